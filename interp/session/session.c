// Sessions: a machine for each run, on a thread with a large stack, and the results.

#include "interp/session/session.h"
#include "interp/kernel/kernel.h"

#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "base/array.h"
#include "base/assert.h"
#include "base/large_stack.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/meet/crossing.h"
#include "geom/solid/csg.h"
#include "interp/scene/fineness.h"
#include "interp/scene/section.h"
#include "interp/session/lead.h"
#include "interp/session/scene_build.h"
#include "interp/session/watch.h"

// Of a run. Less where all addresses together are not more.
#define MEMORY_MOST ((size_t)(SIZE_MAX > UINT32_MAX ? (uint64_t)4 << 30 : (uint64_t)1 << 30))
// The part of the time limit that the kernel may take for what the mesh can give as well.
#define KERNEL_SHARE 0.3

const char *cag_version(void) { return CAG_VERSION; }

void cag_session_options_init(CagSessionOptions *o) {
  *o = (CagSessionOptions){.max_memory = MEMORY_MOST,
                           .max_depth = 10000,
                           .max_triangles = 100000000,
                           .out = stdout,
                           .messages = stderr};
}

CagSession *cag_session_new(const CagSessionOptions *options) {
  CagSession *s = cag_calloc(1, sizeof *s);
  if (!s) return NULL;
  cag_session_options_init(&s->options);
  if (options) s->options = *options;
  s->frames = 1;
  s->main = CAG_NO_MODULE;
  return s;
}

static void drop_scene(CagSession *s) {
  CagAccount *before = cag_account_lend(s->vm ? &s->vm->account : NULL);
  cag_session_drop_robots(s);
  if (s->has_scene) cag_scene_free(&s->scene);
  cag_session_drop_sources(s);
  cag_session_drop_label_paths(s);
  cag_session_drop_mesh(s); // it shares the geometry of the scene
  s->has_scene = false;
  cag_session_drop_points(s);
  cag_account_lend(before);
}

void cag_session_drop_vm(CagSession *s) {
  CAG_ASSERT(!s->together); // the watch refers to the machine
  CagAccount *before = cag_account_lend(s->vm ? &s->vm->account : NULL);
  drop_scene(s);
  cag_free(s->inputs);
  cag_session_drop_params(s);
  cag_free(s->sources.items);
  s->sources = (CagItemSources){0};
  cag_account_lend(before);
  cag_session_clear_diagnostics(s);
  cag_vm_free(s->vm);
  s->vm = NULL;
  s->interactive = false;
  s->main = CAG_NO_MODULE;
  s->inputs = NULL;
  s->input_count = 0;
  cag_session_renew_time(s);
}

void cag_session_clear_diagnostics(CagSession *s) {
  cag_diagnostics_clear(&s->diagnostics);
  s->lasting = s->run_count = 0;
}

bool cag_session_begin(CagSession *s) {
  if (atomic_exchange(&s->busy, true)) return false;
  cag_diagnostics_truncate(&s->diagnostics, s->lasting);
  return true;
}

int cag_session_end(CagSession *s, int status) {
  s->busy = false;
  if (s->free_pending) cag_session_free(s);
  return status;
}

void cag_session_free(CagSession *s) {
  if (!s) return;
  s->free_pending = s->busy || s->together;
  if (s->free_pending) return;
  cag_session_drop_vm(s);
  cag_session_clear_defines(s);
  cag_kernel_free(s->kernel);
  cag_free(s->script);
  cag_free(s->only);
  cag_free(s);
}

// The kernel outlives the run that first needs it, so the run is not charged for it.
struct CagKernel *cag_session_kernel(CagSession *s) {
  CagAccount *before = cag_account_lend(NULL);
  if (!s->kernel) s->kernel = cag_kernel_new();
  if (s->kernel) cag_kernel_set_patience(s->kernel, KERNEL_SHARE * s->options.max_time);
  cag_account_lend(before);
  return s->kernel;
}

// --- Params ---

void cag_session_define(CagSession *s, const char *name, const char *value) {
  const size_t count = s->define_count + 1;
  char *n = cag_strdup(name), *v = cag_strdup(value);
  if (!n || !v || !CAG_RESIZE(s->names, count) || !CAG_RESIZE(s->values, count)) {
    cag_free(n);
    cag_free(v);
    s->define_lost = true;
    return;
  }
  s->names[s->define_count] = n;
  s->values[s->define_count++] = v;
}

void cag_session_clear_defines(CagSession *s) {
  for (size_t i = 0; i < s->define_count; i++) {
    cag_free(s->names[i]);
    cag_free(s->values[i]);
  }
  cag_free(s->names);
  cag_free(s->values);
  s->names = s->values = NULL;
  s->define_count = 0;
  s->define_lost = false;
}

void cag_session_set_frame(CagSession *s, double frame, double frames) {
  s->frame = frame;
  s->frames = frames;
}

void cag_session_set_loop(CagSession *s, bool loop) { s->loop = loop; }

// --- The machine and its thread ---

static bool add_folder(CagVm *vm, const char *path) {
  char *real = cag_realpath(path);
  if (!real) return errno != ENOMEM; // a missing folder contains no modules
  if (!CAG_RESIZE(vm->include, vm->include_count + 1)) {
    cag_free(real);
    return false;
  }
  vm->include[vm->include_count++] = real;
  return true;
}

static struct CagKernel *find_kernel(void *session) { return cag_session_kernel(session); }

CagVm *cag_session_vm(CagSession *s) {
  if (s->vm) return s->vm;
  const CagSessionOptions *o = &s->options;
  s->vm = cag_vm_new(&(CagVmOptions){.max_memory = o->max_memory,
                                     .max_depth = o->max_depth,
                                     .max_triangles = o->max_triangles,
                                     .max_time = o->max_time,
                                     .out = o->out,
                                     .trace = o->messages,
                                     .interrupt = o->interrupt},
                     &s->diagnostics);
  if (!s->vm) return NULL;
  s->vm->tolerance = o->tolerance;
  s->vm->verbose = o->verbose;
  s->vm->find_text = o->find_text;
  s->vm->find_text_context = o->find_text_context;
  s->vm->find_kernel = find_kernel;
  s->vm->find_kernel_context = s;
  CagAccount *before = cag_account_lend(&s->vm->account);
  bool found = true;
  for (size_t i = 0; found && i < o->module_path_count; i++)
    found = add_folder(s->vm, o->module_path[i]);
  cag_account_lend(before);
  if (found) return s->vm;
  cag_vm_free(s->vm);
  s->vm = NULL;
  cag_session_fail_memory(s);
  return NULL;
}

void cag_session_renew_time(CagSession *s) { s->time_left = s->options.max_time; }

typedef struct Task {
  CagVm *vm;
  bool (*work)(CagVm *vm, void *context);
  void *context;
  bool ok;
} Task;

static void perform(void *context, char *low) {
  Task *t = context;
  char here;
  const volatile int *stop = cag_stop_lend(&t->vm->stop);
  CagAccount *account = cag_account_lend(&t->vm->account);
  t->vm->stack_low = low;
  t->vm->stack_paid = &here;
  t->ok = cag_vm_protect(t->vm, t->work, t->context);
  // Work that was interrupted may not have set an error. If it failed without an error of the
  // machine, it has added its own diagnostic.
  if (t->vm->stop && (t->ok || t->vm->failed)) t->ok = cag_stop_answer(t->vm);
  cag_account_drop((size_t)(&here - t->vm->stack_paid));
  cag_account_lend(account);
  cag_stop_lend(stop);
}

static void tell_overdue(void *context) {
  CagSession *s = context;
  s->options.overdue(s, s->options.overdue_context);
}

static CagErrorId why_stopped(const CagSession *s);
static int fail_stopped(CagSession *s, CagErrorId id);

// Runs work(context, low) on a large stack while the limits are watched. Returns false if no thread
// can be created for it.
static bool run_watched(CagSession *s, void (*work)(void *context, char *low), void *context) {
  const CagVm *vm = s->vm;
  // If the limit has already been exceeded, the work ends at its first check.
  const double least = 1e-6;
  CagWatch w = {.stop = &s->vm->stop,
                .interrupt = s->options.interrupt,
                .seconds = !(vm->max_time > 0)    ? 0
                           : s->time_left > least ? s->time_left
                                                  : least,
                .overdue = s->options.overdue && !s->interactive ? tell_overdue : NULL,
                .context = s};
  cag_watch_begin(&w);
  const bool started = cag_large_stack_run(work, context);
  s->time_left -= cag_watch_end(&w);
  return started;
}

typedef struct Together {
  CagSession *session;
  void (*work)(void *context);
  void *context;
} Together;

static void perform_together(void *context, char *low) {
  Together *t = context;
  t->session->together = low;
  t->work(t->context);
  t->session->together = NULL;
}

void cag_session_together(CagSession *s, void (*work)(void *context), void *context) {
  // Without a thread, each call starts its own, or fails.
  if (s->together || !cag_session_vm(s) ||
      !run_watched(s, perform_together, &(Together){s, work, context}))
    work(context);
  if (s->free_pending) cag_session_free(s);
}

int cag_session_work(CagSession *s, bool (*work)(CagVm *vm, void *context), void *context) {
  CagVm *vm = cag_session_vm(s);
  if (!vm) return CAG_STATUS_LIMIT;
  cag_vm_clear_error(vm);
  Task task = {.vm = vm, .work = work, .context = context};
  bool started = true;
  if (s->together) perform(&task, s->together);
  else started = run_watched(s, perform, &task);
  if (!started) cag_vm_fail(vm, CAG_ERR_limit_memory, "cannot create a thread for the evaluation");
  fflush(s->options.out);
  cag_diagnostics_move(&s->diagnostics, &vm->errors);
  vm->failed = false;
  if (started && task.ok) return CAG_STATUS_OK;
  const int status = cag_session_status(s);
  // Interrupted work may not have set an error.
  return status == CAG_STATUS_OK && vm->stop ? fail_stopped(s, why_stopped(s)) : status;
}

typedef struct GeometryTask {
  CagSession *session;
  int (*work)(CagSession *s, void *context);
  void *context;
  int status;
} GeometryTask;

static bool perform_geometry(CagVm *vm, void *context) {
  GeometryTask *t = context;
  t->status = t->work(t->session, t->context);
  return t->status == CAG_STATUS_OK && !vm->failed;
}

int cag_session_geometry(CagSession *s, int (*work)(CagSession *s, void *context), void *context) {
  GeometryTask t = {s, work, context, CAG_STATUS_OK};
  int status = cag_session_work(s, perform_geometry, &t);
  if (t.status == CAG_STATUS_LIMIT && s->diagnostics.count == 0) cag_session_fail_memory(s);
  // Errors of interrupted work are meaningless.
  if (s->vm && s->vm->stop && t.status != CAG_STATUS_OK && t.status != CAG_STATUS_LIMIT &&
      t.status != CAG_STATUS_INTERRUPTED) {
    cag_diagnostics_clear(&s->diagnostics);
    return fail_stopped(s, why_stopped(s));
  }
  return t.status != CAG_STATUS_OK ? t.status : status;
}

CagStatus cag_session_checked(const CagSession *s, CagStatus status, CagError *err) {
  if (status || !s->vm || !s->vm->failed) return status;
  return cag_fail(err, CAG_E_CALLBACK, CAG_ERR_function_failed, "", -1, "a function failed");
}

// --- Status ---

int cag_session_fail_memory(CagSession *s) {
  cag_diagnostics_add(&s->diagnostics, CAG_ERR_limit_memory, NULL, (CagSpan){0, 0},
                      "not enough memory");
  return CAG_STATUS_LIMIT;
}

// Warnings may precede the error.
static const CagDiagnostic *first_error(const CagDiagnostics *d, size_t from) {
  for (size_t i = from; i < d->count; i++)
    if (cag_diagnostics_at(d, i)->severity == CAG_SEVERITY_ERROR) return cag_diagnostics_at(d, i);
  return cag_diagnostics_at(d, from);
}

int cag_session_status(const CagSession *s) {
  if (s->diagnostics.count == s->lasting) return CAG_STATUS_OK;
  const CagDiagnostic *d = first_error(&s->diagnostics, s->lasting);
  if (cag_error_is_limit(d->id)) return CAG_STATUS_LIMIT;
  switch (d->id) {
  case CAG_ERR_interrupted: return CAG_STATUS_INTERRUPTED;
  case CAG_ERR_output_file: return CAG_STATUS_FILE;
  case CAG_ERR_renderer: return CAG_STATUS_RENDERER;
  case CAG_ERR_format_unknown:
  case CAG_ERR_camera_unknown:
  case CAG_ERR_picture_size: return CAG_STATUS_USAGE;
  case CAG_ERR_module_unreadable: return d->source ? CAG_STATUS_SCRIPT : CAG_STATUS_FILE;
  default: return CAG_STATUS_SCRIPT;
  }
}

// Returns the reason why the machine's stop flag is set.
static CagErrorId why_stopped(const CagSession *s) {
  const bool interrupted = s->options.interrupt && *s->options.interrupt;
  return interrupted || !(s->options.max_time > 0) ? CAG_ERR_interrupted : CAG_ERR_limit_time;
}

static void add_time_limit(CagDiagnostics *d, double max_time) {
  cag_diagnostics_add(d, CAG_ERR_limit_time, NULL, (CagSpan){0, 0},
                      "exceeded the time limit of %g s (--max-time)", max_time);
}

static int fail_stopped(CagSession *s, CagErrorId id) {
  if (id == CAG_ERR_limit_time) add_time_limit(&s->diagnostics, s->options.max_time);
  else cag_diagnostics_add(&s->diagnostics, id, NULL, (CagSpan){0, 0}, "interrupted");
  return cag_session_status(s);
}

void cag_session_write_overdue(const CagSession *s, CagStyle style, FILE *out) {
  CagDiagnostics d = {0};
  add_time_limit(&d, s->options.max_time);
  cag_diagnostics_render(&d, (CagDiagnosticStyle)style, out);
  cag_diagnostics_clear(&d);
}

// Returns the location in the script of the set operation whose result is unbounded: that of the
// first shown item with the same error.
static CagSolidPlace place_of_operation(const CagSession *s, const CagError *err) {
  const CagSolidPlace none = {NULL, 0, 0};
  if (err->id != CAG_ERR_solid_unbounded) return none;
  for (size_t i = 0; s->has_scene && i < s->scene.item_count; i++) {
    const CagItem *item = &s->scene.items[i];
    CagBounds unused;
    CagError again = {0};
    if (item->kind != CAG_ITEM_SOLID || !item->as.solid->core) continue;
    if (cag_csg_bounds(item->as.solid, &unused, &again) && !strcmp(again.message, err->message))
      return item->as.solid->core->place;
  }
  return none;
}

int cag_session_fail_geometry(CagSession *s, const CagError *err) {
  if (err->status == CAG_E_CALLBACK && s->vm && s->vm->failed) { // a function of the script
    cag_diagnostics_move(&s->diagnostics, &s->vm->errors);
    return cag_session_status(s);
  }
  CagErrorId id = err->id;
  if (s->vm && s->vm->stop) id = why_stopped(s); // takes precedence over errors of interrupted work
  if (id == CAG_ERR_interrupted || id == CAG_ERR_limit_time) return fail_stopped(s, id);
  const CagSolidPlace place = place_of_operation(s, err);
  cag_diagnostics_add(&s->diagnostics, id, place.source, (CagSpan){place.start, place.end}, "%s",
                      err->message);
  return cag_session_status(s);
}

int cag_session_fail_io(CagSession *s, CagErrorId id, const CagError *err) {
  if (err->status == CAG_E_CALLBACK) return fail_stopped(s, why_stopped(s));
  if (err->status != CAG_E_FILE) id = err->id;
  CagDiagnostic *d =
      cag_diagnostics_add(&s->diagnostics, id, NULL, (CagSpan){0, 0}, "%s", err->message);
  if (err->help[0]) cag_diagnostic_set_help(d, "%s", err->help);
  return cag_exit_status(err);
}

// --- Runs ---

typedef struct Run {
  CagSession *session;
  const char *path, *name, *text;
  size_t length;
  int status;
} Run;

static bool run(CagVm *vm, void *context) {
  Run *r = context;
  CagSession *s = r->session;
  if (!r->path && s->options.folder && !vm->root)
    vm->root = cag_vm_real_path(vm, s->options.folder);
  size_t k = r->path ? cag_load_file(vm, r->path, &r->status)
                     : cag_load_text(vm, r->name, r->text, r->length, CAG_PARSE_FILE);
  s->main = k;
  if (k == CAG_NO_MODULE) return false;
  CagCleanup cleanup;
  CagDefine *defines = cag_temporary(&cleanup, s->define_count, sizeof *defines);
  vm->loop = s->loop;
  for (size_t i = 0; i < s->define_count; i++) defines[i] = (CagDefine){s->names[i], s->values[i]};
  bool ok = cag_program_set_params(vm, vm->modules[k], defines, s->define_count, s->frame,
                                   s->frames, false);
  cag_cleanup_run(&cleanup);
  return ok && cag_program_run(vm, vm->modules[k], NULL, NULL);
}

static int start_run(CagSession *s, Run *r) {
  if (s->together || !cag_session_begin(s)) return CAG_STATUS_USAGE;
  cag_session_drop_vm(s);
  cag_free(s->script);
  s->script = cag_strdup(r->path ? r->path : r->name);
  const bool ready = s->script && !s->define_lost;
  const int status = ready ? cag_session_work(s, run, r) : cag_session_fail_memory(s);
  s->lasting = s->run_count = s->diagnostics.count;
  return cag_session_end(s, status);
}

int cag_session_run_file(CagSession *s, const char *path) {
  return start_run(s, &(Run){.session = s, .path = path});
}

int cag_session_run_text(CagSession *s, const char *name, const char *text, size_t length) {
  return start_run(s, &(Run){.session = s, .name = name, .text = text, .length = length});
}

const char *cag_session_read_file(const CagSession *s, size_t i) {
  return s->vm && i < s->vm->read_count ? s->vm->reads[i] : NULL;
}

size_t cag_session_memory(const CagSession *s) { return s->vm ? s->vm->account.used : 0; }

// --- Diagnostics ---

size_t cag_session_error_count(const CagSession *s) { return s->diagnostics.count; }

void cag_session_error(const CagSession *s, size_t i, CagErrorView *out) {
  *out = (CagErrorView){0};
  if (i >= s->diagnostics.count) return;
  const CagDiagnostic *d = cag_diagnostics_at(&s->diagnostics, i);
  const CagErrorInfo *info = cag_error_info(d->id);
  *out = (CagErrorView){.code = info->code,
                        .reason = info->reason,
                        .message = d->message,
                        .help = d->help,
                        .warning = d->severity == CAG_SEVERITY_WARNING};
  if (!d->source) return;
  CagPosition from = cag_source_position(d->source, d->span.start),
              to = cag_source_position(d->source, d->span.end);
  out->file = d->source->name;
  out->line = from.line;
  out->column = from.column;
  out->end_line = to.line;
  out->end_column = to.column;
}

bool cag_session_error_note(const CagSession *s, size_t i, size_t k, CagNoteView *out) {
  *out = (CagNoteView){0};
  if (i >= s->diagnostics.count) return false;
  const CagDiagnostic *d = cag_diagnostics_at(&s->diagnostics, i);
  if (k >= d->note_count) return false;
  const CagNote *note = &d->notes[k];
  out->text = note->text ? note->text : "";
  out->is_call = note->kind == CAG_NOTE_CALL || note->kind == CAG_NOTE_TAIL_CALL;
  if (!note->source) return true;
  const CagPosition from = cag_source_position(note->source, note->span.start),
                    to = cag_source_position(note->source, note->span.end);
  out->file = note->source->name;
  out->line = from.line;
  out->column = from.column;
  out->end_line = to.line;
  out->end_column = to.column;
  return true;
}

void cag_session_write_diagnostics(const CagSession *s, CagStyle style, FILE *out) {
  cag_diagnostics_render(&s->diagnostics, (CagDiagnosticStyle)style, out);
}

// --- Scene ---

static bool rerun_shows(CagVm *vm, CagSession *s) {
  vm->shown_count = 0;
  for (size_t i = 0; i < s->input_count; i++)
    if (!cag_program_run_shows(vm, vm->modules[s->inputs[i]])) return false;
  return true;
}

static bool refresh(CagVm *vm, void *context) { return rerun_shows(vm, context); }

int cag_session_refresh(CagSession *s) {
  if (!s->interactive) return CAG_STATUS_OK;
  cag_session_renew_time(s);
  return cag_session_work(s, refresh, s);
}

// The shapes are named after the definition, as if the script showed it.
static bool build_definition(CagVm *vm, CagSession *s) {
  const CagExpr name = {.kind = CAG_EXPR_NAME,
                        .as.name = {.id = s->only, .binding = CAG_BIND_OUTER}};
  CagShown shown = {.expr = &name};
  return cag_session_find_definition(s, s->only, &shown.value) &&
         cag_scene_from_values(vm, &shown, 1, &s->scene, NULL);
}

static bool build(CagVm *vm, void *context) {
  CagSession *s = context;
  if (s->interactive && !rerun_shows(vm, s)) return false;
  s->sources.count = 0;
  if (s->only) s->has_scene = build_definition(vm, s);
  else s->has_scene = cag_scene_from_values(vm, vm->shown, vm->shown_count, &s->scene, &s->sources);
  return s->has_scene;
}

static int complete_scene(CagSession *s, void *context) {
  (void)context;
  CagError err = {0};
  CagStatus status = cag_session_checked(s, cag_scene_complete(&s->scene, &err), &err);
  return !status ? CAG_STATUS_OK : cag_session_fail_geometry(s, &err);
}

// Leaves room in the list of diagnostics for a later error.
static void warn_shown(CagSession *s, CagErrorId id, CagSolidPlace place, const char *name,
                       const char *what) {
  if (s->diagnostics.count + 1 >= CAG_DIAGNOSTICS_MAX) {
    s->diagnostics.dropped++;
    return;
  }
  cag_diagnostics_add(&s->diagnostics, id, place.source, (CagSpan){place.start, place.end},
                      "%s: %s", name ? name : "a shape", what)
      ->severity = CAG_SEVERITY_WARNING;
}

static void warn_of_empties(CagSession *s) {
  for (size_t i = 0; i < s->scene.empty_count; i++) {
    const CagItem *item = &s->scene.empties[i];
    CagSolidPlace place = {NULL, 0, 0};
    if (item->kind == CAG_ITEM_SOLID && item->as.solid->core) place = item->as.solid->core->place;
    warn_shown(s, CAG_ERR_empty_shape, place, item->name,
               "the shape is empty, so it adds nothing to the scene");
  }
}

static int fail_nothing_shown(CagSession *s) {
  const bool empty = s->scene.empty_count > 0;
  CagDiagnostic *d = cag_diagnostics_add(
      &s->diagnostics, CAG_ERR_nothing_to_show, NULL, (CagSpan){0, 0}, "%s shows %s",
      s->script ? s->script : "the session", empty ? "only empty shapes" : "no shape");
  cag_diagnostic_set_help(d, empty ? "`is_empty` tests whether a shape is empty"
                             : cag_session_shows_image(s)
                                 ? "to export an image, write cag export FILE -o OUT.exr, or .png"
                                 : "show a shape, such as show sphere(10)");
  drop_scene(s);
  return CAG_STATUS_SCRIPT;
}

// Self-intersecting surfaces and flat lofts are shown, with a warning.
static int look_for_crossings(CagSession *s, void *context) {
  (void)context;
  char what[256];
  for (size_t i = 0; i < s->scene.item_count; i++) {
    const CagItem *item = &s->scene.items[i];
    const bool crosses = (item->kind == CAG_ITEM_SURFACE &&
                          cag_surface_crosses_itself(item->as.surface, what, sizeof what)) ||
                         (item->kind == CAG_ITEM_SOLID &&
                          cag_solid_crosses_itself(item->as.solid, what, sizeof what));
    if (s->vm->failed) continue;
    if (crosses)
      warn_shown(s, CAG_ERR_crosses_itself, (CagSolidPlace){NULL, 0, 0}, item->name, what);
    else if (item->kind == CAG_ITEM_SOLID && cag_solid_is_flat(item->as.solid, what, sizeof what))
      warn_shown(s, CAG_ERR_flat_loft, (CagSolidPlace){NULL, 0, 0}, item->name, what);
  }
  return CAG_STATUS_OK;
}

// --- What of it is shown ---

// Drops the scene and the warnings about it.
static void forget_scene(CagSession *s) {
  drop_scene(s);
  cag_diagnostics_truncate(&s->diagnostics, s->run_count);
  s->lasting = s->run_count;
}

bool cag_session_set_section(CagSession *s, const double plane[4]) {
  CagError ignored;
  CagPlane made = {{0, 0, 0}, {0, 0, 1}};
  if (plane &&
      cag_plane_from_row((double[]){plane[0], plane[1], plane[2], -plane[3]}, &made, &ignored))
    return false;
  if (!cag_session_begin(s)) return false;
  s->has_section = plane != NULL;
  s->section = made;
  forget_scene(s);
  cag_session_end(s, CAG_STATUS_OK);
  return true;
}

bool cag_session_show_only(CagSession *s, const char *name) {
  char *copy = name ? cag_strdup(name) : NULL;
  if ((name && !copy) || !cag_session_begin(s)) {
    cag_free(copy);
    return false;
  }
  cag_free(s->only);
  s->only = copy;
  forget_scene(s);
  cag_session_end(s, CAG_STATUS_OK);
  return true;
}

// If the section leaves nothing, the help states where the shapes are.
static int fail_nothing_left(CagSession *s, CagSectionReach reach) {
  CagDiagnostic *d = cag_diagnostics_add(
      &s->diagnostics, CAG_ERR_nothing_to_show, NULL, (CagSpan){0, 0}, "the section %s %s",
      s->form == CAG_SCENE_CUT ? "leaves nothing of what is shown by"
                               : "does not meet what is shown by",
      s->script ? s->script : "the session");
  const CagVec3 n = s->section.normal;
  const double first = n.x != 0 ? n.x : n.y != 0 ? n.y : n.z, sign = first < 0 ? -1 : 1;
  if (reach.low <= reach.high)
    cag_diagnostic_set_help(d, "the shapes reach from %.6g to %.6g along [%.6g, %.6g, %.6g]",
                            first < 0 ? 0 - reach.high : reach.low,
                            first < 0 ? 0 - reach.low : reach.high, sign * n.x + 0, sign * n.y + 0,
                            sign * n.z + 0);
  drop_scene(s);
  return CAG_STATUS_SCRIPT;
}

static int cut_scene(CagSession *s, void *context) {
  CagSectionReach *reach = context;
  CagError err = {0};
  CagStatus status = s->form == CAG_SCENE_CUT
                         ? cag_scene_cut(&s->scene, &s->section, reach, &err)
                         : cag_scene_section(&s->scene, &s->section, reach, &err);
  status = cag_session_checked(s, status, &err);
  return !status ? CAG_STATUS_OK : cag_session_fail_geometry(s, &err);
}

static bool shows_shapes(const CagScene *scene) {
  bool found = scene->label_count > 0;
  for (size_t i = 0; i < scene->item_count; i++)
    found = found || scene->items[i].kind != CAG_ITEM_GROUND;
  return found;
}

// The default tolerance follows the size of the shapes before they are cut, so that it does not
// change as the section moves.
static int measure_whole(CagSession *s, void *context) {
  (void)context;
  const CagBounds whole = cag_scene_reach(&s->scene);
  if (!(s->scene.usual_tolerance > 0)) s->scene.usual_tolerance = cag_usual_tolerance(&whole);
  return CAG_STATUS_OK;
}

static int apply_section(CagSession *s) {
  CagSectionReach reach;
  if (s->form == CAG_SCENE_WHOLE || !shows_shapes(&s->scene)) return CAG_STATUS_OK;
  const int measured = cag_session_geometry(s, measure_whole, NULL);
  if (measured != CAG_STATUS_OK) return measured;
  const int status = cag_session_geometry(s, cut_scene, &reach);
  return status == CAG_STATUS_OK && !shows_shapes(&s->scene) ? fail_nothing_left(s, reach) : status;
}

static int build_scene_as(CagSession *s, CagSceneForm form) {
  if (!s->has_section) form = CAG_SCENE_WHOLE;
  if (s->has_scene && s->form != form) forget_scene(s);
  if (s->interactive) {
    drop_scene(s);
    cag_session_renew_time(s);
  }
  if (s->has_scene) return CAG_STATUS_OK;
  s->form = form;
  if (s->interactive) cag_session_clear_diagnostics(s);
  int status = cag_session_work(s, build, s);
  if (status != CAG_STATUS_OK) return status;
  CagScene *scene = &s->scene;
  if (s->options.tolerance > 0) scene->tolerance = s->options.tolerance;
  scene->usual_tolerance = s->usual_tolerance;
  scene->max_triangles = s->options.max_triangles;
  scene->interrupt = &s->vm->stop;
  if (!scene->script && s->script && !(scene->script = cag_strdup(s->script))) {
    drop_scene(s);
    return cag_session_fail_memory(s);
  }
  if (scene->item_count + scene->label_count == 0) return fail_nothing_shown(s);
  status = apply_section(s);
  if (!s->has_scene) return status;
  if (status == CAG_STATUS_OK) status = cag_session_geometry(s, complete_scene, NULL);
  if (status == CAG_STATUS_OK) warn_of_empties(s);
  if (status == CAG_STATUS_OK && scene->item_count + scene->label_count == 0)
    return fail_nothing_shown(s);
  if (status == CAG_STATUS_OK) status = cag_session_geometry(s, look_for_crossings, NULL);
  if (status != CAG_STATUS_OK) drop_scene(s);
  else s->lasting = s->diagnostics.count;
  return status;
}

int cag_session_build_scene(CagSession *s) { return build_scene_as(s, CAG_SCENE_CUT); }

int cag_session_build_drawing(CagSession *s) { return build_scene_as(s, CAG_SCENE_OUTLINES); }

int cag_session_scene(CagSession *s, CagShownCounts *out) {
  *out = (CagShownCounts){0};
  if (!cag_session_begin(s)) return CAG_STATUS_USAGE;
  int status = cag_session_build_scene(s);
  if (status == CAG_STATUS_OK)
    *out = (CagShownCounts){s->scene.item_count, s->scene.camera_count, s->scene.light_count};
  return cag_session_end(s, status);
}

// --- Tolerances ---

double cag_session_default_tolerance(CagSession *s) {
  if (!cag_session_begin(s)) return 0;
  const bool built = cag_session_build_scene(s) == CAG_STATUS_OK;
  const double tolerance = built ? s->scene.usual_tolerance : 0;
  cag_session_end(s, CAG_STATUS_OK);
  return tolerance;
}

bool cag_session_set_default_tolerance(CagSession *s, double tolerance) {
  if (!cag_session_begin(s)) return false;
  s->usual_tolerance = tolerance > 0 && isfinite(tolerance) ? tolerance : 0;
  forget_scene(s);
  cag_session_end(s, CAG_STATUS_OK);
  return true;
}

void cag_session_begin_meshes(CagSession *s, const CagCamera *picture) {
  s->used = (CagTolerances){0};
  s->scene.used = &s->used;
  s->scene.picture = picture;
}

void cag_session_end_meshes(CagSession *s) {
  s->scene.used = NULL;
  s->scene.picture = NULL;
}

bool cag_session_tolerance(const CagSession *s, size_t i, CagToleranceView *out) {
  static const char *const SOURCES[] = {[CAG_TOLERANCE_OF_ITEM] = "shape",
                                        [CAG_TOLERANCE_OF_SCENE] = "option",
                                        [CAG_TOLERANCE_OF_PIXELS] = "pixels",
                                        [CAG_TOLERANCE_OF_SIZE] = "size"};
  size_t k = 0;
  for (size_t source = 0; source < CAG_TOLERANCE_SOURCES; source++) {
    const CagToleranceRange *r = &s->used.of[source];
    if (!(r->most > 0) || k++ != i) continue;
    *out = (CagToleranceView){SOURCES[source], r->least, r->most};
    return true;
  }
  return false;
}

const char *cag_session_camera(CagSession *s, size_t i) {
  if (!cag_session_begin(s)) return NULL;
  const bool built = cag_session_build_scene(s) == CAG_STATUS_OK;
  const char *name = built && i < s->scene.camera_count ? s->scene.cameras[i].name : NULL;
  cag_session_end(s, CAG_STATUS_OK);
  return name;
}

typedef struct Listing {
  CagSession *session;
  FILE *out;
} Listing;

// Returns the name of the shape or image, or else of the definition.
static const char *shown_name(const CagShown *shown) {
  const CagValue v = shown->value;
  const CagText *own = cag_is_shape(v)       ? CAG_AS_SHAPE(v)->name
                       : v.type == CAG_IMAGE ? CAG_AS_IMAGE(v)->name
                                             : NULL;
  return own ? own->bytes : cag_lead(shown->expr).name;
}

static bool describe(CagVm *vm, void *context) {
  Listing *l = context;
  if (l->session->interactive && !rerun_shows(vm, l->session)) return false;
  for (size_t i = 0; i < vm->shown_count; i++) {
    CagString text = {0};
    const char *name = shown_name(&vm->shown[i]);
    if (name) cag_string_printf(&text, "%s: ", name);
    if (vm->shown[i].value.type == CAG_LIST) cag_describe_value(vm, &text, vm->shown[i].value);
    else cag_print_value(vm, &text, vm->shown[i].value, false);
    cag_string_check(vm, &text);
    fprintf(l->out, "%s\n", text.bytes ? text.bytes : "");
    cag_string_free(&text);
  }
  return true;
}

void cag_session_describe_scene(CagSession *s, FILE *out) {
  if (!cag_session_begin(s)) return;
  if (s->interactive) cag_session_renew_time(s);
  cag_session_end(s, cag_session_work(s, describe, &(Listing){s, out}));
}
