#pragma once

#include <cstdint>
#include <vector>

#include "tests/golden/spec_reader.h"

namespace planetree::golden {

struct SpecNearest {
  std::uint64_t triangle;
  double distance;
};

/// The whole tree of a file, all pages at once. Part of the independent
/// reader: see spec_reader.h.
class SpecTree {
 public:
  explicit SpecTree(const SpecFile& file);

  const SpecHeader& header() const { return header_; }
  const std::vector<SpecPage>& pages() const { return pages_; }

  /// The records a link leads to; throws where there is no such record.
  const SpecNode& node(std::uint32_t link) const;
  const SpecBlock& block(std::uint32_t link) const;
  std::uint32_t page_of(std::uint32_t link) const;
  static bool is_block(std::uint32_t link) { return link >> 31 != 0; }

  /// All triangles below a link, in the order of the tree.
  std::vector<SpecTriangle> triangles(std::uint32_t link) const;

  /// "Nearest triangle", nearest(): `point` and the distance are in the model
  /// frame.
  SpecNearest nearest(const SpecPoint& point) const;

 private:
  void collect(std::uint32_t link, std::vector<SpecTriangle>& found) const;
  double child_bound(const SpecChild& child, const SpecPoint& from_centre) const;

  SpecHeader header_;
  std::vector<SpecPage> pages_;
};

}  // namespace planetree::golden
