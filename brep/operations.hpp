// Requests that change a solid: fillets, chamfers, shells, offsets, drafts, and imprints.

#ifndef CAG_BREP_OPERATIONS_HPP
#define CAG_BREP_OPERATIONS_HPP

#include "brep/codec.hpp"
#include "brep/solids.hpp"

namespace brep {

// Each reads the fields of its request, to their end.
Solids fillet(Reader &in);
Solids chamfer(Reader &in);
Solids shell(Reader &in);
Solids offset(Reader &in);
Solids draft(Reader &in);
Solids imprint(Reader &in);

} // namespace brep

#endif
