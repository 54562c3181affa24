// Traces that end at the poles of spheres, where u is not defined. The kernel may find an arbitrary
// u there for the seam that it adds to a face of a file.

#ifndef CAG_BREP_POLES_HPP
#define CAG_BREP_POLES_HPP

#include <TopoDS_Face.hxx>

namespace brep {

// Makes the traces of the meridians of a spherical face lines of constant u, and joins those of its
// poles to them. The face is oriented forward. Returns whether some were not.
bool straighten_meridians(const TopoDS_Face &face);

} // namespace brep

#endif
