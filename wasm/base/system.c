// Functions of the system that the C library of emscripten lacks.

#include <errno.h>
#include <fcntl.h>
#include <sys/random.h>
#include <unistd.h>

ssize_t getrandom(void *bytes, size_t size, unsigned flags) {
  (void)flags;
  return getentropy(bytes, size) == 0 ? (ssize_t)size : -1;
}

// Callers do without.
int fallocate(int file, int mode, off_t start, off_t length) {
  (void)file;
  (void)mode;
  (void)start;
  (void)length;
  errno = EOPNOTSUPP;
  return -1;
}
