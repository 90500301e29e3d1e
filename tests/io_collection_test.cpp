// SPDX-License-Identifier: BSD-3-Clause
// Meshes that others wrote, where there is a collection of them: the folder that the environment variable LIMITCL_MESHES names, with its INDEX.tsv.
#include <cctype>
#include <map>
#include <set>
#include <sstream>

#include <catch2/catch.hpp>

#include "tests/io_support.h"

using namespace io_test;
using lcl::Index;
using lcl::MeshFile;

namespace {

struct IndexRow {
    std::string name, vertex_count, face_count, degrees, flags;
};

std::vector<std::string> split(const std::string& line, char at) {
    std::vector<std::string> parts;
    std::istringstream stream(line);
    for (std::string part; std::getline(stream, part, at);) parts.push_back(part);
    return parts;
}

std::vector<IndexRow> read_index(const std::string& folder) {
    std::ifstream stream(folder + "/INDEX.tsv");
    std::string line;
    std::getline(stream, line);
    std::map<std::string, std::size_t> columns;
    const std::vector<std::string> titles = split(line, '\t');
    for (std::size_t i = 0; i < titles.size(); ++i) columns[titles[i]] = i;
    std::vector<IndexRow> rows;
    while (std::getline(stream, line)) {
        std::vector<std::string> cells = split(line, '\t');
        cells.resize(titles.size());
        rows.push_back({cells[columns["name"]], cells[columns["V"]], cells[columns["F"]], cells[columns["face_degrees"]], cells[columns["flags"]]});
    }
    return rows;
}

/// "3:12,4:5" as the index writes it.
std::string degrees_of(const lcl::PolygonMesh& mesh) {
    std::map<Index, int> counts;
    for (Index f = 0; f < mesh.face_count(); ++f) ++counts[mesh.degree(f)];
    std::string text;
    for (const auto& [degree, count] : counts) text += (text.empty() ? "" : ",") + std::to_string(degree) + ":" + std::to_string(count);
    return text.empty() ? "-" : text;
}

bool is_point_file(const std::string& name) {
    std::string lower = name;
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return contains(lower, ".xyz") || contains(lower, ".pts");
}

/// Files that are to be refused: bad numbers, false headers, unknown types, binary OFF, nothing in them, rows longer than the header says.
bool may_be_refused(const IndexRow& row) {
    return row.vertex_count == "?" || contains(row.flags, "bad-v") || contains(row.name, "empty.off") || contains(row.name, "trimesh_fuze_ascii.ply");
}

void check_file(const std::string& path, const IndexRow& row) {
    try {
        const MeshFile file = lcl::read_mesh(path);
        if (row.vertex_count == "?") return;
        CHECK(std::to_string(file.mesh.vertex_count) == row.vertex_count);
        CHECK(std::to_string(file.mesh.face_count()) == row.face_count);
        CHECK(degrees_of(file.mesh) == row.degrees);
        for (const lcl::VertexProperty& property : file.properties) CHECK(property.values.size() == static_cast<std::size_t>(file.mesh.vertex_count));
        CHECK((file.uvs.corner_indices.empty() || file.uvs.corner_indices.size() == file.mesh.face_vertices.size()));
        for (const Index index : file.uvs.corner_indices) REQUIRE(index * file.uvs.components < static_cast<Index>(file.uvs.values.size()));
    } catch (const lcl::BadInput& error) {
        INFO(error.what());
        CHECK(may_be_refused(row));
        CHECK(contains(error.what(), path));
    }
}

}  // namespace

TEST_CASE("meshes that others wrote are read with the counts that are known of them", "[io][collection]") {
    const char* folder = std::getenv("LIMITCL_MESHES");
    if (!folder) {
        WARN("LIMITCL_MESHES names no folder of meshes; nothing was read");
        return;
    }
    const std::vector<IndexRow> rows = read_index(folder);
    REQUIRE(rows.size() > 0);
    for (const IndexRow& row : rows) {
        INFO(row.name);
        if (!is_point_file(row.name)) check_file(std::string(folder) + "/" + row.name, row);
    }
}

TEST_CASE("meshes that others wrote come back from every format that holds them", "[io][collection]") {
    const char* folder = std::getenv("LIMITCL_MESHES");
    if (!folder) {
        WARN("LIMITCL_MESHES names no folder of meshes; nothing was read");
        return;
    }
    const TemporaryFolder output;
    for (const IndexRow& row : read_index(folder)) {
        INFO(row.name);
        if (is_point_file(row.name) || may_be_refused(row) || std::atoi(row.vertex_count.c_str()) > 5000) continue;
        MeshFile file = lcl::read_mesh(std::string(folder) + "/" + row.name);
        bool is_sound = file.mesh.vertex_count > 0;
        for (const Index v : file.mesh.face_vertices) is_sound = is_sound && v >= 0 && v < file.mesh.vertex_count;
        if (!is_sound) continue;
        file.ply_position_type.clear();
        for (const char* name : {"a.obj", "a.off", "a.ply"}) {
            const MeshFile back = round_trip(file, output.file(name));
            CHECK(back.mesh.face_offsets == file.mesh.face_offsets);
            CHECK(back.mesh.face_vertices == file.mesh.face_vertices);
            for (std::size_t i = 0; i < file.mesh.positions.size(); ++i)
                REQUIRE((back.mesh.positions[i] == file.mesh.positions[i] || (std::isnan(back.mesh.positions[i]) && std::isnan(file.mesh.positions[i]))));
        }
    }
}
