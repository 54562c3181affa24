// The table of errors.
//
// Every kind of error is a row of errors.def: a stable code, a short name (its reason), and an
// explanation. All code refers to a kind by its CagErrorId, so an error without a row does not
// compile.

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
  const char *reason;      // short name, "parameter-range"; `attempt` receives it as err.reason
  const char *title;       // one phrase
  const char *explanation; // a few sentences
  const char *example;     // a script that provokes it; NULL: none can
} CagErrorInfo;

const CagErrorInfo *cag_error_info(CagErrorId id);
// Returns the row with this code ("E0101", in any case) or with this reason, or CAG_ERR_COUNT.
CagErrorId cag_error_by_code(const char *code);
CagErrorId cag_error_by_reason(const char *reason);
// Returns whether the error is an exceeded limit of the run, which `attempt` does not catch. The
// exit status is then 5.
bool cag_error_is_limit(CagErrorId id);

#endif
