#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>

namespace planetree::tools {

/// Pending links to later pages, each with a context from its source. Links lead to pages of
/// greater number, so that one pass over the pages in ascending order meets both ends of each link.
template <class Context>
class SubtreeLinks {
 public:
  struct Target {
    std::uint32_t page = 0;
    std::uint32_t record = 0;  ///< number in the page
    bool leaf = false;
    auto operator<=>(const Target&) const = default;
  };

  /// Adds a link. False if a link to the same record exists.
  bool add(Target target, Context context) {
    return links_.emplace(target, std::move(context)).second;
  }

  /// Removes the link to a record and returns its context. Empty if there is none.
  std::optional<Context> take(Target target) {
    const auto found = links_.find(target);
    if (found == links_.end()) return std::nullopt;
    std::optional<Context> context(std::move(found->second));
    links_.erase(found);
    return context;
  }

  /// Removes all remaining links to the page and calls drop(target, context) for each.
  template <class Drop>
  void finish_page(std::uint32_t page, Drop drop) {
    const auto begin = links_.lower_bound(Target{page, 0, false});
    auto end = begin;
    for (; end != links_.end() && end->first.page == page; ++end) drop(end->first, end->second);
    links_.erase(begin, end);
  }

 private:
  std::map<Target, Context> links_;
};

}  // namespace planetree::tools
