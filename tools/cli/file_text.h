#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

/// Values of a .ptree file as people read and type them.
namespace planetree::tools {

/// 32 hexadecimal digits of a 128-bit name whose low word comes first.
[[nodiscard]] std::string content_id_text(std::span<const std::uint64_t, 2> id);

/// "level/x/y/z" of the octcode's cell, with "+n" for n one-bit splits within it.
[[nodiscard]] std::string cell_text(std::uint64_t octcode);

/// An octcode as typed: either all of it in hexadecimal (0x...), or the cell as
/// level:x:y:z or level/x/y/z, with or without "+n".
struct OctcodeQuery {
  std::optional<std::uint64_t> octcode;  ///< if typed in hexadecimal
  unsigned level = 0;
  std::uint32_t x = 0, y = 0, z = 0;
  std::optional<unsigned> within;

  static std::optional<OctcodeQuery> parse(std::string_view text);
  [[nodiscard]] bool matches(std::uint64_t octcode) const;
};

}  // namespace planetree::tools
