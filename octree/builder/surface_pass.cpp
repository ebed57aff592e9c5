#include "octree/builder/surface_pass.h"

#include "octree/builder/shared_area_sums.h"
#include "octree/builder/surface/cap_chain.h"
#include "octree/builder/surface/edge_matching.h"
#include "octree/builder/surface/region_cut.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {

Result<SurfaceWork> SurfacePass::run(const Region& region, const BuildMemory& memory,
                                     storage::SpillFile& scratch, BuildProgress& progress) const {
  RegionCut cut(frame, region, part);
  SharedAreaSums areas(frame.core_lower(), frame.core_upper());
  CapChain boundary(memory.cap_bytes, scratch);
  const auto edges = match_edges(whole, chunks, memory.edge_bytes, scratch, progress,
                                 caps ? &boundary : nullptr, [&](const Triangles& chunk) {
                                   areas.add(chunk);
                                   return cut.add(chunk);
                                 });
  if (!edges) return edges.error();
  return close(*edges, boundary, cut, areas);
}

Result<SurfaceWork> SurfacePass::join(const std::vector<ChunkResults>& parts,
                                      const BuildMemory& memory, storage::SpillFile& scratch,
                                      BuildProgress& progress) const {
  RegionCut cut(frame, Region(), nullptr);
  SharedAreaSums areas(frame.core_lower(), frame.core_upper());
  EdgeCensus census(0, scratch);
  for (const ChunkResults& results : parts) {
    areas.add(results.areas);
    cut.add_winding(results.winding);
    for (const auto& edges : results.edges) census.add_extent(edges);
  }
  CapChain boundary(memory.cap_bytes, scratch);
  const auto edges = list_unbalanced(census, whole, chunks, progress, caps ? &boundary : nullptr);
  if (!edges) return edges.error();
  return close(*edges, boundary, cut, areas);
}

Result<SurfaceWork> SurfacePass::close(const EdgeBalance& edges, CapChain& boundary, RegionCut& cut,
                                       const SharedAreaSums& areas) const {
  if (caps)
    if (const auto closed = caps->close(boundary, cut); !closed) return closed.error();
  SurfaceWork work;
  work.edges = edges;
  work.cut = cut.found();
  work.openness = areas.openness();
  return work;
}

}  // namespace planetree::octree
