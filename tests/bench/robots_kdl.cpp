// The peer in the benchmarks of robots, Orocos KDL. Prints a line of numbers for each chain: the time
// of forward kinematics and of the Jacobian (us), the percentage of poses solved by Newton-Raphson
// with joint limits, and the mean time (ms), for the same poses.

#include <cmath>
#include <cstdio>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_nr_jl.hpp>
#include <kdl/chainiksolvervel_pinv.hpp>
#include <kdl/chainjnttojacsolver.hpp>

#include "tests/bench/robots.h"

static const double degree = 0.017453292519943295;
static const int repeats = 20, iterations = 100;
static double q[BENCH_POSES][BENCH_JOINTS_MAX];
static volatile double sink;

static void run(const BenchChain &c) {
  KDL::Chain chain;
  KDL::JntArray low(c.n), high(c.n), middle(c.n), x(c.n);
  for (int i = 0; i < c.n; i++) {
    const BenchRow &row = c.rows[i];
    chain.addSegment(
        KDL::Segment(KDL::Joint(KDL::Joint::RotZ),
                     KDL::Frame::DH(row.a, row.alpha * degree, row.d, row.theta * degree)));
    low(i) = row.low * degree;
    high(i) = row.high * degree;
    middle(i) = (low(i) + high(i)) / 2;
  }
  KDL::ChainFkSolverPos_recursive forward(chain);
  KDL::ChainJntToJacSolver jacobian(chain);
  KDL::ChainIkSolverVel_pinv rates(chain);
  KDL::ChainIkSolverPos_NR_JL inverse(chain, low, high, forward, rates, iterations,
                                      BENCH_TOLERANCE);
  bench_samples(&c, q);
  static KDL::JntArray places[BENCH_POSES];
  static KDL::Frame poses[BENCH_POSES];
  for (int k = 0; k < BENCH_POSES; k++) {
    places[k].resize(c.n);
    for (int i = 0; i < c.n; i++) places[k](i) = q[k][i];
    forward.JntToCart(places[k], poses[k]);
  }
  double best_forward = INFINITY, best_jacobian = INFINITY;
  KDL::Jacobian j(c.n);
  for (int round = 0; round < repeats; round++) {
    KDL::Frame f;
    double sum = 0;
    double start = bench_now();
    for (int k = 0; k < BENCH_POSES; k++) {
      forward.JntToCart(places[k], f);
      sum += f.p.x();
    }
    best_forward = std::fmin(best_forward, (bench_now() - start) / BENCH_POSES * 1e6);
    start = bench_now();
    for (int k = 0; k < BENCH_POSES; k++) {
      jacobian.JntToJac(places[k], j);
      sum += j(0, 0);
    }
    best_jacobian = std::fmin(best_jacobian, (bench_now() - start) / BENCH_POSES * 1e6);
    sink = sum;
  }
  int solved = 0;
  double start = bench_now();
  for (int k = 0; k < BENCH_POSES; k++) {
    if (inverse.CartToJnt(middle, poses[k], x) < 0) continue;
    KDL::Frame f;
    forward.JntToCart(x, f);
    solved += (f.p - poses[k].p).Norm() <= 10 * BENCH_TOLERANCE;
  }
  double mean = (bench_now() - start) / BENCH_POSES * 1e3;
  std::printf("%.6f %.6f %.4f %.6f\n", best_forward, best_jacobian, 100.0 * solved / BENCH_POSES,
              mean);
}

int main() {
  for (const BenchChain &c : bench_chains) run(c);
}
