// cag repl [FILE]: reads inputs, evaluates them, and prints their values as `VALUE : TYPE`.
//
// An incomplete input continues on the next line. Lines that start with `:` are commands
// (repl_commands.c).

#include "cli/repl.h"

#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// --- Evaluation ---

void cag_repl_fail(CagRepl *repl, int status, const char *format, ...) {
  char *message = NULL;
  va_list args;
  va_start(args, format);
  int n = vasprintf(&message, format, args);
  va_end(args);
  fflush(stdout);
  if (repl->tool->style == CAG_STYLE_JSON)
    cag_tool_fail(repl->tool, status, NULL, "%s", n < 0 ? "out of memory" : message);
  else fprintf(stderr, "error: %s\n", n < 0 ? "out of memory" : message);
  if (n >= 0) free(message);
  if (repl->status == CAG_STATUS_OK) repl->status = status;
}

void cag_repl_finish(CagRepl *repl, int status) {
  fflush(stdout);
  if (status == CAG_STATUS_OK) return;
  // The terminal has written ^C, and the cursor is after it.
  if (status == CAG_STATUS_INTERRUPTED)
    fputs(repl->interactive ? "\ninterrupted\n" : "interrupted\n", stderr);
  else cag_session_write_diagnostics(repl->session, repl->tool->style, stderr);
  fflush(stderr);
  if (repl->status == CAG_STATUS_OK) repl->status = status;
}

static void print_value(void *context, const char *text, const char *type) {
  const CagRepl *repl = context;
  const bool color = repl->interactive && repl->tool->style == CAG_STYLE_COLOR;
  printf(color ? "%s \033[2m: %s\033[0m\n" : "%s : %s\n", text, type);
}

void cag_repl_evaluate(CagRepl *repl, const char *text, size_t length) {
  cag_repl_finish(repl, cag_session_input(repl->session, text, length, print_value, repl));
}

static void remember(CagRepl *repl, const char *path) {
  for (size_t i = 0; i < repl->loaded_count; i++)
    if (strcmp(repl->loaded[i], path) == 0) return;
  char **loaded = realloc(repl->loaded, (repl->loaded_count + 1) * sizeof *loaded);
  if (!loaded) return;
  repl->loaded = loaded;
  if ((loaded[repl->loaded_count] = strdup(path))) repl->loaded_count++;
}

void cag_repl_load(CagRepl *repl, const char *path) {
  remember(repl, path);
  cag_repl_finish(repl, cag_session_input_file(repl->session, path));
}

// --- Inputs ---

// Tests whether a line starts with a word or sign that continues the previous line.
static bool goes_on(const char *line) {
  static const char *const signs[] = {
      "|", ".", "+", "*", "%", "&", "^", "==", "!=", "<", ">", "=", ",", ")", "]", "}"};
  static const char *const words[] = {"then", "else", "and", "or", "in", "by", "as"};
  line += strspn(line, " \t");
  if (line[0] == '/') return line[1] != '/' && line[1] != '*';
  for (size_t i = 0; i < sizeof signs / sizeof *signs; i++)
    if (strncmp(line, signs[i], strlen(signs[i])) == 0) return true;
  for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
    size_t n = strlen(words[i]);
    if (strncmp(line, words[i], n) == 0 && (line[n] == ' ' || line[n] == '\t' || !line[n]))
      return true;
  }
  return false;
}

typedef struct Text {
  char *bytes;
  size_t length;
} Text;

static void add_line(Text *t, const char *line) {
  size_t n = strlen(line);
  char *bytes = realloc(t->bytes, t->length + n + 2);
  if (!bytes) return;
  t->bytes = bytes;
  memcpy(bytes + t->length, line, n);
  t->length += n;
  bytes[t->length++] = '\n';
  bytes[t->length] = 0;
}

static void clear_text(Text *t) {
  free(t->bytes);
  *t = (Text){0};
}

static const char *last_line(const Text *t) {
  const char *at = t->bytes + t->length - 1; // the newline is after it
  while (at > t->bytes && at[-1] != '\n') at--;
  return at + strspn(at, " \t");
}

// Tests whether another line belongs to the input. `///` documents the following line. Without a
// terminal, the next line can be examined.
static bool wants_more(CagRepl *repl, const Text *t) {
  if (cag_input_is_incomplete(t->bytes, t->length)) return true;
  if (strncmp(last_line(t), "///", 3) == 0) return true;
  const char *next = repl->interactive ? NULL : cag_repl_peek(repl->input);
  return next && goes_on(next);
}

static bool is_blank(const char *line) { return line[strspn(line, " \t")] == 0; }

// Returns the command that a single word means, as in other programs, if the name is not defined.
static const char *plain_command(const CagRepl *repl, const char *line) {
  static const struct {
    const char *word, *command;
  } plain[] = {{"help", ":help"}, {"exit", ":quit"}, {"quit", ":quit"}};
  line += strspn(line, " \t");
  const size_t n = strcspn(line, " \t(;");
  const char *rest = line + n + strspn(line + n, " \t");
  if (strcmp(rest, "") != 0 && strcmp(rest, "()") != 0 && strcmp(rest, ";") != 0) return NULL;
  for (size_t i = 0; i < sizeof plain / sizeof *plain; i++) {
    if (strlen(plain[i].word) != n || strncmp(plain[i].word, line, n) != 0) continue;
    const char *name;
    for (size_t k = 0; (name = cag_session_name(repl->session, k, NULL, NULL)); k++)
      if (strcmp(name, plain[i].word) == 0) return NULL;
    return plain[i].command;
  }
  return NULL;
}

static void take_line(CagRepl *repl, Text *t, char *line) {
  if (!t->bytes && is_blank(line)) return;
  const char *plain = t->bytes ? NULL : plain_command(repl, line);
  if (!t->bytes && (plain || line[strspn(line, " \t")] == ':')) {
    char *command = strdup(plain ? plain : line + strspn(line, " \t"));
    cag_repl_remember(repl->input, line, strlen(line));
    if (command) cag_repl_command(repl, command);
    free(command);
    return;
  }
  add_line(t, line);
  if (!t->bytes || wants_more(repl, t)) return;
  cag_repl_remember(repl->input, t->bytes, t->length);
  cag_repl_evaluate(repl, t->bytes, t->length);
  clear_text(t);
}

// --- Ctrl-C ---

// Set only by Ctrl-C, not by other signals.
static volatile sig_atomic_t keyboard;

static void on_keyboard(int number) {
  (void)number;
  keyboard = 1;
  cag_tool_interrupt = 1;
}

static void catch_keyboard(void) {
  struct sigaction action = {.sa_handler = on_keyboard};
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, NULL);
}

// Resets Ctrl-C. Returns false if the program was asked to end by another signal.
static bool go_on(CagRepl *repl) {
  if (!cag_tool_interrupt) return true;
  if (!repl->interactive || !keyboard) return false;
  keyboard = 0;
  cag_tool_interrupt = 0;
  return true;
}

// Ctrl-C discards an incomplete input, but the history keeps it.
static void drop_text(CagRepl *repl, Text *t) {
  if (t->bytes) cag_repl_remember(repl->input, t->bytes, t->length);
  clear_text(t);
}

static void read_texts(CagRepl *repl) {
  Text text = {0};
  char *line;
  while (!repl->quit && go_on(repl)) {
    repl->before = text.bytes;
    CagReplRead read = cag_repl_read(repl->input, text.bytes != NULL, &line);
    if (read == CAG_REPL_END) break;
    if (read == CAG_REPL_INTERRUPTED) drop_text(repl, &text);
    else take_line(repl, &text, line);
  }
  // An input that is cut off by the end of the file reports its own error.
  if (text.bytes && !cag_tool_interrupt) cag_repl_evaluate(repl, text.bytes, text.length);
  clear_text(&text);
}

int cag_tool_repl(CagTool *t, int argc, char **argv) {
  CagRepl repl = {.tool = t, .interactive = isatty(STDIN_FILENO) && isatty(STDOUT_FILENO)};
  repl.session = cag_tool_session(t);
  if (!repl.session) return CAG_STATUS_LIMIT;
  repl.input = cag_repl_input_new(&repl);
  if (!repl.input) {
    cag_session_free(repl.session);
    return cag_tool_fail(t, CAG_STATUS_LIMIT, NULL, "out of memory");
  }
  if (repl.interactive) catch_keyboard();
  if (repl.interactive && !t->quiet)
    printf("cag %s - :help lists the commands, Ctrl-D ends\n", cag_version());
  if (argc > 0) cag_repl_load(&repl, argv[0]);
  read_texts(&repl);
  cag_repl_input_free(repl.input);
  cag_session_free(repl.session);
  while (repl.loaded_count) free(repl.loaded[--repl.loaded_count]);
  free(repl.loaded);
  return repl.interactive ? CAG_STATUS_OK : repl.status;
}
