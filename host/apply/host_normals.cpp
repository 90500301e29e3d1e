// SPDX-License-Identifier: BSD-3-Clause
#include "host/apply/host_normals.h"

#include <array>
#include <cmath>

#include "kernels/normals.cl.h"

namespace lcl {
namespace {

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }
Vector unit(const Vector& a) {
    const double size = std::sqrt(dot(a, a));
    return size > 0 ? Vector{a[0] / size, a[1] / size, a[2] / size} : Vector{};
}

class HostNormals {
public:
    HostNormals(const Plan& plan, const TangentPlan& tangents, const std::vector<double>& x) : plan_(plan), tangents_(tangents), x_(x) {
        out_.vertices.assign(x.size(), 0.0);
        out_.sides.assign(3 * static_cast<std::size_t>(tangents.side_count()), 0.0);
    }

    Normals run() {
        for (std::size_t r = 0; r < plan_.runs.size(); ++r)
            for (Index row = plan_.runs[r].first; tangents_.run_turns[r] >= 0 && row < plan_.runs[r].first + plan_.runs[r].count; ++row)
                put(out_.vertices, row, ring_normal(plan_.runs[r], &tangents_.turns[tangents_.run_turns[r]], row));
        for (std::size_t i = 0; i < tangents_.rows.size(); ++i) store_row(i);
        return std::move(out_);
    }

private:
    static void put(std::vector<double>& to, std::size_t place, const Vector& value) { std::copy(value.begin(), value.end(), to.begin() + 3 * place); }

    /// sum += weight (x_column - x_row)
    void add(Vector& sum, double weight, Index column, Index row) const {
        for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * (x_[3 * static_cast<std::size_t>(column) + c] - x_[3 * static_cast<std::size_t>(row) + c]);
    }

    Vector ring_normal(const Run& run, const double* turn, Index row) const {
        Vector first{}, second{};
        const Index* const neighbours = plan_.indices.data() + run.index_offset + static_cast<std::size_t>(row - run.first) * run.stride();
        for (int j = 0; j < run.stride(); ++j) {
            add(first, turn[2 * j], neighbours[j], row);
            add(second, turn[2 * j + 1], neighbours[j], row);
        }
        return unit(cross(first, second));
    }

    Vector sector_normal(Index row, std::uint32_t sector) const {
        std::array<Vector, 3> sums{};
        for (std::uint32_t e = tangents_.entry_offsets[sector]; e < tangents_.entry_offsets[sector + 1]; ++e)
            for (std::size_t t = 0; t < 3; ++t) add(sums[t], tangents_.weights[3 * static_cast<std::size_t>(e) + t], tangents_.columns[e], row);
        for (Vector& sum : sums) sum = unit(sum);
        const Vector normal = cross(sums[0], sums[1]);
        return unit(dot(normal, normal) > LCL_PARALLEL ? normal : cross(sums[0], sums[2]));
    }

    void store_row(std::size_t i) {
        Vector mean{};
        for (std::uint32_t s = tangents_.sector_offsets[i]; s < tangents_.sector_offsets[i + 1]; ++s) {
            const Vector normal = sector_normal(tangents_.rows[i], s);
            if (s < static_cast<std::uint32_t>(tangents_.side_count())) put(out_.sides, s, normal);
            for (std::size_t c = 0; c < 3; ++c) mean[c] += normal[c];
        }
        put(out_.vertices, tangents_.rows[i], unit(mean));
    }

    const Plan& plan_;
    const TangentPlan& tangents_;
    const std::vector<double>& x_;
    Normals out_;
};

}  // namespace

Normals host_normals(const Plan& plan, const TangentPlan& tangents, const std::vector<double>& x) { return HostNormals(plan, tangents, x).run(); }

}  // namespace lcl
