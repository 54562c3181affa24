// The nearest point of a set operation near a point of its mesh.
//
// Close to that point are some of the smooth sheets of which the boundaries of the operands consist:
// planes, quadrics, tori, and other surfaces, without their ends. The nearest point is on one sheet,
// on the edge of two, or at the corner of three. For each of these sets, it is found by Newton's
// method in the plane or line that the tangent planes have in common; the derivatives, which contain
// the curvatures, are differences. The closest solution on the boundary of the result counts.

#include "base/stop.h"
#include "geom/ray/caster_parts.h"
#include "geom/ray/nearest.h"
#include "geom/surface/nearest.h"
#include "geom/surface/quadric_equation.h"
#include "geom/surface/quadric_nearest.h"

// The step of differences, as a fraction of the size: a compromise between curvature and rounding.
#define DIFFERENCE 1e-6
// Planes that intersect at a smaller squared sine are parallel.
#define PARALLEL 1e-10
// Sheets closer than this fraction of the size, with the same tangent plane, are one.
#define SAME_SHEET 1e-9
// Smaller determinants of derivatives, which are about 1 on flat boundaries, are rounding. There, all
// points are equally near if the way to the nearest one is at most this fraction of the size.
#define SINGULAR 1e-6
#define LEVEL 1e-6
// The last step, and the distance of the result from the boundary, as fractions of the size.
#define LAST_STEP 1e-11
#define ON_BOUNDARY 1e-8
// The nearest points of a boundary and of its mesh are farther apart along it than across it: at
// most this many times the geometric mean of the reach and the size.
#define ALONG 4.0
// The distance of the result exceeds that of the mesh by at most this fraction of the reach.
#define ACROSS 0.1
enum { SHEETS_MAX = 8, ACTIVE_MAX = 3, ITERATIONS = 12 };

typedef enum SheetKind { SHEET_PLANE, SHEET_QUADRIC, SHEET_TORUS, SHEET_SURFACE } SheetKind;

typedef struct Sheet {
  SheetKind kind;
  CagPlane plane; // of a PLANE; of others, the tangent plane at the start
  CagQuadric form;
  const CagCaster *leaf;
  const CagSurface *surface;
  bool placed;
  CagTransform placement; // of the surface, if it is placed
} Sheet;

typedef struct Spot {
  Sheet sheets[SHEETS_MAX];
  int n;
  bool full; // there are more
  CagVec3 start;
  double reach, size;
} Spot;

// --- Tangent planes ---

static CagPlane placed_plane(const CagTransform *t, CagVec3 point, CagVec3 normal) {
  const CagVec3 other = fabs(normal.z) < 0.7 ? cag_vec3(0, 0, 1) : cag_vec3(1, 0, 0);
  const CagVec3 a = cag_cross(normal, other), b = cag_cross(normal, a);
  return (CagPlane){cag_transform_point(t, point),
                    cag_unit(cag_cross(cag_transform_vector(t, a), cag_transform_vector(t, b)))};
}

static CagPlane torus_plane(const CagRayPrimitive *p, CagVec3 at) {
  CagVec3 foot;
  cag_ray_primitive_closest(p, at, &foot);
  const CagVec3 own = cag_transform_point(&p->back, foot);
  const double rho = hypot(own.x, own.y), k = rho > 0 ? p->solid->a / rho : 0;
  return placed_plane(&p->placement, own, cag_vec3(own.x * (1 - k), own.y * (1 - k), own.z));
}

static CagStatus surface_plane(const Sheet *s, CagVec3 at, CagPlane *out, CagError *err) {
  CagSurfaceNearest found;
  CagVec3 d[4];
  const CagVec3 own = s->placed ? cag_transform_point(&s->leaf->back, at) : at;
  CagStatus status = cag_surface_closest(s->surface, own, &found, err);
  if (!status)
    status =
        cag_surface_eval(s->surface, found.u, found.v, 1, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err);
  if (status) return status;
  const CagVec3 normal = cag_cross(d[cag_partial(1, 1, 0)], d[cag_partial(1, 0, 1)]);
  if (s->placed) *out = placed_plane(&s->placement, found.point, normal);
  else *out = (CagPlane){found.point, cag_unit(normal)};
  return CAG_OK;
}

// The tangent plane at the point of the sheet closest to x.
static CagStatus sheet_plane(const Sheet *s, CagVec3 x, CagPlane *out, bool *good, CagError *err) {
  CagStatus status = CAG_OK;
  CagVec3 foot;
  *out = s->plane;
  *good = true;
  switch (s->kind) {
  case SHEET_PLANE: break;
  case SHEET_QUADRIC:
    *good = cag_quadric_closest(&s->form, x, &foot);
    if (*good) *out = (CagPlane){foot, cag_unit(cag_quadric_gradient(&s->form, foot))};
    break;
  case SHEET_TORUS: *out = torus_plane(&s->leaf->primitive, x); break;
  case SHEET_SURFACE: status = surface_plane(s, x, out, err);
  }
  *good = *good && cag_norm(out->normal) > 0;
  return status;
}

// --- Sheets ---

// Adds a sheet if it is within reach, and is not one of those that are known.
static CagStatus add_sheet(Spot *spot, Sheet sheet, CagError *err) {
  CagPlane at;
  bool good;
  CagStatus status = sheet_plane(&sheet, spot->start, &at, &good, err);
  if (status || !good) return status;
  const CagVec3 off = cag_sub(at.point, spot->start);
  const double across = fabs(cag_dot(off, at.normal));
  if (across > spot->reach || (sheet.kind != SHEET_PLANE && cag_norm(off) > spot->reach))
    return CAG_OK;
  for (int i = 0; i < spot->n; i++) {
    const CagPlane *known = &spot->sheets[i].plane;
    const CagVec3 cross = cag_cross(known->normal, at.normal);
    if (spot->sheets[i].kind == sheet.kind && cag_dot(cross, cross) <= PARALLEL &&
        fabs(cag_dot(known->normal, cag_sub(at.point, known->point))) <= SAME_SHEET * spot->size)
      return CAG_OK;
  }
  spot->full = spot->n == SHEETS_MAX;
  if (spot->full) return CAG_OK;
  sheet.plane = at;
  spot->sheets[spot->n++] = sheet;
  return CAG_OK;
}

static CagStatus add_plane(Spot *spot, CagPlane plane, CagError *err) {
  const Sheet sheet = {.kind = SHEET_PLANE, .plane = plane};
  return add_sheet(spot, sheet, err);
}

static CagStatus add_quadric(Spot *spot, const CagQuadric *own, const CagTransform *placement,
                             CagError *err) {
  Sheet sheet = {.kind = SHEET_QUADRIC};
  CagStatus status = cag_quadric_transform(own, placement, &sheet.form, err);
  return status ? status : add_sheet(spot, sheet, err);
}

static CagStatus add_box(Spot *spot, const CagRayPrimitive *p, CagError *err) {
  const CagBounds b = cag_ray_primitive_bounds(p);
  CagStatus status = CAG_OK;
  for (int k = 0; !status && k < 6; k++) {
    const CagVec3 normal = {k / 2 == 0, k / 2 == 1, k / 2 == 2};
    status = add_plane(spot, placed_plane(&p->placement, k % 2 ? b.max : b.min, normal), err);
  }
  return status;
}

// The ends, and the side: x^2 + y^2 = (b + slope z)^2.
static CagStatus add_frustum(Spot *spot, const CagRayPrimitive *p, CagError *err) {
  const CagSolid *s = p->solid;
  const double slope = (s->c - s->b) / s->a;
  const CagQuadric side = {
      .c = {1, 1, -slope * slope, 0, 0, 0, 0, 0, -2 * slope * s->b, -s->b * s->b}};
  const CagVec3 up = {0, 0, 1};
  CagStatus status = add_quadric(spot, &side, &p->placement, err);
  if (!status) status = add_plane(spot, placed_plane(&p->placement, cag_vec3(0, 0, 0), up), err);
  if (!status) status = add_plane(spot, placed_plane(&p->placement, cag_vec3(0, 0, s->a), up), err);
  return status;
}

static CagStatus add_primitive(Spot *spot, const CagCaster *c, CagError *err) {
  const CagRayPrimitive *p = &c->primitive;
  const double r = p->solid->a;
  CagStatus status = CAG_OK;
  if (p->solid->kind == CAG_SOLID_BOX) return add_box(spot, p, err);
  if (p->solid->kind == CAG_SOLID_CYLINDER) return add_frustum(spot, p, err);
  if (p->solid->kind == CAG_SOLID_SPHERE) {
    const CagQuadric sphere = {.c = {1, 1, 1, 0, 0, 0, 0, 0, 0, -r * r}};
    return add_quadric(spot, &sphere, &p->placement, err);
  }
  if (!c->image) return add_sheet(spot, (Sheet){.kind = SHEET_TORUS, .leaf = c}, err);
  for (size_t i = 0; !status && i < c->image->face_count; i++) {
    const Sheet sheet = {.kind = SHEET_SURFACE, .surface = c->image->faces[i]};
    status = add_sheet(spot, sheet, err);
  }
  return status;
}

static CagStatus add_faces(Spot *spot, const CagCaster *c, CagError *err) {
  CagTransform placement = cag_transform_identity();
  double scale = 1;
  CagStatus status = CAG_OK;
  if (c->placed) {
    status = cag_transform_inverse(&c->back, &placement, err);
    cag_transform_is_similarity(&placement, &scale);
  }
  const CagVec3 own = c->placed ? cag_transform_point(&c->back, spot->start) : spot->start;
  for (size_t i = 0; !status && i < c->face_count; i++) {
    const CagRayPatch *f = c->faces[i];
    if (cag_bounds_distance(&f->bounds, own) * scale > spot->reach) continue;
    const Sheet curved = {.kind = SHEET_SURFACE,
                          .leaf = c,
                          .surface = f->surface,
                          .placed = c->placed,
                          .placement = placement};
    status = f->flat == CAG_RAY_CURVED
                 ? add_sheet(spot, curved, err)
                 : add_plane(spot, placed_plane(&placement, f->origin, cag_cross(f->x, f->y)), err);
  }
  return status;
}

// The triangle of a mesh that is closest to the start.
static CagStatus add_triangle(Spot *spot, const CagCaster *c, CagError *err) {
  CagTransform placement = cag_transform_identity();
  CagStatus status = c->placed ? cag_transform_inverse(&c->back, &placement, err) : CAG_OK;
  const CagVec3 own = c->placed ? cag_transform_point(&c->back, spot->start) : spot->start;
  CagVec3 point, p[3];
  uint32_t face;
  if (status || !cag_ray_mesh_closest(c->mesh, own, INFINITY, &point, &face)) return status;
  const CagMesh *m = c->mesh->mesh;
  for (int k = 0; k < 3; k++) p[k] = m->positions[m->triangles[3 * (size_t)face + (size_t)k]];
  const CagVec3 normal = cag_cross(cag_sub(p[1], p[0]), cag_sub(p[2], p[0]));
  return add_plane(spot, placed_plane(&placement, p[0], normal), err);
}

static CagStatus collect_sheets(Spot *spot, const CagCaster *c, CagError *err) {
  CagStatus status = cag_stop_check(err);
  if (status ||
      (c->kind != CAG_CASTER_FORM && cag_bounds_distance(&c->bounds, spot->start) > spot->reach))
    return status;
  const Sheet form = {.kind = SHEET_QUADRIC, .form = c->form};
  switch (c->kind) {
  case CAG_CASTER_OPERATION:
    for (size_t i = 0; !status && !spot->full && i < c->operand_count; i++)
      status = collect_sheets(spot, c->operands[i], err);
    return status;
  case CAG_CASTER_PRIMITIVE: return add_primitive(spot, c, err);
  case CAG_CASTER_FORM: return add_sheet(spot, form, err);
  case CAG_CASTER_FACES: return add_faces(spot, c, err);
  default: return add_triangle(spot, c, err);
  }
}

// --- Newton's method ---

// The point that all planes have in common and that is closest to a given one. Returns false if they
// are parallel.
static bool common_foot(const CagPlane *planes, int n, CagVec3 to, CagVec3 *out) {
  double off[ACTIVE_MAX] = {0};
  const CagVec3 a = planes[0].normal;
  for (int i = 0; i < n; i++) off[i] = cag_dot(planes[i].normal, cag_sub(planes[i].point, to));
  if (n == 1) {
    *out = cag_madd(to, off[0], a);
    return true;
  }
  const CagVec3 b = planes[1].normal, ab = cag_cross(a, b);
  const double square = cag_dot(ab, ab);
  if (!(square > PARALLEL)) return false;
  if (n == 2) {
    const CagVec3 step =
        cag_add(cag_scaled(cag_cross(b, ab), off[0]), cag_scaled(cag_cross(ab, a), off[1]));
    *out = cag_madd(to, 1 / square, step);
    return true;
  }
  const CagVec3 c = planes[2].normal;
  const double det = cag_dot(ab, c);
  if (!(det * det > PARALLEL)) return false;
  const CagVec3 step =
      cag_add(cag_add(cag_scaled(cag_cross(b, c), off[0]), cag_scaled(cag_cross(c, a), off[1])),
              cag_scaled(ab, off[2]));
  *out = cag_madd(to, 1 / det, step);
  return true;
}

// Sheets that the nearest point is on, and the point of interest.
typedef struct Active {
  const Sheet *sheets[ACTIVE_MAX];
  int n;
  CagVec3 p;
  double size;
} Active;

// The tangent planes at x, the point of the boundary there, and the way from it to the foot of p.
typedef struct Tangent {
  CagPlane planes[ACTIVE_MAX];
  CagVec3 at, way;
} Tangent;

static CagStatus tangent_at(const Active *a, CagVec3 x, Tangent *out, bool *good, CagError *err) {
  CagVec3 foot;
  CagStatus status = cag_stop_check(err);
  *good = true;
  for (int i = 0; !status && *good && i < a->n; i++)
    status = sheet_plane(a->sheets[i], x, &out->planes[i], good, err);
  if (status || !*good) return status;
  *good =
      common_foot(out->planes, a->n, x, &out->at) && common_foot(out->planes, a->n, a->p, &foot);
  if (*good) out->way = cag_sub(foot, out->at);
  return CAG_OK;
}

// The directions along the boundary: two, one along an edge, none at a corner.
static int directions_of(const Tangent *t, int n, CagVec3 out[2]) {
  const CagVec3 normal = t->planes[0].normal;
  if (n == 3) return 0;
  if (n == 2) {
    out[0] = cag_unit(cag_cross(normal, t->planes[1].normal));
    return 1;
  }
  const CagVec3 other = fabs(normal.z) < 0.7 ? cag_vec3(0, 0, 1) : cag_vec3(1, 0, 0);
  out[0] = cag_unit(cag_cross(normal, other));
  out[1] = cag_cross(normal, out[0]);
  return 2;
}

// The step along the directions at which the way to the foot of p vanishes.
static CagStatus newton_step(const Active *a, const Tangent *t, CagVec3 *step, bool *good,
                             CagError *err) {
  CagVec3 along[2];
  double j[2][2] = {{-1, 0}, {0, -1}}, r[2] = {0, 0};
  const int n = directions_of(t, a->n, along);
  const double by = DIFFERENCE * a->size;
  *step = cag_vec3(0, 0, 0);
  *good = true;
  for (int k = 0; k < n; k++) {
    Tangent beside;
    CagStatus status = tangent_at(a, cag_madd(t->at, by, along[k]), &beside, good, err);
    if (status || !*good) return status;
    r[k] = cag_dot(t->way, along[k]);
    for (int i = 0; i < n; i++)
      j[i][k] = (cag_dot(beside.way, along[i]) - cag_dot(t->way, along[i])) / by;
  }
  const double det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
  if (n == 0) return CAG_OK;
  if (!(fabs(det) > SINGULAR)) { // all points near it are equally near, or the method fails
    *good = cag_norm(t->way) <= LEVEL * a->size;
    return CAG_OK;
  }
  *step = cag_scaled(along[0], (j[0][1] * r[1] - j[1][1] * r[0]) / det);
  if (n == 2) *step = cag_madd(*step, (j[1][0] * r[0] - j[0][0] * r[1]) / det, along[1]);
  return CAG_OK;
}

// Finds a point at which p is on the normals of the sheets.
static CagStatus solve_active(const Active *a, const Spot *spot, CagVec3 *out, bool *found,
                              CagError *err) {
  const double along = ALONG * sqrt(spot->reach * spot->size);
  CagVec3 x = spot->start;
  CagStatus status = CAG_OK;
  bool good = true;
  *found = false;
  for (int i = 0; !status && good && !*found && i < ITERATIONS; i++) {
    Tangent t;
    CagVec3 step = {0, 0, 0};
    status = tangent_at(a, x, &t, &good, err);
    if (!status && good) status = newton_step(a, &t, &step, &good, err);
    if (status || !good) break;
    const CagVec3 next = cag_add(t.at, step);
    *found = cag_norm(cag_sub(next, x)) <= LAST_STEP * spot->size;
    x = next;
    good = cag_norm(cag_sub(x, spot->start)) <= along;
  }
  *found = *found && good;
  *out = x;
  return status;
}

// --- Candidates ---

// Whether a solution is on the boundary of the result. At an edge, the other side of it need not be
// inside.
static CagStatus is_on_boundary(const CagCaster *c, const Spot *spot, const Active *a,
                                const CagNearest *found, CagCrossings *work, bool *on,
                                CagError *err) {
  int side = 1;
  if (a->n == 1) return cag_operation_ends_at(c, a->p, found, work, on, err);
  CagStatus status = cag_caster_side(c, found->point, ON_BOUNDARY * spot->size, work, &side, err);
  *on = side == 0;
  return status;
}

// Tries the sheets of a set, the bits of `which`.
static CagStatus try_sheets(const CagCaster *c, const Spot *spot, unsigned which, CagVec3 p,
                            double most, CagCrossings *work, CagNearest *best, CagError *err) {
  Active a = {.p = p, .size = spot->size};
  for (int i = 0; i < spot->n; i++) {
    if (!(which >> i & 1)) continue;
    if (a.n == ACTIVE_MAX) return CAG_OK;
    a.sheets[a.n++] = &spot->sheets[i];
  }
  CagNearest next = {.found = true, .certain = true};
  bool found;
  CagStatus status = solve_active(&a, spot, &next.point, &found, err);
  next.distance = cag_norm(cag_sub(next.point, p));
  if (status || !found || !(next.distance < fmin(best->distance, most))) return status;
  status = is_on_boundary(c, spot, &a, &next, work, &found, err);
  if (!status && found) *best = next;
  return status;
}

CagStatus cag_caster_polish(const CagCaster *c, CagVec3 p, CagVec3 start, double reach,
                            CagCrossings *work, CagNearest *out, CagError *err) {
  Spot spot = {.start = start, .reach = reach, .size = c->size > 0 ? c->size : 1};
  const double most = cag_norm(cag_sub(start, p)) + ACROSS * reach;
  *out = (CagNearest){.distance = INFINITY};
  CagStatus status = collect_sheets(&spot, c, err);
  if (spot.full) return status;
  for (unsigned which = 1; !status && which < 1u << spot.n; which++)
    status = try_sheets(c, &spot, which, p, most, work, out, err);
  return status;
}
