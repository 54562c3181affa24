// Functions of the curves' and regions' table (curves.c), by the file that holds them.

#ifndef CAG_INTERP_BUILTIN_CURVES_H
#define CAG_INTERP_BUILTIN_CURVES_H

#include "geom/curve/region.h"
#include "interp/builtin/shapes.h"

// clang-format off
#define CAG_CURVE_FUNCTIONS(X) \
  /* curves_ask.c: at one parameter */ \
  X(at) X(derivative) X(tangent) X(normal) X(binormal) X(curvature) X(torsion) X(frenet) \
  X(domain) X(start) X(end) X(start_point) X(end_point) X(degree) X(points) X(weights) \
  X(knots) X(is_closed) X(is_planar) X(is_straight) \
  /* curves_measure.c: of the whole */ \
  X(length) X(parameter_at_length) X(sample) X(divide) X(closest) X(area) X(centroid) \
  X(bounds) \
  /* curves_change.c: another curve of it */ \
  X(reverse) X(trim) X(reparametrize) X(split) X(join_curves) X(to_nurbs) X(polygonize) \
  /* curves_make.c */ \
  X(line) X(polyline) X(circle) X(arc) X(ellipse) X(arc_through) X(circle_through) X(helix) \
  /* curves_spline.c */ \
  X(bezier) X(bspline) X(nurbs) X(knot_vector) X(bernstein) \
  /* regions.c */ \
  X(region) X(polygon) X(rectangle) X(regular_polygon) X(boundary)
// clang-format on

#define X(name) bool cag_curves_##name(CagCall *call, CagValue *result);
CAG_CURVE_FUNCTIONS(X)
#undef X

// Degree from `degree` or, one more, from `order`; the fallback where neither is given.
bool cag_arg_degree(CagCall *call, int degree, int order, long fallback, int *out);

// The frame of a circle by its `center` and `normal`, the parameters `at` and the next: z along the
// normal; planar where neither is of space.
bool cag_arg_circle_frame(CagCall *call, int at, CagTransform *out);
// Weights, one for each of n points; NULL where there are none. "weight-count".
bool cag_arg_weights(CagCall *call, int argument, size_t n, const double **out);

// Brings loops given in space into the x, y plane of a frame, as plane curves; *in_space: it is not
// that of the world. Fails with "not-planar".
bool cag_region_loops_plane(CagCall *call, CagCurve **loops, size_t n, CagTransform *frame,
                            bool *in_space);

#endif
