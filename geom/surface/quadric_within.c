// The part of a sheet of a quadric within half spaces, as a part of its parameter plane.
//
// In units of the semi-axes a plane is a x + b y + c z = d. On a line of constant u it is a
// quadratic equation for v (in v, in e^v, or in the sine and cosine of v), so its roots have a
// closed form. The roots that bound the intervals of v within all half spaces change only at places
// in u at which two roots of a plane coincide, the intersection of two planes meets the quadric, or
// a root passes an end of the domain. All these places have a closed form as well. Between
// neighboring places the intervals are determined at the middle; they are the cells that form the
// outline.

#include "geom/surface/quadric_within.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

// Coefficients below this fraction of the largest are rounding of the frame.
#define ALIGNED 1e-14
// A plane that passes the apex of a sheet within this fraction touches it.
#define TOUCHING 1e-13
// Places closer than this fraction of the domain coincide.
#define SAME_PLACE 1e-11

static bool is_angular(CagQuadricShape s) {
  return s <= CAG_SHAPE_ELLIPTIC_PARABOLOID || s == CAG_SHAPE_ELLIPTIC_CYLINDER;
}

static bool is_cylinder(CagQuadricShape s) { return s >= CAG_SHAPE_ELLIPTIC_CYLINDER; }

CagVec3 cag_quadric_unit_point(CagQuadricShape shape, double u, double v) {
  switch (shape) {
  case CAG_SHAPE_ELLIPSOID: return cag_vec3(cos(u) * sin(v), sin(u) * sin(v), cos(v));
  case CAG_SHAPE_HYPERBOLOID_ONE: return cag_vec3(cos(u) * cosh(v), sin(u) * cosh(v), sinh(v));
  case CAG_SHAPE_HYPERBOLOID_TWO: return cag_vec3(cos(u) * sinh(v), sin(u) * sinh(v), cosh(v));
  case CAG_SHAPE_CONE: return cag_vec3(v * cos(u), v * sin(u), v);
  case CAG_SHAPE_ELLIPTIC_PARABOLOID: return cag_vec3(v * cos(u), v * sin(u), v * v);
  case CAG_SHAPE_HYPERBOLIC_PARABOLOID: return cag_vec3(u, v, u * u - v * v);
  case CAG_SHAPE_ELLIPTIC_CYLINDER: return cag_vec3(cos(u), sin(u), v);
  case CAG_SHAPE_PARABOLIC_CYLINDER: return cag_vec3(u * u, 2 * u, v);
  default: return cag_vec3(cosh(u), sinh(u), v);
  }
}

// --- Roots ---

// The part of a cut that depends on u (for shapes about an axis: the factor of the radius).
static double part_of_u(CagQuadricShape shape, const CagQuadricCut *p, double u) {
  switch (shape) {
  case CAG_SHAPE_HYPERBOLIC_PARABOLOID: return (p->a + p->c * u) * u;
  case CAG_SHAPE_PARABOLIC_CYLINDER: return (p->a * u + 2 * p->b) * u;
  case CAG_SHAPE_HYPERBOLIC_CYLINDER: return p->a * cosh(u) + p->b * sinh(u);
  default: return p->a * cos(u) + p->b * sin(u);
  }
}

// Real roots of a x^2 + 2 b x + c = 0, the one with minus before the square root first; NAN: none.
// rest: b^2 - a c, if a more accurate value is known.
static void quadratic(double a, double b, double c, double rest, double out[2]) {
  out[0] = out[1] = NAN;
  if (!(rest >= 0)) return;
  if (rest == 0 && a != 0) {
    out[0] = out[1] = -b / a;
    return;
  }
  const int large = b < 0; // of the two numerators, the one without cancellation
  const double q = large ? sqrt(rest) - b : -sqrt(rest) - b;
  out[large] = q / a;
  out[1 - large] = c / q;
}

// Angles in -pi/2..3 pi/2, so that 0 and pi are not at its ends.
static double half_turn(double v) {
  while (v < -M_PI / 2) v += 2 * M_PI;
  while (v > 3 * M_PI / 2) v -= 2 * M_PI;
  return v;
}

// Where the two roots coincide: the square of the part of u there (about an axis); NAN: nowhere.
static double fold_square(CagQuadricShape shape, const CagQuadricCut *p) {
  switch (shape) {
  case CAG_SHAPE_ELLIPSOID: return (p->d - p->c) * (p->d + p->c);
  case CAG_SHAPE_HYPERBOLOID_ONE: return p->d * p->d + p->c * p->c;
  case CAG_SHAPE_HYPERBOLOID_TWO: return (p->c - p->d) * (p->c + p->d);
  case CAG_SHAPE_ELLIPTIC_PARABOLOID: return -4 * p->c * p->d;
  default: return NAN;
  }
}

// What is known about the roots at a place: they may exist, they exist (a contrary result is
// rounding), or they coincide.
typedef enum Known { MAY_EXIST, EXIST, FOLDED } Known;

static double known_rest(double rest, Known known) {
  return known == FOLDED ? 0 : known == EXIST ? fmax(rest, 0) : rest;
}

// v at which a cut intersects the line of constant u; NAN: none.
static void roots(CagQuadricShape shape, const CagQuadricCut *p, double u, Known known,
                  double out[2]) {
  const double at = part_of_u(shape, p, u), square = fold_square(shape, p);
  // (at - fold) (at + fold) has no further cancellation than the difference itself.
  double rest = square > 0 ? (at - sqrt(square)) * (at + sqrt(square)) : at * at - square;
  if (shape == CAG_SHAPE_HYPERBOLOID_ONE) rest = -rest; // roots within the folds
  rest = known_rest(rest, known);
  out[0] = out[1] = NAN;
  switch (shape) {
  case CAG_SHAPE_ELLIPSOID: {
    if (!(rest >= 0)) return;
    const double middle = atan2(at, p->c), reach = atan2(sqrt(rest), p->d);
    out[0] = half_turn(middle - reach);
    out[1] = half_turn(middle + reach);
    return;
  }
  case CAG_SHAPE_HYPERBOLOID_ONE:
  case CAG_SHAPE_HYPERBOLOID_TWO:
    quadratic(at + p->c, -p->d, shape == CAG_SHAPE_HYPERBOLOID_ONE ? at - p->c : p->c - at, rest,
              out);
    for (int k = 0; k < 2; k++) out[k] = out[k] > 0 ? log(out[k]) : NAN;
    return;
  case CAG_SHAPE_CONE: out[0] = p->d / (at + p->c); return;
  case CAG_SHAPE_ELLIPTIC_PARABOLOID: quadratic(p->c, at / 2, -p->d, rest / 4, out); return;
  case CAG_SHAPE_HYPERBOLIC_PARABOLOID:
    rest = known_rest(p->b * p->b / 4 - p->c * (p->d - at), known);
    quadratic(p->c, -p->b / 2, p->d - at, rest, out);
    return;
  default:
    if (p->c != 0) out[0] = (p->d - at) / p->c;
  }
}

double cag_quadric_bound_at(const CagQuadricCells *c, const CagQuadricBound *b, double u,
                            bool folded) {
  if (b->side < 0) return b->value;
  double both[2];
  roots(c->sheet->shape, &c->cuts[b->side], u, folded ? FOLDED : EXIST, both);
  return fmin(fmax(both[b->branch], c->sheet->v0), c->sheet->v1);
}

bool cag_quadric_bound_is_straight(const CagQuadricCells *c, const CagQuadricBound *b) {
  if (b->side < 0) return true;
  const CagQuadricCut *p = &c->cuts[b->side];
  return p->a == 0 && (c->sheet->shape == CAG_SHAPE_HYPERBOLIC_PARABOLOID ? p->c : p->b) == 0;
}

// --- Places ---

static void add_place(CagQuadricCells *c, double u, unsigned folds) {
  const CagQuadricSheet *s = c->sheet;
  if (is_angular(s->shape)) u -= 2 * M_PI * floor(u / (2 * M_PI));
  if (u >= s->u0 && u <= s->u1) c->places[c->place_count++] = (CagQuadricPlace){u, folds};
}

// Adds the solutions for a given value of the part of u.
static void add_solutions(CagQuadricCells *c, const CagQuadricCut *p, double value,
                          unsigned folds) {
  double u[2] = {NAN, NAN};
  switch (c->sheet->shape) {
  case CAG_SHAPE_HYPERBOLIC_PARABOLOID:
    quadratic(p->c, p->a / 2, -value, p->a * p->a / 4 + p->c * value, u);
    break;
  case CAG_SHAPE_PARABOLIC_CYLINDER:
    quadratic(p->a, p->b, -value, p->b * p->b + p->a * value, u);
    break;
  case CAG_SHAPE_HYPERBOLIC_CYLINDER:
    quadratic(p->a + p->b, -value, p->a - p->b, value * value - (p->a - p->b) * (p->a + p->b), u);
    for (int k = 0; k < 2; k++) u[k] = u[k] > 0 ? log(u[k]) : NAN;
    break;
  default: {
    const double r = hypot(p->a, p->b), middle = atan2(p->b, p->a);
    if (!(r > 0) || fabs(value) > r * (1 + TOUCHING)) return;
    if (fabs(value) >= r * (1 - TOUCHING)) u[0] = middle + (value < 0 ? M_PI : 0);
    else {
      const double reach = atan2(sqrt((r - value) * (r + value)), value);
      u[0] = middle - reach;
      u[1] = middle + reach;
    }
  }
  }
  for (int k = 0; k < 2; k++) add_place(c, u[k], folds);
}

// Adds the places at which a root begins, ends, or passes the end of the domain or infinity.
static void add_turns(CagQuadricCells *c, size_t side) {
  const CagQuadricCut *p = &c->cuts[side];
  const CagQuadricShape shape = c->sheet->shape;
  const unsigned fold = 1u << side;
  if (is_cylinder(shape)) {
    if (p->c == 0) add_solutions(c, p, p->d, 0);
    return;
  }
  if (shape == CAG_SHAPE_HYPERBOLIC_PARABOLOID) {
    if (p->c != 0) add_solutions(c, p, p->d - p->b * p->b / (4 * p->c), fold);
    else if (p->b == 0) add_solutions(c, p, p->d, 0);
    return;
  }
  const double square = fold_square(shape, p);
  if (square > 0) {
    add_solutions(c, p, sqrt(square), fold);
    add_solutions(c, p, -sqrt(square), fold);
  }
  add_solutions(c, p, 0, 0);
  add_solutions(c, p, p->c, 0);
  add_solutions(c, p, -p->c, 0);
}

static CagVec3 direction(const CagQuadricCut *p) { return cag_vec3(p->a, p->b, p->c); }

// The quadratic terms of the unit form for two vectors.
static double second_degree(CagQuadricShape shape, CagVec3 p, CagVec3 q) {
  static const double SIGN[][3] = {{1, 1, 1},  {1, 1, -1}, {1, 1, -1}, {1, 1, -1}, {1, 1, 0},
                                   {1, -1, 0}, {1, 1, 0},  {0, 1, 0},  {1, -1, 0}};
  return SIGN[shape][0] * p.x * q.x + SIGN[shape][1] * p.y * q.y + SIGN[shape][2] * p.z * q.z;
}

// The remaining terms, linear in p.
static double first_degree(CagQuadricShape shape, CagVec3 p) {
  return shape == CAG_SHAPE_PARABOLIC_CYLINDER ? -4 * p.x
         : shape == CAG_SHAPE_ELLIPTIC_PARABOLOID || shape == CAG_SHAPE_HYPERBOLIC_PARABOLOID ? -p.z
                                                                                              : 0;
}

static double constant_of(CagQuadricShape shape) {
  switch (shape) {
  case CAG_SHAPE_HYPERBOLOID_TWO: return 1;
  case CAG_SHAPE_CONE:
  case CAG_SHAPE_ELLIPTIC_PARABOLOID:
  case CAG_SHAPE_HYPERBOLIC_PARABOLOID:
  case CAG_SHAPE_PARABOLIC_CYLINDER: return 0;
  default: return -1;
  }
}

static void add_place_of(CagQuadricCells *c, CagVec3 p) {
  switch (c->sheet->shape) {
  case CAG_SHAPE_HYPERBOLIC_PARABOLOID: add_place(c, p.x, 0); return;
  case CAG_SHAPE_PARABOLIC_CYLINDER: add_place(c, p.y / 2, 0); return;
  case CAG_SHAPE_HYPERBOLIC_CYLINDER: add_place(c, asinh(p.y), 0); return;
  default:
    add_place(c, atan2(p.y, p.x), 0);
    // On the other nappe of a cone it is half a turn further.
    if (c->sheet->shape == CAG_SHAPE_CONE) add_place(c, atan2(-p.y, -p.x), 0);
  }
}

// Adds the places at which the intersection of two cuts meets the quadric.
static void add_corners(CagQuadricCells *c, const CagQuadricCut *p, const CagQuadricCut *q) {
  const CagQuadricShape shape = c->sheet->shape;
  const CagVec3 m = direction(p), n = direction(q), along = cag_cross(m, n);
  const double square = cag_dot(along, along);
  if (!(square > ALIGNED * ALIGNED * cag_dot(m, m) * cag_dot(n, n))) return;
  const CagVec3 o = cag_scaled(
      cag_add(cag_scaled(cag_cross(n, along), p->d), cag_scaled(cag_cross(along, m), q->d)),
      1 / square);
  const double a = second_degree(shape, along, along);
  const double b = second_degree(shape, o, along) + first_degree(shape, along) / 2;
  const double k = second_degree(shape, o, o) + first_degree(shape, o) + constant_of(shape);
  double rest = b * b - a * k, t[2];
  if (rest < 0 && rest > -TOUCHING * (b * b + fabs(a * k))) rest = 0;
  quadratic(a, b, k, rest, t);
  for (int i = 0; i < 2; i++)
    if (isfinite(t[i])) add_place_of(c, cag_madd(o, t[i], along));
}

static int by_place(const void *a, const void *b) {
  const double x = ((const CagQuadricPlace *)a)->u, y = ((const CagQuadricPlace *)b)->u;
  return (x > y) - (x < y);
}

#define PLACES_MOST (CAG_QUADRIC_SIDES * 14 + CAG_QUADRIC_SIDES * CAG_QUADRIC_SIDES * 4 + 4)

static void find_places(CagQuadricCells *c) {
  const CagQuadricSheet *s = c->sheet;
  c->places[c->place_count++] = (CagQuadricPlace){s->u0, 0};
  c->places[c->place_count++] = (CagQuadricPlace){s->u1, 0};
  for (size_t i = 0; i < c->cut_count; i++) {
    add_turns(c, i);
    for (size_t k = 0; k < i; k++) add_corners(c, &c->cuts[i], &c->cuts[k]);
  }
  qsort(c->places, c->place_count, sizeof *c->places, by_place);
  const double same = SAME_PLACE * (s->u1 - s->u0);
  size_t n = 1;
  for (size_t i = 1; i < c->place_count; i++) {
    CagQuadricPlace *last = &c->places[n - 1];
    if (c->places[i].u - last->u <= same) {
      // A fold is the most accurate of them.
      if (c->places[i].folds && !last->folds && n > 1) last->u = c->places[i].u;
      last->folds |= c->places[i].folds;
    } else c->places[n++] = c->places[i];
  }
  c->place_count = n;
  c->places[n - 1].u = s->u1;
}

// --- Cells ---

typedef struct Root {
  double v;
  CagQuadricBound bound;
} Root;

static int by_value(const void *a, const void *b) {
  const double x = ((const Root *)a)->v, y = ((const Root *)b)->v;
  return (x > y) - (x < y);
}

static bool is_within(const CagQuadricCells *c, double u, double low, double high) {
  double v = isinf(low) && isinf(high) ? 0
             : isinf(low)              ? high - 1 - fabs(high)
             : isinf(high)             ? low + 1 + fabs(low)
                                       : low + (high - low) / 2;
  const CagVec3 p = cag_quadric_unit_point(c->sheet->shape, u, v);
  for (size_t i = 0; i < c->cut_count; i++)
    if (cag_dot(direction(&c->cuts[i]), p) > c->cuts[i].d) return false;
  return true;
}

// The intervals at the middle between two places.
static void find_cells(CagQuadricCells *c, size_t place) {
  const CagQuadricSheet *s = c->sheet;
  const double from = c->places[place].u, to = c->places[place + 1].u;
  const double u = from + (to - from) / 2;
  Root all[2 * CAG_QUADRIC_SIDES + 2];
  size_t n = 0;
  all[n++] = (Root){s->v0, {-1, 0, s->v0}};
  for (size_t i = 0; i < c->cut_count; i++) {
    double both[2];
    roots(s->shape, &c->cuts[i], u, MAY_EXIST, both);
    for (int k = 0; k < 2; k++)
      if (both[k] > s->v0 && both[k] < s->v1) all[n++] = (Root){both[k], {(int)i, k, 0}};
  }
  all[n++] = (Root){s->v1, {-1, 0, s->v1}};
  qsort(all, n, sizeof *all, by_value);
  bool open = false;
  for (size_t i = 0; i + 1 < n; i++) {
    const double slack = TOUCHING * (1 + (isinf(all[i].v) ? 0 : fabs(all[i].v)));
    if (all[i + 1].v - all[i].v <= slack) continue;
    if (!is_within(c, u, all[i].v, all[i + 1].v)) open = false;
    else if (open) c->cells[c->cell_count - 1].high = all[i + 1].bound;
    else {
      c->cells[c->cell_count++] = (CagQuadricCell){place, all[i].bound, all[i + 1].bound};
      open = true;
    }
  }
}

// Starts the turn after a place without cells, if there is one, so that no piece is cut at 0.
static void begin_turn(CagQuadricCells *c) {
  const size_t last = c->place_count - 1;
  size_t begin = 0;
  for (size_t i = 0, at = 0; i < last; i++) {
    while (at < c->cell_count && c->cells[at].place < i) at++;
    if (at < c->cell_count && c->cells[at].place == i) continue;
    begin = i + 1;
    break;
  }
  if (begin == 0 || begin == last) return;
  // Place 0 and the last one coincide.
  CagQuadricPlace turned[PLACES_MOST];
  c->places[0].folds |= c->places[last].folds;
  for (size_t i = 0; i < last; i++) {
    const size_t from = (begin + i) % last;
    turned[i] = c->places[from];
    turned[i].u += begin + i >= last ? 2 * M_PI : 0;
  }
  turned[last] = turned[0];
  turned[last].u += 2 * M_PI;
  for (size_t i = 0; i <= last; i++) c->places[i] = turned[i];
  for (size_t i = 0; i < c->cell_count; i++)
    c->cells[i].place = (c->cells[i].place + last - begin) % last;
}

static void set_cut(const CagQuadricSheet *s, const CagQuadricSide *side, CagQuadricCut *out) {
  double k[4] = {0};
  const double n[3] = {side->n.x, side->n.y, side->n.z};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++) k[j] += n[i] * s->frame.m[i][j];
  k[3] -= side->d;
  // Removes coordinates and distances from the origin that are only rounding of the frame.
  for (int j = 0; j < 4; j++) {
    double terms = j < 3 ? 0 : side->d * side->d;
    for (int i = 0; i < 3; i++) terms += s->frame.m[i][j] * s->frame.m[i][j];
    if (fabs(k[j]) <= ALIGNED * sqrt(terms)) k[j] = 0;
  }
  *out = (CagQuadricCut){k[0], k[1], k[2], -k[3]};
  const double size = cag_norm(direction(out));
  if (!(size > 0)) return;
  *out = (CagQuadricCut){out->a / size, out->b / size, out->c / size, out->d / size};
}

CagStatus cag_quadric_sheet_within(const CagQuadricSheet *sheet, const CagQuadricSide *sides,
                                   size_t side_count, CagSurface **list, size_t most, size_t *n,
                                   CagError *err) {
  CagQuadricPlace places[PLACES_MOST];
  CagQuadricCells c = {.sheet = sheet, .places = places, .cut_count = side_count};
  for (size_t i = 0; i < side_count; i++) set_cut(sheet, &sides[i], &c.cuts[i]);
  find_places(&c);
  // An interval has a root at one end at least, or is the whole line.
  c.cells = cag_malloc(c.place_count * (CAG_QUADRIC_SIDES + 2) * sizeof *c.cells);
  if (!c.cells) return cag_fail_memory(err);
  for (size_t i = 0; i + 1 < c.place_count; i++) find_cells(&c, i);
  if (is_angular(sheet->shape)) begin_turn(&c);
  CagStatus status = c.cell_count > 0 ? cag_quadric_outline(&c, list, most, n, err) : CAG_OK;
  cag_free(c.cells);
  return status;
}
