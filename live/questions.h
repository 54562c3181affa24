// What a page asks about the shapes of the last run, as JSON: for the server, and for the program
// in the browser.
//
// | question | request | answer |
// |---|---|---|
// | faces | part | mesh, operands: the source of each, faces: pairs of a count and an operand |
// | ghost | file, line, column | ghosts: part, type, mesh, placement, line, radius, motion, place |
// | surface | part, what | of mesh, mean, gaussian, distance, farthest, points, sizes, what it asks for; or the reason why there is no such thing |
// | pose, reach | see robot_json.h | |
// | points, solve | see points_json.h | |
// | section | normal, offset | curves: part, closed, exact, length, area, points |
//
// Long lists of numbers are base64 of 32-bit floats, least byte first.

#ifndef CAG_LIVE_QUESTIONS_H
#define CAG_LIVE_QUESTIONS_H

#include "cag.h"
#include "live/json_write.h"
#include "live/scene_json.h"

// Answers a question about a session that has a scene, or none (NULL). Returns a status of HTTP,
// 200 unless it failed. *out receives the answer, or an error with its help. `meshes` keeps the
// meshes of ghosts.
int cag_live_ask(const char *question, CagSession *s, const char *request, size_t size,
                 const CagLiveMeshes *meshes, CagString *out);
// Whether there is such a question.
bool cag_live_is_question(const char *question);

#endif
