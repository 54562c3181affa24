// Writer of STEP files: one entity per line, numbered when it is written, after the entities to
// which it refers.

#include "interp/formats/step.h"

#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>

#include "base/assert.h"
#include "base/decimal.h"
#include "base/memory.h"

typedef size_t Id; // of an entity; 0: none

typedef struct Writer {
  const CagBrep *brep;
  CagAtomicFile *file;
  Id last;
  Id context, product_shape, placement;
  Id *point, *vertex, *edge, *surface; // points and vertex points of vertices, edge curves, and
                                       // surfaces of faces; 0: not written yet
  size_t *use_face;                    // the face of each use
  size_t *edge_use; // the uses, sorted by edges; those of edge i begin at edge_uses[i]
  size_t *edge_uses;
  Id plane_context; // of curves in the parameters of surfaces; 0: not written yet
  Id *styled;
  size_t styled_count, styled_room;
  bool faceted;   // of the current shape: directions need fewer digits
  bool failed;    // memory ran out
  bool undefined; // a number was not finite
} Writer;

// --- Text ---

static void put(Writer *w, const char *text) { cag_atomic_file_text(w->file, text); }

// Room for a number or an identifier.
#define VALUE_ROOM 40

static void put_id(Writer *w, Id id) {
  char *at = cag_atomic_file_reserve(w->file, VALUE_ROOM);
  *at++ = '#';
  cag_atomic_file_advance(w->file, cag_decimal_index(at, id));
}

// Writes text with values in place of %zu and %s, many times faster than printf.
static void put_values(Writer *w, const char *format, va_list args) {
  for (;;) {
    const size_t n = strcspn(format, "%");
    cag_atomic_file_write(w->file, format, n);
    format += n;
    if (!*format) return;
    if (format[1] == 's') {
      put(w, va_arg(args, const char *));
      format += strlen("%s");
    } else {
      CAG_ASSERT(strncmp(format, "%zu", 3) == 0);
      char *at = cag_atomic_file_reserve(w->file, VALUE_ROOM);
      cag_atomic_file_advance(w->file, cag_decimal_index(at, va_arg(args, size_t)));
      format += strlen("%zu");
    }
  }
}

// Reals contain a point, even with an exponent.
static void put_real(Writer *w, double x) {
  char text[40];
  w->undefined |= !isfinite(x);
  char *at = cag_atomic_file_reserve(w->file, VALUE_ROOM);
  char *last = cag_decimal_shortest(at, x == 0 ? 0 : x);
  if (last) {
    if (!memchr(at, '.', (size_t)(last - at))) *last++ = '.';
    cag_atomic_file_advance(w->file, last);
    return;
  }
  cag_number_text(x, text);
  char *e = strchr(text, 'e');
  if (e) *e++ = 0;
  put(w, text);
  if (!strchr(text, '.')) put(w, ".");
  if (e) {
    put(w, "E");
    put(w, e);
  }
}

// A component of a unit vector of a faceted shape. The error is far below the accuracy of the file,
// and the file is smaller and written faster.
static void put_short_real(Writer *w, double x) {
  w->undefined |= !isfinite(x);
  if (!isfinite(x)) return;
  char *at = cag_atomic_file_reserve(w->file, VALUE_ROOM);
  cag_atomic_file_advance(w->file, cag_decimal_fixed(at, x));
}

// Characters other than printable ASCII are written as code points.
static void put_code(Writer *w, unsigned long code) {
  cag_atomic_file_printf(w->file, code > 0xffff ? "\\X4\\%08lX\\X0\\" : "\\X2\\%04lX\\X0\\", code);
}

static const unsigned char *next_code(const unsigned char *p, unsigned long *code) {
  int more = *p < 0x80 ? 0 : *p < 0xe0 ? 1 : *p < 0xf0 ? 2 : 3;
  *code = more == 0 ? *p : *p & (0x3f >> more);
  for (p++; more > 0 && (*p & 0xc0) == 0x80; more--) *code = *code << 6 | (*p++ & 0x3f);
  return p;
}

static void put_string(Writer *w, const char *text) {
  put(w, "'");
  for (const unsigned char *p = (const unsigned char *)text; *p;) {
    unsigned long code;
    p = next_code(p, &code);
    if (code == '\'') put(w, "''");
    else if (code == '\\') put(w, "\\\\");
    else if (code >= 0x20 && code < 0x7f) cag_atomic_file_printf(w->file, "%c", (int)code);
    else put_code(w, code);
  }
  put(w, "'");
}

static Id begin(Writer *w, const char *head) {
  put_id(w, ++w->last);
  put(w, "=");
  put(w, head);
  return w->last;
}

static void end(Writer *w) { put(w, ");\n"); }

// An entity of text with values, which are %zu and %s.
static Id entity(Writer *w, const char *format, ...) __attribute__((format(printf, 2, 3)));
static Id entity(Writer *w, const char *format, ...) {
  va_list args;
  put_id(w, ++w->last);
  put(w, "=");
  va_start(args, format);
  put_values(w, format, args);
  va_end(args);
  put(w, ";\n");
  return w->last;
}

static void put_ids(Writer *w, const Id *ids, size_t n) {
  put(w, "(");
  for (size_t i = 0; i < n; i++) {
    if (i > 0) put(w, i % 10 == 0 ? ",\n" : ",");
    put_id(w, ids[i]);
  }
  put(w, ")");
}

static Id *take_ids(Writer *w, size_t n) {
  Id *ids = cag_calloc(n + 1, sizeof *ids);
  if (!ids) w->failed = true;
  return ids;
}

// --- Points and placements ---

static Id put_triple(Writer *w, const char *head, CagVec3 p) {
  Id id = begin(w, head);
  put_real(w, p.x);
  put(w, ",");
  put_real(w, p.y);
  put(w, ",");
  put_real(w, p.z);
  put(w, "));\n");
  return id;
}

static Id put_pair(Writer *w, const char *head, CagVec3 p) {
  Id id = begin(w, head);
  put_real(w, p.x);
  put(w, ",");
  put_real(w, p.y);
  put(w, "));\n");
  return id;
}

static Id point(Writer *w, CagVec3 p) { return put_triple(w, "CARTESIAN_POINT('',(", p); }

static Id direction(Writer *w, CagVec3 d) {
  if (!w->faceted) return put_triple(w, "DIRECTION('',(", d);
  const Id id = begin(w, "DIRECTION('',(");
  put_short_real(w, d.x);
  put(w, ",");
  put_short_real(w, d.y);
  put(w, ",");
  put_short_real(w, d.z);
  put(w, "));\n");
  return id;
}

static CagVec3 column(const CagTransform *t, int j) {
  return cag_vec3(t->m[0][j], t->m[1][j], t->m[2][j]);
}

static Id placement(Writer *w, const CagTransform *t) {
  Id at = point(w, column(t, 3)), z = direction(w, column(t, 2)), x = direction(w, column(t, 0));
  return entity(w, "AXIS2_PLACEMENT_3D('',#%zu,#%zu,#%zu)", at, z, x);
}

// --- NURBS ---

// Writes knots as multiplicities and distinct values.
static void put_multiplicities(Writer *w, const double *knots, size_t n) {
  put(w, "(");
  for (size_t i = 0, k; i < n; i = k) {
    for (k = i + 1; k < n && knots[k] == knots[i];) k++;
    cag_atomic_file_printf(w->file, i ? ",%zu" : "%zu", k - i);
  }
  put(w, ")");
}

static void put_distinct(Writer *w, const double *knots, size_t n) {
  put(w, "(");
  for (size_t i = 0; i < n; i++) {
    if (i > 0 && knots[i] == knots[i - 1]) continue;
    if (i > 0) put(w, ",");
    put_real(w, knots[i]);
  }
  put(w, ")");
}

static Id point_of(Writer *w, CagVec3 p, int dimension) {
  return dimension == 2 ? put_pair(w, "CARTESIAN_POINT('',(", p) : point(w, p);
}

static Id direction_of(Writer *w, CagVec3 d, int dimension) {
  return dimension == 2 ? put_pair(w, "DIRECTION('',(", d) : direction(w, d);
}

static Id *put_points(Writer *w, const double *h, size_t n, int dimension) {
  Id *ids = take_ids(w, n);
  for (size_t i = 0; ids && i < n; i++, h += 4)
    ids[i] = point_of(w, cag_vec3(h[0] / h[3], h[1] / h[3], h[2] / h[3]), dimension);
  return ids;
}

static void put_weights(Writer *w, const double *h, size_t n) {
  put(w, "(");
  for (size_t i = 0; i < n; i++) {
    if (i > 0) put(w, ",");
    put_real(w, h[4 * i + 3]);
  }
  put(w, ")");
}

static const char *logical(bool b) { return b ? ".T." : ".F."; }

static Id nurbs_curve(Writer *w, const CagCurve *c) {
  CagNurbsView v = {0};
  cag_curve_nurbs_view(c, &v);
  Id *ids = put_points(w, v.homogeneous, v.count, c->dimension);
  if (!ids) return 0;
  size_t knots = v.count + (size_t)v.degree + 1;
  Id id =
      begin(w, v.rational ? "(BOUNDED_CURVE()B_SPLINE_CURVE(" : "B_SPLINE_CURVE_WITH_KNOTS('',");
  cag_atomic_file_printf(w->file, "%d,", v.degree);
  put_ids(w, ids, v.count);
  cag_atomic_file_printf(w->file, ",.UNSPECIFIED.,%s,.F.", logical(c->closed));
  put(w, v.rational ? ")B_SPLINE_CURVE_WITH_KNOTS(" : ",");
  put_multiplicities(w, v.knots, knots);
  put(w, ",");
  put_distinct(w, v.knots, knots);
  put(w, ",.UNSPECIFIED.)");
  if (v.rational) {
    put(w, "CURVE()GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_CURVE(");
    put_weights(w, v.homogeneous, v.count);
    put(w, ")REPRESENTATION_ITEM(''))");
  }
  put(w, ";\n");
  cag_free(ids);
  return id;
}

static void put_rows(Writer *w, const CagSurfaceNurbsView *v, const Id *ids) {
  put(w, "(");
  for (size_t i = 0; i < v->nu; i++) {
    if (i > 0) put(w, ",\n");
    if (ids) put_ids(w, ids + i * v->nv, v->nv);
    else put_weights(w, v->homogeneous + 4 * i * v->nv, v->nv);
  }
  put(w, ")");
}

static Id nurbs_surface(Writer *w, const CagSurface *s) {
  CagSurfaceNurbsView v = {0};
  cag_surface_nurbs_view(s, &v);
  Id *ids = put_points(w, v.homogeneous, v.nu * v.nv, 3);
  if (!ids) return 0;
  size_t knots_u = v.nu + (size_t)v.degree_u + 1, knots_v = v.nv + (size_t)v.degree_v + 1;
  Id id = begin(w, v.rational ? "(BOUNDED_SURFACE()B_SPLINE_SURFACE("
                              : "B_SPLINE_SURFACE_WITH_KNOTS('',");
  cag_atomic_file_printf(w->file, "%d,%d,", v.degree_u, v.degree_v);
  put_rows(w, &v, ids);
  cag_atomic_file_printf(w->file, ",.UNSPECIFIED.,%s,%s,.F.", logical(s->closed_u),
                         logical(s->closed_v));
  put(w, v.rational ? ")B_SPLINE_SURFACE_WITH_KNOTS(" : ",");
  put_multiplicities(w, v.knots_u, knots_u);
  put(w, ",");
  put_multiplicities(w, v.knots_v, knots_v);
  put(w, ",");
  put_distinct(w, v.knots_u, knots_u);
  put(w, ",");
  put_distinct(w, v.knots_v, knots_v);
  put(w, ",.UNSPECIFIED.)");
  if (v.rational) {
    put(w, "GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_SURFACE(");
    put_rows(w, &v, NULL);
    put(w, ")REPRESENTATION_ITEM('')SURFACE())");
  }
  put(w, ";\n");
  cag_free(ids);
  return id;
}

// A line from a point of the file. The unit of its parameter is the millimeter.
static Id line(Writer *w, Id at, CagVec3 from, CagVec3 to) {
  const Id along = direction(w, cag_unit(cag_sub(to, from)));
  const Id vector = entity(w, "VECTOR('',#%zu,1.)", along);
  return entity(w, "LINE('',#%zu,#%zu)", at, vector);
}

// A circle, or an ellipse. In space, the first semi-axis of an ellipse is the longer one.
static Id conic(Writer *w, double a, double b, const CagTransform *t, int dimension) {
  const CagVec3 x = column(t, 0), y = column(t, 1);
  const bool turned = dimension == 3 && a < b;
  const Id at = point_of(w, column(t, 3), dimension);
  const Id up = dimension == 3 ? direction(w, cag_cross(x, y)) : 0;
  const Id along = direction_of(w, turned ? y : x, dimension);
  const Id place = dimension == 3
                       ? entity(w, "AXIS2_PLACEMENT_3D('',#%zu,#%zu,#%zu)", at, up, along)
                       : entity(w, "AXIS2_PLACEMENT_2D('',#%zu,#%zu)", at, along);
  Id id = begin(w, a == b ? "CIRCLE(''," : "ELLIPSE('',");
  put_id(w, place);
  put(w, ",");
  put_real(w, turned ? b : a);
  if (a != b) {
    put(w, ",");
    put_real(w, turned ? a : b);
  }
  end(w);
  return id;
}

// A line with the parameter of the curve: its point at 0, and its speed.
static Id timed_line(Writer *w, const CagCurve *c) {
  CagNurbsView v = {0};
  cag_curve_nurbs_view(c, &v);
  const double *a = v.homogeneous, *b = a + 4 * (v.count - 1);
  const CagVec3 p = cag_vec3(a[0] / a[3], a[1] / a[3], a[2] / a[3]);
  const CagVec3 q = cag_vec3(b[0] / b[3], b[1] / b[3], b[2] / b[3]);
  const CagVec3 speed = cag_scaled(cag_sub(q, p), 1 / (c->end - c->start));
  const Id at = point_of(w, cag_madd(p, -c->start, speed), c->dimension);
  const Id along = direction_of(w, cag_unit(speed), c->dimension);
  Id vector = begin(w, "VECTOR('',");
  put_id(w, along);
  put(w, ",");
  put_real(w, cag_norm(speed));
  end(w);
  return entity(w, "LINE('',#%zu,#%zu)", at, vector);
}

static Id any_curve(Writer *w, const CagCurve *c) {
  double a, b;
  CagTransform frame;
  CagNurbsView v;
  if (cag_curve_arc_view(c, &a, &b, &frame)) return conic(w, a, b, &frame, c->dimension);
  if (cag_curve_nurbs_view(c, &v) && v.degree == 1 && v.count == 2) return timed_line(w, c);
  return nurbs_curve(w, c);
}

// --- Carriers ---

// The same cone with a positive angle: both axes point the other way.
static CagCarrier with_positive_angle(const CagCarrier *c) {
  CagCarrier out = *c;
  if (!(c->b < 0)) return out;
  out.b = -c->b;
  for (int i = 0; i < 3; i++)
    for (int j = 1; j < 3; j++) out.frame.m[i][j] = -c->frame.m[i][j];
  return out;
}

static Id elementary(Writer *w, const char *head, const CagCarrier *c, int numbers) {
  const Id place = placement(w, &c->frame);
  const double number[2] = {c->a, c->b};
  Id id = begin(w, head);
  put_id(w, place);
  for (int i = 0; i < numbers; i++) {
    put(w, ",");
    put_real(w, number[i]);
  }
  end(w);
  return id;
}

static Id swept(Writer *w, const CagCarrier *c) {
  const Id curve = any_curve(w, c->profile), z = direction(w, column(&c->frame, 2));
  if (c->kind == CAG_CARRIER_EXTRUDED) {
    const Id vector = entity(w, "VECTOR('',#%zu,1.)", z);
    return entity(w, "SURFACE_OF_LINEAR_EXTRUSION('',#%zu,#%zu)", curve, vector);
  }
  const Id at = point(w, column(&c->frame, 3));
  const Id axis = entity(w, "AXIS1_PLACEMENT('',#%zu,#%zu)", at, z);
  return entity(w, "SURFACE_OF_REVOLUTION('',#%zu,#%zu)", curve, axis);
}

static Id carrier(Writer *w, const CagCarrier *c) {
  const CagCarrier cone = c->kind == CAG_CARRIER_CONE ? with_positive_angle(c) : *c;
  switch (c->kind) {
  case CAG_CARRIER_PLANE: return elementary(w, "PLANE('',", c, 0);
  case CAG_CARRIER_CYLINDER: return elementary(w, "CYLINDRICAL_SURFACE('',", c, 1);
  case CAG_CARRIER_CONE: return elementary(w, "CONICAL_SURFACE('',", &cone, 2);
  case CAG_CARRIER_SPHERE: return elementary(w, "SPHERICAL_SURFACE('',", c, 1);
  case CAG_CARRIER_TORUS: return elementary(w, "TOROIDAL_SURFACE('',", c, 2);
  case CAG_CARRIER_SPLINE: return nurbs_surface(w, c->spline);
  default: return swept(w, c);
  }
}

// --- Topology ---

static Id vertex(Writer *w, size_t index) {
  if (w->vertex[index]) return w->vertex[index];
  w->point[index] = point(w, w->brep->vertices[index]);
  return w->vertex[index] = entity(w, "VERTEX_POINT('',#%zu)", w->point[index]);
}

static Id face_surface(Writer *w, size_t index) {
  const CagBrepFace *f = &w->brep->faces[index];
  if (!w->surface[index])
    w->surface[index] = f->carrier.kind ? carrier(w, &f->carrier)
                        : f->flat ? entity(w, "PLANE('',#%zu)", placement(w, &f->carrier.frame))
                                  : nurbs_surface(w, f->surface);
  return w->surface[index];
}

// Whether a trace can be written: arcs in the parameters turn to the left only.
static bool has_trace(const Writer *w, const CagBrepUse *use, size_t face) {
  double a, b;
  CagTransform t;
  const CagCarrier *c = &w->brep->faces[face].carrier;
  if (!use->trace || c->kind == CAG_CARRIER_PLANE) return false;
  return !cag_curve_arc_view(use->trace, &a, &b, &t) ||
         t.m[0][0] * t.m[1][1] - t.m[0][1] * t.m[1][0] > 0;
}

// Cones of STEP files measure v along the axis, not along the side.
static Id trace(Writer *w, const CagBrepUse *use, size_t face) {
  const CagCarrier *c = &w->brep->faces[face].carrier;
  CagTransform turn = cag_transform_identity();
  CagCurve *own = cag_curve_retain(use->trace);
  CagError ignored;
  if (c->kind == CAG_CARRIER_CONE) {
    const double sign = c->b < 0 ? -1 : 1; // see with_positive_angle
    turn.m[0][0] = sign;
    turn.m[1][1] = sign * cos(c->b);
    cag_curve_release(own);
    w->failed |= cag_curve_transform(use->trace, &turn, &own, &ignored) != CAG_OK;
    if (w->failed) return 0;
  }
  const Id surface = face_surface(w, face), curve = any_curve(w, own);
  cag_curve_release(own);
  if (!w->plane_context)
    w->plane_context = entity(w, "(GEOMETRIC_REPRESENTATION_CONTEXT(2)"
                                 "PARAMETRIC_REPRESENTATION_CONTEXT()"
                                 "REPRESENTATION_CONTEXT('parameters',''))");
  const Id drawn =
      entity(w, "DEFINITIONAL_REPRESENTATION('',(#%zu),#%zu)", curve, w->plane_context);
  return entity(w, "PCURVE('',#%zu,#%zu)", surface, drawn);
}

// Adds the curves of an edge in the parameters of its faces, without which a reader would have to
// find out how a face that runs around its carrier, or through a pole, continues. A seam needs both.
static Id with_traces(Writer *w, size_t index, Id curve) {
  Id ids[2];
  size_t faces[2], n = 0;
  for (size_t k = w->edge_uses[index]; k < w->edge_uses[index + 1] && n < 2; k++) {
    const size_t use = w->edge_use[k], face = w->use_face[use];
    if (!has_trace(w, &w->brep->uses[use], face)) continue;
    faces[n] = face;
    ids[n++] = trace(w, &w->brep->uses[use], face);
  }
  if (n == 0) return curve;
  // The first trace of a seam is that of the use along the edge.
  if (n == 2 && faces[0] == faces[1] && w->brep->uses[w->edge_use[w->edge_uses[index]]].reversed) {
    const Id first = ids[0];
    ids[0] = ids[1];
    ids[1] = first;
  }
  const bool seam = n == 2 && faces[0] == faces[1];
  Id id = begin(w, seam ? "SEAM_CURVE(''," : "SURFACE_CURVE('',");
  put_id(w, curve);
  put(w, ",");
  put_ids(w, ids, n);
  put(w, ",.CURVE_3D.);\n");
  return id;
}

static Id edge(Writer *w, size_t index) {
  if (w->edge[index]) return w->edge[index];
  const CagBrepEdge *e = &w->brep->edges[index];
  Id from = vertex(w, e->from), to = vertex(w, e->to);
  Id curve = e->straight && !e->timed
                 ? line(w, w->point[e->from], w->brep->vertices[e->from], w->brep->vertices[e->to])
                 : any_curve(w, e->curve);
  curve = with_traces(w, index, curve);
  return w->edge[index] = entity(w, "EDGE_CURVE('',#%zu,#%zu,#%zu,.T.)", from, to, curve);
}

// A loop around a pole alone is a vertex. Other loops leave degenerate edges out.
static Id edge_loop(Writer *w, const CagBrepLoop *l) {
  Id *ids = take_ids(w, l->count);
  if (!ids) return 0;
  size_t n = 0;
  for (size_t i = 0; i < l->count; i++) {
    const CagBrepUse *use = &w->brep->uses[l->first + i];
    if (cag_brep_is_degenerate(&w->brep->edges[use->edge])) continue;
    ids[n++] =
        entity(w, "ORIENTED_EDGE('',*,*,#%zu,%s)", edge(w, use->edge), logical(!use->reversed));
  }
  Id id;
  if (n == 0) {
    id = entity(w, "VERTEX_LOOP('',#%zu)",
                vertex(w, w->brep->edges[w->brep->uses[l->first].edge].from));
  } else {
    id = begin(w, "EDGE_LOOP('',");
    put_ids(w, ids, n);
    end(w);
  }
  cag_free(ids);
  return id;
}

static Id face(Writer *w, const CagBrepFace *f) {
  Id *bounds = take_ids(w, f->count);
  if (!bounds) return 0;
  for (size_t i = 0; i < f->count; i++) {
    Id loop = edge_loop(w, &w->brep->loops[f->first + i]);
    bounds[i] = entity(w, "%s('',#%zu,.T.)", i == 0 ? "FACE_OUTER_BOUND" : "FACE_BOUND", loop);
  }
  Id surface = face_surface(w, (size_t)(f - w->brep->faces));
  Id id = begin(w, "ADVANCED_FACE('',");
  put_ids(w, bounds, f->count);
  put(w, ",");
  put_id(w, surface);
  put(w, f->reversed ? ",.F.);\n" : ",.T.);\n");
  cag_free(bounds);
  return id;
}

static Id shell(Writer *w, const CagBrepShell *s, bool closed) {
  Id *faces = take_ids(w, s->count);
  if (!faces) return 0;
  for (size_t i = 0; i < s->count && !cag_atomic_file_failed(w->file); i++)
    faces[i] = face(w, &w->brep->faces[s->first + i]);
  Id id = begin(w, closed ? "CLOSED_SHELL(''," : "OPEN_SHELL('',");
  put_ids(w, faces, s->count);
  end(w);
  cag_free(faces);
  return id;
}

// Writes a solid from the shell and its cavities, whose normals also point out of the material.
static Id solid(Writer *w, const CagBrepShape *shape, size_t outer) {
  const CagBrep *b = w->brep;
  Id *hollow = take_ids(w, shape->count);
  if (!hollow) return 0;
  size_t n = 0;
  for (size_t i = shape->first; i < shape->first + shape->count; i++)
    if (i != outer && b->shells[i].void_of == outer) {
      Id inner = shell(w, &b->shells[i], true);
      hollow[n++] = entity(w, "ORIENTED_CLOSED_SHELL('',*,#%zu,.T.)", inner);
    }
  Id around = shell(w, &b->shells[outer], true);
  Id id = begin(w, n ? "BREP_WITH_VOIDS(" : "MANIFOLD_SOLID_BREP(");
  put_string(w, shape->name);
  put(w, ",");
  put_id(w, around);
  if (n) {
    put(w, ",");
    put_ids(w, hollow, n);
  }
  end(w);
  cag_free(hollow);
  return id;
}

static Id sheet(Writer *w, const CagBrepShape *shape) {
  Id *shells = take_ids(w, shape->count);
  if (!shells) return 0;
  for (size_t i = 0; i < shape->count; i++)
    shells[i] = shell(w, &w->brep->shells[shape->first + i], false);
  Id id = begin(w, "SHELL_BASED_SURFACE_MODEL(");
  put_string(w, shape->name);
  put(w, ",");
  put_ids(w, shells, shape->count);
  end(w);
  cag_free(shells);
  return id;
}

// Writes a separate curve set, which can have a name and a color.
static Id curve_set(Writer *w, const CagBrepShape *shape) {
  Id curve = nurbs_curve(w, shape->curve);
  Id id = begin(w, "GEOMETRIC_CURVE_SET(");
  put_string(w, shape->name);
  put(w, ",");
  put_ids(w, &curve, 1);
  end(w);
  return id;
}

// --- Colors ---

// Writes a color component in sRGB, which viewers expect, to 5 decimals.
static void put_share(Writer *w, double linear) {
  put_real(w, round(1e5 * cag_linear_to_srgb(fmin(fmax(linear, 0), 1))) / 1e5);
}

static Id color(Writer *w, CagColor c) {
  Id id = begin(w, "COLOUR_RGB('',");
  put_share(w, c.r);
  put(w, ",");
  put_share(w, c.g);
  put(w, ",");
  put_share(w, c.b);
  end(w);
  return id;
}

static void style(Writer *w, Id item, const CagBrepShape *shape) {
  Id paint = color(w, shape->material->color), use;
  if (shape->kind == CAG_BREP_CURVE) {
    Id font = entity(w, "DRAUGHTING_PRE_DEFINED_CURVE_FONT('continuous')");
    use = entity(w, "CURVE_STYLE('',#%zu,POSITIVE_LENGTH_MEASURE(0.1),#%zu)", font, paint);
  } else {
    Id fill = entity(w, "FILL_AREA_STYLE_COLOUR('',#%zu)", paint);
    Id area = entity(w, "FILL_AREA_STYLE('',(#%zu))", fill);
    Id side = entity(w, "SURFACE_SIDE_STYLE('',(#%zu))",
                     entity(w, "SURFACE_STYLE_FILL_AREA(#%zu)", area));
    use = entity(w, "SURFACE_STYLE_USAGE(.BOTH.,#%zu)", side);
  }
  Id assigned = entity(w, "PRESENTATION_STYLE_ASSIGNMENT((#%zu))", use);
  Id styled = entity(w, "STYLED_ITEM('color',(#%zu),#%zu)", assigned, item);
  if (w->styled_count < w->styled_room) w->styled[w->styled_count++] = styled;
}

// --- Representations ---

typedef struct Items {
  Id *ids;
  size_t count;
} Items;

static void add(Writer *w, Items *items, const CagBrepShape *shape, Id id) {
  items->ids[items->count++] = id;
  style(w, id, shape);
}

static void write_shapes(Writer *w, CagBrepKind kind, Items *items) {
  const CagBrep *b = w->brep;
  for (size_t i = 0; i < b->shape_count && !cag_atomic_file_failed(w->file); i++) {
    const CagBrepShape *s = &b->shapes[i];
    if (s->kind != kind) continue;
    if (kind == CAG_BREP_CURVE) add(w, items, s, curve_set(w, s));
    if (kind == CAG_BREP_SHEET) add(w, items, s, sheet(w, s));
    w->faceted = s->facets > 0;
    for (size_t k = s->first; kind == CAG_BREP_SOLID && k < s->first + s->count; k++)
      if (b->shells[k].void_of == k) add(w, items, s, solid(w, s, k));
    w->faceted = false;
  }
}

static Id representation(Writer *w, const char *type, const Items *items) {
  Id id = begin(w, type);
  put(w, "('',");
  put_ids(w, items->ids, items->count);
  cag_atomic_file_printf(w->file, ",#%zu);\n", w->context);
  return id;
}

// X(kind, representation): each kind of shape has its own representation, to which the product's
// refers.
#define REPRESENTATIONS(X)                                                                         \
  X(CAG_BREP_SOLID, "ADVANCED_BREP_SHAPE_REPRESENTATION")                                          \
  X(CAG_BREP_SHEET, "MANIFOLD_SURFACE_SHAPE_REPRESENTATION")                                       \
  X(CAG_BREP_CURVE, "GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION")

static void write_representation(Writer *w, CagBrepKind kind, const char *type, Id main) {
  Items items = {take_ids(w, w->brep->shape_count + w->brep->shell_count + 1), 0};
  if (!items.ids) return;
  write_shapes(w, kind, &items);
  if (items.count > 0) {
    items.ids[items.count++] = w->placement;
    Id r = representation(w, type, &items);
    entity(w, "SHAPE_REPRESENTATION_RELATIONSHIP('','',#%zu,#%zu)", main, r);
  }
  cag_free(items.ids);
}

static void write_product(Writer *w, const char *name) {
  Id application =
      entity(w, "APPLICATION_CONTEXT('core data for automotive mechanical design processes')");
  entity(w,
         "APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000,#%zu)",
         application);
  Id product_context = entity(w, "PRODUCT_CONTEXT('',#%zu,'mechanical')", application);
  Id product = begin(w, "PRODUCT(");
  put_string(w, name);
  put(w, ",");
  put_string(w, name);
  cag_atomic_file_printf(w->file, ",'',(#%zu));\n", product_context);
  entity(w, "PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,(#%zu))", product);
  Id formation = entity(w, "PRODUCT_DEFINITION_FORMATION('','',#%zu)", product);
  Id design = entity(w, "PRODUCT_DEFINITION_CONTEXT('part definition',#%zu,'design')", application);
  Id definition = entity(w, "PRODUCT_DEFINITION('design','',#%zu,#%zu)", formation, design);
  w->product_shape = entity(w, "PRODUCT_DEFINITION_SHAPE('','',#%zu)", definition);
}

static void write_context(Writer *w) {
  Id length = entity(w, "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))");
  Id angle = entity(w, "(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
  Id solid_angle = entity(w, "(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())");
  Id accuracy = begin(w, "UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(");
  put_real(w, w->brep->accuracy);
  cag_atomic_file_printf(w->file, "),#%zu,'distance_accuracy_value','');\n", length);
  w->context = entity(w,
                      "(GEOMETRIC_REPRESENTATION_CONTEXT(3)"
                      "GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#%zu))"
                      "GLOBAL_UNIT_ASSIGNED_CONTEXT((#%zu,#%zu,#%zu))"
                      "REPRESENTATION_CONTEXT('',''))",
                      accuracy, length, angle, solid_angle);
}

// Finds the faces of the uses, and the uses of the edges.
static void index_uses(Writer *w) {
  const CagBrep *b = w->brep;
  for (size_t f = 0; f < b->face_count; f++)
    for (size_t l = b->faces[f].first; l < b->faces[f].first + b->faces[f].count; l++)
      for (size_t u = b->loops[l].first; u < b->loops[l].first + b->loops[l].count; u++)
        w->use_face[u] = f;
  for (size_t u = 0; u < b->use_count; u++) w->edge_uses[b->uses[u].edge + 1]++;
  for (size_t e = 0; e < b->edge_count; e++) w->edge_uses[e + 1] += w->edge_uses[e];
  for (size_t u = b->use_count; u-- > 0;) w->edge_use[--w->edge_uses[b->uses[u].edge + 1]] = u;
  // Each start has moved to that of the edge before.
  memmove(w->edge_uses, w->edge_uses + 1, b->edge_count * sizeof *w->edge_uses);
  w->edge_uses[b->edge_count] = b->use_count;
}

static void write_data(Writer *w, const char *name) {
  write_product(w, name);
  write_context(w);
  CagTransform world = cag_transform_identity();
  w->placement = placement(w, &world);
  Items here = {&w->placement, 1};
  Id main = representation(w, "SHAPE_REPRESENTATION", &here);
  entity(w, "SHAPE_DEFINITION_REPRESENTATION(#%zu,#%zu)", w->product_shape, main);
#define X(kind, type) write_representation(w, kind, type, main);
  REPRESENTATIONS(X)
#undef X
  Items styled = {w->styled, w->styled_count};
  if (styled.count > 0)
    representation(w, "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION", &styled);
}

// There is no date, so that the output is reproducible.
static void write_header(Writer *w, const char *name) {
  put(w, "ISO-10303-21;\nHEADER;\n");
  put(w, "FILE_DESCRIPTION(('exact geometry'),'2;1');\nFILE_NAME(");
  put_string(w, name);
  put(w, ",'1970-01-01T00:00:00',(''),(''),'cag " CAG_VERSION "','cag " CAG_VERSION "','');\n");
  put(w, "FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));\nENDSEC;\nDATA;\n");
}

CagStatus cag_export_step(const CagBrep *brep, const char *script, CagAtomicFile *file,
                          CagError *err) {
  Writer w = {.brep = brep, .file = file};
  w.point = cag_calloc(brep->vertex_count + 1, sizeof *w.point);
  w.vertex = cag_calloc(brep->vertex_count + 1, sizeof *w.vertex);
  w.edge = cag_calloc(brep->edge_count + 1, sizeof *w.edge);
  w.surface = cag_calloc(brep->face_count + 1, sizeof *w.surface);
  w.use_face = cag_calloc(brep->use_count + 1, sizeof *w.use_face);
  w.edge_use = cag_calloc(brep->use_count + 1, sizeof *w.edge_use);
  w.edge_uses = cag_calloc(brep->edge_count + 2, sizeof *w.edge_uses);
  w.styled_room = brep->shape_count + brep->shell_count;
  w.styled = cag_calloc(w.styled_room + 1, sizeof *w.styled);
  if (!w.point || !w.vertex || !w.edge || !w.surface || !w.use_face || !w.edge_use ||
      !w.edge_uses || !w.styled) {
    w.failed = true;
  } else {
    const char *name = script && *script ? script : "scene";
    index_uses(&w);
    write_header(&w, name);
    write_data(&w, name);
    put(&w, "ENDSEC;\nEND-ISO-10303-21;\n");
  }
  cag_free(w.point);
  cag_free(w.vertex);
  cag_free(w.edge);
  cag_free(w.surface);
  cag_free(w.use_face);
  cag_free(w.edge_use);
  cag_free(w.edge_uses);
  cag_free(w.styled);
  if (w.undefined && !w.failed)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_not_finite, "", -1,
                    "a number in the file overflows or is undefined");
  return w.failed ? cag_fail_memory(err) : CAG_OK;
}
