// The journal of a batch: a record of finished tasks, with which a killed batch can be resumed.
//
// A journal is a text of lines, each a JSON object, to which lines are only appended. Incomplete
// lines are ignored, and complete lines are on the disk after cag_journal_sync returns. If the
// batch is killed, only the last line can be incomplete; the next entry then starts on a new line.
// Later lines about a key override earlier ones.
//
// While a journal is open, it is locked, so a second batch with the same jobs is refused.

#ifndef CAG_CLI_JOURNAL_H
#define CAG_CLI_JOURNAL_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

// 128 bits as hexadecimal digits, and a terminating zero.
#define CAG_JOURNAL_KEY_SIZE 33

typedef enum CagJournalWhat {
  CAG_JOURNAL_DONE,
  CAG_JOURNAL_FAILED,
  CAG_JOURNAL_SUBMITTED, // to a queue; the key is the queue's job id
  CAG_JOURNAL_COLLECTED  // the queue's job has ended, and its results are in the journal
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
  const char *path;         // belongs to the caller
  CagJournalEntry *entries; // latest entry of each key, by key
  size_t count;
  bool unsynced;                  // lines were written that may not be on the disk yet
  char job[CAG_JOURNAL_KEY_SIZE]; // the queue's job that was submitted but not collected; empty:
                                  // none
} CagJournal;

// Opens and reads the journal, which is created if it does not exist. With `fresh`, earlier
// contents are discarded. Fails, with the reason in `err`, if the file cannot be read or written,
// is not a journal, or is locked by another batch.
bool cag_journal_open(CagJournal *j, const char *path, bool fresh, CagError *err);
void cag_journal_close(CagJournal *j);

// Returns the latest entry of the key when the journal was opened, or NULL.
const CagJournalEntry *cag_journal_find(const CagJournal *j, const char *key);

// Appends a line. It survives if the process is killed, but after a power failure only if
// cag_journal_sync was called.
bool cag_journal_write(CagJournal *j, const CagJournalEntry *entry, CagError *err);
// Waits until all lines are on the disk.
bool cag_journal_sync(CagJournal *j, CagError *err);
// Appends a line and waits until it is on the disk.
bool cag_journal_add(CagJournal *j, const CagJournalEntry *entry, CagError *err);

#endif
