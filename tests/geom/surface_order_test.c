// Partial derivatives up to the highest order, of every kind of surface. They do not depend on the
// requested order, and each is the derivative of the previous one.

#include "surface_support.h"
#include "tests/geom/random.h"

#include "geom/surface/family.h"
#include "geom/surface/patches.h"
#include "geom/surface/reshape.h"
#include "geom/surface/swept.h"

enum { MOST = CAG_MAX_PARTIAL, SIZE = (MOST + 1) * (MOST + 1) };

// A rational curve of degree 3 with uneven knots.
static CagCurve *curve_through(CagVec3 a, CagVec3 b) {
  const double knots[] = {0, 0, 0, 0, 0.3, 0.75, 1, 1, 1, 1};
  CagVec3 p[6];
  double weights[6];
  CagCurve *c;
  for (int i = 0; i < 6; i++) {
    const double x = uniform(-0.3, 0.3), y = uniform(-0.3, 0.3), z = uniform(-0.3, 0.3);
    const bool end = i == 0 || i == 5;
    p[i] = cag_lerp(a, b, i / 5.0);
    if (!end) p[i] = cag_add(p[i], cag_vec3(x, y, z));
    weights[i] = uniform(0.7, 1.4);
  }
  MUST(cag_curve_nurbs(p, weights, 6, 3, knots, 3, &c, err));
  return c;
}

static CagVec3 somewhere(void) {
  const double x = uniform(-2, 2), y = uniform(-2, 2);
  return cag_vec3(x, y, uniform(-2, 2));
}

enum { BEZIER, NURBS, COONS, REVOLVED, RULED, TWISTED, SHIFTED, TUBE, TORUS, TRIANGLE, KINDS };

static CagSurface *made(int kind) {
  CagSurface *s = NULL;
  CagCurve *c[4] = {NULL};
  CagVec3 net[25], corner[4];
  double weights[25];
  const double knots[] = {-1, -1, -1, -1, 0.2, 1.5, 1.5, 1.5, 1.5};
  for (int k = 0; k < 4; k++) corner[k] = somewhere();
  for (int k = 0; k < 25; k++) {
    const CagVec3 off = somewhere();
    net[k] = cag_madd(cag_vec3(k / 5, k % 5, 0), 0.3, off);
    weights[k] = uniform(0.7, 1.4);
  }
  switch (kind) {
  case BEZIER: MUST(cag_surface_bezier(net, weights, 5, 5, &s, err)); break;
  case NURBS: MUST(cag_surface_nurbs(net, weights, 5, 5, 3, 3, knots, knots, &s, err)); break;
  case COONS:
    c[0] = curve_through(corner[0], corner[1]);
    c[1] = curve_through(corner[2], corner[3]);
    c[2] = curve_through(corner[0], corner[2]);
    c[3] = curve_through(corner[1], corner[3]);
    MUST(cag_surface_coons(c[0], c[1], c[2], c[3], &s, err));
    break;
  case REVOLVED:
    c[0] = curve_through(cag_vec3(2, 0, 0), cag_vec3(3, 0, 2));
    MUST(cag_surface_revolve(c[0], cag_vec3(0, 0, 1), cag_vec3(0.1, 0.2, 0), 0.4, 2.7, &s, err));
    break;
  case RULED:
    c[0] = curve_through(corner[0], corner[1]);
    c[1] = curve_through(corner[2], corner[3]);
    MUST(cag_surface_ruled(c[0], c[1], &s, err));
    break;
  case TWISTED: {
    CagTransform frame = cag_transform_identity();
    frame.planar = true;
    MUST(cag_curve_arc(1.2, 0.7, 0.3, 4, &frame, &c[0], err));
    MUST(cag_surface_extrude(c[0], cag_vec3(0, 0, 3), 1.1, 0.6, &s, err));
    break;
  }
  case SHIFTED:
    c[0] = curve_through(corner[0], corner[1]);
    c[1] = curve_through(corner[2], corner[3]);
    MUST(cag_surface_translational(c[0], c[1], &s, err));
    break;
  case TUBE:
    MUST(cag_curve_helix(3, 4, 1.5, 0, &c[0], err));
    MUST(cag_surface_tube(c[0], 0.7, &s, err));
    break;
  case TORUS: MUST(cag_surface_torus(3, 1.2, &s, err)); break;
  default: MUST(cag_surface_bezier_triangle(net, 4, &s, err));
  }
  for (int k = 0; k < 4; k++) cag_curve_release(c[k]);
  return s;
}

// Transformed, transposed, flipped, or a part.
static CagSurface *derived(const CagSurface *s, int how) {
  CagSurface *out;
  CagTransform move;
  switch (how) {
  case 0:
    MUST(cag_rotate(cag_vec3(1, 2, 3), 0.7, cag_vec3(1, 0, -1), &move, err));
    MUST(cag_surface_transform(s, &move, &out, err));
    break;
  case 1: MUST(cag_surface_transpose(s, &out, err)); break;
  case 2: MUST(cag_surface_flip(s, &out, err)); break;
  default:
    MUST(cag_surface_part(s, inside(s->u0, s->u1, 0), inside(s->u0, s->u1, 3),
                          inside(s->v0, s->v1, 0), inside(s->v0, s->v1, 3), &out, err));
  }
  return out;
}

static void eval(const CagSurface *s, double u, double v, int n, CagVec3 *out) {
  MUST(cag_surface_eval(s, u, v, n, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, out, err));
}

// The fourth-order central difference of a partial derivative in one direction.
static CagVec3 difference(const CagSurface *s, double u, double v, int i, int j, int direction,
                          double h) {
  static const double WEIGHT[4] = {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12};
  CagVec3 sum = {0, 0, 0}, d[SIZE];
  for (int k = 0; k < 4; k++) {
    const double off = (k < 2 ? k - 2 : k - 1) * h;
    eval(s, direction ? u : u + off, direction ? v + off : v, i + j, d);
    sum = cag_madd(sum, WEIGHT[k] / h, d[cag_partial(i + j, i, j)]);
  }
  return sum;
}

static void check_orders(const CagSurface *s, const char *name) {
  CagVec3 all[SIZE], some[SIZE];
  const double u = inside(s->u0, s->u1, 1), v = inside(s->v0, s->v1, 2);
  const double range[2] = {s->u1 - s->u0, s->v1 - s->v0};
  eval(s, u, v, MOST, all);
  for (int n = 0; n < MOST; n++) {
    eval(s, u, v, n, some);
    double size = 0;
    for (int i = 0; i <= n + 1; i++)
      for (int j = 0; i + j <= n + 1; j++)
        size = fmax(size,
                    cag_norm(all[cag_partial(MOST, i, j)]) * pow(range[0], i) * pow(range[1], j));
    for (int i = 0; i <= n; i++)
      for (int j = 0; i + j <= n; j++) {
        const double scale = size / pow(range[0], i) / pow(range[1], j);
        const CagVec3 a = all[cag_partial(MOST, i, j)], b = some[cag_partial(n, i, j)];
        if (cag_norm(cag_sub(a, b)) > 1e-12 * scale)
          fail_msg("%s: partial %d %d differs by order %d", name, i, j, n);
        if (i + j < n) continue;
        for (int k = 0; k < 2; k++) {
          const CagVec3 next = all[cag_partial(MOST, i + !k, j + k)];
          const CagVec3 near = difference(s, u, v, i, j, k, 1e-3 * range[k]);
          if (cag_norm(cag_sub(near, next)) > 1e-5 * scale / range[k])
            fail_msg("%s: partial %d %d is off by %g", name, i + !k, j + k,
                     cag_norm(cag_sub(near, next)) / scale * range[k]);
        }
      }
  }
}

static void partials_of_all_orders_continue_each_other(void **state) {
  (void)state;
  seed = 31;
  for (int kind = 0; kind < KINDS; kind++) {
    CagSurface *s = made(kind);
    check_orders(s, s->kind->name);
    for (int how = 0; how < 4; how++) {
      CagSurface *other = derived(s, how);
      check_orders(other, s->kind->name);
      cag_surface_release(other);
    }
    CagVec3 d[SIZE];
    MUST_FAIL(cag_surface_eval(s, s->u0, s->v0, MOST + 1, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err),
              "derivative-order");
    cag_surface_release(s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(partials_of_all_orders_continue_each_other),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
