// The POV-Ray process (see povray_process.h).

#include "interp/render/povray_process.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/inotify.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "interp/render/sandbox.h"

// The interval, in milliseconds, at which the flag, the clock, and the process are checked.
#define WATCH_INTERVAL 40
// The same once the output is closed: the process is about to end.
#define WATCH_INTERVAL_CLOSED 4

// Runs in the child after fork, so only async-signal-safe calls are allowed.
static void become(const CagPovrayProcess *p, int output) {
  const struct rlimit no_core = {0, 0};
  int null = open("/dev/null", O_RDONLY);
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL); // POV-Ray must not outlive a killed cag
  setrlimit(RLIMIT_CORE, &no_core);
  sigset_t none;
  sigemptyset(&none);
  signal(SIGINT, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
  signal(SIGPIPE, SIG_DFL);
  signal(SIGXFSZ, SIG_DFL);
  sigprocmask(SIG_SETMASK, &none, NULL);
  if (null >= 0 && dup2(null, STDIN_FILENO) >= 0 && dup2(output, STDOUT_FILENO) >= 0 &&
      dup2(output, STDERR_FILENO) >= 0 && chdir(p->folder) == 0 && cag_sandbox_enter(p->ruleset))
    execve(p->program, p->arguments, p->environment);
  _exit(CAG_POVRAY_EXEC_FAILED);
}

// A process that is being watched.
typedef struct {
  const CagPovrayProcess *process;
  CagPovrayLog *log;
  pid_t child;
  double begun;
  int output;   // read end of its pipe; -1: closed
  int folder;   // inotify descriptor for files closed in the folder; -1: none
  bool written; // the picture was written and closed since the last check
  bool stopped; // it was killed, with the reason in `end`
  CagPovrayEnd end;
} Follow;

static bool should_end(Follow *f) {
  const CagPovrayProcess *p = f->process;
  if (p->interrupted && *p->interrupted) f->end.kind = CAG_POVRAY_INTERRUPTED;
  else if (p->time_limit > 0 && cag_clock_seconds() - f->begun > p->time_limit)
    f->end.kind = CAG_POVRAY_TIME;
  else return false;
  return true;
}

// Reads its output.
static void drain(Follow *f) {
  char bytes[4096];
  const ssize_t n = read(f->output, bytes, sizeof bytes);
  if (n > 0) cag_povray_log_feed(f->log, bytes, (size_t)n);
  else if (n == 0 || (errno != EINTR && errno != EAGAIN)) f->output = -1;
}

// Reads the names of the files that were written.
static void take_events(Follow *f) {
  _Alignas(struct inotify_event) char bytes[sizeof(struct inotify_event) + NAME_MAX + 1];
  for (ssize_t n; (n = read(f->folder, bytes, sizeof bytes)) > 0;) {
    for (char *at = bytes; at < bytes + n;) {
      const struct inotify_event *e = (const struct inotify_event *)(void *)at;
      f->written |= e->len && !strcmp(e->name, f->process->picture);
      at += sizeof *e + e->len;
    }
  }
}

static void wait_for_news(Follow *f) {
  struct pollfd waiting[] = {{.fd = f->output, .events = POLLIN},
                             {.fd = f->folder, .events = POLLIN}};
  if (poll(waiting, 2, f->output >= 0 ? WATCH_INTERVAL : WATCH_INTERVAL_CLOSED) <= 0) return;
  if (waiting[0].revents) drain(f);
  if (waiting[1].revents) take_events(f);
}

// Returns whether the picture is complete.
static bool has_picture(Follow *f) {
  if (!f->written || !f->log->told_statistics) return false;
  f->written = false;
  if (!f->process->is_whole(f->process->user)) return false;
  cag_povray_log_whole(f->log);
  return true;
}

static void stop(Follow *f, CagPovrayEndKind why) {
  f->end = (CagPovrayEnd){why, 0};
  f->stopped = true;
  kill(-f->child, SIGKILL);
  kill(f->child, SIGKILL);
}

// Watches the process until it ends, or kills it.
static CagPovrayEnd follow(Follow *f) {
  int status = 0;
  // Checks for an exit even while the output is open, because a grandchild may hold it.
  for (;;) {
    wait_for_news(f);
    const pid_t done = waitpid(f->child, &status, WNOHANG);
    if (done == f->child || (done < 0 && errno == ECHILD)) break;
    if (f->stopped) continue;
    if (has_picture(f)) stop(f, CAG_POVRAY_EXITED);
    else if (should_end(f)) stop(f, f->end.kind);
  }
  kill(-f->child, SIGKILL); // kills its own children, too
  while (f->output >= 0 && poll(&(struct pollfd){.fd = f->output, .events = POLLIN}, 1, 0) > 0)
    drain(f);
  cag_povray_log_finish(f->log);
  if (f->stopped) return f->end;
  if (WIFSIGNALED(status)) return (CagPovrayEnd){CAG_POVRAY_SIGNALED, WTERMSIG(status)};
  return (CagPovrayEnd){CAG_POVRAY_EXITED, WEXITSTATUS(status)};
}

// If the system has no more watches, waits for the process to end.
static int watch_folder(const CagPovrayProcess *p) {
  const int fd = p->picture ? inotify_init1(IN_NONBLOCK | IN_CLOEXEC) : -1;
  if (fd < 0 || inotify_add_watch(fd, p->folder, IN_CLOSE_WRITE) >= 0) return fd;
  close(fd);
  return -1;
}

CagPovrayEnd cag_povray_process_run(const CagPovrayProcess *process, CagPovrayLog *log) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return (CagPovrayEnd){CAG_POVRAY_NO_START, errno};
  const int folder = watch_folder(process);
  pid_t child = fork();
  if (child == 0) become(process, ends[1]);
  const int code = errno;
  CagPovrayEnd end = {CAG_POVRAY_NO_START, code};
  close(ends[1]);
  if (child > 0) {
    setpgid(child, child); // in both processes, so that a kill never comes too early
    fcntl(ends[0], F_SETFL, O_NONBLOCK);
    Follow f = {.process = process,
                .log = log,
                .child = child,
                .begun = cag_clock_seconds(),
                .output = ends[0],
                .folder = folder};
    end = follow(&f);
  }
  if (folder >= 0) close(folder);
  close(ends[0]);
  return end;
}
