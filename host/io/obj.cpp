// SPDX-License-Identifier: BSD-3-Clause
// Wavefront OBJ with OpenSubdiv's tags: https://paulbourke.net/dataformats/obj/ and OpenSubdiv's regression/common/shape_utils.
//
// Kept: v (x y z, with r g b [a] behind them as many programs write), vt, f, the lines o g s usemtl mtllib in their place, and the tags crease, corner and
// interpolateboundary. Dropped: vn, and w of a vertex. Everything else is counted. Colours are numbers from 0 to 1 in this format; integer columns of
// other formats are divided by their full intensity when written.
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "host/io/format.h"
#include "host/io/number_write.h"
#include "host/io/text_scan.h"

namespace lcl {
namespace {

constexpr const char* colour_names[] = {"red", "green", "blue", "alpha"};
constexpr double infinite_sharpness = 10;  // OpenSubdiv's Crease::SHARPNESS_INFINITE

class ObjReader {
public:
    explicit ObjReader(const InputBytes& input) : scan_(input, '#', true) {
        // A line of text takes about 30 bytes a vertex and as much a face; a wrong guess costs a copy.
        file_.mesh.positions.reserve(input.size / 20);
        file_.mesh.face_vertices.reserve(input.size / 20);
        file_.mesh.face_offsets.reserve(input.size / 80);
    }

    MeshFile read() {
        while (!scan_.at_end()) {
            scan_.skip_blanks();
            if (!scan_.at_line_end()) read_statement();
            scan_.skip_line();
        }
        if (file_.mesh.positions.empty()) scan_.fail(scan_.end(), "no vertex line (v x y z) was found; is this an OBJ file?");
        finish();
        return std::move(file_);
    }

private:
    void read_statement() {
        statement_ = scan_.at();
        const std::string_view keyword = scan_.word();
        if (keyword == "v") read_vertex();
        else if (keyword == "f") read_face();
        else if (keyword == "vt") read_texture_coordinate();
        else if (keyword == "vn") return;
        else if (keyword == "t") read_tag();
        else if (keyword == "o" || keyword == "g" || keyword == "s" || keyword == "usemtl" || keyword == "mtllib") keep_line();
        else count_unknown(printable(keyword));
    }

    /// Reads the numbers of a line, as many as `values` takes, and gives how many there are.
    int numbers(double* values, int capacity, const char* what) {
        int count = 0;
        for (scan_.skip_blanks(); !scan_.at_line_end(); scan_.skip_blanks(), ++count) {
            if (count < capacity) values[count] = scan_.number(what);
            else scan_.word();
        }
        return count;
    }

    void read_vertex() {
        double values[7];
        const int count = numbers(values, 7, "a coordinate");
        if (count < 3) scan_.fail(statement_, "a vertex needs three coordinates, this line has " + std::to_string(count));
        check_count(file_.mesh.positions.size() / 3, "vertices");
        file_.mesh.positions.insert(file_.mesh.positions.end(), values, values + 3);
        if (count == 4) dropped_weights_ += values[3] != 1;
        if (count == 5 || count > 7) ++odd_vertices_;
        if (count == 6 || count == 7) add_colour(values + 3, count - 3);
    }

    void add_colour(const double* values, int count) {
        const std::size_t vertex = file_.mesh.positions.size() / 3 - 1;
        for (int i = 0; i < count; ++i) {
            colours_[i].resize(vertex, 1.0);
            colours_[i].push_back(values[i]);
        }
        ++coloured_vertices_;
    }

    void read_texture_coordinate() {
        double values[3] = {0, 0, 0};
        const int count = numbers(values, 3, "a texture coordinate");
        if (count < 1) scan_.fail(statement_, "a texture coordinate needs one to three numbers, this line has none");
        check_count(texture_coordinate_count(), "texture coordinates");
        if (count > 2 && file_.uvs.components == 2) widen_texture_coordinates();
        file_.uvs.values.insert(file_.uvs.values.end(), values, values + file_.uvs.components);
    }

    std::size_t texture_coordinate_count() const { return file_.uvs.values.size() / static_cast<std::size_t>(file_.uvs.components); }

    void widen_texture_coordinates() {
        std::vector<double> wide;
        wide.reserve(file_.uvs.values.size() / 2 * 3);
        for (std::size_t i = 0; i < file_.uvs.values.size(); i += 2) wide.insert(wide.end(), {file_.uvs.values[i], file_.uvs.values[i + 1], 0.0});
        file_.uvs.values = std::move(wide);
        file_.uvs.components = 3;
    }

    void read_face() {
        std::vector<Index>& corners = file_.mesh.face_vertices;
        for (scan_.skip_blanks(); !scan_.at_line_end(); scan_.skip_blanks()) read_corner();
        check_count(corners.size(), "face corners");
        file_.mesh.face_offsets.push_back(static_cast<Index>(corners.size()));
    }

    /// a, a/b, a//c or a/b/c; b and c may be missing behind their slash.
    void read_corner() {
        file_.mesh.face_vertices.push_back(read_index(file_.mesh.positions.size() / 3, "vertex"));
        Index texture_coordinate = -1;
        if (take_slash() && !at_corner_part_end()) texture_coordinate = read_index(texture_coordinate_count(), "texture coordinate");
        Index normal;
        if (take_slash() && !at_corner_part_end() && !scan_.try_integer(normal)) fail_corner();
        if (!scan_.at_end() && !scan_.is_delimiter(*scan_.at())) fail_corner();
        if (texture_coordinate < 0 && file_.uvs.corner_indices.empty()) return;
        file_.uvs.corner_indices.resize(file_.mesh.face_vertices.size() - 1, -1);
        file_.uvs.corner_indices.push_back(texture_coordinate);
    }

    bool take_slash() {
        if (scan_.at_end() || *scan_.at() != '/') return false;
        scan_.move_to(scan_.at() + 1);
        return true;
    }

    bool at_corner_part_end() const { return scan_.at_end() || *scan_.at() == '/' || scan_.is_delimiter(*scan_.at()); }

    /// An index from 1, or from the last one back, as an index from 0. One beyond the count is left to the checks of the mesh.
    Index read_index(std::size_t count_so_far, const char* what) {
        const char* first = scan_.at();
        std::int64_t value;
        if (!scan_.try_integer(value)) fail_corner();
        if (value == 0) scan_.fail(first, std::string("a face has ") + what + " index 0; OBJ counts from 1");
        if (value > std::numeric_limits<Index>::max())
            scan_.fail(first, std::string(what) + " index " + std::to_string(value) + " is too large; the most is 2147483647");
        if (value > 0) return static_cast<Index>(value - 1);
        const std::int64_t counted_back = static_cast<std::int64_t>(count_so_far) + value;
        if (counted_back < 0)
            scan_.fail(first,
                       std::string(what) + " index " + std::to_string(value) + " counts back further than the " + std::to_string(count_so_far) + " before it");
        return static_cast<Index>(counted_back);
    }

    [[noreturn]] void fail_corner() {
        const char* first = scan_.at();
        while (first > statement_ && !scan_.is_delimiter(first[-1])) --first;
        scan_.fail_number(first, "a face corner (v, v/vt, v//vn or v/vt/vn)");
    }

    void keep_line() {
        std::string text;
        scan_.move_to(statement_);
        while (!scan_.at_end() && !is_line_break(*scan_.at())) {
            const char c = *scan_.at();
            const bool is_joint = c == '\\' && scan_.skip_joint();
            text += is_joint ? ' ' : c;
            if (!is_joint) scan_.move_to(scan_.at() + 1);
        }
        while (!text.empty() && is_blank(text.back())) text.pop_back();
        file_.lines.push_back({file_.mesh.face_count(), std::move(text)});
    }

    void count_unknown(const std::string& keyword) {
        const auto [place, is_new] = unknown_.emplace(keyword, file_.unknown_statements.size());
        if (is_new) file_.unknown_statements.emplace_back(keyword, 0);
        ++file_.unknown_statements[place->second].second;
    }

    /// t name integers/floats/strings ..., vertices from 0.
    void read_tag() {
        scan_.skip_blanks();
        const std::string name = printable(scan_.word());
        if (name == "crease") read_crease();
        else if (name == "corner") read_corner_tag();
        else if (name == "interpolateboundary") read_boundary_rule();
        else if (name.empty()) count_unknown("t");
        else if (std::find(file_.tags.ignored.begin(), file_.tags.ignored.end(), name) == file_.tags.ignored.end()) file_.tags.ignored.push_back(name);
    }

    struct TagArguments {
        std::vector<Index> integers;
        std::vector<double> floats;
    };

    TagArguments read_tag_arguments() {
        std::int64_t counts[3];
        for (int i = 0; i < 3; ++i) {
            if (i > 0 && !take_slash()) scan_.fail(statement_, "the counts of a tag are written as integers/floats/strings, as in 2/1/0");
            if (i == 0) scan_.skip_blanks();
            if (!scan_.try_integer(counts[i]) || counts[i] < 0)
                scan_.fail(statement_, "the counts of a tag are written as integers/floats/strings, as in 2/1/0");
        }
        TagArguments arguments;
        for (std::int64_t i = 0; i < counts[0]; ++i) scan_.skip_blanks(), arguments.integers.push_back(scan_.index("an integer of a tag"));
        for (std::int64_t i = 0; i < counts[1]; ++i) scan_.skip_blanks(), arguments.floats.push_back(scan_.number("a number of a tag"));
        return arguments;
    }

    /// The i-th sharpness: one for all, or one each.
    bool is_sharp(const TagArguments& arguments, std::size_t i) {
        const double sharpness = arguments.floats.size() > 1 ? arguments.floats[i] : arguments.floats[0];
        if (sharpness >= infinite_sharpness) return true;
        if (sharpness != 0 && file_.tags.refused.empty()) {
            char text[40];
            file_.tags.refused = scan_.place(statement_) + "sharpness " + std::string(text, std::to_chars(text, text + 40, sharpness).ptr) +
                                 " makes a semi-sharp crease or corner, which is not supported; use 10 or more (infinitely sharp) or 0 (none)";
        }
        return false;
    }

    void check_sharpness_count(const TagArguments& arguments, std::size_t count, const char* what) {
        if (arguments.floats.size() == 1 || (arguments.floats.size() == count && count > 0)) return;
        scan_.fail(statement_, std::string("a ") + what + " tag needs one sharpness, or one for each of its " + std::to_string(count) + "; this one has " +
                                   std::to_string(arguments.floats.size()));
    }

    void read_crease() {
        const TagArguments arguments = read_tag_arguments();
        if (arguments.integers.size() < 2) scan_.fail(statement_, "a crease tag needs two vertices or more");
        const std::size_t edge_count = arguments.integers.size() - 1;
        check_sharpness_count(arguments, edge_count, "crease");
        for (std::size_t i = 0; i < edge_count; ++i)
            if (is_sharp(arguments, i)) file_.tags.creases.push_back({arguments.integers[i], arguments.integers[i + 1]});
    }

    void read_corner_tag() {
        const TagArguments arguments = read_tag_arguments();
        check_sharpness_count(arguments, arguments.integers.size(), "corner");
        for (std::size_t i = 0; i < arguments.integers.size(); ++i)
            if (is_sharp(arguments, i)) file_.tags.corners.push_back(arguments.integers[i]);
    }

    void read_boundary_rule() {
        const TagArguments arguments = read_tag_arguments();
        if (arguments.integers.size() != 1 || arguments.integers[0] < 0 || arguments.integers[0] > 2)
            scan_.fail(statement_, "the interpolateboundary tag needs one number: 0, 1 (edges and corners) or 2 (edges only)");
        file_.tags.interpolate_boundary = arguments.integers[0];
    }

    void check_count(std::size_t count, const char* what) {
        if (count >= static_cast<std::size_t>(std::numeric_limits<Index>::max()))
            scan_.fail(statement_, std::string("the file has more than 2147483647 ") + what + ", the most that can be numbered");
    }

    void finish() {
        file_.mesh.vertex_count = static_cast<Index>(file_.mesh.positions.size() / 3);
        finish_colours();
        finish_texture_coordinates();
        if (dropped_weights_ > 0) file_.warnings.push_back("the weights w of " + std::to_string(dropped_weights_) + " vertices are not 1; they were dropped");
        if (odd_vertices_ > 0)
            file_.warnings.push_back(std::to_string(odd_vertices_) +
                                     " vertex lines have 5 or more than 7 numbers; those behind x, y, z and a colour were dropped");
        std::string names;
        for (const std::string& name : file_.tags.ignored) names += (names.empty() ? "" : ", ") + name;
        if (!names.empty()) file_.warnings.push_back("tags that have no effect here were skipped: " + names);
    }

    void finish_colours() {
        const std::size_t vertex_count = static_cast<std::size_t>(file_.mesh.vertex_count);
        if (coloured_vertices_ == 0) return;
        if (coloured_vertices_ < vertex_count)
            file_.warnings.push_back(std::to_string(vertex_count - coloured_vertices_) +
                                     " vertices have no colour while others have one; they were made white");
        for (int i = 0; i < 4; ++i) {
            if (colours_[i].empty()) continue;
            colours_[i].resize(vertex_count, 1.0);
            file_.properties.push_back({colour_names[i], VertexProperty::Kind::colour, "double", std::move(colours_[i])});
        }
    }

    /// Corners may name texture coordinates that come later in the file, so that the range is known only now.
    void finish_texture_coordinates() {
        std::vector<Index>& indices = file_.uvs.corner_indices;
        if (!indices.empty()) indices.resize(file_.mesh.face_vertices.size(), -1);
        const std::size_t count = texture_coordinate_count();
        std::size_t beyond = 0;
        for (Index& index : indices) {
            if (index < 0 || static_cast<std::size_t>(index) < count) continue;
            index = -1;
            ++beyond;
        }
        if (beyond > 0)
            file_.warnings.push_back(std::to_string(beyond) + " face corners name a texture coordinate beyond the " + std::to_string(count) +
                                     " of the file; they were left without one");
    }

    TextScanner scan_;
    MeshFile file_;
    const char* statement_ = nullptr;  // where the present statement begins
    std::vector<double> colours_[4];
    std::size_t coloured_vertices_ = 0, dropped_weights_ = 0, odd_vertices_ = 0;
    std::unordered_map<std::string, std::size_t> unknown_;
};

class ObjWriter {
public:
    ObjWriter(const MeshFile& file, ByteSink& sink) : file_(file), out_(sink) {}

    void write() {
        write_vertices();
        write_rows("vt", file_.uvs.values, has_texture_coordinates(file_) ? file_.uvs.components : 0);
        write_rows("vn", file_.normals, 3);
        write_faces();
        write_tags();
        out_.flush();
    }

private:
    void write_vertices() {
        const ColourColumns colours = find_colours(file_);
        const VertexProperty* columns[] = {colours.red, colours.green, colours.blue, colours.alpha};
        for (Index v = 0; v < file_.mesh.vertex_count; ++v) {
            out_.character('v');
            write_numbers(&file_.mesh.positions[3 * static_cast<std::size_t>(v)], 3);
            for (const VertexProperty* column : columns) {
                if (!column) continue;
                out_.character(' ');
                out_.number(column->values[static_cast<std::size_t>(v)] / full_intensity(*column));
            }
            out_.character('\n');
        }
    }

    void write_numbers(const double* values, int count) {
        for (int i = 0; i < count; ++i) {
            out_.character(' ');
            out_.number(values[i]);
        }
    }

    void write_rows(const char* keyword, const std::vector<double>& values, int width) {
        for (std::size_t i = 0; width > 0 && i < values.size(); i += static_cast<std::size_t>(width)) {
            out_.text(keyword);
            write_numbers(&values[i], width);
            out_.character('\n');
        }
    }

    void write_faces() {
        const PolygonMesh& mesh = file_.mesh;
        auto line = file_.lines.begin();
        for (Index f = 0; f < mesh.face_count(); ++f) {
            for (; line != file_.lines.end() && line->before_face <= f; ++line) write_line(line->text);
            out_.character('f');
            for (Index c = mesh.face_offsets[f]; c < mesh.face_offsets[f + 1]; ++c) write_corner(c);
            out_.character('\n');
        }
        for (; line != file_.lines.end(); ++line) write_line(line->text);
    }

    void write_line(const std::string& text) {
        out_.text(text);
        out_.character('\n');
    }

    void write_corner(Index corner) {
        const Index vertex = file_.mesh.face_vertices[corner] + 1;
        const Index texture_coordinate = has_texture_coordinates_ ? file_.uvs.corner_indices[corner] + 1 : 0;
        out_.character(' ');
        out_.number(vertex);
        if (texture_coordinate > 0 || !file_.normals.empty()) out_.character('/');
        if (texture_coordinate > 0) out_.number(texture_coordinate);
        if (file_.normals.empty()) return;
        out_.character('/');
        out_.number(vertex);
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
        write_line(tail);
    }

    const MeshFile& file_;
    OutputBuffer out_;
    const bool has_texture_coordinates_ = has_texture_coordinates(file_);
};

}  // namespace

MeshFile read_obj(const InputBytes& input) { return ObjReader(input).read(); }

void write_obj(const MeshFile& file, ByteSink& sink) { ObjWriter(file, sink).write(); }

}  // namespace lcl
