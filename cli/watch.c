// The work runs on a thread of its own, so that this one notices saves and Ctrl-C meanwhile. Only
// one of the two uses the session at a time.

#include "cli/watch.h"

#include <fnmatch.h>
#include <limits.h>
#include <math.h>
#include <poll.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "live/watch_files.h"

// Milliseconds without a further change after which a save counts as complete, and the longest
// time to wait for that.
#define QUIET 30
#define QUIET_MOST 500
// Milliseconds between looks at Ctrl-C while the work runs, because the signal may arrive on
// another thread.
#define LOOK 50

// Stops the work, for Ctrl-C or for a newer save.
static volatile int stop;

typedef struct Round {
  CagTool *tool;
  CagSession *session;
  CagToolWork *work;
  void *context;
  int status;
  int done[2]; // a pipe that is written to at the end
} Round;

static void *run_work(void *context) {
  Round *r = context;
  r->status = r->work(r->tool, r->session, r->context);
  while (write(r->done[1], "", 1) < 0 && !cag_tool_interrupt) continue;
  return NULL;
}

// --- The files ---

// Makes a pattern for fnmatch that matches the output, in which %d and %s stand for anything.
static char *output_pattern(const char *output) {
  if (!output || !strcmp(output, "-")) return NULL;
  const char *slash = strrchr(output, '/'), *name = slash ? slash + 1 : output;
  char *folder = slash ? strndup(output, (size_t)(slash - output + 1)) : strdup(".");
  char *real = folder ? realpath(folder, NULL) : NULL;
  char *pattern = real ? malloc(2 * (strlen(real) + strlen(name)) + 3) : NULL;
  char *to = pattern;
  const char *parts[] = {real, "/", name};
  for (int k = 0; pattern && k < 3; k++)
    for (const char *at = parts[k]; *at; at++) {
      const size_t digits = k == 2 && *at == '%' ? strspn(at + 1, "0123456789") : 0;
      if (k == 2 && *at == '%' && (at[digits + 1] == 'd' || at[digits + 1] == 's')) {
        *to++ = '*';
        at += digits + 1;
        continue;
      }
      if (strchr("*?[\\", *at)) *to++ = '\\';
      *to++ = *at;
    }
  if (pattern) *to = 0;
  free(folder);
  free(real);
  return pattern;
}

// Watches the script and what the last run read, except for its own output.
static bool watch_files(CagFileWatch *w, const CagTool *t, const CagSession *s, const char *script,
                        double since) {
  size_t n = 0, kept = 0;
  while (s && cag_session_read_file(s, n)) n++;
  const char **paths = malloc((n + 1) * sizeof *paths);
  if (!paths) return false;
  char *pattern = output_pattern(t->output);
  paths[kept++] = script;
  for (size_t i = 0; i < n; i++) {
    const char *path = cag_session_read_file(s, i);
    if (!pattern || fnmatch(pattern, path, 0) != 0) paths[kept++] = path;
  }
  const bool ok = cag_file_watch_set(w, paths, kept, since);
  free(pattern);
  free(paths);
  return ok;
}

// --- Rounds ---

// A round, and what is shown about it.
typedef struct Rounds {
  Round round;
  CagFileWatch *files;
  const char *script;
  char changed[NAME_MAX + 1]; // the name of the file that caused the round
} Rounds;

static bool look(Rounds *s) {
  const char *path;
  if (!cag_file_watch_look(s->files, &path)) return false;
  const char *slash = strrchr(path, '/');
  snprintf(s->changed, sizeof s->changed, "%s", slash ? slash + 1 : path);
  return true;
}

// Waits for the end of the work, and stops it if a file changes. Returns whether one has.
static bool attend(Rounds *s) {
  const int events = cag_file_watch_descriptor(s->files);
  struct pollfd fds[2] = {{.fd = s->round.done[0], .events = POLLIN},
                          {.fd = events, .events = POLLIN}};
  bool newer = false;
  for (;;) {
    fds[0].revents = 0;
    fds[1].fd = newer ? -1 : events;
    poll(fds, 2, LOOK);
    if (fds[0].revents & POLLIN) return newer;
    newer = newer || look(s);
    if (newer || cag_tool_interrupt) stop = 1;
  }
}

// Returns whether a file has changed meanwhile, in which case the work was stopped.
static bool run_round(Rounds *s) {
  Round *r = &s->round;
  pthread_t thread;
  bool newer = false;
  stop = cag_tool_interrupt;
  if (pipe(r->done) != 0) {
    r->status = cag_tool_fail(r->tool, CAG_STATUS_LIMIT, NULL, "cannot create a pipe");
    return false;
  }
  if (pthread_create(&thread, NULL, run_work, r) == 0) {
    newer = attend(s);
    pthread_join(thread, NULL);
  } else {
    r->status = cag_tool_fail(r->tool, CAG_STATUS_LIMIT, NULL, "cannot create a thread");
  }
  close(r->done[0]);
  close(r->done[1]);
  return newer;
}

// Waits for a save, unless one has been noticed, and until it is complete. Returns false if the
// program is to end.
static bool await_save(Rounds *s, bool noticed) {
  const char *path;
  if (noticed) {
    cag_file_watch_wait(s->files, QUIET, QUIET, QUIET_MOST, NULL);
    return !cag_tool_interrupt;
  }
  while (!cag_tool_interrupt)
    if (cag_file_watch_wait(s->files, -1, QUIET, QUIET_MOST, &path)) {
      const char *slash = strrchr(path, '/');
      snprintf(s->changed, sizeof s->changed, "%s", slash ? slash + 1 : path);
      return true;
    }
  return false;
}

// On a terminal, the messages of a round replace those of the last one.
static void begin_again(const Rounds *s) {
  const CagTool *t = s->round.tool;
  if (isatty(STDERR_FILENO) && t->style != CAG_STYLE_JSON) fputs("\033[H\033[2J\033[3J", stderr);
  cag_tool_say(t, "%s changed", s->changed);
}

static int watch(Rounds *s) {
  const CagTool *t = s->round.tool;
  bool newer = false, ok = watch_files(s->files, t, NULL, s->script, INFINITY);
  for (size_t rounds = 0; ok; rounds++) {
    if (rounds > 0 && !await_save(s, newer)) break;
    if (rounds > 0) begin_again(s);
    const double since = cag_file_watch_now(), begun = cag_clock_seconds();
    newer = run_round(s);
    if (cag_tool_interrupt || cag_tool_output_is_unread()) break;
    ok = watch_files(s->files, t, s->round.session, s->script, since);
    newer = newer || look(s);
    if (!newer)
      cag_tool_say(t, "%s after %.2f s; waiting for changes", s->round.status ? "failed" : "done",
                   cag_clock_seconds() - begun);
  }
  if (!ok) return cag_tool_fail(t, CAG_STATUS_LIMIT, NULL, "out of memory");
  return s->round.status;
}

static int check_script(const CagTool *t, const char *script) {
  if (!strcmp(script, "-"))
    return cag_tool_fail(t, CAG_STATUS_USAGE, "name a file", "--watch needs a script in a file");
  if (access(script, R_OK) == 0) return CAG_STATUS_OK;
  return cag_tool_fail(t, CAG_STATUS_FILE, NULL, "cannot read %s", script);
}

static int watch_script(const Round *r, const char *script) {
  char path[PATH_MAX] = "";
  CagFileWatch *files = cag_file_watch_new(getenv("CAG_WATCH_POLL") != NULL);
  if (!files) return cag_tool_fail(r->tool, CAG_STATUS_LIMIT, NULL, "out of memory");
  if (script[0] != '/' && getcwd(path, sizeof path / 2)) strcat(path, "/");
  const size_t used = strlen(path);
  snprintf(path + used, sizeof path - used, "%s", script);
  Rounds s = {.round = *r, .files = files, .script = path};
  const int status = watch(&s);
  cag_file_watch_free(files);
  return status;
}

int cag_tool_rounds(CagTool *t, const char *script, CagToolWork *work, void *context) {
  Round r = {.tool = t, .work = work, .context = context};
  int status = t->watch ? check_script(t, script) : CAG_STATUS_OK;
  if (status != CAG_STATUS_OK) return status;
  if (t->watch) t->session.interrupt = &stop;
  r.session = cag_tool_session(t);
  if (!r.session) return CAG_STATUS_LIMIT;
  status = t->watch ? watch_script(&r, script) : work(t, r.session, context);
  cag_session_free(r.session);
  return status;
}
