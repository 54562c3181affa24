// Common points of two surfaces, found by Newton's method on the parameters of both.

#include "geom/meet/meet_place.h"

#include <float.h>
#include <math.h>

#include "geom/surface/function.h"

#define NEWTON_STEPS 40

bool cag_march_partials(CagMarch *m, int k, const CagMarchNode *node, int order, CagVec3 *out) {
  const CagSurface *s = m->side[k].s;
  const double *at = node->at[k], lo[2] = {s->u0, s->v0}, hi[2] = {s->u1, s->v1};
  CagSide side[2];
  bool on_edge = false;
  for (int d = 0; d < 2; d++) {
    side[d] = at[d] >= cag_march_range(m, k, node, d)[1] ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
    on_edge = on_edge || at[d] <= lo[d] || at[d] >= hi[d];
  }
  const CagStatus status =
      on_edge && cag_surface_is_formula(s)
          ? cag_surface_eval_beside(s, lo, hi, at, order, out, m->err)
          : cag_surface_eval(s, at[0], at[1], order, side[0], side[1], out, m->err);
  return !status || cag_march_fail(m, status);
}

bool cag_march_look(CagMarch *m, int k, const CagMarchNode *node, CagMarchTangent *out) {
  CagVec3 d[4];
  if (!cag_march_partials(m, k, node, 1, d)) return false;
  *out = (CagMarchTangent){.p = d[0], .du = d[cag_partial(1, 1, 0)], .dv = d[cag_partial(1, 0, 1)]};
  out->normal = cag_unit(cag_cross(out->du, out->dv));
  // At poles the normal is a limit.
  if (cag_norm(out->normal) == 0) {
    CagError ignored;
    if (cag_surface_normal(m->side[k].s, node->at[k][0], node->at[k][1], &out->normal, &ignored))
      out->normal = cag_vec3(0, 0, 0);
  }
  return true;
}

static double stepped(double x, double d, double low, double high, bool closed) {
  double range = high - low, y = x + fmin(fmax(d, -range / 4), range / 4);
  if (closed && y < low) return y + range;
  if (closed && y > high) return y - range;
  return fmin(fmax(y, low), high);
}

// A step of u (or v) that would pass a pole continues beyond it, where the other parameter is
// shifted by half its range.
static bool pass_pole(CagMarch *m, int k, int d, double step, CagMarchNode *node) {
  const CagSurface *s = m->side[k].s;
  const double *own = cag_march_range(m, k, node, d), *other = cag_march_range(m, k, node, 1 - d);
  const bool pole_low = d ? s->pole_v0 : s->pole_u0, pole_high = d ? s->pole_v1 : s->pole_u1;
  double *at = node->at[k], y = at[d] + step, range = other[1] - other[0];
  if (!m->side[k].patches.wraps[1 - d]) return false;
  if (y < own[0] && pole_low && own[0] == (d ? s->v0 : s->u0)) at[d] = fmin(2 * own[0] - y, own[1]);
  else if (y > own[1] && pole_high && own[1] == (d ? s->v1 : s->u1))
    at[d] = fmax(2 * own[1] - y, own[0]);
  else return false;
  at[1 - d] += at[1 - d] + range / 2 > other[1] ? -range / 2 : range / 2;
  return true;
}

void cag_march_move(CagMarch *m, int k, const CagMarchTangent *t, CagVec3 x, CagMarchNode *node) {
  CagVec3 r = cag_sub(x, t->p);
  double a = cag_dot(t->du, t->du), b = cag_dot(t->du, t->dv), c = cag_dot(t->dv, t->dv);
  double damping = 1e-14 * (a + c) + DBL_MIN;
  double det = (a + damping) * (c + damping) - b * b;
  double g = cag_dot(r, t->du), h = cag_dot(r, t->dv);
  double du = ((c + damping) * g - b * h) / det, dv = ((a + damping) * h - b * g) / det;
  if (pass_pole(m, k, 0, du, node) || pass_pole(m, k, 1, dv, node)) return;
  for (int d = 0; d < 2; d++) {
    const double *range = cag_march_range(m, k, node, d);
    node->at[k][d] =
        stepped(node->at[k][d], d ? dv : du, range[0], range[1], m->side[k].patches.wraps[d]);
  }
}

CagMarchFound cag_march_locate_crossing(CagMarch *m, CagVec3 q, CagVec3 n, CagVec3 along,
                                        CagMarchNode *node) {
  double last = INFINITY;
  for (int i = 0; i < NEWTON_STEPS; i++) {
    CagMarchTangent t[2];
    if (!cag_march_look(m, 0, node, &t[0]) || !cag_march_look(m, 1, node, &t[1]))
      return CAG_MARCH_FAILED;
    CagVec3 middle = cag_lerp(t[0].p, t[1].p, 0.5);
    CagVec3 cross = cag_cross(t[0].normal, t[1].normal);
    double gap = cag_norm(cag_sub(t[0].p, t[1].p));
    bool planar = cag_norm(n) > 0;
    double off = planar ? fabs(cag_dot(n, cag_sub(middle, q))) : 0;
    if (gap + off <= CAG_MARCH_SAME * m->size && (gap + off > last / 2 || gap + off == 0)) {
      if (cag_norm(cross) < CAG_MARCH_TOUCH) return CAG_MARCH_TANGENT;
      node->x = middle;
      node->tangent = cag_unit(cross);
      if (cag_dot(node->tangent, along) < 0) node->tangent = cag_scaled(node->tangent, -1);
      return CAG_MARCH_FOUND;
    }
    if (i > 8 && gap + off > last / 2 && gap + off > CAG_MARCH_SAME * m->size)
      return CAG_MARCH_NONE;
    last = fmin(last, gap + off);
    // The intersection of three planes: both tangent planes and the given one, or the one
    // perpendicular to both.
    CagVec3 third = planar ? n : cag_unit(cross), through = planar ? q : middle;
    CagVec3 c0 = cag_cross(t[1].normal, third), c1 = cag_cross(third, t[0].normal);
    double det = cag_dot(t[0].normal, c0);
    CagVec3 x;
    if (fabs(det) < CAG_MARCH_TOUCH * CAG_MARCH_TOUCH) {
      // Parallel planes: the midpoint, projected to the given plane.
      x = planar ? cag_madd(middle, cag_dot(n, cag_sub(q, middle)), n) : middle;
    } else {
      x = cag_scaled(c0, cag_dot(t[0].normal, cag_sub(t[0].p, middle)));
      x = cag_madd(x, cag_dot(t[1].normal, cag_sub(t[1].p, middle)), c1);
      x = cag_madd(x, cag_dot(third, cag_sub(through, middle)), cross);
      x = cag_madd(middle, 1 / det, x);
    }
    for (int k = 0; k < 2; k++) cag_march_move(m, k, &t[k], x, node);
  }
  return CAG_MARCH_NONE;
}

bool cag_march_belongs_to(CagMarch *m, int k, const CagMarchNode *node, bool *out) {
  const CagVec3 p = cag_vec3(node->at[k][0], node->at[k][1], 0);
  *out = true;
  if (!m->side[k].region) return true;
  CagStatus status = cag_region_contains(m->side[k].region, p, out, m->err);
  return !status || cag_march_fail(m, status);
}

bool cag_march_belongs(CagMarch *m, const CagMarchNode *node) {
  bool inside;
  for (int k = 0; k < 2; k++)
    if (!cag_march_belongs_to(m, k, node, &inside) || !inside) return false;
  return true;
}
