// Documentation of scripts and of the library, read with a session and written as text.

#include <string.h>

#include "interp/session/session.h"
#include "interp/session/site.h"

typedef struct Reading {
  const char *name, *text;
  size_t length;
  CagDocModule *out;
} Reading;

static bool read(CagVm *vm, void *context) {
  Reading *r = context;
  const CagModuleAst *m = cag_read_script(vm, r->name, r->text, r->length);
  if (m) cag_doc_module_read(m, r->name, r->out);
  return m != NULL;
}

int cag_session_read_doc(CagSession *s, const char *name, const char *text, size_t length,
                         CagDocModule *out) {
  Reading r = {name, text, length, out};
  *out = (CagDocModule){0};
  cag_session_drop_vm(s);
  return cag_session_work(s, read, &r);
}

typedef struct Written {
  CagDocWriter writer;
  const CagDocModule *module;
} Written;

static void write_read(void *context) {
  const Written *w = context;
  cag_doc_write_module(&w->writer, w->module);
}

int cag_session_document_text(CagSession *s, const char *name, const char *text, size_t length,
                              bool styled, FILE *out) {
  if (!cag_session_begin(s)) return CAG_STATUS_USAGE;
  CagDocModule m;
  const int status = cag_session_read_doc(s, name, text, length, &m);
  Written w = {{out, styled}, &m};
  const bool done = status != CAG_STATUS_OK || cag_memory_guard(write_read, &w);
  cag_doc_module_free(&m);
  return cag_session_end(s, done ? status : cag_session_fail_memory(s));
}

// Writes a library module (`member` NULL), or one of its definitions. Returns false if there is
// none.
static bool write_library(CagSession *s, const char *name, const char *member,
                          const CagDocWriter *w) {
  const char *text;
  size_t length;
  CagDocModule m;
  const char *module = cag_doc_library(name, &text, &length);
  if (!module) return false;
  bool found = cag_session_read_doc(s, module, text, length, &m) == CAG_STATUS_OK;
  if (found && !member) cag_doc_write_module(w, &m);
  if (found && member) {
    found = false;
    for (size_t i = 0; i < m.count && !found; i++) {
      if (strcmp(m.entries[i].name, member) != 0) continue;
      cag_doc_write_entry(w, &m, &m.entries[i]);
      found = true;
    }
  }
  cag_doc_module_free(&m);
  return found;
}

// "robots.puma560" and "std.robots.puma560": splits the name at its last point.
static bool write_member(CagSession *s, const char *name, const CagDocWriter *w) {
  const char *dot = strrchr(name, '.');
  char module[128];
  if (!dot || (size_t)(dot - name) >= sizeof module) return false;
  memcpy(module, name, (size_t)(dot - name));
  module[dot - name] = 0;
  return write_library(s, module, dot + 1, w);
}

// Writes a chapter of the manual unchanged.
static bool write_guide(const char *name, FILE *out) {
  char path[128];
  snprintf(path, sizeof path, "docs/%s.md", name);
  const CagDocument *d = cag_document(path);
  if (d) fwrite(d->text, 1, d->length, out);
  return d != NULL;
}

static bool document(CagSession *s, const char *name, bool styled, FILE *out) {
  const CagDocWriter w = {out, styled};
  if (!name) return cag_doc_write_overview(&w), true;
  const size_t index = cag_builtin_find(name);
  if (index != (size_t)-1) cag_doc_write_builtin(&w, index);
  const bool is_word = cag_doc_write_word(&w, name, index != (size_t)-1);
  if (is_word || index != (size_t)-1) return true;
  return write_library(s, name, NULL, &w) || write_member(s, name, &w) || write_guide(name, out) ||
         cag_explain(name, out);
}

typedef struct Question {
  CagSession *session;
  const char *name;
  bool styled, found;
  FILE *out;
} Question;

static void answer(void *context) {
  Question *q = context;
  q->found = document(q->session, q->name, q->styled, q->out);
}

bool cag_session_document(CagSession *s, const char *name, bool styled, FILE *out) {
  if (!cag_session_begin(s)) return false;
  Question q = {s, name, styled, false, out};
  if (!cag_memory_guard(answer, &q)) cag_session_fail_memory(s);
  cag_session_end(s, CAG_STATUS_OK);
  return q.found;
}

void cag_session_document_names(CagSession *s, void (*give)(void *context, const char *name),
                                void *context) {
  if (!cag_session_begin(s)) return;
  for (size_t i = 0; i < cag_builtin_count(); i++) give(context, cag_builtin_name(i));
  for (size_t i = 0; cag_doc_module_name(i); i++) {
    const char *text, *module = cag_doc_module_name(i);
    size_t length;
    CagDocModule m;
    give(context, module);
    give(context, module + 4);
    cag_doc_library(module, &text, &length);
    if (cag_session_read_doc(s, module, text, length, &m) == CAG_STATUS_OK)
      for (size_t k = 0; k < m.count; k++) {
        char name[256];
        snprintf(name, sizeof name, "%s.%s", module, m.entries[k].name);
        give(context, name);
        give(context, name + 4);
      }
    cag_doc_module_free(&m);
  }
  const CagDocChapter *c;
  const char *code, *reason, *word;
  for (size_t i = 0; cag_doc_word_row(i, &word, NULL, NULL); i++) give(context, word);
  for (size_t i = 0; (c = cag_doc_chapter(i)); i++) give(context, c->name);
  for (size_t i = 0; cag_error_kind(i, &code, &reason, NULL, NULL); i++) {
    give(context, code);
    give(context, reason);
  }
  cag_session_end(s, CAG_STATUS_OK);
}
