// What GCC's thread sanitizer calls at each access of a volatile object, if it is to tell them from other accesses (`make test-threads`).
// They are left out: the only volatile objects that threads share are the flags that ask work to end. Such a flag is an int, which every
// machine reads and writes as a whole, is set once, and says nothing of other memory. A signal handler may set it as well.

#define ACCESS(size)                                                                               \
  void __tsan_volatile_read##size(void *);                                                         \
  void __tsan_volatile_write##size(void *);                                                        \
  void __tsan_volatile_read##size(void *at) { (void)at; }                                          \
  void __tsan_volatile_write##size(void *at) { (void)at; }

ACCESS(1)
ACCESS(2)
ACCESS(4)
ACCESS(8)
ACCESS(16)
