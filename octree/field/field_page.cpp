#include "octree/field/field_page.h"

#include <cstring>

#include "octree/geometry/strict_math.h"
#include "octree/page/byte_split.h"

namespace planetree::octree {
namespace {

const char* decode(std::span<const std::byte> raw, const PageInfo& info,
                   std::span<FieldPoint> points) {
  FieldPageHead head;
  if (raw.size() < sizeof head) return "the page is shorter than its head";
  std::memcpy(&head, raw.data(), sizeof head);
  if (const char* const fault = fault_of_key(head, info)) return fault;
  if (head.octcode != 0 || head.ordinal != info.page_number - info.first_page)
    return "its key is not that of its points";
  if (head.point_count != points.size()) return "it has not as many points as the grid";
  if (head.reserved != 0) return "reserved bytes are not 0";
  StreamReader layout(raw.subspan(sizeof head));
  for (unsigned axis = 0; axis < 3; ++axis) {
    ByteSplit<std::uint16_t> differences;
    layout.take(differences, points.size());
    if (!layout.has_sufficed()) return "the page is shorter than its counts say";
    std::uint16_t before = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
      points[i][axis] = before =
          static_cast<std::uint16_t>(before + unfold_difference(differences[i]));
  }
  return layout.empty() ? nullptr : "the page is longer than its counts say";
}

}  // namespace

Result<void> decode_field_page(std::span<const std::byte> raw, const PageInfo& info,
                               std::span<FieldPoint> points) noexcept {
  const char* fault = decode(raw, info, points);
  if (!fault) return {};
  return make_error(ErrorCode::kDamaged, info.page_number, Error::kNowhere,
                    "field page %u is damaged: %s; build the file again", info.page_number, fault);
}

}  // namespace planetree::octree
