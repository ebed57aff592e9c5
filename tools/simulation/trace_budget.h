#pragma once

#include <cstdint>
#include <filesystem>

#include "planetree/error.h"
#include "planetree/model.h"

namespace planetree::tools {

/// The memory budget with which a model that keeps a page trace has as many frames as it has
/// without one within `options.memory_budget_bytes`.
///
/// options  with the capacity of the trace
/// errors   as Model::open; if the memory is too little, the text has the amount without the trace
Result<std::uint64_t> budget_with_trace(const std::filesystem::path& path,
                                        const OpenOptions& options);

}  // namespace planetree::tools
