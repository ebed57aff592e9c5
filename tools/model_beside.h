#pragma once

#include <cstdint>
#include <filesystem>

#include "planetree/error.h"
#include "planetree/model.h"
#include "tools/cli/subcommand.h"

namespace planetree::tools {

/// Opens a model as open_model() does, for a command that takes memory of its own out of --memory.
/// The model gets the rest, and at least half.
///
/// own_bytes     of the command
/// memory_bytes  of --memory
/// options       the memory budget is ignored
/// errors        as open_model(); if the memory is too little, the text says what --memory must be
Result<Model> open_model_beside(std::uint64_t own_bytes, std::uint64_t memory_bytes,
                                const std::filesystem::path& path, OpenOptions options,
                                Console& console);

}  // namespace planetree::tools
