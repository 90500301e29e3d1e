// SPDX-License-Identifier: BSD-3-Clause
// The part of the self-test that evaluates limit surfaces.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "host/device/device.h"
#include "host/field/field.h"
#include "host/selftest/selftest.h"

namespace lcl {

/// Points and derivatives of a surface on the device, at places in every face and next to its vertices, against the plain evaluator in
/// double; with the outer rings of irregular patches as they are, and as regular patches.
bool check_surface(const std::shared_ptr<Context>& context, const std::string& name, const PolygonMesh& mesh, const FeatureOptions& features,
                   const SchemeOptions& scheme, Real real, const std::function<void(const SelftestResult&)>& report);

}  // namespace lcl
