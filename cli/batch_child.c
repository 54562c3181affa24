// Child processes of a batch (see batch_child.h).

#include "cli/batch_child.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"

// Seconds between asking a process to end and killing it. If it can, the program ends by itself
// after two seconds and removes its temporary files (see main.c).
#define PATIENCE 4.0

// Exit status of a child whose exec failed.
#define EXEC_FAILED 127

// Milliseconds between checks by cag_child_run.
#define LOOK_INTERVAL 20

// --- Starting ---

// Runs in the child after fork: resets inherited state.
static bool reset_child(int output, bool whole, const char *folder, pid_t parent) {
  static const int SIGNALS[] = {SIGINT, SIGTERM, SIGHUP, SIGALRM};
  sigset_t none;
  sigemptyset(&none);
  for (size_t i = 0; i < sizeof SIGNALS / sizeof *SIGNALS; i++) signal(SIGNALS[i], SIG_DFL);
  sigprocmask(SIG_SETMASK, &none, NULL);
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) return false; // the parent died before the death signal was set
  const int null = open("/dev/null", O_RDWR);
  return null >= 0 && dup2(null, STDIN_FILENO) >= 0 &&
         dup2(whole ? output : null, STDOUT_FILENO) >= 0 && dup2(output, STDERR_FILENO) >= 0 &&
         (!folder || chdir(folder) == 0);
}

// Forks. Returns 0 in the child, where *c must not be used, and 1 in the parent. If the fork fails,
// returns -1 and sets errno.
static int begin(CagChild *c, const char *folder, double limit, bool whole) {
  int ends[2];
  *c = (CagChild){.said = -1, .limit = limit, .begun = cag_clock_seconds()};
  c->text = calloc(1, 1);
  if (!c->text) return errno = ENOMEM, -1;
  if (pipe2(ends, O_CLOEXEC) != 0) return cag_child_free(c), -1;
  const pid_t parent = getpid();
  c->pid = fork();
  if (c->pid == 0) {
    if (!reset_child(ends[1], whole, folder, parent)) _exit(EXEC_FAILED);
    return 0;
  }
  const int code = errno;
  close(ends[1]);
  c->said = ends[0];
  if (c->pid < 0) {
    cag_child_free(c);
    return errno = code, -1;
  }
  setpgid(c->pid, c->pid); // in both processes, so that a signal never comes too early
  fcntl(c->said, F_SETFL, O_NONBLOCK);
  return 1;
}

bool cag_child_start(CagChild *c, char *const *words, const char *folder, double limit,
                     bool whole) {
  const int side = begin(c, folder, limit, whole);
  if (side == 0) {
    execvp(words[0], words);
    _exit(EXEC_FAILED);
  }
  return side > 0;
}

bool cag_child_start_work(CagChild *c, int (*work)(void *context), void *context, double limit) {
  const int side = begin(c, NULL, limit, false);
  if (side == 0) _exit(work(context));
  return side > 0;
}

// --- Watching ---

// Keeps the end of its output, and drops the beginning of a long one.
static void keep(CagChild *c, const char *bytes, size_t n) {
  if (c->length + n > 2 * CAG_CHILD_TEXT_MAX) {
    const size_t drop = c->length - CAG_CHILD_TEXT_MAX;
    memmove(c->text, c->text + drop, c->length - drop);
    c->length -= drop;
  }
  char *larger = realloc(c->text, c->length + n + 1);
  if (!larger) return;
  c->text = larger;
  memcpy(c->text + c->length, bytes, n);
  c->length += n;
  c->text[c->length] = '\0';
}

static void take_text(CagChild *c) {
  char bytes[4096];
  while (c->said >= 0) {
    const ssize_t n = read(c->said, bytes, sizeof bytes);
    if (n > 0) {
      keep(c, bytes, (size_t)n);
    } else if (n == 0 || (errno != EAGAIN && errno != EINTR)) {
      close(c->said);
      c->said = -1;
    } else {
      return;
    }
  }
}

void cag_child_stop(CagChild *c, CagChildStop why) {
  if (c->stop != CAG_CHILD_RUNS) return;
  c->stop = why;
  c->asked = cag_clock_seconds();
  kill(-c->pid, SIGTERM);
  kill(c->pid, SIGTERM);
}

static void see_to_limits(CagChild *c) {
  const double now = cag_clock_seconds();
  if (c->limit > 0 && now - c->begun > c->limit) cag_child_stop(c, CAG_CHILD_STOP_TIME);
  if (c->stop == CAG_CHILD_RUNS || c->killed || now - c->asked < PATIENCE) return;
  c->killed = true;
  kill(-c->pid, SIGKILL);
  kill(c->pid, SIGKILL);
}

bool cag_child_look(CagChild *c) {
  struct rusage usage;
  take_text(c);
  const pid_t done = wait4(c->pid, &c->status, WNOHANG, &usage);
  if (done == 0) {
    see_to_limits(c);
    return false;
  }
  kill(-c->pid, SIGKILL); // kills its own children, too
  take_text(c);
  c->seconds = cag_clock_seconds() - c->begun;
  c->memory = done > 0 ? (size_t)usage.ru_maxrss * 1024 : 0;
  if (done < 0) c->status = EXEC_FAILED << 8; // other code has waited for it
  return true;
}

void cag_child_free(CagChild *c) {
  if (c->said >= 0) close(c->said);
  free(c->text);
  *c = (CagChild){.said = -1};
}

int cag_child_run(char *const *words, double limit, const volatile int *interrupted, char **text) {
  CagChild c;
  if (!cag_child_start(&c, words, NULL, limit, true)) return -1;
  while (!cag_child_look(&c)) {
    poll(&(struct pollfd){.fd = c.said, .events = POLLIN}, 1, LOOK_INTERVAL);
    if (interrupted && *interrupted) cag_child_stop(&c, CAG_CHILD_STOP_ASKED);
  }
  const bool ended = WIFEXITED(c.status) && c.stop == CAG_CHILD_RUNS;
  const int status = ended && WEXITSTATUS(c.status) != EXEC_FAILED ? WEXITSTATUS(c.status) : -1;
  *text = c.text;
  c.text = NULL;
  cag_child_free(&c);
  return status;
}
