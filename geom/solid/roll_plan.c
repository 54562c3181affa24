// Chains of edges to be rounded (see roll_plan.h).

#include "geom/solid/roll_plan.h"

#include <math.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/linalg/tolerance.h"
#include "geom/solid/roll_corner.h"
#include "geom/solid/roll_pivot.h"

// Edges continue each other smoothly if their tangents differ by less, in radians.
#define SMOOTH_JOINT 1e-2
// Halvings of the parameters between neighboring sections.
#define HALVINGS 12
// The largest turn of the tangent between neighboring sections, in radians.
#define TURN (M_PI / 15)
// Sections of all chains.
#define SECTIONS_MOST 200000

void cag_roll_plan_free(CagRollPlan *p) {
  cag_free(p->picks);
  cag_free(p->sections);
  cag_free(p->chains);
  cag_free(p->balls);
  cag_free(p->pivots);
  cag_free(p->zones);
  *p = (CagRollPlan){0};
}

CagStatus cag_roll_leaving(const CagRollPick *p, int end, CagVec3 *out, CagError *err) {
  const CagCurve *c = p->e.curve;
  CagStatus status =
      cag_curve_tangent(c, end ? c->end : c->start, end ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, out, err);
  if (!status && !end) *out = cag_scaled(*out, -1);
  return status;
}

// --- Sections ---

static CagStatus section_at(CagRollPlan *p, size_t pick, double t, CagRollSection *out,
                            CagError *err) {
  bool fits;
  CagStatus status = cag_roll_section(&p->picks[pick].e, t, out, &fits, err);
  out->origin = pick;
  if (!status && !fits && p->unfit == CAG_ROLL_NONE) p->unfit = pick;
  return status;
}

static CagStatus add_section(CagRollPlan *p, const CagRollSection *s, CagError *err) {
  if (p->section_count >= SECTIONS_MOST)
    return cag_fail(err, CAG_E_LIMIT, CAG_ERR_no_boundary, "", -1,
                    "the edges need too many sections for the tolerance");
  if (!CAG_RESERVE(p->sections, p->section_room, p->section_count + 1)) return cag_fail_memory(err);
  p->sections[p->section_count++] = *s;
  return CAG_OK;
}

// Whether straight lines between two sections miss a third one, halfway, by less than the
// tolerance.
static bool is_straight(const CagRollSection *a, const CagRollSection *b, const CagRollSection *m,
                        double tolerance) {
  double off = cag_norm(cag_sub(m->edge, cag_lerp(a->edge, b->edge, 0.5)));
  for (int k = 0; k < 2; k++)
    off = fmax(off, cag_norm(cag_sub(m->contact[k], cag_lerp(a->contact[k], b->contact[k], 0.5))));
  if (m->radius > 0) {
    // The middles of the arcs.
    CagVec3 p[3];
    const CagRollSection *const all[3] = {a, b, m};
    for (int i = 0; i < 3; i++)
      p[i] = cag_madd(all[i]->center, -all[i]->radius,
                      cag_unit(cag_add(all[i]->toward[0], all[i]->toward[1])));
    off = fmax(off, cag_norm(cag_sub(p[2], cag_lerp(p[0], p[1], 0.5))));
  }
  return off <= tolerance && cag_dot(a->along, b->along) >= cos(TURN);
}

// Adds the sections after t0 up to t1, whose sections are a and b, in the order of the curve.
static CagStatus add_between(CagRollPlan *p, double t0, double t1, const CagRollSection *a,
                             const CagRollSection *b, int depth, CagError *err) {
  CagRollSection middle;
  const double t = t0 + (t1 - t0) / 2;
  CagStatus status = cag_stop_check(err);
  if (!status) status = section_at(p, a->origin, t, &middle, err);
  if (status || p->unfit != CAG_ROLL_NONE) return status;
  if (depth == 0 || is_straight(a, b, &middle, p->tolerance)) return add_section(p, b, err);
  status = add_between(p, t0, t, a, &middle, depth - 1, err);
  if (!status && p->unfit == CAG_ROLL_NONE)
    status = add_between(p, t, t1, &middle, b, depth - 1, err);
  return status;
}

// The parameters at which sections must be: the ends, stations, and breaks of the curve; a closed
// curve is divided, so that its halves are not taken for straight.
#define STOPS_MOST 256
static CagStatus pick_stops(const CagRollPick *pick, double stops[STOPS_MOST], size_t *count,
                            CagError *err) {
  const CagCurve *c = pick->e.curve;
  double found[STOPS_MOST];
  size_t n = 0, m = 0;
  found[n++] = pick->range[0];
  for (int k = 0; k < 2; k++)
    if (pick->ball[k]) found[n++] = pick->station[k];
  const size_t breaks = c->kind->breaks ? c->kind->breaks(c, found + n, STOPS_MOST - 16) : 0;
  n += breaks < STOPS_MOST - 16 ? breaks : STOPS_MOST - 16;
  bool line;
  CagStatus status = cag_curve_is_straight(c, &line, err);
  if (status) return status;
  for (int k = 1; !line && k < 4; k++)
    found[n++] = pick->range[0] + (pick->range[1] - pick->range[0]) * k / 4.0;
  found[n++] = pick->range[1];
  for (size_t i = 1; i < n; i++)
    for (size_t k = i; k > 0 && found[k - 1] > found[k]; k--) {
      const double t = found[k];
      found[k] = found[k - 1];
      found[k - 1] = t;
    }
  const double near = CAG_COINCIDENT * (c->end - c->start);
  for (size_t i = 0; i < n; i++)
    if (found[i] >= pick->range[0] && found[i] <= pick->range[1] &&
        (m == 0 || found[i] > stops[m - 1] + near))
      stops[m++] = found[i];
  *count = m;
  return CAG_OK;
}

// Turns the sections around, as for an edge that is followed from its end.
static void reverse_sections(CagRollSection *s, size_t n) {
  for (size_t i = 0; i < n / 2; i++) {
    const CagRollSection other = s[i];
    s[i] = s[n - 1 - i];
    s[n - 1 - i] = other;
  }
  for (size_t i = 0; i < n; i++) {
    CagVec3 *const pairs[3] = {s[i].contact, s[i].toward, s[i].start};
    for (int k = 0; k < 3; k++) {
      const CagVec3 first = pairs[k][0];
      pairs[k][0] = pairs[k][1];
      pairs[k][1] = first;
    }
    s[i].along = cag_scaled(s[i].along, -1);
  }
}

// Adds the sections of an edge, without the first one if it continues the one before.
static CagStatus add_edge_sections(CagRollPlan *p, size_t pick, bool reversed, bool continues,
                                   CagError *err) {
  double stops[STOPS_MOST];
  const size_t first = p->section_count;
  size_t n;
  CagRollSection last;
  CagStatus status = pick_stops(&p->picks[pick], stops, &n, err);
  if (!status) status = section_at(p, pick, stops[0], &last, err);
  if (!status && p->unfit == CAG_ROLL_NONE) status = add_section(p, &last, err);
  for (size_t i = 1; !status && p->unfit == CAG_ROLL_NONE && i < n; i++) {
    CagRollSection next;
    status = section_at(p, pick, stops[i], &next, err);
    if (!status && p->unfit == CAG_ROLL_NONE)
      status = add_between(p, stops[i - 1], stops[i], &last, &next, HALVINGS, err);
    last = next;
  }
  if (status || p->unfit != CAG_ROLL_NONE) return status;
  if (reversed) reverse_sections(p->sections + first, p->section_count - first);
  if (!continues) return CAG_OK;
  p->section_count--;
  memmove(p->sections + first, p->sections + first + 1,
          (p->section_count - first) * sizeof *p->sections);
  return CAG_OK;
}

// --- Chains ---

// A tip that follows another one in a chain.
typedef struct Link {
  CagRollTip tip;
  const CagRollPivot *pivot; // between them; NULL: they continue each other smoothly
  bool found;
} Link;

// The end of an edge that continues another one beyond its end.
static CagStatus continuation(const CagRollPlan *p, CagRollTip tip, Link *out, CagError *err) {
  const CagRollPick *from = &p->picks[tip.pick];
  CagVec3 leaving, other;
  *out = (Link){{0, 0}, NULL, false};
  if (from->ball[tip.end] || from->closed) return CAG_OK;
  if (from->pivot[tip.end]) {
    const CagRollPivot *v = &p->pivots[from->pivot[tip.end] - 1];
    const bool first = v->tips[0].pick == tip.pick && v->tips[0].end == tip.end;
    *out = (Link){v->tips[first ? 1 : 0], v, true};
    return CAG_OK;
  }
  CagStatus status = cag_roll_leaving(from, tip.end, &leaving, err);
  for (size_t i = 0; !status && i < p->pick_count; i++) {
    const CagRollPick *to = &p->picks[i];
    if (to->part != from->part || to->e.convex != from->e.convex || to->closed) continue;
    for (int end = 0; !status && end < 2; end++) {
      if (to->corner[end] != from->corner[tip.end] || (i == tip.pick && end == tip.end)) continue;
      status = cag_roll_leaving(to, end, &other, err);
      if (status || cag_norm(cag_add(leaving, other)) > SMOOTH_JOINT) continue;
      *out = (Link){{i, end}, NULL, true};
      return CAG_OK;
    }
  }
  return status;
}

// Follows the chain of a pick backward to its first edge, or once around.
static CagStatus chain_start(const CagRollPlan *p, size_t pick, CagRollTip *out, bool *closed,
                             CagError *err) {
  CagRollTip tip = {pick, 0};
  CagStatus status = CAG_OK;
  *closed = p->picks[pick].closed;
  for (size_t i = 0; !*closed && i <= p->pick_count; i++) {
    Link before;
    status = continuation(p, tip, &before, err);
    if (status || !before.found) break;
    tip = (CagRollTip){before.tip.pick, 1 - before.tip.end};
    *closed = tip.pick == pick && tip.end == 0;
  }
  *out = tip;
  return status;
}

static int pivot_end(const CagRollPivot *v, CagRollTip tip) {
  return v->tips[0].pick == tip.pick && v->tips[0].end == tip.end ? 0 : 1;
}

// Whether the turn's first or last section takes the place of that of the edge, since it reaches
// beyond the third edge of the corner, within both faces there.
static bool pivot_replaces(const CagRollPivot *v, CagRollTip tip) {
  return v && !v->flat && !(v->inner > 0) && !v->beyond[pivot_end(v, tip)];
}

// Adds the sections of the turn that follows the end of an edge, without those of the edges.
static CagStatus add_pivot_sections(CagRollPlan *p, const CagRollPivot *v, CagRollTip tip,
                                    CagError *err) {
  const size_t parts = cag_roll_pivot_parts(p, v);
  const int end = pivot_end(v, tip);
  const bool own = !v->flat && !(v->inner > 0);
  CagStatus status = CAG_OK;
  if (pivot_replaces(v, tip)) p->section_count--;
  for (size_t i = 0; !status && i <= parts; i++) {
    CagRollSection s;
    if (v->flat && 2 * i != parts) continue;
    if (i == 0 && !v->beyond[end] && !own) continue;
    if (i == parts && !v->beyond[1 - end] && !own) continue;
    bool fits;
    status = cag_roll_pivot_section(v, tip, (double)i / (double)parts, &s, &fits, err);
    if (!status && !fits) p->unfit = tip.pick;
    if (status || !fits) break;
    status = add_section(p, &s, err);
  }
  return status;
}

// The last section of a closed chain is the first one, unless a turn is between them.
static void close_chain(CagRollPlan *p, const CagRollChain *chain, const Link *last) {
  if (last->found && last->pivot && !pivot_replaces(last->pivot, last->tip)) return;
  p->section_count--;
  if (last->found && last->pivot)
    memmove(p->sections + chain->first, p->sections + chain->first + 1,
            (p->section_count - chain->first) * sizeof *p->sections);
}

static CagStatus add_chain(CagRollPlan *p, size_t pick, CagError *err) {
  CagRollTip tip;
  bool closed;
  Link link = {{0, 0}, NULL, false};
  CagStatus status = chain_start(p, pick, &tip, &closed, err);
  if (status) return status;
  CagRollChain *chain = &p->chains[p->chain_count];
  *chain = (CagRollChain){.first = p->section_count, .closed = closed, .tips = {tip, tip}};
  for (;;) {
    CagRollPick *here = &p->picks[tip.pick];
    here->used = true;
    here->chain = p->chain_count;
    status = add_edge_sections(p, tip.pick, tip.end == 1,
                               link.found && (!link.pivot || pivot_replaces(link.pivot, tip)), err);
    tip.end = 1 - tip.end;
    chain->tips[1] = tip;
    link.found = false;
    if (status || p->unfit != CAG_ROLL_NONE || here->closed) break;
    status = continuation(p, tip, &link, err);
    if (!status && link.found && link.pivot) status = add_pivot_sections(p, link.pivot, tip, err);
    if (status || !link.found || p->picks[link.tip.pick].used) break;
    tip = link.tip;
  }
  if (!status && closed && p->unfit == CAG_ROLL_NONE) close_chain(p, chain, &link);
  chain->count = p->section_count - chain->first;
  p->chain_count++;
  return status;
}

// The fillets about which a ball turns come before its own chain.
static CagStatus order_chains(CagRollPlan *p, CagError *err) {
  bool changed = true;
  for (size_t round = 0; changed; round++) {
    changed = false;
    if (round > p->chain_count)
      return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_no_boundary, "", -1,
                      "convex and concave edges that are rounded depend on each other");
    for (size_t i = 0; i < p->pivot_count; i++) {
      const CagRollPivot *v = &p->pivots[i];
      if (v->third == CAG_ROLL_NONE) continue;
      CagRollChain *chain = &p->chains[p->picks[v->tips[0].pick].chain];
      const size_t before = p->chains[p->picks[v->third].chain].level;
      if (chain->level > before) continue;
      chain->level = before + 1;
      changed = true;
    }
  }
  return CAG_OK;
}

static CagStatus start_pick(CagRollPick *pick, CagError *err) {
  const CagCurve *c = pick->e.curve;
  CagVec3 leaving[2];
  CagStatus status = CAG_OK;
  pick->used = pick->zoned = false;
  for (int k = 0; !status && k < 2; k++) {
    pick->ball[k] = false;
    pick->pivot[k] = 0;
    pick->range[k] = pick->station[k] = k ? c->end : c->start;
    status = cag_roll_leaving(pick, k, &leaving[k], err);
  }
  if (!status)
    pick->closed = pick->corner[0] == pick->corner[1] &&
                   cag_norm(cag_add(leaving[0], leaving[1])) <= SMOOTH_JOINT;
  return status;
}

CagStatus cag_roll_plan(const CagRollPart *parts, size_t part_count, double tolerance,
                        CagRollCorners corners, CagRollPick *picks, size_t n, CagRollPlan *out,
                        CagError *err) {
  CagRollPlan p = {.parts = parts, .part_count = part_count, .tolerance = tolerance};
  CagStatus status = CAG_OK;
  p.picks = picks;
  p.corners = corners;
  p.pick_count = n;
  p.unfit = CAG_ROLL_NONE;
  p.chains = cag_calloc(n + 1, sizeof *p.chains);
  if (!p.chains) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++) status = start_pick(&p.picks[i], err);
  if (!status) status = cag_roll_balls(&p, err);
  for (size_t i = 0; !status && p.unfit == CAG_ROLL_NONE && i < n; i++)
    if (!p.picks[i].used && !p.picks[i].zoned) status = add_chain(&p, i, err);
  if (!status && p.unfit == CAG_ROLL_NONE) status = order_chains(&p, err);
  if (status) cag_roll_plan_free(&p);
  else *out = p;
  return status;
}
