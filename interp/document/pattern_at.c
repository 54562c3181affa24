// The pattern of a definition at a place, for completion.

#include "interp/document/document.h"

typedef struct Search {
  size_t offset;
  PatternAt *out;
} Search;

static bool is_within(const Search *s, CagSpan span) {
  return span.start < s->offset && s->offset < span.end;
}

static void search_pattern(Search *s, const CagPattern *pattern, const CagExpr *value) {
  if (pattern->kind == CAG_PATTERN_NAME || !is_within(s, pattern->span)) return;
  *s->out = (PatternAt){pattern, pattern->kind == CAG_PATTERN_RECORD ? value : NULL};
  for (size_t i = 0; i < pattern->count; i++) {
    const CagPatternPart *part = &pattern->parts[i];
    const bool named = part->field && !cag_pattern_is_shorthand(part) &&
                       part->field_span.end < s->offset && s->offset <= part->pattern->span.end;
    if (named) s->out->value = NULL; // a name is written, not a field
    search_pattern(s, part->pattern, cag_tree_part(pattern, i, value));
  }
}

static void search_statement(Search *s, const CagStatement *st) {
  if (st->kind == CAG_STATEMENT_DEFINITION && st->as.definition.pattern)
    search_pattern(s, st->as.definition.pattern, st->as.definition.value);
}

static void search_blocks(void *context, const CagExpr *e) {
  Search *s = context;
  if (!is_within(s, e->span)) return;
  for (size_t i = 0; e->kind == CAG_EXPR_BLOCK && i < e->as.block.count; i++)
    search_statement(s, e->as.block.statements[i]);
  cag_tree_below(e, search_blocks, s);
}

bool cag_document_pattern(const Document *d, size_t offset, PatternAt *out) {
  Search s = {offset, out};
  *out = (PatternAt){NULL, NULL};
  const CagModuleAst *ast = d->unit->ast;
  const CagStatement *st = ast ? cag_tree_statement(ast, offset) : NULL;
  if (!st) return false;
  search_statement(&s, st);
  cag_tree_of_statement(st, search_blocks, &s);
  return out->pattern;
}
