// Creases are searched only at the breaks, by comparing the normals on both sides at points of each
// interval between the breaks of the other direction.

#include "geom/surface/crease.h"

#include <math.h>

#include "base/memory.h"

// A break is a crease if the unit normals on its sides differ by more than this.
#define CREASE 1e-7
#define PLACES 8

static CagStatus unit_normal(const CagSurface *s, const double at[2], CagSide side_u,
                             CagSide side_v, CagVec3 *out, CagError *err) {
  CagVec3 d[4];
  CagStatus status = cag_surface_eval(s, at[0], at[1], 1, side_u, side_v, d, err);
  if (!status) *out = cag_unit(cag_cross(d[cag_partial(1, 1, 0)], d[cag_partial(1, 0, 1)]));
  return status;
}

// Whether the normals jump from the line `before` to the line `after`, at the parameter w along
// them.
static CagStatus jumps_at(const CagSurface *s, int direction, double before, double after, double w,
                          bool *out, CagError *err) {
  CagVec3 n[2];
  CagStatus status = CAG_OK;
  for (int k = 0; !status && k < 2; k++) {
    const double x = k ? after : before, at[2] = {direction ? w : x, direction ? x : w};
    const CagSide side = k ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT;
    status = unit_normal(s, at, direction ? CAG_SIDE_RIGHT : side,
                         direction ? side : CAG_SIDE_RIGHT, &n[k], err);
  }
  // Points without a normal are inconclusive.
  const bool known = !status && cag_norm(n[0]) > 0 && cag_norm(n[1]) > 0;
  *out = known && cag_norm(cag_sub(n[0], n[1])) > CREASE;
  return status;
}

// Whether the surface has a crease along a parameter line: its normals jump somewhere from `before`
// to `after`, which are the same break, or both edges of a seam. `across` are the breaks of the
// other direction.
static CagStatus is_crease(const CagSurface *s, int direction, double before, double after,
                           const double *across, size_t n, bool *out, CagError *err) {
  // Not simple fractions of the intervals; only a few of each if there are many.
  static const double places[PLACES] = {0.2713, 0.7283, 0.0131, 0.9857,
                                        0.4231, 0.5819, 0.1417, 0.8611};
  const size_t each = n >= PLACES / 2 ? 2 : PLACES;
  CagStatus status = CAG_OK;
  *out = false;
  for (size_t i = 0; !status && !*out && i < n * each; i++) {
    const double lo = across[i / each], w = lo + places[i % each] * (across[i / each + 1] - lo);
    status = jumps_at(s, direction, before, after, w, out, err);
  }
  return status;
}

static CagStatus keep_creases(const CagSurface *s, int direction, double *ends, size_t *n,
                              CagError *err) {
  double *across;
  size_t count, kept = 1;
  CagStatus status = cag_surface_cuts(s, 1 - direction, &across, &count, err);
  for (size_t i = 1; !status && i < *n; i++) {
    bool crease;
    status = is_crease(s, direction, ends[i], ends[i], across, count, &crease, err);
    if (!status && crease) ends[kept++] = ends[i];
  }
  ends[kept] = ends[*n];
  *n = kept;
  cag_free(across);
  return status;
}

CagStatus cag_surface_patch_ends(const CagSurface *s, bool all, int direction, double **out,
                                 size_t *n, CagError *err) {
  const CagStatus status = cag_surface_cuts(s, direction, out, n, err);
  return status || all || *n < 2 ? status : keep_creases(s, direction, *out, n, err);
}

// --- Patches ---

static CagStatus find_wrap(CagPatches *p, int direction, CagError *err) {
  const CagSurface *s = p->s;
  const double *ends = p->ends[direction];
  double *across;
  size_t count;
  bool crease = false;
  if (!(direction ? s->closed_v : s->closed_u) || p->n[direction] > 1) return CAG_OK;
  CagStatus status = cag_surface_cuts(s, 1 - direction, &across, &count, err);
  if (!status) status = is_crease(s, direction, ends[1], ends[0], across, count, &crease, err);
  p->wraps[direction] = !status && !crease;
  cag_free(across);
  return status;
}

CagStatus cag_patches_open(const CagSurface *s, CagPatches *out, CagError *err) {
  CagStatus status = CAG_OK;
  *out = (CagPatches){.s = s};
  for (int d = 0; !status && d < 2; d++) {
    status = cag_surface_patch_ends(s, false, d, &out->ends[d], &out->n[d], err);
    if (!status) status = find_wrap(out, d, err);
  }
  if (status) cag_patches_free(out);
  return status;
}

void cag_patches_free(CagPatches *p) {
  cag_free(p->ends[0]);
  cag_free(p->ends[1]);
  *p = (CagPatches){0};
}

size_t cag_patches_find(const CagPatches *p, int direction, double x) {
  size_t low = 0, high = p->n[direction];
  while (high - low > 1) {
    const size_t middle = (low + high) / 2;
    if (x < p->ends[direction][middle]) high = middle;
    else low = middle;
  }
  return low;
}

// The patches along a direction that contain the parameter x of one of them, and its value in each.
static size_t beside(const CagPatches *p, int d, size_t patch, double x, double near,
                     size_t patches[3], double at[3]) {
  const double *ends = p->ends[d], reach = near * (ends[patch + 1] - ends[patch]);
  const size_t last = p->n[d] - 1;
  const bool closed = (d ? p->s->closed_v : p->s->closed_u) && !p->wraps[d];
  size_t n = 1;
  patches[0] = patch;
  at[0] = x;
  if (x <= ends[patch] + reach && (patch > 0 || closed)) {
    patches[n] = patch > 0 ? patch - 1 : last;
    at[n] = ends[patches[n] + 1];
    n++;
  }
  if (x >= ends[patch + 1] - reach && (patch < last || closed)) {
    patches[n] = patch < last ? patch + 1 : 0;
    at[n] = ends[patches[n]];
    n++;
  }
  return n;
}

size_t cag_patches_beside(const CagPatches *p, const CagPatchPlace *place, double near,
                          CagPatchPlace out[9]) {
  size_t patches[2][3], n[2], count = 0;
  double at[2][3];
  for (int d = 0; d < 2; d++)
    n[d] = beside(p, d, place->patch[d], place->at[d], near, patches[d], at[d]);
  for (size_t i = 0; i < n[0]; i++)
    for (size_t j = 0; j < n[1]; j++)
      out[count++] = (CagPatchPlace){{patches[0][i], patches[1][j]}, {at[0][i], at[1][j]}};
  return count;
}
