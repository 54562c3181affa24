// Records: names and values, creation from pairs, and lookup with a default. Also the names of
// types.

#include <stdlib.h>
#include <string.h>

#include "interp/builtin/support.h"

bool cag_records_keys(CagCall *call, const struct cag_records_keys *a, CagValue *result) {
  CagBuilder *built = cag_builder_new(call->vm);
  for (size_t i = 0; i < a->r->layout->count; i++) {
    CagValue name = cag_object(CAG_TEXT, a->r->layout->names[i]);
    if (!cag_builder_add(call->vm, built, name)) return false;
  }
  *result = cag_builder_finish(call->vm, built);
  return true;
}

bool cag_records_values(CagCall *call, const struct cag_records_values *a, CagValue *result) {
  *result = cag_list_values(call->vm, a->r->fields, a->r->layout->count);
  return true;
}

bool cag_records_get(CagCall *call, const struct cag_records_get *a, CagValue *result) {
  *result = cag_record_get_text(call->vm, a->r, CAG_AS_TEXT(call->values[1]));
  if (result->type == CAG_UNSET) *result = cag_given(call, 2) ? a->default_ : cag_none();
  return true;
}

// --- record ---

// Reads the pair at index i, a list [name, value].
static bool read_pair(CagCall *call, CagSequence *pairs, size_t i, CagText **name,
                      CagValue *value) {
  CagValue pair = cag_sequence_element(call->vm, pairs, i);
  if (pair.type != CAG_LIST || CAG_AS_LIST(pair)->length != 2)
    return cag_fail_element(call, 0, i, pair, "pairs [name, value]");
  CagValue key = cag_list_get(call->vm, CAG_AS_LIST(pair), 0);
  if (key.type != CAG_TEXT) {
    char found[120];
    return cag_fail_call(call, 0, CAG_ERR_record_key,
                         "expects texts as names, found %s in pairs[%zu]",
                         cag_value_words(call->vm, key, found, sizeof found), i);
  }
  *name = cag_intern(call->vm, CAG_AS_TEXT(key)->bytes, CAG_AS_TEXT(key)->length);
  *value = cag_list_get(call->vm, CAG_AS_LIST(pair), 1);
  return true;
}

static int compare_names(const void *a, const void *b) {
  const CagText *s = *(CagText *const *)a, *t = *(CagText *const *)b;
  return (s > t) - (s < t);
}

// Returns a name that occurs twice, or NULL. Texts are interned, so equal names have the same
// address.
static const CagText *repeated_name(CagCall *call, CagText *const *names, size_t n) {
  CagText **sorted = cag_hold_array(call, n, sizeof *sorted);
  memcpy(sorted, names, n * sizeof *sorted);
  qsort(sorted, n, sizeof *sorted, compare_names);
  for (size_t i = 1; i < n; i++)
    if (sorted[i] == sorted[i - 1]) return sorted[i];
  return NULL;
}

bool cag_records_record(CagCall *call, CagValue *result) {
  CagSequence pairs;
  if (!cag_sequence_open(call, 0, false, &pairs)) return false;
  size_t n = pairs.length;
  // Checks the first pair before allocating memory, because a long range has no pairs.
  CagText *name;
  CagValue value;
  if (n > 0 && !read_pair(call, &pairs, 0, &name, &value)) return false;
  CagText **names = cag_hold_array(call, n, sizeof(CagText *));
  CagValue *values = cag_hold_array(call, n, sizeof *values);
  for (size_t i = 0; i < n; i++)
    if (!read_pair(call, &pairs, i, &names[i], &values[i])) return false;
  const CagText *twice = repeated_name(call, names, n);
  if (twice)
    return cag_fail_call(call, 0, CAG_ERR_duplicate_field, "has the field \"%s\" twice",
                         twice->bytes);
  *result = cag_record_from_texts(call->vm, names, values, n);
  return true;
}

bool cag_records_type_of(CagCall *call, CagValue *result) {
  *result = cag_text_c(call->vm, cag_type_name(call->values[0]));
  return true;
}
