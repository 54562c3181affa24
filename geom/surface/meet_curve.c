// A curve against a surface by subdivision of both.
//
// A part of the curve lies within its sag of its chord; a cell of the surface within its bow of the
// plane through the middle of its corners. Pairs that these keep apart are dropped; where the chord
// passes the plane steeply enough for one crossing only, Newton's method finishes; other pairs are
// halved on the side that is bent more. What is left at the smallest size are touches.

#include "geom/surface/meet_curve.h"
#include "geom/surface/trimmed.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "geom/curve/family.h"

// Parts of the size of the data: where two points are one, where things count as flat, where
// meetings found twice are the same.
#define MEET 1e-9
#define FLAT 1e-10
#define SAME_POINT 1e-7
// Parts of a domain within which parameters are one place.
#define SAME_PLACE 1e-4
// Pairs looked at before the curve is taken to run within the surface.
#define MOST_PAIRS 400000
#define DEPTH 100
// A stretch in common that is longer than this part of the size is an overlap.
#define COMMON 1e-3
// How far from a pair a touch is looked for, in its widths.
#define TOUCH_REACH 128
// Cells of a smooth patch, and parts of a smooth piece, to begin with, in each direction.
#define FIRST 4

typedef struct Part {
  double a, b, sag;
  CagVec3 p, q;
} Part;

typedef struct Cell {
  double u[2], v[2], bow;
  double along_u, along_v; // the longer of two opposite edges
  CagVec3 middle, normal;  // of the plane; normal: unit
  CagBounds box;           // holds the cell
} Cell;

typedef struct Search {
  const CagSurface *s;
  const CagCurve *c;
  double size, noise;
  size_t pairs;
  CagSurfaceMeeting *items;
  size_t n, capacity;
} Search;

static CagStatus fail_overlap(CagError *err) {
  return cag_fail(err, CAG_E_DEGENERATE, "overlap", "", -1,
                  "the curve runs within the surface: they share more than single points");
}

// --- Parts and cells ---

static CagStatus make_part(const Search *s, Part *part, CagError *err) {
  CagStatus status = cag_curve_eval(s->c, part->a, 0, CAG_SIDE_RIGHT, &part->p, err);
  if (!status) status = cag_curve_eval(s->c, part->b, 0, CAG_SIDE_LEFT, &part->q, err);
  if (!status) part->sag = cag_curve_sag(s->c, part->a, part->b);
  return status;
}

// The bow is the largest distance of samples from the plane, and half as much again.
static CagStatus make_cell(const Search *s, Cell *cell, CagError *err) {
  enum { SIDE = 4 };
  const double safety = 1.5;
  CagVec3 grid[SIDE * SIDE];
  double us[SIDE], vs[SIDE];
  for (int i = 0; i < SIDE; i++) {
    us[i] = i + 1 == SIDE ? cell->u[1] : cell->u[0] + (cell->u[1] - cell->u[0]) * i / (SIDE - 1);
    vs[i] = i + 1 == SIDE ? cell->v[1] : cell->v[0] + (cell->v[1] - cell->v[0]) * i / (SIDE - 1);
  }
  CagStatus status = cag_surface_eval_grid(s->s, us, SIDE, vs, SIDE, grid, NULL, NULL, err);
  if (status) return status;
  const CagVec3 d = cag_sub(grid[SIDE * SIDE - 1], grid[0]);
  const CagVec3 e = cag_sub(grid[SIDE * (SIDE - 1)], grid[SIDE - 1]);
  cell->normal = cag_unit(cag_cross(d, e));
  cell->middle = cag_scaled(cag_add(cag_add(grid[0], grid[SIDE - 1]),
                                    cag_add(grid[SIDE * (SIDE - 1)], grid[SIDE * SIDE - 1])),
                            0.25);
  cell->bow = 0;
  cell->box = CAG_BOUNDS_EMPTY;
  for (int i = 0; i < SIDE * SIDE; i++) {
    cell->bow = fmax(cell->bow, fabs(cag_dot(cag_sub(grid[i], cell->middle), cell->normal)));
    cag_bounds_add(&cell->box, grid[i]);
  }
  cell->bow *= safety;
  cell->along_u = fmax(cag_norm(cag_sub(grid[SIDE * (SIDE - 1)], grid[0])),
                       cag_norm(cag_sub(grid[SIDE * SIDE - 1], grid[SIDE - 1])));
  cell->along_v = fmax(cag_norm(cag_sub(grid[SIDE - 1], grid[0])),
                       cag_norm(cag_sub(grid[SIDE * SIDE - 1], grid[SIDE * (SIDE - 1)])));
  // Between samples of a grid of SIDE the surface may reach out of their box by its bend, too.
  const double out = fmax(cell->bow, cag_norm(cag_sub(cell->box.max, cell->box.min)) / 8);
  cell->box.min = cag_sub(cell->box.min, cag_vec3(out, out, out));
  cell->box.max = cag_add(cell->box.max, cag_vec3(out, out, out));
  return CAG_OK;
}

static bool outside(double a, double b, double low, double high, double slack) {
  return fmax(a, b) + slack < low || fmin(a, b) - slack > high;
}

static bool apart(const Search *s, const Part *part, const Cell *cell) {
  const double slack = part->sag + MEET * s->size;
  const CagBounds *b = &cell->box;
  if (outside(part->p.x, part->q.x, b->min.x, b->max.x, slack) ||
      outside(part->p.y, part->q.y, b->min.y, b->max.y, slack) ||
      outside(part->p.z, part->q.z, b->min.z, b->max.z, slack))
    return true;
  if (cag_norm(cell->normal) == 0) return false;
  const double h = cag_dot(cag_sub(part->p, cell->middle), cell->normal);
  const double k = cag_dot(cag_sub(part->q, cell->middle), cell->normal);
  return h * k > 0 && fmin(fabs(h), fabs(k)) > slack + cell->bow;
}

// --- Newton ---

static bool solve3(double m[3][3], const double r[3], double out[3]) {
  double det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
               m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
               m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  if (!(fabs(det) > 0) || !isfinite(det)) return false;
  for (int k = 0; k < 3; k++) {
    double a[3][3];
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) a[i][j] = j == k ? r[i] : m[i][j];
    out[k] = (a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
              a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
              a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0])) /
             det;
  }
  return true;
}

static double dot_of(const CagVec3 *a, const CagVec3 *b) { return cag_dot(*a, *b); }

// The step of Gauss and Newton; where directions are dependent, damped.
static bool step_to(const CagVec3 columns[3], CagVec3 residual, double out[3]) {
  double m[3][3] = {{columns[0].x, columns[1].x, columns[2].x},
                    {columns[0].y, columns[1].y, columns[2].y},
                    {columns[0].z, columns[1].z, columns[2].z}};
  const double r[3] = {-residual.x, -residual.y, -residual.z};
  const double volume = cag_dot(columns[0], cag_cross(columns[1], columns[2]));
  const double most = cag_norm(columns[0]) * cag_norm(columns[1]) * cag_norm(columns[2]);
  if (fabs(volume) > FLAT * most && solve3(m, r, out)) return true;
  const double damping = 1e-12;
  double normal[3][3], rhs[3], trace = 0;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) normal[i][j] = dot_of(&columns[i], &columns[j]);
    rhs[i] = -cag_dot(columns[i], residual);
    trace += normal[i][i];
  }
  for (int i = 0; i < 3; i++) normal[i][i] += damping * trace + DBL_MIN;
  return solve3(normal, rhs, out);
}

// --- Overlap ---

static int by_t(const void *a, const void *b) {
  const CagSurfaceMeeting *x = a, *y = b;
  if (x->t != y->t) return x->t > y->t ? 1 : -1;
  if (x->u != y->u) return x->u > y->u ? 1 : -1;
  return (x->v > y->v) - (x->v < y->v);
}

static double within(double x, double low, double high) { return fmin(high, fmax(low, x)); }

// Does the curve's point at t lie on the surface, near to a place of it?
static CagStatus is_on(const Search *s, double t, double u, double v, bool *out, CagError *err) {
  enum { STEPS = 12 };
  CagVec3 p, q[4];
  CagStatus status = cag_curve_eval(s->c, t, 0, CAG_SIDE_RIGHT, &p, err);
  *out = false;
  for (int i = 0; !status && i < STEPS && !*out; i++) {
    status = cag_surface_eval(s->s, u, v, 1, u >= s->s->u1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT,
                              v >= s->s->v1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, q, err);
    if (status) return status;
    const CagVec3 r = cag_sub(p, q[0]), du = q[cag_partial(1, 1, 0)], dv = q[cag_partial(1, 0, 1)];
    const double a = cag_dot(du, du), b = cag_dot(du, dv), c = cag_dot(dv, dv), det = a * c - b * b;
    *out = cag_norm(r) <= MEET * s->size + s->noise;
    if (!(det > 0)) break;
    u = within(u + (c * cag_dot(du, r) - b * cag_dot(dv, r)) / det, s->s->u0, s->s->u1);
    v = within(v + (a * cag_dot(dv, r) - b * cag_dot(du, r)) / det, s->s->v0, s->s->v1);
  }
  return status;
}

// A curve within the surface is found as a row of meetings, between which it meets the surface too.
static CagStatus check_overlap(const Search *s, CagError *err) {
  const size_t row = 8; // meetings
  CagSurfaceMeeting *m = malloc((s->n + 1) * sizeof *m);
  if (!m) return cag_fail_memory(err);
  memcpy(m, s->items, s->n * sizeof *m);
  qsort(m, s->n, sizeof *m, by_t);
  CagStatus status = CAG_OK;
  double length = 0;
  size_t found = 0;
  for (size_t i = 0; !status && i + 1 < s->n; i++) {
    const double gap = cag_norm(cag_sub(m[i + 1].point, m[i].point));
    bool on;
    if (gap <= SAME_POINT * s->size) continue;
    status = is_on(s, m[i].t + (m[i + 1].t - m[i].t) / 2, m[i].u, m[i].v, &on, err);
    found = on ? found + 1 : 0;
    length = on ? length + gap : 0;
    if (!status && found >= row && length > COMMON * s->size) status = fail_overlap(err);
  }
  free(m);
  return status;
}

static CagStatus add(Search *s, CagSurfaceMeeting m, CagError *err) {
  if (s->n == s->capacity) {
    size_t capacity = s->capacity ? 2 * s->capacity : 16;
    CagSurfaceMeeting *grown = realloc(s->items, sizeof *grown * capacity);
    if (!grown) return cag_fail_memory(err);
    s->items = grown;
    s->capacity = capacity;
  }
  s->items[s->n++] = m;
  // So many are looked at, and again when they have become twice as many.
  const size_t many = 256;
  return s->n >= many && (s->n & (s->n - 1)) == 0 ? check_overlap(s, err) : CAG_OK;
}

// Within `reach` widths of part and cell about them.
static CagStatus meet(Search *s, const Part *part, const Cell *cell, double reach, CagError *err) {
  const double width_t = part->b - part->a, width_u = cell->u[1] - cell->u[0],
               width_v = cell->v[1] - cell->v[0];
  const double reach_t = reach * width_t, reach_u = reach * width_u, reach_v = reach * width_v;
  double t = part->a + width_t / 2, u = cell->u[0] + width_u / 2, v = cell->v[0] + width_v / 2;
  double best = INFINITY;
  CagSurfaceMeeting found = {0};
  for (int i = 0; i < 80; i++) {
    CagVec3 p[2], q[4];
    CagStatus status =
        cag_curve_eval(s->c, t, 1, t >= part->b ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, p, err);
    if (!status)
      status = cag_surface_eval(s->s, u, v, 1, u >= cell->u[1] ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT,
                                v >= cell->v[1] ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, q, err);
    if (status) return status;
    const CagVec3 r = cag_sub(p[0], q[0]);
    const double distance = cag_norm(r);
    if (distance < best) {
      best = distance;
      found = (CagSurfaceMeeting){t, u, v, p[0]};
    }
    const CagVec3 columns[3] = {p[1], cag_scaled(q[cag_partial(1, 1, 0)], -1),
                                cag_scaled(q[cag_partial(1, 0, 1)], -1)};
    double step[3];
    if (!step_to(columns, r, step)) break;
    const double next_t = within(t + step[0], fmax(s->c->start, part->a - reach_t),
                                 fmin(s->c->end, part->b + reach_t));
    const double next_u = within(u + step[1], fmax(s->s->u0, cell->u[0] - reach_u),
                                 fmin(s->s->u1, cell->u[1] + reach_u));
    const double next_v = within(v + step[2], fmax(s->s->v0, cell->v[0] - reach_v),
                                 fmin(s->s->v1, cell->v[1] + reach_v));
    if (next_t == t && next_u == u && next_v == v) break;
    t = next_t;
    u = next_u;
    v = next_v;
  }
  return best <= MEET * s->size + s->noise ? add(s, found, err) : CAG_OK;
}

// --- Subdivision ---

static CagStatus halve_part(const Search *s, const Part *part, Part out[2], CagError *err) {
  const double m = part->a + (part->b - part->a) / 2;
  out[0] = (Part){.a = part->a, .b = m};
  out[1] = (Part){.a = m, .b = part->b};
  CagStatus status = make_part(s, &out[0], err);
  return status ? status : make_part(s, &out[1], err);
}

// Across the longer side of the cell.
static CagStatus halve_cell(const Search *s, const Cell *cell, Cell out[2], CagError *err) {
  out[0] = out[1] = *cell;
  if (cell->along_u >= cell->along_v)
    out[0].u[1] = out[1].u[0] = cell->u[0] + (cell->u[1] - cell->u[0]) / 2;
  else out[0].v[1] = out[1].v[0] = cell->v[0] + (cell->v[1] - cell->v[0]) / 2;
  CagStatus status = make_cell(s, &out[0], err);
  return status ? status : make_cell(s, &out[1], err);
}

// A chord along a flat cell: overlap where its middle lies in the cell, else a touch at most.
static CagStatus along(Search *s, const Part *part, const Cell *cell, CagError *err) {
  const size_t before = s->n;
  Part middle = *part;
  for (int i = 1; i < 4; i++) {
    const double t = part->a + (part->b - part->a) * i / 4;
    middle.a = middle.b = t;
    CagStatus status = meet(s, &middle, cell, 1, err);
    if (status) return status;
  }
  if (s->n - before == 3) return fail_overlap(err);
  s->n = before;
  return meet(s, part, cell, TOUCH_REACH, err);
}

static CagStatus pair(Search *s, const Part *part, const Cell *cell, int depth, CagError *err) {
  // Slope of the chord against the plane beside what both bend, that leaves room for one crossing.
  const double steep = 8;
  if (apart(s, part, cell)) return CAG_OK;
  if (++s->pairs > MOST_PAIRS) return fail_overlap(err);
  const CagVec3 d = cag_sub(part->q, part->p);
  const double chord = cag_norm(d), rise = fabs(cag_dot(d, cell->normal)),
               width = fmin(cell->along_u, cell->along_v);
  const bool one = rise > MEET * chord && chord < steep * width &&
                   rise > steep * (part->sag + cell->bow * chord / width);
  if (one) return meet(s, part, cell, 1, err);
  // Both as good as flat and along each other: a touch, whose crossings Newton's method finds from
  // all pairs about it, or a stretch in common.
  const double flat = FLAT * s->size + s->noise;
  const bool flats = part->sag <= flat && cell->bow <= flat;
  if (flats && rise <= MEET * s->size && chord > COMMON * s->size) return along(s, part, cell, err);
  if (depth == 0 || flats) return meet(s, part, cell, TOUCH_REACH, err);
  CagStatus status = CAG_OK;
  if (part->sag > cell->bow || chord > steep * width / 2) {
    Part half[2];
    status = halve_part(s, part, half, err);
    for (int i = 0; !status && i < 2; i++) status = pair(s, &half[i], cell, depth - 1, err);
  } else {
    Cell half[2];
    status = halve_cell(s, cell, half, err);
    for (int i = 0; !status && i < 2; i++) status = pair(s, part, &half[i], depth - 1, err);
  }
  return status;
}

// --- What was found ---

static bool same(double a, double b, double low, double high, bool closed) {
  const double gap = fabs(a - b), range = high - low;
  return gap <= SAME_PLACE * range || (closed && gap >= (1 - SAME_PLACE) * range);
}

static bool at_pole(const CagSurface *s, const CagSurfaceMeeting *m, bool of_u) {
  if (of_u)
    return (s->pole_u0 && same(m->u, s->u0, s->u0, s->u1, false)) ||
           (s->pole_u1 && same(m->u, s->u1, s->u0, s->u1, false));
  return (s->pole_v0 && same(m->v, s->v0, s->v0, s->v1, false)) ||
         (s->pole_v1 && same(m->v, s->v1, s->v0, s->v1, false));
}

// Sorts, puts seams to their start, and drops what was found twice or lies outside of a trimmed
// plane.
static CagStatus tidy(Search *f, CagError *err) {
  const CagSurface *s = f->s;
  const CagCurve *c = f->c;
  const CagRegion *region;
  CagTransform frame;
  const bool trimmed =
      cag_surface_planar_view(s, &region, &frame) || cag_surface_trimmed_view(s, NULL, &region);
  for (size_t i = 0; i < f->n; i++) {
    CagSurfaceMeeting *m = &f->items[i];
    if (c->closed && c->end - m->t <= MEET * (c->end - c->start)) m->t = c->start;
    if (s->closed_u && s->u1 - m->u <= MEET * (s->u1 - s->u0)) m->u = s->u0;
    if (s->closed_v && s->v1 - m->v <= MEET * (s->v1 - s->v0)) m->v = s->v0;
  }
  if (f->n) qsort(f->items, f->n, sizeof *f->items, by_t);
  size_t kept = 0;
  for (size_t i = 0; i < f->n; i++) {
    const CagSurfaceMeeting *m = &f->items[i];
    bool inside = true;
    CagStatus status =
        trimmed ? cag_region_contains(region, cag_vec3(m->u, m->v, 0), &inside, err) : CAG_OK;
    if (status) return status;
    bool known = !inside;
    for (size_t k = 0; k < kept && !known; k++) {
      const CagSurfaceMeeting *o = &f->items[k];
      known = cag_norm(cag_sub(m->point, o->point)) <= SAME_POINT * f->size + f->noise &&
              same(m->t, o->t, c->start, c->end, c->closed) &&
              (same(m->u, o->u, s->u0, s->u1, s->closed_u) || at_pole(s, m, false)) &&
              (same(m->v, o->v, s->v0, s->v1, s->closed_v) || at_pole(s, m, true));
    }
    if (!known) f->items[kept++] = *m;
  }
  f->n = kept;
  return CAG_OK;
}

// --- Touches ---

// Sine of the angle of curve and tangent plane below which a meeting may be a touch.
#define SHALLOW 1e-2

// Beyond a seam, too.
static double around(double x, double low, double high, bool closed) {
  if (closed && x < low) x += high - low;
  if (closed && x > high) x -= high - low;
  return within(x, low, high);
}

// The foot on the surface of the curve's point at t, from u, v on: its distance, and the sine of
// the angle of the curve with the tangent plane.
static CagStatus foot(const Search *s, double t, double *u, double *v, double *gap, double *slope,
                      CagError *err) {
  enum { STEPS = 8 };
  CagVec3 p[2], q[4];
  CagStatus status = cag_curve_eval(s->c, t, 1, CAG_SIDE_RIGHT, p, err);
  for (int i = 0; !status && i < STEPS; i++) {
    status = cag_surface_eval(s->s, *u, *v, 1, *u >= s->s->u1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT,
                              *v >= s->s->v1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, q, err);
    if (status) return status;
    const CagVec3 r = cag_sub(p[0], q[0]), du = q[cag_partial(1, 1, 0)],
                  dv = q[cag_partial(1, 0, 1)];
    const double a = cag_dot(du, du), b = cag_dot(du, dv), c = cag_dot(dv, dv), det = a * c - b * b;
    *gap = cag_norm(r);
    *slope = cag_dot(cag_unit(p[1]), cag_unit(cag_cross(du, dv)));
    if (!(det > 0)) break;
    *u = around(*u + (c * cag_dot(du, r) - b * cag_dot(dv, r)) / det, s->s->u0, s->s->u1,
                s->s->closed_u);
    *v = around(*v + (a * cag_dot(dv, r) - b * cag_dot(du, r)) / det, s->s->v0, s->s->v1,
                s->s->closed_v);
  }
  return status;
}

// Brings a touch to where the curve runs along the tangent plane, by the secant method. One that
// then is no meeting stays as it was: it belongs to two crossings near to each other.
static CagStatus settle(const Search *s, CagSurfaceMeeting *m, CagError *err) {
  const double range = s->c->end - s->c->start, reach = 1e-2 * range;
  double u = m->u, v = m->v, gap, slope, t = m->t, before = t + 1e-5 * range, other;
  if (before > s->c->end) before = t - 1e-5 * range;
  CagStatus status = foot(s, before, &u, &v, &gap, &other, err);
  if (!status) status = foot(s, t, &u, &v, &gap, &slope, err);
  for (int i = 0; !status && i < 20 && slope != 0 && slope != other; i++) {
    const double next = within(t - slope * (t - before) / (slope - other),
                               fmax(s->c->start, m->t - reach), fmin(s->c->end, m->t + reach));
    if (next == t) break;
    before = t;
    other = slope;
    t = next;
    status = foot(s, t, &u, &v, &gap, &slope, err);
  }
  if (status || gap > MEET * s->size + s->noise || fabs(slope) > SHALLOW) return status;
  *m = (CagSurfaceMeeting){.t = t, .u = u, .v = v};
  return cag_curve_point(s->c, t, &m->point, err);
}

// Near a touch the curve is within rounding of the surface for a while: such meetings are one.
static CagStatus merge_touches(Search *s, CagError *err) {
  CagStatus status = CAG_OK;
  size_t kept = 0;
  for (size_t i = 0; !status && i < s->n;) {
    CagSurfaceMeeting best = s->items[i];
    double u = best.u, v = best.v, gap, slope, least;
    status = foot(s, best.t, &u, &v, &gap, &least, err);
    size_t next = i + 1;
    while (!status && fabs(least) < SHALLOW && next < s->n) {
      const CagSurfaceMeeting *m = &s->items[next];
      bool on = false;
      const double between = (s->items[next - 1].t + m->t) / 2;
      if (cag_norm(cag_sub(m->point, s->items[next - 1].point)) > COMMON * s->size) break;
      status = is_on(s, between, m->u, m->v, &on, err);
      if (status || !on) break;
      u = m->u;
      v = m->v;
      status = foot(s, m->t, &u, &v, &gap, &slope, err);
      if (!status && fabs(slope) < fabs(least)) least = slope, best = *m;
      next++;
    }
    if (!status && fabs(least) < SHALLOW) status = settle(s, &best, err);
    // Two that settled in one place.
    const bool again =
        kept > 0 && fabs(s->items[kept - 1].t - best.t) <= MEET * (s->c->end - s->c->start);
    if (!again) s->items[kept++] = best;
    i = next;
  }
  if (!status) s->n = kept;
  return status;
}

// --- The whole ---

// Breaks of one direction with both ends; malloc'd.
static CagStatus surface_cuts(const CagSurface *s, int direction, double **out, size_t *n,
                              CagError *err) {
  const size_t inner = s->kind->breaks ? s->kind->breaks(s, direction, NULL, 0) : 0;
  double *cuts = malloc(sizeof(double) * (inner + 2));
  if (!cuts) return cag_fail_memory(err);
  cuts[0] = direction ? s->v0 : s->u0;
  if (inner) s->kind->breaks(s, direction, cuts + 1, inner);
  cuts[inner + 1] = direction ? s->v1 : s->u1;
  *out = cuts;
  *n = inner + 2;
  return CAG_OK;
}

static double between(const double *cuts, size_t k) {
  const size_t i = k / FIRST, part = k % FIRST;
  return part ? cuts[i] + (cuts[i + 1] - cuts[i]) * (double)part / FIRST : cuts[i];
}

static CagStatus search_all(Search *s, const double *tc, size_t nt, const double *uc, size_t nu,
                            const double *vc, size_t nv, CagError *err) {
  const size_t parts = (nt - 1) * FIRST;
  Part *list = malloc(sizeof *list * parts);
  if (!list) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < parts; i++) {
    list[i] = (Part){.a = between(tc, i), .b = between(tc, i + 1)};
    status = make_part(s, &list[i], err);
  }
  for (size_t i = 0; !status && i < (nu - 1) * FIRST; i++)
    for (size_t j = 0; !status && j < (nv - 1) * FIRST; j++) {
      Cell cell = {.u = {between(uc, i), between(uc, i + 1)},
                   .v = {between(vc, j), between(vc, j + 1)}};
      status = make_cell(s, &cell, err);
      for (size_t k = 0; !status && k < parts; k++) status = pair(s, &list[k], &cell, DEPTH, err);
    }
  free(list);
  return status;
}

CagStatus cag_surface_intersect_curve(const CagSurface *surface, const CagCurve *curve,
                                      CagSurfaceMeeting **out, size_t *n, CagError *err) {
  Search s = {.s = surface, .c = curve};
  CagBounds box;
  CagStatus status = cag_surface_bounds(surface, &box, err);
  if (status) return status;
  const CagBounds other = curve->kind->hull(curve, curve->start, curve->end);
  s.size = fmax(cag_norm(cag_sub(box.max, box.min)), cag_norm(cag_sub(other.max, other.min)));
  s.noise = fmax(cag_curve_noise(&box), cag_curve_noise(&other));
  double *tc = NULL, *uc = NULL, *vc = NULL;
  size_t nt, nu, nv;
  status = cag_curve_cuts(curve, &tc, &nt, err);
  if (!status) status = surface_cuts(surface, 0, &uc, &nu, err);
  if (!status) status = surface_cuts(surface, 1, &vc, &nv, err);
  if (!status) status = search_all(&s, tc, nt, uc, nu, vc, nv, err);
  if (!status && s.n > 0) status = check_overlap(&s, err);
  free(tc);
  free(uc);
  free(vc);
  if (!status) status = tidy(&s, err);
  if (!status) status = merge_touches(&s, err);
  if (status) {
    free(s.items);
    return status;
  }
  *out = s.items;
  *n = s.n;
  return CAG_OK;
}
