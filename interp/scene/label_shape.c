#include "interp/scene/label_shape.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/utf8.h"
#include "geom/curve/region_stroke.h"
#include "geom/curve/region_unite.h"
#include "geom/letter/lettering.h"

// The radius of a mark, the space between mark and text, and so on, in heights of the text. The page
// has the same numbers (web/src/page.css).
#define MARK_RADIUS 0.24
#define GAP 0.36
#define MARK_STROKE 0.1
#define ARROW_LENGTH 0.9
#define ARROW_WIDTH 0.55
#define ARROW_NOTCH 0.25 // of its length
// A text at a corner may be closer to its mark, which is round.
#define CORNER_GAP 0.7
// A subscript: its size, and how far it is lowered.
#define INDEX_SIZE 0.7
#define INDEX_DROP 0.22

#define FULL_TURN 6.283185307179586476925
#define STROKE_TOLERANCE 1e-3 // of the height of the text

// --- Marks ---

static CagStatus region_of(CagCurve **loops, size_t n, CagRegion **out, CagError *err) {
  CagStatus status = cag_region_from_loops(loops, n, out, err);
  for (size_t i = 0; i < n; i++) cag_curve_release(loops[i]);
  return status;
}

static CagStatus make_circle(CagVec3 center, double radius, CagCurve **out, CagError *err) {
  CagTransform frame = cag_translate(center);
  frame.planar = true;
  return cag_curve_arc(radius, radius, 0, FULL_TURN, &frame, out, err);
}

static CagStatus make_disc(CagVec3 p, double radius, CagRegion **out, CagError *err) {
  CagCurve *circle;
  CagStatus status = make_circle(p, radius, &circle, err);
  return status ? status : region_of(&circle, 1, out, err);
}

static CagStatus make_ring(CagVec3 p, double radius, double width, CagRegion **out, CagError *err) {
  CagCurve *circles[2];
  CagStatus status = make_circle(p, radius + width / 2, &circles[0], err);
  if (status) return status;
  status = make_circle(p, radius - width / 2, &circles[1], err);
  if (!status) return region_of(circles, 2, out, err);
  cag_curve_release(circles[0]);
  return status;
}

static CagStatus make_cross(CagVec3 p, double radius, double width, CagRegion **out,
                            CagError *err) {
  const CagStroke stroke = {.width = width,
                            .tolerance = STROKE_TOLERANCE * radius,
                            .cap = CAG_CAP_ROUND,
                            .joins = {CAG_JOIN_ROUND, 2}};
  CagCurve *lines[2] = {NULL, NULL};
  CagStatus status = CAG_OK;
  for (int i = 0; !status && i < 2; i++) {
    const CagVec3 d = {radius, i ? -radius : radius, 0};
    status = cag_curve_line(cag_sub(p, d), cag_add(p, d), 2, &lines[i], err);
  }
  if (!status) status = cag_region_stroke((const CagCurve *const *)lines, 2, &stroke, out, err);
  for (int i = 0; i < 2; i++) cag_curve_release(lines[i]);
  return status;
}

// A slender head with a notched back and its tip at p.
static CagStatus make_arrow(CagVec3 p, CagVec3 along, double size, CagRegion **out, CagError *err) {
  const CagVec3 a = cag_unit(along), across = cag_vec3(-a.y, a.x, 0);
  const double length = ARROW_LENGTH * size, half = ARROW_WIDTH / 2 * size;
  const CagVec3 back = cag_madd(p, -length, a);
  const CagVec3 corners[] = {p, cag_madd(back, half, across),
                             cag_madd(back, ARROW_NOTCH * length, a),
                             cag_madd(back, -half, across)};
  CagCurve *loop;
  CagStatus status =
      cag_curve_polyline(corners, sizeof corners / sizeof *corners, true, 2, &loop, err);
  return status ? status : region_of(&loop, 1, out, err);
}

static void cover(CagBounds *box, CagVec3 p, double radius) {
  cag_bounds_add(box, cag_sub(p, cag_vec3(radius, radius, 0)));
  cag_bounds_add(box, cag_add(p, cag_vec3(radius, radius, 0)));
}

static CagStatus make_mark(CagLabelMark mark, CagVec3 at, CagVec3 along, double size,
                           CagLabelShape *out, CagError *err) {
  const double radius = MARK_RADIUS * size, width = MARK_STROKE * size;
  CagStatus status = CAG_OK;
  switch (mark) {
  case CAG_LABEL_NONE: return CAG_OK;
  case CAG_LABEL_DOT: status = make_disc(at, radius, &out->mark, err); break;
  case CAG_LABEL_CIRCLE:
    status = make_disc(at, radius, &out->paper, err);
    if (!status) status = make_ring(at, radius, width, &out->mark, err);
    break;
  case CAG_LABEL_CROSS: status = make_cross(at, radius, width, &out->mark, err); break;
  case CAG_LABEL_ARROW:
    if (cag_norm(along) > 0)
      status = make_arrow(at, along, size, &out->mark, err); // else seen end-on
    break;
  }
  cover(&out->box, at, (MARK_RADIUS + MARK_STROKE) * size);
  return status;
}

// --- Texts ---

// Tests whether the first code point is a letter that is not followed by a letter.
static bool is_name(const char *text) {
  const unsigned char *c = (const unsigned char *)text;
  if (!isalpha(*c) && *c < 0x80) return false;
  return !isalpha(c[cag_utf8_next(text, strlen(text), 0)]);
}

static size_t index_length(const char *text) {
  size_t n = 0;
  while (isalnum((unsigned char)text[n]) || (unsigned char)text[n] >= 0x80) n++;
  return n;
}

typedef struct Pen {
  CagFont *font;
  double size, x;   // the height of the text, and how far it goes so far
  CagRegion **runs; // on the baseline, from x = 0 on
  size_t count, capacity;
} Pen;

static CagStatus add_run(Pen *pen, CagRegion *r, CagError *err) {
  if (!CAG_RESERVE(pen->runs, pen->capacity, pen->count + 1)) {
    cag_region_release(r);
    return cag_fail_memory(err);
  }
  pen->runs[pen->count++] = r;
  return CAG_OK;
}

static CagStatus put_run(Pen *pen, const char *text, size_t n, bool lowered, CagError *err) {
  const double em = (lowered ? INDEX_SIZE : 1) * pen->size;
  const CagLettering how = {.font = pen->font,
                            .size = em * pen->font->capital / pen->font->em,
                            .spacing = 1,
                            .line_spacing = 1,
                            .direction = CAG_LETTER_AUTO,
                            .missing = true};
  CagLetteringMetrics m;
  CagRegion *r, *placed;
  CagTransform place = cag_translate(cag_vec3(pen->x, lowered ? -INDEX_DROP * pen->size : 0, 0));
  place.planar = true;
  CagStatus status = cag_lettering_measure(text, n, &how, &m, err);
  if (!status) status = cag_lettering(text, n, &how, &r, err);
  if (status) return status;
  pen->x += m.advance;
  status = cag_region_transform(r, &place, &placed, err);
  cag_region_release(r);
  return status ? status : add_run(pen, placed, err);
}

static CagStatus put_runs(Pen *pen, const char *text, bool name, CagError *err) {
  CagStatus status = CAG_OK;
  while (!status && *text) {
    size_t n = name ? strcspn(text, "_") : strlen(text), m = 0;
    if (text[n] == '_') m = index_length(text + n + 1);
    if (text[n] == '_' && m == 0) n++;
    status = put_run(pen, text, n, false, err);
    text += n;
    if (status || m == 0) continue;
    status = put_run(pen, text + 1, m, true, err);
    text += m + 1;
  }
  return status;
}

// The frame of the text: its origin is at the start of the baseline.
static CagTransform text_frame(const CagLabel *l, const Pen *pen, CagVec3 at, CagVec3 along) {
  static const struct {
    int x, y;
  } steps[] = {
#define X(name, text, x, y) {x, y},
      CAG_LABEL_PLACES(X)
#undef X
  };
  const int sx = steps[l->place].x, sy = steps[l->place].y;
  const double size = pen->size, capital = size * pen->font->capital / pen->font->em;
  const double gap = (GAP + (l->mark == CAG_LABEL_NONE ? 0 : MARK_RADIUS)) * size;
  const double near = sx && sy ? CORNER_GAP : 1;
  const bool turned = l->mark != CAG_LABEL_ARROW && cag_norm(along) > 0;
  // A text that runs down or to the left would be upside down.
  CagVec3 x = turned ? cag_unit(along) : cag_vec3(1, 0, 0);
  if (x.x < -1e-9 || (fabs(x.x) <= 1e-9 && x.y < 0)) x = cag_scaled(x, -1);
  const CagVec3 y = cag_vec3(-x.y, x.x, 0);
  const CagVec3 from = cag_madd(cag_madd(at, sx * gap * near + (sx - 1) / 2.0 * pen->x, x),
                                sy * gap * near - (1 - sy) / 2.0 * capital, y);
  CagTransform frame = cag_translate(from);
  frame.m[0][0] = x.x, frame.m[0][1] = y.x;
  frame.m[1][0] = x.y, frame.m[1][1] = y.y;
  frame.planar = true;
  return frame;
}

static CagStatus place_text(const CagLabel *l, const Pen *pen, CagVec3 at, CagVec3 along,
                            CagLabelShape *out, CagError *err) {
  const CagTransform frame = text_frame(l, pen, at, along);
  const double top = pen->size * pen->font->capital / pen->font->em,
               bottom = -INDEX_DROP * pen->size;
  for (int i = 0; i < 4; i++)
    cag_bounds_add(&out->box, cag_transform_point(
                                  &frame, cag_vec3(i & 1 ? pen->x : 0, i & 2 ? top : bottom, 0)));
  CagRegion *whole;
  CagStatus status = cag_regions_unite_few(pen->runs, pen->count, &whole, err);
  if (status) return status;
  status = cag_region_transform(whole, &frame, &out->text, err);
  cag_region_release(whole);
  return status;
}

static CagStatus make_text(CagLabelFonts *fonts, const CagLabel *l, CagVec3 at, CagVec3 along,
                           double size, CagLabelShape *out, CagError *err) {
  const bool name = is_name(l->text);
  Pen pen = {.font = name ? &fonts->slanted : &fonts->upright, .size = size};
  CagStatus status = CAG_OK;
  if (!*l->text) return CAG_OK;
  if (!pen.font->hb)
    status = cag_font_compiled_in(name ? CAG_FONT_ITALIC : CAG_FONT_REGULAR, pen.font, err);
  if (status) return status;
  status = put_runs(&pen, l->text, name, err);
  if (!status) status = place_text(l, &pen, at, along, out, err);
  for (size_t i = 0; i < pen.count; i++) cag_region_release(pen.runs[i]);
  cag_free(pen.runs);
  return status;
}

// --- Labels ---

void cag_label_fonts_free(CagLabelFonts *fonts) {
  cag_font_free(&fonts->upright);
  cag_font_free(&fonts->slanted);
}

CagStatus cag_label_shape(CagLabelFonts *fonts, const CagLabel *l, CagVec3 at, CagVec3 along,
                          double size, CagLabelShape *out, CagError *err) {
  *out = (CagLabelShape){.box = CAG_BOUNDS_EMPTY};
  cag_bounds_add(&out->box, at);
  CagStatus status = make_mark(l->mark, at, along, size, out, err);
  if (!status) status = make_text(fonts, l, at, along, size, out, err);
  if (status) cag_label_shape_free(out);
  return status;
}

void cag_label_shape_free(CagLabelShape *s) {
  cag_region_release(s->text);
  cag_region_release(s->mark);
  cag_region_release(s->paper);
  s->text = s->mark = s->paper = NULL;
}

CagStatus cag_label_shape_draw(const CagLabelShape *s, CagColor color, CagLabelDraw draw,
                               void *context, CagError *err) {
  const CagColor white = {1, 1, 1};
  const CagRegion *const regions[] = {s->paper, s->mark, s->text};
  CagStatus status = CAG_OK;
  for (int i = 0; !status && i < 3; i++)
    if (regions[i] && !cag_region_is_empty(regions[i]))
      status = draw(context, regions[i], i == 0 ? white : color, err);
  return status;
}

// The pixel of a point, with y up; false if it is behind the camera.
static bool project(const CagCamera *c, const CagCameraMap *map, CagVec3 p, CagVec3 *out) {
  double pixel[2], depth;
  if (!cag_camera_project(map, p, pixel, &depth)) return false;
  *out = cag_vec3(pixel[0], c->size[1] - pixel[1], 0);
  return true;
}

CagStatus cag_label_in_picture(CagLabelFonts *fonts, const CagLabel *l, const CagCamera *camera,
                               const CagCameraMap *map, CagLabelShape *out, CagError *err) {
  const CagTransform frame = cag_camera_frame(camera);
  const CagVec3 right = {frame.m[0][0], frame.m[1][0], frame.m[2][0]};
  CagVec3 at, beside, ahead, along = {0, 0, 0};
  *out = (CagLabelShape){.box = CAG_BOUNDS_EMPTY};
  if (!project(camera, map, l->at, &at)) return CAG_OK;
  // A direction is projected as a short step.
  const double step = 1e-3 * cag_norm(cag_sub(camera->target, camera->eye));
  if (l->directed && project(camera, map, cag_madd(l->at, step, cag_unit(l->along)), &ahead))
    along = cag_sub(ahead, at);
  double size = CAG_LABEL_PART * hypot(camera->size[0], camera->size[1]);
  if (l->size > 0 && project(camera, map, cag_madd(l->at, step, right), &beside))
    size = l->size * cag_norm(cag_sub(beside, at)) / step;
  return cag_label_shape(fonts, l, at, along, size, out, err);
}
