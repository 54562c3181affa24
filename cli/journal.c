// The journal of a batch (see journal.h for the meaning of its lines).

#include "cli/journal.h"

#include <cJSON.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *const WHATS[] = {"done", "failed", "submitted", "collected"};
#define WHAT_COUNT (sizeof WHATS / sizeof *WHATS)

// The maximum length of a line that cag_journal_add writes.
#define LINE_MAX_BYTES 256

static bool fail(const CagJournal *j, const char *help, const char *problem, CagError *err) {
  return cag_fail_io(err, CAG_E_FILE, help, "the journal '%s': %s", j->path, problem);
}

// --- Reading ---

// Parses a line. Returns false if it is invalid, for example incomplete.
static bool read_entry(const char *line, size_t length, CagJournalEntry *e) {
  cJSON *object = cJSON_ParseWithLength(line, length);
  const char *what = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, "what"));
  const char *key = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, "key"));
  const cJSON *seconds = cJSON_GetObjectItemCaseSensitive(object, "seconds");
  const cJSON *memory = cJSON_GetObjectItemCaseSensitive(object, "memory");
  const cJSON *attempts = cJSON_GetObjectItemCaseSensitive(object, "attempts");
  size_t kind = 0;
  while (what && kind < WHAT_COUNT && strcmp(what, WHATS[kind]) != 0) kind++;
  const bool good = what && kind < WHAT_COUNT && key && strlen(key) < CAG_JOURNAL_KEY_SIZE;
  if (good) {
    *e = (CagJournalEntry){.what = (CagJournalWhat)kind};
    strcpy(e->key, key);
    if (cJSON_IsNumber(seconds)) e->seconds = seconds->valuedouble;
    if (cJSON_IsNumber(memory) && memory->valuedouble > 0) e->memory = (size_t)memory->valuedouble;
    if (cJSON_IsNumber(attempts)) e->attempts = attempts->valueint;
  }
  cJSON_Delete(object);
  return good;
}

static bool keep_entry(CagJournal *j, size_t *capacity, const CagJournalEntry *e) {
  if (e->what == CAG_JOURNAL_SUBMITTED) strcpy(j->job, e->key);
  if (e->what == CAG_JOURNAL_COLLECTED) j->job[0] = '\0';
  if (e->what == CAG_JOURNAL_SUBMITTED || e->what == CAG_JOURNAL_COLLECTED) return true;
  if (j->count == *capacity) {
    const size_t larger = 2 * *capacity + 64;
    CagJournalEntry *entries = realloc(j->entries, larger * sizeof *entries);
    if (!entries) return false;
    j->entries = entries;
    *capacity = larger;
  }
  j->entries[j->count++] = *e;
  return true;
}

// Tests whether a line starts like those of a journal, as far as it goes; an incomplete one may be
// short.
static bool begins_as_ours(const char *line, size_t length) {
  static const char START[] = "{\"what\":\"";
  return memcmp(line, START, length < sizeof START - 1 ? length : sizeof START - 1) == 0;
}

// Reads the complete lines of the text. A file without a valid line, which contains something that
// is not the start of one, is not a journal.
static bool read_lines(CagJournal *j, const char *text, size_t length, CagError *err) {
  size_t capacity = 0, others = 0, ours = 0;
  for (const char *at = text, *end = text + length; at < end;) {
    const char *newline = memchr(at, '\n', (size_t)(end - at));
    const size_t n = (size_t)((newline ? newline : end) - at);
    others += !begins_as_ours(at, n);
    if (!newline) break;
    CagJournalEntry e;
    const bool good = read_entry(at, n, &e);
    if (good && !keep_entry(j, &capacity, &e))
      return cag_fail_io(err, CAG_E_LIMIT, NULL, "out of memory");
    ours += good;
    at = newline + 1;
  }
  if (others && !ours) return fail(j, "move it away", "the file is not a journal", err);
  return true;
}

static char *read_file(int fd, size_t *length) {
  struct stat st;
  if (fstat(fd, &st) != 0) return NULL;
  char *text = malloc((size_t)st.st_size + 1);
  *length = 0;
  while (text && *length < (size_t)st.st_size) {
    const ssize_t n = read(fd, text + *length, (size_t)st.st_size - *length);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    *length += (size_t)n;
  }
  return text;
}

// Sorts by key, and for each key, the newest entry first. The sort is not stable, so the entry's
// number is part of the order.
typedef struct {
  CagJournalEntry entry;
  size_t number;
} Numbered;

static int by_key_newest_first(const void *a, const void *b) {
  const Numbered *p = a, *q = b;
  const int order = strcmp(p->entry.key, q->entry.key);
  return order ? order : (p->number < q->number) - (p->number > q->number);
}

// Keeps the newest entry of each key, sorted by key.
static bool sort_entries(CagJournal *j) {
  Numbered *all = malloc((j->count + 1) * sizeof *all);
  if (!all) return false;
  for (size_t i = 0; i < j->count; i++) all[i] = (Numbered){j->entries[i], i};
  qsort(all, j->count, sizeof *all, by_key_newest_first);
  size_t kept = 0;
  for (size_t i = 0; i < j->count; i++)
    if (i == 0 || strcmp(all[i].entry.key, all[i - 1].entry.key) != 0)
      j->entries[kept++] = all[i].entry;
  j->count = kept;
  free(all);
  return true;
}

static int by_key(const void *a, const void *b) {
  return strcmp(((const CagJournalEntry *)a)->key, ((const CagJournalEntry *)b)->key);
}

const CagJournalEntry *cag_journal_find(const CagJournal *j, const char *key) {
  CagJournalEntry wanted = {0};
  if (!j->count) return NULL;
  snprintf(wanted.key, sizeof wanted.key, "%s", key);
  return bsearch(&wanted, j->entries, j->count, sizeof *j->entries, by_key);
}

static bool read_journal(CagJournal *j, CagError *err) {
  size_t length = 0;
  char *text = read_file(j->fd, &length);
  if (!text) return fail(j, NULL, strerror(errno), err);
  bool ok = read_lines(j, text, length, err);
  // Do not append to an incomplete line.
  if (ok && length && text[length - 1] != '\n' && write(j->fd, "\n", 1) != 1)
    ok = fail(j, NULL, strerror(errno), err);
  if (ok && !sort_entries(j)) ok = cag_fail_io(err, CAG_E_LIMIT, NULL, "out of memory");
  free(text);
  return ok;
}

bool cag_journal_open(CagJournal *j, const char *path, bool fresh, CagError *err) {
  struct stat st;
  *j = (CagJournal){.fd = -1, .path = path};
  j->fd = open(path, O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NONBLOCK, 0666);
  if (j->fd < 0)
    return cag_fail_io(
        err, CAG_E_FILE,
        "the journal is written to the folder of the table; make this folder writable",
        "cannot open the journal '%s': %s", path, strerror(errno));
  bool ok = true;
  if (fstat(j->fd, &st) != 0 || !S_ISREG(st.st_mode))
    ok = fail(j, "move it away", "it is not a regular file", err);
  else if (flock(j->fd, LOCK_EX | LOCK_NB) != 0)
    ok = fail(j, "wait until it has ended", "another batch of this table is running", err);
  else ok = read_journal(j, err);
  if (ok && fresh) {
    free(j->entries);
    j->entries = NULL;
    j->count = 0;
    j->job[0] = '\0';
    if (ftruncate(j->fd, 0) != 0) ok = fail(j, NULL, strerror(errno), err);
  }
  if (!ok) cag_journal_close(j);
  return ok;
}

void cag_journal_close(CagJournal *j) {
  if (j->fd >= 0) close(j->fd);
  free(j->entries);
  *j = (CagJournal){.fd = -1};
}

// --- Writing ---

static bool fail_write(const CagJournal *j, CagError *err) {
  return cag_fail_io(err, CAG_E_FILE,
                     "free some space; without the journal, finished rows would run again",
                     "cannot write the journal '%s': %s", j->path, strerror(errno));
}

bool cag_journal_write(CagJournal *j, const CagJournalEntry *e, CagError *err) {
  char line[LINE_MAX_BYTES];
  const int n = snprintf(line, sizeof line,
                         "{\"what\":\"%s\",\"key\":\"%s\",\"seconds\":%.3f,\"memory\":%zu,"
                         "\"attempts\":%d}\n",
                         WHATS[e->what], e->key, e->seconds, e->memory, e->attempts);
  // A single call, so that after a kill, either nothing, the whole line, or an incomplete line that
  // is ignored has been written.
  const ssize_t written = write(j->fd, line, (size_t)n);
  j->unsynced = true;
  if (written == n) return true;
  if (written >= 0) errno = ENOSPC;
  return fail_write(j, err);
}

bool cag_journal_sync(CagJournal *j, CagError *err) {
  if (!j->unsynced) return true;
  j->unsynced = false;
  return fdatasync(j->fd) == 0 || fail_write(j, err);
}

bool cag_journal_add(CagJournal *j, const CagJournalEntry *e, CagError *err) {
  return cag_journal_write(j, e, err) && cag_journal_sync(j, err);
}
