// SPDX-License-Identifier: BSD-3-Clause
// PLY, ASCII and both binary encodings: Greg Turk, "The PLY Polygon File Format", 1994. A file names its elements and their properties; what is in
// them is read by that description alone.
//
// Kept: x y z, every other scalar of a vertex (with its type) save nx ny nz, which only come where asked for, the faces' list vertex_indices or vertex_index,
// and their list texcoord (two numbers a corner, as MeshLab writes it). Everything else is skipped, with a warning. An ASCII row ends with its line. ASCII
// numbers are read and written as doubles, also where the header says float: text can hold them, and nothing is lost.
#include <algorithm>

#include "host/io/join_faces.h"
#include "host/io/ply_source.h"
#include "host/parallel.h"

namespace lcl {
namespace {

class PlyReader {
public:
    explicit PlyReader(const InputBytes& input) : input_(input), scan_(input, 0) {}

    MeshFile read() {
        read_header();
        if (file_.ply_encoding == "ascii") {
            AsciiSource source(scan_);
            read_body(source);
        } else {
            BinarySource source(input_, scan_.at(), file_.ply_encoding == "binary_big_endian");
            read_body(source);
        }
        return std::move(file_);
    }

private:
    // The header.

    void read_header() {
        const std::string_view magic = scan_.word();
        if (magic != "ply" && magic != "PLY") scan_.fail(input_.data, "a PLY file begins with the line 'ply', this one does not");
        scan_.skip_line();
        for (;;) {
            scan_.skip_blanks();
            if (scan_.at_end()) scan_.fail(scan_.at(), "the file ends before the line 'end_header'");
            const char* first = scan_.at();
            const std::string_view keyword = scan_.word();
            if (keyword == "end_header") break;
            if (keyword == "format") read_format();
            else if (keyword == "element") read_element(first);
            else if (keyword == "property") read_property(first);
            else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty())
                scan_.fail(first, "'" + printable(keyword) + "' is no line of a PLY header");
            scan_.skip_line();
        }
        end_header();
        if (file_.ply_encoding.empty()) scan_.fail(input_.data, "the header has no line 'format'");
    }

    /// One line break ends the header; the bytes behind it are data, whatever they look like.
    void end_header() {
        scan_.skip_blanks();
        const bool is_pair = scan_.remaining() > 1 && *scan_.at() == '\r' && scan_.at()[1] == '\n' && !lines_end_in_cr();
        if (!scan_.at_end() && is_line_break(*scan_.at())) scan_.move_to(scan_.at() + (is_pair ? 2 : 1));
    }

    bool lines_end_in_cr() const {
        const char* first_break = std::find_if(input_.data, input_.data + input_.size, is_line_break);
        return *first_break == '\r' && first_break[1] != '\n';
    }

    std::string next_word(const char* what) {
        scan_.skip_blanks();
        if (scan_.at_line_end()) scan_.fail(scan_.at(), std::string("the line ends where ") + what + " was expected");
        return std::string(scan_.word());
    }

    void read_format() {
        const std::string encoding = next_word("the encoding");
        if (encoding != "ascii" && encoding != "binary_little_endian" && encoding != "binary_big_endian")
            scan_.fail(scan_.at(), "'" + printable(encoding) + "' is no encoding of PLY (ascii, binary_little_endian, binary_big_endian)");
        file_.ply_encoding = encoding;
    }

    void read_element(const char* place) {
        PlyElement element;
        element.name = next_word("an element's name");
        scan_.skip_blanks();
        const char* first = scan_.at();
        const std::string_view digits = scan_.word();
        scan_.move_to(first);
        const bool is_too_long = digits.size() > 18 && std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
        const std::int64_t count = is_too_long ? std::numeric_limits<std::int64_t>::max() : scan_.integer("the number of elements");
        if (count < 0) scan_.fail(first, "the number of elements is " + std::to_string(count) + "; it cannot be negative");
        element.count = static_cast<std::size_t>(count);
        element.place = place;
        elements_.push_back(std::move(element));
    }

    Scalar read_scalar_type(std::string& name) {
        name = next_word("a type");
        const ScalarName* row = find_scalar(name);
        if (!row) scan_.fail(scan_.at(), "'" + printable(name) + "' is no scalar type of PLY");
        return row->scalar;
    }

    void read_property(const char* place) {
        if (elements_.empty()) scan_.fail(place, "a property stands before the first element");
        PlyProperty property;
        scan_.skip_blanks();
        const char* first = scan_.at();
        property.is_list = scan_.word() == "list";
        if (!property.is_list) scan_.move_to(first);
        if (property.is_list) property.count_scalar = read_scalar_type(property.type_name);
        property.scalar = read_scalar_type(property.type_name);
        property.name = next_word("a property's name");
        if (property.is_list && is_floating(property.count_scalar)) scan_.fail(place, "the length of a list must be of a whole type");
        elements_.back().properties.push_back(std::move(property));
    }

    // The body.

    template <class Source>
    void read_body(Source& source) {
        bool has_vertices = false, has_faces = false;
        for (const PlyElement& element : elements_) {
            check_count(source, element);
            if (element.name == "vertex" && !has_vertices) {
                read_vertices(source, element);
                has_vertices = true;
            } else if (element.name == "face" && !has_faces) {
                read_faces(source, element);
                has_faces = true;
            } else {
                skip_element(source, element);
            }
        }
        if (!has_vertices) scan_.fail(input_.data, "the header has no element 'vertex'");
    }

    template <class Source>
    void check_count(const Source& source, const PlyElement& element) {
        std::size_t row_size = 0;
        for (const PlyProperty& property : element.properties) row_size += source.least_size(property.is_list ? property.count_scalar : property.scalar);
        const bool is_numbered = element.name == "vertex" || element.name == "face";
        if ((row_size > 0 && element.count > source.remaining() / row_size) ||
            (is_numbered && element.count > static_cast<std::size_t>(std::numeric_limits<Index>::max())))
            scan_.fail(element.place, "element '" + printable(element.name) + "' is given " + std::to_string(element.count) + " rows, more than the file of " +
                                          std::to_string(input_.size) + " bytes can hold; correct the header");
    }

    /// Where the values of a vertex's property go: none if skipped.
    struct Column {
        double* first = nullptr;
        std::size_t stride = 0;
    };

    /// Calls read_range(range, index) for the rows of an element, ranges of them at once. The first exception is that of the first range, so that the first row
    /// that is wrong is named.
    template <class Source, class ReadRange>
    void read_rows(Source& source, std::vector<RowRange<Source>>& ranges, const ReadRange& read_range) {
        parallel_for(
            ranges.size(),
            [&](std::size_t first, std::size_t last) {
                for (std::size_t i = first; i < last; ++i) read_range(ranges[i], i);
            },
            1);
        source.move_behind(ranges.back().source);
    }

    template <class Source>
    void read_vertices(Source& source, const PlyElement& element) {
        const std::vector<Column> columns = make_columns(element);
        std::vector<RowRange<Source>> ranges = source.cut(element, input_.splitting);
        read_rows(source, ranges, [&](RowRange<Source>& range, std::size_t) {
            for (std::size_t v = range.first; v < range.last; ++v) read_vertex(range.source, element, columns, v);
        });
    }

    template <class Source>
    void read_vertex(Source& source, const PlyElement& element, const std::vector<Column>& columns, std::size_t v) {
        source.begin_row();
        for (std::size_t p = 0; p < columns.size(); ++p) {
            const PlyProperty& property = element.properties[p];
            if (property.is_list) skip_list(source, property);
            else if (columns[p].first) columns[p].first[v * columns[p].stride] = source.scalar(property.scalar);
            else source.scalar(property.scalar);
        }
        source.end_row();
    }

    std::vector<Column> make_columns(const PlyElement& element) {
        const int axes[3] = {find_axis(element, "x"), find_axis(element, "y"), find_axis(element, "z")};
        file_.ply_position_type = element.properties[static_cast<std::size_t>(axes[0])].scalar == Scalar::float32 ? "float" : "double";
        file_.mesh.vertex_count = static_cast<Index>(element.count);
        file_.mesh.positions.resize(3 * element.count);
        file_.properties.reserve(element.properties.size());
        std::vector<Column> columns(element.properties.size());
        const bool has_normals =
            input_.with_normals && find_property(element, "nx") >= 0 && find_property(element, "ny") >= 0 && find_property(element, "nz") >= 0;
        if (has_normals) file_.given_normals.resize(3 * element.count);
        double* const positions = element.count > 0 ? file_.mesh.positions.data() : nullptr;
        for (std::size_t p = 0; p < columns.size(); ++p) {
            const PlyProperty& property = element.properties[p];
            const auto axis = std::find(axes, axes + 3, static_cast<int>(p));
            if (property.is_list) {
                warn_of_skipped("vertices", property);
            } else if (axis != axes + 3) {
                columns[p] = {positions ? positions + (axis - axes) : nullptr, 3};
            } else if (const int component = normal_component(property.name); component >= 0) {
                if (has_normals && element.count > 0) columns[p] = {file_.given_normals.data() + component, 3};
            } else {
                file_.properties.push_back(make_property(property, element.count));
                columns[p] = {file_.properties.back().values.data(), 1};
            }
        }
        return columns;
    }

    static int normal_component(const std::string& name) { return name == "nx" ? 0 : name == "ny" ? 1 : name == "nz" ? 2 : -1; }

    /// Place of a scalar property, -1 where there is none.
    static int find_property(const PlyElement& element, const char* name) {
        for (std::size_t p = 0; p < element.properties.size(); ++p)
            if (!element.properties[p].is_list && element.properties[p].name == name) return static_cast<int>(p);
        return -1;
    }

    int find_axis(const PlyElement& element, const char* name) const {
        const int place = find_property(element, name);
        if (place >= 0) return place;
        scan_.fail(element.place, std::string("the vertices have no property '") + name + "'");
    }

    static VertexProperty make_property(const PlyProperty& property, std::size_t count) {
        const bool is_colour = property.name == "red" || property.name == "green" || property.name == "blue" || property.name == "alpha";
        return {property.name, is_colour ? VertexProperty::Kind::colour : VertexProperty::Kind::scalar, property.type_name, std::vector<double>(count)};
    }

    /// Faces of a range of rows: offsets and indices of texture coordinates count from its first.
    struct FaceRows {
        PolygonMesh mesh;
        TextureCoordinates uvs;
        std::size_t faces_without_uvs = 0;
    };

    template <class Source>
    void read_faces(Source& source, const PlyElement& element) {
        const FaceColumns columns{find_corners(element), find_texture_coordinates(element)};
        for (const PlyProperty& property : element.properties)
            if (&property != columns.corners && &property != columns.texcoord) warn_of_skipped("faces", property);
        std::vector<RowRange<Source>> ranges = source.cut(element, input_.splitting);
        std::vector<FaceRows> parts(ranges.size());
        read_rows(source, ranges, [&](RowRange<Source>& range, std::size_t i) {
            const std::size_t faces = i == 0 ? element.count : range.last - range.first;  // the others are appended to the first
            parts[i].mesh.face_offsets.reserve(faces + 1);
            parts[i].mesh.face_vertices.reserve(std::min(4 * faces, range.source.remaining()));
            for (std::size_t f = range.first; f < range.last; ++f) read_face(range.source, element, columns, f, parts[i]);
        });
        join(source, parts);
        finish_texture_coordinates();
    }

    struct FaceColumns {
        const PlyProperty* corners;
        const PlyProperty* texcoord;
    };

    template <class Source>
    void read_face(Source& source, const PlyElement& element, const FaceColumns& columns, std::size_t face, FaceRows& rows) {
        std::vector<double> values;
        source.begin_row();
        for (const PlyProperty& property : element.properties) {
            if (&property == columns.corners) read_corners(source, property, face, rows.mesh);
            else if (&property == columns.texcoord) read_list(source, property, values);
            else if (property.is_list) skip_list(source, property);
            else source.scalar(property.scalar);
        }
        source.end_row();
        if (columns.texcoord) add_texture_coordinates(values, rows);
    }

    template <class Source>
    void join(const Source& source, std::vector<FaceRows>& parts) {
        FaceRows& whole = parts[0];
        for (std::size_t i = 1; i < parts.size(); ++i) {
            FaceRows& part = parts[i];
            if (!fit_together(whole.mesh, part.mesh)) fail_corner_count(source);
            const auto uvs = static_cast<Index>(whole.uvs.values.size() / 2);
            for (Index& index : part.uvs.corner_indices) index += index >= 0 ? uvs : 0;
            append_faces(whole.mesh, part.mesh);
            append(whole.uvs.values, part.uvs.values);
            append(whole.uvs.corner_indices, part.uvs.corner_indices);
            whole.faces_without_uvs += part.faces_without_uvs;
        }
        file_.mesh.face_offsets = std::move(whole.mesh.face_offsets);
        file_.mesh.face_vertices = std::move(whole.mesh.face_vertices);
        file_.uvs = std::move(whole.uvs);
        faces_without_uvs_ = whole.faces_without_uvs;
    }

    template <class Source>
    [[noreturn]] static void fail_corner_count(const Source& source) {
        source.fail("the file has more than 2147483647 face corners, the most that can be numbered");
    }

    const PlyProperty* find_corners(const PlyElement& element) const {
        for (const PlyProperty& property : element.properties)
            if (property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index")) return &property;
        scan_.fail(element.place, "the faces have no list 'vertex_indices' or 'vertex_index'");
    }

    static const PlyProperty* find_texture_coordinates(const PlyElement& element) {
        for (const PlyProperty& property : element.properties)
            if (property.is_list && property.name == "texcoord") return &property;
        return nullptr;
    }

    template <class Source>
    std::size_t list_length(Source& source, const PlyProperty& property) {
        const std::int64_t length = source.integer(property.count_scalar);
        if (length < 0) source.fail("a list '" + printable(property.name) + "' has the length " + std::to_string(length));
        if (static_cast<std::uint64_t>(length) > source.remaining() / source.least_size(property.scalar))
            source.fail("a list '" + printable(property.name) + "' is given " + std::to_string(length) + " entries, more than the file can hold");
        return static_cast<std::size_t>(length);
    }

    template <class Source>
    void read_corners(Source& source, const PlyProperty& property, std::size_t face, PolygonMesh& mesh) {
        std::vector<Index>& corners = mesh.face_vertices;
        const std::size_t length = list_length(source, property);
        const bool is_taken = source.take_indices(property.scalar, length, corners);
        for (std::size_t i = 0; i < length && !is_taken; ++i) {
            const std::int64_t vertex = source.integer(property.scalar);
            if (vertex < std::numeric_limits<Index>::min() || vertex > std::numeric_limits<Index>::max())
                source.fail("face " + std::to_string(face) + " uses vertex " + std::to_string(vertex) + "; the most is 2147483647");
            corners.push_back(static_cast<Index>(vertex));
        }
        if (corners.size() > static_cast<std::size_t>(std::numeric_limits<Index>::max())) fail_corner_count(source);
        mesh.face_offsets.push_back(static_cast<Index>(corners.size()));
    }

    template <class Source>
    void read_list(Source& source, const PlyProperty& property, std::vector<double>& values) {
        values.resize(list_length(source, property));
        for (double& value : values) value = source.scalar(property.scalar);
    }

    template <class Source>
    void skip_list(Source& source, const PlyProperty& property) {
        const std::size_t length = list_length(source, property);
        for (std::size_t i = 0; i < length; ++i) source.scalar(property.scalar);
    }

    template <class Source>
    void skip_element(Source& source, const PlyElement& element) {
        file_.warnings.push_back("the element '" + printable(element.name) + "' was skipped");
        if (element.properties.empty()) return;
        std::vector<RowRange<Source>> ranges = source.cut(element, input_.splitting);
        read_rows(source, ranges, [&](RowRange<Source>& range, std::size_t) {
            for (std::size_t row = range.first; row < range.last; ++row) skip_row(range.source, element);
        });
    }

    template <class Source>
    void skip_row(Source& source, const PlyElement& element) {
        source.begin_row();
        for (const PlyProperty& property : element.properties) {
            if (property.is_list) skip_list(source, property);
            else source.scalar(property.scalar);
        }
        source.end_row();
    }

    void warn_of_skipped(const char* owner, const PlyProperty& property) {
        file_.warnings.push_back("the property '" + printable(property.name) + "' of the " + owner + " was dropped");
    }

    /// The texture coordinates of the face that was read last; a list of another length than two a corner counts as none.
    static void add_texture_coordinates(const std::vector<double>& values, FaceRows& rows) {
        const std::size_t degree = static_cast<std::size_t>(rows.mesh.degree(rows.mesh.face_count() - 1));
        const bool fits = values.size() == 2 * degree;
        rows.faces_without_uvs += !fits;
        for (std::size_t i = 0; i < degree; ++i) rows.uvs.corner_indices.push_back(fits ? static_cast<Index>(rows.uvs.values.size() / 2 + i) : -1);
        if (fits) rows.uvs.values.insert(rows.uvs.values.end(), values.begin(), values.end());
    }

    void finish_texture_coordinates() {
        if (file_.uvs.values.empty()) file_.uvs = {};
        else if (faces_without_uvs_ > 0) file_.warnings.push_back(std::to_string(faces_without_uvs_) + " faces have no two texture coordinates a corner");
    }

    const InputBytes& input_;
    TextScanner scan_;
    MeshFile file_;
    std::vector<PlyElement> elements_;
    std::size_t faces_without_uvs_ = 0;
};

}  // namespace

MeshFile read_ply(const InputBytes& input) { return PlyReader(input).read(); }

}  // namespace lcl
