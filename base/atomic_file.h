// Atomic output files.
//
// A file is written under a unique temporary name in the folder of its destination, and renamed
// when it is complete. If the run is killed, the old file remains. Write errors are sticky: a
// writer does not have to check each call, because cag_atomic_file_commit returns the first error
// (to stop early, use cag_atomic_file_failed). Every opened file must be ended with exactly one
// commit or abort. After a request to stop (base/stop.h), the next write fails with status
// CAG_E_CALLBACK.
//
//     CagAtomicFile *f = cag_atomic_file_open(path, &err);
//     if (!f) return false;
//     cag_atomic_file_printf(f, "solid %s\n", name);
//     for (...) {                                    // the fast way, for numbers by the million
//       char *at = cag_atomic_file_reserve(f, 64);   // room for 64 bytes
//       at = format_number(at, x);
//       cag_atomic_file_advance(f, at);              // what was used of it
//     }
//     return cag_atomic_file_commit(f, &err);        // or cag_atomic_file_abort(f)
//
// The path `-` is standard output. Devices and pipes (/dev/null, /dev/full, a FIFO) are written
// directly and never replaced. For a symbolic link, the target file is replaced and the link
// remains. Folders, sockets, disks, dangling links, and write-protected files are refused. The
// permission bits of an existing file are kept; a new file gets those of the umask.

#ifndef CAG_BASE_ATOMIC_FILE_H
#define CAG_BASE_ATOMIC_FILE_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

// The most that one call of cag_atomic_file_reserve may request. The buffer is many times larger,
// to save system calls.
#define CAG_ATOMIC_FILE_RESERVE_MAX ((size_t)64 * 1024)

typedef struct CagAtomicFile {
  char *at;    // next free byte of the buffer
  char *limit; // end of the buffer; at <= limit
  struct CagAtomicFileState *state;
} CagAtomicFile;

// Opens the output `path`. Returns NULL, with an error of status CAG_E_FILE, if it cannot be
// written.
CagAtomicFile *cag_atomic_file_open(const char *path, CagError *err);

// Tests whether cag_atomic_file_open would succeed, and leaves nothing behind even if the process
// is killed meanwhile. Returns false, with `err`, if not. Pipes and devices are not opened, because
// their other end would notice; for these, only their existence is checked.
bool cag_atomic_file_try(const char *path, CagError *err);

// Opens an output in memory instead, for data that is passed on (a scene for the renderer) and for
// tests. All writing functions work on it. End it with cag_atomic_file_commit_memory or
// cag_atomic_file_abort.
CagAtomicFile *cag_atomic_file_open_memory(CagError *err);

// Announces that about `bytes` bytes will be written, so that the file system can allocate them at
// once. This is only a hint for speed and need not be accurate.
void cag_atomic_file_expect(CagAtomicFile *f, uint64_t bytes);

// Appends n bytes, of any size.
void cag_atomic_file_write(CagAtomicFile *f, const void *data, size_t n);

// Appends the zero-terminated text, without its zero.
void cag_atomic_file_text(CagAtomicFile *f, const char *text);

// Appends formatted text of any length.
void cag_atomic_file_printf(CagAtomicFile *f, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

// Flushes the buffer to the system and makes room for at least CAG_ATOMIC_FILE_RESERVE_MAX bytes,
// even after an error (the bytes are then discarded). Called by cag_atomic_file_reserve; rarely
// needed elsewhere.
void cag_atomic_file_flush(CagAtomicFile *f);

// Returns room for n bytes (at most CAG_ATOMIC_FILE_RESERVE_MAX), never NULL. After writing there,
// call cag_atomic_file_advance with the end of what was written.
static inline char *cag_atomic_file_reserve(CagAtomicFile *f, size_t n) {
  if ((size_t)(f->limit - f->at) < n) cag_atomic_file_flush(f);
  return f->at;
}

// Appends what was written into the reserved room, up to but not including `end`.
static inline void cag_atomic_file_advance(CagAtomicFile *f, char *end) { f->at = end; }

// Returns whether a write failed. A long export can then stop early; the error is returned by
// cag_atomic_file_commit.
bool cag_atomic_file_failed(const CagAtomicFile *f);

// Returns the number of bytes appended so far.
uint64_t cag_atomic_file_size(const CagAtomicFile *f);

// Writes the rest, closes the file, renames it, and releases `f`. On failure, sets `err` and
// removes the temporary file; an existing file at the path is unchanged.
bool cag_atomic_file_commit(CagAtomicFile *f, CagError *err);

// Ends an output in memory. The caller must free the bytes, which are followed by a zero byte.
bool cag_atomic_file_commit_memory(CagAtomicFile *f, char **bytes, size_t *size, CagError *err);

// Removes the temporary file and releases `f`, which may be NULL. Nothing at the path changes.
void cag_atomic_file_abort(CagAtomicFile *f);

// Removes the temporary files of all outputs that are open in this process. Async-signal-safe: call
// it in the handler of a signal that ends the process. Open outputs can still be aborted, but their
// commit fails.
void cag_atomic_files_cleanup(void);

#endif
