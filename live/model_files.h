// The files of a model, as a page may read and write them: below the script's folder only.

#ifndef CAG_LIVE_MODEL_FILES_H
#define CAG_LIVE_MODEL_FILES_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

enum { CAG_VERSION_SIZE = 33 };

// Returns the real path of `path` below `folder`, whose file may be missing (malloc). Returns NULL
// if it leads out of the folder, also by symbolic links.
char *cag_model_path(const char *folder, const char *path);
// Reads the file at `path` below `folder`. Refuses paths that lead out of the folder, also by
// symbolic links, and anything but regular files. *text is malloc'd and ends with a NUL. Returns
// false with a reason in `why`.
bool cag_model_read(const char *folder, const char *path, char **text, size_t *size,
                    const char **why);
// Writes the file, which must be a script (.cag) or params (.params.json), under a temporary name
// that is renamed.
bool cag_model_write(const char *folder, const char *path, const char *text, size_t size,
                     CagError *err);
// The version of a text: equal texts have equal versions.
void cag_model_version(const char *text, size_t size, char out[CAG_VERSION_SIZE]);

#endif
