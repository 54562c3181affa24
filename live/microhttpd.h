// libmicrohttpd, which is loaded when a server starts: it brings other libraries with it, which would
// make every start of the program slower.

#ifndef CAG_LIVE_MICROHTTPD_H
#define CAG_LIVE_MICROHTTPD_H

#include <microhttpd.h>
#include <stdbool.h>
#include <stddef.h>

#define CAG_MICROHTTPD_FUNCTIONS(X)                                                                \
  X(start_daemon)                                                                                  \
  X(stop_daemon)                                                                                   \
  X(get_daemon_info)                                                                               \
  X(create_response_from_buffer)                                                                   \
  X(create_response_from_callback)                                                                 \
  X(add_response_header)                                                                           \
  X(destroy_response)                                                                              \
  X(queue_response)                                                                                \
  X(lookup_connection_value)                                                                       \
  X(suspend_connection)                                                                            \
  X(resume_connection)

typedef struct CagMicrohttpd {
#define X(name) __typeof__(MHD_##name) *name;
  CAG_MICROHTTPD_FUNCTIONS(X)
#undef X
} CagMicrohttpd;

extern CagMicrohttpd cag_microhttpd;

// Returns false, with the reason in `why`, if the library is missing or lacks a function.
bool cag_microhttpd_load(char *why, size_t size);

#endif
