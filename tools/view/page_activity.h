#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "planetree/trace.h"

namespace planetree::tools {

/// What became of a page since the model was opened.
enum class PageState : std::uint8_t {
  kUnread,    ///< no query has needed it
  kResident,  ///< in memory
  kWanted,    ///< a query needed it, and it is not in memory yet
  kEvicted,   ///< was in memory
};
inline constexpr std::size_t kPageStates = 4;

/// The states of all pages of a model, from the records of its page trace.
///
/// threads  one at a time
class PageActivity {
 public:
  /// levels  the octree level of each page
  explicit PageActivity(std::vector<std::uint8_t> levels);

  /// Adds records in the order in which Model::drain_page_trace returned them.
  void add(std::span<const PageAccess> accesses);

  std::span<const PageState> states() const { return states_; }
  std::span<const std::uint8_t> levels() const { return levels_; }
  /// Number of changes of states so far.
  std::uint64_t changes() const { return changes_; }
  /// Numbers of the pages `first` to `last` - 1 in each state.
  struct Counts {
    std::size_t of[kPageStates] = {};
    std::size_t operator[](PageState state) const { return of[static_cast<std::size_t>(state)]; }
    std::size_t all() const { return of[0] + of[1] + of[2] + of[3]; }
  };
  Counts count(std::size_t first, std::size_t last) const;
  /// The same for each level, from 0 to the finest.
  std::vector<Counts> count_levels(std::size_t first, std::size_t last) const;

 private:
  std::vector<std::uint8_t> levels_;
  std::vector<PageState> states_;
  std::uint64_t changes_ = 0;
};

}  // namespace planetree::tools
