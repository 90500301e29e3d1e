// SPDX-License-Identifier: BSD-3-Clause
// A limit operator ready to be solved with: plan, device arrays, and what is found out about it and remembered.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <tuple>

#include "host/apply/device_operator.h"
#include "host/operator/feature_rows.h"
#include "host/operator/row_matrix.h"
#include "host/operator/suitability.h"

namespace lcl {

constexpr double auto_alpha = 0.5;      ///< the mesh expansion paper's choice
constexpr double near_singular = 0.05;  ///< smallest eigenvalue below which a warning is given and alpha auto takes 0.5

/// Where an operator comes from.
enum class Origin : std::uint8_t {
    scheme,    ///< limit points of a mesh
    rows,      ///< a caller's own
    features,  ///< weights of a mesh that keep its features
};

/// What is known of the eigenvalues.
struct Spectrum {
    double bound = 0;     ///< proven lower bound; NaN where none is known
    double estimate = 0;  ///< of lambda_min, never below the bound; NaN where A is not self-adjoint (darts, rows without a scaling)
    double smooth = 0;    ///< estimate for the smooth block alone, or for rows without a scaling: what Chebyshev and W-PIA are set to
    bool singular = false, indefinite = false;
    std::string message;  ///< one sentence with the cure where singular or indefinite; else empty
    std::string warning;  ///< one sentence where lambda_min is so small that interpolation exaggerates noise; else empty
    std::vector<Index> vertices;
};

/// |A^-1|_inf of the smooth block (of rows without a scaling: of all that are not fixed), without a unit: how far an error of the residual can reach.
struct InverseNorm {
    double value = 0;     ///< NaN where the estimate's solves do not end
    bool proven = false;  ///< an upper bound; else an estimate, which lies below the norm, by a few percent as a rule
};

struct LimitSystem {
    Origin origin = Origin::scheme;
    SchemeOptions scheme;        ///< of Origin::scheme
    double diagonal = 0;         ///< of the mesh's bounding box, model units; 0 without a mesh
    Objection singular;          ///< find_singular_component's
    int lowest_valence = 0;      ///< of the smooth vertices, 0 without any
    std::vector<Index> weakest;  ///< smooth vertices of that valence, the first ten: where small eigenvalues come from
    std::unique_ptr<DeviceOperator> A;

    std::optional<Spectrum> spectrum;         // filled by spectrum_of
    std::optional<InverseNorm> inverse_norm;  // filled by inverse_norm_of
    std::optional<Schedule> natural, coloured;

    /// Fields that solves work in, made once and kept: one a purpose and shape. Contents are undefined at first.
    enum class Purpose { right, correction, scratch };
    Field& work_field(Purpose purpose, int channels, Real real);
    std::map<std::tuple<Purpose, int, Real>, Field> work_fields;

    const Plan& plan() const { return A->plan(); }
};

/// Builds everything. BadInput where the scheme does not fit the mesh.
std::unique_ptr<LimitSystem> make_limit_system(std::shared_ptr<Context> context, const PolygonMesh& mesh, const Topology& topology, const Features& features,
                                               const SchemeOptions& scheme, PlanOptions plan_options);

/// The same for a caller's rows, with a look at their spectrum. BadInput with the row where an array is wrong or D A is not symmetric; Unsupported where an
/// eigenvalue above 1, below 0 or not real is found.
std::unique_ptr<LimitSystem> make_rows_system(std::shared_ptr<Context> context, const RowMatrix& rows);

/// The same for the feature-preserving weights of a mesh.
std::unique_ptr<LimitSystem> make_feature_system(std::shared_ptr<Context> context, const PolygonMesh& mesh, const Topology& topology, const Features& features,
                                                 const FeatureOperatorOptions& options);

/// Looks for eigenvalues outside [0, 1], where they are not proven to lie inside: by discs of Gershgorin, else some 30 passes on the host. Remembers what
/// there is to know of rows without a scaling. Unsupported where it finds one.
void check_spectrum(LimitSystem& system);

/// InvalidArgument where rows came without the scaling D that makes D A symmetric: "energies need ..".
void require_scaling(const Plan& plan, const char* what);

/// Unsupported where A has ghosts, whose values come from elsewhere: neither solves nor filters go without them.
void refuse_ghosts(const Plan& plan);

/// Bounds and estimates lambda_min by a short Lanczos run on the device: some 20 passes at the first call, over the weakest part alone of a large mesh.
const Spectrum& spectrum_of(LimitSystem& system);

/// Whether alpha 0 should give way to auto_alpha: A is singular, indefinite or nearly singular.
bool wants_other_alpha(LimitSystem& system);

/// The system that make() gives with scheme.alpha 0, or where that should give way with auto_alpha, which then stands in `scheme`, for make() to look at.
template <class Make>
std::unique_ptr<LimitSystem> make_with_auto_alpha(SchemeOptions& scheme, const Make& make) {
    std::unique_ptr<LimitSystem> system = make();
    if (scheme.scheme != Scheme::catmull_clark || !wants_other_alpha(*system)) return system;
    scheme.alpha = auto_alpha;
    return make();
}

/// 1/min(2 a_ii - 1) where the smooth rows are diagonally dominant, else the block Hager-Higham estimate (Higham & Tisseur 2000), some ten short solves at the
/// first call. Unsupported where has_inverse_norm is false.
const InverseNorm& inverse_norm_of(LimitSystem& system);

/// No darts; rows without a scaling are diagonally dominant.
bool has_inverse_norm(const LimitSystem& system);

}  // namespace lcl
