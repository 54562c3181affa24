// Exact outlines of quadrics trimmed by a box or a range of z.
//
// The loops of the trimmed pieces are splines near the exact outline. In space the outline consists
// of the conics in which the sides of the box intersect the quadric. Their equations and the ends
// of a stretch define the arcs; the loop only determines where to halve an arc that turns too much
// for one rational quadratic piece.

#include "geom/meet/quadric_arc.h"

#include <math.h>

#include "geom/curve/conic_side.h"
#include "geom/linalg/tolerance.h"
#include "geom/meet/section.h"
#include "geom/surface/trimmed.h"

// A stretch lies on a side if its points do to this fraction of the size of the box; splines are
// accurate to 1e-11 of it.
#define ON_SIDE CAG_COINCIDENT
// Maximum turn of the tangent of one arc.
#define MOST_TURN (M_PI / 3)
// Number of equal steps of a stretch that are tested.
#define STEPS 6
#define MOST_HALVINGS 12

CagTransform cag_box_side_frame(const CagBounds *box, int side, bool mirrored,
                                CagBounds *rectangle) {
  const CagVec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const CagVec3 size = cag_sub(box->max, box->min);
  const double sizes[3] = {size.x, size.y, size.z};
  const int axis = side / 2, sign = side % 2 ? 1 : -1;
  const int turn = mirrored ? -sign : sign;
  const int x = (axis + (turn > 0 ? 1 : 2)) % 3, y = (axis + (turn > 0 ? 2 : 1)) % 3;
  const CagVec3 middle =
      cag_madd(cag_lerp(box->min, box->max, 0.5), sign * sizes[axis] / 2, axes[axis]);
  const CagVec3 normal = cag_scaled(axes[axis], turn);
  *rectangle = (CagBounds){{-sizes[x] / 2, -sizes[y] / 2, 0}, {sizes[x] / 2, sizes[y] / 2, 0}};
  return (CagTransform){.m = {{axes[x].x, axes[y].x, normal.x, middle.x},
                              {axes[x].y, axes[y].y, normal.y, middle.y},
                              {axes[x].z, axes[y].z, normal.z, middle.z},
                              {0, 0, 0, 1}}};
}

typedef struct Side {
  const CagCurve *loop;
  CagTransform place, back; // from the side's plane to space, and back
  CagConic conic;           // in the plane
} Side;

// The point of the conic nearest to that of the loop.
static CagStatus point_at(const Side *s, double t, CagVec3 *out, CagError *err) {
  CagVec3 p;
  CagStatus status = cag_curve_point(s->loop, t, &p, err);
  if (status) return status;
  p = cag_transform_point(&s->back, p);
  *out = cag_conic_onto(&s->conic, cag_vec3(p.x, p.y, 0));
  return CAG_OK;
}

static CagStatus add_arc(const Side *s, CagVec3 p, CagVec3 q, CagCurve **out, size_t *n,
                         CagError *err) {
  CagCurve *flat = NULL, *space = NULL;
  CagStatus status = cag_conic_short_arc(&s->conic, p, q, &flat, err);
  if (!status) status = cag_curve_to_space(flat, &space, err);
  if (!status) status = cag_curve_transform(space, &s->place, &out[*n], err);
  if (!status) ++*n;
  cag_curve_release(flat);
  cag_curve_release(space);
  return status;
}

// Halves the stretch until its tangent turns little.
static CagStatus add_arcs(const Side *s, double a, double b, int halvings, CagCurve **out,
                          size_t *n, CagError *err) {
  CagVec3 p[STEPS + 1];
  double turn = 0;
  CagStatus status = CAG_OK;
  for (int k = 0; !status && k <= STEPS; k++)
    status = point_at(s, k == STEPS ? b : a + (b - a) * k / STEPS, &p[k], err);
  for (int k = 0; !status && k < STEPS; k++) {
    const CagVec3 g = cag_conic_gradient(&s->conic, p[k]);
    const CagVec3 h = cag_conic_gradient(&s->conic, p[k + 1]);
    turn += atan2(fabs(g.x * h.y - g.y * h.x), cag_dot(g, h));
  }
  if (status || *n == CAG_QUADRIC_ARCS) return status;
  if (turn <= MOST_TURN || halvings == 0) return add_arc(s, p[0], p[STEPS], out, n, err);
  const double half = a + (b - a) / 2;
  status = add_arcs(s, a, half, halvings - 1, out, n, err);
  return status ? status : add_arcs(s, half, b, halvings - 1, out, n, err);
}

// Tests whether the stretch lies in the plane of the side.
static CagStatus is_on_side(const Side *s, double a, double b, double slack, bool *out,
                            CagError *err) {
  CagStatus status = CAG_OK;
  *out = true;
  for (int k = 0; !status && *out && k <= STEPS; k++) {
    CagVec3 p;
    status = cag_curve_point(s->loop, a + (b - a) * k / STEPS, &p, err);
    *out = !status && fabs(cag_transform_point(&s->back, p).z) <= slack;
  }
  return status;
}

CagStatus cag_quadric_side_arcs(const CagSurface *s, const CagCurve *loop, double a, double b,
                                CagCurve *out[CAG_QUADRIC_ARCS], size_t *n, CagError *err) {
  CagQuadricWithin within;
  CagQuadric world, form;
  CagTransform back;
  CagBounds rectangle;
  *n = 0;
  if (!cag_surface_quadric_within(s, &within)) return CAG_OK;
  cag_surface_trimmed_view(s, &s, NULL);
  if (!cag_surface_quadric_view(s, &world)) return CAG_OK;
  CagStatus status = cag_transform_inverse(&within.frame, &back, err);
  if (!status) status = cag_quadric_transform(&world, &back, &form, err);
  CagBounds box = within.box;
  if (within.z_only) box.min.x = box.min.y = -1, box.max.x = box.max.y = 1;
  const CagVec3 size = cag_sub(box.max, box.min);
  const double slack = ON_SIDE * (within.z_only ? size.z : cag_norm(size));
  for (int side = within.z_only ? 4 : 0; !status && *n == 0 && side < CAG_BOX_SIDES; side++) {
    const CagTransform local = cag_box_side_frame(&box, side, false, &rectangle);
    Side on = {.loop = loop, .place = cag_transform_multiply(&within.frame, &local)};
    bool found = false;
    status = cag_transform_inverse(&on.place, &on.back, err);
    if (!status) status = is_on_side(&on, a, b, slack, &found, err);
    if (status || !found) continue;
    cag_quadric_section(&form, &local, &on.conic);
    status = add_arcs(&on, a, b, MOST_HALVINGS, out, n, err);
    if (status || *n == CAG_QUADRIC_ARCS)
      while (*n > 0) cag_curve_release(out[--*n]);
  }
  return status;
}
