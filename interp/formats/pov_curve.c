// Draws curves as tubes: a cylinder, a torus, or cylinders with spheres at their joints.

#include "interp/formats/pov_write.h"
#include "interp/scene/curve_rods.h"

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

static void write_chain(CagPovWriter *w, const CagCurveRods *c) {
  cag_pov_text(w, "union {\n");
  for (size_t i = 0; i < c->count; i++) {
    const CagRod *rod = &c->rods[i];
    if (cag_norm(cag_sub(rod->to, rod->from)) > 0) {
      cag_pov_text(w, "  ");
      write_rod(w, rod->from, rod->to);
      cag_pov_text(w, "\n");
    }
    if (!rod->ball) continue;
    cag_pov_text(w, "  ");
    write_joint(w, rod->from);
    cag_pov_text(w, "\n");
  }
  cag_pov_text(w, "}");
}

static void write_circle(CagPovWriter *w, const CagCurveRods *c) {
  cag_pov_text(w, "torus {\n  ");
  cag_pov_number(w, c->circle_radius);
  cag_pov_text(w, ", line_radius\n  rotate 90*x // POV-Ray's own lie about y\n");
  cag_pov_placement(w, "  ", &c->frame);
  cag_pov_text(w, "}");
}

CagStatus cag_pov_curve(CagPovWriter *w, const CagItem *item, const char *name, CagError *err) {
  CagCurveRods rods;
  CagStatus status = cag_curve_rods(w->scene, item, &rods, err);
  if (status) return status;
  cag_pov_text(w, "#local line_radius = ");
  cag_pov_number(w, rods.radius);
  cag_pov_printf(w, ";\n#declare %s = ", name);
  if (rods.circle) write_circle(w, &rods);
  else if (rods.straight) write_rod(w, rods.rods[0].from, rods.rods[0].to);
  else write_chain(w, &rods);
  cag_curve_rods_free(&rods);
  return CAG_OK;
}
