// SPDX-License-Identifier: BSD-3-Clause
// What is done to the points X of M^1, umbrella by umbrella: on a device in double, or on the host, for devices without doubles and as the reference.
#pragma once

#include <memory>
#include <vector>

#include "host/device/device.h"
#include "host/two_phase/umbrellas.h"

namespace lcl {

/// One number an umbrella, of a repair.
struct RepairFindings {
    std::vector<double> distances;  ///< |Q - V_inf| before, model units; 0 where Q is not asked for
    std::vector<double> sides;      ///< (t1 x t2).N before, t1 and t2 of the mask: at most 0 where the surface looked to the other side; 1 without a normal
};

/// Holds X, in the order of the umbrellas. L: the rows of set_fairness; C X = d: the constraints of the targets, linear in X; C the projection on to C Y = 0,
/// least norm, vertex by vertex.
class UmbrellaSteps {
public:
    virtual ~UmbrellaSteps() = default;
    virtual void upload(const std::vector<double>& points) = 0;  ///< vertex_count x 3
    virtual void download(std::vector<double>& points) = 0;

    /// X += the least-norm step that makes limit points Q and tangent planes orthogonal to N (two-phase paper, equations 7 and 15).
    virtual RepairFindings repair() = 0;
    /// X <- V_inf + S (X - V_inf) (two-phase paper, section 4).
    virtual void scale() = 0;

    /// Before the functions below.
    virtual void set_fairness(const FairRows& rows, double weight) = 0;
    /// |L X|^2.
    virtual double energy() = 0;
    /// Once: r = p = -C W L^T L X; gives |r|^2.
    virtual double begin() = 0;
    /// q = C (p + W L^T L p); gives p.q.
    virtual double apply() = 0;
    /// X += alpha p, r -= alpha q; gives |r|^2.
    virtual double update(double alpha) = 0;
    /// p = r + beta p.
    virtual void turn(double beta) = 0;
};

/// Points (vertex_count x 3) by Umbrellas::order, and back.
std::vector<double> in_umbrella_order(const Umbrellas& umbrellas, const std::vector<double>& points);
std::vector<double> in_vertex_order(const Umbrellas& umbrellas, const std::vector<double>& ordered);

/// In plain double on the host. Both references have to outlive the result.
std::unique_ptr<UmbrellaSteps> make_host_steps(const Umbrellas& umbrellas, const UmbrellaTargets& targets);

/// On a device with double precision. Sums are added up in a fixed order: the same bits in every run. group: work-items that sum together; 0: what suits the
/// device.
std::unique_ptr<UmbrellaSteps> make_device_steps(std::shared_ptr<Context> context, const Umbrellas& umbrellas, const UmbrellaTargets& targets, int group = 0);

}  // namespace lcl
