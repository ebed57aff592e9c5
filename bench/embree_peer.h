#pragma once

#include "bench/peer.h"

namespace planetree::bench {

/// Embree 3: its point query for distances, the parity of all hits of a ray for sides.
class EmbreePeer final : public Peer {
 public:
  explicit EmbreePeer(const PeerMesh& mesh);
  ~EmbreePeer() override;

  [[nodiscard]] std::string name() const override { return "Embree"; }
  double distance(const Vec3& query) override;
  bool inside(const Vec3& query) override;
  [[nodiscard]] std::uint64_t mapped_bytes() const override;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace planetree::bench
