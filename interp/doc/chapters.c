// The documents that are compiled into the program, and the chapters of the manual among them.

#include <string.h>

#include "interp/doc/doc.h"

const CagDocument *cag_document(const char *path) {
  for (const CagDocument *d = cag_documents; d->path; d++)
    if (strcmp(d->path, path) == 0) return d;
  return NULL;
}

static const CagDocChapter chapters[] = {
    {"docs/getting-started.md", "getting-started", "Getting started",
     "from nothing to a picture, in ten minutes"},
    {"docs/language.md", "language", "The language",
     "words, values, functions, blocks, params, modules"},
    {"docs/geometry.md", "geometry", "Geometry",
     "each family of shapes with its formula and picture"},
    {"docs/robots.md", "robots", "Robots", "chains of links, their motion, and files of others"},
    {"docs/batch.md", "batch", "Rendering and batch", "pictures, films, many jobs at once"},
    {"docs/embedding.md", "embedding", "Embedding libcag", "scripts within programs in C"},
    {"docs/manual-additions.md", "manual-additions", "Finer points",
     "functions by subject, as a reference"},
};

const CagDocChapter *cag_doc_chapter(size_t i) {
  return i < sizeof chapters / sizeof *chapters ? &chapters[i] : NULL;
}
