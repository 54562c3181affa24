// Meshes of solids without faces.
//
// An operation with finite reach is meshed as a whole, in its local coordinates, and keeps the mesh
// for transformed copies. An unbounded one is meshed within the window that matters to the
// enclosing operation. The outermost operation must be bounded. If that does not follow from the
// bounds of the operands (such as a tetrahedron of four half spaces), it is tested with a coarse
// mesh within a window far larger than all given data: the mesh must not touch the window's faces.

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "geom/solid/csg.h"
#include "geom/solid/tessellate.h"

// Default tolerance as a fraction of the size (as in tessellate.h).
#define DEFAULT_SHARE 1e-3
// Size of the window for testing whether a solid is bounded, relative to the given data.
#define FAR 100.0
// The reach of such a solid: its coarse bounds, enlarged by this fraction of their size.
#define MARGIN 0.25

static bool is_operation(const CagSolid *s) {
  return s->kind == CAG_SOLID_UNION || s->kind == CAG_SOLID_DIFFERENCE ||
         s->kind == CAG_SOLID_INTERSECTION;
}

static bool is_finite(const CagBounds *b) {
  return isfinite(b->min.x) && isfinite(b->min.y) && isfinite(b->min.z) && isfinite(b->max.x) &&
         isfinite(b->max.y) && isfinite(b->max.z);
}

static bool is_empty(const CagBounds *b) {
  return !(b->min.x <= b->max.x && b->min.y <= b->max.y && b->min.z <= b->max.z);
}

static bool apart(const CagBounds *a, const CagBounds *b) {
  return a->max.x < b->min.x || b->max.x < a->min.x || a->max.y < b->min.y || b->max.y < a->min.y ||
         a->max.z < b->min.z || b->max.z < a->min.z;
}

static CagStatus empty_mesh(CagMesh **out, CagError *err) {
  return cag_mesh_new(0, 0, false, false, false, out, err);
}

static CagStatus check_interrupt(const volatile int *interrupt, CagError *err) {
  if (!interrupt || !*interrupt) return CAG_OK;
  return cag_fail(err, CAG_E_CALLBACK, CAG_ERR_interrupted, "", -1,
                  "the set operation was interrupted");
}

static CagStatus solid_mesh(const CagSolid *s, const CagTessellation *how, const CagBounds *window,
                            CagMesh **out, CagError *err);

// --- Operations ---

static CagSetOperation operation_of(const CagSolid *s) {
  return s->kind == CAG_SOLID_UNION        ? CAG_UNION
         : s->kind == CAG_SOLID_DIFFERENCE ? CAG_DIFFERENCE
                                           : CAG_INTERSECTION;
}

// Meshes of the operands that matter within the window, and the indices of these operands.
// *nothing: an empty operand makes the result empty.
static CagStatus operand_meshes(const CagSolid *s, const CagTessellation *how,
                                const CagBounds *window, CagMesh **meshes, size_t *operands,
                                size_t *n, bool *nothing, CagError *err) {
  CagStatus status = CAG_OK;
  *n = 0;
  *nothing = false;
  for (size_t i = 0; !status && !*nothing && i < s->core->count; i++) {
    const CagSolid *operand = s->core->operands[i];
    bool needed = s->kind == CAG_SOLID_INTERSECTION || (s->kind == CAG_SOLID_DIFFERENCE && i == 0);
    CagBounds reach;
    status = check_interrupt(how->interrupt, err);
    if (!status) status = cag_solid_reach(operand, &reach, err);
    if (status) return status;
    if (is_empty(&reach) || apart(&reach, window)) {
      *nothing = needed;
      continue;
    }
    status = solid_mesh(operand, how, window, &meshes[*n], err);
    if (status) return status;
    operands[*n] = i;
    if (meshes[*n]->triangle_count > 0) {
      ++*n;
    } else {
      cag_mesh_release(meshes[*n]);
      *nothing = needed;
    }
  }
  return status;
}

// A script does not name the meshes of operands, so errors name the operand instead.
static CagStatus name_operand(const CagSolid *s, const size_t *operands, size_t n, CagStatus status,
                              CagError *err) {
  char mesh[32], operand[80], text[sizeof err->message];
  if (strcmp(err->argument, "meshes") != 0 || err->index < 0 || (size_t)err->index >= n)
    return status;
  const size_t i = operands[err->index];
  snprintf(mesh, sizeof mesh, "`meshes[%ld]`", err->index);
  const char *at = strstr(err->message, mesh);
  if (!at) return status;
  cag_solid_describe_form(s->core->operands[i], operand, sizeof operand);
  snprintf(text, sizeof text, "%.*soperand %zu of the %s (%s)%s", (int)(at - err->message),
           err->message, i + 1, cag_solid_kind_name(s->kind), operand, at + strlen(mesh));
  memcpy(err->message, text, sizeof text);
  snprintf(err->argument, sizeof err->argument, "operands");
  err->index = (long)i;
  return status;
}

static CagStatus join_meshes(const CagSolid *s, const CagTessellation *how, CagMesh *const *meshes,
                             const size_t *operands, size_t n, CagMesh **out, CagError *err) {
  if (n == 0) return empty_mesh(out, err);
  if (n == 1) {
    *out = cag_mesh_retain(meshes[0]);
    return CAG_OK;
  }
  const CagBooleanHow set = {.interrupt = how->interrupt, .keep_flat = how->max_edge > 0};
  CagStatus status =
      cag_mesh_boolean_many(operation_of(s), (const CagMesh *const *)meshes, n, &set, out, err);
  if (status) return name_operand(s, operands, n, status, err);
  if ((*out)->triangle_count <= how->max_triangles) return CAG_OK;
  status = cag_fail(err, CAG_E_LIMIT, CAG_ERR_limit_triangles, "tolerance", -1,
                    "the %s needs %zu triangles, and the limit is %zu; use a larger tolerance",
                    cag_solid_kind_name(s->kind), (*out)->triangle_count, how->max_triangles);
  cag_mesh_release(*out);
  return status;
}

// Meshes of unbounded solids end at different locations outside of the window. A difference would
// leave some of the first operand there, so it is cut off near the window, inside the others (see
// ROOM in side.c).
static CagStatus cut_first(const CagSolid *s, const CagTessellation *how, const CagBounds *window,
                           CagMesh **first, CagError *err) {
  const double room = 0.03; // of the size of the window
  CagBounds reach;
  CagMesh *box, *cut;
  CagStatus status = cag_solid_reach(s->core->operands[0], &reach, err);
  if (status || is_finite(&reach)) return status;
  const double by = room * cag_norm(cag_sub(window->max, window->min));
  const CagVec3 off = cag_vec3(by, by, by);
  const CagBounds around = {cag_sub(window->min, off), cag_add(window->max, off)};
  status = cag_box_mesh(&around, &box, err);
  if (status) return status;
  status = cag_mesh_boolean(CAG_INTERSECTION, *first, box, how->interrupt, &cut, err);
  cag_mesh_release(box);
  if (status) return status;
  cag_mesh_release(*first);
  *first = cut;
  return CAG_OK;
}

// The mesh in coordinates of the core.
static CagStatus core_mesh(const CagSolid *s, const CagTessellation *how, const CagBounds *window,
                           CagMesh **out, CagError *err) {
  if (is_empty(window)) return empty_mesh(out, err);
  CagMesh **meshes = cag_malloc((s->core->count + 1) * sizeof *meshes);
  size_t *operands = cag_malloc((s->core->count + 1) * sizeof *operands), n = 0;
  bool nothing;
  CagStatus status = meshes && operands ? CAG_OK : cag_fail_memory(err);
  if (!status) status = operand_meshes(s, how, window, meshes, operands, &n, &nothing, err);
  if (!status && !nothing && n > 1 && s->kind == CAG_SOLID_DIFFERENCE)
    status = cut_first(s, how, window, &meshes[0], err);
  if (!status && n > 0 && meshes[0]->triangle_count == 0) nothing = true;
  if (!status)
    status = nothing ? empty_mesh(out, err) : join_meshes(s, how, meshes, operands, n, out, err);
  for (size_t i = 0; i < n; i++) cag_mesh_release(meshes[i]);
  cag_free(meshes);
  cag_free(operands);
  return status;
}

// The mesh stored in the core can be used for every tolerance that is not finer. It also depends on
// the other settings of `how`, so only meshes with the default settings are stored.
static bool is_usual(const CagTessellation *how) {
  return how->angle == CAG_TESSELLATION_DEFAULT.angle && !(how->max_edge > 0);
}

// A stored mesh is not used if it is finer than requested by this factor: triangles are expensive.
#define MUCH_FINER 0.25

static CagStatus whole_core(const CagSolid *s, const CagTessellation *how, CagMesh **out,
                            CagError *err) {
  CagSolidCore *core = s->core;
  if (core->mesh && is_usual(how) && core->tolerance <= how->tolerance &&
      core->tolerance >= MUCH_FINER * how->tolerance && core->short_edge <= how->short_edge) {
    *out = cag_mesh_retain(core->mesh);
    return CAG_OK;
  }
  CagStatus status = core_mesh(s, how, &core->reach, out, err);
  if (status || !is_usual(how)) return status;
  cag_mesh_release(core->mesh);
  core->mesh = cag_mesh_retain(*out);
  core->tolerance = how->tolerance;
  core->short_edge = how->short_edge;
  return CAG_OK;
}

// The solid is bounded if the mesh in a window around all given data stays away from the window's
// faces.
static CagStatus add_landmarks(const CagSolid *s, CagBounds *into, CagError *err) {
  CagQuadric q;
  CagStatus status = CAG_OK;
  if (cag_solid_form(s, &q)) {
    CagQuadricForm f;
    status = cag_quadric_classify(&q, &f, err);
    if (status) return status;
    CagVec3 o = cag_vec3(f.frame.m[0][3], f.frame.m[1][3], f.frame.m[2][3]);
    double size = fmax(f.semi[0], fmax(f.semi[1], f.semi[2]));
    if (s->kind == CAG_SOLID_HALF_SPACE) { // its frame may be anywhere in the plane
      CagVec3 n = cag_vec3(q.c[6], q.c[7], q.c[8]);
      o = cag_scaled(n, -q.c[9] / cag_dot(n, n));
    }
    cag_bounds_add(into, cag_sub(o, cag_vec3(size, size, size)));
    cag_bounds_add(into, cag_add(o, cag_vec3(size, size, size)));
  } else if (is_operation(s)) {
    for (size_t i = 0; !status && i < s->core->count; i++) {
      CagSolid *placed;
      status = cag_solid_transform(s->core->operands[i], &s->placement, &placed, err);
      if (status) return status;
      status = add_landmarks(placed, into, err);
      cag_solid_release(placed);
    }
  } else {
    CagBounds reach;
    status = cag_solid_reach(s, &reach, err);
    if (status) return status;
    cag_bounds_add(into, reach.min);
    cag_bounds_add(into, reach.max);
  }
  return status;
}

static CagStatus unbounded(const CagSolid *s, CagError *err) {
  if (!is_operation(s))
    return cag_fail(
        err, CAG_E_ARGUMENT, CAG_ERR_solid_unbounded, "", -1,
        "the %s is unbounded: intersect it with a solid that bounds it, as in `sphere(10) & half_space(plane(origin, Z))`, or subtract it from one",
        s->kind == CAG_SOLID_HALF_SPACE ? "half space" : "side of the quadric");
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_solid_unbounded, "", -1,
                  "the %s is unbounded: one of its %zu operands is a half space or quadric "
                  "that the others do not bound; intersect it with a solid that does",
                  cag_solid_kind_name(s->kind), s->core->count);
}

// Determines the bounds of an operation that do not follow from those of its operands: one of them
// is unbounded, so there are landmarks.
static CagStatus find_reach(const CagSolid *s, CagError *err) {
  CagSolid core = *s;
  CagBounds around = CAG_BOUNDS_EMPTY;
  CagTessellation coarse = CAG_TESSELLATION_DEFAULT;
  CagMesh *m = NULL;
  core.placement = cag_transform_identity();
  CagStatus status = add_landmarks(&core, &around, err);
  if (status) return status;
  double size = cag_norm(cag_sub(around.max, around.min));
  if (!(size > 0) || !isfinite(size)) size = 1;
  CagVec3 middle = cag_lerp(around.min, around.max, 0.5);
  CagVec3 far = cag_vec3(FAR * size, FAR * size, FAR * size);
  const CagBounds window = {cag_sub(middle, far), cag_add(middle, far)};
  coarse.tolerance = DEFAULT_SHARE * FAR * size;
  coarse.interrupt = s->core->interrupt;
  status = core_mesh(s, &coarse, &window, &m, err);
  if (status) return status;
  CagBounds found = cag_mesh_bounds(m);
  bool empty = m->triangle_count == 0;
  cag_mesh_release(m);
  if (empty) {
    s->core->reach = CAG_BOUNDS_EMPTY;
    return CAG_OK;
  }
  if (found.min.x < window.min.x || found.min.y < window.min.y || found.min.z < window.min.z ||
      found.max.x > window.max.x || found.max.y > window.max.y || found.max.z > window.max.z)
    return unbounded(s, err);
  double margin = MARGIN * cag_norm(cag_sub(found.max, found.min));
  CagVec3 room = cag_vec3(margin, margin, margin);
  s->core->reach = (CagBounds){cag_sub(found.min, room), cag_add(found.max, room)};
  return CAG_OK;
}

// --- Any solid ---

static CagStatus operation_mesh(const CagSolid *s, const CagTessellation *how,
                                const CagBounds *window, CagMesh **out, CagError *err) {
  CagTessellation own = *how;
  CagMesh *m = NULL;
  double scale = cag_transform_stretch(&s->placement);
  if (!(scale > 0)) scale = 1;
  own.tolerance /= scale;
  own.max_edge /= scale;
  if (!own.interrupt) own.interrupt = s->core->interrupt;
  CagStatus status = CAG_OK;
  if (is_finite(&s->core->reach) || is_empty(&s->core->reach)) {
    status = whole_core(s, &own, &m, err);
  } else {
    CagTransform back;
    CagBounds local = CAG_BOUNDS_EMPTY;
    status = cag_transform_inverse(&s->placement, &back, err);
    for (int k = 0; !status && k < 8; k++)
      cag_bounds_add(&local,
                     cag_transform_point(&back, cag_vec3(k & 1 ? window->max.x : window->min.x,
                                                         k & 2 ? window->max.y : window->min.y,
                                                         k & 4 ? window->max.z : window->min.z)));
    if (!status) status = core_mesh(s, &own, &local, &m, err);
  }
  if (!status) status = cag_mesh_transform(m, &s->placement, out, err);
  cag_mesh_release(m);
  return status;
}

// Triangles without a label get that of the solid. The mesh must belong to the caller.
static CagStatus paint(CagMesh *m, uint32_t label, CagError *err) {
  if (!label) return CAG_OK;
  if (!m->labels) m->labels = cag_calloc(m->triangle_count + 1, sizeof *m->labels);
  if (!m->labels) return cag_fail_memory(err);
  for (size_t t = 0; t < m->triangle_count; t++)
    if (!m->labels[t]) m->labels[t] = label;
  return CAG_OK;
}

static CagStatus plain_mesh(const CagSolid *s, const CagTessellation *how, const CagBounds *window,
                            CagMesh **out, CagError *err) {
  CagQuadric q;
  if (s->kind == CAG_SOLID_MESH) return cag_mesh_transform(s->core->mesh, &s->placement, out, err);
  if (cag_solid_form(s, &q)) return cag_side_mesh(&q, window, how, out, err);
  if (is_operation(s)) return operation_mesh(s, how, window, out, err);
  return cag_solid_tessellate(s, how, out, err);
}

// `how` has a tolerance; the window is finite.
static CagStatus solid_mesh(const CagSolid *s, const CagTessellation *how, const CagBounds *window,
                            CagMesh **out, CagError *err) {
  CagMesh *m = NULL;
  CagStatus status = plain_mesh(s, how, window, &m, err);
  if (!status) status = paint(m, s->label, err);
  if (status) cag_mesh_release(m);
  else *out = m;
  return status;
}

CagStatus cag_csg_mesh(const CagSolid *s, const CagTessellation *how, CagMesh **out,
                       CagError *err) {
  CagTessellation own = how ? *how : CAG_TESSELLATION_DEFAULT;
  CagBounds reach;
  CagStatus status = cag_solid_reach(s, &reach, err);
  if (!status && !is_empty(&reach) && !is_finite(&reach)) {
    status = s->kind == CAG_SOLID_INTERSECTION || s->kind == CAG_SOLID_DIFFERENCE
                 ? find_reach(s, err)
                 : unbounded(s, err);
    if (!status) status = cag_solid_reach(s, &reach, err);
  }
  if (status) return status;
  if (is_empty(&reach)) return empty_mesh(out, err);
  double size = cag_norm(cag_sub(reach.max, reach.min));
  if (!(own.tolerance > 0)) own.tolerance = DEFAULT_SHARE * size;
  if (!(own.tolerance > 0)) return empty_mesh(out, err); // everything coincides in one point
  return solid_mesh(s, &own, &reach, out, err);
}
