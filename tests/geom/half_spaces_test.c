// Operations on half spaces and quadrics, which may be unbounded. Results are compared with the
// corners and closed forms.

#include "geom/solid/csg.h"
#include "geom/solid/solid.h"
#include "geom/tessellate/tessellate.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

enum { PLANES_MOST = 9, CORNERS_MOST = 84 };

// Planes as outward unit normals, with distances from a center inside.
typedef struct Body {
  CagVec3 center, normal[PLANES_MOST];
  double off[PLANES_MOST];
  int n;
} Body;

static CagVec3 random_way(void) {
  const double z = uniform(-1, 1);
  const double angle = uniform(-M_PI, M_PI);
  return cag_vec3(sqrt(1 - z * z) * cos(angle), sqrt(1 - z * z) * sin(angle), z);
}

static Body random_body(int n, double size, double far) {
  Body b = {.n = n};
  for (int i = 0; i < n; i++) {
    b.normal[i] = random_way();
    b.off[i] = size * uniform(0.5, 1);
  }
  b.center = cag_scaled(random_way(), far);
  return b;
}

// A body is unbounded if some direction leads away without end. If so, there is one perpendicular
// to two of the normals, or opposite to a normal if there are fewer.
static bool is_bounded(const Body *b) {
  for (int i = 0; i < b->n; i++)
    for (int j = 0; j < b->n; j++) {
      if (i == j) continue;
      const CagVec3 way = cag_cross(b->normal[i], b->normal[j]);
      bool ends = false;
      for (int k = 0; k < b->n; k++)
        ends = ends || (k != i && k != j && cag_dot(b->normal[k], way) > 0);
      if (!ends) return false;
    }
  return true;
}

// Computes the corners relative to the center, and the planes on which they are.
static int corners_of(const Body *b, CagVec3 *out, int on[][3]) {
  int n = 0;
  for (int i = 0; i < b->n; i++)
    for (int j = 0; j < i; j++)
      for (int k = 0; k < j; k++) {
        const CagVec3 *v = b->normal, x = cag_cross(v[j], v[k]), y = cag_cross(v[k], v[i]),
                      z = cag_cross(v[i], v[j]);
        CagVec3 p = cag_scaled(x, b->off[i]);
        bool within = true;
        p = cag_madd(cag_madd(p, b->off[j], y), b->off[k], z);
        p = cag_scaled(p, 1 / cag_dot(v[i], x));
        for (int l = 0; l < b->n; l++)
          if (l != i && l != j && l != k) within = within && cag_dot(v[l], p) < b->off[l];
        if (!within) continue;
        on[n][0] = i, on[n][1] = j, on[n][2] = k;
        out[n++] = p;
      }
  return n;
}

typedef struct Measures {
  double volume, area;
  CagVec3 moment; // about the center
  CagBounds box;
} Measures;

// Sums pyramids over the sides with their tips at the center. Each side is a fan around the middle
// of its corners, with a triangle for each two corners that have two planes in common.
static Measures measures_of(const Body *b) {
  CagVec3 p[CORNERS_MOST];
  int on[CORNERS_MOST][3];
  const int n = corners_of(b, p, on);
  Measures m = {.box = CAG_BOUNDS_EMPTY};
  for (int i = 0; i < n; i++) cag_bounds_add(&m.box, cag_add(b->center, p[i]));
  for (int f = 0; f < b->n; f++) {
    CagVec3 middle = {0, 0, 0};
    int count = 0;
    bool has[CORNERS_MOST];
    for (int i = 0; i < n; i++) {
      has[i] = on[i][0] == f || on[i][1] == f || on[i][2] == f;
      if (has[i]) middle = cag_add(middle, p[i]), count++;
    }
    if (count == 0) continue;
    middle = cag_scaled(middle, 1.0 / count);
    for (int i = 0; i < n; i++)
      for (int j = 0; j < i; j++) {
        int common = 0;
        for (int k = 0; k < 9; k++) common += on[i][k / 3] == on[j][k % 3];
        if (!has[i] || !has[j] || common != 2) continue;
        const double area = cag_norm(cag_cross(cag_sub(p[i], middle), cag_sub(p[j], middle))) / 2;
        const double volume = area * b->off[f] / 3;
        m.area += area;
        m.volume += volume;
        m.moment = cag_madd(m.moment, volume / 4, cag_add(middle, cag_add(p[i], p[j])));
      }
  }
  return m;
}

static CagSolid *half_space(const Body *b, int i, bool beyond) {
  CagPlane plane;
  CagSolid *s;
  OK(cag_plane(cag_madd(b->center, b->off[i], b->normal[i]),
               cag_scaled(b->normal[i], beyond ? -1 : 1), &plane, &err));
  OK(cag_solid_half_space(&plane, &s, &err));
  return s;
}

// Intersects all at once, one after the other, in pairs, or by differences.
static CagSolid *intersection_of(const Body *b, int way) {
  CagSolid *part[PLANES_MOST], *s = NULL;
  size_t n = 0;
  for (int i = 0; i < b->n; i++) part[n++] = half_space(b, i, way == 3 && i > 0);
  if (way == 2)
    for (size_t i = 0; i + 1 < n; i++) {
      OK(cag_solid_combine(CAG_INTERSECTION, part + i, 2, NULL, &s, &err));
      cag_solid_release(part[i]);
      cag_solid_release(part[i + 1]);
      part[i] = s;
      memmove(part + i + 1, part + i + 2, (n - i - 2) * sizeof *part);
      n--;
    }
  while (way == 1 && n > 2) {
    OK(cag_solid_combine(CAG_INTERSECTION, part, 2, NULL, &s, &err));
    cag_solid_release(part[0]);
    cag_solid_release(part[1]);
    part[0] = s;
    memmove(part + 1, part + 2, (n - 2) * sizeof *part);
    n--;
  }
  OK(cag_solid_combine(way == 3 ? CAG_DIFFERENCE : CAG_INTERSECTION, part, n, NULL, &s, &err));
  for (size_t i = 0; i < n; i++) cag_solid_release(part[i]);
  return s;
}

static void half_spaces_bound_what_their_corners_say(void **state) {
  (void)state;
  int bounded = 0, unbounded = 0;
  seed = 411;
  for (int k = 0; k < 48; k++) {
    const double size = exp(uniform(-4, 4));
    const Body b = random_body(4 + k % 6, size, size * (k % 3 ? uniform(0, 5) : 0));
    CagSolid *s = intersection_of(&b, k / 2 % 4);
    CagBounds box;
    CagMassProperties mass;
    if (!is_bounded(&b)) {
      unbounded++;
      assert_int_not_equal(cag_solid_bounds(s, &box, &err), CAG_OK);
      assert_string_equal(cag_error_info(err.id)->reason, "solid-unbounded");
      cag_solid_release(s);
      continue;
    }
    const Measures m = measures_of(&b);
    const double reach = cag_norm(cag_sub(m.box.max, m.box.min));
    // Bodies that extend far beyond their center may be treated as bounded or not.
    if (reach > 50 * size) {
      cag_solid_release(s);
      continue;
    }
    bounded++;
    OK(cag_solid_bounds(s, &box, &err));
    near_vec(box.min, m.box.min, 1e-9 * reach);
    near_vec(box.max, m.box.max, 1e-9 * reach);
    OK(cag_solid_mass(s, &mass, &err));
    NEAR(mass.volume, m.volume, 1e-9 * m.area * reach);
    NEAR(mass.area, m.area, 1e-9 * reach * reach);
    near_vec(mass.volume_centroid, cag_madd(b.center, 1 / m.volume, m.moment),
             1e-9 * reach * reach * m.area / m.volume);
    cag_solid_release(s);
  }
  assert_true(bounded > 15 && unbounded > 5);
}

// The half space below z = c + x s + y t, or above it.
static CagSolid *slanted(double c, double s, double t, bool above, const CagTransform *place) {
  const double sense = above ? -1 : 1;
  CagPlane plane;
  CagSolid *half, *out;
  OK(cag_plane(cag_vec3(0, 0, c), cag_vec3(-s * sense, -t * sense, sense), &plane, &err));
  OK(cag_solid_half_space(&plane, &half, &err));
  OK(cag_solid_transform(half, place, &out, &err));
  cag_solid_release(half);
  return out;
}

// Between slanted planes, a cylinder over an ellipse has the volume of an upright one with the
// height of its axis. Over a paraboloid, a plane cuts off pi a b R^4 / 2. The parts beyond the
// planes are left out by an intersection or a difference.
static void slanted_planes_cut_quadrics(void **state) {
  (void)state;
  const double tolerance = 4e-3;
  seed = 412;
  for (int k = 0; k < 16; k++) {
    const double a = uniform(0.5, 1.5);
    const double b = uniform(0.5, 1.5);
    const double low[3] = {uniform(-2, -1), uniform(-0.4, 0.4), uniform(-0.4, 0.4)};
    const double high[3] = {uniform(1, 2), uniform(-0.4, 0.4), uniform(-0.4, 0.4)};
    const double scale = exp(uniform(-4, 4));
    const double x = uniform(-3, 3);
    const double y = uniform(-3, 3);
    const double z = uniform(-3, 3);
    const bool cylinder = k % 2, taken = k / 2 % 2;
    CagTransform place = cag_rpy(x, y, z);
    for (int i = 0; i < 9; i++) place.m[i / 3][i % 3] *= scale;
    for (int i = 0; i < 3; i++) place.m[i][3] = scale * uniform(-3, 3);
    CagQuadric q = {
        {1 / (a * a), 1 / (b * b), 0, 0, 0, 0, 0, 0, cylinder ? 0 : -1, cylinder ? -1 : 0}};
    CagSolid *part[3], *form, *s;
    CagMassProperties mass;
    size_t n = 2;
    OK(cag_solid_quadric(&q, &form, &err));
    OK(cag_solid_transform(form, &place, &part[0], &err));
    part[1] = slanted(high[0], high[1], high[2], taken, &place);
    if (cylinder) part[n++] = slanted(low[0], low[1], low[2], !taken, &place);
    OK(cag_solid_combine(taken ? CAG_DIFFERENCE : CAG_INTERSECTION, part, n, NULL, &s, &err));
    OK(cag_solid_mass_within(s, tolerance * scale, &mass, &err));
    const double square = high[0] + (pow(a * high[1], 2) + pow(b * high[2], 2)) / 4;
    const double volume =
        M_PI * a * b * (cylinder ? high[0] - low[0] : square * square / 2) * pow(scale, 3);
    NEAR(mass.volume, volume, tolerance * scale * mass.area);
    cag_solid_release(s);
    cag_solid_release(form);
    for (size_t i = 0; i < n; i++) cag_solid_release(part[i]);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(half_spaces_bound_what_their_corners_say),
      cmocka_unit_test(slanted_planes_cut_quadrics),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
