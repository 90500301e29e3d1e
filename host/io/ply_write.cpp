// SPDX-License-Identifier: BSD-3-Clause
// The writer of PLY; what it writes is what ply.cpp reads.
#include <algorithm>
#include <cstdint>
#include <limits>

#include "host/io/format.h"
#include "host/io/number_write.h"
#include "host/io/ply_types.h"

namespace lcl {
namespace {

/// One row of the body, in any encoding.
class PlyRow {
public:
    PlyRow(OutputBuffer& out, bool is_ascii, bool swap) : out_(out), is_ascii_(is_ascii), swap_(swap) {}

    void write(double value, Scalar scalar) {
        switch (scalar) {
            case Scalar::int8: return write_whole<std::int8_t>(value);
            case Scalar::uint8: return write_whole<std::uint8_t>(value);
            case Scalar::int16: return write_whole<std::int16_t>(value);
            case Scalar::uint16: return write_whole<std::uint16_t>(value);
            case Scalar::int32: return write_whole<std::int32_t>(value);
            case Scalar::uint32: return write_whole<std::uint32_t>(value);
            case Scalar::float32: return is_ascii_ ? write_value(value) : write_value(static_cast<float>(value));
            case Scalar::float64: return write_value(value);
        }
    }

    void end() {
        if (is_ascii_) out_.character('\n');
    }

private:
    template <class T>
    void write_whole(double value) {
        write_value(
            static_cast<T>(round_to_range(value, static_cast<double>(std::numeric_limits<T>::min()), static_cast<double>(std::numeric_limits<T>::max()))));
    }

    template <class T>
    void write_value(T value) {
        if (!is_ascii_) return out_.raw(value, swap_);
        if (has_values_) out_.character(' ');
        has_values_ = true;
        if constexpr (sizeof(T) == 1) out_.number(static_cast<int>(value));
        else out_.number(value);
    }

    OutputBuffer& out_;
    const bool is_ascii_, swap_;
    bool has_values_ = false;
};

class PlyWriter {
public:
    PlyWriter(const MeshFile& file, ByteSink& sink)
        : file_(file),
          sink_(sink),
          is_ascii_(file.ply_encoding == "ascii"),
          swap_(file.ply_encoding == "binary_big_endian"),
          position_scalar_(file.ply_position_type == "float" ? Scalar::float32 : Scalar::float64),
          uv_scalar_(Scalar::float32) {
        for (const VertexProperty& property : file.properties) {
            const ScalarName* row = find_scalar(property.type);
            property_scalars_.push_back(row ? row->scalar : Scalar::float64);
        }
        for (const double value : file.uvs.values)
            if (static_cast<double>(static_cast<float>(value)) != value) uv_scalar_ = Scalar::float64;  // most programs know only float
        for (Index f = 0; f < file.mesh.face_count(); ++f) largest_degree_ = std::max(largest_degree_, file.mesh.degree(f));
    }

    void write() {
        write_header();
        write_rows(sink_, static_cast<std::size_t>(file_.mesh.vertex_count),
                   [&](OutputBuffer& out, std::size_t v) { write_vertex(PlyRow(out, is_ascii_, swap_), v); });
        write_rows(sink_, static_cast<std::size_t>(file_.mesh.face_count()),
                   [&](OutputBuffer& out, std::size_t f) { write_face(PlyRow(out, is_ascii_, swap_), static_cast<Index>(f)); });
    }

private:
    void write_header() {
        OutputBuffer out;
        const std::string encoding = file_.ply_encoding.empty() ? "binary_little_endian" : file_.ply_encoding;
        out.text("ply\nformat " + encoding + " 1.0\nelement vertex " + std::to_string(file_.mesh.vertex_count) + "\n");
        for (const char* name : {"x", "y", "z"}) write_property(out, position_scalar_, name);
        if (!file_.normals.empty())
            for (const char* name : {"nx", "ny", "nz"}) write_property(out, position_scalar_, name);
        for (std::size_t p = 0; p < property_scalars_.size(); ++p) write_property(out, property_scalars_[p], file_.properties[p].name);
        out.text("element face " + std::to_string(file_.mesh.face_count()) + "\nproperty list ");
        out.text(std::string(largest_degree_ > 255 ? "int" : "uchar") + " int vertex_indices\n");
        if (has_uvs_) out.text(std::string("property list ") + (largest_degree_ > 127 ? "int " : "uchar ") + name_of(uv_scalar_) + " texcoord\n");
        out.text("end_header\n");
        out.pass_on(sink_);
    }

    static const char* name_of(Scalar scalar) {
        for (const ScalarName& row : scalar_names)
            if (row.scalar == scalar) return row.name;
        return "double";
    }

    static void write_property(OutputBuffer& out, Scalar scalar, const std::string& name) {
        out.text(std::string("property ") + name_of(scalar) + " " + name + "\n");
    }

    void write_vertex(PlyRow row, std::size_t vertex) const {
        for (int i = 0; i < 3; ++i) row.write(file_.mesh.positions[3 * vertex + static_cast<std::size_t>(i)], position_scalar_);
        if (!file_.normals.empty())
            for (int i = 0; i < 3; ++i) row.write(file_.normals[3 * vertex + static_cast<std::size_t>(i)], position_scalar_);
        for (std::size_t p = 0; p < property_scalars_.size(); ++p) row.write(file_.properties[p].values[vertex], property_scalars_[p]);
        row.end();
    }

    void write_face(PlyRow row, Index face) const {
        const PolygonMesh& mesh = file_.mesh;
        row.write(mesh.degree(face), largest_degree_ > 255 ? Scalar::int32 : Scalar::uint8);
        for (Index c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c) row.write(mesh.face_vertices[c], Scalar::int32);
        if (has_uvs_) write_texture_coordinates(row, face);
        row.end();
    }

    /// A face of which a corner has none gets an empty list.
    void write_texture_coordinates(PlyRow& row, Index face) const {
        const auto first = file_.uvs.corner_indices.begin() + file_.mesh.face_offsets[face];
        const auto last = file_.uvs.corner_indices.begin() + file_.mesh.face_offsets[face + 1];
        const bool is_complete = std::all_of(first, last, [](Index index) { return index >= 0; });
        row.write(is_complete ? 2.0 * static_cast<double>(last - first) : 0.0, largest_degree_ > 127 ? Scalar::int32 : Scalar::uint8);
        for (auto index = first; is_complete && index != last; ++index)
            for (int i = 0; i < 2; ++i)
                row.write(file_.uvs.values[static_cast<std::size_t>(*index) * static_cast<std::size_t>(file_.uvs.components) + static_cast<std::size_t>(i)],
                          uv_scalar_);
    }

    const MeshFile& file_;
    ByteSink& sink_;
    const bool is_ascii_, swap_;
    const Scalar position_scalar_;
    Scalar uv_scalar_;
    std::vector<Scalar> property_scalars_;
    const bool has_uvs_ = has_texture_coordinates(file_);
    Index largest_degree_ = 0;
};

}  // namespace

void write_ply(const MeshFile& file, ByteSink& sink) { PlyWriter(file, sink).write(); }

}  // namespace lcl
