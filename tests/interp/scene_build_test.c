// Scenes built from scripts: names of shown shapes, materials, cameras, lights, and what is added
// if the script does not show any.

#include "interp/session/session.h"
#include "scene_fixture.h"
#include "session_support.h"

static CagSession *session_of(const char *text) {
  CagSession *s = new_session();
  if (cag_session_run_text(s, "script", text, strlen(text)) != CAG_STATUS_OK) {
    cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr);
    fail_msg("the script fails: %s", text);
  }
  return s;
}

// A session whose scene is built.
static CagSession *shown(const char *text) {
  CagSession *s = session_of(text);
  CagShownCounts counts;
  if (cag_session_scene(s, &counts) != CAG_STATUS_OK) {
    cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr);
    fail_msg("there is no scene of: %s", text);
  }
  return s;
}

static void is_point(CagVec3 p, double x, double y, double z) {
  if (cag_norm(cag_sub(p, cag_vec3(x, y, z))) > 1e-9)
    fail_msg("[%.12g, %.12g, %.12g], not [%.12g, %.12g, %.12g]", p.x, p.y, p.z, x, y, z);
}

// --- Names ---

#define DEFINED                                                                                    \
  "b = box(1)\nc = cylinder(2, 1)\nbs = [b, b]\npair = group(b, c)\nr = {lid: b}\n"                \
  "make(k) = box(k)\nsame(g) = g\nf = sphere_surface(3)\n"

// A shape without a name of its own is named after the definition that it comes from, or after its
// kind if there is none. If the name is in use, a number is appended.
static void shapes_are_named_after_their_definitions(void **state) {
  (void)state;
  static const struct {
    const char *show, *names;
  } cases[] = {
      {"(b)", "b"},
      {"b, (b), b", "b b.2 b.3"},
      {"named(b, \"b.2\"), b, b", "b.2 b b.3"},
      {"if 1 < 2 then b else b", "b"},
      {"if 1 < 2 then b else c", "box"},
      {"if 1 < 2 then box(1) else b", "box"},
      {"{ local = box(2)\n local }", "local"},
      {"bs[0]", "bs"},
      {"r.lid", "lid"},
      {"pair.items", "pair pair.2"},
      {"group(b, c).items", "box cylinder"},
      {"[...bs]", "bs bs.2"},
      {"[...bs, c]", "box box.2 cylinder"},
      {"[...bs, ...[]]", "box box.2"},
      {"[]", ""},
      {"[b, sphere(1)]", "b sphere"},
      {"([b, c])", "b c"},
      {"group(b, b)", "b b.2"},
      {"group(b, c)", "b c"},
      {"group([b, c])", "b c"},
      {"group([b, c], sphere(1))", "box cylinder sphere"},
      {"translate([1, 2, 3]) * group(b, c)", "b c"},
      {"translate(group(b, c), [1, 2, 3])", "b c"},
      {"translate((group(b, c)), [1, 2, 3])", "b c"},
      {"(() => group(b, c))()", "box cylinder"},
      {"make(k: 2)", "make"},
      {"[if 1 < 2 then b else c, c]", "box c"},
      {"group(b, c) |> translate([1, 2, 3])", "b c"},
      {"group(b, c) |> color(\"red\") |> translate([1, 2, 3])", "b c"},
      {"around(b, 2)", "b b.2"},
      {"tessellate(b), clip(b, plane([0, 0, 0.5], Z)), thicken(f, 0.1), solid(f)", "b b.2 f f.2"},
      {"convex_hull([b])", "polyhedron"},
      {"around(box(3), 2)", "box box.2"},
      {"[for g in bs: g]", "bs bs.2"},
      {"[for g in [b, c]: g]", "box cylinder"},
      {"[for k in 0..1: translate(b, [k, 0, 0])]", "b b.2"},
      {"[for k in 0..1, g in bs: translate(g, [k, 0, 0])]", "bs bs.2 bs.3 bs.4"},
      {"[for k in 0..1: make(k + 1)]", "make make.2"},
      {"[for [k, g] in [[1, b], [2, c]]: translate(g, [k, 0, 0])]", "box cylinder"},
      {"make(2)", "make"},
      {"2 |> make", "make"},
      {"b |> same", "b"},
      {"b |> same()", "b"},
      {"(g => translate(g, [1, 0, 0]))(b)", "box"},
      {"b - c", "difference"},
      {"region(circle(3)), sphere(1), torus_surface(3, 1)", "region sphere torus"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char text[1000], found[1000] = "";
    snprintf(text, sizeof text, DEFINED "show named(box(9), \"first\")\nshow %s", cases[i].show);
    CagSession *s = shown(text);
    for (size_t k = 1; k < s->scene.item_count; k++) {
      const CagItem *item = &s->scene.items[k];
      if (item->kind == CAG_ITEM_GROUND) continue;
      strcat(found, *found ? " " : "");
      strcat(found, item->name);
    }
    if (strcmp(found, cases[i].names) != 0)
      fail_msg("show %s: `%s`, not `%s`", cases[i].show, found, cases[i].names);
    cag_session_free(s);
  }
}

// --- Materials ---

// Shapes share a material if all properties are equal. Each of these differs from the first in one
// property, and the last one equals the first.
static void equal_materials_are_one(void **state) {
  (void)state;
  CagSession *s =
      shown("m = {color: [0.5, 0.25, 0.125], color2: [0.1, 0.2, 0.3], emission: [0, 0, 0]}\n"
            "ms = [m, {...m, color: [0.6, 0.25, 0.125]}, {...m, color: [0.5, 0.3, 0.125]},\n"
            "  {...m, color: [0.5, 0.25, 0.2]}, {...m, color2: [0.1, 0.2, 0.4]},\n"
            "  {...m, emission: [0, 0, 1]}, {...m, metallic: 1}, {...m, roughness: 0.25},\n"
            "  {...m, ior: 2}, {...m, transmission: 1}, {...m, coat: 1},\n"
            "  {...m, texture_scale: 3}, {...m, texture: \"wood\"},\n"
            "  {...m, pov: \"texture \\{ T \\}\"}, {...m, name: \"skin\"}, m]\n"
            "show [for k in 0..<len(ms): material(translate(box(1), [2 * k, 0, 0]), ms[k])]");
  size_t at[32], n = 0;
  for (size_t i = 0; i < s->scene.item_count; i++)
    if (s->scene.items[i].kind == CAG_ITEM_SOLID) at[n++] = s->scene.items[i].material;
  assert_int_equal(n, 16);
  for (size_t i = 0; i + 1 < n; i++)
    for (size_t k = 0; k < i; k++) assert_int_not_equal(at[i], at[k]);
  assert_int_equal(at[0], at[n - 1]);
  const CagMaterial *m = &s->scene.materials[at[0]];
  assert_true(m->color.r == 0.5 && m->color.g == 0.25 && m->color.b == 0.125);
  assert_string_equal(s->scene.materials[at[14]].name, "skin");
  assert_string_equal(s->scene.materials[at[12]].texture, "wood");
  assert_string_equal(s->scene.materials[at[13]].pov, "texture { T }");
  cag_session_free(s);
}

// A face has the material of the operand that it comes from. A material of the whole applies only
// to operands without one.
static void operands_keep_their_materials(void **state) {
  (void)state;
  CagSession *s = shown("a = color(box(4), [1, 0, 0])\nb = color(sphere(2), [0, 0, 1])\n"
                        "show a - b, color(a - b, [0, 1, 0]), color(box(4) - b, [0, 1, 0]),\n"
                        "  tessellate(a - b), solid(tessellate(a - b))");
  assert_true(s->scene.item_count > 5);
  for (size_t i = 0; i < 5; i++) {
    const CagItem *item = &s->scene.items[i];
    bool red = false, green = false, blue = false;
    for (size_t k = 0; k <= item->label_count; k++) {
      const size_t at = k > 0 ? item->labels[k - 1].material : item->material;
      const CagColor c = s->scene.materials[at].color;
      red = red || (c.r == 1 && c.g == 0 && c.b == 0);
      green = green || (c.r == 0 && c.g == 1 && c.b == 0);
      blue = blue || (c.r == 0 && c.g == 0 && c.b == 1);
    }
    assert_true(blue && red == (i != 2) && green == (i == 1 || i == 2));
  }
  cag_session_free(s);
}

// --- Large scenes ---

static int compare_names(const void *a, const void *b) {
  return strcmp(*(const char *const *)a, *(const char *const *)b);
}

// Names given by the script are kept, even if they look like numbered ones.
static void many_items_have_unique_names(void **state) {
  (void)state;
  CagSession *s = shown("point = circle(1)\n"
                        "show named(circle(1), \"point.7\")\n"
                        "show [for i in 0..<100000: point]\n"
                        "show [for i in 0..<1000: named(point, \"c{i}\")]\n"
                        "show [for i in 0..<1000: named(point, \"c{i}\")]");
  const size_t n = s->scene.item_count;
  assert_true(n >= 102001);
  const CagItem *items = s->scene.items;
  assert_string_equal(items[0].name, "point.7");
  assert_string_equal(items[1].name, "point");
  assert_string_equal(items[6].name, "point.6");
  assert_string_equal(items[7].name, "point.8"); // the name with 7 is in use
  assert_string_equal(items[100000].name, "point.100001");
  assert_string_equal(items[101000].name, "c999");
  assert_string_equal(items[102000].name, "c999.2");
  const char **names = malloc(n * sizeof *names);
  assert_non_null(names);
  for (size_t i = 0; i < n; i++) names[i] = items[i].name;
  qsort(names, n, sizeof *names, compare_names);
  for (size_t i = 1; i < n; i++) assert_string_not_equal(names[i - 1], names[i]);
  free(names);
  cag_session_free(s);
}

// Equal materials are one, unless they have different names.
static void many_materials_are_each_kept_once(void **state) {
  (void)state;
  CagSession *s = shown("c = circle(1)\n"
                        "show [for i in 0..<20000: material(c, {roughness: (i % 10000)/10000})]\n"
                        "show [for i in 0..<20000: material(c, {name: \"m{i % 10000}\"})]\n"
                        "show material(c, {roughness: 0.25}), material(c, {ior: 3}), c");
  const CagScene *scene = &s->scene;
  const CagItem *items = scene->items;
  // In the first list, the one with the default roughness is ink. The one in the last row is new.
  const size_t expected = 2 + 9999 + 10000 + 1;
  assert_true(scene->material_count >= expected && scene->material_count <= expected + 1); // floor
  for (size_t i = 0; i < 10000; i++) {
    char name[16];
    assert_int_equal(items[i].material, items[i + 10000].material);
    assert_true(scene->materials[items[i].material].roughness == (double)i / 10000);
    snprintf(name, sizeof name, "m%zu", i);
    assert_int_equal(items[20000 + i].material, items[30000 + i].material);
    assert_string_equal(scene->materials[items[20000 + i].material].name, name);
  }
  assert_int_equal(items[5000].material, 1);
  assert_int_equal(items[40000].material, items[2500].material);
  assert_true(scene->materials[items[40001].material].ior == 3);
  assert_int_equal(items[40002].material, 1);
  cag_session_free(s);
}

// Labels of operands are numbers of the whole run. An item has only its own.
static void items_keep_the_labels_of_their_own_operands(void **state) {
  (void)state;
  CagSession *s = shown("show [for i in 0..<30: color(box(2), [i/30, 0, 0]) -\n"
                        "  color(translate(box(2), [1, 1, 1]), [0, i/30, 1])]");
  for (size_t i = 0; i < 30; i++) {
    const CagItem *item = &s->scene.items[i];
    assert_int_equal(item->label_count, 2);
    assert_true(item->labels[0].label < item->labels[1].label);
    bool found = false;
    for (size_t k = 0; k < 2; k++) {
      const CagColor c = s->scene.materials[item->labels[k].material].color;
      found = found || (c.r == 0 && c.g == (double)i / 30 && c.b == 1);
      assert_int_equal(cag_item_label_material(item, item->labels[k].label),
                       item->labels[k].material);
    }
    assert_true(found);
    assert_int_equal(cag_item_label_material(item, item->labels[1].label + 1), item->material);
  }
  cag_session_free(s);
}

// --- Cameras and lights ---

// If the view is along `up`, Y is up, or Z if the view is along Y.
static void cameras_have_an_up_that_is_perpendicular_to_the_view(void **state) {
  (void)state;
  static const struct {
    const char *camera;
    double up[3];
  } cases[] = {
      {"camera([0, -9, 0])", {0, 0, 1}},
      {"camera([0, 0, 9])", {0, 1, 0}},
      {"camera([0, -9, 0], up: Y)", {0, 0, 1}},
      {"camera([0, -9, 0], up: [1, 5, 0])", {1, 0, 0}},
      {"camera([3, 0, -3])", {M_SQRT1_2, 0, M_SQRT1_2}},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char text[200];
    snprintf(text, sizeof text, "eye = %s\nshow box(1), eye", cases[i].camera);
    CagSession *s = shown(text);
    const CagCamera *c = &s->scene.cameras[0];
    is_point(c->up, cases[i].up[0], cases[i].up[1], cases[i].up[2]);
    assert_string_equal(c->name, "eye");
    cag_session_free(s);
  }
}

// An orthographic camera without a width shows what a perspective one shows at the target.
static void an_orthographic_camera_has_the_width_of_its_angle(void **state) {
  (void)state;
  CagSession *s = shown("show box(1), camera([0, -10, 0], kind: \"orthographic\", fov: 90deg),\n"
                        "  camera([0, -10, 0], kind: \"orthographic\", width: 7, size: [64, 48])");
  assert_true(fabs(s->scene.cameras[0].width - 20) < 1e-12);
  assert_true(s->scene.cameras[0].orthographic && !cag_camera_has_lens(&s->scene.cameras[0]));
  assert_true(s->scene.cameras[1].width == 7);
  assert_int_equal(s->scene.cameras[1].size[0], 64);
  assert_int_equal(s->scene.cameras[1].size[1], 48);
  cag_session_free(s);
}

// A camera whose eye and target are the same point looks along Y.
static void a_camera_without_a_view_has_a_frame(void **state) {
  (void)state;
  const CagCamera c = {.eye = {1, 2, 3}, .target = {1, 2, 3}, .up = {0, 0, 1}};
  const CagTransform t = cag_camera_frame(&c);
  const double expected[3][4] = {{1, 0, 0, 1}, {0, 0, 1, 2}, {0, -1, 0, 3}};
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 4; k++) assert_true(fabs(t.m[i][k] - expected[i][k]) < 1e-12);
}

static void lights_shine_where_the_script_says(void **state) {
  (void)state;
  CagSession *s = shown("show box(1), sun([0, 0, -2], strength: 3),\n"
                        "  translate(spot_light([0, 0, 10], [0, 0, 4], angle: 90deg), [1, 2, 0]),\n"
                        "  point_light([1, 2, 3], color: [1, 0, 0.5]),\n"
                        "  area_light([0, 9, 0], origin, 5)");
  assert_int_equal(s->scene.light_count, 4);
  const CagLight *l = s->scene.lights;
  assert_int_equal(l[0].kind, CAG_LIGHT_SUN);
  is_point(l[0].direction, 0, 0, -1);
  assert_true(l[0].strength == 3);
  assert_int_equal(l[1].kind, CAG_LIGHT_SPOT);
  is_point(l[1].position, 1, 2, 10);
  is_point(l[1].direction, 0, 0, -1);
  assert_true(fabs(l[1].angle - M_PI_2) < 1e-12);
  assert_int_equal(l[2].kind, CAG_LIGHT_POINT);
  assert_true(l[2].color.r == 1 && l[2].color.g == 0 && l[2].color.b == 0.5);
  assert_int_equal(l[3].kind, CAG_LIGHT_AREA);
  is_point(l[3].direction, 0, -1, 0);
  assert_true(l[3].size == 5 && !s->scene.studio);
  cag_session_free(s);
}

// The last sky, ground, and background of a script count.
static void settings_of_a_scene(void **state) {
  (void)state;
  CagSession *s = shown("floor = ground(z: -2, size: 30)\n"
                        "show box(1), sky(\"white\"), sky([[1, 0, 0], [0, 0, 1]]),\n"
                        "  background([0.5, 0, 1]), floor, color(ground(), \"blue\")");
  assert_int_equal(s->scene.sky.color_count, 2);
  assert_true(s->scene.sky.colors[0].r == 1 && s->scene.sky.colors[1].b == 1);
  assert_true(s->scene.has_background && s->scene.background.r == 0.5);
  assert_int_equal(s->scene.light_count, 0);
  const CagItem *floor = &s->scene.items[1], *blue = &s->scene.items[2];
  assert_int_equal(floor->kind, CAG_ITEM_GROUND);
  assert_string_equal(floor->name, "floor");
  assert_true(floor->ground_z == -2 && floor->ground_size == 30 && isinf(blue->ground_size));
  assert_true(s->scene.materials[blue->material].color.b == 1);
  cag_session_free(s);
}

// --- The studio ---

static size_t ground_count(const CagScene *s) {
  size_t n = 0;
  for (size_t i = 0; i < s->item_count; i++) n += s->items[i].kind == CAG_ITEM_GROUND;
  return n;
}

// The studio's floor replaces a missing ground. A camera below would see only the floor, and a
// background has no horizon for a floor.
static void the_studio_has_a_floor_if_it_is_seen_from_above(void **state) {
  (void)state;
  static const struct {
    const char *show;
    size_t grounds, sky, lights;
    bool studio;
  } cases[] = {
      {"box(1)", 1, 4, 3, true},
      {"box(1), camera([9, 9, 9])", 1, 4, 3, true},
      {"box(1), camera([9, 9, -9])", 0, 4, 3, true},
      {"box(1), ground(-1)", 1, 4, 3, true},
      {"box(1), background(\"white\")", 0, 0, 3, true},
      {"box(1), sky(\"white\")", 0, 1, 0, false},
      {"box(1), sun(-Z)", 0, 0, 1, false},
      {"rectangle(2, 1)", 0, 0, 1, true},
      {"rectangle(2, 1), background(\"red\")", 0, 0, 1, true},
      {"rectangle(2, 1), camera([9, 9, 9])", 1, 4, 3, true},
      {"label([1, 2, 3], \"A\")", 1, 4, 3, true},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char text[200];
    snprintf(text, sizeof text, "show %s", cases[i].show);
    CagSession *s = shown(text);
    const CagScene *scene = &s->scene;
    if (ground_count(scene) != cases[i].grounds || scene->sky.color_count != cases[i].sky ||
        scene->light_count != cases[i].lights || scene->studio != cases[i].studio)
      fail_msg("%s: %zu grounds, %zu colors of the sky, %zu lights, studio %d", cases[i].show,
               ground_count(scene), scene->sky.color_count, scene->light_count, scene->studio);
    cag_session_free(s);
  }
}

// The lights are to the left, to the right, and in the back, seen from the camera. A reflected
// camera shows the mirror image, so its lights are reflected, too.
static void studio_lights_stand_about_the_camera(void **state) {
  (void)state;
  CagSession *plain = shown("show box(2, centered: true), camera([0, -30, 10])");
  CagSession *mirror =
      shown("show box(2, centered: true), reflect(camera([0, -30, 10]), plane(origin, X))");
  assert_true(mirror->scene.cameras[0].mirrored && !plain->scene.cameras[0].mirrored);
  for (size_t i = 0; i < plain->scene.light_count; i++) {
    const CagLight *a = &plain->scene.lights[i], *b = &mirror->scene.lights[i];
    is_point(b->position, -a->position.x, a->position.y, a->position.z);
  }
  assert_true(plain->scene.lights[0].position.x < -1 && plain->scene.lights[0].position.y < -1);
  cag_session_free(plain);
  cag_session_free(mirror);
  // If the camera's right is along Z, the camera is treated as being at -Y.
  CagSession *turned = shown("show box(2, centered: true), camera([0, -30, 0], up: X)");
  assert_true(turned->scene.lights[0].position.y < -1 && turned->scene.lights[2].position.y > 1);
  for (size_t i = 0; i < turned->scene.light_count; i++) {
    const CagLight *l = &turned->scene.lights[i];
    assert_true(fabs(cag_norm(l->direction) - 1) < 1e-12);
  }
  cag_session_free(turned);
}

// --- Standard views ---

// The extents of the shapes shown below, along the picture's right and down.
#define WIDE 24.0 // x, -12..12
#define DEEP 10.0 // y, -5..5
#define TALL 16.0 // z, -8..8

static void standard_views_frame_all_kinds_of_items(void **state) {
  (void)state;
  static const struct {
    const char *name;
    double right, down;
    CagVec3 view;
  } cases[] = {{"top", WIDE, DEEP, {0, 0, -1}},  {"bottom", WIDE, DEEP, {0, 0, 1}},
               {"front", WIDE, TALL, {0, 1, 0}}, {"back", WIDE, TALL, {0, -1, 0}},
               {"left", DEEP, TALL, {1, 0, 0}},  {"right", DEEP, TALL, {-1, 0, 0}}};
  CagSession *s = shown(
      "show polyline([[-12, 0, 0], [-11, 0, 0]]), translate(box(2, centered: true), [11, 0, 0]),\n"
      "  translate(region(circle(1)), [0, 4, 0]),\n"
      "  translate(sphere_surface(2), [0, -3, 0]),\n"
      "  tessellate(translate(box(2, centered: true), [0, 0, 7])),\n"
      "  translate(box(2, centered: true), [0, 0, -7]), camera([60, 80, 90])");
  assert_int_equal(ground_count(&s->scene), 1);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    CagError err = {0};
    assert_int_equal(cag_scene_add_view(&s->scene, cases[i].name, &err), CAG_OK);
    const CagCamera *c = &s->scene.cameras[s->scene.camera_count - 1];
    const double aspect = (double)c->size[0] / c->size[1];
    const double needed = fmax(cases[i].right, cases[i].down * aspect);
    if (c->width < needed || c->width > 1.2 * needed)
      fail_msg("%s is %g wide, and %g is needed", c->name, c->width, needed);
    is_point(cag_unit(cag_sub(c->target, c->eye)), cases[i].view.x, cases[i].view.y,
             cases[i].view.z);
    // From below, the floor would hide everything.
    assert_int_equal(ground_count(&s->scene), i == 0 ? 1 : 0);
  }
  cag_session_free(s);
}

// A ground of the script is kept, even for a view from below.
static void a_view_from_below_keeps_the_grounds_of_the_script(void **state) {
  (void)state;
  static const char *const scripts[] = {"show box(1), ground(-1)", "show ground(-1), box(1)",
                                        "show box(1), sun(-Z), ground(-1)"};
  for (size_t i = 0; i < 3; i++) {
    CagSession *s = shown(scripts[i]);
    CagError err = {0};
    assert_int_equal(cag_scene_add_view(&s->scene, "bottom", &err), CAG_OK);
    assert_int_equal(ground_count(&s->scene), 1);
    cag_session_free(s);
  }
}

static void a_scene_beyond_the_range_of_numbers_is_refused(void **state) {
  (void)state;
  static const char *const scripts[] = {
      "show translate(box(1), [1e308, 0, 0]), translate(box(1), [-1e308, 0, 0])",
      "show box(1), scale(camera([9e300, 0, 0]), 1e300)",
      "show box(1), scale(point_light([9e300, 0, 0]), 1e300)",
      "show box(1), scale(spot_light([9e200, 0, 0], [0, 9e200, 0]), 1e200)"};
  for (size_t i = 0; i < sizeof scripts / sizeof *scripts; i++) {
    CagSession *s = session_of(scripts[i]);
    CagShownCounts counts;
    const int status = cag_session_scene(s, &counts);
    CagErrorView e;
    cag_session_error(s, 0, &e);
    if (status != CAG_STATUS_SCRIPT || !e.reason || strcmp(e.reason, "not-finite") != 0)
      fail_msg("%s: status %d, reason %s", scripts[i], status, e.reason ? e.reason : "none");
    cag_session_free(s);
  }
}

// All values of a list are checked.
static void values_that_cannot_be_shown_are_refused(void **state) {
  (void)state;
  static const char *const scripts[] = {"show 5", "show [box(1), 5]", "show [[5], box(1)]",
                                        "show [box(1), [sphere(1), true]]", "show [1, 2]"};
  for (size_t i = 0; i < sizeof scripts / sizeof *scripts; i++) {
    CagSession *s = new_session();
    if (cag_session_run_text(s, "script", scripts[i], strlen(scripts[i])) != CAG_STATUS_SCRIPT)
      fail_msg("it runs: %s", scripts[i]);
    cag_session_free(s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shapes_are_named_after_their_definitions),
      cmocka_unit_test(equal_materials_are_one),
      cmocka_unit_test(operands_keep_their_materials),
      cmocka_unit_test(many_items_have_unique_names),
      cmocka_unit_test(many_materials_are_each_kept_once),
      cmocka_unit_test(items_keep_the_labels_of_their_own_operands),
      cmocka_unit_test(cameras_have_an_up_that_is_perpendicular_to_the_view),
      cmocka_unit_test(an_orthographic_camera_has_the_width_of_its_angle),
      cmocka_unit_test(a_camera_without_a_view_has_a_frame),
      cmocka_unit_test(lights_shine_where_the_script_says),
      cmocka_unit_test(settings_of_a_scene),
      cmocka_unit_test(the_studio_has_a_floor_if_it_is_seen_from_above),
      cmocka_unit_test(studio_lights_stand_about_the_camera),
      cmocka_unit_test(standard_views_frame_all_kinds_of_items),
      cmocka_unit_test(a_view_from_below_keeps_the_grounds_of_the_script),
      cmocka_unit_test(values_that_cannot_be_shown_are_refused),
      cmocka_unit_test(a_scene_beyond_the_range_of_numbers_is_refused),
  };
  return cmocka_run_group_tests_name("scene_build", tests, NULL, NULL);
}
