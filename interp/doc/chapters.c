// The documents that are embedded into the program, and the chapters of the manual among them.

#include <string.h>

#include "interp/doc/doc.h"

const CagDocument *cag_document(const char *path) {
  for (const CagDocument *d = cag_documents; d->path; d++)
    if (strcmp(d->path, path) == 0) return d;
  return NULL;
}

static const CagDocChapter chapters[] = {
    {"docs/getting-started.md", "getting-started", "Getting started",
     "from installation to a first picture, in ten minutes"},
    {"docs/language.md", "language", "The language",
     "values, functions, blocks, params, and modules"},
    {"docs/geometry.md", "geometry", "Geometry",
     "transforms, measures, sections, and empty shapes"},
    {"docs/curves-and-regions.md", "curves-and-regions", "Curves and regions",
     "each family of curves with its formula and picture"},
    {"docs/surfaces-and-quadrics.md", "surfaces-and-quadrics", "Surfaces and quadrics",
     "each family of surfaces with its formula and picture"},
    {"docs/solids-and-meshes.md", "solids-and-meshes", "Solids and meshes",
     "basic solids, set operations, and meshes"},
    {"docs/solids.md", "solids", "Exact solids and assemblies",
     "fillets, shells, STEP files, drawings, and parts lists"},
    {"docs/robots.md", "robots", "Robots", "chains of links, their motion, and URDF files"},
    {"docs/sensing.md", "sensing", "Sensing",
     "images, cameras that measure, and the formulas of sensors"},
    {"docs/scenes-and-files.md", "scenes-and-files", "Scenes and files",
     "cameras, lights, materials, and exported files"},
    {"docs/batch.md", "batch", "Rendering and batches", "pictures, films, and many jobs at once"},
    {"docs/live.md", "live", "Live work",
     "the page, watching files, the language server, measures, and language models"},
    {"docs/embedding.md", "embedding", "Embedding libcag", "scripts in programs written in C"},
    {"docs/from-openscad.md", "from-openscad", "From OpenSCAD",
     "the constructs of OpenSCAD and those of cag, side by side"},
    {"docs/from-povray.md", "from-povray", "From POV-Ray",
     "the constructs of POV-Ray and those of cag, side by side"},
};

const CagDocChapter *cag_doc_chapter(size_t i) {
  return i < sizeof chapters / sizeof *chapters ? &chapters[i] : NULL;
}
