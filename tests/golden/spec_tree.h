#pragma once

#include <cstdint>
#include <vector>

#include "tests/golden/spec_reader.h"

namespace planetree::golden {

struct SpecNearest {
  std::uint64_t triangle;
  double distance;
};

/// What the header states about a tree.
struct SpecCounts {
  std::uint64_t triangles, nodes, blocks;
  unsigned height;
};

/// A tree of a file, with all its pages. Part of the independent reader: see spec_reader.h.
class SpecTree {
 public:
  enum class Of { kSurface, kCaps };

  /// The file must have caps if their tree is asked for.
  explicit SpecTree(const SpecFile& file, Of of = Of::kSurface);

  const SpecHeader& header() const { return header_; }
  SpecCounts counts() const;
  SpecLink root_link() const { return of_caps_ ? header_.cap_root_link() : header_.root_link(); }
  const std::vector<SpecPage>& pages() const { return pages_; }

  /// The record that a link leads to. Throws if there is none.
  const SpecNode& node(SpecLink link) const;
  const SpecBlock& block(SpecLink link) const;
  /// The page that a link leads to, counted from the first one of the tree.
  std::uint32_t page_of(SpecLink link) const;
  static bool is_block(SpecLink link) { return link >> 63 != 0; }

  /// All triangles below a link, in the order of the tree.
  std::vector<SpecTriangle> triangles(SpecLink link) const;

  /// nearest() of "Nearest triangle". `point` and the distance are in the model frame.
  SpecNearest nearest(const SpecPoint& point) const;

 private:
  void collect(SpecLink link, std::vector<SpecTriangle>& found) const;
  double child_bound(const SpecChild& child, const SpecPoint& from_centre) const;

  SpecHeader header_;
  bool of_caps_;
  std::vector<SpecPage> pages_;
};

}  // namespace planetree::golden
