// Reporting by the checker, and the types of names.

#include "interp/check/walk.h"

#include <string.h>

// Definitions are checked at their first use. Longer chains are not followed.
#define DEPTH_MAX 1000

// ---- reports ----

CagDiagnostic *cag_check_report(Check *c, CagErrorId id, CagSpan span, const char *message) {
  if (c->unjudged) {
    cag_diagnostics_clear(&c->ignored);
    return cag_diagnostics_add(&c->ignored, id, c->ast->source, span, "%s", message);
  }
  return cag_diagnostics_add(&c->vm->errors, id, c->ast->source, span, "%s", message);
}

CagDiagnostic *cag_check_warn(Check *c, CagErrorId id, CagSpan span, const char *message) {
  CagDiagnostic *d = cag_check_report(c, id, span, message);
  d->severity = CAG_SEVERITY_WARNING;
  return d;
}

void cag_check_report_found(Check *c, CagErrorId id, CagSpan span, const char *wanted,
                            CagTypes types) {
  char found[256], text[512];
  snprintf(text, sizeof text, "%s, found %s", wanted, cag_types_text(types, found, sizeof found));
  cag_check_report(c, id, span, text);
}

size_t cag_check_error_count(const Check *c) { return c->vm->errors.count + c->vm->errors.dropped; }

// ---- types of names ----

static size_t slot_of(const Check *c, const CagDecl *decl) {
  size_t i = ((size_t)decl >> 4) * 0x9E3779B97F4A7C15u >> 20 & (c->known_size - 1);
  while (c->known[i].decl && c->known[i].decl != decl) i = (i + 1) & (c->known_size - 1);
  return i;
}

void cag_check_learn(Check *c, const CagDecl *decl, CagTypes types) {
  if (!decl) return;
  if (2 * (c->known_count + 1) > c->known_size) {
    Known *const old = c->known;
    const size_t old_size = c->known_size;
    c->known_size = old_size ? 2 * old_size : 256;
    c->known = cag_arena_alloc(&c->memory, c->known_size * sizeof *c->known);
    for (size_t i = 0; i < old_size; i++)
      if (old[i].decl) c->known[slot_of(c, old[i].decl)] = old[i];
  }
  const size_t i = slot_of(c, decl);
  c->known_count += !c->known[i].decl;
  c->known[i] = (Known){decl, types};
}

static CagTypes types_known(const Check *c, const CagDecl *decl) {
  if (!c->known_size) return CAG_TYPES_ANY;
  const Known *k = &c->known[slot_of(c, decl)];
  return k->decl ? k->types : CAG_TYPES_ANY;
}

static void use_top(Check *c, size_t used) {
  if (c->edge_count == c->edge_capacity) {
    const size_t *const old = c->edges;
    c->edge_capacity = 2 * c->edge_capacity + 64;
    c->edges = cag_arena_alloc(&c->memory, 2 * c->edge_capacity * sizeof *c->edges);
    if (old) memcpy(c->edges, old, 2 * c->edge_count * sizeof *c->edges);
  }
  c->edges[2 * c->edge_count] = c->top;
  c->edges[2 * c->edge_count++ + 1] = used;
}

// Checks the definition of a pattern, which stands for all its names.
static void check_whole(Check *c, const CagDecl *whole) {
  const CagPattern *pattern = whole->statement->as.definition.pattern;
  const CagExpr *value = whole->statement->as.definition.value;
  cag_check_learn_pattern(c, pattern, c->top_types[whole->index], value);
  for (size_t i = 0; i < pattern->name_count; i++) {
    const size_t k = pattern->names[i]->index;
    c->top_types[k] = types_known(c, pattern->names[i]);
    c->top_done[k] = true;
  }
}

// Returns the types of a name of a pattern at the top level.
static CagTypes types_of_part(Check *c, const CagDecl *decl) {
  const CagDecl *whole = decl->statement->as.definition.decl;
  cag_check_types_of_top(c, whole);
  if (c->top_bad[whole->index]) c->top_bad[decl->index] = true;
  return c->top_done[decl->index] ? c->top_types[decl->index] : CAG_TYPES_ANY;
}

static bool is_part(const CagDecl *decl) {
  return decl->statement->kind == CAG_STATEMENT_DEFINITION &&
         decl->statement->as.definition.decl != decl;
}

CagTypes cag_check_types_of_top(Check *c, const CagDecl *decl) {
  const size_t k = decl->index;
  if (decl->statement->damage != CAG_SOUND) return CAG_TYPES_ANY;
  if (is_part(decl)) return types_of_part(c, decl);
  if (c->top_done[k]) return c->top_types[k];
  if (c->top_busy[k] || c->depth > DEPTH_MAX) return CAG_TYPES_ANY;
  const size_t outer = c->top, errors = cag_check_error_count(c);
  const CagStatement *s = decl->statement;
  c->top_busy[k] = true;
  c->depth++;
  c->top = k;
  c->top_types[k] = cag_check_infer(c, s->kind == CAG_STATEMENT_PARAM ? s->as.param.value
                                                                      : s->as.definition.value);
  if (s->kind == CAG_STATEMENT_PARAM && s->as.param.domain) cag_check_infer(c, s->as.param.domain);
  if (decl->whole) check_whole(c, decl);
  c->top = outer;
  c->depth--;
  c->top_done[k] = true;
  if (cag_check_error_count(c) > errors) c->top_bad[k] = true;
  return c->top_types[k];
}

const CagDecl *cag_check_find_public(const Check *c, const CagStatement *import, const char *name) {
  if (!import || import->kind != CAG_STATEMENT_IMPORT || import->as.import.module == CAG_NO_MODULE)
    return NULL;
  const CagModuleUnit *m = c->vm->modules[import->as.import.module];
  for (size_t i = 0; i < m->public_count; i++)
    if (strcmp(m->publics[i].name, name) == 0) return m->publics[i].decl;
  return NULL;
}

void cag_check_deprecated(Check *c, const CagDecl *decl, const char *name, CagSpan span) {
  const char *said = decl && decl->doc ? strstr(decl->doc, "deprecated:") : NULL;
  if (!said || c->again) return;
  said += strlen("deprecated:");
  said += strspn(said, " ");
  CagDiagnostic *d = cag_diagnostics_add(&c->vm->errors, CAG_ERR_deprecated, c->ast->source, span,
                                         "%s is deprecated", name);
  d->severity = CAG_SEVERITY_WARNING;
  cag_diagnostic_set_help(d, "%.*s", (int)strcspn(said, "\n"), said);
}

static CagTypes types_of_builtin(size_t index) {
  if (index >= cag_builtin_count()) return CAG_TYPES(NUMBER); // time, frame, frames
  size_t rows;
  const CagBuiltin *row = cag_builtin_rows(index, &rows);
  return row->function ? CAG_TYPES(BUILTIN) : cag_types_of_result(row->result);
}

CagTypes cag_check_infer_name(Check *c, const CagExpr *e) {
  const CagDecl *decl = e->as.name.decl;
  if (e->as.name.binding == CAG_BIND_BUILTIN) return types_of_builtin(e->as.name.index);
  if (e->as.name.binding != CAG_BIND_DECL || !decl) return CAG_TYPES_ANY;
  switch (decl->kind) {
  case CAG_DECL_TOP:
    use_top(c, decl->index);
    if (is_part(decl)) use_top(c, decl->statement->as.definition.decl->index);
    cag_check_deprecated(c, decl, decl->name, e->span);
    return cag_check_types_of_top(c, decl);
  case CAG_DECL_IMPORT: return CAG_TYPES(MODULE);
  case CAG_DECL_IMPORTED:
    cag_check_deprecated(c, cag_check_find_public(c, decl->statement, decl->name), decl->name,
                         e->span);
    return CAG_TYPES_ANY;
  default: return types_known(c, decl);
  }
}
