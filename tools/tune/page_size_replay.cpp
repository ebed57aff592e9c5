#include "tools/tune/page_size_replay.h"

#include <algorithm>
#include <cmath>

#include "octree/geometry/octcode.h"
#include "tools/tune/trace_analysis.h"

namespace planetree::tools {
namespace {

using octree::kLevels;
using octree::kMortonBits;

constexpr double kFinestCells = 1 << kLevels;

/// A page of a quarter of the bytes has one level, or three bits, more.
int more_bits(std::uint64_t recorded_bytes, std::uint64_t wanted_bytes) {
  const double quarters =
      std::log2(static_cast<double>(recorded_bytes) / static_cast<double>(wanted_bytes)) / 2;
  return static_cast<int>(std::lround(3 * quarters));
}

std::uint64_t first_bits(std::uint64_t morton, unsigned bits) {
  const unsigned dropped = kMortonBits - bits;
  return dropped == kMortonBits ? 0 : morton >> dropped << dropped;
}

double cells_per_unit(const Vec3& lower, const Vec3& upper) {
  const double longest =
      std::max({upper.x - lower.x, upper.y - lower.y, upper.z - lower.z, 1e-300});
  // The octree's edge is the power of two that is above the longest edge, and twice as long as it
  // must be at most.
  return kFinestCells / std::ldexp(2.0, std::ilogb(longest));
}

}  // namespace

PageSizeReplay::PageSizeReplay(std::uint64_t recorded_bytes, std::uint64_t wanted_bytes,
                               Vec3 core_lower, Vec3 core_upper)
    : page_bytes_(wanted_bytes),
      more_bits_(more_bits(recorded_bytes, wanted_bytes)),
      pages_together_(
          static_cast<std::uint32_t>(std::max<std::uint64_t>(wanted_bytes / recorded_bytes, 1))),
      core_lower_(core_lower),
      cells_per_unit_(cells_per_unit(core_lower, core_upper)) {}

std::uint64_t PageSizeReplay::morton_at(const Vec3& position, std::uint64_t page_morton,
                                        unsigned bits) const {
  const unsigned level = bits / 3;
  const octree::Cell cell =
      octree::cell_of_octcode(octree::octcode_of_prefix(page_morton, 3 * level));
  const auto coordinate = [&](double at, double lower, std::uint32_t cell_at) {
    const double first =
        static_cast<double>(cell_at) * std::ldexp(1.0, static_cast<int>(kLevels - level));
    const double last = first + std::ldexp(1.0, static_cast<int>(kLevels - level)) - 1;
    return static_cast<std::uint32_t>(std::clamp((at - lower) * cells_per_unit_, first, last));
  };
  const std::uint64_t morton = octree::morton_code(coordinate(position.x, core_lower_.x, cell.x),
                                                   coordinate(position.y, core_lower_.y, cell.y),
                                                   coordinate(position.z, core_lower_.z, cell.z));
  // The page may be a part of the cell.
  return first_bits(page_morton, bits) | (morton ^ first_bits(morton, bits));
}

PageSizeReplay::Key PageSizeReplay::key_of(const PageAccess& access) const {
  const auto section = static_cast<std::uint8_t>(access.section);
  const unsigned bits =
      3 * static_cast<unsigned>(access.octcode >> 59) + static_cast<unsigned>(access.octcode & 3);
  const std::uint64_t morton = octree::morton_of_octcode(access.octcode);
  if (more_bits_ == 0) return {section, bits, morton, access.page};
  const unsigned other = static_cast<unsigned>(
      std::clamp(static_cast<int>(bits) + more_bits_, 0, static_cast<int>(kMortonBits)));
  if (more_bits_ < 0) return {section, 0, access.page / pages_together_, 0};
  const auto known = positions_.find(access.probe);
  const std::uint64_t at =
      known == positions_.end() ? morton : morton_at(known->second, morton, bits);
  return {section, bits, first_bits(at, other), access.page};
}

void PageSizeReplay::add(const PageAccess& access) {
  using Event = PageAccess::Event;
  if (access.event == Event::kMotion) positions_[access.probe] = access.position;
  if (access.event == Event::kInstalled && access.is_upper) upper_pages_.insert(access.page);
  const bool is_opening = access.query_kind == PageAccess::Query::kOpen &&
                          (access.event == Event::kHit || access.event == Event::kFetched);
  if (!is_opening && !is_counted_lookup(access)) return;
  if (!is_opening && !is_open_) references_.end_opening();
  is_open_ = is_open_ || !is_opening;
  if (access.page / pages_together_ == References::kRootPage) {
    references_.add(References::kRootPage);
    return;
  }
  const auto number =
      numbers_.try_emplace(key_of(access), static_cast<std::uint32_t>(numbers_.size()) + 1).first;
  made_of_.insert({access.page, number->second});
  references_.add(number->second);
}

References PageSizeReplay::references() const {
  References references = references_;
  for (const auto& [page, number] : made_of_)
    if (upper_pages_.contains(page)) references.set_upper(number);
  if (!numbers_.empty()) references.set_upper(References::kRootPage);
  return references;
}

}  // namespace planetree::tools
