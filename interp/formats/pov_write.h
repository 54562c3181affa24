// Internals of the POV-Ray writer.

#ifndef CAG_INTERP_FORMATS_POV_WRITE_H
#define CAG_INTERP_FORMATS_POV_WRITE_H

#include "interp/formats/pov.h"

// The maximum length of an identifier in POV-Ray is 40.
#define CAG_POV_NAME_MAX 40
typedef char CagPovName[CAG_POV_NAME_MAX + 1];

typedef struct CagPovWriter {
  const CagScene *scene;
  const CagPovOptions *options;
  CagAtomicFile *file;
  const CagCamera *camera;
  CagVec3 center; // of the scene
  double radius;  // of a sphere around everything; positive
  bool indirect;  // radiosity is on
  double unit;    // POV-Ray units per millimeter: 1 unless the scene is tiny or huge
  CagPovName *item_names, *material_names;
  // The placement of the last written object, to be written after its material, so that a pattern
  // moves with it. Set by cag_pov_try_solid; the caller writes and resets it.
  CagTransform placement;
  CagTransform outer; // of the enclosing set operations
  // During a set operation (pov_csg.c), operands include their placement, and meshes have an
  // inside.
  bool in_operation;
  const CagItem *item; // being written
  int depth;           // indentation of lines, in steps
  bool see_through;    // light passes through the item's material
  CagError failure;    // not CAG_OK: writing an item failed
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
// Starts `quadric { ... }` with the ten coefficients; the caller closes it. POV-Ray orders the
// terms x^2 y^2 z^2, xy xz yz, x y z, 1, and values inside are negative, as in CagQuadric.
void cag_pov_equation(CagPovWriter *w, const double q[10]);
// Writes one line of comment. Line breaks and control characters of `text` become spaces.
void cag_pov_comment(CagPovWriter *w, const char *indent, const char *text);
// Writes "  matrix <...>", or `translate` if that is sufficient, or nothing for the identity.
void cag_pov_placement(CagPovWriter *w, const char *indent, const CagTransform *t);
// Makes a unique identifier for each name, of letters, digits, and _, that is not a reserved word
// of POV-Ray, and starts with `prefix`. *out is allocated with malloc.
bool cag_pov_names(const char *prefix, const char *const *names, size_t n, CagPovName **out);

// --- Materials (pov_material.c) ---
// Declares material `index`, for closed bodies and, if it is transparent, for thin sheets.
void cag_pov_material(CagPovWriter *w, size_t index, bool closed);
// Returns the name with which an item refers to it.
void cag_pov_material_name(const CagPovWriter *w, size_t index, bool closed, char out[64]);
// Writes the material inside of an object, with the colors of a scale instead of its own. The mesh
// contains the values (cag_pov_mesh).
void cag_pov_scale_material(CagPovWriter *w, size_t index, const CagColorScale *scale);
// The location in the pattern of the position t (0..1) in a scale. The pattern repeats after 1, so
// locations are at most 1 - POV_SCALE_EDGE.
#define POV_SCALE_EDGE 1e-6
static inline double pov_scale_place(double t) { return 0.25 + 0.5 * t; }
// Returns the ambient light that replaces radiosity.
CagColor cag_pov_ambient(const CagScene *s);

// --- Lights, camera, sky (pov_stage.c) ---
void cag_pov_camera(CagPovWriter *w);
void cag_pov_lights(CagPovWriter *w);
void cag_pov_sky(CagPovWriter *w);

// --- Labels (pov_label.c) ---
// Writes the labels of the scene as objects that face the camera.
CagStatus cag_pov_labels(CagPovWriter *w, CagError *err);

// --- Items ---
// Each `try` function writes one native object after "#declare name = ", without the final line
// break, and returns whether it could. If not, it writes nothing.
bool cag_pov_try_solid(CagPovWriter *w, const CagSolid *s);                      // pov_solid.c
bool cag_pov_try_surface(CagPovWriter *w, const CagSurface *s);                  // pov_surface.c
bool cag_pov_try_quadric(CagPovWriter *w, const CagSurface *const *s, size_t n); // pov_quadric.c
bool cag_pov_try_lathe(CagPovWriter *w, const CagSurface *const *s, size_t n);   // pov_lathe.c
// Tests whether POV-Ray can apply the map to its objects: an affine map that does not flatten them.
// For others, meshes are used.
bool cag_pov_takes(const CagTransform *map); // pov_text.c
// Splits a placed surface into the surface and its map, which is the identity if it is not placed.
const CagSurface *cag_pov_unplaced(const CagSurface *s, CagTransform *map); // pov_text.c
// Writes a revolution of straight lines as a surface without an inside.
bool cag_pov_try_cones(CagPovWriter *w, const CagSurface *s); // pov_lathe.c
bool cag_pov_try_prism(CagPovWriter *w, const CagSolid *s);   // pov_lathe.c
// Writes the operation, which `depth` enclosing differences subtract. Failures are kept in the
// writer.
void cag_pov_csg(CagPovWriter *w, const CagSolid *s, int depth); // pov_csg.c
bool cag_pov_try_torus(CagPovWriter *w, const CagSurface *s);    // pov_surface.c
bool cag_pov_try_polygon(CagPovWriter *w, const CagRegion *r, const CagTransform *placement);
// Declares the curve as a tube.
CagStatus cag_pov_curve(CagPovWriter *w, const CagItem *item, const char *name, CagError *err);
CagStatus cag_pov_mesh(CagPovWriter *w, const CagMesh *m, CagError *err); // pov_mesh.c
// Returns the mesh with its normals adjusted to be on the same side as the triangles, as seen from
// the camera.
CagStatus cag_pov_facing_mesh(const CagPovWriter *w, const CagMesh *m, CagMesh **out,
                              CagError *err); // pov_facing.c

#endif
