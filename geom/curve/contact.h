// Where a curve meets something else, found many times over: near a touch it is within rounding of
// the other for a while, and every search finds places all along.

#ifndef CAG_GEOM_CONTACT_H
#define CAG_GEOM_CONTACT_H

#include "geom/curve/curve.h"

typedef struct CagContact {
  double t, at[2]; // the curve's parameter, and the other's
  CagVec3 point;
  int multiplicity;
} CagContact;

// The curve and what it meets.
typedef struct CagContactTask {
  const CagCurve *c;
  void *context;
  // Distance of the curve's point at t from the other, from the foot found near `at`, which it
  // updates; and the sine of the angle between the two there.
  CagStatus (*measure)(void *context, double t, double at[2], double *gap, double *sine,
                       CagError *err);
  int places; // parameters of the other: 0 to 2
  double low[2], high[2];
  bool closed[2];
  double same; // distance below which the two meet
  double size, noise;
} CagContactTask;

// Sorts, and makes one of what belongs together: contacts between which the curve stays within
// `same` of the other. Where the curve is tangential there, the contact becomes the place where it
// is so, with the order of contact as its multiplicity (2: it touches; 1: it crosses). *overlap:
// the curve runs along the other, to rounding, from one contact to the next of a group.
CagStatus cag_contacts_merge(const CagContactTask *task, CagContact *items, size_t *n,
                             bool *overlap, CagError *err);

#endif
