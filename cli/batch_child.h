// Child processes of a batch: starting, watching without blocking, and stopping them.
//
// Each process has its own process group, so that Ctrl-C at the terminal reaches only the batch,
// which then stops its processes in order. If the batch is killed, the kernel terminates them, so
// that none continues to write outputs that a second call may write at the same time.

#ifndef CAG_CLI_BATCH_CHILD_H
#define CAG_CLI_BATCH_CHILD_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>

typedef enum CagChildStop {
  CAG_CHILD_RUNS,
  CAG_CHILD_STOP_TIME,
  CAG_CHILD_STOP_MEMORY,
  CAG_CHILD_STOP_ASKED
} CagChildStop;

typedef struct CagChild {
  pid_t pid;
  int said; // read end of the pipe from its standard error; -1: closed
  char *text;
  size_t length;       // of its output, of which about the last CAG_CHILD_TEXT_MAX bytes are kept,
                       // followed by a zero
  double begun, limit; // start time and time limit in seconds; a limit of 0: none
  CagChildStop stop;   // why it was stopped
  double asked;        // when
  bool killed;
  // Set after it has ended:
  int status; // as from waitpid
  double seconds;
  size_t memory; // largest memory of it or of a process that it waited for, in bytes
} CagChild;

#define CAG_CHILD_TEXT_MAX ((size_t)1 << 16)

// Starts a program in the folder (NULL: the current one), with empty standard input. Keeps its
// standard error, and with `whole` also its standard output, which is otherwise discarded. Returns
// false, with errno, if no process can be created.
bool cag_child_start(CagChild *c, char *const *words, const char *folder, double limit, bool whole);

// Starts a process that runs work(context) and exits with its result.
bool cag_child_start_work(CagChild *c, int (*work)(void *context), void *context, double limit);

// Asks the process to end, and kills it later if it does not.
void cag_child_stop(CagChild *c, CagChildStop why);

// Reads its output and checks its time limit. Returns true after it has ended.
bool cag_child_look(CagChild *c);

void cag_child_free(CagChild *c);

// Runs a program for at most `limit` seconds. Returns its exit status, or -1 if it did not start or
// was stopped. `text` (malloc'd, never NULL on success) is its standard output and standard error.
// `interrupted` may be NULL.
int cag_child_run(char *const *words, double limit, const volatile int *interrupted, char **text);

#endif
