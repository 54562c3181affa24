// Shells of several bodies, next to each other and nested: every second one is a cavity.

#include "geom/solid/solid.h"
#include "geom/solid/tessellate.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

enum { FACES_MOST = 200 };

// The faces so far, and the measures of the enclosed body.
typedef struct Parts {
  CagSurface *face[FACES_MOST];
  size_t n;
  int cavities;
  double volume, area;
  CagVec3 moment, area_moment;
} Parts;

static int random_int(int below) { return (int)uniform(0, below); }

// A body with corners at the same distance from its center, the radius of the ball that it
// contains, and its measures.
static CagSolid *random_body(double radius, double *within, double *volume, double *area) {
  CagSolid *s, *up;
  switch (random_int(3)) {
  case 0:
    OK(cag_solid_sphere(radius, &s, &err));
    *within = radius;
    *volume = 4 * M_PI / 3 * pow(radius, 3);
    *area = 4 * M_PI * radius * radius;
    return s;
  case 1: {
    const double a = 2 * radius / sqrt(3);
    OK(cag_solid_box(cag_vec3(a, a, a), true, &s, &err));
    *within = a / 2;
    *volume = a * a * a;
    *area = 6 * a * a;
    return s;
  }
  default: {
    const double r = radius / sqrt(2);
    const CagTransform down = cag_translate(cag_vec3(0, 0, -r));
    OK(cag_solid_cylinder(2 * r, r, r, &up, &err));
    OK(cag_solid_transform(up, &down, &s, &err));
    cag_solid_release(up);
    *within = r;
    *volume = 2 * M_PI * pow(r, 3);
    *area = 6 * M_PI * r * r;
    return s;
  }
  }
}

// Adds a body inside a ball, and bodies inside the body. `sense` is 1, or -1 for a cavity.
static void add_bodies(Parts *p, CagVec3 center, double radius, int sense, int depth) {
  double within, volume, area, angle[3];
  CagSolid *s = random_body(radius, &within, &volume, &area), *placed;
  for (int i = 0; i < 3; i++) angle[i] = uniform(-3, 3);
  const CagTransform turn = cag_rpy(angle[0], angle[1], angle[2]), shift = cag_translate(center);
  const CagTransform place = cag_transform_multiply(&shift, &turn);
  OK(cag_solid_transform(s, &place, &placed, &err));
  for (size_t i = 0; i < placed->face_count; i++) {
    CagSurface **to = &p->face[p->n++];
    if (random_int(2)) OK(cag_surface_flip(placed->faces[i], to, &err));
    else *to = cag_surface_retain(placed->faces[i]);
  }
  cag_solid_release(s);
  cag_solid_release(placed);
  p->volume += sense * volume;
  p->area += area;
  p->cavities += sense < 0;
  p->moment = cag_madd(p->moment, sense * volume, center);
  p->area_moment = cag_madd(p->area_moment, area, center);
  const int children = depth > 0 ? random_int(3) : 0;
  const double z = uniform(-1, 1);
  const double turned = uniform(-M_PI, M_PI);
  const CagVec3 way = {sqrt(1 - z * z) * cos(turned), sqrt(1 - z * z) * sin(turned), z};
  for (int i = 0; i < children; i++)
    add_bodies(p, cag_madd(center, (i ? -0.5 : 0.5) * within, way), uniform(0.35, 0.45) * within,
               -sense, depth - 1);
}

static void cavities_are_turned_inward(void **state) {
  (void)state;
  int cavities = 0;
  seed = 401;
  for (int k = 0; k < 16; k++) {
    Parts p = {.n = 0};
    CagSolid *s;
    CagMassProperties m;
    CagMesh *mesh;
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    double terms[10] = {0};
    for (int i = 0; i <= k % 3; i++) {
      const double y = uniform(-1, 1);
      const double z = uniform(-1, 1);
      add_bodies(&p, cag_vec3(5 * i - 3, y, z), uniform(1, 2), 1, 3);
    }
    for (size_t i = p.n - 1; i > 0; i--) {
      const int other = random_int((int)i + 1);
      CagSurface *face = p.face[i];
      p.face[i] = p.face[other];
      p.face[other] = face;
    }
    OK(cag_solid_shell(p.face, p.n, &s, &err));
    OK(cag_solid_mass(s, &m, &err));
    NEAR(m.volume, p.volume, 1e-9);
    NEAR(m.area, p.area, 1e-9);
    near_vec(m.volume_centroid, cag_scaled(p.moment, 1 / p.volume), 1e-9);
    near_vec(m.area_centroid, cag_scaled(p.area_moment, 1 / p.area), 1e-9);
    how.tolerance = 0.03;
    OK(cag_solid_tessellate(s, &how, &mesh, &err));
    assert_true(cag_mesh_is_watertight(mesh, NULL));
    cag_mesh_volume_terms(mesh, terms);
    NEAR(terms[0], p.volume, how.tolerance * p.area);
    cavities += p.cavities;
    cag_mesh_release(mesh);
    cag_solid_release(s);
    for (size_t i = 0; i < p.n; i++) cag_surface_release(p.face[i]);
  }
  assert_true(cavities > 10);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(cavities_are_turned_inward),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
