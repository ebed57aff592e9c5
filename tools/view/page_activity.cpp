#include "tools/view/page_activity.h"

#include <optional>
#include <utility>

namespace planetree::tools {
namespace {

/// The state that a record leads to, if it leads to one.
std::optional<PageState> state_after(PageState before, const PageAccess& access) {
  switch (access.event) {
    case PageAccess::Event::kInstalled:
      return PageState::kResident;
    case PageAccess::Event::kHit:
    case PageAccess::Event::kPrefetched:
      // The record of the read was lost; after an eviction, the lookup was before it.
      if (before != PageState::kEvicted) return PageState::kResident;
      return std::nullopt;
    case PageAccess::Event::kEvicted:
    case PageAccess::Event::kEvictedUnused:
      return PageState::kEvicted;
    case PageAccess::Event::kMissed:
    case PageAccess::Event::kLate:
    case PageAccess::Event::kFetched:
      // A query may record its lookups after the page was read.
      if (access.needed && before != PageState::kResident) return PageState::kWanted;
      return std::nullopt;
    case PageAccess::Event::kDegraded:
    case PageAccess::Event::kMotion:
      return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

PageActivity::PageActivity(std::vector<std::uint8_t> levels)
    : levels_(std::move(levels)), states_(levels_.size(), PageState::kUnread) {}

void PageActivity::add(std::span<const PageAccess> accesses) {
  for (const PageAccess& access : accesses) {
    if (access.page >= states_.size()) continue;
    PageState& state = states_[access.page];
    const auto after = state_after(state, access);
    if (!after || *after == state) continue;
    state = *after;
    ++changes_;
  }
}

PageActivity::Counts PageActivity::count(std::size_t first, std::size_t last) const {
  Counts counts;
  for (std::size_t page = first; page < last; ++page)
    ++counts.of[static_cast<std::size_t>(states_[page])];
  return counts;
}

std::vector<PageActivity::Counts> PageActivity::count_levels(std::size_t first,
                                                             std::size_t last) const {
  std::vector<Counts> levels;
  for (std::size_t page = first; page < last; ++page) {
    if (levels.size() <= levels_[page]) levels.resize(levels_[page] + std::size_t{1});
    ++levels[levels_[page]].of[static_cast<std::size_t>(states_[page])];
  }
  return levels;
}

}  // namespace planetree::tools
