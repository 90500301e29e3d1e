/* SPDX-License-Identifier: BSD-3-Clause */
/* C99: an operator of one's own instead of a mesh. A smooths the samples of an open curve: (1 - t) x_i + t (a x_(i - 1) + b x_(i + 1)), a + b = 1, with weights
   inversely as the distances to the two neighbours, so that uneven samples of a straight line stay where they are. The ends stay. D_ii = the sum of both
   inverse distances makes D A symmetric. Solved for P with A P = M: the curve that A smooths to the given one. */
#include <limitcl/limitcl.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SAMPLES = 200 };

#define SMOOTHING 0.45 /* t: the eigenvalues are 1 - 2 t or more */

static double M[2 * SAMPLES], P[2 * SAMPLES], smooth[2 * SAMPLES];
static int64_t offsets[SAMPLES + 1];
static int32_t columns[3 * SAMPLES];
static double weights[3 * SAMPLES], scaling[SAMPLES];

static void check(lcl_status status) {
    if (status == LCL_OK) return;
    fprintf(stderr, "%s: %s\n", lcl_status_string(status), lcl_last_error());
    exit(1);
}

/* A spiral whose samples crowd towards its middle. */
static void make_curve(void) {
    for (int i = 0; i < SAMPLES; ++i) {
        const double s = (i + 1.0) / SAMPLES, angle = 12.0 * s;
        M[2 * i] = s * s * cos(angle);
        M[2 * i + 1] = s * s * sin(angle);
    }
}

static double distance(int i) { return hypot(M[2 * i + 2] - M[2 * i], M[2 * i + 3] - M[2 * i + 1]); }

static void add(int row, int column, double weight) {
    columns[offsets[row + 1]] = column;
    weights[offsets[row + 1]++] = weight;
}

static void make_rows(void) {
    for (int i = 0; i < SAMPLES; ++i) {
        const int is_end = i == 0 || i == SAMPLES - 1;
        const double before = is_end ? 1.0 : 1.0 / distance(i - 1), after = is_end ? 1.0 : 1.0 / distance(i);
        offsets[i + 1] = offsets[i];
        scaling[i] = before + after; /* D A: 1 / distance between two samples, for both of them the same */
        add(i, i, is_end ? 1.0 : 1.0 - SMOOTHING);
        if (is_end) continue;
        add(i, i - 1, SMOOTHING * before / (before + after));
        add(i, i + 1, SMOOTHING * after / (before + after));
    }
}

int main(void) {
    lcl_context context = NULL;
    lcl_operator A = NULL;
    lcl_rows rows = LCL_ROWS_INIT;
    lcl_diagnosis diagnosis = LCL_DIAGNOSIS_INIT;
    lcl_solve_options options = LCL_SOLVE_OPTIONS_INIT;
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;

    make_curve();
    make_rows();
    rows.row_count = SAMPLES;
    rows.offsets = offsets;
    rows.columns = columns;
    rows.weights = weights;
    rows.scaling = scaling;
    check(lcl_context_create(NULL, &context));
    check(lcl_operator_create_rows(context, &rows, &A));
    check(lcl_operator_diagnose(A, &diagnosis));
    printf("the smallest eigenvalue is about %.3f, and at least %.3f\n", diagnosis.lambda_min_estimate, diagnosis.lambda_min_bound);

    options.solver = LCL_SOLVER_CG; /* which D is for */
    options.tolerance = 1e-8;
    check(lcl_interpolate(A, M, 0, 2, &options, P, 0, &report));
    check(lcl_limit_points(A, P, 0, 2, LCL_PRECISION_MIXED, smooth, 0));
    double worst = 0.0;
    for (int i = 0; i < 2 * SAMPLES; ++i) worst = fmax(worst, fabs(smooth[i] - M[i]));
    printf("%d iterations; A P meets M to %.1e\n", report.iterations, worst);

    lcl_operator_release(A);
    lcl_context_release(context);
    return diagnosis.lambda_min_bound > 0.099 && worst <= 3e-8 ? 0 : 1;
}
