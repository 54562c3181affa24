// Set operations.

#ifndef CAG_BREP_BOOLEANS_HPP
#define CAG_BREP_BOOLEANS_HPP

#include "brep/solids.hpp"

#include <BOPAlgo_Operation.hxx>

namespace brep {

// BOPAlgo_FUSE, BOPAlgo_CUT, or BOPAlgo_COMMON of operands, each of which is zero or more separate
// solids. The result is checked. Fails if no method gives a valid one.
Solids combine(BOPAlgo_Operation operation, const std::vector<Solids> &operands);

} // namespace brep

#endif
