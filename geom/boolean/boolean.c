// Set operations of solids: validation of the operands, the sequence of steps, and operations on
// many operands.

#include "geom/boolean/boolean.h"

#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/boolean/work.h"
#include "geom/mesh/edges.h"

// Products of three coordinates must stay far from overflow.
#define MOST_COORDINATE 1e100

// Points that are meant to coincide or to be coplanar may be this far apart, relative to the
// largest coordinate: tens of thousands of rounding errors, since operands may have been
// transformed before.
#define SNAP 1e-11

// An operand and its name in messages: an argument, or an item of a list (index; -1: not a list).
typedef struct Operand {
  const CagMesh *mesh;
  const char *argument;
  long index;
} Operand;

// Operand names are "`a`" or "`meshes[3]`".
static const char *name_of(const Operand *o, char text[64]) {
  if (o->index < 0) snprintf(text, 64, "`%s`", o->argument);
  else snprintf(text, 64, "`%s[%ld]`", o->argument, o->index);
  return text;
}

CagStatus cag_bool_stopped(const BoolWork *w) {
  if ((!w->interrupt || !*w->interrupt) && !cag_stopped()) return CAG_OK;
  return cag_fail(w->err, CAG_E_CALLBACK, CAG_ERR_interrupted, "", -1,
                  "the set operation was interrupted");
}

// --- Reading ---

static CagStatus read_points(BoolWork *w, const Operand *o, uint32_t *number) {
  char name[64];
  for (size_t i = 0; i < o->mesh->vertex_count; i++) {
    const CagVec3 p = o->mesh->positions[i];
    const bool fits = fabs(p.x) <= MOST_COORDINATE && fabs(p.y) <= MOST_COORDINATE &&
                      fabs(p.z) <= MOST_COORDINATE;
    if (!fits)
      return cag_fail(
          w->err, CAG_E_ARGUMENT, CAG_ERR_vertex_out_of_range, o->argument,
          o->index < 0 ? (long)i : o->index,
          "coordinates of operands must be at most 1e100: vertex %zu of %s is [%g, %g, %g]", i,
          name_of(o, name), p.x, p.y, p.z);
    number[i] = cag_bool_points_add(&w->points, p);
    if (number[i] == BOOL_NONE) return cag_fail_memory(w->err);
    if (cag_stop_check(w->err)) return w->err->status;
  }
  return CAG_OK;
}

static CagStatus open_at(BoolWork *w, const Operand *o, const CagMeshEdge *e, size_t ahead,
                         size_t back) {
  const CagVec3 p = w->points.at[e->low], q = w->points.at[e->high];
  char name[64];
  return cag_fail(
      w->err, CAG_E_ARGUMENT, CAG_ERR_mesh_open, o->argument,
      o->index < 0 ? (long)cag_mesh_edge_triangle(e) : o->index,
      "the mesh of %s must be closed, with each edge traversed once in each direction: the edge from [%g, %g, %g] to [%g, %g, %g] is traversed %zu times forward and %zu times backward",
      name_of(o, name), p.x, p.y, p.z, q.x, q.y, q.z, ahead, back);
}

static CagStatus check_closed(BoolWork *w, const Operand *o, const uint32_t *triangles) {
  size_t n = 0;
  CagMeshEdge *e = cag_mesh_edges(triangles, o->mesh->triangle_count, NULL, w->points.n, &n);
  if (!e) return cag_fail_memory(w->err);
  CagStatus status = CAG_OK;
  for (size_t i = 0, uses; !status && i < n; i += uses) {
    size_t ahead = 0;
    for (uses = 0; i + uses < n && e[i + uses].low == e[i].low && e[i + uses].high == e[i].high;)
      ahead += cag_mesh_edge_forward(&e[i + uses++]);
    if (2 * ahead != uses) status = open_at(w, o, &e[i], ahead, uses - ahead);
  }
  cag_free(e);
  return status;
}

static CagStatus check_sense(BoolWork *w, const Operand *o) {
  const double rounding = 1e-9; // of the volume, for thin meshes
  const CagMesh *m = o->mesh;
  double sum = 0, size = 0, area = 0, most = 0;
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    const CagVec3 tip = m->positions[m->triangles[0]];
    const CagVec3 a = cag_sub(m->positions[k[0]], tip), b = cag_sub(m->positions[k[1]], tip);
    const double volume = cag_dot(a, cag_cross(b, cag_sub(m->positions[k[2]], tip)));
    sum += volume;
    size += fabs(volume);
    area += cag_norm(cag_cross(cag_sub(b, a), cag_sub(m->positions[k[2]], m->positions[k[0]])));
  }
  for (size_t i = 0; i < m->vertex_count; i++) most = fmax(most, cag_norm(m->positions[i]));
  char name[64];
  // Within rounding, results of other operations may be oriented either way.
  if (sum >= -rounding * size - SNAP * most * area) return CAG_OK;
  return cag_fail(
      w->err, CAG_E_ARGUMENT, CAG_ERR_mesh_inside_out, o->argument, o->index,
      "the triangles of %s must be counter-clockwise as seen from outside, but its volume is %g; reverse it with `flip`",
      name_of(o, name), sum / 6);
}

// A face of both operands, or a repeated face, is stored once: a hash table keyed by its corners.
typedef struct FaceTable {
  uint32_t *slots;
  size_t mask;
  BoolList thin; // of BoolFace: those without area, which may get some when corners are merged
} FaceTable;

static void sort_corners(const uint32_t v[3], uint32_t out[3], bool *odd) {
  memcpy(out, v, 3 * sizeof *out);
  *odd = false;
  for (int pass = 0; pass < 3; pass++) {
    const int k = pass % 2;
    if (out[k] < out[k + 1]) continue;
    const uint32_t x = out[k];
    out[k] = out[k + 1];
    out[k + 1] = x;
    *odd = !*odd;
  }
}

static void add_face(BoolWork *w, FaceTable *table, const BoolFace *face) {
  uint32_t v[3], u[3];
  bool odd, other;
  sort_corners(face->v, v, &odd);
  size_t at = (v[0] * 73856093u ^ v[1] * 19349663u ^ v[2] * 83492791u) & table->mask;
  for (; table->slots[at] != BOOL_NONE; at = (at + 1) & table->mask) {
    BoolFace *old = &w->faces[table->slots[at]];
    sort_corners(old->v, u, &other);
    if (memcmp(u, v, sizeof u)) continue;
    for (int k = 0; k < 2; k++) old->times[k] += odd == other ? face->times[k] : -face->times[k];
    return;
  }
  table->slots[at] = (uint32_t)w->face_count;
  w->faces[w->face_count++] = *face;
}

// Finds an axis along which the projection of the face has area; false: there is none.
static bool find_axis(BoolWork *w, BoolFace *f) {
  const CagVec3 a = w->points.at[f->v[0]];
  const CagVec3 n = cag_cross(cag_sub(w->points.at[f->v[1]], a), cag_sub(w->points.at[f->v[2]], a));
  const double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
  const int first = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
  for (int k = 0; k < 3; k++) {
    const int axis = (first + k) % 3;
    f->axis = (signed char)axis;
    f->sign = (signed char)cag_bool_turn(&w->points, f->v[0], f->v[1], f->v[2], axis);
    if (f->sign) return true;
  }
  return false;
}

// Triangles without area are kept apart: unless they get one, their neighbors are cut where they touch
// each other.
static bool keep_thin(FaceTable *table, const BoolFace *f) {
  if (!cag_bool_list_reserve(&table->thin, table->thin.n + 1, sizeof *f)) return false;
  ((BoolFace *)table->thin.items)[table->thin.n++] = *f;
  return true;
}

static bool has_three_corners(const BoolFace *f) {
  return f->v[0] != f->v[1] && f->v[1] != f->v[2] && f->v[2] != f->v[0];
}

// Ends early if the work is canceled. Returns false if memory runs out.
static bool add_faces(BoolWork *w, FaceTable *table, const CagMesh *m, const uint32_t *triangles,
                      int operand) {
  for (size_t t = 0; t < m->triangle_count && !cag_stopped(); t++) {
    BoolFace f = {.owner = (uint32_t)operand, .triangle = (uint32_t)t};
    memcpy(f.v, triangles + 3 * t, sizeof f.v);
    f.times[operand] = 1;
    if (!has_three_corners(&f)) continue;
    if (find_axis(w, &f)) add_face(w, table, &f);
    else if (!keep_thin(table, &f)) return false;
  }
  return true;
}

static CagStatus read_operand(BoolWork *w, const Operand *o, int operand, FaceTable *table) {
  const CagMesh *m = o->mesh;
  uint32_t *number = cag_malloc((m->vertex_count + 1) * sizeof *number);
  uint32_t *triangles = cag_malloc((3 * m->triangle_count + 1) * sizeof *triangles);
  CagStatus status = number && triangles ? read_points(w, o, number) : cag_fail_memory(w->err);
  for (size_t i = 0; !status && i < 3 * m->triangle_count; i++)
    triangles[i] = number[m->triangles[i]];
  if (!status) status = check_closed(w, o, triangles);
  if (!status) status = check_sense(w, o);
  if (!status && !add_faces(w, table, m, triangles, operand)) status = cag_fail_memory(w->err);
  if (!status) status = cag_stop_check(w->err);
  cag_free(number);
  cag_free(triangles);
  return status;
}

// --- Fans ---

static bool has_fan(const BoolWork *w) {
  uint32_t *count = cag_calloc(w->points.n + 1, sizeof *count);
  bool found = !count; // the search for flat faces then runs out of memory
  for (size_t i = 0; !found && i < w->face_count; i++)
    for (int k = 0; k < 3; k++) found = found || ++count[w->faces[i].v[k]] >= BOOL_FAN;
  cag_free(count);
  return found;
}

static bool is_of(const BoolFace *f, int operand) {
  return f->times[operand] == 1 && f->times[1 - operand] == 0;
}

// Retriangulates the flat faces of an operand; `parts` receives its triangles.
static bool open_fans(BoolWork *w, int operand, const BoolSource *sources, BoolPart **parts,
                      size_t *n) {
  *n = 0;
  *parts = cag_malloc((w->face_count + 1) * sizeof **parts);
  if (!*parts) return false;
  for (uint32_t i = 0; i < w->face_count; i++) {
    if (!is_of(&w->faces[i], operand)) continue;
    BoolPart *p = &(*parts)[(*n)++];
    *p = (BoolPart){.source = {i, i, i}};
    memcpy(p->v, w->faces[i].v, sizeof p->v);
  }
  return cag_bool_flatten(w, sources, true, parts, n);
}

// The outlines stay the same, so the number of faces cannot grow.
static bool replace_fans(BoolWork *w, FaceTable *table) {
  BoolSource *sources = cag_malloc((w->face_count + 1) * sizeof *sources);
  BoolPart *parts[2] = {NULL, NULL};
  BoolFace *old = w->faces, *faces = NULL;
  const size_t count = w->face_count;
  size_t n[2] = {0, 0};
  for (uint32_t i = 0; sources && i < count; i++) sources[i] = (BoolSource){i, false};
  bool done = sources != NULL;
  for (int k = 0; done && k < 2; k++) done = open_fans(w, k, sources, &parts[k], &n[k]);
  if (done) faces = cag_malloc((count + n[0] + n[1] + table->thin.n + 1) * sizeof *faces);
  done = faces != NULL;
  if (done) {
    memset(table->slots, 0xff, (table->mask + 1) * sizeof *table->slots);
    w->faces = faces;
    w->face_count = 0;
    for (size_t i = 0; i < count; i++)
      if (!is_of(&old[i], 0) && !is_of(&old[i], 1)) add_face(w, table, &old[i]);
  }
  for (int k = 0; done && k < 2; k++)
    for (size_t i = 0; i < n[k]; i++) {
      BoolFace f = old[parts[k][i].source[0]];
      memcpy(f.v, parts[k][i].v, sizeof f.v);
      if (find_axis(w, &f)) add_face(w, table, &f);
      else done = done && keep_thin(table, &f);
    }
  if (faces) cag_free(old);
  cag_free(sources);
  cag_free(parts[0]);
  cag_free(parts[1]);
  return done;
}

// --- Coincidence within rounding ---

static double slack_of(const BoolWork *w) {
  double size = 0;
  for (size_t i = 0; i < w->points.n; i++) {
    const CagVec3 p = w->points.at[i];
    size = fmax(size, fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))));
  }
  return SNAP * size;
}

// Sets the points that span the plane, oriented like the face.
static void set_plane(BoolWork *w, BoolFace *f, const uint32_t *plane) {
  memcpy(f->plane, f->v, sizeof f->plane);
  if (!plane || plane[0] == BOOL_NONE) return;
  memcpy(f->plane, plane, sizeof f->plane);
  if (cag_bool_normal_sign(&w->points, f->plane, f->axis) == f->sign) return;
  f->plane[1] = plane[2];
  f->plane[2] = plane[1];
}

// Renumbers the corners of a face and adds it, unless it collapses.
static bool add_renumbered(BoolWork *w, FaceTable *table, BoolFace f, const uint32_t *number,
                           const uint32_t *plane) {
  for (int k = 0; k < 3; k++) f.v[k] = number[f.v[k]];
  if (!has_three_corners(&f)) return true;
  if (!find_axis(w, &f)) return keep_thin(table, &f);
  set_plane(w, &f, plane);
  add_face(w, table, &f);
  return true;
}

// Renumbers the corners of all faces. plane: three numbers for each face, or NULL. Identical faces
// become one, and faces that lose their area go to the list of thin ones. Returns false if memory
// runs out.
static bool renumber(BoolWork *w, FaceTable *table, const uint32_t *number, const uint32_t *plane) {
  const size_t count = w->face_count;
  const BoolList thin = table->thin;
  bool done = true;
  memset(table->slots, 0xff, (table->mask + 1) * sizeof *table->slots);
  table->thin = (BoolList){0};
  w->face_count = 0;
  for (size_t i = 0; done && i < count; i++)
    done = add_renumbered(w, table, w->faces[i], number, plane ? plane + 3 * i : NULL);
  for (size_t i = 0; done && i < thin.n; i++)
    done = add_renumbered(w, table, ((BoolFace *)thin.items)[i], number, NULL);
  cag_free(thin.items);
  cag_bool_forget_pairs(w);
  return done;
}

// Drops faces that cancel out.
static void drop_faces(BoolWork *w) {
  size_t kept = 0;
  for (size_t f = 0; f < w->face_count; f++)
    if (w->faces[f].times[0] || w->faces[f].times[1]) w->faces[kept++] = w->faces[f];
  w->face_count = kept;
}

static CagStatus snap(BoolWork *w, FaceTable *table) {
  uint32_t *number = cag_malloc((w->points.n + 1) * sizeof *number);
  uint32_t *plane = cag_malloc((3 * (w->face_count + table->thin.n) + 3) * sizeof *plane);
  bool found;
  CagStatus status = number && plane ? CAG_OK : cag_fail_memory(w->err);
  w->slack = slack_of(w);
  if (!status) status = cag_bool_find_twins(w, number, &found);
  if (!status && found && !renumber(w, table, number, NULL)) status = cag_fail_memory(w->err);
  if (!status && found) drop_faces(w);
  if (!status) status = cag_bool_find_planes(w, number, plane, &found);
  if (!status && found && !renumber(w, table, number, plane)) status = cag_fail_memory(w->err);
  if (!status && found) drop_faces(w);
  cag_free(number);
  cag_free(plane);
  return status;
}

static CagStatus read_operands(BoolWork *w, const Operand o[2]) {
  const size_t triangles = o[0].mesh->triangle_count + o[1].mesh->triangle_count;
  const size_t vertices = o[0].mesh->vertex_count + o[1].mesh->vertex_count;
  if (triangles > UINT32_MAX / 16 || vertices > UINT32_MAX / 16)
    return cag_fail(
        w->err, CAG_E_LIMIT, CAG_ERR_mesh_too_large, o[0].argument, -1,
        "operands can have at most %lu vertices and triangles together, found %zu and %zu",
        (unsigned long)UINT32_MAX / 16, vertices, triangles);
  FaceTable table = {.mask = 1023};
  while (table.mask < 2 * triangles) table.mask = 2 * table.mask + 1;
  table.slots = cag_malloc((table.mask + 1) * sizeof *table.slots);
  w->faces = cag_malloc((triangles + 1) * sizeof *w->faces);
  CagStatus status = CAG_OK;
  if (!table.slots || !w->faces || !cag_bool_points_start(&w->points, vertices))
    status = cag_fail_memory(w->err);
  else memset(table.slots, 0xff, (table.mask + 1) * sizeof *table.slots);
  for (int k = 0; !status && k < 2; k++) status = read_operand(w, &o[k], k, &table);
  w->corners = w->points.n;
  if (!status && has_fan(w) && !replace_fans(w, &table)) {
    status = cag_bool_stopped(w);
    if (!status) status = cag_fail_memory(w->err);
  }
  for (size_t f = 0; !status && f < w->face_count; f++) set_plane(w, &w->faces[f], NULL);
  if (!status) drop_faces(w);
  if (!status) status = snap(w, &table);
  w->corners = w->points.n;
  cag_free(table.slots);
  cag_free(table.thin.items);
  return status;
}

// --- Operations ---

static void free_work(BoolWork *w) {
  cag_bool_points_free(&w->points);
  cag_free(w->faces);
  cag_bool_forget_pairs(w);
  cag_free(w->plane_of);
  cag_free(w->touched);
  cag_free(w->contacts.items);
  cag_free(w->pieces.items);
  cag_free(w->winding);
}

static CagStatus solve(BoolWork *w, CagSetOperation op, CagMesh **out) {
  CagStatus status = cag_bool_find_contacts(w);
  if (!status) status = cag_bool_cut_faces(w);
  if (!status) status = cag_bool_find_windings(w);
  return status ? status : cag_bool_build(w, op, out);
}

static CagStatus operate(CagSetOperation op, const Operand o[2], const CagBooleanHow *how,
                         CagMesh **out, CagError *err) {
  BoolWork w = {.meshes = {o[0].mesh, o[1].mesh}, .err = err};
  w.whole = how->keep_flat;
  w.interrupt = how->interrupt;
  CagStatus status = cag_bool_stopped(&w);
  if (!status) status = read_operands(&w, o);
  if (!status) status = solve(&w, op, out);
  free_work(&w);
  return status;
}

CagStatus cag_mesh_boolean(CagSetOperation op, const CagMesh *a, const CagMesh *b,
                           const volatile int *interrupt, CagMesh **out, CagError *err) {
  const Operand operands[2] = {{a, "a", -1}, {b, "b", -1}};
  const CagBooleanHow how = {.interrupt = interrupt};
  return operate(op, operands, &how, out, err);
}

// Combines the halves of the list recursively, so that each triangle takes part in about log2 n
// operations. *out: a mesh owned by the caller, or (*made false) an operand itself.
static CagStatus fold(CagSetOperation op, const Operand *o, size_t n, const CagBooleanHow *how,
                      Operand *out, bool *made, CagError *err) {
  *out = o[0];
  *made = false;
  if (n == 1) return CAG_OK;
  Operand half[2];
  bool own[2];
  CagMesh *m = NULL;
  CagStatus status = fold(op, o, n / 2, how, &half[0], &own[0], err);
  if (status) return status;
  status = fold(op, o + n / 2, n - n / 2, how, &half[1], &own[1], err);
  if (status) own[1] = false;
  else status = operate(op, half, how, &m, err);
  for (int k = 0; k < 2; k++)
    if (own[k]) cag_mesh_release((CagMesh *)half[k].mesh);
  out->mesh = m;
  *made = true;
  return status;
}

// Combines the first operand with the second. A single operand is united with nothing, which
// resolves parts that cross each other.
static CagStatus finish(CagSetOperation op, const Operand o[2], size_t n, const CagBooleanHow *how,
                        CagMesh **out, CagError *err) {
  if (n > 1) return operate(op, o, how, out, err);
  CagMesh *empty = NULL;
  CagStatus status = cag_mesh_new(0, 0, false, false, false, &empty, err);
  if (status) return status;
  const Operand pair[2] = {o[0], {empty, o[0].argument, o[0].index}};
  status = operate(CAG_UNION, pair, how, out, err);
  cag_mesh_release(empty);
  return status;
}

CagStatus cag_mesh_boolean_many(CagSetOperation op, const CagMesh *const *meshes, size_t n,
                                const CagBooleanHow *how, CagMesh **out, CagError *err) {
  const CagBooleanHow usual = {0};
  if (!how) how = &usual;
  if (n == 0) return cag_mesh_new(0, 0, false, false, false, out, err);
  Operand *o = cag_malloc(n * sizeof *o), pair[2];
  if (!o) return cag_fail_memory(err);
  for (size_t i = 0; i < n; i++) o[i] = (Operand){meshes[i], "meshes", (long)i};
  bool made[2] = {false, false};
  CagStatus status;
  if (n == 1) pair[0] = o[0], status = CAG_OK;
  else if (op == CAG_DIFFERENCE) {
    pair[0] = o[0];
    status = fold(CAG_UNION, o + 1, n - 1, how, &pair[1], &made[1], err);
  } else {
    status = fold(op, o, n / 2, how, &pair[0], &made[0], err);
    if (!status) status = fold(op, o + n / 2, n - n / 2, how, &pair[1], &made[1], err);
    else made[0] = false;
  }
  if (status) made[1] = false;
  else status = finish(op, pair, n, how, out, err);
  for (int k = 0; k < 2; k++)
    if (made[k]) cag_mesh_release((CagMesh *)pair[k].mesh);
  cag_free(o);
  return status;
}
