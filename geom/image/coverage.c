// Coverage of pixels by a region.
//
// Everything is in units of the grid: its lines are x = 0 .. width and y = 0 .. height, y up. A
// point is inside if the boundary left of it goes down more often than up, because outer loops are
// counter-clockwise. So a piece of boundary from p to q within the cell of column c adds
//
//     -(q.y - p.y)                       to all pixels right of column c, in its row,
//     -(integral of (c + 1 - x) dy)      to its own pixel.
//
// Row by row, the image first holds the differences of neighboring pixels, and their sums at the
// end. Pieces right of, above, and below the grid add nothing.
//
// Pieces must cross each line at most once, so curves are first cut into parts on which x and y are
// monotone. Where a cut deviates from the exact one by rounding, area moves from a pixel to its
// neighbor, but none is lost.

#include "geom/image/coverage.h"

#include <math.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/basis/interval.h"
#include "geom/curve/family.h"
#include "geom/curve/range.h"

// A coordinate that changes by less than this, in pixels or relative to its size, is constant.
#define STILL 1e-13
// Maximum depth of halvings: a parameter has no more bits.
#define DEEPEST 50
// The number of samples that show that a part is monotone, if the kind of curve has no bounds of
// its derivatives, and the number of halvings before they are trusted.
#define SAMPLES 8
#define TRUSTED_DEPTH 3
// Coverages this close to 0 or 1 are 0 or 1.
#define WHOLE 1e-13
// The most halvings of a piece for its area, and the accepted difference in pixels.
#define AREA_DEPTH 12
#define AREA_CLOSE 1e-15
// Steps of root finding: enough for bisection alone.
#define ROOT_STEPS 120

// A point of the boundary at parameter t.
typedef struct Spot {
  double t, x, y;
} Spot;

typedef struct Tracer {
  const CagGrid *grid;
  CagPixelRule rule;
  CagRaster *image;
  const CagCurve *curve; // NULL: the segment from p to q, over 0..1
  Spot p, q;
  Spot last; // where the previous part of the loop ended
  CagError *err;
} Tracer;

static Spot spot_of(const Tracer *tr, double t, CagVec3 at) {
  const CagGrid *g = tr->grid;
  return (Spot){t, (at.x - g->x) / g->pixel, (at.y - g->y) / g->pixel};
}

static CagStatus spot_at(const Tracer *tr, double t, Spot *out) {
  if (!tr->curve) {
    *out = (Spot){t, tr->p.x + t * (tr->q.x - tr->p.x), tr->p.y + t * (tr->q.y - tr->p.y)};
    return CAG_OK;
  }
  CagVec3 at;
  CagStatus status = cag_curve_eval(tr->curve, t, 0, CAG_SIDE_RIGHT, &at, tr->err);
  if (!status) *out = spot_of(tr, t, at);
  return status;
}

// Adds to the difference at a column, and so to all pixels from there on in the row.
static void add_from(const Tracer *tr, long column, long row, double amount) {
  const CagRaster *r = tr->image;
  if (row < 0 || row >= (long)r->height || column >= (long)r->width) return;
  *cag_raster_at(r, 0, column < 0 ? 0 : (size_t)column, r->height - 1 - (size_t)row) += amount;
}

// --- Areas of pieces ---

// Gauss-Legendre quadrature with 8 points: the positive nodes of -1..1, and their weights.
static const double NODES[4] = {0.18343464249564980494, 0.52553240991632898582,
                                0.79666647741362673959, 0.96028985649753623168};
static const double WEIGHTS[4] = {0.36268378337836198297, 0.31370664587788728734,
                                  0.22238103445337447054, 0.10122853629037625915};

// The integral of (x - left) dy over the parameters a..b.
static CagStatus gauss(const Tracer *tr, double left, double a, double b, double *out) {
  const double middle = a + (b - a) / 2, half = (b - a) / 2;
  *out = 0;
  for (int i = 0; i < 8; i++) {
    const double node = i < 4 ? NODES[i] : -NODES[i - 4], weight = WEIGHTS[i % 4];
    CagVec3 d[2];
    const double t = middle + half * node;
    CagStatus status = cag_curve_eval(tr->curve, t, 1, CAG_SIDE_RIGHT, d, tr->err);
    if (status) return status;
    *out += weight * half * (spot_of(tr, t, d[0]).x - left) * (d[1].y / tr->grid->pixel);
  }
  return CAG_OK;
}

static CagStatus refine_area(const Tracer *tr, double left, double a, double b, double whole,
                             int depth, double *out) {
  const double middle = a + (b - a) / 2;
  double first, second;
  CagStatus status = gauss(tr, left, a, middle, &first);
  if (!status) status = gauss(tr, left, middle, b, &second);
  if (status) return status;
  *out = first + second;
  if (depth == 0 || fabs(*out - whole) <= AREA_CLOSE || !(a < middle && middle < b)) return CAG_OK;
  double low, high;
  status = refine_area(tr, left, a, middle, first, depth - 1, &low);
  if (!status) status = refine_area(tr, left, middle, b, second, depth - 1, &high);
  if (!status) *out = low + high;
  return status;
}

// The integral of (x - left) dy from p to q.
static CagStatus area_left_of(const Tracer *tr, double left, Spot p, Spot q, double *out) {
  if (!tr->curve) {
    *out = ((p.x - left) + (q.x - left)) / 2 * (q.y - p.y);
    return CAG_OK;
  }
  double whole;
  CagStatus status = gauss(tr, left, p.t, q.t, &whole);
  return status ? status : refine_area(tr, left, p.t, q.t, whole, AREA_DEPTH, out);
}

// Adds a piece that lies in one cell of the grid, or left of it.
static CagStatus add_piece(const Tracer *tr, long column, long row, Spot p, Spot q) {
  const double rise = q.y - p.y;
  double inside = 0;
  if (rise == 0 || row < 0 || row >= (long)tr->grid->height || column >= (long)tr->grid->width)
    return CAG_OK;
  CagStatus status = column < 0 ? CAG_OK : area_left_of(tr, (double)column, p, q, &inside);
  if (status) return status;
  add_from(tr, column, row, inside - rise);
  add_from(tr, column + 1, row, -inside);
  return CAG_OK;
}

// --- Crossings with the lines of the grid ---

static double coordinate(Spot s, bool vertical) { return vertical ? s.y : s.x; }

// Finds the point between a and b where a coordinate is `line`, by false position (the Illinois
// variant), with bisection after slow steps. The coordinate is monotone.
static CagStatus find_crossing(const Tracer *tr, Spot a, Spot b, bool vertical, double line,
                               Spot *out) {
  double low = coordinate(a, vertical) - line, high = coordinate(b, vertical) - line;
  const double slack = 4 * 2.2e-16 * (1 + fabs(line)); // the rounding of a coordinate
  double from = a.t, to = b.t;
  int kept = 0;
  *out = fabs(low) < fabs(high) ? a : b;
  for (int i = 0; i < ROOT_STEPS; i++) {
    double t = i % 4 == 3 ? from + (to - from) / 2 : from + (to - from) * (low / (low - high));
    if (!(from < t && t < to)) t = from + (to - from) / 2;
    if (!(from < t && t < to)) return CAG_OK;
    CagStatus status = spot_at(tr, t, out);
    if (status) return status;
    const double at = coordinate(*out, vertical) - line;
    if (fabs(at) <= slack) return CAG_OK;
    if ((at < 0) == (low < 0)) {
      from = t, low = at;
      if (kept == 1) high /= 2;
      kept = 1;
    } else {
      to = t, high = at;
      if (kept == -1) low /= 2;
      kept = -1;
    }
  }
  return CAG_OK;
}

// The lines of one direction that a monotone piece still has to cross, and the cell that it is in:
// -1 before the first line, `count` after the last.
typedef struct Lines {
  bool vertical; // lines y = constant, which are crossed vertically
  long next, last, step, cell;
  bool done;
  Spot crossing; // with the next line
} Lines;

static long clamped(double x, long count) {
  return x < -1 ? -1 : x > (double)count ? count : (long)x;
}

static Lines lines_between(double from, double to, size_t count, bool vertical) {
  const long n = (long)count;
  Lines l = {.vertical = vertical, .step = from <= to ? 1 : -1};
  if (from <= to) {
    l.cell = clamped(floor(from), n);
    l.next = clamped(floor(from) + 1, n + 1);
    if (l.next < 0) l.next = 0;
    l.last = clamped(ceil(to) - 1, n);
    l.done = l.next > l.last;
  } else {
    l.cell = clamped(ceil(from) - 1, n);
    l.next = clamped(ceil(from) - 1, n);
    l.last = clamped(floor(to) + 1, n + 1);
    if (l.last < 0) l.last = 0;
    l.done = l.next < l.last;
  }
  return l;
}

static CagStatus find_next(const Tracer *tr, Lines *l, Spot at, Spot end) {
  return l->done ? CAG_OK : find_crossing(tr, at, end, l->vertical, (double)l->next, &l->crossing);
}

// Moves to the next line, and returns the point on it.
static Spot cross_line(Lines *l) {
  Spot s = l->crossing;
  if (l->vertical) s.y = (double)l->next;
  else s.x = (double)l->next;
  l->cell = l->step > 0 ? l->next : l->next - 1;
  l->done = l->next == l->last;
  l->next += l->step;
  return s;
}

// Keeps the other coordinate of a crossing within the cell.
static double within_cell(const Lines *l, double x) {
  const double low = (double)l->cell;
  return l->cell < 0 ? fmin(x, 0) : fmin(fmax(x, low), low + 1);
}

// Adds a piece on which x and y are monotone.
static CagStatus trace_area(const Tracer *tr, Spot p, Spot q) {
  Lines across = lines_between(p.x, q.x, tr->grid->width, false);
  Lines up = lines_between(p.y, q.y, tr->grid->height, true);
  CagStatus status = find_next(tr, &across, p, q);
  if (!status) status = find_next(tr, &up, p, q);
  while (!status && !(across.done && up.done)) {
    const bool vertical = across.done || (!up.done && up.crossing.t < across.crossing.t);
    Lines *l = vertical ? &up : &across;
    const long column = across.cell, row = up.cell;
    Spot s = cross_line(l);
    if (vertical) s.x = within_cell(&across, s.x);
    else s.y = within_cell(&up, s.y);
    status = add_piece(tr, column, row, p, s);
    if (!status) status = find_next(tr, l, s, q);
    if (!status) status = cag_stop_check(tr->err);
    p = s;
  }
  return status ? status : add_piece(tr, across.cell, up.cell, p, q);
}

// Adds the crossings of a piece on which y is monotone with the rows of centers. The lower end of
// the piece belongs to it, the upper one does not.
static CagStatus trace_centers(const Tracer *tr, Spot p, Spot q) {
  const bool rises = p.y < q.y;
  const double low = fmin(p.y, q.y), high = fmax(p.y, q.y), n = (double)tr->grid->height;
  const double first = fmax(ceil(low - 0.5), 0), end = fmin(ceil(high - 0.5), n);
  CagStatus status = CAG_OK;
  for (double row = first; !status && row < end; row++) {
    Spot s;
    status = find_crossing(tr, p, q, true, row + 0.5, &s);
    if (status) break;
    add_from(tr, clamped(ceil(s.x - 0.5), (long)tr->grid->width), (long)row, rises ? -1 : 1);
    status = cag_stop_check(tr->err);
  }
  return status;
}

// --- Monotone parts ---

static bool is_still(double low, double high) {
  return high - low <= STILL * fmax(1, fmax(fabs(low), fabs(high)));
}

// Whether samples of the derivative, for kinds of curves without bounds of it, have one sign.
static bool seems_monotone(const CagCurve *c, double a, double b, bool *x, bool *y) {
  int signs[2][2] = {{0, 0}, {0, 0}};
  for (int i = 0; i <= SAMPLES; i++) {
    CagVec3 d[2];
    CagError ignored;
    const double t = i == SAMPLES ? b : a + (b - a) * i / SAMPLES;
    if (cag_curve_eval(c, t, 1, i == SAMPLES ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, d, &ignored))
      return false;
    signs[0][d[1].x > 0] += d[1].x != 0;
    signs[1][d[1].y > 0] += d[1].y != 0;
  }
  *x = !signs[0][0] || !signs[0][1];
  *y = !signs[1][0] || !signs[1][1];
  return true;
}

static bool is_monotone(const Tracer *tr, double a, double b, const CagBounds *box, int depth) {
  CagInterval3 d[2];
  bool x = false, y = false;
  if (cag_curve_ranges(tr->curve, a, b, 1, d)) {
    x = d[1].x.lo >= 0 || d[1].x.hi <= 0;
    y = d[1].y.lo >= 0 || d[1].y.hi <= 0;
  } else if (depth >= TRUSTED_DEPTH) {
    seems_monotone(tr->curve, a, b, &x, &y);
  }
  x = x || tr->rule == CAG_PIXEL_CENTER || is_still(box->min.x, box->max.x);
  return x && (y || is_still(box->min.y, box->max.y));
}

// The box of a part in units of the grid.
static CagBounds grid_box(const Tracer *tr, double a, double b) {
  const CagBounds hull = tr->curve->kind->hull(tr->curve, a, b);
  const Spot low = spot_of(tr, a, hull.min), high = spot_of(tr, b, hull.max);
  return (CagBounds){cag_vec3(low.x, low.y, 0), cag_vec3(high.x, high.y, 0)};
}

// Adds the smooth part of the curve from p to q.
static CagStatus trace_smooth(const Tracer *tr, Spot p, Spot q, int depth) {
  const double w = (double)tr->grid->width, h = (double)tr->grid->height;
  const CagBounds box = grid_box(tr, p.t, q.t);
  if (box.min.x > w || box.min.y > h || box.max.y < 0) return CAG_OK;
  const double middle = p.t + (q.t - p.t) / 2;
  const bool whole = depth == DEEPEST || !(p.t < middle && middle < q.t);
  if (whole || is_monotone(tr, p.t, q.t, &box, depth))
    return tr->rule == CAG_PIXEL_CENTER ? trace_centers(tr, p, q) : trace_area(tr, p, q);
  Spot m;
  CagStatus status = cag_stop_check(tr->err);
  if (!status) status = spot_at(tr, middle, &m);
  if (!status) status = trace_smooth(tr, p, m, depth + 1);
  return status ? status : trace_smooth(tr, m, q, depth + 1);
}

static CagStatus trace_segment(Tracer *tr, Spot p, Spot q) {
  tr->curve = NULL;
  tr->p = (Spot){0, p.x, p.y};
  tr->last = tr->q = (Spot){1, q.x, q.y};
  const double w = (double)tr->grid->width, h = (double)tr->grid->height;
  if (fmin(p.x, q.x) > w || fmin(p.y, q.y) > h || fmax(p.y, q.y) < 0) return CAG_OK;
  return tr->rule == CAG_PIXEL_CENTER ? trace_centers(tr, tr->p, tr->q)
                                      : trace_area(tr, tr->p, tr->q);
}

// Adds the part of a curve over [a, b], between breaks; composite curves by their pieces. A gap
// after the previous part, due to rounding, is closed, because it would add to a whole row.
static CagStatus trace_part(Tracer *tr, const CagCurve *c, double a, double b) {
  double rate;
  const CagCurve *piece = cag_curve_composite_piece(c, a, b, &a, &b, &rate);
  if (piece) return trace_part(tr, piece, a, b);
  const CagVec3 *points;
  size_t n;
  bool closed;
  CagVec3 from, to;
  CagStatus status = cag_curve_eval(c, a, 0, CAG_SIDE_RIGHT, &from, tr->err);
  if (!status) status = cag_curve_eval(c, b, 0, CAG_SIDE_LEFT, &to, tr->err);
  if (status) return status;
  const Spot p = spot_of(tr, a, from), q = spot_of(tr, b, to);
  status = trace_segment(tr, tr->last, p);
  if (status) return status;
  if (cag_curve_vertices(c, &points, &n, &closed)) return trace_segment(tr, p, q);
  tr->curve = c;
  tr->last = q;
  return trace_smooth(tr, p, q, 0);
}

static CagStatus trace_polygon(Tracer *tr, const CagVec3 *points, size_t n) {
  CagStatus status = CAG_OK;
  tr->last = spot_of(tr, 0, points[n - 1]);
  for (size_t i = 0; !status && i < n; i++) {
    status = trace_segment(tr, tr->last, spot_of(tr, 0, points[i]));
    if (!status) status = cag_stop_check(tr->err);
  }
  return status;
}

static CagStatus trace_loop(Tracer *tr, const CagCurve *c) {
  const CagVec3 *points;
  CagVec3 end;
  size_t n;
  bool closed;
  double *cuts;
  if (cag_curve_vertices(c, &points, &n, &closed)) return trace_polygon(tr, points, n);
  CagStatus status = cag_curve_eval(c, c->end, 0, CAG_SIDE_LEFT, &end, tr->err);
  if (!status) status = cag_curve_cuts(c, &cuts, &n, tr->err);
  if (status) return status;
  tr->last = spot_of(tr, 0, end);
  for (size_t i = 0; !status && i + 1 < n; i++) {
    status = trace_part(tr, c, cuts[i], cuts[i + 1]);
    if (!status) status = cag_stop_check(tr->err);
  }
  cag_free(cuts);
  return status;
}

// --- The image ---

// Replaces the differences of a row by their sums.
static void sum_row(double *row, size_t n) {
  double total = 0, lost = 0;
  for (size_t x = 0; x < n; x++) {
    const double next = total + row[x];
    lost += fabs(total) >= fabs(row[x]) ? (total - next) + row[x] : (row[x] - next) + total;
    total = next;
    const double v = total + lost;
    row[x] = v <= WHOLE ? 0 : v >= 1 - WHOLE ? 1 : v;
  }
}

CagStatus cag_raster_of_region(const CagRegion *region, const CagGrid *grid, CagPixelRule rule,
                               CagRaster **out, CagError *err) {
  CagRaster *made;
  CagStatus status = cag_raster_new(grid->width, grid->height, 1, &made, err);
  if (status) return status;
  Tracer tr = {.grid = grid, .rule = rule, .image = made, .err = err};
  for (size_t i = 0; !status && i < region->count; i++) status = trace_loop(&tr, region->loops[i]);
  for (size_t y = 0; !status && y < made->height; y++) {
    sum_row(cag_raster_at(made, 0, 0, y), made->width);
    status = cag_stop_check(err);
  }
  if (status) cag_raster_release(made);
  else *out = made;
  return status;
}
