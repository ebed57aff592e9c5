#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "octree/builder/sort/morton_order.h"
#include "octree/builder/sort/triangles.h"
#include "octree/builder/tree/chunk_vertices.h"
#include "octree/builder/tree/page_plan.h"
#include "octree/builder/tree/wide_tree.h"
#include "octree/page/frame.h"

namespace planetree::octree {

/// Bytes of a link to another page: its page in one stream, its record in the next.
inline constexpr std::uint32_t kPageLinkBytes = sizeof(std::uint32_t) + sizeof(std::uint16_t);

/// A page's raw bytes, and where its links to other pages are in them.
struct EncodedPage {
  std::vector<std::byte> bytes;
  std::uint32_t links_at = 0;  ///< offset of the linked pages' numbers
  std::uint32_t link_count = 0;
};

/// Makes the raw bytes of pages, as octree/page/page_decoder.h reads them. One encoder per thread;
/// the bytes depend on the arguments alone.
class PageEncoder {
 public:
  PageEncoder(const Triangles& mesh, const ChunkVertices& vertices,
              const std::vector<MortonKey>& keys, const WideTree& tree, const PagePlan& plan,
              const BlockShape& shape)
      : mesh_(mesh), vertices_(vertices), keys_(keys), tree_(tree), plan_(plan), shape_(shape) {}

  /// page  index in the plan.
  EncodedPage encode(std::size_t page) const;

 private:
  const Triangles& mesh_;
  const ChunkVertices& vertices_;
  const std::vector<MortonKey>& keys_;
  const WideTree& tree_;
  const PagePlan& plan_;
  BlockShape shape_;
};

}  // namespace planetree::octree
