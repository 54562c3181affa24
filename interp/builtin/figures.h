// Functions of the table of figures (figures.c).

#ifndef CAG_INTERP_BUILTIN_FIGURES_H
#define CAG_INTERP_BUILTIN_FIGURES_H

#include "interp/builtin/shapes.h"

bool cag_figures_label(CagCall *call, CagValue *result);
bool cag_figures_surface_normals(CagCall *call, CagValue *result);

#endif
