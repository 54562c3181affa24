#include "brep/module.hpp"

#include <dlfcn.h>
#include <unistd.h>

namespace brep {

void add_valid_parts(std::vector<Part> &parts, const Solids &solids, const char *name) {
  for (const TopoDS_Solid &solid : solids) {
    const std::string faults = faults_of(solid);
    if (!faults.empty()) throw Failure{CAG_BREP_FAIL_CHECK, faults};
    Part part;
    part.solid = solid;
    part.name = name;
    parts.push_back(part);
  }
}

static const char *module_file(uint64_t type) {
  switch (type) {
  case CAG_BREP_FILLET:
  case CAG_BREP_CHAMFER:
  case CAG_BREP_SHELL:
  case CAG_BREP_OFFSET:
  case CAG_BREP_DRAFT:
  case CAG_BREP_IMPRINT: return "cag-brep-operations.so";
  case CAG_BREP_READ_STEP:
  case CAG_BREP_READ_IGES: return "cag-brep-exchange.so";
  default: return nullptr;
  }
}

// The folder of this program, with a slash at its end.
static std::string program_folder() {
  char path[4096];
  const ssize_t n = readlink("/proc/self/exe", path, sizeof path);
  const std::string program(path, n > 0 ? static_cast<size_t>(n) : 0);
  return program.substr(0, program.rfind('/') + 1);
}

ModuleAnswer module_answer(uint64_t type) {
  const char *file = module_file(type);
  if (!file) return nullptr;
  const std::string path = program_folder() + file;
  // The linker counts how often a module is opened, and loads it once. It is never closed.
  void *module = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (!module) throw Failure{CAG_BREP_FAIL_METHOD, std::string("cannot load ") + dlerror()};
  const auto version = reinterpret_cast<ModuleVersion>(dlsym(module, CAG_BREP_MODULE_VERSION));
  const auto answer = reinterpret_cast<ModuleAnswer>(dlsym(module, CAG_BREP_MODULE_ANSWER));
  if (!version || !answer || version() != std::string(CAG_VERSION))
    throw Failure{CAG_BREP_FAIL_METHOD, path + " belongs to another version of cag-brep"};
  return answer;
}

} // namespace brep
