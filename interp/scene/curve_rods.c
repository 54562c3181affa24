#include "interp/scene/curve_rods.h"

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "interp/scene/item_mesh.h"

// The maximum turn at a joint, so that the chain looks smooth.
#define TURN_MAX (6 * 3.14159265358979323846 / 180)
// The chord tolerance, as a fraction of the radius.
#define SAG 0.05

// The number of triangles that count for a rod towards the limit.
#define ROD_TRIANGLES 24

typedef struct RodList {
  CagRod *items;
  size_t n, room, most;
} RodList;

static CagStatus add_rod(RodList *list, CagVec3 from, CagVec3 to, bool ball, CagError *err) {
  if (list->n >= list->most)
    return cag_fail(err, CAG_E_LIMIT, CAG_ERR_limit_triangles, "", -1,
                    "a curve needs more than the %zu rods allowed", list->most);
  if (!isfinite(from.x + from.y + from.z + to.x + to.y + to.z))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_not_finite, "", -1,
                    "a curve has points whose coordinates overflow or are undefined");
  if (!CAG_RESERVE(list->items, list->room, list->n + 1)) return cag_fail_memory(err);
  list->items[list->n++] = (CagRod){from, to, ball};
  return CAG_OK;
}

static bool is_circle(const CagCurve *c, double *radius, CagTransform *frame) {
  const double full_turn = 2 * 3.14159265358979323846, rounding = 1e-12;
  double a, b, scale;
  if (!cag_curve_arc_view(c, &a, &b, frame) || a != b) return false;
  if (c->end - c->start < full_turn * (1 - rounding)) return false;
  if (!cag_transform_is_similarity(frame, &scale) || fabs(scale - 1) > rounding) return false;
  *radius = a;
  return true;
}

// Adds the dashes of a segment. Only the first half of each period is drawn. *run is the length of
// the curve so far.
static CagStatus add_dashes(RodList *list, CagVec3 p, CagVec3 q, double dash, double *run,
                            CagError *err) {
  const double length = cag_norm(cag_sub(q, p));
  CagStatus status = CAG_OK;
  for (double done = 0; !status && done < length;) {
    double step = fmin(dash - fmod(*run, dash), length - done);
    if (step <= length * 1e-12) step = fmin(dash, length - done); // at a boundary, up to rounding
    if (fmod(floor((*run + step / 2) / dash), 2) == 0)
      status = add_rod(list, cag_lerp(p, q, done / length), cag_lerp(p, q, (done + step) / length),
                       false, err);
    done += step;
    *run += step;
    if (!status) status = cag_stop_check(err);
  }
  return status;
}

static CagStatus add_chain(RodList *list, const CagVec3 *p, size_t n, double dash, bool closed,
                           CagError *err) {
  double run = 0;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i + 1 < n; i++)
    status = dash > 0 ? add_dashes(list, p[i], p[i + 1], dash, &run, err)
                      : add_rod(list, p[i], p[i + 1], true, err);
  if (!status && dash <= 0 && !closed && n > 0)
    status = add_rod(list, p[n - 1], p[n - 1], true, err);
  return status;
}

static CagStatus chain_of(const CagItem *item, double radius, RodList *list, CagError *err) {
  const CagCurve *c = item->as.curve;
  double *t;
  size_t n;
  CagStatus status = cag_curve_discretize(c, SAG * radius, TURN_MAX, &t, &n, err);
  if (status) return status;
  CagVec3 *p = cag_malloc(n * sizeof *p);
  status = p ? cag_curve_eval_many(c, t, n, 0, p, err) : cag_fail_memory(err);
  if (!status) status = add_chain(list, p, n, item->dash, c->closed, err);
  cag_free(p);
  cag_free(t);
  return status;
}

static CagStatus straight_rod(const CagCurve *c, RodList *list, CagError *err) {
  CagVec3 p, q;
  CagStatus status = cag_curve_point(c, c->start, &p, err);
  if (!status) status = cag_curve_point(c, c->end, &q, err);
  return status ? status : add_rod(list, p, q, false, err);
}

CagStatus cag_curve_rods(const CagScene *s, const CagItem *item, CagCurveRods *out, CagError *err) {
  const CagCurve *c = item->as.curve;
  CagCurveRods made = {.radius = cag_item_line_radius(s, item)};
  const size_t triangles =
      s->max_triangles > 0 ? s->max_triangles : CAG_TESSELLATION_DEFAULT.max_triangles;
  RodList list = {.most = triangles / ROD_TRIANGLES};
  bool straight;
  CagStatus status = cag_curve_is_straight(c, &straight, err);
  if (status) return status;
  made.straight = straight && item->dash <= 0;
  made.circle = !made.straight && item->dash <= 0 && is_circle(c, &made.circle_radius, &made.frame);
  if (made.straight) status = straight_rod(c, &list, err);
  else if (!made.circle) status = chain_of(item, made.radius, &list, err);
  if (status) {
    cag_free(list.items);
    return status;
  }
  made.rods = list.items;
  made.count = list.n;
  *out = made;
  return CAG_OK;
}

void cag_curve_rods_free(CagCurveRods *rods) {
  cag_free(rods->rods);
  *rods = (CagCurveRods){0};
}
