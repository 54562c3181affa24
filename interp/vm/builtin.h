// Built-in functions. Dispatch, arity checks, documentation, completion, and `cag doc` are all made
// from one table, which has a row for each function.
//
// A row's signature states the parameters with their types, ranges, and defaults (signature.h):
//
//     "cone(height: length > 0, radius: length > 0, centered: bool = false)"
//
// The generated code reads all arguments of a call into a structure and passes it to the function.
// Parameters with `= default` are optional; an argument that is not given is CAG_UNSET. A parameter
// named with a single capital (C, P, V, T, G, S, A, B, Q, R) can be given by position only, others
// by position or name. `...` as the last parameter allows any number of further positional
// arguments.
//
// A name can have several rows, for different types of the first argument. The first row whose
// `accepts` includes the type is called. The rows are in interp/builtin/*.rows, a file for each
// family, from which tools/rows.awk makes cag_builtins.

#ifndef CAG_INTERP_VM_BUILTIN_H
#define CAG_INTERP_VM_BUILTIN_H

#include "base/diagnostic.h"
#include "base/memory.h"
#include "interp/vm/heap.h"
#include "interp/vm/signature.h"
#include "interp/vm/value.h"

// The arguments of one call. `values` is in the order of the parameters. It is CAG_UNSET for
// parameters that were not given, and for those given none whose default is none. With `...`,
// further arguments are values[parameter_count .. count).
typedef struct CagCall {
  CagVm *vm;
  const struct CagBuiltin *builtin;
  CagValue *values;
  size_t count;  // at least the number of named parameters
  CagError *err; // receives errors of core functions; shared by all calls
} CagCall;

typedef bool (*CagBuiltinFunction)(CagCall *call, CagValue *result); // returns false if an error
                                                                     // was set

typedef struct CagBuiltin {
  const char *signature; // "sin(angle)"
  CagBuiltinFunction function;
  const char *result;  // "number"
  const char *summary; // what it computes, units, errors: a few sentences
  const char *example; // a script; lines with `// a script; its `// expect:` lines are checked by
                       // the tests
  // Types of the first argument that this row accepts, as bits (1 << CAG_NUMBER ...); 0: any. Rows
  // of one name are tried in order.
  uint64_t first;
  const char *family; // heading in the documentation: "Numbers", "Curves"
} CagBuiltin;

extern const CagBuiltin cag_builtins[]; // of all families; the last row is empty

// --- Errors ---
// These functions set the machine's error and return false. Its location is the call, or the
// argument if `argument` >= 0 and the call's source contains it. `message` continues the function's
// name: cag_fail_call(call, 0, CAG_ERR_type, "expects an angle, found %s") makes "sin expects an
// angle, found the number 30".
bool cag_fail_call(CagCall *call, int argument, CagErrorId id, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
// Adds to the last error that the name at its location hides a built-in function. Returns false.
bool cag_fail_hidden(CagVm *vm);
// Sets the help of the last error, which is shown after the carets. Returns false.
bool cag_fail_help(CagVm *vm, const char *format, ...) __attribute__((format(printf, 2, 3)));
// A geometry error, such as "bspline: `knots` must not decrease: ...", with the code of its reason.
// Underlines the argument that err names, if the call contains it.
bool cag_fail_geometry(CagCall *call, const CagError *err);
// "NAME expects EXPECTED as `PARAMETER`, found FOUND" (or, for a first or only argument, "sin
// expects an angle, found the number 30"), with code E0301 (type).
bool cag_fail_type(CagCall *call, int argument, const char *expected);

// Fails if a number in the result, at any depth, is undefined (NaN). Parts of lists that existed
// before the call were checked when they were made.
bool cag_check_defined(CagCall *call, CagValue result);

// "NAME cannot be differentiated", code E0331, because an argument is a jet (jet.h). Functions that
// read arguments report jets through cag_fail_type and cag_fail_element, which call this.
bool cag_fail_differentiate(CagCall *call, int argument);

// Compilers and analyzers know that these never return true.
#define cag_fail_call(...) cag_never_true((cag_fail_call)(__VA_ARGS__))
#define cag_fail_help(...) cag_never_true((cag_fail_help)(__VA_ARGS__))
#define cag_fail_geometry(...) cag_never_true((cag_fail_geometry)(__VA_ARGS__))
#define cag_fail_type(...) cag_never_true((cag_fail_type)(__VA_ARGS__))

// --- Reading arguments ---
// Each function returns false if it set an error. `argument` is the index of the parameter. The
// functions that end with _or take the value for a parameter that is not given.
bool cag_given(const CagCall *call, int argument);
bool cag_arg_number(CagCall *call, int argument, double *out);
bool cag_arg_number_or(CagCall *call, int argument, double fallback, double *out);
bool cag_arg_finite(CagCall *call, int argument, double *out);
bool cag_arg_positive(CagCall *call, int argument, double *out); // > 0 and finite
bool cag_arg_integer(CagCall *call, int argument, long low, long high, long *out);
bool cag_arg_integer_or(CagCall *call, int argument, long fallback, long low, long high, long *out);
bool cag_arg_angle(CagCall *call, int argument,
                   double *radians); // exact for special angles, as for cag_sincos
bool cag_arg_degrees(CagCall *call, int argument, double *degrees);
bool cag_arg_bool_or(CagCall *call, int argument, bool fallback, bool *out);
bool cag_arg_text(CagCall *call, int argument, const char **out);
// Tests whether a text contains no zero bytes, so that C functions see all of it.
bool cag_text_is_c(const CagText *t);
// Reads one of the NULL-terminated choices, or the first one if not given. *out is its index.
bool cag_arg_choice(CagCall *call, int argument, const char *const *choices, int *out);
bool cag_arg_list(CagCall *call, int argument, CagList **out); // ranges are converted to lists
bool cag_arg_function(CagCall *call, int argument, CagValue *out);
bool cag_arg_record(CagCall *call, int argument, CagRecord **out);
// Reads a point or vector of 2 or 3 finite numbers and its dimension (z = 0 if it is 2).
bool cag_arg_vec(CagCall *call, int argument, CagVec3 *out, int *dimension);
bool cag_arg_vec_or(CagCall *call, int argument, CagVec3 fallback, CagVec3 *out, int *dimension);
// Reads a list of n >= 1 points of one dimension. The caller must free *out.
bool cag_arg_points(CagCall *call, int argument, CagVec3 **out, size_t *n, int *dimension);
bool cag_arg_numbers(CagCall *call, int argument, const double **out,
                     size_t *n); // a list of numbers; *out lives as long as the argument
// Reads the start and end of a range of numbers or angles (in degrees).
bool cag_arg_interval(CagCall *call, int argument, double *start, double *end, bool *angle);
bool cag_arg_transform(CagCall *call, int argument, CagTransform *out);
bool cag_arg_curve(CagCall *call, int argument, CagCurve **out);     // borrowed
bool cag_arg_surface(CagCall *call, int argument, CagSurface **out); // borrowed

// Reads an argument into its field of the structure that tools/rows.awk has generated from the
// signature; parameter_kinds.def has the types of the fields. For generated code.
//
// An optional argument that is not given gets its default. If the function itself supplies the
// default (such as `none`), the field is zero, and cag_given(call, i) is false. Returns false, with
// the error set, if the argument has the wrong type or is out of range.
bool cag_bind_field(CagCall *call, int argument, void *structure);
// Whether the structure has the size that the signature of the call states.
bool cag_bind_fits(const CagCall *call, size_t size);

// --- Resources of a built-in ---
// Any allocation of a value may end a built-in by a long jump. Therefore the machine releases what
// the built-in holds, in reverse order, however the built-in ends.

// Holds a block from cag_malloc and returns it. If it is NULL, memory is out, and the run ends.
void *cag_hold(CagCall *call, void *block);
// Allocates and holds `count` zeroed items. `count` may be 0.
void *cag_hold_array(CagCall *call, size_t count, size_t size);
// Holds a resource that release(what) releases. Ignores NULL.
void cag_hold_for(CagCall *call, void (*release)(void *what), void *what);
// Releases a held resource before the built-in ends. Ignores NULL.
void cag_release_held(CagCall *call, const void *what);
// Stops holding a resource, because its ownership passes to other code. Returns it.
void *cag_give_held(CagCall *call, void *what);

// Calls a function of the script or another built-in. This is a safe point: push values that must
// survive onto the root stack.
bool cag_call(CagVm *vm, CagValue function, const CagValue *arguments, size_t n, CagValue *result);
// To be called in long loops. Returns false, with the error set, if the run was interrupted or its
// time limit was exceeded.
bool cag_keep_going(CagVm *vm);
// Fails the run because it must stop, whatever the interrupted work returned. Returns false.
bool cag_stop_answer(CagVm *vm);

// --- The table ---
size_t cag_builtin_count(void);            // of names
size_t cag_builtin_find(const char *name); // (size_t)-1: none
const char *cag_builtin_name(size_t index);
const CagBuiltin *cag_builtin_rows(size_t index, size_t *rows); // the rows of that name
const char *const *cag_builtin_names(void);                     // NULL at the end
// Makes the table that the functions below need. Returns false if memory ran out; the table is then
// empty, and the next call tries again. A running machine always has the table.
bool cag_builtins_ready(void);
size_t cag_builtin_jet(size_t index); // cag_jet_row of its name

// NULL for a constant.
const CagSignature *cag_builtin_signature(size_t index, size_t row);
const CagSignature *cag_builtin_signature_of(const CagBuiltin *row); // row: of cag_builtin_rows
// Returns the row for a call with this first positional argument (CAG_UNSET: none) and this number
// of positional arguments: the first row that accepts the type and has room for the arguments, or
// else the first that accepts the type. Returns (size_t)-1 if no row accepts the type.
size_t cag_builtin_select(size_t index, CagType first, size_t positional);
// Adds the types that a name accepts, for messages: "a list, a curve or a transform".
void cag_builtin_served(size_t index, CagString *out);

// --- Operations of the machine for single built-ins ---
// Reads a whole file below the allowed folders. *bytes is allocated with malloc and has a NUL after
// its n bytes. Returns false if an error was set.
bool cag_vm_open_file(CagCall *call, int argument, const char *path, char **bytes, size_t *n);
// Compiles an expression that uses built-in names only, such as `(a, t) => a * t`, and sets *out to
// its value.
bool cag_vm_compile_lambda(CagVm *vm, const char *source, CagValue *out);
// Computes f(), or handler(err) if f fails with an error that is not a limit of the run.
bool cag_vm_attempt(CagCall *call, CagValue f, CagValue handler, CagValue *result);
// Writes the value, with the location of the call and the label unless it is empty, to standard
// error.
void cag_vm_trace(CagCall *call, CagValue value, const char *label);

// Returns the value of a built-in constant: X Y Z origin identity pi tau inf deg rad turn mm cm ...
// Returns CAG_UNSET if the built-in is a function.
CagValue cag_builtin_constant(CagVm *vm, size_t index);

#endif
