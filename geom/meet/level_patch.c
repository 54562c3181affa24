// Functions on a patch of a surface: one-sided values from its inside, also where the surface has
// no normal.
//
// Along a collapsed edge (a pole, the tip of a cone) curvature is 0/0, and next to it mostly
// rounding. Closer than a step to such an edge a sided function is extrapolated by the polynomial
// through its values at one to six steps, at the same position along the edge.

#include "geom/meet/level_patch.h"

#include <float.h>
#include <math.h>

#include "geom/linalg/tolerance.h"
#include "geom/surface/function.h"

// The step, as a fraction of the patch, and the number of points: the error of the polynomial for a
// smooth function, (2e-3)^6 of its sixth derivative, is as small as the rounding of 1e-16 / 2e-3^2
// at the points themselves.
#define STEP 2e-3
#define PLACES 6
// An edge is collapsed if S_u x S_v is everywhere below this fraction of its maximum.
#define COLLAPSED CAG_COINCIDENT
// Distance, as a fraction of the patch, below which a point lies on its edge.
#define ON_EDGE CAG_COINCIDENT

static CagSide side_at(double x, double hi) { return x >= hi ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT; }

static CagStatus partials_at(const CagLevelPatch *p, double u, double v, int n, CagVec3 *d,
                             CagError *err) {
  return cag_surface_eval(p->s, u, v, n, side_at(u, p->hi[0]), side_at(v, p->hi[1]), d, err);
}

static CagStatus normal_size(const CagLevelPatch *p, double x, double y, double *out,
                             CagError *err) {
  CagVec3 d[4] = {0};
  double u = p->lo[0] + x * (p->hi[0] - p->lo[0]), v = p->lo[1] + y * (p->hi[1] - p->lo[1]);
  CagStatus status = partials_at(p, fmin(u, p->hi[0]), fmin(v, p->hi[1]), 1, d, err);
  *out = cag_norm(cag_cross(d[cag_partial(1, 1, 0)], d[cag_partial(1, 0, 1)]));
  return status;
}

static CagStatus find_collapsed(CagLevelPatch *p, CagError *err) {
  enum { TRIED = 5 };
  double largest = 0, edge[2][2] = {{0, 0}, {0, 0}};
  for (int i = 0; i < TRIED; i++)
    for (int j = 0; j < TRIED; j++) {
      double size, x = i / (TRIED - 1.0), y = j / (TRIED - 1.0);
      CagStatus status = normal_size(p, x, y, &size, err);
      if (status) return status;
      largest = fmax(largest, size);
      for (int end = 0; end < 2; end++) {
        if (i == end * (TRIED - 1)) edge[0][end] = fmax(edge[0][end], size);
        if (j == end * (TRIED - 1)) edge[1][end] = fmax(edge[1][end], size);
      }
    }
  for (int k = 0; k < 2; k++)
    for (int end = 0; end < 2; end++) p->collapsed[k][end] = edge[k][end] <= COLLAPSED * largest;
  return CAG_OK;
}

CagStatus cag_patch_open(const CagSurface *s, const CagLevel *level, const double lo[2],
                         const double hi[2], CagLevelPatch *out, CagError *err) {
  *out = (CagLevelPatch){.s = s, .level = level, .lo = {lo[0], lo[1]}, .hi = {hi[0], hi[1]}};
  // Sided functions handle such points by extrapolation.
  out->formula = !level->sided && cag_surface_is_formula(s);
  return level->sided ? find_collapsed(out, err) : CAG_OK;
}

// Distance from an edge, as a fraction of the patch.
static double distance_of(const CagLevelPatch *p, const double at[2], int k, int end) {
  double off = end ? p->hi[k] - at[k] : at[k] - p->lo[k];
  return off / (p->hi[k] - p->lo[k]);
}

static bool is_within(const CagLevelPatch *p, double u, double v, double distance) {
  const double at[2] = {u, v};
  for (int k = 0; k < 2; k++)
    for (int end = 0; end < 2; end++)
      if (p->collapsed[k][end] && distance_of(p, at, k, end) <= distance) return true;
  return false;
}

bool cag_patch_is_collapsed(const CagLevelPatch *p, double u, double v) {
  return is_within(p, u, v, ON_EDGE);
}

bool cag_patch_is_beside(const CagLevelPatch *p, double u, double v) {
  return is_within(p, u, v, STEP * PLACES);
}

// --- Values ---

static bool is_finite(double f, const double *gradient) {
  return isfinite(f) && (!gradient || (isfinite(gradient[0]) && isfinite(gradient[1])));
}

static CagStatus plain_value(const CagLevelPatch *p, const double at[2], double *f,
                             double *gradient, CagVec3 *partials, CagError *err) {
  CagVec3 d[16] = {0};
  int n = gradient ? p->level->order : p->level->order - 1;
  CagStatus status = p->formula ? cag_surface_eval_beside(p->s, p->lo, p->hi, at, n, d, err)
                                : partials_at(p, at[0], at[1], n, d, err);
  if (status) return status;
  *f = p->level->value(p->level, d, n, gradient);
  if (!partials) return CAG_OK;
  partials[0] = d[0];
  partials[cag_partial(1, 1, 0)] = d[cag_partial(n, 1, 0)];
  partials[cag_partial(1, 0, 1)] = d[cag_partial(n, 0, 1)];
  return CAG_OK;
}

// If the value at an isolated point is undefined, uses that one step towards the middle of the
// patch; else 0.
static CagStatus finite_value(const CagLevelPatch *p, const double at[2], double *f,
                              double *gradient, CagVec3 *partials, CagError *err) {
  CagStatus status = plain_value(p, at, f, gradient, partials, err);
  if (status || !p->level->sided || is_finite(*f, gradient)) return status;
  double inside[2];
  for (int k = 0; k < 2; k++) {
    double step = STEP * (p->hi[k] - p->lo[k]);
    inside[k] = at[k] < (p->lo[k] + p->hi[k]) / 2 ? at[k] + step : at[k] - step;
  }
  status = plain_value(p, inside, f, gradient, NULL, err);
  if (status || is_finite(*f, gradient)) return status;
  *f = 0;
  if (gradient) gradient[0] = gradient[1] = 0;
  return CAG_OK;
}

// Weights of the values at 1 .. PLACES for the polynomial's value at x, and for its derivative.
static void weigh(double x, double *values, double *slopes) {
  for (int i = 0; i < PLACES; i++) {
    double product = 1, sum = 0;
    for (int j = 0; j < PLACES; j++) {
      if (j == i) continue;
      double factor = 1;
      for (int k = 0; k < PLACES; k++)
        if (k != i && k != j) factor *= (x - 1 - k) / (i - k);
      sum += factor / (i - j);
      product *= (x - 1 - j) / (i - j);
    }
    values[i] = product;
    slopes[i] = sum;
  }
}

// The value extrapolated from next to edge `end` of direction k.
static CagStatus continued_value(const CagLevelPatch *p, const double at[2], int k, int end,
                                 double *f, double *gradient, CagError *err) {
  double values[PLACES], slopes[PLACES], range = p->hi[k] - p->lo[k], sign = end ? -1 : 1;
  weigh(distance_of(p, at, k, end) / STEP, values, slopes);
  *f = 0;
  if (gradient) gradient[0] = gradient[1] = 0;
  for (int i = 0; i < PLACES; i++) {
    double beside[2] = {at[0], at[1]}, here, change[2];
    beside[k] = (end ? p->hi[k] : p->lo[k]) + sign * STEP * (i + 1) * range;
    // Near the corner of two such edges, stay a step away from the other one.
    for (int other = 0; other < 2; other++)
      if (p->collapsed[1 - k][other] && distance_of(p, at, 1 - k, other) < STEP) {
        double step = STEP * (p->hi[1 - k] - p->lo[1 - k]);
        beside[1 - k] = other ? p->hi[1 - k] - step : p->lo[1 - k] + step;
      }
    CagStatus status = finite_value(p, beside, &here, gradient ? change : NULL, NULL, err);
    if (status) return status;
    *f += values[i] * here;
    if (!gradient) continue;
    gradient[k] += sign * slopes[i] * here / (STEP * range);
    gradient[1 - k] += values[i] * change[1 - k];
  }
  return CAG_OK;
}

CagStatus cag_patch_value(const CagLevelPatch *p, double u, double v, double *f, double *gradient,
                          CagVec3 *partials, CagError *err) {
  const double at[2] = {u, v};
  for (int k = 0; k < 2; k++)
    for (int end = 0; end < 2; end++) {
      if (!p->collapsed[k][end] || distance_of(p, at, k, end) >= STEP) continue;
      CagStatus status = partials ? partials_at(p, u, v, 1, partials, err) : CAG_OK;
      return status ? status : continued_value(p, at, k, end, f, gradient, err);
    }
  return finite_value(p, at, f, gradient, partials, err);
}

// --- Rounding ---

// The jump of f over a short step at x, y in fractions of the patch.
static CagStatus jump_at(const CagLevelPatch *p, double x, double y, double *out, CagError *err) {
  const double step = 1e-9;
  double f[3];
  for (int k = -1; k <= 1; k++) {
    double u = p->lo[0] + (x + k * step) * (p->hi[0] - p->lo[0]);
    double v = p->lo[1] + (y + k * step) * (p->hi[1] - p->lo[1]);
    CagStatus status = cag_patch_value(p, u, v, &f[k + 1], NULL, NULL, err);
    if (status) return status;
  }
  *out = fabs(f[0] - 2 * f[1] + f[2]) / 2;
  return CAG_OK;
}

CagStatus cag_patch_rounding(const CagLevelPatch *p, double *inner, double *most, CagError *err) {
  // Not simple fractions; the first and last are next to the edges.
  static const double places[] = {0.0011, 0.1117, 0.2913, 0.5231, 0.6719, 0.8783, 0.9989};
  enum { TRIED = sizeof places / sizeof *places };
  const double least = 1e-13, safety = 4;
  *inner = *most = least;
  for (int i = 0; i < TRIED; i++)
    for (int j = 0; j < TRIED; j++) {
      double jump;
      bool beside = i == 0 || i == TRIED - 1 || j == 0 || j == TRIED - 1;
      CagStatus status = jump_at(p, places[i], places[j], &jump, err);
      if (status) return status;
      if (!beside) *inner = fmax(*inner, safety * jump);
      *most = fmax(*most, safety * jump);
    }
  return CAG_OK;
}
