// Merging of the contacts of a curve with another object. Near a tangency the curve stays within
// rounding of the object for a while, and a search finds contacts all along that stretch.

#ifndef CAG_GEOM_CONTACT_H
#define CAG_GEOM_CONTACT_H

#include "geom/curve/curve.h"

typedef struct CagContact {
  double t, at[2]; // the curve's parameter, and the object's parameters
  CagVec3 point;
  int multiplicity;
} CagContact;

// The curve and the object that it meets.
typedef struct CagContactTask {
  const CagCurve *c;
  void *context;
  // The distance of the curve's point at t from the object, measured to the foot point found near
  // `at`, which is updated; and the sine of the angle between the two there.
  CagStatus (*measure)(void *context, double t, double at[2], double *gap, double *sine,
                       CagError *err);
  int places; // number of parameters of the object: 0 to 2
  double low[2], high[2];
  bool closed[2];
  double same; // distance below which the two meet
  double size, noise;
} CagContactTask;

// Sorts the contacts, and merges those between which the curve stays within `same` of the object.
// If the curve is tangential in between, the merged contact is the point of tangency, with the
// order of contact as its multiplicity (2: it touches; 1: it crosses). *overlap: the curve
// coincides with the object, to rounding, between two contacts of a group.
CagStatus cag_contacts_merge(const CagContactTask *task, CagContact *items, size_t *n,
                             bool *overlap, CagError *err);

#endif
