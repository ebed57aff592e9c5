#pragma once

#include <cstdint>
#include <filesystem>

#include "planetree/error.h"
#include "planetree/model.h"

/// What a model needs to be opened with, found before that.
namespace planetree::tools {

/// Returns the least memory budget of a model. That of `options` does not matter.
///
/// errors  those of Model::open that do not depend on memory
Result<std::uint64_t> least_memory(const std::filesystem::path& path, const OpenOptions& options);

/// Returns the memory budget of a model for commands that have no --memory: `usual_bytes`, or what
/// the model needs if that is more. Errors as least_memory().
Result<std::uint64_t> memory_without_limit(std::uint64_t usual_bytes,
                                           const std::filesystem::path& path,
                                           const OpenOptions& options);

}  // namespace planetree::tools
