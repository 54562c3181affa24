// The documentation site: static HTML pages that work offline.
//
// Pages are generated twice. The first pass discards its output and collects the scripts that the
// pages show. Then all scripts are run in parallel, and their pictures are rendered. The second
// pass writes the pages to files, with the output of the scripts.

#ifndef CAG_INTERP_SESSION_SITE_H
#define CAG_INTERP_SESSION_SITE_H

#include "base/status.h"
#include "interp/doc/doc.h"

// The size of pictures of examples in pixels.
#define CAG_SITE_WIDTH 320
#define CAG_SITE_HEIGHT 240

// A script that the pages show, and its results.
typedef struct CagSiteExample {
  const char *about; // its location, for messages
  char *text;
  char *folder;   // of the script to which it belongs; NULL: it may not read files
  char *function; // documented function, of whose call a picture may be made; NULL: none
  char *output;   // printed output, including an expected error
  char *picture;  // "pictures/0123456789abcdef.png"; NULL: none
  size_t picture_width, picture_height;
  char *failure;    // why it failed; NULL: it succeeded
  bool unavailable; // it needs the program cag-brep, which is missing: there is no output
} CagSiteExample;

// A user's file that the site documents.
typedef struct CagSiteScript {
  char *file, *folder; // its name, and its folder
  char *page;          // the name of its page: "parts.gripper"
  CagDocModule module; // named as the user sees it: "parts/gripper.cag"
} CagSiteScript;

typedef struct CagSite {
  CagSession *session; // reads modules
  const CagSiteOptions *options;
  const char *folder;
  CagSiteExample *examples;
  size_t count, capacity, next;
  bool final;  // the second pass
  FILE *index; // the growing search index
  size_t index_count;
  CagDocModule *modules;
  size_t module_count;
  CagSiteScript *scripts;
  size_t script_count;
  CagError error; // of the first file that could not be written
  bool failed;
} CagSite;

// The location of an example.
typedef struct CagSiteSpot {
  FILE *out;
  const char *root;     // path from the page to the site's folder: "" or "../"
  const char *about;    // for messages
  const char *function; // documented function; NULL: none
  const char *folder;   // as in CagSiteExample
} CagSiteSpot;

// Collects an example (in the first pass), or finds it.
const CagSiteExample *cag_site_example(CagSite *s, const CagSiteSpot *spot, const char *text,
                                       size_t length);
// Runs all examples and renders their pictures.
void cag_site_run(CagSite *s);

// --- HTML ---
void cag_html_text(FILE *out, const char *text, size_t length);
// Writes a script with syntax highlighting and links from functions to their pages. `root` is the
// path from the page to the site's folder: "" or "../".
void cag_html_script(FILE *out, const char *root, const char *text, size_t length);
// Writes an example with its output and its picture.
void cag_html_example(CagSite *s, const CagSiteSpot *spot, const char *text, size_t length);
// Writes text in which `words` in backquotes are code, with links to functions.
void cag_html_prose(FILE *out, const char *root, const char *text, size_t length);
// Converts Markdown, with tables. Fenced blocks of `cag` in the guide are examples; `cag fragment`
// is only highlighted.
void cag_html_markdown(CagSite *s, FILE *out, const char *root, const char *about, const char *text,
                       size_t length);
// Returns the anchor of a heading, such as "curves-and-splines" for "Curves and splines", allocated
// with malloc.
char *cag_html_anchor(const char *heading);

// --- Pages ---
typedef struct CagSitePage {
  CagSite *site;
  const char *path, *title, *root;
  FILE *out;
  char *text;
  size_t length;
  CagCleanup cleanup; // active until its end
} CagSitePage;

// Starts a page at a path such as "functions/sin.html". `section` selects the highlighted link at
// the top.
void cag_site_begin(CagSite *s, CagSitePage *p, const char *path, const char *title,
                    const char *section);
void cag_site_end(CagSitePage *p);
// Writes a file of the site (in the second pass).
void cag_site_write(CagSite *s, const char *path, const char *text, size_t length);
// Adds an entry to the search index.
void cag_site_find(CagSite *s, const char *name, const char *kind, const char *url,
                   const char *summary, size_t summary_length);

// Writes the head of a table of parameters, and a row.
void cag_site_begin_parameters(const CagSitePage *p);
void cag_site_parameter(const CagSitePage *p, const char *type, const char *meaning,
                        const char *name, const char *fallback);

// Reads the scripts that the site documents. Returns false, after a diagnostic, on failure.
bool cag_site_read_scripts(CagSite *s);
void cag_site_free_scripts(CagSite *s);

void cag_site_functions(CagSite *s); // the index, and a page for each function
void cag_site_library(CagSite *s);
void cag_site_scripts(CagSite *s);
// The scripts' part of the index of functions: its entry in the list at the top, and its section.
void cag_site_scripts_item(const CagSitePage *p);
void cag_site_scripts_section(const CagSitePage *p);
void cag_site_errors(CagSite *s);
void cag_site_guides(CagSite *s);
void cag_site_cookbook(CagSite *s);

#endif
