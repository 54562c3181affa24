// Lists: folds, maps, orders, and parts.
//
// Everything here reads a list, or a range without making a list of it, and texts by their
// characters where that says something. What a function of the script is called for may collect
// garbage, so sources, builders and intermediate values stand on the root stack then.

#include <limits.h>
#include <string.h>

#include "base/memory.h"
#include "base/utf8.h"
#include "interp/builtin/support.h"
#include "interp/vm/vm.h"

// Loops that make no call of the script ask from time to time whether they may go on.
enum { STEPS_BETWEEN_CHECKS = 1 << 14 };
static bool may_go_on(CagCall *call, size_t step) {
  return (step & (STEPS_BETWEEN_CHECKS - 1)) != STEPS_BETWEEN_CHECKS - 1 ||
         cag_keep_going(call->vm);
}

// --- Size, sums ---

bool cag_lists_len(CagCall *call, CagValue *result) {
  CagSequence s;
  if (call->values[0].type == CAG_RECORD) {
    *result = cag_number((double)CAG_AS_RECORD(call->values[0])->layout->count);
    return true;
  }
  if (!cag_sequence_open(call, 0, true, &s)) return false;
  *result = cag_number((double)s.length);
  return true;
}

// Neumaier's sum: the rounding errors are summed beside it.
typedef struct Sum {
  double total, lost;
} Sum;
static inline void sum_add(Sum *s, double x) {
  double next = s->total + x;
  s->lost += fabs(s->total) >= fabs(x) ? (s->total - next) + x : (x - next) + s->total;
  s->total = next;
}
static double sum_value(const Sum *s) { return isfinite(s->total) ? s->total + s->lost : s->total; }

static bool sum_vectors(CagCall *call, const CagList *list, CagValue *result) {
  double *numbers;
  CagValue sum = cag_list_numbers(call->vm, list->dim, &numbers);
  for (size_t j = 0; j < list->dim; j++) {
    Sum s = {0};
    for (size_t i = 0; i < list->length; i++) {
      sum_add(&s, list->as.numbers[i * list->dim + j]);
      if (!may_go_on(call, i)) return false;
    }
    numbers[j] = sum_value(&s);
    if (!isfinite(numbers[j])) return cag_give_number(call, numbers[j], result);
  }
  *result = sum;
  return true;
}

// Vectors that are not packed: too long, or with others among them, which is an error.
static bool sum_long_vectors(CagCall *call, CagSequence *s, CagValue *result) {
  const double *x;
  size_t n, count = 0;
  double *numbers = NULL;
  for (size_t i = 0; i < s->length; i++) {
    CagValue v = cag_sequence_element(call->vm, s, i);
    if (!cag_as_vector(v, &x, &n))
      return cag_fail_element(call, 0, i, v, "vectors of the same length");
    if (i == 0) {
      count = n;
      *result = cag_list_numbers(call->vm, n, &numbers);
      memcpy(numbers, x, n * sizeof *x);
      continue;
    }
    if (n != count)
      return cag_fail_call(
          call, 0, CAG_ERR_length,
          "expects vectors of the same length, found %zu numbers at [0] and %zu at [%zu]", count, n,
          i);
    for (size_t j = 0; j < n; j++) numbers[j] += x[j];
    if (!cag_keep_going(call->vm)) return false;
  }
  return true;
}

bool cag_lists_sum(CagCall *call, CagValue *result) {
  CagSequence s;
  if (!cag_sequence_open(call, 0, false, &s)) return false;
  Sum sum = {0};
  CagType type = CAG_NUMBER;
  const CagList *list = s.source.type == CAG_LIST ? CAG_AS_LIST(s.source) : NULL;
  if (list && list->dim > 1) return sum_vectors(call, list, result);
  for (size_t i = 0; i < s.length; i++) {
    CagValue v = cag_sequence_element(call->vm, &s, i);
    if (i == 0 && v.type == CAG_LIST) return sum_long_vectors(call, &s, result);
    if (i == 0) type = v.type;
    if (v.type != type || (type != CAG_NUMBER && type != CAG_ANGLE))
      return cag_fail_element(call, 0, i, v,
                              type == CAG_ANGLE ? "angles"
                              : i == 0          ? "numbers, angles, or vectors"
                                                : "numbers");
    sum_add(&sum, v.as.number);
    if (!may_go_on(call, i)) return false;
  }
  return type == CAG_ANGLE ? cag_give_angle(call, sum_value(&sum), result)
                           : cag_give_number(call, sum_value(&sum), result);
}

bool cag_lists_product(CagCall *call, CagValue *result) {
  CagSequence s;
  if (!cag_sequence_open(call, 0, false, &s)) return false;
  double product = 1;
  for (size_t i = 0; i < s.length; i++) {
    CagValue v = cag_sequence_element(call->vm, &s, i);
    if (v.type != CAG_NUMBER) return cag_fail_element(call, 0, i, v, "numbers");
    product *= v.as.number;
    if (!may_go_on(call, i)) return false;
  }
  return cag_give_number(call, product, result);
}

// --- Maps and folds ---

// A loop over a sequence that calls the script: what it holds stands on the root stack.
typedef struct Loop {
  CagCall *call;
  CagSequence source;
  CagValue function;
  CagBuilder *built; // NULL: nothing is built
  size_t roots;
} Loop;

static bool loop_open(Loop *loop, CagCall *call, int function, bool build) {
  *loop = (Loop){.call = call};
  if (!cag_sequence_open(call, 0, true, &loop->source)) return false;
  if (function >= 0 && !cag_arg_function(call, function, &loop->function)) return false;
  cag_root_push(call->vm, loop->source.source);
  cag_root_push(call->vm, loop->function);
  loop->roots = 2;
  if (!build) return true;
  loop->built = cag_builder_new(call->vm);
  cag_root_push(call->vm, cag_builder_value(loop->built));
  loop->roots++;
  return true;
}

static bool loop_close(Loop *loop, bool good, CagValue *result) {
  if (good && loop->built) *result = cag_builder_finish(loop->call->vm, loop->built);
  cag_root_pop(loop->call->vm, loop->roots);
  return good;
}

bool cag_lists_map(CagCall *call, CagValue *result) {
  Loop loop;
  if (!loop_open(&loop, call, 1, true)) return false;
  bool good = true;
  for (size_t i = 0; i < loop.source.length && good; i++) {
    CagValue x = cag_sequence_element(call->vm, &loop.source, i), y;
    good = cag_call(call->vm, loop.function, &x, 1, &y) && cag_builder_add(call->vm, loop.built, y);
  }
  return loop_close(&loop, good, result);
}

// Calls the function, which must give a bool, for x.
static bool test_element(Loop *loop, CagValue x, bool *answer) {
  CagValue y;
  if (!cag_call(loop->call->vm, loop->function, &x, 1, &y)) return false;
  *answer = y.type == CAG_BOOL && y.as.boolean;
  if (y.type == CAG_BOOL) return true;
  char found[120];
  return cag_fail_call(
      loop->call, 1, CAG_ERR_type,
      "expects a function that returns true or false as `%s`, found one that returned %s",
      cag_parameter_name(loop->call, 1), cag_value_words(loop->call->vm, y, found, sizeof found));
}

bool cag_lists_filter(CagCall *call, CagValue *result) {
  Loop loop;
  if (!loop_open(&loop, call, 1, true)) return false;
  bool good = true, kept;
  for (size_t i = 0; i < loop.source.length && good; i++) {
    CagValue x = cag_sequence_element(call->vm, &loop.source, i);
    cag_root_push(call->vm, x);
    good = test_element(&loop, x, &kept) && (!kept || cag_builder_add(call->vm, loop.built, x));
    cag_root_pop(call->vm, 1);
  }
  return loop_close(&loop, good, result);
}

// reduce, and scan where `build`.
static bool fold(CagCall *call, bool build, CagValue *result) {
  Loop loop;
  if (!loop_open(&loop, call, 2, build)) return false;
  CagValue state[2] = {call->values[1], cag_none()};
  bool good = !build || cag_builder_add(call->vm, loop.built, state[0]);
  for (size_t i = 0; i < loop.source.length && good; i++) {
    state[1] = cag_sequence_element(call->vm, &loop.source, i);
    CagValue next;
    good = cag_call(call->vm, loop.function, state, 2, &next);
    if (!good) break;
    state[0] = next;
    if (build) good = cag_builder_add(call->vm, loop.built, next);
  }
  *result = state[0];
  return loop_close(&loop, good, result);
}
bool cag_lists_reduce(CagCall *call, CagValue *result) { return fold(call, false, result); }
bool cag_lists_scan(CagCall *call, CagValue *result) { return fold(call, true, result); }

// any (wanted = true) and all (wanted = false): whether an element answers `wanted`; the first one
// that does ends the search.
static bool search(CagCall *call, bool wanted, CagValue *result) {
  Loop loop;
  bool with_function = cag_given(call, 1);
  if (!loop_open(&loop, call, with_function ? 1 : -1, false)) return false;
  bool good = true, found = false;
  for (size_t i = 0; i < loop.source.length && good && !found; i++) {
    CagValue x = cag_sequence_element(call->vm, &loop.source, i);
    bool answer = x.type == CAG_BOOL && x.as.boolean;
    if (with_function) good = test_element(&loop, x, &answer);
    else if (x.type != CAG_BOOL)
      good = cag_fail_element(call, 0, i, x, "bools, or a function `f`,");
    else good = may_go_on(call, i);
    found = good && answer == wanted;
  }
  *result = cag_bool(found == wanted);
  return loop_close(&loop, good, result);
}
bool cag_lists_any(CagCall *call, CagValue *result) { return search(call, true, result); }
bool cag_lists_all(CagCall *call, CagValue *result) { return search(call, false, result); }

// --- Order ---

typedef struct SortItem {
  CagValue value, key;
} SortItem;

// Merges the sorted runs [0, middle) and [middle, n) of `items`; on equal keys the left one comes
// first. Returns false if the run must stop.
static bool merge(CagCall *call, const SortItem *items, size_t middle, size_t n, SortItem *out) {
  size_t i = 0, j = middle;
  for (size_t k = 0; k < n; k++) {
    if (!may_go_on(call, k)) return false;
    int order = -1;
    if (i < middle && j < n) cag_order(items[i].key, items[j].key, &order);
    else if (i == middle) order = 1;
    out[k] = order <= 0 ? items[i++] : items[j++];
  }
  return true;
}

// Bottom-up merge sort: stable. Returns the one of the two buffers that holds the result, or NULL
// if the run must stop.
static SortItem *sort_items(CagCall *call, SortItem *items, SortItem *spare, size_t n) {
  for (size_t run = 1; run < n; run *= 2) {
    for (size_t from = 0; from < n; from += 2 * run) {
      size_t rest = n - from, size = rest < 2 * run ? rest : 2 * run;
      if (!merge(call, items + from, run < size ? run : size, size, spare + from)) return NULL;
    }
    if (!cag_keep_going(call->vm)) return NULL;
    SortItem *sorted = spare;
    spare = items;
    items = sorted;
  }
  return items;
}

// The elements with their keys. What the script made is kept alive by two builders on the root
// stack.
static bool make_sort_items(CagCall *call, Loop *loop, CagBuilder *keys, bool by) {
  for (size_t i = 0; i < loop->source.length; i++) {
    CagValue x = cag_sequence_element(call->vm, &loop->source, i), key = x;
    if (!cag_builder_add(call->vm, loop->built, x) ||
        (by && !cag_call(call->vm, loop->function, &x, 1, &key)) ||
        !cag_builder_add(call->vm, keys, key))
      return false;
  }
  return true;
}

// All keys must have one order: each is compared with the first.
static bool check_keys(CagCall *call, const SortItem *items, size_t n) {
  int order;
  for (size_t i = 0; i < n; i++) {
    if (!cag_order(items[0].key, items[i].key, &order))
      return cag_fail_order(call, cag_given(call, 1) ? 1 : 0, items[0].key, items[i].key);
    if (!may_go_on(call, i)) return false;
  }
  return true;
}

static bool sort_values(CagCall *call, const CagList *values, const CagList *keys,
                        CagValue *result) {
  size_t n = values->length;
  SortItem *buffer = cag_hold(call, cag_malloc((2 * n + 1) * sizeof *buffer));
  for (size_t i = 0; i < n; i++) {
    buffer[i] = (SortItem){cag_list_get(call->vm, values, i), cag_list_get(call->vm, keys, i)};
    if (!may_go_on(call, i)) return false;
  }
  if (!check_keys(call, buffer, n)) return false;
  const SortItem *sorted = sort_items(call, buffer, buffer + n, n);
  if (!sorted) return false;
  CagBuilder *built = cag_builder_new(call->vm);
  for (size_t i = 0; i < n; i++)
    if (!cag_builder_add(call->vm, built, sorted[i].value)) return false;
  *result = cag_builder_finish(call->vm, built);
  return true;
}

bool cag_lists_sort(CagCall *call, CagValue *result) {
  Loop loop;
  bool by = cag_given(call, 1);
  if (!loop_open(&loop, call, by ? 1 : -1, true)) return false;
  CagBuilder *keys = cag_builder_new(call->vm);
  cag_root_push(call->vm, cag_builder_value(keys));
  loop.roots++;
  bool good = make_sort_items(call, &loop, keys, by);
  CagValue values = cag_none();
  if (good) values = cag_builder_finish(call->vm, loop.built);
  loop.built = NULL;
  loop_close(&loop, good, result);
  // From here on nothing calls the script.
  return good && sort_values(call, CAG_AS_LIST(values),
                             CAG_AS_LIST(cag_builder_finish(call->vm, keys)), result);
}

bool cag_lists_reverse(CagCall *call, CagValue *result) {
  CagSequence s;
  if (!cag_sequence_open(call, 0, true, &s)) return false;
  if (s.source.type == CAG_TEXT) {
    const CagText *t = CAG_AS_TEXT(s.source);
    CagString reversed = {0};
    for (const char *end = t->bytes + t->length; end > t->bytes;) {
      const char *from = t->bytes + cag_utf8_start(t->bytes, (size_t)(end - t->bytes) - 1);
      cag_string_add(&reversed, from, (size_t)(end - from));
      end = from;
    }
    *result = cag_text_from_string(call->vm, &reversed);
    return true;
  }
  CagBuilder *built = cag_builder_new(call->vm);
  for (size_t i = s.length; i-- > 0;)
    if (!cag_builder_add(call->vm, built, cag_sequence_element(call->vm, &s, i))) return false;
  *result = cag_builder_finish(call->vm, built);
  return true;
}

// --- Joining and taking apart ---

bool cag_lists_zip(CagCall *call, CagValue *result) {
  size_t n = call->count;
  CagSequence *s = cag_hold_array(call, n, sizeof *s);
  CagValue *parts = cag_hold_array(call, n, sizeof *parts);
  CagBuilder *built = cag_builder_new(call->vm);
  for (size_t k = 0; k < n; k++) {
    if (!cag_sequence_open(call, (int)k, true, &s[k])) return false;
    if (s[k].length != s[0].length)
      return cag_fail_call(call, (int)k, CAG_ERR_length,
                           "expects lists of the same length, found %zu and %zu elements",
                           s[0].length, s[k].length);
  }
  for (size_t i = 0; i < s[0].length; i++) {
    for (size_t k = 0; k < n; k++) parts[k] = cag_sequence_element(call->vm, &s[k], i);
    if (!cag_builder_add(call->vm, built, cag_list_values(call->vm, parts, n))) return false;
  }
  *result = cag_builder_finish(call->vm, built);
  return true;
}

bool cag_lists_enumerate(CagCall *call, CagValue *result) {
  CagSequence s;
  if (!cag_sequence_open(call, 0, true, &s)) return false;
  CagBuilder *built = cag_builder_new(call->vm);
  for (size_t i = 0; i < s.length; i++) {
    CagValue pair[] = {cag_number((double)i), cag_sequence_element(call->vm, &s, i)};
    if (!cag_builder_add(call->vm, built, cag_list_values(call->vm, pair, 2))) return false;
  }
  *result = cag_builder_finish(call->vm, built);
  return true;
}

// Adds all elements of a list or range.
static bool add_all(CagCall *call, CagBuilder *built, CagValue v) {
  if (!cag_as_list(call->vm, v, &v)) return false;
  const CagList *list = CAG_AS_LIST(v);
  for (size_t i = 0; i < list->length; i++)
    if (!cag_builder_add(call->vm, built, cag_list_get(call->vm, list, i))) return false;
  return true;
}

bool cag_lists_flatten(CagCall *call, CagValue *result) {
  CagSequence s;
  if (!cag_sequence_open(call, 0, false, &s)) return false;
  const CagList *list = s.source.type == CAG_LIST ? CAG_AS_LIST(s.source) : NULL;
  if (list && list->dim > 1) {
    double *numbers;
    *result = cag_list_numbers(call->vm, list->length * list->dim, &numbers);
    memcpy(numbers, list->as.numbers, list->length * list->dim * sizeof *numbers);
    return true;
  }
  CagBuilder *built = cag_builder_new(call->vm);
  for (size_t i = 0; i < s.length; i++) {
    CagValue v = cag_sequence_element(call->vm, &s, i);
    bool parts = v.type == CAG_LIST || v.type == CAG_RANGE;
    if (!(parts ? add_all(call, built, v) : cag_builder_add(call->vm, built, v))) return false;
  }
  *result = cag_builder_finish(call->vm, built);
  return true;
}

bool cag_lists_concat(CagCall *call, CagValue *result) {
  CagBuilder *built = cag_builder_new(call->vm);
  for (size_t k = 0; k < call->count; k++) {
    CagValue v = call->values[k];
    if (v.type != CAG_LIST && v.type != CAG_RANGE) return cag_fail_type(call, (int)k, "a list");
    if (!add_all(call, built, v)) return false;
  }
  *result = cag_builder_finish(call->vm, built);
  return true;
}

static bool index_in_text(CagCall *call, const CagText *t, CagValue *result) {
  if (call->values[1].type != CAG_TEXT) return cag_fail_type(call, 1, "a text");
  const CagText *part = CAG_AS_TEXT(call->values[1]);
  const char *found = memmem(t->bytes, t->length, part->bytes, part->length);
  *result = cag_none();
  if (!found) return true;
  size_t k = 0;
  for (const char *s = t->bytes; s < found; s += cag_character_size(s)) k++;
  *result = cag_number((double)k);
  return true;
}

bool cag_lists_index_of(CagCall *call, CagValue *result) {
  CagSequence s;
  if (!cag_sequence_open(call, 0, true, &s)) return false;
  if (s.source.type == CAG_TEXT) return index_in_text(call, CAG_AS_TEXT(s.source), result);
  *result = cag_none();
  for (size_t i = 0; i < s.length; i++) {
    if (cag_equal(call->vm, cag_sequence_element(call->vm, &s, i), call->values[1])) {
      *result = cag_number((double)i);
      return true;
    }
    if (call->vm->failed || !may_go_on(call, i)) return false;
  }
  return true;
}

// --- Making lists ---

// Part k of n - 1 of the way: the ends are exact, and whole steps stay whole.
static double step_between(double a, double b, long k, long n) {
  double way = b - a;
  if (k == n - 1) return b;
  return isfinite(way) ? a + way * (double)k / (double)(n - 1)
                       : cag_mix_numbers(a, b, (double)k / (double)(n - 1));
}

static CagValue vector_between(CagVm *vm, const CagList *a, const CagList *b, long k, long n) {
  double *numbers;
  CagValue v = cag_list_numbers(vm, a->length, &numbers);
  for (size_t i = 0; i < a->length; i++)
    numbers[i] = step_between(a->as.numbers[i], b->as.numbers[i], k, n);
  return v;
}

// The ends are two finite numbers, two angles, or two vectors of one length.
static bool check_ends(CagCall *call) {
  CagValue a = call->values[0], b = call->values[1];
  const double *x;
  size_t na, nb;
  if (cag_as_vector(a, &x, &na)) {
    if (!cag_as_vector(b, &x, &nb)) return cag_fail_type(call, 1, "a vector");
    return na == nb ||
           cag_fail_call(call, 1, CAG_ERR_length,
                         "expects vectors of the same length, found %zu and %zu numbers", na, nb);
  }
  if (a.type != CAG_NUMBER && a.type != CAG_ANGLE)
    return cag_fail_type(call, 0, "a number, an angle, or a vector");
  if (a.type != b.type)
    return cag_fail_type(call, 1, a.type == CAG_NUMBER ? "a number" : "an angle");
  if (!isfinite(a.as.number)) return cag_fail_value(call, 0, "a finite end");
  return isfinite(b.as.number) || cag_fail_value(call, 1, "a finite end");
}

bool cag_lists_linspace(CagCall *call, CagValue *result) {
  long n;
  if (!check_ends(call) || !cag_arg_integer(call, 2, 2, LONG_MAX, &n)) return false;
  CagValue a = call->values[0], b = call->values[1];
  CagBuilder *built = cag_builder_new(call->vm);
  for (long k = 0; k < n; k++) {
    CagValue x = a;
    if (a.type == CAG_LIST) x = vector_between(call->vm, CAG_AS_LIST(a), CAG_AS_LIST(b), k, n);
    else x.as.number = step_between(a.as.number, b.as.number, k, n);
    if (!cag_builder_add(call->vm, built, x) || !may_go_on(call, (size_t)k)) return false;
  }
  *result = cag_builder_finish(call->vm, built);
  return true;
}

bool cag_lists_repeat(CagCall *call, CagValue *result) {
  long n;
  if (!cag_arg_integer(call, 1, 0, LONG_MAX, &n)) return false;
  CagBuilder *built = cag_builder_new(call->vm);
  for (long k = 0; k < n; k++)
    if (!cag_builder_add(call->vm, built, call->values[0]) || !may_go_on(call, (size_t)k))
      return false;
  *result = cag_builder_finish(call->vm, built);
  return true;
}

bool cag_lists_pairs(CagCall *call, CagValue *result) {
  CagSequence s;
  bool closed;
  if (!cag_arg_bool_or(call, 1, false, &closed) || !cag_sequence_open(call, 0, true, &s))
    return false;
  CagBuilder *built = cag_builder_new(call->vm);
  CagValue first = cag_none(), pair[2];
  for (size_t i = 0; i < s.length; i++) {
    pair[1] = cag_sequence_element(call->vm, &s, i);
    if (i == 0) first = pair[1];
    else if (!cag_builder_add(call->vm, built, cag_list_values(call->vm, pair, 2))) return false;
    pair[0] = pair[1];
  }
  pair[1] = first;
  if (closed && s.length > 0 &&
      !cag_builder_add(call->vm, built, cag_list_values(call->vm, pair, 2)))
    return false;
  *result = cag_builder_finish(call->vm, built);
  return true;
}

// --- Parts ---

// Elements from .. from + count of the list, range or text at argument 0.
static bool part(CagCall *call, const CagSequence *s, size_t from, size_t count, CagValue *result) {
  if (s->source.type == CAG_LIST) {
    *result = cag_list_slice(call->vm, s->source, from, count);
    return true;
  }
  if (s->source.type == CAG_TEXT) {
    const CagText *t = CAG_AS_TEXT(s->source);
    const char *begin = cag_text_at(t, from), *end = cag_text_at(t, from + count);
    *result = cag_text_new(call->vm, begin, (size_t)(end - begin));
    return true;
  }
  CagSequence range = *s;
  CagBuilder *built = cag_builder_new(call->vm);
  for (size_t i = from; i < from + count; i++)
    if (!cag_builder_add(call->vm, built, cag_sequence_element(call->vm, &range, i))) return false;
  *result = cag_builder_finish(call->vm, built);
  return true;
}

// The sequence at argument 0 and the count at 1, at most its length.
static bool read_part(CagCall *call, CagSequence *s, size_t *n) {
  long wanted;
  if (!cag_arg_integer(call, 1, 0, LONG_MAX, &wanted) || !cag_sequence_open(call, 0, true, s))
    return false;
  *n = (size_t)wanted < s->length ? (size_t)wanted : s->length;
  return true;
}

bool cag_lists_first(CagCall *call, CagValue *result) {
  CagSequence s;
  size_t n;
  return read_part(call, &s, &n) && part(call, &s, 0, n, result);
}

bool cag_lists_rest(CagCall *call, CagValue *result) {
  CagSequence s;
  size_t n;
  return read_part(call, &s, &n) && part(call, &s, n, s.length - n, result);
}

bool cag_lists_along(CagCall *call, CagValue *result) {
  CagSequence s;
  double t;
  if (!cag_sequence_open(call, 0, false, &s) || !cag_arg_number(call, 1, &t)) return false;
  if (s.length == 0) return cag_fail_value(call, 0, "at least one element");
  if (!(t >= 0 && t <= 1)) return cag_fail_value(call, 1, "a number in 0..1");
  double place = t * (double)(s.length - 1);
  size_t i = (size_t)place;
  *result = cag_sequence_element(call->vm, &s, i);
  if (i + 1 >= s.length) return true;
  return cag_mix_values(call, *result, cag_sequence_element(call->vm, &s, i + 1), place - (double)i,
                        result);
}
