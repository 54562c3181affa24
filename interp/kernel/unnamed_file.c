// Files without a name (see unnamed_file.h).

#include "interp/kernel/unnamed_file.h"

#include <errno.h>
#include <stdio.h>
#include <sys/mman.h>
#include <unistd.h>

int cag_unnamed_file(const void *bytes, size_t size, char path[CAG_UNNAMED_PATH]) {
  const char *at = bytes;
  const int file = memfd_create("cag", MFD_CLOEXEC);
  for (size_t done = 0; file >= 0 && done < size;) {
    const ssize_t n = write(file, at + done, size - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      close(file);
      return -1;
    }
    done += (size_t)n;
  }
  snprintf(path, CAG_UNNAMED_PATH, "/proc/%ld/fd/%d", (long)getpid(), file);
  return file;
}

void cag_unnamed_close(int file) { close(file); }
