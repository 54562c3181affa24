// Areas and mass properties of boundaries, by line integrals along the edges of their faces.

#ifndef CAG_GEOM_BOUNDARY_MEASURE_H
#define CAG_GEOM_BOUNDARY_MEASURE_H

#include "geom/boundary/boundary.h"

// Volume, area, centroids, and inertia (density 1, about the centroid of the volume): to a relative
// error of 1e-8 if all faces are planes, cylinders, cones, spheres, and tori whose edges are lines
// and conics, else about as accurate as the edges. Fails with "no-boundary" if the faces enclose no
// volume.
//
// Method: the divergence theorem makes integrals over the faces of those over the volume, and
// Green's theorem makes line integrals of these, as in Mirtich, "Fast and accurate computation of
// polyhedral mass properties" (1996), but on curved carriers.
CagStatus cag_boundary_mass(const CagBoundary *b, CagMassProperties *out, CagError *err);

// The area and its centroid of a face, as accurate. `centroid` may be NULL.
CagStatus cag_boundary_face_area(const CagBoundary *b, size_t face, double *area, CagVec3 *centroid,
                                 CagError *err);

// A box around points of all edges of a face, or of all faces if `face` is SIZE_MAX. Faces may
// bulge beyond it.
CagStatus cag_boundary_extent(const CagBoundary *b, size_t face, CagBounds *out, CagError *err);

#endif
