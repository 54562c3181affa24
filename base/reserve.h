// Address space that takes memory only where it is used.

#ifndef CAG_BASE_RESERVE_H
#define CAG_BASE_RESERVE_H

#include <stddef.h>

// Returns zeroed memory, or NULL. It is not charged to the account.
void *cag_reserve(size_t bytes);
// `start` may be NULL. `bytes` is the size that was reserved.
void cag_unreserve(void *start, size_t bytes);
// A generous size for a block whose use is unknown. It is small if reserved memory is also used.
extern const size_t cag_reserve_ample;

#endif
