// Boehm's knot insertion (1980), degree elevation by Bezier pieces (Prautzsch 1984), and banded
// interpolation for coefficients of any width.

#include "geom/surface/net.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/basis/bspline.h"
#include "geom/linalg/dense.h"
#include "geom/linalg/tolerance.h"
#include "geom/surface/family.h"

// Knots closer than this fraction of the range are equal.
#define SAME_KNOT CAG_COINCIDENT

CagStatus cag_net_new(int degree, size_t count, size_t width, CagNet *out, CagError *err) {
  *out = (CagNet){.degree = degree, .count = count, .width = width};
  out->knots = cag_malloc((count + (size_t)degree + 1) * sizeof(double));
  out->data = cag_malloc((count * width + 1) * sizeof(double));
  if (out->knots && out->data) return CAG_OK;
  cag_net_free(out);
  return cag_fail_memory(err);
}

void cag_net_free(CagNet *net) {
  cag_free(net->knots);
  cag_free(net->data);
  *net = (CagNet){0};
}

double cag_net_start(const CagNet *net) { return net->knots[net->degree]; }
double cag_net_end(const CagNet *net) { return net->knots[net->count]; }

static bool same_knot(const CagNet *net, double a, double b) {
  return fabs(a - b) <= SAME_KNOT * (cag_net_end(net) - cag_net_start(net));
}

int cag_net_multiplicity(const CagNet *net, double t) {
  int times = 0;
  for (size_t i = 0; i < net->count + (size_t)net->degree + 1; i++)
    times += same_knot(net, net->knots[i], t);
  return times;
}

CagStatus cag_net_insert(CagNet *net, double t, CagError *err) {
  size_t p = (size_t)net->degree, n = net->count, span = p;
  // Reuse the exact value of a knot that is nearly equal.
  for (size_t i = p; i <= n; i++)
    if (same_knot(net, net->knots[i], t)) t = net->knots[i];
  while (span + 1 < n && net->knots[span + 1] <= t) span++;
  CagNet next;
  CagStatus status = cag_stop_check(err);
  if (!status) status = cag_net_new(net->degree, n + 1, net->width, &next, err);
  if (status) return status;
  for (size_t i = 0; i <= n; i++) {
    double *to = next.data + i * net->width;
    const double *here = net->data + i * net->width, *before = here - net->width;
    double f = i + p <= span ? 1 : 0;
    if (i + p > span && i <= span) {
      double width = net->knots[i + p] - net->knots[i];
      f = width > 0 ? (t - net->knots[i]) / width : 0;
    }
    for (size_t c = 0; c < net->width; c++)
      to[c] = f == 1 ? here[c] : f == 0 ? before[c] : (1 - f) * before[c] + f * here[c];
  }
  for (size_t i = 0; i < n + p + 2; i++)
    next.knots[i] = i <= span ? net->knots[i] : i == span + 1 ? t : net->knots[i - 1];
  cag_net_free(net);
  *net = next;
  return CAG_OK;
}

CagStatus cag_net_trim(CagNet *net, double a, double b, CagError *err) {
  size_t p = (size_t)net->degree;
  CagStatus status = CAG_OK;
  while (!status && cag_net_multiplicity(net, a) < net->degree)
    status = cag_net_insert(net, a, err);
  while (!status && cag_net_multiplicity(net, b) < net->degree)
    status = cag_net_insert(net, b, err);
  if (status) return status;
  size_t first = 0, last = net->count + p;
  for (size_t i = 0; i <= net->count; i++)
    if (net->knots[i] < b && (net->knots[i] <= a || same_knot(net, net->knots[i], a))) first = i;
  for (size_t i = net->count + p; i > first; i--)
    if (net->knots[i] >= b || same_knot(net, net->knots[i], b)) last = i;
  CagNet next;
  status = cag_net_new(net->degree, last - first + p, net->width, &next, err);
  if (status) return status;
  for (size_t i = 0; i < next.count + p + 1; i++)
    next.knots[i] = i <= p ? a : i >= next.count ? b : net->knots[first + i - p];
  memcpy(next.data, net->data + (first - p) * net->width,
         next.count * net->width * sizeof *next.data);
  cag_net_free(net);
  *net = next;
  return CAG_OK;
}

// Removes knot number r, the last of equal ones, if that changes nothing.
static CagStatus drop_knot(CagNet *net, size_t r, CagError *err) {
  // Inverse of Boehm's insertion, from both ends to the middle (Tiller 1992).
  size_t p = (size_t)net->degree, n = net->count, width = net->width;
  double t = net->knots[r];
  int times = 0;
  for (size_t i = 0; i < n + p + 1; i++) times += net->knots[i] == t;
  size_t s = (size_t)times, first = r - p, last = r - s;
  double *work = cag_malloc((last - first + 3) * width * sizeof *work);
  if (!work) return cag_fail_memory(err);
  size_t off = first - 1;
  memcpy(work, net->data + off * width, width * sizeof *work);
  memcpy(work + (last + 1 - off) * width, net->data + (last + 1) * width, width * sizeof *work);
  size_t i = first, j = last, ii = 1, jj = last - off;
  while (j > i) {
    double fi = (t - net->knots[i]) / (net->knots[i + p + 1] - net->knots[i]);
    double fj = (t - net->knots[j]) / (net->knots[j + p + 1] - net->knots[j]);
    for (size_t c = 0; c < width; c++) {
      work[ii * width + c] =
          (net->data[i * width + c] - (1 - fi) * work[(ii - 1) * width + c]) / fi;
      work[jj * width + c] =
          (net->data[j * width + c] - fj * work[(jj + 1) * width + c]) / (1 - fj);
    }
    i++, ii++, j--, jj--;
  }
  for (i = first, j = last; j > i; i++, j--) {
    memcpy(net->data + i * width, work + (i - off) * width, width * sizeof *work);
    memcpy(net->data + j * width, work + (j - off) * width, width * sizeof *work);
  }
  cag_free(work);
  size_t gone = (2 * r - s - p) / 2; // the point that is redundant now
  memmove(net->data + gone * width, net->data + (gone + 1) * width,
          (n - gone - 1) * width * sizeof *net->data);
  memmove(net->knots + r, net->knots + r + 1, (n + p - r) * sizeof *net->knots);
  net->count--;
  return CAG_OK;
}

CagStatus cag_net_drop(CagNet *net, double t, CagError *err) {
  size_t r = 0;
  while (r + 1 < net->count + (size_t)net->degree + 1 && net->knots[r + 1] <= t) r++;
  return drop_knot(net, r, err);
}

// The multiplicity of inner knots of a trimmed net must not exceed the degree.
static CagStatus check_inner_knots(const CagNet *net, CagError *err) {
  const size_t p = (size_t)net->degree;
  for (size_t i = p + 1; i + p < net->count; i++)
    if (net->knots[i] == net->knots[i + p])
      return cag_fail(
          err, CAG_E_ARGUMENT, CAG_ERR_knot_multiplicity, "knots", -1,
          "`knots` must not repeat an inner knot more often than the degree %d, or the pieces come apart there",
          net->degree);
  return CAG_OK;
}

CagStatus cag_net_raise(CagNet *net, CagError *err) {
  const int p = net->degree;
  CagStatus status = cag_net_trim(net, cag_net_start(net), cag_net_end(net), err);
  if (!status) status = check_inner_knots(net, err);
  if (status) return status;
  double *knots = cag_malloc(2 * (net->count + (size_t)p + 1) * sizeof *knots);
  if (!knots) return cag_fail_memory(err);
  const size_t n = cag_bspline_elevated_knots(net->knots, net->count, p, knots) - (size_t)p - 2;
  CagNet next = {0};
  status = cag_net_new(p + 1, n, net->width, &next, err);
  if (!status) {
    memcpy(next.knots, knots, (n + (size_t)p + 2) * sizeof *knots);
    status = cag_bspline_elevate(net->data, net->width, net->knots, net->count, p, knots, next.data,
                                 err);
  }
  cag_free(knots);
  if (status) {
    cag_net_free(&next);
    return status;
  }
  cag_net_free(net);
  *net = next;
  return CAG_OK;
}

CagStatus cag_net_take_knots(CagNet *net, const CagNet *other, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = (size_t)other->degree + 1; !status && i < other->count; i++) {
    double t = other->knots[i];
    if (t <= cag_net_start(net) || t >= cag_net_end(net)) continue;
    while (!status && cag_net_multiplicity(net, t) < cag_net_multiplicity(other, t))
      status = cag_net_insert(net, t, err);
  }
  return status;
}

void cag_net_rescale(CagNet *net, double a, double b) {
  double start = cag_net_start(net), end = cag_net_end(net);
  for (size_t i = 0; i < net->count + (size_t)net->degree + 1; i++) {
    double t = net->knots[i];
    net->knots[i] = t == start ? a : t == end ? b : a + (t - start) / (end - start) * (b - a);
  }
}

void cag_net_reverse(CagNet *net) {
  size_t n = net->count, m = n + (size_t)net->degree + 1;
  double sum = cag_net_start(net) + cag_net_end(net);
  for (size_t i = 0; i < n / 2; i++)
    for (size_t c = 0; c < net->width; c++) {
      double keep = net->data[i * net->width + c];
      net->data[i * net->width + c] = net->data[(n - 1 - i) * net->width + c];
      net->data[(n - 1 - i) * net->width + c] = keep;
    }
  for (size_t i = 0; i < m / 2; i++) {
    double keep = net->knots[i];
    net->knots[i] = net->knots[m - 1 - i];
    net->knots[m - 1 - i] = keep;
  }
  for (size_t i = 0; i < m; i++) net->knots[i] = sum - net->knots[i];
}

CagStatus cag_nets_unify(CagNet *nets, size_t n, CagError *err) {
  CagStatus status = CAG_OK;
  int degree = 0;
  for (size_t i = 0; i < n; i++) degree = nets[i].degree > degree ? nets[i].degree : degree;
  for (size_t i = 0; i < n; i++)
    while (!status && nets[i].degree < degree) status = cag_net_raise(&nets[i], err);
  // After the forward pass the last net has all knots; the backward pass distributes them.
  for (size_t i = 1; !status && i < n; i++)
    status = cag_net_take_knots(&nets[i], &nets[i - 1], err);
  for (size_t i = n - 1; !status && i-- > 0;)
    status = cag_net_take_knots(&nets[i], &nets[i + 1], err);
  // Makes nearly equal knots identical.
  for (size_t i = 1; !status && i < n; i++)
    memcpy(nets[i].knots, nets[0].knots,
           (nets[0].count + (size_t)degree + 1) * sizeof *nets[0].knots);
  return status;
}

CagStatus cag_net_of_curve(const CagCurve *c, CagNet *out, CagError *err) {
  CagCurve *exact;
  CagStatus status = cag_curve_to_nurbs(c, &exact, err);
  if (status) return status;
  CagNurbsView view;
  cag_curve_nurbs_view(exact, &view);
  status = cag_net_new(view.degree, view.count, 4, out, err);
  if (!status) {
    memcpy(out->knots, view.knots, (view.count + (size_t)view.degree + 1) * sizeof(double));
    memcpy(out->data, view.homogeneous, 4 * view.count * sizeof(double));
    cag_net_rescale(out, 0, 1);
    status = cag_net_trim(out, 0, 1, err);
    if (status) cag_net_free(out);
  }
  cag_curve_release(exact);
  return status;
}

static void swap_directions(const double *from, size_t nu, size_t nv, double *to) {
  for (size_t i = 0; i < nu; i++)
    for (size_t j = 0; j < nv; j++)
      memcpy(to + 4 * (j * nu + i), from + 4 * (i * nv + j), 4 * sizeof *to);
}

CagStatus cag_net_of_surface(const CagSurface *s, int direction, CagNet *out, CagNet *across,
                             CagError *err) {
  CagSurface *exact;
  CagStatus status = cag_surface_to_nurbs(s, &exact, err);
  if (status) return status;
  CagSurfaceNurbsView v;
  cag_surface_nurbs_view(exact, &v);
  size_t nu = v.nu, nv = v.nv;
  size_t n = direction == 0 ? nu : nv, m = direction == 0 ? nv : nu;
  int p = direction == 0 ? v.degree_u : v.degree_v, q = direction == 0 ? v.degree_v : v.degree_u;
  status = cag_net_new(p, n, 4 * m, out, err);
  if (!status) {
    status = cag_net_new(q, m, 0, across, err);
    if (status) cag_net_free(out);
  }
  if (!status) {
    memcpy(out->knots, direction == 0 ? v.knots_u : v.knots_v,
           (n + (size_t)p + 1) * sizeof(double));
    memcpy(across->knots, direction == 0 ? v.knots_v : v.knots_u,
           (m + (size_t)q + 1) * sizeof(double));
    if (direction == 0) memcpy(out->data, v.homogeneous, 4 * nu * nv * sizeof(double));
    else swap_directions(v.homogeneous, nu, nv, out->data);
  }
  cag_surface_release(exact);
  return status;
}

CagStatus cag_net_to_surface(const CagNet *net, int direction, const CagNet *across,
                             CagSurface **out, CagError *err) {
  if (direction == 0)
    return cag_surface_from_homogeneous(net->data, net->count, across->count, net->degree,
                                        across->degree, net->knots, across->knots, out, err);
  double *turned = cag_malloc((net->count * net->width + 1) * sizeof *turned);
  if (!turned) return cag_fail_memory(err);
  swap_directions(net->data, net->count, across->count, turned);
  CagStatus status = cag_surface_from_homogeneous(turned, across->count, net->count, across->degree,
                                                  net->degree, across->knots, net->knots, out, err);
  cag_free(turned);
  return status;
}

// --- Interpolation ---

void cag_net_averaged_knots(const double *parameters, size_t n, int degree, double *knots) {
  size_t p = (size_t)degree;
  for (size_t i = 0; i < n + p + 1; i++) {
    if (i <= p) knots[i] = parameters[0];
    else if (i >= n) knots[i] = parameters[n - 1];
    else {
      double sum = 0;
      for (size_t k = 1; k <= p; k++) sum += parameters[i - p - 1 + k];
      knots[i] = sum / (double)p;
    }
  }
}

CagStatus cag_net_interpolate(CagNet *net, const double *parameters, CagError *err) {
  size_t p = (size_t)net->degree, n = net->count;
  size_t rows = 3 * p + 1; // LAPACK's band: 2 kl + ku + 1
  double *band = cag_calloc(n * rows, sizeof *band), *basis = cag_malloc((p + 1) * sizeof *basis);
  CagStatus status = band && basis ? CAG_OK : cag_fail_memory(err);
  double least = 1;
  for (size_t i = 0; !status && i < n; i++) {
    double t = parameters[i];
    size_t span = cag_knots_span(net->knots, n, net->degree, t, t >= cag_net_end(net), p);
    cag_bspline_basis(net->knots, net->degree, span, t, basis);
    for (size_t k = 0; k <= p; k++) {
      size_t j = span - p + k;
      // Schoenberg-Whitney condition: an entry outside the band means a singular system.
      if (basis[k] == 0) continue;
      if (j > i + p || i > j + p) least = 0;
      else band[j * rows + 2 * p + i - j] = basis[k];
    }
    status = cag_stop_check(err);
  }
  bool singular = false;
  double *turned = NULL;
  if (!status && least > 0) {
    turned = cag_malloc(n * net->width * sizeof *turned);
    if (!turned) status = cag_fail_memory(err);
  }
  if (!status && least > 0) {
    for (size_t i = 0; i < n && !cag_stopped(); i++)
      for (size_t c = 0; c < net->width; c++) turned[c * n + i] = net->data[i * net->width + c];
    status = cag_stop_check(err);
    if (!status) status = cag_band_solve(band, n, p, p, turned, net->width, &singular, err);
    for (size_t j = 0; !status && !singular && j < n; j++)
      least = fmin(least, fabs(band[j * rows + 2 * p]));
    for (size_t i = 0; !status && i < n; i++) {
      for (size_t c = 0; c < net->width; c++) net->data[i * net->width + c] = turned[c * n + i];
      status = cag_stop_check(err);
    }
  }
  if (!status && (singular || least < 1e-13))
    status = cag_fail(
        err, CAG_E_DEGENERATE, CAG_ERR_fit_singular, "degree", -1,
        "`degree` and knots do not determine the interpolation: lower the degree, or change the spacing of the data");
  cag_free(turned);
  cag_free(band);
  cag_free(basis);
  return status;
}
