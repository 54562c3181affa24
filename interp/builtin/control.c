// Errors raised by scripts, and functions that observe values and errors.

#include "interp/builtin/support.h"
#include "interp/vm/vm.h"

bool cag_control_error(CagCall *call, const struct cag_control_error *a, CagValue *result) {
  CagErrorId id = CAG_ERR_user;
  (void)result;
  if (cag_given(call, 1)) {
    id = cag_error_by_reason(a->reason);
    // An attempt does not catch limits.
    if (id == CAG_ERR_COUNT || cag_error_is_limit(id))
      return cag_fail_value(call, 1, "the short name of a kind of error that can be caught");
  }
  // The script's message is shown unchanged, without the name of a function.
  return cag_vm_fail(call->vm, id, "%s", a->message);
}

bool cag_control_attempt(CagCall *call, const struct cag_control_attempt *a, CagValue *result) {
  return cag_vm_attempt(call, a->f, a->handler, result);
}

bool cag_control_trace(CagCall *call, const struct cag_control_trace *a, CagValue *result) {
  cag_vm_trace(call, a->x, a->label);
  *result = a->x;
  return true;
}
