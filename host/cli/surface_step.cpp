// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/surface_step.h"

#include <algorithm>
#include <utility>

#include "host/cli/failure.h"
#include "host/cli/option_names.h"
#include "host/cli/scheme_choice.h"

namespace lcl::cli {

SurfaceOfInput open_surface(Job& job, DeviceOpening& device, lcl_mesh mesh) {
    job.report.set_parameter("precision", std::string(precision_name(job.options.precision)));
    SchemeChoice scheme = choose_scheme(job, mesh);
    Context context = device.finish();
    resolve_alpha(job, context, mesh, scheme.options);
    say_scheme(job);
    const Phase phase(job, &Seconds::topology, "making patches", context.get());
    lcl_limit_surface handle = nullptr;
    check_of_input(job, lcl_limit_surface_create(context.get(), mesh, &scheme.options, job.options.precision, &handle));
    return {std::move(context), LimitSurface(handle)};
}

TableOutput::TableOutput(Job& job, const std::string& header) : job_(job) {
    if (job.options.output != "-") file_.emplace(job.options.output);
    write(header + "\n");
}

void TableOutput::write(const std::string& rows) {
    if (file_) file_->write(rows);
    else text_ += rows;
}

void TableOutput::finish() {
    if (file_) file_->finish();
    else job_.terminal.result(text_);
}

void write_in_pieces(Job& job, lcl_context context, std::size_t row_count, const std::string& header,
                     const std::function<void(std::size_t, std::size_t)>& compute, const std::function<void(std::string&, std::size_t, std::size_t)>& append) {
    TableOutput output(job, header);
    std::string text;
    for (std::size_t first = 0; first < row_count; first += rows_a_piece) {
        const std::size_t count = std::min(rows_a_piece, row_count - first);
        {
            const Phase phase(job, &Seconds::solve, "evaluating", context);
            compute(first, count);
        }
        const Phase phase(job, &Seconds::write, "writing");
        text.clear();
        for (std::size_t row = 0; row < count; ++row) {
            append(text, first, row);
            text += "\n";
        }
        output.write(text);
    }
    output.finish();
}

void append_vector(std::string& text, const double* vector) {
    for (int axis = 0; axis < 3; ++axis) append_cell(text, vector[axis]);
}

}  // namespace lcl::cli
