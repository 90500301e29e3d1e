// SPDX-License-Identifier: BSD-3-Clause
// Morphs through the C API, on arrays and on fields: the recursion of the paper, even steps and straight lines against plain loops over dense matrices.
#include <limits>

#include "host/filter/morph.h"
#include "tests/expansion_support.h"
#include "tests/solver_support.h"

using namespace expansion_test;

namespace {

/// Frames as they come; what is given is spoilt then, which the next frame must not see.
struct Frames {
    std::size_t size = 0;
    std::vector<int32_t> numbers;
    std::vector<std::vector<double>> points;
    int stop_at = -1;
    static int32_t take(void* user, int32_t frame, double* points) {
        auto& own = *static_cast<Frames*>(user);
        own.numbers.push_back(frame);
        own.points.emplace_back(points, points + own.size);
        std::fill_n(points, own.size, std::nan(""));
        return frame != own.stop_at;
    }
};

struct Path {
    lcl_morph_path path = LCL_MORPH_RECURSION;
    int frames = 0;
    std::vector<int32_t> m;
    std::vector<double> rho;

    lcl_morph_options options(lcl_precision precision = LCL_PRECISION_MIXED) const {
        lcl_morph_options options = LCL_MORPH_OPTIONS_INIT;
        options.precision = precision;
        options.path = path;
        options.frames = frames;
        options.m = m.empty() ? nullptr : m.data();
        options.m_count = m.size();
        options.rho = rho.empty() ? nullptr : rho.data();
        options.rho_count = rho.size();
        return options;
    }
    int frame_count() const { return frames == 0 ? 10 : frames; }
    int m_of(int step) const { return m.empty() ? 2 : m[std::min<std::size_t>(step, m.size() - 1)]; }
    double rho_of(int step) const { return rho.empty() ? 0.5 : rho[std::min<std::size_t>(step, rho.size() - 1)]; }
};

std::vector<std::vector<double>> run(const Subject& subject, const std::vector<double>& from, const std::vector<double>& to, const Path& path,
                                     lcl_precision precision = LCL_PRECISION_MIXED) {
    Frames frames;
    frames.size = from.size();
    const lcl_morph_options options = path.options(precision);
    succeed(lcl_morph(subject.A.get(), from.data(), to.data(), 0, static_cast<int>(from.size() / subject.rows()), &options, Frames::take, &frames));
    REQUIRE(static_cast<int>(frames.numbers.size()) == path.frame_count() + 1);
    for (int i = 0; i <= path.frame_count(); ++i) CHECK(frames.numbers[i] == i);
    return frames.points;
}

/// Another mesh with the faces of the subject's: turned, moved, and rough.
std::vector<double> other_points(const Subject& subject, int channels = 3) {
    std::vector<double> to = subject.values(channels);
    shapes::Random random(11);
    for (std::size_t v = 0; v < subject.rows(); ++v) {
        double* const point = &to[v * channels];
        if (channels > 1) std::swap(point[0], point[1]);
        for (int c = 0; c < channels; ++c) point[c] = 0.8 * point[c] + 0.3 + 0.1 * random.symmetric();
    }
    return to;
}

/// |x|_D over the first three channels.
double norm(const Subject& subject, const Matrix& x) {
    double square = 0;
    for (std::size_t v = 0; v < subject.rows(); ++v) square += subject.scaling(v) * x.row(v).head(std::min<Eigen::Index>(3, x.cols())).squaredNorm();
    return std::sqrt(square);
}

/// Frames by the formulas of section 6.
std::vector<Matrix> plain_frames(const Subject& subject, const Matrix& from, const Matrix& to, const Path& path) {
    std::vector<Matrix> frames{from};
    const int count = path.frame_count();
    for (int step = 0; step < count; ++step) {
        const double share = 1 - (step + 1.0) / count;
        if (path.path == LCL_MORPH_LINEAR) {
            frames.push_back(to + share * (from - to));
            continue;
        }
        const Matrix y = filtered(subject.a, frames.back() - to, path.m_of(step));
        const double size = norm(subject, y);
        const double rho = path.path == LCL_MORPH_RECURSION ? path.rho_of(step) : size > 0 ? std::min(1.0, share * norm(subject, from - to) / size) : 0;
        frames.push_back(to + rho * y);
    }
    return frames;
}

std::vector<lcl_precision> precisions() {
    return has_double() ? std::vector<lcl_precision>{LCL_PRECISION_MIXED, LCL_PRECISION_SINGLE, LCL_PRECISION_DOUBLE}
                        : std::vector<lcl_precision>{LCL_PRECISION_MIXED, LCL_PRECISION_SINGLE};
}

/// Frames lie within the box of both meshes, and the filters of earlier frames make earlier roundings smaller.
void check_frames(const Subject& subject, const std::vector<std::vector<double>>& found, const std::vector<Matrix>& expected, const Path& path,
                  lcl_precision precision, double size = 1) {
    REQUIRE(found.size() == expected.size());
    double passes = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        INFO(subject.name << ", path " << path.path << ", precision " << precision << ", frame " << i << " of " << found.size() - 1);
        CHECK(difference_to(found[i], expected[i]) <= size * tolerance(subject, {precision, false}, passes));
        passes += path.m_of(static_cast<int>(i)) + 1;
    }
}

const std::vector<Path> recursions{{LCL_MORPH_RECURSION, 0, {}, {}},
                                   {LCL_MORPH_RECURSION, 4, {0}, {1.0}},
                                   {LCL_MORPH_RECURSION, 6, {0, 3, 2, 17, 5}, {0.9, 0.5, 1.0, 0.25}},
                                   {LCL_MORPH_RECURSION, 3, {16, 1, 40}, {0.01}}};

}  // namespace

TEST_CASE("frames follow the paper's recursion, with lists of m and rho of which the last is repeated", "[morph]") {
    for (const Subject* subject : all_subjects()) {
        const std::vector<double> from = subject->values(), to = other_points(*subject);
        for (const Path& path : recursions)
            for (const lcl_precision precision : precisions()) {
                const auto frames = run(*subject, from, to, path, precision);
                check_frames(*subject, frames, plain_frames(*subject, subject->points(), matrix_of(to, 3), path), path, precision);
                CHECK(same(frames[0], from));
            }
    }
}

TEST_CASE("for rho below 1 the frames tend to the target, for rho = 1 the mean of the difference never moves", "[morph]") {
    for (const Subject& subject : closed_subjects()) {
        if (subject.name == "singular cube") continue;
        INFO(subject.name);
        const std::vector<double> from = subject.values(), to = other_points(subject);
        const Matrix difference = subject.points() - matrix_of(to, 3);
        const auto shorter = run(subject, from, to, {LCL_MORPH_RECURSION, 60, {}, {0.5}});
        for (int i = 1; i <= 60; i += 7)
            CHECK(norm(subject, matrix_of(shorter[i], 3) - matrix_of(to, 3)) <= std::ldexp(1.0001, -i) * norm(subject, difference) + 1e-12);
        CHECK(largest_difference(shorter.back(), to) <= 1e-12);
        if (subject.name == "two components and an isolated vertex") continue;  // a mean of each
        const auto mean = [&](const Matrix& x) {
            Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(3);
            double weight = 0;
            for (std::size_t v = 0; v < subject.rows(); ++v) sum += subject.scaling(v) * x.row(v), weight += subject.scaling(v);
            return Eigen::RowVectorXd(sum / weight);
        };
        const auto kept = run(subject, from, to, {LCL_MORPH_RECURSION, 3000, {0}, {1.0}});
        const Matrix last = matrix_of(kept.back(), 3) - matrix_of(to, 3);
        CHECK((last.rowwise() - mean(difference)).cwiseAbs().maxCoeff() <= 1e-11);
        CHECK(mean(difference).norm() > 0.1);
    }
}

TEST_CASE("even frames get nearer to the target by equal steps, and the last is the target itself", "[morph][even]") {
    const std::vector<Path> paths{{LCL_MORPH_EVEN, 0, {}, {}},
                                  {LCL_MORPH_EVEN, 1, {}, {}},
                                  {LCL_MORPH_EVEN, 5, {0}, {}},
                                  {LCL_MORPH_EVEN, 7, {4, 17, 16, 2}, {}},
                                  {LCL_MORPH_EVEN, 40, {1}, {}}};
    for (const Subject* subject : all_subjects()) {
        const std::vector<double> from = subject->values(), to = other_points(*subject);
        const Matrix target = matrix_of(to, 3);
        for (const Path& path : paths)
            for (const lcl_precision precision : precisions()) {
                const auto frames = run(*subject, from, to, path, precision);
                check_frames(*subject, frames, plain_frames(*subject, subject->points(), target, path), path, precision, 4);  // rho has roundings of its own
                CHECK(same(frames[0], from));
                CHECK(same(frames.back(), to));
            }
        // No step is cut where the difference is smooth.
        const std::vector<double> near = values_of(filtered(subject->a, subject->points(), 0).array() * 0.9 + 0.5);
        const auto frames = run(*subject, subject->values(), near, {LCL_MORPH_EVEN, 8, {6}, {}});
        const auto distance = [&](int i) { return norm(*subject, matrix_of(frames[i], 3) - matrix_of(near, 3)); };
        for (int i = 0; i <= 8; ++i) CHECK(distance(i) == Approx((1 - i / 8.0) * distance(0)).margin(1e-12));
    }
}

TEST_CASE("even frames go to the target at once where the filter leaves nothing of the difference", "[morph][even]") {
    const Subject& cube = closed_subjects()[7];
    REQUIRE(cube.name == "singular cube");
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(cube.a);  // all valences are 3: A is symmetric, and its least eigenvalue is 0
    REQUIRE(std::abs(eigen.eigenvalues()[0]) < 1e-14);
    const Matrix to = cube.points();
    const std::vector<double> from = values_of(to + eigen.eigenvectors().col(0) * Eigen::RowVector3d(1, 2, 3));
    for (const lcl_precision precision : precisions()) {
        const auto frames = run(cube, from, values_of(to), {LCL_MORPH_EVEN, 3, {}, {}}, precision);
        for (int i = 1; i <= 3; ++i) CHECK(difference_to(frames[i], to) <= 4 * tolerance(cube, {precision, false}, 3));
    }
}

TEST_CASE("a morph between equal meshes stays where it is", "[morph]") {
    for (const Subject* subject : {&closed_subject(), &patchwork()}) {
        const std::vector<double> M = subject->values();
        for (const lcl_precision precision : precisions()) {
            for (const auto& frame : run(*subject, M, M, {LCL_MORPH_RECURSION, 3, {2, 20}, {1.0}}, precision))
                CHECK(largest_difference(frame, M) <= tolerance(*subject, {precision, false}, 0));
            for (const auto& frame : run(*subject, M, M, {LCL_MORPH_EVEN, 3, {2, 20}, {}}, precision))
                CHECK(largest_difference(frame, M) <= tolerance(*subject, {precision, false}, 0));
            for (const auto& frame : run(*subject, M, M, {LCL_MORPH_LINEAR, 3, {}, {}}, precision)) CHECK(same(frame, M));
        }
    }
}

TEST_CASE("linear frames are straight lines with exact ends", "[morph]") {
    for (const Subject* subject : all_subjects()) {
        const std::vector<double> from = subject->values(5), to = other_points(*subject, 5);
        const Path path{LCL_MORPH_LINEAR, 7, {}, {}};
        const auto frames = run(*subject, from, to, path);
        const std::vector<Matrix> expected = plain_frames(*subject, matrix_of(from, 5), matrix_of(to, 5), path);
        for (int i = 0; i <= 7; ++i) CHECK(difference_to(frames[i], expected[i]) <= 4e-16 * 4 * subject->diagonal);
        CHECK(same(frames.front(), from));
        CHECK(same(frames.back(), to));
    }
}

TEST_CASE("corners, isolated vertices and those outside the subset go straight to the target, and stay where it is theirs, to the bit", "[morph][isolated]") {
    for (const Subject* subject : all_subjects())
        for (const lcl_precision precision : precisions())
            for (const Path& path : {Path{LCL_MORPH_RECURSION, 4, {2, 20}, {0.5, 0.75}}, Path{LCL_MORPH_EVEN, 4, {2, 20}, {}}}) {
                INFO(subject->name << ", path " << path.path << ", precision " << precision);
                const std::vector<double> from = subject->values();
                std::vector<double> to = other_points(*subject), far = to;
                for (std::size_t v = 0; v < subject->rows(); ++v) {
                    if (subject->is_fixed(v)) std::copy_n(&from[3 * v], 3, &to[3 * v]);
                    if (subject->is_isolated(v)) to[3 * v] = from[3 * v] * 1e200;
                }
                const auto frames = run(*subject, from, to, path, precision), moved = run(*subject, from, far, path, precision);
                double share = 1;
                for (int i = 1; i <= 4; ++i) {
                    share *= path.rho_of(i - 1);
                    for (std::size_t v = 0; v < subject->rows(); ++v)
                        if (subject->is_fixed(v) && !subject->is_isolated(v)) CHECK(std::equal(&frames[i][3 * v], &frames[i][3 * v] + 3, &from[3 * v]));
                    if (path.path == LCL_MORPH_EVEN) continue;
                    for (std::size_t v = 0; v < subject->rows(); ++v) {
                        if (!subject->is_fixed(v)) continue;
                        for (int c = 0; c < 3; ++c)
                            CHECK(moved[i][3 * v + c] == Approx(far[3 * v + c] + share * (from[3 * v + c] - far[3 * v + c])).epsilon(1e-15).margin(1e-15));
                        if (subject->is_isolated(v)) CHECK(frames[i][3 * v] == Approx(to[3 * v] + share * (from[3 * v] - to[3 * v])).epsilon(1e-14));
                    }
                }
            }
}

TEST_CASE("1 to 11 channels are morphed, with any stride", "[morph][channels]") {
    for (const Subject* subject : {&closed_subject(), &patchwork()})
        for (const int channels : {1, 2, 3, 4, 5, 8, 9, 11}) {
            CAPTURE(channels);
            const std::vector<double> from = subject->values(channels), to = other_points(*subject, channels);
            const std::size_t stride = channels + 2;
            std::vector<double> wide_from(subject->rows() * stride, 1e9), wide_to(subject->rows() * stride, -1e9);
            for (std::size_t v = 0; v < subject->rows(); ++v) {
                std::copy_n(&from[v * channels], channels, &wide_from[v * stride]);
                std::copy_n(&to[v * channels], channels, &wide_to[v * stride]);
            }
            for (const Path& path : {Path{LCL_MORPH_RECURSION, 3, {2, 17}, {0.8}}, Path{LCL_MORPH_EVEN, 3, {3}, {}}, Path{LCL_MORPH_LINEAR, 3, {}, {}}}) {
                const auto frames = run(*subject, from, to, path);
                check_frames(*subject, frames, plain_frames(*subject, matrix_of(from, channels), matrix_of(to, channels), path), path, LCL_PRECISION_MIXED, 4);
                Frames strided;
                strided.size = from.size();
                const lcl_morph_options options = path.options();
                succeed(lcl_morph(subject->A.get(), wide_from.data(), wide_to.data(), stride, channels, &options, Frames::take, &strided));
                for (std::size_t i = 0; i < frames.size(); ++i) CHECK(same(strided.points[i], frames[i]));
            }
        }
}

TEST_CASE("a morph on fields is that of arrays, frame by frame", "[morph][field]") {
    for (const Subject* subject : all_subjects())
        for (const lcl_precision precision : {LCL_PRECISION_SINGLE, LCL_PRECISION_DOUBLE}) {
            if (precision == LCL_PRECISION_DOUBLE && !has_double()) continue;
            lcl_operator A = subject->A.get();
            const std::vector<double> start = subject->values(), end = other_points(*subject);
            const FieldHandle to = make_field(A, end, precision), from = make_field(A, start, precision, to.get()), difference = make_field(A, 3, precision),
                              frame = make_field(A, 3, precision);
            const Path path = recursions[2];
            const std::vector<Matrix> expected = plain_frames(*subject, subject->points(), matrix_of(end, 3), path);
            INFO(subject->name << ", precision " << precision);
            succeed(lcl_field_subtract(from.get(), to.get(), difference.get()));
            CHECK(difference_to(download(difference.get(), subject->rows()), expected[0] - matrix_of(end, 3)) <= tolerance(*subject, {precision, true}, 0));
            double passes = 0;
            for (int step = 0; step < path.frame_count(); ++step) {
                succeed(lcl_morph_field(A, path.m_of(step), path.rho_of(step), to.get(), difference.get(), frame.get()));
                passes += path.m_of(step) + 1;
                const double allowed = tolerance(*subject, {precision, true}, passes);
                CHECK(difference_to(download(frame.get(), subject->rows()), expected[step + 1]) <= allowed);
                CHECK(difference_to(download(difference.get(), subject->rows()), expected[step + 1] - matrix_of(end, 3)) <= allowed);
            }
            CHECK(difference_to(download(to.get(), subject->rows()), matrix_of(end, 3)) <= tolerance(*subject, {precision, true}, 0));
            CHECK(difference_to(download(from.get(), subject->rows()), subject->points()) <= tolerance(*subject, {precision, true}, 0));
        }
}

TEST_CASE("fields may be subtracted from themselves, and with 9 channels", "[morph][field]") {
    const Subject& subject = closed_subject();
    lcl_operator A = subject.A.get();
    const std::vector<double> a = subject.values(9), b = other_points(subject, 9);
    const FieldHandle x = make_field(A, a, LCL_PRECISION_SINGLE), y = make_field(A, b, LCL_PRECISION_SINGLE, x.get()),
                      z = make_field(A, 9, LCL_PRECISION_SINGLE);
    succeed(lcl_field_subtract(x.get(), y.get(), z.get()));
    CHECK(difference_to(download(z.get(), subject.rows()), matrix_of(a, 9) - matrix_of(b, 9)) <= tolerance(subject, {LCL_PRECISION_SINGLE, true}, 0));
    succeed(lcl_field_subtract(x.get(), x.get(), z.get()));
    CHECK(same(download(z.get(), subject.rows()), std::vector<double>(a.size(), 0.0)));
}

TEST_CASE("pairs of floats morph as finely as double where there is none", "[morph][pair]") {
    const Subject& subject = closed_subject();
    const solver_test::Prepared mesh(subject.shape);
    const auto system = mesh.system(solver_test::context_without_double(), solver_test::catmull_clark());
    const std::vector<double> from = subject.values(), to = other_points(subject);
    for (const Path& path : {Path{LCL_MORPH_RECURSION, 5, {3, 17, 2}, {0.75, 0.5}}, Path{LCL_MORPH_EVEN, 4, {2, 17}, {}}}) {
        lcl::MorphOptions options;
        options.path = static_cast<lcl::MorphPath>(path.path);
        options.frames = path.frames;
        options.m.assign(path.m.begin(), path.m.end());
        if (!path.rho.empty()) options.rho = path.rho;
        const std::vector<Matrix> expected = plain_frames(subject, subject.points(), matrix_of(to, 3), path);
        // Norms are sums of floats there, which rho of even frames comes from: 60 of them in all.
        const double allowed = subject.diagonal * (path.path == LCL_MORPH_EVEN ? 64 * std::ldexp(1, -24) : 200 * std::ldexp(1, -46));
        morph_host(*system, from.data(), to.data(), 3, 3, options, [&](int frame, const double* points) {
            INFO("path " << path.path << ", frame " << frame);
            CHECK(difference_to({points, points + from.size()}, expected[frame]) <= allowed);
            return true;
        });
    }
}

TEST_CASE("a morph is cancelled by its callback", "[morph]") {
    const Subject& subject = closed_subject();
    const std::vector<double> from = subject.values(), to = other_points(subject);
    for (const lcl_morph_path path : {LCL_MORPH_RECURSION, LCL_MORPH_EVEN, LCL_MORPH_LINEAR})
        for (const int stop_at : {0, 2, 5}) {
            Frames frames;
            frames.size = from.size();
            frames.stop_at = stop_at;
            const lcl_morph_options options = Path{path, 5, {}, {}}.options();
            refuse(lcl_morph(subject.A.get(), from.data(), to.data(), 0, 3, &options, Frames::take, &frames), LCL_ERROR_CANCELLED, "cancelled");
            CHECK(static_cast<int>(frames.numbers.size()) == stop_at + 1);
        }
}

TEST_CASE("no options are the defaults of a morph", "[morph]") {
    const Subject& subject = closed_subject();
    const std::vector<double> from = subject.values(), to = other_points(subject);
    Frames frames;
    frames.size = from.size();
    succeed(lcl_morph(subject.A.get(), from.data(), to.data(), 0, 3, nullptr, Frames::take, &frames));
    const auto expected = run(subject, from, to, {LCL_MORPH_RECURSION, 10, {2}, {0.5}});
    REQUIRE(frames.points.size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) CHECK(same(frames.points[i], expected[i]));
}

TEST_CASE("wrong options of a morph are refused in a sentence, before the first frame", "[morph][errors]") {
    const Subject& subject = closed_subject();
    lcl_operator A = subject.A.get();
    const std::vector<double> from = subject.values(), to = other_points(subject);
    Frames frames;
    frames.size = from.size();
    const auto refused = [&](const lcl_morph_options& options, const std::string& part) {
        refuse(lcl_morph(A, from.data(), to.data(), 0, 3, &options, Frames::take, &frames), LCL_ERROR_INVALID_ARGUMENT, part);
    };
    refused(Path{static_cast<lcl_morph_path>(3), 2, {}, {}}.options(), "options.path is 3, it goes from 0 to 2");
    refused(Path{LCL_MORPH_RECURSION, -1, {}, {}}.options(), "frames is -1, it goes from 1 to 1000000");
    refused(Path{LCL_MORPH_LINEAR, 1000001, {}, {}}.options(), "frames is 1000001");
    const std::vector<int32_t> bad_m{2, -1}, large_m{100001};
    const std::vector<double> no_rho{0.5, 0}, large_rho{1.5}, nan_rho{0.5, std::nan("")}, good_rho{0.5};
    lcl_morph_options options = Path{}.options();
    options.m = bad_m.data(), options.m_count = 2;
    refused(options, "m is -1, it goes from 0 to 100000");
    options.m = large_m.data(), options.m_count = 1;
    refused(options, "m is 100001");
    options.m = nullptr;
    refused(options, "options.m is NULL");
    options = Path{}.options();
    options.rho = no_rho.data(), options.rho_count = 2;
    refused(options, "rho is 0.000000, it lies above 0 and is at most 1");
    options.rho = large_rho.data(), options.rho_count = 1;
    refused(options, "rho is 1.5");
    options.rho = nan_rho.data(), options.rho_count = 2;
    refused(options, "rho is nan");
    options.rho = nullptr;
    refused(options, "options.rho is NULL");
    options = Path{LCL_MORPH_EVEN, 0, {}, {}}.options();
    options.rho = good_rho.data(), options.rho_count = 1;
    refused(options, "even morphs choose rho themselves");
    options = Path{}.options();
    options.precision = static_cast<lcl_precision>(-1);
    refused(options, "precision is -1, it goes from 0 to 2");
    options = Path{}.options();
    options.struct_size = 4;
    refused(options, "options.struct_size is not set");
    CHECK(frames.numbers.empty());
}

TEST_CASE("wrong arguments of a morph are refused in a sentence, before the first frame", "[morph][errors]") {
    const Subject& subject = closed_subject();
    lcl_operator A = subject.A.get();
    const std::vector<double> from = subject.values(), to = other_points(subject);
    Frames frames;
    frames.size = from.size();
    const auto refused = [&](lcl_operator B, const double* a, const double* b, std::size_t stride, int channels, lcl_frame_callback take,
                             const std::string& part, lcl_status status = LCL_ERROR_INVALID_ARGUMENT) {
        refuse(lcl_morph(B, a, b, stride, channels, nullptr, take, &frames), status, part);
    };
    refused(nullptr, from.data(), to.data(), 0, 3, Frames::take, "A is NULL");
    refused(A, nullptr, to.data(), 0, 3, Frames::take, "from is NULL");
    refused(A, from.data(), nullptr, 0, 3, Frames::take, "to is NULL");
    refused(A, from.data(), to.data(), 0, 3, nullptr, "frame is NULL");
    refused(A, from.data(), to.data(), 0, 0, Frames::take, "channels is 0");
    refused(A, from.data(), to.data(), 2, 3, Frames::take, "stride is 2");
    std::vector<double> bad = from;
    bad[3 * 5 + 1] = std::numeric_limits<double>::infinity();
    refused(A, bad.data(), to.data(), 0, 3, Frames::take, "from of vertex 5 is inf in channel 1", LCL_ERROR_BAD_INPUT);
    CHECK(last_error_vertices() == std::vector<int32_t>{5});
    refused(A, from.data(), bad.data(), 0, 3, Frames::take, "vertex 5", LCL_ERROR_BAD_INPUT);
    CHECK(last_error_vertices() == std::vector<int32_t>{5});
    CHECK(frames.numbers.empty());
}

TEST_CASE("fields of a morph that do not fit together are refused", "[morph][errors][field]") {
    const Subject& subject = closed_subject();
    lcl_operator A = subject.A.get();
    const Operator B = make_operator(subject.shape, &subject.options);
    const std::vector<double> start = subject.values(), end = other_points(subject);
    const lcl_precision single = LCL_PRECISION_SINGLE;
    const FieldHandle to = make_field(A, end, single), from = make_field(A, start, single, to.get()), unmatched = make_field(A, start, single),
                      empty = make_field(A, 3, single), difference = make_field(A, 3, single), frame = make_field(A, 3, single),
                      narrow = make_field(A, 2, single), other = make_field(B.get(), end, single);
    const auto subtract = [&](lcl_field a, lcl_field b, lcl_field out, const std::string& part) {
        refuse(lcl_field_subtract(a, b, out), LCL_ERROR_INVALID_ARGUMENT, part);
    };
    subtract(nullptr, to.get(), difference.get(), "a is NULL");
    subtract(from.get(), nullptr, difference.get(), "b is NULL");
    subtract(from.get(), to.get(), nullptr, "difference is NULL");
    subtract(from.get(), to.get(), from.get(), "difference is the same field as a or b");
    subtract(from.get(), to.get(), to.get(), "difference is the same field as a or b");
    subtract(unmatched.get(), to.get(), difference.get(), "use lcl_field_match");
    subtract(empty.get(), to.get(), difference.get(), "holds no values yet");
    subtract(from.get(), empty.get(), difference.get(), "holds no values yet");
    subtract(from.get(), other.get(), difference.get(), "another operator");
    subtract(from.get(), to.get(), narrow.get(), "differ in channels or precision");
    const auto step = [&](lcl_operator C, int m, double rho, lcl_field t, lcl_field d, lcl_field f, const std::string& part) {
        refuse(lcl_morph_field(C, m, rho, t, d, f), LCL_ERROR_INVALID_ARGUMENT, part);
    };
    step(A, 2, 0.5, to.get(), difference.get(), frame.get(), "holds no values yet");
    succeed(lcl_field_subtract(from.get(), to.get(), difference.get()));
    const std::vector<double> held = download(difference.get(), subject.rows());
    step(nullptr, 2, 0.5, to.get(), difference.get(), frame.get(), "A is NULL");
    step(A, 2, 0.5, nullptr, difference.get(), frame.get(), "to is NULL");
    step(A, 2, 0.5, to.get(), nullptr, frame.get(), "difference is NULL");
    step(A, 2, 0.5, to.get(), difference.get(), nullptr, "frame is NULL");
    step(B.get(), 2, 0.5, to.get(), difference.get(), frame.get(), "another operator");
    step(A, 2, 0.5, other.get(), difference.get(), frame.get(), "another operator");
    step(A, 2, 0.5, to.get(), difference.get(), narrow.get(), "differ in channels or precision");
    step(A, 2, 0.5, empty.get(), difference.get(), frame.get(), "holds no values yet");
    step(A, 2, 0.5, to.get(), from.get(), frame.get(), "begin with lcl_field_subtract");
    step(A, 2, 0.5, unmatched.get(), difference.get(), frame.get(), "begin with lcl_field_subtract");
    step(A, 2, 0.5, to.get(), difference.get(), to.get(), "must be three fields");
    step(A, 2, 0.5, to.get(), difference.get(), difference.get(), "must be three fields");
    step(A, 2, 0.5, difference.get(), difference.get(), frame.get(), "must be three fields");
    step(A, -1, 0.5, to.get(), difference.get(), frame.get(), "m is -1, it goes from 0 to 100000");
    step(A, 100001, 0.5, to.get(), difference.get(), frame.get(), "m is 100001");
    for (const double rho : {0.0, 1.5, std::nan("")}) step(A, 2, rho, to.get(), difference.get(), frame.get(), "it lies above 0 and is at most 1");
    CHECK(same(download(difference.get(), subject.rows()), held));
    double value = 0;
    refuse(lcl_field_download(frame.get(), &value, LCL_TYPE_DOUBLE, 0), LCL_ERROR_INVALID_ARGUMENT, "holds no values yet");
}

TEST_CASE("operators with ghosts are not morphed with", "[morph][ghosts][errors]") {
    const shapes::Shape shape = shapes::torus_triangles(9, 5);
    std::vector<int32_t> owned;
    for (int32_t v = 0; v < shape.mesh.vertex_count; ++v)
        if (v % 4 != 1) owned.push_back(v);
    lcl_scheme_options options = scheme(LCL_SCHEME_LOOP);
    options.owned = owned.data();
    options.owned_count = owned.size();
    const Operator A = make_operator(shape, &options);
    const std::vector<double>& M = shape.mesh.positions;
    Frames frames;
    frames.size = M.size();
    const FieldHandle x = make_field(A.get(), M, LCL_PRECISION_SINGLE), d = make_field(A.get(), 3, LCL_PRECISION_SINGLE),
                      f = make_field(A.get(), 3, LCL_PRECISION_SINGLE);
    refuse(lcl_morph(A.get(), M.data(), M.data(), 0, 3, nullptr, Frames::take, &frames), LCL_ERROR_UNSUPPORTED, "ghosts");
    CHECK(frames.numbers.empty());
    succeed(lcl_field_subtract(x.get(), x.get(), d.get()));
    refuse(lcl_morph_field(A.get(), 2, 0.5, x.get(), d.get(), f.get()), LCL_ERROR_UNSUPPORTED, "ghosts");
}

TEST_CASE("meshes are compared face by face, and the first difference is told", "[morph][capi][mesh]") {
    using namespace shapes;
    const Shape cube = shapes::cube();
    const Mesh a = make_mesh(cube);
    succeed(lcl_mesh_compare_faces(a.get(), make_mesh(rough(cube, 0.3, 1)).get()));
    succeed(lcl_mesh_compare_faces(a.get(), a.get()));
    const auto differs = [&](const Shape& b, const std::string& part) {
        refuse(lcl_mesh_compare_faces(a.get(), make_mesh(b).get()), LCL_ERROR_BAD_INPUT, part);
    };
    differs(with_isolated_vertex(cube, 8), "one has 8 vertices, the other 9: they must have the same faces");
    std::vector<Face> faces = faces_of(cube.mesh);
    const std::vector<Point> points = points_of(cube.mesh);
    faces.pop_back();
    differs(make("open", points, faces), "one has 6 faces, the other 5");
    faces = faces_of(cube.mesh);
    std::rotate(faces[4].begin(), faces[4].begin() + 1, faces[4].end());
    const auto text = [](const Face& face) {
        std::string list;
        for (const int v : face) list += " " + std::to_string(v);
        return list;
    };
    differs(make("turned", points, faces), "face 4 has the vertices" + text(faces_of(cube.mesh)[4]) + " in one and" + text(faces[4]) + " in the other");
    CHECK(last_error_faces() == std::vector<int32_t>{4});
    // The same counts, other degrees.
    const Shape two = make("two", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}}, {{0, 1, 2, 3}, {1, 4, 2}}),
                swapped = make("swapped", points_of(two.mesh), {{0, 1, 3}, {1, 4, 2, 3}});
    refuse(lcl_mesh_compare_faces(make_mesh(two).get(), make_mesh(swapped).get()), LCL_ERROR_BAD_INPUT,
           "face 0 has the vertices 0 1 2 3 in one and 0 1 3 in the other");
    refuse(lcl_mesh_compare_faces(nullptr, a.get()), LCL_ERROR_INVALID_ARGUMENT, "a is NULL");
    refuse(lcl_mesh_compare_faces(a.get(), nullptr), LCL_ERROR_INVALID_ARGUMENT, "b is NULL");
}
