// Plans and results as JSON files.

#include "cli/slurm_plan.h"

#include <cJSON.h>
#include <stdlib.h>
#include <string.h>

#include "base/atomic_file.h"
#include "cli/scripts.h"

static const char *text_of(const cJSON *object, const char *name) {
  return cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, name));
}

static double number_of(const cJSON *object, const char *name) {
  const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, name);
  return cJSON_IsNumber(item) ? item->valuedouble : 0;
}

static bool write_json(const char *path, const cJSON *object, CagError *err) {
  CagAtomicFile *f = cag_atomic_file_open(path, err);
  if (!f) return false;
  char *text = cJSON_PrintUnformatted(object);
  cag_atomic_file_text(f, text ? text : "");
  cag_atomic_file_text(f, "\n");
  cJSON_free(text);
  return cag_atomic_file_commit(f, err);
}

// --- Plans ---

bool cag_plan_write(const CagPlan *plan, const char *path, CagError *err) {
  cJSON *object = cJSON_CreateObject();
  cJSON_AddNumberToObject(object, "elements", (double)plan->elements);
  cJSON_AddNumberToObject(object, "retries", (double)plan->retries);
  cJSON_AddNumberToObject(object, "max_time", plan->max_time);
  cJSON_AddNumberToObject(object, "limit", plan->limit);
  cJSON_AddStringToObject(object, "folder", plan->folder);
  cJSON *tasks = cJSON_AddArrayToObject(object, "tasks");
  for (size_t i = 0; i < plan->count; i++) {
    cJSON *task = cJSON_CreateObject();
    cJSON_AddStringToObject(task, "key", plan->tasks[i].key);
    cJSON *words = cJSON_AddArrayToObject(task, "words");
    for (char **w = plan->tasks[i].words; *w; w++)
      cJSON_AddItemToArray(words, cJSON_CreateString(*w));
    cJSON_AddItemToArray(tasks, task);
  }
  const bool ok = write_json(path, object, err);
  cJSON_Delete(object);
  return ok;
}

static bool take_task(CagPlanTask *out, const cJSON *task) {
  const char *key = text_of(task, "key");
  const cJSON *words = cJSON_GetObjectItemCaseSensitive(task, "words");
  const int n = cJSON_GetArraySize(words);
  if (!key || strlen(key) >= sizeof out->key || n < 1) return false;
  strcpy(out->key, key);
  out->words = calloc((size_t)n + 1, sizeof *out->words);
  if (!out->words) return false;
  size_t i = 0;
  for (const cJSON *w = words->child; w; w = w->next)
    if (!cJSON_IsString(w) || !(out->words[i++] = strdup(w->valuestring))) return false;
  return true;
}

static bool take_plan(CagPlan *plan, const cJSON *object) {
  const cJSON *tasks = cJSON_GetObjectItemCaseSensitive(object, "tasks");
  const char *folder = text_of(object, "folder");
  const double elements = number_of(object, "elements");
  if (!cJSON_IsArray(tasks) || !folder || !(elements >= 1)) return false;
  plan->elements = (size_t)elements;
  plan->retries = (size_t)number_of(object, "retries");
  plan->max_time = number_of(object, "max_time");
  plan->limit = number_of(object, "limit");
  plan->folder = strdup(folder);
  plan->tasks = calloc((size_t)cJSON_GetArraySize(tasks) + 1, sizeof *plan->tasks);
  if (!plan->folder || !plan->tasks) return false;
  for (const cJSON *t = tasks->child; t; t = t->next)
    if (!take_task(&plan->tasks[plan->count++], t)) return false;
  return true;
}

bool cag_plan_read(const CagTool *t, CagPlan *plan, const char *path) {
  size_t length;
  *plan = (CagPlan){0};
  char *text = cag_tool_read_file(t, path, &length);
  if (!text) return false;
  cJSON *object = cJSON_ParseWithLength(text, length);
  free(text);
  const bool ok = take_plan(plan, object);
  cJSON_Delete(object);
  if (ok) return true;
  cag_plan_free(plan);
  cag_tool_fail(t, CAG_STATUS_FILE, "--element is for the plan that --engine-queue writes",
                "'%s' is not a plan of a batch", path);
  return false;
}

void cag_plan_free(CagPlan *plan) {
  for (size_t i = 0; i < plan->count; i++) {
    for (char **w = plan->tasks[i].words; w && *w; w++) free(*w);
    free(plan->tasks[i].words);
  }
  free(plan->tasks);
  free(plan->folder);
  *plan = (CagPlan){0};
}

// --- Results ---

char *cag_plan_result_path(const char *folder, const char *key) {
  char *path = NULL;
  return asprintf(&path, "%s/%s.json", folder, key) < 0 ? NULL : path;
}

bool cag_plan_write_result(const char *path, const CagTask *task, CagError *err) {
  cJSON *object = cJSON_CreateObject();
  cJSON_AddNumberToObject(object, "status", task->status);
  cJSON_AddNumberToObject(object, "seconds", task->seconds);
  cJSON_AddNumberToObject(object, "memory", (double)task->memory);
  cJSON_AddNumberToObject(object, "attempts", task->attempts);
  if (task->message) cJSON_AddStringToObject(object, "message", task->message);
  const bool ok = write_json(path, object, err);
  cJSON_Delete(object);
  return ok;
}

bool cag_plan_read_result(const char *path, CagTask *task) {
  // A result consists of a one-line message and some numbers.
  char text[8192];
  FILE *f = fopen(path, "re");
  if (!f) return false;
  const size_t n = fread(text, 1, sizeof text, f);
  fclose(f);
  cJSON *object = cJSON_ParseWithLength(text, n);
  const bool ok = cJSON_IsNumber(cJSON_GetObjectItemCaseSensitive(object, "status"));
  if (ok) {
    const char *message = text_of(object, "message");
    const double memory = number_of(object, "memory");
    task->status = (int)number_of(object, "status");
    task->seconds = number_of(object, "seconds");
    task->memory = memory > 0 ? (size_t)memory : 0;
    task->attempts = (int)number_of(object, "attempts");
    free(task->message);
    task->message = message ? strdup(message) : NULL;
  }
  cJSON_Delete(object);
  return ok;
}
