// The real pieces of quadrics as parametric patches.
//
// In units of the semi-axes each coordinate of every form is a product of a function of u and a
// function of v (the saddle has a second product in z), so one table of functions covers all forms,
// with any number of partials. A frame, which may be any affine map, places the unit form.

#include <math.h>
#include <stdio.h>

#include "base/memory.h"
#include "geom/surface/family.h"
#include "geom/surface/quadric.h"
#include "geom/surface/quadric_within.h"
#include "geom/surface/trimmed.h"

typedef enum Function {
  ZERO,
  ONE,
  LINEAR,
  TWICE,
  SQUARE,
  MINUS_SQUARE,
  COS,
  SIN,
  COSH,
  SINH
} Function;

typedef struct Shape {
  const char *text;
  Function u[4], v[4]; // x, y, z, and the second product of z
  bool angular_u, angular_v;
} Shape;

static const Shape SHAPE[] = {
    {"ellipsoid", {COS, SIN, ONE, ZERO}, {SIN, SIN, COS, ZERO}, true, true},
    {"hyperboloid of one sheet", {COS, SIN, ONE, ZERO}, {COSH, COSH, SINH, ZERO}, true, false},
    {"sheet of a hyperboloid", {COS, SIN, ONE, ZERO}, {SINH, SINH, COSH, ZERO}, true, false},
    {"cone", {COS, SIN, ONE, ZERO}, {LINEAR, LINEAR, LINEAR, ZERO}, true, false},
    {"elliptic paraboloid", {COS, SIN, ONE, ZERO}, {LINEAR, LINEAR, SQUARE, ZERO}, true, false},
    {"hyperbolic paraboloid",
     {LINEAR, ONE, SQUARE, ONE},
     {ONE, LINEAR, ONE, MINUS_SQUARE},
     false,
     false},
    {"elliptic cylinder", {COS, SIN, ONE, ZERO}, {ONE, ONE, LINEAR, ZERO}, true, false},
    {"parabolic cylinder", {SQUARE, TWICE, ONE, ZERO}, {ONE, ONE, LINEAR, ZERO}, false, false},
    {"branch of a hyperbolic cylinder",
     {COSH, SINH, ONE, ZERO},
     {ONE, ONE, LINEAR, ZERO},
     false,
     false},
};

typedef struct Patch {
  CagSurface base;
  CagQuadricShape shape;
  CagTransform frame;
  CagQuadric equation;
  CagQuadricWithin within; // 0 pieces: unknown
} Patch;

static const CagSurfaceKind quadric_kind;

// Value and derivatives 0..n.
static void derivatives(Function f, double t, int n, double *out) {
  double s, c, a, b;
  for (int k = 0; k <= n; k++) out[k] = 0;
  switch (f) {
  case ZERO: return;
  case ONE: out[0] = 1; return;
  case LINEAR:
  case TWICE:
    out[0] = f == TWICE ? 2 * t : t;
    if (n > 0) out[1] = f == TWICE ? 2 : 1;
    return;
  case SQUARE:
  case MINUS_SQUARE:
    a = f == SQUARE ? 1 : -1;
    out[0] = a * t * t;
    if (n > 0) out[1] = 2 * a * t;
    if (n > 1) out[2] = 2 * a;
    return;
  case COS:
  case SIN:
    cag_sincos(t, &s, &c);
    // cos -> -sin -> -cos; sin is a quarter turn ahead.
    a = f == COS ? c : s;
    b = f == COS ? -s : c;
    for (int k = 0; k <= n; k++) {
      out[k] = a;
      double next = -a;
      a = b;
      b = next;
    }
    return;
  case COSH:
  case SINH:
    for (int k = 0; k <= n; k++) out[k] = (f == COSH) == (k % 2 == 0) ? cosh(t) : sinh(t);
    return;
  }
}

static CagStatus patch_eval(const CagSurface *s, double u, double v, int n, CagSide su, CagSide sv,
                            CagVec3 *out, CagError *err) {
  (void)su;
  (void)sv;
  (void)err;
  const Patch *p = (const Patch *)s;
  const Shape *shape = &SHAPE[p->shape];
  double fu[4][CAG_MAX_PARTIAL + 1], fv[4][CAG_MAX_PARTIAL + 1];
  for (int c = 0; c < 4; c++) {
    derivatives(shape->u[c], u, n, fu[c]);
    derivatives(shape->v[c], v, n, fv[c]);
  }
  for (int i = 0; i <= n; i++)
    for (int j = 0; i + j <= n; j++) {
      CagVec3 d = cag_vec3(fu[0][i] * fv[0][j], fu[1][i] * fv[1][j],
                           fu[2][i] * fv[2][j] + fu[3][i] * fv[3][j]);
      out[cag_partial(n, i, j)] =
          i + j ? cag_transform_vector(&p->frame, d) : cag_transform_point(&p->frame, d);
    }
  return CAG_OK;
}

static CagVec3 product(const double (*fu)[2], int i, const double (*fv)[2], int j) {
  return cag_vec3(fu[0][i] * fv[0][j], fu[1][i] * fv[1][j],
                  fu[2][i] * fv[2][j] + fu[3][i] * fv[3][j]);
}

static CagStatus patch_grid(const CagSurface *s, const double *us, size_t nu, const double *vs,
                            size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv, CagError *err) {
  const Patch *p = (const Patch *)s;
  const Shape *shape = &SHAPE[p->shape];
  double(*fv)[4][2] = cag_malloc((nv ? nv : 1) * sizeof *fv);
  if (!fv) return cag_fail_memory(err);
  for (size_t j = 0; j < nv; j++)
    for (int c = 0; c < 4; c++) derivatives(shape->v[c], vs[j], 1, fv[j][c]);
  for (size_t i = 0; i < nu; i++) {
    double fu[4][2];
    for (int c = 0; c < 4; c++) derivatives(shape->u[c], us[i], 1, fu[c]);
    const double(*a)[2] = (const double(*)[2])fu;
    for (size_t j = 0; j < nv; j++) {
      const double(*b)[2] = (const double(*)[2])fv[j];
      size_t at = i * nv + j;
      points[at] = cag_transform_point(&p->frame, product(a, 0, b, 0));
      if (du) du[at] = cag_transform_vector(&p->frame, product(a, 1, b, 0));
      if (dv) dv[at] = cag_transform_vector(&p->frame, product(a, 0, b, 1));
    }
  }
  cag_free(fv);
  return CAG_OK;
}

// --- Exact form ---

// Control points of the unit form are products of those of two arcs. `x` and `z` select the entries
// of the arc in v (0, 1, or 2: its weight) for x, y and for z.
typedef struct Exact {
  CagConicArc u, v;
  int x, z;
} Exact;
static const Exact EXACT[] = {
    {CAG_ARC_CIRCLE, CAG_ARC_CIRCLE, 1, 0},    {CAG_ARC_CIRCLE, CAG_ARC_HYPERBOLA, 0, 1},
    {CAG_ARC_CIRCLE, CAG_ARC_HYPERBOLA, 1, 0}, {CAG_ARC_CIRCLE, CAG_ARC_LINE, 1, 1},
    {CAG_ARC_CIRCLE, CAG_ARC_PARABOLA, 1, 0},  {CAG_ARC_PARABOLA, CAG_ARC_PARABOLA, 0, 0},
    {CAG_ARC_CIRCLE, CAG_ARC_LINE, 2, 1},      {CAG_ARC_PARABOLA, CAG_ARC_LINE, 2, 1},
    {CAG_ARC_HYPERBOLA, CAG_ARC_LINE, 2, 1},
};

static CagStatus patch_to_nurbs(const CagSurface *s, CagSurface **out, CagError *err) {
  const Patch *p = (const Patch *)s;
  const Exact *exact = &EXACT[p->shape];
  CagConicNurbs u, v;
  cag_conic_nurbs(exact->u, s->u0, s->u1, &u);
  cag_conic_nurbs(exact->v, s->v0, s->v1, &v);
  double net[CAG_CONIC_ARC_POINTS * CAG_CONIC_ARC_POINTS * 4];
  for (size_t i = 0; i < u.count; i++)
    for (size_t j = 0; j < v.count; j++) {
      const double *a = u.points[i], *b = v.points[j];
      double h[4] = {a[0] * b[exact->x], a[1] * b[exact->x], a[2] * b[exact->z], a[2] * b[2]};
      if (p->shape == CAG_SHAPE_PARABOLIC_CYLINDER) h[1] *= 2;
      if (p->shape == CAG_SHAPE_HYPERBOLIC_PARABOLOID) {
        h[0] = a[1] * b[2];
        h[1] = a[2] * b[1];
        h[2] = a[0] * b[2] - a[2] * b[0];
      }
      cag_transform_homogeneous(&p->frame, h, net + 4 * (i * v.count + j));
    }
  return cag_surface_from_homogeneous(net, u.count, v.count, u.degree, v.degree, u.knots, v.knots,
                                      out, err);
}

// --- Other functions of the kind ---

// The implicit form of each shape, in the order of CagQuadric.
static const double UNIT_EQUATION[][10] = {
    {1, 1, 1, 0, 0, 0, 0, 0, 0, -1},  {1, 1, -1, 0, 0, 0, 0, 0, 0, -1},
    {1, 1, -1, 0, 0, 0, 0, 0, 0, 1},  {1, 1, -1, 0, 0, 0, 0, 0, 0, 0},
    {1, 1, 0, 0, 0, 0, 0, 0, -1, 0},  {1, -1, 0, 0, 0, 0, 0, 0, -1, 0},
    {1, 1, 0, 0, 0, 0, 0, 0, 0, -1},  {0, 1, 0, 0, 0, 0, -4, 0, 0, 0},
    {1, -1, 0, 0, 0, 0, 0, 0, 0, -1},
};

static CagStatus patch_transform(const CagSurface *s, const CagTransform *t, CagSurface **out,
                                 CagError *err) {
  const Patch *p = (const Patch *)s;
  if (!cag_transform_is_affine(t)) return cag_surface_transform_placed(s, t, out, err);
  // A singular map leaves no quadric.
  CagTransform frame = cag_transform_multiply(t, &p->frame), unused;
  if (cag_transform_inverse(t, &unused, err)) return cag_surface_placed(s, t, false, out, err);
  CagStatus status = cag_surface_quadric(p->shape, &frame, s->u0, s->u1, s->v0, s->v1, out, err);
  if (status) return status;
  Patch *moved = (Patch *)*out;
  moved->within = p->within;
  if (p->within.pieces) moved->within.frame = cag_transform_multiply(t, &p->within.frame);
  return CAG_OK;
}

static void patch_describe(const CagSurface *s, char *buffer, size_t size) {
  snprintf(buffer, size, "%s", SHAPE[((const Patch *)s)->shape].text);
}

static void patch_digest(const CagSurface *surface, CagDigest *d) {
  const Patch *s = (const Patch *)surface;
  cag_digest_word(d, (uint64_t)s->shape);
  cag_transform_digest(&s->frame, d);
}

static const CagSurfaceKind quadric_kind = {
    .name = "quadric",
    .eval = patch_eval,
    .eval_grid = patch_grid,
    .to_nurbs = patch_to_nurbs,
    .transform = patch_transform,
    .describe = patch_describe,
    .digest = patch_digest,
};

CagStatus cag_surface_quadric(CagQuadricShape shape, const CagTransform *frame, double u0,
                              double u1, double v0, double v1, CagSurface **out, CagError *err) {
  CagQuadric unit, equation;
  for (int i = 0; i < 10; i++) unit.c[i] = UNIT_EQUATION[shape][i];
  CagStatus status = cag_quadric_transform(&unit, frame, &equation, err);
  CagSurface *s;
  if (!status) status = cag_surface_block(sizeof(Patch), &quadric_kind, u0, u1, v0, v1, &s, err);
  if (status) return status;
  Patch *p = (Patch *)s;
  p->shape = shape;
  p->frame = *frame;
  p->frame.planar = false;
  double w = frame->m[3][3];
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) p->frame.m[i][j] /= w;
  p->equation = equation;
  s->angular_u = SHAPE[shape].angular_u;
  s->angular_v = SHAPE[shape].angular_v;
  cag_surface_judge(s);
  *out = s;
  return CAG_OK;
}

bool cag_surface_quadric_view(const CagSurface *s, CagQuadric *equation) {
  if (s->kind != &quadric_kind) return false;
  if (equation) *equation = ((const Patch *)s)->equation;
  return true;
}

bool cag_surface_quadric_frame(const CagSurface *s, CagTransform *frame) {
  if (s->kind != &quadric_kind) return false;
  *frame = ((const Patch *)s)->frame;
  return true;
}

bool cag_surface_quadric_shape(const CagSurface *s, CagQuadricShape *shape) {
  if (s->kind != &quadric_kind) return false;
  *shape = ((const Patch *)s)->shape;
  return true;
}

bool cag_surface_quadric_within(const CagSurface *s, CagQuadricWithin *out) {
  const bool trimmed = cag_surface_trimmed_view(s, &s, NULL);
  if (s->kind != &quadric_kind) return false;
  *out = ((const Patch *)s)->within;
  return out->pieces > 0 && out->trimmed == trimmed;
}

// --- Reversing the normal ---

// The shapes are symmetric in the coordinate that is odd in u.
static CagStatus turn_patch(const Patch *p, CagSurface **out, CagError *err) {
  const int odd = p->shape == CAG_SHAPE_HYPERBOLIC_PARABOLOID ? 0 : 1;
  CagTransform frame = p->frame;
  for (int i = 0; i < 3; i++) frame.m[i][odd] = -frame.m[i][odd];
  const CagSurface *s = &p->base;
  CagStatus status = cag_surface_quadric(p->shape, &frame, -s->u1, -s->u0, s->v0, s->v1, out, err);
  if (!status) ((Patch *)*out)->within = p->within;
  return status;
}

CagStatus cag_surface_quadric_turn(const CagSurface *s, CagSurface **out, CagError *err) {
  const CagSurface *whole = s;
  const CagRegion *region;
  if (!cag_surface_trimmed_view(s, &whole, &region)) return turn_patch((const Patch *)s, out, err);
  CagTransform mirror = cag_transform_identity();
  mirror.m[0][0] = -1;
  CagRegion *image = NULL;
  CagSurface *turned = NULL;
  CagStatus status = cag_region_transform(region, &mirror, &image, err);
  if (!status) status = turn_patch((const Patch *)whole, &turned, err);
  if (!status) status = cag_surface_trimmed(turned, image, out, err);
  if (turned) cag_surface_release(turned);
  cag_region_release(image);
  return status;
}

// --- Extremes ---

// Finds the points at which the normal of the unit form is parallel to m, that is, at which its
// gradient (x, +-y, +-z or a constant) is a multiple of m. A cylinder has whole rulings of such
// points, and a cone has only its apex. The boundary of a piece has the same extremes.
static size_t unit_extremes(CagQuadricShape shape, CagVec3 m, CagVec3 out[2]) {
  double square;
  switch (shape) {
  case CAG_SHAPE_ELLIPSOID: square = cag_dot(m, m); break;
  case CAG_SHAPE_HYPERBOLOID_ONE: square = m.x * m.x + m.y * m.y - m.z * m.z; break;
  case CAG_SHAPE_HYPERBOLOID_TWO: square = m.z * m.z - m.x * m.x - m.y * m.y; break;
  case CAG_SHAPE_ELLIPTIC_PARABOLOID:
  case CAG_SHAPE_HYPERBOLIC_PARABOLOID: {
    if (m.z == 0) return 0;
    const double x = -m.x / (2 * m.z), y = -m.y / (2 * m.z);
    const bool saddle = shape == CAG_SHAPE_HYPERBOLIC_PARABOLOID;
    out[0] = saddle ? cag_vec3(x, -y, x * x - y * y) : cag_vec3(x, y, x * x + y * y);
    return 1;
  }
  default: return 0;
  }
  if (!(square > 0)) return 0;
  if (shape != CAG_SHAPE_ELLIPSOID) m.z = -m.z;
  out[0] = cag_scaled(m, 1 / sqrt(square));
  out[1] = cag_scaled(out[0], -1);
  return 2;
}

// The parameters of a point of the unit form on its own sheet. Angles are in -pi..pi.
static CagVec3 unit_parameters(CagQuadricShape shape, CagVec3 p) {
  const double u = atan2(p.y, p.x), r = hypot(p.x, p.y);
  switch (shape) {
  case CAG_SHAPE_ELLIPSOID: return cag_vec3(u, atan2(r, p.z), 0);
  case CAG_SHAPE_HYPERBOLOID_ONE: return cag_vec3(u, asinh(p.z), 0);
  case CAG_SHAPE_HYPERBOLOID_TWO: return cag_vec3(u, asinh(r), 0);
  case CAG_SHAPE_HYPERBOLIC_PARABOLOID: return cag_vec3(p.x, p.y, 0);
  default: return cag_vec3(u, r, 0);
  }
}

size_t cag_surface_quadric_extremes(const CagSurface *s, int axis, CagVec3 out[2]) {
  if (s->kind != &quadric_kind) return 0;
  const Patch *p = (const Patch *)s;
  const double *row = p->frame.m[axis];
  const size_t all = unit_extremes(p->shape, cag_vec3(row[0], row[1], row[2]), out);
  size_t n = 0;
  for (size_t i = 0; i < all; i++) {
    if (p->shape == CAG_SHAPE_HYPERBOLOID_TWO && out[i].z < 0) continue; // on the other sheet
    CagVec3 at = unit_parameters(p->shape, out[i]);
    while (s->angular_u && at.x > s->u1) at.x -= 2 * M_PI;
    while (s->angular_u && at.x < s->u0) at.x += 2 * M_PI;
    if (at.x >= s->u0 && at.x <= s->u1 && at.y >= s->v0 && at.y <= s->v1) out[n++] = at;
  }
  return n;
}

// --- Pieces within a box ---

// Maximum number of pieces: sheets, nappes, branches, planes, or what a box leaves of them. A box
// leaves at most 18, since its edges intersect a quadric in at most 24 points.
#define PIECES_MOST 32
typedef struct Pieces {
  CagSurface *s[PIECES_MOST];
  size_t n;
} Pieces;

typedef struct Clip {
  const CagQuadricForm *form;
  CagVec3 lo, hi; // range of canonical coordinates in the box; infinite without one
  CagQuadricSide sides[CAG_QUADRIC_SIDES];
  size_t side_count;
  double size;
} Clip;

// The unit form's frame: columns times the semi-axes (with signs), with the same origin.
static CagTransform scaled_frame(const CagQuadricForm *f, double a, double b, double c) {
  CagTransform t = f->frame;
  for (int i = 0; i < 3; i++) {
    t.m[i][0] *= a;
    t.m[i][1] *= b;
    t.m[i][2] *= c;
  }
  return t;
}

static CagStatus add_within(Pieces *p, const Clip *c, const CagQuadricSheet *sheet, CagError *err) {
  return cag_quadric_sheet_within(sheet, c->sides, c->side_count, p->s, PIECES_MOST, &p->n, err);
}

static CagStatus add_around(Pieces *p, const Clip *c, CagQuadricShape shape,
                            const CagTransform *frame, double v0, double v1, CagError *err) {
  return add_within(p, c, &(CagQuadricSheet){shape, *frame, 0, 2 * M_PI, v0, v1, c->size}, err);
}

static CagStatus pieces_about_axis(const Clip *c, Pieces *p, CagError *err) {
  const CagQuadricForm *f = c->form;
  double a = f->semi[0], b = f->semi[1], h = f->semi[2];
  CagTransform up = scaled_frame(f, a, b, h), down = scaled_frame(f, a, b, -h);
  CagStatus status;
  switch (f->class_id) {
  case CAG_QUADRIC_ELLIPSOID: return add_around(p, c, CAG_SHAPE_ELLIPSOID, &up, 0, M_PI, err);
  case CAG_QUADRIC_HYPERBOLOID_ONE:
    return add_around(p, c, CAG_SHAPE_HYPERBOLOID_ONE, &up, -INFINITY, INFINITY, err);
  case CAG_QUADRIC_HYPERBOLOID_TWO:
    status = add_around(p, c, CAG_SHAPE_HYPERBOLOID_TWO, &up, 0, INFINITY, err);
    if (status) return status;
    return add_around(p, c, CAG_SHAPE_HYPERBOLOID_TWO, &down, 0, INFINITY, err);
  case CAG_QUADRIC_CONE:
    status = add_around(p, c, CAG_SHAPE_CONE, &up, 0, INFINITY, err);
    if (status) return status;
    return add_around(p, c, CAG_SHAPE_CONE, &up, -INFINITY, 0, err);
  case CAG_QUADRIC_ELLIPTIC_PARABOLOID:
    up = scaled_frame(f, a, b, 1);
    return add_around(p, c, CAG_SHAPE_ELLIPTIC_PARABOLOID, &up, 0, INFINITY, err);
  default:
    up = scaled_frame(f, a, b, 1);
    return add_around(p, c, CAG_SHAPE_ELLIPTIC_CYLINDER, &up, -INFINITY, INFINITY, err);
  }
}

// For shapes without angles: over somewhat more of u than the box covers.
static CagStatus add_across(Pieces *p, const Clip *c, CagQuadricShape shape,
                            const CagTransform *frame, double u0, double u1, CagError *err) {
  const double room = (u1 - u0) / 64;
  return add_within(
      p, c, &(CagQuadricSheet){shape, *frame, u0 - room, u1 + room, -INFINITY, INFINITY, c->size},
      err);
}

static CagStatus pieces_across(const Clip *c, Pieces *p, CagError *err) {
  const CagQuadricForm *f = c->form;
  double a = f->semi[0], b = f->semi[1];
  CagTransform frame = scaled_frame(f, a, b, 1);
  if (f->class_id == CAG_QUADRIC_HYPERBOLIC_PARABOLOID)
    return add_across(p, c, CAG_SHAPE_HYPERBOLIC_PARABOLOID, &frame, c->lo.x / a, c->hi.x / a, err);
  if (f->class_id == CAG_QUADRIC_PARABOLIC_CYLINDER) {
    frame = scaled_frame(f, a, a, 1);
    return add_across(p, c, CAG_SHAPE_PARABOLIC_CYLINDER, &frame, c->lo.y / (2 * a),
                      c->hi.y / (2 * a), err);
  }
  for (int side = 0; side < 2; side++) {
    frame = scaled_frame(f, side == 0 ? a : -a, b, 1);
    CagStatus status = add_across(p, c, CAG_SHAPE_HYPERBOLIC_CYLINDER, &frame, asinh(c->lo.y / b),
                                  asinh(c->hi.y / b), err);
    if (status) return status;
  }
  return CAG_OK;
}

// --- Planes ---

#define POLYGON_MOST 12 // a square cut by six planes

// Keeps the side sign * coordinate <= sign * limit (Sutherland and Hodgman 1974).
static size_t cut(CagVec3 *polygon, size_t n, int axis, double limit, double sign) {
  CagVec3 kept[POLYGON_MOST];
  size_t count = 0;
  for (size_t i = 0; i < n && count + 2 <= POLYGON_MOST; i++) {
    CagVec3 p = polygon[i], q = polygon[(i + 1) % n];
    double at_p = sign * ((axis == 0 ? p.x : axis == 1 ? p.y : p.z) - limit);
    double at_q = sign * ((axis == 0 ? q.x : axis == 1 ? q.y : q.z) - limit);
    if (at_p <= 0) kept[count++] = p;
    if ((at_p < 0 && at_q > 0) || (at_p > 0 && at_q < 0))
      kept[count++] = cag_lerp(p, q, at_p / (at_p - at_q));
  }
  for (size_t i = 0; i < count; i++) polygon[i] = kept[i];
  return count;
}

// The part of a plane within the box, as a planar surface whose normal is z of the frame.
static CagStatus add_plane(Pieces *p, CagVec3 through, CagVec3 x, CagVec3 y, const CagBounds *box,
                           CagError *err) {
  CagVec3 middle = cag_lerp(box->min, box->max, 0.5), n = cag_cross(x, y);
  double reach = cag_norm(cag_sub(box->max, box->min));
  CagVec3 o = cag_madd(middle, -cag_dot(cag_sub(middle, through), n), n);
  CagVec3 polygon[POLYGON_MOST];
  const double corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  size_t count = 4;
  for (int i = 0; i < 4; i++)
    polygon[i] = cag_madd(cag_madd(o, corner[i][0] * reach, x), corner[i][1] * reach, y);
  const double lo[3] = {box->min.x, box->min.y, box->min.z};
  const double hi[3] = {box->max.x, box->max.y, box->max.z};
  for (int axis = 0; axis < 3; axis++) {
    count = cut(polygon, count, axis, hi[axis], 1);
    count = cut(polygon, count, axis, lo[axis], -1);
  }
  // Merges corners that coincide to rounding.
  CagVec3 flat[POLYGON_MOST];
  size_t distinct = 0;
  for (size_t i = 0; i < count; i++) {
    CagVec3 d = cag_sub(polygon[i], o), q = cag_vec3(cag_dot(d, x), cag_dot(d, y), 0);
    bool again = false;
    for (size_t k = 0; k < distinct; k++)
      again = again || cag_norm(cag_sub(q, flat[k])) <= CAG_SURFACE_SAME * reach;
    if (!again) flat[distinct++] = q;
  }
  if (distinct < 3) return CAG_OK;
  CagTransform frame;
  CagCurve *edge = NULL;
  CagRegion *region = NULL;
  CagStatus status = cag_axes(o, x, y, &frame, err);
  if (!status) status = cag_curve_polyline(flat, distinct, true, 2, &edge, err);
  if (!status) status = cag_region_new(edge, NULL, 0, &region, err);
  if (!status) status = cag_surface_planar(region, &frame, &p->s[p->n], err);
  if (!status) p->n++;
  cag_region_release(region);
  cag_curve_release(edge);
  return status;
}

static CagStatus pieces_of_planes(const CagQuadricForm *f, const CagBounds *box, Pieces *p,
                                  CagError *err) {
  CagVec3 e[3], o = cag_vec3(f->frame.m[0][3], f->frame.m[1][3], f->frame.m[2][3]);
  for (int j = 0; j < 3; j++) e[j] = cag_vec3(f->frame.m[0][j], f->frame.m[1][j], f->frame.m[2][j]);
  CagStatus status = CAG_OK;
  switch (f->class_id) {
  case CAG_QUADRIC_PLANE: return add_plane(p, o, e[0], e[1], box, err);
  case CAG_QUADRIC_COINCIDENT_PLANES: return add_plane(p, o, e[1], e[2], box, err);
  case CAG_QUADRIC_PARALLEL_PLANES:
    for (int side = 0; !status && side < 2; side++)
      status = add_plane(p, cag_madd(o, side == 0 ? f->semi[0] : -f->semi[0], e[0]), e[1], e[2],
                         box, err);
    return status;
  default: // X / a = +- Y / b
    for (int side = 0; !status && side < 2; side++) {
      CagVec3 x =
          cag_madd(cag_scaled(e[0], f->semi[0]), side == 0 ? f->semi[1] : -f->semi[1], e[1]);
      status = add_plane(p, o, cag_unit(x), e[2], box, err);
    }
    return status;
  }
}

// The sides of the box, or the two of the range of z, and the range of canonical coordinates.
static CagStatus set_clip(const CagQuadricForm *f, const CagBounds *within, bool z_only, Clip *out,
                          CagError *err) {
  *out = (Clip){.form = f, .size = cag_norm(cag_vec3(f->semi[0], f->semi[1], f->semi[2]))};
  if (!within) return CAG_OK;
  const CagVec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const double lo[3] = {within->min.x, within->min.y, within->min.z};
  const double hi[3] = {within->max.x, within->max.y, within->max.z};
  for (int i = z_only ? 2 : 0; i < 3; i++) {
    out->sides[out->side_count++] = (CagQuadricSide){axes[i], hi[i]};
    out->sides[out->side_count++] = (CagQuadricSide){cag_scaled(axes[i], -1), -lo[i]};
  }
  out->size = z_only ? within->max.z - within->min.z : cag_norm(cag_sub(within->max, within->min));
  if (z_only) return CAG_OK;
  CagTransform back;
  CagStatus status = cag_transform_inverse(&f->frame, &back, err);
  if (status) return status;
  CagBounds box = CAG_BOUNDS_EMPTY;
  for (int k = 0; k < 8; k++)
    cag_bounds_add(&box,
                   cag_transform_point(&back, cag_vec3(k & 1 ? within->max.x : within->min.x,
                                                       k & 2 ? within->max.y : within->min.y,
                                                       k & 4 ? within->max.z : within->min.z)));
  out->lo = box.min;
  out->hi = box.max;
  return CAG_OK;
}

// Components of z across the axis below this fraction of those along it are rounding.
#define LEVEL 1e-9

// Whether all planes of constant z intersect the quadric in ellipses, so that a range of z bounds
// it.
static bool is_bounded_by_z(const CagQuadricForm *f) {
  const double a = f->frame.m[2][0] * f->semi[0], b = f->frame.m[2][1] * f->semi[1];
  const double along = fabs(f->frame.m[2][2]);
  switch (f->class_id) {
  case CAG_QUADRIC_ELLIPSOID: return true;
  case CAG_QUADRIC_ELLIPTIC_PARABOLOID:
  case CAG_QUADRIC_ELLIPTIC_CYLINDER: return along > LEVEL;
  default: return hypot(a, b) < along * f->semi[2] * (1 - LEVEL);
  }
}

static CagStatus check_within(const CagBounds *w, bool z_only, CagError *err) {
  const double lo[3] = {w->min.x, w->min.y, w->min.z}, hi[3] = {w->max.x, w->max.y, w->max.z};
  for (int i = z_only ? 2 : 0; i < 3; i++)
    if (!isfinite(lo[i]) || !isfinite(hi[i]) || !(hi[i] > lo[i])) {
      char a[32], b[32];
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_empty_range, "within", i,
                      "`within` must be finite and increase in %c, found %s..%s", "xyz"[i],
                      cag_number_text(lo[i], a), cag_number_text(hi[i], b));
    }
  return CAG_OK;
}

static CagStatus find_pieces(const CagQuadricForm *f, const CagBounds *within, bool z_only,
                             Pieces *p, CagError *err) {
  Clip clip;
  CagStatus status = set_clip(f, within, z_only, &clip, err);
  if (status) return status;
  bool needs_box = false;
  switch (f->class_id) {
  case CAG_QUADRIC_ELLIPSOID: return pieces_about_axis(&clip, p, err);
  case CAG_QUADRIC_HYPERBOLOID_ONE:
  case CAG_QUADRIC_HYPERBOLOID_TWO:
  case CAG_QUADRIC_CONE:
  case CAG_QUADRIC_ELLIPTIC_PARABOLOID:
  case CAG_QUADRIC_ELLIPTIC_CYLINDER:
    if (within && (!z_only || is_bounded_by_z(f))) return pieces_about_axis(&clip, p, err);
    needs_box = z_only;
    break;
  case CAG_QUADRIC_HYPERBOLIC_PARABOLOID:
  case CAG_QUADRIC_HYPERBOLIC_CYLINDER:
  case CAG_QUADRIC_PARABOLIC_CYLINDER:
    if (within && !z_only) return pieces_across(&clip, p, err);
    needs_box = true;
    break;
  case CAG_QUADRIC_INTERSECTING_PLANES:
  case CAG_QUADRIC_PARALLEL_PLANES:
  case CAG_QUADRIC_COINCIDENT_PLANES:
  case CAG_QUADRIC_PLANE:
    if (within && !z_only) return pieces_of_planes(f, within, p, err);
    needs_box = true;
    break;
  default:
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_quadric_imaginary, "coefficients", -1,
                    "the equation has no real surface: its class is %s; a sphere of radius r has "
                    "the constant -r^2",
                    f->name);
  }
  return cag_fail(
      err, CAG_E_ARGUMENT, CAG_ERR_quadric_unbounded, "within", -1,
      needs_box
          ? "a quadric of class %s is unbounded, even in a range of z; set `within` to a box, such as box([4, 4, 4], centered: true)"
          : "a quadric of class %s is unbounded; set `within` to a range of z or a box",
      f->name);
}

// Tests whether q has the opposite sign of the equation stored in the patch.
static bool is_negated(const CagQuadric *q, const CagQuadric *of_patch) {
  double sum = 0;
  for (int i = 0; i < 10; i++) sum += q->c[i] * of_patch->c[i];
  return sum < 0;
}

// Records the origin of the pieces, which are not shared yet.
static void set_within(const Pieces *pieces, const CagQuadric *q, const CagBounds *box,
                       bool z_only) {
  for (size_t i = 0; i < pieces->n; i++) {
    const CagSurface *whole = pieces->s[i];
    const bool trimmed = cag_surface_trimmed_view(whole, &whole, NULL);
    if (whole->kind != &quadric_kind) continue;
    Patch *p = (Patch *)whole;
    p->within = (CagQuadricWithin){*box,      z_only,  cag_transform_identity(),
                                   pieces->n, trimmed, is_negated(q, &p->equation)};
    p->within.frame.planar = false;
  }
}

CagStatus cag_quadric_patches(const CagQuadric *q, const CagBounds *within, bool z_only,
                              CagSurface ***out, size_t *n, CagError *err) {
  CagQuadricForm form;
  Pieces pieces = {.n = 0};
  CagStatus status = cag_quadric_classify(q, &form, err);
  if (!status && within) status = check_within(within, z_only, err);
  if (!status) status = find_pieces(&form, within, z_only, &pieces, err);
  if (!status && pieces.n == 0)
    status =
        cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_quadric_outside, "within", -1,
                 "the quadric (%s) does not pass through `within`: move or enlarge it", form.name);
  if (!status && within) set_within(&pieces, q, within, z_only);
  CagSurface **list = NULL;
  if (!status) {
    list = cag_malloc(pieces.n * sizeof *list);
    if (!list) status = cag_fail_memory(err);
  }
  if (status) {
    for (size_t i = 0; i < pieces.n; i++) cag_surface_release(pieces.s[i]);
    return status;
  }
  for (size_t i = 0; i < pieces.n; i++) list[i] = pieces.s[i];
  *out = list;
  *n = pieces.n;
  return CAG_OK;
}
