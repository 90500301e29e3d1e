// SPDX-License-Identifier: BSD-3-Clause
// What `evaluate` and `closest` share: the limit surface of IN, and a table of results that is made piece by piece.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "host/cli/csv.h"
#include "host/cli/handles.h"
#include "host/cli/job.h"

namespace lcl::cli {

/// Rows that are computed and written at a time.
constexpr std::size_t rows_a_piece = 1 << 16;

/// The limit surface of IN with the scheme and precision of the options.
struct SurfaceOfInput {
    Context context;
    LimitSurface surface;
};
SurfaceOfInput open_surface(Job& job, DeviceOpening& device, lcl_mesh mesh);

/// OUT as a table: a file that appears completely or not at all, or standard output, which gets all at the end.
class TableOutput {
public:
    TableOutput(Job& job, const std::string& header);
    void write(const std::string& rows);
    void finish();

private:
    Job& job_;
    std::optional<OutputFile> file_;
    std::string text_;
};

/// Calls compute(first, count) and then append(text, row of the piece) for all rows, and writes the table. Reports the seconds; may be interrupted.
void write_in_pieces(Job& job, lcl_context context, std::size_t row_count, const std::string& header,
                     const std::function<void(std::size_t, std::size_t)>& compute, const std::function<void(std::string&, std::size_t, std::size_t)>& append);

/// Three cells, each behind a comma.
void append_vector(std::string& text, const double* vector);

}  // namespace lcl::cli
