// SPDX-License-Identifier: BSD-3-Clause
#include "host/operator/tangent_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "host/operator/tangent_rows.h"
#include "host/parallel.h"

namespace lcl {
namespace {

constexpr std::size_t smallest_piece = 2048;  // stored rows

class Builder {
public:
    Builder(const Plan& plan, const Topology& topology, const Features& features, const SchemeOptions& options)
        : plan_(plan), topology_(topology), features_(features), options_(options) {}

    TangentPlan build() {
        if (topology_.vertex_count != plan_.vertex_count)
            throw InvalidArgument("the operator has " + std::to_string(plan_.vertex_count) + " vertices, the mesh " + std::to_string(topology_.vertex_count));
        for (const Run& run : plan_.runs) add_run(run);
        check_rings();
        std::stable_partition(out_.rows.begin(), out_.rows.end(), [&](Index row) { return has_sides(plan_.vertex_of_row[row]); });
        add_stored_rows();
        return std::move(out_);
    }

private:
    bool is_ring(const Run& run) const { return run.first >= plan_.smooth.first_row && run.shape != RowShape::weighted && run.edges > 2; }

    void add_run(const Run& run) {
        if (!is_ring(run)) {
            out_.run_turns.push_back(-1);
            for (Index row = run.first; row < run.first + run.count; ++row) out_.rows.push_back(row);
            return;
        }
        const auto [known, is_new] = turns_.emplace(std::make_pair(run.shape, run.edges), static_cast<std::int32_t>(out_.turns.size()));
        out_.run_turns.push_back(known->second);
        if (!is_new) return;
        std::vector<double> weights = ring_tangent_weights(options_, run.edges, run.shape == RowShape::full_ring);
        double size = 0;
        for (const double weight : weights) size += std::fabs(weight) / 2;
        for (double& weight : weights) weight *= tangent_scale / size;
        out_.turns.insert(out_.turns.end(), weights.begin(), weights.end());
    }

    /// A mesh other than the operator's would give normals of neither.
    void check_rings() const {
        const auto check = [&](std::size_t r) {
            if (out_.run_turns[r] >= 0) check_run(plan_.runs[r]);
        };
        parallel_for_each(plan_.runs.size(), check, 16);
    }

    void check_run(const Run& run) const {
        for (Index row = run.first; row < run.first + run.count; ++row) {
            const Index v = plan_.vertex_of_row[row];
            const Index first = plan_.indices[run.index_offset + static_cast<std::size_t>(row - run.first) * run.stride()];
            if (features_.kind[v] != VertexKind::smooth || topology_.vertex_face_count[v] != run.edges ||
                topology_.destination(topology_.vertex_half_edge[v]) != plan_.vertex_of_row[first])
                throw InvalidArgument(
                    "the mesh is not the one that the operator was made of: at vertex " + std::to_string(v) + " its faces or sharp features are others",
                    {{v}, {}});
        }
    }

    bool has_sides(Index v) const {
        if (features_.kind[v] != VertexKind::corner && (features_.kind[v] != VertexKind::curve || topology_.is_boundary(v))) return false;
        std::vector<TangentSector> sectors;
        TangentRows(topology_, features_, options_).sectors(v, sectors);
        return sectors.size() > 1;
    }

    /// Stencils of consecutive stored rows.
    struct StoredRows {
        std::vector<std::uint32_t> sector_counts, entry_counts;  // of each row, of each sector
        std::vector<Index> columns, side_vertices, side_faces;
        std::vector<double> weights;
    };

    void add_stored_rows() {
        const std::size_t pieces = piece_count(out_.rows.size(), smallest_piece);
        std::vector<StoredRows> parts(pieces);
        for_each_piece(out_.rows.size(), pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
            TangentRows rows(topology_, features_, options_);
            for (std::size_t i = begin; i < end; ++i) add_stored_row(plan_.vertex_of_row[out_.rows[i]], rows, parts[piece]);
        });
        std::size_t entries = 0;
        for (const StoredRows& part : parts) entries += part.columns.size();
        if (entries > std::numeric_limits<std::uint32_t>::max())
            throw OutOfMemory("the tangent stencils of this mesh have " + std::to_string(entries) +
                              " entries, 4294967295 are the most: split the mesh into parts");
        out_.columns.reserve(entries);
        out_.weights.reserve(3 * entries);
        for (StoredRows& part : parts) append(std::exchange(part, {}));
    }

    void add_stored_row(Index v, TangentRows& rows, StoredRows& out) const {
        std::vector<TangentSector> sectors;
        rows.sectors(v, sectors);
        out.sector_counts.push_back(static_cast<std::uint32_t>(sectors.size()));
        TangentRow row;
        for (const TangentSector& sector : sectors) {
            rows.row(v, sector, row);
            out.entry_counts.push_back(static_cast<std::uint32_t>(row.entries.size()));
            for (const TangentRow::Entry& entry : row.entries) {
                out.columns.push_back(plan_.row_of_vertex[entry.column]);
                out.weights.insert(out.weights.end(), entry.weights.begin(), entry.weights.end());
            }
            if (sectors.size() < 2) continue;
            out.side_vertices.push_back(v);
            out.side_faces.push_back(topology_.half_edge_face[sector.first]);
        }
    }

    void append(const StoredRows& part) {
        for (const std::uint32_t count : part.sector_counts) out_.sector_offsets.push_back(out_.sector_offsets.back() + count);
        for (const std::uint32_t count : part.entry_counts) out_.entry_offsets.push_back(out_.entry_offsets.back() + count);
        const auto add = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
        add(out_.columns, part.columns);
        add(out_.weights, part.weights);
        add(out_.side_vertices, part.side_vertices);
        add(out_.side_faces, part.side_faces);
    }

    const Plan& plan_;
    const Topology& topology_;
    const Features& features_;
    const SchemeOptions& options_;
    std::map<std::pair<RowShape, int>, std::int32_t> turns_;
    TangentPlan out_;
};

}  // namespace

TangentPlan build_tangent_plan(const Plan& plan, const Topology& topology, const Features& features, const SchemeOptions& options) {
    return Builder(plan, topology, features, options).build();
}

}  // namespace lcl
