// Rendering with POV-Ray: the temporary folder, the process, and the meaning of its exit.

#include "interp/render/povray.h"

#include <errno.h>
#include <ftw.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/memory.h"
#include "interp/render/exr.h"
#include "interp/render/image.h"
#include "interp/render/povray_process.h"
#include "interp/render/sandbox.h"

// The file name of the picture in the folder.
#define PICTURE "out.exr"
// The time limit, in seconds, for a run that only prints the version.
#define VERSION_TIME_LIMIT 20.0
// The largest picture file that is read: half floats of the largest image.
#define PICTURE_SIZE_MAX ((size_t)1 << 33)

// --- Finding POV-Ray ---

static bool find_program(char path[PATH_MAX], CagError *err) {
  const char *list = getenv("PATH");
  if (!list || !*list) list = "/usr/local/bin:/usr/bin:/bin";
  while (*list) {
    const size_t n = strcspn(list, ":");
    const int length = snprintf(path, PATH_MAX, "%.*s%spovray", (int)n, list, n ? "/" : "./");
    struct stat st;
    if (length < PATH_MAX && access(path, X_OK) == 0 && stat(path, &st) == 0 &&
        S_ISREG(st.st_mode)) {
      char real[PATH_MAX]; // absolute, because the process starts in another folder
      if (path[0] != '/' && realpath(path, real)) strcpy(path, real);
      return true;
    }
    list += n + (list[n] == ':');
  }
  return cag_fail_io(err, CAG_E_RENDERER,
                     "install it (apt-get install povray), or use --engine preview",
                     "POV-Ray is not installed: no program povray on PATH");
}

// --- The temporary folder ---

static int remove_entry(const char *path, const struct stat *st, int type, struct FTW *at) {
  (void)st, (void)type, (void)at;
  remove(path);
  return 0;
}

static void remove_folder(const char *folder) {
  enum { OPEN_FOLDERS = 8 };
  if (*folder) nftw(folder, remove_entry, OPEN_FOLDERS, FTW_DEPTH | FTW_PHYS);
}

static bool make_folder(char folder[PATH_MAX], CagError *err) {
  const char *base = getenv("TMPDIR");
  if (!base || *base != '/') base = "/tmp";
  char pattern[PATH_MAX];
  const int n = snprintf(pattern, sizeof pattern, "%s/cag-povray-XXXXXX", base);
  // The real path, because rules of file access do not follow links.
  if (n < PATH_MAX && mkdtemp(pattern) && realpath(pattern, folder)) return true;
  const int code = n < PATH_MAX ? errno : ENAMETOOLONG;
  *folder = '\0';
  return cag_fail_io(err, CAG_E_FILE, "set TMPDIR to a folder that you may write to",
                     "cannot create a temporary folder for POV-Ray in '%.300s': %s", base,
                     strerror(code));
}

static bool fail_temporary(CagError *err, const char *path, int code) {
  return cag_fail_io(err, CAG_E_FILE,
                     code == ENOSPC ? "free some space, or set TMPDIR to another disk" : NULL,
                     "cannot write the temporary file '%s': %s", path, strerror(code));
}

// Writes `size` bytes to the file `name` in the folder.
static bool put_file(const char *folder, const char *name, const void *bytes, size_t size,
                     CagError *err) {
  char path[PATH_MAX];
  if (snprintf(path, sizeof path, "%s/%s", folder, name) >= PATH_MAX)
    return fail_temporary(err, name, ENAMETOOLONG);
  FILE *f = fopen(path, "wbe");
  if (!f) return fail_temporary(err, path, errno);
  bool ok = fwrite(bytes, 1, size, f) == size;
  int code = errno;
  if (fclose(f) != 0 && ok) {
    ok = false;
    code = errno;
  }
  return ok || fail_temporary(err, path, code);
}

static bool is_plain_name(const char *name) {
  return *name && *name != '.' && !strchr(name, '/') && strlen(name) <= NAME_MAX;
}

static bool copy_file(const char *folder, const CagPovrayFile *file, CagError *err) {
  if (!is_plain_name(file->name))
    return cag_fail_io(err, CAG_E_USAGE, "use a name without folders",
                       "'%s' cannot be the name of a file beside the POV-Ray scene", file->name);
  FILE *in = fopen(file->source, "rbe");
  char *bytes = NULL;
  size_t size = 0;
  struct stat st;
  bool ok = in && fstat(fileno(in), &st) == 0 && S_ISREG(st.st_mode);
  if (ok) {
    bytes = cag_malloc((size_t)st.st_size + 1);
    ok = bytes != NULL;
  }
  if (ok) size = fread(bytes, 1, (size_t)st.st_size, in);
  ok = ok && !ferror(in);
  const int code = errno;
  if (!ok)
    cag_fail_io(err, CAG_E_FILE, NULL, "cannot read '%s', which the scene uses: %s", file->source,
                in && !bytes ? "it is not a regular file" : strerror(code));
  // Include files are part of the scene.
  const char *ending = strrchr(file->name, '.');
  if (ok && ending && !strcmp(ending, ".inc")) ok = cag_povray_check_files(bytes, size, err);
  ok = ok && put_file(folder, file->name, bytes, size, err);
  if (in) fclose(in);
  cag_free(bytes);
  return ok;
}

// Finds POV-Ray's include library relative to the program: <prefix>/share/povray-3.7/include.
static void library_path(const char *program, char out[PATH_MAX]) {
  char real[PATH_MAX], probe[PATH_MAX + 64];
  *out = '\0';
  if (!realpath(program, real)) return;
  for (int level = 0; level < 2; level++) {
    char *slash = strrchr(real, '/');
    if (!slash) return;
    *slash = '\0';
  }
  snprintf(probe, sizeof probe, "%s/share/povray-3.7/include", real);
  if (access(probe, R_OK) != 0) snprintf(probe, sizeof probe, "/usr/share/povray-3.7/include");
  if (access(probe, R_OK) == 0 && strlen(probe) < PATH_MAX) strcpy(out, probe);
}

// Writes the configuration that POV-Ray reads from its user's home, which is the folder.
static bool put_configuration(const char *folder, const char *library, CagError *err) {
  char text[3 * PATH_MAX], path[PATH_MAX];
  static const char *const LEVELS[] = {".povray", ".povray/3.7"};
  for (size_t i = 0; i < 2; i++) {
    if (snprintf(path, sizeof path, "%s/%s", folder, LEVELS[i]) >= PATH_MAX)
      return fail_temporary(err, folder, ENAMETOOLONG);
    if (mkdir(path, 0700) != 0) return fail_temporary(err, path, errno);
  }
  int n = snprintf(text, sizeof text,
                   "[File I/O Security]\nrestricted\n\n[Shellout Security]\nforbidden\n\n"
                   "[Permitted Paths]\nread* = %%INSTALLDIR%%/include\nread+write* = \"%s\"\n",
                   folder);
  if (*library) n += snprintf(text + n, sizeof text - (size_t)n, "read* = \"%s\"\n", library);
  if (!put_file(folder, ".povray/3.7/povray.conf", text, (size_t)n, err)) return false;
  n = *library ? snprintf(text, sizeof text, "Library_Path=\"%s\"\n", library) : 0;
  return put_file(folder, ".povray/3.7/povray.ini", text, (size_t)n, err);
}

// --- The process ---

// Makes a sandbox in which POV-Ray can read system libraries, itself, and its own library.
static int prepare_sandbox(const char *program, const char *library, const char *folder) {
  char own[PATH_MAX] = "/usr";
  char *slash = realpath(program, own) ? strrchr(own, '/') : NULL;
  if (slash) *slash = '\0';
  // The program on PATH may be a script or a link, which must be readable, too.
  char named[PATH_MAX];
  snprintf(named, sizeof named, "%s", program);
  slash = strrchr(named, '/');
  if (slash) *slash = '\0';
  const char *readable[] = {"/usr",
                            "/lib",
                            "/lib32",
                            "/lib64",
                            "/bin",
                            "/etc/ld.so.cache",
                            "/etc/ld.so.preload",
                            "/etc/localtime",
                            "/etc/povray",
                            "/dev/urandom",
                            "/sys/devices/system/cpu",
                            "/proc/stat",
                            "/proc/cpuinfo",
                            "/proc/meminfo",
                            own,
                            named,
                            *library ? library : "/usr"};
  return cag_sandbox_prepare(readable, sizeof readable / sizeof *readable, folder);
}

// Runs the program with the arguments in the folder, with the settings in `process`.
static CagPovrayEnd run_in_folder(const char *program, char *const *arguments, const char *folder,
                                  const char *library, CagPovrayProcess process,
                                  CagPovrayLog *log) {
  char home[PATH_MAX + 8], temporary[PATH_MAX + 8], path[PATH_MAX];
  snprintf(home, sizeof home, "HOME=%s", folder);
  snprintf(temporary, sizeof temporary, "TMPDIR=%s", folder);
  const char *list = getenv("PATH");
  snprintf(path, sizeof path, "PATH=%s", list ? list : "/usr/bin:/bin");
  char *const environment[] = {home, temporary, path, "LC_ALL=C", NULL};
  process.program = program;
  process.arguments = arguments;
  process.environment = environment;
  process.folder = folder;
  process.ruleset = prepare_sandbox(program, library, folder);
  const CagPovrayEnd end = cag_povray_process_run(&process, log);
  if (process.ruleset >= 0) close(process.ruleset);
  return end;
}

// --- The meaning of its exit ---

// Copies a line of the scene, without surrounding blanks.
static void scene_line(const CagPovrayJob *job, size_t line, char *out, size_t size) {
  const char *at = job->scene, *end = job->scene + job->scene_size;
  for (size_t i = 1; i < line && at < end; i++) {
    const char *newline = memchr(at, '\n', (size_t)(end - at));
    at = newline ? newline + 1 : end;
  }
  while (at < end && (*at == ' ' || *at == '\t')) at++;
  size_t n = 0;
  while (at + n < end && at[n] != '\n' && at[n] != '\r') n++;
  snprintf(out, size, "%.*s", (int)(n < size ? n : size - 1), at);
}

static bool fail_scene(const CagPovrayJob *job, const CagPovrayLog *log, CagError *err) {
  char text[121] = "";
  if (!strcmp(log->error_file, "scene.pov")) scene_line(job, log->error_line, text, sizeof text);
  return cag_fail_io(err, CAG_E_RENDERER, "to inspect the scene, use `cag export -o scene.pov`",
                     "POV-Ray rejected the scene at line %zu of '%.80s': %.240s%s%s",
                     log->error_line, log->error_file, log->error_text, *text ? "\n" : "", text);
}

// Sets the error of a run that produced no picture.
static bool fail_end(const CagPovrayJob *job, CagPovrayEnd end, const CagPovrayLog *log,
                     CagError *err) {
  char last[CAG_POVRAY_LAST_LINES * CAG_POVRAY_LINE_MAX];
  cag_povray_log_last(log, last, sizeof last);
  switch (end.kind) {
  case CAG_POVRAY_INTERRUPTED: return cag_fail_io(err, CAG_E_CALLBACK, NULL, "interrupted");
  case CAG_POVRAY_TIME:
    return cag_fail_io(err, CAG_E_LIMIT, "raise --max-time, or use --quality draft",
                       "POV-Ray was stopped after the time limit of %g s", job->time_limit);
  case CAG_POVRAY_NO_START:
    return cag_fail_io(err, CAG_E_RENDERER, NULL, "POV-Ray could not be started: %s",
                       strerror(end.code));
  case CAG_POVRAY_SIGNALED:
    return cag_fail_io(err, CAG_E_RENDERER,
                       end.code == SIGKILL
                           ? "the system may have run out of memory; try a larger tolerance"
                           : NULL,
                       "POV-Ray was killed by signal %d (%s)%s%.380s", end.code,
                       strsignal(end.code), *last ? "; its last lines were:" : "", last);
  case CAG_POVRAY_EXITED: break;
  }
  if (log->error_line) return fail_scene(job, log, err);
  if (end.code == CAG_POVRAY_EXEC_FAILED && !log->line_count)
    return cag_fail_io(err, CAG_E_RENDERER, "check that `povray` runs",
                       "POV-Ray could not be started");
  if (end.code == 0)
    return cag_fail_io(err, CAG_E_RENDERER, NULL,
                       "POV-Ray ended without an error but wrote no picture%s%.380s",
                       *last ? "; its last lines were:" : "", last);
  return cag_fail_io(err, CAG_E_RENDERER, NULL, "POV-Ray failed (exit status %d)%s%.380s", end.code,
                     *last ? "; its last lines were:" : "", last);
}

// Reads the picture into memory. Returns false if there is none.
static bool take_picture(const char *folder, CagPovrayResult *out) {
  char path[PATH_MAX + 16];
  snprintf(path, sizeof path, "%s/" PICTURE, folder);
  FILE *f = fopen(path, "rbe");
  struct stat st;
  cag_free(out->exr);
  out->exr = NULL;
  if (!f) return false;
  bool ok = fstat(fileno(f), &st) == 0 && S_ISREG(st.st_mode) && st.st_size > 0 &&
            (size_t)st.st_size < PICTURE_SIZE_MAX;
  out->exr = ok ? cag_malloc((size_t)st.st_size) : NULL;
  ok = out->exr && fread(out->exr, 1, (size_t)st.st_size, f) == (size_t)st.st_size;
  fclose(f);
  if (ok) {
    out->exr_size = (size_t)st.st_size;
  } else {
    cag_free(out->exr);
    out->exr = NULL;
  }
  return ok;
}

typedef struct {
  const char *folder;
  CagPovrayResult *result;
} Place;

static bool is_whole(void *user) {
  const Place *p = user;
  return take_picture(p->folder, p->result) &&
         cag_exr_is_whole(p->result->exr, p->result->exr_size);
}

// --- Rendering ---

// POV-Ray's settings for each quality. Antialiasing never uses jitter, so that pictures are
// reproducible.
static const struct {
  const char *quality, *antialias, *method, *depth;
} QUALITIES[] = {
    [CAG_POVRAY_DRAFT] = {"+Q8", "-A", "+AM1", "+R1"},
    [CAG_POVRAY_NORMAL] = {"+Q9", "+A0.1", "+AM2", "+R2"},
    [CAG_POVRAY_FINAL] = {"+Q9", "+A0.02", "+AM2", "+R4"},
};

static bool prepare_folder(const CagPovrayJob *job, const char *folder, const char *library,
                           CagError *err) {
  return put_configuration(folder, library, err) &&
         put_file(folder, "scene.pov", job->scene, job->scene_size, err) &&
         (!job->file || copy_file(folder, job->file, err));
}

static CagPovrayEnd render_in_folder(const CagPovrayJob *job, const char *program,
                                     const char *folder, const char *library,
                                     CagPovrayResult *result, CagPovrayLog *log) {
  char width[24], height[24], threads[24];
  snprintf(width, sizeof width, "+W%d", job->width);
  snprintf(height, sizeof height, "+H%d", job->height);
  long count = job->threads > 0 ? job->threads : sysconf(_SC_NPROCESSORS_ONLN);
  enum { THREADS_MAX = 512 }; // POV-Ray's own limit
  snprintf(threads, sizeof threads, "+WT%ld",
           count < 1             ? 1
           : count > THREADS_MAX ? THREADS_MAX
                                 : count);
  const int q = job->quality;
  // Columns and rows count from 1. Without a region, the ranges cover the whole picture.
  const bool part = job->region_width > 0;
  char edges[4][24];
  snprintf(edges[0], sizeof edges[0], "+SC%d", part ? job->region_x + 1 : 1);
  snprintf(edges[1], sizeof edges[1], "+EC%d",
           part ? job->region_x + job->region_width : job->width);
  snprintf(edges[2], sizeof edges[2], "+SR%d", part ? job->region_y + 1 : 1);
  snprintf(edges[3], sizeof edges[3], "+ER%d",
           part ? job->region_y + job->region_height : job->height);
  char *const arguments[] = {"povray",
                             "+Iscene.pov",
                             "+O" PICTURE,
                             "+FE",
                             width,
                             height,
                             threads,
                             edges[0],
                             edges[1],
                             edges[2],
                             edges[3],
                             (char *)QUALITIES[q].quality,
                             job->lens ? "-A" : (char *)QUALITIES[q].antialias,
                             (char *)QUALITIES[q].method,
                             (char *)QUALITIES[q].depth,
                             "-J",
                             job->alpha ? "+UA" : "-UA",
                             "-D",
                             "-P",
                             "+V",
                             NULL};
  Place place = {folder, result};
  const CagPovrayProcess process = {.time_limit = job->time_limit,
                                    .interrupted = job->interrupted,
                                    .picture = PICTURE,
                                    .is_whole = is_whole,
                                    .user = &place};
  return run_in_folder(program, arguments, folder, library, process, log);
}

bool cag_povray_render(const CagPovrayJob *job, CagPovrayResult *out, CagError *err) {
  char program[PATH_MAX], library[PATH_MAX], folder[PATH_MAX] = "";
  if (job->width < 1 || job->height < 1 || (size_t)job->width > CAG_IMAGE_SIDE_MAX ||
      (size_t)job->height > CAG_IMAGE_SIDE_MAX)
    return cag_fail_io(err, CAG_E_USAGE, "give --size as 1280x720",
                       "a picture of %d by %d pixels cannot be rendered", job->width, job->height);
  if (!cag_povray_check_files(job->scene, job->scene_size, err)) return false;
  if (!find_program(program, err) || !make_folder(folder, err)) return false;
  library_path(program, library);
  const double begun = cag_clock_seconds();
  CagPovrayLog log = {.progress = job->progress, .progress_user = job->progress_user};
  *out = (CagPovrayResult){0};
  bool ok = prepare_folder(job, folder, library, err);
  if (ok) {
    const CagPovrayEnd end = render_in_folder(job, program, folder, library, out, &log);
    ok = end.kind == CAG_POVRAY_EXITED && end.code == 0 && take_picture(folder, out);
    if (!ok) {
      fail_end(job, end, &log, err);
      cag_povray_result_free(out);
    }
  }
  remove_folder(folder);
  out->seconds = cag_clock_seconds() - begun;
  memcpy(out->version, log.version, sizeof out->version);
  return ok;
}

void cag_povray_result_free(CagPovrayResult *result) {
  cag_free(result->exr);
  *result = (CagPovrayResult){0};
}

bool cag_povray_find(char *path, size_t path_size, char version[64], CagError *err) {
  char program[PATH_MAX], library[PATH_MAX], folder[PATH_MAX] = "";
  if (!find_program(program, err)) return false;
  if (path) snprintf(path, path_size, "%s", program);
  if (!version) return true;
  if (!make_folder(folder, err)) return false;
  library_path(program, library);
  char *const arguments[] = {"povray", "--version", NULL};
  const CagPovrayProcess process = {.time_limit = VERSION_TIME_LIMIT};
  CagPovrayLog log = {0};
  bool ok = put_configuration(folder, library, err);
  if (ok) {
    const CagPovrayJob no_job = {.time_limit = VERSION_TIME_LIMIT};
    const CagPovrayEnd end = run_in_folder(program, arguments, folder, library, process, &log);
    ok = end.kind == CAG_POVRAY_EXITED && log.version[0];
    if (!ok) fail_end(&no_job, end, &log, err);
  }
  remove_folder(folder);
  memcpy(version, log.version, sizeof log.version);
  return ok;
}
