// SPDX-License-Identifier: BSD-3-Clause
// What the tests of the mesh expansion and of morphs share: operators of every scheme beside their dense matrices from brute-force subdivision, and the
// formulas as plain loops over these.
#pragma once

#include <cmath>

#include "tests/capi_support.h"
#include "tests/oracle/dense.h"
#include "tests/oracle/limit.h"

namespace expansion_test {

using namespace capi_test;

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Matrix = Eigen::MatrixXd;

inline Matrix matrix_of(const std::vector<double>& values, int channels) {
    return Eigen::Map<const RowMajor>(values.data(), static_cast<Eigen::Index>(values.size()) / channels, channels);
}
inline std::vector<double> values_of(const Matrix& matrix) {
    const RowMajor rows = matrix;
    return {rows.data(), rows.data() + rows.size()};
}

/// A shape with its scheme, the operator that the library makes of them, and the same one by brute force.
struct Subject {
    std::string name;
    shapes::Shape shape;
    lcl_scheme_options options = LCL_SCHEME_OPTIONS_INIT;  // without the arrays
    std::vector<double> ratios;                            // one a vertex, or none
    std::vector<int32_t> subset;                           // or none
    Operator A;
    Matrix a;
    std::vector<int> face_counts;
    double diagonal = 0;
    std::size_t longest_row = 0;

    Subject(std::string name_, shapes::Shape shape_, const lcl_scheme_options& options_, std::vector<double> ratios_ = {}, std::vector<int32_t> subset_ = {})
        : name(std::move(name_)), shape(std::move(shape_)), options(options_), ratios(std::move(ratios_)), subset(std::move(subset_)) {
        lcl_scheme_options given = options;
        if (!ratios.empty()) given.lambda_per_vertex = ratios.data();
        if (!subset.empty()) given.subset = subset.data(), given.subset_count = subset.size();
        A = make_operator(shape, &given);
        lcl::SchemeOptions plain;
        plain.scheme = static_cast<lcl::Scheme>(options.scheme - 1);
        plain.mask = static_cast<lcl::DooSabinMask>(options.mask);
        plain.alpha = options.alpha;
        plain.lambda = options.lambda;
        plain.lambda_per_vertex = ratios;
        a = oracle::limit_rows(shape.mesh, shape.features, plain);
        if (!subset.empty()) a = oracle::with_identity_rows(a, {subset.begin(), subset.end()});
        face_counts.assign(rows(), 0);
        for (const lcl::Index v : shape.mesh.face_vertices) ++face_counts[v];
        diagonal = diagonal_of(shape);
        for (Eigen::Index i = 0; i < a.rows(); ++i) longest_row = std::max<std::size_t>(longest_row, (a.row(i).array().abs() > 1e-14).count());
    }

    std::size_t rows() const { return static_cast<std::size_t>(shape.mesh.vertex_count); }
    /// A x = x: corners, isolated vertices, those outside the subset.
    bool is_fixed(std::size_t v) const { return a(v, v) == 1; }
    bool is_isolated(std::size_t v) const { return face_counts[v] == 0; }
    double lambda(std::size_t v) const { return ratios.empty() ? options.lambda : ratios[v]; }
    /// Positions, or positions and further channels of size 1.
    std::vector<double> values(int channels = 3) const {
        std::vector<double> all(rows() * channels);
        shapes::Random random(7);
        for (std::size_t v = 0; v < rows(); ++v)
            for (int c = 0; c < channels; ++c) all[v * channels + c] = c < 3 ? shape.mesh.positions[3 * v + c] : random.symmetric();
        return all;
    }

    Matrix points() const { return matrix_of(values(), 3); }

    /// Section 4: n (n + 5), n / (1 - alpha_n) or n of the faces round a vertex, divided by 1 - lambda; 0 where that is none, and without faces.
    double scaling(std::size_t v) const {
        const int n = face_counts[v];
        if (n == 0 || lambda(v) == 1) return 0;
        const double root = 0.375 + std::cos(2 * std::acos(-1.0) / n) / 4, alpha_n = 3 / (11 - 8 * (0.375 + root * root));
        const double d = options.scheme == LCL_SCHEME_CATMULL_CLARK ? n * (n + 5.0) : options.scheme == LCL_SCHEME_LOOP ? n / (1 - alpha_n) : n;
        return d / (1 - lambda(v));
    }
};

inline lcl_scheme_options classic_doo_sabin() {
    lcl_scheme_options options = scheme(LCL_SCHEME_DOO_SABIN);
    options.mask = LCL_MASK_CLASSIC;
    return options;
}

/// Closed and smooth: A is self-adjoint under D as a whole.
inline const std::vector<Subject>& closed_subjects() {
    static const std::vector<Subject> all = [] {
        const shapes::Shape polygons = shapes::rough(shapes::polygons_mixed(60, 3), 0.05, 1);
        std::vector<double> ratios;
        for (int v = 0; v < polygons.mesh.vertex_count; ++v) ratios.push_back(v % 4 * 0.25);
        std::vector<Subject> list;
        list.emplace_back("Catmull-Clark", polygons, scheme(LCL_SCHEME_CATMULL_CLARK));
        list.emplace_back("alpha 0.5", shapes::rough(shapes::polygons_mixed(50, 8), 0.05, 2), scheme(LCL_SCHEME_CATMULL_CLARK, 0.5));
        list.emplace_back("lambda 0.3", shapes::rough(shapes::icosphere_quads(1), 0.05, 3), scheme(LCL_SCHEME_CATMULL_CLARK, 0, 0.3));
        list.emplace_back("one ratio a vertex", polygons, scheme(LCL_SCHEME_CATMULL_CLARK), ratios);
        list.emplace_back("Loop", shapes::rough(shapes::random_triangle_mesh(70, 7), 0.05, 4), scheme(LCL_SCHEME_LOOP));
        list.emplace_back("Doo-Sabin", shapes::rough(shapes::polygons_mixed(50, 5), 0.05, 5), scheme(LCL_SCHEME_DOO_SABIN));
        list.emplace_back("classic Doo-Sabin", polygons, classic_doo_sabin());
        list.emplace_back("singular cube", shapes::rough(shapes::cube(), 0.1, 6), scheme(LCL_SCHEME_CATMULL_CLARK));
        list.emplace_back("two components and an isolated vertex", shapes::with_isolated_vertex(shapes::rough(shapes::two_components(), 0.1, 7), 4),
                          scheme(LCL_SCHEME_LOOP));
        return list;
    }();
    return all;
}

/// Boundaries, creases, corners, darts, isolated vertices, a subset.
inline const std::vector<Subject>& open_subjects() {
    static const std::vector<Subject> all = [] {
        const shapes::Shape grid = shapes::rough(shapes::grid_with_creases(), 0.1, 2);
        std::vector<double> ratios;
        for (int v = 0; v < grid.mesh.vertex_count; ++v) ratios.push_back(v % 3 * 0.3);
        std::vector<int32_t> subset;
        const shapes::Shape torus = shapes::rough(shapes::torus_quads(9, 7), 0.05, 2);
        for (int32_t v = 0; v < torus.mesh.vertex_count; ++v)
            if (v % 3 != 1) subset.push_back(v);
        std::vector<Subject> list;
        list.emplace_back("creases, darts, an isolated vertex", shapes::with_isolated_vertex(grid, 20), scheme(LCL_SCHEME_CATMULL_CLARK, 0.5));
        list.emplace_back("creases, darts, one ratio a vertex", grid, scheme(LCL_SCHEME_CATMULL_CLARK), ratios);
        list.emplace_back("a hole, alpha and lambda", shapes::rough(shapes::grid_with_hole(), 0.1, 5), scheme(LCL_SCHEME_CATMULL_CLARK, 0.25, 0.3));
        list.emplace_back("triangles with creases", shapes::rough(shapes::grid_triangles_with_creases(), 0.1, 3), scheme(LCL_SCHEME_LOOP));
        list.emplace_back("Doo-Sabin, marked corners", shapes::rough(shapes::grid_with_marked_corner(), 0.1, 6), scheme(LCL_SCHEME_DOO_SABIN));
        list.emplace_back("classic Doo-Sabin, creases", grid, classic_doo_sabin());
        list.emplace_back("a subset", torus, scheme(LCL_SCHEME_CATMULL_CLARK), std::vector<double>{}, subset);
        return list;
    }();
    return all;
}

inline std::vector<const Subject*> all_subjects() {
    std::vector<const Subject*> all;
    for (const Subject& subject : closed_subjects()) all.push_back(&subject);
    for (const Subject& subject : open_subjects()) all.push_back(&subject);
    return all;
}

/// One subject of each kind that matters to a test of something else than numbers.
inline const Subject& closed_subject() { return closed_subjects()[0]; }
inline const Subject& patchwork() { return open_subjects()[0]; }

inline bool has_double() {
    lcl_device_info info = LCL_DEVICE_INFO_INIT;
    succeed(lcl_context_get_device(default_context(), &info));
    return info.has_double != 0;
}

/// How values go through the library.
struct Way {
    lcl_precision precision;
    bool on_fields;
    bool is_single() const { return precision == LCL_PRECISION_SINGLE || (on_fields && precision == LCL_PRECISION_MIXED); }
    std::string name() const { return std::string(on_fields ? "fields" : "arrays") + ", precision " + std::to_string(precision); }
};
inline std::vector<Way> all_ways() {
    std::vector<Way> ways{{LCL_PRECISION_MIXED, false}, {LCL_PRECISION_SINGLE, false}, {LCL_PRECISION_SINGLE, true}};
    if (has_double()) ways.insert(ways.end(), {{LCL_PRECISION_DOUBLE, false}, {LCL_PRECISION_DOUBLE, true}});
    return ways;
}

/// Rounding of fields of the model's size: every pass sums up a row, whose weights sum to 1, and adds a few products. Roundings of different passes are
/// independent of each other, so they add up as their squares do. `gain`: the largest that the filter has. Brute force knows weights to some 2e-16. At most
/// 1e-5 of the model's size in float and 1e-12 in double.
inline double tolerance(const Subject& subject, const Way& way, double passes, double gain = 1) {
    const double unit = way.is_single() ? std::ldexp(1, -24) : std::ldexp(1, has_double() ? -53 : -46) + 2e-16;
    return subject.diagonal * gain * std::min((static_cast<double>(subject.longest_row) + 4) * std::sqrt(passes + 1) * unit, way.is_single() ? 1e-5 : 1e-12);
}

// The formulas, one application of A after the other.

inline Matrix remain(const Matrix& a, const Matrix& x) { return x - a * x; }

/// (E - A)^i x
inline Matrix remain(const Matrix& a, Matrix x, int i) {
    for (; i > 0; --i) x = remain(a, x);
    return x;
}

/// sum of (E - A)^i A x, or of (E - A)^i x, over first .. last
inline Matrix sum_of_terms(const Matrix& a, const Matrix& x, lcl_series series, int first, int last) {
    Matrix term = remain(a, series == LCL_SERIES_REPRESENTATION ? Matrix(a * x) : x, first), sum = term;
    for (int i = first + 1; i <= last; ++i) sum += term = remain(a, term);
    return sum;
}

/// D x = sum over i <= m of (E - A)^i A x
inline Matrix filtered(const Matrix& a, const Matrix& x, int m) { return sum_of_terms(a, x, LCL_SERIES_REPRESENTATION, 0, m); }

/// D^k A x, or D^k x
inline Matrix denoised(const Matrix& a, const Matrix& x, int m, int k, bool plain) {
    Matrix t = plain ? x : Matrix(a * x);
    for (; k > 0; --k) t = filtered(a, t, m);
    return t;
}

/// T + sum of (E - A)^i T over first .. last, k times
inline Matrix sharpened(const Matrix& a, Matrix t, int first, int last, int k) {
    for (; k > 0; --k) t = Matrix(t + sum_of_terms(a, t, LCL_SERIES_INTERPOLATION, first, last));
    return t;
}

/// Not a number where one of the values is none.
inline double difference_to(const std::vector<double>& found, const Matrix& expected) { return largest_difference(found, values_of(expected)); }

/// To the bit; says where not.
inline bool same(const std::vector<double>& a, const std::vector<double>& b) {
    const double difference = a.size() == b.size() ? largest_difference(a, b) : std::nan("");
    UNSCOPED_INFO("largest difference: " << difference);
    return difference == 0;
}

}  // namespace expansion_test
