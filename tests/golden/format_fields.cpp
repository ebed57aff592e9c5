#include "tests/golden/format_fields.h"

#include <algorithm>
#include <type_traits>

#include "octree/attributes/attribute_page.h"
#include "octree/field/field_page.h"
#include "octree/page/mask_streams.h"
#include "octree/page/page_streams.h"
#include "storage/file/file_layout.h"

namespace planetree::golden {
namespace {

template <class T>
std::string encoding_of() {
  if constexpr (std::is_array_v<T>) {
    return encoding_of<std::remove_extent_t<T>>() + " x " + std::to_string(std::extent_v<T>);
  } else if constexpr (std::is_enum_v<T>) {
    return encoding_of<std::underlying_type_t<T>>();
  } else if constexpr (std::is_class_v<T>) {
    return "record";
  } else if constexpr (std::is_same_v<T, char>) {
    return "u8";
  } else {
    const char kind = std::is_floating_point_v<T> ? 'f' : std::is_signed_v<T> ? 'i' : 'u';
    return kind + std::to_string(8 * sizeof(T));
  }
}

template <class Struct>
class FieldList {
 public:
  explicit FieldList(std::string heading, std::size_t table = 0)
      : struct_{std::move(heading), sizeof(Struct), {}, table} {}

  template <class T>
  FieldList& add(const char* name, std::size_t offset) {
    struct_.fields.push_back({name, offset, sizeof(T), encoding_of<T>()});
    return *this;
  }
  FormatStruct take() { return std::move(struct_); }

 private:
  FormatStruct struct_;
};

// C++20 has no other way to get a member's name and offset.
#define PLANETREE_FIELD(Struct, member) \
  add<decltype(Struct::member)>(#member, offsetof(Struct, member))

FormatStruct header_fields() {
  using storage::FileHeader;
  return FieldList<FileHeader>("Header")
      .PLANETREE_FIELD(FileHeader, magic)
      .PLANETREE_FIELD(FileHeader, version)
      .PLANETREE_FIELD(FileHeader, header_bytes)
      .PLANETREE_FIELD(FileHeader, page_bytes)
      .PLANETREE_FIELD(FileHeader, incompatible_features)
      .PLANETREE_FIELD(FileHeader, compatible_features)
      .PLANETREE_FIELD(FileHeader, file_bytes)
      .PLANETREE_FIELD(FileHeader, content_id)
      .PLANETREE_FIELD(FileHeader, extensions_hash)
      .PLANETREE_FIELD(FileHeader, stored_bytes)
      .PLANETREE_FIELD(FileHeader, page_count)
      .PLANETREE_FIELD(FileHeader, extension_count)
      .PLANETREE_FIELD(FileHeader, max_raw_bytes)
      .PLANETREE_FIELD(FileHeader, max_stored_bytes)
      .PLANETREE_FIELD(FileHeader, model)
      .PLANETREE_FIELD(FileHeader, reserved)
      .PLANETREE_FIELD(FileHeader, header_hash)
      .take();
}

FormatStruct model_fields() {
  using storage::ModelRecord;
  return FieldList<ModelRecord>("Model record")
      .PLANETREE_FIELD(ModelRecord, triangle_count)
      .PLANETREE_FIELD(ModelRecord, skipped_count)
      .PLANETREE_FIELD(ModelRecord, first_skipped)
      .PLANETREE_FIELD(ModelRecord, vertex_count)
      .PLANETREE_FIELD(ModelRecord, node_count)
      .PLANETREE_FIELD(ModelRecord, block_count)
      .PLANETREE_FIELD(ModelRecord, box_lower)
      .PLANETREE_FIELD(ModelRecord, box_upper)
      .PLANETREE_FIELD(ModelRecord, centre)
      .PLANETREE_FIELD(ModelRecord, sample)
      .PLANETREE_FIELD(ModelRecord, sample_triangle)
      .PLANETREE_FIELD(ModelRecord, scale_exponent)
      .PLANETREE_FIELD(ModelRecord, vertex_kind)
      .PLANETREE_FIELD(ModelRecord, triangle_id_bytes)
      .PLANETREE_FIELD(ModelRecord, height)
      .PLANETREE_FIELD(ModelRecord, reserved)
      .PLANETREE_FIELD(ModelRecord, unbalanced_edge_count)
      .PLANETREE_FIELD(ModelRecord, unbalanced_edge)
      .PLANETREE_FIELD(ModelRecord, mask_cell_count)
      .PLANETREE_FIELD(ModelRecord, mask_page_count)
      .PLANETREE_FIELD(ModelRecord, mask_levels)
      .PLANETREE_FIELD(ModelRecord, mask_reserved)
      .PLANETREE_FIELD(ModelRecord, input_triangles)
      .PLANETREE_FIELD(ModelRecord, region_lower)
      .PLANETREE_FIELD(ModelRecord, region_upper)
      .PLANETREE_FIELD(ModelRecord, region_winding)
      .PLANETREE_FIELD(ModelRecord, core_lower)
      .PLANETREE_FIELD(ModelRecord, core_upper)
      .PLANETREE_FIELD(ModelRecord, stray_count)
      .PLANETREE_FIELD(ModelRecord, stray_edge)
      .PLANETREE_FIELD(ModelRecord, cap_count)
      .PLANETREE_FIELD(ModelRecord, cap_node_count)
      .PLANETREE_FIELD(ModelRecord, cap_block_count)
      .PLANETREE_FIELD(ModelRecord, cap_area)
      .PLANETREE_FIELD(ModelRecord, cap_page_count)
      .PLANETREE_FIELD(ModelRecord, cap_height)
      .PLANETREE_FIELD(ModelRecord, cap_reserved)
      .PLANETREE_FIELD(ModelRecord, openness)
      .PLANETREE_FIELD(ModelRecord, side_rule)
      .PLANETREE_FIELD(ModelRecord, side_is_chosen)
      .PLANETREE_FIELD(ModelRecord, without_sides)
      .PLANETREE_FIELD(ModelRecord, side_reserved)
      .PLANETREE_FIELD(ModelRecord, field_lower)
      .PLANETREE_FIELD(ModelRecord, field_step)
      .PLANETREE_FIELD(ModelRecord, field_quantum)
      .PLANETREE_FIELD(ModelRecord, field_size)
      .PLANETREE_FIELD(ModelRecord, field_page_count)
      .PLANETREE_FIELD(ModelRecord, attribute_page_count)
      .PLANETREE_FIELD(ModelRecord, attributes)
      .PLANETREE_FIELD(ModelRecord, value_kind)
      .PLANETREE_FIELD(ModelRecord, attribute_reserved)
      .take();
}

FormatStruct unbalanced_edge_fields() {
  using storage::UnbalancedEdge;
  return FieldList<UnbalancedEdge>("Unbalanced edges")
      .PLANETREE_FIELD(UnbalancedEdge, from)
      .PLANETREE_FIELD(UnbalancedEdge, to)
      .PLANETREE_FIELD(UnbalancedEdge, triangle)
      .PLANETREE_FIELD(UnbalancedEdge, along)
      .PLANETREE_FIELD(UnbalancedEdge, against)
      .take();
}

FormatStruct entry_fields() {
  using storage::DirectoryPage;
  return FieldList<DirectoryPage>("Directory")
      .PLANETREE_FIELD(DirectoryPage, check)
      .PLANETREE_FIELD(DirectoryPage, octcode)
      .PLANETREE_FIELD(DirectoryPage, stored_bytes)
      .PLANETREE_FIELD(DirectoryPage, raw_bytes)
      .take();
}

FormatStruct directory_block_fields() {
  using storage::DirectoryBlock;
  return FieldList<DirectoryBlock>("Directory", 1)
      .PLANETREE_FIELD(DirectoryBlock, check)
      .PLANETREE_FIELD(DirectoryBlock, octcode)
      .PLANETREE_FIELD(DirectoryBlock, offset)
      .take();
}

FormatStruct extension_fields() {
  using storage::ExtensionRecord;
  return FieldList<ExtensionRecord>("Extensions")
      .PLANETREE_FIELD(ExtensionRecord, name)
      .PLANETREE_FIELD(ExtensionRecord, offset)
      .PLANETREE_FIELD(ExtensionRecord, bytes)
      .PLANETREE_FIELD(ExtensionRecord, check)
      .PLANETREE_FIELD(ExtensionRecord, required)
      .PLANETREE_FIELD(ExtensionRecord, reserved)
      .take();
}

FormatStruct page_head_fields() {
  using octree::PageHead;
  return FieldList<PageHead>("Distance page")
      .PLANETREE_FIELD(PageHead, page_number)
      .PLANETREE_FIELD(PageHead, ordinal)
      .PLANETREE_FIELD(PageHead, octcode)
      .PLANETREE_FIELD(PageHead, node_count)
      .PLANETREE_FIELD(PageHead, block_count)
      .PLANETREE_FIELD(PageHead, root_count)
      .PLANETREE_FIELD(PageHead, child_count)
      .PLANETREE_FIELD(PageHead, page_link_count)
      .PLANETREE_FIELD(PageHead, vertex_count)
      .PLANETREE_FIELD(PageHead, vertex_ref_count)
      .PLANETREE_FIELD(PageHead, triangle_count)
      .PLANETREE_FIELD(PageHead, reserved)
      .take();
}

FormatStruct mask_page_head_fields() {
  using octree::MaskPageHead;
  return FieldList<MaskPageHead>("Mask page")
      .PLANETREE_FIELD(MaskPageHead, page_number)
      .PLANETREE_FIELD(MaskPageHead, ordinal)
      .PLANETREE_FIELD(MaskPageHead, octcode)
      .PLANETREE_FIELD(MaskPageHead, record_count)
      .PLANETREE_FIELD(MaskPageHead, root_count)
      .PLANETREE_FIELD(MaskPageHead, node_count)
      .PLANETREE_FIELD(MaskPageHead, page_link_count)
      .PLANETREE_FIELD(MaskPageHead, plain_count)
      .PLANETREE_FIELD(MaskPageHead, corners_count)
      .PLANETREE_FIELD(MaskPageHead, special_count)
      .PLANETREE_FIELD(MaskPageHead, plane_count)
      .PLANETREE_FIELD(MaskPageHead, listed_count)
      .PLANETREE_FIELD(MaskPageHead, block_link_count)
      .PLANETREE_FIELD(MaskPageHead, reserved)
      .take();
}

FormatStruct field_page_head_fields() {
  using octree::FieldPageHead;
  return FieldList<FieldPageHead>("Field page")
      .PLANETREE_FIELD(FieldPageHead, page_number)
      .PLANETREE_FIELD(FieldPageHead, ordinal)
      .PLANETREE_FIELD(FieldPageHead, octcode)
      .PLANETREE_FIELD(FieldPageHead, point_count)
      .PLANETREE_FIELD(FieldPageHead, reserved)
      .take();
}

FormatStruct attribute_page_head_fields() {
  using octree::AttributePageHead;
  return FieldList<AttributePageHead>("Attribute page")
      .PLANETREE_FIELD(AttributePageHead, page_number)
      .PLANETREE_FIELD(AttributePageHead, ordinal)
      .PLANETREE_FIELD(AttributePageHead, octcode)
      .PLANETREE_FIELD(AttributePageHead, triangle_count)
      .PLANETREE_FIELD(AttributePageHead, reserved)
      .take();
}

#undef PLANETREE_FIELD

}  // namespace

const std::vector<FormatStruct>& format_structs() {
  static const std::vector<FormatStruct> all = {
      header_fields(),          model_fields(),
      unbalanced_edge_fields(), entry_fields(),
      directory_block_fields(), extension_fields(),
      page_head_fields(),       mask_page_head_fields(),
      field_page_head_fields(), attribute_page_head_fields()};
  return all;
}

const FormatStruct& format_struct(const std::string& heading) {
  return *std::ranges::find(format_structs(), heading, &FormatStruct::heading);
}

}  // namespace planetree::golden
