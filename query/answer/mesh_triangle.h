#pragma once

#include <cstdint>

#include "octree/traversal/tree_view.h"
#include "planetree/attributes.h"
#include "planetree/error.h"
#include "query/answer/model_geometry.h"

namespace planetree::query {

/// Finds a triangle by its index: its attribute page has a link to the block that has it.
///
/// The attribute layer must be open.
/// errors  see Model::triangles. kReadFailed if `pages` does not have a page.
Result<MeshTriangle> find_mesh_triangle(const ModelGeometry& model, const octree::PageReader& pages,
                                        std::uint64_t index) noexcept;

}  // namespace planetree::query
