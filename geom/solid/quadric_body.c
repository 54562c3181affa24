// Bodies that pieces of a quadric bound together with flat faces.
//
// The body is the intersection of a box and one side of the quadric. Pieces cut by a box or a range
// of z store that box. For other patches, the box is the range of the canonical coordinates of the
// patches.

#include <math.h>
#include <string.h>

#include "geom/solid/csg.h"
#include "geom/surface/trimmed.h"

#define WHOLE_TURN (2 * M_PI * (1 - 1e-12))

static bool same_equation(const CagQuadric *a, const CagQuadric *b) {
  bool same = true, opposite = true;
  for (int i = 0; i < 10; i++) {
    same = same && a->c[i] == b->c[i];
    opposite = opposite && a->c[i] == -b->c[i];
  }
  return same || opposite;
}

static bool same_within(const CagQuadricWithin *a, const CagQuadricWithin *b) {
  return a->z_only == b->z_only && a->pieces == b->pieces &&
         memcmp(&a->box, &b->box, sizeof a->box) == 0 &&
         memcmp(a->frame.m, b->frame.m, sizeof a->frame.m) == 0;
}

static const CagSurface *whole_of(const CagSurface *piece) {
  cag_surface_trimmed_view(piece, &piece, NULL);
  return piece;
}

// Tests whether the pieces are all those of one box or range, each exactly once.
static bool are_all_within(CagSurface *const *pieces, size_t n, CagQuadricWithin *out) {
  CagQuadricWithin other;
  if (!cag_surface_quadric_within(pieces[0], out) || out->pieces != n) return false;
  for (size_t i = 1; i < n; i++) {
    if (!cag_surface_quadric_within(pieces[i], &other) || !same_within(out, &other)) return false;
    for (size_t k = 0; k < i; k++)
      if (pieces[k] == pieces[i]) return false;
  }
  return true;
}

bool cag_solid_has_quadric_body(CagSurface *const *pieces, size_t n) {
  CagQuadric first, other;
  CagQuadricWithin within;
  if (n == 0) return false;
  const bool all = are_all_within(pieces, n, &within);
  for (size_t i = 0; i < n; i++) {
    const CagSurface *whole = all ? whole_of(pieces[i]) : pieces[i];
    if (!cag_surface_quadric_view(whole, i == 0 ? &first : &other)) return false;
    // A strip of a turn is no body's side: what lies beside it is not known.
    if (!all && whole->angular_u && whole->u1 - whole->u0 < WHOLE_TURN) return false;
    if (i > 0 && !same_equation(&first, &other)) return false;
  }
  return true;
}

// The bounds of the pieces in coordinates of the frame.
static CagStatus local_bounds(const CagTransform *frame, CagSurface *const *pieces, size_t n,
                              CagBounds *out, CagError *err) {
  CagTransform back;
  CagStatus status = cag_transform_inverse(frame, &back, err);
  *out = CAG_BOUNDS_EMPTY;
  for (size_t i = 0; !status && i < n; i++) {
    CagSurface *local;
    CagBounds one;
    status = cag_surface_transform(pieces[i], &back, &local, err);
    if (status) return status;
    status = cag_surface_bounds(local, &one, err);
    cag_surface_release(local);
    if (status) return status;
    cag_bounds_add(out, one.min);
    cag_bounds_add(out, one.max);
  }
  return status;
}

static bool is_about_axis(CagQuadricClass c) {
  return c == CAG_QUADRIC_ELLIPSOID || c == CAG_QUADRIC_HYPERBOLOID_ONE ||
         c == CAG_QUADRIC_HYPERBOLOID_TWO || c == CAG_QUADRIC_CONE ||
         c == CAG_QUADRIC_ELLIPTIC_PARABOLOID || c == CAG_QUADRIC_ELLIPTIC_CYLINDER;
}

// Finds the box that bounds the body, in coordinates of a frame.
static CagStatus find_box(const CagQuadricForm *form, CagSurface *const *pieces, size_t n,
                          CagBounds *box, CagTransform *frame, CagError *err) {
  CagQuadricWithin within;
  const bool all = are_all_within(pieces, n, &within);
  *frame = all ? within.frame : form->frame;
  frame->planar = false;
  if (all && !within.z_only) {
    *box = within.box;
    return CAG_OK;
  }
  CagStatus status = local_bounds(frame, pieces, n, box, err);
  if (status) return status;
  if (all ||
      is_about_axis(form->class_id)) { // a margin, so that the box touches nothing but the cut
    const double room = cag_norm(cag_sub(box->max, box->min));
    box->min.x -= room, box->min.y -= room, box->max.x += room, box->max.y += room;
  }
  if (all) {
    box->min.z = within.box.min.z;
    box->max.z = within.box.max.z;
  }
  return CAG_OK;
}

static CagStatus placed_box(const CagBounds *box, const CagTransform *frame, CagSolid **out,
                            CagError *err) {
  CagTransform shift = cag_translate(box->min), place;
  CagSolid *upright;
  shift.planar = false;
  place = cag_transform_multiply(frame, &shift);
  CagStatus status = cag_solid_box(cag_sub(box->max, box->min), false, &upright, err);
  if (status) return status;
  status = cag_solid_transform(upright, &place, out, err);
  cag_solid_release(upright);
  return status;
}

CagStatus cag_solid_quadric_body(CagSurface *const *pieces, size_t n, const volatile int *interrupt,
                                 CagSolid **out, CagError *err) {
  CagQuadric q;
  CagQuadricForm form;
  CagQuadricWithin within;
  CagBounds box;
  CagTransform frame;
  CagSolid *parts[2] = {NULL};
  cag_surface_quadric_view(whole_of(pieces[0]), &q);
  CagStatus status = cag_quadric_classify(&q, &form, err);
  if (!status && form.class_id == CAG_QUADRIC_HYPERBOLIC_PARABOLOID &&
      are_all_within(pieces, n, &within) && within.negated)
    for (int i = 0; i < 10; i++) q.c[i] = -q.c[i];
  if (!status) status = find_box(&form, pieces, n, &box, &frame, err);
  if (!status) status = cag_solid_quadric(&q, &parts[0], err);
  if (!status) status = placed_box(&box, &frame, &parts[1], err);
  if (!status) status = cag_solid_combine(CAG_INTERSECTION, parts, 2, interrupt, out, err);
  cag_solid_release(parts[0]);
  cag_solid_release(parts[1]);
  return status;
}
