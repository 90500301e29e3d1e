// SPDX-License-Identifier: BSD-3-Clause
// Values of the kernels of evaluation against plain evaluation in double, in regular patches and in every kind of irregular ones, float and double.
#include <algorithm>
#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include "host/evaluate/device_surface.h"
#include "host/evaluate/reference.h"
#include "tests/shapes/shapes.h"
#include "tests/solver_support.h"

using namespace lcl;

namespace {

struct Sizes {
    std::size_t samples = 300;
    double smallest = 1e-6;  // distance of places from the corners of faces
};

/// Places all over the faces: anywhere inside, near corners (at all scales down to `smallest`) and at corners.
struct RandomPlaces {
    std::vector<Index> faces, corners;
    std::vector<double> uv;

    RandomPlaces(const PolygonMesh& mesh, Scheme scheme, const Sizes& sizes) {
        std::mt19937 random(1);
        std::uniform_real_distribution<double> uniform(0, 1);
        for (std::size_t i = 0; i < sizes.samples; ++i) {
            const Index face = static_cast<Index>(random() % static_cast<unsigned>(mesh.face_count())), degree = mesh.degree(face);
            faces.push_back(face);
            corners.push_back(
                scheme == Scheme::loop || (scheme == Scheme::catmull_clark && degree == 4) ? 0 : static_cast<Index>(random() % static_cast<unsigned>(degree)));
            double u = uniform(random), v = uniform(random);
            if (scheme == Scheme::loop && u + v > 1) u = 1 - u, v = 1 - v;
            const double shrink = i % 3 == 1 ? std::pow(sizes.smallest, uniform(random)) : i % 3 == 2 && i % 5 == 0 ? 0 : 1;
            const bool from_far = scheme == Scheme::doo_sabin;  // whose extraordinary points lie at all four corners
            const double corner_u = from_far && random() % 2 ? 1 : 0, corner_v = from_far && random() % 2 ? 1 : 0;
            uv.push_back(corner_u + shrink * (u - corner_u));
            uv.push_back(corner_v + shrink * (v - corner_v));
        }
    }
    Places all() const { return {faces.size(), faces.data(), corners.data(), uv.data()}; }
};

struct Values {
    std::vector<double> of[9];
    SurfaceValues arrays(std::size_t count) {
        for (int q = 0; q < 9; ++q) of[q].assign((q < 7 ? 3 : 1) * count, -1e300);
        return {false, of[0].data(), of[1].data(), of[2].data(), of[6].data(), of[3].data(), of[4].data(), of[5].data(), of[7].data(), of[8].data()};
    }
    Eigen::Vector3d row(int q, std::size_t i) const { return Eigen::Map<const Eigen::Vector3d>(&of[q][3 * i]); }
};

class EvaluationCheck {
public:
    EvaluationCheck(const shapes::Shape& shape, Scheme scheme, Real real, double dense_operations = least_dense_operations)
        : unit_(std::ldexp(1, real == Real::single ? -24 : -53)) {
        SchemeOptions options;
        options.scheme = scheme;
        const Topology topology = build_topology(shape.mesh);
        table_ = build_patch_table(topology, find_features(shape.mesh, topology, shape.features), options);
        control_ = control_points(table_, shape.mesh.positions, 3);
        surface_ = std::make_unique<DeviceSurface>(solver_test::device_context(), table_, real, dense_operations);
        surface_->set_points(shape.mesh.positions.data(), 3);
        places_ = std::make_unique<RandomPlaces>(shape.mesh, scheme, Sizes());
    }

    void check() {
        evaluate();
        surface_->prepare_for(std::size_t{1} << 24);  // the outer rings become regular patches
        evaluate();
    }

private:
    void evaluate() {
        const Places all = places_->all();
        Values values;
        const SurfaceValues to = values.arrays(all.count);
        surface_->evaluate(surface_->make_samples(all, 0, all.count), to);
        std::vector<PatchPlace> found(all.count);
        locate(table_, all, 0, all.count, found.data());
        for (std::size_t i = 0; i < all.count; ++i) check_sample(found[i], values, i);
    }

    /// At sharp features limit tangents are read from the deepest ring of the table, where they have not settled everywhere.
    void check_at_tip(int q, bool at_sharp_feature, const Eigen::Vector3d& value, const Eigen::Vector3d& right) {
        if (q > 2) CHECK(value.hasNaN());
        else if (!at_sharp_feature) CHECK((value - right).norm() <= 300 * unit_);
        else if (!value.hasNaN()) CHECK(std::abs(value.norm() - 1) <= 10 * unit_);
    }

    /// Points are at most a diagonal away from their centre; B-spline weights of first derivatives by (u, v) add up to at most 4 in size (patches are half or a
    /// quarter of a face), of second ones to 16, which grow like the rings' number of cells. 300 u: sums of up to 70 products, twice (projection, cell).
    void check_sample(const PatchPlace& place, const Values& values, std::size_t i) {
        const SurfaceJet expected = reference_jet(table_, control_, place);
        const bool is_tip = table_.kind[place.patch] >= 0 && place.s == 0 && place.t == 0;
        const double size = is_tip ? 1 : std::max({place.s, place.t, 1e-300}), ring = table_.kind[place.patch] >= 0 ? std::max(1.0, 1 / size) : 1;
        for (int q = 0; q < 6; ++q) {
            const Eigen::Vector3d value = values.row(q, i), right(expected[q][0], expected[q][1], expected[q][2]);
            INFO("sample " << i << " value " << q << " in patch " << place.patch << " of kind " << table_.kind[place.patch] << " at " << place.s << ", "
                           << place.t);
            if (is_tip && q > 0) {
                check_at_tip(q, table_.kinds[table_.kind[place.patch]].orbits.empty(), value, right);
            } else {
                const double scale = surface_->size() * (q == 0 ? 1 : q < 3 ? 4 : 16) * (q > 2 ? ring : 1);
                CHECK((value - right).norm() <= 300 * unit_ * scale);
            }
        }
    }

    double unit_;
    PatchTable table_;
    std::vector<double> control_;
    std::unique_ptr<DeviceSurface> surface_;
    std::unique_ptr<RandomPlaces> places_;
};

}  // namespace

TEST_CASE("device values of limit surfaces are those of plain evaluation in double", "[evaluate_kernel]") {
    const Real real = GENERATE(Real::single, Real::full);
    struct Case {
        Scheme scheme;
        shapes::Shape shape;
    };
    const auto c = GENERATE(values<Case>({{Scheme::catmull_clark, shapes::polygons_mixed(60, 1)},
                                          {Scheme::catmull_clark, shapes::rough(shapes::grid_with_creases(), 0.2, 2)},
                                          {Scheme::loop, shapes::random_triangle_mesh(60, 3)},
                                          {Scheme::loop, shapes::rough(shapes::grid_triangles_with_creases(), 0.2, 4)},
                                          {Scheme::doo_sabin, shapes::polygons_mixed(60, 5)},
                                          {Scheme::doo_sabin, shapes::rough(shapes::grid_with_hole(), 0.2, 6)}}));
    if (real == Real::full && !solver_test::device_context()->device().has_double) return;
    EvaluationCheck(c.shape, c.scheme, real).check();
}

#ifdef LIMITCL_CLBLAST
TEST_CASE("so they are where CLBlast makes the projections", "[evaluate_kernel]") {
    EvaluationCheck(shapes::polygons_mixed(60, 1), Scheme::catmull_clark, Real::single, 0).check();
}
#endif
