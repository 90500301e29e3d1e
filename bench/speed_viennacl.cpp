// SPDX-License-Identifier: BSD-3-Clause
// speed_viennacl: ViennaCL's conjugate gradients on limitcl's own OpenCL device, context and queue, in float, on S P = D M, beside limitcl's solve.
#define VIENNACL_WITH_OPENCL
#include <viennacl/compressed_matrix.hpp>
#include <viennacl/linalg/cg.hpp>
#include <viennacl/vector.hpp>

#include "interpolation.h"
#include "measure.h"

namespace bench {
namespace {

void share_device(const ContextHandle& context) {
    const cl_command_queue queue = lcl_context_get_queue(context.get());
    cl_context inner = nullptr;
    cl_device_id device = nullptr;
    check_cl(clGetCommandQueueInfo(queue, CL_QUEUE_CONTEXT, sizeof inner, &inner, nullptr));
    check_cl(clGetCommandQueueInfo(queue, CL_QUEUE_DEVICE, sizeof device, &device, nullptr));
    viennacl::ocl::setup_context(0, inner, device, queue);
}

/// One system a channel, all on the device; the shapes lie round the origin, so that starting from zero costs no digits.
class Peer {
public:
    Peer(const LimitMatrix& matrix, const Shape& shape) : S_(matrix.size(), matrix.size()) {
        const std::vector<float> weights(matrix.weights.begin(), matrix.weights.end());
        const std::vector<unsigned> offsets(matrix.offsets.begin(), matrix.offsets.end()), columns(matrix.columns.begin(), matrix.columns.end());
        S_.set(offsets.data(), columns.data(), weights.data(), matrix.size(), matrix.size(), weights.size());
        for (int c = 0; c < 3; ++c) {
            std::vector<float> right(matrix.size());
            for (std::int32_t v = 0; v < matrix.size(); ++v) right[v] = static_cast<float>(matrix.scale[v] * shape.points[3 * v + c]);
            right_.emplace_back(right.size());
            viennacl::copy(right, right_.back());
        }
    }

    void solve(double tolerance) {
        const viennacl::linalg::cg_tag tag(tolerance, 200);
        iterations_ = 0;
        solutions_.clear();
        for (const Vector& right : right_) {
            solutions_.push_back(viennacl::linalg::solve(S_, right, tag));
            iterations_ += static_cast<int>(tag.iters());
        }
        viennacl::backend::finish();
    }

    int iterations() const { return iterations_; }

    std::vector<double> points() const {
        std::vector<double> out(3 * S_.size1());
        std::vector<float> column(S_.size1());
        for (int c = 0; c < 3; ++c) {
            viennacl::copy(solutions_[c], column);
            for (std::size_t v = 0; v < column.size(); ++v) out[3 * v + c] = column[v];
        }
        return out;
    }

private:
    using Vector = viennacl::vector<float>;
    viennacl::compressed_matrix<float> S_;
    std::vector<Vector> right_, solutions_;
    int iterations_ = 0;
};

void race(const Arguments& arguments) {
    const Shape shape = quad_sphere(arguments.level);
    const LimitMatrix matrix = limit_matrix(shape, Scheme::catmull_clark);
    Interpolation problem(open_device(arguments.device), shape, Scheme::catmull_clark);
    share_device(problem.context);
    Peer peer(matrix, shape);
    const double tolerance = loosest_tolerance([&](double attempt) {
        peer.solve(attempt);
        return relative_error(matrix, shape, peer.points());
    });
    peer.solve(tolerance);
    print_value("viennacl.tolerance", tolerance);
    print_value("viennacl.iterations", peer.iterations());
    print_value("viennacl.error", relative_error(matrix, shape, peer.points()));
    run_rounds(arguments.runs, [&](Laps& laps) {
        laps.time("viennacl.limitcl.single", [&] { problem.solve(LCL_PRECISION_SINGLE); });
        laps.time("viennacl.limitcl.mixed", [&] { problem.solve(LCL_PRECISION_MIXED); });
        laps.time("viennacl.peer", [&] { peer.solve(tolerance); });
    });
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) { return bench::run_program(argc, argv, bench::race); }
