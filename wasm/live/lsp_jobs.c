// Replaces live/lsp_jobs.c where there are no threads and processes: scripts are run by the page.

#include "live/lsp_parts.h"

void lsp_run_saved(CagLsp *l, LspDocument *d) {
  (void)l;
  (void)d;
}

void lsp_stop_run(CagLsp *l, const char *file) {
  (void)l;
  (void)file;
}

void lsp_execute(CagLsp *l, const cJSON *id, const cJSON *params) {
  (void)params;
  lsp_fail(l, id, LSP_INVALID_PARAMS, "unknown command");
}

bool lsp_jobs_done(CagLsp *l) {
  (void)l;
  return false;
}

void lsp_finish_jobs(CagLsp *l) { (void)l; }

void lsp_end_jobs(CagLsp *l) { (void)l; }
