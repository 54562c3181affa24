#include "base/state_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

// Creates the missing folders of a path.
static void make_folders(char *path) {
  for (char *at = path + 1; *at; at++) {
    if (*at != '/') continue;
    *at = 0;
    mkdir(path, 0700);
    *at = '/';
  }
}

char *cag_state_file(const char *name) {
  const char *state = getenv("XDG_STATE_HOME"), *home = getenv("HOME");
  char *path = NULL;
  int n = -1;
  if (state && *state == '/') n = asprintf(&path, "%s/cag/%s", state, name);
  else if (home && *home == '/') n = asprintf(&path, "%s/.local/state/cag/%s", home, name);
  if (n < 0) return NULL;
  make_folders(path);
  return path;
}
