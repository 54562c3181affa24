// Writes quadric surfaces as `quadric`, clipped to the patch.
//
// POV-Ray's quadric is the whole surface. A patch is clipped with a box: one along the quadric's
// own axes, one that is stretched and sheared as the patch was, or one along the world axes,
// whichever has the patch's edges on its faces. If there is none, the patch becomes a mesh.

#include <string.h>

#include "interp/formats/pov_write.h"

// An edge counts as lying on a face of the box up to this fraction of its size, which is the
// accuracy of bounds of patches.
#define ON_FACE 1e-7
// Faces that do not clip are moved outward by this fraction of the size, so that they do not touch
// the surface.
#define CLEARANCE 1e-4
#define EDGE_SAMPLES 16

typedef struct Cut {
  CagTransform frame; // of the box's axes
  CagBounds box;
  double size;
  bool cutting[6]; // min x, y, z, max x, y, z
} Cut;

// Marks the faces on which p, in coordinates of the box, lies. Returns false if there are none.
static bool mark_faces(Cut *c, CagVec3 p) {
  const double x[3] = {p.x, p.y, p.z};
  const double low[3] = {c->box.min.x, c->box.min.y, c->box.min.z};
  const double high[3] = {c->box.max.x, c->box.max.y, c->box.max.z};
  int face = -1, found = 0;
  for (int i = 0; i < 3; i++) {
    if (fabs(x[i] - low[i]) <= ON_FACE * c->size) face = i, found++;
    if (fabs(x[i] - high[i]) <= ON_FACE * c->size) face = 3 + i, found++;
  }
  if (found == 1) c->cutting[face] = true;
  return found > 0;
}

static bool edge_on_faces(Cut *c, const CagSurface *s, const CagTransform *inverse, int side) {
  for (int i = 0; i <= EDGE_SAMPLES; i++) {
    double t = (double)i / EDGE_SAMPLES;
    double u = s->u0 + t * (s->u1 - s->u0), v = s->v0 + t * (s->v1 - s->v0);
    if (side == 0) u = s->u0;
    if (side == 1) u = s->u1;
    if (side == 2) v = s->v0;
    if (side == 3) v = s->v1;
    CagVec3 p;
    CagError err;
    if (cag_surface_point(s, u, v, &p, &err)) return false;
    if (!mark_faces(c, cag_transform_point(inverse, p))) return false;
  }
  return true;
}

static bool edges_on_faces(Cut *c, const CagSurface *s, const CagTransform *inverse) {
  const bool inner[4] = {s->closed_u || s->pole_u0, s->closed_u || s->pole_u1,
                         s->closed_v || s->pole_v0, s->closed_v || s->pole_v1};
  for (int side = 0; side < 4; side++)
    if (!inner[side] && !edge_on_faces(c, s, inverse, side)) return false;
  return true;
}

static bool bounds_in_frame(const CagSurface *s, const CagTransform *inverse, CagBounds *out) {
  CagError err;
  CagSurface *moved;
  if (cag_surface_transform(s, inverse, &moved, &err)) return false;
  bool ok = !cag_surface_bounds(moved, out, &err);
  cag_surface_release(moved);
  return ok;
}

static bool find_cut(const CagSurface *const *s, size_t n, const CagTransform *frame, Cut *c) {
  CagError err;
  CagTransform inverse;
  *c = (Cut){.frame = *frame, .box = CAG_BOUNDS_EMPTY};
  if (cag_transform_inverse(frame, &inverse, &err)) return false;
  for (size_t i = 0; i < n; i++) {
    CagBounds b;
    if (!bounds_in_frame(s[i], &inverse, &b)) return false;
    cag_bounds_add(&c->box, b.min);
    cag_bounds_add(&c->box, b.max);
  }
  c->size = cag_norm(cag_sub(c->box.max, c->box.min));
  for (size_t i = 0; i < n; i++)
    if (!edges_on_faces(c, s[i], &inverse)) return false;
  return true;
}

static bool cuts_anything(const Cut *c) {
  for (int i = 0; i < 6; i++)
    if (c->cutting[i]) return true;
  return false;
}

static void write_cut(CagPovWriter *w, const Cut *c) {
  double off = CLEARANCE * c->size, unit = pow(10, floor(log10(c->size)) - 11);
  CagVec3 low = cag_vec3(cag_pov_round(c->box.min.x - (c->cutting[0] ? 0 : off), unit),
                         cag_pov_round(c->box.min.y - (c->cutting[1] ? 0 : off), unit),
                         cag_pov_round(c->box.min.z - (c->cutting[2] ? 0 : off), unit));
  CagVec3 high = cag_vec3(cag_pov_round(c->box.max.x + (c->cutting[3] ? 0 : off), unit),
                          cag_pov_round(c->box.max.y + (c->cutting[4] ? 0 : off), unit),
                          cag_pov_round(c->box.max.z + (c->cutting[5] ? 0 : off), unit));
  cag_pov_text(w, "  clipped_by {\n    box {\n      ");
  cag_pov_vec(w, low);
  cag_pov_text(w, ", ");
  cag_pov_vec(w, high);
  cag_pov_text(w, "\n");
  cag_pov_placement(w, "      ", &c->frame);
  cag_pov_text(w, "    }\n  }\n  bounded_by { clipped_by }\n");
}

static bool common_equation(const CagSurface *const *s, size_t n, CagQuadric *q) {
  if (n == 0 || !cag_surface_quadric_view(s[0], q)) return false;
  for (size_t i = 1; i < n; i++) {
    CagQuadric other;
    if (!cag_surface_quadric_view(s[i], &other) || memcmp(q, &other, sizeof other) != 0)
      return false;
  }
  return true;
}

bool cag_pov_try_quadric(CagPovWriter *w, const CagSurface *const *s, size_t n) {
  CagQuadric q;
  CagQuadricForm form;
  CagError err;
  Cut cut;
  CagTransform world = cag_transform_identity(), own = world;
  if (!common_equation(s, n, &q) || cag_quadric_classify(&q, &form, &err)) return false;
  cag_surface_quadric_frame(s[0], &own);
  if (!find_cut(s, n, &form.frame, &cut) && !find_cut(s, n, &own, &cut) &&
      !find_cut(s, n, &world, &cut))
    return false;
  cag_pov_equation(w, q.c);
  if (cuts_anything(&cut)) write_cut(w, &cut);
  cag_pov_text(w, "}");
  return true;
}
