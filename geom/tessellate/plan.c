// Tessellation, step 1: how finely each part of a face is divided.
//
// A linear triangle whose corners lie within a box of hu x hv parameters is off the surface by at
// most (hu^2 |S_uu| + 2 hu hv |S_uv| + hv^2 |S_vv|) / 8 (Filip, Magedson and Markot 1986). Only the
// components along the normal count, so that flat pieces need two triangles for any
// parametrization. The second partials are computed from differences of first ones on a dense grid.
// The choice is then tested: distances from the surface to the triangles are measured, and the
// bound is scaled by the result, until the distance is below the tolerance and close to it.

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "geom/linalg/tolerance.h"
#include "geom/surface/frames.h"
#include "geom/surface/trimmed.h"
#include "geom/tessellate/trial.h"

enum {
  STEPS = 8, // of the sampling grid of a leaf; even, so that halves are sampled as well
  SIDE = STEPS + 1,
  SAMPLES = SIDE * SIDE,
  MAX_DEPTH = 24,     // of halving: features of a 4000th of the domain, in both directions
  WORTH_HALVING = 32, // quadrilaterals
  MAX_CORRECTIONS = 8
};

// The sampling grid stays this far (as a fraction of the leaf) inside, so that one-sided
// derivatives are those of the leaf's piece, and poles have normals.
#define CELL_INSET 1e-6
// Distances measured on samples may be this fraction of the tolerance; the rest is a margin for the
// points between.
#define HIGHEST_USE 0.9
#define AIMED_USE 0.84
#define LOWEST_USE 0.68

typedef struct Range {
  int u0, u1, v0, v1; // sample indices, including both ends
} Range;

// Requirements of a leaf in parameters 0..1: triangles of 1/nu x 1/nv are off by
// uu/nu^2 + uv/(nu nv) + vv/nv^2.
typedef struct Needs {
  double uu, uv, vv;
  double turn[2];   // of the normal
  double bend[2];   // the same, excluding jumps at cusps
  double both;      // of bends about the same axis
  double diagonal;  // the same along the diagonal of the cut: negative if they cancel there
  double length[2]; // of lines
} Needs;

typedef struct Sampled {
  double from[2], to[2];
  CagVec3 points[SAMPLES], du[SAMPLES], dv[SAMPLES], normals[SAMPLES];
  double speed[2][SAMPLES]; // the lengths of du and dv
  bool has_normal[SAMPLES];
  double off_uu[SAMPLES], off_uv[SAMPLES], off_vv[SAMPLES];
  double turn[2][SAMPLES];  // of the normal on the way to the next sample
  double both[SAMPLES];     // the product of both turns if they have the same axis, else less
  double diagonal[SAMPLES]; // with the sign for the shorter diagonal, along which is cut
} Sampled;

// --- Sampling ---

static void find_lengths_and_normals(Sampled *s) {
  // If the partials are nearly parallel the cross product is rounding; if one of them is that
  // short, it is rounding itself.
  const double parallel = CAG_PARALLEL;
  for (int k = 0; k < SAMPLES; k++) {
    CagVec3 n = cag_cross(s->du[k], s->dv[k]);
    double length = cag_norm(n);
    s->speed[0][k] = cag_norm(s->du[k]);
    s->speed[1][k] = cag_norm(s->dv[k]);
    s->has_normal[k] =
        length > parallel * s->speed[0][k] * s->speed[1][k] && length > 0 &&
        tess_smaller(s->speed[0][k], s->speed[1][k]) > cag_partial_noise(s->points[k], 1);
    s->normals[k] = s->has_normal[k] ? cag_scaled(n, 1 / length) : n;
  }
}

// Derivative of the samples d along a direction (stride) at index i, in leaf parameters 0..1.
static CagVec3 slope(const CagVec3 *d, int i, int stride) {
  const double twice_step = 2 * (1 - 2 * CELL_INSET) / STEPS;
  CagVec3 change;
  if (i == 0)
    change = cag_sub(cag_sub(cag_scaled(d[stride], 4), cag_scaled(d[0], 3)), d[2 * stride]);
  else if (i == STEPS)
    change = cag_add(cag_sub(cag_scaled(d[0], 3), cag_scaled(d[-stride], 4)), d[-2 * stride]);
  else change = cag_sub(d[stride], d[-stride]);
  return cag_scaled(change, 1 / twice_step);
}

static double along_normal(const Sampled *s, int k, CagVec3 x) {
  return s->has_normal[k] ? fabs(cag_dot(x, s->normals[k])) : cag_norm(x);
}

static void find_second_partials(Sampled *s) {
  for (int i = 0; i < SIDE; i++)
    for (int j = 0; j < SIDE; j++) {
      int k = i * SIDE + j;
      s->off_uu[k] = along_normal(s, k, slope(s->du + k, i, SIDE)) / 8;
      s->off_uv[k] = along_normal(s, k, slope(s->du + k, j, 1)) / 4;
      s->off_vv[k] = along_normal(s, k, slope(s->dv + k, j, 1)) / 8;
    }
}

static double angle_between(CagVec3 a, CagVec3 b) {
  return atan2(cag_norm(cag_cross(a, b)), cag_dot(a, b));
}

static void find_turns(Sampled *s) {
  for (int d = 0; d < 2; d++)
    for (int i = 0; i < SIDE; i++)
      for (int j = 0; j < SIDE; j++) {
        int k = i * SIDE + j, next = k + (d == 0 ? SIDE : 1);
        bool known = (d == 0 ? i : j) < STEPS && s->has_normal[k] && s->has_normal[next];
        s->turn[d][k] = known ? STEPS * angle_between(s->normals[k], s->normals[next]) : 0;
      }
}

// Along a diagonal the turns add up if they have the same axis, or cancel. If the lines of the grid
// are oblique, as on twisted bodies, one diagonal is clearly shorter.
static void find_common_turns(Sampled *s) {
  const double aslant = 0.1; // cosine of the angle between the lines
  for (int i = 0; i < STEPS; i++)
    for (int j = 0; j < STEPS; j++) {
      int k = i * SIDE + j;
      CagVec3 u = cag_sub(s->normals[k + SIDE], s->normals[k]),
              v = cag_sub(s->normals[k + 1], s->normals[k]);
      bool known = s->has_normal[k] && s->has_normal[k + SIDE] && s->has_normal[k + 1];
      const double common = known ? cag_dot(u, v) * STEPS * STEPS : 0;
      const double lean = cag_dot(s->du[k], s->dv[k]);
      const bool clear = fabs(lean) > aslant * s->speed[0][k] * s->speed[1][k];
      s->both[k] = fabs(common);
      s->diagonal[k] = clear ? (lean > 0 ? -common : common) : fabs(common);
    }
}

static CagStatus sample_leaf(const CagSurface *surface, Sampled *s, CagError *err) {
  double ts[2][SIDE], length[2];
  for (int d = 0; d < 2; d++) {
    length[d] = s->to[d] - s->from[d];
    for (int i = 0; i < SIDE; i++)
      ts[d][i] = s->from[d] + length[d] * (CELL_INSET + (1 - 2 * CELL_INSET) * i / STEPS);
  }
  CagStatus status =
      cag_surface_eval_grid(surface, ts[0], SIDE, ts[1], SIDE, s->points, s->du, s->dv, err);
  if (status) return status;
  for (int k = 0; k < SAMPLES; k++) {
    s->du[k] = cag_scaled(s->du[k], length[0]);
    s->dv[k] = cag_scaled(s->dv[k], length[1]);
  }
  find_lengths_and_normals(s);
  find_second_partials(s);
  find_turns(s);
  find_common_turns(s);
  return CAG_OK;
}

// Radians between two samples above which the samples do not determine how the normal turns.
#define TURNED_AWAY 1.0

// Points can be distributed well around a rim at which the normal jumps. Smaller rims are left to
// the trial.
static bool are_turns_resolved(const CagTessellation *how, const Sampled *s, int direction) {
  const double small = 4; // tolerances
  int stride = direction == 0 ? SIDE : 1;
  for (int k = 0; k < SAMPLES; k++)
    if (s->turn[direction][k] > TURNED_AWAY * STEPS &&
        cag_norm(cag_sub(s->points[k + stride], s->points[k])) > small * how->tolerance)
      return false;
  return true;
}

// Whether the samples along a direction are dense enough. If the mean of the derivatives at the
// ends of a step differs much from the step itself, the surface has features between them (such as
// the turns of a helix). At half turns both vanish, and the lengths decide.
static bool is_resolved(const CagTessellation *how, const Sampled *s, int direction) {
  const double far = 0.07; // of the longest step: an arc of 50 degrees, a sixth of a wave
  const CagVec3 *d = direction == 0 ? s->du : s->dv;
  const double *speed = s->speed[direction];
  int stride = direction == 0 ? SIDE : 1;
  double longest = 0, worst = 0;
  for (int k = 0; k < SAMPLES; k++) longest = tess_larger(longest, speed[k]);
  for (int i = 0; i < SIDE; i++)
    for (int j = 0; j < STEPS; j++) {
      int k = direction == 0 ? j * SIDE + i : i * SIDE + j;
      CagVec3 step = cag_scaled(cag_sub(s->points[k + stride], s->points[k]), STEPS);
      CagVec3 mean = cag_scaled(cag_add(d[k], d[k + stride]), 0.5);
      double length = (speed[k] + speed[k + stride]) / 2;
      worst = tess_larger(worst, cag_norm(cag_sub(step, mean)));
      worst = tess_larger(worst, fabs(length - cag_norm(step)));
    }
  // Within the tolerance it does not matter, and if the surface is a point everything is rounding.
  return worst <= tess_larger(far * longest, how->tolerance) &&
         are_turns_resolved(how, s, direction);
}

// --- Requirements and counts ---

static Needs needs_of(const Sampled *s, Range r) {
  Needs n = {.diagonal = -INFINITY};
  double part[2] = {(double)(r.u1 - r.u0) / STEPS, (double)(r.v1 - r.v0) / STEPS};
  for (int i = r.u0; i <= r.u1; i++)
    for (int j = r.v0; j <= r.v1; j++) {
      int k = i * SIDE + j;
      n.uu = tess_larger(n.uu, s->off_uu[k]);
      n.uv = tess_larger(n.uv, s->off_uv[k]);
      n.vv = tess_larger(n.vv, s->off_vv[k]);
      n.length[0] = tess_larger(n.length[0], s->speed[0][k]);
      n.length[1] = tess_larger(n.length[1], s->speed[1][k]);
      if (i < r.u1 && j < r.v1 &&
          tess_larger(s->turn[0][k], s->turn[1][k]) <= TURNED_AWAY * STEPS) {
        n.both = tess_larger(n.both, s->both[k]);
        n.diagonal = tess_larger(n.diagonal, s->diagonal[k]);
      }
      for (int d = 0; d < 2; d++) {
        if (d == 0 ? i == r.u1 : j == r.v1) continue;
        n.turn[d] = tess_larger(n.turn[d], s->turn[d][k]);
        if (s->turn[d][k] <= TURNED_AWAY * STEPS) n.bend[d] = tess_larger(n.bend[d], s->turn[d][k]);
      }
    }
  n.uu *= part[0] * part[0];
  n.uv *= part[0] * part[1];
  n.both *= part[0] * part[1];
  n.diagonal = n.diagonal > -INFINITY ? n.diagonal * part[0] * part[1] : 0;
  n.vv *= part[1] * part[1];
  for (int d = 0; d < 2; d++) {
    n.turn[d] *= part[d];
    n.bend[d] *= part[d];
    n.length[d] *= part[d];
  }
  return n;
}

// Smallest n >= 1 with a/n^2 + b/n <= limit; infinite if there is none.
static double least_count(double a, double b, double limit) {
  if (!(limit > 0)) return INFINITY;
  if (a <= 0 && b <= 0) return 1;
  double n = ceil((b + sqrt(b * b + 4 * a * limit)) / (2 * limit) * (1 - 1e-12));
  return n > 1 ? n : 1;
}

// Terms of uu/nu^2 + uv/(nu nv) + vv/nv^2 <= limit.
typedef struct Form {
  double uu, uv, vv, limit;
} Form;

// Tries the counts with nu (which: 0) or nv (1) fixed and the other derived; accepts them if their
// product is clearly smaller than the best so far.
static void try_counts(const Form *f, int which, double fixed, double n[2], double *best) {
  const double clearly = 0.9;
  double own = which == 0 ? f->uu : f->vv, others = which == 0 ? f->vv : f->uu;
  double other = least_count(others, f->uv / fixed, f->limit - own / (fixed * fixed));
  if (!(fixed * other < clearly * *best)) return;
  *best = fixed * other;
  n[which] = fixed;
  n[1 - which] = other;
}

// Counts with a small product. On the boundary of the admissible range, nu nv = (uu r + uv + vv/r)
// / limit for the ratio r = nv/nu. Among nearly optimal ratios the one closest to square
// quadrilaterals is chosen; single rows and columns only if they are clearly better.
static void best_counts(const Form *f, double square_ratio, double n[2]) {
  const double nearly = 1.1;
  double sum = nearly * (2 * sqrt(f->uu * f->vv) + f->uv) - f->uv, ratio = square_ratio;
  double root = sqrt(tess_larger(0, sum * sum - 4 * f->uu * f->vv));
  if (f->uu > 0) ratio = tess_smaller(ratio, (sum + root) / (2 * f->uu));
  if (f->vv > 0 && sum + root > 0) ratio = tess_larger(ratio, 2 * f->vv / (sum + root));
  double best = INFINITY;
  n[0] = n[1] = 1;
  if (f->uu <= 0 && f->uv <= 0 && f->vv <= 0) return;
  if (ratio > 0) {
    double nu = tess_larger(1, sqrt((f->uu + f->uv / ratio + f->vv / (ratio * ratio)) / f->limit));
    double nv = tess_larger(1, ratio * nu);
    double rounded[2][2], products[2] = {INFINITY, INFINITY};
    try_counts(f, 0, ceil(nu), rounded[0], &products[0]);
    try_counts(f, 1, ceil(nv), rounded[1], &products[1]);
    int better = products[1] < products[0];
    best = products[better];
    if (best < INFINITY) memcpy(n, rounded[better], sizeof rounded[better]);
  }
  try_counts(f, 0, 1, n, &best);
  try_counts(f, 1, 1, n, &best);
}

// Fraction of the angle: where grids of different fineness are stitched, edges differ from those of
// the grid.
#define CLOSELY 0.95

// Counts for a leaf; correction scales the bound on the distance.
static void counts_for(const CagTessellation *how, const Needs *needs, double correction,
                       double n[2]) {
  // Smaller values are rounding of zero, and would only produce stripes.
  double nothing = how->tolerance * 1e-6;
  double uu = needs->uu > nothing ? needs->uu * correction : 0,
         uv = needs->uv > nothing ? needs->uv * correction : 0,
         vv = needs->vv > nothing ? needs->vv * correction : 0;
  double square_ratio =
      needs->length[0] > 0 && needs->length[1] > 0 ? needs->length[1] / needs->length[0] : 1;
  best_counts(&(Form){uu, uv, vv, how->tolerance}, square_ratio, n);
  const double no_turn = 1e-7; // radians: rounding of normals
  double most[2];
  if (how->angle > 0) {
    double a = needs->bend[0] > no_turn ? needs->bend[0] : 0,
           b = needs->bend[1] > no_turn ? needs->bend[1] : 0,
           limit = CLOSELY * CLOSELY * how->angle * how->angle;
    // If turns cancel along the diagonals, both sides of a quadrilateral may use the whole angle.
    const double canceled = -0.5; // fraction of the value for a common axis
    const double sewn = 0.9;      // where bands are stitched, edges lean slightly more
    if (needs->diagonal < canceled * a * b) {
      most[0] = tess_larger(1, ceil(a / (sewn * CLOSELY * how->angle)));
      most[1] = tess_larger(1, ceil(b / (sewn * CLOSELY * how->angle)));
    } else {
      best_counts(&(Form){a * a, a > 0 && b > 0 ? 2 * needs->both : 0, b * b, limit}, square_ratio,
                  most);
    }
    for (int d = 0; d < 2; d++) {
      double room = tess_larger(1, ceil(needs->length[d] / tess_short_edge(how)));
      n[d] = tess_larger(n[d], tess_smaller(most[d], room));
    }
  }
  if (how->max_edge > 0) {
    // A triangle's edge is at most as long as two sides of a quadrilateral, and lines may be
    // slightly longer between the samples.
    const double between = 1.05;
    double a = between * needs->length[0], b = between * needs->length[1];
    best_counts(&(Form){a * a, 2 * a * b, b * b, how->max_edge * how->max_edge}, square_ratio,
                most);
    for (int d = 0; d < 2; d++) n[d] = tess_larger(n[d], most[d]);
  }
}

// --- Trials ---

static int longer_way(const Needs *needs) { return needs->length[0] >= needs->length[1] ? 0 : 1; }

static CagStatus try_distance(const TessTrial *trial, const Needs *needs, double *distance,
                              CagError *err) {
  double sine[2];
  for (int d = 0; d < 2; d++) sine[d] = sin(tess_smaller(needs->turn[d] / trial->n[d], M_PI / 2));
  return cag_tess_try_distance(trial, sine, distance, err);
}

// Finds counts whose measured distance is below the tolerance and not far below it. `halved`: not
// NULL if the leaf may be halved instead; set if the samples missed features between them.
static CagStatus settle_distance(const Tessellator *t, TessTrial *trial, Needs needs, int *halved,
                                 CagError *err) {
  const double surprising = 3; // multiple of the tolerance, if the bound predicted less
  const double blind = 4;      // multiple of the predicted count: the samples missed features
  // Twisted strips may be stitched to other nodes than those that are tested.
  const double sewn = 1.15, twisted = 0.05;
  double tolerance = t->how.tolerance, correction = 1, limit = (double)t->how.max_triangles;
  double smallest = INFINITY, best[2] = {1, 1}, told = 0, *n = trial->n;
  for (int round = 0; round < MAX_CORRECTIONS; round++) {
    counts_for(&t->how, &needs, correction, n);
    double quads = n[0] * n[1], distance;
    if (quads >= smallest) break;
    if (quads > limit) return cag_tess_limit(t, 2 * quads, err);
    if (round == 0) told = tess_larger(quads, WORTH_HALVING);
    if (halved && quads > blind * told) {
      *halved = longer_way(&needs);
      return CAG_OK;
    }
    CagStatus status = try_distance(trial, &needs, &distance, err);
    if (status) return status;
    double use = distance / tolerance;
    if (use <= HIGHEST_USE) {
      status = cag_tess_try_middles(trial, &distance, err);
      if (status) return status;
      use = tess_larger(use, distance / tolerance);
    }
    if (tess_smaller(n[0], n[1]) <= 1 && needs.uv > twisted * tolerance * quads) use *= sewn;
    if (halved && round == 0 && use > surprising) {
      *halved = longer_way(&needs);
      return CAG_OK;
    }
    if (use <= HIGHEST_USE) {
      smallest = quads;
      memcpy(best, n, sizeof best);
      if (use >= LOWEST_USE || quads <= 1) break;
    }
    // Differences miss features between samples: then the counts themselves grow.
    double largest = tess_larger(needs.uu, tess_larger(needs.uv, needs.vv));
    if (use > HIGHEST_USE && largest * correction < tolerance * 0.5) {
      needs.uu = tess_larger(needs.uu, tolerance);
      needs.vv = tess_larger(needs.vv, tolerance);
    }
    correction *= tess_smaller(16, tess_larger(use / AIMED_USE, 1.0 / 16));
  }
  if (smallest < INFINITY) {
    memcpy(n, best, sizeof best);
    return CAG_OK;
  }
  // If corrections do not converge, doubling does.
  for (double distance = INFINITY; distance > HIGHEST_USE * tolerance;) {
    n[0] *= 2;
    n[1] *= 2;
    if (n[0] * n[1] > limit) return cag_tess_limit(t, 2 * n[0] * n[1], err);
    CagStatus status = try_distance(trial, &needs, &distance, err);
    if (status) return status;
  }
  return CAG_OK;
}

// Raises counts until the edges respect the angle and the length: between samples the normal may
// turn faster than on average. Tested only if the samples come close to the limits.
static CagStatus settle_edges(const Tessellator *t, TessTrial *trial, const Needs *needs,
                              int *halved, CagError *err) {
  const double near = 0.6, slight = 0.05, few = 4;
  const double surprising = 1.25; // more is needed only in some part of the leaf
  const CagTessellation *how = &t->how;
  const double free = tess_short_edge(how);
  double *n = trial->n;
  for (int round = 0; round < MAX_CORRECTIONS; round++) {
    double turn[2], length[2];
    for (int d = 0; d < 2; d++) {
      turn[d] = needs->turn[d] / n[d];
      length[d] = needs->length[d] / n[d];
    }
    bool turns = how->angle > 0 && turn[0] + turn[1] > near * how->angle,
         runs = how->max_edge > 0 && length[0] + length[1] > near * how->max_edge;
    if (!turns && !runs) return CAG_OK;
    TessExcess found;
    CagStatus status =
        cag_tess_try_edges(trial, CLOSELY * how->angle, free, how->max_edge, &found, err);
    if (status) return status;
    double worst = tess_larger(found.diagonal, tess_larger(found.along[0], found.along[1]));
    if (worst <= 1) return CAG_OK;
    bool grown = false;
    int finer = n[0] >= n[1] ? 0 : 1;
    if (halved && n[finer] >= few && worst > surprising) {
      *halved = finer;
      return CAG_OK;
    }
    for (int d = 0; d < 2; d++) {
      // Refining a direction with almost no component in a diagonal does not help.
      bool shares = turn[d] > slight * turn[1 - d] || length[d] > slight * length[1 - d];
      double by = tess_larger(found.along[d], shares ? found.diagonal : 0);
      double more = tess_smaller(ceil(n[d] * by), tess_larger(n[d], ceil(needs->length[d] / free)));
      grown |= by > 1 && more > n[d];
      if (by > 1) n[d] = more;
    }
    if (n[0] * n[1] > (double)how->max_triangles) return cag_tess_limit(t, 2 * n[0] * n[1], err);
    if (!grown) return CAG_OK;
  }
  return CAG_OK;
}

static CagStatus settle_counts(const Tessellator *t, const CagSurface *surface, const Sampled *s,
                               bool *suspect, double best[2], int *halved, CagError *err) {
  TessTrial trial = {.surface = surface, .suspect = *suspect};
  Needs needs = needs_of(s, (Range){0, STEPS, 0, STEPS});
  memcpy(trial.from, s->from, sizeof trial.from);
  memcpy(trial.to, s->to, sizeof trial.to);
  CagStatus status = settle_distance(t, &trial, needs, halved, err);
  if (!status && !(halved && *halved >= 0)) status = settle_edges(t, &trial, &needs, halved, err);
  if (!status && halved && *halved < 0 && cag_tess_is_known_by_points(surface)) {
    bool missed;
    status = cag_tess_try_scattered(&trial, t->how.tolerance, &missed, err);
    if (!status && missed) {
      *halved = longer_way(&needs);
      *suspect = true;
    }
  }
  memcpy(best, trial.n, sizeof trial.n);
  return status;
}

// --- Leaves ---

static double cost_of(const CagTessellation *how, const Sampled *s, Range r) {
  double n[2];
  Needs needs = needs_of(s, r);
  counts_for(how, &needs, 1, n);
  return n[0] * n[1];
}

// The triangles of a leaf at a pole meet in a point: whether the leaf is divided so finely around
// it that they are slivers, and would be divided less near the pole.
static bool is_sliver_pole(const CagTessellation *how, const Sampled *s, int direction, bool end) {
  const double slim = 0.15; // ratio of base to height: 9 degrees at the tip
  const double gain = 0.9;
  const double small = 50; // tolerances: a leaf this low is close enough to the tip
  // A leaf may extend from pole to pole: its half is as wide as the whole.
  int quarter = STEPS / 4, stride = direction == 0 ? SIDE : 1, other = direction == 0 ? 1 : SIDE;
  Range all = {0, STEPS, 0, STEPS}, near = all;
  if (direction == 0) *(end ? &near.u0 : &near.u1) = end ? STEPS - quarter : quarter;
  else *(end ? &near.v0 : &near.v1) = end ? STEPS - quarter : quarter;
  double n[2], less[2], base = 0, height = 0;
  Needs needs = needs_of(s, all), fewer = needs_of(s, near);
  counts_for(how, &needs, 1, n);
  if (n[direction] < 2) return false;
  counts_for(how, &fewer, 1, less);
  // The parallels grow with the distance from the pole: the first one is estimated from the first
  // sample.
  for (int i = 0; i < SIDE; i++) {
    int k = i * other + (end ? STEPS - 1 : 1) * stride;
    base = tess_larger(base, s->speed[1 - direction][k] * STEPS);
    height = tess_larger(height, s->speed[direction][k]);
  }
  return height > small * how->tolerance && base / n[1 - direction] < slim * height &&
         less[1 - direction] < gain * n[1 - direction];
}

// Direction in which halving the leaf pays off; -1: none.
static int halving(const CagTessellation *how, const CagSurface *surface, const Sampled *s,
                   int depth) {
  const double gain = 0.8; // halving adds seams of small triangles, so it must save more
  if (depth >= MAX_DEPTH) return -1;
  for (int d = 0; d < 2; d++)
    if (!is_resolved(how, s, d)) return d;
  const bool pole[4] = {
      surface->pole_u0 && s->from[0] == surface->u0, surface->pole_u1 && s->to[0] == surface->u1,
      surface->pole_v0 && s->from[1] == surface->v0, surface->pole_v1 && s->to[1] == surface->v1};
  for (int side = 0; side < 4; side++)
    if (pole[side] && is_sliver_pole(how, s, side / 2, side % 2)) return side / 2;
  Range all = {0, STEPS, 0, STEPS};
  double whole = cost_of(how, s, all);
  if (whole < WORTH_HALVING) return -1;
  int half = STEPS / 2;
  double by_u =
      cost_of(how, s, (Range){0, half, 0, STEPS}) + cost_of(how, s, (Range){half, STEPS, 0, STEPS});
  double by_v =
      cost_of(how, s, (Range){0, STEPS, 0, half}) + cost_of(how, s, (Range){0, STEPS, half, STEPS});
  if (tess_smaller(by_u, by_v) > gain * whole) return -1;
  return by_u <= by_v ? 0 : 1;
}

// Minimum number of steps of a part of the domain, which keeps shapes smaller than the tolerance
// from vanishing: three in total around a closed one, two from pole to pole.
static uint32_t least_steps(const CagSurface *s, int direction, double from, double to) {
  bool closed = direction == 0 ? s->closed_u : s->closed_v;
  bool poles = direction == 0 ? s->pole_u0 && s->pole_u1 : s->pole_v0 && s->pole_v1;
  double length = direction == 0 ? s->u1 - s->u0 : s->v1 - s->v0;
  double least = ceil((closed ? 3 : poles ? 2 : 1) * ((to - from) / length) - 1e-9);
  return least > 1 ? (uint32_t)least : 1;
}

static CagStatus add_leaf(Tessellator *t, uint32_t face, const Sampled *s, const double n[2],
                          CagError *err) {
  if (!CAG_RESERVE(t->leaves, t->leaf_capacity, t->leaf_count + 1)) return cag_fail_memory(err);
  Leaf *leaf = &t->leaves[t->leaf_count++];
  memset(leaf, 0, sizeof *leaf);
  leaf->face = face;
  for (int d = 0; d < 2; d++) {
    leaf->from[d] = s->from[d];
    leaf->to[d] = s->to[d];
    leaf->n[d] = n[d] < UINT32_MAX / 4 ? (uint32_t)n[d] : UINT32_MAX / 4;
    uint32_t least = least_steps(t->faces[face].surface, d, s->from[d], s->to[d]);
    if (leaf->n[d] < least && !t->is_point) leaf->n[d] = least;
  }
  // Quadrilaterals at poles become one triangle, all others two.
  t->quads += n[0] * n[1];
  return t->quads > (double)t->how.max_triangles ? cag_tess_limit(t, 2 * t->quads, err) : CAG_OK;
}

// Plans the halves of a leaf, lower one first. suspect: see TessTrial.
static CagStatus plan_leaf(Tessellator *t, uint32_t face, const double from[2], const double to[2],
                           int depth, bool suspect, CagError *err) {
  CagStatus status = cag_tess_interrupted(t, err);
  if (status) return status;
  const CagSurface *surface = t->faces[face].surface;
  Sampled s;
  memcpy(s.from, from, sizeof s.from);
  memcpy(s.to, to, sizeof s.to);
  status = sample_leaf(surface, &s, err);
  if (status) return status;
  int d = halving(&t->how, surface, &s, depth);
  double middle = d < 0 ? 0 : from[d] + (to[d] - from[d]) / 2;
  if (d < 0 || !(middle > from[d] && middle < to[d])) {
    double n[2];
    int halved = -1;
    status = settle_counts(t, surface, &s, &suspect, n, depth < MAX_DEPTH && d < 0 ? &halved : NULL,
                           err);
    if (status) return status;
    if (halved < 0) return add_leaf(t, face, &s, n, err);
    d = halved;
    middle = from[d] + (to[d] - from[d]) / 2;
  }
  double lower_to[2] = {to[0], to[1]}, upper_from[2] = {from[0], from[1]};
  lower_to[d] = upper_from[d] = middle;
  status = plan_leaf(t, face, from, lower_to, depth + 1, suspect, err);
  return !status ? plan_leaf(t, face, upper_from, to, depth + 1, suspect, err) : status;
}

static CagStatus find_breaks(Face *f, int direction, CagError *err) {
  const CagSurface *s = f->surface;
  double *all;
  size_t n, count = 1;
  CagStatus status = cag_surface_cuts(s, direction, &all, &n, err);
  if (status) return status;
  const double from = all[0], to = all[n];
  // Breaks closer than this are merged: thinner cells are rounding.
  double thin = 1e-12 * (to - from);
  for (size_t k = 1; k < n; k++)
    if (all[k] > all[count - 1] + thin && all[k] < to - thin) all[count++] = all[k];
  all[count++] = to;
  f->breaks[direction] = all;
  f->break_count[direction] = count;
  return CAG_OK;
}

CagStatus cag_tess_plan_face(Tessellator *t, uint32_t face, CagError *err) {
  Face *f = &t->faces[face];
  f->leaf = t->leaf_count;
  for (int d = 0; d < 2; d++) {
    CagStatus status = find_breaks(f, d, err);
    if (status) return status;
  }
  for (size_t i = 0; i + 1 < f->break_count[0]; i++)
    for (size_t j = 0; j + 1 < f->break_count[1]; j++) {
      double from[2] = {f->breaks[0][i], f->breaks[1][j]},
             to[2] = {f->breaks[0][i + 1], f->breaks[1][j + 1]};
      CagStatus status = plan_leaf(t, face, from, to, 0, false, err);
      if (status) return status;
    }
  f->leaf_count = t->leaf_count - f->leaf;
  return CAG_OK;
}
