// JSON: the file parses, and its numbers are those of the scene.

#include "tests/interp/scene_fixture.h"

#include <cjson/cJSON.h>

#include "interp/export/json.h"

static char folder[64];

static cJSON *export_tree(const Fixture *f) {
  char path[128];
  CagIoError io;
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
  // Looking along +Y: the frame's third column.
  assert_true(fabs(element(cJSON_GetArrayItem(member(camera, "frame"), 1), 2) - 1) < 1e-15);
  assert_true(cJSON_IsNull(member(tree, "background")));
  cJSON_Delete(tree);
  fixture_end(&f);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(numbers_come_back_as_the_same_doubles),
      cmocka_unit_test(solids_keep_their_parameters_and_place),
      cmocka_unit_test(every_kind_of_item_is_written),
      cmocka_unit_test(materials_lights_cameras_and_odd_names_are_there),
  };
  fixture_folder(folder);
  int failed = cmocka_run_group_tests(tests, NULL, NULL);
  fixture_folder_remove(folder);
  return failed;
}
