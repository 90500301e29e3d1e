// SPDX-License-Identifier: BSD-3-Clause
#include "host/filter/morph.h"

#include <algorithm>

#include "host/capi/arguments.h"

using namespace lcl;

namespace {

MorphOptions inner_options(const lcl_morph_options& given) {
    if (given.path < LCL_MORPH_RECURSION || given.path > LCL_MORPH_LINEAR)
        throw InvalidArgument("options.path is " + std::to_string(given.path) + ", it goes from 0 to 2");
    if (given.path == LCL_MORPH_EVEN && given.rho_count > 0) throw InvalidArgument("options.rho is given, and even morphs choose rho themselves: leave it out");
    MorphOptions options;
    options.precision = inner_precision(given.precision);
    options.path = static_cast<MorphPath>(given.path);
    if (given.frames != 0) options.frames = given.frames;
    if (given.m != nullptr && given.m_count == 0) throw InvalidArgument("options.m is given without its options.m_count");
    if (given.rho != nullptr && given.rho_count == 0) throw InvalidArgument("options.rho is given without its options.rho_count");
    if (given.m_count > 0) options.m.assign(required(given.m, "options.m"), given.m + given.m_count);
    if (given.rho_count > 0) options.rho.assign(required(given.rho, "options.rho"), given.rho + given.rho_count);
    return options;
}

/// "3 4 5", at most ten.
std::string corners_text(const PolygonMesh& mesh, Index f) {
    std::string text;
    for (Index h = mesh.face_offsets[f]; h < mesh.face_offsets[f + 1] && h < mesh.face_offsets[f] + 10; ++h)
        text += (text.empty() ? "" : " ") + std::to_string(mesh.face_vertices[h]);
    return mesh.degree(f) > 10 ? text + " .." : text;
}

void require_same_count(const char* what, Index a, Index b) {
    if (a != b)
        throw BadInput("the meshes differ: one has " + std::to_string(a) + " " + what + ", the other " + std::to_string(b) + ": they must have the same faces");
}

void require_same_faces(const PolygonMesh& a, const PolygonMesh& b) {
    require_same_count("vertices", a.vertex_count, b.vertex_count);
    require_same_count("faces", a.face_count(), b.face_count());
    for (Index f = 0; f < a.face_count(); ++f) {
        const auto begin = a.face_vertices.begin() + a.face_offsets[f], end = a.face_vertices.begin() + a.face_offsets[f + 1];
        if (a.degree(f) != b.degree(f) || !std::equal(begin, end, b.face_vertices.begin() + b.face_offsets[f]))
            throw BadInput("the meshes differ: face " + std::to_string(f) + " has the vertices " + corners_text(a, f) + " in one and " + corners_text(b, f) +
                               " in the other: they must have the same faces",
                           {{}, {f}});
    }
}

}  // namespace

extern "C" {

lcl_status lcl_morph(lcl_operator A, const double* from, const double* to, size_t stride, int32_t channels, const lcl_morph_options* options,
                     lcl_frame_callback frame, void* user) {
    return guarded([&] {
        LimitSystem& system = *required(A, "A")->system;
        if (stride == 0) stride = channels;
        check_channels(channels, stride, "stride");
        refuse_ghosts(system.plan());
        required(frame, "frame");
        require_finite(required(from, "from"), stride, channels, system.plan().vertex_count, "from");
        require_finite(required(to, "to"), stride, channels, system.plan().vertex_count, "to");
        const MorphOptions inner = inner_options(options_or(options, LCL_MORPH_OPTIONS_INIT, "options"));
        morph_host(system, from, to, stride, channels, inner, [&](int number, double* points) { return frame(user, number, points) != 0; });
        return LCL_OK;
    });
}

lcl_status lcl_morph_field(lcl_operator A, int32_t m, double rho, lcl_field to, lcl_field difference, lcl_field frame) {
    return guarded([&] {
        check_same_operator(required(A, "A"), {required(to, "to"), required(difference, "difference"), required(frame, "frame")});
        if (to == difference || to == frame || difference == frame) throw InvalidArgument("to, difference and frame must be three fields");
        refuse_ghosts(A->system->plan());
        const Transform &target = transform_of(to, "to"), &own = transform_of(difference, "difference");
        const bool is_difference = std::all_of(own.centre.begin(), own.centre.end(), [](double centre) { return centre == 0; });
        if (!is_difference || own.scale != target.scale)
            throw InvalidArgument("difference is not one of fields in the centre and scale of `to`: begin with lcl_field_subtract(from, to, difference)");
        morph_field(*A->system, m, rho, to->field, difference->field, frame->field);
        frame->transform = target;
        return LCL_OK;
    });
}

lcl_status lcl_field_subtract(lcl_field a, lcl_field b, lcl_field difference) {
    return guarded([&] {
        check_same_operator(required(a, "a")->A.get(), {a, required(b, "b"), required(difference, "difference")});
        if (difference == a || difference == b) throw InvalidArgument("difference is the same field as a or b");
        Transform transform = transform_of(a, "a");
        if (!same(transform, transform_of(b, "b"))) throw InvalidArgument("a and b differ in centre and scale: use lcl_field_match before uploading");
        std::fill(transform.centre.begin(), transform.centre.end(), 0.0);
        a->A->system->A->subtract(a->field, b->field, difference->field);
        difference->transform = transform;
        return LCL_OK;
    });
}

lcl_status lcl_mesh_compare_faces(lcl_mesh a, lcl_mesh b) {
    return guarded([&] {
        require_same_faces(required(a, "a")->file.mesh, required(b, "b")->file.mesh);
        return LCL_OK;
    });
}

}  // extern "C"
