// SPDX-License-Identifier: BSD-3-Clause
// Wavefront OBJ with OpenSubdiv's tags: https://paulbourke.net/dataformats/obj/ and OpenSubdiv's regression/common/shape_utils.
//
// Kept: v (x y z, with r g b [a] behind them as many programs write), vt, f, the lines o g s usemtl mtllib in their place, and the tags crease, corner and
// interpolateboundary. vn only where asked for. Dropped: w of a vertex. Everything else is counted. Colours are numbers from 0 to 1 in this format; integer
// columns of other formats are divided by their full intensity when written.
//
// A text is read in parts of whole lines, at once. What is wrong in a part is not said before the whole has been looked at from its beginning, so that the
// sentence, its line number included, is the one for the first line that is wrong.
#include <algorithm>
#include <optional>

#include "host/io/format.h"
#include "host/io/obj_part.h"
#include "host/io/text_scan.h"
#include "host/parallel.h"

namespace lcl {
namespace {

constexpr double infinite_sharpness = 10;  // OpenSubdiv's Crease::SHARPNESS_INFINITE

/// Reads lines into a part.
class ObjReader {
public:
    /// is_first: the part begins with the text, so that all that was counted before is known.
    /// with_normals: of one that reads the whole text.
    ObjReader(const std::string& name, std::size_t size, bool is_first, bool with_normals = false)
        : scan_({nullptr, 0, name}, '#', true), is_first_(is_first), with_normals_(with_normals) {
        // Lines of nothing but short indices or long coordinates; room that is not used costs nothing.
        file_.mesh.positions.reserve(size / 16);
        file_.mesh.face_vertices.reserve(size / 6);
        file_.mesh.face_offsets.reserve(size / 16);
    }

    void read(std::string_view lines, bool begins_text) {
        scan_.move_to_piece(lines, begins_text);
        while (!scan_.at_end()) {
            scan_.skip_blanks();
            if (!scan_.at_line_end()) read_statement();
            scan_.skip_line();
        }
    }

    ObjPart take() { return std::move(part_); }

    /// For each vertex of the mesh the mean of the normals at its corners, NaN where there is none; empty where no corner has one. Points without faces have
    /// one each, as scanning programs write them, where the numbers agree.
    std::vector<double> take_vertex_normals(const PolygonMesh& mesh) const {
        if (mesh.face_count() == 0 && normals_.size() == mesh.positions.size()) return normals_;
        if (corner_normals_.empty()) return {};
        std::vector<double> normals(3 * static_cast<std::size_t>(mesh.vertex_count), 0.0), counts(mesh.vertex_count, 0.0);
        for (std::size_t corner = 0; corner < corner_normals_.size(); ++corner) {
            const std::int64_t normal = corner_normals_[corner], vertex = mesh.face_vertices[corner];
            const bool is_there = normal >= 0 && normal < static_cast<std::int64_t>(normals_.size() / 3) && vertex >= 0 && vertex < mesh.vertex_count;
            if (!is_there) continue;
            for (std::int64_t c = 0; c < 3; ++c) normals[3 * vertex + c] += normals_[3 * normal + c];
            ++counts[vertex];
        }
        for (std::size_t i = 0; i < normals.size(); ++i) normals[i] /= counts[i / 3];  // 0 / 0: none
        return normals;
    }

    [[noreturn]] void fail_without_vertices() { scan_.fail(scan_.end(), "no vertex line (v x y z) was found; is this an OBJ file?"); }

private:
    void read_statement() {
        statement_ = scan_.at();
        const std::string_view keyword = scan_.word();
        if (keyword == "v") read_vertex();
        else if (keyword == "f") read_face();
        else if (keyword == "vt") read_texture_coordinate();
        else if (keyword == "vn") read_normal();
        else if (keyword == "t") read_tag();
        else if (keyword == "o" || keyword == "g" || keyword == "s" || keyword == "usemtl" || keyword == "mtllib") keep_line();
        else part_.count_unknown(printable(keyword), 1);
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
        if (count == 4) part_.dropped_weights += values[3] != 1;
        if (count == 5 || count > 7) ++part_.odd_vertices;
        if (count == 6 || count == 7) add_colour(values + 3, count - 3);
    }

    void add_colour(const double* values, int count) {
        const std::size_t vertex = file_.mesh.positions.size() / 3 - 1;
        for (int i = 0; i < count; ++i) {
            part_.colours[i].resize(vertex, 1.0);
            part_.colours[i].push_back(values[i]);
        }
        ++part_.coloured_vertices;
    }

    void read_texture_coordinate() {
        double values[3] = {0, 0, 0};
        const int count = numbers(values, 3, "a texture coordinate");
        if (count < 1) scan_.fail(statement_, "a texture coordinate needs one to three numbers, this line has none");
        check_count(texture_coordinate_count(file_.uvs), "texture coordinates");
        if (count > 2) widen(file_.uvs);
        file_.uvs.values.insert(file_.uvs.values.end(), values, values + file_.uvs.components);
    }

    void read_normal() {
        if (!with_normals_) return;
        double values[3];
        const int count = numbers(values, 3, "a component of a normal");
        if (count != 3) scan_.fail(statement_, "a normal needs three components, this line has " + std::to_string(count));
        normals_.insert(normals_.end(), values, values + 3);
    }

    void keep_normal(std::size_t corner, Index normal) {
        corner_normals_.resize(corner, -1);
        corner_normals_.push_back(normal > 0 ? std::int64_t{normal} - 1 : static_cast<std::int64_t>(normals_.size() / 3) + normal);
    }

    void read_face() {
        std::vector<Index>& corners = file_.mesh.face_vertices;
        read_plain_corners();
        for (scan_.skip_blanks(); !scan_.at_line_end(); scan_.skip_blanks()) read_corner();
        check_count(corners.size(), "face corners");
        file_.mesh.face_offsets.push_back(static_cast<Index>(corners.size()));
    }

    /// The corners of a line that are plain short numbers, as most are, up to the first that is something else.
    void read_plain_corners() {
        if (!file_.uvs.corner_indices.empty()) return;
        for (;;) {
            scan_.skip_blanks();
            const char* const first = scan_.at();
            Index value;
            if (!scan_.take_short_number(value)) return;
            if (value == 0) return scan_.move_to(first);  // what is wrong with it is said elsewhere
            file_.mesh.face_vertices.push_back(value - 1);
        }
    }

    /// a, a/b, a//c or a/b/c; b and c may be missing behind their slash.
    void read_corner() {
        const std::size_t corner = file_.mesh.face_vertices.size();
        file_.mesh.face_vertices.push_back(read_index(file_.mesh.positions.size() / 3, corner, part_.relative_corners, "vertex"));
        std::optional<Index> texture_coordinate;
        if (take_slash() && !at_corner_part_end())
            texture_coordinate = read_index(texture_coordinate_count(file_.uvs), corner, part_.relative_texture_corners, "texture coordinate");
        Index normal;
        if (take_slash() && !at_corner_part_end()) {
            if (!scan_.try_integer(normal)) fail_corner();
            if (with_normals_) keep_normal(corner, normal);
        }
        if (!scan_.at_end() && !scan_.is_delimiter(*scan_.at())) fail_corner();
        if (!texture_coordinate && file_.uvs.corner_indices.empty()) return;
        file_.uvs.corner_indices.resize(corner, -1);
        file_.uvs.corner_indices.push_back(texture_coordinate.value_or(-1));
    }

    bool take_slash() {
        if (scan_.at_end() || *scan_.at() != '/') return false;
        scan_.move_to(scan_.at() + 1);
        return true;
    }

    bool at_corner_part_end() const { return scan_.at_end() || *scan_.at() == '/' || scan_.is_delimiter(*scan_.at()); }

    /// An index from 1, or from the last one back, as an index from 0. One beyond the count is left to the checks of the mesh. What is counted back in a part
    /// that is not the first counts from the part's own first, until the parts are joined: `corner` goes to `relative`.
    Index read_index(std::size_t count_so_far, std::size_t corner, std::vector<std::size_t>& relative, const char* what) {
        const char* first = scan_.at();
        std::int64_t value;
        if (!scan_.try_integer(value)) fail_corner();
        if (value == 0) scan_.fail(first, std::string("a face has ") + what + " index 0; OBJ counts from 1");
        if (value > std::numeric_limits<Index>::max())
            scan_.fail(first, std::string(what) + " index " + std::to_string(value) + " is too large; the most is 2147483647");
        if (value > 0) return static_cast<Index>(value - 1);
        const std::int64_t counted_back = static_cast<std::int64_t>(count_so_far) + value;
        if (counted_back < (is_first_ ? 0 : std::numeric_limits<Index>::min()))
            scan_.fail(first,
                       std::string(what) + " index " + std::to_string(value) + " counts back further than the " + std::to_string(count_so_far) + " before it");
        if (!is_first_) relative.push_back(corner);
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

    /// t name integers/floats/strings ..., vertices from 0.
    void read_tag() {
        scan_.skip_blanks();
        const std::string name = printable(scan_.word());
        if (name == "crease") read_crease();
        else if (name == "corner") read_corner_tag();
        else if (name == "interpolateboundary") read_boundary_rule();
        else if (name.empty()) part_.count_unknown("t", 1);
        else part_.ignore_tag(name);
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

    TextScanner scan_;
    const bool is_first_, with_normals_;
    std::vector<double> normals_;
    std::vector<std::int64_t> corner_normals_;  // of the corners up to the last that has one; -1: none
    ObjPart part_;
    MeshFile& file_ = part_.file;
    const char* statement_ = nullptr;  // where the present statement begins
};

ObjPart read_part(const Text& text, std::size_t begin, std::size_t end, std::size_t piece) {
    ObjReader reader(text.name, begin == 0 ? text.size : end - begin, begin == 0);  // the others are appended to the first
    LinePieces pieces(text, begin, end, piece);
    bool begins_text = begin == 0;
    for (std::string_view lines = pieces.next(); !lines.empty(); lines = pieces.next(), begins_text = false) reader.read(lines, begins_text);
    return reader.take();
}

ObjPart read_parts(const Text& text, const Splitting& splitting) {
    const std::size_t count = splitting.parts_of(text.size);
    std::vector<ObjPart> parts(count);
    const auto begin_of = [&](std::size_t part) { return next_line(text, text.size / count * part + text.size % count * part / count); };
    parallel_for(
        count,
        [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) parts[i] = read_part(text, begin_of(i), i + 1 < count ? begin_of(i + 1) : text.size, splitting.piece);
        },
        1);
    return join(std::move(parts));
}

}  // namespace

std::optional<MeshFile> try_read_obj(const Text& text, const Splitting& splitting) {
    try {
        ObjPart whole = read_parts(text, splitting);
        const bool names_no_line = whole.file.tags.refused.empty();
        if (!whole.file.mesh.positions.empty() && names_no_line) return finish(std::move(whole));
    } catch (const BadInput&) {  // which line is the first to be wrong is found out by reading from the beginning
    }
    return std::nullopt;
}

MeshFile read_obj(const InputBytes& input) {
    const Text text{input.data, input.size, input.name};
    if (input.splitting.parts_of(input.size) > 1 && !input.with_normals)
        if (std::optional<MeshFile> file = try_read_obj(text, input.splitting)) return *std::move(file);
    ObjReader reader(input.name, input.size, true, input.with_normals);
    reader.read({input.data, input.size}, true);
    ObjPart whole = reader.take();
    if (whole.file.mesh.positions.empty()) reader.fail_without_vertices();
    MeshFile file = finish(std::move(whole));
    file.given_normals = reader.take_vertex_normals(file.mesh);
    return file;
}

}  // namespace lcl
