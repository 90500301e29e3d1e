// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>

#include "host/parallel.h"
#include "host/two_phase/umbrella_steps.h"

namespace lcl {
namespace {

using Vector = std::array<double, 3>;

constexpr std::size_t block_size = 4096;  // summed one after the other: sums do not depend on the number of threads
constexpr std::size_t smallest_piece = 2048;

Vector at(const std::vector<double>& values, std::size_t i) { return {values[3 * i], values[3 * i + 1], values[3 * i + 2]}; }
void add(std::vector<double>& values, std::size_t i, double factor, const Vector& a) {
    for (std::size_t c = 0; c < 3; ++c) values[3 * i + c] += factor * a[c];
}
Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }
double length(const Vector& a) { return std::sqrt(dot(a, a)); }

/// Sum of term(i) over 0 .. count - 1.
template <class Term>
double sum(std::size_t count, const Term& term) {
    const std::size_t blocks = (count + block_size - 1) / block_size;
    std::vector<double> partial(blocks, 0.0);
    parallel_for(
        blocks,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t b = begin; b < end; ++b)
                for (std::size_t i = b * block_size; i < std::min(count, (b + 1) * block_size); ++i) partial[b] += term(i);
        },
        1);
    double total = 0;
    for (const double part : partial) total += part;
    return total;
}

class HostSteps : public UmbrellaSteps {
public:
    HostSteps(const Umbrellas& umbrellas, const UmbrellaTargets& targets) : umbrellas_(umbrellas), targets_(targets) {}

    void upload(const std::vector<double>& points) override { x_ = in_umbrella_order(umbrellas_, points); }
    void download(std::vector<double>& points) override { points = in_vertex_order(umbrellas_, x_); }

    RepairFindings repair() override {
        const auto count = static_cast<std::size_t>(umbrellas_.count);
        RepairFindings found{std::vector<double>(count, 0.0), std::vector<double>(count, 1.0)};
        for_each_umbrella([&](std::size_t u) {
            if (!targets_.constrained[u]) return;
            const Sums sums = sums_of(x_, u);
            const Vector residual = minus(at(targets_.points, u), sums.limit), normal = at(targets_.normals, u);
            found.distances[u] = length(residual);
            if (length(normal) > 0) found.sides[u] = dot(cross(sums.first, sums.second), normal);
            least_norm_step(x_, u, residual, sums);
        });
        return found;
    }

    void scale() override {
        for_each_umbrella([&](std::size_t u) {
            const double handle = targets_.handles[u];
            if (handle == 1) return;
            const Vector limit = sums_of(x_, u).limit;
            for_each_member(u, [&](std::size_t i, const std::array<double, 3>&) {
                for (std::size_t c = 0; c < 3; ++c) x_[3 * i + c] = limit[c] + handle * (x_[3 * i + c] - limit[c]);
            });
        });
    }

    void set_fairness(const FairRows& rows, double weight) override {
        rows_ = &rows;
        weight_ = weight;
        z_.resize(x_.size()), p_.resize(x_.size()), q_.resize(x_.size()), r_.resize(x_.size());
    }

    double energy() override { return laplacian(x_); }

    double begin() override {
        laplacian(x_);
        project_gradient(0);
        for (std::size_t i = 0; i < r_.size(); ++i) p_[i] = r_[i] = -q_[i];
        return squares(r_);
    }

    double apply() override {
        laplacian(p_);
        project_gradient(1);
        return sum(vertex_count(), [&](std::size_t i) { return dot(at(p_, i), at(q_, i)); });
    }

    double update(double alpha) override {
        for (std::size_t i = 0; i < x_.size(); ++i) x_[i] += alpha * p_[i], r_[i] -= alpha * q_[i];
        return squares(r_);
    }

    void turn(double beta) override {
        for (std::size_t i = 0; i < p_.size(); ++i) p_[i] = r_[i] + beta * p_[i];
    }

private:
    struct Sums {
        Vector limit, first, second;
    };

    std::size_t vertex_count() const { return static_cast<std::size_t>(umbrellas_.vertex_count); }
    double squares(const std::vector<double>& values) const {
        return sum(vertex_count(), [&](std::size_t i) { return dot(at(values, i), at(values, i)); });
    }

    template <class Body>
    void for_each_umbrella(const Body& body) const {
        parallel_for_each(static_cast<std::size_t>(umbrellas_.count), body, smallest_piece);
    }

    /// body(place, weights) for the centre and every member.
    template <class Body>
    void for_each_member(std::size_t u, const Body& body) const {
        const UmbrellaMask& mask = umbrellas_.masks[umbrellas_.mask_of[u]];
        const auto first = static_cast<std::size_t>(umbrellas_.offsets[u]);
        for (std::size_t k = 0; k < mask.weights.size(); ++k) body(first + k, mask.weights[k]);
    }

    /// The three masks applied. Differences to the centre keep the digits of meshes far from the origin.
    Sums sums_of(const std::vector<double>& values, std::size_t u) const {
        Sums sums{};
        const Vector centre = at(values, umbrellas_.offsets[u]);
        for_each_member(u, [&](std::size_t i, const std::array<double, 3>& weights) {
            const Vector from_centre = minus(at(values, i), centre);
            for (std::size_t c = 0; c < 3; ++c) {
                sums.limit[c] += weights[0] * from_centre[c];
                sums.first[c] += weights[1] * from_centre[c];
                sums.second[c] += weights[2] * from_centre[c];
            }
        });
        for (std::size_t c = 0; c < 3; ++c) sums.limit[c] += centre[c];
        return sums;
    }

    /// Across N the position alone asks for something: a_k / sum a^2 of it. Along N all three masks do: G y = (residual.N, -t1.N, -t2.N), G their Gram matrix.
    void least_norm_step(std::vector<double>& values, std::size_t u, const Vector& residual, const Sums& sums) const {
        const UmbrellaMask& mask = umbrellas_.masks[umbrellas_.mask_of[u]];
        const Vector normal = at(targets_.normals, u);
        const double along = dot(residual, normal), first = -dot(sums.first, normal), second = -dot(sums.second, normal);
        const std::array<double, 6>& g = mask.inverse_gram;
        const double y[3] = {g[0] * along + g[1] * first + g[2] * second, g[1] * along + g[3] * first + g[4] * second,
                             g[2] * along + g[4] * first + g[5] * second};
        Vector across{};
        for (std::size_t c = 0; c < 3; ++c) across[c] = mask.inverse_square * (residual[c] - along * normal[c]);
        for_each_member(u, [&](std::size_t i, const std::array<double, 3>& weights) {
            add(values, i, weights[0], across);
            add(values, i, weights[0] * y[0] + weights[1] * y[1] + weights[2] * y[2], normal);
        });
    }

    /// z = L v, each row divided by its length; gives |L v|^2.
    double laplacian(const std::vector<double>& v) {
        return sum(vertex_count(), [&](std::size_t i) {
            const Index length = rows_->lengths[i];
            Vector row{};
            for (std::uint32_t e = rows_->offsets[i]; e < rows_->offsets[i + 1]; ++e) {
                const std::uint32_t code = rows_->neighbours[e];
                if ((code & FairRows::counts) == 0) continue;
                const Vector from_vertex = minus(at(v, code & FairRows::place), at(v, i));
                for (std::size_t c = 0; c < 3; ++c) row[c] += from_vertex[c] / length;
            }
            for (std::size_t c = 0; c < 3; ++c) z_[3 * i + c] = length == 0 ? 0 : row[c] / length;
            return dot(row, row);
        });
    }

    /// (L^T L v)_i of laplacian's v: every row that counts i gives its share, i's own takes it away.
    Vector transposed(std::size_t i) const {
        Vector value{};
        for (std::size_t c = 0; c < 3; ++c) value[c] = -rows_->lengths[i] * z_[3 * i + c];
        for (std::uint32_t e = rows_->offsets[i]; e < rows_->offsets[i + 1]; ++e) {
            const std::uint32_t code = rows_->neighbours[e];
            if ((code & FairRows::is_counted) == 0) continue;
            for (std::size_t c = 0; c < 3; ++c) value[c] += z_[3 * std::size_t{code & FairRows::place} + c];
        }
        return value;
    }

    /// q = C (shift p + W L^T L v), v that of laplacian.
    void project_gradient(double shift) {
        for_each_umbrella([&](std::size_t u) {
            for_each_member(u, [&](std::size_t i, const std::array<double, 3>&) {
                const Vector gradient = transposed(i);
                for (std::size_t c = 0; c < 3; ++c) q_[3 * i + c] = shift * p_[3 * i + c] + weight_ * gradient[c];
            });
            if (!targets_.constrained[u]) return;
            const Sums sums = sums_of(q_, u);
            least_norm_step(q_, u, minus({}, sums.limit), sums);
        });
    }

    const Umbrellas& umbrellas_;
    const UmbrellaTargets& targets_;
    const FairRows* rows_ = nullptr;
    double weight_ = 0;
    std::vector<double> x_, z_, p_, q_, r_;
};

}  // namespace

std::vector<double> in_umbrella_order(const Umbrellas& umbrellas, const std::vector<double>& points) {
    std::vector<double> ordered(points.size());
    parallel_for_each(umbrellas.order.size(),
                      [&](std::size_t i) { std::copy_n(&points[3 * static_cast<std::size_t>(umbrellas.order[i])], 3, &ordered[3 * i]); });
    return ordered;
}

std::vector<double> in_vertex_order(const Umbrellas& umbrellas, const std::vector<double>& ordered) {
    std::vector<double> points(ordered.size());
    parallel_for_each(umbrellas.order.size(),
                      [&](std::size_t i) { std::copy_n(&ordered[3 * i], 3, &points[3 * static_cast<std::size_t>(umbrellas.order[i])]); });
    return points;
}

std::unique_ptr<UmbrellaSteps> make_host_steps(const Umbrellas& umbrellas, const UmbrellaTargets& targets) {
    return std::make_unique<HostSteps>(umbrellas, targets);
}

}  // namespace lcl
