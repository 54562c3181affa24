// Solids by their own surfaces (see brep_form.h).

#include "interp/formats/brep_form.h"

#include <math.h>

#include "base/memory.h"
#include "geom/boundary/carrier.h"
#include "geom/linalg/tolerance.h"
#include "geom/solid/form.h"
#include "interp/formats/brep_outline.h"

// A full turn, up to rounding.
static bool is_turn(double angle) { return angle > 0 && angle <= 2 * M_PI * (1 + 1e-12); }

// The right-handed frame of a primitive whose placement is a similarity, and its scale. If the
// placement mirrors, y is opposite to the primitive's.
static bool primitive_frame(const CagSolid *s, CagTransform *frame, double *scale) {
  const CagTransform *t = &s->placement;
  CagError ignored;
  if (!cag_transform_is_similarity(t, scale)) return false;
  const CagVec3 x = cag_frame_column(t, 0), z = cag_frame_column(t, 2);
  return !cag_axes(cag_frame_column(t, 3), x, cag_cross(z, x), frame, &ignored);
}

// --- Primitives ---

static CagStatus add_polygon(CagFormOutline *o, const double (*xy)[2], size_t n, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < n; i++) {
    const double *p = xy[i], *q = xy[(i + 1) % n];
    if (p[0] == q[0] && p[1] == q[1]) continue;
    status = cag_form_outline_line(o, cag_vec3(p[0], p[1], 0), cag_vec3(q[0], q[1], 0), err);
  }
  return status;
}

// The outline that a round primitive is turned from.
static CagStatus add_profile(CagFormOutline *o, const CagSolid *s, double scale, CagError *err) {
  const double a = scale * s->a, b = scale * s->b, c = scale * s->c;
  if (s->kind == CAG_SOLID_TORUS)
    return cag_form_outline_arc(o, cag_vec3(a, 0, 0), b, 0, 2 * M_PI, err);
  if (s->kind == CAG_SOLID_SPHERE) {
    const CagVec3 low = {0, -a, 0}, high = {0, a, 0};
    const CagStatus status = cag_form_outline_arc(o, cag_vec3(0, 0, 0), a, -M_PI / 2, M_PI, err);
    return status ? status : cag_form_outline_line(o, high, low, err);
  }
  const double cylinder[4][2] = {{0, 0}, {b, 0}, {c, a}, {0, a}};
  return add_polygon(o, cylinder, 4, err);
}

static CagStatus add_round(CagFormWork *w, const CagSolid *s, double scale, bool *done,
                           CagError *err) {
  CagFormOutline o = {0};
  CagStatus status = add_profile(&o, s, scale, err);
  *done = !status && cag_form_outline_turns(&o, CAG_COINCIDENT * scale * fmax(s->a, s->b));
  if (*done) {
    cag_form_outline_turn(&o, true);
    cag_form_turned(w, &o, 0, 2 * M_PI);
    status = w->status;
  }
  cag_form_outline_free(&o);
  return status;
}

static CagStatus add_box(CagFormWork *w, const CagSolid *s, double scale, CagError *err) {
  const double a = scale * s->a, b = scale * s->b, c = scale * s->c;
  const double rectangle[4][2] = {{0, 0}, {a, 0}, {a, b}, {0, b}};
  const size_t outer = 0;
  CagFormOutline o = {0};
  CagTransform shift = cag_translate(cag_vec3(0, cag_transform_mirrors(&s->placement) ? -b : 0, 0));
  if (s->centered) shift = cag_translate(cag_vec3(-a / 2, -b / 2, -c / 2));
  w->frame = cag_transform_multiply(&w->frame, &shift);
  CagStatus status = add_polygon(&o, rectangle, 4, err);
  if (!status) {
    cag_form_prism(w, &o, &outer, 1, c);
    status = w->status;
  }
  cag_form_outline_free(&o);
  return status;
}

// --- Extrusions ---

static CagStatus add_outlines(CagFormWork *w, const CagRegion *r, double height, bool *done,
                              CagError *err) {
  CagFormOutline *outlines = cag_calloc(r->count + 1, sizeof *outlines);
  CagStatus status = outlines ? CAG_OK : cag_fail_memory(err);
  bool fits = true;
  for (size_t i = 0; !status && fits && i < r->count; i++) {
    status = cag_form_outline_curve(&outlines[i], r->loops[i], &fits, err);
    fits = fits && outlines[i].count > 0;
    if (!status && fits) cag_form_outline_turn(&outlines[i], r->outer[i] == i);
  }
  *done = !status && fits;
  if (*done) {
    cag_form_prism(w, outlines, r->outer, r->count, height);
    status = w->status;
  }
  for (size_t i = 0; outlines && i < r->count; i++) cag_form_outline_free(&outlines[i]);
  cag_free(outlines);
  return status;
}

static CagStatus add_prism(CagFormWork *w, const CagSolid *s, bool *done, CagError *err) {
  const CagRegion *region;
  CagTransform t, map;
  CagVec3 along;
  CagRegion *own;
  if (!cag_prism_of(s, &region, &t, &along)) return CAG_OK;
  CagStatus status = cag_flat_frame(&t, &w->frame, &map, err);
  if (status) return status;
  const CagVec3 up = cag_frame_column(&w->frame, 2);
  const double height = cag_dot(along, up);
  if (cag_norm(cag_madd(along, -height, up)) > CAG_ROUNDING * cag_norm(along)) return CAG_OK;
  if (height < 0) {
    const CagTransform down = cag_translate(cag_vec3(0, 0, height));
    w->frame = cag_transform_multiply(&w->frame, &down);
  }
  status = cag_region_transform(region, &map, &own, err);
  if (status) return status;
  status = add_outlines(w, own, fabs(height), done, err);
  cag_region_release(own);
  return status;
}

// --- Revolutions ---

// The profile as an outline, closed along the axis if it ends there.
static CagStatus turned_outline(CagFormOutline *o, const CagCurve *profile,
                                const CagTurnedForm *turn, double near, bool *fits, CagError *err) {
  CagCurve *plane;
  CagStatus status = cag_turn_profile(profile, turn, &plane, err);
  if (status) return status;
  status = cag_form_outline_curve(o, plane, fits, err);
  cag_curve_release(plane);
  *fits = *fits && !status && o->count > 0;
  if (!*fits) return status;
  const CagVec3 first = o->items[0].from, last = o->items[o->count - 1].to;
  if (cag_norm(cag_sub(first, last)) <= near) return CAG_OK;
  *fits = fabs(first.x) <= near && fabs(last.x) <= near;
  return cag_form_outline_line(o, last, first, err);
}

static CagStatus add_revolution(CagFormWork *w, const CagSolid *s, bool *done, CagError *err) {
  CagTurnedForm turn;
  CagBounds box;
  size_t sides, i = 0;
  const CagCurve *profile;
  if (!cag_turn_of_solid(s, &turn, &sides) || sides != 1 || !is_turn(turn.to - turn.from))
    return CAG_OK;
  while (!cag_turn_of_face(s->faces[i], &profile, &turn)) i++;
  CagStatus status = cag_solid_bounds(s, &box, err);
  if (status) return status;
  const double near = CAG_COINCIDENT * cag_norm(cag_sub(box.max, box.min));
  CagFormOutline o = {0};
  bool fits = true;
  status = turned_outline(&o, profile, &turn, near, &fits, err);
  *done = !status && fits && cag_form_outline_turns(&o, near);
  if (*done) {
    w->frame = turn.frame;
    cag_form_outline_turn(&o, true);
    cag_form_turned(w, &o, turn.from, turn.to);
    status = w->status;
  }
  cag_form_outline_free(&o);
  return status;
}

CagStatus cag_brep_add_form(CagBrep *b, const CagSolid *s, CagBrepShape *shape, bool *done,
                            CagError *err) {
  CagFormWork w = {.brep = b, .err = err};
  double scale;
  CagStatus status = CAG_OK;
  *done = false;
  shape->kind = CAG_BREP_SOLID;
  shape->first = b->shell_count;
  switch (s->kind) {
  case CAG_SOLID_BOX:
  case CAG_SOLID_SPHERE:
  case CAG_SOLID_CYLINDER:
  case CAG_SOLID_TORUS:
    if (!primitive_frame(s, &w.frame, &scale)) return CAG_OK;
    if (s->kind != CAG_SOLID_BOX) status = add_round(&w, s, scale, done, err);
    else *done = true, status = add_box(&w, s, scale, err);
    break;
  case CAG_SOLID_EXTRUSION: status = add_prism(&w, s, done, err); break;
  case CAG_SOLID_REVOLUTION: status = add_revolution(&w, s, done, err); break;
  default: break;
  }
  shape->count = b->shell_count - shape->first;
  return status;
}
