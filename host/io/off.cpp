// SPDX-License-Identifier: BSD-3-Clause
// OFF as Geomview describes it: http://www.geomview.org/docs/html/OFF.html
//
//   [ST][C][N]OFF                    the word may be missing; STOFF, COFF, NOFF and their mixtures say what follows x, y, z
//   vertices faces edges
//   x y z [nx ny nz] [r g b a] [s t]
//   n v0 v1 .. [colour]              a face
//
// Numbers may be spread over lines, save that what follows a face's corners, and a vertex's colour (three or four numbers), ends with its line.
// Dropped: normals (unless asked for), face colours. Refused: binary OFF, and points of other than three coordinates (4OFF, nOFF).
#include <algorithm>
#include <cmath>

#include "host/io/format.h"
#include "host/io/join_faces.h"
#include "host/io/number_write.h"
#include "host/io/text_scan.h"

namespace lcl {
namespace {

constexpr const char* colour_names[] = {"red", "green", "blue", "alpha"};
constexpr double no_alpha = -1;  // of a vertex whose colour has three numbers

class OffReader {
public:
    explicit OffReader(const InputBytes& input) : scan_(input, '#'), size_(input.size), splitting_(input.splitting), with_normals_(input.with_normals) {}

    MeshFile read() {
        read_header();
        read_counts();
        prepare();
        if (!read_at_once()) {
            Rows rows{0, vertex_count_ + face_count_};
            read_rows(scan_, rows);
            take(rows);
        }
        finish();
        return std::move(file_);
    }

private:
    void read_header() {
        scan_.skip_space();
        if (scan_.at_end()) scan_.fail(scan_.at(), "the file has no content but comments; it holds no mesh");
        if (*scan_.at() >= '0' && *scan_.at() <= '9' && !is_four_off()) return;  // the word OFF may be missing
        const char* first = scan_.at();
        has_texture_coordinates_ = take("ST");
        has_colours_ = take("C");
        has_normals_ = take("N");
        if (take("4") || take("n")) scan_.fail(first, "OFF with other than three coordinates a point (4OFF, nOFF) is not read; convert it to plain OFF");
        if (!take("OFF")) scan_.fail(first, "'" + printable(scan_.word()) + "' was found where the word OFF was expected; is this an OFF file?");
        scan_.skip_blanks();
        if (take("BINARY")) scan_.fail(first, "binary OFF is not read; convert it to text OFF, or to PLY");
    }

    bool is_four_off() const { return scan_.remaining() > 4 && std::string_view(scan_.at(), 4) == "4OFF"; }

    bool take(std::string_view text) {
        if (scan_.remaining() < text.size() || std::string_view(scan_.at(), text.size()) != text) return false;
        scan_.move_to(scan_.at() + text.size());
        return true;
    }

    void read_counts() {
        vertex_count_ = read_count("the number of vertices", 6);  // "0 0 0\n"
        face_count_ = read_count("the number of faces", 2);       // "0\n"
        scan_.skip_blanks();
        if (!scan_.at_line_end()) scan_.integer("the number of edges");
    }

    /// A count that the rest of the file can hold, at `smallest` bytes each.
    std::size_t read_count(const char* what, std::size_t smallest) {
        scan_.skip_space();
        const char* first = scan_.at();
        const std::string_view digits = scan_.word();
        scan_.move_to(first);
        const bool is_too_long = digits.size() > 18 && std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
        const std::int64_t count = is_too_long ? std::numeric_limits<std::int64_t>::max() : scan_.integer(what);
        if (count < 0) scan_.fail(first, std::string(what) + " is " + std::to_string(count) + "; it cannot be negative");
        // The last line may lack its end.
        if (static_cast<std::uint64_t>(count) > (scan_.remaining() + 1) / smallest || count > std::numeric_limits<Index>::max())
            scan_.fail(first, std::string(what) + " is given as " + printable(digits) + ", more than the file of " + std::to_string(size_) +
                                  " bytes can hold; correct the header");
        return static_cast<std::size_t>(count);
    }

    void prepare() {
        file_.mesh.vertex_count = static_cast<Index>(vertex_count_);
        file_.mesh.positions.resize(3 * vertex_count_);
        if (has_normals_ && with_normals_) file_.given_normals.resize(3 * vertex_count_);
        if (has_texture_coordinates_) file_.uvs.values.resize(2 * vertex_count_);
    }

    /// Rows of the body, vertices and then faces, and what is found in them.
    struct Rows {
        std::size_t first, last;
        PolygonMesh mesh = {};
        std::size_t vertices_with_extras = 0, faces_with_extras = 0;
    };

    void read_rows(TextScanner& scan, Rows& rows) {
        const std::size_t first_face = std::max(rows.first, vertex_count_);
        const std::size_t faces = rows.first == 0 ? face_count_ : rows.last - std::min(rows.last, first_face);  // the others are appended to the first
        rows.mesh.face_offsets.reserve(faces + 1);
        rows.mesh.face_vertices.reserve(4 * faces);
        for (std::size_t row = rows.first; row < std::min(rows.last, vertex_count_); ++row) read_vertex(scan, row, rows);
        for (std::size_t row = first_face; row < rows.last; ++row) read_face(scan, row - vertex_count_, rows);
    }

    /// Reads ranges of rows at once where each row is a line, as is usual; false, and nothing done, where it is not, or where a line is wrong: which is the
    /// first is found out by reading from the beginning. Colours need all that come before them.
    bool read_at_once() {
        if (has_colours_) return false;
        const std::vector<LineCut> cuts = count_lines({scan_.at(), scan_.remaining()}, '#', splitting_);
        if (cuts.size() < 2 || cuts.back().number != vertex_count_ + face_count_) return false;
        std::vector<Rows> parts;
        for (const LineCut& cut : cuts) parts.push_back({parts.empty() ? 0 : parts.back().last, cut.number});
        try {
            parallel_for(
                parts.size(),
                [&](std::size_t first, std::size_t last) {
                    for (std::size_t i = first; i < last; ++i) read_lines(i == 0 ? scan_.at() : cuts[i - 1].place, cuts[i].place, parts[i]);
                },
                1);
        } catch (const BadInput&) {
            return false;
        }
        for (std::size_t i = 1; i < parts.size(); ++i)
            if (!fit_together(parts[0].mesh, parts[i].mesh)) return false;
            else add(parts[0], parts[i]);
        scan_.move_to(cuts.back().place);
        take(parts[0]);
        return true;
    }

    /// BadInput if the rows do not end where the lines end.
    void read_lines(const char* begin, const char* end, Rows& rows) {
        TextScanner scan = scan_, behind = scan_;
        scan.move_to(begin);
        read_rows(scan, rows);
        scan.skip_space();
        behind.move_to(end);
        behind.skip_space();
        if (scan.at() != behind.at()) throw BadInput("a row is no line");
    }

    static void add(Rows& whole, Rows& part) {
        append_faces(whole.mesh, part.mesh);
        whole.vertices_with_extras += part.vertices_with_extras;
        whole.faces_with_extras += part.faces_with_extras;
    }

    void take(Rows& rows) {
        file_.mesh.face_offsets = std::move(rows.mesh.face_offsets);
        file_.mesh.face_vertices = std::move(rows.mesh.face_vertices);
        vertices_with_extras_ = rows.vertices_with_extras;
        faces_with_extras_ = rows.faces_with_extras;
    }

    void read_vertex(TextScanner& scan, std::size_t v, Rows& rows) {
        read_numbers(scan, &file_.mesh.positions[3 * v], 3, "a coordinate");
        double dropped[3];
        if (has_normals_) read_numbers(scan, file_.given_normals.empty() ? dropped : &file_.given_normals[3 * v], 3, "a coordinate of a normal");
        if (has_colours_) read_colour(scan, v);
        if (has_texture_coordinates_) read_numbers(scan, &file_.uvs.values[2 * v], 2, "a texture coordinate");
        skip_extras(scan, rows.vertices_with_extras);
    }

    static void read_numbers(TextScanner& scan, double* values, int count, const char* what) {
        for (int i = 0; i < count; ++i) {
            scan.skip_space();
            values[i] = scan.number(what);
        }
    }

    /// Three or four numbers: alpha may be missing where nothing else follows.
    void read_colour(TextScanner& scan, std::size_t vertex) {
        double values[4];
        int count = 0;
        for (scan.skip_blanks(); count < 3 || (count < 4 && !scan.at_line_end()); scan.skip_blanks(), ++count) {
            const char* first = scan.at();
            values[count] = scan.number("a component of a colour");
            colours_are_whole_ = colours_are_whole_ && std::all_of(first, scan.at(), [](char c) { return c >= '0' && c <= '9'; });
            largest_colour_ = std::max(largest_colour_, values[count]);
        }
        for (int i = 0; i < count; ++i) {
            colours_[i].resize(vertex, no_alpha);
            colours_[i].push_back(values[i]);
        }
    }

    /// What the line holds beyond what was expected is skipped; counts the lines where there was something.
    static void skip_extras(TextScanner& scan, std::size_t& lines_with_extras) {
        scan.skip_blanks();
        lines_with_extras += !scan.at_line_end();
        scan.skip_line();
    }

    void read_face(TextScanner& scan, std::size_t face, Rows& rows) {
        std::vector<Index>& corners = rows.mesh.face_vertices;
        scan.skip_space();
        const char* first = scan.at();
        const std::int64_t degree = scan.integer("the number of a face's corners");
        if (degree < 0 || static_cast<std::uint64_t>(degree) > scan.remaining() / 2)
            scan.fail(first, "face " + std::to_string(face) + " is given " + std::to_string(degree) + " corners, which the file cannot hold");
        for (std::int64_t c = 0; c < degree; ++c) {
            scan.skip_space();
            corners.push_back(scan.index("a vertex of a face"));
        }
        if (corners.size() > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
            scan.fail(first, "the file has more than 2147483647 face corners, the most that can be numbered");
        rows.mesh.face_offsets.push_back(static_cast<Index>(corners.size()));
        skip_extras(scan, rows.faces_with_extras);
    }

    void finish() {
        scan_.skip_space();
        if (!scan_.at_end()) file_.warnings.push_back(scan_.place(scan_.at()) + "text behind the last face was ignored");
        finish_colours();
        if (has_texture_coordinates_) file_.uvs.corner_indices = file_.mesh.face_vertices;
        if (vertices_with_extras_ > 0)
            file_.warnings.push_back(std::to_string(vertices_with_extras_) + " vertex lines have more numbers than the word " +
                                     (has_colours_ || has_normals_ || has_texture_coordinates_ ? "before OFF" : "OFF") + " announces; those were dropped");
        if (faces_with_extras_ > 0) file_.warnings.push_back("the colours of " + std::to_string(faces_with_extras_) + " faces were dropped");
        for (const Index v : file_.uvs.corner_indices) {
            if (v >= 0 && v < file_.mesh.vertex_count) continue;
            file_.uvs = {};  // a false index is reported by the checks of the mesh
            break;
        }
    }

    /// Whole numbers of which one is above 1 are bytes; others run from 0 to 1.
    void finish_colours() {
        const bool are_bytes = colours_are_whole_ && largest_colour_ > 1 && largest_colour_ <= 255;
        for (int i = 0; i < 4; ++i) {
            if (colours_[i].empty()) continue;
            colours_[i].resize(vertex_count_, no_alpha);
            if (i == 3) std::replace(colours_[3].begin(), colours_[3].end(), no_alpha, are_bytes ? 255.0 : 1.0);  // opaque
            file_.properties.push_back({colour_names[i], VertexProperty::Kind::colour, are_bytes ? "uchar" : "double", std::move(colours_[i])});
        }
    }

    TextScanner scan_;
    std::size_t size_;
    Splitting splitting_;
    const bool with_normals_;
    MeshFile file_;
    bool has_texture_coordinates_ = false, has_colours_ = false, has_normals_ = false;
    std::size_t vertex_count_ = 0, face_count_ = 0, vertices_with_extras_ = 0, faces_with_extras_ = 0;
    std::vector<double> colours_[4];
    bool colours_are_whole_ = true;
    double largest_colour_ = 0;
};

class OffWriter {
public:
    OffWriter(const MeshFile& file, ByteSink& sink) : file_(file), sink_(sink), colours_(find_colours(file)) {}

    void write() {
        write_header();
        write_rows(sink_, static_cast<std::size_t>(file_.mesh.vertex_count), [&](OutputBuffer& out, std::size_t v) { write_vertex(out, v); });
        write_rows(sink_, static_cast<std::size_t>(file_.mesh.face_count()), [&](OutputBuffer& out, std::size_t f) { write_face(out, static_cast<Index>(f)); });
    }

private:
    void write_header() {
        OutputBuffer out;
        if (has_texture_coordinates_) out.text("ST");
        if (colours_) out.text("C");
        if (!file_.normals.empty()) out.text("N");
        out.text("OFF\n");
        out.number(file_.mesh.vertex_count);
        out.character(' ');
        out.number(file_.mesh.face_count());
        out.text(" 0\n");
        out.pass_on(sink_);
    }

    void write_vertex(OutputBuffer& out, std::size_t vertex) const {
        write_numbers(out, &file_.mesh.positions[3 * vertex], 3);
        if (!file_.normals.empty()) write_numbers(out, &file_.normals[3 * vertex], 3, ' ');
        if (colours_) write_colour(out, vertex);
        if (has_texture_coordinates_) write_numbers(out, &file_.uvs.values[2 * vertex], 2, ' ');
        out.character('\n');
    }

    static void write_numbers(OutputBuffer& out, const double* values, int count, char before = 0) {
        for (int i = 0; i < count; ++i) {
            if (i > 0 || before != 0) out.character(' ');
            out.number(values[i]);
        }
    }

    /// Bytes as they are, other columns from 0 to 1 with a point. Where texture coordinates follow, alpha cannot be left out.
    void write_colour(OutputBuffer& out, std::size_t vertex) const {
        for (const VertexProperty* column : {colours_.red, colours_.green, colours_.blue, colours_.alpha}) {
            if (!column && !has_texture_coordinates_) continue;
            const double unit = full_intensity(column ? *column : *colours_.red);
            const double value = column ? column->values[vertex] : unit;
            out.character(' ');
            if (unit == 255) write_byte(out, value);
            else write_fraction(out, value / unit);
        }
    }

    static void write_byte(OutputBuffer& out, double value) { out.number(static_cast<int>(round_to_range(value, 0, 255))); }

    static void write_fraction(OutputBuffer& out, double value) {
        out.number(value);
        if (value == std::floor(value) && std::fabs(value) < 1e5) out.text(".0");  // without its point a reader might take a 1 for a byte
    }

    void write_face(OutputBuffer& out, Index f) const {
        out.number(file_.mesh.degree(f));
        for (Index c = file_.mesh.face_offsets[f]; c < file_.mesh.face_offsets[f + 1]; ++c) {
            out.character(' ');
            out.number(file_.mesh.face_vertices[c]);
        }
        out.character('\n');
    }

    const MeshFile& file_;
    ByteSink& sink_;
    ColourColumns colours_;
    const bool has_texture_coordinates_ = has_vertex_texture_coordinates(file_) && file_.uvs.components == 2;
};

}  // namespace

MeshFile read_off(const InputBytes& input) { return OffReader(input).read(); }

void write_off(const MeshFile& file, ByteSink& sink) { OffWriter(file, sink).write(); }

}  // namespace lcl
