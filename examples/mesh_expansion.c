/* SPDX-License-Identifier: BSD-3-Clause */
/* C99: the mesh expansion M = sum of (E - A)^i A M on a torus with noise: its terms and bands, an equaliser, the spectrum, and what follows: denoising that
   keeps the volume, and sharpening. */
#include <limitcl/limitcl.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { RING = 48, TUBE = 24, VERTICES = RING * TUBE, VALUES = 3 * VERTICES, TERMS = 8 };

#define NOISE 0.05 /* model units, in every direction; the torus is 8 wide, and its edges are some 0.3 long */

static double clean[VALUES], M[VALUES], smooth[VALUES], sharp[VALUES], out[VALUES], sum[VALUES], louder[VALUES];
static int32_t faces[4 * VERTICES];

static void check(lcl_status status) {
    if (status == LCL_OK) return;
    fprintf(stderr, "%s: %s\n", lcl_status_string(status), lcl_last_error());
    exit(1);
}

static lcl_mesh make_torus(void) {
    uint32_t random = 1;
    for (int v = 0; v < VERTICES; ++v) {
        const int i = v / TUBE, j = v % TUBE, next_i = (i + 1) % RING, next_j = (j + 1) % TUBE;
        const double u = 6.283185307179586 * i / RING, w = 6.283185307179586 * j / TUBE;
        const double point[3] = {(3.0 + cos(w)) * cos(u), (3.0 + cos(w)) * sin(u), sin(w)};
        const int32_t face[4] = {v, next_i * TUBE + j, next_i * TUBE + next_j, i * TUBE + next_j};
        for (int k = 0; k < 3; ++k) {
            random = 1664525u * random + 1013904223u;
            clean[3 * v + k] = point[k];
            M[3 * v + k] = point[k] + NOISE * (2.0 * (random >> 8) / 16777216.0 - 1.0);
        }
        for (int k = 0; k < 4; ++k) faces[4 * v + k] = face[k];
    }
    lcl_mesh mesh = NULL;
    lcl_mesh_data data = LCL_MESH_DATA_INIT;
    data.vertex_count = data.face_count = VERTICES;
    data.uniform_degree = 4;
    data.face_vertices = faces;
    data.points = M;
    check(lcl_mesh_create(&data, &mesh));
    return mesh;
}

/* Root mean square of the distances between the vertices of two meshes. */
static double distance(const double* a, const double* b) {
    double squares = 0.0;
    for (int i = 0; i < VALUES; ++i) squares += (a[i] - b[i]) * (a[i] - b[i]);
    return sqrt(squares / VERTICES);
}

/* Prints the energies of the terms, the sum over x, y, z, and returns the last one, that of the finest details. */
static double print_spectrum(lcl_operator A, const char* name, const double* points) {
    double energies[3 * TERMS], energy = 0.0;
    check(lcl_spectrum(A, points, 0, 3, LCL_PRECISION_MIXED, TERMS, energies));
    printf("%-9s energies of terms 0 to %d:", name, TERMS - 1);
    for (int i = 0; i < TERMS; ++i) printf(" %.1e", energy = energies[3 * i] + energies[3 * i + 1] + energies[3 * i + 2]);
    printf("\n");
    return energy;
}

int main(void) {
    lcl_context context = NULL;
    lcl_operator A = NULL;
    lcl_mesh mesh = make_torus();
    check(lcl_context_create(NULL, &context));
    check(lcl_operator_create(context, mesh, NULL, &A)); /* quads: Catmull-Clark */

    /* Bands are sums of neighbouring terms. Together they are the partial sum, a smooth version of M. */
    const int32_t bands[][2] = {{0, 0}, {1, 1}, {2, 3}, {4, 7}};
    lcl_expand_options expand = LCL_EXPAND_OPTIONS_INIT;
    for (int b = 0; b < 4; ++b) {
        expand.first = bands[b][0];
        expand.last = bands[b][1];
        check(lcl_expand(A, M, 0, 3, &expand, out, 0));
        for (int i = 0; i < VALUES; ++i) sum[i] += out[i];
        if (b == 2)
            for (int i = 0; i < VALUES; ++i) louder[i] = M[i] + 2.0 * out[i];
    }
    expand.first = 0;
    check(lcl_expand(A, M, 0, 3, &expand, out, 0));
    const double of_bands = distance(sum, out);

    /* An equaliser weighs every term, and what the terms leave: all ones give M back, and 3 for terms 2 and 3 adds their band twice. */
    double weights[TERMS];
    for (int i = 0; i < TERMS; ++i) weights[i] = 1.0;
    expand.weights = weights;
    expand.weight_count = TERMS;
    check(lcl_expand(A, M, 0, 3, &expand, out, 0));
    const double of_ones = distance(out, M);
    weights[2] = weights[3] = 3.0;
    check(lcl_expand(A, M, 0, 3, &expand, out, 0));
    const double of_three = distance(out, louder);
    printf("bands and the partial sum differ by %.1e, all ones and M by %.1e, a louder band and M with it by %.1e\n", of_bands, of_ones, of_three);

    /* Denoising shrinks; the volume comes back by an offset along the normals. */
    double volume = 0.0, shrunk = 0.0, restored = 0.0;
    check(lcl_mesh_get_volume(mesh, &volume));
    check(lcl_denoise(A, M, 0, 3, NULL, smooth, 0));
    check(lcl_mesh_set_points(mesh, smooth, 0));
    check(lcl_mesh_get_volume(mesh, &shrunk));
    check(lcl_mesh_match_volume(mesh, M, 0, NULL, 0));
    check(lcl_mesh_get_volume(mesh, &restored));
    check(lcl_mesh_get_points(mesh, smooth, 0));
    const double before = distance(M, clean), after = distance(smooth, clean);
    printf("volume %.3f, denoised %.3f, restored %.3f; distance to the torus %.4f, now %.4f\n", volume, shrunk, restored, before, after);

    /* Sharpening adds the terms 1 to 3 of the other series, (E - A)^i M. */
    check(lcl_sharpen(A, smooth, 0, 3, NULL, sharp, 0));
    const double noisy = print_spectrum(A, "noisy", M), denoised = print_spectrum(A, "denoised", smooth), sharpened = print_spectrum(A, "sharpened", sharp);

    lcl_operator_release(A);
    lcl_mesh_release(mesh);
    lcl_context_release(context);
    const double rounding = 1e-9; /* of some ten passes in doubles or pairs of floats */
    const int sums = of_bands <= rounding && of_ones <= rounding && of_three <= rounding;
    return sums && fabs(restored - volume) <= 1e-6 * volume && after < 0.5 * before && denoised < noisy && denoised < sharpened ? 0 : 1;
}
