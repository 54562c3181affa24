// Scripts as tests: their comments state the expected results of a run.
//
//     print 1 + 1        // expect: 2
//     print sin(30)      // expect error: E0301
//     // run: -D height=200
//     // expect: 200 mm
//
// The texts of the `expect:` comments are the lines that the script prints, in order; blanks at
// both ends are ignored. `expect error:` is on the line that fails. Expectations before the first
// `run:` belong to a run without options. Each `run:` starts another run, which has the
// expectations up to the next `run:`. A run without expectations passes if it does not fail. These
// words have a meaning only at the start of a comment, and not within a text or a block comment,
// unless it is unterminated: the missing end is then the error that the line expects.
//
// The options of a `run:` are -D name=value (values with blanks in quotes), and --max-depth,
// --max-memory (in bytes), --max-time, and --max-triangles, for tests of the limits, and --picture,
// --engine, --quality, --camera, and --samples for its picture (below). Errors without a location in the script (a -D for an unknown param, an error in an
// imported module) are matched by code only.
//
// `expect image: depth.exr` compares the image that the script shows with a file beside it, and
// `expect image left: left.exr` the image of that name (see expect_image.h). PNG files are compared
// after clipping to 0..1.
//
// Examples in the documentation of its definitions, lines of /// indented by four, are also tests.
// Each runs separately, with the names that it uses imported from the script.
//
// A picture beside the script, NAME.exr or NAME.png, is the reference picture for the run without
// options, or for the run with --picture if there is one: `run: -D time=0.5 --picture`. The scene
// is rendered at the size of the reference and compared (see CAG_TEST_DELTA_E). It is a picture of
// POV-Ray with quality "normal" unless the run says otherwise by the options of `cag render`:
// `run: --picture --engine preview --quality draft`. Without POV-Ray, its pictures are skipped.
//
// Without cag-brep, runs that need it are skipped.

#ifndef CAG_INTERP_SESSION_EXPECT_H
#define CAG_INTERP_SESSION_EXPECT_H

#include "cag.h"

// The time limit in seconds for a run or a rendering, unless --max-time is given. It is enough for
// large scenes on a busy machine.
#define CAG_TEST_SECONDS 60.0
#define CAG_TEST_PICTURE_SECONDS 900.0

// A picture matches its reference if the mean of the color difference CIEDE2000 is at most
// CAG_TEST_DELTA_E (1 is just noticeable side by side), and at most the fraction CAG_TEST_PIXELS of
// the pixels differ by more than CAG_TEST_PIXEL in a channel of linear light. This tolerates
// differences at edges between versions of the renderer and rounding of processors, and detects a
// shape that is missing, moved by a few pixels, or of another color.
#define CAG_TEST_DELTA_E 1.0
#define CAG_TEST_PIXEL 0.1
#define CAG_TEST_PIXELS 0.01

typedef enum CagTestOutcome { CAG_TEST_PASSED, CAG_TEST_FAILED, CAG_TEST_SKIPPED } CagTestOutcome;

// An unmet expectation.
typedef struct CagTestFailure {
  const char *test; // name of the run
  const char *file;
  size_t line; // 0: no line
  const char *message;
  const char *expected, *got; // lines of output; NULL: the message is complete
  const char *detail;         // further lines, such as the script's error; NULL: none
} CagTestFailure;

typedef struct CagTestOptions {
  CagSessionOptions session; // limits, module path, interrupt; the script's output is captured
  const char *const *define_names, *const *define_values; // for all runs
  size_t define_count;
  const char *filter; // runs whose name contains this text; NULL: all
  bool update;        // write the reference pictures instead of comparing with them
  bool no_pictures;   // do not render
  // How pictures are rendered where a run does not say: as in CagRenderOptions. May be NULL.
  const char *engine, *quality;
  void (*failure)(void *context, const CagTestFailure *failure);
  // Called after each run. `remark` gives details (why it was skipped, or that a picture was
  // updated) or is NULL.
  void (*ended)(void *context, const char *test, CagTestOutcome outcome, double seconds,
                const char *remark);
  void *context;
} CagTestOptions;

typedef struct CagTestCounts {
  size_t passed, failed, skipped; // runs, and pictures
} CagTestCounts;

// Sets all options to zero, except for the session's defaults.
void cag_test_options_init(CagTestOptions *options);

// Runs a script with all its runs and adds to the counts. `failure` and `ended` may be NULL.
// Returns CAG_STATUS_OK regardless of the results of tests, CAG_STATUS_FILE (after a failure) if
// the script cannot be read, CAG_STATUS_INTERRUPTED, or CAG_STATUS_LIMIT if memory ran out.
int cag_test_file(const char *path, const CagTestOptions *options, CagTestCounts *counts);

// The same for a text, without a picture.
int cag_test_text(const char *name, const char *text, size_t length, const CagTestOptions *options,
                  CagTestCounts *counts);

#endif
