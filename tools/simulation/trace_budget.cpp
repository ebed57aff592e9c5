#include "tools/simulation/trace_budget.h"

#include "query/model_state.h"
#include "tools/cli/open_model.h"

namespace planetree::tools {

Result<std::uint64_t> budget_with_trace(const std::filesystem::path& path,
                                        const OpenOptions& options) {
  OpenOptions without = options;
  without.page_trace_capacity = 0;
  const auto least = query::ModelState::min_budget_bytes(path, without);
  if (!least) return least.error();
  if (options.memory_budget_bytes < *least)
    return too_little_memory(options.memory_budget_bytes, *least);
  const auto least_traced = query::ModelState::min_budget_bytes(path, options);
  if (!least_traced) return least_traced.error();
  return options.memory_budget_bytes + (*least_traced - *least);
}

}  // namespace planetree::tools
