// 3MF, core specification: a ZIP archive with the model as XML and two parts that refer to it.
//
// Ids: 1 is the base materials, and objects start from 2 in the order of the parts. A part is an
// object with a mesh. A copy with the same material is an object that contains the other one as a
// transformed component and has its own name, because components have no material. After the
// objects come the color groups (materials extension) of meshes that show values as colors. A mesh
// must be closed to be a model; an open one is a surface. Points are those of the welded mesh.

#include <stdio.h>

#include "base/decimal.h"
#include "base/memory.h"
#include "base/stop.h"
#include "interp/formats/mesh_copies.h"
#include "interp/formats/mesh_write.h"
#include "interp/formats/zip.h"
#include "interp/scene/color_scale.h"

#ifndef CAG_VERSION
#define CAG_VERSION "0"
#endif

enum {
  BATCH = 128,
  VERTEX_BYTES = 3 * 25 + 40,
  TRIANGLE_BYTES = 3 * 21 + 40 + 24 + 3 * 32, // with colors
  MATERIALS_ID = 1,
  FIRST_OBJECT = 2
};

typedef struct Model {
  const CagMeshPart *parts;
  size_t count;
  CagMeshCopy *copies;
  CagMaterialList materials;
  size_t *material_of; // index of each part's material
  CagAtomicFile *xml;  // in memory: not packed yet
  CagZip zip;
} Model;

// The amount of text that is collected before it is packed.
#define XML_KEPT ((uint64_t)1 << 20)

// Packs the text so far if there is enough of it.
static CagStatus pack_xml(Model *m, bool all, CagError *err) {
  CagError io;
  char *xml;
  size_t size;
  if (!all && cag_atomic_file_size(m->xml) < XML_KEPT) return CAG_OK;
  CagAtomicFile *full = m->xml;
  m->xml = cag_atomic_file_open_memory(&io);
  if (!cag_atomic_file_commit_memory(full, &xml, &size, &io) || !m->xml)
    return cag_fail_memory(err);
  CagStatus status = cag_zip_feed(&m->zip, xml, size, err);
  cag_free(xml);
  return status;
}

static char *put_text(char *at, const char *text) {
  size_t n = strlen(text);
  memcpy(at, text, n);
  return at + n;
}

// Writes the text of an attribute. XML does not allow control characters.
static void write_escaped(CagAtomicFile *xml, const char *text) {
  for (; *text; text++) {
    unsigned char c = (unsigned char)*text;
    const char *as = c == '&'   ? "&amp;"
                     : c == '<' ? "&lt;"
                     : c == '>' ? "&gt;"
                     : c == '"' ? "&quot;"
                     : c < ' '  ? " "
                                : NULL;
    if (as) cag_atomic_file_text(xml, as);
    else cag_atomic_file_write(xml, text, 1);
  }
}

// --- Materials ---

// Colors are in sRGB. Transmission becomes transparency.
static void write_materials(Model *m) {
  if (m->materials.count == 0) return;
  cag_atomic_file_printf(m->xml, "  <basematerials id=\"%d\">\n", MATERIALS_ID);
  for (size_t i = 0; i < m->materials.count; i++) {
    const CagMaterial *a = m->materials.items[i];
    const double x[4] = {cag_linear_to_srgb(fmin(fmax(a->color.r, 0), 1)),
                         cag_linear_to_srgb(fmin(fmax(a->color.g, 0), 1)),
                         cag_linear_to_srgb(fmin(fmax(a->color.b, 0), 1)),
                         1 - fmin(fmax(a->transmission, 0), 1)};
    cag_atomic_file_text(m->xml, "   <base name=\"");
    write_escaped(m->xml, a->name ? a->name : "material");
    cag_atomic_file_text(m->xml, "\" displaycolor=\"#");
    for (int k = 0; k < 4; k++) cag_atomic_file_printf(m->xml, "%02X", (int)(255 * x[k] + 0.5));
    cag_atomic_file_text(m->xml, "\"/>\n");
  }
  cag_atomic_file_text(m->xml, "  </basematerials>\n");
}

// --- Colors of values ---

// Steps of a scale: neighbors differ by less than 8-bit colors can show.
#define SCALE_STEPS 256

static size_t scale_id(const Model *m, size_t i) { return m->count + FIRST_OBJECT + i; }

static int scale_step(const CagColorScale *s, double value) {
  double t = (value - s->from) / (s->to - s->from);
  return isnan(t) ? 0 : (int)fmin(fmax(floor(t * SCALE_STEPS), 0), SCALE_STEPS - 1);
}

static void write_scale(Model *m, size_t i) {
  const CagColorScale *s = &m->parts[i].mesh->scale;
  cag_atomic_file_printf(m->xml, "  <m:colorgroup id=\"%zu\">\n", scale_id(m, i));
  for (int k = 0; k < SCALE_STEPS; k++) {
    CagColor c = cag_color_scale_at(s, s->from + (s->to - s->from) * (k + 0.5) / SCALE_STEPS);
    const double x[3] = {c.r, c.g, c.b};
    cag_atomic_file_text(m->xml, "   <m:color color=\"#");
    for (int j = 0; j < 3; j++)
      cag_atomic_file_printf(m->xml, "%02X", (int)(255 * cag_linear_to_srgb(x[j]) + 0.5));
    cag_atomic_file_text(m->xml, "\"/>\n");
  }
  cag_atomic_file_text(m->xml, "  </m:colorgroup>\n");
}

// Writes pid and p1, p2, p3 of a triangle.
static char *put_triangle_colors(const Model *m, size_t i, const uint32_t *corners, char *at) {
  static const char *const names[] = {"\" p1=\"", "\" p2=\"", "\" p3=\""};
  const CagMesh *mesh = m->parts[i].mesh;
  at = put_text(at, "\" pid=\"");
  at = cag_decimal_index(at, scale_id(m, i));
  for (int j = 0; j < 3; j++) {
    at = put_text(at, names[j]);
    at = cag_decimal_index(at, (uint64_t)scale_step(&mesh->scale, mesh->uv[2 * corners[j]]));
  }
  return at;
}

// --- Meshes ---

static CagStatus write_vertices(Model *m, const CagMesh *mesh, const float *p, uint32_t *number,
                                CagError *err) {
  uint32_t n = 0;
  CagStatus status = CAG_OK;
  for (size_t v = 0; !status && v < mesh->vertex_count && !cag_stopped();) {
    char *at = cag_atomic_file_reserve(m->xml, (size_t)BATCH * VERTEX_BYTES);
    for (size_t end = v + BATCH; v < mesh->vertex_count && v < end; v++) {
      if (mesh->weld && mesh->weld[v] != v) {
        number[v] = number[mesh->weld[v]];
        continue;
      }
      number[v] = n++;
      at = put_text(at, "     <vertex x=\"");
      at = cag_mesh_write_number(at, p[3 * v]);
      at = put_text(at, "\" y=\"");
      at = cag_mesh_write_number(at, p[3 * v + 1]);
      at = put_text(at, "\" z=\"");
      at = cag_mesh_write_number(at, p[3 * v + 2]);
      at = put_text(at, "\"/>\n");
    }
    cag_atomic_file_advance(m->xml, at);
    status = pack_xml(m, false, err);
  }
  return status;
}

static CagStatus write_triangles(Model *m, size_t part, const float *p, const uint32_t *number,
                                 CagError *err) {
  const CagMesh *mesh = m->parts[part].mesh;
  CagStatus status = CAG_OK;
  for (size_t t = 0; !status && t < mesh->triangle_count && !cag_stopped();) {
    char *at = cag_atomic_file_reserve(m->xml, (size_t)BATCH * TRIANGLE_BYTES);
    for (size_t end = t + BATCH; t < mesh->triangle_count && t < end; t++) {
      const uint32_t *k = mesh->triangles + 3 * t;
      if (cag_mesh_shrinks(p, k)) continue;
      at = put_text(at, "     <triangle v1=\"");
      at = cag_decimal_index(at, number[k[0]]);
      at = put_text(at, "\" v2=\"");
      at = cag_decimal_index(at, number[k[1]]);
      at = put_text(at, "\" v3=\"");
      at = cag_decimal_index(at, number[k[2]]);
      if (mesh->scale.kind) at = put_triangle_colors(m, part, k, at);
      at = put_text(at, "\"/>\n");
    }
    cag_atomic_file_advance(m->xml, at);
    status = pack_xml(m, false, err);
  }
  return status;
}

static CagStatus write_mesh(Model *m, size_t i, const float *p, CagError *err) {
  const CagMesh *mesh = m->parts[i].mesh;
  uint32_t *number = cag_malloc((mesh->vertex_count + 1) * sizeof *number);
  if (!number) return cag_fail_memory(err);
  cag_atomic_file_text(m->xml, "   <mesh>\n    <vertices>\n");
  CagStatus status = write_vertices(m, mesh, p, number, err);
  cag_atomic_file_text(m->xml, "    </vertices>\n    <triangles>\n");
  if (!status) status = write_triangles(m, i, p, number, err);
  cag_atomic_file_text(m->xml, "    </triangles>\n   </mesh>\n");
  cag_free(number);
  return status;
}

// --- Objects ---

// Writes a transform by rows, for row vectors: the images of the three axes, then the translation.
static void write_transform(Model *m, const CagTransform *t) {
  cag_atomic_file_text(m->xml, " transform=\"");
  for (int j = 0; j < 4; j++)
    for (int i = 0; i < 3; i++)
      cag_atomic_file_printf(m->xml, "%s%.17g", i + j ? " " : "", t->m[i][j] + 0.0);
  cag_atomic_file_text(m->xml, "\"");
}

static bool is_component(const Model *m, size_t i) { return m->copies[i].original != i; }

// p: the positions, for a part with its own mesh.
static CagStatus write_object(Model *m, size_t i, bool closed, const float *p, CagError *err) {
  const CagMeshPart *part = &m->parts[i];
  size_t original = m->copies[i].original;
  if (part->mesh->scale.kind && !is_component(m, i)) write_scale(m, i);
  cag_atomic_file_printf(m->xml, "  <object id=\"%zu\" type=\"%s\" name=\"", i + FIRST_OBJECT,
                         closed ? "model" : "surface");
  write_escaped(m->xml, part->name ? part->name : "part");
  cag_atomic_file_text(m->xml, "\"");
  CagStatus status = CAG_OK;
  if (is_component(m, i)) {
    cag_atomic_file_printf(m->xml, ">\n   <components>\n    <component objectid=\"%zu\"",
                           original + FIRST_OBJECT);
    write_transform(m, &m->copies[i].place);
    cag_atomic_file_text(m->xml, "/>\n   </components>\n");
  } else {
    if (part->material)
      cag_atomic_file_printf(m->xml, " pid=\"%d\" pindex=\"%zu\"", MATERIALS_ID, m->material_of[i]);
    cag_atomic_file_text(m->xml, ">\n");
    status = write_mesh(m, i, p, err);
  }
  cag_atomic_file_text(m->xml, "  </object>\n");
  return status;
}

// Writes all objects. *shown: those that are not empty in single precision.
static CagStatus write_objects(Model *m, bool *shown, CagError *err) {
  for (size_t i = 0; i < m->count; i++) {
    CagVec3 edge[2];
    float *p = NULL;
    // Done before the positions are made, because the check needs as much memory as the mesh.
    bool closed;
    CagStatus status = cag_mesh_watertight(m->parts[i].mesh, &closed, edge, err);
    if (status) return status;
    if (is_component(m, i)) shown[i] = shown[m->copies[i].original];
    else {
      status = cag_mesh_floats(&m->parts[i], &p, NULL, NULL, err);
      if (status) return status;
      shown[i] = cag_mesh_kept_triangles(m->parts[i].mesh, p) > 0;
    }
    if (shown[i]) status = write_object(m, i, closed, p, err);
    cag_free(p);
    if (status) return status;
  }
  return CAG_OK;
}

static CagStatus write_model(Model *m, bool *shown, CagError *err) {
  cag_atomic_file_text(
      m->xml, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
              "<model unit=\"millimeter\" xml:lang=\"en-US\" "
              "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
              "xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\">\n"
              " <metadata name=\"Application\">cag " CAG_VERSION "</metadata>\n <resources>\n");
  write_materials(m);
  CagStatus status = write_objects(m, shown, err);
  if (status) return status;
  cag_atomic_file_text(m->xml, " </resources>\n <build>\n");
  for (size_t i = 0; i < m->count; i++)
    if (shown[i]) cag_atomic_file_printf(m->xml, "  <item objectid=\"%zu\"/>\n", i + FIRST_OBJECT);
  cag_atomic_file_text(m->xml, " </build>\n</model>\n");
  return CAG_OK;
}

// --- The archive ---

static CagStatus begin(Model *m, CagError *err) {
  static const char types[] =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">\n"
      " <Default Extension=\"rels\" "
      "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>\n"
      " <Default Extension=\"model\" "
      "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/>\n</Types>\n";
  static const char relations[] =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">\n"
      " <Relationship Target=\"/3D/3dmodel.model\" Id=\"model\" "
      "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>\n"
      "</Relationships>\n";
  CagError io;
  m->material_of = cag_calloc(m->count + 1, sizeof *m->material_of);
  if (!m->material_of) return cag_fail_memory(err);
  for (size_t i = 0; i < m->count; i++) {
    const CagMaterial *material = m->parts[i].material;
    if (material && !cag_material_list_add(&m->materials, material, &m->material_of[i]))
      return cag_fail_memory(err);
  }
  m->xml = cag_atomic_file_open_memory(&io);
  if (!m->xml) return cag_fail_memory(err);
  CagStatus status = cag_mesh_find_copies(m->parts, m->count, true, &m->copies, err);
  if (!status) status = cag_zip_add(&m->zip, "[Content_Types].xml", types, sizeof types - 1, err);
  if (!status) status = cag_zip_add(&m->zip, "_rels/.rels", relations, sizeof relations - 1, err);
  return status;
}

CagStatus cag_export_3mf(const CagMeshPart *parts, size_t n, CagAtomicFile *file, CagError *err) {
  Model m = {.parts = parts, .count = n, .zip.file = file};
  bool *shown = cag_calloc(n + 1, sizeof *shown);
  CagStatus status = shown ? begin(&m, err) : cag_fail_memory(err);
  if (!status) status = cag_zip_open(&m.zip, "3D/3dmodel.model", err);
  if (!status) status = write_model(&m, shown, err);
  if (!status) status = pack_xml(&m, true, err);
  if (!status) status = cag_zip_close(&m.zip, err);
  if (!status) cag_zip_end(&m.zip);
  cag_zip_free(&m.zip);
  cag_atomic_file_abort(m.xml);
  cag_free(shown);
  cag_free(m.copies);
  cag_free(m.material_of);
  cag_material_list_free(&m.materials);
  return status;
}
