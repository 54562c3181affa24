// What the EXR library says of an error, kept for our own messages.

#ifndef CAG_INTERP_RENDER_EXR_COMPLAINT_H
#define CAG_INTERP_RENDER_EXR_COMPLAINT_H

#include <openexr.h>

// The first message of the library; "" while there is none.
typedef struct CagExrComplaint {
  char text[256];
} CagExrComplaint;

// Makes the handler below fill `complaint` when it is called on this thread, from now on. NULL:
// messages are dropped.
void cag_exr_complaint_listen(CagExrComplaint *complaint);

// The error handler for the library's contexts.
void cag_exr_complaint_keep(exr_const_context_t ctxt, exr_result_t code, const char *message);

// The kept message, or the library's text for the code.
const char *cag_exr_complaint_text(const CagExrComplaint *complaint, exr_result_t code);

#endif
