#include "bench/embree_peer.h"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>

#include <embree3/rtcore.h>

namespace planetree::bench {
namespace {

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

struct VertexHash {
  std::size_t operator()(const std::array<float, 3>& v) const {
    std::size_t hash = 0;
    for (const float value : v) hash = hash * 1000003 ^ std::hash<float>()(value);
    return hash;
  }
};

bool count_bytes(void* total, std::ptrdiff_t bytes, bool) {
  *static_cast<std::int64_t*>(total) += bytes;
  return true;
}

}  // namespace

struct EmbreePeer::Scene {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<Float3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::int64_t bytes = 0;
};

EmbreePeer::EmbreePeer(const std::vector<float>& corners) : scene_(std::make_unique<Scene>()) {
  std::unordered_map<std::array<float, 3>, std::uint32_t, VertexHash> index;
  index.reserve(corners.size() / 12);
  for (std::size_t i = 0; i < corners.size(); i += 9) {
    std::array<std::uint32_t, 3> triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::array<float, 3> v{corners[i + 3 * k], corners[i + 3 * k + 1],
                                   corners[i + 3 * k + 2]};
      const auto next = static_cast<std::uint32_t>(scene_->vertices.size());
      const auto [at, is_new] = index.try_emplace(v, next);
      if (is_new) scene_->vertices.push_back({v[0], v[1], v[2]});
      triangle[k] = at->second;
    }
    scene_->triangles.push_back(triangle);
  }
  scene_->vertices.push_back({0, 0, 0});  // Embree reads 16 bytes a vertex
  scene_->device = rtcNewDevice("threads=1");
  rtcSetDeviceMemoryMonitorFunction(scene_->device, count_bytes, &scene_->bytes);
  scene_->scene = rtcNewScene(scene_->device);
  rtcSetSceneBuildQuality(scene_->scene, RTC_BUILD_QUALITY_MEDIUM);
  RTCGeometry geometry = rtcNewGeometry(scene_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             scene_->vertices.data(), 0, sizeof(Float3),
                             scene_->vertices.size() - 1);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             scene_->triangles.data(), 0, 12, scene_->triangles.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_->scene);
}

EmbreePeer::~EmbreePeer() {
  rtcReleaseScene(scene_->scene);
  rtcReleaseDevice(scene_->device);
}

double EmbreePeer::distance(const Vec3& query) const {
  RTCPointQuery point{static_cast<float>(query.x), static_cast<float>(query.y),
                      static_cast<float>(query.z), 0, std::numeric_limits<float>::infinity()};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  const auto visit = [](RTCPointQueryFunctionArguments* arguments) {
    const auto& scene = *static_cast<const Scene*>(arguments->userPtr);
    const auto& triangle = scene.triangles[arguments->primID];
    const Float3 p{arguments->query->x, arguments->query->y, arguments->query->z};
    const Float3 nearest = nearest_on_triangle(
        p, scene.vertices[triangle[0]], scene.vertices[triangle[1]], scene.vertices[triangle[2]]);
    const Float3 off = p - nearest;
    const float distance = std::sqrt(dot(off, off));
    if (!(distance < arguments->query->radius)) return false;
    arguments->query->radius = distance;
    return true;
  };
  rtcPointQuery(scene_->scene, &point, &context, visit, scene_.get());
  return point.radius;
}

std::uint64_t EmbreePeer::bytes() const {
  return static_cast<std::uint64_t>(scene_->bytes) + scene_->vertices.size() * sizeof(Float3) +
         scene_->triangles.size() * 12;
}

}  // namespace planetree::bench
