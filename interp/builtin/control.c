// Errors of the script's own, and what looks at values and errors on their way.

#include "interp/builtin/support.h"
#include "interp/vm/vm.h"

bool cag_control_error(CagCall *call, CagValue *result) {
  const char *message;
  (void)result;
  if (!cag_arg_text(call, 0, &message)) return false;
  return cag_vm_fail(call->vm, CAG_ERR_user, "%s",
                     message); // as it stands, without a name before it
}

bool cag_control_attempt(CagCall *call, CagValue *result) {
  CagValue f, handler;
  if (!cag_arg_function(call, 0, &f) || !cag_arg_function(call, 1, &handler)) return false;
  return cag_vm_attempt(call, f, handler, result);
}

bool cag_control_trace(CagCall *call, CagValue *result) {
  const char *label = "";
  if (cag_given(call, 1) && !cag_arg_text(call, 1, &label)) return false;
  cag_vm_trace(call, call->values[0], label);
  *result = call->values[0];
  return true;
}
