// Extrusions and revolutions recognized by their faces (see form.h).

#include "geom/solid/form.h"

#include <math.h>

#include "geom/boundary/carrier.h"
#include "geom/curve/curve.h"
#include "geom/linalg/tolerance.h"
#include "geom/surface/swept.h"

CagStatus cag_flat_frame(const CagTransform *t, CagTransform *frame, CagTransform *map,
                         CagError *err) {
  const CagVec3 x = cag_frame_column(t, 0), y = cag_frame_column(t, 1),
                origin = cag_frame_column(t, 3);
  CagStatus status = cag_axes(origin, x, y, frame, err);
  if (status) return status;
  *map = cag_transform_identity();
  for (int i = 0; i < 2; i++) {
    const CagVec3 axis = cag_frame_column(frame, i);
    map->m[i][0] = cag_dot(axis, x);
    map->m[i][1] = cag_dot(axis, y);
  }
  return CAG_OK;
}

bool cag_prism_of(const CagSolid *s, const CagRegion **region, CagTransform *frame,
                  CagVec3 *along) {
  size_t caps = 0, sides = 0;
  CagVec3 ends[2], v;
  *region = NULL;
  for (size_t i = 0; i < s->face_count; i++) {
    const CagRegion *r;
    const CagCurve *section;
    CagTransform t;
    if (cag_surface_planar_view(s->faces[i], &r, &t)) {
      if (caps == 2) return false;
      ends[caps] = cag_frame_column(&t, 3);
      if (caps++ == 0) {
        *region = r;
        *frame = t;
      }
    } else {
      const CagSurface *side = s->faces[i];
      const bool placed = cag_surface_placed_view(s->faces[i], &side, &t);
      if (!cag_surface_extrusion_view(side, &section, &v)) return false;
      *along = placed ? cag_transform_vector(&t, v) : v;
      sides++;
    }
  }
  if (caps != 2 || sides == 0 || !*region) return false;
  // The frames of caps have any origin in their plane, so only their distance counts.
  const CagVec3 normal = cag_cross(cag_frame_column(frame, 0), cag_frame_column(frame, 1));
  if (cag_dot(*along, normal) * cag_dot(cag_sub(ends[1], ends[0]), normal) < 0)
    *along = cag_scaled(*along, -1);
  return true;
}

// The surface itself, if it is only flipped.
static const CagSurface *without_flip(const CagSurface *s) {
  const CagTransform same = cag_transform_identity();
  const CagSurface *inner;
  CagTransform map;
  if (!cag_surface_placed_view(s, &inner, &map)) return s;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      if (map.m[i][j] != same.m[i][j]) return s;
  return inner;
}

// Angles do not depend on the direction in which the parameter runs.
bool cag_turn_of_face(const CagSurface *face, const CagCurve **profile, CagTurnedForm *out) {
  CagVec3 axis, through, radial;
  bool one_sided;
  CagError ignored;
  face = without_flip(face);
  if (!cag_surface_revolution_view(face, profile, &axis, &through, &out->from, &out->to) ||
      !cag_surface_meridian_view(face, &radial, &one_sided))
    return false;
  const CagVec3 z = cag_unit(axis);
  return !cag_axes(through, radial, cag_cross(z, radial), &out->frame, &ignored);
}

static bool same_turn(const CagTurnedForm *a, const CagTurnedForm *b) {
  bool same = fabs(a->from - b->from) <= CAG_ROUNDING && fabs(a->to - b->to) <= CAG_ROUNDING;
  for (int i = 0; i < 3 && same; i++)
    for (int j = 0; j < 4 && same; j++)
      same = fabs(a->frame.m[i][j] - b->frame.m[i][j]) <=
             CAG_COINCIDENT * (1 + fabs(a->frame.m[i][3]));
  return same;
}

CagStatus cag_turn_profile(const CagCurve *profile, const CagTurnedForm *turn, CagCurve **out,
                           CagError *err) {
  CagTransform plane;
  const CagTransform *t = &turn->frame;
  CagStatus status =
      cag_axes(cag_frame_column(t, 3), cag_frame_column(t, 0), cag_frame_column(t, 2), &plane, err);
  return status ? status : cag_curve_flatten(profile, &plane, out, err);
}

bool cag_turn_of_solid(const CagSolid *s, CagTurnedForm *turn, size_t *sides) {
  *sides = 0;
  for (size_t i = 0; i < s->face_count; i++) {
    const CagCurve *profile;
    CagTurnedForm own;
    if (cag_surface_planar_view(s->faces[i], NULL, NULL)) continue;
    if (!cag_turn_of_face(s->faces[i], &profile, &own)) return false;
    if ((*sides)++ == 0) *turn = own;
    else if (!same_turn(turn, &own)) return false;
  }
  return *sides > 0;
}
