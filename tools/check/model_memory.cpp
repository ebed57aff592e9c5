#include "tools/check/model_memory.h"

#include <algorithm>

#include "query/model_state.h"

namespace planetree::tools {

Result<std::uint64_t> least_memory(const std::filesystem::path& path, const OpenOptions& options) {
  return query::ModelState::min_budget_bytes(path, options);
}

Result<std::uint64_t> memory_without_limit(std::uint64_t usual_bytes,
                                           const std::filesystem::path& path,
                                           const OpenOptions& options) {
  const auto least = least_memory(path, options);
  if (!least) return least.error();
  return std::max(usual_bytes, *least);
}

}  // namespace planetree::tools
