// Completion with Tab: commands after `:`, files after the commands that take one and in the texts
// of functions that read files, members after a `.`, named arguments of the enclosing call, and
// names.

#include <ctype.h>
#include <glob.h>
#include <stdlib.h>
#include <string.h>

#include "cli/repl.h"

// Each text is added once. The name of an argument that is proposed as `name: ` is not added again.
void cag_repl_propose_text(CagReplProposals *p, const char *text, size_t length,
                           const char *prefix) {
  if (length < p->length || strncmp(text, prefix, p->length) != 0) return;
  for (size_t i = 0; i < p->count; i++)
    if (strcspn(p->items[i], ":") == length && strncmp(p->items[i], text, length) == 0) return;
  char **items = realloc(p->items, (p->count + 1) * sizeof *items);
  if (!items) return;
  p->items = items;
  if ((items[p->count] = strndup(text, length))) p->count++;
}

static int by_bytes(const void *a, const void *b) {
  return strcmp(*(char *const *)a, *(char *const *)b);
}

void cag_repl_proposals_free(CagReplProposals *p) {
  for (size_t i = 0; i < p->count; i++) free(p->items[i]);
  free(p->items);
  *p = (CagReplProposals){0};
}

// Bytes from 128 on belong to letters of other alphabets.
static bool is_word(char c) { return isalnum((unsigned char)c) || c == '_' || (c & 0x80); }

const char *cag_repl_word(const char *text, const char *end) {
  while (end > text && is_word(end[-1])) end--;
  return end;
}

static void propose_files(CagReplProposals *p, const char *path) {
  glob_t found = {0};
  char *pattern = NULL;
  p->length = strlen(path);
  if (asprintf(&pattern, "%s*", path) < 0) return;
  if (glob(pattern, GLOB_MARK, NULL, &found) == 0)
    for (size_t i = 0; i < found.gl_pathc; i++)
      cag_repl_propose_text(p, found.gl_pathv[i], strlen(found.gl_pathv[i]), path);
  globfree(&found);
  free(pattern);
}

static void propose_names(CagRepl *repl, CagReplProposals *p, const char *prefix) {
  static const char *const words[] = {"and", "as",    "assert", "by",   "else", "false",
                                      "for", "if",    "import", "in",   "none", "not",
                                      "or",  "param", "print",  "show", "then", "true"};
  const char *name;
  for (size_t i = 0; (name = cag_session_name(repl->session, i, NULL, NULL)); i++)
    cag_repl_propose_text(p, name, strlen(name), prefix);
  for (const char *const *b = cag_builtin_name_list(); *b; b++)
    cag_repl_propose_text(p, *b, strlen(*b), prefix);
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    cag_repl_propose_text(p, words[i], strlen(words[i]), prefix);
}

static void propose_commands(CagReplProposals *p, const char *prefix) {
  p->length = strlen(prefix);
  const char *name;
  for (size_t i = 0; cag_repl_command_row(i, &name, NULL, NULL); i++)
    cag_repl_propose_text(p, name, strlen(name), prefix);
}

// --- Members ---

typedef struct Members {
  CagReplProposals *proposals;
  const char *prefix;
} Members;

static void take_member(void *context, const char *name) {
  const Members *m = context;
  cag_repl_propose_text(m->proposals, name, strlen(name), m->prefix);
}

// --- The context of the cursor ---

// Deeper brackets are ignored.
#define DEPTH_MAX 64

// The brackets, texts, and { } in texts that are open at the end of a text, innermost last.
typedef struct Open {
  char kinds[DEPTH_MAX]; // ( [ { " ` and $ for the { of a text
  const char *places[DEPTH_MAX];
  size_t count;
} Open;

static void enter(Open *o, char kind, const char *at) {
  if (o->count == DEPTH_MAX) return;
  o->kinds[o->count] = kind;
  o->places[o->count++] = at;
}

static char innermost(const Open *o) { return o->count ? o->kinds[o->count - 1] : 0; }

// Scans a character of a text. Returns the last character that belongs to it.
static const char *scan_text(Open *o, const char *at) {
  const char quote = innermost(o);
  if (*at == quote) o->count--;
  else if (quote == '`') return at;
  else if (*at == '\n') o->count--; // a text ends on its line
  else if (*at == '\\' && at[1]) return at + 1;
  else if (*at == '{') enter(o, '$', at);
  return at;
}

static bool is_comment(const char *at) { return *at == '/' && (at[1] == '/' || at[1] == '*'); }

// Returns the last character of the comment at `at`, which ends with its line or at */.
static const char *end_of_comment(const char *at) {
  if (at[1] == '/') return at + strcspn(at, "\n") - 1;
  const char *end = strstr(at + 2, "*/");
  return end ? end + 1 : at + strlen(at) - 1;
}

// Scans a character or a comment. Returns the last character scanned.
static const char *scan_one(Open *o, const char *at) {
  const char in = innermost(o);
  if (in == '"' || in == '`') return scan_text(o, at);
  if (is_comment(at)) return end_of_comment(at);
  if (strchr("([{\"`", *at)) enter(o, *at, at);
  else if (strchr(")]}", *at) && o->count) o->count--;
  return at;
}

static Open scan(const char *text) {
  Open o = {.count = 0};
  for (const char *at = text; *at; at++) at = scan_one(&o, at);
  return o;
}

// Returns the name before the innermost open bracket (ignoring texts) if it is a parenthesis, to be
// freed, or NULL.
static char *find_call(const char *text, const Open *o) {
  size_t i = o->count;
  while (i > 0 && strchr("\"`", o->kinds[i - 1])) i--;
  if (i == 0 || o->kinds[i - 1] != '(') return NULL;
  const char *end = o->places[i - 1], *start = cag_repl_word(text, end);
  return start < end ? strndup(start, (size_t)(end - start)) : NULL;
}

static bool reads_file(const char *function) { return strncmp(function, "read_", 5) == 0; }

// Proposes files in the open text of a call that reads one, or of an import.
static void propose_in_text(CagReplProposals *p, const char *text, const Open *o) {
  const char *quote = o->places[o->count - 1];
  char *function = find_call(text, o);
  const bool reads = function && reads_file(function);
  free(function);
  const char *line = quote;
  while (line > text && line[-1] != '\n') line--;
  line += strspn(line, " \t");
  if (strncmp(line, "import", 6) == 0 || reads) propose_files(p, quote + 1);
}

// --- Named arguments ---

// The `name =` and `name` of a signature (a, b = 1) become `name: `.
static void propose_parameters(CagReplProposals *p, const char *list, const char *prefix) {
  Open o = {.count = 0};
  for (const char *at = list; *at; at++) {
    const bool begins = o.count == 0 || (o.count == 1 && *at == ',');
    at = scan_one(&o, at);
    if (o.count == 0) return;
    if (!begins) continue;
    const char *from = at + 1;
    while (isspace((unsigned char)*from) || is_comment(from))
      from = is_comment(from) ? end_of_comment(from) + 1 : from + 1;
    const char *to = from;
    while (is_word(*to)) to++;
    char *name = NULL;
    if (to > from && asprintf(&name, "%.*s: ", (int)(to - from), from) >= 0)
      cag_repl_propose_text(p, name, strlen(name), prefix);
    free(name);
  }
}

static void propose_arguments_of(CagRepl *repl, CagReplProposals *p, const char *function,
                                 const char *prefix) {
  const char *text, *name;
  const size_t n = strlen(function);
  for (size_t i = 0; (name = cag_session_name(repl->session, i, &text, NULL)); i++) {
    if (strcmp(name, function) != 0) continue;
    if (text && text[n] == '(') propose_parameters(p, text + n, prefix);
    return; // it hides a built-in
  }
  for (size_t i = 0; cag_builtin_row(i, &text, NULL, NULL, NULL); i++)
    if (strncmp(text, function, n) == 0 && text[n] == '(') propose_parameters(p, text + n, prefix);
}

static void propose_words(CagRepl *repl, CagReplProposals *p, const char *text) {
  const Open open = scan(text);
  if (strchr("\"`", innermost(&open)) && open.count) {
    propose_in_text(p, text, &open);
    return;
  }
  const char *end = text + strlen(text), *word = cag_repl_word(text, end);
  p->length = (size_t)(end - word);
  if (word > text && word[-1] == '.' && (word < text + 2 || word[-2] != '.')) {
    const char *object = word - 1;
    while (object > text && (is_word(object[-1]) || object[-1] == '.')) object--;
    char *path = strndup(object, (size_t)(word - 1 - object));
    if (path && *path) cag_session_members(repl->session, path, take_member, &(Members){p, word});
    free(path);
    return;
  }
  char *function = find_call(text, &open);
  if (function) propose_arguments_of(repl, p, function, word);
  free(function);
  if (p->length > 0) propose_names(repl, p, word);
}

// Proposes completions for a line that continues an input.
static void propose_further(CagRepl *repl, CagReplProposals *p, const char *line) {
  char *text = NULL;
  if (asprintf(&text, "%s%s", repl->before, line) < 0) return;
  propose_words(repl, p, text);
  free(text);
}

CagReplProposals cag_repl_propose(CagRepl *repl, const char *text) {
  CagReplProposals p = {0};
  text += strspn(text, " \t");
  size_t n = strcspn(text, " \t");
  if (repl->before) {
    propose_further(repl, &p, text);
  } else if (*text != ':') {
    if (!cag_repl_propose_import(repl, &p, text)) propose_words(repl, &p, text);
  } else if (!text[n]) {
    propose_commands(&p, text);
  } else {
    char command[32]; // large enough for every command
    snprintf(command, sizeof command, "%.*s", (int)n, text);
    const char *rest = text + n + strspn(text + n, " \t");
    if (cag_repl_command_takes_file(command)) propose_files(&p, rest);
    else propose_words(repl, &p, rest);
  }
  if (p.count) qsort(p.items, p.count, sizeof *p.items, by_bytes);
  return p;
}
