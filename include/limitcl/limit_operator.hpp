// SPDX-License-Identifier: BSD-3-Clause
// The limit operator A of a mesh, operators of your own, and fields on their device.
#ifndef LIMITCL_LIMIT_OPERATOR_HPP
#define LIMITCL_LIMIT_OPERATOR_HPP

#include <array>

#include "device.hpp"
#include "scheme.hpp"

namespace limitcl {

enum class Precision {
    mixed = LCL_PRECISION_MIXED,  ///< float sweeps, residuals and corrections in double or float pairs
    single = LCL_PRECISION_SINGLE,
    full = LCL_PRECISION_DOUBLE  ///< double; Error LCL_ERROR_UNSUPPORTED where the device has none
};

/// What can be said of the spectrum of A before solving.
struct Diagnosis {
    double lambda_min_bound = 0;     ///< proven lower bound of the smallest eigenvalue; NaN where none is known
    double lambda_min_estimate = 0;  ///< from a short Lanczos run; NaN where A is not self-adjoint (darts, rows without D)
    bool singular = false, indefinite = false;
    std::string reason;  ///< one sentence with the cure; "" if all is well
    std::vector<std::int32_t> vertices;
};

/// Bound of |A^-1|_inf.
struct InverseNorm {
    double norm = 0;
    bool proven = false;  ///< a bound by diagonal dominance; else an estimate
};

/// Rows of a matrix of your own: row i holds weights[offsets[i]] .. weights[offsets[i + 1] - 1] at columns[..], each column at most once, the diagonal among
/// them. Rows of one entry, 1, are identity rows: their points stay.
struct Rows {
    std::vector<std::int64_t> offsets{0};
    std::vector<std::int32_t> columns;
    std::vector<double> weights;
    std::vector<double> scaling;  ///< empty, or D: one number above 0 a row with diag(D) A symmetric, which CG and GS, energies and even morphs need

    /// Adds an entry to the row that is being made, and ends that row.
    void add(std::int32_t column, double weight) { columns.push_back(column), weights.push_back(weight); }
    void end_row() { offsets.push_back(static_cast<std::int64_t>(columns.size())); }

    /// The struct of the C API. It points into this object: use it before this object changes or goes. Error LCL_ERROR_INVALID_ARGUMENT for sizes that differ.
    lcl_rows to_c() const;
};

/// Weights of a feature-preserving operator: exp(-(angle between the tangent planes at an edge's ends / angle_degrees)^2).
struct FeatureWeights {
    double angle_degrees = 20;
    double diagonal_factor = 2.5;      ///< above 2: eigenvalues lie in [1 - 2 / factor, 1]
    int smoothing = 3;                 ///< of the points from which the tangent planes are taken; 0: none
    std::vector<std::int32_t> subset;  ///< empty: all; else the vertices that may move, the others keep their points

    /// The struct of the C API. It points into this object: use it before this object changes or goes.
    lcl_feature_options to_c() const;
};

/// Limit points and unit limit normals, vertex_count x 3 each.
struct LimitNormals {
    std::vector<double> points, normals;
};

/// The limit operator: row i gives the limit point of vertex i on the subdivision surface of the mesh. Rows sum to one. Copies share it. Operators of your own
/// take its place in solves, series, filters and morphs.
class LimitOperator {
public:
    /// Builds A of a mesh and puts it on the context's device, in linear time. The mesh may change or go afterwards.
    /// Errors: LCL_ERROR_BAD_INPUT (mesh not sound, wrong face degree for the scheme), LCL_ERROR_INVALID_ARGUMENT (options), LCL_ERROR_MEMORY.
    LimitOperator(const Context& context, const Mesh& mesh, const SchemeOptions& options = {});
    /// An operator from rows instead of a mesh; eigenvalues in (0, 1]. Errors: LCL_ERROR_BAD_INPUT with the row where an array is wrong or D A is not
    /// symmetric, LCL_ERROR_UNSUPPORTED where an eigenvalue above 1, below 0 or not real was found, LCL_ERROR_MEMORY.
    static LimitOperator from_rows(const Context& context, const Rows& rows);
    /// A feature-preserving operator of a mesh, for denoising. Errors: LCL_ERROR_BAD_INPUT (mesh not sound), LCL_ERROR_INVALID_ARGUMENT, LCL_ERROR_MEMORY.
    static LimitOperator keeping_features(const Context& context, const Mesh& mesh, const FeatureWeights& weights = {});

    lcl_operator get() const { return handle_.get(); }
    const Context& context() const { return context_; }
    int vertex_count() const { return lcl_operator_vertex_count(get()); }
    /// Rows: vertex_count, or the number of owned vertices.
    int row_count() const { return lcl_operator_row_count(get()); }
    /// Blocks of rows that LimitOperator::step can work on one by one.
    int block_count() const { return lcl_operator_block_count(get()); }
    /// Scheme and numbers in use (alpha after alpha_auto); the vectors are empty. Scheme::by_faces, none, for operators of your own.
    SchemeOptions scheme() const;
    /// Row of a vertex: columns in ascending order with their weights, double.
    std::vector<std::pair<std::int32_t, double>> row(int vertex) const;
    /// Some 20 passes over A at the first call, less on large meshes, then remembered.
    Diagnosis diagnose() const;
    /// A few solves at the first call where no bound is known. Error LCL_ERROR_UNSUPPORTED with darts, and for rows without D that are not dominant.
    InverseNorm inverse_norm() const;

    /// Limit points of `points` (vertex_count x channels, model units), through host memory. One pass.
    std::vector<double> limit_points(ArrayView<double> points, int channels = 3, Precision precision = Precision::mixed) const;
    /// Limit points and normals of `points` (vertex_count x 3, model units; empty: the mesh's), through host memory; 0 0 0 at isolated vertices, at creases the
    /// normalised mean of the sides. mesh: the one that A was made of. Several frames: LimitTangents.
    LimitNormals limit_normals(const Mesh& mesh, ArrayView<double> points = {}, Precision precision = Precision::mixed) const;

private:
    LimitOperator(const Context& context, OperatorHandle handle) : context_(context), handle_(std::move(handle)) {}

    Context context_;
    OperatorHandle handle_;
};

/// vertex_count x channels values that stay on the operator's device; zero at first. Copies share them.
class Field {
public:
    /// Error LCL_ERROR_MEMORY, with the numbers, if the device has no room.
    explicit Field(const LimitOperator& A, int channels = 3, Precision precision = Precision::mixed);

    lcl_field get() const { return handle_.get(); }
    int channels() const { return lcl_field_channels(get()); }

    /// Host to device: vertex_count x channels, in vertex order. `values` may be changed afterwards.
    void upload(ArrayView<double> values);
    void upload(ArrayView<float> values);
    /// Device to host, waits: vertex_count x channels.
    std::vector<double> download() const;
    /// The same into the caller's floats: vertex_count x channels.
    void download(float* values) const { check(lcl_field_download(get(), values, LCL_TYPE_FLOAT, 0)); }
    /// Takes over the centre and scale of another field, so that both can stand in one formula.
    void match(const Field& of) { check(lcl_field_match(get(), of.get())); }
    /// Single rows: vertices.size() x channels. For halo exchange.
    std::vector<double> read_vertices(ArrayView<std::int32_t> vertices) const;
    void write_vertices(ArrayView<std::int32_t> vertices, ArrayView<double> values);

private:
    void require_size(std::size_t size, std::size_t rows) const;

    LimitOperator operator_;
    FieldHandle handle_;
};

/// y = A x: limit points, on the device. Returns at once; Context::finish or a download waits. x and y must differ. One pass.
inline void apply(const LimitOperator& A, const Field& x, Field& y) { check(lcl_operator_apply(A.get(), x.get(), y.get())); }

/// y = a x + b (M - A x), and waits for max_i |M - A x|_i over x, y, z, model units. PIA: a = b = 1; W-PIA: b = w. x and y must differ. One pass.
inline double step(const LimitOperator& A, double a, double b, const Field& M, const Field& x, Field& y) {
    double residual = 0;
    check(lcl_operator_step(A.get(), a, b, 0.0, M.get(), x.get(), nullptr, y.get(), 0, -1, &residual));
    return residual;
}

/// One side of a vertex with several: the faces between two sharp edges.
struct LimitSide {
    std::int32_t vertex = 0;
    std::int32_t face = 0;  ///< its first, in face order
    std::array<double, 3> normal{};
};

/// Limit tangents at the vertices of a mesh, for normals on the device: what is a limit and what a choice, the C API says. Copies share them.
class LimitTangents {
public:
    /// mesh: the one that A was made of, faces and sharp features unchanged, else Error LCL_ERROR_INVALID_ARGUMENT.
    LimitTangents(const LimitOperator& A, const Mesh& mesh);

    lcl_tangents get() const { return handle_.get(); }
    /// Unit normals of x, and limit = A x. Fields of three channels and one precision. Returns at once. About two passes.
    void apply(const Field& x, Field& limit, Field& normals) const { check(lcl_tangents_apply(get(), x.get(), limit.get(), normals.get(), nullptr, nullptr)); }
    void apply(const Field& x, Field& normals) const { check(lcl_tangents_apply(get(), x.get(), nullptr, normals.get(), nullptr, nullptr)); }
    /// Orthonormal frames: normal, tangent, normal x tangent.
    void frames(const Field& x, Field& normals, Field& tangents, Field& bitangents) const {
        check(lcl_tangents_apply(get(), x.get(), nullptr, normals.get(), tangents.get(), bitangents.get()));
    }
    /// Sides of inner crease vertices and corners, with the normals that the last apply() or frames() found; waits.
    std::vector<LimitSide> sides() const;

private:
    LimitOperator operator_;
    TangentsHandle handle_;
};

inline LimitOperator::LimitOperator(const Context& context, const Mesh& mesh, const SchemeOptions& options) : context_(context) {
    detail::require_ratios(options, mesh);
    const lcl_scheme_options c = options.to_c();
    lcl_operator A = nullptr;
    check(lcl_operator_create(context.get(), mesh.get(), &c, &A));
    handle_ = OperatorHandle(A);
}

inline lcl_rows Rows::to_c() const {
    const std::size_t count = offsets.empty() ? 0 : offsets.size() - 1, entries = offsets.empty() ? 0 : static_cast<std::size_t>(offsets.back());
    if (columns.size() != entries || weights.size() != entries || (!scaling.empty() && scaling.size() != count))
        throw Error(LCL_ERROR_INVALID_ARGUMENT, "the rows have " + std::to_string(columns.size()) + " columns, " + std::to_string(weights.size()) +
                                                    " weights and " + std::to_string(scaling.size()) + " scalings, their offsets say " +
                                                    std::to_string(entries) + " entries in " + std::to_string(count) + " rows");
    lcl_rows c = LCL_ROWS_INIT;
    c.row_count = static_cast<std::int32_t>(count);
    c.offsets = offsets.data();
    c.columns = columns.data();
    c.weights = weights.data();
    c.scaling = scaling.empty() ? nullptr : scaling.data();
    return c;
}

inline lcl_feature_options FeatureWeights::to_c() const {
    lcl_feature_options c = LCL_FEATURE_OPTIONS_INIT;
    c.angle_degrees = angle_degrees;
    c.diagonal_factor = diagonal_factor;
    c.smoothing = smoothing <= 0 ? -1 : smoothing;
    c.subset = subset.empty() ? nullptr : subset.data();
    c.subset_count = subset.size();
    return c;
}

inline LimitOperator LimitOperator::from_rows(const Context& context, const Rows& rows) {
    const lcl_rows c = rows.to_c();
    lcl_operator A = nullptr;
    check(lcl_operator_create_rows(context.get(), &c, &A));
    return {context, OperatorHandle(A)};
}

inline LimitOperator LimitOperator::keeping_features(const Context& context, const Mesh& mesh, const FeatureWeights& weights) {
    const lcl_feature_options c = weights.to_c();
    lcl_operator A = nullptr;
    check(lcl_operator_create_features(context.get(), mesh.get(), &c, &A));
    return {context, OperatorHandle(A)};
}

inline SchemeOptions LimitOperator::scheme() const {
    lcl_scheme_options c = LCL_SCHEME_OPTIONS_INIT;
    check(lcl_operator_get_scheme(get(), &c));
    return SchemeOptions::from_c(c);
}

inline std::vector<std::pair<std::int32_t, double>> LimitOperator::row(int vertex) const {
    std::size_t size = 0;
    check(lcl_operator_get_row(get(), vertex, nullptr, nullptr, 0, &size));
    std::vector<std::int32_t> columns(size);
    std::vector<double> weights(size);
    check(lcl_operator_get_row(get(), vertex, columns.data(), weights.data(), size, &size));
    std::vector<std::pair<std::int32_t, double>> row(size);
    for (std::size_t k = 0; k < size; ++k) row[k] = {columns[k], weights[k]};
    return row;
}

inline Diagnosis LimitOperator::diagnose() const {
    lcl_diagnosis c = LCL_DIAGNOSIS_INIT;
    check(lcl_operator_diagnose(get(), &c));
    return {c.lambda_min_bound, c.lambda_min_estimate, c.singular != 0, c.indefinite != 0, c.reason, {c.vertices, c.vertices + c.vertex_count}};
}

inline InverseNorm LimitOperator::inverse_norm() const {
    InverseNorm result;
    std::int32_t proven = 0;
    check(lcl_operator_inverse_norm(get(), &result.norm, &proven));
    result.proven = proven != 0;
    return result;
}

namespace detail {

inline void require_values(const LimitOperator& A, std::size_t size, int channels, const char* what) {
    const std::size_t expected = static_cast<std::size_t>(A.vertex_count()) * static_cast<std::size_t>(channels < 0 ? 0 : channels);
    if (channels < 1 || size != expected)
        throw Error(LCL_ERROR_INVALID_ARGUMENT, std::string(what) + ": " + std::to_string(size) + " values were given, " + std::to_string(A.vertex_count()) +
                                                    " vertices with " + std::to_string(channels) + " channels need " + std::to_string(expected));
}

}  // namespace detail

inline std::vector<double> LimitOperator::limit_points(ArrayView<double> points, int channels, Precision precision) const {
    detail::require_values(*this, points.size(), channels, "points");
    std::vector<double> out(points.size());
    check(lcl_limit_points(get(), points.data(), 0, channels, static_cast<lcl_precision>(precision), out.data(), 0));
    return out;
}

inline LimitNormals LimitOperator::limit_normals(const Mesh& mesh, ArrayView<double> points, Precision precision) const {
    if (!points.empty()) detail::require_values(*this, points.size(), 3, "points");
    const std::size_t size = 3 * static_cast<std::size_t>(vertex_count());
    LimitNormals out{std::vector<double>(size), std::vector<double>(size)};
    check(lcl_limit_normals(get(), mesh.get(), points.empty() ? nullptr : points.data(), 0, static_cast<lcl_precision>(precision), out.points.data(), 0,
                            out.normals.data(), 0));
    return out;
}

inline LimitTangents::LimitTangents(const LimitOperator& A, const Mesh& mesh) : operator_(A) {
    lcl_tangents tangents = nullptr;
    check(lcl_tangents_create(A.get(), mesh.get(), &tangents));
    handle_ = TangentsHandle(tangents);
}

inline std::vector<LimitSide> LimitTangents::sides() const {
    const auto count = static_cast<std::size_t>(lcl_tangents_side_count(get()));
    std::vector<std::int32_t> vertices(count), faces(count);
    std::vector<double> normals(3 * count);
    check(lcl_tangents_get_sides(get(), vertices.data(), faces.data(), normals.data()));
    std::vector<LimitSide> sides(count);
    for (std::size_t s = 0; s < count; ++s) sides[s] = {vertices[s], faces[s], {normals[3 * s], normals[3 * s + 1], normals[3 * s + 2]}};
    return sides;
}

inline Field::Field(const LimitOperator& A, int channels, Precision precision) : operator_(A) {
    lcl_field field = nullptr;
    check(lcl_field_create(A.get(), channels, static_cast<lcl_precision>(precision), &field));
    handle_ = FieldHandle(field);
}

inline void Field::require_size(std::size_t size, std::size_t rows) const {
    const std::size_t expected = rows * static_cast<std::size_t>(channels());
    if (size != expected)
        throw Error(LCL_ERROR_INVALID_ARGUMENT,
                    std::to_string(size) + " values were given, " + std::to_string(rows) + " rows of the field need " + std::to_string(expected));
}

inline void Field::upload(ArrayView<double> values) {
    require_size(values.size(), static_cast<std::size_t>(operator_.vertex_count()));
    check(lcl_field_upload(get(), values.data(), LCL_TYPE_DOUBLE, 0));
}

inline void Field::upload(ArrayView<float> values) {
    require_size(values.size(), static_cast<std::size_t>(operator_.vertex_count()));
    check(lcl_field_upload(get(), values.data(), LCL_TYPE_FLOAT, 0));
}

inline std::vector<double> Field::download() const {
    std::vector<double> values(static_cast<std::size_t>(operator_.vertex_count()) * static_cast<std::size_t>(channels()));
    check(lcl_field_download(get(), values.data(), LCL_TYPE_DOUBLE, 0));
    return values;
}

inline std::vector<double> Field::read_vertices(ArrayView<std::int32_t> vertices) const {
    std::vector<double> values(vertices.size() * static_cast<std::size_t>(channels()));
    check(lcl_field_read_vertices(get(), vertices.data(), vertices.size(), values.data()));
    return values;
}

inline void Field::write_vertices(ArrayView<std::int32_t> vertices, ArrayView<double> values) {
    require_size(values.size(), vertices.size());
    check(lcl_field_write_vertices(get(), vertices.data(), vertices.size(), values.data()));
}

}  // namespace limitcl

#endif
