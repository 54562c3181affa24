// Intersections of a curve with a surface, by subdivision of both.
//
// A part of the curve lies within its sag of its chord; a cell of the surface lies within its bow
// of the plane through the middle of its corners. Pairs separated by these bounds are dropped. If
// the chord crosses the plane steeply enough for a single crossing, Newton's method finishes the
// pair. Other pairs, including those on which it fails, are halved on the side that is bent more:
// only the bounds can exclude an intersection. Pairs that remain at the smallest size belong to
// tangencies, each of which is found many times (geom/curve/contact.h).

#include "geom/meet/meet_curve.h"
#include "geom/surface/trimmed.h"

#include <float.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/contact.h"
#include "geom/curve/family.h"
#include "geom/linalg/tolerance.h"

// Fractions of the size of the data: tolerance for identical points, for flatness, and for
// identical intersections at a pole.
#define MEET CAG_COINCIDENT
#define FLAT 1e-10
#define SAME_POINT 1e-7
// Fraction of a domain within which parameters are identical.
#define SAME_PLACE 1e-4
// Number of pairs after which the curve is assumed to lie in the surface.
#define MOST_PAIRS 400000
#define DEPTH 100
// A common part longer than this fraction of the size is an overlap.
#define COMMON 1e-3
// Search range for a tangency around a pair, in multiples of its width.
#define TOUCH_REACH 128
// When this many intersections have been found, they are checked for an overlap, and again whenever
// the number doubles.
#define FOUND_MANY 256
// Initial number of cells of a smooth patch in each direction, and of parts of a smooth piece.
#define FIRST 4

typedef struct Part {
  double a, b, sag;
  double low, high; // of its smooth interval
  CagVec3 p, q;
} Part;

typedef struct Cell {
  double u[2], v[2], bow;
  double low[2], high[2];  // of its smooth patch
  double along_u, along_v; // the longer of two opposite edges
  CagVec3 middle, normal;  // of the plane; normal: unit
  CagBounds box, corners;  // of the cell; of its corners
} Cell;

typedef struct Search {
  const CagSurface *s;
  const CagCurve *c;
  double size, noise;
  size_t pairs;
  CagContact *items;
  size_t n, capacity;
  CagContactTask task;
} Search;

static CagStatus fail_overlap(CagError *err) {
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_overlap, "", -1,
                  "the curve lies in the surface: they share more than isolated points");
}

// --- Parts and cells ---

static CagStatus make_part(const Search *s, Part *part, CagError *err) {
  CagStatus status = cag_curve_eval(s->c, part->a, 0, CAG_SIDE_RIGHT, &part->p, err);
  if (!status) status = cag_curve_eval(s->c, part->b, 0, CAG_SIDE_LEFT, &part->q, err);
  if (!status) part->sag = cag_curve_sag(s->c, part->a, part->b);
  return status;
}

// The bow is the largest distance of samples from the plane, plus half.
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
  cell->corners = cell->box;
  // Between the samples of a SIDE x SIDE grid the surface may also leave their box by its bend.
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

// The Gauss-Newton step; damped if directions are dependent.
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

// --- Intersections ---

static double within(double x, double low, double high) { return fmin(high, fmax(low, x)); }

static CagStatus merge(Search *s, CagError *err) {
  bool overlap;
  CagStatus status = cag_contacts_merge(&s->task, s->items, &s->n, &overlap, err);
  return status ? status : overlap ? fail_overlap(err) : CAG_OK;
}

static CagStatus add(Search *s, CagContact m, CagError *err) {
  if (!CAG_RESERVE(s->items, s->capacity, s->n + 1)) return cag_fail_memory(err);
  s->items[s->n++] = m;
  return s->n >= FOUND_MANY && (s->n & (s->n - 1)) == 0 ? merge(s, err) : CAG_OK;
}

static bool lies_in(double x, double low, double high) {
  const double slack = 1e-9 * (high - low);
  return x >= low - slack && x <= high + slack;
}

// Searches within `reach` widths of part and cell around them, and within their smooth interval and
// patch. *inside: the intersection is in the part and the cell, not in neighboring ones.
static CagStatus meet(Search *s, const Part *part, const Cell *cell, double reach, bool *met,
                      bool *inside, CagError *err) {
  const double width_t = part->b - part->a, width_u = cell->u[1] - cell->u[0],
               width_v = cell->v[1] - cell->v[0];
  const double reach_t = reach * width_t, reach_u = reach * width_u, reach_v = reach * width_v;
  double t = part->a + width_t / 2, u = cell->u[0] + width_u / 2, v = cell->v[0] + width_v / 2;
  double best = INFINITY;
  CagContact found = {0};
  for (int i = 0; i < 80; i++) {
    CagVec3 p[2], q[4];
    CagStatus status =
        cag_curve_eval(s->c, t, 1, t >= part->high ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, p, err);
    if (!status)
      status = cag_surface_eval(s->s, u, v, 1, u >= cell->high[0] ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT,
                                v >= cell->high[1] ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, q, err);
    if (status) return status;
    const CagVec3 r = cag_sub(p[0], q[0]);
    const double distance = cag_norm(r);
    if (distance < best) {
      best = distance;
      found = (CagContact){t, {u, v}, p[0], 1};
    }
    const CagVec3 columns[3] = {p[1], cag_scaled(q[cag_partial(1, 1, 0)], -1),
                                cag_scaled(q[cag_partial(1, 0, 1)], -1)};
    double step[3];
    if (!step_to(columns, r, step)) break;
    const double next_t = within(t + step[0], fmax(part->low, part->a - reach_t),
                                 fmin(part->high, part->b + reach_t));
    const double next_u = within(u + step[1], fmax(cell->low[0], cell->u[0] - reach_u),
                                 fmin(cell->high[0], cell->u[1] + reach_u));
    const double next_v = within(v + step[2], fmax(cell->low[1], cell->v[0] - reach_v),
                                 fmin(cell->high[1], cell->v[1] + reach_v));
    if (next_t == t && next_u == u && next_v == v) break;
    t = next_t;
    u = next_u;
    v = next_v;
  }
  *met = best <= MEET * s->size + s->noise;
  *inside = *met && lies_in(found.t, part->a, part->b) &&
            lies_in(found.at[0], cell->u[0], cell->u[1]) &&
            lies_in(found.at[1], cell->v[0], cell->v[1]);
  return *met ? add(s, found, err) : CAG_OK;
}

// --- Subdivision ---

static CagStatus halve_part(const Search *s, const Part *part, Part out[2], CagError *err) {
  const double m = part->a + (part->b - part->a) / 2;
  out[0] = out[1] = *part;
  out[0].b = out[1].a = m;
  CagStatus status = make_part(s, &out[0], err);
  return status ? status : make_part(s, &out[1], err);
}

// Halves the longer side of the cell.
static CagStatus halve_cell(const Search *s, const Cell *cell, Cell out[2], CagError *err) {
  out[0] = out[1] = *cell;
  if (cell->along_u >= cell->along_v)
    out[0].u[1] = out[1].u[0] = cell->u[0] + (cell->u[1] - cell->u[0]) / 2;
  else out[0].v[1] = out[1].v[0] = cell->v[0] + (cell->v[1] - cell->v[0]) / 2;
  CagStatus status = make_cell(s, &out[0], err);
  return status ? status : make_cell(s, &out[1], err);
}

// A chord along a flat cell: an overlap if its middle is in the cell, else at most a tangency.
static CagStatus along(Search *s, const Part *part, const Cell *cell, CagError *err) {
  Search looks = *s; // its results are discarded
  looks.items = NULL;
  looks.n = looks.capacity = 0;
  Part middle = *part;
  CagStatus status = CAG_OK;
  bool met = true, inside;
  for (int i = 1; !status && met && i < 4; i++) {
    const double t = part->a + (part->b - part->a) * i / 4;
    middle.a = middle.b = t;
    status = meet(&looks, &middle, cell, 1, &met, &inside, err);
  }
  cag_free(looks.items);
  if (status) return status;
  if (met) return fail_overlap(err);
  return meet(s, part, cell, TOUCH_REACH, &met, &inside, err);
}

// Whether a chord crosses the plane of a flat cell outside of the cell.
static bool passes_beside(const Search *s, const Part *part, const Cell *cell) {
  const double h = cag_dot(cag_sub(part->p, cell->middle), cell->normal);
  const double k = cag_dot(cag_sub(part->q, cell->middle), cell->normal);
  const CagVec3 x = cag_lerp(part->p, part->q, fmin(1, fmax(0, h / (h - k))));
  // How far along the chord the bends of both may move the intersection.
  const double slack =
      2 * MEET * s->size * cag_norm(cag_sub(part->q, part->p)) / fmax(fabs(h - k), DBL_MIN);
  const CagBounds *b = &cell->corners;
  return outside(x.x, x.x, b->min.x, b->max.x, slack) ||
         outside(x.y, x.y, b->min.y, b->max.y, slack) ||
         outside(x.z, x.z, b->min.z, b->max.z, slack);
}

static CagStatus pair(Search *s, const Part *part, const Cell *cell, int depth, CagError *err) {
  // Ratio of the chord's slope to the bends of both above which there is only one crossing.
  const double steep = 8;
  if (apart(s, part, cell)) return CAG_OK;
  if (++s->pairs > MOST_PAIRS) return fail_overlap(err);
  if (cag_stop_check(err)) return err->status;
  const CagVec3 d = cag_sub(part->q, part->p);
  const double chord = cag_norm(d), rise = fabs(cag_dot(d, cell->normal)),
               width = fmin(cell->along_u, cell->along_v);
  const bool one = rise > MEET * chord && chord < steep * width &&
                   rise > steep * (part->sag + cell->bow * chord / width);
  const double flat = FLAT * s->size + s->noise;
  const bool flats = part->sag <= flat && cell->bow <= flat;
  bool met = false, inside = false;
  CagStatus status = one ? meet(s, part, cell, 1, &met, &inside, err) : CAG_OK;
  if (status || inside || (met && flats)) return status;
  // Both flat and parallel: a tangency, whose crossings Newton's method finds from all pairs around
  // it, or a common part.
  if (flats && rise <= MEET * s->size && chord > COMMON * s->size) return along(s, part, cell, err);
  // The parametrization is too uneven for Newton's method: continue until chord and cell are
  // points.
  const bool uneven = flats && rise > flat;
  if (depth == 0 || (flats && !uneven)) return meet(s, part, cell, TOUCH_REACH, &met, &inside, err);
  if (flats && !one) status = meet(s, part, cell, TOUCH_REACH, &met, &inside, err);
  if (status || (flats && (met || passes_beside(s, part, cell)))) return status;
  const bool part_first = flats ? chord >= fmax(cell->along_u, cell->along_v)
                                : part->sag > cell->bow || chord > steep * width / 2;
  if (part_first) {
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

// --- Results ---

static bool same(double a, double b, double low, double high, bool closed) {
  const double gap = fabs(a - b), range = high - low;
  return gap <= SAME_PLACE * range || (closed && gap >= (1 - SAME_PLACE) * range);
}

static bool at_pole(const CagSurface *s, const CagContact *m, bool of_u) {
  if (of_u)
    return (s->pole_u0 && same(m->at[0], s->u0, s->u0, s->u1, false)) ||
           (s->pole_u1 && same(m->at[0], s->u1, s->u0, s->u1, false));
  return (s->pole_v0 && same(m->at[1], s->v0, s->v0, s->v1, false)) ||
         (s->pole_v1 && same(m->at[1], s->v1, s->v0, s->v1, false));
}

// Drops duplicates at a pole, where one parameter is arbitrary, and points outside of a trimmed
// surface.
static CagStatus tidy(Search *f, CagError *err) {
  const CagSurface *s = f->s;
  const CagCurve *c = f->c;
  const CagRegion *region;
  CagTransform frame;
  const bool trimmed =
      cag_surface_planar_view(s, &region, &frame) || cag_surface_trimmed_view(s, NULL, &region);
  size_t kept = 0;
  for (size_t i = 0; i < f->n; i++) {
    const CagContact *m = &f->items[i];
    bool inside = true;
    const CagVec3 p = cag_vec3(m->at[0], m->at[1], 0);
    CagStatus status = trimmed ? cag_region_contains(region, p, &inside, err) : CAG_OK;
    if (status) return status;
    bool known = !inside;
    for (size_t k = 0; k < kept && !known; k++) {
      const CagContact *o = &f->items[k];
      known = cag_norm(cag_sub(m->point, o->point)) <= SAME_POINT * f->size + f->noise &&
              same(m->t, o->t, c->start, c->end, c->closed) &&
              (at_pole(s, m, false) || at_pole(s, m, true));
    }
    if (!known) f->items[kept++] = *m;
  }
  f->n = kept;
  return CAG_OK;
}

// --- Foot points ---

// Wraps around a seam.
static double around(double x, double low, double high, bool closed) {
  if (closed && x < low) x += high - low;
  if (closed && x > high) x -= high - low;
  return within(x, low, high);
}

// The foot point on the surface of the curve's point at t, starting from u, v: its distance, and
// the sine of the angle of the curve with the tangent plane.
static CagStatus foot(void *context, double t, double at[2], double *gap, double *sine,
                      CagError *err) {
  enum { STEPS = 12 };
  const Search *s = context;
  double *u = &at[0], *v = &at[1];
  CagVec3 p[2], q[4];
  CagStatus status =
      cag_curve_eval(s->c, t, 1, t >= s->c->end ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, p, err);
  for (int i = 0; !status && i < STEPS; i++) {
    status = cag_surface_eval(s->s, *u, *v, 1, *u >= s->s->u1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT,
                              *v >= s->s->v1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, q, err);
    if (status) return status;
    const CagVec3 r = cag_sub(p[0], q[0]), du = q[cag_partial(1, 1, 0)],
                  dv = q[cag_partial(1, 0, 1)];
    const double a = cag_dot(du, du), b = cag_dot(du, dv), c = cag_dot(dv, dv), det = a * c - b * b;
    *gap = cag_norm(r);
    *sine = fabs(cag_dot(cag_unit(p[1]), cag_unit(cag_cross(du, dv))));
    if (!(det > 0) || i + 1 == STEPS) break;
    *u = around(*u + (c * cag_dot(du, r) - b * cag_dot(dv, r)) / det, s->s->u0, s->s->u1,
                s->s->closed_u);
    *v = around(*v + (a * cag_dot(dv, r) - b * cag_dot(du, r)) / det, s->s->v0, s->s->v1,
                s->s->closed_v);
  }
  return status;
}

// --- Complete search ---

static CagStatus search_all(Search *s, const double *tc, size_t nt, const double *uc, size_t nu,
                            const double *vc, size_t nv, CagError *err) {
  const size_t parts = (nt - 1) * FIRST;
  Part *list = cag_malloc(sizeof *list * parts);
  if (!list) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < parts; i++) {
    list[i] = (Part){.a = cag_cut_part(tc, i, FIRST), .b = cag_cut_part(tc, i + 1, FIRST)};
    list[i].low = tc[i / FIRST];
    list[i].high = tc[i / FIRST + 1];
    status = make_part(s, &list[i], err);
  }
  for (size_t i = 0; !status && i < nu * FIRST; i++)
    for (size_t j = 0; !status && j < nv * FIRST; j++) {
      Cell cell = {.u = {cag_cut_part(uc, i, FIRST), cag_cut_part(uc, i + 1, FIRST)},
                   .v = {cag_cut_part(vc, j, FIRST), cag_cut_part(vc, j + 1, FIRST)},
                   .low = {uc[i / FIRST], vc[j / FIRST]},
                   .high = {uc[i / FIRST + 1], vc[j / FIRST + 1]}};
      status = make_cell(s, &cell, err);
      for (size_t k = 0; !status && k < parts; k++) status = pair(s, &list[k], &cell, DEPTH, err);
    }
  cag_free(list);
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
  s.task = (CagContactTask){.c = curve,
                            .context = &s,
                            .measure = foot,
                            .places = 2,
                            .low = {surface->u0, surface->v0},
                            .high = {surface->u1, surface->v1},
                            .closed = {surface->closed_u, surface->closed_v},
                            .same = MEET * s.size + s.noise,
                            .size = s.size,
                            .noise = s.noise};
  double *tc = NULL, *uc = NULL, *vc = NULL;
  size_t nt, nu, nv;
  status = cag_curve_cuts(curve, &tc, &nt, err);
  if (!status) status = cag_surface_cuts(surface, 0, &uc, &nu, err);
  if (!status) status = cag_surface_cuts(surface, 1, &vc, &nv, err);
  if (!status) status = search_all(&s, tc, nt, uc, nu, vc, nv, err);
  cag_free(tc);
  cag_free(uc);
  cag_free(vc);
  if (!status) status = merge(&s, err);
  if (!status) status = tidy(&s, err);
  CagSurfaceMeeting *items = NULL;
  if (!status && s.n) {
    items = cag_malloc(s.n * sizeof *items);
    if (!items) status = cag_fail_memory(err);
  }
  for (size_t i = 0; !status && i < s.n; i++) {
    const CagContact *m = &s.items[i];
    items[i] = (CagSurfaceMeeting){m->t, m->at[0], m->at[1], m->point, m->multiplicity};
  }
  cag_free(s.items);
  if (status) return status;
  *out = items;
  *n = s.n;
  return CAG_OK;
}
