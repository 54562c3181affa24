// Lists and their builder.
//
// The representation of a list is determined by its elements (value.h): packed numbers, packed
// vectors, or values. It is chosen only here, so that equal lists have the same representation.

#include <string.h>
#include <sys/mman.h>

#include "base/assert.h"
#include "base/memory.h"
#include "interp/vm/vm.h"

// Larger data are allocated separately with malloc.
#define INLINE_MAX 4096

static size_t element_size(uint32_t dim) { return dim ? dim * sizeof(double) : sizeof(CagValue); }

// From this size on, data use the kernel's huge pages of 2 MiB, because mapping and zeroing small
// pages would take as long as computing the contents.
#define LARGE_PAGES_FROM ((size_t)8 << 20)
#define SMALL_PAGE ((uintptr_t)4096)

static void *list_block(size_t bytes) {
  void *p = cag_malloc(bytes);
#ifdef MADV_HUGEPAGE
  if (p && bytes >= LARGE_PAGES_FROM) {
    const uintptr_t from = ((uintptr_t)p + SMALL_PAGE - 1) & ~(SMALL_PAGE - 1);
    const uintptr_t to = ((uintptr_t)p + bytes) & ~(SMALL_PAGE - 1);
    madvise((void *)from, to - from, MADV_HUGEPAGE); // only a hint, which may be refused
  }
#endif
  return p;
}

static CagList *new_list(CagVm *vm, size_t n, uint32_t dim) {
  size_t element = element_size(dim);
  if (n > SIZE_MAX / 2 / element) cag_vm_out_of_memory(vm);
  size_t bytes = n * element;
  CagList *l;
  if (bytes <= INLINE_MAX) {
    l = cag_alloc(vm, CAG_LIST, sizeof *l + bytes);
    l->as.data = l + 1;
  } else {
    l = cag_alloc(vm, CAG_LIST, sizeof *l);
    l->as.data = list_block(bytes);
    if (!l->as.data) cag_vm_out_of_memory(vm);
    l->allocated = true;
  }
  l->length = n;
  l->dim = n ? dim : 0;
  return l;
}

CagValue cag_list_numbers(CagVm *vm, size_t n, double **numbers) {
  CagList *l = new_list(vm, n, 1);
  *numbers = l->as.numbers;
  return cag_object(CAG_LIST, l);
}

CagValue cag_list_vectors(CagVm *vm, size_t n, size_t d, double **numbers) {
  if (d == 0 || d > CAG_MAX_PACKED ||
      (d == 1 && n)) { // lists of one number each are not vectors: keep them as values
    CagList *l = new_list(vm, n, 0);
    for (size_t i = 0; i < n; i++) l->as.items[i] = cag_none();
    *numbers = NULL;
    return cag_object(CAG_LIST, l);
  }
  CagList *l = new_list(vm, n, (uint32_t)d);
  *numbers = l->as.numbers;
  return cag_object(CAG_LIST, l);
}

CagValue cag_vector(CagVm *vm, const double *x, size_t n) {
  double *out;
  CagValue v = cag_list_numbers(vm, n, &out);
  memcpy(out, x, n * sizeof *x);
  return v;
}

CagValue cag_point(CagVm *vm, CagVec3 p, int dimension) {
  return cag_vector(vm, (double[]){p.x, p.y, p.z}, (size_t)dimension);
}

// Returns the length of a value as an element of packed vectors, or 0 if it is not a vector.
static uint32_t vector_length(CagValue v) {
  if (v.type != CAG_LIST) return 0;
  const CagList *l = CAG_AS_LIST(v);
  return l->dim == 1 && l->length >= 2 && l->length <= CAG_MAX_PACKED ? (uint32_t)l->length : 0;
}

// Returns the representation of a list whose first element is v.
static uint32_t dim_for(CagValue v) { return v.type == CAG_NUMBER ? 1 : vector_length(v); }

static bool fits(CagValue v, uint32_t dim) {
  return dim == 1 ? v.type == CAG_NUMBER : vector_length(v) == dim;
}

static void store(void *data, size_t i, uint32_t dim, CagValue v) {
  if (dim == 0) ((CagValue *)data)[i] = v;
  else if (dim == 1) ((double *)data)[i] = v.as.number;
  else memcpy((double *)data + i * dim, CAG_AS_LIST(v)->as.numbers, dim * sizeof(double));
}

CagValue cag_list_values(CagVm *vm, const CagValue *values, size_t n) {
  uint32_t dim = n ? dim_for(values[0]) : 0;
  for (size_t i = 1; dim && i < n; i++)
    if (!fits(values[i], dim)) dim = 0;
  CagList *l = new_list(vm, n, dim);
  for (size_t i = 0; i < n; i++) store(l->as.data, i, dim, values[i]);
  return cag_object(CAG_LIST, l);
}

CagValue cag_list_get(CagVm *vm, const CagList *l, size_t i) {
  if (l->dim == 0) return l->as.items[i];
  if (l->dim == 1) return cag_number(l->as.numbers[i]);
  return cag_vector(vm, l->as.numbers + i * l->dim, l->dim);
}

CagValue cag_list_slice(CagVm *vm, CagValue list, size_t from, size_t count) {
  CagList *whole = CAG_AS_LIST(list);
  if (from == 0 && count == whole->length) return list;
  size_t element = element_size(whole->dim);
  // A part of a mixed list may be uniform.
  if (whole->dim == 0 && count && dim_for(whole->as.items[from]))
    return cag_list_values(vm, whole->as.items + from, count);
  // Small parts are copied, because a view would keep the whole list alive.
  if (count * element <= 256) {
    CagList *l = new_list(vm, count, whole->dim);
    if (count) memcpy(l->as.data, (char *)whole->as.data + from * element, count * element);
    return cag_object(CAG_LIST, l);
  }
  CagList *l = cag_alloc(vm, CAG_LIST, sizeof *l);
  l->owner = whole->owner ? whole->owner : whole;
  l->length = count;
  l->dim = whole->dim;
  l->as.data = (char *)whole->as.data + from * element;
  return cag_object(CAG_LIST, l);
}

// --- Builder ---

CagBuilder *cag_builder_new(CagVm *vm) {
  CagBuilder *b = cag_alloc(vm, CAG_INTERNAL, sizeof *b);
  b->head.flags = CAG_INTERNAL_BUILDER;
  return b;
}

static void grow(CagVm *vm, CagBuilder *b) {
  size_t capacity = b->capacity ? b->capacity * 2 : 16;
  size_t element = element_size(b->dim);
  void *data = cag_realloc(b->data, capacity * element);
  if (!data) cag_vm_out_of_memory(vm);
  b->data = data;
  b->capacity = capacity;
}

// Converts packed data to values, after an element of another kind was added.
static void unpack(CagVm *vm, CagBuilder *b) {
  CagCleanup cleanup;
  CagValue *items = cag_temporary(&cleanup, b->capacity, sizeof *items);
  const double *x = b->data;
  uint32_t dim = b->dim;
  for (size_t i = 0; i < b->length; i++)
    items[i] = dim == 1 ? cag_number(x[i]) : cag_vector(vm, x + i * dim, dim);
  cag_cleanup_pop(&cleanup);
  cag_free(b->data);
  b->data = items;
  b->dim = 0;
  b->mixed = true;
}

// A power of 2.
enum { ADDS_BETWEEN_CHECKS = 1 << 12 };

bool cag_builder_add(CagVm *vm, CagBuilder *b, CagValue v) {
  if (b->length == 0 && !b->mixed) {
    b->dim = dim_for(v);
    b->mixed = b->dim == 0;
  } else if (b->dim && !fits(v, b->dim)) {
    unpack(vm, b);
  }
  if (b->length == b->capacity) grow(vm, b);
  store(b->data, b->length++, b->dim, v);
  return (b->length & (ADDS_BETWEEN_CHECKS - 1)) != 0 || !vm->stop || cag_keep_going(vm);
}

CagValue cag_builder_finish(CagVm *vm, CagBuilder *b) {
  size_t bytes = b->length * element_size(b->dim);
  CagList *l;
  if (bytes <= INLINE_MAX) {
    l = new_list(vm, b->length, b->dim);
    if (bytes) memcpy(l->as.data, b->data, bytes);
    cag_free(b->data);
  } else {
    l = cag_alloc(vm, CAG_LIST, sizeof *l);
    void *fitted = cag_realloc(b->data, bytes);
    l->as.data = fitted ? fitted : b->data;
    l->allocated = true;
    l->length = b->length;
    l->dim = b->dim;
  }
  b->data = NULL;
  b->length = b->capacity = 0;
  b->dim = 0;
  b->mixed = false;
  return cag_object(CAG_LIST, l);
}

// --- As lists ---

bool cag_as_vector(CagValue v, const double **x, size_t *n) {
  if (v.type != CAG_LIST || CAG_AS_LIST(v)->dim != 1) return false;
  *x = CAG_AS_LIST(v)->as.numbers;
  *n = CAG_AS_LIST(v)->length;
  return true;
}

bool cag_as_list(CagVm *vm, CagValue v, CagValue *list) {
  if (v.type == CAG_LIST) {
    *list = v;
    return true;
  }
  if (v.type != CAG_RANGE) {
    CagString s = {0};
    cag_describe_value(vm, &s, v);
    cag_vm_fail(vm, CAG_ERR_type, "expected a list, found %s", s.bytes);
    cag_string_free(&s);
    return false;
  }
  const CagRange *r = CAG_AS_RANGE(v);
  size_t n;
  if (!cag_range_count(vm, r, &n)) return false;
  if (r->angle) {
    CagList *l = new_list(vm, n, 0);
    for (size_t i = 0; i < n; i++) l->as.items[i] = cag_angle(cag_range_element(r, i, n));
    *list = cag_object(CAG_LIST, l);
    return true;
  }
  double *x;
  *list = cag_list_numbers(vm, n, &x);
  for (size_t i = 0; i < n; i++) x[i] = cag_range_element(r, i, n);
  return true;
}

static bool is_packed_by_rule(const CagList *l) {
  if (l->length == 0) return l->dim == 0;
  if (l->dim != 0) return l->dim <= CAG_MAX_PACKED;
  size_t numbers = 0;
  while (numbers < l->length && l->as.items[numbers].type == CAG_NUMBER) numbers++;
  return numbers < l->length;
}

bool cag_check_list(const CagList *l) {
  const CagList *owner = l->owner;
  if (!is_packed_by_rule(l)) return false;
  if (!owner) return true;
  const size_t size = l->dim ? l->dim * sizeof(double) : sizeof(CagValue);
  const char *data = l->as.data, *all = owner->as.data;
  return !l->allocated && !owner->owner && owner->dim == l->dim && data >= all &&
         data + l->length * size <= all + owner->length * size;
}
