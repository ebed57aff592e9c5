#include "tools/trade/median_edge.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "query/file/scale.h"
#include "tools/check/file_parts.h"

namespace planetree::tools {
namespace {

/// Pages of the sample, spread over the file.
constexpr std::uint32_t kMaxPages = 64;

void add_edges(const FrameView& frame, std::vector<double>& lengths) {
  frame.for_each_block([&](std::uint32_t, const octree::BlockView& block) {
    for (unsigned i = 0; i < block.triangle_count(); ++i) {
      const octree::Triangle triangle = block.triangle(i);
      for (std::size_t k = 0; k < 3; ++k)
        lengths.push_back((triangle[(k + 1) % 3] - triangle[k]).norm());
    }
  });
}

}  // namespace

Result<double> median_edge(const std::filesystem::path& path) {
  auto parts = FileParts::open(path);
  if (!parts) return parts.error();
  if (!parts->header())
    return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                      "its header cannot be read; see planetree inspect");
  const std::uint32_t pages = parts->first_cap_page();
  const std::uint32_t step = std::max(pages / kMaxPages, 1U);
  std::vector<double> lengths;
  for (std::uint32_t page = 0; page < pages; page += step)
    if (!parts->read_page(page) && !parts->decode_page()) add_edges(parts->frame(), lengths);
  if (lengths.empty()) return 0.0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return query::Scale(parts->header()->model.scale_exponent).out(*middle);
}

}  // namespace planetree::tools
