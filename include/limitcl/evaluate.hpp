// SPDX-License-Identifier: BSD-3-Clause
// Exact points, derivatives, normals and curvatures anywhere on the limit surface, and its closest points.
//
//     limitcl::LimitSurface surface(context, mesh);
//     limitcl::Places places;
//     places.add(7, 0.25, 0.5);                                  // face, u, v: limitcl.h says where that is
//     std::vector<double> normals = surface.evaluate(places).normals;
#ifndef LIMITCL_EVALUATE_HPP
#define LIMITCL_EVALUATE_HPP

#include "limit_operator.hpp"
#include "refine.hpp"

namespace limitcl {

/// Places on a surface, in the parameters of limitcl.h ("the limit surface itself").
struct Places {
    std::vector<std::int32_t> faces;    ///< count
    std::vector<std::int32_t> corners;  ///< empty: all 0; else count
    std::vector<double> uv;             ///< count x 2

    Places() = default;
    /// Where the vertices of a refined mesh lie; isolated vertices lie nowhere and are refused where the places are used.
    Places(const Locations& locations) : faces(locations.faces), corners(locations.corners), uv(locations.uv) {}
    std::size_t size() const { return faces.size(); }
    void add(std::int32_t face, double u, double v, std::int32_t corner = 0);
};

/// What is computed at places: points alone, first derivatives and normals too, or also second derivatives and curvatures.
enum class Derivatives { none, first, second };

/// Values at places, one row each, model units by parameter. Vectors that were not asked for are empty. NaN where a value does not exist; at an extraordinary
/// point du and dv are unit tangents along the patch's sides.
struct SurfaceValues {
    std::vector<double> points;         ///< count x 3
    std::vector<double> du, dv;         ///< count x 3
    std::vector<double> normals;        ///< count x 3: unit, du x dv
    std::vector<double> duu, duv, dvv;  ///< count x 3
    std::vector<double> gauss, mean;    ///< count: curvatures; mean > 0 where the surface bends away from the normal (1/r on a sphere)
};

/// The closest point of a surface for each of some points.
struct ClosestPoints {
    Places places;
    std::vector<double> points, normals;  ///< count x 3
    std::vector<double> distances;        ///< count: signed, positive on the normal's side
};

/// The limit surface of a mesh as patches, with its control points on a context's device. Copies share it.
class LimitSurface {
public:
    /// Linear time; the mesh's points are the control points, and it may change or go afterwards. Precision::mixed is double where the device has it.
    /// Errors: LCL_ERROR_BAD_INPUT (mesh not sound, wrong face degree), LCL_ERROR_INVALID_ARGUMENT (lambda, alpha_auto, subset, owned), LCL_ERROR_MEMORY.
    LimitSurface(const Context& context, const Mesh& mesh, const SchemeOptions& options = {}, Precision precision = Precision::mixed);

    lcl_limit_surface get() const { return handle_.get(); }
    int vertex_count() const { return vertex_count_; }
    /// New control points for the same faces: vertex_count x 3. Samples that were made before follow.
    void set_points(ArrayView<double> points);
    /// Values at places. Error LCL_ERROR_BAD_INPUT names the first that does not exist.
    SurfaceValues evaluate(const Places& places, Derivatives derivatives = Derivatives::first) const;
    /// Closest points for count x 3 coordinates. Error LCL_ERROR_BAD_INPUT where they are not finite.
    ClosestPoints closest(ArrayView<double> points) const;

private:
    LimitSurfaceHandle handle_;
    int vertex_count_ = 0;
};

/// Places that are found once and evaluated often, on the device. Copies share them; they keep the surface alive.
class Samples {
public:
    /// Error LCL_ERROR_BAD_INPUT names the first place that does not exist.
    Samples(const LimitSurface& surface, const Places& places);

    lcl_samples get() const { return handle_.get(); }
    std::size_t size() const { return count_; }
    SurfaceValues evaluate(Derivatives derivatives = Derivatives::first) const;

private:
    SamplesHandle handle_;
    std::size_t count_ = 0;
};

inline void Places::add(std::int32_t face, double u, double v, std::int32_t corner) {
    if (corner != 0 && corners.empty()) corners.resize(faces.size());
    if (corner != 0 || !corners.empty()) corners.push_back(corner);
    faces.push_back(face);
    uv.push_back(u);
    uv.push_back(v);
}

namespace detail {

/// Makes room for `count` rows. The struct points into `values`.
inline lcl_surface_values room_for(SurfaceValues& values, std::size_t count, Derivatives derivatives) {
    const auto room = [count](std::vector<double>& rows, std::size_t width) {
        rows.resize(count * width);
        return rows.data();
    };
    lcl_surface_values c = LCL_SURFACE_VALUES_INIT;
    c.points = room(values.points, 3);
    if (derivatives == Derivatives::none) return c;
    c.du = room(values.du, 3);
    c.dv = room(values.dv, 3);
    c.normals = room(values.normals, 3);
    if (derivatives == Derivatives::first) return c;
    c.duu = room(values.duu, 3);
    c.duv = room(values.duv, 3);
    c.dvv = room(values.dvv, 3);
    c.gauss = room(values.gauss, 1);
    c.mean = room(values.mean, 1);
    return c;
}

/// The corners as the C API takes them. Error LCL_ERROR_INVALID_ARGUMENT for sizes that differ.
inline const std::int32_t* corners_of(const Places& places) {
    if (places.uv.size() != 2 * places.size() || (!places.corners.empty() && places.corners.size() != places.size()))
        throw Error(LCL_ERROR_INVALID_ARGUMENT, "the places have " + std::to_string(places.size()) + " faces, " + std::to_string(places.corners.size()) +
                                                    " corners and " + std::to_string(places.uv.size()) + " parameters: two of these a face");
    return places.corners.empty() ? nullptr : places.corners.data();
}

}  // namespace detail

inline LimitSurface::LimitSurface(const Context& context, const Mesh& mesh, const SchemeOptions& options, Precision precision)
    : vertex_count_(mesh.vertex_count()) {
    detail::require_ratios(options, mesh);
    const lcl_scheme_options c = options.to_c();
    lcl_limit_surface surface = nullptr;
    check(lcl_limit_surface_create(context.get(), mesh.get(), &c, static_cast<lcl_precision>(precision), &surface));
    handle_ = LimitSurfaceHandle(surface);
}

inline void LimitSurface::set_points(ArrayView<double> points) {
    if (points.size() != 3 * static_cast<std::size_t>(vertex_count_))
        throw Error(LCL_ERROR_INVALID_ARGUMENT,
                    std::to_string(points.size()) + " coordinates were given, " + std::to_string(vertex_count_) + " vertices need three each");
    check(lcl_limit_surface_set_points(get(), points.data(), 0));
}

inline SurfaceValues LimitSurface::evaluate(const Places& places, Derivatives derivatives) const {
    SurfaceValues values;
    const std::int32_t* corners = detail::corners_of(places);
    const lcl_surface_values c = detail::room_for(values, places.size(), derivatives);
    check(lcl_limit_surface_evaluate(get(), places.size(), places.faces.data(), corners, places.uv.data(), &c));
    return values;
}

inline ClosestPoints LimitSurface::closest(ArrayView<double> points) const {
    if (points.size() % 3 != 0) throw Error(LCL_ERROR_INVALID_ARGUMENT, std::to_string(points.size()) + " coordinates were given: a point has three");
    const std::size_t count = points.size() / 3;
    ClosestPoints result;
    result.places.faces.resize(count);
    result.places.corners.resize(count);
    result.places.uv.resize(2 * count);
    result.points.resize(3 * count);
    result.normals.resize(3 * count);
    result.distances.resize(count);
    lcl_closest_points c = LCL_CLOSEST_POINTS_INIT;
    c.faces = result.places.faces.data();
    c.corners = result.places.corners.data();
    c.uv = result.places.uv.data();
    c.points = result.points.data();
    c.normals = result.normals.data();
    c.distances = result.distances.data();
    check(lcl_limit_surface_closest(get(), count, points.data(), 0, &c));
    return result;
}

inline Samples::Samples(const LimitSurface& surface, const Places& places) : count_(places.size()) {
    const std::int32_t* corners = detail::corners_of(places);
    lcl_samples samples = nullptr;
    check(lcl_samples_create(surface.get(), places.size(), places.faces.data(), corners, places.uv.data(), &samples));
    handle_ = SamplesHandle(samples);
}

inline SurfaceValues Samples::evaluate(Derivatives derivatives) const {
    SurfaceValues values;
    const lcl_surface_values c = detail::room_for(values, count_, derivatives);
    check(lcl_samples_evaluate(get(), &c));
    return values;
}

}  // namespace limitcl

#endif
