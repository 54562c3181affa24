// Scripts as tests: what their comments expect, against what a run gives.
//
//     print 1 + 1        // expect: 2
//     print sin(30)      // expect error: E0301
//     // run: -D height=200
//     // expect: 200 mm
//
// The texts of the `expect:` comments are the lines that the script prints, in order; spaces at
// both ends do not count. `expect error:` stands on the line that fails. What stands before the
// first `run:` belongs to a plain run; each `run:` begins a run of its own, which has the
// expectations that follow it up to the next `run:`. A run without expectations passes when
// nothing fails. A comment begins with these words or is an ordinary one; within a text or a block
// comment they mean nothing, unless that has no end: then the missing end is the error that the
// line expects.
//
// A `run:` takes -D name=value (values with spaces in quotes), and --max-depth, --max-memory (in
// bytes), --max-time and --max-triangles, for tests of the limits, and --picture (below). Errors
// that have no place in the script (a -D that it has no param for, an error within an imported
// module) are matched by their code alone.
//
// The examples in the documentation of its definitions, lines of /// indented by four, are tests as
// well: each runs by itself, with what it names of the script imported.
//
// A picture beside the script, NAME.exr or NAME.png, is the reference of what the plain run shows,
// or of what the run with --picture shows, where there is one: `run: -D time=0.5 --picture`.
// It is rendered at the reference's size in the quality "normal", and compared: see
// CAG_TEST_DELTA_E. Without POV-Ray pictures are skipped.

#ifndef CAG_INTERP_SESSION_EXPECT_H
#define CAG_INTERP_SESSION_EXPECT_H

#include "cag.h"

// The seconds that a run, or a rendering, may take, unless --max-time says otherwise: enough for
// large scenes on a busy machine, and an end for what never ends.
#define CAG_TEST_SECONDS 60.0
#define CAG_TEST_PICTURE_SECONDS 900.0

// A picture is as its reference when the mean of the color difference CIEDE2000 is at most
// CAG_TEST_DELTA_E (1 is just noticeable side by side), and no more than the share CAG_TEST_PIXELS
// of the pixels differ by more than CAG_TEST_PIXEL in a channel of linear light. This lets pass
// what the renderer's version and the rounding of a processor change at edges, and catches a shape
// that is missing, moved by some pixels, or of another color.
#define CAG_TEST_DELTA_E 1.0
#define CAG_TEST_PIXEL 0.1
#define CAG_TEST_PIXELS 0.01

typedef enum CagTestOutcome { CAG_TEST_PASSED, CAG_TEST_FAILED, CAG_TEST_SKIPPED } CagTestOutcome;

// Something that is not as expected.
typedef struct CagTestFailure {
  const char *test; // name of the run
  const char *file;
  size_t line; // 0: no line
  const char *message;
  const char *expected, *got; // lines of output; NULL: the message says it all
  const char *detail;         // further lines, such as the script's error; NULL: none
} CagTestFailure;

typedef struct CagTestOptions {
  CagSessionOptions session; // limits, module path, interrupt; what a script prints is caught
  const char *const *define_names, *const *define_values; // for all runs
  size_t define_count;
  const char *filter; // runs whose name holds this text; NULL: all
  bool update;        // write the reference pictures instead of comparing with them
  bool no_pictures;   // do not render
  void (*failure)(void *context, const CagTestFailure *failure);
  // A run has ended; `remark` says more (why it was skipped, that a picture was renewed) or is
  // NULL.
  void (*ended)(void *context, const char *test, CagTestOutcome outcome, double seconds,
                const char *remark);
  void *context;
} CagTestOptions;

typedef struct CagTestCounts {
  size_t passed, failed, skipped; // runs, and pictures
} CagTestCounts;

// Zero, but for the session's defaults.
void cag_test_options_init(CagTestOptions *options);

// Runs a script in all its runs and adds to the counts. `failure` and `ended` may be NULL. Gives
// CAG_STATUS_OK however the tests end; CAG_STATUS_FILE when the script cannot be read (a failure
// tells it), CAG_STATUS_INTERRUPTED, CAG_STATUS_LIMIT when there is no memory.
int cag_test_file(const char *path, const CagTestOptions *options, CagTestCounts *counts);

// The same of a text; there is no picture then.
int cag_test_text(const char *name, const char *text, size_t length, const CagTestOptions *options,
                  CagTestCounts *counts);

#endif
