// The points in the calls that a shape was made by, and where they are in the scene.

#ifndef CAG_INTERP_SESSION_POINTS_H
#define CAG_INTERP_SESSION_POINTS_H

#include "interp/session/point_literals.h"
#include "interp/session/session.h"

typedef struct CagPointSpot {
  const CagOriginStep *step;
  const char *function;
  CagTransform map; // from the coordinates to the scene
  int dimension;
  double values[3];   // z = 0 in a plane
  CagLiteral literal; // in the script; unknown unless wanted
} CagPointSpot;

typedef struct CagPointSpots {
  CagPointSpot *items;
  size_t count, capacity;
} CagPointSpots;

// Finds the spots of a shape, always in the same order. They are valid until the script is called.
// `literals`: finds out where they stand in the script. Ends the run if memory is out.
void cag_point_spots(CagVm *vm, const CagShape *shape, bool literals, CagPointSpots *out);
CagVec3 cag_point_spot_at(const CagPointSpot *p);

// A param that can be solved for. `value` is in degrees for an angle.
typedef struct CagTrialParam {
  const char *name;
  size_t global;
  bool angle;
  double low, high, value;
} CagTrialParam;
// Returns param i (from 0) of the main script among those with a range of numbers or angles that
// has two ends. The params must have been listed. False: there is none.
bool cag_trial_param(const CagSession *s, size_t i, CagTrialParam *out);

// What a shown part would be if params were different. Between begin and end, definitions may have
// the values of a trial.
typedef struct CagTrial {
  CagSession *session;
  CagVm *vm;
  size_t shown, ordinal; // the part is this one of the shapes in this shown value
  CagValue *values;      // of all globals, as they were
  CagGlobalState *states;
  bool *given;
  size_t count, roots;
  CagCleanup cleanup;
} CagTrial;
void cag_trial_begin(CagTrial *t, CagSession *s, size_t part);
void cag_trial_end(CagTrial *t);
// Finds the spots of the part if params had other values: items[i].value. Returns false, without an
// error, if the script fails or the part is not there.
bool cag_trial_spots(CagTrial *t, const CagTrialParam *items, size_t n, CagPointSpots *out);

// The lists and trials of work on the points of a part. The lists are freed when the work has
// ended, also if it was abandoned.
typedef struct CagPointWork {
  CagSession *session;
  size_t part;
  CagPointSpots spots, moved;
  CagTrial trial;
} CagPointWork;
// Whether there is such a part, and it is a shape.
bool cag_points_of_part(const CagSession *s, size_t part);
// Does work of the session on the points of a part, with a time limit of its own.
int cag_points_work(CagSession *s, bool (*work)(CagVm *vm, void *context), CagPointWork *w,
                    void *context);

#endif
