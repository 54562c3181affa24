// Converts the items of a scene to shapes of curves, sheets, and solids, with their shells.

#include "interp/formats/brep.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "geom/boundary/moved.h"
#include "geom/solid/csg.h"
#include "geom/solid/exact.h"
#include "geom/tessellate/orient.h"
#include "interp/formats/brep_build.h"
#include "interp/formats/brep_check.h"
#include "interp/formats/brep_facets.h"
#include "interp/formats/brep_form.h"
#include "interp/scene/fineness.h"

// The fraction of a shape's size within which ends and edges count as equal. The checks of closed
// solids allow the same.
#define SAME 1e-6
// The minimum accuracy in a file, because programs use it as their smallest length.
#define ACCURACY_MIN 1e-7

void cag_brep_free(CagBrep *b) {
  for (size_t i = 0; i < b->edge_count; i++) cag_curve_release(b->edges[i].curve);
  for (size_t i = 0; i < b->use_count; i++) cag_curve_release(b->uses[i].trace);
  for (size_t i = 0; i < b->face_count; i++) {
    cag_surface_release(b->faces[i].surface);
    cag_surface_release(b->faces[i].carrier.spline);
    cag_curve_release(b->faces[i].carrier.profile);
  }
  for (size_t i = 0; i < b->shape_count; i++) cag_curve_release(b->shapes[i].curve);
  cag_free(b->vertices);
  cag_free(b->edges);
  cag_free(b->uses);
  cag_free(b->loops);
  cag_free(b->faces);
  cag_free(b->shells);
  cag_free(b->shapes);
  *b = (CagBrep){0};
}

// --- Shells ---

static size_t root(size_t *parent, size_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

// Joins faces that share an edge. *open is set if an edge has only one use.
static CagStatus connect(const CagBrepWork *w, size_t *parent, bool *open, CagError *err) {
  const CagBrep *b = w->brep;
  const size_t n = b->face_count - w->first_face, edges = b->edge_count - w->first_edge;
  size_t *user = cag_malloc((edges + 1) * sizeof *user); // of the shape's own edges
  if (!user) return cag_fail_memory(err);
  for (size_t i = 0; i < edges; i++) user[i] = SIZE_MAX;
  size_t single = 0;
  for (size_t f = 0; f < n; f++) {
    const CagBrepFace *face = &b->faces[w->first_face + f];
    for (size_t l = face->first; l < face->first + face->count; l++)
      for (size_t u = b->loops[l].first; u < b->loops[l].first + b->loops[l].count; u++) {
        size_t *first = &user[b->uses[u].edge - w->first_edge];
        if (*first == SIZE_MAX) *first = f, single++;
        else parent[root(parent, f)] = root(parent, *first), single--;
      }
  }
  *open = single > 0;
  cag_free(user);
  return CAG_OK;
}

// Numbers the sets by their first faces. Returns their number.
static size_t number_sets(size_t *parent, size_t n, size_t *set) {
  size_t sets = 0;
  for (size_t f = 0; f < n; f++) set[f] = SIZE_MAX;
  for (size_t f = 0; f < n; f++) {
    size_t r = root(parent, f);
    if (set[r] == SIZE_MAX) set[r] = sets++;
    set[f] = set[r];
  }
  return sets;
}

// Sorts the faces by sets, and makes a shell of each set.
static CagStatus sort_faces(CagBrep *b, size_t first, const size_t *set, size_t sets, bool closed,
                            CagError *err) {
  size_t n = b->face_count - first;
  CagBrepFace *sorted = cag_malloc((n ? n : 1) * sizeof *sorted);
  if (!sorted || !cag_brep_reserve((void **)&b->shells, b->shell_count, sets, sizeof *b->shells)) {
    cag_free(sorted);
    return cag_fail_memory(err);
  }
  size_t *at = cag_calloc(sets + 1, sizeof *at);
  if (!at) {
    cag_free(sorted);
    return cag_fail_memory(err);
  }
  for (size_t f = 0; f < n; f++) at[set[f] + 1]++;
  for (size_t k = 0; k < sets; k++) {
    b->shells[b->shell_count] = (CagBrepShell){first + at[k], at[k + 1], closed, b->shell_count};
    b->shell_count++;
    at[k + 1] += at[k];
  }
  for (size_t f = 0; f < n; f++) sorted[at[set[f]]++] = b->faces[first + f];
  memcpy(b->faces + first, sorted, n * sizeof *sorted);
  cag_free(at);
  cag_free(sorted);
  return CAG_OK;
}

static CagStatus make_shells(CagBrepWork *w, bool *closed, CagError *err) {
  size_t n = w->brep->face_count - w->first_face;
  size_t *parent = cag_malloc((n + 1) * sizeof *parent), *set = cag_malloc((n + 1) * sizeof *set);
  CagStatus status = parent && set ? CAG_OK : cag_fail_memory(err);
  bool open = false;
  for (size_t f = 0; !status && f < n; f++) parent[f] = f;
  if (!status) status = connect(w, parent, &open, err);
  if (!status)
    status = sort_faces(w->brep, w->first_face, set, number_sets(parent, n, set), !open, err);
  *closed = !open;
  cag_free(parent);
  cag_free(set);
  return status;
}

// --- Cavities ---

// Computes the volume bounded by a shell of faces of the solid, which is negative if its normals
// point inward, and its box.
static CagStatus shell_volume(const CagBrep *b, const CagBrepShell *shell, const CagSolid *solid,
                              double *volume, CagBounds *box, CagError *err) {
  double terms[10] = {0};
  size_t last = SIZE_MAX;
  *box = CAG_BOUNDS_EMPTY;
  for (size_t f = shell->first; f < shell->first + shell->count; f++) {
    size_t source = b->faces[f].source;
    if (source == last) continue; // another part of the same surface
    last = source;
    CagBounds part;
    CagStatus status = cag_surface_volume_terms(solid->faces[source], terms, err);
    if (!status) status = cag_surface_bounds(solid->faces[source], &part, err);
    if (status) return status;
    cag_bounds_add(box, part.min);
    cag_bounds_add(box, part.max);
  }
  *volume = terms[0];
  return CAG_OK;
}

static bool holds(const CagBounds *a, const CagBounds *b) {
  return a->min.x <= b->min.x && a->min.y <= b->min.y && a->min.z <= b->min.z &&
         a->max.x >= b->max.x && a->max.y >= b->max.y && a->max.z >= b->max.z;
}

// Finds the shells of a solid that are cavities, each in the shell with the smallest enclosing box.
static CagStatus find_hollows(CagBrep *b, size_t first, const CagSolid *solid, CagError *err) {
  size_t n = b->shell_count - first;
  if (n < 2) return CAG_OK;
  double *volume = cag_malloc(n * sizeof *volume);
  CagBounds *box = cag_malloc(n * sizeof *box);
  CagStatus status = volume && box ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++)
    status = shell_volume(b, &b->shells[first + i], solid, &volume[i], &box[i], err);
  for (size_t i = 0; !status && i < n; i++) {
    if (!(volume[i] < 0)) continue;
    double best = INFINITY;
    for (size_t k = 0; k < n; k++)
      if (volume[k] > 0 && volume[k] < best && holds(&box[k], &box[i])) {
        best = volume[k];
        b->shells[first + i].void_of = first + k;
      }
  }
  cag_free(volume);
  cag_free(box);
  return status;
}

// --- Shapes ---

static double shape_tolerance(const CagScene *s, const CagItem *item) {
  return item->tolerance > 0 ? item->tolerance : s->tolerance;
}

// The normals of a closed surface point outward, as for a solid.
static CagStatus add_surface(CagBrepWork *w, const CagSurface *s, CagError *err) {
  CagSurface *outward;
  CagStatus status = cag_surface_outward(s, &outward, err);
  if (status) return status;
  status = cag_brep_add_surface(w, outward, 0, err);
  cag_surface_release(outward);
  return status;
}

static CagStatus add_faces(CagBrepWork *w, CagError *err) {
  const CagItem *item = w->item;
  switch (item->kind) {
  case CAG_ITEM_REGION: return cag_brep_add_region(w, item->as.region, &item->placement, 0, err);
  case CAG_ITEM_SURFACE: return add_surface(w, item->as.surface, err);
  default: {
    CagStatus status = CAG_OK;
    const CagSolid *solid = item->as.solid;
    for (size_t i = 0; !status && i < solid->face_count; i++)
      status = cag_brep_add_surface(w, solid->faces[i], i, err);
    return status;
  }
  }
}

// Computes the size of the sides so far, to which tolerances are relative.
static CagStatus measure(CagBrepWork *w, CagError *err) {
  CagBounds box = CAG_BOUNDS_EMPTY;
  for (size_t i = 0; i < w->side_count; i++) {
    CagBounds b = w->sides[i].curve->kind->hull(w->sides[i].curve, w->sides[i].curve->start,
                                                w->sides[i].curve->end);
    cag_bounds_add(&box, b.min);
    cag_bounds_add(&box, b.max);
  }
  double size = box.min.x <= box.max.x ? cag_norm(cag_sub(box.max, box.min)) : 0;
  if (!isfinite(size))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "", -1, "%s is too large",
                    w->item->name);
  // Two sides of an edge that were approximated separately may differ by twice the tolerance.
  w->same = fmax(SAME * size, w->approximate ? 2 * w->asked : 0);
  return CAG_OK;
}

static CagStatus add_bounded(CagBrepWork *w, CagBrepShape *shape, CagError *err) {
  CagBrep *b = w->brep;
  w->first_face = b->face_count;
  w->first_loop = b->loop_count;
  w->first_edge = b->edge_count;
  shape->first = b->shell_count;
  shape->kind = w->item->kind == CAG_ITEM_SOLID ? CAG_BREP_SOLID : CAG_BREP_SHEET;
  bool closed = false;
  CagStatus status = add_faces(w, err);
  if (!status) status = measure(w, err);
  if (!status) status = cag_brep_join(w, err);
  if (!status) status = make_shells(w, &closed, err);
  if (!status && shape->kind == CAG_BREP_SOLID && !closed)
    status = cag_fail(
        err, CAG_E_ARGUMENT, CAG_ERR_export_open, "", -1,
        "%s does not close within %g mm: some edges belong to only one face; show its surfaces instead, or write a mesh",
        w->item->name, w->same);
  // A closed surface is the boundary of a solid.
  if (!status && closed && w->item->kind == CAG_ITEM_SURFACE &&
      cag_surface_is_closed(w->item->as.surface))
    shape->kind = CAG_BREP_SOLID;
  if (!status && w->item->kind == CAG_ITEM_SOLID)
    status = find_hollows(b, shape->first, w->item->as.solid, err);
  shape->count = b->shell_count - shape->first;
  for (size_t i = 0; i < w->side_count; i++) cag_curve_release(w->sides[i].curve);
  cag_free(w->sides);
  return status;
}

// Adds the name of the shape to errors of the geometry.
static CagStatus name_shape(const CagItem *item, CagStatus status, CagError *err) {
  char said[sizeof err->message];
  if (status == CAG_E_CALLBACK || strstr(err->message, item->name)) return status;
  memcpy(said, err->message, sizeof said);
  snprintf(err->message, sizeof err->message, "%.80s: %.300s", item->name, said);
  return status;
}

// --- Boundaries from the kernel ---

// Makes room in all arrays for a boundary.
static bool reserve_boundary(CagBrep *b, const CagBoundary *from) {
  return cag_brep_reserve((void **)&b->vertices, b->vertex_count, from->corner_count,
                          sizeof *b->vertices) &&
         cag_brep_reserve((void **)&b->edges, b->edge_count, from->edge_count, sizeof *b->edges) &&
         cag_brep_reserve((void **)&b->uses, b->use_count, from->use_count, sizeof *b->uses) &&
         cag_brep_reserve((void **)&b->loops, b->loop_count, from->loop_count, sizeof *b->loops) &&
         cag_brep_reserve((void **)&b->faces, b->face_count, from->order_count, sizeof *b->faces) &&
         cag_brep_reserve((void **)&b->shells, b->shell_count, from->shell_count,
                          sizeof *b->shells);
}

static bool is_straight(const CagCurve *c) { return c && cag_brep_is_straight(c); }

// The edges and loops get new numbers, and the faces are in the order of the shells.
CagStatus cag_brep_add_boundary(CagBrep *b, const CagBoundary *from, CagError *err) {
  const size_t corner = b->vertex_count, edge = b->edge_count, use = b->use_count;
  const size_t loop = b->loop_count, face = b->face_count, shell = b->shell_count;
  if (!reserve_boundary(b, from)) return cag_fail_memory(err);
  for (size_t i = 0; i < from->corner_count; i++) b->vertices[b->vertex_count++] = from->corners[i];
  for (size_t i = 0; i < from->edge_count; i++) {
    const CagBoundaryEdge *e = &from->edges[i];
    b->edges[b->edge_count++] = (CagBrepEdge){.curve = e->curve ? cag_curve_retain(e->curve) : NULL,
                                              .from = corner + e->from,
                                              .to = corner + e->to,
                                              .straight = is_straight(e->curve),
                                              .timed = true};
    b->accuracy = fmax(b->accuracy, e->gap);
  }
  for (size_t i = 0; i < from->use_count; i++)
    b->uses[b->use_count++] =
        (CagBrepUse){edge + from->uses[i].edge, from->uses[i].reversed,
                     from->uses[i].trace ? cag_curve_retain(from->uses[i].trace) : NULL};
  for (size_t i = 0; i < from->loop_count; i++)
    b->loops[b->loop_count++] = (CagBrepLoop){use + from->loops[i].first, from->loops[i].count};
  for (size_t i = 0; i < from->order_count; i++) {
    const CagBoundaryFace *f = &from->faces[from->order[i]];
    CagBrepFace own = {.carrier = f->carrier, .reversed = f->reversed, .first = loop + f->first};
    memcpy(own.domain, f->domain, sizeof own.domain);
    own.count = f->count;
    own.source = from->order[i];
    if (own.carrier.spline) cag_surface_retain(own.carrier.spline);
    if (own.carrier.profile) cag_curve_retain(own.carrier.profile);
    b->faces[b->face_count++] = own;
  }
  for (size_t i = 0; i < from->shell_count; i++)
    b->shells[b->shell_count++] =
        (CagBrepShell){face + from->shells[i].first, from->shells[i].count, true, shell};
  return CAG_OK;
}

// The boundaries of an exact solid, placed.
static CagStatus copy_known(const CagSolid *s, CagBoundaries *out, CagError *err) {
  size_t n = 0;
  const CagBoundary *parts = cag_solid_boundaries(s, &n);
  CagStatus status = CAG_OK;
  *out = (CagBoundaries){.items = cag_calloc(n + 1, sizeof *out->items)};
  if (!out->items) return cag_fail_memory(err);
  while (!status && out->count < n) {
    status = cag_boundary_moved(&parts[out->count], &s->placement, &out->items[out->count], err);
    if (!status) out->count++;
  }
  return status; // the caller frees them
}

static CagStatus check_reading(CagKernel *kernel, const CagBoundaries *parts, CagBrepFormat format,
                               bool *same, CagError *err) {
  bool needed = true;
  CagStatus status = CAG_OK;
  if (format == CAG_BREP_STEP) status = cag_brep_needs_reading(parts, &needed, err);
  *same = !needed;
  return status || !needed ? status : cag_brep_reads_back(kernel, parts, format, same, err);
}

// Adds the parts of a set operation that other programs will read as they are. Where a face
// contains poles of a sphere, or runs around an axis, some read a file differently; then other
// poles and seams are tried.
static CagStatus add_operation(CagBrepWork *w, CagKernel *kernel, CagBrepFormat format,
                               CagBrepShape *shape, CagError *err) {
  CagBoundaries parts = {0};
  CagBrep *b = w->brep;
  if (!kernel) return cag_fail_memory(err);
  shape->kind = CAG_BREP_SOLID;
  shape->first = b->shell_count;
  CagStatus status = CAG_OK;
  double scale;
  bool same = false;
  const CagSolid *solid = w->item->as.solid;
  const bool known =
      solid->kind == CAG_SOLID_EXACT && cag_transform_is_similarity(&solid->placement, &scale);
  for (int turn = 0; !status && !same && turn < (known ? 1 : CAG_TURNS); turn++) {
    cag_boundaries_free(&parts);
    status = known
                 ? copy_known(solid, &parts, err)
                 : cag_kernel_boundary(kernel, solid, w->asked, turn, &parts, &w->approximate, err);
    if (!status) status = check_reading(kernel, &parts, format, &same, err);
  }
  if (!status && !same)
    status = cag_fail(
        err, CAG_E_DEGENERATE, CAG_ERR_no_boundary, "", -1,
        "Open CASCADE does not read the faces back as they are: turn round parts by a little, or write a mesh");
  for (size_t i = 0; !status && i < parts.count; i++)
    status = cag_brep_add_boundary(b, &parts.items[i], err);
  cag_boundaries_free(&parts);
  shape->count = b->shell_count - shape->first;
  return status;
}

static bool needs_kernel(const CagItem *item) {
  return item->kind == CAG_ITEM_SOLID &&
         (item->as.solid->kind == CAG_SOLID_EXACT || item->as.solid->face_count == 0);
}

// --- Meshes ---

// Whether a solid is a mesh, or a set operation with a mesh among its operands.
static bool has_mesh(const CagSolid *s) {
  if (s->kind == CAG_SOLID_MESH) return true;
  for (size_t i = 0; s->face_count == 0 && s->core && i < s->core->count; i++)
    if (has_mesh(s->core->operands[i])) return true;
  return false;
}

static bool is_faceted(const CagItem *item) {
  return item->kind == CAG_ITEM_MESH || (item->kind == CAG_ITEM_SOLID && has_mesh(item->as.solid));
}

// A mesh of which the exact form is not known. Set operations are meshed within the tolerance of the
// item.
static CagStatus add_facets(CagBrepWork *w, CagBrepShape *shape, CagError *err) {
  const CagItem *item = w->item;
  CagMesh *m;
  CagStatus status = cag_item_mesh(w->scene, item, &m, err);
  if (status) return status;
  const size_t triangles = m->triangle_count;
  status = cag_brep_add_facets(w->brep, m, shape, err);
  cag_mesh_release(m);
  if (!status && triangles == 0)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_no_boundary, "", -1, "nothing is left of it");
  if (status && err->id == CAG_ERR_mesh_open)
    return cag_fail(
        err, CAG_E_UNSUPPORTED, CAG_ERR_export_mesh, "", -1,
        "%s is a mesh that is not closed, but files of exact geometry contain solids: close it (`mesh_check` tells where it is open, and `weld` merges vertices), or write .stl, .obj, .ply, or .glb",
        item->name);
  const bool own = item->kind == CAG_ITEM_MESH || item->as.solid->kind == CAG_SOLID_MESH;
  w->asked = own ? 0 : cag_item_tolerance(w->scene, item);
  return status;
}

static CagStatus add_item(CagBrep *b, const CagScene *scene, const CagItem *item, CagKernel *kernel,
                          CagBrepFormat format, CagError *err) {
  CagBrepWork w = {.brep = b, .scene = scene, .item = item, .asked = shape_tolerance(scene, item)};
  CagBrepShape shape = {.name = item->name, .material = &scene->materials[item->material]};
  CagStatus status;
  if (item->kind == CAG_ITEM_CURVE) {
    shape.kind = CAG_BREP_CURVE;
    status = cag_brep_curve(&w, item->as.curve, &shape.curve, err);
  } else if (is_faceted(item)) {
    status = add_facets(&w, &shape, err);
  } else if (needs_kernel(item)) {
    status = add_operation(&w, kernel, format, &shape, err);
  } else {
    bool done = false;
    status = item->kind == CAG_ITEM_SOLID ? cag_brep_add_form(b, item->as.solid, &shape, &done, err)
                                          : CAG_OK;
    if (!status && !done) status = add_bounded(&w, &shape, err);
  }
  if (status) return name_shape(item, status, err);
  shape.approximate = w.approximate;
  shape.tolerance = w.asked;
  b->shapes[b->shape_count++] = shape;
  return CAG_OK;
}

CagStatus cag_brep_of_scene(const CagScene *scene, CagKernel *kernel, CagBrepFormat format,
                            CagBrep *out, CagError *err) {
  *out = (CagBrep){.accuracy = ACCURACY_MIN};
  out->shapes = cag_calloc(scene->item_count + 1, sizeof *out->shapes);
  if (!out->shapes) return cag_fail_memory(err);
  for (size_t i = 0; i < scene->item_count; i++) {
    if (scene->interrupt && *scene->interrupt)
      return cag_fail(err, CAG_E_CALLBACK, CAG_ERR_interrupted, "", -1,
                      "the export was interrupted");
    if (scene->items[i].kind == CAG_ITEM_GROUND) continue;
    CagStatus status = add_item(out, scene, &scene->items[i], kernel, format, err);
    if (status) return status;
  }
  if (out->shape_count == 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_nothing_to_show, "", -1,
                    "the script shows no shape");
  return CAG_OK;
}
