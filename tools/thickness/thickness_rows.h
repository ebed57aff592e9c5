#pragma once

#include <span>
#include <string>

#include "tools/thickness/thickness_search.h"

namespace planetree::tools {

/// The header of the rows.
inline constexpr const char* kThicknessHeader = "x,y,z,thickness,lower,upper,qx,qy,qz,status\n";

/// A row of CSV for each point. Numbers are the shortest texts that read back the same. Without a
/// wall the contact is empty.
[[nodiscard]] std::string thickness_rows(std::span<const Vec3> points,
                                         std::span<const WallThickness> walls);

}  // namespace planetree::tools
