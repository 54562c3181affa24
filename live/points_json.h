// The points of a part that a page shows as handles, as JSON: for the server, and for the program
// in the browser.

#ifndef CAG_LIVE_POINTS_JSON_H
#define CAG_LIVE_POINTS_JSON_H

#include "cag.h"
#include "live/json_write.h"

// An answer to a request. Statuses are those of HTTP.
typedef struct CagLiveAnswer {
  int status;      // 200; 400: the request is wrong; 404: no such part or point; 422: it failed
  const char *why; // of other statuses than 200, for the user
  CagString text;  // of status 200; release it with cag_string_free
} CagLiveAnswer;

// {"part": NAME} gives {"points": [...], "omitted": N}. Each point has
//
//   id, call, dimension, at     see CagPointView
//   plane        {origin, normal} of a point in a plane, in the scene; null in space
//   map          3 rows of 4: from the coordinates in the script, mm, to the scene
//   numbers      for each coordinate: {file, line, column, endLine, endColumn, value, unit,
//                scale} of the number in the script; null if it is computed
//   moved        for each coordinate: whether params move it
//   locked       why it cannot be moved; null
//   params       names of params that move it
void cag_live_points(CagSession *s, const char *request, size_t size, CagLiveAnswer *out);

// {"part": NAME, "point": ID, "target": [x, y, z], "ignored": [[x, y, z], ...], "params": [NAME,
// ...], "pixel": MM} gives {"params": {NAME: VALUE, ...}, "at": [x, y, z]}: values of these params
// with which the point comes closest to the target, except in at most two directions that are
// ignored (which may be left out), rounded so that the point moves by less than a pixel.
void cag_live_solve(CagSession *s, const char *request, size_t size, CagLiveAnswer *out);

#endif
