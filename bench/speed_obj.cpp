// SPDX-License-Identifier: BSD-3-Clause
// speed_obj IN --file OUT: reads an OBJ by tinyobjloader and writes it by OpenMesh, both as they come (floats, six digits). Building OpenMesh's half-edges in
// between is neither, so its seconds are printed for bench/run to take off.
#include <tiny_obj_loader.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <stdexcept>

#include "measure.h"

namespace bench {
namespace {

using Mesh = OpenMesh::PolyMesh_ArrayKernelT<>;

void build(const tinyobj::attrib_t& attributes, const tinyobj::mesh_t& faces, Mesh& mesh) {
    const std::size_t vertex_count = attributes.vertices.size() / 3;
    mesh.reserve(vertex_count, 2 * vertex_count, vertex_count);
    for (std::size_t v = 0; v < vertex_count; ++v)
        mesh.add_vertex({attributes.vertices[3 * v], attributes.vertices[3 * v + 1], attributes.vertices[3 * v + 2]});
    std::vector<Mesh::VertexHandle> corners;
    std::size_t place = 0;
    for (const unsigned degree : faces.num_face_vertices) {
        corners.clear();
        for (unsigned k = 0; k < degree; ++k) corners.emplace_back(faces.indices[place++].vertex_index);
        mesh.add_face(corners);
    }
}

void read_and_write(const Arguments& arguments) {
    Laps laps;
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    laps.time("obj.read", [&] {
        std::string warning, error;
        if (!tinyobj::LoadObj(&attributes, &shapes, nullptr, &warning, &error, arguments.part.c_str(), nullptr, false)) throw std::runtime_error(error);
    });
    if (shapes.size() != 1) throw std::runtime_error(arguments.part + " does not hold one mesh");
    Mesh mesh;
    laps.time("obj.build", [&] { build(attributes, shapes[0].mesh, mesh); });
    laps.time("obj.write", [&] {
        if (!OpenMesh::IO::write_mesh(mesh, arguments.file)) throw std::runtime_error("OpenMesh cannot write " + arguments.file);
    });
    laps.print();
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) { return bench::run_program(argc, argv, bench::read_and_write); }
