// Writes solids for which POV-Ray has objects.
//
// A solid under a rigid motion is written in its own coordinates, and the writer's `placement`
// contains the motion. A scaled or sheared solid, and an operand of a set operation, is written
// with its matrix.

#include "interp/formats/pov_write.h"

// Tests for orthonormal columns, up to rounding.
static bool is_rigid(const CagTransform *t) {
  const double rounding = 1e-12;
  for (int j = 0; j < 3; j++)
    for (int k = j; k < 3; k++) {
      double dot = 0;
      for (int i = 0; i < 3; i++) dot += t->m[i][j] * t->m[i][k];
      if (fabs(dot - (j == k ? 1 : 0)) > rounding) return false;
    }
  return t->m[3][3] == 1;
}

static void write_placement(CagPovWriter *w, const CagTransform *t) {
  if (!w->in_operation && is_rigid(t)) w->placement = *t;
  else cag_pov_placement(w, "  ", t);
}

static void write_box(CagPovWriter *w, const CagSolid *s) {
  CagVec3 size = cag_vec3(s->a, s->b, s->c), low = {0, 0, 0};
  if (s->centered) low = cag_scaled(size, -0.5);
  cag_pov_text(w, "box {\n  ");
  cag_pov_vec(w, low);
  cag_pov_text(w, ", ");
  cag_pov_vec(w, cag_add(low, size));
  cag_pov_text(w, "\n");
  write_placement(w, &s->placement);
  cag_pov_text(w, "}");
}

static void write_sphere(CagPovWriter *w, const CagSolid *s) {
  cag_pov_text(w, "sphere {\n  <0, 0, 0>, ");
  cag_pov_number(w, s->a);
  cag_pov_text(w, "\n");
  write_placement(w, &s->placement);
  cag_pov_text(w, "}");
}

static void write_cylinder(CagPovWriter *w, const CagSolid *s) {
  bool straight = s->b == s->c;
  cag_pov_text(w, straight ? "cylinder {\n  <0, 0, 0>, " : "cone {\n  <0, 0, 0>, ");
  if (!straight) {
    cag_pov_number(w, s->b);
    cag_pov_text(w, ", ");
  }
  cag_pov_vec(w, cag_vec3(0, 0, s->a));
  cag_pov_text(w, ", ");
  cag_pov_number(w, s->c);
  cag_pov_text(w, "\n");
  write_placement(w, &s->placement);
  cag_pov_text(w, "}");
}

static void write_torus(CagPovWriter *w, const CagSolid *s) {
  cag_pov_text(w, "torus {\n  ");
  cag_pov_number(w, s->a);
  cag_pov_text(w, ", ");
  cag_pov_number(w, s->b);
  cag_pov_text(w, "\n  rotate 90*x // POV-Ray's own lie about y\n");
  write_placement(w, &s->placement);
  cag_pov_text(w, "}");
}

static bool try_shell(CagPovWriter *w, const CagSolid *s) {
  const CagSurface *const *faces = (const CagSurface *const *)s->faces;
  return cag_pov_try_quadric(w, faces, s->face_count) ||
         (s->face_count == 1 && cag_pov_try_surface(w, faces[0])) ||
         cag_pov_try_lathe(w, faces, s->face_count);
}

bool cag_pov_try_solid(CagPovWriter *w, const CagSolid *s) {
  bool affine = cag_transform_is_affine(&s->placement);
  switch (s->kind) {
  case CAG_SOLID_BOX: return affine && (write_box(w, s), true);
  case CAG_SOLID_SPHERE: return affine && (write_sphere(w, s), true);
  case CAG_SOLID_CYLINDER: return affine && (write_cylinder(w, s), true);
  case CAG_SOLID_TORUS: return affine && (write_torus(w, s), true);
  case CAG_SOLID_EXTRUSION: return cag_pov_try_prism(w, s);
  case CAG_SOLID_REVOLUTION:
  case CAG_SOLID_SHELL: return try_shell(w, s);
  case CAG_SOLID_TUBE:
  case CAG_SOLID_SWEEP:
  case CAG_SOLID_LOFT:
  case CAG_SOLID_EXACT:
  case CAG_SOLID_MESH:
  case CAG_SOLID_HALF_SPACE:
  case CAG_SOLID_QUADRIC: return false;
  case CAG_SOLID_UNION:
  case CAG_SOLID_DIFFERENCE:
  case CAG_SOLID_INTERSECTION: return affine && (cag_pov_csg(w, s, 0), true);
  }
  return false;
}
