// Bernstein polynomials and Bezier pieces in homogeneous coordinates.
//
// A piece of degree p is p + 1 points of four numbers (w x, w y, w z, w) over 0..1. All algorithms
// are convex combinations (de Casteljau): stable at any degree, and exact at the ends and for
// constant coordinates.

#ifndef CAG_GEOM_BERNSTEIN_H
#define CAG_GEOM_BERNSTEIN_H

#include "base/status.h"
#include "geom/linalg/vec.h"

// Highest degree of a curve; limits the buffers of a piece on the stack.
#define CAG_MAX_DEGREE 1000

// Linear interpolation, exact at both ends and for a == b.
static inline double cag_mix(double a, double b, double t) {
  return t < 0.5 ? a + t * (b - a) : b - (1 - t) * (b - a);
}

// The binomial coefficient C(n, k); exact if the result is below 2^53.
double cag_binomial(int n, int k);
// All n + 1 Bernstein polynomials of degree n at t in 0..1.
void cag_bernstein(int n, double t, double *out);

// Derivatives of order 0..order with respect to u at u: out[k * 4 ..]; 0 above the degree.
void cag_bezier_derivatives(const double *b, int p, double u, int order, double *out);
// The part over [u, v], reparametrized to 0..1. out must not overlap b.
void cag_bezier_segment(const double *b, int p, double u, double v, double *out);
// Elevates the degree of the piece to p + 1: out has p + 2 points.
void cag_bezier_elevate(const double *b, int p, double *out);
// The Cartesian point of four homogeneous coordinates.
static inline CagVec3 cag_project(const double h[4]) {
  return h[3] == 1 ? cag_vec3(h[0], h[1], h[2]) : cag_vec3(h[0] / h[3], h[1] / h[3], h[2] / h[3]);
}
// Derivatives of the point from those of its homogeneous coordinates (Leibniz's rule applied to P
// w): h[k * 4 ..] for k = 0..order; the weight h[3] must not be 0.
void cag_rational_derivatives(const double *h, int order, CagVec3 *out);

#endif
