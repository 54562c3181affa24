// Writing of the site: the two passes, files, the frame of each page, and the search.

#include <dirent.h>
#include <errno.h>
#include <stdarg.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/json_text.h"
#include "base/memory.h"
#include "interp/session/session.h"
#include "interp/session/site.h"

// --- Files ---

void cag_site_write(CagSite *s, const char *path, const char *text, size_t length) {
  if (!s->final || s->failed) return;
  char *full = cag_doc_text("%s/%s", s->folder, path);
  CagAtomicFile *f = cag_atomic_file_open(full, &s->error);
  if (f) cag_atomic_file_write(f, text, length);
  s->failed = !f || !cag_atomic_file_commit(f, &s->error);
  cag_free(full);
}

static bool make_folder(CagSite *s, const char *name) {
  char *path = cag_doc_text("%s%s%s", s->folder, *name ? "/" : "", name);
  const bool made = mkdir(path, 0777) == 0 || errno == EEXIST;
  if (!made)
    cag_fail_io(&s->error, CAG_E_FILE, "the folder above it must exist and be writable",
                "cannot create the folder %s: %s", path, strerror(errno));
  cag_free(path);
  return made;
}

// Removes pictures of earlier sites that no page shows.
static void remove_old_pictures(const CagSite *s) {
  char *path = cag_doc_text("%s/pictures", s->folder);
  DIR *folder = opendir(path);
  for (struct dirent *f; folder && (f = readdir(folder));) {
    char *name = cag_doc_text("pictures/%s", f->d_name);
    char *full = cag_doc_text("%s/%s", s->folder, name);
    bool used = strlen(f->d_name) != 20 || f->d_name[16] != '.'; // 16 digits and .svg or .png
    for (size_t i = 0; i < s->count && !used; i++)
      used = s->examples[i].picture && strcmp(s->examples[i].picture, name) == 0;
    if (!used) unlink(full);
    cag_free(name);
    cag_free(full);
  }
  if (folder) closedir(folder);
  cag_free(path);
}

// --- The frame of a page ---

static const struct {
  const char *section, *path;
} sections[] = {{"Functions", "index.html"},         {"Guide", "guide/index.html"},
                {"Cookbook", "cookbook/index.html"}, {"Library", "library/index.html"},
                {"Scripts", "scripts/index.html"},   {"Errors", "errors.html"}};

static void drop_page(void *page) {
  CagSitePage *p = page;
  if (p->out) fclose(p->out);
  cag_free(p->text);
}

void cag_site_begin(CagSite *s, CagSitePage *p, const char *path, const char *title,
                    const char *section) {
  const char *root = strchr(path, '/') ? "../" : "";
  *p = (CagSitePage){.site = s, .path = path, .title = title, .root = root};
  p->out = cag_checked(open_memstream(&p->text, &p->length));
  cag_cleanup_push(&p->cleanup, drop_page, p);
  fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>",
        p->out);
  cag_html_text(p->out, title, strlen(title));
  fprintf(
      p->out,
      " - cag</title>\n<link rel=\"stylesheet\" href=\"%sstyle.css\">\n"
      "<script src=\"%sindex.js\" defer></script>\n<script src=\"%ssearch.js\" defer></script>\n"
      "</head>\n<body data-root=\"%s\">\n<header>\n<a class=\"brand\" "
      "href=\"%sindex.html\">cag</a>\n<nav>\n",
      root, root, root, root, root);
  for (size_t i = 0; i < sizeof sections / sizeof *sections; i++) {
    if (s->script_count == 0 && strcmp(sections[i].section, "Scripts") == 0) continue;
    fprintf(p->out, "<a%s href=\"%s%s\">%s</a>\n",
            strcmp(section, sections[i].section) == 0 ? " class=\"here\"" : "", root,
            sections[i].path, sections[i].section);
  }
  fputs("</nav>\n<div class=\"search\"><input id=\"search\" type=\"search\" placeholder=\"Search "
        "(/)\" "
        "aria-label=\"Search\" autocomplete=\"off\"><ol "
        "id=\"found\"></ol></div>\n</header>\n<main>\n",
        p->out);
}

void cag_site_end(CagSitePage *p) {
  fprintf(p->out, "</main>\n<footer>cag %s</footer>\n</body>\n</html>\n", cag_version());
  fclose(p->out);
  p->out = NULL;
  cag_site_write(p->site, p->path, p->text, p->length);
  cag_cleanup_run(&p->cleanup);
}

// --- The search ---

// Writes a text as a JavaScript string that is also valid in HTML.
static void write_string(FILE *out, const char *text, size_t length) {
  fputc('"', out);
  for (size_t i = 0; i < length; i++) {
    char escape[8];
    const char c = text[i] == '\n' ? ' ' : text[i];
    const char *escaped = c == '<' ? "\\u003c" : cag_json_escape(c, escape);
    if (escaped) fputs(escaped, out);
    else fputc(c, out);
  }
  fputc('"', out);
}

void cag_site_find(CagSite *s, const char *name, const char *kind, const char *url,
                   const char *summary, size_t summary_length) {
  fputs(s->index_count++ ? ",\n[" : "[", s->index);
  write_string(s->index, name, strlen(name));
  fputc(',', s->index);
  write_string(s->index, kind, strlen(kind));
  fputc(',', s->index);
  write_string(s->index, url, strlen(url));
  fputc(',', s->index);
  write_string(s->index, summary, summary_length);
  fputc(']', s->index);
}

static void write_pages(CagSite *s) {
  char *index = NULL;
  size_t length = 0;
  s->index = cag_checked(open_memstream(&index, &length));
  s->index_count = 0;
  fputs("const cagIndex = [\n", s->index);
  cag_site_functions(s);
  cag_site_library(s);
  cag_site_scripts(s);
  cag_site_guides(s);
  cag_site_cookbook(s);
  cag_site_errors(s);
  fputs("\n];\n", s->index);
  fclose(s->index);
  s->index = NULL;
  cag_site_write(s, "index.js", index, length);
  cag_free(index);
}

// --- The whole site ---

static bool read_modules(CagSite *s) {
  while (cag_doc_module_name(s->module_count)) s->module_count++;
  s->modules = cag_calloc(s->module_count + 1, sizeof *s->modules);
  if (!s->modules) cag_memory_leave();
  for (size_t i = 0; i < s->module_count; i++) {
    const char *text;
    size_t length;
    const char *name = cag_doc_library(cag_doc_module_name(i), &text, &length);
    if (cag_session_read_doc(s->session, name, text, length, &s->modules[i]) != CAG_STATUS_OK)
      return false;
  }
  return true;
}

static bool make_folders(CagSite *s) {
  static const char *const folders[] = {"",      "functions", "library",
                                        "guide", "cookbook",  "pictures"};
  for (size_t i = 0; i < sizeof folders / sizeof *folders; i++)
    if (!make_folder(s, folders[i])) return false;
  return s->script_count == 0 || make_folder(s, "scripts");
}

static void report_site(const CagSite *s, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static void report_site(const CagSite *s, const char *format, ...) {
  char *message;
  va_list args;
  va_start(args, format);
  const int n = s->options->say ? cag_vasprintf(&message, format, args) : -1;
  va_end(args);
  if (n < 0) return;
  s->options->say(s->options->context, message);
  cag_free(message);
}

// Reports each failed example as an error of the documentation.
static int judge(CagSite *s) {
  size_t pictures = 0, wrong = 0, unavailable = 0;
  for (size_t i = 0; i < s->count; i++) {
    const CagSiteExample *e = &s->examples[i];
    pictures += e->picture != NULL;
    unavailable += e->unavailable;
    if (!e->failure) continue;
    wrong++;
    cag_diagnostics_add(&s->session->diagnostics, CAG_ERR_doc_example, NULL, (CagSpan){0, 0},
                        "an example of %s does not print the expected output:\n%s\nit printed:\n%s",
                        e->about, e->text, e->failure);
  }
  report_site(s, "%zu scripts run", s->count);
  if (unavailable)
    report_site(s, "%zu scripts have no output, because the program cag-brep is missing",
                unavailable);
  if (pictures) report_site(s, "%zu pictures", pictures);
  return wrong ? CAG_STATUS_SCRIPT : CAG_STATUS_OK;
}

static int make(CagSite *s) {
  if (!cag_site_read_scripts(s)) return cag_session_status(s->session);
  if (!make_folders(s)) return cag_session_fail_io(s->session, CAG_ERR_output_file, &s->error);
  if (!read_modules(s)) return cag_session_status(s->session);
  write_pages(s);
  cag_site_run(s);
  if (s->options->session.interrupt && *s->options->session.interrupt)
    return CAG_STATUS_INTERRUPTED;
  s->final = true;
  write_pages(s);
  const CagDocument *style = cag_document("docs/site/style.css");
  const CagDocument *search = cag_document("docs/site/search.js");
  cag_site_write(s, "style.css", style->text, style->length);
  cag_site_write(s, "search.js", search->text, search->length);
  if (s->failed) return cag_session_fail_io(s->session, CAG_ERR_output_file, &s->error);
  remove_old_pictures(s);
  return judge(s);
}

typedef struct Making {
  CagSite site;
  int status;
} Making;

static void make_site(void *context) {
  Making *m = context;
  m->status = make(&m->site);
}

int cag_session_write_site(CagSession *session, const char *folder, const CagSiteOptions *options) {
  if (!cag_session_begin(session)) return CAG_STATUS_USAGE;
  Making m = {.site = {.session = session, .options = options, .folder = folder}};
  const bool done = cag_memory_guard(make_site, &m);
  const int status = done ? m.status : cag_session_fail_memory(session);
  CagSite s = m.site;
  if (s.index) fclose(s.index);
  for (size_t i = 0; i < s.count; i++) {
    CagSiteExample *e = &s.examples[i];
    char *const texts[] = {e->text, e->folder, e->function, e->output, e->picture, e->failure};
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) cag_free(texts[k]);
  }
  for (size_t i = 0; i < s.module_count; i++) cag_doc_module_free(&s.modules[i]);
  cag_free(s.modules);
  cag_site_free_scripts(&s);
  cag_free(s.examples);
  return cag_session_end(session, status);
}
