#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "planetree/error.h"
#include "planetree/types.h"

/// Peers: other libraries that compute the distance to a mesh and whether a point is inside it. All
/// of them hold the mesh in memory.
namespace planetree::bench {

/// A mesh in the form that peers take. Corners at one position are one vertex.
struct PeerMesh {
  std::vector<float> positions;        ///< three coordinates a vertex
  std::vector<std::uint32_t> corners;  ///< three vertex numbers a triangle

  [[nodiscard]] std::size_t triangles() const { return corners.size() / 3; }
};

/// Reads a mesh file of any format that `planetree build` reads. Coordinates are rounded to float.
Result<PeerMesh> read_peer_mesh(const char* path);

/// Another library, built for one mesh.
///
/// threads  one.
class Peer {
 public:
  Peer() = default;
  virtual ~Peer() = default;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  [[nodiscard]] virtual std::string name() const = 0;
  /// Distance to the nearest triangle, computed as the library's users do.
  virtual double distance(const Vec3& query) = 0;
  /// Whether the peer can compute sides. If not, inside() must not be called.
  [[nodiscard]] virtual bool tells_sides() const { return true; }
  /// Whether the point is inside the mesh.
  virtual bool inside(const Vec3& query) = 0;
  /// Bytes of memory that the peer holds outside of the heap.
  [[nodiscard]] virtual std::uint64_t mapped_bytes() const { return 0; }
};

/// A peer and the cost of building it.
struct BuiltPeer {
  std::unique_ptr<Peer> peer;
  double build_s = 0;       ///< wall-clock time, without reading the mesh
  std::uint64_t bytes = 0;  ///< memory that the peer holds, including its copy of the mesh
};

/// Builds the peers with these names: embree, cgal, fcl. `mesh` must outlive them.
///
/// errors  kBadArgument for an unknown name.
Result<std::vector<BuiltPeer>> build_peers(std::span<const std::string> names,
                                           const PeerMesh& mesh);

}  // namespace planetree::bench
