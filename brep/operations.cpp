#include "brep/operations.hpp"
#include "brep/exchange.hpp"
namespace brep {
#define S(n)                                                                                       \
  Solids n(Reader &) { throw Failure{CAG_BREP_FAIL_INPUT, "unknown"}; }

S(draft) S(split) S(imprint) std::vector<Part> read_step(Reader &) {
  throw Failure{CAG_BREP_FAIL_INPUT, "unknown"};
}
std::vector<Part> read_iges(Reader &) { throw Failure{CAG_BREP_FAIL_INPUT, "unknown"}; }
} // namespace brep
