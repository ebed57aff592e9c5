#pragma once

#include "bench/peer.h"

namespace planetree::bench {

/// CGAL's AABB tree with double coordinates and exact predicates.
class CgalPeer final : public Peer {
 public:
  explicit CgalPeer(const PeerMesh& mesh);
  ~CgalPeer() override;

  [[nodiscard]] std::string name() const override { return "CGAL"; }
  double distance(const Vec3& query) override;
  /// By Side_of_triangle_mesh: of a closed mesh, exactly. On the surface is inside.
  bool inside(const Vec3& query) override;

 private:
  class Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace planetree::bench
