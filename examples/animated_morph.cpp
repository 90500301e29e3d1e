// SPDX-License-Identifier: BSD-3-Clause
// C++17: a ring morphs to a flower and back, frame by frame. Both shapes go to the device once; every frame is made there from the one before, by
// Q_(k + 1) = M + rho D (Q_k - M), and only what is to be shown comes back.
#include <limitcl/limitcl.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace {

constexpr int ring = 96, tube = 32, frames = 24, m = 2;
constexpr double rho = 0.7;

std::vector<double> make_points(double petals) {
    std::vector<double> points;
    for (int i = 0; i < ring; ++i)
        for (int j = 0; j < tube; ++j) {
            const double u = 6.283185307179586 * i / ring, w = 6.283185307179586 * j / tube, middle = 3 + petals * std::sin(5 * u);
            points.insert(points.end(), {(middle + std::cos(w)) * std::cos(u), (middle + std::cos(w)) * std::sin(u), (1 + petals) * std::sin(w)});
        }
    return points;
}

limitcl::Mesh make_ring(const std::vector<double>& points) {
    std::vector<std::int32_t> quads;
    for (int i = 0; i < ring; ++i)
        for (int j = 0; j < tube; ++j) {
            const int next_i = (i + 1) % ring, next_j = (j + 1) % tube;
            quads.insert(quads.end(), {i * tube + j, next_i * tube + j, next_i * tube + next_j, i * tube + next_j});
        }
    return limitcl::Mesh::from_uniform_faces(points, 4, quads);
}

template <class Value>
double largest_difference(const std::vector<Value>& a, const std::vector<double>& b) {
    double largest = 0;
    for (std::size_t i = 0; i < b.size(); ++i) largest = std::max(largest, std::abs(static_cast<double>(a[i]) - b[i]));
    return largest;
}

// The same frames through host memory, in double.
std::vector<std::vector<double>> frames_on_host(const limitcl::LimitOperator& A, const std::vector<double>& from, const std::vector<double>& to) {
    limitcl::MorphOptions options;
    options.frames = frames;
    options.m = {m};
    options.rho = {rho};
    std::vector<std::vector<double>> all;
    limitcl::morph(A, from, to, 3, options, [&](int, double* points) {
        all.emplace_back(points, points + from.size());
        return true;
    });
    return all;
}

}  // namespace

int main() {
    try {
        const std::vector<double> circle = make_points(0), flower = make_points(0.8);
        const limitcl::Context context;
        const limitcl::LimitOperator A(context, make_ring(circle));
        limitcl::Field first(A), second(A), difference(A), frame(A);  // floats
        first.upload(flower);
        second.match(first);  // both in one centre and scale, so that they can be subtracted
        second.upload(circle);

        std::vector<float> shown(circle.size());
        const std::vector<std::vector<double>> expected = frames_on_host(A, flower, circle);
        double error = 0;
        limitcl::subtract(first, second, difference);
        for (int k = 1; k <= frames; ++k) {
            limitcl::morph(A, m, rho, second, difference, frame);  // returns at once
            frame.download(shown.data());                          // waits; a renderer on the same device needs no copy
            error = std::max(error, largest_difference(shown, expected[static_cast<std::size_t>(k)]));
        }
        const double there = largest_difference(shown, circle);
        limitcl::subtract(frame, first, difference);  // and back, from where it is
        for (int k = 1; k <= frames; ++k) limitcl::morph(A, m, rho, first, difference, frame);
        const double back = largest_difference(frame.download(), flower), apart = largest_difference(flower, circle);
        std::printf("%d vertices, shapes %.2f apart: %d frames end %.1e from the ring, %d more %.1e from the flower\n", A.vertex_count(), apart, frames, there,
                    frames, back);
        std::printf("frames on the device differ from those on the host by at most %.1e\n", error);
        // Floats hold these coordinates to 2e-7, and differences fade from frame to frame, with the rounding in them.
        return error <= 5e-6 && there <= 0.01 * apart && back <= 0.01 * apart ? 0 : 1;
    } catch (const limitcl::Error& error) {
        std::fprintf(stderr, "%s: %s\n", error.status_name(), error.what());
        return 1;
    }
}
