// An HTTP server on the loopback interface, for one user, on libmicrohttpd.
//
// It answers only those who know its token: the address with `?t=TOKEN` sets a cookie, which all
// other requests need. Requests for another host (DNS rebinding) or from a page of another origin
// are refused, and so are bodies beyond CAG_SERVER_BODY_MAX. A request is an exchange, which can be
// answered at once or later, from any thread.

#ifndef CAG_LIVE_SERVER_H
#define CAG_LIVE_SERVER_H

#include <stdbool.h>
#include <stddef.h>

#define CAG_SERVER_BODY_MAX ((size_t)32 << 20)
enum { CAG_SERVER_CONNECTIONS = 64, CAG_SERVER_LISTENERS = 16 };

typedef struct CagServer CagServer;
typedef struct CagExchange CagExchange;

typedef struct CagServerOptions {
  int port;                                     // 0: any free one
  void (*route)(void *context, CagExchange *x); // answers x, or keeps it to answer it later
  void *context;
} CagServerOptions;

// Starts the server on 127.0.0.1 and, where there is IPv6, ::1. Returns NULL with the reason in
// `why` if the port is in use or the system lacks something.
CagServer *cag_server_start(const CagServerOptions *options, char *why, size_t size);
// All exchanges must have been answered.
void cag_server_stop(CagServer *s);
int cag_server_port(const CagServer *s);
const char *cag_server_token(const CagServer *s); // see server_token.h

// --- Exchanges ---

const char *cag_exchange_method(const CagExchange *x);
const char *cag_exchange_path(const CagExchange *x);
const char *cag_exchange_query(const CagExchange *x, const char *name);  // NULL: not given
const char *cag_exchange_header(const CagExchange *x, const char *name); // NULL: not given
const char *cag_exchange_body(const CagExchange *x, size_t *size);       // ends with a NUL

typedef struct CagAnswer {
  int status;
  const char *type;  // NULL: application/json
  const void *bytes; // are copied
  size_t size;
  const char *etag; // NULL: none
  const char *file; // the name under which a browser saves it; NULL: it is shown
  bool gzipped;     // the bytes are compressed
  bool lasting;     // the answer never changes
} CagAnswer;
void cag_exchange_answer(CagExchange *x, const CagAnswer *a);
// {"error": message, "help": help}; help may be NULL.
void cag_exchange_fail(CagExchange *x, int status, const char *message, const char *help);
// Answers by a stream of events that lasts until the server stops or the client leaves.
void cag_exchange_listen(CagExchange *x);

// --- Events ---

// Sends an event, one line of JSON, to all listeners. There are few kinds, and for each only the last
// event counts: a slow listener may miss earlier ones, and a new one gets the last of each kind that
// is kept.
void cag_server_publish(CagServer *s, const char *kind, const char *json, bool kept);

#endif
