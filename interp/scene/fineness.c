// How fine the meshes of items are.

#include "interp/scene/fineness.h"

#include <math.h>

#include "geom/solid/csg.h"

// The default tolerance as a fraction of the diagonal of the bounds of all that is shown.
#define SIZE_PART 1e-3
// In pictures.
#define PIXEL_PART 0.25
// The coarsest default tolerance, as a fraction of the item's diagonal. A ball then has 14 sides.
#define COARSEST_PART (1.0 / 32)
// The finest tolerance of a picture, as a fraction of the item's diagonal. It limits the triangles
// of a part of which a picture shows a small detail.
#define FINEST_PART 1e-5
// Of an item around the eye, most is at least this fraction of its diagonal away.
#define AROUND_PART 0.25
// Normals of meshes are those of the surface, so that shading is smooth for any angle. Shorter edges
// than this multiple of the tolerance need not respect it: on a round of this radius, they turn by
// a radian, which is within the tolerance.
#define SHORT_EDGE 4

static double size_of(const CagBounds *b) {
  return b->min.x <= b->max.x ? cag_norm(cag_sub(b->max, b->min)) : 0;
}

// Rounds down to a power of two.
static double rounded_down(double x) {
  int exponent;
  if (!(x > 0) || !isfinite(x)) return 0;
  frexp(x, &exponent);
  return ldexp(0.5, exponent);
}

double cag_usual_tolerance(const CagBounds *bounds) {
  return rounded_down(SIZE_PART * size_of(bounds));
}

static bool is_finite(const CagBounds *b) { return isfinite(size_of(b)); }

CagBounds cag_scene_reach(const CagScene *s) {
  CagBounds all = CAG_BOUNDS_EMPTY;
  for (size_t i = 0; i < s->item_count; i++) {
    const CagItem *item = &s->items[i];
    CagBounds one = CAG_BOUNDS_EMPTY;
    CagError ignored;
    const bool compound = item->kind == CAG_ITEM_SOLID && cag_solid_is_compound(item->as.solid);
    const CagStatus status = compound ? cag_solid_reach(item->as.solid, &one, &ignored)
                                      : cag_item_bounds(item, NULL, &one, &ignored);
    if (status || !(one.min.x <= one.max.x) || !is_finite(&one)) continue;
    cag_bounds_add(&all, one.min);
    cag_bounds_add(&all, one.max);
  }
  return all;
}

static CagBounds bounds_of(const CagItem *item) {
  CagBounds box = CAG_BOUNDS_EMPTY;
  CagError ignored;
  if (item->measured) return item->bounds;
  return cag_item_bounds(item, NULL, &box, &ignored) ? CAG_BOUNDS_EMPTY : box;
}

// --- Pictures ---

static double distance_to(const CagBounds *b, CagVec3 p) {
  return cag_norm(cag_vec3(fmax(0, fmax(b->min.x - p.x, p.x - b->max.x)),
                           fmax(0, fmax(b->min.y - p.y, p.y - b->max.y)),
                           fmax(0, fmax(b->min.z - p.z, p.z - b->max.z))));
}

// The depths of a box in front of the eye.
static void find_depths(const CagCamera *c, CagVec3 ahead, const CagBounds *b, double *near,
                        double *far) {
  *near = INFINITY;
  *far = -INFINITY;
  for (int k = 0; k < 8; k++) {
    const CagVec3 corner = cag_vec3(k & 1 ? b->max.x : b->min.x, k & 2 ? b->max.y : b->min.y,
                                    k & 4 ? b->max.z : b->min.z);
    const double depth = cag_dot(cag_sub(corner, c->eye), ahead);
    *near = fmin(*near, depth);
    *far = fmax(*far, depth);
  }
}

// The least depth of what a picture shows of a box. A point in the picture at the distance d of the
// eye has at least the depth d cos(a), where a is the angle from the view axis to the corners.
static double nearest_depth(const CagCamera *c, const CagCameraParts *parts, const CagBounds *b) {
  const CagTransform frame = cag_camera_frame(c);
  const CagVec3 ahead = cag_vec3(frame.m[0][2], frame.m[1][2], frame.m[2][2]);
  const double half[2] = {fmax(parts->k[0][2], c->size[0] - parts->k[0][2]) / parts->k[0][0],
                          fmax(parts->k[1][2], c->size[1] - parts->k[1][2]) / parts->k[1][1]};
  const double cosine = 1 / sqrt(1 + half[0] * half[0] + half[1] * half[1]);
  double near, far;
  find_depths(c, ahead, b, &near, &far);
  if (far <= 0) return -far; // behind the eye: seen in mirrors and by its shadow
  const double depth = fmax(near, cosine * distance_to(b, c->eye));
  return fmax(depth, near > 0 ? 0 : AROUND_PART * size_of(b));
}

static double picture_tolerance(const CagCamera *c, const CagBounds *b) {
  const CagCameraParts parts = cag_camera_parts(c);
  const double pixels = fmax(parts.k[0][0], parts.k[1][1]); // in 1 mm, or in 1 mm at the depth 1
  const double pixel = (c->orthographic ? 1 : nearest_depth(c, &parts, b)) / pixels;
  return rounded_down(fmax(PIXEL_PART * pixel, FINEST_PART * size_of(b)));
}

// --- Tolerances ---

static void note(const CagScene *s, CagToleranceSource source, double tolerance) {
  CagToleranceRange *r = s->used ? &s->used->of[source] : NULL;
  if (!r) return;
  r->least = r->most > 0 ? fmin(r->least, tolerance) : tolerance;
  r->most = fmax(r->most, tolerance);
}

static double find_tolerance(const CagScene *s, const CagItem *item, CagToleranceSource *source) {
  *source = CAG_TOLERANCE_OF_ITEM;
  if (item->tolerance > 0) return item->tolerance;
  *source = CAG_TOLERANCE_OF_SCENE;
  if (s->tolerance > 0) return s->tolerance;
  *source = s->picture ? CAG_TOLERANCE_OF_PIXELS : CAG_TOLERANCE_OF_SIZE;
  const CagBounds box = bounds_of(item);
  const double usual = s->picture ? picture_tolerance(s->picture, &box) : s->usual_tolerance;
  const double coarsest = COARSEST_PART * size_of(&box);
  return usual > 0 && coarsest > 0 ? fmin(usual, coarsest) : usual;
}

double cag_item_tolerance(const CagScene *s, const CagItem *item) {
  CagToleranceSource source;
  const double tolerance = find_tolerance(s, item, &source);
  if (tolerance > 0) note(s, source, tolerance);
  return tolerance;
}

CagTessellation cag_item_fineness(const CagScene *s, const CagItem *item) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  how.tolerance = cag_item_tolerance(s, item);
  how.short_edge = SHORT_EDGE;
  if (s->max_triangles > 0) how.max_triangles = s->max_triangles;
  how.interrupt = s->interrupt;
  return how;
}
