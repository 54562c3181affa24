// What a scene is seen with: cameras that frame all items, the studio, colors of values, tubes of
// curves in space, and parts of meshes by material.

#include "interp/scene/color_scale.h"
#include "interp/scene/item_mesh.h"
#include "interp/scene/scene.h"
#include "interp/session/session.h"
#include "scene_fixture.h"
#include "session_support.h"
#include "tests/geom/random.h"

static CagSession *shown(const char *text) {
  CagSession *s = new_session();
  CagShownCounts counts;
  if (cag_session_run_text(s, "script", text, strlen(text)) != CAG_STATUS_OK ||
      cag_session_scene(s, &counts) != CAG_STATUS_OK) {
    cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr);
    fail_msg("there is no scene of: %s", text);
  }
  return s;
}

static void is_near(double x, double expected, double within, const char *what) {
  if (!(fabs(x - expected) <= within)) fail_msg("%s: %.12g, not %.12g", what, x, expected);
}

static void is_point(CagVec3 p, CagVec3 q, const char *what) {
  if (!(cag_norm(cag_sub(p, q)) < 1e-9))
    fail_msg("%s: [%g, %g, %g], not [%g, %g, %g]", what, p.x, p.y, p.z, q.x, q.y, q.z);
}

static CagVec3 random_vec(double size) {
  CagVec3 v;
  v.x = uniform(-size, size);
  v.y = uniform(-size, size);
  v.z = uniform(-size, size);
  return v;
}

// --- Framing ---

// A camera's own directions, by its definition.
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

// How far points reach beyond the lines x = k z and x = -k z of the picture: negative inside.
typedef struct Limits {
  double high, low;
} Limits;

static void reach(Limits *l, const CagCamera *c, CagVec3 axis, double k, CagVec3 p, double radius) {
  const CagVec3 d = cag_sub(p, c->eye);
  const double x = cag_dot(d, axis), z = cag_dot(d, cag_unit(cag_sub(c->target, c->eye)));
  const double around = radius * sqrt(1 + k * k); // a ball touches the line
  l->high = fmax(l->high, x - k * z + around);
  l->low = fmin(l->low, x + k * z - around);
}

// Boxes, balls and lines anywhere, seen in any direction: the picture is centered, 9% of half its
// size stay free, and no nearer camera would do.
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

// A single point is seen from twice the radius that a scene without a size has.
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

// The views by name, in order; a camera of each looks from its side with its own up.
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

// Where a light stands to the camera's right, up, and back to the camera, in radii.
static CagVec3 place_of(const CagScene *s, size_t i) {
  const CagVec3 center = cag_lerp(s->bounds.min, s->bounds.max, 0.5);
  const double radius = cag_norm(cag_sub(s->bounds.max, s->bounds.min)) / 2;
  const CagVec3 d = cag_scaled(cag_sub(s->lights[i].position, center), 1 / radius);
  const CagVec3 right = view_of(&s->cameras[0]).right, back = cag_cross(right, cag_vec3(0, 0, 1));
  return cag_vec3(cag_dot(d, right), d.z, cag_dot(d, back));
}

// A warm key light from the camera's upper left, a dim cool fill from its right, and a rim light
// from behind. They shine at the center and turn and grow with the scene and its camera.
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
      const CagVec3 p = place_of(s, i);
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

// The floor is as far below as half a thousandth of the radius, at most 1.5 thousandths of a
// millimeter, and at least 2e-5 of the radius. It is matte, and its tone that of the horizon.
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
  // A thousandth of its width is not flat.
  session = shown("show box([1, 1, 0.001])");
  assert_false(session->scene.cameras[0].orthographic);
  is_point(cag_unit(cag_sub(session->scene.cameras[0].eye, session->scene.cameras[0].target)),
           cag_unit(cag_vec3(0.62, -1, 0.55)), "three quarters");
  cag_session_free(session);
}

// Empty shapes are taken out of the items, whatever stands before and behind them.
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
  // Robots are shown at home.
  session = shown("show robot([revolute(a: 300), revolute(a: 100)]), sun(-Z)");
  assert_true(session->scene.item_count > 0);
  is_near(session->scene.bounds.max.x, 400, 40, "the end of the arm");
  cag_session_free(session);
  // Nor is a region without a width in x empty.
  session = shown("show rotate(rectangle(2, 3), Y, 90deg), translate(box(1), [4, 0, 0])");
  is_point(session->scene.bounds.min, cag_vec3(0, -1.5, -1), "least");
  is_point(session->scene.bounds.max, cag_vec3(5, 1.5, 1), "most");
  cag_session_free(session);
  // A line that has no width in x is not empty.
  session = shown("show box(1), line([5, 0, 0], [5, 7, 8])");
  is_point(session->scene.bounds.max, cag_vec3(5, 7, 8), "most");
  cag_session_free(session);
}

// --- Colors ---

static void srgb_is_that_of_its_definition(void **state) {
  (void)state;
  assert_true(cag_linear_to_srgb(0.0031308) == 12.92 * 0.0031308);
  assert_true(cag_srgb_to_linear(0.04045) == 0.04045 / 12.92);
  for (int k = 0; k <= 1000; k++) {
    const double c = k / 1000.0;
    const double s = c < 0.0031308 ? 12.92 * c : 1.055 * exp(log(c) / 2.4) - 0.055;
    is_near(cag_linear_to_srgb(c), s, 1e-12, "to sRGB");
    is_near(cag_srgb_to_linear(cag_linear_to_srgb(c)), c, 1e-7, "and back");
  }
  CagColor c;
  assert_true(cag_color_from_text("#4080c0", &c));
  is_near(c.r, cag_srgb_to_linear(0x40 / 255.0), 1e-15, "red");
  is_near(c.g, cag_srgb_to_linear(0x80 / 255.0), 1e-15, "green");
  is_near(c.b, cag_srgb_to_linear(0xc0 / 255.0), 1e-15, "blue");
}

static void is_srgb(CagColor c, double r, double g, double b, const char *what) {
  is_near(cag_linear_to_srgb(c.r) * 255, r, 1e-3, what);
  is_near(cag_linear_to_srgb(c.g) * 255, g, 1e-3, what);
  is_near(cag_linear_to_srgb(c.b) * 255, b, 1e-3, what);
}

// Viridis at tenths, as published with matplotlib; the middle of two of them is the mean in sRGB.
static void scales_have_their_published_colors(void **state) {
  (void)state;
  static const int viridis[11][3] = {{68, 1, 84},    {72, 36, 117},  {65, 68, 135},  {53, 95, 141},
                                     {42, 120, 142}, {33, 145, 140}, {34, 168, 132}, {68, 191, 112},
                                     {122, 209, 81}, {189, 223, 38}, {253, 231, 37}};
  const CagColorScale scale = {CAG_SCALE_SEQUENCE, -20, 30, 0};
  for (int i = 0; i <= 10; i++) {
    const int *a = viridis[i], *b = viridis[i < 10 ? i + 1 : i];
    const double value = -20 + 5 * i;
    is_srgb(cag_color_scale_at(&scale, value), a[0], a[1], a[2], "a tenth");
    if (i < 10)
      is_srgb(cag_color_scale_at(&scale, value + 2.5), (a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0,
              (a[2] + b[2]) / 2.0, "between");
  }
  is_srgb(cag_color_scale_at(&scale, -1e9), 68, 1, 84, "below");
  is_srgb(cag_color_scale_at(&scale, 1e9), 253, 231, 37, "above");
  is_srgb(cag_color_scale_at(&scale, NAN), 128, 128, 128, "no number");
  // Moreland's cool to warm: blue, nearly white, red.
  const CagColorScale diverging = {CAG_SCALE_DIVERGING, -1, 1, 0};
  is_srgb(cag_color_scale_at(&diverging, -1), 59, 76, 192, "cool");
  is_srgb(cag_color_scale_at(&diverging, 0), 221, 220, 220, "middle");
  is_srgb(cag_color_scale_at(&diverging, 1), 180, 4, 38, "warm");
}

// Stripes change sharply, beginning with a light one; stops are the colors at their places.
static void stops_are_the_colors_of_the_scale(void **state) {
  (void)state;
  static const CagColorScaleKind kinds[] = {CAG_SCALE_SEQUENCE, CAG_SCALE_DIVERGING,
                                            CAG_SCALE_STRIPES};
  CagColorStop stops[CAG_SCALE_STOPS_MAX];
  for (int k = 0; k < 3; k++)
    for (int stripes = 1; stripes <= CAG_SCALE_STRIPES_MAX; stripes += 13) {
      const CagColorScale scale = {kinds[k], 10, 12, stripes};
      const size_t n = cag_color_scale_stops(&scale, stops);
      assert_true(stops[0].at == 0 && stops[n - 1].at == 1);
      if (k == 2) assert_int_equal(n, 4 * stripes);
      for (size_t i = 0; i + 1 < n; i++) {
        assert_true(stops[i].at <= stops[i + 1].at);
        if (k == 2) assert_true((stops[i].at == stops[i + 1].at) == (i % 2 == 1));
        for (int j = 0; j < 5; j++) {
          const double t = 0.1 + 0.2 * j, at = stops[i].at + t * (stops[i + 1].at - stops[i].at);
          if (stops[i].at == stops[i + 1].at) continue;
          const CagColor c = cag_color_scale_at(&scale, 10 + 2 * at);
          const CagColor a = stops[i].color, b = stops[i + 1].color;
          is_near(c.r, a.r + t * (b.r - a.r), 2e-3, "red");
          is_near(c.g, a.g + t * (b.g - a.g), 2e-3, "green");
          is_near(c.b, a.b + t * (b.b - a.b), 2e-3, "blue");
          if (k == 2) assert_true((c.r > 0.5) == (i / 2 % 2 == 0));
        }
      }
      if (k == 2) {
        assert_true(cag_color_scale_at(&scale, 9).r > 0.5);
        assert_true(cag_color_scale_at(&scale, 13).r < 0.5);
      }
    }
}

// --- Tubes ---

static CagMesh *tube_of(const CagCurve *c, double radius, double dash) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *m = NULL;
  OK(cag_curve_tube_mesh(c, radius, dash, &how, &m, &err));
  return m;
}

static double volume_of(const CagMesh *m) {
  double v = 0;
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    v += cag_dot(m->positions[k[0]], cag_cross(m->positions[k[1]], m->positions[k[2]])) / 6;
  }
  return v;
}

static const CagVec3 *sorted_positions;

static int by_position(const void *a, const void *b) {
  const CagVec3 *p = sorted_positions + *(const uint32_t *)a;
  const CagVec3 *q = sorted_positions + *(const uint32_t *)b;
  const double d[3] = {p->x - q->x, p->y - q->y, p->z - q->z};
  for (int k = 0; k < 3; k++)
    if (d[k] != 0) return d[k] < 0 ? -1 : 1;
  return 0;
}

typedef struct Edge {
  uint32_t low, high;
  int up; // 1: from low to high, else -1
} Edge;

static int by_ends(const void *a, const void *b) {
  const Edge *e = a, *f = b;
  if (e->low != f->low) return e->low < f->low ? -1 : 1;
  return e->high < f->high ? -1 : e->high > f->high;
}

// Each edge between points has two triangles, which run through it in opposite directions.
static bool is_closed(const CagMesh *m) {
  const size_t n = 3 * m->triangle_count;
  uint32_t *order = malloc(m->vertex_count * sizeof *order);
  uint32_t *point = malloc(m->vertex_count * sizeof *point);
  Edge *edges = malloc(n * sizeof *edges);
  for (uint32_t v = 0; v < m->vertex_count; v++) order[v] = v;
  sorted_positions = m->positions;
  qsort(order, m->vertex_count, sizeof *order, by_position);
  for (size_t i = 0; i < m->vertex_count; i++)
    point[order[i]] =
        i > 0 && by_position(&order[i - 1], &order[i]) == 0 ? point[order[i - 1]] : order[i];
  for (size_t i = 0; i < n; i++) {
    const uint32_t a = point[m->triangles[i]], b = point[m->triangles[i % 3 == 2 ? i - 2 : i + 1]];
    edges[i] = (Edge){a < b ? a : b, a < b ? b : a, a < b ? 1 : -1};
  }
  qsort(edges, n, sizeof *edges, by_ends);
  bool good = n % 2 == 0;
  for (size_t i = 0; good && i + 1 < n; i += 2)
    good = by_ends(&edges[i], &edges[i + 1]) == 0 && edges[i].up + edges[i + 1].up == 0 &&
           (i + 2 == n || by_ends(&edges[i + 1], &edges[i + 2]) != 0);
  free(order);
  free(point);
  free(edges);
  return good;
}

// A closed mesh whose triangles look to the same side as the normals of their corners, and all of
// whose vertices are used. No vertex is farther from the curve than `most`.
static void check_tube(const CagCurve *c, const CagMesh *m, double most) {
  assert_true(is_closed(m));
  bool *used = calloc(m->vertex_count, sizeof *used);
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    const CagVec3 a = m->positions[k[0]];
    const CagVec3 n = cag_cross(cag_sub(m->positions[k[1]], a), cag_sub(m->positions[k[2]], a));
    assert_true(cag_norm(n) > 0);
    for (int j = 0; j < 3; j++) {
      assert_true(cag_dot(n, m->normals[k[j]]) > 0);
      used[k[j]] = true;
    }
  }
  for (size_t v = 0; v < m->vertex_count; v++) {
    assert_true(used[v]);
    is_near(cag_norm(m->normals[v]), 1, 1e-9, "a normal's length");
    double least = INFINITY;
    CagVec3 before = {0, 0, 0};
    for (int i = 0; i <= 600; i++) {
      CagVec3 p;
      OK(cag_curve_eval(c, c->start + (c->end - c->start) * i / 600, 0, CAG_SIDE_LEFT, &p, &err));
      const CagVec3 d = i ? cag_sub(p, before) : cag_vec3(0, 0, 0);
      const double s = cag_dot(d, d);
      const double t = s > 0 ? cag_dot(cag_sub(m->positions[v], before), d) / s : 0;
      const CagVec3 q = i ? cag_madd(before, fmin(fmax(t, 0), 1), d) : p;
      least = fmin(least, cag_norm(cag_sub(m->positions[v], q)));
      before = p;
    }
    if (least > most) fail_msg("vertex %zu is %g off the curve", v, least);
  }
  free(used);
}

#define SECTION (6 * sin(M_PI / 6)) // of a dodecagon about a circle of radius 1

static void tubes_follow_curves_in_space(void **state) {
  (void)state;
  seed = 31;
  for (int round = 0; round < 12; round++) {
    CagCurve *c, *turned;
    CagTransform t;
    const double radius = 0.4;
    CagVec3 p[8];
    const double knots[] = {-3, -2, -1, 0, 1, 2, 3, 4, 5, 6, 7, 8};
    for (int i = 0; i < 8; i++) { // about a circle, up and down
      p[i].x = 20 * cos(2 * M_PI * i / 5);
      p[i].y = 20 * sin(2 * M_PI * i / 5);
      p[i].z = i % 5 == 1 ? 12 : i % 5 == 3 ? -9 : 2;
    }
    if (round % 3 == 0) OK(cag_curve_helix(15, 9, 2, 0, &c, &err));
    else if (round % 3 == 1) OK(cag_curve_bezier(p, NULL, 5, 3, &c, &err));
    else OK(cag_curve_nurbs(p, NULL, 8, 3, knots, 3, &c, &err));
    const CagVec3 axis = random_vec(1);
    OK(cag_rotate(axis, uniform(0, 6), cag_vec3(0, 0, 0), &t, &err));
    OK(cag_curve_transform(c, &t, &turned, &err));
    CagMesh *m = tube_of(turned, radius, 0);
    check_tube(turned, m, 1.1 * radius + 0.02);
    double length;
    OK(cag_curve_length(turned, turned->start, turned->end, &length, &err));
    const double volume = length * radius * radius * SECTION;
    is_near(volume_of(m), volume, 0.01 * volume, "volume");
    cag_mesh_release(m);
    cag_curve_release(c);
    cag_curve_release(turned);
  }
}

// Rings of a closed tube turn against each other by the same small angle, the last one against the
// first as well.
static void closed_tubes_turn_evenly(void **state) {
  (void)state;
  CagVec3 p[10];
  double knots[14];
  for (int i = 0; i < 10; i++) {
    const double a = 2 * M_PI * (i % 7) / 7;
    p[i] = cag_vec3(20 * cos(a), 20 * sin(a), i % 7 == 1 ? 14 : i % 7 == 4 ? -11 : 3 * (i % 7 % 2));
  }
  for (int i = 0; i < 14; i++) knots[i] = i - 3;
  CagCurve *open, *c;
  OK(cag_curve_nurbs(p, NULL, 10, 3, knots, 3, &open, &err));
  c = open;
  if (!c->closed) fail_msg("the curve is not closed");
  CagMesh *m = tube_of(c, 0.5, 0);
  check_tube(c, m, 0.57);
  assert_int_equal(m->vertex_count % 12, 0);
  const size_t rings = m->vertex_count / 12;
  double least = INFINITY, most = -INFINITY;
  for (size_t i = 0; i < rings; i++) {
    const CagVec3 *a = m->normals + 12 * i, *b = m->normals + 12 * ((i + 1) % rings);
    // The mean of the turns of all twelve, seen along the ring's axis, is free of the bend.
    double sum = 0;
    for (int k = 0; k < 12; k++) {
      const CagVec3 along = cag_unit(cag_cross(a[k], a[(k + 3) % 12]));
      sum += asin(cag_dot(cag_cross(a[k], b[k]), along));
    }
    least = fmin(least, sum / 12);
    most = fmax(most, sum / 12);
  }
  if (most - least > 0.005 || most > M_PI / (double)rings * 1.2 ||
      least < -M_PI / (double)rings * 1.2)
    fail_msg("rings turn by %g to %g", least, most);
  cag_mesh_release(m);
  cag_curve_release(c);
}

// Dashes along a line whose points are anywhere: all vertices lie in dashes, and both ends of each
// dash have a cap.
static void dashes_are_where_they_belong(void **state) {
  (void)state;
  seed = 33;
  for (int round = 0; round < 20; round++) {
    CagVec3 p[12];
    CagCurve *c;
    double x = 0;
    const int n = 2 + round % 10;
    for (int i = 0; i < n; i++) {
      p[i] = cag_vec3(x, 0, 0);
      x += uniform(0.5, 20);
    }
    const double length = p[n - 1].x, dash = uniform(0.5, length / 3), radius = 0.1;
    const double steps = 2 * floor((floor(length / dash) - 1) / 2) + 1, step = length / steps;
    OK(cag_curve_polyline(p, (size_t)n, false, 3, &c, &err));
    CagMesh *m = tube_of(c, radius, dash);
    check_tube(c, m, radius * (1 + 1e-9));
    size_t caps = 0;
    for (size_t v = 0; v < m->vertex_count; v++) {
      const CagVec3 q = m->positions[v];
      const double at = q.x / step, dashes = floor(at / 2 + 1e-9);
      assert_true(at - 2 * dashes > -1e-6 && at - 2 * dashes < 1 + 1e-6);
      if (hypot(q.y, q.z) > 1e-9) continue;
      caps++;
      assert_true(fabs(at - (double)lround(at)) < 1e-6);
      is_near(m->normals[v].x, lround(at) % 2 ? 1 : -1, 1e-9, "the side of a cap");
    }
    assert_int_equal(caps, (size_t)steps + 1);
    is_near(volume_of(m), (steps + 1) / 2 * step * radius * radius * SECTION, 1e-9 * length,
            "volume");
    cag_mesh_release(m);
    cag_curve_release(c);
  }
}

static double turn_at(CagVec3 a, CagVec3 b, CagVec3 c) {
  const CagVec3 t = cag_unit(cag_sub(b, a)), u = cag_unit(cag_sub(c, b));
  return atan2(cag_norm(cag_cross(t, u)), cag_dot(t, u));
}

// What a corner adds to two tubes of radius 1 that end at it. A wedge in steps of at most 30
// degrees fills the outer side: each step adds sin(step) / 2 times the integral of the squared
// width of half a section. The bisecting plane cuts both tubes on the inner side: each loses the
// first moment of that half times the tangent of half the turn.
static double corner_volume(double turn) {
  double moment = 0, squares = 0;
  const double steps = ceil(turn * 6 / M_PI - 1e-9);
  for (int k = -3; k < 3; k++) {
    const double a = M_PI * k / 6, b = M_PI * (k + 1) / 6;
    const double x0 = cos(a), y0 = sin(a), x1 = cos(b), y1 = sin(b);
    moment += (x0 * y1 - x1 * y0) / 2 * (x0 + x1) / 3;
    squares += (y1 - y0) * (x0 * x0 + x0 * x1 + x1 * x1) / 3;
  }
  return steps * sin(turn / steps) / 2 * squares - 2 * moment * tan(turn / 2);
}

// Polylines with corners of 30 to 160 degrees, open and closed. In a plane the sides of tubes do
// not turn; in space they turn by half the angle of a side at most, which changes their volume
// little.
static void corners_of_any_angle_are_closed(void **state) {
  (void)state;
  seed = 34;
  int tried[2] = {0, 0};
  for (int round = 0; round < 300; round++) {
    enum { N = 5 };
    CagVec3 p[N];
    CagCurve *c;
    const double radius = 0.5;
    const bool closed = round % 2, flat = round % 4 < 2;
    const CagVec3 x = random_vec(1), y = random_vec(1);
    for (int i = 0; i < N; i++) {
      CagVec3 d = random_vec(1);
      if (flat) d = cag_add(cag_scaled(x, d.x), cag_scaled(y, d.y));
      p[i] = i ? cag_madd(p[i - 1], uniform(10, 20), cag_unit(d)) : d;
    }
    double length = 0, corners = 0, least = 10, most = 0;
    for (int i = 1; i < N + closed; i++) {
      const double segment = cag_norm(cag_sub(p[i % N], p[i - 1]));
      length += segment;
      if (!closed && i == N - 1) continue;
      const double turn = turn_at(p[i - 1], p[i % N], p[(i + 1) % N]);
      corners += corner_volume(turn);
      least = fmin(fmin(least, turn), segment < 5 ? 0 : 10);
      most = fmax(most, turn);
    }
    if (least < M_PI / 6 || most > 160 * M_PI / 180) continue;
    OK(cag_curve_polyline(p, N, closed, 3, &c, &err));
    CagMesh *m = tube_of(c, radius, 0);
    check_tube(c, m, 6 * radius);
    const double volume = length * radius * radius * SECTION + corners * pow(radius, 3);
    is_near(volume_of(m), volume, (flat ? 1e-9 : 0.04) * volume, "volume");
    cag_mesh_release(m);
    cag_curve_release(c);
    tried[flat]++;
  }
  assert_true(tried[0] > 10 && tried[1] > 10);
}

// A closed square of 4 times 10 with dashes of 3: thirteen fit, so twelve steps are dashes and gaps
// in turn, each with caps where the steps meet.
static void dashes_of_a_square_go_around(void **state) {
  (void)state;
  const CagVec3 p[] = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}};
  CagCurve *c;
  OK(cag_curve_polyline(p, 4, true, 3, &c, &err));
  CagMesh *m = tube_of(c, 0.1, 3);
  check_tube(c, m, 0.2);
  int caps = 0;
  for (uint32_t v = 0; v < m->vertex_count; v++) {
    int uses = 0;
    for (size_t k = 0; k < 3 * m->triangle_count; k++) uses += m->triangles[k] == v;
    if (uses != 12) continue; // the middle of a cap
    const CagVec3 q = m->positions[v];
    const double at = fabs(q.y) < 1e-9        ? q.x
                      : fabs(q.x - 10) < 1e-9 ? 10 + q.y
                      : fabs(q.y - 10) < 1e-9 ? 30 - q.x
                                              : 40 - q.y;
    const double steps = at / (40.0 / 12);
    if (fabs(steps - (double)lround(steps)) > 1e-6) fail_msg("a cap at %g", at);
    caps++;
  }
  assert_int_equal(caps, 12);
  cag_mesh_release(m);
  cag_curve_release(c);
}

// A limit of exactly the triangles of a tube is enough, and one less is not.
static void the_limit_of_triangles_is_exact(void **state) {
  (void)state;
  static const CagVec3 line[] = {{0, 0, 0}, {5, 0, 0}},
                       corner[] = {{0, 0, 0}, {9, 0, 0}, {9, 9, 0}};
  static const CagVec3 back[] = {{0, 0, 0}, {9, 0, 0}, {3, 0, 0}};
  static const CagVec3 square[] = {{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 3}};
  const CagTransform frame = cag_transform_identity();
  for (int k = 0; k < 6; k++) {
    CagCurve *c;
    if (k == 0) OK(cag_curve_polyline(line, 2, false, 3, &c, &err));
    else if (k == 1) OK(cag_curve_polyline(corner, 3, false, 3, &c, &err));
    else if (k == 2) OK(cag_curve_polyline(back, 3, false, 3, &c, &err));
    else if (k == 3) OK(cag_curve_polyline(square, 4, true, 3, &c, &err));
    else OK(cag_curve_arc(9, 9, 0, k == 4 ? 2 * M_PI : 3, &frame, &c, &err));
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    CagMesh *m, *again = NULL;
    CagError err = {0};
    OK(cag_curve_tube_mesh(c, 0.1, 0, &how, &m, &err));
    how.max_triangles = m->triangle_count;
    OK(cag_curve_tube_mesh(c, 0.1, 0, &how, &again, &err));
    cag_mesh_release(again);
    how.max_triangles--;
    assert_int_equal(cag_curve_tube_mesh(c, 0.1, 0, &how, &again, &err), CAG_E_LIMIT);
    assert_string_equal(err.reason, "triangle-limit");
    cag_mesh_release(m);
    cag_curve_release(c);
  }
}

// Closed surfaces and meshes become meshes with their triangles outward, open ones as they are.
static void surfaces_become_meshes(void **state) {
  (void)state;
  CagSession *session = shown("s = sphere_surface(2)\n"
                              "show s, flip(s), bilinear([0,0,0], [0,1,0], [1,0,0], [1,1,0]), "
                              "translate(rectangle(2, 3), [0, 0, 5]), sun(-Z)");
  static const double volumes[] = {32 * M_PI / 3, 32 * M_PI / 3, 0, 0};
  for (size_t i = 0; i < 4; i++) {
    CagMesh *m;
    OK(cag_item_mesh(&session->scene, &session->scene.items[i], &m, &err));
    if (i < 2) is_near(volume_of(m), volumes[i], 0.02 * volumes[i], "volume");
    double area = 0;
    for (size_t t = 0; t < m->triangle_count; t++) {
      const uint32_t *k = m->triangles + 3 * t;
      const CagVec3 a = m->positions[k[0]];
      area +=
          cag_norm(cag_cross(cag_sub(m->positions[k[1]], a), cag_sub(m->positions[k[2]], a))) / 2;
      if (i == 3) assert_true(a.z == 5);
    }
    static const double areas[] = {16 * M_PI, 16 * M_PI, 1, 6};
    is_near(area, areas[i], 0.02 * areas[i], "area");
    cag_mesh_release(m);
  }
  cag_session_free(session);
}

// Only a perspective camera with an aperture has depth of field.
static void lenses_have_an_aperture(void **state) {
  (void)state;
  assert_false(cag_camera_has_lens(&(CagCamera){.aperture = 0}));
  assert_true(cag_camera_has_lens(&(CagCamera){.aperture = 1}));
  assert_false(cag_camera_has_lens(&(CagCamera){.aperture = 1, .orthographic = true}));
}

// Lines that say no width are a part of the diagonal of the scene.
static void lines_have_a_width_by_the_scene(void **state) {
  (void)state;
  CagScene s = {.bounds = {{0, 0, 0}, {30, 40, 0}}};
  CagItem item = {.kind = CAG_ITEM_CURVE};
  is_near(cag_item_line_radius(&s, &item), 0.0025 * 50, 1e-12, "by the diagonal");
  item.line_radius = 3;
  assert_true(cag_item_line_radius(&s, &item) == 3);
  item.line_radius = 0;
  s.bounds = CAG_BOUNDS_EMPTY;
  is_near(cag_item_line_radius(&s, &item), 0.25, 1e-12, "of an empty scene");
  s.bounds = (CagBounds){{1, 1, 1}, {1, 1, 1}};
  is_near(cag_item_line_radius(&s, &item), 0.25, 1e-12, "of a point");
}

// --- Parts of meshes ---

// Each triangle is in the part of its label's material, with what its corners have; vertices of
// one point stay so.
static void parts_of_a_mesh_have_its_triangles(void **state) {
  (void)state;
  seed = 35;
  for (int features = 0; features < 8; features++) {
    enum { V = 40, T = 60 };
    CagMesh *m;
    const bool normals = features & 1, uv = features & 2, weld = features & 4;
    OK(cag_mesh_new(V, T, normals, uv, weld, &m, &err));
    m->scale = (CagColorScale){CAG_SCALE_STRIPES, 1, 2, 3};
    m->labels = malloc(T * sizeof *m->labels);
    for (uint32_t v = 0; v < V; v++) {
      m->positions[v] = random_vec(9);
      if (weld) m->weld[v] = v > 3 && v % 3 == 0 ? m->weld[v / 3] : v;
      if (weld) m->positions[v] = m->positions[m->weld[v]];
      if (normals) m->normals[v] = cag_unit(random_vec(1));
      if (uv) m->uv[2 * v] = uniform(0, 1);
      if (uv) m->uv[2 * v + 1] = uniform(0, 1);
    }
    for (size_t t = 0; t < T; t++) {
      m->labels[t] = (uint32_t)uniform(0, 4.999);
      for (size_t j = 0; j < 3; j++) m->triangles[3 * t + j] = (uint32_t)((7 * t + 13 * j) % V);
    }
    size_t of_label[] = {4, SIZE_MAX, 5};
    const CagItem item = {.material = 3, .label_materials = of_label, .label_count = 3};
    static const size_t material_of[] = {3, 4, 3, 5, 3}; // by label
    size_t seen = 0;
    for (size_t material = 2; material < 7; material++) {
      CagMesh *part;
      OK(cag_item_mesh_of(&item, m, material, &part, &err));
      assert_true(part->scale.kind == CAG_SCALE_STRIPES && part->scale.to == 2);
      size_t n = 0;
      uint32_t from[V];
      memset(from, 0xff, sizeof from);
      for (size_t t = 0; t < T; t++) {
        if (material_of[m->labels[t]] != material) continue;
        assert_true(n < part->triangle_count);
        for (size_t j = 0; j < 3; j++) {
          const uint32_t a = m->triangles[3 * t + j], b = part->triangles[3 * n + j];
          assert_true(b < part->vertex_count);
          assert_true(from[b] == UINT32_MAX || from[b] == a); // a vertex stays one vertex
          from[b] = a;
          is_point(part->positions[b], m->positions[a], "position");
          if (normals) is_point(part->normals[b], m->normals[a], "normal");
          if (uv) assert_memory_equal(part->uv + 2 * b, m->uv + 2 * a, 2 * sizeof *m->uv);
        }
        n++;
      }
      assert_int_equal(part->triangle_count, n);
      seen += n;
      for (uint32_t b = 0; b < part->vertex_count; b++) {
        assert_true(from[b] != UINT32_MAX);
        for (uint32_t a = 0; a < b; a++) assert_true(from[a] != from[b]);
        uint32_t first = 0;
        while (weld && m->weld[from[first]] != m->weld[from[b]]) first++;
        if (weld) assert_int_equal(part->weld[b], first);
      }
      assert_true((part->normals != NULL) == normals && (part->uv != NULL) == uv);
      assert_true((part->weld != NULL) == weld);
      cag_mesh_release(part);
    }
    assert_int_equal(seen, T);
    cag_mesh_release(m);
  }
}

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
      cmocka_unit_test(srgb_is_that_of_its_definition),
      cmocka_unit_test(scales_have_their_published_colors),
      cmocka_unit_test(stops_are_the_colors_of_the_scale),
      cmocka_unit_test(tubes_follow_curves_in_space),
      cmocka_unit_test(closed_tubes_turn_evenly),
      cmocka_unit_test(dashes_are_where_they_belong),
      cmocka_unit_test(corners_of_any_angle_are_closed),
      cmocka_unit_test(dashes_of_a_square_go_around),
      cmocka_unit_test(the_limit_of_triangles_is_exact),
      cmocka_unit_test(surfaces_become_meshes),
      cmocka_unit_test(lenses_have_an_aperture),
      cmocka_unit_test(lines_have_a_width_by_the_scene),
      cmocka_unit_test(parts_of_a_mesh_have_its_triangles),
  };
  return cmocka_run_group_tests_name("scene_frame", tests, NULL, NULL);
}
