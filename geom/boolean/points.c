// Points of a set operation: corners of the operands, and exact points of intersection.
//
// Each point also has its coordinates rounded to the nearest doubles. Rounding is monotone: if two
// rounded coordinates differ, the exact ones differ the same way. Other predicates are evaluated on
// the rounded points first, with an error bound, and exactly only if the bound does not decide.

#include <float.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/boolean/work.h"
#include "geom/mesh/predicates.h"

#define UNIT (DBL_EPSILON / 2)
// Limbs for one computation. Coordinates have at most 2150 bits. A corner moved onto three planes
// takes 7 times that, and an intersection of planes through such corners about 60 times, 2000
// limbs; fewer than 500 such numbers are made at a time.
#define SPACE_LIMBS ((size_t)1 << 20)
#define BLOCK_LIMBS ((size_t)1 << 14)

static int sign(double x) { return (x > 0) - (x < 0); }
static double coordinate(CagVec3 p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }
static CagVec3 seen_along(CagVec3 p, int axis) {
  return axis == 0   ? cag_vec3(p.y, p.z, 0)
         : axis == 1 ? cag_vec3(p.z, p.x, 0)
                     : cag_vec3(p.x, p.y, 0);
}

bool cag_bool_list_reserve(BoolList *l, size_t n, size_t item_size) {
  return cag_array_reserve(&l->items, &l->room, n, item_size);
}

// --- The table ---

bool cag_bool_points_start(BoolPoints *p, size_t expected) {
  *p = (BoolPoints){0};
  p->room = expected + 64;
  size_t slots = 1024;
  while (slots < 2 * p->room) slots *= 2;
  p->mask = slots - 1;
  p->at = cag_malloc(p->room * sizeof *p->at);
  p->exact = cag_malloc(p->room * sizeof *p->exact);
  p->next = cag_malloc(p->room * sizeof *p->next);
  p->heads = cag_malloc(slots * sizeof *p->heads);
  p->space.size = SPACE_LIMBS;
  p->space.limbs = cag_malloc(SPACE_LIMBS * sizeof *p->space.limbs);
  if (!p->at || !p->exact || !p->next || !p->heads || !p->space.limbs) return false;
  memset(p->heads, 0xff, slots * sizeof *p->heads);
  return true;
}

void cag_bool_points_free(BoolPoints *p) {
  while (p->blocks) {
    BoolBlock *next = p->blocks->next;
    cag_free(p->blocks);
    p->blocks = next;
  }
  cag_free(p->at);
  cag_free(p->exact);
  cag_free(p->next);
  cag_free(p->heads);
  cag_free(p->coordinates.items);
  cag_free(p->space.limbs);
}

static uint64_t mix(uint64_t h) {
  h ^= h >> 33;
  h *= 0xff51afd7ed558ccdu; // constants of MurmurHash3's finisher
  h ^= h >> 33;
  h *= 0xc4ceb9fe1a85ec53u;
  return h ^ h >> 33;
}

static size_t slot(const BoolPoints *p, CagVec3 at) {
  uint64_t bits[3];
  memcpy(bits, &at, sizeof bits);
  return mix(bits[0] + mix(bits[1] + mix(bits[2] + 1))) & p->mask;
}

static bool grow_points(BoolPoints *p) {
  if (p->n < p->room) return true;
  if (p->n >= UINT32_MAX / 4) return false;
  const size_t room = p->room + p->room / 2;
  if (!CAG_RESIZE(p->at, room) || !CAG_RESIZE(p->exact, room) || !CAG_RESIZE(p->next, room))
    return false;
  p->room = room;
  return true;
}

static uint32_t append_point(BoolPoints *p, CagVec3 at, uint32_t exact) {
  if (!grow_points(p)) return BOOL_NONE;
  p->at[p->n] = at;
  p->exact[p->n] = exact;
  return (uint32_t)p->n++;
}

static void enter_point(BoolPoints *p, uint32_t i) {
  uint32_t *head = &p->heads[slot(p, p->at[i])];
  p->next[i] = *head;
  *head = i;
}

static bool same_place(CagVec3 a, CagVec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

uint32_t cag_bool_points_add(BoolPoints *p, CagVec3 at) {
  at = cag_vec3(at.x + 0.0, at.y + 0.0, at.z + 0.0); // merges the two zeros
  for (uint32_t i = p->heads[slot(p, at)]; i != BOOL_NONE; i = p->next[i])
    if (p->exact[i] == BOOL_NONE && same_place(p->at[i], at)) return i;
  const uint32_t i = append_point(p, at, BOOL_NONE);
  if (i != BOOL_NONE) enter_point(p, i);
  return i;
}

uint32_t cag_bool_points_first(const BoolPoints *p, uint32_t i) {
  uint32_t first = i;
  for (uint32_t k = p->heads[slot(p, p->at[i])]; k != BOOL_NONE; k = p->next[k])
    if (k < first && same_place(p->at[k], p->at[i])) first = k;
  return first;
}

uint32_t cag_bool_points_add_far(BoolPoints *p, CagVec3 at) {
  return append_point(p, at, BOOL_NONE);
}

// --- Exact coordinates ---

static CagExact one_of(BoolPoints *p) { return cag_exact(&p->space, 1); }

static BoolHomogeneous exact_point(BoolPoints *p, uint32_t i) {
  if (p->exact[i] != BOOL_NONE) return ((const BoolHomogeneous *)p->coordinates.items)[p->exact[i]];
  CagExactSpace *s = &p->space;
  const CagVec3 at = p->at[i];
  return (BoolHomogeneous){cag_exact(s, at.x), cag_exact(s, at.y), cag_exact(s, at.z), one_of(p)};
}

static CagExact part(const BoolHomogeneous *h, int axis) {
  return axis == 0 ? h->x : axis == 1 ? h->y : h->z;
}

static CagExact times(BoolPoints *p, CagExact a, CagExact b) {
  return cag_exact_product(&p->space, a, b);
}

static bool keep(BoolPoints *p, CagExact *x) {
  const size_t n = (size_t)x->n;
  if (n == 0) return true;
  if (!p->blocks || p->blocks->used + n > p->blocks->size) {
    const size_t size = n > BLOCK_LIMBS ? n : BLOCK_LIMBS;
    BoolBlock *block = cag_malloc(sizeof *block + size * sizeof *block->limbs);
    if (!block) return false;
    block->next = p->blocks;
    block->used = 0;
    block->size = size;
    p->blocks = block;
  }
  uint64_t *to = p->blocks->limbs + p->blocks->used;
  p->blocks->used += n;
  memcpy(to, x->limb, n * sizeof *to);
  x->limb = to;
  return true;
}

static bool same_exactly(BoolPoints *p, uint32_t i, const BoolHomogeneous *h) {
  const size_t mark = p->space.used;
  const BoolHomogeneous other = exact_point(p, i);
  bool same = true;
  for (int axis = 0; axis < 3 && same; axis++) {
    const CagExact a = times(p, part(&other, axis), h->w), b = times(p, part(h, axis), other.w);
    same = cag_exact_difference(&p->space, a, b).sign == 0;
  }
  p->space.used = mark;
  return same;
}

static uint32_t append_exact(BoolPoints *p, CagVec3 at, BoolHomogeneous h) {
  const size_t k = p->coordinates.n;
  if (!cag_bool_list_reserve(&p->coordinates, k + 1, sizeof h)) return BOOL_NONE;
  if (!keep(p, &h.x) || !keep(p, &h.y) || !keep(p, &h.z) || !keep(p, &h.w)) return BOOL_NONE;
  const uint32_t i = append_point(p, at, (uint32_t)k);
  if (i == BOOL_NONE) return i;
  ((BoolHomogeneous *)p->coordinates.items)[k] = h;
  p->coordinates.n++;
  return i;
}

static BoolHomogeneous positive(BoolHomogeneous h) {
  if (h.w.sign > 0) return h;
  return (BoolHomogeneous){cag_exact_negative(h.x), cag_exact_negative(h.y),
                           cag_exact_negative(h.z), cag_exact_negative(h.w)};
}

static CagVec3 rounded(BoolPoints *p, const BoolHomogeneous *h) {
  CagExactSpace *s = &p->space;
  return cag_vec3(cag_exact_quotient(s, h->x, h->w), cag_exact_quotient(s, h->y, h->w),
                  cag_exact_quotient(s, h->z, h->w));
}

// The number of the point, added if it is new.
static uint32_t add_exact(BoolPoints *p, BoolHomogeneous h) {
  h = positive(h);
  const CagVec3 at = rounded(p, &h);
  for (uint32_t i = p->heads[slot(p, at)]; i != BOOL_NONE; i = p->next[i])
    if (same_place(p->at[i], at) && same_exactly(p, i, &h)) return i;
  const uint32_t i = append_exact(p, at, h);
  if (i != BOOL_NONE) enter_point(p, i);
  return i;
}

// --- Order and turns ---

int cag_bool_compare(BoolPoints *p, uint32_t a, uint32_t b, int axis) {
  const double x = coordinate(p->at[a], axis), y = coordinate(p->at[b], axis);
  if (x != y) return y > x ? 1 : -1;
  if (a == b || (p->exact[a] == BOOL_NONE && p->exact[b] == BOOL_NONE)) return 0;
  p->space.used = 0;
  const BoolHomogeneous g = exact_point(p, a), h = exact_point(p, b);
  return cag_exact_difference(&p->space, times(p, part(&h, axis), g.w),
                              times(p, part(&g, axis), h.w))
      .sign;
}

int cag_bool_compare_all(BoolPoints *p, uint32_t a, uint32_t b) {
  int order = 0;
  for (int axis = 0; axis < 3 && order == 0 && a != b; axis++)
    order = cag_bool_compare(p, a, b, axis);
  return order;
}

static int exact_turn(BoolPoints *p, const uint32_t v[3], int axis) {
  p->space.used = 0;
  const int first = (axis + 1) % 3, second = (axis + 2) % 3;
  BoolHomogeneous h[3];
  for (int i = 0; i < 3; i++) h[i] = exact_point(p, v[i]);
  CagExact sum = {0};
  for (int i = 0; i < 3; i++) {
    const BoolHomogeneous *q = &h[(i + 1) % 3], *r = &h[(i + 2) % 3];
    const CagExact minor = cag_exact_minor(&p->space, part(q, first), part(q, second),
                                           part(r, first), part(r, second));
    sum = cag_exact_sum(&p->space, sum, times(p, h[i].w, minor));
  }
  return sum.sign;
}

int cag_bool_turn(BoolPoints *p, uint32_t a, uint32_t b, uint32_t c, int axis) {
  const CagVec3 q = seen_along(p->at[a], axis), r = seen_along(p->at[b], axis);
  const CagVec3 o = seen_along(p->at[c], axis);
  const bool given =
      p->exact[a] == BOOL_NONE && p->exact[b] == BOOL_NONE && p->exact[c] == BOOL_NONE;
  if (given) return cag_side_of_line(q, r, o);
  // Differences of rounded coordinates of magnitude m are off by up to 3 units of m.
  const double m = fmax(fmax(fmax(fabs(q.x), fabs(q.y)), fmax(fabs(r.x), fabs(r.y))),
                        fmax(fabs(o.x), fabs(o.y)));
  const double off = 4 * UNIT * m;
  const double ax = q.x - o.x, ay = q.y - o.y, bx = r.x - o.x, by = r.y - o.y;
  const double left = ax * by, right = ay * bx, value = left - right;
  const double bound = off * (fabs(ax) + fabs(ay) + fabs(bx) + fabs(by) + 2 * off) +
                       8 * UNIT * (fabs(left) + fabs(right)) + DBL_MIN;
  if (fabs(value) > bound) return sign(value);
  return exact_turn(p, (const uint32_t[3]){a, b, c}, axis);
}

// --- Planes ---

static bool is_given(const BoolPoints *p, uint32_t i) { return p->exact[i] == BOOL_NONE; }

static bool are_given(const BoolPoints *p, const uint32_t plane[3]) {
  return is_given(p, plane[0]) && is_given(p, plane[1]) && is_given(p, plane[2]);
}

// The vector from a to b, times a positive number.
static void exact_way(BoolPoints *p, uint32_t a, uint32_t b, CagExact way[3]) {
  if (is_given(p, a) && is_given(p, b)) {
    for (int k = 0; k < 3; k++)
      way[k] = cag_exact_step(&p->space, coordinate(p->at[b], k), coordinate(p->at[a], k));
    return;
  }
  const BoolHomogeneous g = exact_point(p, a), h = exact_point(p, b);
  for (int k = 0; k < 3; k++)
    way[k] = cag_exact_minor(&p->space, part(&h, k), part(&g, k), h.w, g.w);
}

// The normal, times a positive number.
static void exact_normal(BoolPoints *p, const uint32_t plane[3], CagExact n[3]) {
  CagExact u[3], v[3];
  exact_way(p, plane[0], plane[1], u);
  exact_way(p, plane[0], plane[2], v);
  for (int k = 0; k < 3; k++) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    n[k] = cag_exact_minor(&p->space, u[i], u[j], v[i], v[j]);
  }
}

void cag_bool_normal(BoolPoints *p, const uint32_t plane[3], CagExact normal[3]) {
  p->space.used = 0;
  exact_normal(p, plane, normal);
}

// Error bounds of the coordinates of the vector from a to b, whose points are rounded.
static void way_off(const BoolPoints *p, uint32_t a, uint32_t b, double off[3]) {
  for (int k = 0; k < 3; k++)
    off[k] = (is_given(p, a) ? 0 : 2 * UNIT * fabs(coordinate(p->at[a], k))) +
             (is_given(p, b) ? 0 : 2 * UNIT * fabs(coordinate(p->at[b], k)));
}

// A normal in doubles, and error bounds of its coordinates.
static void near_normal(const BoolPoints *p, const uint32_t plane[3], double n[3], double off[3]) {
  const CagVec3 a = p->at[plane[0]];
  const CagVec3 u = cag_sub(p->at[plane[1]], a), v = cag_sub(p->at[plane[2]], a);
  for (int k = 0; k < 3; k++) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const double one = coordinate(u, i) * coordinate(v, j);
    const double two = coordinate(u, j) * coordinate(v, i);
    n[k] = one - two;
    off[k] = 8 * UNIT * (fabs(one) + fabs(two)) + DBL_MIN;
  }
  if (are_given(p, plane)) return;
  double du[3], dv[3];
  way_off(p, plane[0], plane[1], du);
  way_off(p, plane[0], plane[2], dv);
  for (int k = 0; k < 3; k++) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    off[k] += 1.01 * (du[i] * (fabs(coordinate(v, j)) + dv[j]) + fabs(coordinate(u, i)) * dv[j] +
                      du[j] * (fabs(coordinate(v, i)) + dv[i]) + fabs(coordinate(u, j)) * dv[i]);
  }
}

int cag_bool_normal_sign(BoolPoints *p, const uint32_t plane[3], int axis) {
  return cag_bool_turn(p, plane[0], plane[1], plane[2], axis);
}

int cag_bool_normals_dot(BoolPoints *p, const uint32_t m[3], const uint32_t n[3]) {
  double a[3], b[3], off_a[3], off_b[3], value = 0, bound = DBL_MIN;
  near_normal(p, m, a, off_a);
  near_normal(p, n, b, off_b);
  for (int k = 0; k < 3; k++) {
    value += a[k] * b[k];
    bound +=
        off_a[k] * (fabs(b[k]) + off_b[k]) + fabs(a[k]) * off_b[k] + 8 * UNIT * fabs(a[k] * b[k]);
  }
  if (fabs(value) > bound) return sign(value);
  p->space.used = 0;
  CagExact e[3], f[3], sum = {0};
  exact_normal(p, m, e);
  exact_normal(p, n, f);
  for (int k = 0; k < 3; k++) sum = cag_exact_sum(&p->space, sum, times(p, e[k], f[k]));
  return sum.sign;
}

int cag_bool_normals_cross(BoolPoints *p, const uint32_t m[3], const uint32_t n[3], int axis) {
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  double a[3], b[3], off_a[3], off_b[3];
  near_normal(p, m, a, off_a);
  near_normal(p, n, b, off_b);
  const double one = a[i] * b[j], two = a[j] * b[i], value = one - two;
  const double bound = off_a[i] * (fabs(b[j]) + off_b[j]) + fabs(a[i]) * off_b[j] +
                       off_a[j] * (fabs(b[i]) + off_b[i]) + fabs(a[j]) * off_b[i] +
                       8 * UNIT * (fabs(one) + fabs(two)) + DBL_MIN;
  if (fabs(value) > bound) return sign(value);
  p->space.used = 0;
  CagExact e[3], f[3];
  exact_normal(p, m, e);
  exact_normal(p, n, f);
  return cag_exact_minor(&p->space, e[i], e[j], f[i], f[j]).sign;
}

// n . (q - a), times a positive number: the side of a plane through a.
static CagExact exact_side(BoolPoints *p, const CagExact n[3], uint32_t a,
                           const BoolHomogeneous *q) {
  const BoolHomogeneous o = exact_point(p, a);
  CagExact sum = {0};
  for (int k = 0; k < 3; k++) {
    const CagExact step = cag_exact_minor(&p->space, part(q, k), part(&o, k), q->w, o.w);
    sum = cag_exact_sum(&p->space, sum, times(p, n[k], step));
  }
  return sum;
}

int cag_bool_side(BoolPoints *p, const uint32_t plane[3], uint32_t d) {
  if (is_given(p, d) && are_given(p, plane))
    return cag_side_of_plane(p->at[plane[0]], p->at[plane[1]], p->at[plane[2]], p->at[d]);
  double n[3], off[3], value = 0, bound = DBL_MIN;
  near_normal(p, plane, n, off);
  const CagVec3 a = p->at[plane[0]], q = p->at[d];
  for (int k = 0; k < 3; k++) {
    const double x = coordinate(q, k), y = coordinate(a, k), step = x - y;
    const double step_off = 3 * UNIT * (fabs(x) + fabs(y));
    value += n[k] * step;
    bound +=
        off[k] * (fabs(step) + step_off) + fabs(n[k]) * step_off + 8 * UNIT * fabs(n[k] * step);
  }
  if (fabs(value) > bound) return sign(value);
  p->space.used = 0;
  CagExact exact[3];
  exact_normal(p, plane, exact);
  const BoolHomogeneous h = exact_point(p, d);
  return exact_side(p, exact, plane[0], &h).sign;
}

// --- New points ---

uint32_t cag_bool_points_cross(BoolPoints *p, uint32_t a, uint32_t b, const uint32_t plane[3]) {
  p->space.used = 0;
  CagExact n[3];
  exact_normal(p, plane, n);
  const BoolHomogeneous from = exact_point(p, a), to = exact_point(p, b);
  const CagExact s = exact_side(p, n, plane[0], &from), t = exact_side(p, n, plane[0], &to);
  BoolHomogeneous h;
  // The side values carry the weights of the points: s that of `from`, t that of `to`.
  h.x = cag_exact_minor(&p->space, to.x, from.x, t, s);
  h.y = cag_exact_minor(&p->space, to.y, from.y, t, s);
  h.z = cag_exact_minor(&p->space, to.z, from.z, t, s);
  h.w = cag_exact_minor(&p->space, to.w, from.w, t, s);
  return add_exact(p, h);
}

// normal . x = *offset for points x of the plane.
static void exact_cut(BoolPoints *p, BoolCut c, CagExact n[3], CagExact *offset) {
  if (c.c != BOOL_NONE) exact_normal(p, (const uint32_t[3]){c.a, c.b, c.c}, n);
  else {
    const int i = (c.axis + 1) % 3, j = (c.axis + 2) % 3;
    CagExact way[3];
    exact_way(p, c.a, c.b, way);
    n[c.axis] = (CagExact){NULL, 0, 0, 0};
    n[i] = way[j];
    n[j] = cag_exact_negative(way[i]);
  }
  const BoolHomogeneous o = exact_point(p, c.a);
  *offset = (CagExact){NULL, 0, 0, 0};
  for (int k = 0; k < 3; k++)
    *offset = cag_exact_sum(&p->space, *offset, times(p, n[k], part(&o, k)));
  for (int k = 0; k < 3 && !is_given(p, c.a); k++) n[k] = times(p, n[k], o.w);
}

static void exact_cross(BoolPoints *p, const CagExact a[3], const CagExact b[3], CagExact out[3]) {
  for (int k = 0; k < 3; k++) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    out[k] = cag_exact_minor(&p->space, a[i], a[j], b[i], b[j]);
  }
}

// The point with n[i] . x = offset[i], by Cramer's rule.
static uint32_t add_solution(BoolPoints *p, CagExact n[3][3], const CagExact offset[3]) {
  CagExact sum[3] = {{0}}, w = {0};
  for (int i = 0; i < 3; i++) {
    CagExact across[3];
    exact_cross(p, n[(i + 1) % 3], n[(i + 2) % 3], across);
    for (int k = 0; k < 3; k++)
      sum[k] = cag_exact_sum(&p->space, sum[k], times(p, offset[i], across[k]));
    if (i > 0) continue;
    for (int k = 0; k < 3; k++) w = cag_exact_sum(&p->space, w, times(p, n[0][k], across[k]));
  }
  return w.sign ? add_exact(p, (BoolHomogeneous){sum[0], sum[1], sum[2], w}) : BOOL_NONE;
}

uint32_t cag_bool_points_meet(BoolPoints *p, const uint32_t plane[3], BoolCut one, BoolCut two) {
  p->space.used = 0;
  CagExact n[3][3], offset[3];
  exact_cut(p, (BoolCut){plane[0], plane[1], plane[2], 0}, n[0], &offset[0]);
  exact_cut(p, one, n[1], &offset[1]);
  exact_cut(p, two, n[2], &offset[2]);
  return add_solution(p, n, offset);
}

uint32_t cag_bool_points_put(BoolPoints *p, uint32_t i, const uint32_t (*planes)[3], int n,
                             const int kept[2]) {
  p->space.used = 0;
  CagExact normal[3][3], offset[3];
  const BoolHomogeneous at = exact_point(p, i);
  for (int k = 0; k < n; k++)
    exact_cut(p, (BoolCut){planes[k][0], planes[k][1], planes[k][2], 0}, normal[k], &offset[k]);
  for (int k = n; k < 3; k++) { // the plane of all points with this coordinate
    for (int axis = 0; axis < 3; axis++)
      normal[k][axis] = axis == kept[k - n] ? at.w : (CagExact){NULL, 0, 0, 0};
    offset[k] = part(&at, kept[k - n]);
  }
  return add_solution(p, normal, offset);
}

uint32_t cag_bool_points_centroid(BoolPoints *p, const uint32_t v[3]) {
  p->space.used = 0;
  BoolHomogeneous h[3], c = {0};
  for (int i = 0; i < 3; i++) h[i] = exact_point(p, v[i]);
  for (int i = 0; i < 3; i++) {
    const CagExact others = times(p, h[(i + 1) % 3].w, h[(i + 2) % 3].w);
    c.x = cag_exact_sum(&p->space, c.x, times(p, others, h[i].x));
    c.y = cag_exact_sum(&p->space, c.y, times(p, others, h[i].y));
    c.z = cag_exact_sum(&p->space, c.z, times(p, others, h[i].z));
    if (i == 0) c.w = times(p, cag_exact(&p->space, 3), times(p, others, h[0].w));
  }
  return append_exact(p, rounded(p, &c), c);
}
