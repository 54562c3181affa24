// Writes the text of a URDF file and its meshes.

#include "interp/formats/urdf.h"

#include <math.h>
#include <string.h>

#include "interp/formats/mesh_formats.h"

#define METERS 1e-3 // of a millimeter

// --- Text ---

typedef struct Writer {
  CagAtomicFile *file;
  bool undefined; // a number was not finite
} Writer;

static void put(Writer *f, const char *text) { cag_atomic_file_text(f->file, text); }

static void put_number(Writer *f, double x) {
  char text[40];
  f->undefined |= !isfinite(x);
  put(f, cag_number_text(x == 0 ? 0 : x, text));
}

static void put_numbers(Writer *f, const double *x, int n) {
  for (int i = 0; i < n; i++) {
    if (i > 0) put(f, " ");
    put_number(f, x[i]);
  }
}

// Writes the text of an attribute. XML does not allow control characters.
static void put_text(Writer *f, const char *text) {
  for (const char *c = text; *c; c++) {
    char one[2] = {(unsigned char)*c < ' ' || *c == 0x7f ? '_' : *c, 0};
    const char *entity = *c == '&'   ? "&amp;"
                         : *c == '<' ? "&lt;"
                         : *c == '>' ? "&gt;"
                         : *c == '"' ? "&quot;"
                                     : one;
    put(f, entity);
  }
}

static void put_attribute(Writer *f, const char *name, const char *text) {
  cag_atomic_file_printf(f->file, " %s=\"", name);
  put_text(f, text);
  put(f, "\"");
}

static void put_value(Writer *f, const char *name, double x) {
  cag_atomic_file_printf(f->file, " %s=\"", name);
  put_number(f, x);
  put(f, "\"");
}

// --- Transforms ---

// Computes roll, pitch, and yaw: first the yaw, then the others from the remaining rotation. So
// they reproduce the rotation up to rounding even if the pitch is a quarter turn, where yaw and
// roll coincide.
static void roll_pitch_yaw(const CagTransform *t, double rpy[3]) {
  double s = t->m[1][0], c = t->m[0][0], across = hypot(s, c);
  // Below this, the direction of the first column is only rounding.
  const double upright = 1e-15;
  if (across > upright) s /= across, c /= across;
  else s = 0, c = 1;
  rpy[2] = atan2(s, c);
  rpy[1] = atan2(-t->m[2][0], c * t->m[0][0] + s * t->m[1][0]);
  rpy[0] = atan2(s * t->m[0][2] - c * t->m[1][2], c * t->m[1][1] - s * t->m[0][1]);
}

static void put_origin(Writer *f, const char *margin, const CagTransform *t) {
  double rpy[3], xyz[3];
  roll_pitch_yaw(t, rpy);
  for (int i = 0; i < 3; i++) xyz[i] = t->m[i][3] * METERS;
  cag_atomic_file_printf(f->file, "%s<origin xyz=\"", margin);
  put_numbers(f, xyz, 3);
  put(f, "\" rpy=\"");
  put_numbers(f, rpy, 3);
  put(f, "\"/>\n");
}

// --- Links ---

static void put_geometry(Writer *f, const CagUrdfShape *s, const char *folder) {
  double side[3];
  for (int i = 0; i < 3; i++) side[i] = s->size[i] * METERS;
  put(f, "      <geometry>\n        ");
  switch (s->kind) {
  case CAG_URDF_MESH:
    put(f, "<mesh filename=\"");
    put_text(f, folder);
    put(f, "/");
    put_text(f, s->file);
    put(f, "\"/>");
    break;
  case CAG_URDF_CYLINDER:
    put(f, "<cylinder");
    put_value(f, "radius", side[0]);
    put_value(f, "length", side[1]);
    put(f, "/>");
    break;
  case CAG_URDF_BOX:
    put(f, "<box size=\"");
    put_numbers(f, side, 3);
    put(f, "\"/>");
    break;
  }
  put(f, "\n      </geometry>\n");
}

static void put_shape(const CagUrdf *u, Writer *f, const CagUrdfShape *s, const char *folder) {
  put(f, "    <visual>\n");
  put_origin(f, "      ", &s->place);
  put_geometry(f, s, folder);
  put(f, "      <material");
  put_attribute(f, "name", u->materials[s->material].name);
  put(f, "/>\n    </visual>\n    <collision>\n");
  put_origin(f, "      ", &s->place);
  put_geometry(f, s, folder);
  put(f, "    </collision>\n");
}

static void put_mass(Writer *f, const CagUrdfMass *m) {
  static const char *const names[] = {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"};
  static const int row[] = {0, 0, 0, 1, 1, 2}, column[] = {0, 1, 2, 1, 2, 2};
  CagTransform place = cag_translate(m->center);
  put(f, "    <inertial>\n");
  put_origin(f, "      ", &place);
  put(f, "      <mass");
  put_value(f, "value", m->mass);
  put(f, "/>\n      <inertia");
  for (int i = 0; i < 6; i++)
    put_value(f, names[i], m->inertia[row[i]][column[i]] * METERS * METERS);
  put(f, "/>\n    </inertial>\n");
}

static void put_link(const CagUrdf *u, Writer *f, const CagUrdfLink *l, const char *folder) {
  put(f, "  <link");
  put_attribute(f, "name", l->name);
  if (!l->shapes) {
    put(f, "/>\n");
    return;
  }
  put(f, ">\n");
  if (l->mass.mass > 0) put_mass(f, &l->mass);
  for (const CagUrdfShape *s = l->shapes; s; s = s->next) put_shape(u, f, s, folder);
  put(f, "  </link>\n");
}

// --- Joints ---

static void put_joint(const CagUrdf *u, Writer *f, const CagUrdfJoint *j) {
  bool turns = strcmp(j->type, "revolute") == 0, moves = strcmp(j->type, "fixed") != 0;
  double unit = turns ? 1 : METERS;
  put(f, "  <joint");
  put_attribute(f, "name", j->name);
  put_attribute(f, "type", j->type);
  put(f, ">\n");
  put_origin(f, "    ", &j->origin);
  put(f, "    <parent");
  put_attribute(f, "link", u->links[j->parent].name);
  put(f, "/>\n    <child");
  put_attribute(f, "link", u->links[j->child].name);
  put(f, "/>\n");
  if (moves) {
    put(f, "    <axis xyz=\"0 0 1\"/>\n    <limit");
    put_value(f, "lower", j->low * unit);
    put_value(f, "upper", j->high * unit);
    put_value(f, "effort", j->effort);
    put_value(f, "velocity", j->rate * unit);
    put(f, "/>\n");
  }
  if (j->mimic) {
    put(f, "    <mimic");
    put_attribute(f, "joint", j->mimic);
    put_value(f, "multiplier", j->multiplier * METERS);
    put(f, "/>\n");
  }
  put(f, "  </joint>\n");
}

// --- The file ---

static void put_materials(const CagUrdf *u, Writer *f) {
  for (size_t i = 0; i < u->material_count; i++) {
    const CagUrdfMaterial *m = &u->materials[i];
    double rgba[4] = {m->color.r, m->color.g, m->color.b, m->alpha};
    for (int k = 0; k < 3; k++) rgba[k] = cag_linear_to_srgb(fmin(fmax(rgba[k], 0), 1));
    put(f, "  <material");
    put_attribute(f, "name", m->name);
    put(f, ">\n    <color rgba=\"");
    put_numbers(f, rgba, 4);
    put(f, "\"/>\n  </material>\n");
  }
}

CagStatus cag_export_urdf(const CagUrdf *u, const char *folder, CagAtomicFile *file,
                          CagError *err) {
  Writer writer = {file, false}, *f = &writer;
  put(f, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<!-- written by cag; lengths in meters, angles in radians, masses in kg -->\n");
  if (u->coupled)
    put(f, "<!-- the motors of this robot are coupled to its joints, which this format cannot "
           "say: what stands here are the joints -->\n");
  put(f, "<robot");
  put_attribute(f, "name", u->name);
  put(f, ">\n");
  put_materials(u, f);
  for (size_t i = 0; i < u->link_count; i++) put_link(u, f, &u->links[i], folder);
  for (size_t i = 0; i < u->joint_count; i++) put_joint(u, f, &u->joints[i]);
  put(f, "</robot>\n");
  if (!writer.undefined) return CAG_OK;
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_not_finite, "", -1,
                  "a number in the description of the robot %s overflows or is undefined", u->name);
}

CagStatus cag_export_urdf_mesh(const CagUrdfShape *s, CagAtomicFile *file, CagError *err) {
  CagTransform meters;
  CagMesh *m = NULL;
  CagStatus status = cag_scale(cag_vec3(METERS, METERS, METERS), cag_vec3(0, 0, 0), &meters, err);
  if (!status) status = cag_mesh_transform(s->mesh, &meters, &m, err);
  if (status) return status;
  status = cag_export_stl(&(CagMeshPart){.name = s->file, .mesh = m}, 1, "binary STL, meters", file,
                          err);
  cag_mesh_release(m);
  return status;
}

void cag_urdf_free(CagUrdf *u) {
  for (size_t i = 0; i < u->link_count; i++)
    for (CagUrdfShape *s = u->links[i].shapes; s; s = s->next) cag_mesh_release(s->mesh);
  cag_arena_free(&u->arena);
}
