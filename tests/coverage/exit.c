// Linked to the programs of `make coverage` with --wrap=_exit: a child process that ends by _exit
// first writes its counters.

#include <unistd.h>

void __gcov_dump(void);
_Noreturn void __real__exit(int status);
_Noreturn void __wrap__exit(int status);

_Noreturn void __wrap__exit(int status) {
  __gcov_dump();
  __real__exit(status);
}
