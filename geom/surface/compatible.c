// Brings two NURBS curves to one knot vector (Piegl and Tiller 1997, section 8.4): both are clamped
// over 0..1, the lower degree is elevated, and missing knots are inserted. The shapes do not
// change.

#include "geom/surface/compatible.h"

#include "base/memory.h"
#include "geom/surface/net.h"

CagStatus cag_curves_compatible(const CagCurve *a, const CagCurve *b, CagCompatible *out,
                                CagError *err) {
  CagNet nets[2] = {{0}, {0}};
  CagStatus status = cag_net_of_curve(a, &nets[0], err);
  if (!status) status = cag_net_of_curve(b, &nets[1], err);
  if (!status) status = cag_nets_unify(nets, 2, err);
  if (status) {
    cag_net_free(&nets[0]);
    cag_net_free(&nets[1]);
    return status;
  }
  *out =
      (CagCompatible){nets[0].degree, nets[0].count, nets[0].knots, {nets[0].data, nets[1].data}};
  cag_free(nets[1].knots);
  return CAG_OK;
}

void cag_compatible_free(CagCompatible *c) {
  cag_free(c->knots);
  cag_free(c->net[0]);
  cag_free(c->net[1]);
  *c = (CagCompatible){0};
}
