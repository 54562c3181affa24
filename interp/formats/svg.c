// Converts curves to SVG paths.
//
// Paths are made in memory together with their bounding box, because the size of the picture is at
// the top of the file. Coordinates have y up until numbers are written.

#include "interp/formats/svg.h"

#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "interp/formats/pieces.h"
#include "interp/scene/label_shape.h"

// The tolerance for approximated curves and for rounding of numbers, as a fraction of the picture's
// size.
#define TOLERANCE_PART 5e-5
#define ROUNDING_PART 1e-9
// A picture is flat if its z range is below this fraction of its size.
#define FLAT 1e-9
#define MARGIN 0.05
// The default line width, as a fraction of the picture's diagonal.
#define STROKE_PART 0.003
// The maximum number of bisections of a curve between two breaks, to 1e-5 of it.
#define DEPTH_MAX 17
// Points of an arc from which its bounding box is computed. It may exceed the box by 1/800 of its
// radius.
#define ARC_SAMPLES 64
#define PI 3.14159265358979323846
// Coordinates of labels are rounded to a power of ten below this fraction of the height of the text.
#define LABEL_ROUNDING 1e-3

typedef struct Picture {
  const CagScene *scene;
  const CagCamera *camera;
  bool flat;         // seen along -Z
  CagTransform view; // world to picture: affine when `affine`, else to the camera's own space
  bool affine;
  double near;  // perspective: anything closer is not drawn
  double scale; // perspective: picture = scale * (x / z, y / z)
  double size;  // of the items, before projection
  CagBounds box;
  FILE *out; // paths
  CagVec3 last;
  bool drawing;   // the pen is down at `last`
  bool undefined; // a number was not finite
} Picture;

// --- Numbers ---

static double rounded(Picture *p, double x) {
  double unit = pow(10, floor(log10(p->size * ROUNDING_PART)));
  double steps = round(x / unit);
  double result = unit < 1 ? steps / round(1 / unit) : steps * unit;
  p->undefined |= !isfinite(result);
  return result == 0 ? 0 : result; // no -0
}

static void put_number(Picture *p, double x) {
  char text[32];
  fputs(cag_number_text(rounded(p, x), text), p->out);
}

static void put_control(Picture *p, CagVec3 q) {
  fputc(' ', p->out);
  put_number(p, q.x);
  fputc(' ', p->out);
  put_number(p, -q.y);
}

static void put_point(Picture *p, CagVec3 q) {
  put_control(p, q);
  cag_bounds_add(&p->box, q);
}

// "#rrggbb"
typedef struct ColorText {
  char text[8];
} ColorText;

static ColorText color_text(CagColor c) {
  const double rgb[3] = {c.r, c.g, c.b};
  unsigned byte[3];
  ColorText out;
  for (int i = 0; i < 3; i++)
    byte[i] = (unsigned)lround(255 * cag_linear_to_srgb(fmin(fmax(rgb[i], 0), 1)));
  snprintf(out.text, sizeof out.text, "#%02x%02x%02x", byte[0] & 255, byte[1] & 255, byte[2] & 255);
  return out;
}

static void escape(Picture *p, const char *text) {
  for (const char *c = text; *c; c++) {
    switch (*c) {
    case '&': fputs("&amp;", p->out); break;
    case '<': fputs("&lt;", p->out); break;
    case '>': fputs("&gt;", p->out); break;
    case '"': fputs("&quot;", p->out); break;
    default: fputc((unsigned char)*c < ' ' ? ' ' : *c, p->out);
    }
  }
}

// --- Pen strokes ---

static void move_to(Picture *p, CagVec3 q) {
  if (p->drawing && cag_norm(cag_sub(q, p->last)) <= ROUNDING_PART * p->size) return;
  fputs(p->drawing ? " M" : "M", p->out);
  put_point(p, q);
  p->last = q;
  p->drawing = true;
}

static void line_to(Picture *p, CagVec3 q) {
  fputs(" L", p->out);
  put_point(p, q);
  p->last = q;
}

static CagVec3 cubic_at(const CagVec3 c[4], double t) {
  double s = 1 - t;
  CagVec3 p = cag_scaled(c[0], s * s * s);
  p = cag_madd(p, 3 * s * s * t, c[1]);
  p = cag_madd(p, 3 * s * t * t, c[2]);
  return cag_madd(p, t * t * t, c[3]);
}

// Adds the points where a cubic reverses in x (or y); w: its control points' x (or y).
static void cover_turns(Picture *p, const CagVec3 c[4], const double w[4]) {
  // A third of the derivative is a t^2 + 2 b t + k.
  const double k = w[1] - w[0], b = w[2] - 2 * w[1] + w[0], a = w[3] - 3 * w[2] + 3 * w[1] - w[0];
  const double root = sqrt(fmax(b * b - a * k, 0)), q = -(b + copysign(root, b));
  const double at[2] = {a != 0 ? q / a : -1, q != 0 ? k / q : -1};
  for (int i = 0; i < 2; i++)
    if (at[i] > 0 && at[i] < 1) cag_bounds_add(&p->box, cubic_at(c, at[i]));
}

static void cubic_to(Picture *p, CagVec3 a, CagVec3 b, CagVec3 q) {
  const CagVec3 c[4] = {p->last, a, b, q};
  cover_turns(p, c, (double[]){c[0].x, a.x, b.x, q.x});
  cover_turns(p, c, (double[]){c[0].y, a.y, b.y, q.y});
  fputs(" C", p->out);
  put_control(p, a);
  fputc(',', p->out);
  put_control(p, b);
  fputc(',', p->out);
  put_point(p, q);
  p->last = q;
}

// --- Exact paths, if the view is affine ---

static bool is_straight(const CagVec3 c[4], double size) {
  CagVec3 a = cag_sub(c[1], cag_lerp(c[0], c[3], 1.0 / 3));
  CagVec3 b = cag_sub(c[2], cag_lerp(c[0], c[3], 2.0 / 3));
  return cag_norm(a) + cag_norm(b) <= ROUNDING_PART * size;
}

static bool draw_pieces(Picture *p, const CagCurve *c) {
  CagPieces pieces;
  if (!cag_pieces_of_curve(c, &pieces)) return false;
  for (size_t i = 0; i < pieces.count; i++) {
    CagVec3 q[4];
    for (int k = 0; k < 4; k++) {
      q[k] = cag_transform_point(&p->view, pieces.points[4 * i + (size_t)k]);
      q[k].z = 0;
    }
    move_to(p, q[0]);
    if (is_straight(q, p->size)) line_to(p, q[3]);
    else cubic_to(p, q[1], q[2], q[3]);
  }
  cag_free(pieces.points);
  return true;
}

// Semi-axes and direction of the ellipse center + cos t e + sin t f.
static void principal_axes(CagVec3 e, CagVec3 f, double *major, double *minor, double *angle) {
  double twist =
      atan2(2 * (e.x * f.x + e.y * f.y), e.x * e.x + e.y * e.y - f.x * f.x - f.y * f.y) / 2;
  double c = cos(twist), s = sin(twist);
  CagVec3 a = cag_madd(cag_scaled(e, c), s, f), b = cag_madd(cag_scaled(f, c), -s, e);
  *major = cag_norm(a);
  *minor = cag_norm(b);
  *angle = atan2(a.y, a.x);
}

static bool draw_arc(Picture *p, const CagCurve *c) {
  double a, b, major, minor, angle;
  CagTransform frame;
  if (!cag_curve_arc_view(c, &a, &b, &frame)) return false;
  frame = cag_transform_multiply(&p->view, &frame);
  CagVec3 center = cag_transform_point(&frame, cag_vec3(0, 0, 0));
  CagVec3 e = cag_transform_vector(&frame, cag_vec3(a, 0, 0));
  CagVec3 f = cag_transform_vector(&frame, cag_vec3(0, b, 0));
  center.z = e.z = f.z = 0;
  principal_axes(e, f, &major, &minor, &angle);
  if (!(minor > FLAT * major)) return false; // seen edge-on
  bool counter_clockwise = e.x * f.y - e.y * f.x > 0;
  double span = c->end - c->start;
  int n = (int)ceil(span / PI - 1e-9); // parts of at most half a turn
  for (int i = 0; i <= n; i++) {
    double t = c->start + span * i / n;
    CagVec3 q = cag_madd(cag_madd(center, cos(t), e), sin(t), f);
    if (i == 0) {
      move_to(p, q);
      continue;
    }
    fputs(" A ", p->out);
    put_number(p, major);
    fputc(' ', p->out);
    put_number(p, minor);
    fprintf(p->out, " %.9g 0 %d", minor == major ? 0.0 : -angle * 180 / PI, !counter_clockwise);
    put_point(p, q);
    p->last = q;
  }
  for (int i = 0; i <= ARC_SAMPLES; i++) { // the path's points do not include its bulge
    double t = c->start + span * i / ARC_SAMPLES;
    cag_bounds_add(&p->box, cag_madd(cag_madd(center, cos(t), e), sin(t), f));
  }
  return true;
}

// --- Approximation: cubics with the curve's end tangents, bisected until they fit ---

typedef struct Sample {
  double t;
  CagVec3 p, d; // in the picture; d: derivative by t
  bool visible;
} Sample;

static bool projected_sample(const Picture *p, const CagCurve *c, double t, CagSide side,
                             Sample *out) {
  CagError err;
  CagVec3 e[2];
  if (cag_curve_eval(c, t, 1, side, e, &err)) return false;
  CagVec3 q = cag_transform_point(&p->view, e[0]), d = cag_transform_vector(&p->view, e[1]);
  *out = (Sample){t, q, d, true};
  out->p.z = out->d.z = 0;
  if (p->affine) return true;
  out->visible = q.z > p->near;
  double z = fmax(q.z, p->near), k = p->scale / z;
  out->p = cag_vec3(k * q.x, -k * q.y, 0); // the camera's y points down
  out->d = cag_vec3(k * (d.x - q.x * d.z / z), -k * (d.y - q.y * d.z / z), 0);
  return true;
}

static bool fits(const Picture *p, const CagCurve *c, const Sample *a, const Sample *b,
                 const CagVec3 cubic[4]) {
  static const double at[] = {0.2, 0.4, 0.5, 0.6, 0.8};
  for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
    Sample s;
    if (!projected_sample(p, c, a->t + at[i] * (b->t - a->t), CAG_SIDE_RIGHT, &s)) return true;
    if (!s.visible) return false;
    if (cag_norm(cag_sub(s.p, cubic_at(cubic, at[i]))) > TOLERANCE_PART * p->size) return false;
  }
  return true;
}

static void draw_between(Picture *p, const CagCurve *c, const Sample *a, const Sample *b,
                         int depth) {
  double third = (b->t - a->t) / 3;
  CagVec3 cubic[4] = {a->p, cag_madd(a->p, third, a->d), cag_madd(b->p, -third, b->d), b->p};
  bool visible = a->visible && b->visible;
  if (visible && (depth == 0 || fits(p, c, a, b, cubic))) {
    move_to(p, a->p);
    if (is_straight(cubic, p->size)) line_to(p, b->p);
    else cubic_to(p, cubic[1], cubic[2], cubic[3]);
    return;
  }
  // Parts behind the camera are bisected up to the visible part, and dropped there.
  const int coarse = DEPTH_MAX - 5;
  if (depth == 0 || (!a->visible && !b->visible && depth < coarse)) return;
  Sample left, right;
  double middle = (a->t + b->t) / 2;
  if (!projected_sample(p, c, middle, CAG_SIDE_LEFT, &left) ||
      !projected_sample(p, c, middle, CAG_SIDE_RIGHT, &right))
    return;
  draw_between(p, c, a, &left, depth - 1);
  draw_between(p, c, &right, b, depth - 1);
}

#define BREAKS_MAX 4096

static CagStatus draw_approximate(Picture *p, const CagCurve *c, CagError *err) {
  double *at = cag_malloc((BREAKS_MAX + 2) * sizeof *at);
  if (!at) return cag_fail_memory(err);
  size_t n = c->kind->breaks ? c->kind->breaks(c, at + 1, BREAKS_MAX) : 0;
  if (n > BREAKS_MAX) n = BREAKS_MAX;
  at[0] = c->start;
  at[n + 1] = c->end;
  for (size_t i = 0; i <= n; i++) {
    Sample a, b;
    if (projected_sample(p, c, at[i], CAG_SIDE_RIGHT, &a) &&
        projected_sample(p, c, at[i + 1], CAG_SIDE_LEFT, &b))
      draw_between(p, c, &a, &b, DEPTH_MAX);
  }
  cag_free(at);
  return CAG_OK;
}

static CagStatus draw_curve(Picture *p, const CagCurve *c, CagError *err) {
  if (p->affine && (draw_pieces(p, c) || draw_arc(p, c))) return CAG_OK;
  return draw_approximate(p, c, err);
}

// --- Items ---

static void open_path(Picture *p, const CagItem *item) {
  p->drawing = false;
  fputs("  <path", p->out);
  const CagMaterial *material = &p->scene->materials[item->material];
  if (item->kind == CAG_ITEM_REGION) {
    fputs(" stroke=\"none\" fill-rule=\"evenodd\"", p->out);
    if (material->transmission > 0)
      fprintf(p->out, " fill-opacity=\"%.3g\"", 1 - material->transmission);
    fputs(" fill=\"", p->out);
  } else {
    if (item->line_radius > 0) {
      fputs(" stroke-width=\"", p->out);
      put_number(p, 2 * item->line_radius);
      fputc('"', p->out);
    }
    if (item->dash > 0) {
      fputs(" stroke-linecap=\"butt\" stroke-dasharray=\"", p->out);
      put_number(p, item->dash);
      fputc('"', p->out);
    }
    fputs(" stroke=\"", p->out);
  }
  fputs(color_text(material->color).text, p->out);
  fputs("\" d=\"", p->out);
}

static void close_path(Picture *p, const CagItem *item) {
  fputs("\"><title>", p->out);
  escape(p, item->name);
  fputs("</title></path>\n", p->out);
}

// Draws the loops under a transform to the world.
static CagStatus draw_region(Picture *p, const CagRegion *r, const CagTransform *placement,
                             CagError *err) {
  CagTransform world = p->view;
  p->view = cag_transform_multiply(&world, placement);
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < r->count; i++) {
    if (i > 0) fputc(' ', p->out);
    p->drawing = false;
    status = draw_curve(p, r->loops[i], err);
    fputs(" Z", p->out);
  }
  p->view = world;
  return status;
}

static CagStatus draw_item(Picture *p, const CagItem *item, CagError *err) {
  CagStatus status = cag_stop_check(err);
  if (status || (item->kind != CAG_ITEM_CURVE && item->kind != CAG_ITEM_REGION)) return status;
  open_path(p, item);
  if (item->kind == CAG_ITEM_REGION) {
    status = draw_region(p, item->as.region, &item->placement, err);
  } else {
    status = draw_curve(p, item->as.curve, err);
    if (item->as.curve->closed && p->drawing && p->affine) fputs(" Z", p->out);
  }
  close_path(p, item);
  return status;
}

// --- Labels ---

// Returns false if it is behind the camera. A direction is projected as a short step along it.
static bool look_at_label(const Picture *p, const CagLabel *l, CagVec3 *at, CagVec3 *along) {
  CagVec3 q = cag_transform_point(&p->view, l->at), d = cag_transform_vector(&p->view, l->along);
  *at = cag_vec3(q.x, q.y, 0);
  *along = cag_vec3(d.x, d.y, 0);
  if (p->affine) return true;
  const double k = p->scale / q.z;
  *at = cag_vec3(k * q.x, -k * q.y, 0);
  *along = cag_vec3(k * (d.x - q.x * d.z / q.z), -k * (d.y - q.y * d.z / q.z), 0);
  return q.z > p->near;
}

// Draws a region of the picture.
static CagStatus draw_flat(void *picture, const CagRegion *r, CagColor color, CagError *err) {
  Picture *p = picture;
  const CagTransform none = cag_transform_identity();
  fprintf(p->out, "    <path stroke=\"none\" fill-rule=\"evenodd\" fill=\"%s\" d=\"",
          color_text(color).text);
  CagStatus status = draw_region(p, r, &none, err);
  fputs("\"/>\n", p->out);
  return status;
}

static CagStatus draw_shape(Picture *p, const CagLabel *l, const CagLabelShape *shape,
                            CagError *err) {
  fputs("  <g", p->out);
  if (*l->text) {
    fputs(" role=\"img\" aria-label=\"", p->out);
    escape(p, l->text);
    fputc('"', p->out);
  }
  fputs(">\n", p->out);
  CagStatus status =
      cag_label_shape_draw(shape, p->scene->materials[l->material].color, draw_flat, p, err);
  fputs("  </g>\n", p->out);
  cag_bounds_add(&p->box, shape->box.min);
  cag_bounds_add(&p->box, shape->box.max);
  return status;
}

// A picture whose paths are regions of its plane, with numbers fit for a text of this height.
static Picture flat_picture(const Picture *p, double size) {
  Picture flat = *p;
  flat.view = cag_transform_identity();
  flat.affine = true;
  flat.size = size * LABEL_ROUNDING / ROUNDING_PART;
  return flat;
}

static CagStatus draw_label(Picture *p, CagLabelFonts *fonts, const CagLabel *l, CagVec3 at,
                            CagVec3 along, double diagonal, CagError *err) {
  const double size = l->size > 0 ? l->size : CAG_LABEL_PART * diagonal;
  CagLabelShape shape;
  if (!isfinite(at.x) || !isfinite(at.y) || !isfinite(size)) {
    p->undefined = true;
    return CAG_OK;
  }
  CagStatus status = cag_label_shape(fonts, l, at, along, size, &shape, err);
  if (status) return status;
  Picture flat = flat_picture(p, size);
  status = draw_shape(&flat, l, &shape, err);
  p->box = flat.box;
  p->undefined = flat.undefined;
  cag_label_shape_free(&shape);
  return status;
}

CagStatus cag_svg_path(const CagRegion *r, double size, FILE *out, CagError *err) {
  const CagTransform none = cag_transform_identity();
  const Picture whole = {.out = out, .box = CAG_BOUNDS_EMPTY};
  Picture flat = flat_picture(&whole, size);
  return draw_region(&flat, r, &none, err);
}

// Labels come last: they are on top of all lines, and depend on the picture's size.
static CagStatus draw_labels(Picture *p, CagError *err) {
  const CagScene *s = p->scene;
  CagBounds drawn = p->box;
  CagLabelFonts fonts = {0};
  CagVec3 at, along;
  CagStatus status = CAG_OK;
  for (size_t i = 0; i < s->label_count; i++)
    if (look_at_label(p, &s->labels[i], &at, &along)) cag_bounds_add(&drawn, at);
  double diagonal = cag_norm(cag_sub(drawn.max, drawn.min));
  if (!(diagonal > 0)) diagonal = p->size;
  for (size_t i = 0; !status && i < s->label_count; i++) {
    const CagLabel *l = &s->labels[i];
    if (look_at_label(p, l, &at, &along))
      status = draw_label(p, &fonts, l, at, along, diagonal, err);
  }
  cag_label_fonts_free(&fonts);
  return status;
}

// --- The view ---

static CagStatus item_bounds(const CagItem *item, CagBounds *out, CagError *err) {
  if (item->kind == CAG_ITEM_CURVE) return cag_curve_bounds(item->as.curve, out, err);
  CagBounds flat;
  CagStatus status = cag_region_bounds(item->as.region, &flat, err);
  if (status) return status;
  *out = CAG_BOUNDS_EMPTY;
  for (int i = 0; i < 4; i++)
    cag_bounds_add(
        out, cag_transform_point(&item->placement, cag_vec3(i & 1 ? flat.max.x : flat.min.x,
                                                            i & 2 ? flat.max.y : flat.min.y, 0)));
  return CAG_OK;
}

static CagStatus measure(const CagScene *s, CagBounds *all, CagError *err) {
  size_t found = 0;
  *all = CAG_BOUNDS_EMPTY;
  for (size_t i = 0; i < s->item_count; i++) {
    const CagItem *item = &s->items[i];
    CagBounds b;
    if (item->kind != CAG_ITEM_CURVE && item->kind != CAG_ITEM_REGION) continue;
    CagStatus status = item_bounds(item, &b, err);
    if (status) return status;
    cag_bounds_add(all, b.min);
    cag_bounds_add(all, b.max);
    found++;
  }
  for (size_t i = 0; i < s->label_count; i++) cag_bounds_add(all, s->labels[i].at);
  if (found + s->label_count > 0) return CAG_OK;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_svg_without_curves, "", -1,
                  "the scene has no curves, regions, or labels, and an .svg shows nothing else");
}

static CagStatus set_view(Picture *p, size_t camera, const CagBounds *all, CagError *err) {
  p->size = cag_norm(cag_sub(all->max, all->min));
  if (!(p->size > 0)) p->size = 1;
  p->view = cag_transform_identity();
  p->affine = p->flat = all->max.z - all->min.z <= FLAT * p->size;
  if (p->flat) return CAG_OK;
  if (camera >= p->scene->camera_count)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_camera_unknown, "camera", (long)camera,
                    "the scene has %zu cameras, but none with the number %zu",
                    p->scene->camera_count, camera);
  const CagCamera *c = p->camera = &p->scene->cameras[camera];
  CagTransform frame = cag_camera_frame(c), up = cag_transform_identity(), pixels = up;
  CagStatus status = cag_transform_inverse(&frame, &p->view, err);
  p->affine = c->orthographic;
  p->scale = cag_norm(cag_sub(c->target, c->eye));
  p->near = 1e-3 * p->scale;
  up.m[1][1] = -1; // the camera's y points down; a perspective view flips it after the division
  pixels.m[0][1] = c->skew;
  pixels.m[1][1] = 1 + c->stretch;
  p->view = cag_transform_multiply(&pixels, &p->view);
  if (p->affine) p->view = cag_transform_multiply(&up, &p->view);
  return status;
}

// --- The file ---

static void write_number(CagAtomicFile *f, Picture *p, double x) {
  char text[32];
  cag_atomic_file_text(f, cag_number_text(rounded(p, x), text));
}

static void write_file(Picture *p, CagAtomicFile *f, const char *paths, size_t n) {
  CagVec3 size = cag_sub(p->box.max, p->box.min);
  double diagonal = hypot(size.x, size.y), widest = STROKE_PART * diagonal;
  for (size_t i = 0; i < p->scene->item_count; i++)
    if (p->scene->items[i].kind == CAG_ITEM_CURVE)
      widest = fmax(widest, 2 * p->scene->items[i].line_radius);
  double border = MARGIN * diagonal + widest / 2;
  const double box[4] = {p->box.min.x - border, -p->box.max.y - border, size.x + 2 * border,
                         size.y + 2 * border};
  cag_atomic_file_text(f, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                          "<svg xmlns=\"http://www.w3.org/2000/svg\" version=\"1.1\" width=\"");
  write_number(f, p, box[2]);
  cag_atomic_file_text(f, "mm\" height=\"");
  write_number(f, p, box[3]);
  cag_atomic_file_text(f, "mm\" viewBox=\"");
  for (int i = 0; i < 4; i++) {
    if (i > 0) cag_atomic_file_text(f, " ");
    write_number(f, p, box[i]);
  }
  cag_atomic_file_text(f,
                       "\">\n<g fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\" "
                       "stroke-width=\"");
  write_number(f, p, STROKE_PART * diagonal);
  cag_atomic_file_text(f, "\">\n");
  cag_atomic_file_write(f, paths, n);
  cag_atomic_file_text(f, "</g>\n</svg>\n");
}

CagStatus cag_export_svg(const CagScene *scene, size_t camera, CagAtomicFile *file, CagError *err) {
  Picture p = {.scene = scene, .box = CAG_BOUNDS_EMPTY};
  CagBounds all;
  CagStatus status = measure(scene, &all, err);
  if (!status) status = set_view(&p, camera, &all, err);
  if (status) return status;
  char *paths = NULL;
  size_t n = 0;
  p.out = open_memstream(&paths, &n);
  if (!p.out) return cag_fail_memory(err);
  for (size_t i = 0; !status && i < scene->item_count; i++)
    status = draw_item(&p, &scene->items[i], err);
  if (!status) status = draw_labels(&p, err);
  bool whole = fclose(p.out) == 0;
  if (!status && !whole) status = cag_fail_memory(err);
  if (!status && !(p.box.min.x <= p.box.max.x))
    status = cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_svg_nothing_visible, "camera", (long)camera,
                      "all curves are behind the camera");
  if (!status) write_file(&p, file, paths, n);
  if (!status && p.undefined)
    status = cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_not_finite, "", -1,
                      "a number in the drawing overflows or is undefined");
  cag_free(paths);
  return status;
}
