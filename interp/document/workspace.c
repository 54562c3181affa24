// Workspaces: the texts of documents, their changes, and reading them.

#include "interp/document/document.h"

#include <string.h>
#include <sys/stat.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/utf8.h"
#include "interp/check/check.h"
#include "interp/doc/doc.h"

bool cag_document_guard(void (*work)(void *context), void *context) {
  return cag_memory_guard(work, context);
}

// --- Files ---

static FileState state_of(const char *path) {
  struct stat st;
  FileState s = {.size = -1};
  if (stat(path, &st) != 0) return s;
  s.seconds = st.st_mtim.tv_sec;
  s.nanoseconds = st.st_mtim.tv_nsec;
  s.size = st.st_size;
  return s;
}

static bool is_unchanged(const FileState *s) {
  const FileState now = state_of(s->path);
  return now.seconds == s->seconds && now.nanoseconds == s->nanoseconds && now.size == s->size;
}

static void free_states(Document *d) {
  for (size_t i = 0; i < d->import_count; i++) cag_free(d->imports[i].path);
  cag_free(d->imports);
  d->imports = NULL;
  d->import_count = 0;
}

static bool add_state(Document *d, const char *path) {
  if (!CAG_RESIZE(d->imports, d->import_count + 1)) return false;
  FileState s = state_of(path);
  s.path = cag_strdup(path);
  if (!s.path) return false;
  d->imports[d->import_count++] = s;
  return true;
}

// Returns the real path of a file, also if it does not exist yet.
static char *real_path(const char *file) {
  if (!strchr(file, '/')) return NULL;
  char *real = cag_realpath(file);
  return real ? real : cag_strdup(file);
}

// --- Documents ---

static void drop_tree(Document *d) {
  cag_session_free(d->session);
  cag_free(d->types);
  cag_free(d->occurrences);
  free_states(d);
  d->session = NULL;
  d->unit = NULL;
  d->checked = false;
  d->types = NULL;
  d->occurrences = NULL;
  d->occurrence_count = 0;
}

static void drop_lines(Document *d) {
  cag_free(d->lines);
  d->lines = NULL;
  d->line_count = 0;
}

static void drop_text(Document *d) {
  drop_tree(d);
  drop_lines(d);
  cag_free(d->text);
  d->text = NULL;
  d->length = d->capacity = 0;
}

void cag_document_rest(Document *d) {
  if (!d->open) drop_text(d);
}

static void free_document(Document *d) {
  drop_text(d);
  cag_free(d->file);
  cag_free(d->path);
  cag_free(d);
}

// Texts of open documents replace files.
static const char *find_open_text(void *context, const char *path, size_t *length) {
  const CagWorkspace *w = context;
  for (size_t i = 0; i < w->count; i++) {
    const Document *d = w->documents[i];
    if (!d->open || !d->path || strcmp(d->path, path) != 0) continue;
    *length = d->length;
    return d->text;
  }
  return NULL;
}

CagWorkspace *cag_workspace_new(const CagSessionOptions *options) {
  CagWorkspace *w = cag_calloc(1, sizeof *w);
  if (!w) return NULL;
  cag_session_options_init(&w->options);
  if (options) w->options = *options;
  w->sink = fopen("/dev/null", "w");
  w->options.out = w->options.messages = w->sink ? w->sink : stderr;
  w->options.overdue = NULL;
  w->options.find_text = find_open_text;
  w->options.find_text_context = w;
  return w;
}

void cag_workspace_free(CagWorkspace *w) {
  if (!w) return;
  for (size_t i = 0; i < w->count; i++) free_document(w->documents[i]);
  cag_free(w->documents);
  if (w->sink) fclose(w->sink);
  cag_free(w);
}

// Most calls ask about the same document as the one before.
static Document *find(CagWorkspace *w, const char *file) {
  if (w->last && strcmp(w->last->file, file) == 0) return w->last;
  for (size_t i = 0; i < w->count; i++)
    if (strcmp(w->documents[i]->file, file) == 0) return w->last = w->documents[i];
  return NULL;
}

Document *cag_workspace_document(CagWorkspace *w, const char *file) {
  Document *d = find(w, file);
  if (d) return d;
  d = cag_calloc(1, sizeof *d);
  if (!d) return NULL;
  d->file = cag_strdup(file);
  d->path = real_path(file);
  if (d->file && CAG_RESERVE(w->documents, w->capacity, w->count + 1))
    return w->documents[w->count++] = d;
  free_document(d);
  return NULL;
}

// --- Changes ---

static bool imports_path(const Document *d, const char *path) {
  const CagVm *vm = d->session->vm;
  for (size_t i = 0; vm && path && i < vm->module_count; i++)
    if (vm->modules[i] != d->unit && vm->modules[i]->path &&
        strcmp(vm->modules[i]->path, path) == 0)
      return true;
  const CagModuleAst *ast = d->unit ? d->unit->ast : NULL;
  for (size_t i = 0; ast && i < ast->count; i++) // a missing module may be this one now
    if (ast->statements[i]->kind == CAG_STATEMENT_IMPORT &&
        ast->statements[i]->as.import.module == CAG_NO_MODULE)
      return true;
  return false;
}

// Forgets what was derived from the text of a document, also in documents that import it.
static void mark_changed(CagWorkspace *w, const Document *changed) {
  for (size_t i = 0; i < w->count; i++) {
    Document *d = w->documents[i];
    if (d != changed && !(d->session && imports_path(d, changed->path))) continue;
    drop_tree(d);
    d->stale = true;
  }
}

bool cag_workspace_open(CagWorkspace *w, const char *file, const char *text, size_t length) {
  Document *d = cag_workspace_document(w, file);
  char *copy = length <= CAG_SOURCE_MAX ? cag_malloc(length + 1) : NULL;
  if (!d || !copy) {
    cag_free(copy);
    return false;
  }
  memcpy(copy, text, length);
  copy[length] = 0;
  drop_text(d);
  d->text = copy;
  d->length = length;
  d->capacity = length + 1;
  d->open = true;
  mark_changed(w, d);
  return true;
}

bool cag_workspace_change(CagWorkspace *w, const char *file, size_t start, size_t end,
                          const char *text, size_t length) {
  Document *d = find(w, file);
  if (!d || !d->open || start > end || end > d->length) return false;
  const size_t rest = d->length - end, after = start + length + rest;
  if (length > CAG_SOURCE_MAX || after > CAG_SOURCE_MAX ||
      !CAG_RESERVE(d->text, d->capacity, after + 1))
    return false;
  memmove(d->text + start + length, d->text + end, rest);
  memcpy(d->text + start, text, length);
  d->length = after;
  d->text[after] = 0;
  drop_lines(d);
  if (d->session || !d->stale) mark_changed(w, d);
  return true;
}

void cag_workspace_close(CagWorkspace *w, const char *file) {
  Document *d = find(w, file);
  if (!d || !d->open) return;
  d->open = false;
  drop_text(d);
  mark_changed(w, d);
  d->stale = false;
}

void cag_workspace_add_file(CagWorkspace *w, const char *file) {
  Document *d = cag_workspace_document(w, file);
  if (d) d->listed = true;
}

void cag_workspace_remove_file(CagWorkspace *w, const char *file) {
  Document *d = find(w, file);
  if (d) d->listed = false;
}

void cag_workspace_file_changed(CagWorkspace *w, const char *file) {
  Document *d = cag_workspace_document(w, file);
  if (!d || d->open) return;
  drop_text(d);
  mark_changed(w, d);
}

bool cag_document_is_stale(CagWorkspace *w, const char *file) {
  const Document *d = find(w, file);
  return d && d->open && d->stale;
}

// --- Reading ---

static bool read_file(Document *d) {
  const char *why;
  if (!d->path) return false;
  d->text = cag_read_whole_file(d->path, &d->length, &why);
  return d->text != NULL;
}

static bool read_library(Document *d) {
  const char *text;
  size_t length;
  const char *name = cag_doc_library(d->file, &text, &length);
  if (!name || strcmp(name, d->file) != 0) return false;
  d->text = cag_strndup(text, length);
  d->length = length;
  return d->text != NULL;
}

bool cag_document_has_text(CagWorkspace *w, Document *d) {
  (void)w;
  return d->text || (d->path ? read_file(d) : read_library(d));
}

static bool load(CagVm *vm, void *context) {
  Document *d = context;
  d->unit = cag_load_document(vm, d->file, d->path, d->text, d->length);
  return true;
}

// Notes the state of all files that were read, except for those that open documents replace.
static bool note_files(const CagWorkspace *w, Document *d) {
  const CagVm *vm = d->session->vm;
  size_t length;
  for (size_t i = 0; i < vm->module_count; i++) {
    const CagModuleUnit *m = vm->modules[i];
    const bool is_open = m == d->unit && d->open;
    if (!m->path || is_open || find_open_text((void *)w, m->path, &length)) continue;
    if (!add_state(d, m->path)) return false;
  }
  return true;
}

static bool make_tree(CagWorkspace *w, Document *d) {
  d->session = cag_session_new(&w->options);
  CagVm *vm = d->session ? cag_session_vm(d->session) : NULL;
  if (!vm) return false;
  vm->errors.most = d->session->diagnostics.most = PROBLEMS_MAX;
  cag_session_renew_time(d->session);
  const int status = cag_session_work(d->session, load, d);
  if (status == CAG_STATUS_LIMIT || status == CAG_STATUS_INTERRUPTED || !d->unit) return false;
  return note_files(w, d);
}

bool cag_document_ready(CagWorkspace *w, Document *d) {
  bool same = d->session != NULL;
  for (size_t i = 0; same && i < d->import_count; i++) same = is_unchanged(&d->imports[i]);
  if (same) return true;
  if (d->session && d->open) d->stale = true;
  if (d->open) drop_tree(d);
  else drop_text(d);
  if (cag_document_has_text(w, d) && make_tree(w, d)) {
    cag_document_list(d);
    return true;
  }
  drop_tree(d);
  return false;
}

Document *cag_document_get(CagWorkspace *w, const char *file) {
  Document *d = cag_workspace_document(w, file);
  return d && cag_document_ready(w, d) ? d : NULL;
}

static bool check(CagVm *vm, void *context) {
  Document *d = context;
  cag_diagnostics_move(&vm->errors, &d->session->diagnostics); // those of reading
  if (d->unit->ast && d->unit->resolved) cag_check_module_types(vm, d->unit, d->types);
  return true;
}

bool cag_document_make_checked(CagWorkspace *w, Document *d) {
  if (!cag_document_ready(w, d)) return false;
  if (d->checked) return true;
  const size_t n = d->unit->ast ? d->unit->ast->top_count : 0;
  d->types = cag_calloc(n + 1, sizeof *d->types);
  if (!d->types) return false;
  const int status = cag_session_work(d->session, check, d);
  d->checked = status != CAG_STATUS_LIMIT && status != CAG_STATUS_INTERRUPTED;
  if (!d->checked) drop_tree(d);
  return d->checked;
}

// --- Places ---

const char *cag_document_file_of(const CagWorkspace *w, const Document *d,
                                 const CagModuleUnit *unit) {
  if (unit == d->unit) return d->file;
  if (!unit->path) return unit->name;
  const char *file = unit->path;
  for (size_t i = 0; i < w->count; i++) {
    const Document *other = w->documents[i];
    if (!other->path || strcmp(other->path, unit->path) != 0) continue;
    if (other->open) return other->file;
    file = other->file;
  }
  return file;
}

CagPlace cag_document_place(const CagWorkspace *w, const Document *d, const CagModuleUnit *unit,
                            CagSpan span) {
  return (CagPlace){cag_document_file_of(w, d, unit), span.start, span.end};
}

const char *cag_document_text(CagWorkspace *w, const char *file, size_t *length) {
  Document *d = cag_workspace_document(w, file);
  *length = 0;
  if (!d || !cag_document_has_text(w, d)) return NULL;
  *length = d->length;
  return d->text;
}

static bool find_lines(Document *d) {
  if (d->lines) return true;
  size_t count = 1, i = 0;
  for (const char *at = d->text; (at = memchr(at, '\n', d->length - (size_t)(at - d->text))); at++)
    count++;
  d->lines = cag_malloc(count * sizeof *d->lines);
  if (!d->lines) return false;
  d->lines[i++] = 0;
  for (const char *at = d->text; i < count; at++) {
    at = memchr(at, '\n', d->length - (size_t)(at - d->text));
    d->lines[i++] = (size_t)(at - d->text) + 1;
  }
  d->line_count = count;
  return true;
}

// Returns the width of the character that starts with this byte. A byte that is not UTF-8 counts as
// one.
static size_t width_of(unsigned char first, CagColumns columns) {
  return columns == CAG_COLUMNS_UTF16 && first >= 0xF0 ? 2 : 1;
}

static bool is_counted(char c, CagColumns columns) {
  return columns == CAG_COLUMNS_UTF8 || !cag_utf8_is_within(c);
}

void cag_document_position(CagWorkspace *w, const char *file, size_t offset, CagColumns columns,
                           size_t *line, size_t *column) {
  Document *d = cag_workspace_document(w, file);
  *line = *column = 0;
  if (!d || !cag_document_has_text(w, d) || !find_lines(d)) return;
  if (offset > d->length) offset = d->length;
  size_t low = 0, high = d->line_count; // lines[low] <= offset < lines[high]
  while (high - low > 1) {
    const size_t middle = low + (high - low) / 2;
    if (d->lines[middle] <= offset) low = middle;
    else high = middle;
  }
  *line = low;
  for (size_t i = d->lines[low]; i < offset; i++)
    if (is_counted(d->text[i], columns)) *column += width_of((unsigned char)d->text[i], columns);
}

size_t cag_document_offset(CagWorkspace *w, const char *file, size_t line, size_t column,
                           CagColumns columns) {
  Document *d = cag_workspace_document(w, file);
  if (!d || !cag_document_has_text(w, d) || !find_lines(d)) return 0;
  if (line >= d->line_count) return d->length;
  size_t at = d->lines[line], end = line + 1 < d->line_count ? d->lines[line + 1] - 1 : d->length;
  if (end > at && d->text[end - 1] == '\r') end--;
  while (at < end && column > 0) {
    const size_t width = width_of((unsigned char)d->text[at], columns);
    if (width > column) break; // within a character
    column -= width;
    at++;
    while (columns != CAG_COLUMNS_UTF8 && at < end && cag_utf8_is_within(d->text[at])) at++;
  }
  return cag_utf8_start(d->text, at);
}

// --- All documents ---

// Tests whether the file of a document is open under another name.
static bool is_replaced(const CagWorkspace *w, const Document *d) {
  size_t length;
  return !d->open && d->path && find_open_text((void *)w, d->path, &length);
}

static bool has_word(const Document *d, const char *word) {
  return !*word || memmem(d->text, d->length, word, strlen(word));
}

void cag_workspace_each(CagWorkspace *w, const char *word, bool (*each)(void *context, Document *d),
                        void *context) {
  for (int round = 0; round < 2; round++)
    for (size_t i = 0; i < w->count; i++) {
      Document *d = w->documents[i];
      const bool was_ready = d->session != NULL;
      if (round == 0 ? !d->open : d->open || !d->listed) continue;
      if (is_replaced(w, d) || !cag_document_has_text(w, d)) continue;
      const bool go_on = !has_word(d, word) || !cag_document_ready(w, d) || each(context, d);
      if (!was_ready) cag_document_rest(d);
      if (!go_on) return;
    }
}
