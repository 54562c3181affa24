// The program `cag`: parses the command line, calls the command, and exits with its status.
//
// Signals: the first Ctrl-C (or SIGTERM, SIGHUP, SIGXCPU) asks the work to stop, which leaves no
// partial output. A second one ends the program at once, after the temporary files of outputs are
// removed. So does an alarm if stopping takes too long, because a single long step of geometry does
// not check the flag. If the reader of standard output closes it, writes fail instead of raising a
// signal.

#include <fcntl.h>
#include <locale.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/clock.h"
#include "cli/cli.h"

volatile int cag_tool_interrupt;

// Signals within this time, in seconds, after the first one count as the same request, for example
// if both a shell and `timeout` send one. The work then still has time to clean up.
#define SAME_WISH 0.3

// The time, in seconds, that the work has to stop. Renderers, their folders, and the script need
// less.
#define PATIENCE 2

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
  // A write beyond the file size limit (ulimit -f) then fails like one on a full disk.
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
  for (size_t i = 0; i < sizeof SIGNALS / sizeof *SIGNALS; i++) {
    struct sigaction action = {.sa_handler = on_signal}, before; // system calls are interrupted,
                                                                 // not restarted
    sigemptyset(&action.sa_mask);
    // The parent may have set a signal to be ignored, as nohup does.
    if (sigaction(SIGNALS[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN)
      sigaction(SIGNALS[i], &action, NULL);
  }
}

// Opens closed standard files, so that no other file gets their numbers and receives standard
// output. They are opened in the wrong direction, so that their use is an error.
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
  setlocale(LC_CTYPE, ""); // for line editing; numbers keep the C format
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
