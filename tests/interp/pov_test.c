// POV-Ray source: the renderer accepts it, shapes with native objects use them, and pictures agree
// with cameras, lights, and meshes.

#include "tests/interp/scene_fixture.h"

#include "interp/formats/pov.h"
#include "interp/render/exr.h"

static char folder[64];

static void export_to(const Fixture *f, const CagPovOptions *options, char path[128]) {
  CagError io;
  static int counter;
  snprintf(path, 128, "%s/scene%d.pov", folder, counter++);
  CagAtomicFile *file = cag_atomic_file_open(path, &io);
  assert_non_null(file);
  OK(cag_export_pov(&f->scene, options, file, &err));
  assert_true(cag_atomic_file_commit(file, &io));
}

static char *export_text(const Fixture *f, bool meshes_only) {
  CagPovOptions options = CAG_POV_OPTIONS_DEFAULT;
  char path[128];
  options.quality = CAG_POV_DRAFT;
  options.meshes_only = meshes_only;
  export_to(f, &options, path);
  return read_whole(path);
}

static bool have_povray(void) { return system("povray --version >/dev/null 2>&1") == 0; }

// Runs the renderer without the user's configuration. Prints its messages if it fails.
static void run_povray(const char *pov, const char *picture, int width, int height) {
  char command[512];
  snprintf(command, sizeof command,
           "povray '+I%s' '+O%s' +FE +W%d +H%d -D -GA +A0.1 +R2 >'%s/log' 2>&1 || { cat '%s/log'; "
           "exit 1; }",
           pov, picture, width, height, folder, folder);
  assert_int_equal(system(command), 0);
}

static void render(const Fixture *f, bool meshes_only, CagImage *out) {
  CagPovOptions options = CAG_POV_OPTIONS_DEFAULT;
  char pov[128], picture[160];
  CagError io;
  options.quality = CAG_POV_DRAFT;
  options.meshes_only = meshes_only;
  export_to(f, &options, pov);
  snprintf(picture, sizeof picture, "%s.exr", pov);
  run_povray(pov, picture, f->camera.size[0], f->camera.size[1]);
  if (!cag_exr_read(picture, out, NULL, &io)) fail_msg("%s", io.message);
}

static float *plane_of(const CagImage *image, int channel) {
  size_t rgb[3];
  assert_true(cag_image_find_color(image, rgb));
  return cag_image_plane(image, rgb[channel]);
}

// --- Shapes ---

static CagSurface *wavy_patch(void) {
  CagVec3 net[16];
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      net[4 * i + j] = cag_vec3(30.0 * i - 45, (i == 1 || j == 2) ? 20 : -15, 24.0 * j - 36);
  CagSurface *s;
  OK(cag_surface_bezier(net, NULL, 4, 4, &s, &err));
  return s;
}

static CagSurface *turned_spline(void) {
  const CagVec3 p[] = {{10, -40, 0}, {45, -30, 0}, {40, 10, 0}, {8, 20, 0}, {25, 40, 0}};
  const double knots[] = {0, 0, 0, 0, 1, 2, 2, 2, 2};
  CagCurve *c;
  CagSurface *s;
  CagVec3 profile[5];
  for (int i = 0; i < 5; i++) profile[i] = cag_vec3(p[i].x, 0, p[i].y);
  OK(cag_curve_nurbs(profile, NULL, 5, 3, knots, 3, &c, &err));
  OK(cag_surface_revolve(c, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0, 2 * M_PI, &s, &err));
  cag_curve_release(c);
  return s;
}

static CagSurface *hyperboloid(double turn) {
  CagQuadric q = {{1 / 400.0, 1 / 400.0, -1 / 625.0, 0, 0, 0, 0, 0, 0, -1}};
  CagTransform t;
  CagSurface **patches, *s;
  size_t n;
  CagBounds box = {{-INFINITY, -INFINITY, -35}, {INFINITY, INFINITY, 30}};
  OK(cag_rotate(cag_vec3(1, 0, 0), turn, cag_vec3(0, 0, 0), &t, &err));
  OK(cag_quadric_patches(&q, &box, true, &patches, &n, &err));
  assert_int_equal(n, 1);
  OK(cag_surface_transform(patches[0], &t, &s, &err));
  cag_surface_release(patches[0]);
  free(patches);
  return s;
}

static CagRegion *plate_with_hole(bool round_hole) {
  const CagVec3 outer[] = {{-40, -25, 0}, {40, -25, 0}, {30, 30, 0}, {-40, 25, 0}};
  const CagVec3 hole[] = {{-10, -8, 0}, {12, -10, 0}, {0, 12, 0}};
  const CagVec3 leaf[] = {{-15, 0, 0}, {0, 30, 0}, {20, -30, 0}, {-15, 0, 0}};
  CagCurve *o, *h;
  CagRegion *r;
  OK(cag_curve_polyline(outer, 4, true, 2, &o, &err));
  if (round_hole) OK(cag_curve_bezier(leaf, NULL, 4, 2, &h, &err));
  else OK(cag_curve_polyline(hole, 3, true, 2, &h, &err));
  OK(cag_region_new(o, &h, 1, &r, &err));
  cag_curve_release(o);
  cag_curve_release(h);
  return r;
}

static CagSolid *extruded(bool round_hole) {
  CagRegion *r = plate_with_hole(round_hole);
  CagSolid *s, *turned;
  CagTransform t;
  OK(cag_solid_extrude(r, cag_vec3(5, 0, 30), 0, 1, &s, &err));
  OK(cag_rotate(cag_vec3(1, 0.3, 0), 1.1, cag_vec3(0, 0, 0), &t, &err));
  OK(cag_solid_transform(s, &t, &turned, &err));
  cag_region_release(r);
  cag_solid_release(s);
  return turned;
}

static CagSolid *moved_solid(CagSolid *s, CagTransform t) {
  CagSolid *out;
  OK(cag_solid_transform(s, &t, &out, &err));
  cag_solid_release(s);
  return out;
}

static CagTransform skewed(void) {
  CagTransform a, shear = cag_shear(0.3, 0, 0, 0, 0, 0.2);
  OK(cag_rotate(cag_vec3(1, 1, 0), 0.7, cag_vec3(0, 0, 0), &a, &err));
  return cag_transform_multiply(&a, &shear);
}

static CagSolid *sphere(double radius) {
  CagSolid *s;
  OK(cag_solid_sphere(radius, &s, &err));
  return s;
}
static CagSolid *cylinder(double height, double radius, double top) {
  CagSolid *s;
  OK(cag_solid_cylinder(height, radius, top, &s, &err));
  return s;
}
static CagSolid *torus(double major, double minor) {
  CagSolid *s;
  OK(cag_solid_torus(major, minor, &s, &err));
  return s;
}
static CagSolid *box(double size) {
  CagSolid *s;
  OK(cag_solid_box(cag_vec3(size, size, size), true, &s, &err));
  return s;
}

static CagCurve *helix(void) {
  CagCurve *c;
  OK(cag_curve_helix(30, 10, 3, 0, &c, &err));
  return c;
}
static CagCurve *segment(void) {
  CagCurve *c;
  OK(cag_curve_line(cag_vec3(0, 0, 0), cag_vec3(10, 20, 30), 3, &c, &err));
  return c;
}
static CagCurve *circle(double radius) {
  CagCurve *c;
  CagTransform frame = cag_transform_identity();
  OK(cag_curve_arc(radius, radius, 0, 2 * M_PI, &frame, &c, &err));
  return c;
}

// --- Tests ---

static void every_kind_parses_and_native_objects_are_used(void **state) {
  (void)state;
  Fixture f;
  fixture_begin(&f);
  CagItem *ground = fixture_item(&f, CAG_ITEM_GROUND, "ground");
  ground->ground_z = -60;
  ground->ground_size = INFINITY;
  CagItem *slab = fixture_item(&f, CAG_ITEM_GROUND, "slab");
  slab->ground_z = -55;
  slab->ground_size = 80;
  fixture_solid(&f, "ball", sphere(10));
  fixture_solid(&f, "egg", moved_solid(sphere(10), skewed()));
  fixture_solid(&f, "dice", box(10));
  fixture_solid(&f, "can", cylinder(20, 5, 5));
  fixture_solid(&f, "cup", cylinder(20, 5, 8));
  fixture_solid(&f, "ring", torus(20, 5));
  fixture_solid(&f, "plate", extruded(false));
  fixture_solid(&f, "leaf", extruded(true));
  fixture_surface(&f, "patch", wavy_patch());
  fixture_surface(&f, "vase", turned_spline());
  fixture_surface(&f, "tower", hyperboloid(0.4));
  fixture_region(&f, "flat", plate_with_hole(false));
  fixture_region(&f, "round", plate_with_hole(true));
  fixture_curve(&f, "path", helix());
  fixture_curve(&f, "dashes", helix())->dash = 3;
  fixture_curve(&f, "stick", segment());
  fixture_curve(&f, "hoop", circle(25));

  char *text = export_text(&f, false);
  static const char *const native[] = {"ground = plane {",
                                       "slab = box {",
                                       "ball = sphere {",
                                       "egg = sphere {",
                                       "dice = box {",
                                       "can = cylinder {",
                                       "cup = cone {",
                                       "ring = torus {",
                                       "plate = prism {",
                                       "leaf = prism {",
                                       "patch = bicubic_patch {",
                                       "vase = lathe {",
                                       "tower = quadric {",
                                       "flat = polygon {",
                                       "round = mesh2 {",
                                       "path = union {",
                                       "dashes = union {",
                                       "stick = cylinder {",
                                       "hoop = torus {"};
  for (size_t i = 0; i < sizeof native / sizeof *native; i++)
    if (!strstr(text, native[i])) fail_msg("no `%s` in the file", native[i]);
  free(text);

  if (have_povray()) {
    CagImage image;
    f.camera.size[0] = 24;
    f.camera.size[1] = 18;
    render(&f, false, &image);
    assert_int_equal(image.width, 24);
    assert_int_equal(image.height, 18);
    cag_image_free(&image);
  }
  fixture_end(&f);
}

// --- Dashes ---

// The position of a point along the polyline.
static double run_of(const CagVec3 *corners, size_t n, CagVec3 p) {
  double run = 0;
  for (size_t i = 0; i + 1 < n; i++) {
    const CagVec3 side = cag_sub(corners[i + 1], corners[i]), at = cag_sub(p, corners[i]);
    const double length = cag_norm(side), along = cag_dot(at, side) / length;
    if (fabs(cag_norm(at) - along) < 1e-9 && along < length + 1e-9) return run + along;
    run += length;
  }
  fail_msg("a dash lies beside its curve");
  return 0;
}

static void check_dashes(const CagVec3 *corners, size_t n, double dash) {
  Fixture f = {0};
  CagCurve *c;
  fixture_begin(&f);
  OK(cag_curve_polyline(corners, n, false, 3, &c, &err));
  fixture_curve(&f, "dashes", c)->dash = dash;
  char *text = export_text(&f, false);
  double whole = 0, expected = 0, drawn = 0;
  for (size_t i = 0; i + 1 < n; i++) whole += cag_norm(cag_sub(corners[i + 1], corners[i]));
  for (double from = 0; from < whole; from += 2 * dash) expected += fmin(dash, whole - from);
  const char *at = strstr(text, "dashes = union {");
  assert_non_null(at);
  while ((at = strstr(at + 1, "cylinder { <"))) {
    CagVec3 p, q;
    if (sscanf(at, "cylinder { <%lf, %lf, %lf>, <%lf, %lf, %lf>, line_radius", &p.x, &p.y, &p.z,
               &q.x, &q.y, &q.z) != 6)
      continue;
    const double from = run_of(corners, n, p), to = run_of(corners, n, q);
    const double start = 2 * dash * floor((from + to) / 2 / (2 * dash));
    assert_true(from >= start - 1e-9 && to <= start + dash + 1e-9);
    drawn += to - from;
  }
  if (fabs(drawn - expected) > 1e-8) fail_msg("dash %g: %g drawn, not %g", dash, drawn, expected);
  free(text);
  fixture_end(&f);
}

// Including around corners.
static void every_other_dash_is_drawn(void **state) {
  (void)state;
  const CagVec3 corners[] = {{0, 0, 0}, {2.5, 0, 0}, {2.5, 4, 0}, {2.5, 4, 1.3}, {-3, 4, 1.3}};
  const double dashes[] = {0.4, 0.7, 1, 1.9, 2.5, 6, 100};
  for (size_t i = 0; i < sizeof dashes / sizeof *dashes; i++)
    for (size_t n = 2; n <= 5; n++) check_dashes(corners, n, dashes[i]);
}

// The root mean square difference of all colors.
static double difference(const CagImage *a, const CagImage *b) {
  double sum = 0;
  size_t n = a->width * a->height;
  assert_int_equal(n, b->width * b->height);
  for (int c = 0; c < 3; c++) {
    const float *p = plane_of(a, c), *q = plane_of(b, c);
    for (size_t i = 0; i < n; i++) sum += (double)(p[i] - q[i]) * (p[i] - q[i]);
  }
  return sqrt(sum / (3.0 * (double)n));
}

// The fraction of pixels that show something.
static double coverage(const CagImage *a) {
  size_t n = a->width * a->height, lit = 0;
  const float *p = plane_of(a, 1);
  for (size_t i = 0; i < n; i++) lit += p[i] > 0.01;
  return (double)lit / (double)n;
}

// A mesh within 0.02 mm of a shape whose pixels are 1.3 mm wide differs from it only in shading:
// normals are the surface's own, interpolated. 0.015 allows for the silhouettes of a mesh with 15
// degree steps.
static void check_native_against_mesh(Fixture *f) {
  CagImage native, mesh;
  f->scene.tolerance = 0.02;
  char *text = export_text(f, false);
  assert_null(strstr(text, "mesh2"));
  free(text);
  render(f, false, &native);
  render(f, true, &mesh);
  double off = difference(&native, &mesh);
  if (!(off < 0.015)) fail_msg("%s: native and mesh differ by %g", f->items[0].name, off);
  assert_true(coverage(&native) > 0.02);
  cag_image_free(&native);
  cag_image_free(&mesh);
  fixture_end(f);
}

static void native_objects_look_like_their_meshes(void **state) {
  (void)state;
  if (!have_povray()) skip();
  Fixture f;
  CagSolid *const solids[] = {moved_solid(sphere(30), skewed()),
                              moved_solid(torus(30, 12), skewed()),
                              moved_solid(cylinder(40, 10, 25), skewed()),
                              moved_solid(box(30), skewed()),
                              extruded(false),
                              extruded(true)};
  for (size_t i = 0; i < sizeof solids / sizeof *solids; i++) {
    char name[16];
    snprintf(name, sizeof name, "solid%zu", i);
    fixture_begin(&f);
    fixture_solid(&f, name, solids[i]);
    check_native_against_mesh(&f);
  }
  CagSurface *const surfaces[] = {wavy_patch(), turned_spline(), hyperboloid(0), hyperboloid(0.6)};
  for (size_t i = 0; i < sizeof surfaces / sizeof *surfaces; i++) {
    char name[16];
    snprintf(name, sizeof name, "surface%zu", i);
    fixture_begin(&f);
    fixture_surface(&f, name, surfaces[i]);
    check_native_against_mesh(&f);
  }
}

// Projects a point by the camera's frame to pixels from the upper left.
static void project(const CagCamera *c, CagVec3 p, double *x, double *y) {
  CagTransform frame = cag_camera_frame(c), inverse;
  OK(cag_transform_inverse(&frame, &inverse, &err));
  CagVec3 q = cag_transform_point(&inverse, p);
  double span = c->orthographic ? c->width : 2 * q.z * tan(c->fov / 2);
  *x = c->size[0] * (0.5 + q.x / span);
  *y = 0.5 * c->size[1] + c->size[0] * q.y / span;
}

static void center_of_light(const CagImage *image, int channel, double *x, double *y) {
  const float *p = plane_of(image, channel);
  double sum = 0;
  *x = *y = 0;
  for (size_t i = 0; i < image->width * image->height; i++) {
    double v = p[i] > 0.02F ? 1 : 0; // the disk, regardless of its shading
    sum += v;
    *x += v * ((double)(i % image->width) + 0.5);
    *y += v * ((double)(i / image->width) + 0.5);
  }
  assert_true(sum > 0);
  *x /= sum;
  *y /= sum;
}

// A red ball to the right (+X) and a green one above (+Z) of the center of a camera that looks
// along +Y. The picture is not reflected, and both are at the projected positions.
static void check_positions(bool orthographic) {
  static const CagVec3 red = {40, 0, -6}, green = {-22, 30, 28};
  Fixture f;
  CagImage image;
  double x, y, px, py;
  fixture_begin(&f);
  f.camera.orthographic = orthographic;
  f.camera.width = 140;
  f.camera.eye = cag_vec3(20, -300, 60);
  f.materials[1] = plain_material("red", 1, 0, 0);
  f.materials[2] = plain_material("green", 0, 1, 0);
  f.scene.material_count = 3;
  fixture_solid(&f, "red", moved_solid(sphere(4), cag_translate(red)))->material = 1;
  fixture_solid(&f, "green", moved_solid(sphere(4), cag_translate(green)))->material = 2;
  render(&f, false, &image);
  center_of_light(&image, 0, &x, &y);
  project(&f.camera, red, &px, &py);
  assert_true(x > 48 && fabs(x - px) < 0.4 && fabs(y - py) < 0.4);
  center_of_light(&image, 1, &x, &y);
  project(&f.camera, green, &px, &py);
  assert_true(y < 36 && fabs(x - px) < 0.4 && fabs(y - py) < 0.4);
  cag_image_free(&image);
  fixture_end(&f);
}

// The renderer's tolerances are absolute, but a scene scaled down to a thousandth must look the
// same.
static void tiny_scenes_look_like_large_ones(void **state) {
  (void)state;
  if (!have_povray()) skip();
  CagImage pictures[2];
  for (int i = 0; i < 2; i++) {
    double size = i == 0 ? 1 : 1e-3;
    Fixture f;
    fixture_begin(&f);
    f.camera.eye = cag_vec3(0, -300 * size, 40 * size);
    f.camera.aperture = 0;
    f.scene.bounds.min = cag_vec3(-50 * size, -50 * size, -50 * size);
    f.scene.bounds.max = cag_scaled(f.scene.bounds.min, -1);
    fixture_solid(&f, "ring", torus(30 * size, 8 * size));
    fixture_solid(
        &f, "ball",
        moved_solid(sphere(12 * size), cag_translate(cag_vec3(0, -20 * size, 25 * size))));
    render(&f, false, &pictures[i]);
    fixture_end(&f);
  }
  assert_true(difference(&pictures[0], &pictures[1]) < 1e-3);
  assert_true(coverage(&pictures[0]) > 0.05);
  cag_image_free(&pictures[0]);
  cag_image_free(&pictures[1]);
}

static void pictures_are_not_mirrored_and_match_the_camera(void **state) {
  (void)state;
  if (!have_povray()) skip();
  check_positions(false);
  check_positions(true);
}

static void a_white_face_square_to_a_sun_of_strength_1_is_white(void **state) {
  (void)state;
  if (!have_povray()) skip();
  Fixture f;
  CagImage image;
  fixture_begin(&f);
  fixture_solid(&f, "wall", box(60));
  render(&f, false, &image);
  const float *p = plane_of(&image, 1);
  double middle = p[image.height / 2 * image.width + image.width / 2];
  // 1, plus the broad highlight of a chalk of index 1.2: at most 1.5 F (n + 2) / 8 with F = 0.0083.
  assert_true(middle >= 1 && middle < 1.02);
  cag_image_free(&image);
  fixture_end(&f);
}

static void materials_of_every_pattern_parse(void **state) {
  (void)state;
  static char *const patterns[] = {"", "wood", "marble", "concrete", "clay"};
  Fixture f;
  fixture_begin(&f);
  for (size_t i = 0; i < 5; i++) {
    CagMaterial *m = &f.materials[1 + i];
    *m = plain_material(patterns[i][0] ? patterns[i] : "glass", 0.9, 0.8, 0.7);
    m->texture = patterns[i];
    m->transmission = i == 0;
    m->coat = (double)i / 5;
    m->emission = i == 1 ? (CagColor){1, 0.5, 0} : (CagColor){0, 0, 0};
    fixture_solid(&f, "ball", sphere(5))->material = 1 + i;
  }
  f.materials[6] = plain_material("own", 0, 0, 0);
  f.materials[6].pov = "pigment { checker rgb 1, rgb <1, 0, 0> } finish { ambient 0.2 }";
  f.materials[7] = plain_material("whole", 0, 0, 0);
  f.materials[7].pov = " texture { pigment { rgb 1 } }";
  f.scene.material_count = 8;
  fixture_solid(&f, "ball", sphere(5))->material = 6;
  fixture_solid(&f, "ball", sphere(5))->material = 7;
  fixture_surface(&f, "pane", turned_spline())->material = 1; // open: a thin sheet of the glass
  char *text = export_text(&f, false);
  assert_non_null(strstr(text, "pigment { checker rgb 1, rgb <1, 0, 0> } finish { ambient 0.2 }"));
  assert_non_null(strstr(text, "M_glass_thin = material {"));
  free(text);
  if (have_povray()) {
    CagImage image;
    f.camera.size[0] = f.camera.size[1] = 8;
    render(&f, false, &image);
    cag_image_free(&image);
  }
  fixture_end(&f);
}

static void names_become_identifiers_of_their_own(void **state) {
  (void)state;
  Fixture f;
  fixture_begin(&f);
  fixture_solid(&f, "sphere", sphere(5));
  fixture_solid(&f, "vase.2", sphere(5));
  fixture_solid(&f, "vase_2", sphere(5));
  fixture_solid(&f, "\xce\xb8", sphere(5));
  fixture_solid(&f, "2nd\n#include \"x\"", sphere(5));
  char *text = export_text(&f, false);
  assert_non_null(strstr(text, "#declare sphere_ = sphere {"));
  assert_non_null(strstr(text, "#declare vase_2 = sphere {"));
  assert_non_null(strstr(text, "#declare vase_2_2 = sphere {"));
  assert_null(strstr(text, "\n#include"));
  free(text);
  if (have_povray()) {
    CagImage image;
    f.camera.size[0] = f.camera.size[1] = 8;
    render(&f, false, &image);
    cag_image_free(&image);
  }
  fixture_end(&f);
}

static void an_empty_scene_and_a_missing_camera_are_errors(void **state) {
  (void)state;
  Fixture f;
  CagError err;
  CagError io;
  CagPovOptions options = CAG_POV_OPTIONS_DEFAULT;
  fixture_begin(&f);
  CagAtomicFile *file = cag_atomic_file_open("/dev/null", &io);
  assert_int_equal(cag_export_pov(&f.scene, &options, file, &err), CAG_E_ARGUMENT);
  assert_string_equal(cag_error_info(err.id)->reason, "nothing-to-show");
  fixture_solid(&f, "ball", sphere(5));
  options.camera = 3;
  assert_int_equal(cag_export_pov(&f.scene, &options, file, &err), CAG_E_ARGUMENT);
  assert_string_equal(cag_error_info(err.id)->reason, "camera-unknown");
  cag_atomic_file_abort(file);
  fixture_end(&f);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_kind_parses_and_native_objects_are_used),
      cmocka_unit_test(native_objects_look_like_their_meshes),
      cmocka_unit_test(every_other_dash_is_drawn),
      cmocka_unit_test(tiny_scenes_look_like_large_ones),
      cmocka_unit_test(pictures_are_not_mirrored_and_match_the_camera),
      cmocka_unit_test(a_white_face_square_to_a_sun_of_strength_1_is_white),
      cmocka_unit_test(materials_of_every_pattern_parse),
      cmocka_unit_test(names_become_identifiers_of_their_own),
      cmocka_unit_test(an_empty_scene_and_a_missing_camera_are_errors),
  };
  fixture_folder(folder);
  int failed = cmocka_run_group_tests(tests, NULL, NULL);
  fixture_folder_remove(folder);
  return failed;
}
