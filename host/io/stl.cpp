// SPDX-License-Identifier: BSD-3-Clause
// STL, ASCII and binary: triangles with float coordinates and no shared vertices. Corners with equal coordinates become one vertex; vertices are
// numbered by first appearance.
//
// Both kinds may begin with the word 'solid', so the size decides: binary if it is what the triangle count at byte 80 demands, else ASCII if it looks so.
#include <cmath>
#include <cstring>

#include "host/io/format.h"
#include "host/io/number_write.h"
#include "host/io/text_scan.h"

namespace lcl {
namespace {

constexpr std::size_t head_size = 84;  // 80 bytes of anything, the number of triangles
constexpr std::size_t facet_size = 50;

/// Gives equal coordinates one number, by first appearance. Open addressing over the bits: -0 is made 0, and NaN equals NaN of the same bits.
class Welder {
public:
    explicit Welder(std::vector<double>& positions) : positions_(positions), slots_(1024, -1) {}

    Index vertex(const double point[3]) {
        if (static_cast<std::size_t>(count_) * 2 >= slots_.size()) grow();
        double normalised[3];
        for (int i = 0; i < 3; ++i) normalised[i] = point[i] == 0 ? 0.0 : point[i];
        std::size_t slot = hash(normalised);
        for (; slots_[slot] >= 0; slot = (slot + 1) & (slots_.size() - 1))
            if (std::memcmp(&positions_[3 * static_cast<std::size_t>(slots_[slot])], normalised, sizeof(normalised)) == 0) return slots_[slot];
        positions_.insert(positions_.end(), normalised, normalised + 3);
        return slots_[slot] = count_++;
    }

    Index count() const { return count_; }

private:
    std::size_t hash(const double* point) const {
        std::uint64_t bits[3];
        std::memcpy(bits, point, sizeof(bits));
        std::uint64_t mixed = 0;
        for (const std::uint64_t part : bits) {
            mixed = (mixed ^ part) * 0x9e3779b97f4a7c15u;
            mixed ^= mixed >> 32;
        }
        return static_cast<std::size_t>(mixed) & (slots_.size() - 1);
    }

    void grow() {
        slots_.assign(slots_.size() * 2, -1);
        for (Index v = 0; v < count_; ++v) {
            std::size_t slot = hash(&positions_[3 * static_cast<std::size_t>(v)]);
            while (slots_[slot] >= 0) slot = (slot + 1) & (slots_.size() - 1);
            slots_[slot] = v;
        }
    }

    std::vector<double>& positions_;
    std::vector<Index> slots_;
    Index count_ = 0;
};

class StlReader {
public:
    explicit StlReader(const InputBytes& input) : input_(input), welder_(file_.mesh.positions) {}

    MeshFile read() {
        const std::uint64_t told = told_size();
        if (told == input_.size) read_binary();
        else if (looks_ascii()) read_ascii();
        else if (input_.size >= head_size && told < input_.size) {
            file_.warnings.push_back(std::to_string(input_.size - told) + " bytes behind the last triangle were ignored");
            read_binary();
        } else {
            fail_size(told);
        }
        file_.mesh.vertex_count = welder_.count();
        return std::move(file_);
    }

private:
    std::uint32_t told_triangles() const {
        std::uint32_t count = 0;
        if (input_.size >= head_size) std::memcpy(&count, input_.data + 80, 4);
        return count;
    }

    std::uint64_t told_size() const { return head_size + facet_size * std::uint64_t(told_triangles()); }

    /// Begins with 'solid' and holds nothing but text in its first kilobyte.
    bool looks_ascii() const {
        TextScanner scan(input_, 0);
        scan.skip_space();
        std::string word(scan.word().substr(0, 5));
        for (char& c : word) c = lower(c);
        const std::size_t sample = std::min<std::size_t>(input_.size, 1024);
        return word == "solid" && std::memchr(input_.data, 0, sample) == nullptr;
    }

    [[noreturn]] void fail_size(std::uint64_t told) const {
        if (input_.size < head_size)
            throw BadInput(input_.name + ": neither ASCII STL (no word 'solid') nor binary STL (" + std::to_string(input_.size) + " bytes, the least is 84)");
        throw BadInput(input_.name + ": binary STL of " + std::to_string(told_triangles()) + " triangles takes " + std::to_string(told) +
                       " bytes, the file has " + std::to_string(input_.size) + "; it is cut off or no STL file");
    }

    void read_binary() {
        const std::size_t count = told_triangles();
        check_count(count);
        file_.mesh.face_offsets.reserve(count + 1);
        file_.mesh.face_vertices.reserve(3 * count);
        std::size_t coloured = 0;
        for (std::size_t f = 0; f < count; ++f) {
            const char* facet = input_.data + head_size + facet_size * f;
            for (std::size_t corner = 0; corner < 3; ++corner) {
                float values[3];
                std::memcpy(values, facet + 12 * (corner + 1), sizeof(values));
                const double point[3] = {values[0], values[1], values[2]};
                file_.mesh.face_vertices.push_back(welder_.vertex(point));
            }
            file_.mesh.face_offsets.push_back(static_cast<Index>(file_.mesh.face_vertices.size()));
            coloured += facet[48] != 0 || facet[49] != 0;
        }
        if (coloured > 0) file_.warnings.push_back("the attributes (colours) of " + std::to_string(coloured) + " triangles were dropped");
    }

    void check_count(std::size_t triangles) const {
        if (triangles > static_cast<std::size_t>(std::numeric_limits<Index>::max()) / 3)
            throw BadInput(input_.name + ": " + std::to_string(triangles) + " triangles have more than 2147483647 corners, the most that can be numbered");
    }

    void read_ascii() {
        TextScanner scan(input_, 0);
        std::size_t corners = 0;
        bool is_open = false;
        for (scan.skip_space(); !scan.at_end(); scan.skip_space()) {
            const char* first = scan.at();
            std::string word = printable(scan.word());
            for (char& c : word) c = lower(c);
            if (word == "vertex") {
                read_corner(scan);
                ++corners;
            } else if (word == "facet") {
                if (is_open) scan.fail(first, "a facet begins before the one above has ended (endfacet)");
                is_open = true;
                skip_normal(scan);
            } else if (word == "endfacet") {
                if (corners != 3) scan.fail(first, "a facet has " + std::to_string(corners) + " vertices; STL holds triangles only");
                file_.mesh.face_offsets.push_back(static_cast<Index>(file_.mesh.face_vertices.size()));
                corners = 0;
                is_open = false;
            } else if (word == "solid" || word == "endsolid" || word == "color") {
                scan.skip_line();
            } else if (word != "outer" && word != "loop" && word != "endloop") {
                scan.fail(first, "'" + word + "' is no word of ASCII STL");
            }
        }
        if (is_open || corners > 0) scan.fail(scan.at(), "the file ends within a facet");
    }

    void read_corner(TextScanner& scan) {
        double point[3];
        for (double& value : point) {
            scan.skip_space();
            value = scan.number("a coordinate");
        }
        check_count(file_.mesh.face_vertices.size() / 3);
        file_.mesh.face_vertices.push_back(welder_.vertex(point));
    }

    /// Normals follow from the corners, and some programs write what is no number; they are not looked at.
    static void skip_normal(TextScanner& scan) {
        for (int i = 0; i < 4; ++i) {
            scan.skip_blanks();
            scan.word();
        }
    }

    static char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

    const InputBytes& input_;
    MeshFile file_;
    Welder welder_;
};

/// The unit normal of a triangle; zeros if it has none.
void triangle_normal(const double* a, const double* b, const double* c, float normal[3]) {
    double u[3], v[3];
    for (int i = 0; i < 3; ++i) u[i] = b[i] - a[i], v[i] = c[i] - a[i];
    const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    const bool has_direction = length > 0 && std::isfinite(length);
    for (int i = 0; i < 3; ++i) normal[i] = has_direction ? static_cast<float>(n[i] / length) : 0.0f;
}

void check_triangles(const PolygonMesh& mesh) {
    for (Index f = 0; f < mesh.face_count(); ++f)
        if (mesh.degree(f) != 3)
            throw InvalidArgument(
                "STL holds triangles only; face " + std::to_string(f) + " has " + std::to_string(mesh.degree(f)) + " corners; write OBJ, PLY or OFF",
                {{}, {f}});
}

void write_triangle(OutputBuffer& out, const PolygonMesh& mesh, const Index* vertices) {
    const double* corners[3];
    for (int c = 0; c < 3; ++c) corners[c] = &mesh.positions[3 * static_cast<std::size_t>(vertices[c])];
    float normal[3];
    triangle_normal(corners[0], corners[1], corners[2], normal);
    for (const float value : normal) out.raw(value);
    for (const double* corner : corners)
        for (int i = 0; i < 3; ++i) out.raw(static_cast<float>(corner[i]));
    out.raw(static_cast<std::uint16_t>(0));
}

}  // namespace

MeshFile read_stl(const InputBytes& input) { return StlReader(input).read(); }

void write_stl(const MeshFile& file, ByteSink& sink) {
    const PolygonMesh& mesh = file.mesh;
    check_triangles(mesh);
    OutputBuffer head;
    std::string title = "limitcl binary STL";
    title.resize(80, ' ');  // not 'solid': that is how ASCII begins
    head.text(title);
    head.raw(static_cast<std::uint32_t>(mesh.face_count()));
    head.pass_on(sink);
    write_rows(sink, static_cast<std::size_t>(mesh.face_count()),
               [&](OutputBuffer& out, std::size_t f) { write_triangle(out, mesh, &mesh.face_vertices[static_cast<std::size_t>(mesh.face_offsets[f])]); });
}

}  // namespace lcl
