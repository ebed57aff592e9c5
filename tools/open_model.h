#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "planetree/error.h"
#include "planetree/model.h"
#include "planetree/stats.h"
#include "tools/verb.h"

namespace planetree::tools {

/// Opens a model for one probe; warns if one of its headers is damaged.
///
/// memory_bytes   most memory it may take
/// batch_threads  threads that answer batches; 0 means one for each processor
/// errors         as Model::open
Result<Model> open_model(const std::filesystem::path& path, std::uint64_t memory_bytes,
                         Console& console, unsigned batch_threads = 1);

/// The error to tell, after the answers, if pages could not be read.
std::optional<Error> unreadable_pages(const Stats& stats);

}  // namespace planetree::tools
