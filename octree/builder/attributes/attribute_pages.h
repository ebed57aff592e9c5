#pragma once

#include <cstdint>
#include <functional>

#include "octree/attributes/attribute_page.h"
#include "octree/builder/attributes/triangle_links.h"
#include "octree/builder/job/build_options.h"
#include "octree/builder/sort/attribute_spool.h"
#include "octree/builder/sort/ordered_mesh.h"
#include "octree/builder/tree/page_appender.h"
#include "planetree/error.h"
#include "storage/file/file_layout.h"
#include "storage/spill/spill_file.h"

namespace planetree::octree {

/// What a build keeps of the triangles of its mesh beside their corners.
struct KeptAttributes {
  AttributeShape shape;           ///< kept is 0: nothing
  std::uint64_t index_count = 0;  ///< of the mesh, those of skipped records included
  ValueKind value_kind = ValueKind::kUnsigned;
  SpooledAttributes spooled;                 ///< empty if only links are kept
  const storage::SpillFile* file = nullptr;  ///< has what is spooled

  /// file  has what is spooled; must outlive the result.
  static KeptAttributes of(const OrderedMesh& mesh, const BuildOptions& options,
                           const storage::SpillFile& file);
  /// Number of attribute pages.
  std::uint64_t page_count(std::uint32_t page_bytes) const;
  /// Writes what is kept to the record.
  void describe(std::uint32_t page_bytes, storage::ModelRecord& model) const;
};

/// The attribute pages of a file.
class AttributePages {
 public:
  /// All arguments must outlive this.
  /// links  of all distance pages.
  AttributePages(const KeptAttributes& kept, TriangleLinks& links, std::uint32_t page_bytes)
      : kept_(kept), links_(links), page_bytes_(page_bytes) {}

  /// Appends all pages to a file; the first of them is `first_page`.
  /// errors  those of PageAppender, TriangleLinks and SpillFile.
  Result<void> append_to(PageAppender& appender, std::uint32_t first_page);

 private:
  Result<FilePage> encode(std::uint32_t index, std::uint32_t first_page,
                          std::span<const std::uint32_t> links) const;

  const KeptAttributes& kept_;
  TriangleLinks& links_;
  const std::uint32_t page_bytes_;
};

}  // namespace planetree::octree
