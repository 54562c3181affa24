#include "brep/isolated.hpp"

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <poll.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif
#include <sys/wait.h>
#include <unistd.h>

namespace brep {

static void write_all(int file, const std::string &bytes) {
  for (size_t done = 0; done < bytes.size();) {
    const ssize_t n = write(file, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) _exit(1);
    done += static_cast<size_t>(n);
  }
}

static double now() {
  timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Reads to the end of the pipe. Returns false at the deadline, or when nobody reads `answers`.
static bool read_all(int file, double deadline, int answers, std::string &bytes) {
  char block[65536];
  for (;;) {
    const double left = deadline - now();
    pollfd waits[2] = {{file, POLLIN, 0}, {answers, 0, 0}};
    const int ready = poll(waits, 2,
                           std::isinf(left) ? -1
                           : left > 0       ? static_cast<int>(left * 1000) + 1
                                            : 0);
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0 || (answers >= 0 && waits[1].revents)) return false;
    const ssize_t n = read(file, block, sizeof block);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return n == 0;
    bytes.append(block, static_cast<size_t>(n));
  }
}

bool run_isolated(const std::function<std::string()> &work, double seconds, int answers,
                  std::string &out, std::string &why) {
  int ends[2];
  if (pipe(ends) != 0) {
    why = std::strerror(errno);
    return false;
  }
  const pid_t parent = getpid(), child = fork();
  if (child < 0) {
    why = std::strerror(errno);
    close(ends[0]);
    close(ends[1]);
    return false;
  }
  if (child == 0) {
    close(ends[0]);
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1);
#endif
    std::string result;
    try {
      result = work();
    } catch (...) { _exit(1); }
    // The size tells a complete result from one that was cut off.
    const uint64_t size = result.size();
    write_all(ends[1], std::string(reinterpret_cast<const char *>(&size), sizeof size));
    write_all(ends[1], result);
    _exit(0);
  }
  close(ends[1]);
  std::string bytes;
  const bool ended = read_all(ends[0], seconds > 0 ? now() + seconds : INFINITY, answers, bytes);
  close(ends[0]);
  if (!ended) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {}
  uint64_t size = 0;
  if (bytes.size() >= sizeof size) std::memcpy(&size, bytes.data(), sizeof size);
  if (ended && bytes.size() >= sizeof size && bytes.size() - sizeof size == size) {
    out = bytes.substr(sizeof size);
    return true;
  }
  why = !ended ? "it takes too long"
        : WIFSIGNALED(status)
            ? std::string("Open CASCADE crashed (") + strsignal(WTERMSIG(status)) + ")"
            : "Open CASCADE ended";
  return false;
}

} // namespace brep
