// Files that exports write next to each other, their names, and messages.

#include <dirent.h>
#include <math.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "session_support.h"

static char folder[] = "/tmp/cag-session-export-XXXXXX";

static char *path_of(const char *name) {
  static char path[4][300];
  static int next;
  char *p = path[next++ % 4];
  snprintf(p, sizeof path[0], "%s/%s", folder, name);
  return p;
}

static char *text_of(const char *name) {
  static char text[200000];
  FILE *f = fopen(path_of(name), "rb");
  if (!f) fail_msg("there is no %s", name);
  text[fread(text, 1, sizeof text - 1, f)] = 0;
  fclose(f);
  return text;
}

static bool is_there(const char *name) { return access(path_of(name), F_OK) == 0; }

// Counts the files in a folder with an extension.
static int count_files(const char *in, const char *ending) {
  DIR *d = opendir(path_of(in));
  int n = 0;
  assert_non_null(d);
  for (struct dirent *e; (e = readdir(d));) {
    const size_t length = strlen(e->d_name), tail = strlen(ending);
    n += length > tail && strcmp(e->d_name + length - tail, ending) == 0;
  }
  closedir(d);
  return n;
}

static int enter(void **state) {
  (void)state;
  return mkdtemp(folder) && chdir(folder) == 0 ? 0 : -1;
}

static int leave(void **state) {
  (void)state;
  char command[100];
  snprintf(command, sizeof command, "rm -rf %s", folder);
  return chdir("/") || system(command);
}

static int export_as(CagSessionOptions options, const char *text, const char *path,
                     const char *format) {
  CagSession *s = cag_session_new(&options);
  if (cag_session_run_text(s, "some/where/part.cag", text, strlen(text)) != CAG_STATUS_OK) {
    cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr);
    fail();
  }
  const int status = cag_session_export(s, path, format);
  cag_session_free(s);
  return status;
}

static void exported(const char *text, const char *path, const char *format) {
  assert_int_equal(export_as(session_options(), text, path, format), CAG_STATUS_OK);
}

static void materials_lie_beside(void **state) {
  (void)state;
  static const struct {
    const char *path, *format, *beside, *line;
  } cases[] = {{"a.obj", NULL, "a.mtl", "mtllib a.mtl\n"},
               {"b", "obj", "b.mtl", "mtllib b.mtl\n"},
               {"v1.2/c", "OBJ", "v1.2/c.mtl", "mtllib c.mtl\n"},
               {"v1.2/d.e.obj", NULL, "v1.2/d.e.mtl", "mtllib d.e.mtl\n"}};
  mkdir("v1.2", 0777);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    exported("show color(box(1), \"red\")", cases[i].path, cases[i].format);
    assert_non_null(strstr(text_of(cases[i].path), cases[i].line));
    assert_non_null(strstr(text_of(cases[i].beside), "newmtl"));
    // Also with a full path, which has a folder.
    exported("show color(box(1), \"red\")", path_of(cases[i].path), cases[i].format);
    assert_non_null(strstr(text_of(cases[i].path), cases[i].line));
  }
}

// The data file of a .gltf file is named by its content. When it changes, the old file is removed.
static void data_of_gltf_is_renewed(void **state) {
  (void)state;
  // The first is small. The JSON of the other is longer than the part that is read from its end.
  static const char *const scenes[] = {"show box(1)", "show [for i in 0..<60: box(i + 1)]",
                                       "show box(2)", "show box(2)"};
  static const char *const paths[] = {"g.gltf", "sub/g.gltf"};
  mkdir("sub", 0777);
  for (size_t p = 0; p < 4; p++) {
    const char *name = paths[p / 2], *in = p / 2 ? "sub" : ".";
    for (size_t i = 0; i < 4; i++) {

      exported(scenes[i], p % 2 ? path_of(name) : name, NULL);
      if (count_files(in, ".bin") != 1)
        fail_msg("%s, scene %zu: %d files of data", name, i, count_files(in, ".bin"));
      const char *json = text_of(name), *uri = strstr(json, "\"uri\":\"");
      char bin[100];
      assert_non_null(uri);
      assert_int_equal(sscanf(uri, "\"uri\":\"%99[^\"]", bin), 1);
      assert_null(strchr(bin, '/'));
      assert_int_equal(strncmp(bin, "g-", 2), 0);
      assert_int_equal(strlen(bin), strlen("g-0123456789abcdef.bin"));
      char whole[200];
      snprintf(whole, sizeof whole, "%s/%s", in, bin);
      assert_true(is_there(whole));
      if (i == 1) assert_true(strlen(json) > 5000);
    }
  }
}

// Data files of other programs are kept, regardless of the contents of their JSON.
static void data_of_others_stays(void **state) {
  (void)state;
  static const char *const names[] = {"foreign.bin", "h-0123456789abcdeg.bin",
                                      "h_0123456789abcdef.bin", "i-0123456789abcdef.bin",
                                      "0123456789abcdef.bin"};
  mkdir("other", 0777);
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    char path[100];
    snprintf(path, sizeof path, "other/%s", names[i]);
    fclose(fopen(path, "w"));
    FILE *f = fopen("other/h.gltf", "w");
    fprintf(f, "{\"buffers\":[{\"byteLength\":0,\"uri\":\"%s\"}]}", names[i]);
    fclose(f);
    exported("show box(1)", "other/h.gltf", NULL);
    assert_true(is_there(path));
  }
  // A data file of this program: its stem is that of the file.
  FILE *f = fopen("other/h.gltf", "w");
  fprintf(f, "{\"buffers\":[{\"byteLength\":0,\"uri\":\"h-0123456789abcdef.bin\"}]}");
  fclose(f);
  fclose(fopen("other/h-0123456789abcdef.bin", "w"));
  exported("show box(1)", "other/h.gltf", NULL);
  assert_false(is_there("other/h-0123456789abcdef.bin"));
}

static void links_of_urdf_have_meshes_beside(void **state) {
  (void)state;
  static const char text[] = "show robot([revolute(a: 300, shape: cone(9, 3))], name: \"arm\")";
  mkdir("robots", 0777);
  exported(text, "r.urdf", NULL);
  assert_int_equal(count_files("r_meshes", ".stl") + count_files("r_meshes", ".obj"), 1);
  assert_non_null(strstr(text_of("r.urdf"), "\"r_meshes/"));
  exported(text, "robots/r.urdf", NULL);
  exported(text, "robots/r.urdf", NULL); // the folder may exist
  assert_int_equal(count_files("robots/r_meshes", ".stl") + count_files("robots/r_meshes", ".obj"),
                   1);
  assert_non_null(strstr(text_of("robots/r.urdf"), "\"r_meshes/"));
  assert_null(strstr(text_of("robots/r.urdf"), "robots/"));
  // A robot without shapes does not have a folder of meshes.
  exported("show robot([revolute(a: 300)])", "bare.urdf", NULL);
  assert_false(is_there("bare_meshes"));
  // A file with the name of the folder.
  fclose(fopen("s_meshes", "w"));
  assert_int_equal(export_as(session_options(), text, "s.urdf", NULL), CAG_STATUS_FILE);
  assert_false(is_there("s.urdf"));
  assert_int_equal(export_as(session_options(), text, "-", "urdf"), CAG_STATUS_USAGE);
}

// Counts the occurrences of a text.
static int times(const char *text, const char *part) {
  int n = 0;
  for (const char *at = text; (at = strstr(at, part)); at++) n++;
  return n;
}

// Names of links and materials contain only letters, digits, - . and _, and are unique.
static void names_of_urdf_are_plain_and_different(void **state) {
  (void)state;
  static const struct {
    const char *said, *written;
  } names[] = {{"azAZ_09.-", "azAZ_09.-"},
               {"b/:@[`^~,", "b________"},
               {"-c", "_c"},
               {".d", "_d"},
               {"9e", "_e"},
               {"\303\251", "\303\251"},
               {"f g", "f_g"},
               {"tool", "tool_2"},
               {"f_g", "f_g_2"},
               {"AZaz_09.-", "AZaz_09.-"},
               {"world", "world_2"}};
  char script[4000] = "show robot([", part[200];
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    snprintf(part, sizeof part, "%srevolute(a: 3, shape: named(cone(9, 3), \"%s\"))", i ? ", " : "",
             names[i].said);
    strcat(script, part);
  }
  strcat(script, "])");
  exported(script, "names.urdf", NULL);
  const char *urdf = text_of("names.urdf");
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    snprintf(part, sizeof part, "<link name=\"%s\">", names[i].written);
    if (times(urdf, part) != 1) fail_msg("%s: %d times", part, times(urdf, part));
    // File names that differ only in case might be the same file.
    snprintf(part, sizeof part, "filename=\"names_meshes/%s%s.stl\"", names[i].written,
             i == 9 ? "_2" : "");
    if (times(urdf, part) != 2) fail_msg("%s: %d times", part, times(urdf, part));
  }
  // More materials than the initial capacity: with the same name and different colors, and equal
  // ones.
  snprintf(
      script, sizeof script,
      "m(n, c) = material(cone(9, 3), {name: n, color: c})\n"
      "show robot([...[for i in 0..<3: revolute(a: 3, shape: [m(\"red\", [1, 0, 0]), m(\"red\", "
      "[0, 1, 0]), m(\"red\", [1, 0, 0]), m(\"red\", [0, 0, 1])])], "
      "...[for i in 0..<40: revolute(a: 3, shape: m(\"k{i}\", [0, 0, i / 40]))]])");
  exported(script, "materials.urdf", NULL);
  urdf = text_of("materials.urdf");
  static const struct {
    const char *name;
    double color[4];
    int uses;
  } materials[] = {{"red", {1, 0, 0, 1}, 6},
                   {"red_2", {0, 1, 0, 1}, 3},
                   {"red_3", {0, 0, 1, 1}, 3},
                   {"k0", {0, 0, 0, 1}, 1}};
  for (size_t i = 0; i < sizeof materials / sizeof *materials; i++) {
    snprintf(part, sizeof part, "<material name=\"%s\"/>", materials[i].name);
    assert_int_equal(times(urdf, part), materials[i].uses);
    snprintf(part, sizeof part, "<material name=\"%s\">", materials[i].name);
    assert_int_equal(times(urdf, part), 1);
    const char *at = strstr(strstr(urdf, part), "rgba=\"");
    double rgba[4];
    assert_int_equal(sscanf(at, "rgba=\"%lf %lf %lf %lf", &rgba[0], &rgba[1], &rgba[2], &rgba[3]),
                     4);
    for (int k = 0; k < 4; k++) assert_true(fabs(rgba[k] - materials[i].color[k]) < 1e-6);
  }
  for (int i = 0; i < 40; i++) {
    snprintf(part, sizeof part, "<material name=\"k%d\"/>", i);
    assert_int_equal(times(urdf, part), 1);
  }
}

static void exact_files_name_their_script(void **state) {
  (void)state;
  static const char *const paths[] = {"e.step", "e.igs"};
  for (size_t i = 0; i < 2; i++) {
    exported("show box(1)", paths[i], NULL);
    assert_non_null(strstr(text_of(paths[i]), "part.cag"));
    assert_null(strstr(text_of(paths[i]), "where/"));
    assert_null(strstr(text_of(paths[i]), "/part.cag"));
  }
}

static void approximations_are_told(void **state) {
  (void)state;
  char told[2000] = "";
  CagSessionOptions options = session_options();
  options.tolerance = 0.01;
  options.messages = fmemopen(told, sizeof told, "w");
  static const char text[] = "wavy = surface((u, v) => [u, v, sin(u * 1rad) / 9], 0..1, 0..1)\n"
                             "plain = box(1)\nshow plain, wavy";
  assert_int_equal(export_as(options, text, "t.step", NULL), CAG_STATUS_OK);
  fflush(options.messages);
  fclose(options.messages);
  assert_non_null(strstr(told, "note: wavy has no exact form: approximated within 0.01 mm"));
  assert_null(strstr(told, "plain"));
}

// A limit equal to the number of triangles of all parts is accepted, and one less is not.
static void triangles_of_all_parts_count(void **state) {
  (void)state;
  static const char text[] = "t(z) = mesh([[0, 0, z], [1, 0, z], [0, 1, z]], [[0, 1, 2]])\n"
                             "show t(0), t(1), t(2)";
  for (size_t most = 1; most < 5; most++) {
    CagSessionOptions options = session_options();
    options.max_triangles = most;
    assert_int_equal(export_as(options, text, "m.obj", NULL),
                     most < 3 ? CAG_STATUS_LIMIT : CAG_STATUS_OK);
  }
}

// However many parts are open, a subsequent error is still reported.
static void warnings_leave_room_for_an_error(void **state) {
  (void)state;
  enum { PARTS = 300 };
  static const char text[] =
      "show [for i in 0..<300: mesh([[0, 0, i], [1, 0, i], [0, 1, i]], [[0, 1, 2]])]";
  for (size_t most = PARTS - 1; most <= PARTS; most++) {
    CagSessionOptions options = session_options();
    options.max_triangles = most;
    CagSession *s = cag_session_new(&options);
    assert_int_equal(cag_session_run_text(s, "part.cag", text, strlen(text)), CAG_STATUS_OK);
    const int status = cag_session_export(s, "w.stl", NULL);
    assert_int_equal(status, most < PARTS ? CAG_STATUS_LIMIT : CAG_STATUS_OK);
    size_t warnings = 0, limits = 0;
    for (size_t i = 0; i < cag_session_error_count(s); i++) {
      CagErrorView e = {0};
      cag_session_error(s, i, &e);
      limits += e.reason && strcmp(e.reason, "triangle-limit") == 0;
      warnings += e.message && strstr(e.message, "is an open mesh, not a solid: 3 open edges");
    }
    assert_int_equal(limits, most < PARTS);
    assert_in_range(warnings, 10, PARTS - 1);
    cag_session_free(s);
  }
}

// Lines are exported only to pictures, unless nothing else is shown. Grounds are always exported.
static void lines_alone_are_tubes(void **state) {
  (void)state;
  static const struct {
    const char *text;
    bool body, line;
  } cases[] = {{"a = box(1)\nline = circle(3)\nshow line, a", true, false},
               {"line = circle(3)\nshow line", false, true},
               {"line = circle(3)\nshow ground(), line", false, true},
               {"a = box(1)\nshow ground(), a", true, false}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    exported(cases[i].text, "l.obj", NULL);
    const char *text = text_of("l.obj");
    assert_int_equal(strstr(text, "\no a\n") != NULL, cases[i].body);
    assert_int_equal(strstr(text, "\no line\n") != NULL, cases[i].line);
    assert_null(strstr(text, "ground"));
  }
}

static void refuses(const char *text, const char *path, const char *format, int status,
                    const char *message, const char *help) {
  CagSession *s = new_session();
  CagErrorView e = {0};
  assert_int_equal(cag_session_run_text(s, "part.cag", text, strlen(text)), 0);
  assert_int_equal(cag_session_export(s, path, format), status);
  cag_session_error(s, 0, &e);
  assert_non_null(e.message);
  assert_string_equal(e.message, message);
  assert_non_null(strstr(e.help, help));
  cag_session_free(s);
}

static void what_cannot_be_written_is_told(void **state) {
  (void)state;
  refuses("show ground()", "n.obj", NULL, CAG_STATUS_SCRIPT,
          "part.cag shows nothing that a mesh file can contain", "a ground is only for pictures");
  refuses("show box(1)", "n.urdf", NULL, CAG_STATUS_SCRIPT, "part.cag shows no robot",
          "show a robot, as it is");
  refuses("r(n) = robot([revolute(a: 3)], name: n)\nshow r(\"a\"), r(\"b\")", "n.urdf", NULL,
          CAG_STATUS_SCRIPT, "part.cag shows 2 robots (a, b), but a .urdf file describes one",
          "show only one");
  refuses("show [for i in 0..<9: robot([revolute(a: i + 1)], name: \"{i}\")]", "n.urdf", NULL,
          CAG_STATUS_SCRIPT,
          "part.cag shows 9 robots (0, 1, 2, 3, 4, 5, 6, 7, ...), but a .urdf file describes one",
          "show only one");
  refuses("show [for i in 0..<8: robot([revolute(a: i + 1)], name: \"{i}\")]", "n.urdf", NULL,
          CAG_STATUS_SCRIPT,
          "part.cag shows 8 robots (0, 1, 2, 3, 4, 5, 6, 7), but a .urdf file describes one",
          "show only one");
  refuses("show box(1)", "x.y/noending", NULL, CAG_STATUS_USAGE,
          "x.y/noending has no extension that determines the format",
          "use --format to choose a format: obj stl ply glb");
  refuses("show box(1)", "a.png", NULL, CAG_STATUS_SCRIPT, "part.cag shows no image",
          "`cag render` renders a picture of shapes");
  refuses("show box(1)", "a.EXR", NULL, CAG_STATUS_SCRIPT, "part.cag shows no image",
          "`cag render` renders a picture of shapes");
  refuses("show image([[1]])", "a.stl", NULL, CAG_STATUS_SCRIPT, "part.cag shows no shape",
          "to export an image");
  refuses("show [image([[1]]), image([[2]])]", "a.exr", NULL, CAG_STATUS_USAGE,
          "part.cag shows 2 images, expected one", "select one by --image: image, image.2");
  refuses("show image([[[1, 2]]])", "a.png", NULL, CAG_STATUS_USAGE,
          "cannot write 'a.png': a PNG has 1, 3, or 4 channels, the image has 2",
          "show channel(image, name)");
  refuses("show box(1)", "a.abc", NULL, CAG_STATUS_USAGE, "unknown format `abc`",
          "use --format to choose a format: obj stl ply glb");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(materials_lie_beside),
      cmocka_unit_test(data_of_gltf_is_renewed),
      cmocka_unit_test(data_of_others_stays),
      cmocka_unit_test(links_of_urdf_have_meshes_beside),
      cmocka_unit_test(names_of_urdf_are_plain_and_different),
      cmocka_unit_test(exact_files_name_their_script),
      cmocka_unit_test(approximations_are_told),
      cmocka_unit_test(triangles_of_all_parts_count),
      cmocka_unit_test(warnings_leave_room_for_an_error),
      cmocka_unit_test(lines_alone_are_tubes),
      cmocka_unit_test(what_cannot_be_written_is_told),
  };
  return cmocka_run_group_tests(tests, enter, leave);
}
