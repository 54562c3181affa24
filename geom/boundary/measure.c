// Areas and mass properties of boundaries (see measure.h).
//
// An integral of f over a face is the integral of F dv along its loops, where F is the integral of
// f in u from any fixed value, or that of -G du, where G is the integral of f in v. On surfaces of
// revolution, F is that of a trigonometric polynomial, and on ruled ones, G is that of a
// polynomial, so that Gauss's quadrature with few points is exact or accurate to rounding. Splines
// need adaptive quadrature.
//
// Loops run clockwise in the parameters of a reversed face, which gives the flux along its outward
// normal. Coordinates are relative to the middle of the boundary, and lengths to its size.

#include "geom/boundary/measure.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/basis/quadrature.h"
#include "geom/boundary/carrier.h"
#include "geom/curve/family.h"

// Area and its three moments; then the fluxes of surface.h: volume, moments, and inertia, of which
// those that have a factor of 1/3 are three times as large.
#define AREA_TERMS 4
#define TERMS 14

// Differences of the rules below this fraction of the integral of magnitudes are ignored. The inner
// integral is the integrand of the outer one and must be more accurate.
#define OUTER 1e-11
#define INNER 1e-12

// Gauss-Legendre quadrature with 8 points on an angle of 45 degrees is accurate to rounding for
// trigonometric polynomials of degree 5, and on twice this angle to 2e-10 for degree 4.
#define EDGE_ANGLE (M_PI / 4)
#define INNER_ANGLE (M_PI / 2)

// A quadrature rule on -1..1. Weights are whole numbers where possible, so that areas of figures
// with simple coordinates are exact.
typedef struct Rule {
  int n;
  double nodes[8], weights[8], divisor;
} Rule;

// Exact for polynomials of degree 3 and 5.
static const Rule SIMPSON = {3, {-1, 0, 1}, {1, 4, 1}, 3};
static const Rule BOOLE = {5, {-1, -0.5, 0, 0.5, 1}, {7, 32, 12, 32, 7}, 45};
static const Rule GAUSS = {8,
                           {-0.96028985649753623168, -0.79666647741362673959,
                            -0.52553240991632898582, -0.18343464249564980494,
                            0.18343464249564980494, 0.52553240991632898582, 0.79666647741362673959,
                            0.96028985649753623168},
                           {0.10122853629037625915, 0.22238103445337447054, 0.31370664587788728734,
                            0.36268378337836198297, 0.36268378337836198297, 0.31370664587788728734,
                            0.22238103445337447054, 0.10122853629037625915},
                           1};

// The integrals over a face. The inner ones start at `from`.
typedef struct FaceIntegral {
  const CagBoundaryFace *face;
  CagEdgePath path;
  CagVec3 center;
  double size, from;
  int terms;    // AREA_TERMS or TERMS
  double v;     // of the current inner integral on a spline
  double *cuts; // on a spline: its breaks along u, of which the first is `from`
  size_t cut_count;
} FaceIntegral;

// Adds the terms at a point of the face, by the partial derivatives there.
static void add_terms(const FaceIntegral *in, CagVec3 point, CagVec3 du, CagVec3 dv, double weight,
                      double *out) {
  const double scale = 1 / in->size;
  const CagVec3 p = cag_scaled(cag_sub(point, in->center), scale);
  const CagVec3 n = cag_scaled(cag_cross(du, dv), weight * scale * scale);
  const double area = copysign(cag_norm(n), weight);
  out[0] += area;
  out[1] += area * p.x;
  out[2] += area * p.y;
  out[3] += area * p.z;
  if (in->terms == AREA_TERMS) return;
  const double xx = p.x * p.x, yy = p.y * p.y, zz = p.z * p.z;
  out[4] += cag_dot(p, n);
  out[5] += xx * n.x / 2;
  out[6] += yy * n.y / 2;
  out[7] += zz * n.z / 2;
  out[8] += xx * p.x * n.x;
  out[9] += yy * p.y * n.y;
  out[10] += zz * p.z * n.z;
  out[11] += xx * p.y * n.x / 2;
  out[12] += yy * p.z * n.y / 2;
  out[13] += zz * p.x * n.z / 2;
}

// --- Inner integrals ---

// -G at (u, v): the terms are polynomials in v, of degree 3 at most, or 4 on cones.
static CagStatus ruled_inner(const FaceIntegral *in, double u, double v, double *out,
                             CagError *err) {
  const Rule *rule = in->face->carrier.kind == CAG_CARRIER_CONE ? &BOOLE : &SIMPSON;
  const double middle = (in->from + v) / 2, half = (v - in->from) / 2;
  CagGenerator g;
  CagStatus status = cag_carrier_generator(&in->face->carrier, u, &g, err);
  for (int i = 0; !status && i < rule->n; i++) {
    const double at = middle + half * rule->nodes[i];
    add_terms(in, cag_madd(g.at, at, g.along), cag_madd(g.at_u, at, g.along_u), g.along,
              -half * rule->weights[i], out);
  }
  for (int k = 0; k < in->terms; k++) out[k] /= rule->divisor;
  return status;
}

// F at (u, v): the terms are trigonometric polynomials of degree 4 at most in u. The derivatives
// turn with the point.
static CagStatus turned_inner(const FaceIntegral *in, double u, double v, double *out,
                              CagError *err) {
  const CagCarrier *c = &in->face->carrier;
  const CagVec3 z = cag_frame_column(&c->frame, 2), origin = cag_frame_column(&c->frame, 3);
  CagCarrierPoint first;
  CagStatus status = cag_carrier_eval(c, in->from, v, &first, err);
  if (status) return status;
  CagVec3 turned[3] = {cag_sub(first.point, origin), first.du, first.dv}, flat[3], across[3];
  for (int k = 0; k < 3; k++) {
    flat[k] = cag_madd(turned[k], -cag_dot(turned[k], z), z);
    across[k] = cag_cross(z, turned[k]);
  }
  const int parts = 1 + (int)(fabs(u - in->from) / INNER_ANGLE);
  const double half = (u - in->from) / (2 * parts);
  for (int i = 0; i < 8 * parts; i++) {
    const double angle = half * (2 * (i / 8) + 1 + GAUSS.nodes[i % 8]), s = sin(angle),
                 k = cos(angle);
    CagVec3 at[3];
    for (int j = 0; j < 3; j++) at[j] = cag_madd(cag_madd(turned[j], k - 1, flat[j]), s, across[j]);
    add_terms(in, cag_add(origin, at[0]), at[1], at[2], half * GAUSS.weights[i % 8], out);
  }
  return CAG_OK;
}

static CagStatus spline_terms(void *context, double u, double *out, CagError *err) {
  const FaceIntegral *in = context;
  CagCarrierPoint p;
  CagStatus status = cag_carrier_eval(&in->face->carrier, u, in->v, &p, err);
  for (int k = 0; k < in->terms; k++) out[k] = 0;
  if (!status) add_terms(in, p.point, p.du, p.dv, 1, out);
  return status;
}

// F at (u, v). Breaks beyond the number that fits are left to bisection.
static CagStatus spline_inner(FaceIntegral *in, double u, double v, double *out, CagError *err) {
  double ends[64];
  size_t n = 0;
  const size_t room = sizeof ends / sizeof *ends - 1;
  if (!(u > in->from)) return CAG_OK;
  in->v = v;
  for (size_t i = 0; i < in->cut_count && in->cuts[i] < u && n < room; i++) ends[n++] = in->cuts[i];
  ends[n++] = u;
  return cag_integrate(spline_terms, in, ends, n, in->terms, INNER, out, err);
}

// --- Integrals along edges ---

// The direction whose rate is a factor of the integrand.
static int outer_direction(const FaceIntegral *in) {
  return cag_carrier_is_ruled(&in->face->carrier) ? 0 : 1;
}

static CagStatus along_edge(void *context, double t, double *out, CagError *err) {
  FaceIntegral *in = context;
  double uv[2], rates[2];
  memset(out, 0, (size_t)in->terms * sizeof *out);
  CagStatus status = cag_edge_path_eval(&in->path, t, uv, rates, err);
  const double rate = rates[outer_direction(in)];
  if (status || rate == 0) return status;
  if (outer_direction(in) == 0) status = ruled_inner(in, uv[0], uv[1], out, err);
  else if (in->face->carrier.kind == CAG_CARRIER_SPLINE)
    status = spline_inner(in, uv[0], uv[1], out, err);
  else status = turned_inner(in, uv[0], uv[1], out, err);
  for (int k = 0; k < in->terms; k++) out[k] *= rate;
  return status;
}

// The angle by which trigonometric polynomials turn along an edge, if the integrand is one of
// degree 5 at most, or a polynomial (0); -1: it is neither.
static double edge_angle(const FaceIntegral *in) {
  const CagEdgePath *p = &in->path;
  const CagCarrier *c = &in->face->carrier;
  CagNurbsView view;
  CagVec3 center, x, y;
  double rate;
  if (!cag_carrier_is_analytic(c)) return -1;
  if (c->kind == CAG_CARRIER_PLANE) {
    if (p->straight) return 0;
    if (p->curve && cag_curve_arc_axes(p->curve, &center, &x, &y, &rate))
      return fabs(rate) * (p->end - p->start);
    return p->curve && cag_curve_nurbs_view(p->curve, &view) && view.degree == 1 && view.count == 2
               ? 0
               : -1;
  }
  if (!p->straight) return -1;
  double sum = 0;
  for (int k = 0; k < 2; k++)
    if (k == 0 || c->kind == CAG_CARRIER_SPHERE || c->kind == CAG_CARRIER_TORUS)
      sum += fabs(p->along[k]) * (p->end - p->start);
  return sum;
}

static CagStatus integrate_smooth(FaceIntegral *in, double angle, double *sum, CagError *err) {
  const CagEdgePath *p = &in->path;
  const Rule *rule = angle == 0 ? &BOOLE : &GAUSS;
  const int parts = 1 + (int)(angle / EDGE_ANGLE);
  const double half = (p->end - p->start) / (2 * parts);
  memset(sum, 0, (size_t)in->terms * sizeof *sum);
  CagStatus status = cag_stop_check(err);
  for (int i = 0; !status && i < rule->n * parts; i++) {
    double value[TERMS];
    const int part = i / rule->n, at = i % rule->n;
    status = along_edge(in, p->start + half * (2 * part + 1 + rule->nodes[at]), value, err);
    for (int k = 0; !status && k < in->terms; k++) sum[k] += half * rule->weights[at] * value[k];
  }
  for (int k = 0; !status && k < in->terms; k++) sum[k] /= rule->divisor;
  return status;
}

static int by_value(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static size_t curve_breaks(const CagCurve *c, double *out, size_t capacity) {
  return c && c->kind->breaks ? c->kind->breaks(c, out, capacity) : 0;
}

// The parameters at which the integrand may not be smooth, and the ends of the edge.
static CagStatus edge_cuts(const FaceIntegral *in, double **out, size_t *n, CagError *err) {
  const CagEdgePath *p = &in->path;
  const CagCarrier *c = &in->face->carrier;
  const size_t curve = curve_breaks(p->curve, NULL, 0), trace = curve_breaks(p->trace, NULL, 0);
  const size_t breaks[2] = {cag_carrier_breaks(c, 0, NULL, 0), cag_carrier_breaks(c, 1, NULL, 0)};
  double *cuts = cag_malloc((curve + trace + breaks[0] + breaks[1] + 2) * sizeof *cuts);
  if (!cuts) return cag_fail_memory(err);
  size_t count = 0;
  cuts[count++] = p->start;
  cuts[count++] = p->end;
  curve_breaks(p->curve, cuts + count, curve);
  count += curve;
  curve_breaks(p->trace, cuts + count, trace);
  count += trace;
  // Only lines have few crossings with the breaks of the carrier.
  for (int k = 0; p->straight && k < 2; k++) {
    if (p->along[k] == 0) continue;
    cag_carrier_breaks(c, k, cuts + count, breaks[k]);
    for (size_t i = count; i < count + breaks[k]; i++) cuts[i] = (cuts[i] - p->at[k]) / p->along[k];
    count += breaks[k];
  }
  qsort(cuts, count, sizeof *cuts, by_value);
  size_t kept = 0;
  for (size_t i = 0; i < count; i++)
    if (cuts[i] >= p->start && cuts[i] <= p->end && (kept == 0 || cuts[i] > cuts[kept - 1]))
      cuts[kept++] = cuts[i];
  *out = cuts;
  *n = kept;
  return CAG_OK;
}

// Adds the integrals along an edge.
static CagStatus integrate_use(const CagBoundary *b, FaceIntegral *in, const CagBoundaryUse *use,
                               double *sum, CagError *err) {
  double part[TERMS], *cuts;
  size_t n;
  CagStatus status = cag_edge_path(b, in->face, use, &in->path, err);
  if (status) return status;
  if (in->path.straight && in->path.along[outer_direction(in)] == 0) return CAG_OK;
  const double angle = edge_angle(in);
  if (angle >= 0) {
    status = integrate_smooth(in, angle, part, err);
  } else {
    status = edge_cuts(in, &cuts, &n, err);
    if (status) return status;
    status = cag_integrate(along_edge, in, cuts, n, in->terms, OUTER, part, err);
    cag_free(cuts);
  }
  for (int k = 0; !status && k < in->terms; k++) sum[k] += in->path.reversed ? -part[k] : part[k];
  return status;
}

// --- Faces ---

// Where inner integrals start. At the apex of a cone they would otherwise be multiplied by large
// rates.
static double inner_start(const CagBoundaryFace *f) {
  const CagCarrier *c = &f->carrier;
  const double *d = f->domain;
  if (c->kind == CAG_CARRIER_SPLINE) return c->spline->u0;
  if (!cag_carrier_is_ruled(c)) return (d[0] + d[1]) / 2;
  if (c->kind != CAG_CARRIER_CONE) return (d[2] + d[3]) / 2;
  return fmin(fmax(-c->a / sin(c->b), d[2]), d[3]);
}

// The integrals over a face: those of the area are positive, the fluxes are along its outward
// normal.
static CagStatus integrate_face(const CagBoundary *b, size_t face, FaceIntegral *in, double *sum,
                                CagError *err) {
  const CagBoundaryFace *f = &b->faces[face];
  CagStatus status = CAG_OK;
  in->face = f;
  in->from = inner_start(f);
  memset(sum, 0, (size_t)in->terms * sizeof *sum);
  if (f->carrier.kind == CAG_CARRIER_SPLINE) {
    const size_t n = cag_carrier_breaks(&f->carrier, 0, NULL, 0);
    in->cuts = cag_malloc((n + 1) * sizeof *in->cuts);
    if (!in->cuts) return cag_fail_memory(err);
    in->cuts[0] = in->from;
    cag_carrier_breaks(&f->carrier, 0, in->cuts + 1, n);
    in->cut_count = n + 1;
  }
  for (size_t l = f->first; !status && l < f->first + f->count; l++)
    for (size_t u = b->loops[l].first; !status && u < b->loops[l].first + b->loops[l].count; u++)
      status = integrate_use(b, in, &b->uses[u], sum, err);
  cag_free(in->cuts);
  in->cuts = NULL;
  for (int k = 0; f->reversed && k < AREA_TERMS; k++) sum[k] = -sum[k];
  return status;
}

// --- Extent ---

// Points of an edge that are looked at.
#define EXTENT_SAMPLES 8

static CagStatus add_edge(const CagBoundary *b, size_t edge, CagBounds *box, CagError *err) {
  const CagBoundaryEdge *e = &b->edges[edge];
  CagStatus status = CAG_OK;
  cag_bounds_add(box, b->corners[e->from]);
  cag_bounds_add(box, b->corners[e->to]);
  for (int i = 1; e->curve && !status && i < EXTENT_SAMPLES; i++) {
    CagVec3 p;
    const double t = e->curve->start + (e->curve->end - e->curve->start) * i / EXTENT_SAMPLES;
    status = cag_curve_point(e->curve, t, &p, err);
    if (!status) cag_bounds_add(box, p);
  }
  return status;
}

CagStatus cag_boundary_extent(const CagBoundary *b, size_t face, CagBounds *out, CagError *err) {
  CagStatus status = CAG_OK;
  *out = CAG_BOUNDS_EMPTY;
  if (face == SIZE_MAX) {
    for (size_t i = 0; !status && i < b->edge_count; i++) status = add_edge(b, i, out, err);
  } else {
    const CagBoundaryFace *f = &b->faces[face];
    for (size_t l = f->first; !status && l < f->first + f->count; l++)
      for (size_t u = b->loops[l].first; !status && u < b->loops[l].first + b->loops[l].count; u++)
        status = add_edge(b, b->uses[u].edge, out, err);
  }
  return status;
}

static CagStatus face_integral(const CagBoundary *b, size_t face, int terms, FaceIntegral *out,
                               CagError *err) {
  CagBounds box;
  CagStatus status = cag_boundary_extent(b, face, &box, err);
  if (status) return status;
  const double size = cag_norm(cag_sub(box.max, box.min)) / 2;
  // A power of two, so that the division is exact.
  *out = (FaceIntegral){.terms = terms,
                        .size = size > 0 && isfinite(size) ? exp2(ceil(log2(size))) : 1};
  if (isfinite(size)) out->center = cag_lerp(box.min, box.max, 0.5);
  return CAG_OK;
}

// --- Queries ---

CagStatus cag_boundary_face_area(const CagBoundary *b, size_t face, double *area, CagVec3 *centroid,
                                 CagError *err) {
  FaceIntegral in;
  double sum[TERMS];
  CagStatus status = face_integral(b, face, AREA_TERMS, &in, err);
  if (!status) status = integrate_face(b, face, &in, sum, err);
  if (status) return status;
  *area = sum[0] * in.size * in.size;
  if (!centroid) return CAG_OK;
  const CagVec3 moment = cag_vec3(sum[1], sum[2], sum[3]);
  *centroid = sum[0] != 0 ? cag_madd(in.center, in.size / sum[0], moment) : in.center;
  return CAG_OK;
}

// From the integrals over all faces, relative to the center and the size.
static void set_mass(const FaceIntegral *in, const double *sum, CagMassProperties *out) {
  const double size = in->size, volume = sum[4] / 3;
  const CagVec3 moment = cag_vec3(sum[1], sum[2], sum[3]);
  const double c[3] = {sum[5] / volume, sum[6] / volume, sum[7] / volume};
  double second[3][3]; // about the centroid
  for (int i = 0; i < 3; i++) {
    const int next = (i + 1) % 3;
    second[i][i] = sum[8 + i] / 3 - volume * c[i] * c[i];
    second[i][next] = second[next][i] = sum[11 + i] - volume * c[i] * c[next];
  }
  const double trace = second[0][0] + second[1][1] + second[2][2];
  *out = (CagMassProperties){.area = sum[0] * size * size, .volume = volume * size * size * size};
  out->area_centroid = cag_madd(in->center, size / sum[0], moment);
  out->volume_centroid = cag_madd(in->center, size, cag_vec3(c[0], c[1], c[2]));
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++)
      out->inertia[i][k] = ((i == k ? trace : 0) - second[i][k]) * pow(size, 5);
}

CagStatus cag_boundary_mass(const CagBoundary *b, CagMassProperties *out, CagError *err) {
  FaceIntegral in;
  double sum[TERMS] = {0};
  CagStatus status = face_integral(b, SIZE_MAX, TERMS, &in, err);
  for (size_t i = 0; !status && i < b->face_count; i++) {
    double part[TERMS];
    status = integrate_face(b, i, &in, part, err);
    for (int k = 0; !status && k < TERMS; k++) sum[k] += part[k];
  }
  if (status) return status;
  if (!(sum[4] > 0 && sum[0] > 0 && isfinite(sum[4])))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_no_boundary, "", -1,
                    "the faces enclose no volume");
  set_mass(&in, sum, out);
  return CAG_OK;
}
