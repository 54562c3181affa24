// Primitives, extrusions, and revolutions with their own surfaces in exact files.

#ifndef CAG_INTERP_FORMATS_BREP_FORM_H
#define CAG_INTERP_FORMATS_BREP_FORM_H

#include "interp/formats/brep.h"

// Adds a solid whose faces are all planes, cylinders, cones, spheres, and tori, and whose edges are
// lines and circles, as the shells of a shape: boxes, spheres, cylinders, cones, and tori;
// extrusions along the normal of regions that are bounded by lines and arcs; and revolutions of one
// such outline. *done is false, and nothing is added, for other solids and where the solid is not
// similar to such a form.
CagStatus cag_brep_add_form(CagBrep *b, const CagSolid *s, CagBrepShape *shape, bool *done,
                            CagError *err);

#endif
