// URDF: files written by robots of scripts agree with fk, according to a small reader in this test.
// Files written by this test, with axes in any direction, agree with fk, too. Files that do not
// describe a robot are rejected.

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "cag.h"
#include "interp/formats/urdf_read.h"

// In meters.
#define SAME 1e-9

static char folder[] = "/tmp/cag-urdf-test-XXXXXX";

// --- Reproducible random numbers ---

static uint64_t state_of_chance;

static double chance(double low, double high) {
  state_of_chance = state_of_chance * 6364136223846793005u + 1442695040888963407u;
  return low + (high - low) * (double)(state_of_chance >> 11) / 9007199254740992.0;
}

// --- Files and scripts ---

static char *path_of(const char *name, char *path) {
  snprintf(path, 200, "%s/%s", folder, name);
  return path;
}

static void write_file(const char *name, const char *text) {
  char path[200];
  FILE *f = fopen(path_of(name, path), "wb");
  assert_non_null(f);
  fputs(text, f);
  fclose(f);
}

static char *read_whole(const char *name) {
  char path[200];
  FILE *f = fopen(path_of(name, path), "rb");
  if (!f) fail_msg("%s was not written", name);
  char *text = calloc(1, 1 << 20);
  assert_non_null(text);
  assert_true(fread(text, 1, (1 << 20) - 1, f) > 0);
  fclose(f);
  return text;
}

// Runs a script in the folder, and exports its shown shapes to `urdf`, unless it is NULL. Returns
// the output, to be freed.
static char *run(const char *text, const char *urdf) {
  char path[200], *printed = NULL;
  size_t size;
  CagSessionOptions options;
  cag_session_options_init(&options);
  options.out = open_memstream(&printed, &size);
  CagSession *s = cag_session_new(&options);
  write_file("script.cag", text);
  int status = cag_session_run_file(s, path_of("script.cag", path));
  if (status == CAG_STATUS_OK && urdf) status = cag_session_export(s, path_of(urdf, path), NULL);
  if (status != CAG_STATUS_OK) cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr);
  cag_session_free(s);
  fclose(options.out);
  if (status != CAG_STATUS_OK) fail_msg("the script failed:\n%s", text);
  return printed;
}

// The next n numbers of a printed text.
static const char *read_numbers(const char *text, double *x, int n) {
  for (int i = 0; i < n; i++) {
    text += strcspn(text, "-0123456789");
    char *end;
    x[i] = strtod(text, &end);
    assert_true(end > text);
    text = end;
  }
  return text;
}

// --- An independent URDF reader: rotations by Rodrigues' formula, joints found by their links ---

typedef struct Frame {
  double r[3][3], p[3];
} Frame;

static const Frame unit = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}};

static Frame product(const Frame *a, const Frame *b) {
  Frame c = {.p = {a->p[0], a->p[1], a->p[2]}};
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) {
      c.p[i] += a->r[i][k] * b->p[k];
      for (int j = 0; j < 3; j++) c.r[i][j] += a->r[i][k] * b->r[k][j];
    }
  return c;
}

static Frame turned(const double axis[3], double angle) {
  Frame f = unit;
  double n = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
  double u[3] = {axis[0] / n, axis[1] / n, axis[2] / n}, c = cos(angle), s = sin(angle);
  double cross[3][3] = {{0, -u[2], u[1]}, {u[2], 0, -u[0]}, {-u[1], u[0], 0}};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      f.r[i][j] = (i == j ? c : 0) + (1 - c) * u[i] * u[j] + s * cross[i][j];
  return f;
}

// Finds the value of an attribute in [text, end). Returns false if there is none.
static bool attribute(const char *text, const char *end, const char *element, const char *name,
                      char *out) {
  char opening[64], key[64];
  snprintf(opening, sizeof opening, "<%s ", element);
  snprintf(key, sizeof key, " %s=\"", name);
  const char *e = strstr(text, opening);
  if (!e || e >= end) return false;
  const char *close = strchr(e, '>'), *at = strstr(e, key);
  if (!at || at > close) return false;
  at += strlen(key);
  size_t n = strcspn(at, "\"");
  memcpy(out, at, n);
  out[n] = 0;
  return true;
}

typedef struct Joint {
  char name[64], type[32], parent[64], child[64], mimic[64];
  Frame origin;
  double axis[3], multiplier, low, high, effort, velocity;
} Joint;

typedef struct Robot {
  Joint joints[64];
  size_t count;
} Robot;

static void read_joint(const char *text, const char *end, Joint *j) {
  static const double x[] = {1, 0, 0}, y[] = {0, 1, 0}, z[] = {0, 0, 1};
  char value[200];
  double rpy[3] = {0};
  *j = (Joint){.origin = unit, .axis = {1, 0, 0}, .multiplier = 1};
  assert_true(attribute(text, end, "joint", "name", j->name));
  assert_true(attribute(text, end, "joint", "type", j->type));
  assert_true(attribute(text, end, "parent", "link", j->parent));
  assert_true(attribute(text, end, "child", "link", j->child));
  if (attribute(text, end, "origin", "rpy", value)) read_numbers(value, rpy, 3);
  Frame rx = turned(x, rpy[0]), ry = turned(y, rpy[1]), rz = turned(z, rpy[2]);
  Frame yx = product(&ry, &rx);
  j->origin = product(&rz, &yx);
  if (attribute(text, end, "origin", "xyz", value)) read_numbers(value, j->origin.p, 3);
  if (attribute(text, end, "axis", "xyz", value)) read_numbers(value, j->axis, 3);
  if (attribute(text, end, "limit", "lower", value)) j->low = strtod(value, NULL);
  if (attribute(text, end, "limit", "upper", value)) j->high = strtod(value, NULL);
  if (attribute(text, end, "limit", "effort", value)) j->effort = strtod(value, NULL);
  if (attribute(text, end, "limit", "velocity", value)) j->velocity = strtod(value, NULL);
  attribute(text, end, "mimic", "joint", j->mimic);
  if (attribute(text, end, "mimic", "multiplier", value)) j->multiplier = strtod(value, NULL);
}

static void read_robot(const char *text, Robot *r) {
  r->count = 0;
  for (const char *at = strstr(text, "<joint "); at; at = strstr(at + 1, "<joint ")) {
    const char *end = strstr(at, "</joint>");
    assert_non_null(end);
    assert_true(r->count < 64);
    read_joint(at, end, &r->joints[r->count++]);
  }
}

static bool moves(const Joint *j) { return strcmp(j->type, "fixed") != 0; }

// The joints that have independent values, in order from the root to the tip.
static size_t chain_of(const Robot *r, const Joint **out) {
  size_t n = 0;
  const char *at = NULL;
  for (size_t i = 0; i < r->count && !at; i++) {
    bool hangs = false;
    for (size_t k = 0; k < r->count; k++) hangs |= !strcmp(r->joints[k].child, r->joints[i].parent);
    if (!hangs) at = r->joints[i].parent;
  }
  for (size_t i = 0; at && i < r->count;) {
    if (strcmp(r->joints[i].parent, at) != 0) {
      i++;
      continue;
    }
    out[n++] = &r->joints[i];
    at = r->joints[i].child;
    i = 0;
  }
  return n;
}

static double value_of(const Joint *const *chain, size_t n, const double *q, const char *name) {
  for (size_t i = 0, k = 0; i < n; i++) {
    if (!moves(chain[i]) || chain[i]->mimic[0]) continue;
    if (!strcmp(chain[i]->name, name)) return q[k];
    k++;
  }
  fail_msg("no joint %s", name);
  return 0;
}

static Frame forward(const Joint *const *chain, size_t n, const double *q) {
  Frame f = unit;
  size_t k = 0;
  for (size_t i = 0; i < n; i++) {
    const Joint *j = chain[i];
    f = product(&f, &j->origin);
    if (!moves(j)) continue;
    double x = j->mimic[0] ? j->multiplier * value_of(chain, n, q, j->mimic) : q[k++];
    Frame motion = turned(j->axis, strcmp(j->type, "prismatic") ? x : 0);
    double length =
        sqrt(j->axis[0] * j->axis[0] + j->axis[1] * j->axis[1] + j->axis[2] * j->axis[2]);
    for (int c = 0; c < 3 && !strcmp(j->type, "prismatic"); c++)
      motion.p[c] = x * j->axis[c] / length;
    f = product(&f, &motion);
  }
  return f;
}

// --- Comparing with fk ---

enum { POSES = 12 };

// Random joint values within the limits: `script` is a list of the language, and q is in radians
// and meters.
static void draw_joints(const Joint *const *chain, size_t n, double q[64], char *script) {
  size_t k = 0;
  strcpy(script, "[");
  for (size_t i = 0; i < n; i++) {
    if (!moves(chain[i]) || chain[i]->mimic[0]) continue;
    bool slides = !strcmp(chain[i]->type, "prismatic");
    bool endless = !strcmp(chain[i]->type, "continuous");
    double low = endless ? -6 : chain[i]->low, high = endless ? 6 : chain[i]->high;
    q[k] = chance(low + 0.001 * (high - low), high - 0.001 * (high - low));
    sprintf(script + strlen(script), "%s%.17g%s", k > 0 ? ", " : "",
            slides ? 1000 * q[k] : q[k] * 180 / M_PI, slides ? "" : "deg");
    k++;
  }
  strcat(script, "]");
}

// `definitions` define r. Checks that the file's joints agree with fk(r).
static void check_same(const char *definitions, const char *urdf) {
  char *file = read_whole(urdf), *script = calloc(1, 1 << 16), list[2048];
  double q[POSES][64];
  const Joint *chain[64];
  static Robot robot;
  read_robot(file, &robot);
  size_t n = chain_of(&robot, chain);
  assert_int_equal(n, robot.count);
  strcpy(script, definitions);
  for (int i = 0; i < POSES; i++) {
    draw_joints(chain, n, q[i], list);
    sprintf(script + strlen(script), "print fk(r, %s)\n", list);
  }
  char *printed = run(script, NULL);
  const char *at = printed;
  for (int i = 0; i < POSES; i++) {
    double m[16];
    at = read_numbers(at, m, 16);
    Frame f = forward(chain, n, q[i]);
    for (int row = 0; row < 3; row++) {
      for (int column = 0; column < 3; column++)
        assert_true(fabs(f.r[row][column] - m[4 * row + column]) < SAME);
      if (!(fabs(f.p[row] - m[4 * row + 3] / 1000) < SAME))
        fail_msg("%s\n%g m apart", definitions, fabs(f.p[row] - m[4 * row + 3] / 1000));
    }
  }
  free(printed);
  free(script);
  free(file);
}

static const char *const robots[] = {
    "r = robot([revolute(alpha: -90deg, offset: 12deg), revolute(d: 149.5, a: 432, limits: "
    "-225deg..45deg), "
    "revolute(a: -20.3, alpha: 90deg), revolute(d: 432, alpha: -90deg), revolute(alpha: 90deg), "
    "revolute(d: 56.5)])\n",
    // Modified rows, a base, a tool, fixed links, and joints whose home is not 0.
    "r = robot([revolute(d: 333), revolute(alpha: -90deg, limits: 10deg..80deg, home: 35deg), "
    "fixed_link(translate([1, 2, 3]) * rotate([1, 1, 0], 40deg)), revolute(alpha: 70deg, a: 82.5, "
    "d: 316), "
    "prismatic(alpha: 33deg, a: -4, "
    "offset: 7, theta: 15deg, limits: 20..180, home: 100)], convention: \"mdh\", base: "
    "translate([100, 200, 300]) * "
    "rotate(X, 77deg), tool: rotate([1, 2, 3], 50deg) * translate([0, 0, 88]))\n",
    // A screw joint, and rotations for which the pitch stays at a quarter turn.
    "r = robot([prismatic(limits: 0..300), fixed_link(rotate(Y, 90deg)), revolute(lead: 20, a: "
    "50), fixed_link(rotate(Y, -90deg) * rotate(X, "
    "13deg)), revolute(limits: -720deg..720deg, d: 5), fixed_link(rotate(Y, 90deg - 1e-9deg))])\n",
    "import std.robots\nr = robots.panda\n",
    "import std.robots\nr = robots.puma560\n",
    "import std.robots\nr = robots.stanford\n",
};

static void the_files_joints_lead_where_fk_leads(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof robots / sizeof *robots; i++) {
    char script[2048];
    state_of_chance = i;
    snprintf(script, sizeof script, "%sshow r\n", robots[i]);
    free(run(script, "arm.urdf"));
    check_same(robots[i], "arm.urdf");
  }
}

static void what_was_written_is_read_back(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof robots / sizeof *robots; i++) {
    char script[4096];
    state_of_chance = i;
    snprintf(script, sizeof script, "%sshow r\n", robots[i]);
    free(run(script, "arm.urdf"));
    check_same("r = read_urdf(\"arm.urdf\")\n", "arm.urdf");
    // Limits agree up to rounding.
    snprintf(
        script, sizeof script,
        "%ss = read_urdf(\"arm.urdf\")\nprint [for i in 0..<r.joints: "
        "near(r.limits[i].start, s.limits[i].start) and near(r.limits[i].end, s.limits[i].end)]\n",
        robots[i]);
    char *printed = run(script, NULL);
    assert_null(strstr(printed, "false"));
    free(printed);
  }
}

// Arbitrary origins and axes, and all kinds of joints.
static void write_any_robot(char *text, int joints) {
  static const char *const kinds[] = {"revolute", "continuous", "prismatic", "fixed"};
  static const double round_axes[][3] = {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}, {0, 0, 2}, {0, 0, 0}};
  sprintf(text, "<robot name=\"any\">\n<link name=\"l0\"/>\n");
  for (int i = 1; i <= joints; i++) {
    const double *round_axis = round_axes[(int)chance(0, 4.999)];
    double axis[3], quarters = floor(chance(-2, 2)) * M_PI_2;
    for (int k = 0; k < 3; k++) axis[k] = chance(0, 1) < 0.5 ? chance(-1, 1) : round_axis[k];
    axis[0] += axis[0] == 0 && axis[1] == 0 && axis[2] == 0;
    sprintf(
        text + strlen(text),
        "<link name=\"l%d\"/>\n<joint name=\"j%d\" type=\"%s\">\n<origin xyz=\"%.17g %.17g %.17g\" "
        "rpy=\"%.17g %.17g %.17g\"/>\n<parent link=\"l%d\"/><child link=\"l%d\"/>\n<axis "
        "xyz=\"%.17g %.17g %.17g\"/><limit lower=\"-0.5\" upper=\"1.5\" effort=\"7\" "
        "velocity=\"2\"/>\n</joint>\n",
        i, i, kinds[(int)chance(0, 3.999)], chance(-1, 1), chance(0, 1) < 0.5 ? 0 : chance(-1, 1),
        chance(0, 1) < 0.5 ? 0 : chance(-1, 1), chance(0, 1) < 0.5 ? quarters : chance(-3, 3),
        chance(0, 1) < 0.5 ? 0 : chance(-3, 3), chance(0, 1) < 0.5 ? quarters : chance(-3, 3),
        i - 1, i, axis[0], axis[1], axis[2]);
  }
  strcat(text, "</robot>\n");
}

static void axes_in_any_direction_are_read(void **state) {
  (void)state;
  char *text = calloc(1, 1 << 16);
  for (int i = 0; i < 60; i++) {
    state_of_chance = 1000 + (uint64_t)i;
    write_any_robot(text, 2 + i % 9);
    write_file("any.urdf", text);
    check_same("r = read_urdf(\"any.urdf\")\n", "any.urdf");
  }
  free(text);
}

// Axes that are almost parallel to the previous one, at angles from 1e-13, intersecting it or not.
// Some become rows. Those whose rows would be far away become fixed transforms.
static void axes_that_are_almost_parallel_are_read(void **state) {
  (void)state;
  char *text = calloc(1, 1 << 16);
  for (int i = 0; i < 60; i++) {
    state_of_chance = 2000 + (uint64_t)i;
    sprintf(text, "<robot name=\"any\">\n<link name=\"l0\"/>\n");
    for (int k = 1; k < 6; k++) {
      double tilt[2], p[3];
      for (int j = 0; j < 2; j++) {
        const double size = pow(10, -chance(1, 13)), sign = chance(-1, 1);
        tilt[j] = chance(0, 1) < 0.3 ? 0 : sign < 0 ? -size : size;
      }
      for (int j = 0; j < 3; j++) {
        const double far = chance(-1, 1);
        p[j] = chance(0, 1) < 0.5 ? 0 : far;
      }
      const double up = chance(0, 1) < 0.7 ? 1 : -1;
      sprintf(text + strlen(text),
              "<link name=\"l%d\"/>\n<joint name=\"j%d\" type=\"revolute\">\n<origin xyz=\"%.17g "
              "%.17g %.17g\"/>\n<parent link=\"l%d\"/><child link=\"l%d\"/>\n<axis xyz=\"%.17g "
              "%.17g %g\"/><limit lower=\"-0.5\" upper=\"1.5\" effort=\"7\" "
              "velocity=\"2\"/>\n</joint>\n",
              k, k, p[0], p[1], p[2], k - 1, k, tilt[0], tilt[1], up);
    }
    strcat(text, "</robot>\n");
    write_file("any.urdf", text);
    check_same("r = read_urdf(\"any.urdf\")\n", "any.urdf");
  }
  free(text);
}

// A chain of Denavit-Hartenberg rows is read as rows again, followed by at most one transform.
static void rows_are_read_as_rows(void **state) {
  (void)state;
  for (int i = 0; i < 40; i++) {
    char script[4000] = "r = robot([";
    state_of_chance = 3000 + (uint64_t)i;
    const int n = 2 + i % 5;
    for (int k = 0; k < n; k++) {
      const double d = chance(-300, 300), a = chance(-300, 300), theta = chance(-170, 170);
      const double any = chance(5, 175), kind = chance(0, 5), sign = chance(-1, 1);
      const double alpha = kind < 1 ? 0 : kind < 3 ? 90 : any;
      sprintf(script + strlen(script),
              "%srevolute(d: %.3f, a: %.3f, alpha: %.2fdeg, offset: %.2fdeg)", k ? ", " : "", d,
              chance(0, 1) < 0.4 ? 0 : a, sign < 0 ? -alpha : alpha,
              chance(0, 1) < 0.5 ? 0 : theta);
    }
    strcat(script, "])\n");
    char *shown = calloc(1, 1 << 14), *printed;
    sprintf(shown, "%sshow r\n", script);
    printed = run(shown, "rows.urdf");
    free(printed);
    sprintf(shown, "%ss = read_urdf(\"rows.urdf\")\nprint len(s.links)\n", script);
    printed = run(shown, NULL);
    if (atoi(printed) != n && atoi(printed) != n + 1) fail_msg("%s%s links", script, printed);
    free(printed);
    free(shown);
  }
}

// --- Masses: closed forms of a box and a cylinder ---

static double number_after(const char *text, const char *mark) {
  const char *at = strstr(text, mark);
  if (!at) fail_msg("no %s", mark);
  double x;
  read_numbers(at + strlen(mark), &x, 1);
  return x;
}

static void masses_are_those_of_the_shapes(void **state) {
  (void)state;
  // A steel box of 0.2 x 0.1 x 0.05 m, whose center is 0.1 m in front of the frame.
  free(run("box_of = translate(box([200, 100, 50]), [-200, -50, -25])\n"
           "show robot([revolute(a: 300, alpha: 90deg, shape: material(box_of, {color: \"grey\", "
           "density: "
           "7850}))])\n",
           "box.urdf"));
  char *text = read_whole("box.urdf");
  const double m = 7850 * 0.2 * 0.1 * 0.05;
  assert_true(fabs(number_after(text, "<mass value=\"") - m) < 1e-12 * m);
  // About x, then y (the frame's z), then z, relative to the joint, which is rotated by 90 degrees.
  assert_true(fabs(number_after(text, "ixx=\"") - m * (0.1 * 0.1 + 0.05 * 0.05) / 12) < 1e-12);
  assert_true(fabs(number_after(text, "iyy=\"") - m * (0.2 * 0.2 + 0.1 * 0.1) / 12) < 1e-12);
  assert_true(fabs(number_after(text, "izz=\"") - m * (0.2 * 0.2 + 0.05 * 0.05) / 12) < 1e-12);
  const char *inertial = strstr(text, "<inertial>");
  double center[3];
  read_numbers(strstr(inertial, "xyz=\"") + 5, center, 3);
  assert_true(fabs(center[0] - 0.2) < 1e-12 && fabs(center[1]) < 1e-12 && fabs(center[2]) < 1e-12);
  free(text);
  // Two cylinders of water end to end are equivalent to one.
  free(run("show robot([revolute(shape: [cylinder(100, 30), translate(cylinder(100, 30), [0, 0, "
           "100])])])\n",
           "rod.urdf"));
  text = read_whole("rod.urdf");
  const double r = 0.03, h = 0.2, water = 1000 * M_PI * r * r * h;
  assert_true(fabs(number_after(text, "<mass value=\"") - water) < 1e-9 * water);
  assert_true(fabs(number_after(text, "ixx=\"") - water * (3 * r * r + h * h) / 12) < 1e-9);
  assert_true(fabs(number_after(text, "izz=\"") - water * r * r / 2) < 1e-9);
  free(text);
}

// The total volume of the collision cylinders and boxes of a link, in cubic meters.
static double volume_of_plain(const char *link, const char *end, int *count) {
  double sum = 0;
  *count = 0;
  for (const char *at = link; (at = strstr(at, "<collision>")) && at < end; at++) {
    const char *close = strstr(at, "</collision>");
    char radius[200], length[200], size[200];
    double side[3];
    ++*count;
    if (attribute(at, close, "box", "size", size)) {
      read_numbers(size, side, 3);
      sum += side[0] * side[1] * side[2];
    } else {
      assert_true(attribute(at, close, "cylinder", "radius", radius));
      assert_true(attribute(at, close, "cylinder", "length", length));
      sum += M_PI * pow(strtod(radius, NULL), 2) * strtod(length, NULL);
    }
  }
  return sum;
}

// The default bodies have the density of water, and a rod extends from joint to joint.
static void plain_bodies_weigh_what_their_sizes_say(void **state) {
  (void)state;
  free(run("show robot([revolute(a: 300), prismatic(limits: 0..100), revolute(a: 100)])\n",
           "plain.urdf"));
  char *text = read_whole("plain.urdf");
  int bodies = 0;
  for (const char *link = strstr(text, "<link "); link; link = strstr(link + 1, "<link ")) {
    const char *end = strstr(link + 1, "<link ");
    char mass[200];
    int count;
    if (!end) end = text + strlen(text);
    const double volume = volume_of_plain(link, end, &count);
    bodies += count;
    assert_int_equal(attribute(link, end, "mass", "value", mass), count > 0);
    if (count) assert_true(fabs(strtod(mass, NULL) - 1000 * volume) < 1e-12);
  }
  assert_true(bodies >= 6); // a foot, three joints, two rods
  assert_non_null(strstr(text, " length=\"0.3\""));
  assert_non_null(strstr(text, " length=\"0.1\""));
  free(text);
}

// A tube without lids, a sheet, a flat mesh, and a curve do not enclose a volume.
static void open_shapes_have_no_mass(void **state) {
  (void)state;
  static const char *const open[] = {"extrude(circle(30), 100, caps: false)",
                                     "mesh([[0, 0, 0], [100, 0, 0], [0, 100, 0]], [[0, 1, 2]])",
                                     "revolve(polyline([[20, 0], [30, 50], [25, 90]]))"};
  const double water = 1000 * M_PI * 0.03 * 0.03 * 0.1;
  for (size_t i = 0; i < sizeof open / sizeof *open; i++) {
    char script[512];
    snprintf(script, sizeof script, "show robot([revolute(a: 100, shape: %s)])\n", open[i]);
    free(run(script, "open.urdf"));
    char *text = read_whole("open.urdf");
    assert_null(strstr(text, "<mass"));
    free(text);
    // Next to a body, it adds nothing, at any location.
    snprintf(script, sizeof script,
             "show robot([revolute(a: 100, shape: [cylinder(100, 30), translate(%s, [500, 0, "
             "0])])])\n",
             open[i]);
    free(run(script, "beside.urdf"));
    text = read_whole("beside.urdf");
    assert_true(fabs(number_after(text, "<mass value=\"") - water) < 1e-9 * water);
    free(text);
  }
}

static void rates_and_efforts_are_in_meters(void **state) {
  (void)state;
  static Robot robot;
  free(run("show robot([prismatic(limits: -100..250, speed: 400, effort: 70), revolute(limits: "
           "-90deg..45deg, speed: 90deg, effort: 12), revolute()])\n",
           "arm.urdf"));
  char *text = read_whole("arm.urdf");
  read_robot(text, &robot);
  const Joint *j = robot.joints;
  assert_true(fabs(j[0].low + 0.1) < 1e-15 && fabs(j[0].high - 0.25) < 1e-15);
  assert_true(fabs(j[0].velocity - 0.4) < 1e-15 && j[0].effort == 70);
  assert_true(fabs(j[1].low + M_PI / 2) < 1e-15 && fabs(j[1].high - M_PI / 4) < 1e-15);
  assert_true(fabs(j[1].velocity - M_PI / 2) < 1e-15 && j[1].effort == 12);
  assert_true(j[2].velocity > 0 && j[2].effort > 0); // present because the format requires them
  free(text);
}

// --- Invalid files ---

static const char *reason_of(const char *text, size_t size) {
  static CagError err;
  CagUrdfTree tree;
  CagUrdfRows rows = {0};
  size_t *chain = NULL, n = 0;
  CagStatus status = cag_urdf_read("test.urdf", text, size, &tree, &err);
  if (status == CAG_OK) status = cag_urdf_chain(&tree, NULL, NULL, &chain, &n, &err);
  if (status == CAG_OK) status = cag_urdf_rows(&tree, NULL, chain, n, true, &rows, &err);
  free(chain);
  cag_urdf_rows_free(&rows);
  cag_urdf_tree_free(&tree);
  return status == CAG_OK ? "ok" : cag_error_info(err.id)->reason;
}

#define LINKS "<link name=\"a\"/><link name=\"b\"/>"
#define ENDS "<parent link=\"a\"/><child link=\"b\"/>"

static void what_is_no_robot_is_refused(void **state) {
  (void)state;
  static const struct {
    const char *text, *reason;
  } cases[] = {
      {"<robot name=\"x\"><link name=\"a\"/></robot>", "ok"},
      {"", "urdf-syntax"},
      {"{}", "urdf-syntax"},
      {"<sdf/>", "urdf-syntax"},
      {"<robot/>", "urdf-syntax"},
      {"<robot><link/></robot>", "urdf-syntax"},
      {"<robot><link name=\"a\"/><link name=\"a\"/></robot>", "urdf-chain"},
      {"<robot>" LINKS "<joint name=\"j\" type=\"revolute\">" ENDS "</joint></robot>",
       "urdf-syntax"},
      {"<robot>" LINKS "<joint name=\"j\" type=\"hinge\">" ENDS "</joint></robot>", "urdf-joint"},
      {"<robot>" LINKS "<joint name=\"j\" type=\"planar\">" ENDS "</joint></robot>", "urdf-joint"},
      {"<robot>" LINKS "<joint name=\"j\" type=\"revolute\">" ENDS
       "<limit lower=\"2\" upper=\"1\"/></joint></robot>",
       "joint-limits"},
      {"<robot>" LINKS "<joint name=\"j\" type=\"continuous\">" ENDS
       "<axis xyz=\"0 0 0\"/></joint></robot>",
       "urdf-syntax"},
      {"<robot>" LINKS "<joint name=\"j\" type=\"fixed\">" ENDS
       "<origin xyz=\"1 2 nan\"/></joint></robot>",
       "urdf-syntax"},
      {"<robot>" LINKS "<joint name=\"j\" type=\"fixed\">" ENDS
       "<origin xyz=\"1e999 0 0\"/></joint></robot>",
       "urdf-syntax"},
      {"<robot>" LINKS "<joint name=\"j\" type=\"fixed\">" ENDS
       "<origin xyz=\"${l} 0 0\"/></joint></robot>",
       "urdf-syntax"},
      {"<robot>" LINKS "<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/><child "
       "link=\"c\"/></joint></robot>",
       "urdf-chain"},
      {"<robot>" LINKS "</robot>", "urdf-branches"},
      {"<robot>" LINKS "<joint name=\"j\" type=\"fixed\">" ENDS
       "</joint><joint name=\"k\" type=\"fixed\">" ENDS "</joint></robot>",
       "urdf-chain"},
      {"<robot>" LINKS "<joint name=\"j\" type=\"continuous\">" ENDS
       "<mimic joint=\"k\"/></joint></robot>",
       "urdf-joint"},
      {"<robot><link name=\"a\"><visual><geometry><box size=\"1 0 "
       "1\"/></geometry></visual></link></robot>",
       "urdf-syntax"},
      {"<robot><link name=\"a\"><visual/></link></robot>", "urdf-syntax"},
      {"<robot>" LINKS "<joint name=\"j\" type=\"fixed\">" ENDS
       "<origin xyz=\"1e300 0 0\"/></joint></robot>",
       "urdf-syntax"},
      {"<!DOCTYPE robot SYSTEM \"file:///etc/passwd\"><robot><link name=\"a\"/></robot>",
       "urdf-syntax"},
      {"<!DOCTYPE r [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;&a;&a;\">]><robot name=\"&b;\"><link "
       "name=\"a\"/></robot>",
       "urdf-syntax"},
      {"<robot name=\"&lol;\"><link name=\"a\"/></robot>", "urdf-syntax"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    if (strcmp(reason_of(cases[i].text, strlen(cases[i].text)), cases[i].reason) != 0)
      fail_msg("%s\nis %s", cases[i].text, reason_of(cases[i].text, strlen(cases[i].text)));
}

static void deep_and_large_files_are_refused(void **state) {
  (void)state;
  const size_t size = (size_t)17 << 20;
  char *text = malloc(size + 1);
  assert_non_null(text);
  for (size_t i = 0; i < size; i++) text[i] = "<a>"[i % 3];
  text[size] = 0;
  assert_string_equal(reason_of(text, 30000), "urdf-syntax"); // 10,000 deep
  assert_string_equal(reason_of(text, size), "urdf-syntax");
  free(text);
}

static void files_changed_by_chance_crash_nothing(void **state) {
  (void)state;
  char *text = calloc(1, 1 << 16), *changed = malloc(1 << 16);
  size_t good = 0;
  static const char letters[] = "<>\"/=0123456789.-e nairpyxzl\n&;";
  for (int i = 0; i < 4000; i++) {
    state_of_chance = (uint64_t)i;
    if (i % 100 == 0) write_any_robot(text, 4);
    size_t n = strlen(text);
    memcpy(changed, text, n + 1);
    for (int k = (int)chance(1, 5); k > 0; k--)
      changed[(size_t)chance(0, (double)n)] = letters[(size_t)chance(0, sizeof letters - 1)];
    if (i % 7 == 0) n = (size_t)chance(0, (double)n); // truncated
    changed[n] = 0;
    good += !strcmp(reason_of(changed, n), "ok");
  }
  assert_true(good > 0); // only digits changed
  free(text);
  free(changed);
}

static int make_folder(void **state) {
  (void)state;
  return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state) {
  (void)state;
  char command[100];
  snprintf(command, sizeof command, "rm -r '%s'", folder);
  return system(command);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_files_joints_lead_where_fk_leads),
      cmocka_unit_test(what_was_written_is_read_back),
      cmocka_unit_test(axes_in_any_direction_are_read),
      cmocka_unit_test(axes_that_are_almost_parallel_are_read),
      cmocka_unit_test(rows_are_read_as_rows),
      cmocka_unit_test(masses_are_those_of_the_shapes),
      cmocka_unit_test(plain_bodies_weigh_what_their_sizes_say),
      cmocka_unit_test(open_shapes_have_no_mass),
      cmocka_unit_test(rates_and_efforts_are_in_meters),
      cmocka_unit_test(what_is_no_robot_is_refused),
      cmocka_unit_test(deep_and_large_files_are_refused),
      cmocka_unit_test(files_changed_by_chance_crash_nothing),
  };
  return cmocka_run_group_tests_name("urdf", tests, make_folder, remove_folder);
}
