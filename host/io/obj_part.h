// SPDX-License-Identifier: BSD-3-Clause
// What the parts of an OBJ file hold, and the whole that they make.
#pragma once

#include <unordered_map>

#include "host/io/format.h"

namespace lcl {

/// What lines of an OBJ file hold. Vertices, faces and texture coordinates are counted from the part's own first; indices of corners are the file's, save those
/// that count back.
struct ObjPart {
    MeshFile file;  ///< but for what finish() makes of the rest: properties, warnings
    std::vector<double> colours[4];
    std::size_t coloured_vertices = 0, dropped_weights = 0, odd_vertices = 0;
    std::vector<std::size_t> relative_corners, relative_texture_corners;  ///< corners whose index counts from the part's first vertex or texture coordinate

    void count_unknown(const std::string& keyword, Index times);
    void ignore_tag(const std::string& name);

private:
    std::unordered_map<std::string, std::size_t> unknown_;  // keyword -> place in file.unknown_statements
};

std::size_t texture_coordinate_count(const TextureCoordinates& uvs);
/// Gives two-component texture coordinates a third.
void widen(TextureCoordinates& uvs);

/// The parts of a file, in their order, as one. BadInput, without a place, where an index counts back behind the first, or there is more than can be numbered.
ObjPart join(std::vector<ObjPart> parts);

/// The mesh of a whole file.
MeshFile finish(ObjPart whole);

}  // namespace lcl
