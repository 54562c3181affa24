// The pages of functions, errors, the guide, and the cookbook.

#include <string.h>

#include "base/memory.h"
#include "interp/session/site.h"

static void write_text(FILE *out, const char *text) { cag_html_text(out, text, strlen(text)); }

// --- Functions ---

static const CagBuiltin *first_row(size_t index) {
  size_t rows;
  return cag_builtin_rows(index, &rows);
}

typedef struct Errors {
  const CagSitePage *page;
  size_t count;
} Errors;

static void write_error_link(void *context, CagErrorId id) {
  Errors *e = context;
  const CagErrorInfo *info = cag_error_info(id);
  FILE *out = e->page->out;
  fputs(e->count++ ? ", " : "<p class=\"errors\">Errors: ", out);
  fprintf(out, "<a href=\"%serrors.html#%s\" title=\"", e->page->root, info->code);
  write_text(out, info->title);
  fprintf(out, "\">%s</a>", info->reason);
}

// Writes a summary. Names of the row's parameters in it are not links.
static void write_summary(const CagSitePage *p, const CagSignature *s, const char *text) {
  while (*text) {
    const char *open = strchr(text, '`'), *close = open ? strchr(open + 1, '`') : NULL;
    bool parameter = false;
    const size_t n = close ? (size_t)(close - open) - 1 : 0;
    for (size_t i = 0; close && s && i < s->count; i++)
      parameter |= strlen(s->parameters[i]) == n && strncmp(s->parameters[i], open + 1, n) == 0;
    const size_t part = close ? (size_t)(close + 1 - text) : strlen(text);
    if (parameter) {
      cag_html_text(p->out, text, (size_t)(open - text));
      fprintf(p->out, "<code>%.*s</code>", (int)n, open + 1);
    } else {
      cag_html_prose(p->out, p->root, text, part);
    }
    text += part;
  }
}

static void write_row(const CagSitePage *p, const CagBuiltin *row) {
  const CagSignature *s = cag_builtin_signature_of(row);
  fputs("<section>\n<p class=\"signature\"><code>", p->out);
  cag_html_script(p->out, p->root, row->signature, strlen(row->signature));
  fputs("</code>", p->out);
  if (row->result) {
    fputs(" <span class=\"result\">&rarr; ", p->out);
    write_text(p->out, row->result);
    fputs("</span>", p->out);
  }
  fputs("</p>\n<p>", p->out);
  write_summary(p, s, row->summary);
  fputs("</p>\n", p->out);
  if (s && (s->count || s->variadic)) {
    cag_site_begin_parameters(p);
    for (size_t i = 0; i < s->count; i++)
      cag_site_parameter(p, s->words[i], cag_doc_meaning(s->name, s->parameters[i]),
                         s->parameters[i], s->defaults[i]);
    if (s->variadic)
      cag_site_parameter(p, "as the first", cag_doc_meaning(s->name, "..."), "...", NULL);
    fputs("</tbody></table>\n", p->out);
  }
  Errors errors = {p, 0};
  cag_doc_reasons(row->summary, write_error_link, &errors);
  if (errors.count) fputs("</p>\n", p->out);
  cag_html_example(
      p->site,
      &(CagSiteSpot){
          .out = p->out, .root = p->root, .about = row->signature, .function = s ? s->name : NULL},
      row->example, strlen(row->example));
  fputs("</section>\n", p->out);
}

// Writes the list of the other functions of the family, beside the page.
static void write_family_list(const CagSitePage *p, const char *family, size_t here) {
  fputs("<aside><h2>", p->out);
  write_text(p->out, family);
  fputs("</h2><ul>\n", p->out);
  for (size_t i = 0; i < cag_builtin_count(); i++)
    if (strcmp(first_row(i)->family, family) == 0)
      fprintf(p->out, "<li%s><a href=\"%s.html\">%s</a></li>\n", i == here ? " class=\"here\"" : "",
              cag_builtin_name(i), cag_builtin_name(i));
  fputs("</ul></aside>\n", p->out);
}

static void function_page(CagSite *s, size_t index) {
  size_t rows;
  CagSitePage p;
  const CagBuiltin *b = cag_builtin_rows(index, &rows);
  const char *name = cag_builtin_name(index);
  char path[128];
  snprintf(path, sizeof path, "functions/%s.html", name);
  cag_site_find(s, name, b->function ? "function" : "constant", path, b->summary,
                cag_doc_sentence(b->summary));
  cag_site_begin(s, &p, path, name, "Functions");
  fputs("<div class=\"with-aside\">\n<article>\n", p.out);
  fprintf(p.out, "<h1>%s</h1>\n", name);
  for (size_t i = 0; i < rows; i++) write_row(&p, &b[i]);
  fputs("</article>\n", p.out);
  write_family_list(&p, b->family, index);
  fputs("</div>\n", p.out);
  cag_site_end(&p);
}

static void write_family(const CagSitePage *p, const char *family) {
  char *anchor = cag_html_anchor(family);
  fprintf(p->out, "<section class=\"family\"><h2 id=\"%s\">", anchor);
  write_text(p->out, family);
  fputs("</h2>\n<dl>\n", p->out);
  for (size_t i = 0; i < cag_builtin_count(); i++) {
    const CagBuiltin *b = first_row(i);
    if (strcmp(b->family, family) != 0) continue;
    const char *name = cag_builtin_name(i);
    fprintf(p->out, "<dt><a href=\"functions/%s.html\"><code>%s</code></a></dt><dd>", name, name);
    cag_html_prose(p->out, "", b->summary, cag_doc_sentence(b->summary));
    fputs("</dd>\n", p->out);
  }
  fputs("</dl></section>\n", p->out);
  cag_free(anchor);
}

// Returns the families in the order of the table. The caller frees the list.
static const char **list_families(size_t *count) {
  const char **families = cag_calloc(cag_builtin_count() + 1, sizeof *families);
  if (!families) cag_memory_leave();
  *count = 0;
  for (size_t i = 0; i < cag_builtin_count(); i++) {
    size_t k = 0;
    while (k < *count && strcmp(families[k], first_row(i)->family) != 0) k++;
    if (k == *count) families[(*count)++] = first_row(i)->family;
  }
  return families;
}

static void index_page(CagSite *s) {
  CagSitePage p;
  size_t count;
  const char **families = list_families(&count);
  cag_site_begin(s, &p, "index.html", "Functions", "Functions");
  fputs("<h1>A language for geometry</h1>\n<p class=\"lead\">A script defines curves, surfaces, "
        "solids, robots, and scenes. "
        "<a href=\"guide/getting-started.html\">Getting started</a> takes ten minutes. The "
        "<a href=\"cookbook/index.html\">cookbook</a> contains scripts to start from.</p>\n<ul "
        "class=\"families\">\n",
        p.out);
  for (size_t i = 0; i < count; i++) {
    char *anchor = cag_html_anchor(families[i]);
    fprintf(p.out, "<li><a href=\"#%s\">", anchor);
    write_text(p.out, families[i]);
    fputs("</a></li>\n", p.out);
    cag_free(anchor);
  }
  cag_site_scripts_item(&p);
  fputs("</ul>\n", p.out);
  for (size_t i = 0; i < count; i++) write_family(&p, families[i]);
  cag_site_scripts_section(&p);
  cag_site_end(&p);
  cag_free(families);
}

void cag_site_functions(CagSite *s) {
  index_page(s);
  for (size_t i = 0; i < cag_builtin_count(); i++) function_page(s, i);
}

// --- Errors ---

void cag_site_errors(CagSite *s) {
  CagSitePage p;
  cag_site_begin(s, &p, "errors.html", "Errors", "Errors");
  fputs("<h1>Errors</h1>\n<p>Every kind of error has a permanent code. <code>cag explain "
        "CODE</code> prints its explanation.</p>\n",
        p.out);
  for (size_t i = 0; i < CAG_ERR_COUNT; i++) {
    const CagErrorInfo *e = cag_error_info((CagErrorId)i);
    char url[64], name[128];
    snprintf(url, sizeof url, "errors.html#%s", e->code);
    snprintf(name, sizeof name, "%s %s", e->code, e->reason);
    cag_site_find(s, name, "error", url, e->title, strlen(e->title));
    fprintf(p.out, "<section class=\"error\" id=\"%s\"><h2>%s <small>%s</small></h2>\n<p><strong>",
            e->code, e->code, e->reason);
    write_text(p.out, e->title);
    fputs("</strong></p>\n<p>", p.out);
    cag_html_prose(p.out, "", e->explanation, strlen(e->explanation));
    fputs("</p>\n", p.out);
    if (e->example) {
      fputs("<pre><code>", p.out);
      cag_html_script(p.out, "", e->example, strlen(e->example));
      fputs("</code></pre>\n", p.out);
    }
    fputs("</section>\n", p.out);
  }
  cag_site_end(&p);
}

// --- Guide ---

static void guide_page(CagSite *s, const CagDocChapter *chapter) {
  CagSitePage p;
  char path[128];
  const CagDocChapter *c;
  snprintf(path, sizeof path, "guide/%s.html", chapter->name);
  cag_site_find(s, chapter->title, "guide", path, chapter->story, strlen(chapter->story));
  cag_site_begin(s, &p, path, chapter->title, "Guide");
  fputs("<div class=\"with-aside\">\n<article class=\"guide\">\n", p.out);
  const CagDocument *d = cag_document(chapter->path);
  cag_html_markdown(s, p.out, p.root, chapter->name, d->text, d->length);
  fputs("</article>\n<aside><h2>Guide</h2><ul>\n", p.out);
  for (size_t i = 0; (c = cag_doc_chapter(i)); i++)
    fprintf(p.out, "<li%s><a href=\"%s.html\">%s</a></li>\n", c == chapter ? " class=\"here\"" : "",
            c->name, c->title);
  fputs("</ul></aside>\n</div>\n", p.out);
  cag_site_end(&p);
}

void cag_site_guides(CagSite *s) {
  CagSitePage p;
  const CagDocChapter *c;
  cag_site_begin(s, &p, "guide/index.html", "Guide", "Guide");
  fputs("<h1>Guide</h1>\n<dl class=\"modules\">\n", p.out);
  for (size_t i = 0; (c = cag_doc_chapter(i)); i++)
    fprintf(p.out, "<dt><a href=\"%s.html\">%s</a></dt><dd>%s</dd>\n", c->name, c->title, c->story);
  fputs("</dl>\n", p.out);
  cag_site_end(&p);
  for (size_t i = 0; (c = cag_doc_chapter(i)); i++) guide_page(s, c);
}

// --- Cookbook ---

// A recipe starts with comments: its title, an empty line, and its paragraph.
static void write_recipe(const CagSitePage *p, const CagDocument *d) {
  char title[160], name[64], url[128];
  const char *at = d->text, *file = strrchr(d->path, '/') + 1;
  snprintf(name, sizeof name, "%.*s", (int)strcspn(file, "."), file);
  const char *begin = strncmp(at, "// ", 3) == 0 ? at + 3 : at;
  snprintf(title, sizeof title, "%.*s", (int)strcspn(begin, "\n"), begin);
  at += strcspn(at, "\n");
  at += *at == '\n';
  snprintf(url, sizeof url, "cookbook/index.html#%s", name);
  fprintf(p->out, "<section class=\"recipe\"><h2 id=\"%s\">", name);
  write_text(p->out, title);
  fputs("</h2>\n<p>", p->out);
  const char *paragraph = at;
  while (strncmp(at, "//", 2) == 0) {
    const size_t n = strcspn(at, "\n"), skip = n > 2 && at[2] == ' ' ? 3 : 2;
    cag_html_prose(p->out, p->root, at + skip, n - skip);
    fputc('\n', p->out);
    at += n + (at[n] == '\n');
  }
  cag_site_find(p->site, title, "recipe", url, paragraph, 0);
  fputs("</p>\n", p->out);
  at += strspn(at, "\n");
  cag_html_example(p->site, &(CagSiteSpot){.out = p->out, .root = p->root, .about = d->path}, at,
                   strlen(at));
  fputs("</section>\n", p->out);
}

void cag_site_cookbook(CagSite *s) {
  CagSitePage p;
  cag_site_begin(s, &p, "cookbook/index.html", "Cookbook", "Cookbook");
  fputs("<h1>Cookbook</h1>\n<p class=\"lead\">Scripts to start from. Each is complete: save it as "
        "<code>x.cag</code> and run "
        "<code>cag render x.cag -o x.png</code>.</p>\n",
        p.out);
  for (const CagDocument *d = cag_documents; d->path; d++)
    if (strncmp(d->path, "docs/cookbook/", 14) == 0) write_recipe(&p, d);
  cag_site_end(&p);
}
