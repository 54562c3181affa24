// Writes set operations of solids natively.
//
// Each operand is written natively as a primitive, a prism, a lathe, a plane, a quadric, or a
// nested operation. Others become a closed mesh2. Each operand includes its placement.
//
// If an operand shares a face with an operand that is subtracted from it, the renderer shows parts
// of the face at random. So subtracted operands are enlarged about their center by an invisibly
// small amount.

#include "interp/formats/pov_write.h"

#include "geom/solid/csg.h"

// The relative enlargement of subtracted operands: below a pixel of any picture, and well above the
// renderer's tolerance, about 1e-6 of the distance.
#define ENLARGED 4e-5

static bool is_operation(const CagSolid *s) {
  return s->kind == CAG_SOLID_UNION || s->kind == CAG_SOLID_DIFFERENCE ||
         s->kind == CAG_SOLID_INTERSECTION;
}

// Writes a mesh with the item's tolerance.
static void write_mesh(CagPovWriter *w, const CagSolid *s) {
  CagItem item = {.kind = CAG_ITEM_SOLID,
                  .as.solid = (CagSolid *)s,
                  .tolerance = w->item->tolerance,
                  .bounds = w->item->bounds,
                  .measured = w->item->measured};
  CagMesh *m;
  CagError err;
  CagStatus status = cag_item_mesh(w->scene, &item, &m, &err);
  if (!status) {
    status = cag_pov_mesh(w, m, &err);
    cag_mesh_release(m);
  }
  if (status && !w->failure.status) w->failure = err;
}

// Writes the plane of a half space. The normal points outward.
static void write_plane(CagPovWriter *w, const CagQuadric *q, int depth) {
  CagVec3 n = cag_vec3(q->c[6], q->c[7], q->c[8]);
  double length = cag_norm(n);
  cag_pov_text(w, "plane {\n  ");
  cag_pov_vec(w, cag_scaled(n, 1 / length));
  cag_pov_text(w, ", ");
  cag_pov_number(w, -q->c[9] / length + depth * ENLARGED * w->radius);
  cag_pov_text(w, "\n}");
}

// Writes objects that are solid for the renderer, which excludes clipped quadrics and flat pieces.
static bool try_leaf(CagPovWriter *w, const CagSolid *s) {
  const CagSurface *const *faces = (const CagSurface *const *)s->faces;
  switch (s->kind) {
  case CAG_SOLID_REVOLUTION: return cag_pov_try_lathe(w, faces, s->face_count);
  case CAG_SOLID_SHELL:
    return s->face_count == 1 && cag_surface_is_closed(faces[0]) &&
           (cag_pov_try_quadric(w, faces, 1) || cag_pov_try_torus(w, faces[0]));
  case CAG_SOLID_TUBE:
  case CAG_SOLID_SWEEP:
  case CAG_SOLID_LOFT:
  case CAG_SOLID_MESH: return false;
  default: return cag_pov_try_solid(w, s);
  }
}

static void enlarge(CagPovWriter *w, const CagSolid *s, int depth) {
  CagBounds box;
  CagError err;
  CagTransform t = cag_transform_identity();
  if (depth == 0 || cag_solid_reach(s, &box, &err)) return;
  double k = 1 + depth * ENLARGED;
  CagVec3 middle = cag_lerp(box.min, box.max, 0.5);
  const double at[3] = {middle.x, middle.y, middle.z};
  t.planar = false;
  for (int i = 0; i < 3; i++) {
    t.m[i][i] = k;
    t.m[i][3] = (1 - k) * at[i];
  }
  cag_pov_placement(w, "  ", &t);
}

static void write_plain(CagPovWriter *w, const CagSolid *s, int depth) {
  CagQuadric q;
  if (is_operation(s)) {
    cag_pov_csg(w, s, depth);
    return;
  }
  if (cag_solid_form(s, &q)) {
    if (s->kind == CAG_SOLID_HALF_SPACE) {
      write_plane(w, &q, depth);
    } else {
      cag_pov_equation(w, q.c);
      cag_pov_text(w, "}");
    }
    return;
  }
  if (depth > 0) {
    w->depth++;
    cag_pov_text(w, "object {\n");
  }
  if (!try_leaf(w, s)) write_mesh(w, s);
  if (depth == 0) return;
  w->depth--;
  cag_pov_text(w, "\n");
  enlarge(w, s, depth);
  cag_pov_text(w, "}");
}

// The material of an operand is written inside it, where it overrides that of the whole.
static void write_operand(CagPovWriter *w, const CagSolid *s, int depth) {
  char material[64];
  if (!s->label || !w->item || !w->item->label_count) {
    write_plain(w, s, depth);
    return;
  }
  w->depth++;
  cag_pov_text(w, "object {\n");
  write_plain(w, s, depth);
  w->depth--;
  cag_pov_material_name(w, cag_item_label_material(w->item, s->label), true, material);
  cag_pov_printf(w, "\n  material { %s }\n}", material);
}

void cag_pov_csg(CagPovWriter *w, const CagSolid *s, int depth) {
  const char *word = s->kind == CAG_SOLID_UNION        ? w->see_through ? "merge" : "union"
                     : s->kind == CAG_SOLID_DIFFERENCE ? "difference"
                                                       : "intersection";
  const bool inside = w->in_operation;
  const CagTransform outer = w->outer;
  w->in_operation = true;
  w->outer = cag_transform_multiply(&outer, &s->placement);
  w->depth++;
  cag_pov_printf(w, "%s {\n", word);
  for (size_t i = 0; i < s->core->count && !w->failure.status; i++) {
    bool taken = s->kind == CAG_SOLID_DIFFERENCE && i > 0;
    write_operand(w, s->core->operands[i], depth + taken);
    if (i + 1 == s->core->count) w->depth--; // for the line of the closing brace
    cag_pov_text(w, "\n");
  }
  w->in_operation = inside;
  w->outer = outer;
  cag_pov_placement(w, "  ", &s->placement);
  cag_pov_text(w, "}");
}
