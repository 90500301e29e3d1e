// SPDX-License-Identifier: BSD-3-Clause
#include "opensubdiv_patches.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <stdexcept>
#include <string>

#include "opensubdiv_surface.h"

namespace bench {
namespace {

constexpr int place_count = 2000;
constexpr int isolation = 2;  // leaves regular patches up to a quarter of a face from what is irregular
constexpr int most_isolation = 6;

void check(lcl_status status) {
    if (status != LCL_OK) throw std::runtime_error(std::string(lcl_status_string(status)) + ": " + lcl_last_error());
}

lcl_context context() {
    static const limitcl::ContextHandle opened = [] {
        lcl_context made = nullptr;
        check(lcl_context_create(nullptr, &made));
        return limitcl::ContextHandle(made);
    }();
    return opened.get();
}

struct Places {
    std::vector<std::int32_t> faces, corners;
    std::vector<double> uv;
    void add(std::int32_t face, std::int32_t corner, double u, double v) {
        faces.push_back(face);
        corners.push_back(corner);
        uv.push_back(u);
        uv.push_back(v);
    }
    std::size_t count() const { return faces.size(); }
};

class Random {
public:
    double uniform() { return distribution_(engine_); }
    int below(int count) { return static_cast<int>(engine_() % static_cast<unsigned>(count)); }

private:
    std::mt19937 engine_{1};
    std::uniform_real_distribution<double> distribution_{0, 1};
};

void add_inside(std::int32_t face, std::int32_t corner, bool is_loop, Random& random, Places& places) {
    const double u = random.uniform(), v = random.uniform();
    if (is_loop && u + v > 1) places.add(face, corner, 1 - u, 1 - v);
    else places.add(face, corner, u, v);
}

Places random_places(const SharpMesh& mesh, bool is_loop) {
    Random random;
    Places places;
    for (int i = 0; i < place_count; ++i) {
        const int face = random.below(static_cast<int>(mesh.face_degrees.size())), degree = mesh.face_degrees[static_cast<std::size_t>(face)];
        add_inside(face, is_loop || degree == 4 ? 0 : random.below(degree), is_loop, random, places);
    }
    return places;
}

using SurfaceHandle = limitcl::Handle<lcl_limit_surface, lcl_limit_surface_retain, lcl_limit_surface_release>;

SurfaceHandle make_surface(lcl_mesh mesh, const std::vector<double>& points, bool is_loop, lcl_precision precision) {
    lcl_scheme_options scheme = LCL_SCHEME_OPTIONS_INIT;
    scheme.scheme = is_loop ? LCL_SCHEME_LOOP : LCL_SCHEME_CATMULL_CLARK;
    lcl_limit_surface surface = nullptr;
    check(lcl_limit_surface_create(context(), mesh, &scheme, precision, &surface));
    const SurfaceHandle made(surface);
    check(lcl_limit_surface_set_points(surface, points.data(), 0));
    return made;
}

std::vector<Jet> limitcl_jets(const SurfaceHandle& surface, const Places& places) {
    std::array<std::vector<double>, 6> values;
    for (std::vector<double>& of : values) of.resize(3 * places.count());
    lcl_surface_values to = LCL_SURFACE_VALUES_INIT;
    to.points = values[0].data();
    to.du = values[1].data();
    to.dv = values[2].data();
    to.duu = values[3].data();
    to.duv = values[4].data();
    to.dvv = values[5].data();
    check(lcl_limit_surface_evaluate(surface.get(), places.count(), places.faces.data(), places.corners.data(), places.uv.data(), &to));
    std::vector<Jet> jets(places.count());
    for (std::size_t i = 0; i < jets.size(); ++i)
        for (std::size_t q = 0; q < 6; ++q) std::copy_n(&values[q][3 * i], 3, jets[i][q].begin());
    return jets;
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

void enlarge(double& worst, double value) {
    if (!(value <= worst)) worst = value;  // also if it is not a number
}

/// The mesh without isolated vertices, which OpenSubdiv does not know.
SharpMesh used_part(const SharpMesh& mesh) {
    SharpMesh out = mesh;
    out.points.clear();
    std::vector<int> number(mesh.points.size() / 3, -1);
    for (const int v : mesh.face_vertices) number[static_cast<std::size_t>(v)] = 0;
    for (std::size_t v = 0; v < number.size(); ++v) {
        if (number[v] < 0) continue;
        number[v] = static_cast<int>(out.points.size() / 3);
        out.points.insert(out.points.end(), &mesh.points[3 * v], &mesh.points[3 * v] + 3);
    }
    for (int& v : out.face_vertices) v = number[static_cast<std::size_t>(v)];
    for (std::array<int, 2>& edge : out.creases)
        for (int& v : edge) v = number[static_cast<std::size_t>(v)];
    out.corners.clear();
    for (const int v : mesh.corners)
        if (number[static_cast<std::size_t>(v)] >= 0) out.corners.push_back(number[static_cast<std::size_t>(v)]);
    return out;
}

template <class Real>
void compare_in(const limitcl::Mesh& surface_of, const SharpMesh& mesh, const SharpMesh& used, bool is_loop, const Places& places, PatchErrors& errors) {
    constexpr bool is_double = sizeof(Real) == sizeof(double);
    const std::vector<Jet> ours =
        limitcl_jets(make_surface(surface_of.get(), mesh.points, is_loop, is_double ? LCL_PRECISION_DOUBLE : LCL_PRECISION_SINGLE), places);
    const OpenSubdivPatches<Real> patches(used, {is_loop, EndCap::ENDCAP_GREGORY_BASIS, isolation});
    const std::vector<Real> control = patches.control_points(used.points);
    double* const worst[6] = {is_double ? &errors.points : &errors.single_points, is_double ? &errors.first : &errors.single_first,
                              is_double ? &errors.first : &errors.single_first,   is_double ? &errors.second : &errors.single_second,
                              is_double ? &errors.second : &errors.single_second, is_double ? &errors.second : &errors.single_second};
    errors.places = errors.irregular = 0;
    for (std::size_t i = 0; i < places.count(); ++i) {
        bool is_regular = false;
        const int face = is_loop ? places.faces[i] : patches.face_number(places.faces[i], places.corners[i]);
        const Jet theirs = patches.evaluate(control, face, places.uv[2 * i], places.uv[2 * i + 1], &is_regular);
        ++(is_regular ? errors.places : errors.irregular);
        for (std::size_t q = 0; is_regular && q < 6; ++q) enlarge(*worst[q], distance(ours[i][q], theirs[q]));
    }
}

/// A vertex of valence n, vertex 0, in three rings of faces, with edges of length 1 round it and every height up to a quarter.
SharpMesh disk(int n, bool is_loop) {
    constexpr int rings = 3;
    SharpMesh mesh;
    mesh.points = {0, 0, 0};
    Random random;
    const double tau = 8 * std::atan(1.0);
    // Sector q holds i = 1 .. rings steps along its own ray and j steps along the next one: for triangles i + j <= rings, for quads 0 .. rings.
    const auto first_of = [&](int q) { return 1 + q % n * (is_loop ? rings * (rings + 1) / 2 : rings * (rings + 1)); };
    const auto number = [&](int q, int i, int j) {
        if (i == 0 && j == 0) return 0;
        if (i == 0) return first_of(q + 1) + (is_loop ? (j - 1) * j / 2 : (j - 1) * (rings + 1));  // on the next ray
        return first_of(q) + (is_loop ? (i + j - 1) * (i + j) / 2 + j : (i - 1) * (rings + 1) + j);
    };
    for (int q = 0; q < n; ++q) {
        const double a = tau * q / n, b = tau * (q + 1) / n;
        const auto add = [&](int i, int j) {
            for (const double x : {i * std::cos(a) + j * std::cos(b), i * std::sin(a) + j * std::sin(b), 0.25 * (2 * random.uniform() - 1)})
                mesh.points.push_back(x);
        };
        if (is_loop) {
            for (int ring = 1; ring <= rings; ++ring)
                for (int j = 0; j < ring; ++j) add(ring - j, j);
        } else {
            for (int i = 1; i <= rings; ++i)
                for (int j = 0; j <= rings; ++j) add(i, j);
        }
    }
    const auto face = [&](std::initializer_list<int> corners) {
        mesh.face_degrees.push_back(static_cast<int>(corners.size()));
        mesh.face_vertices.insert(mesh.face_vertices.end(), corners);
    };
    for (int q = 0; q < n; ++q)  // the n faces round the vertex come first
        face(is_loop ? std::initializer_list<int>{0, number(q, 1, 0), number(q, 0, 1)}
                     : std::initializer_list<int>{0, number(q, 1, 0), number(q, 1, 1), number(q, 0, 1)});
    for (int q = 0; q < n; ++q)
        for (int i = 0; i < rings; ++i)
            for (int j = 0; j < rings; ++j) {
                if (!is_loop && i + j > 0) face({number(q, i, j), number(q, i + 1, j), number(q, i + 1, j + 1), number(q, i, j + 1)});
                if (is_loop && i + j > 0 && i + j < rings) face({number(q, i, j), number(q, i + 1, j), number(q, i, j + 1)});
                if (is_loop && i + j + 1 < rings) face({number(q, i + 1, j), number(q, i + 1, j + 1), number(q, i, j + 1)});
            }
    return mesh;
}

std::array<double, 3> normal_of(const Jet& jet) {
    const auto &u = jet[1], &v = jet[2];
    const std::array<double, 3> n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double length = std::hypot(n[0], n[1], n[2]);
    return {n[0] / length, n[1] / length, n[2] / length};
}

/// Largest distances of OpenSubdiv's points from the surface's at the same (u, v), and from the whole surface; of the normals there, in degrees.
struct CapErrors {
    double same_place = 0, distance = 0, angle = 0;
};

CapErrors cap_errors(const SharpMesh& mesh, const SurfaceHandle& surface, const Places& places, const OpenSubdivOptions& options) {
    const OpenSubdivPatches<double> patches(mesh, options);
    const std::vector<double> control = patches.control_points(mesh.points);
    const std::vector<Jet> ours = limitcl_jets(surface, places);
    std::vector<Jet> theirs;
    std::vector<double> points, normals(3 * places.count()), distances(places.count());
    for (std::size_t i = 0; i < places.count(); ++i) {
        bool is_regular = false;
        const int face = options.is_loop ? places.faces[i] : patches.face_number(places.faces[i], 0);
        theirs.push_back(patches.evaluate(control, face, places.uv[2 * i], places.uv[2 * i + 1], &is_regular));
        points.insert(points.end(), theirs[i][0].begin(), theirs[i][0].end());
    }
    lcl_closest_points to = LCL_CLOSEST_POINTS_INIT;
    to.normals = normals.data();
    to.distances = distances.data();
    check(lcl_limit_surface_closest(surface.get(), places.count(), points.data(), 0, &to));
    CapErrors errors;
    for (std::size_t i = 0; i < places.count(); ++i) {
        enlarge(errors.same_place, distance(ours[i][0], theirs[i][0]));
        enlarge(errors.distance, std::abs(distances[i]));
        const double chord = distance(normal_of(theirs[i]), {normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]});
        enlarge(errors.angle, 2 * std::asin(std::min(1.0, chord / 2)) * 45 / std::atan(1.0));
    }
    return errors;
}

/// Places all over the n faces round vertex 0, as many at every scale down to 2^-8.
Places places_round_vertex(int n, bool is_loop) {
    Random random;
    Places places;
    for (int i = 0; i < place_count; ++i) add_inside(random.below(n), 0, is_loop, random, places);
    for (std::size_t i = 0; i < places.count(); ++i)
        for (std::size_t c = 0; c < 2; ++c) places.uv[2 * i + c] = std::ldexp(places.uv[2 * i + c], -static_cast<int>(i % 9));
    return places;
}

/// Round the origin: OpenSubdiv takes the points to float as they are.
SharpMesh moved_to_origin(SharpMesh mesh) {
    const std::size_t first = 3 * static_cast<std::size_t>(mesh.face_vertices.front());
    const std::array<double, 3> origin{mesh.points[first], mesh.points[first + 1], mesh.points[first + 2]};
    for (std::size_t i = 0; i < mesh.points.size(); ++i) mesh.points[i] -= origin[i % 3];
    return mesh;
}

}  // namespace

PatchErrors compare_patches(const limitcl::Mesh& surface_of, const SharpMesh& given, bool is_loop) {
    const SharpMesh mesh = moved_to_origin(given);
    const Places places = random_places(mesh, is_loop);
    const SharpMesh used = used_part(mesh);
    PatchErrors errors;
    compare_in<double>(surface_of, mesh, used, is_loop, places, errors);
    compare_in<float>(surface_of, mesh, used, is_loop, places, errors);
    const double diagonal = surface_of.info().diagonal;
    for (double* error : {&errors.points, &errors.first, &errors.second, &errors.single_points, &errors.single_first, &errors.single_second})
        if (diagonal > 0) *error /= diagonal;
    return errors;
}

void print_end_caps() {
    std::printf("| scheme | valence | end cap |");
    for (int level = 1; level <= most_isolation; ++level) std::printf(" isolation %d |", level);
    std::printf("\n|---|---|---|");
    for (int level = 1; level <= most_isolation; ++level) std::printf("---|");
    std::printf("\n");
    for (const bool is_loop : {false, true})
        for (const int n : {3, 5, 6, 8, 12}) {
            const int valence = is_loop && n == 6 ? 7 : n;
            const SharpMesh mesh = disk(valence, is_loop);
            const limitcl::Mesh ours = limitcl::Mesh::from_uniform_faces(mesh.points, is_loop ? 3 : 4, mesh.face_vertices);
            const Places places = places_round_vertex(valence, is_loop);
            const SurfaceHandle surface = make_surface(ours.get(), mesh.points, is_loop, LCL_PRECISION_DOUBLE);
            for (const auto& [cap, name] : {std::pair{EndCap::ENDCAP_GREGORY_BASIS, "Gregory"}, std::pair{EndCap::ENDCAP_BSPLINE_BASIS, "B-spline"}}) {
                std::printf("| %s | %d | %s |", is_loop ? "Loop" : "Catmull-Clark", valence, name);
                for (int level = 1; level <= most_isolation; ++level) {
                    const CapErrors errors = cap_errors(mesh, surface, places, {is_loop, cap, level});
                    std::printf(" %.1e, %.2g°, %.1e |", errors.distance, errors.angle, errors.same_place);
                }
                std::printf("\n");
            }
        }
}

}  // namespace bench
