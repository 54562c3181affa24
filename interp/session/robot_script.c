// Where a script says the joint values of a robot: the numbers in the list `q` of a call of
// `posed`.

#include <string.h>

#include "interp/session/robots.h"
#include "interp/vm/builtin.h"
#include "lang/tree.h"

// --- The call ---

typedef struct Search {
  CagSpan span;        // of the call or pipe
  const CagExpr *call; // NULL: not found; the name of the function if it has no parentheses
  bool piped;          // its first argument is before `|>`
} Search;

static bool is_posed(const CagExpr *callee) {
  return callee->kind == CAG_EXPR_NAME && callee->as.name.binding == CAG_BIND_BUILTIN &&
         callee->as.name.index == cag_builtin_find("posed");
}

static const CagExpr *callee_of(const CagExpr *e) {
  return e->kind == CAG_EXPR_CALL ? e->as.call.callee : e;
}

static bool is_span(CagSpan a, CagSpan b) { return a.start == b.start && a.end == b.end; }

static void look_for_call(void *context, const CagExpr *e) {
  Search *s = context;
  if (s->call || e->span.start > s->span.start || e->span.end < s->span.end) return;
  if (e->kind == CAG_EXPR_PIPE && is_posed(callee_of(e->as.binary.right)) &&
      (is_span(e->span, s->span) || is_span(e->as.binary.right->span, s->span))) {
    s->call = e->as.binary.right;
    s->piped = true;
  } else if (e->kind == CAG_EXPR_CALL && is_span(e->span, s->span) && is_posed(callee_of(e))) {
    s->call = e;
  } else {
    cag_tree_below(e, look_for_call, s);
  }
}

static const CagModuleUnit *unit_of(const CagVm *vm, const CagSource *source) {
  for (size_t i = 0; i < vm->module_count; i++)
    if (vm->modules[i] && vm->modules[i]->source == source) return vm->modules[i];
  return NULL;
}

static bool find_call(const CagVm *vm, const CagOriginStep *step, Search *out) {
  *out = (Search){.span = step->site->span};
  const CagModuleUnit *m = step->site->source ? unit_of(vm, step->site->source) : NULL;
  if (!m || !m->ast) return false;
  for (size_t i = 0; i < m->ast->count && !out->call; i++)
    cag_tree_of_statement(m->ast->statements[i], look_for_call, out);
  return out->call != NULL;
}

// The argument `q`, or NULL. The first parameter is the robot.
static const CagExpr *argument_q(const Search *found) {
  if (found->call->kind != CAG_EXPR_CALL) return NULL;
  const size_t at = found->piped ? 0 : 1;
  for (size_t i = 0; i < found->call->as.call.count; i++) {
    const CagArgument *a = &found->call->as.call.arguments[i];
    if (a->name ? !strcmp(a->name, "q") : i == at) return a->value;
  }
  return NULL;
}

// --- The list ---

// Follows parentheses, and names of definitions and params in the same file.
static const CagExpr *said_value(const CagExpr *e) {
  enum { MOST_STEPS = 100 };
  for (int steps = 0; steps < MOST_STEPS; steps++) {
    if (e->kind == CAG_EXPR_GROUP) {
      e = e->as.unary.operand;
      continue;
    }
    const CagDecl *decl =
        e->kind == CAG_EXPR_NAME && e->as.name.binding == CAG_BIND_DECL ? e->as.name.decl : NULL;
    if (!decl || (decl->kind != CAG_DECL_TOP && decl->kind != CAG_DECL_BLOCK)) return e;
    const CagExpr *value = cag_tree_value(decl);
    if (!value) return e;
    e = value;
  }
  return e;
}

static bool is_number(const CagExpr *e) {
  if (e->kind == CAG_EXPR_NEGATE) e = e->as.unary.operand;
  return e->kind == CAG_EXPR_NUMBER || e->kind == CAG_EXPR_ANGLE;
}

typedef struct Said {
  const CagSource *source;
  const CagExpr *list;
  const char *why; // there is none; NULL: there is
} Said;

static const char *why_not(const CagExpr *list, size_t joints) {
  if (list->kind != CAG_EXPR_LIST) return "the script computes q";
  if (list->as.list.count != joints) return "q has spreads";
  for (size_t i = 0; i < joints; i++)
    if (!is_number(list->as.list.items[i])) return "the script computes values of q";
  return NULL;
}

// The latest call of `posed` that the part went through made it a limb of this robot.
static Said said_joints(const CagSession *s, const CagSessionRobot *robot) {
  const CagShape *shape = s->robots->parts[robot->first].shape;
  Search found = {0};
  const CagOriginStep *step = shape->origin.last;
  while (step && !find_call(s->vm, step, &found)) step = step->before;
  if (!step) return (Said){.why = "the script shows the robot without posed"};
  if (step->site->source->library) return (Said){.why = "the library calls posed"};
  const CagExpr *q = argument_q(&found);
  if (!q) return (Said){.why = "the script gives posed no q"};
  const CagExpr *list = said_value(q);
  return (Said){step->site->source, list, why_not(list, robot->chain->joint_count)};
}

const char *cag_session_robot_joint_place(CagSession *s, size_t robot, size_t joint,
                                          CagPlaceView *out) {
  *out = (CagPlaceView){0};
  if (!cag_session_begin(s)) return "another call is under way";
  const CagSessionRobot *r = cag_session_robot_at(s, robot);
  const bool found = r && joint < r->chain->joint_count;
  const Said said = found ? said_joints(s, r) : (Said){.why = "there is no such joint"};
  if (!said.why) *out = cag_session_place(said.source, said.list->as.list.items[joint]->span);
  cag_session_end(s, CAG_STATUS_OK);
  return said.why;
}
