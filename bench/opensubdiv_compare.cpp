// SPDX-License-Identifier: BSD-3-Clause
// opensubdiv_compare M P [loop|catmull-clark]
// Limit positions of the control mesh P by OpenSubdiv against the vertices of M, which `limitcl interpolate M -o P` was given, and the limit surface of P
// against OpenSubdiv's regular patches: points, first and second derivatives, both in double and both in float. Sharp edges and vertices are read from the tags
// of M's OBJ text here, not by the library. Prints one JSON object; lengths relative to the diagonal of M.
// opensubdiv_compare --end-caps
// A table of how far OpenSubdiv's end caps are from the limit surface.
#include "opensubdiv_limit.h"
#include "opensubdiv_patches.h"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

namespace {

constexpr double infinitely_sharp = 10.0;
constexpr int most_faces = 40'000;  // whose patches are compared: OpenSubdiv takes seconds for the tables of larger meshes

// "t NAME nInts/nFloats/nStrings values": the integers, then the floats.
struct Tag {
    std::string name;
    std::vector<int> integers;
    std::vector<double> floats;
};

bool read_tag(const std::string& line, Tag& tag) {
    std::istringstream in(line);
    std::string statement;
    std::size_t integers = 0, floats = 0;
    char slash = 0;
    if (!(in >> statement >> tag.name >> integers >> slash >> floats) || statement != "t") return false;
    std::string rest;
    in >> rest;  // "/nStrings"
    tag.integers.resize(integers);
    tag.floats.resize(floats);
    for (int& value : tag.integers) in >> value;
    for (double& value : tag.floats) in >> value;
    return static_cast<bool>(in);
}

void add_tag(const Tag& tag, bench::SharpMesh& mesh) {
    const auto sharp = [&](std::size_t i) { return !tag.floats.empty() && tag.floats[tag.floats.size() == 1 ? 0 : i] >= infinitely_sharp; };
    if (tag.name == "crease")
        for (std::size_t i = 0; i + 1 < tag.integers.size(); ++i)
            if (sharp(i)) mesh.creases.push_back({tag.integers[i], tag.integers[i + 1]});
    if (tag.name == "corner")
        for (std::size_t i = 0; i < tag.integers.size(); ++i)
            if (sharp(i)) mesh.corners.push_back(tag.integers[i]);
    if (tag.name == "interpolateboundary") mesh.boundary_edge_only = !tag.integers.empty() && tag.integers[0] == 2;
}

void read_tags(const std::string& path, bench::SharpMesh& mesh) {
    if (path.size() < 4 || path.substr(path.size() - 4) != ".obj") return;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        Tag tag;
        if (read_tag(line, tag)) add_tag(tag, mesh);
    }
}

double distance(const double* a, const double* b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

void compare(const std::string& vertices_path, const std::string& control_path, const std::string& scheme) {
    const limitcl::Mesh M = limitcl::read_mesh(vertices_path), P = limitcl::read_mesh(control_path);
    if (M.face_vertices() != P.face_vertices() || M.face_degrees() != P.face_degrees() || M.vertex_count() != P.vertex_count())
        throw std::runtime_error(control_path + " does not have the faces of " + vertices_path);
    bench::SharpMesh mesh{P.points(), P.face_degrees(), P.face_vertices(), {}, {}, false};
    read_tags(vertices_path, mesh);
    const bool triangles = M.face_degree_counts() == std::map<int, int>{{3, M.face_count()}};
    const bool loop = scheme.empty() ? triangles : scheme == "loop";
    const bench::LimitPoints limit = bench::opensubdiv_limit(mesh, loop);

    const std::vector<double> expected = M.points();
    const double diagonal = M.info().diagonal;
    double error = 0;
    std::size_t worst = 0;
    std::array<int, 3> count{};
    for (std::size_t v = 0; v < limit.found.size(); ++v) {
        ++count[static_cast<std::size_t>(limit.found[v])];
        const double here = limit.found[v] == bench::Found::left_out ? 0.0 : distance(&limit.points[3 * v], &expected[3 * v]);
        if (!(here <= error))  // also if it is not a number
            error = here, worst = v;
    }
    std::printf("{\"scheme\": \"%s\", \"by_mask\": %d, \"by_refinement\": %d, \"left_out\": %d, \"error\": %.3e, \"vertex\": %zu, ",
                loop ? "loop" : "catmull-clark", count[0], count[1], count[2], diagonal > 0 ? error / diagonal : error, worst);
    const bench::PatchErrors patches = M.face_count() <= most_faces ? bench::compare_patches(M, mesh, loop) : bench::PatchErrors();
    std::printf("\"places\": %d, \"in_end_caps\": %d, \"double\": [%.3e, %.3e, %.3e], \"single\": [%.3e, %.3e, %.3e]}\n", patches.places, patches.irregular,
                patches.points, patches.first, patches.second, patches.single_points, patches.single_first, patches.single_second);
}

}  // namespace

int main(int argc, char** argv) {
    const bool end_caps = argc == 2 && !std::strcmp(argv[1], "--end-caps");
    const std::string scheme = argc > 3 ? argv[3] : "";
    if (!end_caps && (argc < 3 || argc > 4 || (!scheme.empty() && scheme != "loop" && scheme != "catmull-clark"))) {
        std::fprintf(stderr, "usage: opensubdiv_compare M P [loop|catmull-clark], or opensubdiv_compare --end-caps\n");
        return 2;
    }
    try {
        if (end_caps) bench::print_end_caps();
        else compare(argv[1], argv[2], scheme);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "opensubdiv_compare: %s\n", error.what());
        return 1;
    }
}
