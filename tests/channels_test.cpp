// SPDX-License-Identifier: BSD-3-Clause
// How a caller's values lie in fields: blocks of channels, centred and scaled, in the plan's order; and their way to the device and back.
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/solver_support.h"

using namespace lcl;
using namespace solver_test;

namespace {

Plan grid_plan() { return Prepared(shapes::with_isolated_vertex(shapes::grid_quads(4, 4), 3)).plan(catmull_clark()); }

std::vector<double> numbers(std::size_t count) {
    std::vector<double> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = std::sin(1.7 * static_cast<double>(i)) + static_cast<double>(i % 3);
    return values;
}

/// Largest difference after a round trip of some rows through the device.
double round_trip_error(const std::shared_ptr<Context>& context, Index rows, int channels, Real real) {
    Field field(context, rows, channels, real);
    const std::vector<double> values = numbers(static_cast<std::size_t>(rows) * channels);
    field.upload(values.data(), 0, rows);
    std::vector<double> back(values.size(), -7);
    field.download(back.data(), 0, rows);
    double worst = 0;
    for (std::size_t i = 0; i < values.size(); ++i) worst = std::max(worst, std::abs(values[i] - back[i]));
    return worst;
}

}  // namespace

TEST_CASE("the position has a block of its own, further channels follow in eights", "[channels]") {
    for (int channels = 1; channels <= 21; ++channels) {
        INFO(channels);
        const auto blocks = channel_blocks(channels);
        int next = 0;
        for (std::size_t b = 0; b < blocks.size(); ++b) {
            CHECK(blocks[b].first == next);
            CHECK(blocks[b].count == std::min(channels - next, b == 0 ? 3 : 8));
            CHECK((blocks[b].width == 1 || blocks[b].width == 2 || blocks[b].width == 4 || blocks[b].width == 8));
            CHECK((blocks[b].width >= blocks[b].count && blocks[b].width < 2 * blocks[b].count));
            next += blocks[b].count;
        }
        CHECK(next == channels);
    }
    CHECK(channel_blocks(13).size() == 3);  // 3, 8, 2
}

TEST_CASE("positions share one scale, every further channel has its own, isolated vertices do not count", "[channels]") {
    const Plan plan = grid_plan();
    std::vector<double> values(plan.vertex_count * 5);
    for (Index v = 0; v < plan.vertex_count; ++v) {
        const double t = v == 3 ? 1000 : static_cast<double>(v) / (plan.vertex_count - 1);  // 3 is isolated and far away
        const double row[] = {10 + 3 * t, -4 * t, 7, 100 * t, 5};
        std::copy_n(row, 5, &values[5 * v]);
    }
    const Transform transform = fit_transform(plan, values.data(), 5, 5);
    CHECK(transform.centre[0] == Approx(11.5));
    CHECK(transform.centre[1] == Approx(-2));
    CHECK(transform.centre[2] == 7);
    for (int c = 0; c < 3; ++c) CHECK(transform.scale[c] == Approx(1.0 / 5));  // the diagonal of 3 x 4 x 0
    CHECK(transform.scale[3] == Approx(1.0 / 100));
    CHECK(transform.scale[4] == 1);  // a constant
    const std::vector<double> stored = to_plan_order(plan, transform, values.data(), 5, 5);
    CHECK(stored[0] == Approx((3010 - 11.5) / 5));  // row 0 is the isolated vertex
    double largest_value = 0;
    for (std::size_t i = 5; i < stored.size(); ++i) largest_value = std::max(largest_value, std::abs(stored[i]));
    CHECK(largest_value <= 0.5 + 1e-15);
    values[15] = 1e300;
    const std::vector<double> cut = to_plan_order(plan, fit_transform(plan, values.data(), 5, 5), values.data(), 5, 5);
    CHECK(static_cast<float>(cut[0]) == 1e37f);  // and no infinity
}

TEST_CASE("the way to the plan's order and back gives the values again, with any stride", "[channels]") {
    const Plan plan = grid_plan();
    for (const double offset : {0.0, 1e6, -1e9}) {
        std::vector<double> values = numbers(plan.vertex_count * 7);
        for (double& value : values) value += offset;
        const Transform transform = fit_transform(plan, values.data(), 7, 4);
        const std::vector<double> stored = to_plan_order(plan, transform, values.data(), 7, 4);
        std::vector<double> back(plan.vertex_count * 5, -3);
        from_plan_order(plan, transform, stored, 4, back.data(), 5);
        for (Index v = 0; v < plan.vertex_count; ++v)
            for (int c = 0; c < 5; ++c) {
                const bool written = c < 4;
                CHECK(back[5 * v + c] == Approx(written ? values[7 * v + c] : -3).epsilon(4e-16).margin(1e-15));
            }
    }
}

TEST_CASE("values that cannot be scaled are refused", "[channels][refused]") {
    const Plan plan = grid_plan();
    std::vector<double> values(plan.vertex_count, 1.0);
    for (const double bad : {std::nan(""), HUGE_VAL, 1.7e308}) {
        values[5] = bad;
        values[6] = -1.7e308;
        CHECK_THROWS_AS(fit_transform(plan, values.data(), 1, 1), BadInput);
    }
}

TEST_CASE("fields hold floats, doubles or pairs, in every number of channels", "[channels][field]") {
    const auto& context = device_context();
    for (const int channels : {1, 2, 3, 4, 5, 7, 8, 9}) {
        INFO(channels);
        CHECK(round_trip_error(context, 1001, channels, Real::single) <= std::ldexp(1, -23));  // half an ulp of values from 2 to 4
        if (context->device().has_double) {
            CHECK(round_trip_error(context, 1001, channels, Real::wide) == 0);
            CHECK(round_trip_error(context, 1001, channels, Real::full) == 0);
        }
        CHECK(round_trip_error(context_without_double(), 1001, channels, Real::wide) <= 4 * std::ldexp(1, -49));
    }
}

TEST_CASE("transfers in pieces and of ranges touch what they should", "[channels][field]") {
    CHECK(round_trip_error(device_context(), 300001, 5, Real::single) <= std::ldexp(1, -23));  // three pieces a block
    Field field(device_context(), 100, 4, Real::single);
    field.fill_zero();
    const std::vector<double> ones(4 * 10, 1.0);
    field.upload(ones.data(), 35, 10);
    std::vector<double> all(400, -1);
    field.download(all.data(), 0, 100);
    for (std::size_t i = 0; i < all.size(); ++i) CHECK(all[i] == (i / 4 >= 35 && i / 4 < 45 ? 1 : 0));
    Field copy(device_context(), 100, 4, Real::single);
    copy.copy_from(field);
    std::vector<double> part(4 * 3, -1);
    copy.download(part.data(), 43, 3);
    CHECK(part == std::vector<double>{1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0});
}

TEST_CASE("double fields are refused where there is no double, with the way out", "[channels][field][refused]") {
    CHECK_THROWS_WITH(Field(context_without_double(), 10, 3, Real::full), Catch::Contains("has none: use mixed precision"));
}
