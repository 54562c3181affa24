// Tessellation, step 1 b: cells become strips where grids would not follow the surface.
//
// A grid takes many triangles if the surface bends along both of its parameters but is straight in
// a direction between them. A thread is an example: its parameter lines are horizontal sections and
// helices, while its flanks are straight along lines that are neither. The rows of a mesh do not
// have to follow both parameters. A rail is a line along which only one parameter changes. From one
// rail to the next, the surface bends least along the direction conjugate to the rail, in which the
// second fundamental form has no mixed term. Edges along this direction, called slants, may be
// long: usually one slant crosses a whole flank.
//
// All strips of a run of neighboring cells use the same step between slants. Each strip continues
// the slants of the strip before it, and the nodes on its sides are where slants meet them.
// Otherwise, the triangles of a narrow strip would lean, because the surface bulges over the middle
// of a chord of its rail.
//
// Slants are straight in the parameters of a strip, and steps are equal. Strips therefore suit
// shapes that move along a parameter without changing, such as twisted extrusions and sweeps along
// helices. For other shapes, strips take more triangles than leaves or exceed the tolerance, and
// the leaves are kept.

#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/tessellate/trial.h"

enum {
  ALONG = 5,          // samples along a cell
  MOST_PIECES = 256,  // of a cell, between samples across it
  LEAST_PIECES = 4,   //
  ALL_PIECES = 1024,  // of a run, unless its cells need more for LEAST_PIECES
  LOOKS = 3,          // samples in both directions that decide whether to try strips
  WORTH_STRIPS = 256, // least number of quadrilaterals for which strips are tried
  ROUNDS = 6
};

// Fractions of the tolerance; see plan.c. Chords of creases must keep it on their own (chords.c).
#define HIGHEST_USE 0.9
#define AIMED_USE 0.84
#define LOWEST_USE 0.72
#define CHORD_USE 0.88
// Fraction of the angle; see plan.c.
#define CLOSELY 0.95
// Strips must take less than this fraction of the quadrilaterals of leaves, because their triangles
// are longer.
#define LEAST_GAIN 0.5
// Fraction of the length of a cell: steeper slants would be cut off at both ends.
#define STEEPEST 0.75
#define CELL_INSET 1e-6 // fraction of a cell, as in plan.c

// Derivatives of the surface at a sample. Index [0] is across a strip, [1] along it.
typedef struct Bend {
  double uu, uv, vv; // second fundamental form
  double chord;      // second partial along the strip, without its component parallel to the first
  CagVec3 partial[2], turn[2]; // turn: change of the unit normal
} Bend;

typedef struct Cell {
  double from, to; // across
  double quads;    // of its leaves
  int pieces;
  Bend *bends; // of (pieces + 1) x ALONG samples
} Cell;

typedef struct Strip {
  double from, to, slope;
  double turn[2]; // change of the normal over one quadrilateral
} Strip;

// A row of cells that either all become strips or all stay leaves.
typedef struct Run {
  const Tessellator *t;
  const CagSurface *surface;
  int along;
  double from, to;  // along
  double low, high; // across
  Cell *cells;
  size_t cell_count;
  bool closed;             // the last cell is followed by the first
  double tolerance, angle; // targets
  double steps;            // along the whole run
  Strip *strips;
  size_t strip_count, strip_capacity;
} Run;

// --- Sampling ---

static CagVec3 off_normal(CagVec3 x, CagVec3 normal) {
  return cag_sub(x, cag_scaled(normal, cag_dot(x, normal)));
}

// Evaluates a sample. Returns false if the surface has no second partials or no normal there.
static bool bend_at(const CagSurface *s, int along, double across, double at, Bend *out) {
  const double parallel = 1e-6; // sine of the angle between the partials
  CagVec3 d[9];
  CagError ignored;
  const CagStatus status =
      along == 1 ? cag_surface_eval(s, across, at, 2, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, &ignored)
                 : cag_surface_eval(s, at, across, 2, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, &ignored);
  if (status) return false;
  const bool by_v = along == 1;
  const CagVec3 a = d[cag_partial(2, by_v, !by_v)], l = d[cag_partial(2, !by_v, by_v)],
                aa = d[cag_partial(2, 2 * by_v, 2 * !by_v)], al = d[cag_partial(2, 1, 1)],
                ll = d[cag_partial(2, 2 * !by_v, 2 * by_v)];
  const CagVec3 c = cag_cross(a, l);
  const double area = cag_norm(c), length = cag_norm(l);
  if (!(area > parallel * cag_norm(a) * length)) return false;
  const CagVec3 normal = cag_scaled(c, 1 / area);
  *out = (Bend){.uu = cag_dot(aa, normal), .uv = cag_dot(al, normal), .vv = cag_dot(ll, normal)};
  out->chord = cag_norm(off_normal(ll, cag_scaled(l, 1 / length)));
  out->partial[0] = a;
  out->partial[1] = l;
  const CagVec3 turn[2] = {cag_add(cag_cross(aa, l), cag_cross(a, al)),
                           cag_add(cag_cross(al, l), cag_cross(a, ll))};
  for (int k = 0; k < 2; k++) out->turn[k] = off_normal(cag_scaled(turn[k], 1 / area), normal);
  return true;
}

static double sample_at(double from, double to, double part) {
  return from + (to - from) * (CELL_INSET + (1 - 2 * CELL_INSET) * part);
}

// Decides from a few samples whether a cell bends along the rails, so that slants have a direction,
// and whether strips would save triangles: because grids would not follow the surface, or because
// leaves take far more than the distance requires. Then the normal turns along their edges, and may
// do so along short slants.
static void judge_cell(const Run *r, const Cell *c, bool *usable, bool *worthwhile) {
  const double saving = 0.8, far_more = 4;
  const double length = r->to - r->from;
  double straight = 0, aslant = 0;
  *usable = true;
  for (int i = 0; i < LOOKS && *usable; i++)
    for (int j = 0; j < LOOKS && *usable; j++) {
      Bend b;
      *usable = bend_at(r->surface, r->along, sample_at(c->from, c->to, (i + 0.5) / LOOKS),
                        sample_at(r->from, r->to, (j + 0.5) / LOOKS), &b) &&
                fabs(b.vv) * length * length / 8 > r->tolerance;
      if (!*usable) break;
      straight += sqrt(fabs(b.uu * b.vv - b.uv * b.uv));
      aslant += sqrt(fabs(b.uu * b.vv)) + fabs(b.uv);
    }
  const double area = length * (c->to - c->from) / (LOOKS * LOOKS);
  const double required = straight * area / (4 * r->tolerance); // quadrilaterals, by plan.c's bound
  const bool turns = !(r->t->how.max_edge > 0) && c->quads > far_more * required;
  *worthwhile = *usable && (straight < saving * aslant || turns);
}

static bool sample_cell(const Run *r, Cell *c) {
  for (int i = 0; i <= c->pieces; i++)
    for (int j = 0; j < ALONG; j++)
      if (!bend_at(r->surface, r->along, sample_at(c->from, c->to, (double)i / c->pieces),
                   sample_at(r->from, r->to, (j + 0.5) / ALONG), &c->bends[i * ALONG + j]))
        return false;
  return true;
}

// Runs that become strips, all along the same direction of a face.
typedef struct Plan {
  Run *runs;
  size_t count, capacity;
  double saved; // number of quadrilaterals
} Plan;

// --- Strips ---

// The slope of the slants between two samples across: conjugate to the rails on average.
static double slope_of(const Cell *c, int first, int last) {
  double mixed = 0, bent = 0;
  for (int k = first * ALONG; k < (last + 1) * ALONG; k++) {
    mixed += c->bends[k].uv * c->bends[k].vv;
    bent += c->bends[k].vv * c->bends[k].vv;
  }
  return bent > 0 ? -mixed / bent : 0;
}

// Tests whether the sides and both diagonals of a quadrilateral with the sides a and b respect the
// limits of edges. turn: change of the normal along both sides.
static bool are_edges_within(const Run *r, const CagVec3 side[2], const CagVec3 turn[2]) {
  const CagTessellation *how = &r->t->how;
  const double free = tess_short_edge(how);
  static const double part[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
  const bool free_side = fmin(cag_norm(side[0]), cag_norm(side[1])) <= free;
  for (int k = 0; k < 4; k++) {
    const double *p = part[k];
    const double length = cag_norm(cag_madd(cag_scaled(side[0], p[0]), p[1], side[1]));
    const double turned = cag_norm(cag_madd(cag_scaled(turn[0], p[0]), p[1], turn[1]));
    const bool exempt = length <= free || (k >= 2 && free_side);
    if (how->angle > 0 && turned > r->angle && !exempt) return false;
    if (how->max_edge > 0 && length > how->max_edge) return false;
  }
  return true;
}

// Tests whether a single strip suffices between two samples across.
static bool is_strip(const Run *r, const Cell *c, int first, int last, Strip *out) {
  const double piece = (c->to - c->from) / c->pieces, width = (last - first) * piece,
               step = (r->to - r->from) / r->steps, slope = slope_of(c, first, last);
  *out = (Strip){.from = first == 0 ? c->from : c->from + first * piece,
                 .to = last == c->pieces ? c->to : c->from + last * piece,
                 .slope = slope};
  if (fabs(slope) * width > STEEPEST * (r->to - r->from)) return false;
  for (int k = first * ALONG; k < (last + 1) * ALONG; k++) {
    const Bend *b = &c->bends[k];
    const double off = fabs(b->uu + slope * (2 * b->uv + slope * b->vv)) * width * width / 8 +
                       fabs(b->uv + slope * b->vv) * width * step / 4 +
                       fabs(b->vv) * step * step / 8;
    if (off > r->tolerance) return false;
    const CagVec3 turn[2] = {cag_scaled(cag_madd(b->turn[0], slope, b->turn[1]), width),
                             cag_scaled(b->turn[1], step)};
    const CagVec3 side[2] = {cag_scaled(cag_madd(b->partial[0], slope, b->partial[1]), width),
                             cag_scaled(b->partial[1], step)};
    for (int d = 0; d < 2; d++) out->turn[d] = fmax(out->turn[d], cag_norm(turn[d]));
    if (!are_edges_within(r, side, turn)) return false;
  }
  return true;
}

// Finds the fewest strips that suffice for the chosen number of steps, starting at the lower end of
// the cell. *possible is false if there are none, or more than `most` in all.
static CagStatus cut_cell(Run *r, const Cell *c, double most, bool *possible, CagError *err) {
  for (int first = 0, last; *possible && first < c->pieces; first = last) {
    Strip strip, wider;
    last = first + 1;
    *possible = is_strip(r, c, first, last, &strip) && (double)r->strip_count + 1 <= most;
    // Finds the last sample that one strip can reach.
    for (int low = last, high = c->pieces; *possible && low < high;) {
      const int middle = (low + high + 1) / 2;
      if (is_strip(r, c, first, middle, &wider)) strip = wider, last = low = middle;
      else high = middle - 1;
    }
    if (!*possible) break;
    if (!CAG_RESERVE(r->strips, r->strip_capacity, r->strip_count + 1)) return cag_fail_memory(err);
    r->strips[r->strip_count++] = strip;
  }
  return CAG_OK;
}

static CagStatus cut_run(Run *r, double most, bool *possible, CagError *err) {
  CagStatus status = CAG_OK;
  *possible = true;
  r->strip_count = 0;
  for (size_t k = 0; !status && *possible && k < r->cell_count; k++)
    status = cut_cell(r, &r->cells[k], most, possible, err);
  return status;
}

// The least number of steps along the rails that any strip needs.
static double least_steps(const Run *r) {
  const CagTessellation *how = &r->t->how;
  const double length = r->to - r->from;
  double n = 1;
  for (size_t i = 0; i < r->cell_count; i++) {
    const Cell *c = &r->cells[i];
    for (int k = 0; k < (c->pieces + 1) * ALONG; k++) {
      const Bend *b = &c->bends[k];
      const bool end = k < ALONG || k >= c->pieces * ALONG; // may be a crease
      const double edge = cag_norm(b->partial[1]) * length;
      n = fmax(n, sqrt(fabs(b->vv) * length * length / 8 / r->tolerance));
      if (end) n = fmax(n, sqrt(b->chord * length * length / 8 / (CHORD_USE * how->tolerance)));
      if (how->angle > 0)
        n = fmax(n, fmin(cag_norm(b->turn[1]) * length / r->angle, edge / tess_short_edge(how)));
      if (how->max_edge > 0) n = fmax(n, edge / how->max_edge);
    }
  }
  return n;
}

// On a closed face, slants join up after one turn if the step divides the distance by which they
// climb. At least three steps are used, so that shapes smaller than the tolerance do not vanish.
static void close_run(Run *r) {
  const double nearly = 1.15, rounding = 1e-6; // limit on the increase of steps, and rounding
  const double around_at_all = 0.5;            // or else slants climb as far as they descend
  double climb = 0, way = 0;
  for (size_t k = 0; k < r->strip_count; k++) {
    const double rise = r->strips[k].slope * (r->strips[k].to - r->strips[k].from);
    climb += rise;
    way += fabs(rise);
  }
  const double share = fabs(climb) / (r->to - r->from);
  const double around = fmax(3, ceil(share * r->steps - rounding));
  if (!r->closed || !(share > 0) || fabs(climb) < around_at_all * way) return;
  if (around < nearly * share * r->steps || around <= 3) r->steps = around / share;
}

// Chooses the steps and strips with the smallest product among a few tries.
static CagStatus plan_run(Run *r, double most_quads, bool *possible, CagError *err) {
  enum { TRIES = 8 };
  const double finer = 1.13, rounding = 1 + 1e-9, least = least_steps(r) * rounding;
  double best = most_quads, steps = 0;
  CagStatus status = CAG_OK;
  *possible = false;
  for (int k = 0; !status && k < TRIES; k++) {
    bool found;
    r->steps = least * pow(finer, k);
    if ((double)r->cell_count * r->steps >= best) break; // each cell has at least one strip
    status = cut_run(r, best / r->steps, &found, err);
    if (!status && found) best = (double)r->strip_count * r->steps, steps = r->steps;
  }
  if (status || steps == 0) return status;
  r->steps = steps;
  status = cut_run(r, INFINITY, possible, err);
  close_run(r);
  return status;
}

// --- Trials ---

static TessTrial trial_of(const Run *r, const Strip *strip) {
  TessTrial trial = {.surface = r->surface, .along = r->along, .slope = strip->slope};
  const int across = 1 - r->along;
  const double climb = strip->slope * (strip->to - strip->from),
               step = (r->to - r->from) / r->steps, from = r->from - fmin(0, climb),
               n = fmax(1, floor((r->to - fmax(0, climb) - from) / step));
  trial.from[across] = strip->from;
  trial.to[across] = strip->to;
  trial.n[across] = 1;
  trial.from[r->along] = from;
  trial.to[r->along] = fmin(from + n * step, r->to - fmax(0, climb));
  trial.n[r->along] = n;
  return trial;
}

// Computes the error of a strip relative to the tolerance and to the limits of edges. It is
// INFINITY if a thin feature was missed.
static CagStatus try_strip(const Run *r, const Strip *strip, double *use, double *excess,
                           CagError *err) {
  const CagTessellation *how = &r->t->how;
  const TessTrial trial = trial_of(r, strip);
  const int across = 1 - r->along;
  double sine[2], distance[2];
  sine[across] = sin(fmin(strip->turn[0], M_PI / 2));
  sine[r->along] = sin(fmin(strip->turn[1], M_PI / 2));
  TessExcess found;
  bool missed = false;
  CagStatus status = cag_tess_try_distance(&trial, sine, &distance[0], err);
  if (!status) status = cag_tess_try_middles(&trial, &distance[1], err);
  if (!status)
    status = cag_tess_try_edges(&trial, CLOSELY * how->angle, tess_short_edge(how), how->max_edge,
                                &found, err);
  if (!status && cag_tess_is_known_by_points(r->surface))
    status = cag_tess_try_scattered(&trial, how->tolerance, &missed, err);
  if (status) return status;
  *use = missed ? INFINITY : fmax(distance[0], distance[1]) / how->tolerance;
  *excess = fmax(found.diagonal, fmax(found.along[0], found.along[1]));
  return CAG_OK;
}

static CagStatus try_run(const Run *r, double *use, double *excess, CagError *err) {
  CagStatus status = CAG_OK;
  *use = *excess = 0;
  for (size_t k = 0; !status && k < r->strip_count; k++) {
    double u, e;
    status = try_strip(r, &r->strips[k], &u, &e, err);
    if (!status) *use = fmax(*use, u), *excess = fmax(*excess, e);
  }
  return !status ? cag_tess_interrupted(r->t, err) : status;
}

// Finds strips that keep the tolerance and the limits of edges without being much finer than
// necessary.
static CagStatus settle_run(Run *r, double most_quads, bool *settled, CagError *err) {
  const double tolerance = r->t->how.tolerance, rounding = 1e-9;
  Run best = *r;
  best.strips = NULL;
  *settled = false;
  for (int round = 0; round < ROUNDS; round++) {
    bool possible;
    double use, excess;
    CagStatus status = plan_run(r, most_quads, &possible, err);
    if (!status && possible) status = try_run(r, &use, &excess, err);
    if (status) {
      cag_free(best.strips);
      return status;
    }
    if (!possible || use == INFINITY) break;
    if (excess > 1 + rounding) r->angle /= fmin(2, fmax(1.01, excess));
    if (use > HIGHEST_USE || use < LOWEST_USE)
      r->tolerance *= fmin(4, fmax(1.0 / 4, AIMED_USE / use));
    if (use > HIGHEST_USE || excess > 1 + rounding) continue;
    // These are fewer quadrilaterals than the last solution had; otherwise plan_run finds none.
    cag_free(best.strips);
    best = *r;
    r->strips = NULL;
    r->strip_capacity = 0;
    most_quads = 0.98 * (double)best.strip_count * best.steps;
    *settled = true;
    if (use >= LOWEST_USE || r->tolerance > 16 * tolerance) break;
  }
  if (!*settled) return CAG_OK;
  cag_free(r->strips);
  *r = best;
  return CAG_OK;
}

// --- Cells and runs ---

static size_t cell_of(const Face *f, int direction, double x) {
  size_t low = 0, high = f->break_count[direction] - 2;
  while (low < high) {
    const size_t middle = (low + high + 1) / 2;
    if (f->breaks[direction][middle] <= x) low = middle;
    else high = middle - 1;
  }
  return low;
}

static bool has_pole(const CagSurface *s, int direction, double from, double to) {
  return direction == 0 ? (s->pole_u0 && from == s->u0) || (s->pole_u1 && to == s->u1)
                        : (s->pole_v0 && from == s->v0) || (s->pole_v1 && to == s->v1);
}

// Replaces the leaves of the run's cells with its strips.
static CagStatus replace_leaves(Tessellator *t, uint32_t face, const Run *r, CagError *err) {
  Face *f = &t->faces[face];
  const int across = 1 - r->along;
  size_t kept = f->leaf;
  double phase = r->from;
  for (size_t k = f->leaf; k < t->leaf_count; k++) {
    const Leaf *leaf = &t->leaves[k];
    if (leaf->from[across] >= r->low && leaf->to[across] <= r->high &&
        leaf->from[r->along] >= r->from && leaf->to[r->along] <= r->to) {
      t->quads -= (double)leaf->n[0] * leaf->n[1];
      continue;
    }
    t->leaves[kept++] = *leaf;
  }
  t->leaf_count = kept;
  for (size_t k = 0; k < r->strip_count; k++) {
    const Strip *strip = &r->strips[k];
    if (!CAG_RESERVE(t->leaves, t->leaf_capacity, t->leaf_count + 1)) return cag_fail_memory(err);
    Leaf *leaf = &t->leaves[t->leaf_count++];
    *leaf = (Leaf){.face = face, .n = {1, 1}};
    leaf->from[across] = strip->from;
    leaf->to[across] = strip->to;
    leaf->from[r->along] = r->from;
    leaf->to[r->along] = r->to;
    leaf->slants = (Slants){r->along, strip->slope, phase, (r->to - r->from) / r->steps};
    phase += strip->slope * (strip->to - strip->from);
    t->quads += r->steps;
  }
  f->leaf_count = t->leaf_count - f->leaf;
  return CAG_OK;
}

// Finds strips for the run's cells and adds them to the plan if they save triangles.
static CagStatus try_cells(Run *r, Plan *plan, CagError *err) {
  double quads = 0;
  bool possible = true, settled = false;
  int pieces = ALL_PIECES / (int)fmin(ALL_PIECES, (double)r->cell_count);
  pieces = pieces < LEAST_PIECES ? LEAST_PIECES : pieces > MOST_PIECES ? MOST_PIECES : pieces;
  const size_t samples = (size_t)(pieces + 1) * ALONG;
  for (size_t k = 0; k < r->cell_count; k++) quads += r->cells[k].quads;
  if (quads < WORTH_STRIPS) return CAG_OK;
  Bend *bends = cag_malloc(r->cell_count * samples * sizeof *bends);
  if (!bends) return cag_fail_memory(err);
  for (size_t k = 0; k < r->cell_count && possible; k++) {
    r->cells[k].pieces = pieces;
    r->cells[k].bends = bends + k * samples;
    possible = sample_cell(r, &r->cells[k]);
  }
  r->low = r->cells[0].from;
  r->high = r->cells[r->cell_count - 1].to;
  CagStatus status = cag_tess_interrupted(r->t, err);
  if (!status && possible) status = settle_run(r, LEAST_GAIN * quads, &settled, err);
  cag_free(bends);
  if (!status && settled)
    status =
        CAG_RESERVE(plan->runs, plan->capacity, plan->count + 1) ? CAG_OK : cag_fail_memory(err);
  if (!status && settled) {
    plan->saved += quads - (double)r->strip_count * r->steps;
    plan->runs[plan->count++] = *r;
  } else {
    cag_free(r->strips);
  }
  return status;
}

// Plans the runs of usable cells in one row of cells that extends along the strips from run.from to
// run.to. quads: quadrilaterals in the leaves of each cell. cells: room for the whole row.
static CagStatus plan_row(const Tessellator *t, const Face *f, Run run, const double *quads,
                          Cell *cells, Plan *plan, CagError *err) {
  const CagSurface *s = f->surface;
  const int across = 1 - run.along;
  const size_t count = f->break_count[across] - 1;
  const double *breaks = f->breaks[across];
  CagStatus status = CAG_OK;
  bool worthwhile = false;
  if (has_pole(s, run.along, run.from, run.to)) return CAG_OK;
  run.tolerance = AIMED_USE * t->how.tolerance;
  run.angle = CLOSELY * t->how.angle;
  for (size_t k = 0; !status && k <= count; k++) {
    bool usable = false, saves = false;
    if (k < count) {
      const Cell cell = {.from = breaks[k], .to = breaks[k + 1], .quads = quads[k]};
      cells[k] = cell;
      if (!has_pole(s, across, cell.from, cell.to)) judge_cell(&run, &cell, &usable, &saves);
    }
    if (usable) {
      if (run.cell_count++ == 0) run.cells = &cells[k];
      worthwhile |= saves;
      continue;
    }
    Run whole = run;
    whole.closed = run.cell_count == count && (across == 0 ? s->closed_u : s->closed_v);
    if (worthwhile) status = try_cells(&whole, plan, err);
    run.cell_count = 0;
    worthwhile = false;
  }
  return status;
}

static CagStatus plan_direction(const Tessellator *t, const Face *f, int along, Plan *plan,
                                CagError *err) {
  const int across = 1 - along;
  const size_t rows = f->break_count[along] - 1, cells = f->break_count[across] - 1;
  double *quads = cag_calloc(rows * cells, sizeof *quads);
  Cell *room = cag_malloc(cells * sizeof *room);
  CagStatus status = quads && room ? CAG_OK : cag_fail_memory(err);
  for (size_t k = f->leaf; !status && k < f->leaf + f->leaf_count; k++) {
    const Leaf *leaf = &t->leaves[k];
    const size_t row = cell_of(f, along, leaf->from[along]),
                 cell = cell_of(f, across, leaf->from[across]);
    quads[row * cells + cell] += (double)leaf->n[0] * leaf->n[1];
  }
  for (size_t k = 0; !status && k < rows; k++) {
    const Run run = {.t = t,
                     .surface = f->surface,
                     .along = along,
                     .from = f->breaks[along][k],
                     .to = f->breaks[along][k + 1]};
    status = plan_row(t, f, run, quads + k * cells, room, plan, err);
  }
  cag_free(quads);
  cag_free(room);
  return status;
}

CagStatus cag_tess_plan_strips(Tessellator *t, uint32_t face, CagError *err) {
  const Face *f = &t->faces[face];
  Plan plans[2] = {{0}, {0}};
  double quads = 0;
  CagStatus status = CAG_OK;
  for (size_t k = f->leaf; k < f->leaf + f->leaf_count; k++)
    quads += (double)t->leaves[k].n[0] * t->leaves[k].n[1];
  for (int along = 0; !status && along < 2 && quads >= WORTH_STRIPS; along++)
    status = plan_direction(t, f, along, &plans[along], err);
  const Plan *best = &plans[plans[1].saved >= plans[0].saved];
  for (size_t k = 0; !status && k < best->count; k++)
    status = replace_leaves(t, face, &best->runs[k], err);
  for (int along = 0; along < 2; along++) {
    for (size_t k = 0; k < plans[along].count; k++) cag_free(plans[along].runs[k].strips);
    cag_free(plans[along].runs);
  }
  return status;
}
