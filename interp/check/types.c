// Sets of types: results and arguments of built-ins, and operators.

#include "interp/check/types.h"

#include <stdio.h>
#include <string.h>

#define SHAPES                                                                                     \
  (CAG_TYPES(CURVE) | CAG_TYPES(REGION) | CAG_TYPES(SURFACE) | CAG_TYPES(SOLID) |                  \
   CAG_TYPES(MESH) | CAG_TYPES(LABEL) | CAG_TYPES(GROUP))
// Types whose operators are all in the table below. Nothing is assumed about other types.
#define PLAIN                                                                                      \
  (CAG_TYPES(NONE) | CAG_TYPES(BOOL) | CAG_TYPES(NUMBER) | CAG_TYPES(ANGLE) | CAG_TYPES(TEXT) |    \
   CAG_TYPES(LIST) | CAG_TYPES(RANGE) | CAG_TYPES(RECORD) | CAG_TYPES_FUNCTION)
#define LISTS (CAG_TYPES(LIST) | CAG_TYPES(RANGE))
#define NUMBERS CAG_TYPES(NUMBER)

// --- Results ---

static const struct {
  const char *word;
  CagTypes types;
} words[] = {
    {"number", NUMBERS},
    {"angle", CAG_TYPES(ANGLE)},
    {"list", CAG_TYPES(LIST)},
    {"record", CAG_TYPES(RECORD)},
    {"bool", CAG_TYPES(BOOL)},
    {"text", CAG_TYPES(TEXT)},
    {"none", CAG_TYPES(NONE)},
    {"range", CAG_TYPES(RANGE)},
    {"function", CAG_TYPES_FUNCTION},
    {"transform", CAG_TYPES(TRANSFORM)},
    {"curve", CAG_TYPES(CURVE)},
    {"region", CAG_TYPES(REGION)},
    {"surface", CAG_TYPES(SURFACE)},
    {"solid", CAG_TYPES(SOLID)},
    {"mesh", CAG_TYPES(MESH)},
    {"label", CAG_TYPES(LABEL)},
    {"group", CAG_TYPES(GROUP)},
    {"shape", SHAPES},
    {"plane", CAG_TYPES(PLANE)},
    {"link", CAG_TYPES(LINK)},
    {"robot", CAG_TYPES(ROBOT)},
};

static CagTypes word_types(const char *word, size_t length) {
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    if (strlen(words[i].word) == length && strncmp(words[i].word, word, length) == 0)
      return words[i].types;
  if (length == 2 && strncmp(word, "or", 2) == 0) return 0;
  return CAG_TYPES_ANY;
}

CagTypes cag_types_of_result(const char *result) {
  CagTypes types = 0;
  for (const char *p = result; p && *p;) {
    const size_t n = strcspn(p, " ,");
    if (n) types |= word_types(p, n);
    p += n;
    p += strspn(p, " ,");
  }
  return types ? types : CAG_TYPES_ANY;
}

// --- Arguments ---

CagTypes cag_types_taken(const CagBuiltin *row, const CagSignature *s, size_t parameter) {
  if (parameter == 0 && row->first) return row->first;
  if (s->variadic && parameter >= s->count) parameter = 0; // further arguments are like the first
  if (parameter >= s->count) return CAG_TYPES_ANY;
  const CagTypes accepted = cag_signature_types(s)->items[parameter].accepts;
  if (!accepted) return CAG_TYPES_ANY;
  // A list can be given instead of several values.
  if (s->variadic) return accepted | LISTS;
  return parameter < s->required ? accepted & ~CAG_TYPES(NONE) : accepted;
}

// --- Operators ---

static const struct {
  CagBinaryOp op;
  CagTypes left, right, result;
} joined[] = {
    {CAG_OP_ADD, NUMBERS, NUMBERS, NUMBERS},
    {CAG_OP_ADD, CAG_TYPES(ANGLE), CAG_TYPES(ANGLE), CAG_TYPES(ANGLE)},
    {CAG_OP_ADD, CAG_TYPES(TEXT), CAG_TYPES(TEXT), CAG_TYPES(TEXT)},
    {CAG_OP_ADD, LISTS, LISTS, CAG_TYPES(LIST)},
    {CAG_OP_SUBTRACT, NUMBERS, NUMBERS, NUMBERS},
    {CAG_OP_SUBTRACT, CAG_TYPES(ANGLE), CAG_TYPES(ANGLE), CAG_TYPES(ANGLE)},
    {CAG_OP_SUBTRACT, LISTS, LISTS, CAG_TYPES(LIST)},
    {CAG_OP_MULTIPLY, NUMBERS, NUMBERS, NUMBERS},
    {CAG_OP_MULTIPLY, CAG_TYPES(ANGLE), NUMBERS, CAG_TYPES(ANGLE)},
    {CAG_OP_MULTIPLY, NUMBERS, CAG_TYPES(ANGLE), CAG_TYPES(ANGLE)},
    {CAG_OP_MULTIPLY, LISTS, NUMBERS | CAG_TYPES(ANGLE), CAG_TYPES(LIST)},
    {CAG_OP_MULTIPLY, NUMBERS | CAG_TYPES(ANGLE), LISTS, CAG_TYPES(LIST)},
    {CAG_OP_DIVIDE, NUMBERS, NUMBERS, NUMBERS},
    {CAG_OP_DIVIDE, CAG_TYPES(ANGLE), NUMBERS, CAG_TYPES(ANGLE)},
    {CAG_OP_DIVIDE, CAG_TYPES(ANGLE), CAG_TYPES(ANGLE), NUMBERS},
    {CAG_OP_DIVIDE, LISTS, NUMBERS | CAG_TYPES(ANGLE), CAG_TYPES(LIST)},
    {CAG_OP_MODULO, NUMBERS, NUMBERS, NUMBERS},
    {CAG_OP_MODULO, CAG_TYPES(ANGLE), CAG_TYPES(ANGLE), CAG_TYPES(ANGLE)},
    {CAG_OP_POWER, NUMBERS, NUMBERS, NUMBERS},
    {CAG_OP_LESS, NUMBERS, NUMBERS, CAG_TYPES(BOOL)},
    {CAG_OP_LESS, CAG_TYPES(ANGLE), CAG_TYPES(ANGLE), CAG_TYPES(BOOL)},
    {CAG_OP_LESS, CAG_TYPES(TEXT), CAG_TYPES(TEXT), CAG_TYPES(BOOL)},
};

CagTypes cag_types_joined(CagBinaryOp op, CagTypes left, CagTypes right) {
  CagTypes result = 0;
  switch (op) {
  case CAG_OP_EQUAL:
  case CAG_OP_NOT_EQUAL: return CAG_TYPES(BOOL);
  case CAG_OP_IN: return right & CAG_TYPES_LOOPED ? CAG_TYPES(BOOL) : 0;
  case CAG_OP_UNION:
  case CAG_OP_INTERSECTION:
    if (!(left & ~PLAIN) && !(left & LISTS)) return 0;
    if (!(right & ~PLAIN) && !(right & LISTS)) return 0;
    break;
  case CAG_OP_LESS_EQUAL:
  case CAG_OP_GREATER:
  case CAG_OP_GREATER_EQUAL: op = CAG_OP_LESS; break;
  default: break;
  }
  // Types outside of the table may support any operator.
  if ((left | right) & ~PLAIN) result = op == CAG_OP_LESS ? CAG_TYPES(BOOL) : CAG_TYPES_ANY;
  for (size_t i = 0; i < sizeof joined / sizeof *joined; i++)
    if (joined[i].op == op && left & joined[i].left && right & joined[i].right)
      result |= joined[i].result;
  return result;
}

// --- Names ---

const char *cag_types_text(CagTypes types, char *buffer, size_t size) {
  static const char *const articles[] = {
#define X(tag, name, article) article,
      CAG_VALUE_TYPES(X)
#undef X
  };
  size_t left = 0, n = 0;
  types &= ~CAG_TYPES(JET);
  if (types & CAG_TYPES(CLOSURE)) types &= ~CAG_TYPES(BUILTIN);
  for (size_t i = 0; i < CAG_TYPE_COUNT; i++) left += types >> i & 1;
  if (left > 6) {
    snprintf(buffer, size, "another type");
    return buffer;
  }
  buffer[0] = 0;
  for (size_t i = 0; i < CAG_TYPE_COUNT && n < size; i++) {
    if (!(types >> i & 1)) continue;
    const char *between = n == 0 ? "" : left == 1 ? " or " : ", ";
    n += (size_t)snprintf(buffer + n, size - n, "%s%s", between, articles[i]);
    left--;
  }
  return buffer;
}
