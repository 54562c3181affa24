// Meshes of boundaries: edges are divided first, then each face is triangulated within the points
// of its loops (geom/tessellate/within.h).
//
// Points are numbered over the whole boundary: corners first, then the inner points of edges. A
// degenerate edge, at a pole of its carrier, has entries in the outline of its face that are all its
// corner.

#include "geom/boundary/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/boundary/meshed.h"
#include "geom/boundary/patch.h"
#include "geom/tessellate/within.h"

// Edges are divided for a tolerance smaller by this factor, after chords crossed each other, ...
#define FINER 0.25
// ... at most this many times.
#define TRIES 4
// Rounds in which edges within faces are divided because others have the same ends.
#define ROUNDS 4
// Parts of a degenerate edge on a carrier whose first parameter is not an angle.
#define POLE_PARTS 12

typedef struct Division {
  double *at; // ascending parameters of the edge, both ends included
  size_t n;
  size_t first; // number of the first inner point
} Division;

typedef struct Mesher {
  const CagBoundary *b;
  CagTessellation how;  // of faces
  CagTessellation edge; // of edges
  Division *divisions;
  CagPatch *patches;
  CagCurve **traces; // of uses, in the parameters of patches
  CagVec3 *points;
  size_t count;
  CagMesh **meshes;     // of faces
  uint32_t (*apart)[2]; // points that edges within faces must not join, ascending
  size_t apart_count;
} Mesher;

static void mesher_free(Mesher *m) {
  for (size_t i = 0; m->divisions && i < m->b->edge_count; i++) cag_free(m->divisions[i].at);
  for (size_t i = 0; m->traces && i < m->b->use_count; i++) cag_curve_release(m->traces[i]);
  for (size_t i = 0; m->patches && i < m->b->face_count; i++) cag_patch_release(&m->patches[i]);
  for (size_t i = 0; m->meshes && i < m->b->face_count; i++) cag_mesh_release(m->meshes[i]);
  cag_free(m->divisions);
  cag_free(m->traces);
  cag_free(m->patches);
  cag_free(m->meshes);
  cag_free(m->points);
  cag_free(m->apart);
}

// --- Faces on their carriers ---

static CagStatus find_traces(Mesher *m, size_t face, CagError *err) {
  const CagBoundaryFace *f = &m->b->faces[face];
  CagStatus status = cag_stop_check(err);
  for (size_t l = f->first; !status && l < f->first + f->count; l++) {
    const CagBoundaryLoop *loop = &m->b->loops[l];
    for (size_t i = loop->first; !status && i < loop->first + loop->count; i++)
      status = cag_patch_trace(&m->patches[face], m->b->uses[i].trace, &m->traces[i], err);
  }
  return status;
}

static CagStatus begin(Mesher *m, CagError *err) {
  const CagBoundary *b = m->b;
  m->divisions = cag_calloc(b->edge_count + 1, sizeof *m->divisions);
  m->patches = cag_calloc(b->face_count + 1, sizeof *m->patches);
  m->traces = cag_calloc(b->use_count + 1, sizeof *m->traces);
  m->meshes = cag_calloc(b->face_count + 1, sizeof *m->meshes);
  if (!m->divisions || !m->patches || !m->traces || !m->meshes) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (size_t f = 0; !status && f < b->face_count; f++) {
    status = cag_patch_of_face(b, f, &m->patches[f], err);
    if (!status) status = find_traces(m, f, err);
  }
  return status;
}

// --- Edges ---

// The parameters of an edge's own polyline. An edge with one corner has at least three parts.
static CagStatus divide_curve(const Mesher *m, const CagBoundaryEdge *e, Division *d,
                              CagError *err) {
  const double angle = m->edge.angle > 0 ? m->edge.angle : M_PI / 2;
  CagStatus status =
      cag_curve_discretize_short(e->curve, m->edge.tolerance, angle,
                                 m->edge.short_edge * m->edge.tolerance, &d->at, &d->n, err);
  const size_t least = e->from == e->to ? 4 : 2;
  if (status || d->n >= least) return status;
  if (!CAG_RESIZE(d->at, least)) return cag_fail_memory(err);
  for (size_t k = 0; k < least; k++)
    d->at[k] =
        e->curve->start + (e->curve->end - e->curve->start) * (double)k / (double)(least - 1);
  d->n = least;
  return CAG_OK;
}

// The number of parts of a chord of an edge along which the normal of a face does not turn too far,
// and which are not too long.
static CagStatus parts_of_chord(const Mesher *m, size_t face, size_t use, double from, double to,
                                size_t *parts, CagError *err) {
  const CagCurve *curve = m->b->edges[m->b->uses[use].edge].curve;
  const CagSurface *whole = m->patches[face].whole;
  CagVec3 p, q;
  *parts = 1;
  CagStatus status = cag_curve_point(curve, from, &p, err);
  if (!status) status = cag_curve_point(curve, to, &q, err);
  if (status) return status;
  const double length = cag_norm(cag_sub(q, p)), longest = m->edge.max_edge;
  if (whole)
    status = cag_loop_points_parts(whole, m->traces[use], from, to, length, &m->edge, parts, err);
  if (longest > 0 && ceil(length / longest) > (double)*parts)
    *parts = (size_t)fmin(ceil(length / longest), (double)m->edge.max_triangles);
  return status;
}

// Divides the parts of an edge that are too long for a face that uses it.
static CagStatus divide_for_face(const Mesher *m, size_t face, size_t use, Division *d,
                                 CagError *err) {
  size_t *parts = cag_malloc((d->n + 1) * sizeof *parts), n = 1;
  CagStatus status = parts ? CAG_OK : cag_fail_memory(err);
  for (size_t k = 0; !status && k + 1 < d->n; k++) {
    status = parts_of_chord(m, face, use, d->at[k], d->at[k + 1], &parts[k], err);
    n += parts[k];
    if (!status && n > m->edge.max_triangles + 2)
      status = cag_fail(
          err, CAG_E_LIMIT, CAG_ERR_limit_triangles, "tolerance", -1,
          "an edge alone needs more triangles than the limit of %zu; use a larger tolerance",
          m->edge.max_triangles);
  }
  double *at = status || n == d->n ? NULL : cag_malloc((n + 1) * sizeof *at);
  if (!status && n != d->n && !at) status = cag_fail_memory(err);
  if (at) {
    size_t i = 0;
    for (size_t k = 0; k + 1 < d->n; k++)
      for (size_t j = 0; j < parts[k]; j++)
        at[i++] = d->at[k] + (d->at[k + 1] - d->at[k]) * (double)j / (double)parts[k];
    at[i] = d->at[d->n - 1];
    cag_free(d->at);
    d->at = at;
    d->n = n;
  }
  cag_free(parts);
  return status;
}

static bool is_curved(const CagCurve *c) {
  bool straight;
  CagError ignored;
  return cag_curve_is_straight(c, &straight, &ignored) || !straight;
}

// Of several edges between the same two corners that are single chords, the curved ones are halved:
// their chords must differ.
static CagStatus part_equal_chords(Mesher *m, CagError *err) {
  const CagBoundary *b = m->b;
  uint32_t *last = cag_calloc(b->corner_count + 1, sizeof *last); // edges by their lower corner
  uint32_t *next = cag_calloc(b->edge_count + 1, sizeof *next);
  CagStatus status = last && next ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < b->edge_count; i++) {
    const CagBoundaryEdge *e = &b->edges[i];
    const size_t low = e->from < e->to ? e->from : e->to, high = e->from + e->to - low;
    if (!e->curve || m->divisions[i].n != 2) continue;
    for (uint32_t k = last[low]; !status && k; k = next[k - 1]) {
      const CagBoundaryEdge *other = &b->edges[k - 1];
      if (other->from + other->to - low != high) continue;
      const size_t which = is_curved(e->curve) ? i : k - 1;
      Division *d = &m->divisions[which];
      if (d->n != 2) continue;
      if (!CAG_RESIZE(d->at, 3)) status = cag_fail_memory(err);
      if (status) break;
      d->at[2] = d->at[1];
      d->at[1] = (d->at[0] + d->at[2]) / 2;
      d->n = 3;
    }
    next[i] = last[low];
    last[low] = (uint32_t)i + 1;
  }
  cag_free(last);
  cag_free(next);
  return status;
}

static CagStatus divide_edges(Mesher *m, CagError *err) {
  const CagBoundary *b = m->b;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < b->edge_count; i++) {
    cag_free(m->divisions[i].at);
    m->divisions[i] = (Division){0};
    status = cag_stop_check(err);
    if (!status && b->edges[i].curve) status = divide_curve(m, &b->edges[i], &m->divisions[i], err);
  }
  for (size_t f = 0; !status && f < b->face_count; f++)
    for (size_t l = 0; !status && l < b->faces[f].count; l++) {
      const CagBoundaryLoop *loop = &b->loops[b->faces[f].first + l];
      for (size_t i = loop->first; !status && i < loop->first + loop->count; i++)
        if (b->edges[b->uses[i].edge].curve)
          status = divide_for_face(m, f, i, &m->divisions[b->uses[i].edge], err);
    }
  return status ? status : part_equal_chords(m, err);
}

static CagStatus number_points(Mesher *m, CagError *err) {
  const CagBoundary *b = m->b;
  m->count = b->corner_count;
  for (size_t i = 0; i < b->edge_count; i++) {
    Division *d = &m->divisions[i];
    d->first = m->count;
    if (d->n > 2) m->count += d->n - 2;
  }
  if (m->count > m->how.max_triangles + 2)
    return cag_fail(err, CAG_E_LIMIT, CAG_ERR_limit_triangles, "tolerance", -1,
                    "the edges alone need more triangles than the limit of %zu; use a larger "
                    "tolerance",
                    m->how.max_triangles);
  cag_free(m->points);
  m->points = cag_malloc((m->count + 1) * sizeof *m->points);
  if (!m->points) return cag_fail_memory(err);
  if (b->corner_count) memcpy(m->points, b->corners, b->corner_count * sizeof *m->points);
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < b->edge_count; i++) {
    const Division *d = &m->divisions[i];
    for (size_t k = 1; !status && k + 1 < d->n; k++)
      status = cag_curve_point(b->edges[i].curve, d->at[k], &m->points[d->first + k - 1], err);
  }
  return status;
}

// --- Faces ---

static size_t point_of(const Mesher *m, const CagBoundaryUse *use, size_t k) {
  const CagBoundaryEdge *e = &m->b->edges[use->edge];
  const Division *d = &m->divisions[use->edge];
  return k == 0 ? e->from : k + 1 == d->n ? e->to : d->first + k - 1;
}

static CagStatus add_entry(const Mesher *m, size_t use, double t, size_t point, CagLoopPoints *o,
                           CagError *err) {
  CagVec3 uv;
  CagStatus status = cag_curve_point(m->traces[use], t, &uv, err);
  return status ? status
                : cag_loop_points_add(o, uv.x, uv.y, m->points[point], (uint32_t)point, err);
}

// The entries of a degenerate edge, evenly along its trace.
static CagStatus add_pole(const Mesher *m, size_t use, size_t face, CagLoopPoints *o,
                          CagError *err) {
  const CagCurve *trace = m->traces[use];
  const CagBoundaryUse *u = &m->b->uses[use];
  const CagSurface *whole = m->patches[face].whole;
  CagVec3 ends[2];
  CagStatus status = cag_curve_point(trace, trace->start, &ends[0], err);
  if (!status) status = cag_curve_point(trace, trace->end, &ends[1], err);
  if (status) return status;
  const double turn = whole && whole->angular_v && m->how.angle > 0
                          ? fabs(ends[1].y - ends[0].y) / m->how.angle
                          : POLE_PARTS;
  const size_t n = (size_t)fmin(fmax(1, ceil(turn)), 1e4);
  for (size_t k = 0; !status && k < n; k++) {
    const double f = (double)(u->reversed ? n - k : k) / (double)n;
    const double t = trace->start + (trace->end - trace->start) * f;
    status = add_entry(m, use, t, m->b->edges[u->edge].from, o, err);
  }
  return status;
}

// Adds all entries of a use but its last.
static CagStatus add_use(const Mesher *m, size_t use, size_t face, CagLoopPoints *o,
                         CagError *err) {
  const CagBoundaryUse *u = &m->b->uses[use];
  const Division *d = &m->divisions[u->edge];
  CagStatus status = CAG_OK;
  if (!m->b->edges[u->edge].curve) return add_pole(m, use, face, o, err);
  for (size_t k = 0; !status && k + 1 < d->n; k++) {
    const size_t at = u->reversed ? d->n - 1 - k : k;
    status = add_entry(m, use, d->at[at], point_of(m, u, at), o, err);
  }
  return status;
}

// Plane faces are triangulated over their parallelogram, whose parameters run from 0 to 1.
static CagStatus mesh_plane(const Mesher *m, size_t face, CagLoopPoints *o, CagMesh **out,
                            CagError *err) {
  const CagTransform *frame = &m->patches[face].plane;
  CagBounds box = CAG_BOUNDS_EMPTY;
  CagSurface *plane;
  for (size_t k = 0; k < o->count; k++)
    cag_bounds_add(&box, cag_vec3(o->uv[2 * k], o->uv[2 * k + 1], 0));
  const double low[2] = {box.min.x, box.min.y};
  const double size[2] = {box.max.x - box.min.x, box.max.y - box.min.y};
  const CagVec3 x = cag_transform_vector(frame, cag_vec3(size[0], 0, 0));
  const CagVec3 y = cag_transform_vector(frame, cag_vec3(0, size[1], 0));
  CagStatus status =
      cag_surface_parallelogram(cag_transform_point(frame, box.min), x, y, &plane, err);
  if (status) return status;
  for (size_t k = 0; k < 2 * o->count; k++) o->uv[k] = (o->uv[k] - low[k % 2]) / size[k % 2];
  status = cag_within_tessellate(plane, (const double[]){0, 1, 0, 1}, o, &m->how, out, err);
  cag_surface_release(plane);
  return status;
}

static CagStatus mesh_curved(const CagSurface *whole, const CagLoopPoints *o,
                             const CagTessellation *how, CagMesh **out, CagError *err) {
  double box[4] = {INFINITY, -INFINITY, INFINITY, -INFINITY};
  for (size_t k = 0; k < o->count; k++) {
    box[0] = fmin(box[0], o->uv[2 * k]);
    box[1] = fmax(box[1], o->uv[2 * k]);
    box[2] = fmin(box[2], o->uv[2 * k + 1]);
    box[3] = fmax(box[3], o->uv[2 * k + 1]);
  }
  box[0] = fmax(box[0], whole->u0);
  box[1] = fmin(box[1], whole->u1);
  box[2] = fmax(box[2], whole->v0);
  box[3] = fmin(box[3], whole->v1);
  return cag_within_tessellate(whole, box, o, how, out, err);
}

// Replaces the `weld` of a face by numbers of points, and, above all of these, its own vertices.
static void name_vertices(CagMesh *m, const CagLoopPoints *o, size_t points) {
  for (size_t k = 0; k < m->vertex_count; k++) {
    const uint32_t first = m->weld[k];
    m->weld[k] = first < o->count ? o->points[first] : (uint32_t)(points + first);
  }
}

static CagStatus mesh_face(const Mesher *m, size_t face, CagMesh **out, CagError *err) {
  const CagBoundaryFace *f = &m->b->faces[face];
  size_t *counts = cag_malloc((f->count + 1) * sizeof *counts);
  CagLoopPoints o = {.counts = counts,
                     .loops = f->count,
                     .apart = (const uint32_t(*)[2])m->apart,
                     .apart_count = m->apart_count};
  CagStatus status = counts ? cag_stop_check(err) : cag_fail_memory(err);
  for (size_t l = 0; !status && l < f->count; l++) {
    const CagBoundaryLoop *loop = &m->b->loops[f->first + l];
    const size_t before = o.count;
    for (size_t i = 0; !status && i < loop->count; i++)
      status = add_use(m, loop->first + i, face, &o, err);
    counts[l] = o.count - before;
  }
  const CagSurface *whole = m->patches[face].whole;
  if (!status)
    status = whole ? mesh_curved(whole, &o, &m->how, out, err) : mesh_plane(m, face, &o, out, err);
  if (!status) name_vertices(*out, &o, m->count);
  cag_loop_points_free(&o);
  cag_free(counts);
  return status;
}

// --- All faces ---

// Joins the meshes of the faces, whose vertices have the numbers of name_vertices.
static CagStatus join_faces(const Mesher *m, CagMesh **out, CagError *err) {
  CagMesh *all = NULL;
  uint32_t *first = cag_malloc((m->count + 1) * sizeof *first);
  if (!first) return cag_fail_memory(err);
  for (size_t i = 0; i < m->count; i++) first[i] = UINT32_MAX;
  CagStatus status = cag_mesh_append(m->meshes, m->b->face_count, &all, err);
  size_t v = 0;
  for (size_t f = 0; !status && f < m->b->face_count; f++) {
    const CagMesh *part = m->meshes[f];
    for (size_t k = 0; k < part->vertex_count; k++) {
      const size_t name = part->weld[k];
      if (name >= m->count) all->weld[v + k] = (uint32_t)(v + name - m->count);
      else {
        if (first[name] == UINT32_MAX) first[name] = (uint32_t)(v + k);
        all->weld[v + k] = first[name];
      }
    }
    v += part->vertex_count;
  }
  cag_free(first);
  if (!status) *out = all;
  return status;
}

static int by_pair(const void *a, const void *b) {
  const uint32_t *x = a, *y = b;
  for (int k = 0; k < 2; k++)
    if (x[k] != y[k]) return x[k] < y[k] ? -1 : 1;
  return 0;
}

// All edges of triangles between numbered points, the lower one first, in ascending order.
static CagStatus edges_of_points(const Mesher *m, uint32_t (**out)[2], size_t *n, CagError *err) {
  size_t most = 0;
  for (size_t f = 0; f < m->b->face_count; f++) most += 3 * m->meshes[f]->triangle_count;
  uint32_t(*edges)[2] = cag_malloc((most + 1) * sizeof *edges);
  if (!edges) return cag_fail_memory(err);
  *n = 0;
  for (size_t f = 0; f < m->b->face_count; f++) {
    const CagMesh *mesh = m->meshes[f];
    for (size_t k = 0; k < 3 * mesh->triangle_count; k++) {
      const size_t next = k % 3 == 2 ? k - 2 : k + 1;
      const uint32_t p = mesh->weld[mesh->triangles[k]], q = mesh->weld[mesh->triangles[next]];
      if (p >= m->count || q >= m->count) continue;
      edges[*n][0] = p < q ? p : q;
      edges[(*n)++][1] = p < q ? q : p;
    }
  }
  qsort(edges, *n, sizeof *edges, by_pair);
  *out = edges;
  return CAG_OK;
}

// Finds points that more than two triangles join: an edge within a face has the ends of another one.
// *found: there are some that were not known.
static CagStatus find_equal_edges(Mesher *m, bool *found, CagError *err) {
  uint32_t(*edges)[2];
  size_t n, before = m->apart_count;
  CagStatus status = edges_of_points(m, &edges, &n, err);
  if (status) return status;
  for (size_t i = 0, j; !status && i < n; i = j) {
    for (j = i + 1; j < n && by_pair(edges[i], edges[j]) == 0; j++) {}
    if (j - i <= 2 ||
        (before > 0 && bsearch(edges[i], m->apart, before, sizeof *m->apart, by_pair)))
      continue;
    if (!CAG_RESIZE(m->apart, m->apart_count + 1)) status = cag_fail_memory(err);
    else memcpy(m->apart[m->apart_count++], edges[i], sizeof *edges);
  }
  cag_free(edges);
  *found = m->apart_count > before;
  if (*found) qsort(m->apart, m->apart_count, sizeof *m->apart, by_pair);
  return status;
}

static CagStatus mesh_each_face(Mesher *m, CagError *err) {
  CagStatus status = CAG_OK;
  size_t triangles = 0;
  for (size_t f = 0; !status && f < m->b->face_count; f++) {
    cag_mesh_release(m->meshes[f]);
    m->meshes[f] = NULL;
    status = mesh_face(m, f, &m->meshes[f], err);
    if (!status) triangles += m->meshes[f]->triangle_count;
    if (!status && triangles > m->how.max_triangles)
      status = cag_fail(err, CAG_E_LIMIT, CAG_ERR_limit_triangles, "tolerance", -1,
                        "the solid needs more triangles than the limit of %zu; use a larger "
                        "tolerance",
                        m->how.max_triangles);
  }
  return status;
}

static CagStatus mesh_faces(Mesher *m, CagMesh **out, CagError *err) {
  CagStatus status = divide_edges(m, err);
  if (!status) status = number_points(m, err);
  bool found = true;
  m->apart_count = 0;
  for (int k = 0; !status && found && k < ROUNDS; k++) {
    status = mesh_each_face(m, err);
    if (!status) status = find_equal_edges(m, &found, err);
  }
  return status ? status : join_faces(m, out, err);
}

static CagStatus label_faces(const Mesher *m, CagMesh *mesh, CagError *err) {
  mesh->labels = cag_malloc((mesh->triangle_count + 1) * sizeof *mesh->labels);
  if (!mesh->labels) return cag_fail_memory(err);
  size_t t = 0;
  for (size_t f = 0; f < m->b->face_count; f++)
    for (size_t k = 0; k < m->meshes[f]->triangle_count; k++) mesh->labels[t++] = (uint32_t)f + 1;
  return CAG_OK;
}

CagStatus cag_boundary_mesh(const CagBoundary *b, const CagTessellation *how, bool labeled,
                            CagMesh **out, CagError *err) {
  if (b->mesh) return cag_meshed_copy(b, labeled, out, err);
  Mesher m = {.b = b, .how = *how, .edge = *how};
  CagMesh *mesh = NULL;
  bool watertight = false;
  CagVec3 edge[2];
  CagStatus status = begin(&m, err);
  for (int k = 0; !status && !watertight && k < TRIES; k++) {
    cag_mesh_release(mesh);
    mesh = NULL;
    status = mesh_faces(&m, &mesh, err);
    m.edge.tolerance *= FINER;
    m.edge.angle *= FINER;
    if (!status) status = cag_mesh_watertight(mesh, &watertight, edge, err);
    else if (err->id == CAG_ERR_polygon_self_intersection && k + 1 < TRIES) status = CAG_OK;
  }
  if (!status && labeled) status = label_faces(&m, mesh, err);
  mesher_free(&m);
  if (!status && !watertight)
    status = cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_no_boundary, "", -1,
                      "the mesh of its faces is not watertight");
  if (status) cag_mesh_release(mesh);
  else *out = mesh;
  return status;
}
