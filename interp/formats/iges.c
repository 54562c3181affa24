// Writer of IGES files.
//
// A file consists of lines of 80 columns in five sections: start, global, directory (two lines per
// entity), parameters, and end. The directory comes first and contains line numbers of the
// parameters, so both are made in memory first. An entity is referred to by the number of its first
// directory line.

#include "interp/formats/iges.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/utf8.h"

// Columns of parameters in a line, which are followed by the number of the directory line.
#define PARAMETER_COLUMNS 64
#define GLOBAL_COLUMNS 72

typedef long Pointer; // number of a directory line; 0: none

typedef struct Writer {
  const CagBrep *brep;
  CagAtomicFile *directory, *parameters;
  char line[81];
  size_t column, width; // of the current line
  Pointer entity;       // whose parameters are being written; 0: the global section
  long parameter_lines, first_line, entities;
  int type, form, status;
  Pointer color, name;
  bool undefined; // a number was not finite
} Writer;

// --- Lines ---

static void end_line(Writer *w) {
  if (w->column == 0) return;
  w->line[w->column] = 0;
  w->parameter_lines++;
  if (w->entity > 0)
    cag_atomic_file_printf(w->parameters, "%-64s %7ldP%7ld\n", w->line, w->entity,
                           w->parameter_lines);
  else cag_atomic_file_printf(w->parameters, "%-72sG%7ld\n", w->line, w->parameter_lines);
  w->column = 0;
}

// A value and its separator must be on the same line.
static void put_token(Writer *w, const char *text, char separator) {
  size_t n = strlen(text);
  if (w->column + n + 1 > w->width) end_line(w);
  memcpy(w->line + w->column, text, n);
  w->line[w->column + n] = separator;
  w->column += n + 1;
}

static void put_integer(Writer *w, long x) {
  char text[24];
  snprintf(text, sizeof text, "%ld", x);
  put_token(w, text, ',');
}

static void put_pointer(Writer *w, Pointer p) { put_integer(w, p); }

// Reals contain a point. The exponent of double precision is written with D.
static void put_real(Writer *w, double x) {
  char text[40], out[48];
  w->undefined |= !isfinite(x);
  cag_number_text(x == 0 ? 0 : x, text);
  char *e = strchr(text, 'e');
  if (e) *e++ = 0;
  snprintf(out, sizeof out, "%s%s%s%s", text, strchr(text, '.') ? "" : ".", e ? "D" : "",
           e ? e : "");
  put_token(w, out, ',');
}

static void put_character(Writer *w, char c) {
  if (w->column == w->width) end_line(w);
  w->line[w->column++] = c;
}

// A string is preceded by its length. Only ASCII characters are supported.
static void put_string(Writer *w, const char *text) {
  const size_t n = cag_utf8_count(text, strlen(text));
  if (n == 0) {
    put_token(w, "", ',');
    return;
  }
  char head[24];
  snprintf(head, sizeof head, "%zuH", n);
  if (w->column + strlen(head) + 1 > w->width) end_line(w);
  for (const char *p = head; *p; p++) put_character(w, *p);
  for (const char *p = text; *p; p++) {
    if (cag_utf8_is_within(*p)) continue;
    put_character(w, *p >= 0x20 && *p < 0x7f ? *p : '_');
  }
  put_character(w, ',');
}

static void put_point(Writer *w, CagVec3 p) {
  put_real(w, p.x);
  put_real(w, p.y);
  put_real(w, p.z);
}

// --- Entities ---

// The digits of the status: visibility, dependence (01: part of another), use (05: in parameters of
// a surface, 02: definition), hierarchy.
enum { FREE = 0, PART = 10000, PART_FLAT = 10500, DEFINITION = 200 };

static Pointer begin(Writer *w, int type, int form, int status) {
  w->type = type;
  w->form = form;
  w->status = status;
  w->entity = 2 * w->entities++ + 1;
  w->first_line = w->parameter_lines + 1;
  put_integer(w, type);
  return w->entity;
}

static void end(Writer *w, bool named) {
  if (named && w->name > 0) { // no associations, one property
    put_integer(w, 0);
    put_integer(w, 1);
    put_pointer(w, w->name);
  }
  w->line[w->column - 1] = ';';
  end_line(w);
  Pointer d = w->entity;
  cag_atomic_file_printf(w->directory, "%8d%8ld%8d%8d%8d%8d%8d%8d%08dD%7ld\n", w->type,
                         w->first_line, 0, 1, 0, 0, 0, 0, w->status, d);
  cag_atomic_file_printf(w->directory, "%8d%8d%8ld%8ld%8d%8s%8s%8s%8dD%7ld\n", w->type, 0,
                         -w->color, w->parameter_lines - w->first_line + 1, w->form, "", "", "", 0,
                         d + 1);
}

static Pointer color(Writer *w, CagColor c) {
  Pointer p = begin(w, 314, 0, DEFINITION);
  const double rgb[3] = {c.r, c.g, c.b};
  // Percentages of sRGB, which viewers expect, to 3 decimal places.
  for (int i = 0; i < 3; i++)
    put_real(w, round(1e5 * cag_linear_to_srgb(fmin(fmax(rgb[i], 0), 1))) / 1e3);
  end(w, false);
  return p;
}

static Pointer name(Writer *w, const char *text) {
  Pointer p = begin(w, 406, 15, DEFINITION);
  put_integer(w, 1);
  put_string(w, text);
  end(w, false);
  return p;
}

// --- NURBS ---

// `flat`: a curve in the parameters of a surface.
static CagStatus nurbs_curve(Writer *w, const CagCurve *c, bool flat, int use, Pointer *out,
                             CagError *err) {
  CagNurbsView v = {0};
  CagPlane plane = {{0, 0, 0}, {0, 0, 1}};
  bool planar = true, straight = false;
  CagStatus status = flat ? CAG_OK : cag_curve_is_straight(c, &straight, err);
  if (!status && !flat) status = cag_curve_is_planar(c, &planar, &plane, err);
  if (status) return status;
  planar = planar && !straight;
  cag_curve_nurbs_view(c, &v);
  *out = begin(w, 126, 0, use);
  put_integer(w, (long)v.count - 1);
  put_integer(w, v.degree);
  put_integer(w, planar);
  put_integer(w, c->closed);
  put_integer(w, !v.rational);
  put_integer(w, 0); // not periodic
  for (size_t i = 0; i < v.count + (size_t)v.degree + 1; i++) put_real(w, v.knots[i]);
  for (size_t i = 0; i < v.count; i++) put_real(w, v.homogeneous[4 * i + 3]);
  for (size_t i = 0; i < v.count; i++) {
    const double *h = v.homogeneous + 4 * i;
    put_point(w, cag_vec3(h[0] / h[3], h[1] / h[3], h[2] / h[3]));
  }
  put_real(w, c->start);
  put_real(w, c->end);
  put_point(w, planar ? plane.normal : cag_vec3(0, 0, 0));
  end(w, use == FREE);
  return CAG_OK;
}

// Writes control points and weights, with u varying fastest.
static Pointer nurbs_surface(Writer *w, const CagSurface *s, int status) {
  CagSurfaceNurbsView v = {0};
  cag_surface_nurbs_view(s, &v);
  Pointer p = begin(w, 128, 0, status);
  put_integer(w, (long)v.nu - 1);
  put_integer(w, (long)v.nv - 1);
  put_integer(w, v.degree_u);
  put_integer(w, v.degree_v);
  put_integer(w, s->closed_u);
  put_integer(w, s->closed_v);
  put_integer(w, !v.rational);
  put_integer(w, 0); // not periodic
  put_integer(w, 0);
  for (size_t i = 0; i < v.nu + (size_t)v.degree_u + 1; i++) put_real(w, v.knots_u[i]);
  for (size_t i = 0; i < v.nv + (size_t)v.degree_v + 1; i++) put_real(w, v.knots_v[i]);
  for (size_t j = 0; j < v.nv; j++)
    for (size_t i = 0; i < v.nu; i++) put_real(w, v.homogeneous[4 * (i * v.nv + j) + 3]);
  for (size_t j = 0; j < v.nv; j++)
    for (size_t i = 0; i < v.nu; i++) {
      const double *h = v.homogeneous + 4 * (i * v.nv + j);
      put_point(w, cag_vec3(h[0] / h[3], h[1] / h[3], h[2] / h[3]));
    }
  put_real(w, s->u0);
  put_real(w, s->u1);
  put_real(w, s->v0);
  put_real(w, s->v1);
  end(w, status == FREE);
  return p;
}

// --- Trimmed planes ---

static CagVec3 net_point(const CagSurfaceNurbsView *v, size_t i) {
  const double *h = v->homogeneous + 4 * i;
  return cag_vec3(h[0] / h[3], h[1] / h[3], h[2] / h[3]);
}

// The affine map from space to the parameters of a flat face's rectangle.
static CagStatus to_parameters(const CagSurface *s, CagTransform *out, CagError *err) {
  CagSurfaceNurbsView v = {0};
  cag_surface_nurbs_view(s, &v);
  CagVec3 p = net_point(&v, 0);
  CagVec3 x = cag_scaled(cag_sub(net_point(&v, 2), p), 1 / (s->u1 - s->u0));
  CagVec3 y = cag_scaled(cag_sub(net_point(&v, 1), p), 1 / (s->v1 - s->v0));
  CagVec3 z = cag_cross(x, y);
  CagTransform frame = {
      .m = {{x.x, y.x, z.x, p.x}, {x.y, y.y, z.y, p.y}, {x.z, y.z, z.z, p.z}, {0, 0, 0, 1}}};
  return cag_transform_inverse(&frame, out, err);
}

typedef struct Chain {
  Pointer *flat, *space;
  size_t count;
} Chain;

// Adds the curve in space and, unless map is NULL, in the parameters.
static CagStatus add_use(Writer *w, const CagBrepUse *use, const CagTransform *map, Chain *chain,
                         CagError *err) {
  CagCurve *run = NULL, *flat = NULL;
  const CagCurve *c = w->brep->edges[use->edge].curve;
  CagStatus status = CAG_OK;
  if (use->reversed) status = cag_curve_reverse(c, &run, err);
  else run = cag_curve_retain(c);
  if (!status && map) status = cag_curve_transform(run, map, &flat, err);
  if (!status && map)
    status = nurbs_curve(w, flat, true, PART_FLAT, &chain->flat[chain->count], err);
  if (!status) status = nurbs_curve(w, run, false, PART, &chain->space[chain->count++], err);
  cag_curve_release(run);
  cag_curve_release(flat);
  return status;
}

// Joins several curves end to end. A single curve is returned unchanged.
static Pointer composite(Writer *w, const Pointer *parts, size_t n, int status) {
  if (n == 1) return parts[0];
  Pointer p = begin(w, 102, 0, status);
  put_integer(w, (long)n);
  for (size_t i = 0; i < n; i++) put_pointer(w, parts[i]);
  end(w, false);
  return p;
}

static CagStatus boundary(Writer *w, const CagBrepLoop *loop, const CagTransform *map,
                          Pointer surface, Pointer *out, CagError *err) {
  Chain chain = {cag_calloc(loop->count + 1, sizeof *chain.flat),
                 cag_calloc(loop->count + 1, sizeof *chain.space), 0};
  CagStatus status = chain.flat && chain.space ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < loop->count; i++)
    status = add_use(w, &w->brep->uses[loop->first + i], map, &chain, err);
  if (!status) {
    Pointer flat = map ? composite(w, chain.flat, chain.count, PART_FLAT) : 0;
    Pointer space = composite(w, chain.space, chain.count, PART);
    *out = begin(w, 142, 0, PART);
    put_integer(w, 0); // unspecified way of creation
    put_pointer(w, surface);
    put_pointer(w, flat);
    put_pointer(w, space);
    put_integer(w, map ? 3 : 2); // both are equally good; or the one in space
    end(w, false);
  }
  cag_free(chain.flat);
  cag_free(chain.space);
  return status;
}

static CagStatus trimmed(Writer *w, const CagBrepFace *f, CagError *err) {
  CagTransform map = cag_transform_identity();
  CagStatus status = f->flat ? to_parameters(f->surface, &map, err) : CAG_OK;
  Pointer *loops = cag_calloc(f->count + 1, sizeof *loops);
  if (!status && !loops) status = cag_fail_memory(err);
  Pointer surface = status ? 0 : nurbs_surface(w, f->surface, PART);
  for (size_t i = 0; !status && i < f->count; i++)
    status =
        boundary(w, &w->brep->loops[f->first + i], f->flat ? &map : NULL, surface, &loops[i], err);
  if (!status) {
    begin(w, 144, 0, FREE);
    put_pointer(w, surface);
    put_integer(w, 1); // with an outer boundary
    put_integer(w, (long)f->count - 1);
    for (size_t i = 0; i < f->count; i++) put_pointer(w, loops[i]);
    end(w, true);
  }
  cag_free(loops);
  return status;
}

// --- The whole file ---

static CagStatus write_shape(Writer *w, const CagBrepShape *s, CagError *err) {
  const CagBrep *b = w->brep;
  w->color = w->name = 0;
  Pointer paint = color(w, s->material->color), title = name(w, s->name);
  w->color = paint;
  w->name = title;
  Pointer curve;
  if (s->kind == CAG_BREP_CURVE) return nurbs_curve(w, s->curve, false, FREE, &curve, err);
  for (size_t k = s->first; k < s->first + s->count; k++)
    for (size_t i = b->shells[k].first; i < b->shells[k].first + b->shells[k].count; i++) {
      if (cag_atomic_file_failed(w->parameters)) return CAG_OK;
      const CagBrepFace *f = &b->faces[i];
      CagStatus status = CAG_OK;
      if (f->whole) nurbs_surface(w, f->surface, FREE);
      else status = trimmed(w, f, err);
      if (status) return status;
    }
  return CAG_OK;
}

static double largest_coordinate(const CagBrep *b) {
  double most = 0;
  for (size_t i = 0; i < b->vertex_count; i++) {
    CagVec3 p = b->vertices[i];
    most = fmax(most, fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))));
  }
  return most;
}

// There is no date, so that the output is reproducible.
static void write_global(Writer *w, const char *script) {
  w->width = GLOBAL_COLUMNS;
  put_string(w, ",");
  put_string(w, ";");
  put_string(w, script);
  put_string(w, script);
  put_string(w, "cag " CAG_VERSION);
  put_string(w, "cag " CAG_VERSION);
  // Bits of integers, exponents and digits of single and double precision.
  const long precision[5] = {32, 38, 6, 308, 15};
  for (int i = 0; i < 5; i++) put_integer(w, precision[i]);
  put_string(w, script);
  put_real(w, 1); // scale
  put_integer(w, 2);
  put_string(w, "MM");
  put_integer(w, 1);
  put_real(w, 0.1); // width of lines
  put_string(w, "19700101.000000");
  put_real(w, w->brep->accuracy);
  put_real(w, largest_coordinate(w->brep));
  put_string(w, "");
  put_string(w, "");
  put_integer(w, 11); // IGES 5.3
  put_integer(w, 0);
  put_string(w, "19700101.000000");
  w->line[w->column - 1] = ';';
  end_line(w);
}

// Appends a section made in memory, and counts its lines.
static bool append(CagAtomicFile *to, CagAtomicFile *section, CagError *io) {
  char *bytes;
  size_t size;
  if (!cag_atomic_file_commit_memory(section, &bytes, &size, io)) return false;
  cag_atomic_file_write(to, bytes, size);
  cag_free(bytes);
  return true;
}

typedef struct Sections {
  CagAtomicFile *global, *directory, *parameters;
} Sections;

static void abort_sections(const Sections *s) {
  cag_atomic_file_abort(s->global);
  cag_atomic_file_abort(s->directory);
  cag_atomic_file_abort(s->parameters);
}

static CagStatus write_sections(Writer *w, Sections *s, const char *script, CagAtomicFile *file,
                                CagError *err) {
  w->parameters = s->global;
  write_global(w, script);
  long global = w->parameter_lines;
  w->parameters = s->parameters;
  w->directory = s->directory;
  w->parameter_lines = 0;
  w->width = PARAMETER_COLUMNS;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < w->brep->shape_count; i++)
    status = write_shape(w, &w->brep->shapes[i], err);
  if (status) {
    abort_sections(s);
    return status;
  }
  cag_atomic_file_printf(file, "%-72sS%7d\n", "Exact geometry, in millimeters.", 1);
  CagError io = {0};
  bool whole = append(file, s->global, &io);
  whole = append(file, s->directory, &io) && whole;
  whole = append(file, s->parameters, &io) && whole;
  char counts[80];
  snprintf(counts, sizeof counts, "S%7dG%7ldD%7ldP%7ld", 1, global, 2 * w->entities,
           w->parameter_lines);
  cag_atomic_file_printf(file, "%-72sT%7d\n", counts, 1);
  if (w->undefined && whole)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_not_finite, "", -1,
                    "a number in the file overflows or is undefined");
  return whole ? CAG_OK : cag_fail_memory(err);
}

CagStatus cag_export_iges(const CagBrep *brep, const char *script, CagAtomicFile *file,
                          CagError *err) {
  CagError io = {0};
  Sections s = {cag_atomic_file_open_memory(&io), cag_atomic_file_open_memory(&io),
                cag_atomic_file_open_memory(&io)};
  if (!s.global || !s.directory || !s.parameters) {
    abort_sections(&s);
    return cag_fail_memory(err);
  }
  Writer w = {.brep = brep};
  return write_sections(&w, &s, script && *script ? script : "scene", file, err);
}
