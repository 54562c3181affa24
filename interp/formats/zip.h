// ZIP archives, the container of 3MF files: deflated members, and reproducible bytes.

#ifndef CAG_INTERP_FORMATS_ZIP_H
#define CAG_INTERP_FORMATS_ZIP_H

#include "base/atomic_file.h"
#include "base/status.h"

enum { CAG_ZIP_MEMBERS = 8, CAG_ZIP_NAME = 64 };

typedef struct CagZip {
  CagAtomicFile *file;
  size_t count;
  struct CagZipMember {
    char name[CAG_ZIP_NAME];
    uint32_t crc, packed, size, offset;
  } members[CAG_ZIP_MEMBERS];
  struct CagZipPacker *packer; // of the open member
} CagZip;

// Opens a member, adds bytes to it in any pieces, and closes it, which writes it. Fails with
// CAG_E_LIMIT "file-too-large" beyond 4 GB.
CagStatus cag_zip_open(CagZip *z, const char *name, CagError *err);
CagStatus cag_zip_feed(CagZip *z, const char *bytes, size_t n, CagError *err);
CagStatus cag_zip_close(CagZip *z, CagError *err);
// Opens, writes, and closes a member.
CagStatus cag_zip_add(CagZip *z, const char *name, const char *bytes, size_t n, CagError *err);
// Writes the directory at the end of the archive.
void cag_zip_end(CagZip *z);
// Releases a member that was not closed. Otherwise does nothing.
void cag_zip_free(CagZip *z);

#endif
