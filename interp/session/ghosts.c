// The structure of shapes: what they were before they were moved, the operands of set operations,
// and the curves, regions, and surfaces that other shapes were made of.
//
// A state of a shape is its value after one of its calls. It is kept as the geometry of the last
// state and a map, since calls only move it or give it attributes; a call that makes another shape
// ends the states, and starts those of its inputs. Coordinates are those of the call: an operand
// stands where the operation has it, and follows the operation's later moves.

#include "interp/session/ghosts.h"

#include <math.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/solid/csg.h"

enum { MOST_STATES = 20000, MOST_GHOSTS = 64 };
// Smaller turns are rounding errors, in radians.
#define SMALL_TURN 1e-12

// --- Walking ---

// A shape of which the states are added.
typedef struct Walk {
  CagGhosts *out;
  CagGhost like; // the geometry, the part, and the user
  const CagOrigin *origin;
  CagTransform context;
  bool root; // what is shown, or the value of a definition
} Walk;

static void walk_shape(const Walk *w);

static bool item_of_shape(CagValue v, CagItem *out) {
  static const int KINDS[] = {[CAG_CURVE] = CAG_ITEM_CURVE,
                              [CAG_REGION] = CAG_ITEM_REGION,
                              [CAG_SURFACE] = CAG_ITEM_SURFACE,
                              [CAG_SOLID] = CAG_ITEM_SOLID,
                              [CAG_MESH] = CAG_ITEM_MESH};
  if (v.type < CAG_CURVE || v.type > CAG_MESH) return false;
  const CagShape *shape = CAG_AS_SHAPE(v);
  *out =
      (CagItem){.kind = (CagItemKind)KINDS[v.type],
                .placement = v.type == CAG_REGION ? shape->placement[0] : cag_transform_identity(),
                .tolerance = shape->tolerance};
  out->as.curve = shape->as.curve; // the members of both unions are pointers to the geometry
  return true;
}

// The axis of a surface of revolution, in its coordinates.
static bool surface_axis(const CagSurface *s, CagVec3 *axis, CagVec3 *through) {
  const CagSurface *inner;
  const CagCurve *profile;
  CagTransform map = cag_transform_identity();
  double from, to;
  if (cag_surface_placed_view(s, &inner, &map)) s = inner;
  if (!cag_surface_revolution_view(s, &profile, axis, through, &from, &to)) return false;
  const CagVec3 end = cag_transform_point(&map, cag_add(*through, *axis));
  *through = cag_transform_point(&map, *through);
  *axis = cag_sub(end, *through);
  return true;
}

static void find_axis(const Walk *w, CagGhost *out) {
  const CagItem *item = &w->like.item;
  const bool solid = item->kind == CAG_ITEM_SOLID && item->as.solid->kind == CAG_SOLID_REVOLUTION;
  if (item->kind == CAG_ITEM_SURFACE)
    out->has_axis = surface_axis(item->as.surface, &out->axis, &out->through);
  for (size_t i = 0; solid && !out->has_axis && i < item->as.solid->face_count; i++)
    out->has_axis = surface_axis(item->as.solid->faces[i], &out->axis, &out->through);
  if (!out->has_axis) return;
  const CagVec3 end = cag_transform_point(&w->context, cag_add(out->through, out->axis));
  out->through = cag_transform_point(&w->context, out->through);
  out->axis = cag_sub(end, out->through);
}

// A plane profile that is revolved about a parallel of Z stands upright: [x, y] is [x, 0, y].
static bool stands_upright(const CagGhost *g, const CagTransform *context) {
  const CagItem *item = &g->item;
  CagTransform back;
  CagError ignored;
  const bool plane = (item->kind == CAG_ITEM_CURVE && item->as.curve->dimension == 2) ||
                     (item->kind == CAG_ITEM_REGION && item->placement.planar);
  if (!plane || !g->has_axis || cag_transform_inverse(context, &back, &ignored)) return false;
  const CagVec3 axis = cag_transform_vector(&back, g->axis);
  return hypot(axis.x, axis.y) < SMALL_TURN * fabs(axis.z);
}

static CagTransform upright(const CagTransform *context) {
  const CagTransform up = {.m = {{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}}};
  return cag_transform_multiply(context, &up);
}

// The inputs of a call; `context` has the coordinates of the call.
static void walk_inputs(const Walk *w, const CagOriginStep *step, const CagTransform *context) {
  const CagInputs *inputs = cag_step_inputs(step);
  for (size_t i = 0; inputs && i < inputs->count; i++) {
    const CagValue v = inputs->items[i].shape;
    Walk inner = {.out = w->out, .context = *context, .origin = &CAG_AS_SHAPE(v)->origin};
    if (!item_of_shape(v, &inner.like.item)) continue;
    inner.like.shape = CAG_AS_SHAPE(v);
    inner.like.part = w->like.part;
    inner.like.user = step;
    inner.like.parameter = inputs->items[i].parameter;
    find_axis(w, &inner.like);
    if (stands_upright(&inner.like, context)) inner.context = upright(context);
    walk_shape(&inner);
  }
}

static void walk_operand(const Walk *w, const CagOriginStep *step, const CagTransform *context,
                         const CagOrigin *origin, size_t i) {
  const CagSolidCore *core = w->like.item.as.solid->core;
  Walk inner = {.out = w->out, .context = *context, .origin = origin};
  inner.like.item = (CagItem){.kind = CAG_ITEM_SOLID,
                              .as.solid = core->operands[i],
                              .placement = cag_transform_identity(),
                              .tolerance = w->like.item.tolerance};
  inner.like.part = w->like.part;
  // Of operands that were united without a call of their own, the user is the call around it.
  inner.like.user = step ? step : w->like.user;
  inner.like.operand = step ? i : w->like.operand;
  inner.like.operand_count = step ? core->count : w->like.operand_count;
  walk_shape(&inner);
}

static void walk_operands(const Walk *w, const CagOriginStep *step) {
  const CagOperands *operands = w->origin->operands;
  const CagSolid *s = w->like.item.kind == CAG_ITEM_SOLID ? w->like.item.as.solid : NULL;
  if (!operands || !s || !s->core || s->core->count != operands->count) return;
  const CagTransform context = cag_transform_multiply(&w->context, &s->placement);
  CagOrigin *origins = cag_calloc(operands->count + 1, sizeof *origins);
  if (!origins) {
    w->out->failed = true;
    return;
  }
  cag_operands_list(operands, origins);
  for (size_t i = 0; i < operands->count; i++) walk_operand(w, step, &context, &origins[i], i);
  cag_free(origins);
}

static bool add_state(const Walk *w, const CagTransform *place, const CagOriginStep *step,
                      const CagOriginStep *next, bool shown) {
  CagGhosts *out = w->out;
  if (out->count == MOST_STATES) return false;
  out->failed = out->failed || !CAG_RESERVE(out->items, out->capacity, out->count + 1);
  if (out->failed) return false;
  CagGhost *g = &out->items[out->count++];
  *g = w->like;
  g->place = *place;
  g->context = w->context;
  g->step = step;
  g->next = next;
  g->last = w->origin->last;
  g->shown = shown;
  return true;
}

static bool is_identity(const CagTransform *t) {
  const CagTransform same = cag_transform_identity();
  return memcmp(t->m, same.m, sizeof t->m) == 0;
}

static void walk_shape(const Walk *w) {
  CagTransform place = w->context, undo = cag_transform_identity(), moves = w->context;
  const CagOriginStep *step = w->origin->last, *next = NULL, *shaped = NULL;
  bool shown = w->root && w->like.part != SIZE_MAX;
  CagError ignored;
  if (!step && !add_state(w, &place, NULL, NULL, shown)) return; // without a call of its own
  for (; step; next = step, step = step->before) {
    CagTransform back;
    if (next && next->kind == CAG_STEP_MOVED) {
      const CagTransform motion = cag_motion_transform(cag_step_motion(next));
      if (!is_identity(&motion)) shown = false;
      // A state that a projection has flattened is lost.
      if (cag_transform_inverse(&motion, &back, &ignored)) return;
      undo = cag_transform_multiply(&back, &undo);
      place = cag_transform_multiply(&w->context, &undo);
      moves = cag_transform_multiply(&moves, &motion);
    }
    if (!add_state(w, &place, step, next, shown)) return;
    if (step->kind != CAG_STEP_SHAPED) continue;
    shaped = step;
    walk_inputs(w, step, &moves);
    break;
  }
  walk_operands(w, shaped);
}

static void walk_value(const CagSession *s, CagValue v, CagGhosts *out) {
  if (v.type == CAG_LIST && CAG_AS_LIST(v)->dim == 0)
    for (size_t i = 0; i < CAG_AS_LIST(v)->length; i++)
      walk_value(s, CAG_AS_LIST(v)->as.items[i], out);
  if (v.type == CAG_GROUP) walk_value(s, cag_object(CAG_LIST, CAG_AS_SHAPE(v)->as.items), out);
  Walk w = {.out = out, .context = cag_transform_identity(), .root = true};
  if (out->count >= MOST_STATES || !item_of_shape(v, &w.like.item)) return;
  w.like.shape = CAG_AS_SHAPE(v);
  w.like.part = SIZE_MAX;
  w.origin = &w.like.shape->origin;
  walk_shape(&w);
}

void cag_ghosts_of_parts(const CagSession *s, CagGhosts *out) {
  for (size_t i = 0; i < s->scene.item_count; i++) {
    const CagItemSource *source = cag_session_item_source(s, &s->scene.items[i]);
    if (!source) continue;
    Walk w = {.out = out, .context = cag_transform_identity(), .root = true};
    w.like.item = s->scene.items[i];
    w.like.shape = source->shape;
    w.like.part = i;
    w.origin = &source->shape->origin;
    walk_shape(&w);
  }
}

void cag_ghosts_of_definitions(const CagSession *s, CagGhosts *out) {
  const CagVm *vm = s->vm;
  const CagModuleUnit *m = s->main < vm->module_count ? vm->modules[s->main] : NULL;
  for (size_t i = 0; m && m->ast && i < m->ast->top_count; i++) {
    const CagGlobal *g = &vm->globals[m->tops[i]];
    if (g->state == CAG_GLOBAL_DONE) walk_value(s, g->value, out);
  }
}

// --- What happens next ---

static void copy_vec(CagVec3 p, double out[3]) { out[0] = p.x, out[1] = p.y, out[2] = p.z; }

static void copy_rows(const CagTransform *t, double out[3][4]) {
  for (int i = 0; i < 3; i++) memcpy(out[i], t->m[i], 4 * sizeof(double));
}

// The direction of a vector under the context, at a point.
static CagVec3 direction_at(const CagTransform *t, CagVec3 at, CagVec3 v) {
  return cag_sub(cag_transform_point(t, cag_add(at, v)), cag_transform_point(t, at));
}

static void describe_motion(const CagGhost *g, CagGhostView *out) {
  const CagTransform t = cag_motion_transform(cag_step_motion(g->next));
  const CagVec3 step = {t.m[0][3], t.m[1][3], t.m[2][3]}, origin = {0, 0, 0};
  const CagTransform frame = cag_transform_multiply(&g->context, &t);
  CagTransformClass c;
  CagError ignored;
  copy_rows(&frame, out->frame);
  out->motion = "transform";
  if (!cag_transform_is_rigid(&t) || cag_transform_classify(&t, &c, &ignored)) return;
  // A translation is a turn by 0.
  if (!c.has_rotation || fabs(c.angle) < SMALL_TURN) {
    out->motion = "translate";
    copy_vec(direction_at(&g->context, origin, step), out->direction);
  } else if (!strcmp(c.fixed, "line") || (t.planar && !strcmp(c.fixed, "point"))) {
    out->motion = "rotate";
    copy_vec(cag_transform_point(&g->context, c.fixed_point), out->point);
    copy_vec(direction_at(&g->context, c.fixed_point, c.axis), out->direction);
    out->angle = c.angle * 180 / M_PI;
  }
}

// Attributes do nothing to a shape, so the next move counts.
static void describe_next(const CagGhost *g, CagGhostView *out) {
  CagGhost moved = *g;
  for (const CagOriginStep *step = g->last; step && step != g->step; step = step->before)
    if (step->kind == CAG_STEP_MOVED) moved.next = step; // ends with the first one
  if (moved.next && moved.next->kind == CAG_STEP_MOVED) describe_motion(&moved, out);
  else if (g->has_axis) {
    out->motion = "revolve";
    copy_vec(g->through, out->point);
    copy_vec(g->axis, out->direction);
  }
}

// --- Answers ---

typedef struct Finding {
  const char *file;
  size_t line, column;
  CagGhosts all;
  size_t *found, count;
} Finding;

static bool find_among(CagSession *s, Finding *f) {
  return cag_ghosts_at(s, &f->all, f->file, f->line, f->column, &f->found, &f->count);
}

static int find_ghosts(CagSession *s, void *context) {
  Finding *f = context;
  cag_ghosts_of_parts(s, &f->all);
  if (f->all.failed) return cag_session_fail_memory(s);
  if (find_among(s, f)) return CAG_STATUS_OK;
  cag_free(f->found);
  f->found = NULL;
  f->all.count = 0;
  cag_ghosts_of_definitions(s, &f->all);
  if (f->all.failed) return cag_session_fail_memory(s);
  find_among(s, f);
  return CAG_STATUS_OK;
}

static void place_mesh(const CagGhost *g, CagMeshView *m) {
  CagTransform own = cag_transform_identity();
  for (int i = 0; i < 3; i++) memcpy(own.m[i], m->placement[i], 4 * sizeof(double));
  own = cag_transform_multiply(&g->place, &own);
  copy_rows(&own, m->placement);
  m->placed = true;
}

static int give_ghost(CagSession *s, const CagGhost *g, bool (*has)(void *context, const char *id),
                      void (*give)(void *context, const CagGhostView *ghost,
                                   const CagMeshView *mesh),
                      void *context) {
  CagMeshView mesh;
  CagGhostView view = {.type = cag_session_item_type(&g->item),
                       .part = g->part < s->scene.item_count ? s->scene.items[g->part].name : NULL};
  if (g->step) view.place = cag_session_place(g->step->site->source, g->step->site->span);
  describe_next(g, &view);
  const int status = cag_session_item_mesh(s, &g->item, g->shape, 1, has, context, &mesh);
  if (status != CAG_STATUS_OK) return status;
  place_mesh(g, &mesh);
  give(context, &view, &mesh);
  return CAG_STATUS_OK;
}

static void free_finding(CagSession *s, Finding *f) {
  CagAccount *before = cag_account_lend(&s->vm->account);
  cag_free(f->found);
  cag_free(f->all.items);
  cag_account_lend(before);
}

int cag_session_ghosts(CagSession *s, const char *file, size_t line, size_t column,
                       bool (*has)(void *context, const char *id),
                       void (*give)(void *context, const CagGhostView *ghost,
                                    const CagMeshView *mesh),
                       void *context) {
  if (!cag_session_begin(s)) return CAG_STATUS_USAGE;
  if (!s->has_scene) return cag_session_end(s, CAG_STATUS_USAGE);
  Finding f = {.file = file, .line = line, .column = column};
  int status = cag_session_geometry(s, find_ghosts, &f);
  for (size_t i = 0, given = 0; status == CAG_STATUS_OK && i < f.count; i++) {
    const CagGhost *g = &f.all.items[f.found[i]];
    if (g->shown || given++ >= MOST_GHOSTS) continue;
    status = give_ghost(s, g, has, give, context);
    // A half space, for example, has no mesh.
    if (status == CAG_STATUS_SCRIPT) status = CAG_STATUS_OK;
  }
  free_finding(s, &f);
  return cag_session_end(s, status);
}
