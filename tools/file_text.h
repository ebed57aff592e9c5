#pragma once

#include <cstdint>
#include <span>
#include <string>

/// Values of a .ptree file as people read them.
namespace planetree::tools {

/// 32 hexadecimal digits of a 128-bit name whose low word comes first.
[[nodiscard]] std::string content_id_text(std::span<const std::uint64_t, 2> id);

}  // namespace planetree::tools
