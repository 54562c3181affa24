// Seeds of the curves in which two surfaces meet: all pairs of triangles of their meshes whose
// boxes meet, swept along x.

#include "geom/surface/meet_seed.h"

#include <math.h>
#include <stdlib.h>

bool cag_march_fail(CagMarch *m, CagStatus status) {
  m->status = status;
  return false;
}

const double *cag_march_range(const CagMarch *m, int k, const CagMarchNode *node, int direction) {
  return m->side[k].patches.ends[direction] + node->patch[k][direction];
}

// --- Facets ---

// Parameters of a triangle's corners, brought together where they lie at both sides of a seam.
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
  CagBounds box;
} Facet;

static Facet facet_of(const CagMarchSide *side, size_t i) {
  Facet f = {.box = CAG_BOUNDS_EMPTY};
  const uint32_t *corner = side->mesh->triangles + 3 * i;
  for (int k = 0; k < 3; k++) {
    f.p[k] = side->mesh->positions[corner[k]];
    cag_bounds_add(&f.box, f.p[k]);
  }
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
    const double slack = 1e-9;
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

// The corners of f that lie on g, for facets of one plane: of a piece in common.
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

bool cag_march_add_seed(CagMarch *m, const CagMarchNode *seed) {
  if (m->seed_count == m->seed_capacity) {
    size_t capacity = m->seed_capacity ? 2 * m->seed_capacity : 256;
    CagMarchNode *grown = realloc(m->seeds, capacity * sizeof *grown);
    if (!grown) return cag_march_fail(m, cag_fail_memory(m->err));
    m->seeds = grown;
    m->seed_capacity = capacity;
  }
  m->seeds[m->seed_count++] = *seed;
  return true;
}

// The parameter of a seed on a facet of side k, in the patch that the facet lies in.
static void settle(CagMarch *m, int k, const Facet *f, int d, CagMarchNode *seed) {
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
      settle(m, k, k ? g : f, d, &sum);
    }
  sum.x = cag_scaled(sum.x, 1.0 / count);
  return cag_march_add_seed(m, &sum);
}

static bool apart(const CagBounds *a, const CagBounds *b) {
  return a->min.x > b->max.x || b->min.x > a->max.x || a->min.y > b->max.y || b->min.y > a->max.y ||
         a->min.z > b->max.z || b->min.z > a->max.z;
}

static int by_low(const void *a, const void *b) {
  const Facet *x = a, *y = b;
  return (x->box.min.x > y->box.min.x) - (x->box.min.x < y->box.min.x);
}

static double low_of(const Facet *f) { return f->box.min.x; }

// All pairs of triangles whose boxes meet, swept along x.
bool cag_march_find_seeds(CagMarch *m) {
  Facet *list[2] = {NULL, NULL};
  size_t n[2], first = 0;
  bool ok = true;
  for (int k = 0; k < 2; k++) {
    n[k] = m->side[k].mesh->triangle_count;
    list[k] = malloc((n[k] + 1) * sizeof *list[k]);
    ok = ok && list[k];
    for (size_t i = 0; ok && i < n[k]; i++) list[k][i] = facet_of(&m->side[k], i);
    if (ok && n[k]) qsort(list[k], n[k], sizeof *list[k], by_low);
  }
  if (!ok) cag_march_fail(m, cag_fail_memory(m->err));
  // The longest reach along x of a facet of the second tells how far back others may begin.
  double reach = 0;
  for (size_t i = 0; ok && i < n[1]; i++)
    reach = fmax(reach, list[1][i].box.max.x - list[1][i].box.min.x);
  for (size_t i = 0; ok && i < n[0]; i++) {
    const Facet *f = &list[0][i];
    while (first < n[1] && low_of(&list[1][first]) < f->box.min.x - reach) first++;
    for (size_t j = first; ok && j < n[1] && low_of(&list[1][j]) <= f->box.max.x; j++)
      if (!apart(&f->box, &list[1][j].box)) ok = add_seed(m, f, &list[1][j]);
  }
  free(list[0]);
  free(list[1]);
  return ok;
}
