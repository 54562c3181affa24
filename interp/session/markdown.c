// Converts Markdown documents to parts of pages.
//
// cmark parses the document and writes it. In between, headings get anchors, links to other
// documents become links to their pages, names of functions in code become links, and fenced blocks
// of `cag` become examples.

#include <cmark-gfm-core-extensions.h>
#include <cmark-gfm.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "interp/session/site.h"

typedef struct Document {
  CagSite *site;
  const char *root, *about;
  bool is_guide; // a chapter of the manual; otherwise the comment of a module
} Document;

// Replaces a node by HTML.
static void replace(cmark_node *node, cmark_node_type type, const char *html) {
  cmark_node *new = cmark_node_new(type);
  cmark_node_set_literal(new, html);
  cmark_node_replace(node, new);
  cmark_node_free(node);
}

static void change_block(const Document *d, cmark_node *node) {
  const char *info = cmark_node_get_fence_info(node), *text = cmark_node_get_literal(node);
  int width, offset;
  char character;
  // Indented code, as in the comments of modules, is also cag.
  const bool plain = !cmark_node_get_fenced(node, &width, &offset, &character);
  const bool named = info && strncmp(info, "cag", 3) == 0 && (info[3] == 0 || info[3] == ' ');
  if (!plain && !named) return;
  char *html = NULL;
  size_t length = 0;
  FILE *out = open_memstream(&html, &length);
  if (!out) cag_memory_leave();
  if (plain || !d->is_guide || strstr(info, "fragment")) {
    fputs("<pre><code>", out);
    cag_html_script(out, d->root, text, strlen(text));
    fputs("</code></pre>\n", out);
  } else {
    cag_html_example(d->site, &(CagSiteSpot){.out = out, .root = d->root, .about = d->about}, text,
                     strlen(text));
  }
  fclose(out);
  replace(node, CMARK_NODE_HTML_BLOCK, html);
  cag_free(html);
}

static void change_code(const Document *d, cmark_node *node) {
  const char *text = cmark_node_get_literal(node);
  cmark_node *parent = cmark_node_parent(node);
  if (parent && cmark_node_get_type(parent) == CMARK_NODE_LINK) return;
  char *html = NULL;
  size_t length = 0;
  FILE *out = open_memstream(&html, &length);
  if (!out) cag_memory_leave();
  fputs("<code>", out);
  cag_html_script(out, d->root, text, strlen(text));
  fputs("</code>", out);
  fclose(out);
  replace(node, CMARK_NODE_HTML_INLINE, html);
  cag_free(html);
}

// Returns the text of all nodes of a heading.
static char *plain_text(cmark_node *heading) {
  char *text = NULL;
  size_t length = 0;
  FILE *out = open_memstream(&text, &length);
  cmark_iter *it = cmark_iter_new(heading);
  if (!out) cag_memory_leave();
  while (cmark_iter_next(it) != CMARK_EVENT_DONE) {
    const char *part = cmark_node_get_literal(cmark_iter_get_node(it));
    if (part) fputs(part, out);
  }
  cmark_iter_free(it);
  fclose(out);
  return text;
}

static void anchor_heading(const Document *d, cmark_node *node) {
  char *text = plain_text(node), *anchor = cag_html_anchor(text);
  if (d->is_guide && cmark_node_get_heading_level(node) > 1) {
    char url[512];
    snprintf(url, sizeof url, "guide/%s.html#%s", d->about, anchor);
    cag_site_find(d->site, text, "guide", url, "", 0);
  }
  char *html = cag_doc_text("<a class=\"anchor\" id=\"%s\"></a>", anchor);
  cmark_node *mark = cmark_node_new(CMARK_NODE_HTML_INLINE);
  cmark_node_set_literal(mark, html);
  cmark_node_prepend_child(node, mark);
  cag_free(html);
  cag_free(anchor);
  cag_free(text);
}

// "language.md#values" becomes language.html if the site has this page. Other files of the source
// tree have no page, so the link is replaced by its text.
static void change_link(const Document *d, cmark_node *node) {
  const char *url = cmark_node_get_url(node);
  const char *dot = strstr(url, ".md");
  const CagDocChapter *c;
  if (strstr(url, "://") || *url == '#') return;
  for (size_t i = 0; dot && (c = cag_doc_chapter(i)); i++) {
    if (strlen(c->name) != (size_t)(dot - url) || strncmp(url, c->name, strlen(c->name)) != 0)
      continue;
    char *page = cag_doc_text("%sguide/%s.html%s", d->root, c->name, dot + 3);
    cmark_node_set_url(node, page);
    cag_free(page);
    return;
  }
  if (strncmp(url, "cookbook/", 9) == 0 && strstr(url, ".cag")) {
    char *page =
        cag_doc_text("%scookbook/index.html#%.*s", d->root, (int)strcspn(url + 9, "."), url + 9);
    cmark_node_set_url(node, page);
    cag_free(page);
    return;
  }
  cmark_node *child;
  while ((child = cmark_node_first_child(node))) cmark_node_insert_before(node, child);
  cmark_node_unlink(node);
  cmark_node_free(node);
}

// Text that looks like HTML in the comments of a script, such as `a <b> c`, is literal.
static void change_html(cmark_node *node, cmark_node_type type) {
  cmark_node *text = cmark_node_new(CMARK_NODE_TEXT), *new = text;
  cmark_node_set_literal(text, cmark_node_get_literal(node));
  if (type == CMARK_NODE_HTML_BLOCK) {
    new = cmark_node_new(CMARK_NODE_PARAGRAPH);
    cmark_node_append_child(new, text);
  }
  cmark_node_replace(node, new);
  cmark_node_free(node);
}

// The pictures of guides are not part of the program: what they show is told instead.
static void change_image(cmark_node *node) {
  cmark_node *told = cmark_node_new(CMARK_NODE_EMPH), *child;
  while ((child = cmark_node_first_child(node))) cmark_node_append_child(told, child);
  cmark_node_replace(node, told);
  cmark_node_free(node);
}

static void change(const Document *d, cmark_node *node) {
  const cmark_node_type type = cmark_node_get_type(node);
  const bool is_html = type == CMARK_NODE_HTML_INLINE || type == CMARK_NODE_HTML_BLOCK;
  if (is_html && !d->is_guide) change_html(node, type);
  else if (type == CMARK_NODE_CODE_BLOCK) change_block(d, node);
  else if (type == CMARK_NODE_CODE) change_code(d, node);
  else if (type == CMARK_NODE_HEADING) anchor_heading(d, node);
  else if (type == CMARK_NODE_LINK) change_link(d, node);
  else if (type == CMARK_NODE_IMAGE) change_image(node);
}

// Nodes are collected first, because the changes modify the tree.
static void change_all(const Document *d, cmark_node *root) {
  size_t count = 0, capacity = 0;
  cmark_node **nodes = NULL;
  cmark_iter *it = cmark_iter_new(root);
  cmark_event_type event;
  while ((event = cmark_iter_next(it)) != CMARK_EVENT_DONE) {
    if (event != CMARK_EVENT_ENTER) continue;
    if (!CAG_RESERVE(nodes, capacity, count + 1)) {
      cag_free(nodes);
      cag_memory_leave();
    }
    nodes[count++] = cmark_iter_get_node(it);
  }
  cmark_iter_free(it);
  for (size_t i = 0; i < count; i++) change(d, nodes[i]);
  cag_free(nodes);
}

static bool is_guide(const char *about) {
  const CagDocChapter *c;
  for (size_t i = 0; (c = cag_doc_chapter(i)); i++)
    if (strcmp(c->name, about) == 0) return true;
  return false;
}

void cag_html_markdown(CagSite *s, FILE *out, const char *root, const char *about, const char *text,
                       size_t length) {
  const Document d = {s, root, about, is_guide(about)};
  cmark_gfm_core_extensions_ensure_registered();
  cmark_parser *parser = cmark_parser_new(CMARK_OPT_UNSAFE);
  cmark_syntax_extension *tables = cmark_find_syntax_extension("table");
  if (tables) cmark_parser_attach_syntax_extension(parser, tables);
  cmark_parser_feed(parser, text, length);
  cmark_node *tree = cmark_parser_finish(parser);
  change_all(&d, tree);
  char *html =
      cmark_render_html(tree, CMARK_OPT_UNSAFE, cmark_parser_get_syntax_extensions(parser));
  fputs(html, out);
  cag_free(html);
  cmark_node_free(tree);
  cmark_parser_free(parser);
}
