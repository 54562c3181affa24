// The table of errors.
//
// Every kind of error is a row of errors.def: a stable code, a short name (its reason), and its
// explanation. The core, the language, and the program name it by its number, so an error without a
// row does not compile.

#ifndef CAG_BASE_ERROR_H
#define CAG_BASE_ERROR_H

#include <stdbool.h>

// CAG_ERR_name for each row of errors.def, in the order of the table.
typedef enum CagErrorId {
#define CAG_ERROR(name, code, reason, title, explanation, example) CAG_ERR_##name,
#include "base/errors.def"
#undef CAG_ERROR
  CAG_ERR_COUNT
} CagErrorId;

typedef struct CagErrorInfo {
  const char *code;        // "E0101"
  const char *reason;      // short name, "parameter-range": what `attempt` sees as err.reason
  const char *title;       // one phrase
  const char *explanation; // some sentences
  const char *example;     // a script that provokes it; NULL: none can
} CagErrorInfo;

const CagErrorInfo *cag_error_info(CagErrorId id);
// The row with this code ("E0101", any case) or with this reason; CAG_ERR_COUNT if there is none.
CagErrorId cag_error_by_code(const char *code);
CagErrorId cag_error_by_reason(const char *reason);
// Whether the error is a limit of the run: it passes through `attempt`, and the exit status is 5.
bool cag_error_is_limit(CagErrorId id);

#endif
