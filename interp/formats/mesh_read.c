// Detecting the format of mesh files.
//
// The contents decide if possible: PLY and GLB start with a signature, and a binary STL has exactly
// the length stated in its header. Otherwise, the extension decides, and then the first words.

#include "interp/formats/mesh_read.h"

#include <string.h>
#include <strings.h>

#include "interp/formats/mesh_draft.h"
#include "interp/formats/text_scan.h"

static bool begins(const CagMeshFile *f, const char *mark) {
  size_t n = strlen(mark);
  return f->size >= n && memcmp(f->bytes, mark, n) == 0;
}

static bool ends(const CagMeshFile *f, const char *ending) {
  size_t n = strlen(f->name), k = strlen(ending);
  return n > k && strcasecmp(f->name + n - k, ending) == 0;
}

// Tests whether the text starts, after comments, with a keyword of OBJ files.
static bool looks_like_obj(const CagMeshFile *f) {
  static const char *const words[] = {"v", "vn", "vt", "f", "o", "g", "s", "mtllib", "usemtl"};
  CagTextScan s = {f->bytes, f->bytes + f->size};
  while (cag_scan_to_word(&s)) {
    const char *word;
    size_t n = cag_scan_word(&s, &word);
    if (n == 0) return false; // a zero byte
    if (*word != '#')
      for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (cag_scan_is(word, n, words[i])) return true;
    if (*word != '#') return false;
    cag_scan_next_line(&s);
  }
  return false;
}

static CagMeshReader *find_reader(const CagMeshFile *f) {
  if (begins(f, "ply\n") || begins(f, "ply\r")) return cag_read_ply;
  if (begins(f, "glTF")) return cag_read_gltf;
  if (cag_stl_is_binary(f)) return cag_read_stl;
  if (ends(f, ".stl")) return cag_read_stl;
  if (ends(f, ".obj")) return cag_read_obj;
  if (ends(f, ".ply")) return cag_read_ply;
  if (ends(f, ".gltf") || ends(f, ".glb")) return cag_read_gltf;
  CagTextScan s = {f->bytes, f->bytes + f->size};
  const char *word;
  if (!cag_scan_to_word(&s)) return NULL;
  if (*s.at == '{') return cag_read_gltf;
  size_t n = cag_scan_word(&s, &word);
  if (cag_scan_is(word, n, "solid")) return cag_read_stl;
  return looks_like_obj(f) ? cag_read_obj : NULL;
}

CagStatus cag_mesh_read(const CagMeshFile *f, CagMesh **out, CagError *err) {
  CagMeshReader *read = find_reader(f);
  if (!read)
    return cag_mesh_file_fail_byte(
        f, err, CAG_ERR_mesh_file_kind, NULL,
        f->size ? "it is not a supported mesh file: .stl .obj .ply .gltf .glb"
                : "the file is empty");
  CagMeshDraft draft = {.file = f};
  CagStatus status = read(&draft, err);
  if (!status) status = cag_draft_finish(&draft, out, err);
  cag_draft_free(&draft);
  return status;
}
