// SPDX-License-Identifier: BSD-3-Clause
// Point clouds sampled from analytic shapes whose distance is known, with the triangulation that the sampling itself suggests, and an engine that gives it: so
// surfaces from points are tested without any library that finds surfaces.
#pragma once

#include <functional>
#include <vector>

#include <limitcl/limitcl_engine.h>

#include "tests/shapes/shapes.h"

namespace shapes {

struct SampledShape {
    Shape shape;                                   ///< triangles; its positions are the points
    std::function<double(const Point&)> distance;  ///< signed, of any point of space, positive outside
};

SampledShape sphere_cloud(int levels);                 ///< radius 1: 10 * 4^levels + 2 points
SampledShape torus_cloud(int m, int n);                ///< radii 1 and 0.4: m * n points
SampledShape rounded_box_cloud(int n, double radius);  ///< [-1, 1]^3 with edges of that radius: n * n points a side
SampledShape blend_cloud(int m, int n);                ///< two spheres melted into each other: a surface of revolution of m * n + 2 points
SampledShape wave_cloud(int n);                        ///< open: z = 0.1 sin(3 x) cos(3 y) over [-1, 1]^2, n * n points
Shape two_parts(const Shape& first, const Shape& second, const Point& away);  ///< both, the second one moved

/// Moves each point along a random direction by at most that much.
void add_noise(Shape& shape, double size, std::uint64_t seed);

/// An engine that answers with the faces of a mesh on the points that it gets, whose order must be the mesh's.
class KnownEngine {
public:
    explicit KnownEngine(const Shape& shape);
    const lcl_engine& engine() const { return engine_; }
    std::vector<std::int32_t> triangles;
    std::vector<std::int32_t> outliers;  ///< left out
    std::vector<double> own_points;      ///< given instead of the cloud's where not empty
    std::string seen_options;            ///< "key=value;" of the last run

private:
    static std::int32_t run(void* user, const lcl_engine_points* points, const lcl_engine_option* options, std::size_t option_count,
                            const lcl_engine_sink* sink);
    lcl_engine engine_{};
};

}  // namespace shapes
