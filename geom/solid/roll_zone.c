// Zones (see roll_zone.h).
//
// The second offset is larger than the first one by the tolerance, so that the result crosses the
// faces of the solid instead of coinciding with them.

#include "geom/solid/roll_zone.h"

#include <math.h>

#include "geom/boolean/boolean.h"
#include "geom/solid/convolve.h"
#include "geom/solid/csg.h"

// What is opened or closed reaches beyond the zone by this multiple of the radius.
#define MARGIN 2.2
// The tolerance of the ball, as a fraction of its radius. The time grows fast with its vertices.
#define COARSE 0.08
// The most triangles of the part, and of its first offset.
#define PART_MOST 100
#define OFFSET_MOST 2500
// The zone is a ball with facets of this tolerance, as a fraction of its radius.
#define ZONE_TOLERANCE 0.05

static CagStatus zone_part(const CagRollZone *z, const CagMesh *mesh, CagMesh **out,
                           CagError *err) {
  const double half = z->reach + MARGIN * z->radius;
  const CagVec3 h = {half, half, half};
  const CagBounds around = {cag_sub(z->point, h), cag_add(z->point, h)};
  CagMesh *box;
  CagStatus status = cag_box_mesh(&around, &box, err);
  if (status) return status;
  status = cag_mesh_boolean(CAG_INTERSECTION, mesh, box, NULL, out, err);
  cag_mesh_release(box);
  return status;
}

static CagStatus zone_ball(const CagRollZone *z, CagMesh **out, CagError *err) {
  const CagTransform to = cag_translate(z->point);
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagSolid *ball, *placed;
  how.tolerance = ZONE_TOLERANCE * z->reach;
  how.angle = M_PI / 4;
  CagStatus status = cag_solid_sphere(z->reach, &ball, err);
  if (status) return status;
  status = cag_solid_transform(ball, &to, &placed, err);
  cag_solid_release(ball);
  if (status) return status;
  status = cag_solid_tessellate(placed, &how, out, err);
  cag_solid_release(placed);
  return status;
}

static CagStatus check_count(const CagRollZone *z, const CagMesh *m, size_t most, CagError *err) {
  if (m->triangle_count <= most) return CAG_OK;
  return cag_fail(err, CAG_E_LIMIT, CAG_ERR_no_boundary, "", -1,
                  "too many triangles meet at [%.6g, %.6g, %.6g], where rounded edges do",
                  z->point.x, z->point.y, z->point.z);
}

static double ball_tolerance(const CagRollZone *z, double tolerance) {
  return fmax(tolerance / 2, COARSE * z->radius);
}

// Each of the two offsets is off by the tolerance of the ball, the second one also by its excess.
double cag_roll_zone_within(const CagRollZone *z, double tolerance) {
  return 2 * ball_tolerance(z, tolerance);
}

CagStatus cag_roll_apply_zone(const CagRollZone *z, double tolerance, CagMesh **mesh, bool *fits,
                              CagError *err) {
  const double sign = z->convex ? -1 : 1, fine = ball_tolerance(z, tolerance);
  CagMesh *part = NULL, *first = NULL, *second = NULL, *ball = NULL, *body = NULL, *next;
  *fits = false;
  CagStatus status = zone_part(z, *mesh, &part, err);
  if (!status) status = check_count(z, part, PART_MOST, err);
  if (!status) status = cag_mesh_offset(part, sign * z->radius, fine, NULL, &first, err);
  if (!status) status = check_count(z, first, OFFSET_MOST, err);
  if (!status && first->triangle_count > 0)
    status = cag_mesh_offset(first, -sign * (z->radius + fine), fine, NULL, &second, err);
  *fits = !status && second && second->triangle_count > 0;
  if (*fits) status = zone_ball(z, &ball, err);
  if (!status && *fits)
    status = cag_mesh_boolean(z->convex ? CAG_DIFFERENCE : CAG_INTERSECTION, ball, second, NULL,
                              &body, err);
  if (!status && *fits && body->triangle_count > 0) {
    status =
        cag_mesh_boolean(z->convex ? CAG_DIFFERENCE : CAG_UNION, *mesh, body, NULL, &next, err);
    if (!status) {
      cag_mesh_release(*mesh);
      *mesh = next;
    }
  }
  cag_mesh_release(part);
  cag_mesh_release(first);
  cag_mesh_release(second);
  cag_mesh_release(ball);
  cag_mesh_release(body);
  return status;
}
