// The types of values: one row for each type, with the operations of the machine on its values.
//
// The rows of the language's own types are in types.c. Those of geometry, scenes, and robots are in
// interp/builtin (files types_*.c), which also contains the table. NULL means the default that the
// comment of the field states.

#ifndef CAG_INTERP_VM_VALUE_TYPE_H
#define CAG_INTERP_VM_VALUE_TYPE_H

#include "interp/vm/value.h"
#include "lang/ast.h"

typedef struct CagCall CagCall;
typedef struct CagHeap CagHeap;

typedef struct CagValueType {
  // Adds the printed form (language, section 7). Texts are printed in quotes.
  void (*print)(CagVm *vm, CagString *s, CagValue v); // NULL: the name of the type
  // Adds the description of a value in messages, such as "the number 30".
  void (*describe)(CagVm *vm, CagString *s, CagValue v); // NULL: the name with its article
  // Compares two values of the type.
  bool (*equal)(CagVm *vm, CagValue a, CagValue b); // NULL: an object is equal to itself only
  // Marks the objects that an object refers to, with the functions below.
  void (*scan)(CagHeap *h, CagObject *o); // NULL: nothing
  // Retain and release what the object holds outside of the heap. cag_shape_copy uses `retain`.
  void (*retain)(CagObject *o);  // NULL: nothing
  void (*destroy)(CagObject *o); // NULL: nothing
  // Looks up `v.name`. Returns false if there is no such member, or if an error was set.
  bool (*member)(CagVm *vm, CagValue v, const char *name, CagValue *out); // NULL: no members
  // Returns the name of member i, or NULL after the last one.
  const char *(*member_name)(CagVm *vm, CagValue v, size_t i); // NULL: no members
  // Calls the value: v(arguments). Returns false if an error was set.
  bool (*call)(CagVm *vm, CagValue v, const CagValue *arguments, size_t n,
               CagValue *result); // NULL: the value cannot be called
  // Computes + - * / of operands of which one is of the type, and -v as v * -1. Sets *known to
  // false if the operator does not apply to them. Returns false if an error was set.
  bool (*arithmetic)(CagVm *vm, CagBinaryOp op, CagValue a, CagValue b, CagValue *result,
                     bool *known); // NULL: it has no operators
  // Computes T * v. Returns false if an error was set.
  bool (*transform)(CagCall *call, const CagTransform *t, CagValue v,
                    CagValue *result); // NULL: the value cannot be moved
} CagValueType;

// Indexed by CagType; includes CAG_UNSET and CAG_INTERNAL.
extern const CagValueType *const cag_value_types[];
static inline const CagValueType *cag_value_type(CagValue v) { return cag_value_types[v.type]; }

// --- For `scan` ---
void cag_mark_object(CagHeap *h, CagObject *o); // NULL is allowed
void cag_mark_origin(CagHeap *h, const CagOrigin *o);
void cag_mark_value(CagHeap *h, CagValue v);
// Ends early if the run must stop.
void cag_mark_values(CagHeap *h, const CagValue *v, size_t n);

// --- For `print` and `describe` ---
void cag_print_quoted(CagString *s, const CagText *t);
void cag_print_numbers(CagVm *vm, CagString *s, const double *x, size_t n); // [1, 2, 3]
// Returns whether printing must end because the run must stop or the text is long enough.
bool cag_print_is_cut(CagVm *vm, const CagString *s);

// --- For `member_name`: name i of an array that ends with NULL ---
static inline const char *cag_name_at(const char *const *names, size_t i) {
  for (size_t k = 0; names[k]; k++)
    if (k == i) return names[k];
  return NULL;
}

// --- The types of the language ---
extern const CagValueType cag_type_none, cag_type_bool, cag_type_number, cag_type_angle,
    cag_type_jet, cag_type_text, cag_type_list, cag_type_range, cag_type_record, cag_type_closure,
    cag_type_builtin, cag_type_module, cag_type_internal;

#endif
