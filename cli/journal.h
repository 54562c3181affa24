// The journal of a batch: what was done, kept so that a run that was killed goes on where it ended.
//
// A journal is a text of lines, each a JSON object, to which lines are only ever added; a line
// counts when it is whole, and is on the disk when cag_journal_sync returns. A kill can tear the
// last line only: it is passed over, and the next line begins on a line of its own. Later lines
// about a key stand for the earlier ones.
//
// While a journal is open it is locked: a second batch of the same jobs is refused.

#ifndef CAG_CLI_JOURNAL_H
#define CAG_CLI_JOURNAL_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

// 128 bits as hexadecimal digits, and a zero.
#define CAG_JOURNAL_KEY_SIZE 33

typedef enum CagJournalWhat {
  CAG_JOURNAL_DONE,
  CAG_JOURNAL_FAILED,
  CAG_JOURNAL_SUBMITTED, // to a queue; the key is the number of the queue's job
  CAG_JOURNAL_COLLECTED  // the queue's job has ended and its results are in the journal
} CagJournalWhat;

typedef struct CagJournalEntry {
  CagJournalWhat what;
  char key[CAG_JOURNAL_KEY_SIZE];
  double seconds;
  size_t memory; // bytes
  int attempts;
} CagJournalEntry;

typedef struct CagJournal {
  int fd;
  const char *path;         // the caller's
  CagJournalEntry *entries; // of keys that are known, by key
  size_t count;
  bool unsynced;                  // lines were written that the disk may not have
  char job[CAG_JOURNAL_KEY_SIZE]; // the queue's job that was submitted and not collected; empty:
                                  // none
} CagJournal;

// Opens and reads the journal, and makes it where there is none; a `fresh` one forgets what it
// held. Fails with the reason in `err`: a file that cannot be read or written, one that is no
// journal, a batch that holds it.
bool cag_journal_open(CagJournal *j, const char *path, bool fresh, CagError *err);
void cag_journal_close(CagJournal *j);

// The newest of the key that was there when the journal was opened, or NULL.
const CagJournalEntry *cag_journal_find(const CagJournal *j, const char *key);

// Adds a line, which a kill leaves there; when power fails, the disk may not have it before the
// next cag_journal_sync.
bool cag_journal_write(CagJournal *j, const CagJournalEntry *entry, CagError *err);
// Waits until the disk has all lines.
bool cag_journal_sync(CagJournal *j, CagError *err);
// Both.
bool cag_journal_add(CagJournal *j, const CagJournalEntry *entry, CagError *err);

#endif
