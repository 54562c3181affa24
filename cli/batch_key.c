// The keys of tasks: hashes of everything on which an output depends.
//
// The files that a script reads are found in its text without parsing it. Every quoted text and
// every word after `import` counts if it is the name of a file, and scripts among these are
// searched in the same way. A name too many only causes an unnecessary rerun. Names that a script
// computes are not found.

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/batch.h"

// FNV-1a with 128 bits (Fowler, Noll, Vo): offset 6c62272e07bb014262b821756295c58d, prime 2^88 +
// 0x13b. It is not cryptographically secure, which is not needed here.
typedef unsigned __int128 Hash;

#define HASH_START ((Hash)0x6c62272e07bb0142 << 64 | 0x62b821756295c58d)
#define HASH_PRIME ((Hash)1 << 88 | 0x13b)

// Of larger files, only size and modification time are hashed.
#define READ_MAX ((size_t)64 << 20)
// Longer quoted texts are not file names.
#define NAME_LENGTH_MAX 255

static void add_bytes(Hash *h, const void *bytes, size_t n) {
  const unsigned char *at = bytes;
  for (size_t i = 0; i < n; i++) *h = (*h ^ at[i]) * HASH_PRIME;
}

// Adds a text with its terminator, so that "ab" "c" and "a" "bc" differ. NULL differs from the
// empty text.
static void add_text(Hash *h, const char *text) {
  if (text) add_bytes(h, text, strlen(text) + 1);
  else add_bytes(h, "\1", 1);
}

static void write_key(Hash h, char key[CAG_JOURNAL_KEY_SIZE]) {
  snprintf(key, CAG_JOURNAL_KEY_SIZE, "%016llx%016llx", (unsigned long long)(h >> 64),
           (unsigned long long)h);
}

// --- Files ---

typedef struct Files {
  char **paths; // already in the hash
  size_t count;
  const CagBatch *batch;
} Files;

static bool add_file(Files *f, Hash *h, const char *path);

static bool is_script(const char *path) {
  const size_t n = strlen(path);
  return n > 4 && strcmp(path + n - 4, ".cag") == 0;
}

// Adds the file of that name in the script's folder or on the module path.
static bool add_named(Files *f, Hash *h, const char *folder, const char *name) {
  const CagSessionOptions *o = &f->batch->tool->session;
  char path[PATH_MAX];
  struct stat st;
  for (size_t i = 0; i <= o->module_path_count; i++) {
    const char *base = i == 0 ? folder : o->module_path[i - 1];
    const int n = *name == '/' ? snprintf(path, sizeof path, "%s", name)
                               : snprintf(path, sizeof path, "%s/%s", base, name);
    if (n < (int)sizeof path && stat(path, &st) == 0 && S_ISREG(st.st_mode))
      return add_file(f, h, path);
  }
  return true;
}

// After `import`: parts.gripper is parts/gripper.cag.
static bool add_import(Files *f, Hash *h, const char *folder, const char *at) {
  char name[NAME_LENGTH_MAX + 1];
  at += strspn(at, " \t");
  const size_t n = strcspn(at, " \t\r\n;\"");
  if (!n || n + 4 > NAME_LENGTH_MAX) return true;
  for (size_t i = 0; i < n; i++) name[i] = at[i] == '.' ? '/' : at[i];
  strcpy(name + n, ".cag");
  return add_named(f, h, folder, name);
}

static bool add_quoted(Files *f, Hash *h, const char *folder, const char *start, size_t n) {
  char name[NAME_LENGTH_MAX + 1];
  if (!n || n > NAME_LENGTH_MAX) return true;
  memcpy(name, start, n);
  name[n] = '\0';
  return add_named(f, h, folder, name);
}

// Searches a text for names of files.
static bool add_names(Files *f, Hash *h, const char *folder, const char *text) {
  static const char WORD[] = "import";
  bool ok = true;
  for (const char *at = text; ok && (at = strstr(at, WORD)); at += sizeof WORD - 1)
    ok = add_import(f, h, folder, at + sizeof WORD - 1);
  // Each quote may start or end a text. Both are tried, because a comment may contain a single
  // quote.
  for (const char *at = text; ok && (at = strchr(at, '"')); at++) {
    const size_t n = strcspn(at + 1, "\"\n");
    if (at[1 + n] == '"') ok = add_quoted(f, h, folder, at + 1, n);
  }
  return ok;
}

static bool add_content(Files *f, Hash *h, const char *path, size_t size) {
  char *text = malloc(size + 1);
  FILE *file = text ? fopen(path, "rbe") : NULL;
  const size_t n = file ? fread(text, 1, size, file) : 0;
  if (file) fclose(file);
  bool ok = text != NULL;
  if (ok) {
    text[n] = '\0';
    add_bytes(h, text, n);
    add_bytes(h, &n, sizeof n);
  }
  if (ok && is_script(path)) {
    const char *slash = strrchr(path, '/');
    char *folder = strndup(path, slash > path ? (size_t)(slash - path) : 1);
    ok = folder && add_names(f, h, folder, text);
    free(folder);
  }
  free(text);
  return ok;
}

// Adds a file to the hash, once.
static bool add_file(Files *f, Hash *h, const char *path) {
  struct stat st;
  char *real = realpath(path, NULL);
  if (!real || stat(real, &st) != 0 || !S_ISREG(st.st_mode)) {
    free(real);
    return true;
  }
  for (size_t i = 0; i < f->count; i++)
    if (strcmp(f->paths[i], real) == 0) {
      free(real);
      return true;
    }
  char **paths = realloc(f->paths, (f->count + 1) * sizeof *paths);
  if (!paths) {
    free(real);
    return false;
  }
  f->paths = paths;
  f->paths[f->count++] = real;
  if ((size_t)st.st_size <= READ_MAX) return add_content(f, h, real, (size_t)st.st_size);
  add_bytes(h, &st.st_size, sizeof st.st_size);
  add_bytes(h, &st.st_mtim, sizeof st.st_mtim);
  return true;
}

static void free_files(Files *f) {
  for (size_t i = 0; i < f->count; i++) free(f->paths[i]);
  free(f->paths);
}

// --- Scripts ---

typedef struct {
  const char *name;
  Hash hash;
} Script;

static bool hash_script(const CagBatch *b, const char *name, Hash *h) {
  Files f = {.batch = b};
  char *path = cag_batch_path(b, name);
  *h = HASH_START;
  const bool ok = path && add_file(&f, h, path);
  free(path);
  free_files(&f);
  return ok;
}

// Returns the hash of a script, which is computed once.
static bool find_script(const CagBatch *b, Script *scripts, size_t *count, const char *name,
                        Hash *h) {
  // Rows of the same script are usually adjacent.
  for (size_t i = *count; i-- > 0;)
    if (strcmp(scripts[i].name, name) == 0) {
      *h = scripts[i].hash;
      return true;
    }
  if (!hash_script(b, name, h)) return false;
  scripts[(*count)++] = (Script){name, *h};
  return true;
}

// --- Keys ---

// Adds files that values of params name, relative to the script's folder.
static bool add_params(const CagBatch *b, Hash *h, const CagJob *job) {
  Files f = {.batch = b};
  char *script = cag_batch_path(b, job->cells[CAG_JOB_script]);
  char *slash = script ? strrchr(script, '/') : NULL;
  bool ok = slash != NULL;
  if (ok) *slash = '\0';
  for (size_t i = 0; ok && i < job->param_count; i++) {
    const char *value = job->params[i].value;
    size_t n = strlen(value);
    add_text(h, job->params[i].name);
    add_text(h, value);
    const bool quoted = n > 1 && value[0] == '"' && value[n - 1] == '"';
    ok = add_quoted(&f, h, script, value + quoted, n - (quoted ? 2 : 0));
  }
  free(script);
  free_files(&f);
  return ok;
}

// Adds the fields of the row and the options of the command line.
static bool hash_row(const CagBatch *b, size_t i, Hash script, Hash *h) {
  const CagTool *t = b->tool;
  const CagJob *job = &b->jobs.rows[i];
  *h = script;
  for (size_t c = 0; c < CAG_JOB_COLUMN_COUNT; c++)
    if (c != CAG_JOB_frames && c != CAG_JOB_tiles && c != CAG_JOB_output)
      add_text(h, job->cells[c]);
  for (size_t k = 0; k < t->define_count; k++) {
    add_text(h, t->defines[k].name);
    add_text(h, t->defines[k].value);
  }
  add_bytes(h, &t->session.tolerance, sizeof t->session.tolerance);
  return add_params(b, h, job);
}

// The script can read the length of the film and whether it repeats, so both are part of the key.
static void task_key(const CagBatch *b, const CagBatchRow *row, CagTask *task, const CagTask *whole,
                     Hash h) {
  add_text(&h, whole->output);
  if (row->film) {
    add_bytes(&h, &task->frame, sizeof task->frame);
    add_bytes(&h, &row->last, sizeof row->last);
    if (b->tool->loop) add_text(&h, "loop");
  }
  if (row->tile_columns) {
    const int tiles[] = {row->tile_columns, row->lines, task->tile};
    add_bytes(&h, tiles, sizeof tiles);
  }
  write_key(h, task->key);
}

// A tile is in a folder beside the journal, with its key as its name. The path is relative, because
// the renderer would interpret a % in an outer folder as the frame number.
static bool place_tile(const CagBatch *b, CagTask *task) {
  if (task->tile < 0) return true;
  return asprintf(&task->output, "%s/%s.exr", strrchr(b->tiles_folder, '/') + 1, task->key) >= 0;
}

bool cag_batch_make_keys(CagBatch *b) {
  Script *scripts = malloc((b->jobs.count + 1) * sizeof *scripts);
  size_t count = 0;
  bool ok = scripts != NULL;
  for (size_t i = 0; ok && i < b->jobs.count; i++) {
    const CagBatchRow *row = &b->rows[i];
    const size_t tiles = (size_t)(row->tile_columns * row->lines);
    Hash script, h;
    ok = find_script(b, scripts, &count, b->jobs.rows[i].cells[CAG_JOB_script], &script) &&
         hash_row(b, i, script, &h);
    for (size_t k = 0; ok && k < row->task_count; k++) {
      CagTask *task = &b->tasks[row->task + k];
      // The tasks of a picture are its tiles and the task that joins them.
      const CagTask *whole = &b->tasks[row->task + k / (tiles + 1) * (tiles + 1) + tiles];
      task_key(b, row, task, whole, h);
      ok = place_tile(b, task);
    }
  }
  free(scripts);
  return ok;
}
