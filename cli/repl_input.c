// Lines of the REPL: from libedit on a terminal, else unedited.
//
// The history is a text file, $XDG_STATE_HOME/cag/history (by default in ~/.local/state), with one
// line for each input. Newlines within an input are stored as LINE_BREAK, which scripts never
// contain. An input is appended when it is complete, so that concurrent sessions keep each other's
// entries. The file is truncated at the start if it has grown. All errors are ignored, because the
// history is not essential.

#include <errno.h>
#include <fcntl.h>
#include <histedit.h>
#include <langinfo.h>
#include <locale.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <wchar.h>

#include "base/state_file.h"
#include "base/utf8.h"
#include "cli/repl.h"

// Lines of history that are kept, and the length at which the file is truncated.
#define HISTORY_LINES 2000
#define HISTORY_FILE_LINES 4000
// Replaces a newline in the file: the ASCII unit separator.
#define LINE_BREAK '\x1f'

struct CagReplInput {
  CagRepl *repl;
  EditLine *editor; // NULL without a terminal
  History *history;
  char *history_path; // NULL: not kept
  char *line;
  size_t capacity;
  char *next; // the line that was read ahead
  size_t next_capacity;
  bool has_next;
  bool more;
  char *last; // the last line of the history
};

// --- History ---

static void remember(CagReplInput *in, const char *line) {
  HistEvent event;
  if (!*line || (in->last && strcmp(in->last, line) == 0)) return;
  history(in->history, &event, H_ENTER, line);
  free(in->last);
  in->last = strdup(line);
}

static void append_line(const CagReplInput *in, const char *line) {
  if (!in->history_path) return;
  int fd = open(in->history_path, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0600);
  if (fd < 0) return;
  char *whole;
  int n = asprintf(&whole, "%s\n", line);
  if (n >= 0) {
    ssize_t ignored = write(fd, whole, (size_t)n); // a single write, so that sessions do not mix
                                                   // lines
    (void)ignored;
    free(whole);
  }
  close(fd);
}

// Keeps the last lines of a file that has grown.
static void cut_history(const CagReplInput *in, size_t lines) {
  char *path = NULL, *line = NULL;
  size_t capacity = 0, k = 0;
  if (asprintf(&path, "%s.new", in->history_path) < 0) return;
  FILE *from = fopen(in->history_path, "re"), *to = fopen(path, "we");
  while (from && to && getline(&line, &capacity, from) >= 0)
    if (++k + HISTORY_LINES > lines) fputs(line, to);
  bool ok = to && fclose(to) == 0;
  if (from) fclose(from);
  if (ok) chmod(path, 0600);
  if (!from || !ok || rename(path, in->history_path) != 0) unlink(path);
  free(line);
  free(path);
}

static void replace_all(char *text, char from, char to) {
  for (; *text; text++)
    if (*text == from) *text = to;
}

static void load_history(CagReplInput *in) {
  char *line = NULL;
  size_t capacity = 0, lines = 0;
  ssize_t n;
  FILE *f = in->history_path ? fopen(in->history_path, "re") : NULL;
  if (!f) return;
  while ((n = getline(&line, &capacity, f)) >= 0) {
    if (n > 0 && line[n - 1] == '\n') line[n - 1] = 0;
    replace_all(line, LINE_BREAK, '\n');
    remember(in, line);
    lines++;
  }
  free(line);
  fclose(f);
  if (lines > HISTORY_FILE_LINES) cut_history(in, lines);
}

void cag_repl_remember(CagReplInput *in, const char *text, size_t length) {
  while (length && (text[length - 1] == '\n' || text[length - 1] == ' ')) length--;
  char *copy = in->editor ? strndup(text, length) : NULL;
  const bool again = copy && in->last && strcmp(in->last, copy) == 0;
  if (copy && *copy && !again) {
    remember(in, copy);
    replace_all(copy, '\n', LINE_BREAK);
    append_line(in, copy);
  }
  free(copy);
}

// --- The line editor ---

static CagReplInput *input_of(EditLine *editor) {
  CagReplInput *in = NULL;
  el_get(editor, EL_CLIENTDATA, &in);
  return in;
}

static char *prompt(EditLine *editor) {
  static char first[] = "cag> ", next[] = "...> ";
  return input_of(editor)->more ? next : first;
}

// --- Signals at the prompt: window size changes, and Ctrl-Z ---

static volatile sig_atomic_t window_changed, stop_asked;

static void note(int signal) {
  if (signal == SIGWINCH) window_changed = 1;
  else stop_asked = 1;
}

// Redraws the line for the new size. Terminals rewrap their contents, so the first row of the line
// is found by counting with the new width.
static void redraw(EditLine *editor) {
  struct winsize size = {0};
  const LineInfo *line = el_line(editor);
  const char *first = prompt(editor);
  window_changed = 0;
  ioctl(STDOUT_FILENO, TIOCGWINSZ, &size);
  const size_t column =
      strlen(first) + cag_utf8_count(line->buffer, (size_t)(line->cursor - line->buffer));
  const size_t rows = size.ws_col ? column / size.ws_col : 0;
  fputs("\r", stdout);
  if (rows) printf("\033[%zuA", rows);
  fputs("\033[J", stdout);
  fflush(stdout);
  el_resize(editor);
  el_set(editor, EL_REFRESH);
}

// Restores the terminal, stops the process, and continues with the line when the shell resumes it.
static void stop(EditLine *editor) {
  stop_asked = 0;
  el_set(editor, EL_PREP_TERM, 0);
  fputs("\n", stdout);
  fflush(stdout);
  // The signal's default action, with which the system does not stop an orphaned process.
  const struct sigaction plain = {.sa_handler = SIG_DFL};
  struct sigaction ours;
  sigaction(SIGTSTP, &plain, &ours);
  raise(SIGTSTP);
  sigaction(SIGTSTP, &ours, NULL);
  el_set(editor, EL_PREP_TERM, 1);
  el_resize(editor);
  el_set(editor, EL_REFRESH);
}

// Waits for a byte, and handles changes of the window's size. Returns false if a signal ends the
// line.
static bool wait_for_byte(EditLine *editor) {
  struct pollfd input = {.fd = STDIN_FILENO, .events = POLLIN};
  for (;;) {
    if (cag_tool_interrupt) return false;
    if (window_changed) redraw(editor);
    if (stop_asked) stop(editor);
    if (poll(&input, 1, -1) >= 0) return true;
    if (errno != EINTR) return false;
  }
}

// Reads one UTF-8 character. A signal ends the line, whereas libedit's own reader would continue.
static int read_character(EditLine *editor, wchar_t *out) {
  (void)editor;
  mbstate_t state = {0};
  for (;;) {
    char byte;
    if (!wait_for_byte(editor)) return -1;
    ssize_t n = read(STDIN_FILENO, &byte, 1);
    if (n < 0 && errno == EINTR && !cag_tool_interrupt) continue;
    if (n < 0) return -1;
    if (n == 0) return 0;
    size_t k = mbrtowc(out, &byte, 1, &state);
    if (k == (size_t)-1) memset(&state, 0, sizeof state); // invalid character: skip it
    else if (k != (size_t)-2) return 1;
  }
}

// Lists the completions below the line, in columns.
static void list_proposals(const CagReplProposals *p) {
  struct winsize size = {0};
  size_t longest = 0;
  ioctl(STDOUT_FILENO, TIOCGWINSZ, &size);
  for (size_t i = 0; i < p->count; i++)
    if (strlen(p->items[i]) > longest) longest = strlen(p->items[i]);
  size_t width = longest + 2, columns = size.ws_col > width ? size.ws_col / width : 1;
  size_t rows = (p->count + columns - 1) / columns;
  putchar('\n');
  for (size_t r = 0; r < rows; r++) {
    for (size_t i = r; i < p->count; i += rows) printf("%-*s", (int)width, p->items[i]);
    putchar('\n');
  }
  fflush(stdout);
}

static size_t common_length(const CagReplProposals *p) {
  size_t n = strlen(p->items[0]);
  for (size_t i = 1; i < p->count; i++) {
    size_t k = 0;
    while (k < n && p->items[i][k] == p->items[0][k]) k++;
    n = k;
  }
  return cag_utf8_start(p->items[0], n); // whole characters
}

static unsigned char complete(EditLine *editor, int key) {
  (void)key;
  const LineInfo *line = el_line(editor);
  char *text = strndup(line->buffer, (size_t)(line->cursor - line->buffer));
  if (!text) return CC_ERROR;
  CagReplProposals p = cag_repl_propose(input_of(editor)->repl, text);
  unsigned char result = CC_REFRESH_BEEP;
  if (p.count > 0) {
    size_t n = common_length(&p);
    if (n > p.length) {
      char *rest = strndup(p.items[0] + p.length, n - p.length);
      result = rest && el_insertstr(editor, rest) == 0 ? CC_REFRESH : CC_ERROR;
      free(rest);
    } else if (p.count > 1) {
      list_proposals(&p);
      result = CC_REDISPLAY;
    } else {
      result = CC_NORM;
    }
  }
  cag_repl_proposals_free(&p);
  free(text);
  return result;
}

static bool start_editor(CagReplInput *in) {
  HistEvent event;
  if (strcmp(nl_langinfo(CODESET), "UTF-8") != 0) setlocale(LC_CTYPE, "C.UTF-8");
  in->history = history_init();
  in->editor = el_init("cag", stdin, stdout, stderr);
  if (!in->history || !in->editor) return false;
  history(in->history, &event, H_SETSIZE, HISTORY_LINES);
  el_set(in->editor, EL_CLIENTDATA, in);
  el_set(in->editor, EL_PROMPT, prompt);
  el_set(in->editor, EL_EDITOR, "emacs");
  el_set(in->editor, EL_SIGNAL, 0);
  el_set(in->editor, EL_HIST, history, in->history);
  el_set(in->editor, EL_GETCFN, read_character);
  el_set(in->editor, EL_ADDFN, "cag-complete", "Complete the word", complete);
  el_set(in->editor, EL_BIND, "^I", "cag-complete", NULL);
  el_set(in->editor, EL_BIND, "^R", "em-inc-search-prev", NULL);
  el_source(in->editor, NULL);
  in->history_path = cag_state_file("history");
  load_history(in);
  return true;
}

static bool keep_line(CagReplInput *in, const char *line, size_t n) {
  if (n + 1 > in->capacity) {
    char *larger = realloc(in->line, n + 1);
    if (!larger) return false;
    in->line = larger;
    in->capacity = n + 1;
  }
  memcpy(in->line, line, n);
  in->line[n] = 0;
  return true;
}

static CagReplRead edit_line(CagReplInput *in, char **line) {
  int n = 0;
  fflush(stdout);
  fflush(stderr);
  struct sigaction on = {.sa_handler = note, .sa_flags = SA_RESTART}, window, stopping;
  sigaction(SIGWINCH, &on, &window);
  sigaction(SIGTSTP, &on, &stopping);
  el_resize(in->editor); // the size may have changed
  el_set(in->editor, EL_PREP_TERM, 1);
  const char *text = el_gets(in->editor, &n);
  el_set(in->editor, EL_PREP_TERM, 0);
  sigaction(SIGWINCH, &window, NULL);
  sigaction(SIGTSTP, &stopping, NULL);
  if (cag_tool_interrupt) {
    fputs("^C\n", stdout);
    return CAG_REPL_INTERRUPTED;
  }
  if (!text || n <= 0) {
    putchar('\n');
    return CAG_REPL_END;
  }
  size_t length = strlen(text); // a text from the history may contain newlines
  while (length && (text[length - 1] == '\n' || text[length - 1] == '\r')) length--;
  if (!keep_line(in, text, length)) return CAG_REPL_END;
  *line = in->line;
  return CAG_REPL_LINE;
}

// --- Plain lines ---

// Reads a line into a buffer, without its line end. A zero byte ends it.
static bool read_plain(char **line, size_t *capacity) {
  ssize_t n = getline(line, capacity, stdin);
  if (n < 0) return false;
  while (n > 0 && ((*line)[n - 1] == '\n' || (*line)[n - 1] == '\r')) (*line)[--n] = 0;
  return true;
}

const char *cag_repl_peek(CagReplInput *in) {
  if (!in->has_next) in->has_next = read_plain(&in->next, &in->next_capacity);
  return in->has_next ? in->next : NULL;
}

static CagReplRead plain_line(CagReplInput *in, char **line) {
  if (!cag_repl_peek(in)) return cag_tool_interrupt ? CAG_REPL_INTERRUPTED : CAG_REPL_END;
  char *bytes = in->line;
  size_t capacity = in->capacity;
  in->line = in->next;
  in->capacity = in->next_capacity;
  in->next = bytes;
  in->next_capacity = capacity;
  in->has_next = false;
  *line = in->line;
  return CAG_REPL_LINE;
}

CagReplRead cag_repl_read(CagReplInput *in, bool more, char **line) {
  in->more = more;
  return in->editor ? edit_line(in, line) : plain_line(in, line);
}

CagReplInput *cag_repl_input_new(CagRepl *repl) {
  CagReplInput *in = calloc(1, sizeof *in);
  if (!in) return NULL;
  in->repl = repl;
  if (!repl->interactive || start_editor(in)) return in;
  cag_repl_input_free(in);
  return NULL;
}

void cag_repl_input_free(CagReplInput *in) {
  if (in->editor) el_end(in->editor);
  if (in->history) history_end(in->history);
  free(in->history_path);
  free(in->line);
  free(in->next);
  free(in->last);
  free(in);
}
