// Errors of the script's own, and what looks at values and errors on their way.

#include "interp/builtin/support.h"
#include "interp/vm/vm.h"

static const char FAMILY[] = "Errors";

static bool call_error(CagCall *call, CagValue *result) {
  const char *message;
  (void)result;
  if (!cag_arg_text(call, 0, &message)) return false;
  return cag_vm_fail(call->vm, CAG_ERR_user, "%s",
                     message); // as it stands, without a name before it
}

static bool call_attempt(CagCall *call, CagValue *result) {
  CagValue f, handler;
  if (!cag_arg_function(call, 0, &f) || !cag_arg_function(call, 1, &handler)) return false;
  return cag_vm_attempt(call, f, handler, result);
}

static bool call_trace(CagCall *call, CagValue *result) {
  const char *label = "";
  if (cag_given(call, 1) && !cag_arg_text(call, 1, &label)) return false;
  cag_vm_trace(call, call->values[0], label);
  *result = call->values[0];
  return true;
}

const CagBuiltin cag_builtins_control[] = {
    {"error(message: text)", call_error, "none",
     "Stops the script with this message, or ends the enclosing attempt.",
     "print attempt(() => error(\"no such size\"), err => err.message) // expect: no such size", 0,
     FAMILY},
    {"attempt(f: function () => value, handler: function err => value)", call_attempt, "any",
     "Returns f(). If f stops with an error, returns handler(err) instead. err is a record with "
     "the fields message, code, reason, file, line, and column. Limits of the run (memory, time, "
     "depth) are not caught.",
     "print attempt(() => 1/0, err => err.code) // expect: E0307", 0, FAMILY},
    {"trace(x: any value, label: text = \"\")", call_trace, "as x",
     "Writes x and its location in the script to standard error, and returns x.",
     "print trace(1 + 1, \"sum\") * 2 // expect: 4", 0, FAMILY},
    {0}};
