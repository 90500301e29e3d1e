// SPDX-License-Identifier: BSD-3-Clause
// The writer of Wavefront OBJ; what it writes is what obj.cpp reads.
#include <algorithm>

#include "host/io/format.h"
#include "host/io/number_write.h"

namespace lcl {
namespace {

class ObjWriter {
public:
    ObjWriter(const MeshFile& file, ByteSink& sink) : file_(file), sink_(sink) {}

    void write() {
        write_vertices();
        write_values("vt", file_.uvs.values, has_texture_coordinates_ ? static_cast<std::size_t>(file_.uvs.components) : 0);
        write_values("vn", file_.normals, 3);
        write_faces();
        write_tags();
        out_.pass_on(sink_);
    }

private:
    void write_vertices() {
        const ColourColumns colours = find_colours(file_);
        const VertexProperty* columns[] = {colours.red, colours.green, colours.blue, colours.alpha};
        write_rows(sink_, static_cast<std::size_t>(file_.mesh.vertex_count), [&](OutputBuffer& out, std::size_t v) {
            out.character('v');
            write_numbers(out, &file_.mesh.positions[3 * v], 3);
            for (const VertexProperty* column : columns) {
                if (!column) continue;
                out.character(' ');
                out.number(column->values[v] / full_intensity(*column));
            }
            out.character('\n');
        });
    }

    static void write_numbers(OutputBuffer& out, const double* values, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            out.character(' ');
            out.number(values[i]);
        }
    }

    void write_values(const char* keyword, const std::vector<double>& values, std::size_t width) {
        if (width == 0) return;
        write_rows(sink_, values.size() / width, [&](OutputBuffer& out, std::size_t row) {
            out.text(keyword);
            write_numbers(out, &values[row * width], width);
            out.character('\n');
        });
    }

    /// Lines stand before their face, those behind the last face at the end.
    void write_faces() {
        const Index face_count = file_.mesh.face_count();
        const std::vector<Index> places = places_of_lines();
        const auto write_lines = [&](OutputBuffer& out, auto first, auto last) {
            for (; first != last; ++first) write_line(out, file_.lines[static_cast<std::size_t>(first - places.begin())].text);
        };
        write_rows(sink_, static_cast<std::size_t>(face_count), [&](OutputBuffer& out, std::size_t row) {
            const auto f = static_cast<Index>(row);
            const auto [first, last] = std::equal_range(places.begin(), places.end(), f);
            write_lines(out, first, last);
            out.character('f');
            for (Index c = file_.mesh.face_offsets[f]; c < file_.mesh.face_offsets[f + 1]; ++c) write_corner(out, c);
            out.character('\n');
        });
        write_lines(out_, std::lower_bound(places.begin(), places.end(), face_count), places.end());
    }

    /// The face that each line stands before, ascending: the order of the lines is kept.
    std::vector<Index> places_of_lines() const {
        std::vector<Index> places;
        for (const PassThroughLine& line : file_.lines) places.push_back(std::max(places.empty() ? 0 : places.back(), line.before_face));
        return places;
    }

    static void write_line(OutputBuffer& out, const std::string& text) {
        out.text(text);
        out.character('\n');
    }

    void write_corner(OutputBuffer& out, Index corner) const {
        const Index vertex = file_.mesh.face_vertices[corner] + 1;
        const Index texture_coordinate = has_texture_coordinates_ ? file_.uvs.corner_indices[corner] + 1 : 0;
        out.character(' ');
        out.number(vertex);
        if (texture_coordinate > 0 || !file_.normals.empty()) out.character('/');
        if (texture_coordinate > 0) out.number(texture_coordinate);
        if (file_.normals.empty()) return;
        out.character('/');
        out.number(vertex);
    }

    void write_tags() {
        const MeshTags& tags = file_.tags;
        if (tags.interpolate_boundary >= 0) write_tag("t interpolateboundary 1/0/0", {tags.interpolate_boundary}, "");
        for (const std::array<Index, 2>& edge : tags.creases) write_tag("t crease 2/1/0", {edge[0], edge[1]}, " 10");
        for (const Index corner : tags.corners) write_tag("t corner 1/1/0", {corner}, " 10");
    }

    void write_tag(const char* head, std::initializer_list<Index> integers, const char* tail) {
        out_.text(head);
        for (const Index integer : integers) {
            out_.character(' ');
            out_.number(integer);
        }
        write_line(out_, tail);
    }

    const MeshFile& file_;
    ByteSink& sink_;
    OutputBuffer out_;  // what stands at the end
    const bool has_texture_coordinates_ = has_texture_coordinates(file_);
};

}  // namespace

void write_obj(const MeshFile& file, ByteSink& sink) { ObjWriter(file, sink).write(); }

}  // namespace lcl
