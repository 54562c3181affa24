// Writes texts and scripts as HTML.

#include <string.h>

#include "base/memory.h"
#include "interp/session/site.h"
#include "lang/lexer.h"

void cag_html_text(FILE *out, const char *text, size_t length) {
  for (size_t i = 0; i < length; i++) {
    if (text[i] == '<') fputs("&lt;", out);
    else if (text[i] == '>') fputs("&gt;", out);
    else if (text[i] == '&') fputs("&amp;", out);
    else if (text[i] == '"') fputs("&quot;", out);
    else fputc(text[i], out);
  }
}

// --- Scripts ---

static bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || (c & 0x80);
}
static bool is_digit(char c) { return c >= '0' && c <= '9'; }

static void write_class(FILE *out, const char *name, const char *text, size_t n) {
  fprintf(out, "<span class=\"%s\">", name);
  cag_html_text(out, text, n);
  fputs("</span>", out);
}

static size_t word_end(const char *text, size_t i, size_t length) {
  while (i < length && (is_letter(text[i]) || is_digit(text[i]))) i++;
  return i;
}

// Returns the end of a number with its unit. The two points of a range are not part of it.
static size_t number_end(const char *text, size_t i, size_t length) {
  while (i < length && (is_digit(text[i]) || text[i] == '_')) i++;
  if (i + 1 < length && text[i] == '.' && is_digit(text[i + 1])) {
    i++;
    while (i < length && is_digit(text[i])) i++;
  }
  if (i + 2 < length && text[i] == 'e' && (is_digit(text[i + 1]) || is_digit(text[i + 2]))) i += 2;
  return word_end(text, i, length);
}

static size_t text_end(const char *text, size_t i, size_t length) {
  const char quote = text[i++];
  while (i < length && text[i] != quote) i += text[i] == '\\' && quote == '"' ? 2 : 1;
  return i < length ? i + 1 : length;
}

// Writes a name, with a link if it is that of a built-in and not a member or an argument.
static void write_word(FILE *out, const char *root, const char *text, size_t at, size_t end,
                       size_t length) {
  char name[64];
  const size_t n = end - at;
  if (n >= sizeof name) {
    cag_html_text(out, text + at, n);
    return;
  }
  memcpy(name, text + at, n);
  name[n] = 0;
  const bool member = at > 0 && text[at - 1] == '.' && !(at > 1 && text[at - 2] == '.');
  const bool argument = end < length && text[end] == ':';
  // A name that is not called may be a parameter or a definition of the script.
  const bool meant = n == length || (end < length && text[end] == '(');
  if (cag_word_is_reserved(name)) write_class(out, "k", name, n);
  else if (meant && !member && !argument && cag_builtin_find(name) != (size_t)-1)
    fprintf(out, "<a class=\"f\" href=\"%sfunctions/%s.html\">%s</a>", root, name, name);
  else cag_html_text(out, name, n);
}

void cag_html_script(FILE *out, const char *root, const char *text, size_t length) {
  for (size_t i = 0; i < length;) {
    size_t end = i + 1;
    if (text[i] == '/' && i + 1 < length && text[i + 1] == '/') {
      while (end < length && text[end] != '\n') end++;
      write_class(out, "c", text + i, end - i);
    } else if (text[i] == '"' || text[i] == '`') {
      end = text_end(text, i, length);
      write_class(out, "s", text + i, end - i);
    } else if (is_digit(text[i])) {
      end = number_end(text, i, length);
      write_class(out, "n", text + i, end - i);
    } else if (is_letter(text[i])) {
      end = word_end(text, i, length);
      write_word(out, root, text, i, end, length);
    } else {
      cag_html_text(out, text + i, 1);
    }
    i = end;
  }
}

void cag_html_prose(FILE *out, const char *root, const char *text, size_t length) {
  for (size_t i = 0; i < length;) {
    const char *close = text[i] == '`' ? memchr(text + i + 1, '`', length - i - 1) : NULL;
    const size_t n = close ? (size_t)(close - text) - i - 1 : 0;
    // Empty backquotes are literal.
    if (n > 0 && strspn(text + i + 1, " ") < n) {
      fputs("<code>", out);
      cag_html_script(out, root, text + i + 1, n);
      fputs("</code>", out);
      i += n + 2;
    } else {
      cag_html_text(out, text + i, 1);
      i++;
    }
  }
}

// --- Examples ---

// Returns the script without its `// expect` comments, because its output is shown below it;
// allocated with malloc.
static char *without_expectations(const char *text, size_t length) {
  char *out = cag_strndup(text, length), *to = out;
  if (!out) cag_memory_leave();
  for (char *at = out; *at;) {
    const bool expects = strncmp(at, "// expect", 9) == 0 && (at[9] == ':' || at[9] == ' ');
    if (!expects) {
      *to++ = *at++;
      continue;
    }
    while (to > out && to[-1] == ' ') to--;
    at += strcspn(at, "\n");
    // A line that contained nothing else is removed completely.
    if ((to == out || to[-1] == '\n') && *at) at++;
  }
  *to = 0;
  return out;
}

// Writes a text such that it can stand in an address.
static void write_percent(FILE *out, const char *text) {
  for (; *text; text++) {
    const unsigned char c = (unsigned char)*text;
    if (is_digit(*text) || is_letter(*text) || strchr("-_.", c)) fputc(c, out);
    else fprintf(out, "%%%02X", c);
  }
}

// Examples of the user's scripts may read files, which the playground does not have.
static void write_edit_link(const CagSite *s, const CagSiteSpot *spot, const char *text) {
  const char *address = s->options->playground;
  if (!address || spot->folder) return;
  const bool absolute = strstr(address, "://") || *address == '/';
  fputs("<a class=\"edit\" href=\"", spot->out);
  if (!absolute) fputs(spot->root, spot->out);
  cag_html_text(spot->out, address, strlen(address));
  fputs("#text=", spot->out);
  write_percent(spot->out, text);
  fputs("\">Edit</a>\n", spot->out);
}

void cag_html_example(CagSite *s, const CagSiteSpot *spot, const char *text, size_t length) {
  const CagSiteExample *e = cag_site_example(s, spot, text, length);
  FILE *out = spot->out;
  const char *root = spot->root;
  while (length && text[length - 1] == '\n') length--;
  char *shown = without_expectations(text, length);
  fputs("<div class=\"example\"><div class=\"code\"><pre><code>", out);
  cag_html_script(out, root, shown, strlen(shown));
  fputs("</code></pre>\n", out);
  if (e && e->output && *e->output) {
    fputs("<pre class=\"output\"><samp>", out);
    cag_html_text(out, e->output, strlen(e->output));
    fputs("</samp></pre>\n", out);
  }
  if (e && e->unavailable)
    fputs(
        "<p class=\"missing\">This example needs the package <code>cag-brep</code>, which was not "
        "installed when this page was made.</p>\n",
        out);
  write_edit_link(s, spot, shown);
  cag_free(shown);
  fputs("</div>\n", out);
  if (e && e->picture)
    fprintf(out,
            "<img src=\"%s%s\" width=\"%zu\" height=\"%zu\" loading=\"lazy\" alt=\"what the script "
            "makes\">\n",
            root, e->picture, e->picture_width, e->picture_height);
  fputs("</div>\n", out);
}

char *cag_html_anchor(const char *heading) {
  char *out = cag_malloc(strlen(heading) + 2), *to = out;
  if (!out) cag_memory_leave();
  for (const char *at = heading; *at; at++) {
    if (is_digit(*at) || is_letter(*at)) *to++ = *at >= 'A' && *at <= 'Z' ? *at + 32 : *at;
    else if (to > out && to[-1] != '-' && (*at == ' ' || *at == '-' || *at == '.')) *to++ = '-';
  }
  while (to > out && to[-1] == '-') to--;
  if (to == out) *to++ = 'x';
  *to = 0;
  return out;
}
