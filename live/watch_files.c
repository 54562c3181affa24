// Files are kept in an array, in the order of the list, with the folder that each is in.

#include "live/watch_files.h"

#include <errno.h>
#include <limits.h>
#include <poll.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/hash.h"

// Milliseconds between looks where events are missing.
#define INTERVAL 250
// The kernel stamps files with the time of its last tick, which can be this many seconds ago.
#define TICK 0.02
#define EVENTS                                                                                     \
  (IN_CREATE | IN_MODIFY | IN_CLOSE_WRITE | IN_MOVED_TO | IN_MOVED_FROM | IN_DELETE | IN_ATTRIB |  \
   IN_DELETE_SELF | IN_MOVE_SELF)

typedef struct State {
  bool exists;
  dev_t device;
  ino_t inode;
  off_t size;
  struct timespec written, changed;
} State;

typedef struct File {
  char *path;
  State state;
  bool changed;  // and not yet reported
  bool reported; // by the last look
} File;

// A folder of at least one file. A folder that has not been watched so far is tried again.
typedef struct Folder {
  char *path;
  int watch; // of inotify; -1: none
} Folder;

struct CagFileWatch {
  int events; // of inotify; -1: none
  File *files;
  size_t file_count;
  CagHashIndex by_path; // of files
  Folder *folders;
  size_t folder_count;
  bool unwatched; // a folder has no watch
};

CagFileWatch *cag_file_watch_new(bool polled) {
  CagFileWatch *w = calloc(1, sizeof *w);
  if (!w) return NULL;
  w->events = polled ? -1 : inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  w->unwatched = w->events < 0;
  return w;
}

static void free_files(File *files, size_t n) {
  for (size_t i = 0; i < n; i++) free(files[i].path);
  free(files);
}

static void free_folders(Folder *folders, size_t n) {
  for (size_t i = 0; i < n; i++) free(folders[i].path);
  free(folders);
}

void cag_file_watch_free(CagFileWatch *w) {
  if (!w) return;
  if (w->events >= 0) close(w->events);
  free_files(w->files, w->file_count);
  cag_hash_free(&w->by_path);
  free_folders(w->folders, w->folder_count);
  free(w);
}

// --- States ---

static State state_of(const char *path) {
  struct stat st;
  State s;
  memset(&s, 0, sizeof s); // padding as well
  if (stat(path, &st) != 0) return s;
  s.exists = true;
  s.device = st.st_dev;
  s.inode = st.st_ino;
  s.size = st.st_size;
  s.written = st.st_mtim;
  s.changed = st.st_ctim;
  return s;
}

static bool same_time(struct timespec a, struct timespec b) {
  return a.tv_sec == b.tv_sec && a.tv_nsec == b.tv_nsec;
}

static bool same_state(const State *a, const State *b) {
  return a->exists == b->exists && a->device == b->device && a->inode == b->inode &&
         a->size == b->size && same_time(a->written, b->written) &&
         same_time(a->changed, b->changed);
}

static double seconds(struct timespec t) { return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec; }

double cag_file_watch_now(void) {
  struct timespec now;
  clock_gettime(CLOCK_REALTIME, &now);
  return seconds(now) - TICK;
}

// --- The list ---

static File *find_file(const CagHashIndex *by_path, File *files, const char *path) {
  size_t i;
  CagHashWalk w = cag_hash_walk(by_path, cag_hash_text(CAG_HASH_START, path));
  while (cag_hash_next(&w, &i))
    if (files[i].path && !strcmp(files[i].path, path)) return &files[i];
  return NULL;
}

static char *folder_of(const char *path) {
  const char *slash = strrchr(path, '/');
  if (!slash) return strdup(".");
  return strndup(path, slash == path ? 1 : (size_t)(slash - path));
}

static Folder *find_folder(Folder *folders, size_t n, const char *path) {
  for (size_t i = 0; i < n; i++)
    if (!strcmp(folders[i].path, path)) return &folders[i];
  return NULL;
}

static void watch_folders(CagFileWatch *w) {
  w->unwatched = w->events < 0;
  for (size_t i = 0; i < w->folder_count && w->events >= 0; i++) {
    Folder *f = &w->folders[i];
    if (f->watch < 0) f->watch = inotify_add_watch(w->events, f->path, EVENTS | IN_ONLYDIR);
    w->unwatched = w->unwatched || f->watch < 0;
  }
}

// Drops the watches of folders that are not in the new list. Several paths can be one folder, whose
// watch then has one number.
static void drop_watches(const CagFileWatch *w, const Folder *before, size_t n) {
  for (size_t i = 0; i < n; i++) {
    bool used = before[i].watch < 0;
    for (size_t k = 0; !used && k < w->folder_count; k++)
      used = w->folders[k].watch == before[i].watch;
    if (!used) inotify_rm_watch(w->events, before[i].watch);
  }
}

static bool set_folders(CagFileWatch *w) {
  Folder *before = w->folders, *folders = calloc(w->file_count + 1, sizeof *folders);
  const size_t before_count = w->folder_count;
  if (!folders) return false;
  size_t n = 0;
  bool complete = true;
  for (size_t i = 0; i < w->file_count; i++) {
    char *path = folder_of(w->files[i].path);
    if (!path || find_folder(folders, n, path)) {
      complete = complete && path;
      free(path);
      continue;
    }
    const Folder *known = find_folder(before, before_count, path);
    folders[n++] = (Folder){path, known ? known->watch : -1};
  }
  w->folders = folders;
  w->folder_count = n;
  watch_folders(w);
  if (w->events >= 0) drop_watches(w, before, before_count);
  free_folders(before, before_count);
  return complete;
}

bool cag_file_watch_set(CagFileWatch *w, const char *const *paths, size_t count, double since) {
  File *before = w->files, *files = calloc(count + 1, sizeof *files);
  CagHashIndex known_paths = w->by_path, by_path = {0};
  const size_t before_count = w->file_count;
  if (!files) return false;
  size_t n = 0;
  bool complete = true;
  for (size_t i = 0; i < count; i++) {
    if (find_file(&by_path, files, paths[i])) continue;
    const File *known = find_file(&known_paths, before, paths[i]);
    File f = {.path = strdup(paths[i])};
    if (!f.path || !cag_hash_add(&by_path, cag_hash_text(CAG_HASH_START, f.path), n)) {
      free(f.path);
      complete = false;
      continue;
    }
    if (known) f.state = known->state, f.changed = known->changed;
    files[n++] = f;
  }
  w->files = files;
  w->file_count = n;
  w->by_path = by_path;
  complete = set_folders(w) && complete;
  // The states are taken once the folders are watched, so that no change is missed between.
  for (size_t i = 0; i < n; i++) {
    File *f = &files[i];
    if (find_file(&known_paths, before, f->path)) continue;
    f->state = state_of(f->path);
    f->changed = f->state.exists && (seconds(f->state.changed) >= since);
  }
  free_files(before, before_count);
  cag_hash_free(&known_paths);
  return complete;
}

// --- Changes ---

int cag_file_watch_descriptor(const CagFileWatch *w) { return w->events; }

int cag_file_watch_interval(const CagFileWatch *w) { return w->unwatched ? INTERVAL : -1; }

// Reads all events, and returns whether there were any. A folder whose watch has ended, because it
// was deleted or moved, is no longer watched.
static bool read_events(CagFileWatch *w) {
  _Alignas(struct inotify_event) char bytes[16 * (sizeof(struct inotify_event) + NAME_MAX + 1)];
  ssize_t n;
  bool found = false;
  while (w->events >= 0 && (n = read(w->events, bytes, sizeof bytes)) > 0)
    for (char *at = bytes; at < bytes + n;) {
      struct inotify_event e;
      found = true;
      memcpy(&e, at, sizeof e);
      at += sizeof e + e.len;
      if (e.mask & IN_MOVE_SELF) inotify_rm_watch(w->events, e.wd);
      if (!(e.mask & (IN_IGNORED | IN_MOVE_SELF))) continue;
      for (size_t i = 0; i < w->folder_count; i++)
        if (w->folders[i].watch == e.wd) w->folders[i].watch = -1, w->unwatched = true;
    }
  return found;
}

static void compare_states(CagFileWatch *w) {
  for (size_t i = 0; i < w->file_count; i++) {
    File *f = &w->files[i];
    const State now = state_of(f->path);
    if (same_state(&now, &f->state)) continue;
    f->state = now;
    f->changed = true;
  }
}

bool cag_file_watch_look(CagFileWatch *w, const char **path) {
  bool found = false;
  const bool woken = read_events(w);
  if (woken || w->unwatched) {
    watch_folders(w);
    compare_states(w);
  }
  for (size_t i = 0; i < w->file_count; i++) {
    w->files[i].reported = w->files[i].changed;
    if (!w->files[i].changed) continue;
    if (!found && path) *path = w->files[i].path;
    w->files[i].changed = false;
    found = true;
  }
  return found;
}

const char *cag_file_watch_changed(const CagFileWatch *w, size_t i) {
  for (size_t k = 0; k < w->file_count; k++)
    if (w->files[k].reported && i-- == 0) return w->files[k].path;
  return NULL;
}

// Waits for an event or the next look, at most `timeout` milliseconds (-1: no limit). Returns false
// if a signal arrives.
static bool wait_once(const CagFileWatch *w, int timeout) {
  const int interval = cag_file_watch_interval(w);
  struct pollfd p = {.fd = w->events, .events = POLLIN};
  if (interval >= 0 && (timeout < 0 || interval < timeout)) timeout = interval;
  return poll(&p, w->events >= 0, timeout) >= 0;
}

bool cag_file_watch_wait(CagFileWatch *w, int timeout, int quiet, int most, const char **path) {
  const double begun = cag_clock_seconds();
  while (!cag_file_watch_look(w, path)) {
    const double left = timeout < 0 ? 0 : timeout - 1e3 * (cag_clock_seconds() - begun);
    if (timeout >= 0 && left <= 0) return false;
    if (!wait_once(w, timeout < 0 ? -1 : (int)left + 1)) return false;
  }
  const double noticed = cag_clock_seconds();
  for (double last = noticed;;) {
    const double now = cag_clock_seconds();
    const double left = quiet - 1e3 * (now - last);
    if (left <= 0 || 1e3 * (now - noticed) >= most) return true;
    if (!wait_once(w, (int)left + 1)) return true;
    if (cag_file_watch_look(w, NULL)) last = cag_clock_seconds();
  }
}
