// The error handler cannot ask the context for user data, because the library holds the lock of the
// context during the call, which would deadlock. So the destination is thread-local.

#include "interp/render/exr_complaint.h"

#include <stdio.h>

static _Thread_local CagExrComplaint *listening;

void cag_exr_complaint_listen(CagExrComplaint *complaint) { listening = complaint; }

void cag_exr_complaint_keep(exr_const_context_t ctxt, exr_result_t code, const char *message) {
  (void)ctxt, (void)code;
  if (listening && !listening->text[0])
    snprintf(listening->text, sizeof listening->text, "%s", message);
}

const char *cag_exr_complaint_text(const CagExrComplaint *complaint, exr_result_t code) {
  return complaint->text[0] ? complaint->text : exr_get_default_error_message(code);
}
