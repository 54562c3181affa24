// Fillets and chamfers of solids as meshes (see rolling.h).

#include "geom/solid/rolling.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/solid/csg.h"
#include "geom/solid/roll_apply.h"
#include "geom/solid/roll_plan.h"
#include "geom/solid/roll_zone.h"
#include "geom/solid/tessellate.h"

// Steps to find the largest sizes that fit: by the contacts alone, and by the result.
#define CHEAP_STEPS 12
#define FULL_STEPS 6
#define FULL_STEPS_FEW 3
// The mesh of the solid is this much finer than the result.
#define FINER 0.5

typedef struct Rolling {
  CagRollPart *parts;
  size_t part_count;
  const CagRolledEdge *edges;
  size_t n;
  bool flat;
  double tolerance;
  CagMesh *mesh;
} Rolling;

static const char *rounding_name(bool flat) { return flat ? "chamfer" : "fillet"; }

static CagStatus check_edges(const Rolling *r, CagError *err) {
  for (size_t i = 0; i < r->n; i++) {
    const CagRolledEdge *e = &r->edges[i];
    const bool known = e->part < r->part_count && e->edge < r->parts[e->part].b->edge_count;
    if (!known)
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_no_boundary, "edges", (long)i,
                      "the solid has no edge %zu", e->edge);
    if (r->parts[e->part].bends[e->edge] == CAG_ROLL_SMOOTH)
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_no_boundary, "edges", (long)i,
                      "the faces of edges[%zu] meet smoothly", i);
    for (int k = 0; k < 2; k++)
      if (!(e->size[k] > 0) || !isfinite(e->size[k]))
        return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_radius_not_positive, rounding_name(r->flat),
                        (long)i, "the size of a %s must be positive: %g", rounding_name(r->flat),
                        e->size[k]);
    for (size_t k = 0; k < i; k++)
      if (r->edges[k].part == e->part && r->edges[k].edge == e->edge)
        return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_no_boundary, "edges", (long)i,
                        "edges[%zu] and edges[%zu] are the same", k, i);
  }
  return CAG_OK;
}

// The plan with all sizes multiplied by a factor.
static CagStatus scaled_plan(const Rolling *r, double factor, CagRollCorners corners,
                             CagRollPlan *out, CagError *err) {
  CagRollPick *picks = cag_calloc(r->n + 1, sizeof *picks);
  CagStatus status = picks ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < r->n; i++) {
    const CagRolledEdge *from = &r->edges[i];
    const CagRollPart *part = &r->parts[from->part];
    CagRollPick *pick = &picks[i];
    pick->part = from->part;
    pick->edge = from->edge;
    pick->corner[0] = part->b->edges[from->edge].from;
    pick->corner[1] = part->b->edges[from->edge].to;
    status = cag_roll_edge(part, from->edge, &pick->e, err);
    pick->e.flat = r->flat;
    for (int end = 0; end < 2; end++)
      for (int side = 0; side < 2; side++)
        pick->e.size[end][side] = factor * from->size[r->flat ? side : end];
  }
  if (status) {
    cag_free(picks);
    return status;
  }
  return cag_roll_plan(r->parts, r->part_count, r->tolerance, corners, picks, r->n, out, err);
}

// *zones: the distance of the result near zones, 0 without them.
static CagStatus try_plan(const Rolling *r, double factor, CagRollCorners corners, CagMesh **out,
                          size_t *unfit, double *zones, CagError *err) {
  CagRollPlan plan;
  CagStatus status = scaled_plan(r, factor, corners, &plan, err);
  if (status) return status;
  if (plan.unfit == CAG_ROLL_NONE) status = cag_roll_contacts(&plan, r->mesh, err);
  if (!status && out && plan.unfit == CAG_ROLL_NONE)
    status = cag_roll_apply(&plan, r->mesh, out, err);
  *unfit = plan.unfit;
  *zones = 0;
  for (size_t i = 0; i < plan.zone_count; i++)
    *zones = fmax(*zones, cag_roll_zone_within(&plan.zones[i], r->tolerance));
  cag_roll_plan_free(&plan);
  return status;
}

// Tries sizes. *unfit: the edge that does not fit, or CAG_ROLL_NONE. *out is set if all fit. If zones
// fail, edges are mitered. *within: the distance of the result.
static CagStatus try_factor(const Rolling *r, double factor, CagMesh **out, size_t *unfit,
                            double *within, CagError *err) {
  double zones = 0;
  CagStatus status = try_plan(r, factor, CAG_ROLL_ZONES, out, unfit, &zones, err);
  *within = fmax(r->tolerance, zones);
  if (cag_is_final(status) || zones == 0 || (!status && *unfit == CAG_ROLL_NONE)) return status;
  *within = r->tolerance;
  return try_plan(r, factor, CAG_ROLL_MITERS, out, unfit, &zones, err);
}

// Finds the largest factor below 1 that fits; 0 if there is none. Errors count as not fitting,
// except those that end the run.
static CagStatus search_factor(const Rolling *r, CagRollCorners corners, int full_steps,
                               double *out, CagError *err) {
  double low = 0, high = 1;
  for (int k = 0; k < CHEAP_STEPS + full_steps; k++) {
    const bool full = k >= CHEAP_STEPS;
    // The first full test is that of the factor found so far.
    const double middle = k == CHEAP_STEPS ? low : (low + high) / 2;
    CagMesh *m = NULL;
    size_t unfit = CAG_ROLL_NONE;
    double ignored;
    if (full && !(middle > 0)) break;
    CagStatus status = full ? try_factor(r, middle, &m, &unfit, &ignored, err)
                            : try_plan(r, middle, corners, NULL, &unfit, &ignored, err);
    cag_mesh_release(m);
    if (cag_is_final(status)) return status;
    const bool fits = !status && unfit == CAG_ROLL_NONE;
    if (k == CHEAP_STEPS && fits) break;
    if (k == CHEAP_STEPS) low = 0, high = middle;
    else *(fits ? &low : &high) = middle;
  }
  *out = low;
  return CAG_OK;
}

// Balls at corners limit the sizes, unless a corner has none of any size.
static CagStatus largest_factor(const Rolling *r, double *out, CagError *err) {
  const CagStatus status = search_factor(r, CAG_ROLL_BALLS, FULL_STEPS, out, err);
  if (status || *out > 0) return status;
  return search_factor(r, CAG_ROLL_MITERS, FULL_STEPS_FEW, out, err);
}

// limit: NULL: the largest size, which takes long to find, is not told.
static CagStatus fail_unfit(const Rolling *r, size_t unfit, CagRollLimit *limit, CagError *err) {
  double factor = 0;
  char given[32], largest[64] = "";
  CagStatus status = limit ? largest_factor(r, &factor, err) : CAG_OK;
  if (status) return status;
  if (limit) *limit = (CagRollLimit){unfit, factor};
  const double size = fmax(r->edges[unfit].size[0], r->edges[unfit].size[1]);
  cag_number_text(size, given);
  if (factor > 0) snprintf(largest, sizeof largest, ": at most about %.4g", factor * size);
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_rounding_too_large, "edges", (long)unfit,
                  "a %s of %s does not fit at edges[%zu]%s", rounding_name(r->flat), given, unfit,
                  largest);
}

static CagStatus round_edges(const CagSolid *s, const CagRolledEdge *edges, size_t n, bool flat,
                             double tolerance, CagRollLimit *limit, double *within, CagSolid **out,
                             CagError *err) {
  Rolling r = {.edges = edges, .n = n, .flat = flat, .tolerance = tolerance};
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *m = NULL;
  size_t unfit = CAG_ROLL_NONE;
  double reached = tolerance;
  if (limit) *limit = (CagRollLimit){SIZE_MAX, 0};
  if (!(tolerance > 0))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_tolerance_not_positive, "tolerance", -1,
                    "`tolerance` must be positive: %g", tolerance);
  how.tolerance = FINER * tolerance;
  CagStatus status = cag_roll_parts(s, &r.parts, &r.part_count, err);
  if (status) return status;
  status = check_edges(&r, err);
  if (!status) status = cag_solid_tessellate(s, &how, &r.mesh, err);
  if (!status) status = try_factor(&r, 1, &m, &unfit, &reached, err);
  if (!status && unfit != CAG_ROLL_NONE) status = fail_unfit(&r, unfit, limit, err);
  if (!status) status = cag_solid_from_mesh(m, out, err);
  if (within) *within = reached;
  cag_mesh_release(m);
  cag_mesh_release(r.mesh);
  cag_roll_parts_free(r.parts, r.part_count);
  return status;
}

CagStatus cag_solid_roll(const CagSolid *s, const CagRolledEdge *edges, size_t n, double tolerance,
                         CagRollLimit *limit, double *within, CagSolid **out, CagError *err) {
  return round_edges(s, edges, n, false, tolerance, limit, within, out, err);
}

CagStatus cag_solid_bevel(const CagSolid *s, const CagRolledEdge *edges, size_t n, double tolerance,
                          CagRollLimit *limit, double *within, CagSolid **out, CagError *err) {
  return round_edges(s, edges, n, true, tolerance, limit, within, out, err);
}
