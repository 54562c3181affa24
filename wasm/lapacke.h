// The functions of LAPACK that the geometry core uses, for builds without LAPACK. Arguments and
// results are those of LAPACKE. Only the values of the arguments that the core uses are supported.

#ifndef CAG_WASM_LAPACKE_H
#define CAG_WASM_LAPACKE_H

#ifdef __cplusplus
extern "C" {
#endif

typedef int lapack_int;

#define LAPACK_ROW_MAJOR 101
#define LAPACK_COL_MAJOR 102

lapack_int LAPACKE_dgels(int layout, char trans, lapack_int m, lapack_int n, lapack_int sides,
                         double *a, lapack_int lda, double *b, lapack_int ldb);
lapack_int LAPACKE_dgelsd(int layout, lapack_int m, lapack_int n, lapack_int sides, double *a,
                          lapack_int lda, double *b, lapack_int ldb, double *s, double rcond,
                          lapack_int *rank);
lapack_int LAPACKE_dgesvd(int layout, char jobu, char jobvt, lapack_int m, lapack_int n, double *a,
                          lapack_int lda, double *s, double *u, lapack_int ldu, double *vt,
                          lapack_int ldvt, double *superb);
lapack_int LAPACKE_dgesvd_work(int layout, char jobu, char jobvt, lapack_int m, lapack_int n,
                               double *a, lapack_int lda, double *s, double *u, lapack_int ldu,
                               double *vt, lapack_int ldvt, double *work, lapack_int lwork);
lapack_int LAPACKE_dgeqrf_work(int layout, lapack_int m, lapack_int n, double *a, lapack_int lda,
                               double *tau, double *work, lapack_int lwork);
lapack_int LAPACKE_dgeev(int layout, char jobvl, char jobvr, lapack_int n, double *a,
                         lapack_int lda, double *wr, double *wi, double *vl, lapack_int ldvl,
                         double *vr, lapack_int ldvr);
lapack_int LAPACKE_dsyevd(int layout, char jobz, char uplo, lapack_int n, double *a, lapack_int lda,
                          double *w);
lapack_int LAPACKE_dgtsv(int layout, lapack_int n, lapack_int sides, double *below,
                         double *diagonal, double *above, double *b, lapack_int ldb);
double LAPACKE_dlange(int layout, char norm, lapack_int m, lapack_int n, const double *a,
                      lapack_int lda);
lapack_int LAPACKE_dgetrf(int layout, lapack_int m, lapack_int n, double *a, lapack_int lda,
                          lapack_int *pivots);
lapack_int LAPACKE_dgecon(int layout, char norm, lapack_int n, const double *a, lapack_int lda,
                          double size, double *reciprocal);
lapack_int LAPACKE_dgetrs(int layout, char trans, lapack_int n, lapack_int sides, const double *a,
                          lapack_int lda, const lapack_int *pivots, double *b, lapack_int ldb);

#ifdef __cplusplus
}
#endif

#endif
