#include "live/server_token.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/state_file.h"

static const char DIGITS[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_";

static bool random_token(char out[CAG_SERVER_TOKEN + 1]) {
  unsigned char random[CAG_SERVER_TOKEN];
  if (getrandom(random, sizeof random, 0) != (ssize_t)sizeof random) return false;
  for (int i = 0; i < CAG_SERVER_TOKEN; i++) out[i] = DIGITS[random[i] & 63];
  out[CAG_SERVER_TOKEN] = 0;
  return true;
}

// Others must not be able to read or write the file.
static bool is_private(int file) {
  struct stat s;
  return fstat(file, &s) == 0 && S_ISREG(s.st_mode) && s.st_uid == geteuid() &&
         (s.st_mode & 077) == 0;
}

static bool read_token(const char *path, char out[CAG_SERVER_TOKEN + 1]) {
  char kept[CAG_SERVER_TOKEN + 1] = "";
  const int file = open(path, O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return false;
  const bool whole = is_private(file) && read(file, kept, sizeof kept) == CAG_SERVER_TOKEN;
  close(file);
  if (!whole || strspn(kept, DIGITS) != CAG_SERVER_TOKEN) return false;
  memcpy(out, kept, sizeof kept);
  return true;
}

// A token that cannot be kept is good for this server alone.
static void keep_token(const char *path, const char *token) {
  unlink(path);
  const int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (file < 0) return;
  if (write(file, token, CAG_SERVER_TOKEN) != CAG_SERVER_TOKEN) unlink(path);
  close(file);
}

bool cag_server_make_token(int port, char out[CAG_SERVER_TOKEN + 1]) {
  if (!port) return random_token(out);
  char name[32];
  snprintf(name, sizeof name, "view-%d.token", port);
  char *path = cag_state_file(name);
  const bool kept = path && read_token(path, out);
  const bool made = !kept && random_token(out);
  if (path && made) keep_token(path, out);
  free(path);
  return kept || made;
}
