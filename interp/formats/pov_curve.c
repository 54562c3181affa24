// Draws curves as tubes: a cylinder, a torus, or cylinders with spheres at their joints.

#include "base/memory.h"
#include "interp/formats/pov_write.h"
#include "interp/scene/item_mesh.h"

// The maximum turn at a joint, so that the chain looks smooth.
#define TURN_MAX (6 * 3.14159265358979323846 / 180)
// The chord tolerance, as a fraction of the tube's radius.
#define SAG 0.05

static void write_joint(CagPovWriter *w, CagVec3 p) {
  cag_pov_text(w, "sphere { ");
  cag_pov_vec(w, p);
  cag_pov_text(w, ", line_radius }");
}

// A rod that is too short for the renderer is omitted; only its end is drawn.
static void write_rod(CagPovWriter *w, CagVec3 p, CagVec3 q) {
  const double least = 1e-8; // a few hundred times the renderer's own limit
  if (cag_norm(cag_sub(q, p)) * w->unit <= least) {
    write_joint(w, p);
    return;
  }
  cag_pov_text(w, "cylinder { ");
  cag_pov_vec(w, p);
  cag_pov_text(w, ", ");
  cag_pov_vec(w, q);
  cag_pov_text(w, ", line_radius }");
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

// Writes rods and joints along the points. With dashes, only the first half of each period is
// drawn.
static void write_chain(CagPovWriter *w, const CagVec3 *p, size_t n, double dash, bool closed) {
  double run = 0; // length so far
  cag_pov_text(w, "union {\n");
  for (size_t i = 0; i + 1 < n; i++) {
    double length = cag_norm(cag_sub(p[i + 1], p[i])), done = 0;
    while (done < length) {
      double left = dash > 0 ? dash - fmod(run, dash) : length - done;
      double step = fmin(left, length - done);
      if (step <= length * 1e-12) step = fmin(dash, length - done); // at a boundary, up to rounding
      bool drawn = dash <= 0 || fmod(floor((run + step / 2) / dash), 2) == 0;
      if (drawn) {
        cag_pov_text(w, "  ");
        write_rod(w, cag_lerp(p[i], p[i + 1], done / length),
                  cag_lerp(p[i], p[i + 1], (done + step) / length));
        cag_pov_text(w, "\n");
      }
      done += step;
      run += step;
    }
    if (dash > 0) continue;
    cag_pov_text(w, "  ");
    write_joint(w, p[i]);
    cag_pov_text(w, "\n");
  }
  if (dash <= 0 && !closed && n > 0) {
    cag_pov_text(w, "  ");
    write_joint(w, p[n - 1]);
    cag_pov_text(w, "\n");
  }
  cag_pov_text(w, "}");
}

static CagStatus write_polyline(CagPovWriter *w, const CagItem *item, double radius,
                                CagError *err) {
  const CagCurve *c = item->as.curve;
  double *t;
  size_t n;
  CagStatus status = cag_curve_discretize(c, SAG * radius, TURN_MAX, &t, &n, err);
  if (status) return status;
  CagVec3 *p = cag_malloc(n * sizeof *p);
  status = p ? cag_curve_eval_many(c, t, n, 0, p, err) : cag_fail_memory(err);
  if (!status) write_chain(w, p, n, item->dash, c->closed);
  cag_free(p);
  cag_free(t);
  return status;
}

CagStatus cag_pov_curve(CagPovWriter *w, const CagItem *item, const char *name, CagError *err) {
  const CagCurve *c = item->as.curve;
  double radius = cag_item_line_radius(w->scene, item), circle;
  CagTransform frame;
  cag_pov_text(w, "#local line_radius = ");
  cag_pov_number(w, radius);
  cag_pov_printf(w, ";\n#declare %s = ", name);
  bool straight;
  CagStatus status = cag_curve_is_straight(c, &straight, err);
  if (status) return status;
  if (item->dash <= 0 && straight) {
    CagVec3 p, q;
    status = cag_curve_point(c, c->start, &p, err);
    if (!status) status = cag_curve_point(c, c->end, &q, err);
    if (!status) write_rod(w, p, q);
    return status;
  }
  if (item->dash <= 0 && is_circle(c, &circle, &frame)) {
    cag_pov_text(w, "torus {\n  ");
    cag_pov_number(w, circle);
    cag_pov_text(w, ", line_radius\n  rotate 90*x // POV-Ray's own lie about y\n");
    cag_pov_placement(w, "  ", &frame);
    cag_pov_text(w, "}");
    return CAG_OK;
  }
  return write_polyline(w, item, radius, err);
}
