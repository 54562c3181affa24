// Clips curves, surfaces, and open meshes to a solid.
//
// A surface is clipped as its mesh. Triangles near the solid's boundary are split until their edges
// are short relative to the curvature of a boundary of the solid's size. An edge that is split for
// one triangle is split for its neighbor too, so no gap opens. Then each edge with one end inside
// is cut at its crossing, found by bisection, and each triangle keeps its inner part.

#include "geom/solid/clip.h"

#include <math.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/solid/csg.h"
#include "geom/solid/inside.h"
#include "geom/tessellate/sides.h"

// --- Curves ---

#define SAMPLES 256
#define BISECTIONS 60 // number of bits of a double

typedef struct Pieces {
  CagCurve **at;
  size_t n;
} Pieces;

static CagStatus holds_at(CagInside *in, const CagCurve *c, double t, bool *out, CagError *err) {
  CagVec3 p;
  CagStatus status = cag_curve_point(c, t, &p, err);
  return status ? status : cag_inside_holds(in, p, out, err);
}

// The inner end of the change between a (inside as given by `first`) and b.
static CagStatus crossing(CagInside *in, const CagCurve *c, double a, double b, bool first,
                          double *out, CagError *err) {
  for (int i = 0; i < BISECTIONS; i++) {
    double middle = a + (b - a) / 2;
    bool inner;
    if (middle == a || middle == b) break;
    CagStatus status = holds_at(in, c, middle, &inner, err);
    if (status) return status;
    *(inner == first ? &a : &b) = middle;
  }
  *out = first ? a : b;
  return CAG_OK;
}

static CagStatus add_piece(Pieces *p, const CagCurve *c, double from, double to, CagError *err) {
  if (!(to > from)) return CAG_OK;
  if (!CAG_RESIZE(p->at, p->n + 1)) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  if (from == c->start && to == c->end) p->at[p->n] = cag_curve_retain(c);
  else status = cag_curve_trim(c, from, to, &p->at[p->n], err);
  if (!status) p->n++;
  return status;
}

// The parameters to test: equally spaced between the curve's breaks.
static CagStatus looked_at(const CagCurve *c, double **out, size_t *n, CagError *err) {
  size_t breaks = c->kind->breaks ? c->kind->breaks(c, NULL, 0) : 0;
  double *at = cag_malloc((breaks + 2) * sizeof *at);
  double *t = cag_malloc(((breaks + 1) * SAMPLES + 1) * sizeof *t);
  if (!at || !t) {
    cag_free(at);
    cag_free(t);
    return cag_fail_memory(err);
  }
  at[0] = c->start;
  if (breaks) c->kind->breaks(c, at + 1, breaks);
  at[breaks + 1] = c->end;
  *n = 0;
  for (size_t i = 0; i <= breaks; i++)
    for (int k = 0; k < SAMPLES; k++)
      t[(*n)++] = at[i] + (at[i + 1] - at[i]) * ((double)k / SAMPLES);
  t[(*n)++] = c->end;
  cag_free(at);
  *out = t;
  return CAG_OK;
}

static CagStatus clip_samples(CagInside *in, const CagCurve *c, const double *t, size_t n,
                              const volatile int *interrupt, Pieces *pieces, CagError *err) {
  bool inner, last = false;
  double from = c->start;
  CagStatus status = holds_at(in, c, c->start, &last, err);
  for (size_t i = 1; !status && i < n; i++) {
    if (interrupt && *interrupt)
      return cag_fail(err, CAG_E_CALLBACK, CAG_ERR_interrupted, "", -1,
                      "the clipping was interrupted");
    status = holds_at(in, c, t[i], &inner, err);
    if (status || inner == last) continue;
    double at = t[i];
    status = crossing(in, c, t[i - 1], t[i], last, &at, err);
    if (!status && last) status = add_piece(pieces, c, from, at, err);
    from = at;
    last = inner;
  }
  if (!status && last) status = add_piece(pieces, c, from, t[n - 1], err);
  return status;
}

CagStatus cag_curve_clip(const CagCurve *c, const CagSolid *by, const volatile int *interrupt,
                         CagCurve ***out, size_t *n, CagError *err) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagInside *in = NULL;
  Pieces pieces = {NULL, 0};
  double *t = NULL;
  size_t count = 0;
  how.interrupt = interrupt;
  CagStatus status = looked_at(c, &t, &count, err);
  if (!status) status = cag_inside_new(by, &how, &in, err);
  if (!status) status = clip_samples(in, c, t, count, interrupt, &pieces, err);
  cag_inside_free(in);
  cag_free(t);
  if (status) {
    for (size_t i = 0; i < pieces.n; i++) cag_curve_release(pieces.at[i]);
    cag_free(pieces.at);
    return status;
  }
  *out = pieces.at;
  *n = pieces.n;
  return CAG_OK;
}

// --- Meshes being cut ---

// Points with their parameters; triangles; and the cuts of edges in the current pass.
typedef struct Work {
  const CagSurface *surface; // NULL: points on edges are on the chords
  CagInside *in;
  const CagTessellation *how;
  double chord; // edges near the boundary are split down to this length
  CagBounds reach;
  CagVec3 *p;
  double *uv;
  signed char *inner; // 1, 0, -1: unknown
  size_t n, capacity;
  uint32_t *t;
  size_t triangles, room;
  uint64_t *keys; // open addressing; 0: free, else both ends + 1
  uint32_t *cut;
  size_t slots;
} Work;

#define NOT_CUT UINT32_MAX

static void work_free(Work *w) {
  cag_inside_free(w->in);
  cag_free(w->p);
  cag_free(w->uv);
  cag_free(w->inner);
  cag_free(w->t);
  cag_free(w->keys);
  cag_free(w->cut);
}

static CagStatus room_for_points(Work *w, CagError *err) {
  if (w->n < w->capacity) return CAG_OK;
  size_t capacity = w->capacity ? 2 * w->capacity : 64;
  if (!CAG_RESIZE(w->p, capacity) || !CAG_RESIZE(w->uv, 2 * capacity) ||
      !CAG_RESIZE(w->inner, capacity))
    return cag_fail_memory(err);
  w->capacity = capacity;
  return CAG_OK;
}

static CagStatus add_triangle(Work *w, uint32_t a, uint32_t b, uint32_t c, CagError *err) {
  if (w->triangles == w->room) {
    size_t room = w->room ? 2 * w->room : 64;
    if (!CAG_RESIZE(w->t, 3 * room)) return cag_fail_memory(err);
    w->room = room;
  }
  if (a == b || b == c || c == a) return CAG_OK;
  if (w->triangles >= w->how->max_triangles)
    return cag_fail(
        err, CAG_E_LIMIT, CAG_ERR_limit_triangles, "tolerance", -1,
        "the part within the solid needs more than %zu triangles; use a larger tolerance",
        w->how->max_triangles);
  uint32_t *t = w->t + 3 * w->triangles++;
  t[0] = a, t[1] = b, t[2] = c;
  return CAG_OK;
}

static CagStatus is_inner(Work *w, uint32_t i, bool *out, CagError *err) {
  CagStatus status = CAG_OK;
  if (w->inner[i] < 0) {
    bool inner = false;
    status = cag_inside_holds(w->in, w->p[i], &inner, err);
    w->inner[i] = inner;
  }
  *out = w->inner[i] > 0;
  return status;
}

static CagStatus clear_cuts(Work *w, size_t edges, CagError *err) {
  size_t slots = 64;
  while (slots < 2 * edges) slots *= 2;
  if (slots > w->slots) {
    cag_free(w->keys);
    cag_free(w->cut);
    w->keys = cag_malloc(slots * sizeof *w->keys);
    w->cut = cag_malloc(slots * sizeof *w->cut);
    w->slots = slots;
    if (!w->keys || !w->cut) return cag_fail_memory(err);
  }
  memset(w->keys, 0, w->slots * sizeof *w->keys);
  return CAG_OK;
}

// The slot of an edge; a new one has no cut.
static uint32_t *slot(Work *w, uint32_t a, uint32_t b) {
  uint32_t low = a < b ? a : b, high = a < b ? b : a;
  uint64_t key = ((uint64_t)low << 32 | high) + 1;
  size_t i = (size_t)((key * 0x9e3779b97f4a7c15u) >> 32) & (w->slots - 1);
  while (w->keys[i] && w->keys[i] != key) i = (i + 1) & (w->slots - 1);
  if (!w->keys[i]) w->keys[i] = key, w->cut[i] = NOT_CUT;
  return &w->cut[i];
}

// The point at a fraction of an edge: on the surface if its parameters lead there, else on the
// chord.
static void edge_point(const Work *w, uint32_t a, uint32_t b, double f, CagVec3 *p, double uv[2]) {
  CagError err;
  CagVec3 chord = cag_lerp(w->p[a], w->p[b], f), exact;
  for (int k = 0; k < 2; k++) uv[k] = w->uv[2 * a + k] + f * (w->uv[2 * b + k] - w->uv[2 * a + k]);
  *p = chord;
  if (!w->surface || f == 0 || f == 1) return;
  if (cag_surface_point(w->surface, uv[0], uv[1], &exact, &err)) return;
  if (cag_norm(cag_sub(exact, chord)) <= 0.25 * cag_norm(cag_sub(w->p[a], w->p[b]))) *p = exact;
}

static CagStatus add_point(Work *w, CagVec3 p, const double uv[2], int inner, uint32_t *out,
                           CagError *err) {
  CagStatus status = room_for_points(w, err);
  if (status) return status;
  w->p[w->n] = p;
  w->uv[2 * w->n] = uv[0];
  w->uv[2 * w->n + 1] = uv[1];
  w->inner[w->n] = (signed char)inner;
  *out = (uint32_t)w->n++;
  return CAG_OK;
}

// --- Splitting ---

static double edge_length(const Work *w, uint32_t a, uint32_t b) {
  return cag_norm(cag_sub(w->p[a], w->p[b]));
}

// Triangles are split if the boundary passes between their corners, or if they are so large that
// the whole solid may be inside.
static CagStatus wants_split(Work *w, const uint32_t *t, bool *out, CagError *err) {
  CagBounds box = CAG_BOUNDS_EMPTY;
  int inner = 0;
  double longest = 0;
  for (int k = 0; k < 3; k++) {
    bool in;
    CagStatus status = is_inner(w, t[k], &in, err);
    if (status) return status;
    inner += in;
    cag_bounds_add(&box, w->p[t[k]]);
    longest = fmax(longest, edge_length(w, t[k], t[(k + 1) % 3]));
  }
  const double coarse = 4; // chords
  bool near = box.max.x >= w->reach.min.x && box.min.x <= w->reach.max.x &&
              box.max.y >= w->reach.min.y && box.min.y <= w->reach.max.y &&
              box.max.z >= w->reach.min.z && box.min.z <= w->reach.max.z;
  *out = (inner > 0 && inner < 3 && longest > w->chord) || (near && longest > coarse * w->chord);
  return CAG_OK;
}

static CagStatus split_edge(Work *w, uint32_t a, uint32_t b, CagError *err) {
  CagVec3 p;
  double uv[2];
  if (edge_length(w, a, b) <= w->chord) return CAG_OK;
  uint32_t *at = slot(w, a, b), made;
  if (*at != NOT_CUT) return CAG_OK;
  edge_point(w, a < b ? a : b, a < b ? b : a, 0.5, &p, uv);
  CagStatus status = add_point(w, p, uv, -1, &made, err);
  if (!status) *at = made;
  return status;
}

// Divides a triangle by the cuts of its edges.
static CagStatus divide(Work *w, const uint32_t *t, CagError *err) {
  uint32_t m[3];
  int n = 0, whole = 0, only = 0;
  for (int k = 0; k < 3; k++) {
    m[k] = *slot(w, t[k], t[(k + 1) % 3]);
    if (m[k] != NOT_CUT) n++, only = k;
    else whole = k;
  }
  CagStatus status = CAG_OK;
  if (n == 0) return add_triangle(w, t[0], t[1], t[2], err);
  if (n == 1) {
    uint32_t a = t[only], b = t[(only + 1) % 3], c = t[(only + 2) % 3];
    status = add_triangle(w, a, m[only], c, err);
    return status ? status : add_triangle(w, m[only], b, c, err);
  }
  if (n == 2) { // the edge a-b is not cut
    uint32_t a = t[whole], b = t[(whole + 1) % 3], c = t[(whole + 2) % 3];
    uint32_t bc = m[(whole + 1) % 3], ca = m[(whole + 2) % 3];
    status = add_triangle(w, ca, bc, c, err);
    bool first = edge_length(w, a, bc) <= edge_length(w, b, ca);
    if (!status) status = first ? add_triangle(w, a, b, bc, err) : add_triangle(w, a, b, ca, err);
    if (!status) status = first ? add_triangle(w, a, bc, ca, err) : add_triangle(w, b, bc, ca, err);
    return status;
  }
  status = add_triangle(w, m[0], m[1], m[2], err);
  for (int k = 0; !status && k < 3; k++) status = add_triangle(w, t[k], m[k], m[(k + 2) % 3], err);
  return status;
}

// One pass; *changed: something was split.
static CagStatus split_pass(Work *w, bool *changed, CagError *err) {
  CagStatus status = clear_cuts(w, 3 * w->triangles, err);
  size_t points = w->n;
  for (size_t i = 0; !status && i < w->triangles; i++) {
    const uint32_t *t = w->t + 3 * i;
    bool split;
    status = wants_split(w, t, &split, err);
    for (int k = 0; !status && split && k < 3; k++)
      status = split_edge(w, t[k], t[(k + 1) % 3], err);
    if (!status && w->how->interrupt && *w->how->interrupt)
      status = cag_fail(err, CAG_E_CALLBACK, CAG_ERR_interrupted, "", -1,
                        "the clipping was interrupted");
  }
  *changed = !status && w->n > points;
  if (!*changed) return status;
  uint32_t *before = w->t;
  size_t count = w->triangles;
  w->t = NULL;
  w->triangles = w->room = 0;
  for (size_t i = 0; !status && i < count; i++) status = divide(w, before + 3 * i, err);
  cag_free(before);
  return status;
}

// --- Cutting ---

// The point of an edge at which the inside ends, made once for both triangles.
static CagStatus cut_edge(Work *w, uint32_t a, uint32_t b, uint32_t *out, CagError *err) {
  uint32_t *at = slot(w, a, b);
  *out = *at;
  if (*at != NOT_CUT) return CAG_OK;
  double in = 0, outside = 1, uv[2];
  CagVec3 p;
  const int halvings = 48; // enough to reduce an edge to rounding
  for (int i = 0; i < halvings; i++) {
    bool inner;
    edge_point(w, a, b, (in + outside) / 2, &p, uv);
    CagStatus status = cag_inside_holds(w->in, p, &inner, err);
    if (status) return status;
    *(inner ? &in : &outside) = (in + outside) / 2;
  }
  // A cut that rounds to the inner end is replaced by that end.
  if (in < 1e-9) *out = a;
  else {
    edge_point(w, a, b, in, &p, uv);
    CagStatus status = add_point(w, p, uv, 1, out, err);
    if (status) return status;
  }
  *slot(w, a, b) = *out;
  return CAG_OK;
}

static CagStatus cut_triangle(Work *w, const uint32_t *t, CagError *err) {
  uint32_t kept[4];
  int n = 0;
  CagStatus status = CAG_OK;
  for (int k = 0; !status && k < 3; k++) {
    uint32_t a = t[k], b = t[(k + 1) % 3];
    bool in_a = w->inner[a] > 0, in_b = w->inner[b] > 0;
    if (in_a) kept[n++] = a;
    if (in_a != in_b) status = cut_edge(w, in_a ? a : b, in_a ? b : a, &kept[n++], err);
  }
  if (!status && n >= 3) status = add_triangle(w, kept[0], kept[1], kept[2], err);
  if (!status && n == 4) status = add_triangle(w, kept[0], kept[2], kept[3], err);
  return status;
}

static CagStatus cut_all(Work *w, CagError *err) {
  CagStatus status = clear_cuts(w, 3 * w->triangles, err);
  bool unused;
  for (uint32_t i = 0; !status && i < w->n; i++) status = is_inner(w, i, &unused, err);
  if (status) return status;
  uint32_t *before = w->t;
  size_t count = w->triangles;
  w->t = NULL;
  w->triangles = w->room = 0;
  for (size_t i = 0; !status && i < count; i++) {
    const uint32_t t[3] = {before[3 * i], before[3 * i + 1], before[3 * i + 2]};
    status = cut_triangle(w, t, err);
  }
  cag_free(before);
  return status;
}

// --- Results ---

static CagVec3 normal_at(const Work *w, uint32_t i, CagVec3 fallback) {
  CagError err;
  CagVec3 n;
  const CagSurface *s = w->surface;
  if (s && !cag_surface_normal(s, w->uv[2 * i], w->uv[2 * i + 1], &n, &err)) return n;
  return fallback;
}

// Collects the points used by triangles, in order.
static CagStatus make_mesh(Work *w, CagMesh **out, CagError *err) {
  uint32_t *number = cag_malloc((w->n + 1) * sizeof *number);
  if (!number) return cag_fail_memory(err);
  size_t used = 0;
  for (size_t i = 0; i < w->n; i++) number[i] = NOT_CUT;
  for (size_t i = 0; i < 3 * w->triangles; i++)
    if (number[w->t[i]] == NOT_CUT) number[w->t[i]] = (uint32_t)used++;
  CagMesh *m = NULL;
  bool curved = w->surface != NULL;
  CagStatus status = cag_mesh_new(used, w->triangles, curved, curved, false, &m, err);
  for (uint32_t i = 0; !status && i < w->n; i++) {
    if (number[i] == NOT_CUT) continue;
    m->positions[number[i]] = w->p[i];
    if (!curved) continue;
    memcpy(m->uv + 2 * number[i], w->uv + 2 * i, 2 * sizeof(double));
    m->normals[number[i]] = cag_vec3(0, 0, 0);
  }
  for (size_t i = 0; !status && i < w->triangles; i++) {
    const uint32_t *t = w->t + 3 * i;
    CagVec3 face =
        cag_unit(cag_cross(cag_sub(w->p[t[1]], w->p[t[0]]), cag_sub(w->p[t[2]], w->p[t[0]])));
    for (int k = 0; k < 3; k++) {
      m->triangles[3 * i + k] = number[t[k]];
      if (curved) m->normals[number[t[k]]] = normal_at(w, t[k], face);
    }
  }
  cag_free(number);
  if (!status && curved)
    status = cag_mesh_split_sides(m, 0, m->triangle_count, w->surface, w->how->angle, 0, err);
  if (!status) *out = m;
  else cag_mesh_release(m);
  return status;
}

static CagStatus fill(Work *w, const CagMesh *m, CagError *err) {
  const double none[2] = {0, 0};
  CagStatus status = CAG_OK;
  uint32_t made;
  for (size_t i = 0; !status && i < m->vertex_count; i++)
    status = add_point(w, m->positions[i], m->uv ? m->uv + 2 * i : none, -1, &made, err);
  for (size_t i = 0; !status && i < m->triangle_count; i++) {
    const uint32_t *t = m->triangles + 3 * i;
    status = add_triangle(w, t[0], t[1], t[2], err);
  }
  return status;
}

static double common_size(const CagBounds *a, const CagBounds *b) {
  CagVec3 d = cag_vec3(fmin(a->max.x, b->max.x) - fmax(a->min.x, b->min.x),
                       fmin(a->max.y, b->max.y) - fmax(a->min.y, b->min.y),
                       fmin(a->max.z, b->max.z) - fmax(a->min.z, b->min.z));
  if (!(d.x >= 0 && d.y >= 0 && d.z >= 0)) return 0;
  return cag_norm(d);
}

static CagStatus clip(const CagSurface *s, const CagMesh *m, const CagSolid *by,
                      const CagTessellation *how, CagMesh **out, CagError *err) {
  Work w = {.surface = s, .how = how};
  CagBounds box = cag_mesh_bounds(m);
  CagStatus status = cag_solid_reach(by, &w.reach, err);
  if (status) return status;
  double size = common_size(&box, &w.reach);
  if (m->triangle_count == 0 || !(size > 0))
    return cag_mesh_new(0, 0, false, false, false, out, err);
  // The chord of an arc of a typical radius whose sag is the tolerance.
  double tolerance = how->tolerance > 0 ? how->tolerance : 1e-3 * size;
  w.chord = sqrt(2 * tolerance * size);
  status = cag_inside_new(by, how, &w.in, err);
  if (!status) status = fill(&w, m, err);
  for (bool changed = true; !status && changed;) status = split_pass(&w, &changed, err);
  if (!status) status = cut_all(&w, err);
  if (!status) status = make_mesh(&w, out, err);
  work_free(&w);
  return status;
}

CagStatus cag_mesh_clip(const CagMesh *m, const CagSolid *by, const CagTessellation *how,
                        CagMesh **out, CagError *err) {
  return clip(NULL, m, by, how, out, err);
}

CagStatus cag_surface_clip(const CagSurface *s, const CagSolid *by, const CagTessellation *how,
                           CagMesh **out, CagError *err) {
  CagMesh *m;
  CagStatus status = cag_surface_tessellate(s, how, &m, err);
  if (status) return status;
  status = clip(s, m, by, how, out, err);
  cag_mesh_release(m);
  return status;
}
