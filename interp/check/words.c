// What parameters of built-ins take, by the words of their documentation
// (interp/doc/parameters.def).
//
// The words are made for people, so only what they surely rule out is ruled out: of "list of
// points" that a number, an angle or a truth would do, but not that a curve would. Words that are
// not in the table rule out nothing. `none` is always taken: many parameters have it as "not
// given".

#include <string.h>

#include "interp/check/types.h"

#define SCALARS (CAG_TYPES(NUMBER) | CAG_TYPES(ANGLE) | CAG_TYPES(BOOL))
#define WORDS (SCALARS | CAG_TYPES(TEXT))
#define ALL_BUT(types) (CAG_TYPES_ANY & ~(types))
#define NUMBERS (CAG_TYPES(NUMBER) | CAG_TYPES(JET))
#define ANGLES (CAG_TYPES(ANGLE) | CAG_TYPES(JET))
#define RANGES (CAG_TYPES(RANGE) | CAG_TYPES(LIST))

// The head of a parameter's words, up to a comma (behind it stand units), and what it takes.
static const struct {
  const char *words;
  CagTypes types;
} table[] = {
    {"number", NUMBERS},
    {"whole number", NUMBERS},
    {"number in 0..1", NUMBERS},
    {"1 or 2", NUMBERS},
    {"0 or 1", NUMBERS},
    {"1 or -1", NUMBERS},
    {"angle", ANGLES},
    {"number or angle", NUMBERS | ANGLES},
    {"angle or number", NUMBERS | ANGLES},
    {"bool", CAG_TYPES(BOOL)},
    {"text", CAG_TYPES(TEXT)},
    {"range", RANGES},
    {"range of numbers", RANGES},
    {"range of angles", RANGES},
    {"range of numbers or angles", RANGES},
    {"transform", ALL_BUT(WORDS)},
    {"point", ALL_BUT(SCALARS)},
    {"vector", ALL_BUT(SCALARS)},
    {"vector or point", ALL_BUT(SCALARS)},
    {"transform or point", ALL_BUT(WORDS)},
    {"plane", ALL_BUT(WORDS)},
    {"record", ALL_BUT(WORDS)},
    {"material record", ALL_BUT(WORDS)},
    {"robot", CAG_TYPES(ROBOT)},
    {"mesh", ALL_BUT(WORDS)},
    {"curve", ALL_BUT(WORDS | CAG_TYPES(SURFACE) | CAG_TYPES(SOLID) | CAG_TYPES(MESH))},
    {"surface", ALL_BUT(WORDS | CAG_TYPES(CURVE))},
    {"region", ALL_BUT(WORDS | CAG_TYPES(SURFACE) | CAG_TYPES(SOLID) | CAG_TYPES(MESH))},
    {"shape", ALL_BUT(WORDS)},
    {"shape or group", ALL_BUT(WORDS)},
    {"curve or region", ALL_BUT(WORDS)},
    {"function", ALL_BUT(WORDS)},
    {"list or text", CAG_TYPES(LIST) | CAG_TYPES(RANGE) | CAG_TYPES(TEXT)},
    {"list or range", ALL_BUT(WORDS)},
    {"color", ALL_BUT(SCALARS)},
};

// "list of points, mm" and "function x => number": what these begin with is enough to tell, unless
// something else would do as well.
static const struct {
  const char *head;
  CagTypes types;
} heads[] = {{"list of ", ALL_BUT(SCALARS)}, {"function ", ALL_BUT(WORDS)}};

// Words with their commas.
static const struct {
  const char *words;
  CagTypes types;
} whole[] = {
    {"angle, or point", ANGLES | RANGES},
    {"vector, or angle", ALL_BUT(CAG_TYPES(NUMBER) | CAG_TYPES(BOOL))},
    {"list, range or text", RANGES | CAG_TYPES(TEXT)},
    {"list, range, text or record", RANGES | CAG_TYPES(TEXT) | CAG_TYPES(RECORD)},
};

CagTypes cag_types_of_words(const char *words) {
  for (size_t i = 0; i < sizeof whole / sizeof *whole; i++)
    if (strcmp(whole[i].words, words) == 0) return whole[i].types | CAG_TYPES(NONE);
  const char *comma = strchr(words, ',');
  const size_t n = comma ? (size_t)(comma - words) : strlen(words);
  // Behind a comma stand units and bounds ("1 or more"), or what would do as well.
  const char * or = comma ? strstr(comma, " or ") : NULL;
  if (or &&strncmp(or, " or more", 8) != 0) return CAG_TYPES_ANY;
  for (size_t i = 0; i < sizeof table / sizeof *table; i++)
    if (strlen(table[i].words) == n && strncmp(table[i].words, words, n) == 0)
      return table[i].types | CAG_TYPES(NONE);
  for (size_t i = 0; i < sizeof heads / sizeof *heads; i++)
    if (strncmp(words, heads[i].head, strlen(heads[i].head)) == 0 && !strstr(words, " or "))
      return heads[i].types | CAG_TYPES(NONE);
  return CAG_TYPES_ANY;
}
