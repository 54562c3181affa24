// LAPACK's functions by Eigen.

#include "lapacke.h"

#include <Eigen/Dense>

namespace {

using Matrix = Eigen::MatrixXd;
using Columns = Eigen::Map<Matrix, 0, Eigen::OuterStride<>>;
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Rows = Eigen::Map<RowMatrix, 0, Eigen::OuterStride<>>;

Columns columns_of(double *a, int m, int n, int lda) {
  return Columns(a, m, n, Eigen::OuterStride<>(lda));
}

Rows rows_of(double *a, int m, int n, int lda) { return Rows(a, m, n, Eigen::OuterStride<>(lda)); }

Matrix read(int layout, const double *a, int m, int n, int lda) {
  double *p = const_cast<double *>(a); // only read
  if (layout == LAPACK_ROW_MAJOR) return rows_of(p, m, n, lda);
  return columns_of(p, m, n, lda);
}

void write(int layout, const Matrix &from, double *a, int lda) {
  const int m = (int)from.rows(), n = (int)from.cols();
  if (layout == LAPACK_ROW_MAJOR) rows_of(a, m, n, lda) = from;
  else columns_of(a, m, n, lda) = from;
}

int singular_values(int layout, char jobu, char jobvt, const Matrix &a, double *s, double *u,
                    int ldu, double *vt, int ldvt) {
  if (!a.allFinite()) return 1;
  const unsigned options =
      (jobu == 'A' ? Eigen::ComputeFullU : 0) | (jobvt == 'A' ? Eigen::ComputeFullV : 0);
  const Eigen::JacobiSVD<Matrix> svd(a, options);
  Eigen::Map<Eigen::VectorXd>(s, svd.singularValues().size()) = svd.singularValues();
  if (jobu == 'A') write(layout, svd.matrixU(), u, ldu);
  if (jobvt == 'A') write(layout, svd.matrixV().transpose(), vt, ldvt);
  return 0;
}

// Replaces the rows of b by those of the permutation, or back.
void exchange_rows(Matrix &b, const lapack_int *pivots) {
  for (int i = 0; i < b.rows(); i++)
    if (pivots[i] - 1 != i) b.row(i).swap(b.row(pivots[i] - 1));
}

Matrix solve_factored(const Matrix &lu, const lapack_int *pivots, Matrix b) {
  exchange_rows(b, pivots);
  lu.triangularView<Eigen::UnitLower>().solveInPlace(b);
  lu.triangularView<Eigen::Upper>().solveInPlace(b);
  return b;
}

double column_norm(const Matrix &a) {
  return a.size() ? a.cwiseAbs().colwise().sum().maxCoeff() : 0;
}

} // namespace

// The triangle replaces the upper part of a, as in LAPACK.
lapack_int LAPACKE_dgels(int layout, char, lapack_int m, lapack_int n, lapack_int sides, double *a,
                         lapack_int lda, double *b, lapack_int ldb) {
  if (layout != LAPACK_COL_MAJOR || m < n) return -1;
  Columns matrix = columns_of(a, m, n, lda), right = columns_of(b, m, sides, ldb);
  const Eigen::HouseholderQR<Matrix> qr(matrix);
  matrix = qr.matrixQR();
  for (int i = 0; i < n; i++)
    if (matrix(i, i) == 0) return i + 1;
  const Matrix turned = qr.householderQ().transpose() * right;
  right = turned;
  right.topRows(n) =
      qr.matrixQR().topRows(n).triangularView<Eigen::Upper>().solve(turned.topRows(n));
  return 0;
}

lapack_int LAPACKE_dgelsd(int layout, lapack_int m, lapack_int n, lapack_int sides, double *a,
                          lapack_int lda, double *b, lapack_int ldb, double *s, double rcond,
                          lapack_int *rank) {
  const Matrix matrix = read(layout, a, m, n, lda);
  if (!matrix.allFinite()) return 1;
  Eigen::JacobiSVD<Matrix> svd(matrix, Eigen::ComputeThinU | Eigen::ComputeThinV);
  svd.setThreshold(rcond);
  Eigen::Map<Eigen::VectorXd>(s, svd.singularValues().size()) = svd.singularValues();
  *rank = (lapack_int)svd.rank();
  write(layout, svd.solve(read(layout, b, m, sides, ldb)), b, ldb);
  return 0;
}

lapack_int LAPACKE_dgesvd(int layout, char jobu, char jobvt, lapack_int m, lapack_int n, double *a,
                          lapack_int lda, double *s, double *u, lapack_int ldu, double *vt,
                          lapack_int ldvt, double *) {
  return singular_values(layout, jobu, jobvt, read(layout, a, m, n, lda), s, u, ldu, vt, ldvt);
}

lapack_int LAPACKE_dgesvd_work(int layout, char jobu, char jobvt, lapack_int m, lapack_int n,
                               double *a, lapack_int lda, double *s, double *u, lapack_int ldu,
                               double *vt, lapack_int ldvt, double *, lapack_int) {
  return singular_values(layout, jobu, jobvt, read(layout, a, m, n, lda), s, u, ldu, vt, ldvt);
}

lapack_int LAPACKE_dgeqrf_work(int layout, lapack_int m, lapack_int n, double *a, lapack_int lda,
                               double *tau, double *, lapack_int) {
  const Eigen::HouseholderQR<Matrix> qr(read(layout, a, m, n, lda));
  write(layout, qr.matrixQR(), a, lda);
  Eigen::Map<Eigen::VectorXd>(tau, qr.hCoeffs().size()) = qr.hCoeffs();
  return 0;
}

lapack_int LAPACKE_dgeev(int layout, char, char jobvr, lapack_int n, double *a, lapack_int lda,
                         double *wr, double *wi, double *, lapack_int, double *vr,
                         lapack_int ldvr) {
  const Matrix matrix = read(layout, a, n, n, lda);
  if (!matrix.allFinite()) return 1;
  const Eigen::EigenSolver<Matrix> solver(matrix, jobvr == 'V');
  if (solver.info() != Eigen::Success) return 1;
  for (int i = 0; i < n; i++) {
    wr[i] = solver.eigenvalues()[i].real();
    wi[i] = solver.eigenvalues()[i].imag();
  }
  if (jobvr == 'V') write(layout, solver.pseudoEigenvectors(), vr, ldvr);
  return 0;
}

lapack_int LAPACKE_dsyevd(int layout, char, char, lapack_int n, double *a, lapack_int lda,
                          double *w) {
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(read(layout, a, n, n, lda));
  if (solver.info() != Eigen::Success) return 1;
  Eigen::Map<Eigen::VectorXd>(w, n) = solver.eigenvalues();
  write(layout, solver.eigenvectors(), a, lda);
  return 0;
}

// Gaussian elimination with partial pivoting. The second diagonal above replaces `below`.
lapack_int LAPACKE_dgtsv(int, lapack_int n, lapack_int sides, double *below, double *diagonal,
                         double *above, double *b, lapack_int ldb) {
  Columns right = columns_of(b, n, sides, ldb);
  for (int i = 0; i + 1 < n; i++) {
    if (std::fabs(diagonal[i]) < std::fabs(below[i])) {
      const double next = i + 2 < n ? above[i + 1] : 0, factor = diagonal[i] / below[i];
      const double old = above[i];
      diagonal[i] = below[i];
      above[i] = diagonal[i + 1];
      diagonal[i + 1] = old - factor * above[i];
      if (i + 2 < n) above[i + 1] = -factor * next;
      below[i] = next;
      right.row(i).swap(right.row(i + 1));
      right.row(i + 1) -= factor * right.row(i);
    } else {
      if (diagonal[i] == 0) return i + 1;
      const double factor = below[i] / diagonal[i];
      diagonal[i + 1] -= factor * above[i];
      right.row(i + 1) -= factor * right.row(i);
      below[i] = 0;
    }
  }
  if (n > 0 && diagonal[n - 1] == 0) return n;
  for (int i = n - 1; i >= 0; i--) {
    if (i + 1 < n) right.row(i) -= above[i] * right.row(i + 1);
    if (i + 2 < n) right.row(i) -= below[i] * right.row(i + 2);
    right.row(i) /= diagonal[i];
  }
  return 0;
}

double LAPACKE_dlange(int layout, char, lapack_int m, lapack_int n, const double *a,
                      lapack_int lda) {
  return column_norm(read(layout, a, m, n, lda));
}

lapack_int LAPACKE_dgetrf(int layout, lapack_int m, lapack_int n, double *a, lapack_int lda,
                          lapack_int *pivots) {
  Matrix lu = read(layout, a, m, n, lda);
  lapack_int info = 0;
  for (int k = 0; k < n; k++) {
    int row;
    lu.col(k).tail(m - k).cwiseAbs().maxCoeff(&row);
    row += k;
    pivots[k] = row + 1;
    if (lu(row, k) == 0) {
      if (!info) info = k + 1;
      continue;
    }
    if (row != k) lu.row(k).swap(lu.row(row));
    lu.col(k).tail(m - k - 1) /= lu(k, k);
    lu.bottomRightCorner(m - k - 1, n - k - 1).noalias() -=
        lu.col(k).tail(m - k - 1) * lu.row(k).tail(n - k - 1);
  }
  write(layout, lu, a, lda);
  return info;
}

// LAPACK estimates the norm of the inverse. This is the norm itself.
lapack_int LAPACKE_dgecon(int layout, char, lapack_int n, const double *a, lapack_int lda,
                          double size, double *reciprocal) {
  const Matrix lu = read(layout, a, n, n, lda);
  Matrix inverse = Matrix::Identity(n, n); // up to the order of its columns
  lu.triangularView<Eigen::UnitLower>().solveInPlace(inverse);
  lu.triangularView<Eigen::Upper>().solveInPlace(inverse);
  const double norm = column_norm(inverse);
  *reciprocal = norm > 0 && size > 0 ? 1 / norm / size : 0;
  return 0;
}

lapack_int LAPACKE_dgetrs(int layout, char, lapack_int n, lapack_int sides, const double *a,
                          lapack_int lda, const lapack_int *pivots, double *b, lapack_int ldb) {
  write(layout, solve_factored(read(layout, a, n, n, lda), pivots, read(layout, b, n, sides, ldb)),
        b, ldb);
  return 0;
}
