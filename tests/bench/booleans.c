// Benchmarks of set operations of meshes: spheres of many triangles, identical operands, and many
// operands. `booleans volumes` prints volumes of random operations instead.

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "geom/boolean/boolean.h"

static const double pi = 3.14159265358979323846;

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double volume(const CagMesh *m) {
  double terms[10];
  cag_mesh_volume_terms(m, terms);
  return terms[0];
}

// Rings of n points from pole to pole, 2 n (n / 2 - 1) triangles.
static CagMesh *ball(CagVec3 center, double radius, uint32_t n) {
  CagMesh *m;
  CagError err;
  const uint32_t rings = n / 2, south = n * (rings - 1);
  if (cag_mesh_new(south + 2, 2 * n * (rings - 1), true, false, false, &m, &err)) exit(1);
  for (uint32_t i = 0; i < south + 2; i++) {
    const double polar = pi * (1 + i / n) / rings, turn = 2 * pi * (i % n) / n;
    CagVec3 d = cag_vec3(sin(polar) * cos(turn), sin(polar) * sin(turn), cos(polar));
    if (i >= south) d = cag_vec3(0, 0, i == south ? 1 : -1);
    m->positions[i] = cag_madd(center, radius, d);
    m->normals[i] = d;
  }
  uint32_t *t = m->triangles;
  for (uint32_t k = 0; k < n; k++) {
    const uint32_t next = (k + 1) % n, last = n * (rings - 2);
    const uint32_t caps[6] = {south, k, next, south + 1, last + next, last + k};
    memcpy(t, caps, sizeof caps);
    t += 6;
    for (uint32_t r = 0; r + 2 < rings; r++) {
      const uint32_t a = r * n + k, b = r * n + next, quad[6] = {a, a + n, b + n, a, b + n, b};
      memcpy(t, quad, sizeof quad);
      t += 6;
    }
  }
  return m;
}

static CagMesh *operate(const char *what, CagSetOperation op, const CagMesh *const *m, size_t n) {
  static const char *const names[] = {"union", "difference", "intersection"};
  CagMesh *out = NULL;
  CagError err;
  size_t triangles = 0;
  for (size_t i = 0; i < n; i++) triangles += m[i]->triangle_count;
  const double start = now();
  const CagStatus status = n == 2 ? cag_mesh_boolean(op, m[0], m[1], NULL, &out, &err)
                                  : cag_mesh_boolean_many(op, m, n, NULL, &out, &err);
  if (status) {
    printf("%s: %s\n", what, err.message);
    exit(1);
  }
  printf("%-34s %-12s %8zu -> %8zu triangles %7.3f s  volume %.12g\n", what, names[op], triangles,
         out->triangle_count, now() - start, volume(out));
  fflush(stdout);
  return out;
}

static void run(const char *what, CagSetOperation op, CagMesh *a, CagMesh *b) {
  const CagMesh *const pair[2] = {a, b};
  cag_mesh_release(operate(what, op, pair, 2));
  cag_mesh_release(a);
  cag_mesh_release(b);
}

static double random_number(void) {
  static uint64_t state = 11;
  state = state * 6364136223846793005u + 1442695040888963407u;
  return (double)(state >> 11) / 9007199254740992.0;
}

// Prints volumes of random operations, one per line, to compare builds.
static void print_volumes(void) {
  for (int i = 0; i < 30; i++) {
    const double x = random_number(), y = random_number(), z = random_number();
    CagMesh *a = ball(cag_vec3(0, 0, 0), 1, 8 + 2 * (uint32_t)i);
    CagMesh *b = ball(cag_vec3(x, y, z), 0.5 + random_number(), 60 - 2 * (uint32_t)(i % 20));
    CagMesh *m;
    CagError err;
    if (cag_mesh_boolean((CagSetOperation)(i % 3), a, b, NULL, &m, &err)) exit(1);
    printf("%.15g\n", volume(m));
    cag_mesh_release(a);
    cag_mesh_release(b);
    cag_mesh_release(m);
  }
}

int main(int argc, char **argv) {
  if (argc > 1 && strcmp(argv[1], "volumes") == 0) {
    print_volumes();
    return 0;
  }
  const uint32_t n = 318; // 100,488 triangles
  const CagVec3 o = cag_vec3(0, 0, 0), near = cag_vec3(0.5, 0.3, 0.1);
  for (int op = 0; op < 3; op++)
    run("two spheres", (CagSetOperation)op, ball(o, 1, n), ball(near, 1, n));
  run("two spheres, a tenth", CAG_UNION, ball(o, 1, 100), ball(near, 1, 100));
  run("the same sphere twice", CAG_UNION, ball(o, 1, n), ball(o, 1, n));
  run("a sphere and itself, 1e-9 aside", CAG_UNION, ball(o, 1, 100),
      ball(cag_vec3(1e-9, 2e-9, 3e-9), 1, 100));
  CagMesh *many[125];
  for (int i = 0; i < 125; i++)
    many[i] = ball(cag_vec3(i % 5 * 1.5, i / 5 % 5 * 1.5, i / 25 * 1.5), 1, 32);
  CagMesh *m = operate("125 spheres in a grid", CAG_UNION, (const CagMesh *const *)many, 125);
  cag_mesh_release(m);
  for (int i = 0; i < 125; i++) cag_mesh_release(many[i]);
  return 0;
}
