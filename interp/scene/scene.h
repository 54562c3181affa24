// What a script shows, as plain data: the hand-over from the interpreter to exporters and
// renderers.
//
// A scene owns what it points to: texts are copies, geometry is retained. Positions are world
// coordinates in millimeters, Z up; angles radians; colors linear RGB. Nothing here knows of
// values of the language.

#ifndef CAG_INTERP_SCENE_H
#define CAG_INTERP_SCENE_H

#include "geom/curve/curve.h"
#include "geom/curve/region.h"
#include "geom/mesh/mesh.h"
#include "geom/solid/solid.h"
#include "geom/surface/surface.h"
#include "geom/tessellate/tessellate.h"

typedef struct CagColor {
  double r, g, b; // linear light
} CagColor;

// Color from "teal" (CSS names), "#0a8", "#00aa88": sRGB, made linear. False: no such color.
bool cag_color_from_text(const char *text, CagColor *out);
double cag_srgb_to_linear(double c);
double cag_linear_to_srgb(double c);

typedef struct CagMaterial {
  char *name; // for .mtl and comments; never NULL
  CagColor color;
  double metallic;     // 0..1
  double roughness;    // 0..1
  double ior;          // 1.5
  double transmission; // 0..1: share of light that passes
  CagColor emission;
  double coat;     // 0..1: clear glaze over the base
  char *texture;   // "" | "wood" | "marble" | "concrete" | "clay" ...: procedural pattern of the
                   // engines; never NULL
  CagColor color2; // second color of the pattern
  double texture_scale; // mm
  char *pov;            // POV-Ray texture text for that engine only; NULL: none
} CagMaterial;

typedef enum CagItemKind {
  CAG_ITEM_CURVE,
  CAG_ITEM_REGION,
  CAG_ITEM_SURFACE,
  CAG_ITEM_SOLID,
  CAG_ITEM_MESH,
  CAG_ITEM_GROUND
} CagItemKind;

// The material of a solid's operands or a mesh's triangles with a label.
typedef struct CagItemLabel {
  uint32_t label;
  size_t material; // index into materials
} CagItemLabel;

// One thing to draw; groups are taken apart. Names are unique within the scene ("vase", "vase.2").
typedef struct CagItem {
  CagItemKind kind;
  char *name;
  union {
    CagCurve *curve;
    CagRegion *region;
    CagSurface *surface;
    CagSolid *solid;
    CagMesh *mesh;
  } as;
  CagTransform placement; // REGION only: where its plane lies
  size_t material;        // index into materials
  CagItemLabel *labels;   // SOLID, MESH: its labels, ascending; others have the item's material
  size_t label_count;
  double tolerance;             // mm; 0: the scene's
  double line_radius;           // CURVE: 0: by the size of the scene
  double dash;                  // CURVE: length of dashes in mm; 0: none
  double ground_z, ground_size; // GROUND; size may be infinite
} CagItem;

// X(NAME, text): what is drawn at a label's place.
#define CAG_LABEL_MARKS(X)                                                                         \
  X(NONE, "none") X(DOT, "dot") X(CIRCLE, "circle") X(CROSS, "cross") X(ARROW, "arrow")
// X(NAME, text, x, y): where a label's text stands, as steps right and up from its place.
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
// Their words, ending with NULL.
extern const char *const cag_label_marks[];
extern const char *const cag_label_places[];

// A text or mark of flat pictures.
typedef struct CagLabel {
  char *text;
  CagVec3 at, along; // along: the direction of the text and of an arrow
  bool directed;     // there is one
  CagLabelPlace place;
  CagLabelMark mark;
  double size;     // height of the text, mm; 0: by the size of the picture
  size_t material; // index into materials
} CagLabel;

typedef struct CagCamera {
  char *name;
  CagVec3 eye, target, up; // up perpendicular to the view
  bool orthographic;
  double fov;             // horizontal, radians (perspective)
  double width;           // mm (orthographic)
  int size[2];            // pixels
  double focus, aperture; // mm, the aperture a lens's diameter; 0: everything is sharp
  bool mirrored;          // the picture is seen in a mirror: its frame is left-handed
  bool framed;            // stands where it sees everything, whatever the picture's shape
} CagCamera;

typedef enum CagLightKind {
  CAG_LIGHT_SUN,
  CAG_LIGHT_POINT,
  CAG_LIGHT_SPOT,
  CAG_LIGHT_AREA
} CagLightKind;
typedef struct CagLight {
  CagLightKind kind;
  CagVec3 position, direction; // direction: the way the light goes (unit)
  double angle;                // SPOT: full cone, radians
  double size;                 // AREA: side of its square, mm
  CagColor color;
  double strength; // 1: a white matte face perpendicular to it looks white
} CagLight;

typedef struct CagSky {
  size_t color_count; // colors from below to above; 0: none
  CagColor *colors;
  char *image; // path of an EXR; NULL: none
} CagSky;

typedef struct CagScene {
  CagItem *items;
  size_t item_count;
  CagItem *empties; // shown items of which nothing is left, taken out by cag_scene_complete
  size_t empty_count;
  CagLabel *labels;
  size_t label_count;
  CagMaterial *materials;
  size_t material_count; // 0 is the default material
  CagCamera *cameras;
  size_t camera_count; // after cag_scene_complete at least one
  CagLight *lights;
  size_t light_count;
  CagSky sky;
  bool has_background;
  CagColor background;
  CagBounds bounds; // of all items except grounds
  double tolerance; // mm: for items that say none; 0: by size of each
  size_t max_triangles;
  bool studio; // the studio set-up was added: no light was shown
  bool automatic_camera;
  char *script; // name of the script, for metadata
  const volatile int *interrupt;
} CagScene;

void cag_scene_free(CagScene *s);
// Index of the material of an item's triangles or operands with this label.
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
// Adds what is missing: a camera that frames everything (unless there is one), the studio light
// (unless there is a light or a sky that lights). Computes bounds, and takes out items that are
// empty; where these are all there is, nothing else is done.
CagStatus cag_scene_complete(CagScene *s, CagError *err);
// Moves a camera, keeping its direction, so that it frames all items for the shape of its picture
// (size): used by cag_scene_complete, and again when a picture of another size is asked for.
void cag_camera_frame_all(const CagScene *s, CagCamera *camera);
// The names of the standard views, NULL behind the last; and a camera of such a name, added behind
// the others. It frames what is shown, without perspective.
const char *cag_standard_view(size_t i);
CagStatus cag_scene_add_view(CagScene *s, const char *name, CagError *err);
// Bounds of an item under a transform (NULL: none); a ground has none.
CagStatus cag_item_bounds(const CagItem *item, const CagTransform *t, CagBounds *out,
                          CagError *err);
// The box to frame: where nothing is shown, some room about the origin; and half its diagonal.
CagBounds cag_scene_framed(const CagScene *s);
double cag_scene_radius(const CagBounds *b);
// Camera to world: columns x (right), y (down), z (view), origin.
CagTransform cag_camera_frame(const CagCamera *c);
// Tests whether the camera has depth of field. The rays of orthographic cameras are parallel.
bool cag_camera_has_lens(const CagCamera *c);
CagMaterial cag_material_default(void);

// Mesh of one item at its tolerance (curves as tubes of their line radius, regions flat), its
// closed parts outward; not of a ground. *out has one reference.
CagStatus cag_item_mesh(const CagScene *s, const CagItem *item, CagMesh **out, CagError *err);

#endif
