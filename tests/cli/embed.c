// A program that uses the library: a vase, higher than its script says, as a mesh. The README shows
// it, and the tests build it against an installed libcag.

#include <cag.h>
#include <stdio.h>

int main(void) {
  static const char SCRIPT[] =
      "param height = 120\n"
      "profile = bspline([[24, 0], [45, 0.3*height], [22, 0.7*height], [34, height]], degree: 3)\n"
      "show revolve(profile)\n"
      "print \"height {height}\"\n";
  CagSessionOptions options;
  cag_session_options_init(&options);
  CagSession *s = cag_session_new(&options);
  if (!s) return 1;
  cag_session_define(s, "height", "200");
  int status = cag_session_run_text(s, "vase", SCRIPT, sizeof SCRIPT - 1);
  if (status == CAG_STATUS_OK) status = cag_session_export(s, "vase.stl", NULL);
  cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr);
  cag_session_free(s);
  return status;
}
