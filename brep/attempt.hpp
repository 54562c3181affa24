// Attempts: methods of the kernel that may crash, take forever, or give results that are not valid.

#ifndef CAG_BREP_ATTEMPT_HPP
#define CAG_BREP_ATTEMPT_HPP

#include "brep/failure.hpp"
#include "brep/solids.hpp"

#include <functional>

namespace brep {

// Seconds after which an attempt is given up.
static const double ATTEMPT_SECONDS = 120;

// Runs a method in a process of its own. The method throws Failure or Standard_Failure to fail.
// Returns false, with the reason in `failure`, if it fails, crashes, or takes longer than `seconds`.
bool attempt(const std::function<Solids()> &method, double seconds, Solids &result,
             Failure &failure);

// The fields of a FAILURE (interp/kernel/protocol.h).
std::string failure_bytes(const Failure &failure);

} // namespace brep

#endif
