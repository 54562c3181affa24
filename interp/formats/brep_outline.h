// Outlines of lines and arcs, and the builder of the solids that they make by moving and turning.

#ifndef CAG_INTERP_FORMATS_BREP_OUTLINE_H
#define CAG_INTERP_FORMATS_BREP_OUTLINE_H

#include "interp/formats/brep.h"

// A line, or an arc, in a plane (z = 0).
typedef struct CagFormPiece {
  CagVec3 from, to;
  bool round; // an arc: the fields below are valid
  bool left;  // it turns to the left from `from` to `to`
  CagVec3 center;
  double radius;
  double start, sweep; // radians: counter-clockwise from one of its ends to the other
} CagFormPiece;

typedef struct CagFormOutline {
  CagFormPiece *items;
  size_t count, room;
} CagFormOutline;

void cag_form_outline_free(CagFormOutline *o);
CagStatus cag_form_outline_line(CagFormOutline *o, CagVec3 from, CagVec3 to, CagError *err);
// radians; sweep > 0: to the left
CagStatus cag_form_outline_arc(CagFormOutline *o, CagVec3 center, double radius, double start,
                               double sweep, CagError *err);
// Adds the pieces of a plane curve. *fits is set to false if it has others than lines and arcs.
CagStatus cag_form_outline_curve(CagFormOutline *o, const CagCurve *c, bool *fits, CagError *err);
// Reverses the outline, if need be, so that its inside is on its left, or on its right.
void cag_form_outline_turn(CagFormOutline *o, bool left);

// The solid under construction, in the coordinates of an orthonormal frame. The first error stays,
// and nothing is added after it.
typedef struct CagFormWork {
  CagBrep *brep;
  CagTransform frame;
  CagStatus status;
  CagError *err;
} CagFormWork;

size_t cag_form_corner(CagFormWork *w, CagVec3 p);
// The parameter runs from t0 to t1.
size_t cag_form_line(CagFormWork *w, size_t from, size_t to, double t0, double t1);
// A circle about z with angles from x, between two angles.
size_t cag_form_arc(CagFormWork *w, CagVec3 center, CagVec3 x, CagVec3 z, double radius, double t0,
                    double t1, size_t from, size_t to);
size_t cag_form_pole(CagFormWork *w, size_t corner);
// A face on a carrier of a kind, with its origin, x, and z; a and b as in CagCarrier. Loops, and
// the uses of each, follow.
void cag_form_face(CagFormWork *w, CagCarrierKind kind, CagVec3 origin, CagVec3 x, CagVec3 z,
                   double a, double b, bool reversed, const double domain[4]);
void cag_form_loop(CagFormWork *w);
// trace: u and v at both ends of the edge's curve, whose parameter runs from t0 to t1; NULL: none.
void cag_form_use(CagFormWork *w, size_t edge, bool reversed, const double trace[4], double t0,
                  double t1);
// Makes a shell of all faces from the first one on.
void cag_form_shell(CagFormWork *w, size_t first);

// Adds a prism between z = 0 and z = height > 0, with a shell for each outer outline. outer: the
// index of the outline around each one, or its own. The outlines have the inside on their left.
void cag_form_prism(CagFormWork *w, const CagFormOutline *outlines, const size_t *outer, size_t n,
                    double height);
// Whether the pieces of an outline in the half plane x >= 0 turn to planes, cylinders, cones,
// spheres, and tori. Coordinates up to `near` from the axis are set to 0.
bool cag_form_outline_turns(CagFormOutline *o, double near);
// Adds the outline turned about z, its x over the axis and its y along it, between two angles. The
// inside is on its left.
void cag_form_turned(CagFormWork *w, const CagFormOutline *o, double from, double to);

#endif
