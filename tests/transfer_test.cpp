// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <type_traits>

#include "tests/device_support.h"

using device_test::Layout;
using lcl::Buffer;
using lcl::Context;

namespace {

template <class Real_, class Source_>
struct Types {
    using Real = Real_;
    using Source = Source_;
    using Wide = std::conditional_t<std::is_same_v<Real, double> || std::is_same_v<Source, double>, double, float>;
    static bool needs_double() { return std::is_same_v<Wide, double>; }
};

template <class T>
const char* name_of() {
    return std::is_same_v<T, double> ? "double" : "float";
}

/// A caller's array with what surrounds it, the order of its rows, and the centre and scale of each channel.
template <class T>
struct Case {
    std::size_t count, width;
    Layout layout;
    std::vector<typename T::Source> array;
    std::vector<cl_int> order;
    std::vector<typename T::Wide> frame;

    std::size_t place(std::size_t row, std::size_t k) const { return layout.offset + static_cast<std::size_t>(order[row]) * layout.stride + layout.first + k; }
    bool has(std::size_t k) const { return k < layout.channels; }
};

template <class T>
Case<T> make_case(std::size_t count, std::size_t width, const Layout& layout) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> coordinate(-3, 3);
    Case<T> made{count, width, layout, {}, std::vector<cl_int>(count), {}};
    made.array.resize(layout.offset + count * layout.stride + 11);
    for (auto& value : made.array) value = static_cast<typename T::Source>(1e3 + coordinate(random));
    std::iota(made.order.begin(), made.order.end(), 0);
    std::shuffle(made.order.begin(), made.order.end(), random);
    // Scales are powers of two, so that multiplying by them rounds nothing and the results below are exact, with or without fused multiply-add.
    const double scales[] = {0.25, 1, 8, 0.5};
    for (std::size_t k = 0; k < width; ++k) made.frame.push_back(static_cast<typename T::Wide>(1e3 + coordinate(random)));
    for (std::size_t k = 0; k < width; ++k) made.frame.push_back(static_cast<typename T::Wide>(scales[k]));
    for (std::size_t k = 0; k < width; ++k) made.frame.push_back(static_cast<typename T::Wide>(1 / scales[k]));
    return made;
}

template <class T>
std::vector<typename T::Real> plain_import(const Case<T>& c) {
    std::vector<typename T::Real> rows(c.count * c.width, 0);
    for (std::size_t i = 0; i < c.count; ++i) {
        for (std::size_t k = 0; k < c.width && c.has(k); ++k) {
            const typename T::Wide difference = static_cast<typename T::Wide>(c.array[c.place(i, k)]) - c.frame[k];
            rows[i * c.width + k] = static_cast<typename T::Real>(difference * c.frame[c.width + k]);
        }
    }
    return rows;
}

template <class T>
void plain_export(const Case<T>& c, const std::vector<typename T::Real>& rows, std::vector<typename T::Source>& target) {
    for (std::size_t i = 0; i < c.count; ++i) {
        for (std::size_t k = 0; k < c.width && c.has(k); ++k) {
            const typename T::Wide scaled = static_cast<typename T::Wide>(rows[i * c.width + k]) * c.frame[2 * c.width + k];
            target[c.place(i, k)] = static_cast<typename T::Source>(scaled + c.frame[k]);
        }
    }
}

template <class T>
void check_round_trip(const std::shared_ptr<Context>& context, const Case<T>& c) {
    const std::string options = std::string("-D LCL_REAL=") + name_of<typename T::Real>() + " -D LCL_SOURCE=" + name_of<typename T::Source>() +
                                " -D LCL_WIDTH=" + std::to_string(c.width);
    INFO(options << ", " << c.count << " rows, stride " << c.layout.stride << ", offset " << c.layout.offset << ", channels " << c.layout.first << " + "
                 << c.layout.channels);
    const Buffer order = device_test::upload(context, c.order, "order"), frame = device_test::upload(context, c.frame, "frame");
    const Buffer source = device_test::upload(context, c.array, "source");
    const std::vector<typename T::Real> expected_rows = plain_import(c);
    std::vector<typename T::Real> found_rows(expected_rows.size(), 77);
    const Buffer rows = device_test::upload(context, found_rows, "rows");

    device_test::transfer(*context, context->kernel("transfer", "lcl_import_points", options), c.count, c.layout, order, frame, source, rows);
    context->read(rows, 0, rows.bytes(), found_rows.data(), "reading rows");
    CHECK(found_rows == expected_rows);

    std::vector<typename T::Source> expected(c.array.size(), -5), found(c.array.size(), -5);
    plain_export(c, expected_rows, expected);
    const Buffer target = device_test::upload(context, found, "target");
    device_test::transfer(*context, context->kernel("transfer", "lcl_export_points", options), c.count, c.layout, order, frame, rows, target);
    context->read(target, 0, target.bytes(), found.data(), "reading the target");
    CHECK(found == expected);  // what is not a taken channel keeps its -5

    // Back and forth: the row, at most 6 in size before its scale, rounds to Real, and the sum, about 1003, to Source.
    const double eps = std::max<double>(std::numeric_limits<typename T::Real>::epsilon() / 100, std::numeric_limits<typename T::Source>::epsilon());
    for (std::size_t i = 0; i < c.count; ++i) {
        for (std::size_t k = 0; k < c.width && c.has(k); ++k) REQUIRE(std::abs(double(found[c.place(i, k)]) - double(c.array[c.place(i, k)])) <= 1024 * eps);
    }
}

using AllTypes = std::tuple<Types<float, float>, Types<float, double>, Types<double, float>, Types<double, double>>;

}  // namespace

TEMPLATE_LIST_TEST_CASE("import and export meet the plain loop exactly", "[device][transfer][tiny]", AllTypes) {
    const lcl::DeviceInfo device = lcl::choose_device();
    if (TestType::needs_double() && !device.has_double) return;
    const auto context = Context::create(device);
    for (const std::size_t width : {1, 2, 4}) {
        const cl_uint full = static_cast<cl_uint>(width);
        for (const std::size_t count : {1, 63, 64, 1000}) {
            check_round_trip(context, make_case<TestType>(count, width, {full, 0, 0, full}));
            check_round_trip(context, make_case<TestType>(count, width, {9, 5, 3, full}));
        }
        check_round_trip(context, make_case<TestType>(65, width, {7, 1, 6, 1}));
    }
    check_round_trip(context, make_case<TestType>(65, 4, {3, 2, 0, 3}));
    check_round_trip(context, make_case<TestType>(65, 4, {6, 2, 4, 2}));
}

TEST_CASE("a double model far from the origin arrives in float rows as finely as one at the origin", "[device][transfer][tiny]") {
    const lcl::DeviceInfo device = lcl::choose_device();
    if (!device.has_double) return;
    const auto context = Context::create(device);
    Case<Types<float, double>> far = make_case<Types<float, double>>(100, 4, {3, 0, 0, 3});
    std::fill_n(far.frame.begin(), 4, 1e6);
    for (std::size_t i = 0; i < far.array.size(); ++i) far.array[i] = 1e6 + static_cast<double>(i) / 1024;  // exact in double, not in float
    const std::vector<float> rows = plain_import(far);
    for (std::size_t i = 0; i < far.count; ++i) REQUIRE(rows[i * 4] == static_cast<float>(far.order[i] * 3) / 1024 * static_cast<float>(far.frame[4]));
    check_round_trip(context, far);
    std::vector<double> back(far.array.size(), 0);
    plain_export(far, rows, back);
    for (std::size_t i = 0; i < far.count * 3; ++i) REQUIRE(back[i] == far.array[i]);
}
