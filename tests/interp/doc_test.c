// The documentation is complete: checked for all rows of the built-ins and all public definitions
// of the library.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "interp/doc/doc.h"
#include "interp/session/expect.h"
#include "interp/session/site.h"

static CagSession *open_session(void) {
  CagSessionOptions options;
  cag_session_options_init(&options);
  CagSession *s = cag_session_new(&options);
  assert_non_null(s);
  return s;
}

static void every_parameter_of_a_built_in_is_told(void **state) {
  (void)state;
  size_t bad = 0, parameters = 0;
  for (size_t i = 0; i < cag_builtin_count(); i++) {
    size_t rows;
    cag_builtin_rows(i, &rows);
    for (size_t r = 0; r < rows; r++) {
      const CagSignature *s = cag_builtin_signature(i, r);
      for (size_t k = 0; s && k < s->count; k++) {
        parameters++;
        if (*s->words[k] && *cag_doc_meaning(s->name, s->parameters[k])) continue;
        print_error("%s: nothing tells of the parameter %s\n", s->name, s->parameters[k]);
        bad++;
      }
    }
  }
  assert_true(parameters > 1000);
  assert_int_equal(bad, 0);
}

static void every_built_in_has_result_summary_example_and_family(void **state) {
  (void)state;
  size_t bad = 0;
  for (size_t i = 0; i < cag_builtin_count(); i++) {
    size_t rows;
    const CagBuiltin *b = cag_builtin_rows(i, &rows);
    for (size_t r = 0; r < rows; r++) {
      const char *const parts[] = {b[r].result, b[r].summary, b[r].example, b[r].family};
      for (size_t k = 0; k < 4; k++) {
        if (parts[k] && *parts[k]) continue;
        print_error("%s: part %zu of its documentation is missing\n", b[r].signature, k);
        bad++;
      }
    }
  }
  assert_int_equal(bad, 0);
}

static void every_public_definition_of_the_library_is_told(void **state) {
  (void)state;
  CagSession *s = open_session();
  size_t bad = 0, definitions = 0;
  for (size_t i = 0; cag_doc_module_name(i); i++) {
    const char *text;
    size_t length;
    CagDocModule m;
    const char *name = cag_doc_library(cag_doc_module_name(i), &text, &length);
    assert_int_equal(cag_session_read_doc(s, name, text, length, &m), CAG_STATUS_OK);
    for (size_t k = 0; k < m.count; k++) {
      const CagDocEntry *e = &m.entries[k];
      definitions++;
      bool whole = e->text && *e->text;
      if (!whole) print_error("%s.%s has no documentation\n", m.name, e->name);
      for (size_t n = 0; n < e->argument_count; n++)
        if (!cag_doc_module_parameter(m.name, e->name, e->arguments[n].name)) {
          print_error("%s.%s: nothing tells of %s\n", m.name, e->name, e->arguments[n].name);
          whole = false;
        }
      bad += !whole;
    }
    cag_doc_module_free(&m);
  }
  cag_session_free(s);
  assert_true(definitions > 50);
  assert_int_equal(bad, 0);
}

static bool is_module(const char *word) {
  const char *text;
  size_t length;
  return cag_doc_library(word, &text, &length) != NULL;
}

// Every row of the parameter table is used by a function.
static void no_row_of_parameters_is_left_over(void **state) {
  (void)state;
  static const CagDocParameter rows[] = {
#define CAG_PARAMETER(functions, name, meaning) {functions, name, "", meaning},
#include "interp/doc/parameters.def"
#undef CAG_PARAMETER
#define CAG_LIBRARY_PARAMETER(functions, name, type, meaning) {functions, name, type, meaning},
#include "interp/doc/library_parameters.def"
#undef CAG_LIBRARY_PARAMETER
  };
  size_t bad = 0;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    char *words = strdup(rows[i].functions), *rest = NULL;
    for (char *word = strtok_r(words, " ", &rest); word; word = strtok_r(NULL, " ", &rest)) {
      const size_t index = cag_builtin_find(word);
      bool found = false;
      size_t count = 0;
      if (index != (size_t)-1) cag_builtin_rows(index, &count);
      for (size_t r = 0; r < count && !found; r++) {
        const CagSignature *s = cag_builtin_signature(index, r);
        for (size_t k = 0; s && k < s->count; k++)
          found |= strcmp(s->parameters[k], rows[i].name) == 0;
      }
      if (index == (size_t)-1) found = strchr(word, '.') || is_module(word);
      if (!found) print_error("no %s takes %s\n", word, rows[i].name);
      bad += !found;
    }
    free(words);
  }
  assert_int_equal(bad, 0);
}

static void a_script_s_params_have_default_range_and_words(void **state) {
  (void)state;
  static const char SCRIPT[] = "// Two lines\n// of purpose.\n\n"
                               "/// How high.\nparam height = 3 * 40 in 50..300 \"mm\"\n"
                               "/// Flat.\nflat(c,\n  amount = 2) = c\n"
                               "plain = x => x\n_hidden = 1\n";
  CagSession *s = open_session();
  CagDocModule m;
  assert_int_equal(cag_session_read_doc(s, "a.cag", SCRIPT, sizeof SCRIPT - 1, &m), CAG_STATUS_OK);
  assert_string_equal(m.purpose, "Two lines\nof purpose.\n");
  assert_int_equal(m.count, 3);
  assert_int_equal(m.entries[0].kind, CAG_DOC_PARAM);
  assert_string_equal(m.entries[0].fallback, "3 * 40");
  assert_string_equal(m.entries[0].range, "50..300");
  assert_string_equal(m.entries[0].label, "mm");
  assert_string_equal(m.entries[0].text, "How high.");
  assert_int_equal(m.entries[1].kind, CAG_DOC_FUNCTION);
  assert_string_equal(m.entries[1].signature, "flat(c, amount = 2)");
  assert_string_equal(m.entries[1].arguments[1].fallback, "2");
  assert_int_equal(m.entries[2].kind, CAG_DOC_VALUE);
  assert_null(m.entries[2].text);
  cag_doc_module_free(&m);
  cag_session_free(s);
}

static void a_line_of_documentation_may_be_long(void **state) {
  (void)state;
  enum { LENGTH = 100000 };
  static char script[LENGTH + 32] = "/// ";
  memset(script + 4, 'x', LENGTH);
  strcpy(script + 4 + LENGTH, "\na = 1\n");
  CagSession *s = open_session();
  CagDocModule m;
  assert_int_equal(cag_session_read_doc(s, "a.cag", script, strlen(script), &m), CAG_STATUS_OK);
  assert_int_equal(strlen(m.entries[0].text), LENGTH);
  cag_doc_module_free(&m);
  cag_session_free(s);
}

static void a_sentence_ends_at_its_point(void **state) {
  (void)state;
  assert_int_equal(cag_doc_sentence("One. Two."), 4);
  assert_int_equal(cag_doc_sentence("Over 0..1. Two"), 10);
  assert_int_equal(cag_doc_sentence("By 1, 2 ... and so on"), 21);
  assert_int_equal(cag_doc_sentence(""), 0);
}

static void of_several_words_the_first_is_the_default(void **state) {
  (void)state;
  assert_int_equal(cag_doc_default("\"left\"|\"right\""), 6);
  assert_int_equal(cag_doc_default("0..1"), 4);
}

// ---- Words of the language, and topics ----

static bool is_documented(CagSession *s, const char *name) {
  FILE *out = fopen("/dev/null", "w");
  assert_non_null(out);
  const bool found = cag_session_document(s, name, false, out);
  fclose(out);
  return found;
}

static void every_word_of_the_language_is_told(void **state) {
  (void)state;
  static const char *const words[] = {
      "and",    "as",  "assert", "by",    "else",  "false", "for",  "if",   "import", "in",
      "none",   "not", "or",     "param", "print", "show",  "then", "true", "time",   "frame",
      "frames", "|>",  "=>",     "==",    "!=",    "<",     "<=",   ">",    ">=",     "+",
      "-",      "*",   "/",      "%",     "^",     "|",     "&",    "..",   "..<",    "...",
      "=",      "{}",  "[]",     "//",    "///",   "gear",  "hull", "text", "film",   "light"};
  CagSession *s = open_session();
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    if (!is_documented(s, words[i])) fail_msg("nothing tells of %s", words[i]);
  cag_session_free(s);
}

// The first line belongs to the built-in. Further signatures are preceded by an empty line, and
// there are never two empty lines in a row.
static void rows_of_a_built_in_are_set_apart(void **state) {
  (void)state;
  CagSession *s = open_session();
  for (const char *const *name = cag_builtin_name_list(); *name; name++) {
    const size_t n = strlen(*name);
    int rows = 0, told = 1;
    const char *signature;
    for (size_t i = 0; cag_builtin_row(i, &signature, NULL, NULL, NULL); i++)
      rows += strncmp(signature, *name, n) == 0 && (signature[n] == '(' || !signature[n]);
    char *text;
    size_t length;
    FILE *out = open_memstream(&text, &length);
    assert_non_null(out);
    assert_true(cag_session_document(s, *name, false, out));
    fclose(out);
    assert_int_equal(strncmp(text, *name, n), 0);
    for (const char *gap = text; (gap = strstr(gap, "\n\n")); gap += 2)
      told += strncmp(gap + 2, *name, n) == 0 && (gap[2 + n] == '(' || gap[2 + n] == ' ');
    if (told != rows || strstr(text, "\n\n\n"))
      fail_msg("%s: %d of %d rows in\n%s", *name, told, rows, text);
    free(text);
  }
  cag_session_free(s);
}

static void topics_refer_to_what_is_told(void **state) {
  (void)state;
  CagSession *s = open_session();
  const char *word, *see;
  for (size_t i = 0; cag_doc_word_row(i, &word, &see, NULL); i++) {
    char *names = see ? strdup(see) : NULL, *rest = NULL;
    for (char *n = names ? strtok_r(names, " ", &rest) : NULL; n; n = strtok_r(NULL, " ", &rest))
      if (!is_documented(s, n)) fail_msg("%s refers to %s, of which nothing tells", word, n);
    free(names);
  }
  cag_session_free(s);
}

static void report_failure(void *context, const CagTestFailure *f) {
  (void)context;
  print_error("%s: %s; expected %s, got %s\n", f->test, f->message, f->expected ? f->expected : "",
              f->got ? f->got : "");
}

static void examples_of_words_run(void **state) {
  (void)state;
  CagTestOptions options;
  CagTestCounts counts = {0};
  const char *word, *example;
  cag_test_options_init(&options);
  options.failure = report_failure;
  for (size_t i = 0; cag_doc_word_row(i, &word, NULL, &example); i++) {
    assert_true(strstr(example, "print ") || strstr(example, "show ") ||
                strstr(example, "assert "));
    assert_int_equal(cag_test_text(word, example, strlen(example), &options, &counts), 0);
  }
  assert_int_equal(counts.failed, 0);
  assert_true(counts.passed > 50);
}

// Entries as "kind signature [default|range|label] (argument=default: meaning) {text} lines".
static void describe_module(const CagDocModule *m, char *out, size_t size) {
  static const char *const kinds[] = {"value", "function", "param"};
  size_t n = (size_t)snprintf(out, size, "<%s>\n", m->purpose);
#define SAY(...) n += (size_t)snprintf(out + n, size - n, __VA_ARGS__)
  for (size_t i = 0; i < m->count; i++) {
    const CagDocEntry *e = &m->entries[i];
    SAY("%s %s", kinds[e->kind], e->signature);
    if (e->kind == CAG_DOC_PARAM)
      SAY(" [%s|%s|%s]", e->fallback, e->range ? e->range : "", e->label ? e->label : "");
    for (size_t k = 0; k < e->argument_count; k++) {
      const CagDocArgument *a = &e->arguments[k];
      SAY(" (%s=%s: %s)", a->name, a->fallback ? a->fallback : "", a->meaning ? a->meaning : "");
    }
    if (e->text) {
      SAY(" {%s}", e->text);
      const char *at = e->text;
      for (size_t k = 0; *at; k++) {
        SAY(" %zu", e->lines[k]);
        at += strcspn(at, "\n");
        at += *at == '\n';
      }
    }
    SAY("\n");
  }
#undef SAY
}

static void definitions_are_told_with_their_parameters_and_lines(void **state) {
  (void)state;
  static const struct {
    const char *script, *told;
  } rows[] = {
      {"", "<>\n"},
      {"a = 1", "<>\nvalue a\n"},
      {"// One.\n//Two.\n//\n//  Three.\n\n// no\na = 1", "<One.\nTwo.\n\n Three.\n>\nvalue a\n"},
      {"// One.\n/// of a\na = 1", "<One.\n>\nvalue a {of a} 2\n"},
      {"/// of a\n/// more\na = 1\nb = 2\n/// of c\n\nc = 3",
       "<>\nvalue a {of a\nmore} 1 2\nvalue b\nvalue c {of c} 5\n"},
      {"f(x) = x\ng (x,\n   y =  [1,\n  2]) = {\n  x\n}",
       "<>\nfunction f(x) (x=: )\nfunction g (x, y =  [1, 2]) (x=: ) (y=[1, 2]: )\n"},
      {"f(a, width = 2, w = 3) = a\n",
       "<>\nfunction f(a, width = 2, w = 3) (a=: ) (width=2: ) (w=3: )\n"},
      {"/// Makes.\n/// - `a`: number: how many\n/// - `width`: number, mm:  wide\n///   as it is\n"
       "///   said\n/// - `w`: x\n/// The end.\nf(a, width = 2, w = 3) = a\n",
       "<>\nfunction f(a, width = 2, w = 3) (a=: number: how many) (width=2: number, mm:  wide as "
       "it "
       "is said) (w=3: x) {Makes.\nThe end.} 1 7\n"},
      // An item is repeated, one does not name a parameter, and one has no text: these stay in the
      // text.
      {"/// - `a`: first\n/// - `a`: second\n/// - `b`: third\n/// - `a`\n/// - a: fourth\nf(a) = "
       "a\n",
       "<>\nfunction f(a) (a=: first) {- `a`: second\n- `b`: third\n- `a`\n- a: fourth} 2 3 4 5\n"},
      // A blank line between items and text is kept once.
      {"/// Text.\n///\n/// - `a`: first\n///\n/// More.\n///\n/// End.\nf(a) = a\n",
       "<>\nfunction f(a) (a=: first) {Text.\n\nMore.\n\nEnd.} 1 2 5 6 7\n"},
      {"/// - `a`: first\n///\n/// More.\nf(a) = a\n", "<>\nfunction f(a) (a=: first) {More.} 3\n"},
      {"/// - `a`: first\n///\n///   no more\nf(a) = a\n",
       "<>\nfunction f(a) (a=: first) {  no more} 3\n"},
      {"/// A.\nparam h = 2 *\n  3 in 1..\n  9 \"how\\n high\" // c\nparam k = \"x\"",
       "<>\nparam param h = 2 * 3 in 1.. 9 \"how\\n high\" [2 * 3|1.. 9|how\n high] {A.} 1\n"
       "param param k = \"x\" [\"x\"||]\n"},
      {"_a = 1\nb = x => x\nc(x) = {\n  d = x\n  d\n}", "<>\nvalue b\nfunction c(x) (x=: )\n"},
  };
  size_t bad = 0;
  CagSession *s = open_session();
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    CagDocModule m;
    char told[2000];
    assert_int_equal(cag_session_read_doc(s, "a.cag", rows[i].script, strlen(rows[i].script), &m),
                     CAG_STATUS_OK);
    describe_module(&m, told, sizeof told);
    if (strcmp(told, rows[i].told) != 0) {
      print_error("%s\n  gives %s  not %s", rows[i].script, told, rows[i].told);
      bad++;
    }
    cag_doc_module_free(&m);
  }
  cag_session_free(s);
  assert_int_equal(bad, 0);
}

static void texts_are_cut_into_prose_and_scripts(void **state) {
  (void)state;
  static const struct {
    const char *text, *parts; // prose in < >, scripts in [ ]
  } rows[] = {
      {"", ""},
      {"a", "<a\n>"},
      {"a\nb\n", "<a\nb\n>"},
      {"    x\n", "[x\n]"},
      {"    x\n      y\n", "[x\n  y\n]"},
      {"a\n    x\nb", "<a\n>[x\n]<b\n>"},
      {"a\n\n    x\n\n    y\n\nb\n", "<a\n\n>[x\n\ny\n]<\nb\n>"},
      {"    x\n\n\n    y\n", "[x\n]<\n\n>[y\n]"},
      {"   x\n    \n", "<   x\n>[\n]"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    char parts[200] = "";
    bool is_code;
    size_t n;
    for (const char *at = rows[i].text; (n = cag_doc_part(at, &is_code)) > 0; at += n) {
      char *part = cag_doc_part_text(at, n, is_code);
      sprintf(parts + strlen(parts), is_code ? "[%s]" : "<%s>", part);
      free(part);
    }
    assert_string_equal(parts, rows[i].parts);
  }
}

static void add_reason(void *context, CagErrorId id) {
  strcat(context, cag_error_info(id)->reason);
  strcat(context, " ");
}

static void summaries_have_a_first_sentence_and_reasons(void **state) {
  (void)state;
  static const struct {
    const char *text, *first;
  } sentences[] = {
      {"", ""},
      {"One", "One"},
      {"One.", "One."},
      {"One. Two.", "One."},
      {"One.\nTwo.", "One."},
      {"One e.g. two. Three.", "One e.g. two."},
      {"From 1 .. n ... and so on. End.", "From 1 .. n ... and so on."},
      {"All ... And so on. End.", "All ... And so on."},
      {"1.5 mm. Z.", "1.5 mm."},
      {"1.5 mm. A.", "1.5 mm."},
      {"a. 9 b. [c. @d. End.", "a. 9 b. [c. @d."},
      {". A", ". A"},
  };
  for (size_t i = 0; i < sizeof sentences / sizeof *sentences; i++) {
    const size_t n = cag_doc_sentence(sentences[i].text);
    assert_int_equal(n, strlen(sentences[i].first));
    assert_memory_equal(sentences[i].text, sentences[i].first, n);
  }
  static const struct {
    const char *text, *reasons;
  } rows[] = {
      {"a (unknown-name) b", "unknown-name "},
      {"(unknown-name) (index)", "unknown-name index "},
      {"(unknown-name, index) (Index) () (no-such-reason) (index", ""},
      {"((index))", "index "},
      {"index)", ""},
      // Words of 63 to 65 letters, longer than any reason.
      {"(abcdefghijklmnopqrstuvwxyzabcdefghijklmnopqrstuvwxyzabcdefghijk) (index)", "index "},
      {"(abcdefghijklmnopqrstuvwxyzabcdefghijklmnopqrstuvwxyzabcdefghijkl) (index)", "index "},
      {"(abcdefghijklmnopqrstuvwxyzabcdefghijklmnopqrstuvwxyzabcdefghijklm) (index)", "index "},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    char reasons[200] = "";
    cag_doc_reasons(rows[i].text, add_reason, reasons);
    assert_string_equal(reasons, rows[i].reasons);
  }
  assert_int_equal(cag_doc_default("\"left\"|\"right\""), 6);
  assert_int_equal(cag_doc_default("12"), 2);
  assert_int_equal(cag_doc_default("\"left\""), 6);
}

// The prefix of an example that makes the names of its script available.
static void examples_import_what_they_name(void **state) {
  (void)state;
  static const struct {
    const char *purpose, *file, *example, *import;
  } rows[] = {
      {"", "flange.cag", "print plate(1)\n", "import \"flange.cag\": plate"},
      {"", "flange.cag", "print plate(1) + hole\n", "import \"flange.cag\": hole, plate"},
      {"", "flange.cag", "print plates, x.plate, a_plate, plate2, \xc3\xa9plate\n", NULL},
      {"", "flange.cag", "plate\n", "import \"flange.cag\": plate"},
      {"", "flange.cag",
       "aplate zplate Aplate Zplate 0plate 9plate _plate platea platez plateA plateZ plate0 plate9 "
       "plate_\n",
       NULL},
      {"", "flange.cag", "[plate]\n", "import \"flange.cag\": plate"},
      {"", "flange.cag", "{plate}/@plate`\n", "import \"flange.cag\": plate"},
      {"", "flange.cag", "plate = 3\nprint plate, hole\n", "import \"flange.cag\": hole"},
      {"", "flange.cag", "plate(x) = 3\nprint plate(1)\n", NULL},
      {"", "flange.cag", "f = plate => 1\nprint plate == 2\n", "import \"flange.cag\": plate"},
      {"", "flange.cag", "plate == 2\n", "import \"flange.cag\": plate"},
      {"", "flange.cag", "import std.robots\nprint plate\n", NULL},
      {"", "flange.cag", "print flange.plate\n", "import \"flange.cag\" as flange"},
      {"", "flange.cag", "print flange.plate, hole\n", "import \"flange.cag\" as flange: hole"},
      {"", "flange.cag", "print x.flange.plate, my_flange.plate, flange\n", NULL},
      {"", "2flange.cag", "print 2flange.plate\n", NULL},
      {"", "my-flange.cag", "print my-flange.plate\n", NULL},
      {"import parts.flange as f\n", "flange.cag", "print f.plate\n", "import \"flange.cag\" as f"},
      {"x import y\nimport parts.flange as fl_1\n", "flange.cag", "print fl_1.plate\n",
       "import \"flange.cag\" as fl_1"},
      {"import parts.other as f\n", "flange.cag", "print f.plate\n", NULL},
      {"", "flange.cag", "print 1\n", NULL},
  };
  CagDocEntry entries[] = {{.name = (char[]){"hole"}}, {.name = (char[]){"plate"}}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    char purpose[100];
    snprintf(purpose, sizeof purpose, "%s", rows[i].purpose);
    const CagDocModule m = {.purpose = purpose, .entries = entries, .count = 2};
    char *import = cag_doc_script_import(&m, rows[i].file, rows[i].example);
    if (!import != !rows[i].import || (import && strcmp(import, rows[i].import) != 0))
      fail_msg("%s%s", rows[i].example, import ? import : "no import");
    free(import);
  }
}

// --- HTML ---

typedef void HtmlWriter(FILE *out, const char *root, const char *text, size_t length);

static void expect_html(HtmlWriter *write, const char *text, const char *expected) {
  char *html = NULL;
  size_t size;
  FILE *out = open_memstream(&html, &size);
  write(out, "../", text, strlen(text));
  fclose(out);
  assert_string_equal(html, expected);
  free(html);
}

static void scripts_are_colored_and_linked(void **state) {
  (void)state;
#define LINK(name) "<a class=\"f\" href=\"../functions/" name ".html\">" name "</a>"
#define SPAN(kind, text) "<span class=\"" kind "\">" text "</span>"
  static const struct {
    const char *text, *html;
  } rows[] = {
      {"", ""},
      {"a < b & c > \"d\"", "a &lt; b &amp; c &gt; " SPAN("s", "&quot;d&quot;")},
      {"x // y < z\nw", "x " SPAN("c", "// y &lt; z") "\nw"},
      {"x / y", "x / y"},
      {"//", SPAN("c", "//")},
      {"/", "/"},
      {"\"a\\\"b\" c", SPAN("s", "&quot;a\\&quot;b&quot;") " c"},
      {"\"a\\\\\" c", SPAN("s", "&quot;a\\\\&quot;") " c"},
      {"`a\\` c", SPAN("s", "`a\\`") " c"},
      {"\"open", SPAN("s", "&quot;open")},
      {"\"open\\", SPAN("s", "&quot;open\\")},
      {"12 1_000 1.5 1.5mm 2e3 2e-3deg",
       SPAN("n", "12") " " SPAN("n", "1_000") " " SPAN("n", "1.5") " " SPAN("n", "1.5mm") " " SPAN(
           "n", "2e3") " " SPAN("n", "2e-3deg")},
      {"12e+x 1e x", SPAN("n", "12e") "+x " SPAN("n", "1e") " x"},
      {"0..5", SPAN("n", "0") ".." SPAN("n", "5")},
      {"5.", SPAN("n", "5") "."},
      {"if x", SPAN("k", "if") " x"},
      {"sphere", LINK("sphere")},
      {"sphere(2)", LINK("sphere") "(" SPAN("n", "2") ")"},
      {" sphere", " sphere"},
      {"sphere: (1)", "sphere: (" SPAN("n", "1") ")"},
      {"x.sphere(1)", "x.sphere(" SPAN("n", "1") ")"},
      {"...sphere(1)", "..." LINK("sphere") "(" SPAN("n", "1") ")"},
      {"spheres(1) sphere2(1) _sphere(1) \xc3\xa9(1)",
       "spheres(" SPAN("n", "1") ") sphere2(" SPAN("n", "1") ") _sphere(" SPAN(
           "n", "1") ") \xc3\xa9(" SPAN("n", "1") ")"},
      {"aA_zZ09(1)", "aA_zZ09(" SPAN("n", "1") ")"},
      {"a2345678901234567890123456789012345678901234567890123456789012345678(1)",
       "a2345678901234567890123456789012345678901234567890123456789012345678(" SPAN("n", "1") ")"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    expect_html(cag_html_script, rows[i].text, rows[i].html);
  static const struct {
    const char *text, *html;
  } prose[] = {
      {"a `sphere` < b", "a <code>" LINK("sphere") "</code> &lt; b"},
      {"sphere(1)", "sphere(1)"},
      {"`` ` ` `", "`` ` ` `"},
      {"`x", "`x"},
      {"`a``b`", "<code>a</code><code>b</code>"},
      {"a `b`.", "a <code>b</code>."},
  };
  for (size_t i = 0; i < sizeof prose / sizeof *prose; i++)
    expect_html(cag_html_prose, prose[i].text, prose[i].html);
  static const struct {
    const char *heading, *anchor;
  } anchors[] = {{"Lists", "lists"},
                 {"The REPL", "the-repl"},
                 {"  A  b ", "a-b"},
                 {"a - b", "a-b"},
                 {"1.2 Az", "1-2-az"},
                 {"what? no!", "what-no"},
                 {"--x--", "x"},
                 {"?", "x"},
                 {"", "x"},
                 {"Zz_9", "zz_9"},
                 {"a/b", "ab"},
                 {"[", "x"}};
  for (size_t i = 0; i < sizeof anchors / sizeof *anchors; i++) {
    char *anchor = cag_html_anchor(anchors[i].heading);
    assert_string_equal(anchor, anchors[i].anchor);
    free(anchor);
  }
#undef LINK
#undef SPAN
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(definitions_are_told_with_their_parameters_and_lines),
      cmocka_unit_test(texts_are_cut_into_prose_and_scripts),
      cmocka_unit_test(summaries_have_a_first_sentence_and_reasons),
      cmocka_unit_test(examples_import_what_they_name),
      cmocka_unit_test(scripts_are_colored_and_linked),
      cmocka_unit_test(every_parameter_of_a_built_in_is_told),
      cmocka_unit_test(every_word_of_the_language_is_told),
      cmocka_unit_test(rows_of_a_built_in_are_set_apart),
      cmocka_unit_test(topics_refer_to_what_is_told),
      cmocka_unit_test(examples_of_words_run),
      cmocka_unit_test(every_built_in_has_result_summary_example_and_family),
      cmocka_unit_test(every_public_definition_of_the_library_is_told),
      cmocka_unit_test(no_row_of_parameters_is_left_over),
      cmocka_unit_test(a_script_s_params_have_default_range_and_words),
      cmocka_unit_test(a_line_of_documentation_may_be_long),
      cmocka_unit_test(a_sentence_ends_at_its_point),
      cmocka_unit_test(of_several_words_the_first_is_the_default),
  };
  return cmocka_run_group_tests_name("documentation", tests, NULL, NULL);
}
