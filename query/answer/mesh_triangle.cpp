#include "query/answer/mesh_triangle.h"

#include <cinttypes>
#include <optional>

#include "octree/traversal/link_resolver.h"

namespace planetree::query {
namespace {

Error unreadable(std::uint32_t page) {
  return make_error(ErrorCode::kReadFailed, page, Error::kNowhere,
                    "page %u cannot be read, or takes too long; see Stats::quarantined_pages",
                    page);
}

std::optional<unsigned> position_of(std::uint64_t index, const octree::BlockView& block) {
  for (unsigned i = 0; i < block.triangle_count(); ++i)
    if (block.id(i) == index) return i;
  return std::nullopt;
}

MeshTriangle attributes_of(const octree::AttributeView& page, std::uint32_t at,
                           octree::AttributeShape shape) {
  MeshTriangle triangle;
  if (shape.has_colors()) triangle.colors = page.colors(at);
  if (shape.has_uvs()) triangle.uvs = page.uvs(at);
  if (shape.has_values()) triangle.value = page.value(at);
  return triangle;
}

}  // namespace

Result<MeshTriangle> find_mesh_triangle(const ModelGeometry& model, const octree::PageReader& pages,
                                        std::uint64_t index) noexcept {
  const AttributePages& attributes = model.attributes;
  if (index >= attributes.index_count)
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "there is no triangle %" PRIu64 "; the mesh has indices below %" PRIu64,
                      index, attributes.index_count);
  const auto number = static_cast<std::uint32_t>(index / attributes.in_page);
  const std::uint32_t page = attributes.first_page + number;
  const std::byte* const frame = pages.page(pages.context, page);
  if (!frame) return unreadable(page);
  const octree::AttributeView view(frame, attributes.shape);
  const auto at = static_cast<std::uint32_t>(index % attributes.in_page);
  const std::uint32_t link = view.link(at);
  if (link == octree::kNoLink)
    return make_error(ErrorCode::kNotFound, Error::kNowhere, Error::kNowhere,
                      "triangle %" PRIu64
                      " is of a skipped record or outside of the file's region; it has no corners",
                      index);
  MeshTriangle triangle = attributes_of(view, at, attributes.shape);
  octree::LinkResolver records(model.tree, pages);
  octree::TraversalStats work;
  const std::byte* const record = records.find_numbered(link, work);
  const std::uint32_t tree_page = octree::LinkFormat::numbered(model.tree.page_bytes).page(link);
  if (!record && !records.has_page()) return unreadable(tree_page);
  if (record) {
    const octree::BlockView block(record, model.tree.shape);
    if (const auto position = position_of(index, block)) {
      const octree::Triangle corners = block.triangle(*position);
      for (std::size_t k = 0; k < 3; ++k) triangle.corners[k] = model.scale.out(corners[k]);
      return triangle;
    }
  }
  return make_error(ErrorCode::kDamaged, page, Error::kNowhere,
                    "page %u has a wrong link for triangle %" PRIu64 "; build the file again", page,
                    index);
}

}  // namespace planetree::query
