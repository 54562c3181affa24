// Writing and reading the fields of messages (protocol.h).

#ifndef CAG_INTERP_KERNEL_FIELDS_H
#define CAG_INTERP_KERNEL_FIELDS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "geom/linalg/transform.h"

// A message under construction. If memory runs out, `failed` is set and nothing is added any more.
typedef struct CagFields {
  unsigned char *bytes;
  size_t length, room;
  bool failed;
  double tolerance; // mm: for surfaces and curves without an exact form; 0: they fail
  bool approximate; // the tolerance was used
  int turn;         // which of the equal forms of round primitives is put: their seams and poles
                    // differ
} CagFields;

// The number of these forms.
#define CAG_TURNS 4

void cag_fields_free(CagFields *f);
void cag_put_bytes(CagFields *f, const void *bytes, size_t n); // without a length
void cag_put_u32(CagFields *f, size_t x);                      // sets `failed` if x does not fit
void cag_put_f64(CagFields *f, double x);
void cag_put_vec(CagFields *f, CagVec3 p);
void cag_put_plane_point(CagFields *f, CagVec3 p);       // x and y
void cag_put_frame(CagFields *f, const CagTransform *t); // origin, x, y, z
void cag_put_placement(CagFields *f, const CagTransform *t);

// A message that is read. Fields beyond its end are 0 and set `bad`.
typedef struct CagFieldReader {
  const unsigned char *at, *end;
  bool bad;
} CagFieldReader;

uint32_t cag_take_u32(CagFieldReader *r);
double cag_take_f64(CagFieldReader *r); // a number that is not finite sets `bad`
CagVec3 cag_take_vec(CagFieldReader *r);
// The number of items that follow, each of at least `least` bytes; more than fit set `bad`.
size_t cag_take_count(CagFieldReader *r, size_t least);
// The bytes of a text or of bytes, without a final zero.
const unsigned char *cag_take_bytes(CagFieldReader *r, size_t *n);

#endif
