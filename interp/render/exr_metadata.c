// The list of attributes in the header of an EXR file.

#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "interp/render/exr.h"

// Attributes that describe how the file is stored, which the library writes.
static const char *const RESERVED[] = {
    "channels",           "chunkCount",         "compression", "dataWindow", "displayWindow",
    "lineOrder",          "maxSamplesPerPixel", "name",        "preview",    "pixelAspectRatio",
    "screenWindowCenter", "screenWindowWidth",  "tiles",       "type",       "version",
};

bool cag_exr_name_is_reserved(const char *name) {
  for (size_t i = 0; i < sizeof RESERVED / sizeof *RESERVED; i++)
    if (!strcmp(name, RESERVED[i])) return true;
  return false;
}

// Returns the entry of that name: a new one, or the existing one after clearing it.
static CagExrAttribute *entry(CagExrMetadata *m, const char *name, CagError *err) {
  size_t length = strlen(name);
  if (!length || length > CAG_IMAGE_NAME_MAX || cag_exr_name_is_reserved(name)) {
    cag_fail_io(err, CAG_E_USAGE, "choose a name of 1 to 255 bytes that EXR does not use",
                "'%s' cannot be the name of an EXR attribute", name);
    return NULL;
  }
  for (size_t i = 0; i < m->count; i++) {
    if (strcmp(m->items[i].name, name) != 0) continue;
    cag_free(m->items[i].text);
    m->items[i].text = NULL;
    return &m->items[i];
  }
  if (!CAG_RESERVE(m->items, m->capacity, m->count + 1)) {
    cag_fail_io(err, CAG_E_LIMIT, NULL, "not enough memory for the EXR attribute '%s'", name);
    return NULL;
  }
  CagExrAttribute *a = &m->items[m->count++];
  *a = (CagExrAttribute){0};
  memcpy(a->name, name, length + 1);
  return a;
}

bool cag_exr_metadata_text(CagExrMetadata *m, const char *name, const char *text, CagError *err) {
  char *copy = cag_strdup(text);
  CagExrAttribute *a = copy ? entry(m, name, err) : NULL;
  if (!a) {
    if (!copy)
      cag_fail_io(err, CAG_E_LIMIT, NULL, "not enough memory for the EXR attribute '%s'", name);
    cag_free(copy);
    return false;
  }
  a->kind = CAG_EXR_TEXT;
  a->text = copy;
  return true;
}

bool cag_exr_metadata_number(CagExrMetadata *m, const char *name, double number, CagError *err) {
  CagExrAttribute *a = entry(m, name, err);
  if (!a) return false;
  a->kind = CAG_EXR_NUMBER;
  a->number = number;
  return true;
}

bool cag_exr_metadata_matrix(CagExrMetadata *m, const char *name, const double matrix[16],
                             CagError *err) {
  CagExrAttribute *a = entry(m, name, err);
  if (!a) return false;
  a->kind = CAG_EXR_MATRIX;
  memcpy(a->matrix, matrix, sizeof a->matrix);
  return true;
}

const CagExrAttribute *cag_exr_metadata_find(const CagExrMetadata *m, const char *name) {
  for (size_t i = 0; i < m->count; i++)
    if (!strcmp(m->items[i].name, name)) return &m->items[i];
  return NULL;
}

void cag_exr_metadata_free(CagExrMetadata *m) {
  for (size_t i = 0; i < m->count; i++) cag_free(m->items[i].text);
  cag_free(m->items);
  *m = (CagExrMetadata){0};
}
