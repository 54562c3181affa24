// The REPL: what its files share.
//
//     repl.c           reading texts and evaluating them
//     repl_input.c     lines, from the line editor or from a pipe; history
//     repl_complete.c  what Tab proposes
//     repl_import.c    the same behind import
//     repl_commands.c  the `:` commands
//
// With a terminal on both sides lines are edited, and Ctrl-C stops what runs. Else lines are just
// read: no prompt, no history; Ctrl-C ends the program as it ends any other, and the exit status is
// that of the first input that failed.

#ifndef CAG_CLI_REPL_H
#define CAG_CLI_REPL_H

#include "cli/tool.h"

typedef struct CagReplInput CagReplInput;

typedef struct CagRepl {
  CagTool *tool;
  CagSession *session;
  CagReplInput *input;
  bool interactive; // a person at a terminal
  bool quit;
  int status;         // of the first failure; CAG_STATUS_OK
  const char *before; // the lines that the line being read goes on; NULL: none
  char **loaded;      // the files of :load, for :reload
  size_t loaded_count;
} CagRepl;

// --- repl_input.c ---

// How reading a line ended.
typedef enum CagReplRead { CAG_REPL_LINE, CAG_REPL_END, CAG_REPL_INTERRUPTED } CagReplRead;

// NULL when memory is out. `repl` gives Tab what it proposes.
CagReplInput *cag_repl_input_new(CagRepl *repl);
void cag_repl_input_free(CagReplInput *in);
// The next line without its end, valid until the next call. `more`: the text so far asks for
// another line.
CagReplRead cag_repl_read(CagReplInput *in, bool more, char **line);
// Adds a complete text, of one line or several, to the history that a terminal has.
void cag_repl_remember(CagReplInput *in, const char *text, size_t length);
// Without a terminal: the line to come, which stays to be read; NULL: none.
const char *cag_repl_peek(CagReplInput *in);

// --- repl_complete.c ---

typedef struct CagReplProposals {
  char **items; // in order, each once
  size_t count;
  size_t length; // bytes before the cursor that they stand for
} CagReplProposals;

// What could stand in place of the word before the end of `text` (the line up to the cursor).
CagReplProposals cag_repl_propose(CagRepl *repl, const char *text);
void cag_repl_proposals_free(CagReplProposals *p);
// Adds a text that begins with `prefix` (of p->length bytes), once.
void cag_repl_propose_text(CagReplProposals *p, const char *text, size_t length,
                           const char *prefix);
// Where the name that ends at `end` begins.
const char *cag_repl_word(const char *text, const char *end);

// --- repl_import.c ---

// Proposals for a line that begins with `import`; false for other lines, and within its text.
bool cag_repl_propose_import(CagRepl *repl, CagReplProposals *p, const char *line);

// --- repl_commands.c ---

// Performs a line that begins with `:`.
void cag_repl_command(CagRepl *repl, char *line);
// Command i in the order of :help; false behind the last.
bool cag_repl_command_row(size_t i, const char **name, const char **operand, const char **story);
// Whether a command wants a file behind it.
bool cag_repl_command_takes_file(const char *name);

// --- repl.c ---

// Evaluates a text; values are printed with their types.
void cag_repl_evaluate(CagRepl *repl, const char *text, size_t length);
// Loads a script and remembers it for :reload.
void cag_repl_load(CagRepl *repl, const char *path);
// Tells how a call of the session ended: the diagnostics, or that it was interrupted.
void cag_repl_finish(CagRepl *repl, int status);
// A failure without a place in a script.
void cag_repl_fail(CagRepl *repl, int status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
