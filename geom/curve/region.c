// Regions: construction from loops, measures, and point tests.
//
// All queries use the exact curves.

#include "geom/curve/region.h"

#include <string.h>

#include "base/memory.h"
#include "geom/curve/family.h"
#include "geom/curve/region_check.h"
#include "geom/linalg/tolerance.h"

// Points this close to a loop, as a fraction of its size, lie on it.
#define ON_BOUNDARY 1e-10

void cag_region_digest(const CagRegion *r, CagDigest *d) {
  cag_digest_word(d, r->count);
  for (size_t i = 0; i < r->count; i++) cag_curve_digest(r->loops[i], d);
}

CagRegion *cag_region_retain(const CagRegion *r) {
  CagRegion *mine = (CagRegion *)r;
  if (mine) mine->references++;
  return mine;
}

void cag_region_release(CagRegion *r) {
  if (!r || --r->references > 0) return;
  for (size_t i = 0; r->loops && i < r->count; i++) cag_curve_release(r->loops[i]);
  cag_free(r->loops);
  cag_free(r->outer);
  cag_free(r);
}

// Allocates an empty region for n loops.
static CagRegion *allocate(size_t n) {
  CagRegion *r = cag_calloc(1, sizeof *r);
  if (!r) return NULL;
  r->references = 1;
  r->loops = cag_calloc(n + 1, sizeof(CagCurve *));
  r->outer = cag_calloc(n + 1, sizeof(size_t));
  r->count = n;
  if (r->loops && r->outer) return r;
  cag_region_release(r);
  return NULL;
}

CagStatus cag_region_empty(CagRegion **out, CagError *err) {
  CagRegion *r = allocate(0);
  if (!r) return cag_fail_memory(err);
  *out = r;
  return CAG_OK;
}

bool cag_region_is_empty(const CagRegion *r) { return r->count == 0; }

CagStatus cag_region_take(CagCurve **loops, const size_t *outer, size_t n, CagRegion **out,
                          CagError *err) {
  CagRegion *r = allocate(n);
  for (size_t i = 0; i < n; i++) {
    if (!r) {
      cag_curve_release(loops[i]);
      continue;
    }
    r->loops[i] = loops[i];
    r->outer[i] = outer[i];
  }
  if (!r) return cag_fail_memory(err);
  *out = r;
  return CAG_OK;
}

// --- Inside or outside ---

static double loop_size(const CagCurve *c) {
  CagBounds b = c->kind->hull(c, c->start, c->end);
  return cag_norm(cag_sub(b.max, b.min));
}

// Number of upward crossings minus downward crossings of the ray from p along +x with the part [a,
// b] of the curve, whose ends have the heights ya, yb above p. A part to the right of p is decided
// by its ends; a part around p is halved, which terminates because p is not on the curve.
static int crossings(const CagCurve *c, double a, double b, double ya, double yb, CagVec3 p) {
  CagBounds box = c->kind->hull(c, a, b);
  if (box.max.x < p.x || box.min.y > p.y || box.max.y < p.y) {
    // If the hull excludes a crossing, rounding of an end must not create one; the heights only
    // decide whether the ends are on different sides, and then the hull includes p's height.
    if (box.max.x < p.x || (ya >= 0) == (yb >= 0)) return 0;
  }
  double middle = a + (b - a) / 2;
  if (box.min.x > p.x || !(a < middle && middle < b))
    return (ya >= 0) == (yb >= 0) ? 0 : yb >= 0 ? 1 : -1;
  CagVec3 q;
  CagError ignored;
  if (cag_curve_point(c, middle, &q, &ignored)) return 0;
  double ym = q.y - p.y;
  return crossings(c, a, middle, ya, ym, p) + crossings(c, middle, b, ym, yb, p);
}

typedef enum Place { OUTSIDE, INSIDE, BOUNDARY } Place;

static CagStatus place_of(const CagCurve *c, CagVec3 p, Place *out, CagError *err) {
  CagBounds box = c->kind->hull(c, c->start, c->end);
  double slack = ON_BOUNDARY * cag_norm(cag_sub(box.max, box.min));
  *out = OUTSIDE;
  if (p.x < box.min.x - slack || p.x > box.max.x + slack || p.y < box.min.y - slack ||
      p.y > box.max.y + slack)
    return CAG_OK;
  double distance;
  CagStatus status = cag_curve_closest(c, p, NULL, NULL, &distance, err);
  if (status) return status;
  if (distance <= slack) {
    *out = BOUNDARY;
    return CAG_OK;
  }
  double *cuts;
  size_t n;
  status = cag_curve_cuts(c, &cuts, &n, err);
  if (status) return status;
  CagVec3 start, q;
  status = cag_curve_point(c, c->start, &start, err);
  double before = start.y - p.y, first = before;
  int sum = 0;
  for (size_t i = 0; !status && i + 1 < n; i++) {
    double next = first; // the loop ends where it starts
    if (i + 2 < n) {
      status = cag_curve_point(c, cuts[i + 1], &q, err);
      next = q.y - p.y;
    }
    if (!status) sum += crossings(c, cuts[i], cuts[i + 1], before, next, p);
    before = next;
  }
  cag_free(cuts);
  *out = sum % 2 ? INSIDE : OUTSIDE;
  return status;
}

// Whether `inner` lies within `outer`, for loops that do not cross, decided by a point of the inner
// loop that is not on the other. Identical loops count as outside.
static CagStatus loop_within(const CagCurve *inner, const CagCurve *outer, bool *out,
                             CagError *err) {
  enum { SAMPLES = 16 };
  *out = false;
  for (int i = 0; i < SAMPLES; i++) {
    CagVec3 p;
    Place place;
    double t = inner->start + (inner->end - inner->start) * (i + 0.3) / SAMPLES;
    CagStatus status = cag_curve_point(inner, t, &p, err);
    if (!status) status = place_of(outer, p, &place, err);
    if (status) return status;
    if (place == BOUNDARY) continue;
    *out = place == INSIDE;
    return CAG_OK;
  }
  return CAG_OK;
}

// --- Construction ---

// The loop, oriented counter-clockwise (or clockwise); fails if it encloses no area.
static CagStatus oriented(const CagCurve *c, bool clockwise, CagCurve **out, CagError *err) {
  // An area below this fraction of the squared size is rounding.
  const double nothing = CAG_ROUNDING;
  double area;
  CagStatus status = cag_curve_area(c, &area, NULL, err);
  if (status) return status;
  double size = loop_size(c);
  if (fabs(area) <= nothing * size * size)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_zero_area, "C", -1,
                    "the closed curve bounds no area: it runs back on itself or its two sides "
                    "cancel");
  if ((area < 0) == clockwise) {
    *out = cag_curve_retain(c);
    return CAG_OK;
  }
  return cag_curve_reverse(c, out, err);
}

CagStatus cag_region_new(const CagCurve *outer, CagCurve *const *holes, size_t hole_count,
                         CagRegion **out, CagError *err) {
  CagStatus status = cag_region_check_closed(outer, "C", -1, err);
  for (size_t i = 0; !status && i < hole_count; i++)
    status = cag_region_check_closed(holes[i], "holes", (long)i, err);
  if (status) return status;
  CagRegion *r = allocate(hole_count + 1);
  if (!r) return cag_fail_memory(err);
  for (size_t i = 0; !status && i <= hole_count; i++)
    status = oriented(i ? holes[i - 1] : outer, i > 0, &r->loops[i], err);
  if (!status) status = cag_region_check_holes(r->loops, r->count, err);
  for (size_t i = 1; !status && i <= hole_count; i++) {
    bool within;
    status = loop_within(r->loops[i], r->loops[0], &within, err);
    if (!status && !within)
      status = cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_hole_outside, "holes", (long)i - 1,
                        "holes[%zu] does not lie within the outer boundary", i - 1);
    for (size_t k = 1; !status && k < i; k++) {
      bool a, b;
      status = loop_within(r->loops[i], r->loops[k], &a, err);
      if (!status) status = loop_within(r->loops[k], r->loops[i], &b, err);
      if (!status && (a || b))
        status =
            cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_region_crossing, "holes", (long)i - 1,
                     "holes[%zu] and holes[%zu] are nested; holes must be disjoint", k - 1, i - 1);
    }
  }
  if (status) cag_region_release(r);
  else *out = r;
  return status;
}

// Determines the nesting depth of every loop, and orders the loops: each outer one is followed by
// its holes.
CagStatus cag_region_from_loops(CagCurve *const *loops, size_t n, CagRegion **out, CagError *err) {
  if (n == 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_too_few_curves, "C", -1,
                    "a region needs at least one closed curve");
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < n; i++)
    status = cag_region_check_closed(loops[i], "curves", (long)i, err);
  if (!status) status = cag_region_check_loops(loops, n, err);
  if (status) return status;
  bool *within = cag_calloc(n * n, sizeof *within); // within[i * n + k]: loop i lies in loop k
  size_t *depth = cag_calloc(n, sizeof *depth);
  CagRegion *r = allocate(n);
  if (!within || !depth || !r) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++)
    for (size_t k = 0; !status && k < n; k++) {
      if (i == k) continue;
      status = loop_within(loops[i], loops[k], &within[i * n + k], err);
      depth[i] += within[i * n + k];
    }
  size_t used = 0;
  for (size_t i = 0; !status && i < n; i++) {
    if (depth[i] % 2) continue;
    const size_t outer = used;
    status = oriented(loops[i], false, &r->loops[used], err);
    r->outer[used++] = outer;
    for (size_t k = 0; !status && k < n; k++) {
      if (depth[k] != depth[i] + 1 || !within[k * n + i]) continue;
      status = oriented(loops[k], true, &r->loops[used], err);
      r->outer[used++] = outer;
    }
  }
  cag_free(within);
  cag_free(depth);
  if (status) cag_region_release(r);
  else *out = r;
  return status;
}

static CagStatus from_one(CagCurve *loop, CagRegion **out, CagError *err) {
  CagRegion *r = allocate(1);
  if (!r) {
    cag_curve_release(loop);
    return cag_fail_memory(err);
  }
  r->loops[0] = loop;
  *out = r;
  return CAG_OK;
}

static CagStatus check_positive(double x, const char *name, CagError *err) {
  char text[32];
  CagStatus status = cag_curve_check_number(x, name, err);
  if (status || x > 0) return status;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_size_not_positive, name, -1,
                  "`%s` must be positive, found %s", name, cag_number_text(x, text));
}

// Sides and quarter circles, counter-clockwise from the start of the lower side.
static CagStatus rounded_rectangle(double w, double h, double r, CagCurve **out, CagError *err) {
  static const double sx[4] = {1, 1, -1, -1}, sy[4] = {-1, 1, 1, -1};
  CagCurve *pieces[8];
  size_t n = 0;
  CagStatus status = CAG_OK;
  const double x = w / 2 - r, y = h / 2 - r; // center of the corner arcs
  for (int i = 0; !status && i < 4; i++) {
    // Side i runs from corner i - 1 to corner i, at distance r outside of both centers.
    const int k = (i + 3) % 4;
    static const double nx[4] = {0, 1, 0, -1}, ny[4] = {-1, 0, 1, 0};
    CagVec3 p = {sx[k] * x + nx[i] * r, sy[k] * y + ny[i] * r, 0};
    CagVec3 q = {sx[i] * x + nx[i] * r, sy[i] * y + ny[i] * r, 0};
    if (p.x != q.x || p.y != q.y) {
      status = cag_curve_line(p, q, 2, &pieces[n], err);
      n += !status;
    }
    CagTransform frame = cag_translate(cag_vec3(sx[i] * x, sy[i] * y, 0));
    frame.planar = true;
    if (!status) {
      status = cag_curve_arc(r, r, (i - 1) * M_PI / 2, i * M_PI / 2, &frame, &pieces[n], err);
      n += !status;
    }
  }
  if (!status) status = cag_curve_join(pieces, n, out, err);
  for (size_t i = 0; i < n; i++) cag_curve_release(pieces[i]);
  return status;
}

CagStatus cag_region_rectangle(double w, double h, double radius, CagRegion **out, CagError *err) {
  char text[32], most[32];
  CagStatus status = check_positive(w, "w", err);
  if (!status) status = check_positive(h, "h", err);
  if (!status) status = cag_curve_check_number(radius, "radius", err);
  if (status) return status;
  if (radius < 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_size_not_positive, "radius", -1,
                    "`radius` must not be negative, found %s", cag_number_text(radius, text));
  if (radius > fmin(w, h) / 2)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_radius_too_large, "radius", -1,
                    "`radius` must be at most half the shorter side, %s, found %s",
                    cag_number_text(fmin(w, h) / 2, most), cag_number_text(radius, text));
  CagCurve *loop;
  if (radius > 0 && radius == w / 2 && radius == h / 2) {
    CagTransform frame = cag_transform_identity();
    status = cag_curve_arc(radius, radius, 0, 2 * M_PI, &frame, &loop, err);
  } else if (radius > 0) {
    status = rounded_rectangle(w, h, radius, &loop, err);
  } else {
    const CagVec3 p[4] = {
        {-w / 2, -h / 2, 0}, {w / 2, -h / 2, 0}, {w / 2, h / 2, 0}, {-w / 2, h / 2, 0}};
    status = cag_curve_polyline(p, 4, true, 2, &loop, err);
  }
  return status ? status : from_one(loop, out, err);
}

CagStatus cag_region_regular_polygon(size_t n, double radius, CagRegion **out, CagError *err) {
  CagStatus status = check_positive(radius, "radius", err);
  if (status) return status;
  if (n < 3)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_too_few_points, "n", -1,
                    "`n` must be at least 3, found %zu", n);
  CagVec3 *p = cag_malloc(sizeof *p * n);
  if (!p) return cag_fail_memory(err);
  for (size_t i = 0; i < n; i++) {
    double s, c;
    cag_sincos(2 * M_PI * (double)i / (double)n, &s, &c);
    p[i] = cag_vec3(radius * c, radius * s, 0);
  }
  CagCurve *loop;
  status = cag_curve_polyline(p, n, true, 2, &loop, err);
  cag_free(p);
  return status ? status : from_one(loop, out, err);
}

// --- Measures ---

CagStatus cag_region_area(const CagRegion *r, double *area, CagVec3 *centroid, CagError *err) {
  double total = 0;
  CagVec3 moment = {0, 0, 0};
  if (centroid && cag_region_is_empty(r))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_empty_shape, "", -1,
                    "the region is empty, so its centroid is undefined");
  for (size_t i = 0; i < r->count; i++) {
    double a;
    CagVec3 c;
    CagStatus status = cag_curve_area(r->loops[i], &a, &c, err);
    if (status) return status;
    total += a;
    moment = cag_madd(moment, a, c);
  }
  if (area) *area = total;
  if (centroid) *centroid = cag_scaled(moment, 1 / total);
  return CAG_OK;
}

CagStatus cag_region_perimeter(const CagRegion *r, double *out, CagError *err) {
  double total = 0;
  for (size_t i = 0; i < r->count; i++) {
    double part;
    const CagCurve *c = r->loops[i];
    CagStatus status = cag_curve_length(c, c->start, c->end, &part, err);
    if (status) return status;
    total += part;
  }
  *out = total;
  return CAG_OK;
}

CagStatus cag_region_bounds(const CagRegion *r, CagBounds *out, CagError *err) {
  CagBounds box = CAG_BOUNDS_EMPTY;
  if (cag_region_is_empty(r))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_empty_shape, "", -1,
                    "the region is empty, so its bounds are undefined");
  for (size_t i = 0; i < r->count; i++) {
    CagBounds part;
    CagStatus status = cag_curve_bounds(r->loops[i], &part, err);
    if (status) return status;
    cag_bounds_add(&box, part.min);
    cag_bounds_add(&box, part.max);
  }
  *out = box;
  return CAG_OK;
}

CagStatus cag_region_contains(const CagRegion *r, CagVec3 p, bool *out, CagError *err) {
  CagStatus status = cag_curve_check_points(&p, 1, "P", err);
  if (status) {
    err->index = -1;
    return status;
  }
  bool within = false;
  for (size_t i = 0; i < r->count; i++) {
    Place place;
    status = place_of(r->loops[i], p, &place, err);
    if (status) return status;
    if (place == BOUNDARY) {
      *out = true;
      return CAG_OK;
    }
    within = within != (place == INSIDE);
  }
  *out = within;
  return CAG_OK;
}

CagStatus cag_region_transform(const CagRegion *r, const CagTransform *t, CagRegion **out,
                               CagError *err) {
  if (!t->planar)
    return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_not_planar, "T", -1,
                    "a region needs a transform of the plane, found one of space");
  CagRegion *image = allocate(r->count);
  if (!image) return cag_fail_memory(err);
  // Such a map keeps the orientation; for others, the sign of each area is computed.
  double scale;
  const bool keeps =
      cag_transform_is_similarity(t, &scale) && scale > 0 && !cag_transform_mirrors(t);
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < r->count; i++) {
    CagCurve *moved;
    status = cag_curve_transform(r->loops[i], t, &moved, err);
    if (status) break;
    if (keeps) image->loops[i] = cag_curve_retain(moved);
    else status = oriented(moved, r->outer[i] != i, &image->loops[i], err);
    cag_curve_release(moved);
    image->outer[i] = r->outer[i];
  }
  if (status) cag_region_release(image);
  else *out = image;
  return status;
}
