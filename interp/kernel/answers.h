// Answers of the kernel, kept by what was asked, so that a question that was asked before is not asked
// again.

#ifndef CAG_INTERP_KERNEL_ANSWERS_H
#define CAG_INTERP_KERNEL_ANSWERS_H

#include <stddef.h>

#include "base/digest.h"

// The most bytes that are kept. When they are exceeded, the answers go that were not used for the
// longest time.
#define CAG_ANSWERS_MOST ((size_t)64 << 20)

typedef struct CagKeptAnswer {
  CagDigest question;
  unsigned char *bytes;
  size_t length;
} CagKeptAnswer;

// Zeroed, it is empty. Its memory belongs to no account, because it lives longer than a run.
typedef struct CagAnswers {
  CagKeptAnswer *items; // the last one was used last
  size_t count, room, total;
} CagAnswers;

void cag_answers_free(CagAnswers *a);
// Keeps a copy of an answer, unless memory runs out or the answer is too long.
void cag_answers_keep(CagAnswers *a, const CagDigest *question, const void *bytes, size_t length);
// Returns the answer to an equal question, which is valid until the next call, or NULL.
const CagKeptAnswer *cag_answers_find(CagAnswers *a, const CagDigest *question);

#endif
