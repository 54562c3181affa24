// The tools that answer by pictures: views and section.
//
// Pictures are rendered by the built-in renderer into a temporary folder, and sent as PNG in base64.

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "live/mcp_script.h"
#include "live/measures.h"

// --- Files ---

static bool read_file(const char *path, unsigned char **bytes, size_t *n) {
  FILE *f = fopen(path, "rbe");
  *bytes = NULL;
  *n = 0;
  if (!f) return false;
  const long size = fseek(f, 0, SEEK_END) == 0 ? ftell(f) : -1;
  rewind(f);
  if (size > 0) *bytes = malloc((size_t)size + 1);
  if (*bytes) *n = fread(*bytes, 1, (size_t)size, f);
  const bool complete = *bytes && *n == (size_t)size;
  if (complete) (*bytes)[*n] = 0;
  fclose(f);
  return complete;
}

// RFC 4648, section 4. Returns NULL if memory ran out.
static char *base64(const unsigned char *bytes, size_t n) {
  static const char DIGITS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  char *out = malloc((n + 2) / 3 * 4 + 1), *to = out;
  for (size_t i = 0; out && i < n; i += 3) {
    const unsigned a = bytes[i], b = i + 1 < n ? bytes[i + 1] : 0, c = i + 2 < n ? bytes[i + 2] : 0;
    *to++ = DIGITS[a >> 2];
    *to++ = DIGITS[(a & 3) << 4 | b >> 4];
    *to++ = i + 1 < n ? DIGITS[(b & 15) << 2 | c >> 6] : '=';
    *to++ = i + 2 < n ? DIGITS[c & 63] : '=';
  }
  if (out) *to = 0;
  return out;
}

static bool make_folder(CagMcpCall *call, char folder[PATH_MAX]) {
  const char *base = getenv("TMPDIR");
  snprintf(folder, PATH_MAX, "%s/cag-mcp-XXXXXX", base && *base == '/' ? base : "/tmp");
  if (mkdtemp(folder)) return true;
  call->is_error = true;
  cag_mcp_add_text(call, "cannot create a temporary folder; set TMPDIR");
  return false;
}

// --- Pictures ---

// Several pictures share the progress of a call.
typedef struct Pictures {
  CagMcpScript *script;
  CagRenderOptions options;
  char folder[PATH_MAX];
  int index, count;
} Pictures;

static void show_progress(void *context, double percent, const char *phase) {
  const Pictures *p = context;
  CagMcpCall *call = p->script->call;
  call->progress(call->progress_context, (100 * p->index + percent) / p->count, phase);
}

static void begin_pictures(Pictures *p, CagMcpScript *s, int count) {
  cag_render_options_init(&p->options);
  const char *quality = cag_mcp_text(s->call, "quality");
  p->script = s;
  p->index = 0;
  p->count = count;
  p->options.width = (int)cag_mcp_number(s->call, "width", 640);
  p->options.height = (int)cag_mcp_number(s->call, "height", 480);
  p->options.quality = quality ? quality : "draft";
  p->options.engine = "preview";
  if (s->call->progress) p->options.progress = show_progress;
  p->options.progress_context = p;
}

static bool add_picture(CagMcpCall *call, const char *path) {
  unsigned char *bytes;
  size_t n;
  char *data = read_file(path, &bytes, &n) ? base64(bytes, n) : NULL;
  free(bytes);
  if (!data) return false;
  cJSON *block = cJSON_CreateObject();
  cJSON_AddStringToObject(block, "type", "image");
  cJSON_AddStringToObject(block, "data", data);
  cJSON_AddStringToObject(block, "mimeType", "image/png");
  cJSON_AddItemToArray(call->content, block);
  free(data);
  return true;
}

static int render_view(Pictures *p, const char *view) {
  char path[PATH_MAX + 16];
  snprintf(path, sizeof path, "%s/view.png", p->folder);
  p->options.camera = view;
  int status = cag_session_render(p->script->session, &p->options, path);
  if (status == CAG_STATUS_OK) {
    cag_mcp_add_text(p->script->call, view);
    if (!add_picture(p->script->call, path)) status = CAG_STATUS_LIMIT;
  }
  unlink(path);
  p->index++;
  return status;
}

// --- views ---

static const char *const USUAL[] = {"iso", "front", "top", "right"};

static int render_views(Pictures *p, const cJSON *views) {
  int status = CAG_STATUS_OK;
  for (int i = 0; status == CAG_STATUS_OK && i < p->count; i++)
    status = render_view(p, views ? cJSON_GetArrayItem(views, i)->valuestring : USUAL[i]);
  return status;
}

void cag_mcp_views(CagMcpCall *call) {
  CagMcpScript s;
  Pictures p;
  const cJSON *views = cJSON_GetObjectItemCaseSensitive(call->arguments, "views");
  if (!cag_mcp_open(call, &s)) return;
  int status = cag_mcp_run_script(&s);
  begin_pictures(&p, &s, views ? cJSON_GetArraySize(views) : (int)(sizeof USUAL / sizeof *USUAL));
  if (status == CAG_STATUS_OK && make_folder(call, p.folder)) {
    status = render_views(&p, views);
    rmdir(p.folder);
  }
  cJSON *result = cag_mcp_structured(call);
  cJSON_AddItemToObject(result, "views",
                        views ? cJSON_Duplicate(views, true)
                              : cJSON_CreateStringArray(USUAL, sizeof USUAL / sizeof *USUAL));
  cJSON_AddNumberToObject(result, "width", p.options.width);
  cJSON_AddNumberToObject(result, "height", p.options.height);
  const bool failed = call->is_error;
  cag_mcp_conclude(&s, status);
  call->is_error = call->is_error || failed;
  cag_mcp_close(&s);
}

// --- section ---

// A standard view from the side that is removed.
static const char *view_of(const char *plane) {
  return !strncmp(plane, "-x", 2)   ? "left"
         : !strncmp(plane, "-z", 2) ? "bottom"
         : plane[0] == 'y'          ? "back"
                                    : "iso";
}

static int add_outlines(CagMcpScript *s, const char *folder) {
  char path[PATH_MAX + 16];
  unsigned char *bytes = NULL;
  size_t n;
  snprintf(path, sizeof path, "%s/cut.svg", folder);
  const int status = cag_session_export(s->session, path, NULL);
  if (status == CAG_STATUS_OK && read_file(path, &bytes, &n)) {
    cag_mcp_add_text(s->call, (const char *)bytes);
    cJSON_AddStringToObject(cag_mcp_structured(s->call), "outlines", (const char *)bytes);
  }
  free(bytes);
  unlink(path);
  return status;
}

static int make_section(CagMcpScript *s, Pictures *p) {
  CagMcpCall *call = s->call;
  const char *view = cag_mcp_text(call, "view");
  int status = render_view(p, view ? view : view_of(cag_mcp_text(call, "plane")));
  if (status != CAG_STATUS_OK) return status;
  const CagMeasuring m =
      cag_measure(s->session, cag_mcp_script_name(s), cag_mcp_text(call, "name"));
  if (m.status == CAG_STATUS_OK) {
    char *text = cJSON_PrintUnformatted(m.whole);
    if (text) cag_mcp_add_text(call, text);
    cJSON_free(text);
    cJSON_AddItemToObject(cag_mcp_structured(call), "measures", m.whole);
  } else {
    cJSON_Delete(m.whole);
  }
  status = m.status;
  if (status == CAG_STATUS_OK && cag_mcp_flag(call, "outlines"))
    status = add_outlines(s, p->folder);
  return status;
}

void cag_mcp_section(CagMcpCall *call) {
  CagMcpScript s;
  Pictures p;
  if (!cag_mcp_open(call, &s)) return;
  int status = cag_mcp_run_script(&s);
  cJSON_AddStringToObject(cag_mcp_structured(call), "plane", cag_mcp_text(call, "plane"));
  begin_pictures(&p, &s, 1);
  if (status == CAG_STATUS_OK && make_folder(call, p.folder)) {
    status = make_section(&s, &p);
    rmdir(p.folder);
  }
  const bool failed = call->is_error;
  cag_mcp_conclude(&s, status);
  call->is_error = call->is_error || failed;
  cag_mcp_close(&s);
}
