// Definitions of a script, and measures of what is shown.

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "interp/scene/item_measure.h"
#include "interp/session/session.h"

// --- Definitions ---

static bool fail_unknown(CagVm *vm, const CagModuleUnit *m, const char *name) {
  const size_t n = m ? m->ast->top_count : 0;
  const char **names = cag_malloc((n + 1) * sizeof *names);
  if (!names) return cag_vm_fail_memory(vm);
  size_t count = 0;
  for (size_t i = 0; i < n; i++)
    if (!m->ast->tops[i]->whole) names[count++] = m->ast->tops[i]->name;
  const char *nearest = cag_nearest_name(name, names, count);
  CagDiagnostic *d =
      cag_diagnostics_add(&vm->errors, CAG_ERR_unknown_name, NULL, (CagSpan){0, 0},
                          "%s defines no name `%s`", m ? m->name : "the script", name);
  if (nearest) cag_diagnostic_set_help(d, "did you mean `%s`?", nearest);
  cag_free(names);
  vm->failed = true;
  return false;
}

bool cag_session_find_definition(CagSession *s, const char *name, CagValue *out) {
  CagVm *vm = s->vm;
  const CagModuleUnit *m = s->main < vm->module_count ? vm->modules[s->main] : NULL;
  for (size_t i = m && m->ast ? m->ast->top_count : 0; i-- > 0;)
    if (!m->ast->tops[i]->whole && !strcmp(m->ast->tops[i]->name, name))
      return cag_vm_force(vm, m->tops[i], out);
  return fail_unknown(vm, m && m->ast ? m : NULL, name);
}

typedef struct Printing {
  CagSession *session;
  const char *name;
  CagString text;
  const char *type;
  bool shape;
} Printing;

static bool print_definition(CagVm *vm, void *context) {
  Printing *p = context;
  CagValue v;
  if (!cag_session_find_definition(p->session, p->name, &v)) return false;
  p->type = cag_type_name(v);
  p->shape = cag_value_is_shown(vm, v);
  if (vm->failed) return false;
  cag_print_value(vm, &p->text, v, true);
  cag_string_check(vm, &p->text);
  return !vm->failed;
}

int cag_session_definition(CagSession *s, const char *name,
                           void (*give)(void *context, const char *text, const char *type,
                                        bool shown),
                           void *context) {
  if (!cag_session_begin(s)) return CAG_STATUS_USAGE;
  Printing p = {.session = s, .name = name};
  const int status = cag_session_work(s, print_definition, &p);
  if (status == CAG_STATUS_OK) give(context, p.text.bytes ? p.text.bytes : "", p.type, p.shape);
  cag_string_free(&p.text);
  return cag_session_end(s, status);
}

// --- Measures ---

typedef struct Measuring {
  const CagItem *item;
  CagItemMeasures measures;
} Measuring;

static int measure_item(CagSession *s, void *context) {
  Measuring *g = context;
  CagError err = {0};
  const CagStatus status =
      cag_session_checked(s, cag_item_measure(&s->scene, g->item, &g->measures, &err), &err);
  return !status ? CAG_STATUS_OK : cag_session_fail_geometry(s, &err);
}

static void set_point(double out[3], CagVec3 p) { out[0] = p.x, out[1] = p.y, out[2] = p.z; }

static CagMeasures view_of(const CagItem *item, const CagItemMeasures *m) {
  CagMeasures out = {.name = item->name,
                     .type = cag_item_type(item),
                     .kind = cag_item_kind(item),
                     .length = m->length,
                     .area = m->area,
                     .volume = m->volume,
                     .closed = m->closed,
                     .exact = m->exact,
                     .has_faces = m->has_faces,
                     .faces = m->faces,
                     .triangles = m->triangles};
  set_point(out.min, m->bounds.min);
  set_point(out.max, m->bounds.max);
  set_point(out.centroid, m->centroid);
  return out;
}

static CagMeasures view_of_empty(const CagItem *item) {
  const bool curve = item->kind == CAG_ITEM_CURVE,
             body = item->kind == CAG_ITEM_SOLID || item->kind == CAG_ITEM_MESH;
  const CagItemMeasures none = {.bounds = CAG_BOUNDS_EMPTY,
                                .length = curve || item->kind == CAG_ITEM_REGION ? 0 : NAN,
                                .area = curve ? NAN : 0,
                                .volume = body ? 0 : NAN,
                                .centroid = {NAN, NAN, NAN},
                                .exact = true};
  CagMeasures out = view_of(item, &none);
  out.empty = true;
  return out;
}

int cag_session_measure(CagSession *s, void (*give)(void *context, const CagMeasures *part),
                        void *context) {
  if (!cag_session_begin(s)) return CAG_STATUS_USAGE;
  int status = cag_session_build_scene(s);
  for (size_t i = 0; status == CAG_STATUS_OK && i < s->scene.item_count; i++) {
    Measuring g = {.item = &s->scene.items[i]};
    if (g.item->kind == CAG_ITEM_GROUND) continue;
    status = cag_session_geometry(s, measure_item, &g);
    if (status != CAG_STATUS_OK) break;
    const CagMeasures part = view_of(g.item, &g.measures);
    give(context, &part);
  }
  for (size_t i = 0; status == CAG_STATUS_OK && i < s->scene.empty_count; i++) {
    const CagMeasures part = view_of_empty(&s->scene.empties[i]);
    give(context, &part);
  }
  return cag_session_end(s, status);
}
