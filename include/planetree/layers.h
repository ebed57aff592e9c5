#pragma once

#include <cstdint>

/// @file
/// The layers of a file. A program that does without a layer may leave it out when it opens the
/// file (OpenOptions::layers), or when the file is built (BuildOptions::layers). Constants are
/// combined with `|`.

namespace planetree {

/// The tree of the triangles. It tells distances, nearest points, triangles and, by
/// SideRule::kSurface, sides. Every file has it, and every model opens it, so that it need not be
/// named.
inline constexpr std::uint32_t kDistanceLayer = 1;
/// The mask and the caps. They tell sides by SideRule::kSolid. Without this layer these sides are
/// unknown.
inline constexpr std::uint32_t kSideLayer = 2;
/// The coarse field. It saves work of answers within an error, and narrows degraded answers.
/// Without it the intervals of such answers are wider. Exact answers are the same.
inline constexpr std::uint32_t kFieldLayer = 4;
/// The attributes of triangles (planetree/attributes.h), which Model::triangle() reads. Queries
/// read nothing of it. A file has it if it was built with BuildOptions::keep.
inline constexpr std::uint32_t kAttributeLayer = 8;
/// All layers.
inline constexpr std::uint32_t kAllLayers =
    kDistanceLayer | kSideLayer | kFieldLayer | kAttributeLayer;

}  // namespace planetree
