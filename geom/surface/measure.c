// Areas, volume integrals, and tight bounds of surfaces.
//
// Integrals are computed cell by cell between the breaks, where the surface is smooth, by the
// tensor product of the 15 point Gauss-Kronrod rule. If the embedded 7 point Gauss rule disagrees,
// the cell is halved in the direction of the larger disagreement. A flat piece has a closed form:
// moments of its region by Green's theorem, along the boundary curves.

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "geom/curve/family.h"
#include "geom/curve/line_integral.h"
#include "geom/surface/family.h"
#include "geom/surface/function.h"
#include "geom/surface/trimmed.h"

// Nodes of the 15 point Kronrod rule on -1..1 (the odd ones are those of the 7 point Gauss rule)
// and the weights of both (Piessens et al., QUADPACK).
#define NODES 15
static const double NODE[NODES] = {
    -0.991455371120812639206854697526329, -0.949107912342758524526189684047851,
    -0.864864423359769072789712788640926, -0.741531185599394439863864773280788,
    -0.586087235467691130294144691693413, -0.405845151377397166906606412076961,
    -0.207784955007898467600689403773245, 0,
    0.207784955007898467600689403773245,  0.405845151377397166906606412076961,
    0.586087235467691130294144691693413,  0.741531185599394439863864773280788,
    0.864864423359769072789712788640926,  0.949107912342758524526189684047851,
    0.991455371120812639206854697526329};
static const double KRONROD[NODES] = {
    0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
    0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
    0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
    0.204432940075298892414161999234649, 0.209482141084727828012999174891714,
    0.204432940075298892414161999234649, 0.190350578064785409913256402421014,
    0.169004726639267902826583426598550, 0.140653259715525918745189590510238,
    0.104790010322250183839876322541518, 0.063092092629978553290700663189204,
    0.022935322010529224963732008058970};
static const double GAUSS[NODES] = {
    0, 0.129484966168869693270611432679082, 0, 0.279705391489276667901467771423780,
    0, 0.381830050505118944950369775488975, 0, 0.417959183673469387755102040816327,
    0, 0.381830050505118944950369775488975, 0, 0.279705391489276667901467771423780,
    0, 0.129484966168869693270611432679082, 0};

// A cell is accepted if its rules differ by less than this fraction of the whole; the Kronrod value
// is far more accurate than the difference, so the documented 1e-8 has a margin.
#define CELL_TOLERANCE 1e-10
#define MAX_DEPTH 60
// Convergent integrals never need this many cells; others must terminate.
#define MAX_CELLS 20000
// A term below this fraction of what the extent of the surface allows is mostly rounding (such as
// the flux through a vertical wall) and is not refined further.
#define SMALLEST_TERM 1e-4
// A surface whose extent is below this fraction of its distance from the origin is a point up to
// rounding, and its apparent area is rounding as well.
#define POINT_EXTENT 1e-9
#define MAX_TERMS 10

typedef void Integrand(CagVec3 p, CagVec3 du, CagVec3 dv, double *out);

typedef struct Integral {
  const CagSurface *s;
  Integrand *f;
  size_t terms;
  const int *powers; // powers of length of each term in addition to an area
  double sum[MAX_TERMS];
  double size[MAX_TERMS]; // of the magnitudes, estimated from the first pass
  double area, reach; // of the surface, and largest distance from the origin, from the first pass
  size_t budget;      // number of cells left
} Integral;

typedef struct Cell {
  double u0, u1, v0, v1;
} Cell;

typedef struct CellSums {
  double fine[MAX_TERMS], magnitude[MAX_TERMS];
  double error_u, error_v; // largest disagreement, relative to the sizes of the integrals
} CellSums;

static CagStatus sum_cell(Integral *in, const Cell *c, bool judge, CellSums *out, CagError *err) {
  double us[NODES], vs[NODES];
  CagVec3 p[NODES * NODES], du[NODES * NODES], dv[NODES * NODES];
  double hu = (c->u1 - c->u0) / 2, hv = (c->v1 - c->v0) / 2;
  for (int i = 0; i < NODES; i++) {
    us[i] = (c->u0 + c->u1) / 2 + hu * NODE[i];
    vs[i] = (c->v0 + c->v1) / 2 + hv * NODE[i];
  }
  CagStatus status = cag_surface_eval_grid(in->s, us, NODES, vs, NODES, p, du, dv, err);
  if (status) return status;
  double coarse_u[MAX_TERMS] = {0}, coarse_v[MAX_TERMS] = {0};
  memset(out, 0, sizeof *out);
  for (int i = 0; i < NODES; i++)
    for (int j = 0; j < NODES; j++) {
      double value[MAX_TERMS];
      int at = i * NODES + j;
      in->f(p[at], du[at], dv[at], value);
      if (!judge) {
        in->area += KRONROD[i] * KRONROD[j] * hu * hv * cag_norm(cag_cross(du[at], dv[at]));
        in->reach = fmax(in->reach, cag_norm(p[at]));
      }
      double w = KRONROD[i] * KRONROD[j] * hu * hv;
      double wu = GAUSS[i] * KRONROD[j] * hu * hv, wv = KRONROD[i] * GAUSS[j] * hu * hv;
      for (size_t k = 0; k < in->terms; k++) {
        out->fine[k] += w * value[k];
        out->magnitude[k] += w * fabs(value[k]);
        coarse_u[k] += wu * value[k];
        coarse_v[k] += wv * value[k];
      }
    }
  for (size_t k = 0; judge && k < in->terms; k++) {
    if (!(in->size[k] > 0)) continue;
    out->error_u = fmax(out->error_u, fabs(out->fine[k] - coarse_u[k]) / in->size[k]);
    out->error_v = fmax(out->error_v, fabs(out->fine[k] - coarse_v[k]) / in->size[k]);
  }
  return CAG_OK;
}

static CagStatus refine(Integral *in, const Cell *c, int depth, CagError *err) {
  CellSums sums;
  CagStatus status = sum_cell(in, c, true, &sums, err);
  if (status) return status;
  if (fmax(sums.error_u, sums.error_v) <= CELL_TOLERANCE || depth >= MAX_DEPTH || in->budget == 0) {
    for (size_t k = 0; k < in->terms; k++) in->sum[k] += sums.fine[k];
    return CAG_OK;
  }
  in->budget--;
  Cell a = *c, b = *c;
  if (sums.error_u >= sums.error_v) a.u1 = b.u0 = (c->u0 + c->u1) / 2;
  else a.v1 = b.v0 = (c->v0 + c->v1) / 2;
  status = refine(in, &a, depth + 1, err);
  return status ? status : refine(in, &b, depth + 1, err);
}

static CagStatus integrate(Integral *in, CagError *err) {
  double *us = NULL, *vs = NULL;
  size_t nu, nv;
  CagStatus status = cag_surface_cuts(in->s, 0, &us, &nu, err);
  if (!status) status = cag_surface_cuts(in->s, 1, &vs, &nv, err);
  in->budget = MAX_CELLS;
  for (int pass = 0; !status && pass < 2; pass++) {
    const double point = POINT_EXTENT * in->reach;
    const double least = fmax(SMALLEST_TERM * in->area, point * point);
    for (size_t k = 0; pass == 1 && k < in->terms; k++)
      in->size[k] = fmax(in->size[k], least * pow(in->reach, in->powers[k]));
    for (size_t i = 0; !status && i < nu; i++)
      for (size_t j = 0; !status && j < nv; j++) {
        Cell c = {us[i], us[i + 1], vs[j], vs[j + 1]};
        CellSums sums;
        if (pass == 1) status = refine(in, &c, 0, err);
        else status = sum_cell(in, &c, false, &sums, err);
        for (size_t k = 0; !status && pass == 0 && k < in->terms; k++)
          in->size[k] += sums.magnitude[k];
      }
  }
  cag_free(us);
  cag_free(vs);
  return status;
}

static const int AREA_POWERS[] = {0, 1, 1, 1}, FLUX_POWERS[] = {1, 2, 2, 2, 3, 3, 3, 3, 3, 3};

static void area_terms(CagVec3 p, CagVec3 du, CagVec3 dv, double *out) {
  double a = cag_norm(cag_cross(du, dv));
  out[0] = a;
  out[1] = a * p.x;
  out[2] = a * p.y;
  out[3] = a * p.z;
}

// Each volume integral as a flux (divergence theorem); n is S_u x S_v.
static void flux_terms(CagVec3 p, CagVec3 du, CagVec3 dv, double *out) {
  CagVec3 n = cag_cross(du, dv);
  double xx = p.x * p.x, yy = p.y * p.y, zz = p.z * p.z;
  out[0] = cag_dot(p, n) / 3;
  out[1] = xx * n.x / 2;
  out[2] = yy * n.y / 2;
  out[3] = zz * n.z / 2;
  out[4] = xx * p.x * n.x / 3;
  out[5] = yy * p.y * n.y / 3;
  out[6] = zz * p.z * n.z / 3;
  out[7] = xx * p.y * n.x / 2;
  out[8] = yy * p.z * n.y / 2;
  out[9] = zz * p.x * n.z / 2;
}

// --- Flat pieces ---

// Tolerance of the moments of a region, as a fraction of the largest that its box allows.
#define MOMENTS 1e-13

// Moments of x^i y^j over the region, i + j <= 3, in the order of MOMENT.
static const int MOMENT[MAX_TERMS][2] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1},
                                         {0, 2}, {3, 0}, {2, 1}, {1, 2}, {0, 3}};

// The integrands of the line integrals of x^(i + 1) y^j / (i + 1) dy, each relative to what the box
// allows.
typedef struct Boundary {
  CagVec3 middle;
  double size[MAX_TERMS];
} Boundary;

static void boundary_terms(void *context, CagVec3 p, CagVec3 d, double *out) {
  const Boundary *b = context;
  double x = p.x - b->middle.x, y = p.y - b->middle.y;
  const double px[5] = {1, x, x * x, x * x * x, x * x * x * x}, py[4] = {1, y, y * y, y * y * y};
  for (int m = 0; m < MAX_TERMS; m++) {
    int i = MOMENT[m][0], j = MOMENT[m][1];
    out[m] = b->size[m] > 0 ? px[i + 1] * py[j] / (i + 1) * d.y / b->size[m] : 0;
  }
}

// Relative to the middle of the region's box, which keeps the powers small.
static CagStatus region_moments(const CagRegion *r, CagVec3 *middle, double *out, CagError *err) {
  CagBounds box;
  CagStatus status = cag_region_bounds(r, &box, err);
  if (status) return status;
  *middle = cag_lerp(box.min, box.max, 0.5);
  CagVec3 half = cag_scaled(cag_sub(box.max, box.min), 0.5);
  Boundary b = {.middle = *middle};
  for (int m = 0; m < MAX_TERMS; m++) {
    b.size[m] = half.x * half.y * pow(half.x, MOMENT[m][0]) * pow(half.y, MOMENT[m][1]);
    out[m] = 0;
  }
  for (size_t l = 0; !status && l < r->count; l++) {
    double part[MAX_TERMS];
    const CagCurve *loop = r->loops[l];
    status = cag_curve_integrate(loop, loop->start, loop->end, boundary_terms, &b, MAX_TERMS,
                                 MOMENTS, part, err);
    for (int m = 0; !status && m < MAX_TERMS; m++) out[m] += b.size[m] * part[m];
  }
  return status;
}

// A polynomial in x, y of degree at most 3, coefficients in the order of MOMENT.
typedef struct Cubic {
  double c[MAX_TERMS];
} Cubic;

static Cubic multiply(const Cubic *a, const Cubic *b) {
  Cubic out = {{0}};
  for (int i = 0; i < MAX_TERMS; i++)
    for (int j = 0; j < MAX_TERMS; j++)
      for (int k = 0; k < MAX_TERMS; k++)
        if (MOMENT[k][0] == MOMENT[i][0] + MOMENT[j][0] &&
            MOMENT[k][1] == MOMENT[i][1] + MOMENT[j][1])
          out.c[k] += a->c[i] * b->c[j];
  return out;
}

static double over_region(const Cubic *a, const double *moments) {
  double sum = 0;
  for (int k = 0; k < MAX_TERMS; k++) sum += a->c[k] * moments[k];
  return sum;
}

static CagStatus planar_flux(const CagRegion *r, const CagTransform *frame, double terms[10],
                             CagError *err) {
  double moments[MAX_TERMS];
  CagVec3 middle;
  CagStatus status = region_moments(r, &middle, moments, err);
  if (status) return status;
  CagVec3 o = cag_transform_point(frame, cag_vec3(middle.x, middle.y, 0));
  CagVec3 a = cag_transform_vector(frame, cag_vec3(1, 0, 0));
  CagVec3 b = cag_transform_vector(frame, cag_vec3(0, 1, 0));
  CagVec3 n = cag_cross(a, b);
  const Cubic x = {{o.x, a.x, b.x}}, y = {{o.y, a.y, b.y}}, z = {{o.z, a.z, b.z}};
  const Cubic *p[3] = {&x, &y, &z};
  const double normal[3] = {n.x, n.y, n.z};
  for (int k = 0; k < 3; k++) {
    const Cubic *q = p[k], *next = p[(k + 1) % 3];
    Cubic square = multiply(q, q), cube = multiply(&square, q), mixed = multiply(&square, next);
    terms[0] += over_region(q, moments) * normal[k] / 3;
    terms[1 + k] += over_region(&square, moments) * normal[k] / 2;
    terms[4 + k] += over_region(&cube, moments) * normal[k] / 3;
    terms[7 + k] += over_region(&mixed, moments) * normal[k] / 2;
  }
  return CAG_OK;
}

static CagStatus planar_area(const CagRegion *r, const CagTransform *frame, double *area,
                             CagVec3 *centroid, CagError *err) {
  CagVec3 a = cag_transform_vector(frame, cag_vec3(1, 0, 0));
  CagVec3 b = cag_transform_vector(frame, cag_vec3(0, 1, 0)), flat;
  CagStatus status = cag_region_area(r, area, &flat, err);
  if (status) return status;
  *area *= cag_norm(cag_cross(a, b));
  if (centroid) *centroid = cag_transform_point(frame, cag_vec3(flat.x, flat.y, 0));
  return CAG_OK;
}

// --- Queries ---

CagStatus cag_surface_area(const CagSurface *s, double *area, CagVec3 *centroid, CagError *err) {
  const CagRegion *region;
  CagTransform frame;
  if (cag_surface_planar_view(s, &region, &frame))
    return planar_area(region, &frame, area, centroid, err);
  if (cag_surface_trimmed_view(s, NULL, NULL)) return cag_trimmed_area(s, area, centroid, err);
  Integral in = {.s = s, .f = area_terms, .terms = centroid ? 4 : 1, .powers = AREA_POWERS};
  CagStatus status = integrate(&in, err);
  if (status) return status;
  *area = in.sum[0];
  if (centroid && in.sum[0] > 0)
    *centroid = cag_scaled(cag_vec3(in.sum[1], in.sum[2], in.sum[3]), 1 / in.sum[0]);
  else if (centroid) return cag_surface_point(s, s->u0, s->v0, centroid, err);
  return CAG_OK;
}

CagStatus cag_surface_volume_terms(const CagSurface *s, double terms[10], CagError *err) {
  const CagRegion *region;
  CagTransform frame;
  if (cag_surface_planar_view(s, &region, &frame)) return planar_flux(region, &frame, terms, err);
  if (cag_surface_trimmed_view(s, NULL, NULL)) return cag_trimmed_volume_terms(s, terms, err);
  Integral in = {.s = s, .f = flux_terms, .terms = 10, .powers = FLUX_POWERS};
  CagStatus status = integrate(&in, err);
  for (int k = 0; !status && k < 10; k++) terms[k] += in.sum[k];
  return status;
}

// --- Bounds ---

// Sampling finds the peaks, Newton's method their maxima. Cells are sampled more densely if there
// are few of them.
#define FEW_CELLS 8
#define SAMPLES_FEW 24
#define SAMPLES_MANY 6
#define NEWTON_STEPS 40

static double coordinate(CagVec3 p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

// Maximizes sign * coordinate from (u, v) within the cell; returns the best value found.
static CagStatus climb(const CagSurface *s, const Cell *c, double u, double v, int axis,
                       double sign, double *best, CagError *err) {
  const bool formula = cag_surface_is_formula(s);
  double here = -INFINITY, step_limit = 1;
  double lu = c->u1 - c->u0, lv = c->v1 - c->v0, last_u = u, last_v = v;
  for (int k = 0; k < NEWTON_STEPS; k++) {
    CagVec3 d[9];
    CagSide su = u >= c->u1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
    CagSide sv = v >= c->v1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
    const double lo[2] = {c->u0, c->v0}, hi[2] = {c->u1, c->v1}, at[2] = {u, v};
    CagStatus status = formula ? cag_surface_eval_beside(s, lo, hi, at, 2, d, err)
                               : cag_surface_eval(s, u, v, 2, su, sv, d, err);
    if (status) return status;
    double value = sign * coordinate(d[0], axis);
    if (value > *best) *best = value;
    if (k > 0 && value < here) { // overshoot: halve the step
      step_limit /= 2;
      u = (u + last_u) / 2;
      v = (v + last_v) / 2;
      if (fabs(u - last_u) <= 1e-15 * lu && fabs(v - last_v) <= 1e-15 * lv) return CAG_OK;
      continue;
    }
    here = value;
    // In units of the cell.
    double gu = sign * coordinate(d[cag_partial(2, 1, 0)], axis) * lu;
    double gv = sign * coordinate(d[cag_partial(2, 0, 1)], axis) * lv;
    double huu = sign * coordinate(d[cag_partial(2, 2, 0)], axis) * lu * lu;
    double huv = sign * coordinate(d[cag_partial(2, 1, 1)], axis) * lu * lv;
    double hvv = sign * coordinate(d[cag_partial(2, 0, 2)], axis) * lv * lv;
    // Directions blocked by a border are removed.
    bool free_u = !((u <= c->u0 && gu <= 0) || (u >= c->u1 && gu >= 0));
    bool free_v = !((v <= c->v0 && gv <= 0) || (v >= c->v1 && gv >= 0));
    double su_ = 0, sv_ = 0, det = huu * hvv - huv * huv;
    if (free_u && free_v && huu < 0 && det > 0) {
      su_ = -(hvv * gu - huv * gv) / det;
      sv_ = -(huu * gv - huv * gu) / det;
    } else {
      if (free_u) su_ = huu < 0 ? -gu / huu : (gu > 0 ? 0.1 : gu < 0 ? -0.1 : 0);
      if (free_v) sv_ = hvv < 0 ? -gv / hvv : (gv > 0 ? 0.1 : gv < 0 ? -0.1 : 0);
      // Both directions together may cancel through the mixed term: use only the steeper one.
      if (free_u && free_v && fabs(gu) >= fabs(gv)) sv_ = 0;
      else if (free_u && free_v) su_ = 0;
    }
    double length = fmax(fabs(su_), fabs(sv_)), most = 0.25 * step_limit;
    if (length > most) {
      su_ *= most / length;
      sv_ *= most / length;
    }
    last_u = u;
    last_v = v;
    u = fmin(fmax(u + su_ * lu, c->u0), c->u1);
    v = fmin(fmax(v + sv_ * lv, c->v0), c->v1);
    if (u == last_u && v == last_v) return CAG_OK;
  }
  return CAG_OK;
}

// Extrema over one cell: starts from each sample that is a local maximum and could still enlarge
// the bounds.
static CagStatus bound_cell(const CagSurface *s, const Cell *c, size_t n, CagVec3 *points,
                            double best[6], CagError *err) {
  double us[SAMPLES_FEW + 1], vs[SAMPLES_FEW + 1];
  for (size_t i = 0; i <= n; i++) {
    double f = (double)i / (double)n;
    us[i] = i == n ? c->u1 : c->u0 + f * (c->u1 - c->u0);
    vs[i] = i == n ? c->v1 : c->v0 + f * (c->v1 - c->v0);
  }
  size_t row = n + 1;
  CagStatus status = cag_surface_eval_grid(s, us, row, vs, row, points, NULL, NULL, err);
  for (int e = 0; !status && e < 6; e++) {
    int axis = e / 2;
    double sign = e % 2 ? 1 : -1, top = -INFINITY, bottom = INFINITY;
    for (size_t i = 0; i < row * row; i++) {
      double value = sign * coordinate(points[i], axis);
      top = fmax(top, value);
      bottom = fmin(bottom, value);
    }
    // Generous estimate of how far a peak between samples may rise.
    double reserve = (top - bottom) * (n >= SAMPLES_FEW ? 0.05 : 0.25);
    if (top + reserve <= best[e]) continue;
    best[e] = fmax(best[e], top);
    for (size_t i = 0; !status && i < row; i++)
      for (size_t j = 0; !status && j < row; j++) {
        double value = sign * coordinate(points[i * row + j], axis);
        if (value + reserve < best[e]) continue;
        bool summit = true;
        for (int k = 0; summit && k < 9; k++) {
          size_t a = i + (size_t)(k / 3) - 1, b = j + (size_t)(k % 3) - 1;
          if (k == 4 || a > n || b > n) continue; // below 0 wraps above n
          double other = sign * coordinate(points[a * row + b], axis);
          // Among equal neighbors the first is used.
          summit = k < 4 ? value > other : value >= other;
        }
        if (summit) status = climb(s, c, us[i], vs[j], axis, sign, &best[e], err);
      }
  }
  return status;
}

static CagStatus planar_bounds(const CagRegion *r, const CagTransform *frame, CagBounds *out,
                               CagError *err) {
  CagBounds box = CAG_BOUNDS_EMPTY;
  for (size_t l = 0; l < r->count; l++) {
    if (r->outer[l] != l) continue;
    CagCurve *space = NULL, *moved = NULL;
    CagBounds part;
    CagStatus status = cag_surface_space_curve(r->loops[l], &space, err);
    if (!status) status = cag_curve_transform(space, frame, &moved, err);
    if (!status) status = cag_curve_bounds(moved, &part, err);
    cag_curve_release(space);
    cag_curve_release(moved);
    if (status) return status;
    cag_bounds_add(&box, part.min);
    cag_bounds_add(&box, part.max);
  }
  *out = box;
  return CAG_OK;
}

CagStatus cag_surface_bounds(const CagSurface *s, CagBounds *out, CagError *err) {
  const CagRegion *region;
  CagTransform frame;
  if (cag_surface_planar_view(s, &region, &frame)) return planar_bounds(region, &frame, out, err);
  if (cag_surface_trimmed_view(s, NULL, NULL)) return cag_trimmed_bounds(s, out, err);
  double *us = NULL, *vs = NULL;
  size_t nu = 0, nv = 0;
  CagVec3 *points = cag_malloc((SAMPLES_FEW + 1) * (SAMPLES_FEW + 1) * sizeof *points);
  CagStatus status = points ? cag_surface_cuts(s, 0, &us, &nu, err) : cag_fail_memory(err);
  if (!status) status = cag_surface_cuts(s, 1, &vs, &nv, err);
  double best[6];
  for (int e = 0; e < 6; e++) best[e] = -INFINITY;
  size_t n = nu * nv <= FEW_CELLS ? SAMPLES_FEW : SAMPLES_MANY;
  for (size_t i = 0; !status && i < nu; i++)
    for (size_t j = 0; !status && j < nv; j++) {
      Cell c = {us[i], us[i + 1], vs[j], vs[j + 1]};
      status = bound_cell(s, &c, n, points, best, err);
    }
  cag_free(points);
  cag_free(us);
  cag_free(vs);
  if (status) return status;
  *out = (CagBounds){{-best[0], -best[2], -best[4]}, {best[1], best[3], best[5]}};
  return CAG_OK;
}
