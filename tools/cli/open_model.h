#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "planetree/error.h"
#include "planetree/model.h"
#include "planetree/stats.h"
#include "tools/cli/subcommand.h"

namespace planetree::tools {

/// Opens a model for one probe; warns if one of its headers is damaged.
///
/// memory_bytes   most memory it may take
/// batch_threads  threads that answer batches; 0 means one for each processor
/// wait_limit_ms  as OpenOptions has it
/// errors         as Model::open
Result<Model> open_model(const std::filesystem::path& path, std::uint64_t memory_bytes,
                         Console& console, unsigned batch_threads = 1,
                         unsigned wait_limit_ms = OpenOptions().wait_limit_ms);

/// The error to tell, after the answers, if some are degraded because pages could not be read,
/// or were not in time.
std::optional<Error> pages_lost(const Stats& stats);

}  // namespace planetree::tools
