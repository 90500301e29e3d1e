// SPDX-License-Identifier: BSD-3-Clause
// A look at an OM file before OpenMesh reads it.
#pragma once

#include <string>

#include "host/io/format.h"

namespace lcl {

/// What OpenMesh is given to read, and what was left out of it.
struct OmContent {
    std::string bytes;  ///< an OM file of the chunks that are of use, in the order that OpenMesh needs
    Index vertex_count = 0;
    Index face_count = 0;
    bool has_colours = false;
    std::vector<std::string> dropped;  ///< what other chunks held
};

/// OpenMesh believes every count and index of an OM file and writes outside its arrays, or walks round a face for ever, where one is false. So the chunks are
/// walked and checked here: sizes against the file, indices against the counts, half-edges against each other. BadInput names what is wrong and the byte.
OmContent check_om(const InputBytes& input);

}  // namespace lcl
