// The handler cannot ask the context for user data: the library calls it while it holds the lock of
// the context, which that call would wait for. So the place to write to belongs to the thread.

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
