#pragma once

#include <optional>
#include <string_view>

namespace planetree::octree {

/// A format that no reader here reads.
struct ForeignFormat {
  std::string_view name;    ///< with its article, such as "a glTF file"
  std::string_view remedy;  ///< what to do instead
};

/// Recognises a format by the first bytes of a file, so that a refusal can name it.
///
/// file    the first 4 KiB of the file, or all of it.
/// return  nothing for a mesh that a reader here may read, and for unknown bytes.
std::optional<ForeignFormat> foreign_format(std::string_view file) noexcept;

}  // namespace planetree::octree
