// Fillets and chamfers.
//
// The kernel rounds the parts one by one, in their own coordinates (tier B). If it cannot, a ball
// rolls along the edges of the mesh (geom/solid/rolling.h), in the coordinates of the world (tier C).

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "geom/linalg/tolerance.h"
#include "geom/mesh/smooth.h"
#include "geom/solid/csg.h"
#include "geom/solid/rolling.h"
#include "interp/builtin/exacts_match.h"
#include "interp/builtin/exacts_parts.h"
#include "interp/builtin/support.h"
#include "interp/vm/vm.h"

// Ends that are nearer than this fraction of the length of an edge are one point.
#define CLOSED 1e-9
// Limits of the ball on the mesh are by its tolerance too large.
#define CLEARLY 1.05
// Facets of fillets on a mesh turn by less, and edges that are not rounded by more (radians).
#define CREASE (40 * M_PI / 180)

typedef CagStatus (*BlendRequest)(CagKernel *k, const CagBoundary *part, const CagBlend *blends,
                                  size_t n, CagBoundaries *out, CagKernelFailure *why,
                                  CagError *err);

// What fillet and chamfer differ in. Their parameters have the same numbers.
typedef struct BlendWords {
  const char *verb, *size;
  BlendRequest request;
  CagStatus (*roll)(const CagSolid *s, const CagRolledEdge *edges, size_t n, double tolerance,
                    CagRollLimit *limit, double *within, CagSolid **out, CagError *err);
  bool chamfer;
} BlendWords;

enum { BLEND_SIZE = 1, BLEND_EDGES = 2 };

static const BlendWords FILLET = {"round", "radius", cag_kernel_fillet, cag_solid_roll, false};
static const BlendWords CHAMFER = {"cut off", "distance", cag_kernel_chamfer, cag_solid_bevel,
                                   true};

// --- Sizes ---

static bool fail_size(CagCall *call, const BlendWords *words) {
  return cag_fail_call(
      call, BLEND_SIZE, CAG_ERR_value,
      "expects a length greater than 0, two of them, or a function of an edge that returns these, as `%s`",
      words->size);
}

static bool is_size(CagValue v, double *out) {
  *out = v.type == CAG_NUMBER ? v.as.number : 0;
  return *out > 0 && isfinite(*out);
}

// A length, or two.
static bool read_sizes(CagCall *call, const BlendWords *words, CagValue v, double out[2]) {
  if (v.type != CAG_LIST) {
    if (!is_size(v, &out[0])) return fail_size(call, words);
    out[1] = out[0];
    return true;
  }
  const CagList *pair = CAG_AS_LIST(v);
  return (pair->length == 2 && is_size(cag_list_get(call->vm, pair, 0), &out[0]) &&
          is_size(cag_list_get(call->vm, pair, 1), &out[1])) ||
         fail_size(call, words);
}

static bool sizes_of(CagCall *call, const BlendWords *words, const CagChosen *c, double out[2]) {
  CagValue v = call->values[BLEND_SIZE];
  if (cag_is_function(v) && !cag_call(call->vm, v, &c->record, 1, &v)) return false;
  return read_sizes(call, words, v, out);
}

// --- Failures ---

static const char *point_text(CagVec3 p, char text[64]) {
  snprintf(text, 64, "[%.6g, %.6g, %.6g]", p.x + 0.0, p.y + 0.0, p.z + 0.0);
  return text;
}

// Whether an edge runs from its end to its start in world coordinates, where the first coordinate of
// its direction is positive that is not 0 (features.h).
static bool is_turned(const CagExactParts *p, const CagEdgeFeature *e) {
  const CagVec3 d = cag_transform_vector(&p->solid->placement, e->direction);
  const double x[3] = {d.x, d.y, d.z}, zero = CAG_PARALLEL * cag_norm(d);
  for (int i = 0; i < 3; i++)
    if (fabs(x[i]) > zero) return x[i] < 0;
  return false;
}

// The edge in world coordinates: "the line from [0, 0, 0] to [0, 0, 30], 30 mm long".
static void describe_edge(const CagExactParts *p, const CagEdgeFeature *e, char *text, size_t n) {
  char from[64], to[64];
  const CagTransform *t = &p->solid->placement;
  const bool closed = cag_norm(cag_sub(e->start, e->end)) <= CLOSED * e->length;
  const bool turned = is_turned(p, e);
  point_text(cag_transform_point(t, turned ? e->end : e->start), from);
  point_text(cag_transform_point(t, turned ? e->start : e->end), to);
  if (closed)
    snprintf(text, n, "the %s through %s, %.6g mm long", e->kind, from, e->length * p->scale);
  else
    snprintf(text, n, "the %s from %s to %s, %.6g mm long", e->kind, from, to,
             e->length * p->scale);
}

// The reason without the kernel's words for the edge, which end with a colon.
static const char *kernel_reason(const char *message) {
  const char *colon = strstr(message, ": ");
  return colon ? colon + 2 : message;
}

// A limit, rounded down to four digits.
static double limit_shown(double limit) {
  const double unit = pow(10, floor(log10(limit)) - 3);
  return floor(limit / unit) * unit;
}

static bool fail_blend(const CagExactParts *p, const BlendWords *words, size_t part,
                       const CagBlend *blends, size_t n, const CagKernelFailure *why) {
  CagCall *call = p->call;
  const CagFeatures *f = &p->features[part];
  char edge[256], reason[sizeof call->err->message], limit[96] = "";
  size_t at = 0, blend = 0;
  while (at < f->edge_count && f->edges[at].edge != why->edge) at++;
  while (blend < n && blends[blend].edge != why->edge) blend++;
  if (why->reason == 0 || at == f->edge_count || blend == n)
    return cag_fail_geometry(call, call->err);
  describe_edge(p, &f->edges[at], edge, sizeof edge);
  snprintf(reason, sizeof reason, "%s", kernel_reason(call->err->message));
  const bool together = strstr(call->err->message, "does not fit together") != NULL;
  if (why->limit > 0)
    snprintf(limit, sizeof limit, "; the largest %s that fits is %.6g", words->size,
             limit_shown(why->limit * p->scale));
  return cag_fail_call(call, BLEND_SIZE, CAG_ERR_no_blend, "cannot %s %s, with the %s %.6g%s: %s%s",
                       words->verb, edge, words->size,
                       fmax(blends[blend].first, blends[blend].last) * p->scale,
                       together ? ", along with other edges" : "", reason, limit);
}

// --- Blends ---

static CagBlend blend_of(const CagExactParts *p, const BlendWords *words, const CagChosen *c,
                         const double sizes[2]) {
  const CagFeatures *f = &p->features[c->part];
  const CagEdgeFeature *e = &f->edges[c->index];
  const bool turned = !words->chamfer && e->flipped != is_turned(p, e);
  return (CagBlend){.edge = e->edge,
                    .face = e->count > 0 ? f->edge_faces[e->first] : 0,
                    .first = sizes[turned] / p->scale,
                    .last = sizes[!turned] / p->scale};
}

// The blends of the chosen edges, held by the call. Functions of the script may be called.
static bool read_blends(CagExactParts *p, const BlendWords *words, const CagChosen *chosen,
                        size_t n, CagBlend **out) {
  CagVm *vm = p->call->vm;
  *out = cag_hold_array(p->call, n, sizeof **out);
  cag_root_push(vm, p->records);
  for (size_t i = 0; i < n; i++) {
    double sizes[2];
    if (!sizes_of(p->call, words, &chosen[i], sizes)) return false;
    (*out)[i] = blend_of(p, words, &chosen[i], sizes);
  }
  cag_root_pop(vm, 1);
  return true;
}

// --- Tier C ---

// Whether a face uses an edge in the direction of its curve, which has the face on its left.
static bool is_left_of(const CagBoundary *b, size_t face, size_t edge) {
  const CagBoundaryFace *f = &b->faces[face];
  for (size_t l = f->first; l < f->first + f->count; l++)
    for (size_t u = b->loops[l].first; u < b->loops[l].first + b->loops[l].count; u++)
      if (b->uses[u].edge == edge && !b->uses[u].reversed) return true;
  return false;
}

static CagRolledEdge rolled_edge(const CagExactParts *p, const BlendWords *words, size_t part,
                                 const CagBlend *blend) {
  const bool mirrored = cag_transform_mirrors(&p->solid->placement);
  const bool turned =
      words->chamfer && is_left_of(&p->parts[part], blend->face, blend->edge) == mirrored;
  const double sizes[2] = {blend->first * p->scale, blend->last * p->scale};
  return (CagRolledEdge){part, blend->edge, {sizes[turned], sizes[!turned]}};
}

// The chosen edges of a solid, and their sizes.
typedef struct Blending {
  CagExactParts *parts;
  const BlendWords *words;
  const CagChosen *chosen;
  const CagBlend *blends;
  size_t n;
} Blending;

static const CagRolledEdge *rolled_edges(const Blending *b) {
  CagRolledEdge *rolled = cag_hold_array(b->parts->call, b->n, sizeof *rolled);
  for (size_t i = 0; i < b->n; i++)
    rolled[i] = rolled_edge(b->parts, b->words, b->chosen[i].part, &b->blends[i]);
  return rolled;
}

// Gives smooth normals to a solid whose edges were filleted on its mesh.
static CagStatus smooth_fillets(CagSolid **made, CagError *err) {
  CagMesh *smooth;
  CagSolid *flat = *made;
  *made = NULL;
  CagStatus status = cag_mesh_smooth(flat->core->mesh, CREASE, &smooth, err);
  cag_solid_release(flat);
  if (status) return status;
  status = cag_solid_from_mesh(smooth, made, err);
  cag_mesh_release(smooth);
  return status;
}

// Rounds the mesh.
static CagStatus roll_edges(const Blending *b, CagRollLimit *limit, CagSolid **out, CagError *err) {
  CagCall *call = b->parts->call;
  const CagSolid *s = b->parts->solid;
  double tolerance, within;
  char said[96];
  CagStatus status = cag_exacts_tolerance(call, s, &tolerance, err);
  if (!status)
    status = b->words->roll(s, rolled_edges(b), b->n, tolerance, limit, &within, out, err);
  if (!status && !b->words->chamfer) status = smooth_fillets(out, err);
  if (status) return status;
  snprintf(said, sizeof said, "tier C: rolling ball on the mesh, within %.3g mm", within);
  cag_exacts_say_tier(call, said, "edges", b->n);
  return CAG_OK;
}

// The error of an edge that the ball does not fit, or another one, of a solid whose boundary was
// found from its mesh.
static bool fail_rolled(const Blending *b, const CagRollLimit *limit) {
  CagCall *call = b->parts->call;
  char edge[256], most[96] = "";
  if (call->err->id != CAG_ERR_rounding_too_large || limit->index >= b->n)
    return cag_fail_geometry(call, call->err);
  const CagChosen *c = &b->chosen[limit->index];
  const double *size = rolled_edges(b)[limit->index].size, given = fmax(size[0], size[1]);
  describe_edge(b->parts, &b->parts->features[c->part].edges[c->index], edge, sizeof edge);
  if (limit->factor > 0)
    snprintf(most, sizeof most, "; the largest %s that fits is %.6g", b->words->size,
             limit_shown(limit->factor * given));
  return cag_fail_call(call, BLEND_SIZE, CAG_ERR_no_blend,
                       "cannot %s %s, with the %s %.6g: the ball does not fit there%s",
                       b->words->verb, edge, b->words->size, given, most);
}

// --- Tier B ---

// What the kernel said about the part that it could not blend.
typedef struct BlendFailure {
  size_t part, count;
  const CagBlend *blends; // of the part
  CagKernelFailure why;
} BlendFailure;

// The error is that of the call.
static CagStatus ask_kernel(const Blending *b, CagSolid **out, BlendFailure *failure) {
  CagExactParts *p = b->parts;
  CagBlend *own = cag_hold_array(p->call, b->n, sizeof *own);
  CagStatus status = CAG_OK;
  *failure = (BlendFailure){.blends = own};
  for (size_t i = 0; !status && i < p->count; i++) {
    CagBoundaries made;
    failure->part = i;
    failure->count = 0;
    for (size_t k = 0; k < b->n; k++)
      if (b->chosen[k].part == i) own[failure->count++] = b->blends[k];
    status = b->words->request(p->kernel, &p->parts[i], own, failure->count, &made, &failure->why,
                               p->call->err);
    if (!status) status = cag_exact_parts_take(p, &made);
  }
  if (!status) status = cag_exact_parts_solid(p, out);
  if (!status) cag_exacts_say_tier(p->call, "tier B: kernel", "edges", b->n);
  return status;
}

// --- The functions ---

// Functions of the script choose the edges and sizes.
static bool read_blending(CagExactParts *p, const BlendWords *words, Blending *out) {
  CagChosen *chosen;
  CagBlend *blends;
  const bool records = cag_is_function(p->call->values[BLEND_SIZE]);
  *out = (Blending){.parts = p, .words = words};
  if (!cag_chosen_edges(p, BLEND_EDGES, records, &chosen, &out->n) ||
      !read_blends(p, words, chosen, out->n, &blends))
    return false;
  out->chosen = chosen;
  out->blends = blends;
  return true;
}

// The number of a chosen edge, counting through all parts.
static size_t edge_number(const CagExactParts *p, const CagChosen *c) {
  size_t number = c->index;
  for (size_t i = 0; i < c->part; i++) number += p->features[i].edge_count;
  return number;
}

// The blend of the edge of the kernel's boundary that runs along one of the other boundary at each
// place; NULL if these are not chosen. *same: all places agree.
static const CagBlend *blend_along(const Blending *b, const size_t *by_number, const size_t *of,
                                   bool *same) {
  const CagBlend *found = NULL;
  int chosen = 0;
  for (int k = 0; k < CAG_MATCH_PLACES; k++) {
    const size_t i = of[k] == SIZE_MAX ? SIZE_MAX : by_number[of[k]];
    if (i == SIZE_MAX) continue;
    const CagBlend *one = &b->blends[i];
    if (one->last != one->first || (found && one->first != found->first)) *same = false;
    found = one;
    chosen++;
  }
  if (chosen > 0 && chosen < CAG_MATCH_PLACES) *same = false;
  return found;
}

// Whether the ball on the mesh failed at an edge with a clearly larger limit than the kernel, or where
// the kernel told none. The error then tells that of the ball.
static bool allows_more(const Blending *b, const CagError *rolled, const CagRollLimit *limit,
                        const CagKernelFailure *kernel) {
  if (rolled->id != CAG_ERR_rounding_too_large || limit->index >= b->n) return false;
  const double *size = rolled_edges(b)[limit->index].size;
  return kernel->reason == 0 ||
         limit->factor * fmax(size[0], size[1]) > CLEARLY * kernel->limit * b->parts->scale;
}

// The same edges with the same sizes, of the boundary that is found from the mesh. *done: there are
// such edges. Sizes that change along an edge are not transferred.
static CagStatus transfer(const Blending *b, CagExactParts *p, Blending *out, bool *done,
                          CagError *err) {
  CagCall *call = p->call;
  CagEdgeMatch m;
  const CagStatus status = cag_match_edges(b->parts, p, &m, err);
  if (status) return status;
  size_t *by_number = cag_hold_array(call, m.from_count, sizeof *by_number);
  bool *taken = cag_hold_array(call, m.to_count, sizeof *taken);
  CagChosen *chosen = cag_hold_array(call, m.to_count, sizeof *chosen);
  CagBlend *blends = cag_hold_array(call, m.to_count, sizeof *blends);
  *out = (Blending){.parts = p, .words = b->words, .chosen = chosen, .blends = blends};
  for (size_t i = 0; i < m.from_count; i++) by_number[i] = SIZE_MAX;
  for (size_t i = 0; i < b->n; i++) by_number[edge_number(b->parts, &b->chosen[i])] = i;
  *done = true;
  for (size_t part = 0, number = 0; part < p->count; part++)
    for (size_t k = 0; k < p->features[part].edge_count; k++, number++) {
      const CagBlend *along = blend_along(b, by_number, m.of[number], done);
      const CagChosen one = {part, k, {.type = CAG_UNSET}};
      if (!along) continue;
      const double size = along->first * b->parts->scale;
      taken[number] = true;
      chosen[out->n] = one;
      blends[out->n++] = blend_of(p, b->words, &one, (double[2]){size, size});
    }
  for (size_t i = 0; i < m.from_count; i++)
    if (by_number[i] != SIZE_MAX && (m.back[i] == SIZE_MAX || !taken[m.back[i]])) *done = false;
  return CAG_OK;
}

// Rounds the same edges of the boundary that is found from the mesh. The status is not final if that
// cannot be done.
static CagStatus roll_found_edges(const Blending *b, CagSolid **out, CagError *err) {
  CagCall *call = b->parts->call;
  const CagSolid *found = NULL;
  Blending other;
  bool same = false;
  CagStatus status = cag_exacts_meshed(call, CAG_AS_SHAPE(call->values[0])->as.solid, &found, err);
  if (status) return status;
  CagExactParts *p = cag_exact_parts_try(call, found, err);
  if (!p) return err->status;
  status = transfer(b, p, &other, &same, err);
  if (!status && !same)
    status = cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_no_boundary, "", -1,
                      "the edges are not those of the mesh");
  return status ? status : roll_edges(&other, NULL, out, err);
}

// kernel: why the boundary is not the kernel's.
static bool blend_meshed(const Blending *b, const CagError *kernel, CagValue *result) {
  CagCall *call = b->parts->call;
  CagRollLimit limit;
  CagSolid *made = NULL;
  const CagStatus status = roll_edges(b, &limit, &made, call->err);
  if (status && !cag_is_final(status))
    return kernel->id == CAG_ERR_kernel_missing ? cag_fail_geometry(call, kernel)
                                                : fail_rolled(b, &limit);
  return cag_exacts_changed(call, status, &made, result);
}

static bool blend_edges(CagCall *call, const BlendWords *words, CagValue *result) {
  const CagValue size = call->values[BLEND_SIZE];
  double sizes[2];
  Blending b;
  BlendFailure failure;
  CagRollLimit limit;
  CagSolid *made = NULL;
  if (!cag_is_function(size) && !read_sizes(call, words, size, sizes)) return false;
  CagExactParts *p = cag_exact_parts(call, 0, true);
  const CagError unmeshed = *call->err;
  if (!p || !read_blending(p, words, &b)) return false;
  if (cag_exact_parts_meshed(p)) return blend_meshed(&b, &unmeshed, result);
  CagStatus status = ask_kernel(&b, &made, &failure);
  if (status && !cag_is_final(status)) {
    CagError kernel = *call->err, err;
    cag_exacts_say_refused(call, "tier B: kernel", &kernel);
    CagStatus rolled = roll_edges(&b, &limit, &made, &err);
    if (rolled && !cag_is_final(rolled)) {
      cag_exacts_say_refused(call, "tier C: rolling ball on the mesh", &err);
      if (allows_more(&b, &err, &limit, &failure.why)) kernel = err, failure.count = 0;
      rolled = roll_found_edges(&b, &made, &err);
      if (rolled && !cag_is_final(rolled))
        cag_exacts_say_refused(call, "tier C: rolling ball on edges found in the mesh", &err);
    }
    *call->err = cag_is_final(rolled) ? err : kernel;
    if (!rolled || cag_is_final(rolled)) status = rolled;
  }
  if (status && !cag_is_final(status))
    return failure.count > 0
               ? fail_blend(p, words, failure.part, failure.blends, failure.count, &failure.why)
               : fail_rolled(&b, &limit);
  return cag_exacts_changed(call, status, &made, result);
}

bool cag_exacts_fillet(CagCall *call, const struct cag_exacts_fillet *a, CagValue *result) {
  (void)a;
  return blend_edges(call, &FILLET, result);
}

bool cag_exacts_chamfer(CagCall *call, const struct cag_exacts_chamfer *a, CagValue *result) {
  (void)a;
  return blend_edges(call, &CHAMFER, result);
}
