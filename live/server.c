#include "live/server.h"

#include <arpa/inet.h>
#include <errno.h>
#include <netinet/in.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "live/json_write.h"
#include "live/microhttpd.h"
#include "live/server_token.h"

enum { KINDS_MAX = 8, IDLE_SECONDS = 30 };
#define COOKIE "cag-view-%d" // of a port: browsers send the cookies of all ports of a host

// A text that listeners share.
typedef struct SharedText {
  int references;
  size_t length;
  char bytes[];
} SharedText;

typedef struct Event {
  char kind[16];
  SharedText *text; // NULL: not kept
  unsigned long number;
} Event;

typedef struct Listener {
  CagServer *server;
  struct MHD_Connection *connection;
  bool waiting; // the connection is suspended
  SharedText *text;
  size_t sent;        // bytes of `text`
  unsigned long seen; // number of the last event that was begun
  struct Listener *next;
} Listener;

struct CagServer {
  struct MHD_Daemon *daemons[2];
  CagServerOptions options;
  char token[CAG_SERVER_TOKEN + 1];
  int port;
  pthread_mutex_t mutex; // of the events and listeners
  Event events[KINDS_MAX];
  size_t kind_count;
  unsigned long last; // number of the last event
  Listener *listeners;
  size_t listener_count;
  bool stopping;
};

struct CagExchange {
  CagServer *server;
  struct MHD_Connection *connection;
  char *method, *path, *body;
  size_t size, capacity;
  bool too_large, routed;
  struct MHD_Response *response; // once it is answered
  unsigned status;
};

// --- Who may ask ---

// The part of a host before the port: "localhost" of "localhost:8080".
static size_t host_length(const char *host) {
  if (*host == '[') {
    const char *end = strchr(host, ']');
    return end ? (size_t)(end + 1 - host) : 0;
  }
  return strcspn(host, ":");
}

static bool is_loopback(const char *host) {
  static const char *const NAMES[] = {"localhost", "127.0.0.1", "[::1]"};
  const size_t n = host_length(host);
  for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES; i++)
    if (strlen(NAMES[i]) == n && !strncasecmp(NAMES[i], host, n))
      return host[n] == 0 || host[n] == ':';
  return false;
}

// Takes the same time whatever differs.
static bool same_token(const CagServer *s, const char *given) {
  if (!given || strlen(given) != CAG_SERVER_TOKEN) return false;
  unsigned char differs = 0;
  for (int i = 0; i < CAG_SERVER_TOKEN; i++) differs |= (unsigned char)(given[i] ^ s->token[i]);
  return differs == 0;
}

static const char *header_of(struct MHD_Connection *c, const char *name) {
  return cag_microhttpd.lookup_connection_value(c, MHD_HEADER_KIND, name);
}

// The page that asks, if a page asks, must be the server's own.
static bool is_own_origin(struct MHD_Connection *c, const char *host) {
  const char *origin = header_of(c, "Origin"), *site = header_of(c, "Sec-Fetch-Site");
  if (origin && (strncmp(origin, "http://", 7) != 0 || strcasecmp(origin + 7, host) != 0))
    return false;
  return !site || !strcmp(site, "same-origin") || !strcmp(site, "none");
}

// The port that is listened on. The first request may come before start_daemons has noted it.
static int known_port(CagServer *s) {
  pthread_mutex_lock(&s->mutex);
  const int port = s->port;
  pthread_mutex_unlock(&s->mutex);
  return port;
}

// Why a request is refused, or NULL.
static const char *refusal(CagServer *s, struct MHD_Connection *c, const char *path) {
  const char *host = header_of(c, "Host");
  if (!host || !is_loopback(host)) return "this server answers only for localhost";
  const bool entry = !strcmp(path, "/");
  if (entry && same_token(s, cag_microhttpd.lookup_connection_value(c, MHD_GET_ARGUMENT_KIND, "t")))
    return NULL; // a link from anywhere may lead here
  if (!is_own_origin(c, host)) return "a page of another origin cannot use this server";
  char cookie[32];
  snprintf(cookie, sizeof cookie, COOKIE, known_port(s));
  if (!same_token(s, cag_microhttpd.lookup_connection_value(c, MHD_COOKIE_KIND, cookie)))
    return "open the address that cag view printed";
  return NULL;
}

// --- Answers ---

static void add_safety(struct MHD_Response *r) {
  // The editor of the page makes its styles by script, which needs no exception.
  static const char POLICY[] =
      "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; "
      "base-uri 'none'; form-action 'none'";
  cag_microhttpd.add_response_header(r, "Content-Security-Policy", POLICY);
  cag_microhttpd.add_response_header(r, "X-Content-Type-Options", "nosniff");
  cag_microhttpd.add_response_header(r, "Referrer-Policy", "no-referrer");
  cag_microhttpd.add_response_header(r, "Cross-Origin-Resource-Policy", "same-origin");
}

static void conclude(CagExchange *x, unsigned status, struct MHD_Response *r) {
  x->status = status;
  x->response = r;
  cag_microhttpd.resume_connection(x->connection);
}

void cag_exchange_answer(CagExchange *x, const CagAnswer *a) {
  struct MHD_Response *r = cag_microhttpd.create_response_from_buffer(
      a->size, (void *)(size_t)(a->size ? a->bytes : ""), MHD_RESPMEM_MUST_COPY);
  if (r) {
    add_safety(r);
    cag_microhttpd.add_response_header(r, "Content-Type", a->type ? a->type : "application/json");
    cag_microhttpd.add_response_header(
        r, "Cache-Control", a->lasting ? "private, max-age=31536000, immutable" : "no-store");
    if (a->gzipped) cag_microhttpd.add_response_header(r, "Content-Encoding", "gzip");
    if (a->etag) {
      char quoted[96];
      snprintf(quoted, sizeof quoted, "\"%s\"", a->etag);
      cag_microhttpd.add_response_header(r, "ETag", quoted);
    }
    if (a->file) {
      char text[160];
      snprintf(text, sizeof text, "attachment; filename=\"%.128s\"", a->file);
      cag_microhttpd.add_response_header(r, "Content-Disposition", text);
    }
  }
  conclude(x, (unsigned)a->status, r);
}

void cag_exchange_fail(CagExchange *x, int status, const char *message, const char *help) {
  CagString s = {0};
  CagJson j = {.to = &s};
  cag_json_open(&j, '{');
  cag_json_text(&j, "error", message);
  cag_json_text(&j, "help", help);
  cag_json_close(&j, '}');
  cag_exchange_answer(x, &(CagAnswer){.status = status, .bytes = s.bytes, .size = s.length});
  cag_string_free(&s);
}

// The first visit: the cookie, and the address without the token.
static void answer_entry(CagExchange *x) {
  char cookie[128];
  struct MHD_Response *r =
      cag_microhttpd.create_response_from_buffer(0, "", MHD_RESPMEM_PERSISTENT);
  snprintf(cookie, sizeof cookie, COOKIE "=%s; Path=/; HttpOnly; SameSite=Strict",
           known_port(x->server), x->server->token);
  if (r) {
    add_safety(r);
    cag_microhttpd.add_response_header(r, "Set-Cookie", cookie);
    cag_microhttpd.add_response_header(r, "Location", "/");
    cag_microhttpd.add_response_header(r, "Cache-Control", "no-store");
  }
  conclude(x, MHD_HTTP_SEE_OTHER, r);
}

const char *cag_exchange_method(const CagExchange *x) { return x->method; }
const char *cag_exchange_path(const CagExchange *x) { return x->path; }
const char *cag_exchange_query(const CagExchange *x, const char *name) {
  return cag_microhttpd.lookup_connection_value(x->connection, MHD_GET_ARGUMENT_KIND, name);
}
const char *cag_exchange_header(const CagExchange *x, const char *name) {
  return header_of(x->connection, name);
}
const char *cag_exchange_body(const CagExchange *x, size_t *size) {
  *size = x->size;
  return x->body ? x->body : "";
}

// --- Events ---

static void release_text(SharedText *t) {
  if (t && --t->references == 0) free(t);
}

static SharedText *event_text(const char *kind, const char *json) {
  const size_t n = strlen(kind) + strlen(json) + 32;
  SharedText *t = malloc(sizeof *t + n);
  if (!t) return NULL;
  t->references = 1;
  t->length = (size_t)snprintf(t->bytes, n, "event: %s\ndata: %s\n\n", kind, json);
  return t;
}

static void wake_listeners(CagServer *s) {
  for (Listener *l = s->listeners; l; l = l->next) {
    if (!l->waiting) continue;
    l->waiting = false;
    cag_microhttpd.resume_connection(l->connection);
  }
}

void cag_server_publish(CagServer *s, const char *kind, const char *json, bool kept) {
  SharedText *text = event_text(kind, json);
  if (!text) return;
  pthread_mutex_lock(&s->mutex);
  size_t i = 0;
  while (i < s->kind_count && strcmp(s->events[i].kind, kind) != 0) i++;
  if (i == s->kind_count && i < KINDS_MAX) {
    s->kind_count++;
    snprintf(s->events[i].kind, sizeof s->events[i].kind, "%s", kind);
  }
  if (i < KINDS_MAX) {
    release_text(s->events[i].text);
    s->events[i].text = text;
    s->events[i].number = ++s->last;
    // A new listener starts with what is kept.
    if (!kept && !s->listeners) {
      release_text(text);
      s->events[i].text = NULL;
    }
    wake_listeners(s);
  } else {
    release_text(text);
  }
  pthread_mutex_unlock(&s->mutex);
}

// The next event that the listener has not seen.
static bool begin_event(Listener *l) {
  const CagServer *s = l->server;
  const Event *next = NULL;
  for (size_t i = 0; i < s->kind_count; i++) {
    const Event *e = &s->events[i];
    if (e->text && e->number > l->seen && (!next || e->number < next->number)) next = e;
  }
  if (!next) return false;
  l->seen = next->number;
  l->text = next->text;
  l->text->references++;
  l->sent = 0;
  return true;
}

static ssize_t read_events(void *context, uint64_t at, char *buffer, size_t most) {
  (void)at;
  Listener *l = context;
  CagServer *s = l->server;
  ssize_t n = 0;
  pthread_mutex_lock(&s->mutex);
  if (s->stopping) {
    n = MHD_CONTENT_READER_END_OF_STREAM;
  } else if (l->text || begin_event(l)) {
    const size_t left = l->text->length - l->sent, part = left < most ? left : most;
    memcpy(buffer, l->text->bytes + l->sent, part);
    l->sent += part;
    n = (ssize_t)part;
    if (l->sent == l->text->length) {
      release_text(l->text);
      l->text = NULL;
    }
  } else {
    l->waiting = true;
    cag_microhttpd.suspend_connection(l->connection);
  }
  pthread_mutex_unlock(&s->mutex);
  return n;
}

static void end_listener(void *context) {
  Listener *l = context;
  CagServer *s = l->server;
  pthread_mutex_lock(&s->mutex);
  for (Listener **at = &s->listeners; *at; at = &(*at)->next)
    if (*at == l) {
      *at = l->next;
      s->listener_count--;
      break;
    }
  release_text(l->text);
  pthread_mutex_unlock(&s->mutex);
  free(l);
}

void cag_exchange_listen(CagExchange *x) {
  CagServer *s = x->server;
  Listener *l = calloc(1, sizeof *l);
  pthread_mutex_lock(&s->mutex);
  const bool room = l && s->listener_count < CAG_SERVER_LISTENERS && !s->stopping;
  if (room) {
    *l = (Listener){.server = s, .connection = x->connection, .next = s->listeners};
    s->listeners = l;
    s->listener_count++;
  }
  pthread_mutex_unlock(&s->mutex);
  if (!room) {
    free(l);
    cag_exchange_fail(x, MHD_HTTP_SERVICE_UNAVAILABLE, "too many pages are open", NULL);
    return;
  }
  struct MHD_Response *r = cag_microhttpd.create_response_from_callback(
      MHD_SIZE_UNKNOWN, 16384, read_events, l, end_listener);
  if (r) {
    add_safety(r);
    cag_microhttpd.add_response_header(r, "Content-Type", "text/event-stream");
    cag_microhttpd.add_response_header(r, "Cache-Control", "no-store");
  } else {
    end_listener(l);
  }
  conclude(x, MHD_HTTP_OK, r);
}

// --- Requests ---

static void free_exchange(CagExchange *x) {
  if (x->response) cag_microhttpd.destroy_response(x->response);
  free(x->method);
  free(x->path);
  free(x->body);
  free(x);
}

static void end_request(void *context, struct MHD_Connection *c, void **state,
                        enum MHD_RequestTerminationCode why) {
  (void)context, (void)c, (void)why;
  if (*state) free_exchange(*state);
  *state = NULL;
}

static CagExchange *begin_exchange(CagServer *s, struct MHD_Connection *c, const char *path,
                                   const char *method) {
  CagExchange *x = calloc(1, sizeof *x);
  if (!x) return NULL;
  *x = (CagExchange){.server = s, .connection = c, .method = strdup(method), .path = strdup(path)};
  const char *length = header_of(c, "Content-Length");
  x->too_large = length && strtoull(length, NULL, 10) > CAG_SERVER_BODY_MAX;
  if (x->method && x->path) return x;
  free_exchange(x);
  return NULL;
}

static bool add_to_body(CagExchange *x, const char *data, size_t n) {
  if (x->too_large || x->size + n > CAG_SERVER_BODY_MAX) {
    x->too_large = true; // the rest is read, and forgotten
    return true;
  }
  if (x->size + n + 1 > x->capacity) {
    const size_t capacity = 2 * (x->size + n) + 1024;
    char *larger = realloc(x->body, capacity);
    if (!larger) return false;
    x->body = larger;
    x->capacity = capacity;
  }
  memcpy(x->body + x->size, data, n);
  x->size += n;
  x->body[x->size] = 0;
  return true;
}

static void route(CagExchange *x) {
  CagServer *s = x->server;
  const char *why = refusal(s, x->connection, x->path);
  const bool entry = !strcmp(x->path, "/") && cag_exchange_query(x, "t");
  if (why) cag_exchange_fail(x, MHD_HTTP_FORBIDDEN, why, NULL);
  else if (x->too_large)
    cag_exchange_fail(x, MHD_HTTP_CONTENT_TOO_LARGE, "the request is too large", NULL);
  else if (entry) answer_entry(x);
  else s->options.route(s->options.context, x);
}

static enum MHD_Result handle(void *context, struct MHD_Connection *c, const char *path,
                              const char *method, const char *version, const char *data,
                              size_t *size, void **state) {
  (void)version;
  CagExchange *x = *state;
  if (!x) {
    x = *state = begin_exchange(context, c, path, method);
    return x ? MHD_YES : MHD_NO;
  }
  if (*size > 0) {
    const bool ok = add_to_body(x, data, *size);
    *size = 0;
    return ok ? MHD_YES : MHD_NO;
  }
  if (!x->routed) {
    x->routed = true;
    cag_microhttpd.suspend_connection(c); // until it is answered, which may be at once
    route(x);
    return MHD_YES;
  }
  return x->response ? cag_microhttpd.queue_response(c, x->status, x->response) : MHD_NO;
}

// --- The server ---

static void ignore_log(void *context, const char *format, va_list arguments) {
  (void)context, (void)format, (void)arguments;
}

static struct MHD_Daemon *start_daemon(CagServer *s, const struct sockaddr *address, bool v6) {
  const unsigned flags = MHD_USE_EPOLL_INTERNAL_THREAD | MHD_ALLOW_SUSPEND_RESUME |
                         MHD_USE_ERROR_LOG | (v6 ? MHD_USE_IPv6 : 0);
  return cag_microhttpd.start_daemon(
      flags, 0, NULL, NULL, handle, s, MHD_OPTION_EXTERNAL_LOGGER, ignore_log, NULL,
      MHD_OPTION_SOCK_ADDR, address, MHD_OPTION_NOTIFY_COMPLETED, end_request, NULL,
      MHD_OPTION_CONNECTION_LIMIT, (unsigned)CAG_SERVER_CONNECTIONS, MHD_OPTION_CONNECTION_TIMEOUT,
      (unsigned)IDLE_SECONDS, MHD_OPTION_END);
}

static bool start_daemons(CagServer *s) {
  struct sockaddr_in v4 = {.sin_family = AF_INET, .sin_port = htons((uint16_t)s->options.port)};
  v4.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  pthread_mutex_lock(&s->mutex);
  s->daemons[0] = start_daemon(s, (struct sockaddr *)&v4, false);
  if (s->daemons[0])
    s->port = cag_microhttpd.get_daemon_info(s->daemons[0], MHD_DAEMON_INFO_BIND_PORT)->port;
  pthread_mutex_unlock(&s->mutex);
  if (!s->daemons[0]) return false;
  struct sockaddr_in6 v6 = {.sin6_family = AF_INET6, .sin6_port = htons((uint16_t)s->port)};
  v6.sin6_addr = in6addr_loopback;
  s->daemons[1] = start_daemon(s, (struct sockaddr *)&v6, true); // NULL without IPv6
  return true;
}

CagServer *cag_server_start(const CagServerOptions *options, char *why, size_t size) {
  if (!cag_microhttpd_load(why, size)) return NULL;
  CagServer *s = calloc(1, sizeof *s);
  if (!s) {
    snprintf(why, size, "out of memory");
    return NULL;
  }
  s->options = *options;
  pthread_mutex_init(&s->mutex, NULL);
  errno = 0;
  if (cag_server_make_token(options->port, s->token) && start_daemons(s)) return s;
  if (options->port) snprintf(why, size, "cannot use port %d: %s", options->port, strerror(errno));
  else snprintf(why, size, "cannot listen on 127.0.0.1: %s", strerror(errno));
  pthread_mutex_destroy(&s->mutex);
  free(s);
  return NULL;
}

void cag_server_stop(CagServer *s) {
  pthread_mutex_lock(&s->mutex);
  s->stopping = true;
  wake_listeners(s);
  pthread_mutex_unlock(&s->mutex);
  for (int i = 0; i < 2; i++)
    if (s->daemons[i]) cag_microhttpd.stop_daemon(s->daemons[i]);
  for (size_t i = 0; i < s->kind_count; i++) release_text(s->events[i].text);
  pthread_mutex_destroy(&s->mutex);
  free(s);
}

int cag_server_port(const CagServer *s) { return s->port; }
const char *cag_server_token(const CagServer *s) { return s->token; }
