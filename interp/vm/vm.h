// The machine: the state of a running program.
//
// A program is a set of modules. Each top-level definition has a slot in `globals`, which is
// evaluated on first use by running its initializer. Functions are compiled to register code (see
// opcodes.def): a frame's registers are a window of one stack of values, and the operands a, b, and
// c of an instruction are register numbers. Since values never change, closures copy what they
// capture.
//
// Invariants: `frames[0 .. frame_count)` are the active calls, including those below built-ins that
// call back. The saved pc of every frame below the top is just after the call that it waits for.
// All values in stack[0 .. top) are valid (live or kept by the last collection), so the collector
// may mark all of them.

#ifndef CAG_INTERP_VM_VM_H
#define CAG_INTERP_VM_VM_H

#include <stdatomic.h>
#include <stdio.h>
#include <time.h>

#include "base/hash.h"
#include "base/memory.h"
#include "interp/vm/builtin.h"
#include "interp/vm/heap.h"
#include "interp/vm/memo.h"
#include "interp/vm/value.h"
#include "lang/ast.h"
#include "lang/parser.h"

// One value of a `show` statement, in the order of the file.
typedef struct CagShown {
  CagValue value;
  const CagExpr *expr; // NULL: not shown by a script
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
    int32_t x; // jump distance, or index of a constant, global, or child
  };
} CagInstruction;

// The locations of a call's arguments in the source, for messages; sorted by `pc`.
typedef struct CagCallSite {
  uint32_t pc;
  uint32_t first, count; // in the proto's argument spans; the first span is that of the callee
} CagCallSite;

typedef struct CagProto {
  const char *name; // of the function or definition; NULL: a lambda or a statement
  bool is_function; // false: initializer of a definition, or a statement
  const CagSource *source;
  size_t parameter_count, required_count;
  const char **parameters; // NUL-terminated names, compared by strcmp
  uint32_t body;           // pc of the body, after the defaults
  uint32_t registers;
  CagInstruction *code;
  CagSpan *spans;
  size_t code_count, code_capacity;
  CagValue *constants;
  size_t constant_count, constant_capacity;
  struct CagProto **children;
  size_t child_count, child_capacity;
  struct CagCapture {
    bool local;     // a register of the enclosing function; else one of its captures
    uint16_t index; // CAG_CAPTURE_SELF: the enclosing closure itself
  } * captures;
  size_t capture_count, capture_capacity;
  CagCallSite *sites;
  size_t site_count, site_capacity;
  CagSpan *site_spans;
  size_t site_span_count, site_span_capacity;
  const char ***names; // argument names of calls with named arguments: one array per such call
  size_t *name_counts;
  size_t names_count, names_capacity;
  struct CagProto *next; // all protos of the machine
} CagProto;

#define CAG_CAPTURE_SELF 0xffff
// The maximum number of registers of a frame. Operands have 16 bits, and the highest numbers are
// reserved as markers.
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
  // The definition of a pattern has a slot of its own, whose value is not kept, beside those of its
  // names.
  const CagPattern *pattern; // NULL: a name
  size_t whole;              // of a name of a pattern: the slot of its definition; 0: none
  bool given; // a param whose value was set from outside; it is kept when others are forgotten
} CagGlobal;

// The locations of calls in tail position, of which the last CAG_TAIL_KEPT of each frame are kept.
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
  uint64_t tail_count; // calls in tail position made by this frame; their locations are in
                       // vm->tails
} CagFrame;

typedef struct CagModuleUnit {
  size_t number;
  char *name; // "std.materials", or the path as shown in messages
  char *path; // real path of the file; NULL: standard library, REPL, text
  CagSource *source;
  CagModuleAst *ast;
  size_t *tops;   // indices of globals, by CagDecl.index
  CagValue value; // the module as a value
  // LOST means that memory ran out while loading; the next import loads the module again.
  enum { CAG_MODULE_LOADING, CAG_MODULE_LOADED, CAG_MODULE_FAILED, CAG_MODULE_LOST } state;
  bool sound;         // it has no syntax errors
  bool resolved;      // its names are bound, except for unknown ones
  size_t first_error; // index in the machine's errors of the first error of its names
  bool asserted;      // its asserts have run
  bool adopted;       // its definitions belong to the interactive session
  size_t *imports;    // module index of each import statement, in order
  size_t import_count;
  struct CagPublicName {
    const char *name;
    size_t global;
    const CagDecl *decl;
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
  size_t objects;   // number of objects; after a collection, of live ones
  size_t debt;      // bytes allocated since the last collection
  size_t threshold; // debt at which the next collection is due
  size_t seen;      // used bytes of the account when the debt was last updated
  uint8_t mark;     // mark of live objects in the last collection: 1 or 2
  uint8_t depth;    // of geometry callbacks into the script; older objects are not collected
                    // (heap.c)
  CagObject **gray; // marked objects with unmarked references; NULL: gray_first
  size_t gray_count, gray_capacity;
  CagObject *gray_first[CAG_GRAY_FIRST];
  size_t values_marked; // in lists and the like, during the last collection
  bool gray_lost;       // memory ran out for the list, so marked objects must be scanned again
  size_t scans;         // objects scanned in all collections
  bool unfinished; // the last collection was stopped: marks are mixed, and some garbage remains
  size_t collections;
} CagHeap;

// A running built-in. `order` tells from which argument of the call in the source each parameter
// came.
typedef struct CagNative {
  struct CagNative *outer;
  size_t frame_count; // number of frames when it was called
  bool direct;        // called by the instruction of the top frame, not by another built-in
  bool probed;        // a formula called by geometry has failed
  const uint16_t
      *order; // index of the argument, as written, of each parameter, 0xffff: none; NULL: in order
  size_t order_count;
} CagNative;

// What the origins of many shapes share: calls from one place, and equal motions. Each
// collection clears this table, so it does not keep objects alive.
enum { CAG_RECENT_COUNT = 64 };
typedef struct CagRecentOrigins {
  CagOriginSite *sites[CAG_RECENT_COUNT];
  CagMotionNote *motions[CAG_RECENT_COUNT];
} CagRecentOrigins;

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
  // Values that geometry refers to. Slots keep their numbers; free slots are CAG_UNSET and hold the
  // number of the next free one + 1.
  CagValue *kept;
  size_t kept_count, kept_capacity, kept_free;
  CagHashIndex kept_materials; // slots of the records that are materials of operands
  // Resources held by running built-ins, the innermost last (builtin.h).
  struct CagHeld {
    void (*release)(void *what);
    void *what;
  } * held;
  size_t held_count, held_capacity;
  CagRecentOrigins recent;
  CagMemo memos[CAG_MEMO_COUNT];
  size_t memo_bytes;
  uint32_t differentiation; // level of the jets in use; 0: none
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
  // stack_paid, the stack of values up to paid_end.
  char *stack_paid;
  CagValue *paid_end;

  // The error of the run: `failed` means that errors.items[0] is set.
  CagDiagnostics errors;
  bool failed;
  // Set if memory ran out while a printed value, a message, or a path was made, which is then
  // incomplete. The run ends with that error.
  bool starved;

  // Definitions of earlier inputs of the REPL, oldest first.
  const char **outer_names;
  size_t *outer_globals;
  size_t outer_count, outer_capacity;

  // What the script showed
  CagShown *shown;
  size_t shown_count, shown_capacity;

  // The environment.
  FILE *out, *trace;
  bool verbose;                  // `trace` also receives how results were found
  const volatile int *interrupt; // never NULL
  volatile int stop; // set by the watcher of the run, after an interrupt or when its time is over
  double max_time;   // seconds; 0: none
  struct timespec started;
  size_t max_triangles;
  bool uses_time; // code was compiled that reads `time`, `frame`, or `frames`
  bool loop;      // time is frame/frames
  double tolerance;
  char *root; // real path of the folder of the main script; NULL: none, so no file may be read
  // Returns the text that replaces a file, given its real path, or NULL. It must live until the
  // call that loads the module ends. NULL: files are read.
  const char *(*find_text)(void *context, const char *path, size_t *length);
  void *find_text_context;
  // Returns the session's kernel for exact boundaries, or NULL if memory ran out. NULL: there is
  // none.
  struct CagKernel *(*find_kernel)(void *context);
  void *find_kernel_context;
  char **include; // real paths of the module path
  size_t include_count;

  // Absolute paths of the files that the run read, or would have read if they existed.
  char **reads;
  size_t read_count, read_capacity;
  CagHashIndex reads_by_path;
};

// The stop flag for long geometry computations that do not call the script. They end when it is
// nonzero.
static inline const volatile int *cag_vm_stop(const CagVm *vm) { return &vm->stop; }

// The stacks are charged in steps of this many bytes.
#define CAG_STACK_STEP ((size_t)64 << 10)

// Reserved globals.
enum { CAG_GLOBAL_TIME, CAG_GLOBAL_FRAME, CAG_GLOBAL_FRAMES, CAG_GLOBAL_RESERVED };

// --- compile.c: syntax tree to code ---
// Compiles an expression to a unit without parameters, called `name` (a definition) or unnamed (a
// statement). `tops` and the module provide the numbers of globals. Returns NULL, with an error, if
// it is too large for one function.
CagProto *cag_compile_expression(CagVm *vm, CagModuleUnit *m, const CagExpr *e, const char *name);
// The same for a definition of a pattern. Its code returns the list of the values of its names.
CagProto *cag_compile_definition(CagVm *vm, CagModuleUnit *m, const CagExpr *value,
                                 const CagPattern *pattern, const char *name);
// Compiles an assert. Its code returns true or fails.
CagProto *cag_compile_assert(CagVm *vm, CagModuleUnit *m, const CagStatement *s);
void cag_proto_free(CagProto *p);

// --- run.c ---
bool cag_vm_run(CagVm *vm, const CagProto *proto, CagValue *result); // a unit without parameters
bool cag_vm_force(CagVm *vm, size_t global, CagValue *result);
// Runs `work` in a guard against exhausted memory (base/guard.h). Returns false with the error set
// if memory ran out. Every run must start here.
bool cag_vm_protect(CagVm *vm, bool (*work)(CagVm *vm, void *context), void *context);
// Returns false, with the error set, if the run must stop (interrupt, time, memory). Collects
// garbage if it is due.
bool cag_safe_point(CagVm *vm);
// Returns whether the C stack has room for deeper recursion. The depth to which nested values are
// processed is limited.
bool cag_room_on_c_stack(CagVm *vm);
// Charges the stack of values up to `end`, which is after paid_end. Ends the run if memory is out.
void cag_pay_for_values(CagVm *vm, const CagValue *end);
// Like cag_room_on_c_stack, but sets an error if there is no room. It also fails if the run must
// stop, because values that share parts may take extremely long to process. `done` is what is done
// to the values, for the message.
bool cag_may_go_deeper(CagVm *vm, const char *done);
// Returns whether a value can be shown: a shape, camera, light, setting, robot, or a list of these.
bool cag_value_is_shown(CagVm *vm, CagValue v);

// Releases the resources of built-ins, down to a count.
void cag_vm_release_held(CagVm *vm, size_t count);

// --- callback.c: calls of the script from geometry ---
// Keeps a value alive until cag_vm_let_go. Returns its slot.
size_t cag_vm_keep(CagVm *vm, CagValue v);
void cag_vm_let_go(CagVm *vm, size_t slot);
// Runs `work`, which may call the script, from geometry code. Returns false, with the error set, if
// a limit is exceeded. Objects made before the call are not collected. After an error, all further
// calls return false at once.
bool cag_vm_call_back(CagVm *vm, bool (*work)(CagVm *vm, void *context), void *context);

// --- operators.c: operators beyond the fast paths of the loop ---
bool cag_arithmetic(CagVm *vm, CagBinaryOp op, CagValue a, CagValue b, CagValue *result);
bool cag_compare(CagVm *vm, CagBinaryOp op, CagValue a, CagValue b, bool *result);
bool cag_contains(CagVm *vm, CagValue needle, CagValue haystack, bool *result);
bool cag_negate(CagVm *vm, CagValue v, CagValue *result);
bool cag_index(CagVm *vm, CagValue object, CagValue index, CagValue *result);
bool cag_member(CagVm *vm, CagValue object, CagValue name, CagValue *result);
bool cag_make_range(CagVm *vm, CagValue low, CagValue high, CagValue step, bool open,
                    CagValue *result);

// --- failure.c ---
// Returns the location of the running call, or false if there is none.
bool cag_vm_place(const CagVm *vm, const CagSource **source, CagSpan *span);
// The same for the nearest call outside of the standard library.
bool cag_vm_caller(const CagVm *vm, const CagSource **source, CagSpan *span);
// Sets the error at the current instruction of the top frame (or without a location if there is
// none), with the chain of calls. Returns false.
bool cag_vm_fail(CagVm *vm, CagErrorId id, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
// The same, with a location within the function, which has already returned a wrong result.
bool cag_vm_fail_in(CagVm *vm, CagValue function, CagErrorId id, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
// The same, underlining argument `argument` (from 0) of the current call; -1: the callee.
bool cag_vm_fail_at(CagVm *vm, int argument, CagErrorId id, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
// As cag_fail_call (builtin.h), these never give true.
#define cag_vm_fail(...) cag_never_true((cag_vm_fail)(__VA_ARGS__))
#define cag_vm_fail_at(...) cag_never_true((cag_vm_fail_at)(__VA_ARGS__))
void cag_vm_clear_error(CagVm *vm);
// Returns whether the error is a limit of the run, which `attempt` does not catch. An error without
// a message counts as one.
bool cag_vm_at_limit(const CagVm *vm);
// Sets the error of the memory limit and leaves the innermost cag_vm_protect.
_Noreturn void cag_vm_out_of_memory(CagVm *vm);
// Sets the error of the memory limit and returns false.
bool cag_vm_fail_memory(CagVm *vm);

// --- modules.c ---
#define CAG_NO_MODULE ((size_t)-1)
// Loads a module and its imports: parses all, then resolves all, then assigns slots. Returns
// CAG_NO_MODULE, with errors in vm->errors, on failure.
size_t cag_load_file(CagVm *vm, const char *path, int *exit_status);
size_t cag_load_text(CagVm *vm, const char *name, const char *text, size_t length,
                     CagParseMode mode);
// The same for a text that stands for the file `path`, a real path (NULL: it is in no file). Gives
// the module even if it has errors; its AST is NULL if it could not be read.
CagModuleUnit *cag_load_document(CagVm *vm, const char *name, const char *path, const char *text,
                                 size_t length);
// Returns the source of a script that is not to be run, which lives as long as the machine, or NULL
// if it is not text.
const CagSource *cag_read_source(CagVm *vm, const char *name, const char *text, size_t length);
// Parses a script that is not to be run. Returns its tree, which lives as long as the machine, or
// NULL if it has errors.
const CagModuleAst *cag_read_script(CagVm *vm, const char *name, const char *text, size_t length);
// Returns the absolute path, which the caller frees, or NULL if the file does not exist or memory
// ran out, which is recorded.
char *cag_vm_real_path(CagVm *vm, const char *path);
// Adds a file to the list of those that were read.
void cag_vm_note_file(CagVm *vm, const char *path);
// Returns the real path of a file (from malloc) if it may be read, which means that it is below the
// root or the module path. Otherwise writes the reason to message and returns NULL. Notes the file.
char *cag_allowed_path(CagVm *vm, const char *path, const char *beside, char *message, size_t size);
// Reads a whole file. Returns NULL, with the reason in *why (static or from strerror), on failure.
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
