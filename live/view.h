// `cag view`: the page on which a script is seen and changed, and its server.

#ifndef CAG_LIVE_VIEW_H
#define CAG_LIVE_VIEW_H

#include "cag.h"

typedef struct CagViewOptions {
  CagSessionOptions session; // limits, module path, and the flag that ends the server
  const char *file;          // the script; NULL: an empty one, which is not saved
  int port;                  // 0: any free one
  bool read_only;            // nothing can be written
  // Params of the first run, as -D sets them.
  const char *const *define_names, *const *define_values;
  size_t define_count;
  // Called once the server listens, with the address to open.
  void (*ready)(void *context, const char *address);
  void *context;
} CagViewOptions;

// Serves the page until the flag of `session.interrupt` is set. Returns CAG_STATUS_INTERRUPTED then,
// and otherwise a status with the reason in `why`: CAG_STATUS_FILE if the port is in use or the file
// cannot be read.
int cag_view_serve(const CagViewOptions *options, char *why, size_t size);

#endif
