// SPDX-License-Identifier: BSD-3-Clause
// How a caller's values lie in fields: blocks of channels, centred and scaled, in the plan's order; and their way to the device and back.
#include <cmath>

#include <catch2/catch.hpp>

#include "host/field/host_rows.h"
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

TEST_CASE("channels lie in eights, the position at the beginning of the first", "[channels]") {
    for (int channels = 1; channels <= 21; ++channels) {
        INFO(channels);
        const auto blocks = channel_blocks(channels);
        int next = 0;
        for (std::size_t b = 0; b < blocks.size(); ++b) {
            CHECK(blocks[b].first == next);
            CHECK(blocks[b].count == std::min(channels - next, 8));
            CHECK(is_mixed(blocks[b]) == (b == 0 && channels > 3));
            CHECK((blocks[b].width == 1 || blocks[b].width == 2 || blocks[b].width == 4 || blocks[b].width == 8));
            CHECK((blocks[b].width >= blocks[b].count && blocks[b].width < 2 * blocks[b].count));
            next += blocks[b].count;
        }
        CHECK(next == channels);
    }
    CHECK(channel_blocks(13).size() == 2);  // 8, 5
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

TEST_CASE("ranges are those of a plain loop, isolated vertices left out, for every type, stride and number of channels", "[channels][large]") {
    const Prepared mesh(shapes::with_isolated_vertex(shapes::shuffled(shapes::torus_quads(200, 180), 3), 777));
    for (const bool with_isolated : {false, true}) {
        Plan plan = mesh.plan(catmull_clark());
        if (!with_isolated) plan.isolated_count = 0;
        for (const int channels : {1, 2, 3, 4, 5, 8}) {
            CAPTURE(channels, with_isolated);
            const std::size_t stride = channels + 2;
            std::vector<double> values = numbers(plan.vertex_count * stride);
            values[777 * stride] = -50;
            const std::vector<float> floats(values.begin(), values.end());
            for (const bool is_float : {false, true}) {
                const HostRows rows{is_float ? static_cast<const void*>(floats.data()) : values.data(), stride, is_float};
                const ValueRanges ranges = value_ranges(plan, rows, channels);
                CHECK(ranges.are_finite);
                for (int c = 0; c < channels; ++c) {
                    double low = HUGE_VAL, high = -HUGE_VAL;
                    for (Index v = 0; v < plan.vertex_count; ++v) {
                        if (with_isolated && v == 777) continue;
                        const double value = is_float ? floats[v * stride + c] : values[v * stride + c];
                        low = std::min(low, value), high = std::max(high, value);
                    }
                    CHECK(ranges.low[c] == low);
                    CHECK(ranges.high[c] == high);
                }
            }
            for (const Index v : {0, 777, plan.vertex_count - 1}) {
                std::vector<double> bad = values;
                bad[v * stride + channels - 1] = v == 0 ? HUGE_VAL : std::nan("");
                CHECK(!value_ranges(plan, {bad.data(), stride}, channels).are_finite);
                bad = values;
                bad[v * stride + channels] = HUGE_VAL;  // between the rows
                CHECK(value_ranges(plan, {bad.data(), stride}, channels).are_finite);
            }
        }
    }
}

TEST_CASE("rows go from and to a caller's memory as by way of the plan's order", "[channels][field][large]") {
    const Prepared mesh(shapes::with_isolated_vertex(shapes::shuffled(shapes::torus_quads(200, 180), 3), 777));
    const Plan plan = mesh.plan(catmull_clark());
    for (const int channels : {1, 2, 3, 4, 7})
        for (const bool is_float : {false, true}) {
            CAPTURE(channels, is_float);
            const std::size_t stride = channels + 1, count = plan.vertex_count * stride;
            std::vector<double> values = numbers(count);
            values[777 * stride] = 1e300;
            if (is_float) values[777 * stride] = 1e38;
            const std::vector<float> floats(values.begin(), values.end());
            if (is_float) values.assign(floats.begin(), floats.end());
            const Transform transform = fit_transform(plan, values.data(), stride, channels);
            const HostRows rows{is_float ? static_cast<const void*>(floats.data()) : values.data(), stride, is_float};
            for (const auto& [context, real] : {std::pair(device_context(), Real::single), std::pair(context_without_double(), Real::wide)}) {
                Field direct(context, plan.vertex_count, channels, real), plain(context, plan.vertex_count, channels, real);
                upload_rows(plan, transform, rows, direct);
                plain.upload(to_plan_order(plan, transform, values.data(), stride, channels).data(), 0, plan.vertex_count);
                std::vector<double> a(plan.vertex_count * static_cast<std::size_t>(channels)), b = a;
                direct.download(a.data(), 0, plan.vertex_count);
                plain.download(b.data(), 0, plan.vertex_count);
                CHECK(a == b);
                std::vector<double> back(count, -3), plain_back(count, -3);
                std::vector<float> float_back(count, -3);
                from_plan_order(plan, transform, a, channels, plain_back.data(), stride);
                download_rows(plan, transform, direct, {is_float ? static_cast<void*>(float_back.data()) : back.data(), stride, is_float});
                if (is_float) CHECK(float_back == std::vector<float>(plain_back.begin(), plain_back.end()));
                else CHECK(back == plain_back);
            }
        }
}

TEST_CASE("mapped and staged transfers carry the same bytes", "[channels][field]") {
    for (const auto& [first, count] : {std::pair(0, 300001), std::pair(1234, 131073), std::pair(9, 0)})
        for (const auto write : {Field::Way::mapped, Field::Way::staged})
            for (const auto read : {Field::Way::mapped, Field::Way::staged}) {
                CAPTURE(first, count, static_cast<int>(write), static_cast<int>(read));
                Field field(device_context(), 300001, 11, Real::single);
                field.fill_zero();
                const auto value = [](std::size_t block, std::size_t row, int c) { return static_cast<float>(block * 1000003 + row * 4 + c); };
                const auto width = [&](std::size_t block) { return field.blocks()[block].width; };
                field.write(
                    first, count,
                    [&](std::size_t block, std::size_t begin, std::size_t rows, void* out) {
                        for (std::size_t i = 0; i < rows; ++i)
                            for (int c = 0; c < width(block); ++c) static_cast<float*>(out)[i * width(block) + c] = value(block, first + begin + i, c);
                    },
                    write);
                std::size_t wrong = 0, seen = 0;
                field.read(
                    0, 300001,
                    [&](std::size_t block, std::size_t begin, std::size_t rows, const void* in) {
                        seen += rows;
                        for (std::size_t row = begin; row < begin + rows; ++row)
                            for (int c = 0; c < width(block); ++c) {
                                const bool is_written = row >= static_cast<std::size_t>(first) && row < static_cast<std::size_t>(first + count);
                                wrong += static_cast<const float*>(in)[(row - begin) * width(block) + c] != (is_written ? value(block, row, c) : 0.0f);
                            }
                    },
                    read);
                CHECK(wrong == 0);
                CHECK(seen == 2 * 300001);
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
