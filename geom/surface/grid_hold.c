// A fit to a grid of points that keeps one coordinate exact: this coordinate of the control points
// is fixed, from given planes or from a first fit, and the parameters of the data move to where the
// surface has the data's coordinate. Least squares for the other coordinates then preserves the
// match.
//
// With planes the coordinate is a function of one parameter, monotone if the planes are. It is
// inverted independently of the other coordinates, so that data of one station get identical
// parameters, and a tensor product fit stays one.

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "geom/basis/bspline.h"
#include "geom/basis/knots.h"
#include "geom/linalg/tolerance.h"
#include "geom/surface/grid_fit.h"

// Maximum number of steps for a parameter, by Newton's method and bisection.
#define STEPS_MOST 50
#define BISECTIONS_MOST 200
// Maximum number of halvings of a step without improvement.
#define HALVINGS_MOST 30
// Sums of basis functions times coordinates agree to this many units in the last place.
#define ROUNDING (16 * DBL_EPSILON)
// Parameters that decrease by less than this fraction of the range are in order up to rounding.
#define IN_ORDER CAG_COINCIDENT

static const char *name_of(const CagGridFit *f) {
  return &"x\0y\0z"[2 * (f->g->hold - CAG_GRID_HOLD_X)];
}

static double coordinate(const CagGridFit *f, CagVec3 p) { return *cag_grid_coordinate(f, &p); }
static double of_data(const CagGridFit *f, size_t i) { return coordinate(f, f->g->points[i]); }

static double size_of(const CagGridFit *f) {
  double most = 0;
  for (size_t i = 0; i < f->rows; i++) most = fmax(most, fabs(of_data(f, i)));
  for (size_t i = 0; f->planes && i < f->axis[f->planes_along].count; i++)
    most = fmax(most, fabs(f->planes[i]));
  return most;
}

// Accepted deviation of the coordinate.
static double slack_of(const CagGridFit *f) { return fmax(f->g->slack, ROUNDING * size_of(f)); }

static CagStatus fail_turns(const CagGridFit *f, size_t i, size_t before, CagError *err) {
  const size_t s = f->g->s;
  char a[32], b[32];
  return cag_fail(
      err, CAG_E_ARGUMENT, CAG_ERR_coordinate_turns, "fixed", (long)i,
      "%s must increase or decrease throughout the data, but it turns back from %s at point [%zu, %zu] to %s at point [%zu, %zu]; order the stations, keep another coordinate, or fit the parts before and after separately",
      name_of(f), cag_number_text(of_data(f, before), a), before / s, before % s,
      cag_number_text(of_data(f, i), b), i / s, i % s);
}

// --- Planes ---

// Total change of the coordinate along the lines of a direction, from their starts to their ends.
static double extent(const CagGridFit *f, int k) {
  const size_t r = f->g->r, s = f->g->s, lines = k == 0 ? s : r;
  double sum = 0;
  for (size_t l = 0; l < lines; l++)
    sum += fabs(k == 0 ? of_data(f, (r - 1) * s + l) - of_data(f, l)
                       : of_data(f, l * s + s - 1) - of_data(f, l * s));
  return sum / (double)lines;
}

static CagStatus choose_lines(CagGridFit *f, CagError *err) {
  const CagGridPlanes lines = f->g->lines;
  f->planes_along = lines == CAG_GRID_PLANES_V;
  if (lines == CAG_GRID_PLANES_EITHER) {
    const bool u = !f->axis[0].closed, v = !f->axis[1].closed;
    f->planes_along = v && (!u || extent(f, 1) > extent(f, 0));
  }
  if (!f->axis[f->planes_along].closed) return CAG_OK;
  return cag_fail(
      err, CAG_E_ARGUMENT, CAG_ERR_planes_closed, "planes", -1,
      "the surface is closed in %c, so planes in this direction cannot follow one another; %s",
      f->planes_along ? 'v' : 'u',
      f->axis[1 - f->planes_along].closed ? "leave it open in one direction, or omit the planes"
      : f->planes_along == 0              ? "give them for the other direction as {v: ...}"
                                          : "give them for the other direction as {u: ...}");
}

static CagStatus check_given(const CagGridFit *f, CagError *err) {
  const size_t wanted = f->axis[f->planes_along].count, n = f->g->plane_count;
  const double *x = f->g->planes;
  char a[32], b[32];
  if (n != wanted)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_plane_count, "planes", -1,
                    "%zu lines of control points in %c need as many `planes`, found %zu", wanted,
                    "uv"[f->planes_along], n);
  for (size_t i = 0; i < n; i++)
    if (!isfinite(x[i]))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "planes", (long)i,
                      "planes[%zu] is not a finite number", i);
  for (size_t i = 1; i < n; i++)
    if (x[1] > x[0] ? !(x[i] > x[i - 1]) : !(x[i] < x[i - 1]))
      return cag_fail(
          err, CAG_E_ARGUMENT, CAG_ERR_planes_not_monotone, "planes", (long)i,
          "`planes` must increase throughout, or decrease throughout: planes[%zu] = %s follows planes[%zu] = %s",
          i, cag_number_text(x[i], a), i - 1, cag_number_text(x[i - 1], b));
  return CAG_OK;
}

// The mean coordinate of each line of data, at its mean parameter.
static void stations(const CagGridFit *f, double *at, double *x) {
  const size_t r = f->g->r, s = f->g->s;
  const int k = f->planes_along;
  const size_t n = k == 0 ? r : s, lines = k == 0 ? s : r;
  for (size_t i = 0; i < n; i++) {
    at[i] = x[i] = 0;
    for (size_t l = 0; l < lines; l++) {
      const size_t point = k == 0 ? i * s + l : l * s + i;
      at[i] += f->parameters[k][point] / (double)lines;
      x[i] += of_data(f, point) / (double)lines;
    }
  }
}

// Linear interpolation between the stations, and extrapolation beyond the last ones.
static double between(const double *at, const double *x, size_t n, double t) {
  size_t i = 1;
  while (i + 1 < n && (at[i] < t || !(at[i] > at[i - 1]))) i++;
  const double step = at[i] - at[i - 1];
  return step > 0 ? x[i - 1] + (t - at[i - 1]) / step * (x[i] - x[i - 1]) : x[i];
}

// Planes at the Greville abscissas, where the control points of a straight line would be; the outer
// ones far enough out that all data lie between them.
static CagStatus find_planes(CagGridFit *f, CagError *err) {
  const CagGridAxis *a = &f->axis[f->planes_along];
  const size_t n = f->planes_along == 0 ? f->g->r : f->g->s, p = (size_t)a->degree;
  double *at = cag_malloc(2 * n * sizeof *at), least = INFINITY, most = -INFINITY;
  if (!at) return cag_fail_memory(err);
  double *x = at + n;
  stations(f, at, x);
  for (size_t i = 0; i < a->count; i++) {
    double t = 0;
    for (size_t j = 1; j <= p; j++) t += a->knots[i + j] / (double)p;
    f->planes[i] = between(at, x, n, t);
  }
  for (size_t i = 0; i < f->rows; i++) {
    least = fmin(least, of_data(f, i));
    most = fmax(most, of_data(f, i));
  }
  const bool grows = x[n - 1] > x[0];
  double *first = &f->planes[0], *last = &f->planes[a->count - 1];
  *first = grows ? fmin(*first, least) : fmax(*first, most);
  *last = grows ? fmax(*last, most) : fmin(*last, least);
  cag_free(at);
  for (size_t i = 1; i < a->count; i++)
    if (grows ? !(f->planes[i] > f->planes[i - 1]) : !(f->planes[i] < f->planes[i - 1]))
      return cag_fail(
          err, CAG_E_ARGUMENT, CAG_ERR_planes_not_monotone, "planes", (long)i,
          "the data do not determine the planes: the means of %s over their %s neither increase throughout nor decrease throughout; give the `planes` as a list",
          name_of(f), f->planes_along == 0 ? "rows" : "columns");
  return CAG_OK;
}

// The coordinate at a parameter, and its derivative.
static double along_planes(const CagGridFit *f, double t, double *slope) {
  const CagGridAxis *a = &f->axis[f->planes_along];
  double both[2 * (CAG_GRID_DEGREE_MOST + 1)], sum = 0;
  const size_t p = (size_t)a->degree;
  size_t span = cag_knots_span(a->knots, a->stored, a->degree, t, t >= cag_grid_end(a), p);
  cag_bspline_derivatives(a->knots, a->degree, span, t, 1, both);
  *slope = 0;
  for (size_t i = 0; i <= p; i++) {
    sum += both[i] * f->planes[span - p + i];
    *slope += both[p + 1 + i] * f->planes[span - p + i];
  }
  return sum;
}

// The parameter for a coordinate, or the nearest end. Newton's method within a bracket, which every
// third step halves.
static double parameter_of(const CagGridFit *f, double x) {
  const CagGridAxis *a = &f->axis[f->planes_along];
  double lo = cag_grid_start(a), hi = cag_grid_end(a), slope;
  const double first = along_planes(f, lo, &slope), last = along_planes(f, hi, &slope);
  const double sign = last > first ? 1 : -1;
  if (sign * (x - first) <= 0) return lo;
  if (sign * (x - last) >= 0) return hi;
  double t = lo + (hi - lo) * ((x - first) / (last - first));
  for (int step = 0; step < BISECTIONS_MOST; step++) {
    const double gap = x - along_planes(f, t, &slope);
    if (gap == 0) break;
    if (sign * gap > 0) lo = t;
    else hi = t;
    double next = t + gap / slope;
    if (step % 3 == 2 || !(next > lo && next < hi)) next = lo + (hi - lo) / 2;
    if (next == t || !(next > lo && next < hi)) break;
    t = next;
  }
  return t;
}

static CagStatus fail_beyond(const CagGridFit *f, size_t i, CagError *err) {
  const CagGridAxis *a = &f->axis[f->planes_along];
  double slope;
  char x[32], from[32], to[32];
  return cag_fail(
      err, CAG_E_ARGUMENT, CAG_ERR_beyond_planes, "planes", (long)i,
      "point [%zu, %zu] has %s = %s, but the surface between the `planes` extends from %s to %s; move the outer planes outward, or allow a larger `error`",
      i / f->g->s, i % f->g->s, name_of(f), cag_number_text(of_data(f, i), x),
      cag_number_text(along_planes(f, cag_grid_start(a), &slope), from),
      cag_number_text(along_planes(f, cag_grid_end(a), &slope), to));
}

// Whether all parameters match; if one does not, all are set from their coordinates.
static bool planes_matched(const CagGridFit *f, double slack) {
  const double *t = f->parameters[f->planes_along];
  double slope;
  for (size_t i = 0; i < f->rows; i++)
    if (!(fabs(of_data(f, i) - along_planes(f, t[i], &slope)) <= slack)) return false;
  return true;
}

static CagStatus match_planes(CagGridFit *f, int *rounds, CagError *err) {
  const double slack = slack_of(f);
  double *t = f->parameters[f->planes_along], slope;
  if (planes_matched(f, slack)) return CAG_OK;
  *rounds = 1;
  const size_t back = f->planes_along == 0 ? f->g->s : 1;
  const double sign = f->planes[1] > f->planes[0] ? 1 : -1;
  for (size_t i = 0; i < f->rows; i++) {
    const double x = of_data(f, i);
    t[i] = parameter_of(f, x);
    if (!(fabs(x - along_planes(f, t[i], &slope)) <= slack)) return fail_beyond(f, i, err);
    const bool first = f->planes_along == 0 ? i < f->g->s : i % f->g->s == 0;
    if (!first && sign * (of_data(f, i - back) - x) > slack) return fail_turns(f, i, i - back, err);
  }
  return CAG_OK;
}

static CagStatus hold_planes(CagGridFit *f, int *rounds, CagError *err) {
  CagStatus status = choose_lines(f, err);
  if (!status && f->g->planes) status = check_given(f, err);
  if (status) return status;
  const size_t count = f->axis[f->planes_along].count, nv = f->axis[1].count;
  f->planes = cag_malloc(count * sizeof *f->planes);
  if (!f->planes) return cag_fail_memory(err);
  if (f->g->planes) memcpy(f->planes, f->g->planes, count * sizeof *f->planes);
  else status = find_planes(f, err);
  for (size_t i = 0; !status && i < f->axis[0].count * nv; i++)
    f->held[i] = f->planes[f->planes_along == 0 ? i / nv : i % nv];
  return status ? status : match_planes(f, rounds, err);
}

// --- The coordinate of a first fit ---

// Point and first partials of the surface at a point of the data.
static CagStatus data_partials(const CagGridFit *f, const CagSurface *s, size_t i, CagVec3 d[4],
                               CagError *err) {
  return cag_surface_eval(s, f->parameters[0][i], f->parameters[1][i], 1, CAG_SIDE_RIGHT,
                          CAG_SIDE_RIGHT, d, err);
}

static double gap_of(const CagGridFit *f, size_t i, const CagVec3 d[4]) {
  return of_data(f, i) - coordinate(f, d[0]);
}

// The shortest step, as fractions of the ranges, that would close the gap: along the gradient, in
// the directions free for the point. Zero where the coordinate is stationary.
static void shortest_step(const CagGridFit *f, size_t i, const CagVec3 d[4], double gap,
                          double step[2]) {
  double g[2];
  for (int k = 0; k < 2; k++) {
    const CagGridAxis *a = &f->axis[k];
    const double lo = cag_grid_start(a), hi = cag_grid_end(a), t = f->parameters[k][i];
    g[k] = coordinate(f, d[cag_partial(1, 1 - k, k)]) * (hi - lo);
    const bool outward = gap * g[k] > 0 ? t == hi : t == lo;
    if (cag_grid_on_border(f, i, k) || (!a->closed && outward)) g[k] = 0;
  }
  const double square = g[0] * g[0] + g[1] * g[1];
  for (int k = 0; k < 2; k++) step[k] = square > 0 ? gap * g[k] / square : 0;
}

static CagStatus fail_match(const CagGridFit *f, size_t i, double gap, CagError *err) {
  char x[32], off[32];
  const bool border = cag_grid_on_border(f, i, 0) || cag_grid_on_border(f, i, 1);
  return cag_fail(
      err, CAG_E_CONVERGENCE, CAG_ERR_fit_no_convergence, "fixed", (long)i,
      "the surface comes no nearer than %s to the %s = %s of point [%zu, %zu]%s; allow a larger `error`, give the control points `planes`, or use more of them",
      cag_number_text(fabs(gap), off), name_of(f), cag_number_text(of_data(f, i), x), i / f->g->s,
      i % f->g->s, border ? ", which stays on the edge" : "");
}

// Moves one point's parameters by a step, halved until the gap gets smaller; false if it never
// does.
static CagStatus take_step(CagGridFit *f, const CagSurface *s, size_t i, double gap,
                           const double step[2], bool *gained, CagError *err) {
  double from[2];
  for (int k = 0; k < 2; k++) from[k] = f->parameters[k][i];
  *gained = false;
  double part = 1;
  for (int h = 0; h < HALVINGS_MOST && !*gained; h++, part /= 2) {
    CagVec3 d[4];
    for (int k = 0; k < 2; k++) {
      const CagGridAxis *a = &f->axis[k];
      f->parameters[k][i] =
          cag_grid_moved(a, from[k], part * step[k] * (cag_grid_end(a) - cag_grid_start(a)));
    }
    CagStatus status = data_partials(f, s, i, d, err);
    if (status) return status;
    *gained = fabs(gap_of(f, i, d)) < fabs(gap);
  }
  for (int k = 0; k < 2 && !*gained; k++) f->parameters[k][i] = from[k];
  return CAG_OK;
}

static CagStatus match_point(CagGridFit *f, const CagSurface *s, size_t i, double slack, int *steps,
                             CagError *err) {
  double gap = 0;
  for (*steps = 0; *steps < STEPS_MOST; ++*steps) {
    CagVec3 d[4];
    double step[2];
    bool gained;
    CagStatus status = data_partials(f, s, i, d, err);
    if (status) return status;
    gap = gap_of(f, i, d);
    if (fabs(gap) <= slack) return CAG_OK;
    shortest_step(f, i, d, gap, step);
    status = take_step(f, s, i, gap, step, &gained, err);
    if (status) return status;
    if (!gained) break;
  }
  return fail_match(f, i, gap, err);
}

static CagStatus match_all(CagGridFit *f, const CagSurface *s, int *rounds, CagError *err) {
  const double slack = slack_of(f);
  for (size_t i = 0; i < f->rows; i++) {
    int steps;
    CagStatus status = match_point(f, s, i, slack, &steps, err);
    if (status) return status;
    if (steps > *rounds) *rounds = steps;
  }
  return CAG_OK;
}

static CagStatus check_order(const CagGridFit *f, CagError *err) {
  for (int k = 0; k < 2; k++) {
    const CagGridAxis *a = &f->axis[k];
    const size_t back = k == 0 ? f->g->s : 1;
    const double *t = f->parameters[k], most = IN_ORDER * (cag_grid_end(a) - cag_grid_start(a));
    for (size_t i = back; !a->closed && i < f->rows; i++)
      if ((k == 0 || i % f->g->s > 0) && t[i - back] - t[i] > most)
        return fail_turns(f, i, i - back, err);
  }
  return CAG_OK;
}

static CagStatus hold_first_fit(CagGridFit *f, int *rounds, CagError *err) {
  CagSurface *s = NULL;
  double *held = f->held;
  f->edges = true;
  f->held = NULL;
  CagStatus status = cag_grid_surface(f, &s, err);
  f->held = held;
  if (status) return status;
  for (size_t i = 0; i < f->axis[0].count * f->axis[1].count; i++)
    held[i] = coordinate(f, f->net[i]);
  status = match_all(f, s, rounds, err);
  cag_surface_release(s);
  return status ? status : check_order(f, err);
}

CagStatus cag_grid_hold(CagGridFit *f, int *rounds, CagError *err) {
  *rounds = 0;
  f->held = cag_malloc(f->axis[0].count * f->axis[1].count * sizeof *f->held);
  if (!f->held) return cag_fail_memory(err);
  return f->g->lines == CAG_GRID_PLANES_NONE ? hold_first_fit(f, rounds, err)
                                             : hold_planes(f, rounds, err);
}

// --- Corrections ---

// The direction, as a step of the parameters, along which the coordinate is constant. Zero if a
// border leaves none.
static void level_direction(const CagGridFit *f, size_t i, const CagVec3 d[4], double out[2]) {
  double g[2], part[2];
  for (int k = 0; k < 2; k++) {
    g[k] = coordinate(f, d[cag_partial(1, 1 - k, k)]);
    part[k] = fabs(g[k]) * (cag_grid_end(&f->axis[k]) - cag_grid_start(&f->axis[k]));
    if (f->planes && k != f->planes_along) g[k] = part[k] = 0;
  }
  out[0] = -g[1];
  out[1] = g[0];
  for (int k = 0; k < 2; k++) {
    if (!cag_grid_on_border(f, i, k) || (f->planes && k == f->planes_along)) continue;
    // The line of constant coordinate must run along this border.
    if (part[1 - k] > IN_ORDER * part[k]) out[1 - k] = 0;
    out[k] = 0;
  }
}

CagStatus cag_grid_correct_held(CagGridFit *f, const CagSurface *s, CagError *err) {
  for (size_t i = 0; i < f->rows; i++) {
    CagVec3 d[4];
    double way[2];
    CagStatus status = data_partials(f, s, i, d, err);
    if (status) return status;
    level_direction(f, i, d, way);
    const CagVec3 along = cag_add(cag_scaled(d[cag_partial(1, 1, 0)], way[0]),
                                  cag_scaled(d[cag_partial(1, 0, 1)], way[1]));
    const double square = cag_dot(along, along);
    if (!(square > 0)) continue;
    const double step = cag_dot(cag_sub(f->g->points[i], d[0]), along) / square;
    for (int k = 0; k < 2; k++)
      f->parameters[k][i] = cag_grid_moved(&f->axis[k], f->parameters[k][i], step * way[k]);
  }
  int rounds = 0;
  return f->planes ? CAG_OK : match_all(f, s, &rounds, err);
}
