// Solids of IGES files by their boundaries (see iges_solid.h).
//
// The faces of a solid refer to one list of its edges, and these to one list of its vertices. An
// edge in a loop has a curve in the parameters of the surface, in the direction of the loop;
// without it, a reader would have to find out how a face that runs around its surface, or through a
// pole, continues. On planes it is omitted.

#include "interp/formats/iges_solid.h"

#include "base/memory.h"
#include "base/stop.h"
#include "interp/formats/iges_carrier.h"

typedef struct SolidLists {
  CagIgesPointer vertices, edges;
  size_t *vertex, *edge; // numbers in the lists, from 1; 0: not in the solid
  size_t vertex_count, edge_count;
} SolidLists;

// --- Lists ---

static void number_vertex(SolidLists *s, size_t vertex) {
  if (s->vertex[vertex] == 0) s->vertex[vertex] = ++s->vertex_count;
}

// Numbers the edges, and the vertices, of a shell. Degenerate edges are vertices.
static void number_shell(const CagBrep *b, const CagBrepShell *shell, SolidLists *s) {
  for (size_t f = shell->first; f < shell->first + shell->count; f++)
    for (size_t l = b->faces[f].first; l < b->faces[f].first + b->faces[f].count; l++)
      for (size_t u = b->loops[l].first; u < b->loops[l].first + b->loops[l].count; u++) {
        const size_t index = b->uses[u].edge;
        const CagBrepEdge *e = &b->edges[index];
        number_vertex(s, e->from);
        number_vertex(s, e->to);
        if (!cag_brep_is_degenerate(e) && s->edge[index] == 0) s->edge[index] = ++s->edge_count;
      }
}

static CagStatus vertex_list(CagIges *w, SolidLists *s, CagError *err) {
  const CagBrep *b = w->brep;
  size_t *order = cag_calloc(s->vertex_count + 1, sizeof *order);
  if (!order) return cag_fail_memory(err);
  for (size_t i = 0; i < b->vertex_count; i++)
    if (s->vertex[i] > 0) order[s->vertex[i] - 1] = i;
  s->vertices = cag_iges_begin(w, 502, 1, CAG_IGES_PART);
  cag_iges_integer(w, (long)s->vertex_count);
  for (size_t i = 0; i < s->vertex_count; i++) cag_iges_point(w, b->vertices[order[i]]);
  cag_iges_end(w, false);
  cag_free(order);
  return CAG_OK;
}

static CagStatus edge_curve(CagIges *w, const CagBrepEdge *e, CagIgesCurve *out, CagError *err) {
  if (e->curve) return cag_iges_curve(w, e->curve, out, err);
  *out = (CagIgesCurve){
      .at = cag_iges_line(w, w->brep->vertices[e->from], w->brep->vertices[e->to]), .scale = 1};
  return CAG_OK;
}

static CagStatus edge_list(CagIges *w, SolidLists *s, CagError *err) {
  const CagBrep *b = w->brep;
  size_t *order = cag_calloc(s->edge_count + 1, sizeof *order);
  CagIgesCurve *curves = cag_calloc(s->edge_count + 1, sizeof *curves);
  CagStatus status = order && curves ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < b->edge_count; i++)
    if (s->edge[i] > 0) order[s->edge[i] - 1] = i;
  for (size_t i = 0; !status && i < s->edge_count; i++)
    status = edge_curve(w, &b->edges[order[i]], &curves[i], err);
  if (!status) {
    s->edges = cag_iges_begin(w, 504, 1, CAG_IGES_PART);
    cag_iges_integer(w, (long)s->edge_count);
    for (size_t i = 0; i < s->edge_count; i++) {
      const CagBrepEdge *e = &b->edges[order[i]];
      cag_iges_pointer(w, curves[i].at);
      cag_iges_pointer(w, s->vertices);
      cag_iges_integer(w, (long)s->vertex[e->from]);
      cag_iges_pointer(w, s->vertices);
      cag_iges_integer(w, (long)s->vertex[e->to]);
    }
    cag_iges_end(w, false);
  }
  cag_free(order);
  cag_free(curves);
  return status;
}

// --- Faces ---

// The curve of a use in the parameters of the surface, along the loop.
static CagStatus use_trace(CagIges *w, const CagBrepUse *use, const CagTransform *map,
                           bool backwards, CagIgesPointer *out, CagError *err) {
  CagCurve *moved, *exact = NULL, *run = NULL;
  CagStatus status = cag_curve_transform(use->trace, map, &moved, err);
  if (status) return status;
  status = cag_curve_to_nurbs(moved, &exact, err);
  if (!status) {
    if (backwards) status = cag_curve_reverse(exact, &run, err);
    else run = cag_curve_retain(exact);
  }
  if (!status) status = cag_iges_nurbs_curve(w, run, true, CAG_IGES_PART_FLAT, out, err);
  cag_curve_release(moved);
  cag_curve_release(exact);
  cag_curve_release(run);
  return status;
}

static void put_use(CagIges *w, const SolidLists *s, const CagBrepUse *use, bool backwards,
                    CagIgesPointer trace) {
  const CagBrepEdge *e = &w->brep->edges[use->edge];
  const bool vertex = cag_brep_is_degenerate(e);
  cag_iges_integer(w, vertex); // 0: an edge, 1: a vertex
  cag_iges_pointer(w, vertex ? s->vertices : s->edges);
  cag_iges_integer(w, (long)(vertex ? s->vertex[e->from] : s->edge[use->edge]));
  cag_iges_integer(w, vertex || !backwards);
  cag_iges_integer(w, trace > 0); // the number of curves
  if (trace == 0) return;
  cag_iges_integer(w, 0); // it need not be along a parameter
  cag_iges_pointer(w, trace);
}

// `against`: the normal of the surface points into the solid, so that the loop runs backwards.
static CagStatus solid_loop(CagIges *w, const SolidLists *s, const CagBrepLoop *loop,
                            const CagIgesSurface *surface, bool plane, bool against,
                            CagIgesPointer *out, CagError *err) {
  CagIgesPointer *traces = cag_calloc(loop->count + 1, sizeof *traces);
  CagStatus status = traces ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < loop->count; i++) {
    const CagBrepUse *use = &w->brep->uses[loop->first + i];
    if (use->trace && !plane && !surface->bent)
      status = use_trace(w, use, &surface->parameters, use->reversed != against, &traces[i], err);
  }
  if (!status) {
    *out = cag_iges_begin(w, 508, 1, CAG_IGES_PART);
    cag_iges_integer(w, (long)loop->count);
    for (size_t k = 0; k < loop->count; k++) {
      const size_t i = against ? loop->count - 1 - k : k;
      const CagBrepUse *use = &w->brep->uses[loop->first + i];
      put_use(w, s, use, use->reversed != against, traces[i]);
    }
    cag_iges_end(w, false);
  }
  cag_free(traces);
  return status;
}

// Writes a face. *along: the normal of its surface points out of the solid.
static CagStatus solid_face(CagIges *w, const SolidLists *s, const CagBrepFace *f, bool *along,
                            CagIgesPointer *out, CagError *err) {
  CagIgesSurface surface;
  CagIgesPointer *loops = cag_calloc(f->count + 1, sizeof *loops);
  CagStatus status = loops ? CAG_OK : cag_fail_memory(err);
  if (!status) status = cag_iges_carrier(w, f, &surface, err);
  *along = !status && f->reversed == surface.turned;
  for (size_t i = 0; !status && i < f->count; i++)
    status = solid_loop(w, s, &w->brep->loops[f->first + i], &surface,
                        f->carrier.kind == CAG_CARRIER_PLANE, !*along, &loops[i], err);
  if (!status) {
    *out = cag_iges_begin(w, 510, 1, CAG_IGES_PART);
    cag_iges_pointer(w, surface.at);
    cag_iges_integer(w, (long)f->count);
    cag_iges_integer(w, 1); // the first loop is the outer one
    for (size_t i = 0; i < f->count; i++) cag_iges_pointer(w, loops[i]);
    cag_iges_end(w, false);
  }
  cag_free(loops);
  return status;
}

static CagStatus solid_shell(CagIges *w, const SolidLists *s, const CagBrepShell *shell,
                             CagIgesPointer *out, CagError *err) {
  CagIgesPointer *faces = cag_calloc(shell->count + 1, sizeof *faces);
  bool *along = cag_calloc(shell->count + 1, sizeof *along);
  CagStatus status = faces && along ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < shell->count; i++) {
    status = solid_face(w, s, &w->brep->faces[shell->first + i], &along[i], &faces[i], err);
    if (!status) status = cag_stop_check(err);
  }
  if (!status) {
    *out = cag_iges_begin(w, 514, 1, CAG_IGES_PART);
    cag_iges_integer(w, (long)shell->count);
    for (size_t i = 0; i < shell->count; i++) {
      cag_iges_pointer(w, faces[i]);
      cag_iges_integer(w, along[i]);
    }
    cag_iges_end(w, false);
  }
  cag_free(faces);
  cag_free(along);
  return status;
}

// --- Solids ---

// The shells of the solid: the outer one, then its cavities. Returns their number.
static size_t solid_shells(const CagBrep *b, const CagBrepShape *shape, size_t outer, size_t *out) {
  size_t n = 0;
  out[n++] = outer;
  for (size_t i = shape->first; i < shape->first + shape->count; i++)
    if (i != outer && b->shells[i].void_of == outer) out[n++] = i;
  return n;
}

static CagStatus write_solid(CagIges *w, SolidLists *s, const size_t *shells, size_t n,
                             CagIgesPointer *written, CagError *err) {
  for (size_t i = 0; i < n; i++) number_shell(w->brep, &w->brep->shells[shells[i]], s);
  CagStatus status = vertex_list(w, s, err);
  if (!status) status = edge_list(w, s, err);
  for (size_t i = 0; !status && i < n; i++)
    status = solid_shell(w, s, &w->brep->shells[shells[i]], &written[i], err);
  if (status) return status;
  cag_iges_begin(w, 186, 0, CAG_IGES_FREE);
  cag_iges_pointer(w, written[0]);
  cag_iges_integer(w, 1); // faces have their outward normals
  cag_iges_integer(w, (long)n - 1);
  for (size_t i = 1; i < n; i++) {
    cag_iges_pointer(w, written[i]);
    cag_iges_integer(w, 1);
  }
  cag_iges_end(w, true);
  return CAG_OK;
}

CagStatus cag_iges_solid(CagIges *w, const CagBrepShape *shape, size_t outer, CagError *err) {
  const CagBrep *b = w->brep;
  SolidLists s = {.vertex = cag_calloc(b->vertex_count + 1, sizeof *s.vertex),
                  .edge = cag_calloc(b->edge_count + 1, sizeof *s.edge)};
  size_t *shells = cag_calloc(shape->count + 1, sizeof *shells);
  CagIgesPointer *written = cag_calloc(shape->count + 1, sizeof *written);
  CagStatus status = s.vertex && s.edge && shells && written ? CAG_OK : cag_fail_memory(err);
  if (!status)
    status = write_solid(w, &s, shells, solid_shells(b, shape, outer, shells), written, err);
  cag_free(s.vertex);
  cag_free(s.edge);
  cag_free(shells);
  cag_free(written);
  return status;
}
