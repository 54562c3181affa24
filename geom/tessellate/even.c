// Tessellation, between lines and nodes: thin leaves get the step counts of their neighbors.
//
// If a leaf's side has other nodes than its grid, the band between them is stitched. The height of
// a triangle in the band is a step across it; the surface bulges over the middle of its base by its
// bend along the band. At the leading edge of a twisted blade the steps across are short and those
// along it are long: such a triangle would stand on edge, although everything is within the
// tolerance. There the leaf uses the finest steps on its sides for its own grid, so that no
// stitching is needed, and the lines are rebuilt, since the leaf's other side may now be finer than
// the next leaf's grid.

#include "geom/linalg/tolerance.h"
#include "geom/tessellate/tessellation.h"

// Ratio of the height of the bulge to that of the triangle: the tangent of the angle by which it
// leans.
#define LEANING 0.1
enum { ROUNDS = 32, MOST_RAISED = 8 };

static size_t first_atom(const Tessellator *t, const Line *line, double from) {
  size_t low = line->atom, high = line->atom + line->atom_count - 1;
  while (low < high) {
    const size_t middle = (low + high + 1) / 2;
    if (t->atoms[middle].from <= from) low = middle;
    else high = middle - 1;
  }
  return low;
}

// Steps along a side of a leaf at the finest spacing found on its line.
static double finest_steps(const Tessellator *t, const Leaf *leaf, int side) {
  const Line *line = &t->lines[leaf->line[side]];
  const int along = 1 - side / 2;
  double most = leaf->n[along];
  if (line->pole) return most;
  const size_t end = line->atom + line->atom_count;
  for (size_t a = first_atom(t, line, leaf->from[along]), next; a < end; a = next) {
    double steps = t->atoms[a].n;
    if (!(t->atoms[a].from < leaf->to[along])) break;
    // Slants of an adjacent strip cut a line between the corners of leaves.
    for (next = a + 1; next < end && !t->atoms[next].corner; next++) steps += t->atoms[next].n;
    const double rounding = CAG_COINCIDENT;
    const double part =
        (t->atoms[next - 1].to - t->atoms[a].from) / (leaf->to[along] - leaf->from[along]);
    most = fmax(most, ceil(steps / part * (1 - rounding)));
  }
  return most;
}

static CagStatus point_at(const CagSurface *s, const double at[2], int along, double step,
                          CagVec3 *out, CagError *err) {
  return along == 0 ? cag_surface_point(s, at[0] + step, at[1], out, err)
                    : cag_surface_point(s, at[0], at[1] + step, out, err);
}

// Whether triangles of a band on this side would lean.
static CagStatus is_thin(const Tessellator *t, const Leaf *leaf, int side, bool *thin,
                         CagError *err) {
  enum { LOOKS = 4 };
  const CagSurface *s = t->faces[leaf->face].surface;
  const int across = side / 2, along = 1 - across;
  const bool low = side % 2 == 0;
  const double long_step = (leaf->to[along] - leaf->from[along]) / leaf->n[along];
  const double short_step = (leaf->to[across] - leaf->from[across]) / leaf->n[across];
  *thin = false;
  for (int k = 0; k < LOOKS && !*thin; k++) {
    CagVec3 a, middle, b, beside;
    double at[2];
    at[across] = low ? leaf->from[across] : leaf->to[across];
    at[along] =
        leaf->from[along] + (leaf->to[along] - leaf->from[along] - long_step) * ((k + 0.5) / LOOKS);
    CagStatus status = point_at(s, at, along, 0, &a, err);
    if (!status) status = point_at(s, at, along, long_step / 2, &middle, err);
    if (!status) status = point_at(s, at, along, long_step, &b, err);
    if (!status) status = point_at(s, at, across, low ? short_step : -short_step, &beside, err);
    if (status) return status;
    const CagVec3 chord = cag_unit(cag_sub(b, a)), out = cag_sub(beside, a);
    const CagVec3 height = cag_sub(out, cag_scaled(chord, cag_dot(out, chord)));
    const CagVec3 normal = cag_cross(chord, cag_unit(height));
    const CagVec3 bulge = cag_sub(middle, cag_scaled(cag_add(a, b), 0.5));
    *thin = fabs(cag_dot(bulge, normal)) > LEANING * cag_norm(height);
  }
  return CAG_OK;
}

static CagStatus even_leaf(const Tessellator *t, Leaf *leaf, bool *raised, CagError *err) {
  if (tess_is_strip(leaf)) return CAG_OK;
  for (int side = 0; side < 4; side++) {
    const int along = 1 - side / 2;
    const double n = finest_steps(t, leaf, side);
    bool thin = false;
    if (n <= leaf->n[along] || n > (double)MOST_RAISED * leaf->planned[along]) continue;
    const CagStatus status = is_thin(t, leaf, side, &thin, err);
    if (status) return status;
    if (!thin) continue;
    leaf->n[along] = (uint32_t)n;
    *raised = true;
  }
  return CAG_OK;
}

CagStatus cag_tess_make_even_lines(Tessellator *t, uint32_t face, CagError *err) {
  const Face *f = &t->faces[face];
  const size_t lines = t->line_count, atoms = t->atom_count;
  CagStatus status = CAG_OK;
  for (size_t k = 0; k < f->leaf_count; k++) {
    Leaf *leaf = &t->leaves[f->leaf + k];
    for (int d = 0; d < 2; d++) leaf->planned[d] = leaf->n[d];
  }
  bool raised = true;
  for (int round = 0; raised && !status && round < ROUNDS; round++) {
    t->line_count = lines;
    t->atom_count = atoms;
    raised = false;
    status = cag_tess_make_lines(t, face, err);
    if (!(t->how.angle > 0)) break;
    for (size_t k = 0; !status && k < f->leaf_count && round + 1 < ROUNDS; k++)
      status = even_leaf(t, &t->leaves[f->leaf + k], &raised, err);
  }
  return status;
}
