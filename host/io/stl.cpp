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

    /// Room for a closed mesh of so many triangles, which has half as many vertices; more grow it.
    void expect(std::size_t triangles) {
        while (slots_.size() < triangles) slots_.resize(2 * slots_.size(), -1);
        positions_.reserve(3 * (triangles / 2 + 2));
    }

    static constexpr std::size_t batch = 48;

    /// The vertices of up to `batch` points (x y z each, which become normalised). They are looked for together: all that may be needed of the table and of
    /// the positions is fetched before the first is looked at, as each of them is a wait for memory.
    void find(double* points, std::size_t count, Index* vertices) {
        while ((static_cast<std::size_t>(count_) + count) * 2 >= slots_.size()) grow();
        std::size_t hashes[batch];
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t axis = 0; axis < 3; ++axis) points[3 * i + axis] += 0.0;  // -0 becomes 0
            hashes[i] = hash(points + 3 * i);
            __builtin_prefetch(&slots_[hashes[i]]);
        }
        for (std::size_t i = 0; i < count; ++i)
            if (const Index vertex = slots_[hashes[i]]; vertex >= 0) __builtin_prefetch(&positions_[3 * static_cast<std::size_t>(vertex)]);
        for (std::size_t i = 0; i < count; ++i) vertices[i] = vertex(points + 3 * i, hashes[i]);
    }

    Index count() const { return count_; }

private:
    Index vertex(const double* point, std::size_t slot) {
        for (; slots_[slot] >= 0; slot = (slot + 1) & (slots_.size() - 1))
            if (std::memcmp(&positions_[3 * static_cast<std::size_t>(slots_[slot])], point, 3 * sizeof(double)) == 0) return slots_[slot];
        positions_.insert(positions_.end(), point, point + 3);
        return slots_[slot] = count_++;
    }

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
        welder_.expect(count);
        file_.mesh.face_offsets.resize(count + 1);
        file_.mesh.face_vertices.resize(3 * count);
        std::size_t coloured = 0;
        for (std::size_t f = 0; f < count; ++f) {
            file_.mesh.face_offsets[f + 1] = static_cast<Index>(3 * (f + 1));
            const char* attributes = input_.data + head_size + facet_size * f + 48;
            coloured += attributes[0] != 0 || attributes[1] != 0;
        }
        constexpr std::size_t step = Welder::batch / 3;
        for (std::size_t f = 0; f < count; f += step) weld(f, std::min(step, count - f));
        if (coloured > 0) file_.warnings.push_back("the attributes (colours) of " + std::to_string(coloured) + " triangles were dropped");
    }

    void weld(std::size_t first, std::size_t count) {
        double points[3 * Welder::batch];
        for (std::size_t i = 0; i < 3 * count; ++i) {
            float values[3];
            std::memcpy(values, input_.data + head_size + facet_size * (first + i / 3) + 12 * (i % 3 + 1), sizeof(values));
            std::copy(values, values + 3, points + 3 * i);
        }
        welder_.find(points, 3 * count, &file_.mesh.face_vertices[3 * first]);
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
        file_.mesh.face_vertices.emplace_back();
        welder_.find(point, 1, &file_.mesh.face_vertices.back());
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
