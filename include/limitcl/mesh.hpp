// SPDX-License-Identifier: BSD-3-Clause
// Meshes: polygons, points, sharp features, and per-vertex data.
#ifndef LIMITCL_MESH_HPP
#define LIMITCL_MESH_HPP

#include "array_view.hpp"
#include "error.hpp"
#include "handle.hpp"

#include <map>

namespace limitcl {

/// Points in the caller's memory, model units: `count` rows of three values, rows `stride` values apart, float or double.
struct PointView {
    PointView(const double* points, std::size_t rows, std::size_t row_stride = 3) : data(points), count(rows), stride(row_stride), type(LCL_TYPE_DOUBLE) {}
    PointView(const float* points, std::size_t rows, std::size_t row_stride = 3) : data(points), count(rows), stride(row_stride), type(LCL_TYPE_FLOAT) {}
    PointView(const std::vector<double>& xyz) : PointView(xyz.data(), whole_points(xyz.size())) {}
    PointView(const std::vector<float>& xyz) : PointView(xyz.data(), whole_points(xyz.size())) {}

    const void* data;
    std::size_t count;
    std::size_t stride;
    lcl_type type;

private:
    static std::size_t whole_points(std::size_t values) {
        if (values % 3 != 0)
            throw Error(LCL_ERROR_INVALID_ARGUMENT, std::to_string(values) + " values are no whole number of points; give three values a point");
        return values / 3;
    }
};

enum class Boundary {
    by_file = LCL_BOUNDARY_DEFAULT,                  ///< the file's tag, else edge_and_corner
    edge_and_corner = LCL_BOUNDARY_EDGE_AND_CORNER,  ///< boundary curves; vertices with one face are corners
    edge_only = LCL_BOUNDARY_EDGE_ONLY,              ///< boundary curves everywhere
    fixed = LCL_BOUNDARY_FIXED                       ///< every boundary vertex is a corner
};

/// Sharp features beside the boundary.
struct Features {
    Boundary boundary = Boundary::by_file;
    std::vector<std::int32_t> creases;  ///< pairs of vertices, one pair an edge
    std::vector<std::int32_t> corners;  ///< vertices that stay where they are
    double crease_angle_degrees = 0;    ///< > 0: edges whose face normals differ by more are creases (add_features only)
};

/// Counts of a mesh. Edges and what follows from them are -1 on a mesh that is not sound.
struct MeshInfo {
    int vertices = 0, faces = 0, edges = 0, boundary_edges = 0, boundary_loops = 0, components = 0, isolated_vertices = 0;
    int creases = 0;      ///< sharp edges off the boundary
    int corners = 0;      ///< vertices that stay, isolated ones not counted
    double diagonal = 0;  ///< of the bounding box of the vertices that a face uses, model units
};

/// One kind of defect of a mesh with the first ten places.
struct Defect {
    std::string kind, message;
    std::int64_t count = 0;
    std::vector<std::int32_t> vertices, faces;
};

/// A mesh. Copies share it; copy() makes one of its own. It may be read from several threads; functions that change it need it alone.
class Mesh {
public:
    /// From arrays, copied: points (vertex_count x 3), face_degrees (face_count sides, each 3 or more), face_vertices (their sum, zero-based).
    /// Counts are checked here, the mesh itself by validate() or where a function needs it sound. Errors: LCL_ERROR_INVALID_ARGUMENT, LCL_ERROR_BAD_INPUT.
    static Mesh from_faces(PointView points, ArrayView<std::int32_t> face_degrees, ArrayView<std::int32_t> face_vertices);
    /// The same with faces that all have `degree` sides: 3 triangles, 4 quads.
    static Mesh from_uniform_faces(PointView points, int degree, ArrayView<std::int32_t> face_vertices);
    /// Takes over a reference of the C API.
    explicit Mesh(MeshHandle handle) : handle_(std::move(handle)) {}

    lcl_mesh get() const { return handle_.get(); }
    /// A mesh with its own points; faces, features and properties are those of this one.
    Mesh copy() const;

    int vertex_count() const { return lcl_mesh_vertex_count(get()); }
    int face_count() const { return lcl_mesh_face_count(get()); }
    /// Sum of the face degrees.
    int corner_count() const { return lcl_mesh_corner_count(get()); }
    /// face_count values.
    std::vector<std::int32_t> face_degrees() const;
    /// corner_count values, face after face.
    std::vector<std::int32_t> face_vertices() const;
    /// vertex_count x 3, model units.
    std::vector<double> points() const;
    /// Replaces the points: vertex_count x 3, model units.
    void set_points(ArrayView<double> points);
    /// Unit normals that a writer puts beside the points: vertex_count x 3; empty: none.
    void set_normals(ArrayView<double> normals);
    /// Normals as the file holds them, of a mesh from read_mesh_with_normals: vertex_count x 3, NaN where a vertex has none.
    /// Errors: LCL_ERROR_BAD_INPUT where the file has none, LCL_ERROR_INVALID_ARGUMENT where they were not read or the points have changed.
    std::vector<double> file_normals() const;

    /// Adds sharp features to those that are there and sets the boundary rule. Operators made before keep what they were made with.
    void add_features(const Features& features);
    /// The resolved features: creases off the boundary and corners, however they were found.
    Features features() const;

    MeshInfo info() const;
    /// Number of faces by their degree.
    std::map<int, int> face_degree_counts() const { return histogram(LCL_HISTOGRAM_FACE_DEGREES); }
    /// Number of vertices by their number of edges. Error LCL_ERROR_BAD_INPUT on a mesh that is not sound.
    std::map<int, int> valence_counts() const { return histogram(LCL_HISTOGRAM_VALENCES); }
    /// Throws LCL_ERROR_BAD_INPUT with the first reason unless the mesh is manifold, consistently oriented, finite and without a tag that is refused.
    void validate() const { check(lcl_mesh_validate(get())); }
    std::vector<Defect> defects() const;

    /// Per-vertex data (colours, PLY scalar properties) by name, in the order of the file.
    std::vector<std::string> property_names() const;
    /// vertex_count values. Error LCL_ERROR_INVALID_ARGUMENT if there is none of that name.
    std::vector<double> property(const std::string& name) const;
    /// Sets a property that is there or adds one: vertex_count values.
    void set_property(const std::string& name, ArrayView<double> values);
    /// Colours of the vertices, kept in 8 bits: vertex_count x (red, green, blue) from 0 to 1.
    void set_colours(ArrayView<double> colours);
    /// Sentences on what reading, refining or writing could not keep.
    std::vector<std::string> warnings() const;

private:
    static Mesh create(const PointView& points, lcl_mesh_data& data);
    std::map<int, int> histogram(lcl_histogram which) const;
    void require_size(std::size_t size, std::size_t per_vertex, const char* what) const;

    MeshHandle handle_;
};

inline Mesh Mesh::create(const PointView& points, lcl_mesh_data& data) {
    if (points.count > INT32_MAX)
        throw Error(LCL_ERROR_INVALID_ARGUMENT, std::to_string(points.count) + " points are more than the 2147483647 that a mesh can have");
    data.vertex_count = static_cast<std::int32_t>(points.count);
    data.points = points.data;
    data.point_type = points.type;
    data.point_stride = points.stride;
    lcl_mesh mesh = nullptr;
    check(lcl_mesh_create(&data, &mesh));
    return Mesh(MeshHandle(mesh));
}

inline Mesh Mesh::from_faces(PointView points, ArrayView<std::int32_t> face_degrees, ArrayView<std::int32_t> face_vertices) {
    std::int64_t corners = 0;
    for (const std::int32_t degree : face_degrees) corners += degree;
    if (face_degrees.size() > INT32_MAX || corners != static_cast<std::int64_t>(face_vertices.size()))
        throw Error(LCL_ERROR_INVALID_ARGUMENT, "the face degrees add up to " + std::to_string(corners) + ", but there are " +
                                                    std::to_string(face_vertices.size()) + " face vertices; give one for each corner");
    lcl_mesh_data data = LCL_MESH_DATA_INIT;
    data.face_count = static_cast<std::int32_t>(face_degrees.size());
    data.face_degrees = face_degrees.data();
    data.face_vertices = face_vertices.data();
    return create(points, data);
}

inline Mesh Mesh::from_uniform_faces(PointView points, int degree, ArrayView<std::int32_t> face_vertices) {
    if (degree < 3 || face_vertices.size() % static_cast<std::size_t>(degree) != 0 || face_vertices.size() / static_cast<std::size_t>(degree) > INT32_MAX)
        throw Error(LCL_ERROR_INVALID_ARGUMENT, std::to_string(face_vertices.size()) + " face vertices do not make faces of " + std::to_string(degree) +
                                                    " sides; give degree values a face, degree 3 or more");
    lcl_mesh_data data = LCL_MESH_DATA_INIT;
    data.face_count = static_cast<std::int32_t>(face_vertices.size() / static_cast<std::size_t>(degree));
    data.uniform_degree = degree;
    data.face_vertices = face_vertices.data();
    return create(points, data);
}

inline Mesh Mesh::copy() const {
    lcl_mesh mesh = nullptr;
    check(lcl_mesh_copy(get(), &mesh));
    return Mesh(MeshHandle(mesh));
}

inline std::vector<std::int32_t> Mesh::face_degrees() const {
    std::vector<std::int32_t> degrees(static_cast<std::size_t>(face_count()));
    check(lcl_mesh_get_faces(get(), degrees.data(), nullptr));
    return degrees;
}

inline std::vector<std::int32_t> Mesh::face_vertices() const {
    std::vector<std::int32_t> vertices(static_cast<std::size_t>(corner_count()));
    check(lcl_mesh_get_faces(get(), nullptr, vertices.data()));
    return vertices;
}

inline std::vector<double> Mesh::points() const {
    std::vector<double> points(3 * static_cast<std::size_t>(vertex_count()));
    check(lcl_mesh_get_points(get(), points.data(), 3));
    return points;
}

inline void Mesh::require_size(std::size_t size, std::size_t per_vertex, const char* what) const {
    const std::size_t expected = per_vertex * static_cast<std::size_t>(vertex_count());
    if (size != expected)
        throw Error(LCL_ERROR_INVALID_ARGUMENT,
                    std::string(what) + ": " + std::to_string(size) + " values were given, the mesh needs " + std::to_string(expected));
}

inline void Mesh::set_points(ArrayView<double> points) {
    require_size(points.size(), 3, "points");
    check(lcl_mesh_set_points(get(), points.data(), 3));
}

inline std::vector<double> Mesh::file_normals() const {
    std::vector<double> normals(3 * static_cast<std::size_t>(vertex_count()));
    check(lcl_mesh_get_normals(get(), normals.data()));
    return normals;
}

inline void Mesh::set_normals(ArrayView<double> normals) {
    if (!normals.empty()) require_size(normals.size(), 3, "normals");
    check(lcl_mesh_set_normals(get(), normals.empty() ? nullptr : normals.data()));
}

inline void Mesh::add_features(const Features& features) {
    if (features.creases.size() % 2 != 0) throw Error(LCL_ERROR_INVALID_ARGUMENT, "the creases hold an odd number of vertices; give two for each edge");
    lcl_features c = LCL_FEATURES_INIT;
    c.boundary = static_cast<lcl_boundary>(features.boundary);
    c.creases = features.creases.data();
    c.crease_count = features.creases.size() / 2;
    c.corners = features.corners.data();
    c.corner_count = features.corners.size();
    c.crease_angle_degrees = features.crease_angle_degrees;
    check(lcl_mesh_add_features(get(), &c));
}

inline Features Mesh::features() const {
    lcl_boundary boundary = LCL_BOUNDARY_DEFAULT;
    std::size_t crease_count = 0, corner_count = 0;
    check(lcl_mesh_get_features(get(), &boundary, nullptr, &crease_count, nullptr, &corner_count));
    Features features;
    features.boundary = static_cast<Boundary>(boundary);
    features.creases.resize(2 * crease_count);
    features.corners.resize(corner_count);
    check(lcl_mesh_get_features(get(), nullptr, features.creases.data(), nullptr, features.corners.data(), nullptr));
    return features;
}

inline MeshInfo Mesh::info() const {
    lcl_mesh_info c = LCL_MESH_INFO_INIT;
    check(lcl_mesh_get_info(get(), &c));
    return {c.vertices, c.faces, c.edges, c.boundary_edges, c.boundary_loops, c.components, c.isolated_vertices, c.creases, c.corners, c.diagonal};
}

inline std::map<int, int> Mesh::histogram(lcl_histogram which) const {
    std::size_t size = 0;
    check(lcl_mesh_get_histogram(get(), which, nullptr, nullptr, 0, &size));
    std::vector<std::int32_t> keys(size), counts(size);
    check(lcl_mesh_get_histogram(get(), which, keys.data(), counts.data(), size, &size));
    std::map<int, int> histogram;
    for (std::size_t i = 0; i < size; ++i) histogram[keys[i]] = counts[i];
    return histogram;
}

inline std::vector<Defect> Mesh::defects() const {
    std::vector<Defect> defects;
    for (std::int32_t i = 0; i < lcl_mesh_defect_count(get()); ++i) {
        lcl_defect c = LCL_DEFECT_INIT;
        check(lcl_mesh_get_defect(get(), i, &c));
        defects.push_back({c.kind, c.message, c.count, {c.vertices, c.vertices + c.vertex_count}, {c.faces, c.faces + c.face_count}});
    }
    return defects;
}

inline std::vector<std::string> Mesh::property_names() const {
    std::vector<std::string> names;
    for (std::int32_t i = 0; i < lcl_mesh_property_count(get()); ++i) names.emplace_back(lcl_mesh_property_name(get(), i));
    return names;
}

inline std::vector<double> Mesh::property(const std::string& name) const {
    const std::vector<std::string> names = property_names();
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i] == name) {
            std::vector<double> values(static_cast<std::size_t>(vertex_count()));
            check(lcl_mesh_get_property(get(), static_cast<std::int32_t>(i), values.data()));
            return values;
        }
    throw Error(LCL_ERROR_INVALID_ARGUMENT, "the mesh has no property '" + name + "'; property_names() lists those that it has");
}

inline void Mesh::set_property(const std::string& name, ArrayView<double> values) {
    require_size(values.size(), 1, name.c_str());
    check(lcl_mesh_set_property(get(), name.c_str(), values.data()));
}

inline void Mesh::set_colours(ArrayView<double> colours) {
    require_size(colours.size(), 3, "colours");
    check(lcl_mesh_set_colours(get(), colours.data()));
}

inline std::vector<std::string> Mesh::warnings() const {
    std::vector<std::string> notes;
    for (std::int32_t i = 0; i < lcl_mesh_note_count(get(), LCL_NOTE_WARNING); ++i) notes.emplace_back(lcl_mesh_note(get(), LCL_NOTE_WARNING, i));
    return notes;
}

}  // namespace limitcl

#endif
