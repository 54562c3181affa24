// Knot and degree changes do not change the functions of nets. Values are computed by the Cox-de
// Boor recursion, implemented here from its definition.

#include "geom/surface/net.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

enum { MOST_WIDTH = 5, MOST_KNOTS = 64, PLACES = 23 };

static int whole(int from, int to) { return from + (int)uniform(0, to + 1 - from); }

// Basis function i of degree p. If `left` is set, the interval is closed on the right instead.
static double basis(const double *knots, size_t i, int p, double t, bool left) {
  if (p == 0) return left ? knots[i] < t && t <= knots[i + 1] : knots[i] <= t && t < knots[i + 1];
  const double up = knots[i + (size_t)p] - knots[i];
  const double down = knots[i + (size_t)p + 1] - knots[i + 1];
  double sum = 0;
  if (up > 0) sum += (t - knots[i]) / up * basis(knots, i, p - 1, t, left);
  if (down > 0) sum += (knots[i + (size_t)p + 1] - t) / down * basis(knots, i + 1, p - 1, t, left);
  return sum;
}

static void value(const CagNet *net, double t, bool left, double *out) {
  for (size_t c = 0; c < net->width; c++) out[c] = 0;
  for (size_t i = 0; i < net->count; i++) {
    const double b = basis(net->knots, i, net->degree, t, left);
    for (size_t c = 0; c < net->width; c++) out[c] += b * net->data[i * net->width + c];
  }
}

static size_t knot_count(const CagNet *net) { return net->count + (size_t)net->degree + 1; }

// Up to 4 inner knots of any multiplicity up to the degree, with clamped or unclamped ends.
static CagNet random_net(int degree, double start, double end) {
  double knots[MOST_KNOTS];
  size_t n = 0;
  const bool open[2] = {whole(0, 2) > 0, whole(0, 2) > 0};
  const int inner = whole(0, 4);
  double at[6];
  for (int i = 0; i < inner; i++) at[i] = uniform(start, end);
  for (int i = 0; i < inner; i++)
    for (int j = i + 1; j < inner; j++)
      if (at[j] < at[i]) {
        const double keep = at[i];
        at[i] = at[j];
        at[j] = keep;
      }
  for (int i = 0; i <= degree; i++)
    knots[n++] = open[0] ? start : start - 0.3 * (end - start) * (degree - i);
  for (int i = 0; i < inner; i++) {
    const int times = whole(1, degree);
    for (int k = 0; k < times; k++) knots[n++] = at[i];
  }
  for (int i = 0; i <= degree; i++) knots[n++] = open[1] ? end : end + 0.3 * (end - start) * i;
  CagNet net;
  OK(cag_net_new(degree, n - (size_t)degree - 1, (size_t)whole(1, MOST_WIDTH), &net, &err));
  memcpy(net.knots, knots, n * sizeof *knots);
  for (size_t i = 0; i < net.count * net.width; i++) net.data[i] = uniform(-1, 1);
  return net;
}

static CagNet copy_of(const CagNet *net) {
  CagNet out;
  OK(cag_net_new(net->degree, net->count, net->width, &out, &err));
  memcpy(out.knots, net->knots, knot_count(net) * sizeof *out.knots);
  memcpy(out.data, net->data, net->count * net->width * sizeof *out.data);
  return out;
}

// Checks that both have the same values: the first over [a, b], whose b may be the end of its
// domain, and the second over the mapped range [c, d].
static void assert_same(const CagNet *x, double a, double b, const CagNet *y, double c, double d) {
  assert_int_equal(x->width, y->width);
  for (int i = 0; i < PLACES; i++) {
    double p[MOST_WIDTH], q[MOST_WIDTH];
    const double f = i / (PLACES - 1.0);
    const bool last = i == PLACES - 1;
    value(x, last ? b : a + f * (b - a), d < c ? i > 0 : last, p);
    value(y, last ? d : c + f * (d - c), d < c ? i == 0 : last, q);
    for (size_t k = 0; k < x->width; k++) NEAR(p[k], q[k], 1e-11);
  }
}

static int times_of(const CagNet *net, double t) {
  int times = 0;
  for (size_t i = 0; i < knot_count(net); i++) times += net->knots[i] == t;
  return times;
}

static void inserted_knots_keep_the_values(void **state) {
  (void)state;
  seed = 1;
  for (int round = 0; round < 300; round++) {
    const double start = uniform(-2, 2), end = start + uniform(0.5, 3);
    CagNet net = random_net(whole(1, 6), start, end), old = copy_of(&net);
    double t = uniform(start, end);
    double wanted = t;
    if (round % 3 == 0) {
      // An existing knot, or one within a billionth of the domain beside it.
      wanted = net.knots[(size_t)whole(net.degree, (int)net.count)];
      t = wanted + (round % 2 ? 0 : 4e-10 * (end - start));
    }
    const int times = times_of(&net, wanted);
    assert_int_equal(cag_net_multiplicity(&net, t), times);
    assert_int_equal(cag_net_multiplicity(&net, wanted + 2e-9 * (end - start)), 0);
    if (times < net.degree) {
      OK(cag_net_insert(&net, t, &err));
      assert_int_equal(net.count, old.count + 1);
      assert_int_equal(times_of(&net, wanted), times + 1);
      for (size_t i = 1; i < knot_count(&net); i++) assert_true(net.knots[i] >= net.knots[i - 1]);
      for (size_t i = 0; i < knot_count(&old); i++)
        assert_int_equal(times_of(&net, old.knots[i]),
                         times_of(&old, old.knots[i]) + (old.knots[i] == wanted));
      assert_same(&old, start, end, &net, start, end);
      if (wanted > start && wanted < end) {
        // Removing the knot restores the old net.
        OK(cag_net_drop(&net, wanted, &err));
        assert_int_equal(net.count, old.count);
        assert_memory_equal(net.knots, old.knots, knot_count(&old) * sizeof *old.knots);
        for (size_t i = 0; i < net.count * net.width; i++) NEAR(net.data[i], old.data[i], 1e-7);
      }
    }
    cag_net_free(&net);
    cag_net_free(&old);
  }
}

static void a_part_has_the_values_and_is_clamped(void **state) {
  (void)state;
  seed = 2;
  for (int round = 0; round < 300; round++) {
    const double start = uniform(-2, 2), end = start + uniform(0.5, 3);
    CagNet net = random_net(whole(1, 4), start, end), old = copy_of(&net);
    const size_t p = (size_t)net.degree;
    double a = start, b = end;
    if (round % 4 > 0) a = uniform(start, start + 0.5 * (end - start));
    if (round % 4 > 1) b = uniform(a + 0.1 * (end - a), end);
    // Between knots, or parameters that are knots up to rounding.
    if (round % 4 == 3) {
      const double from = net.knots[p + (size_t)whole(0, (int)(net.count - p) / 2)];
      if (from < b - 1e-3) a = from;
    }
    if (round % 5 == 0) b += 1e-14 * (end - start);
    if (round % 7 == 0) a += 1e-14 * (end - start);
    OK(cag_net_trim(&net, a, b, &err));
    assert_true(cag_net_end(&net) == b);
    assert_int_equal(net.degree, p);
    for (size_t i = 0; i <= p; i++) {
      assert_true(net.knots[i] == a);
      assert_true(net.knots[net.count + i] == b);
    }
    const double near = 1e-9 * (end - start);
    for (size_t i = 0; i < knot_count(&old); i++) {
      const double t = old.knots[i];
      if (t > a + near && t < b - near) assert_int_equal(times_of(&net, t), times_of(&old, t));
    }
    for (size_t i = p + 1; i < net.count; i++)
      assert_true(net.knots[i] > a + near && net.knots[i] < b - near &&
                  times_of(&old, net.knots[i]) > 0);
    assert_same(&old, fmax(a, start), fmin(b, end), &net, a, b);
    cag_net_free(&net);
    cag_net_free(&old);
  }
}

static void raised_degrees_keep_values_and_smoothness(void **state) {
  (void)state;
  seed = 3;
  for (int round = 0; round < 200; round++) {
    const double start = uniform(-2, 2), end = start + uniform(0.5, 3);
    CagNet net = random_net(whole(1, 4), start, end), old = copy_of(&net);
    OK(cag_net_raise(&net, &err));
    const size_t p = (size_t)net.degree;
    assert_int_equal(p, old.degree + 1);
    assert_int_equal(times_of(&net, start), p + 1);
    assert_int_equal(times_of(&net, end), p + 1);
    size_t count = p + 1;
    for (size_t i = 0; i < knot_count(&old); i++) {
      const double t = old.knots[i];
      if (!(t > start && t < end)) continue;
      assert_int_equal(times_of(&net, t), times_of(&old, t) + 1);
      count += 1 + (t != old.knots[i - 1]);
    }
    assert_int_equal(net.count, count);
    assert_same(&old, start, end, &net, start, end);
    cag_net_free(&net);
    cag_net_free(&old);
  }
  // Disconnected pieces do not have a common higher degree.
  CagNet net;
  OK(cag_net_new(1, 4, 1, &net, &err));
  const double knots[] = {0, 0, 0.5, 0.5, 1, 1}, data[] = {1, 2, 3, 4};
  memcpy(net.knots, knots, sizeof knots);
  memcpy(net.data, data, sizeof data);
  FAILS(cag_net_raise(&net, &err), "knot-multiplicity");
  cag_net_free(&net);
}

static void nets_get_one_degree_and_knot_vector(void **state) {
  (void)state;
  seed = 4;
  for (int round = 0; round < 60; round++) {
    CagNet nets[3], old[3];
    const size_t n = (size_t)whole(1, 3);
    int degree = 0;
    for (size_t i = 0; i < n; i++) {
      nets[i] = random_net(whole(1, 3), 0, 1);
      OK(cag_net_trim(&nets[i], 0, 1, &err));
      if (i > 0 && nets[0].count > (size_t)nets[0].degree + 1) {
        // A knot that all of them have.
        const double t = nets[0].knots[nets[0].degree + 1];
        if (cag_net_multiplicity(&nets[i], t) == 0) OK(cag_net_insert(&nets[i], t, &err));
      }
      old[i] = copy_of(&nets[i]);
      if (old[i].degree > degree) degree = old[i].degree;
    }
    OK(cag_nets_unify(nets, n, &err));
    for (size_t i = 0; i < n; i++) {
      assert_int_equal(nets[i].degree, degree);
      assert_int_equal(nets[i].count, nets[0].count);
      assert_memory_equal(nets[i].knots, nets[0].knots, knot_count(&nets[0]) * sizeof(double));
      assert_same(&old[i], 0, 1, &nets[i], 0, 1);
    }
    // No knot has a higher multiplicity than one of them needs.
    for (size_t k = 0; k < knot_count(&nets[0]); k++) {
      const double t = nets[0].knots[k];
      int most = 0;
      for (size_t i = 0; i < n; i++) {
        const int times = cag_net_multiplicity(&old[i], t);
        if (times > 0 && times + degree - old[i].degree > most)
          most = times + degree - old[i].degree;
      }
      assert_int_equal(times_of(&nets[0], t), most);
    }
    for (size_t i = 0; i < n; i++) {
      cag_net_free(&nets[i]);
      cag_net_free(&old[i]);
    }
  }
}

static void ranges_move_and_turn_round(void **state) {
  (void)state;
  seed = 5;
  for (int round = 0; round < 100; round++) {
    const double start = uniform(-2, 2), end = start + uniform(0.5, 3);
    CagNet net = random_net(whole(1, 4), start, end), old = copy_of(&net);
    const double a = uniform(-5, 5), b = a + uniform(0.1, 9);
    cag_net_rescale(&net, a, b);
    assert_true(cag_net_start(&net) == a && cag_net_end(&net) == b);
    assert_same(&old, start, end, &net, a, b);
    cag_net_free(&net);
    net = copy_of(&old);
    cag_net_reverse(&net);
    NEAR(cag_net_start(&net), start, 1e-15 * 5);
    NEAR(cag_net_end(&net), end, 1e-15 * 5);
    // Away from the knots, where the sides would be exchanged.
    for (int i = 0; i < PLACES; i++) {
      double p[MOST_WIDTH], q[MOST_WIDTH];
      const double t = uniform(start, end);
      value(&old, t, false, p);
      value(&net, start + end - t, false, q);
      for (size_t k = 0; k < net.width; k++) NEAR(p[k], q[k], 1e-11);
    }
    cag_net_free(&net);
    cag_net_free(&old);
  }
}

static void interpolation_passes_the_data(void **state) {
  (void)state;
  seed = 6;
  for (int round = 0; round < 100; round++) {
    const int degree = whole(1, 5);
    const size_t p = (size_t)degree, n = p + 1 + (size_t)whole(0, 12), width = (size_t)whole(1, 5);
    double at[32], data[32 * MOST_WIDTH];
    at[0] = uniform(-1, 1);
    for (size_t i = 1; i < n; i++) at[i] = at[i - 1] + uniform(0.2, 1);
    CagNet net;
    OK(cag_net_new(degree, n, width, &net, &err));
    cag_net_averaged_knots(at, n, degree, net.knots);
    for (size_t i = 0; i < n + p + 1; i++) {
      double mean = 0;
      for (size_t k = 0; k < p; k++)
        mean += at[i <= p ? 0 : i >= n ? n - 1 : i - p + k] / (double)p;
      NEAR(net.knots[i], mean, 1e-13);
    }
    for (size_t i = 0; i < n * width; i++) net.data[i] = data[i] = uniform(-1, 1);
    OK(cag_net_interpolate(&net, at, &err));
    for (size_t i = 0; i < n; i++) {
      double found[MOST_WIDTH];
      value(&net, at[i], i == n - 1, found);
      for (size_t c = 0; c < width; c++) NEAR(found[c], data[i * width + c], 1e-9);
    }
    // Two conditions at one parameter, or too many within few knots, have no solution.
    at[n / 2] = at[n / 2 - 1];
    FAILS(cag_net_interpolate(&net, at, &err), "fit-singular");
    if (n > 2 * p + 2) {
      const double step = (net.knots[p + 1] - net.knots[p]) / (double)n;
      for (size_t i = 0; i < n - 1; i++) at[i] = net.knots[p] + (double)i * step;
      FAILS(cag_net_interpolate(&net, at, &err), "fit-singular");
    }
    cag_net_free(&net);
  }
}

static void surfaces_are_nets_of_rows_either_way(void **state) {
  (void)state;
  seed = 7;
  enum { NU = 5, NV = 4 };
  CagVec3 points[NU * NV];
  double weights[NU * NV];
  for (int i = 0; i < NU * NV; i++) {
    points[i].x = uniform(-1, 1);
    points[i].y = uniform(-1, 1);
    points[i].z = uniform(-1, 1);
    weights[i] = uniform(0.5, 2);
  }
  const double ku[] = {0, 0, 0, 1, 2.5, 4, 4, 4}, kv[] = {-1, -1, -1, -1, 2, 2, 2, 2};
  CagSurface *s, *back;
  OK(cag_surface_nurbs(points, weights, NU, NV, 2, 3, ku, kv, &s, &err));
  for (int direction = 0; direction < 2; direction++) {
    CagNet net, across;
    OK(cag_net_of_surface(s, direction, &net, &across, &err));
    const size_t n = direction ? NV : NU, m = direction ? NU : NV;
    assert_int_equal(net.count, n);
    assert_int_equal(net.width, 4 * m);
    assert_int_equal(net.degree, direction ? 3 : 2);
    assert_int_equal(across.count, m);
    assert_int_equal(across.degree, direction ? 2 : 3);
    assert_memory_equal(net.knots, direction ? kv : ku, (n + (size_t)net.degree + 1) * 8);
    assert_memory_equal(across.knots, direction ? ku : kv, (m + (size_t)across.degree + 1) * 8);
    for (size_t i = 0; i < NU; i++)
      for (size_t j = 0; j < NV; j++) {
        const double *h = net.data + (direction ? j * net.width + 4 * i : i * net.width + 4 * j);
        const double w = weights[i * NV + j];
        NEAR(h[3], w, 0);
        near_vec(cag_vec3(h[0] / w, h[1] / w, h[2] / w), points[i * NV + j], 1e-15);
      }
    OK(cag_net_to_surface(&net, direction, &across, &back, &err));
    CagSurfaceNurbsView a, b;
    assert_true(cag_surface_nurbs_view(s, &a) && cag_surface_nurbs_view(back, &b));
    assert_int_equal(b.nu, NU);
    assert_int_equal(b.nv, NV);
    assert_memory_equal(b.knots_u, ku, sizeof ku);
    assert_memory_equal(b.knots_v, kv, sizeof kv);
    assert_memory_equal(a.homogeneous, b.homogeneous, sizeof(double) * 4 * NU * NV);
    cag_surface_release(back);
    cag_net_free(&net);
    cag_net_free(&across);
  }
  cag_surface_release(s);
}

// An arc in pieces over its fraction, as a homogeneous, clamped net.
static void a_curve_is_a_net_over_its_fractions(void **state) {
  (void)state;
  CagCurve *arc;
  const CagTransform identity = cag_transform_identity();
  OK(cag_curve_arc(2, 2, 0.3, 4.1, &identity, &arc, &err));
  CagNet net;
  OK(cag_net_of_curve(arc, &net, &err));
  assert_true(cag_net_start(&net) == 0 && cag_net_end(&net) == 1);
  assert_int_equal(net.width, 4);
  assert_int_equal(times_of(&net, 0), net.degree + 1);
  assert_int_equal(times_of(&net, 1), net.degree + 1);
  double before = 0.3;
  for (int i = 0; i <= 40; i++) {
    double h[MOST_WIDTH];
    value(&net, i / 40.0, i == 40, h);
    NEAR(hypot(h[0], h[1]) / h[3], 2, 1e-14);
    NEAR(h[2], 0, 0);
    double angle = atan2(h[1], h[0]);
    while (angle < before - 1e-9) angle += 2 * M_PI;
    if (i == 0) NEAR(angle, 0.3, 1e-14);
    if (i == 40) NEAR(angle, 4.1, 1e-14);
    before = angle;
  }
  cag_net_free(&net);
  cag_curve_release(arc);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(inserted_knots_keep_the_values),
      cmocka_unit_test(a_part_has_the_values_and_is_clamped),
      cmocka_unit_test(raised_degrees_keep_values_and_smoothness),
      cmocka_unit_test(nets_get_one_degree_and_knot_vector),
      cmocka_unit_test(ranges_move_and_turn_round),
      cmocka_unit_test(interpolation_passes_the_data),
      cmocka_unit_test(surfaces_are_nets_of_rows_either_way),
      cmocka_unit_test(a_curve_is_a_net_over_its_fractions),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
