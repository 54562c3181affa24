// Loops whose iterations run on several threads.
//
// The result of such a loop must not depend on the number of threads: each iteration writes to data
// of its own. Iterations may not allocate memory that outlives them, run scripts, or retain and
// release shared data, since accounts and reference counts belong to the calling thread.

#ifndef CAG_BASE_PARALLEL_H
#define CAG_BASE_PARALLEL_H

#include <stddef.h>

// The largest number of threads of a loop.
#define CAG_THREADS_MAX 64

// The number of threads that a loop may use: the processors of the machine, unless it was set.
int cag_thread_count(void);
// Sets the number of threads, at most CAG_THREADS_MAX; 0: the number of processors.
void cag_set_thread_count(int n);

// Calls work(context, i, thread) for each i < n, with 0 <= thread < cag_thread_count(). Iterations
// start in ascending order. The calling thread takes part, and its stop flag applies to all. Where
// threads cannot be started, fewer are used.
void cag_parallel(size_t n, void (*work)(void *context, size_t i, int thread), void *context);

#endif
