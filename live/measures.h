// The measures of what a script shows as JSON, for `cag measure --json` and `cag mcp`.
//
//     {"file": "vase.cag", "name": null, "unit": "mm", "parts": [PART, ...], "total": TOTAL}
//     PART   {"name": "vase", "type": "surface", "kind": "revolution", "empty": false,
//             "bounds": BOX, "length": null, "area": 21803.1, "volume": null,
//             "centroid": [0, 0, 58.2], "watertight": false, "closed": false, "exact": true,
//             "faces": 1, "triangles": 5440}
//     TOTAL  {"parts": 1, "bounds": BOX, "area": 21803.1, "volume": 0, "centroid": null}
//     BOX    {"min": [-30, -30, 0], "max": [30, 30, 120], "size": [60, 60, 120]}
//
// What does not apply, or is unknown, is null. `name` is the definition that was asked for. A
// definition that is not a shape has no parts, and its "value" and "type" instead. The total has
// the sum of the areas and volumes, the box around all parts, and the centroid of the volume.

#ifndef CAG_LIVE_MEASURES_H
#define CAG_LIVE_MEASURES_H

#include "live/json.h"

typedef struct CagMeasuring {
  cJSON *whole; // freed by the caller
  int status;   // of the session; if it is not CAG_STATUS_OK, `whole` is incomplete
} CagMeasuring;

// Measures what the session shows, or one definition (name NULL: all). Leaves the definition alone
// shown.
CagMeasuring cag_measure(CagSession *s, const char *file, const char *name);

#endif
