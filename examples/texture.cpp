// SPDX-License-Identifier: BSD-3-Clause
// C++17: a procedural texture as vertex colours, for the refined surface and for the mesh itself; without a mesh file on a torus.
// usage: texture [MESH TEXTURED.ply COLOURED.ply]
#include <limitcl/limitcl.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace {

// 16 x 8 quads round an axis.
limitcl::Mesh make_torus() {
    const int around = 16, across = 8;
    const double turn = 2 * std::acos(-1.0);
    std::vector<double> points;
    std::vector<std::int32_t> quads;
    for (int j = 0; j < across; ++j)
        for (int i = 0; i < around; ++i) {
            const double u = turn * i / around, v = turn * j / across, radius = 2 + 0.8 * std::cos(v);
            points.insert(points.end(), {radius * std::cos(u), radius * std::sin(u), 0.8 * std::sin(v)});
            const int right = (i + 1) % around, up = (j + 1) % across;
            quads.insert(quads.end(), {j * around + i, j * around + right, up * around + right, up * around + i});
        }
    return limitcl::Mesh::from_uniform_faces(points, 4, quads);
}

// The noise goes from 0 to 1, and every colour is one of the 256 steps of a PLY file.
bool is_complete(const limitcl::Mesh& textured) {
    const std::vector<double> noise = textured.property("noise");
    bool complete = *std::min_element(noise.begin(), noise.end()) == 0 && *std::max_element(noise.begin(), noise.end()) == 1;
    for (const char* name : {"red", "green", "blue"})
        for (const double value : textured.property(name)) complete = complete && value >= 0 && value <= 255 && value == std::round(value);
    return complete;
}

// Catmull-Clark and Loop keep the numbers of old vertices, so the first colours are those of the mesh itself.
void colour_like(limitcl::Mesh& mesh, const limitcl::Mesh& textured) {
    std::vector<double> colours(3 * static_cast<std::size_t>(mesh.vertex_count()));
    const char* const names[] = {"red", "green", "blue"};
    for (std::size_t c = 0; c < 3; ++c) {
        const std::vector<double> values = textured.property(names[c]);
        for (std::size_t v = 0; v < colours.size() / 3; ++v) colours[3 * v + c] = values[v] / 255;
    }
    mesh.set_colours(colours);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const limitcl::Context context;
        limitcl::Mesh mesh = argc == 4 ? limitcl::read_mesh(argv[1]) : make_torus();
        limitcl::TextureOptions options;
        options.frequency = 6;
        options.seed = 7;
        options.colours = {0.35, 0.15, 0.05, 0.60, 0.32, 0.12, 0.80, 0.55, 0.30, 0.55, 0.28, 0.10};  // wood
        const limitcl::Texture texture = limitcl::make_texture(context, mesh, options);
        const bool complete = is_complete(texture.mesh);
        std::printf("%s: %d octaves of noise on %d vertices, worst solve: %d iterations, error %.1e\n", context.device().name.c_str(), options.octaves,
                    texture.mesh.vertex_count(), texture.report.iterations, texture.report.max_error);

        const bool same = limitcl::make_texture(context, mesh, options).mesh.property("noise") == texture.mesh.property("noise");
        options.seed = 8;
        const bool other = limitcl::make_texture(context, mesh, options).mesh.property("noise") != texture.mesh.property("noise");
        std::printf("the same seed gives %s texture, another seed %s\n", same ? "the same" : "a different", other ? "another" : "the same");

        colour_like(mesh, texture.mesh);
        if (argc == 4) {
            limitcl::write_mesh(texture.mesh, argv[2]);
            limitcl::write_mesh(mesh, argv[3]);
        }
        return complete && same && other ? 0 : 1;
    } catch (const limitcl::Error& error) {
        std::fprintf(stderr, "%s: %s\n", error.status_name(), error.what());
        return 1;
    }
}
