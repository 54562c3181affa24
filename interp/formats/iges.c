// Writer of IGES files.
//
// A file consists of lines of 80 columns in five sections: start, global, directory (two lines per
// entity), parameters, and end. The directory comes first and contains line numbers of the
// parameters, so both are made in memory first.

#include "interp/formats/iges.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "interp/formats/iges_entity.h"
#include "interp/formats/iges_solid.h"

// --- Trimmed planes ---

static CagVec3 net_point(const CagSurfaceNurbsView *v, size_t i) {
  const double *h = v->homogeneous + 4 * i;
  return cag_vec3(h[0] / h[3], h[1] / h[3], h[2] / h[3]);
}

// The affine map from space to the parameters of a flat face's rectangle.
static CagStatus to_parameters(const CagSurface *s, CagTransform *out, CagError *err) {
  CagSurfaceNurbsView v = {0};
  cag_surface_nurbs_view(s, &v);
  CagVec3 p = net_point(&v, 0);
  CagVec3 x = cag_scaled(cag_sub(net_point(&v, 2), p), 1 / (s->u1 - s->u0));
  CagVec3 y = cag_scaled(cag_sub(net_point(&v, 1), p), 1 / (s->v1 - s->v0));
  CagVec3 z = cag_cross(x, y);
  CagTransform frame = {
      .m = {{x.x, y.x, z.x, p.x}, {x.y, y.y, z.y, p.y}, {x.z, y.z, z.z, p.z}, {0, 0, 0, 1}}};
  return cag_transform_inverse(&frame, out, err);
}

typedef struct Chain {
  CagIgesPointer *flat, *space;
  size_t count;
} Chain;

// Adds the curve in space and, unless map is NULL, in the parameters.
static CagStatus add_use(CagIges *w, const CagBrepUse *use, const CagTransform *map, Chain *chain,
                         CagError *err) {
  CagCurve *run = NULL, *flat = NULL;
  const CagCurve *c = w->brep->edges[use->edge].curve;
  CagStatus status = CAG_OK;
  if (use->reversed) status = cag_curve_reverse(c, &run, err);
  else run = cag_curve_retain(c);
  if (!status && map) status = cag_curve_transform(run, map, &flat, err);
  if (!status && map)
    status =
        cag_iges_nurbs_curve(w, flat, true, CAG_IGES_PART_FLAT, &chain->flat[chain->count], err);
  if (!status)
    status = cag_iges_nurbs_curve(w, run, false, CAG_IGES_PART, &chain->space[chain->count++], err);
  cag_curve_release(run);
  cag_curve_release(flat);
  return status;
}

// Joins several curves end to end. A single curve is returned unchanged.
static CagIgesPointer composite(CagIges *w, const CagIgesPointer *parts, size_t n, int status) {
  if (n == 1) return parts[0];
  CagIgesPointer p = cag_iges_begin(w, 102, 0, status);
  cag_iges_integer(w, (long)n);
  for (size_t i = 0; i < n; i++) cag_iges_pointer(w, parts[i]);
  cag_iges_end(w, false);
  return p;
}

static CagStatus boundary(CagIges *w, const CagBrepLoop *loop, const CagTransform *map,
                          CagIgesPointer surface, CagIgesPointer *out, CagError *err) {
  Chain chain = {cag_calloc(loop->count + 1, sizeof *chain.flat),
                 cag_calloc(loop->count + 1, sizeof *chain.space), 0};
  CagStatus status = chain.flat && chain.space ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < loop->count; i++)
    status = add_use(w, &w->brep->uses[loop->first + i], map, &chain, err);
  if (!status) {
    CagIgesPointer flat = map ? composite(w, chain.flat, chain.count, CAG_IGES_PART_FLAT) : 0;
    CagIgesPointer space = composite(w, chain.space, chain.count, CAG_IGES_PART);
    *out = cag_iges_begin(w, 142, 0, CAG_IGES_PART);
    cag_iges_integer(w, 0); // unspecified way of creation
    cag_iges_pointer(w, surface);
    cag_iges_pointer(w, flat);
    cag_iges_pointer(w, space);
    cag_iges_integer(w, map ? 3 : 2); // both are equally good; or the one in space
    cag_iges_end(w, false);
  }
  cag_free(chain.flat);
  cag_free(chain.space);
  return status;
}

static CagStatus trimmed(CagIges *w, const CagBrepFace *f, CagError *err) {
  CagTransform map = cag_transform_identity();
  CagStatus status = f->flat ? to_parameters(f->surface, &map, err) : CAG_OK;
  CagIgesPointer *loops = cag_calloc(f->count + 1, sizeof *loops);
  if (!status && !loops) status = cag_fail_memory(err);
  CagIgesPointer surface = status ? 0 : cag_iges_nurbs_surface(w, f->surface, CAG_IGES_PART);
  for (size_t i = 0; !status && i < f->count; i++)
    status =
        boundary(w, &w->brep->loops[f->first + i], f->flat ? &map : NULL, surface, &loops[i], err);
  if (!status) {
    cag_iges_begin(w, 144, 0, CAG_IGES_FREE);
    cag_iges_pointer(w, surface);
    cag_iges_integer(w, 1); // with an outer boundary
    cag_iges_integer(w, (long)f->count - 1);
    for (size_t i = 0; i < f->count; i++) cag_iges_pointer(w, loops[i]);
    cag_iges_end(w, true);
  }
  cag_free(loops);
  return status;
}

// --- The whole file ---

// Writes the faces of a shell one by one.
static CagStatus write_faces(CagIges *w, const CagBrepShell *shell, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = shell->first; !status && i < shell->first + shell->count; i++) {
    if (cag_atomic_file_failed(w->parameters)) return CAG_OK;
    const CagBrepFace *f = &w->brep->faces[i];
    if (f->whole) cag_iges_nurbs_surface(w, f->surface, CAG_IGES_FREE);
    else status = trimmed(w, f, err);
  }
  return status;
}

static CagStatus write_shape(CagIges *w, const CagBrepShape *s, CagError *err) {
  const CagBrep *b = w->brep;
  w->color = w->name = 0;
  CagIgesPointer paint = cag_iges_color(w, s->material->color), title = cag_iges_name(w, s->name);
  w->color = paint;
  w->name = title;
  CagIgesPointer curve;
  if (s->kind == CAG_BREP_CURVE)
    return cag_iges_nurbs_curve(w, s->curve, false, CAG_IGES_FREE, &curve, err);
  CagStatus status = CAG_OK;
  for (size_t k = s->first; !status && k < s->first + s->count; k++) {
    if (b->faces[b->shells[k].first].carrier.kind == CAG_CARRIER_NONE)
      status = write_faces(w, &b->shells[k], err);
    else if (b->shells[k].void_of == k) status = cag_iges_solid(w, s, k, err);
  }
  return status;
}

static double largest_coordinate(const CagBrep *b) {
  double most = 0;
  for (size_t i = 0; i < b->vertex_count; i++) {
    CagVec3 p = b->vertices[i];
    most = fmax(most, fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))));
  }
  return most;
}

// There is no date, so that the output is reproducible.
static void write_global(CagIges *w, const char *script) {
  w->width = CAG_IGES_GLOBAL_COLUMNS;
  cag_iges_string(w, ",");
  cag_iges_string(w, ";");
  cag_iges_string(w, script);
  cag_iges_string(w, script);
  cag_iges_string(w, "cag " CAG_VERSION);
  cag_iges_string(w, "cag " CAG_VERSION);
  // Bits of integers, exponents and digits of single and double precision.
  const long precision[5] = {32, 38, 6, 308, 15};
  for (int i = 0; i < 5; i++) cag_iges_integer(w, precision[i]);
  cag_iges_string(w, script);
  cag_iges_real(w, 1); // scale
  cag_iges_integer(w, 2);
  cag_iges_string(w, "MM");
  cag_iges_integer(w, 1);
  cag_iges_real(w, 0.1); // width of lines
  cag_iges_string(w, "19700101.000000");
  cag_iges_real(w, w->brep->accuracy);
  cag_iges_real(w, largest_coordinate(w->brep));
  cag_iges_string(w, "");
  cag_iges_string(w, "");
  cag_iges_integer(w, 11); // IGES 5.3
  cag_iges_integer(w, 0);
  cag_iges_string(w, "19700101.000000");
  w->line[w->column - 1] = ';';
  cag_iges_end_line(w);
}

// Appends a section made in memory, and counts its lines.
static bool append(CagAtomicFile *to, CagAtomicFile *section, CagError *io) {
  char *bytes;
  size_t size;
  if (!cag_atomic_file_commit_memory(section, &bytes, &size, io)) return false;
  cag_atomic_file_write(to, bytes, size);
  cag_free(bytes);
  return true;
}

typedef struct Sections {
  CagAtomicFile *global, *directory, *parameters;
} Sections;

static void abort_sections(const Sections *s) {
  cag_atomic_file_abort(s->global);
  cag_atomic_file_abort(s->directory);
  cag_atomic_file_abort(s->parameters);
}

static CagStatus write_sections(CagIges *w, Sections *s, const char *script, CagAtomicFile *file,
                                CagError *err) {
  w->parameters = s->global;
  write_global(w, script);
  long global = w->parameter_lines;
  w->parameters = s->parameters;
  w->directory = s->directory;
  w->parameter_lines = 0;
  w->width = CAG_IGES_PARAMETER_COLUMNS;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < w->brep->shape_count; i++)
    status = write_shape(w, &w->brep->shapes[i], err);
  if (status) {
    abort_sections(s);
    return status;
  }
  cag_atomic_file_printf(file, "%-72sS%7d\n", "Exact geometry, in millimeters.", 1);
  CagError io = {0};
  bool whole = append(file, s->global, &io);
  whole = append(file, s->directory, &io) && whole;
  whole = append(file, s->parameters, &io) && whole;
  char counts[80];
  snprintf(counts, sizeof counts, "S%7dG%7ldD%7ldP%7ld", 1, global, 2 * w->entities,
           w->parameter_lines);
  cag_atomic_file_printf(file, "%-72sT%7d\n", counts, 1);
  if (w->undefined && whole)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_not_finite, "", -1,
                    "a number in the file overflows or is undefined");
  return whole ? CAG_OK : cag_fail_memory(err);
}

CagStatus cag_export_iges(const CagBrep *brep, const char *script, CagAtomicFile *file,
                          CagError *err) {
  CagError io = {0};
  Sections s = {cag_atomic_file_open_memory(&io), cag_atomic_file_open_memory(&io),
                cag_atomic_file_open_memory(&io)};
  if (!s.global || !s.directory || !s.parameters) {
    abort_sections(&s);
    return cag_fail_memory(err);
  }
  CagIges w = {.brep = brep};
  return write_sections(&w, &s, script && *script ? script : "scene", file, err);
}
