// Parts that share volume.

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "geom/meet/overlap.h"
#include "geom/solid/csg.h"
#include "interp/builtin/assemblies.h"
#include "interp/builtin/solids.h"
#include "interp/vm/vm.h"

// A part as one solid. Parts without a closed body have none.
typedef struct ClashPart {
  CagSolid *solid;
  CagOverlapBody body;
} ClashPart;

typedef struct ClashOrder {
  double low; // the lower end of its bounds along x
  size_t part;
} ClashOrder;

typedef struct ClashSearch {
  CagCall *call;
  const CagParts *parts;
  CagTessellation how;
  ClashPart *items;
  ClashOrder *order; // of the parts that have a solid
  size_t ordered;
  CagClash *clashes;
  size_t count, capacity;
} ClashSearch;

static void release_search(void *what) {
  ClashSearch *s = what;
  for (size_t i = 0; s->items && i < s->parts->count; i++) {
    cag_overlap_release(&s->items[i].body);
    cag_solid_release(s->items[i].solid);
  }
  cag_free(s->items);
  cag_free(s->order);
  cag_free(s->clashes);
  cag_free(s);
}

// The union of the bodies.
static CagStatus part_solid(const ClashSearch *s, const CagPart *part, CagSolid **out,
                            CagError *err) {
  const CagPartBody *bodies = s->parts->bodies + part->first;
  CagSolid **solids = cag_malloc((part->count + 1) * sizeof *solids);
  size_t n = 0;
  if (!solids) return cag_fail_memory(err);
  for (size_t i = 0; i < part->count; i++)
    if (bodies[i].solid) solids[n++] = bodies[i].solid;
  CagStatus status = CAG_OK;
  if (n == 1) *out = cag_solid_retain(solids[0]);
  else if (n > 1) status = cag_solid_combine(CAG_UNION, solids, n, s->how.interrupt, out, err);
  cag_free(solids);
  return status;
}

// The finest of the bodies; 0: none is given.
static double part_tolerance(const ClashSearch *s, const CagPart *part) {
  double least = 0;
  for (size_t i = part->first; i < part->first + part->count; i++) {
    const double own = s->parts->bodies[i].tolerance;
    if (own > 0 && (least == 0 || own < least)) least = own;
  }
  return least;
}

// Adds the names of the parts to an error.
static bool clash_ok(CagCall *call, CagStatus status, const CagPart *a, const CagPart *b) {
  if (!status) return true;
  char text[sizeof call->err->message];
  if (b)
    snprintf(text, sizeof text, "parts `%.60s` and `%.60s`: %.300s", a->name, b->name,
             call->err->message);
  else snprintf(text, sizeof text, "part `%.60s`: %.300s", a->name, call->err->message);
  if (status != CAG_E_CALLBACK && status != CAG_E_MEMORY)
    memcpy(call->err->message, text, sizeof text);
  return cag_fail_geometry(call, call->err);
}

static bool prepare_parts(ClashSearch *s) {
  for (size_t i = 0; i < s->parts->count; i++) {
    const CagPart *part = &s->parts->items[i];
    ClashPart *item = &s->items[i];
    if (i % CAG_LOOK_UP == 0 && !cag_keep_going(s->call->vm)) return false;
    CagStatus status = part_solid(s, part, &item->solid, s->call->err);
    if (!status && item->solid)
      status = cag_overlap_body(item->solid, part_tolerance(s, part), &s->how, &item->body,
                                s->call->err);
    if (!clash_ok(s->call, status, part, NULL)) return false;
    if (item->solid) s->order[s->ordered++] = (ClashOrder){item->body.bounds.min.x, i};
  }
  return true;
}

static int by_low_end(const void *x, const void *y) {
  const ClashOrder *a = x, *b = y;
  if (a->low != b->low) return (a->low > b->low) - (a->low < b->low);
  return (a->part > b->part) - (a->part < b->part);
}

static bool try_pair(ClashSearch *s, size_t i, size_t k) {
  const size_t a = i < k ? i : k, b = i < k ? k : i;
  double volume = 0;
  const CagStatus status =
      cag_overlap_volume(&s->items[a].body, &s->items[b].body, &s->how, &volume, s->call->err);
  if (!clash_ok(s->call, status, &s->parts->items[a], &s->parts->items[b])) return false;
  if (!(volume > 0)) return true;
  if (!CAG_RESERVE(s->clashes, s->capacity, s->count + 1)) cag_vm_out_of_memory(s->call->vm);
  s->clashes[s->count++] = (CagClash){a, b, volume};
  return true;
}

// Tries the pairs whose bounds overlap along x; cag_overlap_volume looks at y and z.
static bool try_pairs(ClashSearch *s) {
  for (size_t i = 0; i < s->ordered; i++) {
    const double end = s->items[s->order[i].part].body.bounds.max.x;
    for (size_t k = i + 1; k < s->ordered; k++) {
      if (!cag_keep_going(s->call->vm)) return false;
      if (s->order[k].low >= end) break;
      if (!try_pair(s, s->order[i].part, s->order[k].part)) return false;
    }
  }
  return true;
}

static int by_parts(const void *x, const void *y) {
  const CagClash *a = x, *b = y;
  if (a->a != b->a) return (a->a > b->a) - (a->a < b->a);
  return (a->b > b->b) - (a->b < b->b);
}

bool cag_parts_clashes(CagCall *call, const CagParts *parts, CagClash **out, size_t *n) {
  ClashSearch *s = cag_calloc(1, sizeof *s);
  if (!s) cag_vm_out_of_memory(call->vm);
  cag_hold_for(call, release_search, s);
  s->call = call;
  s->parts = parts;
  s->how = cag_run_tessellation(call->vm);
  s->items = cag_calloc(parts->count + 1, sizeof *s->items);
  s->order = cag_malloc((parts->count + 1) * sizeof *s->order);
  if (!s->items || !s->order) cag_vm_out_of_memory(call->vm);
  if (!prepare_parts(s)) return false;
  if (s->ordered > 1) qsort(s->order, s->ordered, sizeof *s->order, by_low_end);
  if (!try_pairs(s)) return false;
  if (s->count > 1) qsort(s->clashes, s->count, sizeof *s->clashes, by_parts);
  *out = s->clashes;
  *n = s->count;
  return true;
}

bool cag_assemblies_interference(CagCall *call, const struct cag_assemblies_interference *a,
                                 CagValue *result) {
  static const char *const names[] = {"a", "b", "volume"};
  CagClash *clashes;
  size_t n;
  const CagParts *parts = cag_parts_of(call, a->G, true);
  if (!parts || !cag_parts_clashes(call, parts, &clashes, &n)) return false;
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = 0; i < n; i++) {
    const CagValue values[] = {cag_text_c(call->vm, parts->items[clashes[i].a].name),
                               cag_text_c(call->vm, parts->items[clashes[i].b].name),
                               cag_number(clashes[i].volume)};
    if (!cag_builder_add(call->vm, list, cag_record_new(call->vm, names, values, 3))) return false;
  }
  *result = cag_builder_finish(call->vm, list);
  return true;
}
