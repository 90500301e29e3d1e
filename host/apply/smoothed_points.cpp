// SPDX-License-Identifier: BSD-3-Clause
#include "host/apply/smoothed_points.h"

#include "host/apply/host_operator.h"
#include "host/field/channels.h"

namespace lcl {

std::vector<double> smoothed_points(const PolygonMesh& mesh, const Topology& topology, const Features& features, int times) {
    SchemeOptions scheme;
    if (topology.uniform_degree == 3) scheme.scheme = Scheme::loop;
    const Plan plan = build_plan(mesh, topology, features, scheme, {});
    const Transform transform = fit_transform(plan, mesh.positions.data(), 3, 3);
    std::vector<double> points = to_plan_order(plan, transform, mesh.positions.data(), 3, 3);
    for (int time = 0; time < times; ++time) {
        points = host_apply(plan, points, 3);
        std::vector<double> rest = points;
        for (int power = 0; power < 3; ++power) {
            const std::vector<double> limit = host_apply(plan, rest, 3);
            for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= limit[i];
        }
        for (std::size_t i = 0; i < rest.size(); ++i) points[i] -= rest[i];
    }
    std::vector<double> out(points.size());
    from_plan_order(plan, {{0, 0, 0}, {1, 1, 1}}, points, 3, out.data(), 3);
    return out;
}

}  // namespace lcl
