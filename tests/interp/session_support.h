// Sessions for tests of the C interface; their output goes to standard error.

#ifndef CAG_TESTS_SESSION_SUPPORT_H
#define CAG_TESTS_SESSION_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "cag.h"

static inline CagSessionOptions session_options(void) {
  CagSessionOptions options;
  cag_session_options_init(&options);
  options.out = options.messages = stderr;
  return options;
}

static inline CagSession *new_session(void) {
  const CagSessionOptions options = session_options();
  CagSession *s = cag_session_new(&options);
  assert_non_null(s);
  return s;
}

#endif
