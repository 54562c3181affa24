// Answers that are kept (see answers.h). There are few of them, so they are searched one by one.

#include "interp/kernel/answers.h"

#include <stdlib.h>
#include <string.h>

void cag_answers_free(CagAnswers *a) {
  for (size_t i = 0; i < a->count; i++) free(a->items[i].bytes);
  free(a->items);
  *a = (CagAnswers){0};
}

// Drops answers, the oldest first, until `length` more bytes fit.
static void make_room(CagAnswers *a, size_t length) {
  size_t gone = 0;
  for (; gone < a->count && a->total > CAG_ANSWERS_MOST - length; gone++) {
    a->total -= a->items[gone].length;
    free(a->items[gone].bytes);
  }
  if (gone == 0) return;
  a->count -= gone;
  memmove(a->items, a->items + gone, a->count * sizeof *a->items);
}

void cag_answers_keep(CagAnswers *a, const CagDigest *question, const void *bytes, size_t length) {
  if (question->unknown || length > CAG_ANSWERS_MOST) return;
  make_room(a, length);
  if (a->count == a->room) {
    const size_t room = 2 * a->room + 8;
    CagKeptAnswer *more = realloc(a->items, room * sizeof *more);
    if (!more) return;
    a->items = more;
    a->room = room;
  }
  unsigned char *copy = malloc(length + 1);
  if (!copy) return;
  memcpy(copy, bytes, length);
  a->items[a->count++] = (CagKeptAnswer){*question, copy, length};
  a->total += length;
}

const CagKeptAnswer *cag_answers_find(CagAnswers *a, const CagDigest *question) {
  for (size_t i = a->count; i-- > 0;) {
    if (!cag_digest_equal(&a->items[i].question, question)) continue;
    const CagKeptAnswer found = a->items[i];
    memmove(a->items + i, a->items + i + 1, (a->count - i - 1) * sizeof *a->items);
    a->items[a->count - 1] = found;
    return &a->items[a->count - 1];
  }
  return NULL;
}
