#include "bench/peer.h"

#include <malloc.h>

#include <array>
#include <chrono>
#include <unordered_map>

#include "bench/peer_kinds.h"
#include "octree/builder/mesh/mesh_reader.h"

namespace planetree::bench {
namespace {

struct PositionHash {
  std::size_t operator()(const std::array<float, 3>& position) const {
    std::size_t hash = 0;
    for (const float value : position) hash = hash * 1000003 ^ std::hash<float>()(value);
    return hash;
  }
};

class MeshCollector final : public octree::TriangleSink {
 public:
  Result<void> triangle(std::uint64_t, const std::array<Vec3, 3>& corners) override {
    for (const Vec3& corner : corners) mesh.corners.push_back(vertex(corner));
    return {};
  }
  void skipped(std::uint64_t, std::uint64_t, const octree::SkippedRecord&) override {}
  Result<void> progress(std::uint64_t, std::uint64_t) override { return {}; }

  PeerMesh mesh;

 private:
  std::uint32_t vertex(const Vec3& corner) {
    const std::array<float, 3> position{static_cast<float>(corner.x), static_cast<float>(corner.y),
                                        static_cast<float>(corner.z)};
    const auto next = static_cast<std::uint32_t>(mesh.positions.size() / 3);
    const auto [at, is_new] = vertices_.try_emplace(position, next);
    if (is_new) mesh.positions.insert(mesh.positions.end(), position.begin(), position.end());
    return at->second;
  }

  std::unordered_map<std::array<float, 3>, std::uint32_t, PositionHash> vertices_;
};

std::uint64_t heap_bytes() {
  const struct mallinfo2 heap = mallinfo2();
  return heap.uordblks + heap.hblkhd;
}

std::unique_ptr<Peer> make_peer(const std::string& name, const PeerMesh& mesh) {
  if (name == "embree") return make_embree_peer(mesh);
  if (name == "cgal") return make_cgal_peer(mesh);
  if (name == "fcl") return make_fcl_peer(mesh);
  return nullptr;
}

}  // namespace

Result<PeerMesh> read_peer_mesh(const char* path) {
  MeshCollector collector;
  if (const auto read = octree::read_mesh(path, collector); !read) return read.error();
  return std::move(collector.mesh);
}

Result<std::vector<BuiltPeer>> build_peers(std::span<const std::string> names,
                                           const PeerMesh& mesh) {
  std::vector<BuiltPeer> built;
  for (const std::string& name : names) {
    const std::uint64_t before = heap_bytes();
    const auto start = std::chrono::steady_clock::now();
    BuiltPeer peer{.peer = make_peer(name, mesh)};
    if (!peer.peer)
      return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                        "there is no peer '%s'; peers are embree, cgal and fcl", name.c_str());
    peer.build_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    peer.bytes = heap_bytes() - before + peer.peer->mapped_bytes();
    built.push_back(std::move(peer));
  }
  return built;
}

}  // namespace planetree::bench
