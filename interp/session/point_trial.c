// Tries other values of params: the definitions of the script are forgotten, the shown expression
// is evaluated again, and afterwards everything is as it was.

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "interp/builtin/robots.h"
#include "interp/session/points.h"

// --- Params ---

// Finds the k-th param in the list of the session, which has those of the script in their order.
static bool read_param(const CagSession *s, const CagStatement *statement, size_t k,
                       CagTrialParam *out) {
  double low, high;
  const CagModuleUnit *m = s->vm->modules[s->main];
  const CagDecl *decl = statement->as.param.decl;
  const CagGlobal *g = &s->vm->globals[m->tops[decl->index]];
  const bool number = g->value.type == CAG_NUMBER || g->value.type == CAG_ANGLE;
  if (!number || g->state != CAG_GLOBAL_DONE || !cag_session_param_range(s, k, &low, &high))
    return false;
  *out = (CagTrialParam){.name = decl->name,
                         .global = m->tops[decl->index],
                         .angle = g->value.type == CAG_ANGLE,
                         .low = low,
                         .high = high,
                         .value = g->value.as.number};
  return isfinite(low) && isfinite(high) && low < high;
}

bool cag_trial_param(const CagSession *s, size_t i, CagTrialParam *out) {
  const CagModuleAst *ast = s->main < s->vm->module_count ? s->vm->modules[s->main]->ast : NULL;
  size_t k = 0;
  for (size_t j = 0; ast && j < ast->count; j++) {
    if (ast->statements[j]->kind != CAG_STATEMENT_PARAM) continue;
    if (read_param(s, ast->statements[j], k++, out) && i-- == 0) return true;
  }
  return false;
}

// --- Parts of shown values ---

typedef struct Search {
  CagVm *vm;
  size_t left; // shapes before the one that is wanted
  const CagShape *found;
} Search;

// Goes through a shown value as the scene does (scene_build.c).
static void search_shape(Search *s, CagValue v) {
  if (s->found || !cag_may_go_deeper(s->vm, "shown")) return;
  const CagList *list = NULL;
  CagValue group;
  if (v.type == CAG_ROBOT) {
    if (cag_robot_at_home(s->vm, v, &group)) search_shape(s, group);
    return;
  }
  if (cag_is_shape(v) && CAG_AS_SHAPE(v)->hidden) return;
  if (v.type == CAG_LIST) list = CAG_AS_LIST(v);
  if (v.type == CAG_GROUP) list = CAG_AS_SHAPE(v)->as.items;
  for (size_t i = 0; list && i < list->length; i++) search_shape(s, cag_list_get(s->vm, list, i));
  if (list || !cag_is_shape(v) || v.type == CAG_LABEL) return;
  if (s->left-- == 0) s->found = CAG_AS_SHAPE(v);
}

// --- Trials ---

// Forgets what the main module has computed; other modules do not depend on its params.
static void forget_definitions(CagTrial *t) {
  const CagModuleUnit *m = t->vm->modules[t->session->main];
  for (size_t i = 0; i < t->vm->global_count; i++) {
    CagGlobal *g = &t->vm->globals[i];
    if (g->unit == m && g->expr && !g->given) g->state = CAG_GLOBAL_NEW;
  }
}

static void restore_globals(CagTrial *t) {
  for (size_t i = 0; i < t->count; i++) {
    t->vm->globals[i].value = t->values[i];
    t->vm->globals[i].state = t->states[i];
    t->vm->globals[i].given = t->given[i];
  }
}

static void end_trial(void *context) {
  CagTrial *t = context;
  restore_globals(t);
  cag_free(t->values);
  cag_free(t->states);
  cag_free(t->given);
}

void cag_trial_begin(CagTrial *t, CagSession *s, size_t part) {
  CagVm *vm = s->vm;
  const CagItemSource *source = &s->sources.items[s->scene.items[part].number];
  *t = (CagTrial){.session = s, .vm = vm, .shown = source->shown};
  for (const CagItemSource *k = s->sources.items; k < source; k++)
    if (k->shape && k->shown == source->shown) t->ordinal++;
  const size_t n = vm->global_count;
  t->values = cag_calloc(n + 1, sizeof *t->values);
  t->states = cag_calloc(n + 1, sizeof *t->states);
  t->given = cag_calloc(n + 1, sizeof *t->given);
  cag_cleanup_push(&t->cleanup, end_trial, t);
  if (!t->values || !t->states || !t->given) cag_vm_out_of_memory(vm);
  for (size_t i = 0; i < n; i++) {
    t->values[i] = vm->globals[i].value;
    t->states[i] = vm->globals[i].state;
    t->given[i] = vm->globals[i].given;
    cag_root_push(vm, t->values[i]);
  }
  t->count = n;
}

void cag_trial_end(CagTrial *t) {
  cag_root_pop(t->vm, t->count);
  cag_cleanup_run(&t->cleanup);
}

bool cag_trial_spots(CagTrial *t, const CagTrialParam *items, size_t n, CagPointSpots *out) {
  CagVm *vm = t->vm;
  const CagShown *shown = &vm->shown[t->shown];
  CagModuleUnit *m = vm->modules[t->session->main];
  CagValue v;
  restore_globals(t);
  for (size_t i = 0; i < n; i++) {
    CagGlobal *g = &vm->globals[items[i].global];
    g->value = items[i].angle ? cag_angle(items[i].value) : cag_number(items[i].value);
    g->state = CAG_GLOBAL_DONE;
    g->given = true;
  }
  forget_definitions(t);
  const CagProto *p = cag_compile_expression(vm, m, shown->expr, NULL);
  Search search = {.vm = vm, .left = t->ordinal};
  if (p && cag_vm_run(vm, p, &v)) search_shape(&search, v);
  const bool found = search.found && !vm->failed;
  if (found) cag_point_spots(vm, search.found, false, out);
  if (vm->failed) cag_vm_clear_error(vm);
  return found;
}
