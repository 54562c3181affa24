// The program `cag`: reads the command line, calls the command, and ends with its status.
//
// Signals: the first Ctrl-C (or SIGTERM, SIGHUP, SIGXCPU) asks what runs to stop, which leaves
// nothing half written. A second one, or an alarm where that takes too long (a single long step of
// geometry does not look up), ends the program at once, after the temporaries of output files are
// removed. A standard output that nobody reads shows as a failed write, not as a signal.

#include <fcntl.h>
#include <locale.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/clock.h"
#include "cli/cli.h"

volatile int cag_tool_interrupt;

// Signals that come this soon (in seconds) after the first are the same wish, such as a shell and a
// `timeout` that both send one: what was asked to stop gets the time to clean up.
static const double SAME_WISH = 0.3;

// Seconds that what runs has to stop by itself: renderers, their folders and the script need less.
static const unsigned PATIENCE = 2;

static void end_now(void) {
  cag_atomic_files_cleanup();
  _exit(CAG_STATUS_INTERRUPTED);
}

static void on_signal(int number) {
  static volatile double first;
  if (number == SIGALRM) {
    end_now();
  } else if (!cag_tool_interrupt) {
    first = cag_clock_seconds();
    cag_tool_interrupt = 1;
    alarm(PATIENCE);
  } else if (cag_clock_seconds() - first > SAME_WISH) {
    end_now();
  }
}

static void catch_signals(void) {
  static const int SIGNALS[] = {SIGINT, SIGTERM, SIGHUP, SIGALRM, SIGXCPU};
  // A write beyond the limit of a file's size (ulimit -f) fails as one on a full disk does.
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
  for (size_t i = 0; i < sizeof SIGNALS / sizeof *SIGNALS; i++) {
    struct sigaction action = {.sa_handler = on_signal}, before; // reads are to end, not to resume
    sigemptyset(&action.sa_mask);
    // Who started the program may have asked for a signal to be ignored, as nohup does.
    if (sigaction(SIGNALS[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN)
      sigaction(SIGNALS[i], &action, NULL);
  }
}

// Fills closed standard files, so that no file opened later gets their numbers and what is meant
// for standard output ends in it. They are opened the wrong way round: their use is an error.
static void fill_standard_files(void) {
  bool filled = true;
  for (int fd = STDIN_FILENO; filled && fd <= STDERR_FILENO; fd++)
    filled = fcntl(fd, F_GETFD) >= 0 ||
             open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY) == fd;
}

int main(int argc, char **argv) {
  CagTool t;
  int count, status = CAG_STATUS_USAGE;
  fill_standard_files();
  catch_signals();
  setlocale(LC_CTYPE, ""); // for line editing; numbers stay as C writes them
  if (cag_tool_read(&t, argc, argv, &count)) {
    if (t.wants_help) cag_tool_help(t.command, stdout), status = CAG_STATUS_OK;
    else if (t.wants_version) status = printf("cag %s\n", cag_version()) < 0;
    else status = t.command->run(&t, count, argv);
    if (cag_tool_interrupt) status = CAG_STATUS_INTERRUPTED;
    status = cag_tool_close_output(&t, status);
  }
  cag_tool_release(&t);
  return status;
}
