// SPDX-License-Identifier: BSD-3-Clause
#include "host/points/least_squares.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>

#include "host/error.h"
#include "host/evaluate/closest.h"
#include "host/points/fit_system.h"

namespace lcl {
namespace {

constexpr double smallest_change = 1e-3;  // of the root mean square, in a correction
constexpr double solve_tolerance = 1e-4;  // of what the residual is where a correction begins: the next one goes on from there
constexpr int most_iterations = 500;      // of conjugate gradients in a correction

class Stopwatch {
public:
    explicit Stopwatch(double& seconds) : seconds_(seconds), start_(std::chrono::steady_clock::now()) {}
    ~Stopwatch() { seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

private:
    double& seconds_;
    std::chrono::steady_clock::time_point start_;
};

/// A surface that was measured.
struct Candidate {
    std::vector<double> control, distances;
    double rms = 0, objective = 0;  ///< sum of both terms
};

class Fit {
public:
    Fit(DeviceSurface& surface, const std::vector<double>& points, const LeastSquaresOptions& options)
        : surface_(surface), points_(points), options_(options), faces_(count()), corners_(count()), uv_(2 * count()) {}

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
    std::size_t count() const { return points_.size() / 3; }
    Places places() const { return {count(), faces_.data(), corners_.data(), uv_.data()}; }

    /// Until the objective, which both halves of a correction lower, does so no more, or the root mean square hardly changes.
    void correct() {
        while (result_.corrections < options_.max_corrections) {
            if (options_.progress && !options_.progress(result_.corrections, *std::max_element(best_.distances.begin(), best_.distances.end())))
                throw Cancelled("the least-squares fit was cancelled after " + std::to_string(result_.corrections) + " corrections");
            Candidate next;
            next.control = solve();
            surface_.set_points(next.control.data(), 3);
            const Places start = places();
            measure(next, &start);
            ++result_.corrections;
            if (!(next.objective < best_.objective)) return;
            const double change = std::abs(next.rms - best_.rms);
            best_ = std::move(next);
            if (change < smallest_change * best_.rms) return;
        }
    }

    std::vector<double> solve() {
        const Stopwatch watch(result_.seconds_solve);
        system_->set_samples(places(), points_.data(), origin_);
        std::vector<double> control = seen_from_origin(best_.control, -1);
        result_.iterations += system_->solve(control, solve_tolerance, most_iterations);
        return seen_from_origin(std::move(control), 1);
    }

    /// Closest points and what they say of the surface's points of now.
    void measure(Candidate& candidate, const Places* start) {
        const Stopwatch watch(result_.seconds_measure);
        candidate.distances.resize(count());
        ClosestPoints out;
        out.faces = faces_.data(), out.corners = corners_.data(), out.uv = uv_.data(), out.distances = candidate.distances.data();
        if (start == nullptr) search_ = std::make_unique<ClosestSearch>(surface_);
        search_->find(points_.data(), 3, count(), out, start);
        double sum = 0;
        for (double& distance : candidate.distances) {
            distance = std::abs(distance);
            sum += distance * distance;
        }
        const double mean = sum / static_cast<double>(count());
        candidate.rms = std::sqrt(mean);
        candidate.objective = mean + options_.fair * system_->energy(seen_from_origin(candidate.control, -1));
    }

    std::vector<double> seen_from_origin(std::vector<double> points, double sign) const {
        for (std::size_t i = 0; i < points.size(); ++i) points[i] += sign * origin_[i % 3];
        return points;
    }

    DeviceSurface& surface_;
    const std::vector<double>& points_;
    const LeastSquaresOptions& options_;
    std::vector<Index> faces_, corners_;  ///< of the points' places
    std::vector<double> uv_;
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
