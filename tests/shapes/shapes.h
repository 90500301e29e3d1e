// SPDX-License-Identifier: BSD-3-Clause
// Small named meshes, all made by code. Closed ones are oriented outwards. Positions are in model units, of size about 1 unless said otherwise.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "host/mesh/features.h"
#include "host/mesh/polygon_mesh.h"

namespace shapes {

struct Shape {
    std::string name;
    lcl::PolygonMesh mesh;
    lcl::FeatureOptions features;
};

using Point = std::array<double, 3>;
using Face = std::vector<int>;

/// The same numbers on every machine (64-bit linear congruential generator, upper bits).
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed * 2 + 1) { next(); next(); }
    double next();            ///< in [0, 1)
    int below(int count);     ///< in 0 .. count - 1
    double symmetric() { return 2 * next() - 1; }

private:
    std::uint64_t state_;
};

Shape make(std::string name, const std::vector<Point>& points, const std::vector<Face>& faces);
std::vector<Face> faces_of(const lcl::PolygonMesh& mesh);
std::vector<Point> points_of(const lcl::PolygonMesh& mesh);
bool is_triangle_mesh(const lcl::PolygonMesh& mesh);

// Solids. All valences 3: tetrahedron, cube, dodecahedron, prisms, truncated octahedron, hexagonal torus.
Shape tetrahedron();
Shape cube();
Shape cube_split_edges();  ///< a new vertex of valence 2 in the middle of every edge: six octagons, 20 vertices
Shape octahedron();
Shape icosahedron();
Shape dodecahedron();
Shape triangular_prism();
Shape hexagonal_prism();
Shape truncated_octahedron();
Shape icosphere(int levels);        ///< 10 * 4^levels + 2 vertices on the unit sphere
Shape icosphere_quads(int levels);  ///< the same with every triangle split into three quads
Shape valence_2_pole();             ///< one vertex with two quads; four triangles close the mesh
Shape neighbour_also_diagonal();    ///< vertices 0 and 1 share an edge and are also opposite corners of a hexagon: they meet twice

// Closed rings and open sheets; m by n faces (quads) or twice as many (triangles). Tori need m, n >= 3.
Shape torus_quads(int m, int n);
Shape torus_triangles(int m, int n);
Shape hexagonal_torus(int m, int n);  ///< m * n hexagons, 2 m n vertices, all valence 3, bipartite
Shape grid_quads(int m, int n);
Shape grid_triangles(int m, int n);   ///< two of the four corners have one face, the others two
Shape grid_with_hole();               ///< 5 x 5 quads without the middle one
Shape cylinder_open(int m, int n);    ///< m quads round, n along; two boundary loops
Shape disk_pole_triangles(int n);     ///< a fan: vertex 0 has n triangles
Shape disk_pole_quads(int n);         ///< vertex 0 has n quads; n boundary vertices with one face
Shape single_triangle();
Shape single_quad();
Shape single_hexagon();

// Creases and corners.
Shape cube_with_crease();              ///< a chain of three edges: two darts, two curve vertices
Shape cube_with_crease_loop();         ///< the four top edges
Shape cube_with_dart();                ///< one edge: a dart at both its ends
Shape grid_with_creases();             ///< 6 x 6 quads: a line from boundary to boundary, a crossing, a bend with one face inside, a dart
Shape grid_with_marked_corner();       ///< an inner and a boundary vertex marked
Shape grid_triangles_with_creases();
Shape torus_with_dart();               ///< quads, a chain of three edges
Shape torus_triangles_with_dart();
Shape icosphere_with_crease_loop();    ///< triangles, the equator of an octahedron refined twice
Shape box_with_crease_angle();         ///< a cube split into 3 x 3 quads a side; the angle makes its twelve edges creases

// Random, the same for the same seed.
Shape random_triangle_mesh(int vertex_count, std::uint64_t seed, int highest_valence = 10);  ///< closed, genus 0, valences 3 to highest_valence
Shape polygons_mixed(int vertex_count, std::uint64_t seed);  ///< closed, valences 3 to 8, face degrees 3 to 10
Shape dual_of(const Shape& closed);                          ///< face centroids as vertices, one face a vertex

// Changes of a shape.
Shape rough(Shape shape, double amplitude, std::uint64_t seed);  ///< every coordinate moved by up to +-amplitude
Shape shuffled(const Shape& shape, std::uint64_t seed);          ///< vertices renumbered, faces reordered and turned
Shape transformed(Shape shape, double scale, double offset);     ///< scale * x + offset in every coordinate
Shape combined(const Shape& a, const Shape& b);                  ///< two components, b two units along x; creases and corners of both
Shape with_isolated_vertex(const Shape& shape, int number);      ///< a vertex without faces inserted at that number
Shape two_components();                                          ///< octahedron and tetrahedron

// Lists to generate tests from, all valid.
std::vector<Shape> closed_shapes();    ///< valences >= 3, smooth
std::vector<Shape> boundary_shapes();
std::vector<Shape> feature_shapes();   ///< creases, darts, marked corners
std::vector<Shape> all_shapes();       ///< the three above, valence 2, two components, isolated vertex
std::vector<Shape> triangles_only(std::vector<Shape> shapes);

// Meshes that have to be refused; the name says why.
Shape face_with_index_out_of_range();  ///< face 3 uses vertex 905 of 4
Shape face_with_negative_index();      ///< face 1 uses vertex -1
Shape repeated_vertex_in_face();       ///< face 1 has vertex 2 twice
Shape two_sided_face();                ///< face 2 has two vertices
Shape edge_with_three_faces();         ///< edge 0 1
Shape bow_tie_vertex();                ///< two triangles that share vertex 2 alone
Shape closed_bow_tie();                ///< two tetrahedra that share vertex 0 alone
Shape inconsistent_orientation();      ///< face 1 of a cube turned round
Shape moebius_strip();
Shape with_nan();                      ///< vertex 5
Shape with_infinity();                 ///< vertex 5
Shape no_faces();
Shape zero_area_face();                ///< allowed: face 0 has three equal positions

}  // namespace shapes
