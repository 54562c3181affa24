// Finds circular definitions in scripts without syntax errors. In the graph, node 2k is the value
// of definition k, and node 2k + 1 is a call of it. The depth-first search uses an explicit stack
// because chains may be long.

#include <string.h>

#include "base/arena.h"
#include "interp/check/circle.h"

typedef struct Edge {
  size_t to;
  CagSpan span; // of the name
} Edge;

typedef struct Node {
  Edge *edges;
  size_t count, capacity, next; // next: the edge to follow next
  enum { NEW, OPEN, DONE } state;
} Node;

typedef struct Graph {
  const CagModuleAst *ast;
  Node *nodes;
  size_t from; // definition whose expression is being searched
  CagArena memory;
} Graph;

static const CagFunctionAst *function_of(const CagStatement *s) {
  if (s->kind != CAG_STATEMENT_DEFINITION || s->as.definition.value->kind != CAG_EXPR_LAMBDA)
    return NULL;
  return s->as.definition.value->as.function;
}

// ---- edges ----

static void walk(Graph *g, const CagExpr *e);

// The whole of a pattern stands for its names.
static const CagDecl *top_of_statement(const CagStatement *s) {
  return s->kind == CAG_STATEMENT_PARAM ? s->as.param.decl : s->as.definition.decl;
}

static const CagDecl *top_of(const CagExpr *e) {
  if (e->kind != CAG_EXPR_NAME || e->as.name.binding != CAG_BIND_DECL) return NULL;
  const CagDecl *d = e->as.name.decl;
  return d->kind == CAG_DECL_TOP ? top_of_statement(d->statement) : NULL;
}

static void add_edge(Graph *g, const CagExpr *name, bool called) {
  const CagDecl *d = top_of(name);
  Node *n = &g->nodes[g->from];
  if (!d) return;
  if (n->count == n->capacity) {
    const Edge *const old = n->edges;
    n->capacity = 2 * n->capacity + 4;
    n->edges = cag_arena_alloc(&g->memory, n->capacity * sizeof *n->edges);
    if (old) memcpy(n->edges, old, n->count * sizeof *n->edges);
  }
  n->edges[n->count++] = (Edge){2 * d->index + called, name->span};
}

static void walk_callee(Graph *g, const CagExpr *callee) {
  const CagDecl *d = top_of(callee);
  if (d && function_of(d->statement)) add_edge(g, callee, true);
  else walk(g, callee);
}

static void walk_arguments(Graph *g, const CagExpr *call) {
  for (size_t i = 0; i < call->as.call.count; i++) walk(g, call->as.call.arguments[i].value);
}

static void walk_block(Graph *g, const CagExpr *e) {
  for (size_t i = 0; i < e->as.block.count; i++) {
    const CagStatement *s = e->as.block.statements[i];
    walk(g, s->kind == CAG_STATEMENT_ASSERT ? s->as.assertion.condition : s->as.definition.value);
  }
  walk(g, e->as.block.value);
}

static void walk(Graph *g, const CagExpr *e) {
  switch (e->kind) {
  case CAG_EXPR_NAME: add_edge(g, e, false); break;
  case CAG_EXPR_GROUP:
  case CAG_EXPR_SPREAD:
  case CAG_EXPR_NEGATE:
  case CAG_EXPR_NOT: walk(g, e->as.unary.operand); break;
  case CAG_EXPR_TEMPLATE:
  case CAG_EXPR_LIST:
    for (size_t i = 0; i < e->as.list.count; i++) walk(g, e->as.list.items[i]);
    break;
  case CAG_EXPR_RECORD:
    for (size_t i = 0; i < e->as.record.count; i++) walk(g, e->as.record.fields[i].value);
    break;
  case CAG_EXPR_BLOCK: walk_block(g, e); break;
  case CAG_EXPR_BINARY:
  case CAG_EXPR_INDEX:
    walk(g, e->as.binary.left);
    walk(g, e->as.binary.right);
    break;
  case CAG_EXPR_AND:
  case CAG_EXPR_OR: walk(g, e->as.binary.left); break;
  case CAG_EXPR_PIPE:
    walk(g, e->as.binary.left);
    if (e->as.binary.right->kind == CAG_EXPR_CALL) {
      walk_callee(g, e->as.binary.right->as.call.callee);
      walk_arguments(g, e->as.binary.right);
    } else {
      walk_callee(g, e->as.binary.right);
    }
    break;
  case CAG_EXPR_CALL:
    walk_callee(g, e->as.call.callee);
    walk_arguments(g, e);
    break;
  case CAG_EXPR_RANGE:
    walk(g, e->as.range.low);
    walk(g, e->as.range.high);
    if (e->as.range.step) walk(g, e->as.range.step);
    break;
  case CAG_EXPR_IF: walk(g, e->as.branch.condition); break;
  case CAG_EXPR_MEMBER: walk(g, e->as.member.object); break;
  case CAG_EXPR_COMPREHENSION: walk(g, e->as.comprehension.clauses[0].source); break;
  default: break;
  }
}

// ---- search ----

// Reports the circle that the edge at `span` closes: the path from its node `at` on. A circle that
// consists only of calls is a recursion, which is valid.
static void report_circle(const Graph *g, const size_t *path, size_t length, size_t at,
                          CagSpan span, CagDiagnostics *errors) {
  CagString s = {0};
  const char *first = NULL;
  for (size_t i = at; i < length; i++) {
    if (path[i] % 2) continue;
    const char *name = g->ast->tops[path[i] / 2]->name;
    if (!first) first = name;
    cag_string_printf(&s, "%s -> ", name);
  }
  if (s.failed) cag_memory_leave();
  if (first)
    cag_diagnostics_add(errors, CAG_ERR_circle, g->ast->source, span,
                        "the value of `%s` depends on itself: %s%s", first, s.bytes, first);
  cag_string_free(&s);
}

static void search(Graph *g, size_t start, size_t *path, CagDiagnostics *errors) {
  size_t length = 0;
  path[length++] = start;
  g->nodes[start].state = OPEN;
  while (length) {
    Node *n = &g->nodes[path[length - 1]];
    if (n->next == n->count) {
      n->state = DONE;
      length--;
      continue;
    }
    const Edge edge = n->edges[n->next++];
    Node *to = &g->nodes[edge.to];
    if (to->state == NEW) {
      to->state = OPEN;
      path[length++] = edge.to;
    } else if (to->state == OPEN) {
      size_t at = length;
      while (path[--at] != edge.to) {}
      report_circle(g, path, length, at, edge.span, errors);
    }
  }
}

static void free_graph(void *g) { cag_arena_free(&((Graph *)g)->memory); }

void cag_check_circles(const CagModuleAst *ast, CagDiagnostics *errors) {
  const size_t n = ast->top_count;
  Graph g = {.ast = ast};
  CagCleanup cleanup;
  cag_cleanup_push(&cleanup, free_graph, &g);
  g.nodes = cag_arena_alloc(&g.memory, (2 * n + 1) * sizeof *g.nodes);
  size_t *path = cag_arena_alloc(&g.memory, (2 * n + 1) * sizeof *path);
  for (size_t k = 0; k < n; k++) {
    const CagStatement *s = ast->tops[k]->statement;
    if (s->damage != CAG_SOUND || top_of_statement(s) != ast->tops[k]) continue;
    const CagFunctionAst *f = function_of(s);
    g.from = 2 * k + (f != NULL);
    if (f) walk(&g, f->body);
    else walk(&g, s->kind == CAG_STATEMENT_PARAM ? s->as.param.value : s->as.definition.value);
  }
  for (size_t k = 0; k < n; k++) // starting from values, as a run does
    if (g.nodes[2 * k].state == NEW) search(&g, 2 * k, path, errors);
  cag_cleanup_run(&cleanup);
}
