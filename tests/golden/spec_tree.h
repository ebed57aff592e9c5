#pragma once

#include <cstdint>
#include <vector>

#include "tests/golden/spec_reader.h"

namespace planetree::golden {

struct SpecNearest {
  std::uint64_t triangle;
  double distance;
};

/// The tree of a file, with all its pages. Part of the independent reader: see spec_reader.h.
class SpecTree {
 public:
  explicit SpecTree(const SpecFile& file);

  const SpecHeader& header() const { return header_; }
  const std::vector<SpecPage>& pages() const { return pages_; }

  /// The record that a link leads to. Throws if there is none.
  const SpecNode& node(std::uint32_t link) const;
  const SpecBlock& block(std::uint32_t link) const;
  std::uint32_t page_of(std::uint32_t link) const;
  static bool is_block(std::uint32_t link) { return link >> 31 != 0; }

  /// All triangles below a link, in the order of the tree.
  std::vector<SpecTriangle> triangles(std::uint32_t link) const;

  /// nearest() of "Nearest triangle". `point` and the distance are in the model frame.
  SpecNearest nearest(const SpecPoint& point) const;

 private:
  void collect(std::uint32_t link, std::vector<SpecTriangle>& found) const;
  double child_bound(const SpecChild& child, const SpecPoint& from_centre) const;

  SpecHeader header_;
  std::vector<SpecPage> pages_;
};

}  // namespace planetree::golden
