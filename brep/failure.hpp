// What a request fails with. Thrown; the loop in main.cpp answers with it.

#ifndef CAG_BREP_FAILURE_HPP
#define CAG_BREP_FAILURE_HPP

#include "interp/kernel/protocol.h"

#include <cstdint>
#include <string>

namespace brep {

struct Failure {
  CagBrepFailure reason;
  std::string what;
  uint32_t edge = CAG_BREP_NONE;
  double limit = 0;
};

} // namespace brep

#endif
