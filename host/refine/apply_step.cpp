// SPDX-License-Identifier: BSD-3-Clause
// Values of one refinement step in double on all cores. Every refined row is written by one thread from rows of the step before: the same bits on every run.
#include <algorithm>

#include "host/mesh/face_walk.h"
#include "host/parallel.h"
#include "host/refine/refiner.h"
#include "host/refine/steps.h"
#include "host/scheme/masks.h"

namespace lcl {
namespace {

/// `channels` neighbouring values of every row.
template <class T>
struct Table {
    T* values;
    std::size_t stride;
    T* operator[](Index row) const { return values + static_cast<std::size_t>(row) * stride; }
};

template <int channels>
struct Sum {
    double values[channels] = {};
    void add(const double* row) {
        for (int c = 0; c < channels; ++c) values[c] += row[c];
    }
    void add(const double* row, double weight) {
        for (int c = 0; c < channels; ++c) values[c] += weight * row[c];
    }
    void add(const Sum& other, double weight) { add(other.values, weight); }
    void store(double* row, double weight = 1) const {
        for (int c = 0; c < channels; ++c) row[c] = weight * values[c];
    }
};

template <int channels>
class StepValues {
public:
    StepValues(const RefinerStep& step, Table<const double> in, Table<double> out) : step_(step), topology_(step.topology), in_(in), out_(out) {}

    void run() const {
        if (step_.bulk == BulkRule::loop) loop();
        else if (step_.bulk == BulkRule::catmull_clark) with_face_walk(topology_, [&](const auto& walk) { catmull_clark(walk); });
        sparse_rows();
    }

private:
    template <class Walk>
    void catmull_clark(const Walk& walk) const {
        const Table<double> face_points{out_[topology_.vertex_count + topology_.edge_count], out_.stride};
        parallel_for_each(topology_.face_count, [&](Index f) {
            Sum<channels> sum;
            for (Index h = topology_.face_offsets[f]; h < topology_.face_offsets[f + 1]; ++h) sum.add(in_[topology_.face_vertices[h]]);
            sum.store(face_points[f], 1.0 / topology_.degree(f));
        });
        // The mean of the ends and of the two face points.
        parallel_for_each(topology_.edge_count, [&](Index e) {
            const Index h = topology_.edge_half_edge[e], t = topology_.twin[h];
            if (step_.features.edge_is_sharp[e]) return;
            Sum<channels> sum;
            sum.add(in_[topology_.face_vertices[h]]);
            sum.add(in_[topology_.face_vertices[t]]);
            sum.add(face_points[walk.face(h)]);
            sum.add(face_points[walk.face(t)]);
            sum.store(out_[topology_.vertex_count + e], 0.25);
        });
        // (n - 2 + alpha)/n V + (1 - alpha)/n^2 sum E_j + 1/n^2 sum f_j  (mesh expansion paper, appendix A)
        const double alpha = step_.options.alpha;
        parallel_for_each(topology_.vertex_count, [&](Index v) {
            if (!has_smooth_rule(step_.features.kind[v])) return;
            const double n = topology_.vertex_face_count[v];
            Sum<channels> ends, faces, sum;
            for (Index i = topology_.fan_offsets[v]; i < topology_.fan_offsets[v + 1]; ++i) {
                const Index h = topology_.fan_half_edges[i];
                ends.add(in_[topology_.face_vertices[walk.next(h)]]);
                faces.add(face_points[walk.face(h)]);
            }
            sum.add(in_[v], (n - 2 + alpha) / n);
            sum.add(ends, (1 - alpha) / (n * n));
            sum.add(faces, 1 / (n * n));
            sum.store(out_[v]);
        });
    }

    void loop() const {
        const TriangleWalk walk;
        // 3/8 of the ends, 1/8 of the vertices across.
        parallel_for_each(topology_.edge_count, [&](Index e) {
            const Index h = topology_.edge_half_edge[e], t = topology_.twin[h];
            if (step_.features.edge_is_sharp[e]) return;
            Sum<channels> ends, across;
            ends.add(in_[topology_.face_vertices[h]]);
            ends.add(in_[topology_.face_vertices[t]]);
            across.add(in_[topology_.face_vertices[walk.previous(h)]]);
            across.add(in_[topology_.face_vertices[walk.previous(t)]]);
            ends.add(across, 1.0 / 3);
            ends.store(out_[topology_.vertex_count + e], 3.0 / 8);
        });
        // (1 - n beta) V + beta sum E_j  (Loop PIA paper)
        parallel_for_each(topology_.vertex_count, [&](Index v) {
            if (!has_smooth_rule(step_.features.kind[v])) return;
            const Index n = topology_.vertex_face_count[v];
            const double beta = betas_.of(n);
            Sum<channels> ends, sum;
            for (Index i = topology_.fan_offsets[v]; i < topology_.fan_offsets[v + 1]; ++i)
                ends.add(in_[topology_.face_vertices[walk.next(topology_.fan_half_edges[i])]]);
            sum.add(in_[v], 1 - n * beta);
            sum.add(ends, beta);
            sum.store(out_[v]);
        });
    }

    void sparse_rows() const {
        const SparseRows& rows = step_.rows;
        Array<double> sums(static_cast<std::size_t>(rows.sum_count()) * channels);
        const Table<double> sum_rows{sums.data(), channels};
        const auto row_of = [](const Stencils& stencils, Index i, const auto& value_of) {
            Sum<channels> sum;
            for (std::size_t k = stencils.offsets[i]; k < stencils.offsets[i + 1]; ++k) sum.add(value_of(stencils.indices[k]), stencils.weights[k]);
            return sum;
        };
        parallel_for_each(rows.sum_count(), [&](Index i) { row_of(rows.sums, i, [&](Index v) { return in_[v]; }).store(sum_rows[i]); });
        const Index old_count = topology_.vertex_count;
        const auto value_of = [&](Index v) -> const double* { return v < old_count ? in_[v] : sum_rows[v - old_count]; };
        parallel_for_each(rows.row_count(), [&](Index i) { row_of(rows.rows, i, value_of).store(out_[rows.targets.empty() ? i : rows.targets[i]]); });
    }

    /// Loop's beta of the valences that are common.
    struct Betas {
        static constexpr Index count = 16;
        double values[count];
        Betas() {
            for (Index n = 0; n < count; ++n) values[n] = n > 1 ? loop_refined_edge_weight(n) : 0;
        }
        double of(Index n) const { return n < count ? values[n] : loop_refined_edge_weight(n); }
    };

    const RefinerStep& step_;
    const Topology& topology_;
    Table<const double> in_;
    Table<double> out_;
    Betas betas_;
};

}  // namespace

void apply_step(const RefinerStep& step, const double* values, std::size_t stride, int channels, double* out, std::size_t out_stride) {
    for (int first = 0; first < channels; first += 4) {
        const Table<const double> from{values + first, stride};
        const Table<double> to{out + first, out_stride};
        switch (std::min(4, channels - first)) {
            case 1: StepValues<1>(step, from, to).run(); break;
            case 2: StepValues<2>(step, from, to).run(); break;
            case 3: StepValues<3>(step, from, to).run(); break;
            default: StepValues<4>(step, from, to).run(); break;
        }
    }
}

}  // namespace lcl
