// Bodies of rounded edges (see roll_apply.h).

#include "geom/solid/roll_apply.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/boolean/boolean.h"
#include "geom/mesh/distance.h"
#include "geom/solid/roll_body.h"
#include "geom/solid/roll_shells.h"
#include "geom/solid/roll_zone.h"

// Bodies reach beyond the faces by this fraction of the size of a section, and by this multiple of
// the tolerance and of the bulge of faces.
#define LIFT_SIZE 2e-3
#define LIFT_TOLERANCE 2
#define LIFT_BULGE 2
// A face that the direction of an edge meets with a smaller sine continues the edge smoothly.
#define GRAZING 1e-3
// Steps of Newton's method toward a face along a line.
#define STEPS 60
// Points of the result may be off by the tolerance of the mesh and that of the sections.
#define NEAR 2
// The volume may be off by this fraction of itself because of rounding.
#define VOLUME 1e-9

bool cag_roll_is_near(const CagMesh *m, CagVec3 p, double most) {
  for (size_t i = 0; i < m->triangle_count; i++) {
    const uint32_t *t = m->triangles + 3 * i;
    const CagVec3 a = m->positions[t[0]], b = m->positions[t[1]], c = m->positions[t[2]];
    if (fmin(a.x, fmin(b.x, c.x)) > p.x + most || fmax(a.x, fmax(b.x, c.x)) < p.x - most ||
        fmin(a.y, fmin(b.y, c.y)) > p.y + most || fmax(a.y, fmax(b.y, c.y)) < p.y - most ||
        fmin(a.z, fmin(b.z, c.z)) > p.z + most || fmax(a.z, fmax(b.z, c.z)) < p.z - most)
      continue;
    if (cag_distance_to_triangle(p, a, b, c) <= most) return true;
  }
  return false;
}

// --- Tests ---

// The middle of the arc, or of a chamfer.
static CagVec3 section_middle(const CagRollSection *s) {
  if (!(s->radius > 0)) return cag_lerp(s->contact[0], s->contact[1], 0.5);
  return cag_madd(s->center, -s->radius, cag_unit(cag_add(s->toward[0], s->toward[1])));
}

// The section of an edge between its stations.
static CagStatus section_within(CagRollPlan *p, size_t pick, double part, CagRollSection *out,
                                CagError *err) {
  const CagRollPick *e = &p->picks[pick];
  bool fits;
  CagStatus status = cag_roll_section(&e->e, e->station[0] + part * (e->station[1] - e->station[0]),
                                      out, &fits, err);
  if (!status && !fits) p->unfit = pick;
  return status;
}

CagStatus cag_roll_contacts(CagRollPlan *p, const CagMesh *solid, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = 0; i < p->pick_count && p->unfit == CAG_ROLL_NONE; i++)
    for (int k = 1; !status && k < 4 && !p->picks[i].zoned; k++) {
      CagRollSection s;
      status = cag_stop_check(err);
      if (!status) status = section_within(p, i, k / 4.0, &s, err);
      if (status || p->unfit != CAG_ROLL_NONE) return status;
      for (int j = 0; j < 2; j++)
        if (!cag_roll_is_near(solid, s.contact[j], NEAR * p->tolerance)) p->unfit = i;
    }
  return status;
}

// Whether the result passes through the contacts and the arc at a fraction of an edge.
static CagStatus passes_section(CagRollPlan *p, size_t pick, double part, const CagMesh *result,
                                bool *out, CagError *err) {
  CagRollSection s;
  CagStatus status = cag_stop_check(err);
  *out = false;
  if (!status) status = section_within(p, pick, part, &s, err);
  if (status || p->unfit != CAG_ROLL_NONE) return status;
  const CagVec3 points[3] = {s.contact[0], s.contact[1], section_middle(&s)};
  *out = true;
  for (int k = 0; *out && k < 3; k++)
    *out = cag_roll_is_near(result, points[k], NEAR * p->tolerance);
  return CAG_OK;
}

// The rounding of another edge may reach that of an edge, but not everywhere.
static CagStatus check_middles(CagRollPlan *p, const CagMesh *result, CagError *err) {
  static const double PARTS[] = {0.5, 0.25, 0.75};
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < p->pick_count && p->unfit == CAG_ROLL_NONE; i++) {
    bool passes = p->picks[i].zoned;
    for (int k = 0; !status && !passes && k < 3 && p->unfit == CAG_ROLL_NONE; k++)
      status = passes_section(p, i, PARTS[k], result, &passes, err);
    if (!status && !passes) p->unfit = i;
  }
  return status;
}

// --- The ends of chains ---

// How far the line from `from` along a unit vector is from the face; the tangent plane at the
// parameters uv is near the face there.
static CagStatus distance_along(const CagRollSide *side, const double uv[2], CagVec3 from,
                                CagVec3 along, double *out, CagError *err) {
  double at[2] = {uv[0], uv[1]}, s = 0;
  CagStatus status = CAG_OK;
  for (int k = 0; !status && k < STEPS; k++) {
    CagVec3 foot, normal;
    status = cag_roll_foot(side, cag_madd(from, s, along), at, &foot, &normal, err);
    if (status) break;
    const double slope = cag_dot(normal, along);
    if (fabs(slope) < GRAZING) break;
    const double step = cag_dot(cag_sub(foot, cag_madd(from, s, along)), normal) / slope;
    s += step;
    if (fabs(step) <= 1e-14 * (cag_norm(from) + fabs(s))) break;
  }
  *out = s;
  return status;
}

// The faces at the end of a chain on which its body ends, or through which it leaves the solid.
typedef struct Stops {
  CagRollMeeting faces[2 * CAG_ROLL_VALENCE];
  double slope[2 * CAG_ROLL_VALENCE]; // of the face against the edge: positive if the body leaves
  size_t count;
  bool flush; // the body ends on the faces with negative slopes
} Stops;

static CagStatus find_stops(const CagRollPlan *p, CagRollTip tip, CagVec3 leaving, Stops *out,
                            CagError *err) {
  const CagRollPick *pick = &p->picks[tip.pick];
  CagRollMeeting met[2 * CAG_ROLL_VALENCE];
  size_t n;
  *out = (Stops){0};
  CagStatus status = cag_roll_meetings(&p->parts[pick->part], pick->corner[tip.end], met,
                                       2 * CAG_ROLL_VALENCE, &n, err);
  for (size_t i = 0; !status && i < n && i < 2 * CAG_ROLL_VALENCE; i++) {
    CagVec3 normal;
    if (met[i].side.face == pick->e.sides[0].face || met[i].side.face == pick->e.sides[1].face)
      continue;
    status = cag_carrier_normal(met[i].side.carrier, met[i].uv[0], met[i].uv[1], &normal, err);
    if (status) break;
    const double slope = met[i].side.outward * cag_dot(normal, leaving) * (pick->e.convex ? 1 : -1);
    if (fabs(slope) < GRAZING) continue;
    out->faces[out->count] = met[i];
    out->slope[out->count++] = slope;
    out->flush = out->flush || slope < 0;
  }
  return status;
}

// Moves the points of the last ring along the edge: to the faces on which the body ends, or beyond
// those through which it leaves. *fits: whether the ring stays beyond the one before it, and
// does not cross itself.
static CagStatus end_ring(const CagRollPlan *p, CagRollTip tip, double lift, CagVec3 *ring,
                          const CagVec3 *before, size_t size, bool *fits, CagError *err) {
  CagVec3 leaving;
  Stops stops;
  CagStatus status = cag_roll_leaving(&p->picks[tip.pick], tip.end, &leaving, err);
  if (!status) status = find_stops(p, tip, leaving, &stops, err);
  for (size_t i = 0; !status && *fits && i < size; i++) {
    double move = stops.flush ? INFINITY : 0;
    for (size_t k = 0; !status && k < stops.count; k++) {
      double s;
      if (stops.flush && stops.slope[k] > 0) continue;
      status = distance_along(&stops.faces[k].side, stops.faces[k].uv, ring[i], leaving, &s, err);
      if (status) break;
      move = stops.flush ? fmin(move, s) : fmax(move, s + lift / stops.slope[k]);
    }
    if (!status) ring[i] = cag_madd(ring[i], move, leaving);
    *fits = *fits && cag_dot(cag_sub(ring[i], before[i]), leaving) > 0;
  }
  return status || !*fits ? status : cag_roll_ring_is_simple(ring, size, fits, err);
}

// --- Bodies ---

typedef struct Bodies {
  CagMesh **meshes;
  bool *convex;
  size_t *level;
  size_t count;
  double removed, added; // volumes
} Bodies;

static void bodies_free(Bodies *b) {
  for (size_t i = 0; i < b->count; i++) cag_mesh_release(b->meshes[i]);
  cag_free(b->meshes);
  cag_free(b->convex);
  cag_free(b->level);
}

static double mesh_volume(const CagMesh *m) {
  double terms[10] = {0};
  cag_mesh_volume_terms(m, terms);
  return terms[0];
}

static void add_body(Bodies *b, CagMesh *m, bool convex, size_t level) {
  *(convex ? &b->removed : &b->added) += fabs(mesh_volume(m));
  b->convex[b->count] = convex;
  b->level[b->count] = level;
  b->meshes[b->count++] = m;
}

// The number of parts of all arcs, and how far bodies reach beyond the faces.
static size_t common_arc(const CagRollPlan *p, double *lift) {
  size_t arc = 1;
  double size = 0, bulge = 0;
  for (size_t i = 0; i < p->section_count; i++) {
    const CagRollSection *s = &p->sections[i];
    bulge = fmax(bulge, s->bulge);
    for (int k = 0; k < 2; k++) size = fmax(size, cag_norm(cag_sub(s->contact[k], s->edge)));
    if (!(s->radius > 0)) continue;
    const double angle = acos(fmin(1, fmax(-1, cag_dot(s->toward[0], s->toward[1]))));
    const size_t own = cag_roll_arc(s->radius, angle, p->tolerance);
    if (own > arc) arc = own;
  }
  *lift = LIFT_SIZE * size + LIFT_TOLERANCE * p->tolerance + LIFT_BULGE * bulge;
  return arc;
}

// Ends the rings of a chain on one side. Rings that the end would pass are left out.
static CagStatus end_rings(const CagRollPlan *p, CagRollTip tip, int end, double lift,
                           CagVec3 *rings, size_t size, size_t *first, size_t *count, bool *fits,
                           CagError *err) {
  const size_t bytes = size * sizeof *rings, whole = *count, start = *first;
  CagVec3 *own = cag_malloc(bytes + sizeof *own);
  CagStatus status = CAG_OK;
  if (!own) return cag_fail_memory(err);
  memcpy(own, rings + size * (end ? *first + *count - 1 : *first), bytes);
  for (*fits = false; !status && !*fits && *count >= 2;) {
    CagVec3 *last = rings + size * (end ? *first + *count - 1 : *first);
    memcpy(last, own, bytes);
    *fits = true;
    status = end_ring(p, tip, lift, last, end ? last - size : last + size, size, fits, err);
    if (status || *fits) break;
    --*count;
    if (!end) ++*first;
  }
  if (!status && !*fits) { // the body ends where the edge does
    *first = start;
    *count = whole;
    memcpy(rings + size * (end ? *first + *count - 1 : *first), own, bytes);
    *fits = true;
  }
  cag_free(own);
  return status;
}

static CagStatus chain_body(CagRollPlan *p, const CagRollChain *c, size_t arc, double lift,
                            Bodies *out, CagError *err) {
  const size_t size = CAG_ROLL_RING(arc);
  CagVec3 *rings = cag_calloc(size * c->count + 1, sizeof *rings);
  CagStatus status = rings ? CAG_OK : cag_fail_memory(err);
  CagMesh *m;
  bool fits = true;
  size_t first = 0, count = c->count;
  for (size_t i = 0; rings && i < c->count; i++)
    cag_roll_ring(&p->sections[c->first + i], arc, lift, rings + size * i);
  for (int k = 0; !status && fits && !c->closed && k < 2; k++) {
    if (p->picks[c->tips[k].pick].ball[c->tips[k].end]) continue;
    status = end_rings(p, c->tips[k], k, lift, rings, size, &first, &count, &fits, err);
  }
  if (!status && !fits) p->unfit = c->tips[0].pick;
  if (!status && fits)
    status = cag_roll_sweep(rings + size * first, size, count, c->closed, &m, err);
  if (!status && fits) add_body(out, m, p->picks[c->tips[0].pick].e.convex, c->level);
  cag_free(rings);
  return status;
}

static CagStatus ball_body(const CagRollPlan *p, const CagRollBall *b, size_t arc, double lift,
                           Bodies *out, CagError *err) {
  const CagRollCorner corner = {.point = b->point,
                                .center = b->center,
                                .radius = b->radius,
                                .count = b->count,
                                .contact = b->contact,
                                .toward = b->toward,
                                .at_point = b->at_point,
                                .station = b->station,
                                .before = b->before,
                                .after = b->after};
  CagMesh *m;
  CagStatus status = cag_roll_corner_body(&corner, arc, lift, &m, err);
  if (!status) add_body(out, m, b->convex, p->chains[p->picks[b->pick].chain].level);
  return status;
}

static CagStatus all_bodies(CagRollPlan *p, Bodies *out, CagError *err) {
  double lift;
  const size_t arc = common_arc(p, &lift), most = p->chain_count + p->ball_count;
  *out = (Bodies){.meshes = cag_calloc(most + 1, sizeof(CagMesh *)),
                  .convex = cag_calloc(most + 1, sizeof(bool)),
                  .level = cag_calloc(most + 1, sizeof(size_t))};
  CagStatus status = out->meshes && out->convex && out->level ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < p->chain_count && p->unfit == CAG_ROLL_NONE; i++) {
    status = cag_stop_check(err);
    if (!status) status = chain_body(p, &p->chains[i], arc, lift, out, err);
  }
  for (size_t i = 0; !status && i < p->ball_count && p->unfit == CAG_ROLL_NONE; i++)
    status = ball_body(p, &p->balls[i], arc, lift, out, err);
  for (size_t i = 0; i < p->zone_count; i++)
    *(p->zones[i].convex ? &out->removed : &out->added) += p->zones[i].most;
  return status;
}

// Removes the convex bodies of a level, or adds the others. Releases *mesh if it is replaced.
static CagStatus combine_bodies(const Bodies *b, size_t level, bool convex, CagMesh **mesh,
                                size_t *done, CagError *err) {
  const CagMesh **operands = cag_calloc(b->count + 1, sizeof *operands);
  size_t n = 0;
  CagMesh *next;
  if (!operands) return cag_fail_memory(err);
  operands[n++] = *mesh;
  for (size_t i = 0; i < b->count; i++)
    if (b->convex[i] == convex && b->level[i] == level) operands[n++] = b->meshes[i];
  *done += n - 1;
  CagStatus status = CAG_OK;
  if (n > 1)
    status =
        cag_mesh_boolean_many(convex ? CAG_DIFFERENCE : CAG_UNION, operands, n, NULL, &next, err);
  if (!status && n > 1) {
    cag_mesh_release(*mesh);
    *mesh = next;
  }
  cag_free(operands);
  return status;
}

static CagStatus check_watertight(const CagMesh *m, CagError *err) {
  bool watertight;
  CagVec3 edge[2];
  CagStatus status = cag_mesh_watertight(m, &watertight, edge, err);
  if (status || watertight) return status;
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_no_boundary, "", -1,
                  "the mesh of the rounded solid is open at [%.6g, %.6g, %.6g]", edge[0].x,
                  edge[0].y, edge[0].z);
}

static CagStatus check_volume(const Bodies *b, const CagMesh *before, const CagMesh *after,
                              CagError *err) {
  const double from = mesh_volume(before), to = mesh_volume(after), slack = VOLUME * fabs(from);
  if (to >= from - b->removed - slack && to <= from + b->added + slack) return CAG_OK;
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_no_boundary, "", -1,
                  "rounding changes the volume from %.9g to %.9g, which cannot be", from, to);
}

// Rounds within all zones: at concave edges first, so that a ball rolls over their fillets.
static CagStatus apply_zones(CagRollPlan *p, CagMesh **mesh, CagError *err) {
  CagStatus status = CAG_OK;
  for (int convex = 0; convex < 2; convex++)
    for (size_t i = 0; !status && i < p->zone_count && p->unfit == CAG_ROLL_NONE; i++) {
      const CagRollZone *z = &p->zones[i];
      bool fits = true;
      if (z->convex != (convex == 1)) continue;
      status = cag_stop_check(err);
      if (!status) status = cag_roll_apply_zone(z, p->tolerance, mesh, &fits, err);
      if (!status && !fits) p->unfit = z->pick;
    }
  return status;
}

// Applies the bodies level by level, then the zones. Replaces *mesh.
static CagStatus apply_bodies(CagRollPlan *p, const Bodies *b, CagMesh **mesh, CagError *err) {
  CagMesh *solid = cag_mesh_retain(*mesh);
  CagMesh *clean;
  CagStatus status = CAG_OK;
  for (size_t level = 0, done = 0; !status && done < b->count; level++)
    for (int k = 0; !status && k < 2; k++)
      status = combine_bodies(b, level, k == 0, mesh, &done, err);
  if (!status) status = apply_zones(p, mesh, err);
  if (!status && p->unfit == CAG_ROLL_NONE) status = check_volume(b, solid, *mesh, err);
  if (!status) status = cag_roll_drop_thin_shells(*mesh, p->tolerance, &clean, err);
  if (!status) {
    cag_mesh_release(*mesh);
    *mesh = clean;
    status = check_watertight(*mesh, err);
  }
  cag_mesh_release(solid);
  return status;
}

CagStatus cag_roll_apply(CagRollPlan *p, const CagMesh *solid, CagMesh **out, CagError *err) {
  Bodies b;
  CagMesh *m = cag_mesh_retain(solid);
  CagStatus status = all_bodies(p, &b, err);
  if (!status && p->unfit == CAG_ROLL_NONE) status = apply_bodies(p, &b, &m, err);
  if (!status && p->unfit == CAG_ROLL_NONE) status = check_middles(p, m, err);
  bodies_free(&b);
  if (status || p->unfit != CAG_ROLL_NONE) cag_mesh_release(m);
  else *out = m;
  return status;
}
