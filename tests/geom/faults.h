// Fault injection. Each operation runs repeatedly, with a different fault each time: an allocation
// fails, a function supplied by the caller fails, or an allocation sets the flag that stops the
// operation. The operation must report the fault or do without the allocation (such as that of a
// cache) and return the same result. Instead of an error, it may only record exhausted memory
// (cag_memory_was_out). A stopped operation may end in any way. Every operation must release all
// memory that it allocated, and write to no other.
//
// The Makefile links the tests that include this header (memory_*_test) with --wrap, so that
// malloc, calloc, realloc, and free of the geometry core call the functions below.

#ifndef CAG_TESTS_GEOM_FAULTS_H
#define CAG_TESTS_GEOM_FAULTS_H

#include "base/stop.h"
#include "support.h"

void *__real_malloc(size_t size);
void *__real_realloc(void *p, size_t size);
void __real_free(void *p);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t n, size_t size);
void *__wrap_realloc(void *p, size_t size);
void __wrap_free(void *p);

typedef enum Fault { FAULT_NONE, FAULT_MEMORY, FAULT_CALLBACK, FAULT_STOP } Fault;

static struct {
  Fault kind;
  size_t chances, at; // allocations or calls so far; index of the one with the fault
  long blocks;        // allocated and not yet freed
  double result;      // for comparing two runs
  volatile int stop;
} fault;

// Operations call this to combine a number with their result.
static inline void fault_found(double x) { fault.result = 1.25 * fault.result + x; }

// Whether this allocation or call has the fault. A function that has failed keeps failing.
static bool fault_falls(Fault kind) {
  if (fault.kind != kind) return false;
  const size_t chance = ++fault.chances;
  return chance == fault.at || (kind == FAULT_CALLBACK && fault.at && chance > fault.at);
}

static bool fault_in_allocation(void) {
  if (fault_falls(FAULT_STOP)) fault.stop = 1;
  return fault_falls(FAULT_MEMORY);
}

// Each block is between two guards, which detect writes outside of it.
#define GUARD 32
#define GUARD_BYTE 0x7f

static int fault_problems;

// Fills the guards of p, which consists of GUARD bytes, the block, and GUARD bytes. Returns the
// block.
static void *guarded(void *p, size_t size) {
  if (!p) return NULL;
  char *block = (char *)p + GUARD;
  memset(p, GUARD_BYTE, GUARD);
  memcpy(p, &size, sizeof size);
  memset(block + size, GUARD_BYTE, GUARD);
  return block;
}

// Returns the start of the block's allocation, and its size. Counts blocks with damaged guards.
static void *unguarded(void *block, size_t *size) {
  char *p = (char *)block - GUARD;
  bool whole = true;
  memcpy(size, p, sizeof *size);
  for (size_t i = sizeof *size; i < GUARD; i++) whole = whole && p[i] == GUARD_BYTE;
  for (size_t i = 0; whole && i < GUARD; i++)
    whole = ((const char *)block)[*size + i] == GUARD_BYTE;
  if (!whole) {
    print_error("a block of %zu bytes was written to outside\n", *size);
    fault_problems++;
  }
  return p;
}

void *__wrap_malloc(size_t size) {
  if (fault_in_allocation()) return NULL;
  void *p = guarded(__real_malloc(size + (size_t)2 * GUARD), size);
  if (p) memset(p, 0xa5, size); // makes reads of uninitialized memory visible
  fault.blocks += p != NULL;
  return p;
}
void *__wrap_calloc(size_t n, size_t size) {
  if (fault_in_allocation()) return NULL;
  void *p = guarded(__real_malloc(n * size + (size_t)2 * GUARD), n * size);
  if (p) memset(p, 0, n * size);
  fault.blocks += p != NULL;
  return p;
}
void *__wrap_realloc(void *p, size_t size) {
  size_t old;
  if (fault_in_allocation()) return NULL;
  void *start = p ? unguarded(p, &old) : NULL;
  void *larger = guarded(__real_realloc(start, size + (size_t)2 * GUARD), size);
  fault.blocks += !p && larger;
  return larger;
}
void __wrap_free(void *p) {
  size_t size;
  fault.blocks -= p != NULL;
  __real_free(p ? unguarded(p, &size) : NULL);
}

// Functions supplied by the caller call this. It fails if the fault is at this call.
static inline CagStatus fault_in_call(CagError *e) {
  if (!fault_falls(FAULT_CALLBACK)) return CAG_OK;
  return cag_fail(e, CAG_E_CALLBACK, CAG_ERR_function_failed, "", -1, "the function failed");
}

// Runs the operation on `given` and releases its result.
typedef CagStatus (*FaultyOperation)(const void *given, CagError *e);

static inline CagStatus run_with_fault(FaultyOperation operation, const void *given, Fault kind,
                                       size_t at, CagError *e) {
  fault.kind = kind;
  fault.chances = 0;
  fault.at = at;
  fault.stop = 0;
  fault.result = 0;
  cag_memory_was_out(); // resets the record
  e->id = CAG_ERR_internal;
  CagStatus status = operation(given, e);
  fault.kind = FAULT_NONE;
  fault.stop = 0;
  return status;
}

static inline bool fault_is_reported(Fault kind, CagStatus status, const CagError *e) {
  switch (kind) {
  case FAULT_MEMORY: return cag_memory_was_out();
  case FAULT_CALLBACK: return status == CAG_E_CALLBACK && e->id == CAG_ERR_function_failed;
  default: return !status || (status == CAG_E_CALLBACK && e->id == CAG_ERR_interrupted);
  }
}

// The positions of the faults: all of the first ones, then at intervals proportional to the index.
typedef struct FaultSteps {
  size_t first, part;
} FaultSteps;
#define FAULTS_OF_QUICK ((FaultSteps){16, 3})
#define FAULTS_OF_SLOW ((FaultSteps){6, 2})
static FaultSteps fault_steps;

// Runs the operation with each fault in turn.
static inline void try_faults_of(Fault kind, const char *name, const char *kind_name,
                                 FaultyOperation operation, const void *given) {
  static const char *const WORD[] = {"", "allocation", "call", "stop at allocation"};
  CagError e;
  const long before = fault.blocks;
  const CagStatus usual = run_with_fault(operation, given, kind, 0, &e);
  const double result = fault.result;
  const size_t most = fault.chances;
  if (fault.blocks != before) {
    print_error("%s of %s: %ld blocks are not freed\n", name, kind_name, fault.blocks - before);
    fault_problems++;
  }
  for (size_t at = 1; at <= most; at += at < fault_steps.first ? 1 : 1 + at / fault_steps.part) {
    const long blocks = fault.blocks;
    const CagStatus status = run_with_fault(operation, given, kind, at, &e);
    const bool same = status == usual && fault.result == result;
#ifdef FAULT_STRICT
    if (kind == FAULT_MEMORY && same) print_error("SURVIVED ");
    else
#endif
        if ((same || fault_is_reported(kind, status, &e)) && fault.blocks == blocks)
      continue;
    fault_problems++;
    print_error("%s of %s, %s %zu of %zu: status %d \"%s\", %ld blocks are not freed\n", name,
                kind_name, WORD[kind], at, most, (int)status, cag_error_info(e.id)->reason,
                fault.blocks - blocks);
  }
}

static inline void try_faults(const char *name, const char *kind_name, FaultyOperation operation,
                              const void *given) {
  cag_stop_lend(&fault.stop);
  if (!fault_steps.first) fault_steps = FAULTS_OF_QUICK;
  for (Fault kind = FAULT_MEMORY; kind <= FAULT_STOP; kind++)
    try_faults_of(kind, name, kind_name, operation, given);
  cag_stop_lend(NULL);
}

#endif
