// Pictures that a page asks for. Each is rendered by a thread and a session of its own, while the
// script can be changed and run again.

#ifndef CAG_LIVE_RENDER_JOBS_H
#define CAG_LIVE_RENDER_JOBS_H

#include "live/runner.h"

typedef struct CagRenderJobs CagRenderJobs;

CagRenderJobs *cag_render_jobs_new(const CagRunner *runner, CagServer *const *server);
// Cancels what is under way, and waits for it.
void cag_render_jobs_free(CagRenderJobs *jobs);
// Starts a picture of what the request shows. `body` is JSON: the engine, quality, width, height,
// and camera, which is a name or a record. Takes over the request. Returns the number of the job, 0
// if too many are under way or memory ran out, and -1 if the JSON is wrong.
int cag_render_jobs_add(CagRenderJobs *jobs, const char *body, size_t size,
                        CagLiveRequest *request);
void cag_render_jobs_cancel(CagRenderJobs *jobs, int number);
// A copy of the PNG file of a job, malloc'd. Returns false until it is done.
bool cag_render_jobs_picture(CagRenderJobs *jobs, int number, char **bytes, size_t *size);

#endif
