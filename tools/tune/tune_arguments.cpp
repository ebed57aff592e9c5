#include "tools/tune/tune_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "tools/cli/shell_word.h"
#include "tools/cli/size_text.h"

namespace planetree::tools {
namespace {

Error refusal(const std::string& text) {
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere, "%s", text.c_str());
}

}  // namespace

std::string tune_command(const TuneArguments& arguments) {
  std::string text = "planetree tune";
  for (const auto& trace : arguments.traces) text += " " + shell_word(trace.string());
  if (!arguments.model.empty()) text += " --model " + shell_word(arguments.model.string());
  if (arguments.goal) text += " --recommend " + shell_word(arguments.goal_text);
  if (arguments.latency_ns) text += fmt::format(" --latency {}ns", *arguments.latency_ns);
  for (std::size_t i = 0; i < arguments.page_sizes.size(); ++i)
    text += fmt::format("{}{}", i == 0 ? " --pages " : ",", arguments.page_sizes[i]);
  return text + " --html " + shell_word(arguments.page.html.string()) + " --force";
}

Result<std::vector<std::uint64_t>> parse_page_sizes(std::string_view text) {
  constexpr std::uint64_t kMin = 4096, kMax = 262144;
  std::vector<std::uint64_t> sizes;
  for (;;) {
    const std::size_t comma = std::min(text.find(','), text.size());
    const auto bytes = parse_bytes(text.substr(0, comma));
    if (!bytes || !std::has_single_bit(*bytes) || *bytes < kMin || *bytes > kMax)
      return refusal(
          fmt::format("'{:.40}' is no page size; give powers of two from 4K to 256K, "
                      "such as 16K,64K,256K",
                      text.substr(0, comma)));
    sizes.push_back(*bytes);
    if (comma == text.size()) return sizes;
    text.remove_prefix(comma + 1);
  }
}

}  // namespace planetree::tools
