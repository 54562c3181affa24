// Reading a file back (see brep_check.h).

#include "interp/formats/brep_check.h"

#include <math.h>

#include "base/memory.h"
#include "geom/boundary/carrier.h"
#include "interp/formats/brep_build.h"
#include "interp/formats/iges.h"
#include "interp/formats/step.h"

// The relative difference of volumes that counts as equal. Readers compute curves in the parameters
// of surfaces again, within the gaps of edges; a face that was read wrongly changes far more.
#define VOLUME_SAME 1e-5

// The fraction of a face's extent in the parameters by which its sides may be off.
#define SIDE_SLACK 1e-7

// The sides of a face in the parameters, if all of its edges are straight there.
typedef struct Rectangle {
  double box[4]; // u0 u1 v0 v1
  bool straight;
} Rectangle;

static void add_parameters(Rectangle *r, double u, double v) {
  r->box[0] = fmin(r->box[0], u);
  r->box[1] = fmax(r->box[1], u);
  r->box[2] = fmin(r->box[2], v);
  r->box[3] = fmax(r->box[3], v);
}

static CagStatus rectangle_about_face(const CagBoundary *b, const CagBoundaryFace *f,
                                      Rectangle *out, CagError *err) {
  const CagBoundaryLoop *loop = &b->loops[f->first];
  *out = (Rectangle){{INFINITY, -INFINITY, INFINITY, -INFINITY}, true};
  for (size_t i = loop->first; out->straight && i < loop->first + loop->count; i++) {
    CagEdgePath p;
    CagStatus status = cag_edge_path(b, f, &b->uses[i], &p, err);
    if (status) return status;
    out->straight = p.straight;
    add_parameters(out, p.at[0] + p.start * p.along[0], p.at[1] + p.start * p.along[1]);
    add_parameters(out, p.at[0] + p.end * p.along[0], p.at[1] + p.end * p.along[1]);
  }
  return CAG_OK;
}

// Whether an edge lies along a side.
static bool is_on_side(const Rectangle *r, const CagEdgePath *p) {
  for (int k = 0; k < 2; k++) {
    const double *range = r->box + 2 * (size_t)k, slack = SIDE_SLACK * (range[1] - range[0]);
    const double from = p->at[k] + p->start * p->along[k], to = p->at[k] + p->end * p->along[k];
    for (int side = 0; side < 2; side++)
      if (fabs(from - range[side]) <= slack && fabs(to - range[side]) <= slack) return true;
  }
  return false;
}

static CagStatus is_rectangle(const CagBoundary *b, const CagBoundaryFace *f, bool *out,
                              CagError *err) {
  const CagBoundaryLoop *loop = &b->loops[f->first];
  Rectangle r;
  CagStatus status = f->count == 1 ? rectangle_about_face(b, f, &r, err) : CAG_OK;
  *out =
      !status && f->count == 1 && r.straight && r.box[1] - r.box[0] <= 2 * M_PI * (1 + SIDE_SLACK);
  for (size_t i = loop->first; !status && *out && i < loop->first + loop->count; i++) {
    CagEdgePath p;
    status = cag_edge_path(b, f, &b->uses[i], &p, err);
    *out = !status && is_on_side(&r, &p);
  }
  return status;
}

CagStatus cag_brep_needs_reading(const CagBoundaries *parts, bool *needed, CagError *err) {
  CagStatus status = CAG_OK;
  *needed = false;
  for (size_t i = 0; i < parts->count && !*needed; i++) {
    const CagBoundary *b = &parts->items[i];
    for (size_t f = 0; f < b->face_count && !*needed; f++) {
      bool plain = false;
      if (b->faces[f].carrier.kind == CAG_CARRIER_PLANE) continue;
      if (cag_carrier_is_analytic(&b->faces[f].carrier))
        status = is_rectangle(b, &b->faces[f], &plain, err);
      if (status) return status;
      *needed = !plain;
    }
  }
  return CAG_OK;
}

static CagStatus write_text(const CagBoundaries *parts, CagBrepFormat format, char **text,
                            size_t *size, CagError *err) {
  CagBrep b = {.accuracy = 1e-7};
  CagMaterial plain = {0};
  CagError io = {0};
  CagStatus status = CAG_OK;
  b.shapes = cag_calloc(1, sizeof *b.shapes);
  CagAtomicFile *file = cag_atomic_file_open_memory(&io);
  if (!b.shapes || !file) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i < parts->count; i++)
    status = cag_brep_add_boundary(&b, &parts->items[i], err);
  if (!status) {
    b.shapes[0] = (CagBrepShape){
        .kind = CAG_BREP_SOLID, .name = "solid", .material = &plain, .count = b.shell_count};
    b.shape_count = 1;
    status = format == CAG_BREP_IGES ? cag_export_iges(&b, NULL, file, err)
                                     : cag_export_step(&b, NULL, file, err);
  }
  if (status) cag_atomic_file_abort(file);
  else if (!cag_atomic_file_commit_memory(file, text, size, &io)) status = cag_fail_memory(err);
  cag_brep_free(&b);
  return status;
}

static double total_volume(const CagBoundaries *b) {
  double sum = 0;
  for (size_t i = 0; i < b->count; i++) sum += b->items[i].volume;
  return sum;
}

CagStatus cag_brep_reads_back(CagKernel *kernel, const CagBoundaries *parts, CagBrepFormat format,
                              bool *same, CagError *err) {
  char *text = NULL;
  size_t size = 0;
  CagBoundaries again = {0};
  CagKernelFailure why;
  *same = false;
  CagStatus status = write_text(parts, format, &text, &size, err);
  if (status) return status;
  status = format == CAG_BREP_IGES
               ? cag_kernel_read_iges(kernel, "solid.igs", text, size, &again, &why, err)
               : cag_kernel_read_step(kernel, "solid.step", text, size, &again, &why, err);
  cag_free(text);
  if (status) return why.reason ? CAG_OK : status;
  const double meant = total_volume(parts), found = total_volume(&again);
  *same = again.count == parts->count && fabs(meant - found) <= VOLUME_SAME * fabs(meant);
  cag_boundaries_free(&again);
  return CAG_OK;
}
