// The pages of modules: of the library, and of scripts that are added to the site.
//
// Both are shelves of modules. They differ only in their location, in the name of their search
// results, and in how an example imports the module.

#include <string.h>

#include "base/memory.h"
#include "interp/session/site.h"

static void write_text(FILE *out, const char *text) { cag_html_text(out, text, strlen(text)); }

// --- Parameters ---

void cag_site_parameter(const CagSitePage *p, const char *type, const char *meaning,
                        const char *name, const char *fallback) {
  fputs("<tr><td><code>", p->out);
  write_text(p->out, name);
  fputs("</code></td><td>", p->out);
  write_text(p->out, type);
  fputs("</td><td>", p->out);
  if (fallback) {
    fputs("<code>", p->out);
    cag_html_script(p->out, p->root, fallback, cag_doc_default(fallback));
    fputs("</code>", p->out);
  }
  fputs("</td><td>", p->out);
  cag_html_prose(p->out, p->root, meaning, strlen(meaning));
  fputs("</td></tr>\n", p->out);
}

void cag_site_begin_parameters(const CagSitePage *p) {
  fputs("<table class=\"parameters\"><thead><tr><th>parameter</th><th>type</th><th>default</th>"
        "<th></th></tr></thead><tbody>\n",
        p->out);
}

// Writes the description of a parameter from the /// lines, which may have a type before a colon.
static void write_said_parameter(const CagSitePage *p, const CagDocArgument *a) {
  const char *colon = strstr(a->meaning, ": ");
  char *type = cag_strndup(a->meaning, colon ? (size_t)(colon - a->meaning) : 0);
  if (!type) cag_memory_leave();
  cag_site_parameter(p, type, colon ? colon + 2 : a->meaning, a->name, a->fallback);
  cag_free(type);
}

// --- A module ---

// The location of a module's page.
typedef struct Shelf {
  const char *folder, *section, *kind;
} Shelf;

static const Shelf library = {"library", "Library", "library"},
                   scripts = {"scripts", "Scripts", "script"};

typedef struct Book {
  const Shelf *shelf;
  const CagDocModule *module;
  const CagSiteScript *script; // NULL: of the library
  const char *page;            // its name, without folder and extension
} Book;

// Returns the line that imports the module, as in its purpose; allocated with malloc.
static char *import_line(const CagDocModule *m) {
  const char *shown = strstr(m->purpose, m->name);
  const char *begin = shown && shown - m->purpose >= 7 ? shown - 7 : NULL;
  if (begin && strncmp(begin, "import ", 7) == 0) return cag_strndup(begin, strcspn(begin, "\n"));
  return cag_doc_text("import %s", m->name);
}

// Returns the import for an example of the module, allocated with malloc, or NULL if the example
// contains it.
static char *example_import(const Book *b, const char *text) {
  if (b->script) return cag_doc_script_import(b->module, b->script->file, text);
  return strstr(text, "import ") ? NULL : import_line(b->module);
}

static void write_module_example(const CagSitePage *p, const Book *b, const char *text) {
  char *import = example_import(b, text);
  char *whole = cag_doc_text("%s%s%s", import ? import : "", import ? "\n" : "", text);
  cag_html_example(p->site,
                   &(CagSiteSpot){.out = p->out,
                                  .root = p->root,
                                  .about = b->module->name,
                                  .folder = b->script ? b->script->folder : NULL},
                   whole, strlen(whole));
  cag_free(whole);
  cag_free(import);
}

// Documentation is prose, with scripts indented by four. Returns, with `prose_only`, the text from
// its first script on, or else its end.
static const char *write_doc_text(const CagSitePage *p, const Book *b, const char *text,
                                  bool prose_only) {
  bool is_code;
  for (size_t n; *text; text += n) {
    n = cag_doc_part(text, &is_code);
    if (is_code && prose_only) break;
    char *part = cag_doc_part_text(text, n, is_code);
    if (is_code) write_module_example(p, b, part);
    else cag_html_markdown(p->site, p->out, p->root, b->module->name, part, strlen(part));
    cag_free(part);
  }
  return text;
}

// Returns the description of a parameter from other sources than its /// line, or NULL.
static const CagDocParameter *known_parameter(const Book *b, const CagDocEntry *e, size_t i) {
  return cag_doc_module_parameter(b->module->name, e->name, e->arguments[i].name);
}

// Writes the table of parameters if at least one is described.
static void write_arguments(const CagSitePage *p, const Book *b, const CagDocEntry *e) {
  bool told = false;
  for (size_t i = 0; i < e->argument_count; i++)
    told |= e->arguments[i].meaning || e->arguments[i].fallback || known_parameter(b, e, i);
  if (!told) return;
  cag_site_begin_parameters(p);
  for (size_t i = 0; i < e->argument_count; i++) {
    const CagDocArgument *a = &e->arguments[i];
    const CagDocParameter *known = known_parameter(b, e, i);
    if (a->meaning) write_said_parameter(p, a);
    else
      cag_site_parameter(p, known ? known->type : "", known ? known->meaning : "", a->name,
                         a->fallback);
  }
  fputs("</tbody></table>\n", p->out);
}

// Returns the first sentence of the description of a definition: of its text, or its label.
static const char *sentence_of(const CagDocEntry *e, size_t *length) {
  const char *text = e->text && *e->text ? e->text : e->label ? e->label : "";
  *length = cag_doc_sentence(text);
  return text;
}

static void write_definition(const CagSitePage *p, const Book *b, const CagDocEntry *e) {
  char url[512], name[256];
  size_t n;
  const char *said = sentence_of(e, &n);
  snprintf(url, sizeof url, "%s/%s.html#%s", b->shelf->folder, b->page, e->name);
  snprintf(name, sizeof name, "%s.%s", b->page, e->name);
  cag_site_find(p->site, name, b->shelf->kind, url, said, n);
  fprintf(p->out, "<section><p class=\"signature\" id=\"%s\"><code>", e->name);
  cag_html_script(p->out, p->root, e->signature, strlen(e->signature));
  fputs("</code></p>\n", p->out);
  const char *examples = e->text ? write_doc_text(p, b, e->text, true) : "";
  write_arguments(p, b, e);
  write_doc_text(p, b, examples, false);
  fputs("</section>\n", p->out);
}

static void module_page(CagSite *s, const Book *b) {
  CagSitePage p;
  char path[256];
  const CagDocModule *m = b->module;
  snprintf(path, sizeof path, "%s/%s.html", b->shelf->folder, b->page);
  cag_site_find(s, m->name, b->script ? "script" : "module", path, m->purpose,
                cag_doc_sentence(m->purpose));
  cag_site_begin(s, &p, path, m->name, b->shelf->section);
  fputs("<div class=\"with-aside\">\n<article>\n<h1>", p.out);
  write_text(p.out, m->name);
  fputs("</h1>\n", p.out);
  cag_html_markdown(s, p.out, p.root, m->name, m->purpose, strlen(m->purpose));
  for (size_t i = 0; i < m->count; i++) write_definition(&p, b, &m->entries[i]);
  fputs("</article>\n<aside><h2>", p.out);
  write_text(p.out, m->name);
  fputs("</h2><ul>\n", p.out);
  for (size_t i = 0; i < m->count; i++)
    fprintf(p.out, "<li><a href=\"#%s\">%s</a></li>\n", m->entries[i].name, m->entries[i].name);
  fputs("</ul></aside>\n</div>\n", p.out);
  cag_site_end(&p);
}

// Writes an item of a list of modules.
static void write_item(const CagSitePage *p, const Book *b) {
  fprintf(p->out, "<dt><a href=\"%s.html\"><code>", b->page);
  write_text(p->out, b->module->name);
  fputs("</code></a></dt><dd>", p->out);
  cag_html_prose(p->out, p->root, b->module->purpose, cag_doc_sentence(b->module->purpose));
  fputs("</dd>\n", p->out);
}

// --- Library ---

static Book library_book(const CagSite *s, size_t i) {
  return (Book){&library, &s->modules[i], NULL, s->modules[i].name + strlen("std.")};
}

void cag_site_library(CagSite *s) {
  CagSitePage p;
  cag_site_begin(s, &p, "library/index.html", "Library", "Library");
  fputs("<h1>Library</h1>\n<p>Modules that come with the program: <code>import "
        "std.materials</code> binds "
        "<code>materials</code>.</p>\n<dl class=\"modules\">\n",
        p.out);
  for (size_t i = 0; i < s->module_count; i++) {
    const Book b = library_book(s, i);
    write_item(&p, &b);
  }
  fputs("</dl>\n", p.out);
  cag_site_end(&p);
  for (size_t i = 0; i < s->module_count; i++) {
    const Book b = library_book(s, i);
    module_page(s, &b);
  }
}

// --- Scripts ---

static Book script_book(const CagSite *s, size_t i) {
  return (Book){&scripts, &s->scripts[i].module, &s->scripts[i], s->scripts[i].page};
}

void cag_site_scripts(CagSite *s) {
  CagSitePage p;
  if (s->script_count == 0) return;
  cag_site_begin(s, &p, "scripts/index.html", "Scripts", "Scripts");
  fputs("<h1>Scripts</h1>\n<dl class=\"modules\">\n", p.out);
  for (size_t i = 0; i < s->script_count; i++) {
    const Book b = script_book(s, i);
    write_item(&p, &b);
  }
  fputs("</dl>\n", p.out);
  cag_site_end(&p);
  for (size_t i = 0; i < s->script_count; i++) {
    const Book b = script_book(s, i);
    module_page(s, &b);
  }
}

void cag_site_scripts_item(const CagSitePage *p) {
  if (p->site->script_count) fputs("<li><a href=\"#scripts\">Scripts</a></li>\n", p->out);
}

// Lists the definitions of a script in the index of functions.
static void list_definitions(const CagSitePage *p, const Book *b) {
  for (size_t i = 0; i < b->module->count; i++) {
    const CagDocEntry *e = &b->module->entries[i];
    size_t n;
    const char *said = sentence_of(e, &n);
    fprintf(p->out, "<dt><a href=\"scripts/%s.html#%s\"><code>%s.%s</code></a></dt><dd>", b->page,
            e->name, b->page, e->name);
    cag_html_prose(p->out, p->root, said, n);
    fputs("</dd>\n", p->out);
  }
}

void cag_site_scripts_section(const CagSitePage *p) {
  const CagSite *s = p->site;
  if (s->script_count == 0) return;
  fputs("<section class=\"family\"><h2 id=\"scripts\"><a href=\"scripts/index.html\">Scripts</a>"
        "</h2>\n<dl>\n",
        p->out);
  for (size_t i = 0; i < s->script_count; i++) {
    const Book b = script_book(s, i);
    list_definitions(p, &b);
  }
  fputs("</dl></section>\n", p->out);
}
