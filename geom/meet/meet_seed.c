// Seeds of intersection curves of two surfaces, from all pairs of triangles of the two meshes whose
// boxes overlap, found by a sweep along an axis.

#include "geom/meet/meet_seed.h"

#include <math.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/sort.h"
#include "base/stop.h"
#include "geom/linalg/tolerance.h"

bool cag_march_fail(CagMarch *m, CagStatus status) {
  m->status = status;
  return false;
}

const double *cag_march_range(const CagMarch *m, int k, const CagMarchNode *node, int direction) {
  return m->side[k].patches.ends[direction] + node->patch[k][direction];
}

// --- Facets ---

// Parameters of a triangle's corners, made contiguous if they are on both sides of a seam.
static void corner_parameters(const CagMarchSide *side, const uint32_t *corner, double out[3][2]) {
  const CagSurface *s = side->s;
  const double range[2] = {s->u1 - s->u0, s->v1 - s->v0};
  const bool closed[2] = {s->closed_u, s->closed_v};
  for (int d = 0; d < 2; d++) {
    double high = -INFINITY;
    for (int k = 0; k < 3; k++) {
      out[k][d] = side->mesh->uv[2 * corner[k] + (size_t)d];
      high = fmax(high, out[k][d]);
    }
    for (int k = 0; closed[d] && k < 3; k++)
      if (high - out[k][d] > range[d] / 2) out[k][d] += range[d];
  }
}

typedef struct Facet {
  CagVec3 p[3];
  double at[3][2];
  CagVec3 normal; // unit, or zero
  CagBounds box;
  double low, high; // along the axis of the sweep
} Facet;

static Facet facet_of(const CagMarchSide *side, size_t i) {
  Facet f = {.box = CAG_BOUNDS_EMPTY};
  const uint32_t *corner = side->mesh->triangles + 3 * i;
  for (int k = 0; k < 3; k++) {
    f.p[k] = side->mesh->positions[corner[k]];
    cag_bounds_add(&f.box, f.p[k]);
  }
  f.normal = cag_unit(cag_cross(cag_sub(f.p[1], f.p[0]), cag_sub(f.p[2], f.p[0])));
  corner_parameters(side, corner, f.at);
  return f;
}

// Where the edges of f pass through g: adds points with the parameters on both to the sum.
static int pierce(const Facet *f, const Facet *g, int which, CagMarchNode *sum) {
  CagVec3 e1 = cag_sub(g->p[1], g->p[0]), e2 = cag_sub(g->p[2], g->p[0]), n = cag_cross(e1, e2);
  double nn = cag_dot(n, n);
  int count = 0;
  if (nn == 0) return 0;
  for (int k = 0; k < 3; k++) {
    int l = (k + 1) % 3;
    double h0 = cag_dot(n, cag_sub(f->p[k], g->p[0])), h1 = cag_dot(n, cag_sub(f->p[l], g->p[0]));
    if ((h0 < 0) == (h1 < 0)) continue;
    double t = h0 / (h0 - h1);
    CagVec3 x = cag_lerp(f->p[k], f->p[l], t), r = cag_sub(x, g->p[0]);
    double b = cag_dot(cag_cross(r, e2), n) / nn, c = cag_dot(cag_cross(e1, r), n) / nn;
    const double slack = CAG_COINCIDENT;
    if (b < -slack || c < -slack || b + c > 1 + slack) continue;
    for (int d = 0; d < 2; d++) {
      sum->at[which][d] += f->at[k][d] + t * (f->at[l][d] - f->at[k][d]);
      sum->at[1 - which][d] +=
          g->at[0][d] + b * (g->at[1][d] - g->at[0][d]) + c * (g->at[2][d] - g->at[0][d]);
    }
    sum->x = cag_add(sum->x, x);
    count++;
  }
  return count;
}

// The corners of f that lie on g, for coplanar facets: they may belong to a common part.
static int rest(const Facet *f, const Facet *g, int which, CagMarchNode *sum) {
  CagVec3 e1 = cag_sub(g->p[1], g->p[0]), e2 = cag_sub(g->p[2], g->p[0]), n = cag_cross(e1, e2);
  double nn = cag_dot(n, n), flat = 1e-9 * sqrt(sqrt(nn));
  int count = 0;
  if (nn == 0) return 0;
  for (int k = 0; k < 3; k++) {
    CagVec3 r = cag_sub(f->p[k], g->p[0]);
    if (fabs(cag_dot(n, r)) > flat * sqrt(nn)) return 0;
    double b = cag_dot(cag_cross(r, e2), n) / nn, c = cag_dot(cag_cross(e1, r), n) / nn;
    if (b < 0 || c < 0 || b + c > 1) continue;
    for (int d = 0; d < 2; d++) {
      sum->at[which][d] += f->at[k][d];
      sum->at[1 - which][d] +=
          g->at[0][d] + b * (g->at[1][d] - g->at[0][d]) + c * (g->at[2][d] - g->at[0][d]);
    }
    sum->x = cag_add(sum->x, f->p[k]);
    count++;
  }
  return count;
}

static double into(double x, double low, double high, bool closed) {
  if (closed && x > high) x -= high - low;
  return fmin(fmax(x, low), high);
}

bool cag_march_add_seed(CagMarch *m, CagMarchSeeds *list, const CagMarchNode *seed) {
  if (!CAG_RESERVE(list->items, list->capacity, list->count + 1))
    return cag_march_fail(m, cag_fail_memory(m->err));
  list->items[list->count++] = *seed;
  return true;
}

// The parameter of a seed on a facet of side k, in the patch that the facet lies in.
static void set_seed_parameter(CagMarch *m, int k, const Facet *f, int d, CagMarchNode *seed) {
  const CagSurface *s = m->side[k].s;
  const double low = d ? s->v0 : s->u0, high = d ? s->v1 : s->u1;
  const bool closed = d ? s->closed_v : s->closed_u;
  const double middle = (f->at[0][d] + f->at[1][d] + f->at[2][d]) / 3;
  seed->patch[k][d] = cag_patches_find(&m->side[k].patches, d, into(middle, low, high, closed));
  const double *range = cag_march_range(m, k, seed, d);
  seed->at[k][d] = fmin(fmax(into(seed->at[k][d], low, high, closed), range[0]), range[1]);
}

static bool add_seed(CagMarch *m, const Facet *f, const Facet *g) {
  CagMarchNode sum = {0};
  int count = pierce(f, g, 0, &sum) + pierce(g, f, 1, &sum);
  if (count == 0) count = rest(f, g, 0, &sum) + rest(g, f, 1, &sum);
  if (count == 0) return true;
  for (int k = 0; k < 2; k++)
    for (int d = 0; d < 2; d++) {
      sum.at[k][d] /= count;
      set_seed_parameter(m, k, k ? g : f, d, &sum);
    }
  sum.x = cag_scaled(sum.x, 1.0 / count);
  return cag_march_add_seed(m, &m->crossings, &sum);
}

// --- Seeds of touches ---

// cos 37 degrees: the normals of two facets near a touch differ by at most this angle.
#define PARALLEL 0.8
// Size of the cells of space, as a fraction of the longest step. One seed per cell is enough.
#define CELL (1.0 / 8)

// Tests whether all corners of f lie farther than the margin from the plane of g, on the same side.
static bool is_beyond(const Facet *f, const Facet *g, double margin) {
  double low = INFINITY, high = -INFINITY;
  for (int k = 0; k < 3; k++) {
    const double h = cag_dot(g->normal, cag_sub(f->p[k], g->p[0]));
    low = fmin(low, h);
    high = fmax(high, h);
  }
  return low > margin || high < -margin;
}

// Finds a point of the facet near x, and its parameters.
static CagVec3 foot_on(const Facet *f, CagVec3 x, double at[2]) {
  const CagVec3 e1 = cag_sub(f->p[1], f->p[0]), e2 = cag_sub(f->p[2], f->p[0]),
                n = cag_cross(e1, e2), r = cag_sub(x, f->p[0]);
  const double nn = cag_dot(n, n);
  double b = fmax(0, cag_dot(cag_cross(r, e2), n) / nn),
         c = fmax(0, cag_dot(cag_cross(e1, r), n) / nn);
  if (b + c > 1) {
    const double sum = b + c;
    b /= sum;
    c /= sum;
  }
  for (int d = 0; d < 2; d++)
    at[d] = f->at[0][d] + b * (f->at[1][d] - f->at[0][d]) + c * (f->at[2][d] - f->at[0][d]);
  return cag_madd(cag_madd(f->p[0], b, e1), c, e2);
}

static bool add_touch_seed(CagMarch *m, const Facet *f, const Facet *g, double margin) {
  if (!(fabs(cag_dot(f->normal, g->normal)) > PARALLEL) || is_beyond(f, g, margin) ||
      is_beyond(g, f, margin))
    return true;
  CagMarchNode seed = {0};
  const CagVec3 middle = cag_scaled(cag_add(f->p[0], cag_add(f->p[1], f->p[2])), 1.0 / 3);
  const CagVec3 on_g = foot_on(g, middle, seed.at[1]), on_f = foot_on(f, on_g, seed.at[0]);
  seed.x = cag_lerp(on_f, on_g, 0.5);
  for (int k = 0; k < 2; k++)
    for (int d = 0; d < 2; d++) set_seed_parameter(m, k, k ? g : f, d, &seed);
  return cag_march_add_seed(m, &m->touches, &seed);
}

// A seed's patches, cell of space, and index.
typedef struct CellSeed {
  size_t patch[4];
  double cell[3];
  size_t number;
} CellSeed;

static int compare_cells(const CellSeed *x, const CellSeed *y) {
  for (int k = 0; k < 4; k++)
    if (x->patch[k] != y->patch[k]) return x->patch[k] > y->patch[k] ? 1 : -1;
  for (int k = 0; k < 3; k++)
    if (x->cell[k] != y->cell[k]) return x->cell[k] > y->cell[k] ? 1 : -1;
  return 0;
}

static int by_cell(const void *a, const void *b) {
  const CellSeed *x = a, *y = b;
  const int order = compare_cells(x, y);
  return order ? order : (x->number > y->number) - (x->number < y->number);
}

// Keeps only the first seed of each cell.
static bool thin_seeds(CagMarch *m, CagMarchSeeds *seeds) {
  const double width = CELL * m->step_most;
  CellSeed *list = cag_malloc((seeds->count + 1) * sizeof *list);
  CagMarchNode *kept = cag_malloc((seeds->count + 1) * sizeof *kept);
  size_t n = 0;
  for (size_t i = 0; list && i < seeds->count; i++) {
    const CagMarchNode *s = &seeds->items[i];
    list[i] = (CellSeed){{s->patch[0][0], s->patch[0][1], s->patch[1][0], s->patch[1][1]},
                         {floor(s->x.x / width), floor(s->x.y / width), floor(s->x.z / width)},
                         i};
  }
  const bool ok = list && kept;
  const CagStatus status =
      ok ? cag_sort(list, seeds->count, sizeof *list, by_cell, m->err) : cag_fail_memory(m->err);
  for (size_t i = 0; !status && i < seeds->count; i++)
    if (i == 0 || compare_cells(&list[i - 1], &list[i]) != 0)
      kept[n++] = seeds->items[list[i].number];
  cag_free(list);
  if (status) {
    cag_free(kept);
    return cag_march_fail(m, status);
  }
  cag_free(seeds->items);
  *seeds = (CagMarchSeeds){kept, n, seeds->count + 1};
  return true;
}

// --- Pairs of facets ---

// Tests whether boxes are farther apart than the margin.
static bool are_apart(const CagBounds *a, const CagBounds *b, double margin) {
  return a->min.x > b->max.x + margin || b->min.x > a->max.x + margin ||
         a->min.y > b->max.y + margin || b->min.y > a->max.y + margin ||
         a->min.z > b->max.z + margin || b->min.z > a->max.z + margin;
}

static bool add_seeds(CagMarch *m, const Facet *f, const Facet *g, double margin) {
  if (are_apart(&f->box, &g->box, margin)) return true;
  return (are_apart(&f->box, &g->box, 0) || add_seed(m, f, g)) && add_touch_seed(m, f, g, margin);
}

static int by_low(const void *a, const void *b) {
  const Facet *x = a, *y = b;
  return (x->low > y->low) - (x->low < y->low);
}

static double component(CagVec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

// The axis along which the mesh is longest.
static int longest_axis(const CagMesh *mesh) {
  const CagBounds box = cag_mesh_bounds(mesh);
  const CagVec3 d = cag_sub(box.max, box.min);
  return d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
}

bool cag_march_find_seeds(CagMarch *m, double margin) {
  Facet *list[2] = {NULL, NULL};
  size_t n[2], first = 0;
  bool ok = true;
  const int axis = longest_axis(m->side[0].mesh);
  for (int k = 0; k < 2; k++) {
    n[k] = m->side[k].mesh->triangle_count;
    list[k] = cag_malloc((n[k] + 1) * sizeof *list[k]);
    ok = ok && list[k];
    for (size_t i = 0; ok && i < n[k]; i++) {
      list[k][i] = facet_of(&m->side[k], i);
      list[k][i].low = component(list[k][i].box.min, axis);
      list[k][i].high = component(list[k][i].box.max, axis);
    }
    if (!list[k]) cag_march_fail(m, cag_fail_memory(m->err));
    else if (ok && cag_sort(list[k], n[k], sizeof *list[k], by_low, m->err))
      ok = cag_march_fail(m, m->err->status);
  }
  // The greatest extent of a facet of the second mesh along the axis determines how far back the
  // sweep must look.
  double reach = margin;
  for (size_t i = 0; ok && i < n[1]; i++)
    reach = fmax(reach, list[1][i].high - list[1][i].low + margin);
  for (size_t i = 0; ok && i < n[0]; i++) {
    const Facet *f = &list[0][i];
    while (first < n[1] && list[1][first].low < f->low - reach) first++;
    for (size_t j = first; ok && j < n[1] && list[1][j].low <= f->high + margin; j++) {
      ok = add_seeds(m, f, &list[1][j], margin);
      if (cag_stopped()) ok = cag_march_fail(m, cag_stop_fail(m->err));
    }
  }
  cag_free(list[0]);
  cag_free(list[1]);
  return ok && thin_seeds(m, &m->touches);
}
