// Lines of curvature.
//
// The direction field is integrated by arc length with a Runge-Kutta method of order 4. Each step
// is taken once as a whole and once in halves: the difference controls the step length, and
// improves the result to order 5. A principal direction has no orientation; it is oriented like the
// previous one.
//
// Steps cannot reach a pole of the parametrization, which is often also an umbilic (on surfaces of
// revolution). A line that heads straight into a pole at which the surface is smooth continues
// straight on the other side, along the parameter line that leaves the pole in its direction.

#include "geom/meet/curvature_line.h"

#include <math.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/linalg/tolerance.h"
#include "geom/meet/section.h"

// Principal curvatures are equal if they differ by less than this fraction of the larger, or of the
// inverse size: second derivatives are not more accurate.
#define UMBILIC 1e-7
// Error of a step, as a fraction of the size: circles must be recognizable.
#define STEP_ERROR 1e-13
// Maximum turn of the line in a step (radians), for the cubics fitted to it.
#define STEP_TURN 0.06
#define STEPS_MOST 20000
#define FIRST_STEP 1e-3
#define SMALLEST_STEP 1e-12
// Rounding of the directions grows towards a pole or an umbilic. A line ends if a step as short as
// this is still not accurate enough.
#define TIRED_STEP 1e-7
// A line is closed if it returns within this fraction of the size of its start.
#define CLOSED 1e-6
// A line passes over a pole that is closer than AT_POLE of the size. If the principal curvatures
// differ by less than NEARLY_ROUND of the larger, rounding blurs their directions, and it passes
// from as far as AT_POLE_MOST.
#define AT_POLE 1e-4
#define AT_POLE_MOST 0.1
#define NEARLY_ROUND 1e-3
// Sine of the angle by which a line may miss a pole, and deviate from the parameter line beyond it.
#define AIM 1e-5
// cos 0.8 degrees: a sharper bend at a pole is a tip.
#define SMOOTH_COSINE 0.9999

CagStatus cag_surface_principal(const CagSurface *s, double u, double v, bool *found,
                                CagPrincipal *out, CagError *err) {
  const double flat = CAG_ROUNDING;
  CagVec3 d[9];
  *found = false;
  CagStatus status = cag_surface_eval(s, u, v, 2, u >= s->u1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT,
                                      v >= s->v1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, d, err);
  if (status) return status;
  CagVec3 su = d[cag_partial(2, 1, 0)], sv = d[cag_partial(2, 0, 1)], n = cag_cross(su, sv);
  double x = cag_norm(su), size = cag_norm(n);
  out->point = d[0];
  out->k[0] = out->k[1] = 0;
  if (!(size > flat * x * cag_norm(sv))) return CAG_OK;
  n = cag_unit(n);
  // In the orthonormal basis e1, e2: su = x e1, sv = c e1 + e e2.
  CagVec3 e1 = cag_unit(su), e2 = cag_cross(n, e1);
  double c = cag_dot(sv, e1), e = cag_dot(sv, e2);
  double l = cag_dot(d[cag_partial(2, 2, 0)], n), m = cag_dot(d[cag_partial(2, 1, 1)], n),
         k = cag_dot(d[cag_partial(2, 0, 2)], n);
  double a = l / (x * x), b = (m / x - c * a) / e, g = (k - c * c * a - 2 * c * e * b) / (e * e);
  double middle = (a + g) / 2, spread = hypot((a - g) / 2, b), turn = atan2(b, (a - g) / 2) / 2;
  out->k[0] = middle - spread;
  out->k[1] = middle + spread;
  for (int i = 0; i < 2; i++) {
    double p = i == 1 ? cos(turn) : -sin(turn), q = i == 1 ? sin(turn) : cos(turn);
    out->direction[i] = cag_madd(cag_scaled(e1, p), q, e2);
    out->step[i][1] = q / e;
    out->step[i][0] = (p - c * q / e) / x;
  }
  *found = true;
  return CAG_OK;
}

typedef struct Place {
  double u, v;
} Place;

typedef struct Walk {
  const CagSurface *s;
  int which;
  double size;
  CagTrace trace;
  size_t capacity;
  CagStatus status;
  CagError *err;
} Walk;

static double wrapped(double x, double lo, double hi) {
  double period = hi - lo;
  while (x < lo) x += period;
  while (x > hi) x -= period;
  return x;
}

// Brings the parameters into the domain; false outside.
static bool bring_in(const CagSurface *s, Place *p) {
  if (s->closed_u) p->u = wrapped(p->u, s->u0, s->u1);
  if (s->closed_v) p->v = wrapped(p->v, s->v0, s->v1);
  return p->u >= s->u0 && p->u <= s->u1 && p->v >= s->v0 && p->v <= s->v1;
}

// Whether the principal curvatures differ by no more than a part of the larger.
static bool is_round(const Walk *w, const CagPrincipal *p, double part) {
  double large = fmax(fabs(p->k[0]), fabs(p->k[1]));
  return p->k[1] - p->k[0] <= part * fmax(large, 1 / w->size);
}

static bool is_umbilic(const Walk *w, const CagPrincipal *p) { return is_round(w, p, UMBILIC); }

// The direction at a point, oriented like `sense`; false if it is undefined.
static bool way_at(Walk *w, Place at, CagVec3 sense, CagPrincipal *p, Place *way,
                   CagVec3 *tangent) {
  bool found;
  if (!bring_in(w->s, &at)) return false;
  w->status = cag_surface_principal(w->s, at.u, at.v, &found, p, w->err);
  if (w->status || !found || is_umbilic(w, p)) return false;
  double sign = cag_dot(p->direction[w->which], sense) < 0 ? -1 : 1;
  *tangent = cag_scaled(p->direction[w->which], sign);
  *way = (Place){sign * p->step[w->which][0], sign * p->step[w->which][1]};
  return true;
}

// The length of a small parameter step at a point.
static double length_of(const CagPrincipal *p, double u, double v) {
  const double *a = p->step[0], *b = p->step[1], area = a[0] * b[1] - a[1] * b[0];
  return hypot((u * b[1] - v * b[0]) / area, (v * a[0] - u * a[1]) / area);
}

static Place ahead(Place at, double h, Place way) {
  return (Place){at.u + h * way.u, at.v + h * way.v};
}

static bool one_step(Walk *w, Place at, CagVec3 sense, double h, Place *out) {
  CagPrincipal p;
  Place k[4];
  CagVec3 t;
  if (!way_at(w, at, sense, &p, &k[0], &t) ||
      !way_at(w, ahead(at, h / 2, k[0]), t, &p, &k[1], &t) ||
      !way_at(w, ahead(at, h / 2, k[1]), t, &p, &k[2], &t) ||
      !way_at(w, ahead(at, h, k[2]), t, &p, &k[3], &t))
    return false;
  out->u = at.u + h / 6 * (k[0].u + 2 * k[1].u + 2 * k[2].u + k[3].u);
  out->v = at.v + h / 6 * (k[0].v + 2 * k[1].v + 2 * k[2].v + k[3].v);
  return true;
}

static bool add_point(Walk *w, CagVec3 p, CagVec3 t) {
  CagTrace *a = &w->trace;
  if (a->count == w->capacity) {
    size_t capacity = 2 * w->capacity + 64;
    if (!CAG_RESIZE(a->points, capacity) || !CAG_RESIZE(a->tangents, capacity)) {
      w->status = cag_fail_memory(w->err);
      return false;
    }
    w->capacity = capacity;
  }
  a->points[a->count] = p;
  a->tangents[a->count++] = t;
  return true;
}

// --- Poles ---

// Edge `end` of direction k, which is a single point.
typedef struct Pole {
  int k, end;
  CagVec3 point;
} Pole;

static Place place_by(const Walk *w, const Pole *pole, double off, double x) {
  const CagSurface *s = w->s;
  double lo = pole->k ? s->v0 : s->u0, hi = pole->k ? s->v1 : s->u1;
  double along = pole->end ? hi - off : lo + off;
  return pole->k ? (Place){x, along} : (Place){along, x};
}

// The direction in which the parameter line leaves, at `off` from the pole.
static bool leaving(Walk *w, const Pole *pole, double off, double x, CagVec3 *point, CagVec3 *way) {
  CagVec3 d[4];
  Place at = place_by(w, pole, off, x);
  if (!bring_in(w->s, &at)) return false;
  w->status = cag_surface_eval(w->s, at.u, at.v, 1, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, w->err);
  if (w->status) return false;
  *point = d[0];
  *way = cag_scaled(d[pole->k ? cag_partial(1, 0, 1) : cag_partial(1, 1, 0)], pole->end ? -1 : 1);
  return cag_norm(*way) > 0;
}

// The pole that the line heads into from a distance below `near`.
static bool find_pole(Walk *w, CagVec3 at, CagVec3 tangent, double near, Pole *out) {
  const CagSurface *s = w->s;
  const bool is_pole[2][2] = {{s->pole_u0, s->pole_u1}, {s->pole_v0, s->pole_v1}};
  for (int i = 0; i < 4; i++) {
    Pole pole = {i / 2, i % 2, {0, 0, 0}};
    CagVec3 way;
    if (!is_pole[i / 2][i % 2]) continue;
    double x = pole.k ? s->u0 : s->v0;
    if (!leaving(w, &pole, 0, x, &pole.point, &way)) continue;
    CagVec3 off = cag_sub(pole.point, at);
    if (cag_norm(off) <= near && cag_dot(off, tangent) > 0) {
      *out = pole;
      return true;
    }
  }
  return false;
}

// The start of the parameter line that leaves the pole in a direction; false if there is none.
static bool find_leaving(Walk *w, const Pole *pole, CagVec3 along, double *out) {
  enum { TRIED = 72 };
  const int halvings = 60;
  const CagSurface *s = w->s;
  double lo = pole->k ? s->u0 : s->v0, step = ((pole->k ? s->u1 : s->v1) - lo) / TRIED;
  double best = -1, x = lo;
  CagVec3 p, way, ways[2];
  for (int i = 0; i <= TRIED && !w->status; i++)
    if (leaving(w, pole, 0, fmin(lo + i * step, lo + TRIED * step), &p, &way) &&
        cag_dot(cag_unit(way), along) > best) {
      best = cag_dot(cag_unit(way), along);
      x = lo + i * step;
    }
  double from = x - step, to = x + step;
  if (!leaving(w, pole, 0, from, &p, &ways[0]) || !leaving(w, pole, 0, to, &p, &ways[1]))
    return false;
  CagVec3 side = cag_cross(cag_cross(ways[0], ways[1]), along);
  if (!(cag_dot(ways[0], side) < 0 && cag_dot(ways[1], side) > 0)) return false;
  for (int i = 0; i < halvings; i++) {
    double middle = (from + to) / 2;
    if (!leaving(w, pole, 0, middle, &p, &way)) return false;
    if (cag_dot(way, side) < 0) from = middle;
    else to = middle;
  }
  *out = (from + to) / 2;
  return leaving(w, pole, 0, *out, &p, &way) && cag_dot(cag_unit(way), along) > SMOOTH_COSINE;
}

// Passes over a pole ahead that is closer than `near`: the point beyond it, at which the line
// continues, and the pole as a point of the line.
static bool pass_pole(Walk *w, Place *at, CagPrincipal *p, CagVec3 *tangent, double near,
                      double *gone) {
  const double widest = 4, wider = 1.1;
  Pole pole;
  double x;
  if (!find_pole(w, p->point, *tangent, near, &pole)) return false;
  CagVec3 off = cag_sub(pole.point, p->point), back, beside;
  double d = cag_norm(off);
  // The line must run along a parameter line, so that it leads into the pole and not past it, and
  // continue in that line's direction there, which must be that of an arc from here.
  Place edge = place_by(w, &pole, 0, 0);
  double distance = fabs(pole.k ? at->v - edge.v : at->u - edge.u), line = pole.k ? at->u : at->v;
  if (!leaving(w, &pole, distance, line, &beside, &back)) return false;
  if (cag_norm(cag_cross(cag_unit(back), *tangent)) > AIM) return false;
  CagVec3 arc = cag_unit(cag_sub(cag_scaled(off, 2 / d), *tangent));
  if (!leaving(w, &pole, 0, line, &beside, &back)) return false;
  CagVec3 along = cag_scaled(cag_unit(back), -1);
  if (cag_dot(along, arc) < SMOOTH_COSINE) return false;
  if (!find_leaving(w, &pole, along, &x)) return false;
  CagVec3 point, ahead_of;
  if (!leaving(w, &pole, 0, x, &point, &ahead_of)) return false;
  for (double far = near > AT_POLE * w->size ? 2 * d : d; far <= widest * d; far *= wider) {
    Place next = place_by(w, &pole, far / cag_norm(ahead_of), x);
    CagPrincipal found;
    Place next_way;
    CagVec3 next_tangent, leads;
    if (!bring_in(w->s, &next)) return false;
    if (!way_at(w, next, along, &found, &next_way, &next_tangent)) {
      if (w->status) return false;
      continue; // still an umbilic
    }
    if (!leaving(w, &pole, far / cag_norm(ahead_of), x, &point, &leads) ||
        cag_norm(cag_cross(cag_unit(leads), next_tangent)) > AIM)
      return false;
    *gone += d + cag_norm(cag_sub(found.point, pole.point));
    *at = next;
    *p = found;
    *tangent = next_tangent;
    return add_point(w, pole.point, along) && add_point(w, p->point, *tangent);
  }
  return false;
}

// --- The line ---

// Continues from a point until the line ends. Returns true if it has returned to the start.
static bool walk(Walk *w, Place at, CagVec3 sense) {
  CagPrincipal p;
  Place next_way;
  CagVec3 tangent, start, first = sense;
  double h = FIRST_STEP * w->size, gone = 0;
  if (!way_at(w, at, sense, &p, &next_way, &tangent)) return false;
  start = p.point;
  for (int steps = 0; steps < STEPS_MOST; steps++) {
    Place whole, half, twice;
    CagPrincipal next_p;
    CagVec3 next;
    bool stopped = h <= SMALLEST_STEP * w->size;
    double near = (is_round(w, &p, NEARLY_ROUND) ? AT_POLE_MOST : AT_POLE) * w->size;
    if (pass_pole(w, &at, &p, &tangent, near, &gone)) h = FIRST_STEP * w->size;
    else if (stopped || w->status) return false;
    // Near the start the step must end there.
    CagVec3 home = cag_sub(start, p.point);
    double left = cag_norm(home);
    bool returning = gone > 4 * h && left < 2 * h && cag_dot(home, tangent) > 0;
    if (returning && cag_dot(home, tangent) < h) h = cag_dot(home, tangent);
    if (returning && left <= CLOSED * w->size) return cag_dot(tangent, first) > 0;
    if (!one_step(w, at, tangent, h, &whole) || !one_step(w, at, tangent, h / 2, &half) ||
        !one_step(w, half, tangent, h / 2, &twice) ||
        !way_at(w, twice, tangent, &next_p, &next_way, &next)) {
      if (w->status) return false;
      h /= 2; // up to the border, or the umbilic
      continue;
    }
    double error = length_of(&p, twice.u - whole.u, twice.v - whole.v) / 15;
    double turn = cag_norm(cag_sub(next, tangent));
    if (error > STEP_ERROR * w->size || turn > STEP_TURN) {
      if (h <= TIRED_STEP * w->size) return false;
      h /= 2;
      continue;
    }
    Place better = {twice.u + (twice.u - whole.u) / 15, twice.v + (twice.v - whole.v) / 15};
    if (!bring_in(w->s, &better) || !way_at(w, better, next, &next_p, &next_way, &next)) {
      if (w->status) return false;
      h /= 2;
      continue;
    }
    at = better;
    p = next_p;
    tangent = next;
    if (!add_point(w, p.point, tangent)) return false;
    gone += h;
    double grow = error > 0 ? 0.8 * pow(STEP_ERROR * w->size / error, 0.2) : 2;
    h *= fmin(2, fmax(0.5, grow));
    if (returning && cag_norm(cag_sub(start, p.point)) <= CLOSED * w->size)
      return cag_dot(tangent, first) > 0;
  }
  return false;
}

// Reverses the points so far.
static void turn_back(CagTrace *t) {
  for (size_t i = 0, j = t->count; i < j--; i++) {
    CagVec3 p = t->points[i], d = t->tangents[i];
    t->points[i] = t->points[j];
    t->points[j] = p;
    t->tangents[i] = cag_scaled(t->tangents[j], -1);
    t->tangents[j] = cag_scaled(d, -1);
  }
}

static void trace_line(Walk *w, double u, double v, const CagPrincipal *p) {
  Place at = {u, v};
  CagVec3 sense = p->direction[w->which];
  // Backward first, then reversed, and on from the start.
  if (!add_point(w, p->point, cag_scaled(sense, -1))) return;
  if (walk(w, at, cag_scaled(sense, -1)) && !w->status) {
    CagTrace *t = &w->trace;
    t->closed = true;
    if (cag_norm(cag_sub(t->points[t->count - 1], p->point)) > CLOSED * w->size) {
      add_point(w, p->point, t->tangents[0]);
    }
    t->points[t->count - 1] = t->points[0];
    t->tangents[t->count - 1] = t->tangents[0];
    return;
  }
  if (w->status) return;
  turn_back(&w->trace);
  walk(w, at, sense);
}

CagStatus cag_surface_curvature_line(const CagSurface *s, double u, double v, bool larger,
                                     CagCurve **out, CagError *err) {
  CagBounds box;
  CagPrincipal p;
  bool found;
  CagStatus status = cag_surface_bounds(s, &box, err);
  if (!status) status = cag_surface_principal(s, u, v, &found, &p, err);
  if (status) return status;
  Walk w = {.s = s, .which = larger ? 1 : 0, .err = err};
  w.size = cag_norm(cag_sub(box.max, box.min));
  if (!found)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_degenerate_normal, "", -1,
                    "the surface has no normal there, so no line of curvature begins there");
  if (is_umbilic(&w, &p))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_umbilic, "", -1,
                    "both principal curvatures are the same there (an umbilic): every direction is "
                    "a principal one");
  trace_line(&w, u, v, &p);
  status = w.status;
  if (!status && w.trace.count < 2)
    status = cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_umbilic, "", -1,
                      "the line of curvature ends where it begins: next to it is an umbilic or the "
                      "border");
  if (!status) status = cag_trace_curve(&w.trace, NULL, w.size, out, err);
  cag_free(w.trace.points);
  cag_free(w.trace.tangents);
  return status;
}
