// SPDX-License-Identifier: BSD-3-Clause
#include "host/points/fit_system.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "host/parallel.h"
#include "host/points/bending.h"
#include "host/refine/steps.h"

namespace lcl {

/// Samples sorted by patch.
struct SortedSamples {
    std::vector<PatchPlace> places;
    std::vector<std::size_t> order;   ///< the samples of patch p stand at starts[p] .. starts[p + 1] - 1
    std::vector<std::size_t> starts;  ///< patch_count + 1
    std::vector<Index> patches;       ///< those with samples
};

namespace {

using Eigen::MatrixXd;
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr std::size_t smallest_piece = 256;                  // of patches, and of rows that are made of other rows
constexpr std::size_t block_entries = std::size_t{1} << 20;  // of the matrices of patches that are held at a time
constexpr Index sample_block = 64;                           // rows of a patch's samples that are multiplied at a time
constexpr double smallest_part = 1e-9;                       // of a diagonal block's trace, that every direction has at least where the block is inverted
constexpr std::size_t sum_block = 4096;                      // sums are those of blocks, so that threads do not change them

/// Sums of rows, one at a time.
class RowSum {
public:
    explicit RowSum(Index column_count) : place_(static_cast<std::size_t>(column_count), -1) {}

    void add(Index column) {
        if (place_[column] >= 0) return;
        place_[column] = static_cast<Index>(entries_.size());
        entries_.emplace_back(column, 0);
    }
    void add(Index column, double weight) {
        add(column);
        entries_[place_[column]].second += weight;
    }
    void add_row(const Stencils& rows, Index row, double weight) {
        for (std::size_t k = rows.offsets[row]; k < rows.offsets[row + 1]; ++k) add(rows.indices[k], weight * rows.weights[k]);
    }
    /// Appends the row, its columns in ascending order, and begins the next one.
    void end(Stencils& rows) {
        std::sort(entries_.begin(), entries_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
        for (const auto& [column, weight] : entries_) {
            rows.indices.push_back(column);
            rows.weights.push_back(weight);
            place_[column] = -1;
        }
        rows.offsets.push_back(rows.indices.size());
        entries_.clear();
    }

private:
    std::vector<Index> place_;  ///< of each column among the entries, -1 for none
    std::vector<std::pair<Index, double>> entries_;
};

/// Rows 0 .. row_count - 1 on all cores: fill(row, sum) adds one's entries.
template <class Fill>
Stencils make_rows(Index row_count, Index column_count, const Fill& fill) {
    const auto count = static_cast<std::size_t>(row_count);
    const std::size_t pieces = piece_count(count, smallest_piece);
    std::vector<Stencils> parts(pieces);
    for_each_piece(count, pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
        RowSum sum(column_count);
        for (std::size_t row = begin; row < end; ++row) {
            fill(static_cast<Index>(row), sum);
            sum.end(parts[piece]);
        }
    });
    Stencils all = std::move(parts.front());
    for (std::size_t piece = 1; piece < pieces; ++piece) {
        const Stencils part = std::move(parts[piece]);
        const std::size_t first = all.indices.size();
        for (std::size_t i = 1; i < part.offsets.size(); ++i) all.offsets.push_back(first + part.offsets[i]);
        all.indices.insert(all.indices.end(), part.indices.begin(), part.indices.end());
        all.weights.insert(all.weights.end(), part.weights.begin(), part.weights.end());
    }
    return all;
}

Index row_count(const Stencils& rows) { return static_cast<Index>(rows.offsets.size()) - 1; }

Stencils product(const Stencils& outer, const Stencils& inner, Index column_count) {
    return make_rows(row_count(outer), column_count, [&](Index row, RowSum& sum) {
        for (std::size_t k = outer.offsets[row]; k < outer.offsets[row + 1]; ++k) sum.add_row(inner, outer.indices[k], outer.weights[k]);
    });
}

Stencils rows_of(const RefinerStep& step) {
    const StepInput input{step.topology, step.features, step.options};
    const std::optional<DooSabinLayout> layout = layout_of(input);
    StencilRows rows(step.topology, static_cast<std::size_t>(step.vertex_count));
    write_all_rows(input, pointer_to(layout), rows);
    return rows.take();
}

/// The control points of patches, refined ones and ghosts, over the mesh's points.
Stencils control_rows(const PatchTable& table) {
    Stencils rows;
    for (const RefinerStep& step : table.refiner->steps()) rows = row_count(rows) == 0 ? rows_of(step) : product(rows_of(step), rows, table.point_count);
    const Stencils ghosts = product(table.ghosts, rows, table.point_count);
    const std::size_t first = rows.indices.size();
    for (std::size_t i = 1; i < ghosts.offsets.size(); ++i) rows.offsets.push_back(first + ghosts.offsets[i]);
    rows.indices.insert(rows.indices.end(), ghosts.indices.begin(), ghosts.indices.end());
    rows.weights.insert(rows.weights.end(), ghosts.weights.begin(), ghosts.weights.end());
    return rows;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> sums((a.size() + sum_block - 1) / sum_block);
    parallel_for_each(
        sums.size(),
        [&](std::size_t i) {
            const std::size_t begin = i * sum_block, size = std::min(sum_block, a.size() - begin);
            sums[i] = Eigen::Map<const Eigen::VectorXd>(&a[begin], size).dot(Eigen::Map<const Eigen::VectorXd>(&b[begin], size));
        },
        8);
    double sum = 0;
    for (const double part : sums) sum += part;
    return sum;
}

/// A symmetric matrix by its six values.
struct Metric {
    Eigen::Matrix<double, 1, FitSystem::block> values;  ///< xx, xy, xz, yy, yz, zz

    static Metric of(const Eigen::Matrix3d& m) { return {(Eigen::Matrix<double, 1, 6>() << m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2)).finished()}; }
    Eigen::Matrix3d matrix() const {
        return (Eigen::Matrix3d() << values[0], values[1], values[2], values[1], values[3], values[4], values[2], values[4], values[5]).finished();
    }
};

Metric metric_of(const FitSamples& samples, std::size_t i) {
    Eigen::Matrix3d metric = Eigen::Matrix3d::Identity();
    if (samples.normals != nullptr && !std::isnan(samples.normals[3 * i])) {
        const Eigen::Map<const Eigen::Vector3d> normal(samples.normals + 3 * i);
        metric = samples.along * metric + (1 - samples.along) * normal * normal.transpose();
    }
    return Metric::of(metric / static_cast<double>(samples.places.count));
}

/// to += the symmetric block times x.
void multiply_block(const double* values, const double* x, double* to) {
    to[0] += values[0] * x[0] + values[1] * x[1] + values[2] * x[2];
    to[1] += values[1] * x[0] + values[3] * x[1] + values[4] * x[2];
    to[2] += values[2] * x[0] + values[4] * x[1] + values[5] * x[2];
}

Eigen::Map<const Eigen::Vector3d> point_at(const std::vector<double>& points, Index i) {
    return Eigen::Map<const Eigen::Vector3d>(&points[3 * static_cast<std::size_t>(i)]);
}

SortedSamples sort_samples(const PatchTable& table, const Places& places) {
    SortedSamples samples;
    samples.places.resize(places.count);
    parallel_for(places.count, [&](std::size_t begin, std::size_t end) { locate(table, places, begin, end, &samples.places[begin]); });
    samples.starts.assign(static_cast<std::size_t>(table.patch_count()) + 1, 0);
    for (const PatchPlace& place : samples.places) ++samples.starts[place.patch + 1];
    for (Index patch = 0; patch < table.patch_count(); ++patch) {
        if (samples.starts[patch + 1] > 0) samples.patches.push_back(patch);
        samples.starts[patch + 1] += samples.starts[patch];
    }
    std::vector<std::size_t> next = samples.starts;
    samples.order.resize(places.count);
    for (std::size_t i = 0; i < places.count; ++i) samples.order[next[samples.places[i].patch]++] = i;
    return samples;
}

}  // namespace

/// What one patch adds to N (or E) and B.
struct FitSystem::LocalSystem {
    std::vector<Index> vertices;  ///< in ascending order
    MatrixXd normal;              ///< a column for each vertex, in it a block of numbers for each vertex
    Points right;                 ///< no rows: nothing
};

/// A patch's control points over the vertices that they depend on.
class FitSystem::LocalRows {
public:
    explicit LocalRows(const FitSystem& system) : system_(system), place_(static_cast<std::size_t>(system.table_.point_count), -1) {}

    const MatrixXd& transfer() const { return transfer_; }  ///< K x vertices

    void find_vertices(Index patch, std::vector<Index>& vertices) {
        vertices.clear();
        for_each_entry(patch, [&](Index, Index vertex, double) {
            if (place_[vertex] >= 0) return;
            place_[vertex] = 0;
            vertices.push_back(vertex);
        });
        std::sort(vertices.begin(), vertices.end());
        for (const Index vertex : vertices) place_[vertex] = -1;
    }

    void set(Index patch, std::vector<Index>& vertices) {
        find_vertices(patch, vertices);
        for (std::size_t j = 0; j < vertices.size(); ++j) place_[vertices[j]] = static_cast<Index>(j);
        transfer_.setZero(system_.patch_rows_.point_count(patch), static_cast<Index>(vertices.size()));
        for_each_entry(patch, [&](Index i, Index vertex, double weight) { transfer_(i, place_[vertex]) = weight; });
        for (const Index vertex : vertices) place_[vertex] = -1;
    }

private:
    template <class Visit>
    void for_each_entry(Index patch, const Visit& visit) const {
        const PatchTable& table = system_.table_;
        const Stencils& rows = system_.rows_;
        for (Index c = table.patch_begin[patch]; c < table.patch_begin[patch + 1]; ++c)
            for (std::size_t k = rows.offsets[table.control[c]]; k < rows.offsets[table.control[c] + 1]; ++k)
                visit(c - table.patch_begin[patch], rows.indices[k], rows.weights[k]);
    }

    const FitSystem& system_;
    std::vector<Index> place_;  ///< of vertices among those of the patch, -1 for none
    MatrixXd transfer_;
};

FitSystem::FitSystem(const PatchTable& table, double fair) : table_(table), patch_rows_(table), fair_(fair), rows_(control_rows(table)) {
    find_pattern();
    right_.resize(3 * static_cast<std::size_t>(table.point_count));
    if (fair > 0) set_energy();
}

/// Two vertices are coupled where they share a patch.
void FitSystem::find_pattern() {
    const auto patch_count = static_cast<std::size_t>(table_.patch_count());
    std::vector<std::vector<Index>> vertices_of(patch_count), patches_of(static_cast<std::size_t>(table_.point_count));
    for_each_piece(patch_count, piece_count(patch_count, smallest_piece), [&](std::size_t, std::size_t begin, std::size_t end) {
        LocalRows local(*this);
        for (std::size_t patch = begin; patch < end; ++patch) local.find_vertices(static_cast<Index>(patch), vertices_of[patch]);
    });
    for (std::size_t patch = 0; patch < patch_count; ++patch)
        for (const Index vertex : vertices_of[patch]) patches_of[vertex].push_back(static_cast<Index>(patch));
    pattern_ = make_rows(table_.point_count, table_.point_count, [&](Index vertex, RowSum& sum) {
        for (const Index patch : patches_of[vertex])
            for (const Index other : vertices_of[patch]) sum.add(other);
    });
    pattern_.weights = {};
}

/// Patches are squares (Loop: triangles) of side 2^-levels of an edge, so second derivatives by edges are 4^levels times those by patches.
void FitSystem::set_energy() {
    const double factor = std::ldexp(1.0, 4 * table_.levels()) / table_.patch_count();
    const MatrixXd regular = factor * regular_bending(table_.scheme);
    std::vector<MatrixXd> irregular;
    for (const PatchKind& kind : table_.kinds) irregular.push_back(factor * irregular_bending(table_.scheme, kind));
    std::vector<Index> patches(static_cast<std::size_t>(table_.patch_count()));
    for (std::size_t i = 0; i < patches.size(); ++i) patches[i] = static_cast<Index>(i);
    energy_.assign(pattern_.indices.size(), 0.0);
    const auto make = [&](Index patch, LocalRows& local, LocalSystem& out) {
        local.set(patch, out.vertices);
        const MatrixXd& bending = table_.kind[patch] < 0 ? regular : irregular[table_.kind[patch]];
        out.normal.noalias() = local.transfer().transpose() * (bending * local.transfer());
    };
    add(patches, make, 1, energy_);
}

void FitSystem::set_samples(const FitSamples& samples) {
    const SortedSamples sorted = sort_samples(table_, samples.places);
    normal_.assign(block * pattern_.indices.size(), 0.0);
    for (std::size_t k = 0; k < energy_.size(); ++k)
        for (const int diagonal : {0, 3, 5}) normal_[block * k + diagonal] = fair_ * energy_[k];
    right_.assign(3 * static_cast<std::size_t>(table_.point_count), 0.0);
    const auto make = [&](Index patch, LocalRows& local, LocalSystem& out) { add_samples(sorted, samples, patch, local, out); };
    add(sorted.patches, make, block, normal_);
}

void FitSystem::add_samples(const SortedSamples& sorted, const FitSamples& samples, Index patch, LocalRows& local, LocalSystem& out) const {
    local.set(patch, out.vertices);
    const auto size = static_cast<Index>(out.vertices.size());
    out.normal.setZero(block * size, size);
    out.right.setZero(size, 3);
    const Eigen::Vector3d origin(samples.origin[0], samples.origin[1], samples.origin[2]);
    Rows weights, rows, weighted;
    Points targets;
    for (std::size_t first = sorted.starts[patch]; first < sorted.starts[patch + 1]; first += sample_block) {
        const auto count = static_cast<Index>(std::min<std::size_t>(sample_block, sorted.starts[patch + 1] - first));
        weights.resize(count, patch_rows_.point_count(patch));
        for (Index i = 0; i < count; ++i) patch_rows_.write(sorted.places[sorted.order[first + i]], 1, weights.row(i).data());
        rows.noalias() = weights * local.transfer();
        weighted.resize(count, block * size);
        targets.resize(count, 3);
        for (Index i = 0; i < count; ++i) {
            const std::size_t sample = sorted.order[first + i];
            const Metric metric = metric_of(samples, sample);
            targets.row(i) = metric.matrix() * (Eigen::Map<const Eigen::Vector3d>(samples.points + 3 * sample) - origin);
            for (Index j = 0; j < size; ++j) weighted.row(i).segment<block>(block * j) = rows(i, j) * metric.values;
        }
        out.normal.noalias() += weighted.transpose() * rows;
        out.right.noalias() += rows.transpose() * targets;
    }
}

/// What patches add to N and B, in their order, so that sums do not depend on threads: block by block, first the patches' own matrices, then their sum.
template <class Make>
void FitSystem::add(const std::vector<Index>& patches, const Make& make, std::size_t size, std::vector<double>& values) {
    std::vector<LocalRows> workers;
    std::vector<LocalSystem> systems;
    for (std::size_t first = 0; first < patches.size(); first += systems.size()) {
        std::size_t count = 0, entries = 0;
        for (; first + count < patches.size() && entries < block_entries; ++count) {
            const auto points = static_cast<std::size_t>(patch_rows_.point_count(patches[first + count]));
            entries += size * points * points;
        }
        systems.resize(count);
        const std::size_t pieces = piece_count(count, smallest_piece);
        while (workers.size() < pieces) workers.emplace_back(*this);
        for_each_piece(count, pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) make(patches[first + i], workers[piece], systems[i]);
        });
        scatter(systems, size, values);
    }
}

/// Each thread has its own rows of N and goes through all systems.
void FitSystem::scatter(const std::vector<LocalSystem>& systems, std::size_t size, std::vector<double>& values) {
    const auto add_row = [&](const LocalSystem& local, Index i) {
        const Index row = local.vertices[i];
        const double* from = local.normal.col(i).data();
        std::size_t to = pattern_.offsets[row];
        for (const Index vertex : local.vertices) {
            while (pattern_.indices[to] != vertex) ++to;
            for (std::size_t c = 0; c < size; ++c) values[size * to + c] += *from++;
        }
        for (Index c = 0; c < 3 && local.right.rows() > 0; ++c) right_[3 * static_cast<std::size_t>(row) + c] += local.right(i, c);
    };
    parallel_for(
        static_cast<std::size_t>(table_.point_count),
        [&](std::size_t begin, std::size_t end) {
            for (const LocalSystem& local : systems) {
                auto at = std::lower_bound(local.vertices.begin(), local.vertices.end(), static_cast<Index>(begin));
                for (; at != local.vertices.end() && *at < static_cast<Index>(end); ++at) add_row(local, static_cast<Index>(at - local.vertices.begin()));
            }
        },
        smallest_piece);
}

void FitSystem::multiply(const std::vector<double>& x, std::vector<double>& y) const {
    y.resize(x.size());
    parallel_for_each(
        table_.point_count,
        [&](Index row) {
            double sum[3] = {0, 0, 0};
            for (std::size_t k = pattern_.offsets[row]; k < pattern_.offsets[row + 1]; ++k)
                multiply_block(&normal_[block * k], &x[3 * static_cast<std::size_t>(pattern_.indices[k])], sum);
            std::copy_n(sum, 3, &y[3 * static_cast<std::size_t>(row)]);
        },
        smallest_parallel_piece / 32);
}

/// Of each row's diagonal block; zeros where there is nothing.
std::vector<double> FitSystem::inverse_diagonal() const {
    std::vector<double> inverse(block * static_cast<std::size_t>(table_.point_count), 0.0);
    parallel_for_each(table_.point_count, [&](Index row) {
        const auto begin = pattern_.indices.begin() + static_cast<std::ptrdiff_t>(pattern_.offsets[row]),
                   end = pattern_.indices.begin() + static_cast<std::ptrdiff_t>(pattern_.offsets[row + 1]), at = std::lower_bound(begin, end, row);
        if (at == end) return;  // isolated
        const Metric diagonal{Eigen::Map<const Eigen::Matrix<double, 1, block>>(&normal_[block * static_cast<std::size_t>(at - pattern_.indices.begin())])};
        Eigen::Matrix3d matrix = diagonal.matrix();
        if (!(matrix.trace() > 0)) return;
        matrix += smallest_part * matrix.trace() * Eigen::Matrix3d::Identity();
        const Metric result = Metric::of(matrix.inverse());
        std::copy_n(result.values.data(), block, &inverse[block * static_cast<std::size_t>(row)]);
    });
    return inverse;
}

int FitSystem::solve(std::vector<double>& control, double tolerance, int most_iterations) const {
    const std::vector<double> inverse = inverse_diagonal();
    std::vector<double> residual, conditioned(control.size()), direction(control.size(), 0.0), product;
    multiply(control, residual);
    for (std::size_t i = 0; i < residual.size(); ++i) residual[i] = right_[i] - residual[i];
    double first = -1, before = 0;
    for (int iteration = 0;; ++iteration) {
        std::fill(conditioned.begin(), conditioned.end(), 0.0);
        for (std::size_t v = 0; 3 * v < residual.size(); ++v) multiply_block(&inverse[block * v], &residual[3 * v], &conditioned[3 * v]);
        const double now = dot(residual, conditioned);
        if (first < 0) first = now;
        if (iteration == most_iterations || !(now > tolerance * tolerance * first)) return iteration;
        for (std::size_t i = 0; i < residual.size(); ++i) direction[i] = conditioned[i] + (iteration > 0 ? now / before : 0) * direction[i];
        before = now;
        multiply(direction, product);
        const double curvature = dot(direction, product);
        if (!(curvature > 0)) return iteration;  // rounding: what is left lies in the null space
        for (std::size_t i = 0; i < residual.size(); ++i) {
            control[i] += now / curvature * direction[i];
            residual[i] -= now / curvature * product[i];
        }
    }
}

double FitSystem::energy(const std::vector<double>& control) const {
    double sum = 0;
    for (Index row = 0; !energy_.empty() && row < table_.point_count; ++row)
        for (std::size_t k = pattern_.offsets[row]; k < pattern_.offsets[row + 1]; ++k)
            sum += energy_[k] * point_at(control, row).dot(point_at(control, pattern_.indices[k]));
    return sum;
}

}  // namespace lcl
