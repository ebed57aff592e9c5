#pragma once

#include <array>
#include <cstdint>
#include <utility>

#include "cache/reader.h"
#include "query/model_state.h"
#include "query/side_memory.h"

namespace planetree::query {

/// What stands behind a Probe.
class ProbeState {
 public:
  ProbeState(const ModelState& model, cache::Reader reader) noexcept
      : model_(model), reader_(std::move(reader)) {}

  const ModelState& model() const noexcept { return model_; }
  cache::Reader& reader() noexcept { return reader_; }

  octree::Vicinity& vicinity() noexcept { return vicinity_; }
  SideMemory& side_memory() noexcept { return side_memory_; }

  /// Queries of a batch that are put in order together.
  static constexpr std::size_t kBatchQueries = 1024;
  struct BatchEntry {
    std::uint64_t code;   ///< Morton code of the query
    std::uint32_t index;  ///< in the caller's spans
  };
  std::array<BatchEntry, kBatchQueries>& batch() noexcept { return batch_; }

 private:
  const ModelState& model_;
  cache::Reader reader_;
  octree::Vicinity vicinity_;
  SideMemory side_memory_;
  std::array<BatchEntry, kBatchQueries> batch_;
};

}  // namespace planetree::query
