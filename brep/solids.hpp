// What all requests need of solids: their measures, whether they are valid, and the solids of a
// shape.

#ifndef CAG_BREP_SOLIDS_HPP
#define CAG_BREP_SOLIDS_HPP

#include "brep/measure.hpp"

#include <TopoDS_Shape.hxx>
#include <TopoDS_Solid.hxx>
#include <gp_Trsf.hxx>
#include <string>
#include <vector>

namespace brep {

typedef std::vector<TopoDS_Solid> Solids;

double volume_of(const TopoDS_Shape &shape);
double volume_of(const Solids &solids);
// The measures of a solid, which are computed once.
Measures measures_of(const TopoDS_Solid &solid);
// Notes the measures of a solid that were found in another process.
void note_measures(const TopoDS_Solid &solid, const Measures &measures);
// Notes the measures of a solid that is the image of a measured one under a similarity.
void note_image(const TopoDS_Solid &before, const gp_Trsf &map, const TopoDS_Shape &after);
// Whether the faces of a shape enclose more than rounding errors.
bool encloses_volume(const TopoDS_Shape &shape);
// Of the box around a shape.
double diagonal_of(const TopoDS_Shape &shape);

// What is wrong with a solid: empty if it is closed, valid, and oriented outward. A solid that was
// found valid is not checked again.
std::string faults_of(const TopoDS_Solid &solid);
// Whether a solid was found valid, and notes that an equal one was, in another process.
bool is_known_valid(const TopoDS_Solid &solid);
void note_valid(const TopoDS_Solid &solid);
bool are_valid(const Solids &solids);

// All solids of a shape, oriented outward, in canonical order: by descending volume, then by
// centroid. Solids of no volume are left out.
Solids solids_of(const TopoDS_Shape &shape);
void sort_solids(Solids &solids);

// The solids that closed shells bound: a shell inside of another is its cavity. Fails if a shell is
// open.
Solids solids_of_shells(const TopoDS_Shape &shells);

// Merges faces of one surface and edges of one curve. Returns the solids as they are if merging
// would break them.
Solids unify(const Solids &solids);

// Repairs tolerances, missing curves, and orientations.
Solids repair(const Solids &solids);

TopoDS_Shape compound_of(const Solids &solids);

} // namespace brep

#endif
