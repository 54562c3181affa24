// Allocation with accounting.
//
// The owner of some work assigns an account to the thread that does the work. Every block that the
// thread allocates through these functions is charged to the account, and every block that it frees
// is credited. An allocation that would exceed the account's limit returns NULL, as does one that
// the system refuses, so callers need no special code for the limit.
//
// Blocks come from malloc: they have no header, can be passed to free() by code without an account,
// and are measured by their usable size. Allocations of libraries are not seen. Callers that pass
// input of unlimited size to a library charge an estimate while it works (cag_account_hold).
//
// Memory that is charged to an account must be freed while the same account is assigned.

#ifndef CAG_BASE_MEMORY_H
#define CAG_BASE_MEMORY_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct CagAccount {
  size_t used; // bytes charged, at most the limit
  size_t limit;
} CagAccount;

extern _Thread_local CagAccount *cag_account; // NULL: nothing is charged

// Assigns an account to the thread (NULL: none). Returns the previous one.
CagAccount *cag_account_lend(CagAccount *account);
// Returns whether `bytes` more bytes can be charged. True without an account.
bool cag_account_has_room(size_t bytes);
// Returns the number of bytes that can still be charged, at most SIZE_MAX / 2.
size_t cag_account_room(void);
// Charges bytes that other code allocates. Returns false, and charges nothing, if they would exceed
// the limit.
bool cag_account_hold(size_t bytes);
// Credits what cag_account_hold charged.
void cag_account_drop(size_t bytes);

// Like the functions of the standard library with these names. As with the system's functions, an
// allocation of 0 bytes may return NULL.
void *cag_malloc(size_t size);
void *cag_calloc(size_t count, size_t size);
void *cag_realloc(void *block, size_t size);
void cag_free(void *block);
char *cag_strdup(const char *text);
char *cag_strndup(const char *text, size_t length);
int cag_asprintf(char **out, const char *format, ...) __attribute__((format(printf, 2, 3)));
int cag_vasprintf(char **out, const char *format, va_list args)
    __attribute__((format(printf, 2, 0)));
char *cag_realpath(const char *path);

// Advises the system that a new block will be read here and there, so that it uses large pages if it
// has them. Finding the address of a small page takes longer than reading it.
void cag_memory_scattered(void *block, size_t size);

// Charges a block that the system has allocated, such as the text of open_memstream. The block may
// exceed the limit; later allocations then fail.
void cag_adopt(void *block);
// Credits a block that is passed to a caller who frees it with free().
void cag_disown(void *block);

#endif
