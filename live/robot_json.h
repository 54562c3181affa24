// The robots of a scene as JSON, and the answers to a page that moves them: for the server, and for
// the program in the browser.

#ifndef CAG_LIVE_ROBOT_JSON_H
#define CAG_LIVE_ROBOT_JSON_H

#include "cag.h"
#include "live/json_write.h"

// Adds the list "robots" of the scene to an object: name, parts (their names), joints, frames,
// tool. A joint has name, kind, low, high, home, value, unit, and place, the location of its number
// in the script, or null if `fixed` tells why the script has no such numbers.
void cag_live_robots(CagJson *j, CagSession *s);

// Both take a request in JSON and the session of the last run that succeeded (NULL: there is none),
// and add an object to `out`. They return 200, or the HTTP status of the error that the object then
// tells: {"error": message, "help": null}. Joint values are in degrees and millimeters. Frames and
// motions are 12 numbers: 3 rows of 4.

// {"robot": name, "q": [...]} gives {"q", "motions" of the parts, "frames", "tool"}.
int cag_live_pose(CagSession *s, const char *request, size_t size, CagString *out);
// {"robot": name, "target": frame of the tool, "q": where it is now, "orientation": "keep",
// "exact", or "free"} gives the same, with "reached", "distance" (mm), and "angle" (degrees).
int cag_live_reach(CagSession *s, const char *request, size_t size, CagString *out);

#endif
