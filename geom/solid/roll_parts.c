// Boundaries of a solid with the faces at their edges (see roll_parts.h).

#include "geom/solid/roll_parts.h"

#include <math.h>
#include <stdint.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/boundary/moved.h"
#include "geom/solid/exact.h"

// Faces meet smoothly if their normals differ by less, in radians (as in features.h).
#define SMOOTH 1e-4

void cag_roll_parts_free(CagRollPart *parts, size_t n) {
  for (size_t i = 0; i < n; i++) {
    cag_boundary_free(&parts[i].moved);
    cag_free(parts[i].face_of);
    cag_free(parts[i].use_of);
    cag_free(parts[i].bends);
  }
  cag_free(parts);
}

static CagStatus sort_uses(CagRollPart *p, CagError *err) {
  const CagBoundary *b = p->b;
  p->face_of = cag_calloc(b->use_count + 1, sizeof *p->face_of);
  p->use_of = cag_calloc(2 * b->edge_count + 1, sizeof *p->use_of);
  p->bends = cag_calloc(b->edge_count + 1, sizeof *p->bends);
  if (!p->face_of || !p->use_of || !p->bends) return cag_fail_memory(err);
  for (size_t i = 0; i < 2 * b->edge_count; i++) p->use_of[i] = CAG_ROLL_NONE;
  for (size_t f = 0; f < b->face_count; f++)
    for (size_t l = b->faces[f].first; l < b->faces[f].first + b->faces[f].count; l++)
      for (size_t u = b->loops[l].first; u < b->loops[l].first + b->loops[l].count; u++) {
        p->face_of[u] = f;
        p->use_of[2 * b->uses[u].edge + (b->uses[u].reversed ? 1 : 0)] = u;
      }
  return CAG_OK;
}

static CagStatus side_of_use(const CagRollPart *p, size_t use, CagRollSide *out, CagError *err) {
  const CagBoundaryFace *f = &p->b->faces[p->face_of[use]];
  *out = (CagRollSide){.face = p->face_of[use], .carrier = &f->carrier};
  out->outward = f->reversed ? -1 : 1;
  return cag_edge_path(p->b, f, &p->b->uses[use], &out->path, err);
}

CagStatus cag_roll_edge(const CagRollPart *p, size_t edge, CagRollEdge *out, CagError *err) {
  *out = (CagRollEdge){.curve = p->b->edges[edge].curve};
  out->convex = p->bends[edge] == CAG_ROLL_CONVEX;
  CagStatus status = CAG_OK;
  for (int k = 0; !status && k < 2; k++)
    status = side_of_use(p, p->use_of[2 * edge + (size_t)k], &out->sides[k], err);
  return status;
}

// Whether an edge is sharp, at the middle of its curve.
static CagStatus find_bend(CagRollPart *p, size_t e, CagError *err) {
  const CagCurve *c = p->b->edges[e].curve;
  CagVec3 along, normal[2];
  double uv[2];
  if (!c || p->use_of[2 * e] == CAG_ROLL_NONE || p->use_of[2 * e + 1] == CAG_ROLL_NONE)
    return CAG_OK;
  const double middle = c->start + (c->end - c->start) / 2;
  CagStatus status = cag_curve_tangent(c, middle, CAG_SIDE_RIGHT, &along, err);
  for (int k = 0; !status && k < 2; k++) {
    CagRollSide side;
    status = side_of_use(p, p->use_of[2 * e + (size_t)k], &side, err);
    if (!status) status = cag_edge_path_eval(&side.path, middle, uv, NULL, err);
    if (!status) status = cag_carrier_normal(side.carrier, uv[0], uv[1], &normal[k], err);
    if (!status) normal[k] = cag_scaled(normal[k], side.outward);
  }
  if (status) return status;
  const double turn = cag_dot(cag_cross(normal[0], normal[1]), along);
  const double angle = atan2(turn, cag_dot(normal[0], normal[1]));
  // The normals turn by the angle from the left face to the right one, about the direction of the
  // edge: counter-clockwise if the edge is convex.
  if (fabs(angle) < SMOOTH) return CAG_OK;
  p->bends[e] = angle > 0 ? CAG_ROLL_CONVEX : CAG_ROLL_CONCAVE;
  return CAG_OK;
}

static CagStatus part_new(const CagBoundary *b, const CagTransform *placement, bool stays,
                          CagRollPart *p, CagError *err) {
  CagStatus status = CAG_OK;
  p->b = b;
  if (!stays) {
    status = cag_boundary_moved(b, placement, &p->moved, err);
    p->b = &p->moved;
  }
  if (!status) status = sort_uses(p, err);
  for (size_t e = 0; !status && e < p->b->edge_count; e++) {
    status = cag_stop_check(err);
    if (!status) status = find_bend(p, e, err);
  }
  return status;
}

static bool is_identity(const CagTransform *t) {
  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 4; k++)
      if (t->m[i][k] != (i == k ? 1 : 0)) return false;
  return true;
}

CagStatus cag_roll_parts(const CagSolid *s, CagRollPart **out, size_t *n, CagError *err) {
  size_t count;
  const CagBoundary *b = cag_solid_boundaries(s, &count);
  if (!b)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_no_boundary, "", -1,
                    "the edges of %s %s are not known", cag_article(cag_solid_kind_name(s->kind)),
                    cag_solid_kind_name(s->kind));
  CagRollPart *parts = cag_calloc(count + 1, sizeof *parts);
  if (!parts) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < count; i++)
    status = part_new(&b[i], &s->placement, is_identity(&s->placement), &parts[i], err);
  if (status) {
    cag_roll_parts_free(parts, count);
    return status;
  }
  *out = parts;
  *n = count;
  return CAG_OK;
}

// --- Corners ---

static CagStatus add_meeting(const CagRollPart *p, size_t use, bool at_end, CagRollMeeting *out,
                             size_t capacity, size_t *n, CagError *err) {
  const CagCurve *curve = p->b->edges[p->b->uses[use].edge].curve;
  CagRollMeeting m;
  for (size_t i = 0; i < *n && i < capacity; i++)
    if (out[i].side.face == p->face_of[use]) return CAG_OK;
  CagStatus status = side_of_use(p, use, &m.side, err);
  if (!status)
    status = cag_edge_path_eval(&m.side.path, at_end ? curve->end : curve->start, m.uv, NULL, err);
  if (status) return status;
  if (*n < capacity) out[*n] = m;
  ++*n;
  return CAG_OK;
}

CagStatus cag_roll_meetings(const CagRollPart *p, size_t corner, CagRollMeeting *out,
                            size_t capacity, size_t *n, CagError *err) {
  const CagBoundary *b = p->b;
  CagStatus status = CAG_OK;
  *n = 0;
  for (size_t u = 0; !status && u < b->use_count; u++) {
    const CagBoundaryEdge *e = &b->edges[b->uses[u].edge];
    if (!e->curve || (e->from != corner && e->to != corner)) continue;
    status = add_meeting(p, u, e->from != corner, out, capacity, n, err);
  }
  return status;
}
