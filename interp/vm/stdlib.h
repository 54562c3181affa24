// The files of the standard library, embedded into the program by tools/embed.sh.

#ifndef CAG_INTERP_VM_STDLIB_H
#define CAG_INTERP_VM_STDLIB_H

#include <stddef.h>

typedef struct CagStdlibFile {
  const char *module; // "std.materials"
  const char *text;
  size_t length;
} CagStdlibFile;

extern const CagStdlibFile cag_stdlib[]; // ends with a row of NULLs

#endif
