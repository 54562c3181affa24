// The tools that answer by text: check, run, measure, documentation, and examples.

#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "live/mcp_script.h"
#include "live/measures.h"

// --- check, run, measure ---

void cag_mcp_check(CagMcpCall *call) {
  CagMcpScript s;
  if (!cag_mcp_open(call, &s)) return;
  const int status = cag_mcp_check_script(&s);
  if (cag_session_error_count(s.session) == 0) cag_mcp_add_text(call, "no errors and no warnings");
  cag_mcp_conclude(&s, status);
  cag_mcp_close(&s);
}

static void add_output(CagMcpScript *s, const char *name, const CagMcpText *text) {
  cJSON *result = cag_mcp_structured(s->call);
  cJSON_AddStringToObject(result, name, text->bytes ? text->bytes : "");
  if (!text->bytes) return;
  cag_mcp_add_text(s->call, text->bytes);
  if (text->cut) cag_mcp_add_text(s->call, "the rest of the output is omitted");
}

// The lines of cag_session_describe_scene, as a list.
static void add_shown(CagMcpScript *s) {
  char *text = NULL, *rest = NULL;
  size_t length = 0;
  cJSON *list = cJSON_AddArrayToObject(cag_mcp_structured(s->call), "shown");
  FILE *f = open_memstream(&text, &length);
  if (!f) return;
  cag_session_describe_scene(s->session, f);
  fclose(f);
  if (length > 0) cag_mcp_add_text(s->call, text);
  for (char *line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest))
    cJSON_AddItemToArray(list, cJSON_CreateString(line));
  free(text);
}

void cag_mcp_run(CagMcpCall *call) {
  CagMcpScript s;
  if (!cag_mcp_open(call, &s)) return;
  const int status = cag_mcp_run_script(&s);
  add_output(&s, "output", &s.printed);
  add_output(&s, "trace", &s.traced);
  cJSON_AddBoolToObject(cag_mcp_structured(call), "truncated", s.printed.cut || s.traced.cut);
  if (status == CAG_STATUS_OK) add_shown(&s);
  cag_mcp_conclude(&s, status);
  if (cJSON_GetArraySize(call->content) == 0)
    cag_mcp_add_text(call, "the script prints and shows nothing");
  cag_mcp_close(&s);
}

void cag_mcp_measure(CagMcpCall *call) {
  CagMcpScript s;
  if (!cag_mcp_open(call, &s)) return;
  CagMeasuring m = {.status = cag_mcp_run_script(&s)};
  if (m.status == CAG_STATUS_OK)
    m = cag_measure(s.session, cag_mcp_script_name(&s), cag_mcp_text(call, "name"));
  if (m.status == CAG_STATUS_OK) {
    char *text = cJSON_PrintUnformatted(m.whole);
    if (text) cag_mcp_add_text(call, text);
    cJSON_free(text);
    call->structured = m.whole;
  } else {
    cJSON_Delete(m.whole);
  }
  cag_mcp_conclude(&s, m.status);
  cag_mcp_close(&s);
}

// --- documentation ---

void cag_mcp_documentation(CagMcpCall *call) {
  char *text = NULL;
  size_t length = 0;
  const char *name = cag_mcp_text(call, "name");
  CagSession *s = cag_session_new(NULL);
  FILE *f = s ? open_memstream(&text, &length) : NULL;
  const bool found = f && cag_session_document(s, name, false, f);
  if (f) fclose(f);
  if (found) {
    cag_mcp_add_text(call, text);
  } else {
    char message[300];
    snprintf(message, sizeof message,
             "nothing is documented as `%.100s`; without a name, this tool lists all functions",
             name ? name : "");
    call->is_error = true;
    cag_mcp_add_text(call, message);
  }
  free(text);
  cag_session_free(s);
}

// --- examples ---

// Whether a text contains all words, which are divided by spaces.
static bool has_words(const char *const *texts, size_t n, const char *words) {
  char word[64];
  for (const char *at = words + strspn(words, " "); *at; at += strspn(at, " ")) {
    const size_t k = strcspn(at, " ");
    bool found = false;
    snprintf(word, sizeof word, "%.*s", (int)k, at);
    for (size_t i = 0; i < n; i++) found = found || (texts[i] && strcasestr(texts[i], word));
    if (!found) return false;
    at += k;
  }
  return true;
}

typedef struct Examples {
  CagMcpCall *call;
  cJSON *list;
  const char *words;
  int count, most;
} Examples;

static void add_example(Examples *e, const char *name, const char *title, const char *text) {
  cJSON *one = cJSON_CreateObject();
  cJSON_AddStringToObject(one, "name", name);
  cJSON_AddStringToObject(one, "title", title);
  if (text) cJSON_AddStringToObject(one, "text", text);
  cJSON_AddItemToArray(e->list, one);
  e->count++;
  char *block = NULL;
  if (asprintf(&block, "%s: %s\n\n%s", name, title, text ? text : "") < 0) return;
  cag_mcp_add_text(e->call, block);
  free(block);
}

// The title of a script is its first comment.
static void title_of(const char *text, char *out, size_t size) {
  const char *at = strncmp(text, "// ", 3) ? text : text + 3;
  snprintf(out, size, "%.*s", (int)strcspn(at, "\n"), at);
}

static void find_scripts(Examples *e) {
  const char *name, *text;
  char title[200];
  for (size_t i = 0; e->count < e->most && cag_cookbook(i, &name, &text); i++) {
    title_of(text, title, sizeof title);
    if (!has_words((const char *[]){name, text}, 2, e->words)) continue;
    add_example(e, name, title, text);
  }
}

static void find_functions(Examples *e) {
  const char *signature, *summary, *example;
  for (size_t i = 0; e->count < e->most && cag_builtin_row(i, &signature, &summary, &example, NULL);
       i++) {
    if (!example || !has_words((const char *[]){signature, summary, example}, 3, e->words))
      continue;
    add_example(e, signature, summary ? summary : "", example);
  }
}

static void list_scripts(Examples *e) {
  const char *name, *text;
  char title[200];
  for (size_t i = 0; cag_cookbook(i, &name, &text); i++) {
    title_of(text, title, sizeof title);
    add_example(e, name, title, NULL);
  }
}

void cag_mcp_examples(CagMcpCall *call) {
  const char *words = cag_mcp_text(call, "words");
  Examples e = {.call = call,
                .list = cJSON_AddArrayToObject(cag_mcp_structured(call), "examples"),
                .words = words ? words : "",
                .most = (int)cag_mcp_number(call, "limit", 5)};
  if (e.words[strspn(e.words, " ")]) {
    find_scripts(&e);
    find_functions(&e);
  } else {
    list_scripts(&e);
  }
  if (e.count == 0) cag_mcp_add_text(call, "no example contains all of these words");
}
