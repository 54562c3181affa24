// What the parts of the POV-Ray writer share. Not for other files.

#ifndef CAG_INTERP_FORMATS_POV_WRITE_H
#define CAG_INTERP_FORMATS_POV_WRITE_H

#include "interp/formats/pov.h"

// Room for an identifier: POV-Ray takes up to 40 characters.
#define CAG_POV_NAME_MAX 40
typedef char CagPovName[CAG_POV_NAME_MAX + 1];

typedef struct CagPovWriter {
  const CagScene *scene;
  const CagPovOptions *options;
  CagAtomicFile *file;
  const CagCamera *camera;
  CagVec3 center; // of the scene
  double radius;  // of a sphere about everything; positive
  bool indirect;  // radiosity is on
  double unit;    // POV-Ray's units in a millimeter: 1 unless the scene is tiny or huge
  CagPovName *item_names, *material_names;
  // Where the thing just written stands, to be said behind its material, so that a pattern moves
  // with it. Set by cag_pov_try_solid, taken and reset by the caller.
  CagTransform placement;
  CagTransform outer; // of the set operations around what is being written
  // While a set operation is written (pov_csg.c): its operands carry their placement, and
  // meshes tell inside from outside.
  bool in_operation;
  const CagItem *item; // being written
  int depth;           // by so many steps lines are indented
  double tolerance;    // of the item being written, as its mesh would have it
  bool see_through;    // light passes through the item's material
  CagError failure;    // status not CAG_OK: writing an item failed on the way
} CagPovWriter;

// --- Text (pov_text.c) ---
void cag_pov_text(CagPovWriter *w, const char *text);
void cag_pov_printf(CagPovWriter *w, const char *format, ...) __attribute__((format(printf, 2, 3)));
void cag_pov_number(CagPovWriter *w, double x);     // shortest that reads back the same
void cag_pov_vec(CagPovWriter *w, CagVec3 v);       // <x, y, z>
void cag_pov_place_vec(CagPovWriter *w, CagVec3 v); // of the camera or a light: unit*<x, y, z>
void cag_pov_length(CagPovWriter *w, double x);     // likewise
void cag_pov_vec2(CagPovWriter *w, double x, double y);
void cag_pov_color(CagPovWriter *w, CagColor c); // rgb <r, g, b>, rounded to 5 places
double cag_pov_round(double x, double unit);     // to a multiple of unit, for readable numbers
// Begins `quadric { ... }` with the ten coefficients; the caller closes it. POV-Ray orders the terms
// x^2 y^2 z^2, xy xz yz, x y z, 1, and the values inside are negative, as in CagQuadric.
void cag_pov_equation(CagPovWriter *w, const double q[10]);
// One line of comment: line breaks and control characters of `text` become spaces.
void cag_pov_comment(CagPovWriter *w, const char *indent, const char *text);
// "  matrix <...>", or `translate` where that is all; nothing for the identity.
void cag_pov_placement(CagPovWriter *w, const char *indent, const CagTransform *t);
// Identifiers for all names: letters, digits and _, no word of POV-Ray's own, each once. `prefix`
// goes before each. *out is malloc'd.
bool cag_pov_names(const char *prefix, const char *const *names, size_t n, CagPovName **out);

// --- Materials (pov_material.c) ---
// #declare of material `index`, for closed bodies and (where light passes through) thin sheets.
void cag_pov_material(CagPovWriter *w, size_t index, bool closed);
// The name to use for an item of it.
void cag_pov_material_name(const CagPovWriter *w, size_t index, bool closed, char out[64]);
// The material with the colors of a scale in place of its own, to stand in an object; the mesh
// has the places (cag_pov_mesh).
void cag_pov_scale_material(CagPovWriter *w, size_t index, const CagColorScale *scale);
// Where in the pattern the place t of a scale is; at its end it begins anew.
#define POV_SCALE_EDGE 1e-6
static inline double pov_scale_place(double t) { return 0.25 + 0.5 * t; }
// Light from everywhere where there is no radiosity.
CagColor cag_pov_ambient(const CagScene *s);

// --- Lights, camera, sky (pov_stage.c) ---
void cag_pov_camera(CagPovWriter *w);
void cag_pov_lights(CagPovWriter *w);
void cag_pov_sky(CagPovWriter *w);

// --- Things. Each `try` writes one native object after "#declare name = ", without the final line
// break, and says whether there was one. Nothing is written otherwise. ---
bool cag_pov_try_solid(CagPovWriter *w, const CagSolid *s);                      // pov_solid.c
bool cag_pov_try_surface(CagPovWriter *w, const CagSurface *s);                  // pov_surface.c
bool cag_pov_try_quadric(CagPovWriter *w, const CagSurface *const *s, size_t n); // pov_quadric.c
bool cag_pov_try_lathe(CagPovWriter *w, const CagSurface *const *s, size_t n);   // pov_lathe.c
// What POV-Ray's objects are stretched by: an affine map that leaves them a body. A flatter one is
// for meshes.
bool cag_pov_takes(const CagTransform *map); // pov_text.c
// The surface and the map it is seen through; itself and the identity where there is none.
const CagSurface *cag_pov_unplaced(const CagSurface *s, CagTransform *map); // pov_text.c
// A revolution of straight lines without an inside.
bool cag_pov_try_cones(CagPovWriter *w, const CagSurface *s); // pov_lathe.c
bool cag_pov_try_prism(CagPovWriter *w, const CagSolid *s);   // pov_lathe.c
// The operation, `depth` times taken away from something; failures are left in the writer.
void cag_pov_csg(CagPovWriter *w, const CagSolid *s, int depth); // pov_csg.c
bool cag_pov_try_torus(CagPovWriter *w, const CagSurface *s);    // pov_surface.c
bool cag_pov_try_polygon(CagPovWriter *w, const CagRegion *r, const CagTransform *placement);
// Declares the curve as a round line.
CagStatus cag_pov_curve(CagPovWriter *w, const CagItem *item, const char *name, CagError *err);
CagStatus cag_pov_mesh(CagPovWriter *w, const CagMesh *m, CagError *err); // pov_mesh.c
// The mesh with normals that the camera sees from the side from which it sees their triangles.
CagStatus cag_pov_facing_mesh(const CagPovWriter *w, const CagMesh *m, CagMesh **out,
                              CagError *err); // pov_facing.c

#endif
