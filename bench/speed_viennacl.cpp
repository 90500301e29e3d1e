// SPDX-License-Identifier: BSD-3-Clause
// speed_viennacl: ViennaCL's conjugate gradients on limitcl's own OpenCL device, context and queue, in float, on S P = D M, preconditioned by the diagonal and
// started from M (plain and from zero it took twice as long), beside limitcl's solve.
#include "interpolation.h"  // before ViennaCL: it chooses the OpenCL version

#define VIENNACL_WITH_OPENCL
#include <memory>
#include <viennacl/compressed_matrix.hpp>
#include <viennacl/linalg/cg.hpp>
#include <viennacl/linalg/jacobi_precond.hpp>
#include <viennacl/vector.hpp>

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

/// One system a channel, all on the device.
class Peer {
public:
    Peer(const LimitMatrix& matrix, const Shape& shape) : S_(matrix.size(), matrix.size()) {
        const std::vector<float> weights(matrix.weights.begin(), matrix.weights.end());
        const std::vector<unsigned> offsets(matrix.offsets.begin(), matrix.offsets.end()), columns(matrix.columns.begin(), matrix.columns.end());
        S_.set(offsets.data(), columns.data(), weights.data(), matrix.size(), matrix.size(), weights.size());
        preconditioner_ = std::make_unique<Preconditioner>(S_, viennacl::linalg::jacobi_tag());
        for (int c = 0; c < 3; ++c) {
            std::vector<float> start(matrix.size()), right(matrix.size());
            for (std::int32_t v = 0; v < matrix.size(); ++v) {
                start[v] = static_cast<float>(shape.points[3 * v + c]);
                right[v] = static_cast<float>(matrix.scale[v] * shape.points[3 * v + c]);
            }
            start_.push_back(on_device(start));
            right_.push_back(on_device(right));
        }
    }

    void solve(double tolerance) {
        iterations_ = 0;
        solutions_.clear();
        for (int c = 0; c < 3; ++c) {
            viennacl::linalg::cg_solver<Vector> solver(viennacl::linalg::cg_tag(tolerance, 200));
            solver.set_initial_guess(start_[c]);
            solutions_.push_back(solver(S_, right_[c], *preconditioner_));
            iterations_ += static_cast<int>(solver.tag().iters());
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
    using Preconditioner = viennacl::linalg::jacobi_precond<viennacl::compressed_matrix<float>>;
    static Vector on_device(const std::vector<float>& values) {
        Vector vector(values.size());
        viennacl::copy(values, vector);
        return vector;
    }

    viennacl::compressed_matrix<float> S_;
    std::unique_ptr<Preconditioner> preconditioner_;
    std::vector<Vector> start_, right_, solutions_;
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
        laps.time_warm("viennacl.limitcl.single", [&] { problem.solve(LCL_PRECISION_SINGLE); });
        laps.time_warm("viennacl.limitcl.mixed", [&] { problem.solve(LCL_PRECISION_MIXED); });
        laps.time_warm("viennacl.peer", [&] { peer.solve(tolerance); });
    });
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) { return bench::run_program(argc, argv, bench::race); }
