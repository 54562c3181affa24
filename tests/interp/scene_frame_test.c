// Viewing of scenes: cameras that frame all items, lenses, and the studio.

#include "interp/scene/scene.h"
#include "scene_checks.h"

// --- Framing ---

// The axes of a camera, by its definition.
typedef struct View {
  CagVec3 right, down, ahead;
} View;

static View view_of(const CagCamera *c) {
  View v;
  v.ahead = cag_unit(cag_sub(c->target, c->eye));
  v.right = cag_unit(cag_cross(v.ahead, c->up));
  v.down = cag_cross(v.ahead, v.right);
  return v;
}

// How far points are beyond the lines x = k z and x = -k z of the picture's edges: negative inside.
typedef struct Limits {
  double high, low;
} Limits;

static void reach(Limits *l, const CagCamera *c, CagVec3 axis, double k, CagVec3 p, double radius) {
  const CagVec3 d = cag_sub(p, c->eye);
  const double x = cag_dot(d, axis), z = cag_dot(d, cag_unit(cag_sub(c->target, c->eye)));
  const double around = radius * sqrt(1 + k * k); // the line is tangent to the ball
  l->high = fmax(l->high, x - k * z + around);
  l->low = fmin(l->low, x + k * z - around);
}

// Boxes, balls, and lines at any location, seen from any direction: the picture is centered, with a
// margin of 9% of half its size, and a closer camera would not show everything.
static void everything_just_fits(void **state) {
  (void)state;
  seed = 21;
  for (int round = 0; round < 60; round++) {
    Fixture f;
    fixture_begin(&f);
    const double size = pow(10, uniform(-2, 3));
    CagVec3 points[40];
    double radii[40];
    size_t n = 0;
    f.scene.bounds = CAG_BOUNDS_EMPTY;
    for (int i = 0; i < 1 + round % 4; i++) {
      const CagVec3 at = random_vec(size);
      const double r = uniform(0.1, 0.5) * size;
      const int kind = (round / 4 + i) % 3;
      if (kind == 0) {
        CagTransform t = cag_translate(at);
        CagSolid *ball, *moved;
        OK(cag_solid_sphere(r, &ball, &err));
        OK(cag_solid_transform(ball, &t, &moved, &err));
        cag_solid_release(ball);
        fixture_solid(&f, "ball", moved);
        points[n] = at;
        radii[n++] = r;
      } else if (kind == 1) {
        CagTransform t = cag_translate(at);
        CagSolid *box, *moved;
        OK(cag_solid_box(cag_vec3(r, 2 * r, 3 * r), false, &box, &err));
        OK(cag_solid_transform(box, &t, &moved, &err));
        cag_solid_release(box);
        fixture_solid(&f, "box", moved);
        for (int k = 0; k < 8; k++) {
          points[n] = cag_add(at, cag_vec3(k & 1 ? r : 0, k & 2 ? 2 * r : 0, k & 4 ? 3 * r : 0));
          radii[n++] = 0;
        }
      } else {
        CagCurve *line;
        CagVec3 to = random_vec(size);
        if (round % 2) to.x = at.x;
        OK(cag_curve_line(at, to, 3, &line, &err));
        fixture_curve(&f, "line", line);
        points[n] = at, radii[n++] = 0;
        points[n] = to, radii[n++] = 0;
      }
    }
    for (size_t i = 0; i < f.scene.item_count; i++) {
      CagBounds box;
      OK(cag_item_bounds(&f.items[i], NULL, &box, &err));
      cag_bounds_add(&f.scene.bounds, box.min);
      cag_bounds_add(&f.scene.bounds, box.max);
    }
    CagCamera c = {.orthographic = round % 5 == 4, .fov = uniform(0.2, 1.2), .size = {160, 90}};
    if (round % 3 == 0) c.size[0] = 60;
    c.eye = random_vec(9);
    c.target = random_vec(2);
    const CagVec3 ahead = cag_unit(cag_sub(c.target, c.eye));
    c.up = cag_unit(cag_cross(cag_cross(ahead, cag_vec3(0.1, 0.2, 1)), ahead));
    cag_camera_frame_all(&f.scene, &c);
    const View v = view_of(&c);
    is_point(v.ahead, ahead, "the direction stays");
    const double aspect = (double)c.size[0] / c.size[1];
    const double k = c.orthographic ? 0 : tan(c.fov / 2) * 0.91;
    Limits l[2];
    const CagVec3 axes[2] = {v.right, v.down};
    double wide[2], most = -INFINITY;
    for (int a = 0; a < 2; a++) {
      l[a] = (Limits){-INFINITY, INFINITY};
      for (size_t i = 0; i < n; i++)
        reach(&l[a], &c, axes[a], a == 0 ? k : k / aspect, points[i], radii[i]);
      is_near(l[a].high, -l[a].low, 1e-7 * size, "centered");
      wide[a] = l[a].high - l[a].low;
      most = fmax(most, l[a].high);
    }
    if (c.orthographic)
      is_near(c.width * 0.91, fmax(wide[0], wide[1] * aspect), 1e-7 * size, "width");
    else is_near(most, 0, 1e-7 * size, "as near as it can be");
    fixture_end(&f);
  }
}

// A single point is seen from twice the default radius of scenes without a size.
static void a_point_is_seen_from_some_distance(void **state) {
  (void)state;
  Fixture f;
  CagCurve *c;
  fixture_begin(&f);
  OK(cag_curve_resting(cag_vec3(1, 2, 3), 3, 0, 1, false, &c, &err));
  fixture_curve(&f, "point", c);
  f.scene.bounds = (CagBounds){{1, 2, 3}, {1, 2, 3}};
  CagCamera camera = f.camera;
  cag_camera_frame_all(&f.scene, &camera);
  is_point(camera.target, cag_vec3(1, 2, 3), "target");
  is_point(camera.eye, cag_vec3(1, 0, 3), "eye");
  camera.orthographic = true;
  cag_camera_frame_all(&f.scene, &camera);
  assert_true(camera.width > 0 && camera.width < 1e-6);
  fixture_end(&f);
}

// Without items, a box about the origin is framed.
static void an_empty_scene_has_room_about_the_origin(void **state) {
  (void)state;
  const CagScene s = {.bounds = CAG_BOUNDS_EMPTY};
  const CagBounds b = cag_scene_framed(&s);
  is_point(b.min, cag_vec3(-50, -50, 0), "least");
  is_point(b.max, cag_vec3(50, 50, 50), "most");
  is_near(cag_scene_radius(&b), 75, 1e-12, "half the diagonal"); // sqrt(100^2 + 100^2 + 50^2) / 2
  const CagBounds none = {{1, 2, 3}, {1, 2, 3}};
  assert_true(cag_scene_radius(&none) == 1);
}

// The views in order of their names: the camera of each looks from its side, with its own up
// direction.
static void standard_views_have_their_directions(void **state) {
  (void)state;
  static const struct {
    const char *name;
    CagVec3 back, up;
  } views[] = {{"top", {0, 0, 1}, {0, 1, 0}},    {"bottom", {0, 0, -1}, {0, -1, 0}},
               {"front", {0, -1, 0}, {0, 0, 1}}, {"back", {0, 1, 0}, {0, 0, 1}},
               {"left", {-1, 0, 0}, {0, 0, 1}},  {"right", {1, 0, 0}, {0, 0, 1}},
               {"iso", {1, -1, 1}, {-1, 1, 2}}};
  CagSession *s = shown("show box([2, 3, 4]), camera([9, 9, 9], size: [64, 48])");
  for (size_t i = 0; i < 7; i++) {
    CagError err = {0};
    assert_string_equal(cag_standard_view(i), views[i].name);
    assert_int_equal(cag_scene_add_view(&s->scene, views[i].name, &err), CAG_OK);
    assert_int_equal(s->scene.camera_count, i + 2);
    const CagCamera *c = &s->scene.cameras[i + 1];
    assert_string_equal(c->name, views[i].name);
    assert_true(c->orthographic && c->framed && c->size[0] == 64 && c->size[1] == 48);
    is_point(cag_unit(cag_sub(c->eye, c->target)), cag_unit(views[i].back), c->name);
    is_point(c->up, cag_unit(views[i].up), c->name);
  }
  assert_null(cag_standard_view(7));
  cag_session_free(s);
  s = shown("show box(1)");
  s->scene.camera_count--; // the first camera of a scene without one
  free(s->scene.cameras[0].name);
  CagError err = {0};
  assert_int_equal(cag_scene_add_view(&s->scene, "front", &err), CAG_OK);
  assert_true(s->scene.cameras[0].size[0] == 1280 && s->scene.cameras[0].size[1] == 720);
  cag_session_free(s);
}

// --- The studio ---

// The position of a light along the camera's right, up, and backward directions, in radii.
static CagVec3 light_position(const CagScene *s, size_t i) {
  const CagVec3 center = cag_lerp(s->bounds.min, s->bounds.max, 0.5);
  const double radius = cag_norm(cag_sub(s->bounds.max, s->bounds.min)) / 2;
  const CagVec3 d = cag_scaled(cag_sub(s->lights[i].position, center), 1 / radius);
  const CagVec3 right = view_of(&s->cameras[0]).right, back = cag_cross(right, cag_vec3(0, 0, 1));
  return cag_vec3(cag_dot(d, right), d.z, cag_dot(d, back));
}

// A warm key light from the camera's upper left, a dim cool fill light from its right, and a rim
// light from behind. They shine at the center, and rotate and scale with the scene and its camera.
static void studio_lights_go_with_the_camera_and_the_scene(void **state) {
  (void)state;
  static const char *const scripts[] = {
      "show box(2, centered: true), camera([0, -30, 10])",
      "show translate(box(20, centered: true), [5, 6, 7]), camera([305, 6, 207], [5, 6, 7])",
      "show box([0.2, 0.3, 0.1]), camera([-8, 9, 5])", "show box(3)"};
  CagVec3 first[3];
  for (int k = 0; k < 4; k++) {
    CagSession *session = shown(scripts[k]);
    const CagScene *s = &session->scene;
    assert_int_equal(s->light_count, 3);
    const double radius = cag_norm(cag_sub(s->bounds.max, s->bounds.min)) / 2;
    for (size_t i = 0; i < 3; i++) {
      const CagLight *l = &s->lights[i];
      const CagVec3 center = cag_lerp(s->bounds.min, s->bounds.max, 0.5);
      assert_int_equal(l->kind, CAG_LIGHT_AREA);
      is_point(l->direction, cag_unit(cag_sub(center, l->position)), "direction");
      const CagVec3 p = light_position(s, i);
      if (k == 0) first[i] = p;
      is_point(p, first[i], "place");
      assert_true(cag_norm(p) > 2 && l->size > radius && l->size < 4 * radius);
    }
    const CagLight *key = &s->lights[0], *fill = &s->lights[1], *rim = &s->lights[2];
    assert_true(first[0].x < -1 && first[0].y > 1 && first[0].z > 1);
    assert_true(first[1].x > 1 && first[1].y > 1 && first[1].z > 1);
    assert_true(first[2].y > 1 && first[2].z < -1);
    assert_true(key->strength > rim->strength && rim->strength > fill->strength);
    assert_true(key->color.r > key->color.b && fill->color.r < fill->color.b);
    is_near(key->strength + fill->strength + rim->strength, 1, 0.1, "a white face is nearly white");
    cag_session_free(session);
  }
}

// The floor is half a thousandth of the radius below the scene, but at most 1.5 thousandths of a
// millimeter, and at least 2e-5 of the radius. It is matte, and has the color of the horizon.
static void the_floor_lies_close_below(void **state) {
  (void)state;
  static const double sides[] = {0.1, 2, 20, 50, 1000};
  for (int k = 0; k < 5; k++) {
    char script[100];
    snprintf(script, sizeof script, "show translate(box(%g), [1, 2, 3])", sides[k]);
    CagSession *session = shown(script);
    const CagScene *s = &session->scene;
    const double r = sides[k] * sqrt(3) / 2;
    const double gap = r * 5e-4 <= 1.5e-3 ? r * 5e-4 : r * 2e-5 > 1.5e-3 ? r * 2e-5 : 1.5e-3;
    assert_int_equal(s->item_count, 2);
    const CagItem *floor = &s->items[1];
    assert_int_equal(floor->kind, CAG_ITEM_GROUND);
    is_near(3 - floor->ground_z, gap, 1e-12 * (1 + sides[k]), "gap");
    assert_true(isinf(floor->ground_size));
    const CagMaterial *m = &s->materials[floor->material];
    assert_string_equal(m->name, "studio_floor");
    assert_true(m->roughness == 1 && m->ior < 1.5);
    assert_int_equal(s->sky.color_count, 4);
    const CagColor *sky = s->sky.colors;
    is_near(m->color.g, (sky[1].g + sky[2].g) / 2, 0.06, "tone");
    for (int i = 0; i < 3; i++) assert_true(sky[i].g < sky[i + 1].g);
    cag_session_free(session);
  }
}

static void flat_scenes_lie_on_paper(void **state) {
  (void)state;
  CagSession *session = shown("show translate(rectangle(3, 2), [5, 6, 7])");
  const CagScene *s = &session->scene;
  const CagLight *l = &s->lights[0];
  assert_int_equal(l->kind, CAG_LIGHT_SUN);
  is_near(cag_norm(l->direction), 1, 1e-12, "length");
  assert_true(l->direction.z < -0.9 && l->strength == 0.8);
  assert_true(l->color.r == 1 && l->color.g == 1 && l->color.b == 1);
  assert_true(s->has_background && s->background.r == 1 && s->background.b == 1);
  assert_true(s->automatic_camera && s->cameras[0].orthographic);
  is_point(cag_unit(cag_sub(s->cameras[0].target, s->cameras[0].eye)), cag_vec3(0, 0, -1), "view");
  is_point(s->cameras[0].up, cag_vec3(0, 1, 0), "up");
  cag_session_free(session);
  session = shown("show rectangle(3, 2), background([0.25, 0.5, 1])");
  assert_true(session->scene.background.r == 0.25);
  cag_session_free(session);
  // A thickness of a thousandth of the width is not flat.
  session = shown("show box([1, 1, 0.001])");
  assert_false(session->scene.cameras[0].orthographic);
  is_point(cag_unit(cag_sub(session->scene.cameras[0].eye, session->scene.cameras[0].target)),
           cag_unit(cag_vec3(0.62, -1, 0.55)), "three quarters");
  cag_session_free(session);
}

// Empty shapes are removed from the items, wherever they are in the list.
static void empty_shapes_are_set_aside(void **state) {
  (void)state;
  CagSession *session =
      shown("e = box(1) & translate(box(1), [5, 0, 0])\n"
            "show e, named(box(2), \"a\"), e, named(sphere(3), \"b\"), e, sun(-Z)");
  const CagScene *s = &session->scene;
  assert_int_equal(s->item_count, 2);
  assert_int_equal(s->empty_count, 3);
  assert_string_equal(s->items[0].name, "a");
  assert_string_equal(s->items[1].name, "b");
  is_point(s->bounds.min, cag_vec3(-3, -3, -3), "least");
  is_point(s->bounds.max, cag_vec3(3, 3, 3), "most");
  cag_session_free(session);
  // Robots are shown in their home position.
  session = shown("show robot([revolute(a: 300), revolute(a: 100)]), sun(-Z)");
  assert_true(session->scene.item_count > 0);
  is_near(session->scene.bounds.max.x, 400, 40, "the end of the arm");
  cag_session_free(session);
  // A region without extent in x is not empty.
  session = shown("show rotate(rectangle(2, 3), Y, 90deg), translate(box(1), [4, 0, 0])");
  is_point(session->scene.bounds.min, cag_vec3(0, -1.5, -1), "least");
  is_point(session->scene.bounds.max, cag_vec3(5, 1.5, 1), "most");
  cag_session_free(session);
  // A line without extent in x is not empty.
  session = shown("show box(1), line([5, 0, 0], [5, 7, 8])");
  is_point(session->scene.bounds.max, cag_vec3(5, 7, 8), "most");
  cag_session_free(session);
}

// Only a perspective camera with an aperture has depth of field.
static void lenses_have_an_aperture(void **state) {
  (void)state;
  assert_false(cag_camera_has_lens(&(CagCamera){.aperture = 0}));
  assert_true(cag_camera_has_lens(&(CagCamera){.aperture = 1}));
  assert_false(cag_camera_has_lens(&(CagCamera){.aperture = 1, .orthographic = true}));
}

// The default width of lines is a fraction of the diagonal of the scene.

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(everything_just_fits),
      cmocka_unit_test(a_point_is_seen_from_some_distance),
      cmocka_unit_test(an_empty_scene_has_room_about_the_origin),
      cmocka_unit_test(standard_views_have_their_directions),
      cmocka_unit_test(studio_lights_go_with_the_camera_and_the_scene),
      cmocka_unit_test(the_floor_lies_close_below),
      cmocka_unit_test(flat_scenes_lie_on_paper),
      cmocka_unit_test(empty_shapes_are_set_aside),
      cmocka_unit_test(lenses_have_an_aperture),
  };
  return cmocka_run_group_tests_name("scene_frame", tests, NULL, NULL);
}
