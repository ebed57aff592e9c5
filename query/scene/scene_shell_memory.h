#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "planetree/scene.h"
#include "query/shell/shell_memory.h"
#include "query/shell/sphere_tree.h"

namespace planetree::query {

/// The implementation of SceneShellState: what is known of a shell in some instances.
class SceneShellMemory {
 public:
  /// Throws std::bad_alloc.
  SceneShellMemory(const SphereTree& tree, std::uint32_t instances) : tree_(tree) {
    for (std::uint32_t i = 0; i < instances; ++i)
      entries_.push_back({std::make_unique<ShellMemory>(tree)});
  }

  const SphereTree& tree() const noexcept { return tree_; }

  /// Returns the memory of an instance. If there is none, that which was used earliest becomes its.
  ShellMemory& of(InstanceId instance) noexcept {
    const auto is_its = [instance](const Entry& entry) { return entry.instance == instance; };
    auto entry = std::ranges::find_if(entries_, is_its);
    if (entry == entries_.end()) {
      entry = std::ranges::min_element(entries_, {}, &Entry::last_use);
      entry->memory->forget();
      entry->instance = instance;
    }
    entry->last_use = ++uses_;
    return *entry->memory;
  }
  void forget() noexcept {
    for (Entry& entry : entries_) entry.instance = kNoInstance;
  }

 private:
  struct Entry {
    std::unique_ptr<ShellMemory> memory;
    InstanceId instance = kNoInstance;
    std::uint64_t last_use = 0;
  };

  const SphereTree& tree_;
  std::vector<Entry> entries_;
  std::uint64_t uses_ = 0;
};

}  // namespace planetree::query
