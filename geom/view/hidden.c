// Visibility by rays. A ray starts at a point of a line in space, a little nearer to the eye and
// beside the line in the drawing, so that it does not meet the faces of the line itself. A line is
// visible if the ray on one of its sides meets nothing; for a contour only the side counts that the
// face does not cover.

#include "geom/view/hidden.h"

#include <math.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/family.h"
#include "geom/ray/caster.h"
#include "geom/surface/nearest.h"
#include "geom/view/drawn.h"

// How far beside the line, and nearer to the eye, rays start, as fractions of the size.
#define BESIDE 1e-6
#define NEARER 2e-5
// Parts of lines shorter than this fraction of the size are not looked at.
#define SHORT 1e-5
// The sine of the angle between lines that coincide.
#define PARALLEL 1e-3
// Where a part is looked at, as fractions of its parameters.
static const double LOOKS[] = {0.2031, 0.3517, 0.5059, 0.6491, 0.8013};
enum { LOOK_COUNT = sizeof LOOKS / sizeof *LOOKS };
// Axes of an ellipse whose directions have a smaller cosine are its principal axes.
#define ROUND 1e-12
// A place at which the visibility changes within a part is found by this many bisections.
enum { BISECTIONS = 40 };

// A body that covers others.
typedef struct Cover {
  CagCaster *caster;
  double low[2], high[2]; // of its image
} Cover;

// A part of a line that is visible, or hidden, as a whole.
typedef struct Piece {
  size_t line; // of the drawing
  double a, b; // parameters of its flat curve
  bool visible, dropped;
} Piece;

typedef struct View {
  CagDrawing drawing;
  CagVec3 eye, x, y; // unit: to the eye, and along the axes of the drawing
  Cover *covers;
  size_t cover_count;
  Piece *pieces;
  size_t count, capacity;
  size_t *first; // the pieces of line i are pieces[first[i]] to pieces[first[i + 1] - 1]
  CagCrossings work;
} View;

static void view_free(View *v) {
  for (size_t i = 0; i < v->cover_count; i++) cag_caster_free(v->covers[i].caster);
  cag_free(v->covers);
  cag_free(v->pieces);
  cag_free(v->first);
  cag_crossings_free(&v->work);
  cag_drawing_free(&v->drawing);
}

// --- Covers ---

static CagStatus caster_of_body(const CagViewBody *b, CagCaster **out, CagError *err) {
  *out = NULL;
  if (b->solid) return cag_caster_of_solid(b->solid, out, err);
  if (b->surface) return cag_caster_of_surface(b->surface, out, err);
  return b->mesh ? cag_caster_of_mesh(b->mesh, out, err) : CAG_OK;
}

static void cover_extent(const View *v, Cover *c) {
  const CagBounds box = cag_caster_bounds(c->caster);
  const CagVec3 axes[2] = {v->x, v->y};
  for (int k = 0; k < 2; k++) {
    c->low[k] = INFINITY;
    c->high[k] = -INFINITY;
    for (int i = 0; i < 8; i++) {
      const CagVec3 p = cag_vec3(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                                 i & 4 ? box.max.z : box.min.z);
      const double at = cag_dot(p, axes[k]);
      c->low[k] = fmin(c->low[k], at);
      c->high[k] = fmax(c->high[k], at);
    }
  }
}

static CagStatus open_covers(View *v, const CagViewBody *bodies, size_t n, CagError *err) {
  v->covers = cag_calloc(n + 1, sizeof *v->covers);
  CagStatus status = v->covers ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++) {
    Cover *c = &v->covers[v->cover_count];
    status = caster_of_body(&bodies[i], &c->caster, err);
    if (status || !c->caster) continue;
    cover_extent(v, c);
    v->cover_count++;
    status = cag_stop_check(err);
  }
  return status;
}

// --- Rays ---

// Whether anything is between a point and the eye.
static CagStatus is_covered(View *v, CagVec3 p, bool *out, CagError *err) {
  const double at[2] = {cag_dot(p, v->x), cag_dot(p, v->y)}, slack = BESIDE * v->drawing.size;
  const CagRay ray = {p, v->eye, NEARER * v->drawing.size, INFINITY};
  CagStatus status = CAG_OK;
  *out = false;
  for (size_t i = 0; !status && !*out && i < v->cover_count; i++) {
    const Cover *c = &v->covers[i];
    CagCrossing met;
    if (at[0] < c->low[0] - slack || at[0] > c->high[0] + slack || at[1] < c->low[1] - slack ||
        at[1] > c->high[1] + slack)
      continue;
    status = cag_caster_first(c->caster, &ray, &v->work, &met, out, err);
  }
  return status;
}

// The direction in which no part of the face is, at a point of its contour.
static CagStatus fold_side(const CagSurface *face, CagVec3 p, CagVec3 *out, CagError *err) {
  CagSurfaceNearest at;
  CagStatus status = cag_surface_closest(face, p, &at, err);
  return status ? status : cag_surface_normal(face, at.u, at.v, out, err);
}

static CagStatus is_visible(View *v, const CagDrawnLine *l, double s, bool *out, CagError *err) {
  CagVec3 d[2], p, side;
  double t;
  bool covered = true;
  CagStatus status = cag_curve_eval(l->flat, s, 1, CAG_SIDE_RIGHT, d, err);
  if (!status) status = cag_drawn_parameter(&v->drawing, l, s, &t, err);
  if (!status) status = cag_curve_point(l->line->curve, t, &p, err);
  if (status) return status;
  const CagVec3 along = cag_unit(d[1]);
  side = cag_sub(cag_scaled(v->y, along.x), cag_scaled(v->x, along.y));
  if (l->line->fold) status = fold_side(l->line->fold, p, &side, err);
  if (status) return status;
  const double beside = BESIDE * v->drawing.size;
  status = is_covered(v, cag_madd(p, beside, side), &covered, err);
  if (!status && covered && !l->line->fold)
    status = is_covered(v, cag_madd(p, -beside, side), &covered, err);
  *out = !covered;
  return status;
}

// --- Pieces ---

static CagStatus add_piece(View *v, size_t line, double a, double b, bool visible, CagError *err) {
  if (!CAG_RESERVE(v->pieces, v->capacity, v->count + 1)) return cag_fail_memory(err);
  v->pieces[v->count++] = (Piece){line, a, b, visible, false};
  return CAG_OK;
}

// Adds the pieces of a part of a line between two cuts.
static CagStatus look_at_part(View *v, size_t line, double a, double b, CagError *err) {
  const CagDrawnLine *l = &v->drawing.items[line];
  bool seen[LOOK_COUNT];
  double from = a;
  CagStatus status = cag_stop_check(err);
  for (int i = 0; !status && i < LOOK_COUNT; i++)
    status = is_visible(v, l, a + LOOKS[i] * (b - a), &seen[i], err);
  for (int i = 1; !status && i < LOOK_COUNT; i++) {
    if (seen[i] == seen[i - 1]) continue;
    double low = a + LOOKS[i - 1] * (b - a), high = a + LOOKS[i] * (b - a);
    for (int k = 0; !status && k < BISECTIONS; k++) {
      const double middle = low + (high - low) / 2;
      bool here;
      status = is_visible(v, l, middle, &here, err);
      if (!status && here == seen[i - 1]) low = middle;
      else high = middle;
    }
    if (!status) status = add_piece(v, line, from, low, seen[i - 1], err);
    from = low;
  }
  return status ? status : add_piece(v, line, from, b, seen[LOOK_COUNT - 1], err);
}

static CagStatus chord(const CagDrawnLine *l, double a, double b, double *out, CagError *err) {
  CagVec3 p, q, m;
  CagStatus status = cag_curve_point(l->flat, a, &p, err);
  if (!status) status = cag_curve_point(l->flat, b, &q, err);
  if (!status) status = cag_curve_point(l->flat, a + (b - a) / 2, &m, err);
  if (!status) *out = cag_norm(cag_sub(m, p)) + cag_norm(cag_sub(q, m));
  return status;
}

// Parts that are too short to look at belong to the part before, or else to the one after.
static CagStatus look_at_line(View *v, size_t line, CagError *err) {
  const CagDrawnLine *l = &v->drawing.items[line];
  const size_t first = v->count;
  double from = l->cuts[0];
  CagStatus status = CAG_OK;
  for (size_t i = 1; !status && i < l->cut_count; i++) {
    double length = 0;
    if (l->cuts[i] > from) status = chord(l, from, l->cuts[i], &length, err);
    const bool last = i + 1 == l->cut_count;
    if (status || (length <= SHORT * v->drawing.size && !(last && v->count == first))) continue;
    status = look_at_part(v, line, from, l->cuts[i], err);
    from = l->cuts[i];
  }
  if (!status && v->count > first) v->pieces[v->count - 1].b = l->cuts[l->cut_count - 1];
  return status;
}

static CagStatus look_at_lines(View *v, CagError *err) {
  const size_t n = v->drawing.count;
  v->first = cag_calloc(n + 1, sizeof *v->first);
  CagStatus status = v->first ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++) {
    v->first[i] = v->count;
    status = look_at_line(v, i, err);
  }
  if (!status) v->first[n] = v->count;
  return status;
}

// --- Lines that coincide ---

// The parameter of a line at a point of another one, with its tangent, if the two coincide there; NAN
// else.
static CagStatus shared_parameter(const CagDrawing *d, size_t line, CagVec3 p, CagVec3 along,
                                  double *out, CagError *err) {
  const CagDrawnLine *l = &d->items[line];
  double s, distance;
  CagVec3 at[2];
  CagStatus status = cag_drawn_nearest(l, p, &s, &distance, err);
  *out = NAN;
  if (status || distance > CAG_DRAWN_NEAR * d->size) return status;
  status = cag_curve_eval(l->flat, s, 1, CAG_SIDE_RIGHT, at, err);
  if (status) return status;
  const CagVec3 other = cag_unit(at[1]);
  if (fabs(along.x * other.y - along.y * other.x) <= PARALLEL) *out = s;
  return CAG_OK;
}

static bool is_simple(const CagDrawnLine *l) {
  CagVec3 center, x, y;
  double rate;
  return l->straight || cag_curve_arc_axes(l->flat, &center, &x, &y, &rate);
}

// Whether one of two lines at the same depth is drawn: lines and conics before other curves, then the
// larger one, else the one with the lower index. This is a total order, so one of them is drawn.
static bool is_drawn_before(const CagDrawing *d, size_t a, size_t b) {
  const bool simple = is_simple(&d->items[a]);
  if (simple != is_simple(&d->items[b])) return simple;
  const CagBounds *one = &d->items[a].box, *other = &d->items[b].box;
  const double size = cag_norm(cag_sub(one->max, one->min)),
               with = cag_norm(cag_sub(other->max, other->min));
  return size != with ? size > with : a < b;
}

// A point of a piece.
typedef struct Spot {
  const Piece *piece;
  CagVec3 at, along; // in the drawing
  double depth;      // toward the eye
} Spot;

static CagStatus spot_of(const View *v, const Piece *p, double s, Spot *out, CagError *err) {
  const CagDrawnLine *l = &v->drawing.items[p->line];
  CagVec3 d[2], space;
  double t;
  CagStatus status = cag_curve_eval(l->flat, s, 1, CAG_SIDE_RIGHT, d, err);
  if (!status) status = cag_drawn_parameter(&v->drawing, l, s, &t, err);
  if (!status) status = cag_curve_point(l->line->curve, t, &space, err);
  if (!status) *out = (Spot){p, d[0], cag_unit(d[1]), cag_dot(space, v->eye)};
  return status;
}

// Whether one of two pieces that coincide at a spot is drawn rather than the other one: a visible one
// before a hidden one, and then the one that is nearer to the eye.
static bool is_spot_before(const View *v, const Spot *q, const Spot *p) {
  if (q->piece->visible != p->piece->visible) return q->piece->visible;
  if (fabs(q->depth - p->depth) > CAG_DRAWN_NEAR * v->drawing.size) return q->depth > p->depth;
  return is_drawn_before(&v->drawing, q->piece->line, p->piece->line);
}

// Whether a piece of a line is drawn rather than the one at a spot.
static CagStatus is_on_line(const View *v, size_t line, const Spot *p, bool *out, CagError *err) {
  const CagCurve *flat = v->drawing.items[line].flat;
  const double slack = 1e-9 * (flat->end - flat->start);
  bool any = false;
  double s;
  for (size_t k = v->first[line]; !any && k < v->first[line + 1]; k++)
    any = v->pieces[k].visible || !p->piece->visible;
  *out = false;
  if (!any) return CAG_OK;
  CagStatus status = shared_parameter(&v->drawing, line, p->at, p->along, &s, err);
  for (size_t k = v->first[line]; !status && !*out && k < v->first[line + 1]; k++) {
    const Piece *q = &v->pieces[k];
    Spot other;
    if (!(s >= q->a - slack && s <= q->b + slack)) continue;
    status = spot_of(v, q, fmin(fmax(s, flat->start), flat->end), &other, err);
    *out = !status && is_spot_before(v, &other, p);
  }
  return status;
}

// Whether something else is drawn at a point of a piece.
static CagStatus is_drawn_there(const View *v, const Piece *p, double s, bool *out, CagError *err) {
  const CagDrawing *d = &v->drawing;
  const double near = CAG_DRAWN_NEAR * d->size;
  Spot spot;
  CagStatus status = spot_of(v, p, s, &spot, err);
  *out = false;
  if (status) return status;
  for (size_t i = cag_drawing_from(d, spot.at.x - near); !status && !*out && i < d->count; i++) {
    const size_t line = d->order[i];
    const CagBounds *box = &d->items[line].box;
    if (box->min.x > spot.at.x + near) break;
    if (line != p->line && box->max.x >= spot.at.x - near && box->min.y <= spot.at.y + near &&
        box->max.y >= spot.at.y - near)
      status = is_on_line(v, line, &spot, out, err);
  }
  return status;
}

static CagStatus drop_covered(View *v, bool visible, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < v->count; i++) {
    Piece *p = &v->pieces[i];
    if (p->visible != visible) continue;
    bool drawn = true;
    for (int k = 0; !status && drawn && k < 3; k++)
      status = is_drawn_there(v, p, p->a + LOOKS[2 * k] * (p->b - p->a), &drawn, err);
    p->dropped = drawn;
    if (!status) status = cag_stop_check(err);
  }
  return status;
}

// --- The lists ---

// Replaces an arc of an ellipse that is given by any conjugate axes by one with its principal axes, in
// an orthonormal frame.
static CagStatus turn_axes(CagCurve **c, CagError *err) {
  CagVec3 center, x, y, p;
  double rate;
  if (!cag_curve_arc_axes(*c, &center, &x, &y, &rate) || rate != 1) return CAG_OK;
  const double skew = cag_dot(x, y);
  double a, b;
  CagTransform frame = cag_transform_identity(), given;
  if (fabs(skew) <= ROUND * cag_norm(x) * cag_norm(y) && cag_curve_arc_view(*c, &a, &b, &given) &&
      fabs(a - cag_norm(x)) <= ROUND * a && fabs(b - cag_norm(y)) <= ROUND * b)
    return CAG_OK;
  CagStatus status = cag_curve_point(*c, (*c)->start, &p, err);
  if (status) return status;
  const double turn = atan2(2 * skew, cag_dot(x, x) - cag_dot(y, y)) / 2, cosine = cos(turn),
               sine = sin(turn), w = x.x * y.y - x.y * y.x;
  const CagVec3 major = cag_add(cag_scaled(x, cosine), cag_scaled(y, sine)),
                minor = cag_sub(cag_scaled(y, cosine), cag_scaled(x, sine)),
                from = cag_sub(p, center);
  double start = atan2(x.x * from.y - x.y * from.x, from.x * y.y - from.y * y.x);
  if (w < 0) start = atan2(-(x.x * from.y - x.y * from.x), -(from.x * y.y - from.y * y.x));
  start -= turn;
  start -= 2 * M_PI * floor(start / (2 * M_PI));
  a = cag_norm(major);
  b = cag_norm(minor);
  frame.m[0][0] = major.x / a, frame.m[1][0] = major.y / a;
  frame.m[0][1] = minor.x / b, frame.m[1][1] = minor.y / b;
  frame.m[0][3] = center.x, frame.m[1][3] = center.y;
  frame.planar = true;
  CagCurve *made;
  status = cag_curve_arc(a, b, start, start + (*c)->end - (*c)->start, &frame, &made, err);
  if (status) return status;
  cag_curve_release(*c);
  *c = made;
  return CAG_OK;
}

static CagStatus add_curve(const CagDrawnLine *l, double a, double b, CagCurveList *out,
                           CagError *err) {
  CagCurve *part = NULL;
  CagStatus status = CAG_OK;
  if (a == l->flat->start && b == l->flat->end) part = cag_curve_retain(l->flat);
  else status = cag_curve_trim(l->flat, a, b, &part, err);
  if (status) return status;
  status = turn_axes(&part, err);
  if (!status) return cag_curve_list_add(out, part, err);
  cag_curve_release(part);
  return status;
}

static bool continues(const Piece *p, const Piece *q) {
  return !p->dropped && !q->dropped && p->visible == q->visible && p->b == q->a;
}

// Adds the pieces of a line, joined as far as they continue each other, also over the seam of a
// closed curve.
static CagStatus add_line_pieces(const View *v, size_t line, CagCurveList *visible,
                                 CagCurveList *hidden, CagError *err) {
  const CagDrawnLine *l = &v->drawing.items[line];
  size_t i = v->first[line], end = v->first[line + 1];
  double wrap = 0;
  CagStatus status = CAG_OK;
  if (end - i > 1 && l->flat->closed) {
    const Piece *p = &v->pieces[i], *q = &v->pieces[end - 1];
    size_t n = 1;
    while (i + n < end && continues(&v->pieces[i + n - 1], &v->pieces[i + n])) n++;
    if (i + n < end && !p->dropped && !q->dropped && p->visible == q->visible) {
      wrap = v->pieces[i + n - 1].b - l->flat->start;
      i += n;
    }
  }
  while (!status && i < end) {
    const Piece *p = &v->pieces[i];
    double b = p->b;
    while (++i < end && continues(&v->pieces[i - 1], &v->pieces[i])) b = v->pieces[i].b;
    if (i == end) b += wrap;
    if (!p->dropped) status = add_curve(l, p->a, b, p->visible ? visible : hidden, err);
  }
  return status;
}

// --- The drawing ---

static CagStatus body_bounds(const CagViewBody *b, CagBounds *out, CagError *err) {
  if (b->solid) return cag_solid_bounds(b->solid, out, err);
  if (b->surface) return cag_surface_bounds(b->surface, out, err);
  if (b->curve) return cag_curve_bounds(b->curve, out, err);
  *out = cag_mesh_bounds(b->mesh);
  return CAG_OK;
}

static CagStatus collect(const CagViewBody *bodies, size_t n, CagViewLines *out, CagError *err) {
  CagBounds all = CAG_BOUNDS_EMPTY;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < n; i++) {
    CagBounds box = CAG_BOUNDS_EMPTY;
    status = body_bounds(&bodies[i], &box, err);
    if (status || box.min.x > box.max.x) continue;
    cag_bounds_add(&all, box.min);
    cag_bounds_add(&all, box.max);
  }
  out->size = cag_norm(cag_sub(all.max, all.min));
  for (size_t i = 0; !status && i < n; i++) status = cag_view_lines_of(out, &bodies[i], i, err);
  return status;
}

static CagVec3 frame_axis(const CagTransform *t, int k) {
  return cag_vec3(t->m[0][k], t->m[1][k], t->m[2][k]);
}

CagStatus cag_hidden_lines(const CagViewBody *bodies, size_t n, const CagTransform *frame,
                           CagCurveList *visible, CagCurveList *hidden, CagError *err) {
  View v = {.eye = frame_axis(frame, 2), .x = frame_axis(frame, 0), .y = frame_axis(frame, 1)};
  CagViewLines lines = {.direction = v.eye};
  if (n == 0) return CAG_OK;
  CagStatus status = collect(bodies, n, &lines, err);
  if (!status) status = cag_drawing_of(&lines, bodies, frame, &v.drawing, err);
  if (!status) status = open_covers(&v, bodies, n, err);
  if (!status) status = look_at_lines(&v, err);
  if (!status) status = drop_covered(&v, true, err);
  if (!status) status = drop_covered(&v, false, err);
  for (size_t i = 0; !status && i < v.drawing.count; i++)
    status = add_line_pieces(&v, i, visible, hidden, err);
  view_free(&v);
  cag_view_lines_free(&lines);
  return status;
}
