// The module that rounds, hollows, and otherwise changes the faces of a solid.

#include "brep/module.hpp"
#include "brep/operations.hpp"

static brep::Solids operation_result(uint64_t type, brep::Reader &in) {
  switch (type) {
  case CAG_BREP_FILLET: return brep::fillet(in);
  case CAG_BREP_CHAMFER: return brep::chamfer(in);
  case CAG_BREP_SHELL: return brep::shell(in);
  case CAG_BREP_OFFSET: return brep::offset(in);
  case CAG_BREP_DRAFT: return brep::draft(in);
  default: return brep::imprint(in);
  }
}

extern "C" const char *cag_brep_module_version() { return CAG_VERSION; }

extern "C" void cag_brep_module_answer(uint64_t type, brep::Reader &in,
                                       std::vector<brep::Part> &parts) {
  brep::add_valid_parts(parts, operation_result(type, in), "");
}
