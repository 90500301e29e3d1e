// SPDX-License-Identifier: BSD-3-Clause
// The whole C++ API: RAII classes over the C API of limitcl.h, header-only, C++17. Handles are shared by copies; failures throw limitcl::Error.
//
//     limitcl::Context context;
//     limitcl::Mesh mesh = limitcl::read_mesh("bunny.obj");
//     limitcl::LimitOperator A(context, mesh);
//     limitcl::interpolate(A, mesh).require_ok();   // mesh now holds the control points P with A P = M
//     limitcl::write_mesh(mesh, "control.obj");
//
// limitcl/openmesh.hpp (OpenMesh::PolyMesh) is included on its own.
#ifndef LIMITCL_LIMITCL_HPP
#define LIMITCL_LIMITCL_HPP

#include "device.hpp"
#include "error.hpp"
#include "evaluate.hpp"
#include "expansion.hpp"
#include "io.hpp"
#include "limit_operator.hpp"
#include "mesh.hpp"
#include "points.hpp"
#include "refine.hpp"
#include "scheme.hpp"
#include "solve.hpp"
#include "texture.hpp"
#include "two_phase.hpp"

#endif
