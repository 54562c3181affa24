// Writes the scene as JSON, in the form that the header describes.
//
// The output is written immediately, because meshes may be large. `open`, `close`, and the put
// functions write the commas. The key of each value in an object must be put first.

#include "interp/formats/json.h"

#include <string.h>

#include "base/json_text.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/solid/csg.h"
#include "geom/tessellate/orient.h"

#define DEPTH_MAX 512 // the nesting is about 12, plus 2 for each nested set operation

typedef struct Writer {
  const CagScene *scene;
  CagAtomicFile *file;
  int depth;
  bool filled[DEPTH_MAX]; // the object or list at this depth has a member
  bool keyed;             // a key was put, and its value is next
} Writer;

// --- Tokens ---

static void before_value(Writer *w) {
  if (w->keyed) {
    w->keyed = false;
    return;
  }
  if (w->filled[w->depth]) cag_atomic_file_text(w->file, ",");
  w->filled[w->depth] = true;
}

static void open(Writer *w, const char *bracket) {
  before_value(w);
  cag_atomic_file_text(w->file, bracket);
  w->filled[++w->depth] = false;
}

static void close(Writer *w, const char *bracket) {
  w->depth--;
  cag_atomic_file_text(w->file, bracket);
}

static void put_raw(Writer *w, const char *token) {
  before_value(w);
  cag_atomic_file_text(w->file, token);
}

static void put_bool(Writer *w, bool b) { put_raw(w, b ? "true" : "false"); }

static void put_number(Writer *w, double x) {
  char text[32];
  put_raw(w, isfinite(x) ? cag_number_text(x == 0 ? 0 : x, text) : "null");
}

static void put_text(Writer *w, const char *text) {
  if (!text) {
    put_raw(w, "null");
    return;
  }
  before_value(w);
  cag_atomic_file_text(w->file, "\"");
  for (const char *c = text; *c; c++) {
    char escape[8];
    const char *escaped = cag_json_escape(*c, escape);
    if (escaped) cag_atomic_file_text(w->file, escaped);
    else cag_atomic_file_write(w->file, c, 1);
  }
  cag_atomic_file_text(w->file, "\"");
}

static void key(Writer *w, const char *name) {
  put_text(w, name);
  cag_atomic_file_text(w->file, ":");
  w->keyed = true;
}

static void new_line(Writer *w) { cag_atomic_file_text(w->file, "\n"); }

// --- Small values ---

static void put_numbers(Writer *w, const double *x, size_t n) {
  open(w, "[");
  for (size_t i = 0; i < n; i++) put_number(w, x[i]);
  close(w, "]");
}

static void put_vec(Writer *w, CagVec3 v, int dimension) {
  put_numbers(w, (const double[]){v.x, v.y, v.z}, (size_t)dimension);
}

static void put_color(Writer *w, CagColor c) { put_numbers(w, (const double[]){c.r, c.g, c.b}, 3); }

static void put_transform(Writer *w, const CagTransform *t) {
  open(w, "[");
  for (int i = 0; i < 4; i++) put_numbers(w, t->m[i], 4);
  close(w, "]");
}

static void key_text(Writer *w, const char *name, const char *text) {
  key(w, name);
  put_text(w, text);
}
static void key_number(Writer *w, const char *name, double x) {
  key(w, name);
  put_number(w, x);
}
static void key_bool(Writer *w, const char *name, bool b) {
  key(w, name);
  put_bool(w, b);
}
static void key_vec(Writer *w, const char *name, CagVec3 v) {
  key(w, name);
  put_vec(w, v, 3);
}
static void key_color(Writer *w, const char *name, CagColor c) {
  key(w, name);
  put_color(w, c);
}
static void key_pair(Writer *w, const char *name, double a, double b) {
  key(w, name);
  put_numbers(w, (const double[]){a, b}, 2);
}
static void key_bools(Writer *w, const char *name, bool a, bool b) {
  key(w, name);
  open(w, "[");
  put_bool(w, a);
  put_bool(w, b);
  close(w, "]");
}
static void key_transform(Writer *w, const char *name, const CagTransform *t) {
  key(w, name);
  put_transform(w, t);
}

// --- Meshes ---

static void put_vectors(Writer *w, const CagVec3 *v, size_t n) {
  open(w, "[");
  for (size_t i = 0; i < n && !cag_stopped(); i++) put_vec(w, v[i], 3);
  close(w, "]");
}

static void put_mesh(Writer *w, const CagMesh *m) {
  open(w, "{");
  key(w, "vertices");
  put_vectors(w, m->positions, m->vertex_count);
  key(w, "normals");
  if (m->normals) put_vectors(w, m->normals, m->vertex_count);
  else put_raw(w, "null");
  key(w, "triangles");
  open(w, "[");
  for (size_t i = 0; i < m->triangle_count && !cag_stopped(); i++) {
    const uint32_t *t = m->triangles + 3 * i;
    before_value(w);
    cag_atomic_file_printf(w->file, "[%u,%u,%u]", t[0], t[1], t[2]);
  }
  close(w, "]");
  close(w, "}");
}

// --- Curves and regions ---

// Writes points and weights from homogeneous control points.
static void put_control(Writer *w, const double *h, size_t n, int dimension) {
  open(w, "[");
  for (size_t i = 0; i < n; i++, h += 4)
    put_vec(w, cag_vec3(h[0] / h[3], h[1] / h[3], h[2] / h[3]), dimension);
  close(w, "]");
}

static void put_weights(Writer *w, const double *h, size_t n) {
  open(w, "[");
  for (size_t i = 0; i < n; i++) put_number(w, h[4 * i + 3]);
  close(w, "]");
}

static void put_nurbs_curve(Writer *w, const CagNurbsView *v, int dimension) {
  key_number(w, "degree", v->degree);
  key_bool(w, "periodic", v->periodic);
  key(w, "knots");
  put_numbers(w, v->knots, v->count + (size_t)v->degree + 1);
  key(w, "points");
  put_control(w, v->homogeneous, v->count, dimension);
  key(w, "weights");
  if (v->rational) put_weights(w, v->homogeneous, v->count);
  else put_raw(w, "null");
}

static CagStatus put_curve(Writer *w, const CagCurve *c, CagError *err);

static CagStatus put_samples(Writer *w, const CagCurve *c, CagError *err) {
  double *t;
  size_t n;
  const double turn = 5 * 3.14159265358979323846 / 180;
  CagBounds b;
  CagStatus status = cag_curve_bounds(c, &b, err);
  if (status) return status;
  double tolerance =
      w->scene->tolerance > 0 ? w->scene->tolerance : cag_norm(cag_sub(b.max, b.min)) / 1000;
  if ((status = cag_curve_discretize(c, tolerance, turn, &t, &n, err))) return status;
  CagVec3 *p = cag_malloc(n * sizeof *p);
  status = p ? cag_curve_eval_many(c, t, n, 0, p, err) : cag_fail_memory(err);
  if (!status) {
    key(w, "samples");
    open(w, "{");
    key(w, "parameters");
    put_numbers(w, t, n);
    key(w, "points");
    open(w, "[");
    for (size_t i = 0; i < n; i++) put_vec(w, p[i], c->dimension);
    close(w, "]");
    close(w, "}");
  }
  cag_free(p);
  cag_free(t);
  return status;
}

static CagStatus put_other_curve(Writer *w, const CagCurve *c, CagError *err) {
  CagCurve *nurbs;
  CagStatus status = cag_curve_to_nurbs(c, &nurbs, err);
  if (status == CAG_E_MEMORY) return status;
  if (status) return put_samples(w, c, err);
  key(w, "nurbs");
  status = put_curve(w, nurbs, err);
  cag_curve_release(nurbs);
  return status;
}

static CagStatus put_curve_data(Writer *w, const CagCurve *c, CagError *err) {
  CagNurbsView nurbs;
  const CagVec3 *points;
  size_t n;
  bool closed;
  double a, b, turns, taper;
  CagTransform frame;
  if (cag_curve_nurbs_view(c, &nurbs)) {
    put_nurbs_curve(w, &nurbs, c->dimension);
  } else if (cag_curve_vertices(c, &points, &n, &closed)) {
    key(w, "points");
    open(w, "[");
    for (size_t i = 0; i < n; i++) put_vec(w, points[i], c->dimension);
    close(w, "]");
  } else if (cag_curve_arc_view(c, &a, &b, &frame)) {
    key_number(w, "a", a);
    key_number(w, "b", b);
    key_transform(w, "frame", &frame);
  } else if (cag_curve_helix_view(c, &a, &b, &turns, &taper, &frame)) {
    key_number(w, "radius", a);
    key_number(w, "pitch", b);
    key_number(w, "turns", turns);
    key_number(w, "taper", taper);
    key_transform(w, "frame", &frame);
  } else {
    return put_other_curve(w, c, err);
  }
  return CAG_OK;
}

static CagStatus put_curve(Writer *w, const CagCurve *c, CagError *err) {
  open(w, "{");
  key_text(w, "type", c->kind->name);
  key_number(w, "dimension", c->dimension);
  key_pair(w, "domain", c->start, c->end);
  key_bool(w, "angular", c->angular);
  key_bool(w, "closed", c->closed);
  CagStatus status = put_curve_data(w, c, err);
  close(w, "}");
  return status;
}

static CagStatus put_region(Writer *w, const CagRegion *r, CagError *err) {
  CagStatus status = CAG_OK;
  open(w, "{");
  key(w, "loops");
  open(w, "[");
  for (size_t i = 0; !status && i < r->count; i++) status = put_curve(w, r->loops[i], err);
  close(w, "]");
  key(w, "outer");
  open(w, "[");
  for (size_t i = 0; i < r->count; i++) put_number(w, (double)r->outer[i]);
  close(w, "]");
  close(w, "}");
  return status;
}

// --- Surfaces ---

static void put_nurbs_surface(Writer *w, const CagSurfaceNurbsView *v) {
  key_pair(w, "degree", v->degree_u, v->degree_v);
  key_bools(w, "periodic", v->periodic_u, v->periodic_v);
  key(w, "knots");
  open(w, "[");
  put_numbers(w, v->knots_u, v->nu + (size_t)v->degree_u + 1);
  put_numbers(w, v->knots_v, v->nv + (size_t)v->degree_v + 1);
  close(w, "]");
  key(w, "points");
  open(w, "[");
  for (size_t i = 0; i < v->nu; i++) put_control(w, v->homogeneous + 4 * i * v->nv, v->nv, 3);
  close(w, "]");
  key(w, "weights");
  if (!v->rational) {
    put_raw(w, "null");
    return;
  }
  open(w, "[");
  for (size_t i = 0; i < v->nu; i++) put_weights(w, v->homogeneous + 4 * i * v->nv, v->nv);
  close(w, "]");
}

static CagStatus put_surface(Writer *w, const CagSurface *s, CagError *err);

static CagStatus put_other_surface(Writer *w, const CagSurface *s, CagError *err) {
  CagSurface *nurbs;
  CagMesh *mesh;
  CagStatus status = cag_surface_to_nurbs(s, &nurbs, err);
  if (status == CAG_E_MEMORY) return status;
  if (!status) {
    key(w, "nurbs");
    status = put_surface(w, nurbs, err);
    cag_surface_release(nurbs);
    return status;
  }
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  how.tolerance = w->scene->tolerance > 0 ? w->scene->tolerance : w->scene->usual_tolerance;
  how.max_triangles = w->scene->max_triangles > 0 ? w->scene->max_triangles : how.max_triangles;
  how.interrupt = w->scene->interrupt;
  if ((status = cag_surface_tessellate(s, &how, &mesh, err))) return status;
  key(w, "mesh");
  put_mesh(w, mesh);
  cag_mesh_release(mesh);
  return CAG_OK;
}

static CagStatus put_surface_data(Writer *w, const CagSurface *s, CagError *err) {
  CagSurfaceNurbsView nurbs;
  CagQuadric q;
  const CagCurve *profile;
  const CagRegion *region;
  CagTransform frame;
  CagVec3 axis, through;
  double from, to;
  CagStatus status = CAG_OK;
  if (cag_surface_nurbs_view(s, &nurbs)) {
    put_nurbs_surface(w, &nurbs);
  } else if (cag_surface_revolution_view(s, &profile, &axis, &through, &from, &to)) {
    key_vec(w, "axis", axis);
    key_vec(w, "through", through);
    key_pair(w, "angle", from, to);
    key(w, "profile");
    status = put_curve(w, profile, err);
  } else if (cag_surface_quadric_view(s, &q)) {
    key(w, "equation");
    put_numbers(w, q.c, 10);
  } else if (cag_surface_planar_view(s, &region, &frame)) {
    key_transform(w, "frame", &frame);
    key(w, "region");
    status = put_region(w, region, err);
  } else {
    status = put_other_surface(w, s, err);
  }
  return status;
}

static CagStatus put_surface(Writer *w, const CagSurface *s, CagError *err) {
  open(w, "{");
  key_text(w, "type", s->kind->name);
  key_pair(w, "u", s->u0, s->u1);
  key_pair(w, "v", s->v0, s->v1);
  key_bools(w, "closed", s->closed_u, s->closed_v);
  CagStatus status = put_surface_data(w, s, err);
  close(w, "}");
  return status;
}

// --- Solids ---

static CagStatus put_faces(Writer *w, const CagSolid *s, CagError *err) {
  CagStatus status = CAG_OK;
  key(w, "faces");
  open(w, "[");
  for (size_t i = 0; !status && i < s->face_count; i++) status = put_surface(w, s->faces[i], err);
  close(w, "]");
  return status;
}

static CagStatus put_solid(Writer *w, const CagSolid *s, CagError *err);

static CagStatus put_operands(Writer *w, const CagSolid *s, CagError *err) {
  CagStatus status = CAG_OK;
  const int room = 16; // nesting of a solid without operands
  if (w->depth + room > DEPTH_MAX)
    return cag_fail(
        err, CAG_E_LIMIT, CAG_ERR_limit_depth, "", -1,
        "set operations are nested too deeply for the file (more than %d); `tessellate` makes one mesh of them",
        DEPTH_MAX / 2);
  key(w, "operands");
  open(w, "[");
  for (size_t i = 0; !status && i < s->core->count; i++)
    status = put_solid(w, s->core->operands[i], err);
  close(w, "]");
  return status;
}

static CagStatus put_solid(Writer *w, const CagSolid *s, CagError *err) {
  CagStatus status = CAG_OK;
  open(w, "{");
  key_text(w, "type", cag_solid_kind_name(s->kind));
  key_transform(w, "placement", &s->placement);
  switch (s->kind) {
  case CAG_SOLID_BOX:
    key_vec(w, "size", cag_vec3(s->a, s->b, s->c));
    key_bool(w, "centered", s->centered);
    break;
  case CAG_SOLID_SPHERE: key_number(w, "radius", s->a); break;
  case CAG_SOLID_CYLINDER:
    key_number(w, "height", s->a);
    key_number(w, "radius", s->b);
    key_number(w, "top", s->c);
    break;
  case CAG_SOLID_TORUS:
    key_number(w, "major", s->a);
    key_number(w, "minor", s->b);
    break;
  case CAG_SOLID_MESH:
    key(w, "mesh");
    put_mesh(w, s->core->mesh);
    break;
  case CAG_SOLID_HALF_SPACE:
  case CAG_SOLID_QUADRIC:
    key(w, "form"); // a x^2 + b y^2 + c z^2 + d xy + e yz + f xz + g x + h y + j z + k < 0
    put_numbers(w, s->core->form, 10);
    break;
  case CAG_SOLID_UNION:
  case CAG_SOLID_DIFFERENCE:
  case CAG_SOLID_INTERSECTION: status = put_operands(w, s, err); break;
  default: status = put_faces(w, s, err);
  }
  close(w, "}");
  return status;
}

// --- Items ---

// Closed surfaces have outward normals in the file.
static CagStatus put_outward_surface(Writer *w, const CagSurface *s, CagError *err) {
  CagSurface *outward;
  CagStatus status = cag_surface_outward(s, &outward, err);
  if (status) return status;
  status = put_surface(w, outward, err);
  cag_surface_release(outward);
  return status;
}

static CagStatus put_outward_mesh(Writer *w, const CagMesh *m, CagError *err) {
  CagMesh *outward;
  CagStatus status = cag_mesh_outward(m, &outward, err);
  if (status) return status;
  put_mesh(w, outward);
  cag_mesh_release(outward);
  return CAG_OK;
}

static const char *const item_names[] = {
    [CAG_ITEM_CURVE] = "curve", [CAG_ITEM_REGION] = "region", [CAG_ITEM_SURFACE] = "surface",
    [CAG_ITEM_SOLID] = "solid", [CAG_ITEM_MESH] = "mesh",     [CAG_ITEM_GROUND] = "ground"};

static CagStatus put_item_data(Writer *w, const CagItem *item, CagError *err) {
  CagStatus status = CAG_OK;
  switch (item->kind) {
  case CAG_ITEM_CURVE:
    key_number(w, "line_radius", item->line_radius);
    key_number(w, "dash", item->dash);
    key(w, "curve");
    status = put_curve(w, item->as.curve, err);
    break;
  case CAG_ITEM_REGION:
    key_transform(w, "placement", &item->placement);
    key(w, "region");
    status = put_region(w, item->as.region, err);
    break;
  case CAG_ITEM_SURFACE:
    key(w, "surface");
    status = put_outward_surface(w, item->as.surface, err);
    break;
  case CAG_ITEM_SOLID:
    key(w, "solid");
    status = put_solid(w, item->as.solid, err);
    break;
  case CAG_ITEM_MESH:
    key(w, "mesh");
    status = put_outward_mesh(w, item->as.mesh, err);
    break;
  case CAG_ITEM_GROUND:
    key_number(w, "z", item->ground_z);
    key_number(w, "size", item->ground_size);
    break;
  }
  return status;
}

static CagStatus put_items(Writer *w, CagError *err) {
  CagStatus status = CAG_OK;
  key(w, "items");
  open(w, "[");
  for (size_t i = 0; !status && i < w->scene->item_count; i++) {
    const CagItem *item = &w->scene->items[i];
    open(w, "\n{");
    key_text(w, "name", item->name);
    key_text(w, "kind", item_names[item->kind]);
    key_number(w, "material", (double)item->material);
    key_number(w, "tolerance", item->tolerance);
    status = put_item_data(w, item, err);
    close(w, "}");
  }
  close(w, "]");
  new_line(w);
  return status;
}

static void put_labels(Writer *w) {
  const CagScene *s = w->scene;
  if (s->label_count == 0) return;
  key(w, "labels");
  open(w, "[");
  for (size_t i = 0; i < s->label_count; i++) {
    const CagLabel *l = &s->labels[i];
    open(w, "\n{");
    key_text(w, "text", l->text);
    key_vec(w, "at", l->at);
    if (l->directed) key_vec(w, "along", l->along);
    key_text(w, "place", cag_label_places[l->place]);
    key_text(w, "mark", cag_label_marks[l->mark]);
    key_number(w, "size", l->size);
    key_number(w, "material", (double)l->material);
    close(w, "}");
  }
  close(w, "]");
  new_line(w);
}

// --- Materials, cameras, lights, settings ---

static void put_materials(Writer *w) {
  key(w, "materials");
  open(w, "[");
  for (size_t i = 0; i < w->scene->material_count; i++) {
    const CagMaterial *m = &w->scene->materials[i];
    open(w, "\n{");
    key_text(w, "name", m->name);
    key_color(w, "color", m->color);
    key_number(w, "metallic", m->metallic);
    key_number(w, "roughness", m->roughness);
    key_number(w, "ior", m->ior);
    key_number(w, "transmission", m->transmission);
    key_color(w, "emission", m->emission);
    key_number(w, "coat", m->coat);
    key_text(w, "texture", m->texture);
    key_color(w, "color2", m->color2);
    key_number(w, "texture_scale", m->texture_scale);
    key_text(w, "pov", m->pov);
    close(w, "}");
  }
  close(w, "]");
  new_line(w);
}

static void put_cameras(Writer *w) {
  key(w, "cameras");
  open(w, "[");
  for (size_t i = 0; i < w->scene->camera_count; i++) {
    const CagCamera *c = &w->scene->cameras[i];
    CagTransform frame = cag_camera_frame(c);
    open(w, "\n{");
    key_text(w, "name", c->name);
    key_text(w, "projection", c->orthographic ? "orthographic" : "perspective");
    key_vec(w, "eye", c->eye);
    key_vec(w, "target", c->target);
    key_vec(w, "up", c->up);
    if (c->orthographic) key_number(w, "width", c->width);
    else key_number(w, "fov", c->fov);
    key_pair(w, "size", c->size[0], c->size[1]);
    key_number(w, "focus", c->focus);
    key_number(w, "aperture", c->aperture);
    if (c->focal > 0) {
      key_number(w, "focal", c->focal);
      key_pair(w, "shift", c->shift[0], c->shift[1]);
      key_number(w, "skew", c->skew);
      key_number(w, "stretch", c->stretch);
    }
    key_transform(w, "frame", &frame);
    close(w, "}");
  }
  close(w, "]");
  new_line(w);
}

static const char *const light_names[] = {[CAG_LIGHT_SUN] = "sun",
                                          [CAG_LIGHT_POINT] = "point",
                                          [CAG_LIGHT_SPOT] = "spot",
                                          [CAG_LIGHT_AREA] = "area"};

static void put_lights(Writer *w) {
  key(w, "lights");
  open(w, "[");
  for (size_t i = 0; i < w->scene->light_count; i++) {
    const CagLight *l = &w->scene->lights[i];
    open(w, "\n{");
    key_text(w, "kind", light_names[l->kind]);
    if (l->kind != CAG_LIGHT_SUN) key_vec(w, "position", l->position);
    if (l->kind != CAG_LIGHT_POINT) key_vec(w, "direction", l->direction);
    if (l->kind == CAG_LIGHT_SPOT) key_number(w, "angle", l->angle);
    if (l->kind == CAG_LIGHT_AREA) key_number(w, "size", l->size);
    key_color(w, "color", l->color);
    key_number(w, "strength", l->strength);
    close(w, "}");
  }
  close(w, "]");
  new_line(w);
}

static void put_sky(Writer *w) {
  const CagScene *s = w->scene;
  key(w, "sky");
  if (s->sky.image) {
    open(w, "{");
    key_text(w, "image", s->sky.image);
    close(w, "}");
  } else if (s->sky.color_count > 0) {
    open(w, "{");
    key(w, "colors");
    open(w, "[");
    for (size_t i = 0; i < s->sky.color_count; i++) put_color(w, s->sky.colors[i]);
    close(w, "]");
    close(w, "}");
  } else {
    put_raw(w, "null");
  }
  key(w, "background");
  if (s->has_background) put_color(w, s->background);
  else put_raw(w, "null");
  key_bool(w, "studio", s->studio);
  key_bool(w, "automatic_camera", s->automatic_camera);
}

static void put_head(Writer *w) {
  const CagScene *s = w->scene;
  key_text(w, "format", "cag-scene");
  key_number(w, "version", 1);
  key_text(w, "generator", "cag " CAG_VERSION);
  key_text(w, "script", s->script);
  key_text(w, "units", "mm");
  key_text(w, "up", "z");
  key(w, "bounds");
  if (s->bounds.min.x <= s->bounds.max.x) {
    open(w, "{");
    key_vec(w, "min", s->bounds.min);
    key_vec(w, "max", s->bounds.max);
    close(w, "}");
  } else {
    put_raw(w, "null");
  }
  key_number(w, "tolerance", s->tolerance);
  new_line(w);
}

CagStatus cag_export_json(const CagScene *scene, CagAtomicFile *file, CagError *err) {
  Writer w = {.scene = scene, .file = file};
  open(&w, "{");
  put_head(&w);
  put_materials(&w);
  CagStatus status = put_items(&w, err);
  if (status) return status;
  put_labels(&w);
  put_cameras(&w);
  put_lights(&w);
  put_sky(&w);
  close(&w, "}");
  new_line(&w);
  return CAG_OK;
}
