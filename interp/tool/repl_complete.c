// What Tab proposes: commands behind `:`, files behind the commands that take one, else members
// behind a `.`, the named arguments of the call that the cursor is in, and names.

#include <ctype.h>
#include <glob.h>
#include <stdlib.h>
#include <string.h>

#include "interp/tool/repl.h"

// Each text once; the name of an argument that is proposed as `name: ` is not proposed again.
static void propose(CagReplProposals *p, const char *text, size_t length, const char *prefix) {
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

// Letters of other alphabets are bytes from 128 on.
static bool is_word(char c) { return isalnum((unsigned char)c) || c == '_' || (c & 0x80); }

static const char *word_start(const char *text, const char *end) {
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
      propose(p, found.gl_pathv[i], strlen(found.gl_pathv[i]), path);
  globfree(&found);
  free(pattern);
}

static void propose_names(CagRepl *repl, CagReplProposals *p, const char *prefix) {
  static const char *const words[] = {"and", "as",    "assert", "by",   "else", "false",
                                      "for", "if",    "import", "in",   "none", "not",
                                      "or",  "param", "print",  "show", "then", "true"};
  const char *name;
  for (size_t i = 0; (name = cag_session_name(repl->session, i, NULL, NULL)); i++)
    propose(p, name, strlen(name), prefix);
  for (const char *const *b = cag_builtin_name_list(); *b; b++) propose(p, *b, strlen(*b), prefix);
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    propose(p, words[i], strlen(words[i]), prefix);
}

static void propose_commands(CagReplProposals *p, const char *prefix) {
  p->length = strlen(prefix);
  const char *name;
  for (size_t i = 0; cag_repl_command_row(i, &name, NULL, NULL); i++)
    propose(p, name, strlen(name), prefix);
}

// --- Members ---

typedef struct Members {
  CagReplProposals *proposals;
  const char *prefix;
} Members;

static void take_member(void *context, const char *name) {
  const Members *m = context;
  propose(m->proposals, name, strlen(name), m->prefix);
}

// --- Named arguments ---

// The `name =` and `name` of a signature f(a, b = 1) become `name: `.
static void propose_parameters(CagReplProposals *p, const char *signature, size_t length,
                               const char *prefix) {
  const char *end = signature + length, *at = memchr(signature, '(', length);
  int depth = 0;
  for (; at && at < end; at++) {
    if (strchr(")]}", *at) && --depth == 0) return;
    bool begins = depth == 0 || (depth == 1 && *at == ',');
    if (strchr("([{", *at)) depth++;
    if (!begins || depth != 1) continue;
    const char *from = at + 1;
    while (from < end && *from == ' ') from++;
    const char *to = from;
    while (to < end && is_word(*to)) to++;
    char name[64];
    if (to > from && (size_t)(to - from) < sizeof name - 3) {
      int n = snprintf(name, sizeof name, "%.*s: ", (int)(to - from), from);
      propose(p, name, (size_t)n, prefix);
    }
  }
}

static void propose_arguments_of(CagRepl *repl, CagReplProposals *p, const char *function,
                                 const char *prefix) {
  const char *text, *name;
  size_t length, n = strlen(function);
  for (size_t i = 0; (name = cag_session_name(repl->session, i, &text, &length)); i++) {
    if (strcmp(name, function) != 0) continue;
    if (text && length > n && text[n] == '(') propose_parameters(p, text, length, prefix);
    return; // it hides a built-in
  }
  for (size_t i = 0; cag_builtin_row(i, &text, NULL, NULL, NULL); i++)
    if (strncmp(text, function, n) == 0 && text[n] == '(')
      propose_parameters(p, text, strlen(text), prefix);
}

// The name before the innermost open parenthesis, to be freed; NULL: none is open.
static char *find_call(const char *text, const char *end) {
  int depth = 0;
  for (const char *at = end; at > text; at--) {
    if (strchr(")]}", at[-1])) depth++;
    if (!strchr("([{", at[-1]) || depth-- > 0) continue;
    const char *start = word_start(text, at - 1);
    return at[-1] == '(' && start < at - 1 ? strndup(start, (size_t)(at - 1 - start)) : NULL;
  }
  return NULL;
}

static void propose_words(CagRepl *repl, CagReplProposals *p, const char *text) {
  const char *end = text + strlen(text), *word = word_start(text, end);
  p->length = (size_t)(end - word);
  if (word > text && word[-1] == '.' && (word < text + 2 || word[-2] != '.')) {
    const char *object = word - 1;
    while (object > text && (is_word(object[-1]) || object[-1] == '.')) object--;
    char *path = strndup(object, (size_t)(word - 1 - object));
    if (path && *path) cag_session_members(repl->session, path, take_member, &(Members){p, word});
    free(path);
    return;
  }
  char *function = find_call(text, word);
  if (function) propose_arguments_of(repl, p, function, word);
  free(function);
  if (p->length > 0) propose_names(repl, p, word);
}

CagReplProposals cag_repl_propose(CagRepl *repl, const char *text) {
  CagReplProposals p = {0};
  text += strspn(text, " \t");
  size_t n = strcspn(text, " \t");
  if (*text != ':') {
    propose_words(repl, &p, text);
  } else if (!text[n]) {
    propose_commands(&p, text);
  } else {
    char *command = strndup(text, n);
    const char *rest = text + n + strspn(text + n, " \t");
    if (command && cag_repl_command_takes_file(command)) propose_files(&p, rest);
    else propose_words(repl, &p, rest);
    free(command);
  }
  if (p.count) qsort(p.items, p.count, sizeof *p.items, by_bytes);
  return p;
}
