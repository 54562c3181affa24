// The params of the main script, for programs that let them be changed.

#include <math.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "interp/session/session.h"

typedef struct Param {
  CagParamView view;
  char *description, *value, *initial;
  char **choices;
} Param;

typedef struct CagSessionParams {
  Param *items;
  size_t count;
} CagSessionParams;

static void free_param(Param *p) {
  for (size_t i = 0; i < p->view.choice_count; i++) cag_free(p->choices[i]);
  cag_free(p->choices);
  cag_free(p->description);
  cag_free(p->value);
  cag_free(p->initial);
}

void cag_session_drop_params(CagSession *s) {
  if (!s->params) return;
  for (size_t i = 0; i < s->params->count; i++) free_param(&s->params->items[i]);
  cag_free(s->params->items);
  cag_free(s->params);
  s->params = NULL;
}

CagPlaceView cag_session_place(const CagSource *source, CagSpan span) {
  if (!source) return (CagPlaceView){0};
  const CagPosition from = cag_source_position(source, span.start),
                    to = cag_source_position(source, span.end);
  return (CagPlaceView){.file = source->name,
                        .line = from.line,
                        .column = from.column,
                        .end_line = to.line,
                        .end_column = to.column,
                        .library = source->library};
}

// The value as an expression, allocated with malloc.
static char *expression_of(CagVm *vm, CagValue v) {
  CagString s = {0};
  cag_print_value(vm, &s, v, true);
  char *copy = s.bytes && !s.failed ? cag_strdup(s.bytes) : NULL;
  cag_string_free(&s);
  return cag_checked(copy);
}

static const char *kind_of(CagValue v) {
  CagColor color;
  switch (v.type) {
  case CAG_NUMBER: return "number";
  case CAG_ANGLE: return "angle";
  case CAG_BOOL: return "bool";
  case CAG_TEXT: return cag_color_from_text(CAG_AS_TEXT(v)->bytes, &color) ? "color" : "text";
  default: return "other";
  }
}

static void read_choices(CagVm *vm, const CagList *domain, Param *p) {
  p->choices = cag_checked(cag_calloc(domain->length + 1, sizeof *p->choices));
  p->view.kind = "choice";
  for (size_t i = 0; i < domain->length; i++) {
    p->choices[i] = expression_of(vm, cag_list_get(vm, domain, i));
    p->view.choice_count++;
  }
}

static void read_domain(CagVm *vm, CagModuleUnit *m, const CagExpr *e, Param *p) {
  CagValue domain;
  const CagProto *proto = cag_compile_expression(vm, m, e, NULL);
  if (!proto || !cag_vm_run(vm, proto, &domain)) return;
  if (domain.type == CAG_LIST) read_choices(vm, CAG_AS_LIST(domain), p);
  if (domain.type != CAG_RANGE) return;
  const CagRange *r = CAG_AS_RANGE(domain);
  p->view.ranged = true;
  p->view.low = r->start;
  p->view.high = r->end;
}

static void read_param(CagVm *vm, CagModuleUnit *m, const CagStatement *s, Param *p) {
  const CagExpr *value = s->as.param.value;
  const CagDecl *decl = s->as.param.decl;
  CagValue v;
  p->view.name = decl->name;
  p->view.place = cag_session_place(m->source, decl->span);
  p->view.kind = "other";
  if (s->as.param.label) p->description = cag_checked(cag_strdup(s->as.param.label));
  p->initial = cag_checked(
      cag_strndup(m->source->text + value->span.start, value->span.end - value->span.start));
  if (cag_vm_force(vm, m->tops[decl->index], &v)) {
    p->view.kind = kind_of(v);
    p->value = expression_of(vm, v);
    if (s->as.param.domain) read_domain(vm, m, s->as.param.domain, p);
  }
  cag_vm_clear_error(vm); // the run has reported it
  if (!p->value) p->value = cag_checked(cag_strdup(p->initial));
}

static bool read_params(CagVm *vm, void *context) {
  CagSession *s = context;
  CagModuleUnit *m = vm->modules[s->main];
  s->params = cag_checked(cag_calloc(1, sizeof *s->params));
  s->params->items = cag_checked(cag_calloc(m->ast->count + 1, sizeof *s->params->items));
  for (size_t i = 0; i < m->ast->count; i++)
    if (m->ast->statements[i]->kind == CAG_STATEMENT_PARAM)
      read_param(vm, m, m->ast->statements[i], &s->params->items[s->params->count++]);
  return true;
}

// Nothing here adds a diagnostic.
bool cag_session_list_params(CagSession *s) {
  if (s->params) return true;
  if (!s->vm || s->main == CAG_NO_MODULE || s->interactive) return false;
  const bool ok = cag_session_work(s, read_params, s) == CAG_STATUS_OK;
  cag_diagnostics_truncate(&s->diagnostics, s->lasting);
  if (!ok) cag_session_drop_params(s);
  return ok;
}

bool cag_session_param(CagSession *s, size_t i, CagParamView *out) {
  *out = (CagParamView){0};
  if (!cag_session_begin(s)) return false;
  const bool found = cag_session_list_params(s) && i < s->params->count;
  if (found) {
    const Param *p = &s->params->items[i];
    *out = p->view;
    out->description = p->description;
    out->value = p->value;
    out->initial = p->initial;
  }
  cag_session_end(s, CAG_STATUS_OK);
  return found;
}

bool cag_session_param_range(const CagSession *s, size_t i, double *low, double *high) {
  if (!s->params || i >= s->params->count || !s->params->items[i].view.ranged) return false;
  *low = s->params->items[i].view.low;
  *high = s->params->items[i].view.high;
  return true;
}

const char *cag_session_param_choice(CagSession *s, size_t param, size_t i) {
  if (!s->params || param >= s->params->count) return NULL;
  const Param *p = &s->params->items[param];
  return i < p->view.choice_count ? p->choices[i] : NULL;
}

bool cag_session_is_timed(CagSession *s) { return s->vm && s->vm->uses_time; }
