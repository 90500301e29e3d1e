// SPDX-License-Identifier: BSD-3-Clause
// What the handles of limit surfaces point at.
#pragma once

#include <utility>
#include <vector>

#include "host/capi/handles.h"
#include "host/evaluate/closest.h"

struct lcl_limit_surface_s : lcl::Counted {
    lcl::Reference<lcl_context_s> context;
    lcl::DeviceSurface surface;
    std::unique_ptr<lcl::ClosestSearch> search;  // made by the first search

    lcl_limit_surface_s(lcl_context_s* owner, lcl::DeviceSurface made) : context(lcl::share(owner)), surface(std::move(made)) {}
};

struct lcl_samples_s : lcl::Counted {
    lcl::Reference<lcl_limit_surface_s> surface;
    std::vector<lcl::SamplePiece> pieces;

    explicit lcl_samples_s(lcl_limit_surface_s* of) : surface(lcl::share(of)) {}
};
