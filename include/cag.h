// libcag: scripts of the cag language as meshes, scenes and pictures.
//
//     CagSessionOptions options;
//     cag_session_options_init(&options);
//     CagSession *s = cag_session_new(&options);
//     if (cag_session_run_file(s, "vase.cag") == CAG_STATUS_OK) cag_session_export(s, "vase.stl",
//     NULL); cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr); cag_session_free(s);
//
// A session runs one script at a time and keeps what it showed. The program `cag` is a client of
// these calls. A session may be used by one thread at a time; different sessions are independent of
// each other. Evaluation happens on a thread of the session's own, whose stack is large enough for
// deep recursion.
//
// A callback (a value, progress, a name) is called while a call is under way. From there, calls
// that evaluate, build a scene, document or clear are refused: with CAG_STATUS_USAGE, false or NULL
// by their result, and without a trace in the diagnostics. Questions about diagnostics and names
// are answered; cag_session_free takes effect when the call under way returns. A question about an
// element that does not exist answers NULL, false, or a view of NULL texts.

#ifndef CAG_H
#define CAG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

#define CAG_API __attribute__((visibility("default")))

// What calls give back: the exit statuses of the program.
enum {
  CAG_STATUS_OK = 0,
  CAG_STATUS_SCRIPT = 1,   // the script failed
  CAG_STATUS_USAGE = 2,    // a call that makes no sense: an unknown format, no such camera
  CAG_STATUS_FILE = 3,     // a file could not be read or written
  CAG_STATUS_RENDERER = 4, // the renderer is missing or failed
  CAG_STATUS_LIMIT = 5,    // a limit was crossed
  CAG_STATUS_INTERRUPTED = 130
};

typedef enum CagStyle { CAG_STYLE_TEXT, CAG_STYLE_COLOR, CAG_STYLE_JSON } CagStyle;

typedef struct CagSession CagSession;

typedef struct CagSessionOptions {
  double tolerance;  // mm, largest distance between mesh and surface; 0: by the size of each shape
  size_t max_memory; // bytes (4 GiB)
  size_t max_depth;  // calls (10,000)
  size_t max_triangles;           // (100 million)
  double max_time;                // seconds of a run and of all that is made of its scene; 0: none
  const char *const *module_path; // folders of modules (-I)
  size_t module_path_count;
  // Set operations of solids in POV-Ray source: "native", "mesh", or "auto" (NULL): pictures mesh
  // them, and a .pov file has them native where no two operands have faces that coincide.
  const char *pov_csg;
  const char *folder; // below which texts read files and modules (NULL: the working folder)
  FILE *out;          // what print writes to (stdout)
  FILE *messages;     // what trace writes to (stderr)
  const volatile int *interrupt; // becomes nonzero to stop; may be NULL
  // Called once, on a thread of the session's own, when work goes on well after max_time because it
  // is in a step that cannot be ended; a program may wish to end then, after a word of
  // cag_session_write_overdue. Not called for inputs (cag_session_input). May be NULL.
  void (*overdue)(CagSession *s, void *context);
  void *overdue_context;
} CagSessionOptions;

CAG_API const char *cag_version(void);
CAG_API void cag_session_options_init(CagSessionOptions *options);
// NULL when memory is out. The options are copied, module_path, folder, pov_csg and what they point
// to must outlive the session.
CAG_API CagSession *cag_session_new(const CagSessionOptions *options);
CAG_API void cag_session_free(CagSession *s);

// Sets a param of the scripts run later, as -D does: the value is an expression, or the text itself
// where the param is a text.
CAG_API void cag_session_define(CagSession *s, const char *name, const char *value);
CAG_API void cag_session_clear_defines(CagSession *s);
// time, frame and frames of the scripts run later; frames >= 1.
CAG_API void cag_session_set_frame(CagSession *s, double frame, double frames);
// Whether time is frame/frames, for films that repeat, in place of frame/(frames - 1).
CAG_API void cag_session_set_loop(CagSession *s, bool loop);

// Runs a script anew: prints, asserts; what it shows is kept until the next run. "-" is standard
// input. The status says how it ended, and the diagnostics why.
CAG_API int cag_session_run_file(CagSession *s, const char *path);
CAG_API int cag_session_run_text(CagSession *s, const char *name, const char *text, size_t length);

// The one layout of a script, malloc'd; NULL where it has errors. Nothing is run, no other file is
// read.
CAG_API int cag_session_format(CagSession *s, const char *name, const char *text, size_t length,
                               char **out, size_t *out_length);

// Finds errors without running anything: of syntax, names and arity, and types that cannot be
// right; also definitions that nothing uses, as warnings. Imported modules are read. "-" is
// standard input.
CAG_API int cag_session_check_file(CagSession *s, const char *path);
CAG_API int cag_session_check_text(CagSession *s, const char *name, const char *text,
                                   size_t length);

// --- Diagnostics of the last call ---
CAG_API size_t cag_session_error_count(const CagSession *s);
typedef struct CagErrorView {
  const char *code, *reason, *message, *help; // help may be NULL
  const char *file;                           // NULL: no place
  size_t line, column, end_line, end_column;
} CagErrorView;
CAG_API void cag_session_error(const CagSession *s, size_t i, CagErrorView *out);
// Writes the error of a run that took longer than max_time. Any thread may call it, at any time.
CAG_API void cag_session_write_overdue(const CagSession *s, CagStyle style, FILE *out);
CAG_API void cag_session_write_diagnostics(const CagSession *s, CagStyle style, FILE *out);

// --- What was shown ---
typedef struct CagShownCounts {
  size_t items, cameras, lights;
} CagShownCounts;
// Builds the scene of what was shown (also done by export and render).
CAG_API int cag_session_scene(CagSession *s, CagShownCounts *out);
// A line for each thing shown: "vase: revolution surface, ..." to `out`.
CAG_API void cag_session_describe_scene(CagSession *s, FILE *out);
// Name of camera i of the scene; NULL: none.
CAG_API const char *cag_session_camera(CagSession *s, size_t i);

// Writes the scene in the format of the path's ending, or in `format` ("obj", "stl", "ply", "glb",
// "pov", "svg", "json"). "-" is standard output.
CAG_API int cag_session_export(CagSession *s, const char *path, const char *format);
// The formats that there are, NULL at the end, and what each is.
CAG_API const char *const *cag_export_formats(void);
CAG_API const char *cag_export_format_story(const char *format);

// A part of a picture: pixels from its left and top edge. A width of 0: all of it.
typedef struct CagRenderRegion {
  int x, y, width, height;
} CagRenderRegion;

typedef struct CagRenderOptions {
  int width, height;   // pixels; 0: the camera's
  const char *quality; // "draft", "normal", "final"
  int samples;         // of a lens for each pixel (cameras with an aperture); 0: by the quality
  const char *camera;  // its name, or top, bottom, front, back, left, right, iso; NULL: the first
  double exposure;     // stops, for .png
  int threads;         // 0: one for each processor
  double time_limit;   // seconds of the renderer; 0: what is left of max_time
  CagRenderRegion region; // only this part is rendered and written
  void (*progress)(void *context, double percent, const char *phase);
  void *progress_context;
} CagRenderOptions;
CAG_API void cag_render_options_init(CagRenderOptions *o);
// Renders what was shown through POV-Ray to .exr or .png.
CAG_API int cag_session_render(CagSession *s, const CagRenderOptions *options, const char *path);
// Version text of POV-Ray, or NULL with the reason in `why` (static buffer of the session).
CAG_API const char *cag_find_povray(char *buffer, size_t size);

// --- Interactive use: definitions stay, and may be said again; what depends on a name follows ---
// Evaluates definitions, statements and expressions. Each expression's value is given to `value` as
// printed text and type name.
CAG_API int cag_session_input(CagSession *s, const char *text, size_t length,
                              void (*value)(void *context, const char *text, const char *type),
                              void *context);
// Runs a script file into the interactive session: its definitions stay.
CAG_API int cag_session_input_file(CagSession *s, const char *path);
// Takes what is shown by this text, the name of a definition as a rule, out of the scene; gives how
// many times it was shown.
CAG_API size_t cag_session_hide(CagSession *s, const char *text);
// Whether a text asks for another line.
CAG_API bool cag_input_is_incomplete(const char *text, size_t length);
// Names defined interactively, newest of each, in the order of definition: NULL at the end of the
// list.
CAG_API const char *cag_session_name(CagSession *s, size_t i, const char **source_text,
                                     size_t *source_length);
// Writes what is known of a name defined interactively, its text and documentation; false: no such
// name.
CAG_API bool cag_session_write_doc(CagSession *s, const char *name, FILE *out);
// What the library calls something that the interactive session imported from it: after
// `import std.materials as mat`, "mat.glazed" is "std.materials.glazed". False: it did not.
CAG_API bool cag_session_library_name(CagSession *s, const char *name, char *out, size_t size);
// Gives the names that may stand behind `path.`, a name or several with points between them, of the
// interactive session.
CAG_API void cag_session_members(CagSession *s, const char *path,
                                 void (*give)(void *context, const char *name), void *context);
// Writes the interactive session as a script: imports, definitions as they are now, asserts, shows.
CAG_API void cag_session_write_script(CagSession *s, FILE *out);
CAG_API void cag_session_clear(CagSession *s);
// Module i of the standard library, as import writes it ("std.robots"); NULL behind the last.
CAG_API const char *cag_library_module(size_t i);
// Names of all built-ins, NULL at the end.
CAG_API const char *const *cag_builtin_name_list(void);
// Documentation of a built-in name as text to `out`; false: no such name.
CAG_API bool cag_write_builtin_doc(const char *name, FILE *out);
// Row i of the built-ins' table (rows of one name one after the other), for tests of the examples;
// false behind the last.
CAG_API bool cag_builtin_row(size_t i, const char **signature, const char **summary,
                             const char **example, const char **family);

// --- Documentation ---
// Documentation of a built-in ("bspline"), a library module ("std.robots", "robots"), its member
// ("robots.puma560"), a chapter of the manual ("geometry") or an error code as text; NULL: an
// overview. `styled` makes headings bold for a terminal. False: there is no such name.
CAG_API bool cag_session_document(CagSession *s, const char *name, bool styled, FILE *out);
// The names that the call above knows.
CAG_API void cag_session_document_names(CagSession *s,
                                        void (*give)(void *context, const char *name),
                                        void *context);
// What the `///` lines of a script say of its definitions and params.
CAG_API int cag_session_document_text(CagSession *s, const char *name, const char *text,
                                      size_t length, bool styled, FILE *out);
typedef struct CagSiteOptions {
  CagSessionOptions session; // limits of the examples, the interrupt flag
  bool no_pictures;
  size_t jobs;                // examples run at once; 0: one for each processor
  const char *const *scripts; // files that the site tells of as well, beside the library
  size_t script_count;
  void (*say)(void *context, const char *message); // remarks; may be NULL
  void *context;
} CagSiteOptions;
// Writes all documentation as a site of static pages into a folder, which is made. Pictures that
// are there already are kept. Fails where an example does not do what it says.
CAG_API int cag_session_write_site(CagSession *s, const char *folder,
                                   const CagSiteOptions *options);

// --- Error codes ---
// Explanation of a code at length to `out`; false: no such code.
CAG_API bool cag_explain(const char *code, FILE *out);
// Code and title of kind of error i; false behind the last.
CAG_API bool cag_error_kind(size_t i, const char **code, const char **reason, const char **title,
                            const char **example);

#ifdef __cplusplus
}
#endif

#endif
