// SPDX-License-Identifier: BSD-3-Clause
// Few rows of fields between device and host, in one launch a field whatever their number and places.
#pragma once

#include <vector>

#include "host/field/field.h"

namespace lcl {

/// A list of rows of one field, each row at most once.
struct FieldRows {
    Field* field = nullptr;
    const std::vector<Index>* rows = nullptr;
};

/// Keeps its staging memory, for the longest transfer so far, on the device from call to call. All on the kernels' queue: for a few kilobytes a second queue
/// costs more than it hides (PoCL, 4000 rows: 40 microseconds against 85).
class RowTransfer {
public:
    explicit RowTransfer(std::shared_ptr<Context> context) : context_(std::move(context)) {}

    /// Rows of fields of one shape and type, single or full, as normalised doubles: one list after the other, rows x channels. Waits.
    void read(const std::vector<FieldRows>& lists, std::vector<double>& values);
    /// The way back. The last launches are enqueued only; everything given may be changed at once.
    void write(const std::vector<FieldRows>& lists, const std::vector<double>& values);

private:
    std::size_t prepare(const std::vector<FieldRows>& lists);
    void launch_lists(const char* name, const std::vector<FieldRows>& lists, std::size_t block, bool gathers);

    std::shared_ptr<Context> context_;
    std::vector<Index> all_rows_;
    std::vector<unsigned char> raw_;
    Buffer rows_, values_;  // values_: rows of one channel block
};

}  // namespace lcl
