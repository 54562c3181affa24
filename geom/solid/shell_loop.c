// Loops of planar faces of a shell that border several other faces.
//
// A loop is split at its breaks. Sides of other faces that cover parts of it become its edges. The
// rest is straight, because it lies in the planes of two faces: each piece must be a reversed piece
// of another loop.

#include <math.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/solid/shell.h"

typedef struct Piece {
  size_t loop; // index among the boundaries
  CagVec3 from, middle, to;
  bool matched;
} Piece;

typedef struct Pieces {
  Piece *at;
  size_t n, room;
} Pieces;

CagStatus cag_shell_add_link(CagShellLinks *l, CagShellLink link, CagError *err) {
  if (!CAG_RESERVE(l->at, l->room, l->n + 1)) return cag_fail_memory(err);
  l->at[l->n++] = link;
  return CAG_OK;
}

// --- Sides along loops ---

// How a side runs along a loop: +1, -1, or 0 if it does not. Steps across the loop's start are long
// and are ignored.
static CagStatus side_on_loop(const CagShellBoundary *side, const CagShellBoundary *loop,
                              double slack, int *how, CagError *err) {
  const double period = loop->curve->end - loop->curve->start;
  double last = 0;
  int turns = 0;
  *how = 0;
  for (int i = 0; i < CAG_SHELL_PROBES; i++) {
    double t, distance;
    CagVec3 point;
    CagStatus status = cag_curve_closest(loop->curve, side->p[i], &t, &point, &distance, err);
    if (status || distance > slack) return status;
    const double step = t - last;
    if (i > 0 && fabs(step) < period / 2) turns += (step > 0) - (step < 0);
    last = t;
  }
  *how = turns >= 0 ? 1 : -1;
  return CAG_OK;
}

static CagStatus pair_sides(CagSolid *s, CagShellBoundaries *all, size_t loop, CagShellLinks *links,
                            double *covered, CagError *err) {
  CagShellBoundary *l = &all->at[loop];
  CagStatus status = CAG_OK;
  *covered = 0;
  for (size_t i = 0; !status && i < all->n; i++) {
    CagShellBoundary *b = &all->at[i];
    int how;
    double length = 0;
    if (b->paired || cag_shell_is_loop(b)) continue;
    status = side_on_loop(b, l, all->slack, &how, err);
    if (status || how == 0) continue;
    status = cag_curve_length(b->curve, b->curve->start, b->curve->end, &length, err);
    if (!status) status = cag_solid_add_edge(s, l->face, l->side, b->face, b->side, how < 0, err);
    if (!status)
      status = cag_shell_add_link(
          links, (CagShellLink){l->face, b->face, cag_shell_sense(b->side) * how < 0}, err);
    b->paired = true;
    *covered += length;
  }
  return status;
}

// --- Pieces ---

static CagStatus add_piece(Pieces *p, Piece piece, CagError *err) {
  if (!CAG_RESERVE(p->at, p->room, p->n + 1)) return cag_fail_memory(err);
  p->at[p->n++] = piece;
  return CAG_OK;
}

// The pieces of a loop between its breaks.
static CagStatus add_pieces(Pieces *p, const CagShellBoundaries *all, size_t loop, CagError *err) {
  const CagCurve *c = all->at[loop].curve;
  const size_t n = c->kind->breaks ? c->kind->breaks(c, NULL, 0) : 0;
  double *t = cag_malloc((n + 2) * sizeof *t);
  if (!t) return cag_fail_memory(err);
  t[0] = c->start;
  if (n) c->kind->breaks(c, t + 1, n);
  t[n + 1] = c->end;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i <= n; i++) {
    Piece piece = {.loop = loop};
    status = cag_curve_point(c, t[i], &piece.from, err);
    if (!status) status = cag_curve_point(c, (t[i] + t[i + 1]) / 2, &piece.middle, err);
    if (!status) status = cag_curve_point(c, t[i + 1], &piece.to, err);
    if (!status && cag_norm(cag_sub(piece.to, piece.from)) > all->slack)
      status = add_piece(p, piece, err);
  }
  cag_free(t);
  return status;
}

static bool near(CagVec3 a, CagVec3 b, double slack) { return cag_norm(cag_sub(a, b)) <= slack; }

// +1: same direction, -1: reversed, 0: different pieces.
static int compare_pieces(const Piece *a, const Piece *b, double slack) {
  if (!near(a->middle, b->middle, slack)) return 0;
  if (near(a->from, b->from, slack) && near(a->to, b->to, slack)) return 1;
  return near(a->from, b->to, slack) && near(a->to, b->from, slack) ? -1 : 0;
}

// Pieces covered by a side of another face, which is an edge of the loop.
static CagStatus match_sides(const CagSolid *s, const CagShellBoundaries *all, Pieces *p,
                             CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = 0; i < p->n; i++) {
    Piece *piece = &p->at[i];
    const CagShellBoundary *loop = &all->at[piece->loop];
    for (size_t k = 0; !status && !piece->matched && k < all->n; k++) {
      const CagShellBoundary *b = &all->at[k];
      double t, distance;
      CagVec3 point;
      if (cag_shell_is_loop(b)) continue;
      bool edge = false;
      for (size_t e = 0; e < s->edge_count && !edge; e++)
        edge = s->edges[e].face[0] == loop->face && s->edges[e].side[0] == loop->side &&
               s->edges[e].face[1] == b->face && s->edges[e].side[1] == b->side;
      if (!edge) continue;
      status = cag_curve_closest(b->curve, piece->middle, &t, &point, &distance, err);
      piece->matched = distance <= all->slack;
    }
  }
  return status;
}

static CagStatus match_pieces(const CagShellBoundaries *all, Pieces *p, CagShellLinks *links,
                              CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = 0; i < p->n; i++)
    for (size_t k = i + 1; !status && k < p->n && !p->at[i].matched; k++) {
      const int how = p->at[k].matched ? 0 : compare_pieces(&p->at[i], &p->at[k], all->slack);
      if (how == 0) continue;
      p->at[i].matched = p->at[k].matched = true;
      const size_t a = all->at[p->at[i].loop].face, b = all->at[p->at[k].loop].face;
      if (a != b) status = cag_shell_add_link(links, (CagShellLink){a, b, how < 0}, err);
    }
  return status;
}

CagStatus cag_shell_pair_loops(CagSolid *s, CagShellBoundaries *all, CagShellLinks *links,
                               CagError *err) {
  Pieces pieces = {0};
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < all->n; i++) {
    CagShellBoundary *b = &all->at[i];
    double covered, length;
    if (b->paired || !cag_shell_is_loop(b)) continue;
    status = pair_sides(s, all, i, links, &covered, err);
    if (!status) status = cag_curve_length(b->curve, b->curve->start, b->curve->end, &length, err);
    b->paired = !status && fabs(covered - length) <= 8 * all->slack;
    if (!status && !b->paired) status = add_pieces(&pieces, all, i, err);
  }
  if (!status) status = match_sides(s, all, &pieces, err);
  if (!status) status = match_pieces(all, &pieces, links, err);
  for (size_t i = 0; !status && i < pieces.n; i++) all->at[pieces.at[i].loop].paired = true;
  for (size_t i = 0; !status && i < pieces.n; i++)
    if (!pieces.at[i].matched) all->at[pieces.at[i].loop].paired = false;
  cag_free(pieces.at);
  return status;
}
