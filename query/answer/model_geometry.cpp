#include "query/answer/model_geometry.h"

#include "query/file/page_decoding.h"

namespace planetree::query {
namespace {

octree::TreeInfo tree_info(const storage::FileHeader& header, const Scale& scale) {
  const storage::ModelRecord& model = header.model;
  octree::TreeInfo tree;
  tree.page_bytes = header.page_bytes;
  tree.root_link = model.root_link;
  tree.shape = block_shape(model);
  tree.record_count = model.node_count + model.block_count;
  tree.box_lower = scale.in(Vec3{model.box_lower[0], model.box_lower[1], model.box_lower[2]});
  tree.box_upper = scale.in(Vec3{model.box_upper[0], model.box_upper[1], model.box_upper[2]});
  tree.core_lower = scale.in(Vec3{model.core_lower[0], model.core_lower[1], model.core_lower[2]});
  tree.core_upper = scale.in(Vec3{model.core_upper[0], model.core_upper[1], model.core_upper[2]});
  tree.set_strays(model.stray_count, model.stray_edge);
  tree.centre = {model.centre[0], model.centre[1], model.centre[2]};
  tree.sample = {model.sample[0], model.sample[1], model.sample[2]};
  tree.sample_triangle = model.sample_triangle;
  return tree;
}

octree::MaskInfo mask_info(const storage::FileHeader& header, const octree::TreeInfo& tree) {
  octree::MaskInfo mask;
  mask.page_bytes = header.page_bytes;
  mask.first_page = header.first_mask_page();
  mask.page_count = header.model.mask_page_count;
  mask.lower = tree.core_lower;
  mask.beside_strays = tree.has_strays;
  return mask;
}

}  // namespace

octree::Region region_of(const storage::ModelRecord& model) {
  if (!model.has_region()) return {};
  const Scale scale(model.scale_exponent);
  const auto point = [&scale](const double(&v)[3]) { return scale.in(Vec3{v[0], v[1], v[2]}); };
  return {point(model.region_lower), point(model.region_upper), point(model.box_lower),
          point(model.box_upper)};
}

ModelGeometry::ModelGeometry(const storage::FileHeader& header)
    : scale(header.model.scale_exponent),
      tree(tree_info(header, scale)),
      mask(mask_info(header, tree)),
      region(region_of(header.model)),
      region_corner(region.clamped(tree.core_lower)),
      region_winding(header.model.region_winding),
      watertight(header.model.unbalanced_edge_count == 0) {}

}  // namespace planetree::query
