// What a script shows, as plain data: the interface between the interpreter and the exporters and
// renderers.
//
// A scene owns its data: texts are copies, geometry is retained. Positions are world coordinates in
// millimeters, Z up; angles are in radians; colors are linear RGB. The scene is independent of the
// values of the language.

#ifndef CAG_INTERP_SCENE_H
#define CAG_INTERP_SCENE_H

#include "geom/camera/camera.h"
#include "geom/curve/curve.h"
#include "geom/curve/region.h"
#include "geom/mesh/mesh.h"
#include "geom/solid/solid.h"
#include "geom/surface/surface.h"
#include "geom/tessellate/tessellate.h"

typedef struct CagColor {
  double r, g, b; // linear light
} CagColor;

// Converts "teal" (a CSS name), "#0a8", or "#00aa88" from sRGB to a linear color. Returns false for
// other texts.
bool cag_color_from_text(const char *text, CagColor *out);
double cag_srgb_to_linear(double c);
double cag_linear_to_srgb(double c);

typedef struct CagMaterial {
  char *name; // for .mtl and comments; never NULL
  CagColor color;
  double metallic;     // 0..1
  double roughness;    // 0..1
  double ior;          // 0..1: fraction of light that passes
  double transmission; // 0..1: share of light that passes
  CagColor emission;
  double coat;     // 0..1: clear coat over the base
  char *texture;   // "" | "wood" | "marble" | "concrete" | "clay" ...: procedural pattern of the
                   // renderers; never NULL
  CagColor color2; // second color of the pattern
  double texture_scale; // mm
  char *pov;            // texture in POV-Ray syntax, for POV-Ray only; NULL: none
} CagMaterial;

typedef enum CagItemKind {
  CAG_ITEM_CURVE,
  CAG_ITEM_REGION,
  CAG_ITEM_SURFACE,
  CAG_ITEM_SOLID,
  CAG_ITEM_MESH,
  CAG_ITEM_GROUND
} CagItemKind;

// The material of labeled operands of a solid or triangles of a mesh.
typedef struct CagItemLabel {
  uint32_t label;
  size_t material; // index into materials
} CagItemLabel;

// A shape to draw. Groups are split into their items. Names are unique within the scene ("vase",
// "vase.2").
typedef struct CagItem {
  CagItemKind kind;
  size_t number; // in the order in which items were added, before empty ones were moved away
  char *name;
  union {
    CagCurve *curve;
    CagRegion *region;
    CagSurface *surface;
    CagSolid *solid;
    CagMesh *mesh;
  } as;
  CagTransform placement; // REGION only: from z = 0 to its plane
  size_t material;        // index into materials
  CagItemLabel *labels;   // SOLID, MESH: labels, ascending; unlabeled parts have the item's
                          // material
  size_t label_count;
  double tolerance;             // mm; 0: the scene's
  CagBounds bounds;             // by cag_scene_complete
  bool measured;                // the bounds are known
  double line_radius;           // CURVE; 0: derived from the size of the scene
  double dash;                  // CURVE: length of dashes in mm; 0: none
  double ground_z, ground_size; // GROUND; size may be infinite
} CagItem;

// X(NAME, text): the mark drawn at the location of a label.
#define CAG_LABEL_MARKS(X)                                                                         \
  X(NONE, "none") X(DOT, "dot") X(CIRCLE, "circle") X(CROSS, "cross") X(ARROW, "arrow")
// X(NAME, text, x, y): the placement of a label's text, as steps to the right and up from its
// location.
#define CAG_LABEL_PLACES(X)                                                                        \
  X(RIGHT, "right", 1, 0)                                                                          \
  X(LEFT, "left", -1, 0)                                                                           \
  X(ABOVE, "above", 0, 1)                                                                          \
  X(BELOW, "below", 0, -1)                                                                         \
  X(CENTER, "center", 0, 0)                                                                        \
  X(ABOVE_RIGHT, "above_right", 1, 1)                                                              \
  X(ABOVE_LEFT, "above_left", -1, 1)                                                               \
  X(BELOW_RIGHT, "below_right", 1, -1)                                                             \
  X(BELOW_LEFT, "below_left", -1, -1)
typedef enum CagLabelMark {
#define X(name, text) CAG_LABEL_##name,
  CAG_LABEL_MARKS(X)
#undef X
} CagLabelMark;
typedef enum CagLabelPlace {
#define X(name, text, x, y) CAG_LABEL_##name,
  CAG_LABEL_PLACES(X)
#undef X
} CagLabelPlace;
// Their names, ending with NULL.
extern const char *const cag_label_marks[];
extern const char *const cag_label_places[];

// A text or mark in a flat picture.
typedef struct CagLabel {
  char *text;
  CagVec3 at, along; // along: the direction of the text and of an arrow
  bool directed;     // it has a direction
  CagLabelPlace place;
  CagLabelMark mark;
  double size;     // height of the text, mm; 0: derived from the size of the picture
  size_t material; // index into materials
} CagLabel;

typedef struct CagCamera {
  char *name;
  CagVec3 eye, target, up; // up is perpendicular to the view direction
  bool orthographic;
  double fov;             // horizontal, radians (perspective)
  double width;           // mm (orthographic; with `focal`, of the image plane)
  int size[2];            // pixels
  double focus, aperture; // mm; the aperture is the diameter of a lens; 0: everything is sharp
  bool mirrored;          // the picture is mirrored: its frame is left-handed
  // Of cameras that measure. The middle of the picture is at `shift` to the right of and below the
  // view axis, as fractions of the width in pixels; `skew` and `stretch` are K[0][1] / K[0][0] and
  // K[1][1] / K[0][0] - 1 of the camera matrix K (geom/camera/camera.h). Depths are measured from
  // the plane at the distance `focal`.
  double shift[2], skew, stretch, focal;
  bool framed; // placed so that it sees everything, for any shape of the picture
} CagCamera;

typedef enum CagLightKind {
  CAG_LIGHT_SUN,
  CAG_LIGHT_POINT,
  CAG_LIGHT_SPOT,
  CAG_LIGHT_AREA
} CagLightKind;
typedef struct CagLight {
  CagLightKind kind;
  CagVec3 position, direction; // direction: of the light (a unit vector)
  double angle;                // SPOT: full cone, radians
  double size;                 // AREA: side of its square, mm
  CagColor color;
  double strength; // 1: a white matte face perpendicular to it looks white
} CagLight;

typedef struct CagSky {
  size_t color_count; // number of colors, from bottom to top; 0: none
  CagColor *colors;
  char *image; // path of an EXR; NULL: none
} CagSky;

// What determined the tolerance of a mesh (fineness.h).
typedef enum CagToleranceSource {
  CAG_TOLERANCE_OF_ITEM,
  CAG_TOLERANCE_OF_SCENE,
  CAG_TOLERANCE_OF_PIXELS,
  CAG_TOLERANCE_OF_SIZE,
  CAG_TOLERANCE_SOURCES
} CagToleranceSource;
typedef struct CagToleranceRange {
  double least, most; // mm; 0: no mesh was made
} CagToleranceRange;
typedef struct CagTolerances {
  CagToleranceRange of[CAG_TOLERANCE_SOURCES];
} CagTolerances;

typedef struct CagScene {
  CagItem *items;
  size_t item_count;
  CagItem *empties; // shown items that are empty, moved here by cag_scene_complete
  size_t empty_count;
  CagLabel *labels;
  size_t label_count;
  CagMaterial *materials;
  size_t material_count; // material 0 is the default
  CagCamera *cameras;
  size_t camera_count; // at least one after cag_scene_complete
  CagLight *lights;
  size_t light_count;
  CagSky sky;
  bool has_background;
  CagColor background;
  CagBounds bounds;         // of all items except grounds
  double tolerance;         // mm: for items without their own; 0: the default (fineness.h)
  double usual_tolerance;   // mm: the default, by the size of all that is shown; 0: of each
  const CagCamera *picture; // meshes are for a picture of this camera; NULL: for any use
  CagTolerances *used;      // receives the tolerances of meshes; may be NULL
  size_t max_triangles;
  bool studio; // the studio lights were added, because no light was shown
  bool
      floor_hidden; // the studio's floor is the item after the last one, hidden by a view from below
  bool automatic_camera;
  char *script; // name of the script, for metadata
  const volatile int *interrupt;
} CagScene;

void cag_scene_free(CagScene *s);
void cag_item_free(CagItem *item); // what it owns
// Returns the index of the material of an item's triangles or operands with this label.
static inline size_t cag_item_label_material(const CagItem *item, uint32_t label) {
  size_t from = 0, to = item->label_count;
  while (from < to) {
    const size_t middle = from + (to - from) / 2;
    if (item->labels[middle].label < label) from = middle + 1;
    else to = middle;
  }
  const bool found = from < item->label_count && item->labels[from].label == label;
  return found ? item->labels[from].material : item->material;
}
// Adds a camera that frames everything, unless there is one, and the studio lights, unless there is
// a light or a sky that lights. Computes bounds and, unless it is set, the default tolerance, and
// moves empty items to `empties`. If all items are empty, nothing else is done.
CagStatus cag_scene_complete(CagScene *s, CagError *err);
// Moves a camera, keeping its direction, so that it frames all items for the shape of its picture
// (size). Called by cag_scene_complete, and again for a picture of another size.
void cag_camera_frame_all(const CagScene *s, CagCamera *camera);
// The first function returns the name of standard view i, or NULL after the last one. The second
// adds a camera of such a name after the others, which frames what is shown, without perspective.
// From below, the studio's floor is hidden. The third removes the last camera, which was added by
// the second.
const char *cag_standard_view(size_t i);
CagStatus cag_scene_add_view(CagScene *s, const char *name, CagError *err);
void cag_scene_remove_view(CagScene *s);
// Adds a camera after the others. Copies its name.
CagStatus cag_scene_add_camera(CagScene *s, const CagCamera *camera, CagError *err);
// Computes the bounds of an item under a transform (NULL: none). A ground has none.
CagStatus cag_item_bounds(const CagItem *item, const CagTransform *t, CagBounds *out,
                          CagError *err);
// Returns the box to frame, which is a region about the origin if nothing is shown, and half its
// diagonal.
CagBounds cag_scene_framed(const CagScene *s);
double cag_scene_radius(const CagBounds *b);
// Returns the transform from camera to world: columns x (right), y (down), z (view direction),
// origin.
CagTransform cag_camera_frame(const CagCamera *c);
// The directions in the picture, in units of its width: right, down, and from the view axis to the
// middle of the picture. Without skew and stretch, right and down are unit vectors at right angles.
typedef struct CagCameraWindow {
  CagVec3 right, down, shift;
} CagCameraWindow;
CagCameraWindow cag_camera_window(const CagCamera *c);
// Returns K and R, and the map from points to pixels, of the camera with a picture of its size.
CagCameraParts cag_camera_parts(const CagCamera *c);
CagStatus cag_scene_camera_map(const CagCamera *c, CagCameraMap *out, CagError *err);
// Tests whether the camera has depth of field. The rays of orthographic cameras are parallel.
bool cag_camera_has_lens(const CagCamera *c);
CagMaterial cag_material_default(void);

// Makes the mesh of an item at its tolerance. Curves become tubes of their line radius, regions are
// flat, and closed parts have outward normals. Not for grounds. *out has one reference.
CagStatus cag_item_mesh(const CagScene *s, const CagItem *item, CagMesh **out, CagError *err);

#endif
