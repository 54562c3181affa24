// Parts of URDF: each value that a description has comes out of its reader, chains are found in
// trees, and masses follow the laws of mechanics.

#include "geom/solid/tessellate.h"
#include "interp/formats/urdf.h"
#include "interp/formats/urdf_read.h"
#include "tests/geom/random.h"
#include "tests/interp/scene_fixture.h"

static void is_near(double x, double expected, double within, const char *what) {
  if (!(fabs(x - expected) <= within)) fail_msg("%s: %.15g, not %.15g", what, x, expected);
}

static double linear(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : pow((srgb + 0.055) / 1.055, 2.4);
}

// --- Reading ---

static const char robot_text[] =
    "<?xml version=\"1.0\"?>\n"
    "<robot name=\"arm\">\n"
    "  <material name=\"steel\"><color rgba=\"0.5 0.02 1.5 0.25\"/></material>\n"
    "  <link name=\"a\">\n"
    "    <visual><origin xyz=\"0.1 -0.2 0.3\" rpy=\"0.4 0.5 -0.6\"/>\n"
    "      <geometry><box size=\"0.1 0.2 0.3\"/></geometry><material name=\"steel\"/></visual>\n"
    "    <collision><geometry><cylinder radius=\"0.05\" length=\"0.7\"/></geometry></collision>\n"
    "    <visual><geometry><sphere radius=\"0.02\"/></geometry>\n"
    "      <material name=\"own\"><color rgba=\"1 -1 0 7\"/></material></visual>\n"
    "    <visual><geometry><mesh filename=\"m.stl\" scale=\"1 2 -3\"/></geometry>\n"
    "      <material name=\"later\"/></visual>\n"
    "    <visual><geometry><mesh filename=\"n.stl\"/></geometry>\n"
    "      <material name=\"unknown\"/></visual>\n"
    "  </link>\n"
    "  <link name=\"b\"><visual><geometry><box size=\"1 1 1\"/></geometry>\n"
    "    <material name=\"own\"/></visual></link>\n"
    "  <link name=\"c\"/>\n"
    "  <link name=\"d\"/>\n"
    "  <link name=\"e\"/>\n"
    "  <link name=\"f\"/>\n"
    "  <joint name=\"j1\" type=\"revolute\"><origin xyz=\"1 2 3\"/><parent link=\"a\"/>\n"
    "    <child link=\"b\"/><axis xyz=\"0 3 -4\"/>\n"
    "    <limit lower=\"-0.5\" upper=\"1.5\" effort=\"7\" velocity=\"2\"/></joint>\n"
    "  <joint name=\"j2\" type=\"prismatic\"><parent link=\"b\"/><child link=\"c\"/>\n"
    "    <limit lower=\"-0.25\" upper=\"0.5\" effort=\"-7\" velocity=\"2\"/>\n"
    "    <mimic joint=\"j1\" multiplier=\"2.5\" offset=\"0.5\"/></joint>\n"
    "  <joint name=\"j3\" type=\"continuous\"><parent link=\"c\"/><child link=\"d\"/>\n"
    "    <mimic joint=\"j2\"/></joint>\n"
    "  <joint name=\"j4\" type=\"fixed\"><parent link=\"b\"/><child link=\"e\"/></joint>\n"
    "  <joint name=\"j5\" type=\"continuous\"><parent link=\"e\"/><child link=\"f\"/>\n"
    "    <limit lower=\"1\" upper=\"0\" effort=\"1\" velocity=\"-3\"/></joint>\n"
    "  <material name=\"later\"><color rgba=\"0 1 0 1\"/></material>\n"
    "</robot>\n";

static void read_text(const char *text, CagUrdfTree *t) {
  OK(cag_urdf_read("arm.urdf", text, strlen(text), t, &err));
}

static void is_color(const CagUrdfBody *b, double r, double g, double bl, double alpha) {
  assert_true(b->colored);
  is_near(b->color.r, linear(r), 1e-12, "red");
  is_near(b->color.g, linear(g), 1e-12, "green");
  is_near(b->color.b, linear(bl), 1e-12, "blue");
  is_near(b->alpha, alpha, 0, "alpha");
}

static void every_value_is_read(void **state) {
  (void)state;
  CagUrdfTree t;
  read_text(robot_text, &t);
  assert_string_equal(t.name, "arm");
  assert_int_equal(t.node_count, 6);
  assert_int_equal(t.edge_count, 5);
  const CagUrdfBody *b = t.nodes[0].visuals;
  assert_int_equal(b->kind, CAG_URDF_BODY_BOX);
  for (int i = 0; i < 3; i++) is_near(b->size[i], 100 * (i + 1), 1e-9, "side");
  is_color(b, 0.5, 0.02, 1, 0.25); // of the named material, brought into the range
  // Roll about x, then pitch about y, then yaw about z.
  const double r = 0.4, p = 0.5, y = -0.6;
  const double m[3][4] = {{cos(y) * cos(p), cos(y) * sin(p) * sin(r) - sin(y) * cos(r),
                           cos(y) * sin(p) * cos(r) + sin(y) * sin(r), 100},
                          {sin(y) * cos(p), sin(y) * sin(p) * sin(r) + cos(y) * cos(r),
                           sin(y) * sin(p) * cos(r) - cos(y) * sin(r), -200},
                          {-sin(p), cos(p) * sin(r), cos(p) * cos(r), 300}};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++) is_near(b->place.m[i][j], m[i][j], 1e-9, "place");
  b = b->next;
  assert_int_equal(b->kind, CAG_URDF_BODY_SPHERE);
  is_near(b->size[0], 20, 1e-9, "radius");
  is_color(b, 1, 0, 0, 1);
  b = b->next;
  assert_int_equal(b->kind, CAG_URDF_BODY_MESH);
  assert_string_equal(b->file, "m.stl");
  assert_true(b->scale[0] == 1 && b->scale[1] == 2 && b->scale[2] == -3);
  is_color(b, 0, 1, 0, 1); // of a material that stands behind
  b = b->next;
  assert_string_equal(b->file, "n.stl");
  assert_string_equal(b->material, "unknown");
  assert_true(b->scale[0] == 1 && b->scale[1] == 1 && b->scale[2] == 1);
  assert_false(b->colored);
  assert_null(b->next);
  b = t.nodes[0].collisions;
  assert_int_equal(b->kind, CAG_URDF_BODY_CYLINDER);
  is_near(b->size[0], 50, 1e-9, "radius");
  is_near(b->size[1], 700, 1e-9, "length");
  assert_null(b->next);
  is_color(t.nodes[1].visuals, 1, 0, 0, 1); // a material told in a body is known from then on
  static const size_t above[] = {CAG_URDF_NONE, 0, 1, 2, 3, 4};
  for (size_t i = 0; i < 6; i++) assert_true(t.nodes[i].above == above[i]);
  const CagUrdfEdge *e = t.edges;
  const double turn = 2 * M_PI;
  static const CagUrdfJointKind kinds[] = {CAG_URDF_REVOLUTE, CAG_URDF_PRISMATIC,
                                           CAG_URDF_CONTINUOUS, CAG_URDF_FIXED,
                                           CAG_URDF_CONTINUOUS};
  static const size_t ends[5][2] = {{0, 1}, {1, 2}, {2, 3}, {1, 4}, {4, 5}};
  const double values[5][4] = {{-0.5, 1.5, 2, 7},
                               {-250, 500, 2000, 0},
                               {-turn, turn, 0, 0},
                               {0, 0, 0, 0},
                               {-turn, turn, 0, 1}};
  for (int i = 0; i < 5; i++) {
    assert_int_equal(e[i].kind, kinds[i]);
    assert_int_equal(e[i].parent, ends[i][0]);
    assert_int_equal(e[i].child, ends[i][1]);
    is_near(e[i].low, values[i][0], 1e-9, "low");
    is_near(e[i].high, values[i][1], 1e-9, "high");
    is_near(e[i].speed, values[i][2], 1e-9, "speed");
    is_near(e[i].effort, values[i][3], 0, "effort");
  }
  is_near(e[0].axis.y, 0.6, 1e-12, "axis");
  is_near(e[0].axis.z, -0.8, 1e-12, "axis");
  is_near(e[0].origin.m[2][3], 3000, 1e-9, "origin");
  assert_true(e[1].axis.x == 1 && e[1].axis.y == 0); // the default
  assert_string_equal(e[1].mimic, "j1");
  assert_true(e[1].multiplier == 2.5 && e[1].offset == 0.5);
  assert_true(e[2].multiplier == 1 && e[2].offset == 0 && !e[0].mimic);
  cag_urdf_tree_free(&t);
}

static void sizes_must_be_greater_than_zero(void **state) {
  (void)state;
  static const struct {
    const char *geometry;
    bool read;
  } cases[] = {{"<box size=\"1 1 1\"/>", true},
               {"<box size=\"0 1 1\"/>", false},
               {"<box size=\"1 0 1\"/>", false},
               {"<box size=\"1 1 0\"/>", false},
               {"<box size=\"1 1\"/>", false},
               {"<box size=\"1 1 1 1\"/>", false},
               {"<box size=\"1 1 -1\"/>", false},
               {"<box/>", false},
               {"<sphere radius=\"0\"/>", false},
               {"<sphere radius=\"1\"/>", true},
               {"<sphere radius=\"x\"/>", false},
               {"<cylinder radius=\"1\"/>", false},
               {"<cylinder length=\"1\"/>", false},
               {"<cylinder radius=\"1\" length=\"1\"/>", true},
               {"<cylinder radius=\"0\" length=\"1\"/>", false},
               {"<cylinder radius=\"1\" length=\"0\"/>", false},
               {"<mesh/>", false},
               {"<mesh filename=\"\"/>", false},
               {"<mesh filename=\"a\" scale=\"1 0 1\"/>", false},
               {"<mesh filename=\"a\" scale=\"1 1 0\"/>", false},
               {"<mesh filename=\"a\" scale=\"0 1 1\"/>", false},
               {"<mesh filename=\"a\" scale=\"-1 1 1\"/>", true},
               {"<cone/>", false}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char text[400];
    snprintf(text, sizeof text,
             "<robot><link name=\"a\"><visual><geometry>%s</geometry></visual></link></robot>",
             cases[i].geometry);
    CagUrdfTree t;
    CagError err = {0};
    const CagStatus status = cag_urdf_read("a", text, strlen(text), &t, &err);
    if ((status == CAG_OK) != cases[i].read) fail_msg("%s", cases[i].geometry);
    if (status != CAG_OK) assert_string_equal(cag_error_info(err.id)->reason, "urdf-syntax");
    cag_urdf_tree_free(&t);
  }
}

// The chains of a tree by the names of base and tip.
static void chains_lead_from_base_to_tip(void **state) {
  (void)state;
  static const struct {
    const char *base, *tip, *chain, *reason;
  } cases[] = {{NULL, NULL, NULL, "urdf-branches"},
               {"a", NULL, NULL, "urdf-branches"},
               {"c", NULL, "j3", NULL},
               {"e", NULL, "j5", NULL},
               {"d", NULL, "", NULL},
               {NULL, "d", "j1 j2 j3", NULL},
               {NULL, "f", "j1 j4 j5", NULL},
               {NULL, "a", "", NULL},
               {"a", "c", "j1 j2", NULL},
               {"b", "f", "j4 j5", NULL},
               {"b", "b", "", NULL},
               {"c", "f", NULL, "urdf-chain"},
               {"f", "b", NULL, "urdf-chain"},
               {"x", NULL, NULL, "urdf-chain"},
               {NULL, "x", NULL, "urdf-chain"},
               {"a", "x", NULL, "urdf-chain"}};
  CagUrdfTree t;
  read_text(robot_text, &t);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    size_t *chain = NULL, n = 0;
    CagError err = {0};
    const CagStatus status = cag_urdf_chain(&t, cases[i].base, cases[i].tip, &chain, &n, &err);
    if ((status == CAG_OK) != (cases[i].chain != NULL)) fail_msg("case %zu: %s", i, err.message);
    if (status != CAG_OK) {
      assert_string_equal(cag_error_info(err.id)->reason, cases[i].reason);
      continue;
    }
    char found[100] = "";
    for (size_t k = 0; k < n; k++) {
      if (k > 0) strcat(found, " ");
      strcat(found, t.edges[chain[k]].name);
    }
    assert_string_equal(found, cases[i].chain);
    free(chain);
  }
  size_t *chain, n;
  CagError err = {0};
  assert_int_equal(cag_urdf_chain(&t, NULL, NULL, &chain, &n, &err), CAG_E_ARGUMENT);
  assert_non_null(
      strstr(err.message, "after the link \"b\", the robot branches, to the ends \"d\", \"f\";"));
  cag_urdf_tree_free(&t);
}

// Two roots, a ring, and a ring behind a root.
static void trees_without_one_root_are_refused(void **state) {
  (void)state;
#define JOINT(name, a, b)                                                                          \
  "<joint name=\"" name "\" type=\"fixed\"><parent link=\"" a "\"/>"                               \
  "<child link=\"" b "\"/></joint>"
#define LINKS "<link name=\"a\"/><link name=\"b\"/><link name=\"c\"/>"
  static const struct {
    const char *text, *tip, *reason, *part;
  } cases[] = {
      {"<robot>" LINKS JOINT("j", "a", "b") "</robot>", NULL, "urdf-branches",
       "parent joint: \"a\", \"c\";"},
      {"<robot>" LINKS JOINT("j", "a", "b") JOINT("k", "b", "c") JOINT("l", "c", "a") "</robot>",
       NULL, "urdf-chain", "there is no first link"},
      {"<robot>" LINKS JOINT("j", "a", "b") JOINT("k", "b", "c") JOINT("l", "c", "a") "</robot>",
       "c", "urdf-chain", "form a loop"}};
  for (size_t i = 0; i < 3; i++) {
    CagUrdfTree t;
    CagError err = {0};
    size_t *chain, n;
    read_text(cases[i].text, &t);
    assert_int_equal(cag_urdf_chain(&t, NULL, cases[i].tip, &chain, &n, &err), CAG_E_ARGUMENT);
    assert_string_equal(cag_error_info(err.id)->reason, cases[i].reason);
    if (!strstr(err.message, cases[i].part)) fail_msg("%s", err.message);
    cag_urdf_tree_free(&t);
  }
}

// --- Masses ---

static CagTransform random_place(double size) {
  CagTransform t, move;
  CagVec3 axis, at;
  axis.x = uniform(-1, 1);
  axis.y = uniform(-1, 1);
  axis.z = uniform(-1, 1);
  at.x = uniform(-size, size);
  at.y = uniform(-size, size);
  at.z = uniform(-size, size);
  OK(cag_rotate(axis, uniform(-3, 3), cag_vec3(0, 0, 0), &t, &err));
  move = cag_translate(at);
  return cag_transform_multiply(&move, &t);
}

static void is_mass(const CagUrdfMass *a, const CagUrdfMass *b, double part, const char *what) {
  const double size = cbrt(b->mass) * 1e3;
  is_near(a->mass, b->mass, part * b->mass, what);
  if (!(cag_norm(cag_sub(a->center, b->center)) <= part * (size + cag_norm(b->center))))
    fail_msg("%s: the center", what);
  double most = 0;
  for (int i = 0; i < 3; i++) most = fmax(most, b->inertia[i][i]);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) is_near(a->inertia[i][j], b->inertia[i][j], part * most, what);
}

// A box and a cylinder as plain bodies, as solids, as meshes, and as closed surfaces with any
// normals: the same mass, center, and inertia, wherever they are. The solids are measured by
// another part of the program.
static void bodies_weigh_the_same_in_every_form(void **state) {
  (void)state;
  seed = 51;
  for (int round = 0; round < 20; round++) {
    const CagTransform place = random_place(round % 2 ? 100 : 30000);
    const double a = uniform(10, 200), b = uniform(10, 200), c = uniform(10, 200), density = 2700;
    CagUrdfShape shape = {.kind = CAG_URDF_BOX, .place = place, .size = {a, b, c}};
    CagSolid *box, *moved;
    CagTransform middle = cag_translate(cag_vec3(0, 0, -c / 2));
    const bool round_one = round % 4 > 1;
    if (round_one) {
      shape = (CagUrdfShape){.kind = CAG_URDF_CYLINDER, .place = place, .size = {b, c}};
      CagSolid *can;
      OK(cag_solid_cylinder(c, b, b, &can, &err));
      OK(cag_solid_transform(can, &middle, &box, &err));
      cag_solid_release(can);
    } else OK(cag_solid_box(cag_vec3(a, b, c), true, &box, &err));
    OK(cag_solid_transform(box, &place, &moved, &err));
    const CagUrdfMass plain = cag_urdf_plain_mass(&shape, density);
    is_near(plain.mass, density * 1e-9 * (round_one ? M_PI * b * b * c : a * b * c),
            1e-12 * plain.mass, "mass");
    CagUrdfMass mass;
    CagItem item = {.kind = CAG_ITEM_SOLID, .as.solid = moved};
    OK(cag_urdf_item_mass(&item, density, &mass, &err));
    is_mass(&mass, &plain, 1e-9, "solid");
    if (!round_one) {
      CagMesh *m;
      OK(cag_solid_tessellate(moved, NULL, &m, &err));
      item = (CagItem){.kind = CAG_ITEM_MESH, .as.mesh = m};
      OK(cag_urdf_item_mass(&item, density, &mass, &err));
      is_mass(&mass, &plain, 1e-9, "mesh");
      for (size_t t = 0; t < m->triangle_count; t++) { // inside out
        const uint32_t first = m->triangles[3 * t];
        m->triangles[3 * t] = m->triangles[3 * t + 1];
        m->triangles[3 * t + 1] = first;
      }
      OK(cag_urdf_item_mass(&item, density, &mass, &err));
      is_mass(&mass, &plain, 1e-9, "mesh inside out");
      m->triangle_count--; // open
      OK(cag_urdf_item_mass(&item, density, &mass, &err));
      assert_true(mass.mass == 0);
      cag_mesh_release(m);
    } else {
      const CagVec3 up[] = {{0, 0, -c / 2}, {b, 0, -c / 2}, {b, 0, c / 2}, {0, 0, c / 2}};
      const CagVec3 down[] = {up[3], up[2], up[1], up[0]};
      for (int k = 0; k < 2; k++) {
        CagCurve *profile;
        CagSurface *s, *at;
        OK(cag_curve_polyline(k ? down : up, 4, false, 3, &profile, &err));
        OK(cag_surface_revolve(profile, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0, 2 * M_PI, &s,
                               &err));
        OK(cag_surface_transform(s, &place, &at, &err));
        item = (CagItem){.kind = CAG_ITEM_SURFACE, .as.surface = at};
        OK(cag_urdf_item_mass(&item, density, &mass, &err));
        is_mass(&mass, &plain, 1e-8, "surface");
        cag_curve_release(profile);
        cag_surface_release(s);
        cag_surface_release(at);
      }
    }
    cag_solid_release(box);
    cag_solid_release(moved);
  }
}

// Inertia about the origin is what adds up, for any bodies joined in any order (Steiner): of a body
// it is that about its center, and m (|c|^2 E - c c^T).
static void joined_bodies_add_up_about_the_origin(void **state) {
  (void)state;
  seed = 52;
  for (int round = 0; round < 30; round++) {
    CagUrdfMass whole = {0};
    double mass = 0, first[3] = {0}, about[3][3] = {{0}};
    for (int i = 0; i < 2 + round % 5; i++) {
      CagUrdfShape s = {.kind = i % 2 ? CAG_URDF_BOX : CAG_URDF_CYLINDER,
                        .place = random_place(300)};
      s.size[0] = uniform(10, 100);
      s.size[1] = uniform(10, 100);
      s.size[2] = uniform(10, 100);
      const CagUrdfMass one = cag_urdf_plain_mass(&s, uniform(500, 8000));
      const CagUrdfMass nothing = {.center = {1e9, 0, 0}};
      cag_urdf_mass_join(&whole, &one);
      cag_urdf_mass_join(&whole, &nothing);
      mass += one.mass;
      const double c[3] = {one.center.x, one.center.y, one.center.z},
                   square = cag_dot(one.center, one.center);
      for (int j = 0; j < 3; j++) {
        first[j] += one.mass * c[j];
        for (int k = 0; k < 3; k++)
          about[j][k] += one.inertia[j][k] + one.mass * ((j == k ? square : 0) - c[j] * c[k]);
      }
    }
    is_near(whole.mass, mass, 1e-12 * mass, "mass");
    const double c[3] = {whole.center.x, whole.center.y, whole.center.z};
    const double square = cag_dot(whole.center, whole.center);
    for (int j = 0; j < 3; j++) {
      is_near(c[j] * mass, first[j], 1e-9 * mass, "center");
      for (int k = 0; k < 3; k++)
        is_near(whole.inertia[j][k] + mass * ((j == k ? square : 0) - c[j] * c[k]), about[j][k],
                1e-10 * fabs(about[0][0]), "inertia");
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_value_is_read),
      cmocka_unit_test(sizes_must_be_greater_than_zero),
      cmocka_unit_test(chains_lead_from_base_to_tip),
      cmocka_unit_test(trees_without_one_root_are_refused),
      cmocka_unit_test(bodies_weigh_the_same_in_every_form),
      cmocka_unit_test(joined_bodies_add_up_about_the_origin),
  };
  return cmocka_run_group_tests_name("urdf_parts", tests, NULL, NULL);
}
