// SPDX-License-Identifier: BSD-3-Clause
// A Refiner's values on a device.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "host/field/field.h"
#include "host/refine/refiner.h"

namespace lcl {

class DeviceRefiner {
public:
    /// Uploads what the rows need of the topology of every step: about 60 bytes a vertex of the mesh before the last step.
    DeviceRefiner(std::shared_ptr<Context> context, std::shared_ptr<const Refiner> refiner);

    const Refiner& refiner() const { return *refiner_; }
    const std::shared_ptr<const Refiner>& shared_refiner() const { return refiner_; }
    Context& context() const { return *context_; }

    /// values: control_count rows, out: vertex_count rows of the same channels and type, both in the order of vertices. Returns at once. Values of the levels
    /// between stay on the device for the next call.
    void apply(const Field& values, Field& out);

    /// The same from and to doubles of the host: rows of `channels`, `stride` values apart. On the device they are centred and scaled, of the given type.
    /// BadInput for values that are not finite or too far apart to be scaled. Waits.
    void apply(const double* values, std::size_t stride, int channels, Real real, double* out, std::size_t out_stride);

private:
    struct Rows {
        Index count = 0;
        Buffer targets, offsets, indices;
        std::map<Real, Buffer> weights;
    };
    struct Step {
        Buffer face_offsets, half_edge_face, face_vertices, twin, edge_half_edge, fan_offsets, fan_half_edges;
        std::map<Real, Buffer> degree_weights, valence_weights, edge_weights;
        Rows sums, rows;
    };
    struct Scratch {
        std::vector<Field> levels;  ///< between the first and the last
        std::vector<Field> sums;    ///< of each step, one row where it has none
    };

    void upload_step(const RefinerStep& from, Step& to);
    void upload_rows(const Stencils& stencils, const std::vector<Index>& targets, Rows& to);
    Scratch& scratch(int channels, Real real);
    const Buffer& weights(std::map<Real, Buffer>& of, Real real, const std::function<std::vector<double>()>& values);
    void run_step(std::size_t index, const Field& in, Field& sums, Field& out);
    void run_bulk(const RefinerStep& from, Step& step, const Field& in, Field& out, std::size_t block);
    void run_rows(Rows& rows, const Stencils& stencils, Index old_count, const Field& in, const Field& sums, Field& out, std::size_t block);
    Buffer upload(const void* data, std::size_t bytes, const char* what);
    cl_kernel kernel(const char* name, const Field& field, std::size_t block, Index degree);

    std::shared_ptr<Context> context_;
    std::shared_ptr<const Refiner> refiner_;
    std::vector<Step> steps_;
    std::map<std::pair<Real, int>, Scratch> scratch_;
};

}  // namespace lcl
