// The processes of a batch: started, followed without waiting, and ended.
//
// A process has a group of its own, so that a Ctrl-C at the terminal reaches the batch alone, which
// then ends its processes in order. When the batch is killed the kernel asks them to end: none goes
// on writing outputs that a second call makes at the same time.

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
  int said; // the end of a pipe from its standard error; -1: it is closed
  char *text;
  size_t length; // of what it said, the last CAG_CHILD_TEXT_MAX bytes or so, with a zero behind
  double begun, limit; // seconds; a limit of 0: none
  CagChildStop stop;   // why it was asked to end
  double asked;        // when
  bool killed;
  // When it has ended:
  int status; // as waitpid gives it
  double seconds;
  size_t memory; // bytes: the most of it or of a process that it waited for
} CagChild;

#define CAG_CHILD_TEXT_MAX ((size_t)1 << 16)

// Starts a program in the folder (NULL: this one). It reads nothing; what it says on standard error
// is kept, and on standard output with `whole`, else dropped. False, with errno, when the system
// gives no process.
bool cag_child_start(CagChild *c, char *const *words, const char *folder, double limit, bool whole);

// Starts a process that does work(context) and ends with what it gives.
bool cag_child_start_work(CagChild *c, int (*work)(void *context), void *context, double limit);

// Asks it to end, and has it killed when it does not.
void cag_child_stop(CagChild *c, CagChildStop why);

// Takes what it said, sees to its limit, and gives true when it has ended.
bool cag_child_look(CagChild *c);

void cag_child_free(CagChild *c);

// Runs a program to its end, at most `limit` seconds; gives its exit status, or -1 when it did not
// start or was stopped. `text` (malloc'd, never NULL on success) is what it said on both outputs.
// `interrupted` may be NULL.
int cag_child_run(char *const *words, double limit, const volatile int *interrupted, char **text);

#endif
