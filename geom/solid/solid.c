// Solids bounded by faces: reference counts, transforms, bounds, shared edges, and mass.

#include "geom/solid/solid.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/linalg/tolerance.h"
#include "geom/solid/build.h"
#include "geom/solid/csg.h"
#include "geom/solid/exact.h"
#include "geom/solid/kind.h"

CagStatus cag_solid_block(CagSolidKind kind, size_t faces, CagSolid **out, CagError *err) {
  CagSolid *s = cag_calloc(1, sizeof *s);
  CagSurface **room = cag_calloc(faces ? faces : 1, sizeof *room);
  if (!s || !room) {
    cag_free(s);
    cag_free(room);
    return cag_fail_memory(err);
  }
  s->references = 1;
  s->kind = kind;
  s->placement = cag_transform_identity();
  s->placement.planar = false;
  s->faces = room;
  *out = s;
  return CAG_OK;
}

void cag_solid_add(CagSolid *s, CagSurface *face) { s->faces[s->face_count++] = face; }

CagStatus cag_solid_add_turned(CagSolid *s, CagSurface *face, bool flip, CagError *err) {
  CagSurface *turned = face;
  CagStatus status = CAG_OK;
  if (flip) {
    status = cag_surface_flip(face, &turned, err);
    cag_surface_release(face);
  }
  if (!status) cag_solid_add(s, turned);
  return status;
}

CagStatus cag_solid_add_cap(CagSolid *s, const CagRegion *r, const CagTransform *frame, bool flip,
                            CagError *err) {
  CagSurface *face;
  CagStatus status = cag_surface_planar(r, frame, &face, err);
  return status ? status : cag_solid_add_turned(s, face, flip, err);
}

CagSolid *cag_solid_retain(const CagSolid *s) {
  CagSolid *mine = (CagSolid *)s;
  if (mine) mine->references++;
  return mine;
}

void cag_solid_release(CagSolid *s) {
  if (!s || --s->references > 0) return;
  for (size_t i = 0; i < s->face_count; i++) cag_surface_release(s->faces[i]);
  cag_free(s->faces);
  cag_free(s->edges);
  cag_solid_core_release(s->core);
  cag_exact_release(s->exact);
  cag_free(s);
}

bool cag_solid_has_own_frame(const CagSolid *s) {
  return s->core || s->exact || s->kind == CAG_SOLID_BOX || s->kind == CAG_SOLID_SPHERE ||
         s->kind == CAG_SOLID_CYLINDER || s->kind == CAG_SOLID_TORUS;
}

static void core_digest(const CagSolidCore *c, bool of_mesh, CagDigest *d) {
  cag_digest_word(d, c->count);
  for (size_t i = 0; i < c->count; i++) cag_solid_digest(c->operands[i], d);
  cag_digest_numbers(d, c->form, 10);
  if (of_mesh) cag_mesh_digest(c->mesh, d);
}

void cag_solid_digest_in_own_frame(const CagSolid *s, CagDigest *d) {
  cag_digest_word(d, (uint64_t)s->kind << 1 | s->centered);
  cag_digest_word(d, s->label);
  cag_digest_numbers(d, (const double[]){s->a, s->b, s->c}, 3);
  if (s->core) core_digest(s->core, s->kind == CAG_SOLID_MESH, d);
  if (s->exact) cag_exact_digest(s->exact, d);
}

void cag_solid_digest(const CagSolid *s, CagDigest *d) {
  cag_solid_digest_in_own_frame(s, d);
  if (cag_solid_has_own_frame(s)) cag_transform_digest(&s->placement, d);
  else
    for (size_t i = 0; i < s->face_count; i++) cag_surface_digest(s->faces[i], d);
}

bool cag_check_solid(const CagSolid *s) {
  if (!s || s->references < 1 || (int)s->kind < 0 || s->kind > CAG_SOLID_INTERSECTION) return false;
  if (s->face_count == 0 && !s->core) return false;
  for (size_t i = 0; i < s->face_count; i++)
    if (!cag_check_surface(s->faces[i])) return false;
  for (size_t i = 0; i < s->edge_count; i++)
    for (int k = 0; k < 2; k++)
      if (s->edges[i].face[k] >= s->face_count || s->edges[i].side[k] < 0) return false;
  for (int i = 0; i < 12; i++)
    if (!isfinite(s->placement.m[i / 4][i % 4])) return false;
  return true;
}

// Largest length whose fifth power (in moments) does not overflow, with a margin for sums and
// transforms.
#define LENGTH_MOST 1e50
#define LENGTH_LEAST 1e-50

CagStatus cag_solid_check_size(double size, const char *name, long index, CagError *err) {
  char text[32];
  if (size >= LENGTH_LEAST && size <= LENGTH_MOST) return CAG_OK;
  if (size > 0 && isfinite(size))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_size_out_of_range, name, index,
                    "`%s` must be between %g and %g, found %s", name, LENGTH_LEAST, LENGTH_MOST,
                    cag_number_text(size, text));
  if (index >= 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_size_not_positive, name, index,
                    "`%s` must be positive lengths: %s[%ld] is %s", name, name, index,
                    cag_number_text(size, text));
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_size_not_positive, name, -1,
                  "`%s` must be a positive length, found %s", name, cag_number_text(size, text));
}

CagStatus cag_solid_disk(double radius, CagRegion **out, CagError *err) {
  CagTransform frame = cag_transform_identity();
  CagCurve *circle;
  CagStatus status = cag_curve_arc(radius, radius, 0, 2 * M_PI, &frame, &circle, err);
  if (status) return status;
  status = cag_region_new(circle, NULL, 0, out, err);
  cag_curve_release(circle);
  return status;
}

// --- Edges ---

CagStatus cag_solid_add_edge(CagSolid *s, size_t face_a, int side_a, size_t face_b, int side_b,
                             bool reversed, CagError *err) {
  if (!CAG_RESIZE(s->edges, s->edge_count + 1)) return cag_fail_memory(err);
  s->edges[s->edge_count++] = (CagFaceEdge){{face_a, face_b}, {side_a, side_b}, reversed};
  return CAG_OK;
}

int cag_solid_first_side(const CagSurface *face) {
  return cag_surface_planar_view(face, NULL, NULL) ? 4 : 0;
}

int cag_solid_side_end(const CagSurface *face) {
  const CagRegion *region;
  return cag_surface_planar_view(face, &region, NULL) ? 4 + (int)region->count : 4;
}

bool cag_solid_side_is_edge(const CagSurface *f, int side) {
  switch (side) {
  case 0: return !f->closed_u && !f->pole_u0;
  case 1: return !f->closed_u && !f->pole_u1;
  case 2: return !f->closed_v && !f->pole_v0;
  case 3: return !f->closed_v && !f->pole_v1;
  default: return true;
  }
}

static double part(double a, double b, double fraction) {
  return fraction >= 1 ? b : a + fraction * (b - a);
}

CagStatus cag_solid_side_point(const CagSurface *f, int side, double fraction, CagVec3 *out,
                               CagError *err) {
  const CagRegion *region;
  CagTransform frame;
  if (side >= 4 && cag_surface_planar_view(f, &region, &frame)) {
    const CagCurve *loop = region->loops[side - 4];
    CagVec3 flat;
    CagStatus status = cag_curve_point(loop, part(loop->start, loop->end, fraction), &flat, err);
    if (!status) *out = cag_transform_point(&frame, flat);
    return status;
  }
  double u = part(f->u0, f->u1, fraction), v = part(f->v0, f->v1, fraction);
  if (side < 2) return cag_surface_point(f, side == 0 ? f->u0 : f->u1, v, out, err);
  return cag_surface_point(f, u, side == 2 ? f->v0 : f->v1, out, err);
}

// Points compared along an edge; not only the middle, which symmetric edges share.
#define EDGE_POINTS 6
static const double EDGE_FRACTION[EDGE_POINTS] = {0, 0.17, 0.36, 0.64, 0.83, 1};

// Edges coincide if their points do, within this fraction of the size of the solid.
#define EDGE_SAME CAG_COINCIDENT

typedef struct Side {
  size_t face;
  int side;
  CagVec3 p[EDGE_POINTS];
} Side;

// +1: same edge, -1: same edge reversed, 0: different.
static int compare(const Side *a, const Side *b, double slack) {
  bool same = true, backwards = true;
  for (int i = 0; i < EDGE_POINTS; i++) {
    same = same && cag_norm(cag_sub(a->p[i], b->p[i])) <= slack;
    backwards = backwards && cag_norm(cag_sub(a->p[i], b->p[EDGE_POINTS - 1 - i])) <= slack;
  }
  return same ? 1 : backwards ? -1 : 0;
}

static CagStatus collect_sides(const CagSolid *s, Side **out, size_t *n, double *size,
                               CagError *err) {
  size_t most = 0;
  for (size_t f = 0; f < s->face_count; f++)
    most += (size_t)(cag_solid_side_end(s->faces[f]) - cag_solid_first_side(s->faces[f]));
  Side *sides = cag_malloc((most ? most : 1) * sizeof *sides);
  if (!sides) return cag_fail_memory(err);
  CagBounds box = CAG_BOUNDS_EMPTY;
  *n = 0;
  for (size_t f = 0; f < s->face_count; f++)
    for (int k = cag_solid_first_side(s->faces[f]); k < cag_solid_side_end(s->faces[f]); k++) {
      if (!cag_solid_side_is_edge(s->faces[f], k)) continue;
      Side *side = &sides[(*n)++];
      side->face = f;
      side->side = k;
      for (int i = 0; i < EDGE_POINTS; i++) {
        CagStatus status = cag_solid_side_point(s->faces[f], k, EDGE_FRACTION[i], &side->p[i], err);
        if (status) {
          cag_free(sides);
          return status;
        }
        cag_bounds_add(&box, side->p[i]);
      }
    }
  *size = *n ? cag_norm(cag_sub(box.max, box.min)) : 0;
  *out = sides;
  return CAG_OK;
}

CagStatus cag_solid_match_edges(CagSolid *s, CagError *err) {
  Side *sides = NULL;
  size_t n = 0;
  double size = 0;
  CagStatus status = collect_sides(s, &sides, &n, &size, err);
  for (size_t i = 0; !status && i < n; i++)
    for (size_t j = i + 1; !status && sides[i].face != SIZE_MAX && j < n; j++) {
      if (sides[j].face == SIZE_MAX) continue;
      int how = compare(&sides[i], &sides[j], EDGE_SAME * size);
      if (how == 0) continue;
      status = cag_solid_add_edge(s, sides[i].face, sides[i].side, sides[j].face, sides[j].side,
                                  how < 0, err);
      sides[j].face = SIZE_MAX; // already paired
      break;
    }
  cag_free(sides);
  return status;
}

// --- Transforms ---

// Flipping a face reverses v: v0 and v1 are exchanged, and sides along v and the loops of a planar
// face are reversed.
static void flip_edge_end(int *side, bool *reversed) {
  if (*side == 2 || *side == 3) *side = 5 - *side;
  else *reversed = !*reversed;
}

CagStatus cag_solid_transform(const CagSolid *s, const CagTransform *t, CagSolid **out,
                              CagError *err) {
  CagTransform unused;
  CagStatus status = cag_transform_inverse(t, &unused, err);
  if (status) return status;
  if (!cag_transform_is_affine(t))
    return cag_fail(
        err, CAG_E_UNSUPPORTED, CAG_ERR_not_affine, "transform", -1,
        "a solid needs an affine transform; to project it, project its faces or its mesh");
  CagSolid *moved = NULL;
  status = cag_solid_block(s->kind, s->face_count, &moved, err);
  if (status) return status;
  moved->a = s->a;
  moved->b = s->b;
  moved->c = s->c;
  moved->centered = s->centered;
  moved->label = s->label;
  moved->placement = cag_transform_multiply(t, &s->placement);
  moved->core = s->core;
  if (moved->core) moved->core->references++;
  moved->exact = cag_exact_retain(s->exact);
  bool mirror = cag_transform_mirrors(t);
  for (size_t i = 0; !status && i < s->face_count; i++) {
    CagSurface *face;
    status = cag_surface_transform(s->faces[i], t, &face, err);
    if (!status) status = cag_solid_add_turned(moved, face, mirror, err);
  }
  for (size_t i = 0; !status && i < s->edge_count; i++) {
    CagFaceEdge e = s->edges[i];
    for (int k = 0; mirror && k < 2; k++) flip_edge_end(&e.side[k], &e.reversed);
    status = cag_solid_add_edge(moved, e.face[0], e.side[0], e.face[1], e.side[1], e.reversed, err);
  }
  if (status) {
    cag_solid_release(moved);
    return status;
  }
  *out = moved;
  return CAG_OK;
}

CagStatus cag_solid_bounds(const CagSolid *s, CagBounds *out, CagError *err) {
  CagBounds box = CAG_BOUNDS_EMPTY;
  if (s->face_count == 0) return cag_csg_bounds(s, out, err);
  const CagSolidKindRow *kind = &cag_solid_kinds[s->kind];
  if (kind->bounds) return kind->bounds(s, out, err);
  for (size_t i = 0; i < s->face_count; i++) {
    CagBounds face;
    CagStatus status = cag_surface_bounds(s->faces[i], &face, err);
    if (status) return status;
    cag_bounds_add(&box, face.min);
    cag_bounds_add(&box, face.max);
  }
  // The bounds of a set operation with faces lie within its reach, which is exact where the
  // operation ends at the side of a box.
  CagStatus status = CAG_OK;
  CagBounds reach = box;
  if (cag_solid_is_compound(s)) status = cag_solid_reach(s, &reach, err);
  *out = (CagBounds){cag_vec3(fmax(box.min.x, reach.min.x), fmax(box.min.y, reach.min.y),
                              fmax(box.min.z, reach.min.z)),
                     cag_vec3(fmin(box.max.x, reach.max.x), fmin(box.max.y, reach.max.y),
                              fmin(box.max.z, reach.max.z))};
  return status;
}

// --- Mass ---

// The inertia tensor trace(J) E - J from second moments. The diagonal adds the other two moments,
// which avoids cancellation.
static void set_inertia(CagMassProperties *m, const double j[3][3]) {
  for (int i = 0; i < 3; i++) {
    int next = (i + 1) % 3, last = (i + 2) % 3;
    for (int k = 0; k < 3; k++)
      m->inertia[i][k] = i == k ? j[next][next] + j[last][last] : 0 - j[i][k];
  }
}

// Moments under the placement: J' = |det| A J A^T.
static void place_body(const CagSolidBody *b, const CagTransform *t, CagMassProperties *m) {
  const double j[3][3] = {{b->moment[0], b->moment[3], b->moment[5]},
                          {b->moment[3], b->moment[1], b->moment[4]},
                          {b->moment[5], b->moment[4], b->moment[2]}};
  double half[3][3], full[3][3];
  double det = fabs(cag_dot(cag_cross(cag_vec3(t->m[0][0], t->m[1][0], t->m[2][0]),
                                      cag_vec3(t->m[0][1], t->m[1][1], t->m[2][1])),
                            cag_vec3(t->m[0][2], t->m[1][2], t->m[2][2])));
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) {
      half[i][k] = 0;
      for (int l = 0; l < 3; l++) half[i][k] += t->m[i][l] * j[l][k];
    }
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) {
      full[i][k] = 0;
      for (int l = 0; l < 3; l++) full[i][k] += half[i][l] * t->m[k][l];
      full[i][k] *= det;
    }
  m->volume = b->volume * det;
  m->volume_centroid = cag_transform_point(t, b->centroid);
  set_inertia(m, (const double(*)[3])full);
}

static CagStatus area_of_faces(const CagSolid *s, CagMassProperties *m, CagError *err) {
  CagVec3 moment = {0, 0, 0};
  m->area = 0;
  for (size_t i = 0; i < s->face_count; i++) {
    double area;
    CagVec3 centroid;
    CagStatus status = cag_surface_area(s->faces[i], &area, &centroid, err);
    if (status) return status;
    m->area += area;
    moment = cag_madd(moment, area, centroid);
  }
  m->area_centroid = m->area > 0 ? cag_scaled(moment, 1 / m->area) : moment;
  return CAG_OK;
}

// By the divergence theorem, in coordinates relative to the middle of the solid: moments about a
// distant origin would lose digits.
static CagStatus volume_of_faces(const CagSolid *s, CagMassProperties *m, CagError *err) {
  CagBounds box;
  CagStatus status = cag_solid_bounds(s, &box, err);
  if (status) return status;
  CagVec3 middle = cag_lerp(box.min, box.max, 0.5);
  CagTransform shift = cag_translate(cag_scaled(middle, -1));
  double terms[10] = {0};
  for (size_t i = 0; i < s->face_count; i++) {
    CagSurface *face;
    status = cag_surface_transform(s->faces[i], &shift, &face, err);
    if (status) return status;
    status = cag_surface_volume_terms(face, terms, err);
    cag_surface_release(face);
    if (status) return status;
  }
  double v = terms[0];
  const double c[3] = {terms[1] / v, terms[2] / v, terms[3] / v};
  double j[3][3];
  for (int i = 0; i < 3; i++) {
    int next = (i + 1) % 3;
    j[i][i] = terms[4 + i] - v * c[i] * c[i];
    j[i][next] = j[next][i] = terms[7 + i] - v * c[i] * c[next];
  }
  m->volume = v;
  m->volume_centroid = cag_add(middle, cag_vec3(c[0], c[1], c[2]));
  set_inertia(m, (const double(*)[3])j);
  return CAG_OK;
}

CagStatus cag_solid_mass(const CagSolid *s, CagMassProperties *out, CagError *err) {
  CagMassProperties m = {0};
  const CagSolidKindRow *kind = &cag_solid_kinds[s->kind];
  double scale;
  if (s->face_count == 0) return cag_csg_mass(s, 0, out, err);
  if (!kind->body && !s->exact) {
    CagStatus status = area_of_faces(s, &m, err);
    if (!status) status = volume_of_faces(s, &m, err);
    if (!status) *out = m;
    return status;
  }
  CagSolidBody body;
  if (s->exact) {
    CagStatus status = cag_exact_body(s->exact, &body, err);
    if (status) return status;
  } else body = kind->body(s);
  place_body(&body, &s->placement, &m);
  if (cag_transform_is_similarity(&s->placement, &scale)) {
    m.area = body.area * scale * scale;
    m.area_centroid = cag_transform_point(&s->placement, body.area_centroid);
  } else {
    CagStatus status = area_of_faces(s, &m, err);
    if (status) return status;
  }
  *out = m;
  return CAG_OK;
}
