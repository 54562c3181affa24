// Signatures of built-ins: parsing.

#include "interp/vm/signature.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "interp/vm/value.h"

// --- Words for types ---

#define TYPE(tag) ((uint64_t)1 << CAG_##tag)
#define NUMBERS (TYPE(NUMBER) | TYPE(JET))
#define ANGLES (TYPE(ANGLE) | TYPE(JET))
#define RANGES (TYPE(RANGE) | TYPE(LIST))
#define SCALARS (TYPE(NUMBER) | TYPE(ANGLE) | TYPE(BOOL))
#define WORDS (SCALARS | TYPE(TEXT))
#define ALL ((TYPE(TYPE_COUNT) - 1))
#define ALL_BUT(types) (ALL & ~(types))

static const struct {
  const char *words;
  CagParameterKind kind;
  uint64_t accepts;
} known[] = {
#define CAG_PARAMETER_TYPE(words, kind, accepts) {words, CAG_BIND_##kind, accepts},
#include "interp/vm/parameter_types.def"
#undef CAG_PARAMETER_TYPE
};
#define KNOWN_COUNT (sizeof known / sizeof *known)

// A part of the text.
typedef struct Part {
  const char *start, *end;
} Part;

static size_t part_length(Part p) { return (size_t)(p.end - p.start); }

static Part trimmed(Part p) {
  while (p.start < p.end && (*p.start == ' ' || *p.start == '\n')) p.start++;
  while (p.end > p.start && (p.end[-1] == ' ' || p.end[-1] == '\n')) p.end--;
  return p;
}

static char *part_text(Part p, CagArena *arena) {
  char *text = cag_arena_alloc(arena, part_length(p) + 1);
  memcpy(text, p.start, part_length(p));
  return text;
}

// The first `what` outside of brackets and texts, or the end of the part.
static const char *find_outside(Part p, const char *what) {
  int depth = 0;
  bool quoted = false;
  const size_t n = strlen(what);
  for (const char *s = p.start; s + n <= p.end; s++) {
    if (!quoted && depth == 0 && strncmp(s, what, n) == 0) return s;
    if (*s == '"') quoted = !quoted;
    if (quoted) continue;
    if (*s == '(' || *s == '[' || *s == '{') depth++;
    else if (*s == ')' || *s == ']' || *s == '}') depth--;
  }
  return p.end;
}

// The known words that the alternative begins with, the longest of them; KNOWN_COUNT: none.
static size_t find_words(Part p) {
  size_t best = KNOWN_COUNT, length = 0;
  for (size_t i = 0; i < KNOWN_COUNT; i++) {
    const size_t n = strlen(known[i].words);
    if (n <= length || n > part_length(p) || strncmp(p.start, known[i].words, n) != 0) continue;
    if (n < part_length(p) && p.start[n] != ' ') continue;
    best = i;
    length = n;
  }
  return best;
}

// Takes the range off the end of a type.
static Part parse_range(Part p, CagParameterType *out) {
  static const char *const signs[] = {" >= ", " > ", " in "};
  for (size_t i = 0; i < sizeof signs / sizeof *signs; i++) {
    const char *at = find_outside(p, signs[i]);
    if (at == p.end) continue;
    out->ranged = true;
    out->above_low = i == 1;
    out->low = strtod(at + strlen(signs[i]), NULL);
    // Of "1..5", strtod reads "1.".
    const char *dots = find_outside((Part){at, p.end}, "..");
    out->high = i == 2 && dots < p.end ? strtod(dots + 2, NULL) : HUGE_VAL;
    return (Part){p.start, at};
  }
  return p;
}

static void parse_type(CagParameterType *out, Part p, CagArena *arena) {
  static const char or [] = " or ";
  *out = (CagParameterType){.low = -HUGE_VAL, .high = HUGE_VAL};
  p = parse_range(p, out);
  size_t count = 1, texts = 0;
  for (Part rest = p; rest.start < rest.end; rest.start += strlen(or)) {
    rest.start = find_outside(rest, or);
    if (rest.start == rest.end) break;
    count++;
  }
  const char **choices = cag_arena_alloc(arena, (count + 1) * sizeof *choices);
  bool any = false;
  for (size_t i = 0; i < count; i++) {
    const Part one = {p.start, find_outside(p, or)};
    if (*one.start == '"') {
      choices[texts++] = part_text((Part){one.start + 1, one.end - 1}, arena);
      out->accepts |= TYPE(TEXT);
    } else {
      const size_t k = find_words(one);
      any |= k == KNOWN_COUNT;
      if (k == KNOWN_COUNT) continue;
      out->accepts |= known[k].accepts;
      if (count == 1) out->kind = known[k].kind;
    }
    p.start = one.end + strlen(or);
  }
  if (texts == count) {
    out->kind = CAG_BIND_CHOICE;
    out->choices = choices;
  }
  // `none` is always accepted: many parameters have it for "not given".
  out->accepts = any ? 0 : out->accepts | TYPE(NONE);
}

// --- Parameters ---

// --- Fields of the structure of cag_bind ---

static void add_field(CagSignature *s, CagParameterType *type) {
  static const struct {
    size_t size, align;
  } fields[] = {
// clang-format off
#define FIELD(kind, type) [CAG_BIND_##kind] = {sizeof(type), _Alignof(type)},
      FIELD(VALUE, CagValue) FIELD(NUMBER, double) FIELD(FINITE, double) FIELD(INTEGER, long)
      FIELD(ANGLE, double) FIELD(BOOL, bool) FIELD(TEXT, char *) FIELD(CHOICE, int)
      FIELD(POINT, CagPoint) FIELD(DIRECTION, CagPoint) FIELD(POINTS, CagPoints)
      FIELD(NUMBERS, CagNumbers) FIELD(RANGE, CagRangeEnds) FIELD(LIST, CagList *)
      FIELD(RECORD, CagRecord *) FIELD(FUNCTION, CagValue) FIELD(TRANSFORM, CagTransform)
      FIELD(PLANE, CagPlane) FIELD(CURVE, CagCurve *) FIELD(SURFACE, CagSurface *)
      FIELD(SOLID, CagSolid *) FIELD(MESH, CagMesh *) FIELD(ROBOT, CagRobot *)
// clang-format on
#undef FIELD
  };
  const size_t align = fields[type->kind].align;
  type->offset = (s->size + align - 1) / align * align;
  s->size = type->offset + fields[type->kind].size;
}

// --- Defaults ---

#define RADIANS_PER_DEGREE 0.017453292519943295

// A number or angle, in degrees.
static double parse_number(const char *text, const char **end) {
  char *after;
  const double x = strncmp(text, "inf", 3) == 0 ? HUGE_VAL : strtod(text, &after);
  *end = isinf(x) ? text + 3 : after;
  // Of "0..1", strtod reads "0.".
  if (!isinf(x) && after > text && after[-1] == '.' && *after == '.') --*end;
  if (strncmp(*end, "deg", 3) == 0) *end += 3;
  return x;
}

static void parse_point(CagParameterType *out, const char *text) {
  static const struct {
    const char *name;
    double at[3];
  } names[] = {{"X", {1, 0, 0}}, {"Y", {0, 1, 0}}, {"Z", {0, 0, 1}}, {"origin", {0, 0, 0}}};
  out->dimension = 3;
  for (size_t i = 0; i < sizeof names / sizeof *names; i++)
    if (strcmp(text, names[i].name) == 0) memcpy(out->fallback, names[i].at, sizeof names[i].at);
  if (*text != '[') return;
  for (out->dimension = 0; *text != ']' && out->dimension < 3; out->dimension++)
    out->fallback[out->dimension] = parse_number(text + 1, &text);
}

static void parse_default(CagSignature *s, CagParameterType *out, const char *text) {
  const char *end;
  for (size_t i = 0; i + 1 < s->count; i++)
    if (strcmp(s->parameters[i], text) == 0 && s->types[i].kind == out->kind) {
      out->same_as_set = true;
      out->same_as = i;
    }
  switch (out->kind) {
  case CAG_BIND_NUMBER:
  case CAG_BIND_FINITE:
  case CAG_BIND_INTEGER: out->fallback[0] = parse_number(text, &end); break;
  case CAG_BIND_ANGLE: out->fallback[0] = parse_number(text, &end) * RADIANS_PER_DEGREE; break;
  case CAG_BIND_BOOL: out->fallback[0] = strcmp(text, "true") == 0; break;
  case CAG_BIND_CHOICE:
    for (size_t i = 0; out->choices[i]; i++)
      if (*text == '"' && strncmp(text + 1, out->choices[i], strlen(out->choices[i])) == 0 &&
          text[1 + strlen(out->choices[i])] == '"')
        out->fallback[0] = (double)i;
    break;
  case CAG_BIND_POINT:
  case CAG_BIND_DIRECTION: parse_point(out, text); break;
  case CAG_BIND_RANGE:
    out->fallback[0] = parse_number(text, &end);
    if (strncmp(end, "..", 2) == 0) out->fallback[1] = parse_number(end + 2, &end);
    out->dimension = strstr(text, "deg") != NULL;
    break;
  default: break;
  }
}

static void parse_parameter(CagSignature *out, Part p, CagArena *arena) {
  if (part_length(p) == 3 && strncmp(p.start, "...", 3) == 0) {
    out->variadic = true;
    return;
  }
  const Part head = {p.start, find_outside(p, " = ")};
  const char *colon = find_outside(head, ":");
  const Part name = trimmed((Part){p.start, colon});
  const Part type = trimmed((Part){colon < head.end ? colon + 1 : colon, head.end});
  const size_t i = out->count++;
  out->parameters[i] = part_text(name, arena);
  out->words[i] = part_text(type, arena);
  parse_type(&out->types[i], type, arena);
  out->positional_only[i] = part_length(name) == 1 && *name.start >= 'A' && *name.start <= 'Z';
  add_field(out, &out->types[i]);
  if (head.end == p.end) {
    out->required = i + 1;
    return;
  }
  const char *fallback = part_text(trimmed((Part){head.end + strlen(" = "), p.end}), arena);
  out->defaults[i] = fallback;
  parse_default(out, &out->types[i], fallback);
}

// The signature as documentation and messages show it.
static const char *plain_text(const CagSignature *s, size_t most, CagArena *arena) {
  char *text = cag_arena_alloc(arena, most + 1), *to = text;
  to = stpcpy(to, s->name);
  to = stpcpy(to, "(");
  for (size_t i = 0; i < s->count; i++) {
    if (i) to = stpcpy(to, ", ");
    to = stpcpy(to, s->parameters[i]);
    if (s->defaults[i]) to = stpcpy(stpcpy(to, " = "), s->defaults[i]);
  }
  if (s->variadic) to = stpcpy(to, s->count ? ", ..." : "...");
  stpcpy(to, ")");
  return text;
}

void cag_signature_parse(CagSignature *out, const char *text, CagArena *arena) {
  const char *open = strchr(text, '(');
  *out = (CagSignature){.name = text, .text = text};
  if (!open) return;
  out->name = part_text((Part){text, open}, arena);
  // No signature has more parameters than commas, and one.
  size_t most = 1;
  for (const char *s = open; *s; s++) most += *s == ',';
  out->parameters = cag_arena_alloc(arena, most * sizeof *out->parameters);
  out->words = cag_arena_alloc(arena, most * sizeof *out->words);
  out->types = cag_arena_alloc(arena, most * sizeof *out->types);
  out->defaults = cag_arena_alloc(arena, most * sizeof *out->defaults);
  out->positional_only = cag_arena_alloc(arena, most * sizeof *out->positional_only);
  Part rest = trimmed((Part){open + 1, strrchr(text, ')')});
  while (rest.start < rest.end) {
    const char *comma = find_outside(rest, ",");
    parse_parameter(out, trimmed((Part){rest.start, comma}), arena);
    rest.start = comma < rest.end ? comma + 1 : comma;
  }
  out->text = plain_text(out, strlen(text), arena);
}
