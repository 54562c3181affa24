// Labels as paths, for pages that draw them over a picture.

#include <stdio.h>
#include <stdlib.h>

#include "base/memory.h"
#include "interp/formats/svg.h"
#include "interp/scene/label_shape.h"
#include "interp/session/session.h"

struct CagSessionLabelPaths {
  CagLabelFonts fonts;       // for all labels of the scene
  char *text, *mark, *paper; // of the last one; from malloc, without an account
};

static void drop_texts(struct CagSessionLabelPaths *p) {
  free(p->text);
  free(p->mark);
  free(p->paper);
  p->text = p->mark = p->paper = NULL;
}

void cag_session_drop_label_paths(CagSession *s) {
  if (!s->label_paths) return;
  drop_texts(s->label_paths);
  cag_label_fonts_free(&s->label_paths->fonts);
  cag_free(s->label_paths);
  s->label_paths = NULL;
}

static CagStatus write_path(const CagRegion *r, char **out, CagError *err) {
  size_t n;
  if (!r) return CAG_OK;
  FILE *f = open_memstream(out, &n);
  if (!f) return cag_fail_memory(err);
  CagStatus status = cag_svg_path(r, 1, f, err);
  return fclose(f) == 0 || status ? status : cag_fail_memory(err);
}

static int make_paths(CagSession *s, void *context) {
  const CagVec3 origin = {0, 0, 0}, right = {1, 0, 0};
  const CagLabel *l = context;
  CagLabelShape shape;
  CagError err = {0};
  if (!s->label_paths) s->label_paths = cag_calloc(1, sizeof *s->label_paths);
  struct CagSessionLabelPaths *p = s->label_paths;
  if (!p) return cag_session_fail_memory(s);
  drop_texts(p);
  CagStatus status = cag_label_shape(&p->fonts, l, origin, right, 1, &shape, &err);
  if (!status) {
    status = write_path(shape.text, &p->text, &err);
    if (!status) status = write_path(shape.mark, &p->mark, &err);
    if (!status) status = write_path(shape.paper, &p->paper, &err);
    cag_label_shape_free(&shape);
  }
  return status ? cag_session_fail_geometry(s, &err) : CAG_STATUS_OK;
}

bool cag_session_label_paths(CagSession *s, size_t i, CagLabelPaths *out) {
  *out = (CagLabelPaths){.text = NULL};
  if (!cag_session_begin(s)) return false;
  const bool found = s->has_scene && i < s->scene.label_count &&
                     cag_session_geometry(s, make_paths, &s->scene.labels[i]) == CAG_STATUS_OK;
  if (found)
    *out = (CagLabelPaths){s->label_paths->text, s->label_paths->mark, s->label_paths->paper};
  cag_session_end(s, CAG_STATUS_OK);
  return found;
}
