// SPDX-License-Identifier: BSD-3-Clause
// Fields from and to n x c values in a caller's memory and order: permuted, normalised and converted in one pass on all cores.
#pragma once

#include "host/field/field.h"

namespace lcl {

/// All rows of the field from a caller's, transformed as by to_plan_order. Waits.
void upload_rows(const Plan& plan, const Transform& transform, const HostRows& rows, Field& field);
/// The way back, as by from_plan_order.
void download_rows(const Plan& plan, const Transform& transform, const Field& field, const WritableHostRows& rows);

}  // namespace lcl
