// Replaces base/parallel.c where there are no threads: the caller runs all iterations.

#include "base/parallel.h"

int cag_thread_count(void) { return 1; }

void cag_set_thread_count(int n) { (void)n; }

void cag_parallel(size_t n, void (*work)(void *context, size_t i, int thread), void *context) {
  for (size_t i = 0; i < n; i++) work(context, i, 0);
}

bool cag_parallel_checked(size_t n, bool (*work)(void *context, size_t i, int thread),
                          void *context) {
  for (size_t i = 0; i < n; i++)
    if (!work(context, i, 0)) return false;
  return true;
}

bool cag_on_worker(void) { return false; }

CagStatus cag_worker_fail(CagError *err) {
  return cag_fail(err, CAG_E_CALLBACK, CAG_ERR_internal, "", -1,
                  "a formula of the script was evaluated by another thread than the script's");
}
