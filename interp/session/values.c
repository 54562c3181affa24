// The values of top-level definitions after a run, for editors that show them beside the text.

#include <string.h>

#include "base/memory.h"
#include "interp/session/session.h"
#include "lang/tree.h"

// Longer texts end with "...".
enum { TEXT_MAX = 80 };

typedef struct Values {
  CagSession *session;
  void (*give)(void *context, const CagValueView *v);
  void *context;
} Values;

// Whether the definition says no more than its value: a number or a text, say.
static bool is_plain(const CagModuleUnit *m, const CagDecl *d, const CagString *text) {
  const CagExpr *value = cag_tree_value(d);
  if (!value) return false;
  const CagSpan span = {d->statement->span.start, value->span.end};
  const char *end = m->source->text + span.end;
  const size_t n = text->length;
  return span.end - span.start > n && memcmp(end - n, text->bytes, n) == 0;
}

// Cuts the text after whole characters of UTF-8.
static void shorten(CagString *s) {
  size_t n = TEXT_MAX;
  if (s->length <= TEXT_MAX) return;
  while (n > 0 && ((unsigned char)s->bytes[n] & 0xC0) == 0x80) n--;
  s->length = n;
  cag_string_add(s, "...", 3);
}

static void give_value(const Values *all, CagVm *vm, const CagModuleUnit *m, const CagDecl *d) {
  const CagGlobal *g = &vm->globals[m->tops[d->index]];
  CagString text = {.most = TEXT_MAX};
  if (g->state != CAG_GLOBAL_DONE || cag_is_function(g->value)) return;
  cag_print_value(vm, &text, g->value, true);
  if (text.bytes && !text.failed && !is_plain(m, d, &text)) {
    shorten(&text);
    const CagValueView view = {d->name, text.bytes,
                               cag_session_place(m->source, d->statement->span)};
    if (!text.failed) all->give(all->context, &view);
  }
  cag_string_free(&text);
}

static bool give_values(CagVm *vm, void *context) {
  for (size_t i = 0; i < vm->module_count; i++) {
    const CagModuleUnit *m = vm->modules[i];
    if (!m->source || m->source->library || !m->ast || !m->tops) continue;
    for (size_t k = 0; k < m->ast->top_count; k++) {
      const CagDecl *d = m->ast->tops[k];
      if (d->statement && d->statement->kind != CAG_STATEMENT_PARAM && !d->whole)
        give_value(context, vm, m, d);
    }
  }
  return true;
}

void cag_session_values(CagSession *s, void (*give)(void *context, const CagValueView *v),
                        void *context) {
  if (!cag_session_begin(s)) return;
  if (s->vm && s->main != CAG_NO_MODULE && !s->interactive)
    cag_session_work(s, give_values, &(Values){s, give, context});
  cag_diagnostics_truncate(&s->diagnostics, s->lasting);
  cag_session_end(s, CAG_STATUS_OK);
}
