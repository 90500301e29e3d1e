// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "host/apply/device_operator.h"
#include "host/two_phase/umbrella_steps.h"

namespace lcl {
namespace {

constexpr std::size_t largest_local = 64;
constexpr cl_int rows_a_lane = 512;  // a work-group sums on a CPU, where it is one work-item

class DeviceSteps : public UmbrellaSteps {
public:
    DeviceSteps(std::shared_ptr<Context> context, const Umbrellas& umbrellas, const UmbrellaTargets& targets, int group)
        : context_(std::move(context)),
          umbrellas_(umbrellas),
          count_(umbrellas.count),
          points_(umbrellas.vertex_count),
          group_(group > 0 ? group : launch_shape(context_->device(), umbrellas.vertex_count).group),
          block_rows_(group_ == 1 ? rows_a_lane : 4 * group_),
          options_(kernel_options(*context_, Real::full, 1, group_)),
          offsets_(upload(umbrellas.offsets, "the umbrellas of a refined mesh")),
          mask_of_(upload(umbrellas.mask_of, "the umbrellas of a refined mesh")),
          constrained_(upload(targets.constrained, "the umbrellas of a refined mesh")),
          targets_(upload(targets.points, "the vertices to interpolate")),
          normals_(upload(targets.normals, "the normals to interpolate")),
          handles_(upload(targets.handles, "the shape handles")),
          x_(make("the points of a refined mesh")) {
        upload_masks(umbrellas.masks);
    }

    void upload(const std::vector<double>& points) override {
        const std::vector<double> ordered = in_umbrella_order(umbrellas_, points);
        context_->write(x_, 0, ordered.size() * sizeof(double), ordered.data(), "uploading a refined mesh");
    }

    void download(std::vector<double>& points) override {
        std::vector<double> ordered(numbers());
        context_->read(x_, 0, ordered.size() * sizeof(double), ordered.data(), "reading a refined mesh");
        points = in_vertex_order(umbrellas_, ordered);
    }

    RepairFindings repair() override {
        const std::size_t bytes = static_cast<std::size_t>(count_) * sizeof(double);
        const Buffer distances(context_, bytes, "the findings of a repair"), sides(context_, bytes, "the findings of a repair");
        launch(*context_, kernel("lcl_umbrella_repair"), by_item(count_), count_, offsets_, mask_of_, mask_offsets_, masks_, grams_, constrained_, targets_,
               normals_, x_, distances, sides);
        RepairFindings found{std::vector<double>(count_), std::vector<double>(count_)};
        context_->read(distances, 0, bytes, found.distances.data(), "reading the findings of a repair");
        context_->read(sides, 0, bytes, found.sides.data(), "reading the findings of a repair");
        return found;
    }

    void scale() override {
        launch(*context_, kernel("lcl_umbrella_scale"), by_item(count_), count_, offsets_, mask_of_, mask_offsets_, masks_, grams_, handles_, x_);
    }

    void set_fairness(const FairRows& rows, double weight) override {
        weight_ = weight;
        row_offsets_ = upload(rows.offsets, "the neighbours of a refined mesh");
        neighbours_ = upload(rows.neighbours, "the neighbours of a refined mesh");
        lengths_ = upload(rows.lengths, "the neighbours of a refined mesh");
        const std::vector<double> zeros(numbers(), 0.0);
        p_ = upload(zeros, "the fairness of a refined mesh"), r_ = upload(zeros, "the fairness of a refined mesh");
        z_ = make("the fairness of a refined mesh"), q_ = make("the fairness of a refined mesh");
        sums_ = Buffer(context_, blocks(numbers()) * sizeof(double), "the sums of fairness");
    }

    double energy() override {
        laplacian(x_);
        return read_sum(points_);
    }

    double begin() override {
        laplacian(x_);
        project_gradient(0);
        const double square = update(0, 1);  // r = -q, r and p being zero
        turn(0);
        return square;
    }

    double apply() override {
        laplacian(p_);
        project_gradient(1);
        return read_sum(count_);
    }

    double update(double alpha) override { return update(alpha, alpha); }

    void turn(double beta) override { launch(*context_, kernel("lcl_fair_turn"), by_item(numbers()), static_cast<cl_uint>(numbers()), beta, r_, p_); }

private:
    std::size_t numbers() const { return 3 * static_cast<std::size_t>(points_); }
    std::size_t blocks(std::size_t rows) const { return (rows + block_rows_ - 1) / static_cast<std::size_t>(block_rows_); }
    LaunchSize by_block(std::size_t rows) const { return {blocks(rows) * group_, static_cast<std::size_t>(group_)}; }
    LaunchSize by_item(std::size_t rows) const {
        const std::size_t local = std::min(largest_local, context_->device().max_work_group_size);
        return {(rows + local - 1) / local * local, local};
    }
    cl_kernel kernel(const char* name) { return context_->kernel("two_phase", name, options_); }

    Buffer make(const char* what) { return Buffer(context_, numbers() * sizeof(double), what); }

    template <class Values>
    Buffer upload(const Values& values, const char* what) {
        const std::size_t bytes = values.size() * sizeof values[0];
        Buffer buffer(context_, std::max<std::size_t>(bytes, 16), what);
        context_->write(buffer, 0, bytes, values.data(), std::string("uploading ") + what);
        return buffer;
    }

    void upload_masks(const std::vector<UmbrellaMask>& masks) {
        std::vector<cl_int> offsets;
        std::vector<double> weights, grams;
        for (const UmbrellaMask& mask : masks) {
            offsets.push_back(static_cast<cl_int>(weights.size() / 3));
            for (const std::array<double, 3>& entry : mask.weights) weights.insert(weights.end(), entry.begin(), entry.end());
            grams.push_back(mask.inverse_square);
            grams.insert(grams.end(), mask.inverse_gram.begin(), mask.inverse_gram.end());
        }
        mask_offsets_ = upload(offsets, "the masks of umbrellas");
        masks_ = upload(weights, "the masks of umbrellas");
        grams_ = upload(grams, "the masks of umbrellas");
    }

    /// z = L v, each row divided by its length, with the sums of |L v|^2
    void laplacian(const Buffer& v) {
        launch(*context_, kernel("lcl_fair_laplacian"), by_block(points_), points_, block_rows_, row_offsets_, neighbours_, lengths_, v, z_, sums_);
    }

    /// q = C (shift p + W L^T L v), v that of laplacian
    void project_gradient(double shift) {
        launch(*context_, kernel("lcl_fair_apply"), by_block(count_), count_, block_rows_, offsets_, mask_of_, mask_offsets_, masks_, grams_, row_offsets_,
               neighbours_, lengths_, constrained_, normals_, shift, weight_, p_, z_, q_, sums_);
    }

    /// x += alpha p, r -= beta q
    double update(double alpha, double beta) {
        launch(*context_, kernel("lcl_fair_update"), by_block(numbers()), static_cast<cl_uint>(numbers()), static_cast<cl_uint>(block_rows_), alpha, beta, p_,
               q_, x_, r_, sums_);
        return read_sum(numbers());
    }

    double read_sum(std::size_t rows) {
        std::vector<double> partial(blocks(rows));
        context_->read(sums_, 0, partial.size() * sizeof(double), partial.data(), "reading the sums of fairness");
        double sum = 0;
        for (const double part : partial) sum += part;
        return sum;
    }

    const std::shared_ptr<Context> context_;
    const Umbrellas& umbrellas_;
    const cl_int count_, points_;
    const int group_;
    const cl_int block_rows_;
    const std::string options_;
    const Buffer offsets_, mask_of_, constrained_, targets_, normals_, handles_, x_;
    Buffer mask_offsets_, masks_, grams_;
    Buffer row_offsets_, neighbours_, lengths_, z_, p_, q_, r_, sums_;
    double weight_ = 0;
};

}  // namespace

std::unique_ptr<UmbrellaSteps> make_device_steps(std::shared_ptr<Context> context, const Umbrellas& umbrellas, const UmbrellaTargets& targets, int group) {
    return std::make_unique<DeviceSteps>(std::move(context), umbrellas, targets, group);
}

}  // namespace lcl
