// The site of all documentation: pages of static HTML, with no need of a network.
//
// Pages are written twice. The first time they go nowhere, and every script that they show is
// kept; then all scripts are run, several at once, and their pictures made; the second time the
// pages are written to files, with what the scripts printed. So a page says but once what it shows.

#ifndef CAG_INTERP_SESSION_SITE_H
#define CAG_INTERP_SESSION_SITE_H

#include "base/status.h"
#include "interp/doc/doc.h"

// What pictures of examples measure, in pixels.
#define CAG_SITE_WIDTH 320
#define CAG_SITE_HEIGHT 240

// A script that the pages show, and what came of it.
typedef struct CagSiteExample {
  const char *about; // where it stands, for messages
  char *text;
  char *folder;   // of a script that it belongs to; NULL: it reads no files
  char *function; // what it is an example of, whose picture may be made of its call; NULL: nothing
  char *output;   // what it printed, and its error where one is expected
  char *picture;  // "pictures/0123456789abcdef.png"; NULL: none
  char *failure;  // why it is wrong; NULL: it is well
} CagSiteExample;

// A file of the user's that the site tells of.
typedef struct CagSiteScript {
  char *file, *folder; // its name, and where it is
  char *page;          // the name of its page: "parts.gripper"
  CagDocModule module; // called as the user sees it: "parts/gripper.cag"
} CagSiteScript;

typedef struct CagSite {
  CagSession *session; // reads modules
  const CagSiteOptions *options;
  const char *folder;
  bool renders; // there is POV-Ray
  CagSiteExample *examples;
  size_t count, capacity, next;
  bool final;  // the second time
  FILE *index; // what the search looks in, as it grows
  size_t index_count;
  CagDocModule *modules;
  size_t module_count;
  CagSiteScript *scripts;
  size_t script_count;
  CagError error; // of the first file that could not be written
  bool failed;
} CagSite;

// Where an example stands.
typedef struct CagSiteSpot {
  FILE *out;
  const char *root;     // leads from the page to the site's folder: "" or "../"
  const char *about;    // for messages
  const char *function; // what it is an example of; NULL: nothing
  const char *folder;   // as in CagSiteExample
} CagSiteSpot;

// Keeps an example (the first time), or finds it.
const CagSiteExample *cag_site_example(CagSite *s, const CagSiteSpot *spot, const char *text,
                                       size_t length);
// Runs all examples and makes their pictures.
void cag_site_run(CagSite *s);

// --- HTML ---
void cag_html_text(FILE *out, const char *text, size_t length);
// A script, its words colored; names of functions lead to their pages. `root` leads from the page
// to the site's folder: "" or "../".
void cag_html_script(FILE *out, const char *root, const char *text, size_t length);
// An example with what it printed and its picture.
void cag_html_example(CagSite *s, const CagSiteSpot *spot, const char *text, size_t length);
// Text in which `words` between backquotes are code, and lead to functions' pages.
void cag_html_prose(FILE *out, const char *root, const char *text, size_t length);
// Markdown, with tables. Fenced blocks of `cag` in the guide are examples (`cag fragment`: only
// colored).
void cag_html_markdown(CagSite *s, FILE *out, const char *root, const char *about, const char *text,
                       size_t length);
// The anchor of a heading: "Curves and splines" is "curves-and-splines". malloc'd.
char *cag_html_anchor(const char *heading);

// --- Pages ---
typedef struct CagSitePage {
  CagSite *site;
  const char *path, *title, *root;
  FILE *out;
  char *text;
  size_t length;
  CagCleanup cleanup; // until its end
} CagSitePage;

// Begins a page at a path such as "functions/sin.html"; `section` marks its link at the top.
void cag_site_begin(CagSite *s, CagSitePage *p, const char *path, const char *title,
                    const char *section);
void cag_site_end(CagSitePage *p);
// Writes a file of the site (the second time).
void cag_site_write(CagSite *s, const char *path, const char *text, size_t length);
// Adds what a search finds.
void cag_site_find(CagSite *s, const char *name, const char *kind, const char *url,
                   const char *summary, size_t summary_length);

// The table of parameters: its head, and a line.
void cag_site_begin_parameters(const CagSitePage *p);
void cag_site_parameter(const CagSitePage *p, const char *type, const char *meaning,
                        const char *name, const char *fallback);

// Reads the scripts that the site is to tell of; false: a diagnostic says what is wrong.
bool cag_site_read_scripts(CagSite *s);
void cag_site_free_scripts(CagSite *s);

void cag_site_functions(CagSite *s); // the index, and a page for each function
void cag_site_library(CagSite *s);
void cag_site_scripts(CagSite *s);
// Their part of the index of functions: its place in the list at the top, and the section.
void cag_site_scripts_item(const CagSitePage *p);
void cag_site_scripts_section(const CagSitePage *p);
void cag_site_errors(CagSite *s);
void cag_site_guides(CagSite *s);
void cag_site_cookbook(CagSite *s);

#endif
