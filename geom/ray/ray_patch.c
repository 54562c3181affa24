#include "geom/ray/ray_patch.h"

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/ray/bvh_walk.h"
#include "geom/surface/trimmed.h"

// A cell is sampled on a grid of this many points in each direction.
enum { SAMPLES = 5 };
// A cell is divided while its points are farther than this fraction of its diagonal from the
// bilinear surface of its corners, or its normals deviate from their mean by more than the angle.
#define BEND 0.04
#define CONE_SINE 0.30 // 17 degrees
enum { DEPTH_MAX = 14 };
// Between samples a smooth surface leaves the box of the samples by a sixteenth of its bend.
#define BOX_PAD_OF_BEND 0.25
// A cone from samples may be a little too narrow.
#define CONE_MARGIN 0.05
// The parameters of a crossing may be outside of a cell by this fraction of it, and those of the
// surface by this fraction of its range: rounding of the solution.
#define EDGE_SLACK 1e-9
// Iterations of Newton's method, and how far it may leave the cell, as a fraction of it.
enum { ITERATIONS = 16 };
#define LEEWAY 0.5
// After so many iterations in a row that end at a border, the crossing is outside.
enum { BORDER_STOPS = 3 };
// Newton's method ends at this distance from the ray, as a fraction of the size of the surface.
#define ON_RAY 1e-14
#define NEAR_RAY 1e-11

// --- Cells ---

typedef struct CellList {
  CagRayCell *items;
  CagBounds *boxes;
  size_t n, capacity, box_capacity;
} CellList;

typedef struct Sampled {
  CagVec3 p[SAMPLES][SAMPLES], normal[SAMPLES][SAMPLES];
} Sampled;

static double mix(double a, double b, int k) {
  return k == SAMPLES - 1 ? b : a + (b - a) * ((double)k / (SAMPLES - 1));
}

static CagStatus sample_cell(const CagSurface *s, const CagRayCell *c, Sampled *out,
                             CagError *err) {
  for (int i = 0; i < SAMPLES; i++)
    for (int j = 0; j < SAMPLES; j++) {
      CagVec3 d[4];
      const double u = mix(c->from[0], c->to[0], i), v = mix(c->from[1], c->to[1], j);
      CagStatus status =
          cag_surface_eval(s, u, v, 1, i == SAMPLES - 1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT,
                           j == SAMPLES - 1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, d, err);
      if (status) return status;
      out->p[i][j] = d[0];
      out->normal[i][j] = cag_unit(cag_cross(d[cag_partial(1, 1, 0)], d[cag_partial(1, 0, 1)]));
    }
  return CAG_OK;
}

// The largest distance of a sample from the bilinear surface of the corners.
static double bend_of(const Sampled *s) {
  const int last = SAMPLES - 1;
  double most = 0;
  for (int i = 0; i < SAMPLES; i++)
    for (int j = 0; j < SAMPLES; j++) {
      const double u = (double)i / last, v = (double)j / last;
      const CagVec3 a = cag_lerp(s->p[0][0], s->p[last][0], u);
      const CagVec3 b = cag_lerp(s->p[0][last], s->p[last][last], u);
      most = fmax(most, cag_norm(cag_sub(s->p[i][j], cag_lerp(a, b, v))));
    }
  return most;
}

// Where the partials vanish, at poles, the normal is that of the neighbors.
static void find_cone(const Sampled *s, CagRayCell *c) {
  CagVec3 sum = {0, 0, 0};
  for (int i = 0; i < SAMPLES; i++)
    for (int j = 0; j < SAMPLES; j++) sum = cag_add(sum, s->normal[i][j]);
  c->axis = cag_unit(sum);
  c->sine = 0;
  for (int i = 0; i < SAMPLES; i++)
    for (int j = 0; j < SAMPLES; j++) {
      if (cag_norm(s->normal[i][j]) == 0) continue;
      const double cosine = cag_dot(s->normal[i][j], c->axis);
      c->sine = fmax(c->sine, cosine > 0 ? sqrt(fmax(0, 1 - cosine * cosine)) : 1);
    }
  if (cag_norm(c->axis) == 0) c->sine = 1;
}

// The longest polyline of samples along u (axis 0) or v.
static double length_along(const Sampled *s, int axis) {
  double longest = 0;
  for (int i = 0; i < SAMPLES; i++) {
    double length = 0;
    for (int k = 1; k < SAMPLES; k++)
      length += axis == 0 ? cag_norm(cag_sub(s->p[k][i], s->p[k - 1][i]))
                          : cag_norm(cag_sub(s->p[i][k], s->p[i][k - 1]));
    longest = fmax(longest, length);
  }
  return longest;
}

static CagStatus add_cell(CellList *list, const CagRayCell *cell, const Sampled *s, double bend,
                          CagError *err) {
  if (!CAG_RESERVE(list->items, list->capacity, list->n + 1) ||
      !CAG_RESERVE(list->boxes, list->box_capacity, list->n + 1))
    return cag_fail_memory(err);
  CagBounds box = CAG_BOUNDS_EMPTY;
  for (int i = 0; i < SAMPLES; i++)
    for (int j = 0; j < SAMPLES; j++) cag_bounds_add(&box, s->p[i][j]);
  const double pad = BOX_PAD_OF_BEND * bend;
  box.min = cag_sub(box.min, cag_vec3(pad, pad, pad));
  box.max = cag_add(box.max, cag_vec3(pad, pad, pad));
  list->items[list->n] = *cell;
  list->boxes[list->n++] = box;
  return CAG_OK;
}

// Divides a cell across its longer side until it bends little.
static CagStatus add_cells(CellList *list, const CagSurface *s, CagRayCell cell, int depth,
                           CagError *err) {
  Sampled sampled;
  CagStatus status = cag_stop_check(err);
  if (!status) status = sample_cell(s, &cell, &sampled, err);
  if (status) return status;
  const double bend = bend_of(&sampled), along_u = length_along(&sampled, 0),
               along_v = length_along(&sampled, 1);
  find_cone(&sampled, &cell);
  if (depth >= DEPTH_MAX || (bend <= BEND * hypot(along_u, along_v) && cell.sine <= CONE_SINE)) {
    cell.sine = fmin(1, cell.sine + CONE_MARGIN);
    return add_cell(list, &cell, &sampled, bend, err);
  }
  const int axis = along_u >= along_v ? 0 : 1;
  const double middle = cell.from[axis] + (cell.to[axis] - cell.from[axis]) / 2;
  CagRayCell low = cell, high = cell;
  low.to[axis] = high.from[axis] = middle;
  status = add_cells(list, s, low, depth + 1, err);
  return status ? status : add_cells(list, s, high, depth + 1, err);
}

static CagStatus divide_surface(CagRayPatch *p, CagError *err) {
  double *us = NULL, *vs = NULL;
  size_t nu = 0, nv = 0;
  CellList list = {0};
  CagStatus status = cag_surface_cuts(p->surface, 0, &us, &nu, err);
  if (!status) status = cag_surface_cuts(p->surface, 1, &vs, &nv, err);
  for (size_t i = 0; !status && i < nu; i++)
    for (size_t j = 0; !status && j < nv; j++) {
      const CagRayCell cell = {.from = {us[i], vs[j]}, .to = {us[i + 1], vs[j + 1]}};
      status = add_cells(&list, p->surface, cell, 0, err);
    }
  cag_free(us);
  cag_free(vs);
  if (!status) status = cag_bvh_build(list.boxes, list.n, 1, &p->bvh, err);
  cag_free(list.boxes);
  p->cells = list.items;
  p->cell_count = list.n;
  p->bounds = p->bvh.bounds;
  return status;
}

// --- Making ---

// Planes need no cells.
static CagStatus make_flat(CagRayPatch *p, const CagSurface *s, bool *flat, CagError *err) {
  const CagRegion *region;
  CagTransform t;
  *flat = true;
  if (cag_surface_parallelogram_view(s, &p->origin, &p->x, &p->y)) {
    p->flat = CAG_RAY_PARALLELOGRAM;
    p->bounds = CAG_BOUNDS_EMPTY;
    for (int k = 0; k < 4; k++)
      cag_bounds_add(&p->bounds, cag_madd(cag_madd(p->origin, k & 1, p->x), k >> 1, p->y));
    return CAG_OK;
  }
  if (!cag_surface_planar_view(s, &region, &t)) {
    *flat = false;
    return CAG_OK;
  }
  p->flat = CAG_RAY_PLANE;
  p->x = cag_vec3(t.m[0][0], t.m[1][0], t.m[2][0]);
  p->y = cag_vec3(t.m[0][1], t.m[1][1], t.m[2][1]);
  p->origin = cag_vec3(t.m[0][3], t.m[1][3], t.m[2][3]);
  CagStatus status = cag_ray_outline_new(region, &p->outline, err);
  return status ? status : cag_surface_bounds(s, &p->bounds, err);
}

CagStatus cag_ray_patch_new(const CagSurface *s, CagRayPatch **out, CagError *err) {
  CagRayPatch *p = cag_calloc(1, sizeof *p);
  if (!p) return cag_fail_memory(err);
  const CagSurface *inner = s;
  const CagRegion *region = NULL;
  bool flat;
  if (!cag_surface_trimmed_view(s, &inner, &region)) inner = s;
  p->shape = cag_surface_retain(s);
  p->surface = cag_surface_retain(inner);
  CagStatus status = make_flat(p, s, &flat, err);
  if (!status && region) status = cag_ray_outline_new(region, &p->outline, err);
  if (!status && !flat) status = divide_surface(p, err);
  p->size = cag_norm(cag_sub(p->bounds.max, p->bounds.min));
  if (status) cag_ray_patch_free(p);
  else *out = p;
  return status;
}

void cag_ray_patch_free(CagRayPatch *p) {
  if (!p) return;
  cag_surface_release(p->shape);
  cag_surface_release(p->surface);
  cag_ray_outline_free(p->outline);
  cag_bvh_free(&p->bvh);
  cag_free(p->cells);
  cag_free(p);
}

// --- Planes ---

static CagStatus meet_plane(const CagRayPatch *p, const CagRay *ray, CagCrossings *out,
                            CagError *err) {
  const CagVec3 normal = cag_cross(p->x, p->y), to = cag_sub(p->origin, ray->origin);
  const double slope = cag_dot(normal, ray->direction), square = cag_dot(normal, normal);
  const double t = cag_dot(normal, to) / slope;
  if (slope == 0 || !(t > ray->least && t <= ray->most)) return CAG_OK;
  const CagVec3 at = cag_sub(cag_madd(ray->origin, t, ray->direction), p->origin);
  const double u = cag_dot(cag_cross(at, p->y), normal) / square;
  const double v = cag_dot(cag_cross(p->x, at), normal) / square;
  const double slack = EDGE_SLACK;
  if (p->flat == CAG_RAY_PARALLELOGRAM) {
    if (u < -slack || v < -slack || u > 1 + slack || v > 1 + slack) return CAG_OK;
  } else {
    const double range = fmax(p->outline->high - p->outline->low, 0);
    if (!cag_ray_outline_holds(p->outline, u, v, slack * range)) return CAG_OK;
  }
  CagCrossing *c = cag_crossings_add(out, err);
  if (!c) return CAG_E_MEMORY;
  *c = (CagCrossing){.t = t,
                     .normal = cag_scaled(normal, 1 / sqrt(square)),
                     .u = u,
                     .v = v,
                     .sign = slope > 0 ? 1 : -1};
  return CAG_OK;
}

// --- Newton's method ---

// A ray with two directions perpendicular to it.
typedef struct Line {
  const CagRay *ray;
  CagVec3 a, b;
} Line;

static Line line_of(const CagRay *ray) {
  const CagVec3 d = ray->direction;
  const CagVec3 other = fabs(d.x) < 0.6 ? cag_vec3(1, 0, 0) : cag_vec3(0, 1, 0);
  Line l = {.ray = ray, .a = cag_unit(cag_cross(d, other))};
  l.b = cag_cross(d, l.a);
  return l;
}

typedef struct Root {
  double at[2];
  CagVec3 p, du, dv;
} Root;

static double clamped(double x, double low, double high) { return fmin(fmax(x, low), high); }

// How a search ended: at a crossing, against the border of where it may go, or neither.
typedef enum Outcome { FOUND, LEFT_CELL, FAILED } Outcome;

// Moves the parameters to where the surface meets the line.
static CagStatus refine_root(const CagRayPatch *s, const CagRayCell *cell, const Line *line,
                             Root *r, Outcome *outcome, CagError *err) {
  const double domain[2][2] = {{s->surface->u0, s->surface->u1}, {s->surface->v0, s->surface->v1}};
  double low[2], high[2], before = INFINITY;
  *outcome = FAILED;
  int stopped = 0; // iterations in a row that were stopped at a border
  for (int k = 0; k < 2; k++) {
    const double leeway = LEEWAY * (cell->to[k] - cell->from[k]);
    low[k] = fmax(domain[k][0], cell->from[k] - leeway);
    high[k] = fmin(domain[k][1], cell->to[k] + leeway);
  }
  for (int i = 0; i < ITERATIONS; i++) {
    CagVec3 d[4];
    const CagSide side_u = r->at[0] >= cell->to[0] ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
    const CagSide side_v = r->at[1] >= cell->to[1] ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
    CagStatus status = cag_surface_eval(s->surface, r->at[0], r->at[1], 1, side_u, side_v, d, err);
    if (status) return status;
    r->p = d[0];
    r->du = d[cag_partial(1, 1, 0)];
    r->dv = d[cag_partial(1, 0, 1)];
    const CagVec3 off = cag_sub(r->p, line->ray->origin);
    const double f = cag_dot(off, line->a), g = cag_dot(off, line->b), distance = hypot(f, g);
    const double scale = s->size + cag_norm(off);
    if (distance <= ON_RAY * scale ||
        (i > 3 && distance <= NEAR_RAY * scale && distance >= before / 2)) {
      *outcome = FOUND;
      return CAG_OK;
    }
    before = distance;
    const double fu = cag_dot(r->du, line->a), fv = cag_dot(r->dv, line->a),
                 gu = cag_dot(r->du, line->b), gv = cag_dot(r->dv, line->b);
    const double det = fu * gv - fv * gu;
    if (det == 0) return CAG_OK;
    const double step[2] = {(fv * g - gv * f) / det, (gu * f - fu * g) / det};
    bool moved = false, at_border = false;
    for (int k = 0; k < 2; k++) {
      const double wanted = r->at[k] + step[k], next = clamped(wanted, low[k], high[k]);
      moved = moved || next != r->at[k];
      at_border = at_border || next != wanted;
      r->at[k] = next;
    }
    stopped = at_border ? stopped + 1 : 0;
    if (moved && stopped < BORDER_STOPS) continue;
    *outcome = !moved && distance <= NEAR_RAY * scale ? FOUND : LEFT_CELL;
    return CAG_OK;
  }
  return CAG_OK;
}

static bool is_in_part(const CagRayCell *part, const Root *r) {
  for (int k = 0; k < 2; k++) {
    const double slack = EDGE_SLACK * (part->to[k] - part->from[k]);
    if (r->at[k] < part->from[k] - slack || r->at[k] > part->to[k] + slack) return false;
  }
  return true;
}

// Whether a root is in its cell and in the outline. Cells that meet in an edge both have it.
static bool is_in_cell(const CagRayPatch *s, const CagRayCell *cell, const Root *r) {
  if (!is_in_part(cell, r)) return false;
  if (!s->outline) return true;
  const double range = s->outline->high - s->outline->low;
  return cag_ray_outline_holds(s->outline, r->at[0], r->at[1], EDGE_SLACK * range);
}

static CagStatus add_root(const CagRayPatch *s, const Line *line, const Root *r, CagCrossings *out,
                          CagError *err) {
  const double t = cag_dot(cag_sub(r->p, line->ray->origin), line->ray->direction);
  if (!(t > line->ray->least && t <= line->ray->most)) return CAG_OK;
  CagVec3 normal = cag_unit(cag_cross(r->du, r->dv));
  CagError ignored;
  if (cag_norm(normal) == 0) cag_surface_normal(s->surface, r->at[0], r->at[1], &normal, &ignored);
  const double slope = cag_dot(normal, line->ray->direction);
  CagCrossing *c = cag_crossings_add(out, err);
  if (!c) return CAG_E_MEMORY;
  *c = (CagCrossing){.t = t,
                     .normal = normal,
                     .u = r->at[0],
                     .v = r->at[1],
                     .angular = {s->surface->angular_u, s->surface->angular_v},
                     .sign = slope > 0   ? 1
                             : slope < 0 ? -1
                                         : 0};
  return CAG_OK;
}

// The roots of a ray in a cell. Where the surface bends little, a ray meets it in a few points.
enum { ROOTS_MAX = 32 };
typedef struct CellRoots {
  Root found[ROOTS_MAX];
  int n;
} CellRoots;

static bool differ(const Root *a, const Root *b, const CagRayCell *cell) {
  const double same = 1e-6;
  return fabs(a->at[0] - b->at[0]) > same * (cell->to[0] - cell->from[0]) ||
         fabs(a->at[1] - b->at[1]) > same * (cell->to[1] - cell->from[1]);
}

static bool is_known(const CellRoots *roots, const Root *r, const CagRayCell *cell) {
  for (int i = 0; i < roots->n; i++)
    if (!differ(&roots->found[i], r, cell)) return true;
  return false;
}

// Where the ray meets the surface again if it grazes it at a root: along the direction of the ray,
// the surface bends away from it by a parabola. Returns false if it does not bend.
static CagStatus partner_of(const CagRayPatch *s, const Line *line, const Root *root, Root *out,
                            bool *bends, CagError *err) {
  CagVec3 d[9];
  *bends = false;
  CagStatus status = cag_surface_eval(s->surface, root->at[0], root->at[1], 2, CAG_SIDE_RIGHT,
                                      CAG_SIDE_RIGHT, d, err);
  if (status) return status;
  const CagVec3 du = root->du, dv = root->dv, ray = line->ray->direction;
  const CagVec3 normal = cag_unit(cag_cross(du, dv));
  // The parameters change by wu and wv along the ray, as far as it is in the tangent plane.
  const double uu = cag_dot(du, du), uv = cag_dot(du, dv), vv = cag_dot(dv, dv);
  const double ru = cag_dot(du, ray), rv = cag_dot(dv, ray), det = uu * vv - uv * uv;
  if (!(det > 0)) return CAG_OK;
  const double wu = (vv * ru - uv * rv) / det, wv = (uu * rv - uv * ru) / det;
  const CagVec3 second = cag_madd(
      cag_madd(cag_scaled(d[cag_partial(2, 2, 0)], wu * wu), 2 * wu * wv, d[cag_partial(2, 1, 1)]),
      wv * wv, d[cag_partial(2, 0, 2)]);
  const double bend = cag_dot(second, normal), along = 2 * cag_dot(normal, ray) / bend;
  if (!(fabs(along) < s->size)) return CAG_OK;
  *bends = true;
  out->at[0] = clamped(root->at[0] + along * wu, s->surface->u0, s->surface->u1);
  out->at[1] = clamped(root->at[1] + along * wv, s->surface->v0, s->surface->v1);
  return CAG_OK;
}

// What a search in a part of a cell needs.
typedef struct CellSearch {
  const CagRayPatch *patch;
  const CagRayCell *cell;
  const Line *line;
  CellRoots roots;
  CagCrossings *out;
} CellSearch;

// Searches from a start, in a part of the cell and a little around it.
static CagStatus search_from(CellSearch *c, const CagRayCell *part, Root *r, Outcome *outcome,
                             CagError *err) {
  CagStatus status = refine_root(c->patch, part, c->line, r, outcome, err);
  if (status || *outcome != FOUND || !is_in_cell(c->patch, c->cell, r) || c->roots.n == ROOTS_MAX ||
      is_known(&c->roots, r, c->cell))
    return status;
  c->roots.found[c->roots.n++] = *r;
  return add_root(c->patch, c->line, r, c->out, err);
}

static Root middle_of(const CagRayCell *part) {
  Root r = {0};
  for (int k = 0; k < 2; k++) r.at[k] = part->from[k] + (part->to[k] - part->from[k]) / 2;
  return r;
}

// A grid of 3 x 3 points of a part of a cell, as the ray sees them: how far they are from it in two
// directions, and the cosine of the angle of the normal with it, times the lengths of the partials.
enum { GRID = 3 };
typedef struct Seen {
  double off[2][GRID][GRID], slope[GRID][GRID];
} Seen;

static CagStatus see_part(const CellSearch *c, const CagRayCell *part, Seen *out, CagError *err) {
  for (int i = 0; i < GRID; i++)
    for (int j = 0; j < GRID; j++) {
      CagVec3 d[4];
      const double u = i == 2 ? part->to[0] : part->from[0] + i * (part->to[0] - part->from[0]) / 2;
      const double v = j == 2 ? part->to[1] : part->from[1] + j * (part->to[1] - part->from[1]) / 2;
      CagStatus status =
          cag_surface_eval(c->patch->surface, u, v, 1, i == 2 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT,
                           j == 2 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, d, err);
      if (status) return status;
      const CagVec3 off = cag_sub(d[0], c->line->ray->origin);
      out->off[0][i][j] = cag_dot(off, c->line->a);
      out->off[1][i][j] = cag_dot(off, c->line->b);
      out->slope[i][j] = cag_dot(cag_cross(d[cag_partial(1, 1, 0)], d[cag_partial(1, 0, 1)]),
                                 c->line->ray->direction);
    }
  return CAG_OK;
}

// How far a function leaves the range of its values on the grid. Its second differences are four
// times as large as its distances from the chords of a quarter.
static double bend_of_grid(const double f[GRID][GRID]) {
  double bend = 0;
  for (int a = 0; a < GRID; a++)
    bend = fmax(bend,
                fmax(fabs(f[a][0] - 2 * f[a][1] + f[a][2]), fabs(f[0][a] - 2 * f[1][a] + f[2][a])));
  return bend / 2;
}

// Whether a function may be 0 in the square of points whose first corner is [i][j].
static bool may_vanish(const double f[GRID][GRID], int i, int j, int side, double slack) {
  double low = INFINITY, high = -INFINITY;
  for (int a = i; a <= i + side; a++)
    for (int b = j; b <= j + side; b++) {
      low = fmin(low, f[a][b]);
      high = fmax(high, f[a][b]);
    }
  slack += bend_of_grid(f);
  return low <= slack && high >= -slack;
}

// Finds the crossings of a part that may have several: divides it until each quarter that the ray may
// pass through has one, or two of which one leads to the other.
enum { DIVISIONS = 6 };
static CagStatus divide_part(CellSearch *c, const CagRayCell *part, int depth, CagError *err) {
  Seen seen;
  CagStatus status = see_part(c, part, &seen, err);
  // Where the slope has a sign, there is one crossing at most.
  const bool one = !status && !may_vanish(seen.slope, 0, 0, 2, 0);
  for (int k = 0; !status && k < 4; k++) {
    const int at[2] = {k & 1, k >> 1};
    const double slack = NEAR_RAY * c->patch->size;
    if (!may_vanish(seen.off[0], at[0], at[1], 1, slack) ||
        !may_vanish(seen.off[1], at[0], at[1], 1, slack))
      continue;
    CagRayCell quarter = *part;
    const Root middle = middle_of(part);
    for (int axis = 0; axis < 2; axis++)
      if (at[axis]) quarter.from[axis] = middle.at[axis];
      else quarter.to[axis] = middle.at[axis];
    Root root = middle_of(&quarter), other;
    Outcome outcome;
    bool bends;
    status = search_from(c, &quarter, &root, &outcome, err);
    if (status) break;
    if (outcome == FOUND && is_in_part(&quarter, &root)) {
      if (one) continue;
      other = root;
      status = partner_of(c->patch, c->line, &root, &other, &bends, err);
      if (!status && bends) status = search_from(c, c->cell, &other, &outcome, err);
      if (status) break;
      if (depth >= 2 && bends && outcome == FOUND && is_in_part(&quarter, &other) &&
          differ(&root, &other, c->cell))
        continue;
    }
    if (depth < DIVISIONS) status = divide_part(c, &quarter, depth + 1, err);
  }
  return status;
}

static CagStatus meet_cell(const CagRayPatch *s, const CagRayCell *cell, const Line *line,
                           CagCrossings *out, CagError *err) {
  CellSearch c = {.patch = s, .cell = cell, .line = line, .out = out};
  c.roots.n = 0;
  if (fabs(cag_dot(cell->axis, line->ray->direction)) > cell->sine) {
    Outcome outcome;
    Root r = middle_of(cell);
    CagStatus status = search_from(&c, cell, &r, &outcome, err);
    if (status || outcome != FAILED) return status;
  }
  return divide_part(&c, cell, 0, err);
}

CagStatus cag_ray_patch_meet(const CagRayPatch *p, const CagRay *ray, bool first, CagCrossings *out,
                             CagError *err) {
  if (p->flat != CAG_RAY_CURVED) return meet_plane(p, ray, out, err);
  CagBvhRay walked;
  if (!cag_bvh_ray(&p->bvh, ray->origin, ray->direction, ray->least, ray->most, &walked))
    return CAG_OK;
  const Line line = line_of(ray);
  CagBvhWalk walk;
  CagStatus status = CAG_OK;
  size_t from, count;
  cag_bvh_start(&p->bvh, &walk);
  while (!status && cag_bvh_next(&p->bvh, &walked, &walk, &from, &count))
    for (size_t i = from; !status && i < from + count; i++) {
      const size_t known = out->n;
      status = meet_cell(p, &p->cells[p->bvh.order[i]], &line, out, err);
      for (size_t k = known; first && k < out->n; k++)
        walked.most =
            fminf(walked.most, nextafterf((float)(out->items[k].t - walked.start), INFINITY));
    }
  return status;
}
