// Quadrics: by their ten numbers, by rows, and by name.

#include <math.h>
#include <string.h>

#include "geom/surface/trimmed.h"
#include "interp/builtin/solids.h"
#include "interp/builtin/support.h"
#include "interp/builtin/surfaces.h"

// --- Where an unbounded one ends: a box (a solid whose bounds count) or a range of z ---

static bool read_within(CagCall *call, int argument, CagBounds *box, bool *z_only, bool *given) {
  CagValue v = call->values[argument];
  *given = cag_given(call, argument);
  *z_only = false;
  *box = (CagBounds){{-INFINITY, -INFINITY, -INFINITY}, {INFINITY, INFINITY, INFINITY}};
  if (!*given) return true;
  if (v.type == CAG_SOLID)
    return cag_geometry_ok(call, cag_solid_bounds(CAG_AS_SHAPE(v)->as.solid, box, call->err));
  if (v.type != CAG_RANGE) {
    cag_fail_type(call, argument, "a box or a range of z");
    return cag_fail_help(call->vm,
                         "write within: box([4, 4, 4], centered: true), or within: -2..2");
  }
  bool angle;
  *z_only = true;
  if (!cag_arg_interval(call, argument, &box->min.z, &box->max.z, &angle)) return false;
  if (angle) return cag_fail_type(call, argument, "a box or a range of z");
  return box->min.z < box->max.z || cag_fail_value(call, argument, "an increasing range of z");
}

// One surface, or a group of the sheets or planes.
static bool give_patches(CagCall *call, const CagQuadric *q, int within, CagValue *result) {
  CagBounds box;
  bool z_only, given;
  if (!read_within(call, within, &box, &z_only, &given)) return false;
  CagSurfaceArray *patches = cag_hold_surfaces(call);
  CagStatus status = cag_quadric_patches(q, given ? &box : NULL, z_only, &patches->items,
                                         &patches->count, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = 0; i < patches->count; i++)
    cag_builder_add(call->vm, list,
                    cag_surface_value(call->vm, cag_surface_retain(patches->items[i])));
  return cag_shapes_result(call, list, result);
}

// --- By numbers ---

// Ten that are not all numbers, or neither ten nor four.
static bool fail_equation(CagCall *call, const CagList *list) {
  for (size_t i = 0; list->length == 10 && i < 10; i++) {
    CagValue v = cag_list_get(call->vm, list, i);
    if (v.type != CAG_NUMBER) return cag_fail_element(call, 0, i, v, "10 numbers");
  }
  return cag_fail_call(call, 0, CAG_ERR_type,
                       "expects the 10 numbers of a x^2 + b y^2 + c z^2 + d xy + e yz + f xz + "
                       "g x + h y + j z + k = 0, or 4 rows of 4; found a list of %zu",
                       list->length);
}

bool cag_surfaces_read_form(CagCall *call, CagQuadric *q) {
  CagList *list;
  double rows[4][4];
  const double *x;
  size_t n;
  if (!cag_arg_list(call, 0, &list)) return false;
  if (cag_as_vector(cag_object(CAG_LIST, list), &x, &n) && n == 10) {
    memcpy(q->c, x, sizeof q->c);
    return true;
  }
  if (list->length != 4) return fail_equation(call, list);
  for (size_t i = 0; i < 4; i++) {
    CagValue row = cag_list_get(call->vm, list, i);
    if (!cag_as_vector(row, &x, &n) || n != 4)
      return cag_fail_element(call, 0, i, row, "4 rows of 4 numbers, or 10 numbers,");
    memcpy(rows[i], x, sizeof rows[i]);
  }
  return cag_geometry_ok(call, cag_quadric_from_rows(rows, q, call->err));
}

bool cag_surfaces_quadric(CagCall *call, CagValue *result) {
  CagQuadric q;
  return cag_surfaces_read_form(call, &q) && give_patches(call, &q, 1, result);
}

// --- By name: alpha x^2 + beta y^2 + gamma z^2 + linear terms + k ---

static double inverse_square(double x) { return 1 / (x * x); }

bool cag_surfaces_ellipsoid(CagCall *call, const struct cag_surfaces_ellipsoid *a,
                            CagValue *result) {
  const CagQuadric q = {
      {inverse_square(a->a), inverse_square(a->b), inverse_square(a->c), 0, 0, 0, 0, 0, 0, -1}};
  return give_patches(call, &q, 3, result);
}

bool cag_surfaces_hyperboloid(CagCall *call, const struct cag_surfaces_hyperboloid *a,
                              CagValue *result) {
  const CagQuadric q = {{inverse_square(a->a), inverse_square(a->b), -inverse_square(a->c), 0, 0, 0,
                         0, 0, 0, a->sheets == 1 ? -1 : 1}};
  return give_patches(call, &q, 4, result);
}

bool cag_surfaces_elliptic_cone(CagCall *call, const struct cag_surfaces_elliptic_cone *a,
                                CagValue *result) {
  const CagQuadric q = {
      {inverse_square(a->a), inverse_square(a->b), -inverse_square(a->c), 0, 0, 0, 0, 0, 0, 0}};
  return give_patches(call, &q, 3, result);
}

// x^2/a^2 + sign y^2/b^2 + j z + k = 0
static bool two_axes(CagCall *call, double a, double b, double sign, double j, double k,
                     CagValue *result) {
  const CagQuadric q = {{inverse_square(a), sign * inverse_square(b), 0, 0, 0, 0, 0, 0, j, k}};
  return give_patches(call, &q, 2, result);
}

bool cag_surfaces_paraboloid(CagCall *call, const struct cag_surfaces_paraboloid *a,
                             CagValue *result) {
  return two_axes(call, a->a, a->b, 1, -1, 0, result);
}

bool cag_surfaces_hyperbolic_paraboloid(CagCall *call,
                                        const struct cag_surfaces_hyperbolic_paraboloid *a,
                                        CagValue *result) {
  return two_axes(call, a->a, a->b, -1, -1, 0, result);
}

bool cag_surfaces_elliptic_cylinder(CagCall *call, const struct cag_surfaces_elliptic_cylinder *a,
                                    CagValue *result) {
  return two_axes(call, a->a, a->b, 1, 0, -1, result);
}

bool cag_surfaces_hyperbolic_cylinder(CagCall *call,
                                      const struct cag_surfaces_hyperbolic_cylinder *a,
                                      CagValue *result) {
  return two_axes(call, a->a, a->b, -1, 0, -1, result);
}

bool cag_surfaces_parabolic_cylinder(CagCall *call, const struct cag_surfaces_parabolic_cylinder *a,
                                     CagValue *result) {
  return give_patches(call, &(CagQuadric){{0, 1, 0, 0, 0, 0, -4 * a->a, 0, 0, 0}}, 1, result);
}

// --- Classification ---

// The ball as an equation, negative inside.
static bool sphere_equation(CagCall *call, const CagSolid *s, CagQuadric *q) {
  CagQuadric own = {{1, 1, 1, 0, 0, 0, 0, 0, 0, -s->a * s->a}};
  return cag_geometry_ok(call, cag_quadric_transform(&own, &s->placement, q, call->err));
}

// Places on a meridian at which it must be as far from the center as at its ends.
#define MERIDIAN_PROBES 9
#define ON_SPHERE 1e-12 // part of the radius

// The equation of a surface of revolution whose meridian is an arc about a point of the axis.
static bool turned_sphere(const CagSurface *s, CagQuadric *q) {
  const CagCurve *meridian;
  CagVec3 axis, through, d[2], p;
  CagError ignored;
  if (!cag_surface_revolution_view(s, &meridian, &axis, &through, NULL, NULL)) return false;
  const double t[2] = {meridian->start, meridian->end};
  for (int i = 0; i < 2; i++) {
    if (cag_curve_point(meridian, t[i], &p, &ignored)) return false;
    d[i] = cag_sub(p, through);
  }
  const double rise = cag_dot(cag_sub(d[1], d[0]), cag_unit(axis));
  const double along = (cag_dot(d[1], d[1]) - cag_dot(d[0], d[0])) / (2 * rise);
  if (!isfinite(along)) return false;
  const CagVec3 c = cag_madd(through, along, cag_unit(axis));
  const double radius = cag_norm(cag_sub(cag_add(through, d[0]), c));
  for (int i = 1; i <= MERIDIAN_PROBES; i++) {
    const double at = t[0] + (t[1] - t[0]) * i / (MERIDIAN_PROBES + 1);
    if (cag_curve_point(meridian, at, &p, &ignored) ||
        !(fabs(cag_norm(cag_sub(p, c)) - radius) <= ON_SPHERE * radius))
      return false;
  }
  *q = (CagQuadric){
      {1, 1, 1, 0, 0, 0, -2 * c.x, -2 * c.y, -2 * c.z, cag_dot(c, c) - radius * radius}};
  return true;
}

bool cag_arg_quadric(CagCall *call, CagQuadric *q) {
  CagValue v = call->values[0];
  if (v.type == CAG_LIST) return cag_surfaces_read_form(call, q);
  if (v.type == CAG_GROUP && CAG_AS_SHAPE(v)->as.items->length > 0)
    v = cag_list_get(call->vm, CAG_AS_SHAPE(v)->as.items, 0);
  if (v.type == CAG_SURFACE) {
    const CagSurface *whole = CAG_AS_SHAPE(v)->as.surface;
    cag_surface_trimmed_view(whole, &whole, NULL);
    if (cag_surface_quadric_view(whole, q) || turned_sphere(whole, q)) return true;
  }
  if (v.type == CAG_SOLID && CAG_AS_SHAPE(v)->as.solid->kind == CAG_SOLID_SPHERE)
    return sphere_equation(call, CAG_AS_SHAPE(v)->as.solid, q);
  const char *kind =
      v.type == CAG_SURFACE ? CAG_AS_SHAPE(v)->as.surface->kind->name : cag_type_name(v);
  return cag_geometry_ok(
      call, cag_fail(call->err, CAG_E_UNSUPPORTED, CAG_ERR_not_a_quadric, "", -1,
                     "expects a quadric, a sphere, or the 10 numbers or 4 rows of one, found %s %s",
                     cag_article(kind), kind));
}

bool cag_surfaces_classify(CagCall *call, CagValue *result) {
  static const char *const names[] = {"class", "frame", "center", "semi_axes", "rank3", "rank4"};
  CagQuadric q;
  CagQuadricForm form;
  if (!cag_arg_quadric(call, &q) ||
      !cag_geometry_ok(call, cag_quadric_classify(&q, &form, call->err)))
    return false;
  CagTransform frame = form.frame;
  frame.planar = false;
  CagValue values[] = {cag_text_c(call->vm, form.name),
                       cag_transform_value(call->vm, &frame),
                       form.has_center ? cag_point(call->vm, form.center, 3) : cag_none(),
                       cag_vector(call->vm, form.semi, 3),
                       cag_number(form.rank3),
                       cag_number(form.rank4)};
  *result = cag_record_new(call->vm, names, values, 6);
  return true;
}
