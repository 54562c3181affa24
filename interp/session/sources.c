// The sources of the faces of set operations: the calls of the script that made their operands.

#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/ray/mesh_surface.h"
#include "geom/solid/csg.h"
#include "interp/session/part_mesh.h"

// A solid of more operands has no sources: only a script that unites a shape with itself again and
// again has so many.
enum { MOST_OPERANDS = 1 << 18 };

typedef struct SourcePlace {
  const CagSource *source;
  CagSpan span;
  const char *what;
} SourcePlace;

typedef struct Source {
  CagDigest digest; // of its places
  const char *name;
  SourcePlace *places;
  size_t count, capacity;
} Source;

typedef struct CagSessionSources {
  size_t part;
  Source *items;
  size_t count, capacity;
  CagHashIndex index;
  uint32_t *operands; // the source of each operand
  size_t operand_count, operand_capacity;
} CagSessionSources;

void cag_session_drop_sources(CagSession *s) {
  CagSessionSources *k = s->part_sources;
  if (!k) return;
  for (size_t i = 0; i < k->count; i++) cag_free(k->items[i].places);
  cag_free(k->items);
  cag_hash_free(&k->index);
  cag_free(k->operands);
  cag_free(k);
  s->part_sources = NULL;
}

// --- Trails ---

// The set operations around an operand, the innermost first. Those with the locations of one around
// them are left out, so that the operands of a loop have the same trail in all rounds.
typedef struct Trail {
  const CagOriginStep *last;
  CagDigest chain, whole; // of its own locations, and of those of the trail
  const struct Trail *outer;
} Trail;

static void digest_chain(const CagOriginStep *last, CagDigest *d) {
  for (const CagOriginStep *step = last; step; step = step->before) {
    const uint64_t span = ((uint64_t)step->site->span.start << 32) | step->site->span.end,
                   caller = ((uint64_t)step->site->caller_span.start << 32) |
                            step->site->caller_span.end;
    cag_digest_word(d, (uint64_t)(size_t)step->site->source);
    cag_digest_word(d, span);
    if (step->site->caller) cag_digest_word(d, caller);
  }
}

static bool is_on_trail(const Trail *t, const CagDigest *chain) {
  for (; t; t = t->outer)
    if (cag_digest_equal(&t->chain, chain)) return true;
  return false;
}

static void add_place(Source *out, const SourcePlace *place, bool *failed) {
  *failed = *failed || !CAG_RESERVE(out->places, out->capacity, out->count + 1);
  if (!*failed && place->source) out->places[out->count++] = *place;
}

static void add_chain(Source *out, const CagOriginStep *last, const char *what, bool *failed) {
  const CagOriginStep *later = NULL;
  for (const CagOriginStep *step = last; step; later = step, step = step->before) {
    const char *own = what ? what : step->before ? "changed" : "made";
    if (cag_origin_other_caller(step, later))
      add_place(out, &(SourcePlace){step->site->caller, step->site->caller_span, own}, failed);
    add_place(out, &(SourcePlace){step->site->source, step->site->span, own}, failed);
  }
}

static void add_trail(Source *out, const Trail *t, bool *failed) {
  if (!t) return;
  add_trail(out, t->outer, failed);
  add_chain(out, t->last, "combined", failed);
}

// --- Operands ---

typedef struct Collecting {
  CagSessionSources *to;
  bool failed, many;
} Collecting;

static bool find_source(const CagSessionSources *k, const CagDigest *d, size_t *out) {
  for (CagHashWalk w = cag_hash_walk(&k->index, d->a); cag_hash_next(&w, out);)
    if (cag_digest_equal(&k->items[*out].digest, d)) return true;
  return false;
}

static void add_operand(Collecting *c, const CagOrigin *o, const Trail *trail) {
  CagSessionSources *k = c->to;
  CagDigest d = trail ? trail->whole : cag_digest_start();
  size_t source;
  digest_chain(o->last, &d);
  c->many = c->many || k->operand_count == MOST_OPERANDS;
  c->failed =
      c->failed || c->many || !CAG_RESERVE(k->operands, k->operand_capacity, k->operand_count + 1);
  if (c->failed) return;
  if (!find_source(k, &d, &source)) {
    if (!CAG_RESERVE(k->items, k->capacity, k->count + 1) ||
        !cag_hash_add(&k->index, d.a, k->count)) {
      c->failed = true;
      return;
    }
    source = k->count++;
    k->items[source] = (Source){.digest = d, .name = o->definition ? o->definition->bytes : ""};
    add_trail(&k->items[source], trail, &c->failed);
    add_chain(&k->items[source], o->last, NULL, &c->failed);
  }
  k->operands[k->operand_count++] = (uint32_t)source;
}

static bool is_operation(const CagSolid *s) {
  return s->core && (s->kind == CAG_SOLID_UNION || s->kind == CAG_SOLID_DIFFERENCE ||
                     s->kind == CAG_SOLID_INTERSECTION);
}

// The order is that of cag_mesh_leaves.
static void collect_operands(Collecting *c, const CagSolid *s, const CagOrigin *o,
                             const Trail *trail) {
  if (c->failed) return;
  if (!is_operation(s)) {
    add_operand(c, o, trail);
    return;
  }
  const size_t n = s->core->count;
  CagOrigin *origins = cag_calloc(n + 1, sizeof *origins);
  c->failed = !origins;
  if (origins && o->operands && o->operands->count == n) cag_operands_list(o->operands, origins);
  Trail inner = {.last = o->last, .chain = cag_digest_start(), .outer = trail};
  digest_chain(o->last, &inner.chain);
  inner.whole = trail ? trail->whole : cag_digest_start();
  digest_chain(o->last, &inner.whole);
  const bool adds = o->last && !is_on_trail(trail, &inner.chain);
  for (size_t i = 0; origins && i < n; i++)
    collect_operands(c, s->core->operands[i], &origins[i], adds ? &inner : trail);
  cag_free(origins);
}

static int collect_part(CagSession *s, void *context) {
  const size_t part = *(const size_t *)context;
  const CagItem *item = &s->scene.items[part];
  const CagItemSource *source = cag_session_item_source(s, item);
  Collecting c = {.to = cag_calloc(1, sizeof *c.to)};
  if (!c.to) return cag_session_fail_memory(s);
  s->part_sources = c.to;
  c.to->part = part;
  const CagOrigin *own = source ? &source->shape->origin : NULL;
  // The part's own calls are its origin, so its operands have no trail yet.
  if (own) collect_operands(&c, item->as.solid, &(CagOrigin){.operands = own->operands}, NULL);
  if (c.many) c.to->count = c.to->operand_count = 0;
  return c.failed && !c.many ? cag_session_fail_memory(s) : CAG_STATUS_OK;
}

static const CagSessionSources *sources_of(CagSession *s, size_t part) {
  if (!s->has_scene || part >= s->scene.item_count) return NULL;
  const CagItem *item = &s->scene.items[part];
  if (item->kind != CAG_ITEM_SOLID || !is_operation(item->as.solid)) return NULL;
  if (s->part_sources && s->part_sources->part == part) return s->part_sources;
  CagAccount *before = cag_account_lend(&s->vm->account);
  cag_session_drop_sources(s);
  cag_account_lend(before);
  return cag_session_geometry(s, collect_part, &part) == CAG_STATUS_OK ? s->part_sources : NULL;
}

// --- Answers ---

const char *cag_session_part_source(CagSession *s, size_t part, size_t i) {
  if (!cag_session_begin(s)) return NULL;
  const CagSessionSources *k = sources_of(s, part);
  const char *name = k && i < k->count ? k->items[i].name : NULL;
  cag_session_end(s, CAG_STATUS_OK);
  return name;
}

bool cag_session_source_place(CagSession *s, size_t part, size_t i, size_t k, const char **what,
                              CagPlaceView *out) {
  *out = (CagPlaceView){0};
  if (!cag_session_begin(s)) return false;
  const CagSessionSources *all = sources_of(s, part);
  const bool found = all && i < all->count && k < all->items[i].count;
  if (found) {
    const SourcePlace *p = &all->items[i].places[k];
    *what = p->what;
    *out = cag_session_place(p->source, p->span);
  }
  cag_session_end(s, CAG_STATUS_OK);
  return found;
}

static int find_faces(CagSession *s, void *context) {
  CagFacesView *out = context;
  CagError err = {0};
  CagSessionMesh *m = s->mesh;
  m->numbers = cag_malloc((m->mesh->triangle_count + 1) * sizeof *m->numbers);
  CagStatus status = m->numbers ? CAG_OK : cag_fail_memory(&err);
  if (!status) status = cag_mesh_leaves(m->item.as.solid, m->mesh, m->numbers, &err);
  status = cag_session_checked(s, status, &err);
  if (status) return cag_session_fail_geometry(s, &err);
  out->operands = m->numbers;
  out->triangle_count = m->mesh->triangle_count;
  memcpy(out->id, m->id, sizeof out->id);
  return CAG_STATUS_OK;
}

int cag_session_part_faces(CagSession *s, size_t part, CagFacesView *out) {
  CagMeshView mesh;
  *out = (CagFacesView){0};
  if (!cag_session_begin(s)) return CAG_STATUS_USAGE;
  const CagSessionSources *k = sources_of(s, part);
  int status = CAG_STATUS_USAGE;
  if (k && k->operand_count > 0) {
    const CagItem *item = &s->scene.items[part];
    status = cag_session_item_mesh(s, item, cag_session_item_source(s, item)->shape, 1, NULL, NULL,
                                   &mesh);
    if (status == CAG_STATUS_OK) status = cag_session_geometry(s, find_faces, out);
    out->operand_count = k->operand_count;
    out->sources = k->operands;
  }
  return cag_session_end(s, status);
}
