// The language server on two files: framing, the queue of messages, and cancellation.
//
// A thread reads messages into a queue, so that a message can end the work of the one before it: a
// request that is canceled while it waits is answered at once, and a change of a document ends a
// check of the old text. Checks are made only when the queue is empty, so many changes in a row
// cause one check.

#include <cjson/cJSON.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "live/lsp.h"

// Longer messages are refused.
#define LENGTH_MAX ((size_t)256 << 20)
// The reader waits if the messages that were not handled yet are longer than this together.
#define QUEUE_MAX ((size_t)512 << 20)
#define HEADER_MAX 4096

typedef struct Message {
  struct Message *next;
  char *text; // NULL: it could not be read
  size_t length;
  const char *problem; // why not
  char *id;            // of a request, printed; NULL: none
  bool is_change, canceled;
} Message;

typedef struct Serving {
  FILE *in, *out;
  CagLsp *lsp;
  pthread_mutex_t lock, out_lock;
  pthread_cond_t filled, emptied;
  Message *first, *last;
  size_t bytes;
  bool ended, woken, stopped;
  char *running; // id of the request being handled
  bool checking;
  bool failed; // writing failed
} Serving;

// --- Writing ---

static void send(void *context, const char *json, size_t length) {
  Serving *s = context;
  pthread_mutex_lock(&s->out_lock);
  fprintf(s->out, "Content-Length: %zu\r\n\r\n", length);
  fwrite(json, 1, length, s->out);
  if (fflush(s->out) != 0) s->failed = true;
  pthread_mutex_unlock(&s->out_lock);
}

static void wake(void *context) {
  Serving *s = context;
  pthread_mutex_lock(&s->lock);
  s->woken = true;
  pthread_cond_signal(&s->filled);
  pthread_mutex_unlock(&s->lock);
}

// --- Reading ---

static void skip(FILE *in, size_t length) {
  char scrap[4096];
  while (length > 0) {
    const size_t n = fread(scrap, 1, length < sizeof scrap ? length : sizeof scrap, in);
    if (n == 0) return;
    length -= n;
  }
}

// Reads a line of a header without its end. Returns false if there is none.
static bool read_line(FILE *in, char *line, size_t size) {
  size_t n = 0;
  int c;
  while ((c = getc(in)) != EOF && c != '\n')
    if (n + 1 < size) line[n++] = (char)c;
  if (c == EOF && n == 0) return false;
  if (n && line[n - 1] == '\r') n--;
  line[n] = 0;
  return true;
}

// Reads the length of a header. Returns false if it is not a number.
static bool read_length(const char *text, size_t *out) {
  text += strspn(text, " \t");
  char *end;
  if (*text < '0' || *text > '9') return false;
  const unsigned long long n = strtoull(text, &end, 10); // a larger number becomes the largest
  *out = n > SIZE_MAX ? SIZE_MAX : (size_t)n;
  return end[strspn(end, " \t")] == 0;
}

typedef enum Header { HEADER_GOOD, HEADER_BAD, HEADER_END } Header;

static Header read_header(FILE *in, size_t *length) {
  char line[HEADER_MAX];
  bool any = false, good = false, bad = false;
  while (read_line(in, line, sizeof line)) {
    if (!*line) {
      if (!any) continue; // blank lines between messages
      return good && !bad ? HEADER_GOOD : HEADER_BAD;
    }
    any = true;
    if (strncasecmp(line, "Content-Length:", 15) == 0) {
      bad |= good || !read_length(line + 15, length);
      good = true;
    } else if (strncasecmp(line, "Content-Type:", 13) != 0) {
      bad |= !strchr(line, ':');
    }
  }
  return any ? HEADER_BAD : HEADER_END;
}

// Reads a message. Returns NULL at the end of the file.
static Message *read_message(FILE *in) {
  size_t length = 0;
  const Header header = read_header(in, &length);
  Message *m = header == HEADER_END ? NULL : calloc(1, sizeof *m);
  if (!m) return NULL;
  if (header == HEADER_BAD) {
    m->problem = "expected the header Content-Length with a number";
  } else if (length > LENGTH_MAX || !(m->text = malloc(length + 1))) {
    m->problem = "the message is too long";
    skip(in, length);
  } else if (fread(m->text, 1, length, in) < length) {
    free(m->text);
    m->text = NULL;
    m->problem = "the message is shorter than its header states";
  } else {
    m->text[length] = 0;
    m->length = length;
  }
  return m;
}

static void free_message(Message *m) {
  free(m->text);
  free(m->id);
  free(m);
}

// Notes what the queue needs to know of a message. Returns the id that it cancels, or NULL.
static char *look_into(Message *m) {
  char *canceled = NULL;
  cJSON *json = m->text ? cJSON_ParseWithLength(m->text, m->length) : NULL;
  const cJSON *id = cJSON_GetObjectItemCaseSensitive(json, "id"),
              *method = cJSON_GetObjectItemCaseSensitive(json, "method");
  const char *name = cJSON_IsString(method) ? method->valuestring : "";
  if (id && *name) m->id = cJSON_PrintUnformatted(id);
  m->is_change = strcmp(name, "textDocument/didChange") == 0;
  if (strcmp(name, "$/cancelRequest") == 0) {
    const cJSON *params = cJSON_GetObjectItemCaseSensitive(json, "params"),
                *other = cJSON_GetObjectItemCaseSensitive(params, "id");
    canceled = other ? cJSON_PrintUnformatted(other) : NULL;
  }
  cJSON_Delete(json);
  return canceled;
}

static void cancel(Serving *s, const char *id) {
  for (Message *m = s->first; m; m = m->next)
    if (m->id && strcmp(m->id, id) == 0) m->canceled = true;
  if (s->running && strcmp(s->running, id) == 0) cag_lsp_interrupt(s->lsp);
}

static void *read_all(void *context) {
  Serving *s = context;
  Message *m;
  while ((m = read_message(s->in))) {
    char *canceled = look_into(m);
    pthread_mutex_lock(&s->lock);
    while (s->bytes > QUEUE_MAX && !s->stopped) pthread_cond_wait(&s->emptied, &s->lock);
    if (canceled) cancel(s, canceled);
    if (m->is_change && s->checking) cag_lsp_interrupt(s->lsp);
    if (s->last) s->last->next = m;
    else s->first = m;
    s->last = m;
    s->bytes += m->length;
    const bool stopped = s->stopped;
    pthread_cond_signal(&s->filled);
    pthread_mutex_unlock(&s->lock);
    free(canceled);
    if (stopped) break;
  }
  pthread_mutex_lock(&s->lock);
  s->ended = true;
  pthread_cond_signal(&s->filled);
  pthread_mutex_unlock(&s->lock);
  return NULL;
}

// --- Handling ---

static void answer_problem(Serving *s, const char *id, int code, const char *text) {
  char json[512];
  const int n = snprintf(json, sizeof json,
                         "{\"jsonrpc\":\"2.0\",\"id\":%.200s,\"error\":{\"code\":%d,\"message\":"
                         "\"%s\"}}",
                         id, code, text);
  send(s, json, (size_t)n);
}

static void handle(Serving *s, Message *m) {
  if (m->problem) answer_problem(s, "null", -32700, m->problem);
  else if (m->canceled) answer_problem(s, m->id, -32800, "canceled");
  else cag_lsp_receive(s->lsp, m->text, m->length);
}

// Takes the next message. Waits for one unless there is other work. Returns NULL if there is none.
static Message *take(Serving *s) {
  const bool work = cag_lsp_has_work(s->lsp);
  pthread_mutex_lock(&s->lock);
  while (!s->first && !s->ended && !s->woken && !work) pthread_cond_wait(&s->filled, &s->lock);
  Message *m = s->first;
  if (m) {
    s->first = m->next;
    if (!s->first) s->last = NULL;
    s->bytes -= m->length;
    s->running = m->id;
    pthread_cond_signal(&s->emptied);
  } else {
    s->checking = true;
  }
  s->woken = false;
  pthread_mutex_unlock(&s->lock);
  return m;
}

static void end_piece(Serving *s) {
  pthread_mutex_lock(&s->lock);
  s->running = NULL;
  s->checking = false;
  pthread_mutex_unlock(&s->lock);
}

static bool at_end(Serving *s) {
  pthread_mutex_lock(&s->lock);
  const bool end = s->ended && !s->first;
  pthread_mutex_unlock(&s->lock);
  return end;
}

static int serve(Serving *s) {
  int status = 1;
  while (!cag_lsp_is_done(s->lsp, &status) && !s->failed) {
    Message *m = take(s);
    if (m) handle(s, m);
    else if (at_end(s)) break;
    else cag_lsp_work(s->lsp);
    end_piece(s);
    if (m) free_message(m);
  }
  return status;
}

int cag_lsp_serve(const CagSessionOptions *session, const char *program, FILE *in, FILE *out) {
  Serving s = {.in = in, .out = out};
  const CagLspOptions options = {
      .session = *session, .program = program, .send = send, .wake = wake, .context = &s};
  pthread_t reader;
  pthread_mutex_init(&s.lock, NULL);
  pthread_mutex_init(&s.out_lock, NULL);
  pthread_cond_init(&s.filled, NULL);
  pthread_cond_init(&s.emptied, NULL);
  s.lsp = cag_lsp_new(&options);
  if (!s.lsp || pthread_create(&reader, NULL, read_all, &s) != 0) {
    cag_lsp_free(s.lsp);
    return CAG_STATUS_LIMIT;
  }
  const int status = serve(&s);
  pthread_mutex_lock(&s.lock);
  s.stopped = true;
  pthread_cond_signal(&s.emptied);
  const bool ended = s.ended;
  pthread_mutex_unlock(&s.lock);
  // The reader may wait for input that never comes.
  if (!ended) pthread_cancel(reader);
  pthread_join(reader, NULL);
  cag_lsp_free(s.lsp);
  while (s.first) {
    Message *next = s.first->next;
    free_message(s.first);
    s.first = next;
  }
  pthread_cond_destroy(&s.emptied);
  pthread_cond_destroy(&s.filled);
  pthread_mutex_destroy(&s.out_lock);
  pthread_mutex_destroy(&s.lock);
  return status;
}
