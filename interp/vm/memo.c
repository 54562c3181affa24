#include "interp/vm/memo.h"

#include "interp/vm/vm.h"

// Slots in which a memo can be. More built-ins than these cannot use memos of one slot at a time.
enum { PROBES = 16 };

static CagMemo *memo_at(CagVm *vm, const CagObject *owner, size_t probe) {
  // The upper half of a product by the golden ratio depends on all bits.
  const uint64_t hash = (uint64_t)(uintptr_t)owner * UINT64_C(0x9e3779b97f4a7c15) >> 32;
  return &vm->memos[(hash + probe) & (CAG_MEMO_COUNT - 1)];
}

static void memo_forget(CagVm *vm, CagMemo *m) {
  if (!m->owner || m->users > 0) return;
  const CagMemo old = *m;
  vm->memo_bytes -= old.bytes;
  *m = (CagMemo){0};
  old.release(old.data);
}

static void end_use(void *memo) { ((CagMemo *)memo)->users--; }

static void *use_memo(CagCall *call, CagMemo *m) {
  m->users++;
  cag_hold_for(call, end_use, m);
  return m->data;
}

void *cag_memo_find(CagCall *call, const CagObject *owner, void (*release)(void *data)) {
  for (size_t i = 0; i < PROBES; i++) {
    CagMemo *m = memo_at(call->vm, owner, i);
    if (m->owner == owner && m->release == release) return use_memo(call, m);
  }
  return NULL;
}

void cag_memo_keep(CagCall *call, CagObject *owner, CagValue held, void *data,
                   void (*release)(void *data), size_t used_before) {
  CagVm *vm = call->vm;
  const size_t used = vm->account.used, bytes = used > used_before ? used - used_before : 0;
  for (size_t i = 0; i < CAG_MEMO_COUNT && vm->memo_bytes + bytes > vm->account.limit / 8; i++)
    memo_forget(vm, &vm->memos[i]);
  CagMemo *m = NULL;
  for (size_t i = 0; i < PROBES && (!m || m->users > 0); i++) m = memo_at(vm, owner, i);
  if (m->users > 0) { // built-ins that call each other so deep: this one keeps it for itself
    cag_hold_for(call, release, data);
    return;
  }
  memo_forget(vm, m);
  *m = (CagMemo){owner, held, data, release, bytes, 0};
  vm->memo_bytes += bytes;
  use_memo(call, m);
}

void cag_memo_clear(CagVm *vm) {
  for (size_t i = 0; i < CAG_MEMO_COUNT; i++) memo_forget(vm, &vm->memos[i]);
}
