// All feet of perpendiculars from a point to a surface.
//
// They are the zeros of the gradient of half of the squared distance, f = (S - P) . S_u and g = (S -
// P) . S_v. Each smooth patch is sampled, and Newton's method starts from the cells in which both
// may change sign. u and v are scaled by the largest partials, so that lengths of steps are about
// those on the surface. Where the Hessian is singular, steps along its null direction show whether
// the foot is one of infinitely many.

#include "geom/surface/feet.h"

#include <stdlib.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/family.h"
#include "geom/linalg/tolerance.h"
#include "geom/surface/trimmed.h"

// Samples along each direction: of the surface, and the least of a patch.
enum { SAMPLES = 48, LEAST = 4, ROUNDS = 60 };
// A cell is searched if zero is within its range of f and g, enlarged by this part.
#define ENLARGED 0.3
// Eigenvalues of the Hessian below this fraction of its scale are 0.
#define SINGULAR 1e-7
// Steps of Newton's method below this fraction of the patch are rounding.
#define CONVERGED 1e-14
// Feet are the same if their points are this fraction of the size apart.
#define SAME 1e-7
// The sine of the angle between the line and the normal at a foot.
#define PERPENDICULAR 1e-7
// Steps along the null direction, and for the kind of a singular foot, as a fraction of the patch.
#define ASIDE 1e-2

typedef struct Search {
  const CagSurface *surface;
  const CagRegion *region; // NULL: all of it
  CagVec3 target;
  double low[2], high[2]; // the patch
  double scale[2];        // largest partials on it
  double size;            // of the surface and the distance
  CagFoot *feet;
  size_t n, capacity;
} Search;

// Gradient and Hessian in the scaled parameters.
typedef struct Slopes {
  CagVec3 from; // S - P
  double f[2], h[3];
} Slopes;

static CagStatus slopes_at(const Search *s, const double at[2], int order, Slopes *out,
                           CagError *err) {
  CagVec3 d[9];
  const CagSide su = at[0] >= s->high[0] ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
  const CagSide sv = at[1] >= s->high[1] ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
  CagStatus status = cag_surface_eval(s->surface, at[0], at[1], order, su, sv, d, err);
  if (status) return status;
  const CagVec3 r = cag_sub(d[0], s->target);
  const CagVec3 x = cag_scaled(d[cag_partial(order, 1, 0)], 1 / s->scale[0]);
  const CagVec3 y = cag_scaled(d[cag_partial(order, 0, 1)], 1 / s->scale[1]);
  *out = (Slopes){.from = r, .f = {cag_dot(r, x), cag_dot(r, y)}};
  if (order < 2) return CAG_OK;
  out->h[0] = cag_dot(x, x) + cag_dot(r, d[cag_partial(2, 2, 0)]) / (s->scale[0] * s->scale[0]);
  out->h[1] = cag_dot(x, y) + cag_dot(r, d[cag_partial(2, 1, 1)]) / (s->scale[0] * s->scale[1]);
  out->h[2] = cag_dot(y, y) + cag_dot(r, d[cag_partial(2, 0, 2)]) / (s->scale[1] * s->scale[1]);
  return CAG_OK;
}

// The eigenvalues of the Hessian, the one of larger magnitude first, and their unit vectors.
typedef struct Axes {
  double value[2], axis[2][2];
} Axes;

static Axes axes_of(const double h[3]) {
  const double mean = (h[0] + h[2]) / 2, half = (h[0] - h[2]) / 2, r = hypot(half, h[1]);
  const double angle = atan2(h[1], half) / 2; // of the eigenvector of mean + r
  const int first = mean >= 0 ? 0 : 1;
  Axes out;
  for (int k = 0; k < 2; k++) {
    const int upper = k == first;
    out.value[k] = upper ? mean + r : mean - r;
    out.axis[k][0] = upper ? cos(angle) : -sin(angle);
    out.axis[k][1] = upper ? sin(angle) : cos(angle);
  }
  return out;
}

static double clamp_to(double x, double low, double high) { return fmin(high, fmax(low, x)); }

// Newton's method within the patch, without steps along directions in which the Hessian is
// singular.
static CagStatus converge(const Search *s, double at[2], Slopes *slopes, CagError *err) {
  for (int round = 0; round < ROUNDS; round++) {
    CagStatus status = slopes_at(s, at, 2, slopes, err);
    if (status) return status;
    const Axes a = axes_of(slopes->h);
    double step[2] = {0, 0}, change = 0;
    for (int k = 0; k < 2; k++) {
      const double along = slopes->f[0] * a.axis[k][0] + slopes->f[1] * a.axis[k][1];
      if (!(fabs(a.value[k]) > SINGULAR)) continue;
      for (int i = 0; i < 2; i++) step[i] -= along / a.value[k] * a.axis[k][i];
    }
    for (int i = 0; i < 2; i++) {
      const double width = s->high[i] - s->low[i];
      const double to = at[i] + clamp_to(step[i] / s->scale[i], -width / 4, width / 4);
      const double next = clamp_to(to, s->low[i], s->high[i]);
      change = fmax(change, fabs(next - at[i]) / width);
      at[i] = next;
    }
    if (change <= CONVERGED) break;
  }
  return slopes_at(s, at, 2, slopes, err);
}

// Whether the line from the target is normal to the surface, at poles too.
static CagStatus is_foot(const Search *s, const double at[2], const Slopes *slopes, bool *yes,
                         CagError *err) {
  CagVec3 normal;
  const double distance = cag_norm(slopes->from);
  *yes = distance <= CAG_ROUNDING * s->size;
  if (*yes) return CAG_OK;
  CagStatus status = cag_surface_normal(s->surface, at[0], at[1], &normal, err);
  if (cag_is_final(status)) return status;
  *yes = !status && cag_norm(cag_cross(normal, slopes->from)) <=
                        PERPENDICULAR * distance + CAG_ROUNDING * s->size;
  return CAG_OK;
}

// --- Feet ---

// Whether feet lead away from a singular one: infinitely many.
static CagStatus check_isolated(const Search *s, const double at[2], const Slopes *slopes,
                                CagError *err) {
  const Axes a = axes_of(slopes->h);
  const CagVec3 p = cag_add(s->target, slopes->from);
  for (int k = 0; k < 2; k++)
    for (int sign = -1; sign <= 1 && fabs(a.value[k]) <= SINGULAR; sign += 2) {
      double next[2];
      Slopes there;
      bool foot;
      for (int i = 0; i < 2; i++)
        next[i] = clamp_to(at[i] + sign * ASIDE * a.axis[k][i] * (s->high[i] - s->low[i]),
                           s->low[i], s->high[i]);
      CagStatus status = converge(s, next, &there, err);
      if (!status) status = is_foot(s, next, &there, &foot, err);
      if (status) return status;
      const double moved = cag_norm(cag_sub(cag_add(s->target, there.from), p));
      const double change = fabs(cag_norm(there.from) - cag_norm(slopes->from));
      if (foot && moved > SAME * s->size && change <= CAG_COINCIDENT * s->size)
        return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_not_unique, "P", -1,
                        "points along a curve of the surface have the same distance from it");
    }
  return CAG_OK;
}

// The kind of a singular foot, by the distances around it.
static CagStatus singular_kind(const Search *s, const double at[2], double distance,
                               CagFootKind *kind, CagError *err) {
  enum { AROUND = 16 };
  bool farther = false, nearer = false;
  for (int k = 0; k < AROUND; k++) {
    const double angle = 2 * M_PI * k / AROUND, by[2] = {cos(angle), sin(angle)};
    double next[2];
    CagVec3 p;
    for (int i = 0; i < 2; i++)
      next[i] = clamp_to(at[i] + ASIDE * by[i] * (s->high[i] - s->low[i]), s->low[i], s->high[i]);
    CagStatus status = cag_surface_point(s->surface, next[0], next[1], &p, err);
    if (status) return status;
    const double change = cag_norm(cag_sub(p, s->target)) - distance;
    farther = farther || change > CAG_ROUNDING * s->size;
    nearer = nearer || change < -CAG_ROUNDING * s->size;
  }
  *kind = farther && nearer ? CAG_FOOT_SADDLE : nearer ? CAG_FOOT_MAXIMUM : CAG_FOOT_MINIMUM;
  return CAG_OK;
}

static CagStatus foot_kind(const Search *s, const double at[2], const Slopes *slopes,
                           CagFootKind *kind, CagError *err) {
  const Axes a = axes_of(slopes->h);
  if (fabs(a.value[1]) <= SINGULAR) return singular_kind(s, at, cag_norm(slopes->from), kind, err);
  *kind = a.value[0] * a.value[1] < 0 ? CAG_FOOT_SADDLE
          : a.value[0] > 0            ? CAG_FOOT_MINIMUM
                                      : CAG_FOOT_MAXIMUM;
  return CAG_OK;
}

static bool is_known(const Search *s, CagVec3 p) {
  for (size_t i = 0; i < s->n; i++)
    if (cag_norm(cag_sub(s->feet[i].point, p)) <= SAME * s->size) return true;
  return false;
}

// Searches from a point of the patch, and keeps the foot that is found. Returns where it ended.
static CagStatus search_from(Search *s, double at[2], CagError *err) {
  Slopes slopes;
  bool foot, inside = true;
  CagStatus status = converge(s, at, &slopes, err);
  if (!status) status = is_foot(s, at, &slopes, &foot, err);
  if (status || !foot) return status;
  CagFoot found = {{at[0], at[1]}, cag_add(s->target, slopes.from), cag_norm(slopes.from), 0};
  if (is_known(s, found.point)) return CAG_OK;
  if (s->region) status = cag_region_contains(s->region, cag_vec3(at[0], at[1], 0), &inside, err);
  if (status || !inside) return status;
  status = check_isolated(s, at, &slopes, err);
  if (!status) status = foot_kind(s, at, &slopes, &found.kind, err);
  if (status) return status;
  if (!CAG_RESERVE(s->feet, s->capacity, s->n + 1)) return cag_fail_memory(err);
  s->feet[s->n++] = found;
  return CAG_OK;
}

// --- Cells ---

static double node(const Search *s, int direction, int k, int n) {
  return k == n ? s->high[direction]
                : s->low[direction] + (s->high[direction] - s->low[direction]) * k / n;
}

static bool may_vanish(double a, double b, double c, double d) {
  const double low = fmin(fmin(a, b), fmin(c, d)), high = fmax(fmax(a, b), fmax(c, d));
  const double more = ENLARGED * (high - low);
  return low - more <= 0 && high + more >= 0;
}

// From the middle of a cell and, if that leads out of it, from its quarters.
static CagStatus search_cell(Search *s, const double a[2], const double b[2], CagError *err) {
  double at[2] = {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2};
  CagStatus status = search_from(s, at, err);
  if (at[0] >= a[0] && at[0] <= b[0] && at[1] >= a[1] && at[1] <= b[1]) return status;
  for (int k = 0; !status && k < 4; k++) {
    double from[2];
    for (int i = 0; i < 2; i++) from[i] = a[i] + (b[i] - a[i]) * (k >> i & 1 ? 0.75 : 0.25);
    status = search_from(s, from, err);
  }
  return status;
}

// The largest partials of the patch, from samples.
static CagStatus find_scales(Search *s, CagError *err) {
  s->scale[0] = s->scale[1] = 0;
  for (int i = 0; i <= LEAST; i++)
    for (int j = 0; j <= LEAST; j++) {
      CagVec3 d[4];
      CagStatus status = cag_surface_eval(s->surface, node(s, 0, i, LEAST), node(s, 1, j, LEAST), 1,
                                          i == LEAST ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT,
                                          j == LEAST ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, d, err);
      if (status) return status;
      s->scale[0] = fmax(s->scale[0], cag_norm(d[cag_partial(1, 1, 0)]));
      s->scale[1] = fmax(s->scale[1], cag_norm(d[cag_partial(1, 0, 1)]));
    }
  return CAG_OK;
}

// nodes: (n + 1) x (m + 1) gradients.
static CagStatus search_cells(Search *s, int n, int m, double (*nodes)[2], CagError *err) {
  for (int i = 0; i <= n; i++)
    for (int j = 0; j <= m; j++) {
      const double at[2] = {node(s, 0, i, n), node(s, 1, j, m)};
      Slopes slopes;
      CagStatus status = cag_stop_check(err);
      if (!status) status = slopes_at(s, at, 1, &slopes, err);
      if (status) return status;
      for (int k = 0; k < 2; k++) nodes[i * (m + 1) + j][k] = slopes.f[k];
    }
  for (int i = 0; i < n; i++)
    for (int j = 0; j < m; j++) {
      const double(*p)[2] = (const double(*)[2])nodes + i * (m + 1) + j, (*q)[2] = p + m + 1;
      if (!may_vanish(p[0][0], p[1][0], q[0][0], q[1][0]) ||
          !may_vanish(p[0][1], p[1][1], q[0][1], q[1][1]))
        continue;
      const double a[2] = {node(s, 0, i, n), node(s, 1, j, m)};
      const double b[2] = {node(s, 0, i + 1, n), node(s, 1, j + 1, m)};
      CagStatus status = search_cell(s, a, b, err);
      if (status) return status;
    }
  return CAG_OK;
}

static int samples_of(size_t patches) {
  const size_t n = (SAMPLES + patches - 1) / patches;
  return n < LEAST ? LEAST : (int)n;
}

static CagStatus search_patches(Search *s, CagError *err) {
  double *cuts[2] = {NULL, NULL};
  size_t count[2] = {0, 0};
  CagStatus status = cag_surface_cuts(s->surface, 0, &cuts[0], &count[0], err);
  if (!status) status = cag_surface_cuts(s->surface, 1, &cuts[1], &count[1], err);
  const int n = status ? 0 : samples_of(count[0]), m = status ? 0 : samples_of(count[1]);
  double(*nodes)[2] = cag_malloc((size_t)((n + 1) * (m + 1)) * sizeof *nodes);
  if (!status && !nodes) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i < count[0]; i++)
    for (size_t j = 0; !status && j < count[1]; j++) {
      const size_t at[2] = {i, j};
      for (int k = 0; k < 2; k++) {
        s->low[k] = cuts[k][at[k]];
        s->high[k] = cuts[k][at[k] + 1];
      }
      status = find_scales(s, err);
      if (!status && s->scale[0] > 0 && s->scale[1] > 0) status = search_cells(s, n, m, nodes, err);
    }
  cag_free(nodes);
  cag_free(cuts[0]);
  cag_free(cuts[1]);
  return status;
}

static int by_distance(const void *a, const void *b) {
  const CagFoot *x = a, *y = b;
  if (x->distance != y->distance) return x->distance < y->distance ? -1 : 1;
  for (int k = 0; k < 2; k++)
    if (x->at[k] != y->at[k]) return x->at[k] < y->at[k] ? -1 : 1;
  return 0;
}

CagStatus cag_surface_feet(const CagSurface *s, CagVec3 p, CagFoot **out, size_t *n,
                           CagError *err) {
  Search search = {.surface = s, .target = p};
  CagBounds box;
  CagTransform frame;
  CagStatus status = cag_curve_check_points(&p, 1, "P", err);
  if (!status) status = cag_surface_bounds(s, &box, err);
  if (status) return status;
  search.size = cag_norm(cag_sub(box.max, box.min)) + cag_norm(cag_sub(p, box.min));
  if (!cag_surface_planar_view(s, &search.region, &frame))
    cag_surface_trimmed_view(s, NULL, &search.region);
  status = search_patches(&search, err);
  if (status) {
    cag_free(search.feet);
    return status;
  }
  if (search.n > 1) qsort(search.feet, search.n, sizeof *search.feet, by_distance);
  *out = search.feet;
  *n = search.n;
  return CAG_OK;
}
