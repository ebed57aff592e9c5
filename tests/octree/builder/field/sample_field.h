#pragma once

#include <cstdlib>
#include <memory>

#include "octree/builder/field/built_field.h"
#include "tests/octree/builder/chunked_tree.h"
#include "tests/octree/builder/silent_progress.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {

/// A built field, with the triangles that it is of, in pages of 4096 bytes.
struct SampleField {
  std::uint32_t page_bytes = 4096;
  std::unique_ptr<ChunkedTree> tree;
  BuiltField field;

  explicit SampleField(const Soup& soup, const Region& region = {})
      : tree(std::make_unique<ChunkedTree>(soup, 2000, page_bytes, spill_file())) {
    SilentProgress progress;
    auto built = BuiltField::build(tree->tree.get(), region, soup.size(), page_bytes, progress);
    if (!built) std::abort();
    field = *std::move(built);
  }
  /// A sphere of 8,192 triangles. Its field has several pages.
  static SampleField of_sphere() { return SampleField(sphere(5)); }
};

}  // namespace planetree::octree
