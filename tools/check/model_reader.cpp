#include "tools/check/model_reader.h"

#include <cstdint>
#include <utility>

#include "tools/check/model_memory.h"

namespace planetree::tools {
namespace {

constexpr std::uint64_t kMemoryBytes = std::uint64_t{256} << 20;

}  // namespace

Result<ModelReader> ModelReader::open(const std::filesystem::path& path) {
  OpenOptions options;
  options.max_probes = 1;
  const auto memory = memory_without_limit(kMemoryBytes, path, options);
  if (!memory) return memory.error();
  options.memory_budget_bytes = *memory;
  auto model = query::ModelState::open(path, options);
  if (!model) return model.error();
  auto reader = (*model)->claim_reader();
  if (!reader) return reader.error();
  return ModelReader{*std::move(model), *std::move(reader)};
}

}  // namespace planetree::tools
