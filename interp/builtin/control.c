// Errors raised by scripts, and functions that observe values and errors.

#include "interp/builtin/support.h"
#include "interp/vm/vm.h"

bool cag_control_error(CagCall *call, const struct cag_control_error *a, CagValue *result) {
  (void)result;
  // The script's message is shown unchanged, without the name of a function.
  return cag_vm_fail(call->vm, CAG_ERR_user, "%s", a->message);
}

bool cag_control_attempt(CagCall *call, const struct cag_control_attempt *a, CagValue *result) {
  return cag_vm_attempt(call, a->f, a->handler, result);
}

bool cag_control_trace(CagCall *call, const struct cag_control_trace *a, CagValue *result) {
  cag_vm_trace(call, a->x, a->label);
  *result = a->x;
  return true;
}
