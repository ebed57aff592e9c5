#pragma once

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "planetree/model.h"

namespace planetree {

/// The minimum budget that a model opens with, as the error names it; 0 if it opens with any.
inline std::uint64_t least_memory_bytes(const std::filesystem::path& file, OpenOptions options) {
  options.memory_budget_bytes = 1;
  const auto refused = Model::open(file, options);
  const std::string text = refused ? "" : refused.error().text;
  const std::size_t at = text.find("at least ");
  return at == std::string::npos ? 0 : std::strtoull(&text[at + 9], nullptr, 10);
}

}  // namespace planetree
