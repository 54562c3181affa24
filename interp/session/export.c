// Writes the scene in a file format.

#include <errno.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/tessellate/orient.h"
#include "interp/formats/iges.h"
#include "interp/formats/json.h"
#include "interp/formats/mesh_formats.h"
#include "interp/formats/pov.h"
#include "interp/formats/step.h"
#include "interp/formats/svg.h"
#include "interp/scene/item_mesh.h"
#include "interp/session/output.h"
#include "interp/session/urdf_robot.h"

typedef int (*ExportFunction)(CagSession *s, const char *path);

// --- Meshes ---

typedef struct Parts {
  CagMeshPart *items;
  size_t count, capacity;
} Parts;

static void free_parts(Parts *p) {
  for (size_t i = 0; i < p->count; i++) cag_mesh_release((CagMesh *)p->items[i].mesh);
  cag_free(p->items);
}

static CagStatus add_part(Parts *p, CagMeshPart part, CagError *err) {
  if (!CAG_RESERVE(p->items, p->capacity, p->count + 1)) {
    cag_mesh_release((CagMesh *)part.mesh);
    return cag_fail_memory(err);
  }
  p->items[p->count++] = part;
  return CAG_OK;
}

// Adds one part or, with `apart`, one for each material of the faces of a set operation. Takes over
// the mesh.
static CagStatus add_parts(Parts *p, const CagScene *scene, const CagItem *item, CagMesh *mesh,
                           bool apart, CagError *err) {
  if (!apart || !mesh->labels || !item->label_count) {
    const CagMaterial *material = &scene->materials[item->material];
    return add_part(p, (CagMeshPart){.name = item->name, .mesh = mesh, .material = material}, err);
  }
  size_t *materials, count;
  CagStatus status = cag_item_materials(item, &materials, &count, err);
  for (size_t i = 0; !status && i < count; i++) {
    const CagMaterial *material = &scene->materials[materials[i]];
    CagMesh *m = NULL;
    status = cag_item_mesh_of(item, mesh, materials[i], &m, err);
    if (status || m->triangle_count == 0) {
      cag_mesh_release(m);
      continue;
    }
    status = add_part(p, (CagMeshPart){.name = item->name, .mesh = m, .material = material}, err);
  }
  cag_free(materials);
  cag_mesh_release(mesh);
  return status;
}

// Warns about an open part in a file for printing. Leaves room in the list of diagnostics for a
// later error.
static CagStatus warn_open(CagSession *s, const CagItem *item, const CagMesh *mesh, CagError *err) {
  const bool region = item->kind == CAG_ITEM_REGION;
  size_t open = 0;
  if (item->kind == CAG_ITEM_SOLID || item->kind == CAG_ITEM_CURVE) return CAG_OK;
  CagStatus status = cag_mesh_open_edges(mesh, &open, err);
  if (status || open == 0) return status;
  if (s->diagnostics.count + 1 >= CAG_DIAGNOSTICS_MAX) {
    s->diagnostics.dropped++;
    return CAG_OK;
  }
  CagDiagnostic *d =
      cag_diagnostics_add(&s->diagnostics, CAG_ERR_open_in_file, NULL, (CagSpan){0, 0},
                          "%s is %s, not a solid: %zu open edge%s", item->name,
                          region                           ? "a flat region"
                          : item->kind == CAG_ITEM_SURFACE ? "an open surface"
                                                           : "an open mesh",
                          open, open == 1 ? "" : "s");
  d->severity = CAG_SEVERITY_WARNING;
  cag_diagnostic_set_help(d, region ? "`prism` makes it printable"
                             : item->kind == CAG_ITEM_SURFACE
                                 ? "`thicken` or `solid` makes it printable"
                                 : "add the missing faces, or `weld` them");
  return CAG_OK;
}

typedef enum MeshUse {
  FOR_PRINTING = 1, // parts should be solids
  ONE_MATERIAL = 2  // each part has a single material
} MeshUse;

// Makes meshes of all shown items. Grounds and lines are omitted unless nothing else was shown.
// use: of MeshUse.
static int make_parts(CagSession *s, unsigned use, Parts *out) {
  const CagScene *scene = &s->scene;
  *out = (Parts){0};
  bool bodies = false;
  for (size_t i = 0; i < scene->item_count; i++)
    bodies |= scene->items[i].kind != CAG_ITEM_CURVE && scene->items[i].kind != CAG_ITEM_GROUND;
  size_t triangles = 0;
  for (size_t i = 0; i < scene->item_count; i++) {
    const CagItem *item = &scene->items[i];
    if (item->kind == CAG_ITEM_GROUND || (bodies && item->kind == CAG_ITEM_CURVE)) continue;
    CagError err = {0};
    CagMesh *mesh;
    CagStatus status = cag_item_mesh(scene, item, &mesh, &err);
    if (!status) {
      triangles += mesh->triangle_count;
      if (use & FOR_PRINTING) status = warn_open(s, item, mesh, &err);
      if (status) cag_mesh_release(mesh);
      else status = add_parts(out, scene, item, mesh, use & ONE_MATERIAL, &err);
      if (!status && triangles > scene->max_triangles)
        status = cag_fail(&err, CAG_E_LIMIT, CAG_ERR_limit_triangles, "", -1,
                          "the meshes have more than the %zu triangles allowed (--max-triangles)",
                          scene->max_triangles);
    }
    if (!status) continue;
    free_parts(out);
    return cag_session_fail_geometry(s, &err);
  }
  return CAG_STATUS_OK;
}

// A mesh file needs triangles. Labels and grounds appear only in pictures.
static int check_parts(CagSession *s, const Parts *parts) {
  for (size_t i = 0; i < parts->count; i++)
    if (parts->items[i].mesh->triangle_count > 0) return CAG_STATUS_OK;
  CagDiagnostic *d = cag_diagnostics_add(
      &s->diagnostics, CAG_ERR_nothing_to_show, NULL, (CagSpan){0, 0},
      "%s shows nothing that a mesh file can contain", s->script ? s->script : "the session");
  cag_diagnostic_set_help(
      d, s->scene.label_count > 0
             ? "labels have no mesh (`lettering` has one); show a surface, solid, or mesh"
             : "a ground is only for pictures; show a surface, solid, or mesh");
  return CAG_STATUS_SCRIPT;
}

// Makes the path of an accompanying file, such as part.mtl for part.obj, or NULL for standard
// output. Returns false if memory ran out.
static bool path_beside(const char *path, const char *ending, char **out) {
  *out = NULL;
  if (strcmp(path, "-") == 0) return true;
  const char *dot = strrchr(path, '.'), *slash = strrchr(path, '/');
  size_t stem = dot && (!slash || dot > slash) ? (size_t)(dot - path) : strlen(path);
  return cag_asprintf(out, "%.*s%s", (int)stem, path, ending) >= 0;
}

static int fail_memory(CagSession *s) {
  CagError err;
  cag_fail_memory(&err);
  return cag_session_fail_geometry(s, &err);
}

typedef struct MeshOutput {
  const CagMeshPart *parts;
  size_t count;
  CagAtomicFile *file, *beside; // beside: NULL if the format or the output has none
  const char *beside_name;
} MeshOutput;

typedef CagStatus (*MeshWriter)(const MeshOutput *m, CagError *err);

static CagStatus write_obj(const MeshOutput *m, CagError *err) {
  CagStatus status = cag_export_obj(m->parts, m->count, m->beside_name, m->file, err);
  return !status && m->beside ? cag_export_mtl(m->parts, m->count, m->beside, err) : status;
}
static CagStatus write_stl(const MeshOutput *m, CagError *err) {
  return cag_export_stl(m->parts, m->count, NULL, m->file, err);
}
static CagStatus write_ply(const MeshOutput *m, CagError *err) {
  return cag_export_ply(m->parts, m->count, m->file, err);
}
static CagStatus write_glb(const MeshOutput *m, CagError *err) {
  return cag_export_glb(m->parts, m->count, m->file, err);
}
static CagStatus write_3mf(const MeshOutput *m, CagError *err) {
  return cag_export_3mf(m->parts, m->count, m->file, err);
}

static int commit(CagSession *s, CagAtomicFile *f) {
  CagError io = {0};
  return cag_atomic_file_commit(f, &io) ? CAG_STATUS_OK
                                        : cag_session_fail_io(s, CAG_ERR_output_file, &io);
}

// Commits both files or neither. The accompanying file comes first, so that a complete main file
// never refers to a missing one.
static int commit_both(CagSession *s, MeshOutput *m) {
  cag_atomic_file_flush(m->file);
  if (m->beside) cag_atomic_file_flush(m->beside);
  if (cag_atomic_file_failed(m->file)) { // its commit reports the reason
    cag_atomic_file_abort(m->beside);
    return commit(s, m->file);
  }
  int status = m->beside ? commit(s, m->beside) : CAG_STATUS_OK;
  if (status == CAG_STATUS_OK) return commit(s, m->file);
  cag_atomic_file_abort(m->file);
  return status;
}

static int write_meshes(CagSession *s, MeshOutput *m, const char *path, const char *beside,
                        MeshWriter write) {
  CagError io = {0};
  CagError err = {0};
  const char *slash = beside ? strrchr(beside, '/') : NULL;
  m->beside_name = slash ? slash + 1 : beside;
  m->file = cag_atomic_file_open(path, &io);
  if (m->file && beside) m->beside = cag_atomic_file_open(beside, &io);
  if (!m->file || (beside && !m->beside)) {
    cag_atomic_file_abort(m->file);
    return cag_session_fail_io(s, CAG_ERR_output_file, &io);
  }
  if (!cag_session_checked(s, write(m, &err), &err)) return commit_both(s, m);
  cag_atomic_file_abort(m->file);
  cag_atomic_file_abort(m->beside);
  return cag_session_fail_geometry(s, &err);
}

// --- .gltf ---

// Returns the name of the data file of an existing .gltf file of ours, which will become unused, or
// NULL. Its name is at the end of the file.
static char *former_data(const char *path, const char *stem) {
  enum { TAIL = 4096, HASH_DIGITS = 16 };
  char tail[TAIL + 1], *name = NULL;
  FILE *f = fopen(path, "rb");
  if (!f) return NULL;
  if (fseek(f, -TAIL, SEEK_END) != 0) rewind(f);
  tail[fread(tail, 1, TAIL, f)] = 0;
  fclose(f);
  const char *at = strstr(tail, ".bin\"}]}");
  if (!at || at - tail <= HASH_DIGITS) return NULL;
  const char *hash = at - HASH_DIGITS;
  const bool ours = strspn(hash, "0123456789abcdef") == HASH_DIGITS && hash[-1] == '-';
  if (!ours || cag_asprintf(&name, "%s-%.*s.bin", stem, HASH_DIGITS, hash) < 0) return NULL;
  return name;
}

// Writes the data first, under a name derived from its contents, and renames the JSON last. So
// whenever the program is stopped, the JSON refers to its own data.
static int write_gltf_data(CagSession *s, const CagGltfData *data, const char *folder) {
  CagError io = {0};
  char *path = NULL;
  if (!data->name) return CAG_STATUS_OK;
  if (cag_asprintf(&path, "%s%s", folder, data->name) < 0) return CAG_STATUS_LIMIT;
  CagAtomicFile *f = cag_atomic_file_open(path, &io);
  cag_free(path);
  if (!f) return cag_session_fail_io(s, CAG_ERR_output_file, &io);
  cag_atomic_file_expect(f, data->size);
  cag_atomic_file_write(f, data->bytes, data->size);
  return commit(s, f);
}

// Commits both files, and removes the data of the previous JSON.
static int commit_gltf(CagSession *s, CagAtomicFile *f, const CagGltfData *data, const char *path,
                       const char *stem, const char *folder) {
  char *former = former_data(path, stem);
  const char *slash = former ? strrchr(former, '/') : NULL;
  const char *former_name = slash ? slash + 1 : former;
  int status = write_gltf_data(s, data, folder);
  if (status == CAG_STATUS_OK) status = commit(s, f);
  else cag_atomic_file_abort(f);
  if (status == CAG_STATUS_OK && former && (!data->name || strcmp(former_name, data->name) != 0))
    unlink(former);
  cag_free(former);
  return status;
}

// stem: the path without its extension, NULL if there can be no file beside it; folder: the part of
// it before the name.
static int write_gltf_files(CagSession *s, const Parts *parts, const char *path, const char *stem,
                            const char *folder) {
  CagError io = {0};
  CagError err = {0};
  CagGltfData data;
  CagAtomicFile *f = cag_atomic_file_open(path, &io);
  if (!f) return cag_session_fail_io(s, CAG_ERR_output_file, &io);
  const char *name = stem ? stem + strlen(folder) : NULL;
  int status = CAG_STATUS_OK;
  CagStatus made = cag_export_gltf(parts->items, parts->count, name, f, &data, &err);
  if (cag_session_checked(s, made, &err)) {
    cag_atomic_file_abort(f);
    status = cag_session_fail_geometry(s, &err);
  } else {
    cag_atomic_file_flush(f);
    // the commit of a failed file reports the reason
    status = !stem || cag_atomic_file_failed(f) ? commit(s, f)
                                                : commit_gltf(s, f, &data, path, stem, folder);
  }
  cag_free(data.name);
  cag_free(data.bytes);
  return status;
}

static int write_gltf(CagSession *s, const Parts *parts, const char *path) {
  struct stat at;
  const bool special = stat(path, &at) == 0 && !S_ISREG(at.st_mode); // a device or a pipe
  char *stem = NULL, *folder = NULL;
  if (!special && (!path_beside(path, "", &stem) || (stem && !(folder = cag_strdup(stem))))) {
    cag_free(stem);
    return fail_memory(s);
  }
  if (folder) {
    char *slash = strrchr(folder, '/');
    if (slash) slash[1] = 0;
    else folder[0] = 0;
  }
  int status = write_gltf_files(s, parts, path, stem, folder ? folder : "");
  cag_free(stem);
  cag_free(folder);
  return status;
}

// ending: extension of the accompanying file; NULL: none. use: of MeshUse.
static int export_meshes(CagSession *s, const char *path, MeshWriter write, const char *ending,
                         unsigned use) {
  Parts parts;
  int status = make_parts(s, use, &parts);
  if (status != CAG_STATUS_OK) return status;
  status = check_parts(s, &parts);
  if (status == CAG_STATUS_OK) {
    char *beside = NULL;
    MeshOutput m = {.parts = parts.items, .count = parts.count};
    status = ending && !path_beside(path, ending, &beside)
                 ? fail_memory(s)
                 : write_meshes(s, &m, path, beside, write);
    cag_free(beside);
  }
  free_parts(&parts);
  return status;
}

static int export_obj(CagSession *s, const char *path) {
  return export_meshes(s, path, write_obj, ".mtl", ONE_MATERIAL);
}
static int export_stl(CagSession *s, const char *path) {
  return export_meshes(s, path, write_stl, NULL, FOR_PRINTING);
}
static int export_ply(CagSession *s, const char *path) {
  return export_meshes(s, path, write_ply, NULL, 0);
}
static int export_glb(CagSession *s, const char *path) {
  return export_meshes(s, path, write_glb, NULL, ONE_MATERIAL);
}
static int export_gltf(CagSession *s, const char *path) {
  Parts parts;
  int status = make_parts(s, ONE_MATERIAL, &parts);
  if (status != CAG_STATUS_OK) return status;
  status = check_parts(s, &parts);
  if (status == CAG_STATUS_OK) status = write_gltf(s, &parts, path);
  free_parts(&parts);
  return status;
}
static int export_3mf(CagSession *s, const char *path) {
  return export_meshes(s, path, write_3mf, NULL, FOR_PRINTING);
}

// --- Scenes as text ---

static int export_text(CagSession *s, const char *path,
                       CagStatus (*write)(CagSession *s, CagAtomicFile *f, CagError *err)) {
  CagError io = {0};
  CagError err = {0};
  CagAtomicFile *f = cag_atomic_file_open(path, &io);
  if (!f) return cag_session_fail_io(s, CAG_ERR_output_file, &io);
  if (cag_session_checked(s, write(s, f, &err), &err)) {
    cag_atomic_file_abort(f);
    return cag_session_fail_geometry(s, &err);
  }
  return cag_atomic_file_commit(f, &io) ? CAG_STATUS_OK
                                        : cag_session_fail_io(s, CAG_ERR_output_file, &io);
}

static CagStatus write_pov(CagSession *s, CagAtomicFile *f, CagError *err) {
  CagPovOptions options = CAG_POV_OPTIONS_DEFAULT;
  // export_pov has checked the option.
  (void)cag_session_pov_csg(s, CAG_POV_CSG_GENERAL, &options.csg);
  return cag_export_pov(&s->scene, &options, f, err);
}
static CagStatus write_svg(CagSession *s, CagAtomicFile *f, CagError *err) {
  return cag_export_svg(&s->scene, 0, f, err);
}
static CagStatus write_json(CagSession *s, CagAtomicFile *f, CagError *err) {
  return cag_export_json(&s->scene, f, err);
}

static int export_pov(CagSession *s, const char *path) {
  CagPovCsg csg;
  return cag_session_pov_csg(s, CAG_POV_CSG_GENERAL, &csg) ? export_text(s, path, write_pov)
                                                           : CAG_STATUS_USAGE;
}
static int export_svg(CagSession *s, const char *path) { return export_text(s, path, write_svg); }
static int export_json(CagSession *s, const char *path) { return export_text(s, path, write_json); }

// --- Exact geometry ---

typedef CagStatus (*BrepWriter)(const CagBrep *b, const char *script, CagAtomicFile *f,
                                CagError *err);

// Lists the approximated shapes, because users of the format expect exact ones.
static void tell_approximate(const CagSession *s, const CagBrep *b) {
  for (size_t i = 0; s->options.messages && i < b->shape_count; i++)
    if (b->shapes[i].approximate)
      fprintf(s->options.messages, "note: %s has no exact form: approximated within %g mm\n",
              b->shapes[i].name, b->shapes[i].tolerance);
}

// Warns about shapes that consist of flat faces. Leaves room in the list of diagnostics for a later
// error.
static void warn_faceted(CagSession *s, const CagBrep *b) {
  for (size_t i = 0; i < b->shape_count; i++) {
    const CagBrepShape *shape = &b->shapes[i];
    char within[32];
    if (shape->facets == 0) continue;
    if (s->diagnostics.count + 1 >= CAG_DIAGNOSTICS_MAX) {
      s->diagnostics.dropped++;
      continue;
    }
    snprintf(within, sizeof within, "%.3g", fmax(shape->tolerance + shape->flatness, b->accuracy));
    CagDiagnostic *d = cag_diagnostics_add(
        &s->diagnostics, CAG_ERR_faceted_in_file, NULL, (CagSpan){0, 0},
        "%s is faceted in the file: %zu flat face%s, within %s mm of %s", shape->name,
        shape->facets, shape->facets == 1 ? "" : "s", within,
        shape->tolerance > 0 ? "its surfaces and the meshes among its operands" : "its mesh");
    d->severity = CAG_SEVERITY_WARNING;
    cag_diagnostic_set_help(d, shape->tolerance > 0
                                   ? "without meshes among the operands, its faces are exact"
                                   : "a mesh has no exact surfaces");
  }
}

static int write_brep(CagSession *s, const CagBrep *b, const char *path, BrepWriter write) {
  CagError io = {0};
  CagError err = {0};
  CagAtomicFile *f = cag_atomic_file_open(path, &io);
  if (!f) return cag_session_fail_io(s, CAG_ERR_output_file, &io);
  const char *script = s->scene.script ? s->scene.script : "", *slash = strrchr(script, '/');
  if (write(b, slash ? slash + 1 : script, f, &err)) {
    cag_atomic_file_abort(f);
    return cag_session_fail_geometry(s, &err);
  }
  int status = commit(s, f);
  if (status != CAG_STATUS_OK) return status;
  tell_approximate(s, b);
  warn_faceted(s, b);
  return status;
}

static int export_brep(CagSession *s, const char *path, CagBrepFormat format, BrepWriter write) {
  CagBrep b;
  CagError err = {0};
  const CagStatus made = cag_session_checked(
      s, cag_brep_of_scene(&s->scene, cag_session_kernel(s), format, &b, &err), &err);
  int status = !made ? write_brep(s, &b, path, write) : cag_session_fail_geometry(s, &err);
  cag_brep_free(&b);
  return status;
}

static int export_step(CagSession *s, const char *path) {
  return export_brep(s, path, CAG_BREP_STEP, cag_export_step);
}
static int export_iges(CagSession *s, const char *path) {
  return export_brep(s, path, CAG_BREP_IGES, cag_export_iges);
}

// --- Robots ---

// Finds the shown robot if there is exactly one. Otherwise adds a diagnostic.
static int find_robot(CagSession *s, const CagRobotValue **robot) {
  enum { NAMED = 8 };
  const CagRobotValue *found[NAMED];
  CagVm *vm = s->vm;
  CagValue *shown = cag_malloc((vm->shown_count + 1) * sizeof *shown);
  if (!shown) return CAG_STATUS_LIMIT;
  for (size_t i = 0; i < vm->shown_count; i++) shown[i] = vm->shown[i].value;
  size_t n = cag_urdf_robots(vm, shown, vm->shown_count, found, NAMED);
  cag_free(shown);
  *robot = found[0];
  if (n == 1) return CAG_STATUS_OK;
  const char *script = s->script ? s->script : "the session";
  CagString names = {0};
  for (size_t i = 0; i < n && i < NAMED; i++)
    cag_string_printf(&names, "%s%s", i > 0 ? ", " : "",
                      found[i]->name->length > 0 ? found[i]->name->bytes : "one without a name");
  CagDiagnostic *d =
      n == 0 ? cag_diagnostics_add(&s->diagnostics, CAG_ERR_urdf_no_robot, NULL, (CagSpan){0, 0},
                                   "%s shows no robot", script)
             : cag_diagnostics_add(&s->diagnostics, CAG_ERR_urdf_several, NULL, (CagSpan){0, 0},
                                   "%s shows %zu robots (%s%s), but a .urdf file describes one",
                                   script, n, names.bytes ? names.bytes : "",
                                   n > NAMED ? ", ..." : "");
  cag_diagnostic_set_help(
      d,
      n == 0
          ? "show a robot, as it is or by `posed`, such as show robot([revolute(a: 300)])"
          : "show only one; to select it by a param, use `param which = 0`, `show robots[which]`, and -D which=1");
  cag_string_free(&names);
  return CAG_STATUS_SCRIPT;
}

static int write_urdf_meshes(CagSession *s, const CagUrdf *u, const char *folder) {
  CagError io = {0};
  CagError err = {0};
  if (mkdir(folder, 0777) != 0 && errno != EEXIST) {
    cag_fail_io(&io, CAG_E_FILE, "the meshes of a .urdf file are written to this folder next to it",
                "cannot create the folder %s: %s", folder, strerror(errno));
    return cag_session_fail_io(s, CAG_ERR_output_file, &io);
  }
  int status = CAG_STATUS_OK;
  for (size_t i = 0; i < u->link_count; i++)
    for (const CagUrdfShape *m = u->links[i].shapes; m && status == CAG_STATUS_OK; m = m->next) {
      char *path = NULL;
      if (m->kind != CAG_URDF_MESH) continue;
      if (cag_asprintf(&path, "%s/%s", folder, m->file) < 0) return fail_memory(s);
      CagAtomicFile *f = cag_atomic_file_open(path, &io);
      cag_free(path);
      if (!f) return cag_session_fail_io(s, CAG_ERR_output_file, &io);
      if (!cag_export_urdf_mesh(m, f, &err)) {
        status = commit(s, f);
        continue;
      }
      cag_atomic_file_abort(f);
      status = cag_session_fail_geometry(s, &err);
    }
  return status;
}

// The meshes come first, so that a complete file never refers to missing ones.
static int write_urdf(CagSession *s, const CagUrdf *u, const char *path) {
  CagError io = {0};
  if (u->meshes && strcmp(path, "-") == 0) {
    CagDiagnostic *d = cag_diagnostics_add(
        &s->diagnostics, CAG_ERR_urdf_output, NULL, (CagSpan){0, 0},
        "the meshes of the links are written to files next to the .urdf file, which standard output does not allow");
    cag_diagnostic_set_help(d, "write to a file: -o arm.urdf");
    return CAG_STATUS_USAGE;
  }
  char *folder;
  if (!path_beside(path, "_meshes", &folder)) return fail_memory(s);
  CagAtomicFile *f = cag_atomic_file_open(path, &io);
  if (!f) {
    cag_free(folder);
    return cag_session_fail_io(s, CAG_ERR_output_file, &io);
  }
  const char *slash = folder ? strrchr(folder, '/') : NULL;
  CagError err = {0};
  int status = cag_export_urdf(u,
                               slash    ? slash + 1
                               : folder ? folder
                                        : "",
                               f, &err)
                   ? cag_session_fail_geometry(s, &err)
                   : CAG_STATUS_OK;
  if (status == CAG_STATUS_OK && u->meshes && folder) status = write_urdf_meshes(s, u, folder);
  cag_free(folder);
  if (status == CAG_STATUS_OK) return commit(s, f);
  cag_atomic_file_abort(f);
  return status;
}

static void free_urdf(void *u) { cag_urdf_free(u); }

static int export_urdf(CagSession *s, const char *path) {
  const CagRobotValue *robot;
  CagUrdf u = {0};
  CagUrdfHow how = {s->scene.tolerance, s->scene.usual_tolerance, s->scene.bounds,
                    s->scene.max_triangles, s->scene.interrupt};
  int status = find_robot(s, &robot);
  if (status != CAG_STATUS_OK) return status;
  CagCleanup cleanup;
  cag_cleanup_push(&cleanup, free_urdf, &u);
  status = cag_urdf_of_robot(s->vm, robot, &how, &u)
               ? write_urdf(s, &u, path)
               : cag_session_fail_geometry(s, &(CagError){.status = CAG_E_CALLBACK});
  cag_cleanup_run(&cleanup);
  return status;
}

// --- The table of formats ---

// X(name, story, function)
#define FORMATS(X)                                                                                 \
  X("obj", "mesh, Wavefront OBJ with its materials in an .mtl file next to it", export_obj)        \
  X("stl", "mesh, binary STL", export_stl)                                                         \
  X("ply", "mesh, binary PLY with normals, colors, and parameters", export_ply)                    \
  X("glb", "mesh, binary glTF 2.0 in meters with Y up", export_glb)                                \
  X("gltf", "mesh, glTF 2.0 with its data in a .bin file next to it", export_gltf)                 \
  X("3mf", "mesh, 3MF with objects, copies, and colors", export_3mf)                               \
  X("pov", "scene, POV-Ray 3.7 source that uses POV-Ray's own objects where possible", export_pov) \
  X("igs", "exact geometry, IGES 5.3 with curves, surfaces, and trimmed planes", export_iges)      \
  X("step", "exact geometry, STEP AP214 with solids, colors, and names", export_step)              \
  X("urdf", "robot, URDF with its meshes in meters in a folder next to it", export_urdf)           \
  X("svg", "drawing of curves and regions", export_svg)                                            \
  X("json", "data of the whole scene", export_json)

// Formats of shown images, which need no scene.
static int export_exr(CagSession *s, const char *path) {
  return cag_session_write_image(s, path, false, NULL);
}
static int export_png(CagSession *s, const char *path) {
  return cag_session_write_image(s, path, true, NULL);
}
#define IMAGE_FORMATS(X)                                                                           \
  X("exr", "image that is shown, OpenEXR with all channels as 32-bit floats", export_exr)          \
  X("png", "image that is shown, PNG", export_png)

static const struct Format {
  const char *name, *story;
  ExportFunction write;
  bool of_image;
} formats[] = {
#define X(name, story, function) {name, story, function, false},
    FORMATS(X)
#undef X
#define X(name, story, function) {name, story, function, true},
        IMAGE_FORMATS(X)
#undef X
};
#define FORMAT_COUNT (sizeof formats / sizeof *formats)

static const char FORMAT_HELP[] =
#define X(name, story, function) " " name
    "use --format to choose a format:" FORMATS(X) IMAGE_FORMATS(X);
#undef X

const char *const *cag_export_formats(void) {
  static const char *const names[] = {
#define X(name, story, function) name,
      FORMATS(X) IMAGE_FORMATS(X)
#undef X
          NULL};
  return names;
}

static const struct Format *find_format(const char *name) {
  for (size_t i = 0; i < FORMAT_COUNT; i++)
    if (strcasecmp(formats[i].name, name) == 0) return &formats[i];
  return NULL;
}

const char *cag_export_format_story(const char *format) {
  const struct Format *f = find_format(format);
  return f ? f->story : NULL;
}

// Drawings of a section have the outlines of the cut.
static bool is_drawing(const struct Format *f) {
  static const char *const names[] = {"svg", "dxf", "pdf"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++)
    if (!strcmp(f->name, names[i])) return true;
  return false;
}

typedef struct Output {
  const struct Format *format;
  const char *path;
} Output;

static int write_output(CagSession *s, void *context) {
  const Output *o = context;
  return o->format->write(s, o->path);
}

static int export_scene(CagSession *s, const char *path, const char *format) {
  const char *slash = strrchr(path, '/');
  const char *dot = strrchr(slash ? slash : path, '.');
  const char *name = format ? format : dot ? dot + 1 : "";
  const struct Format *f = find_format(name);
  if (!f) {
    CagDiagnostic *d =
        *name ? cag_diagnostics_add(&s->diagnostics, CAG_ERR_format_unknown, NULL, (CagSpan){0, 0},
                                    "unknown format `%s`", name)
              : cag_diagnostics_add(&s->diagnostics, CAG_ERR_format_unknown, NULL, (CagSpan){0, 0},
                                    "%s has no extension that determines the format", path);
    cag_diagnostic_set_help(d, FORMAT_HELP);
    return CAG_STATUS_USAGE;
  }
  if (f->of_image) return f->write(s, path);
  int status = is_drawing(f) ? cag_session_build_drawing(s) : cag_session_build_scene(s);
  if (status != CAG_STATUS_OK) return status;
  const CagCamera *picture = f->write == export_pov ? &s->scene.cameras[0] : NULL;
  cag_session_begin_meshes(s, picture);
  status = cag_session_geometry(s, write_output, &(Output){f, path});
  cag_session_end_meshes(s);
  return status;
}

int cag_session_export(CagSession *s, const char *path, const char *format) {
  if (!cag_session_begin(s)) return CAG_STATUS_USAGE;
  return cag_session_end(s, export_scene(s, path, format));
}
