#include "octree/builder/shard_results.h"

#include <utility>

namespace planetree::octree {

std::vector<storage::SpillRuns::Extent> moved(std::vector<storage::SpillRuns::Extent> extents,
                                              std::uint64_t offset) {
  for (storage::SpillRuns::Extent& extent : extents) extent.offset += offset;
  return extents;
}

void attach_runs(std::span<const SortedPart> parts, storage::SpillFile& file, TriangleRuns& runs) {
  for (const SortedPart& part : parts) runs.add_extent(moved(part.runs, file.attach(part.file)));
}

std::vector<BuiltChunk> attach_chunks(const BuiltPart& part, storage::SpillFile& file) {
  const std::uint64_t offset = file.attach(part.file);
  std::vector<BuiltChunk> chunks = part.results.chunks;
  for (BuiltChunk& chunk : chunks)
    for (SpilledPage& page : chunk.pages) page.offset += offset;
  return chunks;
}

}  // namespace planetree::octree
