// Points at which the speed, the curvature, or the torsion of a curve vanishes.
//
// Each is a zero of a function of the derivatives that is smooth on each piece: w = C', C' x C'',
// (C' C'' C'''). Its square has a minimum there, so w . w' changes sign upward. That is bracketed
// on steps so small that a cubic through the ends of each approximates w, and the bracket is
// bisected.

#include <stdlib.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/curve/family.h"
#include "geom/curve/frenet.h"

// A function vanishes along a piece if it is below this fraction of its natural size, and at a
// point if it is below this fraction of its maximum on the piece.
#define NOTHING 1e-10
#define NOTHING_HERE 1e-8
// Points closer than this fraction of the piece are identical: the accuracy of zeros of high order.
#define SAME 1e-5
// Minimum number of steps per piece, maximum number of halvings of a step, tolerance of the cubic,
// and subdivisions of a step that are searched.
#define STEPS 32
#define HALVINGS 8
#define MISSES 1e-3
#define PARTS 8
// Enough bisections for all digits of a double.
#define BISECTIONS 80

typedef struct Search {
  const CagCurve *curve;
  CagVanishing kind;
  double start, end; // of the piece
  double largest;    // |w| of the piece
  double maxima[3];  // of the derivatives 1..3 on the whole curve
  CagSpecialPoints *found;
  CagError *err;
} Search;

typedef struct Sample {
  double t;
  CagVec3 w, slope;
} Sample;

static CagStatus add(CagParameters *list, double t, CagError *err) {
  if (!CAG_RESERVE(list->t, list->capacity, list->count + 1)) return cag_fail_memory(err);
  list->t[list->count++] = t;
  return CAG_OK;
}

static CagStatus sample(const Search *s, double t, Sample *out) {
  CagVec3 d[5];
  const CagSide side = t >= s->end ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
  CagStatus status = cag_curve_eval(s->curve, t, (int)s->kind + 2, side, d, s->err);
  if (status) return status;
  out->t = t;
  if (s->kind == CAG_STANDS) {
    out->w = d[1];
    out->slope = d[2];
  } else if (s->kind == CAG_STRAIGHT) {
    out->w = cag_cross(d[1], d[2]);
    out->slope = cag_cross(d[1], d[3]);
  } else {
    const CagVec3 cross = cag_cross(d[1], d[2]);
    out->w = cag_vec3(cag_dot(cross, d[3]), 0, 0);
    out->slope = cag_vec3(cag_dot(cross, d[4]), 0, 0);
  }
  return CAG_OK;
}

static double rise(const Sample *x) { return cag_dot(x->w, x->slope); }

// --- Points ---

static bool known(const Search *s, double t) {
  const double reach = SAME * (s->end - s->start);
  for (int k = 0; k <= (int)s->kind; k++) {
    const CagParameters *list = &s->found->points[k];
    for (size_t i = 0; i < list->count; i++)
      if (fabs(list->t[i] - t) <= reach) return true;
  }
  return false;
}

static CagStatus judge(const Search *s, const Sample *x) {
  if (cag_norm(x->w) > NOTHING_HERE * s->largest || known(s, x->t)) return CAG_OK;
  return add(&s->found->points[s->kind], x->t, s->err);
}

static CagStatus bisect(const Search *s, Sample low, Sample high) {
  for (int i = 0; i < BISECTIONS; i++) {
    Sample middle;
    const double t = low.t + (high.t - low.t) / 2;
    if (t <= low.t || t >= high.t) break;
    CagStatus status = sample(s, t, &middle);
    if (status) return status;
    *(rise(&middle) < 0 ? &low : &high) = middle;
  }
  return judge(s, cag_norm(low.w) < cag_norm(high.w) ? &low : &high);
}

// Searches all subdivisions of a step on which the cubic is accurate.
static CagStatus search_parts(const Search *s, Sample low, const Sample *end) {
  const double start = low.t;
  for (int i = 1; i <= PARTS; i++) {
    Sample high = *end;
    CagStatus status = CAG_OK;
    if (i < PARTS) status = sample(s, start + (end->t - start) * i / PARTS, &high);
    // At an exact zero the rise is 0; it ends the part before it.
    if (!status && rise(&low) < 0 && rise(&high) >= 0) status = bisect(s, low, high);
    if (status) return status;
    low = high;
  }
  return CAG_OK;
}

// Whether the cubic with the values and slopes at the ends is near w at the middle.
static bool followed(const Sample *a, const Sample *b, const Sample *middle) {
  const CagVec3 mean = cag_scaled(cag_add(a->w, b->w), 0.5);
  const CagVec3 cubic = cag_madd(mean, (b->t - a->t) / 8, cag_sub(a->slope, b->slope));
  const double scale = fmax(fmax(cag_norm(a->w), cag_norm(b->w)), cag_norm(middle->w));
  return cag_norm(cag_sub(cubic, middle->w)) <= MISSES * scale;
}

static CagStatus search_step(const Search *s, const Sample *a, const Sample *b, int halvings) {
  Sample middle;
  CagStatus status = sample(s, a->t + (b->t - a->t) / 2, &middle);
  if (status) return status;
  // With zeros at both ends of a small step, the cubic cannot be verified.
  if (halvings == 0 || followed(a, b, &middle)) return search_parts(s, *a, b);
  status = search_step(s, a, &middle, halvings - 1);
  return status ? status : search_step(s, &middle, b, halvings - 1);
}

// --- Pieces ---

static double step_at(const Search *s, int i) {
  return i == STEPS ? s->end : s->start + (s->end - s->start) * i / STEPS;
}

// Natural size of w, for derivatives that do not nearly vanish.
static double natural_size(const Search *s) {
  const double length = s->curve->end - s->curve->start;
  const double second = fmax(s->maxima[1], s->maxima[0] / length);
  const double third = fmax(s->maxima[2], second / length);
  return s->maxima[0] * (s->kind >= CAG_STRAIGHT ? second : 1) * (s->kind == CAG_FLAT ? third : 1);
}

static bool in_stretch(const Search *s, CagVanishing kind) {
  const CagParameters *list = &s->found->stretches[kind];
  for (size_t i = 0; i + 1 < list->count; i += 2)
    if (list->t[i] <= s->start && list->t[i + 1] >= s->end) return true;
  return false;
}

static CagStatus search_piece(Search *s) {
  Sample x[STEPS + 1];
  for (int k = 0; k < (int)s->kind; k++)
    if (in_stretch(s, (CagVanishing)k)) return CAG_OK;
  s->largest = 0;
  for (int i = 0; i <= STEPS; i++) {
    CagStatus status = sample(s, step_at(s, i), &x[i]);
    if (status) return status;
    s->largest = fmax(s->largest, cag_norm(x[i].w));
  }
  if (s->largest <= NOTHING * natural_size(s)) {
    CagStatus status = add(&s->found->stretches[s->kind], s->start, s->err);
    return status ? status : add(&s->found->stretches[s->kind], s->end, s->err);
  }
  CagStatus status = judge(s, &x[0]);
  for (int i = 0; !status && i < STEPS; i++) status = search_step(s, &x[i], &x[i + 1], HALVINGS);
  return status ? status : judge(s, &x[STEPS]);
}

static CagStatus measure(Search *s) {
  for (int i = 0; i <= STEPS; i++) {
    CagVec3 d[4];
    const CagSide side = i == STEPS ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
    CagStatus status = cag_curve_eval(s->curve, step_at(s, i), 3, side, d, s->err);
    if (status) return status;
    for (int k = 0; k < 3; k++) s->maxima[k] = fmax(s->maxima[k], cag_norm(d[k + 1]));
  }
  return CAG_OK;
}

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static CagStatus search_all(Search *s, const double *cuts, size_t n) {
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i + 1 < n; i++) {
    s->start = cuts[i];
    s->end = cuts[i + 1];
    status = measure(s);
  }
  for (int k = 0; !status && k < CAG_VANISHINGS; k++) {
    s->kind = (CagVanishing)k;
    bool planar = false;
    if (k == CAG_FLAT) status = cag_curve_is_planar(s->curve, &planar, NULL, s->err);
    if (planar) {
      status = add(&s->found->stretches[k], s->curve->start, s->err);
      if (!status) status = add(&s->found->stretches[k], s->curve->end, s->err);
      continue;
    }
    for (size_t i = 0; !status && i + 1 < n; i++) {
      s->start = cuts[i];
      s->end = cuts[i + 1];
      status = search_piece(s);
    }
    CagParameters *list = &s->found->points[k];
    if (list->count) qsort(list->t, list->count, sizeof *list->t, ascending);
  }
  return status;
}

CagStatus cag_curve_special_points(const CagCurve *c, CagSpecialPoints *out, CagError *err) {
  double *cuts;
  size_t n;
  *out = (CagSpecialPoints){0};
  CagStatus status = cag_curve_cuts(c, &cuts, &n, err);
  if (status) return status;
  Search s = {.curve = c, .found = out, .err = err};
  status = search_all(&s, cuts, n);
  cag_free(cuts);
  return status;
}

void cag_special_points_free(CagSpecialPoints *s) {
  for (int k = 0; k < CAG_VANISHINGS; k++) {
    cag_free(s->points[k].t);
    cag_free(s->stretches[k].t);
  }
}
