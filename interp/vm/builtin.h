// Built-in functions: one table row each, from which dispatch, arity checks, documentation,
// completion and `cag doc` are made.
//
// A row's signature states the parameters with their types, ranges, and defaults (signature.h):
//
//     "cone(height: length > 0, radius: length > 0, centered: bool = false)"
//
// The generated code reads all arguments of a call into a structure and passes it to the function.
// Parameters with `= default` are optional; an argument that is not given is CAG_UNSET. A parameter named with a single capital (C,
// P, V, T, G, S, A, B, Q, R) goes by position only; others by position or name. `...` as last
// parameter: any number of further positional arguments. One name may serve several types of first
// argument: it then has several rows, and the first whose `accepts` takes the arguments is called.
// The rows are in interp/builtin/*.rows, a file for each family; tools/rows.awk makes cag_builtins of
// them.

#ifndef CAG_INTERP_VM_BUILTIN_H
#define CAG_INTERP_VM_BUILTIN_H

#include "base/diagnostic.h"
#include "base/memory.h"
#include "interp/vm/heap.h"
#include "interp/vm/signature.h"
#include "interp/vm/value.h"

// Arguments of one call. Given ones stand in `values` by parameter order; parameters left out are
// CAG_UNSET, and so are those for which none was given where none is the default. With `...`,
// further ones follow: values[parameter_count .. count).
typedef struct CagCall {
  CagVm *vm;
  const struct CagBuiltin *builtin;
  CagValue *values;
  size_t count;  // at least the number of named parameters
  CagError *err; // for functions of the core to write their errors to; the same for all calls
} CagCall;

typedef bool (*CagBuiltinFunction)(CagCall *call, CagValue *result); // false: an error was set

typedef struct CagBuiltin {
  const char *signature; // "sin(angle)"
  CagBuiltinFunction function;
  const char *result;  // "number"
  const char *summary; // what it computes, units, errors: some sentences
  const char *example; // a script; lines with `// expect:` are checked by the tests
  // Types of the first argument that this row serves, as bits (1 << CAG_NUMBER ...); 0: any. Rows
  // of one name are tried in order.
  uint64_t first;
  const char *family; // heading of the documentation: "Numbers", "Curves"
} CagBuiltin;

extern const CagBuiltin cag_builtins[]; // of all families; the last row is empty

// --- Errors: set the machine's error (the place is the call, or the argument where `argument` >= 0
// and the call's source gives it) and give false --- `message` begins after the function's name:
// cag_fail_call(call, 0, CAG_ERR_type, "expects an angle, found %s") makes "sin expects an angle,
// found the number 30".
bool cag_fail_call(CagCall *call, int argument, CagErrorId id, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
// The same with the mend that stands behind the carets. Call after the failure was set.
// Mentions, in the last error, that the name it stands at hides a built-in function. Gives false.
bool cag_fail_hidden(CagVm *vm);
bool cag_fail_help(CagVm *vm, const char *format, ...) __attribute__((format(printf, 2, 3)));
// A geometry error: "bspline: `knots` must not decrease: ...", code by its reason; underlines the
// argument that err names when the call has one.
bool cag_fail_geometry(CagCall *call, const CagError *err);
// "NAME expects EXPECTED as `PARAMETER`, found FOUND" (of a first or only argument: "sin expects an
// angle, found the number 30"), code E0301 (type).
bool cag_fail_type(CagCall *call, int argument, const char *expected);

// Fails where a number that the call made is undefined (NaN), at any depth of its result. Parts of
// lists that were there before were checked when they were made.
bool cag_check_defined(CagCall *call, CagValue result);

// "NAME cannot be differentiated", code E0331: an argument is a jet (jet.h). All readers of
// arguments end here when they meet one, since cag_fail_type and cag_fail_element do.
bool cag_fail_differentiate(CagCall *call, int argument);

// Compilers and analyzers know that these never give true.
#define cag_fail_call(...) cag_never_true((cag_fail_call)(__VA_ARGS__))
#define cag_fail_help(...) cag_never_true((cag_fail_help)(__VA_ARGS__))
#define cag_fail_geometry(...) cag_never_true((cag_fail_geometry)(__VA_ARGS__))
#define cag_fail_type(...) cag_never_true((cag_fail_type)(__VA_ARGS__))

// --- Reading arguments. Each gives false with the error set. `argument` is the parameter's index.
// Unset ones take the default given (…_or). ---
bool cag_given(const CagCall *call, int argument);
bool cag_arg_number(CagCall *call, int argument, double *out);
bool cag_arg_number_or(CagCall *call, int argument, double fallback, double *out);
bool cag_arg_finite(CagCall *call, int argument, double *out);
bool cag_arg_positive(CagCall *call, int argument, double *out); // > 0 and finite
bool cag_arg_integer(CagCall *call, int argument, long low, long high, long *out);
bool cag_arg_integer_or(CagCall *call, int argument, long fallback, long low, long high, long *out);
bool cag_arg_angle(CagCall *call, int argument,
                   double *radians); // exact special angles survive cag_sincos
bool cag_arg_angle_or(CagCall *call, int argument, double fallback, double *radians);
bool cag_arg_degrees(CagCall *call, int argument, double *degrees);
bool cag_arg_bool_or(CagCall *call, int argument, bool fallback, bool *out);
bool cag_arg_text(CagCall *call, int argument, const char **out);
// Whether a text ends where its bytes have their first zero, so that C functions see all of it.
bool cag_text_is_c(const CagText *t);
// One of the NULL-terminated choices; unset: the first. *out is its index.
bool cag_arg_choice(CagCall *call, int argument, const char *const *choices, int *out);
bool cag_arg_list(CagCall *call, int argument, CagList **out); // ranges become lists
bool cag_arg_function(CagCall *call, int argument, CagValue *out);
bool cag_arg_record(CagCall *call, int argument, CagRecord **out);
// A point or vector: 2 or 3 finite numbers; dimension tells which (z = 0 for 2).
bool cag_arg_vec(CagCall *call, int argument, CagVec3 *out, int *dimension);
bool cag_arg_vec_or(CagCall *call, int argument, CagVec3 fallback, CagVec3 *out, int *dimension);
// A list of points of one dimension; *out is malloc'd (n >= 1), to be freed by the caller.
bool cag_arg_points(CagCall *call, int argument, CagVec3 **out, size_t *n, int *dimension);
bool cag_arg_numbers(CagCall *call, int argument, const double **out,
                     size_t *n); // a list of numbers; *out lives as long as the argument
// An interval: numbers or angles (degrees); a range's start and end.
bool cag_arg_interval(CagCall *call, int argument, double *start, double *end, bool *angle);
bool cag_arg_transform(CagCall *call, int argument, CagTransform *out);
bool cag_arg_curve(CagCall *call, int argument, CagCurve **out);     // borrowed
bool cag_arg_surface(CagCall *call, int argument, CagSurface **out); // borrowed

// Reads all arguments into a structure that tools/rows.awk has made of the signature; its fields have
// the types that parameter_kinds.def states.
//
// Optional arguments that are not given have their default. If the function itself supplies the
// default (such as `none`), the field is zero, and cag_given(call, i) is false. Returns false, with
// the error set, if an argument has the wrong type or is out of range.
bool cag_bind(CagCall *call, void *out, size_t size);

// --- What a built-in holds besides values ---
// A built-in may end at any allocation of a value, by a jump. What it holds is therefore released
// by the machine when the built-in ends, in whatever way, the last thing first.

// Holds a block of cag_malloc. Returns the block. If it is NULL, memory is out, and the run ends.
void *cag_hold(CagCall *call, void *block);
// Allocates `count` items, zeroed, and holds them; also for a count of 0.
void *cag_hold_array(CagCall *call, size_t count, size_t size);
// Holds something that release(what) releases. NULL is allowed, and not held.
void cag_hold_for(CagCall *call, void (*release)(void *what), void *what);
// Releases a held thing before the built-in ends; NULL is allowed.
void cag_release_held(CagCall *call, const void *what);
// The built-in gives a held thing away: it is no longer held. Returns it.
void *cag_give_held(CagCall *call, void *what);

// Calls a function of the script (or a built-in) from a built-in. A safe point: root what must
// survive.
bool cag_call(CagVm *vm, CagValue function, const CagValue *arguments, size_t n, CagValue *result);
// Call to be made in long loops of C code: false when interrupted or the time limit is crossed
// (error set).
bool cag_keep_going(CagVm *vm);
// Fails the run because it must stop, whatever the work that was cut short has answered. Returns
// false.
bool cag_stop_answer(CagVm *vm);

// --- The table ---
size_t cag_builtin_count(void);            // of names
size_t cag_builtin_find(const char *name); // (size_t)-1: none
const char *cag_builtin_name(size_t index);
const CagBuiltin *cag_builtin_rows(size_t index, size_t *rows); // the rows of that name
const char *const *cag_builtin_names(void);                     // NULL at the end
// Makes the table on which the functions below rely. Returns false if memory ran out; the table is
// then empty, and the next call tries again. A running machine always has the table.
bool cag_builtins_ready(void);
size_t cag_builtin_jet(size_t index); // cag_jet_row of its name

// NULL for a constant.
const CagSignature *cag_builtin_signature(size_t index, size_t row);
const CagSignature *cag_builtin_signature_of(const CagBuiltin *row); // row: of cag_builtin_rows
// The row that serves a call with this first argument by position (CAG_UNSET: none is by position)
// and so many arguments by position: the first whose mask takes the type and that has room for so
// many, else the first whose mask takes the type. (size_t)-1: no row serves the type.
size_t cag_builtin_select(size_t index, CagType first, size_t positional);
// Adds the types that a name serves, for messages: "a list, a curve or a transform".
void cag_builtin_served(size_t index, CagString *out);

// --- What the machine does for single built-ins ---
// Reads a whole file below the allowed folders. *bytes is malloc'd, with a NUL behind its n bytes.
// False: error set.
bool cag_vm_open_file(CagCall *call, int argument, const char *path, char **bytes, size_t *n);
// Compiles one expression of built-in names, `(a, t) => a * t`, and gives its value.
bool cag_vm_compile_lambda(CagVm *vm, const char *source, CagValue *out);
// f(), or handler(err) when f stops with an error that is no limit of the run.
bool cag_vm_attempt(CagCall *call, CagValue f, CagValue handler, CagValue *result);
// Writes the value, with the call's place and the label where it is not empty, to standard error.
void cag_vm_trace(CagCall *call, CagValue value, const char *label);

// Constants that are no functions: X Y Z origin identity pi tau inf deg rad turn mm cm ... ;
// CAG_UNSET when the built-in is a function.
CagValue cag_builtin_constant(CagVm *vm, size_t index);

#endif
