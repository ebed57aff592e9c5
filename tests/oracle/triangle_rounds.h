#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "octree/builder/mesh/mesh_reader.h"
#include "tests/oracle/brute_force.h"

namespace planetree::oracle {

/// Passes a mesh on in rounds, so that at most one round of it is in memory.
class TriangleRounds : public octree::TriangleSink {
 public:
  explicit TriangleRounds(std::size_t most) : max_(most) {}

  Result<void> triangle(std::uint64_t index, const Corners& corners) final {
    indices_.push_back(index);
    triangles_.push_back(corners);
    if (triangles_.size() == max_) finish_round();
    return {};
  }
  void skipped(std::uint64_t, std::uint64_t, const octree::SkippedRecord&) final {}
  Result<void> progress(std::uint64_t, std::uint64_t) final { return {}; }

  /// Passes on the last round. Call it once the mesh is read.
  void finish() {
    if (!triangles_.empty()) finish_round();
  }
  [[nodiscard]] std::uint64_t triangle_count() const { return count_; }

 protected:
  /// Takes one round: at least one triangle; indices ascend.
  virtual void take(std::span<const Corners> triangles, std::span<const std::uint64_t> indices) = 0;

 private:
  void finish_round() {
    count_ += triangles_.size();
    take(triangles_, indices_);
    triangles_.clear();
    indices_.clear();
  }

  std::size_t max_;
  std::uint64_t count_ = 0;
  std::vector<Corners> triangles_;
  std::vector<std::uint64_t> indices_;
};

}  // namespace planetree::oracle
