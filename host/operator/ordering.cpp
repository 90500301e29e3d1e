// SPDX-License-Identifier: BSD-3-Clause
#include "host/operator/ordering.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "host/mesh/box.h"
#include "host/mesh/face_walk.h"
#include "host/prefetch.h"

namespace lcl {
namespace {

constexpr std::size_t sample_size = 4096;  // vertices of which the middle is taken

/// Cuts the vertices into those before and those behind a plane across the longest axis of the mesh, about half of them each.
class Cut {
public:
    Cut(const Topology& topology, const std::vector<double>& positions) : positions_(positions) {
        const Box box =
            box_of_points(positions, topology.vertex_count, [&](std::size_t v) { return topology.vertex_half_edge[v] < 0 ? -1 : static_cast<Index>(v); });
        for (int axis = 1; axis < 3; ++axis)
            if (box.extent(axis) > box.extent(axis_)) axis_ = axis;
        const std::size_t step = std::max<std::size_t>(1, topology.vertex_count / sample_size);
        std::vector<double> sample;
        for (std::size_t v = 0; v < static_cast<std::size_t>(topology.vertex_count); v += step)
            if (topology.vertex_half_edge[v] >= 0) sample.push_back(positions[3 * v + axis_]);
        if (sample.empty()) return;
        const auto middle = sample.begin() + static_cast<std::ptrdiff_t>(sample.size() / 2);
        std::nth_element(sample.begin(), middle, sample.end());
        plane_ = *middle;
    }

    bool is_behind(Index v) const { return positions_[3 * static_cast<std::size_t>(v) + axis_] >= plane_; }

private:
    const std::vector<double>& positions_;
    int axis_ = 0;
    double plane_ = 0;
};

/// What searches have met, a byte each.
struct Marks {
    std::vector<std::uint8_t> vertices, faces;
};

/// The vertices of a search in the order in which they are met. Several may share marks as long as they meet different vertices and faces: what one of them
/// writes, the others do not look at.
template <class Walk>
class Search {
public:
    Search(const Walk& walk, const Topology& topology, Marks& is_met)
        : walk_(walk), topology_(topology), is_met_(is_met), order_(topology.vertex_count + std::size_t{1}) {}

    void meet(Index v) {
        std::uint8_t& is_met = is_met_.vertices[v];
        const bool is_new = is_met == 0;
        order_[met_] = v;  // overwritten by the next one where this one is not new: no branch that nobody could predict
        met_ += is_new;
        *(is_new ? &is_met : &unused_) = 1;
    }

    /// Meets the vertices of all faces round those that were met, and so on.
    void spread() {
        for (; next_ < met_; ++next_) {
            look_ahead();
            for_each_new_vertex(order_[next_], [&](Index v) { meet(v); });
        }
    }

    /// visit(vertex) for the other vertices of all faces at v that were not met before.
    template <class Visit>
    void for_each_new_vertex(Index v, const Visit& visit) {
        for (Index i = topology_.fan_offsets[v]; i < topology_.fan_offsets[v + 1]; ++i) {
            const Index own = topology_.fan_half_edges[i];
            std::uint8_t& is_met = is_met_.faces[walk_.face(own)];
            if (is_met) continue;
            is_met = 1;
            for (Index corner = walk_.next(own); corner != own; corner = walk_.next(corner)) visit(topology_.face_vertices[corner]);
        }
    }

    const Index* begin() const { return order_.data(); }
    const Index* end() const { return order_.data() + met_; }

private:
    /// Starts to load what vertices further on in the queue need: each array's place is known from the one before it.
    void look_ahead() const {
        const auto vertex_ahead = [&](Index vertices) { return order_[std::min(next_ + vertices, met_ - 1)]; };
        prefetch(&topology_.fan_offsets[vertex_ahead(32)]);
        prefetch(topology_.fan_half_edges.data() + topology_.fan_offsets[vertex_ahead(20)]);
        const Index v = vertex_ahead(8);
        for (Index i = topology_.fan_offsets[v]; i < topology_.fan_offsets[v + 1]; ++i) prefetch(&topology_.face_vertices[topology_.fan_half_edges[i]]);
    }

    const Walk& walk_;
    const Topology& topology_;
    Marks& is_met_;
    Array<Index> order_;  // one longer than the mesh, for meet() to write to
    Index met_ = 0, next_ = 0;
    std::uint8_t unused_ = 0;
};

/// Faces with vertices on both sides, in their order.
std::vector<Index> faces_across(const Topology& topology, const std::vector<std::uint8_t>& is_behind) {
    const std::size_t pieces = piece_count(topology.face_count);
    std::vector<std::vector<Index>> found(pieces);
    for_each_piece(topology.face_count, pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) {
            Index behind = 0;
            for (Index c = topology.face_offsets[f]; c < topology.face_offsets[f + 1]; ++c) behind += is_behind[topology.face_vertices[c]];
            if (behind > 0 && behind < topology.degree(static_cast<Index>(f))) found[piece].push_back(static_cast<Index>(f));
        }
    });
    std::vector<Index> faces;
    for (const std::vector<Index>& piece : found) faces.insert(faces.end(), piece.begin(), piece.end());
    return faces;
}

/// Breadth-first levels counted from the cut to both sides at once.
template <class Walk>
class TwoSidedOrder {
public:
    TwoSidedOrder(const Walk& walk, const Topology& topology, const std::vector<double>& positions)
        : topology_(topology),
          is_behind_(topology.vertex_count),
          is_first_(topology.vertex_count, 0),
          is_met_{std::vector<std::uint8_t>(topology.vertex_count, 0), std::vector<std::uint8_t>(topology.face_count, 0)},
          first_(walk, topology, is_met_),
          before_(walk, topology, is_met_),
          behind_(walk, topology, is_met_) {
        const Cut cut(topology, positions);
        parallel_for(topology.vertex_count, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) is_behind_[v] = cut.is_behind(static_cast<Index>(v));
        });
    }

    Array<Index> run() {
        find_first_level();
        for (const Index v : first_) first_.for_each_new_vertex(v, [&](Index other) { (is_behind_[other] ? behind_ : before_).meet(other); });
        // Faces across have all been met, so from here on each side keeps to vertices and faces of its own, but for vertices that both know as met.
        for_each_piece(2, 2, [&](std::size_t side, std::size_t, std::size_t) { (side == 0 ? before_ : behind_).spread(); });
        for (Index v = 0; v < topology_.vertex_count; ++v) {  // components on one side alone
            if (is_met_.vertices[v] || topology_.is_isolated(v)) continue;
            behind_.meet(v);
            behind_.spread();
        }
        return join();
    }

private:
    /// The vertices behind the cut that have a face with vertices before it, one after the other along the cut.
    void find_first_level() {
        std::vector<Index> seeds, open;
        for (const Index f : faces_across(topology_, is_behind_))
            for (Index c = topology_.face_offsets[f]; c < topology_.face_offsets[f + 1]; ++c) {
                const Index v = topology_.face_vertices[c];
                if (!is_behind_[v]) continue;
                is_first_[v] = 1;
                seeds.push_back(v);
            }
        for (const Index seed : seeds)
            for (open.assign(1, seed); !open.empty();) {
                const Index v = open.back();
                open.pop_back();
                if (is_met_.vertices[v]) continue;
                first_.meet(v);
                add_neighbours_on_first_level(v, open);
            }
    }

    void add_neighbours_on_first_level(Index v, std::vector<Index>& out) const {
        for (Index i = topology_.fan_offsets[v]; i < topology_.fan_offsets[v + 1]; ++i) {
            const Index face = topology_.half_edge_face[topology_.fan_half_edges[i]];
            for (Index c = topology_.face_offsets[face]; c < topology_.face_offsets[face + 1]; ++c) {
                const Index other = topology_.face_vertices[c];
                if (is_first_[other] && !is_met_.vertices[other]) out.push_back(other);
            }
        }
    }

    Array<Index> join() const {
        Array<Index> order(topology_.vertex_count);
        auto place = std::reverse_copy(before_.begin(), before_.end(), order.begin());
        place = std::copy(first_.begin(), first_.end(), place);
        place = std::copy(behind_.begin(), behind_.end(), place);
        for (Index v = 0; v < topology_.vertex_count && place != order.end(); ++v)
            if (topology_.is_isolated(v)) *place++ = v;
        return order;
    }

    const Topology& topology_;
    std::vector<std::uint8_t> is_behind_, is_first_;
    Marks is_met_;
    Search<Walk> first_, before_, behind_;
};

}  // namespace

Array<Index> breadth_first_order(const Topology& topology, const std::vector<double>& positions) {
    if (topology.vertex_count == 0) return {};
    return with_face_walk(topology, [&](const auto& walk) { return TwoSidedOrder<std::decay_t<decltype(walk)>>(walk, topology, positions).run(); });
}

}  // namespace lcl
