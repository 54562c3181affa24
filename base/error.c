// The table of errors, and lookups in it.

#include "base/error.h"

#include <string.h>
#include <strings.h>

static const CagErrorInfo infos[] = {
#define CAG_ERROR(name, code, reason, title, explanation, example)                                 \
  {code, reason, title, explanation, example},
#include "base/errors.def"
#undef CAG_ERROR
};

const CagErrorInfo *cag_error_info(CagErrorId id) {
  static const CagErrorInfo unknown = {"E0000", "unknown", "an error without a kind", "", NULL};
  return (size_t)id < CAG_ERR_COUNT ? &infos[id] : &unknown;
}

CagErrorId cag_error_by_code(const char *code) {
  for (size_t i = 0; i < CAG_ERR_COUNT; i++)
    if (strcasecmp(infos[i].code, code) == 0) return (CagErrorId)i;
  return CAG_ERR_COUNT;
}

CagErrorId cag_error_by_reason(const char *reason) {
  for (size_t i = 0; i < CAG_ERR_COUNT; i++)
    if (strcmp(infos[i].reason, reason) == 0) return (CagErrorId)i;
  return CAG_ERR_COUNT;
}

bool cag_error_is_limit(CagErrorId id) {
  switch (id) {
  case CAG_ERR_limit_depth:
  case CAG_ERR_limit_memory:
  case CAG_ERR_limit_time:
  case CAG_ERR_limit_triangles:
  case CAG_ERR_mesh_too_large:
  case CAG_ERR_fit_too_large:
  case CAG_ERR_file_too_large: return true;
  default: return false;
  }
}
