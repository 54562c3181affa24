// The files of the page, compressed by gzip: made by `make web` from web/, and compiled into the
// program.

#ifndef CAG_LIVE_PAGE_FILES_H
#define CAG_LIVE_PAGE_FILES_H

#include <stddef.h>

typedef struct CagPageFile {
  const char *path; // "/page.js"
  const unsigned char *bytes;
  size_t size;
} CagPageFile;

extern const CagPageFile cag_page_files[]; // ends with a NULL path

#endif
