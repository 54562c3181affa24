// Entities of IGES files (see iges_entity.h).

#include "interp/formats/iges_entity.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "base/decimal.h"
#include "base/utf8.h"

// --- Lines ---

// Fields of lines, and their counters, have 8 columns; files are limited to 9,999,999 lines, but
// larger numbers would only make a line longer.
#define COLUMN_WIDTH 8
#define LINE_ROOM 240

// Writes x, which is not negative, at the end of a column.
static char *write_column(char *at, size_t width, char fill, long x) {
  char digits[20];
  const size_t n = (size_t)(cag_decimal_index(digits, (uint64_t)x) - digits);
  for (size_t i = n; i < width; i++) *at++ = fill;
  memcpy(at, digits, n);
  return at + n;
}

static char *end_line(char *at, char section, long number) {
  *at++ = section;
  at = write_column(at, COLUMN_WIDTH - 1, ' ', number);
  *at++ = '\n';
  return at;
}

void cag_iges_end_line(CagIges *w) {
  if (w->column == 0) return;
  char *at = cag_atomic_file_reserve(w->parameters, LINE_ROOM);
  w->parameter_lines++;
  memcpy(at, w->line, w->column);
  memset(at + w->column, ' ', CAG_IGES_GLOBAL_COLUMNS - w->column);
  if (w->entity > 0)
    at = write_column(at + CAG_IGES_PARAMETER_COLUMNS, COLUMN_WIDTH, ' ', w->entity);
  else at += CAG_IGES_GLOBAL_COLUMNS;
  cag_atomic_file_advance(w->parameters,
                          end_line(at, w->entity > 0 ? 'P' : 'G', w->parameter_lines));
  w->column = 0;
}

// A value and its separator must be on the same line.
static void put_token(CagIges *w, const char *text, char separator) {
  size_t n = strlen(text);
  if (w->column + n + 1 > w->width) cag_iges_end_line(w);
  memcpy(w->line + w->column, text, n);
  w->line[w->column + n] = separator;
  w->column += n + 1;
}

void cag_iges_integer(CagIges *w, long x) {
  char text[24], *at = text;
  if (x < 0) *at++ = '-';
  *cag_decimal_index(at, x < 0 ? -(uint64_t)x : (uint64_t)x) = 0;
  put_token(w, text, ',');
}

void cag_iges_pointer(CagIges *w, CagIgesPointer p) { cag_iges_integer(w, p); }

// Reals contain a point. The exponent of double precision is written with D.
void cag_iges_real(CagIges *w, double x) {
  char text[40];
  w->undefined |= !isfinite(x);
  cag_number_text(x == 0 ? 0 : x, text);
  char *e = strchr(text, 'e'), exponent[8] = "";
  if (e) {
    *e = 0;
    snprintf(exponent, sizeof exponent, "D%s", e + 1);
  }
  if (!strchr(text, '.')) strcat(text, ".");
  put_token(w, strcat(text, exponent), ',');
}

static void put_character(CagIges *w, char c) {
  if (w->column == w->width) cag_iges_end_line(w);
  w->line[w->column++] = c;
}

// A string is preceded by its length. Only ASCII characters are supported.
void cag_iges_string(CagIges *w, const char *text) {
  const size_t n = cag_utf8_count(text, strlen(text));
  if (n == 0) {
    put_token(w, "", ',');
    return;
  }
  char head[24];
  snprintf(head, sizeof head, "%zuH", n);
  if (w->column + strlen(head) + 1 > w->width) cag_iges_end_line(w);
  for (const char *p = head; *p; p++) put_character(w, *p);
  for (const char *p = text; *p; p++) {
    if (cag_utf8_is_within(*p)) continue;
    put_character(w, *p >= 0x20 && *p < 0x7f ? *p : '_');
  }
  put_character(w, ',');
}

void cag_iges_point(CagIges *w, CagVec3 p) {
  cag_iges_real(w, p.x);
  cag_iges_real(w, p.y);
  cag_iges_real(w, p.z);
}

// --- Entities ---

CagIgesPointer cag_iges_begin(CagIges *w, int type, int form, int status) {
  w->type = type;
  w->form = form;
  w->status = status;
  w->entity = 2 * w->entities++ + 1;
  w->first_line = w->parameter_lines + 1;
  cag_iges_integer(w, type);
  return w->entity;
}

void cag_iges_end(CagIges *w, bool named) {
  if (named && w->name > 0) { // no associations, one property
    cag_iges_integer(w, 0);
    cag_iges_integer(w, 1);
    cag_iges_pointer(w, w->name);
  }
  w->line[w->column - 1] = ';';
  cag_iges_end_line(w);
  // Structure, line font, level, and view come between the first line of parameters and the matrix;
  // line weight, color, number of lines, and form begin the second line.
  const CagIgesPointer d = w->entity;
  const long first[7] = {w->type, w->first_line, 0, 1, 0, 0, w->matrix};
  char *at = cag_atomic_file_reserve(w->directory, LINE_ROOM);
  for (size_t i = 0; i < 7; i++) at = write_column(at, COLUMN_WIDTH, ' ', first[i]);
  at = write_column(at, COLUMN_WIDTH, ' ', 0); // no label display
  at = write_column(at, COLUMN_WIDTH, '0', w->status);
  cag_atomic_file_advance(w->directory, end_line(at, 'D', d));
  cag_atomic_file_printf(w->directory, "%8d%8d%8ld%8ld%8d%8s%8s%8s%8dD%7ld\n", w->type, 0,
                         -w->color, w->parameter_lines - w->first_line + 1, w->form, "", "", "", 0,
                         d + 1);
  w->matrix = 0;
}

CagIgesPointer cag_iges_color(CagIges *w, CagColor c) {
  CagIgesPointer p = cag_iges_begin(w, 314, 0, CAG_IGES_DEFINITION);
  const double rgb[3] = {c.r, c.g, c.b};
  // Percentages of sRGB, which viewers expect, to 3 decimal places.
  for (int i = 0; i < 3; i++)
    cag_iges_real(w, round(1e5 * cag_linear_to_srgb(fmin(fmax(rgb[i], 0), 1))) / 1e3);
  cag_iges_end(w, false);
  return p;
}

CagIgesPointer cag_iges_name(CagIges *w, const char *text) {
  CagIgesPointer p = cag_iges_begin(w, 406, 15, CAG_IGES_DEFINITION);
  cag_iges_integer(w, 1);
  cag_iges_string(w, text);
  cag_iges_end(w, false);
  return p;
}

// --- NURBS ---

CagStatus cag_iges_nurbs_curve(CagIges *w, const CagCurve *c, bool flat, int use,
                               CagIgesPointer *out, CagError *err) {
  CagNurbsView v = {0};
  CagPlane plane = {{0, 0, 0}, {0, 0, 1}};
  bool planar = true, straight = false;
  CagStatus status = flat ? CAG_OK : cag_curve_is_straight(c, &straight, err);
  if (!status && !flat) status = cag_curve_is_planar(c, &planar, &plane, err);
  if (status) return status;
  planar = planar && !straight;
  cag_curve_nurbs_view(c, &v);
  *out = cag_iges_begin(w, 126, 0, use);
  cag_iges_integer(w, (long)v.count - 1);
  cag_iges_integer(w, v.degree);
  cag_iges_integer(w, planar);
  cag_iges_integer(w, c->closed);
  cag_iges_integer(w, !v.rational);
  cag_iges_integer(w, 0); // not periodic
  for (size_t i = 0; i < v.count + (size_t)v.degree + 1; i++) cag_iges_real(w, v.knots[i]);
  for (size_t i = 0; i < v.count; i++) cag_iges_real(w, v.homogeneous[4 * i + 3]);
  for (size_t i = 0; i < v.count; i++) {
    const double *h = v.homogeneous + 4 * i;
    cag_iges_point(w, cag_vec3(h[0] / h[3], h[1] / h[3], h[2] / h[3]));
  }
  cag_iges_real(w, c->start);
  cag_iges_real(w, c->end);
  cag_iges_point(w, planar ? plane.normal : cag_vec3(0, 0, 0));
  cag_iges_end(w, use == CAG_IGES_FREE);
  return CAG_OK;
}

// Writes control points and weights, with u varying fastest.
CagIgesPointer cag_iges_nurbs_surface(CagIges *w, const CagSurface *s, int status) {
  CagSurfaceNurbsView v = {0};
  cag_surface_nurbs_view(s, &v);
  CagIgesPointer p = cag_iges_begin(w, 128, 0, status);
  cag_iges_integer(w, (long)v.nu - 1);
  cag_iges_integer(w, (long)v.nv - 1);
  cag_iges_integer(w, v.degree_u);
  cag_iges_integer(w, v.degree_v);
  cag_iges_integer(w, s->closed_u);
  cag_iges_integer(w, s->closed_v);
  cag_iges_integer(w, !v.rational);
  cag_iges_integer(w, 0); // not periodic
  cag_iges_integer(w, 0);
  for (size_t i = 0; i < v.nu + (size_t)v.degree_u + 1; i++) cag_iges_real(w, v.knots_u[i]);
  for (size_t i = 0; i < v.nv + (size_t)v.degree_v + 1; i++) cag_iges_real(w, v.knots_v[i]);
  for (size_t j = 0; j < v.nv; j++)
    for (size_t i = 0; i < v.nu; i++) cag_iges_real(w, v.homogeneous[4 * (i * v.nv + j) + 3]);
  for (size_t j = 0; j < v.nv; j++)
    for (size_t i = 0; i < v.nu; i++) {
      const double *h = v.homogeneous + 4 * (i * v.nv + j);
      cag_iges_point(w, cag_vec3(h[0] / h[3], h[1] / h[3], h[2] / h[3]));
    }
  cag_iges_real(w, s->u0);
  cag_iges_real(w, s->u1);
  cag_iges_real(w, s->v0);
  cag_iges_real(w, s->v1);
  cag_iges_end(w, status == CAG_IGES_FREE);
  return p;
}

// --- Lines and conics ---

// Angles that differ by less are the same.
#define ANGLE_ROUNDING 1e-9

CagIgesPointer cag_iges_line(CagIges *w, CagVec3 from, CagVec3 to) {
  const CagIgesPointer at = cag_iges_begin(w, 110, 0, CAG_IGES_PART);
  cag_iges_point(w, from);
  cag_iges_point(w, to);
  cag_iges_end(w, false);
  return at;
}

static void straight_curve(CagIges *w, const CagCurve *c, const CagNurbsView *v,
                           CagIgesCurve *out) {
  const double *a = v->homogeneous, *b = a + 4;
  out->at = cag_iges_line(w, cag_vec3(a[0] / a[3], a[1] / a[3], a[2] / a[3]),
                          cag_vec3(b[0] / b[3], b[1] / b[3], b[2] / b[3]));
  out->scale = 1 / (c->end - c->start);
  out->shift = -c->start * out->scale;
}

// The frame with its x and y axes turned by an angle.
static CagTransform turned_frame(const CagTransform *t, double angle) {
  CagTransform out = *t;
  for (int i = 0; i < 3; i++) {
    out.m[i][0] = cos(angle) * t->m[i][0] + sin(angle) * t->m[i][1];
    out.m[i][1] = cos(angle) * t->m[i][1] - sin(angle) * t->m[i][0];
  }
  return out;
}

// The matrix (entity 124) from the coordinates of a frame, whose z axis is the product of its other
// ones.
static CagIgesPointer frame_matrix(CagIges *w, const CagTransform *t) {
  const CagVec3 x = cag_vec3(t->m[0][0], t->m[1][0], t->m[2][0]);
  const CagVec3 y = cag_vec3(t->m[0][1], t->m[1][1], t->m[2][1]);
  const CagVec3 z = cag_cross(x, y);
  const double row[3][4] = {
      {x.x, y.x, z.x, t->m[0][3]}, {x.y, y.y, z.y, t->m[1][3]}, {x.z, y.z, z.z, t->m[2][3]}};
  const CagIgesPointer p = cag_iges_begin(w, 124, 0, CAG_IGES_PART);
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 4; k++) cag_iges_real(w, row[i][k]);
  cag_iges_end(w, false);
  return p;
}

// Two coordinates of the point of an ellipse, exact at whole turns.
static void put_conic_point(CagIges *w, double a, double b, double t) {
  cag_iges_real(w, t == 0 ? a : a * cos(t));
  cag_iges_real(w, t == 0 ? 0 : b * sin(t));
}

// A circular arc (entity 100) that starts on the x axis of its coordinates.
static void circular_curve(CagIges *w, const CagCurve *c, double radius, const CagTransform *frame,
                           CagIgesCurve *out) {
  const CagTransform from = turned_frame(frame, c->start);
  const CagIgesPointer matrix = frame_matrix(w, &from);
  out->at = cag_iges_begin(w, 100, 0, CAG_IGES_PART);
  w->matrix = matrix;
  for (int i = 0; i < 3; i++) cag_iges_real(w, 0);
  put_conic_point(w, radius, radius, 0);
  put_conic_point(w, radius, radius, c->closed ? 0 : c->end - c->start);
  cag_iges_end(w, false);
  out->shift = -c->start;
}

// An arc of an ellipse (entity 104), whose longer axis is the first one of its coordinates, and
// whose parameter starts in the first turn.
static void elliptic_curve(CagIges *w, const CagCurve *c, double a, double b,
                           const CagTransform *frame, CagIgesCurve *out) {
  const double quarter = a < b ? M_PI / 2 : 0, longer = fmax(a, b), shorter = fmin(a, b);
  const CagTransform from = turned_frame(frame, quarter);
  const CagIgesPointer matrix = frame_matrix(w, &from);
  const double start = c->start - quarter, turns = 2 * M_PI * floor(start / (2 * M_PI));
  out->at = cag_iges_begin(w, 104, 1, CAG_IGES_PART);
  w->matrix = matrix;
  const double equation[7] = {shorter * shorter,
                              0,
                              longer * longer,
                              0,
                              0,
                              -longer * longer * shorter * shorter,
                              0}; // the last one: z
  for (int i = 0; i < 7; i++) cag_iges_real(w, equation[i]);
  put_conic_point(w, longer, shorter, start - turns);
  put_conic_point(w, longer, shorter, c->closed ? start - turns : c->end - quarter - turns);
  cag_iges_end(w, false);
  out->shift = -quarter - turns;
}

bool cag_iges_is_offset_ellipse(const CagCurve *c) {
  double a, b;
  CagTransform frame;
  if (!c->closed || !cag_curve_arc_view(c, &a, &b, &frame) || a == b) return false;
  return fabs(remainder(c->start - (a < b ? M_PI / 2 : 0), 2 * M_PI)) > ANGLE_ROUNDING;
}

// Writes the exact NURBS form of a curve.
static CagStatus exact_curve(CagIges *w, const CagCurve *c, CagIgesCurve *out, CagError *err) {
  CagCurve *exact;
  CagStatus status = cag_curve_to_nurbs(c, &exact, err);
  if (status) return status;
  out->bent = true;
  status = cag_iges_nurbs_curve(w, exact, false, CAG_IGES_PART, &out->at, err);
  cag_curve_release(exact);
  return status;
}

CagStatus cag_iges_curve(CagIges *w, const CagCurve *c, CagIgesCurve *out, CagError *err) {
  double a, b;
  CagTransform frame;
  CagNurbsView v;
  *out = (CagIgesCurve){.scale = 1};
  if (cag_iges_is_offset_ellipse(c)) return exact_curve(w, c, out, err);
  if (cag_curve_arc_view(c, &a, &b, &frame)) {
    if (a == b) circular_curve(w, c, a, &frame, out);
    else elliptic_curve(w, c, a, b, &frame, out);
    return CAG_OK;
  }
  if (cag_curve_nurbs_view(c, &v) && v.degree == 1 && v.count == 2) {
    straight_curve(w, c, &v, out);
    return CAG_OK;
  }
  return cag_iges_nurbs_curve(w, c, false, CAG_IGES_PART, &out->at, err);
}
