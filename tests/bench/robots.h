// The chains and the sequence of joint values for the benchmarks of robots: for our side in C and
// the peer's in C++. Rows are classic Denavit-Hartenberg, in meters and degrees, with limits.

#ifndef CAG_BENCH_ROBOTS_H
#define CAG_BENCH_ROBOTS_H

#include <stdint.h>
#include <time.h>

#define BENCH_POSES 10000
#define BENCH_JOINTS_MAX 15
#define BENCH_TOLERANCE 1e-5 // m and rad

typedef struct BenchRow {
  double theta, d, a, alpha, low, high;
} BenchRow;
typedef struct BenchChain {
  const char *name;
  int n;
  BenchRow rows[BENCH_JOINTS_MAX];
} BenchChain;

// The tables of Panda and the arm of five joints differ from the makers' by a shift; limits are the
// makers'.
static const BenchChain bench_chains[] = {
    {"Puma 560",
     6,
     {{0, 0, 0, -90, -160, 160},
      {0, .14909, .4318, 0, -225, 45},
      {0, 0, -.02032, 90, -45, 225},
      {0, .43307, 0, -90, -110, 170},
      {0, 0, 0, 90, -100, 100},
      {0, .05625, 0, 0, -266, 266}}},
    {"IRB 120",
     6,
     {{0, .29, 0, -90, -165, 165},
      {-90, 0, .27, 0, -110, 110},
      {0, 0, .07, -90, -110, 70},
      {0, .302, 0, 90, -160, 160},
      {0, 0, 0, -90, -120, 120},
      {180, .072, 0, 0, -400, 400}}},
    {"Panda",
     7,
     {{0, .333, 0, -90, -166, 166},
      {0, 0, 0, 90, -101, 101},
      {0, .316, .0825, 90, -166, 166},
      {0, 0, -.0825, -90, -176, -4},
      {0, .384, 0, 90, -166, 166},
      {0, 0, .088, 90, -1, 215},
      {0, .107, 0, 0, -166, 166}}},
    {"iiwa 14",
     7,
     {{0, .36, 0, -90, -170, 170},
      {0, 0, 0, 90, -120, 120},
      {0, .42, 0, 90, -170, 170},
      {0, 0, 0, -90, -120, 120},
      {0, .4, 0, -90, -170, 170},
      {0, 0, 0, 90, -120, 120},
      {0, .126, 0, 0, -175, 175}}},
    {"five joints",
     5,
     {{0, .29, 0, -90, -165, 165},
      {-90, 0, .27, 0, -110, 110},
      {0, 0, .27, 0, -110, 110},
      {0, 0, 0, -90, -120, 120},
      {0, .15, 0, 0, -180, 180}}},
    {"fifteen joints",
     15,
     {{0, .12, 0, 90, -120, 120},
      {0, 0, .05, -90, -120, 120},
      {0, .12, 0, 90, -120, 120},
      {0, 0, .05, -90, -120, 120},
      {0, .12, 0, 90, -120, 120},
      {0, 0, .05, -90, -120, 120},
      {0, .12, 0, 90, -120, 120},
      {0, 0, .05, -90, -120, 120},
      {0, .12, 0, 90, -120, 120},
      {0, 0, .05, -90, -120, 120},
      {0, .12, 0, 90, -120, 120},
      {0, 0, .05, -90, -120, 120},
      {0, .12, 0, 90, -120, 120},
      {0, 0, .05, -90, -120, 120},
      {0, .12, 0, 90, -120, 120}}},
};
#define BENCH_CHAINS (sizeof bench_chains / sizeof *bench_chains)

// Joint values in radians, distributed evenly over the limits, the same for both sides.
static inline void bench_samples(const BenchChain *c, double (*q)[BENCH_JOINTS_MAX]) {
  const double degree = 0.017453292519943295;
  uint64_t state = 12345;
  for (int k = 0; k < BENCH_POSES; k++)
    for (int i = 0; i < c->n; i++) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      double u = (double)(state >> 11) / 9007199254740992.0;
      q[k][i] = (c->rows[i].low + u * (c->rows[i].high - c->rows[i].low)) * degree;
    }
}

// The processor time of this program in seconds, so that other programs do not count.
static inline double bench_now(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

#endif
