// SPDX-License-Identifier: BSD-3-Clause
// Files that are read and written in parts, at once: the parts give what the whole gives, wherever it is cut.
#include <catch2/catch.hpp>

#include <fcntl.h>
#include <unistd.h>

#include "host/io/format.h"
#include "host/io/number_write.h"
#include "tests/io_support.h"

using namespace io_test;
using lcl::FileFormat;
using lcl::Index;
using lcl::MeshFile;
using lcl::Splitting;

namespace {

/// Every statement, line end and form of an index that OBJ has, a colour and a third texture coordinate that begin late, no line end at the end.
const std::string awkward_obj =
    "\xEF\xBB\xBF# comment \\\nv 1 2 3 goes on in the comment\nv 0 0 0\r\nv 1 0 0\rv 0 1 0\n\n\r\n\r# a\nmtllib a.mtl\no left \\\r\nright\nvt 0 0\nvt 0.5 "
    "0.25\n"
    "f 1 2 3\nf -3 -2 -1\nusemtl red\nl 1 2\nf 1/1 2/-1 3/2\nv 1 1 0 0.25 0.5 0.75\nv 2 2 2 1\nv 3 3 3 0.5\nvn 0 0 1\nf 4//1 -1/ 2\\\n 3\\\r\n 5 \\\r -2\n"
    "t crease 2/1/0 0 1 10\nt hole 1/0/0 0\ng b\nv 4 4 4 1 1 1 0.5\nvt 1 2 3\nf -1/-1/-1 -2/-3/ 1\np 4\ncurv2 7\nf\nt crease 2/1/0 1 2 11\nt corner 1/1/0 2 "
    "10\n"
    "t interpolateboundary 1/0/0 2\nt creasemethod 0/0/1 x\nt hole 1/0/0 1\nv 9 9 9 9 9\n   \t f\t1  2 3 # end \\\nf 9 9 9\nl 3 4\ng last\nf 900 1/7 2\ns off";

void check_same(const MeshFile& a, const MeshFile& b) {
    CHECK(same_mesh(a.mesh, b.mesh));
    REQUIRE(a.properties.size() == b.properties.size());
    for (std::size_t i = 0; i < a.properties.size(); ++i) {
        CHECK(a.properties[i].name == b.properties[i].name);
        CHECK(a.properties[i].type == b.properties[i].type);
        CHECK(same_bits(a.properties[i].values, b.properties[i].values));
    }
    CHECK(a.uvs.components == b.uvs.components);
    CHECK(same_bits(a.uvs.values, b.uvs.values));
    CHECK(a.uvs.corner_indices == b.uvs.corner_indices);
    REQUIRE(a.lines.size() == b.lines.size());
    for (std::size_t i = 0; i < a.lines.size(); ++i) {
        CHECK(a.lines[i].before_face == b.lines[i].before_face);
        CHECK(a.lines[i].text == b.lines[i].text);
    }
    CHECK(a.tags.creases == b.tags.creases);
    CHECK(a.tags.corners == b.tags.corners);
    CHECK(a.tags.interpolate_boundary == b.tags.interpolate_boundary);
    CHECK(a.tags.refused == b.tags.refused);
    CHECK(a.tags.ignored == b.tags.ignored);
    CHECK(a.unknown_statements == b.unknown_statements);
    CHECK(a.warnings == b.warnings);
}

using Reader = MeshFile (*)(const lcl::InputBytes&);

MeshFile read_with(Reader read, const std::string& text, const Splitting& splitting) {
    const std::string name = "cut";
    return read({text.data(), text.size(), name, splitting});
}

std::string refusal_with(Reader read, const std::string& text, const Splitting& splitting) {
    return error_of<lcl::BadInput>([&] { read_with(read, text, splitting); });
}

/// Parts without end in which nearly every place is a cut.
std::vector<std::size_t> part_counts(const std::string& text) {
    std::vector<std::size_t> counts{text.size()};
    for (std::size_t count = 2; count < 40; ++count) counts.push_back(count);
    return counts;
}

/// A text in a file that is open as long as it lives.
class OpenText {
public:
    OpenText(const TemporaryFolder& folder, const std::string& text) : path_(folder.file("text")), size_(text.size()) {
        write_bytes(path_, text);
        descriptor_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
    }
    ~OpenText() { ::close(descriptor_); }
    OpenText(const OpenText&) = delete;
    OpenText& operator=(const OpenText&) = delete;
    lcl::Text text() const { return {nullptr, size_, path_, descriptor_}; }
    lcl::Text text(std::size_t size) const { return {nullptr, size, path_, descriptor_}; }

private:
    std::string path_;
    std::size_t size_;
    int descriptor_;
};

/// A grid of quads with coordinates of all lengths, of which many rows fill several buffers of the writers.
MeshFile large_grid() {
    constexpr Index side = 150;
    MeshFile file;
    file.mesh.vertex_count = side * side;
    for (Index v = 0; v < side * side; ++v)
        for (const double value : {v / side / 7.0, v % side / 2.0, std::sin(v)}) file.mesh.positions.push_back(value);
    for (Index i = 0; i + 1 < side; ++i)
        for (Index j = 0; j + 1 < side; ++j) {
            const Index a = i * side + j;
            file.mesh.face_vertices.insert(file.mesh.face_vertices.end(), {a, a + 1, a + side + 1, a + side});
            file.mesh.face_offsets.push_back(static_cast<Index>(file.mesh.face_vertices.size()));
        }
    return file;
}

struct StringSink : lcl::ByteSink {
    void write(const char* bytes, std::size_t size) override { text.append(bytes, size); }
    std::string text;
};

}  // namespace

TEST_CASE("an OBJ text that is read in parts gives what it gives as a whole", "[io][obj][parts][thread]") {
    const MeshFile whole = read_with(lcl::read_obj, awkward_obj, {1, 1, 0});
    REQUIRE(whole.mesh.face_count() == 8);
    REQUIRE(whole.mesh.vertex_count == 8);
    for (const std::size_t count : part_counts(awkward_obj)) {
        INFO(count << " parts");
        check_same(read_with(lcl::read_obj, awkward_obj, {1, count, 0}), whole);
        const std::string name = "cut";
        CHECK(lcl::try_read_obj({awkward_obj.data(), awkward_obj.size(), name}, {1, count, 0}));  // not by another attempt from the beginning
    }
}

TEST_CASE("an OBJ file that is read in pieces gives what it gives in memory", "[io][obj][parts][thread]") {
    const TemporaryFolder folder;
    const OpenText file(folder, awkward_obj);
    const MeshFile whole = read_with(lcl::read_obj, awkward_obj, {1, 1, 0});
    for (const std::size_t piece : {1, 2, 3, 7, 16, 61, 5000})
        for (const std::size_t count : {1, 2, 3, 8, 31}) {
            INFO(count << " parts in pieces of " << piece);
            const std::optional<MeshFile> read = lcl::try_read_obj(file.text(), {1, count, piece});
            REQUIRE(read);
            check_same(*read, whole);
        }
}

TEST_CASE("the first line of an OBJ text that is wrong is named, however it is cut", "[io][obj][parts]") {
    const std::string good = "v 0 0 0\nv 1 0 0 \\\n\nv 0 1 0\r\nf 1 2 3\nt hole 0/0/0\nf -1 -2 -3\n";
    for (const std::string bad : {"f 1 2 x\n", "v 1 2\n", "f -99 1 2\n", "f 0 1 2\n", "f 1 2 -9223372036854775807\n", "f 1/-1 2 3\n", "vt\n"})
        for (const std::string& text : {good + bad + good, bad + good + good, good + good + bad, good + bad + good + "f 1 2 y\n", bad + good + bad}) {
            const std::string expected = refusal_with(lcl::read_obj, text, {1, 1, 0});
            CHECK(contains(expected, "cut:"));
            for (const std::size_t count : {2, 3, 5, 9, 17}) CHECK(refusal_with(lcl::read_obj, text, {1, count, 0}) == expected);
        }
    for (const std::size_t count : {1, 2, 3, 9}) {
        CHECK(contains(refusal_with(lcl::read_obj, "f 1 2 3\n\nf 1 2 3\n", {1, count, 0}), "no vertex line"));
        CHECK(contains(read_with(lcl::read_obj, good + good + "t corner 1/1/0 0 3\n" + good, {1, count, 0}).tags.refused, "cut:15: sharpness 3 "));
    }
}

TEST_CASE("a large OBJ file is refused with the number of the line", "[io][obj][parts][thread]") {
    const TemporaryFolder folder;
    std::vector<std::string> warnings;
    lcl::write_mesh(folder.file("a.obj"), large_grid(), FileFormat::by_ending, warnings);
    check_same(lcl::read_mesh(folder.file("a.obj")), large_grid());
    write_bytes(folder.file("b.obj"), file_bytes(folder.file("a.obj")) + "f 1 2 x\nf 1 2 y\n");
    CHECK(contains(error_of<lcl::BadInput>([&] { lcl::read_mesh(folder.file("b.obj")); }), "b.obj:" + std::to_string(150 * 150 + 149 * 149 + 1) + ": 'x'"));
}

namespace {

/// Skipped elements before, between and behind, lists among the scalars, texture coordinates of which one list is too short, empty and blank lines.
const std::string awkward_ply_header =
    "element start 3\nproperty int a\nelement vertex 5\nproperty double x\nproperty uchar red\nproperty list uchar int more\nproperty float y\nproperty double "
    "z\n"
    "element nothing 2\nelement face 4\nproperty list uchar float texcoord\nproperty list ushort int vertex_indices\nproperty short flag\n"
    "element end 2\nproperty list int double values\nend_header\n";
const std::string awkward_ply_body =
    "1\n2\n\n3\n0 1 0 0 0\n 1 2 2 7 8 0.5 0\n \t \n0 3 0 1 0.1\r\n1 4 1 9 1 0\n2 5 0 2 2\n6 0 0 0.5 0 1 1 3 0 1 2 5\n0 4 1 2 3 4 6\n\r\n"
    "1 0.25 3 4 3 2 7\n8 0 0 1 0 1 1 0 1 4 0 1 3 2 8\n2 1 2\n0";

template <class T>
void put(std::string& bytes, double value, bool swap) {
    T typed = static_cast<T>(value);
    if (swap) typed = lcl::swap_bytes(typed);
    bytes.append(reinterpret_cast<const char*>(&typed), sizeof typed);
}

/// Triangles, quads and pentagons with a column of bytes, in one of the binary encodings.
std::string binary_ply(bool swap) {
    std::string bytes = std::string("ply\nformat binary_") + (swap ? "big" : "little") +
                        "_endian 1.0\nelement vertex 40\nproperty float x\nproperty uchar red\nproperty double y\nproperty short z\n"
                        "element face 60\nproperty list uchar int vertex_indices\nproperty list uint float texcoord\nend_header\n";
    for (int v = 0; v < 40; ++v)
        put<float>(bytes, v / 3.0, swap), put<unsigned char>(bytes, v, swap), put<double>(bytes, v / 7.0, swap), put<short>(bytes, -v, swap);
    for (int f = 0; f < 60; ++f) {
        const int degree = 3 + f % 3;
        put<unsigned char>(bytes, degree, swap);
        for (int i = 0; i < degree; ++i) put<int>(bytes, (f + i) % 40, swap);
        const int uvs = f % 4 == 0 ? 2 * degree : f % 4;
        put<unsigned>(bytes, uvs, swap);
        for (int i = 0; i < uvs; ++i) put<float>(bytes, f + i / 8.0, swap);
    }
    return bytes;
}

/// Triangles that share corners, one with -0.
std::string binary_stl() {
    std::string bytes(80, ' ');
    put<unsigned>(bytes, 100, false);
    for (int f = 0; f < 100; ++f) {
        for (int i = 0; i < 3; ++i) put<float>(bytes, 0, false);
        for (int i = 0; i < 3; ++i) put<float>(bytes, (f + i) % 20, false), put<float>(bytes, f % 2 ? -0.0 : 0.0, false), put<float>(bytes, (f + i) % 3, false);
        put<short>(bytes, 0, false);
    }
    return bytes;
}

/// A line each, with comments, normals, texture coordinates and colours of faces.
const std::string awkward_off =
    "STNOFF # comment\n\n6 4 9\n0 0 0 0 0 1 0 0\n# between\n1 0 0 0 0 1 1 0 # behind\n  \t\n1 1 0 0 0 1 1 1\r\n0 1 0 0 0 1 0 1 7 8\n2 2 2 0 0 1 0.5 0.5\n"
    "3 3 3 0 0 1 0.25 1\n4 0 1 2 3\n3 1 2 4 255 0 0\n\n# end\n0\n3 5 4 3 1 1\n\n# last\n";

void check_all_cuts(Reader read, const std::string& text) {
    const MeshFile whole = read_with(read, text, {1, 1, 0});
    for (const std::size_t count : part_counts(text)) {
        INFO(count << " parts");
        check_same(read_with(read, text, {1, count, 0}), whole);
    }
}

void check_all_refusals(Reader read, const std::string& text, const std::string& expected) {
    INFO(text);
    CHECK_THAT(refusal_with(read, text, {1, 1, 0}), Catch::Contains(expected));
    for (const std::size_t count : part_counts(text)) CHECK(refusal_with(read, text, {1, count, 0}) == refusal_with(read, text, {1, 1, 0}));
}

std::string replaced(std::string text, const std::string& old, const std::string& by) {
    const std::size_t place = text.rfind(old);
    REQUIRE(place != std::string::npos);
    return text.replace(place, old.size(), by);
}

}  // namespace

TEST_CASE("PLY that is read in parts gives what it gives as a whole", "[io][ply][parts][thread]") {
    const std::string ascii = "ply\nformat ascii 1.0\n" + awkward_ply_header + awkward_ply_body;
    const MeshFile whole = read_with(lcl::read_ply, ascii, {1, 1, 0});
    CHECK(whole.mesh.face_offsets == std::vector<Index>{0, 3, 7, 10, 14});
    CHECK(whole.uvs.corner_indices == std::vector<Index>{0, 1, 2, -1, -1, -1, -1, -1, -1, -1, 3, 4, 5, 6});
    check_all_cuts(lcl::read_ply, ascii);
    check_all_cuts(lcl::read_ply, ascii + "\n\n");
    std::string carriage_returns = ascii;
    std::replace(carriage_returns.begin(), carriage_returns.end(), '\n', '\r');
    check_all_cuts(lcl::read_ply, carriage_returns);
    check_all_cuts(lcl::read_ply, binary_ply(false));
    check_all_cuts(lcl::read_ply, binary_ply(true));
}

TEST_CASE("the first row of a PLY file that is wrong is named, however it is cut", "[io][ply][parts]") {
    const std::string ascii = "ply\nformat ascii 1.0\n" + awkward_ply_header + awkward_ply_body;
    check_all_refusals(lcl::read_ply, replaced(replaced(ascii, "2 5 0 2 2", "2 5 0 2"), "0 4 1", "x 4 1"), "cut:28: the line ends where a value");
    check_all_refusals(lcl::read_ply, replaced(replaced(ascii, "3 2 7", "3 2 x"), "3 2 8", "3 2 y"), "cut:32: 'x'");
    check_all_refusals(lcl::read_ply, replaced(ascii, "2 1 2\n0", "2 1 2\n"), "the file ends");
    check_all_refusals(lcl::read_ply, replaced(ascii, "\n2\n\n3", "\n2 2\n\n3"), "cut:20: the row has more values");
    for (const std::string& bytes : {binary_ply(false), binary_ply(true)}) {
        check_all_refusals(lcl::read_ply, bytes.substr(0, bytes.size() - 1), "(byte ");
        check_all_refusals(lcl::read_ply, bytes.substr(0, bytes.size() - 900), "(byte ");
    }
}

TEST_CASE("OFF that is read in parts gives what it gives as a whole", "[io][off][parts][thread]") {
    CHECK(read_with(lcl::read_off, awkward_off, {1, 1, 0}).warnings.size() == 2);
    check_all_cuts(lcl::read_off, awkward_off);
    check_all_cuts(lcl::read_off, awkward_off + "more");
    check_all_cuts(lcl::read_off, replaced(awkward_off, "0 0 0 0 0 1 0 0\n", "0 0\n0 0 0 1 0 0\n"));
    check_all_cuts(lcl::read_off, replaced(replaced(awkward_off, "0 0 0 0 0 1 0 0\n", "0 0\n0 0 0 1 0 0\n"), "3 5 4 3 1 1\n", "3 5 4 3 1 1"));
    check_all_cuts(lcl::read_off, "COFF 3 1 0\n0 0 0 1 0 0\n1 0 0 0 1 0 1\n0 1 0 0 0 1\n3 0 1 2\n");
    check_all_cuts(lcl::read_off, "OFF\r3 1 0\r0 0 0\r1 0 0\r0 1 0\r3 0 1 2\r");
}

TEST_CASE("the first line of an OFF file that is wrong is named, however it is cut", "[io][off][parts]") {
    check_all_refusals(lcl::read_off, replaced(replaced(awkward_off, "1 0 1 7 8", "1 0 x"), "3 5 4", "y 5 4"), "cut:9: 'x'");
    check_all_refusals(lcl::read_off, replaced(awkward_off, "3 1 2 4 255", "3 1 2.5 4 255"), "cut:13: '2.5'");
    check_all_refusals(lcl::read_off, replaced(awkward_off, "1 1 0 0 0 1 1 1\r\n", "1 1 0\r\n"), "cut:");  // takes numbers of the next line
    check_all_refusals(lcl::read_off, replaced(awkward_off, "3 5 4 3 1 1", "3 5"), "the file ends");
}

TEST_CASE("corners of STL are welded alike, many or one at a time", "[io][stl][parts]") {
    const MeshFile file = read_with(lcl::read_stl, binary_stl(), {});
    std::string ascii = "solid\n";
    for (Index f = 0; f < file.mesh.face_count(); ++f) {
        ascii += "facet normal 0 0 0\nouter loop\n";
        for (int i = 0; i < 3; ++i) ascii += "vertex " + std::to_string((f + i) % 20) + (f % 2 ? " -0 " : " 0 ") + std::to_string((f + i) % 3) + "\n";
        ascii += "endloop\nendfacet\n";
    }
    CHECK(file.mesh.vertex_count == 60);
    CHECK(same_mesh(file.mesh, read_with(lcl::read_stl, ascii + "endsolid\n", {}).mesh));
    CHECK_FALSE(std::signbit(file.mesh.positions[1]));
}

TEST_CASE("a file that becomes shorter while it is read is an error", "[io][parts]") {
    const TemporaryFolder folder;
    const OpenText file(folder, awkward_obj);
    CHECK(contains(error_of<lcl::FileError>([&] { lcl::try_read_obj(file.text(awkward_obj.size() + 10), {1, 3, 16}); }), "it became shorter"));
}

TEST_CASE("text is cut before lines only, and not where a backslash continues one", "[io][parts]") {
    const std::string text = "a\nb\r\nc\rd\\\ne\\\r\nf\\\rg\n\nh\r\r\ni\\";
    const std::vector<std::size_t> lines{0, 2, 5, 7, 19, 20, 22, 24};
    const std::string name = "cut";
    const lcl::Text memory{text.data(), text.size(), name};
    const TemporaryFolder folder;
    const OpenText file(folder, text);
    for (std::size_t at = 0; at <= text.size(); ++at) {
        const auto expected = std::lower_bound(lines.begin(), lines.end(), at);
        CHECK(lcl::next_line(memory, at) == (expected == lines.end() ? text.size() : *expected));
        CHECK(lcl::next_line(file.text(), at) == lcl::next_line(memory, at));
    }
    const std::string long_line = "a" + std::string(20000, 'x') + "\nb";
    const OpenText long_file(folder, long_line);
    CHECK(lcl::next_line(long_file.text(), 1) == 20002);
    CHECK(lcl::next_line(long_file.text(), 20003) == long_line.size());
}

TEST_CASE("rows that are written at once stand in their order", "[io][parts][thread]") {
    for (const std::size_t count : {0, 1, 4095, 4096, 4097, 100000}) {
        StringSink sink;
        lcl::write_rows(sink, count, [](lcl::OutputBuffer& out, std::size_t row) {
            out.number(row);
            out.character('\n');
        });
        std::string expected;
        for (std::size_t row = 0; row < count; ++row) expected += std::to_string(row) + "\n";
        CHECK(sink.text == expected);
    }
}

TEST_CASE("a failure of the sink or of a row ends the writing", "[io][parts][thread]") {
    struct FullSink : lcl::ByteSink {
        void write(const char*, std::size_t) override {
            if (++calls == 3) throw lcl::WriteError("full");
        }
        int calls = 0;
    } full;
    const auto write_number = [](lcl::OutputBuffer& out, std::size_t row) { out.number(row); };
    CHECK(error_of<lcl::WriteError>([&] { lcl::write_rows(full, 1000000, write_number); }) == "full");
    CHECK(full.calls == 3);
    StringSink sink;
    const auto fail_late = [](lcl::OutputBuffer& out, std::size_t row) {
        if (row == 70000) throw lcl::WriteError("row");
        out.number(row);
    };
    CHECK(error_of<lcl::WriteError>([&] { lcl::write_rows(sink, 1000000, fail_late); }) == "row");
    CHECK(sink.text.size() < 400000);
}
