// Runs of traced points: runs that continue across a seam or a break are joined, and points without
// a tangent get one from their neighbors.

#include "geom/meet/section_join.h"

#include <math.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"

// Runs that meet are joined if their tangents agree up to this (1 - cosine): cubics with a common
// tangent are then accurate to a millionth.
#define KINK 1e-8
// Fraction of the size below which an open run is negligible.
#define SPECK 1e-8

void cag_trace_free(CagTrace *t) {
  cag_free(t->points);
  cag_free(t->tangents);
  cag_free(t->checks);
}

void cag_traces_free(CagTraces *t) {
  for (size_t i = 0; i < t->count; i++) cag_trace_free(&t->items[i]);
  cag_free(t->items);
  *t = (CagTraces){0};
}

static void turn_trace(CagTrace *t) {
  for (size_t i = 0, j = t->count - 1; i < j; i++, j--) {
    CagVec3 p = t->points[i], d = t->tangents[i];
    t->points[i] = t->points[j];
    t->tangents[i] = t->tangents[j];
    t->points[j] = p;
    t->tangents[j] = d;
  }
  for (size_t i = 0; i < t->count; i++) t->tangents[i] = cag_scaled(t->tangents[i], -1);
}

static bool is_smooth(const CagTraceJoint *how, CagVec3 before, CagVec3 after, CagVec3 tangent,
                      CagVec3 next_tangent) {
  const bool known = cag_norm(tangent) > 0 && cag_norm(next_tangent) > 0;
  if (how->sided || known) return cag_dot(tangent, next_tangent) > 1 - KINK;
  return cag_dot(before, after) > CAG_TRACE_CORNER;
}

static bool goes_on(const CagTrace *a, const CagTrace *b, const CagTraceJoint *how) {
  CagVec3 p = a->points[a->count - 1];
  if (cag_norm(cag_sub(p, b->points[0])) > how->same) return false;
  CagVec3 before = cag_unit(cag_sub(p, a->points[a->count - 2]));
  CagVec3 after = cag_unit(cag_sub(b->points[1], b->points[0]));
  return is_smooth(how, before, after, a->tangents[a->count - 1], b->tangents[0]);
}

static bool append(CagTrace *a, const CagTrace *b) {
  if (!CAG_RESIZE(a->points, a->count + b->count) ||
      !CAG_RESIZE(a->tangents, a->count + b->count) ||
      !CAG_RESIZE(a->checks, a->check_count + b->check_count + 1))
    return false;
  // The first point of b is there already.
  memcpy(a->points + a->count, b->points + 1, (b->count - 1) * sizeof *a->points);
  memcpy(a->tangents + a->count, b->tangents + 1, (b->count - 1) * sizeof *a->tangents);
  if (b->check_count > 0)
    memcpy(a->checks + a->check_count, b->checks, b->check_count * sizeof *a->checks);
  a->count += b->count - 1;
  a->check_count += b->check_count;
  return true;
}

static bool join_pair(CagTraces *t, size_t i, size_t j, const CagTraceJoint *how, bool *joined) {
  CagTrace *a = &t->items[i], *b = &t->items[j];
  for (int turn = 0; turn < 4 && !*joined; turn++) {
    *joined = goes_on(a, b, how);
    if (*joined) break;
    if (turn % 2 == 0) turn_trace(b);
    else turn_trace(a);
  }
  if (!*joined) return true;
  if (!append(a, b)) return false;
  cag_trace_free(b);
  t->items[j] = t->items[--t->count];
  return true;
}

// Drops single runs smaller than the tolerance, which only touch the level, and negligible open
// runs (at a pole, where values are rounding), whose neighbors meet without them.
static void drop_specks(CagTraces *t, const CagTraceJoint *how) {
  size_t kept = 0;
  for (size_t i = 0; i < t->count; i++) {
    CagTrace *a = &t->items[i];
    double reach = 0;
    for (size_t k = 1; k < a->count; k++)
      reach = fmax(reach, cag_norm(cag_sub(a->points[k], a->points[0])));
    if (reach <= (a->closed ? how->tolerance : SPECK * how->size)) {
      cag_trace_free(a);
    } else {
      t->items[kept++] = *a;
    }
  }
  t->count = kept;
}

// Ends early if the work is canceled.
static bool join_traces(CagTraces *t, const CagTraceJoint *how) {
  for (size_t i = 0; i < t->count; i++) {
    bool joined = true;
    while (joined) {
      joined = false;
      for (size_t j = i + 1; j < t->count && !joined && !cag_stopped(); j++)
        if (!join_pair(t, i, j, how, &joined)) return false;
    }
  }
  return true;
}

// Sets a missing tangent at an end of an open run by reflecting its neighbor's.
static void complete_ends(CagTrace *t) {
  size_t n = t->count;
  const size_t ends[2][2] = {{0, 1}, {n - 1, n - 2}};
  for (int k = 0; k < 2; k++) {
    size_t i = ends[k][0], next = ends[k][1];
    if (cag_norm(t->tangents[i]) > 0) continue;
    CagVec3 way = cag_unit(cag_sub(t->points[next], t->points[i]));
    if (k == 1) way = cag_scaled(way, -1);
    bool known = n > 2 && cag_norm(t->tangents[next]) > 0;
    t->tangents[i] = known ? cag_unit(cag_sub(cag_scaled(way, 2), t->tangents[next])) : way;
  }
}

// Sets missing tangents from the parabola through the neighbors.
static void complete_tangents(CagTrace *t, const CagTraceJoint *how) {
  size_t n = t->count;
  bool comes_back = n > 3 && cag_norm(cag_sub(t->points[0], t->points[n - 1])) <= how->same;
  t->closed = false;
  if (comes_back) {
    // Closed only if it continues smoothly.
    CagVec3 before = cag_unit(cag_sub(t->points[n - 1], t->points[n - 2]));
    CagVec3 after = cag_unit(cag_sub(t->points[1], t->points[0]));
    t->points[n - 1] = t->points[0];
    t->closed = is_smooth(how, before, after, t->tangents[n - 1], t->tangents[0]);
    if (t->closed) t->tangents[n - 1] = t->tangents[0];
  }
  if (!t->closed) complete_ends(t);
  for (size_t i = 0; i < n; i++) {
    if (cag_norm(t->tangents[i]) > 0) continue;
    CagVec3 before = i > 0 ? t->points[i - 1] : t->points[n - 2];
    CagVec3 after = i + 1 < n ? t->points[i + 1] : t->points[1];
    CagVec3 d1 = cag_sub(t->points[i], before), d2 = cag_sub(after, t->points[i]);
    double a = cag_norm(d1), b = cag_norm(d2);
    t->tangents[i] = cag_unit(cag_madd(cag_scaled(d1, b / a), a / b, d2));
  }
}

bool cag_traces_join(CagTraces *t, const CagTraceJoint *how) {
  for (size_t i = 0; how->sided && i < t->count; i++) complete_ends(&t->items[i]);
  if (!join_traces(t, how)) return false;
  for (size_t i = 0; i < t->count && !cag_stopped(); i++) complete_tangents(&t->items[i], how);
  if (how->sided) drop_specks(t, how);
  return true;
}
