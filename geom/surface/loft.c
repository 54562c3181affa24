// Lofts: compatible sections, interpolated across by a spline (Piegl and Tiller 1997, section
// 10.3).
//
// Control points are interpolated in homogeneous coordinates, so that every section is reproduced
// exactly, including its weights.

#include "geom/surface/loft.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "geom/basis/bspline.h"
#include "geom/linalg/dense.h"
#include "geom/surface/family.h"
#include "geom/surface/net.h"

// The rows of all sections as one net across them.
static CagStatus gather(const CagNet *sections, size_t n, int degree, CagNet *out, CagError *err) {
  size_t width = 4 * sections[0].count;
  CagStatus status = cag_net_new(degree, n, width, out, err);
  if (status) return status;
  for (size_t j = 0; j < n; j++)
    memcpy(out->data + j * width, sections[j].data, width * sizeof *out->data);
  return CAG_OK;
}

// Replaces data rows, one for each section, by the coefficients of the spline that interpolates row
// j at v = j.
static CagStatus open_spline(CagNet *net, CagError *err) {
  double *at = cag_malloc(net->count * sizeof *at);
  if (!at) return cag_fail_memory(err);
  for (size_t j = 0; j < net->count; j++) at[j] = (double)j;
  cag_net_averaged_knots(at, net->count, net->degree, net->knots);
  CagStatus status = cag_net_interpolate(net, at, err);
  cag_free(at);
  return status;
}

// Maximum degree of a closed loft.
#define DEGREE_MOST 31

// With uniform periodic knots the system is circulant: row j has the basis at a knot, shifted.
static CagStatus solve_circulant(CagNet *net, CagError *err) {
  size_t n = net->count, p = (size_t)net->degree, width = net->width;
  double knots[2 * DEGREE_MOST + 2], basis[DEGREE_MOST + 1];
  for (size_t i = 0; i < 2 * p + 2; i++) knots[i] = (double)i;
  cag_bspline_basis(knots, net->degree, p, (double)p, basis);
  double *a = cag_calloc(n * n, sizeof *a);
  size_t *pivots = cag_malloc(n * sizeof *pivots);
  CagStatus status = a && pivots ? CAG_OK : cag_fail_memory(err);
  if (!status) {
    for (size_t j = 0; j < n; j++)
      for (size_t k = 0; k <= p; k++) a[j * n + (j + k) % n] += basis[k];
    bool singular;
    status = cag_lu_factor(a, n, pivots, &singular, err);
    if (!status && !singular) status = cag_lu_solve(a, n, pivots, net->data, width, err);
    if (!status && singular)
      status = cag_fail(
          err, CAG_E_DEGENERATE, CAG_ERR_fit_singular, "degree", -1,
          "there is no closed loft of degree %zu through %zu curves; use another `degree`", p, n);
  }
  cag_free(a);
  cag_free(pivots);
  return status;
}

static CagStatus check_closed(int degree, size_t n, CagError *err) {
  if (degree > DEGREE_MOST)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_order_range, "degree", -1,
                    "`degree` of a closed loft must be at most %d, found %d", DEGREE_MOST, degree);
  if (degree % 2 == 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_order_range, "degree", -1,
                    "`degree` of a closed loft must be odd, found %d; use %d", degree, degree + 1);
  if ((size_t)degree >= n)
    return cag_fail(
        err, CAG_E_ARGUMENT, CAG_ERR_order_range, "degree", -1,
        "`degree` must be less than the number of curves of a closed loft (%zu), found %d", n,
        degree);
  return CAG_OK;
}

// The same for a spline that continues from the last row to the first.
static CagStatus closed_spline(CagNet *net, CagError *err) {
  const size_t n = net->count, p = (size_t)net->degree;
  CagNet wrapped;
  CagStatus status = solve_circulant(net, err);
  // Appends the first rows and clamps the ends: knots -p..n + p, range 0..n.
  if (!status) status = cag_net_new(net->degree, n + p, net->width, &wrapped, err);
  if (status) return status;
  memcpy(wrapped.data, net->data, n * net->width * sizeof *net->data);
  memcpy(wrapped.data + n * net->width, net->data, p * net->width * sizeof *net->data);
  for (size_t i = 0; i < n + 2 * p + 1; i++) wrapped.knots[i] = (double)i - (double)p;
  cag_net_free(net);
  *net = wrapped;
  return CAG_OK;
}

static int loft_degree(size_t n, int degree, bool closed) {
  return closed || degree < (int)n - 1 ? degree : (int)n - 1;
}

// Sections with an exact form, as one NURBS surface.
static CagStatus loft_nets(const CagNet *sections, size_t n, int degree, bool closed,
                           CagSurface **out, CagError *err) {
  CagNet net;
  CagStatus status = gather(sections, n, loft_degree(n, degree, closed), &net, err);
  if (status) return status;
  status = closed ? closed_spline(&net, err) : open_spline(&net, err);
  if (!status) status = cag_net_to_surface(&net, 1, &sections[0], out, err);
  cag_net_free(&net);
  return status;
}

// Sections of any kind: the spline is linear in them, so its coefficients are those for unit data.
static CagStatus loft_curves(const CagCurve *const *curves, size_t n, int degree, bool closed,
                             CagSurface **out, CagError *err) {
  CagNet net;
  CagStatus status = cag_net_new(loft_degree(n, degree, closed), n, n, &net, err);
  if (status) return status;
  memset(net.data, 0, n * n * sizeof *net.data);
  for (size_t j = 0; j < n; j++) net.data[j * n + j] = 1;
  status = closed ? closed_spline(&net, err) : open_spline(&net, err);
  if (!status) status = cag_surface_across(curves, &net, out, err);
  cag_net_free(&net);
  return status;
}

CagStatus cag_surface_loft(const CagCurve *const *curves, size_t n, int degree, bool closed,
                           CagSurface **out, CagError *err) {
  CagNet *sections = cag_calloc(n, sizeof *sections);
  if (!sections) return cag_fail_memory(err);
  CagStatus status = closed ? check_closed(degree, n, err) : CAG_OK;
  for (size_t i = 0; !status && i < n; i++) {
    status = cag_net_of_curve(curves[i], &sections[i], err);
    if (status && err->index < 0) {
      err->index = (long)i;
      memcpy(err->argument, "curves", sizeof "curves");
    }
  }
  const bool formulas = status == CAG_E_UNSUPPORTED;
  if (!status) status = cag_nets_unify(sections, n, err);
  if (!status) status = loft_nets(sections, n, degree, closed, out, err);
  if (formulas) status = loft_curves(curves, n, degree, closed, out, err);
  for (size_t i = 0; i < n; i++) cag_net_free(&sections[i]);
  cag_free(sections);
  return status;
}
