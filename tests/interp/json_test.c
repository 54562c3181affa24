// JSON: the file can be parsed, and its numbers are those of the scene.

#include "tests/interp/scene_fixture.h"

#include <cjson/cJSON.h>

#include "interp/formats/json.h"
#include "interp/session/session.h"
#include "session_support.h"

static char folder[64];

static cJSON *export_tree(const Fixture *f) {
  char path[128];
  CagError io;
  snprintf(path, sizeof path, "%s/scene.json", folder);
  CagAtomicFile *file = cag_atomic_file_open(path, &io);
  assert_non_null(file);
  OK(cag_export_json(&f->scene, file, &err));
  assert_true(cag_atomic_file_commit(file, &io));
  char *text = read_whole(path);
  cJSON *tree = cJSON_Parse(text);
  if (!tree) fail_msg("does not parse: %.60s", cJSON_GetErrorPtr());
  free(text);
  return tree;
}

static const cJSON *member(const cJSON *o, const char *name) {
  const cJSON *m = cJSON_GetObjectItemCaseSensitive(o, name);
  if (!m) fail_msg("no member %s", name);
  return m;
}
static double number(const cJSON *o, const char *name) {
  assert_true(cJSON_IsNumber(member(o, name)));
  return member(o, name)->valuedouble;
}
static const char *text(const cJSON *o, const char *name) {
  assert_true(cJSON_IsString(member(o, name)));
  return member(o, name)->valuestring;
}
static double element(const cJSON *list, int i) { return cJSON_GetArrayItem(list, i)->valuedouble; }

static void numbers_come_back_as_the_same_doubles(void **state) {
  (void)state;
  const CagVec3 p[] = {{0.1, 1.0 / 3, 0}, {1e-7, 2e20, 0}, {-0.0, 0.30000000000000004, 0}};
  const double w[] = {1, 0.7, 1};
  Fixture f;
  CagCurve *c;
  OK(cag_curve_bezier(p, w, 3, 2, &c, &err));
  fixture_begin(&f);
  fixture_curve(&f, "arc", c);
  cJSON *tree = export_tree(&f);
  const cJSON *item = cJSON_GetArrayItem(member(tree, "items"), 0);
  const cJSON *curve = member(item, "curve"), *points = member(curve, "points");
  assert_string_equal(text(item, "name"), "arc");
  assert_string_equal(text(item, "kind"), "curve");
  assert_true(number(curve, "degree") == 2);
  assert_true(element(cJSON_GetArrayItem(points, 0), 1) == 1.0 / 3);
  assert_true(element(cJSON_GetArrayItem(points, 2), 1) == 0.30000000000000004);
  assert_true(element(member(curve, "weights"), 1) == 0.7);
  assert_int_equal(cJSON_GetArraySize(member(curve, "knots")), 6);
  cJSON_Delete(tree);
  fixture_end(&f);
}

static void solids_keep_their_parameters_and_place(void **state) {
  (void)state;
  Fixture f;
  CagSolid *s, *moved;
  CagTransform t = cag_translate(cag_vec3(1, 2, 3));
  OK(cag_solid_cylinder(20, 5, 2, &s, &err));
  OK(cag_solid_transform(s, &t, &moved, &err));
  cag_solid_release(s);
  fixture_begin(&f);
  fixture_solid(&f, "cup", moved);
  cJSON *tree = export_tree(&f);
  const cJSON *solid = member(cJSON_GetArrayItem(member(tree, "items"), 0), "solid");
  assert_string_equal(text(solid, "type"), "cylinder");
  assert_true(number(solid, "height") == 20 && number(solid, "radius") == 5);
  assert_true(number(solid, "top") == 2);
  assert_true(element(cJSON_GetArrayItem(member(solid, "placement"), 2), 3) == 3);
  cJSON_Delete(tree);
  fixture_end(&f);
}

static void every_kind_of_item_is_written(void **state) {
  (void)state;
  const CagVec3 corners[] = {{0, 0, 0}, {20, 0, 0}, {20, 20, 0}, {0, 20, 0}};
  const uint32_t indices[] = {0, 1, 2, 3}, counts[] = {4};
  Fixture f;
  CagCurve *outline, *helix;
  CagRegion *region;
  CagSurface *turned, *tube;
  CagSolid *block;
  OK(cag_curve_polyline(corners, 4, true, 2, &outline, &err));
  OK(cag_region_new(outline, NULL, 0, &region, &err));
  OK(cag_curve_helix(10, 5, 2, 0, &helix, &err));
  OK(cag_surface_tube(helix, 1, &tube, &err));
  OK(cag_surface_revolve(outline, cag_vec3(0, 0, 1), cag_vec3(-30, 0, 0), 0, 1, &turned, &err));
  OK(cag_solid_extrude(region, cag_vec3(0, 0, 5), 0, 1, &block, &err));
  fixture_begin(&f);
  fixture_curve(&f, "outline", outline);
  fixture_curve(&f, "helix", helix);
  fixture_region(&f, "region", region);
  fixture_surface(&f, "turned", turned);
  fixture_surface(&f, "tube", tube);
  fixture_solid(&f, "block", block);
  CagItem *mesh = fixture_item(&f, CAG_ITEM_MESH, "mesh");
  OK(cag_mesh_from_faces(corners, 4, indices, counts, 1, &mesh->as.mesh, &err));
  CagItem *ground = fixture_item(&f, CAG_ITEM_GROUND, "ground");
  ground->ground_size = INFINITY;

  cJSON *tree = export_tree(&f);
  const cJSON *items = member(tree, "items");
  assert_int_equal(cJSON_GetArraySize(items), 8);
  assert_true(cJSON_IsNull(member(cJSON_GetArrayItem(items, 7), "size"))); // infinite
  assert_int_equal(
      cJSON_GetArraySize(member(member(cJSON_GetArrayItem(items, 6), "mesh"), "triangles")), 2);
  assert_true(number(member(cJSON_GetArrayItem(items, 1), "curve"), "pitch") ==
              5); // exact, not sampled
  const cJSON *faces = member(member(cJSON_GetArrayItem(items, 5), "solid"), "faces");
  assert_true(cJSON_GetArraySize(faces) >= 3); // two ends and the side
  assert_string_equal(text(tree, "format"), "cag-scene");
  cJSON_Delete(tree);
  fixture_end(&f);
}

static void materials_lights_cameras_and_odd_names_are_there(void **state) {
  (void)state;
  Fixture f;
  fixture_begin(&f);
  fixture_item(&f, CAG_ITEM_GROUND, "a \"quoted\"\\\n\x01 name \xce\xb8");
  cJSON *tree = export_tree(&f);
  assert_string_equal(text(cJSON_GetArrayItem(member(tree, "items"), 0), "name"),
                      "a \"quoted\"\\\n\x01 name \xce\xb8");
  assert_string_equal(text(cJSON_GetArrayItem(member(tree, "materials"), 0), "name"), "white");
  assert_string_equal(text(cJSON_GetArrayItem(member(tree, "lights"), 0), "kind"), "sun");
  const cJSON *camera = cJSON_GetArrayItem(member(tree, "cameras"), 0);
  assert_true(number(camera, "fov") == 0.4);
  // The view along +Y is the third column of the frame.
  assert_true(fabs(element(cJSON_GetArrayItem(member(camera, "frame"), 1), 2) - 1) < 1e-15);
  assert_true(cJSON_IsNull(member(tree, "background")));
  cJSON_Delete(tree);
  fixture_end(&f);
}

// --- Files of scripts ---

static cJSON *tree_of(const char *script) {
  CagSession *s = new_session();
  CagShownCounts counts;
  if (cag_session_run_text(s, "script", script, strlen(script)) != CAG_STATUS_OK ||
      cag_session_scene(s, &counts) != CAG_STATUS_OK) {
    cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr);
    fail_msg("the script fails: %s", script);
  }
  const Fixture f = {.scene = s->scene};
  cJSON *tree = export_tree(&f);
  cag_session_free(s);
  return tree;
}

// Whether a value contains everything expected: the members of objects, all elements of lists, and
// numbers up to rounding.
static bool has(const cJSON *found, const cJSON *expected) {
  if (!found) return false;
  if (cJSON_IsObject(expected)) {
    for (const cJSON *m = expected->child; m; m = m->next)
      if (!has(cJSON_GetObjectItemCaseSensitive(found, m->string), m)) return false;
    return cJSON_IsObject(found);
  }
  if (cJSON_IsArray(expected)) {
    if (cJSON_GetArraySize(found) != cJSON_GetArraySize(expected)) return false;
    const cJSON *a = found->child;
    for (const cJSON *b = expected->child; b; a = a->next, b = b->next)
      if (!has(a, b)) return false;
    return cJSON_IsArray(found);
  }
  if (cJSON_IsNumber(expected))
    return cJSON_IsNumber(found) && fabs(found->valuedouble - expected->valuedouble) < 1e-12;
  return cJSON_Compare(found, expected, true);
}

#define UNMOVED "[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]"

// The form described by the header, for each kind of curve, surface, solid, light, and setting. The
// values are those of the script.
static void every_member_has_the_value_of_the_script(void **state) {
  (void)state;
  static const struct {
    const char *show, *expected;
  } cases[] = {
      {"line([1, 2], [3, 5])",
       "{'items':[{'kind':'curve','name':'line','line_radius':0,'dash':0,'curve':{'type':'line',"
       "'dimension':2,'domain':[0,1],'angular':false,'closed':false,"
       "'points':[[1,2],[3,5]]}}]}"},
      {"line_style(polyline([[0, 0, 1], [3, 0, 1], [3, 4, 2]], closed: true), 0.5, dash: 2)",
       "{'items':[{'line_radius':0.5,'dash':2,'curve':{'type':'polyline','dimension':3,"
       "'closed':true,'points':[[0,0,1],[3,0,1],[3,4,2]]}}]}"},
      {"ellipse(5, 3)", "{'items':[{'curve':{'type':'ellipse','domain':[0,6.283185307179586],"
                        "'angular':true,'closed':true,'a':5,'b':3,'frame':" UNMOVED "}}]}"},
      {"helix(10, 3, 2)", "{'items':[{'curve':{'type':'helix','domain':[0,12.566370614359172],"
                          "'angular':true,'closed':false,'radius':10,'pitch':3,'turns':2,'taper':0,"
                          "'frame':" UNMOVED "}}]}"},
      {"bspline([[0, 0], [1, 0], [1, 1]], degree: 2, closed: true)",
       "{'items':[{'curve':{'degree':2,'periodic':true,'closed':true,'weights':null,"
       "'knots':[-2,-1,0,1,2,3,4,5],'points':[[0,0],[1,0],[1,1],[0,0],[1,0]]}}]}"},
      {"bezier([[0, 0, 1], [2, 0, 1], [4, 4, 1]], weights: [1, 0.5, 2])",
       "{'items':[{'curve':{'degree':2,'periodic':false,'weights':[1,0.5,2],"
       "'knots':[0,0,0,1,1,1],'points':[[0,0,1],[2,0,1],[4,4,1]]}}]}"},
      {"region(circle(5), holes: [circle(1), circle(1, center: [3, 0])])",
       "{'items':[{'kind':'region','placement':" UNMOVED ",'region':{'outer':[0,0,0],"
       "'loops':[{'type':'circle','a':5,'b':5},{'a':1,'b':1},{'a':1,'b':1}]}}]}"},
      {"bezier_surface([[[0,0,0],[0,1,1]],[[1,0,0],[1,1,0]],[[2,0,1],[2,1,0]]], "
       "weights: [[1,2],[1,1],[3,1]])",
       "{'items':[{'kind':'surface','surface':{'u':[0,1],'v':[0,1],'closed':[false,false],"
       "'degree':[2,1],'periodic':[false,false],'knots':[[0,0,0,1,1,1],[0,0,1,1]],"
       "'points':[[[0,0,0],[0,1,1]],[[1,0,0],[1,1,0]],[[2,0,1],[2,1,0]]],"
       "'weights':[[1,2],[1,1],[3,1]]}}]}"},
      {"bezier_surface([[[0,0,0],[0,1,1]],[[1,0,0],[1,1,0]]])",
       "{'items':[{'surface':{'weights':null,'degree':[1,1]}}]}"},
      {"revolve(line([3, 0, 0], [4, 0, 5]), angle: 90deg)",
       "{'items':[{'surface':{'type':'revolution','u':[0,1],'v':[0,1.5707963267948966],"
       "'axis':[0,0,1],'through':[0,0,0],'angle':[0,1.5707963267948966],"
       "'profile':{'type':'line','points':[[3,0,0],[4,0,5]]}}}]}"},
      {"translate(torus_surface(5, 2), [1, 2, 3])",
       "{'items':[{'surface':{'closed':[true,true],'nurbs':{'degree':[2,2],'closed':[true,true]}}}]"
       "}"},
      {"box([1, 2, 3], centered: true)",
       "{'items':[{'kind':'solid','solid':{'type':'box','size':[1,2,3],'centered':true,"
       "'placement':" UNMOVED "}}]}"},
      {"translate(box(2), [5, 6, 7])", "{'items':[{'solid':{'size':[2,2,2],'centered':false,"
                                       "'placement':[[1,0,0,5],[0,1,0,6],[0,0,1,7],[0,0,0,1]]}}]}"},
      {"sphere(4)", "{'items':[{'solid':{'type':'sphere','radius':4}}]}"},
      {"torus(5, 1)", "{'items':[{'solid':{'type':'torus','major':5,'minor':1}}]}"},
      {"cylinder(6, 3, 2)", "{'items':[{'solid':{'height':6,'radius':3,'top':2}}]}"},
      {"sphere(2) - box(1)",
       "{'items':[{'solid':{'type':'difference','placement':" UNMOVED ",'operands':["
       "{'type':'sphere','placement':" UNMOVED ",'radius':2},{'type':'box','size':[1,1,1]}]}}]}"},
      {"half_space(plane([0, 0, 1], Z)) & sphere(2)",
       "{'items':[{'solid':{'type':'intersection','operands':["
       "{'type':'half_space','form':[0,0,0,0,0,0,0,0,1,-1]},{'type':'sphere'}]}}]}"},
      {"label([1, 2, 3], \"A\"), label([1, 2, 3], \"B\", along: X), "
       "label([1, 2], \"C\", mark: \"dot\", place: \"left\", size: 3)",
       "{'labels':[{'text':'A','at':[1,2,3],'place':'right','mark':'none','size':0,'material':1},"
       "{'text':'B','at':[1,2,3],'along':[1,0,0]},"
       "{'text':'C','at':[1,2,0],'place':'left','mark':'dot','size':3}]}"},
      {"box(1), point_light([1, 2, 3]), spot_light([0, 0, 10], [0, 0, 4], angle: 90deg), "
       "area_light([0, 9, 0], origin, 5), sun(-Z, color: [1, 0.5, 0.25], strength: 3)",
       "{'studio':false,'lights':["
       "{'kind':'point','position':[1,2,3],'color':[1,1,1],'strength':1},"
       "{'kind':'spot','position':[0,0,10],'direction':[0,0,-1],'angle':1.5707963267948966},"
       "{'kind':'area','position':[0,9,0],'direction':[0,-1,0],'size':5},"
       "{'kind':'sun','direction':[0,0,-1],'color':[1,0.5,0.25],'strength':3}]}"},
      {"box(1), camera([0, -9, 0]), camera([0, -9, 0], kind: \"orthographic\", width: 5, "
       "size: [64, 48], focus: 3, aperture: 2)",
       "{'automatic_camera':false,'cameras':[{'projection':'perspective','eye':[0,-9,0],"
       "'target':[0,0,0],'up':[0,0,1],'fov':0.6981317007977318,'size':[1280,720],"
       "'frame':[[1,0,0,0],[0,0,1,-9],[0,-1,0,0],[0,0,0,1]]},"
       "{'projection':'orthographic','width':5,'size':[64,48],'focus':3,'aperture':2}]}"},
      {"box(2), sky([[1, 0, 0], [0, 0, 1]]), background([0.5, 0, 1])",
       "{'bounds':{'min':[0,0,0],'max':[2,2,2]},'tolerance':0,'automatic_camera':true,"
       "'sky':{'colors':[[1,0,0],[0,0,1]]},'background':[0.5,0,1]}"},
      {"line([5, 0, 0], [5, 7, 8]), sun(-Z)", "{'bounds':{'min':[5,0,0],'max':[5,7,8]}}"},
      {"box(2), sun(-Z)", "{'sky':null,'background':null}"},
      {"box(2), ground(-3, size: 20), sun(-Z)",
       "{'items':[{'kind':'solid'},{'kind':'ground','z':-3,'size':20}]}"},
      {"material(box(1), {metallic: 0.5, roughness: 0.25, ior: 2, transmission: 0.125, coat: 1, "
       "color: [0.5, 0.25, 0.125], emission: [1, 2, 3], texture: \"wood\", color2: [1, 0, 1], "
       "texture_scale: 7, pov: \"texture \\{ T \\}\", name: \"skin\"})",
       "{'items':[{'material':2}],'materials':[{'name':'default'},{'name':'ink'},{'name':'skin',"
       "'metallic':0.5,'roughness':0.25,'ior':2,'transmission':0.125,'coat':1,"
       "'color':[0.5,0.25,0.125],'emission':[1,2,3],'texture':'wood','color2':[1,0,1],"
       "'texture_scale':7,'pov':'texture { T }'}]}"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char script[1000], expected[2000];
    // The only light and ground are those of the case.
    const bool lit = strstr(cases[i].show, "sun") || strstr(cases[i].show, "sky");
    snprintf(script, sizeof script, "show %s%s", cases[i].show, lit ? "" : ", sun(-Z)");
    snprintf(expected, sizeof expected, "%s", cases[i].expected);
    for (char *c = expected; *c; c++)
      if (*c == '\'') *c = '"';
    cJSON *found = tree_of(script), *subset = cJSON_Parse(expected);
    if (!subset) fail_msg("%s", cases[i].expected);
    if (strstr(cases[i].show, "light"))
      cJSON_DeleteItemFromArray(cJSON_GetObjectItem(found, "lights"), 4);
    if (!has(found, subset)) fail_msg("%s: %s", cases[i].show, cJSON_Print(found));
    cJSON_Delete(found);
    cJSON_Delete(subset);
  }
}

// A curve without an exact form is sampled within a thousandth of its size, or within the scene's
// tolerance. y = x^4 / 4 has y'' = 3 x^2, so a chord of length h deviates by h^2 y'' / 8.
static void other_curves_are_sampled(void **state) {
  (void)state;
  static const double tolerances[] = {0, 1e-5};
  for (int i = 0; i < 2; i++) {
    CagSession *s = new_session();
    CagShownCounts counts;
    const char *script = "show curve(t => [t, t^4 / 4, exp(t)], 0..2), sun(-Z)";
    assert_int_equal(cag_session_run_text(s, "script", script, strlen(script)), CAG_STATUS_OK);
    assert_int_equal(cag_session_scene(s, &counts), CAG_STATUS_OK);
    Fixture f = {.scene = s->scene};
    f.scene.tolerance = tolerances[i];
    cJSON *tree = export_tree(&f);
    const cJSON *samples =
        member(member(cJSON_GetArrayItem(member(tree, "items"), 0), "curve"), "samples");
    const cJSON *t = member(samples, "parameters"), *p = member(samples, "points");
    const int n = cJSON_GetArraySize(t);
    assert_int_equal(cJSON_GetArraySize(p), n);
    assert_true(element(t, 0) == 0 && element(t, n - 1) == 2);
    const double size = sqrt(4 + 16 + pow(exp(2) - 1, 2)), within = i ? 1e-5 : size / 1000;
    double worst = 0;
    for (int k = 0; k < n; k++) {
      const double x = element(t, k);
      const cJSON *q = cJSON_GetArrayItem(p, k);
      assert_true(element(q, 0) == x && fabs(element(q, 1) - pow(x, 4) / 4) < 1e-12);
      assert_true(fabs(element(q, 2) - exp(x)) < 1e-12);
      if (k == 0) continue;
      const double h = x - element(t, k - 1), middle = x - h / 2;
      const double off = h * h / 8 * hypot(3 * middle * middle, exp(middle));
      const double slope = 1 + pow(middle, 6) + exp(2 * middle);
      worst = fmax(worst, off / sqrt(slope)); // at most the distance from the chord
    }
    if (worst > within * 1.05 || n > 400 * (i ? 30 : 1)) fail_msg("%d samples, %g off", n, worst);
    cJSON_Delete(tree);
    cag_session_free(s);
  }
}

// Closed surfaces and meshes have outward normals, regardless of their orientation in the script.
static void closed_shapes_are_written_outward(void **state) {
  (void)state;
  static const char *const scripts[] = {
      "show sun(-Z), mesh([[0,0,0],[1,0,0],[0,1,0],[0,0,1]], [[0,1,2],[0,3,1],[0,2,3],[1,3,2]])",
      "show sun(-Z), mesh([[0,0,0],[1,0,0],[0,1,0],[0,0,1]], [[0,2,1],[0,1,3],[0,3,2],[1,2,3]])"};
  for (int i = 0; i < 2; i++) {
    cJSON *tree = tree_of(scripts[i]);
    const cJSON *mesh = member(cJSON_GetArrayItem(member(tree, "items"), 0), "mesh");
    const cJSON *v = member(mesh, "vertices"), *t;
    double volume = 0;
    cJSON_ArrayForEach(t, member(mesh, "triangles")) {
      CagVec3 p[3];
      for (int k = 0; k < 3; k++) {
        const cJSON *q = cJSON_GetArrayItem(v, (int)element(t, k));
        p[k] = cag_vec3(element(q, 0), element(q, 1), element(q, 2));
      }
      volume += cag_dot(p[0], cag_cross(p[1], p[2])) / 6;
    }
    assert_true(fabs(volume - 1.0 / 6) < 1e-12);
    cJSON_Delete(tree);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(numbers_come_back_as_the_same_doubles),
      cmocka_unit_test(solids_keep_their_parameters_and_place),
      cmocka_unit_test(every_kind_of_item_is_written),
      cmocka_unit_test(materials_lights_cameras_and_odd_names_are_there),
      cmocka_unit_test(every_member_has_the_value_of_the_script),
      cmocka_unit_test(other_curves_are_sampled),
      cmocka_unit_test(closed_shapes_are_written_outward),
  };
  fixture_folder(folder);
  int failed = cmocka_run_group_tests(tests, NULL, NULL);
  fixture_folder_remove(folder);
  return failed;
}
