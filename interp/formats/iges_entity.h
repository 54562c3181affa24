// Entities of IGES files (IGES 5.3), as lines of the directory and of the parameters.
//
// An entity is begun, its parameters are written one by one, and it is ended. Entities to which it
// refers come first. An entity is referred to by the number of its first directory line.

#ifndef CAG_INTERP_FORMATS_IGES_ENTITY_H
#define CAG_INTERP_FORMATS_IGES_ENTITY_H

#include "base/atomic_file.h"
#include "interp/formats/brep.h"

// Columns of parameters in a line, which are followed by the number of the directory line.
#define CAG_IGES_PARAMETER_COLUMNS 64
#define CAG_IGES_GLOBAL_COLUMNS 72

typedef long CagIgesPointer; // number of a directory line; 0: none

// The state of the writer.
typedef struct CagIges {
  const CagBrep *brep;
  CagAtomicFile *directory, *parameters;
  char line[81];
  size_t column, width;  // of the current line
  CagIgesPointer entity; // whose parameters are being written; 0: the global section
  long parameter_lines, first_line, entities;
  int type, form, status;
  CagIgesPointer matrix;      // of the next entity, which is in its coordinates; 0: none
  CagIgesPointer color, name; // of the entities that follow
  bool undefined;             // a number was not finite
} CagIges;

// The digits of the status: visibility, dependence (01: part of another), use (05: in parameters of
// a surface, 02: definition), hierarchy.
enum {
  CAG_IGES_FREE = 0,
  CAG_IGES_PART = 10000,
  CAG_IGES_PART_FLAT = 10500,
  CAG_IGES_PART_DEFINITION = 10200,
  CAG_IGES_DEFINITION = 200
};

CagIgesPointer cag_iges_begin(CagIges *w, int type, int form, int status);
// `named`: with the writer's name as a property.
void cag_iges_end(CagIges *w, bool named);
void cag_iges_end_line(CagIges *w);

// --- Parameters ---
void cag_iges_integer(CagIges *w, long x);
void cag_iges_pointer(CagIges *w, CagIgesPointer p);
void cag_iges_real(CagIges *w, double x);
void cag_iges_string(CagIges *w, const char *text);
void cag_iges_point(CagIges *w, CagVec3 p);

// --- Whole entities ---
CagIgesPointer cag_iges_color(CagIges *w, CagColor c);
CagIgesPointer cag_iges_name(CagIges *w, const char *text);
// A curve of a NURBS kind. `flat`: in the parameters of a surface.
CagStatus cag_iges_nurbs_curve(CagIges *w, const CagCurve *c, bool flat, int use,
                               CagIgesPointer *out, CagError *err);
CagIgesPointer cag_iges_nurbs_surface(CagIges *w, const CagSurface *s, int status);

// The curve in space and its parameter: the point that the curve has at t is at scale t + shift.
typedef struct CagIgesCurve {
  CagIgesPointer at;
  double scale, shift;
  bool bent; // there is no such map
} CagIgesCurve;
// A line (entity 110), whose parameter runs from 0 to 1.
CagIgesPointer cag_iges_line(CagIges *w, CagVec3 from, CagVec3 to);
// Whether a curve is a whole ellipse that does not start on its longer axis. Readers take a closed
// conic arc (entity 104) as an ellipse that starts there, so it must be written as a NURBS curve.
bool cag_iges_is_offset_ellipse(const CagCurve *c);
// A line of degree 1, an arc, or a curve of a NURBS kind.
CagStatus cag_iges_curve(CagIges *w, const CagCurve *c, CagIgesCurve *out, CagError *err);

#endif
