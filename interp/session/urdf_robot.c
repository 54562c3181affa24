// Converts a robot to the links and joints of a URDF file.
//
// The walk goes from the base to the tool. Besides the current link, it tracks the transform from
// that link's frame to the current frame, which contains the constant part of rows after their
// joints. The origin of the next joint or fixed link absorbs it.

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"
#include "interp/builtin/robots.h"
#include "interp/session/scene_build.h"
#include "interp/session/urdf_robot.h"
#include "interp/vm/vm.h"

// Bytes of a name; longer names are replaced by generated ones.
enum { NAME_ROOM = 120 };

typedef struct Walk {
  CagCall call; // for errors, and to collect shapes
  const CagUrdfHow *how;
  CagUrdf *u;
  const CagRobotValue *value;
  size_t link;     // the current link
  CagTransform at; // from its frame to the current one
  bool plain;      // no link has a shape
  double size;     // of the default drawing
  size_t triangles;
} Walk;

// --- Robots among the shown values ---

typedef struct Found {
  CagVm *vm;
  const CagRobotValue **out;
  size_t count, room;
} Found;

static void keep_robot(Found *f, const CagRobotValue *r) {
  for (size_t i = 0; i < f->count && i < f->room; i++)
    if (f->out[i] == r) return;
  if (f->count < f->room) f->out[f->count] = r;
  f->count++;
}

static void find_robots(Found *f, CagValue v) {
  if (v.type == CAG_ROBOT) keep_robot(f, CAG_AS_ROBOT(v));
  if (v.type != CAG_LIST && v.type != CAG_GROUP) return;
  const CagShape *shape = v.type == CAG_GROUP ? CAG_AS_SHAPE(v) : NULL;
  if (shape && shape->hidden) return;
  if (shape && shape->drawn) {
    keep_robot(f, shape->drawn);
    return;
  }
  const CagList *items = shape ? shape->as.items : CAG_AS_LIST(v);
  if (items->dim != 0) return; // numbers
  for (size_t i = 0; i < items->length; i++) find_robots(f, items->as.items[i]);
}

size_t cag_urdf_robots(CagVm *vm, const CagValue *shown, size_t n, const CagRobotValue **out,
                       size_t room) {
  Found f = {vm, out, 0, room};
  for (size_t i = 0; i < n; i++) find_robots(&f, shown[i]);
  return f.count;
}

// --- Names ---

static char *text_of(CagUrdf *u, const char *text) {
  return cag_arena_copy(&u->arena, text, strlen(text));
}

// Makes a name of letters, digits, - . and _, which every reader accepts, also in file names.
// Letters beyond ASCII are kept. The first character is neither . nor -.
static char *plain_name(CagUrdf *u, const char *text) {
  char *name = text_of(u, text);
  for (char *c = name; *c; c++) {
    bool letter = (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') || *c == '_' ||
                  (unsigned char)*c >= 0x80;
    bool inner = (*c >= '0' && *c <= '9') || *c == '-' || *c == '.';
    if (!letter && !(inner && c > name)) *c = '_';
  }
  return name;
}

// Tests for names that the walk generates.
static bool is_reserved(const char *name) {
  return !strcmp(name, "world") || !strcmp(name, "base_link") || !strcmp(name, "tool");
}

static bool is_taken(const CagUrdf *u, const char *name) {
  for (size_t i = 0; i < u->link_count; i++)
    if (!strcmp(u->links[i].name, name)) return true;
  return is_reserved(name);
}

// Returns the name of the link's shape, if it has one.
static char *link_name(Walk *w, size_t i) {
  CagUrdf *u = w->u;
  char wanted[NAME_ROOM], name[NAME_ROOM + 32];
  CagValue shape = CAG_AS_LINK(w->value->links->as.items[i])->shape;
  const CagText *said = cag_is_shape(shape) ? CAG_AS_SHAPE(shape)->name : NULL;
  if (said && said->length > 0 && said->length < sizeof wanted)
    snprintf(wanted, sizeof wanted, "%s", plain_name(u, said->bytes));
  else snprintf(wanted, sizeof wanted, "link_%zu", i + 1);
  snprintf(name, sizeof name, "%s", wanted);
  for (size_t k = 2; is_taken(u, name); k++) snprintf(name, sizeof name, "%s_%zu", wanted, k);
  return text_of(u, name);
}

// --- Materials ---

static bool same_material(const CagUrdfMaterial *a, const CagUrdfMaterial *b) {
  return !strcmp(a->name, b->name) && a->color.r == b->color.r && a->color.g == b->color.g &&
         a->color.b == b->color.b && a->alpha == b->alpha;
}

// Returns the index of the material. Different colors with the same name get different names.
static size_t keep_material(CagUrdf *u, const char *said, CagColor color, double alpha) {
  CagUrdfMaterial m = {plain_name(u, said), color, alpha};
  const char *wanted = m.name;
  for (size_t k = 1;; k++) {
    size_t i = 0;
    while (i < u->material_count && strcmp(u->materials[i].name, m.name) != 0) i++;
    if (i < u->material_count && same_material(&u->materials[i], &m)) return i;
    if (i == u->material_count) break;
    char numbered[NAME_ROOM + 32];
    snprintf(numbered, sizeof numbered, "%s_%zu", wanted, k + 1);
    m.name = text_of(u, numbered);
  }
  if (u->material_count == u->material_room) {
    size_t room = u->material_room ? 2 * u->material_room : 16;
    CagUrdfMaterial *more = cag_arena_alloc(&u->arena, room * sizeof *more);
    if (u->material_count) memcpy(more, u->materials, u->material_count * sizeof *more);
    u->materials = more;
    u->material_room = room;
  }
  u->materials[u->material_count] = m;
  return u->material_count++;
}

// --- Shapes ---

static CagUrdfShape *add_shape(CagUrdf *u, size_t link, CagUrdfShapeKind kind) {
  CagUrdfLink *l = &u->links[link];
  CagUrdfShape *s = cag_arena_alloc(&u->arena, sizeof *s);
  s->kind = kind;
  s->place = cag_transform_identity();
  *l->last_shape = s;
  l->last_shape = &s->next;
  return s;
}

// File systems may be case-insensitive.
static bool file_is_taken(const CagUrdf *u, const char *file) {
  for (size_t i = 0; i < u->link_count; i++)
    for (const CagUrdfShape *s = u->links[i].shapes; s; s = s->next)
      if (s->file && !strcasecmp(s->file, file)) return true;
  return false;
}

// Returns the name of the next mesh of a link: foot.stl, foot_2.stl ...
static char *file_name(CagUrdf *u, const char *link) {
  char file[200];
  snprintf(file, sizeof file, "%s.stl", link);
  for (size_t k = 2; file_is_taken(u, file); k++)
    snprintf(file, sizeof file, "%s_%zu.stl", link, k);
  return text_of(u, file);
}

static bool mesh_of(Walk *w, CagScene *scene, const CagItem *item, CagMesh **out) {
  CagError *err = w->call.err;
  scene->tolerance = w->how->tolerance;
  scene->usual_tolerance = w->how->usual_tolerance;
  scene->max_triangles = w->how->max_triangles;
  scene->interrupt = w->how->interrupt;
  scene->bounds = w->how->bounds;
  CagStatus status = cag_item_mesh(scene, item, out, err);
  if (status) return cag_geometry_ok(&w->call, status);
  w->triangles += (*out)->triangle_count;
  if (w->triangles <= w->how->max_triangles) return !w->call.vm->failed;
  cag_mesh_release(*out);
  *out = NULL;
  cag_fail(err, CAG_E_LIMIT, CAG_ERR_limit_triangles, "", -1,
           "the meshes have more than the %zu triangles allowed (--max-triangles)",
           w->how->max_triangles);
  return cag_geometry_ok(&w->call, CAG_E_LIMIT);
}

static double density_of(CagValue leaf) {
  const CagRecord *m = CAG_AS_SHAPE(leaf)->material;
  CagValue said = m ? cag_record_get(m, "density") : cag_unset();
  return said.type == CAG_NUMBER && said.as.number > 0 && isfinite(said.as.number)
             ? said.as.number
             : CAG_URDF_DENSITY;
}

static const char *material_name(CagValue leaf) {
  const CagRecord *m = CAG_AS_SHAPE(leaf)->material;
  CagValue said = m ? cag_record_get(m, "name") : cag_unset();
  const CagText *name = said.type == CAG_TEXT ? CAG_AS_TEXT(said) : NULL;
  return name && name->length > 0 && name->length < NAME_ROOM ? name->bytes : "material";
}

// Adds the single item of a leaf as a mesh of the link, and its mass.
static bool add_item(Walk *w, CagScene *scene, CagValue leaf) {
  CagUrdf *u = w->u;
  CagUrdfLink *l = &u->links[w->link];
  const CagItem *item = &scene->items[0];
  const CagMaterial *material = &scene->materials[item->material];
  CagMesh *mesh = NULL;
  CagUrdfMass mass;
  if (!mesh_of(w, scene, item, &mesh)) return false;
  if (mesh->triangle_count == 0) {
    cag_mesh_release(mesh);
    return true;
  }
  char *file = file_name(u, l->name);
  CagUrdfShape *s = add_shape(u, w->link, CAG_URDF_MESH);
  s->file = file;
  s->mesh = mesh;
  s->place = w->at;
  s->material =
      keep_material(u, material_name(leaf), material->color, 1 - fmin(1, material->transmission));
  u->meshes = true;
  CagStatus status = cag_urdf_item_mass(item, density_of(leaf), &mass, w->call.err);
  if (!cag_geometry_ok(&w->call, status)) return false;
  mass.center = cag_transform_point(&w->at, mass.center);
  CagUrdfMass turned = mass;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      turned.inertia[i][j] = 0;
      for (int k = 0; k < 3; k++)
        for (int n = 0; n < 3; n++)
          turned.inertia[i][j] += w->at.m[i][k] * mass.inertia[k][n] * w->at.m[j][n];
    }
  cag_urdf_mass_join(&l->mass, &turned);
  return !w->call.vm->failed;
}

static bool is_body(CagValue leaf) { return leaf.type != CAG_CURVE && !CAG_AS_SHAPE(leaf)->hidden; }

// Adds the shapes in the current frame. Curves are used only if there is nothing else.
static bool add_shapes(Walk *w, CagValue shape) {
  CagVm *vm = w->call.vm;
  if (shape.type == CAG_NONE) return true;
  CagBuilder *builder = cag_builder_new(vm);
  if (!cag_shapes_collect(&w->call, shape, builder)) return false;
  const CagList *leaves = CAG_AS_LIST(cag_builder_finish(vm, builder));
  bool bodies = false, ok = true;
  for (size_t i = 0; i < leaves->length; i++) bodies |= is_body(leaves->as.items[i]);
  for (size_t i = 0; ok && i < leaves->length; i++) {
    CagValue leaf = leaves->as.items[i];
    if (bodies && !is_body(leaf)) continue;
    CagScene scene;
    CagShown shown = {.value = leaf};
    if (!cag_keep_going(vm) || !cag_scene_from_values(vm, &shown, 1, &scene, NULL)) return false;
    if (scene.item_count > 0) ok = add_item(w, &scene, leaf); // labels are not items
    cag_scene_free(&scene);
  }
  return ok;
}

// --- Plain robots (as robots_show.c draws them at home) ---

static void add_plain(Walk *w, CagUrdfShape *s, const double color[3]) {
  CagUrdfMass mass = cag_urdf_plain_mass(s, CAG_URDF_DENSITY);
  s->material = keep_material(w->u, "plain", (CagColor){color[0], color[1], color[2]}, 1);
  cag_urdf_mass_join(&w->u->links[w->link].mass, &mass);
}

static void add_cylinder(Walk *w, CagVec3 p, CagVec3 q, double radius, const double color[3]) {
  CagVec3 z = cag_unit(cag_sub(q, p));
  double length = cag_norm(cag_sub(q, p));
  CagError err;
  if (!w->plain || length <= CAG_PLAIN_SHORT * w->size) return;
  CagVec3 side = fabs(z.x) < 0.9 ? cag_vec3(1, 0, 0) : cag_vec3(0, 1, 0);
  CagUrdfShape *s = add_shape(w->u, w->link, CAG_URDF_CYLINDER);
  CagVec3 x = cag_cross(z, side);
  if (cag_axes(cag_lerp(p, q, 0.5), x, cag_cross(z, x), &s->place, &err)) return;
  s->size[0] = radius;
  s->size[1] = length;
  add_plain(w, s, color);
}

static void add_rod(Walk *w, CagVec3 p, CagVec3 q) {
  static const double color[3] = CAG_PLAIN_ROD_COLOR;
  add_cylinder(w, p, q, CAG_PLAIN_ROD_RADIUS * w->size, color);
}

static const double drum_color[3] = CAG_PLAIN_DRUM_COLOR;

static void add_drum(Walk *w, double z) {
  double half = CAG_PLAIN_DRUM_LENGTH / 2 * w->size;
  add_cylinder(w, cag_vec3(0, 0, z - half), cag_vec3(0, 0, z + half),
               CAG_PLAIN_DRUM_RADIUS * w->size, drum_color);
}

static void add_slide(Walk *w, const CagTransform *place) {
  if (!w->plain) return;
  CagUrdfShape *s = add_shape(w->u, w->link, CAG_URDF_BOX);
  s->place = *place;
  s->size[0] = s->size[1] = CAG_PLAIN_SLIDE_SIDE * w->size;
  s->size[2] = CAG_PLAIN_DRUM_LENGTH * w->size;
  add_plain(w, s, drum_color);
}

static void add_foot(Walk *w) {
  static const double color[3] = CAG_PLAIN_FOOT_COLOR;
  double top = -CAG_PLAIN_DRUM_LENGTH / 2 * w->size;
  add_cylinder(w, cag_vec3(0, 0, top - CAG_PLAIN_FOOT_HEIGHT * w->size), cag_vec3(0, 0, top),
               CAG_PLAIN_FOOT_RADIUS * w->size, color);
}

static CagVec3 origin_of(const CagTransform *t) {
  return cag_vec3(t->m[0][3], t->m[1][3], t->m[2][3]);
}

// --- Links and joints ---

static size_t add_link(CagUrdf *u, char *name) {
  CagUrdfLink *l = &u->links[u->link_count];
  l->name = name;
  l->last_shape = &l->shapes;
  return u->link_count++;
}

// Adds a joint from the current frame to a new link, and continues from there.
static CagUrdfJoint *go_on(Walk *w, const char *type, char *joint, char *link) {
  CagUrdf *u = w->u;
  CagUrdfJoint *j = &u->joints[u->joint_count++];
  *j = (CagUrdfJoint){.name = joint, .type = type, .parent = w->link, .origin = w->at};
  w->link = j->child = add_link(u, link);
  w->at = cag_transform_identity();
  return j;
}

static char *numbered(CagUrdf *u, const char *format, size_t n)
    __attribute__((format(printf, 2, 0)));
static char *numbered(CagUrdf *u, const char *format, size_t n) {
  char text[48];
  snprintf(text, sizeof text, format, n);
  return text_of(u, text);
}

static void move_on(Walk *w, const CagTransform *t) { w->at = cag_transform_multiply(&w->at, t); }

// Adds the prismatic half of a screw, which comes before the revolute one.
static void add_screw(Walk *w, const CagRobotLink *l, char *turning, size_t joint) {
  CagUrdf *u = w->u;
  char *name = numbered(u, "joint_%zu_slide", joint);
  CagUrdfJoint *j = go_on(w, "prismatic", name, numbered(u, "screw_%zu", joint));
  double a = l->screw * l->low, b = l->screw * l->high;
  j->low = fmin(a, b);
  j->high = fmax(a, b);
  j->rate = fabs(l->screw) * (l->speed > 0 ? l->speed : CAG_URDF_TURN_RATE);
  j->effort = CAG_URDF_EFFORT;
  j->mimic = turning;
  j->multiplier = l->screw;
}

static void add_joint(Walk *w, const CagRobotLink *l, size_t link, size_t joint) {
  CagUrdf *u = w->u;
  bool turns = l->kind == CAG_JOINT_REVOLUTE;
  bool modified = w->value->robot->convention == CAG_ROBOT_MODIFIED;
  CagTransform across = modified ? cag_mdh(0, 0, l->a, l->alpha) : cag_dh(0, 0, l->a, l->alpha);
  CagTransform along = cag_dh(l->theta, l->d, 0, 0);
  if (modified) {
    add_rod(w, origin_of(&w->at), cag_transform_point(&w->at, cag_vec3(l->a, 0, 0)));
    move_on(w, &across);
  }
  if (!turns) add_slide(w, &w->at);
  // Rotations about z and translations along it commute with the joint's own motion, so they may
  // precede it.
  move_on(w, &along);
  char *name = numbered(u, "joint_%zu", joint);
  if (l->screw != 0) add_screw(w, l, name, joint);
  CagUrdfJoint *j = go_on(w, turns ? "revolute" : "prismatic", name, link_name(w, link));
  j->low = l->low;
  j->high = l->high;
  j->rate = l->speed > 0 ? l->speed : turns ? CAG_URDF_TURN_RATE : CAG_URDF_SLIDE_RATE;
  j->effort = l->effort > 0 ? l->effort : CAG_URDF_EFFORT;
  if (turns && w->plain) add_drum(w, -l->d);
  add_rod(w, cag_vec3(0, 0, -l->d - (turns ? l->screw : 1) * l->home), cag_vec3(0, 0, 0));
  if (modified) return;
  add_rod(w, cag_vec3(0, 0, 0), cag_vec3(l->a, 0, 0));
  move_on(w, &across);
}

static void add_fixed(Walk *w, const CagTransform *t, char *joint, char *link) {
  add_rod(w, origin_of(&w->at), cag_transform_point(&w->at, origin_of(t)));
  move_on(w, t);
  go_on(w, "fixed", joint, link);
}

static bool is_identity(const CagTransform *t) {
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      if (t->m[i][j] != (i == j)) return false;
  return true;
}

static void begin(Walk *w) {
  const CagRobot *r = w->value->robot;
  CagUrdf *u = w->u;
  w->at = cag_transform_identity();
  w->link = add_link(u, text_of(u, is_identity(&r->base) ? "base_link" : "world"));
  if (is_identity(&r->base)) return;
  w->at = r->base;
  go_on(w, "fixed", text_of(u, "base_joint"), text_of(u, "base_link"));
}

// Tests whether no link has a shape, and computes the size of the default drawing.
static bool measure_plain(Walk *w) {
  const CagRobotValue *v = w->value;
  const CagRobot *r = v->robot;
  double q[CAG_ROBOT_JOINTS_MAX], length = 0;
  for (size_t i = 0; i < r->link_count; i++)
    if (CAG_AS_LINK(v->links->as.items[i])->shape.type != CAG_NONE) return true;
  CagVec3 *points = cag_malloc((2 * r->link_count + 2) * sizeof *points);
  if (!points)
    return cag_fail_call(&w->call, -1, CAG_ERR_limit_memory, "needs more memory than is available");
  cag_robot_home(r, q);
  size_t n = cag_robot_skeleton(r, q, points);
  for (size_t i = 1; i < n; i++) length += cag_norm(cag_sub(points[i], points[i - 1]));
  cag_free(points);
  w->plain = true;
  w->size = length > 0 ? length : 1;
  return true;
}

bool cag_urdf_of_robot(CagVm *vm, const CagRobotValue *robot, const CagUrdfHow *how, CagUrdf *out) {
  const CagRobot *r = robot->robot;
  size_t rows, joint = 0, most = 2 * r->link_count + 3; // a screw is two joints
  *out = (CagUrdf){.coupled = r->coupling != NULL};
  Walk w = {
      .call = {vm, cag_builtin_rows(cag_builtin_find("posed"), &rows), NULL, 0, &vm->core_error},
      .how = how,
      .u = out,
      .value = robot};
  out->name = robot->name->length > 0 ? text_of(out, robot->name->bytes) : "robot";
  out->links = cag_arena_alloc(&out->arena, most * sizeof *out->links);
  out->joints = cag_arena_alloc(&out->arena, most * sizeof *out->joints);
  if (!measure_plain(&w)) return false;
  begin(&w);
  add_foot(&w);
  for (size_t i = 0; i < r->link_count; i++) {
    const CagRobotLink *l = &r->links[i];
    if (l->kind == CAG_JOINT_FIXED)
      add_fixed(&w, &l->fixed, numbered(out, "fixed_%zu", i + 1), link_name(&w, i));
    else add_joint(&w, l, i, ++joint);
    if (!add_shapes(&w, CAG_AS_LINK(robot->links->as.items[i])->shape)) return false;
  }
  add_fixed(&w, &r->tool, text_of(out, "tool_joint"), text_of(out, "tool"));
  return true;
}
