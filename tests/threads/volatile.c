// The functions that GCC's thread sanitizer calls for each access to a volatile object, if it distinguishes these from other accesses
// (`make test-threads`). They do nothing: the only volatile objects shared by threads are the flags that request an operation to end. Such
// a flag is an int, which every machine reads and writes atomically. It is set once, and does not refer to other memory. A signal handler
// may set it as well.

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
