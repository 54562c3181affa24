// Errors of the script's own, and what looks at values and errors on their way.

#include "interp/builtin/support.h"
#include "interp/vm/vm.h"

bool cag_control_error(CagCall *call, const struct cag_control_error *a, CagValue *result) {
  (void)result;
  // As it stands, without a name before it.
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
