// Landlock rules for a child process. The C library has no functions for these system calls, so
// they are called by number.

#include "interp/render/sandbox.h"

#include <fcntl.h>
#include <stdint.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#if defined(__has_include) && defined(SYS_landlock_create_ruleset)
#if __has_include(<linux/landlock.h>)
#include <linux/landlock.h>
#define HAVE_LANDLOCK 1
#endif
#endif

#ifdef HAVE_LANDLOCK

// Rights that may be missing in old headers: renaming between folders (ABI 2) and truncation (ABI
// 3).
#define ACCESS_REFER (1ULL << 13)
#define ACCESS_TRUNCATE (1ULL << 14)
#define ACCESS_ABI1 ((1ULL << 13) - 1)

static const uint64_t READ =
    LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
// The rights that a rule on a file, rather than a folder, may contain.
static const uint64_t FOR_FILES = LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_READ_FILE |
                                  LANDLOCK_ACCESS_FS_WRITE_FILE | ACCESS_TRUNCATE;

// Returns all rights that this kernel can restrict, or 0 without Landlock.
static uint64_t handled_rights(void) {
  long abi = syscall(SYS_landlock_create_ruleset, NULL, 0, LANDLOCK_CREATE_RULESET_VERSION);
  if (abi < 1) return 0;
  return ACCESS_ABI1 | (abi >= 2 ? ACCESS_REFER : 0) | (abi >= 3 ? ACCESS_TRUNCATE : 0);
}

static bool allow(int ruleset, const char *path, uint64_t rights) {
  int fd = open(path, O_PATH | O_CLOEXEC);
  if (fd < 0) return true;
  struct stat st;
  if (fstat(fd, &st) == 0 && !S_ISDIR(st.st_mode)) rights &= FOR_FILES;
  struct landlock_path_beneath_attr rule = {.allowed_access = rights, .parent_fd = fd};
  bool ok = syscall(SYS_landlock_add_rule, ruleset, LANDLOCK_RULE_PATH_BENEATH, &rule, 0) == 0;
  close(fd);
  return ok;
}

int cag_sandbox_prepare(const char *const *readable, size_t count, const char *folder) {
  const uint64_t all = handled_rights();
  if (!all) return -1;
  struct landlock_ruleset_attr attributes = {.handled_access_fs = all};
  int ruleset = (int)syscall(SYS_landlock_create_ruleset, &attributes, sizeof attributes, 0);
  if (ruleset < 0) return -1;
  bool ok = allow(ruleset, folder, all);
  ok =
      allow(ruleset, "/dev/null", (READ | LANDLOCK_ACCESS_FS_WRITE_FILE | ACCESS_TRUNCATE) & all) &&
      ok;
  for (size_t i = 0; i < count; i++) ok = allow(ruleset, readable[i], READ) && ok;
  if (ok) return ruleset;
  close(ruleset);
  return -1;
}

bool cag_sandbox_enter(int ruleset) {
  if (ruleset < 0) return true;
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         syscall(SYS_landlock_restrict_self, ruleset, 0) == 0;
}

#else

int cag_sandbox_prepare(const char *const *readable, size_t count, const char *folder) {
  (void)readable, (void)count, (void)folder;
  return -1;
}

bool cag_sandbox_enter(int ruleset) { return ruleset < 0; }

#endif
