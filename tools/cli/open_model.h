#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "planetree/error.h"
#include "planetree/model.h"
#include "planetree/stats.h"
#include "tools/cli/subcommand.h"

namespace planetree::tools {

/// Opens a model with one probe. Warns if one of the file's headers is damaged.
///
/// memory_bytes   OpenOptions::memory_budget_bytes
/// batch_threads  number of batch threads; 0 means one for each processor
/// wait_limit_ms  OpenOptions::wait_limit_ms
/// errors         as Model::open
Result<Model> open_model(const std::filesystem::path& path, std::uint64_t memory_bytes,
                         Console& console, unsigned batch_threads = 1,
                         unsigned wait_limit_ms = OpenOptions().wait_limit_ms);

/// The error to report after the answers if pages were unreadable or did not come in time, so that
/// answers are degraded. Empty if there were none.
std::optional<Error> pages_lost(const Stats& stats);

}  // namespace planetree::tools
