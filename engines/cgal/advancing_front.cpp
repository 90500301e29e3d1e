// SPDX-License-Identifier: GPL-3.0-or-later
// The engine "advancing-front": a Delaunay tetrahedrisation of the points, and a surface that grows in it one triangle at a time, the most plausible first
// (Cohen-Steiner & Da 2004; the Doo-Sabin paper's own way to its approximations). Its vertices are the points as they are.
#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_3.h>
#include <CGAL/Unique_hash_map.h>
#include <CGAL/compute_average_spacing.h>
#include <CGAL/jet_smooth_point_set.h>
#include <CGAL/property_map.h>
#include <CGAL/remove_outliers.h>
#include <CGAL/spatial_sort.h>
#include <CGAL/version.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include "engines/engine_call.h"

namespace {

using limitcl_engine::Call;
using limitcl_engine::Failure;
using limitcl_engine::Frame;
using limitcl_engine::Kind;
using limitcl_engine::no_limit;
using limitcl_engine::Option;
using limitcl_engine::Triangle;

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using VertexBase = CGAL::Advancing_front_surface_reconstruction_vertex_base_3<Kernel>;
using CellBase = CGAL::Advancing_front_surface_reconstruction_cell_base_3<Kernel>;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;
namespace names = CGAL::parameters;

// CGAL's radius_ratio_bound is left out: version 5.5 puts another value in its place before it looks at it.
const Option options[] = {
    {"beta", "0.52", Kind::number, 0.0, 1.57, "radians; a triangle that folds by less than this competes by the radius of its Delaunay sphere alone"},
    {"perimeter-bound", "0", Kind::number, 0.0, no_limit, "no triangle has a larger perimeter than this, model units (0: any)"},
    {"outlier-percent", "0", Kind::number, 0.0, 99.0, "of the points are left out: those farthest from their neighbours"},
    {"outlier-distance", "0", Kind::number, 0.0, no_limit,
     "leave out only points whose neighbours are so many times farther away than is usual (0: as `outlier-percent` says alone)"},
    {"outlier-neighbours", "24", Kind::whole, 2.0, 1000.0, "how many neighbours that looks at"},
    {"smooth", "0", Kind::zero_or_whole, 6.0, 1000.0,
     "against noise: each point moves to a quadric through so many neighbours (0: none); distances are then to the points as they were"}};

/// Shares of the whole time, roughly, for the progress: measured on clouds of 100k points.
struct Share {
    double begin, size;
};
constexpr Share outlier_share = {0.0, 0.1}, smooth_share = {0.1, 0.3}, delaunay_share = {0.4, 0.2}, front_share = {0.6, 0.4};

void report(const Call& call, Share share, double fraction) { call.progress(share.begin + share.size * std::min(fraction, 1.0)); }

auto callback(const Call& call, Share share) {
    return names::callback([&call, share, count = 0](double fraction) mutable {
        if (++count % 1024 == 0) report(call, share, fraction);
        return true;
    });
}

/// Takes outliers away from `kept`, indices into `points`, and reports them.
void remove_outliers(const Call& call, const std::vector<Point>& points, std::vector<std::size_t>& kept) {
    double percent = call.options.number("outlier-percent");
    const double distance = call.options.number("outlier-distance");
    if (percent == 0.0 && distance == 0.0) return;
    if (percent == 0.0) percent = 100.0;
    const auto neighbours = static_cast<unsigned>(std::min<std::size_t>(call.options.whole("outlier-neighbours"), kept.size() - 1));
    const auto map = names::point_map(CGAL::make_property_map(points));
    const double usual = distance > 0.0 ? CGAL::compute_average_spacing<CGAL::Sequential_tag>(kept, neighbours, map) : 0.0;
    const auto first = CGAL::remove_outliers<CGAL::Sequential_tag>(
        kept, neighbours,
        callback(call, outlier_share).point_map(CGAL::make_property_map(points)).threshold_percent(percent).threshold_distance(distance * usual));
    std::vector<std::int32_t> outliers(first, kept.end());
    std::sort(outliers.begin(), outliers.end());
    call.leave_out(outliers);
    kept.erase(first, kept.end());
    std::sort(kept.begin(), kept.end());
    if (kept.size() < 4)
        throw Failure{LCL_ENGINE_OPTION, "the engine's options leave " + std::to_string(kept.size()) +
                                             " points after the outliers: " + (distance > 0.0 ? "raise `outlier-distance`" : "lower `outlier-percent`")};
}

/// Moves the points of `kept`; returns whether it did.
bool smooth(const Call& call, std::vector<Point>& points, const std::vector<std::size_t>& kept) {
    const int neighbours = call.options.whole("smooth");
    if (neighbours == 0) return false;
    if (kept.size() < 7) throw Failure{LCL_ENGINE_OPTION, "the engine's option smooth takes 7 points or more"};
    std::vector<Point> moved;
    for (const std::size_t index : kept) moved.push_back(points[index]);
    CGAL::jet_smooth_point_set<CGAL::Sequential_tag>(moved, std::min<unsigned>(neighbours, static_cast<unsigned>(kept.size() - 1)),
                                                     callback(call, smooth_share));
    for (std::size_t i = 0; i < kept.size(); ++i) points[kept[i]] = moved[i];
    return true;
}

/// A number in [0, 1) that hangs on this one alone (splitmix64).
double scattered(std::uint64_t value) {
    value += 0x9e3779b97f4a7c15u;
    value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9u;
    value = (value ^ (value >> 27)) * 0x94d049bb133111ebu;
    return std::ldexp(static_cast<double>((value ^ (value >> 31)) >> 11), -53);
}

/// The point moved by less than 2e-9 of a spacing. Grids and planes are full of equal radii and angles, which CGAL takes in the order of addresses, another one
/// in every run; and of points on one plane or sphere, which cost it twice the time.
Point disturbed(const Point& point, std::size_t index) {
    const auto by = [index](std::uint64_t axis) { return 1e-9 * scattered(3 * std::uint64_t(index) + axis); };
    return {point.x() + by(0), point.y() + by(1), point.z() + by(2)};
}

/// The tetrahedra, whose vertices carry the indices of their points. Inserted along a curve through space, so that each point is near the one before.
Delaunay triangulate(const Call& call, const std::vector<Point>& points, std::vector<std::size_t> order) {
    using Traits = CGAL::Spatial_sort_traits_adapter_3<Kernel, CGAL::Pointer_property_map<Point>::const_type>;
    CGAL::spatial_sort(order.begin(), order.end(), Traits(CGAL::make_property_map(points)));
    Delaunay delaunay;
    Delaunay::Vertex_handle last;
    for (std::size_t done = 0; done < order.size(); ++done) {
        if (done % 4096 == 0) report(call, delaunay_share, static_cast<double>(done) / static_cast<double>(order.size()));
        const Point point = disturbed(points[order[done]], order[done]);
        last = delaunay.insert(point, last == Delaunay::Vertex_handle() ? Delaunay::Cell_handle() : last->cell());
        last->id() = order[done];
    }
    return delaunay;
}

/// How soon a triangle may be taken: CGAL's own measure, without those that are too large. The front asks for it all the time, so it also tells the progress.
class Priority {
public:
    Priority(const Call& call, double perimeter_bound, std::size_t point_count) : call_(&call), perimeter_bound_(perimeter_bound), point_count_(point_count) {}

    template <typename Front, typename Cell>
    double operator()(const Front& front, Cell& cell, int index) const {
        if (++asked_ % 16384 == 0) report(*call_, front_share, front.number_of_facets() / (2.0 * static_cast<double>(point_count_)));
        const Point &a = cell->vertex((index + 1) & 3)->point(), &b = cell->vertex((index + 2) & 3)->point(), &c = cell->vertex((index + 3) & 3)->point();
        if (perimeter_bound_ > 0.0 && perimeter(a, b, c) > perimeter_bound_) return front.infinity();
        return front.smallest_radius_delaunay_sphere(cell, index);
    }

private:
    static double perimeter(const Point& a, const Point& b, const Point& c) {
        return std::sqrt(CGAL::squared_distance(a, b)) + std::sqrt(CGAL::squared_distance(b, c)) + std::sqrt(CGAL::squared_distance(c, a));
    }

    const Call* call_;
    double perimeter_bound_;
    std::size_t point_count_;
    mutable std::uint64_t asked_ = 0;
};

/// A triangle from its least corner on, and the number of the part of the surface that it is in.
struct Face {
    Triangle corners;
    int part;

    /// The same for both orientations.
    Triangle key() const { return {corners[0], std::min(corners[1], corners[2]), std::max(corners[1], corners[2])}; }
    bool operator<(const Face& other) const { return key() < other.key(); }
};

/// CGAL has the triangles in the order of addresses: here they come by their corners. Parts hang together over edges.
template <typename Surface>
std::vector<Face> faces_of(const Surface& surface) {
    using Handle = typename Surface::Face_handle;
    std::vector<Face> faces;
    CGAL::Unique_hash_map<Handle, int> parts(-1);
    int part_count = 0;
    std::vector<Handle> pending;
    for (auto first = surface.faces_begin(); first != surface.faces_end(); ++first) {
        if (!first->is_on_surface() || parts[first] >= 0) continue;
        parts[first] = part_count;
        for (pending = {first}; !pending.empty();) {
            const Handle face = pending.back();
            pending.pop_back();
            Triangle triangle;
            for (int corner = 0; corner < 3; ++corner) triangle[corner] = static_cast<std::int32_t>(face->vertex(corner)->vertex_3()->id());
            std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
            faces.push_back({triangle, part_count});
            for (int side = 0; side < 3; ++side) {
                const Handle next = face->neighbor(side);
                if (!next->is_on_surface() || parts[next] >= 0) continue;
                parts[next] = part_count;
                pending.push_back(next);
            }
        }
        ++part_count;
    }
    std::sort(faces.begin(), faces.end());
    return faces;
}

/// Turns each part so that the volume between its triangles and its middle is positive: closed ones outwards. The library leaves it to chance.
std::vector<Triangle> oriented(const std::vector<Face>& faces, const std::vector<Point>& points) {
    struct Part {
        double count = 0.0, volume = 0.0;
        Kernel::Vector_3 sum = CGAL::NULL_VECTOR;
    };
    std::vector<Part> parts;
    const auto part_of = [&parts](const Face& face) -> Part& { return parts[static_cast<std::size_t>(face.part)]; };
    for (const Face& face : faces) {
        parts.resize(std::max(parts.size(), static_cast<std::size_t>(face.part) + 1));
        for (const std::int32_t corner : face.corners) part_of(face).sum += points[corner] - CGAL::ORIGIN;
        part_of(face).count += 3.0;
    }
    for (const Face& face : faces) {
        const Point middle = CGAL::ORIGIN + part_of(face).sum / part_of(face).count;
        part_of(face).volume += (points[face.corners[0]] - middle) * CGAL::cross_product(points[face.corners[1]] - middle, points[face.corners[2]] - middle);
    }
    std::vector<Triangle> triangles;
    triangles.reserve(faces.size());
    for (const Face& face : faces) {
        const Triangle& t = face.corners;
        triangles.push_back(part_of(face).volume < 0.0 ? Triangle{t[0], t[2], t[1]} : t);
    }
    return triangles;
}

std::vector<Triangle> grow(const Call& call, const std::vector<Point>& points, Delaunay delaunay, double perimeter_bound) {
    using Front = CGAL::Advancing_front_surface_reconstruction<Delaunay, Priority>;
    Front front(delaunay, Priority(call, perimeter_bound, delaunay.number_of_vertices()));
    front.run(5.0, call.options.number("beta"));
    return oriented(faces_of(front.triangulation_data_structure_2()), points);
}

void approximate(const Call& call) {
    call.progress(0.0);
    const Frame frame(call.points);
    std::vector<Point> points;
    points.reserve(static_cast<std::size_t>(call.points.count));
    for (std::int64_t i = 0; i < call.points.count; ++i) {
        const double* p = call.points.points + 3 * i;
        points.emplace_back(frame.to(p[0], 0), frame.to(p[1], 1), frame.to(p[2], 2));
    }
    std::vector<std::size_t> kept(points.size());
    std::iota(kept.begin(), kept.end(), std::size_t(0));
    remove_outliers(call, points, kept);
    const bool moved = smooth(call, points, kept);

    const double perimeter_bound = call.options.number("perimeter-bound") * frame.scale;
    const std::vector<Triangle> triangles = grow(call, points, triangulate(call, points, std::move(kept)), perimeter_bound);
    if (triangles.empty())
        throw Failure{LCL_ENGINE_FAILED, "CGAL's advancing front finds no triangle: the points lie on a line, or perimeter-bound is too small"};
    if (!moved) return call.give(triangles);
    std::vector<double> vertices;
    vertices.reserve(3 * points.size());
    for (const Point& point : points) {
        for (int axis = 0; axis < 3; ++axis) vertices.push_back(frame.from(point[axis], axis));
    }
    call.give(vertices, triangles);
}

std::int32_t run(void*, const lcl_engine_points* points, const lcl_engine_option* given, std::size_t given_count, const lcl_engine_sink* sink) {
    return limitcl_engine::run_engine(*points, options, given, given_count, *sink, approximate);
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const lcl_engine* lcl_engines(std::uint32_t abi, std::size_t* count) {
    static const std::string text = limitcl_engine::options_text(options);
    static const lcl_engine engines[] = {{sizeof(lcl_engine), "advancing-front", "CGAL " CGAL_VERSION_STR ", advancing front surface reconstruction",
                                          "GPL-3.0-or-later", text.c_str(), run, nullptr}};
    if (abi != LCL_ENGINE_ABI) return nullptr;
    *count = 1;
    return engines;
}
