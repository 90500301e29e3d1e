// SPDX-License-Identifier: BSD-3-Clause
// The limit surface of a mesh as patches: control points, kinds, and where a place (face, corner, u, v) lies.
//
// The mesh is refined explicitly until no patch has more than one extraordinary vertex (Doo-Sabin: face) and none but its corner (0, 0) touches sharp features
// irregularly: Catmull-Clark twice (once where all faces are quads), Loop once, Doo-Sabin twice. alpha rules the first refinement.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "host/array.h"
#include "host/evaluate/patch_kind.h"
#include "host/mesh/features.h"
#include "host/mesh/topology.h"
#include "host/refine/refiner.h"

namespace lcl {

/// Derivatives by (u, v) from those by the patch's (s, t): S_u = su S_s + tu S_t, S_v = sv S_s + tv S_t.
struct ParameterTurn {
    double su = 1, tu = 0, sv = 0, tv = 1;
};

/// A place inside a patch.
struct PatchPlace {
    double s = 0, t = 0;
    Index patch = 0;
    std::int32_t turn = 0;  ///< of PatchTable::turns
};

/// Places as a caller gives them: limitcl.h, "the limit surface itself". corners may be null: all 0.
struct Places {
    std::size_t count = 0;
    const Index* faces = nullptr;
    const Index* corners = nullptr;
    const double* uv = nullptr;

    Index corner(std::size_t i) const { return corners != nullptr ? corners[i] : 0; }
};

struct PatchTable {
    Scheme scheme = Scheme::catmull_clark;
    Index point_count = 0;                   ///< points of the mesh
    std::shared_ptr<const Refiner> refiner;  ///< the explicit refinements: points of the refined mesh
    Stencils ghosts;                         ///< rows over the points of the refined mesh: points across sharp edges, which follow them as control points
    Array<Index> control;                    ///< numbers of the control points of every patch, one patch after the other
    std::vector<Index> patch_begin;          ///< patch_count + 1, in `control`
    std::vector<std::int32_t> kind;          ///< patch_count: -1 regular, else of `kinds`
    std::vector<PatchKind> kinds;            ///< each is used
    std::vector<ParameterTurn> turns;
    // What locating needs.
    std::vector<Index> face_begin;        ///< face_count + 1: first corner of each face of the mesh
    std::vector<Index> patch_of_quarter;  ///< Doo-Sabin: patches of the quarters of every vertex of the once refined mesh: towards (1,1), (1,0), (0,0), (0,1)
    std::vector<Index> squares_beyond;    ///< Doo-Sabin with sharp edges: three per corner, as square_beyond() gives them

    /// Doo-Sabin: the vertex of the once refined mesh whose square lies at a corner of the mesh beyond v = 0 (side 0), u = 0 (1) or both (2), -1 if there is
    /// none.
    Index square_beyond(Index corner, int side) const { return squares_beyond.empty() ? -1 : squares_beyond[3 * static_cast<std::size_t>(corner) + side]; }
    Index patch_count() const { return static_cast<Index>(patch_begin.size()) - 1; }
    int levels() const { return refiner->levels(); }
    Index face_count() const { return static_cast<Index>(face_begin.size()) - 1; }
    Index degree(Index face) const { return face_begin[face + 1] - face_begin[face]; }
    Index refined_count() const { return refiner->vertex_count(); }
    Index control_count() const { return refined_count() + static_cast<Index>(ghosts.offsets.size() - 1); }
};

/// lambda of `options` must be 0. Linear time. BadInput as refine_once.
PatchTable build_patch_table(const Topology& topology, const Features& features, const SchemeOptions& options);

/// Refuses tables of more control points than can be numbered (OutOfMemory).
void check_control_count(std::int64_t count);

/// "place 17: ", "corner 2 of face 3".
std::string place_name(std::size_t i);
std::string corner_name(const Places& places, std::size_t i);
/// Refuse a place whose face, or whose corner among the face's, does not exist (BadInput).
void check_face(const PatchTable& table, const Places& places, std::size_t i);
void check_corner(const PatchTable& table, const Places& places, std::size_t i);

/// Finds places begin .. end - 1 of `places`; out: one each, from out[0] on. BadInput "place 17: ..." for the first that does not exist; not finite (u, v) do
/// not exist.
void locate(const PatchTable& table, const Places& places, std::size_t begin, std::size_t end, PatchPlace* out);

/// All control points (control_count x channels) from the mesh's points (point_count x channels), in double on the host.
std::vector<double> control_points(const PatchTable& table, const std::vector<double>& points, int channels);

/// Of each scheme: fills the table (all but scheme and point_count), and locates.
void add_catmull_clark_patches(const Topology& topology, const Features& features, const SchemeOptions& options, PatchTable& table);
void add_loop_patches(const Topology& topology, const Features& features, const SchemeOptions& options, PatchTable& table);
void add_doo_sabin_patches(const Topology& topology, const Features& features, const SchemeOptions& options, PatchTable& table);
void locate_catmull_clark(const PatchTable& table, const Places& places, std::size_t begin, std::size_t end, PatchPlace* out);
void locate_loop(const PatchTable& table, const Places& places, std::size_t begin, std::size_t end, PatchPlace* out);
void locate_doo_sabin(const PatchTable& table, const Places& places, std::size_t begin, std::size_t end, PatchPlace* out);

}  // namespace lcl
