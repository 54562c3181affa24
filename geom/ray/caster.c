#include "geom/ray/caster.h"

#include "base/memory.h"
#include "base/stop.h"
#include "geom/linalg/tolerance.h"
#include "geom/ray/bvh_walk.h"
#include "geom/ray/caster_parts.h"
#include "geom/solid/csg.h"
#include "geom/solid/kind.h"

// Crossings closer than this fraction of the size are at one point: faces that share an edge, and
// faces of operands that coincide.
#define SAME_POINT 1e-10
// Where a ray meets the faces of a solid in an order that no solid has, because it passes between
// two that meet to a tolerance only, or touches one, it is moved by this fraction of the size.
#define NUDGE 1e-8
enum { NUDGES = 6 };
// Operands are found by a hierarchy of their boxes if there are more.
enum { FEW_OPERANDS = 6 };

// --- Making ---

void cag_caster_free(CagCaster *c) {
  if (!c) return;
  for (size_t i = 0; i < c->face_count; i++) cag_ray_patch_free(c->faces[i]);
  cag_free(c->faces);
  cag_ray_mesh_free(c->mesh);
  cag_ray_primitive_free(&c->primitive);
  if (c->image) cag_solid_release(c->image);
  for (size_t i = 0; i < c->operand_count; i++) cag_caster_free(c->operands[i]);
  cag_free(c->operands);
  cag_bvh_free(&c->boxes);
  cag_free(c);
}

static CagStatus caster_new(CagCasterKind kind, CagCaster **out, CagError *err) {
  CagCaster *c = cag_calloc(1, sizeof *c);
  if (!c) return cag_fail_memory(err);
  c->kind = kind;
  c->bounds = CAG_BOUNDS_EMPTY;
  *out = c;
  return CAG_OK;
}

static void bounds_join(CagBounds *a, const CagBounds *b) {
  if (!(b->min.x <= b->max.x)) return;
  cag_bounds_add(a, b->min);
  cag_bounds_add(a, b->max);
}

static CagBounds moved_bounds(const CagBounds *b, const CagTransform *t) {
  CagBounds out = CAG_BOUNDS_EMPTY;
  for (int k = 0; k < 8 && b->min.x <= b->max.x; k++)
    cag_bounds_add(&out, cag_transform_point(t, cag_vec3(k & 1 ? b->max.x : b->min.x,
                                                         k & 2 ? b->max.y : b->min.y,
                                                         k & 4 ? b->max.z : b->min.z)));
  return out;
}

static void find_size(CagCaster *c) {
  const double size = cag_norm(cag_sub(c->bounds.max, c->bounds.min));
  c->size = isfinite(size) ? size : 0;
}

static bool is_identity(const CagTransform *t) {
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      if (t->m[i][j] != (i == j)) return false;
  return true;
}

// Places FACES or a MESH whose own coordinates are mapped to the world by `to_world`.
static CagStatus place_caster(CagCaster *c, const CagTransform *to_world, CagError *err) {
  find_size(c);
  if (is_identity(to_world)) return CAG_OK;
  c->placed = true;
  c->bounds = moved_bounds(&c->bounds, to_world);
  find_size(c);
  return cag_transform_inverse(to_world, &c->back, err);
}

static CagStatus faces_of(CagSurface *const *faces, size_t n, CagCaster **out, CagError *err) {
  CagCaster *c = NULL;
  CagStatus status = caster_new(CAG_CASTER_FACES, &c, err);
  if (status) return status;
  c->faces = cag_calloc(n + 1, sizeof *c->faces);
  if (!c->faces) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++) {
    status = cag_ray_patch_new(faces[i], &c->faces[i], err);
    if (status) break;
    c->face_count++;
    bounds_join(&c->bounds, &c->faces[i]->bounds);
  }
  find_size(c);
  if (status) cag_caster_free(c);
  else *out = c;
  return status;
}

CagStatus cag_caster_of_surface(const CagSurface *s, CagCaster **out, CagError *err) {
  CagSurface *faces[1] = {(CagSurface *)s};
  return faces_of(faces, 1, out, err);
}

CagStatus cag_caster_of_mesh(const CagMesh *m, CagCaster **out, CagError *err) {
  CagCaster *c = NULL;
  CagStatus status = caster_new(CAG_CASTER_MESH, &c, err);
  if (!status) status = cag_ray_mesh_new(m, &c->mesh, err);
  if (status) {
    cag_caster_free(c);
    return status;
  }
  c->bounds = cag_mesh_bounds(m);
  c->closed = m->triangle_count == 0 || cag_mesh_is_watertight(m, NULL);
  find_size(c);
  *out = c;
  return CAG_OK;
}

static CagStatus solid_caster(const CagSolid *s, const CagTransform *to_world, CagCaster **out,
                              CagError *err);

static CagStatus find_operand_boxes(CagCaster *c, CagError *err) {
  if (c->operand_count <= FEW_OPERANDS) return CAG_OK;
  CagBounds *boxes = cag_malloc(c->operand_count * sizeof *boxes);
  if (!boxes) return cag_fail_memory(err);
  bool bounded = true;
  for (size_t i = 0; i < c->operand_count; i++) {
    boxes[i] = c->operands[i]->bounds;
    bounded = bounded && isfinite(boxes[i].max.x - boxes[i].min.x + boxes[i].max.y -
                                  boxes[i].min.y + boxes[i].max.z - boxes[i].min.z);
  }
  CagStatus status = CAG_OK;
  if (bounded) status = cag_bvh_build(boxes, c->operand_count, 1, &c->boxes, err);
  cag_free(boxes);
  return status;
}

static CagStatus operation_caster(const CagSolid *s, const CagTransform *to_world, CagCaster **out,
                                  CagError *err) {
  CagCaster *c = NULL;
  CagStatus status = caster_new(CAG_CASTER_OPERATION, &c, err);
  if (status) return status;
  const CagTransform placement = cag_transform_multiply(to_world, &s->placement);
  c->operation = s->kind;
  c->operands = cag_calloc(s->core->count + 1, sizeof *c->operands);
  if (!c->operands) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i < s->core->count; i++) {
    status = solid_caster(s->core->operands[i], &placement, &c->operands[i], err);
    if (status) break;
    c->operand_count++;
    if (s->kind == CAG_SOLID_UNION || i == 0) bounds_join(&c->bounds, &c->operands[i]->bounds);
    if (s->kind == CAG_SOLID_INTERSECTION && i > 0) {
      const CagBounds *b = &c->operands[i]->bounds;
      c->bounds.min = cag_vec3(fmax(c->bounds.min.x, b->min.x), fmax(c->bounds.min.y, b->min.y),
                               fmax(c->bounds.min.z, b->min.z));
      c->bounds.max = cag_vec3(fmin(c->bounds.max.x, b->max.x), fmin(c->bounds.max.y, b->max.y),
                               fmin(c->bounds.max.z, b->max.z));
    }
  }
  if (!status) status = find_operand_boxes(c, err);
  if (status) cag_caster_free(c);
  else *out = c;
  return status;
}

static CagStatus form_caster(const CagSolid *s, const CagTransform *to_world, CagCaster **out,
                             CagError *err) {
  CagQuadric own;
  CagStatus status = caster_new(CAG_CASTER_FORM, out, err);
  if (status) return status;
  if (!cag_solid_form(s, &own)) status = CAG_E_ARGUMENT;
  else status = cag_quadric_transform(&own, to_world, &(*out)->form, err);
  (*out)->bounds = (CagBounds){{-INFINITY, -INFINITY, -INFINITY}, {INFINITY, INFINITY, INFINITY}};
  if (status) cag_caster_free(*out);
  return status;
}

static CagStatus primitive_caster(const CagSolid *s, const CagTransform *to_world,
                                  const CagTransform *placement, CagCaster **out, CagError *err) {
  CagCaster *c = NULL;
  CagVec3 unused;
  CagStatus status = caster_new(CAG_CASTER_PRIMITIVE, &c, err);
  if (!status) status = cag_ray_primitive_set(&c->primitive, s, placement, err);
  if (!status && !cag_ray_primitive_closest(&c->primitive, cag_vec3(0, 0, 0), &unused))
    status = cag_solid_transform(s, to_world, &c->image, err);
  if (status) {
    cag_caster_free(c);
    return status;
  }
  const CagBounds own = cag_ray_primitive_bounds(&c->primitive);
  c->bounds = moved_bounds(&own, placement);
  *out = c;
  return CAG_OK;
}

// A mesh that is placed by other maps than similarities is moved itself.
static CagStatus mesh_caster(const CagSolid *s, const CagTransform *placement, CagCaster **out,
                             CagError *err) {
  double scale;
  if (cag_transform_is_similarity(placement, &scale)) {
    CagStatus status = cag_caster_of_mesh(s->core->mesh, out, err);
    return status ? status : place_caster(*out, placement, err);
  }
  CagMesh *moved = NULL;
  CagStatus status = cag_mesh_transform(s->core->mesh, placement, &moved, err);
  if (!status) status = cag_caster_of_mesh(moved, out, err);
  cag_mesh_release(moved);
  return status;
}

// A solid of faces or of a mesh.
static CagStatus boundary_caster(const CagSolid *s, const CagTransform *to_world, CagCaster **out,
                                 CagError *err) {
  CagCaster *c = NULL;
  CagStatus status;
  if (s->kind == CAG_SOLID_MESH) {
    const CagTransform placement = cag_transform_multiply(to_world, &s->placement);
    status = mesh_caster(s, &placement, &c, err);
  } else {
    status = faces_of(s->faces, s->face_count, &c, err);
    if (!status) status = place_caster(c, to_world, err);
  }
  if (status) cag_caster_free(c);
  else *out = c;
  return status;
}

// The caster of a solid whose coordinates are mapped to the world by `to_world`.
static CagStatus solid_caster(const CagSolid *s, const CagTransform *to_world, CagCaster **out,
                              CagError *err) {
  CagQuadric form;
  CagStatus status = cag_stop_check(err);
  if (status) return status;
  const CagTransform placement = cag_transform_multiply(to_world, &s->placement);
  const bool affine = cag_transform_is_affine(&placement);
  const bool primitive = affine && cag_ray_primitive_can(s);
  const bool of_faces = !s->core && !primitive;
  double scale;
  if ((!affine || (of_faces && !cag_transform_is_similarity(to_world, &scale))) &&
      !is_identity(to_world) && !cag_solid_form(s, &form)) {
    // The image is a solid of its own.
    CagSolid *image = NULL;
    const CagTransform identity = cag_transform_identity();
    status = cag_solid_transform(s, to_world, &image, err);
    if (!status) status = solid_caster(image, &identity, out, err);
    cag_solid_release(image);
  } else if (cag_solid_form(s, &form)) status = form_caster(s, to_world, out, err);
  else if (s->core && s->kind != CAG_SOLID_MESH) status = operation_caster(s, to_world, out, err);
  else if (primitive) status = primitive_caster(s, to_world, &placement, out, err);
  else status = boundary_caster(s, to_world, out, err);
  if (status) return status;
  (*out)->closed = true;
  (*out)->label = s->label;
  find_size(*out);
  return CAG_OK;
}

CagStatus cag_caster_of_solid(const CagSolid *s, CagCaster **out, CagError *err) {
  const CagTransform identity = cag_transform_identity();
  return solid_caster(s, &identity, out, err);
}

bool cag_caster_is_closed(const CagCaster *c) { return c->closed; }
CagBounds cag_caster_bounds(const CagCaster *c) { return c->bounds; }

// --- Spans ---

// The crossings work->items[from..to) of the whole line with one solid, which alternate, and
// whether it starts inside.
typedef struct Span {
  size_t from, to;
  bool inside;
} Span;

static CagStatus meet(const CagCaster *c, const CagRay *line, CagCrossings *work, Span *out,
                      CagError *err);

// Sets the sign and label of crossings with a placed part, and maps them to the world.
static void finish_part(const CagCaster *c, const CagRay *line, double stretch, CagCrossings *work,
                        size_t from) {
  for (size_t i = from; i < work->n; i++) {
    CagCrossing *x = &work->items[i];
    x->part = c;
    if (c->label) x->label = c->label;
    if (!c->placed) continue;
    const double n[3] = {x->normal.x, x->normal.y, x->normal.z};
    double w[3] = {0, 0, 0};
    for (int k = 0; k < 3; k++)
      for (int j = 0; j < 3; j++) w[k] += c->back.m[j][k] * n[j];
    x->normal = cag_unit(cag_vec3(w[0], w[1], w[2]));
    x->t /= stretch;
  }
  (void)line;
}

// The line in the coordinates of a placed part. Distances there are `stretch` times as long.
static CagRay own_line(const CagCaster *c, const CagRay *line, double *stretch) {
  *stretch = 1;
  if (!c->placed) return *line;
  CagRay own = *line;
  const double w = c->back.m[3][3];
  own.origin = cag_transform_point(&c->back, line->origin);
  own.direction = cag_scaled(cag_transform_vector(&c->back, line->direction), 1 / w);
  *stretch = cag_norm(own.direction);
  own.direction = cag_scaled(own.direction, 1 / *stretch);
  own.least *= *stretch;
  own.most *= *stretch;
  return own;
}

// Adds the crossings with FACES or a MESH.
static CagStatus meet_parts(const CagCaster *c, const CagRay *line, bool first, CagCrossings *work,
                            CagError *err) {
  double stretch;
  const CagRay own = own_line(c, line, &stretch);
  const size_t from = work->n;
  CagStatus status = CAG_OK;
  if (c->kind == CAG_CASTER_MESH) status = cag_ray_mesh_all(c->mesh, &own, work, err);
  for (size_t i = 0; !status && i < c->face_count; i++) {
    const size_t known = work->n;
    status = cag_ray_patch_meet(c->faces[i], &own, first, work, err);
    for (size_t k = known; k < work->n; k++) work->items[k].face = (uint32_t)i;
  }
  finish_part(c, line, stretch, work, from);
  return status;
}

static void sort_span(CagCrossings *work, size_t from) {
  if (work->n == from) return;
  CagCrossings part = {work->items + from, work->n - from, work->n - from};
  cag_crossings_sort(&part);
}

// Merges crossings at one point, in the same direction, of faces that share an edge, and drops
// those that only touch. Returns whether the rest alternates, as for a solid.
static bool merge_crossings(CagCrossings *work, size_t from, double same) {
  size_t kept = from;
  int expected = -1;
  bool alternates = true;
  for (size_t i = from; i < work->n; i++) {
    const CagCrossing x = work->items[i];
    if (x.sign == 0) continue;
    if (kept > from && work->items[kept - 1].sign == x.sign &&
        x.t - work->items[kept - 1].t <= same)
      continue;
    work->items[kept++] = x;
    alternates = alternates && x.sign == expected;
    expected = -x.sign;
  }
  work->n = kept;
  return alternates && expected == -1;
}

// Of the crossings with a mesh, which may overlap itself, keeps those at which the line enters and
// leaves all of it.
static void keep_changes(CagCrossings *work, size_t from) {
  size_t kept = from;
  int depth = 0;
  for (size_t i = from; i < work->n; i++) {
    const int before = depth;
    depth -= work->items[i].sign;
    if ((before > 0) != (depth > 0)) work->items[kept++] = work->items[i];
  }
  work->n = kept;
}

// A line that is moved a little, a different way each time.
static CagRay nudged(const CagRay *line, double size, int k) {
  CagRay moved = *line;
  const double angle = 2.4 * k, by = NUDGE * size * (k + 1);
  const CagVec3 d = line->direction;
  const CagVec3 other = fabs(d.x) < 0.6 ? cag_vec3(1, 0, 0) : cag_vec3(0, 1, 0);
  const CagVec3 a = cag_unit(cag_cross(d, other)), b = cag_cross(d, a);
  moved.origin = cag_madd(cag_madd(line->origin, by * cos(angle), a), by * sin(angle), b);
  return moved;
}

static CagStatus meet_boundary(const CagCaster *c, const CagRay *line, CagCrossings *work,
                               Span *out, CagError *err) {
  const double same = SAME_POINT * c->size;
  CagStatus status = meet_parts(c, line, false, work, err);
  if (status) return status;
  sort_span(work, out->from);
  if (c->kind == CAG_CASTER_MESH) {
    keep_changes(work, out->from);
    return CAG_OK;
  }
  bool good = merge_crossings(work, out->from, same);
  for (int k = 0; !good && k < NUDGES; k++) {
    const CagRay moved = nudged(line, c->size, k);
    work->n = out->from;
    status = meet_parts(c, &moved, false, work, err);
    if (status) return status;
    sort_span(work, out->from);
    good = merge_crossings(work, out->from, same);
  }
  if (!good) { // what alternates is kept
    int expected = -1;
    size_t kept = out->from;
    for (size_t i = out->from; i < work->n; i++)
      if (work->items[i].sign == expected) {
        work->items[kept++] = work->items[i];
        expected = -expected;
      }
    work->n = kept - (expected == 1 && kept > out->from);
  }
  return CAG_OK;
}

// --- Forms ---

// The form along a line: a t^2 + b t + c.
static void form_along(const CagQuadric *q, const CagRay *line, double out[3]) {
  const CagVec3 o = line->origin, d = line->direction;
  const double *f = q->c;
  out[0] = f[0] * d.x * d.x + f[1] * d.y * d.y + f[2] * d.z * d.z + f[3] * d.x * d.y +
           f[4] * d.y * d.z + f[5] * d.x * d.z;
  out[1] = 2 * (f[0] * o.x * d.x + f[1] * o.y * d.y + f[2] * o.z * d.z) +
           f[3] * (o.x * d.y + o.y * d.x) + f[4] * (o.y * d.z + o.z * d.y) +
           f[5] * (o.x * d.z + o.z * d.x) + f[6] * d.x + f[7] * d.y + f[8] * d.z;
  out[2] = cag_quadric_value(q, o);
}

static CagVec3 form_normal(const CagQuadric *q, CagVec3 p) {
  const double *f = q->c;
  return cag_unit(cag_vec3(2 * f[0] * p.x + f[3] * p.y + f[5] * p.z + f[6],
                           2 * f[1] * p.y + f[3] * p.x + f[4] * p.z + f[7],
                           2 * f[2] * p.z + f[4] * p.y + f[5] * p.x + f[8]));
}

static CagStatus meet_form(const CagCaster *c, const CagRay *line, CagCrossings *work, Span *out,
                           CagError *err) {
  double k[3], roots[2];
  form_along(&c->form, line, k);
  const int n = cag_ray_quadratic(k[0], k[1], k[2], roots);
  // Far away, the highest power decides.
  out->inside = k[0] != 0 ? k[0] < 0 : k[1] != 0 ? k[1] > 0 : k[2] < 0;
  for (int i = 0; i < n; i++) {
    CagCrossing *x = cag_crossings_add(work, err);
    if (!x) return CAG_E_MEMORY;
    const CagVec3 p = cag_ray_point(line, roots[i]);
    *x = (CagCrossing){.t = roots[i],
                       .normal = form_normal(&c->form, p),
                       .u = NAN,
                       .v = NAN,
                       .label = c->label,
                       .part = c,
                       .sign = (i == 0) == out->inside ? 1 : -1};
  }
  return CAG_OK;
}

// --- Set operations ---

// Whether a point is in the result, given how many operands hold it.
static bool is_in_result(const CagCaster *c, bool in_first, size_t in_others) {
  switch (c->operation) {
  case CAG_SOLID_UNION: return in_first || in_others > 0;
  case CAG_SOLID_DIFFERENCE: return in_first && in_others == 0;
  default: return in_first && in_others == c->operand_count - 1;
  }
}

typedef struct Event {
  double t;
  size_t item; // of the crossing
  bool of_first;
} Event;

// Collects the crossings of the operands, which stay in place, and counts those that start inside.
// `*wanted` is false if the result is empty whatever the others are.
static CagStatus meet_operand(const CagCaster *c, size_t i, const CagRay *line, CagCrossings *work,
                              bool *in_first, size_t *in_others, size_t *end_of_first,
                              CagError *err) {
  Span span;
  CagStatus status = meet(c->operands[i], line, work, &span, err);
  if (status) return status;
  if (i == 0) {
    *in_first = span.inside;
    *end_of_first = span.to;
  } else *in_others += span.inside;
  return CAG_OK;
}

static CagStatus meet_operands(const CagCaster *c, const CagRay *line, CagCrossings *work,
                               bool *in_first, size_t *in_others, size_t *end_of_first,
                               CagError *err) {
  const size_t from = work->n;
  CagStatus status = CAG_OK;
  *in_first = false;
  *in_others = 0;
  *end_of_first = from;
  if (c->operand_count == 0) return CAG_OK;
  // The first operand bounds the others, except in a union.
  if (c->operation != CAG_SOLID_UNION) {
    status = meet_operand(c, 0, line, work, in_first, in_others, end_of_first, err);
    if (status || (work->n == from && !*in_first)) return status;
  }
  const size_t start = c->operation == CAG_SOLID_UNION ? 0 : 1;
  if (c->boxes.item_count == 0) {
    for (size_t i = start; !status && i < c->operand_count; i++)
      status = meet_operand(c, i, line, work, in_first, in_others, end_of_first, err);
    return status;
  }
  CagBvhRay ray;
  CagBvhWalk walk;
  size_t first, count;
  if (!cag_bvh_ray(&c->boxes, line->origin, line->direction, line->least, line->most, &ray))
    return CAG_OK;
  // The first operand's crossings come first, so that they can be told from the others.
  if (start == 0) {
    status = meet_operand(c, 0, line, work, in_first, in_others, end_of_first, err);
    if (status) return status;
  }
  cag_bvh_start(&c->boxes, &walk);
  while (!status && cag_bvh_next(&c->boxes, &ray, &walk, &first, &count))
    for (size_t k = first; !status && k < first + count; k++)
      if (c->boxes.order[k] != 0)
        status =
            meet_operand(c, c->boxes.order[k], line, work, in_first, in_others, end_of_first, err);
  return status;
}

// Marks the crossings of the first operand by their order: they come first in the span.
static void sort_events(Event *events, size_t n) {
  for (size_t i = 1; i < n; i++) {
    const Event e = events[i];
    size_t k = i;
    for (; k > 0 && events[k - 1].t > e.t; k--) events[k] = events[k - 1];
    events[k] = e;
  }
}

// The crossing of a group of events at one point that the result crosses as well: into the result,
// out of it. Other operands of a difference count with the opposite direction.
static CagCrossing result_crossing(const CagCaster *c, const CagCrossings *work,
                                   const Event *events, size_t n, int sign) {
  CagCrossing best = work->items[events[0].item];
  for (size_t i = 0; i < n; i++) {
    CagCrossing x = work->items[events[i].item];
    const bool inverted = c->operation == CAG_SOLID_DIFFERENCE && !events[i].of_first;
    if (inverted) {
      x.sign = -x.sign;
      x.normal = cag_scaled(x.normal, -1);
      x.flipped = !x.flipped;
    }
    if (i == 0) best = x;
    if (x.sign != sign) continue;
    best = x;
    break;
  }
  best.sign = sign;
  return best;
}

// Replaces the crossings of the operands by those of the result.
static CagStatus combine_operands(const CagCaster *c, CagCrossings *work, Span *out, bool in_first,
                                  size_t in_others, size_t end_of_first, CagError *err) {
  enum { LOCAL = 64 };
  Event local[LOCAL];
  const size_t from = out->from, n = work->n - from;
  Event *events = n <= LOCAL ? local : cag_malloc(n * sizeof *events);
  CagCrossing kept_local[LOCAL];
  CagCrossing *kept = n <= LOCAL ? kept_local : cag_malloc(n * sizeof *kept);
  CagStatus status = events && kept ? CAG_OK : cag_fail_memory(err);
  size_t used = 0;
  if (!status) {
    for (size_t i = 0; i < n; i++)
      events[i] = (Event){work->items[from + i].t, from + i, from + i < end_of_first};
    sort_events(events, n);
    bool inside = out->inside = is_in_result(c, in_first, in_others);
    for (size_t i = 0, end; i < n; i = end) {
      const double same = SAME_POINT * (c->size > 0 ? c->size : fabs(events[i].t));
      for (end = i; end < n && events[end].t - events[i].t <= same; end++) {
        const int sign = work->items[events[end].item].sign;
        if (events[end].of_first) in_first = sign < 0;
        else in_others = sign < 0 ? in_others + 1 : in_others - 1;
      }
      const bool now = is_in_result(c, in_first, in_others);
      if (now != inside) kept[used++] = result_crossing(c, work, events + i, end - i, now ? -1 : 1);
      inside = now;
    }
    for (size_t i = 0; i < used; i++) work->items[from + i] = kept[i];
    work->n = from + used;
  }
  if (events != local) cag_free(events);
  if (kept != kept_local) cag_free(kept);
  return status;
}

static CagStatus meet_operation(const CagCaster *c, const CagRay *line, CagCrossings *work,
                                Span *out, CagError *err) {
  bool in_first;
  size_t in_others, end_of_first;
  CagStatus status = meet_operands(c, line, work, &in_first, &in_others, &end_of_first, err);
  if (status) return status;
  return combine_operands(c, work, out, in_first, in_others, end_of_first, err);
}

// --- Solids ---

static bool misses_bounds(const CagBounds *b, const CagRay *line) {
  const double o[3] = {line->origin.x, line->origin.y, line->origin.z};
  const double d[3] = {line->direction.x, line->direction.y, line->direction.z};
  const double low[3] = {b->min.x, b->min.y, b->min.z}, high[3] = {b->max.x, b->max.y, b->max.z};
  double from = line->least, to = line->most;
  for (int k = 0; k < 3; k++) {
    const double pad = CAG_ROUNDING * (high[k] - low[k] + fabs(low[k]) + fabs(high[k]));
    if (!(low[k] <= high[k])) return true;
    if (d[k] == 0) {
      if (o[k] < low[k] - pad || o[k] > high[k] + pad) return true;
      continue;
    }
    const double a = (low[k] - pad - o[k]) / d[k], e = (high[k] + pad - o[k]) / d[k];
    from = fmax(from, fmin(a, e));
    to = fmin(to, fmax(a, e));
  }
  return from > to;
}

static CagStatus meet(const CagCaster *c, const CagRay *line, CagCrossings *work, Span *out,
                      CagError *err) {
  *out = (Span){.from = work->n, .to = work->n};
  if (c->kind != CAG_CASTER_FORM && misses_bounds(&c->bounds, line)) return CAG_OK;
  CagStatus status = CAG_OK;
  switch (c->kind) {
  case CAG_CASTER_PRIMITIVE:
    status = cag_ray_primitive_meet(&c->primitive, line, work, err);
    for (size_t i = out->from; i < work->n; i++) {
      work->items[i].label = c->label;
      work->items[i].part = c;
    }
    break;
  case CAG_CASTER_FORM: status = meet_form(c, line, work, out, err); break;
  case CAG_CASTER_OPERATION: status = meet_operation(c, line, work, out, err); break;
  default: status = meet_boundary(c, line, work, out, err);
  }
  out->to = work->n;
  return status;
}

static const CagRay WHOLE_LINE = {.least = -INFINITY, .most = INFINITY};

// Crossings of the whole line behind or beyond the ray are left out.
static void cut_to_ray(CagCrossings *list, const CagRay *ray, bool *inside) {
  size_t kept = 0;
  for (size_t i = 0; i < list->n; i++) {
    const CagCrossing x = list->items[i];
    if (x.t <= ray->least) *inside = x.sign < 0;
    else if (x.t <= ray->most) list->items[kept++] = x;
  }
  list->n = kept;
}

CagStatus cag_caster_all(const CagCaster *c, const CagRay *ray, CagCrossings *out, bool *inside,
                         CagError *err) {
  bool starts_inside = false;
  out->n = 0;
  CagStatus status;
  if (c->closed) {
    Span span;
    CagRay line = *ray;
    line.least = WHOLE_LINE.least;
    line.most = WHOLE_LINE.most;
    status = meet(c, &line, out, &span, err);
    if (!status) {
      starts_inside = span.inside;
      cut_to_ray(out, ray, &starts_inside);
    }
  } else {
    status = meet_parts(c, ray, false, out, err);
    sort_span(out, 0);
    const double same = SAME_POINT * c->size;
    size_t kept = 0;
    for (size_t i = 0; i < out->n; i++)
      if (kept == 0 || out->items[i].t - out->items[kept - 1].t > same)
        out->items[kept++] = out->items[i];
    out->n = kept;
  }
  if (inside) *inside = starts_inside;
  return status;
}

CagStatus cag_caster_first(const CagCaster *c, const CagRay *ray, CagCrossings *work,
                           CagCrossing *out, bool *met, CagError *err) {
  *met = false;
  work->n = 0;
  if (c->kind == CAG_CASTER_MESH && !c->placed) {
    *met = cag_ray_mesh_first(c->mesh, ray, out);
    if (*met && c->label) out->label = c->label;
    return CAG_OK;
  }
  CagStatus status;
  if (c->kind == CAG_CASTER_FACES || c->kind == CAG_CASTER_MESH) {
    if (misses_bounds(&c->bounds, ray)) return CAG_OK;
    status = meet_parts(c, ray, true, work, err);
    if (!status) sort_span(work, 0);
  } else status = cag_caster_all(c, ray, work, NULL, err);
  if (status || work->n == 0) return status;
  *met = true;
  *out = work->items[0];
  if (c->kind == CAG_CASTER_PRIMITIVE) cag_ray_primitive_parameters(&c->primitive, ray, out);
  return CAG_OK;
}

// --- Points ---

// A direction that is parallel to no face of most solids.
static const CagVec3 ANY_DIRECTION = {0.36, 0.48, 0.8};

static CagStatus side_of_boundary(const CagCaster *c, CagVec3 p, double slack, CagCrossings *work,
                                  int *side, CagError *err) {
  const CagRay ray = {p, ANY_DIRECTION, -INFINITY, INFINITY};
  Span span;
  work->n = 0;
  CagStatus status = meet(c, &ray, work, &span, err);
  if (status) return status;
  bool inside = false;
  for (size_t i = 0; i < work->n; i++) {
    const CagCrossing *x = &work->items[i];
    // The distance of the tangent plane.
    if (fabs(x->t * cag_dot(x->normal, ANY_DIRECTION)) <= slack && fabs(x->t) <= 1e3 * slack) {
      *side = 0;
      return CAG_OK;
    }
    if (x->t < 0) inside = x->sign < 0;
  }
  *side = inside ? -1 : 1;
  return CAG_OK;
}

static bool is_outside_box(const CagBounds *b, CagVec3 p, double slack) {
  return p.x < b->min.x - slack || p.y < b->min.y - slack || p.z < b->min.z - slack ||
         p.x > b->max.x + slack || p.y > b->max.y + slack || p.z > b->max.z + slack;
}

static CagStatus side_of_operation(const CagCaster *c, CagVec3 p, double slack, CagCrossings *work,
                                   int *side, CagError *err) {
  const bool join = c->operation == CAG_SOLID_UNION;
  *side = join || c->operand_count == 0 ? 1 : -1;
  for (size_t i = 0; i < c->operand_count; i++) {
    int one = 1;
    CagStatus status = cag_caster_side(c->operands[i], p, slack, work, &one, err);
    if (status) return status;
    if (c->operation == CAG_SOLID_DIFFERENCE && i > 0) one = -one;
    if (join ? one < *side : one > *side) *side = one;
    // One operand (inside for a union, outside for an intersection) decides.
    if (*side == (join ? -1 : 1)) break;
  }
  return CAG_OK;
}

CagStatus cag_caster_side(const CagCaster *c, CagVec3 p, double slack, CagCrossings *work,
                          int *side, CagError *err) {
  *side = 1;
  if (c->kind != CAG_CASTER_FORM && is_outside_box(&c->bounds, p, slack)) return CAG_OK;
  switch (c->kind) {
  case CAG_CASTER_PRIMITIVE: *side = cag_ray_primitive_side(&c->primitive, p, slack); return CAG_OK;
  case CAG_CASTER_FORM: *side = cag_ray_form_side(&c->form, p, slack); return CAG_OK;
  case CAG_CASTER_OPERATION: return side_of_operation(c, p, slack, work, side, err);
  case CAG_CASTER_MESH:
    if (c->placed) break;
    *side = cag_ray_mesh_contains(c->mesh, p, 0) ? -1 : 1;
    if (*side > 0 && slack > 0 && cag_ray_mesh_contains(c->mesh, p, slack)) *side = 0;
    return CAG_OK;
  default: break;
  }
  return side_of_boundary(c, p, slack, work, side, err);
}
