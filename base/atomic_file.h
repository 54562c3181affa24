// Output files that appear whole or not at all.
//
// A file is written beside its place, in the same folder, under a temporary name that nobody else
// uses, and renamed when it is whole: a killed run leaves the old file or the new one. Errors of
// writing are sticky: a writer need not look at each call, it learns of the first error from
// cag_atomic_file_commit (or, to stop early, from cag_atomic_file_failed). Every opened file ends
// with exactly one commit or abort. Work that is asked to end (base/stop.h) meets an error of
// status CAG_E_CALLBACK at its next write.
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
// `-` is standard output. A device or pipe (/dev/null, /dev/full, a FIFO) is written directly,
// never renamed over. A symbolic link to a file keeps being one: the file that it points to is
// replaced. Folders, sockets, disks, dangling links and write-protected files are refused. An
// existing file's permission bits are kept; a new file gets those of the umask.

#ifndef CAG_BASE_ATOMIC_FILE_H
#define CAG_BASE_ATOMIC_FILE_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

// The most that one cag_atomic_file_reserve may ask for. The buffer is many times larger, so that
// the system is called seldom.
#define CAG_ATOMIC_FILE_RESERVE_MAX ((size_t)64 * 1024)

typedef struct CagAtomicFile {
  char *at;    // next free byte of the buffer
  char *limit; // end of the buffer; at <= limit
  struct CagAtomicFileState *state;
} CagAtomicFile;

// Opens the output `path`. NULL and an error of exit status CAG_E_FILE when it cannot be written
// there.
CagAtomicFile *cag_atomic_file_open(const char *path, CagError *err);

// Whether cag_atomic_file_open would open the output, without leaving anything when it is killed
// meanwhile; false, with `err`, when not. Of pipes and devices, which would notice, only that they
// are there.
bool cag_atomic_file_try(const char *path, CagError *err);

// Opens a target in memory instead, for what is handed on (a scene for the renderer) and for tests:
// the same writers serve both. End it with cag_atomic_file_commit_memory or cag_atomic_file_abort.
CagAtomicFile *cag_atomic_file_open_memory(CagError *err);

// Tells that about `bytes` bytes will come: a file system then finds room for them in one piece,
// which is quicker. Telling more or less, or nothing, changes nothing else.
void cag_atomic_file_expect(CagAtomicFile *f, uint64_t bytes);

// Appends n bytes, of any size.
void cag_atomic_file_write(CagAtomicFile *f, const void *data, size_t n);

// Appends the zero-ended text, without its zero.
void cag_atomic_file_text(CagAtomicFile *f, const char *text);

// Appends formatted text of any length.
void cag_atomic_file_printf(CagAtomicFile *f, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

// Empties the buffer to the system; makes room for at least CAG_ATOMIC_FILE_RESERVE_MAX bytes, also
// after an error (the bytes go nowhere then). Called by reserve; seldom of use elsewhere.
void cag_atomic_file_flush(CagAtomicFile *f);

// Room for n bytes (at most CAG_ATOMIC_FILE_RESERVE_MAX), never NULL. Write from there on, then
// tell how far with advance.
static inline char *cag_atomic_file_reserve(CagAtomicFile *f, size_t n) {
  if ((size_t)(f->limit - f->at) < n) cag_atomic_file_flush(f);
  return f->at;
}

// Takes what was written into the reserved room, up to but not including `end`.
static inline void cag_atomic_file_advance(CagAtomicFile *f, char *end) { f->at = end; }

// True after a write failed: a long export can stop, abort or commit will tell.
bool cag_atomic_file_failed(const CagAtomicFile *f);

// Bytes appended so far.
uint64_t cag_atomic_file_size(const CagAtomicFile *f);

// Writes the rest, closes, renames into place, and releases `f`. On failure the temporary is
// removed, what was at the place before is untouched, and `err` says why.
bool cag_atomic_file_commit(CagAtomicFile *f, CagError *err);

// Ends a target in memory: what was written, with a zero byte behind it, is the caller's to free.
bool cag_atomic_file_commit_memory(CagAtomicFile *f, char **bytes, size_t *size, CagError *err);

// Removes the temporary and releases `f`, which may be NULL. Nothing at the place itself changes.
void cag_atomic_file_abort(CagAtomicFile *f);

// Removes the temporaries of all files that are open in this process. Async-signal-safe: call it in
// the handler of a signal that ends the process. Files that are open stay valid to abort, but their
// commit fails.
void cag_atomic_files_cleanup(void);

#endif
