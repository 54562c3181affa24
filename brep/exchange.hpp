// Solids of STEP and IGES files.

#ifndef CAG_BREP_EXCHANGE_HPP
#define CAG_BREP_EXCHANGE_HPP

#include "brep/codec.hpp"
#include "brep/solids.hpp"

namespace brep {

// A solid of a file, in millimeters.
struct Part {
  TopoDS_Solid solid;
  std::string name = "";
  bool has_color = false;
  double color[3] = {0, 0, 0}; // linear red, green, blue
};

// Each reads the fields of its request, to their end.
std::vector<Part> read_step(Reader &in);
std::vector<Part> read_iges(Reader &in);

} // namespace brep

#endif
