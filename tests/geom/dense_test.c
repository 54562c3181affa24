// Dense and banded systems: solutions are checked by their residuals. Every function ends when its
// thread's stop flag is set.

#include "geom/linalg/dense.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/sort.h"
#include "base/stop.h"
#include "tests/geom/random.h"

enum { N = 150 };
static const double ROUNDING = 1e-10; // for systems of this size with entries near 1

static volatile int flag;

static int take_back(void **state) {
  (void)state;
  cag_stop_lend(NULL);
  return 0;
}

static double *random_numbers(size_t n) {
  double *x = malloc(n * sizeof *x);
  for (size_t i = 0; i < n; i++) x[i] = uniform(-1, 1);
  return x;
}

static double *copy_of(const double *x, size_t n) {
  double *y = malloc(n * sizeof *y);
  memcpy(y, x, n * sizeof *y);
  return y;
}

static void lu_solves_systems_with_several_right_sides(void **state) {
  (void)state;
  enum { SIDES = 300 };
  CagError err;
  bool singular;
  size_t pivots[N];
  double *a = random_numbers(N * N), *lu = copy_of(a, N * N);
  double *x = random_numbers(N * SIDES), *b = copy_of(x, N * SIDES);
  assert_int_equal(cag_lu_factor(lu, N, pivots, &singular, &err), CAG_OK);
  assert_false(singular);
  assert_int_equal(cag_lu_solve(lu, N, pivots, x, SIDES, &err), CAG_OK);
  for (size_t i = 0; i < N; i++)
    for (size_t s = 0; s < SIDES; s++) {
      double sum = 0;
      for (size_t j = 0; j < N; j++) sum += a[i * N + j] * x[j * SIDES + s];
      assert_true(fabs(sum - b[i * SIDES + s]) < ROUNDING);
    }
  free(a);
  free(lu);
  free(x);
  free(b);
}

static void lu_finds_a_column_of_zeros(void **state) {
  (void)state;
  CagError err;
  bool singular;
  size_t pivots[N];
  double *a = random_numbers(N * N);
  for (size_t i = 0; i < N; i++) a[i * N + 70] = 0;
  assert_int_equal(cag_lu_factor(a, N, pivots, &singular, &err), CAG_OK);
  assert_true(singular);
  free(a);
}

// The condition number of a diagonal matrix is the ratio of its extremes.
static void the_condition_of_a_diagonal_matrix_is_exact(void **state) {
  (void)state;
  CagError err;
  bool singular;
  size_t pivots[N];
  double *a = calloc(N * N, sizeof *a), reciprocal;
  for (size_t i = 0; i < N; i++) a[i * N + i] = i == 40 ? 1e-6 : 2;
  assert_int_equal(cag_lu_factor(a, N, pivots, &singular, &err), CAG_OK);
  assert_int_equal(cag_lu_condition(a, N, pivots, 2, &reciprocal, &err), CAG_OK);
  assert_true(fabs(reciprocal / 5e-7 - 1) < ROUNDING);
  free(a);
}

// The residual is perpendicular to all columns, and the solution to the null space. The matrix is a
// product of rows x rank and rank x columns here.
static void check_shortest(size_t rows, size_t columns, size_t rank) {
  CagError err;
  const size_t room = rows > columns ? rows : columns;
  double *left = random_numbers(rows * rank), *upper = random_numbers(rank * columns);
  double *a = calloc(rows * columns, sizeof *a), *x = random_numbers(room);
  const double cut = 1e-12;
  for (size_t j = 0; j < columns; j++)
    for (size_t k = 0; k < rank; k++)
      for (size_t i = 0; i < rows; i++) a[j * rows + i] += left[k * rows + i] * upper[j * rank + k];
  double *given = copy_of(a, rows * columns), *residual = copy_of(x, rows);
  assert_int_equal(cag_least_squares(a, rows, columns, x, room, 1, &cut, &err), CAG_OK);
  for (size_t j = 0; j < columns; j++)
    for (size_t i = 0; i < rows; i++) residual[i] -= given[j * rows + i] * x[j];
  for (size_t j = 0; j < columns; j++) {
    double sum = 0;
    for (size_t i = 0; i < rows; i++) sum += given[j * rows + i] * residual[i];
    assert_true(fabs(sum) < 1e-8);
  }
  // The part of x perpendicular to the rows of `upper` is x minus its least squares fit by them.
  double *rows_of = malloc(columns * rank * sizeof *rows_of);
  for (size_t j = 0; j < columns; j++)
    for (size_t k = 0; k < rank; k++) rows_of[k * columns + j] = upper[j * rank + k];
  double *basis = copy_of(rows_of, columns * rank), *fit = calloc(columns + rank, sizeof *fit);
  memcpy(fit, x, columns * sizeof *fit);
  assert_int_equal(cag_least_squares(rows_of, columns, rank, fit, columns, 1, NULL, &err), CAG_OK);
  for (size_t j = 0; j < columns; j++) {
    double sum = 0;
    for (size_t k = 0; k < rank; k++) sum += basis[k * columns + j] * fit[k];
    assert_true(fabs(sum - x[j]) < 1e-8);
  }
  free(left);
  free(upper);
  free(a);
  free(x);
  free(given);
  free(residual);
  free(rows_of);
  free(basis);
  free(fit);
}

static void least_squares_are_the_shortest(void **state) {
  (void)state;
  check_shortest(120, 60, 60);
  check_shortest(120, 60, 25);
  check_shortest(60, 120, 60);
  check_shortest(60, 120, 25);
  check_shortest(50, 50, 1);
}

static void banded_systems_are_solved_as_dense_ones(void **state) {
  (void)state;
  enum { KL = 3, KU = 5, LD = 2 * KL + KU + 1, SIDES = 2 };
  CagError err;
  bool singular;
  double *a = calloc(N * N, sizeof *a), *band = calloc(N * LD, sizeof *band);
  double *x = random_numbers(SIDES * N), *b = copy_of(x, SIDES * N);
  for (size_t j = 0; j < N; j++)
    for (size_t i = j > KU ? j - KU : 0; i < N && i <= j + KL; i++)
      band[j * LD + KL + KU + i - j] = a[i * N + j] = uniform(-1, 1);
  assert_int_equal(cag_band_solve(band, N, KL, KU, x, SIDES, &singular, &err), CAG_OK);
  assert_false(singular);
  for (size_t s = 0; s < SIDES; s++)
    for (size_t i = 0; i < N; i++) {
      double sum = 0;
      for (size_t j = 0; j < N; j++) sum += a[i * N + j] * x[s * N + j];
      assert_true(fabs(sum - b[s * N + i]) < 1e-8);
    }
  free(a);
  free(band);
  free(x);
  free(b);
}

static void eigenvectors_are_unit_and_belong_to_their_values(void **state) {
  (void)state;
  CagError err;
  double *a = random_numbers(N * N), values[N];
  for (size_t i = 0; i < N; i++)
    for (size_t j = 0; j < i; j++) a[j * N + i] = a[i * N + j];
  double *v = copy_of(a, N * N);
  assert_int_equal(cag_symmetric_eigen(v, N, values, &err), CAG_OK);
  for (size_t k = 0; k < N; k++) {
    const double *x = v + k * N;
    double length = 0;
    if (k > 0) assert_true(values[k] >= values[k - 1]);
    for (size_t i = 0; i < N; i++) {
      double sum = 0;
      length += x[i] * x[i];
      for (size_t j = 0; j < N; j++) sum += a[i * N + j] * x[j];
      assert_true(fabs(sum - values[k] * x[i]) < ROUNDING);
    }
    assert_true(fabs(length - 1) < ROUNDING);
  }
  free(a);
  free(v);
}

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void long_lists_are_sorted_by_merging(void **state) {
  (void)state;
  enum { COUNT = 100003 };
  CagError err;
  double *x = random_numbers(COUNT);
  assert_int_equal(cag_sort(x, COUNT, sizeof *x, ascending, &err), CAG_OK);
  for (size_t i = 1; i < COUNT; i++) assert_true(x[i - 1] <= x[i]);
  free(x);
}

static void everything_ends_when_the_flag_is_set(void **state) {
  (void)state;
  CagError err;
  bool singular;
  size_t pivots[N];
  double *a = random_numbers(N * N), *x = random_numbers(N * N), reciprocal;
  const double cut = 1e-12;
  assert_int_equal(cag_lu_factor(a, N, pivots, &singular, &err), CAG_OK);
  flag = 1;
  cag_stop_lend(&flag);
  assert_int_equal(cag_lu_solve(a, N, pivots, x, 1, &err), CAG_E_CALLBACK);
  assert_int_equal(cag_lu_condition(a, N, pivots, 1, &reciprocal, &err), CAG_E_CALLBACK);
  assert_int_equal(cag_lu_factor(a, N, pivots, &singular, &err), CAG_E_CALLBACK);
  assert_int_equal(cag_least_squares(a, N, N, x, N, 1, NULL, &err), CAG_E_CALLBACK);
  assert_int_equal(cag_least_squares(a, N, N, x, N, 1, &cut, &err), CAG_E_CALLBACK);
  assert_int_equal(cag_band_solve(a, N, 10, 10, x, 1, &singular, &err), CAG_E_CALLBACK);
  assert_int_equal(cag_symmetric_eigen(a, N, x, &err), CAG_E_CALLBACK);
  assert_int_equal(cag_sort(x, N, sizeof *x, ascending, &err), CAG_E_CALLBACK);
  free(a);
  free(x);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lu_solves_systems_with_several_right_sides),
      cmocka_unit_test(lu_finds_a_column_of_zeros),
      cmocka_unit_test(the_condition_of_a_diagonal_matrix_is_exact),
      cmocka_unit_test(least_squares_are_the_shortest),
      cmocka_unit_test(banded_systems_are_solved_as_dense_ones),
      cmocka_unit_test(eigenvectors_are_unit_and_belong_to_their_values),
      cmocka_unit_test(long_lists_are_sorted_by_merging),
      cmocka_unit_test_teardown(everything_ends_when_the_flag_is_set, take_back),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
