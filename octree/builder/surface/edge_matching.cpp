#include "octree/builder/surface/edge_matching.h"

#include "octree/builder/sort/each_chunk.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

constexpr auto is_never_done = [](std::size_t) { return false; };

}  // namespace

Result<EdgeBalance> list_unbalanced(EdgeCensus& census, const TriangleRuns& runs,
                                    const std::vector<Chunk>& chunks, BuildProgress& progress,
                                    CapChain* boundary) {
  auto balance = census.balance(boundary);
  if (!balance || balance->unbalanced_edges == 0) return balance;
  EdgeFaces faces(*balance);
  const auto look = [&](std::size_t, const Triangles& chunk) -> Result<void> {
    faces.look_at(chunk);
    return {};
  };
  const auto looked =
      for_each_chunk(runs, chunks, progress, BuildPhase::kListing, is_never_done, look);
  if (!looked) return looked.error();
  return faces.balance();
}

Result<EdgeBalance> match_edges(const TriangleRuns& runs, const std::vector<Chunk>& chunks,
                                std::uint64_t held_bytes, storage::SpillFile& scratch,
                                BuildProgress& progress, CapChain* boundary,
                                const ChunkCall& also) {
  EdgeCensus census(held_bytes, scratch);
  const auto add = [&](std::size_t, const Triangles& chunk) {
    const auto counted = census.add(chunk);
    return counted ? also(chunk) : counted;
  };
  const auto added =
      for_each_chunk(runs, chunks, progress, BuildPhase::kMatching, is_never_done, add);
  if (!added) return added.error();
  return list_unbalanced(census, runs, chunks, progress, boundary);
}

}  // namespace planetree::octree
