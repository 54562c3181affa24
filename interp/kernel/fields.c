// Fields of messages (see fields.h).

#include "interp/kernel/fields.h"

#include <math.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"

void cag_fields_free(CagFields *f) {
  cag_free(f->bytes);
  *f = (CagFields){0};
}

void cag_put_bytes(CagFields *f, const void *bytes, size_t n) {
  if (f->failed || n == 0) return;
  if (!CAG_RESERVE(f->bytes, f->room, f->length + n)) {
    f->failed = true;
    return;
  }
  memcpy(f->bytes + f->length, bytes, n);
  f->length += n;
}

void cag_put_u32(CagFields *f, size_t x) {
  const uint32_t word = (uint32_t)x;
  if (word != x) f->failed = true;
  cag_put_bytes(f, &word, sizeof word);
}

void cag_put_f64(CagFields *f, double x) { cag_put_bytes(f, &x, sizeof x); }

void cag_put_vec(CagFields *f, CagVec3 p) {
  cag_put_f64(f, p.x);
  cag_put_f64(f, p.y);
  cag_put_f64(f, p.z);
}

void cag_put_plane_point(CagFields *f, CagVec3 p) {
  cag_put_f64(f, p.x);
  cag_put_f64(f, p.y);
}

void cag_put_frame(CagFields *f, const CagTransform *t) {
  static const int COLUMNS[] = {3, 0, 1, 2};
  for (int k = 0; k < 4; k++)
    for (int i = 0; i < 3; i++) cag_put_f64(f, t->m[i][COLUMNS[k]]);
}

void cag_put_placement(CagFields *f, const CagTransform *t) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++) cag_put_f64(f, t->m[i][j] / t->m[3][3]);
}

static void take(CagFieldReader *r, void *out, size_t n) {
  if (r->bad || (size_t)(r->end - r->at) < n) {
    r->bad = true;
    memset(out, 0, n);
    return;
  }
  memcpy(out, r->at, n);
  r->at += n;
}

uint32_t cag_take_u32(CagFieldReader *r) {
  uint32_t x;
  take(r, &x, sizeof x);
  return x;
}

double cag_take_f64(CagFieldReader *r) {
  double x;
  take(r, &x, sizeof x);
  if (isfinite(x)) return x;
  r->bad = true;
  return 0;
}

CagVec3 cag_take_vec(CagFieldReader *r) {
  CagVec3 p;
  p.x = cag_take_f64(r);
  p.y = cag_take_f64(r);
  p.z = cag_take_f64(r);
  return p;
}

size_t cag_take_count(CagFieldReader *r, size_t least) {
  const size_t n = cag_take_u32(r);
  if (!r->bad && n <= (size_t)(r->end - r->at) / least) return n;
  r->bad = true;
  return 0;
}

const unsigned char *cag_take_bytes(CagFieldReader *r, size_t *n) {
  *n = cag_take_count(r, 1);
  const unsigned char *bytes = r->at;
  r->at += *n;
  return bytes;
}
