// SPDX-License-Identifier: BSD-3-Clause
#include "host/points/least_squares.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "host/error.h"
#include "host/evaluate/closest.h"
#include "host/points/fit_system.h"
#include "host/points/stopwatch.h"

namespace lcl {
namespace {

constexpr double smallest_change = 1e-3;  // of the root mean square, in a correction
constexpr double solve_tolerance = 1e-4;  // of what the residual is where a correction begins: the next one goes on from there
constexpr int most_iterations = 200;      // of conjugate gradients in a correction

// Weight of distances along the surface: where it begins and how it goes down. At 1e-6 what is left to do shrinks by about that factor in a correction.
constexpr double first_along = 1e-2, smallest_along = 1e-6, along_factor = 0.1;

/// A surface that was measured: its closest points.
struct Candidate {
    std::vector<double> control, distances, uv, normals;
    std::vector<Index> faces, corners;
    double rms = 0, objective = 0;  ///< sum of both terms

    Places places() const { return {distances.size(), faces.data(), corners.data(), uv.data()}; }
};

class Fit {
public:
    Fit(DeviceSurface& surface, const std::vector<double>& points, const LeastSquaresOptions& options)
        : surface_(surface), points_(points), options_(options), closest_(points.size()) {}

    LeastSquaresFit run(std::vector<double> control) {
        surface_.set_points(control.data(), 3);
        origin_ = surface_.centre();
        {
            const Stopwatch watch(result_.seconds_solve);
            system_ = std::make_unique<FitSystem>(surface_.table(), options_.fair);
        }
        best_.control = std::move(control);
        measure(best_, nullptr);
        correct();
        surface_.set_points(best_.control.data(), 3);
        if (result_.corrections > 0) measure(best_, nullptr);  // what is nearest now may be another part of the surface
        result_.control = std::move(best_.control);
        result_.distances = std::move(best_.distances);
        return std::move(result_);
    }

private:
    /// As in the method of Levenberg and Marquardt distances along the surface get a weight: less after steps that lower the objective, which then goes down as
    /// fast as by Gauss and Newton, and more after others, up to 1, where every step lowers it.
    void correct() {
        double along = first_along;
        while (result_.corrections < options_.max_corrections) {
            if (options_.progress && !options_.progress(result_.corrections, *std::max_element(best_.distances.begin(), best_.distances.end())))
                throw Cancelled("the least-squares fit was cancelled after " + std::to_string(result_.corrections) + " corrections");
            Candidate next;
            next.control = solve(along);
            surface_.set_points(next.control.data(), 3);
            measure(next, &best_);
            ++result_.corrections;
            if (next.objective < best_.objective) {
                const double change = std::abs(next.rms - best_.rms);
                std::swap(best_, next);
                if (change < smallest_change * next.rms) return;
                along = std::max(smallest_along, along * along_factor);
            } else {
                if (along >= 1) return;
                along = std::min(1.0, along / (along_factor * along_factor));
            }
        }
    }

    std::vector<double> solve(double along) {
        const Stopwatch watch(result_.seconds_solve);
        system_->set_samples({best_.places(), points_.data(), best_.normals.data(), along, origin_});
        std::vector<double> control = seen_from_origin(best_.control, -1);
        result_.iterations += system_->solve(control, solve_tolerance, most_iterations);
        return seen_from_origin(std::move(control), 1);
    }

    /// Closest points and what they say of the surface's points of now; near those of `start`, or anywhere.
    void measure(Candidate& candidate, const Candidate* start) {
        const Stopwatch watch(result_.seconds_measure);
        const std::size_t count = points_.size() / 3;
        candidate.faces.resize(count);
        candidate.corners.resize(count);
        candidate.uv.resize(2 * count);
        candidate.normals.resize(3 * count);
        candidate.distances.resize(count);
        const ClosestPoints out{candidate.faces.data(), candidate.corners.data(), candidate.uv.data(),
                                closest_.data(),        candidate.normals.data(), candidate.distances.data()};
        if (start == nullptr) search_ = std::make_unique<ClosestSearch>(surface_);
        const Places places = start != nullptr ? start->places() : Places{};
        search_->find(points_.data(), 3, count, out, start != nullptr ? &places : nullptr);
        double sum = 0;
        for (std::size_t i = 0; i < count; ++i) sum += settle(candidate, i);
        candidate.rms = std::sqrt(sum / static_cast<double>(count));
        candidate.objective = sum / static_cast<double>(count) + options_.fair * system_->energy(seen_from_origin(candidate.control, -1));
    }

    /// Takes the sign off a distance, and the normal from a point whose way to the surface is not along it: that lies beyond the boundary, where the surface
    /// would slide away from it. Returns the square of the distance.
    double settle(Candidate& candidate, std::size_t i) const {
        double& distance = candidate.distances[i];
        distance = std::abs(distance);
        double along_normal = 0;
        for (std::size_t c = 0; c < 3; ++c) along_normal += candidate.normals[3 * i + c] * (points_[3 * i + c] - closest_[3 * i + c]);
        if (std::abs(along_normal) < 0.9 * distance && distance > 1e-6 * surface_.size()) candidate.normals[3 * i] = std::numeric_limits<double>::quiet_NaN();
        return distance * distance;
    }

    std::vector<double> seen_from_origin(std::vector<double> points, double sign) const {
        for (std::size_t i = 0; i < points.size(); ++i) points[i] += sign * origin_[i % 3];
        return points;
    }

    DeviceSurface& surface_;
    const std::vector<double>& points_;
    const LeastSquaresOptions& options_;
    std::vector<double> closest_;
    std::array<double, 3> origin_{};
    std::unique_ptr<FitSystem> system_;
    std::unique_ptr<ClosestSearch> search_;
    Candidate best_;
    LeastSquaresFit result_;
};

}  // namespace

LeastSquaresFit fit_least_squares(DeviceSurface& surface, const std::vector<double>& points, std::vector<double> control, const LeastSquaresOptions& options) {
    if (points.empty()) throw InvalidArgument("a least-squares fit needs points, and there are none: give at least one");
    return Fit(surface, points, options).run(std::move(control));
}

}  // namespace lcl
