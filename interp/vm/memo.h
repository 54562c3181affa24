// What is computed once for a value and used again, such as the structures by which a shape is
// searched.
//
// A memo belongs to one object: values never change. The machine keeps a few of them, and their
// objects stay alive meanwhile. Together they take at most an eighth of the memory that the run may
// use, unless it is a single one, or a built-in is using more.

#ifndef CAG_INTERP_VM_MEMO_H
#define CAG_INTERP_VM_MEMO_H

#include "interp/vm/builtin.h"

// Memos that are kept at a time: a power of two.
#define CAG_MEMO_COUNT 64

typedef struct CagMemo {
  CagObject *owner; // NULL: none
  CagValue held;    // a value that `data` refers to
  void *data;
  void (*release)(void *data);
  size_t bytes;
  int users; // running built-ins that use the data
} CagMemo;

// The data that were kept for an object with this release function; NULL: none. They are kept until
// the built-in ends.
void *cag_memo_find(CagCall *call, const CagObject *owner, void (*release)(void *data));
// Keeps data, which release(data) frees, in the same way. `used_before` is the account's use before
// they were made. They may be released at once if memory is out, which ends the run.
void cag_memo_keep(CagCall *call, CagObject *owner, CagValue held, void *data,
                   void (*release)(void *data), size_t used_before);
// Forgets all that no running built-in uses.
void cag_memo_clear(CagVm *vm);

#endif
