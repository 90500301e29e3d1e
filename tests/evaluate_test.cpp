// SPDX-License-Identifier: BSD-3-Clause
// Exact evaluation of limit surfaces through the C API, against subdivision carried on until the patch of a place is a spline (tests/oracle/evaluate.h).
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "tests/capi_support.h"
#include "tests/oracle/evaluate.h"
#include "tests/oracle/limit.h"
#include "tests/oracle/subdivide.h"

using namespace capi_test;
using Vector = Eigen::Vector3d;

namespace {

const double pi = std::acos(-1.0);
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

/// Places as the C API takes them.
struct Places {
    std::vector<std::int32_t> faces, corners;
    std::vector<double> uv;

    void add(int face, int corner, double u, double v) {
        faces.push_back(face);
        corners.push_back(corner);
        uv.insert(uv.end(), {u, v});
    }
    std::size_t count() const { return faces.size(); }
    oracle::Place at(std::size_t i) const { return {faces[i], corners[i], uv[2 * i], uv[2 * i + 1]}; }
    Places part(std::size_t first, std::size_t size) const {
        Places result;
        for (std::size_t i = first; i < std::min(first + size, count()); ++i) result.add(faces[i], corners[i], uv[2 * i], uv[2 * i + 1]);
        return result;
    }
};

/// Everything at some places. Real is double or float.
template <class Real>
struct Values {
    std::vector<Real> points, du, dv, normals, duu, duv, dvv, gauss, mean;

    explicit Values(std::size_t count) : gauss(count), mean(count) {
        for (auto* rows : {&points, &du, &dv, &normals, &duu, &duv, &dvv}) rows->resize(3 * count);
    }
    lcl_surface_values arrays() {
        lcl_surface_values values = LCL_SURFACE_VALUES_INIT;
        values.type = std::is_same<Real, float>::value ? LCL_TYPE_FLOAT : LCL_TYPE_DOUBLE;
        values.points = points.data(), values.du = du.data(), values.dv = dv.data(), values.normals = normals.data();
        values.duu = duu.data(), values.duv = duv.data(), values.dvv = dvv.data();
        values.gauss = gauss.data(), values.mean = mean.data();
        return values;
    }
    static Vector row(const std::vector<Real>& rows, std::size_t i) { return {rows[3 * i], rows[3 * i + 1], rows[3 * i + 2]}; }
};

lcl_scheme_options doo_sabin(lcl_mask mask = LCL_MASK_CATMULL) {
    lcl_scheme_options options = scheme(LCL_SCHEME_DOO_SABIN);
    options.mask = mask;
    return options;
}

lcl::SchemeOptions plain(const lcl_scheme_options& options) {
    lcl::SchemeOptions result;
    result.scheme = options.scheme == LCL_SCHEME_LOOP        ? lcl::Scheme::loop
                    : options.scheme == LCL_SCHEME_DOO_SABIN ? lcl::Scheme::doo_sabin
                                                             : lcl::Scheme::catmull_clark;
    result.mask = options.mask == LCL_MASK_CLASSIC ? lcl::DooSabinMask::classic : lcl::DooSabinMask::catmull;
    result.alpha = options.alpha;
    return result;
}

std::vector<lcl_scheme_options> options_for(const shapes::Shape& shape) {
    std::vector<lcl_scheme_options> list{scheme(LCL_SCHEME_CATMULL_CLARK), scheme(LCL_SCHEME_CATMULL_CLARK, 0.5), doo_sabin(), doo_sabin(LCL_MASK_CLASSIC)};
    if (shapes::is_triangle_mesh(shape.mesh)) list.push_back(scheme(LCL_SCHEME_LOOP));
    return list;
}

std::string name_of(const lcl_scheme_options& options) {
    if (options.scheme == LCL_SCHEME_LOOP) return "loop";
    if (options.scheme == LCL_SCHEME_DOO_SABIN) return options.mask == LCL_MASK_CLASSIC ? "doo-sabin, classic" : "doo-sabin";
    return options.alpha == 0 ? "catmull-clark" : "catmull-clark, alpha 0.5";
}

LimitSurface make_surface(const shapes::Shape& shape, const lcl_scheme_options& options, lcl_precision precision = LCL_PRECISION_DOUBLE) {
    lcl_limit_surface surface = nullptr;
    succeed(lcl_limit_surface_create(default_context(), make_mesh(shape).get(), &options, precision, &surface));
    return LimitSurface(surface);
}

Samples make_samples(const LimitSurface& surface, const Places& places) {
    lcl_samples samples = nullptr;
    succeed(lcl_samples_create(surface.get(), places.count(), places.faces.data(), places.corners.data(), places.uv.data(), &samples));
    return Samples(samples);
}

template <class Real = double>
Values<Real> evaluate(const LimitSurface& surface, const Places& places) {
    Values<Real> values(places.count());
    const lcl_surface_values arrays = values.arrays();
    succeed(lcl_limit_surface_evaluate(surface.get(), places.count(), places.faces.data(), places.corners.data(), places.uv.data(), &arrays));
    return values;
}

oracle::LimitSurface truth_of(const shapes::Shape& shape, const lcl_scheme_options& options) {
    return {oracle::make_surface(shape.mesh, shape.features), oracle::positions(shape.mesh), plain(options)};
}

/// Faces, and what is sharp, as the places on a face depend on it.
class Domains {
public:
    Domains(const shapes::Shape& shape, const lcl_scheme_options& options) : flat_(oracle::make_surface(shape.mesh, shape.features)), scheme_(options.scheme) {
        for (int f = 0; f < face_count(); ++f)
            for (int k = 0; k < degree(f); ++k) half_edges_[{vertex(f, k), vertex(f, k + 1)}] = {f, k};
    }

    int face_count() const { return static_cast<int>(flat_.faces.size()); }
    int degree(int face) const { return static_cast<int>(flat_.faces[face].size()); }
    int vertex(int face, int corner) const { return flat_.faces[face][(corner + degree(face)) % degree(face)]; }
    int corner_count(int face) const { return scheme_ == LCL_SCHEME_LOOP || is_quad(face) ? 1 : degree(face); }
    bool is_quad(int face) const { return scheme_ == LCL_SCHEME_CATMULL_CLARK && degree(face) == 4; }
    bool is_sharp(int face, int corner) const { return flat_.sharp.count(oracle::edge_of(vertex(face, corner), vertex(face, corner + 1))) != 0; }
    bool is_corner(int vertex) const { return flat_.corners.count(vertex) != 0; }
    /// Face and corner of the half-edge on the other side of an edge, or -1.
    std::pair<int, int> opposite(int face, int corner) const {
        const auto found = half_edges_.find({vertex(face, corner + 1), vertex(face, corner)});
        return found == half_edges_.end() ? std::pair{-1, 0} : found->second;
    }
    bool touches_sharp(int face, int corner) const {
        for (const auto& edge : flat_.sharp)
            if (edge.first == vertex(face, corner) || edge.second == vertex(face, corner)) return true;
        return is_corner(vertex(face, corner));
    }

    /// Places near every vertex of a face (Doo-Sabin: near the centre of the new face there, and beyond sharp sides), and one anywhere.
    void add_places(int face, const std::vector<double>& distances, shapes::Random& random, Places& places) const {
        for (int corner = 0; corner < corner_count(face); ++corner) {
            const auto sides = [&](double r) { return std::pair{r * random.next(), r * random.next()}; };
            for (const double r : distances) {
                const auto [a, b] = sides(r);
                places.add(face, corner, a, b);
            }
            if (scheme_ == LCL_SCHEME_LOOP || is_quad(face))
                for (int k = 1; k < degree(face); ++k) {
                    const auto [a, b] = sides(distances[random.below(static_cast<int>(distances.size()))]);
                    if (scheme_ == LCL_SCHEME_LOOP) places.add(face, 0, k == 1 ? 1 - a - b : b, k == 1 ? a : 1 - a - b);
                    else places.add(face, 0, k < 3 ? 1 - a : a, k > 1 ? 1 - b : b);
                }
            const auto [u, v] = sides(scheme_ == LCL_SCHEME_LOOP ? 0.5 : 1);
            places.add(face, corner, u, v);
            if (scheme_ != LCL_SCHEME_DOO_SABIN) continue;
            const bool below = is_sharp(face, corner), left = is_sharp(face, corner - 1 + degree(face));
            if (below) places.add(face, corner, u, -v);
            if (left) places.add(face, corner, -u, v);
            if (below && left && is_corner(vertex(face, corner))) places.add(face, corner, -u, -v);
        }
    }

private:
    oracle::Surface flat_;
    lcl_scheme scheme_;
    std::map<std::pair<int, int>, std::pair<int, int>> half_edges_;
};

/// A regular polygon's pyramid on both sides: 2 n triangles, two vertices of valence n.
shapes::Shape bipyramid(int n) {
    std::vector<shapes::Point> points{{0, 0, 0.7}, {0, 0, -0.6}};
    std::vector<shapes::Face> faces;
    for (int i = 0; i < n; ++i) {
        points.push_back({std::cos(2 * pi * i / n), std::sin(2 * pi * i / n), 0});
        faces.push_back({0, 2 + i, 2 + (i + 1) % n});
        faces.push_back({1, 2 + (i + 1) % n, 2 + i});
    }
    return shapes::make("bipyramid", points, faces);
}

/// 2 n quads, two vertices of valence n.
shapes::Shape trapezohedron(int n) {
    std::vector<shapes::Point> points{{0, 0, 0.7}, {0, 0, -0.6}};
    std::vector<shapes::Face> faces;
    const auto ring = [n](int i) { return 2 + i % (2 * n); };
    for (int i = 0; i < 2 * n; ++i) points.push_back({std::cos(pi * i / n), std::sin(pi * i / n), i % 2 == 0 ? 0.1 : -0.1});
    for (int i = 0; i < 2 * n; i += 2) {
        faces.push_back({0, ring(i), ring(i + 1), ring(i + 2)});
        faces.push_back({1, ring(i + 3), ring(i + 2), ring(i + 1)});
    }
    return shapes::make("trapezohedron", points, faces);
}

/// Two n-gons and a belt of quads, all valences 3.
shapes::Shape prism(int n) {
    std::vector<shapes::Point> points;
    std::vector<shapes::Face> faces(2);
    for (int i = 0; i < 2 * n; ++i) points.push_back({std::cos(2 * pi * i / n), std::sin(2 * pi * i / n), i < n ? -0.5 : 0.6});
    for (int i = 0; i < n; ++i) {
        faces[0].insert(faces[0].begin(), i);
        faces[1].push_back(n + i);
        faces.push_back({i, (i + 1) % n, n + (i + 1) % n, n + i});
    }
    return shapes::make("prism", points, faces);
}

/// One mesh with a component for every n, none of them symmetric: one surface serves all valences.
shapes::Shape family(const std::string& name, const std::function<shapes::Shape(int)>& member, const std::vector<int>& sizes) {
    shapes::Shape result;
    for (const int n : sizes) result = result.mesh.vertex_count == 0 ? member(n) : shapes::combined(result, member(n));
    result.name = name;
    return shapes::rough(result, 0.05, 11);
}

shapes::Shape together(const std::string& name, const std::vector<shapes::Shape>& list) {
    shapes::Shape result = list[0];
    for (std::size_t i = 1; i < list.size(); ++i) result = shapes::combined(result, list[i]);
    result.name = name;
    return shapes::rough(result, 0.05, 12);
}

const std::vector<int> valences{3, 4, 5, 6, 7, 8, 9, 10, 11, 12};

double largest(const Vector& a, const Vector& b, const Vector& c) { return std::max({a.norm(), b.norm(), c.norm()}); }

/// The values of the oracle with what follows from them.
struct Truth {
    Vector point, du, dv, normal, duu, duv, dvv;
    double gauss, mean;
    double first_size;   ///< of the larger first derivative
    double second_size;  ///< of the largest second derivative
    double sine;         ///< of the angle between the first derivatives, times the ratio of their lengths: how well they give a normal
    double bend;         ///< largest second derivative over the square of the smaller extent: what curvatures are made of

    explicit Truth(const oracle::SurfacePoint& at)
        : point(at.point.cast<double>()),
          du(at.du.cast<double>()),
          dv(at.dv.cast<double>()),
          duu(at.duu.cast<double>()),
          duv(at.duv.cast<double>()),
          dvv(at.dvv.cast<double>()) {
        const Vector cross = du.cross(dv);
        normal = cross.normalized();
        first_size = std::max(du.norm(), dv.norm());
        second_size = largest(duu, duv, dvv);
        sine = cross.norm() / (first_size * first_size);
        bend = second_size / (sine * sine * first_size * first_size);
        // Curvatures by the two fundamental forms; the normal looks outwards, so a sphere has L = -|S_u|^2 / r.
        const double e = du.dot(du), f = du.dot(dv), g = dv.dot(dv), l = duu.dot(normal), m = duv.dot(normal), n = dvv.dot(normal);
        gauss = (l * n - m * m) / (e * g - f * f);
        mean = -(e * n - 2 * f * m + g * l) / (2 * (e * g - f * f));
    }
};

/// How far from the nearest vertex of its patch a place lies, in parameters.
double distance_to_vertex(double u, double v) {
    const auto side = [](double x) { return std::min(std::abs(x - std::floor(x)), std::abs(x - std::ceil(x))); };
    return std::max(side(u), side(v));
}

/// Tolerances, with e the error that is allowed of a number of size 1 (double: 1e-10; float: derived where it is used):
/// - points: e times the model's size; first derivatives: e times the larger one there; second derivatives: e times the largest there, and what the rounding of
///   points 2^-k apart leaves, which are first differences of size |S_u| 2^-k: some eps |S_u| / distance, where distance 2^-k is that to the next vertex;
/// - normals and curvatures: what follows from those, by the angle between the first derivatives.
struct Tolerance {
    double relative = 1e-10, rounding = std::numeric_limits<double>::epsilon();
    double rounding_factor = 64;

    double second(const Truth& truth, double distance) const {
        return relative * truth.second_size + (distance > 0 ? rounding_factor * rounding * truth.first_size / distance : 0);
    }
};

template <class Real>
void check_place(const Values<Real>& values, std::size_t i, const Truth& truth, double distance, double size, const Tolerance& tolerance) {
    const auto difference = [&](const std::vector<Real>& rows, const Vector& exact) { return (Values<Real>::row(rows, i) - exact).norm(); };
    const double first = tolerance.relative * truth.first_size, second = tolerance.second(truth, distance);
    CHECK(difference(values.points, truth.point) <= tolerance.relative * size);
    CHECK(difference(values.du, truth.du) <= first);
    CHECK(difference(values.dv, truth.dv) <= first);
    CHECK(difference(values.duu, truth.duu) <= second);
    CHECK(difference(values.duv, truth.duv) <= second);
    CHECK(difference(values.dvv, truth.dvv) <= second);
    CHECK(difference(values.normals, truth.normal) <= 4 * tolerance.relative / truth.sine);
    // The curvatures' formulas are sums of at most six products of the derivatives' components, over the square of the area.
    const double share = 16 * (second / truth.second_size + tolerance.relative / truth.sine);
    CHECK(std::abs(values.gauss[i] - truth.gauss) <= share * truth.bend * truth.bend);
    CHECK(std::abs(values.mean[i] - truth.mean) <= share * truth.bend);
}

double model_size(const shapes::Shape& shape) { return oracle::positions(shape.mesh).cwiseAbs().maxCoeff(); }

/// A few faces of every kind, spread over the mesh.
Places places_of(const shapes::Shape& shape, const lcl_scheme_options& options, const std::vector<double>& distances, int stride = 1) {
    const Domains domains(shape, options);
    shapes::Random random(5);
    Places places;
    for (int f = 0; f < domains.face_count(); f += stride) domains.add_places(f, distances, random, places);
    return places;
}

void check_against_oracle(const shapes::Shape& shape, const lcl_scheme_options& options, const Places& places) {
    const auto truth = truth_of(shape, options);
    const auto values = evaluate(make_surface(shape, options), places);
    const double size = model_size(shape);
    for (std::size_t i = 0; i < places.count(); ++i) {
        const oracle::SurfacePoint at = truth.at(places.at(i));
        if (at.is_extraordinary) continue;
        CAPTURE(shape.name, name_of(options), places.faces[i], places.corners[i], places.uv[2 * i], places.uv[2 * i + 1], at.levels);
        check_place(values, i, Truth(at), distance_to_vertex(places.uv[2 * i], places.uv[2 * i + 1]), size, Tolerance{});
    }
}

/// The side of a face from corner k on, 0 <= t <= 1, as a place.
void add_on_side(const Domains& domains, lcl_scheme which, int face, int k, double t, Places& places) {
    if (which == LCL_SCHEME_LOOP) {
        const std::array<std::array<double, 2>, 3> uv{{{t, 0}, {1 - t, t}, {0, 1 - t}}};
        places.add(face, 0, uv[k][0], uv[k][1]);
    } else if (domains.is_quad(face)) {
        const std::array<std::array<double, 2>, 4> uv{{{t, 0}, {1, t}, {1 - t, 1}, {0, 1 - t}}};
        places.add(face, 0, uv[k][0], uv[k][1]);
    } else if (t <= 0.5) {
        places.add(face, k, 2 * t, 0);
    } else {
        places.add(face, (k + 1) % domains.degree(face), 0, 2 * (1 - t));
    }
}

/// Pairs of places that are the same point of the surface: on both sides of the edges of the mesh, and of those between the patches of a face.
std::pair<Places, Places> two_sides(const Domains& domains, lcl_scheme which) {
    Places here, there;
    for (int f = 0; f < domains.face_count(); ++f)
        for (int k = 0; k < domains.degree(f); ++k)
            for (const double t : {0.3125, 0.8, 1e-5}) {
                const auto [g, j] = domains.opposite(f, k);
                const int next = (k + 1) % domains.degree(f);
                if (domains.corner_count(f) > 1) {  // from the edge's middle to the face's centre
                    here.add(f, k, 1, t);
                    there.add(f, next, t, 1);
                }
                if (g < 0 || domains.is_sharp(f, k)) continue;
                if (which == LCL_SCHEME_DOO_SABIN) {  // from the new face at the vertex to that on the edge
                    here.add(f, k, t, 0);
                    there.add(g, (j + 1) % domains.degree(g), 0, t);
                } else {
                    add_on_side(domains, which, f, k, t, here);
                    add_on_side(domains, which, g, j, 1 - t, there);
                }
            }
    return {here, there};
}

}  // namespace

TEST_CASE("evaluation is exact at all valences, down to 1e-6 from the extraordinary point", "[evaluate]") {
    const std::vector<double> distances{1e-6, 1e-3, 0.1};
    SECTION("triangles") {
        const auto shape = family("bipyramids", bipyramid, valences);
        for (const auto& options : options_for(shape)) check_against_oracle(shape, options, places_of(shape, options, distances, 3));
    }
    SECTION("quads") {
        const auto shape = family("trapezohedra", trapezohedron, valences);
        for (const auto& options : options_for(shape)) check_against_oracle(shape, options, places_of(shape, options, distances, 3));
    }
    SECTION("faces of three to twelve sides") {
        const auto shape = family("prisms", prism, valences);
        for (const auto& options : options_for(shape)) {
            Places places = places_of(shape, options, distances, 11);
            if (options.scheme == LCL_SCHEME_DOO_SABIN) {  // the centre of the old face
                int face = 0;
                for (const int n : valences) {
                    for (const double r : distances) places.add(face, 1, 1 - 0.7 * r, 1 - 0.4 * r);
                    face += n + 2;
                }
            }
            check_against_oracle(shape, options, places);
        }
    }
}

TEST_CASE("evaluation is exact at valence 50", "[evaluate]") {
    const auto triangles = shapes::rough(bipyramid(50), 0.02, 3), quads = shapes::rough(trapezohedron(50), 0.02, 3),
               polygons = shapes::rough(prism(50), 0.02, 3);
    Places near_pole;
    for (const double r : {1e-6, 1e-2, 0.4}) near_pole.add(14, 0, 0.7 * r, 0.4 * r);
    check_against_oracle(triangles, scheme(LCL_SCHEME_LOOP), near_pole);
    check_against_oracle(quads, scheme(LCL_SCHEME_CATMULL_CLARK), near_pole);
    check_against_oracle(quads, doo_sabin(), near_pole);
    Places near_centre;
    for (const double r : {1e-6, 1e-2, 0.4}) near_centre.add(1, 17, 1 - 0.7 * r, 1 - 0.4 * r);
    check_against_oracle(polygons, scheme(LCL_SCHEME_CATMULL_CLARK, 0.5), near_centre);
    check_against_oracle(polygons, doo_sabin(LCL_MASK_CLASSIC), near_centre);
}

TEST_CASE("evaluation is exact at boundaries, creases, darts and corners", "[evaluate]") {
    const std::vector<double> distances{1e-6, 0.05, 0.5};
    SECTION("boundaries") {
        const auto quads = together("open quads", {shapes::grid_with_hole(), shapes::disk_pole_quads(5), shapes::cylinder_open(5, 2)});
        for (const auto& options : options_for(quads)) check_against_oracle(quads, options, places_of(quads, options, distances, 3));
        const auto triangles = together("open triangles", {shapes::grid_triangles(3, 3), shapes::disk_pole_triangles(7)});
        for (const auto& options : options_for(triangles)) check_against_oracle(triangles, options, places_of(triangles, options, distances, 3));
    }
    SECTION("creases, darts and corners of quads") {
        auto shape = together("sharp quads", {shapes::grid_with_creases(), shapes::cube_with_crease(), shapes::cube_with_dart(), shapes::torus_with_dart()});
        for (const auto& options : options_for(shape)) check_against_oracle(shape, options, places_of(shape, options, distances, 4));
    }
    SECTION("creases, darts and corners of triangles") {
        auto shape =
            together("sharp triangles", {shapes::grid_triangles_with_creases(), shapes::torus_triangles_with_dart(), shapes::icosphere_with_crease_loop()});
        for (const auto& options : options_for(shape)) {
            if (options.scheme == LCL_SCHEME_DOO_SABIN) continue;  // next to a corner inside, which the oracle does not offer
            check_against_oracle(shape, options, places_of(shape, options, distances, 9));
        }
    }
    SECTION("marked corners, and boundaries where all or none are corners") {
        for (const auto rule : {lcl::BoundaryRule::edge_and_corner, lcl::BoundaryRule::edge_only, lcl::BoundaryRule::fixed}) {
            auto shape = shapes::rough(shapes::grid_with_marked_corner(), 0.05, 4);
            shape.features.boundary = rule;
            for (const auto& options : {scheme(LCL_SCHEME_CATMULL_CLARK), scheme(LCL_SCHEME_CATMULL_CLARK, 0.5)})
                check_against_oracle(shape, options, places_of(shape, options, distances, 3));
            auto triangles = shapes::rough(shapes::grid_triangles(3, 2), 0.05, 4);
            triangles.features.boundary = rule;
            check_against_oracle(triangles, scheme(LCL_SCHEME_LOOP), places_of(triangles, scheme(LCL_SCHEME_LOOP), distances, 2));
        }
        auto rounded = shapes::rough(shapes::grid_quads(3, 3), 0.05, 5);
        rounded.features.boundary = lcl::BoundaryRule::edge_only;
        check_against_oracle(rounded, doo_sabin(), places_of(rounded, doo_sabin(), distances, 2));
    }
}

TEST_CASE("evaluation is exact on meshes of one face and on mixed polygons", "[evaluate]") {
    for (const auto& shape : {shapes::single_triangle(), shapes::single_quad(), shapes::single_hexagon()})
        for (const auto& options : options_for(shape)) check_against_oracle(shape, options, places_of(shape, options, {1e-6, 0.3}));
    const auto polygons = shapes::polygons_mixed(30, 6);
    for (const auto& options : options_for(polygons)) check_against_oracle(polygons, options, places_of(polygons, options, {1e-4, 0.5}, 7));
}

TEST_CASE("regular meshes are splines by their definition", "[evaluate]") {
    // A torus of random points: face 5 j + i lies between the columns i, i + 1 and the rows j, j + 1.
    auto torus = shapes::torus_quads(5, 4);
    shapes::Random random(9);
    for (double& x : torus.mesh.positions) x = random.symmetric();
    const auto control = [&](int i, int j) -> Vector {
        const int v = (j + 8) % 4 * 5 + (i + 10) % 5;
        return {torus.mesh.positions[3 * v], torus.mesh.positions[3 * v + 1], torus.mesh.positions[3 * v + 2]};
    };
    const auto cubic = [](double t) {
        t = std::abs(t);
        return t >= 2 ? 0.0 : t >= 1 ? std::pow(2 - t, 3) / 6 : 2.0 / 3 - t * t + t * t * t / 2;
    };
    const auto quadratic = [](double t) {
        t = std::abs(t);
        return t >= 1.5 ? 0.0 : t >= 0.5 ? (1.5 - t) * (1.5 - t) / 2 : 0.75 - t * t;
    };
    const auto spline = [&](double x, double y, const std::function<double(double)>& basis) {
        Vector sum = Vector::Zero();
        for (int i = static_cast<int>(x) - 2; i <= static_cast<int>(x) + 3; ++i)
            for (int j = static_cast<int>(y) - 2; j <= static_cast<int>(y) + 3; ++j) sum += basis(x - i) * basis(y - j) * control(i, j);
        return sum;
    };
    Places places;
    for (int f = 0; f < 20; ++f) places.add(f, 0, random.next(), random.next());
    const auto bicubic = evaluate(make_surface(torus, scheme(LCL_SCHEME_CATMULL_CLARK)), places);
    for (const auto mask : {LCL_MASK_CATMULL, LCL_MASK_CLASSIC}) {
        const auto biquadratic = evaluate(make_surface(torus, doo_sabin(mask)), places);
        for (std::size_t i = 0; i < places.count(); ++i) {
            const int f = places.faces[i];
            const double u = places.uv[2 * i], v = places.uv[2 * i + 1];
            // 36 products of numbers up to 1, and as many inside.
            CHECK((Values<double>::row(bicubic.points, i) - spline(f % 5 + u, f / 5 + v, cubic)).norm() < 1e-14);
            CHECK((Values<double>::row(biquadratic.points, i) - spline(f % 5 + u / 2, f / 5 + v / 2, quadratic)).norm() < 1e-14);
        }
    }
}

TEST_CASE("points and tangent planes are continuous across the borders of patches", "[evaluate]") {
    for (const auto& shape : {shapes::polygons_mixed(24, 8), shapes::grid_with_creases(), shapes::random_triangle_mesh(24, 9)})
        for (const auto& options : options_for(shape)) {
            CAPTURE(shape.name, name_of(options));
            const Domains domains(shape, options);
            const auto [here, there] = two_sides(domains, options.scheme);
            const auto surface = make_surface(shape, options);
            const auto a = evaluate(surface, here), b = evaluate(surface, there);
            for (std::size_t i = 0; i < here.count(); ++i) {
                CAPTURE(here.faces[i], here.corners[i], here.uv[2 * i], here.uv[2 * i + 1], there.faces[i], there.corners[i]);
                CHECK((Values<double>::row(a.points, i) - Values<double>::row(b.points, i)).norm() < 1e-13);
                const Vector cross = Values<double>::row(a.du, i).cross(Values<double>::row(a.dv, i));
                const double sine = cross.norm() / (Values<double>::row(a.du, i).norm() * Values<double>::row(a.dv, i).norm());
                CHECK((Values<double>::row(a.normals, i) - Values<double>::row(b.normals, i)).norm() < 1e-12 / sine);
            }
        }
}

TEST_CASE("limit surfaces follow affine maps and pass through the limit points", "[evaluate]") {
    const auto shape = shapes::polygons_mixed(30, 10), sharp = shapes::grid_with_creases(), triangles = shapes::random_triangle_mesh(30, 4);
    Eigen::Matrix3d map;
    map << 1, 2, 0.5, -0.25, 1, 3, 0, 1, -2;
    const Vector shift(100, -20, 3);
    for (const auto* mesh : {&shape, &sharp, &triangles})
        for (const auto& options : options_for(*mesh)) {
            CAPTURE(mesh->name, name_of(options));
            const Places places = places_of(*mesh, options, {1e-6, 0.2, 0.5}, 3);
            const auto surface = make_surface(*mesh, options);
            const auto before = evaluate(surface, places);
            const Eigen::MatrixXd points = (oracle::positions(mesh->mesh) * map.transpose()).rowwise() + shift.transpose();
            const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = points;
            succeed(lcl_limit_surface_set_points(surface.get(), rows.data(), 0));
            const auto after = evaluate(surface, places);
            for (std::size_t i = 0; i < places.count(); ++i) {
                const auto row = [i](const std::vector<double>& values) { return Values<double>::row(values, i); };
                CHECK((row(after.points) - map * row(before.points) - shift).norm() < 1e-12);
                CHECK((row(after.du) - map * row(before.du)).norm() < 1e-11 * std::max(1.0, row(before.du).norm()));
                CHECK((row(after.dv) - map * row(before.dv)).norm() < 1e-11 * std::max(1.0, row(before.dv).norm()));
            }
            // At a smooth vertex the first parameters of its corner are its limit point A x.
            const Domains domains(*mesh, options);
            Places vertices;
            std::vector<int> numbers;
            for (int f = 0; f < domains.face_count(); ++f) {
                if (domains.touches_sharp(f, 0)) continue;
                vertices.add(f, 0, 0, 0);
                numbers.push_back(domains.vertex(f, 0));
            }
            const auto limits = evaluate(surface, vertices);
            std::vector<double> expected(rows.size());
            succeed(lcl_limit_points(make_operator(*mesh, &options).get(), rows.data(), 0, 3, LCL_PRECISION_DOUBLE, expected.data(), 0));
            for (std::size_t i = 0; i < numbers.size(); ++i)
                CHECK((Values<double>::row(limits.points, i) - Values<double>::row(expected, numbers[i])).norm() < 1e-12);
        }
}

TEST_CASE("at an extraordinary point there are unit tangents and no second derivatives", "[evaluate]") {
    const auto triangles = family("bipyramids", bipyramid, {3, 5, 7, 12}), quads = family("trapezohedra", trapezohedron, {3, 5, 7, 12});
    const auto sharp = shapes::rough(shapes::grid_with_creases(), 0.05, 2);
    for (const auto* shape : {&triangles, &quads, &sharp})
        for (const auto& options : options_for(*shape)) {
            const Domains domains(*shape, options);
            Places places;
            for (int f = 0; f < domains.face_count(); ++f)
                if (domains.degree(f) == 4 || f % 6 == 0) places.add(f, 0, 0, 0);
            const auto truth = truth_of(*shape, options);
            const auto values = evaluate(make_surface(*shape, options), places);
            std::size_t seen = 0;
            for (std::size_t i = 0; i < places.count() && seen < 8; ++i) {
                const oracle::SurfacePoint at = truth.at(places.at(i));
                CAPTURE(shape->name, name_of(options), places.faces[i]);
                const auto row = [i](const std::vector<double>& rows) { return Values<double>::row(rows, i); };
                CHECK((row(values.points) - at.point.cast<double>()).norm() < 1e-10);
                if (!at.is_extraordinary) continue;
                ++seen;
                const Vector du = at.du.cast<double>(), dv = at.dv.cast<double>(), normal = du.cross(dv);
                // Where there is no tangent plane both sides have one direction, which they come to like 1 / level. At sharp features tangents come from powers
                // of the subdivision, of which 1e-7 of the next eigenvalue's part may be left.
                const double allowed = normal.norm() < 1e-3 ? 0.1 : domains.touches_sharp(places.faces[i], 0) ? 1e-7 : 1e-9;
                CHECK(row(values.du).norm() == Approx(1).margin(1e-14));
                CHECK(row(values.dv).norm() == Approx(1).margin(1e-14));
                CHECK((row(values.du) - du).norm() < allowed);
                CHECK((row(values.dv) - dv).norm() < allowed);
                if (normal.norm() > 1e-3) CHECK((row(values.normals) - normal.normalized()).norm() < 4 * allowed / normal.norm());
                for (const auto* rows : {&values.duu, &values.duv, &values.dvv}) CHECK(row(*rows).array().isNaN().all());
                CHECK(std::isnan(values.gauss[i]));
                CHECK(std::isnan(values.mean[i]));
            }
            CHECK(seen >= 4);
        }
}

TEST_CASE("a sphere bends away from its outward normal", "[evaluate]") {
    for (const auto& [shape, which] : {std::pair{shapes::icosphere_quads(2), LCL_SCHEME_CATMULL_CLARK}, std::pair{shapes::icosphere(2), LCL_SCHEME_LOOP},
                                       std::pair{shapes::icosphere_quads(2), LCL_SCHEME_DOO_SABIN}}) {
        const auto options = scheme(which);
        const Places places = places_of(shape, options, {0.5}, 17);
        const auto values = evaluate(make_surface(shape, options), places);
        for (std::size_t i = 0; i < places.count(); ++i) {
            CAPTURE(name_of(options), places.faces[i]);
            const Vector point = Values<double>::row(values.points, i), normal = Values<double>::row(values.normals, i);
            CHECK(point.normalized().dot(normal) > 0.99);
            CHECK(values.mean[i] > 0);
            CHECK(values.gauss[i] > 0);
            if (which == LCL_SCHEME_DOO_SABIN) continue;  // its curvature has no bound at extraordinary faces
            // The control net of a sphere of radius 1 has edges of 0.15 to 0.3: its surface bends by some tenths more or less.
            CHECK(values.mean[i] == Approx(1).margin(0.5));
        }
    }
}

TEST_CASE("samples are found once and follow new points", "[evaluate]") {
    const auto shape = shapes::polygons_mixed(30, 12);
    const auto options = scheme(LCL_SCHEME_CATMULL_CLARK);
    const auto surface = make_surface(shape, options);
    const Places some = places_of(shape, options, {0.01, 1}, 4), others = places_of(shape, options, {0.3}, 3);
    const auto first = make_samples(surface, some), second = make_samples(surface, others);
    const auto values_at = [](const Samples& samples, std::size_t count) {
        Values<double> values(count);
        const lcl_surface_values arrays = values.arrays();
        succeed(lcl_samples_evaluate(samples.get(), &arrays));
        return values;
    };
    CHECK(values_at(second, others.count()).points == evaluate(surface, others).points);
    CHECK(values_at(first, some.count()).duv == evaluate(surface, some).duv);
    const auto moved = shapes::rough(shape, 0.1, 3);
    std::vector<double> wide;  // rows four values apart
    for (int v = 0; v < shape.mesh.vertex_count; ++v)
        wide.insert(wide.end(), {moved.mesh.positions[3 * v], moved.mesh.positions[3 * v + 1], moved.mesh.positions[3 * v + 2], 9});
    succeed(lcl_limit_surface_set_points(surface.get(), wide.data(), 4));
    const auto fresh = make_surface(moved, options);
    CHECK(values_at(first, some.count()).points == evaluate(fresh, some).points);
    CHECK(values_at(second, others.count()).normals == evaluate(fresh, others).normals);
    // The samples keep the surface alive, and arrays that are not wanted may be left out.
    const auto alive = make_samples(make_surface(shape, options), some);
    std::vector<double> points(3 * some.count());
    lcl_surface_values only_points = LCL_SURFACE_VALUES_INIT;
    only_points.points = points.data();
    succeed(lcl_samples_evaluate(alive.get(), &only_points));
    CHECK(largest_difference(points, evaluate(make_surface(shape, options), some).points) < 1e-14);
    std::vector<double> mean(some.count());
    lcl_surface_values only_mean = LCL_SURFACE_VALUES_INIT;
    only_mean.mean = mean.data();
    succeed(lcl_samples_evaluate(alive.get(), &only_mean));
    CHECK(largest_difference(mean, evaluate(make_surface(shape, options), some).mean) < 1e-12);
    const Places none;
    const auto empty = make_samples(surface, none);
    succeed(lcl_samples_evaluate(empty.get(), &only_points));
}

TEST_CASE("a large batch gives the values of small ones", "[evaluate]") {
    const auto shape = shapes::grid_with_creases();
    for (const auto& options : options_for(shape)) {
        const Domains domains(shape, options);
        shapes::Random random(21);
        Places places;
        for (int i = 0; i < 70000; ++i) {
            const int face = random.below(domains.face_count());
            places.add(face, random.below(domains.corner_count(face)), random.next(), random.next());
        }
        const auto surface = make_surface(shape, options);
        const auto all = evaluate(surface, places);
        for (const std::size_t first : {std::size_t(0), std::size_t(33333), std::size_t(69990)}) {
            const Places part = places.part(first, 64);
            const auto few = evaluate(surface, part);
            const std::vector<double> same(all.duu.begin() + 3 * first, all.duu.begin() + 3 * (first + part.count()));
            const std::vector<double> points(all.points.begin() + 3 * first, all.points.begin() + 3 * (first + part.count()));
            CHECK(largest_difference(few.points, points) < 1e-14);
            CHECK(largest_difference(few.duu, same) < 1e-11);
        }
    }
}

TEST_CASE("single precision is good to the rounding of floats", "[evaluate]") {
    const auto shape = family("trapezohedra", trapezohedron, {3, 5, 8});
    for (const auto& options : options_for(shape)) {
        const Places places = places_of(shape, options, {1e-3, 0.1, 1}, 3);
        const auto truth = truth_of(shape, options);
        const auto surface = make_surface(shape, options, LCL_PRECISION_SINGLE);
        const auto values = evaluate<float>(surface, places);
        const auto as_doubles = evaluate(surface, places);
        const double size = model_size(shape), eps = std::numeric_limits<float>::epsilon();
        for (std::size_t i = 0; i < places.count(); ++i) {
            CAPTURE(name_of(options), places.faces[i], places.corners[i], places.uv[2 * i], places.uv[2 * i + 1]);
            const Truth exact(truth.at(places.at(i)));
            const auto difference = [&](const std::vector<float>& rows, const Vector& of) { return (Values<float>::row(rows, i) - of).norm(); };
            // Control points are floats, eps of the size each; a point is a mean of at most some thirty of them, a first derivative has weights of up to 4, by
            // the size of the derivatives near there (which grow or fall with the distance from the vertex).
            CHECK(difference(values.points, exact.point) < 4 * eps * size);
            CHECK(difference(values.du, exact.du) < 32 * eps * (size + exact.first_size));
            CHECK(difference(values.dv, exact.dv) < 32 * eps * (size + exact.first_size));
            CHECK((Values<double>::row(as_doubles.points, i) - exact.point).norm() < 4 * eps * size);
            if (exact.sine > 0.1 && exact.first_size > 0.1) CHECK(difference(values.normals, exact.normal) < 256 * eps * size);
        }
    }
}

TEST_CASE("places that are not there are refused by name", "[evaluate]") {
    struct Bad {
        int face, corner;
        double u, v;
    };
    const auto refuse_places = [](const shapes::Shape& shape, const lcl_scheme_options& options, const std::vector<Bad>& list) {
        const auto surface = make_surface(shape, options);
        for (const Bad& bad : list) {
            CAPTURE(shape.name, name_of(options), bad.face, bad.corner, bad.u, bad.v);
            Places places;
            for (int i = 0; i < 3; ++i) places.add(0, 0, 0.25, 0.25);
            places.add(bad.face, bad.corner, bad.u, bad.v);
            places.add(-7, 0, 0, 0);  // not the first
            lcl_samples samples = nullptr;
            refuse(lcl_samples_create(surface.get(), places.count(), places.faces.data(), places.corners.data(), places.uv.data(), &samples),
                   LCL_ERROR_BAD_INPUT, "place 3");
            CHECK(samples == nullptr);
            Values<double> values(places.count());
            const lcl_surface_values arrays = values.arrays();
            refuse(lcl_limit_surface_evaluate(surface.get(), places.count(), places.faces.data(), places.corners.data(), places.uv.data(), &arrays),
                   LCL_ERROR_BAD_INPUT, "place 3");
        }
    };
    const double inf = std::numeric_limits<double>::infinity();
    const std::vector<Bad> everywhere{{-1, 0, 0, 0},    {1000, 0, 0, 0},  {0, -1, 0, 0},        {0, 4, 0, 0},
                                      {0, 0, 1.001, 0}, {0, 0, 0, 1.001}, {0, 0, nan_value, 0}, {0, 0, 0, inf}};
    std::vector<Bad> closed = everywhere;
    closed.insert(closed.end(), {{0, 0, -1e-9, 0}, {0, 0, 0, -1e-9}});
    std::vector<Bad> triangles = closed;
    triangles.push_back({0, 0, 0.6, 0.6});
    triangles.push_back({0, 1, 0.1, 0.1});
    std::vector<Bad> quads = closed;
    quads.push_back({0, 1, 0.1, 0.1});
    refuse_places(shapes::cube(), scheme(LCL_SCHEME_CATMULL_CLARK), quads);
    refuse_places(shapes::octahedron(), scheme(LCL_SCHEME_LOOP), triangles);
    refuse_places(shapes::cube(), doo_sabin(), closed);
    refuse_places(shapes::polygons_mixed(20, 2), scheme(LCL_SCHEME_CATMULL_CLARK), {{0, 10, 0, 0}});
    // Face 1 of the open grid has its first side on the boundary, no other.
    refuse_places(shapes::grid_quads(3, 3), doo_sabin(), {{1, 0, -0.5, 0.5}, {1, 0, 0.5, -1.001}, {1, 1, 0.5, -0.5}, {1, 2, 0.5, -0.5}, {1, 2, -0.5, 0.5}});
    // Where no corner is kept, the curve cuts it off.
    auto rounded = shapes::single_quad();
    rounded.features.boundary = lcl::BoundaryRule::edge_only;
    refuse_places(rounded, doo_sabin(), {{0, 0, -0.5, -0.5}});
}

TEST_CASE("surfaces that are not offered and null pointers are refused", "[evaluate]") {
    const Mesh mesh = make_mesh(shapes::cube());
    lcl_limit_surface handle = nullptr;
    auto options = scheme(LCL_SCHEME_CATMULL_CLARK, 0, 0.3);
    refuse(lcl_limit_surface_create(default_context(), mesh.get(), &options, LCL_PRECISION_DOUBLE, &handle), LCL_ERROR_INVALID_ARGUMENT, "lambda");
    options = scheme(LCL_SCHEME_CATMULL_CLARK);
    const std::int32_t some[] = {1};
    options.subset = some, options.subset_count = 1;
    refuse(lcl_limit_surface_create(default_context(), mesh.get(), &options, LCL_PRECISION_DOUBLE, &handle), LCL_ERROR_INVALID_ARGUMENT, "subset");
    options = scheme(LCL_SCHEME_CATMULL_CLARK);
    options.owned = some, options.owned_count = 1;
    refuse(lcl_limit_surface_create(default_context(), mesh.get(), &options, LCL_PRECISION_DOUBLE, &handle), LCL_ERROR_INVALID_ARGUMENT, "owned");
    options = scheme(LCL_SCHEME_CATMULL_CLARK);
    options.alpha_auto = 1;
    refuse(lcl_limit_surface_create(default_context(), mesh.get(), &options, LCL_PRECISION_DOUBLE, &handle), LCL_ERROR_INVALID_ARGUMENT, "alpha");
    options = scheme(LCL_SCHEME_LOOP);
    refuse(lcl_limit_surface_create(default_context(), mesh.get(), &options, LCL_PRECISION_DOUBLE, &handle), LCL_ERROR_BAD_INPUT, "");
    CHECK(lcl_limit_surface_create(nullptr, mesh.get(), nullptr, LCL_PRECISION_DOUBLE, &handle) == LCL_ERROR_INVALID_ARGUMENT);
    CHECK(lcl_limit_surface_create(default_context(), nullptr, nullptr, LCL_PRECISION_DOUBLE, &handle) == LCL_ERROR_INVALID_ARGUMENT);
    CHECK(lcl_limit_surface_create(default_context(), mesh.get(), nullptr, LCL_PRECISION_DOUBLE, nullptr) == LCL_ERROR_INVALID_ARGUMENT);
    CHECK(lcl_limit_surface_create(default_context(), make_mesh(shapes::no_faces()).get(), nullptr, LCL_PRECISION_DOUBLE, &handle) == LCL_ERROR_BAD_INPUT);
    CHECK(handle == nullptr);

    const auto surface = make_surface(shapes::cube(), scheme(LCL_SCHEME_CATMULL_CLARK));
    const std::int32_t face = 0;
    const double uv[] = {0.5, 0.5};
    lcl_samples samples = nullptr;
    CHECK(lcl_samples_create(surface.get(), 1, nullptr, nullptr, uv, &samples) == LCL_ERROR_INVALID_ARGUMENT);
    CHECK(lcl_samples_create(surface.get(), 1, &face, nullptr, nullptr, &samples) == LCL_ERROR_INVALID_ARGUMENT);
    CHECK(lcl_samples_create(nullptr, 1, &face, nullptr, uv, &samples) == LCL_ERROR_INVALID_ARGUMENT);
    CHECK(lcl_samples_create(surface.get(), 1, &face, nullptr, uv, nullptr) == LCL_ERROR_INVALID_ARGUMENT);
    CHECK(lcl_samples_evaluate(nullptr, nullptr) == LCL_ERROR_INVALID_ARGUMENT);
    CHECK(lcl_limit_surface_evaluate(surface.get(), 1, &face, nullptr, uv, nullptr) == LCL_ERROR_INVALID_ARGUMENT);
    CHECK(lcl_limit_surface_set_points(surface.get(), nullptr, 0) == LCL_ERROR_INVALID_ARGUMENT);
    std::vector<double> points(24, 1.0);
    points[10] = nan_value;
    refuse(lcl_limit_surface_set_points(surface.get(), points.data(), 0), LCL_ERROR_BAD_INPUT, "point 3");
    lcl_limit_surface_release(nullptr);
    lcl_samples_release(nullptr);
    // Corners may be left out: all 0.
    double point[3];
    lcl_surface_values values = LCL_SURFACE_VALUES_INIT;
    values.points = point;
    succeed(lcl_limit_surface_evaluate(surface.get(), 1, &face, nullptr, uv, &values));
    CHECK(point[2] < 0);  // face 0 is the lower one
}

TEST_CASE("kernels of exact evaluation on tiny meshes", "[evaluate][tiny]") {
    for (const auto& [shape, options] : {std::pair{shapes::octahedron(), scheme(LCL_SCHEME_LOOP)}, std::pair{shapes::cube(), scheme(LCL_SCHEME_CATMULL_CLARK)},
                                         std::pair{shapes::single_quad(), doo_sabin()}}) {
        Places places;
        places.add(0, 0, 0, 0);
        places.add(0, 0, 0.3, 0.2);
        places.add(0, 0, 0.01, 0.03);
        const auto truth = truth_of(shape, options);
        const auto values = evaluate<float>(make_surface(shape, options, LCL_PRECISION_SINGLE), places);
        for (std::size_t i = 0; i < places.count(); ++i) CHECK((Values<float>::row(values.points, i) - truth.point(places.at(i)).cast<double>()).norm() < 1e-6);
    }
}
