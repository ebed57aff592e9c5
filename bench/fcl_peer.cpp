#include "bench/fcl_peer.h"

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

}  // namespace

class FclPeer::Scene {
 public:
  explicit Scene(const PeerMesh& mesh)
      : mesh_(hierarchy_of(mesh)), point_(std::make_shared<fcl::Sphered>(0.0)) {}

  double distance(const Vec3& query) {
    point_.setTranslation({query.x, query.y, query.z});
    fcl::DistanceResultd result;
    fcl::distance(&mesh_, &point_, fcl::DistanceRequestd(), result);
    return result.min_distance;
  }

 private:
  fcl::CollisionObjectd mesh_, point_;
};

FclPeer::FclPeer(const PeerMesh& mesh) : scene_(std::make_unique<Scene>(mesh)) {}
FclPeer::~FclPeer() = default;

double FclPeer::distance(const Vec3& query) { return scene_->distance(query); }

bool FclPeer::inside(const Vec3&) { return false; }

}  // namespace planetree::bench
