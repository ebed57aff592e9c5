#include "octree/builder/sort/chunks.h"

#include <utility>

#include "octree/builder/sort/morton_order.h"
#include "octree/geometry/octcode.h"

namespace planetree::octree {
namespace {

/// Triangles whose Morton codes agree with `code` except in the last `bits` bits.
struct Stretch {
  Chunk chunk;
  std::uint64_t code = 0;
  unsigned bits = kMortonBits;
};

struct Halves {
  Stretch lower, upper;
};

class ChunkCutter {
 public:
  ChunkCutter(const TriangleRuns& runs, std::uint64_t most) : runs_(runs), max_(most) {}

  // Adds the node of a stretch, its chunks and the nodes below it.
  Result<void> add(Stretch stretch) {
    const std::size_t at = tree.nodes.size();
    const auto begin = static_cast<std::uint32_t>(tree.chunks.size());
    tree.nodes.push_back({begin, begin + 1, 0, 0});
    if (stretch.chunk.size <= max_) {
      tree.chunks.push_back(std::move(stretch.chunk));
      return {};
    }
    auto halves = by_code(std::move(stretch));
    if (!halves) return halves.error();
    tree.nodes[at].left = static_cast<std::uint32_t>(tree.nodes.size());
    if (const auto added = add(std::move(halves->lower)); !added) return added;
    tree.nodes[at].right = static_cast<std::uint32_t>(tree.nodes.size());
    if (const auto added = add(std::move(halves->upper)); !added) return added;
    tree.nodes[at].end = static_cast<std::uint32_t>(tree.chunks.size());
    return {};
  }

  // Adds the core and the strays, side by side.
  Result<void> add_parts(Stretch core, Stretch strays) {
    tree.parts_strays = true;
    tree.nodes.push_back({0, 0, 1, 0});
    if (const auto added = add(std::move(core)); !added) return added;
    tree.nodes[0].right = static_cast<std::uint32_t>(tree.nodes.size());
    if (const auto added = add(std::move(strays)); !added) return added;
    tree.nodes[0].end = static_cast<std::uint32_t>(tree.chunks.size());
    return {};
  }

  ChunkTree tree;

 private:
  // Splits a stretch at the first bit that is not the same in all codes.
  Result<Halves> by_code(Stretch stretch) const {
    while (stretch.bits > 0) {
      const std::uint64_t upper_code = stretch.code | std::uint64_t{1} << --stretch.bits;
      auto middle = runs_.cut(upper_code);
      if (!middle) return middle.error();
      const std::uint64_t lower = TriangleRuns::count(stretch.chunk.from, *middle);
      if (lower == 0) stretch.code = upper_code;
      if (lower != 0 && lower != stretch.chunk.size)
        return halves_of(std::move(stretch), *std::move(middle), lower, upper_code);
    }
    return by_number(std::move(stretch));
  }

  // Splits a stretch of equal codes at the least index with half of the triangles before it.
  Result<Halves> by_number(Stretch stretch) const {
    const std::uint64_t lower = stretch.chunk.size / 2;
    std::uint64_t least = 0, most = ~std::uint64_t{0};
    while (least < most) {
      const std::uint64_t index = least + (most - least) / 2;
      const auto middle = runs_.cut(stretch.code, index);
      if (!middle) return middle.error();
      // Negative if `index` is before the stretch.
      const auto before =
          static_cast<std::int64_t>(TriangleRuns::count(stretch.chunk.from, *middle));
      if (before < static_cast<std::int64_t>(lower))
        least = index + 1;
      else
        most = index;
    }
    auto middle = runs_.cut(stretch.code, least);
    if (!middle) return middle.error();
    const std::uint64_t code = stretch.code;
    return halves_of(std::move(stretch), *std::move(middle), lower, code);
  }

  static Halves halves_of(Stretch stretch, TriangleRuns::Cut middle, std::uint64_t lower,
                          std::uint64_t upper_code) {
    Halves halves;
    halves.upper = {{middle, std::move(stretch.chunk.to), stretch.chunk.size - lower},
                    upper_code,
                    stretch.bits};
    halves.lower = {
        {std::move(stretch.chunk.from), std::move(middle), lower}, stretch.code, stretch.bits};
    return halves;
  }

  const TriangleRuns& runs_;
  const std::uint64_t max_;
};

}  // namespace

Result<ChunkTree> cut_chunks(const TriangleRuns& runs, bool has_strays, std::uint64_t most) {
  ChunkCutter cutter(runs, most);
  auto middle = has_strays ? runs.cut(kStrayCode) : Result<TriangleRuns::Cut>(runs.end());
  if (!middle) return middle.error();
  const std::uint64_t in_core = TriangleRuns::count(runs.begin(), *middle);
  const std::uint64_t strays = runs.size() - in_core;
  Stretch core{{runs.begin(), *middle, in_core}}, rest{{*middle, runs.end(), strays}, kStrayCode};
  const auto added = in_core > 0 && strays > 0 ? cutter.add_parts(std::move(core), std::move(rest))
                                               : cutter.add(std::move(strays == 0 ? core : rest));
  if (!added) return added.error();
  return std::move(cutter.tree);
}

}  // namespace planetree::octree
