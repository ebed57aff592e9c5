#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "planetree/error.h"

namespace planetree::octree {

/// A face whose vertices are in memory, as FaceVertexJoin needs it.
class IndexedFace {
 public:
  /// vertices         as the file names them; must outlive this.
  /// vertices_before  the number from which negative ones count back.
  IndexedFace(std::uint64_t record, std::span<const std::int64_t> vertices,
              std::int64_t vertices_before = 0)
      : record_(record), vertices_(vertices), vertices_before_(vertices_before) {}

  [[nodiscard]] std::uint64_t record() const { return record_; }
  [[nodiscard]] std::uint64_t size() const { return vertices_.size(); }
  bool value_at(std::uint64_t k, std::int64_t& value) const {
    value = vertices_[static_cast<std::size_t>(k)];
    return true;
  }
  [[nodiscard]] std::int64_t vertices_before() const { return vertices_before_; }
  [[nodiscard]] static Error failure() { return {}; }

 private:
  const std::uint64_t record_;
  const std::span<const std::int64_t> vertices_;
  const std::int64_t vertices_before_;
};

}  // namespace planetree::octree
