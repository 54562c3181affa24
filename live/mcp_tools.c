// The table of tools. The schema that clients see and the check of arguments are made from it.

#include "live/mcp_tools.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

typedef enum Kind { TEXT, NUMBER, INTEGER, FLAG, PARAMS, TEXTS } Kind;

typedef struct Argument {
  const char *name;
  Kind kind;
  const char *story;
  bool required;
  const char *choices; // TEXT: the allowed values, divided by |; NULL: any
  double least, most;  // NUMBER, INTEGER; TEXTS: the most elements
} Argument;

#define SCRIPT                                                                                     \
  {"file", TEXT, "path of a script, relative to the server's folder; give either file or text",    \
   false,  NULL, 0,                                                                                \
   0},                                                                                             \
      {"text", TEXT, "source of a script; give either file or text", false, NULL, 0, 0}, {         \
    "params", PARAMS,                                                                              \
        "values of params of the script, such as {\"height\": 200}; a text is read as an "         \
        "expression",                                                                              \
        false, NULL, 0, 0                                                                          \
  }
#define SHOWN                                                                                      \
  {                                                                                                \
    "name", TEXT, "a definition that is shown alone, instead of what the script shows", false,     \
        NULL, 0, 0                                                                                 \
  }
#define PICTURE                                                                                    \
  {"width", INTEGER, "pixels (default: 640)", false, NULL, 16, 2048},                              \
      {"height", INTEGER, "pixels (default: 480)", false, NULL, 16, 2048}, {                       \
    "quality", TEXT, "draft is fast (default); normal and final have soft light", false,           \
        "draft|normal|final", 0, 0                                                                 \
  }
#define MOST_ARGUMENTS 12

static const struct Tool {
  const char *name, *title, *story;
  CagMcpFunction *function;
  Argument arguments[MOST_ARGUMENTS]; // ends with one without a name
} tools[] = {
    {"check",
     "Check a script",
     "Finds errors and warnings of a script without running it: syntax, unknown names, arguments, "
     "and types. The result has a list of diagnostics with locations and help.",
     cag_mcp_check,
     {{"file", TEXT, "path of a script, relative to the server's folder; give either file or text",
       false, NULL, 0, 0},
      {"text", TEXT, "source of a script; give either file or text", false, NULL, 0, 0}}},
    {"run",
     "Run a script",
     "Runs a script, and returns what it prints, a line for each shape that it shows, and its "
     "errors and warnings.",
     cag_mcp_run,
     {SCRIPT}},
    {"views",
     "Render views",
     "Renders what a script shows, seen by several cameras, and returns PNG pictures. The cameras "
     "top, bottom, front, back, left, right, and iso always exist; others are those of the "
     "script.",
     cag_mcp_views,
     {SCRIPT,
      SHOWN,
      {"views", TEXTS, "names of cameras (default: iso, front, top, right)", false, NULL, 0, 16},
      {"section", TEXT,
       "a plane above which everything is cut off, such as \"z=10\"; \"-z=10\" cuts off what is "
       "below",
       false, NULL, 0, 0},
      PICTURE}},
    {"section",
     "Render a section",
     "Cuts what a script shows by a plane, closes the cut, and returns a PNG picture of the rest "
     "and its measures. With outlines, also the outlines of the cut as SVG in millimeters.",
     cag_mcp_section,
     {SCRIPT,
      SHOWN,
      {"plane", TEXT,
       "an axis and a position in mm, such as \"z=10\": what lies above is removed; \"-z=10\" "
       "removes what lies below",
       true, NULL, 0, 0},
      {"view", TEXT, "name of a camera (default: one that sees the cut)", false, NULL, 0, 0},
      {"outlines", FLAG, "add the outlines of the cut as SVG", false, NULL, 0, 0},
      PICTURE}},
    {"measure",
     "Measure shapes",
     "Measures each part that a script shows, or a definition: type, bounds, area, volume, "
     "centroid, length, whether it is watertight, and the number of faces. Lengths are in mm.",
     cag_mcp_measure,
     {SCRIPT, SHOWN}},
    {"documentation",
     "Look up documentation",
     "Returns the documentation of a function (\"bspline\"), a module (\"std.materials\"), a word "
     "of the language, a chapter (\"language-card\" has the language on one page), or an error "
     "code (\"E0201\"). Without a name, it lists all functions.",
     cag_mcp_documentation,
     {{"name", TEXT, "what to look up", false, NULL, 0, 0}}},
    {"examples",
     "Find examples",
     "Returns example scripts that contain all given words: complete scripts of the cookbook, and "
     "examples of functions. Without words, it lists the cookbook.",
     cag_mcp_examples,
     {{"words", TEXT, "words to search for, such as \"gear\" or \"loft hull\"", false, NULL, 0, 0},
      {"limit", INTEGER, "the most examples to return (default: 5)", false, NULL, 1, 50}}},
};
#define TOOL_COUNT (sizeof tools / sizeof *tools)

// --- Schemas ---

static void add_choices(cJSON *schema, const char *choices) {
  cJSON *list = cJSON_AddArrayToObject(schema, "enum");
  for (const char *at = choices; *at;) {
    char word[64];
    const size_t n = strcspn(at, "|");
    snprintf(word, sizeof word, "%.*s", (int)n, at);
    cJSON_AddItemToArray(list, cJSON_CreateString(word));
    at += n + (at[n] == '|');
  }
}

static cJSON *argument_schema(const Argument *a) {
  static const char *const types[] = {
      [TEXT] = "string",  [NUMBER] = "number", [INTEGER] = "integer",
      [FLAG] = "boolean", [PARAMS] = "object", [TEXTS] = "array"};
  cJSON *schema = cJSON_CreateObject();
  cJSON_AddStringToObject(schema, "type", types[a->kind]);
  cJSON_AddStringToObject(schema, "description", a->story);
  if (a->choices) add_choices(schema, a->choices);
  if (a->kind == NUMBER || a->kind == INTEGER) {
    cJSON_AddNumberToObject(schema, "minimum", a->least);
    cJSON_AddNumberToObject(schema, "maximum", a->most);
  }
  if (a->kind == TEXTS) {
    cJSON_AddStringToObject(cJSON_AddObjectToObject(schema, "items"), "type", "string");
    cJSON_AddNumberToObject(schema, "minItems", 1);
    cJSON_AddNumberToObject(schema, "maxItems", a->most);
  }
  if (a->kind == PARAMS) {
    static const char *const values[] = {"string", "number", "boolean"};
    cJSON_AddItemToObject(cJSON_AddObjectToObject(schema, "additionalProperties"), "type",
                          cJSON_CreateStringArray(values, 3));
  }
  return schema;
}

static cJSON *tool_schema(const struct Tool *tool) {
  cJSON *schema = cJSON_CreateObject();
  cJSON_AddStringToObject(schema, "type", "object");
  cJSON *properties = cJSON_AddObjectToObject(schema, "properties"), *required = NULL;
  for (const Argument *a = tool->arguments; a->name; a++) {
    cJSON_AddItemToObject(properties, a->name, argument_schema(a));
    if (a->required && !required) required = cJSON_AddArrayToObject(schema, "required");
    if (a->required) cJSON_AddItemToArray(required, cJSON_CreateString(a->name));
  }
  cJSON_AddBoolToObject(schema, "additionalProperties", false);
  return schema;
}

cJSON *cag_mcp_tool_list(void) {
  cJSON *result = cJSON_CreateObject(), *list = cJSON_AddArrayToObject(result, "tools");
  for (size_t i = 0; i < TOOL_COUNT; i++) {
    cJSON *tool = cJSON_CreateObject();
    cJSON_AddStringToObject(tool, "name", tools[i].name);
    cJSON_AddStringToObject(tool, "title", tools[i].title);
    cJSON_AddStringToObject(tool, "description", tools[i].story);
    cJSON_AddItemToObject(tool, "inputSchema", tool_schema(&tools[i]));
    cJSON *notes = cJSON_AddObjectToObject(tool, "annotations");
    cJSON_AddBoolToObject(notes, "readOnlyHint", true);
    cJSON_AddBoolToObject(notes, "openWorldHint", false);
    cJSON_AddItemToArray(list, tool);
  }
  return result;
}

// --- Arguments ---

bool cag_mcp_refuse(CagMcpCall *call, const char *format, ...) {
  va_list args;
  va_start(args, format);
  vsnprintf(call->refusal, sizeof call->refusal, format, args);
  va_end(args);
  return false;
}

static bool is_choice(const char *text, const char *choices) {
  const size_t n = strlen(text);
  for (const char *at = choices; *at;) {
    const size_t k = strcspn(at, "|");
    if (k == n && !strncmp(at, text, n)) return true;
    at += k + (at[k] == '|');
  }
  return false;
}

static bool check_number(CagMcpCall *call, const Argument *a, const cJSON *v) {
  const double x = v->valuedouble;
  if (!cJSON_IsNumber(v) || !(x >= a->least && x <= a->most) ||
      (a->kind == INTEGER && x != floor(x)))
    return cag_mcp_refuse(call, "%s: expected %s in %g..%g", a->name,
                          a->kind == INTEGER ? "an integer" : "a number", a->least, a->most);
  return true;
}

static bool check_texts(CagMcpCall *call, const Argument *a, const cJSON *v) {
  const cJSON *item;
  const int n = cJSON_GetArraySize(v);
  bool ok = cJSON_IsArray(v) && n >= 1 && n <= a->most;
  if (ok) cJSON_ArrayForEach(item, v) ok = ok && cJSON_IsString(item);
  return ok || cag_mcp_refuse(call, "%s: expected a list of 1 to %g texts", a->name, a->most);
}

static bool check_params(CagMcpCall *call, const Argument *a, const cJSON *v) {
  const cJSON *item;
  bool ok = cJSON_IsObject(v);
  if (ok)
    cJSON_ArrayForEach(item, v) ok =
        ok && (cJSON_IsString(item) || cJSON_IsNumber(item) || cJSON_IsBool(item));
  return ok || cag_mcp_refuse(call, "%s: expected a record of texts, numbers, and bools", a->name);
}

static bool check_argument(CagMcpCall *call, const Argument *a, const cJSON *v) {
  switch (a->kind) {
  case TEXT:
    if (!cJSON_IsString(v)) return cag_mcp_refuse(call, "%s: expected a text", a->name);
    return !a->choices || is_choice(v->valuestring, a->choices) ||
           cag_mcp_refuse(call, "%s: expected one of %s", a->name, a->choices);
  case NUMBER:
  case INTEGER: return check_number(call, a, v);
  case FLAG: return cJSON_IsBool(v) || cag_mcp_refuse(call, "%s: expected true or false", a->name);
  case PARAMS: return check_params(call, a, v);
  case TEXTS: return check_texts(call, a, v);
  }
  return false;
}

static const Argument *find_argument(const struct Tool *tool, const char *name) {
  for (const Argument *a = tool->arguments; a->name; a++)
    if (!strcmp(a->name, name)) return a;
  return NULL;
}

static bool check_arguments(const struct Tool *tool, CagMcpCall *call) {
  const cJSON *v;
  cJSON_ArrayForEach(v, call->arguments) {
    const Argument *a = find_argument(tool, v->string);
    if (!a)
      return cag_mcp_refuse(call, "the tool %s has no argument `%.200s`", tool->name, v->string);
    if (!check_argument(call, a, v)) return false;
  }
  for (const Argument *a = tool->arguments; a->name; a++)
    if (a->required && !cJSON_GetObjectItemCaseSensitive(call->arguments, a->name))
      return cag_mcp_refuse(call, "%s: the argument is missing", a->name);
  return true;
}

const char *cag_mcp_text(const CagMcpCall *call, const char *name) {
  return cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(call->arguments, name));
}

double cag_mcp_number(const CagMcpCall *call, const char *name, double fallback) {
  const cJSON *v = cJSON_GetObjectItemCaseSensitive(call->arguments, name);
  return v ? v->valuedouble : fallback;
}

bool cag_mcp_flag(const CagMcpCall *call, const char *name) {
  return cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(call->arguments, name));
}

// --- Calls ---

void cag_mcp_add_text(CagMcpCall *call, const char *text) {
  cJSON *block = cJSON_CreateObject();
  cJSON_AddStringToObject(block, "type", "text");
  cJSON_AddStringToObject(block, "text", text);
  cJSON_AddItemToArray(call->content, block);
}

bool cag_mcp_call_tool(const char *name, CagMcpCall *call) {
  for (size_t i = 0; i < TOOL_COUNT; i++) {
    if (strcmp(tools[i].name, name) != 0) continue;
    if (!check_arguments(&tools[i], call)) return false;
    call->content = cJSON_CreateArray();
    tools[i].function(call);
    return !call->refusal[0];
  }
  return cag_mcp_refuse(call, "unknown tool `%.200s`", name);
}
