// Solids from surfaces that are given: a closed shell, checked and turned outward.
//
// Each boundary edge of each face must lie on boundary edges of other faces (or of itself), to
// SHELL_GAP of the size. Edges that correspond as a whole make the edge table and carry the
// orientation from face to face; the volume then decides which side is out.

#include <math.h>
#include <stdlib.h>

#include "geom/solid/build.h"
#include "geom/surface/trimmed.h"

// How far edges may gape, as part of the size of the solid (geometry of files and of rounding
// scripts).
#define SHELL_GAP 1e-6
#define PROBES 9

typedef struct Boundary {
  size_t face;
  int side;
  CagCurve *curve;   // in space
  CagVec3 p[PROBES]; // at equal steps of its parameter
  bool paired;
} Boundary;

typedef struct Boundaries {
  Boundary *at;
  size_t n;
  double size;
} Boundaries;

static void boundaries_free(Boundaries *b) {
  for (size_t i = 0; i < b->n; i++) cag_curve_release(b->at[i].curve);
  free(b->at);
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

static CagStatus collect(CagSurface *const *faces, size_t n, Boundaries *out, CagError *err) {
  size_t most = 0;
  for (size_t f = 0; f < n; f++) most += (size_t)cag_solid_side_end(faces[f]);
  *out = (Boundaries){calloc(most ? most : 1, sizeof(Boundary)), 0, 0};
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
      Boundary *b = &out->at[out->n];
      b->face = f;
      b->side = k;
      status = side_curve(faces[f], k, &b->curve, err);
      if (!status) out->n++;
      for (int i = 0; !status && i < PROBES; i++)
        status = cag_solid_side_point(faces[f], k, (double)i / (PROBES - 1), &b->p[i], err);
    }
  }
  if (status) boundaries_free(out);
  else out->size = cag_norm(cag_sub(box.max, box.min));
  return status;
}

// Distance of the farthest probe of b from the other boundaries, stopping above `enough`.
static CagStatus gap_of(const Boundaries *all, size_t index, double enough, double *gap,
                        CagVec3 *where, CagError *err) {
  const Boundary *b = &all->at[index];
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

static CagStatus check_closed(const Boundaries *all, CagError *err) {
  for (size_t i = 0; i < all->n; i++) {
    if (all->at[i].paired) continue;
    double gap;
    CagVec3 where = {0, 0, 0};
    CagStatus status = gap_of(all, i, SHELL_GAP * all->size, &gap, &where, err);
    if (status) return status;
    if (gap <= SHELL_GAP * all->size) continue;
    static const char *const SIDE[] = {"u = start", "u = end", "v = start", "v = end"};
    char x[32], y[32], z[32], g[32];
    bool alone = !isfinite(gap);
    return cag_fail(err, CAG_E_ARGUMENT, "solid-open", "surfaces", (long)all->at[i].face,
                    "the surfaces must close: surface %zu has an open edge (%s) at [%s, %s, %s], "
                    "%s%s; add the missing face or move the edges together",
                    all->at[i].face, all->at[i].side < 4 ? SIDE[all->at[i].side] : "boundary",
                    cag_number_text(where.x, x), cag_number_text(where.y, y),
                    cag_number_text(where.z, z),
                    alone ? "with no other edge to meet" : "the nearest other edge is away by ",
                    alone ? "" : cag_number_text(gap, g));
  }
  return CAG_OK;
}

// How two boundaries run along each other: +1, -1, or 0 where they are different edges. Equal
// parameters are not asked for: ends and every probe must lie on the other.
static CagStatus relation(const Boundary *a, const Boundary *b, double slack, int *out,
                          CagError *err) {
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

// Boundary sense of a side: whether its parameter runs with the face on its left (seen from
// outside).
static int boundary_sense(int side) { return side == 0 || side == 3 ? -1 : 1; }

typedef struct Link {
  size_t a, b; // faces
  bool agrees; // their orientations agree
} Link;

static CagStatus pair_edges(CagSolid *s, Boundaries *all, Link *links, size_t *count,
                            CagError *err) {
  *count = 0;
  for (size_t i = 0; i < all->n; i++) {
    Boundary *a = &all->at[i];
    for (size_t j = i + 1; j < all->n && !a->paired; j++) {
      Boundary *b = &all->at[j];
      int how;
      if (b->paired) continue;
      CagStatus status = relation(a, b, SHELL_GAP * all->size, &how, err);
      if (status) return status;
      if (how == 0) continue;
      a->paired = b->paired = true;
      status = cag_solid_add_edge(s, a->face, a->side, b->face, b->side, how < 0, err);
      if (status) return status;
      links[(*count)++] =
          (Link){a->face, b->face, boundary_sense(a->side) * boundary_sense(b->side) * how < 0};
    }
  }
  return CAG_OK;
}

// Which faces must be turned so that neighbours agree; faces without links keep their side. part:
// the number of each face's connected part, `none` before. Gives the number of parts.
static size_t orient(size_t faces, const Link *links, size_t count, bool *turn, size_t *part) {
  const size_t none = SIZE_MAX;
  size_t parts = 0;
  for (size_t f = 0; f < faces; f++) part[f] = none;
  for (size_t seed = 0; seed < faces; seed++) {
    if (part[seed] != none) continue;
    part[seed] = parts++;
    for (bool changed = true; changed;) {
      changed = false;
      for (size_t k = 0; k < count; k++) {
        const Link *l = &links[k];
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

// Turns the faces that `turn` names, with their edges.
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

// Parts with edges that correspond to no single other one close only together: they become one
// part, the first of them.
static void join_unpaired(const Boundaries *all, size_t faces, size_t *part) {
  size_t first = SIZE_MAX;
  for (size_t i = 0; i < all->n; i++) {
    if (all->at[i].paired) continue;
    const size_t other = part[all->at[i].face];
    if (first == SIZE_MAX) first = other;
    for (size_t f = 0; f < faces; f++)
      if (part[f] == other) part[f] = first;
  }
}

static CagStatus face_outward(CagSolid *s, const Boundaries *all, const Link *links, size_t count,
                              CagError *err) {
  bool *turn = calloc(s->face_count + 1, sizeof *turn);
  size_t *part = malloc((s->face_count + 1) * sizeof *part);
  CagStatus status = turn && part ? CAG_OK : cag_fail_memory(err);
  size_t parts = status ? 0 : orient(s->face_count, links, count, turn, part);
  if (!status) join_unpaired(all, s->face_count, part);
  if (!status) status = turn_faces(s, turn, err);
  if (!status) status = cag_solid_nest(s->faces, s->face_count, part, parts, turn, err);
  if (!status) status = turn_faces(s, turn, err);
  free(turn);
  free(part);
  return status;
}

CagStatus cag_solid_shell(CagSurface *const *faces, size_t n, CagSolid **out, CagError *err) {
  for (size_t i = 0; i < n; i++)
    if (cag_surface_trimmed_view(faces[i], NULL, NULL))
      return cag_fail(err, CAG_E_UNSUPPORTED, "trimmed-face", "", (long)i,
                      "face %zu is a trimmed surface, whose outline cannot be matched to the sides "
                      "of others: use whole surfaces, or a mesh of the parts",
                      i);
  if (n == 0)
    return cag_fail(err, CAG_E_ARGUMENT, "solid-open", "surfaces", -1,
                    "`surfaces` must hold at least one surface");
  Boundaries all;
  CagStatus status = collect(faces, n, &all, err);
  if (status) return status;
  CagSolid *s = NULL;
  size_t count = 0;
  Link *links = malloc((all.n + 1) * sizeof *links);
  if (!links) status = cag_fail_memory(err);
  if (!status) status = cag_solid_block(CAG_SOLID_SHELL, n, &s, err);
  for (size_t i = 0; !status && i < n; i++) cag_solid_add(s, cag_surface_retain(faces[i]));
  if (!status) status = pair_edges(s, &all, links, &count, err);
  if (!status) status = check_closed(&all, err);
  if (!status) status = face_outward(s, &all, links, count, err);
  free(links);
  boundaries_free(&all);
  if (status) cag_solid_release(s);
  else *out = s;
  return status;
}
