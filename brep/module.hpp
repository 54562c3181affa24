// Modules answer the requests that few runs make. The libraries of the kernel that they need take
// longer to load than all others together, so a module is loaded with its first request. It lies
// beside the program, of whose functions it uses many.

#ifndef CAG_BREP_MODULE_HPP
#define CAG_BREP_MODULE_HPP

#include "brep/codec.hpp"
#include "brep/solids.hpp"

#include <gp_Trsf.hxx>
#include <string>
#include <vector>

namespace brep {

// A solid of a result: one of its own, or a copy of an earlier part.
struct Part {
  TopoDS_Solid solid; // null: a copy
  std::string name = "";
  bool has_color = false;
  double color[3] = {0, 0, 0};   // linear red, green, blue
  size_t original = 0;           // of a copy: the index of the part
  gp_Trsf placement = gp_Trsf(); // rigid: maps the original to the copy
};

// Adds solids under one name. Fails if one is not valid.
void add_valid_parts(std::vector<Part> &parts, const Solids &solids, const char *name);

// The names of the functions that each module has.
#define CAG_BREP_MODULE_VERSION "cag_brep_module_version"
#define CAG_BREP_MODULE_ANSWER "cag_brep_module_answer"

// The version of cag that the module belongs to.
typedef const char *(*ModuleVersion)();
// Reads the fields of a request, to their end.
typedef void (*ModuleAnswer)(uint64_t type, Reader &in, std::vector<Part> &parts);

// The function that answers a request, or null if no module does. Loads the module. Fails if it is
// missing or of another version.
ModuleAnswer module_answer(uint64_t type);

} // namespace brep

#endif
