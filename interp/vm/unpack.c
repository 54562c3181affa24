// Takes lists and records apart by patterns. The text of a pattern, for messages, is at the place of
// the running instruction.

#include "interp/vm/unpack.h"

#include "base/utf8.h"
#include "interp/vm/value_type.h"

// Longer patterns and values are cut off in messages.
#define PATTERN_MAX 80
#define VALUE_MAX 200

static const char *pattern_text(const CagVm *vm, char *buffer, size_t size) {
  const CagSource *source;
  CagSpan span;
  if (cag_vm_place(vm, &source, &span)) cag_source_excerpt(source, span, buffer, size);
  else snprintf(buffer, size, "[ ]");
  return buffer;
}

static void add_printed(CagVm *vm, CagString *s, CagValue v) {
  const size_t start = s->length;
  s->most = start + VALUE_MAX;
  cag_print_value(vm, s, v, true);
  if (s->length - start < VALUE_MAX) return;
  s->length = cag_utf8_start(s->bytes, start + VALUE_MAX);
  s->most = 0;
  cag_string_add(s, "...", 3);
}

// Adds a value that can be taken apart as it is printed, and any other with its type.
static void add_found(CagVm *vm, CagString *s, CagValue v) {
  if (v.type != CAG_LIST && v.type != CAG_RANGE && v.type != CAG_RECORD) {
    cag_describe_value(vm, s, v);
    return;
  }
  cag_string_printf(s, "the %s ", cag_type_name(v));
  add_printed(vm, s, v);
}

// ---- lists ----

static bool fail_list(CagVm *vm, CagValue v, size_t n, bool more, const size_t *length) {
  char text[PATTERN_MAX];
  CagString found = {0};
  if (!length) {
    add_found(vm, &found, v);
  } else {
    cag_string_printf(&found, "%zu: ", *length);
    add_printed(vm, &found, v);
  }
  cag_vm_fail(vm, CAG_ERR_pattern, "the pattern %s expects a list of %s%zu element%s, found %s",
              pattern_text(vm, text, sizeof text), more ? "at least " : "", n, n == 1 ? "" : "s",
              found.bytes);
  cag_string_free(&found);
  if (v.type == CAG_RECORD) cag_fail_help(vm, "a record is taken apart by { }");
  else if (length && *length > n) cag_fail_help(vm, "`...rest` takes the other elements");
  return false;
}

// Sets the number of elements of a list, or of a range that stands for one.
static bool count_elements(CagVm *vm, CagValue v, size_t *n) {
  if (v.type == CAG_RANGE) return cag_range_count(vm, CAG_AS_RANGE(v), n);
  *n = CAG_AS_LIST(v)->length;
  return true;
}

static CagValue element(CagVm *vm, CagValue v, size_t i, size_t length) {
  if (v.type == CAG_LIST) return cag_list_get(vm, CAG_AS_LIST(v), i);
  const double x = cag_range_element(CAG_AS_RANGE(v), i, length);
  return CAG_AS_RANGE(v)->angle ? cag_angle(x) : cag_number(x);
}

bool cag_unpack(CagVm *vm, CagValue v, size_t n, bool rest, CagValue *out) {
  size_t length;
  CagValue list;
  if (v.type != CAG_LIST && v.type != CAG_RANGE) return fail_list(vm, v, n, rest, NULL);
  if (!count_elements(vm, v, &length)) return false;
  if (rest ? length < n : length != n) return fail_list(vm, v, n, rest, &length);
  for (size_t i = 0; i < n; i++) out[i] = element(vm, v, i, length);
  if (!rest) return true;
  if (!cag_as_list(vm, v, &list)) return false;
  out[n] = cag_list_slice(vm, list, n, length - n);
  return true;
}

// ---- records ----

static bool fail_field(CagVm *vm, CagValue v, const CagText *name) {
  char text[PATTERN_MAX];
  CagString found = {0};
  add_found(vm, &found, v);
  pattern_text(vm, text, sizeof text);
  if (v.type == CAG_RECORD)
    cag_vm_fail(vm, CAG_ERR_pattern, "the pattern %s expects the field `%s`, missing in %s", text,
                name->bytes, found.bytes);
  else
    cag_vm_fail(vm, CAG_ERR_pattern, "the pattern %s expects a record, found %s", text,
                found.bytes);
  cag_string_free(&found);
  if (v.type == CAG_LIST || v.type == CAG_RANGE)
    return cag_fail_help(vm, "a list is taken apart by [ ]");
  if (v.type != CAG_RECORD) return false;
  const CagLayout *layout = CAG_AS_RECORD(v)->layout;
  CagCleanup cleanup;
  const char **names = cag_temporary(&cleanup, layout->count, sizeof *names);
  for (size_t i = 0; i < layout->count; i++) names[i] = layout->names[i]->bytes;
  const char *nearest = cag_nearest_name(name->bytes, names, layout->count);
  if (nearest) cag_fail_help(vm, "did you mean `%s`?", nearest);
  cag_cleanup_run(&cleanup);
  return false;
}

bool cag_unpack_field(CagVm *vm, CagValue v, const CagText *name, CagValue *out) {
  if (v.type == CAG_RECORD) {
    const size_t k = cag_layout_find(CAG_AS_RECORD(v)->layout, name);
    if (k != (size_t)-1) {
      *out = CAG_AS_RECORD(v)->fields[k];
      return true;
    }
  }
  return fail_field(vm, v, name);
}
