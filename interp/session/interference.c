// Parts of what a script shows that share volume.

#include "interp/builtin/assemblies.h"
#include "interp/session/session.h"

// The most pairs that are reported.
#define PAIRS_MOST 10000

static bool shown_value(CagSession *s, CagVm *vm, CagValue *out) {
  if (s->only) return cag_session_find_definition(s, s->only, out);
  CagBuilder *all = cag_builder_new(vm);
  for (size_t i = 0; i < vm->shown_count; i++)
    if (!cag_builder_add(vm, all, vm->shown[i].value)) return false;
  *out = cag_builder_finish(vm, all);
  return true;
}

// Where the script made or placed the part. No source: unknown.
static const CagSource *part_place(const CagPart *part, CagSpan *span) {
  const CagOriginSite *at = part->last ? part->last->site : NULL;
  *span = (CagSpan){0, 0};
  if (!at) return NULL;
  *span = at->caller ? at->caller_span : at->span;
  return at->caller ? at->caller : at->source;
}

static void report_clash(CagSession *s, const CagParts *parts, const CagClash *clash) {
  const CagPart *a = &parts->items[clash->a], *b = &parts->items[clash->b];
  CagSpan span, other;
  const CagSource *source = part_place(a, &span), *second = part_place(b, &other);
  CagDiagnostic *d =
      cag_diagnostics_add(&s->diagnostics, CAG_ERR_interference, source, span,
                          "parts `%s` and `%s` share %.6g mm3", a->name, b->name, clash->volume);
  if (second) cag_diagnostic_add_note(d, CAG_NOTE_RELATED, second, other, "`%s` is here", b->name);
}

static bool find_clashes(CagSession *s, CagVm *vm, CagCall *call, CagValue v) {
  CagClash *clashes;
  size_t n;
  CagParts *parts = cag_parts_of(call, v, false);
  if (!parts) return false;
  for (size_t i = 0; i < parts->body_count; i++)
    if (!(parts->bodies[i].tolerance > 0)) parts->bodies[i].tolerance = s->options.tolerance;
  if (!cag_parts_clashes(call, parts, &clashes, &n)) return false;
  const size_t usual = s->diagnostics.most;
  s->diagnostics.most = PAIRS_MOST;
  for (size_t i = 0; i < n; i++) report_clash(s, parts, &clashes[i]);
  s->diagnostics.most = usual;
  return n == 0 && !vm->failed;
}

static bool look_for_interference(CagVm *vm, void *context) {
  CagSession *s = context;
  CagValue v;
  size_t rows;
  if (!shown_value(s, vm, &v)) return false;
  CagCall call = {vm, cag_builtin_rows(cag_builtin_find("interference"), &rows), &v, 1,
                  &vm->core_error};
  const size_t held = vm->held_count;
  const bool none = find_clashes(s, vm, &call, v);
  cag_vm_release_held(vm, held);
  return none;
}

int cag_session_interference(CagSession *s) {
  if (!cag_session_begin(s)) return CAG_STATUS_USAGE;
  return cag_session_end(s, cag_session_work(s, look_for_interference, s));
}
