// Detects coincident faces of different operands.
//
// Each face of each operand is approximated by a coarse mesh. If two triangles of different
// operands overlap, closer than the meshes are to their surfaces, the center of their intersection
// is moved to the first surface and projected onto the second: exact points and normals decide.
// Faces of meshes are exact already; half spaces and quadrics are compared by their forms.

#include "geom/solid/general.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/linalg/tolerance.h"

// Faces closer than this fraction of the size of all operands coincide. Renderers compute distances
// along rays to about 1e-6 of the size, and subtracted operands are enlarged by 4e-5.
#define COINCIDENT 1e-4
// Sine of the largest angle between normals of faces that coincide.
#define PARALLEL 1e-3
// Tolerance of the coarse meshes, as a fraction of the size of their operand.
#define COARSE 5e-3
// Minimum cosine of the angle between overlapping triangles of coincident surfaces.
#define OVER 0.5
// Overlaps with an area below this fraction of the squared size are edges.
#define AREA_LEAST CAG_COINCIDENT

typedef struct Piece {
  CagSurface *surface; // NULL: the triangles are the face
  CagMesh *mesh;
  CagBounds box;
  double tolerance; // of the mesh
  size_t leaf;      // the operand
} Piece;

typedef struct Side {
  CagQuadric form, centered; // the latter relative to the middle of all pieces
  size_t leaf;
} Side;

typedef struct Search {
  Piece *pieces;
  size_t count, room;
  Side *sides;
  size_t side_count, side_room;
  size_t leaves;
  double size, slack;
  const volatile int *interrupt;
} Search;

static void search_free(Search *s) {
  for (size_t i = 0; i < s->count; i++) {
    cag_surface_release(s->pieces[i].surface);
    cag_mesh_release(s->pieces[i].mesh);
  }
  cag_free(s->pieces);
  cag_free(s->sides);
}

// --- Collecting ---

// Takes ownership of the mesh and the surface.
static bool add_piece(Search *s, CagSurface *surface, CagMesh *mesh, double tolerance) {
  if (!CAG_RESERVE(s->pieces, s->room, s->count + 1)) {
    cag_surface_release(surface);
    cag_mesh_release(mesh);
    return false;
  }
  s->pieces[s->count++] = (Piece){surface, mesh, cag_mesh_bounds(mesh), tolerance, s->leaves};
  return true;
}

static bool add_side(Search *s, const CagQuadric *form) {
  if (!CAG_RESERVE(s->sides, s->side_room, s->side_count + 1)) return false;
  s->sides[s->side_count++] = (Side){*form, *form, s->leaves};
  return true;
}

static bool add_faces(Search *s, const CagSolid *leaf) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagBounds box;
  CagError err;
  if (cag_solid_reach(leaf, &box, &err)) return false;
  how.tolerance = COARSE * cag_norm(cag_sub(box.max, box.min));
  how.interrupt = s->interrupt;
  for (size_t f = 0; f < leaf->face_count; f++) {
    CagMesh *mesh;
    if (cag_surface_tessellate(leaf->faces[f], &how, &mesh, &err)) return false;
    if (!add_piece(s, cag_surface_retain(leaf->faces[f]), mesh, how.tolerance)) return false;
  }
  return true;
}

static bool add_mesh(Search *s, const CagSolid *leaf) {
  CagMesh *mesh;
  CagError err;
  return !cag_mesh_transform(leaf->core->mesh, &leaf->placement, &mesh, &err) &&
         add_piece(s, NULL, mesh, 0);
}

static bool collect(Search *s, const CagSolid *solid) {
  CagQuadric form;
  CagError err;
  bool ok = true;
  if (cag_solid_form(solid, &form)) ok = add_side(s, &form);
  else if (solid->kind == CAG_SOLID_MESH) ok = add_mesh(s, solid);
  else if (!cag_solid_is_compound(solid)) ok = add_faces(s, solid);
  else {
    for (size_t i = 0; ok && i < solid->core->count; i++) {
      CagSolid *placed;
      if (cag_solid_transform(solid->core->operands[i], &solid->placement, &placed, &err))
        return false;
      ok = collect(s, placed);
      cag_solid_release(placed);
    }
    return ok;
  }
  s->leaves++;
  return ok;
}

// --- Exact points ---

// A triangle of a piece.
typedef struct Facet {
  const Piece *piece;
  const uint32_t *v;
  CagBounds box;
} Facet;

static CagVec3 corner(const Facet *f, int k) { return f->piece->mesh->positions[f->v[k]]; }

static CagVec3 facet_normal(const Facet *f) {
  return cag_unit(
      cag_cross(cag_sub(corner(f, 1), corner(f, 0)), cag_sub(corner(f, 2), corner(f, 0))));
}

static CagVec3 chord_point(const Facet *f, const double weight[3]) {
  CagVec3 p = {0, 0, 0};
  for (int k = 0; k < 3; k++) p = cag_madd(p, weight[k], corner(f, k));
  return p;
}

static void parameters(const Facet *f, const double weight[3], double uv[2]) {
  uv[0] = uv[1] = 0;
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < 2; i++) uv[i] += weight[k] * f->piece->mesh->uv[2 * f->v[k] + (uint32_t)i];
}

static double clamped(double x, double low, double high) { return fmin(fmax(x, low), high); }

// The point of the face that corresponds to a point of the triangle, and its normal. False: none
// nearby.
static bool exact_point(const Facet *f, const double weight[3], CagVec3 *p, CagVec3 *normal) {
  const CagSurface *s = f->piece->surface;
  CagError err;
  double uv[2];
  *p = chord_point(f, weight);
  *normal = facet_normal(f);
  if (!s) return true;
  const CagVec3 chord = *p;
  parameters(f, weight, uv);
  return !cag_surface_point(s, uv[0], uv[1], p, &err) &&
         !cag_surface_normal(s, uv[0], uv[1], normal, &err) &&
         cag_norm(cag_sub(*p, chord)) <= 4 * f->piece->tolerance;
}

// The foot point on the face of a point over the triangle, by Newton's method.
static bool project(const Facet *f, const double weight[3], CagVec3 p, CagVec3 *foot,
                    CagVec3 *normal) {
  const int steps = 12; // quadratic from a start within the tolerance
  const CagSurface *s = f->piece->surface;
  CagVec3 d[4];
  CagError err;
  double uv[2];
  if (!s) {
    *normal = facet_normal(f);
    *foot = cag_madd(p, cag_dot(cag_sub(corner(f, 0), p), *normal), *normal);
    return true;
  }
  parameters(f, weight, uv);
  for (int i = 0; i < steps; i++) {
    if (cag_surface_eval(s, uv[0], uv[1], 1, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, &err)) return false;
    const CagVec3 off = cag_sub(p, d[0]), du = d[cag_partial(1, 1, 0)],
                  dv = d[cag_partial(1, 0, 1)];
    const double uu = cag_dot(du, du), vv = cag_dot(dv, dv), mixed = cag_dot(du, dv);
    const double det = uu * vv - mixed * mixed, x = cag_dot(off, du), y = cag_dot(off, dv);
    if (!(det > 1e-12 * uu * vv)) break; // a pole
    uv[0] = clamped(uv[0] + (x * vv - y * mixed) / det, s->u0, s->u1);
    uv[1] = clamped(uv[1] + (y * uu - x * mixed) / det, s->v0, s->v1);
  }
  return !cag_surface_point(s, uv[0], uv[1], foot, &err) &&
         !cag_surface_normal(s, uv[0], uv[1], normal, &err);
}

static bool is_parallel(CagVec3 m, CagVec3 n) { return cag_norm(cag_cross(m, n)) <= PARALLEL; }

// --- Two triangles ---

typedef struct Flat {
  double x, y;
} Flat;

static double turn(Flat a, Flat b, Flat c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The part of a polygon to the left of the line a, b (Sutherland and Hodgman 1974).
static int cut(const Flat *in, int n, Flat a, Flat b, Flat *out) {
  int count = 0;
  for (int i = 0; i < n; i++) {
    const Flat p = in[i], q = in[(i + 1) % n];
    const double s = turn(a, b, p), t = turn(a, b, q);
    if (s >= 0) out[count++] = p;
    if ((s < 0) != (t < 0)) {
      const double f = s / (s - t);
      out[count++] = (Flat){p.x + f * (q.x - p.x), p.y + f * (q.y - p.y)};
    }
  }
  return count;
}

// Centroid and area of a convex polygon.
static double middle_of(const Flat *p, int n, Flat *middle) {
  double area = 0;
  *middle = (Flat){0, 0};
  for (int i = 1; i + 1 < n; i++) {
    const double one = turn(p[0], p[i], p[i + 1]) / 2;
    area += one;
    middle->x += one * (p[0].x + p[i].x + p[i + 1].x) / 3;
    middle->y += one * (p[0].y + p[i].y + p[i + 1].y) / 3;
  }
  if (area > 0) *middle = (Flat){middle->x / area, middle->y / area};
  return area;
}

static void weights_of(const Flat t[3], Flat p, double weight[3]) {
  const double all = turn(t[0], t[1], t[2]);
  for (int k = 0; k < 3; k++) weight[k] = turn(t[(k + 1) % 3], t[(k + 2) % 3], p) / all;
}

// Coordinates in the plane of the first triangle.
static void see(const Facet *f, CagVec3 origin, CagVec3 x, CagVec3 y, Flat out[3]) {
  for (int k = 0; k < 3; k++) {
    const CagVec3 p = cag_sub(corner(f, k), origin);
    out[k] = (Flat){cag_dot(p, x), cag_dot(p, y)};
  }
}

static bool facets_coincide(const Search *s, const Facet *a, const Facet *b) {
  const CagVec3 m = facet_normal(a), n = facet_normal(b);
  if (!(fabs(cag_dot(m, n)) >= OVER)) return false;
  const CagVec3 x = cag_unit(cag_sub(corner(a, 1), corner(a, 0))), y = cag_cross(m, x);
  Flat one[3], two[3], common[9], rest[9], middle;
  see(a, corner(a, 0), x, y, one);
  see(b, corner(a, 0), x, y, two);
  memcpy(common, two, sizeof two);
  if (turn(two[0], two[1], two[2]) < 0) common[1] = two[2], common[2] = two[1];
  int count = 3;
  for (int k = 0; k < 3 && count > 2; k++) {
    memcpy(rest, common, sizeof rest);
    count = cut(rest, count, one[k], one[(k + 1) % 3], common);
  }
  if (count < 3 || !(middle_of(common, count, &middle) > AREA_LEAST * s->size * s->size))
    return false;
  double in_a[3], in_b[3];
  CagVec3 p, q, normal, other;
  weights_of(one, middle, in_a);
  weights_of(two, middle, in_b);
  const double gap = cag_dot(cag_sub(chord_point(b, in_b), chord_point(a, in_a)), m);
  if (fabs(gap) > 2 * (a->piece->tolerance + b->piece->tolerance) + s->slack) return false;
  return exact_point(a, in_a, &p, &normal) && project(b, in_b, p, &q, &other) &&
         cag_norm(cag_sub(p, q)) <= s->slack && is_parallel(normal, other);
}

// --- Many triangles ---

static bool boxes_meet(const CagBounds *a, const CagBounds *b, double slack) {
  return a->min.x <= b->max.x + slack && b->min.x <= a->max.x + slack &&
         a->min.y <= b->max.y + slack && b->min.y <= a->max.y + slack &&
         a->min.z <= b->max.z + slack && b->min.z <= a->max.z + slack;
}

static CagBounds box_of(const Facet *f, size_t n) {
  CagBounds box = CAG_BOUNDS_EMPTY;
  for (size_t i = 0; i < n; i++) {
    cag_bounds_add(&box, f[i].box.min);
    cag_bounds_add(&box, f[i].box.max);
  }
  return box;
}

// Moves the facets that may intersect the box to the front, and returns their number.
static size_t keep_near(Facet *f, size_t n, const CagBounds *box, double slack) {
  size_t kept = 0;
  for (size_t i = 0; i < n; i++) {
    if (!boxes_meet(&f[i].box, box, slack)) continue;
    const Facet near = f[i];
    f[i] = f[kept];
    f[kept++] = near;
  }
  return kept;
}

static int in_order(double a, double b) { return (a > b) - (a < b); }
static int by_x(const void *a, const void *b) {
  return in_order(((const Facet *)a)->box.min.x, ((const Facet *)b)->box.min.x);
}
static int by_y(const void *a, const void *b) {
  return in_order(((const Facet *)a)->box.min.y, ((const Facet *)b)->box.min.y);
}
static int by_z(const void *a, const void *b) {
  return in_order(((const Facet *)a)->box.min.z, ((const Facet *)b)->box.min.z);
}

static void sort_along(Facet *f, size_t n, const CagBounds *box) {
  const CagVec3 d = cag_sub(box->max, box->min);
  qsort(f, n, sizeof *f, d.x >= d.y && d.x >= d.z ? by_x : d.y >= d.z ? by_y : by_z);
}

// Halves the longer list until both are short; the depth is logarithmic in their lengths.
static bool lists_coincide(const Search *s, Facet *a, size_t n, Facet *b, size_t m, double slack) {
  const size_t few = 8;
  if (n == 0 || m == 0 || (s->interrupt && *s->interrupt)) return false;
  CagBounds box = box_of(a, n);
  m = keep_near(b, m, &box, slack);
  const CagBounds other = box_of(b, m);
  n = keep_near(a, n, &other, slack);
  if (n <= few && m <= few) {
    for (size_t i = 0; i < n; i++)
      for (size_t k = 0; k < m; k++)
        if (boxes_meet(&a[i].box, &b[k].box, slack) && facets_coincide(s, &a[i], &b[k]))
          return true;
    return false;
  }
  if (n >= m) {
    box = box_of(a, n);
    sort_along(a, n, &box);
    return lists_coincide(s, a, n / 2, b, m, slack) ||
           lists_coincide(s, a + n / 2, n - n / 2, b, m, slack);
  }
  sort_along(b, m, &other);
  return lists_coincide(s, a, n, b, m / 2, slack) ||
         lists_coincide(s, a, n, b + m / 2, m - m / 2, slack);
}

static Facet facet_of(const Piece *p, size_t t) {
  Facet f = {p, p->mesh->triangles + 3 * t, CAG_BOUNDS_EMPTY};
  for (int k = 0; k < 3; k++) cag_bounds_add(&f.box, corner(&f, k));
  return f;
}

static Facet *facets_of(const Piece *p) {
  Facet *f = cag_malloc((p->mesh->triangle_count + 1) * sizeof *f);
  for (size_t t = 0; f && t < p->mesh->triangle_count; t++) f[t] = facet_of(p, t);
  return f;
}

static bool pieces_coincide(const Search *s, const Piece *a, const Piece *b) {
  const double slack = 2 * (a->tolerance + b->tolerance) + s->slack;
  if (a->leaf == b->leaf || !boxes_meet(&a->box, &b->box, slack)) return false;
  Facet *f = facets_of(a), *g = facets_of(b);
  const bool found =
      !f || !g || lists_coincide(s, f, a->mesh->triangle_count, g, b->mesh->triangle_count, slack);
  cag_free(f);
  cag_free(g);
  return found;
}

// --- Half spaces and quadrics ---

static CagVec3 slope_of(const double c[10], CagVec3 p) {
  return cag_vec3(2 * c[0] * p.x + c[3] * p.y + c[5] * p.z + c[6],
                  2 * c[1] * p.y + c[3] * p.x + c[4] * p.z + c[7],
                  2 * c[2] * p.z + c[4] * p.y + c[5] * p.x + c[8]);
}

static bool side_coincides(const Search *s, const Side *side, const Piece *piece) {
  static const double MIDDLE[3] = {1 / 3.0, 1 / 3.0, 1 / 3.0};
  if (side->leaf == piece->leaf) return false;
  for (size_t t = 0; t < piece->mesh->triangle_count; t++) {
    const Facet f = facet_of(piece, t);
    CagVec3 p, normal;
    if (!exact_point(&f, MIDDLE, &p, &normal)) continue;
    const CagVec3 slope = slope_of(side->form.c, p);
    const double steep = cag_norm(slope);
    if (fabs(cag_quadric_value(&side->form, p)) <= steep * s->slack &&
        is_parallel(cag_scaled(slope, 1 / steep), normal))
      return true;
  }
  return false;
}

// Whether the forms have the same zeros: one is a multiple of the other.
static bool sides_coincide(const Search *s, const Side *a, const Side *b) {
  const double *p = a->centered.c, *q = b->centered.c;
  // Coefficients are compared by their contributions at this distance from the middle.
  const double unit = fmax(s->size, 1e-300);
  double most[2] = {0, 0}, x[10], y[10];
  if (a->leaf == b->leaf) return false;
  for (int i = 0; i < 10; i++) {
    const double weight = i < 6 ? unit * unit : i < 9 ? unit : 1;
    x[i] = p[i] * weight;
    y[i] = q[i] * weight;
    most[0] = fmax(most[0], fabs(x[i]));
    most[1] = fmax(most[1], fabs(y[i]));
  }
  for (int sense = -1; sense <= 1; sense += 2) {
    bool same = true;
    for (int i = 0; i < 10; i++)
      same = same && fabs(x[i] / most[0] - sense * y[i] / most[1]) <= COINCIDENT;
    if (same) return true;
  }
  return false;
}

// --- Complete search ---

static bool any_coincide(const Search *s) {
  for (size_t i = 0; i < s->count; i++)
    for (size_t k = i + 1; k < s->count; k++)
      if (pieces_coincide(s, &s->pieces[i], &s->pieces[k])) return true;
  for (size_t i = 0; i < s->side_count; i++) {
    for (size_t k = 0; k < s->count; k++)
      if (side_coincides(s, &s->sides[i], &s->pieces[k])) return true;
    for (size_t k = i + 1; k < s->side_count; k++)
      if (sides_coincide(s, &s->sides[i], &s->sides[k])) return true;
  }
  return false;
}

bool cag_solid_in_general_position(const CagSolid *s, const volatile int *interrupt) {
  Search search = {.interrupt = interrupt};
  CagBounds all = CAG_BOUNDS_EMPTY;
  bool general = collect(&search, s);
  for (size_t i = 0; i < search.count; i++) {
    cag_bounds_add(&all, search.pieces[i].box.min);
    cag_bounds_add(&all, search.pieces[i].box.max);
  }
  if (search.count) {
    const CagTransform center = cag_translate(cag_scaled(cag_lerp(all.min, all.max, 0.5), -1));
    CagError ignored;
    search.size = cag_norm(cag_sub(all.max, all.min));
    for (size_t i = 0; i < search.side_count; i++) {
      Side *side = &search.sides[i];
      if (cag_quadric_transform(&side->form, &center, &side->centered, &ignored)) general = false;
    }
  }
  search.slack = COINCIDENT * search.size;
  general = general && !any_coincide(&search) && !(interrupt && *interrupt);
  search_free(&search);
  return general;
}
