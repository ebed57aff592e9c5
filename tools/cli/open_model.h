#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "planetree/error.h"
#include "planetree/model.h"
#include "planetree/stats.h"
#include "tools/cli/subcommand.h"
#include "tools/cli/subcommand_options.h"

namespace planetree::tools {

/// Where models that are opened by URL keep what they read, and whether a set may lack members.
struct SourceChoice {
  std::filesystem::path directory;  ///< empty: nowhere
  std::uint64_t bytes = OpenOptions{}.http_cache_bytes;
  bool allow_missing = false;

  void apply_to(OpenOptions& options) const {
    options.http_cache = directory;
    options.http_cache_bytes = bytes;
    options.allow_missing_members = allow_missing;
  }
};

/// Declares the options --http-cache and --http-cache-size, which set `choice`.
void add_http_cache(SubcommandOptions& subcommand, SourceChoice& choice);
/// Declares --allow-missing.
void add_missing_members(SubcommandOptions& subcommand, SourceChoice& choice);

/// The number of batch threads: `wanted`, or one for each processor if that is 0.
unsigned batch_threads_of(unsigned wanted);

/// Opens a model with one probe. Warns if one of the file's headers is damaged.
///
/// options  max_probes is ignored; batch_threads may be 0, which means one for each processor
/// errors   as Model::open
Result<Model> open_model(const std::filesystem::path& path, OpenOptions options, Console& console);

/// The error of a model that needs more than the command has.
///
/// memory_bytes  of --memory
/// least_bytes   that --memory must be for the model
Error too_little_memory(std::uint64_t memory_bytes, std::uint64_t least_bytes);

/// The error to report after the answers if pages were unreadable or did not come in time, so that
/// answers are degraded. Empty if there were none.
///
/// last  Model::read_error(), which tells why pages of a URL did not come
std::optional<Error> pages_lost(const Stats& stats, const std::optional<Error>& last);
/// The same for all answers of a model so far.
std::optional<Error> pages_lost(const Model& model);

}  // namespace planetree::tools
