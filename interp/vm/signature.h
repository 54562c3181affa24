// Signatures of built-ins.
//
//     signature = name [ "(" parameter { "," parameter } [ "," "..." ] ")" ]
//     parameter = name ":" type [ " = " default ]
//     type      = alternative { " or " alternative } [ range ]
//     range     = "> a" | ">= a" | "in a..b"
//
// An alternative is a text in quotes, which the argument may be, or words of parameter_types.def.
// Other words are for the reader, and accept any value. Text within brackets belongs to the words:
// "function (u, v) => point", "record {point, direction}".
//
// The type says how cag_bind reads an argument, and which types `cag check` accepts. Documentation
// and messages show it as it is written.

#ifndef CAG_INTERP_VM_SIGNATURE_H
#define CAG_INTERP_VM_SIGNATURE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/arena.h"
#include "geom/linalg/transform.h"

// How an argument is read: see parameter_kinds.def.
typedef enum CagParameterKind {
#define CAG_PARAMETER_KIND(kind, type) CAG_BIND_##kind,
#include "interp/vm/parameter_kinds.def"
#undef CAG_PARAMETER_KIND
} CagParameterKind;

typedef struct CagParameterType {
  CagParameterKind kind;
  uint64_t accepts; // types that may be right, as bits (1 << CAG_NUMBER ...); 0: any
  double low, high; // of numbers and integers
  bool above_low;   // low itself is out of range
  bool ranged;
  const char *const *choices; // of CHOICE; ends with NULL
  size_t offset;              // of its field in the structure of cag_bind
  // The value if no argument is given, from the text of the default: radians, the index of a text,
  // coordinates, or the ends of a range. It is 0 for defaults that the function itself supplies.
  double fallback[3];
  const char *fallback_text; // of a text; NULL: the function supplies it
  int dimension;             // of a point
  bool same_as_set;          // the default is the value of an earlier parameter
  size_t same_as;
} CagParameterType;

// Fields of several numbers.
typedef struct CagPoint {
  CagVec3 at; // z = 0 in the plane
  int dimension;
} CagPoint;
typedef struct CagPoints {
  CagVec3 *items; // held by the call
  size_t count;
  int dimension; // the highest
} CagPoints;
typedef struct CagNumbers {
  const double *items; // live as long as the argument
  size_t count;
} CagNumbers;
typedef struct CagRangeEnds {
  double start, end; // degrees if `angle`
  bool angle;
} CagRangeEnds;

typedef struct CagParameterTypes {
  size_t size; // of the structure of cag_bind
  CagParameterType items[];
} CagParameterTypes;

typedef struct CagSignature {
  const char *name;
  const char *text;          // without types: "cone(height, radius, centered = false)"
  size_t count;              // parameters; `...` is not one of them
  size_t required;           // parameters without default; they come first
  const char **parameters;   // names
  const char **words;        // types as written: "length > 0"
  const char **defaults;     // the default's text, NULL where there is none
  bool *none_is_unset;       // the default is none: giving none is like giving nothing
  bool *positional_only;     // a single capital: by position only
  bool variadic;             // `...`: any number of further arguments by position
  CagParameterTypes *parsed; // see cag_signature_types
} CagSignature;

// Parses a signature. All that it points to is in the arena. Leaves the guard if memory runs out.
void cag_signature_parse(CagSignature *out, const char *text, CagArena *arena);
// The types of the parameters, parsed when they are first asked for and never freed. Several
// threads may call this. Leaves the guard if memory runs out.
const CagParameterTypes *cag_signature_types(const CagSignature *s);

#endif
