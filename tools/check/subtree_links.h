#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>

namespace planetree::tools {

/// Links from page to page that have been seen, with what their source knows,
/// until the page they lead to comes. Links lead to pages of greater number, so
/// that one pass over the pages in their order meets both ends of each.
template <class Context>
class SubtreeLinks {
 public:
  struct Target {
    std::uint32_t page = 0;
    std::uint32_t slot = 0;
    bool leaf = false;
    auto operator<=>(const Target&) const = default;
  };

  /// False if a link to the same record is there already.
  bool add(Target target, Context context) {
    return links_.emplace(target, std::move(context)).second;
  }

  /// What the link to this subtree's root brought, if there is one.
  std::optional<Context> take(Target target) {
    const auto found = links_.find(target);
    if (found == links_.end()) return std::nullopt;
    std::optional<Context> context(std::move(found->second));
    links_.erase(found);
    return context;
  }

  /// Calls drop(target, context) for links to the page that nothing took, and
  /// forgets them.
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
