// Parsing of the signatures of built-ins.

#include "interp/vm/signature.h"

#include <math.h>
#include <stddef.h>
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
  size_t length;
  CagParameterKind kind;
  uint64_t accepts;
} known[] = {
#define CAG_PARAMETER_TYPE(words, kind, accepts)                                                   \
  {words, sizeof words - 1, CAG_BIND_##kind, accepts},
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
  if (p.start >= p.end || !memmem(p.start, part_length(p), what, n)) return p.end;
  for (const char *s = p.start; s + n <= p.end; s++) {
    if (*s == *what && !quoted && depth == 0 && memcmp(s, what, n) == 0) return s;
    if (*s == '"') quoted = !quoted;
    if (quoted) continue;
    if (*s == '(' || *s == '[' || *s == '{') depth++;
    else if (*s == ')' || *s == ']' || *s == '}') depth--;
  }
  return p.end;
}

// Returns the longest known words with which the alternative starts, or KNOWN_COUNT.
static size_t find_words(Part p) {
  size_t best = KNOWN_COUNT, length = 0;
  for (size_t i = 0; i < KNOWN_COUNT; i++) {
    const size_t n = known[i].length;
    if (*known[i].words != *p.start || n <= length || n > part_length(p)) continue;
    if (memcmp(p.start, known[i].words, n) != 0) continue;
    if (n < part_length(p) && p.start[n] != ' ') continue;
    best = i;
    length = n;
  }
  return best;
}

// Parses a range such as " > 0", starting with its space.
static void parse_range(CagParameterType *out, const char *range) {
  const bool within = strncmp(range, " in ", 4) == 0;
  out->ranged = true;
  out->above_low = !within && range[2] != '=';
  out->low = strtod(range + (within ? 4 : out->above_low ? 2 : 3), NULL);
  // strtod reads "1." from "1..5".
  const char *dots = within ? strstr(range, "..") : NULL;
  out->high = dots ? strtod(dots + 2, NULL) : HUGE_VAL;
}

// Memory for the data of types, after the types themselves.
typedef struct Room {
  char *at;
} Room;

static void *room_for(Room *r, size_t size) {
  const size_t align = _Alignof(max_align_t);
  char *taken = r->at;
  r->at += (size + align - 1) / align * align;
  return taken;
}

static char *copy_to_room(Part p, Room *room) {
  char *text = room_for(room, part_length(p) + 1);
  memcpy(text, p.start, part_length(p));
  text[part_length(p)] = 0;
  return text;
}

// Finds the range at the end of a type, and counts its alternatives.
static size_t scan_type(Part p, const char **range) {
  int depth = 0;
  bool quoted = false;
  size_t alternatives = 1;
  *range = NULL;
  for (const char *s = p.start; s < p.end; s++) {
    if (*s == '"') quoted = !quoted;
    if (quoted) continue;
    if (*s == '(' || *s == '[' || *s == '{') depth++;
    else if (*s == ')' || *s == ']' || *s == '}') depth--;
    if (depth > 0 || *s != ' ') continue;
    if (strncmp(s, " or ", 4) == 0) alternatives++;
    else if (s[1] == '>' || strncmp(s, " in ", 4) == 0) *range = s;
  }
  return alternatives;
}

static void parse_type(CagParameterType *out, const char *words, Room *room) {
  static const char or [] = " or ";
  Part p = {words, words + strlen(words)};
  const char *range;
  const size_t count = scan_type(p, &range);
  size_t texts = 0;
  *out = (CagParameterType){.low = -HUGE_VAL, .high = HUGE_VAL};
  if (range) {
    parse_range(out, range);
    p.end = range;
  }
  const char **choices = NULL; // most types have none
  if (strchr(words, '"')) choices = room_for(room, (count + 1) * sizeof *choices);
  bool any = false;
  for (size_t i = 0; i < count; i++) {
    const Part one = {p.start, i + 1 < count ? find_outside(p, or) : p.end};
    if (choices && *one.start == '"') {
      choices[texts++] = copy_to_room((Part){one.start + 1, one.end - 1}, room);
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
  if (choices) choices[texts] = NULL;
  if (texts == count) {
    out->kind = CAG_BIND_CHOICE;
    out->choices = choices;
  }
  // `none` is always accepted, because it means "not given" for many parameters.
  out->accepts = any ? 0 : out->accepts | TYPE(NONE);
}

// --- Parameters ---

// --- Fields of the structure of arguments ---

static void add_field(CagParameterTypes *types, CagParameterType *type) {
  static const struct {
    size_t size, align;
  } fields[] = {
#define CAG_PARAMETER_KIND(kind, type) [CAG_BIND_##kind] = {sizeof(type), _Alignof(type)},
#include "interp/vm/parameter_kinds.def"
#undef CAG_PARAMETER_KIND
  };
  const size_t align = fields[type->kind].align;
  type->offset = (types->size + align - 1) / align * align;
  type->size = fields[type->kind].size;
  types->size = type->offset + type->size;
}

// --- Defaults ---

#define RADIANS_PER_DEGREE 0.017453292519943295

// A number or angle, in degrees.
static double parse_number(const char *text, const char **end) {
  const bool infinite = strncmp(text, "inf", 3) == 0;
  char *after = NULL;
  const double x = infinite ? HUGE_VAL : strtod(text, &after);
  *end = infinite ? text + 3 : after;
  // strtod reads "0." from "0..1".
  if (!infinite && after > text && after[-1] == '.' && *after == '.') --*end;
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

static void parse_default(const CagSignature *s, const CagParameterTypes *types,
                          CagParameterType *out, const char *text) {
  const char *end;
  for (size_t i = 0; &types->items[i] < out; i++)
    if (strcmp(s->parameters[i], text) == 0 && types->items[i].kind == out->kind) {
      out->same_as_set = true;
      out->same_as = i;
    }
  switch (out->kind) {
  case CAG_BIND_NUMBER:
  case CAG_BIND_FINITE:
  case CAG_BIND_INTEGER: out->fallback[0] = parse_number(text, &end); break;
  case CAG_BIND_ANGLE: out->fallback[0] = parse_number(text, &end) * RADIANS_PER_DEGREE; break;
  case CAG_BIND_TEXT:
    if (strcmp(text, "\"\"") == 0) out->fallback_text = "";
    break;
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

// --- Parameters ---

// The parts of a parameter, empty if missing.
typedef struct Pieces {
  Part name, type, fallback;
} Pieces;

// Finds the parts of the parameter that starts at `s`. Returns its end: a comma, or `end`.
static const char *scan_parameter(const char *s, const char *end, Pieces *out) {
  int depth = 0;
  bool quoted = false;
  *out = (Pieces){.name = {s, NULL}};
  for (; s < end; s++) {
    if (*s == '"') quoted = !quoted;
    if (quoted) continue;
    if (*s == '(' || *s == '[' || *s == '{') depth++;
    else if (*s == ')' || *s == ']' || *s == '}') depth--;
    if (depth > 0) continue;
    if (*s == ',') break;
    if (*s == ':' && !out->type.start) {
      out->name.end = s;
      out->type.start = s + 1;
    }
    if (*s != ' ' || out->fallback.start || s[1] != '=' || s[2] != ' ') continue;
    out->type.end = s;
    out->fallback.start = s + 3;
  }
  if (out->fallback.start) out->fallback.end = s;
  else out->type.end = s;
  if (!out->type.start) out->type.start = out->name.end = out->type.end;
  return s;
}

// Terminates a part of the copied text by overwriting the separator after it.
static const char *ended(Part p) {
  p = trimmed(p);
  *(char *)p.end = 0;
  return p.start;
}

static void add_parameter(CagSignature *out, const Pieces *pieces) {
  if (strncmp(pieces->name.start, "...", 3) == 0) {
    out->variadic = true;
    return;
  }
  const size_t i = out->count++;
  out->words[i] = ended(pieces->type);
  const char *name = out->parameters[i] = ended(pieces->name);
  out->positional_only[i] = name[1] == 0 && name[0] >= 'A' && name[0] <= 'Z';
  if (pieces->fallback.start) out->defaults[i] = ended(pieces->fallback);
  else out->required = i + 1;
  out->none_is_unset[i] = out->defaults[i] && strcmp(out->defaults[i], "none") == 0 &&
                          strcmp(out->words[i], "any value") != 0;
}

// Returns the size of the types of a signature and their data.
static size_t types_size(const CagSignature *s) {
  size_t size = sizeof(CagParameterTypes) + s->count * sizeof(CagParameterType);
  for (size_t i = 0; i < s->count; i++) {
    const size_t n = strlen(s->words[i]); // each alternative has at least 4 bytes
    size += n + (n / 4 + 2) * (sizeof(char *) + 2 * _Alignof(max_align_t));
  }
  return size + _Alignof(max_align_t);
}

const CagParameterTypes *cag_signature_types(const CagSignature *signature) {
  CagSignature *s = (CagSignature *)signature;
  CagParameterTypes *types = __atomic_load_n(&s->parsed, __ATOMIC_ACQUIRE), *none = NULL;
  if (types) return types;
  // They outlive the run, so no account is charged.
  types = cag_checked(calloc(1, types_size(s)));
  Room room = {(char *)types};
  room_for(&room, sizeof *types + s->count * sizeof *types->items);
  for (size_t i = 0; i < s->count; i++) {
    CagParameterType *type = &types->items[i];
    parse_type(type, s->words[i], &room);
    add_field(types, type);
    if (s->defaults[i]) parse_default(s, types, type, s->defaults[i]);
  }
  if (__atomic_compare_exchange_n(&s->parsed, &none, types, false, __ATOMIC_ACQ_REL,
                                  __ATOMIC_ACQUIRE))
    return types;
  free(types); // another thread was faster
  return none;
}

// Formats the signature for documentation and messages.
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
  const char *start = strchr(text, '(');
  *out = (CagSignature){.name = text, .text = text};
  if (!start) return;
  // The parts are pieces of one copy.
  char *copy = part_text((Part){text, text + strlen(text)}, arena);
  char *open = copy + (start - text);
  *open = 0;
  out->name = copy;
  // A signature has at most one parameter more than commas.
  size_t most = 1;
  for (const char *s = start; *s; s++) most += *s == ',';
  out->parameters = cag_arena_alloc(arena, most * sizeof *out->parameters);
  out->words = cag_arena_alloc(arena, most * sizeof *out->words);
  out->defaults = cag_arena_alloc(arena, most * sizeof *out->defaults);
  out->none_is_unset = cag_arena_alloc(arena, most * sizeof *out->none_is_unset);
  out->positional_only = cag_arena_alloc(arena, most * sizeof *out->positional_only);
  const char *end = strrchr(open + 1, ')');
  for (const char *s = open + 1; s < end; s++) {
    while (*s == ' ' || *s == '\n') s++;
    Pieces pieces;
    s = scan_parameter(s, end, &pieces);
    add_parameter(out, &pieces);
  }
  out->text = plain_text(out, strlen(text), arena);
}
