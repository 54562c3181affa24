// Boundaries from meshes (see recognized.h).

#include "geom/solid/recognized.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/boundary/carrier.h"
#include "geom/boundary/meshed.h"
#include "geom/solid/exact.h"
#include "geom/solid/recognized_curve.h"
#include "geom/solid/recognized_net.h"
#include "geom/solid/recognized_order.h"

// Points move by at most this multiple of the tolerance to their carriers.
#define MOVE 25
// Angles of the vertices of a face that leave a larger gap do not go all around (radians).
#define GAP 0.8

typedef struct Recognition {
  CagRecognizedSources sources;
  CagMesh *mesh;
  CagRecognizedNet net;
  CagBoundary b;
  double size, tolerance;
  size_t *edge_of; // by chains: the edge, plus 1; 0: none
  size_t *face_of; // by regions: likewise
} Recognition;

static void recognition_free(Recognition *f) {
  cag_recognized_sources_free(&f->sources);
  cag_recognized_net_free(&f->net);
  cag_mesh_release(f->mesh);
  cag_boundary_free(&f->b);
  cag_free(f->edge_of);
  cag_free(f->face_of);
}

static const CagCarrier *region_carrier(const Recognition *f, uint32_t region) {
  return &f->sources.items[f->net.source[region]];
}

// --- Corners ---

// Up to three regions at each corner.
typedef struct Meeting {
  uint32_t regions[3];
  size_t n;
} Meeting;

static void add_meeting(const Recognition *f, Meeting *m, uint32_t region) {
  for (size_t i = 0; i < m->n; i++)
    if (f->net.source[m->regions[i]] == f->net.source[region]) return;
  if (m->n < 3) m->regions[m->n++] = region;
}

static CagStatus find_corners(Recognition *f, CagError *err) {
  const size_t n = f->net.corner_count;
  Meeting *met = cag_calloc(n + 1, sizeof *met);
  f->b.corners = cag_calloc(n + f->net.region_count + 1, sizeof *f->b.corners); // and apexes
  CagStatus status = met && f->b.corners ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < f->net.chain_count; i++) {
    const CagRecognizedChain *c = &f->net.chains[i];
    for (int k = 0; k < 2 && !c->closed; k++)
      for (int side = 0; side < 2; side++) add_meeting(f, &met[c->ends[k]], c->sides[side]);
  }
  for (size_t i = 0; !status && i < n; i++) {
    const CagCarrier *carriers[3];
    bool settled;
    f->b.corners[i] = f->mesh->positions[f->net.corners[i]];
    for (size_t k = 0; k < met[i].n; k++) carriers[k] = region_carrier(f, met[i].regions[k]);
    status = cag_stop_check(err);
    if (!status && met[i].n > 1)
      status = cag_recognized_settle(carriers, met[i].n, MOVE * f->tolerance, &f->b.corners[i],
                                     &settled, err);
  }
  f->b.corner_count = n;
  cag_free(met);
  return status;
}

static uint32_t mesh_vertex(const CagMesh *m, size_t corner) {
  const uint32_t v = m->triangles[corner];
  return m->weld ? m->weld[v] : v;
}

// Adds the apexes of cones that lie inside their regions as corners without edges.
static CagStatus add_apexes(Recognition *f, CagError *err) {
  const CagMesh *m = f->mesh;
  // By vertices: the region whose apex it is, plus 1; others: other regions meet there, too.
  const uint32_t others = UINT32_MAX;
  uint32_t *apex_of = cag_calloc(m->vertex_count + 1, sizeof *apex_of);
  CagStatus status = apex_of ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < 3 * m->triangle_count; i++) {
    const uint32_t region = f->net.region[i / 3], v = mesh_vertex(m, i);
    CagVec3 apex;
    if (cag_carrier_apex(region_carrier(f, region), &apex) &&
        cag_norm(cag_sub(m->positions[v], apex)) <= MOVE * f->tolerance)
      apex_of[v] = region + 1;
    if (i % 1024 == 0) status = cag_stop_check(err);
  }
  for (size_t i = 0; !status && i < 3 * m->triangle_count; i++) {
    uint32_t *of = &apex_of[mesh_vertex(m, i)];
    if (*of != 0 && *of != f->net.region[i / 3] + 1) *of = others;
  }
  bool *done = cag_calloc(f->net.region_count + 1, sizeof *done);
  if (!status && !done) status = cag_fail_memory(err);
  for (size_t v = 0; !status && v < m->vertex_count; v++) {
    if (apex_of[v] == 0 || apex_of[v] == others || done[apex_of[v] - 1]) continue;
    done[apex_of[v] - 1] = true;
    cag_carrier_apex(region_carrier(f, apex_of[v] - 1), &f->b.corners[f->b.corner_count++]);
  }
  cag_free(apex_of);
  cag_free(done);
  return status;
}

// --- Edges ---

static CagStatus chain_curve(const Recognition *f, const CagRecognizedChain *c, CagCurve **out,
                             CagError *err) {
  const CagCarrier *carriers[2] = {region_carrier(f, c->sides[0]), region_carrier(f, c->sides[1])};
  CagVec3 *points = cag_malloc((c->count + 1) * sizeof *points);
  if (!points) return cag_fail_memory(err);
  for (size_t i = 0; i < c->count; i++) points[i] = f->mesh->positions[f->net.path[c->first + i]];
  if (!c->closed) {
    points[0] = f->b.corners[c->ends[0]];
    points[c->count - 1] = f->b.corners[c->ends[1]];
  }
  CagStatus status = cag_recognized_curve(carriers, points, c->count, c->closed, f->size,
                                          MOVE * f->tolerance, out, err);
  cag_free(points);
  return status;
}

static bool is_known(const Recognition *f, uint32_t region) {
  return region_carrier(f, region)->kind != CAG_CARRIER_NONE;
}

static CagStatus find_edges(Recognition *f, CagError *err) {
  const size_t n = f->net.chain_count;
  f->b.edges = cag_calloc(n + 1, sizeof *f->b.edges);
  f->edge_of = cag_calloc(n + 1, sizeof *f->edge_of);
  CagStatus status = f->b.edges && f->edge_of ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++) {
    const CagRecognizedChain *c = &f->net.chains[i];
    CagCurve *curve;
    status = cag_stop_check(err);
    if (status || !is_known(f, c->sides[0]) || !is_known(f, c->sides[1])) continue;
    status = chain_curve(f, c, &curve, err);
    if (status) break;
    f->b.edges[f->b.edge_count++] =
        (CagBoundaryEdge){.curve = curve, .from = c->ends[0], .to = c->ends[1]};
    f->edge_of[i] = f->b.edge_count;
    if (c->closed) status = cag_curve_point(curve, curve->start, &f->b.corners[c->ends[0]], err);
  }
  return status;
}

// --- Faces ---

// The uses of the edges of a face, loop by loop.
static CagStatus add_use(Recognition *f, size_t edge, bool reversed, const CagCarrier *carrier,
                         CagError *err) {
  CagBoundary *b = &f->b;
  CagCurve *trace;
  if (!CAG_RESERVE(b->uses, b->use_room, b->use_count + 1)) return cag_fail_memory(err);
  CagStatus status = cag_recognized_trace(carrier, b->edges[edge].curve, &trace, err);
  if (!status) b->uses[b->use_count++] = (CagBoundaryUse){edge, reversed, trace};
  return status;
}

static size_t use_end(const CagBoundary *b, size_t use, bool at_end) {
  const CagBoundaryEdge *e = &b->edges[b->uses[use].edge];
  return at_end != b->uses[use].reversed ? e->to : e->from;
}

// Divides the uses of a face into loops.
static CagStatus add_loops(Recognition *f, CagBoundaryFace *face, size_t first, CagError *err) {
  CagBoundary *b = &f->b;
  face->first = b->loop_count;
  for (size_t at = first; at < b->use_count;) {
    CagBoundaryLoop loop = {.first = at, .count = 1};
    const size_t start = use_end(b, at, false);
    for (size_t end = use_end(b, at, true); end != start; end = use_end(b, at, true)) {
      size_t next = at + 1;
      while (next < b->use_count && use_end(b, next, false) != end) next++;
      if (next == b->use_count) break; // an edge is left out
      const CagBoundaryUse use = b->uses[next];
      b->uses[next] = b->uses[++at];
      b->uses[at] = use;
      loop.count++;
    }
    at++;
    if (!CAG_RESERVE(b->loops, b->loop_room, b->loop_count + 1)) return cag_fail_memory(err);
    b->loops[b->loop_count++] = loop;
    face->count++;
  }
  return CAG_OK;
}

static CagStatus spline_normal(const CagCarrier *c, CagVec3 p, CagVec3 *out, CagError *err);

// Compares the normals of triangles with that of the carrier, and finds the parameters of a face.
static CagStatus orient_faces(Recognition *f, double *turn, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t t = 0; !status && t < f->mesh->triangle_count; t++) {
    const uint32_t region = f->net.region[t];
    const CagCarrier *c = region_carrier(f, region);
    const CagVec3 middle = cag_meshed_middle(f->mesh, t);
    const double near[2] = {0, 0};
    double uv[2];
    CagVec3 normal;
    if (t % 256 == 0) status = cag_stop_check(err);
    if (status || c->kind == CAG_CARRIER_NONE) continue;
    if (cag_carrier_is_analytic(c)) {
      cag_carrier_parameters(c, middle, near, uv);
      status = cag_carrier_normal(c, uv[0], uv[1], &normal, err);
    } else if (turn[region] == 0) status = spline_normal(c, middle, &normal, err);
    else continue;
    if (!status) turn[region] += cag_dot(normal, cag_meshed_cross(f->mesh, t));
  }
  return status;
}

static int by_value(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return x < y ? -1 : x > y;
}

// The range of angles that has all values, which are sorted: all but the largest gap between them.
static void angle_range(double *values, size_t n, double out[2]) {
  size_t at = n - 1;
  double most = values[0] + 2 * M_PI - values[n - 1];
  for (size_t i = 0; i + 1 < n; i++)
    if (values[i + 1] - values[i] > most) most = values[i + 1] - values[i], at = i;
  out[0] = most < GAP ? 0 : values[(at + 1) % n];
  out[1] = out[0] + 2 * M_PI - (most < GAP ? 0 : most);
}

static CagStatus face_domain(const Recognition *f, uint32_t region, CagBoundaryFace *face,
                             CagError *err) {
  const CagCarrier *c = &face->carrier;
  if (c->kind == CAG_CARRIER_SPLINE) {
    const CagSurface *s = c->spline;
    memcpy(face->domain, (double[4]){s->u0, s->u1, s->v0, s->v1}, sizeof face->domain);
    return CAG_OK;
  }
  size_t n = 0;
  double *uv[2] = {cag_malloc((3 * f->mesh->triangle_count + 1) * sizeof(double)),
                   cag_malloc((3 * f->mesh->triangle_count + 1) * sizeof(double))};
  CagStatus status = uv[0] && uv[1] ? CAG_OK : cag_fail_memory(err);
  for (size_t t = 0; !status && t < f->mesh->triangle_count; t++)
    for (int k = 0; k < 3 && f->net.region[t] == region; k++) {
      const double near[2] = {0, 0};
      double at[2];
      cag_carrier_parameters(c, f->mesh->positions[f->mesh->triangles[3 * t + (size_t)k]], near,
                             at);
      uv[0][n] = at[0], uv[1][n++] = at[1];
    }
  for (int k = 0; !status && n > 0 && k < 2; k++) {
    qsort(uv[k], n, sizeof **uv, by_value);
    double *range = face->domain + 2 * k;
    range[0] = uv[k][0], range[1] = uv[k][n - 1];
    if (cag_carrier_is_periodic(c, k)) angle_range(uv[k], n, range);
  }
  cag_free(uv[0]);
  cag_free(uv[1]);
  return status;
}

static CagStatus find_faces(Recognition *f, const double *turn, CagError *err) {
  CagBoundary *b = &f->b;
  CagStatus status = CAG_OK;
  for (uint32_t r = 0; !status && r < f->net.region_count; r++) {
    if (!is_known(f, r)) continue;
    CagBoundaryFace *face = &b->faces[b->face_count];
    *face = (CagBoundaryFace){.carrier = *region_carrier(f, r), .reversed = turn[r] < 0};
    if (face->carrier.spline) cag_surface_retain(face->carrier.spline);
    f->face_of[r] = ++b->face_count;
    const size_t first = b->use_count;
    status = face_domain(f, r, face, err);
    for (size_t i = 0; !status && i < f->net.chain_count; i++)
      for (int side = 0; !status && side < 2; side++)
        if (f->edge_of[i] && f->net.chains[i].sides[side] == r)
          status = add_use(f, f->edge_of[i] - 1, side == 1, &face->carrier, err);
    if (!status) status = add_loops(f, face, first, err);
  }
  return status;
}

static CagStatus spline_normal(const CagCarrier *c, CagVec3 p, CagVec3 *out, CagError *err) {
  CagCurve *point, *trace;
  double uv[2] = {0, 0};
  CagVec3 at;
  CagStatus status = cag_curve_line(p, cag_add(p, cag_vec3(1e-9, 0, 0)), 3, &point, err);
  if (status) return status;
  status = cag_recognized_trace(c, point, &trace, err);
  cag_curve_release(point);
  if (status) return status;
  status = cag_curve_point(trace, trace->start, &at, err);
  cag_curve_release(trace);
  if (status) return status;
  uv[0] = at.x, uv[1] = at.y;
  return cag_carrier_normal(c, uv[0], uv[1], out, err);
}

// --- The whole ---

static CagStatus sort_parts(Recognition *f, CagError *err) {
  size_t *rank = cag_calloc(f->b.face_count + 1, sizeof *rank);
  if (!rank) return cag_fail_memory(err);
  const CagStatus status = cag_recognized_order(&f->b, f->tolerance, rank, err);
  for (size_t r = 0; !status && r < f->net.region_count; r++)
    if (f->face_of[r]) f->face_of[r] = rank[f->face_of[r] - 1] + 1;
  cag_free(rank);
  return status;
}

// The labels of the mesh become the faces, plus 1.
static void label_faces(Recognition *f) {
  for (size_t t = 0; t < f->mesh->triangle_count; t++)
    f->mesh->labels[t] = (uint32_t)f->face_of[f->net.region[t]];
}

static CagStatus finish(Recognition *f, CagError *err) {
  CagBoundary *b = &f->b;
  double terms[10] = {0};
  b->shells = cag_calloc(2, sizeof *b->shells);
  b->order = cag_calloc(b->face_count + 1, sizeof *b->order);
  b->name = cag_strdup("");
  if (!b->shells || !b->order || !b->name) return cag_fail_memory(err);
  for (size_t i = 0; i < b->face_count; i++) b->order[i] = i;
  b->shells[0] = (CagBoundaryShell){0, b->face_count};
  b->shell_count = 1;
  b->order_count = b->order_room = b->face_count;
  label_faces(f);
  cag_mesh_volume_terms(f->mesh, terms);
  b->volume = terms[0];
  b->area = cag_mesh_area(f->mesh);
  b->mesh = cag_mesh_retain(f->mesh);
  return CAG_OK;
}

static CagStatus find_boundary(Recognition *f, CagError *err) {
  const size_t regions = f->net.region_count;
  double *turn = cag_calloc(regions + 1, sizeof *turn);
  f->face_of = cag_calloc(regions + 1, sizeof *f->face_of);
  f->b.faces = cag_calloc(regions + 1, sizeof *f->b.faces);
  CagStatus status = turn && f->face_of && f->b.faces ? CAG_OK : cag_fail_memory(err);
  if (!status) status = find_corners(f, err);
  if (!status) status = add_apexes(f, err);
  if (!status) status = find_edges(f, err);
  if (!status) status = orient_faces(f, turn, err);
  if (!status) status = find_faces(f, turn, err);
  if (!status) status = sort_parts(f, err);
  if (!status) status = finish(f, err);
  cag_free(turn);
  return status;
}

CagStatus cag_solid_recognized(const CagSolid *s, double tolerance, CagSolid **out, CagError *err) {
  Recognition f = {.tolerance = tolerance};
  CagStatus status = cag_recognized_mesh(s, tolerance, &f.sources, &f.mesh, err);
  if (status) return status;
  const CagBounds box = cag_mesh_bounds(f.mesh);
  f.size = cag_norm(cag_sub(box.max, box.min));
  status = cag_recognized_net(f.mesh, &f.sources, tolerance, &f.net, err);
  if (!status) status = find_boundary(&f, err);
  if (!status) status = cag_solid_exact(&f.b, 1, out, err);
  recognition_free(&f);
  return status;
}
