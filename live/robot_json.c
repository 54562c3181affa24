#include "live/robot_json.h"

#include <cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "live/place_json.h"

// More numbers than any robot has joints.
enum { NUMBERS_MAX = 1024, FRAME_NUMBERS = 12 };

// --- The scene ---

static void write_joint(CagJson *j, CagSession *s, size_t robot, size_t joint,
                        const CagJointView *v) {
  CagPlaceView place;
  cag_json_open(j, '{');
  cag_json_text(j, "name", v->name);
  cag_json_text(j, "kind", v->kind);
  cag_json_number(j, "low", v->low);
  cag_json_number(j, "high", v->high);
  cag_json_number(j, "home", v->home);
  cag_json_number(j, "value", v->value);
  cag_json_text(j, "unit", v->unit);
  if (cag_session_robot_joint_place(s, robot, joint, &place)) {
    cag_json_null(j, "place");
  } else {
    cag_json_open_in(j, "place", '{');
    cag_live_place(j, &place);
    cag_json_close(j, '}');
  }
  cag_json_close(j, '}');
}

static void write_part_names(CagJson *j, CagSession *s, size_t robot, const CagRobotView *r) {
  cag_json_open_in(j, "parts", '[');
  for (size_t k = 0; k < r->part_count; k++) {
    const char *name;
    cag_session_robot_part(s, robot, k, &name);
    cag_json_text(j, NULL, name);
  }
  cag_json_close(j, ']');
}

static void write_frames(CagJson *j, const char *key, const double (*frames)[3][4], size_t n) {
  cag_json_open_in(j, key, '[');
  for (size_t i = 0; i < n; i++) cag_json_numbers(j, NULL, frames[i][0], FRAME_NUMBERS);
  cag_json_close(j, ']');
}

// The frames of the robot as the script shows it. A robot that was flattened has none.
static void write_shown_frames(CagJson *j, CagSession *s, size_t robot, const CagRobotView *r) {
  double *q = calloc(r->joint_count + 1, sizeof *q);
  CagRobotPose pose = {0};
  CagJointView joint;
  for (size_t k = 0; q && cag_session_robot_joint(s, robot, k, &joint); k++) q[k] = joint.value;
  if (!q) j->to->failed = true;
  else cag_session_robot_pose(s, robot, q, r->joint_count, &pose);
  write_frames(j, "frames", pose.frames, pose.frame_count);
  if (pose.frame_count) cag_json_numbers(j, "tool", pose.tool[0], FRAME_NUMBERS);
  else cag_json_null(j, "tool");
  free(q);
}

static void write_robot(CagJson *j, CagSession *s, size_t robot, const CagRobotView *r) {
  CagJointView joint;
  CagPlaceView ignored;
  cag_json_open(j, '{');
  cag_json_text(j, "name", r->name);
  write_part_names(j, s, robot, r);
  cag_json_open_in(j, "joints", '[');
  for (size_t k = 0; cag_session_robot_joint(s, robot, k, &joint); k++)
    write_joint(j, s, robot, k, &joint);
  cag_json_close(j, ']');
  cag_json_text(j, "fixed", cag_session_robot_joint_place(s, robot, 0, &ignored));
  write_shown_frames(j, s, robot, r);
  cag_json_close(j, '}');
}

void cag_live_robots(CagJson *j, CagSession *s) {
  CagRobotView r;
  cag_json_open_in(j, "robots", '[');
  for (size_t i = 0; cag_session_robot(s, i, &r); i++) write_robot(j, s, i, &r);
  cag_json_close(j, ']');
}

// --- Requests ---

typedef struct Request {
  CagSession *session;
  cJSON *json;
  size_t robot;
  double q[NUMBERS_MAX];
  size_t count;
  CagString *out;
} Request;

static int fail(CagString *out, int status, const char *message) {
  CagJson j = {.to = out};
  cag_json_open(&j, '{');
  cag_json_text(&j, "error", message);
  cag_json_null(&j, "help");
  cag_json_close(&j, '}');
  return out->failed ? 500 : status;
}

static int fail_with_session(const Request *r) {
  const size_t n = cag_session_error_count(r->session);
  CagErrorView e = {0};
  if (n > 0) cag_session_error(r->session, n - 1, &e);
  return fail(r->out, 400, e.message ? e.message : "the robot cannot be moved");
}

// Reads a list of numbers. False: it is something else.
static bool read_numbers(const cJSON *list, double *out, size_t *count) {
  const cJSON *item;
  *count = 0;
  if (!cJSON_IsArray(list)) return false;
  cJSON_ArrayForEach(item, list) {
    if (!cJSON_IsNumber(item) || *count == NUMBERS_MAX) return false;
    out[(*count)++] = item->valuedouble;
  }
  return true;
}

static bool find_robot(Request *r) {
  const cJSON *name = cJSON_GetObjectItemCaseSensitive(r->json, "robot");
  CagRobotView robot;
  if (!cJSON_IsString(name)) return false;
  for (r->robot = 0; cag_session_robot(r->session, r->robot, &robot); r->robot++)
    if (!strcmp(robot.name, name->valuestring)) return true;
  return false;
}

// Reads what both requests have. Returns 200 or a status after an error.
static int begin_request(Request *r, const char *text, size_t size) {
  if (!r->session) return fail(r->out, 409, "the script has not run without errors yet");
  r->json = cJSON_ParseWithLength(text, size);
  if (!cJSON_IsObject(r->json)) return fail(r->out, 400, "expected a JSON object");
  if (!find_robot(r))
    return fail(r->out, 404, "expected the name of a robot of the scene as `robot`");
  if (!read_numbers(cJSON_GetObjectItemCaseSensitive(r->json, "q"), r->q, &r->count))
    return fail(r->out, 400, "expected a list of numbers, the joint values, as `q`");
  return 200;
}

// Adds the pose at the joint values of the request to an object.
static int write_pose(Request *r, CagJson *j) {
  CagRobotPose pose;
  const int status = cag_session_robot_pose(r->session, r->robot, r->q, r->count, &pose);
  if (status == CAG_STATUS_LIMIT) return fail(r->out, 500, "out of memory");
  if (status != CAG_STATUS_OK) return fail_with_session(r);
  cag_json_open(j, '{');
  cag_json_numbers(j, "q", r->q, r->count);
  write_frames(j, "motions", pose.motions, pose.part_count);
  write_frames(j, "frames", pose.frames, pose.frame_count);
  cag_json_numbers(j, "tool", pose.tool[0], FRAME_NUMBERS);
  return 200;
}

static int end_request(Request *r, int status) {
  cJSON_Delete(r->json);
  return status == 200 && r->out->failed ? 500 : status;
}

int cag_live_pose(CagSession *s, const char *request, size_t size, CagString *out) {
  Request r = {.session = s, .out = out};
  CagJson j = {.to = out};
  int status = begin_request(&r, request, size);
  if (status == 200) status = write_pose(&r, &j);
  if (status == 200) cag_json_close(&j, '}');
  return end_request(&r, status);
}

static bool read_orientation(const cJSON *json, CagReach *out) {
  static const char *const NAMES[] = {
      [CAG_REACH_KEEP] = "keep", [CAG_REACH_EXACT] = "exact", [CAG_REACH_FREE] = "free"};
  const cJSON *name = cJSON_GetObjectItemCaseSensitive(json, "orientation");
  *out = CAG_REACH_KEEP;
  if (!name) return true;
  for (size_t i = 0; cJSON_IsString(name) && i < sizeof NAMES / sizeof *NAMES; i++)
    if (!strcmp(name->valuestring, NAMES[i])) {
      *out = (CagReach)i;
      return true;
    }
  return false;
}

static int write_reach(Request *r, CagJson *j) {
  double target[NUMBERS_MAX];
  size_t count;
  CagReach orientation;
  CagReachView reach;
  if (!read_numbers(cJSON_GetObjectItemCaseSensitive(r->json, "target"), target, &count) ||
      count != FRAME_NUMBERS)
    return fail(r->out, 400, "expected 12 numbers, 3 rows of 4, as `target`");
  if (!read_orientation(r->json, &orientation))
    return fail(r->out, 400, "expected \"keep\", \"exact\", or \"free\" as `orientation`");
  double rows[3][4];
  memcpy(rows, target, sizeof rows);
  if (cag_session_robot_reach(r->session, r->robot, (const double(*)[4])rows, orientation, r->q,
                              r->count, &reach) != CAG_STATUS_OK)
    return fail_with_session(r);
  memcpy(r->q, reach.q, r->count * sizeof *r->q);
  const int status = write_pose(r, j);
  if (status != 200) return status;
  cag_json_bool(j, "reached", reach.reached);
  cag_json_number(j, "distance", reach.distance);
  cag_json_number(j, "angle", reach.angle);
  cag_json_close(j, '}');
  return 200;
}

int cag_live_reach(CagSession *s, const char *request, size_t size, CagString *out) {
  Request r = {.session = s, .out = out};
  CagJson j = {.to = out};
  int status = begin_request(&r, request, size);
  if (status == 200) status = write_reach(&r, &j);
  return end_request(&r, status);
}
