// Notices when files are saved.
//
// The folders of the files are watched, so that editors which save by renaming are noticed, and
// files that are deleted and made again. An event only wakes the watch: what has changed is found
// by comparing the state of each file (its inode, size, and times) with the last one seen. Where
// folders cannot be watched (there is no inotify, its limits are reached, or a folder is missing),
// the states are compared at intervals instead.

#ifndef CAG_LIVE_WATCH_FILES_H
#define CAG_LIVE_WATCH_FILES_H

#include <stdbool.h>
#include <stddef.h>

typedef struct CagFileWatch CagFileWatch;

// Returns NULL if memory ran out. `polled`: never use inotify.
CagFileWatch *cag_file_watch_new(bool polled);
void cag_file_watch_free(CagFileWatch *w);

// Replaces the list of files, given by absolute paths; a file may be missing. Files that stay in
// the list keep their state, so a change since the last look is still noticed. A new file counts as
// changed if it was changed at or after `since`, seconds of cag_file_watch_now: a run that began
// then may have read an earlier state. Returns false if memory ran out; the list is then
// incomplete.
bool cag_file_watch_set(CagFileWatch *w, const char *const *paths, size_t count, double since);

// The time in seconds by the clock of files.
double cag_file_watch_now(void);

// A file descriptor that becomes readable when there may be a change, for poll; -1: there is none.
int cag_file_watch_descriptor(const CagFileWatch *w);
// The longest time, in milliseconds, until the next look; -1: events are sufficient.
int cag_file_watch_interval(const CagFileWatch *w);

// Looks at the files. Returns whether one of them has changed since it was last reported, and the
// path of the first one (NULL: not needed), which is valid until the list is replaced.
bool cag_file_watch_look(CagFileWatch *w, const char **path);
// Returns file i of those that the last look found to have changed, or NULL.
const char *cag_file_watch_changed(const CagFileWatch *w, size_t i);

// Waits until a file has changed, and then until no file has changed for `quiet` milliseconds, or
// `most` milliseconds have passed, because editors save in several steps. Returns false after
// `timeout` milliseconds (-1: none) without a change, or if a signal arrives before one.
bool cag_file_watch_wait(CagFileWatch *w, int timeout, int quiet, int most, const char **path);

#endif
