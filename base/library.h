// Shared libraries that are loaded when they are first needed, because they bring other libraries
// with them, which would make every start of the program slower.

#ifndef CAG_BASE_LIBRARY_H
#define CAG_BASE_LIBRARY_H

#include <stdbool.h>
#include <stddef.h>

// A function of the library, and the address of the pointer to it.
typedef struct CagLibraryFunction {
  const char *name;
  void *to;
} CagLibraryFunction;

// Loads the library `file`, which is in the Debian package `package`, and sets the pointers. If that
// fails, writes the reason to `why`, a phrase that starts with the file.
bool cag_library_load(const char *file, const char *package, const CagLibraryFunction *functions,
                      size_t n, char *why, size_t size);

#endif
