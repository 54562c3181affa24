#include "geom/letter/lettering.h"

#include <math.h>
#include <stdio.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/region_unite.h"
#include "geom/letter/outline.h"

typedef struct Layout {
  const CagLettering *how;
  double scale;    // millimeters per unit of the font
  double distance; // between baselines, in millimeters
  CagLetters letters;
  CagBounds box; // of all glyphs, in millimeters, before the vertical alignment
  CagVec3 shift; // aligns all lines together
} Layout;

static bool is_vertical(const Layout *l) { return l->how->direction == CAG_LETTER_TTB; }

static bool has_ink(const CagBounds *box) { return box->min.x <= box->max.x; }

// --- Alignment ---

// The start of line `k`.
static CagVec3 line_start(const Layout *l, size_t k) {
  static const double along[] = {0, 0.5, 1}, down[] = {0, 0, 0.5, 1};
  const double across = -(double)k * l->distance, advance = l->letters.lines[k].advance * l->scale;
  if (is_vertical(l)) return cag_vec3(across, down[l->how->valign] * advance, 0);
  return cag_vec3(l->how->along ? 0 : -along[l->how->align] * advance, across, 0);
}

static CagVec3 letter_origin(const Layout *l, size_t line, const CagLetter *letter) {
  return cag_madd(line_start(l, line), l->scale, cag_vec3(letter->x, letter->y, 0));
}

// Adds the boxes of a line.
static CagStatus cover_line(Layout *l, size_t k, CagError *err) {
  const CagLetterLine *line = &l->letters.lines[k];
  CagStatus status = CAG_OK;
  for (size_t i = line->first; !status && i < line->first + line->count; i++) {
    const CagLetter *letter = &l->letters.items[i];
    const CagVec3 at = letter_origin(l, k, letter);
    CagBounds ink;
    status = cag_font_glyph_box(l->how->font, letter->glyph, &ink, err);
    if (status || !has_ink(&ink)) continue;
    cag_bounds_add(&l->box, cag_madd(at, l->scale, ink.min));
    cag_bounds_add(&l->box, cag_madd(at, l->scale, ink.max));
  }
  return status;
}

static CagStatus find_box(Layout *l, CagError *err) {
  CagStatus status = CAG_OK;
  l->box = CAG_BOUNDS_EMPTY;
  for (size_t k = 0; !status && k < l->letters.line_count; k++) status = cover_line(l, k, err);
  return status;
}

static CagVec3 shift_of(const Layout *l) {
  const CagBounds *box = &l->box;
  const double middle = (box->min.y + box->max.y) / 2, center = (box->min.x + box->max.x) / 2;
  const double up[] = {0, -box->max.y, -middle, -box->min.y};
  const double right[] = {-box->min.x, -center, -box->max.x};
  if (!has_ink(box)) return cag_vec3(0, 0, 0);
  return is_vertical(l) ? cag_vec3(right[l->how->align], 0, 0) : cag_vec3(0, up[l->how->valign], 0);
}

static void layout_free(Layout *l) { cag_letters_free(&l->letters); }

// Coordinates of at most this size can be multiplied by each other.
#define SIZE_LEAST 1e-50
#define SIZE_MOST 1e50
#define FACTOR_MOST 1e30

static CagStatus check_range(double x, double least, double most, const char *name, CagError *err) {
  if (x >= least && x <= most) return CAG_OK;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_size_out_of_range, name, -1,
                  "`%s` must be between %g and %g, found %g", name, least, most, x);
}

static CagStatus check_sizes(const CagLettering *how, CagError *err) {
  CagStatus status = check_range(how->size, SIZE_LEAST, SIZE_MOST, "size", err);
  if (!status) status = check_range(how->spacing, 0, FACTOR_MOST, "spacing", err);
  if (!status) status = check_range(how->line_spacing, 0, FACTOR_MOST, "line_spacing", err);
  return status;
}

static CagStatus layout_new(const char *text, size_t n, const CagLettering *how, Layout *l,
                            CagError *err) {
  const CagFont *f = how->font;
  *l = (Layout){.how = how, .scale = how->size / f->capital};
  l->distance = how->line_spacing * (f->ascender + f->descender + f->gap) * l->scale;
  const CagLetterRules rules = {how->direction, how->spacing, how->width / l->scale, how->missing};
  CagStatus status = check_sizes(how, err);
  if (!status) status = cag_letters_shape(f, text, n, &rules, &l->letters, err);
  if (status) return status;
  status = find_box(l, err);
  if (!status) l->shift = shift_of(l);
  if (status) layout_free(l);
  return status;
}

CagStatus cag_lettering_measure(const char *text, size_t n, const CagLettering *how,
                                CagLetteringMetrics *out, CagError *err) {
  Layout l;
  CagStatus status = layout_new(text, n, how, &l, err);
  if (status) return status;
  const double last = line_start(&l, l.letters.line_count - 1).y;
  *out = (CagLetteringMetrics){.box = l.box, .lines = l.letters.line_count};
  if (has_ink(&l.box)) {
    out->box.min = cag_add(l.box.min, l.shift);
    out->box.max = cag_add(l.box.max, l.shift);
    out->ascent = l.box.max.y;
    out->descent = (is_vertical(&l) ? 0 : last) - l.box.min.y;
  }
  for (size_t k = 0; k < l.letters.line_count; k++)
    out->advance = fmax(out->advance, l.letters.lines[k].advance * l.scale);
  layout_free(&l);
  return CAG_OK;
}

// --- Along a curve ---

static CagStatus line_on_curve(const Layout *l, size_t k, double length, double *start,
                               CagError *err) {
  const double advance = l->letters.lines[k].advance * l->scale;
  if (advance > length * (1 + 1e-9)) {
    (cag_fail)(err, CAG_E_ARGUMENT, CAG_ERR_lettering_too_long, "along", -1,
               "the text is %.6g mm long, and the curve is %.6g mm long", advance, length);
    snprintf(err->help, sizeof err->help,
             "choose a smaller size or spacing, or break lines with `width`");
    return cag_never_ok(err->status);
  }
  static const double parts[] = {0, 0.5, 1};
  *start = parts[l->how->align] * (length - advance);
  return CAG_OK;
}

// The frame whose origin is at the arc length s, with x along the curve.
static CagStatus frame_on_curve(const CagCurve *c, double s, double length, CagTransform *out,
                                CagError *err) {
  double t;
  CagVec3 at, along;
  CagStatus status = cag_curve_parameter_at_length(c, fmin(fmax(s, 0), length), &t, err);
  if (!status) status = cag_curve_point(c, t, &at, err);
  if (!status)
    status = cag_curve_tangent(c, t, t < c->end ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT, &along, err);
  if (status) return status;
  const CagVec3 x = cag_unit(along);
  *out = cag_translate(at);
  out->m[0][0] = x.x, out->m[0][1] = -x.y;
  out->m[1][0] = x.y, out->m[1][1] = x.x;
  out->planar = true;
  return CAG_OK;
}

// --- The region ---

// The map from units of the font, with the origin of a glyph at `to`.
static CagTransform map_to(const Layout *l, CagVec3 to) {
  CagTransform t = cag_translate(cag_vec3(to.x, to.y, 0));
  for (int i = 0; i < 3; i++) t.m[i][i] = l->scale;
  t.planar = true;
  return t;
}

// The place of a letter: its line starts at the arc length `start` of the curve.
static CagStatus letter_place(const Layout *l, size_t k, const CagLetter *letter, double start,
                              double length, CagTransform *out, CagError *err) {
  const CagVec3 origin = cag_add(letter_origin(l, k, letter), l->shift);
  *out = map_to(l, origin);
  if (!l->how->along) return CAG_OK;
  const double middle = letter->middle * l->scale;
  CagTransform frame;
  CagStatus status = frame_on_curve(l->how->along, start + middle, length, &frame, err);
  if (status) return status;
  const CagTransform local = map_to(l, cag_sub(origin, cag_vec3(middle, 0, 0)));
  *out = cag_transform_multiply(&frame, &local);
  return CAG_OK;
}

// The placed regions of the letters with ink; *count is how many there are, also if it fails.
static CagStatus place_letters(Layout *l, CagRegion **regions, size_t *count, CagError *err) {
  double length = 0, start = 0;
  CagStatus status = CAG_OK;
  *count = 0;
  if (l->how->along)
    status =
        cag_curve_length(l->how->along, l->how->along->start, l->how->along->end, &length, err);
  for (size_t k = 0; !status && k < l->letters.line_count; k++) {
    const CagLetterLine *line = &l->letters.lines[k];
    if (l->how->along) status = line_on_curve(l, k, length, &start, err);
    for (size_t i = line->first; !status && i < line->first + line->count; i++) {
      const CagLetter *letter = &l->letters.items[i];
      const CagRegion *region;
      CagTransform place;
      status = cag_stop_check(err);
      if (!status) status = cag_font_glyph_region(l->how->font, letter->glyph, &region, err);
      if (!status && cag_region_is_empty(region)) continue;
      if (!status) status = letter_place(l, k, letter, start, length, &place, err);
      if (!status) status = cag_region_transform(region, &place, &regions[*count], err);
      if (!status) ++*count;
    }
  }
  return status;
}

CagStatus cag_lettering(const char *text, size_t n, const CagLettering *how, CagRegion **out,
                        CagError *err) {
  Layout l;
  size_t count = 0;
  CagStatus status = layout_new(text, n, how, &l, err);
  if (status) return status;
  const size_t room = l.letters.count ? l.letters.count : 1;
  CagRegion **regions = cag_malloc(room * sizeof *regions);
  if (!regions) status = cag_fail_memory(err);
  else status = place_letters(&l, regions, &count, err);
  if (!status) status = cag_regions_unite_few(regions, count, out, err);
  for (size_t i = 0; i < count; i++) cag_region_release(regions[i]);
  cag_free(regions);
  layout_free(&l);
  return status;
}
