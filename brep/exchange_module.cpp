// The module that reads STEP and IGES files.

#include "brep/exchange.hpp"

extern "C" const char *cag_brep_module_version() { return CAG_VERSION; }

extern "C" void cag_brep_module_answer(uint64_t type, brep::Reader &in,
                                       std::vector<brep::Part> &parts) {
  parts = type == CAG_BREP_READ_STEP ? brep::read_step(in) : brep::read_iges(in);
}
