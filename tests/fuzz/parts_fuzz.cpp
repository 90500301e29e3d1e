// SPDX-License-Identifier: BSD-3-Clause
// OBJ, OFF or PLY by the first byte, read as a whole and in as many parts as the second byte says: the same mesh, or the same sentence.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>

#include "host/io/format.h"

namespace {

/// All that a reader finds; where it refuses the file, the sentence alone.
struct Result {
    lcl::MeshFile file;
    std::string refusal;
};

Result read(const std::uint8_t* data, std::size_t size, std::uint8_t format, std::size_t parts) {
    const std::string name = "fuzz";
    const lcl::InputBytes input{reinterpret_cast<const char*>(data), size, name, {1, parts, 0}};
    try {
        return {format % 3 == 0 ? lcl::read_obj(input) : format % 3 == 1 ? lcl::read_off(input) : lcl::read_ply(input), {}};
    } catch (const lcl::BadInput& error) {
        return {{}, error.what()};
    }
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

bool same(const lcl::MeshFile& a, const lcl::MeshFile& b) {
    bool agrees = same_bits(a.mesh.positions, b.mesh.positions) && a.mesh.face_offsets == b.mesh.face_offsets && a.mesh.face_vertices == b.mesh.face_vertices &&
                  same_bits(a.uvs.values, b.uvs.values) && a.uvs.corner_indices == b.uvs.corner_indices && a.warnings == b.warnings &&
                  a.unknown_statements == b.unknown_statements && a.tags.refused == b.tags.refused && a.lines.size() == b.lines.size() &&
                  a.properties.size() == b.properties.size();
    for (std::size_t i = 0; agrees && i < a.lines.size(); ++i) agrees = a.lines[i].text == b.lines[i].text && a.lines[i].before_face == b.lines[i].before_face;
    for (std::size_t i = 0; agrees && i < a.properties.size(); ++i) agrees = same_bits(a.properties[i].values, b.properties[i].values);
    return agrees;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 3) return 0;
    const Result whole = read(data + 2, size - 2, data[0], 1), parts = read(data + 2, size - 2, data[0], 2 + data[1] % 30);
    if (whole.refusal != parts.refusal || !same(whole.file, parts.file)) std::abort();
    return 0;
}
