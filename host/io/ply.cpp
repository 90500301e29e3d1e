// SPDX-License-Identifier: BSD-3-Clause
// PLY, ASCII and both binary encodings: Greg Turk, "The PLY Polygon File Format", 1994. A file names its elements and their properties; what is in
// them is read by that description alone.
//
// Kept: x y z, every other scalar of a vertex save nx ny nz (with its type), the faces' list vertex_indices or vertex_index, and their list texcoord
// (two numbers a corner, as MeshLab writes it). Everything else is skipped, with a warning. An ASCII row ends with its line. ASCII numbers are read and
// written as doubles, also where the header says float: text can hold them, and nothing is lost.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "host/io/format.h"
#include "host/io/number_write.h"
#include "host/io/ply_types.h"
#include "host/io/text_scan.h"

namespace lcl {
namespace {

struct Property {
    std::string name;
    Scalar scalar = Scalar::float64;
    bool is_list = false;
    Scalar count_scalar = Scalar::uint8;
    std::string type_name;
};

struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;
    const char* place = nullptr;  // its line in the header
};

/// Values of an ASCII body, row by row.
class AsciiSource {
public:
    explicit AsciiSource(TextScanner& scan) : scan_(scan) {}

    void begin_row() { scan_.skip_space(); }

    double scalar(Scalar) {
        scan_.skip_blanks();
        return scan_.number("a value");
    }

    std::int64_t integer(Scalar scalar) {
        scan_.skip_blanks();
        return is_floating(scalar) ? whole(scan_.number("an index")) : scan_.integer("an index or the length of a list");
    }

    void end_row() {
        scan_.skip_blanks();
        if (!scan_.at_line_end()) fail("the row has more values than the header announces; correct the header or the row");
        scan_.skip_line();
    }

    std::size_t least_size(Scalar) const { return 2; }               // "0 "
    std::size_t remaining() const { return scan_.remaining() + 1; }  // the last line may lack its end
    [[noreturn]] void fail(const std::string& sentence) const { scan_.fail(scan_.at(), sentence); }

private:
    std::int64_t whole(double value) const {
        if (!(std::fabs(value) < 9e15) || value != std::floor(value)) fail("an index is no whole number");
        return static_cast<std::int64_t>(value);
    }

    TextScanner& scan_;
};

/// Values of a binary body.
class BinarySource {
public:
    BinarySource(const InputBytes& input, const char* at, bool swap) : input_(input), at_(at), swap_(swap) {}

    void begin_row() const {}
    void end_row() const {}

    double scalar(Scalar scalar) {
        switch (scalar) {
            case Scalar::int8: return take<std::int8_t>();
            case Scalar::uint8: return take<std::uint8_t>();
            case Scalar::int16: return take<std::int16_t>();
            case Scalar::uint16: return take<std::uint16_t>();
            case Scalar::int32: return take<std::int32_t>();
            case Scalar::uint32: return take<std::uint32_t>();
            case Scalar::float32: return static_cast<double>(take<float>());
            case Scalar::float64: break;
        }
        return take<double>();
    }

    std::int64_t integer(Scalar scalar_type) {
        const double value = scalar(scalar_type);
        if (!(std::fabs(value) < 9e15) || value != std::floor(value)) fail("an index is no whole number");
        return static_cast<std::int64_t>(value);
    }

    std::size_t least_size(Scalar scalar) const { return size_of(scalar); }
    std::size_t remaining() const { return static_cast<std::size_t>(input_.data + input_.size - at_); }
    [[noreturn]] void fail(const std::string& sentence) const {
        throw BadInput(input_.name + ": " + sentence + " (byte " + std::to_string(at_ - input_.data) + ")");
    }

private:
    template <class T>
    T take() {
        T value;
        if (remaining() < sizeof(T)) fail("the file ends within its binary data");
        std::memcpy(&value, at_, sizeof(T));
        at_ += sizeof(T);
        return swap_ ? swap_bytes(value) : value;
    }

    const InputBytes& input_;
    const char* at_;
    bool swap_;
};

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
        Element element;
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
        Property property;
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
        for (const Element& element : elements_) {
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
    void check_count(const Source& source, const Element& element) {
        std::size_t row_size = 0;
        for (const Property& property : element.properties) row_size += source.least_size(property.is_list ? property.count_scalar : property.scalar);
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

    template <class Source>
    void read_vertices(Source& source, const Element& element) {
        const std::vector<Column> columns = make_columns(element);
        for (std::size_t v = 0; v < element.count; ++v) {
            source.begin_row();
            for (std::size_t p = 0; p < columns.size(); ++p) {
                const Property& property = element.properties[p];
                if (property.is_list) skip_list(source, property);
                else if (columns[p].first) columns[p].first[v * columns[p].stride] = source.scalar(property.scalar);
                else source.scalar(property.scalar);
            }
            source.end_row();
        }
    }

    std::vector<Column> make_columns(const Element& element) {
        const int axes[3] = {find_axis(element, "x"), find_axis(element, "y"), find_axis(element, "z")};
        file_.ply_position_type = element.properties[static_cast<std::size_t>(axes[0])].scalar == Scalar::float32 ? "float" : "double";
        file_.mesh.vertex_count = static_cast<Index>(element.count);
        file_.mesh.positions.resize(3 * element.count);
        file_.properties.reserve(element.properties.size());
        std::vector<Column> columns(element.properties.size());
        double* const positions = element.count > 0 ? file_.mesh.positions.data() : nullptr;
        for (std::size_t p = 0; p < columns.size(); ++p) {
            const Property& property = element.properties[p];
            const auto axis = std::find(axes, axes + 3, static_cast<int>(p));
            if (property.is_list) {
                warn_of_skipped("vertices", property);
            } else if (axis != axes + 3) {
                columns[p] = {positions ? positions + (axis - axes) : nullptr, 3};
            } else if (property.name != "nx" && property.name != "ny" && property.name != "nz") {
                file_.properties.push_back(make_property(property, element.count));
                columns[p] = {file_.properties.back().values.data(), 1};
            }
        }
        return columns;
    }

    int find_axis(const Element& element, const char* name) const {
        for (std::size_t p = 0; p < element.properties.size(); ++p)
            if (!element.properties[p].is_list && element.properties[p].name == name) return static_cast<int>(p);
        scan_.fail(element.place, std::string("the vertices have no property '") + name + "'");
    }

    static VertexProperty make_property(const Property& property, std::size_t count) {
        const bool is_colour = property.name == "red" || property.name == "green" || property.name == "blue" || property.name == "alpha";
        return {property.name, is_colour ? VertexProperty::Kind::colour : VertexProperty::Kind::scalar, property.type_name, std::vector<double>(count)};
    }

    template <class Source>
    void read_faces(Source& source, const Element& element) {
        const Property* corners = find_corners(element);
        const Property* texcoord = find_texture_coordinates(element);
        for (const Property& property : element.properties)
            if (&property != corners && &property != texcoord) warn_of_skipped("faces", property);
        PolygonMesh& mesh = file_.mesh;
        mesh.face_offsets.reserve(element.count + 1);
        mesh.face_vertices.reserve(std::min(4 * element.count, source.remaining()));
        std::vector<double> values;
        for (std::size_t f = 0; f < element.count; ++f) {
            source.begin_row();
            for (const Property& property : element.properties) {
                if (&property == corners) read_corners(source, property, f);
                else if (&property == texcoord) read_list(source, property, values);
                else if (property.is_list) skip_list(source, property);
                else source.scalar(property.scalar);
            }
            source.end_row();
            if (texcoord) add_texture_coordinates(values);
        }
        finish_texture_coordinates();
    }

    const Property* find_corners(const Element& element) const {
        for (const Property& property : element.properties)
            if (property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index")) return &property;
        scan_.fail(element.place, "the faces have no list 'vertex_indices' or 'vertex_index'");
    }

    static const Property* find_texture_coordinates(const Element& element) {
        for (const Property& property : element.properties)
            if (property.is_list && property.name == "texcoord") return &property;
        return nullptr;
    }

    template <class Source>
    std::size_t list_length(Source& source, const Property& property) {
        const std::int64_t length = source.integer(property.count_scalar);
        if (length < 0) source.fail("a list '" + printable(property.name) + "' has the length " + std::to_string(length));
        if (static_cast<std::uint64_t>(length) > source.remaining() / source.least_size(property.scalar))
            source.fail("a list '" + printable(property.name) + "' is given " + std::to_string(length) + " entries, more than the file can hold");
        return static_cast<std::size_t>(length);
    }

    template <class Source>
    void read_corners(Source& source, const Property& property, std::size_t face) {
        std::vector<Index>& corners = file_.mesh.face_vertices;
        const std::size_t length = list_length(source, property);
        for (std::size_t i = 0; i < length; ++i) {
            const std::int64_t vertex = source.integer(property.scalar);
            if (vertex < std::numeric_limits<Index>::min() || vertex > std::numeric_limits<Index>::max())
                source.fail("face " + std::to_string(face) + " uses vertex " + std::to_string(vertex) + "; the most is 2147483647");
            corners.push_back(static_cast<Index>(vertex));
        }
        if (corners.size() > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
            source.fail("the file has more than 2147483647 face corners, the most that can be numbered");
        file_.mesh.face_offsets.push_back(static_cast<Index>(corners.size()));
    }

    template <class Source>
    void read_list(Source& source, const Property& property, std::vector<double>& values) {
        values.resize(list_length(source, property));
        for (double& value : values) value = source.scalar(property.scalar);
    }

    template <class Source>
    void skip_list(Source& source, const Property& property) {
        const std::size_t length = list_length(source, property);
        for (std::size_t i = 0; i < length; ++i) source.scalar(property.scalar);
    }

    template <class Source>
    void skip_element(Source& source, const Element& element) {
        file_.warnings.push_back("the element '" + printable(element.name) + "' was skipped");
        if (element.properties.empty()) return;
        for (std::size_t row = 0; row < element.count; ++row) {
            source.begin_row();
            for (const Property& property : element.properties) {
                if (property.is_list) skip_list(source, property);
                else source.scalar(property.scalar);
            }
            source.end_row();
        }
    }

    void warn_of_skipped(const char* owner, const Property& property) {
        file_.warnings.push_back("the property '" + printable(property.name) + "' of the " + owner + " was dropped");
    }

    /// The texture coordinates of the face that was read last; a list of another length than two a corner counts as none.
    void add_texture_coordinates(const std::vector<double>& values) {
        const std::size_t degree = static_cast<std::size_t>(file_.mesh.degree(file_.mesh.face_count() - 1));
        const bool fits = values.size() == 2 * degree;
        faces_without_uvs_ += !fits;
        for (std::size_t i = 0; i < degree; ++i) file_.uvs.corner_indices.push_back(fits ? static_cast<Index>(file_.uvs.values.size() / 2 + i) : -1);
        if (fits) file_.uvs.values.insert(file_.uvs.values.end(), values.begin(), values.end());
    }

    void finish_texture_coordinates() {
        if (file_.uvs.values.empty()) file_.uvs = {};
        else if (faces_without_uvs_ > 0) file_.warnings.push_back(std::to_string(faces_without_uvs_) + " faces have no two texture coordinates a corner");
    }

    const InputBytes& input_;
    TextScanner scan_;
    MeshFile file_;
    std::vector<Element> elements_;
    std::size_t faces_without_uvs_ = 0;
};

}  // namespace

MeshFile read_ply(const InputBytes& input) { return PlyReader(input).read(); }

}  // namespace lcl
