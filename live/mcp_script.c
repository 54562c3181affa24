// Scripts that are called by tools: their files, params, output, and diagnostics.

#include "live/mcp_script.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/status.h"

// What a script prints beyond this is not sent.
#define PRINTED_MOST ((size_t)256 << 10)

// --- Texts of limited length ---

static ssize_t write_text(void *cookie, const char *bytes, size_t n) {
  CagMcpText *t = cookie;
  const size_t room = PRINTED_MOST - t->length, kept = n < room ? n : room;
  t->cut = t->cut || kept < n;
  if (t->length + kept + 1 > t->capacity) {
    const size_t capacity = 2 * (t->length + kept) + 64;
    char *larger = realloc(t->bytes, capacity);
    if (!larger) return t->cut = true, (ssize_t)n;
    t->bytes = larger;
    t->capacity = capacity;
  }
  memcpy(t->bytes + t->length, bytes, kept);
  t->length += kept;
  t->bytes[t->length] = 0;
  return (ssize_t)n;
}

static FILE *open_text(CagMcpText *t) {
  return fopencookie(t, "w", (cookie_io_functions_t){.write = write_text});
}

// --- The script ---

static bool is_below(const char *path, const char *folder) {
  char real[PATH_MAX];
  if (!realpath(folder, real)) return false;
  const size_t n = strlen(real);
  return !strcmp(real, "/") || (!strncmp(path, real, n) && path[n] == '/');
}

// Finds the file below the server's folders. The message is the same whether a file outside exists
// or not.
static bool find_file(CagMcpCall *call, const char *file, char **out) {
  const CagMcpOptions *o = call->options;
  char joined[PATH_MAX], real[PATH_MAX];
  if (file[0] == '/') snprintf(joined, sizeof joined, "%s", file);
  else if (!strcmp(o->folder, ".")) snprintf(joined, sizeof joined, "%s", file);
  else snprintf(joined, sizeof joined, "%s/%s", o->folder, file);
  if (strlen(file) < PATH_MAX / 2 && realpath(joined, real)) {
    bool allowed = is_below(real, o->folder);
    for (size_t i = 0; !allowed && i < o->session.module_path_count; i++)
      allowed = is_below(real, o->session.module_path[i]);
    if (allowed) return (*out = strdup(joined)) || cag_mcp_refuse(call, "out of memory");
  }
  return cag_mcp_refuse(call, "file: cannot find %.200s in the folders of this server", file);
}

static bool find_script(CagMcpScript *s) {
  const char *file = cag_mcp_text(s->call, "file");
  s->text = cag_mcp_text(s->call, "text");
  if (!file == !s->text) return cag_mcp_refuse(s->call, "expected either `file` or `text`");
  return !file || find_file(s->call, file, &s->path);
}

static void set_params(CagMcpScript *s) {
  const cJSON *v;
  cJSON_ArrayForEach(v, cJSON_GetObjectItemCaseSensitive(s->call->arguments, "params")) {
    char number[32];
    const char *text = cJSON_IsString(v)   ? v->valuestring
                       : cJSON_IsNumber(v) ? cag_number_text(v->valuedouble, number)
                       : cJSON_IsTrue(v)   ? "true"
                                           : "false";
    cag_session_define(s->session, v->string, text);
  }
}

bool cag_mcp_read_section(CagMcpCall *call, double plane[4], bool *given) {
  static const char AXES[] = "xyz";
  const char *text = cag_mcp_text(call, "plane"), *option = text ? "plane" : "section";
  if (!text) text = cag_mcp_text(call, "section");
  *given = text != NULL;
  if (!text) return true;
  const char *at = text + (*text == '-'), *axis = *at ? strchr(AXES, *at) : NULL;
  const double sign = *text == '-' ? -1 : 1;
  char *end = NULL;
  const double height = axis && at[1] == '=' ? strtod(at + 2, &end) : 0;
  if (!end || end == at + 2 || *end || !(height - height == 0))
    return cag_mcp_refuse(call, "%s: expected an axis and a position, such as \"z=10\"", option);
  memset(plane, 0, 4 * sizeof *plane);
  plane[axis - AXES] = sign;
  plane[3] = sign * height;
  return true;
}

bool cag_mcp_open(CagMcpCall *call, CagMcpScript *s) {
  *s = (CagMcpScript){.call = call, .begun = cag_clock_seconds()};
  double plane[4];
  bool cut;
  if (!find_script(s) || !cag_mcp_read_section(call, plane, &cut)) {
    free(s->path);
    return false;
  }
  s->out = open_text(&s->printed);
  s->trace = open_text(&s->traced);
  CagSessionOptions o = call->options->session;
  o.out = s->out;
  o.messages = s->trace;
  o.folder = call->options->folder;
  o.interrupt = &call->stop;
  o.overdue = NULL;
  s->session = s->out && s->trace ? cag_session_new(&o) : NULL;
  if (!s->session) {
    cag_mcp_close(s);
    return cag_mcp_refuse(call, "out of memory");
  }
  set_params(s);
  if (cut) cag_session_set_section(s->session, plane);
  return true;
}

void cag_mcp_close(CagMcpScript *s) {
  cag_session_free(s->session);
  if (s->out) fclose(s->out);
  if (s->trace) fclose(s->trace);
  free(s->printed.bytes);
  free(s->traced.bytes);
  free(s->path);
}

const char *cag_mcp_script_name(const CagMcpScript *s) {
  return s->path ? cag_mcp_text(s->call, "file") : "text";
}

int cag_mcp_run_script(CagMcpScript *s) {
  int status = s->path ? cag_session_run_file(s->session, s->path)
                       : cag_session_run_text(s->session, "text", s->text, strlen(s->text));
  fflush(s->out);
  fflush(s->trace);
  const char *name = cag_mcp_text(s->call, "name");
  if (status == CAG_STATUS_OK && name && !cag_session_show_only(s->session, name))
    status = CAG_STATUS_LIMIT;
  return status;
}

int cag_mcp_check_script(CagMcpScript *s) {
  return s->path ? cag_session_check_file(s->session, s->path)
                 : cag_session_check_text(s->session, "text", s->text, strlen(s->text));
}

// --- Results ---

cJSON *cag_mcp_structured(CagMcpCall *call) {
  if (!call->structured) call->structured = cJSON_CreateObject();
  return call->structured;
}

static const char *status_word(int status) {
  switch (status) {
  case CAG_STATUS_OK: return "ok";
  case CAG_STATUS_SCRIPT: return "script";
  case CAG_STATUS_USAGE: return "usage";
  case CAG_STATUS_FILE: return "file";
  case CAG_STATUS_RENDERER: return "renderer";
  case CAG_STATUS_LIMIT: return "limit";
  default: return "interrupted";
  }
}

void cag_mcp_conclude(CagMcpScript *s, int status) {
  char *text = NULL;
  size_t length = 0;
  cJSON *result = cag_mcp_structured(s->call);
  FILE *f = open_memstream(&text, &length);
  if (f) {
    cag_session_write_diagnostics(s->session, CAG_STYLE_TEXT, f);
    fclose(f);
    if (length > 0) cag_mcp_add_text(s->call, text);
    free(text);
  }
  s->call->is_error = status != CAG_STATUS_OK;
  cJSON_AddStringToObject(result, "status", status_word(status));
  cJSON_AddItemToObject(result, "diagnostics", cag_json_diagnostics(s->session));
  cag_json_add_number(result, "seconds", cag_clock_seconds() - s->begun);
}
