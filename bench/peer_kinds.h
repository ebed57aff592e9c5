#pragma once

#include <memory>

#include "bench/peer.h"

namespace planetree::bench {

/// Embree 3: its point query for distances, the parity of all hits of a ray for sides.
std::unique_ptr<Peer> make_embree_peer(const PeerMesh& mesh);

/// What Embree's build of medium quality takes, the mesh in memory already.
double embree_build_seconds(const PeerMesh& mesh, unsigned threads);

/// CGAL's AABB tree with double coordinates and exact predicates. Sides by
/// Side_of_triangle_mesh: of a closed mesh, exactly; on the surface is inside.
std::unique_ptr<Peer> make_cgal_peer(const PeerMesh& mesh);

/// FCL's bounding volume hierarchy, asked for the distance of a sphere without radius.
std::unique_ptr<Peer> make_fcl_peer(const PeerMesh& mesh);

}  // namespace planetree::bench
