#pragma once

#include <algorithm>
#include <cstdint>

#include "planetree/layers.h"
#include "storage/file/file_layout.h"

namespace planetree::query {

/// Returns the layers that a file has.
inline std::uint32_t layers_of(const storage::ModelRecord& model) noexcept {
  return kDistanceLayer | (model.has_side_layer() ? kSideLayer : 0) |
         (model.field_page_count > 0 ? kFieldLayer : 0) |
         (model.attributes != 0 ? kAttributeLayer : 0);
}

/// The layers of a file that a model opens, and the pages that its queries may read.
struct OpenLayers {
  std::uint32_t layers = kDistanceLayer;

  /// wanted  OpenOptions::layers
  static OpenLayers of(const storage::ModelRecord& model, std::uint32_t wanted) noexcept {
    return {layers_of(model) & (wanted | kDistanceLayer)};
  }

  bool has_side() const noexcept { return (layers & kSideLayer) != 0; }
  bool has_field() const noexcept { return (layers & kFieldLayer) != 0; }
  bool has_attributes() const noexcept { return (layers & kAttributeLayer) != 0; }
  /// Number of pages up to the last one that the cache may hold.
  std::uint32_t page_count(const storage::FileHeader& header) const noexcept {
    if (has_side()) return header.page_count;
    return has_attributes() ? header.first_mask_page() : header.first_cap_page();
  }
  /// First of the pages that the cache never holds, which follow one another: those of layers that
  /// are not open, and the field pages, which are read when the model is opened.
  std::uint32_t first_unused_page(const storage::FileHeader& header) const noexcept {
    return has_side() ? header.first_field_page() : header.first_cap_page();
  }
  /// How many these are, below page_count().
  std::uint32_t unused_pages(const storage::FileHeader& header) const noexcept {
    const std::uint32_t end =
        has_attributes() ? header.first_attribute_page() : header.first_mask_page();
    return std::min(end, page_count(header)) - first_unused_page(header);
  }
};

}  // namespace planetree::query
