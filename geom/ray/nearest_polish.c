// The nearest point of a set operation near a point of its mesh.
//
// Close to the point are the boundaries of one operand, two at an edge, or three at a corner. Their
// tangent planes are found from the feet of a point beside the boundary. With them, the conditions
// for the nearest point are solved by Newton's method in the plane or line that all have in common;
// the derivatives, which contain the curvatures, are differences.

#include "base/stop.h"
#include "geom/ray/caster_parts.h"
#include "geom/ray/nearest.h"

// The offset of points beside the boundary is at first a fraction of the reach, because the start is
// not on the boundary. It decreases to this fraction of the size: a compromise between curvature and
// rounding.
#define FIRST_OFFSET 0.5
#define DECREASE 0.1
#define BESIDE 1e-8
// The step of differences, as a fraction of the size.
#define DIFFERENCE 1e-4
// A foot has to be at least this fraction of the offset away, to determine a normal.
#define CLEAR 0.1
// Planes that intersect at a smaller squared sine are parallel.
#define PARALLEL 1e-4
// The last step, and the distance of the result from the boundaries, as fractions of the size.
#define LAST_STEP 1e-8
#define ON_BOUNDARY 1e-9
// Smaller determinants of derivatives, which are about 1 on flat boundaries, are rounding.
#define SINGULAR 1e-3
// There, the way is at most this fraction of the size.
#define LEVEL 1e-4
// The nearest points of a boundary and of its mesh are farther apart along it than across it: at
// most this many times the geometric mean of the reach and the size.
#define ALONG 4.0
// Rounding of the way along the boundary.
#define NO_WAY 5e-9
enum { LEAVES_MAX = 3, ITERATIONS = 20, OFFSETS = 9 };

typedef struct Spot {
  const CagCaster *leaves[LEAVES_MAX];
  int n; // more than LEAVES_MAX: too many
  CagVec3 p;
  double size, offset; // of points beside the boundary
  CagCrossings *work;
} Spot;

static CagStatus collect_leaves(const CagCaster *c, CagVec3 at, double reach, Spot *spot,
                                CagError *err) {
  CagStatus status = CAG_OK;
  if (c->kind == CAG_CASTER_OPERATION) {
    for (size_t i = 0; !status && i < c->operand_count && spot->n <= LEAVES_MAX; i++)
      status = collect_leaves(c->operands[i], at, reach, spot, err);
    return status;
  }
  CagNearest found;
  status = cag_caster_closest(c, at, reach, spot->work, &found, err);
  if (status || !found.found) return status;
  if (spot->n < LEAVES_MAX) spot->leaves[spot->n] = c;
  spot->n++;
  return CAG_OK;
}

// --- Tangent planes ---

// Whether a plane intersects the n others.
static bool is_oblique(const CagPlane *plane, const CagPlane *others, int n) {
  for (int i = 0; i < n; i++) {
    const CagVec3 cross = cag_cross(plane->normal, others[i].normal);
    if (!(cag_dot(cross, cross) > PARALLEL)) return false;
  }
  return true;
}

// Finds a tangent plane of a leaf close to x that intersects the n others, from the foot of a point
// toward p, or else beside it and behind. Operands may have faces in common, so that the first foot
// can be on the wrong one.
static CagStatus leaf_plane(const Spot *spot, const CagCaster *leaf, CagVec3 x,
                            const CagPlane *others, int n, CagPlane *out, bool *good,
                            CagError *err) {
  const CagVec3 toward = cag_unit(cag_sub(spot->p, x));
  const CagVec3 other = fabs(toward.z) < 0.7 ? cag_vec3(0, 0, 1) : cag_vec3(1, 0, 0);
  const CagVec3 a = cag_unit(cag_cross(toward, other)), b = cag_cross(toward, a);
  *good = false;
  for (int k = 0; k < OFFSETS && !*good; k++) {
    CagNearest found;
    const double by = spot->offset;
    const CagVec3 side = cag_scaled(k % 4 < 2 ? a : b, k == 0 ? 0 : k % 2 ? 2 : -2);
    const CagVec3 y = cag_madd(x, by, cag_unit(cag_add(cag_scaled(toward, k > 4 ? -1 : 1), side)));
    CagStatus status = cag_caster_closest(leaf, y, INFINITY, spot->work, &found, err);
    if (status) return status;
    *out = (CagPlane){found.point, cag_unit(cag_sub(y, found.point))};
    *good = found.found && found.distance >= CLEAR * by && is_oblique(out, others, n);
  }
  return CAG_OK;
}

// The point that all planes have in common and that is closest to a given one. Returns false if they
// are parallel.
static bool common_foot(const CagPlane *planes, int n, CagVec3 to, CagVec3 *out) {
  double off[LEAVES_MAX] = {0};
  const CagVec3 a = planes[0].normal;
  for (int i = 0; i < n; i++) off[i] = cag_dot(planes[i].normal, cag_sub(planes[i].point, to));
  if (n == 1) {
    *out = cag_madd(to, off[0], a);
    return true;
  }
  const CagVec3 b = planes[1].normal, ab = cag_cross(a, b);
  const double square = cag_dot(ab, ab);
  if (!(square > PARALLEL)) return false;
  if (n == 2) {
    const CagVec3 step =
        cag_add(cag_scaled(cag_cross(b, ab), off[0]), cag_scaled(cag_cross(ab, a), off[1]));
    *out = cag_madd(to, 1 / square, step);
    return true;
  }
  const CagVec3 c = planes[2].normal;
  const double det = cag_dot(ab, c);
  if (!(fabs(det) > PARALLEL)) return false;
  const CagVec3 step =
      cag_add(cag_add(cag_scaled(cag_cross(b, c), off[0]), cag_scaled(cag_cross(c, a), off[1])),
              cag_scaled(ab, off[2]));
  *out = cag_madd(to, 1 / det, step);
  return true;
}

// The planes at x, the point of the boundary there, and the way from it to the foot of p.
typedef struct Tangent {
  CagPlane planes[LEAVES_MAX];
  CagVec3 at, way;
} Tangent;

static CagStatus tangent_at(const Spot *spot, CagVec3 x, Tangent *out, bool *good, CagError *err) {
  CagVec3 foot;
  CagStatus status = cag_stop_check(err);
  *good = true;
  for (int i = 0; !status && *good && i < spot->n; i++)
    status = leaf_plane(spot, spot->leaves[i], x, out->planes, i, &out->planes[i], good, err);
  if (status || !*good) return status;
  *good = common_foot(out->planes, spot->n, x, &out->at) &&
          common_foot(out->planes, spot->n, spot->p, &foot);
  if (*good) out->way = cag_sub(foot, out->at);
  return CAG_OK;
}

// --- Newton's method ---

// The directions along the boundary: two, one along an edge, none at a corner.
static int directions_of(const Tangent *t, int n, CagVec3 out[2]) {
  const CagVec3 normal = t->planes[0].normal;
  if (n == 3) return 0;
  if (n == 2) {
    out[0] = cag_unit(cag_cross(normal, t->planes[1].normal));
    return 1;
  }
  const CagVec3 other = fabs(normal.z) < 0.7 ? cag_vec3(0, 0, 1) : cag_vec3(1, 0, 0);
  out[0] = cag_unit(cag_cross(normal, other));
  out[1] = cag_cross(normal, out[0]);
  return 2;
}

// The step along the directions at which the way to the foot of p vanishes.
static CagStatus newton_step(const Spot *spot, const Tangent *t, CagVec3 *step, bool *good,
                             CagError *err) {
  CagVec3 along[2];
  double j[2][2] = {{-1, 0}, {0, -1}}, r[2] = {0, 0};
  const int n = directions_of(t, spot->n, along);
  const double by = DIFFERENCE * spot->size;
  *step = cag_vec3(0, 0, 0);
  *good = true;
  if (cag_norm(t->way) <= NO_WAY * spot->size) return CAG_OK;
  for (int k = 0; k < n; k++) {
    Tangent beside;
    CagStatus status = tangent_at(spot, cag_madd(t->at, by, along[k]), &beside, good, err);
    if (status || !*good) return status;
    r[k] = cag_dot(t->way, along[k]);
    for (int i = 0; i < n; i++)
      j[i][k] = (cag_dot(beside.way, along[i]) - cag_dot(t->way, along[i])) / by;
  }
  const double det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
  if (n == 0) return CAG_OK;
  if (!(fabs(det) > SINGULAR)) { // all points near it are equally near, or the method fails
    *good = cag_norm(t->way) <= LEVEL * spot->size;
    return CAG_OK;
  }
  *step = cag_scaled(along[0], (j[0][1] * r[1] - j[1][1] * r[0]) / det);
  if (n == 2) *step = cag_madd(*step, (j[1][0] * r[0] - j[0][0] * r[1]) / det, along[1]);
  return CAG_OK;
}

// Whether x is on the boundaries of all leaves and of the result.
static CagStatus check_result(const CagCaster *c, const Spot *spot, CagVec3 x, bool *on,
                              CagError *err) {
  const double slack = ON_BOUNDARY * spot->size;
  CagStatus status = CAG_OK;
  int side = 0;
  *on = true;
  for (int i = 0; !status && *on && i < spot->n; i++) {
    CagNearest found;
    status = cag_caster_closest(spot->leaves[i], x, slack, spot->work, &found, err);
    *on = found.found;
  }
  if (!status && *on) status = cag_caster_side(c, x, slack, spot->work, &side, err);
  *on = *on && side == 0;
  return status;
}

CagStatus cag_caster_polish(const CagCaster *c, CagVec3 p, CagVec3 start, double reach,
                            CagCrossings *work, CagNearest *out, CagError *err) {
  Spot spot = {.p = p, .size = c->size > 0 ? c->size : 1, .work = work};
  *out = (CagNearest){.distance = INFINITY};
  CagStatus status = collect_leaves(c, start, reach, &spot, err);
  if (status || spot.n == 0 || spot.n > LEAVES_MAX) return status;
  const double least = BESIDE * spot.size;
  spot.offset = fmax(least, FIRST_OFFSET * reach);
  const double along = ALONG * sqrt(reach * spot.size);
  CagVec3 x = start, step;
  bool good = true, done = false;
  for (int i = 0; !status && good && !done && i < ITERATIONS; i++) {
    Tangent t;
    status = tangent_at(&spot, x, &t, &good, err);
    if (!status && good) status = newton_step(&spot, &t, &step, &good, err);
    if (status || !good) break;
    const CagVec3 next = cag_add(t.at, step);
    done = spot.offset == least && cag_norm(cag_sub(next, x)) <= LAST_STEP * spot.size;
    spot.offset = fmax(least, DECREASE * spot.offset);
    x = next;
    good = cag_norm(cag_sub(x, start)) <= along;
  }
  if (status || !good || !done) return status;
  status = check_result(c, &spot, x, &good, err);
  if (!status && good) *out = (CagNearest){true, true, cag_norm(cag_sub(x, p)), x};
  return status;
}
