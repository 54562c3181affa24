// Parts of the documentation site: scripts and Markdown as HTML, the run of examples and their
// pictures, names of pages, and the width of text in a terminal.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <fcntl.h>
#include <pty.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "interp/session/session.h"
#include "interp/session/site.h"

static char folder[64];

static int enter_folder(void **state) {
  (void)state;
  strcpy(folder, "/tmp/cag-site-XXXXXX");
  return mkdtemp(folder) ? chdir(folder) : -1;
}

static int leave_folder(void **state) {
  (void)state;
  return chdir("/") ? -1 : rmdir(folder);
}

static void put_file(const char *path, const char *text) {
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  fputs(text, f);
  fclose(f);
}

// --- A site with a few examples ---

typedef struct Site {
  CagSiteOptions options;
  CagSite site;
  char *index;
  size_t index_length;
} Site;

static void begin_site(Site *t) {
  *t = (Site){.options = {.jobs = 2}};
  cag_session_options_init(&t->options.session);
  t->site = (CagSite){.options = &t->options, .folder = "."};
  t->site.index = open_memstream(&t->index, &t->index_length);
}

static void end_site(Site *t) {
  for (size_t i = 0; i < t->site.count; i++) {
    CagSiteExample *e = &t->site.examples[i];
    char *const texts[] = {e->text, e->folder, e->function, e->output, e->picture, e->failure};
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) free(texts[k]);
  }
  free(t->site.examples);
  fclose(t->site.index);
  free(t->index);
}

// --- HTML ---

static void assert_html(const char *from, const char *got, const char *expected) {
  if (strcmp(got, expected) != 0) fail_msg("%s\ngives    %s\nexpected %s", from, got, expected);
}

static void scripts_are_marked_word_by_word(void **state) {
  (void)state;
  static const struct {
    const char *script, *html;
  } ROWS[] = {
      {"a < b", "a &lt; b"},
      {"x = 1 // a & b", "x = <span class=\"n\">1</span> <span class=\"c\">// a &amp; b</span>"},
      {"// c\ny", "<span class=\"c\">// c</span>\ny"},
      {"6 / 3", "<span class=\"n\">6</span> / <span class=\"n\">3</span>"},
      {"\"a\\\"b\" c", "<span class=\"s\">&quot;a\\&quot;b&quot;</span> c"},
      {"`a\\` c", "<span class=\"s\">`a\\`</span> c"},
      {"\"open", "<span class=\"s\">&quot;open</span>"},
      {"\"open\\", "<span class=\"s\">&quot;open\\</span>"},
      {"1_000.5mm", "<span class=\"n\">1_000.5mm</span>"},
      {"2.5e-3", "<span class=\"n\">2.5e-3</span>"},
      {"1e5 2e7", "<span class=\"n\">1e5</span> <span class=\"n\">2e7</span>"},
      {"0..1", "<span class=\"n\">0</span>..<span class=\"n\">1</span>"},
      {"if a", "<span class=\"k\">if</span> a"},
      {"sin", "<a class=\"f\" href=\"../functions/sin.html\">sin</a>"},
      {"sin(x)", "<a class=\"f\" href=\"../functions/sin.html\">sin</a>(x)"},
      {"a..sin(x)", "a..<a class=\"f\" href=\"../functions/sin.html\">sin</a>(x)"},
      {".sin(x)", ".sin(x)"},
      {"m.sin(x)", "m.sin(x)"},
      {"sin = x", "sin = x"},
      {"f(sin: x)", "f(sin: x)"},
      {"Plate_2(x)", "Plate_2(x)"},
      {"höhe", "höhe"},
      {"a_name_of_more_than_sixty_three_letters_is_no_name_of_a_function_(x)",
       "a_name_of_more_than_sixty_three_letters_is_no_name_of_a_function_(x)"},
  };
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    char *html = NULL;
    size_t n;
    FILE *out = open_memstream(&html, &n);
    cag_html_script(out, "../", ROWS[i].script, strlen(ROWS[i].script));
    fclose(out);
    assert_html(ROWS[i].script, html, ROWS[i].html);
    free(html);
  }
}

static void backquotes_in_prose_are_code(void **state) {
  (void)state;
  static const struct {
    const char *prose, *html;
  } ROWS[] = {
      {"a `b` c", "a <code>b</code> c"},
      {"a ` b", "a ` b"},
      {"a `` b", "a `` b"},
      {"a ` ` b", "a ` ` b"},
      {"`1`", "<code><span class=\"n\">1</span></code>"},
  };
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    char *html = NULL;
    size_t n;
    FILE *out = open_memstream(&html, &n);
    cag_html_prose(out, "", ROWS[i].prose, strlen(ROWS[i].prose));
    fclose(out);
    assert_html(ROWS[i].prose, html, ROWS[i].html);
    free(html);
  }
}

static void anchors_are_lower_case_words(void **state) {
  (void)state;
  static const struct {
    const char *heading, *anchor;
  } ROWS[] = {
      {"Curves and splines", "curves-and-splines"},
      {"  E0301 (type)", "e0301-type"},
      {"a - b", "a-b"},
      {"v1.2.", "v1-2"},
      {"Zoo_9", "zoo_9"},
      {"Übung", "Übung"},
      {"|>", "x"},
      {"", "x"},
  };
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    char *anchor = cag_html_anchor(ROWS[i].heading);
    assert_html(ROWS[i].heading, anchor, ROWS[i].anchor);
    free(anchor);
  }
}

static void markdown_leads_to_pages_of_the_site(void **state) {
  (void)state;
  static const struct {
    const char *about, *text, *html;
  } ROWS[] = {
      {"language", "[a](geometry.md#b)", "<p><a href=\"../guide/geometry.html#b\">a</a></p>\n"},
      {"language", "[a](cookbook/gear.cag)",
       "<p><a href=\"../cookbook/index.html#gear\">a</a></p>\n"},
      {"language", "[a](https://b.org/c.md)", "<p><a href=\"https://b.org/c.md\">a</a></p>\n"},
      {"language", "[a](#b)", "<p><a href=\"#b\">a</a></p>\n"},
      // A link without a target page becomes plain text.
      {"language", "[a `b` c](../LICENSE)", "<p>a <code>b</code> c</p>\n"},
      {"language", "[a](notes.md)", "<p>a</p>\n"},
      {"language", "[a](cookbook/README)", "<p>a</p>\n"},
      {"language", "[`sin`](geometry.md)",
       "<p><a href=\"../guide/geometry.html\"><code>sin</code></a></p>\n"},
      {"language", "`sin`",
       "<p><code><a class=\"f\" href=\"../functions/sin.html\">sin</a></code></p>\n"},
      {"language", "# A", "<h1><a class=\"anchor\" id=\"a\"></a>A</h1>\n"},
      {"language", "```sh\n1\n```", "<pre><code class=\"language-sh\">1\n</code></pre>\n"},
      {"language", "```cagx\n1\n```", "<pre><code class=\"language-cagx\">1\n</code></pre>\n"},
      {"language", "```\n1\n```", "<pre><code>1\n</code></pre>\n"},
      {"language", "```cag fragment\n1\n```",
       "<pre><code><span class=\"n\">1</span>\n</code></pre>\n"},
      {"language", "    1", "<pre><code><span class=\"n\">1</span>\n</code></pre>\n"},
      {"language", "<b>c</b>", "<p><b>c</b></p>\n"},
      {"language", "<div>\n", "<div>\n"},
      {"parts.cag", "```cag\n1\n```", "<pre><code><span class=\"n\">1</span>\n</code></pre>\n"},
      {"parts.cag", "## B", "<h2><a class=\"anchor\" id=\"b\"></a>B</h2>\n"},
      {"parts.cag", "a <b> c", "<p>a &lt;b&gt; c</p>\n"},
      {"parts.cag", "<div>\n", "<p>&lt;div&gt;\n</p>\n"},
  };
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    Site t;
    begin_site(&t);
    char *html = NULL;
    size_t n;
    FILE *out = open_memstream(&html, &n);
    cag_html_markdown(&t.site, out, "../", ROWS[i].about, ROWS[i].text, strlen(ROWS[i].text));
    fclose(out);
    assert_html(ROWS[i].text, html, ROWS[i].html);
    free(html);
    end_site(&t);
  }
}

static void headings_of_the_guide_are_found_by_the_search(void **state) {
  (void)state;
  Site t;
  begin_site(&t);
  static const char TEXT[] = "# A\n## Say \"b\\c\" & `d`\n";
  FILE *out = fopen("/dev/null", "w");
  cag_html_markdown(&t.site, out, "../", "language", TEXT, sizeof TEXT - 1);
  cag_html_markdown(&t.site, out, "../", "parts.cag", TEXT, sizeof TEXT - 1);
  fclose(out);
  fflush(t.site.index);
  assert_string_equal(t.index, "[\"Say \\\"b\\\\c\\\" & d\",\"guide\","
                               "\"guide/language.html#say-bc-d\",\"\"]");
  end_site(&t);
}

// --- Examples ---

// Shows an example, runs it, and shows it again. Returns the HTML, to be freed.
static char *shown_example(Site *t, const CagSiteSpot *at, const char *text) {
  char *html = NULL;
  size_t n;
  FILE *nowhere = fopen("/dev/null", "w");
  CagSiteSpot spot = *at;
  spot.root = "../";
  spot.out = nowhere;
  cag_html_example(&t->site, &spot, text, strlen(text));
  fclose(nowhere);
  cag_site_run(&t->site);
  t->site.final = true;
  spot.out = open_memstream(&html, &n);
  cag_html_example(&t->site, &spot, text, strlen(text));
  fclose(spot.out);
  return html;
}

static void examples_are_shown_with_what_they_print(void **state) {
  (void)state;
  static const struct {
    const char *text, *code, *output; // output may be NULL
  } ROWS[] = {
      {"print 1 + 1  // expect: 2\n\n", "print 1 + 1", "2\n"},
      {"// expect: 3\nprint 3\n", "print 3", "3\n"},
      {"print 4 // expected\n", "print 4 // expected", "4\n"},
      {"x = 5\n", "x = 5", NULL},
  };
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    Site t;
    begin_site(&t);
    t.options.no_pictures = true;
    char *html = shown_example(&t, &(CagSiteSpot){.about = "test"}, ROWS[i].text), code[256];
    size_t n = 0;
    // The code without markup.
    for (const char *at = strstr(html, "<code>") + 6; strncmp(at, "</code>", 7) != 0; at++) {
      if (*at == '<') at = strchr(at, '>');
      else code[n++] = *at;
    }
    code[n] = 0;
    assert_string_equal(code, ROWS[i].code);
    const char *output = strstr(html, "<samp>");
    assert_true(!output == !ROWS[i].output);
    if (output) assert_int_equal(strncmp(output + 6, ROWS[i].output, strlen(ROWS[i].output)), 0);
    assert_null(t.site.examples[0].failure);
    free(html);
    end_site(&t);
  }
}

static void an_example_that_does_not_do_what_it_says_is_wrong(void **state) {
  (void)state;
  static const struct {
    const char *text;
    bool wrong;
  } ROWS[] = {
      {"print 1 // expect: 1", false},
      {"print 1 //  expect: 1", false}, // an ordinary comment
      {"print 1 // expect:   1  ", false},
      {"print 1 // expect: 2", true},
      {"print 1 // expect: 11", true},
      {"print 1 // expect: 1\n// expect: 2", true},
      {"print 1 // expect:", true},
      {"print \" 1 \" // expect: 1", false},
      {"print 1, 2 // expect: 1 2\nprint 3 // expect: 3", false},
      {"/// of x, print x // expect: 7\nx = 7\nprint x + 1 // expect: 8", false},
      {"print sin(30)", true},
      {"print sin(30) // expect error: E0301", false},
      {"print 1 // expect error: E0301", true},
      {"print 1", false},
      {"x = 1 // expect: 1", true},
  };
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    Site t;
    begin_site(&t);
    t.options.no_pictures = true;
    free(shown_example(&t, &(CagSiteSpot){.about = "test"}, ROWS[i].text));
    if (!t.site.examples[0].failure != !ROWS[i].wrong) fail_msg("%s", ROWS[i].text);
    end_site(&t);
  }
}

// Without cag-brep, an example that needs it is shown without output. One that fails for another
// reason, or expects this error, is as always.
static void an_example_may_need_the_missing_kernel(void **state) {
  (void)state;
  static const struct {
    const char *text;
    bool unavailable, wrong;
  } ROWS[] = {
      {"print 1  // expect: 1\nprint exact(box(1))  // expect: x", true, false},
      {"print exact(box(1))  // expect error: E0301", true, false},
      {"print exact(box(1))  // expect error: E0756", false, false},
      {"print 1  // expect: 2\nprint sin(30)", false, true},
      {"print 1  // expect: 1", false, false},
  };
  const char *helper = getenv("CAG_BREP");
  char *former = helper ? strdup(helper) : NULL;
  setenv("CAG_BREP", "/none", 1);
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    Site t;
    begin_site(&t);
    char *html = shown_example(&t, &(CagSiteSpot){.about = "test"}, ROWS[i].text);
    const CagSiteExample *e = &t.site.examples[0];
    if (e->unavailable != ROWS[i].unavailable || !e->failure != !ROWS[i].wrong ||
        !strstr(html, "needs the package <code>cag-brep</code>") != !ROWS[i].unavailable ||
        (ROWS[i].unavailable && (strstr(html, "<samp>") || e->picture)))
      fail_msg("%s\n%s", ROWS[i].text, html);
    free(html);
    end_site(&t);
  }
  if (former) setenv("CAG_BREP", former, 1);
  else unsetenv("CAG_BREP");
  free(former);
}

static void an_example_is_run_once_in_each_folder(void **state) {
  (void)state;
  Site t;
  begin_site(&t);
  static const struct {
    const char *folder, *text;
    size_t count; // number of examples after it
  } ROWS[] = {{NULL, "a = 1", 1}, {NULL, "a = 1", 1}, {NULL, "a = 2", 2},  {"a", "a = 1", 3},
              {"b", "a = 1", 4},  {"a", "a = 1", 4},  {NULL, "a = 10", 5}, {NULL, "a = 2", 5}};
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    const CagSiteSpot spot = {.about = "test", .folder = ROWS[i].folder};
    const CagSiteExample *e = cag_site_example(&t.site, &spot, ROWS[i].text, strlen(ROWS[i].text));
    if (e) assert_string_equal(e->text, ROWS[i].text);
    assert_int_equal(t.site.count, ROWS[i].count);
  }
  t.site.final = true;
  assert_null(cag_site_example(&t.site, &(CagSiteSpot){.about = "test"}, "b", 1));
  end_site(&t);
}

static void a_picture_shows_what_the_example_is_about(void **state) {
  (void)state;
  static const struct {
    const char *function, *text, *ending; // ending: NULL if there is no picture
  } ROWS[] = {
      {NULL, "show circle(5)", "svg"},
      {NULL, "show circle(5), translate(circle(5), [0, 0, 1])", "png"},
      {NULL, "show region(circle(5))", "svg"},
      {NULL, "show box(5)", "png"},
      {NULL, "c = circle(5)\nx = 2", "svg"},
      {NULL, "x = 2", NULL},
      {NULL, "x = [2]", NULL},
      {NULL, "x = [[circle(5)]]", NULL},
      {"circle", "x = length(circle(5))", "svg"},
      {"length", "x = length(circle(5))", NULL},
      {"circle", "my_circle(r) = r\nx = my_circle(5)", NULL},
      {"circle", "x = circle\ny = circle(", NULL}, // a syntax error
      {"divide", "x = len([for c in divide(circle(5), 3): c])", NULL},
      {"circle", "f(circle) = circle\nx = 3", NULL},
      {NULL, "r = robot([revolute(a: 100, shape: box([100, 10, 10]))])", "png"},
      {NULL, "c = [circle(5), circle(6)]", "svg"},
  };
  assert_int_equal(mkdir("pictures", 0777), 0);
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    // The second time, the picture exists already.
    for (int time = 0; time < 2; time++) {
      Site t;
      begin_site(&t);
      char *html = shown_example(&t, &(CagSiteSpot){.about = "test", .function = ROWS[i].function},
                                 ROWS[i].text);
      const char *picture = t.site.examples[0].picture;
      if (!ROWS[i].ending) {
        if (picture) fail_msg("a picture of %s", ROWS[i].text);
        assert_null(strstr(html, "<img"));
      } else {
        if (!picture) fail_msg("no picture of %s", ROWS[i].text);
        assert_string_equal(strrchr(picture, '.') + 1, ROWS[i].ending);
        assert_int_equal(access(picture, R_OK), 0);
        assert_non_null(strstr(html, picture));
        if (time > 0) unlink(picture);
      }
      free(html);
      end_site(&t);
    }
  }
  assert_int_equal(rmdir("pictures"), 0);
}

static void an_example_without_place_for_its_picture_has_none(void **state) {
  (void)state;
  Site t;
  begin_site(&t);
  free(shown_example(&t, &(CagSiteSpot){.about = "test"}, "show circle(5)"));
  assert_null(t.site.examples[0].picture); // the folder `pictures` does not exist
  assert_null(t.site.examples[0].failure);
  end_site(&t);
}

// --- Scripts of the user ---

static void an_example_imports_what_it_names_of_its_script(void **state) {
  (void)state;
  static const struct {
    const char *purpose, *file, *example, *import; // import may be NULL
  } ROWS[] = {
      {"", "parts.cag", "print plate(3)", "import \"parts.cag\": plate"},
      {"", "parts.cag", "print plate(hole)", "import \"parts.cag\": plate, hole"},
      {"", "parts.cag", "print 3", NULL},
      {"", "parts.cag", "import parts: plate\nprint plate(3)", NULL},
      {"", "parts.cag", "reimport = plate(3)", "import \"parts.cag\": plate"},
      {"", "parts.cag", "print parts.plate(3)", "import \"parts.cag\" as parts"},
      {"", "parts.cag", "print spareparts.plate(3)", NULL},
      {"", "parts.cag", "print m.parts.plate(3)", NULL},
      {"", "parts.cag", "parts.plate(3)", "import \"parts.cag\" as parts"},
      {"", "parts.cag", "plate = 3\nprint plate", NULL},
      {"", "parts.cag", "plate == 3", "import \"parts.cag\": plate"},
      {"", "parts.cag", "plate => 3", "import \"parts.cag\": plate"},
      {"", "parts.cag", "print template, plates, plate2, _plate", NULL},
      {"", "parts.cag", "x = 1\nplate(x) = x\nprint plate(2)", NULL},
      {"", "2d.cag", "print 2d.plate(3)", NULL},
      {"", "my-parts.cag", "print my-parts.plate(3)", NULL},
      {"", ".cag", "print .plate(3)", NULL},
      {"Say `import shop.parts as p`.", "parts.cag", "print p.plate(3)",
       "import \"parts.cag\" as p"},
      {"Say `import shop.parts`.", "parts.cag", "print parts.plate(3)",
       "import \"parts.cag\" as parts"},
      {"Say `import shop.other as p`.", "parts.cag", "print p.plate(3)", NULL},
      {"Say `import a as parts`.", "parts.cag", "print parts.plate(3)",
       "import \"parts.cag\" as parts"},
  };
  CagDocEntry entries[] = {{.name = "plate"}, {.name = "hole"}};
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    const CagDocModule m = {.name = "parts",
                            .purpose = (char *)(size_t)ROWS[i].purpose,
                            .entries = entries,
                            .count = 2};
    char *import = cag_doc_script_import(&m, ROWS[i].file, ROWS[i].example);
    assert_html(ROWS[i].example, import ? import : "none",
                ROWS[i].import ? ROWS[i].import : "none");
    free(import);
  }
}

static void the_search_finds_every_error(void **state) {
  (void)state;
  Site t;
  begin_site(&t);
  cag_site_errors(&t.site);
  fflush(t.site.index);
  const char *code, *reason;
  size_t count = 0;
  for (; cag_error_kind(count, &code, &reason, NULL, NULL); count++) {
    char link[64];
    snprintf(link, sizeof link, "errors.html#%s", code);
    if (!strstr(t.index, link) || !strstr(t.index, reason)) fail_msg("%s is missing", code);
  }
  assert_true(count > 100);
  end_site(&t);
}

static void scripts_get_pages_of_different_names(void **state) {
  (void)state;
  static const struct {
    const char *path, *name, *page; // name: NULL for a script listed before
  } ROWS[] = {
      {"in/parts/a.cag", "parts/a.cag", "parts.a"},
      {"in/parts/a b.cag", "parts/a b.cag", "parts.a_b"},
      {"in/parts/a_b.cag", "parts/a_b.cag", "parts.a_b-2"},
      {"in/parts/a.b.cag", "parts/a.b.cag", "parts.a_b-3"},
      {"in/path/Z9", "path/Z9", "path.Z9"},
      {"in/parts/a.cag", NULL, NULL},
      {"in/index.cag", "index.cag", "index-2"},
      {"in/.cag", ".cag", "_cag"},
  };
  enum { COUNT = sizeof ROWS / sizeof *ROWS };
  const char *paths[COUNT];
  mkdir("in", 0777);
  mkdir("in/parts", 0777);
  mkdir("in/path", 0777);
  for (size_t i = 0; i < COUNT; i++) put_file(paths[i] = ROWS[i].path, "/// One.\na = 1\n");
  Site t;
  begin_site(&t);
  t.options.scripts = paths;
  t.options.script_count = COUNT;
  t.site.session = cag_session_new(&t.options.session);
  assert_true(cag_session_begin(t.site.session));
  assert_true(cag_site_read_scripts(&t.site));
  size_t k = 0;
  for (size_t i = 0; i < COUNT; i++) {
    if (!ROWS[i].name) continue;
    const CagSiteScript *s = &t.site.scripts[k++];
    assert_string_equal(s->module.name, ROWS[i].name);
    assert_string_equal(s->page, ROWS[i].page);
    assert_int_equal(s->module.count, 1);
  }
  assert_int_equal(t.site.script_count, k);
  cag_site_free_scripts(&t.site);
  assert_int_equal(cag_session_end(t.site.session, CAG_STATUS_OK), CAG_STATUS_OK);
  cag_session_free(t.site.session);
  end_site(&t);
  for (size_t i = 0; i < COUNT; i++) unlink(paths[i]);
  rmdir("in/parts");
  rmdir("in/path");
  rmdir("in");
}

static void a_script_that_cannot_be_read_makes_no_site(void **state) {
  (void)state;
  static const struct {
    const char *path;
    int status;
  } ROWS[] = {{"nowhere.cag", CAG_STATUS_FILE}, {"broken.cag", CAG_STATUS_SCRIPT}};
  put_file("broken.cag", "a = (\n");
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    CagSiteOptions options = {.no_pictures = true, .scripts = &ROWS[i].path, .script_count = 1};
    cag_session_options_init(&options.session);
    CagSession *s = cag_session_new(&options.session);
    assert_int_equal(cag_session_write_site(s, "site", &options), ROWS[i].status);
    cag_session_free(s);
    assert_int_equal(access("site", F_OK), -1);
  }
  unlink("broken.cag");
}

// --- Files ---

static void after_a_file_that_fails_none_is_written(void **state) {
  (void)state;
  Site t;
  begin_site(&t);
  cag_site_write(&t.site, "a", "1", 1); // the first time
  assert_int_equal(access("a", F_OK), -1);
  t.site.final = true;
  cag_site_write(&t.site, "a", "1", 1);
  assert_int_equal(access("a", F_OK), 0);
  cag_site_write(&t.site, "none/b", "1", 1);
  assert_true(t.site.failed);
  assert_non_null(strstr(t.site.error.message, "none/b"));
  cag_site_write(&t.site, "c", "1", 1);
  assert_int_equal(access("c", F_OK), -1);
  unlink("a");
  end_site(&t);
}

static void an_interrupt_leaves_folders_but_no_pages(void **state) {
  (void)state;
  int stop = 1;
  CagSiteOptions options = {.jobs = 1};
  cag_session_options_init(&options.session);
  options.session.interrupt = &stop;
  CagSession *s = cag_session_new(&options.session);
  assert_int_equal(cag_session_write_site(s, "site", &options), CAG_STATUS_INTERRUPTED);
  cag_session_free(s);
  static const char *const FOLDERS[] = {"site/functions", "site/library",  "site/guide",
                                        "site/cookbook",  "site/pictures", "site"};
  for (size_t i = 0; i < sizeof FOLDERS / sizeof *FOLDERS; i++)
    assert_int_equal(rmdir(FOLDERS[i]), 0); // it is empty
}

// --- Text for a terminal ---

static void text_fits_the_terminal(void **state) {
  (void)state;
  static const struct {
    unsigned short columns;
    size_t longest; // limit for a line of prose
  } ROWS[] = {{20, 40}, {60, 60}, {200, 92}, {0, 92}};
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    int master, slave;
    struct winsize size = {.ws_row = 24, .ws_col = ROWS[i].columns};
    assert_int_equal(openpty(&master, &slave, NULL, NULL, &size), 0);
    FILE *out = fdopen(slave, "w");
    char text[1000], shown[4096];
    for (size_t k = 0; k < 249; k++) memcpy(text + 4 * k, "abc ", 4);
    cag_doc_write_wrapped(out, text, 996, 2);
    fclose(out);
    size_t n = 0;
    for (ssize_t more; (more = read(master, shown + n, sizeof shown - 1 - n)) > 0;)
      n += (size_t)more;
    shown[n] = 0;
    assert_true(n > 996);
    size_t longest = 0;
    for (char *line = strtok(shown, "\r\n"); line; line = strtok(NULL, "\r\n"))
      if (strlen(line) > longest) longest = strlen(line);
    // With words of three letters, at most three columns stay free.
    assert_in_range(longest, ROWS[i].longest - 3, ROWS[i].longest);
    close(master);
  }
}

static void a_styled_page_is_the_plain_one_with_bold_heads(void **state) {
  (void)state;
  static const char SCRIPT[] =
      "/// How wide.\nparam width = 3 in 1..4 \"mm\"\nparam plain = 2\n"
      "/// A plate.\n///\n/// - `size`: number: how far\nplate(size) = size\n"
      "three = 3\n";
  CagSessionOptions options;
  cag_session_options_init(&options);
  CagSession *s = cag_session_new(&options);
  static const char *const NAMES[] = {
      "sphere", "std.materials", "robots.puma560", "if", "gear", "box", NULL, "translate"};
  for (size_t i = 0; i <= sizeof NAMES / sizeof *NAMES; i++) {
    char *text[2] = {NULL, NULL};
    size_t n;
    for (int styled = 0; styled < 2; styled++) {
      FILE *out = open_memstream(&text[styled], &n);
      if (i == sizeof NAMES / sizeof *NAMES)
        cag_session_document_text(s, "a.cag", SCRIPT, sizeof SCRIPT - 1, styled, out);
      else assert_true(cag_session_document(s, NAMES[i], styled, out));
      fclose(out);
    }
    assert_null(strchr(text[0], '\033'));
    assert_non_null(strstr(text[1], "\033[1m"));
    // Without escape codes, both are the same.
    char *to = text[1];
    for (const char *at = text[1]; *at;) {
      const size_t code = strncmp(at, "\033[1m", 4) == 0 || strncmp(at, "\033[0m", 4) == 0 ? 4 : 0;
      if (!code) *to++ = *at++;
      at += code;
    }
    *to = 0;
    assert_string_equal(text[0], text[1]);
    free(text[0]);
    free(text[1]);
  }
  cag_session_free(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(scripts_are_marked_word_by_word),
      cmocka_unit_test(backquotes_in_prose_are_code),
      cmocka_unit_test(anchors_are_lower_case_words),
      cmocka_unit_test(markdown_leads_to_pages_of_the_site),
      cmocka_unit_test(headings_of_the_guide_are_found_by_the_search),
      cmocka_unit_test(examples_are_shown_with_what_they_print),
      cmocka_unit_test(an_example_that_does_not_do_what_it_says_is_wrong),
      cmocka_unit_test(an_example_may_need_the_missing_kernel),
      cmocka_unit_test(an_example_is_run_once_in_each_folder),
      cmocka_unit_test(a_picture_shows_what_the_example_is_about),
      cmocka_unit_test(an_example_without_place_for_its_picture_has_none),
      cmocka_unit_test(an_example_imports_what_it_names_of_its_script),
      cmocka_unit_test(the_search_finds_every_error),
      cmocka_unit_test(scripts_get_pages_of_different_names),
      cmocka_unit_test(a_script_that_cannot_be_read_makes_no_site),
      cmocka_unit_test(after_a_file_that_fails_none_is_written),
      cmocka_unit_test(an_interrupt_leaves_folders_but_no_pages),
      cmocka_unit_test(text_fits_the_terminal),
      cmocka_unit_test(a_styled_page_is_the_plain_one_with_bold_heads),
  };
  return cmocka_run_group_tests_name("site", tests, enter_folder, leave_folder);
}
