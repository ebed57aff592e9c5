#pragma once

#include <memory>

#include "bench/peer.h"

namespace planetree::bench {

/// Embree 3: distances by its point query, sides by the parity of the hits of one ray.
std::unique_ptr<Peer> make_embree_peer(const PeerMesh& mesh);

/// Seconds that Embree's build of medium quality takes, without reading the mesh.
double embree_build_seconds(const PeerMesh& mesh, unsigned threads);

/// CGAL's AABB tree with double coordinates and exact predicates. Sides by Side_of_triangle_mesh,
/// which are exact on a closed mesh; a point on the surface counts as inside.
std::unique_ptr<Peer> make_cgal_peer(const PeerMesh& mesh);

/// FCL's bounding volume hierarchy. Distances are those of a sphere of radius 0; no sides.
std::unique_ptr<Peer> make_fcl_peer(const PeerMesh& mesh);

}  // namespace planetree::bench
