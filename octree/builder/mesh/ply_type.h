#pragma once

#include <optional>
#include <string_view>

#include "octree/builder/mesh/stream/scalar_type.h"

namespace planetree::octree {

/// The type that the header of a PLY calls `name`, in any case: "uchar", "uint8" or "uint8_t".
/// "long" has 64 bits.
std::optional<ScalarType> ply_type_named(std::string_view name) noexcept;

}  // namespace planetree::octree
