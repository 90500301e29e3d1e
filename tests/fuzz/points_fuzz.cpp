// SPDX-License-Identifier: BSD-3-Clause
// Points of any format, chosen by the first byte; what is read is finite and of one count, and text read in as many parts as the second byte says gives the
// same.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>

#include "host/io/point_text.h"
#include "host/io/points_file.h"

namespace {

constexpr lcl::FileFormat formats[] = {lcl::FileFormat::xyz, lcl::FileFormat::csv, lcl::FileFormat::pts,
                                       lcl::FileFormat::ply, lcl::FileFormat::off, lcl::FileFormat::obj};

bool all_of(const std::vector<double>& values, bool (*holds)(double)) {
    for (const double value : values)
        if (!holds(value)) return false;
    return true;
}

bool is_consistent(const lcl::PointCloud& cloud) {
    const bool counts_agree = cloud.points.size() % 3 == 0 && (cloud.normals.empty() || cloud.normals.size() == cloud.points.size()) &&
                              (cloud.colours.empty() || cloud.colours.size() == cloud.points.size());
    return counts_agree && all_of(cloud.points, [](double x) { return std::isfinite(x); }) && lcl::bad_normals(cloud.normals).count == 0 &&
           all_of(cloud.colours, [](double x) { return x >= 0 && x <= 1; });
}

/// What a reader of text finds; where it refuses the text, the sentence alone.
struct Result {
    lcl::PointCloud cloud;
    std::string refusal;
};

Result read_text(const char* data, std::size_t size, std::size_t format, std::size_t parts) {
    const std::string name = "fuzz";
    const lcl::InputBytes input{data, size, name, {1, parts, 0}};
    try {
        return {format == 0 ? lcl::read_xyz(input) : format == 1 ? lcl::read_csv_points(input) : lcl::read_pts(input), {}};
    } catch (const lcl::BadInput& error) {
        return {{}, error.what()};
    }
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

bool same(const Result& a, const Result& b) {
    return a.refusal == b.refusal && a.cloud.warnings == b.cloud.warnings && same_bits(a.cloud.points, b.cloud.points) &&
           same_bits(a.cloud.normals, b.cloud.normals) && same_bits(a.cloud.colours, b.cloud.colours);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    if (size < 2) return 0;
    const char* const data = reinterpret_cast<const char*>(bytes) + 2;
    const std::size_t format = bytes[0] % 6;
    try {
        if (!is_consistent(lcl::read_points_memory(data, size - 2, formats[format], "fuzz"))) std::abort();
    } catch (const lcl::BadInput&) {
    }
    if (format < 3 && !same(read_text(data, size - 2, format, 1), read_text(data, size - 2, format, 2 + bytes[1] % 30))) std::abort();
    return 0;
}
