// The heap: pages of equal cells for small objects, malloc for large ones, and mark-and-sweep
// garbage collection of both.
//
// A cell of a page is free if its `type` is CELL_FREE. The mark alternates between 1 and 2 from one
// collection to the next, so that marks need not be cleared. A new object has the mark of the last
// collection and becomes garbage unless the next collection reaches it.
//
// Geometry may call the script (a curve by a formula) from within built-ins that hold values in
// plain variables. An object therefore records the number of such calls in which it was made, and a
// collection during a call keeps everything made outside of it. Values never change, so older
// objects do not refer to objects made during the call.

#include "interp/vm/heap.h"

#include <string.h>

#include "base/array.h"
#include "base/assert.h"
#include "base/memory.h"
#include "base/stop.h"
#include "interp/vm/value_type.h"
#include "interp/vm/vm.h"

#define CELL_FREE 0xff
// Pages are large compared to their header, and are rarely allocated.
#define PAGE_BYTES ((size_t)64 * 1024)
// A collection is due after this much allocation, or as much as is live, whichever is more. This
// keeps the cost of marking proportional to allocation.

struct CagPage {
  CagPage *next;
  size_t cell, count;
  max_align_t cells[];
};

// Under AddressSanitizer, each object is a separate block, so that uses after free are detected.
#if defined(__SANITIZE_ADDRESS__)
#define SMALL_LIMIT 0
// Frequent collections reveal values that are not rooted.
#define DEBT_MIN ((size_t)32 << 10)
#else
#define SMALL_LIMIT CAG_SMALL_MAX
#define DEBT_MIN ((size_t)16 << 20)
#endif

// The low bits of the mark byte are the mark; the others are the depth of calls from geometry.
#define MARK_BITS 2
#define MARK_MASK ((1 << MARK_BITS) - 1)

// Adds to the debt what geometry and lists have allocated since the last object.
static void add_debt_of_others(CagVm *vm) {
  CagHeap *h = &vm->heap;
  if (vm->account.used > h->seen) h->debt += vm->account.used - h->seen;
  h->seen = vm->account.used;
}

// Makes a new page of cells for a size class and threads them into its free list.
static bool add_page(CagHeap *h, size_t size_class) {
  CagPage *page = cag_malloc(PAGE_BYTES);
  if (!page) return false;
  page->cell = size_class * CAG_SMALL_STEP;
  page->count = (PAGE_BYTES - sizeof *page) / page->cell;
  page->next = h->pages;
  h->pages = page;
  char *cell = (char *)page->cells;
  for (size_t i = 0; i < page->count; i++, cell += page->cell) {
    CagObject *o = (CagObject *)cell;
    o->type = CELL_FREE;
    o->small = (uint8_t)size_class;
    o->next = h->free_lists[size_class];
    h->free_lists[size_class] = o;
  }
  return true;
}

void *cag_alloc(CagVm *vm, CagType type, size_t size) {
  CagHeap *h = &vm->heap;
  if (vm->account.used != h->seen) add_debt_of_others(vm);
  h->debt += size;
  CagObject *o;
  if (size <= SMALL_LIMIT) {
    size_t size_class = (size + CAG_SMALL_STEP - 1) / CAG_SMALL_STEP;
    if (!h->free_lists[size_class]) {
      if (!add_page(h, size_class)) cag_vm_out_of_memory(vm);
      h->seen = vm->account.used;
    }
    o = h->free_lists[size_class];
    h->free_lists[size_class] = o->next;
    memset(o, 0, size);
    o->small = (uint8_t)size_class;
  } else {
    o = cag_calloc(1, size);
    if (!o) cag_vm_out_of_memory(vm);
    o->next = h->large;
    h->large = o;
    h->seen = vm->account.used;
  }
  h->objects++;
  o->type = (uint8_t)type;
  o->mark = (uint8_t)(h->mark | h->depth << MARK_BITS);
  return o;
}

void cag_root_push(CagVm *vm, CagValue v) {
  if (!CAG_RESERVE(vm->roots, vm->root_capacity, vm->root_count + 1)) cag_vm_out_of_memory(vm);
  vm->roots[vm->root_count++] = v;
}

void cag_root_pop(CagVm *vm, size_t n) { vm->root_count -= n; }

// --- Marking ---

// The list of gray objects starts in the heap itself. If memory runs out for a longer list, the
// objects that do not fit stay marked, and a scan of the heap finds them later.
static bool grow_gray(CagHeap *h) {
  const size_t capacity = h->gray_capacity * 2;
  const bool first = h->gray == h->gray_first;
  CagObject **gray = cag_realloc(first ? NULL : h->gray, capacity * sizeof *gray);
  if (!gray) return false;
  if (first) memcpy(gray, h->gray_first, sizeof h->gray_first);
  h->gray = gray;
  h->gray_capacity = capacity;
  return true;
}

void cag_mark_object(CagHeap *h, CagObject *o) {
  if (!o || (o->mark & MARK_MASK) == h->mark) return;
  o->mark = (uint8_t)((o->mark & ~MARK_MASK) | h->mark);
  if (h->gray_count == h->gray_capacity && !grow_gray(h)) h->gray_lost = true;
  else h->gray[h->gray_count++] = o;
}

void cag_mark_value(CagHeap *h, CagValue v) {
  if (v.type >= CAG_FIRST_OBJECT && v.type != CAG_UNSET) cag_mark_object(h, v.as.object);
}

// Values marked, objects scanned, and pages swept between two checks of the stop flag.
enum { SCANS_BETWEEN_LOOKS = 1 << 14, PAGES_BETWEEN_LOOKS = 16 };

void cag_mark_values(CagHeap *h, const CagValue *v, size_t n) {
  h->values_marked += n;
  for (size_t i = 0; i < n; i++) {
    cag_mark_value(h, v[i]);
    if (i % SCANS_BETWEEN_LOOKS == SCANS_BETWEEN_LOOKS - 1 && cag_stopped()) return;
  }
}

// Marks the objects that an object refers to.
static void scan(CagHeap *h, CagObject *o) {
  CAG_ASSERT(o->type >= CAG_FIRST_OBJECT && o->type <= CAG_INTERNAL && o->type != CAG_UNSET);
  const CagValueType *type = cag_value_types[o->type];
  if (type->scan) type->scan(h, o);
}

// Frees what an object holds outside of the heap.
static void destroy(CagObject *o) {
  const CagValueType *type = cag_value_types[o->type];
  if (type->destroy) type->destroy(o);
}

static void mark_roots(CagVm *vm) {
  CagHeap *h = &vm->heap;
  cag_mark_values(h, vm->stack, (size_t)(vm->top - vm->stack));
  // Clears the dead values above the top of the stack, so that a later frame never exposes a stale
  // pointer to the collector.
  if (vm->high_water > vm->top)
    memset(vm->top, 0, (size_t)(vm->high_water - vm->top) * sizeof *vm->top);
  vm->high_water = vm->top;
  for (size_t i = 0; i < vm->frame_count; i++)
    if (vm->frames[i].closure) cag_mark_object(h, &vm->frames[i].closure->head);
  cag_mark_values(h, vm->roots, vm->root_count);
  cag_mark_values(h, vm->kept, vm->kept_count);
  for (size_t i = 0; i < CAG_MEMO_COUNT; i++) {
    cag_mark_object(h, vm->memos[i].owner);
    cag_mark_value(h, vm->memos[i].held);
  }
  for (size_t i = 0; i < vm->interned_size; i++)
    if (vm->interned[i]) cag_mark_object(h, &vm->interned[i]->head);
  for (size_t i = 0; i < vm->global_count; i++) cag_mark_value(h, vm->globals[i].value);
  for (size_t i = 0; i < vm->module_count; i++) cag_mark_value(h, vm->modules[i]->value);
  for (const CagProto *p = vm->protos; p; p = p->next)
    cag_mark_values(h, p->constants, p->constant_count);
  if (vm->builtin_values) cag_mark_values(h, vm->builtin_values, cag_builtin_count());
  for (size_t i = 0; i < vm->shown_count; i++) cag_mark_value(h, vm->shown[i].value);
}

// --- Sweeping ---

static bool lives(const CagHeap *h, CagObject *o) {
  if ((o->mark & MARK_MASK) == h->mark) return true;
  if (o->mark >> MARK_BITS >= h->depth) return false;
  o->mark = (uint8_t)((o->mark & ~MARK_MASK) | h->mark);
  return true;
}

// Frees the dead objects of a page and adds its free cells to their list. Returns the number of
// objects freed.
static size_t sweep_page(CagHeap *h, CagPage *page) {
  const size_t size_class = page->cell / CAG_SMALL_STEP;
  size_t live = 0;
  char *cell = (char *)page->cells;
  for (size_t i = 0; i < page->count; i++, cell += page->cell) {
    CagObject *o = (CagObject *)cell;
    if (o->type != CELL_FREE && lives(h, o)) {
      live++;
      continue;
    }
    if (o->type != CELL_FREE) destroy(o);
    o->type = CELL_FREE;
    o->next = h->free_lists[size_class];
    h->free_lists[size_class] = o;
  }
  h->objects += live;
  return page->count - live;
}

// If memory is short, returns empty pages to the system, except for one of each size class. Returns
// false if the run must stop. The pages that were not swept then keep their garbage, and their free
// cells are lost, until the next collection. *live and *free_bytes are the bytes of the cells in
// use and of the others.
static bool sweep(CagHeap *h, bool short_of_memory, size_t *live, size_t *free_bytes) {
  bool kept[CAG_SMALL_CLASSES] = {false};
  size_t swept = 0;
  h->objects = 0;
  *live = *free_bytes = 0;
  memset(h->free_lists, 0, sizeof h->free_lists);
  CagPage **at = &h->pages;
  while (*at) {
    if (++swept % PAGES_BETWEEN_LOOKS == 0 && cag_stopped()) return false;
    CagPage *page = *at;
    const size_t size_class = page->cell / CAG_SMALL_STEP;
    CagObject *const before = h->free_lists[size_class];
    const size_t free_cells = sweep_page(h, page);
    const bool empty = free_cells == page->count;
    if (empty && kept[size_class] && short_of_memory) {
      h->free_lists[size_class] = before;
      *at = page->next;
      cag_free(page);
    } else {
      kept[size_class] |= empty;
      *free_bytes += free_cells * page->cell;
      *live += (page->count - free_cells) * page->cell;
      at = &page->next;
    }
  }
  CagObject **link = &h->large;
  while (*link) {
    CagObject *o = *link;
    if (lives(h, o)) {
      h->objects++;
      link = &o->next;
    } else {
      *link = o->next;
      destroy(o);
      cag_free(o);
    }
  }
  return true;
}

// Returns false if the run must stop.
static bool drain(CagHeap *h) {
  while (h->gray_count) {
    scan(h, h->gray[--h->gray_count]);
    if (++h->scans % SCANS_BETWEEN_LOOKS == 0 && cag_stopped()) return false;
  }
  return !cag_stopped();
}

// Marks the objects that a marked object refers to, even if that has been done before.
static bool scan_again(CagHeap *h, CagObject *o) {
  if ((o->mark & MARK_MASK) != h->mark) return true;
  scan(h, o);
  return drain(h);
}

static bool scan_heap_again(CagHeap *h) {
  for (CagPage *page = h->pages; page; page = page->next) {
    char *cell = (char *)page->cells;
    for (size_t i = 0; i < page->count; i++, cell += page->cell)
      if (((CagObject *)cell)->type != CELL_FREE && !scan_again(h, (CagObject *)cell)) return false;
  }
  for (CagObject *o = h->large; o; o = o->next)
    if (!scan_again(h, o)) return false;
  return true;
}

static bool mark_all(CagVm *vm) {
  CagHeap *h = &vm->heap;
  h->gray_count = 0;
  h->gray_lost = false;
  h->values_marked = 0;
  mark_roots(vm);
  bool done = drain(h);
  while (done && h->gray_lost) { // each pass marks more objects
    h->gray_lost = false;
    done = scan_heap_again(h);
  }
  return done;
}

// Gives every object the mark of the last collection, which an interrupted collection has not done.
static void mark_evenly(CagHeap *h) {
  for (CagPage *page = h->pages; page; page = page->next) {
    char *cell = (char *)page->cells;
    for (size_t i = 0; i < page->count; i++, cell += page->cell) {
      CagObject *o = (CagObject *)cell;
      o->mark = (uint8_t)((o->mark & ~MARK_MASK) | h->mark);
    }
  }
  for (CagObject *o = h->large; o; o = o->next)
    o->mark = (uint8_t)((o->mark & ~MARK_MASK) | h->mark);
}

void cag_collect(CagVm *vm) {
  CagHeap *h = &vm->heap;
  if (h->unfinished) mark_evenly(h);
  vm->recent = (CagRecentOrigins){0};
  h->mark = h->mark == 1 ? 2 : 1;
  const bool short_of_memory = vm->account.used > vm->account.limit / 4;
  if (vm->account.used > vm->account.limit / 2) cag_memo_clear(vm);
  size_t live = 0, free_bytes = 0;
  h->unfinished = !mark_all(vm) || !sweep(h, short_of_memory, &live, &free_bytes);
  if (h->unfinished) return; // the run ends
  // Objects that take time to mark and sweep: cells, and lists of values.
  live += h->values_marked * sizeof(CagValue);
  h->debt = 0;
  h->seen = vm->account.used;
  const size_t room = (cag_account_room() + free_bytes) / 2;
  h->threshold = live > DEBT_MIN ? live : DEBT_MIN;
  if (h->threshold > room) h->threshold = room;
  h->collections++;
}

// Frees everything, at the end of the machine.
void cag_heap_free(CagVm *vm) {
  CagHeap *h = &vm->heap;
  for (CagPage *page = h->pages, *next; page; page = next) {
    next = page->next;
    char *cell = (char *)page->cells;
    for (size_t i = 0; i < page->count; i++, cell += page->cell)
      if (((CagObject *)cell)->type != CELL_FREE) destroy((CagObject *)cell);
    cag_free(page);
  }
  for (CagObject *o = h->large, *next; o; o = next) {
    next = o->next;
    destroy(o);
    cag_free(o);
  }
  if (h->gray != h->gray_first) cag_free(h->gray);
  memset(h, 0, sizeof *h);
}

void cag_heap_init(CagVm *vm) {
  const size_t quarter = vm->account.limit / 4;
  vm->heap = (CagHeap){.mark = 1, .threshold = DEBT_MIN < quarter ? DEBT_MIN : quarter};
  vm->heap.gray = vm->heap.gray_first;
  vm->heap.gray_capacity = CAG_GRAY_FIRST;
}
