// The program `cag`: one function for each command, and shared functions.
//
// main.c parses the command line into a CagTool, by the tables commands.def and options.def, and
// calls the command's function with its operands. The result of a command is the exit status of the
// program (CAG_STATUS_*). Commands use include/cag.h like other clients of the library. Only those
// for pictures also use the readers and writers of interp/render.
//
// Standard output contains only results (prints, values, exported bytes); everything else goes to
// standard error. main.c flushes standard output at the end and turns a failure into exit status 3,
// so commands need not check each write.

#ifndef CAG_CLI_TOOL_H
#define CAG_CLI_TOOL_H

#include <signal.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "base/status.h"
#include "cag.h"

typedef struct CagTool CagTool;
typedef int CagToolFunction(CagTool *t, int argc, char **argv);

// A row of commands.def.
typedef struct CagToolCommand {
  const char *name, *operands, *summary, *story, *examples;
  int least, most; // numbers of operands
  CagToolFunction *run;
} CagToolCommand;

typedef struct CagToolDefine {
  const char *name, *value; // -D name=value
} CagToolDefine;

typedef enum CagToolColor {
  CAG_TOOL_COLOR_AUTO,
  CAG_TOOL_COLOR_ALWAYS,
  CAG_TOOL_COLOR_NEVER
} CagToolColor;

// Why the value of an option is invalid.
typedef struct CagToolRefusal {
  char message[256], help[256];
} CagToolRefusal;

// The parsed command line. Texts point into argv; values of missing options are NULL or 0.
struct CagTool {
  const CagToolCommand *command;
  CagSessionOptions session; // limits, tolerance, module path, and the interrupt flag
  CagToolDefine *defines;
  size_t define_count;
  CagStyle style; // of diagnostics on standard error: JSON, or text with or without color
  CagToolColor color;
  bool quiet, verbose;
  bool wants_help, wants_version;

  const char *output, *format; // -o, --format
  int width, height;           // --size
  const char *quality, *camera, *engine, *passes;
  const char *image; // --image
  bool has_range;    // --range
  double range_low, range_high;
  int bits; // --bits; 0: the default
  double exposure;
  bool has_frames, loop;        // --frames, --loop
  bool keep_partial;            // --keep-partial
  bool by_part;                 // --passes of compare
  int samples;                  // --samples; 0: depends on the quality
  bool progress;                // --progress
  long first_frame, last_frame; // --frames
  double threshold;
  const char *heatmap;
  const char *filter;     // --filter
  bool update;            // --update
  bool no_pictures;       // --no-pictures
  bool check, diff;       // --check, --diff
  size_t jobs;            // --jobs; 0: one per processor
  const char *report;     // --report
  CagRenderRegion region; // --region; a width of 0: the whole picture
  int threads;            // --threads; 0: one per processor
  const char *queue;      // --engine-queue; NULL: run on this machine
  size_t retries;         // --retries
  bool fresh;             // --fresh
  const char *tiles;      // --tiles
  const char *element;    // --element
  const char *html;       // --html
  const char *playground; // --playground
  int port;               // --port; 0: any free one
  bool no_open;           // --no-open
  bool read_only;         // --read-only
  const char *views;      // --views
  bool has_section;       // --section
  double section[4];      // as for cag_session_set_section
  bool watch;             // --watch
  bool interference;      // --interference
  bool json;              // --json

  // Receives the error of an invalid option value; NULL: it is written to standard error.
  struct CagToolRefusal *refusal;
};

CagToolFunction cag_tool_run, cag_tool_eval, cag_tool_export, cag_tool_render, cag_tool_compare,
    cag_tool_test, cag_tool_fmt, cag_tool_check, cag_tool_doc, cag_tool_explain, cag_tool_info,
    cag_tool_repl, cag_tool_batch, cag_tool_measure, cag_tool_mcp, cag_tool_view, cag_tool_lsp;

// Makes a session with the options and the -D of the command line. Returns NULL, after a message,
// if memory ran out.
CagSession *cag_tool_session(CagTool *t);

// Writes the diagnostics of the session's last call to standard error in the selected style, and
// returns `status`: `return cag_tool_finish(t, s, cag_session_run_file(s, path));`. Does not report
// interruptions, or a standard output that was closed by its reader.
int cag_tool_finish(CagTool *t, CagSession *s, int status);

// Writes `cag render: MESSAGE` and then `help` (NULL: none) to standard error, and returns
// `status`.
int cag_tool_fail(const CagTool *t, int status, const char *help, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

// Flushes standard output. If that fails, reports it (unless the reader closed it), and changes a
// status of 0 to CAG_STATUS_FILE. Called by main.c at the end.
int cag_tool_close_output(const CagTool *t, int status);
// Tests whether standard output is a pipe that its reader has closed.
bool cag_tool_output_is_unread(void);

// Sets the option `--name` in `t`, as the command line does. Returns false, with the reason in
// `why`, if the value is invalid.
bool cag_tool_try(CagTool *t, const char *name, const char *value, CagToolRefusal *why);

// Writes a remark to standard error, unless -q or JSON diagnostics are selected.
void cag_tool_say(const CagTool *t, const char *format, ...) __attribute__((format(printf, 2, 3)));

// Writes which tolerances the meshes of the last export or picture had, as such a remark.
void cag_tool_say_tolerances(const CagTool *t, const CagSession *s);

// Checks that the output can be written, before a long calculation. Returns 0, or a status after a
// message.
int cag_tool_check_output(const CagTool *t, const char *path);
// The same, but creates missing folders. If that fails, the error is reported when the file is
// opened.
int cag_tool_check_place(const CagTool *t, const char *path);
bool cag_tool_try_place(const char *path, CagError *err);
void cag_tool_make_folder(const char *path);

// Nonzero after Ctrl-C or SIGTERM; t->session.interrupt points to it. A second signal ends the
// program at once, but removes temporary files. A command that handles Ctrl-C and continues (the
// REPL) resets it to 0.
extern volatile int cag_tool_interrupt;

#endif
