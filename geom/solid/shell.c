// Solids from given surfaces: a closed shell, checked and oriented outward.
//
// Each boundary edge of each face must lie on boundary edges of other faces (or of itself), to
// SHELL_GAP of the size. Edges that match entirely form the edge table and propagate the
// orientation from face to face; the sign of the volume then determines which side is outside.
// Faces whose edges match several others are cut first (shell_split.c), and loops of planar faces
// may match several faces (shell_loop.c), until no edge is left.

#include <math.h>

#include "base/memory.h"
#include "geom/solid/shell.h"
#include "geom/surface/trimmed.h"

// Largest gap between edges, as a fraction of the size of the solid (geometry from files and
// scripts with rounding).
#define SHELL_GAP 1e-6
#define PROBES CAG_SHELL_PROBES
// Maximum number of rounds of cuts, each of which may require others on the opposite sides, and of
// faces after them.
#define ROUNDS_MOST 12
#define FACES_MOST 4000

static void boundaries_free(CagShellBoundaries *b) {
  for (size_t i = 0; i < b->n; i++) cag_curve_release(b->at[i].curve);
  cag_free(b->at);
}

static CagStatus side_curve(const CagSurface *face, int side, CagCurve **out, CagError *err) {
  const CagRegion *region;
  CagTransform frame;
  if (!cag_surface_planar_view(face, &region, &frame))
    return cag_surface_isocurve(face, side / 2,
                                side == 0   ? face->u0
                                : side == 1 ? face->u1
                                : side == 2 ? face->v0
                                            : face->v1,
                                out, err);
  CagCurve *space;
  CagStatus status = cag_curve_to_space(region->loops[side - 4], &space, err);
  if (status) return status;
  status = cag_curve_transform(space, &frame, out, err);
  cag_curve_release(space);
  return status;
}

static CagStatus collect(CagSurface *const *faces, size_t n, CagShellBoundaries *out,
                         CagError *err) {
  size_t most = 0;
  for (size_t f = 0; f < n; f++) most += (size_t)cag_solid_side_end(faces[f]);
  *out = (CagShellBoundaries){cag_calloc(most ? most : 1, sizeof(CagShellBoundary)), 0, 0, 0};
  if (!out->at) return cag_fail_memory(err);
  CagBounds box = CAG_BOUNDS_EMPTY;
  CagStatus status = CAG_OK;
  for (size_t f = 0; !status && f < n; f++) {
    CagBounds part;
    status = cag_surface_bounds(faces[f], &part, err);
    if (status) break;
    cag_bounds_add(&box, part.min);
    cag_bounds_add(&box, part.max);
    for (int k = cag_solid_first_side(faces[f]); !status && k < cag_solid_side_end(faces[f]); k++) {
      if (!cag_solid_side_is_edge(faces[f], k)) continue;
      CagShellBoundary *b = &out->at[out->n];
      b->face = f;
      b->side = k;
      status = side_curve(faces[f], k, &b->curve, err);
      if (!status) out->n++;
      for (int i = 0; !status && i < PROBES; i++)
        status = cag_solid_side_point(faces[f], k, (double)i / (PROBES - 1), &b->p[i], err);
    }
  }
  if (status) boundaries_free(out);
  out->size = cag_norm(cag_sub(box.max, box.min));
  out->slack = SHELL_GAP * out->size;
  for (size_t i = 0; !status && i < out->n; i++) { // an edge that is a point needs no partner
    CagShellBoundary *b = &out->at[i];
    b->paired = true;
    for (int k = 1; k < PROBES && b->paired; k++)
      b->paired = cag_norm(cag_sub(b->p[k], b->p[0])) <= out->slack;
  }
  return status;
}

// Largest distance of a probe of b from the other boundaries; stops above `enough`.
static CagStatus gap_of(const CagShellBoundaries *all, size_t index, double enough, double *gap,
                        CagVec3 *where, CagError *err) {
  const CagShellBoundary *b = &all->at[index];
  *gap = 0;
  for (int i = 0; i < PROBES; i++) {
    double nearest = INFINITY;
    for (size_t k = 0; k < all->n && nearest > enough; k++) {
      if (k == index) continue;
      double t, distance;
      CagVec3 point;
      CagStatus status = cag_curve_closest(all->at[k].curve, b->p[i], &t, &point, &distance, err);
      if (status) return status;
      nearest = fmin(nearest, distance);
    }
    if (nearest > *gap) {
      *gap = nearest;
      *where = b->p[i];
    }
  }
  return CAG_OK;
}

static const char *side_name(int side) {
  static const char *const NAMES[] = {"u = start", "u = end", "v = start", "v = end"};
  return side < 4 ? NAMES[side] : "boundary";
}

// Reports edges without a partner: a gap, or neighbors whose edges are divided differently. origin:
// the caller's face numbers.
static CagStatus check_closed(const CagShellBoundaries *all, const size_t *origin, CagError *err) {
  char x[32], y[32], z[32], g[32];
  const CagShellBoundary *divided = NULL;
  for (size_t i = 0; i < all->n; i++) {
    const CagShellBoundary *b = &all->at[i];
    double gap;
    CagVec3 where = {0, 0, 0};
    if (b->paired) continue;
    CagStatus status = gap_of(all, i, all->slack, &gap, &where, err);
    if (status) return status;
    if (!divided) divided = b;
    if (gap <= all->slack) continue;
    const size_t face = origin[b->face];
    bool alone = !isfinite(gap);
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_solid_open, "surfaces", (long)face,
                    "the surfaces must close: surface %zu has an open edge (%s) at [%s, %s, %s], "
                    "%s%s; add the missing face or move the edges together",
                    face, side_name(b->side), cag_number_text(where.x, x),
                    cag_number_text(where.y, y), cag_number_text(where.z, z),
                    alone ? "with no other edge to meet" : "the nearest other edge is away by ",
                    alone ? "" : cag_number_text(gap, g));
  }
  if (!divided) return CAG_OK;
  const size_t face = origin[divided->face];
  const CagVec3 at = divided->p[0];
  return cag_fail(
      err, CAG_E_ARGUMENT, CAG_ERR_solid_open, "surfaces", (long)face,
      "the surfaces must share whole edges: the edge of surface %zu (%s) that starts at [%s, %s, %s] is divided differently by its neighbors; divide it at their corners",
      face, side_name(divided->side), cag_number_text(at.x, x), cag_number_text(at.y, y),
      cag_number_text(at.z, z));
}

// Whether two boundaries coincide: +1 in the same direction, -1 reversed, or 0 for different edges.
// Parameters need not agree: ends and every probe must lie on the other boundary.
static CagStatus relation(const CagShellBoundary *a, const CagShellBoundary *b, double slack,
                          int *out, CagError *err) {
  *out = 0;
  double forward = fmax(cag_norm(cag_sub(a->p[0], b->p[0])),
                        cag_norm(cag_sub(a->p[PROBES - 1], b->p[PROBES - 1])));
  double backward = fmax(cag_norm(cag_sub(a->p[0], b->p[PROBES - 1])),
                         cag_norm(cag_sub(a->p[PROBES - 1], b->p[0])));
  if (forward > slack && backward > slack) return CAG_OK;
  double last = 0;
  int turns = 0;
  for (int i = 1; i < PROBES - 1; i++) {
    double t, distance;
    CagVec3 point;
    CagStatus status = cag_curve_closest(b->curve, a->p[i], &t, &point, &distance, err);
    if (status || distance > slack) return status;
    if (i > 1) turns += t > last ? 1 : -1;
    last = t;
  }
  *out = turns > 0 ? 1 : -1;
  return CAG_OK;
}

static CagStatus pair_edges(CagSolid *s, CagShellBoundaries *all, CagShellLinks *links,
                            CagError *err) {
  for (size_t i = 0; i < all->n; i++) {
    CagShellBoundary *a = &all->at[i];
    for (size_t j = i + 1; j < all->n && !a->paired; j++) {
      CagShellBoundary *b = &all->at[j];
      int how;
      if (b->paired) continue;
      CagStatus status = relation(a, b, all->slack, &how, err);
      if (status) return status;
      if (how == 0) continue;
      a->paired = b->paired = true;
      status = cag_solid_add_edge(s, a->face, a->side, b->face, b->side, how < 0, err);
      if (status) return status;
      const CagShellLink link = {a->face, b->face,
                                 cag_shell_sense(a->side) * cag_shell_sense(b->side) * how < 0};
      status = cag_shell_add_link(links, link, err);
      if (status) return status;
    }
  }
  return CAG_OK;
}

// Determines which faces to reverse so that neighbors agree; faces without links are not reversed.
// part: the index of each face's connected part, `none` before. Returns the number of parts.
static size_t orient(size_t faces, const CagShellLinks *links, bool *turn, size_t *part) {
  const size_t none = SIZE_MAX;
  size_t parts = 0;
  for (size_t f = 0; f < faces; f++) part[f] = none;
  for (size_t seed = 0; seed < faces; seed++) {
    if (part[seed] != none) continue;
    part[seed] = parts++;
    for (bool changed = true; changed;) {
      changed = false;
      for (size_t k = 0; k < links->n; k++) {
        const CagShellLink *l = &links->at[k];
        if ((part[l->a] == none) == (part[l->b] == none)) continue;
        size_t from = part[l->a] != none ? l->a : l->b, to = part[l->a] != none ? l->b : l->a;
        turn[to] = turn[from] != !l->agrees;
        part[to] = part[from];
        changed = true;
      }
    }
  }
  return parts;
}

// Reverses the faces marked in `turn`, with their edges.
static CagStatus turn_faces(CagSolid *s, const bool *turn, CagError *err) {
  for (size_t i = 0; i < s->face_count; i++) {
    if (!turn[i]) continue;
    CagSurface *turned;
    CagStatus status = cag_surface_flip(s->faces[i], &turned, err);
    if (status) return status;
    cag_surface_release(s->faces[i]);
    s->faces[i] = turned;
  }
  for (size_t e = 0; e < s->edge_count; e++)
    for (int k = 0; k < 2; k++) {
      if (!turn[s->edges[e].face[k]]) continue;
      int *side = &s->edges[e].side[k];
      if (*side == 2 || *side == 3) *side = 5 - *side;
      else s->edges[e].reversed = !s->edges[e].reversed;
    }
  return CAG_OK;
}

static CagStatus face_outward(CagSolid *s, const CagShellLinks *links, CagError *err) {
  bool *turn = cag_calloc(s->face_count + 1, sizeof *turn);
  size_t *part = cag_malloc((s->face_count + 1) * sizeof *part);
  CagStatus status = turn && part ? CAG_OK : cag_fail_memory(err);
  size_t parts = status ? 0 : orient(s->face_count, links, turn, part);
  if (!status) status = turn_faces(s, turn, err);
  if (!status) status = cag_solid_nest(s->faces, s->face_count, part, parts, turn, err);
  if (!status) status = turn_faces(s, turn, err);
  cag_free(turn);
  cag_free(part);
  return status;
}

// Pairs whole edges, then loops. *left: some edges match only in part.
static CagStatus pair_all(const CagShellFaces *faces, CagShellBoundaries *all, CagSolid **out,
                          CagShellLinks *links, bool *left, CagError *err) {
  CagSolid *s = NULL;
  CagStatus status = cag_solid_block(CAG_SOLID_SHELL, faces->n, &s, err);
  if (status) return status;
  for (size_t i = 0; i < faces->n; i++) cag_solid_add(s, cag_surface_retain(faces->at[i]));
  links->n = 0;
  status = pair_edges(s, all, links, err);
  if (!status) status = cag_shell_pair_loops(s, all, links, err);
  *left = false;
  for (size_t i = 0; i < all->n; i++) *left = *left || !all->at[i].paired;
  if (status) cag_solid_release(s);
  else *out = s;
  return status;
}

// Pairs the edges, cutting faces as long as that helps. The faces are replaced by their parts.
static CagStatus join_faces(CagShellFaces *faces, CagSolid **out, CagError *err) {
  CagShellLinks links = {0};
  CagSolid *s = NULL;
  CagStatus status = CAG_OK;
  bool split = true;
  for (int round = 0; !status && split; round++) {
    CagShellBoundaries all;
    CagShellFaces parts = {0};
    bool left = false;
    status = collect(faces->at, faces->n, &all, err);
    if (status) break;
    cag_solid_release(s);
    s = NULL;
    status = pair_all(faces, &all, &s, &links, &left, err);
    split = !status && left && round < ROUNDS_MOST && faces->n < FACES_MOST;
    if (split) status = cag_shell_split(&all, faces, &split, &parts, err);
    if (!status && !split && left) status = check_closed(&all, faces->origin, err);
    boundaries_free(&all);
    if (status || !split) continue;
    cag_shell_free_faces(faces);
    *faces = parts;
  }
  if (!status) status = face_outward(s, &links, err);
  cag_free(links.at);
  if (status) cag_solid_release(s);
  else *out = s;
  return status;
}

CagStatus cag_solid_shell(CagSurface *const *faces, size_t n, CagSolid **out, CagError *err) {
  for (size_t i = 0; i < n; i++)
    if (cag_surface_trimmed_view(faces[i], NULL, NULL))
      return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_trimmed_face, "", (long)i,
                      "face %zu is a trimmed surface, whose outline cannot be matched to the sides "
                      "of others: use whole surfaces, or a mesh of the parts",
                      i);
  if (n == 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_solid_open, "surfaces", -1,
                    "`surfaces` must contain at least one surface");
  CagShellFaces own = {0};
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < n; i++) status = cag_shell_add_face(&own, faces[i], i, err);
  if (!status) status = join_faces(&own, out, err);
  cag_shell_free_faces(&own);
  return status;
}
