// What the built-ins of measures, filters, and templates of images share.

#ifndef CAG_INTERP_BUILTIN_IMAGE_CALLS_H
#define CAG_INTERP_BUILTIN_IMAGE_CALLS_H

#include "geom/image/moments.h"
#include "interp/builtin/images.h"
#include "interp/builtin/shapes.h"
#include "interp/builtin/support.h"

// Fails with "several-channels" unless the image has a single channel.
bool cag_gray_image(CagCall *call, int argument, const CagRaster *r);
// Reads an image with a single channel, or a region of the plane, which the call holds.
bool cag_arg_mass(CagCall *call, int argument, CagMass mass, CagMassOf *out);
// Reads the number of neighbors, 8 or 4; 8 by default.
bool cag_arg_connectivity(CagCall *call, int argument, int *out);
// Reads the odd side of a window.
bool cag_odd_size(CagCall *call, int argument, long size);

// Holds an image that the core has made. The call of the core is an argument before it, so this
// takes the address.
bool cag_hold_image(CagCall *call, CagStatus status, CagRaster **made);

// A point of the plane.
CagValue cag_xy(CagVm *vm, double x, double y);

#endif
