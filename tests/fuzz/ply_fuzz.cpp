// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <cstdint>

#include "host/io/mesh_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        lcl::read_mesh_memory(reinterpret_cast<const char*>(data), size, lcl::FileFormat::ply, "fuzz");
    } catch (const lcl::BadInput&) {
    }
    return 0;
}
