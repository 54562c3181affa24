// Splits faces of a shell at the ends of the edges of their neighbors.
//
// The edge of a face may correspond to several others, such as a circle to the arcs of two half
// disks. The face is split there along a parameter line, so that edges match entirely. A cut
// extends to the opposite side, whose neighbors may then need cuts as well; the caller repeats
// until nothing is split.

#include <math.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/solid/shell.h"
#include "geom/surface/reshape.h"

// Cuts closer to each other or to an end of the domain than this fraction of the domain coincide.
#define CUT_SAME 1e-7

typedef struct Cuts {
  double *at;
  size_t n, room;
} Cuts;

CagStatus cag_shell_add_face(CagShellFaces *f, const CagSurface *face, size_t origin,
                             CagError *err) {
  if (f->n == f->room) {
    const size_t room = f->room ? 2 * f->room : 16;
    if (!CAG_RESIZE(f->at, room) || !CAG_RESIZE(f->origin, room)) return cag_fail_memory(err);
    f->room = room;
  }
  f->at[f->n] = cag_surface_retain(face);
  f->origin[f->n++] = origin;
  return CAG_OK;
}

void cag_shell_free_faces(CagShellFaces *f) {
  for (size_t i = 0; i < f->n; i++) cag_surface_release(f->at[i]);
  cag_free(f->at);
  cag_free(f->origin);
  *f = (CagShellFaces){0};
}

static CagStatus add_cut(Cuts *c, double t, double low, double high, CagError *err) {
  const double same = CUT_SAME * (high - low);
  if (t - low <= same || high - t <= same) return CAG_OK;
  size_t place = c->n;
  for (size_t i = 0; i < c->n; i++)
    if (fabs(c->at[i] - t) <= same) return CAG_OK;
  if (!CAG_RESERVE(c->at, c->room, c->n + 1)) return cag_fail_memory(err);
  for (; place > 0 && c->at[place - 1] > t; place--) c->at[place] = c->at[place - 1];
  c->at[place] = t;
  c->n++;
  return CAG_OK;
}

// Adds a cut if the point lies within the edge b of its face.
static CagStatus cut_at(const CagShellBoundaries *all, const CagShellBoundary *b, CagVec3 p,
                        Cuts *cuts, CagError *err) {
  const CagVec3 *ends = b->p;
  double t, distance;
  CagVec3 point;
  if (cag_norm(cag_sub(p, ends[0])) <= 2 * all->slack ||
      cag_norm(cag_sub(p, ends[CAG_SHELL_PROBES - 1])) <= 2 * all->slack)
    return CAG_OK;
  CagStatus status = cag_curve_closest(b->curve, p, &t, &point, &distance, err);
  if (status || distance > all->slack) return status;
  return add_cut(cuts, t, b->curve->start, b->curve->end, err);
}

// Adds cuts at the corners of loops of planar faces.
static CagStatus cut_at_breaks(const CagShellBoundaries *all, const CagShellBoundary *b,
                               const CagCurve *loop, Cuts *cuts, CagError *err) {
  const size_t n = loop->kind->breaks ? loop->kind->breaks(loop, NULL, 0) : 0;
  double *at = cag_malloc((n + 1) * sizeof *at);
  CagStatus status = at ? CAG_OK : cag_fail_memory(err);
  if (!status && n) loop->kind->breaks(loop, at, n);
  for (size_t i = 0; !status && i < n; i++) {
    CagVec3 p;
    status = cag_curve_point(loop, at[i], &p, err);
    if (!status) status = cut_at(all, b, p, cuts, err);
  }
  cag_free(at);
  return status;
}

// Cuts across the sides of a face: in v for sides along v (0, 1), else in u.
static CagStatus find_cuts(const CagShellBoundaries *all, size_t face, Cuts cuts[2],
                           CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = 0; i < all->n; i++) {
    const CagShellBoundary *b = &all->at[i];
    if (b->face != face || b->paired || cag_shell_is_loop(b)) continue;
    Cuts *into = &cuts[b->side < 2 ? 1 : 0];
    for (size_t k = 0; !status && k < all->n; k++) {
      const CagShellBoundary *other = &all->at[k];
      if (k == i || other->paired) continue;
      if (cag_shell_is_loop(other)) {
        status = cut_at_breaks(all, b, other->curve, into, err);
        continue;
      }
      status = cut_at(all, b, other->p[0], into, err);
      if (!status) status = cut_at(all, b, other->p[CAG_SHELL_PROBES - 1], into, err);
    }
  }
  return status;
}

static double cut_or_end(const Cuts *c, size_t i, double low, double high) {
  return i == 0 ? low : i > c->n ? high : c->at[i - 1];
}

static CagStatus add_parts(const CagSurface *face, size_t origin, const Cuts cuts[2],
                           CagShellFaces *out, CagError *err) {
  CagStatus status = CAG_OK;
  if (cuts[0].n + cuts[1].n == 0) return cag_shell_add_face(out, face, origin, err);
  for (size_t i = 0; i <= cuts[0].n; i++)
    for (size_t k = 0; !status && k <= cuts[1].n; k++) {
      CagSurface *part;
      status = cag_surface_part(face, cut_or_end(&cuts[0], i, face->u0, face->u1),
                                cut_or_end(&cuts[0], i + 1, face->u0, face->u1),
                                cut_or_end(&cuts[1], k, face->v0, face->v1),
                                cut_or_end(&cuts[1], k + 1, face->v0, face->v1), &part, err);
      if (status) break;
      status = cag_shell_add_face(out, part, origin, err);
      cag_surface_release(part);
    }
  return status;
}

CagStatus cag_shell_split(const CagShellBoundaries *all, const CagShellFaces *faces, bool *split,
                          CagShellFaces *out, CagError *err) {
  CagStatus status = CAG_OK;
  *out = (CagShellFaces){0};
  *split = false;
  for (size_t f = 0; !status && f < faces->n; f++) {
    Cuts cuts[2] = {{0}};
    status = find_cuts(all, f, cuts, err);
    if (!status) status = add_parts(faces->at[f], faces->origin[f], cuts, out, err);
    cag_free(cuts[0].at);
    cag_free(cuts[1].at);
  }
  *split = !status && out->n > faces->n;
  if (!*split) cag_shell_free_faces(out);
  return status;
}
