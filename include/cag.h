// libcag: runs scripts of the cag language and turns them into meshes, scenes, and pictures.
//
//     CagSession *s = cag_session_new(NULL);
//     if (!s) return CAG_STATUS_LIMIT;
//     int status = cag_session_run_file(s, "vase.cag");
//     if (status == CAG_STATUS_OK) status = cag_session_export(s, "vase.stl", NULL);
//     cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr);
//     cag_session_free(s);
//     return status;
//
// A session runs one script at a time and keeps what the script showed until the next run. The
// program `cag` uses the same calls.
//
// Threads: a session may be used by one thread at a time. Different sessions are independent of
// each other, so each thread can have its own. A session evaluates scripts on a thread of its own,
// which has a large stack for deep recursion; the call returns when that thread is done. Callbacks
// can be called on that thread while the caller waits.
//
// Callbacks: a callback must not start work on its session. Calls that evaluate, check, format,
// export, render, document, or clear are refused: they return CAG_STATUS_USAGE, false, or NULL and
// add no diagnostic, or do nothing if they return nothing. Calls that only query diagnostics and
// names are allowed. cag_session_free takes effect when the call that is under way returns.
//
// Memory: texts that a call returns, or that it passes to a callback, belong to the library. Those
// about a session stay valid until the next call that evaluates, checks, formats, builds the scene,
// exports, renders, documents, or clears; those passed to a callback until it returns. The only
// memory that the host must free is the text made by cag_session_format, with free().
//
// An index beyond the end is not an error: the result is NULL, false, or a view full of NULLs.
// Unless stated otherwise, pointers must not be NULL.

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

// The statuses that calls return. They are the exit statuses of the program `cag`.
enum {
  CAG_STATUS_OK = 0,
  CAG_STATUS_SCRIPT = 1,   // the script has an error, or shows nothing that the output can contain
  CAG_STATUS_USAGE = 2,    // wrong arguments (unknown format or camera), or a refused call
  CAG_STATUS_FILE = 3,     // a file could not be read or written
  CAG_STATUS_RENDERER = 4, // POV-Ray is missing or failed
  CAG_STATUS_LIMIT = 5,    // a limit was exceeded, or memory ran out
  CAG_STATUS_INTERRUPTED = 130
};

// Diagnostics as text, as text with terminal colors, or as one JSON object per line.
typedef enum CagStyle { CAG_STYLE_TEXT, CAG_STYLE_COLOR, CAG_STYLE_JSON } CagStyle;

typedef struct CagSession CagSession;

// Defaults are in parentheses.
typedef struct CagSessionOptions {
  double tolerance;     // mm, largest distance between mesh and surface; 0: a quarter of a pixel in
                        // pictures, otherwise the default tolerance
  size_t max_memory;    // memory limit of a run, in bytes, including its values (4 GiB)
  size_t max_depth;     // nested calls in a script (10,000)
  size_t max_triangles; // of all meshes together (100 million)
  double max_time;      // seconds for a run and all output of its scene; 0: no limit
  const char *const *module_path; // folders that are searched for modules (-I)
  size_t module_path_count;
  // How POV-Ray source has set operations of solids: "native", "mesh", or "auto" (NULL). Auto uses
  // meshes in pictures; in .pov files it uses native objects where no faces of operands coincide.
  const char *pov_csg;
  // A script can read files and modules below its own folder, and below those of module_path. For a
  // script run from text, this is its folder (NULL: the working folder).
  const char *folder;
  // Returns the text that replaces a file that the script imports, given its real path, or NULL:
  // the file counts. For editors with unsaved texts. The text must stay the same during a run. May
  // be NULL.
  const char *(*find_text)(void *context, const char *path, size_t *length);
  void *find_text_context;
  FILE *out;      // where `print` writes (stdout)
  FILE *messages; // where `trace` writes (stderr)
  // Work stops soon after this integer becomes nonzero, for example in a signal handler. The
  // library never changes it. NULL: nothing interrupts.
  const volatile int *interrupt;
  // Called at most once per call, on another thread, if work continues well after max_time because
  // it is in a step that cannot be stopped. The program may then want to end: it can call
  // cag_session_write_overdue and _exit. Not called during interactive use. May be NULL.
  void (*overdue)(CagSession *s, void *context);
  void *overdue_context;
  bool verbose; // `messages` also receives how results were found, such as the method of a fillet
} CagSessionOptions;

CAG_API const char *cag_version(void);
CAG_API void cag_session_options_init(CagSessionOptions *options);
// Makes a session (options NULL: the defaults). Returns NULL if memory ran out. The options are
// copied, but what they point to must outlive the session.
CAG_API CagSession *cag_session_new(const CagSessionOptions *options);
// Frees a session; NULL is allowed.
CAG_API void cag_session_free(CagSession *s);

// Sets a param in later runs, like -D. The value is the text of an expression; for a param that is
// a text, the quotes are optional. The last value of a name counts. Errors appear when a script
// runs: if it has no such param, if the value is wrong, or if memory ran out here.
CAG_API void cag_session_define(CagSession *s, const char *name, const char *value);
CAG_API void cag_session_clear_defines(CagSession *s);
// Sets `frame` and `frames` in later runs (0 and 1); frames must be at least 1. `time` is then
// frame/(frames - 1), or 0 if there is one frame.
CAG_API void cag_session_set_frame(CagSession *s, double frame, double frames);
// Makes `time` frame/frames instead, for films that repeat (false).
CAG_API void cag_session_set_loop(CagSession *s, bool loop);

// Runs a script, after dropping the previous run or the interactive definitions. The path "-" is
// standard input; `name` stands for the text in diagnostics. What the script showed before an error
// remains shown.
CAG_API int cag_session_run_file(CagSession *s, const char *path);
CAG_API int cag_session_run_text(CagSession *s, const char *name, const char *text, size_t length);

// Returns the absolute path of file i that the last run read: the script, imported modules, data,
// meshes, and images. Files that were looked for and are missing are listed as well, so that a
// program can run the script again when one of them changes. NULL after the last one.
CAG_API const char *cag_session_read_file(const CagSession *s, size_t i);

// The following three drop the previous run or the interactive definitions as well.

// Formats a script without running it or reading other files. *out receives a zero-terminated text
// of *out_length bytes; release it with free(). It is NULL if the status is not CAG_STATUS_OK.
CAG_API int cag_session_format(CagSession *s, const char *name, const char *text, size_t length,
                               char **out, size_t *out_length);

// Checks a script without running it. Reports errors of syntax, names, arity, and types, and, as
// warnings, unused definitions. Reads imported modules. The path "-" is standard input.
CAG_API int cag_session_check_file(CagSession *s, const char *path);
CAG_API int cag_session_check_text(CagSession *s, const char *name, const char *text,
                                   size_t length);

// --- Diagnostics ---
// A run, check, format, document, or interactive call starts a new list of errors and warnings.
// Calls that use the scene of a run keep the diagnostics of the run and of building the scene, and
// replace those of the previous such call. A list has at most 20 diagnostics.
CAG_API size_t cag_session_error_count(const CagSession *s); // errors and warnings
typedef struct CagErrorView {
  const char *code;                          // "E0201"; see cag_explain
  const char *reason;                        // short name of the kind of error
  const char *message, *help;                // help: how to fix it; may be NULL
  const char *file;                          // NULL: the error has no location
  size_t line, column, end_line, end_column; // from 1
  bool warning;
} CagErrorView;
CAG_API void cag_session_error(const CagSession *s, size_t i, CagErrorView *out);
// A further location of a diagnostic.
typedef struct CagNoteView {
  const char *text; // "first defined here"
  bool is_call;     // the place called what failed; the text is the name of its function, or ""
  const char *file; // NULL: it has no location
  size_t line, column, end_line, end_column; // from 1
} CagNoteView;
// Returns note k of diagnostic i. Returns false if there is none.
CAG_API bool cag_session_error_note(const CagSession *s, size_t i, size_t k, CagNoteView *out);
CAG_API void cag_session_write_diagnostics(const CagSession *s, CagStyle style, FILE *out);
// Writes the error of a run that exceeded max_time, for the callback `overdue`. Can be called on
// any thread at any time.
CAG_API void cag_session_write_overdue(const CagSession *s, CagStyle style, FILE *out);

// --- What was shown ---
// Cuts the scene by a plane in later calls: removes the points with a x + b y + c z > d, where
// `plane` is {a, b, c, d}, and closes the cut of solids. Drawings (.svg) get the outlines of the
// cut instead. NULL: no section (the default). Returns false if a, b, and c are 0, if a number is
// not finite, or if the call is refused.
CAG_API bool cag_session_set_section(CagSession *s, const double plane[4]);
typedef struct CagShownCounts {
  size_t items, cameras, lights;
} CagShownCounts;
// Builds the scene of what was shown, unless it was built since the run. Export and render do so as
// well. A camera, lights, and a floor are added if the script shows none, and counted.
CAG_API int cag_session_scene(CagSession *s, CagShownCounts *out);
// Shows only a definition of the script in later calls, as if the script showed nothing else; its
// value must be something that can be shown. NULL: what the script shows (the default). Returns
// false if memory ran out, or if the call is refused.
CAG_API bool cag_session_show_only(CagSession *s, const char *name);
// Calls `give` with the printed value and the type of a definition of the script that was run, and
// whether it can be shown.
CAG_API int cag_session_definition(CagSession *s, const char *name,
                                   void (*give)(void *context, const char *text, const char *type,
                                                bool shown),
                                   void *context);

// The measures of a part, in mm, mm2, and mm3. Numbers that do not apply to the part are NaN.
typedef struct CagMeasures {
  const char *name, *type, *kind; // "vase"; "solid", "mesh", "surface", "region", or "curve";
                                  // how it was made: "sphere", "revolution"
  bool empty;                     // nothing is left of it; it has no bounds
  double min[3], max[3];          // bounds
  double length;                  // of a curve; of a region, that of its boundary
  double area;                    // of a solid or closed mesh, that of its boundary
  double volume;                  // of solids, closed surfaces, and closed meshes
  double centroid[3];             // of the volume if there is one, else of the area
  bool closed;      // a curve ends where it starts; each edge of the mesh has two triangles
  bool exact;       // from formulas or integrals, not from a mesh within the tolerance
  bool has_faces;   // the number of faces is known; it is not for set operations
  size_t faces;     // a mesh has those of its triangles
  size_t triangles; // of the mesh within the tolerance
} CagMeasures;
// Measures what is shown, and calls `give` with each part, of which groups have several. The names
// are those in exported files.
CAG_API int cag_session_measure(CagSession *s, void (*give)(void *context, const CagMeasures *part),
                                void *context);
// Looks for parts of what is shown that share volume: solids, closed meshes, and closed surfaces; a
// group that has a name and contains no other names is one part. Adds an error for each pair, with
// the names of the parts and the volume. Returns CAG_STATUS_SCRIPT if there are any.
CAG_API int cag_session_interference(CagSession *s);
// Writes a line for each shown item, such as "vase: revolution surface, ...", to `out`.
CAG_API void cag_session_describe_scene(CagSession *s, FILE *out);
// Returns the name of camera i of the scene, or NULL.
CAG_API const char *cag_session_camera(CagSession *s, size_t i);
// Returns name i of the cameras that every scene has for rendering ("top", "iso"), or NULL.
CAG_API const char *cag_standard_camera(size_t i);

// Writes the scene to a file, under a temporary name that is renamed at the end. `format` is one of
// "obj", "stl", "ply", "glb", "gltf", "3mf", "pov", "igs", "step", "urdf", "svg", "json", and, for
// an image that is shown, "exr" and "png"; NULL: that of the path's extension. The path "-" is
// standard output and needs a format. Three formats write files next to the path: obj its
// materials, gltf its data, and urdf its meshes.
CAG_API int cag_session_export(CagSession *s, const char *path, const char *format);
// Returns the name of image i that is shown, or NULL.
CAG_API const char *cag_session_image(CagSession *s, size_t i);
// Zeros are the defaults.
typedef struct CagImageOptions {
  const char *image; // the name of one of the images; NULL: the only one
  double low, high;  // of .png: the numbers that become black and white; both 0: 0 and 1
  int bits;          // of .png: 8 or 16 per channel; 0: 8
} CagImageOptions;
CAG_API void cag_image_options_init(CagImageOptions *o);
// Writes an image that the script shows to an .exr file, all channels as 32-bit floats, or to a
// .png file (options NULL: the defaults). Other formats are those of cag_session_export, which also
// accepts these two.
CAG_API int cag_session_export_image(CagSession *s, const char *path, const char *format,
                                     const CagImageOptions *options);
// Returns the formats, ending with NULL.
CAG_API const char *const *cag_export_formats(void);
// Returns a short description of a format, or NULL if there is no such format.
CAG_API const char *cag_export_format_story(const char *format);

// The default tolerance of meshes, in mm: a thousandth of the size of all that is shown, except
// grounds, rounded down to a power of two. Small shapes have a smaller one, so that they keep their
// form. cag_session_default_tolerance returns 0 without a scene. After
// cag_session_set_default_tolerance, later calls use the given tolerance (0: the usual one again):
// give all frames of a film the tolerance of the first frame. It returns false if it is refused.
CAG_API double cag_session_default_tolerance(CagSession *s);
CAG_API bool cag_session_set_default_tolerance(CagSession *s, double tolerance);
typedef struct CagToleranceView {
  const char *source; // what determined it: "shape", "option", "pixels", or "size"
  double least, most; // mm
} CagToleranceView;
// Returns range i of the tolerances of meshes that the last export or picture needed. Returns false
// after the last range.
CAG_API bool cag_session_tolerance(const CagSession *s, size_t i, CagToleranceView *out);

// A part of a picture: pixels from its left and top edge. A width of 0 means the whole picture.
typedef struct CagRenderRegion {
  int x, y, width, height;
} CagRenderRegion;

// Zeros are the defaults.
typedef struct CagRenderOptions {
  int width, height;   // pixels, both or none; 0: the camera's
  const char *quality; // "draft", "normal", or "final"; NULL: normal
  // "povray"; "preview", the built-in renderer; or NULL: preview for drafts and where POV-Ray is
  // not found, and else povray.
  const char *engine;
  int samples; // per pixel: of light for preview, of the lens for povray; 0: by the quality
  // preview: "color,depth,normal,object,material,uv,curvature", or some of these, in one .exr of
  // several layers; NULL: the color alone
  const char *passes;
  bool keep_partial;  // preview: write what is complete if the work is stopped
  const char *camera; // a name, or top, bottom, front, back, left, right, or iso; NULL: the first
  const struct CagCameraView *view; // a camera of the host's own, in place of `camera`; NULL: none
  double exposure;                  // stops; only for .png
  int threads;                      // of the renderer; 0: one per processor
  double time_limit; // seconds for the renderer, in place of max_time; 0: what is left of max_time
  CagRenderRegion region; // renders and writes only this part
  // Called during rendering, with the percentage of a phase ("parsing", "photons", "radiosity", or
  // "rendering"). May be NULL.
  void (*progress)(void *context, double percent, const char *phase);
  void *progress_context;
} CagRenderOptions;
CAG_API void cag_render_options_init(CagRenderOptions *o);
// Renders what was shown and writes an .exr or .png file (options NULL: the defaults).
CAG_API int cag_session_render(CagSession *s, const CagRenderOptions *options, const char *path);
// Looks for POV-Ray. If it is found, writes its version to `buffer`, of `size` bytes, and returns
// the buffer. Otherwise writes the reason to the buffer and returns NULL.
CAG_API const char *cag_find_povray(char *buffer, size_t size);

// --- What a page shows ---
// These calls describe the last run, for programs that show its scene and let its params be
// changed.

// A location in a script.
typedef struct CagPlaceView {
  const char *file;                          // NULL: none
  size_t line, column, end_line, end_column; // from 1; columns count code points
  bool library;                              // in the standard library
} CagPlaceView;

typedef struct CagParamView {
  const char *name, *description; // description: NULL if there is none
  const char *kind;            // "number", "angle", "choice", "bool", "color", "text", or "other"
  const char *value, *initial; // expressions, such as `140` and `"teal"`; initial: without -D
  // Of numbers and angles (in degrees) with a range; infinite if it has no end.
  bool ranged;
  double low, high;
  size_t choice_count;
  CagPlaceView place;
} CagParamView;
// Returns whether there is a param i of the main script. Params are known even if the run failed,
// unless the script has an error of syntax.
CAG_API bool cag_session_param(CagSession *s, size_t i, CagParamView *out);
// Returns the expression of choice i of a param, or NULL.
CAG_API const char *cag_session_param_choice(CagSession *s, size_t param, size_t i);
// Whether the script uses `time`, `frame`, or `frames`.
CAG_API bool cag_session_is_timed(CagSession *s);

typedef struct CagValueView {
  const char *name;
  const char *text;   // "box, 10 x 20 x 30", at most about 80 characters
  CagPlaceView place; // of the whole definition
} CagValueView;
// Gives the values of definitions at the top level of the main script and of the modules that it
// imported, except the library: of those that the run has evaluated, unless they are functions, or
// their text is the value.
CAG_API void cag_session_values(CagSession *s, void (*give)(void *context, const CagValueView *v),
                                void *context);

// Runs work(context), which may call functions of this session often: for each part of a large
// scene, say. Elsewhere, each call that uses the machine starts a thread of its own. The time limit
// holds for all of the work. `work` must not run a script, and cag_session_free takes effect after
// it.
CAG_API void cag_session_together(CagSession *s, void (*work)(void *context), void *context);

// The following need a scene, as cag_session_scene makes it.

typedef struct CagPartView {
  const char *name;       // unique in the scene
  const char *type;       // "curve", "region", "surface", "solid", "mesh", or "ground"
  const char *story;      // such as "box, 10 x 20 x 30 mm"; NULL for a ground
  size_t material;        // index for cag_session_material
  double low[3], high[3]; // bounds; low > high for a ground
  double z, size;         // of a ground; size: infinite if it has no end
} CagPartView;
CAG_API bool cag_session_part(CagSession *s, size_t i, CagPartView *out);
// Location k in the origin of a part: the `show` it came through, then calls that moved it or gave
// it attributes, the latest first, and finally the call that made it. For calls in the library, the
// location in the user's script comes once before them. *what receives "show", "changed", or
// "made".
CAG_API bool cag_session_part_place(CagSession *s, size_t part, size_t k, const char **what,
                                    CagPlaceView *out);
// The material of triangles with a label, of a part with several materials. Returns false after the
// last one.
CAG_API bool cag_session_part_label(CagSession *s, size_t part, size_t k, uint32_t *label,
                                    size_t *material);

typedef struct CagMeshView {
  // The identity of the mesh: equal texts, equal meshes, also of other runs.
  char id[33];
  // The rows of the map from the mesh to the scene: what only moves keeps its mesh.
  double placement[3][4];
  bool placed;   // the map is not the identity
  bool line;     // of a curve, which has edges only
  double radius; // of a line as pictures draw it
  size_t vertex_count, triangle_count, edge_count;
  const float *positions, *normals; // 3 per vertex; normals may be NULL
  const uint32_t *triangles;        // 3 per triangle
  const uint32_t *labels;           // of triangles; NULL: all 0
  const uint32_t *edges;            // 2 per feature edge, or segment of a curve
} CagMeshView;
// Makes the mesh of a part, which is valid until the next mesh of the session is made. `coarse`:
// the tolerance is so many times larger; 1: as in exports. `has`, which may be NULL, is asked
// whether the host already has the mesh with this identity: then only the identity and the
// placement are set. Not for grounds.
CAG_API int cag_session_part_mesh(CagSession *s, size_t part, double coarse,
                                  bool (*has)(void *context, const char *id), void *context,
                                  CagMeshView *out);

// A coordinate of a point as it stands in the script.
typedef struct CagPointNumber {
  bool literal;       // it is a number, which can be replaced; else nothing else is set
  CagPlaceView place; // of the number with its sign and unit
  double value;       // mm
  char unit[8];       // as written: "", "mm", "cm" ...
  double scale;       // mm per unit
} CagPointNumber;

// A point in a call that made or moved a part, or one of the shapes that the part was made of: a
// control point, vertex, or data point of a curve, surface, or region, or the vector of a
// `translate`, which is at the image of the origin.
typedef struct CagPointView {
  size_t id;        // stays the same while only numbers change
  const char *call; // the function, such as "polyline"
  int dimension;    // coordinates in the script: 2 (in a plane) or 3
  double at[3];     // in the scene
  double map[3][4]; // from the coordinates in the script, mm, to the scene
  CagPointNumber numbers[3];
  const char *locked; // why nothing of it can be moved; NULL: something can
  bool moved[3];      // by params, of each coordinate
  size_t param_count; // number of params that move it
} CagPointView;
// The most points of a part that are given.
enum { CAG_POINTS_MAX = 300 };
// Finds the points of a part. *omitted receives the number of those beyond CAG_POINTS_MAX; of more,
// points that can be moved come first. Params are tried out by evaluating the shown expression
// again, so this may take as long as a few runs without meshes; params for which there is no time
// (1 s) do not count. Fails with CAG_STATUS_USAGE if there is no such part.
CAG_API int cag_session_points(CagSession *s, size_t part, size_t *count, size_t *omitted);
// Returns point i of those that were found last, which are valid until the next run or search.
CAG_API bool cag_session_point(CagSession *s, size_t i, CagPointView *out);
// Returns the name of param k that moves point i, or NULL. It is a number or an angle with a range.
CAG_API const char *cag_session_point_param(CagSession *s, size_t i, size_t k);
// Where a point of a part is wanted, and the params that may change for it.
typedef struct CagPointGoal {
  size_t part, point; // point: its id
  double target[3];
  // Directions in which differences count very little, of any length: the line of sight of a
  // viewer, or those in which numbers of the script move the point. Zero: none.
  double ignored[2][3];
  double tolerance; // mm; 0: 1e-6
  const char *const *names;
  size_t count; // of names, 1 to 8
} CagPointGoal;
// Finds values of params with which a point comes as close as possible to a target: least squares,
// by Gauss-Newton steps with differences as derivatives, within the ranges of the params (Nocedal
// and Wright 2006, 10.3). The shown expression is evaluated for each step; after 0.5 s, the best
// values so far are taken. Values are rounded to a power of ten that moves the point by less than
// the tolerance. Calls `give` with the value of each param as an expression, such as "12.5" or
// "30deg"; `at` receives where the point is with these values.
//
// The result of the last run stays as it is. Fails with CAG_STATUS_USAGE if there is no such part
// or point, or if a name is not that of a number or an angle with a range.
CAG_API int cag_session_solve_point(CagSession *s, const CagPointGoal *goal,
                                    void (*give)(void *context, const char *name,
                                                 const char *value),
                                    void *context, double at[3]);

typedef struct CagMaterialView {
  const char *name, *texture;              // texture: "" for none
  double color[3], color2[3], emission[3]; // linear light
  double metallic, roughness, transmission, ior, coat, texture_scale;
} CagMaterialView;
CAG_API bool cag_session_material(CagSession *s, size_t i, CagMaterialView *out);

typedef struct CagCameraView {
  const char *name;
  double eye[3], target[3], up[3];
  bool orthographic, automatic; // automatic: the script shows no camera
  double fov, width;            // horizontal: degrees, and of orthographic ones mm
  int size[2];                  // pixels
} CagCameraView;
CAG_API bool cag_session_camera_view(CagSession *s, size_t i, CagCameraView *out);

typedef struct CagLightView {
  const char *kind; // "sun", "point", "spot", or "area"
  double position[3], direction[3], color[3];
  double angle, size, strength; // angle: degrees
} CagLightView;
CAG_API bool cag_session_light(CagSession *s, size_t i, CagLightView *out);

typedef struct CagLabelView {
  const char *text, *place, *mark;
  double at[3], along[3];
  double size; // mm; 0: by the size of the picture
  size_t material;
} CagLabelView;
CAG_API bool cag_session_label(CagSession *s, size_t i, CagLabelView *out);

// What is drawn for a label, as data of SVG paths with y down. The location is the origin, and the
// height of the text is 1. If the label has a direction, this is +x, and the paths are turned with
// it, except for the text of an arrow and the other marks. Text that would be upside down is turned
// by half a turn.
typedef struct CagLabelPaths {
  const char *text, *mark, *paper; // NULL: none. The paper is white, below the mark
} CagLabelPaths;
// The texts are valid until the next call on the session.
CAG_API bool cag_session_label_paths(CagSession *s, size_t i, CagLabelPaths *out);

typedef struct CagStageView {
  bool studio;  // the lights were added, because the script shows none
  bool drawing; // all parts are curves and regions of one plane z = constant
  bool has_background;
  double background[3];
  size_t sky_count;       // colors of the sky, from bottom to top
  double low[3], high[3]; // bounds of all parts, except grounds
} CagStageView;
CAG_API bool cag_session_stage(CagSession *s, CagStageView *out);
CAG_API bool cag_session_sky_color(CagSession *s, size_t i, double out[3]);

// --- Robots that a scene shows ---
// A robot that is shown (by `posed`, or by itself) can be brought to other joint values without
// another run: its parts are not made again, but get motions. Robots are found where they were
// moved, colored, or grouped. Shapes that were changed otherwise (by a set operation, for example)
// are not parts of a robot.
//
// Joint values are in the units of the script: degrees for revolute joints, millimeters for
// prismatic ones. Frames and motions have 3 rows of 4 numbers. They are in the coordinates of the
// scene, so a robot that was scaled has frames with axes that are not unit vectors.

typedef struct CagRobotView {
  const char *name; // unique among the robots of the scene
  size_t joint_count, part_count, frame_count;
} CagRobotView;
// Returns whether there is a robot i in the scene.
CAG_API bool cag_session_robot(CagSession *s, size_t i, CagRobotView *out);
// Returns the index of part k of a robot, as for cag_session_part; (size_t)-1: there is none.
// `name` receives the name of the part, or NULL; it may be NULL.
CAG_API size_t cag_session_robot_part(CagSession *s, size_t robot, size_t k, const char **name);

typedef struct CagJointView {
  char name[32];    // "joint 1"
  const char *kind; // "revolute" or "prismatic"
  const char *unit; // "deg" or "mm"
  double low, high; // limits
  double home;      // within the limits
  double value;     // as shown; may be outside of the limits (`limits: false`)
} CagJointView;
CAG_API bool cag_session_robot_joint(CagSession *s, size_t robot, size_t joint, CagJointView *out);

// Finds where the script says the value of a joint, as a number in a list that is the argument `q`
// of `posed`, or the definition or param that the argument names. The location includes a sign and
// the unit. Returns NULL, or the reason why there is no such number, for all joints of the robot
// alike.
CAG_API const char *cag_session_robot_joint_place(CagSession *s, size_t robot, size_t joint,
                                                  CagPlaceView *out);

typedef struct CagRobotPose {
  size_t part_count, frame_count;
  // By part of the robot: the motion from where it is in the scene to where it is in this pose. The
  // rods that a robot without shapes is drawn with change their lengths at prismatic joints.
  const double (*motions)[3][4];
  const double (*frames)[3][4]; // the base, then the frame after each link
  double tool[3][4];
} CagRobotPose;
// Forward kinematics: moves the parts of a robot to joint values, which may be outside of the
// limits. `out` is valid until the next call about robots. Fails with "joint-count" (`count` is not
// the number of joints), "not-finite".
CAG_API int cag_session_robot_pose(CagSession *s, size_t robot, const double *q, size_t count,
                                   CagRobotPose *out);

// What becomes of the orientation of the tool.
typedef enum CagReach {
  CAG_REACH_KEEP,  // it is reached if the robot can; fewer than 6 joints may give it up
  CAG_REACH_EXACT, // it is reached, or else the closest pose is found
  CAG_REACH_FREE   // only the position matters
} CagReach;

typedef struct CagReachView {
  const double *q; // within the limits
  size_t joint_count;
  bool reached;
  double distance; // mm, from the target to the tool
  double angle;    // degrees, between the target's orientation and that of the tool
} CagReachView;
// Inverse kinematics: joint values that bring the tool to a target, near the joint values `near`.
// If the target can be reached without a jump from there, they are found by damped least squares
// from `near`. Otherwise, they are found as by `ik`. If the target is out of reach, they are those
// of the closest pose; among poses that are equally close to within a few percent, the nearest to
// `near` is chosen, so that a target that moves steadily gives a steady motion. `target` is a frame
// like those of CagRobotPose: of a robot that was scaled, its axes are as long as those of the
// tool. `out` is valid until the next call about robots. Fails with "joint-count", "not-finite",
// "not-rigid" (the axes of the target are dependent, or the robot was flattened by its placement).
CAG_API int cag_session_robot_reach(CagSession *s, size_t robot, const double target[3][4],
                                    CagReach orientation, const double *near, size_t count,
                                    CagReachView *out);

// --- Interactive use ---
// Definitions remain until the next run, check, format, document, or clear call. A name can be
// defined again; everything that depends on it is then updated.

// Evaluates definitions, statements, and expressions. Calls `value` (may be NULL) with the printed
// value and the type of each expression.
CAG_API int cag_session_input(CagSession *s, const char *text, size_t length,
                              void (*value)(void *context, const char *text, const char *type),
                              void *context);
// Runs a script file so that its definitions remain.
CAG_API int cag_session_input_file(CagSession *s, const char *path);
// Removes from the scene what was shown by exactly this text, usually the name of a definition.
// Returns how many times it was shown.
CAG_API size_t cag_session_hide(CagSession *s, const char *text);
// Returns whether the text needs another line to be complete.
CAG_API bool cag_input_is_incomplete(const char *text, size_t length);
// Returns name i of the interactive session, each name once, in the order of first definition, or
// NULL. *source_text receives its latest definition, which is not zero-terminated, or NULL if it
// was imported. Both outputs may be NULL.
CAG_API const char *cag_session_name(CagSession *s, size_t i, const char **source_text,
                                     size_t *source_length);
// Writes the definition and documentation of a name of the interactive session. Returns false if
// there is no such name.
CAG_API bool cag_session_write_doc(CagSession *s, const char *name, FILE *out);
// Writes the full name of something imported from the library to `out`, of `size` bytes: after
// `import std.materials as mat`, "mat.glazed" is "std.materials.glazed". Returns false if the name
// was not imported from the library.
CAG_API bool cag_session_library_name(CagSession *s, const char *name, char *out, size_t size);
// Calls `give` with each member of what `path` names in the interactive session, such as "mat" or
// "arm.links".
CAG_API void cag_session_members(CagSession *s, const char *path,
                                 void (*give)(void *context, const char *name), void *context);
// Writes the interactive session as a script: imports, current definitions, asserts, and shows.
CAG_API void cag_session_write_script(CagSession *s, FILE *out);
// Drops the previous run or the interactive definitions. Values set by cag_session_define remain.
CAG_API void cag_session_clear(CagSession *s);
// Returns module i of the standard library as import names it ("std.robots"), or NULL.
CAG_API const char *cag_library_module(size_t i);
// Returns the text of a module of the standard library, or NULL if there is no such module.
CAG_API const char *cag_library_text(const char *module, size_t *length);
// Returns the names of all built-ins, ending with NULL.
CAG_API const char *const *cag_builtin_name_list(void);
// Writes the documentation of a built-in as text. Returns false if there is no such built-in.
CAG_API bool cag_write_builtin_doc(const char *name, FILE *out);
// Returns row i of the table of built-ins; rows with the same name are adjacent. The outputs may be
// NULL, and summary and example may receive NULL. Returns false if there is no such row.
CAG_API bool cag_builtin_row(size_t i, const char **signature, const char **summary,
                             const char **example, const char **family);

// --- Documentation ---
// These calls may drop the previous run or the interactive definitions: use a session of its own.

// Writes documentation as text: of a built-in ("bspline"), a module of the library ("std.robots" or
// "robots"), a member of one ("robots.puma560"), a chapter of the manual ("geometry"), a word of
// the language, or an error code; NULL: an overview. `styled` makes headings bold on a terminal.
// Returns false if the name is unknown or memory ran out.
CAG_API bool cag_session_document(CagSession *s, const char *name, bool styled, FILE *out);
// Returns script i of the cookbook: its name ("01-turned-vase.cag") and its text, whose first line
// is its title as a comment. Returns false after the last one.
CAG_API bool cag_cookbook(size_t i, const char **name, const char **text);
// Calls `give` with each name that cag_session_document knows.
CAG_API void cag_session_document_names(CagSession *s,
                                        void (*give)(void *context, const char *name),
                                        void *context);
// Writes the documentation in the `///` comments of a script.
CAG_API int cag_session_document_text(CagSession *s, const char *name, const char *text,
                                      size_t length, bool styled, FILE *out);
typedef struct CagSiteOptions {
  CagSessionOptions session; // for the examples; use cag_session_options_init
  bool no_pictures;
  size_t jobs;                // examples that run at once; 0: one per processor
  const char *const *scripts; // files to document in addition to the library
  size_t script_count;
  // Examples get links that open them in the playground at this address, which is relative to the
  // site or absolute ("../playground/"). NULL: no links.
  const char *playground;
  void (*say)(void *context, const char *message); // remarks about progress; may be NULL
  void *context;
} CagSiteOptions;
// Writes all documentation as a site of static pages into a folder, which is created. Pictures that
// exist are kept. Fails if an example does not print the expected output.
CAG_API int cag_session_write_site(CagSession *s, const char *folder,
                                   const CagSiteOptions *options);

// --- What a page asks about parts ---
// These calls need a scene, too. They work on the shapes that the run made, and evaluate nothing.
// What they return is valid until the next of them, or until the next mesh of the session is made.

// The sources of the faces of a set operation: the origins of its operands, and of theirs. Operands
// that were made by the same calls, such as those of a loop, are one source. Returns the name of
// the definition that source i of a part was first the value of, "" if there is none, or NULL after
// the last source. Parts that are not set operations have none.
CAG_API const char *cag_session_part_source(CagSession *s, size_t part, size_t i);
// Location k in the origin of a source, as for cag_session_part_place, but without the `show`:
// first the calls that the set operations around it went through, which *what calls "combined", and
// then its own.
CAG_API bool cag_session_source_place(CagSession *s, size_t part, size_t i, size_t k,
                                      const char **what, CagPlaceView *out);

typedef struct CagFacesView {
  char id[33];              // of the mesh that the triangles belong to
  size_t triangle_count;    // of the mesh
  const uint32_t *operands; // of each triangle: the number of the operand that it is a part of
  size_t operand_count;
  const uint32_t *sources; // of each operand
} CagFacesView;
// Finds which operand each triangle of the mesh of a part comes from. Fails if the part is not a
// set operation of solids.
CAG_API int cag_session_part_faces(CagSession *s, size_t part, CagFacesView *out);

// A shape that is not shown itself, where it stands in the scene.
typedef struct CagGhostView {
  const char *part;   // the name of the part that was made of it; NULL: none
  const char *type;   // as of a part
  CagPlaceView place; // of the call that made it
  // What the script does to it next: "translate", "rotate", "transform" (any other map), "revolve",
  // or NULL.
  const char *motion;
  double point[3], direction[3]; // the axis, or the vector of a translation
  double angle;                  // of a rotation, in degrees
  double frame[3][4];            // of "transform": the image of the axes
} CagGhostView;
// Gives the shapes that are the value of the smallest expression at a location of the script: none
// if that is shown itself. `column` counts code points. Shapes of a loop are given several times,
// at most 64. `has` is as for cag_session_part_mesh.
CAG_API int cag_session_ghosts(CagSession *s, const char *file, size_t line, size_t column,
                               bool (*has)(void *context, const char *id),
                               void (*give)(void *context, const CagGhostView *ghost,
                                            const CagMeshView *mesh),
                               void *context);

// Numbers and lines of the exact surface of a part, in the coordinates of the scene.
typedef struct CagSurfaceView {
  char id[33];           // of the mesh that the values belong to; "" if there are none
  size_t triangle_count; // of this mesh
  // Curvature: the mean and the Gaussian curvature (1/mm, 1/mm2) at the corners of the triangles, 3
  // per triangle, relative to the outward or front side: positive where a ball's are. NaN: unknown.
  const float *mean, *gaussian;
  const float *distance; // per triangle, of its farthest point from the surface, mm. NaN: unknown
  double farthest;       // the largest of them
  size_t point_count, line_count;
  const float *points;        // of all lines, 3 numbers each
  const uint32_t *line_sizes; // points of each line
} CagSurfaceView;
// `what` is "curvature", "deviation", "isolines", or "net" (the control points of a spline). Fails,
// with the reason, if the part has no such thing: a mesh has no exact surface.
CAG_API int cag_session_part_surface(CagSession *s, size_t part, const char *what,
                                     CagSurfaceView *out);

// A curve in which a plane cuts a part.
typedef struct CagSectionCurve {
  const char *part;
  bool closed, exact; // exact: not of a mesh
  double length;
  double area; // within a closed curve, negative for the outline of a hole; NaN for an open curve
  size_t point_count;
  const float *points; // a polyline within the tolerance of the part, 3 numbers each
} CagSectionCurve;
// Gives the curves in which the plane a x + b y + c z = d, {a, b, c, d}, cuts the parts. Lines and
// conics are exact; other curves are within a millionth of the size of the part.
CAG_API int cag_session_section_curves(CagSession *s, const double plane[4],
                                       void (*give)(void *context, const CagSectionCurve *c),
                                       void *context);
// The bytes that the last run and its scene have in use.
CAG_API size_t cag_session_memory(const CagSession *s);
// The pixels of image i that the script shows. Returns false if there is none.
CAG_API bool cag_session_image_size(CagSession *s, size_t i, size_t *width, size_t *height);

// --- Documents ---
// A workspace holds the texts that are being edited, for editors and language servers. A document
// is a script, open or in a file, or a module of the library. All questions are answered from the
// text; no script is run. Definitions that are constant (literals and calls of fast built-ins) are
// evaluated, as by cag_session_check_text.
//
// A document is named by its path, which should be absolute ("/home/me/vase.cag"), by the name of a
// module of the library ("std.robots"), or by another name without `/` if it is in no file
// ("untitled-1"). An open document replaces its file, also for documents that import it. Files are
// read when they are needed.
//
// Locations in a text are offsets in bytes. Answers are given to a callback, whose texts are valid
// until it returns. The callback must not change the workspace. A question about a document that
// is neither open nor readable has no answers. A workspace may be used by one thread at a time.

typedef struct CagWorkspace CagWorkspace;

// Makes an empty workspace. Of the options, those for modules, memory, time, depth, and
// interruption are used, for each check or question. Returns NULL if memory ran out.
CAG_API CagWorkspace *cag_workspace_new(const CagSessionOptions *options);
CAG_API void cag_workspace_free(CagWorkspace *w);
// Opens a document, or replaces its text. Returns false if memory ran out.
CAG_API bool cag_workspace_open(CagWorkspace *w, const char *file, const char *text, size_t length);
// Replaces the bytes [start, end) of an open document. Returns false, without a change, if there is
// no such document or range, or memory ran out.
CAG_API bool cag_workspace_change(CagWorkspace *w, const char *file, size_t start, size_t end,
                                  const char *text, size_t length);
// Closes a document. From then on, its file counts.
CAG_API void cag_workspace_close(CagWorkspace *w, const char *file);
// Adds a file to those that references, renaming, symbols, and imports consider, in addition to the
// open documents, or removes it.
CAG_API void cag_workspace_add_file(CagWorkspace *w, const char *file);
CAG_API void cag_workspace_remove_file(CagWorkspace *w, const char *file);
// Tells that a file has changed on disk. Documents that import it are then read again.
CAG_API void cag_workspace_file_changed(CagWorkspace *w, const char *file);
// Returns whether the answers for an open document may have changed since its last
// cag_document_check.
CAG_API bool cag_document_is_stale(CagWorkspace *w, const char *file);
// Returns the text of a document, which is zero-terminated and valid until the workspace is next
// used, or NULL.
CAG_API const char *cag_document_text(CagWorkspace *w, const char *file, size_t *length);

// How columns are counted.
typedef enum CagColumns { CAG_COLUMNS_UTF8, CAG_COLUMNS_UTF16, CAG_COLUMNS_UTF32 } CagColumns;
// Converts an offset to a line and column, both from 0. Offsets beyond the end become the end.
CAG_API void cag_document_position(CagWorkspace *w, const char *file, size_t offset,
                                   CagColumns columns, size_t *line, size_t *column);
// Converts a line and column to an offset. Positions beyond the end of a line become its end.
CAG_API size_t cag_document_offset(CagWorkspace *w, const char *file, size_t line, size_t column,
                                   CagColumns columns);

// The bytes [start, end) of a document.
typedef struct CagPlace {
  const char *file;
  size_t start, end;
} CagPlace;
// Replaces a part of a document by a zero-terminated text.
typedef struct CagEdit {
  CagPlace place;
  const char *text;
} CagEdit;
typedef void CagGivePlace(void *context, const CagPlace *place);
typedef void CagGiveEdit(void *context, const CagEdit *edit);

// What a name stands for.
typedef enum CagNameKind {
  CAG_NAME_VALUE,     // a definition of the module
  CAG_NAME_FUNCTION,  // a definition with parameters, or of a function
  CAG_NAME_PARAM,     // a param
  CAG_NAME_MODULE,    // an imported module
  CAG_NAME_PARAMETER, // of a function
  CAG_NAME_LOCAL,     // a definition in a block, or a name of a comprehension
  CAG_NAME_FIELD,     // of a record or another value
  CAG_NAME_BUILTIN,   // a built-in function
  CAG_NAME_CONSTANT,  // a built-in constant
  CAG_NAME_WORD,      // a reserved word
  CAG_NAME_FILE,      // a file or folder
  CAG_NAME_CHOICE,    // a text that a parameter accepts
  CAG_NAME_SNIPPET,   // a statement or form with gaps
  CAG_NAME_UNKNOWN
} CagNameKind;

// An error or a warning. `code` and `reason` are as in CagErrorView.
typedef struct CagProblem {
  CagPlace place; // file NULL: it has no location
  const char *code, *reason, *message, *help;
  bool warning, unused, deprecated;
  size_t note_count;
  const struct CagProblemNote {
    CagPlace place; // file NULL: it has no location
    const char *text;
  } * notes;
} CagProblem;
// Checks a document, and gives all problems of it and of the files that it imports. There may be
// more than 20. Returns a status; CAG_STATUS_INTERRUPTED and CAG_STATUS_LIMIT mean that the check
// is incomplete.
CAG_API int cag_document_check(CagWorkspace *w, const char *file,
                               void (*give)(void *context, const CagProblem *p), void *context);

typedef struct CagSymbolView {
  const char *name;
  const char *detail; // "(height, width = 2)", or "" if there is none
  CagNameKind kind;
  CagPlace whole, place; // of the statement, and of the name
  size_t depth; // 0 at the top level; definitions in blocks and fields of records are below
} CagSymbolView;
typedef void CagGiveSymbol(void *context, const CagSymbolView *s);
// Gives the definitions of a document, in order.
CAG_API void cag_document_symbols(CagWorkspace *w, const char *file, CagGiveSymbol *give,
                                  void *context);
// Gives the top-level definitions of all documents whose name contains the letters of `query` in
// order, ignoring case.
CAG_API void cag_workspace_symbols(CagWorkspace *w, const char *query, CagGiveSymbol *give,
                                   void *context);

typedef struct CagCompletion {
  const char *label, *detail; // detail: a signature or type; may be NULL
  const char *documentation;  // Markdown; NULL: none
  CagNameKind kind;
  CagPlace place;   // what is replaced
  const char *text; // what is inserted
  bool is_snippet;  // `text` has gaps, as in ${1:radius} and $0
  int rank;         // 0: the most likely ones
  bool deprecated;
  const CagEdit *import; // an import that the name needs; NULL: none
} CagCompletion;
// Gives what can be written at an offset, given the text before it: names in scope, members,
// arguments, modules, files, and texts that a parameter accepts.
CAG_API void cag_document_complete(CagWorkspace *w, const char *file, size_t offset,
                                   void (*give)(void *context, const CagCompletion *c),
                                   void *context);

// Calls `give` with a description in Markdown of what is at an offset, and its place. Returns false
// if there is nothing to describe.
CAG_API bool cag_document_hover(CagWorkspace *w, const char *file, size_t offset,
                                void (*give)(void *context, const CagPlace *place,
                                             const char *markdown),
                                void *context);

typedef struct CagSignatureView {
  const char *label, *documentation; // documentation: Markdown; NULL: none
  size_t parameter_count;
  const struct CagSignatureParameter {
    size_t start, end;         // in the label
    const char *documentation; // NULL: none
  } * parameters;
  size_t active;  // the parameter that is being written; parameter_count: none
  bool is_chosen; // of several signatures, the one that the arguments fit
} CagSignatureView;
// Gives the signatures of the function whose arguments enclose an offset.
CAG_API void cag_document_signatures(CagWorkspace *w, const char *file, size_t offset,
                                     void (*give)(void *context, const CagSignatureView *s),
                                     void *context);

// Gives the place of the definition of the name at an offset; of a module, its start.
CAG_API void cag_document_definition(CagWorkspace *w, const char *file, size_t offset,
                                     CagGivePlace *give, void *context);
// Gives all places of the name at an offset, in all documents, with or without its definition.
CAG_API void cag_document_references(CagWorkspace *w, const char *file, size_t offset,
                                     bool definition, CagGivePlace *give, void *context);
// Gives those in the same document.
CAG_API void cag_document_highlights(CagWorkspace *w, const char *file, size_t offset,
                                     CagGivePlace *give, void *context);
// Tests whether the name at an offset can be changed, and gives its place.
CAG_API bool cag_document_can_rename(CagWorkspace *w, const char *file, size_t offset,
                                     CagGivePlace *give, void *context);
// Gives the edits that change the name at an offset everywhere. If the change is impossible, or
// would change the meaning of a script, writes the reason to `why`, of `size` bytes, and returns
// false.
CAG_API bool cag_document_rename(CagWorkspace *w, const char *file, size_t offset, const char *name,
                                 CagGiveEdit *give, void *context, char *why, size_t size);

typedef enum CagFoldKind { CAG_FOLD_CODE, CAG_FOLD_COMMENT, CAG_FOLD_IMPORTS } CagFoldKind;
// Gives the parts of several lines that can be folded.
CAG_API void cag_document_folds(CagWorkspace *w, const char *file,
                                void (*give)(void *context, const CagPlace *place,
                                             CagFoldKind kind),
                                void *context);
// Gives the expressions and statements that enclose an offset, from the innermost to the whole.
CAG_API void cag_document_selection(CagWorkspace *w, const char *file, size_t offset,
                                    CagGivePlace *give, void *context);

// Kinds of words of a text, from general to specific.
typedef enum CagWordKind {
  CAG_WORD_KEYWORD,
  CAG_WORD_OPERATOR,
  CAG_WORD_NUMBER,
  CAG_WORD_TEXT,
  CAG_WORD_COMMENT,
  CAG_WORD_VALUE,
  CAG_WORD_FUNCTION,
  CAG_WORD_PARAMETER,
  CAG_WORD_MODULE,
  CAG_WORD_FIELD,
  CAG_WORD_KIND_COUNT
} CagWordKind;
enum {
  CAG_WORD_IS_DEFINITION = 1,
  CAG_WORD_IS_LIBRARY = 2, // built in, or of the standard library
  CAG_WORD_IS_CONSTANT = 4,
  CAG_WORD_IS_DOCUMENTATION = 8,
  CAG_WORD_IS_DEPRECATED = 16
};
// Gives the words between two offsets with their meaning, in order. None contains a line break.
CAG_API void cag_document_words(CagWorkspace *w, const char *file, size_t start, size_t end,
                                void (*give)(void *context, const CagPlace *place, CagWordKind kind,
                                             unsigned flags),
                                void *context);
// Gives the names of the parameters of positional arguments between two offsets: "height: ".
CAG_API void cag_document_hints(CagWorkspace *w, const char *file, size_t start, size_t end,
                                void (*give)(void *context, const CagPlace *place,
                                             const char *label),
                                void *context);
// Gives the imports and the files that texts name, with the document that each leads to.
CAG_API void cag_document_links(CagWorkspace *w, const char *file,
                                void (*give)(void *context, const CagPlace *place,
                                             const char *target),
                                void *context);
// Gives the texts that are colors, with sRGB components in 0..1.
CAG_API void cag_document_colors(CagWorkspace *w, const char *file,
                                 void (*give)(void *context, const CagPlace *place,
                                              const double rgb[3]),
                                 void *context);
// Writes a color (sRGB, 0..1) as a text of a script, such as "\"#0a8\"", to `out`, of `size` bytes.
CAG_API void cag_color_text(const double rgb[3], char *out, size_t size);

// Gives the edits that format the statements between two offsets (all: 0 and SIZE_MAX). Statements
// with syntax errors stay as they are; with a range of the whole text, none is changed then.
// Returns false if it cannot be formatted.
CAG_API bool cag_document_format(CagWorkspace *w, const char *file, size_t start, size_t end,
                                 CagGiveEdit *give, void *context);

typedef enum CagActionKind { CAG_ACTION_FIX, CAG_ACTION_EXTRACT, CAG_ACTION_REWRITE } CagActionKind;
typedef struct CagActionView {
  const char *title;
  CagActionKind kind;
  const char *code;  // of the problem that it fixes; NULL: none
  CagPlace problem;  // the place of that problem
  bool is_preferred; // the obvious fix
  const CagEdit *edits;
  size_t edit_count;
} CagActionView;
// Gives the changes that are useful for the part [start, end) of a document: fixes of its problems,
// and extraction of the selected expression to a definition or a param.
CAG_API void cag_document_actions(CagWorkspace *w, const char *file, size_t start, size_t end,
                                  void (*give)(void *context, const CagActionView *a),
                                  void *context);

// What can be done with a document: its first `show`, and whether it has expectations of a test.
typedef struct CagDocumentUse {
  bool shows, tests;
  CagPlace show, test; // of the first show, and of the first expectation or example
} CagDocumentUse;
CAG_API bool cag_document_use(CagWorkspace *w, const char *file, CagDocumentUse *out);

// --- Error codes ---
// Writes the long explanation of an error, given its code ("E0201") or its short name. Returns
// false if there is no such error.
CAG_API bool cag_explain(const char *code, FILE *out);
// Returns kind i of error: its code, short name, title, and an example, which may be NULL. The
// outputs may be NULL. Returns false if there is no such kind.
CAG_API bool cag_error_kind(size_t i, const char **code, const char **reason, const char **title,
                            const char **example);

#ifdef __cplusplus
}
#endif

#endif
