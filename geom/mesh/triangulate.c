// Triangulation of polygons with holes: the GLU tessellator triangulates them, then edge flips make
// the result constrained Delaunay.
//
// GLU is a sweep algorithm and may produce triangles without area if boundary points are collinear;
// the flips remove them, so that caps keep every boundary point and have no slivers. All state is
// in the tessellator object of the call.

#include <GL/glu.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/aside.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/linalg/tolerance.h"
#include "geom/mesh/edges.h"
#include "geom/mesh/mesh.h"

typedef struct Sweep {
  const double *xy;
  uint32_t *triangles;
  size_t corners, capacity; // of triangles, in corners
  GLenum error;
  bool crossing, no_memory;
  size_t near_crossing; // a point at an end of one of the crossing edges
} Sweep;

static void on_vertex(void *data, void *polygon) {
  Sweep *s = polygon;
  if (s->corners == s->capacity) {
    s->no_memory = true;
    return;
  }
  s->triangles[s->corners++] = (uint32_t)((uintptr_t)data - 1);
}

// Setting this callback makes GLU output separate triangles.
static void on_edge_flag(GLboolean flag, void *polygon) { (void)flag, (void)polygon; }

static void on_error(GLenum error, void *polygon) { ((Sweep *)polygon)->error = error; }

// Called where boundaries cross, and where two given points coincide.
static void on_combine(GLdouble at[3], void *data[4], GLfloat weights[4], void **out,
                       void *polygon) {
  (void)weights;
  Sweep *s = polygon;
  (void)at;
  *out = data[0];
  if (!s->crossing) s->near_crossing = (uintptr_t)data[0] - 1;
  s->crossing = true;
}

typedef void (*GluCallback)(void);

// GLU sweeps along x and searches the edges at the sweep line linearly. Returns whether a quarter
// turn reduces their number (on average: the sum of the edges' extents in x over the width).
static bool is_faster_turned(const double *xy, const size_t *counts, size_t loops) {
  double run[2] = {0, 0}, least[2] = {INFINITY, INFINITY}, most[2] = {-INFINITY, -INFINITY};
  for (size_t l = 0; l < loops; xy += 2 * counts[l++])
    for (size_t k = 0; k < counts[l]; k++)
      for (int axis = 0; axis < 2; axis++) {
        double x = xy[2 * k + axis], next = xy[2 * ((k + 1) % counts[l]) + axis];
        run[axis] += fabs(next - x);
        least[axis] = fmin(least[axis], x);
        most[axis] = fmax(most[axis], x);
      }
  return run[0] * (most[1] - least[1]) > run[1] * (most[0] - least[0]);
}

// Bytes that GLU needs for each point of a polygon: a vertex, a pair of half edges, and a fraction
// of faces, of the event queue, and of the regions at the sweep line.
#define GLU_BYTES ((size_t)512)

// From this number of points on, GLU takes so long that a stop must not wait for it.
#define MANY_POINTS ((size_t)20000)

// The polygon for GLU, in a single block of memory, because a canceled call may leave it to a
// thread that continues.
typedef struct Polygon {
  Sweep sweep;
  bool failed; // GLU could not start
  size_t loops;
  size_t *counts;
  GLdouble (*coordinates)[3];
} Polygon;

static void sweep_polygon(void *data) {
  Polygon *p = data;
  GLUtesselator *glu = gluNewTess();
  p->failed = !glu;
  if (!glu) return;
  gluTessCallback(glu, GLU_TESS_VERTEX_DATA, (GluCallback)on_vertex);
  gluTessCallback(glu, GLU_TESS_EDGE_FLAG_DATA, (GluCallback)on_edge_flag);
  gluTessCallback(glu, GLU_TESS_COMBINE_DATA, (GluCallback)on_combine);
  gluTessCallback(glu, GLU_TESS_ERROR_DATA, (GluCallback)on_error);
  gluTessProperty(glu, GLU_TESS_WINDING_RULE, GLU_TESS_WINDING_ODD);
  gluTessNormal(glu, 0, 0, 1);
  gluTessBeginPolygon(glu, &p->sweep);
  for (size_t l = 0, k = 0; l < p->loops; l++) {
    gluTessBeginContour(glu);
    for (size_t end = k + p->counts[l]; k < end; k++)
      gluTessVertex(glu, p->coordinates[k], (void *)(uintptr_t)(k + 1));
    gluTessEndContour(glu);
  }
  gluTessEndPolygon(glu);
  gluDeleteTess(glu);
}

static Polygon *new_polygon(const double *xy, const size_t *counts, size_t loops, size_t points,
                            size_t corners) {
  Polygon *p = cag_malloc(sizeof *p + points * sizeof *p->coordinates + loops * sizeof *p->counts +
                          corners * sizeof *p->sweep.triangles);
  if (!p) return NULL;
  *p = (Polygon){.sweep = {.capacity = corners}, .loops = loops};
  p->coordinates = (GLdouble(*)[3])(p + 1);
  p->counts = (size_t *)(p->coordinates + points);
  p->sweep.triangles = (uint32_t *)(p->counts + loops);
  memcpy(p->counts, counts, loops * sizeof *counts);
  const bool turned = is_faster_turned(xy, counts, loops);
  for (size_t k = 0; k < points; k++) {
    p->coordinates[k][0] = turned ? xy[2 * k + 1] : xy[2 * k];
    p->coordinates[k][1] = turned ? -xy[2 * k] : xy[2 * k + 1];
    p->coordinates[k][2] = 0;
  }
  return p;
}

// Sweeps a polygon with many points in another thread, so that the work can be canceled.
static CagStatus sweep_points(const double *xy, const size_t *counts, size_t loops, size_t points,
                              Sweep *s, CagError *err) {
  if (!cag_account_hold(points * GLU_BYTES)) return cag_fail_memory(err);
  Polygon *p = new_polygon(xy, counts, loops, points, s->capacity);
  CagStatus status = p ? CAG_OK : cag_fail_memory(err);
  if (p && points < MANY_POINTS) sweep_polygon(p);
  else if (p) {
    cag_disown(p); // the other thread may have to free it
    if (cag_run_aside(sweep_polygon, free, p)) cag_adopt(p);
    else status = cag_stop_fail(err);
  }
  cag_account_drop(points * GLU_BYTES);
  if (status) return status;
  memcpy(s->triangles, p->sweep.triangles, p->sweep.corners * sizeof *s->triangles);
  uint32_t *triangles = s->triangles;
  *s = p->sweep;
  s->triangles = triangles;
  s->xy = xy;
  if (p->failed || s->error == GLU_OUT_OF_MEMORY) status = cag_fail_memory(err);
  cag_free(p);
  return status;
}

// --- Delaunay flips ---

// Twice the signed area of a b c.
static double turn(const double *a, const double *b, const double *c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// Whether d is clearly inside the circle through a b c (counter-clockwise): by more than the
// rounding of the determinant, so that four cocircular points do not flip endlessly.
static bool in_circle(const double *a, const double *b, const double *c, const double *d) {
  const double rounding = CAG_ROUNDING;
  double ax = a[0] - d[0], ay = a[1] - d[1], bx = b[0] - d[0], by = b[1] - d[1], cx = c[0] - d[0],
         cy = c[1] - d[1];
  double aa = ax * ax + ay * ay, bb = bx * bx + by * by, cc = cx * cx + cy * cy;
  double p = aa * (bx * cy - by * cx), q = bb * (ax * cy - ay * cx), r = cc * (ax * by - ay * bx);
  double size = aa * (fabs(bx * cy) + fabs(by * cx)) + bb * (fabs(ax * cy) + fabs(ay * cx)) +
                cc * (fabs(ax * by) + fabs(ay * bx));
  return p - q + r > rounding * size;
}

// Triangles with their neighbors: across[3 t + k] is the index 3 t' + k' at which the neighbor's
// copy of the edge from corner k of t starts; NO_PLACE on the boundary.
#define NO_PLACE SIZE_MAX
typedef struct Flips {
  const double *xy;
  uint32_t *triangles;
  size_t *across;
  size_t *stack, depth, capacity; // indices whose edges must be tested
} Flips;

// If memory runs out, the edge is not tested again: the triangulation stays valid but is not
// optimal.
static void push(Flips *f, size_t place) {
  if (!CAG_RESERVE(f->stack, f->capacity, f->depth + 1)) return cag_note_memory();
  f->stack[f->depth++] = place;
}

static size_t next_place(size_t p) { return p % 3 == 2 ? p - 2 : p + 1; }

static void link_places(Flips *f, size_t p, size_t q) {
  f->across[p] = q;
  if (q != NO_PLACE) f->across[q] = p;
}

// The edge from a to b belongs to the triangles a b c and b a d; replaces it by c d if that is
// better.
static bool flip_edge(Flips *f, size_t p) {
  const double no_area = CAG_ROUNDING; // of the quadrilateral's area: a triangle that is only
                                       // rounding
  size_t q = f->across[p];
  if (q == NO_PLACE) return false;
  size_t pb = next_place(p), pc = next_place(pb), qa = next_place(q), qd = next_place(qa);
  uint32_t *v = f->triangles;
  const double *a = f->xy + 2 * v[p], *b = f->xy + 2 * v[q], *c = f->xy + 2 * v[pc],
               *d = f->xy + 2 * v[qd];
  double adc = turn(a, d, c), dbc = turn(d, b, c);
  if (!(adc > 0 && dbc > 0)) return false;
  double least_now = fmin(turn(a, b, c), turn(b, a, d)), least_then = fmin(adc, dbc);
  bool no_triangle = least_now <= no_area * (adc + dbc);
  if (no_triangle ? least_then <= least_now : !in_circle(a, b, c, d)) return false;
  // The triangle of p becomes a d c (p: a d, pb: d c, pc: c a), that of q b c d.
  size_t bc = f->across[pb], ad = f->across[qa];
  v[pb] = v[qd];
  v[qa] = v[pc];
  link_places(f, p, ad);
  link_places(f, q, bc);
  link_places(f, pb, qa);
  push(f, p);
  push(f, q);
  push(f, pc);
  push(f, qd);
  return true;
}

static void flip_to_delaunay(Flips *f, size_t corners) {
  // Lawson's algorithm needs at most about n^2 flips, and a few n on usual input. The limit only
  // guards against cycles caused by rounding.
  size_t flips_left = 64 * corners + 1024;
  for (size_t p = 0; p < corners; p++) {
    push(f, p);
    while (f->depth > 0 && flips_left > 0) flips_left -= flip_edge(f, f->stack[--f->depth]);
    f->depth = 0;
  }
}

// --- Checks ---

// Fills `across`, and checks that the triangles triangulate the given polygon: each edge of a loop
// belongs to one triangle, every other edge to two. *bad: a point at fault.
static bool link_triangles(const uint32_t *triangles, size_t n, const size_t *counts, size_t loops,
                           size_t points, size_t *across, size_t *bad, bool *no_memory) {
  size_t used;
  CagMeshEdge *e = cag_mesh_edges(triangles, n, NULL, points, &used);
  uint32_t *follows = cag_malloc((points + 1) * sizeof *follows); // the next point of the loop
  *no_memory = !e || !follows;
  bool good = !*no_memory;
  for (size_t l = 0, k = 0; good && l < loops; l++)
    for (size_t first = k, end = k + counts[l]; k < end; k++)
      follows[k] = (uint32_t)(k + 1 < end ? k + 1 : first);
  unsigned char *met =
      cag_calloc(points + 1, 1); // the loop's edge that starts at the point was found
  *no_memory |= !met;
  good &= met != NULL;
  for (size_t i = 0; good && i < used;) {
    size_t last = i + 1;
    while (last < used && e[last].low == e[i].low && e[last].high == e[i].high) last++;
    size_t p = 3 * cag_mesh_edge_triangle(&e[i]) + cag_mesh_edge_corner(&e[i]);
    bool of_loop = follows[e[i].low] == e[i].high || follows[e[i].high] == e[i].low;
    across[p] = NO_PLACE;
    if (of_loop) {
      good = last - i == 1;
      met[follows[e[i].low] == e[i].high ? e[i].low : e[i].high] = 1;
    } else {
      good = last - i == 2 && cag_mesh_edge_forward(&e[i]) != cag_mesh_edge_forward(&e[i + 1]);
      if (good) {
        size_t q = 3 * cag_mesh_edge_triangle(&e[i + 1]) + cag_mesh_edge_corner(&e[i + 1]);
        across[p] = q;
        across[q] = p;
      }
    }
    if (!good) *bad = e[i].low;
    i = last;
  }
  for (size_t k = 0; good && k < points; k++)
    if (!met[k]) good = false, *bad = k;
  cag_free(met);
  cag_free(e);
  cag_free(follows);
  return good;
}

static CagStatus check_loops(const double *xy, const size_t *counts, size_t loops, size_t *points,
                             CagError *err) {
  *points = 0;
  for (size_t l = 0; l < loops; *points += counts[l++])
    if (counts[l] < 3)
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_polygon_too_small, "points", (long)l,
                      "a polygon needs 3 or more points: loop %zu has %zu", l, counts[l]);
  for (size_t k = 0; k < *points; k++)
    if (!isfinite(xy[2 * k]) || !isfinite(xy[2 * k + 1]))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_vertex_not_finite, "points", (long)k,
                      "`points` must be finite: points[%zu] = [%g, %g]", k, xy[2 * k],
                      xy[2 * k + 1]);
  if (loops == 0 || *points > UINT32_MAX / 4)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_polygon_too_small, "points", -1,
                    "a polygon needs at least one loop and at most %lu points",
                    (unsigned long)UINT32_MAX / 4);
  return CAG_OK;
}

static CagStatus crosses(const double *xy, size_t point, CagError *err) {
  return cag_fail(
      err, CAG_E_ARGUMENT, CAG_ERR_polygon_self_intersection, "points", (long)point,
      "the boundary of a polygon must not cross or touch itself: it does near points[%zu] = [%g, %g]",
      point, xy[2 * point], xy[2 * point + 1]);
}

static CagStatus sweep_and_check(const double *xy, const size_t *counts, size_t loops,
                                 size_t points, Sweep *s, size_t *across, CagError *err) {
  CagStatus status = sweep_points(xy, counts, loops, points, s, err);
  if (status) return status;
  if (s->crossing || s->no_memory || s->error) return crosses(xy, s->near_crossing, err);
  size_t bad = 0;
  bool no_memory;
  if (!link_triangles(s->triangles, s->corners / 3, counts, loops, points, across, &bad,
                      &no_memory))
    return no_memory ? cag_fail_memory(err) : crosses(xy, bad, err);
  return CAG_OK;
}

CagStatus cag_triangulate(const double *xy, const size_t *counts, size_t loops, uint32_t **out,
                          size_t *n, CagError *err) {
  size_t points;
  CagStatus status = check_loops(xy, counts, loops, &points, err);
  if (status) return status;
  // A triangulation has points + 2 (holes - outers) triangles: at most points + 2 loops.
  Sweep s = {.xy = xy, .capacity = 3 * (points + 2 * loops)};
  s.triangles = cag_malloc(s.capacity * sizeof *s.triangles);
  size_t *across = cag_malloc(s.capacity * sizeof *across);
  if (s.triangles && across) status = sweep_and_check(xy, counts, loops, points, &s, across, err);
  else status = cag_fail_memory(err);
  if (!status) {
    Flips f = {.xy = xy, .triangles = s.triangles, .across = across};
    flip_to_delaunay(&f, s.corners);
    cag_free(f.stack);
    *out = s.triangles;
    *n = s.corners / 3;
  } else cag_free(s.triangles);
  cag_free(across);
  return status;
}
