#include "live/lsp_pages.h"

#include <cJSON.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/string.h"
#include "live/lsp.h"

enum { NAME_SIZE = 64, WAITING_MAX = 64 };

typedef struct Page {
  char name[NAME_SIZE]; // "": the place is free
  CagLsp *lsp;
  pthread_mutex_t lock;
  CagString outbox; // behind the lock; messages, separated by commas
  unsigned long asked;
} Page;

typedef struct Question {
  CagExchange *x;
  cJSON *body;
  const char *page; // its name, in the body
} Question;

struct CagLspPages {
  CagSessionOptions session;
  const char *folder;
  pthread_t thread;
  pthread_mutex_t lock; // of what follows
  pthread_cond_t woken;
  Question waiting[WAITING_MAX];
  size_t count;
  bool stopping;
  CagLsp *checking; // the server that checks documents at the moment, or NULL
  char checking_page[NAME_SIZE];
  // Of the thread alone.
  Page pages[CAG_LSP_PAGES];
  unsigned long asked;
};

// --- Pages ---

static void put_message(void *context, const char *json, size_t length) {
  Page *page = context;
  pthread_mutex_lock(&page->lock);
  if (page->outbox.length > 0) cag_string_add(&page->outbox, ",", 1);
  cag_string_add(&page->outbox, json, length);
  pthread_mutex_unlock(&page->lock);
}

// What a finished run has to say waits for the next question.
static void wake(void *context) { (void)context; }

static void close_page(Page *page) {
  cag_lsp_free(page->lsp);
  cag_string_free(&page->outbox);
  page->lsp = NULL;
  page->name[0] = 0;
}

// The page of this name. A new one takes a free place, or that of the page that has been silent
// longest. Returns NULL if memory ran out.
static Page *find_page(CagLspPages *p, const char *name) {
  Page *oldest = &p->pages[0], *found = NULL;
  for (Page *page = p->pages; page < p->pages + CAG_LSP_PAGES; page++) {
    if (!strcmp(page->name, name)) found = page;
    if (page->asked < oldest->asked) oldest = page;
  }
  if (!found) {
    close_page(oldest);
    const CagLspOptions options = {.session = p->session,
                                   .folder = p->folder,
                                   .send = put_message,
                                   .wake = wake,
                                   .context = oldest};
    oldest->lsp = cag_lsp_new(&options);
    if (!oldest->lsp) return NULL;
    snprintf(oldest->name, sizeof oldest->name, "%s", name);
    found = oldest;
  }
  found->asked = ++p->asked;
  return found;
}

// --- Questions ---

static bool is_asking(const CagLspPages *p, const char *page) {
  for (size_t i = 0; i < p->count; i++)
    if (!strcmp(p->waiting[i].page, page)) return true;
  return false;
}

// Marks the server as one that checks, unless its page has asked again. Returns whether it shall.
static bool begin_check(CagLspPages *p, const Page *page) {
  pthread_mutex_lock(&p->lock);
  const bool checks = !p->stopping && !is_asking(p, page->name);
  if (checks) {
    p->checking = page->lsp;
    memcpy(p->checking_page, page->name, sizeof p->checking_page);
  }
  pthread_mutex_unlock(&p->lock);
  return checks;
}

static void end_check(CagLspPages *p) {
  pthread_mutex_lock(&p->lock);
  p->checking = NULL;
  pthread_mutex_unlock(&p->lock);
}

static void check_documents(CagLspPages *p, Page *page) {
  while (cag_lsp_has_work(page->lsp) && begin_check(p, page)) {
    cag_lsp_work(page->lsp);
    end_check(p);
  }
}

static void send_outbox(Page *page, CagExchange *x) {
  CagString all = {0};
  cag_string_add(&all, "[", 1);
  pthread_mutex_lock(&page->lock);
  if (page->outbox.failed) all.failed = true;
  else cag_string_add(&all, page->outbox.bytes, page->outbox.length);
  cag_string_free(&page->outbox);
  pthread_mutex_unlock(&page->lock);
  cag_string_add(&all, "]", 1);
  if (all.failed) cag_exchange_fail(x, 500, "out of memory", NULL);
  else cag_exchange_answer(x, &(CagAnswer){.status = 200, .bytes = all.bytes, .size = all.length});
  cag_string_free(&all);
}

static void answer_question(CagLspPages *p, const Question *q) {
  Page *page = find_page(p, q->page);
  if (!page) {
    cag_exchange_fail(q->x, 500, "out of memory", NULL);
    return;
  }
  const cJSON *message;
  cJSON_ArrayForEach(message, cJSON_GetObjectItemCaseSensitive(q->body, "messages")) {
    char *text = cJSON_PrintUnformatted(message);
    if (text) cag_lsp_receive(page->lsp, text, strlen(text));
    free(text);
  }
  if (cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(q->body, "check"))) check_documents(p, page);
  send_outbox(page, q->x);
}

static void *answer_all(void *context) {
  CagLspPages *p = context;
  pthread_mutex_lock(&p->lock);
  while (!p->stopping || p->count > 0) {
    if (p->count == 0) {
      pthread_cond_wait(&p->woken, &p->lock);
      continue;
    }
    const Question q = p->waiting[0];
    memmove(p->waiting, p->waiting + 1, --p->count * sizeof *p->waiting);
    const bool stopping = p->stopping;
    pthread_mutex_unlock(&p->lock);
    if (stopping) cag_exchange_fail(q.x, 503, "the server is ending", NULL);
    else answer_question(p, &q);
    cJSON_Delete(q.body);
    pthread_mutex_lock(&p->lock);
  }
  pthread_mutex_unlock(&p->lock);
  return NULL;
}

void cag_lsp_pages_ask(CagLspPages *p, CagExchange *x) {
  size_t size;
  const char *body = cag_exchange_body(x, &size);
  Question q = {x, cJSON_ParseWithLength(body, size), NULL};
  const cJSON *page = cJSON_GetObjectItemCaseSensitive(q.body, "page");
  if (!cJSON_IsString(page) || !*page->valuestring || strlen(page->valuestring) >= NAME_SIZE ||
      !cJSON_IsArray(cJSON_GetObjectItemCaseSensitive(q.body, "messages"))) {
    cag_exchange_fail(x, 400, "expected {\"page\": \"...\", \"messages\": [...]}",
                      "the name of the page has 1 to 63 bytes");
    cJSON_Delete(q.body);
    return;
  }
  q.page = page->valuestring;
  pthread_mutex_lock(&p->lock);
  const bool room = p->count < WAITING_MAX;
  if (room) p->waiting[p->count++] = q;
  // What it checks may have changed.
  if (p->checking && !strcmp(p->checking_page, q.page)) cag_lsp_interrupt(p->checking);
  pthread_cond_signal(&p->woken);
  pthread_mutex_unlock(&p->lock);
  if (room) return;
  cag_exchange_fail(x, 503, "too many requests wait", NULL);
  cJSON_Delete(q.body);
}

// --- The whole ---

CagLspPages *cag_lsp_pages_new(const CagSessionOptions *session, const char *folder) {
  CagLspPages *p = calloc(1, sizeof *p);
  if (!p) return NULL;
  p->session = *session;
  p->folder = folder;
  pthread_mutex_init(&p->lock, NULL);
  pthread_cond_init(&p->woken, NULL);
  for (size_t i = 0; i < CAG_LSP_PAGES; i++) pthread_mutex_init(&p->pages[i].lock, NULL);
  if (pthread_create(&p->thread, NULL, answer_all, p) == 0) return p;
  free(p);
  return NULL;
}

void cag_lsp_pages_free(CagLspPages *p) {
  if (!p) return;
  pthread_mutex_lock(&p->lock);
  p->stopping = true;
  if (p->checking) cag_lsp_interrupt(p->checking);
  pthread_cond_signal(&p->woken);
  pthread_mutex_unlock(&p->lock);
  pthread_join(p->thread, NULL);
  for (size_t i = 0; i < CAG_LSP_PAGES; i++) {
    close_page(&p->pages[i]);
    pthread_mutex_destroy(&p->pages[i].lock);
  }
  pthread_cond_destroy(&p->woken);
  pthread_mutex_destroy(&p->lock);
  free(p);
}
