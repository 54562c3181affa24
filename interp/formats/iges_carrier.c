// Carriers of faces as surfaces of IGES files (see iges_carrier.h).
//
// Planes, cylinders, spheres, and tori are analytic surfaces (entities 190, 192, 196, 198), whose
// parameters are angles in degrees and lengths. Cones are surfaces of revolution (entity 120) of a
// line, because readers do not agree on whether the length on a conical surface (194) is measured
// along the axis or along the side. The parameters of a surface of revolution are that of its
// generatrix and the angle, so that its normal is opposite.
//
// Angles begin at 0: the frame of a face whose angles are outside of a turn is turned.

#include "interp/formats/iges_carrier.h"

#include <math.h>

#define DEGREES (180 / M_PI)
// Angles may be this much outside of a turn.
#define ANGLE_ROUNDING 1e-9

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

// The angle by which the frame of a face of revolution is turned.
static double face_turn(const CagBrepFace *f) {
  const double from = f->domain[0], to = f->domain[1];
  return from >= -ANGLE_ROUNDING && to <= 2 * M_PI + ANGLE_ROUNDING ? 0 : from;
}

// --- Analytic surfaces ---

static CagIgesPointer carrier_point(CagIges *w, CagVec3 p) {
  const CagIgesPointer at = cag_iges_begin(w, 116, 0, CAG_IGES_PART);
  cag_iges_point(w, p);
  cag_iges_pointer(w, 0); // no symbol
  cag_iges_end(w, false);
  return at;
}

static CagIgesPointer carrier_direction(CagIges *w, CagVec3 d) {
  const CagIgesPointer at = cag_iges_begin(w, 123, 0, CAG_IGES_PART_DEFINITION);
  cag_iges_point(w, d);
  cag_iges_end(w, false);
  return at;
}

// A surface by a point, its z axis, further radii, and its x axis, turned by an angle.
static CagIgesPointer analytic_surface(CagIges *w, int type, const CagCarrier *c, int further,
                                       double turn) {
  const CagVec3 x = column(&c->frame, 0), y = column(&c->frame, 1);
  const CagIgesPointer point = carrier_point(w, column(&c->frame, 3));
  const CagIgesPointer axis = carrier_direction(w, column(&c->frame, 2));
  const CagIgesPointer from =
      carrier_direction(w, cag_madd(cag_scaled(x, cos(turn)), sin(turn), y));
  const CagIgesPointer at = cag_iges_begin(w, type, 1, CAG_IGES_PART);
  cag_iges_pointer(w, point);
  if (c->kind == CAG_CARRIER_SPHERE) cag_iges_real(w, c->a); // before its axis
  cag_iges_pointer(w, axis);
  if (further > 0) cag_iges_real(w, c->a);
  if (further > 1) cag_iges_real(w, c->b);
  cag_iges_pointer(w, from);
  cag_iges_end(w, false);
  return at;
}

// --- Swept surfaces ---

// The carrier's profile, turned about its axis by an angle.
static CagStatus revolved_profile(const CagCarrier *c, double turn, CagCurve **out, CagError *err) {
  if (turn == 0) {
    *out = cag_curve_retain(c->profile);
    return CAG_OK;
  }
  CagTransform t;
  const CagStatus status = cag_rotate(column(&c->frame, 2), turn, column(&c->frame, 3), &t, err);
  return status ? status : cag_curve_transform(c->profile, &t, out, err);
}

// The side of a cone at an angle, between the lengths of the face.
static CagStatus cone_profile(const CagBrepFace *f, double turn, CagCurve **out, CagError *err) {
  const CagCarrier *c = &f->carrier;
  const CagVec3 x = column(&c->frame, 0), y = column(&c->frame, 1), z = column(&c->frame, 2);
  const CagVec3 out_x = cag_madd(cag_scaled(x, cos(turn)), sin(turn), y);
  const CagVec3 foot = cag_madd(column(&c->frame, 3), c->a, out_x);
  const CagVec3 along = cag_madd(cag_scaled(out_x, sin(c->b)), cos(c->b), z);
  const double from = f->domain[2], to = f->domain[3], knots[4] = {from, from, to, to};
  const CagVec3 ends[2] = {cag_madd(foot, from, along), cag_madd(foot, to, along)};
  return cag_curve_nurbs(ends, NULL, 2, 1, knots, 3, out, err);
}

static CagStatus revolved_surface(CagIges *w, const CagBrepFace *f, CagIgesSurface *out,
                                  CagError *err) {
  const CagCarrier *c = &f->carrier;
  const double turn = face_turn(f);
  CagCurve *profile;
  CagIgesCurve generatrix;
  CagStatus status = c->kind == CAG_CARRIER_CONE ? cone_profile(f, turn, &profile, err)
                                                 : revolved_profile(c, turn, &profile, err);
  if (status) return status;
  status = cag_iges_curve(w, profile, &generatrix, err);
  cag_curve_release(profile);
  if (status) return status;
  const CagVec3 origin = column(&c->frame, 3);
  const CagIgesPointer axis = cag_iges_begin(w, 110, 0, CAG_IGES_PART);
  cag_iges_point(w, origin);
  cag_iges_point(w, cag_add(origin, column(&c->frame, 2)));
  cag_iges_end(w, false);
  out->at = cag_iges_begin(w, 120, 0, CAG_IGES_PART);
  cag_iges_pointer(w, axis);
  cag_iges_pointer(w, generatrix.at);
  cag_iges_real(w, 0);
  cag_iges_real(w, 2 * M_PI);
  cag_iges_end(w, false);
  out->turned = true;
  out->bent = generatrix.bent;
  out->parameters = parameter_map(0, generatrix.scale, generatrix.shift, 1, 0, -turn);
  return CAG_OK;
}

// The NURBS form of an extruded curve over the length of a face.
static CagStatus exact_extrusion(CagIges *w, const CagCurve *section, CagVec3 along,
                                 CagIgesSurface *out, CagError *err) {
  CagSurface *swept, *exact;
  CagStatus status = cag_surface_extrude(section, along, 0, 1, &swept, err);
  if (status) return status;
  status = cag_surface_to_nurbs(swept, &exact, err);
  cag_surface_release(swept);
  if (status) return status;
  out->at = cag_iges_nurbs_surface(w, exact, CAG_IGES_PART);
  out->bent = true;
  cag_surface_release(exact);
  return CAG_OK;
}

// A tabulated cylinder (entity 122), whose parameters both run from 0 to 1.
static CagStatus extruded_surface(CagIges *w, const CagBrepFace *f, CagIgesSurface *out,
                                  CagError *err) {
  const CagCarrier *c = &f->carrier;
  const CagVec3 z = column(&c->frame, 2);
  const CagTransform shift = cag_translate(cag_scaled(z, f->domain[2]));
  const double length = f->domain[3] - f->domain[2];
  const double u = 1 / (c->profile->end - c->profile->start), v = 1 / length;
  CagCurve *section;
  CagIgesCurve directrix;
  CagVec3 start;
  CagStatus status = cag_curve_transform(c->profile, &shift, &section, err);
  if (status) return status;
  status = cag_curve_point(section, section->start, &start, err);
  const bool bent = !status && cag_iges_is_offset_ellipse(section);
  if (bent) status = exact_extrusion(w, section, cag_scaled(z, length), out, err);
  else if (!status) status = cag_iges_curve(w, section, &directrix, err);
  cag_curve_release(section);
  if (status || bent) return status;
  out->at = cag_iges_begin(w, 122, 0, CAG_IGES_PART);
  cag_iges_pointer(w, directrix.at);
  cag_iges_point(w, cag_madd(start, length, z));
  cag_iges_end(w, false);
  out->parameters = parameter_map(u, 0, -c->profile->start * u, 0, v, -f->domain[2] * v);
  return CAG_OK;
}

CagStatus cag_iges_carrier(CagIges *w, const CagBrepFace *face, CagIgesSurface *out,
                           CagError *err) {
  const CagCarrier *c = &face->carrier;
  const double turn = face_turn(face), k = DEGREES;
  *out = (CagIgesSurface){.parameters = cag_transform_identity()};
  switch (c->kind) {
  case CAG_CARRIER_PLANE: out->at = analytic_surface(w, 190, c, 0, 0); break;
  case CAG_CARRIER_CYLINDER:
    out->at = analytic_surface(w, 192, c, 1, turn);
    out->parameters = parameter_map(k, 0, -turn * k, 0, 1, 0);
    break;
  case CAG_CARRIER_SPHERE:
    out->at = analytic_surface(w, 196, c, 0, turn);
    out->parameters = parameter_map(k, 0, -turn * k, 0, k, 0);
    break;
  case CAG_CARRIER_TORUS: // the angle in the section, and the one about the axis, backwards
    out->at = analytic_surface(w, 198, c, 2, turn);
    out->parameters = parameter_map(0, k, 0, -k, 0, 360 + turn * k);
    break;
  case CAG_CARRIER_SPLINE: out->at = cag_iges_nurbs_surface(w, c->spline, CAG_IGES_PART); break;
  case CAG_CARRIER_EXTRUDED: return extruded_surface(w, face, out, err);
  default: return revolved_surface(w, face, out, err);
  }
  return CAG_OK;
}
