// Carriers of faces (see carrier.h).

#include "geom/boundary/carrier.h"

#include <math.h>

// Points this close to the axis, as a fraction of their distance from the origin of the carrier and
// of its radii, have no angle.
#define ON_AXIS 1e-13

#define TURN (2 * M_PI)

static const char *const KINDS[] = {
    [CAG_CARRIER_NONE] = "none",         [CAG_CARRIER_PLANE] = "plane",
    [CAG_CARRIER_CYLINDER] = "cylinder", [CAG_CARRIER_CONE] = "cone",
    [CAG_CARRIER_SPHERE] = "sphere",     [CAG_CARRIER_TORUS] = "torus",
    [CAG_CARRIER_SPLINE] = "spline",     [CAG_CARRIER_REVOLVED] = "revolved",
    [CAG_CARRIER_EXTRUDED] = "extruded"};

const char *cag_carrier_name(const CagCarrier *c) { return KINDS[c->kind]; }

bool cag_carrier_apex(const CagCarrier *c, CagVec3 *out) {
  if (c->kind != CAG_CARRIER_CONE) return false;
  *out = cag_transform_point(&c->frame, cag_vec3(0, 0, -c->a / tan(c->b)));
  return true;
}

bool cag_carrier_is_analytic(const CagCarrier *c) {
  return c->kind >= CAG_CARRIER_PLANE && c->kind <= CAG_CARRIER_TORUS;
}

bool cag_carrier_is_ruled(const CagCarrier *c) {
  return c->kind == CAG_CARRIER_PLANE || c->kind == CAG_CARRIER_CYLINDER ||
         c->kind == CAG_CARRIER_CONE || c->kind == CAG_CARRIER_EXTRUDED;
}

bool cag_carrier_is_periodic(const CagCarrier *c, int direction) {
  if (direction == 1) return c->kind == CAG_CARRIER_TORUS;
  return c->kind == CAG_CARRIER_CYLINDER || c->kind == CAG_CARRIER_CONE ||
         c->kind == CAG_CARRIER_SPHERE || c->kind == CAG_CARRIER_TORUS ||
         c->kind == CAG_CARRIER_REVOLVED;
}

size_t cag_carrier_breaks(const CagCarrier *c, int direction, double *out, size_t capacity) {
  const bool profile = (c->kind == CAG_CARRIER_REVOLVED && direction == 1) ||
                       (c->kind == CAG_CARRIER_EXTRUDED && direction == 0);
  if (profile && c->profile->kind->breaks)
    return c->profile->kind->breaks(c->profile, out, capacity);
  if (c->kind == CAG_CARRIER_SPLINE && c->spline->kind->breaks)
    return c->spline->kind->breaks(c->spline, direction, out, capacity);
  return 0;
}

// --- Points ---

static double clamped(double t, double lo, double hi) { return fmin(fmax(t, lo), hi); }

static CagVec3 combined(double a, CagVec3 x, double b, CagVec3 y) {
  return cag_add(cag_scaled(x, a), cag_scaled(y, b));
}

static CagStatus profile_at(const CagCarrier *c, double t, CagVec3 d[2], CagError *err) {
  const CagCurve *profile = c->profile;
  t = clamped(t, profile->start, profile->end);
  return cag_curve_eval(profile, t, 1, t < profile->end ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT, d, err);
}

CagStatus cag_carrier_generator(const CagCarrier *c, double u, CagGenerator *out, CagError *err) {
  const CagVec3 x = cag_frame_column(&c->frame, 0), y = cag_frame_column(&c->frame, 1);
  const CagVec3 z = cag_frame_column(&c->frame, 2), origin = cag_frame_column(&c->frame, 3);
  const CagVec3 none = {0, 0, 0};
  if (c->kind == CAG_CARRIER_PLANE) {
    *out = (CagGenerator){cag_madd(origin, u, x), y, x, none};
    return CAG_OK;
  }
  if (c->kind == CAG_CARRIER_EXTRUDED) {
    CagVec3 d[2];
    CagStatus status = profile_at(c, u, d, err);
    if (!status) *out = (CagGenerator){d[0], z, d[1], none};
    return status;
  }
  const double slope = c->kind == CAG_CARRIER_CONE ? c->b : 0, s = sin(u), k = cos(u);
  const CagVec3 radial = combined(k, x, s, y), around = combined(-s, x, k, y);
  *out = (CagGenerator){cag_madd(origin, c->a, radial), combined(sin(slope), radial, cos(slope), z),
                        cag_scaled(around, c->a), cag_scaled(around, sin(slope))};
  return CAG_OK;
}

// The profile of a carrier of revolution at u = 0, and its derivative by v.
static CagStatus meridian_at(const CagCarrier *c, double v, CagVec3 d[2], CagError *err) {
  const CagVec3 x = cag_frame_column(&c->frame, 0), z = cag_frame_column(&c->frame, 2);
  if (c->kind == CAG_CARRIER_REVOLVED) {
    CagStatus status = profile_at(c, v, d, err);
    d[0] = cag_sub(d[0], cag_frame_column(&c->frame, 3));
    return status;
  }
  const bool torus = c->kind == CAG_CARRIER_TORUS;
  const double middle = torus ? c->a : 0, radius = torus ? c->b : c->a, s = sin(v), k = cos(v);
  d[0] = combined(middle + radius * k, x, radius * s, z);
  d[1] = combined(-radius * s, x, radius * k, z);
  return CAG_OK;
}

static CagStatus turned_point(const CagCarrier *c, double u, double v, CagCarrierPoint *out,
                              CagError *err) {
  const CagVec3 z = cag_frame_column(&c->frame, 2), origin = cag_frame_column(&c->frame, 3);
  CagVec3 d[2];
  CagStatus status = meridian_at(c, v, d, err);
  if (status) return status;
  const double s = sin(u), k = cos(u);
  CagVec3 turned[2], flat[2];
  for (int i = 0; i < 2; i++) {
    const double height = cag_dot(d[i], z);
    flat[i] = cag_madd(d[i], -height, z);
    turned[i] = cag_madd(combined(k, flat[i], s, cag_cross(z, d[i])), height, z);
  }
  out->point = cag_add(origin, turned[0]);
  out->du = combined(-s, flat[0], k, cag_cross(z, d[0]));
  out->dv = turned[1];
  return CAG_OK;
}

CagStatus cag_carrier_eval(const CagCarrier *c, double u, double v, CagCarrierPoint *out,
                           CagError *err) {
  if (cag_carrier_is_ruled(c)) {
    CagGenerator g;
    CagStatus status = cag_carrier_generator(c, u, &g, err);
    if (!status)
      *out = (CagCarrierPoint){cag_madd(g.at, v, g.along), cag_madd(g.at_u, v, g.along_u), g.along};
    return status;
  }
  if (c->kind != CAG_CARRIER_SPLINE) return turned_point(c, u, v, out, err);
  const CagSurface *s = c->spline;
  CagVec3 d[4];
  u = clamped(u, s->u0, s->u1);
  v = clamped(v, s->v0, s->v1);
  CagStatus status = cag_surface_eval(s, u, v, 1, u < s->u1 ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT,
                                      v < s->v1 ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT, d, err);
  if (!status) *out = (CagCarrierPoint){d[0], d[cag_partial(1, 1, 0)], d[cag_partial(1, 0, 1)]};
  return status;
}

CagStatus cag_carrier_normal(const CagCarrier *c, double u, double v, CagVec3 *out, CagError *err) {
  CagCarrierPoint p;
  CagStatus status = cag_carrier_eval(c, u, v, &p, err);
  if (!status) *out = cag_unit(cag_cross(cag_unit(p.du), cag_unit(p.dv)));
  return status;
}

// --- Parameters ---

// The angle that differs by whole turns and is nearest to another.
static double beside(double angle, double near) {
  return angle + TURN * nearbyint((near - angle) / TURN);
}

// Coordinates in the frame of a carrier, of a point or, with a weight of 0, of a vector.
static CagVec3 local(const CagTransform *frame, CagVec3 p, double weight) {
  const CagVec3 d = cag_madd(p, -weight, cag_frame_column(frame, 3));
  return cag_vec3(cag_dot(d, cag_frame_column(frame, 0)), cag_dot(d, cag_frame_column(frame, 1)),
                  cag_dot(d, cag_frame_column(frame, 2)));
}

// The parameters of a point in the frame of a carrier, and their rates if it moves by `d`.
static void analytic_parameters(const CagCarrier *c, CagVec3 p, CagVec3 d, const double near[4],
                                double uv[2], double rates[2]) {
  if (c->kind == CAG_CARRIER_PLANE) {
    uv[0] = p.x, uv[1] = p.y;
    rates[0] = d.x, rates[1] = d.y;
    return;
  }
  const double r = hypot(p.x, p.y), size = fabs(c->a) + fabs(p.z);
  const bool axis = r <= ON_AXIS * size;
  const double out = axis ? 0 : (p.x * d.x + p.y * d.y) / r; // the rate of r
  uv[0] = axis ? near[0] : beside(atan2(p.y, p.x), near[0]);
  rates[0] = axis ? near[2] : (p.x * d.y - p.y * d.x) / (r * r);
  if (c->kind == CAG_CARRIER_CYLINDER) {
    uv[1] = p.z, rates[1] = d.z;
  } else if (c->kind == CAG_CARRIER_CONE) {
    const double s = sin(c->b), k = cos(c->b);
    uv[1] = (r - c->a) * s + p.z * k;
    rates[1] = out * s + d.z * k;
  } else {
    const double q = c->kind == CAG_CARRIER_TORUS ? r - c->a : r, square = q * q + p.z * p.z;
    uv[1] = atan2(p.z, q);
    if (c->kind == CAG_CARRIER_TORUS) uv[1] = beside(uv[1], near[1]);
    rates[1] = square > 0 ? (q * d.z - p.z * out) / square : near[3];
    // At a pole, the distance from the axis has a corner.
    if (axis && c->kind == CAG_CARRIER_SPHERE) rates[1] = near[3];
  }
}

void cag_carrier_parameters(const CagCarrier *c, CagVec3 p, const double near[2], double out[2]) {
  const double hint[4] = {near[0], near[1], 0, 0};
  double rates[2];
  analytic_parameters(c, local(&c->frame, p, 1), cag_vec3(0, 0, 0), hint, out, rates);
}

// --- Edges ---

CagStatus cag_edge_path(const CagBoundary *b, const CagBoundaryFace *f, const CagBoundaryUse *use,
                        CagEdgePath *out, CagError *err) {
  const CagCurve *curve = b->edges[use->edge].curve;
  const bool analytic = cag_carrier_is_analytic(&f->carrier);
  CagNurbsView view;
  *out = (CagEdgePath){.carrier = &f->carrier, .reversed = use->reversed, .trace = use->trace};
  if (!use->trace && (!curve || f->carrier.kind != CAG_CARRIER_PLANE))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_no_boundary, "", -1,
                    "an edge has no curve on its face");
  if (use->trace && cag_curve_nurbs_view(use->trace, &view) && view.degree == 1 &&
      view.count == 2 && !view.rational) {
    const double *h = view.homogeneous, t0 = use->trace->start, t1 = use->trace->end;
    out->straight = true;
    for (int k = 0; k < 2; k++) {
      out->along[k] = (h[4 + k] - h[k]) / (t1 - t0);
      out->at[k] = h[k] - t0 * out->along[k];
    }
  }
  if (analytic && !out->straight) out->curve = curve;
  out->start = out->curve ? curve->start : use->trace->start;
  out->end = out->curve ? curve->end : use->trace->end;
  return CAG_OK;
}

static CagStatus curve_at(const CagCurve *c, double t, CagVec3 d[2], CagError *err) {
  t = clamped(t, c->start, c->end);
  return cag_curve_eval(c, t, 1, t < c->end ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT, d, err);
}

CagStatus cag_edge_path_eval(const CagEdgePath *p, double t, double uv[2], double rates[2],
                             CagError *err) {
  double unused[2];
  CagVec3 d[2];
  CagStatus status = CAG_OK;
  if (!rates) rates = unused;
  if (p->straight) {
    for (int k = 0; k < 2; k++) {
      uv[k] = p->at[k] + t * p->along[k];
      rates[k] = p->along[k];
    }
    return CAG_OK;
  }
  double near[4] = {0};
  if (p->carrier->kind != CAG_CARRIER_PLANE || !p->curve) {
    status = curve_at(p->trace, t, d, err);
    if (status) return status;
    near[0] = d[0].x, near[1] = d[0].y;
    near[2] = d[1].x, near[3] = d[1].y;
  }
  if (!p->curve) {
    for (int k = 0; k < 2; k++) uv[k] = near[k], rates[k] = near[2 + k];
    return CAG_OK;
  }
  status = curve_at(p->curve, t, d, err);
  if (status) return status;
  const CagTransform *frame = &p->carrier->frame;
  analytic_parameters(p->carrier, local(frame, d[0], 1), local(frame, d[1], 0), near, uv, rates);
  return CAG_OK;
}
