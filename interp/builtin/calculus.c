// Integrals, extremes and roots of a function of the script over a range.
//
// Methods: adaptive Gauss-Kronrod quadrature with 7 and 15 points (QUADPACK's QAG), and Brent's
// minimizer and root finder (Algorithms for Minimization without Derivatives, 1973). A range of
// angles calls the function with angles; inside, and in integrals, angles are then radians.

#include <float.h>
#include <string.h>

#include "interp/builtin/support.h"
#include "interp/vm/jet.h"

#define DEGREES_PER_RADIAN 57.29577951308232

// --- The function under study ---

typedef struct Subject {
  CagCall *call;
  CagValue function;
  double start, end; // degrees when angle
  bool angle;
} Subject;

static Subject subject(CagCall *call, CagValue f, CagRangeEnds range) {
  return (Subject){call, f, range.start, range.end, range.angle};
}

static bool check_finite(const Subject *f) {
  if (!isfinite(f->start) || !isfinite(f->end)) return cag_fail_value(f->call, 1, "a finite range");
  return f->start <= f->end ||
         cag_fail_value(f->call, 1, "a range whose start is not greater than its end");
}

static CagValue parameter(const Subject *f, double x) {
  return f->angle ? cag_angle(x) : cag_number(x);
}

static bool evaluate(const Subject *f, double x, CagValue *y) {
  CagValue argument = parameter(f, x);
  return cag_call(f->call->vm, f->function, &argument, 1, y);
}

static bool fail_result(const Subject *f, CagValue y, const char *expected) {
  if (cag_holds_jet(y)) return cag_fail_differentiate(f->call, 0);
  char found[120];
  return cag_fail_call(f->call, 0, CAG_ERR_type,
                       "expects a function that returns %s as `%s`, found one that returned %s",
                       expected, cag_parameter_name(f->call, 0),
                       cag_value_words(f->call->vm, y, found, sizeof found));
}

// The value as a number; of a function that gives angles their degrees.
static bool evaluate_number(const Subject *f, double x, double *y) {
  CagValue v;
  if (!evaluate(f, x, &v)) return false;
  *y = v.as.number;
  return v.type == CAG_NUMBER || v.type == CAG_ANGLE || fail_result(f, v, "numbers");
}

// --- integrate ---

// Kronrod's points of [-1, 1], from the outermost to the middle; every second one is Gauss's.
// (QUADPACK, qk15.)
enum { KRONROD = 8 };
static const double POINTS[KRONROD] = {
    0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
    0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
    0.586087235467691130294144691693013, 0.405845151377397166906606412076961,
    0.207784955007898467600689403773245, 0};
static const double KRONROD_WEIGHTS[KRONROD] = {
    0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
    0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
    0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
    0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
static const double GAUSS_WEIGHTS[KRONROD / 2] = {
    0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
    0.381830050505118944950369775488975, 0.417959183673469387755102040816327};

// The integrand may give vectors: they are integrated component by component.
enum { COMPONENTS_MOST = CAG_MAX_PACKED };

typedef struct Integrand {
  Subject subject;
  size_t components; // 0: not known before the first value
  bool vector;
  enum { BOTH_FINITE, END_INFINITE, START_INFINITE, BOTH_INFINITE } kind;
  double at_end[2 * KRONROD - 1]; // the weights that extrapolate a piece to its high end
} Integrand;

typedef struct Piece {
  double low, high;
  double value[COMPONENTS_MOST];
  double ends[2][COMPONENTS_MOST]; // of the polynomial through the points: low, high
  double error, magnitude;         // estimate; integral of the absolute value
  int doubted; // the end beside which a kink may be hidden: -1 low, 1 high; 0: neither
} Piece;

// The place x of the substitution's variable t, and dx/dt: t itself on a finite range; start + t/(1
// - t), end - t/(1 - t) on 0..1; t/(1 - t^2) on -1..1.
static double substituted(const Integrand *g, double t, double *slope) {
  double rest = 1 - t;
  switch (g->kind) {
  case END_INFINITE: *slope = 1 / (rest * rest); return g->subject.start + t / rest;
  case START_INFINITE: *slope = 1 / (rest * rest); return g->subject.end - t / rest;
  case BOTH_INFINITE: {
    double square = (1 - t) * (1 + t);
    *slope = (1 + t * t) / (square * square);
    return t / square;
  }
  default: *slope = 1; return t;
  }
}

static bool integrand_at(Integrand *g, double t, double *out) {
  double slope, x = substituted(g, t, &slope);
  const double *numbers;
  size_t n;
  CagValue y;
  if (!evaluate(&g->subject, x, &y)) return false;
  bool vector = cag_as_vector(y, &numbers, &n) && n <= COMPONENTS_MOST;
  if (!vector && y.type != CAG_NUMBER) return fail_result(&g->subject, y, "numbers or vectors");
  if (!vector) numbers = &y.as.number, n = 1;
  if (g->components == 0) {
    g->components = n;
    g->vector = vector;
  }
  if (n != g->components || vector != g->vector)
    return fail_result(&g->subject, y, "vectors of the same length, or numbers,");
  for (size_t k = 0; k < n; k++) out[k] = numbers[k] * slope;
  return true;
}

// Both rules on one piece.
static bool measure(Integrand *g, Piece *p) {
  double middle = 0.5 * (p->low + p->high), half = 0.5 * (p->high - p->low);
  double gauss[COMPONENTS_MOST] = {0}, y[COMPONENTS_MOST];
  memset(p->value, 0, sizeof p->value);
  memset(p->ends, 0, sizeof p->ends);
  p->error = p->magnitude = 0;
  for (int i = 0; i < 2 * KRONROD - 1; i++) {
    int k = i < KRONROD ? i : 2 * KRONROD - 2 - i;
    double t = middle + (i < KRONROD ? -half : half) * POINTS[k];
    if (!integrand_at(g, t, y)) return false;
    for (size_t c = 0; c < g->components; c++) {
      p->value[c] += half * KRONROD_WEIGHTS[k] * y[c];
      p->ends[0][c] += g->at_end[2 * KRONROD - 2 - i] * y[c];
      p->ends[1][c] += g->at_end[i] * y[c];
      if (k % 2 == 1) gauss[c] += half * GAUSS_WEIGHTS[k / 2] * y[c];
      p->magnitude += fabs(half * KRONROD_WEIGHTS[k] * y[c]);
    }
  }
  for (size_t c = 0; c < g->components; c++)
    p->error = fmax(p->error, fabs(p->value[c] - gauss[c]));
  // The difference of the rules is far larger than the error of the better one where both are good
  // (QUADPACK's estimate).
  static const double SCALE = 200;
  if (p->magnitude > 0 && p->error > 0) {
    double ratio = SCALE * p->error / p->magnitude;
    if (ratio < 1) p->error = fmin(p->error, p->magnitude * ratio * sqrt(ratio));
  }
  return true;
}

// A piece whose ends are neighbors, or whose error is that of rounding, is not divided.
static bool can_be_divided(const Piece *p, double narrowest) {
  static const double ROUNDING = 50 * DBL_EPSILON;
  double middle = 0.5 * (p->low + p->high);
  return middle > p->low && middle < p->high && p->high - p->low > narrowest &&
         p->error > ROUNDING * p->magnitude;
}

// The pieces lie in a list of the heap on top of the root stack, so that a run that ends within the
// function leaves nothing behind.
typedef struct Pieces {
  CagVm *vm;
  Piece *at;
  size_t count, capacity;
  double narrowest; // what is narrower is not divided
} Pieces;

enum { PIECES_FIRST = 32, PIECES_MOST = 4096 };

static void grow(Pieces *p, size_t capacity) {
  double *memory;
  CagValue list = cag_list_numbers(p->vm, capacity * sizeof(Piece) / sizeof(double), &memory);
  if (p->count > 0) {
    memcpy(memory, p->at, p->count * sizeof(Piece));
    cag_root_pop(p->vm, 1);
  }
  cag_root_push(p->vm, list);
  p->at = (Piece *)memory;
  p->capacity = capacity;
}

// What the pieces add up to, and the one to divide next; (size_t)-1: none can be.
typedef struct Survey {
  double error, size;
  double wanted,
      tolerable; // errors: with the latter the result is given when nothing can be divided
  size_t worst;
} Survey;

static Survey survey(const Integrand *g, const Pieces *pieces) {
  static const double RELATIVE = 1e-11, ROUNDING = 100 * DBL_EPSILON, FLOOR = 1e-300;
  static const double TOLERABLE = 1e-8;
  Survey s = {.worst = (size_t)-1};
  double magnitude = 0, total[COMPONENTS_MOST] = {0};
  for (size_t i = 0; i < pieces->count; i++) {
    const Piece *p = &pieces->at[i];
    s.error += p->error;
    magnitude += p->magnitude;
    for (size_t c = 0; c < g->components; c++) total[c] += p->value[c];
    bool worse = s.worst == (size_t)-1 || p->error > pieces->at[s.worst].error;
    if (worse && can_be_divided(p, pieces->narrowest)) s.worst = i;
  }
  for (size_t c = 0; c < g->components; c++) s.size = fmax(s.size, fabs(total[c]));
  // Where positive and negative parts cancel, their size bounds what rounding allows.
  s.wanted = fmax(fmax(RELATIVE * s.size, ROUNDING * magnitude), FLOOR);
  s.tolerable = fmax(TOLERABLE * magnitude, FLOOR);
  return s;
}

// --- Kinks beside the ends of pieces ---
//
// Between the ends of a piece and the rule's outermost points, a kink or a step is not seen. It is
// beside the place where a piece was divided if both parts have suddenly almost no error. Then the
// parts are divided again close to that place, until what may be hidden there is small enough. At
// the ends of the first pieces, the function is compared with what the points extrapolate to.

// From a piece's end to the outermost point, as a part of half its width.
#define BLIND (1 - POINTS[0])
// Where the function is compared, from the end as a part of the width.
#define PROBE 0x1p-36

// Lagrange's polynomials of the rule's points, from the lowest, at the high end.
static void fill_end_weights(double *weights) {
  enum { COUNT = 2 * KRONROD - 1 };
  double x[COUNT];
  for (int i = 0; i < COUNT; i++) x[i] = i < KRONROD ? -POINTS[i] : POINTS[COUNT - 1 - i];
  for (int i = 0; i < COUNT; i++) {
    weights[i] = 1;
    for (int k = 0; k < COUNT; k++)
      if (k != i) weights[i] *= (1 - 2 * PROBE - x[k]) / (x[i] - x[k]);
  }
}

// Looks at one end of a piece; *found: something is hidden there, and the piece is doubted.
static bool probe_end(Integrand *g, Piece *p, int end, double wanted, bool *found) {
  static const double ROUNDING = 1e-7;
  const double width = p->high - p->low;
  const double t = end ? p->high - PROBE * width : p->low + PROBE * width;
  double y[COMPONENTS_MOST], off = 0;
  if (t == p->low || t == p->high) return true;
  if (!integrand_at(g, t, y)) return false;
  for (size_t c = 0; c < g->components; c++) off = fmax(off, fabs(y[c] - p->ends[end][c]));
  const double hidden = off * BLIND * width / 2;
  *found = off * width > ROUNDING * p->magnitude && hidden > fmax(wanted, p->error);
  if (!*found) return true;
  p->doubted = end ? 1 : -1;
  p->error = hidden;
  return true;
}

// Looks at the ends of the first pieces, `middle` being that of both, unless they are too narrow.
static bool probe_ends(Integrand *g, Pieces *pieces, double middle, bool *found) {
  const double wanted = survey(g, pieces).wanted;
  double low = INFINITY, high = -INFINITY;
  for (size_t i = 0; i < pieces->count; i++) {
    low = fmin(low, pieces->at[i].low);
    high = fmax(high, pieces->at[i].high);
  }
  *found = false;
  for (size_t i = 0; i < pieces->count; i++)
    for (int end = 0; end < 2; end++) {
      Piece *p = &pieces->at[i];
      const double at = end ? p->high : p->low;
      bool one = false;
      if ((at != low && at != high && at != middle) || p->doubted ||
          p->high - p->low <= pieces->narrowest)
        continue;
      if (!probe_end(g, p, end, wanted, &one)) return false;
      *found |= one;
    }
  return true;
}

static void keep_doubts(const Piece *parent, Piece *low, Piece *high) {
  static const double SUDDEN = 1e-8, HIDDEN = 0.05;
  const double most = SUDDEN * parent->error;
  double share = HIDDEN;
  low->doubted = high->doubted = 0;
  if (parent->doubted == 0 && low->error <= most && high->error <= most) {
    low->doubted = 1;
    high->doubted = -1;
  } else if (parent->doubted != 0) {
    Piece *end = parent->doubted < 0 ? low : high;
    share = (end->high - end->low) / (parent->high - parent->low);
    if (end->error <= share * parent->error) end->doubted = parent->doubted;
  }
  if (low->doubted) low->error = fmax(low->error, share * parent->error);
  if (high->doubted) high->error = fmax(high->error, share * parent->error);
}

// Where to divide a piece.
static double cut_of(const Piece *p) {
  static const double NEAR = 0.125;
  const double width = p->high - p->low;
  return p->doubted < 0   ? p->low + NEAR * width
         : p->doubted > 0 ? p->high - NEAR * width
                          : 0.5 * (p->low + p->high);
}

// Divides the piece with the largest error until the sum of errors is small enough.
static bool refine(Integrand *g, Pieces *pieces) {
  for (;;) {
    Survey s = survey(g, pieces);
    if (s.error <= s.wanted) return true;
    if (s.worst == (size_t)-1 && s.error <= s.tolerable) return true;
    if (s.worst == (size_t)-1 || pieces->count == PIECES_MOST)
      return cag_fail_call(
          g->subject.call, 0, CAG_ERR_convergence,
          "does not converge: after %zu pieces, the error is still about %.2g of %.6g",
          pieces->count, s.error, s.size);
    if (pieces->count == pieces->capacity) grow(pieces, 2 * pieces->capacity);
    Piece *p = &pieces->at[s.worst], *q = &pieces->at[pieces->count++];
    const Piece parent = *p;
    p->high = cut_of(&parent);
    *q = (Piece){.low = p->high, .high = parent.high};
    if (!measure(g, p) || !measure(g, q)) return false;
    keep_doubts(&parent, p, q);
  }
}

static void choose_substitution(Integrand *g, double *low, double *high) {
  bool start = isinf(g->subject.start), end = isinf(g->subject.end);
  g->kind = start && end ? BOTH_INFINITE
            : start      ? START_INFINITE
            : end        ? END_INFINITE
                         : BOTH_FINITE;
  *low = g->kind == BOTH_FINITE ? g->subject.start : g->kind == BOTH_INFINITE ? -1 : 0;
  *high = g->kind == BOTH_FINITE ? g->subject.end : 1;
}

static bool integrate(Integrand *g, double sign, CagValue *result) {
  enum {
    FIRST = 2
  }; // their seam keeps the rule's points from falling in step with a symmetric function
  CagVm *vm = g->subject.call->vm;
  Pieces pieces = {.vm = vm};
  double low, high;
  choose_substitution(g, &low, &high);
  // A singularity that matters still in so small a part of the range has no integral.
  static const double SMALLEST_PART = 0x1p-150;
  pieces.narrowest = SMALLEST_PART * (high - low);
  grow(&pieces, PIECES_FIRST);
  pieces.count = FIRST;
  double middle = low + 0.5 * (high - low);
  pieces.at[0] = (Piece){.low = low, .high = middle};
  pieces.at[1] = (Piece){.low = middle, .high = high};
  fill_end_weights(g->at_end);
  bool doubtful = false;
  bool good = measure(g, &pieces.at[0]) && measure(g, &pieces.at[1]) && refine(g, &pieces) &&
              probe_ends(g, &pieces, middle, &doubtful) && (!doubtful || refine(g, &pieces));
  double scale = g->subject.angle ? sign / DEGREES_PER_RADIAN : sign, total[COMPONENTS_MOST] = {0};
  for (size_t i = 0; good && i < pieces.count; i++)
    for (size_t c = 0; c < g->components; c++) total[c] += scale * pieces.at[i].value[c];
  cag_root_pop(vm, 1);
  for (size_t c = 0; good && c < g->components; c++)
    if (!isfinite(total[c])) return cag_give_number(g->subject.call, total[c], result);
  if (good) *result = g->vector ? cag_vector(vm, total, g->components) : cag_number(total[0] + 0.0);
  return good;
}

bool cag_calculus_integrate(CagCall *call, const struct cag_calculus_integrate *a,
                            CagValue *result) {
  const double start = a->range.start, end = a->range.end, sign = start > end ? -1 : 1;
  Integrand g = {.subject = {call, a->f, fmin(start, end), fmax(start, end), a->range.angle}};
  if (g.subject.start == g.subject.end && isinf(g.subject.start))
    return cag_fail_value(call, 1, "a range with a finite part");
  return integrate(&g, sign, result);
}

// --- minimize, maximize ---

typedef struct Extreme {
  double x, y;
} Extreme;

// Brent's minimizer in [a, c] from the point m between them.
static bool brent_minimum(const Subject *f, double sign, double a, double c, Extreme *m) {
  static const double GOLDEN = 0.3819660112501051; // (3 - sqrt 5) / 2
  static const double RELATIVE = 1.5e-8; // root of the rounding error: a minimum is no sharper
  static const double ABSOLUTE = 1e-14;
  enum { STEPS_MOST = 200 };
  double x = m->x, fx = m->y, w = x, fw = fx, v = x, fv = fx, step = 0, before = 0;
  for (int i = 0; i < STEPS_MOST; i++) {
    double middle = 0.5 * (a + c), small = RELATIVE * fabs(x) + ABSOLUTE * fmax(1, fabs(c - a));
    if (fabs(x - middle) <= 2 * small - 0.5 * (c - a)) break;
    bool golden = true;
    if (fabs(before) > small) {
      // The vertex of the parabola through x, w, v, if it lies inside and moves less than half of
      // the step before last.
      double r = (x - w) * (fx - fv), q = (x - v) * (fx - fw), p = (x - v) * q - (x - w) * r;
      q = 2 * (q - r);
      if (q > 0) p = -p;
      q = fabs(q);
      if (fabs(p) < fabs(0.5 * q * before) && p > q * (a - x) && p < q * (c - x)) {
        before = step;
        step = p / q;
        double u = x + step;
        if (u - a < 2 * small || c - u < 2 * small) step = copysign(small, middle - x);
        golden = false;
      }
    }
    if (golden) {
      before = x < middle ? c - x : a - x;
      step = GOLDEN * before;
    }
    double u = x + (fabs(step) >= small ? step : copysign(small, step)), fu;
    if (!evaluate_number(f, u, &fu)) return false;
    fu *= sign;
    if (fu <= fx) {
      if (u < x) c = x;
      else a = x;
      v = w, fv = fw, w = x, fw = fx, x = u, fx = fu;
      continue;
    }
    if (u < x) a = u;
    else c = u;
    if (fu <= fw || w == x) v = w, fv = fw, w = u, fw = fu;
    else if (fu <= fv || v == x || v == w) v = u, fv = fu;
  }
  *m = (Extreme){x, fx};
  return true;
}

// The least value of sign * f: a scan in equal steps, then Brent's method about each of the lowest
// valleys that the scan shows.
static bool least(Subject f, double sign, CagValue *result) {
  enum { SCAN = 128, VALLEYS = 4 };
  double y[SCAN + 1];
  bool taken[SCAN + 1] = {false};
  if (!check_finite(&f)) return false;
  double width = f.end - f.start;
  for (int i = 0; i <= SCAN; i++) {
    double x = i == SCAN ? f.end : f.start + width * i / SCAN;
    if (!evaluate_number(&f, x, &y[i])) return false;
    y[i] *= sign;
  }
  Extreme best = {f.start, y[0]};
  if (y[SCAN] < best.y) best = (Extreme){f.end, y[SCAN]};
  for (int valley = 0; valley < VALLEYS && width > 0; valley++) {
    int lowest = -1;
    for (int i = 0; i <= SCAN; i++) {
      bool bottom = (i == 0 || y[i] <= y[i - 1]) && (i == SCAN || y[i] <= y[i + 1]);
      if (bottom && !taken[i] && (lowest < 0 || y[i] < y[lowest])) lowest = i;
    }
    if (lowest < 0) break;
    taken[lowest] = true;
    int left = lowest > 0 ? lowest - 1 : 0, right = lowest < SCAN ? lowest + 1 : SCAN;
    double low = f.start + width * left / SCAN,
           high = right == SCAN ? f.end : f.start + width * right / SCAN;
    Extreme m = {lowest == SCAN ? f.end : f.start + width * lowest / SCAN, y[lowest]};
    if (m.y < best.y) best = m;
    if (!brent_minimum(&f, sign, low, high, &m)) return false;
    if (m.y < best.y) best = m;
  }
  CagValue value;
  if (!evaluate(&f, best.x, &value)) return false;
  CagValue pair[] = {parameter(&f, best.x), value};
  *result = cag_list_values(f.call->vm, pair, 2);
  return true;
}

bool cag_calculus_minimize(CagCall *call, const struct cag_calculus_minimize *a, CagValue *result) {
  return least(subject(call, a->f, a->range), 1, result);
}

bool cag_calculus_maximize(CagCall *call, const struct cag_calculus_maximize *a, CagValue *result) {
  return least(subject(call, a->f, a->range), -1, result);
}

// --- find_root ---

static bool fail_same_sign(const Subject *f, double fa, double fb) {
  CagString s = {0};
  CagVm *vm = f->call->vm;
  cag_string_printf(&s, "needs a change of sign over the range: f(");
  cag_print_value(vm, &s, parameter(f, f->start), true);
  cag_string_printf(&s, ") = ");
  cag_print_number(&s, fa);
  cag_string_printf(&s, " and f(");
  cag_print_value(vm, &s, parameter(f, f->end), true);
  cag_string_printf(&s, ") = ");
  cag_print_number(&s, fb);
  cag_string_add(&s, "", 1);
  cag_fail_call(f->call, 1, CAG_ERR_convergence, "%s", s.bytes);
  cag_string_free(&s);
  return false;
}

// Brent's root finder: b is the best place, the root lies between b and c, a was the b before.
static bool brent_root(const Subject *f, double a, double fa, double b, double fb, double *root) {
  enum { STEPS_MOST = 1000 };
  // Of a root at 0 so much of the range is good enough.
  static const double PART = 1e-4 * DBL_EPSILON;
  double least_step = PART * fabs(b - a);
  double c = a, fc = fa, step = b - a, before = step;
  for (int i = 0; i < STEPS_MOST; i++) {
    if ((fb > 0) == (fc > 0)) c = a, fc = fa, step = before = b - a;
    if (fabs(fc) < fabs(fb)) a = b, b = c, c = a, fa = fb, fb = fc, fc = fa;
    double small = 2 * DBL_EPSILON * fabs(b) + least_step, half = 0.5 * (c - b);
    *root = b;
    if (fabs(half) <= small || fb == 0) return true;
    if (fabs(before) >= small && fabs(fa) > fabs(fb)) {
      // Secant, or inverse quadratic interpolation.
      double s = fb / fa, p, q;
      if (a == c) p = 2 * half * s, q = 1 - s;
      else {
        double u = fa / fc, r = fb / fc;
        p = s * (2 * half * u * (u - r) - (b - a) * (r - 1));
        q = (u - 1) * (r - 1) * (s - 1);
      }
      if (p > 0) q = -q;
      p = fabs(p);
      bool good = 2 * p < fmin(3 * half * q - fabs(small * q), fabs(before * q));
      before = good ? step : half;
      step = good ? p / q : half;
    } else {
      step = before = half;
    }
    a = b, fa = fb;
    b += fabs(step) > small ? step : copysign(small, half);
    if (!evaluate_number(f, b, &fb)) return false;
  }
  return cag_fail_call(f->call, 0, CAG_ERR_convergence, "does not converge within %d steps",
                       STEPS_MOST);
}

bool cag_calculus_find_root(CagCall *call, const struct cag_calculus_find_root *a,
                            CagValue *result) {
  const Subject f = subject(call, a->f, a->range);
  double fa, fb, root;
  if (!check_finite(&f)) return false;
  if (!evaluate_number(&f, f.start, &fa) || !evaluate_number(&f, f.end, &fb)) return false;
  if (fa == 0) root = f.start;
  else if (fb == 0) root = f.end;
  else if ((fa > 0) == (fb > 0)) return fail_same_sign(&f, fa, fb);
  else if (!brent_root(&f, f.start, fa, f.end, fb, &root)) return false;
  *result = parameter(&f, root + 0.0);
  return true;
}
