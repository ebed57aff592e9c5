#include "tools/mesh/model_pieces.h"

#include <array>

#include "query/file/scale.h"
#include "tools/check/file_parts.h"

namespace planetree::tools {
namespace {

/// Hands over the triangles of a page. Returns their number.
Result<std::uint64_t> add_page(const FrameView& frame, const query::Scale& scale,
                               MeshPieceMaker& maker) {
  std::uint64_t count = 0;
  Result<void> added;
  frame.for_each_block([&](std::uint32_t, const octree::BlockView& block) {
    for (unsigned i = 0; i < block.triangle_count() && added; ++i) {
      const octree::Triangle triangle = block.triangle(i);
      added = maker.add({scale.out(triangle[0]), scale.out(triangle[1]), scale.out(triangle[2])});
      ++count;
    }
  });
  if (!added) return added.error();
  return count;
}

}  // namespace

Result<void> read_model_pieces(const std::filesystem::path& path, MeshPieceMaker& maker,
                               const std::function<void(std::uint64_t)>& progress) {
  auto parts = FileParts::open(path);
  if (!parts) return parts.error();
  if (!parts->header())
    return make_error(ErrorCode::kDamaged, Error::kNowhere, Error::kNowhere,
                      "its header cannot be read; see planetree inspect");
  const query::Scale scale(parts->header()->model.scale_exponent);
  for (std::uint32_t page = 0; page < parts->first_cap_page(); ++page) {
    if (parts->read_page(page) || parts->decode_page())
      return make_error(ErrorCode::kDamaged, page, Error::kNowhere,
                        "it cannot be read; planetree verify says why");
    const auto count = add_page(parts->frame(), scale, maker);
    if (!count) return count.error();
    progress(*count);
  }
  return maker.finish();
}

}  // namespace planetree::tools
