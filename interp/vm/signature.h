// Signatures of built-ins.
//
//     signature = name [ "(" parameter { "," parameter } [ "," "..." ] ")" ]
//     parameter = name ":" type [ " = " default ]
//     type      = alternative { " or " alternative } [ range ]
//     range     = "> a" | ">= a" | "in a..b"
//
// An alternative is a quoted text, which is a possible value of the argument, or words from
// parameter_types.def. Other words are for the reader and accept any value. Text in brackets
// belongs to the words: "function (u, v) => point", "record {point, direction}".
//
// The type determines how an argument is read, and which types `cag check` accepts.
// Documentation and messages show it as written.

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
  uint64_t accepts; // types that are accepted, as bits (1 << CAG_NUMBER ...); 0: any
  double low, high; // of numbers and integers
  bool above_low;   // low itself is excluded
  bool ranged;
  const char *const *choices; // of CHOICE; ends with NULL
  size_t offset, size;        // of its field in the structure of arguments
  // The value if no argument is given, parsed from the default: radians, the index of a text,
  // coordinates, or the ends of a range. It is 0 if the function itself supplies the default.
  double fallback[3];
  const char *fallback_text; // of a text; NULL: the function supplies it
  int dimension;             // of a point
  bool same_as_set;          // the default is the value of an earlier parameter
  size_t same_as;
} CagParameterType;

// Types of fields that hold several numbers.
typedef struct CagPoint {
  CagVec3 at; // z = 0 in the plane
  int dimension;
} CagPoint;
typedef struct CagPoints {
  CagVec3 *items; // held by the call
  size_t count;
  int dimension; // the highest of all points
} CagPoints;
typedef struct CagNumbers {
  const double *items; // valid as long as the argument
  size_t count;
} CagNumbers;
typedef struct CagRangeEnds {
  double start, end; // degrees if `angle`
  bool angle;
} CagRangeEnds;

typedef struct CagParameterTypes {
  size_t size; // of the structure of arguments
  CagParameterType items[];
} CagParameterTypes;

typedef struct CagSignature {
  const char *name;
  const char *text;          // without types: "cone(height, radius, centered = false)"
  size_t count;              // number of parameters, without `...`
  size_t required;           // parameters without a default, which come first
  const char **parameters;   // names
  const char **words;        // types as written: "length > 0"
  const char **defaults;     // text of the default, NULL if there is none
  bool *none_is_unset;       // the default is none, so that giving none has the same effect as
                             // giving nothing
  bool *positional_only;     // named with a single capital: by position only
  bool variadic;             // `...`: any number of further arguments by position
  CagParameterTypes *parsed; // see cag_signature_types
} CagSignature;

// Parses a signature. The result is allocated in the arena. Leaves the guard if memory runs out.
void cag_signature_parse(CagSignature *out, const char *text, CagArena *arena);
// Returns the types of the parameters, which are parsed on first use and never freed. Thread-safe.
// Leaves the guard if memory runs out.
const CagParameterTypes *cag_signature_types(const CagSignature *s);

#endif
