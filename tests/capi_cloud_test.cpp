// SPDX-License-Identifier: BSD-3-Clause
// The C API's clouds: made from arrays and from text, and what they refuse. The formats have tests of their own: points_file_test.cpp.
#include <limits>

#include "tests/capi_support.h"

using namespace capi_test;

namespace {

using Cloud = Owned<lcl_cloud>;

const double points[] = {0, 0, 1, -9, 1, 0, 2, -9, 0.5, 1, 3, -9}, normals[] = {0, 0, 2, 0, 1, 0, 1, 0, 0};

Cloud cloud_of_text(const std::string& text, lcl_format format = LCL_FORMAT_XYZ) {
    lcl_cloud cloud = nullptr;
    succeed(lcl_cloud_read_memory(text.data(), text.size(), format, nullptr, &cloud));
    return Cloud(cloud);
}

}  // namespace

TEST_CASE("a cloud gives back the points and normals that it was made from", "[capi][cloud]") {
    lcl_cloud raw = nullptr;
    succeed(lcl_cloud_create(3, points, 4, normals, 0, &raw));
    const Cloud cloud(raw);
    CHECK(lcl_cloud_count(raw) == 3);
    CHECK(lcl_cloud_has_normals(raw) == 1);
    CHECK(lcl_cloud_has_colours(raw) == 0);
    CHECK(lcl_cloud_note_count(raw) == 0);
    std::vector<double> p(9), n(9);
    succeed(lcl_cloud_get(raw, p.data(), n.data(), nullptr));
    CHECK(p == std::vector<double>{0, 0, 1, 1, 0, 2, 0.5, 1, 3});
    CHECK(n == std::vector<double>(normals, normals + 9));
    succeed(lcl_cloud_get(raw, nullptr, nullptr, nullptr));
    refuse(lcl_cloud_get(raw, nullptr, nullptr, p.data()), LCL_ERROR_INVALID_ARGUMENT, "the cloud has no colours");

    lcl_cloud_retain(raw);
    lcl_cloud_release(raw);
    CHECK(lcl_cloud_count(raw) == 3);  // the first reference is still there
    lcl_cloud empty = nullptr;
    succeed(lcl_cloud_create(0, nullptr, 0, nullptr, 0, &empty));
    const Cloud owner(empty);
    CHECK(lcl_cloud_count(empty) == 0);
}

TEST_CASE("a cloud is read from memory and from a file, with notes", "[capi][cloud]") {
    const Cloud cloud = cloud_of_text("0 0 1 255 0 51 7\n1 2 3 0 102 0 8\n");
    CHECK(lcl_cloud_count(cloud.get()) == 2);
    CHECK(lcl_cloud_has_normals(cloud.get()) == 0);
    REQUIRE(lcl_cloud_has_colours(cloud.get()) == 1);
    std::vector<double> p(6), colours(6);
    succeed(lcl_cloud_get(cloud.get(), p.data(), nullptr, colours.data()));
    CHECK(p == std::vector<double>{0, 0, 1, 1, 2, 3});
    CHECK(lcl_cloud_note_count(cloud.get()) == 1);
    CHECK(contains(lcl_cloud_note(cloud.get(), 0), "was left out"));
    CHECK(lcl_cloud_note(cloud.get(), 1) == nullptr);
    CHECK(lcl_cloud_note(cloud.get(), -1) == nullptr);
    refuse(lcl_cloud_get(cloud.get(), nullptr, p.data(), nullptr), LCL_ERROR_INVALID_ARGUMENT, "the cloud has no normals");

    lcl_cloud raw = nullptr;
    refuse(lcl_cloud_read_memory("0 0 x", 5, LCL_FORMAT_XYZ, "scan", &raw), LCL_ERROR_BAD_INPUT, "scan:1: 'x'");
    refuse(lcl_cloud_read_memory("0 0 x", 5, LCL_FORMAT_XYZ, nullptr, &raw), LCL_ERROR_BAD_INPUT, "memory:1: 'x'");
    refuse(lcl_cloud_read_memory("0 0 1\n0 nan 1\ninf 0 0", 21, LCL_FORMAT_XYZ, "scan", &raw), LCL_ERROR_BAD_INPUT,
           "scan:2: the point is not finite, nor is 1 more");
    CHECK(last_error_vertices() == std::vector<int32_t>{1, 2});
    refuse(lcl_cloud_read("/nowhere/a.xyz", LCL_FORMAT_BY_ENDING, &raw), LCL_ERROR_FILE, "/nowhere/a.xyz");
    CHECK(raw == nullptr);
}

TEST_CASE("a cloud refuses what it cannot be made from", "[capi][cloud]") {
    lcl_cloud raw = nullptr;
    double bad[9] = {0, 0, 1, 1, 0, 2, 0.5, 1, 3};
    refuse(lcl_cloud_create(3, nullptr, 0, nullptr, 0, &raw), LCL_ERROR_INVALID_ARGUMENT, "points is NULL");
    refuse(lcl_cloud_create(3, points, 0, nullptr, 0, nullptr), LCL_ERROR_INVALID_ARGUMENT, "cloud is NULL");
    refuse(lcl_cloud_create(3, points, 2, nullptr, 0, &raw), LCL_ERROR_INVALID_ARGUMENT, "stride is 2");
    refuse(lcl_cloud_create(3, points, 0, normals, 1, &raw), LCL_ERROR_INVALID_ARGUMENT, "normal_stride is 1");
    refuse(lcl_cloud_create(std::size_t(1) << 31, points, 0, nullptr, 0, &raw), LCL_ERROR_INVALID_ARGUMENT, "at most 2147483647 points");
    bad[4] = std::numeric_limits<double>::infinity();
    refuse(lcl_cloud_create(3, bad, 0, nullptr, 0, &raw), LCL_ERROR_BAD_INPUT, "point 1 is not finite: correct it or leave it out");
    CHECK(last_error_vertices() == std::vector<int32_t>{1});
    refuse(lcl_cloud_create(3, points, 4, bad, 0, &raw), LCL_ERROR_BAD_INPUT, "the normal of point 1 is zero or not finite (1 of 3)");
    bad[4] = bad[3] = bad[5] = 0;
    refuse(lcl_cloud_create(3, points, 4, bad, 0, &raw), LCL_ERROR_BAD_INPUT, "the normal of point 1 is zero or not finite (1 of 3)");
    refuse(lcl_cloud_read("a.xyz", static_cast<lcl_format>(9), &raw), LCL_ERROR_INVALID_ARGUMENT, "format is 9");
    refuse(lcl_cloud_read("a.stl", LCL_FORMAT_BY_ENDING, &raw), LCL_ERROR_INVALID_ARGUMENT, "not from .stl or .om");
    refuse(lcl_cloud_read("a.xyz", LCL_FORMAT_OM, &raw), LCL_ERROR_INVALID_ARGUMENT, "not from .stl or .om");
    refuse(lcl_cloud_read("-", LCL_FORMAT_BY_ENDING, &raw), LCL_ERROR_INVALID_ARGUMENT, "standard input needs a format");
    refuse(lcl_cloud_read(nullptr, LCL_FORMAT_XYZ, &raw), LCL_ERROR_INVALID_ARGUMENT, "path is NULL");
    refuse(lcl_cloud_read_memory(nullptr, 3, LCL_FORMAT_XYZ, "a", &raw), LCL_ERROR_INVALID_ARGUMENT, "bytes is NULL");
    refuse(lcl_cloud_read_memory(nullptr, 0, LCL_FORMAT_XYZ, "a", &raw), LCL_ERROR_BAD_INPUT, "a is empty");
    refuse(lcl_cloud_get(nullptr, nullptr, nullptr, nullptr), LCL_ERROR_INVALID_ARGUMENT, "cloud is NULL");
    CHECK(raw == nullptr);
    lcl_cloud_retain(nullptr);
    lcl_cloud_release(nullptr);
    CHECK(lcl_cloud_count(nullptr) == 0);
    CHECK(lcl_cloud_has_normals(nullptr) == 0);
    CHECK(lcl_cloud_has_colours(nullptr) == 0);
    CHECK(lcl_cloud_note_count(nullptr) == 0);
    CHECK(lcl_cloud_note(nullptr, 0) == nullptr);
    lcl_format format = LCL_FORMAT_BY_ENDING;
    succeed(lcl_format_of_path("a.PTS.gz", &format));
    CHECK(format == LCL_FORMAT_PTS);
    lcl_mesh mesh = nullptr;
    refuse(lcl_mesh_read("a.csv", LCL_FORMAT_BY_ENDING, &mesh), LCL_ERROR_INVALID_ARGUMENT, "CSV holds points, not a mesh");
}
