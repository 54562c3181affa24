// Surfaces compared with SISL 4.6 (grids of a bicubic surface) and Open CASCADE (tessellation), in
// one run. Uses SISL if its header is installed (CAG_SISL). Open CASCADE's figures are read from
// the file that occt.cpp writes. Without a peer, its column is empty.
//
// The surface has a net of 20 x 20 points, polynomial and rational. Both sides compute grids in
// batches of rows into reused memory, so that memory is not measured. Times are processor times on
// one core, the best of several rounds for grids. The deviation of a tessellation is measured at
// samples that do not depend on its parameters: each sample is in the parameters of a known
// triangle, and its distance is that to the closest triangle nearby.

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#ifdef CAG_SISL
#include <sisl.h>
// SISL defines these as macros.
#undef MAX
#undef MIN
#endif

#include "geom/mesh/distance.h"
#include "geom/surface/frames.h"
#include "geom/tessellate/tessellate.h"

#define ROUNDS 5
#define SIDE 20
#define DEGREE 3
#define GRID 1000
#define BATCH 40 // rows of the grid that are evaluated together and then summed

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void check(bool ok, const char *what) {
  if (ok) return;
  fprintf(stderr, "surfaces: %s\n", what);
  exit(1);
}

static double best(double a, double b) { return a == 0 || b < a ? b : a; }

// --- The surface, and its SISL counterpart ---

typedef struct Subject {
  CagSurface *ours;
#ifdef CAG_SISL
  SISLSurf *theirs;
#endif
  double end; // of both domains, which begin at 0
} Subject;

static Subject make_subject(bool rational) {
  static CagVec3 net[SIDE * SIDE];
  static double weights[SIDE * SIDE], flat[SIDE * SIDE * 4];
  double knots[SIDE + DEGREE + 1];
  size_t stride = rational ? 4 : 3;
  for (int k = 0; k < SIDE + DEGREE + 1; k++)
    knots[k] = k <= DEGREE ? 0 : k >= SIDE ? SIDE - DEGREE : k - DEGREE;
  for (int i = 0; i < SIDE; i++)
    for (int j = 0; j < SIDE; j++) {
      CagVec3 p = cag_vec3(i, j, sin(i * 0.7) * cos(j * 0.5));
      double w = rational ? 1 + 0.1 * ((i * 7 + j * 3) % 5) : 1;
      const double h[4] = {w * p.x, w * p.y, w * p.z, w};
      net[i * SIDE + j] = p;
      weights[i * SIDE + j] = w;
      // SISL's first direction is our v; in both, it varies fastest. SISL's normals are opposite.
      memcpy(flat + stride * (size_t)(i * SIDE + j), h, stride * sizeof *h);
    }
  CagError err;
  Subject s = {.end = SIDE - DEGREE};
  check(cag_surface_nurbs(net, rational ? weights : NULL, SIDE, SIDE, DEGREE, DEGREE, knots, knots,
                          &s.ours, &err) == CAG_OK,
        err.message);
#ifdef CAG_SISL
  s.theirs =
      newSurf(SIDE, SIDE, DEGREE + 1, DEGREE + 1, knots, knots, flat, rational ? 2 : 1, 3, 1);
  check(s.theirs != NULL, "SISL makes no surface");
#endif
  return s;
}

static void free_subject(Subject *s) {
  cag_surface_release(s->ours);
#ifdef CAG_SISL
  freeSurf(s->theirs);
#endif
}

// --- Grids: points, first derivatives, and unit normals ---

typedef struct Grid {
  double at[GRID];
  CagVec3 *points, *du, *dv, *normals;
  double *both, *crosses; // SISL's
} Grid;

static double ours(const Subject *s, Grid *g, double *sum) {
  CagError err;
  double seconds = 0;
  *sum = 0;
  for (int i = 0; i < GRID; i += BATCH) {
    double begin = now();
    check(cag_surface_eval_frames(s->ours, g->at + i, BATCH, g->at, GRID, g->points, g->du, g->dv,
                                  g->normals, &err) == CAG_OK,
          err.message);
    seconds += now() - begin;
    for (size_t k = 0; k < (size_t)BATCH * GRID; k++)
      *sum += g->points[k].z + g->normals[k].z + g->du[k].z;
  }
  return seconds;
}

static double of_sisl(const Subject *s, Grid *g, double *sum) {
  double seconds = 0;
  *sum = 0;
#ifdef CAG_SISL
  for (int i = 0; i < GRID; i += BATCH) {
    int status;
    double begin = now();
    s1506(s->theirs, 1, GRID, g->at, BATCH, g->at + i, g->both, g->crosses, &status);
    seconds += now() - begin;
    check(status >= 0, "s1506 fails");
    for (size_t k = 0; k < (size_t)BATCH * GRID; k++)
      *sum += g->both[9 * k + 2] - g->crosses[3 * k + 2] + g->both[9 * k + 6 + 2];
  }
#else
  (void)s, (void)g;
#endif
  return seconds;
}

static void measure_grid(bool rational, double aim) {
  const size_t n = (size_t)GRID * GRID, room_for = (size_t)BATCH * GRID;
  Subject s = make_subject(rational);
  Grid *g = malloc(sizeof *g);
  double *room = calloc(24 * room_for, sizeof *room);
  check(g && room, "no memory");
  g->points = (CagVec3 *)room;
  g->du = g->points + room_for;
  g->dv = g->du + room_for;
  g->normals = g->dv + room_for;
  g->both = room + 12 * room_for;
  g->crosses = g->both + 9 * room_for;
  for (int k = 0; k < GRID; k++) g->at[k] = s.end * k / (GRID - 1.0);
  double us = 0, sisl = 0, sums[2];
  for (int round = 0; round < ROUNDS; round++) {
    us = best(us, ours(&s, g, &sums[0]));
    sisl = best(sisl, of_sisl(&s, g, &sums[1]));
  }
  check(sisl == 0 || fabs(sums[0] - sums[1]) <= 1e-9 * (1 + fabs(sums[1])), "SISL and we differ");
  printf("%-52s %7.2f Mpoints/s",
         rational ? "rational 1000x1000 grid, derivatives and normals"
                  : "bicubic 1000x1000 grid, derivatives and normals",
         (double)n / us / 1e6);
  if (sisl > 0)
    printf("   SISL s1506 %6.2f   %6.2f times as fast", (double)n / sisl / 1e6, sisl / us);
  printf("   aim >= %g\n", aim);
  free(room);
  free(g);
  free_subject(&s);
}

// --- Tessellation ---

// Open CASCADE's mesh at one tolerance, measured by occt.cpp.
typedef struct Peer {
  double tolerance, seconds, triangles;
} Peer;

// The largest distance found from points of the surface to the mesh. Boxes of the parameter plane
// list the triangles that touch them. The foot of a point is in one of the triangles at its
// parameters, except for shear, which the neighboring boxes cover.
enum { BOXES = 512, AROUND = 1, TRIES = 2000000 };

typedef struct Boxes {
  const CagMesh *mesh;
  double end;
  uint32_t *start, *triangles;
} Boxes;

static int box_of(const Boxes *b, double x) {
  int k = (int)(x / b->end * BOXES);
  return k < 0 ? 0 : k >= BOXES ? BOXES - 1 : k;
}

static Boxes sort_into_boxes(const CagMesh *m, double end) {
  Boxes b = {m, end, calloc((size_t)BOXES * BOXES + 2, sizeof *b.start), NULL};
  check(b.start != NULL, "no memory");
  for (int pass = 0; pass < 2; pass++) {
    for (size_t t = 0; t < m->triangle_count; t++) {
      int low[2] = {BOXES, BOXES}, high[2] = {0, 0};
      for (size_t k = 0; k < 3; k++)
        for (size_t d = 0; d < 2; d++) {
          int at = box_of(&b, m->uv[2 * (size_t)m->triangles[3 * t + k] + d]);
          low[d] = at < low[d] ? at : low[d];
          high[d] = at > high[d] ? at : high[d];
        }
      for (int i = low[0]; i <= high[0]; i++)
        for (int j = low[1]; j <= high[1]; j++) {
          size_t at = (size_t)i * BOXES + (size_t)j;
          if (pass == 0) b.start[at + 2]++;
          else b.triangles[b.start[at + 1]++] = (uint32_t)t;
        }
    }
    if (pass == 1) break;
    for (size_t k = 2; k < (size_t)BOXES * BOXES + 2; k++) b.start[k] += b.start[k - 1];
    b.triangles = malloc((b.start[(size_t)BOXES * BOXES + 1] + 1) * sizeof *b.triangles);
    check(b.triangles != NULL, "no memory");
  }
  return b;
}

static double distance_at(const Boxes *b, double u, double v, CagVec3 p) {
  double least = INFINITY;
  int i = box_of(b, u), j = box_of(b, v);
  const CagMesh *m = b->mesh;
  for (int x = i - AROUND; x <= i + AROUND; x++)
    for (int y = j - AROUND; y <= j + AROUND; y++) {
      if (x < 0 || y < 0 || x >= BOXES || y >= BOXES) continue;
      size_t at = (size_t)x * BOXES + (size_t)y;
      for (uint32_t k = b->start[at]; k < b->start[at + 1]; k++) {
        const uint32_t *c = m->triangles + 3 * (size_t)b->triangles[k];
        least = fmin(least, cag_distance_to_triangle(p, m->positions[c[0]], m->positions[c[1]],
                                                     m->positions[c[2]]));
      }
    }
  return least;
}

// Park and Miller's generator: the same parameters on every machine.
static double random_fraction(void) {
  static uint64_t state = 1;
  state = state * 48271 % 2147483647;
  return (double)state / 2147483647;
}

static double largest_distance(const Subject *s, const CagMesh *m, size_t tries) {
  Boxes b = sort_into_boxes(m, s->end);
  double largest = 0;
  CagError err;
  for (size_t k = 0; k < tries; k++) {
    double u = s->end * random_fraction(), v = s->end * random_fraction();
    CagVec3 p;
    check(cag_surface_point(s->ours, u, v, &p, &err) == CAG_OK, err.message);
    largest = fmax(largest, distance_at(&b, u, v, p));
  }
  free(b.start);
  free(b.triangles);
  return largest;
}

static void measure_mesh(const Subject *s, double tolerance, const Peer *peers, size_t peer_count) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *m = NULL;
  CagError err;
  double seconds = 0;
  how.tolerance = tolerance;
  how.angle = 0.5; // the same as for Open CASCADE
  for (int round = 0; round < ROUNDS; round++) {
    cag_mesh_release(m);
    double begin = now();
    check(cag_surface_tessellate(s->ours, &how, &m, &err) == CAG_OK, err.message);
    seconds = best(seconds, now() - begin);
  }
  double triangles = (double)m->triangle_count;
  printf("mesh at %-7g %9.0f triangles %9.4f s", tolerance, triangles, seconds);
  for (size_t k = 0; k < peer_count; k++)
    if (peers[k].tolerance == tolerance)
      printf("   Open CASCADE %9.0f %9.4f s   %8.1f times as fast, aim >= 100; %.2f of its "
             "triangles, aim <= 1.3",
             peers[k].triangles, peers[k].seconds, peers[k].seconds / seconds,
             triangles / peers[k].triangles);
  double largest = largest_distance(s, m, TRIES);
  printf("\n    largest distance found %.3g, %.2f of the tolerance, aim <= 1\n", largest,
         largest / tolerance);
  cag_mesh_release(m);
}

// Argument: the file of Open CASCADE's figures, each line with tolerance, triangles, and seconds.
int main(int argc, char **argv) {
  Peer peers[8];
  size_t n = 0;
  FILE *file = argc > 1 ? fopen(argv[1], "r") : NULL;
  while (file && n < 8 &&
         fscanf(file, "%lf %lf %lf", &peers[n].tolerance, &peers[n].triangles, &peers[n].seconds) ==
             3)
    n++;
  if (file) fclose(file);
  measure_grid(false, 8);
  measure_grid(true, 10);
  Subject s = make_subject(false);
  measure_mesh(&s, 1e-2, peers, n);
  measure_mesh(&s, 1e-3, peers, n);
  measure_mesh(&s, 1e-4, peers, n);
  free_subject(&s);
  return 0;
}
