#pragma once

#include "bench/peer.h"

namespace planetree::bench {

/// FCL's bounding volume hierarchy, asked for the distance of a sphere without radius.
class FclPeer final : public Peer {
 public:
  explicit FclPeer(const PeerMesh& mesh);
  ~FclPeer() override;

  [[nodiscard]] std::string name() const override { return "FCL"; }
  double distance(const Vec3& query) override;
  [[nodiscard]] bool tells_sides() const override { return false; }
  bool inside(const Vec3& query) override;

 private:
  class Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace planetree::bench
