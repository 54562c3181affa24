// Edits of control points, corners, and edges of random surfaces: the edited quantities change as
// defined, and all others stay. Seams and creases are compared with closed forms.

#include "geom/surface/edit.h"
#include "geom/surface/reshape.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

enum { NU = 5, NV = 6, PU = 2, PV = 3 };
static const double KU[] = {0.5, 0.5, 0.5, 1.2, 2, 3.1, 3.1, 3.1};
static const double KV[] = {-1, -1, -1, -1, -0.4, 0.5, 1.5, 1.5, 1.5, 1.5};

// The domain begins at neither 0 nor 1. With `plain_v`, there are no inner knots along v.
static CagSurface *random_surface(bool rational, bool plain) {
  CagVec3 p[NU * NV];
  double w[NU * NV], ku[6], kv[8];
  const size_t nu = plain ? 3 : NU, nv = plain ? 4 : NV;
  for (int i = 0; i < 6; i++) ku[i] = i < 3 ? 0.5 : 3.1;
  for (int i = 0; i < 8; i++) kv[i] = i < 4 ? -1 : 1.5;
  for (size_t i = 0; i < nu; i++)
    for (size_t j = 0; j < nv; j++) {
      CagVec3 *at = &p[i * nv + j];
      at->x = 2 * (double)i + uniform(-0.5, 0.5);
      at->y = 2 * (double)j + uniform(-0.5, 0.5);
      at->z = uniform(-1, 1);
      w[i * nv + j] = uniform(0.6, 1.7);
    }
  CagSurface *s;
  OK(cag_surface_nurbs(p, rational ? w : NULL, nu, nv, PU, PV, plain ? ku : KU, plain ? kv : KV, &s,
                       &err));
  return s;
}

static CagVec3 point_of(const CagSurfaceNurbsView *v, size_t i, size_t j) {
  const double *h = v->homogeneous + 4 * (i * v->nv + j);
  return cag_vec3(h[0] / h[3], h[1] / h[3], h[2] / h[3]);
}

static double weight_of(const CagSurfaceNurbsView *v, size_t i, size_t j) {
  return v->homogeneous[4 * (i * v->nv + j) + 3];
}

static void one_point_is_put(void **state) {
  (void)state;
  seed = 51;
  for (int round = 0; round < 40; round++) {
    CagSurface *s = random_surface(round % 2, false), *t;
    const size_t i = (size_t)uniform(0, NU), j = (size_t)uniform(0, NV);
    const double weight = round % 3 == 0 ? -1 : round % 3 == 1 ? 0.7 : 2;
    const CagVec3 p = {1.5, -2, 7};
    CagSurfaceNurbsView a, b;
    OK(cag_surface_set_point(s, i, j, p, weight, &t, &err));
    assert_true(cag_surface_nurbs_view(s, &a) && cag_surface_nurbs_view(t, &b));
    for (size_t x = 0; x < NU; x++)
      for (size_t y = 0; y < NV; y++) {
        const bool here = x == i && y == j;
        near_vec(point_of(&b, x, y), here ? p : point_of(&a, x, y), 1e-14);
        NEAR(weight_of(&b, x, y), here && weight >= 0 ? weight : weight_of(&a, x, y), 1e-15);
      }
    assert_memory_equal(b.knots_u, KU, sizeof KU);
    assert_memory_equal(b.knots_v, KV, sizeof KV);
    FAILS_AT(cag_surface_set_point(s, NU, 0, p, -1, &t, &err), "point-index", NU);
    FAILS_AT(cag_surface_set_point(s, 0, NV, p, -1, &t, &err), "point-index", NV);
    cag_surface_release(s);
    cag_surface_release(t);
  }
}

static void corners_get_their_tangents_and_twists(void **state) {
  (void)state;
  seed = 52;
  for (int round = 0; round < 80; round++) {
    CagSurface *s = random_surface(round % 2, false), *t;
    CagCornerEdit edit = {.u = round / 2 % 2, .v = round / 4 % 2};
    for (int k = 0; k < 3; k++) {
      edit.by_vector[k] = uniform(0, 1) < 0.5;
      edit.factor[k] = uniform(-2, 2);
      edit.vector[k].x = uniform(-3, 3);
      edit.vector[k].y = uniform(-3, 3);
      edit.vector[k].z = uniform(-3, 3);
    }
    CagHermiteCorners old, now;
    CagSurfaceNurbsView a, b;
    OK(cag_surface_corners(s, &old, &err));
    OK(cag_surface_edit_corner(s, &edit, &t, &err));
    OK(cag_surface_corners(t, &now, &err));
    for (int i = 0; i < 2; i++)
      for (int j = 0; j < 2; j++) {
        // The corners are those of the surface.
        CagVec3 d[9];
        OK(cag_surface_eval(t, i ? 3.1 : 0.5, j ? 1.5 : -1, 2, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d,
                            &err));
        near_vec(now.p[i][j], d[0], 1e-14);
        const CagVec3 *before[] = {&old.pu[i][j], &old.pv[i][j], &old.puv[i][j]};
        const CagVec3 after[] = {d[cag_partial(2, 1, 0)], d[cag_partial(2, 0, 1)],
                                 d[cag_partial(2, 1, 1)]};
        near_vec(now.pu[i][j], after[0], 1e-13);
        near_vec(now.pv[i][j], after[1], 1e-13);
        near_vec(now.puv[i][j], after[2], 1e-13);
        near_vec(now.p[i][j], old.p[i][j], 1e-13);
        const bool here = i == edit.u && j == edit.v;
        for (int k = 0; k < 3; k++) {
          const CagVec3 wanted = !here               ? *before[k]
                                 : edit.by_vector[k] ? edit.vector[k]
                                                     : cag_scaled(*before[k], edit.factor[k]);
          near_vec(after[k], wanted, 1e-10 * (1 + cag_norm(*before[k])));
        }
      }
    assert_true(cag_surface_nurbs_view(s, &a) && cag_surface_nurbs_view(t, &b));
    int moved = 0;
    for (size_t x = 0; x < NU; x++)
      for (size_t y = 0; y < NV; y++) {
        const size_t du = edit.u ? NU - 1 - x : x, dv = edit.v ? NV - 1 - y : y;
        NEAR(weight_of(&b, x, y), weight_of(&a, x, y), 1e-15);
        if (du <= 1 && dv <= 1 && du + dv > 0) moved++;
        else near_vec(point_of(&b, x, y), point_of(&a, x, y), 1e-13);
      }
    assert_int_equal(moved, 3);
    cag_surface_release(s);
    cag_surface_release(t);
  }
}

static void only_single_bicubic_patches_have_hermite_corners(void **state) {
  (void)state;
  seed = 53;
  CagSurface *s = random_surface(false, true), *t;
  CagHermiteCorners a, b;
  OK(cag_surface_hermite_corners(s, &a, &err));
  OK(cag_surface_corners(s, &b, &err));
  assert_memory_equal(&a, &b, sizeof a);
  for (int direction = 0; direction < 2; direction++) {
    OK(cag_surface_insert_knot(s, direction, 1.1, 1, &t, &err));
    FAILS(cag_surface_hermite_corners(t, &a, &err), "not-one-patch");
    cag_surface_release(t);
    OK(cag_surface_elevate(s, direction ? 0 : 2, direction ? 1 : 0, &t, &err));
    FAILS(cag_surface_hermite_corners(t, &a, &err), "degree-too-high");
    cag_surface_release(t);
  }
  cag_surface_release(s);
  s = random_surface(true, true);
  FAILS(cag_surface_hermite_corners(s, &a, &err), "rational-patch");
  cag_surface_release(s);
}

// --- Edges ---

// The point, the outward derivative across a side, and the derivative along it, at a fraction of
// the side.
static void edge_at(const CagSurface *s, int side, double f, CagVec3 out[3]) {
  CagVec3 d[4];
  const bool of_u = side < 2;
  const double u = side == 0 ? s->u0 : side == 1 ? s->u1 : s->u0 + f * (s->u1 - s->u0);
  const double v = side == 2 ? s->v0 : side == 3 ? s->v1 : s->v0 + f * (s->v1 - s->v0);
  OK(cag_surface_eval(s, u, v, 1, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, &err));
  const CagVec3 du = d[cag_partial(1, 1, 0)], dv = d[cag_partial(1, 0, 1)];
  out[0] = d[0];
  out[1] = cag_scaled(of_u ? du : dv, side % 2 ? 1 : -1);
  out[2] = of_u ? dv : du;
}

static void matched_surfaces_continue_each_other(void **state) {
  (void)state;
  seed = 54;
  for (int side = 0; side < 4; side++)
    for (int other = 0; other < 4; other++)
      for (int round = 0; round < 4; round++) {
        // Shear requires an edge of one piece.
        const bool shears = round % 2;
        CagSurface *a = random_surface(round >= 2, shears), *b = random_surface(round == 3, false),
                   *t;
        CagEdgeMatch how = {uniform(0.3, 0.9), {0, 0}};
        for (int k = 0; shears && k < 2; k++) how.shear[k] = uniform(-0.4, 0.4);
        const int sides[2] = {side, other};
        CagSeam seam;
        OK(cag_surface_seam_on(a, b, sides, 0, &seam, &err));
        assert_true(seam.side[0] == side && seam.side[1] == other);
        const CagStatus status = cag_surface_match(a, b, &how, sides, &t, &err);
        if (status) {
          // The weights of the neighbor would become negative.
          assert_string_equal(cag_error_info(err.id)->reason, "negative-weight");
        } else {
          for (int i = 0; i <= 10; i++) {
            CagVec3 own[3], next[3];
            const double f = i / 10.0;
            edge_at(a, side, f, own);
            edge_at(t, other, seam.reversed ? 1 - f : f, next);
            near_vec(next[0], own[0], 1e-11);
            const double shear = how.shear[0] + f * (how.shear[1] - how.shear[0]);
            near_vec(cag_scaled(next[1], -1),
                     cag_madd(cag_scaled(own[1], how.ratio), shear, own[2]), 1e-9);
          }
          assert_true(t->u0 == b->u0 && t->u1 == b->u1 && t->v0 == b->v0 && t->v1 == b->v1);
          // Away from the edge, the surface is unchanged: checked on the opposite side.
          for (int i = 0; i <= 4; i++) {
            CagVec3 far[3], was[3];
            edge_at(t, other ^ 1, i / 4.0, far);
            edge_at(b, other ^ 1, i / 4.0, was);
            near_vec(far[0], was[0], 1e-11);
          }
          cag_surface_release(t);
        }
        cag_surface_release(a);
        cag_surface_release(b);
      }
}

// The rows are those of a patch over 0..1 of the degree. Its inward derivative is the degree times
// their difference, in homogeneous coordinates.
static void joined_lines_start_a_neighbor(void **state) {
  (void)state;
  seed = 55;
  for (int round = 0; round < 48; round++) {
    const int side = round % 4, degree = 2 + round / 4 % 3;
    const bool shears = round >= 24;
    CagSurface *a = random_surface(round % 2, shears), *b;
    CagEdgeMatch how = {uniform(0.2, 0.6), {0, 0}};
    for (int k = 0; shears && k < 2; k++) how.shear[k] = uniform(-0.2, 0.2);
    double *lines, net[4 * 5 * NV];
    size_t n;
    if (cag_surface_join_lines(a, side, degree, &how, &lines, &n, &err)) {
      assert_string_equal(cag_error_info(err.id)->reason, "negative-weight");
      cag_surface_release(a);
      continue;
    }
    const int along = side < 2 ? PV : PU;
    assert_int_equal(n, shears ? along + 1 : side < 2 ? NV : NU);
    // The other rows are arbitrary; they repeat the second one here.
    for (int k = 0; k <= degree; k++)
      memcpy(net + 4 * n * (size_t)k, lines + (k ? 4 * n : 0), 4 * n * sizeof *net);
    CagVec3 p[5 * NV];
    double w[5 * NV], across[10];
    for (size_t k = 0; k < n * (size_t)(degree + 1); k++) {
      const double *h = net + 4 * k;
      w[k] = h[3];
      p[k] = cag_vec3(h[0] / h[3], h[1] / h[3], h[2] / h[3]);
    }
    for (int k = 0; k < 2 * degree + 2; k++) across[k] = k > degree;
    CagSurfaceNurbsView view;
    assert_true(cag_surface_nurbs_view(a, &view));
    OK(cag_surface_nurbs(p, w, (size_t)degree + 1, n, degree, along, across,
                         side < 2 ? view.knots_v : view.knots_u, &b, &err));
    for (int i = 0; i <= 10; i++) {
      CagVec3 own[3], next[3];
      edge_at(a, side, i / 10.0, own);
      edge_at(b, 0, i / 10.0, next);
      const double shear = how.shear[0] + i / 10.0 * (how.shear[1] - how.shear[0]);
      // The shear depends on the fraction of the edge in one case, and on the parameter in the
      // other.
      near_vec(next[0], own[0], 1e-12);
      near_vec(cag_scaled(next[1], -1), cag_madd(cag_scaled(own[1], how.ratio), shear, own[2]),
               1e-10);
    }
    free(lines);
    cag_surface_release(a);
    cag_surface_release(b);
  }
  CagSurface *a = random_surface(false, false);
  double *lines;
  size_t n;
  CagEdgeMatch how = {0, {0, 0}};
  FAILS(cag_surface_join_lines(a, 1, 3, &how, &lines, &n, &err), "join-folds");
  how.ratio = 1;
  how.shear[1] = 0.1;
  FAILS(cag_surface_join_lines(a, 1, 3, &how, &lines, &n, &err), "join-shear");
  how.shear[1] = 0;
  cag_surface_release(a);
  // The row of points next to the edge coincides with the edge's.
  const CagVec3 p[] = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {2, 0, 0}, {1, 1, 0}};
  OK(cag_surface_bezier(p, NULL, 3, 2, &a, &err));
  FAILS_AT(cag_surface_join_lines(a, 1, 3, &how, &lines, &n, &err), "join-degenerate", 1);
  cag_surface_release(a);
}

// --- Seams and creases ---

// A square plate over x = -2 .. 0, continued by about a quarter of a cylinder of radius r, which is
// bent upward by an angle.
static void seams_tell_angle_and_curvature(void **state) {
  (void)state;
  seed = 56;
  for (int round = 0; round < 40; round++) {
    const double r = uniform(0.5, 3), angle = round % 2 ? uniform(0.01, 2) : 0;
    const double length = uniform(0.5, 2), speed = uniform(0.5, 2);
    CagSurface *plate, *tube, *bent, *turned;
    CagCurve *arc;
    CagTransform frame = cag_transform_identity(), up;
    // x = r sin t, z = r (1 - cos t): in the frame with x along -Z and y along X, about the center.
    frame.planar = false;
    memset(frame.m, 0, sizeof frame.m);
    frame.m[3][3] = 1;
    frame.m[2][0] = -1;
    frame.m[0][1] = 1;
    frame.m[1][2] = -1;
    frame.m[2][3] = r;
    OK(cag_surface_bilinear(cag_vec3(-2, 0, 0), cag_vec3(-2, length, 0), cag_vec3(0, 0, 0),
                            cag_vec3(0, length, 0), &plate, &err));
    OK(cag_curve_arc(r, r, 0, speed, &frame, &arc, &err));
    OK(cag_surface_extrude(arc, cag_vec3(0, length, 0), 0, 1, &tube, &err));
    OK(cag_rotate(cag_vec3(0, -1, 0), angle, cag_vec3(0, 0, 0), &up, &err));
    OK(cag_surface_transform(tube, &up, &bent, &err));
    CagSeam seam;
    const int turn = round / 2 % 4; // unchanged, v reversed, u and v exchanged, both
    if (turn & 1) {
      OK(cag_surface_flip(bent, &turned, &err));
      cag_surface_release(bent);
      bent = turned;
    }
    if (turn & 2) {
      OK(cag_surface_transpose(bent, &turned, &err));
      cag_surface_release(bent);
      bent = turned;
    }
    OK(cag_surface_seam(plate, bent, 1e-9, &seam, &err));
    assert_int_equal(seam.side[0], 1);
    assert_int_equal(seam.side[1], turn & 2 ? 2 : 0);
    assert_int_equal(seam.reversed, turn & 1);
    NEAR(seam.gap, 0, 1e-12);
    NEAR(seam.angle, angle, 1e-7);
    NEAR(seam.curvature, 1 / r, 1e-9);
    // |S_u| of the plate is 2, and that of the arc is its radius.
    NEAR(seam.first, sqrt(4 + r * r - 4 * r * cos(angle)), 1e-7);
    assert_true(seam.c0 && seam.g1 == (angle == 0) && !seam.c1 && !seam.g2);
    cag_surface_release(plate);
    cag_surface_release(tube);
    cag_surface_release(bent);
    cag_curve_release(arc);
  }
}

// The largest gap and angle are at the end of the edge, where two plates separate.
static void seams_are_measured_up_to_their_ends(void **state) {
  (void)state;
  seed = 58;
  for (int round = 0; round < 20; round++) {
    const double length = uniform(1, 3), lift = uniform(0.1, 0.5), rise = uniform(0.1, 2);
    const bool first = round % 2; // at the start of the edge, or at its end
    const double a = first ? lift : 0, b = first ? 0 : lift;
    CagSurface *flat, *other;
    CagSeam seam;
    OK(cag_surface_bilinear(cag_vec3(-9, 0, 0), cag_vec3(-9, length, 0), cag_vec3(0, 0, 0),
                            cag_vec3(0, length, 0), &flat, &err));
    OK(cag_surface_bilinear(cag_vec3(0, 0, a), cag_vec3(0, length, b), cag_vec3(9, 0, a),
                            cag_vec3(9, length, b), &other, &err));
    OK(cag_surface_seam(flat, other, 1e-9, &seam, &err));
    NEAR(seam.gap, lift, 1e-12);
    NEAR(seam.angle, atan(lift / length), 1e-9);
    assert_true(!seam.c0 && !seam.g1 && !seam.c1 && !seam.g2 && !seam.reversed);
    cag_surface_release(other);
    // A common edge, and a rotation about it.
    OK(cag_surface_bilinear(cag_vec3(0, 0, 0), cag_vec3(0, length, 0),
                            cag_vec3(9, 0, first ? rise : 0), cag_vec3(9, length, first ? 0 : rise),
                            &other, &err));
    OK(cag_surface_seam(flat, other, 1e-9, &seam, &err));
    NEAR(seam.gap, 0, 1e-12);
    NEAR(seam.angle, atan(rise / 9), 1e-9);
    NEAR(seam.first, rise, 1e-9);
    assert_true(seam.c0 && !seam.g1 && !seam.c1 && !seam.g2);
    cag_surface_release(other);
    cag_surface_release(flat);
  }
}

static CagSurface *replaced(CagSurface *old, CagSurface *by) {
  cag_surface_release(old);
  return by;
}

// The parts of a surface, the second of which has another domain of v, is rotated, and has a higher
// degree.
static void joined_surfaces_run_over_both(void **state) {
  (void)state;
  seed = 59;
  for (int round = 0; round < 16; round++) {
    CagSurface *s = random_surface(round % 2, false), *a, *b, *other, *t;
    CagSurfaceNurbsView v;
    CagVec3 p[NU * NV];
    double w[NU * NV], kv[NV + PV + 1];
    assert_true(cag_surface_nurbs_view(s, &v));
    for (size_t i = 0; i < NU * NV; i++) {
      p[i] = point_of(&v, i / NV, i % NV);
      w[i] = weight_of(&v, i / NV, i % NV);
    }
    for (int i = 0; i < NV + PV + 1; i++) kv[i] = 4 + 2 * (KV[i] + 1);
    OK(cag_surface_nurbs(p, w, NU, NV, PU, PV, KU, kv, &other, &err));
    const double cut = 1.7;
    OK(cag_surface_part(s, 0.5, cut, -1, 1.5, &a, &err));
    OK(cag_surface_part(other, cut, 3.1, 4, 9, &b, &err));
    if (round & 2) {
      OK(cag_surface_elevate(b, 1, 1, &t, &err));
      b = replaced(b, t);
    }
    if (round & 4) {
      OK(cag_surface_transpose(b, &t, &err));
      b = replaced(b, t);
    }
    if (round & 8) {
      OK(cag_surface_flip(b, &t, &err));
      b = replaced(b, t);
    }
    OK(cag_surface_join(a, b, 1e-9, &t, &err));
    NEAR(t->u0, 0.5, 1e-14);
    NEAR(t->u1, 3.1, 1e-14);
    NEAR(t->v0, -1, 1e-14);
    NEAR(t->v1, 1.5, 1e-14);
    assert_true(cag_surface_nurbs_view(t, &v));
    assert_int_equal(v.degree_u, round & 2 ? PU + 1 : PU);
    assert_int_equal(v.degree_v, round & 2 ? PV + 1 : PV);
    for (int i = 0; i <= 12; i++)
      for (int j = 0; j <= 12; j++) {
        const double x = 0.5 + 2.6 * i / 12, y = -1 + 2.5 * j / 12;
        CagVec3 is, was;
        OK(cag_surface_point(t, fmin(x, t->u1), fmin(y, t->v1), &is, &err));
        OK(cag_surface_point(s, fmin(x, 3.1), y, &was, &err));
        near_vec(is, was, 1e-10);
      }
    cag_surface_release(t);
    cag_surface_release(a);
    cag_surface_release(b);
    cag_surface_release(s);
    cag_surface_release(other);
  }
}

static void creases_have_the_angle_between_their_sides(void **state) {
  (void)state;
  seed = 57;
  for (int round = 0; round < 30; round++) {
    // A profile of three straight edges, of degree 1 or elevated, extruded along y.
    double turn[2], heading = uniform(-1, 1);
    CagVec3 p[8], at = {0, 0, 0};
    for (int i = 0; i < 4; i++) {
      p[2 * i] = at;
      p[2 * i + 1] = cag_add(at, cag_vec3(0, 3, 0));
      at = cag_madd(at, uniform(0.5, 2), cag_vec3(cos(heading), 0, sin(heading)));
      if (i < 2) heading += turn[i] = i == 0 && round % 3 == 0 ? 0 : uniform(-2, 2);
    }
    // The knots may be uneven, because only the tangents count.
    const double ku[] = {2, 2, 2.5, 4, 7, 7}, kv[] = {0, 0, 1, 1};
    CagSurface *s, *t;
    OK(cag_surface_nurbs(p, NULL, 4, 2, 1, 1, ku, kv, &s, &err));
    OK(cag_surface_elevate(s, round % 2 ? 2 : 0, 0, &t, &err));
    cag_surface_release(s);
    const int direction = round / 2 % 2;
    if (direction) {
      OK(cag_surface_transpose(t, &s, &err));
      cag_surface_release(t);
      t = s;
    }
    CagCrease *creases;
    size_t n;
    OK(cag_surface_creases(t, 1 - direction, &creases, &n, &err));
    assert_int_equal(n, 0);
    free(creases);
    OK(cag_surface_creases(t, direction, &creases, &n, &err));
    size_t k = 0;
    for (int i = 0; i < 2; i++) {
      if (turn[i] == 0) continue;
      assert_true(k < n);
      NEAR(creases[k].at, i ? 4 : 2.5, 1e-12);
      NEAR(creases[k].angle, fabs(turn[i]), 1e-9);
      k++;
    }
    assert_int_equal(n, k);
    free(creases);
    cag_surface_release(t);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(one_point_is_put),
      cmocka_unit_test(corners_get_their_tangents_and_twists),
      cmocka_unit_test(only_single_bicubic_patches_have_hermite_corners),
      cmocka_unit_test(matched_surfaces_continue_each_other),
      cmocka_unit_test(joined_lines_start_a_neighbor),
      cmocka_unit_test(seams_tell_angle_and_curvature),
      cmocka_unit_test(seams_are_measured_up_to_their_ends),
      cmocka_unit_test(joined_surfaces_run_over_both),
      cmocka_unit_test(creases_have_the_angle_between_their_sides),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
