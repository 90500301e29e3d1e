// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/capi/arguments.h"
#include "host/parallel.h"

using namespace lcl;

namespace {

/// Edge ends of all creases off the boundary.
std::vector<std::array<Index, 2>> crease_edges(const Topology& topology, const Features& features) {
    std::vector<std::array<Index, 2>> edges;
    for (Index e = 0; e < topology.edge_count; ++e)
        if (features.edge_is_sharp[e] && !topology.is_boundary_edge(e))
            edges.push_back({topology.origin(topology.edge_half_edge[e]), topology.destination(topology.edge_half_edge[e])});
    return edges;
}

}  // namespace

const Topology& lcl_mesh_s::sound_topology() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!topology_) topology_ = build_topology(file.mesh);
    return *topology_;
}

const Topology& lcl_mesh_s::topology() {
    const Topology& sound = sound_topology();
    refuse_tags(sound);
    return sound;
}

void lcl_mesh_s::refuse_tags(const Topology& topology) const {
    if (!file.tags.refused.empty()) throw BadInput(file.tags.refused);
    const bool no_rule = file.tags.interpolate_boundary == 0 && boundary == LCL_BOUNDARY_DEFAULT;
    if (no_rule && !topology.is_closed())
        throw BadInput(
            "the file asks for `t interpolateboundary 0` (no surface along the boundary) on a mesh with a boundary, which is not offered: choose a boundary "
            "rule");
}

const Features& lcl_mesh_s::sound_features() {
    const Topology& sound = sound_topology();
    const std::lock_guard<std::mutex> lock(mutex_);
    if (features_) return *features_;
    FeatureOptions options = feature_options;
    options.boundary = boundary_rule();
    features_ = find_features(file.mesh, sound, options);
    return *features_;
}

const Features& lcl_mesh_s::features() {
    topology();
    return sound_features();
}

const std::vector<Defect>& lcl_mesh_s::defects() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (defects_) return *defects_;
    if (!topology_) topology_ = topology_if_sound(file.mesh);
    defects_ = topology_ ? find_defects_of_sound_mesh(file.mesh) : find_defects(file.mesh);
    return *defects_;
}

BoundaryRule lcl_mesh_s::boundary_rule() const {
    switch (boundary) {
        case LCL_BOUNDARY_EDGE_ONLY: return BoundaryRule::edge_only;
        case LCL_BOUNDARY_FIXED: return BoundaryRule::fixed;
        case LCL_BOUNDARY_EDGE_AND_CORNER: return BoundaryRule::edge_and_corner;
        case LCL_BOUNDARY_DEFAULT: break;
    }
    return file.tags.interpolate_boundary == 2 ? BoundaryRule::edge_only : BoundaryRule::edge_and_corner;
}

FeatureOptions lcl_mesh_s::named_features() { return {boundary_rule(), crease_edges(topology(), features()), feature_options.corners, -1}; }

void lcl_mesh_s::keep_features_of_positions() {
    if (feature_options.crease_angle_degrees > 0) features();
}

void lcl_mesh_s::forget_positions() {
    file.normals.clear();
    file.given_normals.clear();
    was_read_with_normals = false;
    const std::lock_guard<std::mutex> lock(mutex_);
    defects_.reset();
    if (!positions_are_finite(file.mesh)) topology_.reset();  // no longer sound
}

void lcl_mesh_s::forget_features() {
    const std::lock_guard<std::mutex> lock(mutex_);
    topology_.reset();
    features_.reset();
}

namespace {

lcl_mesh adopt(MeshFile file) {
    auto mesh = std::make_unique<lcl_mesh_s>();
    mesh->feature_options.creases = file.tags.creases;
    mesh->feature_options.corners = file.tags.corners;
    mesh->notes[LCL_NOTE_WARNING] = file.warnings;
    mesh->notes[LCL_NOTE_IGNORED_TAG] = file.tags.ignored;
    for (const auto& [name, count] : file.unknown_statements) mesh->notes[LCL_NOTE_UNKNOWN_STATEMENT].push_back(name + " " + std::to_string(count));
    if (!file.tags.refused.empty()) mesh->notes[LCL_NOTE_REFUSED_TAG] = {file.tags.refused};
    mesh->file = std::move(file);
    return mesh.release();
}

lcl_mesh adopt_with_normals(MeshFile file) {
    lcl_mesh const mesh = adopt(std::move(file));
    mesh->was_read_with_normals = true;
    return mesh;
}

/// The tags that make a reader find the same features: creases however they were found, marked corners, the boundary rule where it is not the default.
void set_output_tags(lcl_mesh_s& mesh) {
    const Topology& topology = mesh.topology();
    const Features& features = mesh.features();
    MeshTags& tags = mesh.file.tags;
    tags.creases = crease_edges(topology, features);
    tags.corners = mesh.feature_options.corners;
    if (mesh.boundary_rule() == BoundaryRule::fixed)
        for (Index v = 0; v < topology.vertex_count; ++v)
            if (topology.is_boundary(v)) tags.corners.push_back(v);
    std::sort(tags.corners.begin(), tags.corners.end());
    tags.corners.erase(std::unique(tags.corners.begin(), tags.corners.end()), tags.corners.end());
    tags.interpolate_boundary = mesh.boundary_rule() == BoundaryRule::edge_only ? 2 : -1;
}

std::size_t point_stride(std::size_t stride, const char* name) {
    if (stride != 0 && stride < 3) throw InvalidArgument(std::string(name) + " is " + std::to_string(stride) + ", a point has 3 values");
    return stride == 0 ? 3 : stride;
}

template <class T>
void copy_rows(const T* points, std::size_t stride, std::size_t count, std::vector<double>& positions) {
    if (stride == 3) return positions.assign(points, points + 3 * count);
    positions.resize(3 * count);
    for (std::size_t v = 0; v < count; ++v) std::copy_n(points + v * stride, 3, &positions[3 * v]);
}

void copy_points(const lcl_mesh_data& data, std::vector<double>& positions) {
    const std::size_t stride = point_stride(data.point_stride, "data.point_stride");
    if (data.point_type != LCL_TYPE_DOUBLE && data.point_type != LCL_TYPE_FLOAT)
        throw InvalidArgument("data.point_type is " + std::to_string(data.point_type) + ", it is 0 (double) or 1 (float)");
    if (data.point_type == LCL_TYPE_FLOAT) copy_rows(static_cast<const float*>(data.points), stride, data.vertex_count, positions);
    else copy_rows(static_cast<const double*>(data.points), stride, data.vertex_count, positions);
}

void copy_faces(const lcl_mesh_data& data, PolygonMesh& mesh) {
    std::int64_t corners = 0;
    mesh.face_offsets.resize(data.face_count + std::size_t{1});
    for (int32_t f = 0; f < data.face_count; ++f) {
        const int32_t degree = data.face_degrees ? data.face_degrees[f] : data.uniform_degree;
        if (degree < 0) throw InvalidArgument("face " + std::to_string(f) + " has " + std::to_string(degree) + " sides");
        corners += degree;
        if (corners > INT32_MAX) throw OutOfMemory("the faces have more than 2147483647 corners: split the mesh");
        mesh.face_offsets[f + 1] = static_cast<Index>(corners);
    }
    if (corners > 0) mesh.face_vertices.assign(required(data.face_vertices, "data.face_vertices"), data.face_vertices + corners);
}

const std::string* note_at(lcl_mesh mesh, lcl_note kind, int32_t index) {
    if (mesh == nullptr) return nullptr;
    const auto found = mesh->notes.find(kind);
    if (found == mesh->notes.end() || index < 0 || index >= static_cast<int32_t>(found->second.size())) return nullptr;
    return &found->second[index];
}

VertexProperty* property_at(lcl_mesh mesh, int32_t index) {
    return mesh && index >= 0 && index < static_cast<int32_t>(mesh->file.properties.size()) ? &mesh->file.properties[index] : nullptr;
}

/// The range of a PLY integer type; false for the others.
bool integer_range(const std::string& type, double& low, double& high) {
    const auto is = [&](const char* name, const char* sized) { return type == name || type == sized; };
    const bool is_unsigned = type.rfind("u", 0) == 0;
    const int bits = is("char", "int8") || is("uchar", "uint8")       ? 8
                     : is("short", "int16") || is("ushort", "uint16") ? 16
                     : is("int", "int32") || is("uint", "uint32")     ? 32
                                                                      : 0;
    low = is_unsigned ? 0 : -std::ldexp(1, bits - 1);
    high = std::ldexp(1, is_unsigned ? bits : bits - 1) - 1;
    return bits > 0;
}

/// Makes a property a double where its integer type cannot hold its values (control values of channels).
bool widen(VertexProperty& property) {
    double low = 0, high = 0;
    if (!integer_range(property.type, low, high)) return false;
    const bool fits = std::all_of(property.values.begin(), property.values.end(), [&](double v) { return v == std::floor(v) && v >= low && v <= high; });
    if (!fits) property.type = "double";
    return !fits;
}

/// Red, green and blue in 8 bits from rows of three numbers from 0 to 1.
std::vector<VertexProperty> colour_columns(const double* colours, Index vertex_count) {
    std::vector<VertexProperty> columns;
    for (const char* name : {"red", "green", "blue"}) columns.push_back({name, VertexProperty::Kind::colour, "uchar", {}});
    for (std::size_t i = 0; i < 3 * static_cast<std::size_t>(vertex_count); ++i) {
        if (!(colours[i] >= 0 && colours[i] <= 1))
            throw InvalidArgument(
                "colours: " + columns[i % 3].name + " of vertex " + std::to_string(i / 3) + " is " + std::to_string(colours[i]) + ", it goes from 0 to 1",
                {{static_cast<Index>(i / 3)}, {}});
        columns[i % 3].values.push_back(std::round(255 * colours[i]));
    }
    return columns;
}

/// The values and how often each of them is met; `value` gives those of 0 to count - 1, below zero: not counted.
template <class Value>
std::map<Index, Index> count_values(Index count, const Value& value) {
    std::vector<Index> times;
    for (Index i = 0; i < count; ++i) {
        const Index v = value(i);
        if (v < 0) continue;
        if (static_cast<std::size_t>(v) >= times.size()) times.resize(static_cast<std::size_t>(v) + 1);
        ++times[static_cast<std::size_t>(v)];
    }
    std::map<Index, Index> counts;
    for (std::size_t v = 0; v < times.size(); ++v)
        if (times[v] > 0) counts[static_cast<Index>(v)] = times[v];
    return counts;
}

std::map<Index, Index> histogram(lcl_mesh_s& mesh, lcl_histogram which) {
    if (which != LCL_HISTOGRAM_FACE_DEGREES && which != LCL_HISTOGRAM_VALENCES)
        throw InvalidArgument("which is " + std::to_string(which) + ", it is 0 (face degrees) or 1 (valences)");
    if (which == LCL_HISTOGRAM_FACE_DEGREES) return count_values(mesh.file.mesh.face_count(), [&](Index f) { return mesh.file.mesh.degree(f); });
    const Topology& topology = mesh.sound_topology();
    return count_values(topology.vertex_count, [&](Index v) { return topology.is_isolated(v) ? -1 : topology.valence(v); });
}

lcl_mesh_info sound_info(lcl_mesh_s& mesh, lcl_mesh_info info) {
    const Topology& topology = mesh.sound_topology();
    const Features& features = mesh.sound_features();
    info.edges = topology.edge_count;
    info.boundary_edges = 0;
    for (Index e = 0; e < topology.edge_count; ++e) info.boundary_edges += topology.is_boundary_edge(e);
    info.boundary_loops = static_cast<int32_t>(boundary_loops(topology).size());
    connected_components(topology, info.components);
    info.creases = features.crease_count;
    info.corners = features.corner_count;
    return info;
}

}  // namespace

void lcl::set_colours(lcl_mesh_s& mesh, const double* colours) {
    std::vector<VertexProperty>& properties = mesh.file.properties;
    for (const VertexProperty& column : colour_columns(colours, mesh.file.mesh.vertex_count)) {
        const auto found = std::find_if(properties.begin(), properties.end(), [&](const VertexProperty& p) { return p.name == column.name; });
        if (found == properties.end()) properties.push_back(column);
        else *found = column;
    }
}

extern "C" {

lcl_status lcl_mesh_create(const lcl_mesh_data* data, lcl_mesh* mesh) {
    return guarded([&] {
        required(mesh, "mesh");
        const lcl_mesh_data given = options_or(required(data, "data"), LCL_MESH_DATA_INIT, "data");
        if (given.vertex_count < 0 || given.face_count < 0) throw InvalidArgument("data has a negative vertex or face count");
        if (given.vertex_count > 0) required(given.points, "data.points");
        MeshFile file;
        file.mesh.vertex_count = given.vertex_count;
        parallel_for(
            2,
            [&](std::size_t begin, std::size_t end) {
                if (begin == 0) copy_points(given, file.mesh.positions);
                if (end == 2) copy_faces(given, file.mesh);
            },
            given.vertex_count < static_cast<Index>(smallest_parallel_piece) ? 2 : 1);
        *mesh = adopt(std::move(file));
        return LCL_OK;
    });
}

lcl_status lcl_mesh_read(const char* path, lcl_format format, lcl_mesh* mesh) {
    return guarded([&] {
        required(mesh, "mesh");
        *mesh = adopt(read_mesh(required(path, "path"), inner_format(format)));
        return LCL_OK;
    });
}

lcl_status lcl_mesh_read_memory(const void* bytes, size_t size, lcl_format format, const char* name, lcl_mesh* mesh) {
    return guarded([&] {
        required(mesh, "mesh");
        if (size > 0) required(bytes, "bytes");
        *mesh = adopt(read_mesh_memory(static_cast<const char*>(bytes), size, inner_format(format), name ? name : "memory"));
        return LCL_OK;
    });
}

lcl_status lcl_mesh_read_with_normals(const char* path, lcl_format format, lcl_mesh* mesh) {
    return guarded([&] {
        required(mesh, "mesh");
        *mesh = adopt_with_normals(read_mesh(required(path, "path"), inner_format(format), true));
        return LCL_OK;
    });
}

lcl_status lcl_mesh_read_memory_with_normals(const void* bytes, size_t size, lcl_format format, const char* name, lcl_mesh* mesh) {
    return guarded([&] {
        required(mesh, "mesh");
        if (size > 0) required(bytes, "bytes");
        *mesh = adopt_with_normals(read_mesh_memory(static_cast<const char*>(bytes), size, inner_format(format), name ? name : "memory", true));
        return LCL_OK;
    });
}

lcl_status lcl_mesh_get_normals(lcl_mesh mesh, double* normals) {
    return guarded([&] {
        if (!required(mesh, "mesh")->was_read_with_normals)
            throw InvalidArgument("this mesh was not read with its normals, or its points have changed since: use lcl_mesh_read_with_normals");
        const std::vector<double>& given = mesh->file.given_normals;
        if (given.empty() && mesh->file.mesh.vertex_count > 0)
            throw BadInput("the file holds no normals of vertices (OBJ vn, PLY nx ny nz, OFF with N): give them in another way");
        std::copy(given.begin(), given.end(), required(normals, "normals"));
        return LCL_OK;
    });
}

lcl_status lcl_mesh_write(lcl_mesh mesh, const char* path, lcl_format format) {
    return guarded([&] {
        required(mesh, "mesh");
        set_output_tags(*mesh);
        std::vector<std::string>& warnings = mesh->notes[LCL_NOTE_WARNING];
        write_mesh(required(path, "path"), mesh->file, inner_format(format), warnings);
        return LCL_OK;
    });
}

lcl_status lcl_format_of_path(const char* path, lcl_format* format) {
    return guarded([&] {
        bool gzip = false;
        *required(format, "format") = static_cast<lcl_format>(format_of_path(required(path, "path"), gzip));
        return LCL_OK;
    });
}

lcl_status lcl_mesh_copy(lcl_mesh mesh, lcl_mesh* copy) {
    return guarded([&] {
        required(copy, "copy");
        auto out = std::make_unique<lcl_mesh_s>();
        out->file = required(mesh, "mesh")->file;
        out->feature_options = mesh->feature_options;
        out->boundary = mesh->boundary;
        out->locations = mesh->locations;
        out->was_read_with_normals = mesh->was_read_with_normals;
        out->two_phase_vertices = mesh->two_phase_vertices;
        out->notes = mesh->notes;
        if (out->feature_options.crease_angle_degrees > 0) {  // found on these points, not on those that the copy may get
            out->feature_options.creases = crease_edges(mesh->topology(), mesh->features());
            out->feature_options.crease_angle_degrees = -1;
        }
        *copy = out.release();
        return LCL_OK;
    });
}

void lcl_mesh_retain(lcl_mesh mesh) { retain(mesh); }
void lcl_mesh_release(lcl_mesh mesh) { release(mesh); }

int32_t lcl_mesh_vertex_count(lcl_mesh mesh) { return mesh ? mesh->file.mesh.vertex_count : 0; }
int32_t lcl_mesh_face_count(lcl_mesh mesh) { return mesh ? mesh->file.mesh.face_count() : 0; }
int32_t lcl_mesh_corner_count(lcl_mesh mesh) { return mesh ? mesh->file.mesh.corner_count() : 0; }

lcl_status lcl_mesh_get_faces(lcl_mesh mesh, int32_t* face_degrees, int32_t* face_vertices) {
    return guarded([&] {
        const PolygonMesh& polygons = required(mesh, "mesh")->file.mesh;
        for (Index f = 0; face_degrees != nullptr && f < polygons.face_count(); ++f) face_degrees[f] = polygons.degree(f);
        if (face_vertices != nullptr) std::copy(polygons.face_vertices.begin(), polygons.face_vertices.end(), face_vertices);
        return LCL_OK;
    });
}

lcl_status lcl_mesh_get_points(lcl_mesh mesh, double* points, size_t stride) {
    return guarded([&] {
        const PolygonMesh& polygons = required(mesh, "mesh")->file.mesh;
        const std::size_t step = point_stride(stride, "stride");
        for (Index v = 0; v < polygons.vertex_count; ++v)
            std::copy_n(&polygons.positions[3 * static_cast<std::size_t>(v)], 3, required(points, "points") + v * step);
        return LCL_OK;
    });
}

lcl_status lcl_mesh_set_points(lcl_mesh mesh, const double* points, size_t stride) {
    return guarded([&] {
        required(mesh, "mesh")->keep_features_of_positions();
        PolygonMesh& polygons = mesh->file.mesh;
        const std::size_t step = point_stride(stride, "stride");
        for (Index v = 0; v < polygons.vertex_count; ++v)
            std::copy_n(required(points, "points") + v * step, 3, &polygons.positions[3 * static_cast<std::size_t>(v)]);
        mesh->forget_positions();
        return LCL_OK;
    });
}

lcl_status lcl_mesh_set_normals(lcl_mesh mesh, const double* normals) {
    return guarded([&] {
        std::vector<double>& own = required(mesh, "mesh")->file.normals;
        if (normals == nullptr) own.clear();
        else own.assign(normals, normals + 3 * static_cast<std::size_t>(mesh->file.mesh.vertex_count));
        return LCL_OK;
    });
}

lcl_status lcl_mesh_add_features(lcl_mesh mesh, const lcl_features* features) {
    return guarded([&] {
        required(mesh, "mesh");
        const lcl_features given = options_or(required(features, "features"), LCL_FEATURES_INIT, "features");
        if (given.boundary < LCL_BOUNDARY_DEFAULT || given.boundary > LCL_BOUNDARY_FIXED)
            throw InvalidArgument("features.boundary is " + std::to_string(given.boundary) + ", it goes from 0 to 3");
        if (std::isnan(given.crease_angle_degrees) || given.crease_angle_degrees > 180)
            throw InvalidArgument("features.crease_angle_degrees goes from 0 to 180");
        if (given.crease_count > 0) required(given.creases, "features.creases");
        if (given.corner_count > 0) required(given.corners, "features.corners");
        FeatureOptions& own = mesh->feature_options;
        for (std::size_t i = 0; i < given.crease_count; ++i) own.creases.push_back({given.creases[2 * i], given.creases[2 * i + 1]});
        own.corners.insert(own.corners.end(), given.corners, given.corners + given.corner_count);
        if (given.crease_angle_degrees > 0) own.crease_angle_degrees = given.crease_angle_degrees;
        if (given.boundary != LCL_BOUNDARY_DEFAULT) mesh->boundary = given.boundary;
        mesh->forget_features();
        return LCL_OK;
    });
}

lcl_status lcl_mesh_get_features(lcl_mesh mesh, lcl_boundary* boundary, int32_t* creases, size_t* crease_count, int32_t* corners, size_t* corner_count) {
    return guarded([&] {
        const Topology& topology = required(mesh, "mesh")->sound_topology();
        const Features& features = mesh->sound_features();
        if (boundary != nullptr) *boundary = static_cast<lcl_boundary>(static_cast<int>(mesh->boundary_rule()) + 1);
        if (crease_count != nullptr) *crease_count = features.crease_count;
        if (corner_count != nullptr) *corner_count = features.corner_count;
        if (creases != nullptr)
            for (const auto& edge : crease_edges(topology, features)) creases = std::copy(edge.begin(), edge.end(), creases);
        for (Index v = 0; corners != nullptr && v < topology.vertex_count; ++v)
            if (features.kind[v] == VertexKind::corner) *corners++ = v;
        return LCL_OK;
    });
}

lcl_status lcl_mesh_get_info(lcl_mesh mesh, lcl_mesh_info* info) {
    return guarded([&] {
        const PolygonMesh& polygons = required(mesh, "mesh")->file.mesh;
        lcl_mesh_info out = LCL_MESH_INFO_INIT;
        out.vertices = polygons.vertex_count;
        out.faces = polygons.face_count();
        out.edges = out.boundary_edges = out.boundary_loops = out.components = out.creases = out.corners = -1;
        std::vector<std::uint8_t> used(polygons.vertex_count, 0);
        bool are_there = true;
        for (const Index v : polygons.face_vertices) {
            if (v >= 0 && v < polygons.vertex_count) used[v] = 1;
            else are_there = false;
        }
        out.isolated_vertices = polygons.vertex_count - std::accumulate(used.begin(), used.end(), Index{0});
        if (are_there) out.diagonal = bounding_box_diagonal(polygons);
        try {
            out = sound_info(*mesh, out);
        } catch (const BadInput&) {  // counts of a mesh that is not sound: lcl_mesh_validate says why
        }
        give(info, out, "info");
        return LCL_OK;
    });
}

lcl_status lcl_mesh_get_histogram(lcl_mesh mesh, lcl_histogram which, int32_t* keys, int32_t* counts, size_t capacity, size_t* size) {
    return guarded([&] {
        const std::map<Index, Index> all = histogram(*required(mesh, "mesh"), which);
        if (size != nullptr) *size = all.size();
        std::size_t place = 0;
        for (const auto& [key, count] : all) {
            if (place == capacity) break;
            if (keys != nullptr) keys[place] = key;
            if (counts != nullptr) counts[place] = count;
            ++place;
        }
        return LCL_OK;
    });
}

lcl_status lcl_mesh_validate(lcl_mesh mesh) {
    return guarded([&] {
        required(mesh, "mesh")->features();
        return LCL_OK;
    });
}

int32_t lcl_mesh_defect_count(lcl_mesh mesh) {
    int32_t count = 0;
    guarded([&] {
        count = static_cast<int32_t>(required(mesh, "mesh")->defects().size());
        return LCL_OK;
    });
    return count;
}

lcl_status lcl_mesh_get_defect(lcl_mesh mesh, int32_t index, lcl_defect* defect) {
    return guarded([&] {
        const std::vector<Defect>& all = required(mesh, "mesh")->defects();
        if (index < 0 || index >= static_cast<int32_t>(all.size()))
            throw InvalidArgument("defect " + std::to_string(index) + " of " + std::to_string(all.size()) + " was asked for");
        lcl_defect out = LCL_DEFECT_INIT;
        out.kind = defect_name(all[index].kind);
        out.message = all[index].message.c_str();
        out.count = all[index].count;
        out.vertex_count = copy_first(out.vertices, all[index].where.vertices);
        out.face_count = copy_first(out.faces, all[index].where.faces);
        give(defect, out, "defect");
        return LCL_OK;
    });
}

int32_t lcl_mesh_property_count(lcl_mesh mesh) { return mesh ? static_cast<int32_t>(mesh->file.properties.size()) : 0; }

const char* lcl_mesh_property_name(lcl_mesh mesh, int32_t index) {
    const VertexProperty* property = property_at(mesh, index);
    return property ? property->name.c_str() : nullptr;
}

int32_t lcl_mesh_property_is_colour(lcl_mesh mesh, int32_t index) {
    const VertexProperty* property = property_at(mesh, index);
    return property != nullptr && property->kind == VertexProperty::Kind::colour;
}

lcl_status lcl_mesh_get_property(lcl_mesh mesh, int32_t index, double* values) {
    return guarded([&] {
        const VertexProperty* property = property_at(required(mesh, "mesh"), index);
        if (property == nullptr)
            throw InvalidArgument("property " + std::to_string(index) + " was asked for, the mesh has " + std::to_string(mesh->file.properties.size()));
        if (!property->values.empty()) std::copy(property->values.begin(), property->values.end(), required(values, "values"));
        return LCL_OK;
    });
}

lcl_status lcl_mesh_set_property(lcl_mesh mesh, const char* name, const double* values) {
    return guarded([&] {
        std::vector<VertexProperty>& properties = required(mesh, "mesh")->file.properties;
        const std::string wanted = required(name, "name");
        required(values, "values");
        auto found = std::find_if(properties.begin(), properties.end(), [&](const VertexProperty& p) { return p.name == wanted; });
        if (found == properties.end()) found = properties.insert(properties.end(), {wanted, VertexProperty::Kind::scalar, "double", {}});
        found->values.assign(values, values + mesh->file.mesh.vertex_count);
        if (widen(*found))
            mesh->notes[LCL_NOTE_WARNING].push_back("the property '" + wanted + "' holds values now that its integer type cannot: it is kept as double");
        return LCL_OK;
    });
}

lcl_status lcl_mesh_set_colours(lcl_mesh mesh, const double* colours) {
    return guarded([&] {
        required(mesh, "mesh");
        set_colours(*mesh, required(colours, "colours"));
        return LCL_OK;
    });
}

int32_t lcl_mesh_note_count(lcl_mesh mesh, lcl_note kind) {
    const auto found = mesh ? mesh->notes.find(kind) : decltype(mesh->notes.find(kind)){};
    return mesh && found != mesh->notes.end() ? static_cast<int32_t>(found->second.size()) : 0;
}

const char* lcl_mesh_note(lcl_mesh mesh, lcl_note kind, int32_t index) {
    const std::string* note = note_at(mesh, kind, index);
    return note ? note->c_str() : nullptr;
}

}  // extern "C"
