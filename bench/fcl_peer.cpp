#include "bench/peer_kinds.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/distance.h>

namespace planetree::bench {
namespace {

using Hierarchy = fcl::BVHModel<fcl::OBBRSSd>;

std::shared_ptr<Hierarchy> hierarchy_of(const PeerMesh& mesh) {
  const auto corner = [&](std::size_t i) {
    const float* const position = &mesh.positions[3 * std::size_t{mesh.corners[i]}];
    return fcl::Vector3d(position[0], position[1], position[2]);
  };
  auto hierarchy = std::make_shared<Hierarchy>();
  hierarchy->beginModel(static_cast<int>(mesh.triangles()));
  for (std::size_t i = 0; i < mesh.corners.size(); i += 3)
    hierarchy->addTriangle(corner(i), corner(i + 1), corner(i + 2));
  hierarchy->endModel();
  return hierarchy;
}

class FclPeer final : public Peer {
 public:
  explicit FclPeer(const PeerMesh& mesh)
      : mesh_(hierarchy_of(mesh)), point_(std::make_shared<fcl::Sphered>(0.0)) {}

  [[nodiscard]] std::string name() const override { return "FCL"; }
  double distance(const Vec3& query) override {
    point_.setTranslation({query.x, query.y, query.z});
    fcl::DistanceResultd result;
    fcl::distance(&mesh_, &point_, fcl::DistanceRequestd(), result);
    return result.min_distance;
  }
  [[nodiscard]] bool tells_sides() const override { return false; }
  bool inside(const Vec3&) override { return false; }

 private:
  fcl::CollisionObjectd mesh_, point_;
};

}  // namespace

std::unique_ptr<Peer> make_fcl_peer(const PeerMesh& mesh) {
  return std::make_unique<FclPeer>(mesh);
}

}  // namespace planetree::bench
