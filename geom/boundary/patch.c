// Faces of boundaries as surfaces: a carrier becomes a surface of revolution, an extrusion, a
// spline, or a plane over the parameters of its face.
//
// The normal of a surface of revolution, whose parameters are that of the profile and the angle, is
// opposite to that of the carrier, whose first parameter is the angle: the profile runs backwards
// if the face has the normal of its carrier.

#include "geom/boundary/patch.h"

#include <math.h>

#include "base/memory.h"
#include "geom/boundary/unseamed.h"
#include "geom/curve/region.h"
#include "geom/surface/reshape.h"
#include "geom/surface/trimmed.h"

// The domain is this fraction larger than that of the face, because traces are approximate.
#define MARGIN 1e-6
// Traces of files may leave the domain of a spline by up to this fraction of it.
#define OVERSHOOT 1e-2
// Ends of traces that are closer than this fraction of the size of the domain meet.
#define MEET 1e-10

void cag_patch_release(CagPatch *p) { cag_surface_release(p->whole); }

static CagVec3 column(const CagTransform *t, int k) {
  return cag_vec3(t->m[0][k], t->m[1][k], t->m[2][k]);
}

// [u, v] = [uu U + uv V + u0, vu U + vv V + v0].
static CagTransform parameter_map(double uu, double uv, double u0, double vu, double vv,
                                  double v0) {
  CagTransform t = cag_transform_identity();
  t.m[0][0] = uu;
  t.m[0][1] = uv;
  t.m[0][3] = u0;
  t.m[1][0] = vu;
  t.m[1][1] = vv;
  t.m[1][3] = v0;
  return t;
}

// --- Carriers ---

static void plane_patch(const CagBoundaryFace *f, CagPatch *out) {
  out->plane = f->carrier.frame;
  if (!f->reversed) return;
  for (int i = 0; i < 3; i++)
    for (int k = 1; k < 3; k++) out->plane.m[i][k] = -out->plane.m[i][k];
  out->parameters = parameter_map(1, 0, 0, 0, -1, 0);
}

// The profile of a carrier of revolution in the half plane of its frame's x and z axes, over the
// carrier's parameters from v0 to v1.
static CagStatus profile_of(const CagCarrier *c, double v0, double v1, CagCurve **out,
                            CagError *err) {
  const CagVec3 origin = column(&c->frame, 3), x = column(&c->frame, 0), z = column(&c->frame, 2);
  if (c->kind == CAG_CARRIER_CYLINDER || c->kind == CAG_CARRIER_CONE) {
    const double angle = c->kind == CAG_CARRIER_CONE ? c->b : 0;
    const CagVec3 foot = cag_madd(origin, c->a, x);
    const CagVec3 along = cag_add(cag_scaled(x, sin(angle)), cag_scaled(z, cos(angle)));
    CagCurve *line;
    CagStatus status =
        cag_curve_line(cag_madd(foot, v0, along), cag_madd(foot, v1, along), 3, &line, err);
    if (status) return status;
    status = cag_curve_reparametrize(line, v0, v1, out, err);
    cag_curve_release(line);
    return status;
  }
  const bool torus = c->kind == CAG_CARRIER_TORUS;
  const CagVec3 center = torus ? cag_madd(origin, c->a, x) : origin;
  const double radius = torus ? c->b : c->a;
  CagTransform frame = cag_transform_identity();
  const CagVec3 axes[4] = {x, z, cag_cross(x, z), center};
  frame.planar = false;
  for (int k = 0; k < 4; k++) {
    frame.m[0][k] = axes[k].x;
    frame.m[1][k] = axes[k].y;
    frame.m[2][k] = axes[k].z;
  }
  return cag_curve_arc(radius, radius, v0, v1, &frame, out, err);
}

// Widens a range, but not beyond the limits.
static void widen(double range[2], double least, double most) {
  const double margin = MARGIN * (range[1] - range[0]);
  range[0] = fmax(range[0] - margin, fmin(range[0], least));
  range[1] = fmin(range[1] + margin, fmax(range[1], most));
}

static CagStatus revolved_patch(const CagBoundaryFace *f, CagPatch *out, CagError *err) {
  const CagCarrier *c = &f->carrier;
  double angles[2] = {f->domain[0], f->domain[1]}, along[2] = {f->domain[2], f->domain[3]};
  const double room = fmax(0, 2 * M_PI - (angles[1] - angles[0])) / 2;
  widen(angles, angles[0] - room, angles[1] + room);
  if (angles[1] - angles[0] > 2 * M_PI - 1e-9) angles[1] = angles[0] + 2 * M_PI;
  CagCurve *profile = NULL, *reversed = NULL;
  CagStatus status = CAG_OK;
  if (c->kind == CAG_CARRIER_REVOLVED) profile = cag_curve_retain(c->profile);
  else {
    if (c->kind == CAG_CARRIER_SPHERE) widen(along, -M_PI / 2, M_PI / 2);
    else if (c->kind == CAG_CARRIER_CONE && sin(c->b) != 0) {
      const double apex = -c->a / sin(c->b);
      widen(along, apex <= along[0] ? apex : -INFINITY, apex >= along[1] ? apex : INFINITY);
    } else if (c->kind == CAG_CARRIER_TORUS && along[1] - along[0] > 2 * M_PI * (1 - MARGIN))
      along[1] = along[0] + 2 * M_PI;
    else widen(along, -INFINITY, INFINITY);
    status = profile_of(c, along[0], along[1], &profile, err);
  }
  if (status) return status;
  out->parameters = parameter_map(0, 1, 0, 1, 0, 0);
  if (!f->reversed) {
    out->parameters = parameter_map(0, -1, profile->start + profile->end, 1, 0, 0);
    status = cag_curve_reverse(profile, &reversed, err);
  }
  if (!status)
    status = cag_surface_revolve(reversed ? reversed : profile, column(&c->frame, 2),
                                 column(&c->frame, 3), angles[0], angles[1], &out->whole, err);
  cag_curve_release(profile);
  cag_curve_release(reversed);
  return status;
}

static CagStatus extruded_patch(const CagBoundaryFace *f, CagPatch *out, CagError *err) {
  const CagCarrier *c = &f->carrier;
  double along[2] = {f->domain[2], f->domain[3]};
  widen(along, -INFINITY, INFINITY);
  const double from = along[f->reversed], to = along[!f->reversed];
  const CagVec3 z = column(&c->frame, 2);
  const CagTransform shift = cag_translate(cag_scaled(z, from));
  CagCurve *section;
  CagStatus status = cag_curve_transform(c->profile, &shift, &section, err);
  if (status) return status;
  out->parameters = parameter_map(1, 0, 0, 0, 1 / (to - from), -from / (to - from));
  status = cag_surface_extrude(section, cag_scaled(z, to - from), 0, 1, &out->whole, err);
  cag_curve_release(section);
  return status;
}

static CagStatus spline_patch(const CagBoundaryFace *f, CagPatch *out, CagError *err) {
  const CagSurface *s = f->carrier.spline;
  if (!f->reversed) {
    out->whole = cag_surface_retain(s);
    return CAG_OK;
  }
  out->parameters = parameter_map(1, 0, 0, 0, -1, s->v0 + s->v1);
  return cag_surface_flip(s, &out->whole, err);
}

static CagStatus patch_of(const CagBoundaryFace *f, size_t face, CagPatch *out, CagError *err) {
  *out = (CagPatch){NULL, cag_transform_identity(), cag_transform_identity()};
  switch (f->carrier.kind) {
  case CAG_CARRIER_PLANE: plane_patch(f, out); return CAG_OK;
  case CAG_CARRIER_CYLINDER:
  case CAG_CARRIER_CONE:
  case CAG_CARRIER_SPHERE:
  case CAG_CARRIER_TORUS:
  case CAG_CARRIER_REVOLVED: return revolved_patch(f, out, err);
  case CAG_CARRIER_EXTRUDED: return extruded_patch(f, out, err);
  case CAG_CARRIER_SPLINE: return spline_patch(f, out, err);
  case CAG_CARRIER_NONE: break;
  }
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_no_boundary, "", -1, "face %zu has no surface",
                  face);
}

CagStatus cag_patch_of_face(const CagBoundary *b, size_t face, CagPatch *out, CagError *err) {
  return patch_of(&b->faces[face], face, out, err);
}

// A parameter that is at most slightly outside of a domain, moved to its end.
static double within(double x, double low, double high, bool *moved) {
  const double inside = fmin(fmax(x, low), high);
  if (inside == x || fabs(inside - x) > OVERSHOOT * (high - low)) return x;
  *moved = true;
  return inside;
}

// Moves the control points of a trace that are slightly outside of the surface's domain to its edge.
static CagStatus trace_within(const CagSurface *s, CagCurve **trace, CagError *err) {
  CagNurbsView view;
  bool moved = false;
  if (!cag_curve_nurbs_view(*trace, &view) || view.periodic) return CAG_OK;
  CagVec3 *points = cag_calloc(view.count, sizeof *points);
  double *weights = cag_calloc(view.count, sizeof *weights);
  CagStatus status = points && weights ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < view.count; i++) {
    const double *h = view.homogeneous + 4 * i;
    weights[i] = h[3];
    points[i] = cag_vec3(within(h[0] / h[3], s->u0, s->u1, &moved),
                         within(h[1] / h[3], s->v0, s->v1, &moved), 0);
  }
  CagCurve *inside = NULL;
  if (!status && moved)
    status = cag_curve_nurbs(points, view.rational ? weights : NULL, view.count, view.degree,
                             view.knots, 2, &inside, err);
  cag_free(points);
  cag_free(weights);
  if (!inside) return status;
  cag_curve_release(*trace);
  *trace = inside;
  return CAG_OK;
}

CagStatus cag_patch_trace(const CagPatch *p, const CagCurve *trace, CagCurve **out, CagError *err) {
  CagCurve *moved;
  CagStatus status = cag_curve_transform(trace, &p->parameters, &moved, err);
  if (status) return status;
  if (p->whole) status = trace_within(p->whole, &moved, err);
  if (status) cag_curve_release(moved);
  else *out = moved;
  return status;
}

// --- Regions ---

typedef struct Chain {
  CagCurve **items;
  size_t n;
  CagVec3 first, last; // ends of the chain
} Chain;

// Adds a line to the next trace unless the chain ends there. Curves are joined to a fraction of their
// coordinates, which may be much smaller than the domain.
static CagStatus bridge(Chain *c, CagVec3 to, double slack, CagError *err) {
  const double here = fmax(fmax(fabs(to.x), fabs(to.y)), fmax(fabs(c->last.x), fabs(c->last.y)));
  const double near = fmin(slack, fmax(MEET * here, slack / 1000));
  if (cag_norm(cag_sub(to, c->last)) <= near) return CAG_OK;
  CagStatus status = cag_curve_line(c->last, to, 2, &c->items[c->n], err);
  if (!status) c->n++;
  return status;
}

static CagStatus add_use(Chain *c, const CagPatch *p, const CagBoundaryUse *use, double slack,
                         CagError *err) {
  CagCurve *moved, *along;
  CagVec3 from;
  CagStatus status = cag_patch_trace(p, use->trace, &moved, err);
  if (status) return status;
  if (use->reversed) {
    status = cag_curve_reverse(moved, &along, err);
    cag_curve_release(moved);
    if (status) return status;
  } else along = moved;
  status = cag_curve_point(along, along->start, &from, err);
  if (!status && c->n > 0) status = bridge(c, from, slack, err);
  if (!status && c->n == 0) c->first = from;
  if (!status) status = cag_curve_point(along, along->end, &c->last, err);
  if (status) cag_curve_release(along);
  else c->items[c->n++] = along;
  return status;
}

// A closed curve through the traces of a loop, with the face on its left.
static CagStatus loop_curve(const CagBoundary *b, const CagBoundaryLoop *l, const CagPatch *p,
                            double size, CagCurve **out, CagError *err) {
  Chain c = {.items = cag_calloc(2 * l->count + 1, sizeof *c.items)};
  CagStatus status = c.items ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < l->count; i++)
    status = add_use(&c, p, &b->uses[l->first + i], MEET * size, err);
  if (!status) status = bridge(&c, c.first, MEET * size, err);
  if (!status) status = cag_curve_join(c.items, c.n, out, err);
  for (size_t i = 0; c.items && i < c.n; i++) cag_curve_release(c.items[i]);
  cag_free(c.items);
  return status;
}

static CagStatus region_of(const CagBoundary *b, const CagBoundaryFace *f, const CagPatch *p,
                           CagRegion **out, CagError *err) {
  const double *d = f->domain;
  const CagVec3 low = cag_transform_point(&p->parameters, cag_vec3(d[0], d[2], 0));
  const CagVec3 high = cag_transform_point(&p->parameters, cag_vec3(d[1], d[3], 0));
  CagCurve **loops = cag_calloc(f->count + 1, sizeof *loops);
  size_t *outer = cag_calloc(f->count + 1, sizeof *outer), n = 0;
  CagStatus status = loops && outer ? CAG_OK : cag_fail_memory(err);
  while (!status && n < f->count) {
    status =
        loop_curve(b, &b->loops[f->first + n], p, cag_norm(cag_sub(high, low)), &loops[n], err);
    if (!status) n++;
  }
  if (!status) status = cag_region_take(loops, outer, n, out, err);
  else
    for (size_t i = 0; i < n; i++) cag_curve_release(loops[i]);
  cag_free(loops);
  cag_free(outer);
  return status;
}

// The curved face of a boundary with a mesh, whose loops have no seams; NULL: they are incomplete.
static CagStatus unseamed_surface(const CagBoundary *b, size_t face, CagSurface **out,
                                  CagError *err) {
  CagBoundaryFace f = b->faces[face];
  CagRegion *region, *moved = NULL;
  CagPatch p = {0};
  *out = NULL;
  CagStatus status = cag_unseamed_region(b, face, &region, f.domain, err);
  if (status || !region) return status;
  status = patch_of(&f, face, &p, err);
  if (!status) status = cag_region_transform(region, &p.parameters, &moved, err);
  if (!status) status = cag_surface_trimmed(p.whole, moved, out, err);
  cag_region_release(region);
  cag_region_release(moved);
  cag_patch_release(&p);
  return cag_is_final(status) ? status : CAG_OK;
}

// The face of a boundary with a mesh. A curved face whose loops are incomplete is the whole surface
// over its domain.
static CagStatus meshed_surface(const CagBoundary *b, const CagBoundaryFace *f, const CagPatch *p,
                                CagSurface **out, CagError *err) {
  CagRegion *region = NULL;
  if (p->whole) {
    *out = cag_surface_retain(p->whole);
    return CAG_OK;
  }
  CagStatus status = f->count > 0 ? region_of(b, f, p, &region, err) : CAG_OK;
  if (!status && region) {
    status = cag_surface_planar(region, &p->plane, out, err);
    cag_region_release(region);
    return status;
  }
  if (cag_is_final(status)) return status;
  const double *d = f->domain, sign = f->reversed ? -1 : 1;
  const CagVec3 x = column(&p->plane, 0), y = column(&p->plane, 1);
  const CagVec3 corner =
      cag_madd(cag_madd(column(&p->plane, 3), d[0], x), sign * d[f->reversed ? 3 : 2], y);
  return cag_surface_parallelogram(corner, cag_scaled(x, d[1] - d[0]), cag_scaled(y, d[3] - d[2]),
                                   out, err);
}

CagStatus cag_boundary_surface(const CagBoundary *b, size_t face, CagSurface **out, CagError *err) {
  CagPatch p;
  CagRegion *region = NULL;
  CagStatus status = cag_patch_of_face(b, face, &p, err);
  if (status) return status;
  if (b->mesh) {
    CagSurface *trimmed = NULL;
    if (p.whole) status = unseamed_surface(b, face, &trimmed, err);
    if (trimmed) *out = trimmed;
    else if (!status) status = meshed_surface(b, &b->faces[face], &p, out, err);
    cag_patch_release(&p);
    return status;
  }
  status = region_of(b, &b->faces[face], &p, &region, err);
  if (!status)
    status = p.whole ? cag_surface_trimmed(p.whole, region, out, err)
                     : cag_surface_planar(region, &p.plane, out, err);
  cag_region_release(region);
  cag_patch_release(&p);
  return status;
}
