#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "planetree/error.h"
#include "planetree/types.h"

/// Others that say how far a mesh is and whether a point is inside it: all of them
/// hold the mesh in memory.
namespace planetree::bench {

/// A mesh as the peers take it: corners at one position are one vertex.
struct PeerMesh {
  std::vector<float> positions;        ///< three a vertex
  std::vector<std::uint32_t> corners;  ///< three vertices a triangle

  [[nodiscard]] std::size_t triangles() const { return corners.size() / 3; }
};

/// The mesh of a file that `planetree build` reads.
Result<PeerMesh> read_peer_mesh(const char* path);

/// What a peer answers. One thread.
class Peer {
 public:
  Peer() = default;
  virtual ~Peer() = default;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  [[nodiscard]] virtual std::string name() const = 0;
  /// Distance to the nearest triangle, as the peer's users compute it.
  virtual double distance(const Vec3& query) = 0;
  /// Whether it tells sides at all; if not, `inside` is not asked.
  [[nodiscard]] virtual bool tells_sides() const { return true; }
  virtual bool inside(const Vec3& query) = 0;
  /// Memory that it holds beside the heap.
  [[nodiscard]] virtual std::uint64_t mapped_bytes() const { return 0; }
};

/// A peer that was built, and what that took.
struct BuiltPeer {
  std::unique_ptr<Peer> peer;
  double build_s = 0;       ///< by the wall clock, the mesh in memory already
  std::uint64_t bytes = 0;  ///< of memory that it holds, its copy of the mesh included
};

/// Builds peers by their names: embree, cgal, fcl. An unknown name is kBadArgument.
/// `mesh` must outlive them.
Result<std::vector<BuiltPeer>> build_peers(std::span<const std::string> names,
                                           const PeerMesh& mesh);

}  // namespace planetree::bench
