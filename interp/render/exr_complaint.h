// Error messages of the EXR library, kept for our own messages.

#ifndef CAG_INTERP_RENDER_EXR_COMPLAINT_H
#define CAG_INTERP_RENDER_EXR_COMPLAINT_H

#include <openexr.h>

// The first message of the library, or "" if there is none yet.
typedef struct CagExrComplaint {
  char text[256];
} CagExrComplaint;

// Makes the handler below write to `complaint` when it is called on this thread. NULL: messages are
// dropped.
void cag_exr_complaint_listen(CagExrComplaint *complaint);

// The error handler for contexts of the library.
void cag_exr_complaint_keep(exr_const_context_t ctxt, exr_result_t code, const char *message);

// Returns the kept message, or the library's text for the code.
const char *cag_exr_complaint_text(const CagExrComplaint *complaint, exr_result_t code);

#endif
