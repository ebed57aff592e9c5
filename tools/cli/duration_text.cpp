#include "tools/cli/duration_text.h"

#include <charconv>
#include <string>
#include <utility>

#include "octree/builder/mesh/stream/mesh_text.h"

namespace planetree::tools {

Result<std::uint64_t> parse_latency(std::string_view text) {
  constexpr std::pair<std::string_view, double> kUnits[] = {
      {"ns", 1}, {"us", 1e3}, {"ms", 1e6}, {"s", 1e9}};
  constexpr double kMaxNs = 1e10;
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, failed] = std::from_chars(text.data(), end, value);
  const std::string_view unit(rest, static_cast<std::size_t>(end - rest));
  for (const auto& [name, ns] : kUnits)
    if (failed == std::errc() && unit == name && value >= 0 && value * ns <= kMaxNs)
      return static_cast<std::uint64_t>(value * ns + 0.5);
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                    "'%s' is no latency; give a time up to 10s, such as 85us",
                    octree::printable(text.substr(0, 40)).c_str());
}

}  // namespace planetree::tools
