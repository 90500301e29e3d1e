// SPDX-License-Identifier: BSD-3-Clause
// Points out of files: every format, what further columns are, and what is refused with which sentence.
#include <algorithm>
#include <sstream>

#include <catch2/catch.hpp>

#include "host/io/point_text.h"
#include "host/io/points_file.h"
#include "tests/compressed.h"
#include "tests/io_support.h"

using namespace io_test;
using lcl::FileFormat;
using lcl::PointCloud;

namespace {

PointCloud read_as(FileFormat format, const std::string& text, const std::string& name = "text") {
    return lcl::read_points_memory(text.data(), text.size(), format, name);
}
PointCloud xyz(const std::string& text) { return read_as(FileFormat::xyz, text); }
PointCloud csv(const std::string& text) { return read_as(FileFormat::csv, text); }
PointCloud pts(const std::string& text) { return read_as(FileFormat::pts, text); }

std::string refused(FileFormat format, const std::string& text) {
    return error_of<lcl::BadInput>([&] { read_as(format, text, "a"); });
}

using Numbers = std::vector<double>;

/// The bytes of numbers as another kind of processor would write them, or as this one does.
template <class T>
std::string binary(const std::vector<T>& values, bool swap = false) {
    std::string bytes;
    for (const T value : values) {
        char raw[sizeof(T)];
        std::memcpy(raw, &value, sizeof(T));
        if (swap) std::reverse(raw, raw + sizeof(T));
        bytes.append(raw, sizeof(T));
    }
    return bytes;
}

const std::string ply_coordinates = "property double x\nproperty double y\nproperty double z\n";
const std::string ply_normals = "property float nx\nproperty float ny\nproperty float nz\n";
std::string ply_header(const std::string& encoding, int count, const std::string& properties) {
    return "ply\nformat " + encoding + " 1.0\nelement vertex " + std::to_string(count) + "\n" + properties + "end_header\n";
}

}  // namespace

TEST_CASE("text gives the very numbers, whatever stands between them", "[points]") {
    const Numbers expected{0.1, -2, 3e5, 4, 1.0 / 3, -0.0};
    const std::string third = "0.33333333333333331";
    for (const std::string& text : {
             "0.1 -2 3e5\n4 " + third + " -0\n",
             "0.1,-2,3e5\n4," + third + ",-0\n",
             "0.1 ; -2;3e5;\n  4; " + third + " ;-0\n",
             "0.1\t-2\t3e5\r\n4\t" + third + "\t-0\r\n",
             "0.1 -2 3e5\r4 " + third + " -0\r",
             "\xEF\xBB\xBF" + std::string("0.1 -2 3e5\n\n  \n4 ") + third + " -0",
             "# a comment\n+0.1 -2 3E+5 # another\n#\n4 " + third + " -0 #",
             "//X Y Z\n0.1 -2 3e5\n4 " + third + " -0\n",
         }) {
        INFO(text);
        const PointCloud cloud = xyz(text);
        CHECK(same_bits(cloud.points, expected));
        CHECK(cloud.normals.empty());
        CHECK(cloud.colours.empty());
        CHECK(cloud.warnings.empty());
    }
    CHECK(same_bits(pts("2\n0.1 -2 3e5\n4 " + third + " -0\n").points, expected));
    CHECK(same_bits(pts("# two\n 2 \n0.1 -2 3e5\n\n4 " + third + " -0").points, expected));
    for (const char separator : {',', ';', '\t'}) {
        std::string text = "x,y,z\n0.1,-2,3e5\n4," + third + ",-0\n";
        std::replace(text.begin(), text.end(), ',', separator);
        CHECK(same_bits(csv(text).points, expected));
    }
}

TEST_CASE("what three further columns are is told by what stands in them", "[points]") {
    SECTION("whole numbers up to 255 are colours") {
        const PointCloud cloud = xyz("0 0 0 255 0 51\n1 0 0 0 102 0\n");
        CHECK(cloud.colours == Numbers{1, 0, 0.2, 0, 0.4, 0});
        CHECK(cloud.normals.empty());
        CHECK(cloud.warnings.empty());
    }
    SECTION("unit vectors are normals, also where they are whole numbers or not negative") {
        CHECK(xyz("0 0 0 0 0 1\n1 0 0 0 1 0\n").normals == Numbers{0, 0, 1, 0, 1, 0});
        CHECK(xyz("0 0 0 0.6 0.8 0\n1 0 0 0.58 0.58 0.57\n").normals == Numbers{0.6, 0.8, 0, 0.58, 0.58, 0.57});
    }
    SECTION("fractions that are no unit vectors are colours") {
        const PointCloud cloud = xyz("0 0 0 0.5 0.25 0\n1 0 0 1 1 0.125\n");
        CHECK(cloud.colours == Numbers{0.5, 0.25, 0, 1, 1, 0.125});
        CHECK(cloud.normals.empty());
    }
    SECTION("other vectors are normals of any length, with a warning") {
        const PointCloud cloud = xyz("0 0 0 0 0 -2\n1 0 0 3 0 0\n");
        CHECK(cloud.normals == Numbers{0, 0, -2, 3, 0, 0});
        REQUIRE(cloud.warnings.size() == 1);
        CHECK(cloud.warnings[0] == "columns 4 to 6 were taken as normals, although their lengths are not 1");
        CHECK(xyz("0 0 0 256 0 0\n1 0 0 3 0 0\n").colours.empty());
    }
    SECTION("zeros are no normals") {
        const PointCloud cloud = xyz("0 0 0 0 0 0\n1 0 0 0 0 0\n");
        CHECK(cloud.normals.empty());
        CHECK(cloud.colours.empty());
        REQUIRE(cloud.warnings.size() == 1);
        CHECK(cloud.warnings[0] == "all normals are zero or not finite; all were left out");
    }
}

TEST_CASE("normals and colours stand beside each other in either order, and what is left over is told", "[points]") {
    const Numbers points{0, 0, 0, 1, 2, 3}, normals{0, 0, 1, 0.6, 0.8, 0}, colours{1, 0, 0.2, 0, 0.4, 0};
    struct Layout {
        const char *first, *second, *warning;
    };
    for (const auto& [first, second, warning] :
         {Layout{"0 0 0 0 0 1 255 0 51", "1 2 3 0.6 0.8 0 0 102 0", ""}, Layout{"0 0 0 255 0 51 0 0 1", "1 2 3 0 102 0 0.6 0.8 0", ""},
          Layout{"0 0 0 0 0 1 255 0 51 8", "1 2 3 0.6 0.8 0 0 102 0 7", "column 10 was left out"},
          Layout{"0 0 0 0 0 1 255 0 51 8 tree 1", "1 2 3 0.6 0.8 0 0 102 0 7 house 2", "columns 10 to 12 were left out"}}) {
        const std::string rows = std::string(first) + "\n" + second + "\n";
        for (const PointCloud& cloud : {xyz(rows), pts("2\n" + rows)}) {
            INFO(rows);
            CHECK(cloud.points == points);
            CHECK(cloud.normals == normals);
            CHECK(cloud.colours == colours);
            CHECK(cloud.warnings == (*warning ? std::vector<std::string>{warning} : std::vector<std::string>{}));
        }
    }
}

TEST_CASE("intensity stands before colours or normals in .pts files", "[points]") {
    const PointCloud coloured = pts("2\n0 0 0 120 255 0 51\n1 2 3 90 0 102 0\n");
    CHECK(coloured.colours == Numbers{1, 0, 0.2, 0, 0.4, 0});
    CHECK(coloured.warnings == std::vector<std::string>{"column 4 (intensity) was left out"});
    const PointCloud both = pts("2\n0 0 0 -9 255 0 51 0 0 1\n1 2 3 7.5 0 102 0 0.6 0.8 0\n");
    CHECK(both.colours == coloured.colours);
    CHECK(both.normals == Numbers{0, 0, 1, 0.6, 0.8, 0});
    CHECK(both.warnings == coloured.warnings);
    CHECK(pts("2\n0 0 0 5 0 0 1\n1 2 3 -7 0.6 0.8 0\n").normals == Numbers{0, 0, 1, 0.6, 0.8, 0});
    CHECK(pts("2\n0 0 0 5 0 0 0\n1 2 3 -7 0 0 0\n").normals.empty());
}

TEST_CASE("a single column behind normals or colours is left out", "[points]") {
    const PointCloud opaque = xyz("0 0 0 255 0 51 255\n1 2 3 0 102 0 255\n");  // red, green, blue, alpha
    CHECK(opaque.colours == Numbers{1, 0, 0.2, 0, 0.4, 0});
    CHECK(opaque.warnings == std::vector<std::string>{"column 7 was left out"});
    const PointCloud both = xyz("0 0 0 0 0 1 255 0 51 128\n1 2 3 0.6 0.8 0 0 102 0 0\n");
    CHECK(both.normals == Numbers{0, 0, 1, 0.6, 0.8, 0});
    CHECK(both.colours == opaque.colours);
    CHECK(both.warnings == std::vector<std::string>{"column 10 was left out"});
    const PointCloud curved = xyz("0 0 0 0 0 1 0.01\n1 2 3 0.6 0.8 0 0.5\n");  // normals and curvature
    CHECK(curved.normals == Numbers{0, 0, 1, 0.6, 0.8, 0});
    CHECK(curved.warnings == std::vector<std::string>{"column 7 was left out"});
    CHECK(xyz("0 0 0 1\n1 2 3 2\n").warnings == std::vector<std::string>{"column 4 was left out"});
    CHECK(xyz("0 0 0 1 2\n1 2 3 2 3\n").warnings == std::vector<std::string>{"columns 4 to 5 were left out"});
}

TEST_CASE("a CSV is read by the names in its header", "[points]") {
    const PointCloud cloud = csv("\"Blue\",id, Z ,nx,y,red,ny,X,green,nz\n51,a b,3,0,2,255,0,1,0,1\n0,\"c,d\",6,0.6,5,0,0.8,4,102,0\n");
    CHECK(cloud.points == Numbers{1, 2, 3, 4, 5, 6});
    CHECK(cloud.normals == Numbers{0, 0, 1, 0.6, 0.8, 0});
    CHECK(cloud.colours == Numbers{1, 0, 0.2, 0, 0.4, 0});
    CHECK(cloud.warnings == std::vector<std::string>{"the column 'id' was left out"});

    CHECK(csv("x,y,z,red,green,blue\n1,2,3,0.5,1,0\n").colours == Numbers{0.5, 1, 0});
    const PointCloud partial = csv("x,y,z,nx,red\n1,2,3,,\n4,5,6,1,2\n");
    CHECK(partial.points == Numbers{1, 2, 3, 4, 5, 6});
    CHECK(partial.normals.empty());
    CHECK(partial.warnings == std::vector<std::string>{"the columns 'nx', 'red' were left out"});
    const PointCloud dark = csv("x,y,z,red,green,blue\n1,2,3,-1,0,0\n");
    CHECK(dark.colours.empty());
    CHECK(dark.warnings == std::vector<std::string>{"the colours are neither whole numbers from 0 to 255 nor numbers from 0 to 1; they were left out"});
    CHECK(csv("x,y,z\n").count() == 0);
    CHECK(contains(refused(FileFormat::csv, "x,y\n1,2\n"), "a:1: the header has no column z: a CSV of points needs x, y and z"));
    CHECK(contains(refused(FileFormat::csv, "1,2,3\n"), "a:1: the header has no column x"));
    CHECK(contains(refused(FileFormat::csv, "x,y,z,nx,ny,nz\n1,2,3,1,0,\n"), "a:2: the line ends where a number was expected"));
    CHECK(contains(refused(FileFormat::csv, "x,y,z\n1,2,3\n1;2;3\n"), "a:3: '1;2;3' was found where a number was expected"));
}

TEST_CASE("vertices of PLY in every encoding are points, with normals and colours", "[points]") {
    const Numbers points{0.1, -2, 3e5, 4, 1.0 / 3, 7}, normals{0, 0, 1, 0.5, -0.5, 2}, colours{1, 0, 0.2, 0, 0.4, 0};
    const std::string colour_names = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    const std::string properties = ply_coordinates + ply_normals + colour_names + "property int label\n";
    std::vector<std::string> files{ply_header("ascii", 2, properties) + "0.1 -2 3e5 0 0 1 255 0 51 9\n4 0.33333333333333331 7 0.5 -0.5 2 0 102 0 8\n"};
    for (const bool swap : {false, true}) {
        std::string text = ply_header(swap ? "binary_big_endian" : "binary_little_endian", 2, properties);
        for (std::size_t i = 0; i < 2; ++i) {
            text += binary<double>({points[3 * i], points[3 * i + 1], points[3 * i + 2]}, swap);
            text += binary<float>({float(normals[3 * i]), float(normals[3 * i + 1]), float(normals[3 * i + 2])}, swap);
            text += i == 0 ? std::string("\xFF\x00\x33", 3) : std::string("\x00\x66\x00", 3);
            text += binary<std::int32_t>({9}, swap);
        }
        files.push_back(text);
    }
    for (const std::string& text : files) {
        const PointCloud cloud = read_as(FileFormat::ply, text);
        CHECK(same_bits(cloud.points, points));
        CHECK(cloud.normals == normals);
        CHECK(cloud.colours == colours);
        CHECK(cloud.warnings == std::vector<std::string>{"the property 'label' was left out"});
    }
}

TEST_CASE("elements and lists before the vertices of a PLY, and faces behind them, are passed over", "[points]") {
    const std::string header = "element camera 1\nproperty list uchar int places\nproperty float zoom\nelement vertex 2\nproperty list uchar short marks\n" +
                               ply_coordinates + "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const std::string ascii = "ply\nformat ascii 1.0\n" + header + "2 5 6 1.5\n1 7 1 2 3\n0 4 5 6\n3 0 1 1\n";
    const std::string bytes = "ply\nformat binary_big_endian 1.0\n" + header + "\2" + binary<std::int32_t>({5, 6}, true) + binary<float>({1.5F}, true) + "\1" +
                              binary<std::int16_t>({7}, true) + binary<double>({1, 2, 3}, true) + std::string(1, '\0') + binary<double>({4, 5, 6}, true) +
                              "\3" + binary<std::int32_t>({0, 1, 1}, true);
    for (const std::string& text : {ascii, bytes}) {
        const PointCloud cloud = read_as(FileFormat::ply, text);
        CHECK(cloud.points == Numbers{1, 2, 3, 4, 5, 6});
        CHECK(cloud.warnings ==
              std::vector<std::string>{"the element 'camera' was skipped", "the property 'marks' of the vertices was dropped", "the face was left out"});
    }
}

TEST_CASE("colours of PLY are scaled by their type, and floats by what stands in them", "[points]") {
    const auto colours_of = [](const std::string& type, const std::string& values) {
        std::string names;
        for (const char* name : {"red", "green", "blue"}) names += "property " + type + " " + name + "\n";
        return read_as(FileFormat::ply, ply_header("ascii", 1, ply_coordinates + names) + "1 2 3 " + values + "\n").colours;
    };
    CHECK(colours_of("uchar", "1 0 0") == Numbers{1.0 / 255, 0, 0});
    CHECK(colours_of("ushort", "65535 0 13107") == Numbers{1, 0, 0.2});
    CHECK(colours_of("float", "0.5 1 0") == Numbers{0.5, 1, 0});
    CHECK(colours_of("float", "255 0 51") == Numbers{1, 0, 0.2});
    CHECK(colours_of("float", "nan 0 0").empty());
    CHECK(colours_of("int", "300 0 0").empty());
}

TEST_CASE("vertices of OFF and OBJ are points, with normals and colours", "[points]") {
    const PointCloud off = read_as(FileFormat::off, "CNOFF\n3 1 0\n0 0 0 0 0 1 255 0 51 255\n1 0 0 0 1 0 0 102 0 255\n0 1 0 1 0 0 0 0 255 9\n3 0 1 2\n");
    CHECK(off.points == Numbers{0, 0, 0, 1, 0, 0, 0, 1, 0});
    CHECK(off.normals == Numbers{0, 0, 1, 0, 1, 0, 1, 0, 0});
    CHECK(off.colours == Numbers{1, 0, 0.2, 0, 0.4, 0, 0, 0, 1});
    CHECK(off.warnings == std::vector<std::string>{"the face was left out", "the property 'alpha' was left out"});

    const PointCloud scan = read_as(FileFormat::obj, "vn 0 0 2\nv 1 2 3 0.5 0.25 0\nvn 0 1 0\nv 4 5 6 1 0 0\np 1 2\n");
    CHECK(scan.points == Numbers{1, 2, 3, 4, 5, 6});
    CHECK(scan.normals == Numbers{0, 0, 2, 0, 1, 0});
    CHECK(scan.colours == Numbers{0.5, 0.25, 0, 1, 0, 0});
    CHECK(scan.warnings.empty());
    CHECK(read_as(FileFormat::obj, "vn 0 0 1\nv 1 2 3\nv 4 5 6\n").normals.empty());

    const PointCloud meshed = read_as(FileFormat::obj, "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 0 3\nf 1//1 2//1 3//1\nf 3//2 2//2 1//2\n");
    CHECK(meshed.normals == Numbers{0, 0, 2, 0, 0, 2, 0, 0, 2});
    CHECK(meshed.warnings == std::vector<std::string>{"the 2 faces were left out"});
}

TEST_CASE("normals are of use to every point or to none", "[points]") {
    const PointCloud filled = xyz("0 0 0 0 0 1\n9 0 0 1 0 0\n8 0 0 0 0 0\n1 0 0 nan 0 0\n5 0 0 0 1 0\n");
    CHECK(filled.normals == Numbers{0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0});
    CHECK(filled.warnings == std::vector<std::string>{"2 of the 5 normals are zero or not finite, the first that of point 2; instead the normal of the nearest "
                                                      "point was taken"});
    const PointCloud dropped = csv("x,y,z,nx,ny,nz\n0,0,0,0,0,0\n1,0,0,inf,0,0\n2,0,0,0,0,1\n");
    CHECK(dropped.normals.empty());
    CHECK(dropped.warnings == std::vector<std::string>{"2 of the 3 normals are zero or not finite, the first that of point 0; all were left out"});
    // Coordinates whose squares are no doubles.
    CHECK(csv("x,y,z,nx,ny,nz\n1e300,0,0,0,0,1\n-1e300,0,0,1,0,0\n9e299,0,0,0,0,0\n").normals == Numbers{0, 0, 1, 1, 0, 0, 0, 0, 1});
    CHECK(csv("x,y,z,nx,ny,nz\n1e-320,0,0,0,0,1\n0,0,0,0,0,0\n").normals == Numbers{0, 0, 1, 0, 0, 1});
}

TEST_CASE("points that are not finite are refused with their place and number", "[points]") {
    CHECK(refused(FileFormat::xyz, "# c\n0 0 0\n\n0 nan 0\n1 1 1\n") == "a:4: the point is not finite: correct it or leave it out");
    CHECK(refused(FileFormat::xyz, "0 0 0\n0 inf 0\n1 1 1e999\n") == "a:2: the point is not finite, nor is 1 more: correct them or leave them out");
    CHECK(contains(refused(FileFormat::pts, "1\n0 0 -inf\n"), "a:2: the point is not finite"));
    CHECK(contains(refused(FileFormat::csv, "x,y,z\n0,0,nan\n"), "a:2: the point is not finite"));
    CHECK(refused(FileFormat::ply, ply_header("ascii", 4, ply_coordinates) + "0 0 0\n1 nan 2\ninf 0 0\n0 0 -inf\n") ==
          "a: point 1 is not finite, nor are 2 more: correct them or leave them out");
    CHECK(contains(refused(FileFormat::obj, "v 0 0 0\nv nan 0 0\n"), "a: point 1 is not finite"));
    try {
        xyz("0 0 0\n0 inf 0\n1 1 inf\n");
    } catch (const lcl::BadInput& error) {
        CHECK(error.where.vertices == std::vector<lcl::Index>{1, 2});
    }
}

TEST_CASE("lines with other columns than the first are refused", "[points]") {
    CHECK(refused(FileFormat::xyz, "0 0 0\n1 1 1\n1 1\n") == "a:3: mixed columns: this line has 2, the first one has 3; every line needs the same");
    CHECK(contains(refused(FileFormat::xyz, "0 0 0\n1 1 1 1 1 1\n1 1\n"), "a:2: mixed columns: this line has 6, the first one has 3"));
    CHECK(contains(refused(FileFormat::xyz, "0,0,0\n1,1,1,1\n"), "a:2: mixed columns: this line has 4, the first one has 3"));
    CHECK(contains(refused(FileFormat::csv, "x,y,z\n1,2\n"), "a:2: mixed columns: this line has 2, the first one has 3"));
    CHECK(contains(refused(FileFormat::xyz, "0 0\n"), "a:1: a point needs three numbers, this line has 2"));
    CHECK(contains(refused(FileFormat::xyz, "2\n0 0 0\n1 1 1\n"), "this line has 1; a file that begins with the number of its points is a .pts file"));
    CHECK(contains(refused(FileFormat::xyz, "0 0 x\n"), "a:1: 'x' was found where a number was expected"));
    CHECK(contains(refused(FileFormat::xyz, "0 0 0\n0,0,0\n"), "a:2: '0,0,0' was found where a number was expected"));
    CHECK(contains(refused(FileFormat::xyz, "X Y Z\n0 0 0\n"),
                   "a:1: 'X' was found where a coordinate was expected; put # before a header, or read the file as .csv"));
    CHECK(contains(refused(FileFormat::xyz, "1,5 2,5 3,5\n"),
                   "a:1: between some numbers is a ',', between others none; separate all in one way, and write decimals with a "
                   "point"));
    CHECK(contains(refused(FileFormat::xyz, "1,5;2,5;3,5\n"), "a:1: '1,5' was found where a number was expected"));
    CHECK(contains(refused(FileFormat::xyz, ",,\n"), "a:1: '' was found where a coordinate was expected"));
}

TEST_CASE("the range grid of a scan whose header was cut off is left out, and nothing else is", "[points]") {
    const std::string points = "0 0 1\n0 1 2\n1 1 3\n";
    for (const char* grid : {"0 \n1 0\n1 1 \n0\n\n0\n1 2", "1 0\n1 1\n1 2\n"}) {
        const PointCloud cloud = xyz(points + grid);
        CHECK(cloud.points == Numbers{0, 0, 1, 0, 1, 2, 1, 1, 3});
        CHECK(cloud.warnings == std::vector<std::string>{"text:4: the lines from here on are a scanner's range grid, not points; they were left out"});
    }
    const std::string grid = "1 0\n1 1\n1 2\n";
    for (const std::string& other : {std::string("1 0\n1 1\n"), std::string("1 0\n1 2\n1 1\n"), "1 1\n" + grid, grid + "1 3\n", grid + "2\n", grid + "0 0 1\n",
                                     grid + "1\n", grid + "0 0\n", grid + "1 x\n", grid + "0.0\n", grid + "1 -1\n", std::string("0\n0\n")}) {
        INFO(other);
        CHECK(contains(refused(FileFormat::xyz, points + other), "a:4: mixed columns"));
    }
    CHECK(contains(refused(FileFormat::pts, "6\n" + points + grid), "a:5: mixed columns"));
    CHECK(contains(refused(FileFormat::xyz, "0\n1 0\n"), "a:1: a point needs three numbers"));
}

TEST_CASE("counts that do not hold and files without points are refused", "[points]") {
    CHECK(refused(FileFormat::pts, "3\n0 0 0\n1 1 1\n") == "a:1: the first line says 3 points, 2 lines follow: correct the number, or the lines");
    CHECK(contains(refused(FileFormat::pts, "1\n0 0 0\n1 1 1\n"), "says 1 point, 2 lines follow"));
    CHECK(contains(refused(FileFormat::pts, "9000000000000000000\n0 0 0\n"), "says 9000000000000000000 points, 1 line follows"));
    for (const char* text : {"0 0 0\n1 1 1\n", "-1\n", "99999999999999999999\n0 0 0\n", "2.5\n0 0 0\n", "# nothing\n", "x\n"})
        CHECK(contains(refused(FileFormat::pts, text), "the first line of a .pts file is the number of its points, and nothing else"));
    CHECK(pts("0\n").count() == 0);
    CHECK(xyz("# nothing\n").count() == 0);
    for (const FileFormat format : {FileFormat::xyz, FileFormat::pts, FileFormat::csv, FileFormat::ply, FileFormat::off, FileFormat::obj})
        CHECK(refused(format, "") == "a is empty; it holds no points");
    CHECK(contains(refused(FileFormat::ply, ply_header("binary_little_endian", 2000000000, ply_coordinates)), "more than the file of"));
    CHECK(contains(refused(FileFormat::ply, ply_header("ascii", 2, "property float x\nproperty float y\n") + "0 0\n1 1\n"), "no property 'z'"));
    CHECK(contains(refused(FileFormat::off, "OFF\n2000000000 0 0\n0 0 0\n"), "more than the file of"));
}

TEST_CASE("text in many parts gives what it gives as a whole", "[points]") {
    std::string text = "# scan\n";
    for (int i = 0; i < 500; ++i) {
        for (int c = 0; c < 6; ++c) text += std::to_string(std::sin(7.0 * i + c)) + (c < 5 ? " " : i % 7 == 0 ? " # odd\r\n\n" : "\n");
    }
    std::string grid;
    for (int i = 0; i < 500; ++i) grid += "0\n1 " + std::to_string(i) + "\n";
    const std::string name = "a";
    const auto read = [&](const std::string& content, std::size_t parts) { return lcl::read_xyz({content.data(), content.size(), name, {1, parts, 0}}); };
    const auto refusal_of = [&](const std::string& content, std::size_t parts) { return error_of<lcl::BadInput>([&] { read(content, parts); }); };
    const PointCloud whole = read(text, 1);
    REQUIRE(whole.count() == 500);
    for (const std::size_t parts : {2, 3, 7, 64}) {
        const PointCloud cloud = read(text, parts);
        CHECK(same_bits(cloud.points, whole.points));
        CHECK(same_bits(cloud.normals, whole.normals));
        CHECK(read(text + grid, parts).count() == 500);
        CHECK(refusal_of(text + "1 2 3 4 5\n" + text + "x\n", parts) == refusal_of(text + "1 2 3 4 5\n" + text + "x\n", 1));
        CHECK(refusal_of(text + grid + "1 500\n" + text, parts) == refusal_of(text + grid + "1 500\n" + text, 1));
    }
}

TEST_CASE("points come from files, packed or not, and from standard input with a format", "[points]") {
    const TemporaryFolder folder;
    const std::string rows = "0 0 1\n0 1 2\n1 1 3\n";
    const Numbers expected{0, 0, 1, 0, 1, 2, 1, 1, 3};
    write_bytes(folder.file("a.xyz"), rows);
    write_bytes(folder.file("a.XYZ.gz"), compressed(rows));
    write_bytes(folder.file("packed.xyz"), compressed(rows));
    write_bytes(folder.file("a.pts.gz"), compressed("3\n" + rows));
    write_bytes(folder.file("a.csv.gz"), compressed("x y z\n" + rows));
    write_bytes(folder.file("a.ply.gz"), compressed(ply_header("ascii", 3, ply_coordinates) + rows));
    write_bytes(folder.file("a.off.gz"), compressed("OFF\n3 0 0\n" + rows));
    for (const char* name : {"a.xyz", "a.XYZ.gz", "packed.xyz", "a.pts.gz", "a.csv.gz", "a.ply.gz", "a.off.gz"}) {
        INFO(name);
        CHECK(lcl::read_points(folder.file(name)).points == expected);
    }
    write_bytes(folder.file("scan.txt"), rows);
    CHECK(lcl::read_points(folder.file("scan.txt"), FileFormat::xyz).points == expected);
    {
        const Redirection input(STDIN_FILENO, folder.file("packed.xyz"), "rb");
        CHECK(lcl::read_points("-", FileFormat::xyz).points == expected);
    }
    {
        const Redirection input(STDIN_FILENO, folder.file("a.xyz"), "rb");
        CHECK(contains(error_of<lcl::BadInput>([] { lcl::read_points("-", FileFormat::pts); }), "standard input:1: the first line of a .pts file"));
    }
    write_bytes(folder.file("false.xyz.gz"), rows);
    CHECK(contains(error_of<lcl::BadInput>([&] { lcl::read_points(folder.file("false.xyz.gz")); }), "is no gzip file"));
    write_bytes(folder.file("cut.xyz.gz"), compressed(rows).substr(0, 15));
    CHECK(contains(error_of<lcl::BadInput>([&] { lcl::read_points(folder.file("cut.xyz.gz")); }), folder.file("cut.xyz.gz")));
    CHECK(error_of<lcl::FileError>([&] { lcl::read_points(folder.file("nowhere.xyz")); }) != "no error");
    CHECK(contains(error_of<lcl::InvalidArgument>([&] { lcl::read_points("scan.txt"); }), "names no format of points"));
    CHECK(contains(error_of<lcl::InvalidArgument>([&] { lcl::read_points("scan.stl"); }), "not from .stl or .om"));
    CHECK(contains(error_of<lcl::InvalidArgument>([&] { lcl::read_points("-"); }), "standard input needs a format: ply, xyz"));
}

TEST_CASE("functions of meshes refuse the formats of points alone", "[points]") {
    bool gzip = false;
    CHECK(lcl::format_of_path("a.XYZ.gz", gzip) == FileFormat::xyz);
    CHECK(gzip);
    CHECK(lcl::format_of_path("a.csv", gzip) == FileFormat::csv);
    CHECK(lcl::format_of_path("a.Pts", gzip) == FileFormat::pts);
    CHECK(contains(error_of<lcl::InvalidArgument>([] { lcl::read_mesh("a.xyz"); }), "a.xyz: XYZ holds points, not a mesh: `limitcl surface`"));
    CHECK(contains(error_of<lcl::InvalidArgument>([] { read_text("0 0 0\n", FileFormat::pts); }), "PTS holds points, not a mesh"));
    std::vector<std::string> warnings;
    CHECK(contains(error_of<lcl::InvalidArgument>([&] { lcl::write_mesh("a.csv", file_of(float_triangles()), FileFormat::by_ending, warnings); }),
                   "a.csv: CSV holds points, not a mesh"));
}

TEST_CASE("clouds that others made are read with the counts that are known of them", "[points][collection]") {
    const char* folder = std::getenv("LIMITCL_MESHES");
    if (!folder) {
        WARN("LIMITCL_MESHES names no folder of meshes; nothing was read");
        return;
    }
    std::ifstream index(std::string(folder) + "/INDEX.tsv");
    std::size_t read = 0;
    for (std::string line; std::getline(index, line);) {
        std::vector<std::string> cells;
        std::istringstream stream(line);
        for (std::string cell; std::getline(stream, cell, '\t');) cells.push_back(cell);
        const std::string& name = cells[0];
        const bool is_cloud = name.rfind("points/", 0) == 0 || (name.rfind("syntax/", 0) == 0 && contains(name, "point")) || contains(name, ".xyz");
        if (!is_cloud) continue;
        INFO(name);
        ++read;
        const std::string path = std::string(folder) + "/" + name;
        if (contains(name, "float_inf")) {
            CHECK(contains(error_of<lcl::BadInput>([&] { lcl::read_points(path); }), path + ": point 0 is not finite, nor are 2 more"));
            continue;
        }
        const PointCloud cloud = lcl::read_points(path);
        CHECK(std::to_string(cloud.count()) == cells[3]);
        const bool has_only_zeros = contains(name, "blobby") || contains(name, "ply_points_bin");
        CHECK(cloud.normals.empty() == (!contains(line, "with-normals") || has_only_zeros || contains(name, "agisoft")));
        CHECK(cloud.colours.empty() == !(contains(name, "b9_training") || contains(name, "agisoft")));
    }
    CHECK(read >= 25);
}
