// Benchmarks of robots: forward kinematics, Jacobian, and numerical inverse kinematics of random
// reachable poses, compared with the peer, whose lines are read from the given file.

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "geom/robot/numeric.h"
#include "tests/bench/robots.h"

#define REPEATS 20
#define LONGEST 5e-3 // the maximum seconds for a pose

typedef struct Peer {
  double fk, jacobian, solved, mean; // us, us, fraction, ms
} Peer;

static CagRobot *make(const BenchChain *c) {
  const double degree = 0.017453292519943295;
  CagRobotLink links[BENCH_JOINTS_MAX];
  for (int i = 0; i < c->n; i++) {
    const BenchRow *row = &c->rows[i];
    links[i] = cag_robot_link(CAG_JOINT_REVOLUTE);
    links[i].theta = row->theta * degree;
    links[i].d = row->d;
    links[i].a = row->a;
    links[i].alpha = row->alpha * degree;
    links[i].low = row->low * degree;
    links[i].high = row->high * degree;
    links[i].home = (links[i].low + links[i].high) / 2;
  }
  CagRobotSpec spec = {.links = links,
                       .link_count = (size_t)c->n,
                       .base = cag_transform_identity(),
                       .tool = cag_transform_identity()};
  CagRobot *r = NULL;
  CagError err;
  if (cag_robot_new(&spec, &r, &err)) fprintf(stderr, "%s\n", err.message);
  return r;
}

static double q[BENCH_POSES][BENCH_JOINTS_MAX];
static volatile double sink;

// The best of several rounds, in microseconds per call.
static void time_forward(const CagRobot *r, double *forward, double *jacobian) {
  *forward = *jacobian = INFINITY;
  for (int round = 0; round < REPEATS; round++) {
    double start = bench_now(), sum = 0;
    for (int k = 0; k < BENCH_POSES; k++) {
      CagTransform t;
      cag_robot_forward(r, q[k], &t);
      sum += t.m[0][3];
    }
    *forward = fmin(*forward, (bench_now() - start) / BENCH_POSES * 1e6);
    start = bench_now();
    for (int k = 0; k < BENCH_POSES; k++) {
      double columns[BENCH_JOINTS_MAX][6];
      cag_robot_jacobian(r, q[k], columns, NULL);
      sum += columns[0][0];
    }
    *jacobian = fmin(*jacobian, (bench_now() - start) / BENCH_POSES * 1e6);
    sink = sum;
  }
}

// Whether joint values are within the limits and lead to the target pose.
static bool is_solution(const CagRobot *r, const CagTransform *wanted, const double *x) {
  CagTransform t;
  double by, position, rotation;
  cag_robot_forward(r, x, &t);
  cag_robot_pose_distance(&t, wanted, &position, &rotation);
  return cag_robot_outside(r, x, &by) == r->joint_count && position <= BENCH_TOLERANCE &&
         rotation <= BENCH_TOLERANCE;
}

static void time_inverse(const CagRobot *r, double *solved, double *mean, double *longest) {
  size_t count = 0;
  double sum = 0;
  *longest = 0;
  for (int k = 0; k < BENCH_POSES; k++) {
    CagTransform wanted;
    double x[BENCH_JOINTS_MAX];
    CagRobotSearch search = {.position = BENCH_TOLERANCE, .rotation = BENCH_TOLERANCE};
    cag_robot_forward(r, q[k], &wanted);
    double start = bench_now();
    bool found = cag_robot_search(r, &wanted, &search, x).solved;
    double time = bench_now() - start;
    sum += time;
    *longest = fmax(*longest, time);
    count += found && time <= LONGEST && is_solution(r, &wanted, x);
  }
  *solved = 100.0 * (double)count / BENCH_POSES;
  *mean = sum / BENCH_POSES * 1e3;
  *longest *= 1e3;
}

int main(int argc, char **argv) {
  FILE *peers = argc > 1 ? fopen(argv[1], "r") : NULL;
  for (size_t i = 0; i < BENCH_CHAINS; i++) {
    const BenchChain *c = &bench_chains[i];
    CagRobot *r = make(c);
    if (!r) return 1;
    Peer peer;
    double forward, jacobian, solved, mean, longest;
    bool beside = peers && fscanf(peers, "%lf %lf %lf %lf", &peer.fk, &peer.jacobian, &peer.solved,
                                  &peer.mean) == 4;
    bench_samples(c, q);
    time_forward(r, &forward, &jacobian);
    time_inverse(r, &solved, &mean, &longest);
    printf("%-15s fk %6.3f us", c->name, forward);
    if (beside) printf(" (KDL %.3f, ratio %.1f)", peer.fk, peer.fk / forward);
    printf("  Jacobian %6.3f us", jacobian);
    if (beside) printf(" (KDL %.3f, ratio %.1f)", peer.jacobian, peer.jacobian / jacobian);
    printf("\n%-15s numerical inverse %.2f %% solved, mean %.4f ms, longest %.2f ms", "", solved,
           mean, longest);
    if (beside) printf(" (KDL NR_JL %.2f %%, %.4f ms)", peer.solved, peer.mean);
    printf("\n");
    cag_robot_release(r);
  }
  if (peers) fclose(peers);
  return 0;
}
