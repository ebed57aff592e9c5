#include "tools/cli/file_text.h"

#include <fmt/format.h>

#include <charconv>

#include "octree/geometry/octcode.h"

namespace planetree::tools {
namespace {

/// Removes a number from the front of `text`. False if there is none or it does not fit T.
template <class T>
bool take_number(std::string_view& text, T& value, int base = 10) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (error != std::errc()) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

bool take_separator(std::string_view& text) {
  if (!text.starts_with(':') && !text.starts_with('/')) return false;
  text.remove_prefix(1);
  return true;
}

}  // namespace

std::string content_id_text(std::span<const std::uint64_t, 2> id) {
  return fmt::format("{:016x}{:016x}", id[1], id[0]);
}

std::string format_version_text(std::uint16_t version) {
  return fmt::format("{}.{}", version / 256, version % 256);
}

std::string cell_text(std::uint64_t octcode) {
  const octree::Cell cell = octree::cell_of_octcode(octcode);
  const std::string within = cell.within > 0 ? fmt::format("+{}", cell.within) : std::string();
  return fmt::format("{}/{}/{}/{}{}", cell.level, cell.x, cell.y, cell.z, within);
}

std::optional<OctcodeQuery> OctcodeQuery::parse(std::string_view text) {
  OctcodeQuery query;
  if (text.starts_with("0x") || text.starts_with("0X")) {
    text.remove_prefix(2);
    std::uint64_t octcode = 0;
    if (!take_number(text, octcode, 16) || !text.empty()) return std::nullopt;
    query.octcode = octcode;
    return query;
  }
  const bool has_cell = take_number(text, query.level) && take_separator(text) &&
                        take_number(text, query.x) && take_separator(text) &&
                        take_number(text, query.y) && take_separator(text) &&
                        take_number(text, query.z);
  if (!has_cell || query.level > octree::kLevels) return std::nullopt;
  if (text.empty()) return query;
  unsigned within = 0;
  if (!text.starts_with('+')) return std::nullopt;
  text.remove_prefix(1);
  if (!take_number(text, within) || !text.empty() || within > 2) return std::nullopt;
  query.within = within;
  return query;
}

bool OctcodeQuery::matches(std::uint64_t other) const {
  if (octcode) return *octcode == other;
  const octree::Cell cell = octree::cell_of_octcode(other);
  return cell.level == level && cell.x == x && cell.y == y && cell.z == z &&
         (!within || *within == cell.within);
}

}  // namespace planetree::tools
