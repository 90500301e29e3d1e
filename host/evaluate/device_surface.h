// SPDX-License-Identifier: BSD-3-Clause
// A limit surface on a device: patches, control points, and samples that are evaluated there (kernels/evaluate.cl).
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "host/device/dense_product.h"
#include "host/device/device.h"
#include "host/evaluate/patch_table.h"
#include "host/field/field.h"

namespace lcl {

constexpr std::int32_t regular_group = -1, cells_group = -2;

/// Samples of one launch: those in irregular patches of one kind, in regular ones, or in cells that have become regular patches.
struct SampleGroup {
    std::int32_t kind = regular_group;
    cl_int begin = 0, count = 0;
};

/// At most `piece_samples` samples, found and sorted by kind of patch, on the device.
struct SamplePiece {
    std::size_t first = 0, count = 0;  ///< of the caller's places
    std::vector<SampleGroup> groups;
    Buffer parameters, places, packed;
};

/// Where values go: packed arrays of the caller, null where they are not wanted; limitcl.h, lcl_surface_values.
struct SurfaceValues {
    bool is_float = false;
    void *points = nullptr, *du = nullptr, *dv = nullptr, *normals = nullptr, *duu = nullptr, *duv = nullptr, *dvv = nullptr, *gauss = nullptr, *mean = nullptr;
};

class DeviceSurface {
public:
    static constexpr std::size_t piece_samples = std::size_t{1} << 17;  // what a launch reads and writes stays in the caches, and order_i in 24 bits

    /// real: single or full. Uploads all but the points. dense_operations: from so many on a projection is CLBlast's.
    DeviceSurface(std::shared_ptr<Context> context, PatchTable table, Real real, double dense_operations = least_dense_operations);

    const PatchTable& table() const { return table_; }
    bool is_double() const { return real_ == Real::full; }
    const std::array<double, 3>& centre() const { return centre_; }
    double size() const { return scale_; }  ///< diagonal of the bounding box of the control points
    /// points: point_count rows of three, `stride` values apart. BadInput where they are not finite.
    void set_points(const double* points, std::size_t stride);
    /// For batches of so many samples: where there are many to a patch, the outer rings of irregular patches become regular patches, once.
    void prepare_for(std::size_t sample_count);
    /// Finds places first .. first + count - 1. BadInput for the first that does not exist.
    SamplePiece make_samples(const Places& places, std::size_t first, std::size_t count);
    /// The same into memory that is used again.
    void make_samples(const Places& places, std::size_t first, std::size_t count, SamplePiece& piece);
    /// Writes the values of a piece to their places in `values`, whose arrays begin with place 0.
    void evaluate(const SamplePiece& piece, const SurfaceValues& values);

private:
    struct Kind {
        std::size_t mode_count = 0, point_count = 0;  // M, K
        cl_int which = 0, patch_count = 0;
        std::size_t first_coefficient = 0;
        Buffer control, projection, weights, cells;
        std::size_t expanded_point = 0;
    };
    template <class Number>
    struct Sorter;

    std::vector<std::vector<Index>> number_patches();
    void upload_kinds(const std::vector<std::vector<Index>>& controls);
    void upload_turns();
    void upload_points();
    void project();
    void expand();
    std::size_t expanded_cells() const;
    Buffer reals(const std::vector<double>& values, const char* what) const;
    cl_kernel kernel(const char* name, unsigned want = 0) const;
    LaunchSize lanes(std::size_t count, std::size_t second = 1) const;
    void launch_groups(const SamplePiece& piece, unsigned want);
    template <class Number>
    void fill(const Places& places, SamplePiece& piece);
    template <class Number>
    void read(const SamplePiece& piece, unsigned want, const SurfaceValues& values);

    std::shared_ptr<Context> context_;
    PatchTable table_;
    Real real_;
    double dense_operations_;
    std::vector<cl_uint> place_of_patch_;  // regular: where its control points begin; irregular: its column among those of its kind
    std::vector<Kind> kinds_;
    std::size_t coefficient_count_ = 0;
    bool has_expanded_ = false;  // the outer rings of irregular patches stand behind the control points, as regular patches
    Buffer kind_numbers_, control_, points_, coefficients_, turns_, out_;
    std::vector<double> control_points_;  // normalised, control_count x 3
    std::array<double, 3> centre_{};
    double scale_ = 1;  // model units in one of the device's
    std::vector<PatchPlace> found_;
};

}  // namespace lcl
