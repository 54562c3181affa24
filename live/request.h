// What a page asks to run: unsaved texts, params, and time.

#ifndef CAG_LIVE_REQUEST_H
#define CAG_LIVE_REQUEST_H

#include <stdbool.h>
#include <stddef.h>

typedef struct CagLiveText {
  char *name, *text;
} CagLiveText;

// Everything is malloc'd.
typedef struct CagLiveRequest {
  // Unsaved texts, which replace files. Their names are paths below the folder.
  CagLiveText *texts;
  size_t text_count;
  CagLiveText *defines; // expressions of params
  size_t define_count;
  bool has_time, loop;
  double time, frames;
  double coarse; // factor of the tolerance
} CagLiveRequest;

// Reads a request, such as {"files": {"vase.cag": "..."}, "params": {"height": "120"}, "time": 0.5,
// "frames": 24, "loop": true, "coarse": false}. Returns false if the JSON is wrong or memory runs
// out.
bool cag_live_request_read(const char *json, size_t size, CagLiveRequest *out);
// The unsaved text of a file, or NULL.
const char *cag_live_request_text(const CagLiveRequest *r, const char *path);
// From now on, the file on the disk counts.
void cag_live_request_drop_text(CagLiveRequest *r, const char *path);
// Returns false if memory ran out.
bool cag_live_request_copy(const CagLiveRequest *from, CagLiveRequest *to);
void cag_live_request_free(CagLiveRequest *r);

#endif
