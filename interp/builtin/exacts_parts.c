// The parts of exact solids, and the choice of their edges and faces (see exacts_parts.h).

#include "interp/builtin/exacts_parts.h"

#include <string.h>

#include "base/array.h"
#include "geom/solid/exact.h"
#include "interp/builtin/exacts_features.h"
#include "interp/builtin/support.h"
#include "interp/vm/vm.h"

static void release_exact_parts(void *what) {
  CagExactParts *p = what;
  for (size_t i = 0; i < p->count; i++) cag_features_free(&p->features[i]);
  cag_free(p->features);
  cag_boundaries_free(&p->results);
  cag_free(p);
}

CagExactParts *cag_exact_parts(CagCall *call, int argument, bool meshed) {
  const CagSolid *exact;
  const bool found = (meshed ? cag_exacts_or_meshed : cag_exacts_of)(call, argument, &exact);
  return found ? cag_exact_parts_of(call, exact) : NULL;
}

bool cag_exact_parts_meshed(const CagExactParts *p) {
  return p->count > 0 && p->parts[0].mesh != NULL;
}

CagExactParts *cag_exact_parts_try(CagCall *call, const CagSolid *exact, CagError *err) {
  CagExactParts *p = cag_calloc(1, sizeof *p);
  size_t n = 0;
  if (!p) cag_vm_out_of_memory(call->vm);
  cag_hold_for(call, release_exact_parts, p);
  p->call = call;
  p->records = (CagValue){.type = CAG_UNSET};
  p->solid = exact;
  p->kernel = cag_exacts_kernel(call);
  if (!p->kernel) cag_vm_out_of_memory(call->vm);
  p->parts = cag_solid_boundaries(p->solid, &n);
  cag_transform_is_similarity(&p->solid->placement, &p->scale);
  p->features = cag_calloc(n + 1, sizeof *p->features);
  if (!p->features) cag_vm_out_of_memory(call->vm);
  for (; p->count < n; p->count++)
    if (cag_boundary_features(&p->parts[p->count], &p->features[p->count], err)) return NULL;
  return p;
}

CagExactParts *cag_exact_parts_of(CagCall *call, const CagSolid *exact) {
  CagExactParts *p = cag_exact_parts_try(call, exact, call->err);
  if (!p) (void)cag_fail_geometry(call, call->err);
  return p;
}

// --- Choices ---

// What is chosen: edges or faces.
typedef struct Choice {
  CagExactParts *p;
  int argument;
  bool edges;
  CagList *records; // of all of them, in order; NULL: not made
  CagChosen *items;
  size_t count;
} Choice;

static size_t features_count(const Choice *c, size_t part) {
  return c->edges ? c->p->features[part].edge_count : c->p->features[part].face_count;
}

static size_t all_count(const Choice *c) {
  size_t n = 0;
  for (size_t i = 0; i < c->p->count; i++) n += features_count(c, i);
  return n;
}

static void add_chosen(Choice *c, size_t number) {
  const CagValue record =
      c->records ? cag_list_get(c->p->call->vm, c->records, number) : (CagValue){.type = CAG_UNSET};
  size_t part = 0;
  while (number >= features_count(c, part)) number -= features_count(c, part++);
  c->items[c->count++] = (CagChosen){part, number, record};
}

// The records are those that the script gets from edges_of and faces_of.
static bool make_records(Choice *c) {
  CagExactParts *p = c->p;
  if (!(c->edges ? cag_exacts_edge_records : cag_exacts_face_records)(p->call, p->solid,
                                                                      &p->records))
    return false;
  c->records = CAG_AS_LIST(p->records);
  return true;
}

static bool choose_by_function(Choice *c, CagValue function) {
  CagCall *call = c->p->call;
  cag_root_push(call->vm, c->p->records);
  for (size_t i = 0; i < c->records->length; i++) {
    const CagValue record = cag_list_get(call->vm, c->records, i);
    CagValue told;
    if (!cag_call(call->vm, function, &record, 1, &told)) return false;
    if (told.type != CAG_BOOL)
      return cag_fail_call(call, c->argument, CAG_ERR_type,
                           "expects a function that returns true or false as `%s`, found %s",
                           cag_parameter_name(call, c->argument), cag_type_article(told));
    if (told.as.boolean) add_chosen(c, i);
  }
  cag_root_pop(call->vm, 1);
  return true;
}

static bool choose_from_list(Choice *c, const CagList *given) {
  CagCall *call = c->p->call;
  bool *taken = cag_hold_array(call, c->records->length, sizeof *taken);
  for (size_t i = 0; i < given->length; i++) {
    const CagValue one = cag_list_get(call->vm, given, i);
    size_t k = 0;
    if (!cag_keep_going(call->vm)) return false;
    while (k < c->records->length &&
           !cag_exacts_same_record(call->vm, cag_list_get(call->vm, c->records, k), one))
      k++;
    if (k == c->records->length)
      return cag_fail_call(call, c->argument, CAG_ERR_value,
                           "expects records of %s of this solid as `%s`, found another at [%zu]",
                           c->edges ? "edges" : "faces", cag_parameter_name(call, c->argument), i);
    if (!taken[k]) add_chosen(c, k);
    taken[k] = true;
  }
  return true;
}

static bool choose(Choice *c) {
  CagCall *call = c->p->call;
  const CagValue given = call->values[c->argument];
  if (given.type != CAG_LIST && !cag_is_function(given))
    return cag_fail_type(call, c->argument, "a function or a list of records");
  if (!make_records(c)) return false;
  return given.type == CAG_LIST ? choose_from_list(c, CAG_AS_LIST(given))
                                : choose_by_function(c, given);
}

static bool chosen(Choice *c, CagChosen **out, size_t *n) {
  CagCall *call = c->p->call;
  if (!choose(c)) return false;
  *out = c->items;
  *n = c->count;
  if (c->count > 0) return true;
  return cag_fail_call(call, c->argument, CAG_ERR_value,
                       "expects a choice of at least one %s as `%s`, found none",
                       c->edges ? "edge" : "face", cag_parameter_name(call, c->argument));
}

static void add_sharp_edges(Choice *c) {
  size_t number = 0;
  for (size_t i = 0; i < c->p->count; i++)
    for (size_t k = 0; k < c->p->features[i].edge_count; k++, number++)
      if (c->p->features[i].edges[k].bend != CAG_EDGE_SMOOTH) add_chosen(c, number);
}

bool cag_chosen_edges(CagExactParts *p, int argument, bool records, CagChosen **out, size_t *n) {
  Choice c = {.p = p, .argument = argument, .edges = true};
  c.items = cag_hold_array(p->call, all_count(&c), sizeof *c.items);
  if (cag_given(p->call, argument)) return chosen(&c, out, n);
  if (records && !make_records(&c)) return false;
  add_sharp_edges(&c);
  *out = c.items;
  *n = c.count;
  return *n > 0 || cag_fail_call(p->call, 0, CAG_ERR_value,
                                 "expects a solid with edges as `%s`, found one without",
                                 cag_parameter_name(p->call, 0));
}

bool cag_chosen_faces(CagExactParts *p, int argument, CagChosen **out, size_t *n) {
  Choice c = {.p = p, .argument = argument};
  c.items = cag_hold_array(p->call, all_count(&c), sizeof *c.items);
  *out = c.items;
  *n = 0;
  return !cag_given(p->call, argument) || chosen(&c, out, n);
}

size_t cag_chosen_in_part(CagCall *call, const CagChosen *chosen, size_t n, size_t part,
                          size_t **out) {
  size_t count = 0;
  *out = cag_hold_array(call, n, sizeof **out);
  for (size_t i = 0; i < n; i++)
    if (chosen[i].part == part) (*out)[count++] = chosen[i].index;
  return count;
}

// --- Results ---

CagStatus cag_exact_parts_take(CagExactParts *p, CagBoundaries *made) {
  CagBoundaries *all = &p->results;
  CagBoundary *items = cag_realloc(all->items, (all->count + made->count + 1) * sizeof *items);
  if (!items) {
    cag_boundaries_free(made);
    return cag_fail_memory(p->call->err);
  }
  memcpy(items + all->count, made->items, made->count * sizeof *items);
  *all = (CagBoundaries){.items = items, .count = all->count + made->count};
  cag_free(made->items);
  *made = (CagBoundaries){0};
  return CAG_OK;
}

bool cag_exact_parts_add(CagExactParts *p, CagBoundaries *made) {
  return cag_geometry_ok(p->call, cag_exact_parts_take(p, made));
}

CagStatus cag_exact_parts_solid(CagExactParts *p, CagSolid **out) {
  CagSolid *own = NULL;
  CagStatus status = cag_exacts_checked(&p->results, &own, p->call->err);
  if (!status) status = cag_solid_transform(own, &p->solid->placement, out, p->call->err);
  cag_solid_release(own);
  return status;
}

bool cag_exact_parts_result(CagExactParts *p, int argument, CagValue *result) {
  CagSolid *placed = NULL;
  const CagStatus status = cag_exact_parts_solid(p, &placed);
  if (!cag_solid_result(p->call, status, &placed, result)) return false;
  cag_shape_say_alike(*result, p->call->values[argument]);
  return true;
}
