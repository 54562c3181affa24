// The problems of a document.

#include <string.h>

#include "base/memory.h"
#include "interp/document/document.h"

typedef struct Report {
  CagWorkspace *w;
  Document *d;
  void (*give)(void *context, const CagProblem *p);
  void *context;
  CagArena memory;
} Report;

static const CagModuleUnit *unit_of(const Document *d, const CagSource *source) {
  const CagVm *vm = d->session->vm;
  for (size_t i = 0; source && i < vm->module_count; i++)
    if (vm->modules[i]->source == source) return vm->modules[i];
  return NULL;
}

// A location outside of documents, such as in a formula given as a text, is left empty.
static CagPlace place_of(const Report *r, const CagSource *source, CagSpan span) {
  const CagModuleUnit *m = unit_of(r->d, source);
  if (!m || m->name[0] == '<') return (CagPlace){NULL, 0, 0};
  return cag_document_place(r->w, r->d, m, span);
}

static void report(Report *r, const CagDiagnostic *d) {
  const CagErrorInfo *info = cag_error_info(d->id);
  CagProblem p = {.place = place_of(r, d->source, d->span),
                  .code = info->code,
                  .reason = info->reason,
                  .message = d->message,
                  .help = d->help,
                  .warning = d->severity != CAG_SEVERITY_ERROR,
                  .unused = d->id == CAG_ERR_unused || d->id == CAG_ERR_never_reached,
                  .deprecated = d->id == CAG_ERR_deprecated};
  struct CagProblemNote *notes = cag_arena_alloc(&r->memory, (d->note_count + 1) * sizeof *notes);
  for (size_t i = 0; i < d->note_count; i++) {
    const CagNote *n = &d->notes[i];
    if (n->kind != CAG_NOTE_RELATED || !n->source) continue;
    notes[p.note_count++] =
        (struct CagProblemNote){place_of(r, n->source, n->span), n->text ? n->text : ""};
  }
  p.notes = notes;
  r->give(r->context, &p);
}

static void report_all(void *context) {
  Report *r = context;
  const CagDiagnostics *list = &r->d->session->diagnostics;
  for (size_t i = 0; i < list->count; i++) report(r, cag_diagnostics_at(list, i));
}

int cag_document_check(CagWorkspace *w, const char *file,
                       void (*give)(void *context, const CagProblem *p), void *context) {
  Document *d = cag_workspace_document(w, file);
  if (!d) return CAG_STATUS_LIMIT;
  const bool has_text = cag_document_has_text(w, d);
  if (!has_text || !cag_document_make_checked(w, d)) {
    if (w->options.interrupt && *w->options.interrupt) return CAG_STATUS_INTERRUPTED;
    d->stale = false; // another check would fail as well
    return has_text ? CAG_STATUS_LIMIT : CAG_STATUS_FILE;
  }
  d->stale = false;
  Report r = {w, d, give, context, {0}};
  const bool done = cag_document_guard(report_all, &r);
  cag_arena_free(&r.memory);
  return done ? cag_session_status(d->session) : CAG_STATUS_LIMIT;
}
