// SPDX-License-Identifier: BSD-3-Clause
// Engines on Open3D, which is under the MIT licence. "poisson": the zero set of a function whose gradient fits the normals (Kazhdan & Hoppe 2013): smooth, also
// where points are noisy, but not through the points. "ball-pivoting": the triangles that a ball rests on as it rolls over the points (Bernardini et al. 1999):
// through the points, with holes where they are sparse.
#include <open3d/Open3DConfig.h>
#include <open3d/geometry/KDTreeFlann.h>
#include <open3d/geometry/KDTreeSearchParam.h>
#include <open3d/geometry/PointCloud.h>
#include <open3d/geometry/TriangleMesh.h>
#include <open3d/utility/Logging.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <memory>
#include <mutex>
#include <numeric>
#include <queue>
#include <streambuf>
#include <string>
#include <tuple>
#include <utility>
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
using open3d::geometry::KDTreeFlann;
using open3d::geometry::PointCloud;
using open3d::geometry::TriangleMesh;

constexpr Option neighbours_option = {"neighbours", "20", Kind::whole, 3.0, 1000.0, "how many points each normal is estimated from, where the cloud has none"};
constexpr Option outliers_option = {
    "outlier-deviations", "0", Kind::number, 0.0, no_limit, "leave out points so many standard deviations farther from others than is usual (0: none)"};
constexpr Option outlier_neighbours_option = {"outlier-neighbours", "20", Kind::whole, 1.0, 1000.0, "how many neighbours that looks at"};

const Option poisson_options[] = {
    {"depth", "0", Kind::zero_or_whole, 5.0, 12.0, "of the octree: cells are as small as the cloud's width / 2^depth (0: half of log2 of the points, rounded)"},
    {"trim", "4", Kind::number, 0.0, no_limit,
     "take away triangles farther from the points than so many times their spacing (0: none, and the surface closes over every gap)"},
    neighbours_option,
    outliers_option,
    outlier_neighbours_option};
const Option ball_options[] = {{"radii", "2,4,8", Kind::list, 0.01, 1e6, "of the ball, times the points' mean spacing, one after the other"},
                               neighbours_option,
                               outliers_option,
                               outlier_neighbours_option};

/// Drops the warnings that PoissonRecon, inside Open3D, writes to std::cerr, each as one string and a line's end; passes all else on. There is no other way to
/// it than std::cerr of the whole process: what other threads write meanwhile comes through here, too, and may be mixed up.
class WarningFilter : public std::streambuf {
public:
    WarningFilter() : target_(std::cerr.rdbuf(this)) {}
    ~WarningFilter() override { std::cerr.rdbuf(target_); }

protected:
    std::streamsize xsputn(const char* text, std::streamsize size) override {
        const std::string start = "[WARNING]";
        dropped_ = size >= static_cast<std::streamsize>(start.size()) && start.compare(0, start.size(), text, start.size()) == 0;
        return dropped_ ? size : target_->sputn(text, size);
    }
    int_type overflow(int_type character) override {
        if (std::exchange(dropped_, false) && character == '\n') return character;
        return traits_type::eq_int_type(character, traits_type::eof()) ? traits_type::not_eof(character) : target_->sputc(traits_type::to_char_type(character));
    }
    int sync() override { return target_->pubsync(); }

private:
    std::streambuf* target_;
    bool dropped_ = false;
};

/// While it lives, Open3D prints nothing. One at a time: how much it prints is kept once for the whole process. So it must not live while a function of the
/// caller runs, which may run an engine itself.
class Silence {
public:
    Silence() : lock_(mutex()), verbosity_(open3d::utility::VerbosityLevel::Error) { verbosity_.Enter(); }
    ~Silence() { verbosity_.Exit(); }
    Silence(const Silence&) = delete;
    Silence& operator=(const Silence&) = delete;

private:
    static std::mutex& mutex() {
        static std::mutex one;
        return one;
    }
    std::lock_guard<std::mutex> lock_;
    open3d::utility::VerbosityContextManager verbosity_;
};

/// What `work` returns, which calls Open3D and no function of the caller.
template <typename Work>
auto quietly(Work work) {
    const Silence silence;
    return work();
}

/// The cloud in a frame of its own, and what each of its points was.
struct Cloud {
    PointCloud points;
    std::vector<std::int32_t> indices;
};

Cloud read_cloud(const lcl_engine_points& in, const Frame& frame) {
    Cloud cloud;
    cloud.points.points_.reserve(static_cast<std::size_t>(in.count));
    for (std::int64_t i = 0; i < 3 * std::int64_t(in.count); i += 3) {
        cloud.points.points_.emplace_back(frame.to(in.points[i], 0), frame.to(in.points[i + 1], 1), frame.to(in.points[i + 2], 2));
        if (in.normals) cloud.points.normals_.emplace_back(in.normals[i], in.normals[i + 1], in.normals[i + 2]);
    }
    cloud.indices.resize(static_cast<std::size_t>(in.count));
    std::iota(cloud.indices.begin(), cloud.indices.end(), 0);
    return cloud;
}

void remove_outliers(const Call& call, Cloud& cloud) {
    const double deviations = call.options.number("outlier-deviations");
    if (deviations == 0.0) return;
    const auto neighbours = static_cast<std::size_t>(call.options.whole("outlier-neighbours"));
    const auto [kept_points, kept] = quietly([&] { return cloud.points.RemoveStatisticalOutliers(neighbours, deviations); });
    if (kept.size() < 4)
        throw Failure{LCL_ENGINE_OPTION,
                      "the engine's options leave " + std::to_string(kept.size()) + " points after the outliers: raise `outlier-deviations`"};
    std::vector<char> is_kept(cloud.indices.size(), 0);
    for (const std::size_t index : kept) is_kept[index] = 1;
    std::vector<std::int32_t> outliers;
    for (std::size_t i = 0; i < is_kept.size(); ++i) {
        if (!is_kept[i]) outliers.push_back(static_cast<std::int32_t>(i));
    }
    call.leave_out(outliers);
    cloud.indices.assign(kept.begin(), kept.end());
    cloud.points = *kept_points;
}

/// Makes the normals of neighbours agree, along the edges where they differ least in direction (Hoppe et al. 1992). Gives each point the number of its part,
/// from 0: what neighbours lead to. Open3D's own function needs the points' Delaunay tetrahedra and fails where many lie on one sphere.
std::vector<std::int32_t> make_consistent(PointCloud& cloud, int neighbours) {
    struct Edge {
        float turn;
        std::int32_t from, to;
        bool operator<(const Edge& other) const { return turn > other.turn; }  // the least turn comes first out of a queue
    };
    const KDTreeFlann tree(cloud);
    std::vector<Eigen::Vector3d>& normals = cloud.normals_;
    std::vector<std::int32_t> parts(normals.size(), -1);
    std::int32_t part_count = 0;
    std::priority_queue<Edge> edges;
    std::vector<int> found;
    std::vector<double> squares;
    const auto add_edges = [&](std::int32_t point, bool to_done) {
        tree.SearchKNN(cloud.points_[point], neighbours, found, squares);
        for (const std::int32_t other : found) {
            const float turn = 1.0f - static_cast<float>(std::abs(normals[point].dot(normals[other])));
            if (to_done && parts[other] >= 0) edges.push({turn, other, point});
            if (!to_done && parts[other] < 0) edges.push({turn, point, other});
        }
    };
    for (std::int32_t first = 0; first < static_cast<std::int32_t>(parts.size()); ++first) {
        if (parts[first] >= 0) continue;
        add_edges(first, true);  // it may be nobody's neighbour and have some
        if (edges.empty()) edges.push({0.0f, first, first}), ++part_count;
        for (; !edges.empty();) {
            const Edge edge = edges.top();
            edges.pop();
            if (parts[edge.to] >= 0) continue;
            parts[edge.to] = edge.from == edge.to ? part_count - 1 : parts[edge.from];
            if (normals[edge.from].dot(normals[edge.to]) < 0.0) normals[edge.to] = -normals[edge.to];
            add_edges(edge.to, false);
        }
    }
    return parts;
}

/// Turns the normals of each part outwards: the sum of (p - middle) . n is about three times the volume inside times the density of points.
void turn_outwards(PointCloud& cloud, const std::vector<std::int32_t>& parts) {
    struct Sums {
        double count = 0.0, products = 0.0;
        Eigen::Vector3d points = Eigen::Vector3d::Zero(), normals = Eigen::Vector3d::Zero();
    };
    std::vector<Sums> sums(static_cast<std::size_t>(*std::max_element(parts.begin(), parts.end())) + 1);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        Sums& sum = sums[parts[i]];
        sum.count += 1.0;
        sum.products += cloud.points_[i].dot(cloud.normals_[i]);
        sum.points += cloud.points_[i];
        sum.normals += cloud.normals_[i];
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Sums& sum = sums[parts[i]];
        if (sum.products < sum.points.dot(sum.normals) / sum.count) cloud.normals_[i] = -cloud.normals_[i];
    }
}

void make_normals(const Call& call, PointCloud& cloud) {
    if (!cloud.normals_.empty()) return;
    const int neighbours = static_cast<int>(std::min<std::size_t>(call.options.whole("neighbours"), cloud.points_.size()));
    quietly([&] { cloud.EstimateNormals(open3d::geometry::KDTreeSearchParamKNN(neighbours)); });
    call.progress(-1.0);
    turn_outwards(cloud, make_consistent(cloud, neighbours));
}

Cloud prepare(const Call& call, const Frame& frame) {
    call.progress(-1.0);
    Cloud cloud = read_cloud(call.points, frame);
    remove_outliers(call, cloud);
    call.progress(-1.0);
    make_normals(call, cloud.points);
    call.progress(-1.0);
    return cloud;
}

/// Mean distance to the six nearest others, of each point: the spacing there.
std::vector<double> spacings(const PointCloud& cloud, const KDTreeFlann& tree) {
    std::vector<double> result(cloud.points_.size());
    std::vector<int> found;
    std::vector<double> squares;
    for (std::size_t i = 0; i < result.size(); ++i) {
        tree.SearchKNN(cloud.points_[i], 7, found, squares);
        double sum = 0.0;
        for (const double square : squares) sum += std::sqrt(square);
        result[i] = sum / static_cast<double>(squares.size() - 1);  // the point itself is among them
    }
    return result;
}

/// By default about as many vertices as points come out, up to three times as many: finer cells follow the points no better.
int octree_depth(const Call& call, std::size_t count) {
    const int given = call.options.whole("depth");
    const int depth = given > 0 ? given : static_cast<int>(std::lround(std::log2(static_cast<double>(count)) / 2));
    return std::clamp(depth, 5, 12);  // below 5 the library has not the nodes that it asks for
}

/// Whether a vertex is within `trim` spacings of the points, the spacing being that of the nearest one.
std::vector<char> near_points(const TriangleMesh& mesh, const PointCloud& cloud, double trim) {
    std::vector<char> near(mesh.vertices_.size(), 1);
    if (trim == 0.0) return near;
    const KDTreeFlann tree(cloud);
    const std::vector<double> spacing = spacings(cloud, tree);
    std::vector<int> found;
    std::vector<double> squares;
    for (std::size_t i = 0; i < near.size(); ++i) {
        tree.SearchKNN(mesh.vertices_[i], 1, found, squares);
        near[i] = std::sqrt(squares.front()) <= trim * spacing[static_cast<std::size_t>(found.front())];
    }
    return near;
}

std::shared_ptr<TriangleMesh> poisson_mesh(const PointCloud& cloud, int depth) {
    return quietly([&] {
        const WarningFilter filter;
        // One thread: with more the sums, and so the vertices, would differ from run to run.
        return std::get<0>(TriangleMesh::CreateFromPointCloudPoisson(cloud, static_cast<std::size_t>(depth), 0.0f, 1.1f, false, 1));
    });
}

void run_poisson(const Call& call) {
    const Frame frame(call.points);
    const Cloud cloud = prepare(call, frame);
    const std::shared_ptr<TriangleMesh> mesh = poisson_mesh(cloud.points, octree_depth(call, cloud.indices.size()));
    call.progress(-1.0);
    const std::vector<char> near = near_points(*mesh, cloud.points, call.options.number("trim"));
    std::vector<Triangle> triangles;
    for (const Eigen::Vector3i& corners : mesh->triangles_) {
        if (near[corners[0]] && near[corners[1]] && near[corners[2]]) triangles.push_back({corners[0], corners[1], corners[2]});
    }
    if (triangles.empty()) throw Failure{LCL_ENGINE_FAILED, "Open3D's Poisson reconstruction gives no triangle near the points: raise `trim` or `depth`"};
    std::vector<double> vertices;
    for (const Eigen::Vector3d& vertex : mesh->vertices_) {
        for (int axis = 0; axis < 3; ++axis) vertices.push_back(frame.from(vertex[axis], axis));
    }
    call.give(vertices, triangles);
}

void run_ball_pivoting(const Call& call) {
    const Frame frame(call.points);
    const Cloud cloud = prepare(call, frame);
    const std::vector<double> nearest = quietly([&] { return cloud.points.ComputeNearestNeighborDistance(); });
    const double spacing = std::accumulate(nearest.begin(), nearest.end(), 0.0) / static_cast<double>(nearest.size());
    std::vector<double> radii = call.options.list("radii");
    std::sort(radii.begin(), radii.end());
    for (double& radius : radii) radius *= spacing;
    const auto mesh = quietly([&] { return TriangleMesh::CreateFromPointCloudBallPivoting(cloud.points, radii); });
    std::vector<Triangle> triangles;
    for (const Eigen::Vector3i& corners : mesh->triangles_) {
        triangles.push_back({cloud.indices[corners[0]], cloud.indices[corners[1]], cloud.indices[corners[2]]});
    }
    if (triangles.empty()) throw Failure{LCL_ENGINE_FAILED, "Open3D's ball pivoting finds no triangle: take larger `radii`"};
    call.give(triangles);
}

std::int32_t poisson(void*, const lcl_engine_points* points, const lcl_engine_option* given, std::size_t given_count, const lcl_engine_sink* sink) {
    return limitcl_engine::run_engine(*points, poisson_options, given, given_count, *sink, run_poisson);
}

std::int32_t ball_pivoting(void*, const lcl_engine_points* points, const lcl_engine_option* given, std::size_t given_count, const lcl_engine_sink* sink) {
    return limitcl_engine::run_engine(*points, ball_options, given, given_count, *sink, run_ball_pivoting);
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const lcl_engine* lcl_engines(std::uint32_t abi, std::size_t* count) {
    static const std::string poisson_text = limitcl_engine::options_text(poisson_options), ball_text = limitcl_engine::options_text(ball_options);
    static const lcl_engine engines[] = {
        {sizeof(lcl_engine), "poisson", "Open3D " OPEN3D_VERSION ", screened Poisson reconstruction", "MIT", poisson_text.c_str(), poisson, nullptr},
        {sizeof(lcl_engine), "ball-pivoting", "Open3D " OPEN3D_VERSION ", ball pivoting", "MIT", ball_text.c_str(), ball_pivoting, nullptr}};
    if (abi != LCL_ENGINE_ABI) return nullptr;
    *count = 2;
    return engines;
}
