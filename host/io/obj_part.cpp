// SPDX-License-Identifier: BSD-3-Clause
#include "host/io/obj_part.h"

#include <algorithm>
#include <limits>

#include "host/parallel.h"

namespace lcl {
namespace {

constexpr const char* colour_names[] = {"red", "green", "blue", "alpha"};

/// What stands before a part.
struct Base {
    std::size_t vertices = 0, corners = 0, faces = 0, texture_coordinates = 0;
};

std::vector<Base> bases_of(const std::vector<ObjPart>& parts) {
    std::vector<Base> bases(parts.size() + 1);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const MeshFile& file = parts[i].file;
        bases[i + 1] = {bases[i].vertices + file.mesh.positions.size() / 3, bases[i].corners + file.mesh.face_vertices.size(),
                        bases[i].faces + file.mesh.face_offsets.size() - 1, bases[i].texture_coordinates + texture_coordinate_count(file.uvs)};
    }
    return bases;
}

void check_counts(const Base& all) {
    const std::size_t most = std::numeric_limits<Index>::max();
    if (all.vertices > most || all.corners >= most || all.texture_coordinates > most) throw BadInput("the file has more than can be numbered");
}

void resolve(std::vector<Index>& indices, const std::vector<std::size_t>& corners, std::size_t base) {
    for (const std::size_t corner : corners) {
        const std::int64_t index = indices[corner] + static_cast<std::int64_t>(base);
        if (index < 0) throw BadInput("an index counts back behind the first");
        indices[corner] = static_cast<Index>(index);
    }
}

/// Everything of a part counted from the file's first.
void move_by(ObjPart& part, const Base& base) {
    MeshFile& file = part.file;
    resolve(file.mesh.face_vertices, part.relative_corners, base.vertices);
    resolve(file.uvs.corner_indices, part.relative_texture_corners, base.texture_coordinates);
    for (Index& offset : file.mesh.face_offsets) offset += static_cast<Index>(base.corners);
    for (PassThroughLine& line : file.lines) line.before_face += static_cast<Index>(base.faces);
}

/// The lists of all parts behind each other; `skipped` elements at the beginning of each repeat the end of the one before.
template <class Select>
void join_lists(std::vector<ObjPart>& parts, std::size_t total, const Select& select, std::size_t skipped = 0) {
    auto& whole = select(parts[0]);
    for (std::size_t i = 1; i < parts.size(); ++i) {
        auto& list = select(parts[i]);
        if (whole.size() <= skipped) whole.swap(list);
        whole.reserve(total);
        if (list.size() > skipped) whole.insert(whole.end(), list.begin() + static_cast<std::ptrdiff_t>(skipped), list.end());
        list = {};
    }
}

/// The large lists, at once.
void join_mesh(std::vector<ObjPart>& parts, const Base& all) {
    const auto join_one = [&](std::size_t which) {
        if (which == 0)
            join_lists(
                parts, 3 * all.vertices, [](ObjPart & part) -> auto& { return part.file.mesh.positions; });
        else if (which == 1)
            join_lists(
                parts, all.corners, [](ObjPart & part) -> auto& { return part.file.mesh.face_vertices; });
        else
            join_lists(
                parts, all.faces + 1, [](ObjPart & part) -> auto& { return part.file.mesh.face_offsets; }, 1);
    };
    parallel_for(
        3,
        [&](std::size_t first, std::size_t last) {
            for (std::size_t which = first; which < last; ++which) join_one(which);
        },
        1);
}

void join_texture_coordinates(std::vector<ObjPart>& parts, const std::vector<Base>& bases) {
    const auto is_wide = [](const ObjPart& part) { return part.file.uvs.components == 3; };
    const auto is_used = [](const ObjPart& part) { return !part.file.uvs.corner_indices.empty(); };
    if (std::any_of(parts.begin(), parts.end(), is_wide))
        for (ObjPart& part : parts) widen(part.file.uvs);
    if (std::any_of(parts.begin(), parts.end(), is_used))
        for (std::size_t i = 0; i < parts.size(); ++i) parts[i].file.uvs.corner_indices.resize(bases[i + 1].corners - bases[i].corners, -1);
    const auto components = static_cast<std::size_t>(parts[0].file.uvs.components);
    join_lists(
        parts, components * bases.back().texture_coordinates, [](ObjPart & part) -> auto& { return part.file.uvs.values; });
    join_lists(
        parts, is_used(parts[0]) ? bases.back().corners : 0, [](ObjPart & part) -> auto& { return part.file.uvs.corner_indices; });
}

/// Vertices without a colour are white where others have one.
void append_colours(ObjPart& whole, const ObjPart& part, std::size_t first_vertex) {
    for (int i = 0; i < 4; ++i) {
        if (part.colours[i].empty()) continue;
        whole.colours[i].resize(first_vertex, 1.0);
        whole.colours[i].insert(whole.colours[i].end(), part.colours[i].begin(), part.colours[i].end());
    }
    whole.coloured_vertices += part.coloured_vertices;
}

void append_tags(ObjPart& whole, const MeshTags& tags) {
    MeshTags& own = whole.file.tags;
    own.creases.insert(own.creases.end(), tags.creases.begin(), tags.creases.end());
    own.corners.insert(own.corners.end(), tags.corners.begin(), tags.corners.end());
    if (tags.interpolate_boundary >= 0) own.interpolate_boundary = tags.interpolate_boundary;
    if (own.refused.empty()) own.refused = tags.refused;
    for (const std::string& name : tags.ignored) whole.ignore_tag(name);
}

/// What is counted or rare.
void append_rest(ObjPart& whole, ObjPart& part, const Base& base) {
    append_colours(whole, part, base.vertices);
    append_tags(whole, part.file.tags);
    whole.dropped_weights += part.dropped_weights;
    whole.odd_vertices += part.odd_vertices;
    std::move(part.file.lines.begin(), part.file.lines.end(), std::back_inserter(whole.file.lines));
    for (const auto& [keyword, times] : part.file.unknown_statements) whole.count_unknown(keyword, times);
}

void finish_colours(ObjPart& whole) {
    const auto vertex_count = static_cast<std::size_t>(whole.file.mesh.vertex_count);
    if (whole.coloured_vertices == 0) return;
    if (whole.coloured_vertices < vertex_count)
        whole.file.warnings.push_back(std::to_string(vertex_count - whole.coloured_vertices) +
                                      " vertices have no colour while others have one; they were made white");
    for (int i = 0; i < 4; ++i) {
        if (whole.colours[i].empty()) continue;
        whole.colours[i].resize(vertex_count, 1.0);
        whole.file.properties.push_back({colour_names[i], VertexProperty::Kind::colour, "double", std::move(whole.colours[i])});
    }
}

/// Corners may name texture coordinates that come later in the file, so that the range is known only now.
void finish_texture_coordinates(MeshFile& file) {
    std::vector<Index>& indices = file.uvs.corner_indices;
    if (!indices.empty()) indices.resize(file.mesh.face_vertices.size(), -1);
    const std::size_t count = texture_coordinate_count(file.uvs);
    std::size_t beyond = 0;
    for (Index& index : indices) {
        if (index < 0 || static_cast<std::size_t>(index) < count) continue;
        index = -1;
        ++beyond;
    }
    if (beyond > 0)
        file.warnings.push_back(std::to_string(beyond) + " face corners name a texture coordinate beyond the " + std::to_string(count) +
                                " of the file; they were left without one");
}

}  // namespace

void ObjPart::count_unknown(const std::string& keyword, Index times) {
    const auto [place, is_new] = unknown_.emplace(keyword, file.unknown_statements.size());
    if (is_new) file.unknown_statements.emplace_back(keyword, 0);
    file.unknown_statements[place->second].second += times;
}

void ObjPart::ignore_tag(const std::string& name) {
    std::vector<std::string>& names = file.tags.ignored;
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

std::size_t texture_coordinate_count(const TextureCoordinates& uvs) { return uvs.values.size() / static_cast<std::size_t>(uvs.components); }

void widen(TextureCoordinates& uvs) {
    if (uvs.components == 3) return;
    std::vector<double> wide;
    wide.reserve(uvs.values.size() / 2 * 3);
    for (std::size_t i = 0; i < uvs.values.size(); i += 2) wide.insert(wide.end(), {uvs.values[i], uvs.values[i + 1], 0.0});
    uvs.values = std::move(wide);
    uvs.components = 3;
}

ObjPart join(std::vector<ObjPart> parts) {
    if (parts.size() == 1) return std::move(parts[0]);
    const std::vector<Base> bases = bases_of(parts);
    check_counts(bases.back());
    parallel_for(
        parts.size() - 1,
        [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first + 1; i <= last; ++i) move_by(parts[i], bases[i]);
        },
        1);
    join_mesh(parts, bases.back());
    join_texture_coordinates(parts, bases);
    for (std::size_t i = 1; i < parts.size(); ++i) append_rest(parts[0], parts[i], bases[i]);
    return std::move(parts[0]);
}

MeshFile finish(ObjPart whole) {
    MeshFile& file = whole.file;
    file.mesh.vertex_count = static_cast<Index>(file.mesh.positions.size() / 3);
    finish_colours(whole);
    finish_texture_coordinates(file);
    if (whole.dropped_weights > 0)
        file.warnings.push_back("the weights w of " + std::to_string(whole.dropped_weights) + " vertices are not 1; they were dropped");
    if (whole.odd_vertices > 0)
        file.warnings.push_back(std::to_string(whole.odd_vertices) +
                                " vertex lines have 5 or more than 7 numbers; those behind x, y, z and a colour were dropped");
    std::string names;
    for (const std::string& name : file.tags.ignored) names += (names.empty() ? "" : ", ") + name;
    if (!names.empty()) file.warnings.push_back("tags that have no effect here were skipped: " + names);
    return std::move(file);
}

}  // namespace lcl
