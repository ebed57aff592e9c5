#include "tools/check/tree_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "query/answer/model_geometry.h"
#include "query/file/scale.h"
#include "tools/check/page_rules.h"
#include "tools/check/subtree_links.h"

namespace planetree::tools {
namespace {

using octree::FloatBox;
using octree::Node;

/// What the node with a link to another page states about the subtree there.
struct SubtreeClaim {
  std::shared_ptr<const Bounds> bounds;  // null for the root of the tree
  std::uint64_t parent = 0;              // key of that node in TreeCheck::open_nodes_
  bool is_root = false;
};

/// A node with children in later pages, which are needed to check its height.
struct OpenNode {
  std::uint32_t page = 0;
  std::uint8_t height = 0;
  std::uint8_t highest_child = 0;
  std::uint8_t children_left = 0;
};

/// Checks the pages of one tree. Counts what it finds in the report.
class TreeCheck {
 public:
  // geometry  null: only the structure is checked
  TreeCheck(FileParts& parts, const TreeSection& section, GeometryCheck* geometry,
            CheckReport& report)
      : parts_(parts),
        header_(*parts.header()),
        section_(section),
        links_(parts.links()),
        report_(report),
        geometry_(geometry),
        nodes_before_(report.nodes),
        blocks_before_(report.blocks) {}

  /// Returns whether all pages were readable and all links led to records.
  bool run(const CheckProgress& progress);

 private:
  using Links = SubtreeLinks<SubtreeClaim>;
  using Chain = std::shared_ptr<const Bounds>;

  void check_page(std::uint32_t page);
  std::optional<Issue> load();
  void check_roots();
  void check_root_node(std::uint32_t index, const FloatBox& box);
  void check_root_box(const FloatBox& box);
  void check_nodes();
  void check_node(std::uint32_t index);
  void follow_link(std::uint32_t index, unsigned child, OpenNode& open);
  void check_blocks();
  void settle_height(std::uint64_t parent, std::uint8_t child_height);
  void prove_height(const OpenNode& node);
  void compare(const char* what, std::uint64_t stated, std::uint64_t found);
  void check_counts();

  void report(IssueCode code, std::string message) {
    report_.issues.add({code, page_, Error::kNowhere, std::move(message)});
  }
  void report_whole(IssueCode code, std::string message) {
    report_.issues.add({code, Error::kNowhere, Error::kNowhere, std::move(message)});
  }
  std::uint64_t key_of(std::uint32_t node) const { return std::uint64_t{page_} << 32 | node; }

  FileParts& parts_;
  const storage::FileHeader& header_;
  const TreeSection section_;
  octree::LinkFormat links_;
  CheckReport& report_;
  GeometryCheck* const geometry_;
  const std::uint64_t nodes_before_, blocks_before_;
  std::uint64_t triangles_ = 0;
  Links pending_;
  std::map<std::uint64_t, OpenNode> open_nodes_;
  bool complete_ = true;  // whether all pages so far were readable and all links led to records

  // Of the current page.
  std::uint32_t page_ = 0;
  std::uint32_t ordinal_ = 0;  // its rank among the pages of its octcode
  std::optional<FrameView> frame_;
  std::vector<Chain> node_bounds_;   // by node
  std::vector<Chain> block_bounds_;  // by block
};

bool TreeCheck::run(const CheckProgress& progress) {
  SubtreeClaim whole;
  whole.is_root = true;
  pending_.add({section_.first_page, 0, section_.nodes == 0}, whole);
  if (section_.first_page == section_.end_page) complete_ = false;
  for (std::uint32_t page = section_.first_page; page < section_.end_page; ++page) {
    check_page(page);
    if (progress) progress(page + 1);
  }
  if (section_.first_page == section_.end_page && parts_.page_count() > 0)
    report_whole(IssueCode::kLinkTarget, "the header states no page with the root");
  check_counts();
  return complete_;
}

void TreeCheck::check_page(std::uint32_t page) {
  page_ = page;
  const auto octcode = [this](std::uint32_t of) { return parts_.entries()[of].octcode; };
  const bool follows = page > section_.first_page && octcode(page - 1) == octcode(page);
  ordinal_ = follows ? ordinal_ + 1 : 0;
  std::optional<Issue> issue = load();
  if (issue) {
    report_.issues.add(*std::move(issue));
    complete_ = false;
    pending_.finish_page(page, [this](const Links::Target&, const SubtreeClaim& claim) {
      open_nodes_.erase(claim.parent);
    });
    return;
  }
  node_bounds_.assign(frame_->node_count(), nullptr);
  block_bounds_.assign(frame_->block_count(), nullptr);
  ++report_.pages;
  report_.nodes += frame_->node_count();
  report_.blocks += frame_->header().block_count;
  check_roots();
  check_nodes();
  check_blocks();
}

// Loads the current page. Empty if it is sound by itself.
std::optional<Issue> TreeCheck::load() {
  if (std::optional<Issue> issue = parts_.load_page(page_)) return issue;
  frame_.emplace(parts_.frame());
  octree::RawStreams streams;
  if (!parts_.read(streams)) return std::nullopt;
  const char* fault = fault_of_rules(streams, *frame_, ordinal_);
  if (!fault) return std::nullopt;
  return Issue{IssueCode::kPageStructure, page_, parts_.entries()[page_].offset, fault};
}

void TreeCheck::check_roots() {
  octree::RawStreams streams;
  parts_.read(streams);
  const octree::FrameHeader& header = frame_->header();
  for (std::uint32_t i = 0; i < header.root_count; ++i) {
    FloatBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.lower[axis] = streams.root_boxes[6 * std::size_t{i} + axis];
      box.upper[axis] = streams.root_boxes[6 * std::size_t{i} + 3 + axis];
    }
    check_root_node(i, box);
  }
  if (header.node_count == 0 && pending_.take({page_, 0, true}) && section_.height != 0)
    report(IssueCode::kHeight, "the root is a block, but the header's height is not 0");
  pending_.finish_page(page_, [this](const Links::Target& target, const SubtreeClaim& claim) {
    report(IssueCode::kLinkTarget,
           fmt::format("a link leads to {} {}, which is no root of a subtree",
                       target.leaf ? "block" : "node", target.record));
    open_nodes_.erase(claim.parent);
    complete_ = false;
  });
}

void TreeCheck::check_root_node(std::uint32_t index, const FloatBox& box) {
  const auto claim = pending_.take({page_, index, false});
  if (!claim) {
    if (complete_)
      report(IssueCode::kSubtreeUnlinked, fmt::format("no link leads to node {}", index));
    return;
  }
  const std::uint8_t height = frame_->node(index).height;
  if (claim->is_root) {
    if (!section_.is_of_caps) check_root_box(box);
    if (geometry_) geometry_->add_root(box);
    if (height != section_.height)
      report(IssueCode::kHeight, fmt::format("the root's height is {}, but the header states {}",
                                             height, section_.height));
    return;
  }
  node_bounds_[index] = claim->bounds;
  if (!claim->bounds->box.holds(box))
    report(IssueCode::kSubtreeBox,
           fmt::format("the box of node {} is not within the one its parent states", index));
  settle_height(claim->parent, height);
}

/// Checks that the root's box encloses the header's box. In the file of a region with walls it need
/// not, because the header's box is that of the whole input.
void TreeCheck::check_root_box(const FloatBox& box) {
  const storage::ModelRecord& model = header_.model;
  if (query::region_of(model).has_walls()) return;
  const query::Scale scale(model.scale_exponent);
  for (int axis = 0; axis < 3; ++axis) {
    const double lower = scale.in(model.box_lower[axis]) - model.centre[axis];
    const double upper = scale.in(model.box_upper[axis]) - model.centre[axis];
    if (static_cast<double>(box.lower[axis]) <= lower &&
        upper <= static_cast<double>(box.upper[axis]))
      continue;
    return report(IssueCode::kRootBox, "the root's box does not enclose the header's box");
  }
}

void TreeCheck::check_nodes() {
  for (std::uint32_t i = 0; i < frame_->node_count(); ++i) check_node(i);
}

void TreeCheck::check_node(std::uint32_t index) {
  const Node& node = frame_->node(index);
  if (geometry_ && node_bounds_[index]) geometry_->add_node(node, page_, *node_bounds_[index]);
  OpenNode open;
  open.page = page_;
  open.height = node.height;
  for (unsigned child = 0; child < node.child_count; ++child) {
    const std::uint32_t link = node.link[child];
    const bool here = links_.page(link) == page_;
    if (!here) {
      follow_link(index, child, open);
      continue;
    }
    if (!octree::LinkFormat::is_leaf(link)) {
      const std::uint8_t height = frame_->node(links_.record(link)).height;
      open.highest_child = std::max(open.highest_child, height);
    }
    if (!geometry_) continue;
    auto bounds = std::make_shared<const Bounds>(
        Bounds{child_box(node, child), child_disc(node, child), frame_->moments(node, child),
               node_bounds_[index], 0});
    const bool is_block = octree::LinkFormat::is_leaf(link);
    (is_block ? block_bounds_ : node_bounds_)[links_.record(link)] = std::move(bounds);
  }
  if (open.children_left > 0)
    open_nodes_.emplace(key_of(index), open);
  else
    prove_height(open);
}

void TreeCheck::follow_link(std::uint32_t index, unsigned child, OpenNode& open) {
  const Node& node = frame_->node(index);
  const std::uint32_t link = node.link[child];
  const std::uint32_t to = links_.record(link);
  SubtreeClaim claim;
  Bounds bounds{child_box(node, child), child_disc(node, child), frame_->moments(node, child),
                node_bounds_[index], 0};
  if (geometry_) bounds.subtree = geometry_->add_subtree(links_.page(link));
  claim.bounds = std::make_shared<const Bounds>(std::move(bounds));
  claim.parent = key_of(index);
  if (pending_.add({links_.page(link), to, false}, std::move(claim)))
    ++open.children_left;
  else
    report(IssueCode::kLinkTwice,
           fmt::format("a second link leads to page {}, node {}", links_.page(link), to));
}

void TreeCheck::check_blocks() {
  frame_->for_each_block([&](std::uint32_t index, const octree::BlockView& block) {
    triangles_ += block.triangle_count();
    // Indices ascend within a block.
    const std::uint64_t last = block.id(block.triangle_count() - 1);
    if (last >= section_.indices)
      report(IssueCode::kTriangleRange,
             fmt::format("a {} has index {}, but the model has {} indices",
                         section_.is_of_caps ? "cap" : "triangle", last, section_.indices));
    if (!geometry_) return;
    geometry_->add(block, page_, block_bounds_[index].get());
  });
}

void TreeCheck::settle_height(std::uint64_t parent, std::uint8_t child_height) {
  const auto found = open_nodes_.find(parent);
  if (found == open_nodes_.end()) return;
  OpenNode& node = found->second;
  node.highest_child = std::max(node.highest_child, child_height);
  if (--node.children_left > 0) return;
  prove_height(node);
  open_nodes_.erase(found);
}

void TreeCheck::prove_height(const OpenNode& node) {
  if (node.height == node.highest_child + 1) return;
  report_.issues.add(
      {IssueCode::kHeight, node.page, Error::kNowhere,
       fmt::format("a node states the height {}, but the greatest height below it is {}",
                   node.height, node.highest_child)});
}

void TreeCheck::compare(const char* what, std::uint64_t stated, std::uint64_t found) {
  if (stated != found)
    report_whole(IssueCode::kCount, fmt::format("the header states {} {}, but the pages hold {}",
                                                stated, what, found));
}

void TreeCheck::check_counts() {
  if (!section_.is_of_caps) report_.triangles += triangles_;
  if (!complete_) return;
  const bool caps = section_.is_of_caps;
  compare(caps ? "nodes of caps" : "nodes", section_.nodes, report_.nodes - nodes_before_);
  compare(caps ? "blocks of caps" : "blocks", section_.blocks, report_.blocks - blocks_before_);
  compare(caps ? "caps" : "triangles", section_.triangles, triangles_);
}

}  // namespace

bool check_tree(FileParts& parts, const TreeSection& section, GeometryCheck* geometry,
                CheckReport& report, const CheckProgress& progress) {
  return TreeCheck(parts, section, geometry, report).run(progress);
}

}  // namespace planetree::tools
