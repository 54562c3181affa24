// The general conic: classification, standard form, images, branches, segments, lines.
//
// The form is stored as given, not scaled. Differences are compared with their terms, so that
// neither a factor of the equation nor the unit of length matters.

#include <float.h>
#include <stdlib.h>

#include "geom/curve/conic.h"
#include "geom/curve/family.h"
#include "geom/curve/nurbs.h"
#include "geom/linalg/tolerance.h"

// The smaller eigenvalue of the quadratic part is 0 below this fraction of the larger: rotated and
// rounded coefficients must still be recognized as a parabola, and ellipses may be 3e5 times as
// long as wide.
#define FLAT 1e-11
// A sum is 0 below this fraction of its terms.
#define NOTHING CAG_ROUNDING
// Eigenvalues are equal (the conic is a circle) within this fraction of their sum.
#define ROUND CAG_COINCIDENT

static void matrix_of(const CagConic *k, double s[3][3]) {
  const double *c = k->c;
  const double rows[3][3] = {
      {c[0], c[1] / 2, c[3] / 2}, {c[1] / 2, c[2], c[4] / 2}, {c[3] / 2, c[4] / 2, c[5]}};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) s[i][j] = rows[i][j];
}

CagStatus cag_conic_check(const CagConic *c, CagError *err) {
  for (int i = 0; i < 6; i++)
    if (!isfinite(c->c[i]))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "coefficients", i,
                      "`coefficients`[%d] is not a finite number", i);
  return CAG_OK;
}

double cag_conic_value(const CagConic *k, CagVec3 p) {
  const double *c = k->c;
  return (c[0] * p.x + c[1] * p.y + c[3]) * p.x + (c[2] * p.y + c[4]) * p.y + c[5];
}

void cag_conic_polar(const CagConic *k, CagVec3 p, double line[3]) {
  double s[3][3];
  matrix_of(k, s);
  for (int i = 0; i < 3; i++) line[i] = s[i][0] * p.x + s[i][1] * p.y + s[i][2];
}

// --- Images ---

// Transforms the form s0 of points u to the form m^-T s0 m^-1 of points m u. False: m is singular.
static bool carry(const double s0[3][3], const double m[3][3], CagConic *out) {
  double inverse[3][3], s[3][3] = {{0}}, size = 1;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      const int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
      inverse[i][j] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
    }
  double det = 0;
  for (int j = 0; j < 3; j++) {
    det += m[0][j] * inverse[j][0];
    size *= hypot(hypot(m[0][j], m[1][j]), m[2][j]);
  }
  if (!(fabs(det) > NOTHING * NOTHING * size)) return false;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
          s[i][j] += (inverse[a][i] / det) * s0[a][b] * (inverse[b][j] / det);
  *out = (CagConic){{s[0][0], 2 * s[0][1], s[1][1], 2 * s[0][2], 2 * s[1][2], s[2][2]}};
  return true;
}

CagStatus cag_conic_transform(const CagConic *c, const CagTransform *t, CagConic *out,
                              CagError *err) {
  static const int place[3] = {0, 1, 3};
  double s[3][3], m[3][3];
  matrix_of(c, s);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) m[i][j] = t->m[place[i]][place[j]];
  if (carry(s, m, out)) return CAG_OK;
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_singular_transform, "", -1,
                  "the transform is singular, so the conic has no image");
}

// --- Classification ---

// Normalizes the angle of an axis, which has no direction, to (-pi/2, pi/2].
static double axis_angle(double angle) {
  const double half = M_PI / 2;
  while (angle > half) angle -= M_PI;
  while (angle <= -half) angle += M_PI;
  // -90deg up to rounding is 90deg.
  return angle < -half * (1 - NOTHING) ? half : angle;
}

static void add_line(CagConicClass *out, double p, double q, double r) {
  const double n = hypot(p, q);
  double *line = out->lines[out->line_count++];
  line[0] = fabs(p) <= NOTHING * n ? 0 : p / n;
  line[1] = fabs(q) <= NOTHING * n ? 0 : q / n;
  line[2] = r / n;
  const double sign = line[0] < 0 || (line[0] == 0 && line[1] < 0) ? -1 : 1;
  for (int i = 0; i < 3; i++) line[i] = sign * line[i] + 0.0;
}

// A = B = C = 0.
static void classify_linear(const double *c, CagConicClass *out) {
  if (c[3] != 0 || c[4] != 0) {
    out->name = "line";
    add_line(out, c[3], c[4], c[5]);
    return;
  }
  out->name = c[5] == 0 ? "plane" : "empty";
}

// Values as in textbooks: the angle that removes the xy term, and the coefficients in those axes.
static void turn_axes(const double *c, CagConicClass *out) {
  double sine, cosine, angle = 0;
  if (c[1] != 0) angle = c[0] == c[2] ? copysign(M_PI / 4, c[1]) : atan(c[1] / (c[0] - c[2])) / 2;
  cag_sincos(angle, &sine, &cosine);
  out->book_angle = angle;
  const double cc = cosine * cosine, cs = cosine * sine, ss = sine * sine;
  double *r = out->rotated;
  r[0] = c[0] * cc + c[1] * cs + c[2] * ss;
  r[1] = 0;
  r[2] = c[0] * ss - c[1] * cs + c[2] * cc;
  r[3] = c[3] * cosine + c[4] * sine;
  r[4] = c[4] * cosine - c[3] * sine;
  r[5] = c[5];
}

typedef struct Eigen {
  double l1, l2; // l1 belongs to the axis at `angle`, l2 to the one perpendicular to it
  double angle;
} Eigen;

static Eigen eigen_of(const double *c) {
  const double spread = hypot(c[0] - c[2], c[1]), sum = c[0] + c[2];
  Eigen e = {(sum + spread) / 2, (sum - spread) / 2, 0};
  // The smaller eigenvalue is the determinant over the larger, since the difference would cancel.
  const double det = c[0] * c[2] - c[1] * c[1] / 4;
  if (sum > 0) e.l2 = det / e.l1;
  else if (sum < 0) e.l1 = det / e.l2;
  if (spread > 0) e.angle = atan2(c[1], c[0] - c[2]) / 2;
  return e;
}

static void set_ellipse(Eigen e, double semi1, double semi2, CagConicClass *out) {
  const bool first = semi1 >= semi2;
  const bool round = fabs(e.l1 - e.l2) <= ROUND * fabs(e.l1 + e.l2);
  out->name = round ? "circle" : "ellipse";
  out->a = sqrt(first ? semi1 : semi2);
  out->b = sqrt(first ? semi2 : semi1);
  out->angle = round ? 0 : axis_angle(first ? e.angle : e.angle + M_PI / 2);
  out->eccentricity = sqrt(fmax(0, 1 - (out->b / out->a) * (out->b / out->a)));
  if (round) out->eccentricity = 0;
}

static void set_foci(CagConicClass *out) {
  double sine, cosine;
  const double c = out->eccentricity * out->a;
  cag_sincos(out->angle, &sine, &cosine);
  out->focus_count = c == 0 ? 1 : 2;
  for (size_t i = 0; i < out->focus_count; i++)
    out->foci[i] = cag_madd(out->center, i == 0 ? c : -c, cag_vec3(cosine, sine, 0));
}

static void classify_central(const double *c, Eigen e, CagConicClass *out) {
  const double disc = out->discriminant;
  const double m = (2 * c[2] * c[3] - c[1] * c[4]) / disc;
  const double n = (2 * c[0] * c[4] - c[1] * c[3]) / disc;
  out->center = cag_vec3(m + 0.0, n + 0.0, 0);
  out->has_center = true;
  double f = c[5] + (c[3] * m + c[4] * n) / 2;
  if (fabs(f) <= NOTHING * (fabs(c[5]) + (fabs(c[3] * m) + fabs(c[4] * n)) / 2)) f = 0;
  out->standard[0] = out->rotated[0];
  out->standard[1] = out->rotated[2];
  out->standard[2] = -f + 0.0;
  const bool alike = e.l1 * e.l2 > 0;
  if (f == 0 && alike) {
    out->name = "point";
    return;
  }
  if (f == 0) {
    out->name = "intersecting_lines";
    double sine, cosine;
    cag_sincos(e.angle, &sine, &cosine);
    const double u = sqrt(fabs(e.l1)), v = sqrt(fabs(e.l2));
    for (int sign = 1; sign >= -1; sign -= 2) {
      double p = u * cosine - sign * v * sine, q = u * sine + sign * v * cosine;
      add_line(out, p, q, -(p * m + q * n));
    }
    return;
  }
  const double semi1 = -f / e.l1, semi2 = -f / e.l2;
  if (alike && semi1 < 0) {
    out->name = "empty";
    return;
  }
  if (alike) {
    set_ellipse(e, semi1, semi2, out);
  } else {
    out->name = "hyperbola";
    out->a = sqrt(fmax(semi1, semi2));
    out->b = sqrt(-fmin(semi1, semi2));
    out->angle = axis_angle(semi1 > 0 ? e.angle : e.angle + M_PI / 2);
    out->eccentricity = hypot(out->a, out->b) / out->a;
  }
  set_foci(out);
}

// l y^2 + d1 x + d2 y + F = 0 along the axes e1, e2, where e2 is the eigenvector of l.
static void classify_flat(const double *c, Eigen e, CagConicClass *out) {
  const bool first = fabs(e.l1) > fabs(e.l2);
  const double l = first ? e.l1 : e.l2;
  double sine, cosine;
  cag_sincos(first ? e.angle - M_PI / 2 : e.angle, &sine, &cosine);
  const CagVec3 e1 = {cosine, sine, 0}, e2 = {-sine, cosine, 0};
  const double d1 = c[3] * e1.x + c[4] * e1.y, d2 = c[3] * e2.x + c[4] * e2.y;
  const double y0 = -d2 / (2 * l);
  double f = c[5] - d2 * d2 / (4 * l);
  if (fabs(d1) > FLAT * (hypot(c[3], c[4]) + sqrt(fabs(l * c[5])))) {
    out->name = "parabola";
    out->center = cag_madd(cag_scaled(e1, -f / d1), y0, e2);
    out->center = cag_vec3(out->center.x + 0.0, out->center.y + 0.0, 0);
    out->a = fabs(d1 / l) / 4;
    const CagVec3 into = cag_scaled(e1, d1 / l > 0 ? -1 : 1);
    out->angle = atan2(into.y, into.x);
    if (out->angle < -M_PI * (1 - NOTHING)) out->angle = M_PI;
    out->eccentricity = 1;
    out->focus_count = 1;
    out->foci[0] = cag_madd(out->center, out->a, into);
    return;
  }
  if (fabs(f) <= NOTHING * (fabs(c[5]) + d2 * d2 / fabs(4 * l))) {
    out->name = "double_line";
    add_line(out, e2.x, e2.y, -y0);
  } else if (f / l < 0) {
    out->name = "parallel_lines";
    add_line(out, e2.x, e2.y, -y0 - sqrt(-f / l));
    add_line(out, e2.x, e2.y, -y0 + sqrt(-f / l));
  } else {
    out->name = "empty";
  }
}

CagStatus cag_conic_classify(const CagConic *conic, CagConicClass *out, CagError *err) {
  CagStatus status = cag_conic_check(conic, err);
  if (status) return status;
  const double *c = conic->c;
  *out = (CagConicClass){.discriminant = c[1] * c[1] - 4 * c[0] * c[2]};
  turn_axes(c, out);
  const double scale = fmax(fabs(c[0]), fmax(fabs(c[1]), fabs(c[2])));
  if (scale == 0) {
    classify_linear(c, out);
    return CAG_OK;
  }
  Eigen e = eigen_of(c);
  const double small = fmin(fabs(e.l1), fabs(e.l2)), large = fmax(fabs(e.l1), fabs(e.l2));
  if (small > FLAT * large) classify_central(c, e, out);
  else classify_flat(c, e, out);
  return CAG_OK;
}

// --- Its curves ---

// From the standard position to the position of the conic.
static CagTransform place_of(const CagConicClass *k) {
  double sine, cosine;
  CagTransform t = cag_translate(k->center);
  cag_sincos(k->angle, &sine, &cosine);
  t.m[0][0] = t.m[1][1] = cosine;
  t.m[0][1] = -sine + 0.0;
  t.m[1][0] = sine;
  t.planar = true;
  return t;
}

static CagTransform mirrored(const CagTransform *t) {
  CagTransform m = *t;
  for (int i = 0; i < 3; i++) m.m[i][0] = -m.m[i][0] + 0.0;
  return m;
}

static CagStatus line_piece(const double line[3], CagVec3 near, double from, double to,
                            CagCurve **out, CagError *err) {
  const CagVec3 n = {line[0], line[1], 0}, d = {-line[1], line[0], 0};
  const CagVec3 foot = cag_madd(near, -(cag_dot(n, near) + line[2]), n);
  return cag_curve_line(cag_madd(foot, from, d), cag_madd(foot, to, d), 2, out, err);
}

CagStatus cag_conic_branches(const CagConic *c, double from, double to, CagCurve *out[2], size_t *n,
                             CagError *err) {
  CagConicClass k;
  CagStatus status = cag_conic_classify(c, &k, err);
  if (status) return status;
  if (!(from < to) || !isfinite(from) || !isfinite(to))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_empty_range, "range", -1,
                    "`range` must be finite and its start less than its end");
  *n = 0;
  const CagTransform place = place_of(&k), other = mirrored(&place);
  if (k.line_count > 0) {
    for (size_t i = 0; !status && i < k.line_count; i++) {
      status = line_piece(k.lines[i], k.center, from, to, &out[i], err);
      if (!status) ++*n;
    }
  } else if (k.a > 0) {
    if (k.eccentricity < 1) status = cag_curve_arc(k.a, k.b, 0, 2 * M_PI, &place, &out[0], err);
    else if (k.eccentricity == 1)
      status = cag_curve_parabola(k.a, CAG_FORM_QUADRATIC, from, to, &place, &out[0], err);
    else
      status = cag_curve_hyperbola(k.a, k.b, CAG_FORM_HYPERBOLIC, from, to, &place, &out[0], err);
    if (!status) ++*n;
    if (!status && k.eccentricity > 1) {
      status = cag_curve_hyperbola(k.a, k.b, CAG_FORM_HYPERBOLIC, from, to, &other, &out[1], err);
      if (!status) ++*n;
    }
  }
  if (status)
    while (*n > 0) cag_curve_release(out[--*n]);
  return status;
}

static CagStatus not_a_conic(CagError *err) {
  return cag_fail(
      err, CAG_E_ARGUMENT, CAG_ERR_not_a_conic, "", -1,
      "expects a conic of the plane: a circle, ellipse, parabola or hyperbola or an arc "
      "of one, a line, a Bezier curve of degree 2, or conic(coefficients)");
}

static bool carry_axes(const double s0[3][3], CagVec3 x, CagVec3 y, CagVec3 center, CagConic *out) {
  const double m[3][3] = {{x.x, y.x, center.x}, {x.y, y.y, center.y}, {0, 0, 1}};
  return carry(s0, m, out);
}

// b1^2 / (b0 b2) is constant along a quadratic Bezier curve with b = weight times Bernstein
// polynomial, and b / sum are the barycentric coordinates of the triangle of control points.
static bool conic_of_bezier(const double *h, CagConic *out) {
  double m[3][3];
  for (int j = 0; j < 3; j++) {
    const double *p = h + 4 * j;
    if (!(p[3] > 0)) return false;
    m[0][j] = p[0] / p[3];
    m[1][j] = p[1] / p[3];
    m[2][j] = 1;
  }
  const double ends = h[3] * h[11], middle = h[7] * h[7];
  const double s0[3][3] = {{0, 0, -2 * middle}, {0, ends, 0}, {-2 * middle, 0, 0}};
  return carry(s0, m, out);
}

// Sum of the magnitudes of the terms at p, to which the value there is compared.
static double terms_at(const CagConic *k, CagVec3 p) {
  const double *c = k->c;
  return fabs(c[0] * p.x * p.x) + fabs(c[1] * p.x * p.y) + fabs(c[2] * p.y * p.y) +
         fabs(c[3] * p.x) + fabs(c[4] * p.y) + fabs(c[5]);
}

// Whether the other pieces of a quadratic NURBS curve are on the conic of the first, tested at five
// points of each.
static bool all_on(const CagNurbs *c, const CagConic *k) {
  enum { POINTS = 5 };
  for (size_t i = 0; i < c->pieces; i++)
    for (int j = 0; j < POINTS; j++) {
      const double t = c->cuts[i] + (c->cuts[i + 1] - c->cuts[i]) * j / POINTS;
      CagVec3 p;
      CagError ignored;
      if (cag_curve_point(&c->base, t, &p, &ignored) ||
          fabs(cag_conic_value(k, p)) > ROUND * terms_at(k, p))
        return false;
    }
  return true;
}

CagStatus cag_conic_of_curve(const CagCurve *c, CagConic *out, CagError *err) {
  static const double circle[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
  static const double hyperbola[3][3] = {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  static const double parabola[3][3] = {{0, 0, -0.5}, {0, 1, 0}, {-0.5, 0, 0}};
  CagVec3 center, x, y;
  const CagVec3 *p;
  double rate;
  size_t n;
  bool closed;
  CagOpenConic open;
  const CagNurbs *nurbs = cag_nurbs_data(c);
  if (cag_curve_conic_view(c, out)) return CAG_OK;
  if (c->dimension != 2) return not_a_conic(err);
  if (cag_curve_arc_axes(c, &center, &x, &y, &rate))
    return carry_axes(circle, x, y, center, out) ? CAG_OK : not_a_conic(err);
  if (cag_curve_open_conic(c, &open)) {
    bool flat = open.form == CAG_FORM_QUADRATIC || open.form == CAG_FORM_TANGENT;
    return carry_axes(flat ? parabola : hyperbola, open.x, open.y, open.center, out)
               ? CAG_OK
               : not_a_conic(err);
  }
  if (cag_curve_vertices(c, &p, &n, &closed) && n == 2) {
    const CagVec3 d = cag_sub(p[1], p[0]);
    *out = (CagConic){{0, 0, 0, d.y, -d.x, d.x * p[0].y - d.y * p[0].x}};
    return CAG_OK;
  }
  if (nurbs && nurbs->degree == 2 && conic_of_bezier(nurbs->bezier, out) && all_on(nurbs, out))
    return CAG_OK;
  return not_a_conic(err);
}

// Axes of the plane: those of z = 0 if it is parallel to that, else with a horizontal x axis. The
// origin is the point of the plane nearest to the origin of space.
static CagStatus plane_frame(CagPlane plane, CagTransform *out, CagError *err) {
  CagVec3 n = plane.normal;
  if (n.z < 0 || (n.z == 0 && (n.y < 0 || (n.y == 0 && n.x < 0)))) n = cag_scaled(n, -1);
  CagVec3 x = {-n.y, n.x, 0};
  const double level = CAG_ROUNDING; // sine of an angle caused by rounding
  if (cag_norm(x) <= level) x = cag_vec3(1, 0, 0);
  return cag_axes(cag_scaled(n, cag_dot(plane.point, n)), x, cag_cross(n, x), out, err);
}

CagStatus cag_conic_of_space_curve(const CagCurve *c, CagTransform *frame, CagConic *out,
                                   CagError *err) {
  CagPlane plane;
  CagTransform into;
  CagCurve *flat;
  bool planar;
  if (c->dimension != 3) return not_a_conic(err);
  CagStatus status = cag_curve_is_planar(c, &planar, &plane, err);
  if (!status && !planar) status = not_a_conic(err);
  if (!status) status = plane_frame(plane, frame, err);
  if (!status) status = cag_transform_inverse(frame, &into, err);
  if (!status) status = cag_curve_transform(c, &into, &flat, err);
  if (status) return status;
  cag_curve_lay_flat(flat);
  status = cag_conic_of_curve(flat, out, err);
  cag_curve_release(flat);
  return status;
}

// --- Segments ---

static CagStatus fail_segment(double x, CagError *err) {
  char text[32];
  return cag_fail(err, CAG_E_DOMAIN, CAG_ERR_conic_domain, "x", -1,
                  "the conic has no real point at x = %s", cag_number_text(x, text));
}

CagStatus cag_conic_point_at(const CagConic *conic, double x, bool upper, CagVec3 *out,
                             CagError *err) {
  const double *c = conic->c, b = c[1] * x + c[4], e = (c[0] * x + c[3]) * x + c[5];
  const double scale = fmax(fabs(c[0]), fmax(fabs(c[1]), fabs(c[2])));
  const double b_size = fabs(c[1] * x) + fabs(c[4]);
  const double e_size = fabs(c[0] * x * x) + fabs(c[3] * x) + fabs(c[5]);
  if (fabs(c[2]) <= NOTHING * scale) {
    if (b == 0) return fail_segment(x, err);
    *out = cag_vec3(x, -e / b, 0);
    return CAG_OK;
  }
  double disc = b * b - 4 * c[2] * e;
  if (disc < 0 && -disc <= NOTHING * (b_size * b_size + 4 * fabs(c[2]) * e_size)) disc = 0;
  if (disc < 0) return fail_segment(x, err);
  const double q = -(b + copysign(sqrt(disc), b)) / 2, first = q / c[2];
  const double second = q != 0 ? e / q : first;
  *out = cag_vec3(x, upper ? fmax(first, second) : fmin(first, second), 0);
  return CAG_OK;
}

// A point in standard position.
static CagVec3 local_of(const CagConicClass *k, CagVec3 p) {
  double sine, cosine;
  cag_sincos(k->angle, &sine, &cosine);
  const CagVec3 d = cag_sub(p, k->center);
  return cag_vec3(d.x * cosine + d.y * sine, d.y * cosine - d.x * sine, 0);
}

// Arc from t0 to t1, in either direction.
static CagStatus directed(CagStatus status, bool backwards, CagCurve *forward, CagCurve **out,
                          CagError *err) {
  if (status) return status;
  *out = forward;
  if (!backwards) return CAG_OK;
  status = cag_curve_reverse(forward, out, err);
  cag_curve_release(forward);
  return status;
}

static CagStatus segment_of_lines(const CagConic *c, CagVec3 p, CagVec3 q, CagCurve **out,
                                  CagError *err) {
  const CagVec3 middle = cag_lerp(p, q, 0.5);
  if (fabs(cag_conic_value(c, middle)) > ROUND * terms_at(c, middle))
    return cag_fail(err, CAG_E_DOMAIN, CAG_ERR_conic_domain, "x", -1,
                    "the two ends lie on different lines of the conic");
  return cag_curve_line(p, q, 2, out, err);
}

CagStatus cag_conic_segment(const CagConic *c, double from, double to, bool upper, CagCurve **out,
                            CagError *err) {
  CagConicClass k;
  CagVec3 p, q;
  CagCurve *forward = NULL;
  CagStatus status = cag_conic_classify(c, &k, err);
  if (!status && from == to)
    status = cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_empty_range, "x", -1, "the range of x is empty");
  if (!status) status = cag_conic_point_at(c, from, upper, &p, err);
  if (!status) status = cag_conic_point_at(c, to, upper, &q, err);
  if (status) return status;
  if (k.line_count > 0) return segment_of_lines(c, p, q, out, err);
  if (!(k.a > 0)) return fail_segment(from, err);

  const CagTransform place = place_of(&k), other = mirrored(&place);
  const CagVec3 a = local_of(&k, p), b = local_of(&k, q);
  if (k.eccentricity < 1) {
    double t0 = atan2(a.y / k.b, a.x / k.a), t1 = atan2(b.y / k.b, b.x / k.a);
    const bool turned_left = upper == (to < from);
    double start = turned_left ? t0 : t1, end = turned_left ? t1 : t0;
    if (end <= start) end += 2 * M_PI;
    status = cag_curve_arc(k.a, k.b, start, end, &place, &forward, err);
    return directed(status, !turned_left, forward, out, err);
  }
  if (k.eccentricity == 1) {
    const double t0 = a.y / (2 * k.a), t1 = b.y / (2 * k.a);
    status = cag_curve_parabola(k.a, CAG_FORM_QUADRATIC, fmin(t0, t1), fmax(t0, t1), &place,
                                &forward, err);
    return directed(status, t1 < t0, forward, out, err);
  }
  if ((a.x < 0) != (b.x < 0))
    return cag_fail(err, CAG_E_DOMAIN, CAG_ERR_conic_domain, "x", -1,
                    "the two ends lie on different branches of the hyperbola: the segment would "
                    "cross the gap between them");
  const double t0 = asinh(a.y / k.b), t1 = asinh(b.y / k.b);
  status = cag_curve_hyperbola(k.a, k.b, CAG_FORM_HYPERBOLIC, fmin(t0, t1), fmax(t0, t1),
                               a.x < 0 ? &other : &place, &forward, err);
  return directed(status, t1 < t0, forward, out, err);
}

// --- Lines ---

CagStatus cag_conic_line(const CagConic *conic, CagVec3 p, CagVec3 d, CagLineConic *kind,
                         double t[2], CagError *err) {
  CagConicClass k;
  CagStatus status = cag_conic_classify(conic, &k, err);
  if (status) return status;
  const double dd = cag_dot(d, d);
  if (!(dd > 0))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_zero_vector, "", -1,
                    "the direction of the line is zero");
  // Relative to the center, and from the line's point nearest to it, the numbers stay small; the
  // shift adds only the rounding of its terms.
  const CagVec3 m = k.center;
  const double *g = conic->c;
  const double c[6] = {g[0],
                       g[1],
                       g[2],
                       2 * g[0] * m.x + g[1] * m.y + g[3],
                       2 * g[2] * m.y + g[1] * m.x + g[4],
                       cag_conic_value(conic, m)};
  const double rounding = 8 * DBL_EPSILON * terms_at(conic, m);
  const double quadratic = fabs(g[0]) + fabs(g[1]) + fabs(g[2]), linear = hypot(g[3], g[4]);
  const double reach = fmax(cag_norm(m), cag_norm(p));
  const double slope_rounding = 16 * DBL_EPSILON * (quadratic * reach + linear) * sqrt(dd);
  const double shift = cag_dot(cag_sub(m, p), d) / dd;
  const CagVec3 o = cag_sub(cag_madd(p, shift, d), m);
  const double terms[6] = {c[0] * o.x * o.x, c[1] * o.x * o.y, c[2] * o.y * o.y,
                           c[3] * o.x,       c[4] * o.y,       c[5]};
  const double slopes[5] = {2 * c[0] * o.x * d.x, c[1] * (o.x * d.y + o.y * d.x),
                            2 * c[2] * o.y * d.y, c[3] * d.x, c[4] * d.y};
  double q2 = c[0] * d.x * d.x + c[1] * d.x * d.y + c[2] * d.y * d.y, q1 = 0, q0 = 0;
  double size2 = fabs(c[0] * d.x * d.x) + fabs(c[1] * d.x * d.y) + fabs(c[2] * d.y * d.y);
  double size1 = 0, size0 = 0;
  for (int i = 0; i < 5; i++) {
    q1 += slopes[i];
    size1 += fabs(slopes[i]);
  }
  for (int i = 0; i < 6; i++) {
    q0 += terms[i];
    size0 += fabs(terms[i]);
  }
  const bool flat = fabs(q2) <= NOTHING * size2;
  if (flat && fabs(q1) <= NOTHING * size1 + slope_rounding) {
    *kind = fabs(q0) <= NOTHING * size0 + rounding ? CAG_LINE_WITHIN : CAG_LINE_NONE;
    return CAG_OK;
  }
  if (flat) {
    *kind = CAG_LINE_ONE;
    t[0] = t[1] = shift - q0 / q1;
    return CAG_OK;
  }
  const double disc = q1 * q1 - 4 * q2 * q0;
  if (fabs(disc) <= NOTHING * (q1 * q1 + 4 * fabs(q2) * size0) + 4 * fabs(q2) * rounding) {
    *kind = CAG_LINE_TANGENT;
    t[0] = t[1] = shift - q1 / (2 * q2);
    return CAG_OK;
  }
  if (disc < 0) {
    *kind = CAG_LINE_NONE;
    return CAG_OK;
  }
  const double q = -(q1 + copysign(sqrt(disc), q1)) / 2, a = q / q2, b = q0 / q;
  *kind = CAG_LINE_TWO;
  t[0] = shift + fmin(a, b);
  t[1] = shift + fmax(a, b);
  return CAG_OK;
}
