// SPDX-License-Identifier: BSD-3-Clause
#include "host/selftest/selftest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "host/apply/device_tangents.h"
#include "host/apply/host_normals.h"
#include "host/apply/noise.h"
#include "host/apply/row_transfer.h"
#include "host/apply/transfer.h"
#include "host/refine/device_refiner.h"
#include "host/selftest/surface_check.h"
#include "host/solve/limit_system.h"
#include "host/two_phase/umbrella_steps.h"

namespace lcl {
namespace {

constexpr double pi = 3.14159265358979323846;

/// A tube of quads with a bump, closed round and open at both ends: smooth rows of one valence, boundary curves; `triangles` splits every quad, a crease runs
/// along it half way (a dart).
PolygonMesh tube(int around, int along, bool triangles, bool polygons) {
    PolygonMesh mesh;
    mesh.vertex_count = around * along;
    for (int j = 0; j < along; ++j)
        for (int i = 0; i < around; ++i) {
            const double angle = 2 * pi * i / around, radius = 1 + 0.2 * std::sin(3 * angle + j);
            mesh.positions.insert(mesh.positions.end(), {radius * std::cos(angle), radius * std::sin(angle), 0.3 * j});
        }
    const auto add_face = [&](std::initializer_list<Index> face) {
        mesh.face_vertices.insert(mesh.face_vertices.end(), face);
        mesh.face_offsets.push_back(static_cast<Index>(mesh.face_vertices.size()));
    };
    for (int j = 0; j + 1 < along; ++j)
        for (int i = 0; i < around; ++i) {
            const Index a = j * around + i, b = j * around + (i + 1) % around, c = b + around, d = a + around;
            const bool split = triangles || (polygons && (i + j) % 3 == 0);
            if (split) add_face({a, b, c}), add_face({a, c, d});
            else add_face({a, b, c, d});
        }
    return mesh;
}

struct Case {
    std::string name;
    PolygonMesh mesh;
    FeatureOptions features;
    SchemeOptions scheme;
};

std::vector<Case> cases() {
    std::vector<Case> all;
    all.push_back({"quads", tube(13, 9, false, false), {}, {}});
    all.push_back({"polygons, dart", tube(11, 8, false, true), {}, {}});
    for (int j = 2; j < 5; ++j) all.back().features.creases.push_back({j * 11, (j + 1) * 11});
    all.back().scheme.alpha = 0.5;
    all.push_back({"triangles", tube(12, 7, true, false), {}, {}});
    all.back().scheme.scheme = Scheme::loop;
    all.push_back({"Doo-Sabin", tube(9, 7, false, true), {}, {}});
    all.back().scheme.scheme = Scheme::doo_sabin;
    return all;
}

/// Largest difference of two lists, not a number if there is one.
double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (!(std::fabs(a[i] - b[i]) <= worst)) worst = std::fabs(a[i] - b[i]);
    return worst;
}

/// Values of a few channels that are of size 1 and rough.
std::vector<double> values_for(Index rows, int channels, int seed) {
    std::vector<double> values(static_cast<std::size_t>(rows) * channels);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(12.9898 * static_cast<double>(i + 1) + 78.233 * seed);
    return values;
}

std::string what_of(const Case& c, int channels, Real real) {
    const char* const type = real == Real::single ? "single" : real == Real::full ? "double" : "mixed";
    return c.name + ", " + std::to_string(channels) + (channels == 1 ? " channel, " : " channels, ") + type;
}

/// A row sums at most 60 products of numbers of size 1 and weights that sum to 1; pairs of floats hold 2^-48.
double rounding_of(const Context& context, Real real) {
    const bool pairs = real == Real::wide && !context.device().has_double;
    return 64 * (real == Real::single ? std::ldexp(1, -24) : pairs ? std::ldexp(1, -46) : std::ldexp(1, -52));
}

class Selftest {
public:
    Selftest(std::shared_ptr<Context> context, const Case& c, int channels, Real real, std::function<void(const SelftestResult&)> report)
        : mesh_(c.mesh),
          topology_(build_topology(mesh_)),
          features_(find_features(mesh_, topology_, c.features)),
          system_(make_limit_system(std::move(context), mesh_, topology_, features_, c.scheme, {})),
          A_(*system_->A),
          plan_(A_.plan()),
          channels_(channels),
          real_(real),
          report_(std::move(report)) {
        what_ = what_of(c, channels, real);
        tolerance_ = rounding_of(A_.context(), real);
    }

    bool run() {
        m_ = values_for(plan_.vertex_count, channels_, 1);
        x_ = values_for(plan_.vertex_count, channels_, 2);
        ax_ = host_apply(plan_, x_, channels_);
        limit();
        if (channels_ == 3) normals();
        series();
        morphs();
        if (real_ == Real::wide) residual();
        else sweeps(), gauss_seidel(), conjugate_gradients(), transfers(), single_rows();
        return passed_;
    }

private:
    Field field(const std::vector<double>& values, Real real) {
        Field field = A_.make_field(channels_, real);
        field.upload(values.data(), 0, plan_.vertex_count);
        return field;
    }
    std::vector<double> download(const Field& field) const {
        std::vector<double> values(static_cast<std::size_t>(plan_.vertex_count) * channels_);
        field.download(values.data(), 0, plan_.vertex_count);
        return values;
    }

    void compare(const char* kernel, const std::vector<double>& found, const std::vector<double>& expected, double tolerance) {
        const SelftestResult result{kernel, what_, largest_difference(found, expected), tolerance};
        passed_ = passed_ && result.passed();
        report_(result);
    }

    void limit() {
        const Field x = field(x_, real_);
        Field y = field(x_, real_);
        A_.limit_points(x, y, plan_.all_rows());
        compare("lcl_limit_points", download(y), ax_, tolerance_);
    }

    /// Of the mesh itself, whose tangents are well apart: an angle is off by some ten times what a row is.
    void normals() {
        TangentPlan tangent_plan = build_tangent_plan(plan_, topology_, features_, system_->scheme);
        std::vector<double> points;
        for (Index row = 0; row < plan_.vertex_count; ++row)
            for (int c = 0; c < 3; ++c) points.push_back(static_cast<float>(mesh_.positions[3 * static_cast<std::size_t>(plan_.vertex_of_row[row]) + c]));
        const Normals expected = host_normals(plan_, tangent_plan, points);
        DeviceTangents tangents(A_, std::move(tangent_plan));
        const bool ends_in_floats = real_ == Real::wide && !A_.context().device().has_double;
        const double tolerance = 16 * (ends_in_floats ? 64 * std::ldexp(1, -24) : tolerance_);
        const Field x = field(points, real_);
        Field y = field(x_, real_), n = field(x_, real_), t = field(x_, real_), b = field(x_, real_);
        tangents.normals(x, &y, n);
        compare("lcl_limit_normals", download(n), expected.vertices, tolerance);
        compare("lcl_limit_normals (points)", download(y), host_apply(plan_, points, channels_), 4 * tolerance_);
        compare("lcl_sector_normals", tangents.read_sides(), expected.sides, tolerance);
        tangents.normals(x, nullptr, n);
        compare("lcl_normals", download(n), expected.vertices, tolerance);
        tangents.frames(x, n, t, b);
        compare("lcl_frames", download(n), expected.vertices, tolerance);
        compare("lcl_sector_frames", tangents.read_sides(), expected.sides, tolerance);
        const std::vector<double> tangent = download(t);
        std::vector<double> across = download(b);
        for (std::size_t i = 0; i < across.size(); i += 3)
            for (std::size_t c = 0; c < 3; ++c) {  // normal x tangent
                const std::size_t d = i + (c + 1) % 3, e = i + (c + 2) % 3;
                across[i + c] -= expected.vertices[d] * tangent[e] - expected.vertices[e] * tangent[d];
            }
        compare("lcl_frames (bitangents)", across, std::vector<double>(across.size(), 0.0), tolerance);
        A_.context().finish();
    }

    /// y = a x + b (m - A x) + b_jacobi (m - A x) / A_ii + c d, all terms.
    std::vector<double> expected_sweep(const Sweep& s, const std::vector<double>& d) const {
        std::vector<double> y(x_.size());
        for (std::size_t i = 0; i < y.size(); ++i) {
            const double r = m_[i] - ax_[i];
            y[i] = s.a * x_[i] + (s.b + s.b_jacobi / plan_.diagonal[i / channels_]) * r + s.c * d[i];
        }
        return y;
    }

    void sweeps() {
        const Field m = field(m_, real_), x = field(x_, real_);
        Field y = field(x_, real_);
        const Sweep two{0.75, 1.25, 0.5, 0}, three{0.75, 1.25, 0, -0.5};
        A_.sweep(two, m, x, nullptr, y, plan_.all_rows());
        compare("lcl_relax", download(y), expected_sweep(two, x_), 8 * tolerance_);
        const double norm = A_.norms(x, plan_.all_rows()).position, expected = host_residual(plan_, m_, x_, channels_).position;
        compare("lcl_relax (norm)", {norm}, {expected}, 4 * tolerance_);
        const std::vector<double> d_values = values_for(plan_.vertex_count, channels_, 3);
        y.upload(d_values.data(), 0, plan_.vertex_count);
        A_.sweep(three, m, x, &y, y, plan_.all_rows());
        compare("lcl_relax_three_term", download(y), expected_sweep(three, d_values), 8 * tolerance_);
        y.upload(d_values.data(), 0, plan_.vertex_count);
        Field newest = field(x_, real_);
        A_.chain({three}, m, newest, y, plan_.all_rows());
        compare("lcl_relax_phase", download(newest), expected_sweep(three, d_values), 8 * tolerance_);
    }

    void gauss_seidel() {
        const Schedule schedule = coloured_schedule(plan_);
        Field x = field(x_, real_);
        A_.relax_rows(schedule, field(m_, real_), x);
        std::vector<double> expected = x_;
        for (std::size_t k = 0; k < schedule.rows.size(); ++k)
            for (int c = 0; c < channels_; ++c) {
                double r = m_[static_cast<std::size_t>(schedule.rows[k]) * channels_ + c];
                for (std::uint32_t e = schedule.offsets[k]; e < schedule.offsets[k + 1]; ++e)
                    r -= schedule.weights[e] * expected[static_cast<std::size_t>(schedule.columns[e]) * channels_ + c];
                expected[static_cast<std::size_t>(schedule.rows[k]) * channels_ + c] += r * schedule.inverse_diagonal[k];
            }
        compare("lcl_relax_rows", download(x), expected, 32 * tolerance_);
        A_.context().finish();
    }

    double scaled_dot(const std::vector<double>& a, const std::vector<double>& b, int channel) const {
        double sum = 0;
        for (Index row = plan_.smooth.first_row; row < plan_.smooth.end_row(); ++row)
            sum += plan_.scaling[row] * a[static_cast<std::size_t>(row) * channels_ + channel] * b[static_cast<std::size_t>(row) * channels_ + channel];
        return sum;
    }

    void conjugate_gradients() {
        const Part part = plan_.smooth;
        double weight = 0;  // sums are compared relative to the sum of the scaling
        for (Index row = part.first_row; row < part.end_row(); ++row) weight += plan_.scaling[row];
        Field p = field(x_, real_), q = field(x_, real_), x = field(m_, real_), r = field(m_, real_);
        ChannelValues found = A_.cg_apply(p, q, part), expected(channels_), ones(channels_, 0.5);
        for (int c = 0; c < channels_; ++c) expected[c] = scaled_dot(x_, ax_, c) / weight, found[c] /= weight;
        compare("lcl_cg_apply", found, expected, 4 * tolerance_);
        found = A_.cg_update(ones, p, q, x, r, part);
        std::vector<double> new_r = m_, new_p = x_;
        for (Index row = part.first_row; row < part.end_row(); ++row)
            for (int c = 0; c < channels_; ++c) {
                const std::size_t i = static_cast<std::size_t>(row) * channels_ + c;
                new_r[i] -= 0.5 * ax_[i];
                new_p[i] = new_r[i] + 0.5 * x_[i];
            }
        for (int c = 0; c < channels_; ++c) expected[c] = scaled_dot(new_r, new_r, c) / weight, found[c] /= weight;
        compare("lcl_cg_update", found, expected, 4 * tolerance_);
        compare("lcl_cg_update (residual)", download(r), new_r, 4 * tolerance_);
        A_.cg_direction(ones, r, p, part);
        compare("lcl_cg_direction", download(p), new_p, 8 * tolerance_);
    }

    void residual() {
        const Part all = plan_.all_rows();
        const Field m = field(m_, Real::wide);
        Field x = field(x_, Real::wide), r = field(m_, Real::single);
        A_.wide_residual(m, x, r, all);
        std::vector<double> expected(x_.size());
        for (std::size_t i = 0; i < expected.size(); ++i) expected[i] = m_[i] - ax_[i];
        compare("lcl_residual", download(r), expected, std::ldexp(1, -22));  // handed on in float
        A_.correct(r, x, all);
        const std::vector<double> handed_on = download(r);
        for (std::size_t i = 0; i < expected.size(); ++i) expected[i] = x_[i] + handed_on[i];
        compare("lcl_correct", download(x), expected, tolerance_);
        A_.context().finish();
    }

    /// y of every step, x_ first.
    std::vector<std::vector<double>> expected_steps(const SeriesSteps& steps) const {
        std::vector<std::vector<double>> y{x_};
        for (std::int64_t k = 0; k < steps.count(); ++k) {
            const std::vector<double> ay = host_apply(plan_, y[k], channels_), &third = steps.third == SeriesThird::input || k == 0 ? x_ : y[k - 1];
            std::vector<double> next(x_.size());
            for (std::size_t i = 0; i < next.size(); ++i) next[i] = steps[k].a * y[k][i] + steps[k].b * ay[i] + steps[k].c * third[i];
            y.push_back(std::move(next));
        }
        return y;
    }

    void series() {
        const Field x = field(x_, real_);
        Field out = field(m_, real_), scratch = field(m_, real_);
        const SeriesSteps horner{SeriesThird::input, {{1.5, -0.5, 0}, {1, -1, 0.25}, {0.5, 0.5, -0.5}}, {}, 0};
        A_.series(horner, x, out, scratch);
        compare("lcl_series", download(out), expected_steps(horner).back(), 4 * tolerance_);
        const SeriesSteps filter{SeriesThird::older, {{0, 1, 0}, {0.5, -1, 0}, {1, -1, 1}}, {}, 0};
        A_.series(filter, x, out, scratch);
        const std::vector<std::vector<double>> expected = expected_steps(filter);
        compare("lcl_filter", download(out), expected.back(), 4 * tolerance_);
        const std::vector<SeriesSums> sums = A_.series_with_sums(filter, x, out, scratch);
        compare("lcl_series_sums", download(out), expected.back(), 4 * tolerance_);
        double weight = 0;  // sums are compared relative to the sum of the scaling
        for (const double d : plan_.scaling) weight += d;
        std::vector<double> found_sums, expected_sums;
        for (std::size_t k = 0; k < sums.size(); ++k)
            for (int c = 0; c < channels_; ++c) {
                found_sums.insert(found_sums.end(), {sums[k].linear[c] / weight, sums[k].square[c] / weight});
                double linear = 0, square = 0;
                for (Index row = 0; row < plan_.row_count; ++row) {
                    const double value = expected[k + 1][static_cast<std::size_t>(row) * channels_ + c], weighted = plan_.scaling[row] / weight * value;
                    linear += weighted;
                    square += weighted * value;
                }
                expected_sums.insert(expected_sums.end(), {linear, square});
            }
        compare("lcl_series_sums (sums)", found_sums, expected_sums, 4 * (A_.context().device().has_double ? tolerance_ : 64 * std::ldexp(1, -24)));
    }

    void morphs() {
        const SeriesSteps steps{SeriesThird::older, {{0, 0.75, 0}, {0.5, -1, 0}, {1, -1, 1}}, {}, 0};
        const Field target = field(m_, real_);
        Field difference = field(x_, real_), scratch = field(x_, real_), frame = field(x_, real_);
        const auto frame_of = [&](std::vector<double> values) {
            for (std::size_t i = 0; i < values.size(); ++i) values[i] += m_[i];
            return values;
        };
        A_.morph(steps, target, difference, scratch, frame);
        std::vector<double> expected = expected_steps(steps).back();
        compare("lcl_morph", download(difference), expected, 4 * tolerance_);
        compare("lcl_morph (frame)", download(frame), frame_of(expected), 4 * tolerance_);
        A_.morph_blend(0.5, target, difference, frame);
        for (double& value : expected) value *= 0.5;
        compare("lcl_morph_blend", download(difference), expected, 4 * tolerance_);
        compare("lcl_morph_blend (frame)", download(frame), frame_of(expected), 4 * tolerance_);
        A_.subtract(field(x_, real_), target, difference);
        for (std::size_t i = 0; i < expected.size(); ++i) expected[i] = x_[i] - m_[i];
        compare("lcl_morph_difference", download(difference), expected, tolerance_);
        A_.context().finish();
    }

    /// A caller's floats to rows and back.
    void transfers() {
        Context& context = A_.context();
        const std::size_t rows = plan_.vertex_count;
        std::vector<float> caller(rows * channels_), back(caller.size(), 0.0f);
        for (std::size_t i = 0; i < caller.size(); ++i) caller[i] = static_cast<float>(m_[i]);
        Buffer buffer(A_.shared_context(), caller.size() * sizeof(float), "a self-test buffer");
        context.write(buffer, 0, caller.size() * sizeof(float), caller.data(), "uploading a self-test buffer");
        Field field = A_.make_field(channels_, real_);
        const CallerRows rows_of_caller{&buffer, 0, static_cast<std::size_t>(channels_), false};
        const Transform transform{std::vector<double>(channels_, 0.25), std::vector<double>(channels_, 2.0)};
        import_rows(A_, transform, rows_of_caller, field);
        std::vector<double> expected(x_.size());
        for (std::size_t row = 0; row < rows; ++row)
            for (int c = 0; c < channels_; ++c) expected[row * channels_ + c] = (caller[plan_.vertex_of_row[row] * channels_ + c] - 0.25) * 2;
        compare("lcl_import_points", download(field), expected, 4 * tolerance_);
        context.fill_zero(buffer, "clearing a self-test buffer");
        export_rows(A_, transform, field, rows_of_caller);
        context.read(buffer, 0, back.size() * sizeof(float), back.data(), "reading a self-test buffer");
        compare("lcl_export_points", {back.begin(), back.end()}, {caller.begin(), caller.end()}, 4 * std::ldexp(1, -24));
    }

    /// Every third row there and, into another field, back.
    void single_rows() {
        Field from = field(m_, real_), to = field(x_, real_);
        std::vector<double> expected = x_, travelling;
        std::vector<Index> rows;
        for (Index row = 0; row < plan_.vertex_count; row += 3) {
            rows.push_back(row);
            std::copy_n(m_.begin() + row * channels_, channels_, expected.begin() + row * channels_);
        }
        RowTransfer transfer(A_.shared_context());
        transfer.read({{&from, &rows}}, travelling);
        std::vector<double> sent;
        for (const Index row : rows) sent.insert(sent.end(), m_.begin() + row * channels_, m_.begin() + (row + 1) * channels_);
        compare("lcl_gather_rows", travelling, sent, tolerance_);
        transfer.write({{&to, &rows}}, travelling);
        compare("lcl_scatter_rows", download(to), expected, tolerance_);
    }

    const PolygonMesh mesh_;
    const Topology topology_;
    const Features features_;
    const std::unique_ptr<LimitSystem> system_;
    DeviceOperator& A_;
    const Plan& plan_;
    const int channels_;
    const Real real_;
    const std::function<void(const SelftestResult&)> report_;
    std::string what_;
    double tolerance_ = 0;
    bool passed_ = true;
    std::vector<double> m_, x_, ax_;
};

/// One octave of noise at points on both sides of the origin. A value sums eight slopes, each below 3, by weights of which each is off by some ten roundings.
bool check_noise(const std::shared_ptr<Context>& context, Real real, const std::function<void(const SelftestResult&)>& report) {
    constexpr int octave = 2;
    std::vector<double> points = values_for(5000, 3, 1), expected;
    for (double& coordinate : points) coordinate *= 100;
    for (std::size_t i = 0; i < points.size(); i += 3)
        expected.push_back(improved_noise({4 * points[i], 4 * points[i + 1], 4 * points[i + 2]}) / 4);  // f(2^octave p) / 2^octave
    const bool is_single = real == Real::single;
    const SelftestResult result{"lcl_noise", is_single ? "5000 points, single" : "5000 points, double",
                                largest_difference(noise_octave(context, {}, points, octave, real), expected), 256 * std::ldexp(1, is_single ? -24 : -53)};
    report(result);
    return result.passed();
}

/// Limit points, normals and handles that are no mesh's own, on every kind of umbrella; one vertex in seven is free.
UmbrellaTargets rough_targets(const Umbrellas& umbrellas) {
    UmbrellaTargets targets;
    targets.points = values_for(umbrellas.count, 3, 1);
    targets.normals = values_for(umbrellas.count, 3, 2);
    for (Index u = 0; u < umbrellas.count; ++u) {
        double* const normal = &targets.normals[3 * static_cast<std::size_t>(u)];
        const double length = std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
        const bool is_free = u % 7 == 0 || !umbrellas.masks[umbrellas.mask_of[u]].has_tangents;
        for (int c = 0; c < 3; ++c) normal[c] = is_free ? 0 : normal[c] / length;
        targets.constrained.push_back(u % 7 != 0);
        targets.handles.push_back(0.5 + u % 3);
    }
    return targets;
}

/// What every kernel of the two-phase scheme gives one after the other. Numbers are of size 1, or are made so.
std::vector<std::pair<const char*, std::vector<double>>> two_phase_results(UmbrellaSteps& steps, const PolygonMesh& refined, const FairRows& rows) {
    std::vector<std::pair<const char*, std::vector<double>>> results;
    std::vector<double> points;
    const double count = refined.vertex_count;
    steps.upload(refined.positions);
    const RepairFindings found = steps.repair();
    steps.download(points);
    results.push_back({"lcl_umbrella_repair", points});
    results.push_back({"lcl_umbrella_repair (distances)", found.distances});
    results.push_back({"lcl_umbrella_repair (sides)", found.sides});
    steps.set_fairness(rows, 2);
    results.push_back({"lcl_fair_laplacian", {steps.energy() / count}});
    double square = steps.begin();
    std::vector<double> products, squares{square / count};
    for (int step = 0; step < 3; ++step) {
        products.push_back(steps.apply() / count);
        const double before = square;
        square = steps.update(before / (products.back() * count));
        squares.push_back(square / count);
        steps.turn(square / before);
    }
    results.push_back({"lcl_fair_apply", products});
    results.push_back({"lcl_fair_update", squares});
    steps.download(points);
    results.push_back({"lcl_fair_turn", points});
    steps.scale();
    steps.download(points);
    results.push_back({"lcl_umbrella_scale", points});
    return results;
}

/// A row sums some twenty products of numbers of size 1 by weights up to 10; three steps of conjugate gradients carry that on.
bool check_two_phase(const std::shared_ptr<Context>& context, const std::function<void(const SelftestResult&)>& report) {
    const Case c = cases()[1];
    SchemeOptions scheme;
    scheme.lambda = 0.3;
    const Topology topology = build_topology(c.mesh);
    const Umbrellas umbrellas = build_umbrellas(topology, find_features(c.mesh, topology, c.features));
    const UmbrellaTargets targets = rough_targets(umbrellas);
    const Refinement refined = refine(c.mesh, c.features, scheme, 1);
    const Topology fine = build_topology(refined.mesh);
    const FairRows rows = build_fair_rows(umbrellas, fine, find_features(refined.mesh, fine, refined.features));
    const auto found = two_phase_results(*make_device_steps(context, umbrellas, targets), refined.mesh, rows);
    const auto expected = two_phase_results(*make_host_steps(umbrellas, targets), refined.mesh, rows);
    bool passed = true;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const SelftestResult result{found[i].first, c.name + ", double", largest_difference(found[i].second, expected[i].second), std::ldexp(1, -40)};
        report(result);
        passed = result.passed() && passed;
    }
    return passed;
}

/// The kernel that gives each refined row of a step.
std::vector<std::string> kernels_of_rows(const RefinerStep& step) {
    const Index edges = step.topology.vertex_count, faces = edges + step.topology.edge_count;
    const bool is_loop = step.bulk == BulkRule::loop;
    std::vector<std::string> kernels(step.vertex_count, "lcl_refine_rows");
    if (step.bulk == BulkRule::none) return kernels;
    std::fill(kernels.begin(), kernels.begin() + edges, is_loop ? "lcl_refine_loop_vertices" : "lcl_refine_vertices");
    std::fill(kernels.begin() + edges, kernels.begin() + faces, is_loop ? "lcl_refine_loop_edges" : "lcl_refine_edges");
    std::fill(kernels.begin() + faces, kernels.end(), "lcl_refine_faces");
    for (const Index row : step.rows.targets) kernels[row] = "lcl_refine_rows";
    return kernels;
}

/// Two levels of refinement, of which the first takes the case's polygons, creases and alpha, and the second quads or triangles.
bool check_refinement(const std::shared_ptr<Context>& context, const Case& c, Real real, const std::function<void(const SelftestResult&)>& report) {
    constexpr int levels = 2, channels = 3;
    Topology topology = build_topology(c.mesh);
    Features features = find_features(c.mesh, topology, c.features);
    const auto refiner = std::make_shared<const Refiner>(std::move(topology), std::move(features), c.scheme, levels);
    const std::vector<double> values = values_for(c.mesh.vertex_count, channels, 1);
    std::vector<double> found(static_cast<std::size_t>(refiner->vertex_count()) * channels), expected(found.size());
    refiner->apply(values.data(), channels, channels, expected.data(), channels);
    DeviceRefiner(context, refiner).apply(values.data(), channels, channels, real, found.data(), channels);
    const std::vector<std::string> kernels = kernels_of_rows(refiner->steps().back());
    std::map<std::string, std::array<std::vector<double>, 2>> by_kernel;  // found, expected
    for (std::size_t i = 0; i < found.size(); ++i) {
        auto& lists = by_kernel[kernels[i / channels]];
        lists[0].push_back(found[i]);
        lists[1].push_back(expected[i]);
    }
    bool passed = true;
    for (const auto& [kernel, lists] : by_kernel) {
        // The device scales values, of a diagonal of up to 3.5, to a diagonal of 1.
        const SelftestResult result{kernel, what_of(c, channels, real), largest_difference(lists[0], lists[1]), 3.5 * levels * rounding_of(*context, real)};
        report(result);
        passed = passed && result.passed();
    }
    return passed;
}

}  // namespace

bool run_selftest(const std::shared_ptr<Context>& context, const std::function<void(const SelftestResult&)>& report) {
    bool passed = true;
    for (const Case& c : cases())
        for (const Real real : {Real::single, Real::wide, Real::full}) {
            if (real == Real::full && !context->device().has_double) continue;
            if (real != Real::wide) passed = check_surface(context, c.name, c.mesh, c.features, c.scheme, real, report) && passed;
            for (const int channels : {1, 2, 3, 9}) passed = Selftest(context, c, channels, real, report).run() && passed;
            passed = check_refinement(context, c, real, report) && passed;
        }
    passed = check_noise(context, Real::single, report) && passed;
    if (context->device().has_double) {
        passed = check_noise(context, Real::full, report) && passed;
        passed = check_two_phase(context, report) && passed;
    }
    return passed;
}

}  // namespace lcl
