// SPDX-License-Identifier: BSD-3-Clause
// Limit normals against the normals of faces that are refined until they no longer change, and the kernels against the plain host normals.
#include <cmath>
#include <cstring>

#include <catch2/catch.hpp>

#include "host/apply/device_tangents.h"
#include "host/apply/host_normals.h"
#include "tests/oracle/normals.h"
#include "tests/solver_support.h"

using namespace lcl;
using namespace solver_test;

namespace {

const double pi = std::acos(-1.0);

using Vector = Eigen::Vector3d;

/// Vertex 0 in the middle of `faces` faces of the given degrees (in turn), E_i = 1 + i; round it closed, or through `angle`. Rough, but nowhere folded.
shapes::Shape fan(int faces, bool closed, const std::vector<int>& degrees, double angle, double roughness, std::uint64_t seed) {
    shapes::Random random(seed);
    const auto point = [&](double turn, double radius) -> shapes::Point {
        radius *= 1 + 0.3 * roughness * random.symmetric();
        return {radius * std::cos(turn), radius * std::sin(turn), roughness * (0.3 * random.symmetric() + 0.2 * std::sin(2 * turn))};
    };
    const double step = closed ? 2 * pi / faces : angle / faces;
    std::vector<shapes::Point> points{{0.05 * roughness, -0.08 * roughness, 0.1 * roughness}};
    const int edges = closed ? faces : faces + 1;
    for (int i = 0; i < edges; ++i) points.push_back(point(i * step, 1));
    std::vector<shapes::Face> list;
    for (int i = 0; i < faces; ++i) {
        const int degree = degrees[i % degrees.size()];
        shapes::Face face{0, 1 + i};
        for (int j = 1; j + 2 < degree; ++j) {
            face.push_back(static_cast<int>(points.size()));
            points.push_back(point((i + j / (degree - 2.0)) * step, 1.4));
        }
        face.push_back(1 + (i + 1) % edges);
        list.push_back(face);
    }
    return shapes::make("fan of " + std::to_string(faces) + (closed ? " round" : " open"), points, list);
}

shapes::Shape with_creases(shapes::Shape shape, const std::vector<int>& ends) {
    for (const int end : ends) shape.features.creases.push_back({0, end});
    shape.name += ", " + std::to_string(ends.size()) + " creases";
    return shape;
}

/// Normals of a shape by the host's plan, in the caller's numbering.
struct Found {
    Eigen::MatrixXd normals;                 // vertex_count x 3
    std::vector<std::pair<int, int>> sides;  // vertex, first face
    std::vector<Vector> side_normals;

    Vector at(int v) const { return normals.row(v); }
    /// Of the vertex's sector that begins with a face; its only one where it has no sides.
    Vector of_sector(int v, int face) const {
        bool has_sides = false;
        for (std::size_t i = 0; i < sides.size(); ++i) {
            if (sides[i] == std::pair(v, face)) return side_normals[i];
            has_sides = has_sides || sides[i].first == v;
        }
        return has_sides ? Vector(Vector::Constant(NAN)) : at(v);
    }
};

Found find_normals(const shapes::Shape& shape, const SchemeOptions& scheme) {
    const Prepared mesh(shape);
    const Plan plan = mesh.plan(scheme);
    const TangentPlan tangents = build_tangent_plan(plan, mesh.topology, mesh.features, scheme);
    std::vector<double> x(3 * mesh.vertex_count());
    for (Index row = 0; row < plan.vertex_count; ++row) std::copy_n(&shape.mesh.positions[3 * plan.vertex_of_row[row]], 3, &x[3 * row]);
    const Normals normals = host_normals(plan, tangents, x);
    Found found{Eigen::MatrixXd(mesh.vertex_count(), 3), {}, {}};
    for (Index row = 0; row < plan.vertex_count; ++row)
        found.normals.row(plan.vertex_of_row[row]) = Eigen::Map<const Eigen::RowVector3d>(&normals.vertices[3 * row]);
    for (Index s = 0; s < tangents.side_count(); ++s) {
        found.sides.emplace_back(tangents.side_vertices[s], tangents.side_faces[s]);
        found.side_normals.push_back(Eigen::Map<const Vector>(&normals.sides[3 * s]));
    }
    return found;
}

/// Where each sector of a vertex begins, by plain search: its faces whose edge to the next vertex is sharp; without two of them, any.
std::vector<int> first_faces(const oracle::Surface& surface, int v) {
    std::vector<int> first, all;
    for (int f = 0; f < static_cast<int>(surface.faces.size()); ++f) {
        const auto& face = surface.faces[f];
        const auto at = std::find(face.begin(), face.end(), v);
        if (at == face.end()) continue;
        all.push_back(f);
        const int next = at + 1 == face.end() ? face.front() : *(at + 1);
        if (surface.sharp.count(oracle::edge_of(v, next))) first.push_back(f);
    }
    return first.empty() ? all : first;
}

/// All normals at one vertex are the limits of its refined faces.
void check_vertex(const shapes::Shape& shape, const SchemeOptions& scheme, const Found& found, int v) {
    const oracle::Surface surface = oracle::make_surface(shape.mesh, shape.features);
    const std::vector<int> first = first_faces(surface, v);
    Vector sum = Vector::Zero();
    std::size_t sectors = 0;
    for (const oracle::FaceNormal& limit : oracle::limit_normals(surface, scheme, oracle::positions(shape.mesh), v)) {
        if (std::find(first.begin(), first.end(), limit.face) == first.end()) continue;
        INFO(shape.name << ", vertex " << v << ", face " << limit.face << ", oracle's own error " << limit.error);
        REQUIRE(limit.error < 1e-6);  // there is a limit, and it was reached
        const bool only_one = found.of_sector(v, limit.face) == found.at(v);
        CHECK((found.of_sector(v, limit.face) - limit.normal).norm() <= 1e-9 + 30 * limit.error);
        if (only_one && sectors > 0) continue;  // seen from another face
        sum += limit.normal;
        ++sectors;
    }
    REQUIRE(sectors > 0);
    INFO(shape.name << ", vertex " << v);
    CHECK((found.at(v) - sum.normalized()).norm() <= 1e-6);
}

std::vector<NamedScheme> schemes_for(const std::vector<int>& degrees) {
    std::vector<NamedScheme> schemes{{"Catmull-Clark", catmull_clark()},
                                     {"alpha 0.7", catmull_clark(0.7)},
                                     {"two-phase 0.3, alpha 0.4", catmull_clark(0.4, 0.3)},
                                     {"Doo-Sabin", doo_sabin()},
                                     {"classic Doo-Sabin", doo_sabin(DooSabinMask::classic)}};
    if (degrees == std::vector<int>{3}) schemes.push_back({"Loop", loop()});
    return schemes;
}

const std::vector<std::vector<int>> face_degrees = {{4}, {3}, {4, 3, 5, 6, 4}};

void check_fan(const shapes::Shape& shape, const NamedScheme& scheme) {
    INFO(scheme.name);
    check_vertex(shape, scheme.options, find_normals(shape, scheme.options), 0);
}

bool is_doo_sabin(const NamedScheme& scheme) { return scheme.options.scheme == Scheme::doo_sabin; }

}  // namespace

TEST_CASE("limit normals of smooth vertices and darts are those that refined faces tend to", "[normals]") {
    for (const auto& degrees : face_degrees)
        for (const NamedScheme& scheme : schemes_for(degrees))
            for (const int n : {3, 4, 5, 6, 7, 8, 9, 12}) {
                const shapes::Shape round = fan(n, true, degrees, 0, 1, 3 * n + degrees.size());
                check_fan(round, scheme);
                if (!is_doo_sabin(scheme)) check_fan(with_creases(round, {2}), scheme);  // the tip of a slit has no tangent plane
            }
}

TEST_CASE("limit normals on curves are those that refined faces tend to", "[normals]") {
    for (const auto& degrees : face_degrees)
        for (const NamedScheme& scheme : schemes_for(degrees)) {
            // Faces of a sector for which the limit is there, and is not approached like 1/level.
            const std::vector<int> faces = is_doo_sabin(scheme)    ? std::vector<int>{1, 2, 3, 5, 8}
                                           : scheme.name == "Loop" ? std::vector<int>{1, 2, 3, 4, 5}
                                                                   : std::vector<int>{2, 3};
            for (const int k : faces) {
                shapes::Shape open = fan(k, false, degrees, pi, 1, 100 + k);
                open.features.boundary = BoundaryRule::edge_only;
                check_fan(open, scheme);
                for (const int other : faces)
                    if (k + other > 2) check_fan(with_creases(fan(k + other, true, degrees, 0, 1, 7 * k + other), {1, 1 + k}), scheme);
            }
        }
}

TEST_CASE("limit normals at corners are those that refined faces tend to", "[normals]") {
    for (const auto& degrees : face_degrees)
        for (const NamedScheme& scheme : schemes_for(degrees)) {
            const std::vector<int> faces = is_doo_sabin(scheme)    ? std::vector<int>{1, 2, 3, 5}
                                           : scheme.name == "Loop" ? std::vector<int>{1, 2}
                                                                   : std::vector<int>{1};
            for (const int k : faces) {
                shapes::Shape open = fan(k, false, degrees, 0.5 * pi, 1, 200 + k);
                open.features.corners = {0};
                check_fan(open, scheme);
                check_fan(with_creases(fan(3 * k, true, degrees, 0, 1, 300 + k), {1, 1 + k, 1 + 2 * k}), scheme);
            }
            // A straight line: what the surface leaves it by.
            shapes::Shape straight = fan(faces.back(), false, degrees, pi, 1, 5);
            straight.features.corners = {0};
            std::vector<double>& p = straight.mesh.positions;
            const int last = 3 * (1 + faces.back());
            for (int c = 0; c < 3; ++c) p[last + c] = p[c] - 0.75 * (p[3 + c] - p[c]);
            const bool can_leave = degrees != std::vector<int>{3} || faces.back() > 1;  // one triangle would have no area
            if (can_leave) check_fan(straight, scheme);
        }
}

// At these the tangents' eigenvalues meet with others: errors fall like 1/level, and an extrapolation of that takes their place.
TEST_CASE("limit normals that are approached slowly agree with extrapolated ones", "[normals]") {
    struct Slow {
        SchemeOptions scheme;
        int faces, degree;
    };
    for (const auto& [scheme, faces, degree] : {Slow{catmull_clark(), 1, 4}, Slow{catmull_clark(), 4, 4}, Slow{loop(), 6, 3}}) {
        shapes::Shape open = fan(faces, false, {degree}, pi, 0.5, 11);
        open.features.boundary = BoundaryRule::edge_only;
        const oracle::Surface surface = oracle::make_surface(open.mesh, open.features);
        const auto at_level = [&, rules = scheme](int level) {
            return oracle::limit_normals(surface, rules, oracle::positions(open.mesh), 0, level).front().normal;
        };
        // Neville's scheme in 1/level; at 44 levels the smaller tangent is still 1e-13 of the larger one, far above rounding.
        const std::vector<int> levels{20, 24, 30, 36, 44};
        std::vector<Vector> table;
        for (const int level : levels) table.push_back(at_level(level));
        for (std::size_t order = 1; order < levels.size(); ++order)
            for (std::size_t i = 0; i + order < levels.size(); ++i)
                table[i] = (levels[i + order] * table[i + 1] - levels[i] * table[i]) / (levels[i + order] - levels[i]);
        INFO(scheme_name(scheme.scheme) << ", " << faces << " faces");
        const Vector expected = find_normals(open, scheme).at(0);
        const double near = (at_level(20) - expected).norm(), extrapolated = (table[0].normalized() - expected).norm();
        CHECK(extrapolated <= 0.02);
        CHECK(extrapolated < near);
    }
}

TEST_CASE("limit normals of whole meshes are those that refined faces tend to", "[normals]") {
    for (const shapes::Shape& plain : {shapes::icosahedron(), shapes::polygons_mixed(40, 5), shapes::cube_with_crease(), shapes::torus_with_dart(),
                                       shapes::cylinder_open(5, 3), shapes::icosphere_quads(0), shapes::torus_triangles_with_dart()})
        for (const NamedScheme& scheme : all_schemes()) {
            if (!suits(plain, scheme.options)) continue;
            const shapes::Shape shape = shapes::rough(shapes::shuffled(plain, 3), 0.1, 9);
            const Prepared mesh(shape);
            const Found found = find_normals(shape, scheme.options);
            for (Index v = 0; v < shape.mesh.vertex_count; v += 3) {
                const VertexKind kind = mesh.features.kind[v];
                const bool tip = kind == VertexKind::dart && scheme.options.scheme == Scheme::doo_sabin;
                const bool slow_curve =
                    kind == VertexKind::curve && scheme.options.scheme == Scheme::catmull_clark && shape.name.find("cube") != std::string::npos;  // one face
                if (tip || slow_curve) continue;
                INFO(scheme.name);
                check_vertex(shape, scheme.options, found, v);
            }
        }
}

TEST_CASE("normals of flat meshes look upwards at every kind of vertex, chosen ones too", "[normals]") {
    std::vector<shapes::Shape> flat{shapes::grid_quads(4, 3),    shapes::grid_triangles(3, 4),      shapes::grid_with_hole(),
                                    shapes::grid_with_creases(), shapes::grid_with_marked_corner(), shapes::grid_triangles_with_creases(),
                                    shapes::single_hexagon()};
    for (const auto& degrees : face_degrees)
        for (const int n : {2, 3, 4, 5, 8, 13}) {
            if (n > 2) flat.push_back(fan(n, true, degrees, 0, 0, 1));
            if (n > 2) flat.push_back(with_creases(fan(n, true, degrees, 0, 0, 1), {1}));
            flat.push_back(fan(n, false, degrees, pi, 0, 1));
            flat.push_back(fan(n, false, degrees, 0.6 * pi, 0, 1));
            if (n > 2) flat.push_back(with_creases(fan(n, true, degrees, 0, 0, 1), {1, 3}));
        }
    for (shapes::Shape& shape : flat)
        for (std::size_t z = 2; z < shape.mesh.positions.size(); z += 3) shape.mesh.positions[z] = 0;
    const std::size_t curves = flat.size();
    for (std::size_t i = 0; i < curves; ++i)
        for (const BoundaryRule rule : {BoundaryRule::edge_only, BoundaryRule::fixed}) {
            flat.push_back(flat[i]);
            flat.back().features.boundary = rule;
            if (rule == BoundaryRule::fixed) flat.back().features.corners.push_back(0);
        }
    for (const shapes::Shape& shape : flat)
        for (const NamedScheme& scheme : all_schemes()) {
            if (!suits(shape, scheme.options)) continue;
            const Prepared mesh(shape);
            const Found found = find_normals(shape, scheme.options);
            for (Index v = 0; v < shape.mesh.vertex_count; ++v) {
                // Loop's and Doo-Sabin's surfaces fold over in hollow corners, where they lie in the plane of the two edges.
                const bool can_fold = mesh.features.kind[v] == VertexKind::corner && scheme.options.scheme != Scheme::catmull_clark;
                INFO(shape.name << ", " << scheme.name << ", boundary rule " << static_cast<int>(shape.features.boundary) << ", vertex " << v);
                const double z = can_fold ? std::abs(found.at(v).z()) : found.at(v).z();
                if (!can_fold || z != 0) CHECK(std::abs(z - 1) <= 1e-12);  // sides that look up and down have no mean
            }
        }
}

namespace {

struct DeviceCase {
    std::string name;
    shapes::Shape shape;
    SchemeOptions scheme;
    PlanOptions plan;
};

/// Rings of many valences, and stored rows of every kind; odd sizes.
std::vector<DeviceCase> device_cases() {
    std::vector<DeviceCase> cases{{"quads", shapes::torus_quads(17, 13), catmull_clark(), {}},
                                  {"creases and darts", shapes::with_isolated_vertex(shapes::grid_with_creases(), 3), catmull_clark(0.3), {}},
                                  {"polygons", shapes::polygons_mixed(151, 3), doo_sabin(DooSabinMask::classic), {}},
                                  {"quads of valence 3 to 6", shapes::icosphere_quads(2), doo_sabin(), {}},
                                  {"triangles", shapes::random_triangle_mesh(233, 2, 20), loop(), {}},
                                  {"quads at a pole", shapes::disk_pole_quads(60), catmull_clark(0.5), {}},
                                  {"a pole of 5", shapes::disk_pole_quads(5), catmull_clark(), {}},
                                  {"a pole of 7", shapes::disk_pole_triangles(7), loop(), {}},
                                  {"triangles with a dart", shapes::torus_triangles_with_dart(), loop(), {}},
                                  {"one ratio a vertex", shapes::icosphere_quads(1), catmull_clark(), {}},
                                  {"a subset", shapes::torus_quads(5, 4), catmull_clark(), {}},
                                  {"ghosts", shapes::torus_triangles(9, 5), loop(), {}}};
    for (Index v = 0; v < cases[9].shape.mesh.vertex_count; ++v) cases[9].scheme.lambda_per_vertex.push_back(v % 6 * 0.2);
    for (Index v = 0; v < cases[10].shape.mesh.vertex_count; ++v) cases[10].plan.subset.push_back(v % 3 == 0);
    for (Index v = 0; v < cases[11].shape.mesh.vertex_count; ++v) cases[11].plan.owned.push_back(v % 4 != 1);
    return cases;
}

using Values = std::vector<double>;

double largest_difference(const Values& a, const Values& b) {
    REQUIRE(a.size() == b.size());
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (!(std::abs(a[i] - b[i]) <= worst)) worst = std::abs(a[i] - b[i]);
    return worst;
}

/// Kernels of one case, type and launch shape against host_normals and host_apply.
class DeviceCheck {
public:
    DeviceCheck(const std::shared_ptr<Context>& context, const DeviceCase& c, const LaunchShape& launching, Real real) : mesh_(c.shape), real_(real) {
        PlanOptions options = c.plan;
        options.block_rows = launching.block_rows;
        plan_ = std::make_shared<const Plan>(mesh_.plan(c.scheme, options));
        A_ = std::make_unique<DeviceOperator>(context, plan_, launching);
        tangents_ = std::make_unique<DeviceTangents>(*A_, build_tangent_plan(*plan_, mesh_.topology, mesh_.features, c.scheme));
        const bool wide = real == Real::full || (real == Real::wide && context->device().has_double);
        // A tangent of k neighbours sums products that are at most ten times its length, with k + 8 roundings, in the cross product and the length too.
        std::size_t longest = 8;
        for (const Run& run : plan_->runs) longest = std::max<std::size_t>(longest, run.stride());
        tolerance_ = 20 * (static_cast<double>(longest) + 8) * std::ldexp(1, wide ? -53 : -24);
        for (Index row = 0; row < plan_->vertex_count; ++row)
            for (int c3 = 0; c3 < 3; ++c3) {
                const double value = c.shape.mesh.positions[3 * plan_->vertex_of_row[row] + c3] / 4;
                x_.push_back(real == Real::single ? static_cast<float>(value) : value);
            }
    }

    void check_all() {
        const Normals expected = host_normals(*plan_, tangents_->plan(), x_);
        Field x = field(x_), y = field(x_), normals = field(Values(x_.size(), 0.0)), tangents = field(Values(x_.size(), 0.0)),
              bitangents = field(Values(x_.size(), 0.0));
        tangents_->normals(x, &y, normals);
        CHECK(largest_difference(download(normals), expected.vertices) <= tolerance_);
        CHECK(largest_difference(tangents_->read_sides(), expected.sides) <= tolerance_);
        CHECK(largest_difference(download(y), host_apply(*plan_, x_, 3)) <= tolerance_);
        normals = field(Values(x_.size(), 0.0));
        tangents_->normals(x, nullptr, normals);
        CHECK(largest_difference(download(normals), expected.vertices) <= tolerance_);
        normals = field(Values(x_.size(), 0.0));
        tangents_->frames(x, normals, tangents, bitangents);
        CHECK(largest_difference(download(normals), expected.vertices) <= tolerance_);
        CHECK(largest_difference(tangents_->read_sides(), expected.sides) <= tolerance_);
        check_frames(download(normals), download(tangents), download(bitangents));
        A_->context().finish();
    }

private:
    Field field(const Values& values) {
        Field field = A_->make_field(3, real_);
        field.upload(values.data(), 0, plan_->vertex_count);
        return field;
    }
    Values download(const Field& field) const {
        Values values(x_.size());
        field.download(values.data(), 0, plan_->vertex_count);
        return values;
    }

    void check_frames(const Values& normals, const Values& tangents, const Values& bitangents) const {
        double worst = 0;
        for (std::size_t i = 0; i < normals.size(); i += 3) {
            const Vector n(&normals[i]), t(&tangents[i]), b(&bitangents[i]);
            if (n.isZero()) continue;
            worst = std::max({worst, std::abs(t.norm() - 1), std::abs(t.dot(n)), (n.cross(t) - b).norm()});
        }
        CHECK(worst <= tolerance_);
    }

    Prepared mesh_;
    Real real_;
    std::shared_ptr<const Plan> plan_;
    std::unique_ptr<DeviceOperator> A_;
    std::unique_ptr<DeviceTangents> tangents_;
    double tolerance_ = 0;
    Values x_;
};

void check_device(const std::shared_ptr<Context>& context, const DeviceCase& c, const LaunchShape& launching, Real real) {
    INFO(c.name << ", type " << static_cast<int>(real) << ", group " << launching.group << (context->device().has_double ? "" : ", no double"));
    DeviceCheck(context, c, launching, real).check_all();
}

}  // namespace

TEST_CASE("normals of the kernels equal those of plain loops", "[normals][kernel]") {
    for (const DeviceCase& c : device_cases()) {
        for (const Real real : {Real::single, Real::wide, Real::full}) {
            if (real == Real::full && !device_context()->device().has_double) continue;
            check_device(device_context(), c, {1, 7, 0, 1}, real);
            check_device(device_context(), c, {16, 33, 0, 1}, real);
        }
        check_device(context_without_double(), c, {1, 64, 0, 1}, Real::wide);
    }
}

TEST_CASE("the kernels of normals run once on small meshes", "[normals][kernel][tiny]") {
    const std::vector<DeviceCase> cases = device_cases();
    check_device(device_context(), cases[1], {16, 30, 0, 1}, Real::single);
    check_device(device_context(), cases[6], {1, 64, 0, 1}, Real::wide);
}

TEST_CASE("a mesh that is not the operator's is refused", "[normals]") {
    const Prepared mesh(shapes::torus_quads(5, 4)), other(shapes::torus_quads(4, 5)), more(shapes::torus_quads(5, 5));
    shapes::Shape creased = mesh.shape;
    creased.features.creases = {{0, 1}, {1, 2}};
    const Prepared with_crease(creased);
    const Plan plan = mesh.plan(catmull_clark());
    using Catch::Matchers::Contains;
    CHECK_THROWS_WITH(build_tangent_plan(plan, other.topology, other.features, catmull_clark()), Contains("is not the one that the operator was made of"));
    CHECK_THROWS_WITH(build_tangent_plan(plan, with_crease.topology, with_crease.features, catmull_clark()),
                      Contains("its faces or sharp features are others"));
    CHECK_THROWS_WITH(build_tangent_plan(plan, more.topology, more.features, catmull_clark()), Contains("20 vertices, the mesh 25"));
}
