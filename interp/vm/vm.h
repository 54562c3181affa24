// The machine: what a running program consists of.
//
// A program is a set of modules. Each top-level definition has a slot in `globals`, evaluated when
// first needed by running its initializer. Functions are register code (see opcodes.def): a frame's
// registers are a window of one value stack; instruction operands a, b, c number them. Since values
// never change, closures copy what they capture.
//
// Invariants: `frames[0 .. frame_count)` are the active calls, also across built-ins that call
// back, and every frame below the top has its pc saved just behind the call it waits for. All
// values in stack[0 .. top) are valid (live or kept by the last collection), so the collector may
// mark them all.

#ifndef CAG_INTERP_VM_VM_H
#define CAG_INTERP_VM_VM_H

#include <stdatomic.h>
#include <stdio.h>
#include <time.h>

#include "base/hash.h"
#include "base/memory.h"
#include "interp/vm/builtin.h"
#include "interp/vm/heap.h"
#include "interp/vm/value.h"
#include "lang/ast.h"
#include "lang/parser.h"

// One value of a `show` statement, in the order of the file.
typedef struct CagShown {
  CagValue value;
  const CagExpr *expr; // NULL: not of a script
  const CagSource *source;
  CagSpan span;
} CagShown;

typedef enum CagOpcode {
#define CAG_OPCODE(name, story) CAG_CODE_##name,
#include "interp/vm/opcodes.def"
#undef CAG_OPCODE
  CAG_OPCODE_COUNT
} CagOpcode;

typedef struct CagInstruction {
  uint16_t op, a;
  union {
    struct {
      uint16_t b, c;
    };
    int32_t x; // jump distance, or number of a constant, global or child
  };
} CagInstruction;

// Where the arguments of a call stand in the source, for messages; in order of `pc`.
typedef struct CagCallSite {
  uint32_t pc;
  uint32_t first, count; // in the proto's argument spans; the first span is the callee's
} CagCallSite;

typedef struct CagProto {
  const char *name; // of the function or definition; NULL: a lambda or a statement
  bool is_function; // false: initializer of a definition, or a statement
  const CagSource *source;
  size_t parameter_count, required_count;
  const char **parameters; // NUL-terminated names, compared by strcmp
  uint32_t body;           // pc of the body, behind the defaults
  uint32_t registers;
  CagInstruction *code;
  CagSpan *spans;
  size_t code_count, code_capacity;
  CagValue *constants;
  size_t constant_count, constant_capacity;
  struct CagProto **children;
  size_t child_count, child_capacity;
  struct CagCapture {
    bool local;     // a register of the function around; else one of its captures
    uint16_t index; // CAG_CAPTURE_SELF: the closure around itself
  } * captures;
  size_t capture_count, capture_capacity;
  CagCallSite *sites;
  size_t site_count, site_capacity;
  CagSpan *site_spans;
  size_t site_span_count, site_span_capacity;
  const char ***names; // argument names of calls that name some: one array per such call
  size_t *name_counts;
  size_t names_count, names_capacity;
  struct CagProto *next; // all protos of the machine
} CagProto;

#define CAG_CAPTURE_SELF 0xffff
// One frame has at most so many registers: operands are 16 bits, and the last numbers are kept for
// marks.
#define CAG_MAX_REGISTERS 60000

struct CagModuleUnit;

typedef enum CagGlobalState { CAG_GLOBAL_NEW, CAG_GLOBAL_RUNNING, CAG_GLOBAL_DONE } CagGlobalState;

typedef struct CagGlobal {
  CagValue value;
  CagGlobalState state;
  const CagExpr
      *expr; // compiled when the value is first needed; NULL: the value was set from outside
  struct CagModuleUnit *unit;
  const char *name;
  CagSpan span; // of the name
  bool given;   // a param whose value comes from outside: it stays when others are forgotten
} CagGlobal;

// A call in tail position leaves its place here: the last CAG_TAIL_KEPT of each frame.
#define CAG_TAIL_KEPT 16
typedef struct CagTailPlace {
  const CagProto *proto;
  uint32_t pc;
} CagTailPlace;

typedef struct CagFrame {
  const CagProto *proto;
  CagClosure *closure;
  const CagInstruction *pc; // next instruction
  CagValue *base;
  uint64_t tail_count; // calls in tail position made by this frame; places in vm->tails
} CagFrame;

typedef struct CagModuleUnit {
  size_t number;
  char *name; // "std.materials", or the path as shown
  char *path; // real path of the file; NULL: standard library, REPL, text
  CagSource *source;
  CagModuleAst *ast;
  size_t *tops;   // globals of the tops, by CagDecl.index
  CagValue value; // the module as a value
  // LOST means that memory ran out while loading; the next import loads the module again.
  enum { CAG_MODULE_LOADING, CAG_MODULE_LOADED, CAG_MODULE_FAILED, CAG_MODULE_LOST } state;
  bool sound;         // it has no syntax errors
  bool resolved;      // its known names are bound
  size_t first_error; // where the errors of its names begin in those of the machine
  bool asserted;      // its asserts have run
  bool adopted;       // its definitions are those of the interactive session
  size_t *imports;    // module number of each import statement, in order
  size_t import_count;
  struct CagPublicName {
    const char *name;
    size_t global;
    const CagStatement *statement;
  } * publics; // sorted by name
  size_t public_count;
  const char **public_names;
} CagModuleUnit;

// --- Memory (heap.c) ---
#define CAG_SMALL_MAX 512
#define CAG_SMALL_STEP 16
#define CAG_SMALL_CLASSES (CAG_SMALL_MAX / CAG_SMALL_STEP + 1)
#define CAG_GRAY_FIRST 64
typedef struct CagPage CagPage;
typedef struct CagHeap {
  CagObject *free_lists[CAG_SMALL_CLASSES];
  CagPage *pages;
  CagObject *large; // list of objects from cag_malloc
  size_t objects;   // that there are: live ones after a collection
  size_t debt;      // bytes allocated since the last collection
  size_t threshold; // debt at which the next collection is due
  size_t seen;      // used bytes of the account when the debt was last brought up to date
  uint8_t mark;     // mark of live objects in the last collection: 1 or 2
  uint8_t depth;    // of calls of the script by geometry: what is older is not collected (heap.c)
  CagObject **gray; // marked objects with unmarked references; NULL: gray_first
  size_t gray_count, gray_capacity;
  CagObject *gray_first[CAG_GRAY_FIRST];
  size_t values_marked; // in lists and the like, by the last collection
  bool gray_lost;       // memory ran out for the list, so marked objects must be scanned again
  size_t scans;         // objects scanned in all collections
  bool unfinished; // the last collection was stopped: marks are mixed, and some garbage remains
  size_t collections;
} CagHeap;

// A built-in that is being run: tells which argument of the call in the source each parameter came
// from.
typedef struct CagNative {
  struct CagNative *outer;
  size_t frame_count; // frames when it was called
  bool direct;        // called by the instruction of the top frame, not by another built-in
  bool probed;        // a formula that geometry called has failed
  const uint16_t
      *order; // argument (as written) of each parameter, 0xffff: none; NULL: as they come
  size_t order_count;
} CagNative;

struct CagVm {
  CagAccount account; // what the run has allocated; its limit is --max-memory
  CagHeap heap;
  CagNative *native;
  CagValue *stack, *stack_end, *top;
  CagValue *high_water;
  CagFrame *frames;
  size_t frame_count, frame_limit;
  CagTailPlace *tails; // frame_limit x CAG_TAIL_KEPT, reserved lazily
  CagValue *roots;
  size_t root_count, root_capacity;
  CagError core_error; // CagCall.err of all calls
  // Values that geometry refers to, in slots that keep their numbers; free ones are CAG_UNSET and
  // hold the next free one + 1.
  CagValue *kept;
  size_t kept_count, kept_capacity, kept_free;
  CagHashIndex kept_materials; // slots of the records that are materials of operands
  // What the built-ins that are running hold, the innermost last (builtin.h).
  struct CagHeld {
    void (*release)(void *what);
    void *what;
  } * held;
  size_t held_count, held_capacity;
  uint32_t differentiation; // level of the jets that are being computed with, 0: none
  CagText **interned;
  size_t interned_count, interned_size;
  CagGlobal *globals;
  size_t global_count, global_capacity;
  CagModuleUnit **modules;
  size_t module_count, module_capacity;
  CagProto *protos;
  CagValue *builtin_values; // one function value per built-in name
  char *stack_low;          // lowest address that the C stack may reach
  // Both stacks are charged to the account as far as they have been used: the C stack down to
  // stack_paid, the values up to paid_end.
  char *stack_paid;
  CagValue *paid_end;

  // The error of the run: `failed` says that errors.items[0] is set.
  CagDiagnostics errors;
  bool failed;
  // Set if memory ran out while making a printed value, a message, or a path, which is then
  // incomplete. The run ends with that error.
  bool starved;

  // Definitions of earlier texts of the REPL, oldest first.
  const char **outer_names;
  size_t *outer_globals;
  size_t outer_count, outer_capacity;

  // What the script showed
  CagShown *shown;
  size_t shown_count, shown_capacity;

  // Outside
  FILE *out, *trace;
  const volatile int *interrupt; // never NULL
  volatile int stop; // set by who watches the run, when it was interrupted or its time is over
  double max_time;   // seconds; 0: none
  struct timespec started;
  size_t max_triangles;
  bool loop; // time is frame/frames
  double tolerance;
  char *root;     // real path of the folder of the main script; NULL: none (no file may be read)
  char **include; // real paths of the module path
  size_t include_count;
};

// What long geometry without calls of the script looks at, to end when it is not 0.
static inline const volatile int *cag_vm_stop(const CagVm *vm) { return &vm->stop; }

// Stacks are charged in steps of so many bytes.
#define CAG_STACK_STEP ((size_t)64 << 10)

// Reserved globals.
enum { CAG_GLOBAL_TIME, CAG_GLOBAL_FRAME, CAG_GLOBAL_FRAMES, CAG_GLOBAL_RESERVED };

// --- compile.c: syntax tree to code ---
// Code of an expression as the body of a parameterless unit named `name` (a definition) or nameless
// (a statement). `tops` and the module give globals their numbers. NULL: too large for one function
// (an error is added).
CagProto *cag_compile_expression(CagVm *vm, CagModuleUnit *m, const CagExpr *e, const char *name);
// Code of an assert: gives true or fails.
CagProto *cag_compile_assert(CagVm *vm, CagModuleUnit *m, const CagStatement *s);
void cag_proto_free(CagProto *p);

// --- run.c ---
bool cag_vm_run(CagVm *vm, const CagProto *proto, CagValue *result); // a unit without parameters
bool cag_vm_force(CagVm *vm, size_t global, CagValue *result);
// Runs `work` in a guard against exhausted memory (base/guard.h). Returns false with the error set
// if memory ran out. Every run must start here.
bool cag_vm_protect(CagVm *vm, bool (*work)(CagVm *vm, void *context), void *context);
// Whether the run must stop (interrupt, time, memory): sets the error and gives false. Collects
// when due.
bool cag_safe_point(CagVm *vm);
// Whether the C stack has room for more recursion: deep values are walked only so far.
bool cag_room_on_c_stack(CagVm *vm);
// Charges the stack of values up to `end`, which is beyond paid_end. Leaves the run if memory is
// out.
void cag_pay_for_values(CagVm *vm, const CagValue *end);
// The same, with an error where there is none, or where the run must stop: values that share their
// parts take endlessly long to walk. `done` tells what is done to the values.
bool cag_may_go_deeper(CagVm *vm, const char *done);
// Whether a value can be shown: a shape, camera, light, setting, robot, or a list of these.
bool cag_value_is_shown(CagVm *vm, CagValue v);

// Releases what built-ins hold, down to a count.
void cag_vm_release_held(CagVm *vm, size_t count);

// --- callback.c: calls of the script from geometry ---
// Keeps a value alive until it is let go.
size_t cag_vm_keep(CagVm *vm, CagValue v);
void cag_vm_let_go(CagVm *vm, size_t slot);
// Runs `work`, which may call the script, from geometry code: a limit that is crossed gives false
// with the error set, and nothing that is held outside is collected. After an error all further
// calls give false at once.
bool cag_vm_call_back(CagVm *vm, bool (*work)(CagVm *vm, void *context), void *context);

// --- operators.c: everything that is no fast path of the loop ---
bool cag_arithmetic(CagVm *vm, CagBinaryOp op, CagValue a, CagValue b, CagValue *result);
bool cag_compare(CagVm *vm, CagBinaryOp op, CagValue a, CagValue b, bool *result);
bool cag_contains(CagVm *vm, CagValue needle, CagValue haystack, bool *result);
bool cag_negate(CagVm *vm, CagValue v, CagValue *result);
bool cag_index(CagVm *vm, CagValue object, CagValue index, CagValue *result);
bool cag_member(CagVm *vm, CagValue object, CagValue name, CagValue *result);
bool cag_make_range(CagVm *vm, CagValue low, CagValue high, CagValue step, bool open,
                    CagValue *result);

// --- failure.c ---
// Where the running call stands; false: nowhere.
bool cag_vm_place(const CagVm *vm, const CagSource **source, CagSpan *span);
// Sets the error at the current instruction of the top frame (or without place when there is none),
// with the chain of calls.
bool cag_vm_fail(CagVm *vm, CagErrorId id, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
// The same with the place within the function, which has been left: what it gave is wrong.
bool cag_vm_fail_in(CagVm *vm, CagValue function, CagErrorId id, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
// The same, underlining argument `argument` (0 .. ) of the current call; -1: the callee.
bool cag_vm_fail_at(CagVm *vm, int argument, CagErrorId id, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
// As cag_fail_call (builtin.h), these never give true.
#define cag_vm_fail(...) cag_never_true((cag_vm_fail)(__VA_ARGS__))
#define cag_vm_fail_at(...) cag_never_true((cag_vm_fail_at)(__VA_ARGS__))
void cag_vm_clear_error(CagVm *vm);
// Whether the error is a limit of the run, which passes through `attempt`; so does one without a
// message.
bool cag_vm_at_limit(const CagVm *vm);
// Sets the error of the memory limit and leaves the innermost cag_vm_protect.
_Noreturn void cag_vm_out_of_memory(CagVm *vm);
// Sets the error of the memory limit and returns false.
bool cag_vm_fail_memory(CagVm *vm);

// --- modules.c ---
#define CAG_NO_MODULE ((size_t)-1)
// Loads a module and what it imports: parses all, then resolves all, then gives slots. Errors go to
// vm->errors; CAG_NO_MODULE then.
size_t cag_load_file(CagVm *vm, const char *path, int *exit_status);
size_t cag_load_text(CagVm *vm, const char *name, const char *text, size_t length,
                     CagParseMode mode);
// The source of a script that is not to be run; it lives as long as the machine. NULL: it is no
// text.
const CagSource *cag_read_source(CagVm *vm, const char *name, const char *text, size_t length);
// Parses a script that is not to be run; its tree lives as long as the machine. NULL: it has
// errors.
const CagModuleAst *cag_read_script(CagVm *vm, const char *name, const char *text, size_t length);
// Returns the absolute path, which the caller frees. NULL: the file does not exist, or memory ran
// out, which is recorded.
char *cag_vm_real_path(CagVm *vm, const char *path);
// Whether a file may be read: below the root or the module path. Gives the real path (malloc'd) or
// NULL with the reason in message.
char *cag_allowed_path(CagVm *vm, const char *path, const char *beside, char *message, size_t size);
// Reads a whole file. NULL: *why is what went wrong (static or strerror text).
extern const char cag_file_out_of_memory[]; // a value of *why
char *cag_read_whole_file(const char *path, size_t *length, const char **why);

// --- vm.c ---
typedef struct CagVmOptions {
  size_t max_memory, max_depth, max_triangles;
  double max_time;
  FILE *out, *trace;
  const volatile int *interrupt; // NULL: none
} CagVmOptions;
// Returns NULL, with an error, if memory ran out or max_memory is too small for the built-ins.
CagVm *cag_vm_new(const CagVmOptions *options, CagDiagnostics *errors);
void cag_vm_free(CagVm *vm);
void cag_module_free(CagModuleUnit *m);
size_t cag_vm_add_global(CagVm *vm, const char *name);

#endif
