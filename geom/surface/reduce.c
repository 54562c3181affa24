// Knot removal and degree reduction of surfaces, and reversed directions.

#include <string.h>

#include "base/memory.h"
#include "geom/curve/reduce_rows.h"
#include "geom/surface/family.h"
#include "geom/surface/net.h"
#include "geom/surface/reshape.h"

// Whether a weight differs from 1.
static bool is_rational(const CagNet *net) {
  for (size_t i = 3; i < net->count * net->width; i += 4)
    if (net->data[i] != 1) return true;
  return false;
}

// The net of a surface in a direction, with interpolated ends: a closed one becomes open.
static CagStatus clamped_net(const CagSurface *s, int direction, CagNet *net, CagNet *across,
                             CagError *err) {
  CagStatus status = cag_net_of_surface(s, direction, net, across, err);
  if (status) return status;
  status = cag_net_trim(net, cag_net_start(net), cag_net_end(net), err);
  if (!status) return CAG_OK;
  cag_net_free(net);
  cag_net_free(across);
  return status;
}

static CagStatus rows_surface(const CagRows *rows, int direction, const CagNet *across,
                              CagSurface **out, CagError *err) {
  const CagNet net = {rows->degree, rows->count, 4 * rows->across, rows->knots, rows->h};
  return cag_net_to_surface(&net, direction, across, out, err);
}

CagStatus cag_surface_remove_knot(const CagSurface *s, int direction, double t, int times,
                                  double tolerance, CagSurface **out, double *deviation,
                                  CagError *err) {
  CagNet net, across;
  CagRows rows;
  double moved = 0;
  CagStatus status = clamped_net(s, direction, &net, &across, err);
  if (status) return status;
  status = cag_rows_new(net.degree, net.count, net.width / 4, is_rational(&net), &rows, err);
  if (!status) {
    memcpy(rows.h, net.data, net.count * net.width * sizeof *rows.h);
    memcpy(rows.knots, net.knots, (net.count + (size_t)net.degree + 1) * sizeof *rows.knots);
    status = cag_rows_remove(&rows, t, times, tolerance, &moved, err);
    if (!status) status = rows_surface(&rows, direction, &across, out, err);
    cag_rows_free(&rows);
  }
  if (!status && deviation) *deviation = moved;
  cag_net_free(&net);
  cag_net_free(&across);
  return status;
}

// Finds the distinct knots of a clamped net, and their multiplicities.
static CagStatus find_cuts(const CagNet *net, double **cuts, int **multiplicity, size_t *pieces,
                           CagError *err) {
  const size_t knots = net->count + (size_t)net->degree + 1;
  size_t n = 0;
  *cuts = cag_malloc(knots * sizeof **cuts);
  *multiplicity = cag_malloc(knots * sizeof **multiplicity);
  if (!*cuts || !*multiplicity) return cag_fail_memory(err);
  for (size_t i = 0; i < knots; i++) {
    if (n > 0 && net->knots[i] == (*cuts)[n - 1]) {
      (*multiplicity)[n - 1]++;
      continue;
    }
    (*cuts)[n] = net->knots[i];
    (*multiplicity)[n++] = 1;
  }
  *pieces = n - 1;
  return CAG_OK;
}

static CagStatus reduce_net(CagNet *net, int direction, const CagNet *across, double tolerance,
                            CagSurface **out, double *moved, CagError *err) {
  double *cuts = NULL;
  int *multiplicity = NULL;
  size_t pieces = 0;
  CagRows rows = {0};
  CagStatus status = find_cuts(net, &cuts, &multiplicity, &pieces, err);
  for (size_t i = 1; !status && i < pieces; i++)
    for (int k = multiplicity[i]; !status && k < net->degree; k++)
      status = cag_net_insert(net, cuts[i], err);
  const CagRowPieces all = {net->degree, pieces, net->width / 4, is_rational(net),
                            net->data,   cuts,   multiplicity};
  if (!status) status = cag_rows_reduce(&all, tolerance, &rows, moved, err);
  if (!status) status = rows_surface(&rows, direction, across, out, err);
  cag_rows_free(&rows);
  cag_free(cuts);
  cag_free(multiplicity);
  return status;
}

CagStatus cag_surface_reduce_degree(const CagSurface *s, int direction, double tolerance,
                                    CagSurface **out, double *deviation, CagError *err) {
  CagNet net, across;
  double moved = 0;
  CagStatus status = clamped_net(s, direction, &net, &across, err);
  if (status) return status;
  status = reduce_net(&net, direction, &across, tolerance, out, &moved, err);
  if (!status && deviation) *deviation = moved;
  cag_net_free(&net);
  cag_net_free(&across);
  return status;
}

CagStatus cag_surface_reverse(const CagSurface *s, int direction, CagSurface **out, CagError *err) {
  if (direction == 1) return cag_surface_flip(s, out, err);
  CagSurface *swapped, *reversed = NULL;
  CagStatus status = cag_surface_transpose(s, &swapped, err);
  if (status) return status;
  status = cag_surface_flip(swapped, &reversed, err);
  cag_surface_release(swapped);
  if (!status) status = cag_surface_transpose(reversed, out, err);
  if (reversed) cag_surface_release(reversed);
  return status;
}
