// Regions that may overlap, because boxes around parts of their boundaries do, are in one set. Each
// set is united by itself.

#include "geom/curve/region_unite.h"

#include <stdint.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/sort.h"
#include "base/stop.h"

typedef struct Member {
  const CagRegion *region;
  CagBounds box;
  CagBounds *parts; // of the smooth parts of its boundary; NULL: not needed so far
  size_t part_count;
  size_t index; // among the given regions
  size_t set;   // the index of another member of its set, or its own; at the end, its least `index`
} Member;

typedef struct Sets {
  Member *members; // by ascending box.min.x
  size_t n;
} Sets;

// --- Boxes ---

static bool boxes_meet(const CagBounds *a, const CagBounds *b) {
  return a->min.x <= b->max.x && b->min.x <= a->max.x && a->min.y <= b->max.y &&
         b->min.y <= a->max.y;
}

static void cover(CagBounds *box, const CagBounds *part) {
  cag_bounds_add(box, part->min);
  cag_bounds_add(box, part->max);
}

static CagBounds hull_of(const CagRegion *r) {
  CagBounds box = CAG_BOUNDS_EMPTY;
  for (size_t i = 0; i < r->count; i++) {
    const CagCurve *c = r->loops[i];
    const CagBounds one = c->kind->hull(c, c->start, c->end);
    cover(&box, &one);
  }
  return box;
}

static size_t breaks_of(const CagCurve *c, double *out, size_t capacity) {
  return c->kind->breaks ? c->kind->breaks(c, out, capacity) : 0;
}

static CagStatus add_parts(Member *m, const CagCurve *c, CagError *err) {
  const size_t n = breaks_of(c, NULL, 0);
  double *ends = cag_malloc((n + 2) * sizeof *ends);
  if (!ends || !CAG_RESIZE(m->parts, m->part_count + n + 1)) {
    cag_free(ends);
    return cag_fail_memory(err);
  }
  ends[0] = c->start;
  breaks_of(c, ends + 1, n);
  ends[n + 1] = c->end;
  for (size_t i = 0; i <= n; i++)
    m->parts[m->part_count++] = c->kind->hull(c, ends[i], ends[i + 1]);
  cag_free(ends);
  return CAG_OK;
}

static CagStatus find_parts(Member *m, CagError *err) {
  CagStatus status = CAG_OK;
  if (m->part_count) return CAG_OK;
  for (size_t i = 0; !status && i < m->region->count; i++)
    status = add_parts(m, m->region->loops[i], err);
  return status;
}

static bool parts_meet(const Member *a, const Member *b) {
  for (size_t i = 0; i < a->part_count; i++) {
    if (!boxes_meet(&a->parts[i], &b->box)) continue;
    for (size_t k = 0; k < b->part_count; k++)
      if (boxes_meet(&a->parts[i], &b->parts[k])) return true;
  }
  return false;
}

static CagStatus holds_start(const CagRegion *r, const CagRegion *of, bool *out, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && !*out && i < of->count; i++) {
    CagVec3 p;
    status = cag_curve_point(of->loops[i], of->loops[i]->start, &p, err);
    if (!status) status = cag_region_contains(r, p, out, err);
  }
  return status;
}

static CagStatus may_overlap(Member *a, Member *b, bool *out, CagError *err) {
  *out = boxes_meet(&a->box, &b->box);
  if (!*out) return CAG_OK;
  CagStatus status = find_parts(a, err);
  if (!status) status = find_parts(b, err);
  if (status) return status;
  *out = parts_meet(a, b);
  if (!*out) status = holds_start(a->region, b->region, out, err);
  if (!status && !*out) status = holds_start(b->region, a->region, out, err);
  return status;
}

// --- Sets ---

static size_t set_of(Sets *s, size_t i) {
  while (s->members[i].set != i) i = s->members[i].set = s->members[s->members[i].set].set;
  return i;
}

static int by_left(const void *a, const void *b) {
  const double x = ((const Member *)a)->box.min.x, y = ((const Member *)b)->box.min.x;
  return (x > y) - (x < y);
}

static CagStatus find_sets(Sets *s, CagError *err) {
  for (size_t i = 0; i < s->n; i++) s->members[i].set = i;
  for (size_t i = 0; i < s->n; i++)
    for (size_t k = i + 1; k < s->n && s->members[k].box.min.x <= s->members[i].box.max.x; k++) {
      const size_t a = set_of(s, i), b = set_of(s, k);
      bool overlap;
      CagStatus status = cag_stop_check(err);
      if (!status && a != b) status = may_overlap(&s->members[i], &s->members[k], &overlap, err);
      if (status) return status;
      if (a != b && overlap) s->members[a > b ? a : b].set = a < b ? a : b;
    }
  return CAG_OK;
}

// --- The result ---

typedef struct Loops {
  CagCurve **items;
  size_t *outer;
  size_t count, capacity;
} Loops;

static bool add_loops(Loops *l, const CagRegion *r) {
  const size_t first = l->count;
  if (first + r->count > l->capacity) {
    const size_t capacity = 2 * (first + r->count);
    if (!CAG_RESIZE(l->items, capacity) || !CAG_RESIZE(l->outer, capacity)) return false;
    l->capacity = capacity;
  }
  for (size_t i = 0; i < r->count; i++) {
    l->items[l->count] = cag_curve_retain(r->loops[i]);
    l->outer[l->count++] = first + r->outer[i];
  }
  return true;
}

// Adds the loops of a set of n members. `regions` has room for them.
static CagStatus add_set(const Member *members, size_t n, const CagRegion **regions, Loops *l,
                         CagError *err) {
  if (n == 1) return add_loops(l, members->region) ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; i < n; i++) regions[i] = members[i].region;
  CagRegion *whole;
  CagStatus status = cag_region_combine(CAG_REGION_UNION, regions, n, &whole, err);
  if (status) return status;
  if (!add_loops(l, whole)) status = cag_fail_memory(err);
  cag_region_release(whole);
  return status;
}

static int by_set(const void *a, const void *b) {
  const Member *p = a, *q = b;
  return p->set != q->set ? (p->set > q->set) - (p->set < q->set)
                          : (p->index > q->index) - (p->index < q->index);
}

// Puts the members of each set next to each other, in the given order.
static CagStatus sort_sets(Sets *s, CagError *err) {
  size_t *least = cag_malloc((s->n ? s->n : 1) * sizeof *least);
  if (!least) return cag_fail_memory(err);
  for (size_t i = 0; i < s->n; i++) least[i] = SIZE_MAX;
  for (size_t i = 0; i < s->n; i++) {
    const size_t set = set_of(s, i);
    if (s->members[i].index < least[set]) least[set] = s->members[i].index;
  }
  for (size_t i = 0; i < s->n; i++) s->members[i].set = set_of(s, i);
  for (size_t i = 0; i < s->n; i++) s->members[i].set = least[s->members[i].set];
  cag_free(least);
  return cag_sort(s->members, s->n, sizeof *s->members, by_set, err);
}

static CagStatus unite_sets(const Sets *s, CagRegion **out, CagError *err) {
  Loops l = {.items = NULL};
  const CagRegion **regions = cag_malloc((s->n ? s->n : 1) * sizeof *regions);
  CagStatus status = regions ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0, k; !status && i < s->n; i = k) {
    for (k = i + 1; k < s->n && s->members[k].set == s->members[i].set;) k++;
    status = add_set(s->members + i, k - i, regions, &l, err);
  }
  cag_free(regions);
  if (!status && l.count == 0) status = cag_region_empty(out, err);
  else if (!status) status = cag_region_take(l.items, l.outer, l.count, out, err);
  else
    for (size_t i = 0; i < l.count; i++) cag_curve_release(l.items[i]);
  cag_free(l.items);
  cag_free(l.outer);
  return status;
}

CagStatus cag_regions_unite_few(CagRegion *const *regions, size_t n, CagRegion **out,
                                CagError *err) {
  Sets s = {cag_calloc(n ? n : 1, sizeof *s.members), 0};
  if (!s.members) return cag_fail_memory(err);
  for (size_t i = 0; i < n; i++)
    if (!cag_region_is_empty(regions[i]))
      s.members[s.n++] = (Member){.region = regions[i], .box = hull_of(regions[i]), .index = i};
  CagStatus status = cag_sort(s.members, s.n, sizeof *s.members, by_left, err);
  if (!status) status = find_sets(&s, err);
  if (!status) status = sort_sets(&s, err);
  if (!status) status = unite_sets(&s, out, err);
  for (size_t i = 0; i < s.n; i++) cag_free(s.members[i].parts);
  cag_free(s.members);
  return status;
}
