// ZIP archives: deflated members, with reproducible bytes.
//
// A member is deflated in memory first, so that its header can contain its length. Streaming
// readers need that, and the output may be a pipe. The time is always the first day of the format.

#include "interp/formats/zip.h"

#include <string.h>
#include <zlib.h>

#include "base/array.h"
#include "base/memory.h"

// Signatures of the format (APPNOTE 4.3).
#define LOCAL_HEADER 0x04034b50u
#define DIRECTORY_HEADER 0x02014b50u
#define DIRECTORY_END 0x06054b50u
enum { VERSION = 20, DEFLATED = 8, UTF8_NAMES = 1 << 11, FIRST_DAY = 0x21, RAW_WINDOW = -15 };
// Text with many similar numbers hardly becomes smaller with more effort.
enum { LEVEL = 3, MEMORY_LEVEL = 8 };

static char *put(char *at, uint64_t x, int bytes) {
  for (int k = 0; k < bytes; k++) *at++ = (char)(x >> 8 * k & 0xff);
  return at;
}

// Writes the common part of both headers of a member, from the version needed to the length of its
// name.
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

struct CagZipPacker {
  z_stream stream;
  char *packed;
  size_t room;
  uint64_t size;
};

static CagStatus fail_size(uint64_t size, CagError *err) {
  return cag_fail(
      err, CAG_E_LIMIT, CAG_ERR_file_too_large, "", -1,
      "a 3MF file can have at most 4 GB of text, but the scene needs %.1f GB; use a larger tolerance or PLY",
      (double)size / 1e9);
}

CagStatus cag_zip_open(CagZip *z, const char *name, CagError *err) {
  struct CagZipPacker *p = cag_calloc(1, sizeof *p);
  if (!p) return cag_fail_memory(err);
  if (deflateInit2(&p->stream, LEVEL, Z_DEFLATED, RAW_WINDOW, MEMORY_LEVEL, Z_DEFAULT_STRATEGY) !=
      Z_OK) {
    cag_free(p);
    return cag_fail_memory(err);
  }
  z->packer = p;
  struct CagZipMember *m = &z->members[z->count];
  *m = (struct CagZipMember){.offset = (uint32_t)cag_atomic_file_size(z->file)};
  strncpy(m->name, name, sizeof m->name - 1);
  return CAG_OK;
}

// Deflates the input of the stream. `flush`: Z_FINISH for the last part.
static CagStatus pack(struct CagZipPacker *p, int flush, CagError *err) {
  z_stream *s = &p->stream;
  do {
    const size_t block = (size_t)1 << 16;
    if (s->total_out == p->room && !CAG_RESERVE(p->packed, p->room, p->room + block))
      return cag_fail_memory(err);
    s->next_out = (Bytef *)p->packed + s->total_out;
    size_t left = p->room - s->total_out;
    s->avail_out = left > UINT32_MAX ? UINT32_MAX : (uInt)left;
    if (deflate(s, flush) == Z_STREAM_END) return CAG_OK;
  } while (s->avail_out == 0 || flush == Z_FINISH);
  return CAG_OK;
}

CagStatus cag_zip_feed(CagZip *z, const char *bytes, size_t n, CagError *err) {
  struct CagZipPacker *p = z->packer;
  struct CagZipMember *m = &z->members[z->count];
  p->size += n;
  if (p->size > UINT32_MAX) return fail_size(p->size, err);
  m->crc = (uint32_t)crc32(m->crc, (const Bytef *)bytes, (uInt)n);
  p->stream.next_in = (Bytef *)bytes;
  p->stream.avail_in = (uInt)n;
  return pack(p, Z_NO_FLUSH, err);
}

CagStatus cag_zip_close(CagZip *z, CagError *err) {
  struct CagZipPacker *p = z->packer;
  struct CagZipMember *m = &z->members[z->count];
  CagStatus status = pack(p, Z_FINISH, err);
  uint64_t size = p->stream.total_out, offset = cag_atomic_file_size(z->file);
  if (!status && offset + size > UINT32_MAX) status = fail_size(p->size, err);
  if (!status) {
    m->packed = (uint32_t)size;
    m->size = (uint32_t)p->size;
    z->count++;
    char header[64], *at = put_member(put(header, LOCAL_HEADER, 4), m);
    cag_atomic_file_write(z->file, header, (size_t)(at - header));
    cag_atomic_file_text(z->file, m->name);
    cag_atomic_file_write(z->file, p->packed, size);
  }
  cag_zip_free(z);
  return status;
}

void cag_zip_free(CagZip *z) {
  if (!z->packer) return;
  deflateEnd(&z->packer->stream);
  cag_free(z->packer->packed);
  cag_free(z->packer);
  z->packer = NULL;
}

CagStatus cag_zip_add(CagZip *z, const char *name, const char *bytes, size_t n, CagError *err) {
  CagStatus status = cag_zip_open(z, name, err);
  if (!status) status = cag_zip_feed(z, bytes, n, err);
  if (!status) status = cag_zip_close(z, err);
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
    at = put(at, 0, 2 + 2 + 2); // comment, disk, attributes
    at = put(at, 0, 4);         // attributes of the system
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
