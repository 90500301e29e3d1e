// SPDX-License-Identifier: BSD-3-Clause
// Loops over all cores, and the set-up of an operator that is made of them.
#include <numeric>
#include <set>
#include <stdexcept>

#include <catch2/catch.hpp>

#include "host/counting_sort.h"
#include "host/field/host_rows.h"
#include "tests/solver_support.h"

using namespace lcl;
using namespace solver_test;

TEST_CASE("pieces cover a range once and in order, however many they are", "[parallel][thread]") {
    for (const std::size_t count : {0, 1, 7, 1000})
        for (const std::size_t pieces : {1, 2, 3, 8}) {
            CAPTURE(count, pieces);
            std::vector<std::pair<std::size_t, std::size_t>> ranges(pieces);
            for_each_piece(count, pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) { ranges[piece] = {begin, end}; });
            std::size_t next = 0;
            for (const auto& [begin, end] : ranges) {
                CHECK(begin == next);
                next = end;
            }
            CHECK(next == count);
        }
    CHECK(piece_count(0) == 1);
    CHECK(piece_count(smallest_parallel_piece) == 1);
    CHECK(piece_count(3, 1) <= 3);
}

TEST_CASE("the first piece's exception comes out of a loop, after all pieces have ended", "[parallel][thread]") {
    std::vector<int> ended(4, 0);
    const auto body = [&](std::size_t piece, std::size_t, std::size_t) {
        ended[piece] = 1;
        if (piece > 0) throw std::runtime_error("piece " + std::to_string(piece));
    };
    CHECK_THROWS_WITH(for_each_piece(100, 4, body), "piece 1");
    CHECK(ended == std::vector<int>(4, 1));
}

TEST_CASE("places of a counting sort are stable over pieces", "[parallel][thread]") {
    const std::size_t pieces = 3, buckets = 40000;
    Array<Index> counts(pieces * buckets), starts(buckets + 1);
    for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = static_cast<Index>(i * 7919 % 5);
    const Array<Index> before = counts;
    counts_to_places(counts, buckets, pieces, starts.data());
    Index place = 0;
    bool same = true;
    for (std::size_t b = 0; b < buckets; ++b) {
        same = same && starts[b] == place;
        for (std::size_t piece = 0; piece < pieces; ++piece) {
            same = same && counts[piece * buckets + b] == place;
            place += before[piece * buckets + b];
        }
    }
    CHECK(same);
    CHECK(starts[buckets] == place);
}

TEST_CASE("an array's new numbers are left unset, given ones are not", "[parallel]") {
    Array<Index> numbers(1 << 20);  // large enough to ask for large pages
    std::iota(numbers.begin(), numbers.end(), 0);
    numbers.resize(2 << 20, 7);
    CHECK(numbers[(1 << 20) - 1] == (1 << 20) - 1);
    CHECK(numbers[1 << 20] == 7);
    CHECK(numbers.back() == 7);
    const Array<Index> copy = numbers;
    CHECK(copy == numbers);
}

TEST_CASE("topology, features, plan and fields of large meshes are set up by several threads", "[parallel][thread]") {
    auto creased = shapes::with_isolated_vertex(shapes::grid_quads(220, 200), 12345);
    creased.features.crease_angle_degrees = 60;
    for (const auto& shape : {shapes::torus_quads(230, 200), creased, shapes::polygons_mixed(36000, 8)}) {
        CAPTURE(shape.name);
        const Prepared mesh(shape);
        const auto system = mesh.system(device_context(), catmull_clark());
        const Plan& plan = system->plan();
        Field field = system->A->make_field(3, Real::single);
        const HostRows rows{shape.mesh.positions.data(), 3};
        const Transform transform = transform_of_ranges(plan, value_ranges(plan, rows, 3));
        upload_rows(plan, transform, rows, field);
        std::vector<double> back(shape.mesh.positions.size());
        download_rows(plan, transform, field, {back.data(), 3});
        double worst = 0;
        for (std::size_t i = 0; i < back.size(); ++i) worst = std::max(worst, std::abs(back[i] - shape.mesh.positions[i]));
        CHECK(worst < 1e-6 * system->diagonal);
        CHECK(find_defects_of_sound_mesh(shape.mesh).empty());
    }
}
