// Internals of the REPL.
//
//     repl.c           reading and evaluating inputs
//     repl_input.c     lines, from the line editor or from a pipe; history
//     repl_complete.c  completion with Tab
//     repl_import.c    completion of import statements
//     repl_commands.c  the `:` commands
//
// If input and output are a terminal, lines can be edited, and Ctrl-C stops the evaluation.
// Otherwise there is no prompt and no history, Ctrl-C ends the program, and the exit status is that
// of the first input that failed.

#ifndef CAG_CLI_REPL_H
#define CAG_CLI_REPL_H

#include "cli/tool.h"

typedef struct CagReplInput CagReplInput;

typedef struct CagRepl {
  CagTool *tool;
  CagSession *session;
  CagReplInput *input;
  bool interactive; // input and output are a terminal
  bool quit;
  int status;         // of the first failure; CAG_STATUS_OK
  const char *before; // the lines that the current line continues; NULL: none
  char **loaded;      // files of :load, for :reload
  size_t loaded_count;
} CagRepl;

// --- repl_input.c ---

// How reading a line ended.
typedef enum CagReplRead { CAG_REPL_LINE, CAG_REPL_END, CAG_REPL_INTERRUPTED } CagReplRead;

// Returns NULL if memory ran out. `repl` provides completions.
CagReplInput *cag_repl_input_new(CagRepl *repl);
void cag_repl_input_free(CagReplInput *in);
// Reads the next line, without its line end; it is valid until the next call. `more`: the line
// continues the previous ones.
CagReplRead cag_repl_read(CagReplInput *in, bool more, char **line);
// Adds a complete input, of one or several lines, to the terminal's history.
void cag_repl_remember(CagReplInput *in, const char *text, size_t length);
// Without a terminal: returns the next line without consuming it, or NULL.
const char *cag_repl_peek(CagReplInput *in);

// --- repl_complete.c ---

typedef struct CagReplProposals {
  char **items; // sorted, each once
  size_t count;
  size_t length; // bytes before the cursor that they replace
} CagReplProposals;

// Returns the completions of the last word of `text`, the line up to the cursor.
CagReplProposals cag_repl_propose(CagRepl *repl, const char *text);
void cag_repl_proposals_free(CagReplProposals *p);
// Adds a text once if it starts with `prefix` (of p->length bytes).
void cag_repl_propose_text(CagReplProposals *p, const char *text, size_t length,
                           const char *prefix);
// Returns the start of the name that ends at `end`.
const char *cag_repl_word(const char *text, const char *end);

// --- repl_import.c ---

// Returns the completions of a line that starts with `import`. Returns false for other lines, and
// within the line's text.
bool cag_repl_propose_import(CagRepl *repl, CagReplProposals *p, const char *line);

// --- repl_commands.c ---

// Executes a line that starts with `:`.
void cag_repl_command(CagRepl *repl, char *line);
// Returns command i in the order of :help. Returns false after the last one.
bool cag_repl_command_row(size_t i, const char **name, const char **operand, const char **story);
// Tests whether a command takes a file name.
bool cag_repl_command_takes_file(const char *name);

// --- repl.c ---

// Evaluates a text, and prints the values with their types.
void cag_repl_evaluate(CagRepl *repl, const char *text, size_t length);
// Loads a script, and records it for :reload.
void cag_repl_load(CagRepl *repl, const char *path);
// Reports the result of a call of the session: the diagnostics, or that it was interrupted.
void cag_repl_finish(CagRepl *repl, int status);
// Reports a failure without a location in a script.
void cag_repl_fail(CagRepl *repl, int status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
