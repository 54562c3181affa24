// The program `cag`: one function per command, and what they share.
//
// main.c reads the command line into a CagTool, by the tables commands.def and options.def, and
// calls the command's function with its operands. A command gives back the exit status of the
// program (CAG_STATUS_*). Commands use include/cag.h as any client of the library would; only
// those about pictures also use the readers and writers of interp/render.
//
// Standard output belongs to what was asked for (prints, values, exported bytes); everything else
// goes to standard error. main.c flushes standard output at the end and makes a failure of that
// exit status 3, so a command need not look at each write.

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
  int least, most; // how many operands
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

// Why an option does not take a value.
typedef struct CagToolRefusal {
  char message[256], help[256];
} CagToolRefusal;

// The command line, read. Texts point into argv; NULL or 0 where an option was not given.
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
  const char *quality, *camera;
  double exposure;
  bool has_frames, loop;        // --frames, --loop
  int samples;                  // --samples; 0: by the quality
  bool progress;                // --progress
  long first_frame, last_frame; // --frames
  double threshold;
  const char *heatmap;
  const char *filter;     // --filter
  bool update;            // --update
  bool no_pictures;       // --no-pictures
  bool check, diff;       // --check, --diff
  size_t jobs;            // --jobs; 0: one for each processor
  const char *report;     // --report
  CagRenderRegion region; // --region; a width of 0: all of the picture
  int threads;            // --threads; 0: one for each processor
  const char *queue;      // --engine-queue; NULL: run here
  size_t retries;         // --retries
  bool fresh;             // --fresh
  const char *tiles;      // --tiles
  const char *element;    // --element
  const char *html;       // --html

  // Where a value that an option refuses is told instead of on standard error; NULL: there.
  struct CagToolRefusal *refusal;
};

CagToolFunction cag_tool_run, cag_tool_eval, cag_tool_export, cag_tool_render, cag_tool_compare,
    cag_tool_test, cag_tool_fmt, cag_tool_check, cag_tool_doc, cag_tool_explain, cag_tool_info,
    cag_tool_repl, cag_tool_batch;

// A session with the options and the -D of the command line. NULL, after a message, when memory is
// out.
CagSession *cag_tool_session(CagTool *t);

// Writes the diagnostics of the session's last call to standard error in the style asked for, and
// gives back `status`: `return cag_tool_finish(t, s, cag_session_run_file(s, path));`. Says nothing
// of an interruption and of a standard output that nobody reads any more.
int cag_tool_finish(CagTool *t, CagSession *s, int status);

// Says `cag render: MESSAGE` and, behind it, the mend `help` (NULL: none) on standard error, and
// gives back `status`.
int cag_tool_fail(const CagTool *t, int status, const char *help, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

// Flushes standard output. When that fails, says so (unless nobody reads it any more), and makes
// a status of 0 CAG_STATUS_FILE. main.c does it at the end.
int cag_tool_close_output(const CagTool *t, int status);
// Whether standard output is a pipe that was closed at its other end.
bool cag_tool_output_is_unread(void);

// Keeps a value of the option `--name` in `t`, as the command line does. False, with the reason in
// `why`, where the option does not take it.
bool cag_tool_try(CagTool *t, const char *name, const char *value, CagToolRefusal *why);

// A remark on standard error; nothing with -q or JSON diagnostics.
void cag_tool_say(const CagTool *t, const char *format, ...) __attribute__((format(printf, 2, 3)));

// Checks that the output can be written, before a long calculation: 0, or a status after a message.
int cag_tool_check_output(const CagTool *t, const char *path);
// The same where folders that are missing will be made; and makes them. That they cannot be made is
// told when the file is opened.
int cag_tool_check_place(const CagTool *t, const char *path);
bool cag_tool_try_place(const char *path, CagError *err);
void cag_tool_make_folder(const char *path);

// Nonzero after Ctrl-C or SIGTERM; t->session.interrupt points to it. A second signal ends the
// program at once, without temporaries left behind. Who handles Ctrl-C and goes on (the REPL)
// resets it to 0.
extern volatile int cag_tool_interrupt;

#endif
