// Robots from URDF files.
//
// Meshes are read as read_mesh reads them, by the same rules of where a script's files lie: names
// are taken from the folder of the .urdf file, and those of ROS packages are looked for near it.

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"
#include "interp/builtin/robots.h"
#include "interp/builtin/solids.h"
#include "interp/builtin/support.h"
#include "interp/formats/urdf_read.h"
#include "interp/vm/vm.h"

// Held, with what it owns, until the call ends.
typedef struct Import {
  CagCall *call;
  const char *path; // of the .urdf file
  const char *tip, *base;
  bool shapes;
  CagUrdfTree tree; // its arena holds names of meshes as well
  CagUrdfRows rows;
  CagRobotLink *plain;
} Import;

// --- Meshes ---

static bool begins(const char *text, const char *with) {
  return strncmp(text, with, strlen(with)) == 0;
}

static bool ends_with(const char *file, const char *const *endings, size_t n) {
  const char *dot = strrchr(file, '.');
  for (size_t i = 0; dot && i < n; i++)
    if (!strcasecmp(dot, endings[i])) return true;
  return false;
}

// glTF's endings are the last two.
static const char *const mesh_endings[] = {".stl", ".obj", ".ply", ".gltf", ".glb"};
static bool can_be_read(const char *file) { return ends_with(file, mesh_endings, 5); }
static bool is_gltf(const char *file) { return ends_with(file, mesh_endings + 3, 2); }

static bool fail_mesh(const Import *m, const CagUrdfBody *b, const char *why, const char *help) {
  cag_fail_call(m->call, 0, CAG_ERR_urdf_mesh, "cannot read the mesh \"%.120s\" (%s, line %ld): %s",
                b->file, m->tree.file, b->line, why);
  return cag_fail_help(m->call->vm, "%s; to read only the chain, use `shapes: false`", help);
}

// Reads a mesh at this place. *found is false where there is no such file; the error is set then
// too.
static bool read_at(const Import *m, const char *path, CagValue *out, bool *found) {
  CagVm *vm = m->call->vm;
  size_t rows;
  CagValue text = cag_text_c(vm, path);
  CagCall call = {vm, cag_builtin_rows(cag_builtin_find("read_mesh"), &rows), &text, 1,
                  &vm->core_error};
  const size_t held = vm->held_count;
  const bool ok = call.builtin->function(&call, out);
  cag_vm_release_held(vm, held);
  if (ok) return *found = true;
  *found = vm->errors.count == 0 || vm->errors.items[0].id != CAG_ERR_file;
  return false;
}

// Where a name may lie, as printf patterns of the folder of the .urdf file, the package and the
// rest of the name.
static const char *const package_places[] = {"%1$s%3$s", "%1$s%2$s/%3$s", "%1$s../%3$s",
                                             "%1$s../../%2$s/%3$s"};
static const char *const plain_places[] = {"%1$s%3$s"};

static bool read_near(Import *m, const CagUrdfBody *b, const char *package, int package_size,
                      const char *rest, CagValue *out) {
  const char *const *places = package ? package_places : plain_places;
  size_t n = package ? sizeof package_places / sizeof *package_places : 1;
  const char *slash = strrchr(m->path, '/');
  CagArena *texts = &m->tree.arena;
  const char *folder = cag_arena_copy(texts, m->path, slash ? (size_t)(slash + 1 - m->path) : 0);
  const char *name = cag_arena_copy(texts, package ? package : "", (size_t)package_size);
  // The longest place has three of them and "../../" and "/".
  const size_t room = strlen(folder) + strlen(name) + strlen(rest) + 16;
  char *path = cag_arena_alloc(texts, room);
  for (size_t i = 0; i < n; i++) {
    bool found;
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
    snprintf(path, room, places[i], folder, name, rest);
#pragma GCC diagnostic pop
    const bool ok = read_at(m, path, out, &found);
    if (ok || found) return ok;
    cag_vm_clear_error(m->call->vm);
  }
  return fail_mesh(m, b, "the file does not exist in the folders that the script can read",
                   package
                       ? "put the package's folders next to the .urdf file, as in meshes/arm.stl"
                       : "put the file at its path relative to the folder of the .urdf file");
}

// package://NAME/REST; else a path from the folder of the .urdf file. Absolute paths are of another
// machine: their last name is looked for beside the file.
static bool read_file(Import *m, const CagUrdfBody *b, CagValue *out) {
  static const char package[] = "package://", model[] = "model://", file[] = "file://";
  const char *name = b->file;
  if (!can_be_read(name))
    return fail_mesh(m, b, "meshes are read from .stl .obj .ply .gltf .glb",
                     "convert it, or add a <collision> with such a mesh to the link");
  if (begins(name, package) || begins(name, model)) {
    name = strstr(name, "://") + 3;
    const char *slash = strchr(name, '/');
    if (slash) return read_near(m, b, name, (int)(slash - name), slash + 1, out);
    return fail_mesh(m, b, "the file's name is missing after the package's name",
                     "write package://NAME/meshes/arm.stl");
  }
  if (begins(name, file)) name += strlen(file);
  else if (strstr(name, "://"))
    return fail_mesh(m, b, "files are not downloaded",
                     "put the file next to the .urdf file and use its relative path");
  const char *slash = strrchr(name, '/');
  return read_near(m, b, NULL, 0, name[0] == '/' && slash ? slash + 1 : name, out);
}

// --- Bodies ---

static bool make_body(Import *m, const CagUrdfBody *b, CagTransform *place, CagValue *out) {
  CagCall *call = m->call;
  CagSolid *s = NULL;
  const double *size = b->size;
  const CagVec3 sides = cag_vec3(size[0], size[1], size[2]);
  switch (b->kind) {
  case CAG_URDF_BODY_BOX:
    return cag_solid_result(call, cag_solid_box(sides, true, &s, call->err), &s, out);
  case CAG_URDF_BODY_CYLINDER: {
    CagTransform down = cag_translate(cag_vec3(0, 0, -size[1] / 2));
    *place = cag_transform_multiply(place, &down);
    CagStatus status = cag_solid_cylinder(size[1], size[0], size[0], &s, call->err);
    return cag_solid_result(call, status, &s, out);
  }
  case CAG_URDF_BODY_SPHERE:
    return cag_solid_result(call, cag_solid_sphere(size[0], &s, call->err), &s, out);
  case CAG_URDF_BODY_MESH: break;
  }
  // glTF says its own unit, which the reader has made millimeters.
  const double unit = is_gltf(b->file) ? 1 : 1000;
  CagTransform scale = cag_transform_identity();
  for (int i = 0; i < 3; i++) scale.m[i][i] = b->scale[i] * unit;
  scale.planar = false;
  *place = cag_transform_multiply(place, &scale);
  return read_file(m, b, out);
}

static CagRecord *material_of(CagVm *vm, const CagUrdfBody *b) {
  static const char *const names[] = {"color", "name", "transmission"};
  const double color[3] = {b->color.r, b->color.g, b->color.b};
  CagValue values[] = {cag_vector(vm, color, 3), cag_text_c(vm, b->material ? b->material : ""),
                       cag_number(1 - b->alpha)};
  bool named = b->material && *b->material;
  if (!b->colored) return NULL;
  if (b->alpha < 1) {
    if (!named) values[1] = cag_text_c(vm, "material");
    return CAG_AS_RECORD(cag_record_new(vm, names, values, 3));
  }
  return CAG_AS_RECORD(cag_record_new(vm, names, values, named ? 2 : 1));
}

// What is drawn of a link: its visual bodies, or in their stead those for collisions where a visual
// one is a mesh that cannot be read (Collada, mostly).
static const CagUrdfBody *drawn_bodies(const CagUrdfNode *n) {
  for (const CagUrdfBody *b = n->visuals; b; b = b->next)
    if (b->kind == CAG_URDF_BODY_MESH && !can_be_read(b->file) && n->collisions)
      return n->collisions;
  return n->visuals;
}

static bool add_bodies(Import *m, const CagUrdfPlaced *placed, CagBuilder *into) {
  CagVm *vm = m->call->vm;
  const CagUrdfNode *n = &m->tree.nodes[placed->node];
  for (const CagUrdfBody *b = drawn_bodies(n); b; b = b->next) {
    CagTransform place = cag_transform_multiply(&placed->place, &b->place);
    CagValue body, moved;
    if (!cag_keep_going(vm) || !make_body(m, b, &place, &body) ||
        !cag_transform_apply(vm, &place, body, &moved))
      return false;
    CagShape *shape = CAG_AS_SHAPE(moved);
    shape->material = material_of(vm, b);
    shape->name = CAG_AS_TEXT(cag_text_c(vm, n->name));
    if (!cag_builder_add(vm, into, moved)) return false;
  }
  return true;
}

// --- Links ---

// The shape of a row, named as its link: none, one body, or a group.
static bool make_shape(Import *m, const CagUrdfRow *row, CagValue *out) {
  CagVm *vm = m->call->vm;
  CagBuilder *bodies = cag_builder_new(vm);
  *out = cag_none();
  for (size_t i = 0; i < row->count; i++)
    if (!add_bodies(m, &m->rows.placed[row->first + i], bodies)) return false;
  CagValue list = cag_builder_finish(vm, bodies);
  const CagList *items = CAG_AS_LIST(list);
  if (items->length == 0) return true;
  if (items->length == 1) {
    *out = items->as.items[0];
    return true;
  }
  *out = cag_group_value(vm, list);
  CAG_AS_SHAPE(*out)->name =
      CAG_AS_TEXT(cag_text_c(vm, m->tree.nodes[m->rows.placed[row->first].node].name));
  return true;
}

static bool make_links(Import *m, CagValue *list) {
  CagBuilder *links = cag_builder_new(m->call->vm);
  for (size_t i = 0; i < m->rows.row_count; i++) {
    CagValue shape;
    m->plain[i] = m->rows.rows[i].link;
    if (!make_shape(m, &m->rows.rows[i], &shape) ||
        !cag_builder_add(m->call->vm, links, cag_link_value(m->call->vm, &m->plain[i], shape)))
      return false;
  }
  *list = cag_builder_finish(m->call->vm, links);
  return true;
}

static bool make_robot(Import *m, CagValue *result) {
  CagCall *call = m->call;
  CagRobot *robot = NULL;
  CagValue list;
  m->plain = cag_hold_array(call, m->rows.row_count, sizeof *m->plain);
  if (!make_links(m, &list)) return false;
  CagText *name = CAG_AS_TEXT(cag_text_c(call->vm, m->tree.name));
  CagRobotSpec spec = {.links = m->plain,
                       .link_count = m->rows.row_count,
                       .convention = CAG_ROBOT_CLASSIC,
                       .base = m->rows.base,
                       .tool = m->rows.tool};
  if (!cag_geometry_ok(call, cag_robot_new(&spec, &robot, call->err))) return false;
  *result = cag_robot_value(call->vm, robot, name, list);
  return true;
}

// --- The call ---

static bool read_chain(Import *m) {
  CagCall *call = m->call;
  char *bytes;
  size_t size, *chain = NULL, n = 0;
  const char *slash = strrchr(m->path, '/');
  if (!cag_vm_open_file(call, 0, m->path, &bytes, &size)) return false;
  cag_hold(call, bytes);
  CagStatus status = cag_urdf_read(slash ? slash + 1 : m->path, bytes, size, &m->tree, call->err);
  cag_release_held(call, bytes);
  if (!status) status = cag_urdf_chain(&m->tree, m->base, m->tip, &chain, &n, call->err);
  cag_hold_for(call, cag_free, chain);
  if (!status)
    status = cag_urdf_rows(&m->tree, m->base ? m->base : m->tip, chain, n, m->shapes, &m->rows,
                           call->err);
  return cag_geometry_ok(call, status);
}

static void release_import(void *import) {
  Import *m = import;
  cag_urdf_rows_free(&m->rows);
  cag_urdf_tree_free(&m->tree);
}

bool cag_robot_files_read_urdf(CagCall *call, const struct cag_robot_files_read_urdf *a,
                               CagValue *result) {
  Import *m = cag_hold_array(call, 1, sizeof *m);
  cag_hold_for(call, release_import, m);
  m->call = call;
  m->path = a->path;
  m->tip = a->tip;
  m->base = a->base;
  m->shapes = a->shapes;
  return read_chain(m) && make_robot(m, result);
}
