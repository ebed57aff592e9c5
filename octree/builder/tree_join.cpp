#include <cassert>
#include <utility>

#include "octree/builder/job/phase_count.h"
#include "octree/builder/sort/each_chunk.h"
#include "octree/builder/surface_pass.h"
#include "octree/builder/tree_build.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {

Result<BuildReport> TreeBuild::join(const ShardResults& results) {
  if (const auto joined = join_triangles(results); !joined) return joined.error();
  if (const auto joined = join_surface(results.built); !joined) return joined.error();
  if (const auto joined = join_chunks(results.built); !joined) return joined.error();
  return finish();
}

Result<void> TreeBuild::join_triangles(const ShardResults& results) {
  OrderedMesh mesh = results.plan.mesh;
  const std::uint64_t plan_offset = files_.triangles().attach(results.plan.file);
  for (std::uint64_t& offset : mesh.attributes.offsets) offset += plan_offset;
  std::uint64_t kept_bytes = 0;
  for (const SortedPart& part : results.sorted) kept_bytes += part.file->data_bytes();
  for (const BuiltPart& part : results.built) kept_bytes += part.file->data_bytes();
  if (const auto set = set_mesh(mesh, kept_bytes, true); !set) return set;
  whole_.emplace(mesh.frame.float64, 0, files_.triangles());
  attach_runs(results.sorted, files_.triangles(), *whole_);
  auto above = cut_chunks(*whole_, model_.frame.has_strays(), seams_.chunk_triangles);
  if (!above) return above.error();
  model_.above = *std::move(above);
  return {};
}

Result<void> TreeBuild::join_surface(const std::vector<BuiltPart>& parts) {
  caps_.emplace(model_.frame, model_.shape, options_.page_bytes, memory_.cap_bytes,
                files_.triangles(), files_.pages());
  std::vector<ChunkResults> results;
  for (const BuiltPart& part : parts) {
    const std::uint64_t offset = files_.scratch().attach(part.file);
    results.push_back({.chunks = {},
                       .edges = moved(part.results.edges, offset),
                       .areas = part.results.areas,
                       .winding = part.results.winding});
  }
  const SurfacePass pass{model_.frame, *whole_, model_.above.chunks, nullptr,
                         options_.has_side_layer() ? &*caps_ : nullptr};
  const auto found = pass.join(results, memory_, files_.scratch(), progress_);
  if (!found) return found.error();
  model_.edges = found->edges;
  model_.cut = found->cut;
  model_.openness = found->openness;
  take_whole_surface();
  return {};
}

// The triangles are read again only for the sectors of the mask.
Result<void> TreeBuild::join_chunks(const std::vector<BuiltPart>& parts) {
  if (const auto divided = divide_sectors(); !divided) return divided;
  for (const BuiltPart& part : parts)
    for (BuiltChunk& chunk : attach_chunks(part, files_.pages()))
      model_.chunks.push_back(std::move(chunk));
  assert(model_.chunks.size() == model_.above.chunks.size());
  if (!sectors_) return {};
  return for_each_chunk(
      runs(), model_.above.chunks, progress_, BuildPhase::kBuildingTree,
      [](std::size_t) { return false; },
      [&](std::size_t, Triangles& triangles) -> Result<void> {
        triangles.sort();
        const auto added = sectors_->add(triangles);
        return added ? Result<void>() : added.error();
      });
}

}  // namespace planetree::octree
