// Labels of an SVG drawing: a mark, and a text beside it.

#include "interp/formats/svg_label.h"
#include "base/utf8.h"

#include <ctype.h>
#include <string.h>

// The height of a text as a fraction of the picture's diagonal: 3.5 mm on a figure 130 mm wide.
#define TEXT_PART 0.024
// The radius of a mark, the space between mark and text, and so on, in heights of the text.
#define MARK_RADIUS 0.24
#define GAP 0.36
#define MARK_STROKE 0.1
#define ARROW_LENGTH 0.9
#define ARROW_WIDTH 0.55
// For common sans-serif fonts: the width of a letter and the height of capitals, in heights of the
// text.
#define LETTER 0.56
#define CAPITAL 0.72
// A subscript: its size, and how far it is lowered.
#define INDEX_SIZE 0.7
#define INDEX_DROP 0.22

#define DEGREES_PER_RADIAN 57.29577951308232

void cag_svg_escape(FILE *out, const char *text, size_t n) {
  for (const char *c = text; c < text + n; c++) {
    switch (*c) {
    case '&': fputs("&amp;", out); break;
    case '<': fputs("&lt;", out); break;
    case '>': fputs("&gt;", out); break;
    case '"': fputs("&quot;", out); break;
    default: fputc((unsigned char)*c < ' ' ? ' ' : *c, out);
    }
  }
}

// --- Numbers, rounded to a thousandth of a letter ---

// The location at which a label is written.
typedef struct Pen {
  FILE *file;
  bool undefined; // whether a number was not finite
} Pen;

static double rounded(Pen *out, double x, double size) {
  double unit = pow(10, floor(log10(size)) - 3), steps = round(x / unit);
  double y = unit < 1 ? steps / round(1 / unit) : steps * unit;
  out->undefined |= !isfinite(y);
  return y == 0 ? 0 : y;
}

static void attribute(Pen *out, const char *name, double x, double size) {
  char text[32];
  fprintf(out->file, " %s=\"%s\"", name, cag_number_text(rounded(out, x, size), text));
}

static void point(Pen *out, const char *command, CagVec3 p, double size) {
  char x[32], y[32];
  fprintf(out->file, "%s%s %s", command, cag_number_text(rounded(out, p.x, size), x),
          cag_number_text(rounded(out, -p.y, size), y));
}

// --- Marks ---

static void cover(CagBounds *box, CagVec3 p, double radius) {
  cag_bounds_add(box, cag_sub(p, cag_vec3(radius, radius, 0)));
  cag_bounds_add(box, cag_add(p, cag_vec3(radius, radius, 0)));
}

static void put_circle(Pen *out, CagVec3 p, double size, const char *color, bool filled) {
  fputs("  <circle", out->file);
  attribute(out, "cx", p.x, size);
  attribute(out, "cy", -p.y, size);
  attribute(out, "r", MARK_RADIUS * size, size);
  if (filled) fprintf(out->file, " fill=\"%s\" stroke=\"none\"/>\n", color);
  else {
    attribute(out, "stroke-width", MARK_STROKE * size, size);
    fprintf(out->file, " fill=\"#ffffff\" stroke=\"%s\"/>\n", color);
  }
}

static void put_cross(Pen *out, CagVec3 p, double size, const char *color) {
  const double r = MARK_RADIUS * size;
  fputs("  <path", out->file);
  attribute(out, "stroke-width", MARK_STROKE * size, size);
  fprintf(out->file, " stroke=\"%s\" d=\"", color);
  point(out, "M ", cag_add(p, cag_vec3(-r, -r, 0)), size);
  point(out, " L ", cag_add(p, cag_vec3(r, r, 0)), size);
  point(out, " M ", cag_add(p, cag_vec3(-r, r, 0)), size);
  point(out, " L ", cag_add(p, cag_vec3(r, -r, 0)), size);
  fputs("\"/>\n", out->file);
}

// Draws a slender head with a notched back and its tip at p.
static void put_arrow(Pen *out, CagVec3 p, CagVec3 along, double size, const char *color) {
  if (cag_norm(along) == 0) return; // seen end-on
  const CagVec3 a = cag_unit(along), across = cag_vec3(-a.y, a.x, 0);
  const CagVec3 back = cag_madd(p, -ARROW_LENGTH * size, a);
  const double half = ARROW_WIDTH / 2 * size, notch = 0.25 * ARROW_LENGTH * size;
  fprintf(out->file, "  <path fill=\"%s\" stroke=\"none\" d=\"", color);
  point(out, "M ", p, size);
  point(out, " L ", cag_madd(back, half, across), size);
  point(out, " L ", cag_madd(back, notch, a), size);
  point(out, " L ", cag_madd(back, -half, across), size);
  fputs(" Z\"/>\n", out->file);
}

static void put_mark(Pen *out, const CagLabel *l, CagVec3 at, CagVec3 along, const char *color,
                     double size, CagBounds *box) {
  switch (l->mark) {
  case CAG_LABEL_NONE: return;
  case CAG_LABEL_DOT:
  case CAG_LABEL_CIRCLE: put_circle(out, at, size, color, l->mark == CAG_LABEL_DOT); break;
  case CAG_LABEL_CROSS: put_cross(out, at, size, color); break;
  case CAG_LABEL_ARROW: put_arrow(out, at, along, size, color); break;
  }
  cover(box, at, (MARK_RADIUS + MARK_STROKE) * size);
}

// --- Texts ---

// Tests whether the first code point is a letter that is not followed by a letter.
static bool is_name(const char *text) {
  const unsigned char *c = (const unsigned char *)text;
  if (!isalpha(*c) && *c < 0x80) return false;
  return !isalpha(c[cag_utf8_next(text, strlen(text), 0)]);
}

static bool is_index(unsigned char c) { return isalnum(c) || c >= 0x80; }

// Counts code points.
static double letters(const char *text, size_t n) {
  size_t count = 0;
  for (size_t i = 0; i < n; i++) count += ((unsigned char)text[i] & 0xC0) != 0x80;
  return (double)count;
}

static size_t index_length(const char *text) {
  size_t n = 0;
  while (text[n] && is_index((unsigned char)text[n])) n++;
  return n;
}

// Writes the text, with the parts after a _ as subscripts if `name`. Returns its width in letters.
static double put_runs(Pen *out, const char *text, bool name, double size) {
  double width = 0, lowered = 0;
  while (*text) {
    size_t n = name ? strcspn(text, "_") : strlen(text), m = 0;
    if (text[n] == '_') m = index_length(text + n + 1);
    if (text[n] == '_' && m == 0) n++;
    fputs("<tspan", out->file);
    if (lowered != 0) attribute(out, "dy", -lowered, size);
    fputc('>', out->file);
    cag_svg_escape(out->file, text, n);
    fputs("</tspan>", out->file);
    width += letters(text, n);
    text += n;
    lowered = 0;
    if (m == 0) continue;
    lowered = INDEX_DROP * size;
    fputs("<tspan", out->file);
    attribute(out, "dy", lowered, size);
    attribute(out, "font-size", INDEX_SIZE * size, size);
    fputc('>', out->file);
    cag_svg_escape(out->file, text + 1, m);
    fputs("</tspan>", out->file);
    width += INDEX_SIZE * letters(text + 1, m);
    text += m + 1;
  }
  return width;
}

static void put_text(Pen *out, const CagLabel *l, CagVec3 at, CagVec3 along, const char *color,
                     double size, CagBounds *box) {
  static const struct {
    int x, y;
  } steps[] = {
#define X(name, text, x, y) {x, y},
      CAG_LABEL_PLACES(X)
#undef X
  };
  static const char *const anchors[] = {"end", "middle", "start"};
  const int sx = steps[l->place].x, sy = steps[l->place].y;
  const bool name = is_name(l->text), turned = l->mark != CAG_LABEL_ARROW && cag_norm(along) > 0;
  const double gap = (GAP + (l->mark == CAG_LABEL_NONE ? 0 : MARK_RADIUS)) * size;
  // The mark is round, so the text may be closer at a corner.
  const double near = sx && sy ? 0.7 : 1;
  // From the location to the start of the baseline, along the text's axes.
  const double dx = sx * gap * near;
  const double dy = sy * gap * near - (1 - sy) / 2.0 * CAPITAL * size;
  // A text that runs down or to the left would be upside down.
  CagVec3 x = turned ? cag_unit(along) : cag_vec3(1, 0, 0);
  if (x.x < -1e-9 || (fabs(x.x) <= 1e-9 && x.y < 0)) x = cag_scaled(x, -1);
  const CagVec3 y = cag_vec3(-x.y, x.x, 0), from = cag_madd(cag_madd(at, dx, x), dy, y);
  fputs("  <text", out->file);
  attribute(out, "x", from.x, size);
  attribute(out, "y", -from.y, size);
  attribute(out, "font-size", size, size);
  if (name) fputs(" font-style=\"italic\"", out->file);
  fprintf(out->file, " text-anchor=\"%s\" stroke=\"none\" fill=\"%s\"", anchors[sx + 1], color);
  if (turned) {
    char angle[32], cx[32], cy[32];
    fprintf(out->file, " transform=\"rotate(%s %s %s)\"",
            cag_number_text(rounded(out, -atan2(x.y, x.x) * DEGREES_PER_RADIAN, 10), angle),
            cag_number_text(rounded(out, from.x, size), cx),
            cag_number_text(rounded(out, -from.y, size), cy));
  }
  fputc('>', out->file);
  const double width = put_runs(out, l->text, name, size) * LETTER * size;
  fputs("</text>\n", out->file);
  const double left = (sx - 1) / 2.0 * width;
  const double bottom = -INDEX_DROP * size;
  for (int i = 0; i < 4; i++)
    cag_bounds_add(box, cag_madd(cag_madd(from, left + (i & 1 ? width : 0), x),
                                 i & 2 ? CAPITAL * size : bottom, y));
}

bool cag_svg_label(FILE *file, const CagLabel *label, CagVec3 at, CagVec3 along, const char *color,
                   double unit, CagBounds *box) {
  Pen pen = {file, false};
  const double size = label->size > 0 ? label->size : TEXT_PART * unit;
  cag_bounds_add(box, at);
  put_mark(&pen, label, at, along, color, size, box);
  if (*label->text) put_text(&pen, label, at, along, color, size, box);
  return !pen.undefined;
}
