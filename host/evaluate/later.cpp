// placeholder until the other schemes land
#include "host/evaluate/patch_table.h"
namespace lcl {
void add_loop_patches(const PolygonMesh&, const Topology&, const Features&, const SchemeOptions&, PatchTable&) { throw Unsupported("not yet"); }
void add_doo_sabin_patches(const PolygonMesh&, const Topology&, const Features&, const SchemeOptions&, PatchTable&) { throw Unsupported("not yet"); }
void locate_loop(const PatchTable&, const Places&, std::size_t, std::size_t, PatchPlace*) {}
void locate_doo_sabin(const PatchTable&, const Places&, std::size_t, std::size_t, PatchPlace*) {}
}
