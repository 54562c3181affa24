// Calls every built-in with extreme and invalid arguments, and runs scripts of the repository with
// changed words.
//
//     fuzz [ROUNDS [SEED [NAME]]]
//
// Each row of the tables of built-ins is called ROUNDS times (default 2) with random arguments from
// pools of extreme and invalid values. Then scripts of tests/language and examples run with some of
// their words removed, doubled, exchanged, or replaced by such values. SEED (default 1) makes a run
// reproducible. NAME restricts it to one built-in. A script passes if it ends by itself, within
// limits of time and memory, with an error of a known kind or with output without undefined
// numbers. Scripts run in child processes: a crash or a hang affects only one script, which is
// shown.

#include <ctype.h>
#include <glob.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cag.h"
#include "interp/vm/builtin.h"

// Limits of one script. An error must occur within HANG seconds, which includes a margin for
// sanitizers.
#define SECONDS 0.5
#define MEMORY ((size_t)256 << 20)
#define TRIANGLES 50000
#define HANG 60
#define LONGEST 16384 // bytes of one script
#define MUTATIONS 120 // mutated scripts in each round

// --- Random numbers ---

typedef struct Draws {
  uint64_t state;
} Draws;

static size_t draw(Draws *d, size_t n) {
  d->state += 0x9e3779b97f4a7c15u; // splitmix64
  uint64_t z = d->state;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return (size_t)((z ^ (z >> 31)) % n);
}

#define PICK(d, pool) (pool)[draw(d, sizeof(pool) / sizeof *(pool))]

// --- Values ---

static const char *const numbers[] = {"0",    "-0",    "1",    "2",     "3",      "-1",     "0.5",
                                      "7",    "inf",   "-inf", "1e308", "-1e308", "1e-308", "1e20",
                                      "1e-9", "1e100", "2^53", "0.1",   "-3.7",   "60"};
static const char *const angles[] = {"0deg",      "90deg", "-90deg", "360deg", "1e300deg",
                                     "1e-300deg", "30deg", "180deg", "1turn",  "725deg"};
static const char *const texts[] = {"\"\"",          "\"open\"",     "\"chord\"",        "\"z\"",
                                    "\"x\\u{3b8}\"", "\"periodic\"", "\"no such word\"", "\"zyx\"",
                                    "\"1e999\""};
static const char *const lists[] = {"[]",
                                    "[[]]",
                                    "[[[]]]",
                                    "[0]",
                                    "[0, 0]",
                                    "[0, 0, 0]",
                                    "[1, 2, 3]",
                                    "[inf, 0]",
                                    "[1e308, -1e308]",
                                    "[1e200, 1e200, 1e200]",
                                    "[[0, 0], [0, 0]]",
                                    "[[0, 0], [1, 1], [2, 2]]",
                                    "[[0, 0, 0]]",
                                    "[[0, 0], [1, 2], [3, 1], [4, 4]]",
                                    "[[0, 0], [1, 2], [1, 2], [1, 2], [3, 1]]",
                                    "[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]",
                                    "[0, 0, 0, 0, 1, 1, 1, 1]",
                                    "[0, 1, 1, 1, 1, 0]",
                                    "[1, 1, 1, 1]",
                                    "[1, 0, 0, 1]",
                                    "[0, 0, 0, 0]",
                                    "[1, -1, 1, -1]",
                                    "[\"a\", 1, none]",
                                    "[[1, 2], [3]]",
                                    "[[1, 0, 0], [0, 1, 0], [0, 0, 1]]",
                                    "[[1, 2], [2, 4]]",
                                    "[1, 0, 1, 0, 0, -1]",
                                    "[1, 1, 1, 0, 0, 0, 0, 0, 0, -1]",
                                    "[for i in 0..999: [i, i % 7]]",
                                    "[for i in 0..3: [for j in 0..3: [i, j, i * j]]]",
                                    "[for i in 0..3: [for j in 0..3: [0, 0, 0]]]",
                                    "[1e-308, 1e-308]",
                                    "X",
                                    "Z"};
static const char *const ranges[] = {"0..1",           "1..0",          "0..0",         "0..inf",
                                     "-inf..inf",      "0..1 by 0",     "0deg..360deg", "0..1e9",
                                     "0..1 by 1e-300", "1e308..-1e308", "0deg..0deg",   "-1..1"};
static const char *const records[] = {
    "{}",        "{a: 1}",  "{x: {y: {z: []}}}", "{point: [0, 0], direction: [0, 0]}",
    "relaxed()", "cyclic()"};
static const char *const functions[] = {"x => x",
                                        "(a, b) => a + b",
                                        "() => 1",
                                        "x => [x, x^2]",
                                        "x => [cos(x), sin(x), x]",
                                        "x => 1 / 0",
                                        "x => error(\"no\")",
                                        "(u, v) => [u, v, u * v]",
                                        "x => \"a\"",
                                        "sin",
                                        "x => inf",
                                        "x => if x < 0.5 then [0, 0] else [1, 1]"};
static const char *const transforms[] = {
    "identity",
    "rotate(30deg)",
    "translate([1, 2, 3])",
    "scale(1e-150)",
    "scale(1e150)",
    "transform([[1, 2], [2, 4]])",
    "transform([[1, 0, 0], [0, 1, 0], [1, 1, 1]], kind: \"plane\")",
    "reflect_point([0, 0])",
    "rotate(Z, 90deg)"};
static const char *const curves[] = {
    "line([0, 0], [1, 1])",
    "line([0, 0], [0, 0])",
    "circle(1)",
    "circle(1e-200)",
    "circle(1e99)",
    "arc(2, 0deg..90deg)",
    "bezier([[0, 0], [1, 2], [3, 1]])",
    "bezier([[1, 1], [1, 1], [1, 1]])",
    "bezier([[0, 0, 0], [1, 0, 1], [2, 1, 0], [0, 0, 5]])",
    "bspline([[0, 0], [1, 1], [2, 0], [3, 1], [4, 0]])",
    "bspline([[0, 0], [1, 1], [2, 0], [3, 1]], closed: true)",
    "nurbs([[0, 0], [1, 2], [1, 2], [3, 0]], degree: 2, weights: [1, 0, 0, 1])",
    "polyline([[0, 0], [1, 0], [1, 0], [0, 0]])",
    "polyline([[0, 0], [4, 0], [4, 4]], closed: true)",
    "helix(1, 1, 2)",
    "ellipse(1e50, 1e-50)",
    "parabola(1, 0..2)",
    "curve(t => [t, t^2], 0..1)",
    "curve(t => [0, 0], 0..1)",
    "curve(t => [t, 1 / t], 0..1)",
    "conic([1, 0, 1, 0, 0, 1])",
    "conic([1, 0, -1, 0, 0, 0])",
    "join_curves(line([0, 0], [1, 0]), line([1, 0], [1, 1]))",
    "cubic_spline([[0, 0], [1, 2], [3, 1]])",
    "natural_curve(s => s, 3)",
    "curve(t => if t < 0.5 then [t, 0] else [t, 1], 0..1)"};
static const char *const regions[] = {
    "rectangle(2, 3)", "regular_polygon(3, 1)", "region(circle(1))", "rectangle(1e-200, 1)",
    "polygon([[0, 0], [4, 0], [4, 4], [0, 4]], holes: [[[1, 1], [2, 1], [2, 2]]])"};
static const char *const surfaces[] = {
    "bilinear([0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 1])",
    "bilinear([0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0])",
    "sphere_surface(1)",
    "torus_surface(2, 1)",
    "surface((u, v) => [u, v, u * v])",
    "surface((u, v) => [0, 0, 0])",
    "revolve(line([1, 0], [1, 5]))",
    "bezier_surface([for i in 0..2: [for j in 0..2: [i, j, i * j]]])",
    "ellipsoid(1, 2, 1e-9)",
    "quadric([1, 1, -1, 0, 0, 0, 0, 0, 0, -1], within: -1..1)"};
static const char *const solids[] = {"box(1)",
                                     "sphere(1)",
                                     "sphere(1e-40)",
                                     "cylinder(2, 1)",
                                     "torus(2, 1)",
                                     "box(2) - sphere(1)",
                                     "half_space(plane(origin, Z))",
                                     "box(1) - box(1)"};
static const char *const meshes[] = {"mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])",
                                     "convex_hull([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])"};
static const char *const planes[] = {"plane(origin, Z)", "plane([1, 2, 3], [1, 1, 1])",
                                     "plane([0, 0, 1, 1e300])"};
static const char *const robots[] = {
    "robot([revolute(a: 1), revolute(a: 1)])", "robot([prismatic(limits: 0..1)])",
    "robot([revolute(alpha: 90deg), revolute(a: 300), revolute(a: 100)])"};
static const char *const images[] = {"image([[1]])",
                                     "image([[0, 0], [0, 0]])",
                                     "image([[none, 1], [2, none]])",
                                     "image([[1, -1, inf]])",
                                     "image([[[1, 2, 3], [4, 5, 6]]])",
                                     "image(9, 7, (x, y) => if x > y then 1 else 0)",
                                     "image(16, 16, (x, y) => x*y)",
                                     "image([[1e308, 1e308, -1e308], [1e-308, 0, 0.1]])",
                                     "enlarge(image([[1e308, -1]]), 300)"};
static const char *const cameras[] = {
    "camera([1, 2, 3], size: [5, 4])",
    "camera([1e150, 0, 0], size: [3, 3])",
    "camera([9, 9, 9], kind: \"orthographic\", size: [4, 4])",
    "pinhole(look_at([0, 0, 9], origin, Y), 1, 0.1, [7, 5])",
    "pinhole(identity, 1e-9, 1e9, [2, 3])",
    "pinhole(look_at([0, 0, 9], origin, Y), 5, 0.1, [1, 1]) |> reflect(X)"};
static const char *const lights[] = {"sun(-Z)", "point_light([0, 0, 9], strength: 1e308)",
                                     "spot_light([0, 0, 9], origin, angle: 1e-9deg)",
                                     "area_light([0, 0, 9], origin, 5)",
                                     "[sun(X), point_light([1e200, 0, 0])]"};
static const char *const scenes[] = {"[sphere(2), sun(-Z)]",
                                     "[box(1), torus(3, 1), camera([9, 9, 9])]",
                                     "difference(box(2), sphere(1), cylinder(9, 0.1))",
                                     "half_space(plane(origin, Z)) & sphere(3)",
                                     "[half_space(plane([0, 0, -5], Z)), cone(3, 1)]",
                                     "scale([1, 2, 3]) * union(torus(3, 1), cylinder(2, 1))",
                                     "scale([1, 1e-9, 1]) * torus(3, 1)"};
static const char *const others[] = {"none",
                                     "true",
                                     "false",
                                     "revolute(a: 1)",
                                     "prismatic(limits: 0..1)",
                                     "camera([1, 2, 3])",
                                     "sun([0, 0, -1])",
                                     "group(box(1), circle(1))",
                                     "group([])",
                                     "sky(\"white\")",
                                     "pi",
                                     "sin"};

typedef struct Pool {
  CagType type;
  const char *const *values;
  size_t count;
} Pool;

#define POOL(type, values)                                                                         \
  { type, values, sizeof(values) / sizeof *(values) }
static const Pool pools[] = {
    POOL(CAG_NUMBER, numbers),    POOL(CAG_ANGLE, angles),         POOL(CAG_TEXT, texts),
    POOL(CAG_LIST, lists),        POOL(CAG_RANGE, ranges),         POOL(CAG_RECORD, records),
    POOL(CAG_CLOSURE, functions), POOL(CAG_TRANSFORM, transforms), POOL(CAG_CURVE, curves),
    POOL(CAG_REGION, regions),    POOL(CAG_SURFACE, surfaces),     POOL(CAG_SOLID, solids),
    POOL(CAG_MESH, meshes),       POOL(CAG_PLANE, planes),         POOL(CAG_ROBOT, robots),
    POOL(CAG_IMAGE, images),      POOL(CAG_NONE, others)};
#define POOL_COUNT (sizeof pools / sizeof *pools)

static const char *any_value(Draws *d) {
  const Pool *p = &pools[draw(d, POOL_COUNT)];
  return p->values[draw(d, p->count)];
}

// Usually of a type that the first argument may have.
static const char *first_value(Draws *d, uint64_t mask) {
  for (int tries = 0; mask && tries < 40; tries++) {
    const Pool *p = &pools[draw(d, POOL_COUNT)];
    if (mask & ((uint64_t)1 << p->type)) return p->values[draw(d, p->count)];
  }
  return any_value(d);
}

// Usually a number, an angle, or a list, because most arguments are.
static const char *further_value(Draws *d) {
  switch (draw(d, 6)) {
  case 0: return PICK(d, angles);
  case 1: return PICK(d, lists);
  case 2:
  case 3: return PICK(d, numbers);
  default: return any_value(d);
  }
}

// Parameters whose words begin like this usually get a value of that type.
static const struct {
  const char *word;
  const char *const *values;
  size_t count;
} typed[] = {{"camera", cameras, sizeof cameras / sizeof *cameras},
             {"light", lights, sizeof lights / sizeof *lights},
             {"plane", planes, sizeof planes / sizeof *planes},
             {"transform", transforms, sizeof transforms / sizeof *transforms},
             {"shape or robot", scenes, sizeof scenes / sizeof *scenes}};

static const char *argument_value(Draws *d, const CagBuiltin *row, const CagSignature *s,
                                  size_t i) {
  for (size_t k = 0; k < sizeof typed / sizeof *typed; k++)
    if (!strncmp(s->words[i], typed[k].word, strlen(typed[k].word)) && draw(d, 4) > 0)
      return typed[k].values[draw(d, typed[k].count)];
  return i == 0 ? first_value(d, row->first) : further_value(d);
}

// --- Scripts ---

static void write_call(Draws *d, const CagBuiltin *row, const CagSignature *s, char *out) {
  size_t at = (size_t)snprintf(out, LONGEST, "print %s(", s->name);
  size_t given = s->required + draw(d, s->count - s->required + 1);
  bool named = false;
  for (size_t i = 0; i < given && at < LONGEST / 2; i++) {
    const char *value = argument_value(d, row, s, i);
    named = named || (i >= s->required && !s->positional_only[i] && draw(d, 3) == 0);
    if (named && s->positional_only[i]) break;
    at += (size_t)snprintf(out + at, LONGEST - at, "%s%s%s%s", i ? ", " : "",
                           named ? s->parameters[i] : "", named ? ": " : "", value);
  }
  for (size_t i = draw(d, 3); s->variadic && !named && i > 0; i--)
    at += (size_t)snprintf(out + at, LONGEST - at, ", %s", first_value(d, row->first));
  snprintf(out + at, LONGEST - at, ")\n");
}

static size_t word_end(const char *text, size_t at, size_t n) {
  size_t end = at + 1;
  if (isalnum((unsigned char)text[at]) || text[at] == '_')
    while (end < n && (isalnum((unsigned char)text[end]) || text[end] == '_')) end++;
  return end;
}

// Changes one word: removes it, doubles it, or replaces it by a value or another word of the
// script.
static size_t change(Draws *d, char *text, size_t n) {
  if (n < 2) return n;
  size_t from = draw(d, n), to = word_end(text, from, n), other = draw(d, n);
  char piece[256];
  size_t length = 0;
  switch (draw(d, 4)) {
  case 0: break;
  case 1:
    length = (size_t)snprintf(piece, sizeof piece, "%.*s %.*s", (int)(to - from), text + from,
                              (int)(to - from), text + from);
    break;
  case 2: length = (size_t)snprintf(piece, sizeof piece, "%s", any_value(d)); break;
  default:
    length = (size_t)snprintf(piece, sizeof piece, "%.*s", (int)(word_end(text, other, n) - other),
                              text + other);
  }
  if (length >= sizeof piece) length = sizeof piece - 1;
  if (n - (to - from) + length >= LONGEST) return n;
  memmove(text + from + length, text + to, n - to);
  memcpy(text + from, piece, length);
  return n - (to - from) + length;
}

static bool read_script(const char *path, char *out, size_t *n) {
  FILE *f = fopen(path, "rb");
  if (!f) return false;
  *n = fread(out, 1, LONGEST / 2, f);
  fclose(f);
  return true;
}

// --- Running ---

// Memory shared by a child and its parent: the script that runs, and its position in the sequence.
typedef struct Shared {
  size_t next, failed;
  uint64_t state;
  char script[LONGEST];
} Shared;

// Whether the text contains the word nan, not as part of a longer word.
static bool undefined(const char *text) {
  for (const char *s = strstr(text, "nan"); s; s = strstr(s + 1, "nan"))
    if ((s == text || !isalpha((unsigned char)s[-1])) && !isalpha((unsigned char)s[3])) return true;
  return false;
}

static const char *judge(CagSession *s, int status, const char *output, bool strict) {
  if (status == CAG_STATUS_OK)
    return strict && undefined(output) ? "an undefined number is printed" : NULL;
  if (cag_session_error_count(s) == 0) return "it fails without an error";
  for (size_t i = 0; i < cag_session_error_count(s); i++) {
    CagErrorView e;
    cag_session_error(s, i, &e);
    if (!e.code || strcmp(e.code, "E0000") == 0 || strcmp(e.code, "E0399") == 0)
      return "an error without a code";
    // error("") has the text of the script.
    if ((!e.message || !*e.message) && strcmp(e.code, "E0313") != 0)
      return "an error without words";
  }
  return NULL;
}

static void complain(const char *what, const char *script) {
  printf("--- %s:\n%s\n", what, script);
  fflush(stdout);
}

static void run_script(Shared *shared, size_t length, bool strict) {
  CagSessionOptions options;
  char *output = NULL;
  size_t size = 0;
  cag_session_options_init(&options);
  options.max_time = SECONDS;
  options.max_memory = MEMORY;
  options.max_triangles = TRIANGLES;
  options.out = open_memstream(&output, &size);
  options.messages = fopen("/dev/null", "w");
  CagSession *s = cag_session_new(&options);
  alarm(HANG);
  int status = cag_session_run_text(s, "tests/language/fuzz.cag", shared->script, length);
  alarm(0);
  fclose(options.out);
  fclose(options.messages);
  const char *wrong = judge(s, status, output, strict);
  if (wrong) {
    shared->failed++;
    complain(wrong, shared->script);
  }
  cag_session_free(s);
  free(output);
}

// Runs the rows in each round, then the mutations. Continues where the last child ended.
static size_t calls, mutations;

typedef struct Row {
  const CagBuiltin *row;
  const CagSignature *signature;
} Row;

static void run_from(Shared *shared, const Row *rows, size_t count, const glob_t *scripts) {
  while (shared->next < calls + mutations) {
    size_t i = shared->next++, length;
    Draws d = {shared->state + i * 0x2545f4914f6cdd1du};
    bool call = i < calls;
    if (call) {
      write_call(&d, rows[i % count].row, rows[i % count].signature, shared->script);
      length = strlen(shared->script);
    } else {
      if (!read_script(scripts->gl_pathv[draw(&d, scripts->gl_pathc)], shared->script, &length))
        continue;
      for (size_t k = 1 + draw(&d, 4); k > 0; k--) length = change(&d, shared->script, length);
      shared->script[length] = 0;
    }
    run_script(shared, length, call);
  }
}

// Collects rows with arguments, optionally of one name.
static size_t gather(Row *out, const char *name) {
  size_t n = 0;
  for (size_t i = 0; i < cag_builtin_count(); i++) {
    size_t rows;
    const CagBuiltin *row = cag_builtin_rows(i, &rows);
    for (size_t k = 0; k < rows; k++) {
      const CagSignature *s = cag_builtin_signature(i, k);
      if (!s || (name && strcmp(name, s->name) != 0)) continue;
      if (out) out[n] = (Row){row + k, s};
      n++;
    }
  }
  return n;
}

int main(int argc, char **argv) {
  size_t rounds = argc > 1 ? strtoul(argv[1], NULL, 10) : 2;
  const char *name = argc > 3 ? argv[3] : NULL;
  size_t count = gather(NULL, name);
  Row *rows = calloc(count + 1, sizeof *rows);
  Shared *shared =
      mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  glob_t scripts;
  if (!rows || count == 0 || shared == MAP_FAILED) return 2;
  gather(rows, name);
  glob("tests/language/[!l]*/*.cag", 0, NULL, &scripts);
  glob("examples/*.cag", GLOB_APPEND, NULL, &scripts);
  calls = count * rounds;
  mutations = name || scripts.gl_pathc == 0 ? 0 : rounds * MUTATIONS;
  shared->state = argc > 2 ? strtoull(argv[2], NULL, 10) : 1;
  setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0});
  while (shared->next < calls + mutations) {
    fflush(stdout);
    pid_t child = fork();
    if (child < 0) return 2;
    if (child == 0) {
      run_from(shared, rows, count, &scripts);
      exit(0); // sanitizers detect memory leaks here
    }
    int status;
    waitpid(child, &status, 0);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) continue;
    shared->failed++;
    complain(WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM ? "it does not end" : "a crash",
             shared->script);
  }
  printf("%zu passed, %zu failed, 0 skipped\n", calls + mutations - shared->failed, shared->failed);
  free(rows);
  globfree(&scripts);
  return shared->failed > 0;
}
