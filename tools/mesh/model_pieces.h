#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "planetree/error.h"
#include "tools/mesh/mesh_pieces.h"

namespace planetree::tools {

/// Reads the triangles of a .ptree file, page by page, and gives them to `maker`. Triangles near
/// each other come one after the other.
///
/// progress  called with the number of triangles read since the last call
/// errors    those of FileParts::open() and of MeshPieceMaker; kDamaged: a page cannot be read
Result<void> read_model_pieces(const std::filesystem::path& path, MeshPieceMaker& maker,
                               const std::function<void(std::uint64_t)>& progress);

}  // namespace planetree::tools
