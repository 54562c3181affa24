// What a page asks to run: the text, params, and time.

#ifndef CAG_LIVE_REQUEST_H
#define CAG_LIVE_REQUEST_H

#include <stdbool.h>
#include <stddef.h>

typedef struct CagLiveDefine {
  char *name, *value;
} CagLiveDefine;

// Everything is malloc'd.
typedef struct CagLiveRequest {
  char *text; // of the main script; NULL: that of the file
  CagLiveDefine *defines;
  size_t define_count;
  bool has_time, loop;
  double time, frames;
  double coarse; // factor of the tolerance
} CagLiveRequest;

// Reads a request, such as {"files": {"vase.cag": "..."}, "params": {"height": "120"}, "time": 0.5,
// "frames": 24, "loop": true, "coarse": false}. `script` is the path of the main script, whose text
// may be among the files. Returns false if the JSON is wrong or memory runs out.
bool cag_live_request_read(const char *json, size_t size, const char *script, CagLiveRequest *out);
// Returns false if memory ran out.
bool cag_live_request_copy(const CagLiveRequest *from, CagLiveRequest *to);
void cag_live_request_free(CagLiveRequest *r);

#endif
