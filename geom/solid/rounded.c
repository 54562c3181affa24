// Extrusions with rounded or beveled ends.
//
// The outline is cut into smooth pieces. Each piece has a face on the side and a rim at each
// rounded end: a part of a cylinder or plane along a line, of a torus or cone along an arc of a
// circle, else a surface of kind "rim". Rims meet at convex corners in a miter. At a concave corner,
// a face turned about the vertical edge lies between them. The caps are bounded by the rims.
//
// All faces are rectangles of parameters whose sides are whole edges, so the table of edges follows
// from the order of the pieces.

#include "geom/solid/rounded.h"

#include <math.h>
#include <stdio.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/strip.h"
#include "geom/linalg/tolerance.h"
#include "geom/solid/build.h"
#include "geom/solid/csg.h"
#include "geom/surface/rim.h"

// Turns to the right between two lines below this (sine) get a miter as well: the ball leaves it by
// an eighth of the square.
#define SLIGHT 3e-5
// A piece that shrinks to less than this fraction of its length is used up.
#define LEAST 1e-6
// Samples of a curve along its length and over the width of the rim, to compare the radius of
// curvature with the distance.
#define SAMPLES 32
#define LEVELS 8
// Relative difference of the areas of the offset and of the cap that is rounding of the offset.
#define SAME_AREA 1e-7
// Accuracy of the offset, as a fraction of the size of the region.
#define OFFSET 1e-9
// Bisections for the largest distance, which is printed with 6 digits.
#define BISECTIONS 26

typedef enum Corner { SMOOTH, MITER, TURNED } Corner;

// A smooth piece of a loop.
typedef struct Piece {
  const CagStripPart *part;
  size_t next;
  Corner corner;   // at its end
  CagVec3 end_way; // MITER of two lines: how the corner moves, by the distance
  bool bent;       // a miter at one of its ends is not straight
} Piece;

typedef struct Loop {
  CagStripParts parts;
  Piece *pieces;
} Loop;

typedef struct Outline {
  const CagRegion *region;
  Loop *loops;
  double size;
  bool cusp; // turns straight back: nothing fits
} Outline;

static CagVec3 left_of(CagVec3 v) { return cag_vec3(-v.y, v.x, 0); }
static CagVec3 normal_at(const CagStripPart *p, int end) { return left_of(p->tangents[end]); }

// --- The outline ---

static void outline_free(Outline *o) {
  for (size_t i = 0; o->loops && i < o->region->count; i++) {
    cag_strip_parts_free(&o->loops[i].parts);
    cag_free(o->loops[i].pieces);
  }
  cag_free(o->loops);
}

static void judge_corner(Outline *o, Piece *p, const CagStripPart *next) {
  const CagVec3 a = normal_at(p->part, 1), b = normal_at(next, 0);
  const double sine = cag_cross(a, b).z, cosine = cag_dot(a, b);
  const bool lines = p->part->straight && next->straight;
  switch (cag_strip_turn(p->part, next)) {
  case CAG_TURN_NONE: p->corner = SMOOTH; break;
  case CAG_TURN_LEFT: p->corner = MITER; break;
  case CAG_TURN_RIGHT: p->corner = lines && cosine > 0 && -sine < SLIGHT ? MITER : TURNED; break;
  case CAG_TURN_BACK: o->cusp = true; break;
  }
  if (lines && 1 + cosine > 0) p->end_way = cag_scaled(cag_add(a, b), 1 / (1 + cosine));
}

static const Piece *piece_before(const Loop *l, size_t k) {
  return &l->pieces[k > 0 ? k - 1 : l->parts.n - 1];
}

static void mark_bent(Loop *l) {
  for (size_t k = 0; k < l->parts.n; k++) {
    Piece *p = &l->pieces[k], *next = &l->pieces[p->next];
    if (p->corner != MITER || (p->part->straight && next->part->straight)) continue;
    p->bent = next->bent = true;
  }
}

// Whether the miter at the end of the piece is followed: one of its rims is of the general kind.
static bool is_followed(const Loop *l, const Piece *p) {
  return p->corner == MITER && (p->bent || l->pieces[p->next].bent);
}

static CagStatus outline_of(const CagRegion *r, Outline *out, CagError *err) {
  CagBounds box;
  *out = (Outline){.region = r, .loops = cag_calloc(r->count, sizeof *out->loops)};
  if (!out->loops) return cag_fail_memory(err);
  CagStatus status = cag_region_bounds(r, &box, err);
  if (!status) out->size = cag_norm(cag_sub(box.max, box.min));
  for (size_t i = 0; !status && i < r->count; i++) {
    Loop *l = &out->loops[i];
    status = cag_strip_parts_add(&l->parts, r->loops[i], 0, err);
    if (!status && !(l->pieces = cag_calloc(l->parts.n + 1, sizeof *l->pieces)))
      status = cag_fail_memory(err);
    for (size_t k = 0; !status && k < l->parts.n; k++) {
      Piece *p = &l->pieces[k];
      p->part = &l->parts.items[k];
      p->next = k + 1 < l->parts.n ? k + 1 : 0;
      judge_corner(out, p, &l->parts.items[p->next]);
    }
    if (!status) mark_bent(l);
  }
  if (status) outline_free(out);
  return status;
}

// --- The rims of one end ---

typedef struct Rims {
  CagRimProfile profile;
  CagRimMiter **miters; // by loop and piece: at the end of the piece, if it is followed
} Rims;

static void rims_free(const Outline *o, Rims *r) {
  for (size_t i = 0; r->miters && i < o->region->count; i++) {
    for (size_t k = 0; r->miters[i] && k < o->loops[i].parts.n; k++)
      cag_rim_miter_free(&r->miters[i][k]);
    cag_free(r->miters[i]);
  }
  cag_free(r->miters);
  r->miters = NULL;
}

static CagStatus rims_new(const Outline *o, const CagRimProfile *p, Rims *out, bool *fits,
                          CagError *err) {
  *out = (Rims){*p, cag_calloc(o->region->count, sizeof *out->miters)};
  *fits = !o->cusp;
  if (!out->miters) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < o->region->count; i++) {
    const Loop *l = &o->loops[i];
    out->miters[i] = cag_calloc(l->parts.n + 1, sizeof **out->miters);
    if (!out->miters[i]) status = cag_fail_memory(err);
    for (size_t k = 0; !status && *fits && k < l->parts.n; k++) {
      const Piece *a = &l->pieces[k];
      if (!is_followed(l, a)) continue;
      status = cag_rim_miter(a->part->curve, l->pieces[a->next].part->curve, p, fits,
                             &out->miters[i][k], err);
    }
  }
  if (status) rims_free(o, out);
  return status;
}

static const CagRimMiter *miter_of(const Rims *r, size_t loop, const Loop *l, const Piece *p) {
  return is_followed(l, p) ? &r->miters[loop][p - l->pieces] : NULL;
}

// Whether some of the curve between the miters is left at each distance, and bends to its left less
// than the distance allows.
static CagStatus piece_fits(const Rims *r, size_t loop, const Loop *l, size_t k, bool *fits,
                            CagError *err) {
  const Piece *p = &l->pieces[k], *before = piece_before(l, k);
  const CagCurve *c = p->part->curve;
  const CagRimMiter *m0 = miter_of(r, loop, l, before), *m1 = miter_of(r, loop, l, p);
  const double d = r->profile.reach;
  if (p->part->straight) {
    const double length = cag_norm(cag_sub(p->part->ends[1], p->part->ends[0]));
    double a = m0 ? m0->at[CAG_RIM_STEPS][1] : c->start, b = m1 ? m1->at[CAG_RIM_STEPS][0] : c->end;
    double left = length * (b - a) / (c->end - c->start);
    if (before->corner == MITER && !m0) left -= d * cag_dot(before->end_way, p->part->tangents[0]);
    if (p->corner == MITER && !m1) left += d * cag_dot(p->end_way, p->part->tangents[1]);
    *fits = left > LEAST * length;
    return CAG_OK;
  }
  for (int level = 1; *fits && level <= LEVELS; level++) {
    const int step = level * CAG_RIM_STEPS / LEVELS;
    const double a = m0 ? m0->at[step][1] : c->start, b = m1 ? m1->at[step][0] : c->end;
    const double v = (double)level / LEVELS, at = r->profile.round ? 1 - cos(M_PI / 2 * v) : v;
    *fits = b - a > LEAST * (c->end - c->start);
    for (int i = 0; *fits && i <= SAMPLES; i++) {
      CagVec3 q[3];
      const CagStatus status =
          cag_curve_eval(c, i == SAMPLES ? b : a + (b - a) * i / SAMPLES, 2,
                         i == SAMPLES ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, q, err);
      if (status) return status;
      const double speed = cag_norm(q[1]);
      *fits = (1 - LEAST) * speed * speed * speed > at * d * cag_cross(q[1], q[2]).z;
    }
  }
  return CAG_OK;
}

// --- Faces ---

// A face and its sides: the start and end along the outline, the foot at the side of the extrusion,
// and the cap. All sides from foot to cap have the same parameter.
typedef struct Patch {
  size_t face;
  int start, end, foot, cap;
  bool backward; // its parameter runs against the outline
} Patch;

typedef struct Builder {
  CagSolid *solid;
  CagCurve **caps; // pieces of the loop of a cap
  size_t cap_count, cap_room;
} Builder;

static CagStatus add_cap_piece(Builder *b, CagCurve *c, CagError *err) {
  if (!CAG_RESERVE(b->caps, b->cap_room, b->cap_count + 1)) {
    cag_curve_release(c);
    return cag_fail_memory(err);
  }
  b->caps[b->cap_count++] = c;
  return CAG_OK;
}

static void drop_cap_pieces(Builder *b) {
  while (b->cap_count > 0) cag_curve_release(b->caps[--b->cap_count]);
}

// The profile at a point of the outline that moves inward by `way` per distance: from the side to
// the cap.
static CagStatus profile_curve(const CagRimProfile *p, CagVec3 from, CagVec3 way, CagCurve **out,
                               CagError *err) {
  from.z = p->foot;
  const CagVec3 to = cag_add(cag_madd(from, p->reach, way), cag_vec3(0, 0, p->sense * p->reach));
  if (!p->round) return cag_curve_line(from, to, 3, out, err);
  const double length = cag_norm(way);
  CagTransform frame = cag_translate(cag_madd(from, p->reach, way));
  const CagVec3 x = cag_scaled(way, -1 / length), y = cag_vec3(0, 0, p->sense), n = cag_cross(x, y);
  const CagVec3 columns[3] = {x, y, n};
  for (int j = 0; j < 3; j++) {
    frame.m[0][j] = columns[j].x;
    frame.m[1][j] = columns[j].y;
    frame.m[2][j] = columns[j].z;
  }
  frame.planar = false;
  return cag_curve_arc(p->reach * length, p->reach, 0, M_PI / 2, &frame, out, err);
}

// The way of the end (0 or 1) of a line whose miters are straight.
static CagVec3 end_way(const Loop *l, size_t k, int end) {
  const Piece *p = end == 0 ? piece_before(l, k) : &l->pieces[k];
  return p->corner == MITER ? p->end_way : normal_at(l->pieces[k].part, end);
}

static Patch patch_along(const Builder *b, bool down) {
  const size_t face = b->solid->face_count - 1;
  return down ? (Patch){face, 1, 0, 2, 3, true} : (Patch){face, 0, 1, 2, 3, false};
}

static Patch patch_about(const Builder *b, bool down) {
  const size_t face = b->solid->face_count - 1;
  return down ? (Patch){face, 2, 3, 0, 1, false} : (Patch){face, 3, 2, 0, 1, true};
}

static CagStatus add_straight(Builder *b, const Rims *r, const Loop *l, size_t k, Patch *out,
                              CagError *err) {
  const CagStripPart *p = l->pieces[k].part;
  const double d = r->profile.reach;
  CagCurve *ends[2] = {0}, *cap;
  CagSurface *face;
  CagStatus status = CAG_OK;
  for (int i = 0; !status && i < 2; i++)
    status = profile_curve(&r->profile, p->ends[i], end_way(l, k, i), &ends[i], err);
  const bool down = r->profile.sense < 0;
  // u = 1 is on the first curve.
  if (!status) status = cag_surface_ruled(ends[down ? 0 : 1], ends[down ? 1 : 0], &face, err);
  if (!status) {
    cag_solid_add(b->solid, face);
    *out = patch_along(b, down);
    status = cag_curve_line(cag_madd(p->ends[0], d, end_way(l, k, 0)),
                            cag_madd(p->ends[1], d, end_way(l, k, 1)), 2, &cap, err);
  }
  if (!status) status = add_cap_piece(b, cap, err);
  cag_curve_release(ends[0]);
  cag_curve_release(ends[1]);
  return status;
}

// A face turned about a vertical axis by an angle, counter-clockwise if sense > 0: from the profile
// at the start, or backwards from the one at the end, so that its normal points outward.
static CagStatus add_turned(Builder *b, const CagRimProfile *p, CagVec3 center, double sense,
                            double angle, const CagVec3 ends[2], const CagVec3 ways[2], Patch *out,
                            CagError *err) {
  const bool down = p->sense < 0;
  const int from = down ? 0 : 1;
  CagCurve *profile;
  CagSurface *face;
  CagStatus status = profile_curve(p, ends[from], ways[from], &profile, err);
  if (status) return status;
  center.z = p->foot;
  status = cag_surface_revolve(profile, cag_vec3(0, 0, down ? sense : -sense), center, 0, angle,
                               &face, err);
  cag_curve_release(profile);
  if (status) return status;
  cag_solid_add(b->solid, face);
  *out = patch_about(b, down);
  return CAG_OK;
}

static CagStatus add_arc(Builder *b, const Rims *r, const CagStripPart *p, Patch *out,
                         CagError *err) {
  const double scale = 1 - p->sense * r->profile.reach / p->radius;
  const CagVec3 ways[2] = {normal_at(p, 0), normal_at(p, 1)};
  CagCurve *cap;
  double length;
  CagStatus status = cag_curve_length(p->curve, p->curve->start, p->curve->end, &length, err);
  if (status) return status;
  const double angle = p->curve->closed ? 2 * M_PI : length / p->radius;
  status = add_turned(b, &r->profile, p->center, p->sense, angle, p->ends, ways, out, err);
  if (status) return status;
  CagTransform t = cag_translate(cag_scaled(p->center, 1 - scale));
  t.m[0][0] = t.m[1][1] = scale;
  t.planar = true;
  status = cag_curve_transform(p->curve, &t, &cap, err);
  return status ? status : add_cap_piece(b, cap, err);
}

static CagStatus add_general(Builder *b, const Rims *r, size_t loop, const Loop *l, size_t k,
                             Patch *out, CagError *err) {
  const bool down = r->profile.sense < 0;
  CagSurface *face;
  CagCurve *edge = NULL, *flat = NULL, *cap = NULL;
  CagStatus status = cag_surface_rim(l->pieces[k].part->curve, &r->profile,
                                     miter_of(r, loop, l, piece_before(l, k)),
                                     miter_of(r, loop, l, &l->pieces[k]), &face, err);
  if (status) return status;
  cag_solid_add(b->solid, face);
  *out = patch_along(b, down);
  CagTransform frame =
      cag_translate(cag_vec3(0, 0, r->profile.foot + r->profile.sense * r->profile.reach));
  frame.planar = false;
  status = cag_surface_isocurve(face, 1, 1, &edge, err);
  if (!status) status = cag_curve_flatten(edge, &frame, &flat, err);
  if (!status && down) status = cag_curve_reverse(flat, &cap, err);
  else if (!status) cap = cag_curve_retain(flat);
  cag_curve_release(edge);
  cag_curve_release(flat);
  return status ? status : add_cap_piece(b, cap, err);
}

// The face about the vertical edge of a concave corner.
static CagStatus add_corner(Builder *b, const Rims *r, const Loop *l, const Piece *p, Patch *out,
                            CagError *err) {
  const CagVec3 corner = p->part->ends[1];
  const CagVec3 ways[2] = {normal_at(p->part, 1), normal_at(l->pieces[p->next].part, 0)};
  const CagVec3 ends[2] = {corner, corner};
  const double angle = atan2(-cag_cross(ways[0], ways[1]).z, cag_dot(ways[0], ways[1]));
  CagCurve *cap;
  CagStatus status = add_turned(b, &r->profile, corner, -1, angle, ends, ways, out, err);
  if (status) return status;
  CagTransform frame = cag_translate(corner);
  const CagVec3 x = ways[0], y = cag_scaled(left_of(x), -1);
  frame.m[0][0] = x.x;
  frame.m[1][0] = x.y;
  frame.m[0][1] = y.x;
  frame.m[1][1] = y.y;
  frame.planar = true;
  status = cag_curve_arc(r->profile.reach, r->profile.reach, 0, angle, &frame, &cap, err);
  return status ? status : add_cap_piece(b, cap, err);
}

// Patches of a loop: for each piece its face, and the one of the corner at its end, if there is
// one.
typedef struct Ring {
  Patch *faces, *corners;
} Ring;

static CagStatus ring_new(size_t n, Ring *out, CagError *err) {
  *out = (Ring){cag_calloc(n + 1, sizeof(Patch)), cag_calloc(n + 1, sizeof(Patch))};
  if (out->faces && out->corners) return CAG_OK;
  return cag_fail_memory(err); // the caller frees both
}

static void ring_free(Ring *r) {
  cag_free(r->faces);
  cag_free(r->corners);
}

static CagStatus join_ends(Builder *b, const Patch *a, const Patch *c, CagError *err) {
  // The face of a closed piece is closed.
  if (!cag_solid_side_is_edge(b->solid->faces[a->face], a->end)) return CAG_OK;
  return cag_solid_add_edge(b->solid, a->face, a->end, c->face, c->start, false, err);
}

// The rims of a loop, with the edges between them; the pieces of the cap are left in the builder.
static CagStatus add_rims(Builder *b, const Rims *r, size_t loop, const Loop *l, Ring *out,
                          CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t k = 0; !status && k < l->parts.n; k++) {
    const Piece *p = &l->pieces[k];
    if (p->part->straight && !p->bent) status = add_straight(b, r, l, k, &out->faces[k], err);
    else if (p->part->round && !p->bent) status = add_arc(b, r, p->part, &out->faces[k], err);
    else status = add_general(b, r, loop, l, k, &out->faces[k], err);
    if (!status && p->corner == TURNED) status = add_corner(b, r, l, p, &out->corners[k], err);
  }
  for (size_t k = 0; !status && k < l->parts.n; k++) {
    const Piece *p = &l->pieces[k];
    if (p->corner == TURNED) {
      status = join_ends(b, &out->faces[k], &out->corners[k], err);
      if (!status) status = join_ends(b, &out->corners[k], &out->faces[p->next], err);
    } else status = join_ends(b, &out->faces[k], &out->faces[p->next], err);
  }
  return status;
}

// The loop of the cap that the rims leave.
static CagStatus take_cap_loop(Builder *b, CagCurve **out, CagError *err) {
  CagStatus status = CAG_OK;
  if (b->cap_count == 1) *out = cag_curve_retain(b->caps[0]);
  else status = cag_curve_join(b->caps, b->cap_count, out, err);
  drop_cap_pieces(b);
  return status;
}

// --- Ends ---

typedef struct End {
  Rims rims; // if `rounded`
  bool rounded;
  double z;
  Ring *rings; // by loop
  CagRegion *cap;
  size_t cap_face;
} End;

static void end_free(const Outline *o, End *e) {
  rims_free(o, &e->rims);
  for (size_t i = 0; e->rings && i < o->region->count; i++) ring_free(&e->rings[i]);
  cag_free(e->rings);
  cag_region_release(e->cap);
}

static CagStatus add_end(Builder *b, const Outline *o, End *e, CagError *err) {
  const size_t n = o->region->count;
  if (!e->rounded) {
    e->cap = cag_region_retain(o->region);
    return CAG_OK;
  }
  CagCurve **loops = cag_calloc(n + 1, sizeof *loops);
  e->rings = cag_calloc(n + 1, sizeof *e->rings);
  CagStatus status = loops && e->rings ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++) {
    status = ring_new(o->loops[i].parts.n, &e->rings[i], err);
    if (!status) status = add_rims(b, &e->rims, i, &o->loops[i], &e->rings[i], err);
    if (!status) status = take_cap_loop(b, &loops[i], err);
  }
  if (!status) status = cag_region_take(loops, o->region->outer, n, &e->cap, err);
  else
    for (size_t i = 0; loops && i < n; i++) cag_curve_release(loops[i]);
  cag_free(loops);
  return status;
}

// --- Whether a rounding fits ---

// Rims, corners, sides, and caps.
static size_t most_faces(const Outline *o) {
  size_t n = 2;
  for (size_t i = 0; i < o->region->count; i++) n += 5 * o->loops[i].parts.n;
  return n;
}

// Whether the cap of the end is the offset of the region: a cap that crosses itself encloses a
// smaller signed area.
static CagStatus cap_fits(const Outline *o, const CagRegion *cap, double d, bool *fits,
                          CagError *err) {
  CagRegion *offset = NULL;
  double own = 0, other = 0, whole = 0;
  CagStatus status = cag_region_offset(o->region, -d, OFFSET * o->size, &offset, err);
  if (status) return status;
  *fits = offset->count == cap->count;
  if (*fits) status = cag_region_area(offset, &other, NULL, err);
  for (size_t i = 0; !status && *fits && i < cap->count; i++) {
    double area = 0;
    status = cag_curve_area(cap->loops[i], &area, NULL, err);
    own += area;
  }
  if (!status && *fits) status = cag_region_area(o->region, &whole, NULL, err);
  *fits = *fits && fabs(own - other) <= SAME_AREA * whole;
  cag_region_release(offset);
  return status;
}

static CagStatus pieces_fit(const Outline *o, const Rims *r, bool *fits, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && *fits && i < o->region->count; i++)
    for (size_t k = 0; !status && *fits && k < o->loops[i].parts.n; k++)
      status = piece_fits(r, i, &o->loops[i], k, fits, err);
  return status;
}

// Whether an end of this reach fits, whatever the height.
static CagStatus reach_fits(const Outline *o, const CagRoundedEnd *how, double reach, bool *fits,
                            CagError *err) {
  End e = {.rounded = true};
  Builder b = {0};
  const CagRimProfile profile = {reach, how->round, 0, 1};
  CagStatus status = cag_stop_check(err);
  if (!status) status = cag_solid_block(CAG_SOLID_SHELL, most_faces(o), &b.solid, err);
  if (status) return status;
  status = rims_new(o, &profile, &e.rims, fits, err);
  if (!status && *fits) status = pieces_fit(o, &e.rims, fits, err);
  if (!status && *fits) status = add_end(&b, o, &e, err);
  if (!status && *fits) status = cap_fits(o, e.cap, reach, fits, err);
  drop_cap_pieces(&b);
  cag_free(b.caps);
  cag_solid_release(b.solid);
  end_free(o, &e);
  return status;
}

static CagStatus fail_reach(const Outline *o, const CagRoundedEnd *how, CagError *err) {
  const char *name = how->round ? "fillet" : "chamfer";
  double most = 0, above = how->reach;
  char found[32], limit[32];
  // Start below the size of the region.
  above = fmin(above, o->size);
  for (int i = 0; !o->cusp && i < BISECTIONS; i++) {
    const double middle = (most + above) / 2;
    bool fits = false;
    const CagStatus status = reach_fits(o, how, middle, &fits, err);
    if (status) return status;
    if (fits) most = middle;
    else above = middle;
  }
  if (o->cusp)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_rounding_too_large, name, -1,
                    "an outline with a cusp cannot have a %s; remove the cusp", name);
  snprintf(limit, sizeof limit, "%.5g", above);
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_rounding_too_large, name, -1,
                  "`%s` must be less than %s for this outline, found %s", name, limit,
                  cag_number_text(how->reach, found));
}

static CagStatus check_height(double height, const CagRoundedEnd ends[2], CagError *err) {
  const double sum = ends[0].reach + ends[1].reach;
  char found[32], limit[32];
  if (sum <= height * (1 + CAG_ROUNDING)) return CAG_OK;
  const CagRoundedEnd *larger = &ends[ends[1].reach > ends[0].reach ? 1 : 0];
  const bool both = ends[0].reach > 0 && ends[1].reach > 0;
  return cag_fail(
      err, CAG_E_ARGUMENT, CAG_ERR_rounding_too_large, larger->round ? "fillet" : "chamfer", -1,
      both ? "both rounded ends together must be at most as high as the extrusion (%s), "
             "found %s; reduce `%s` or increase `height`"
           : "the rounded end must be at most as high as the extrusion (%s), found %s; "
             "reduce `%s` or increase `height`",
      cag_number_text(height, limit), cag_number_text(sum, found),
      larger->round ? "fillet" : "chamfer");
}

// --- The solid ---

// The faces of the side, one for each piece, between the ends.
static CagStatus add_sides(Builder *b, const Loop *l, double low, double high, Patch *out,
                           CagError *err) {
  CagStatus status = CAG_OK;
  const CagTransform up = {.m = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, low}, {0, 0, 0, 1}}};
  for (size_t k = 0; !status && k < l->parts.n; k++) {
    CagCurve *space = NULL;
    CagSurface *face;
    status = cag_curve_transform(l->pieces[k].part->curve, &up, &space, err);
    if (!status) status = cag_surface_extrude(space, cag_vec3(0, 0, high - low), 0, 1, &face, err);
    cag_curve_release(space);
    if (status) break;
    cag_solid_add(b->solid, face);
    out[k] = (Patch){b->solid->face_count - 1, 0, 1, 2, 3, false};
  }
  for (size_t k = 0; !status && k < l->parts.n; k++)
    status = join_ends(b, &out[k], &out[l->pieces[k].next], err);
  return status;
}

static CagStatus join_sides(Builder *b, const Patch *p, int side, const Patch *q, int other,
                            CagError *err) {
  return cag_solid_add_edge(b->solid, p->face, side, q->face, other, p->backward != q->backward,
                            err);
}

// The edges of loop i with the caps, and between rims and sides. sides: NULL if the rims of both
// ends meet.
static CagStatus join_loop(Builder *b, const Loop *l, size_t i, const End ends[2],
                           const Patch *sides, CagError *err) {
  CagStatus status = CAG_OK;
  for (int e = 0; !status && e < 2; e++)
    for (size_t k = 0; !status && k < l->parts.n; k++) {
      const int side = e == 0 ? 2 : 3, loop = 4 + (int)i;
      const Patch *rim = ends[e].rounded ? &ends[e].rings[i].faces[k] : NULL;
      if (rim && sides) status = join_sides(b, &sides[k], side, rim, rim->foot, err);
      const Patch *at = rim ? rim : &sides[k];
      if (!status)
        status = cag_solid_add_edge(b->solid, ends[e].cap_face, loop, at->face,
                                    rim ? rim->cap : side, at->backward != (e == 0), err);
      if (status || !rim || l->pieces[k].corner != TURNED) continue;
      const Patch *corner = &ends[e].rings[i].corners[k];
      status = cag_solid_add_edge(b->solid, ends[e].cap_face, loop, corner->face, corner->cap,
                                  corner->backward != (e == 0), err);
    }
  for (size_t k = 0; !status && !sides && k < l->parts.n; k++) {
    const Patch *p = &ends[0].rings[i].faces[k], *q = &ends[1].rings[i].faces[k];
    status = join_sides(b, p, p->foot, q, q->foot, err);
  }
  return status;
}

static CagStatus build(Builder *b, const Outline *o, End ends[2], CagError *err) {
  double foot[2];
  CagStatus status = CAG_OK;
  for (int e = 0; !status && e < 2; e++) {
    foot[e] = ends[e].rounded ? ends[e].rims.profile.foot : ends[e].z;
    status = add_end(b, o, &ends[e], err);
    CagTransform frame = cag_translate(cag_vec3(0, 0, ends[e].z));
    frame.planar = false;
    if (!status) status = cag_solid_add_cap(b->solid, ends[e].cap, &frame, e == 0, err);
    if (!status) ends[e].cap_face = b->solid->face_count - 1;
  }
  const bool has_sides = foot[1] - foot[0] > CAG_ROUNDING * (ends[1].z - ends[0].z);
  for (size_t i = 0; !status && i < o->region->count; i++) {
    Patch *sides = cag_calloc(o->loops[i].parts.n + 1, sizeof *sides);
    if (!sides) return cag_fail_memory(err);
    if (has_sides) status = add_sides(b, &o->loops[i], foot[0], foot[1], sides, err);
    if (!status) status = join_loop(b, &o->loops[i], i, ends, has_sides ? sides : NULL, err);
    cag_free(sides);
  }
  return status;
}

static CagStatus check_ends(const Outline *o, const CagRoundedEnd ends[2], CagError *err) {
  CagStatus status = CAG_OK;
  for (int e = 0; !status && e < 2; e++) {
    const bool again = e == 1 && ends[1].reach == ends[0].reach && ends[1].round == ends[0].round;
    bool fits = true;
    if (ends[e].reach == 0 || again) continue;
    status = reach_fits(o, &ends[e], ends[e].reach, &fits, err);
    if (!status && !fits) status = fail_reach(o, &ends[e], err);
  }
  return status;
}

static CagStatus extrude_up(const CagRegion *r, double height, const CagRoundedEnd ends[2],
                            CagSolid **out, CagError *err) {
  Outline o;
  Builder b = {0};
  CagStatus status = check_height(height, ends, err);
  if (!status) status = outline_of(r, &o, err);
  if (status) return status;
  End made[2] = {{.z = 0}, {.z = height}};
  status = check_ends(&o, ends, err);
  for (int e = 0; !status && e < 2; e++) {
    const double reach = ends[e].reach;
    bool fits = true;
    const CagRimProfile profile = {reach, ends[e].round, e == 0 ? reach : height - reach,
                                   e == 0 ? -1 : 1};
    made[e].rounded = reach > 0;
    if (made[e].rounded) status = rims_new(&o, &profile, &made[e].rims, &fits, err);
  }
  if (!status) status = cag_solid_block(CAG_SOLID_SHELL, most_faces(&o), &b.solid, err);
  if (!status) status = build(&b, &o, made, err);
  drop_cap_pieces(&b);
  cag_free(b.caps);
  for (int e = 0; e < 2; e++) end_free(&o, &made[e]);
  outline_free(&o);
  if (status) cag_solid_release(b.solid);
  else *out = b.solid;
  return status;
}

// A reach below rounding leaves the edge sharp.
static CagStatus drop_tiny(const CagRegion *r, const CagRoundedEnd given[2], CagRoundedEnd ends[2],
                           CagError *err) {
  CagBounds box;
  const CagStatus status = cag_region_bounds(r, &box, err);
  if (status) return status;
  for (int e = 0; e < 2; e++) {
    ends[e] = given[e];
    if (ends[e].reach <= CAG_ROUNDING * cag_norm(cag_sub(box.max, box.min))) ends[e].reach = 0;
  }
  return CAG_OK;
}

CagStatus cag_solid_extrude_rounded(const CagRegion *r, double height, const CagRoundedEnd given[2],
                                    CagSolid **out, CagError *err) {
  if (cag_region_is_empty(r)) return cag_solid_empty(out, err);
  CagRoundedEnd ends[2];
  const CagStatus bounded = drop_tiny(r, given, ends, err);
  if (bounded) return bounded;
  if (ends[0].reach == 0 && ends[1].reach == 0)
    return cag_solid_extrude(r, cag_vec3(0, 0, height), 0, 1, out, err);
  if (height == 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_degenerate_direction, "height", -1,
                    "`height` must not be 0");
  if (height > 0) return extrude_up(r, height, ends, out, err);
  const CagRoundedEnd turned[2] = {ends[1], ends[0]};
  const CagTransform down = cag_translate(cag_vec3(0, 0, height));
  CagSolid *up;
  CagStatus status = extrude_up(r, -height, turned, &up, err);
  if (status) return status;
  status = cag_solid_transform(up, &down, out, err);
  cag_solid_release(up);
  return status;
}
