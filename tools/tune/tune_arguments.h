#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/cli/report_page.h"
#include "tools/tune/lookup_export.h"
#include "tools/tune/tune_goal.h"

namespace planetree::tools {

/// Arguments of `planetree tune`.
struct TuneArguments {
  std::vector<std::filesystem::path> traces;
  std::filesystem::path model;   ///< whose sessions are replayed; empty: that of the first trace
  std::optional<TuneGoal> goal;  ///< what to recommend memory for
  std::string goal_text;         ///< as given
  std::optional<std::uint64_t> latency_ns;            ///< of a page; nothing: as the trace says
  std::vector<std::uint64_t> page_sizes;              ///< to compare, bytes
  std::optional<LookupExport::Format> export_format;  ///< export lookups instead of a report
  PageChoice page;                                    ///< page to write
  bool json = false;
  bool quiet = false;
};

/// The command that measures the same and writes the page again, as typed in a shell. Options that
/// have their defaults are left out.
std::string tune_command(const TuneArguments& arguments);

/// Reads page sizes such as 16K,64K,256K: powers of two from 4 KiB to 256 KiB.
Result<std::vector<std::uint64_t>> parse_page_sizes(std::string_view text);

}  // namespace planetree::tools
