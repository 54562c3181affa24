// Reads the state of the machine from /proc, and derives the number of processes from it.

#include "cli/batch_load.h"

#include <ctype.h>
#include <dirent.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/clock.h"
#include "cli/batch_child.h"

// Seconds between checks for an idle processor, and between measurements of the fractions of time,
// which take fifteen ticks of the kernel's clock per processor.
#define LOOK_INTERVAL 0.008
#define SHARE_INTERVAL 0.15

// Processors count as idle if they are busy for less than this fraction of the time.
#define BUSY 0.95

// If a processor is idle, the number of processes may grow by this fraction of the number of
// processors, and by at least one.
#define GROWTH 0.125

// The number of processes by which the limit decreases per second without an idle processor.
#define SINK 0.5

// The maximum per processor until one has ended.
#define MOST_UNKNOWN 6.0

// If this many processes per processor are needed to keep it busy, they sleep. At the end of a
// batch, all waiting ones are then started at once, if they are not more than may run.
#define SLEEPERS 2.0

// The fraction of memory that must be free before more processes are started, and the fraction that
// all processes may use if they become as large as the largest one.
#define FREE_MEMORY 0.25
#define USED_MEMORY 0.75

static FILE *open_file(const char *proc, const char *name) {
  char path[4096];
  const int n = snprintf(path, sizeof path, "%s/%s", proc, name);
  return n > 0 && (size_t)n < sizeof path ? fopen(path, "re") : NULL;
}

// Reads the ticks of all processors. Returns false if there is no such file.
static bool read_ticks(const char *proc, double *busy, double *total) {
  unsigned long long t[8] = {0}; // user, nice, system, idle, iowait, irq, softirq, steal
  FILE *f = open_file(proc, "stat");
  const int n = f ? fscanf(f, "cpu %llu %llu %llu %llu %llu %llu %llu %llu", &t[0], &t[1], &t[2],
                           &t[3], &t[4], &t[5], &t[6], &t[7])
                  : 0;
  if (f) fclose(f);
  *total = 0;
  for (int i = 0; i < n; i++) *total += (double)t[i];
  *busy = *total - (double)t[3] - (double)t[4];
  // Processes with a lower priority than ours yield to us, so they count as idle.
  if (getpriority(PRIO_PROCESS, 0) <= 0) *busy -= (double)t[1];
  return n >= 4;
}

// Tests whether there is memory for one more process than `running`.
static bool has_memory(const CagLoad *l, size_t running) {
  char line[128];
  double total = 0, available = 0;
  FILE *f = open_file(l->proc, "meminfo");
  while (f && !available && fgets(line, sizeof line, f)) {
    if (!strncmp(line, "MemTotal:", 9)) total = 1024 * strtod(line + 9, NULL);
    if (!strncmp(line, "MemAvailable:", 13)) available = 1024 * strtod(line + 13, NULL);
  }
  if (f) fclose(f);
  return available > FREE_MEMORY * total &&
         (double)l->largest * (double)(running + 1) < USED_MEMORY * total;
}

// Counts the runnable threads of the machine, except this one. Returns SIZE_MAX if it is unknown.
static size_t count_runnable(const char *proc) {
  size_t n = 0;
  FILE *f = open_file(proc, "loadavg");
  const bool ok = f && fscanf(f, "%*f %*f %*f %zu", &n) == 1;
  if (f) fclose(f);
  return !ok ? SIZE_MAX : n ? n - 1 : 0;
}

void cag_load_begin(CagLoad *l, size_t workers, const char *proc) {
  const double now = cag_clock_seconds();
  *l = (CagLoad){
      .proc = proc, .workers = workers, .limit = (double)workers, .looked = now, .seen = now};
  read_ticks(proc, &l->busy, &l->total);
}

// Tests whether a processor is idle according to the measured fractions of time. Unlike a count of
// threads, they account for processes with lower priority.
static bool was_idle(CagLoad *l, double now) {
  double busy, total;
  if (now - l->seen < SHARE_INTERVAL || !read_ticks(l->proc, &busy, &total) || total <= l->total)
    return false;
  const double processors = (double)sysconf(_SC_NPROCESSORS_ONLN);
  const double share = (busy - l->busy) / (total - l->total);
  l->busy = busy;
  l->total = total;
  l->seen = now;
  return share * processors < BUSY * (double)l->workers;
}

static void measure_load(CagLoad *l, size_t running) {
  const double now = cag_clock_seconds(), passed = now - l->looked;
  if (passed < LOOK_INTERVAL) return;
  l->looked = now;
  const bool idle = was_idle(l, now);
  const bool has_room = idle || count_runnable(l->proc) < l->workers;
  // Only a few more than are running, because a limit that was not reached is meaningless.
  const double more = (double)running + fmax(1, floor(GROWTH * (double)l->workers));
  l->limit = has_room ? fmax(l->limit, more) : l->limit - SINK * passed;
  const double least = (double)l->workers;
  const double most = least * (l->largest ? CAG_LOAD_MOST : MOST_UNKNOWN);
  l->limit = fmax(least, fmin(most, l->limit));
}

size_t cag_load_limit(CagLoad *l, size_t running, size_t waiting) {
  measure_load(l, running);
  if (running < l->workers) return l->workers;
  size_t limit = (size_t)l->limit;
  const bool sleep = l->largest && l->limit >= SLEEPERS * (double)l->workers;
  if (sleep && waiting <= limit && running + waiting > limit) limit = running + waiting;
  if (limit > l->workers * CAG_LOAD_MOST) limit = l->workers * CAG_LOAD_MOST;
  return running >= limit || has_memory(l, running) ? limit : running;
}

void cag_load_ended(CagLoad *l, size_t memory) {
  if (memory > l->largest) l->largest = memory;
}

void cag_load_refused(CagLoad *l, size_t running) { l->limit = (double)running; }

// Reads the parent and the resident pages of a process from /proc/N/stat. Its second field is a
// name in parentheses that may contain any characters.
static bool read_process(const char *proc, const char *number, long *parent, long *pages) {
  char name[32], text[1024];
  snprintf(name, sizeof name, "%.20s/stat", number);
  FILE *f = open_file(proc, name);
  const size_t n = f ? fread(text, 1, sizeof text - 1, f) : 0;
  if (f) fclose(f);
  text[n] = '\0';
  const char *at = strrchr(text, ')');
  // state, parent, and 19 fields before field 24, the pages
  return at &&
         sscanf(at + 1,
                " %*c %ld %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s "
                "%*s %*s %ld",
                parent, pages) == 2;
}

void cag_load_memory(const char *proc, const pid_t *processes, size_t count, size_t *bytes) {
  const size_t page = (size_t)sysconf(_SC_PAGESIZE);
  memset(bytes, 0, count * sizeof *bytes);
  DIR *folder = opendir(proc);
  for (const struct dirent *e; folder && (e = readdir(folder));) {
    long parent, pages;
    if (!isdigit((unsigned char)e->d_name[0]) || !read_process(proc, e->d_name, &parent, &pages))
      continue;
    const long number = strtol(e->d_name, NULL, 10);
    for (size_t i = 0; i < count; i++)
      if (processes[i] == number || processes[i] == parent) bytes[i] += (size_t)pages * page;
  }
  if (folder) closedir(folder);
}
