// Set operations and other solids without faces: construction, bounds, and the side that a point is
// on. Their meshes and measures are in csg_mesh.c and csg_measure.c.

#include "geom/solid/csg.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "geom/solid/build.h"
#include "geom/solid/exact.h"
#include "geom/tessellate/orient.h"

bool cag_solid_is_compound(const CagSolid *s) { return s->core != NULL; }

static CagStatus block(CagSolidKind kind, size_t operands, CagSolid **out, CagError *err) {
  CagSolid *s = NULL;
  CagStatus status = cag_solid_block(kind, 0, &s, err);
  if (status) return status;
  s->core = cag_calloc(1, sizeof *s->core);
  if (s->core) {
    s->core->references = 1;
    s->core->operands = cag_calloc(operands + 1, sizeof(CagSolid *));
  }
  if (!s->core || !s->core->operands) {
    cag_solid_release(s);
    return cag_fail_memory(err);
  }
  *out = s;
  return CAG_OK;
}

void cag_solid_core_release(CagSolidCore *core) {
  if (!core || --core->references > 0) return;
  for (size_t i = 0; i < core->count; i++) cag_solid_release(core->operands[i]);
  cag_free(core->operands);
  cag_mesh_release(core->mesh);
  cag_free(core);
}

CagStatus cag_solid_empty(CagSolid **out, CagError *err) {
  CagSolid *s = NULL;
  const CagStatus status = block(CAG_SOLID_UNION, 0, &s, err);
  if (status) return status;
  s->core->reach = CAG_BOUNDS_EMPTY;
  *out = s;
  return CAG_OK;
}

// --- Half spaces and quadrics ---

CagStatus cag_solid_half_space(const CagPlane *plane, CagSolid **out, CagError *err) {
  double row[4];
  CagSolid *s = NULL;
  CagStatus status = block(CAG_SOLID_HALF_SPACE, 0, &s, err);
  if (status) return status;
  cag_plane_row(plane, row);
  for (int i = 0; i < 4; i++) s->core->form[6 + i] = row[i];
  *out = s;
  return CAG_OK;
}

CagStatus cag_solid_quadric(const CagQuadric *form, CagSolid **out, CagError *err) {
  CagQuadricForm f;
  CagSolid *s = NULL;
  CagStatus status = cag_quadric_classify(form, &f, err);
  if (status) return status;
  if (f.class_id == CAG_QUADRIC_EMPTY)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_quadric_imaginary, "coefficients", -1,
                    "the form does not depend on x, y, or z, so it has no inside");
  bool flat = f.class_id == CAG_QUADRIC_PLANE;
  status = block(flat ? CAG_SOLID_HALF_SPACE : CAG_SOLID_QUADRIC, 0, &s, err);
  if (status) return status;
  memcpy(s->core->form, form->c, sizeof s->core->form);
  *out = s;
  return CAG_OK;
}

bool cag_solid_form(const CagSolid *s, CagQuadric *out) {
  CagError err;
  CagQuadric own;
  if (s->kind != CAG_SOLID_HALF_SPACE && s->kind != CAG_SOLID_QUADRIC) return false;
  memcpy(own.c, s->core->form, sizeof own.c);
  return !cag_quadric_transform(&own, &s->placement, out, &err);
}

// --- Solids bounded by meshes ---

CagStatus cag_solid_from_mesh(const CagMesh *m, CagSolid **out, CagError *err) {
  CagVec3 edge[2];
  double terms[10] = {0};
  char x[32], y[32], z[32];
  if (m->triangle_count == 0) return cag_solid_empty(out, err);
  if (!cag_mesh_is_watertight(m, edge))
    return cag_fail(
        err, CAG_E_ARGUMENT, CAG_ERR_mesh_open, "", -1,
        "the mesh must be closed: its edge from [%s, %s, %s] to [%.9g, %.9g, %.9g] does not belong to two faces with opposite directions; `weld` merges vertices that nearly coincide",
        cag_number_text(edge[0].x, x), cag_number_text(edge[0].y, y), cag_number_text(edge[0].z, z),
        edge[1].x, edge[1].y, edge[1].z);
  CagBounds box = cag_mesh_bounds(m);
  CagTransform shift = cag_translate(cag_scaled(cag_lerp(box.min, box.max, 0.5), -1));
  CagMesh *near = NULL, *outward = NULL;
  CagSolid *s = NULL;
  CagStatus status = cag_mesh_transform(m, &shift, &near, err);
  if (status) return status;
  cag_mesh_volume_terms(near, terms);
  cag_mesh_release(near);
  if (terms[0] == 0)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_mesh_flat, "", -1,
                    "the mesh encloses no volume: its faces coincide");
  status = cag_mesh_outward(m, &outward, err);
  if (!status) status = block(CAG_SOLID_MESH, 0, &s, err);
  if (status) {
    cag_mesh_release(outward);
    return status;
  }
  s->core->mesh = outward;
  *out = s;
  return CAG_OK;
}

// --- Bounds ---

static const CagBounds EVERYWHERE = {{-INFINITY, -INFINITY, -INFINITY},
                                     {INFINITY, INFINITY, INFINITY}};

// Bounds of the image of bounds, computing each coordinate as a sum of intervals; infinite bounds
// remain infinite.
static CagBounds moved(const CagBounds *b, const CagTransform *t) {
  const double lo[3] = {b->min.x, b->min.y, b->min.z}, hi[3] = {b->max.x, b->max.y, b->max.z};
  double low[3], high[3];
  for (int i = 0; i < 3; i++) {
    low[i] = high[i] = t->m[i][3];
    for (int j = 0; j < 3; j++) {
      double k = t->m[i][j];
      if (k == 0) continue;
      low[i] += k > 0 ? k * lo[j] : k * hi[j];
      high[i] += k > 0 ? k * hi[j] : k * lo[j];
    }
    low[i] /= t->m[3][3];
    high[i] /= t->m[3][3];
  }
  return (CagBounds){{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

static void join(CagBounds *a, const CagBounds *b) {
  if (!(b->min.x <= b->max.x)) return;
  cag_bounds_add(a, b->min);
  cag_bounds_add(a, b->max);
}

static void meet(CagBounds *a, const CagBounds *b) {
  a->min = cag_vec3(fmax(a->min.x, b->min.x), fmax(a->min.y, b->min.y), fmax(a->min.z, b->min.z));
  a->max = cag_vec3(fmin(a->max.x, b->max.x), fmin(a->max.y, b->max.y), fmin(a->max.z, b->max.z));
}

// A half space perpendicular to an axis is bounded along it.
static CagBounds plane_reach(const CagQuadric *q) {
  const double *n = q->c + 6, k = q->c[9];
  CagBounds b = EVERYWHERE;
  if (n[1] == 0 && n[2] == 0) *(n[0] > 0 ? &b.max.x : &b.min.x) = -k / n[0];
  if (n[0] == 0 && n[2] == 0) *(n[1] > 0 ? &b.max.y : &b.min.y) = -k / n[1];
  if (n[0] == 0 && n[1] == 0) *(n[2] > 0 ? &b.max.z : &b.min.z) = -k / n[2];
  return b;
}

// For an ellipsoid, an elliptic cylinder, or a slab: each coordinate extends as far as the
// semi-axes, unless an infinite direction of the frame has a component in it.
static CagBounds quadric_reach(const CagQuadric *q) {
  CagQuadricForm f;
  CagError err;
  CagBounds b = EVERYWHERE;
  double *lo[3] = {&b.min.x, &b.min.y, &b.min.z}, *hi[3] = {&b.max.x, &b.max.y, &b.max.z};
  if (cag_quadric_classify(q, &f, &err)) return b;
  int ends = f.class_id == CAG_QUADRIC_ELLIPSOID           ? 3
             : f.class_id == CAG_QUADRIC_ELLIPTIC_CYLINDER ? 2
             : f.class_id == CAG_QUADRIC_PARALLEL_PLANES   ? 1
                                                           : 0;
  CagVec3 center = cag_vec3(f.frame.m[0][3], f.frame.m[1][3], f.frame.m[2][3]);
  if (ends == 0 || !(cag_quadric_value(q, center) < 0)) return b;
  const double at[3] = {center.x, center.y, center.z};
  for (int i = 0; i < 3; i++) {
    double square = 0;
    bool endless = false;
    for (int j = 0; j < 3; j++) {
      double part = f.frame.m[i][j] * f.semi[j];
      if (j < ends) square += part * part;
      else endless = endless || fabs(f.frame.m[i][j]) > 1e-12; // rounding of a rotated frame
    }
    if (endless) continue;
    *lo[i] = at[i] - sqrt(square);
    *hi[i] = at[i] + sqrt(square);
  }
  return b;
}

CagStatus cag_solid_reach(const CagSolid *s, CagBounds *out, CagError *err) {
  CagQuadric q;
  CagBounds own;
  switch (s->kind) {
  case CAG_SOLID_MESH:
    own = cag_mesh_bounds(s->core->mesh);
    *out = moved(&own, &s->placement);
    return CAG_OK;
  case CAG_SOLID_HALF_SPACE:
  case CAG_SOLID_QUADRIC:
    if (!cag_solid_form(s, &q)) *out = EVERYWHERE;
    else *out = s->kind == CAG_SOLID_QUADRIC ? quadric_reach(&q) : plane_reach(&q);
    return CAG_OK;
  case CAG_SOLID_UNION:
  case CAG_SOLID_DIFFERENCE:
  case CAG_SOLID_INTERSECTION:
    *out = moved(&s->core->reach, &s->placement);
    if (!(s->core->reach.min.x <= s->core->reach.max.x) ||
        !(s->core->reach.min.y <= s->core->reach.max.y) ||
        !(s->core->reach.min.z <= s->core->reach.max.z))
      *out = CAG_BOUNDS_EMPTY;
    return CAG_OK;
  default: return cag_solid_bounds(s, out, err);
  }
}

// --- Operations ---

static CagSolidKind kind_of(CagSetOperation op) {
  return op == CAG_UNION        ? CAG_SOLID_UNION
         : op == CAG_DIFFERENCE ? CAG_SOLID_DIFFERENCE
                                : CAG_SOLID_INTERSECTION;
}

static bool is_identity(const CagTransform *t) {
  const CagTransform same = cag_transform_identity();
  return memcmp(t->m, same.m, sizeof t->m) == 0;
}

// (a | b) | c is a | b | c, likewise for &; (a - b) - c is a - b - c.
bool cag_solid_dissolves(const CagSolid *operand, CagSetOperation op, size_t index) {
  return operand->kind == kind_of(op) && (op != CAG_DIFFERENCE || index == 0) &&
         is_identity(&operand->placement);
}

static CagStatus reach_of(CagSetOperation op, CagSolid *const *operands, size_t n, CagBounds *out,
                          CagError *err) {
  for (size_t i = 0; i < n; i++) {
    CagBounds one;
    if (op == CAG_DIFFERENCE && i > 0) break;
    CagStatus status = cag_solid_reach(operands[i], &one, err);
    if (status) return status;
    if (i == 0) *out = one;
    else if (op == CAG_UNION) join(out, &one);
    else meet(out, &one);
  }
  return CAG_OK;
}

CagStatus cag_solid_combine(CagSetOperation op, CagSolid *const *operands, size_t n,
                            const volatile int *interrupt, CagSolid **out, CagError *err) {
  size_t count = 0;
  for (size_t i = 0; i < n; i++)
    count += cag_solid_dissolves(operands[i], op, i) ? operands[i]->core->count : 1;
  CagSolid *s = NULL;
  CagStatus status = block(kind_of(op), count, &s, err);
  if (status) return status;
  for (size_t i = 0; i < n; i++) {
    bool apart = cag_solid_dissolves(operands[i], op, i);
    size_t parts = apart ? operands[i]->core->count : 1;
    for (size_t k = 0; k < parts; k++)
      s->core->operands[s->core->count++] =
          cag_solid_retain(apart ? operands[i]->core->operands[k] : operands[i]);
  }
  s->core->interrupt = interrupt;
  status = reach_of(op, operands, n, &s->core->reach, err);
  if (status) cag_solid_release(s);
  else *out = s;
  return status;
}

// --- Sides of a point ---

static int side_of_form(const CagQuadric *q, CagVec3 p, double slack) {
  const double *c = q->c;
  CagVec3 slope = cag_vec3(2 * c[0] * p.x + c[3] * p.y + c[5] * p.z + c[6],
                           2 * c[1] * p.y + c[3] * p.x + c[4] * p.z + c[7],
                           2 * c[2] * p.z + c[4] * p.y + c[5] * p.x + c[8]);
  double value = cag_quadric_value(q, p);
  // Where the gradient vanishes too, the second derivatives determine how fast the form grows.
  double bend = 0;
  for (int i = 0; i < 6; i++) bend = fmax(bend, fabs(c[i]));
  if (fabs(value) <= cag_norm(slope) * slack + bend * slack * slack) return 0;
  return value < 0 ? -1 : 1;
}

CagStatus cag_csg_side(const CagSolid *s, CagVec3 p, double slack, CagSideOfLeaf *leaf,
                       void *context, int *side, CagError *err) {
  CagQuadric q;
  CagTransform back;
  if (cag_solid_form(s, &q)) {
    *side = side_of_form(&q, p, slack);
    return CAG_OK;
  }
  if (!s->core || s->kind == CAG_SOLID_MESH) return leaf(context, s, p, side, err);
  CagStatus status = cag_transform_inverse(&s->placement, &back, err);
  if (status) return status;
  p = cag_transform_point(&back, p);
  *side = s->kind == CAG_SOLID_UNION ? 1 : -1;
  for (size_t i = 0; !status && i < s->core->count; i++) {
    int one;
    status = cag_csg_side(s->core->operands[i], p, slack, leaf, context, &one, err);
    if (status) return status;
    if (s->kind == CAG_SOLID_DIFFERENCE && i > 0) one = -one;
    if (s->kind == CAG_SOLID_UNION ? one < *side : one > *side) *side = one;
    // One operand (inside for a union, outside for an intersection) decides.
    if (*side == (s->kind == CAG_SOLID_UNION ? -1 : 1)) break;
  }
  return CAG_OK;
}

// --- Labels ---

uint32_t cag_solid_first_label(const CagSolid *s) {
  uint32_t label = s->label;
  for (size_t i = 0; !label && s->core && i < s->core->count; i++)
    label = cag_solid_first_label(s->core->operands[i]);
  return label;
}

static CagStatus copy_solid(const CagSolid *s, CagSolid **out, CagError *err) {
  CagSolid *c = NULL;
  CagStatus status = cag_solid_block(s->kind, s->face_count, &c, err);
  if (status) return status;
  c->a = s->a;
  c->b = s->b;
  c->c = s->c;
  c->centered = s->centered;
  c->label = s->label;
  c->placement = s->placement;
  c->core = s->core;
  if (c->core) c->core->references++;
  c->exact = cag_exact_retain(s->exact);
  for (size_t i = 0; i < s->face_count; i++) cag_solid_add(c, cag_surface_retain(s->faces[i]));
  for (size_t i = 0; !status && i < s->edge_count; i++) {
    const CagFaceEdge *e = &s->edges[i];
    status =
        cag_solid_add_edge(c, e->face[0], e->side[0], e->face[1], e->side[1], e->reversed, err);
  }
  if (status) cag_solid_release(c);
  else *out = c;
  return status;
}

// The same operation with other operands.
static CagStatus relabel_operands(const CagSolid *s, CagRelabel *relabel, void *context,
                                  CagSolid **out, CagError *err) {
  CagSolid *c = NULL;
  CagStatus status = block(s->kind, s->core->count, &c, err);
  if (status) return status;
  c->placement = s->placement;
  c->core->reach = s->core->reach;
  c->core->interrupt = s->core->interrupt;
  c->core->place = s->core->place;
  for (size_t i = 0; !status && i < s->core->count; i++) {
    status = cag_solid_relabel(s->core->operands[i], relabel, context, &c->core->operands[i], err);
    if (!status) c->core->count++;
  }
  if (status) cag_solid_release(c);
  else *out = c;
  return status;
}

CagStatus cag_solid_relabel(const CagSolid *s, CagRelabel *relabel, void *context, CagSolid **out,
                            CagError *err) {
  if (s->core && s->core->count > 0 && !s->label && cag_solid_first_label(s))
    return relabel_operands(s, relabel, context, out, err);
  const CagStatus status = copy_solid(s, out, err);
  if (!status) (*out)->label = relabel(context, s->label);
  return status;
}
