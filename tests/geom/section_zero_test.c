// Plane sections of graphs of polynomials with known zeros: small loops, tips that barely cross an
// edge, and branches that cross, touch, or almost meet.

#include "tests/geom/polynomial_support.h"

#include "geom/meet/section.h"

typedef struct Zeros {
  const char *name;
  Polynomial p;
  int count, closed; // curves
  double length;
  bool doubled; // zeros of the second order
} Zeros;

// The length inside the square of the line through (x, y) with this direction.
static double clipped(double x, double y, double dx, double dy) {
  double lo = -INFINITY, hi = INFINITY;
  const double at[2] = {x, y}, way[2] = {dx, dy};
  for (int k = 0; k < 2; k++) {
    if (way[k] == 0) continue;
    const double a = -at[k] / way[k], b = (1 - at[k]) / way[k];
    lo = fmax(lo, fmin(a, b));
    hi = fmin(hi, fmax(a, b));
  }
  return (hi - lo) * hypot(dx, dy);
}

// The length of both branches of (x - x0) (y - y0) = e inside the square.
static double hyperbola_length(double x0, double y0, double e) {
  enum { STEPS = 4000 };
  double length = 0;
  for (int side = -1; side < 2; side += 2) {
    const double wide = side > 0 ? 1 - x0 : x0;
    const double high = (side > 0) == (e > 0) ? 1 - y0 : y0;
    // From where y leaves the square to where x does.
    const double from = log(fabs(e) / high), to = log(wide);
    double last_x = exp(from), last_y = fabs(e) / last_x;
    for (int i = 1; i <= STEPS; i++) {
      const double x = exp(from + (to - from) * i / STEPS), y = fabs(e) / x;
      length += hypot(x - last_x, y - last_y);
      last_x = x;
      last_y = y;
    }
  }
  return length;
}

enum { KINDS = 12 };

static Zeros some_zeros(int kind) {
  const double x = uniform(0.25, 0.75), y = uniform(0.25, 0.75), slope = uniform(-0.9, 0.9);
  const double small = pow(10, uniform(-3, -1)), r = uniform(0.12, 0.22), other = slope - 1.7;
  const Polynomial line = slanted(x, y, slope), second = slanted(x, y, other),
                   loop = circle(x, y, r), tiny = circle(x, y, small), a = line_x(x), b = line_y(y),
                   one = {{{1}}};
  // A line through (x, y) has the direction (-slope, 1).
  const double line_length = clipped(x, y, -slope, 1);
  switch (kind) {
  case 0: return (Zeros){"line", line, 1, 0, line_length, false};
  case 1: return (Zeros){"small loop", tiny, 1, 1, 2 * M_PI * small, false};
  case 2: {
    // The tip of a circle whose center is beyond an edge extends this far into the square.
    const double tip = pow(10, uniform(-6, -2)), wide = uniform(0.05, 0.3), far = tip - wide;
    const int edge = (int)uniform(0, 4);
    const double cx = edge == 0 ? far : edge == 1 ? 1 - far : x;
    const double cy = edge == 2 ? far : edge == 3 ? 1 - far : y;
    return (Zeros){"tip", circle(cx, cy, wide), 1, 0, 2 * wide * acos(-far / wide), false};
  }
  case 3:
    return (Zeros){
        "two lines", product(&line, &second), 2, 0, line_length + clipped(x, y, -other, 1), false};
  case 4: // through the circle's center, so they cross twice
    return (Zeros){
        "circle and line", product(&loop, &line), 2, 1, line_length + 2 * M_PI * r, false};
  case 5: return (Zeros){"double line", product(&line, &line), 1, 0, line_length, true};
  case 6: return (Zeros){"double circle", product(&loop, &loop), 1, 1, 2 * M_PI * r, true};
  case 7: {
    const double e = pow(10, uniform(-7, -2)) * (uniform(-1, 1) < 0 ? -1 : 1);
    const Polynomial saddle = product(&a, &b);
    return (Zeros){"hyperbola", sum(&saddle, &one, -e), 2, 0, hyperbola_length(x, y, e), false};
  }
  case 11: // through nodes of the tracing grid
    return (Zeros){"middle line", line_x(0.25 * floor(uniform(1, 4))), 1, 0, 1, false};
  case 8: return (Zeros){"none", sum(&loop, &one, 0.2), 0, 0, 0, false};
  case 9: {
    const Polynomial beside = circle(x > 0.5 ? x - 0.21 : x + 0.21, y, small);
    return (Zeros){"two loops", product(&beside, &tiny), 2, 2, 4 * M_PI * small, false};
  }
  default: {
    const double turn = uniform(0.3, 0.6);
    const Polynomial p = slanted(turn, 0, 0.3), q = slanted(turn + 0.15, 0, 0.3);
    return (Zeros){"parallel lines",
                   product(&p, &q),
                   2,
                   0,
                   clipped(turn, 0, -0.3, 1) + clipped(turn + 0.15, 0, -0.3, 1),
                   false};
  }
  }
}

static void sections_are_the_zeros_of_polynomials(void **state) {
  (void)state;
  seed = 63;
  for (int round = 0; round < 4 * KINDS; round++) {
    const Zeros is = some_zeros(round % KINDS);
    CagTransform turn, move, back;
    OK(cag_rotate(direction(), uniform(0, 6), direction(), &turn, &err));
    move = cag_translate(direction());
    move = cag_transform_multiply(&turn, &move);
    OK(cag_transform_inverse(&move, &back, &err));
    double per[2];
    for (int k = 0; k < 2; k++) per[k] = pow(10, floor(uniform(-3, 4)));
    Polynomial p = is.p;
    const double factor = uniform(0.5, 2) * (round % 2 ? 1 : -1);
    for (int i = 0; i < SIDE * SIDE; i++) p.c[i / SIDE][i % SIDE] *= factor;
    CagSurface *s = graph(&p, per, &move);
    const CagPlane plane = {cag_transform_point(&move, cag_vec3(0.3, 0.2, 0)),
                            cag_transform_vector(&move, cag_vec3(0, 0, 1))};
    CagCurveList list = {0};
    OK(cag_surface_section(s, &plane, 0, &list, &err));
    double length = 0;
    int closed = 0;
    for (size_t i = 0; i < list.count; i++) {
      const CagCurve *c = list.items[i];
      double own;
      OK(cag_curve_length(c, c->start, c->end, &own, &err));
      length += own;
      closed += c->closed;
      for (int k = 0; k <= 24; k++) {
        CagVec3 q;
        OK(cag_curve_point(c, c->start + (c->end - c->start) * k / 24, &q, &err));
        q = cag_transform_point(&back, q);
        // The polynomial changes by at most a few times the distance.
        if (!(fabs(q.z) < 1e-5) || !(fabs(value(&is.p, q.x, q.y)) < 2e-5))
          fail_msg("round %d, %s: [%g %g %g] is off by %g", round, is.name, q.x, q.y, q.z,
                   value(&is.p, q.x, q.y));
        const double edge = fmin(fmin(fabs(q.x), fabs(1 - q.x)), fmin(fabs(q.y), fabs(1 - q.y)));
        if ((k == 0 || k == 24) && !c->closed) NEAR(edge, 0, is.doubled ? 1e-6 : 1e-9);
      }
    }
    if ((int)list.count != is.count || closed != is.closed ||
        !(fabs(length - is.length) <= 1e-3 * is.length))
      fail_msg("round %d, %s: %zu curves of length %g, %d closed, not %d of %g, %d closed", round,
               is.name, list.count, length, closed, is.count, is.length, is.closed);
    cag_curve_list_free(&list);
    cag_surface_release(s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sections_are_the_zeros_of_polynomials),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
