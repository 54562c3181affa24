// Solids of STEP and IGES files.

#ifndef CAG_BREP_EXCHANGE_HPP
#define CAG_BREP_EXCHANGE_HPP

#include "brep/module.hpp"

namespace brep {

// The solids of a file, in millimeters. Each reads the fields of its request, to their end.
std::vector<Part> read_step(Reader &in);
std::vector<Part> read_iges(Reader &in);

} // namespace brep

#endif
