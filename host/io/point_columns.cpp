// SPDX-License-Identifier: BSD-3-Clause
#include "host/io/point_columns.h"

#include <algorithm>
#include <cmath>

#include "host/parallel.h"

namespace lcl {
namespace {

constexpr double unit_tolerance = 0.01;  // components of two decimals miss length 1 by at most 0.005 sqrt 3

/// What is true of all rows, and counts of some.
struct Findings {
    bool are_bytes = true, are_fractions = true, has_above_one = false;
    std::size_t nonzero_rows = 0, unit_rows = 0;

    void look_at(const double* row) {
        double square = 0;
        for (int i = 0; i < 3; ++i) {
            const double value = row[i];
            are_bytes = are_bytes && value >= 0 && value <= 255 && value == std::floor(value);
            are_fractions = are_fractions && value >= 0 && value <= 1;
            has_above_one = has_above_one || value > 1;
            square += value * value;
        }
        nonzero_rows += square != 0;
        unit_rows += std::fabs(std::sqrt(square) - 1) <= unit_tolerance;
    }

    void add(const Findings& other) {
        are_bytes = are_bytes && other.are_bytes;
        are_fractions = are_fractions && other.are_fractions;
        has_above_one = has_above_one || other.has_above_one;
        nonzero_rows += other.nonzero_rows;
        unit_rows += other.unit_rows;
    }
};

std::vector<double> take_triples(std::vector<double>& values, std::size_t width, std::size_t first) {
    if (width == 3) return std::move(values);
    const std::size_t count = values.size() / width;
    std::vector<double> triples(3 * count);
    parallel_for_each(count, [&](std::size_t i) { std::copy_n(&values[i * width + first], 3, &triples[3 * i]); });
    return triples;
}

std::string columns_text(std::size_t first, std::size_t count) {
    return count == 1 ? "column " + std::to_string(first) : "columns " + std::to_string(first) + " to " + std::to_string(first + count - 1);
}

}  // namespace

TripleKind kind_of_triples(const double* rows, std::size_t stride, std::size_t count) {
    const std::size_t pieces = piece_count(count);
    std::vector<Findings> parts(pieces);
    for_each_piece(count, pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
        Findings found;
        for (std::size_t i = begin; i < end; ++i) found.look_at(rows + i * stride);
        parts[piece] = found;
    });
    for (std::size_t piece = 1; piece < pieces; ++piece) parts[0].add(parts[piece]);
    const Findings& all = parts[0];
    if (all.are_bytes && all.has_above_one) return TripleKind::bytes;
    if (2 * all.unit_rows > all.nonzero_rows) return TripleKind::unit_vectors;
    if (all.nonzero_rows == 0) return TripleKind::zeros;
    return all.are_fractions ? TripleKind::fractions : TripleKind::vectors;
}

void take_colours(PointCloud& cloud, std::vector<double> rows, double full) {
    if (full == 0) full = kind_of_triples(rows.data(), 3, rows.size() / 3) == TripleKind::bytes ? 255 : 1;
    const std::size_t pieces = piece_count(rows.size());
    std::vector<char> are_usable(pieces, 1);
    for_each_piece(rows.size(), pieces, [&](std::size_t piece, std::size_t begin, std::size_t end) {
        bool usable = true;
        for (std::size_t i = begin; i < end; ++i) {
            rows[i] /= full;
            usable = usable && rows[i] >= 0 && rows[i] <= 1;
        }
        are_usable[piece] = usable;
    });
    const bool usable = std::find(are_usable.begin(), are_usable.end(), 0) == are_usable.end();
    if (usable) cloud.colours = std::move(rows);
    else cloud.warnings.push_back("the colours are neither whole numbers from 0 to 255 nor numbers from 0 to 1; they were left out");
}

void take_columns(PointCloud& cloud, std::vector<double> values, std::size_t width, std::size_t columns, bool may_have_intensity) {
    const std::size_t count = cloud.count();
    if (count == 0) return;
    const auto kind_at = [&](std::size_t first) { return kind_of_triples(values.data() + first, width, count); };
    const auto is_shifted = [&] {  // x y z intensity and then triples
        const TripleKind second = kind_at(1);
        return kind_at(0) != TripleKind::unit_vectors && (second == TripleKind::bytes || second == TripleKind::unit_vectors || second == TripleKind::zeros);
    };
    std::size_t next = may_have_intensity && (columns == 7 || columns == 10) && is_shifted() ? 1 : 0;
    if (next == 1) cloud.warnings.push_back("column 4 (intensity) was left out");
    for (; next + 3 <= width; next += 3) {
        const TripleKind kind = kind_at(next);
        const bool are_colours = kind == TripleKind::bytes || kind == TripleKind::fractions;
        if (!(are_colours ? cloud.colours : cloud.normals).empty()) break;
        if (kind == TripleKind::vectors) cloud.warnings.push_back(columns_text(next + 4, 3) + " were taken as normals, although their lengths are not 1");
        std::vector<double> triples = take_triples(values, width, next);
        if (are_colours) take_colours(cloud, std::move(triples));
        else cloud.normals = std::move(triples);
    }
    const std::size_t left = columns - 3 - next;
    if (left > 0) cloud.warnings.push_back(columns_text(next + 4, left) + (left == 1 ? " was" : " were") + " left out");
}

}  // namespace lcl
