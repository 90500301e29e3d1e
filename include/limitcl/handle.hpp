// SPDX-License-Identifier: BSD-3-Clause
// Shared ownership of the C API's reference counted handles.
#ifndef LIMITCL_HANDLE_HPP
#define LIMITCL_HANDLE_HPP

#include "limitcl.h"

#include <utility>

namespace limitcl {

/// One reference to a handle of the C API. A copy shares the object (it retains), the last one releases it. get() is for calls of the C API beside this one.
template <class C, void (*Retain)(C), void (*Release)(C)>
class Handle {
public:
    Handle() = default;
    /// Takes over the reference that the caller has.
    explicit Handle(C handle) : handle_(handle) {}
    Handle(const Handle& other) : handle_(other.handle_) {
        if (handle_) Retain(handle_);
    }
    Handle(Handle&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
    Handle& operator=(Handle other) noexcept {
        std::swap(handle_, other.handle_);
        return *this;
    }
    ~Handle() { Release(handle_); }

    C get() const { return handle_; }
    explicit operator bool() const { return handle_ != nullptr; }

private:
    C handle_ = nullptr;
};

using ContextHandle = Handle<lcl_context, lcl_context_retain, lcl_context_release>;
using MeshHandle = Handle<lcl_mesh, lcl_mesh_retain, lcl_mesh_release>;
using OperatorHandle = Handle<lcl_operator, lcl_operator_retain, lcl_operator_release>;
using FieldHandle = Handle<lcl_field, lcl_field_retain, lcl_field_release>;
using RefinerHandle = Handle<lcl_refiner, lcl_refiner_retain, lcl_refiner_release>;
using TangentsHandle = Handle<lcl_tangents, lcl_tangents_retain, lcl_tangents_release>;
using LimitSurfaceHandle = Handle<lcl_limit_surface, lcl_limit_surface_retain, lcl_limit_surface_release>;
using SamplesHandle = Handle<lcl_samples, lcl_samples_retain, lcl_samples_release>;
using CloudHandle = Handle<lcl_cloud, lcl_cloud_retain, lcl_cloud_release>;

}  // namespace limitcl

#endif
