// ZIP archives: deflated members, the same bytes for the same content.
//
// A member is deflated in memory first, so that its header can say how long it is: readers that go
// from front to back need that, and the output may be a pipe. No time is written but the format's
// first day.

#include "interp/export/zip.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

// Words of the format (APPNOTE 4.3).
#define LOCAL_HEADER 0x04034b50u
#define DIRECTORY_HEADER 0x02014b50u
#define DIRECTORY_END 0x06054b50u
enum { VERSION = 20, DEFLATED = 8, UTF8_NAMES = 1 << 11, FIRST_DAY = 0x21, RAW_WINDOW = -15 };
// Numbers in text are many and alike: more work hardly makes them smaller.
enum { LEVEL = 3, MEMORY_LEVEL = 8 };

static char *put(char *at, uint64_t x, int bytes) {
  for (int k = 0; k < bytes; k++) *at++ = (char)(x >> 8 * k & 0xff);
  return at;
}

// What both headers of a member share: from the version needed to the length of its name.
static char *put_member(char *at, const struct CagZipMember *m) {
  at = put(at, VERSION, 2);
  at = put(at, UTF8_NAMES, 2);
  at = put(at, DEFLATED, 2);
  at = put(at, 0, 2);
  at = put(at, FIRST_DAY, 2);
  at = put(at, m->crc, 4);
  at = put(at, m->packed, 4);
  at = put(at, m->size, 4);
  at = put(at, strlen(m->name), 2);
  return put(at, 0, 2); // no extra field
}

// Deflates into memory from malloc.
static CagStatus deflate_bytes(const char *bytes, size_t n, char **out, size_t *size,
                               CagError *err) {
  z_stream s = {0};
  if (deflateInit2(&s, LEVEL, Z_DEFLATED, RAW_WINDOW, MEMORY_LEVEL, Z_DEFAULT_STRATEGY) != Z_OK)
    return cag_fail_memory(err);
  size_t room = n / 4 + 4096;
  char *packed = malloc(room);
  int state = Z_OK;
  s.next_in = (Bytef *)bytes;
  s.avail_in = (uInt)n;
  while (packed && state == Z_OK) {
    if (s.total_out == room) {
      room *= 2;
      char *larger = realloc(packed, room);
      if (!larger) free(packed);
      packed = larger;
      if (!packed) break;
    }
    s.next_out = (Bytef *)packed + s.total_out;
    s.avail_out = (uInt)(room - s.total_out);
    state = deflate(&s, Z_FINISH);
    if (state == Z_BUF_ERROR) state = Z_OK; // the room was full
  }
  *out = packed;
  *size = s.total_out;
  deflateEnd(&s);
  return packed ? CAG_OK : cag_fail_memory(err);
}

CagStatus cag_zip_add(CagZip *z, const char *name, const char *bytes, size_t n, CagError *err) {
  char *packed = NULL;
  size_t size = 0;
  uint64_t offset = cag_atomic_file_size(z->file);
  CagStatus status = n > UINT32_MAX / 2 ? CAG_OK : deflate_bytes(bytes, n, &packed, &size, err);
  if (status == CAG_OK && (!packed || offset + size > UINT32_MAX))
    status = cag_fail(err, CAG_E_LIMIT, "file-too-large", "", -1,
                      "a part of a 3MF file holds at most 2 GB, the scene takes %.1f GB: use a "
                      "larger tolerance or PLY",
                      (double)n / 1e9);
  if (status == CAG_OK) {
    struct CagZipMember *m = &z->members[z->count++];
    *m = (struct CagZipMember){.crc = (uint32_t)crc32(0, (const Bytef *)bytes, (uInt)n),
                               .packed = (uint32_t)size,
                               .size = (uint32_t)n,
                               .offset = (uint32_t)offset};
    strncpy(m->name, name, sizeof m->name - 1);
    char header[64], *at = put_member(put(header, LOCAL_HEADER, 4), m);
    cag_atomic_file_write(z->file, header, (size_t)(at - header));
    cag_atomic_file_text(z->file, m->name);
    cag_atomic_file_write(z->file, packed, size);
  }
  free(packed);
  return status;
}

void cag_zip_end(CagZip *z) {
  uint64_t begin = cag_atomic_file_size(z->file);
  char header[64], *at;
  for (size_t i = 0; i < z->count; i++) {
    const struct CagZipMember *m = &z->members[i];
    at = put(header, DIRECTORY_HEADER, 4);
    at = put(at, VERSION, 2);
    at = put_member(at, m);
    at = put(at, 0, 2 + 2 + 2 + 4); // comment, disk, attributes
    at = put(at, m->offset, 4);
    cag_atomic_file_write(z->file, header, (size_t)(at - header));
    cag_atomic_file_text(z->file, m->name);
  }
  uint64_t end = cag_atomic_file_size(z->file);
  at = put(header, DIRECTORY_END, 4);
  at = put(at, 0, 4); // disks
  at = put(at, z->count, 2);
  at = put(at, z->count, 2);
  at = put(at, end - begin, 4);
  at = put(at, begin, 4);
  at = put(at, 0, 2); // comment
  cag_atomic_file_write(z->file, header, (size_t)(at - header));
}
