// Shared by export and rendering.

#ifndef CAG_INTERP_SESSION_OUTPUT_H
#define CAG_INTERP_SESSION_OUTPUT_H

#include "base/atomic_file.h"
#include "interp/render/image.h"
#include "interp/session/session.h"

// Finds the index of the camera of this name (NULL: the first). Otherwise adds a diagnostic and
// returns its status.
int cag_session_find_camera(CagSession *s, const char *name, size_t *out);

#endif
