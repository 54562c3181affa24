#include "base/large_stack.h"

#include <pthread.h>

// Reserved address space. Deep recursion through built-ins needs about 1 KiB per call (more with
// sanitizers).
#define STACK_BYTES ((size_t)512 << 20)
#define STACK_BYTES_MIN ((size_t)1 << 20)
// For the guard page, and for what the system stores at the end of the stack.
#define STACK_MARGIN 65536

typedef struct Work {
  void (*work)(void *context, char *low);
  void *context;
  size_t stack;
} Work;

static void *perform(void *context) {
  const Work *w = context;
  char here;
  w->work(w->context, &here - w->stack + STACK_MARGIN);
  return NULL;
}

bool cag_large_stack_run(void (*work)(void *context, char *low), void *context) {
  Work w = {work, context, STACK_BYTES};
  pthread_t thread;
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  bool started = false;
  for (; w.stack >= STACK_BYTES_MIN; w.stack /= 2) { // less if the system does not provide as much
    started = pthread_attr_setstacksize(&attributes, w.stack) == 0 &&
              pthread_create(&thread, &attributes, perform, &w) == 0;
    if (started) break;
  }
  pthread_attr_destroy(&attributes);
  if (started) pthread_join(thread, NULL);
  return started;
}

bool cag_large_stack_has_room(const char *here, const char *low, size_t reserve) {
  return here - low > (ptrdiff_t)reserve;
}
