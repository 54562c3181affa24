// The tree of calls is walked from the shape that is shown to those that it was made of. The map
// from the coordinates of a call to the scene is built on the way.

#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "interp/session/points.h"
#include "interp/vm/origin.h"

// The most spots and steps of one part: values that share parts may have trees of any size.
enum { MOST_SPOTS = 4000, MOST_STEPS = 20000, MOST_DEPTH = 200 };
#define MOST_IN_LIST (CAG_ORIGIN_NUMBERS / 2)

typedef struct Walk {
  CagVm *vm;
  CagPointSpots *out;
  bool literals;
  size_t steps;
  int depth;
} Walk;

// The map between a step and the scene. A revolution places a plane [x, y] as [x, 0, y]: `lifted`
// tells that one follows, between `inner` and `outer`.
typedef struct Frame {
  CagTransform outer, inner;
  bool lifted;
} Frame;

static CagTransform frame_map(const Frame *f, int dimension) {
  const bool lift = f->lifted && dimension == 2 && f->inner.planar;
  if (!lift) return cag_transform_multiply(&f->outer, &f->inner);
  CagTransform upright = {.m = {{1, 0, 0, 0}, {0, 0, 1, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}}};
  upright = cag_transform_multiply(&upright, &f->inner);
  return cag_transform_multiply(&f->outer, &upright);
}

CagVec3 cag_point_spot_at(const CagPointSpot *p) {
  return cag_transform_point(&p->map, cag_vec3(p->values[0], p->values[1], p->values[2]));
}

// --- Points of one call ---

static void add_spot(Walk *w, const CagOriginStep *step, const Frame *f, const double *x,
                     size_t dimension, CagLiteral literal) {
  CagPointSpots *out = w->out;
  if (out->count >= MOST_SPOTS) return;
  if (!CAG_RESERVE(out->items, out->capacity, out->count + 1)) cag_vm_out_of_memory(w->vm);
  CagPointSpot *p = &out->items[out->count++];
  *p = (CagPointSpot){.step = step,
                      .function = cag_builtin_name(step->site->index),
                      .map = frame_map(f, (int)dimension),
                      .dimension = (int)dimension,
                      .literal = literal};
  for (size_t i = 0; i < dimension; i++) p->values[i] = x[i];
}

static bool is_point_list(const CagList *list) { return list->dim == 2 || list->dim == 3; }

static void add_points(Walk *w, const CagOriginStep *step, const Frame *f, const CagList *list,
                       CagLiteral literal) {
  CagLiteral found[MOST_IN_LIST] = {{0}};
  if (list->length > MOST_IN_LIST) return;
  if (w->literals) cag_literal_elements(w->vm, literal, list->length, found);
  for (size_t i = 0; i < list->length; i++) {
    const CagValue point = cag_list_get(w->vm, list, i);
    const double *x;
    size_t n;
    if (cag_as_vector(point, &x, &n) && (n == 2 || n == 3)) add_spot(w, step, f, x, n, found[i]);
  }
}

static void add_rows(Walk *w, const CagOriginStep *step, const Frame *f, const CagList *rows,
                     CagLiteral literal) {
  CagLiteral found[MOST_IN_LIST] = {{0}};
  if (rows->dim != 0 || rows->length > MOST_IN_LIST) return;
  if (w->literals) cag_literal_elements(w->vm, literal, rows->length, found);
  for (size_t i = 0; i < rows->length; i++) {
    const CagValue row = rows->as.items[i];
    if (row.type == CAG_LIST && is_point_list(CAG_AS_LIST(row)))
      add_points(w, step, f, CAG_AS_LIST(row), found[i]);
  }
}

// Whether a type, as a signature has it, has this alternative.
static bool has_alternative(const char *words, const char *wanted) {
  const size_t n = strlen(wanted);
  for (const char *at = words; at; at = strstr(at, " or ")) {
    if (at != words) at += strlen(" or ");
    if (!strncmp(at, wanted, n) && (!at[n] || !strncmp(at + n, " or ", 4))) return true;
  }
  return false;
}

// The points in one argument.
static void add_argument(Walk *w, const CagOriginStep *step, const Frame *f, size_t k,
                         const char *words) {
  const CagValue v = step->call[0]->values[k];
  const double *x;
  size_t n;
  if (v.type != CAG_LIST) return;
  const CagList *list = CAG_AS_LIST(v);
  const CagLiteral literal =
      w->literals ? cag_literal_of_argument(w->vm, step, k) : (CagLiteral){0};
  if (has_alternative(words, "point") && cag_as_vector(v, &x, &n) && (n == 2 || n == 3))
    add_spot(w, step, f, x, n, literal);
  else if (has_alternative(words, "list of points") && list->dim != 1)
    add_points(w, step, f, list, literal);
  else if (has_alternative(words, "list of rows of points")) add_rows(w, step, f, list, literal);
}

// Calls that only move shapes or give them attributes have no points.
static void add_call(Walk *w, const CagOriginStep *step, const Frame *f) {
  const CagOriginCall *call = cag_step_call(step);
  if (!call) return;
  const CagSignature *s = cag_builtin_signature_of(step->site->row);
  if (!s || !strncmp(step->site->row->result, "as ", 3)) return;
  const size_t count = call->count < s->count ? call->count : s->count;
  for (size_t k = 0; k < count; k++) add_argument(w, step, f, k, s->words[k]);
}

// The vector of a translation is a point of the scene after it.
static void add_translation(Walk *w, const CagOriginStep *step, const Frame *f) {
  double x[3];
  const CagMotionNote *motion = cag_step_motion(step);
  const size_t n = motion ? cag_motion_vector(motion, x) : 0;
  if (n == 0) return;
  add_spot(w, step, f, x, n,
           w->literals ? cag_literal_of_argument(w->vm, step, 1) : (CagLiteral){0});
}

// --- Steps ---

static void walk_chain(Walk *w, const CagOriginStep *step, Frame f);

// The other shapes that a call had.
static void walk_operands(Walk *w, CagValue v, const Frame *f) {
  if (v.type == CAG_INTERNAL) walk_chain(w, (const CagOriginStep *)v.as.object, *f);
  if (v.type != CAG_LIST || CAG_AS_LIST(v)->dim != 0) return;
  const CagList *list = CAG_AS_LIST(v);
  for (size_t i = 0; i < list->length; i++) walk_operands(w, list->as.items[i], f);
}

// Whether a call moves each point of its first shape in its own way, so that the points before it
// are nowhere in the scene.
static bool bends(const char *function) {
  static const char *const NAMES[] = {"sweep", "sweep_by", "remap"};
  for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES; i++)
    if (!strcmp(function, NAMES[i])) return true;
  return false;
}

static bool is_upright_axis(const CagOriginCall *call) {
  const double *x;
  size_t n;
  if (!call || call->count < 2 || call->values[1].type == CAG_UNSET) return true;
  return cag_as_vector(call->values[1], &x, &n) && n == 3 && x[0] == 0 && x[1] == 0;
}

static void walk_chain(Walk *w, const CagOriginStep *step, Frame f) {
  if (++w->depth > MOST_DEPTH) step = NULL;
  for (; step && ++w->steps <= MOST_STEPS; step = step->before) {
    const char *function =
        step->site->row ? cag_builtin_name(step->site->index) : ""; // an operator
    const CagOriginCall *call = cag_step_call(step);
    add_translation(w, step, &f);
    if (!strcmp(function, "revolve") && is_upright_axis(call) && !f.lifted) {
      f.outer = cag_transform_multiply(&f.outer, &f.inner);
      f.inner = cag_transform_identity();
      f.lifted = true;
    }
    if (cag_step_motion(step)) {
      const CagTransform motion = cag_motion_transform(cag_step_motion(step));
      f.inner = cag_transform_multiply(&f.inner, &motion);
    }
    if (!bends(function)) add_call(w, step, &f);
    for (size_t i = 0; call && i < call->count; i++)
      if (i > 0 || !bends(function)) walk_operands(w, call->values[i], &f);
    if (bends(function)) break;
  }
  w->depth--;
}

void cag_point_spots(CagVm *vm, const CagShape *shape, bool literals, CagPointSpots *out) {
  Walk w = {.vm = vm, .out = out, .literals = literals};
  Frame f = {.outer = cag_transform_identity(), .inner = cag_transform_identity()};
  out->count = 0;
  walk_chain(&w, shape->origin.last, f);
}
