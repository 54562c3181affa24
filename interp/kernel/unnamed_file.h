// Files without a name, which other processes find by a path.

#ifndef CAG_INTERP_KERNEL_UNNAMED_FILE_H
#define CAG_INTERP_KERNEL_UNNAMED_FILE_H

#include <stddef.h>

// Room for a path.
#define CAG_UNNAMED_PATH 64

// Makes a file in memory with these bytes, and its path, which is valid until it is closed. Returns
// -1 if memory ran out.
int cag_unnamed_file(const void *bytes, size_t size, char path[CAG_UNNAMED_PATH]);
void cag_unnamed_close(int file);

#endif
