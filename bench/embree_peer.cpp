#include "bench/peer_kinds.h"

#include <chrono>
#include <cmath>
#include <limits>

#include <embree3/rtcore.h>

namespace planetree::bench {
namespace {

// Context of a ray: its number of hits.
struct HitCount : RTCIntersectContext {
  unsigned hits = 0;
};

struct Float3 {
  float x, y, z;
};
Float3 operator-(Float3 a, Float3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Float3 operator+(Float3 a, Float3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Float3 operator*(float s, Float3 a) { return {s * a.x, s * a.y, s * a.z}; }
float dot(Float3 a, Float3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// Nearest point of a triangle by Voronoi regions (Ericson, Real-Time Collision
// Detection, 5.1.5), in float as Embree's users write it.
Float3 nearest_on_triangle(Float3 p, Float3 a, Float3 b, Float3 c) {
  const Float3 ab = b - a, ac = c - a, ap = p - a;
  const float d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Float3 bp = p - b;
  const float d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const Float3 cp = p - c;
  const float d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const float scale = 1 / (va + vb + vc);
  return a + vb * scale * ab + vc * scale * ac;
}

// Counts a hit and rejects it, so that the ray continues.
void count_hit(const RTCFilterFunctionNArguments* arguments) {
  arguments->valid[0] = 0;
  ++static_cast<HitCount*>(arguments->context)->hits;
}

bool count_bytes(void* total, std::ptrdiff_t bytes, bool) {
  *static_cast<std::int64_t*>(total) += bytes;
  return true;
}

class EmbreePeer final : public Peer {
 public:
  EmbreePeer(const PeerMesh& mesh, unsigned threads);
  ~EmbreePeer() override {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  [[nodiscard]] std::string name() const override { return "Embree"; }
  [[nodiscard]] double commit_seconds() const { return commit_seconds_; }
  double distance(const Vec3& query) override;
  bool inside(const Vec3& query) override;
  [[nodiscard]] std::uint64_t mapped_bytes() const override {
    return static_cast<std::uint64_t>(bytes_);
  }

 private:
  Float3 corner(unsigned triangle, unsigned k) const {
    const float* const at = &positions_[3 * std::size_t{corners_[3 * std::size_t{triangle} + k]}];
    return {at[0], at[1], at[2]};
  }

  std::vector<float> positions_;
  std::vector<std::uint32_t> corners_;
  RTCDevice device_;
  RTCScene scene_ = nullptr;
  std::int64_t bytes_ = 0;  // memory that Embree reports
  double commit_seconds_ = 0;
};

EmbreePeer::EmbreePeer(const PeerMesh& mesh, unsigned threads)
    : positions_(mesh.positions),
      corners_(mesh.corners),
      device_(rtcNewDevice(("threads=" + std::to_string(threads)).c_str())) {
  const std::size_t vertices = positions_.size() / 3;
  positions_.push_back(0);  // Embree reads 16 bytes a vertex
  rtcSetDeviceMemoryMonitorFunction(device_, count_bytes, &bytes_);
  scene_ = rtcNewScene(device_);
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_MEDIUM);
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             positions_.data(), 0, 12, vertices);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, corners_.data(),
                             0, 12, mesh.triangles());
  rtcSetGeometryIntersectFilterFunction(geometry, count_hit);
  const auto started = std::chrono::steady_clock::now();
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started;
  commit_seconds_ = elapsed.count();
}

double EmbreePeer::distance(const Vec3& query) {
  RTCPointQuery point{static_cast<float>(query.x), static_cast<float>(query.y),
                      static_cast<float>(query.z), 0, std::numeric_limits<float>::infinity()};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  const auto visit = [](RTCPointQueryFunctionArguments* arguments) {
    const auto& peer = *static_cast<const EmbreePeer*>(arguments->userPtr);
    const unsigned triangle = arguments->primID;
    const Float3 p{arguments->query->x, arguments->query->y, arguments->query->z};
    const Float3 nearest = nearest_on_triangle(p, peer.corner(triangle, 0),
                                               peer.corner(triangle, 1), peer.corner(triangle, 2));
    const Float3 off = p - nearest;
    const float distance = std::sqrt(dot(off, off));
    if (!(distance < arguments->query->radius)) return false;
    arguments->query->radius = distance;
    return true;
  };
  rtcPointQuery(scene_, &point, &context, visit, this);
  return point.radius;
}

bool EmbreePeer::inside(const Vec3& query) {
  HitCount context;
  rtcInitIntersectContext(&context);
  RTCRayHit ray{};
  ray.ray.org_x = static_cast<float>(query.x);
  ray.ray.org_y = static_cast<float>(query.y);
  ray.ray.org_z = static_cast<float>(query.z);
  ray.ray.dir_z = 1;
  ray.ray.tfar = std::numeric_limits<float>::infinity();
  ray.ray.mask = ~0U;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_, &context, &ray);
  return context.hits % 2 == 1;
}

}  // namespace

std::unique_ptr<Peer> make_embree_peer(const PeerMesh& mesh) {
  return std::make_unique<EmbreePeer>(mesh, 1);
}

double embree_build_seconds(const PeerMesh& mesh, unsigned threads) {
  return EmbreePeer(mesh, threads).commit_seconds();
}

}  // namespace planetree::bench
