#include "tools/cli/open_model.h"

#include <algorithm>
#include <cinttypes>

#include "storage/system/processors.h"

namespace planetree::tools {

void add_http_cache(SubcommandOptions& subcommand, SourceChoice& choice) {
  const auto directory =
      subcommand.path("--http-cache", "DIR", choice.directory,
                      "Keep what is read of a URL in this directory, for later commands");
  const auto bytes = SubcommandOptions::default_text(
      subcommand.bytes("--http-cache-size", choice.bytes,
                       "Maximum size of the file in --http-cache; the file is cut if it is larger"),
      "1G");
  subcommand.need(bytes, directory);
}

void add_missing_members(SubcommandOptions& subcommand, SourceChoice& choice) {
  subcommand.flag("--allow-missing", choice.allow_missing,
                  "Open a set of which members are missing. Answers that need one are degraded, "
                  "with intervals that hold; planetree inspect lists the members");
}

unsigned batch_threads_of(unsigned wanted) {
  return wanted != 0 ? wanted
                     : std::min(storage::usable_processors(), OpenOptions::kMaxBatchThreads);
}

Result<Model> open_model(const std::filesystem::path& path, OpenOptions options, Console& console) {
  options.max_probes = 1;
  options.batch_threads = batch_threads_of(options.batch_threads);
  auto model = Model::open(path, options);
  if (model && model->stats().header_copy_damaged)
    console.warn(path.string(),
                 "one of its two headers is damaged; copy the file or build it again");
  return model;
}

Error too_little_memory(std::uint64_t memory_bytes, std::uint64_t least_bytes) {
  return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                    "--memory of %" PRIu64 " bytes is too small: give at least %" PRIu64 " bytes",
                    memory_bytes, least_bytes);
}

std::optional<Error> pages_lost(const Stats& stats, const std::optional<Error>& last) {
  if (stats.quarantined_pages != 0)
    return make_error(ErrorCode::kDamaged, Error::kNowhere, Error::kNowhere,
                      "%" PRIu64 " of its pages cannot be read, so %" PRIu64
                      " answers are degraded; planetree verify names the pages",
                      stats.quarantined_pages, stats.degraded_answers);
  if (stats.waits_given_up != 0 && last)
    return make_error(last->code, last->page, Error::kNowhere,
                      "%" PRIu64 " answers are degraded: %s", stats.degraded_answers, last->text);
  if (stats.waits_given_up != 0)
    return make_error(ErrorCode::kReadFailed, Error::kNowhere, Error::kNowhere,
                      "%" PRIu64 " waits for its pages reached the limit, so %" PRIu64
                      " answers are degraded; query again when the disk is less busy, or let "
                      "planetree query wait longer (--wait-limit)",
                      stats.waits_given_up, stats.degraded_answers);
  return std::nullopt;
}

std::optional<Error> pages_lost(const Model& model) {
  return pages_lost(model.stats(), model.read_error());
}

}  // namespace planetree::tools
