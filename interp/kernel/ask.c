// The process of cag-brep and the exchange of messages with it (see ask.h and kernel.h).
//
// Both directions are one socket, so that a program that has ended is an error of the call and not
// a signal. The socket does not block: cag waits with poll, and looks at the stop flag meanwhile.

#include "interp/kernel/ask.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/stop.h"
#include "interp/kernel/answers.h"
#include "interp/kernel/read_boundary.h"

// Milliseconds between looks at the stop flag.
#define WATCH_INTERVAL 20
// Seconds until a program that says nothing is given up: at its start, and during a request for
// which there is no other limit.
#define HELLO_SECONDS 20.0
#define ANSWER_SECONDS 600.0
// The largest answer that is accepted, in bytes.
#define ANSWER_MOST ((uint64_t)1 << 31)
// The memory that the program needs for itself, in bytes, beside that of the run's limit.
#define OWN_MEMORY ((size_t)256 << 20)
#define EXEC_FAILED 127

#define PROGRAM "cag-brep"
#define TUNABLES "GLIBC_TUNABLES"
#define PACKAGE_HELP "install the package cag-brep, or build it with `make brep`"

struct CagKernel {
  pid_t process; // 0: not started
  int socket;
  double patience; // seconds; 0: ANSWER_SECONDS
  CagAnswers answers;
};

CagKernel *cag_kernel_new(void) {
  CagKernel *k = calloc(1, sizeof *k); // lives longer than an account
  if (k) k->socket = -1;
  return k;
}

// The process is killed with those that it has started.
static void end_process(CagKernel *k) {
  if (k->socket >= 0) close(k->socket);
  k->socket = -1;
  if (k->process <= 0) return;
  kill(-k->process, SIGKILL);
  kill(k->process, SIGKILL);
  while (waitpid(k->process, NULL, 0) < 0 && errno == EINTR) continue;
  k->process = 0;
}

void cag_kernel_free(CagKernel *k) {
  if (!k) return;
  end_process(k);
  cag_answers_free(&k->answers);
  free(k);
}

void cag_kernel_set_patience(CagKernel *k, double seconds) { k->patience = seconds; }

// --- The program ---

// Sets `path` to the folder of the running program and `rest`. Returns whether there is such a
// program.
static bool beside_self(const char *rest, char *path, size_t size) {
  const ssize_t n = readlink("/proc/self/exe", path, size - strlen(rest) - 1);
  if (n <= 0 || (size_t)n >= size - strlen(rest) - 1) return false;
  path[n] = '\0';
  char *slash = strrchr(path, '/');
  if (!slash) return false;
  strcpy(slash + 1, rest);
  return access(path, X_OK) == 0;
}

// The program is the one that the environment variable CAG_BREP names, or lies beside cag, or in
// lib/cag of its installation, or is found like any program.
static void find_program(char *path, size_t size) {
  const char *named = getenv("CAG_BREP");
  if (named && *named && strlen(named) < size) strcpy(path, named);
  else if (!beside_self(PROGRAM, path, size) && !beside_self("../lib/cag/" PROGRAM, path, size))
    strcpy(path, PROGRAM);
}

// The environment of the program, in which the C library takes memory in large pages: the kernel
// touches much of it, once. NULL if memory ran out; the caller frees it.
static char **program_environment(void) {
  static char setting[] = TUNABLES "=glibc.malloc.hugetlb=1";
  size_t n = 0;
  while (environ && environ[n]) n++;
  char **all = cag_calloc(n + 2, sizeof *all);
  if (!all) return NULL;
  if (n > 0) memcpy(all, environ, n * sizeof *all);
  if (!getenv(TUNABLES)) all[n] = setting;
  return all;
}

// Runs in the child after fork, so only async-signal-safe calls are allowed. The program ends itself
// when the socket is closed. The death signal of the parent would come when its thread ends, which is
// that of a run.
static void become(const char *program, char *const *environment, int socket, rlim_t memory) {
  static char name[] = PROGRAM;
  char *const arguments[] = {name, NULL};
  static const int SIGNALS[] = {SIGINT, SIGTERM, SIGHUP, SIGALRM, SIGPIPE, SIGXFSZ};
  const struct rlimit no_core = {0, 0}, most = {memory, memory};
  sigset_t none;
  sigemptyset(&none);
  setpgid(0, 0);
  setrlimit(RLIMIT_CORE, &no_core);
  if (memory != RLIM_INFINITY) setrlimit(RLIMIT_DATA, &most);
  for (size_t i = 0; i < sizeof SIGNALS / sizeof *SIGNALS; i++) signal(SIGNALS[i], SIG_DFL);
  sigprocmask(SIG_SETMASK, &none, NULL);
  const int null = open("/dev/null", O_WRONLY);
  if (null >= 0 && dup2(socket, STDIN_FILENO) >= 0 && dup2(socket, STDOUT_FILENO) >= 0 &&
      dup2(null, STDERR_FILENO) >= 0)
    execvpe(program, arguments, environment);
  _exit(EXEC_FAILED);
}

static CagStatus fail_missing(CagError *err, const char *why) {
  const CagStatus status =
      cag_fail(err, CAG_E_RENDERER, CAG_ERR_kernel_missing, "", -1,
               "exact boundaries of solids need the program cag-brep, %s: " PACKAGE_HELP, why);
  return status;
}

static CagStatus fail_ended(CagKernel *k, CagError *err, const char *what) {
  end_process(k);
  return cag_fail(err, CAG_E_RENDERER, CAG_ERR_kernel_failed, "", -1, "cag-brep %s", what);
}

// --- Messages ---

static CagStatus fail_answer(CagError *err) {
  return cag_fail(err, CAG_E_RENDERER, CAG_ERR_kernel_answer, "", -1,
                  "cag-brep answered something else than a message");
}

// Waits until the socket is ready. Fails when the work is to stop, or the time is over.
static CagStatus wait_for(CagKernel *k, short events, double until, CagError *err) {
  for (;;) {
    struct pollfd waiting = {.fd = k->socket, .events = events};
    const int ready = poll(&waiting, 1, WATCH_INTERVAL);
    if (ready > 0) return CAG_OK;
    if (cag_stopped()) {
      end_process(k);
      return cag_stop_fail(err);
    }
    if (cag_clock_seconds() > until) return fail_ended(k, err, "did not answer in time");
  }
}

static CagStatus send_bytes(CagKernel *k, const void *bytes, size_t n, double until,
                            CagError *err) {
  const char *at = bytes;
  while (n > 0) {
    const ssize_t sent = send(k->socket, at, n, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent > 0) {
      at += sent;
      n -= (size_t)sent;
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      CagStatus status = wait_for(k, POLLOUT, until, err);
      if (status) return status;
    } else if (errno != EINTR) {
      return fail_ended(k, err, "ended before it had the question");
    }
  }
  return CAG_OK;
}

static CagStatus receive_bytes(CagKernel *k, void *bytes, size_t n, double until, CagError *err) {
  char *at = bytes;
  while (n > 0) {
    const ssize_t got = recv(k->socket, at, n, MSG_DONTWAIT);
    if (got > 0) {
      at += got;
      n -= (size_t)got;
    } else if (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) {
      CagStatus status = wait_for(k, POLLIN, until, err);
      if (status) return status;
    } else if (got == 0 || errno != EINTR) {
      return fail_ended(k, err, "ended before it had answered");
    }
  }
  return CAG_OK;
}

// An answer, which the caller frees.
typedef struct Answer {
  uint64_t type, length;
  unsigned char *bytes;
} Answer;

static CagStatus receive(CagKernel *k, double seconds, Answer *out, CagError *err) {
  uint64_t head[2];
  const double until = cag_clock_seconds() + seconds;
  CagStatus status = receive_bytes(k, head, sizeof head, until, err);
  if (status) return status;
  if (head[1] > ANSWER_MOST) {
    end_process(k);
    return fail_answer(err);
  }
  *out = (Answer){head[0], head[1], cag_malloc((size_t)head[1] + 1)};
  if (!out->bytes) {
    end_process(k);
    return cag_fail_memory(err);
  }
  status = receive_bytes(k, out->bytes, (size_t)out->length, until, err);
  if (status) cag_free(out->bytes);
  return status;
}

static CagFieldReader reader_of(const Answer *a) {
  return (CagFieldReader){a->bytes, a->bytes + a->length, false};
}

static CagStatus greet(CagKernel *k, CagError *err) {
  Answer hello;
  CagStatus status = receive(k, HELLO_SECONDS, &hello, err);
  if (status == CAG_E_CALLBACK || status == CAG_E_MEMORY) return status;
  if (status) return fail_missing(err, "which does not start");
  CagFieldReader r = reader_of(&hello);
  const bool ours = hello.type == CAG_BREP_HELLO && cag_take_u32(&r) == CAG_BREP_PROTOCOL;
  cag_free(hello.bytes);
  if (ours) return CAG_OK;
  end_process(k);
  return fail_missing(err, "of the same version as cag");
}

static CagStatus start(CagKernel *k, CagError *err) {
  char path[PATH_MAX];
  int ends[2];
  if (k->process > 0) return CAG_OK;
  find_program(path, sizeof path);
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    return cag_fail(err, CAG_E_RENDERER, CAG_ERR_kernel_failed, "", -1,
                    "cag-brep cannot be started: %s", strerror(errno));
  char **environment = program_environment();
  if (!environment) {
    close(ends[0]);
    close(ends[1]);
    return cag_fail_memory(err);
  }
  const size_t room = cag_account_room();
  const rlim_t memory = room >= SIZE_MAX / 2 - OWN_MEMORY ? RLIM_INFINITY : room + OWN_MEMORY;
  k->process = fork();
  if (k->process == 0) become(path, environment, ends[1], memory);
  const int code = errno;
  cag_free(environment);
  close(ends[1]);
  k->socket = ends[0];
  if (k->process < 0) {
    k->process = 0;
    end_process(k);
    return cag_fail(err, CAG_E_RENDERER, CAG_ERR_kernel_failed, "", -1,
                    "cag-brep cannot be started: %s", strerror(code));
  }
  setpgid(k->process, k->process); // in both processes, so that a kill never comes too early
  return greet(k, err);
}

// The longest text of a failure that is passed on, in bytes.
#define TOLD_MOST 300

static CagStatus fail_as_told(const Answer *a, CagKernelFailure *why, CagError *err) {
  CagFieldReader r = reader_of(a);
  size_t n;
  const uint32_t reason = cag_take_u32(&r);
  const char *text = (const char *)cag_take_bytes(&r, &n);
  const uint32_t edge = cag_take_u32(&r);
  const double limit = cag_take_f64(&r);
  if (r.bad || reason == 0) return fail_answer(err);
  why->reason = (int)reason;
  why->edge = edge == CAG_BREP_NONE ? CAG_NO_EDGE : edge;
  why->limit = fmax(limit, 0);
  if (reason == CAG_BREP_FAIL_EMPTY)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_no_boundary, "", -1, "nothing is left of it");
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_no_boundary, "", -1, "%.*s",
                  (int)(n < TOLD_MOST ? n : TOLD_MOST), text);
}

// Seconds that the answer to a request may take.
static double answer_seconds(const CagKernel *k, CagBrepMessage type) {
  switch (type) {
  case CAG_BREP_FILLET:
  case CAG_BREP_CHAMFER:
  case CAG_BREP_SHELL:
  case CAG_BREP_OFFSET:
  case CAG_BREP_DRAFT: return k->patience > 0 ? k->patience : ANSWER_SECONDS;
  default: return ANSWER_SECONDS;
  }
}

static CagStatus exchange(CagKernel *k, CagBrepMessage type, const CagFields *f, Answer *out,
                          CagKernelFailure *why, CagError *err) {
  const uint64_t head[2] = {type, f->length};
  const double seconds = answer_seconds(k, type), until = cag_clock_seconds() + seconds;
  CagStatus status = start(k, err);
  if (!status) status = send_bytes(k, head, sizeof head, until, err);
  if (!status) status = send_bytes(k, f->bytes, f->length, until, err);
  if (!status) status = receive(k, seconds, out, err);
  if (status || out->type == CAG_BREP_RESULT) return status;
  status = out->type == CAG_BREP_FAILURE ? fail_as_told(out, why, err) : fail_answer(err);
  if (status == CAG_E_RENDERER) end_process(k);
  cag_free(out->bytes);
  return status;
}

// --- Boundaries ---

// Whether each edge is used as often in one direction as in the other.
static bool closes(const CagBoundary *b) {
  long *balance = cag_calloc(b->edge_count + 1, sizeof *balance);
  if (!balance) return false;
  for (size_t i = 0; i < b->use_count; i++)
    balance[b->uses[i].edge] += b->uses[i].reversed ? -1 : 1;
  bool ok = true;
  for (size_t i = 0; i < b->edge_count; i++) ok = ok && (balance[i] == 0 || !b->edges[i].curve);
  cag_free(balance);
  return ok;
}

static CagStatus fail_result(CagError *err) {
  return cag_fail(err, CAG_E_RENDERER, CAG_ERR_kernel_answer, "", -1,
                  "the answer of cag-brep is not a boundary");
}

// Whether the solid that was read last is a boundary that closes, or a copy of one.
static CagStatus check_result(CagBoundaries *all, CagError *err) {
  const size_t last = all->count - 1, original = all->copies[last].original;
  if (original == CAG_NOT_COPIED)
    return closes(&all->items[last]) ? CAG_OK
                                     : cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_no_boundary, "", -1,
                                                "the faces that the kernel found do not close");
  if (original >= last || all->copies[original].original != CAG_NOT_COPIED) return fail_result(err);
  all->items[last].volume = all->items[original].volume;
  return CAG_OK;
}

static CagStatus read_result(const Answer *a, CagBoundaries *out, CagError *err) {
  CagFieldReader r = reader_of(a);
  const size_t n = cag_take_count(&r, 1);
  *out = (CagBoundaries){cag_calloc(n + 1, sizeof *out->items), 0,
                         cag_calloc(n + 1, sizeof *out->copies)};
  CagStatus status = out->items && out->copies ? CAG_OK : cag_fail_memory(err);
  bool copied = false;
  while (!status && out->count < n) {
    status = cag_read_part(&r, &out->items[out->count], &out->copies[out->count], err);
    if (status) break;
    copied = copied || out->copies[out->count].original != CAG_NOT_COPIED;
    out->count++;
    status = check_result(out, err);
    if (!status) status = cag_stop_check(err);
  }
  if (!copied) {
    cag_free(out->copies);
    out->copies = NULL;
  }
  if (!status && (n == 0 || r.at != r.end)) status = fail_result(err);
  if (status) cag_boundaries_free(out);
  return status;
}

CagStatus cag_kernel_ask(CagKernel *k, CagBrepMessage type, const CagFields *f,
                         const CagDigest *question, CagBoundaries *out, CagKernelFailure *why,
                         CagError *err) {
  *why = (CagKernelFailure){.edge = CAG_NO_EDGE};
  *out = (CagBoundaries){0};
  if (f->failed) return cag_fail_memory(err);
  const CagKeptAnswer *kept = cag_answers_find(&k->answers, question);
  if (kept) return read_result(&(Answer){CAG_BREP_RESULT, kept->length, kept->bytes}, out, err);
  Answer answer;
  CagStatus status = exchange(k, type, f, &answer, why, err);
  if (status) return status;
  status = read_result(&answer, out, err);
  if (!status) cag_answers_keep(&k->answers, question, answer.bytes, (size_t)answer.length);
  cag_free(answer.bytes);
  return status;
}
