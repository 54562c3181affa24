// Values of the language.
//
// A CagValue is a tag and either an immediate value (none, bool, number, angle) or a pointer to an
// object on the heap. Values are immutable once a script can reach them. Objects start with a
// CagObject header and are garbage-collected (see heap.h). Memory is reclaimed only at safe points,
// so a built-in that does not call back into the script may keep values in plain C variables. One
// that calls back (cag_call) must keep values that it needs afterwards on the root stack
// (cag_root_push / cag_root_pop).

#ifndef CAG_INTERP_VM_VALUE_H
#define CAG_INTERP_VM_VALUE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/guard.h"
#include "base/source.h"
#include "base/string.h"
#include "geom/curve/curve.h"
#include "geom/curve/region.h"
#include "geom/image/raster.h"
#include "geom/linalg/transform.h"
#include "geom/mesh/mesh.h"
#include "geom/robot/robot.h"
#include "geom/solid/solid.h"
#include "geom/surface/surface.h"

typedef struct CagVm CagVm;
typedef struct CagObject CagObject;

// X(tag, name in type_of, name with its article in messages)
#define CAG_VALUE_TYPES(X)                                                                         \
  X(NONE, "none", "none")                                                                          \
  X(BOOL, "bool", "a bool")                                                                        \
  X(NUMBER, "number", "a number")                                                                  \
  X(ANGLE, "angle", "an angle")                                                                    \
  X(JET, "number", "a number") /* a number or angle with its derivatives: jet.h */                 \
  X(TEXT, "text", "a text")                                                                        \
  X(LIST, "list", "a list")                                                                        \
  X(RANGE, "range", "a range")                                                                     \
  X(RECORD, "record", "a record")                                                                  \
  X(CLOSURE, "function", "a function")                                                             \
  X(BUILTIN, "function", "a function")                                                             \
  X(TRANSFORM, "transform", "a transform")                                                         \
  X(CURVE, "curve", "a curve")                                                                     \
  X(REGION, "region", "a region")                                                                  \
  X(SURFACE, "surface", "a surface")                                                               \
  X(SOLID, "solid", "a solid")                                                                     \
  X(MESH, "mesh", "a mesh")                                                                        \
  X(LABEL, "label", "a label")                                                                     \
  X(GROUP, "group", "a group")                                                                     \
  X(PLANE, "plane", "a plane")                                                                     \
  X(LINK, "link", "a link")                                                                        \
  X(ROBOT, "robot", "a robot")                                                                     \
  X(CAMERA, "camera", "a camera")                                                                  \
  X(LIGHT, "light", "a light")                                                                     \
  X(SENSOR, "sensor", "a sensor")                                                                  \
  X(IMAGE, "image", "an image")                                                                    \
  X(SETTING, "setting", "a scene setting")                                                         \
  X(MODULE, "module", "a module")

typedef enum CagType {
#define X(tag, name, article) CAG_##tag,
  CAG_VALUE_TYPES(X)
#undef X
      CAG_TYPE_COUNT,
  // Internal tags, which scripts never see.
  CAG_UNSET = CAG_TYPE_COUNT, // an argument that was not given
  CAG_INTERNAL                // an object of the machine (list builder, iterator ...)
} CagType;

// Values of this and all following types have an object.
#define CAG_FIRST_OBJECT CAG_JET

typedef struct CagValue {
  CagType type;
  union {
    bool boolean;
    double number; // an angle is in degrees
    CagObject *object;
  } as;
} CagValue;

struct CagObject {
  uint8_t type;  // CagType
  uint8_t mark;  // mark of the last collection, and the depth of geometry callbacks in which it was
                 // made: see heap.c
  uint8_t small; // size class; 0: from malloc
  uint8_t flags;
  uint32_t hash;   // depends on the type
  CagObject *next; // list of large objects, or free list
};

// --- Text: UTF-8, NUL-terminated ---
typedef struct CagText {
  CagObject head;
  size_t length;     // bytes
  size_t characters; // code points
  bool interned;
  char bytes[];
} CagText;

// --- List ---
// dim 0: items are CagValues. dim 1: packed numbers. dim d >= 2: packed vectors of d numbers each
// (element k is numbers[k * d .. k * d + d)). The representation is canonical: a list of numbers
// always has dim 1, so a vector is a list with dim 1; a list of number lists that all have the same
// length 2..16 always has that length as dim; an empty list has dim 0. Data are inline, from
// malloc, or a part of another list's data (`owner`).
#define CAG_MAX_PACKED 16
typedef struct CagList {
  CagObject head;
  size_t length;
  uint32_t dim;
  bool allocated;        // the list owns its data, which are from malloc
  struct CagList *owner; // the list that owns the data; NULL: this one
  union {
    CagValue *items;
    double *numbers;
    void *data;
  } as;
} CagList;

// Checks the invariants: a list that refers to a part of another's data has no data of its own, and
// the other list has data, in the same representation. For CAG_ASSERT and tests.
bool cag_check_list(const CagList *l);

// --- Range ---
typedef struct CagRange {
  CagObject head;
  double start, end, step;   // in degrees if `angle`
  bool angle, open, stepped; // stepped: it has a `by`
} CagRange;

// --- Record ---
// Fields keep their order. Records made at one location share their layout (the names).
typedef struct CagLayout {
  CagObject head; // CAG_INTERNAL
  size_t count;
  uint32_t *index; // open-addressing table when count > 8, else NULL
  size_t index_size;
  CagText *names[]; // interned
} CagLayout;
typedef struct CagRecord {
  CagObject head;
  CagLayout *layout;
  CagValue fields[];
} CagRecord;

// --- Functions ---
// A closure holds copies of the values that it captured, which never change.
struct CagProto;
typedef struct CagClosure {
  CagObject head;
  const struct CagProto *proto;
  size_t capture_count;
  CagValue captures[];
} CagClosure;
typedef struct CagBuiltinValue {
  CagObject head;
  size_t index; // in the table of built-ins
} CagBuiltinValue;

typedef struct CagTransformValue {
  CagObject head;
  CagTransform t;
} CagTransformValue;

typedef struct CagPlaneValue {
  CagObject head;
  CagPlane plane;
} CagPlaneValue;

// --- Shapes ---
// A reference to the geometry, and attributes. A shape is copied to change an attribute or the
// placement.

// A text at a point.
typedef struct CagLabelText {
  CagObject head; // CAG_INTERNAL
  CagText *text;
  CagVec3 at, along; // along: the direction of the text, zero if it has none
  int place, mark;   // CagLabelPlace and CagLabelMark (interp/scene/scene.h)
  double size;       // mm; 0: by the size of the picture
} CagLabelText;

// How curves are drawn.
typedef struct CagLineStyle {
  bool set;            // line_style was called
  double radius, dash; // 0: not set
} CagLineStyle;

// The transform by which a call moved a shape. Most are translations or affine, for which fewer
// numbers are enough.
typedef struct CagMotionNote {
  CagObject head;  // CAG_INTERNAL
  uint8_t numbers; // 3: a translation, 12: affine, 16
  uint8_t given;   // coordinates of the vector that the call was given, if it is `translate`
  bool planar, in_front;
  double m[]; // `numbers` of them, by rows; then the vector if it is another one
} CagMotionNote;

// The curves, regions, and surfaces that a call made a shape of, such as the profile of a
// revolution.
typedef struct CagInputs {
  CagObject head; // CAG_INTERNAL
  size_t count;
  struct CagInput {
    size_t parameter; // index of the argument that is the shape, or a list with it
    CagValue shape;
  } items[];
} CagInputs;

// What a call did with the shape before it.
typedef enum CagStepKind {
  CAG_STEP_SHAPED, // made another shape of it, or of `inputs`
  CAG_STEP_MOVED,  // moved it by `motion`
  CAG_STEP_SAID    // gave it attributes
} CagStepKind;

// What is kept of the arguments of a call that made shapes: points and vectors, and the last steps
// of shapes (CAG_INTERNAL). Everything else is CAG_UNSET.
typedef struct CagOriginCall {
  CagObject head; // CAG_INTERNAL
  size_t count;   // by parameter, up to the last one that is kept
  CagValue values[];
} CagOriginCall;

// A place where the script calls a built-in. The steps that are made there share it.
struct CagBuiltin;
typedef struct CagOriginSite {
  CagObject head; // CAG_INTERNAL
  const CagSource *source;
  CagSpan span;
  const CagSource *caller; // in the library: the nearest call outside of it; else NULL
  CagSpan caller_span;
  const struct CagBuiltin *row; // what is called; NULL: an operator
  size_t index;                 // of its name
} CagOriginSite;

// A call of the script that a shape went through, which made it, moved it, or gave it an attribute.
// A script may have millions of them.
typedef struct CagOriginStep {
  CagObject head; // CAG_INTERNAL
  CagOriginSite *site;
  struct CagOriginStep *before; // the call before this one; NULL: this one made the shape
  union {
    CagMotionNote *motion; // MOVED
    CagInputs *inputs;     // SHAPED; NULL: none, or not kept
  } as;
  uint8_t kind;          // CagStepKind
  uint8_t depth;         // number of calls before it
  uint8_t held;          // levels of shapes that are kept by inputs of inputs, here and before
  bool called;           // whether there is `call`
  CagOriginCall *call[]; // its arguments, if any are kept: see cag_step_call
} CagOriginStep;

// The inputs, motion, and arguments of a step, each NULL if there are none.
static inline const CagInputs *cag_step_inputs(const CagOriginStep *s) {
  return s->kind == CAG_STEP_SHAPED ? s->as.inputs : NULL;
}
static inline const CagMotionNote *cag_step_motion(const CagOriginStep *s) {
  return s->kind == CAG_STEP_MOVED ? s->as.motion : NULL;
}
static inline const CagOriginCall *cag_step_call(const CagOriginStep *s) {
  return s->called ? s->call[0] : NULL;
}

// The most calls that are kept. Of more, those in between are dropped: first the latest ones.
enum { CAG_ORIGIN_DEPTH = 12 };
// The most levels of inputs that are kept, so that a loop that reshapes a curve again and again
// does not keep all of its curves.
enum { CAG_INPUTS_DEPTH = 6 };

// Where a shape comes from in the script.
typedef struct CagOrigin {
  CagOriginStep *last;          // NULL: not made by a call
  CagText *definition;          // the definition whose value it first was; NULL: none
  struct CagOperands *operands; // SOLID: of the operands of its set operation; NULL: unknown
} CagOrigin;

// Where the operands of a set operation come from, in the order of those of the solid's core. The
// first ones may be those of another operation, which was flattened into this one: a loop that adds
// one operand in each round does not copy the others.
typedef struct CagOperands {
  CagObject head; // CAG_INTERNAL
  size_t count;   // of all
  struct CagOperands *first;
  CagOrigin items[]; // the others
} CagOperands;

// The shape that was moved to make another one, and the rigid motion between them. The mesh of what
// only moves is made once.
struct CagShape;
typedef struct CagStill {
  CagObject head; // CAG_INTERNAL
  struct CagShape *shape;
  CagMotionNote *motion;
} CagStill;

// The joint values with which a robot was drawn.
typedef struct CagPosture {
  CagObject head; // CAG_INTERNAL
  struct CagRobotValue *robot;
  double q[]; // one per joint, in radians and millimeters
} CagPosture;

// A shape of a drawing of a robot, and what it moves with if the joint values change.
typedef struct CagLimb {
  CagObject head; // CAG_INTERNAL
  CagPosture *posture;
  size_t number;       // of the shape in the drawing
  size_t frame;        // of the chain, as cag_robot_frames counts them; the one after: the tool
  size_t section;      // the rod that ends at this point of the skeleton; 0: not a rod
  CagTransform motion; // affine, from the drawing to where the shape is
} CagLimb;

typedef struct CagShape {
  CagObject head;
  union {
    CagCurve *curve;
    CagRegion *region;
    CagSurface *surface;
    CagSolid *solid;
    CagMesh *mesh;
    CagLabelText *label;
    CagList *items; // GROUP: list of shapes (dim 0)
  } as;
  CagRecord *material; // NULL: not set
  CagText *name;       // NULL: not set
  CagRecord *frames;   // transforms, which move with the shape; NULL: none
  CagOrigin origin;
  CagText *model;        // the definition of the shape that was moved to make this one; NULL: none
  CagMotionNote *motion; // by the call that is not in its origin yet; NULL: it did not move
  CagStill *still;       // CURVE, SURFACE, SOLID, MESH: NULL if it was not moved
  CagLimb *limb;         // NULL: not of a robot, or changed since it was drawn
  CagLineStyle line;     // of curves
  double tolerance;      // 0: not set
  struct CagRobotValue *drawn; // GROUP: the robot of which this is the drawing; NULL
  bool hidden;
  bool fresh;               // the call that makes it has not been added to its origin yet
  bool copied;              // while fresh: it has the geometry of an argument of that call
  CagTransform placement[]; // REGION: one, from z = 0 to the plane of the region; other shapes,
                            // which are transformed themselves, have none
} CagShape;

// --- Cameras, lights, and settings (sky, background, ground) ---
// Records with a kind, checked when they are made.
typedef struct CagSceneValue {
  CagObject head;
  const char *kind;  // "perspective", "sun", "point", "spot", "area", "sky", "background", "ground"
  CagRecord *fields; // all arguments by name, including defaults; colors as [r, g, b] in linear
                     // light
  CagTransform placement; // the scene builder applies it to eye, target, direction ...
  bool mirrored; // a camera transformed by an odd number of reflections: its picture is mirrored
} CagSceneValue;

// --- Robots ---
typedef struct CagLinkValue {
  CagObject head;
  CagRobotLink link;
  CagValue shape; // drawn in the frame after the link: a shape, a list of shapes, or none
} CagLinkValue;
typedef struct CagRobotValue {
  CagObject head;
  CagRobot *robot; // holds one reference
  CagText *name;   // may be empty
  CagList *links;  // of link values
} CagRobotValue;

// --- Images ---
typedef struct CagImageValue {
  CagObject head;
  CagRaster *raster; // holds one reference
  CagList *parts;    // names of the parts whose numbers it shows; NULL: it shows something else
  CagText *name;     // NULL: not set
} CagImageValue;

typedef struct CagModuleValue {
  CagObject head;
  size_t module; // index in the program
} CagModuleValue;

// --- Constructors ---
static inline CagValue cag_none(void) { return (CagValue){CAG_NONE, {.number = 0}}; }
static inline CagValue cag_bool(bool b) { return (CagValue){CAG_BOOL, {.boolean = b}}; }
static inline CagValue cag_number(double x) { return (CagValue){CAG_NUMBER, {.number = x}}; }
static inline CagValue cag_angle(double degrees) {
  return (CagValue){CAG_ANGLE, {.number = degrees}};
}
static inline CagValue cag_unset(void) { return (CagValue){CAG_UNSET, {.number = 0}}; }
static inline CagValue cag_object(CagType type, void *o) {
  return (CagValue){type, {.object = (CagObject *)o}};
}
static inline bool cag_is_shape(CagValue v) { return v.type >= CAG_CURVE && v.type <= CAG_GROUP; }
static inline bool cag_is_function(CagValue v) {
  return v.type == CAG_CLOSURE || v.type == CAG_BUILTIN;
}
#define CAG_AS_TEXT(v) ((CagText *)(v).as.object)
#define CAG_AS_LIST(v) ((CagList *)(v).as.object)
#define CAG_AS_RANGE(v) ((CagRange *)(v).as.object)
#define CAG_AS_RECORD(v) ((CagRecord *)(v).as.object)
#define CAG_AS_CLOSURE(v) ((CagClosure *)(v).as.object)
#define CAG_AS_BUILTIN(v) ((CagBuiltinValue *)(v).as.object)
#define CAG_AS_TRANSFORM(v) ((CagTransformValue *)(v).as.object)
#define CAG_AS_PLANE(v) ((CagPlaneValue *)(v).as.object)
#define CAG_AS_SHAPE(v) ((CagShape *)(v).as.object)
#define CAG_AS_SCENE(v) ((CagSceneValue *)(v).as.object)
#define CAG_AS_LINK(v) ((CagLinkValue *)(v).as.object)
#define CAG_AS_ROBOT(v) ((CagRobotValue *)(v).as.object)
#define CAG_AS_IMAGE(v) ((CagImageValue *)(v).as.object)
#define CAG_AS_MODULE(v) ((CagModuleValue *)(v).as.object)

CagValue cag_text_new(CagVm *vm, const char *bytes, size_t length); // valid UTF-8; copies
CagValue cag_text_joined(CagVm *vm, const CagText *a, const CagText *b);
CagValue cag_text_c(CagVm *vm, const char *s);
CagText *cag_intern(CagVm *vm, const char *bytes,
                    size_t length); // interned: one text for equal bytes, which lives as long as
                                    // the machine

// Makes a list of n numbers (dim 1). The caller must set the numbers immediately.
CagValue cag_list_numbers(CagVm *vm, size_t n, double **numbers);
// Makes a list of n vectors of d numbers, d in 2..CAG_MAX_PACKED.
CagValue cag_list_vectors(CagVm *vm, size_t n, size_t d, double **numbers);
// Makes a list of n values, which are copied, and packs it if all are numbers, or vectors of the
// same length.
CagValue cag_list_values(CagVm *vm, const CagValue *values, size_t n);
CagValue cag_vector(CagVm *vm, const double *x, size_t n);
CagValue cag_point(CagVm *vm, CagVec3 p, int dimension);                      // [x, y] or [x, y, z]
CagValue cag_list_slice(CagVm *vm, CagValue list, size_t from, size_t count); // shares the data
// Returns element i, without a check of the index, of a list in any representation.
CagValue cag_list_get(CagVm *vm, const CagList *l, size_t i);

// A growing list: add values, then finish it, which packs it. If the script is called in between,
// the caller must root it (cag_builder_value).
typedef struct CagBuilder {
  CagObject head; // CAG_INTERNAL
  size_t length, capacity;
  uint32_t dim; // representation so far; 0 and mixed: values
  bool mixed;
  void *data;
} CagBuilder;
CagBuilder *cag_builder_new(CagVm *vm);
// Returns false, with the error set, if the run must stop, which is checked every so often. If
// memory runs out, the run ends by a long jump.
bool cag_builder_add(CagVm *vm, CagBuilder *b, CagValue v);
CagValue cag_builder_finish(CagVm *vm, CagBuilder *b);
static inline CagValue cag_builder_value(CagBuilder *b) { return cag_object(CAG_INTERNAL, b); }

CagValue cag_range_new(CagVm *vm, double start, double end, double step, bool angle, bool open,
                       bool stepped);
// Counts the elements as a list. Returns false, with the error set, for an unbounded range.
bool cag_range_count(CagVm *vm, const CagRange *r, size_t *count);
double cag_range_element(const CagRange *r, size_t k, size_t count);

// Makes a record with these names (C strings) and values.
CagValue cag_record_new(CagVm *vm, const char *const *names, const CagValue *values, size_t n);
CagValue cag_record_from_texts(CagVm *vm, CagText *const *names, const CagValue *values,
                               size_t n); // names distinct
CagLayout *cag_layout_new(CagVm *vm, CagText *const *names,
                          size_t n);                                 // names interned and distinct
size_t cag_layout_find(const CagLayout *l, const CagText *interned); // (size_t)-1: none
CagValue cag_record_with_layout(CagVm *vm, CagLayout *l, const CagValue *values);
// Returns the value of a field, or CAG_UNSET.
CagValue cag_record_get(const CagRecord *r, const char *name);
CagValue cag_record_get_text(CagVm *vm, const CagRecord *r, const CagText *name);

CagValue cag_transform_value(CagVm *vm, const CagTransform *t);
CagValue cag_plane_value(CagVm *vm, const CagPlane *p);
// The shape takes over the caller's reference.
CagValue cag_curve_value(CagVm *vm, CagCurve *c);
CagValue cag_region_value(CagVm *vm, CagRegion *r, const CagTransform *placement); // NULL: identity
CagValue cag_surface_value(CagVm *vm, CagSurface *s);
CagValue cag_solid_value(CagVm *vm, CagSolid *s);
CagValue cag_mesh_value(CagVm *vm, CagMesh *m);
CagValue cag_image_value(CagVm *vm, CagRaster *r);
CagValue cag_label_value(CagVm *vm, const CagLabelText *like); // copies all but the header
CagValue cag_group_value(CagVm *vm, CagValue list);            // list of shapes
// Adds a call to an origin, which is changed in place. `like` is all but its `before` and what
// follows from that.
void cag_origin_add(CagVm *vm, CagOrigin *o, const CagOriginStep *like, CagOriginCall *call);
// Notes that the call under way made a shape by moving another one, for its origin.
void cag_shape_note_motion(CagVm *vm, CagValue moved, CagValue from, const CagTransform *motion);
// Makes a note. `vector` is what the call was given, if it is `translate`, of `given` coordinates; 0:
// it is another call.
CagMotionNote *cag_motion_note(CagVm *vm, const CagTransform *t, const double *vector,
                               size_t given);
size_t cag_motion_bytes(const CagMotionNote *note); // its size
CagTransform cag_motion_transform(const CagMotionNote *note);
// The vector that `translate` was given, of 2 or 3 coordinates; 0: it was another call.
size_t cag_motion_vector(const CagMotionNote *note, double out[3]);
// Where the operands `first` (NULL: none) and n further ones come from, which are unknown.
CagOperands *cag_operands_new(CagVm *vm, CagOperands *first, size_t n);
// Copies the origins of all operands to a list of o->count.
void cag_operands_list(const CagOperands *o, CagOrigin *out);
// Notes that a shape is another one after a rigid motion.
void cag_shape_moved(CagVm *vm, CagValue moved, CagValue from, const CagTransform *motion);
// Notes that `moved` is the image of the limb `from` by an affine map.
void cag_limb_moved(CagVm *vm, CagValue moved, CagValue from, const CagTransform *motion);
CagPosture *cag_posture_new(CagVm *vm, struct CagRobotValue *robot, const double *q);
CagLimb *cag_limb_new(CagVm *vm, const CagLimb *like); // everything but the head is copied
CagValue cag_shape_copy(CagVm *vm, CagValue shape); // same geometry (retained) and attributes; the
                                                    // caller may change the copy
CagValue cag_scene_value(CagVm *vm, CagType type, const char *kind, CagValue record);
CagValue cag_link_value(CagVm *vm, const CagRobotLink *link, CagValue shape);
// Takes over the caller's reference. `links` is a list of link values.
CagValue cag_robot_value(CagVm *vm, CagRobot *r, CagText *name, CagValue links);

// --- Queries ---
const char *cag_type_name(CagValue v);             // "number"
const char *cag_type_article(CagValue v);          // "a number"
bool cag_equal(CagVm *vm, CagValue a, CagValue b); // ==

// Reads a list of numbers as doubles.
bool cag_as_vector(CagValue v, const double **x, size_t *n); // a list with dim 1 (not empty)
// Converts a range to a list; lists are returned unchanged. Texts and records are rejected. Returns
// false if an error was set.
bool cag_as_list(CagVm *vm, CagValue v, CagValue *list);

// --- Printed form (language, section 7) ---
// Ends the run if the string has failed.
void cag_string_check(CagVm *vm, CagString *s);
CagValue cag_text_from_string(CagVm *vm, CagString *s); // frees s
CagText *cag_intern_string(CagVm *vm, CagString *s);    // frees s
// Tests whether a text fits in the machine's memory, and sets the error if it does not. Call this
// while a text grows: the printed form of a value with shared parts may be much longer than the
// value.
bool cag_string_fits(CagVm *vm, const CagString *s);
void cag_print_number(CagString *s, double x);
// `quoted`: prints texts in quotes, as inside lists and records.
void cag_print_value(CagVm *vm, CagString *s, CagValue v, bool quoted);
// Adds the type and, if it is short, the value, for messages: "the number 30", "the text \"a\"", "a
// list of 3 elements".
void cag_describe_value(CagVm *vm, CagString *s, CagValue v);

#endif
