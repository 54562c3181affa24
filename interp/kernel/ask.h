// Asking the kernel: the message that goes out and the boundaries that come back.

#ifndef CAG_INTERP_KERNEL_ASK_H
#define CAG_INTERP_KERNEL_ASK_H

#include "base/digest.h"
#include "interp/kernel/kernel.h"
#include "interp/kernel/protocol.h"

// Sends a request and reads the boundaries of the answer. An answer to an equal request is used
// again: `question` identifies what determines the answer. *why is set (kernel.h).
CagStatus cag_kernel_ask(CagKernel *k, CagBrepMessage type, const CagFields *f,
                         const CagDigest *question, CagBoundaries *out, CagKernelFailure *why,
                         CagError *err);

#endif
