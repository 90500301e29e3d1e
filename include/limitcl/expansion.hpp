// SPDX-License-Identifier: BSD-3-Clause
// Mesh expansion (mesh expansion paper): terms, bands, equaliser and spectrum; denoising, sharpening and morphing with them.
//
//     std::vector<double> smooth = limitcl::denoise(A, mesh.points());                      // D^k A M
//     std::vector<double> detail = limitcl::expand(A, mesh.points(), 3, limitcl::Terms{4, 7});  // one band
#ifndef LIMITCL_EXPANSION_HPP
#define LIMITCL_EXPANSION_HPP

#include "limit_operator.hpp"

#include <exception>
#include <functional>
#include <utility>
#include <vector>

namespace limitcl {

enum class Series {
    representation = LCL_SERIES_REPRESENTATION,  ///< terms (E - A)^i A M, which sum to M
    interpolation = LCL_SERIES_INTERPOLATION     ///< terms (E - A)^i M, which sum to P with A P = M
};

/// Passes done of all; return false to cancel (Error LCL_ERROR_CANCELLED). What it throws reaches the caller of the filter.
using PassProgress = std::function<bool(std::int64_t done, std::int64_t all)>;

/// The sum of the terms first .. last; equal: one term.
struct Terms {
    int first = 0, last = 0;
    Series series = Series::representation;
};

/// Weights of the terms 0 .. weights.size() - 1, and of what they leave (representation only; all ones give M back).
struct Equaliser {
    std::vector<double> weights;
    double remainder = 1;
    Series series = Series::representation;
};

/// D^k A, or D^k where plain; D = E - (E - A)^(m + 1). Small m: smoother, less detail.
struct Denoise {
    int m = 2, k = 3;
    bool plain = false;

    /// m and k in plain words: 0 (k = 0) to 1 (m = 1, k = 100), 0.5 is the default.
    static Denoise of_strength(double strength, bool plain = false) {
        std::int32_t m = 0, k = 0;
        check(lcl_denoise_settings(strength, &m, &k));
        return {m, k, plain};
    }
};

/// T += sum of (E - A)^i T over first .. last, k times. Refused where (last - first + 2)^k, the largest gain, is above 10^6.
struct Sharpen {
    int first = 1, last = 3, k = 1;
};

enum class MorphPath {
    recursion = LCL_MORPH_RECURSION,  ///< m and rho as given
    even = LCL_MORPH_EVEN,            ///< rho of each frame for equal steps; the last frame is the target itself
    linear = LCL_MORPH_LINEAR         ///< straight lines
};

struct MorphOptions {
    MorphPath path = MorphPath::recursion;
    int frames = 10;              ///< N: frames 0 (the start) to N are given out
    std::vector<std::int32_t> m;  ///< of the step to frame 1, 2, ..; the last is repeated; empty: 2
    std::vector<double> rho;      ///< likewise, above 0 and up to 1; empty: 0.5. Not with MorphPath::even
    Precision precision = Precision::mixed;
};

namespace detail {

// A callback of the caller's that C calls: an exception must not pass through C, so it cancels, and goes on afterwards.
template <class... Arguments>
class Forwarded {
public:
    explicit Forwarded(std::function<bool(Arguments...)> call) : call_(std::move(call)) {}
    static std::int32_t forward(void* user, Arguments... arguments) {
        Forwarded& self = *static_cast<Forwarded*>(user);
        try {
            return self.call_(arguments...);
        } catch (...) {
            self.thrown_ = std::current_exception();
            return 0;
        }
    }
    bool is_there() const { return static_cast<bool>(call_); }
    void finish(lcl_status status) const {
        if (thrown_) std::rethrow_exception(thrown_);
        check(status);
    }

private:
    std::function<bool(Arguments...)> call_;
    std::exception_ptr thrown_;
};

inline lcl_expand_options to_c(const Terms& terms) {
    lcl_expand_options c = LCL_EXPAND_OPTIONS_INIT;
    c.series = static_cast<lcl_series>(terms.series);
    c.first = terms.first;
    c.last = terms.last;
    return c;
}
inline lcl_expand_options to_c(const Equaliser& equaliser) {
    static const double none = 0;
    lcl_expand_options c = LCL_EXPAND_OPTIONS_INIT;
    c.series = static_cast<lcl_series>(equaliser.series);
    c.weights = equaliser.weights.empty() ? &none : equaliser.weights.data();
    c.weight_count = equaliser.weights.size();
    c.remainder = equaliser.remainder;
    return c;
}
inline lcl_denoise_options to_c(const Denoise& denoise) {
    lcl_denoise_options c = LCL_DENOISE_OPTIONS_INIT;
    c.m = denoise.m;
    c.k = denoise.k;
    c.plain = denoise.plain;
    return c;
}
inline lcl_sharpen_options to_c(const Sharpen& sharpen) {
    lcl_sharpen_options c = LCL_SHARPEN_OPTIONS_INIT;
    c.first = sharpen.first;
    c.last = sharpen.last;
    c.k = sharpen.k;
    return c;
}

// `call` is one of lcl_expand, lcl_denoise, lcl_sharpen.
template <class Options, class Call>
std::vector<double> filter(const LimitOperator& A, ArrayView<double> M, int channels, Options options, Precision precision, const PassProgress& progress,
                           Call call) {
    require_values(A, M.size(), channels, "M");
    Forwarded<std::int64_t, std::int64_t> forwarded(progress);
    options.precision = static_cast<lcl_precision>(precision);
    options.progress = forwarded.is_there() ? &Forwarded<std::int64_t, std::int64_t>::forward : nullptr;
    options.progress_user = &forwarded;
    std::vector<double> out(M.size());
    forwarded.finish(call(A.get(), M.data(), 0, channels, &options, out.data(), 0));
    return out;
}

}  // namespace detail

/// A weighted sum of terms of M, vertex_count x channels, positions first, model units; so is the result. A term beyond the first, or a band, is a field of
/// vectors round the origin. One pass a term up to the last one. Errors of all filters: LCL_ERROR_INVALID_ARGUMENT, LCL_ERROR_BAD_INPUT (values that are not
/// finite), LCL_ERROR_CANCELLED, LCL_ERROR_MEMORY, LCL_ERROR_UNSUPPORTED (ghosts; double precision on a device without).
[[nodiscard]] inline std::vector<double> expand(const LimitOperator& A, ArrayView<double> M, int channels = 3, const Terms& terms = {},
                                                Precision precision = Precision::mixed, const PassProgress& progress = {}) {
    return detail::filter(A, M, channels, detail::to_c(terms), precision, progress, lcl_expand);
}
/// The same with a weight for each term: at most as many passes as there are weights.
[[nodiscard]] inline std::vector<double> expand(const LimitOperator& A, ArrayView<double> M, int channels, const Equaliser& equaliser,
                                                Precision precision = Precision::mixed, const PassProgress& progress = {}) {
    return detail::filter(A, M, channels, detail::to_c(equaliser), precision, progress, lcl_expand);
}
/// D^k A M, k (m + 1) + 1 passes, or D^k M.
[[nodiscard]] inline std::vector<double> denoise(const LimitOperator& A, ArrayView<double> M, int channels = 3, const Denoise& settings = {},
                                                 Precision precision = Precision::mixed, const PassProgress& progress = {}) {
    return detail::filter(A, M, channels, detail::to_c(settings), precision, progress, lcl_denoise);
}
/// T_k of T += sum of (E - A)^i T, T_0 = M: k times `last` passes.
[[nodiscard]] inline std::vector<double> sharpen(const LimitOperator& A, ArrayView<double> M, int channels = 3, const Sharpen& settings = {},
                                                 Precision precision = Precision::mixed, const PassProgress& progress = {}) {
    return detail::filter(A, M, channels, detail::to_c(settings), precision, progress, lcl_sharpen);
}

/// The same on fields that stay on the device; M and out must differ. Returns at once.
inline void expand(const LimitOperator& A, const Field& M, Field& out, const Terms& terms) {
    const lcl_expand_options c = detail::to_c(terms);
    check(lcl_expand_field(A.get(), M.get(), &c, out.get()));
}
inline void expand(const LimitOperator& A, const Field& M, Field& out, const Equaliser& equaliser) {
    const lcl_expand_options c = detail::to_c(equaliser);
    check(lcl_expand_field(A.get(), M.get(), &c, out.get()));
}
inline void denoise(const LimitOperator& A, const Field& M, Field& out, const Denoise& settings = {}) {
    const lcl_denoise_options c = detail::to_c(settings);
    check(lcl_denoise_field(A.get(), M.get(), &c, out.get()));
}
inline void sharpen(const LimitOperator& A, const Field& M, Field& out, const Sharpen& settings = {}) {
    const lcl_sharpen_options c = detail::to_c(settings);
    check(lcl_sharpen_field(A.get(), M.get(), &c, out.get()));
}

/// Energies of the terms 0 .. term_count - 1, term_count x channels, model units squared. One pass a term.
[[nodiscard]] inline std::vector<double> spectrum(const LimitOperator& A, ArrayView<double> M, int term_count = 16, int channels = 3,
                                                  Precision precision = Precision::mixed) {
    detail::require_values(A, M.size(), channels, "M");
    std::vector<double> energies(static_cast<std::size_t>(term_count > 0 ? term_count : 0) * static_cast<std::size_t>(channels));
    check(lcl_spectrum(A.get(), M.data(), 0, channels, static_cast<lcl_precision>(precision), term_count, energies.data()));
    return energies;
}

/// Frames from `from` to `to`, vertex_count x channels each: frame(number, points), whose points it may change; false cancels (Error LCL_ERROR_CANCELLED).
/// m + 1 passes a frame.
inline void morph(const LimitOperator& A, ArrayView<double> from, ArrayView<double> to, int channels, const MorphOptions& options,
                  const std::function<bool(int frame, double* points)>& frame) {
    detail::require_values(A, from.size(), channels, "from");
    detail::require_values(A, to.size(), channels, "to");
    lcl_morph_options c = LCL_MORPH_OPTIONS_INIT;
    c.precision = static_cast<lcl_precision>(options.precision);
    c.path = static_cast<lcl_morph_path>(options.path);
    c.frames = options.frames;
    c.m = options.m.data();
    c.m_count = options.m.size();
    c.rho = options.rho.data();
    c.rho_count = options.rho.size();
    detail::Forwarded<std::int32_t, double*> forwarded([&](std::int32_t number, double* points) { return frame(number, points); });
    forwarded.finish(lcl_morph(A.get(), from.data(), to.data(), 0, channels, &c, &detail::Forwarded<std::int32_t, double*>::forward, &forwarded));
}

/// One frame on fields that stay on the device: difference becomes rho D difference, frame = to + difference. Returns at once. The first difference is
/// subtract(from, to, difference).
inline void morph(const LimitOperator& A, int m, double rho, const Field& to, Field& difference, Field& frame) {
    check(lcl_morph_field(A.get(), m, rho, to.get(), difference.get(), frame.get()));
}
/// difference = a - b; all three differ, a and b share centre and scale (Field::match).
inline void subtract(const Field& a, const Field& b, Field& difference) { check(lcl_field_subtract(a.get(), b.get(), difference.get())); }

/// Volume that a closed mesh encloses. Error LCL_ERROR_BAD_INPUT with a boundary.
inline double volume(const Mesh& mesh) {
    double result = 0;
    check(lcl_mesh_get_volume(mesh.get(), &result));
    return result;
}
/// Moves the points of every component along their normals until it encloses the volume that it had with `points`; corners and `fixed` vertices stay.
inline void match_volume(Mesh& mesh, ArrayView<double> points, ArrayView<std::int32_t> fixed = {}) {
    const std::size_t expected = 3 * static_cast<std::size_t>(mesh.vertex_count());
    if (points.size() != expected)
        throw Error(LCL_ERROR_INVALID_ARGUMENT, std::to_string(points.size()) + " values were given, the mesh's points have " + std::to_string(expected));
    check(lcl_mesh_match_volume(mesh.get(), points.data(), 3, fixed.data(), fixed.size()));
}

}  // namespace limitcl

#endif
