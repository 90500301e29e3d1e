// SPDX-License-Identifier: BSD-3-Clause
// One solve on one mesh in two parts, as the nodes of a cluster do it: rows for the owned vertices, ghosts exchanged after each sweep. With two devices each
// part has its own.
#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "tests/capi_support.h"
#include "tests/oracle/dense.h"
#include "tests/oracle/limit.h"

using namespace capi_test;

namespace {

// Sums of up to 20 products of numbers of the size of the model, in another order of rows; sweeps contract what they start from.
constexpr double rounding = 1e-13;

/// What a part sees of the whole: its vertices by their numbers in the whole mesh, owned ones and ghosts.
struct Extract {
    lcl::PolygonMesh mesh;
    std::vector<int32_t> whole_vertex;  // of each vertex of `mesh`
    std::vector<int32_t> owned;         // vertices of `mesh`
};

using IsOwned = std::vector<char>;

/// The left half (part 0) and the right half of a mesh.
IsOwned cut(const lcl::PolygonMesh& mesh, int part) {
    IsOwned owned(mesh.vertex_count);
    for (lcl::Index v = 0; v < mesh.vertex_count; ++v) owned[v] = (mesh.positions[3 * v] + 0.1 * mesh.positions[3 * v + 1] < 0.05) == (part == 0);
    return owned;
}

/// All of the mesh, with owned vertices marked: what a caller does for whom memory is no matter.
Extract whole_extract(const lcl::PolygonMesh& mesh, const IsOwned& is_owned) {
    Extract extract{mesh, {}, {}};
    for (lcl::Index v = 0; v < mesh.vertex_count; ++v) {
        extract.whole_vertex.push_back(v);
        if (is_owned[v]) extract.owned.push_back(v);
    }
    return extract;
}

/// Marks of the faces that touch a marked vertex.
std::vector<char> faces_at(const std::vector<shapes::Face>& faces, const std::vector<char>& vertices) {
    std::vector<char> marks;
    for (const shapes::Face& face : faces) marks.push_back(std::any_of(face.begin(), face.end(), [&](int v) { return vertices[v]; }));
    return marks;
}

/// Vertices where the marked faces form several fans: these have more edges than faces by the number of fans.
std::vector<char> joints(const std::vector<shapes::Face>& faces, const std::vector<char>& marks, int vertex_count) {
    std::vector<std::set<int>> neighbours(vertex_count);
    std::vector<int> face_count(vertex_count);
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (std::size_t i = 0; marks[f] && i < faces[f].size(); ++i) {
            const int a = faces[f][i], b = faces[f][(i + 1) % faces[f].size()];
            neighbours[a].insert(b), neighbours[b].insert(a);
            ++face_count[a];
        }
    std::vector<char> result(vertex_count);
    for (int v = 0; v < vertex_count; ++v) result[v] = static_cast<int>(neighbours[v].size()) > face_count[v] + 1;
    return result;
}

/// The faces that touch an owned vertex, renumbered, and those that make them a manifold mesh: what a cluster sends to a node.
Extract local_extract(const lcl::PolygonMesh& mesh, const IsOwned& is_owned) {
    Extract extract;
    std::map<int, int> number;
    const std::vector<shapes::Face> all = shapes::faces_of(mesh);
    std::vector<char> vertices = is_owned, marks = faces_at(all, vertices);
    for (std::vector<char> more = joints(all, marks, mesh.vertex_count); std::count(more.begin(), more.end(), 1) > 0;
         more = joints(all, marks, mesh.vertex_count)) {
        for (std::size_t v = 0; v < more.size(); ++v) vertices[v] |= more[v];
        marks = faces_at(all, vertices);
    }
    std::vector<shapes::Face> faces;
    for (std::size_t f = 0; f < all.size(); ++f) {
        if (!marks[f]) continue;
        faces.push_back(all[f]);
        for (int& v : faces.back()) {
            const auto [found, is_new] = number.emplace(v, static_cast<int>(extract.whole_vertex.size()));
            if (is_new) extract.whole_vertex.push_back(v);
            v = found->second;
        }
    }
    std::vector<shapes::Point> points;
    for (std::size_t v = 0; v < extract.whole_vertex.size(); ++v) {
        const double* point = &mesh.positions[3 * static_cast<std::size_t>(extract.whole_vertex[v])];
        points.push_back({point[0], point[1], point[2]});
        if (is_owned[extract.whole_vertex[v]]) extract.owned.push_back(static_cast<int32_t>(v));
    }
    extract.mesh = shapes::make("extract", points, faces).mesh;
    return extract;
}

/// One part on one device. x holds P_k, y receives P_(k+1).
class Part {
public:
    Part(lcl_context context, Extract extract, const lcl_scheme_options& options) : extract_(std::move(extract)), is_owned_(extract_.whole_vertex.size(), 0) {
        for (const int32_t v : extract_.owned) is_owned_[v] = 1;
        lcl_scheme_options own = options;
        own.owned = extract_.owned.data();
        own.owned_count = extract_.owned.size();
        A_ = make_operator(context, make_mesh(extract_.mesh).get(), &own);
        REQUIRE(lcl_operator_row_count(A_.get()) == static_cast<int32_t>(extract_.owned.size()));
        M_ = make_field(A_.get(), extract_.mesh.positions);
        x_ = make_field(A_.get(), extract_.mesh.positions, LCL_PRECISION_DOUBLE, M_.get());
        y_ = make_field(A_.get(), extract_.mesh.positions, LCL_PRECISION_DOUBLE, M_.get());
    }

    int block_count() const { return lcl_operator_block_count(A_.get()); }
    std::size_t ghost_count() const { return extract_.whole_vertex.size() - extract_.owned.size(); }

    /// y = a x + b (M - A x) + c y on a range of blocks; the largest residual of its rows.
    double sweep(const std::array<double, 3>& factors, int first_block = 0, int block_count = -1) {
        double residual = -1;
        succeed(lcl_operator_step(A_.get(), factors[0], factors[1], factors[2], M_.get(), x_.get(), factors[2] == 0 ? nullptr : y_.get(), y_.get(), first_block,
                                  block_count, &residual));
        return residual;
    }

    void swap() { std::swap(x_, y_); }

    /// Takes over the new values of the ghosts from the part that owns them.
    void fetch_ghosts(Part& owner) {
        if (ghosts_.empty()) find_ghosts(owner);
        std::vector<double> values(3 * ghosts_.size());
        succeed(lcl_field_read_vertices(owner.y_.get(), sources_.data(), sources_.size(), values.data()));
        succeed(lcl_field_write_vertices(y_.get(), ghosts_.data(), ghosts_.size(), values.data()));
    }

    /// Writes P_k of the owned vertices to their places in the whole mesh.
    void gather(std::vector<double>& whole) const {
        const std::vector<double> own = download(x_.get(), extract_.whole_vertex.size());
        for (const int32_t v : extract_.owned) std::copy_n(&own[3 * v], 3, &whole[3 * extract_.whole_vertex[v]]);
    }

private:
    void find_ghosts(const Part& owner) {
        std::map<int32_t, int32_t> place;
        for (const int32_t v : owner.extract_.owned) place[owner.extract_.whole_vertex[v]] = v;
        for (std::size_t v = 0; v < extract_.whole_vertex.size(); ++v) {
            if (is_owned_[v]) continue;
            ghosts_.push_back(static_cast<int32_t>(v));
            sources_.push_back(place.at(extract_.whole_vertex[v]));
        }
    }

    Extract extract_;
    std::vector<char> is_owned_;
    std::vector<int32_t> ghosts_, sources_;  // ghosts here, the same vertices there
    Operator A_;
    FieldHandle M_, x_, y_;
};

/// The sweeps of an iteration, one (a, b, c) after the other.
using Recurrence = std::vector<std::array<double, 3>>;

Recurrence pia(int sweeps) { return Recurrence(sweeps, {1, 1, 0}); }

/// Chebyshev semi-iteration for a spectrum in [low, 1]: P_1 = P_0 + R_0/theta, P_(k+1) = P_k + rho_k rho_(k-1) (P_k - P_(k-1)) + 2 rho_k/delta R_k.
Recurrence chebyshev(int sweeps, double low) {
    const double theta = (1 + low) / 2, delta = (1 - low) / 2;
    Recurrence all{{1, 1 / theta, 0}};
    for (double rho = delta / theta; static_cast<int>(all.size()) < sweeps;) {
        const double next = 1 / (2 * theta / delta - rho);
        all.push_back({1 + next * rho, 2 * next / delta, -next * rho});
        rho = next;
    }
    return all;
}

struct Run {
    std::vector<double> points, residuals;
};

/// Drives all parts through a recurrence; with `overlap` each sweep is made in two ranges of blocks, as one does to exchange the first while the second is
/// computed.
Run run(std::vector<Part>& parts, const Recurrence& recurrence, std::size_t vertex_count, bool overlap) {
    Run result{std::vector<double>(3 * vertex_count), {}};
    for (const auto& factors : recurrence) {
        double largest = 0;
        for (Part& part : parts) {
            const int first = overlap ? part.block_count() / 2 : 0;
            if (overlap) largest = std::max(largest, part.sweep(factors, 0, first));
            largest = std::max(largest, part.sweep(factors, first));
        }
        result.residuals.push_back(largest);
        if (parts.size() == 2) parts[0].fetch_ghosts(parts[1]), parts[1].fetch_ghosts(parts[0]);
        for (Part& part : parts) part.swap();
    }
    for (const Part& part : parts) part.gather(result.points);
    return result;
}

using MakeExtract = Extract (*)(const lcl::PolygonMesh&, const IsOwned&);

struct TwoContexts {
    Context first = open_context("0"), second = open_context(lcl_device_count() >= 2 ? "1" : "0");

    std::vector<Part> split(const shapes::Shape& shape, const lcl_scheme_options& options, MakeExtract make_extract) const {
        std::vector<Part> parts;
        parts.emplace_back(first.get(), make_extract(shape.mesh, cut(shape.mesh, 0)), options);
        parts.emplace_back(second.get(), make_extract(shape.mesh, cut(shape.mesh, 1)), options);
        for (const Part& part : parts) REQUIRE(part.ghost_count() > 0);
        return parts;
    }
    std::vector<Part> whole(const shapes::Shape& shape, const lcl_scheme_options& options) const {
        std::vector<Part> parts;
        parts.emplace_back(first.get(), whole_extract(shape.mesh, IsOwned(shape.mesh.vertex_count, 1)), options);
        return parts;
    }
};

void expect_same(const Run& found, const Run& expected, double diagonal) {
    CHECK(largest_difference(found.residuals, expected.residuals) <= rounding * diagonal);
    CHECK(largest_difference(found.points, expected.points) <= 10 * rounding * diagonal);
}

}  // namespace

TEST_CASE("PIA on two parts has the residual history of one device and of lcl_interpolate", "[split][capi][device]") {
    const auto [shape, options] =
        GENERATE(table<shapes::Shape, lcl_scheme_options>({{shapes::rough(shapes::torus_quads(16, 9), 0.03, 4), scheme(LCL_SCHEME_CATMULL_CLARK)},
                                                           {shapes::rough(shapes::grid_quads(13, 11), 0.03, 4), scheme(LCL_SCHEME_CATMULL_CLARK, 0.5, 0.2)},
                                                           {shapes::rough(shapes::icosphere(2), 0.03, 4), scheme(LCL_SCHEME_LOOP)},
                                                           {shapes::rough(shapes::polygons_mixed(150, 6), 0.03, 4), scheme(LCL_SCHEME_DOO_SABIN)}}));
    CAPTURE(shape.name);
    const int sweeps = 25;
    const TwoContexts contexts;
    const double diagonal = diagonal_of(shape);
    auto whole = contexts.whole(shape, options);
    const Run expected = run(whole, pia(sweeps), shape.mesh.vertex_count, false);
    for (const MakeExtract make_extract : {whole_extract, local_extract}) {
        auto parts = contexts.split(shape, options, make_extract);
        expect_same(run(parts, pia(sweeps), shape.mesh.vertex_count, false), expected, diagonal);
    }
    CHECK(expected.residuals.back() < 0.2 * expected.residuals.front());

    lcl_solve_options solve = LCL_SOLVE_OPTIONS_INIT;
    solve.solver = LCL_SOLVER_PIA;
    solve.precision = LCL_PRECISION_DOUBLE;
    solve.exact_sweeps = sweeps;
    Run in_one_call{std::vector<double>(shape.mesh.positions.size()), std::vector<double>(sweeps)};
    lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
    report.residuals = in_one_call.residuals.data();
    report.residual_capacity = sweeps;  // a driver by hand knows E_0 .. E_(sweeps - 1)
    const Operator A = make_operator(contexts.second.get(), make_mesh(shape).get(), &options);
    succeed(lcl_interpolate(A.get(), shape.mesh.positions.data(), 0, 3, &solve, in_one_call.points.data(), 0, &report));
    expect_same(in_one_call, expected, diagonal);
}

TEST_CASE("Chebyshev on two parts has the residual history of one device and of the plain loop", "[split][capi][device]") {
    const shapes::Shape shape = shapes::rough(shapes::torus_quads(16, 9), 0.03, 4);
    const lcl_scheme_options options = scheme(LCL_SCHEME_CATMULL_CLARK);
    const int sweeps = 30;
    const double low = 1.0 / 9;  // regular Catmull-Clark
    const TwoContexts contexts;
    auto whole = contexts.whole(shape, options), parts = contexts.split(shape, options, local_extract);
    const Run expected = run(whole, chebyshev(sweeps, low), shape.mesh.vertex_count, false);
    expect_same(run(parts, chebyshev(sweeps, low), shape.mesh.vertex_count, false), expected, diagonal_of(shape));
    CHECK(expected.residuals.back() <= 1e-7 * diagonal_of(shape));

    const Eigen::MatrixXd rows = oracle::limit_rows(shape.mesh, {}, {});
    const oracle::History plain = oracle::chebyshev(oracle::to_sparse(rows), oracle::positions(shape.mesh), sweeps, low);
    const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> points = plain.points;
    expect_same({{points.data(), points.data() + points.size()}, {plain.residuals.begin(), plain.residuals.end() - 1}}, expected, diagonal_of(shape));
}

TEST_CASE("sweeps of parts in two ranges of blocks change nothing", "[split][capi][device]") {
    const shapes::Shape shape = shapes::rough(shapes::grid_quads(170, 150), 0.002, 4);  // parts of more rows than a block holds
    const lcl_scheme_options options = scheme(LCL_SCHEME_CATMULL_CLARK);
    const Recurrence recurrence = GENERATE(pia(6), chebyshev(6, 1.0 / 9));
    const TwoContexts contexts;
    auto whole = contexts.whole(shape, options), parts = contexts.split(shape, options, local_extract),
         in_ranges = contexts.split(shape, options, local_extract);
    for (const Part& part : in_ranges) REQUIRE(part.block_count() >= 4);
    const Run expected = run(whole, recurrence, shape.mesh.vertex_count, false), found = run(parts, recurrence, shape.mesh.vertex_count, false),
              overlapped = run(in_ranges, recurrence, shape.mesh.vertex_count, true);
    expect_same(found, expected, diagonal_of(shape));
    CHECK(overlapped.residuals == found.residuals);
    CHECK(overlapped.points == found.points);
}
