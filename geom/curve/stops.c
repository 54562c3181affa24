// Removes intervals of the parameter on which a curve rests in one point.
//
// A polyline with a repeated vertex, or a joined curve with a piece of zero length, has no
// direction there. A sweep does not need one: it continues from the moving part before to the one
// after, whose parameter ranges are extended over the stop.

#include "base/memory.h"
#include "geom/curve/family.h"

// Whether the curve rests in one point over [a, b].
static bool rests(const CagCurve *c, double a, double b, double size) {
  const CagBounds box = c->kind->hull(c, a, b);
  return cag_norm(cag_sub(box.max, box.min)) <= CAG_CURVE_SAME * size;
}

// The part over [a, b], reparametrized to [from, to].
static CagStatus stretched(const CagCurve *c, double a, double b, double from, double to,
                           CagCurve **out, CagError *err) {
  CagCurve *part;
  CagStatus status = cag_curve_trim(c, a, b, &part, err);
  if (status) return status;
  status = cag_curve_reparametrize_as(part, from, to, c->angular, out, err);
  cag_curve_release(part);
  return status;
}

CagStatus cag_curve_without_stops(const CagCurve *c, CagCurve **out, CagError *err) {
  const CagBounds box = c->kind->hull(c, c->start, c->end);
  const double size = cag_norm(cag_sub(box.max, box.min));
  double *cuts;
  size_t n, moving = 0, runs = 0;
  CagStatus status = cag_curve_cuts(c, &cuts, &n, err);
  if (status) return status;
  bool *stop = cag_calloc(n, sizeof *stop);
  CagCurve **parts = cag_calloc(n, sizeof *parts);
  if (!stop || !parts) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i + 1 < n; i++) {
    stop[i] = rests(c, cuts[i], cuts[i + 1], size);
    moving += !stop[i];
  }
  if (!status && moving == 0) { // not a path
    *out = cag_curve_retain(c);
  } else if (!status) {
    double from = c->start; // start of the part, including the stop before it
    for (size_t i = 0; !status && i + 1 < n; i++) {
      if (stop[i]) continue;
      size_t last = i;
      while (last + 2 < n && !stop[last + 1]) last++;
      size_t next = last + 1;
      while (next + 1 < n && stop[next]) next++;
      const double to = next + 1 < n ? cuts[last + 1] : c->end;
      status = stretched(c, cuts[i], cuts[last + 1], from, to, &parts[runs], err);
      runs += !status;
      from = to;
      i = last;
    }
    if (!status) status = cag_curve_join(parts, runs, out, err);
  }
  for (size_t i = 0; parts && i < runs; i++) cag_curve_release(parts[i]);
  cag_free(parts);
  cag_free(stop);
  cag_free(cuts);
  return status;
}
