#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "planetree/types.h"

namespace planetree::bench {

/// Embree 3's point queries over a mesh held in memory: the peer.
class EmbreePeer {
 public:
  /// Nine coordinates a triangle.
  explicit EmbreePeer(const std::vector<float>& corners);
  ~EmbreePeer();

  double distance(const Vec3& query) const;
  /// Memory Embree says it holds, the shared vertices and indices included.
  std::uint64_t bytes() const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace planetree::bench
