// Locations in scripts as JSON.

#ifndef CAG_LIVE_PLACE_JSON_H
#define CAG_LIVE_PLACE_JSON_H

#include "cag.h"
#include "live/json_write.h"

// Adds the fields of a location to an object.
void cag_live_place(CagJson *j, const CagPlaceView *p);

#endif
