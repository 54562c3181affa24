// What /proc says of the machine, and what follows for the number of processes.

#include "interp/tool/batch_load.h"

#include <ctype.h>
#include <dirent.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "interp/tool/batch_child.h"

// Seconds between looks: fifteen ticks of the kernel's clock for each processor.
static const double LOOK_INTERVAL = 0.15;

// Processors count as busy from this share on; processes are taken back above the second.
static const double BUSY = 0.97, FULL = 0.995;

// The number grows by what would fill the processors, but at most threefold at a look; it shrinks
// slowly.
static const double GROW_MOST = 3, SHRINK = 0.97;

// Memory that must be free, of all there is, before further processes are begun.
static const double FREE_MEMORY = 0.25;

// Reads the ticks of all processors. False where there is no such file.
static bool read_ticks(double *busy, double *total) {
  unsigned long long t[8] = {0}; // user, nice, system, idle, iowait, irq, softirq, steal
  FILE *f = fopen("/proc/stat", "re");
  const int n = f ? fscanf(f, "cpu %llu %llu %llu %llu %llu %llu %llu %llu", &t[0], &t[1], &t[2],
                           &t[3], &t[4], &t[5], &t[6], &t[7])
                  : 0;
  if (f) fclose(f);
  *total = 0;
  for (int i = 0; i < n; i++) *total += (double)t[i];
  *busy = *total - (double)t[3] - (double)t[4];
  // What runs at a lower priority than we do gives way.
  if (getpriority(PRIO_PROCESS, 0) <= 0) *busy -= (double)t[1];
  return n >= 4;
}

static bool has_memory(void) {
  char line[128];
  double total = 0, available = 0;
  FILE *f = fopen("/proc/meminfo", "re");
  while (f && fgets(line, sizeof line, f)) {
    if (!strncmp(line, "MemTotal:", 9)) total = strtod(line + 9, NULL);
    if (!strncmp(line, "MemAvailable:", 13)) available = strtod(line + 13, NULL);
  }
  if (f) fclose(f);
  return available > FREE_MEMORY * total;
}

void cag_load_begin(CagLoad *l, size_t workers) {
  *l = (CagLoad){.workers = workers, .limit = (double)workers, .seen = cag_child_now()};
  read_ticks(&l->busy, &l->total);
}

static void adapt(CagLoad *l, double share, size_t running) {
  const double processors = (double)sysconf(_SC_NPROCESSORS_ONLN);
  const double wanted = (double)l->workers, busy = share * processors;
  const double most = wanted * CAG_LOAD_MOST;
  if (busy < BUSY * wanted && (double)running >= floor(l->limit) && has_memory()) {
    const double factor = busy > 0 ? wanted / busy : GROW_MOST;
    l->limit = fmin(most, fmax(l->limit * fmin(factor, GROW_MOST), l->limit + 1));
  } else if (busy > FULL * wanted) {
    l->limit = fmax(wanted, l->limit * SHRINK);
  }
}

size_t cag_load_limit(CagLoad *l, size_t running) {
  double busy, total;
  const double now = cag_child_now();
  if (now - l->seen >= LOOK_INTERVAL && read_ticks(&busy, &total) && total > l->total) {
    adapt(l, (busy - l->busy) / (total - l->total), running);
    l->busy = busy;
    l->total = total;
    l->seen = now;
  }
  return (size_t)l->limit;
}

// Takes parent and pages in memory of a process from /proc/N/stat, whose second field is a name in
// parentheses that may hold anything.
static bool read_process(const char *number, long *parent, long *pages) {
  char path[64], text[1024];
  snprintf(path, sizeof path, "/proc/%.20s/stat", number);
  FILE *f = fopen(path, "re");
  const size_t n = f ? fread(text, 1, sizeof text - 1, f) : 0;
  if (f) fclose(f);
  text[n] = '\0';
  const char *at = strrchr(text, ')');
  // state, parent, then 19 fields up to the 24th, the pages
  return at &&
         sscanf(at + 1,
                " %*c %ld %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s "
                "%*s %*s %ld",
                parent, pages) == 2;
}

void cag_load_memory(const pid_t *processes, size_t count, size_t *bytes) {
  const size_t page = (size_t)sysconf(_SC_PAGESIZE);
  memset(bytes, 0, count * sizeof *bytes);
  DIR *folder = opendir("/proc");
  for (const struct dirent *e; folder && (e = readdir(folder));) {
    long parent, pages;
    if (!isdigit((unsigned char)e->d_name[0]) || !read_process(e->d_name, &parent, &pages))
      continue;
    const long number = strtol(e->d_name, NULL, 10);
    for (size_t i = 0; i < count; i++)
      if (processes[i] == number || processes[i] == parent) bytes[i] += (size_t)pages * page;
  }
  if (folder) closedir(folder);
}
