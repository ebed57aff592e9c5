#include "tools/check/tree_descent.h"

#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace planetree::tools {
namespace {

/// A node that is to be opened.
struct NodeToVisit {
  std::uint32_t index = 0;
  std::uint32_t depth = 0;
};

Error damage(std::uint64_t page) {
  return make_error(ErrorCode::kDamaged, page, Error::kNowhere,
                    "it cannot be read; planetree verify says why");
}

class TreeDescent {
 public:
  using Visitor = std::function<bool(const TreePart&)>;

  TreeDescent(FileParts& parts, const Visitor& visit)
      : parts_(parts), visit_(visit), links_(parts.links()) {}

  Result<void> run(const std::function<void(std::uint32_t)>& progress) {
    if (auto begun = begin(); !begun) return begun;
    while (!open_.empty()) {
      const std::uint32_t page = open_.begin()->first;
      std::vector<NodeToVisit> nodes = std::move(open_.begin()->second);
      open_.erase(open_.begin());
      if (progress) progress(page);
      if (parts_.load_page(page)) return damage(page);
      while (!nodes.empty()) {
        const NodeToVisit next = nodes.back();
        nodes.pop_back();
        if (!open(page, next, nodes)) return damage(page);
      }
    }
    return {};
  }

 private:
  // The root's box is in no parent.
  Result<void> begin() {
    const storage::ModelRecord& model = parts_.header()->model;
    const std::uint32_t link = parts_.root_link();
    TreePart root;
    root.page = links_.page(link);
    root.is_block = octree::LinkFormat::is_leaf(link);
    root.begins_page = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto relative = [&](double at) {
        return static_cast<float>(std::ldexp(at, model.scale_exponent) - model.centre[axis]);
      };
      root.box.lower[axis] = relative(model.box_lower[axis]);
      root.box.upper[axis] = relative(model.box_upper[axis]);
    }
    if (visit_(root) && !root.is_block) {
      if (root.page >= parts_.first_cap_page()) return damage(root.page);
      open_[root.page].push_back({links_.record(link), 0});
    }
    return {};
  }

  // Returns false if a link leads to no node behind this one.
  bool open(std::uint32_t page, const NodeToVisit& at, std::vector<NodeToVisit>& nodes) {
    const FrameView frame = parts_.frame();
    if (at.index >= frame.node_count()) return false;
    const octree::Node& node = frame.node(at.index);
    // From the last on, since the last to be added is opened next.
    for (unsigned child = node.child_count; child-- > 0;) {
      const std::uint32_t link = node.link[child];
      const TreePart part = part_of(page, at.depth + 1, node, child);
      if (!visit_(part) || part.is_block) continue;
      const NodeToVisit next{links_.record(link), part.depth};
      if (part.page == page) {
        if (next.index <= at.index) return false;
        nodes.push_back(next);
      } else {
        if (part.page < page || part.page >= parts_.first_cap_page()) return false;
        open_[part.page].push_back(next);
      }
    }
    return true;
  }

  TreePart part_of(std::uint32_t page, std::uint32_t depth, const octree::Node& node,
                   unsigned child) const {
    const std::uint32_t link = node.link[child];
    TreePart part;
    part.depth = depth;
    part.page = links_.page(link);
    part.is_block = octree::LinkFormat::is_leaf(link);
    part.begins_page = part.page != page;
    part.is_only_child = node.child_count == 1;
    part.box = child_box(node, child);
    part.disc = child_disc(node, child);
    part.has_disc = std::isfinite(part.disc.radius) && std::isfinite(part.disc.slab_lower) &&
                    std::isfinite(part.disc.slab_upper);
    return part;
  }

  FileParts& parts_;
  const Visitor& visit_;
  const octree::LinkFormat links_;
  std::map<std::uint32_t, std::vector<NodeToVisit>> open_;  // by page
};

}  // namespace

Result<void> descend_tree(FileParts& parts, const std::function<bool(const TreePart&)>& visit,
                          const std::function<void(std::uint32_t page)>& progress) {
  if (parts.header() == nullptr)
    return make_error(ErrorCode::kDamaged, Error::kNowhere, Error::kNowhere,
                      "its header cannot be read; see planetree inspect");
  return TreeDescent(parts, visit).run(progress);
}

}  // namespace planetree::tools
