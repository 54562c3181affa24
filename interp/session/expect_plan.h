// The expectations of a script, read from its comments (see expect.h).
//
// The script is scanned for comments and texts only, without parsing the language, because scripts
// with errors are tests, too. Each run has a plan: its options, the expected lines, and the
// expected errors.

#ifndef CAG_INTERP_SESSION_EXPECT_PLAN_H
#define CAG_INTERP_SESSION_EXPECT_PLAN_H

#include "cag.h"

// A part of the script's text.
typedef struct CagTestPiece {
  const char *start, *end;
} CagTestPiece;

typedef struct CagTestExpected {
  CagTestPiece text; // the line, the error's code, or the path of an image
  CagTestPiece name; // of the image; empty: the only one
  size_t line;
  bool is_error, is_image;
  bool alone; // nothing else is on the line
  bool met;
} CagTestExpected;

typedef struct CagTestDefine {
  char *name, *value;
} CagTestDefine;

typedef struct CagTestPlan {
  char *options; // as written after `run:`; NULL: the run without options
  size_t line;
  CagTestDefine *defines;
  size_t define_count;
  CagSessionOptions limits;
  bool picture;               // the reference picture belongs to this run
  CagRenderOptions rendering; // of the picture; NULL and 0 where the run says nothing
  CagTestExpected *expected;
  size_t count;
  char *problem; // with the options; NULL: none
} CagTestPlan;

// A comment that looks like an expectation.
typedef struct CagTestMiss {
  CagTestPiece text;
  const char *meant;
  size_t line;
} CagTestMiss;

typedef struct CagTestPlans {
  CagTestPlan *items;
  size_t count;
  CagTestMiss *misses;
  size_t miss_count;
  bool memory; // memory ran out
} CagTestPlans;

// Removes blanks at both ends.
CagTestPiece cag_test_trim(CagTestPiece p);

// Reads the plans of a script, one at least. Pieces refer to `text`. Returns false if memory ran
// out. In any case, the plans are released with cag_test_free_plans.
bool cag_test_read_plans(const char *text, size_t length, const CagSessionOptions *limits,
                         CagTestPlans *plans);
void cag_test_free_plans(CagTestPlans *plans);

#endif
