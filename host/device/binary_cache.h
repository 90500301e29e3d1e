// SPDX-License-Identifier: BSD-3-Clause
// Built programs on disk, one file each. A cache that cannot be read or written is no error: programs are then built again.
#pragma once

#include <optional>
#include <string>

namespace lcl {

/// Where binaries go: `asked` if not empty, else LIMITCL_CACHE_DIR, else XDG_CACHE_HOME/limitcl, else HOME/.cache/limitcl, else nowhere (empty). Reads the
/// environment at each call.
std::string cache_directory(const std::string& asked);

/// A folder of binaries by key. The key is any text that says all that the binary depends on; its 128-bit hash is the file's name, and the file holds the whole
/// key, so neither a collision nor a damaged file is ever taken for the binary. Files appear whole (temporary file, then rename): several processes may share a
/// folder.
class BinaryCache {
public:
    explicit BinaryCache(std::string directory) : directory_(std::move(directory)) {}  ///< empty: stores nothing, finds nothing
    std::string path(const std::string& key) const;
    /// The binary stored for `key`; nothing if there is none or the file is damaged.
    std::optional<std::string> load(const std::string& key) const;
    /// Replaces what is stored for `key`; makes the folder if needed. Gives up silently where it cannot write.
    void store(const std::string& key, const std::string& binary) const;

private:
    std::string directory_;
};

}  // namespace lcl
