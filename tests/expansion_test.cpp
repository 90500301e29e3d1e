// SPDX-License-Identifier: BSD-3-Clause
// The mesh expansion through the C API, on arrays and on fields: terms, sums, bands, equalisers, energies, denoising and sharpening against plain loops over
// dense matrices from brute-force subdivision.
#include <limits>

#include "host/field/host_rows.h"
#include "host/filter/expansion.h"
#include "tests/expansion_support.h"
#include "tests/solver_support.h"

using namespace expansion_test;

namespace {

lcl_expand_options expand_options(int first, int last, lcl_series series = LCL_SERIES_REPRESENTATION) {
    lcl_expand_options options = LCL_EXPAND_OPTIONS_INIT;
    options.series = series;
    options.first = first;
    options.last = last;
    return options;
}

lcl_expand_options equaliser(const std::vector<double>& weights, double remainder = 1, lcl_series series = LCL_SERIES_REPRESENTATION) {
    lcl_expand_options options = expand_options(-5, -7, series);  // not looked at
    options.weights = weights.data();
    options.weight_count = weights.size();
    options.remainder = remainder;
    return options;
}

lcl_denoise_options denoise_options(int m, int k, bool plain = false) {
    lcl_denoise_options options = LCL_DENOISE_OPTIONS_INIT;
    options.m = m;
    options.k = k;
    options.plain = plain;
    return options;
}

lcl_sharpen_options sharpen_options(int first, int last, int k) {
    lcl_sharpen_options options = LCL_SHARPEN_OPTIONS_INIT;
    options.first = first;
    options.last = last;
    options.k = k;
    return options;
}

lcl_status call(lcl_operator A, const double* M, size_t stride, int channels, const lcl_expand_options& options, double* out, size_t out_stride) {
    return lcl_expand(A, M, stride, channels, &options, out, out_stride);
}
lcl_status call(lcl_operator A, const double* M, size_t stride, int channels, const lcl_denoise_options& options, double* out, size_t out_stride) {
    return lcl_denoise(A, M, stride, channels, &options, out, out_stride);
}
lcl_status call(lcl_operator A, const double* M, size_t stride, int channels, const lcl_sharpen_options& options, double* out, size_t out_stride) {
    return lcl_sharpen(A, M, stride, channels, &options, out, out_stride);
}
lcl_status call(lcl_operator A, lcl_field M, const lcl_expand_options& options, lcl_field out) { return lcl_expand_field(A, M, &options, out); }
lcl_status call(lcl_operator A, lcl_field M, const lcl_denoise_options& options, lcl_field out) { return lcl_denoise_field(A, M, &options, out); }
lcl_status call(lcl_operator A, lcl_field M, const lcl_sharpen_options& options, lcl_field out) { return lcl_sharpen_field(A, M, &options, out); }

template <class Options>
std::vector<double> run(const Subject& subject, const std::vector<double>& M, Options options, const Way& way = {LCL_PRECISION_MIXED, false}) {
    options.precision = way.precision;
    std::vector<double> out(M.size(), std::nan(""));
    if (way.on_fields) {
        const FieldHandle from = make_field(subject.A.get(), M, way.precision), to = make_field(subject.A.get(), lcl_field_channels(from.get()), way.precision);
        succeed(call(subject.A.get(), from.get(), options, to.get()));
        return download(to.get(), subject.rows());
    }
    succeed(call(subject.A.get(), M.data(), 0, static_cast<int>(M.size() / subject.rows()), options, out.data(), 0));
    return out;
}

/// Values of n x channels against a formula's; further channels have size `size`, in the place of the diagonal.
void check(const Subject& subject, const Way& way, const std::vector<double>& found, const Matrix& expected, double passes, double gain = 1, double size = 1) {
    const double allowed = tolerance(subject, way, passes, gain);
    INFO(subject.name << ", " << way.name() << ", " << expected.cols() << " channels");
    REQUIRE(found.size() == static_cast<std::size_t>(expected.size()));
    const Matrix error = (matrix_of(found, static_cast<int>(expected.cols())) - expected).cwiseAbs();
    for (Eigen::Index c = 0; c < error.cols(); ++c) {
        const double scale = c < 3 ? 1 : size / subject.diagonal, worst = error.col(c).maxCoeff<Eigen::PropagateNaN>();
        CHECK(worst <= allowed * scale);
    }
}

const std::vector<std::pair<int, int>> bands{{0, 0}, {1, 1}, {3, 3}, {0, 1}, {0, 2}, {2, 3}, {4, 7}, {0, 15}, {0, 20}, {6, 40}};
const std::vector<std::pair<int, int>> dyadic{{0, 0}, {1, 1}, {2, 3}, {4, 7}, {8, 15}};

/// Notes every call; cancels at the given one.
struct Passes {
    std::vector<int64_t> done, all;
    int stop_at = -1;
    static int32_t note(void* user, int64_t done, int64_t all) {
        auto& own = *static_cast<Passes*>(user);
        own.done.push_back(done);
        own.all.push_back(all);
        return static_cast<int>(own.done.size()) != own.stop_at;
    }
};

template <class Options>
Options with_progress(Options options, Passes& passes) {
    options.progress = Passes::note;
    options.progress_user = &passes;
    return options;
}

}  // namespace

TEST_CASE("terms, partial sums and bands of both series are those of plain loops, with every scheme", "[expansion][series]") {
    for (const Subject* subject : all_subjects())
        for (const lcl_series series : {LCL_SERIES_REPRESENTATION, LCL_SERIES_INTERPOLATION})
            for (const auto& [first, last] : bands) {
                CAPTURE(series, first, last);
                const Matrix expected = sum_of_terms(subject->a, subject->points(), series, first, last);
                const double gain = series == LCL_SERIES_INTERPOLATION ? last - first + 1 : 1;  // at eigenvalue 0
                for (const Way& way : all_ways())
                    check(*subject, way, run(*subject, subject->values(), expand_options(first, last, series), way), expected, last + 1, gain);
            }
}

TEST_CASE("all bands and what they leave add up to the mesh", "[expansion][series]") {
    for (const Subject* subject : all_subjects())
        for (const Way& way : all_ways()) {
            const std::vector<double> M = subject->values();
            Matrix sum = matrix_of(run(*subject, M, expand_options(16, 16, LCL_SERIES_INTERPOLATION), way), 3);  // (E - A)^16 M
            for (const auto& [first, last] : dyadic) sum += matrix_of(run(*subject, M, expand_options(first, last), way), 3);
            check(*subject, way, M, sum, 40);
            check(*subject, way, run(*subject, M, equaliser(std::vector<double>(16, 1.0)), way), subject->points(), 0);
        }
}

TEST_CASE("partial sums telescope: the terms 0 to m are E - (E - A)^(m + 1)", "[expansion][series]") {
    for (const Subject* subject : all_subjects())
        for (const int m : {0, 1, 2, 7, 30}) {
            const std::vector<double> M = subject->values();
            const Matrix rest = matrix_of(run(*subject, M, expand_options(m + 1, m + 1, LCL_SERIES_INTERPOLATION)), 3);
            check(*subject, {LCL_PRECISION_MIXED, false}, run(*subject, M, expand_options(0, m)), subject->points() - rest, 2 * m);
        }
}

TEST_CASE("partial sums of the interpolation series are the iterates of PIA", "[expansion][series]") {
    for (const Subject* subject : all_subjects())
        for (const int m : {1, 2, 6}) {
            const std::vector<double> M = subject->values();
            lcl_solve_options options = LCL_SOLVE_OPTIONS_INIT;
            options.solver = LCL_SOLVER_PIA;
            options.exact_sweeps = m;
            options.precision = has_double() ? LCL_PRECISION_DOUBLE : LCL_PRECISION_MIXED;
            options.keep_going = 1;
            std::vector<double> P(M.size());
            const lcl_status status = lcl_interpolate(subject->A.get(), M.data(), 0, 3, &options, P.data(), 0, nullptr);
            CHECK((status == LCL_OK || status == LCL_ERROR_SINGULAR));
            check(*subject, {options.precision, false}, run(*subject, M, expand_options(0, m, LCL_SERIES_INTERPOLATION), {options.precision, false}),
                  matrix_of(P, 3), 2 * m, m + 1);
        }
}

TEST_CASE("an equaliser is the weighted sum of the terms, with or without what they leave", "[expansion][series]") {
    const std::vector<std::vector<double>> faders{{2.5}, {0.5, 1, 2}, {1, 0, -0.75, 0, 0, 0.5}, {1, 1.5, 2, 2, 0.5, 0.5, 0.5, 0.5, 0, 0, 0, 0, 0, 0, 0, 0, 3}};
    for (const Subject* subject : all_subjects())
        for (const lcl_series series : {LCL_SERIES_REPRESENTATION, LCL_SERIES_INTERPOLATION})
            for (const std::vector<double>& weights : faders)
                for (const double remainder : {1.0, 0.0, -0.5}) {
                    CAPTURE(series, weights.size(), remainder);
                    const int count = static_cast<int>(weights.size());
                    Matrix expected = Matrix::Zero(subject->a.rows(), 3), term = subject->points();
                    double gain = std::abs(remainder);
                    if (series == LCL_SERIES_REPRESENTATION) {
                        expected += remainder * remain(subject->a, term, count);
                        term = subject->a * term;
                    }
                    for (const double weight : weights) expected += weight * term, term = remain(subject->a, term), gain += std::abs(weight);
                    for (const Way& way : all_ways())
                        check(*subject, way, run(*subject, subject->values(), equaliser(weights, remainder, series), way), expected, count, gain);
                }
}

TEST_CASE("each term is a mesh that can be expanded again", "[expansion][series]") {
    for (const Subject* subject : all_subjects())
        for (const Way& way : all_ways()) {
            const std::vector<double> term = run(*subject, subject->values(), expand_options(2, 2), way),
                                      again = run(*subject, term, expand_options(1, 3), way);
            check(*subject, way, again,
                  sum_of_terms(subject->a, sum_of_terms(subject->a, subject->points(), LCL_SERIES_REPRESENTATION, 2, 2), LCL_SERIES_REPRESENTATION, 1, 3), 8);
        }
}

TEST_CASE("results on fields go on as inputs, whatever centre and scale they had before", "[expansion][field]") {
    const Subject& subject = closed_subject();
    lcl_operator A = subject.A.get();
    const std::vector<double> M = subject.values(), moved = values_of(subject.points().array() * 3 + 100);
    const lcl_expand_options term = expand_options(1, 1);
    const lcl_denoise_options denoise = denoise_options(2, 2);
    for (const lcl_precision precision : {LCL_PRECISION_SINGLE, LCL_PRECISION_DOUBLE}) {
        if (precision == LCL_PRECISION_DOUBLE && !has_double()) continue;
        const FieldHandle x = make_field(A, M, precision), y = make_field(A, moved, precision), z = make_field(A, moved, precision);
        succeed(lcl_denoise_field(A, x.get(), &denoise, y.get()));
        succeed(lcl_expand_field(A, y.get(), &term, z.get()));
        succeed(lcl_denoise_field(A, z.get(), &denoise, y.get()));
        const Way way{precision, true};
        const Matrix once = denoised(subject.a, subject.points(), 2, 2, false), band = sum_of_terms(subject.a, once, LCL_SERIES_REPRESENTATION, 1, 1);
        check(subject, way, download(z.get(), subject.rows()), band, 9);
        check(subject, way, download(y.get(), subject.rows()), denoised(subject.a, band, 2, 2, false), 16);
        check(subject, way, download(x.get(), subject.rows()), subject.points(), 0);
    }
}

TEST_CASE("D^k A and D^k are k filters one after the other, with every scheme", "[expansion][denoise]") {
    for (const Subject* subject : all_subjects())
        for (const int m : {0, 1, 2, 3, 4, 5, 16, 17, 40})
            for (const int k : {0, 1, 2, 3, 4})
                for (const bool plain : {false, true}) {
                    CAPTURE(m, k, plain);
                    const Matrix expected = denoised(subject->a, subject->points(), m, k, plain);
                    for (const Way& way : all_ways())
                        check(*subject, way, run(*subject, subject->values(), denoise_options(m, k, plain), way), expected, k * (m + 1) + 1);
                }
}

TEST_CASE("many terms give the mesh back where A is not singular, and many filters the mean of each component", "[expansion][denoise]") {
    const Way way{has_double() ? LCL_PRECISION_DOUBLE : LCL_PRECISION_MIXED, false};
    for (const Subject* subject : all_subjects()) {
        if (subject->name == "singular cube") continue;
        check(*subject, way, run(*subject, subject->values(), denoise_options(3000, 1, true), way), subject->points(), 3000);
    }
    for (const Subject& subject : closed_subjects()) {
        const lcl::Topology topology = lcl::build_topology(subject.shape.mesh);
        lcl::Index count = 0;
        const std::vector<lcl::Index> component = lcl::connected_components(topology, count);
        Matrix mean = Matrix::Zero(count, 3), expected = subject.points();
        std::vector<double> weight(count, 0.0);
        for (std::size_t v = 0; v < subject.rows(); ++v)
            if (component[v] >= 0) mean.row(component[v]) += subject.scaling(v) * expected.row(v), weight[component[v]] += subject.scaling(v);
        for (std::size_t v = 0; v < subject.rows(); ++v)
            if (component[v] >= 0) expected.row(v) = mean.row(component[v]) / weight[component[v]];
        const std::vector<double> found = run(subject, subject.values(), denoise_options(0, 2000), way);
        CHECK(difference_to(found, expected) <= 2000 * 16 * std::ldexp(1, -53) * subject.diagonal);  // roundings of a mean do not fade
    }
}

TEST_CASE("a boundary curve without corners shrinks to its own mean, and corners stay", "[expansion][denoise]") {
    const shapes::Shape shape = shapes::rough(shapes::cylinder_open(8, 4), 0.1, 3);
    const Operator A = make_operator(shape);
    const std::size_t rows = shape.mesh.vertex_count;
    std::vector<double> out(3 * rows);
    const lcl_denoise_options options = denoise_options(0, 500);  // the slowest wave of a loop of 8 keeps (4 + 2 cos(pi/4))/6 a pass
    succeed(lcl_denoise(A.get(), shape.mesh.positions.data(), 0, 3, &options, out.data(), 0));
    const Matrix found = matrix_of(out, 3), given = matrix_of(shape.mesh.positions, 3);
    for (const auto& loop : lcl::boundary_loops(lcl::build_topology(shape.mesh))) {
        Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
        for (const lcl::Index h : loop) mean += given.row(shape.mesh.face_vertices[h]) / static_cast<double>(loop.size());
        for (const lcl::Index h : loop) CHECK((found.row(shape.mesh.face_vertices[h]) - mean).cwiseAbs().maxCoeff() <= 1e-12);
    }
}

TEST_CASE("a sharpener is its own recursion", "[expansion][sharpen]") {
    for (const Subject* subject : all_subjects())
        for (const auto& [first, last, k] : {std::array<int, 3>{1, 3, 1}, {1, 1, 3}, {2, 5, 2}, {4, 20, 1}, {1, 30, 2}}) {
            CAPTURE(first, last, k);
            const Matrix expected = sharpened(subject->a, subject->points(), first, last, k);
            for (const Way& way : all_ways())
                check(*subject, way, run(*subject, subject->values(), sharpen_options(first, last, k), way), expected, k * last,
                      std::pow(last - first + 2.0, k));
        }
}

TEST_CASE("energies are variances of the terms under D, channel by channel", "[expansion][spectrum]") {
    constexpr int channels = 5, count = 12;
    for (const Subject* weighed : all_subjects()) {
        const Subject& subject = *weighed;
        const std::vector<double> M = subject.values(channels);
        Matrix term = subject.a * matrix_of(M, channels);
        std::vector<std::vector<double>> expected(count);
        double weight = 0;
        for (std::size_t v = 0; v < subject.rows(); ++v) weight += subject.scaling(v);
        for (int i = 0; i < count; ++i, term = remain(subject.a, term))
            for (int c = 0; c < channels; ++c) {
                double mean = 0, square = 0;
                for (std::size_t v = 0; v < subject.rows(); ++v) mean += subject.scaling(v) * term(v, c) / weight;
                for (std::size_t v = 0; v < subject.rows(); ++v) square += subject.scaling(v) * (term(v, c) - mean) * (term(v, c) - mean) / weight;
                expected[i].push_back(square);
            }
        for (const Way& way : all_ways()) {
            std::vector<double> energies(count * channels, -1.0);
            if (way.on_fields) succeed(lcl_spectrum_field(subject.A.get(), make_field(subject.A.get(), M, way.precision).get(), count, energies.data()));
            else succeed(lcl_spectrum(subject.A.get(), M.data(), 0, channels, way.precision, count, energies.data()));
            for (int i = 0; i < count; ++i)
                for (int c = 0; c < channels; ++c) {
                    INFO(subject.name << ", " << way.name() << ", term " << i << ", channel " << c);
                    const double error = tolerance(subject, way, i + 1);  // of a term; more of its square, and what the difference of two squares loses
                    const double allowed = 2 * error * std::sqrt(expected[i][c]) + error * error + 16 * std::ldexp(1, -53) * std::pow(subject.diagonal, 2);
                    CHECK(std::abs(energies[i * channels + c] - expected[i][c]) <= allowed);
                    CHECK(energies[i * channels + c] >= 0);
                }
        }
    }
}

TEST_CASE("the energies of an array with a stride are those of its channels", "[expansion][spectrum]") {
    const Subject& subject = closed_subject();
    const std::vector<double> M = subject.values();
    std::vector<double> wide(subject.rows() * 7, 1e6), energies(9), plain(9);
    for (std::size_t v = 0; v < subject.rows(); ++v) std::copy_n(&M[3 * v], 3, &wide[7 * v]);
    succeed(lcl_spectrum(subject.A.get(), M.data(), 0, 3, LCL_PRECISION_MIXED, 3, plain.data()));
    succeed(lcl_spectrum(subject.A.get(), wide.data(), 7, 3, LCL_PRECISION_MIXED, 3, energies.data()));
    CHECK(same(energies, plain));
}

TEST_CASE("constants are multiplied by what the filter makes of eigenvalue 1, exactly", "[expansion]") {
    for (const Subject* subject : all_subjects()) {
        std::vector<double> M;
        for (std::size_t v = 0; v < subject->rows(); ++v) M.insert(M.end(), {3.0, -1e5, 0.1});
        const auto times = [&](double factor) {
            std::vector<double> out = M;
            for (double& value : out) value *= factor;
            return out;
        };
        for (const Way& way : all_ways()) {
            INFO(subject->name << ", " << way.name());
            CHECK(same(run(*subject, M, denoise_options(2, 3), way), M));
            CHECK(same(run(*subject, M, denoise_options(20, 2, true), way), M));
            CHECK(same(run(*subject, M, sharpen_options(1, 3, 2), way), M));
            CHECK(same(run(*subject, M, expand_options(0, 0), way), M));
            CHECK(same(run(*subject, M, expand_options(0, 7, LCL_SERIES_INTERPOLATION), way), M));
            CHECK(same(run(*subject, M, expand_options(1, 7), way), times(0)));
            CHECK(same(run(*subject, M, expand_options(3, 3, LCL_SERIES_INTERPOLATION), way), times(0)));
            CHECK(same(run(*subject, M, equaliser({0.5, 3, 0}, -2), way), times(0.5)));
            CHECK(same(run(*subject, M, equaliser({-4, 3, 2}, 1, LCL_SERIES_INTERPOLATION), way), times(-4)));
        }
    }
}

TEST_CASE("corners, isolated vertices and vertices outside the subset keep their bits, or become 0 in terms that do not hold them", "[expansion]") {
    for (const Subject* subject : all_subjects()) {
        std::vector<std::size_t> fixed;
        for (std::size_t v = 0; v < subject->rows(); ++v)
            if (subject->is_fixed(v)) fixed.push_back(v);
        for (const Way& way : all_ways()) {
            const std::vector<double> M = subject->values();
            const FieldHandle x = make_field(subject->A.get(), M, way.precision), y = make_field(subject->A.get(), 3, way.precision);
            const std::vector<double> held = way.on_fields ? download(x.get(), subject->rows()) : M;
            const auto check_fixed = [&](const auto& options, double factor) {
                std::vector<double> out;
                if (way.on_fields) succeed(call(subject->A.get(), x.get(), options, y.get())), out = download(y.get(), subject->rows());
                else out = run(*subject, M, options, way);
                INFO(subject->name << ", " << way.name());
                for (const std::size_t v : fixed)
                    for (int c = 0; c < 3; ++c) CHECK(out[3 * v + c] == factor * held[3 * v + c]);
            };
            check_fixed(denoise_options(3, 4), 1);
            check_fixed(denoise_options(30, 2, true), 1);
            check_fixed(sharpen_options(1, 3, 2), 1);
            check_fixed(expand_options(0, 9), 1);
            check_fixed(expand_options(0, 40, LCL_SERIES_INTERPOLATION), 1);
            check_fixed(expand_options(1, 1), 0);
            check_fixed(expand_options(5, 30), 0);
            check_fixed(expand_options(2, 4, LCL_SERIES_INTERPOLATION), 0);
            if (!way.on_fields) check_fixed(equaliser({0.3, 7, 2}, 5), 0.3);
        }
    }
}

TEST_CASE("isolated vertices may be anywhere, and disturb nothing", "[expansion][isolated]") {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const Subject* subject : {&closed_subjects().back(), &patchwork()})
        for (const double place : {1e300, -infinity, std::nan("")}) {
            const std::vector<double> plain = subject->values();
            std::vector<double> M = plain;
            std::size_t isolated = 0;
            while (!subject->is_isolated(isolated)) ++isolated;
            M[3 * isolated + 1] = place;
            for (const lcl_precision precision : {LCL_PRECISION_MIXED, LCL_PRECISION_SINGLE}) {
                INFO(subject->name << ", " << place << ", precision " << precision);
                const Way way{precision, false};
                const auto check_others = [&](std::vector<double> out, std::vector<double> expected, double value) {
                    CHECK((out[3 * isolated + 1] == value || (std::isnan(value) && std::isnan(out[3 * isolated + 1]))));
                    expected[3 * isolated + 1] = out[3 * isolated + 1] = 0;
                    CHECK(same(out, expected));
                };
                check_others(run(*subject, M, denoise_options(2, 3), way), run(*subject, plain, denoise_options(2, 3), way), place);
                check_others(run(*subject, M, sharpen_options(1, 3, 1), way), run(*subject, plain, sharpen_options(1, 3, 1), way), place);
                check_others(run(*subject, M, expand_options(0, 20), way), run(*subject, plain, expand_options(0, 20), way), place);
                check_others(run(*subject, M, expand_options(1, 2), way), run(*subject, plain, expand_options(1, 2), way), 0);
                check_others(run(*subject, M, expand_options(2, 20, LCL_SERIES_INTERPOLATION), way),
                             run(*subject, plain, expand_options(2, 20, LCL_SERIES_INTERPOLATION), way), 0);
                std::vector<double> energies(12), plain_energies(12);
                succeed(lcl_spectrum(subject->A.get(), M.data(), 0, 3, precision, 4, energies.data()));
                succeed(lcl_spectrum(subject->A.get(), plain.data(), 0, 3, precision, 4, plain_energies.data()));
                CHECK(same(energies, plain_energies));
            }
        }
}

TEST_CASE("1 to 24 channels are each filtered as if they were alone", "[expansion][channels]") {
    for (const Subject* subject : {&closed_subject(), &patchwork()})
        for (const int channels : {1, 2, 3, 4, 5, 8, 9, 11, 12, 19, 24}) {
            const std::vector<double> M = subject->values(channels);
            const Matrix points = matrix_of(M, channels);
            for (const Way& way : all_ways()) {
                check(*subject, way, run(*subject, M, denoise_options(3, 2), way), denoised(subject->a, points, 3, 2, false), 9, 1, 2);
                check(*subject, way, run(*subject, M, expand_options(2, 3), way), sum_of_terms(subject->a, points, LCL_SERIES_REPRESENTATION, 2, 3), 4, 1, 2);
                check(*subject, way, run(*subject, M, sharpen_options(1, 2, 1), way), sharpened(subject->a, points, 1, 2, 1), 2, 3, 2);
            }
        }
}

TEST_CASE("arrays may have strides and the output may be the input", "[expansion]") {
    const Subject& subject = patchwork();
    constexpr int channels = 3;
    constexpr std::size_t stride = 5, out_stride = 4;
    const std::vector<double> M = subject.values(channels);
    const auto check_layouts = [&](const auto& options) {
        const std::vector<double> expected = run(subject, M, options);
        std::vector<double> wide(subject.rows() * stride, 77.0), out(subject.rows() * out_stride, -1.0);
        for (std::size_t v = 0; v < subject.rows(); ++v) std::copy_n(&M[3 * v], 3, &wide[stride * v]);
        succeed(call(subject.A.get(), wide.data(), stride, channels, options, out.data(), out_stride));
        succeed(call(subject.A.get(), wide.data(), stride, channels, options, wide.data(), stride));
        for (std::size_t v = 0; v < subject.rows(); ++v) {
            CHECK(std::equal(&out[out_stride * v], &out[out_stride * v] + 3, &expected[3 * v]));
            CHECK(std::equal(&wide[stride * v], &wide[stride * v] + 3, &expected[3 * v]));
            CHECK(out[out_stride * v + 3] == -1.0);
            CHECK((wide[stride * v + 3] == 77.0 && wide[stride * v + 4] == 77.0));
        }
    };
    check_layouts(denoise_options(2, 3));
    check_layouts(denoise_options(0, 0, true));
    check_layouts(expand_options(1, 4));
    check_layouts(sharpen_options(1, 3, 2));
}

TEST_CASE("no options are the defaults", "[expansion]") {
    const Subject& subject = closed_subject();
    lcl_operator A = subject.A.get();
    const std::vector<double> M = subject.values();
    std::vector<double> out(M.size());
    const FieldHandle x = make_field(A, M, LCL_PRECISION_SINGLE), y = make_field(A, 3, LCL_PRECISION_SINGLE);
    const Way fields{LCL_PRECISION_SINGLE, true};
    succeed(lcl_denoise(A, M.data(), 0, 3, nullptr, out.data(), 0));
    CHECK(same(out, run(subject, M, denoise_options(2, 3))));
    succeed(lcl_denoise_field(A, x.get(), nullptr, y.get()));
    CHECK(same(download(y.get(), subject.rows()), run(subject, M, denoise_options(2, 3), fields)));
    succeed(lcl_sharpen(A, M.data(), 0, 3, nullptr, out.data(), 0));
    CHECK(same(out, run(subject, M, sharpen_options(1, 3, 1))));
    succeed(lcl_sharpen_field(A, x.get(), nullptr, y.get()));
    CHECK(same(download(y.get(), subject.rows()), run(subject, M, sharpen_options(1, 3, 1), fields)));
    succeed(lcl_expand(A, M.data(), 0, 3, nullptr, out.data(), 0));
    CHECK(same(out, run(subject, M, expand_options(0, 0))));
    succeed(lcl_expand_field(A, x.get(), nullptr, y.get()));
    CHECK(same(download(y.get(), subject.rows()), run(subject, M, expand_options(0, 0), fields)));
}

TEST_CASE("a model far away is filtered as finely in float as one at the origin", "[expansion][scale]") {
    const Subject& subject = closed_subject();
    const double offset = 1e6;
    const std::vector<double> M = values_of(subject.points().array() + offset);
    for (const Way& way : {Way{LCL_PRECISION_SINGLE, false}, Way{LCL_PRECISION_SINGLE, true}}) {
        const double lost = 4 * offset * std::ldexp(1, -52);  // by the positions themselves
        const Matrix smooth = denoised(subject.a, subject.points(), 2, 3, false).array() + offset,
                     band = sum_of_terms(subject.a, subject.points(), LCL_SERIES_REPRESENTATION, 1, 3);
        CHECK(difference_to(run(subject, M, denoise_options(2, 3), way), smooth) <= tolerance(subject, way, 10) + lost);
        CHECK(difference_to(run(subject, M, expand_options(1, 3), way), band) <= tolerance(subject, way, 4) + lost);
    }
}

TEST_CASE("progress counts the passes that were promised, and never goes back", "[expansion][progress]") {
    for (const Subject* subject :
         {&closed_subjects().back(), &closed_subject(), &patchwork()}) {  // rows in two parts, in one, and in several that depend on each other
        const std::vector<double> M = subject->values();
        const auto check_passes = [&](const auto& options, int64_t expected) {
            for (const bool on_fields : {false, true}) {
                INFO(subject->name << (on_fields ? ", fields" : ", arrays") << ", " << expected << " passes");
                Passes passes;
                run(*subject, M, with_progress(options, passes), {LCL_PRECISION_SINGLE, on_fields});
                REQUIRE(passes.done.empty() == (expected == 0));
                CHECK(std::is_sorted(passes.done.begin(), passes.done.end(), std::less_equal<int64_t>()));
                for (const int64_t all : passes.all) CHECK(all == expected);
                if (expected > 0) CHECK(passes.done.back() == expected);
                if (expected > 0) CHECK(passes.done.front() > 0);
            }
        };
        for (const int m : {0, 2, 5, 16, 17, 40})
            for (const int k : {0, 1, 3, 10}) {
                check_passes(denoise_options(m, k), k * (m + 1) + 1);
                check_passes(denoise_options(m, k, true), k * (m + 1));
            }
        check_passes(expand_options(0, 50), 51);
        check_passes(expand_options(7, 9), 10);
        check_passes(expand_options(0, 50, LCL_SERIES_INTERPOLATION), 50);
        check_passes(expand_options(0, 0, LCL_SERIES_INTERPOLATION), 0);
        check_passes(sharpen_options(1, 20, 3), 60);
    }
}

TEST_CASE("a filter that is cancelled leaves its output as it was", "[expansion][progress]") {
    for (const Subject* subject : {&closed_subjects().back(), &patchwork()}) {
        lcl_operator A = subject->A.get();
        const std::vector<double> M = subject->values(), before = values_of(subject->points().array() * 2 + 7);
        const auto check_cancelled = [&](const auto& plain, int call_number) {
            INFO(subject->name << ", at call " << call_number);
            Passes passes;
            passes.stop_at = call_number;
            const auto options = with_progress(plain, passes);
            std::vector<double> out = before;
            refuse(call(A, M.data(), 0, 3, options, out.data(), 0), LCL_ERROR_CANCELLED, "cancelled");
            CHECK(static_cast<int>(passes.done.size()) == call_number);
            CHECK(same(out, before));
            passes.done.clear();
            const FieldHandle x = make_field(A, M, LCL_PRECISION_SINGLE), y = make_field(A, before, LCL_PRECISION_SINGLE);
            const std::vector<double> held = download(y.get(), subject->rows()), given = download(x.get(), subject->rows());
            refuse(call(A, x.get(), options, y.get()), LCL_ERROR_CANCELLED, "cancelled");
            CHECK(static_cast<int>(passes.done.size()) == call_number);
            CHECK(same(download(y.get(), subject->rows()), held));
            CHECK(same(download(x.get(), subject->rows()), given));
            succeed(call(A, x.get(), plain, y.get()));  // and nothing is left of it
            CHECK(same(download(y.get(), subject->rows()), run(*subject, M, plain, {LCL_PRECISION_SINGLE, true})));
        };
        for (const int call_number : {1, 2}) {
            check_cancelled(denoise_options(2, 30), call_number);
            check_cancelled(denoise_options(40, 2), call_number);
            check_cancelled(expand_options(0, 60), call_number);
            check_cancelled(expand_options(40, 42), call_number);
            check_cancelled(sharpen_options(1, 3, 3), call_number);
        }
    }
}

TEST_CASE("the same filter of the same input gives the same bits", "[expansion]") {
    const Subject& subject = closed_subject();
    for (const Way& way : all_ways()) {
        CHECK(same(run(subject, subject.values(), denoise_options(3, 3), way), run(subject, subject.values(), denoise_options(3, 3), way)));
        CHECK(same(run(subject, subject.values(), equaliser({1, 2, 0.5}), way), run(subject, subject.values(), equaliser({1, 2, 0.5}), way)));
    }
}

TEST_CASE("wrong options of filters are refused in a sentence", "[expansion][errors]") {
    const Subject& subject = closed_subject();
    lcl_operator A = subject.A.get();
    const std::vector<double> M = subject.values();
    const FieldHandle x = make_field(A, M, LCL_PRECISION_SINGLE), y = make_field(A, 3, LCL_PRECISION_SINGLE);
    const auto refused = [&](const auto& options, const std::string& part) {
        std::vector<double> out(M.size(), 5.0);
        refuse(call(A, M.data(), 0, 3, options, out.data(), 0), LCL_ERROR_INVALID_ARGUMENT, part);
        CHECK(same(out, std::vector<double>(M.size(), 5.0)));
        refuse(call(A, x.get(), options, y.get()), LCL_ERROR_INVALID_ARGUMENT, part);
        refuse(lcl_field_download(y.get(), out.data(), LCL_TYPE_DOUBLE, 0), LCL_ERROR_INVALID_ARGUMENT, "holds no values yet");
    };
    refused(expand_options(-1, 3), "the first term is -1, it goes from 0 to 100000");
    refused(expand_options(0, 100001), "the last term is 100001, it goes from 0 to 100000");
    refused(expand_options(4, 3), "from term 4 to 3");
    refused(expand_options(0, 1, static_cast<lcl_series>(2)), "options.series is 2");
    refused(expand_options(0, 1, static_cast<lcl_series>(-1)), "options.series is -1");
    refused(equaliser({1, std::nan("")}), "weight 1 of the equaliser is not finite");
    refused(equaliser({1}, std::numeric_limits<double>::infinity()), "remainder is not finite");
    const std::vector<double> many(100001, 1.0);
    refused(equaliser(many), "100001 weights");
    lcl_expand_options no_weights = equaliser(many);
    no_weights.weight_count = 0;
    refused(no_weights, "0 weights");
    refused(denoise_options(-1, 3), "m is -1, it goes from 0 to 100000");
    refused(denoise_options(100001, 3), "m is 100001");
    refused(denoise_options(2, -1), "k is -1, it goes from 0 to 100000");
    refused(denoise_options(2, 100001), "k is 100001");
    refused(sharpen_options(0, 3, 1), "the first term is 0, it goes from 1 to 100000");
    refused(sharpen_options(3, 2, 1), "from term 3 to 2");
    refused(sharpen_options(1, 3, 0), "k is 0, it is at least 1");
    refused(sharpen_options(1, 3, 10), "more than 10^6");
    refused(sharpen_options(1, 100000, 2), "a narrower band or a smaller k");
    lcl_denoise_options without_size = denoise_options(1, 1);
    without_size.struct_size = 0;
    refused(without_size, "options.struct_size is not set");
}

TEST_CASE("wrong arguments of filters are refused in a sentence", "[expansion][errors]") {
    const Subject& subject = closed_subject();
    lcl_operator A = subject.A.get();
    const std::vector<double> M = subject.values();
    std::vector<double> out(M.size(), 5.0);
    const auto each = [&](const auto& body) { body(expand_options(0, 1)), body(denoise_options(2, 3)), body(sharpen_options(1, 3, 1)); };
    each([&](auto options) {
        const auto refused = [&](const double* from, std::size_t stride, int channels, double* to, std::size_t out_stride, const std::string& part) {
            refuse(call(A, from, stride, channels, options, to, out_stride), LCL_ERROR_INVALID_ARGUMENT, part);
        };
        refused(nullptr, 0, 3, out.data(), 0, "M is NULL");
        refused(M.data(), 0, 3, nullptr, 0, "out is NULL");
        refused(M.data(), 0, 0, out.data(), 0, "channels is 0, it is at least 1");
        refused(M.data(), 0, -2, out.data(), 0, "channels is -2");
        refused(M.data(), 2, 3, out.data(), 0, "stride is 2, less than the 3 channels");
        refused(M.data(), 0, 3, out.data(), 1, "out_stride is 1, less than the 3 channels");
        refuse(call(nullptr, M.data(), 0, 3, options, out.data(), 0), LCL_ERROR_INVALID_ARGUMENT, "A is NULL");
        options.precision = static_cast<lcl_precision>(3);
        refused(M.data(), 0, 3, out.data(), 0, "precision is 3, it goes from 0 to 2");
        options.precision = LCL_PRECISION_MIXED;
        std::vector<double> bad = M;
        bad[3 * 11 + 2] = std::nan("");
        refuse(call(A, bad.data(), 0, 3, options, out.data(), 0), LCL_ERROR_BAD_INPUT, "channel 2 of vertex 11 is not finite");
        CHECK(last_error_vertices() == std::vector<int32_t>{11});
    });
    CHECK(same(out, std::vector<double>(M.size(), 5.0)));
    const auto energies_of = [&](const double* from, std::size_t stride, int channels, int count, double* energies, int precision = 0) {
        return lcl_spectrum(A, from, stride, channels, static_cast<lcl_precision>(precision), count, energies);
    };
    refuse(energies_of(nullptr, 0, 3, 2, out.data()), LCL_ERROR_INVALID_ARGUMENT, "M is NULL");
    refuse(energies_of(M.data(), 0, 3, 2, nullptr), LCL_ERROR_INVALID_ARGUMENT, "energies is NULL");
    refuse(energies_of(M.data(), 0, 0, 2, out.data()), LCL_ERROR_INVALID_ARGUMENT, "channels is 0");
    refuse(energies_of(M.data(), 2, 3, 2, out.data()), LCL_ERROR_INVALID_ARGUMENT, "stride is 2");
    refuse(energies_of(M.data(), 0, 3, 0, out.data()), LCL_ERROR_INVALID_ARGUMENT, "the number of terms is 0, it goes from 1 to 100000");
    refuse(energies_of(M.data(), 0, 3, 100001, out.data()), LCL_ERROR_INVALID_ARGUMENT, "the number of terms is 100001");
    refuse(energies_of(M.data(), 0, 3, 2, out.data(), 3), LCL_ERROR_INVALID_ARGUMENT, "precision is 3");
    refuse(lcl_spectrum(nullptr, M.data(), 0, 3, LCL_PRECISION_MIXED, 2, out.data()), LCL_ERROR_INVALID_ARGUMENT, "A is NULL");
    int32_t m = -7, k = -7;
    refuse(lcl_denoise_settings(-0.1, &m, &k), LCL_ERROR_INVALID_ARGUMENT, "it goes from 0 to 1");
    refuse(lcl_denoise_settings(std::nan(""), &m, &k), LCL_ERROR_INVALID_ARGUMENT, "it goes from 0 to 1");
    refuse(lcl_denoise_settings(0.5, nullptr, &k), LCL_ERROR_INVALID_ARGUMENT, "m is NULL");
    refuse(lcl_denoise_settings(0.5, &m, nullptr), LCL_ERROR_INVALID_ARGUMENT, "k is NULL");
    succeed(lcl_denoise_settings(0.5, &m, &k));
    CHECK((m == 2 && k == 3));
}

TEST_CASE("fields that do not fit together are refused", "[expansion][errors][field]") {
    const Subject& subject = closed_subject();
    lcl_operator A = subject.A.get();
    const Operator B = make_operator(subject.shape, &subject.options);
    const std::vector<double> M = subject.values();
    const FieldHandle x = make_field(A, M, LCL_PRECISION_SINGLE), y = make_field(A, 3, LCL_PRECISION_SINGLE), narrow = make_field(A, 2, LCL_PRECISION_SINGLE),
                      empty = make_field(A, 3, LCL_PRECISION_SINGLE), other = make_field(B.get(), M, LCL_PRECISION_SINGLE);
    double energies[6];
    const auto each = [&](const auto& body) { body(expand_options(0, 1)), body(denoise_options(2, 3)), body(sharpen_options(1, 3, 1)); };
    each([&](const auto& options) {
        const auto refused = [&](lcl_field from, lcl_field to, const std::string& part) {
            refuse(call(A, from, options, to), LCL_ERROR_INVALID_ARGUMENT, part);
        };
        refused(nullptr, y.get(), "M is NULL");
        refused(x.get(), nullptr, "out is NULL");
        refused(x.get(), x.get(), "M and out are the same field");
        refused(empty.get(), y.get(), "holds no values yet");
        refused(other.get(), y.get(), "another operator");
        refused(x.get(), other.get(), "another operator");
        refused(x.get(), narrow.get(), "differ in channels or precision");
        refuse(call(nullptr, x.get(), options, y.get()), LCL_ERROR_INVALID_ARGUMENT, "A is NULL");
        refuse(call(B.get(), x.get(), options, y.get()), LCL_ERROR_INVALID_ARGUMENT, "another operator");
        if (has_double()) refused(x.get(), make_field(A, 3, LCL_PRECISION_DOUBLE).get(), "differ in channels or precision");
    });
    refuse(lcl_spectrum_field(A, nullptr, 2, energies), LCL_ERROR_INVALID_ARGUMENT, "M is NULL");
    refuse(lcl_spectrum_field(nullptr, x.get(), 2, energies), LCL_ERROR_INVALID_ARGUMENT, "A is NULL");
    refuse(lcl_spectrum_field(A, other.get(), 2, energies), LCL_ERROR_INVALID_ARGUMENT, "another operator");
    refuse(lcl_spectrum_field(A, empty.get(), 2, energies), LCL_ERROR_INVALID_ARGUMENT, "holds no values yet");
    refuse(lcl_spectrum_field(A, x.get(), 0, energies), LCL_ERROR_INVALID_ARGUMENT, "the number of terms is 0");
    refuse(lcl_spectrum_field(A, x.get(), 2, nullptr), LCL_ERROR_INVALID_ARGUMENT, "energies is NULL");
}

TEST_CASE("operators with ghosts are not filtered with", "[expansion][ghosts][errors]") {
    const shapes::Shape shape = shapes::torus_triangles(9, 5);
    std::vector<int32_t> owned;
    for (int32_t v = 0; v < shape.mesh.vertex_count; ++v)
        if (v % 4 != 1) owned.push_back(v);
    lcl_scheme_options options = scheme(LCL_SCHEME_LOOP);
    options.owned = owned.data();
    options.owned_count = owned.size();
    const Operator A = make_operator(shape, &options);
    const std::vector<double>& M = shape.mesh.positions;
    std::vector<double> out(M.size());
    const FieldHandle x = make_field(A.get(), M, LCL_PRECISION_SINGLE), y = make_field(A.get(), 3, LCL_PRECISION_SINGLE);
    refuse(lcl_expand(A.get(), M.data(), 0, 3, nullptr, out.data(), 0), LCL_ERROR_UNSUPPORTED, "ghosts");
    refuse(lcl_denoise(A.get(), M.data(), 0, 3, nullptr, out.data(), 0), LCL_ERROR_UNSUPPORTED, "ghosts");
    refuse(lcl_sharpen(A.get(), M.data(), 0, 3, nullptr, out.data(), 0), LCL_ERROR_UNSUPPORTED, "ghosts");
    refuse(lcl_spectrum(A.get(), M.data(), 0, 3, LCL_PRECISION_MIXED, 1, out.data()), LCL_ERROR_UNSUPPORTED, "ghosts");
    refuse(lcl_expand_field(A.get(), x.get(), nullptr, y.get()), LCL_ERROR_UNSUPPORTED, "ghosts");
    refuse(lcl_denoise_field(A.get(), x.get(), nullptr, y.get()), LCL_ERROR_UNSUPPORTED, "ghosts");
    refuse(lcl_sharpen_field(A.get(), x.get(), nullptr, y.get()), LCL_ERROR_UNSUPPORTED, "ghosts");
    refuse(lcl_spectrum_field(A.get(), x.get(), 1, out.data()), LCL_ERROR_UNSUPPORTED, "ghosts");
}

TEST_CASE("pairs of floats filter as finely as double where there is none", "[expansion][pair]") {
    using namespace lcl;
    for (const shapes::Shape& shape :
         {shapes::rough(shapes::polygons_mixed(60, 3), 0.05, 1), shapes::with_isolated_vertex(shapes::rough(shapes::grid_with_creases(), 0.1, 2), 20)})
        for (const int channels : {3, 5}) {
            const solver_test::Prepared mesh(shape);
            const auto system = mesh.system(solver_test::context_without_double(), solver_test::catmull_clark(0.5));
            const Matrix a = solver_test::matrix_of(system->plan()), points = solver_test::rough_values(a.rows(), channels, 3);
            const std::vector<double> M = values_of(points);
            const auto check_filter = [&](const Polynomial& p, const Matrix& expected, double passes) {
                std::vector<double> out(M.size());
                filter_host(*system, p, M.data(), channels, channels, Precision::mixed, out.data(), channels);
                INFO(shape.name << ", " << channels << " channels, " << passes << " passes");
                CHECK(difference_to(out, expected) <= 4 * 30 * std::sqrt(passes + 1) * std::ldexp(1, -46));  // values in a box of diagonal 4
            };
            for (const int m : {0, 2, 5, 16, 17, 40})
                for (const int k : {0, 1, 3}) check_filter(denoiser(m, k, false), denoised(a, points, m, k, false), k * (m + 1) + 1);
            check_filter(lcl::sum_of_terms(Series::representation, 4, 7), expansion_test::sum_of_terms(a, points, LCL_SERIES_REPRESENTATION, 4, 7), 8);
            check_filter(lcl::sum_of_terms(Series::interpolation, 0, 7), expansion_test::sum_of_terms(a, points, LCL_SERIES_INTERPOLATION, 0, 7), 8 * 8);
            const Transform transform = fit_transform(system->plan(), M.data(), channels, channels);
            Field field = system->A->make_field(channels, Real::wide);
            upload_rows(system->plan(), transform, {M.data(), static_cast<std::size_t>(channels)}, field);
            const std::vector<double> energies = term_energies(*system, field, transform, 3);
            double weight = 0;
            for (Index row = 0; row < system->plan().row_count; ++row) weight += system->plan().scaling[row];
            Matrix term = a * points;
            for (int i = 0; i < 3; ++i, term = remain(a, term))
                for (int c = 0; c < channels; ++c) {
                    double mean = 0, square = 0;
                    for (Index row = 0; row < system->plan().row_count; ++row)
                        mean += system->plan().scaling[row] * term(system->plan().vertex_of_row[row], c) / weight;
                    for (Index row = 0; row < system->plan().row_count; ++row)
                        square += system->plan().scaling[row] * std::pow(term(system->plan().vertex_of_row[row], c) - mean, 2) / weight;
                    CHECK(std::abs(energies[i * channels + c] - square) <= 16 * 60 * std::ldexp(1, -24));  // sums of 60 floats
                }
        }
}

namespace {

/// A series on a device operator of its own, in the plan's order and without centre and scale, as its bits lie there.
class ChainRun {
public:
    ChainRun(const std::shared_ptr<const lcl::Plan>& plan, const lcl::LaunchShape& shape, int channels, lcl::Real real)
        : plan_(plan), A_(solver_test::device_context(), plan, shape), channels_(channels), real_(real) {}

    lcl::Field field(std::uint64_t seed) {
        const RowMajor values = solver_test::rough_values(plan_->vertex_count, channels_, seed);
        lcl::Field field = A_.make_field(channels_, real_);
        field.upload(values.data(), 0, plan_->vertex_count);
        return field;
    }
    std::vector<double> values(const lcl::Field& field) const {
        std::vector<double> values(static_cast<std::size_t>(plan_->vertex_count) * channels_);
        field.download(values.data(), 0, plan_->vertex_count);
        return values;
    }

    /// How the smooth part runs a chain: phases of less than all blocks?
    bool is_phased(int fields) {
        const lcl::Field like = field(1);
        const auto phases = A_.phases(16, like, plan_->smooth, fields);
        return phases.width < plan_->smooth.block_count && phases.sweeps > 1;
    }

    std::vector<double> series(const lcl::SeriesSteps& steps) {
        const lcl::Field x = field(1);
        lcl::Field out = field(2), scratch = field(3);
        A_.series(steps, x, out, scratch);
        return values(out);
    }
    std::vector<double> morph(const lcl::SeriesSteps& steps) {
        const lcl::Field target = field(4);
        lcl::Field difference = field(1), scratch = field(2), frame = field(3);
        A_.morph(steps, target, difference, scratch, frame);
        std::vector<double> both = values(difference), frame_values = values(frame);
        both.insert(both.end(), frame_values.begin(), frame_values.end());
        return both;
    }
    /// The last y, then the sums of each step.
    std::vector<double> sums(const lcl::SeriesSteps& steps) {
        const lcl::Field x = field(1);
        lcl::Field out = field(2), scratch = field(3);
        const std::vector<lcl::SeriesSums> sums = A_.series_with_sums(steps, x, out, scratch);
        std::vector<double> all = values(out);
        for (const lcl::SeriesSums& step : sums) {
            all.insert(all.end(), step.linear.begin(), step.linear.end());
            all.insert(all.end(), step.square.begin(), step.square.end());
        }
        return all;
    }

private:
    std::shared_ptr<const lcl::Plan> plan_;
    lcl::DeviceOperator A_;
    int channels_;
    lcl::Real real_;
};

}  // namespace

TEST_CASE("steps of a chain that follow each other through the rows give the bits of steps one by one", "[expansion][phases]") {
    using namespace lcl;
    struct Mesh {
        shapes::Shape shape;
        SchemeOptions scheme;
    };
    const shapes::Shape torus = shapes::shuffled(shapes::torus_quads(97, 41), 3);
    const std::vector<Mesh> meshes{{torus, solver_test::catmull_clark()},
                                   {shapes::with_isolated_vertex(shapes::with_isolated_vertex(torus, 100), 0), solver_test::catmull_clark(0.5)},  // two parts
                                   {shapes::torus_triangles(61, 59), solver_test::loop()},
                                   {shapes::random_triangle_mesh(3000, 4), solver_test::doo_sabin()},
                                   {shapes::grid_quads(60, 55), solver_test::catmull_clark()}};  // rows that depend on curves and corners: one part, one by one
    const std::vector<Real> reals =
        solver_test::device_context()->device().has_double ? std::vector<Real>{Real::single, Real::full} : std::vector<Real>{Real::single, Real::wide};
    std::vector<SeriesSteps> chains{term_steps(2), term_steps(33)};
    for (const Polynomial& p :
         {lcl::sum_of_terms(Series::representation, 2, 9), lcl::sum_of_terms(Series::interpolation, 3, 40), denoiser(2, 9, false), denoiser(16, 2, true)})
        chains.push_back(p.stages.back().steps);
    for (const Mesh& mesh : meshes) {
        constexpr Index block_rows = 16;
        PlanOptions options;
        options.block_rows = block_rows;
        const auto plan = std::make_shared<const Plan>(solver_test::Prepared(mesh.shape).plan(mesh.scheme, options));
        for (const Real real : reals)
            for (const int channels : {3, 9}) {
                const std::size_t cache_bytes =
                    (real == Real::single ? 1 : 2) * (channels == 3 ? 64 : 128) * 1500;  // a part of some 3500 rows in two or three fields
                ChainRun plain(plan, {1, block_rows, 0, 1}, channels, real), narrow(plan, {1, block_rows, cache_bytes, 1}, channels, real),
                    wide(plan, {1, block_rows, cache_bytes, 12}, channels, real);
                INFO(mesh.shape.name << ", " << channels << " channels, type " << static_cast<int>(real));
                for (const int fields : {2, 3}) CHECK((narrow.is_phased(fields) && wide.is_phased(fields)));
                for (const SeriesSteps& steps : chains) {
                    INFO(steps.count() << " steps");
                    const std::vector<double> expected = plain.series(steps);
                    for (ChainRun* phased : {&narrow, &wide, &narrow}) CHECK(same(phased->series(steps), expected));
                    if (steps.third == SeriesThird::input) continue;
                    CHECK(same(narrow.sums(steps), plain.sums(steps)));
                    CHECK(same(narrow.morph(steps), plain.morph(steps)));
                }
            }
    }
}
