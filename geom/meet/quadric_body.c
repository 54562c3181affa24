// Bodies that pieces of a quadric bound together with flat faces.
//
// The body is the intersection of a box and one side of the quadric. Pieces cut by a box or a range
// of z store that box. For other patches, the box is the range of the canonical coordinates of the
// patches.
//
// The body is kept as a set operation, for its mesh and for exporters that have such operations.
// Its boundary is known exactly as well: the pieces, and on each side of the box the part in which
// the section of the quadric is negative. The arcs that bound this part are the curves in which the
// pieces end.

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "geom/curve/conic_side.h"
#include "geom/meet/quadric_arc.h"
#include "geom/meet/quadric_body.h"
#include "geom/solid/build.h"
#include "geom/surface/quadric_equation.h"
#include "geom/surface/trimmed.h"

#define WHOLE_TURN (2 * M_PI * (1 - 1e-12))

static bool same_equation(const CagQuadric *a, const CagQuadric *b) {
  bool same = true, opposite = true;
  for (int i = 0; i < 10; i++) {
    same = same && a->c[i] == b->c[i];
    opposite = opposite && a->c[i] == -b->c[i];
  }
  return same || opposite;
}

static bool same_within(const CagQuadricWithin *a, const CagQuadricWithin *b) {
  return a->z_only == b->z_only && a->pieces == b->pieces &&
         memcmp(&a->box, &b->box, sizeof a->box) == 0 &&
         memcmp(a->frame.m, b->frame.m, sizeof a->frame.m) == 0;
}

static const CagSurface *whole_of(const CagSurface *piece) {
  cag_surface_trimmed_view(piece, &piece, NULL);
  return piece;
}

// Tests whether the pieces are all those of one box or range, each exactly once.
static bool are_all_within(CagSurface *const *pieces, size_t n, CagQuadricWithin *out) {
  CagQuadricWithin other;
  if (!cag_surface_quadric_within(pieces[0], out) || out->pieces != n) return false;
  for (size_t i = 1; i < n; i++) {
    if (!cag_surface_quadric_within(pieces[i], &other) || !same_within(out, &other)) return false;
    for (size_t k = 0; k < i; k++)
      if (pieces[k] == pieces[i]) return false;
  }
  return true;
}

bool cag_solid_has_quadric_body(CagSurface *const *pieces, size_t n) {
  CagQuadric first, other;
  CagQuadricWithin within;
  if (n == 0) return false;
  const bool all = are_all_within(pieces, n, &within);
  for (size_t i = 0; i < n; i++) {
    const CagSurface *whole = all ? whole_of(pieces[i]) : pieces[i];
    if (!cag_surface_quadric_view(whole, i == 0 ? &first : &other)) return false;
    // A strip of a partial turn does not bound a solid: what lies next to it is unknown.
    if (!all && whole->angular_u && whole->u1 - whole->u0 < WHOLE_TURN) return false;
    if (i > 0 && !same_equation(&first, &other)) return false;
  }
  return true;
}

// The bounds of the pieces in coordinates of the frame.
static CagStatus local_bounds(const CagTransform *frame, CagSurface *const *pieces, size_t n,
                              CagBounds *out, CagError *err) {
  CagTransform back;
  CagStatus status = cag_transform_inverse(frame, &back, err);
  *out = CAG_BOUNDS_EMPTY;
  for (size_t i = 0; !status && i < n; i++) {
    CagSurface *local;
    CagBounds one;
    status = cag_surface_transform(pieces[i], &back, &local, err);
    if (status) return status;
    status = cag_surface_bounds(local, &one, err);
    cag_surface_release(local);
    if (status) return status;
    cag_bounds_add(out, one.min);
    cag_bounds_add(out, one.max);
  }
  return status;
}

static bool is_about_axis(CagQuadricClass c) {
  return c == CAG_QUADRIC_ELLIPSOID || c == CAG_QUADRIC_HYPERBOLOID_ONE ||
         c == CAG_QUADRIC_HYPERBOLOID_TWO || c == CAG_QUADRIC_CONE ||
         c == CAG_QUADRIC_ELLIPTIC_PARABOLOID || c == CAG_QUADRIC_ELLIPTIC_CYLINDER;
}

// Finds the box that bounds the body, in coordinates of a frame.
static CagStatus find_box(const CagQuadricForm *form, CagSurface *const *pieces, size_t n,
                          CagBounds *box, CagTransform *frame, CagError *err) {
  CagQuadricWithin within;
  const bool all = are_all_within(pieces, n, &within);
  *frame = all ? within.frame : form->frame;
  frame->planar = false;
  if (all && !within.z_only) {
    *box = within.box;
    return CAG_OK;
  }
  CagStatus status = local_bounds(frame, pieces, n, box, err);
  if (status) return status;
  if (all ||
      is_about_axis(form->class_id)) { // a margin, so that the box touches nothing but the cut
    const double room = cag_norm(cag_sub(box->max, box->min));
    box->min.x -= room, box->min.y -= room, box->max.x += room, box->max.y += room;
  }
  if (all) {
    box->min.z = within.box.min.z;
    box->max.z = within.box.max.z;
  }
  return CAG_OK;
}

static CagStatus placed_box(const CagBounds *box, const CagTransform *frame, CagSolid **out,
                            CagError *err) {
  CagTransform shift = cag_translate(box->min), place;
  CagSolid *upright;
  shift.planar = false;
  place = cag_transform_multiply(frame, &shift);
  CagStatus status = cag_solid_box(cag_sub(box->max, box->min), false, &upright, err);
  if (status) return status;
  status = cag_solid_transform(upright, &place, out, err);
  cag_solid_release(upright);
  return status;
}

// --- The boundary ---

#define SIDES CAG_BOX_SIDES
#define FACES_MOST (SIDES * CAG_CONIC_PARTS)

typedef struct Boundary {
  CagSurface **faces;
  size_t n;
  bool decided; // the faces are known
} Boundary;

// Adds the flat faces on one side. q: the form in coordinates of the box.
static CagStatus add_caps(Boundary *b, const CagQuadric *q, const CagBounds *box,
                          const CagTransform *frame, int side, CagError *err) {
  CagBounds rectangle;
  CagConic section;
  CagRegion *parts[CAG_CONIC_PARTS];
  size_t n = 0;
  const CagTransform local =
      cag_box_side_frame(box, side, cag_transform_mirrors(frame), &rectangle);
  const CagTransform place = cag_transform_multiply(frame, &local);
  cag_quadric_section(q, &local, &section);
  CagStatus status = cag_conic_negative_parts(&section, &rectangle, parts, &n, &b->decided, err);
  for (size_t i = 0; i < n; i++) {
    if (!status) status = cag_surface_planar(parts[i], &place, &b->faces[b->n], err);
    if (!status) b->n++;
    cag_region_release(parts[i]);
  }
  return status;
}

// Adds a piece with its normal along the gradient of the form. The middle of the piece must be
// neither a pole nor the apex of a cone.
static CagStatus add_outward(Boundary *b, const CagSurface *piece, const CagQuadric *q,
                             CagError *err) {
  const CagSurface *whole = whole_of(piece);
  CagVec3 d[4];
  const double off_middle = 0.47;
  CagStatus status = cag_surface_eval(whole, whole->u0 + off_middle * (whole->u1 - whole->u0),
                                      whole->v0 + off_middle * (whole->v1 - whole->v0), 1,
                                      CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err);
  if (status) return status;
  const CagVec3 normal = cag_cross(d[cag_partial(1, 1, 0)], d[cag_partial(1, 0, 1)]);
  if (cag_dot(normal, cag_quadric_gradient(q, d[0])) > 0)
    b->faces[b->n] = cag_surface_retain(piece);
  else status = cag_surface_quadric_turn(piece, &b->faces[b->n], err);
  if (!status) b->n++;
  return status;
}

// Tests whether whole patches and caps share all edges.
static bool do_close(const Boundary *b) {
  CagSolid *shell = NULL;
  CagError err;
  const bool closed = !cag_solid_shell(b->faces, b->n, &shell, &err);
  cag_solid_release(shell);
  return closed;
}

// Gives the solid its faces. Without these it has only its mesh.
static CagStatus set_faces(CagSolid *body, CagSurface *const *pieces, size_t n, const CagQuadric *q,
                           const CagBounds *box, const CagTransform *frame, CagError *err) {
  Boundary b = {cag_calloc(n + FACES_MOST, sizeof *b.faces), 0, true};
  CagTransform back;
  CagQuadric local;
  CagQuadricWithin within;
  CagStatus status = b.faces ? CAG_OK : cag_fail_memory(err);
  if (!status) status = cag_transform_inverse(frame, &back, err);
  if (!status) status = cag_quadric_transform(q, &back, &local, err);
  for (size_t i = 0; !status && b.decided && i < n; i++)
    status = add_outward(&b, pieces[i], q, err);
  for (int side = 0; !status && b.decided && side < SIDES; side++)
    status = add_caps(&b, &local, box, frame, side, err);
  if (!status && b.decided && !are_all_within(pieces, n, &within)) b.decided = do_close(&b);
  if (!status && b.decided) {
    cag_free(body->faces);
    body->faces = b.faces;
    body->face_count = b.n;
    return CAG_OK;
  }
  for (size_t i = 0; i < b.n; i++) cag_surface_release(b.faces[i]);
  cag_free(b.faces);
  return cag_is_final(status) ? status : CAG_OK;
}

CagStatus cag_solid_quadric_body(CagSurface *const *pieces, size_t n, const volatile int *interrupt,
                                 CagSolid **out, CagError *err) {
  CagQuadric q;
  CagQuadricForm form;
  CagQuadricWithin within;
  CagBounds box;
  CagTransform frame;
  CagSolid *parts[2] = {NULL}, *body = NULL;
  cag_surface_quadric_view(whole_of(pieces[0]), &q);
  CagStatus status = cag_quadric_classify(&q, &form, err);
  if (!status && form.class_id == CAG_QUADRIC_HYPERBOLIC_PARABOLOID &&
      are_all_within(pieces, n, &within) && within.negated)
    for (int i = 0; i < 10; i++) q.c[i] = -q.c[i];
  if (!status) status = find_box(&form, pieces, n, &box, &frame, err);
  if (!status) status = cag_solid_quadric(&q, &parts[0], err);
  if (!status) status = placed_box(&box, &frame, &parts[1], err);
  if (!status) status = cag_solid_combine(CAG_INTERSECTION, parts, 2, interrupt, &body, err);
  if (!status) status = set_faces(body, pieces, n, &q, &box, &frame, err);
  cag_solid_release(parts[0]);
  cag_solid_release(parts[1]);
  if (status) cag_solid_release(body);
  else *out = body;
  return status;
}
