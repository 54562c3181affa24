#include "geom/letter/outline.h"

#include <math.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/region_fill.h"

enum { CUBIC = 3 };

// The outlines of a glyph in units of the font. Segment i has degrees[i] points after the last one
// of the segment before; a contour begins with a point of its own.
typedef struct Contour {
  size_t point, segment, segments;
} Contour;

typedef struct Outline {
  CagVec3 *points;
  unsigned char *degrees;
  Contour *contours;
  size_t point_count, point_capacity, segment_count, segment_capacity, count, capacity;
  bool out_of_memory;
} Outline;

// --- Reading ---

static void add_point(Outline *o, double x, double y) {
  if (!CAG_RESERVE(o->points, o->point_capacity, o->point_count + 1)) o->out_of_memory = true;
  else o->points[o->point_count++] = cag_vec3(x, y, 0);
}

static CagVec3 last_point(const Outline *o) { return o->points[o->point_count - 1]; }

static bool same(CagVec3 p, CagVec3 q) { return p.x == q.x && p.y == q.y; }

static bool is_between(CagVec3 p, CagVec3 a, CagVec3 b) {
  const CagVec3 u = cag_sub(p, a), v = cag_sub(b, p);
  return u.x * v.y == u.y * v.x && cag_dot(u, v) >= 0;
}

// Adds a segment from the last point; one that stays at it or on a line is not a curve.
static void add_segment(Outline *o, const CagVec3 *p, int degree) {
  if (o->out_of_memory || o->count == 0) return;
  const CagVec3 from = last_point(o), to = p[degree - 1];
  bool straight = true;
  for (int i = 0; i < degree - 1; i++) straight &= is_between(p[i], i ? p[i - 1] : from, to);
  if (straight && same(from, to)) return;
  if (straight) degree = 1;
  if (!CAG_RESERVE(o->degrees, o->segment_capacity, o->segment_count + 1)) o->out_of_memory = true;
  else o->degrees[o->segment_count++] = (unsigned char)degree;
  o->contours[o->count - 1].segments++;
  if (straight) add_point(o, to.x, to.y);
  else
    for (int i = 0; i < degree; i++) add_point(o, p[i].x, p[i].y);
}

static void draw_move(hb_draw_funcs_t *functions, void *data, hb_draw_state_t *state, float x,
                      float y, void *user) {
  Outline *o = data;
  (void)functions, (void)state, (void)user;
  if (o->out_of_memory) return;
  if (!CAG_RESERVE(o->contours, o->capacity, o->count + 1)) {
    o->out_of_memory = true;
    return;
  }
  o->contours[o->count++] = (Contour){o->point_count, o->segment_count, 0};
  add_point(o, x, y);
}

static void draw_line(hb_draw_funcs_t *functions, void *data, hb_draw_state_t *state, float x,
                      float y, void *user) {
  (void)functions, (void)state, (void)user;
  const CagVec3 p[] = {{x, y, 0}};
  add_segment(data, p, 1);
}

static void draw_quadratic(hb_draw_funcs_t *functions, void *data, hb_draw_state_t *state, float x1,
                           float y1, float x, float y, void *user) {
  (void)functions, (void)state, (void)user;
  const CagVec3 p[] = {{x1, y1, 0}, {x, y, 0}};
  add_segment(data, p, 2);
}

static void draw_cubic(hb_draw_funcs_t *functions, void *data, hb_draw_state_t *state, float x1,
                       float y1, float x2, float y2, float x, float y, void *user) {
  (void)functions, (void)state, (void)user;
  const CagVec3 p[] = {{x1, y1, 0}, {x2, y2, 0}, {x, y, 0}};
  add_segment(data, p, CUBIC);
}

static void draw_close(hb_draw_funcs_t *functions, void *data, hb_draw_state_t *state, void *user) {
  Outline *o = data;
  (void)functions, (void)state, (void)user;
  if (o->out_of_memory || o->count == 0) return;
  add_segment(o, &o->points[o->contours[o->count - 1].point], 1);
}

static void outline_free(Outline *o) {
  cag_free(o->points);
  cag_free(o->degrees);
  cag_free(o->contours);
}

static CagStatus outline_read(const CagFont *f, uint32_t glyph, Outline *out, CagError *err) {
  *out = (Outline){.points = NULL};
  hb_draw_funcs_t *functions = cag_hb.draw_funcs_create();
  cag_hb.draw_funcs_set_move_to_func(functions, draw_move, NULL, NULL);
  cag_hb.draw_funcs_set_line_to_func(functions, draw_line, NULL, NULL);
  cag_hb.draw_funcs_set_quadratic_to_func(functions, draw_quadratic, NULL, NULL);
  cag_hb.draw_funcs_set_cubic_to_func(functions, draw_cubic, NULL, NULL);
  cag_hb.draw_funcs_set_close_path_func(functions, draw_close, NULL, NULL);
  cag_hb.font_get_glyph_shape(f->hb, glyph, functions, out);
  cag_hb.draw_funcs_destroy(functions);
  CagStatus status = out->out_of_memory ? cag_fail_memory(err) : cag_stop_check(err);
  for (size_t i = 0; !status && i < out->point_count; i++)
    if (!isfinite(out->points[i].x) || !isfinite(out->points[i].y))
      status = cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_font_unreadable, "font", -1,
                        "the font \"%s\" cannot be used: glyph %u is damaged", f->name, glyph);
  if (status) outline_free(out);
  return status;
}

// --- Bounds ---

// Adds the point at t of a Bezier curve, if t is inside of 0..1.
static void cover_inner(CagBounds *box, const CagVec3 *p, int degree, double t) {
  if (!(t > 0 && t < 1)) return;
  CagVec3 q[CUBIC + 1];
  for (int i = 0; i <= degree; i++) q[i] = p[i];
  for (int n = degree; n > 0; n--)
    for (int i = 0; i < n; i++) q[i] = cag_add(cag_scaled(q[i], 1 - t), cag_scaled(q[i + 1], t));
  cag_bounds_add(box, q[0]);
}

// Adds the points at which a coordinate, given by its Bezier coefficients, is extreme.
static void cover_extremes(CagBounds *box, const CagVec3 *p, int degree, const double *c) {
  if (degree == 2) {
    cover_inner(box, p, degree, (c[0] - c[1]) / (c[0] - 2 * c[1] + c[2]));
    return;
  }
  // The derivative, divided by the degree: u (1 - t)^2 + 2 v t (1 - t) + w t^2.
  const double u = c[1] - c[0], v = c[2] - c[1], w = c[3] - c[2];
  const double root = sqrt(fmax(0, v * v - u * w)), q = u - v + (u - v < 0 ? -root : root);
  cover_inner(box, p, degree, q / (u - 2 * v + w));
  cover_inner(box, p, degree, u / q);
}

static void cover_segment(CagBounds *box, const CagVec3 *p, int degree) {
  double x[CUBIC + 1], y[CUBIC + 1];
  cag_bounds_add(box, p[0]);
  cag_bounds_add(box, p[degree]);
  if (degree == 1) return;
  for (int i = 0; i <= degree; i++) {
    x[i] = p[i].x;
    y[i] = p[i].y;
  }
  cover_extremes(box, p, degree, x);
  cover_extremes(box, p, degree, y);
}

CagStatus cag_glyph_bounds(const CagFont *f, uint32_t glyph, CagBounds *box, CagError *err) {
  Outline o;
  CagStatus status = outline_read(f, glyph, &o, err);
  if (status) return status;
  for (size_t i = 0; i < o.count; i++) {
    const CagVec3 *p = &o.points[o.contours[i].point];
    for (size_t k = 0; k < o.contours[i].segments; k++) {
      const int degree = o.degrees[o.contours[i].segment + k];
      cover_segment(box, p, degree);
      p += degree;
    }
  }
  outline_free(&o);
  return CAG_OK;
}

// --- Curves ---

// Successive lines are one polyline.
static size_t line_run(const unsigned char *degrees, size_t n) {
  size_t run = 0;
  while (run < n && degrees[run] == 1) run++;
  return run;
}

// The pieces of a contour; *count is how many there are, also if it fails.
static CagStatus make_pieces(const Outline *o, const Contour *c, CagCurve **pieces, size_t *count,
                             CagError *err) {
  const unsigned char *degrees = o->degrees + c->segment;
  const CagVec3 *p = o->points + c->point;
  CagStatus status = CAG_OK;
  *count = 0;
  for (size_t i = 0; !status && i < c->segments;) {
    const size_t run = line_run(degrees + i, c->segments - i);
    const size_t steps = run ? run : degrees[i];
    if (run) status = cag_curve_polyline(p, run + 1, false, 2, &pieces[*count], err);
    else status = cag_curve_bezier(p, NULL, steps + 1, 2, &pieces[*count], err);
    if (!status) ++*count;
    p += steps;
    i += run ? run : 1;
  }
  return status;
}

static CagStatus make_loop(const Outline *o, const Contour *c, CagCurve **out, CagError *err) {
  const unsigned char *degrees = o->degrees + c->segment;
  if (line_run(degrees, c->segments) == c->segments)
    return cag_curve_polyline(o->points + c->point, c->segments, true, 2, out, err);
  CagCurve **pieces = cag_malloc(c->segments * sizeof *pieces);
  if (!pieces) return cag_fail_memory(err);
  size_t n;
  CagStatus status = make_pieces(o, c, pieces, &n, err);
  if (!status) status = cag_curve_join(pieces, n, out, err);
  for (size_t i = 0; i < n; i++) cag_curve_release(pieces[i]);
  cag_free(pieces);
  return status;
}

// Points and lines have no inside.
static bool has_inside(const Outline *o, const Contour *c) {
  return c->segments > 2 ||
         (c->segments == 2 && o->degrees[c->segment] + o->degrees[c->segment + 1] > 2) ||
         (c->segments == 1 && o->degrees[c->segment] == CUBIC);
}

static void release_loops(CagCurve **loops, size_t n) {
  for (size_t i = 0; i < n; i++) cag_curve_release(loops[i]);
  cag_free(loops);
}

CagStatus cag_glyph_loops(const CagFont *f, uint32_t glyph, double scale, CagCurve ***loops,
                          size_t *count, CagError *err) {
  Outline o;
  size_t n = 0;
  CagStatus status = outline_read(f, glyph, &o, err);
  if (status) return status;
  for (size_t i = 0; i < o.point_count; i++) o.points[i] = cag_scaled(o.points[i], scale);
  CagCurve **found = cag_malloc((o.count ? o.count : 1) * sizeof *found);
  if (!found) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i < o.count; i++) {
    if (!has_inside(&o, &o.contours[i])) continue;
    status = make_loop(&o, &o.contours[i], &found[n], err);
    if (!status) n++;
  }
  outline_free(&o);
  if (status) {
    release_loops(found, n);
    return status;
  }
  *loops = found;
  *count = n;
  return CAG_OK;
}

CagStatus cag_glyph_region(const CagFont *f, uint32_t glyph, double scale, CagRegion **out,
                           CagError *err) {
  CagCurve **loops;
  size_t n;
  CagStatus status = cag_glyph_loops(f, glyph, scale, &loops, &n, err);
  if (status) return status;
  status = cag_region_fill((const CagCurve *const *)loops, n, CAG_FILL_NONZERO, out, err);
  release_loops(loops, n);
  return status;
}

// --- Glyphs that the font keeps ---

static CagGlyph *find_glyph(const CagFont *f, uint32_t number) {
  size_t i;
  CagHashWalk w = cag_hash_walk(&f->glyph_index, cag_hash_word(CAG_HASH_START, number));
  while (cag_hash_next(&w, &i))
    if (f->glyphs[i].number == number) return &f->glyphs[i];
  return NULL;
}

static CagStatus keep_glyph(CagFont *f, uint32_t number, CagGlyph **out, CagError *err) {
  CagGlyph glyph = {.number = number, .box = CAG_BOUNDS_EMPTY};
  if ((*out = find_glyph(f, number))) return CAG_OK;
  CagStatus status = cag_glyph_bounds(f, number, &glyph.box, err);
  if (status) return status;
  if (!CAG_RESERVE(f->glyphs, f->glyph_capacity, f->glyph_count + 1) ||
      !cag_hash_add(&f->glyph_index, cag_hash_word(CAG_HASH_START, number), f->glyph_count))
    return cag_fail_memory(err);
  f->glyphs[f->glyph_count] = glyph;
  *out = &f->glyphs[f->glyph_count++];
  return CAG_OK;
}

CagStatus cag_font_glyph_box(CagFont *f, uint32_t glyph, CagBounds *out, CagError *err) {
  CagGlyph *kept;
  CagStatus status = keep_glyph(f, glyph, &kept, err);
  if (!status) *out = kept->box;
  return status;
}

CagStatus cag_font_glyph_region(CagFont *f, uint32_t glyph, const CagRegion **out, CagError *err) {
  CagGlyph *kept;
  CagStatus status = keep_glyph(f, glyph, &kept, err);
  if (!status && !kept->region) status = cag_glyph_region(f, glyph, 1, &kept->region, err);
  if (!status) *out = kept->region;
  return status;
}
