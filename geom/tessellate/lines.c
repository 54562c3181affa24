// Tessellation, step 2: the lines that leaves share, and how finely each is divided.
//
// A line is cut into atoms at the corners of the leaves on both of its sides, and where the slants
// of strips meet it. An atom takes the larger count that the two leaves beside it need. Neighbors
// therefore have the same points, whatever their grids are. Edges of a solid join a line of one
// face to a line of another, and both lines receive the corners of both.

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/sort.h"
#include "geom/linalg/tolerance.h"
#include "geom/tessellate/tessellation.h"

// One side of a leaf, on its line.
typedef struct LeafSide {
  uint32_t leaf;
  int side, fixed;
  double coordinate; // at a seam, that of the lower end of the domain
  double from, to;
  double n;
  double slant, spacing; // slants meet the side at slant + k * spacing; spacing is 0 without slants
} LeafSide;

static int compare(double a, double b) { return a < b ? -1 : a > b; }

static int by_line(const void *a, const void *b) {
  const LeafSide *p = a, *q = b;
  if (p->fixed != q->fixed) return p->fixed - q->fixed;
  int order = compare(p->coordinate, q->coordinate);
  if (!order) order = compare(p->from, q->from);
  if (!order) order = compare(p->to, q->to);
  return order ? order : p->side - q->side;
}

static double end_of(const CagSurface *s, int side) {
  const double ends[4] = {s->u0, s->u1, s->v0, s->v1};
  return ends[side];
}

static bool closed_in(const CagSurface *s, int direction) {
  return direction == 0 ? s->closed_u : s->closed_v;
}

static bool pole_at(const CagSurface *s, int side) {
  const bool poles[4] = {s->pole_u0, s->pole_u1, s->pole_v0, s->pole_v1};
  return poles[side];
}

// Finds where the slants of a strip meet one of its sides.
static void find_slants(const Leaf *leaf, LeafSide *side, double at) {
  const Slants *s = &leaf->slants;
  const double from = leaf->from[1 - s->along];
  if (!tess_is_strip(leaf)) return;
  if (side->fixed != s->along) {
    side->slant = s->phase + s->slope * (at - from);
    side->spacing = s->step;
  } else if (s->slope != 0) {
    side->slant = from + (at - s->phase) / s->slope;
    side->spacing = s->step / fabs(s->slope);
  }
}

static LeafSide *collect_sides(const Tessellator *t, const Face *f) {
  LeafSide *sides = cag_malloc((4 * f->leaf_count + 1) * sizeof *sides);
  for (size_t k = 0; sides && k < f->leaf_count; k++) {
    const Leaf *leaf = &t->leaves[f->leaf + k];
    for (int side = 0; side < 4; side++) {
      int fixed = side / 2, along = 1 - fixed;
      const double own = side % 2 == 0 ? leaf->from[fixed] : leaf->to[fixed];
      double at = own;
      if (closed_in(f->surface, fixed) && at == end_of(f->surface, 2 * fixed + 1))
        at = end_of(f->surface, 2 * fixed);
      LeafSide *to = &sides[4 * k + (size_t)side];
      *to = (LeafSide){.leaf = (uint32_t)(f->leaf + k),
                       .side = side,
                       .fixed = fixed,
                       .coordinate = at,
                       .from = leaf->from[along],
                       .to = leaf->to[along],
                       .n = leaf->n[along]};
      find_slants(leaf, to, own);
    }
  }
  if (sides) qsort(sides, 4 * f->leaf_count, sizeof *sides, by_line);
  return sides;
}

// A location at which a line is cut: a corner of a leaf or a slant of a strip.
typedef struct Mark {
  double at, nearest; // a slant mark has no other mark within `nearest`
  bool corner;
} Mark;

typedef struct Marks {
  Mark *all;
  size_t count, capacity;
} Marks;

static int by_place(const void *a, const void *b) {
  const Mark *p = a, *q = b;
  const int order = compare(p->at, q->at);
  return order ? order : q->corner - p->corner;
}

static CagStatus add_mark(Marks *m, Mark mark, CagError *err) {
  if (!CAG_RESERVE(m->all, m->capacity, m->count + 1)) return cag_fail_memory(err);
  m->all[m->count++] = mark;
  return CAG_OK;
}

static CagStatus mark_slants(Marks *m, const LeafSide *side, CagError *err) {
  const double nearest = 0.05; // fraction of the distance between slants
  CagStatus status = CAG_OK;
  if (!(side->spacing > 0)) return CAG_OK;
  for (double k = ceil((side->from - side->slant) / side->spacing); !status; k++) {
    const double at = side->slant + k * side->spacing;
    if (at >= side->to) break;
    status = add_mark(m, (Mark){at, nearest * side->spacing, false}, err);
  }
  return status;
}

// Finds the locations at which `count` sides cut their line, in order. If strips lie on both sides
// of the line, the slants of one of them serve both.
static CagStatus find_marks(Marks *m, const LeafSide *sides, size_t count, CagError *err) {
  CagStatus status = CAG_OK;
  const LeafSide *last = NULL; // the side whose slants were marked last
  m->count = 0;
  for (size_t k = 0; !status && k < count; k++) {
    status = add_mark(m, (Mark){sides[k].from, 0, true}, err);
    if (!status) status = add_mark(m, (Mark){sides[k].to, 0, true}, err);
    if (status || !(sides[k].spacing > 0)) continue;
    if (last && last->from == sides[k].from && last->to == sides[k].to) continue;
    status = mark_slants(m, &sides[k], err);
    last = &sides[k];
  }
  if (status) return status;
  status = cag_sort(m->all, m->count, sizeof *m->all, by_place, err);
  if (status) return status;
  size_t kept = 0;
  for (size_t k = 0; k < m->count; k++) {
    const Mark mark = m->all[k];
    if (kept > 0 && mark.at == m->all[kept - 1].at) continue;
    if (!mark.corner && kept > 0 && mark.at - m->all[kept - 1].at < mark.nearest) continue;
    while (mark.corner && kept > 0 && !m->all[kept - 1].corner &&
           mark.at - m->all[kept - 1].at < m->all[kept - 1].nearest)
      kept--;
    m->all[kept++] = mark;
  }
  m->count = kept;
  return CAG_OK;
}

static CagStatus push_atom(Tessellator *t, double from, double to, CagError *err) {
  if (!CAG_RESERVE(t->atoms, t->atom_capacity, t->atom_count + 1)) return cag_fail_memory(err);
  t->atoms[t->atom_count++] = (Atom){from, to, 0, 1, true};
  return CAG_OK;
}

// Index of the atom of the line that starts at `from`.
static size_t atom_at(const Tessellator *t, const Line *line, double from) {
  size_t low = line->atom, high = line->atom + line->atom_count - 1;
  while (low < high) {
    size_t middle = (low + high + 1) / 2;
    if (t->atoms[middle].from <= from) low = middle;
    else high = middle - 1;
  }
  return low;
}

// Number of steps of an atom; rounded to an integer that it equals up to rounding.
static uint32_t steps(double needed) {
  double n = ceil(needed - 1e-9 * (1 + needed));
  return n < 1 ? 1 : (uint32_t)n;
}

// Makes the atoms of the line on which `count` sides lie.
static CagStatus cut_line(Tessellator *t, Line *line, const LeafSide *sides, size_t count,
                          Marks *marks, CagError *err) {
  CagStatus status = find_marks(marks, sides, count, err);
  line->atom = t->atom_count;
  for (size_t k = 0; !status && k + 1 < marks->count; k++) {
    status = push_atom(t, marks->all[k].at, marks->all[k + 1].at, err);
    if (!status) t->atoms[t->atom_count - 1].corner = marks->all[k].corner;
  }
  if (status) return status;
  line->atom_count = t->atom_count - line->atom;
  for (size_t k = 0; k < count; k++) {
    double per_length = sides[k].n / (sides[k].to - sides[k].from);
    for (size_t a = atom_at(t, line, sides[k].from); a < t->atom_count; a++) {
      Atom *atom = &t->atoms[a];
      if (atom->from >= sides[k].to) break;
      atom->needed = fmax(atom->needed, per_length * (atom->to - atom->from));
      atom->n = steps(atom->needed);
    }
  }
  return CAG_OK;
}

static bool is_break(const Face *f, int direction, double at) {
  for (size_t low = 1, high = f->break_count[direction] - 1; low < high;) {
    size_t middle = (low + high) / 2;
    if (f->breaks[direction][middle] == at) return true;
    if (f->breaks[direction][middle] < at) low = middle + 1;
    else high = middle;
  }
  return false;
}

static Line new_line(const Face *f, uint32_t face, const LeafSide *first) {
  const CagSurface *s = f->surface;
  Line line = {.face = face,
               .fixed = first->fixed,
               .coordinate = first->coordinate,
               .before = first->coordinate,
               .joined = NO_INDEX};
  int low = 2 * first->fixed;
  line.seam = closed_in(s, first->fixed) && first->coordinate == end_of(s, low);
  if (line.seam) line.before = end_of(s, low + 1);
  line.pole = (pole_at(s, low) && first->coordinate == end_of(s, low)) ||
              (pole_at(s, low + 1) && first->coordinate == end_of(s, low + 1));
  line.border = !line.seam && !line.pole &&
                (first->coordinate == end_of(s, low) || first->coordinate == end_of(s, low + 1));
  line.is_break = line.seam || is_break(f, first->fixed, first->coordinate);
  return line;
}

CagStatus cag_tess_make_lines(Tessellator *t, uint32_t face, CagError *err) {
  Face *f = &t->faces[face];
  size_t count = 4 * f->leaf_count;
  LeafSide *sides = collect_sides(t, f);
  Marks marks = {0};
  CagStatus status = sides ? CAG_OK : cag_fail_memory(err);
  f->line = t->line_count;
  for (size_t k = 0, next; !status && k < count; k = next) {
    for (next = k + 1; next < count && sides[next].fixed == sides[k].fixed &&
                       sides[next].coordinate == sides[k].coordinate;)
      next++;
    status =
        CAG_RESERVE(t->lines, t->line_capacity, t->line_count + 1) ? CAG_OK : cag_fail_memory(err);
    if (status) break;
    Line *line = &t->lines[t->line_count++];
    *line = new_line(f, face, &sides[k]);
    status = cut_line(t, line, sides + k, next - k, &marks, err);
    if (!status && (line->border || line->is_break)) status = cag_tess_refine_chords(t, line, err);
    for (size_t j = k; j < next; j++)
      t->leaves[sides[j].leaf].line[sides[j].side] = (uint32_t)(t->line_count - 1);
  }
  f->line_count = t->line_count - f->line;
  cag_free(sides);
  cag_free(marks.all);
  return status;
}

uint32_t cag_tess_side_line(const Tessellator *t, uint32_t face, int side) {
  const Face *f = &t->faces[face];
  if (f->planar || side > SIDE_V1 || closed_in(f->surface, side / 2) || pole_at(f->surface, side))
    return NO_INDEX;
  for (size_t k = f->line; k < f->line + f->line_count; k++)
    if (t->lines[k].fixed == side / 2 && t->lines[k].coordinate == end_of(f->surface, side))
      return (uint32_t)k;
  return NO_INDEX;
}

// --- Joining ---

// Maps parameters of one line to parameters of the other: affinely if that is correct, else by the
// nearest point.
typedef struct Match {
  const Tessellator *t;
  const Line *lines[2];
  double from[2], to[2];
  bool reversed, affine;
  CagVec3 *samples[2];
} Match;

enum { MATCH_SAMPLES = 257 };

static CagStatus point_on(const Match *m, int which, double t, CagVec3 *out, CagError *err) {
  const Line *line = m->lines[which];
  const CagSurface *s = m->t->faces[line->face].surface;
  return line->fixed == 0 ? cag_surface_point(s, line->coordinate, t, out, err)
                          : cag_surface_point(s, t, line->coordinate, out, err);
}

static double affine_image(const Match *m, int of, double t) {
  double a = m->from[1 - of], b = m->to[1 - of];
  if (t == m->from[of]) return m->reversed ? b : a;
  if (t == m->to[of]) return m->reversed ? a : b;
  double x = (t - m->from[of]) / (m->to[of] - m->from[of]);
  return m->reversed ? b + (a - b) * x : a + (b - a) * x;
}

// Parameter of the other line's point nearest to that at t: the nearest sample, refined by section
// search on the adjacent steps.
static CagStatus nearest_image(const Match *m, int of, double t, double *out, CagError *err) {
  int other = 1 - of;
  CagVec3 p, q;
  CagStatus status = point_on(m, of, t, &p, err);
  if (status) return status;
  size_t best = 0;
  double least = INFINITY;
  for (size_t k = 0; k < MATCH_SAMPLES; k++) {
    double d = cag_norm(cag_sub(m->samples[other][k], p));
    if (d < least) least = d, best = k;
  }
  size_t last = MATCH_SAMPLES - 1;
  double a = tess_mix(m->from[other], m->to[other], best > 0 ? best - 1 : 0, last),
         b = tess_mix(m->from[other], m->to[other], best < last ? best + 1 : last, last);
  const double golden = 0.6180339887498949;
  for (int k = 0; k < 60; k++) {
    double x = b - golden * (b - a), y = a + golden * (b - a);
    status = point_on(m, other, x, &q, err);
    double dx = cag_norm(cag_sub(q, p));
    if (!status) status = point_on(m, other, y, &q, err);
    if (status) return status;
    if (dx < cag_norm(cag_sub(q, p))) b = y;
    else a = x;
  }
  *out = (a + b) / 2;
  return CAG_OK;
}

static CagStatus image(const Match *m, int of, double t, double *out, CagError *err) {
  *out = affine_image(m, of, t);
  bool end = t == m->from[of] || t == m->to[of];
  return m->affine || end ? CAG_OK : nearest_image(m, of, t, out, err);
}

static CagStatus begin_match(Match *m, CagError *err) {
  const double same = 1e-7; // relative to the size: edges of solids are matched to 1e-6
  enum { TRIALS = 16 };
  m->affine = true;
  for (size_t k = 1; k < TRIALS && m->affine; k++) {
    double t = tess_mix(m->from[0], m->to[0], k, TRIALS);
    CagVec3 p, q;
    CagStatus status = point_on(m, 0, t, &p, err);
    if (!status) status = point_on(m, 1, affine_image(m, 0, t), &q, err);
    if (status) return status;
    m->affine = cag_norm(cag_sub(p, q)) <= same * m->t->size;
  }
  for (int w = 0; w < 2 && !m->affine; w++) {
    m->samples[w] = cag_malloc(MATCH_SAMPLES * sizeof *m->samples[w]);
    if (!m->samples[w]) return cag_fail_memory(err);
    for (size_t k = 0; k < MATCH_SAMPLES; k++) {
      double t = tess_mix(m->from[w], m->to[w], k, MATCH_SAMPLES - 1);
      CagStatus status = point_on(m, w, t, &m->samples[w][k], err);
      if (status) return status;
    }
  }
  return CAG_OK;
}

// A cut of the joined lines: its parameter on each, and whether it is a leaf corner there.
typedef struct Cut {
  double t[2];
  bool corner[2];
} Cut;

static int by_master(const void *a, const void *b) {
  return compare(((const Cut *)a)->t[0], ((const Cut *)b)->t[0]);
}

// Cuts of both lines in the master's order; coinciding cuts are merged.
static CagStatus common_cuts(const Match *m, Cut *cuts, size_t *count, CagError *err) {
  const double thin =
      CAG_COINCIDENT; // fraction of the domain: rounding of the map and of the nearest point
  size_t n = 0;
  for (int of = 0; of < 2; of++)
    for (size_t a = 0; a < m->lines[of]->atom_count; a++) {
      const Atom *atom = &m->t->atoms[m->lines[of]->atom + a];
      Cut *cut = &cuts[n++];
      cut->t[of] = atom->from;
      cut->corner[of] = atom->corner;
      cut->corner[1 - of] = a == 0; // the start of one line is the start or the end of the other
      CagStatus status = image(m, of, atom->from, &cut->t[1 - of], err);
      if (status) return status;
    }
  // For lines in opposite directions, first atoms begin at both ends.
  if (!m->reversed) cuts[n++] = (Cut){{m->to[0], m->to[1]}, {true, true}};
  qsort(cuts, n, sizeof *cuts, by_master);
  size_t kept = 0;
  for (size_t k = 1; k < n; k++) {
    Cut *last = &cuts[kept];
    double near = m->affine ? thin : 1e-6;
    if (cuts[k].t[0] - last->t[0] > near * (m->to[0] - m->from[0])) {
      cuts[++kept] = cuts[k];
      continue;
    }
    // Each line keeps the exact parameter of its own corner.
    for (int w = 0; w < 2; w++)
      if (cuts[k].corner[w] && !last->corner[w]) last->t[w] = cuts[k].t[w], last->corner[w] = true;
  }
  *count = kept + 1;
  return CAG_OK;
}

static double needed_between(const Tessellator *t, const Line *line, double a, double b) {
  double from = a < b ? a : b, to = a < b ? b : a;
  const Atom *atom = &t->atoms[atom_at(t, line, from + (to - from) / 2)];
  return atom->needed * (to - from) / (atom->to - atom->from);
}

// Replaces the atoms of both lines by the common ones.
static CagStatus write_atoms(Tessellator *t, const Match *m, const Cut *cuts, size_t count,
                             uint32_t lines[2], CagError *err) {
  size_t first[2], atoms = count - 1;
  for (int w = 0; w < 2; w++) {
    first[w] = t->atom_count;
    for (size_t k = 0; k < atoms; k++) {
      // The slave may be reversed; its atoms ascend like those of every line.
      bool backwards = w == 1 && m->reversed;
      size_t from = backwards ? atoms - k : k, to = backwards ? from - 1 : from + 1;
      CagStatus status = push_atom(t, cuts[from].t[w], cuts[to].t[w], err);
      if (status) return status;
      Atom *atom = &t->atoms[t->atom_count - 1];
      atom->corner = cuts[from].corner[w];
      atom->needed = fmax(needed_between(t, m->lines[0], cuts[from].t[0], cuts[to].t[0]),
                          needed_between(t, m->lines[1], cuts[from].t[1], cuts[to].t[1]));
      atom->n = steps(atom->needed);
    }
  }
  for (int w = 0; w < 2; w++) {
    t->lines[lines[w]].atom = first[w];
    t->lines[lines[w]].atom_count = atoms;
  }
  return CAG_OK;
}

// Parameters of the slave's nodes if the map is not affine: images of the master's.
static CagStatus write_own_parameters(Tessellator *t, const Match *m, uint32_t slave,
                                      CagError *err) {
  Line *line = &t->lines[slave];
  const Line *master = m->lines[0];
  size_t nodes = 1;
  for (size_t a = 0; a < line->atom_count; a++) nodes += t->atoms[line->atom + a].n;
  line->own_parameters = cag_malloc(nodes * sizeof *line->own_parameters);
  if (!line->own_parameters) return cag_fail_memory(err);
  for (size_t a = 0, at = 0; a < line->atom_count; a++) {
    const Atom *atom = &t->atoms[line->atom + a];
    const Atom *of = &t->atoms[master->atom + (m->reversed ? line->atom_count - 1 - a : a)];
    for (size_t k = 0; k < atom->n; k++, at++) {
      double s = tess_mix(of->from, of->to, m->reversed ? atom->n - k : k, atom->n);
      line->own_parameters[at] = atom->from;
      CagStatus status = k == 0 ? CAG_OK : image(m, 0, s, &line->own_parameters[at], err);
      if (status) return status;
    }
    line->own_parameters[at] = atom->to;
  }
  return CAG_OK;
}

CagStatus cag_tess_join_lines(Tessellator *t, uint32_t master, uint32_t slave, bool reversed,
                              CagError *err) {
  Line before[2] = {t->lines[master], t->lines[slave]};
  Match m = {.t = t, .lines = {&before[0], &before[1]}, .reversed = reversed};
  for (int w = 0; w < 2; w++) {
    m.from[w] = t->atoms[before[w].atom].from;
    m.to[w] = t->atoms[before[w].atom + before[w].atom_count - 1].to;
  }
  size_t count;
  Cut *cuts = cag_malloc((before[0].atom_count + before[1].atom_count + 1) * sizeof *cuts);
  CagStatus status = cuts ? begin_match(&m, err) : cag_fail_memory(err);
  if (!status) status = common_cuts(&m, cuts, &count, err);
  if (!status) status = write_atoms(t, &m, cuts, count, (uint32_t[2]){master, slave}, err);
  if (!status) {
    t->lines[slave].joined = master;
    t->lines[slave].joined_reversed = reversed;
    m.lines[0] = &t->lines[master];
    if (!m.affine) status = write_own_parameters(t, &m, slave, err);
  }
  cag_free(cuts);
  cag_free(m.samples[0]);
  cag_free(m.samples[1]);
  return status;
}
