#include "geom/ray/ray_outline.h"

#include "base/memory.h"

// More strips than pieces do not help.
enum { STRIPS_MAX = 4096 };

static size_t strip_of(const CagRayOutline *o, double y) {
  const double k = (y - o->low) * o->scale;
  return k <= 0 ? 0 : k >= (double)(o->strip_count - 1) ? o->strip_count - 1 : (size_t)k;
}

static double lower_end(const CagRegionPiece *p) { return fmin(p->p.y, p->q.y); }
static double upper_end(const CagRegionPiece *p) { return fmax(p->p.y, p->q.y); }

// Consecutive pieces of a loop end in one point, to the bit: no line passes between them.
static void join_ends(CagRegionPieces *s) {
  for (size_t i = 0; i < s->n; i++) {
    size_t next = i + 1;
    if (next == s->n || s->items[next].walk != s->items[i].walk)
      for (next = i; next > 0 && s->items[next - 1].walk == s->items[i].walk;) next--;
    s->items[i].q = s->items[next].p;
  }
}

// Lists the pieces of each strip: first counts them, then stores them.
static CagStatus fill_strips(CagRayOutline *o, CagError *err) {
  const CagRegionPieces *s = &o->pieces;
  o->strip_count = s->n < STRIPS_MAX ? s->n + 1 : STRIPS_MAX;
  o->low = INFINITY;
  o->high = -INFINITY;
  for (size_t i = 0; i < s->n; i++) {
    o->low = fmin(o->low, lower_end(&s->items[i]));
    o->high = fmax(o->high, upper_end(&s->items[i]));
  }
  o->scale = o->high > o->low ? (double)o->strip_count / (o->high - o->low) : 0;
  o->strip = cag_calloc(o->strip_count + 2, sizeof *o->strip);
  if (!o->strip) return cag_fail_memory(err);
  size_t total = 0;
  for (size_t i = 0; i < s->n; i++)
    for (size_t k = strip_of(o, lower_end(&s->items[i])); k <= strip_of(o, upper_end(&s->items[i]));
         k++, total++)
      o->strip[k + 2]++;
  o->piece = cag_malloc((total + 1) * sizeof *o->piece);
  if (!o->piece) return cag_fail_memory(err);
  for (size_t k = 2; k < o->strip_count + 2; k++) o->strip[k] += o->strip[k - 1];
  for (size_t i = 0; i < s->n; i++)
    for (size_t k = strip_of(o, lower_end(&s->items[i])); k <= strip_of(o, upper_end(&s->items[i]));
         k++)
      o->piece[o->strip[k + 1]++] = (uint32_t)i;
  return CAG_OK;
}

CagStatus cag_ray_outline_new(const CagRegion *r, CagRayOutline **out, CagError *err) {
  CagRayOutline *o = cag_calloc(1, sizeof *o);
  if (!o) return cag_fail_memory(err);
  o->region = cag_region_retain(r);
  o->walks = cag_calloc(r->count + 1, sizeof *o->walks);
  CagStatus status = o->walks ? CAG_OK : cag_fail_memory(err);
  o->pieces.walks = o->walks;
  for (size_t i = 0; !status && i < r->count; i++) {
    o->walks[i] = (CagWalk){.curve = r->loops[i], .sign = 1, .group = -1};
    status = cag_region_pieces_add(&o->pieces, i, err);
  }
  if (!status) join_ends(&o->pieces);
  if (!status) status = fill_strips(o, err);
  if (status) cag_ray_outline_free(o);
  else *out = o;
  return status;
}

void cag_ray_outline_free(CagRayOutline *o) {
  if (!o) return;
  cag_region_pieces_free(&o->pieces);
  cag_region_release(o->region);
  cag_free(o->walks);
  cag_free(o->strip);
  cag_free(o->piece);
  cag_free(o);
}

// Whether the piece, which has the height y, passes to the right of x there.
static bool passes_right(const CagRayOutline *o, const CagRegionPiece *s, double x, double y) {
  if (x < fmin(s->p.x, s->q.x)) return true;
  if (x > fmax(s->p.x, s->q.x)) return false;
  const CagVec3 p = s->p.y < s->q.y ? s->p : s->q, q = s->p.y < s->q.y ? s->q : s->p;
  if (s->straight) return (x - p.x) * (q.y - p.y) < (y - p.y) * (q.x - p.x);
  if (s->round) {
    const double dy = y - s->center.y, half = sqrt(fmax(0, s->radius * s->radius - dy * dy));
    const bool right = p.x + q.x > 2 * s->center.x;
    return x < s->center.x + (right ? half : -half);
  }
  double t;
  CagVec3 at;
  CagError ignored;
  if (cag_region_piece_at(&o->pieces, s, s->a, s->b, 1, y, &t, &at, &ignored)) return false;
  return x < at.x;
}

static bool holds_exactly(const CagRayOutline *o, double x, double y) {
  if (!(y >= o->low && y < o->high)) return false;
  const size_t k = strip_of(o, y);
  bool inside = false;
  for (size_t i = o->strip[k]; i < o->strip[k + 1]; i++) {
    const CagRegionPiece *s = &o->pieces.items[o->piece[i]];
    if (y >= lower_end(s) && y < upper_end(s) && passes_right(o, s, x, y)) inside = !inside;
  }
  return inside;
}

bool cag_ray_outline_holds(const CagRayOutline *o, double x, double y, double slack) {
  if (holds_exactly(o, x, y)) return true;
  return slack > 0 && (holds_exactly(o, x - slack, y) || holds_exactly(o, x + slack, y) ||
                       holds_exactly(o, x, y - slack) || holds_exactly(o, x, y + slack));
}
