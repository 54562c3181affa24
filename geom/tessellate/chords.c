// Tessellation: chords of borders and creases of a face.
//
// Inside a face only the distance along the normal matters. At its border the curve must be
// followed too: the rim of a flat ring is round, although the ring is flat. The same holds at a
// crease, where a point may be close to both tangent planes and yet far from their intersection.

#include "geom/mesh/distance.h"
#include "geom/tessellate/tessellation.h"

enum { CHORDS = 32 }; // maximum number of chords of an atom that are measured

#define HIGHEST_USE 0.9
#define AIMED_USE 0.84 // see plan.c

// Largest distance from some of the n chords of [from, to] to the curve, at their midpoints and
// thirds.
static CagStatus chord_distance(const Tessellator *t, const Line *line, double from, double to,
                                double n, double *distance, CagError *err) {
  enum { PLACES = 5 };
  static const double place[PLACES] = {0, 1.0 / 3, 0.5, 2.0 / 3, 1};
  const CagSurface *s = t->faces[line->face].surface;
  double at[CHORDS * PLACES];
  CagVec3 points[CHORDS * PLACES];
  size_t count = n < CHORDS ? (size_t)n : CHORDS;
  for (size_t k = 0; k < count; k++) {
    double chosen = count > 1 ? floor((double)k * (n - 1) / (double)(count - 1)) : 0;
    for (size_t p = 0; p < PLACES; p++) {
      double x = from + (to - from) * ((chosen + place[p]) / n);
      at[k * PLACES + p] = x < to ? x : to;
    }
  }
  CagStatus status = line->fixed == 0
                         ? cag_surface_eval_grid(s, &line->coordinate, 1, at, count * PLACES,
                                                 points, NULL, NULL, err)
                         : cag_surface_eval_grid(s, at, count * PLACES, &line->coordinate, 1,
                                                 points, NULL, NULL, err);
  if (status) return status;
  *distance = 0;
  for (size_t k = 0; k < count; k++) {
    const CagVec3 *q = points + k * PLACES;
    for (size_t p = 1; p + 1 < PLACES; p++)
      *distance = fmax(*distance, cag_distance_to_segment(q[p], q[0], q[PLACES - 1]));
  }
  return CAG_OK;
}

static CagStatus normal_on(const CagSurface *s, const Line *line, double at, bool after,
                           CagVec3 *normal, CagError *err) {
  CagVec3 d[4];
  double fixed = after ? line->coordinate : line->before;
  CagSide side = after ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT;
  CagStatus status = line->fixed == 0
                         ? cag_surface_eval(s, fixed, at, 1, side, CAG_SIDE_RIGHT, d, err)
                         : cag_surface_eval(s, at, fixed, 1, CAG_SIDE_RIGHT, side, d, err);
  *normal = cag_unit(cag_cross(d[cag_partial(1, 1, 0)], d[cag_partial(1, 0, 1)]));
  return status;
}

// Whether the normal jumps across the line, tested at two points of the atom.
static CagStatus is_crease(const Tessellator *t, const Line *line, const Atom *atom, bool *out,
                           CagError *err) {
  const double jump = 1e-3;                        // radians
  static const double place[2] = {0.3819, 0.8541}; // arbitrary, but not at points of symmetry
  *out = false;
  for (int k = 0; k < 2 && !*out; k++) {
    double at = atom->from + (atom->to - atom->from) * place[k];
    CagVec3 before, after;
    const CagSurface *s = t->faces[line->face].surface;
    CagStatus status = normal_on(s, line, at, false, &before, err);
    if (!status) status = normal_on(s, line, at, true, &after, err);
    if (status) return status;
    *out = cag_norm(cag_sub(after, before)) > jump;
  }
  return CAG_OK;
}

CagStatus cag_tess_refine_chords(Tessellator *t, Line *line, CagError *err) {
  for (size_t a = 0; a < line->atom_count; a++) {
    Atom *atom = &t->atoms[line->atom + a];
    double n = atom->n, distance;
    bool counts = line->border;
    if (!counts) {
      CagStatus status = is_crease(t, line, atom, &counts, err);
      if (status) return status;
    }
    while (counts) {
      CagStatus status = chord_distance(t, line, atom->from, atom->to, n, &distance, err);
      if (status) return status;
      double use = distance / t->how.tolerance;
      if (use <= HIGHEST_USE) break;
      n = ceil(n * fmin(16, fmax(1.05, sqrt(use / AIMED_USE))));
      if (n > (double)t->how.max_triangles) return cag_tess_limit(t, n, err);
    }
    if (n <= atom->n) continue;
    atom->n = n < UINT32_MAX / 4 ? (uint32_t)n : UINT32_MAX / 4;
    atom->needed = n;
  }
  return CAG_OK;
}
