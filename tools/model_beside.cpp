#include "tools/model_beside.h"

#include <algorithm>

#include "tools/check/model_memory.h"
#include "tools/cli/open_model.h"

namespace planetree::tools {

Result<Model> open_model_beside(std::uint64_t own_bytes, std::uint64_t memory_bytes,
                                const std::filesystem::path& path, OpenOptions options,
                                Console& console) {
  options.memory_budget_bytes =
      std::max(memory_bytes / 2, memory_bytes - std::min(memory_bytes, own_bytes));
  options.max_probes = 1;
  options.batch_threads = batch_threads_of(options.batch_threads);
  const auto least = least_memory(path, options);
  if (!least) return least.error();
  if (options.memory_budget_bytes < *least)
    return too_little_memory(memory_bytes, *least + std::min(*least, own_bytes));
  return open_model(path, options, console);
}

}  // namespace planetree::tools
