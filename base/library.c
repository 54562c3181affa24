#include "base/library.h"

#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

bool cag_library_load(const char *file, const char *package, const CagLibraryFunction *functions,
                      size_t n, char *why, size_t size) {
  void *library = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  if (!library) {
    snprintf(why, size, "%s (Debian package %s)", file, package);
    return false;
  }
  for (size_t i = 0; i < n; i++) {
    // POSIX lets a pointer to an object hold that of a function, which C alone does not.
    void *found = dlsym(library, functions[i].name);
    memcpy(functions[i].to, &found, sizeof found);
    if (found) continue;
    snprintf(why, size, "%s with the function %s (Debian package %s)", file, functions[i].name,
             package);
    return false;
  }
  return true;
}
