// Prints the tree: each kind of node has its form, `(word parts...)`.

#include "lang/dump.h"

#include <string.h>

static const char *const op_signs[] = {
    [CAG_OP_ADD] = "+",        [CAG_OP_SUBTRACT] = "-",       [CAG_OP_MULTIPLY] = "*",
    [CAG_OP_DIVIDE] = "/",     [CAG_OP_MODULO] = "%",         [CAG_OP_POWER] = "^",
    [CAG_OP_UNION] = "|",      [CAG_OP_INTERSECTION] = "&",   [CAG_OP_EQUAL] = "==",
    [CAG_OP_NOT_EQUAL] = "!=", [CAG_OP_LESS] = "<",           [CAG_OP_LESS_EQUAL] = "<=",
    [CAG_OP_GREATER] = ">",    [CAG_OP_GREATER_EQUAL] = ">=", [CAG_OP_IN] = "in",
};

static void dump_statement(FILE *out, const CagStatement *s);

static void dump_text(FILE *out, const char *bytes, size_t length) {
  fputc('"', out);
  for (size_t i = 0; i < length; i++) {
    if (bytes[i] == '\n') fputs("\\n", out);
    else if (bytes[i] == '\t') fputs("\\t", out);
    else if (bytes[i] == '"' || bytes[i] == '\\') fprintf(out, "\\%c", bytes[i]);
    else fputc(bytes[i], out);
  }
  fputc('"', out);
}

static void dump_two(FILE *out, const char *word, const CagExpr *a, const CagExpr *b) {
  fprintf(out, "(%s ", word);
  cag_expr_dump(out, a);
  if (b) {
    fputc(' ', out);
    cag_expr_dump(out, b);
  }
  fputc(')', out);
}

static void dump_list(FILE *out, const char *word, CagExpr *const *items, size_t count) {
  fprintf(out, "(%s", word);
  for (size_t i = 0; i < count; i++) {
    fputc(' ', out);
    cag_expr_dump(out, items[i]);
  }
  fputc(')', out);
}

static void dump_pattern(FILE *out, const CagPattern *pattern) {
  if (pattern->kind == CAG_PATTERN_NAME) {
    fputs(pattern->decl->name, out);
    return;
  }
  const bool list = pattern->kind == CAG_PATTERN_LIST;
  fputs(list ? "[" : "{", out);
  for (size_t i = 0; i < pattern->count; i++) {
    const CagPatternPart *part = &pattern->parts[i];
    if (i) fputc(' ', out);
    if (part->field) fprintf(out, "%s: ", part->field);
    dump_pattern(out, part->pattern);
  }
  if (pattern->rest) fprintf(out, "%s...%s", pattern->count ? " " : "", pattern->rest->name);
  fputs(list ? "]" : "}", out);
}

static void dump_parameters(FILE *out, const CagFunctionAst *f) {
  fputc('(', out);
  for (size_t i = 0; i < f->parameter_count; i++) {
    if (i) fputc(' ', out);
    const CagParameter *p = &f->parameters[i];
    if (p->fallback) {
      fprintf(out, "(%s ", p->decl->name);
      cag_expr_dump(out, p->fallback);
      fputc(')', out);
    } else if (p->pattern) {
      dump_pattern(out, p->pattern);
    } else {
      fputs(p->decl->name, out);
    }
  }
  fputc(')', out);
}

static void dump_comprehension(FILE *out, const CagExpr *e) {
  fputs("(for", out);
  for (size_t i = 0; i < e->as.comprehension.count; i++) {
    const CagClause *c = &e->as.comprehension.clauses[i];
    fputs(" (", out);
    dump_pattern(out, c->pattern);
    fputc(' ', out);
    cag_expr_dump(out, c->source);
    if (c->filter) {
      fputs(" if ", out);
      cag_expr_dump(out, c->filter);
    }
    fputc(')', out);
  }
  fputc(' ', out);
  cag_expr_dump(out, e->as.comprehension.body);
  fputc(')', out);
}

static void dump_record(FILE *out, const CagExpr *e) {
  fputs("(record", out);
  for (size_t i = 0; i < e->as.record.count; i++) {
    const CagField *f = &e->as.record.fields[i];
    fprintf(out, " (%s ", f->name ? f->name : "...");
    cag_expr_dump(out, f->value);
    fputc(')', out);
  }
  fputc(')', out);
}

static void dump_block(FILE *out, const CagExpr *e) {
  fputs("(block", out);
  for (size_t i = 0; i < e->as.block.count; i++) {
    fputc(' ', out);
    dump_statement(out, e->as.block.statements[i]);
  }
  fputc(' ', out);
  cag_expr_dump(out, e->as.block.value);
  fputc(')', out);
}

static void dump_call(FILE *out, const CagExpr *e) {
  fputs("(call ", out);
  cag_expr_dump(out, e->as.call.callee);
  for (size_t i = 0; i < e->as.call.count; i++) {
    const CagArgument *a = &e->as.call.arguments[i];
    fputc(' ', out);
    if (a->name) fprintf(out, "%s: ", a->name);
    cag_expr_dump(out, a->value);
  }
  fputc(')', out);
}

void cag_expr_dump(FILE *out, const CagExpr *e) {
  switch (e->kind) {
  case CAG_EXPR_NUMBER: fprintf(out, "%.17g", e->as.number); break;
  case CAG_EXPR_ANGLE: fprintf(out, "%.17gdeg", e->as.number); break;
  case CAG_EXPR_TEXT: dump_text(out, e->as.text.bytes, e->as.text.length); break;
  case CAG_EXPR_TEMPLATE: dump_list(out, "text", e->as.list.items, e->as.list.count); break;
  case CAG_EXPR_TRUE: fputs("true", out); break;
  case CAG_EXPR_FALSE: fputs("false", out); break;
  case CAG_EXPR_NONE: fputs("none", out); break;
  case CAG_EXPR_NAME: fputs(e->as.name.id, out); break;
  case CAG_EXPR_GROUP: dump_two(out, "group", e->as.unary.operand, NULL); break;
  case CAG_EXPR_LIST: dump_list(out, "list", e->as.list.items, e->as.list.count); break;
  case CAG_EXPR_SPREAD: dump_two(out, "...", e->as.unary.operand, NULL); break;
  case CAG_EXPR_COMPREHENSION: dump_comprehension(out, e); break;
  case CAG_EXPR_RECORD: dump_record(out, e); break;
  case CAG_EXPR_BLOCK: dump_block(out, e); break;
  case CAG_EXPR_LAMBDA:
    fputs("(=> ", out);
    dump_parameters(out, e->as.function);
    fputc(' ', out);
    cag_expr_dump(out, e->as.function->body);
    fputc(')', out);
    break;
  case CAG_EXPR_IF:
    fputs("(if ", out);
    cag_expr_dump(out, e->as.branch.condition);
    fputc(' ', out);
    cag_expr_dump(out, e->as.branch.then);
    fputc(' ', out);
    cag_expr_dump(out, e->as.branch.otherwise);
    fputc(')', out);
    break;
  case CAG_EXPR_NEGATE: dump_two(out, "neg", e->as.unary.operand, NULL); break;
  case CAG_EXPR_NOT: dump_two(out, "not", e->as.unary.operand, NULL); break;
  case CAG_EXPR_BINARY:
    dump_two(out, op_signs[e->as.binary.op], e->as.binary.left, e->as.binary.right);
    break;
  case CAG_EXPR_AND: dump_two(out, "and", e->as.binary.left, e->as.binary.right); break;
  case CAG_EXPR_OR: dump_two(out, "or", e->as.binary.left, e->as.binary.right); break;
  case CAG_EXPR_PIPE: dump_two(out, "|>", e->as.binary.left, e->as.binary.right); break;
  case CAG_EXPR_RANGE:
    fprintf(out, "(%s ", e->as.range.open ? "..<" : "..");
    cag_expr_dump(out, e->as.range.low);
    fputc(' ', out);
    cag_expr_dump(out, e->as.range.high);
    if (e->as.range.step) {
      fputs(" by ", out);
      cag_expr_dump(out, e->as.range.step);
    }
    fputc(')', out);
    break;
  case CAG_EXPR_CALL: dump_call(out, e); break;
  case CAG_EXPR_INDEX: dump_two(out, "index", e->as.binary.left, e->as.binary.right); break;
  case CAG_EXPR_MEMBER:
    fputs("(. ", out);
    cag_expr_dump(out, e->as.member.object);
    fprintf(out, " %s)", e->as.member.name);
    break;
  case CAG_EXPR_ERROR: fputs("<error>", out); break;
  }
}

static void dump_import(FILE *out, const CagStatement *s) {
  fputs("(import ", out);
  if (s->as.import.is_text) dump_text(out, s->as.import.path, strlen(s->as.import.path));
  else fputs(s->as.import.path, out);
  if (s->as.import.decl) fprintf(out, " as %s", s->as.import.decl->name);
  if (s->as.import.name_count) fputs(" :", out);
  for (size_t i = 0; i < s->as.import.name_count; i++)
    fprintf(out, " %s", s->as.import.names[i].name);
  fputc(')', out);
}

static void dump_statement(FILE *out, const CagStatement *s) {
  switch (s->kind) {
  case CAG_STATEMENT_IMPORT: dump_import(out, s); break;
  case CAG_STATEMENT_PARAM:
    fprintf(out, "(param %s ", s->as.param.decl->name);
    cag_expr_dump(out, s->as.param.value);
    if (s->as.param.domain) {
      fputs(" in ", out);
      cag_expr_dump(out, s->as.param.domain);
    }
    if (s->as.param.label) {
      fputc(' ', out);
      dump_text(out, s->as.param.label, strlen(s->as.param.label));
    }
    fputc(')', out);
    break;
  case CAG_STATEMENT_DEFINITION:
    fputs("(= ", out);
    if (s->as.definition.pattern) dump_pattern(out, s->as.definition.pattern);
    else fputs(s->as.definition.decl->name, out);
    fputc(' ', out);
    cag_expr_dump(out, s->as.definition.value);
    fputc(')', out);
    break;
  case CAG_STATEMENT_SHOW: dump_list(out, "show", s->as.list.items, s->as.list.count); break;
  case CAG_STATEMENT_PRINT: dump_list(out, "print", s->as.list.items, s->as.list.count); break;
  case CAG_STATEMENT_ASSERT:
    dump_two(out, "assert", s->as.assertion.condition, s->as.assertion.message);
    break;
  case CAG_STATEMENT_EXPRESSION: cag_expr_dump(out, s->as.expression); break;
  }
}

void cag_ast_dump(FILE *out, const CagModuleAst *m) {
  for (size_t i = 0; i < m->count; i++) {
    dump_statement(out, m->statements[i]);
    fputc('\n', out);
  }
}
