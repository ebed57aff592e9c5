#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

/// Text forms of values in a .ptree file.
namespace planetree::tools {

/// 32 hexadecimal digits of a 128-bit content id whose low word comes first.
[[nodiscard]] std::string content_id_text(std::span<const std::uint64_t, 2> id);

/// "1.0" of a version of the format.
[[nodiscard]] std::string format_version_text(std::uint16_t version);

/// "level/x/y/z" of the octcode's cell, followed by "+n" for n one-bit splits within it.
[[nodiscard]] std::string cell_text(std::uint64_t octcode);

/// An octcode as typed: all 64 bits in hexadecimal (0x...), or its cell as level:x:y:z or
/// level/x/y/z. Without "+n" a cell matches any number of splits.
struct OctcodeQuery {
  std::optional<std::uint64_t> octcode;  ///< set if typed in hexadecimal, which decides alone
  unsigned level = 0;
  std::uint32_t x = 0, y = 0, z = 0;
  std::optional<unsigned> within;  ///< one-bit splits, 0 to 2; empty: any

  /// Empty if the text is not an octcode.
  static std::optional<OctcodeQuery> parse(std::string_view text);
  [[nodiscard]] bool matches(std::uint64_t octcode) const;
};

}  // namespace planetree::tools
