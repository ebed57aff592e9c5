#include "query/answer/model_geometry.h"

#include "query/file/page_decoding.h"

namespace planetree::query {
namespace {

// Converts a corner of a box from the input's coordinates.
octree::Point point_in_frame(const Scale& scale, const double (&corner)[3]) {
  return scale.in(Vec3{corner[0], corner[1], corner[2]});
}

octree::TreeInfo tree_info(const storage::FileHeader& header, const Scale& scale) {
  const storage::ModelRecord& model = header.model;
  octree::TreeInfo tree;
  tree.page_bytes = header.page_bytes;
  tree.shape = block_shape(header);
  tree.root_link = octree::root_link_of(header.page_bytes, tree.shape.links, 0, model.node_count);
  tree.record_count = model.node_count + model.block_count;
  tree.box_lower = point_in_frame(scale, model.box_lower);
  tree.box_upper = point_in_frame(scale, model.box_upper);
  tree.core_lower = point_in_frame(scale, model.core_lower);
  tree.core_upper = point_in_frame(scale, model.core_upper);
  tree.set_strays(model.stray_count, model.stray_edge);
  tree.centre = {model.centre[0], model.centre[1], model.centre[2]};
  tree.sample = {model.sample[0], model.sample[1], model.sample[2]};
  tree.sample_triangle = model.sample_triangle;
  return tree;
}

octree::TreeInfo cap_info(const storage::FileHeader& header, const octree::TreeInfo& surface) {
  octree::TreeInfo caps = surface;
  caps.first_page = header.first_cap_page();
  caps.shape = cap_shape(header);
  caps.root_link = octree::root_link_of(header.page_bytes, caps.shape.links, caps.first_page,
                                        header.model.cap_node_count);
  caps.record_count = header.model.cap_node_count + header.model.cap_block_count;
  return caps;
}

octree::MaskInfo mask_info(const storage::FileHeader& header, const OpenLayers& opened,
                           const octree::TreeInfo& tree) {
  octree::MaskInfo mask;
  mask.page_bytes = header.page_bytes;
  mask.first_page = header.first_mask_page();
  mask.page_count = opened.has_side() ? header.model.mask_page_count : 0;
  mask.lower = tree.core_lower;
  mask.beside_strays = tree.has_strays;
  return mask;
}

AttributePages attribute_pages(const storage::FileHeader& header, const OpenLayers& opened) {
  if (!opened.has_attributes()) return {};
  const octree::AttributeShape shape = attribute_shape(header.model);
  return {shape, header.first_attribute_page(), shape.triangles_per_page(header.page_bytes),
          header.model.index_count()};
}

}  // namespace

octree::Region region_of(const storage::ModelRecord& model) {
  if (!model.has_region()) return {};
  const Scale scale(model.scale_exponent);
  return {point_in_frame(scale, model.region_lower), point_in_frame(scale, model.region_upper),
          point_in_frame(scale, model.box_lower), point_in_frame(scale, model.box_upper)};
}

ModelGeometry::ModelGeometry(const storage::FileHeader& header, const OpenLayers& opened)
    : scale(header.model.scale_exponent),
      tree(tree_info(header, scale)),
      caps(cap_info(header, tree)),
      mask(mask_info(header, opened, tree)),
      attributes(attribute_pages(header, opened)),
      region(region_of(header.model)),
      region_corner(region.clamped(tree.core_lower)),
      diagonal((tree.core_upper - tree.core_lower).norm()),
      cap_area(header.model.cap_area),
      region_winding(header.model.region_winding) {
  const auto solid = opened.has_side() ? SideMeans::kWindingNumber : SideMeans::kNothing;
  const auto set = [&](SideRule rule) { side_means_[static_cast<std::uint8_t>(rule)] = solid; };
  if (header.model.side_rule == storage::SideRule::kSolid) set(SideRule::kOfFile);
  set(SideRule::kSolid);
  if (header.model.cap_count == 0 || !opened.has_side()) return;
  tree.caps = &caps;
  cap_grid = octree::CapGrid::unfilled();
}

}  // namespace planetree::query
