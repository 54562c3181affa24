// Parts of rendering in isolation: output of POV-Ray, sizes and channels of pictures, and truncated
// messages.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <string.h>

#include "interp/render/image.h"
#include "interp/render/povray_log.h"

// --- Output of POV-Ray ---

typedef struct Seen {
  char text[256]; // "parsing 0, rendering 50"
} Seen;

static void note(void *user, double percent, const char *phase) {
  Seen *seen = user;
  const size_t n = strlen(seen->text);
  snprintf(seen->text + n, sizeof seen->text - n, "%s%s %g", n ? ", " : "", phase, percent);
}

static void progress_is_read_from_what_povray_says(void **state) {
  (void)state;
  static const struct {
    const char *said, *seen;
  } ROWS[] = {
      {"==== [Parsing...] ====\n", "parsing 0"},
      {"==== [Parsing...] ====\nParsing 11K tokens\r", "parsing 0, parsing 0"},
      {"Parsing 11K tokens\r", ""}, // before any phase
      {"Parsing Options\n", ""},
      {"==== [Shooting Photons...] ====\nPhotons 20\rShooting photons now\r",
       "photons 0, photons 0, photons 0"},
      {"==== [Sorting photons...] ====\n", "photons 0"},
      {"==== [Radiosity...] ====\n", "radiosity 0"},
      {"==== [Rendering...] ====\rRendered 1 of 4 pixels (25%)\r", "rendering 0, rendering 25"},
      {"Rendered 3 of 4 pixels (75%)\r", "rendering 75"},
      {"Rendered 0 of 0 pixels\r", ""},
      {"Rendered some of 4 pixels\r", ""},
      {"==== [Of another kind] ====\n", ""},
      {"\n\r\n", ""},
  };
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    Seen seen = {""};
    CagPovrayLog log = {.progress = note, .progress_user = &seen}, silent = {0};
    // In chunks of any size.
    const size_t n = strlen(ROWS[i].said), first = n / 3;
    cag_povray_log_feed(&log, ROWS[i].said, first);
    cag_povray_log_feed(&log, ROWS[i].said + first, n - first);
    cag_povray_log_finish(&log);
    assert_string_equal(seen.text, ROWS[i].seen);
    cag_povray_log_feed(&silent, ROWS[i].said, n);
  }
}

// If POV-Ray fails, the last lines of its output are shown, without the progress.
static void progress_is_not_kept_as_last_words(void **state) {
  (void)state;
  static const char *const LINES[] = {"Parsing 11K tokens\r", "Rendered 1 of 4 pixels (25%)\r",
                                      "Photons 20\r", "Shooting photons now\r",
                                      "==== [Rendering...] ====\n"};
  CagPovrayLog bare = {0};
  char expected[1024], found[1024];
  cag_povray_log_feed(&bare, "Cannot open file.\n", 18);
  cag_povray_log_last(&bare, expected, sizeof expected);
  assert_non_null(strstr(expected, "Cannot open file."));
  for (size_t i = 0; i < sizeof LINES / sizeof *LINES; i++) {
    CagPovrayLog log = {0};
    cag_povray_log_feed(&log, LINES[i], strlen(LINES[i]));
    cag_povray_log_feed(&log, "Cannot open file.\n", 18);
    cag_povray_log_feed(&log, LINES[i], strlen(LINES[i]));
    cag_povray_log_last(&log, found, sizeof found);
    assert_string_equal(found, expected);
  }
}

static void the_first_error_with_a_place_counts(void **state) {
  (void)state;
  static const struct {
    const char *said, *file;
    size_t line;
    const char *text;
  } ROWS[] = {
      {"File 'scene.pov' line 12: Parse Error: Missing }\n", "scene.pov", 12, "Missing }"},
      {"File 'scene.pov' line 12: Parse Error: Missing\n }, sphere\n found\nelse\n", "scene.pov",
       12, "Missing }, sphere found"},
      {"File 'a.inc' line 3: Error: one\nFile 'b.inc' line 4: Error: two\n", "a.inc", 3, "one"},
      {"File 'a' line 1: Possible Parse Error: x\nFile 'b' line 2: Parse Error: y\n", "b", 2, "y"},
      {"File 'a' line 0: Error: x\n", "a", 1, "x"},
      {"File 'a' line 5: Parse Warning: x\n", "", 0, ""},
      {"File 'a' line 5 Error: x\n", "", 0, ""},
      {"File 'a' of line 5: Error: x\n", "", 0, ""},
      {"Error: no place\n", "", 0, ""},
  };
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    CagPovrayLog log = {0};
    cag_povray_log_feed(&log, ROWS[i].said, strlen(ROWS[i].said));
    assert_string_equal(log.error_file, ROWS[i].file);
    assert_int_equal(log.error_line, ROWS[i].line);
    assert_string_equal(log.error_text, ROWS[i].text);
  }
}

static void the_version_is_a_number(void **state) {
  (void)state;
  static const struct {
    const char *said, *version;
  } ROWS[] = {
      {"POV-Ray 3.7.0.10.unofficial\n", "3.7.0.10.unofficial"},
      {"Persistence of Vision(tm) Ray Tracer Version 3.8.0 (x)\n", "3.8.0"},
      {"POV-Ray is free\nPOV-Ray 3.7\nPOV-Ray 3.8\n", "3.7"},
      {"POV-Ray :\n", ""},
      {"Version 3.7\n", ""},
  };
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    CagPovrayLog log = {0};
    cag_povray_log_feed(&log, ROWS[i].said, strlen(ROWS[i].said));
    assert_string_equal(log.version, ROWS[i].version);
  }
}

static void long_lines_and_many_lines_are_cut(void **state) {
  (void)state;
  CagPovrayLog log = {0};
  char last[CAG_POVRAY_LAST_LINES * CAG_POVRAY_LINE_MAX];
  cag_povray_log_last(&log, last, sizeof last);
  assert_string_equal(last, "");
  for (int i = 0; i < 1000; i++) cag_povray_log_feed(&log, "x\0y", 3); // without zero bytes
  cag_povray_log_feed(&log, "\n", 1);
  cag_povray_log_last(&log, last, sizeof last);
  assert_int_equal(strlen(last), 101); // 100 bytes of a message
  assert_int_equal(strspn(last + 1, "xy"), 100);
  for (char c = 'a'; c <= 'g'; c++) cag_povray_log_feed(&log, (char[]){c, '\n'}, 2);
  cag_povray_log_last(&log, last, sizeof last);
  assert_string_equal(last, "\nc\nd\ne\nf\ng");
}

// --- Pictures ---

static void pictures_have_limits(void **state) {
  (void)state;
  static const struct {
    size_t width, height, channels;
    const char *says;
  } ROWS[] = {
      {0, 1, 1, "no samples"},
      {1, 0, 1, "no samples"},
      {1, 1, 0, "no samples"},
      {CAG_IMAGE_SIDE_MAX + 1, 1, 1, "too large"},
      {1, CAG_IMAGE_SIDE_MAX + 1, 1, "too large"},
      {1, 1, CAG_IMAGE_CHANNELS_MAX + 1, "too large"},
      {CAG_IMAGE_SIDE_MAX, CAG_IMAGE_SIDE_MAX, CAG_IMAGE_CHANNELS_MAX, "too large"},
      {CAG_IMAGE_SIDE_MAX, CAG_IMAGE_SAMPLES_MAX / CAG_IMAGE_SIDE_MAX + 1, 1, "too large"},
  };
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    CagImage image;
    CagError err = {0};
    assert_false(cag_image_create(&image, ROWS[i].width, ROWS[i].height, ROWS[i].channels, &err));
    assert_int_equal(err.status, CAG_E_LIMIT);
    assert_non_null(strstr(err.message, ROWS[i].says));
  }
}

static void colors_are_r_g_b_or_y_or_a_single_channel(void **state) {
  (void)state;
  static const struct {
    const char *names[4];
    size_t count;
    bool found;
    size_t rgb[3];
  } ROWS[] = {
      {{"R", "G", "B"}, 3, true, {0, 1, 2}}, {{"A", "B", "G", "R"}, 4, true, {3, 2, 1}},
      {{"Y"}, 1, true, {0, 0, 0}},           {{"A", "Y"}, 2, true, {1, 1, 1}},
      {{"Z"}, 1, true, {0, 0, 0}},           {{"Z", "A"}, 2, false, {0}},
      {{"R", "G", "Y"}, 3, true, {2, 2, 2}}, {{"R", "B", "Y"}, 3, true, {2, 2, 2}},
      {{"G", "B", "A", "Z"}, 4, false, {0}},
  };
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    CagImage image;
    size_t rgb[3] = {0};
    assert_true(cag_image_create(&image, 1, 1, ROWS[i].count, NULL));
    for (size_t c = 0; c < ROWS[i].count; c++) cag_image_set_name(&image, c, ROWS[i].names[c]);
    assert_true(cag_image_find_color(&image, rgb) == ROWS[i].found);
    if (ROWS[i].found) assert_memory_equal(rgb, ROWS[i].rgb, sizeof rgb);
    cag_image_free(&image);
  }
}

// --- Messages ---

// The number of bytes of the UTF-8 character with this lead byte.
static size_t character_bytes(unsigned char lead) {
  return lead < 0x80 ? 1 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
}

// A message is truncated between characters, and loses only the characters that do not fit.
static void messages_are_cut_between_characters(void **state) {
  (void)state;
  static const char *const CHARACTERS[] = {"x", "é", "€", "😀"};
  for (size_t i = 0; i < 4; i++) {
    const size_t width = strlen(CHARACTERS[i]);
    assert_int_equal(width, i + 1);
    for (size_t shift = 0; shift < 4; shift++) {
      char text[1000] = "";
      memset(text, '.', shift);
      while (strlen(text) + width < sizeof text) strcat(text, CHARACTERS[i]);
      CagError err = {0};
      assert_false(cag_fail_io(&err, CAG_E_FILE, text, "%s", text));
      const struct {
        const char *text;
        size_t size;
      } CUT[] = {{err.message, sizeof err.message}, {err.help, sizeof err.help}};
      for (size_t k = 0; k < 2; k++) {
        const size_t n = strlen(CUT[k].text);
        assert_in_range(n, CUT[k].size - width, CUT[k].size - 1);
        assert_int_equal(strncmp(CUT[k].text, text, n), 0);
        size_t at = 0;
        while (at < n) at += character_bytes((unsigned char)CUT[k].text[at]);
        assert_int_equal(at, n);
      }
    }
  }
  assert_false(cag_fail_io(NULL, CAG_E_FILE, NULL, "nobody asks"));
  CagError err;
  cag_fail_io(&err, CAG_E_FILE, NULL, "%s", "");
  assert_true(!err.message[0] && !err.help[0]);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(progress_is_read_from_what_povray_says),
      cmocka_unit_test(progress_is_not_kept_as_last_words),
      cmocka_unit_test(the_first_error_with_a_place_counts),
      cmocka_unit_test(the_version_is_a_number),
      cmocka_unit_test(long_lines_and_many_lines_are_cut),
      cmocka_unit_test(pictures_have_limits),
      cmocka_unit_test(colors_are_r_g_b_or_y_or_a_single_channel),
      cmocka_unit_test(messages_are_cut_between_characters),
  };
  return cmocka_run_group_tests_name("render", tests, NULL, NULL);
}
