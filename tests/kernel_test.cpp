// SPDX-License-Identifier: BSD-3-Clause
// Every kernel of the operator against plain double loops over the plan's rows. Tolerances follow from the rounding of one row: a row of k entries whose
// weights sum to 1, times values below 1, is off by at most (k + 4) u (products, sums, the weights' own rounding), u = 2^-24 for float, 2^-53 for double, 2^-46
// for pairs of floats.
#include <cmath>
#include <functional>

#include <catch2/catch.hpp>

#include "kernels/types.cl.h"
#include "tests/solver_support.h"

using namespace lcl;
using namespace solver_test;

namespace {

using Values = std::vector<double>;

struct Launching {
    int group;
    Index block_rows;
    std::size_t cache_bytes = 0;
    Index phase_blocks = 1;
};

struct Case {
    std::string name;
    shapes::Shape shape;
    SchemeOptions scheme;
    std::vector<std::uint8_t> subset, owned;
};

class KernelCheck {
public:
    KernelCheck(std::shared_ptr<Context> context, const Case& c, const Launching& launching, int channels, Real real)
        : plan_(make_plan(c, launching)), A_(std::move(context), plan_, launch_shape_of(launching)), channels_(channels), real_(real), launching_(launching) {
        const bool wide = real == Real::full || (real == Real::wide && A_.context().device().has_double);
        unit_ = std::ldexp(1, real == Real::single ? -24 : wide ? -53 : -46);
        for (Index row = 0; row < plan_->row_count; ++row) {
            entries_.push_back(plan_row(*plan_, run_of_row(*plan_, row), row));
            longest_ = std::max(longest_, entries_.back().columns.size());
        }
        x_ = rounded(random_values(1)), m_ = rounded(random_values(2)), d_ = rounded(random_values(3));
        ax_ = apply(x_);
    }

    /// Every kernel that runs on this type.
    void check_all() {
        check_limit_points();
        check_series();
        check_morph();
        if (real_ == Real::wide) return check_wide_residual(), check_residual_of_floats(), check_correct();
        check_relax();
        check_relax_three_term();
        check_chain();
        check_relax_rows(natural_schedule(*plan_));
        check_relax_rows(coloured_schedule(*plan_));
        check_conjugate_gradients();
        check_parts();
    }

    void check_limit_points() {
        const Field x = field(x_);
        Field y = field(d_);
        A_.limit_points(x, y, all());
        CHECK(difference(download(y), with_rows(d_, ax_, all())) <= row_tolerance());
    }

    void check_relax() {
        const Sweep sweep{0.75, 1.25, 0.5, 0};
        const Field m = field(m_), x = field(x_);
        Field y = field(d_);
        A_.sweep(sweep, m, x, nullptr, y, all());
        CHECK(difference(download(y), with_rows(d_, expected(sweep, d_), all())) <= sweep_tolerance(sweep));
        check_norms(x, m_, 2 * row_tolerance());
    }

    void check_relax_three_term() {
        const Sweep sweep{0.75, 1.25, 0.25, -0.5};
        const Field m = field(m_), x = field(x_), d = field(d_);
        Field y = field(x_);
        A_.sweep(sweep, m, x, &d, y, all());
        CHECK(difference(download(y), with_rows(x_, expected(sweep, d_), all())) <= sweep_tolerance(sweep));
        y = field(d_);  // in place: d is y
        A_.sweep(sweep, m, x, &y, y, all());
        CHECK(difference(download(y), with_rows(d_, expected(sweep, d_), all())) <= sweep_tolerance(sweep));
        check_norms(x, m_, 2 * row_tolerance());
    }

    /// Rows of a step may read what steps before have written, with its rounding: the bound is carried along.
    void check_relax_rows(Schedule schedule) {
        kept_schedules_.push_back(std::make_unique<Schedule>(std::move(schedule)));  // the operator knows schedules by their address
        const Schedule& s = *kept_schedules_.back();
        Field x = field(x_);
        A_.relax_rows(s, field(m_), x);
        Values points = x_, bound(plan_->vertex_count, 0.0), worst(plan_->vertex_count, 0.0);
        const Values found = download(x);
        double excess = -1;
        for (const Index row : s.rows) {
            const LimitRow& entries = entries_[row];
            double size = 1, carried = 0;
            for (int c = 0; c < channels_; ++c) {
                double r = m_[at(row, c)];
                for (std::size_t k = 0; k < entries.columns.size(); ++k) r -= entries.weights[k] * points[at(entries.columns[k], c)];
                points[at(row, c)] += r / plan_->diagonal[row];
            }
            for (std::size_t k = 0; k < entries.columns.size(); ++k) {
                if (entries.columns[k] != row) carried += entries.weights[k] * bound[entries.columns[k]];
                for (int c = 0; c < channels_; ++c) size = std::max(size, std::abs(points[at(entries.columns[k], c)]));
            }
            bound[row] = (carried + (static_cast<double>(entries.columns.size()) + 6) * unit_ * 2 * size) / plan_->diagonal[row];
            for (int c = 0; c < channels_; ++c) excess = std::max(excess, std::abs(found[at(row, c)] - points[at(row, c)]) - bound[row]);
        }
        CHECK(excess <= 0);
        for (Index row = plan_->row_count; row < plan_->vertex_count; ++row) CHECK(found[at(row, 0)] == x_[at(row, 0)]);
        A_.context().finish();
    }

    void check_conjugate_gradients() {
        const Part part = plan_->smooth;
        if (part.row_count == 0) return;
        double total = 0;
        for (Index row = part.first_row; row < part.end_row(); ++row) total += plan_->scaling[row];
        // Products are rounded in the field's type; sums in double, or without it in float, a block at a time.
        const double sum_tolerance = 4 * (row_tolerance() + (A_.context().device().has_double ? 0 : launching_.block_rows * unit_)) * total;
        const ChannelValues factor = factors();
        Field p = field(x_), q = field(d_), x = field(m_), r = field(d_);
        check_sums(A_.cg_apply(p, q, part), x_, ax_, sum_tolerance);
        CHECK(difference(download(q), with_rows(d_, ax_, part)) <= row_tolerance());
        Values new_x = m_, new_r = d_, new_p = x_;
        const ChannelValues squares = A_.cg_update(factor, p, q, x, r, part);
        for (Index row = part.first_row; row < part.end_row(); ++row)
            for (int c = 0; c < channels_; ++c) {
                const std::size_t i = at(row, c);
                new_x[i] += factor[c] * x_[i];
                new_r[i] -= factor[c] * ax_[i];
                new_p[i] = new_r[i] + factor[c] * x_[i];
            }
        check_sums(squares, new_r, new_r, 8 * sum_tolerance);
        CHECK(difference(download(x), new_x) <= 4 * unit_);
        CHECK(difference(download(r), new_r) <= 2 * row_tolerance());
        Values others = new_r;
        for (double& value : others) value = -value;
        check_norms(x, others, 4 * row_tolerance(), part, true);
        A_.cg_direction(factor, r, p, part);
        CHECK(difference(download(p), new_p) <= 4 * row_tolerance());
    }

    /// Sweeps over single parts leave the other rows alone.
    void check_parts() {
        for (const Part& part : {plan_->fixed, plan_->curves, plan_->darts, plan_->smooth}) {
            const Field x = field(x_);
            Field y = field(d_);
            A_.limit_points(x, y, part);
            CHECK(difference(download(y), with_rows(d_, ax_, part)) <= row_tolerance());
        }
    }

    /// m = A x + 1e-9: what is left is computed in the wide type and handed on in float.
    void check_wide_residual() {
        Values m = ax_, small = random_values(5);
        for (std::size_t i = 0; i < m.size(); ++i) m[i] += 1e-9 * small[i];
        m = rounded(m);
        const Field wide_m = field(m), wide_x = field(x_);
        Field r = A_.make_field(channels_, Real::single);
        r.upload(random_values(6).data(), 0, plan_->vertex_count);
        const Values before = download(r);
        A_.wide_residual(wide_m, wide_x, r, all());
        Values residual(m.size());
        for (std::size_t i = 0; i < m.size(); ++i) residual[i] = m[i] - ax_[i];
        const double tolerance = row_tolerance() + unit_ + 1e-9 * std::ldexp(1, -24);
        CHECK(difference(download(r), with_rows(before, residual, all())) <= tolerance);
        const ResidualNorms found = A_.norms(r, all()), plain = norms_of(residual);
        CHECK(std::abs(found.position - plain.position) <= 2 * tolerance + 4e-7 * plain.position);
        CHECK(std::abs(found.others - plain.others) <= 3 * tolerance + 4e-7 * plain.others);
    }

    /// The same on fields of floats.
    void check_residual_of_floats() {
        Field m = A_.make_field(channels_, Real::single), x = A_.make_field(channels_, Real::single), r = A_.make_field(channels_, Real::single);
        m.upload(m_.data(), 0, plan_->vertex_count);
        x.upload(x_.data(), 0, plan_->vertex_count);
        r.fill_zero();
        const Values float_m = download(m), a_x = apply(download(x));
        Values residual(float_m.size());
        for (std::size_t i = 0; i < residual.size(); ++i) residual[i] = float_m[i] - a_x[i];
        A_.wide_residual(m, x, r, all());
        CHECK(difference(download(r), with_rows(Values(residual.size(), 0.0), residual, all())) <= row_tolerance() + std::ldexp(1, -22));
    }

    /// Three sweeps in one go are three sweeps one after the other.
    void check_chain() {
        const std::vector<Sweep> sweeps{{0.75, 1.25, 0.25, -0.5}, {0.5, 0.75, 0, 0.25}, {1, 0.5, 0, -0.25}};
        if (launching_.phase_blocks > 1) CHECK(plan_->reach > 1);
        if (launching_.cache_bytes > 0) CHECK(A_.phases(sweeps.size(), field(x_), plan_->smooth).width < plan_->smooth.block_count);
        for (const Part& part : {all(), plan_->smooth}) {
            const Field m = field(m_);
            Field x = field(x_), y = field(d_), plain_x = field(x_), plain_y = field(d_);
            const std::vector<ResidualNorms> norms = A_.chain(sweeps, m, x, y, part);
            REQUIRE(norms.size() == sweeps.size());
            for (std::size_t s = 0; s < sweeps.size(); ++s, std::swap(plain_x, plain_y)) {
                A_.sweep(sweeps[s], m, plain_x, &plain_y, plain_y, part);
                const ResidualNorms plain = A_.norms(plain_x, part);
                CHECK(std::abs(norms[s].position - plain.position) <= 32 * row_tolerance());
                CHECK(std::abs(norms[s].others - plain.others) <= 32 * row_tolerance());
            }
            CHECK(difference(download(x), download(plain_x)) <= 32 * row_tolerance());
        }
    }

    /// Two chains of steps, of both kinds, with the sums over each step's rows.
    void check_series() {
        if (plan_->row_count < plan_->vertex_count) return;  // ghosts have no rows to go on from
        for (const SeriesThird third : {SeriesThird::input, SeriesThird::older}) {
            const Index repeated = plan_->vertex_count > 10000 ? 3 : LCL_CHAIN;
            const SeriesSteps steps{third, {{0.75, 0.25, 0}, {1, -0.5, 0}}, {{0.5, 0.25, 0.25}}, repeated};
            const auto [values, bound] = expected_chain(steps, x_);
            const Field x = field(x_);
            if (launching_.cache_bytes > 0)
                CHECK(A_.phases(LCL_CHAIN, x, plan_->smooth, third == SeriesThird::input ? 3 : 2).width < plan_->smooth.block_count);
            Field out = field(d_), scratch = field(m_);
            CHECK(A_.series(steps, x, out, scratch));
            CHECK(difference(download(out), values.back()) <= bound);
            CHECK(difference(download(x), x_) == 0);
            if (third == SeriesThird::input) continue;
            out = field(d_), scratch = field(m_);
            const std::vector<SeriesSums> sums = A_.series_with_sums(steps, x, out, scratch);
            CHECK(difference(download(out), values.back()) <= bound);
            REQUIRE(sums.size() == values.size());
            for (std::size_t k = 0; k < sums.size(); ++k) check_series_sums(sums[k], values[k], bound);
        }
    }

    void check_series_sums(const SeriesSums& found, const Values& y, double bound) const {
        // Without double, sums are made in float, a block at a time, of values and scalings rounded to float.
        const double sum_unit = A_.context().device().has_double ? unit_ : (launching_.block_rows + 4) * std::ldexp(1, -24);
        double total = 0;
        for (const double scaling : plan_->scaling) total += scaling;
        REQUIRE((found.linear.size() == static_cast<std::size_t>(channels_) && found.square.size() == static_cast<std::size_t>(channels_)));
        for (int c = 0; c < channels_; ++c) {
            double linear = 0, square = 0, size = 1;
            for (Index row = 0; row < plan_->row_count; ++row) {
                linear += plan_->scaling[row] * y[at(row, c)];
                square += plan_->scaling[row] * y[at(row, c)] * y[at(row, c)];
                size = std::max(size, std::abs(y[at(row, c)]));
            }
            CHECK(std::abs(found.linear[c] - linear) <= (bound + 4 * sum_unit * size) * total);
            CHECK(std::abs(found.square[c] - square) <= 2 * size * (bound + 4 * sum_unit * size) * total);
        }
    }

    /// An even and an odd number of steps in place, and what is done row by row.
    void check_morph() {
        const Field target = field(m_);
        for (const Index repeated : {1, 2}) {
            if (plan_->row_count < plan_->vertex_count) break;
            const SeriesSteps steps{SeriesThird::older, {{0, 0.75, 0}, {1, -0.5, 0}}, {{0.5, 0.25, 0.25}}, repeated};
            const auto [values, bound] = expected_chain(steps, x_);
            Field difference_field = field(x_), scratch = field(d_), frame = field(d_);
            A_.morph(steps, target, difference_field, scratch, frame);
            CHECK(difference(download(difference_field), values.back()) <= bound);
            CHECK(difference(download(frame), sum(1, m_, 1, values.back())) <= bound + 2 * 3 * unit_);
        }
        Field y = field(x_), frame = field(d_);
        A_.morph_blend(0.375, target, y, frame);
        CHECK(difference(download(y), sum(0.375, x_, 0, x_)) <= unit_);
        CHECK(difference(download(frame), sum(1, m_, 0.375, x_)) <= 3 * unit_);
        A_.subtract(target, y, frame);
        CHECK(difference(download(frame), sum(1, m_, -0.375, x_)) <= 4 * unit_);
    }

    void check_correct() {
        Field x = field(x_), d = A_.make_field(channels_, Real::single);
        d.upload(d_.data(), 0, plan_->vertex_count);
        const Values correction = download(d);
        A_.correct(d, x, plan_->smooth);
        Values expected_x = x_;
        for (std::size_t i = at(plan_->smooth.first_row, 0); i < at(plan_->smooth.end_row(), 0); ++i) expected_x[i] += correction[i];
        CHECK(difference(download(x), expected_x) <= 4 * unit_);
    }

private:
    static LaunchShape launch_shape_of(const Launching& launching) {
        return {launching.group, launching.block_rows, launching.cache_bytes, launching.phase_blocks};
    }
    static std::shared_ptr<const Plan> make_plan(const Case& c, const Launching& launching) {
        PlanOptions options;
        options.block_rows = launching.block_rows;
        options.subset = c.subset;
        options.owned = c.owned;
        return std::make_shared<const Plan>(Prepared(c.shape).plan(c.scheme, options));
    }

    Part all() const { return plan_->all_rows(); }
    std::size_t at(Index row, int channel) const { return static_cast<std::size_t>(row) * channels_ + channel; }
    double row_tolerance() const { return (static_cast<double>(longest_) + 4) * unit_; }
    double smallest_diagonal() const { return plan_->row_count == 0 ? 1 : *std::min_element(plan_->diagonal.begin(), plan_->diagonal.end()); }
    double sweep_tolerance(const Sweep& s) const {
        const double on_residual = std::abs(s.b) + std::abs(s.b_jacobi) / smallest_diagonal();
        return 2 * on_residual * (row_tolerance() + 3 * unit_) + (std::abs(s.a) + std::abs(s.c)) * 3 * unit_;
    }

    Values random_values(std::uint64_t seed) const {
        shapes::Random random(seed);
        Values values(static_cast<std::size_t>(plan_->vertex_count) * channels_);
        for (double& value : values) value = random.symmetric();
        return values;
    }

    /// As the field holds them, so that only the arithmetic is compared.
    Values rounded(const Values& values) const { return download(field(values)); }

    Field field(const Values& values) const {
        Field field = A_.make_field(channels_, real_);
        field.upload(values.data(), 0, plan_->vertex_count);
        return field;
    }

    Values download(const Field& field) const {
        Values values(static_cast<std::size_t>(plan_->vertex_count) * channels_);
        field.download(values.data(), 0, plan_->vertex_count);
        return values;
    }

    Values apply(const Values& x) const {
        Values y = x;
        for (Index row = 0; row < plan_->row_count; ++row)
            for (int c = 0; c < channels_; ++c) {
                long double sum = 0;
                for (std::size_t k = 0; k < entries_[row].columns.size(); ++k)
                    sum += static_cast<long double>(entries_[row].weights[k]) * x[at(entries_[row].columns[k], c)];
                y[at(row, c)] = static_cast<double>(sum);
            }
        return y;
    }

    Values expected(const Sweep& s, const Values& d) const {
        Values y(x_.size());
        for (Index row = 0; row < plan_->row_count; ++row)
            for (int c = 0; c < channels_; ++c) {
                const std::size_t i = at(row, c);
                y[i] = s.a * x_[i] + (s.b + s.b_jacobi / plan_->diagonal[row]) * (m_[i] - ax_[i]) + s.c * d[i];
            }
        return y;
    }

    /// y of every step of a chain, and a bound of what rounding makes of the last: A does not enlarge anything in the largest norm.
    std::pair<std::vector<Values>, double> expected_chain(const SeriesSteps& steps, const Values& input) const {
        std::vector<Values> y{input};
        std::vector<double> bound{0};
        for (std::int64_t k = 0; k < steps.count(); ++k) {
            const SeriesStep& s = steps[k];
            const bool is_older = steps.third == SeriesThird::older;
            const Values& third = is_older && k > 0 ? y[k - 1] : input;
            const Values ay = apply(y[k]);
            Values next = sum(s.a, y[k], s.b, ay);
            if (s.c != 0) next = sum(1, next, s.c, third);
            const double size = std::max({largest_of(y[k]), largest_of(third), largest_of(next)});
            bound.push_back((std::abs(s.a) + std::abs(s.b)) * bound[k] + (is_older && k > 0 ? std::abs(s.c) * bound[k - 1] : 0) +
                            (std::abs(s.b) * row_tolerance() + 3 * (std::abs(s.a) + std::abs(s.b) + std::abs(s.c)) * unit_) * size);
            y.push_back(std::move(next));
        }
        y.erase(y.begin());
        return {std::move(y), *std::max_element(bound.begin(), bound.end())};
    }

    static double largest_of(const Values& values) {
        double largest = 0;
        for (const double value : values) largest = std::max(largest, std::abs(value));
        return largest;
    }

    /// a x + b y
    static Values sum(double a, const Values& x, double b, const Values& y) {
        Values out(x.size());
        for (std::size_t i = 0; i < x.size(); ++i) out[i] = a * x[i] + b * y[i];
        return out;
    }

    /// `inside` on the part's rows, `outside` on the others.
    Values with_rows(const Values& outside, const Values& inside, const Part& part) const {
        Values values = outside;
        std::copy(inside.begin() + static_cast<std::ptrdiff_t>(at(part.first_row, 0)), inside.begin() + static_cast<std::ptrdiff_t>(at(part.end_row(), 0)),
                  values.begin() + static_cast<std::ptrdiff_t>(at(part.first_row, 0)));
        return values;
    }

    /// Not a number where one of the values is none.
    static double difference(const Values& a, const Values& b) {
        double worst = a.size() == b.size() ? 0 : std::nan("");
        for (std::size_t i = 0; i < a.size() && !std::isnan(worst); ++i) worst = std::abs(a[i] - b[i]) <= worst ? worst : std::abs(a[i] - b[i]);
        return worst;
    }

    ResidualNorms norms_of(const Values& residual, const Part& part) const {
        ResidualNorms norms;
        for (Index row = part.first_row; row < part.end_row(); ++row) {
            double square = 0, other = 0;
            for (const ChannelBlock& block : channel_blocks(channels_)) {
                double sum = 0;
                for (int c = block.first; c < block.first + block.count; ++c) (c < 3 ? square : sum) += residual[at(row, c)] * residual[at(row, c)];
                other = std::max(other, sum);
            }
            norms.position = std::max(norms.position, std::sqrt(square));
            norms.others = std::max(norms.others, std::sqrt(other));
        }
        return norms;
    }
    ResidualNorms norms_of(const Values& residual) const { return norms_of(residual, all()); }

    /// Norms that the last launch left, against those of m - A x, or of -m where the residual itself is given. Further channels are measured together with
    /// those of their block.
    void check_norms(const Field& like, const Values& m, double tolerance) { check_norms(like, m, tolerance, all(), false); }
    void check_norms(const Field& like, const Values& m, double tolerance, const Part& part, bool is_residual) {
        Values residual(m.size());
        for (std::size_t i = 0; i < m.size(); ++i) residual[i] = is_residual ? -m[i] : m[i] - ax_[i];
        const ResidualNorms found = A_.norms(like, part), plain = norms_of(residual, part);
        CHECK(std::abs(found.position - plain.position) <= 2 * tolerance + 8 * unit_ * plain.position);
        CHECK(std::abs(found.others - plain.others) <= 2 * tolerance + 8 * unit_ * plain.others);
    }

    ChannelValues factors() const {
        ChannelValues factor;
        for (int c = 0; c < channels_; ++c) factor.push_back(0.5 + 0.0625 * c);
        return factor;
    }

    void check_sums(const ChannelValues& found, const Values& u, const Values& v, double tolerance) const {
        REQUIRE(found.size() == static_cast<std::size_t>(channels_));
        for (int c = 0; c < channels_; ++c) {
            double sum = 0;
            for (Index row = plan_->smooth.first_row; row < plan_->smooth.end_row(); ++row) sum += plan_->scaling[row] * u[at(row, c)] * v[at(row, c)];
            CHECK(std::abs(found[c] - sum) <= tolerance);
        }
    }

    std::shared_ptr<const Plan> plan_;
    DeviceOperator A_;
    int channels_;
    Real real_;
    Launching launching_;
    double unit_ = 0;
    std::vector<LimitRow> entries_;
    std::size_t longest_ = 1;
    Values x_, m_, d_, ax_;
    std::vector<std::unique_ptr<Schedule>> kept_schedules_;
};

/// Ring rows of many valences, weighted rows, curves, darts, fixed rows, ghosts; odd sizes.
std::vector<Case> small_cases() {
    std::vector<Case> cases{{"quads", shapes::torus_quads(17, 13), catmull_clark(), {}, {}},
                            {"creases and darts", shapes::grid_with_creases(), catmull_clark(0.3), {}, {}},
                            {"polygons", shapes::polygons_mixed(151, 3), doo_sabin(DooSabinMask::classic), {}, {}},
                            {"triangles", shapes::random_triangle_mesh(233, 2, 20), loop(), {}, {}},
                            {"quads at a pole", shapes::disk_pole_quads(60), catmull_clark(0.5), {}, {}},
                            {"triangles at a pole", shapes::disk_pole_triangles(60), loop(), {}, {}},
                            {"one ratio a vertex", shapes::icosphere_quads(1), catmull_clark(), {}, {}},
                            {"one row", shapes::torus_quads(3, 3), catmull_clark(), {0, 0, 0, 0, 1, 0, 0, 0, 0}, {}},
                            {"only fixed rows", shapes::single_quad(), catmull_clark(), {}, {}},
                            {"ghosts", shapes::torus_triangles(9, 5), loop(), {}, {}}};
    for (Index v = 0; v < cases[6].shape.mesh.vertex_count; ++v) cases[6].scheme.lambda_per_vertex.push_back(v % 5 * 0.2);
    for (Index v = 0; v < cases[9].shape.mesh.vertex_count; ++v) cases[9].owned.push_back(v % 4 != 1);
    return cases;
}

std::vector<Real> reals() {
    return device_context()->device().has_double ? std::vector<Real>{Real::single, Real::wide, Real::full} : std::vector<Real>{Real::single, Real::wide};
}

void check(const std::shared_ptr<Context>& context, const Case& c, const Launching& launching, int channels, Real real) {
    INFO(c.name << ", " << channels << " channels, type " << static_cast<int>(real) << ", group " << launching.group << ", blocks of " << launching.block_rows
                << " rows" << (context->device().has_double ? "" : ", no double"));
    KernelCheck(context, c, launching, channels, real).check_all();
}

}  // namespace

TEST_CASE("kernels equal plain loops on every kind of row, one work-item a block", "[kernel]") {
    for (const Case& c : small_cases())
        for (const Real real : reals())
            for (const Index block_rows : {7, 8192}) check(device_context(), c, {1, block_rows}, 3, real);
}

TEST_CASE("kernels equal plain loops in the shape of a GPU, a work-group a block", "[kernel]") {
    for (const Case& c : small_cases())
        for (const Real real : reals())
            for (const Launching& launching : {Launching{16, 33}, Launching{16, 1024}}) check(device_context(), c, launching, 3, real);
    for (const Case& c : small_cases()) check(device_context(), c, {64, 150}, 3, Real::single);
}

TEST_CASE("kernels equal plain loops with 1 to 17 channels", "[kernel][channels]") {
    const Case c{"creases and darts", shapes::grid_with_creases(), catmull_clark(0.3), {}, {}};
    for (const int channels : {1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 12, 17})
        for (const Real real : reals()) check(device_context(), c, {1, 20}, channels, real);
    check(device_context(), c, {16, 20}, 1, Real::single);
    check(device_context(), c, {16, 20}, 9, reals().back());
}

TEST_CASE("pairs of floats stand in where there is no double", "[kernel][pair]") {
    for (const Case& c : small_cases()) check(context_without_double(), c, {1, 64}, 3, Real::wide);
    const Case c{"creases and darts", shapes::grid_with_creases(), catmull_clark(0.3), {}, {}};
    for (const int channels : {1, 2, 7, 9}) check(context_without_double(), c, {1, 64}, channels, Real::wide);
    for (const Real real : {Real::single, Real::wide}) check(context_without_double(), c, {16, 20}, 3, real);
}

TEST_CASE("kernels equal plain loops on 100 000 rows", "[kernel]") {
    const Case quads{"100172 quads", shapes::torus_quads(317, 316), catmull_clark(), {}, {}},
        triangles{"99847 triangles", shapes::shuffled(shapes::torus_triangles(313, 319), 1), loop(), {}, {}};
    for (const Case& c : {quads, triangles}) {
        check(device_context(), c, {1, 8192}, 3, Real::single);
        check(device_context(), c, {16, 1024}, 3, Real::single);
        check(device_context(), c, {1, 8192}, 3, Real::wide);
        for (const int channels : {3, 5}) check(device_context(), c, {1, 512, 2000000}, channels, Real::single);  // sweeps that follow each other
        check(device_context(), c, {1, 128, 2000000, 8}, 19, Real::single);                                       // several blocks a phase, reach above 1
    }
}

TEST_CASE("every kernel runs once on a small mesh", "[kernel][tiny]") {
    const Case c{"creases and darts", shapes::grid_with_creases(), catmull_clark(0.3), {}, {}};
    check(device_context(), c, {16, 30}, 3, Real::single);
    check(device_context(), c, {16, 30}, 3, Real::wide);
    check(device_context(), c, {1, 8192}, 2, Real::single);
    const Case torus{"sweeps that follow each other", shapes::torus_quads(17, 13), catmull_clark(), {}, {}};
    check(device_context(), torus, {1, 4, 12000}, 3, Real::single);
}

TEST_CASE("results are the same bits in every run and for every shape of launch", "[kernel]") {
    const Prepared mesh(shapes::random_triangle_mesh(400, 6));
    const auto sweep_of = [&](int group) {
        PlanOptions options;
        options.block_rows = 64;
        const auto plan = std::make_shared<const Plan>(mesh.plan(loop(), options));
        DeviceOperator A(device_context(), plan, {group, 64, 0, 1});
        const Eigen::MatrixXd values = rough_values(3, mesh.vertex_count(), 9);
        Field x = A.make_field(3, Real::single), y = A.make_field(3, Real::single);
        x.upload(values.data(), 0, plan->vertex_count);
        A.sweep({1, 1, 0, 0}, x, x, nullptr, y, plan->all_rows());
        Values out(3 * static_cast<std::size_t>(mesh.vertex_count()) + 1);
        y.download(out.data(), 0, plan->vertex_count);
        out.back() = A.norms(x, plan->all_rows()).position;
        return out;
    };
    const Values once = sweep_of(1);
    CHECK(once == sweep_of(1));
    CHECK(sweep_of(16) == sweep_of(16));
}

TEST_CASE("launch shapes suit the kind of device", "[kernel]") {
    DeviceInfo device;
    device.max_work_group_size = 4096;
    device.cache_bytes = 1000000, device.compute_units = 4;
    CHECK(launch_shape(device, 1000000).group == 1);
    CHECK((launch_shape(device, 1000000).cache_bytes > 0 && launch_shape(device, 1000000).cache_bytes < device.cache_bytes));
    CHECK(launch_shape(device, 1000000).phase_blocks >= 4);
    CHECK(launch_shape(device, 20000).block_rows <= 20000 / 4 / 4);
    CHECK(launch_shape(device, 5).block_rows > 0);
    device.is_gpu = true;
    CHECK(launch_shape(device, 1000000).group == 128);
    CHECK(launch_shape(device, 1000000).cache_bytes == 0);
    device.max_work_group_size = 64;
    CHECK(launch_shape(device, 1000000).group == 64);
    CHECK(launch_shape(device, 1000000).block_rows > 0);
}
