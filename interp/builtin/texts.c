// Texts: printed forms, parts, and case.
//
// Positions count code points; case follows Unicode's simple mappings.

#include <string.h>
#include <utf8proc.h>

#include "interp/builtin/support.h"
#include "interp/vm/vm.h"

static bool read_text(CagCall *call, int argument, const CagText **out) {
  if (call->values[argument].type != CAG_TEXT) {
    cag_fail_type(call, argument, "a text");
    return false;
  }
  *out = CAG_AS_TEXT(call->values[argument]);
  return true;
}

// --- text ---

static bool print_places(CagCall *call, CagString *s, CagValue v, int digits, int depth);

static bool print_list(CagCall *call, CagString *s, const CagList *list, int digits, int depth) {
  if (!cag_may_nest(call, depth) || !cag_string_fits(call->vm, s)) return false;
  cag_string_add(s, "[", 1);
  for (size_t i = 0; i < list->length; i++) {
    if (i > 0) cag_string_add(s, ", ", 2);
    if (!print_places(call, s, cag_list_get(call->vm, list, i), digits, depth)) return false;
  }
  cag_string_add(s, "]", 1);
  return true;
}

// Numbers and angles with so many places, alone or in lists.
static bool print_places(CagCall *call, CagString *s, CagValue v, int digits, int depth) {
  if (v.type == CAG_LIST) return print_list(call, s, CAG_AS_LIST(v), digits, depth + 1);
  if (v.type != CAG_NUMBER && v.type != CAG_ANGLE) {
    char found[120];
    return cag_fail_call(call, 0, CAG_ERR_type,
                         "with `digits` expects a number, an angle, or a list of these, found %s",
                         cag_value_words(call->vm, v, found, sizeof found));
  }
  cag_print_fixed(s, v.as.number, digits);
  if (v.type == CAG_ANGLE) cag_string_add(s, "deg", strlen("deg"));
  return true;
}

bool cag_texts_text(CagCall *call, const struct cag_texts_text *a, CagValue *result) {
  CagString *s = cag_held_string(call);
  if (!cag_given(call, 1)) cag_print_value(call->vm, s, a->x, false);
  else if (!print_places(call, s, a->x, (int)a->digits, 0)) return false;
  *result = cag_text_from_string(call->vm, s);
  return !call->vm->failed;
}

bool cag_texts_number_of(CagCall *call, CagValue *result) {
  const CagText *t;
  double x;
  if (!read_text(call, 0, &t)) return false;
  if (cag_read_number(t->bytes, t->length, &x)) {
    *result = cag_number(x);
    return true;
  }
  char found[200];
  return cag_fail_call(call, 0, CAG_ERR_parse_text, "expects a text that is a number, found %s",
                       cag_value_words(call->vm, call->values[0], found, sizeof found));
}

// --- Parts ---

// Where `part` begins in [s, end), or NULL.
static const char *find_part(const char *s, const char *end, const CagText *part) {
  return memmem(s, (size_t)(end - s), part->bytes, part->length);
}

bool cag_texts_split(CagCall *call, CagValue *result) {
  const CagText *t, *separator;
  if (!read_text(call, 0, &t) || !read_text(call, 1, &separator)) return false;
  CagBuilder *built = cag_builder_new(call->vm);
  const char *s = t->bytes, *end = t->bytes + t->length;
  while (separator->length == 0 && s < end) {
    size_t n = cag_character_size(s);
    if (!cag_builder_add(call->vm, built, cag_text_new(call->vm, s, n))) return false;
    s += n;
  }
  while (separator->length > 0) {
    const char *found = find_part(s, end, separator);
    const char *stop = found ? found : end;
    if (!cag_builder_add(call->vm, built, cag_text_new(call->vm, s, (size_t)(stop - s))))
      return false;
    if (!found) break;
    s = found + separator->length;
  }
  *result = cag_builder_finish(call->vm, built);
  return true;
}

// Elements joined between two looks at the clock.
enum { KEEP_GOING_EVERY = 4096 };

bool cag_texts_join(CagCall *call, CagValue *result) {
  const CagText *separator = NULL;
  CagSequence xs;
  if (cag_given(call, 1) && !read_text(call, 1, &separator)) return false;
  if (!cag_sequence_open(call, 0, true, &xs)) return false;
  CagString *s = cag_held_string(call);
  for (size_t i = 0; i < xs.length; i++) {
    if (i % KEEP_GOING_EVERY == 0 && !cag_keep_going(call->vm)) return false;
    if (!cag_string_fits(call->vm, s)) return false;
    if (i > 0 && separator) cag_string_add(s, separator->bytes, separator->length);
    cag_print_value(call->vm, s, cag_sequence_element(call->vm, &xs, i), false);
  }
  *result = cag_text_from_string(call->vm, s);
  return !call->vm->failed;
}

bool cag_texts_starts_with(CagCall *call, CagValue *result) {
  const CagText *t, *part;
  if (!read_text(call, 0, &t) || !read_text(call, 1, &part)) return false;
  *result = cag_bool(t->length >= part->length && memcmp(t->bytes, part->bytes, part->length) == 0);
  return true;
}

bool cag_texts_replace(CagCall *call, CagValue *result) {
  const CagText *t, *old, *new;
  if (!read_text(call, 0, &t) || !read_text(call, 1, &old) || !read_text(call, 2, &new))
    return false;
  if (old->length == 0) return cag_fail_value(call, 1, "a text that is not empty");
  CagString *s = cag_held_string(call);
  const char *from = t->bytes, *end = t->bytes + t->length, *found;
  while ((found = find_part(from, end, old)) != NULL) {
    if (!cag_keep_going(call->vm) || !cag_string_fits(call->vm, s)) return false;
    cag_string_add(s, from, (size_t)(found - from));
    cag_string_add(s, new->bytes, new->length);
    from = found + old->length;
  }
  cag_string_add(s, from, (size_t)(end - from));
  *result = cag_text_from_string(call->vm, s);
  return true;
}

// --- Case ---

static bool map_characters(CagCall *call, utf8proc_int32_t (*f)(utf8proc_int32_t),
                           CagValue *result) {
  const CagText *t;
  if (!read_text(call, 0, &t)) return false;
  CagString *s = cag_held_string(call);
  const char *end = t->bytes + t->length;
  size_t done = 0;
  for (const char *at = t->bytes; at < end; at += cag_character_size(at)) {
    if (++done % KEEP_GOING_EVERY == 0 && !cag_keep_going(call->vm)) return false;
    utf8proc_int32_t c;
    utf8proc_uint8_t mapped[4];
    utf8proc_iterate((const utf8proc_uint8_t *)at, end - at, &c);
    utf8proc_ssize_t n = utf8proc_encode_char(f(c), mapped);
    cag_string_add(s, (const char *)mapped, (size_t)n);
  }
  *result = cag_text_from_string(call->vm, s);
  return true;
}
bool cag_texts_upper(CagCall *call, CagValue *result) {
  return map_characters(call, utf8proc_toupper, result);
}
bool cag_texts_lower(CagCall *call, CagValue *result) {
  return map_characters(call, utf8proc_tolower, result);
}
