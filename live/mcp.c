// The connection: lines, JSON-RPC, the queue of calls, and their cancellation.
//
// One lock protects the output, the queue, and the running call. A call belongs to the queue, then
// to the thread that runs it.

#include "live/mcp.h"

#include <errno.h>
#include <poll.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <utf8proc.h>

#include "base/clock.h"
#include "live/mcp_tools.h"

// Longer lines are refused without being kept.
#define LINE_MOST ((size_t)16 << 20)
// More calls than this do not wait.
#define WAITING_MOST 64
// The shortest time between two notifications of progress, in seconds.
#define PROGRESS_TIME 0.1
// Milliseconds between looks at the interrupt flag, because a signal may arrive on another thread.
#define LOOK 200

// The codes of JSON-RPC 2.0, section 5.1.
enum {
  PARSE_ERROR = -32700,
  INVALID_REQUEST = -32600,
  METHOD_NOT_FOUND = -32601,
  INVALID_PARAMS = -32602,
  INTERNAL_ERROR = -32603,
  BUSY = -32000 // of this server
};

// The revisions of the protocol, the latest first.
static const char *const REVISIONS[] = {"2025-06-18", "2025-03-26", "2024-11-05"};
#define LATEST 0
#define REVISION_COUNT (sizeof REVISIONS / sizeof *REVISIONS)

static const char INSTRUCTIONS[] =
    "cag is a small declarative language for geometry and scenes: curves, surfaces, solids, meshes, "
    "robots, and cameras. Lengths are in millimeters, Z is up. Begin with the tool documentation "
    "and the name language-card, which has the language on one page; the tool examples finds "
    "scripts to start from. Then check, run, and look at the views.";

// Answers of a batch (an array of requests, in older revisions) are sent together.
typedef struct Batch {
  cJSON *answers;
  size_t pending; // requests that are not answered, and 1 until all are read
} Batch;

typedef struct Waiting {
  cJSON *id, *params;
  Batch *batch; // NULL: none
  CagMcpCall call;
  struct Server *server;
  bool cancelled;
  double progress_time, progress; // of the last notification
  struct Waiting *next;
} Waiting;

typedef struct Server {
  const CagMcpOptions *options;
  int in, out;
  size_t revision; // index
  pthread_mutex_t lock;
  pthread_cond_t changed;
  Waiting *first, **last, *running;
  size_t waiting_count;
  bool ending; // no more calls come
  bool done;   // the thread of calls has ended
  bool broken; // the reader of the output is gone
} Server;

// --- Output (under the lock) ---

static void send_bytes(Server *s, const char *bytes, size_t n) {
  while (n > 0 && !s->broken) {
    const ssize_t k = write(s->out, bytes, n);
    if (k < 0 && errno != EINTR) s->broken = true;
    if (k <= 0) continue;
    bytes += k;
    n -= (size_t)k;
  }
}

// Takes over the message.
static void send_message(Server *s, cJSON *message) {
  char *text = cJSON_PrintUnformatted(message);
  cJSON_Delete(message);
  if (!text) {
    s->broken = true; // an answer that cannot be sent would be waited for
    return;
  }
  send_bytes(s, text, strlen(text));
  send_bytes(s, "\n", 1);
  cJSON_free(text);
}

static void settle_batch(Server *s, Batch *b) {
  if (--b->pending > 0) return;
  if (cJSON_GetArraySize(b->answers) > 0) send_message(s, b->answers);
  else cJSON_Delete(b->answers);
  free(b);
}

static void send_answer(Server *s, Batch *batch, cJSON *answer) {
  if (!batch) {
    send_message(s, answer);
    return;
  }
  cJSON_AddItemToArray(batch->answers, answer);
  settle_batch(s, batch);
}

static cJSON *new_message(void) {
  cJSON *m = cJSON_CreateObject();
  cJSON_AddStringToObject(m, "jsonrpc", "2.0");
  return m;
}

// Takes over the result. A request without an id is a notification, which has no answer.
static void answer(Server *s, Batch *batch, const cJSON *id, cJSON *result) {
  cJSON *m = new_message();
  cJSON_AddItemToObject(m, "id", cJSON_Duplicate(id, false));
  cJSON_AddItemToObject(m, "result", result);
  send_answer(s, batch, m);
}

static void refuse(Server *s, Batch *batch, const cJSON *id, int code, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

// id NULL: it could not be read.
static void refuse(Server *s, Batch *batch, const cJSON *id, int code, const char *format, ...) {
  char text[700];
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  cJSON *m = new_message();
  cJSON_AddItemToObject(m, "id", id ? cJSON_Duplicate(id, false) : cJSON_CreateNull());
  cJSON *error = cJSON_AddObjectToObject(m, "error");
  cJSON_AddNumberToObject(error, "code", code);
  cJSON_AddStringToObject(error, "message", text);
  send_answer(s, batch, m);
}

// --- Calls of tools ---

static void free_waiting(Waiting *w) {
  cJSON_Delete(w->id);
  cJSON_Delete(w->params);
  cJSON_Delete(w->call.content);
  cJSON_Delete(w->call.structured);
  free(w);
}

// Progress must increase (2025-06-18, utilities/progress).
static void report_progress(void *context, double percent, const char *message) {
  Waiting *w = context;
  Server *s = w->server;
  const double now = cag_clock_seconds();
  if (!(percent > w->progress) || now - w->progress_time < PROGRESS_TIME) return;
  w->progress = percent;
  w->progress_time = now;
  cJSON *m = new_message();
  const cJSON *meta = cJSON_GetObjectItemCaseSensitive(w->params, "_meta");
  cJSON_AddStringToObject(m, "method", "notifications/progress");
  cJSON *params = cJSON_AddObjectToObject(m, "params");
  cJSON_AddItemToObject(
      params, "progressToken",
      cJSON_Duplicate(cJSON_GetObjectItemCaseSensitive(meta, "progressToken"), false));
  cag_json_add_number(params, "progress", percent);
  cJSON_AddNumberToObject(params, "total", 100);
  cJSON_AddStringToObject(params, "message", message);
  pthread_mutex_lock(&s->lock);
  if (w->cancelled) cJSON_Delete(m);
  else send_message(s, m);
  pthread_mutex_unlock(&s->lock);
}

static cJSON *call_result(CagMcpCall *call) {
  cJSON *result = cJSON_CreateObject();
  cJSON_AddItemToObject(result, "content", call->content);
  if (call->structured) cJSON_AddItemToObject(result, "structuredContent", call->structured);
  cJSON_AddBoolToObject(result, "isError", call->is_error);
  call->content = call->structured = NULL;
  return result;
}

// A cancelled call has no answer (2025-06-18, utilities/cancellation).
static void finish_call(Server *s, Waiting *w, bool valid) {
  if (w->cancelled && w->batch) settle_batch(s, w->batch);
  if (w->cancelled) return;
  if (valid) answer(s, w->batch, w->id, call_result(&w->call));
  else refuse(s, w->batch, w->id, INVALID_PARAMS, "%s", w->call.refusal);
}

static void run_call(Server *s, Waiting *w) {
  const cJSON *arguments = cJSON_GetObjectItemCaseSensitive(w->params, "arguments"), *none = NULL;
  const cJSON *token = cJSON_GetObjectItemCaseSensitive(
      cJSON_GetObjectItemCaseSensitive(w->params, "_meta"), "progressToken");
  const char *name = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(w->params, "name"));
  cJSON *empty = arguments ? NULL : cJSON_CreateObject();
  w->call.options = s->options;
  w->call.arguments = arguments ? arguments : empty;
  if (cJSON_IsString(token) || cJSON_IsNumber(token)) {
    w->call.progress = report_progress;
    w->call.progress_context = w;
  }
  const bool valid = cag_mcp_call_tool(name, &w->call);
  pthread_mutex_lock(&s->lock);
  s->running = NULL;
  finish_call(s, w, valid);
  pthread_mutex_unlock(&s->lock);
  w->call.arguments = none;
  cJSON_Delete(empty);
}

static void *run_calls(void *server) {
  Server *s = server;
  pthread_mutex_lock(&s->lock);
  while (s->first || !s->ending) {
    Waiting *w = s->first;
    if (!w) {
      pthread_cond_wait(&s->changed, &s->lock);
      continue;
    }
    s->first = w->next;
    if (!s->first) s->last = &s->first;
    s->waiting_count--;
    s->running = w;
    pthread_mutex_unlock(&s->lock);
    run_call(s, w);
    free_waiting(w);
    pthread_mutex_lock(&s->lock);
  }
  s->done = true;
  pthread_cond_broadcast(&s->changed);
  pthread_mutex_unlock(&s->lock);
  return NULL;
}

// Takes over the params.
static void queue_call(Server *s, Batch *batch, const cJSON *id, cJSON *params) {
  Waiting *w = calloc(1, sizeof *w);
  if (!w || s->waiting_count >= WAITING_MOST) {
    refuse(s, batch, id, w ? BUSY : INTERNAL_ERROR,
           w ? "more than %d calls are waiting" : "out of memory", WAITING_MOST);
    cJSON_Delete(params);
    free(w);
    return;
  }
  *w = (Waiting){.id = cJSON_Duplicate(id, false), .params = params, .batch = batch, .server = s};
  *s->last = w;
  s->last = &w->next;
  s->waiting_count++;
  pthread_cond_broadcast(&s->changed);
}

static void call_tool(Server *s, Batch *batch, const cJSON *id, cJSON *params) {
  const cJSON *name = cJSON_GetObjectItemCaseSensitive(params, "name"),
              *arguments = cJSON_GetObjectItemCaseSensitive(params, "arguments");
  if (!cJSON_IsString(name))
    refuse(s, batch, id, INVALID_PARAMS, "name: expected the name of a tool");
  else if (arguments && !cJSON_IsObject(arguments))
    refuse(s, batch, id, INVALID_PARAMS, "arguments: expected a record");
  else {
    queue_call(s, batch, id, cJSON_Duplicate(params, true));
    return;
  }
}

static void stop_call(Waiting *w) {
  w->cancelled = true;
  w->call.stop = 1;
}

static void cancel(Server *s, const cJSON *params) {
  const cJSON *id = cJSON_GetObjectItemCaseSensitive(params, "requestId");
  if (!id) return;
  if (s->running && cJSON_Compare(s->running->id, id, true)) stop_call(s->running);
  for (Waiting **at = &s->first; *at; at = &(*at)->next) {
    Waiting *w = *at;
    if (!cJSON_Compare(w->id, id, true)) continue;
    *at = w->next;
    if (!*at) s->last = at;
    s->waiting_count--;
    if (w->batch) settle_batch(s, w->batch);
    free_waiting(w);
    return;
  }
}

// --- Requests (under the lock) ---

static void initialize(Server *s, Batch *batch, const cJSON *id, const cJSON *params) {
  const char *wanted =
      cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(params, "protocolVersion"));
  if (!wanted) {
    refuse(s, batch, id, INVALID_PARAMS, "protocolVersion: expected a text");
    return;
  }
  s->revision = LATEST;
  for (size_t i = 0; i < REVISION_COUNT; i++)
    if (!strcmp(REVISIONS[i], wanted)) s->revision = i;
  cJSON *result = cJSON_CreateObject();
  cJSON_AddStringToObject(result, "protocolVersion", REVISIONS[s->revision]);
  cJSON *tools = cJSON_AddObjectToObject(cJSON_AddObjectToObject(result, "capabilities"), "tools");
  cJSON_AddBoolToObject(tools, "listChanged", false);
  cJSON *info = cJSON_AddObjectToObject(result, "serverInfo");
  cJSON_AddStringToObject(info, "name", "cag");
  cJSON_AddStringToObject(info, "title", "cag: geometry scripts");
  cJSON_AddStringToObject(info, "version", cag_version());
  cJSON_AddStringToObject(result, "instructions", INSTRUCTIONS);
  answer(s, batch, id, result);
}

static void handle_request(Server *s, Batch *batch, const char *method, const cJSON *id,
                           cJSON *params) {
  if (!strcmp(method, "initialize")) initialize(s, batch, id, params);
  else if (!strcmp(method, "ping")) answer(s, batch, id, cJSON_CreateObject());
  else if (!strcmp(method, "tools/list")) answer(s, batch, id, cag_mcp_tool_list());
  else if (!strcmp(method, "tools/call")) call_tool(s, batch, id, params);
  else refuse(s, batch, id, METHOD_NOT_FOUND, "unknown method `%.200s`", method);
}

// Handles a request or notification. Answers to requests of this server do not occur, since it has
// none, and are ignored.
static void handle_message(Server *s, Batch *batch, const cJSON *m) {
  cJSON *params = cJSON_GetObjectItemCaseSensitive(m, "params");
  const cJSON *id = cJSON_GetObjectItemCaseSensitive(m, "id"),
              *version = cJSON_GetObjectItemCaseSensitive(m, "jsonrpc");
  const char *method = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(m, "method"));
  const bool has_id = cJSON_IsString(id) || cJSON_IsNumber(id);
  const bool is_answer = has_id && !method &&
                         (cJSON_GetObjectItemCaseSensitive(m, "result") ||
                          cJSON_GetObjectItemCaseSensitive(m, "error"));
  const bool good = cJSON_IsObject(m) && cJSON_IsString(version) &&
                    !strcmp(version->valuestring, "2.0") && method && (!id || has_id) &&
                    (!params || cJSON_IsObject(params));
  if (is_answer || (good && !id)) {
    if (good && !strcmp(method, "notifications/cancelled")) cancel(s, params);
    return;
  }
  if (batch) batch->pending++;
  if (!good)
    refuse(s, batch, has_id ? id : NULL, INVALID_REQUEST,
           "expected a request of JSON-RPC 2.0 with a method, an id, and params as a record");
  else handle_request(s, batch, method, id, params);
}

static void handle_batch(Server *s, const cJSON *list) {
  const cJSON *m;
  Batch *batch = NULL;
  if (s->revision == LATEST) {
    refuse(s, NULL, NULL, INVALID_REQUEST, "this revision of the protocol has no batches");
    return;
  }
  if (cJSON_GetArraySize(list) > 0) batch = calloc(1, sizeof *batch);
  if (!batch) {
    refuse(s, NULL, NULL, INVALID_REQUEST, "expected a batch of at least one request");
    return;
  }
  *batch = (Batch){.answers = cJSON_CreateArray(), .pending = 1};
  cJSON_ArrayForEach(m, list) handle_message(s, batch, m);
  settle_batch(s, batch);
}

// --- Lines ---

static bool is_utf8(const char *text, size_t n) {
  for (size_t i = 0; i < n;) {
    utf8proc_int32_t c;
    const utf8proc_ssize_t k =
        utf8proc_iterate((const utf8proc_uint8_t *)text + i, (utf8proc_ssize_t)(n - i), &c);
    if (k <= 0) return false;
    i += (size_t)k;
  }
  return true;
}

static bool is_blank(const char *text, size_t n) {
  for (size_t i = 0; i < n; i++)
    if (!strchr(" \t\r", text[i]) || !text[i]) return false;
  return true;
}

// Texts here end with a zero, so one that contains a zero would be cut.
static bool has_zero(const char *text, size_t n) {
  static const char ZERO[] = "\\u0000";
  return memchr(text, 0, n) || memmem(text, n, ZERO, sizeof ZERO - 1);
}

static void handle_line(Server *s, char *text, size_t n) {
  const char *end = NULL;
  if (is_blank(text, n)) return;
  cJSON *m = is_utf8(text, n) && !has_zero(text, n)
                 ? cJSON_ParseWithLengthOpts(text, n + 1, &end, true)
                 : NULL;
  pthread_mutex_lock(&s->lock);
  if (!m) refuse(s, NULL, NULL, PARSE_ERROR, "expected a line of JSON in UTF-8");
  else if (cJSON_IsArray(m)) handle_batch(s, m);
  else handle_message(s, NULL, m);
  pthread_mutex_unlock(&s->lock);
  cJSON_Delete(m);
}

static void refuse_line(Server *s) {
  pthread_mutex_lock(&s->lock);
  refuse(s, NULL, NULL, INVALID_REQUEST, "a line is longer than %zu MiB", LINE_MOST >> 20);
  pthread_mutex_unlock(&s->lock);
}

// The part of the input that has no end of line yet.
typedef struct Input {
  char *bytes;
  size_t length, capacity;
  bool skipping; // the line is too long
} Input;

static bool keep_bytes(Input *in, const char *bytes, size_t n) {
  if (in->length + n + 1 > in->capacity) {
    const size_t capacity = 2 * (in->length + n) + 1;
    char *larger = realloc(in->bytes, capacity);
    if (!larger) return false;
    in->bytes = larger;
    in->capacity = capacity;
  }
  memcpy(in->bytes + in->length, bytes, n);
  in->length += n;
  in->bytes[in->length] = 0;
  return true;
}

static void end_line(Server *s, Input *in) {
  if (in->skipping) refuse_line(s);
  else if (in->length > 0) handle_line(s, in->bytes, in->length);
  in->length = 0;
  in->skipping = false;
}

static bool take_bytes(Server *s, Input *in, const char *bytes, size_t n) {
  while (n > 0) {
    const char *newline = memchr(bytes, '\n', n);
    const size_t k = newline ? (size_t)(newline - bytes) : n;
    if (in->length + k > LINE_MOST) in->skipping = true, in->length = 0;
    if (!in->skipping && !keep_bytes(in, bytes, k)) return false;
    if (newline) end_line(s, in);
    bytes += k + (newline != NULL);
    n -= k + (newline != NULL);
  }
  return true;
}

static bool is_interrupted(const Server *s) {
  return s->options->interrupt && *s->options->interrupt;
}

static bool is_broken(Server *s) {
  pthread_mutex_lock(&s->lock);
  const bool broken = s->broken;
  pthread_mutex_unlock(&s->lock);
  return broken;
}

static int read_input(Server *s) {
  Input in = {0};
  char bytes[65536];
  int status = CAG_STATUS_OK;
  while (!is_interrupted(s) && !is_broken(s)) {
    struct pollfd p = {.fd = s->in, .events = POLLIN};
    if (poll(&p, 1, LOOK) <= 0) continue;
    const ssize_t n = read(s->in, bytes, sizeof bytes);
    if (n < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (n < 0) status = CAG_STATUS_FILE;
    if (n > 0 && !take_bytes(s, &in, bytes, (size_t)n)) status = CAG_STATUS_LIMIT;
    if (n == 0) end_line(s, &in);
    if (n == 0 || status != CAG_STATUS_OK) break;
  }
  free(in.bytes);
  return status;
}

// --- The server ---

// Drops the waiting calls, and stops the running one.
static void stop_all(Server *s) {
  while (s->first) {
    Waiting *w = s->first;
    s->first = w->next;
    if (w->batch) settle_batch(s, w->batch);
    free_waiting(w);
  }
  s->last = &s->first;
  s->waiting_count = 0;
  if (s->running) stop_call(s->running);
}

// At the end of the input, the calls that came before it are answered.
static void end_calls(Server *s) {
  pthread_mutex_lock(&s->lock);
  s->ending = true;
  pthread_cond_broadcast(&s->changed);
  while (!s->done) {
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += LOOK * 1000000L;
    until.tv_sec += until.tv_nsec / 1000000000L;
    until.tv_nsec %= 1000000000L;
    if (is_interrupted(s) || s->broken) stop_all(s);
    pthread_cond_timedwait(&s->changed, &s->lock, &until);
  }
  pthread_mutex_unlock(&s->lock);
}

int cag_mcp_serve(const CagMcpOptions *options, int in, int out) {
  Server s = {.options = options, .in = in, .out = out};
  pthread_t thread;
  s.last = &s.first;
  pthread_mutex_init(&s.lock, NULL);
  pthread_cond_init(&s.changed, NULL);
  int status = CAG_STATUS_LIMIT;
  if (pthread_create(&thread, NULL, run_calls, &s) == 0) {
    status = read_input(&s);
    end_calls(&s);
    pthread_join(thread, NULL);
    if (s.broken) status = CAG_STATUS_FILE;
    if (is_interrupted(&s)) status = CAG_STATUS_INTERRUPTED;
  }
  pthread_cond_destroy(&s.changed);
  pthread_mutex_destroy(&s.lock);
  return status;
}
