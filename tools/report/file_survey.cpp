#include "tools/report/file_survey.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <utility>

#include "tools/check/mask_walk.h"
#include "tools/check/subtree_links.h"

namespace planetree::tools {
namespace {

class Surveyor {
 public:
  explicit Surveyor(FileParts& parts)
      : parts_(parts),
        links_(parts.links()),
        mask_(
            parts, [this](const GreyCell& grey) { count(grey); },
            [this](Issue issue) { survey_.issues.add(std::move(issue)); }) {}

  FileSurvey run(const PageVisitor& visit) {
    for (const Issue& issue : parts_.issues()) survey_.issues.add(issue);
    pending_.add({0, 0, parts_.header()->model.node_count == 0}, 0);
    for (std::uint32_t page = 0; page < parts_.page_count(); ++page) {
      PageRow row{page, parts_.entries()[page], {}, {}, {}, {}, false};
      survey_page(row);
      if (!visit(row)) break;
    }
    return std::move(survey_);
  }

 private:
  void survey_page(PageRow& row) {
    std::optional<Issue> issue = parts_.load_page(row.number);
    const bool mask = row.number >= parts_.first_mask_page();
    if (parts_.is_field_page(row.number)) return survey_field_page(row, std::move(issue));
    if (parts_.is_attribute_page(row.number)) return survey_attributes(row, std::move(issue));
    const bool caps = !mask && row.number >= parts_.first_cap_page();
    row.is_of_caps = caps;
    if (issue) {
      survey_.issues.add(*std::move(issue));
      if (mask) return mask_.skip_page(row.number);
      if (caps) return;
      return pending_.finish_page(row.number, [](const auto&, const auto&) {});
    }
    if (mask) {
      row.mask = add_streams<octree::MaskStreams>(survey_.mask_streams);
      survey_.lists += row.mask->listed_count;
      return mask_.add(row.number);
    }
    row.head = add_streams<octree::RawStreams>(caps ? survey_.cap_streams : survey_.streams);
    if (caps) return;
    const FrameView frame = parts_.frame();
    frame.for_each_block([&](std::uint32_t, const octree::BlockView& block) {
      survey_.height_fields += block.header().is_height_field() ? 1 : 0;
    });
    add_levels(row.number);
  }

  void survey_field_page(PageRow& row, std::optional<Issue> issue) {
    if (issue) return survey_.issues.add(*std::move(issue));
    row.field = parts_.field_head();
    add(stream_rows(*row.field), survey_.field_streams);
  }

  void survey_attributes(PageRow& row, std::optional<Issue> issue) {
    if (issue) return survey_.issues.add(*std::move(issue));
    row.attributes = parts_.attribute_head();
    add(stream_rows(*row.attributes, query::attribute_shape(parts_.header()->model)),
        survey_.attribute_streams);
  }

  MaskLevelRow& mask_level(std::size_t level) {
    if (survey_.mask.size() <= level) survey_.mask.resize(level + 1);
    return survey_.mask[level];
  }

  void count(const GreyCell& grey) {
    MaskLevelRow& row = mask_level(grey.cell.level);
    ++row.grey;
    row.corners += grey.corners != nullptr || grey.listed != nullptr;
    row.special += grey.special != nullptr;
    if (grey.node == nullptr) return;
    const auto count_bits = [](unsigned mask) {
      return static_cast<unsigned>(std::popcount(mask));
    };
    const unsigned inside = grey.node->black() | grey.node->inverted;
    MaskLevelRow& below = mask_level(grey.cell.level + 1);
    below.black += count_bits(inside);
    below.white += 8 - count_bits(inside | grey.node->grey);
  }

  // Adds the stream sizes of the current page to `sums`. Returns the page's head.
  template <class Streams>
  decltype(Streams::head) add_streams(std::vector<StreamRow>& sums) const {
    Streams streams;
    const bool whole = parts_.read(streams);
    assert(whole);
    static_cast<void>(whole);
    add(stream_rows(streams, parts_.shape()), sums);
    return streams.head;
  }

  static void add(const std::vector<StreamRow>& rows, std::vector<StreamRow>& sums) {
    if (sums.empty()) {
      sums = rows;
      return;
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
      sums[i].elements += rows[i].elements;
      sums[i].bytes += rows[i].bytes;
    }
  }

  // Depths of a page's records. Empty where no link from above was seen.
  using Depths = std::vector<std::optional<std::uint32_t>>;

  LevelRow& level(std::uint32_t depth) {
    if (survey_.levels.size() <= depth) survey_.levels.resize(depth + 1);
    return survey_.levels[depth];
  }

  void add_levels(std::uint32_t page) {
    const FrameView frame = parts_.frame();
    const octree::FrameHeader& header = frame.header();
    Depths node_depths(header.node_count), block_depths(header.block_count);
    for (std::uint32_t i = 0; i < header.root_count; ++i)
      node_depths[i] = pending_.take({page, i, false});
    for (std::uint32_t i = 0; i < header.node_count; ++i)
      if (node_depths[i]) add_node(page, frame, i, *node_depths[i], node_depths, block_depths);
    bool reached = true;
    if (header.node_count == 0)
      if (const auto depth = pending_.take({page, 0, true})) block_depths[0] = *depth;
    frame.for_each_block([&](std::uint32_t index, const octree::BlockView& block) {
      const std::optional<std::uint32_t>& depth = block_depths[index];
      reached = reached && depth.has_value();
      if (!depth) return;
      LevelRow& row = level(*depth);
      ++row.blocks;
      row.triangles += block.triangle_count();
    });
    std::optional<std::uint32_t> highest;
    const auto raise = [&highest](std::uint32_t depth) {
      highest = std::min(depth, highest.value_or(depth));
    };
    for (const auto& depth : node_depths) {
      reached = reached && depth.has_value();
      if (depth) raise(*depth);
    }
    for (const auto& depth : block_depths)
      if (depth) raise(*depth);
    if (highest) {
      ++level(*highest).pages;
      level(*highest).page_bytes += parts_.entries()[page].stored_bytes;
    }
    if (!reached) ++survey_.unreached_pages;
    pending_.finish_page(page, [](const auto&, const auto&) {});
  }

  void add_node(std::uint32_t page, const FrameView& frame, std::uint32_t index,
                std::uint32_t depth, Depths& node_depths, Depths& block_depths) {
    const octree::Node& node = frame.node(index);
    LevelRow& row = level(depth);
    ++row.nodes;
    row.children += node.child_count;
    for (unsigned child = 0; child < node.child_count; ++child) {
      const std::uint32_t link = node.link[child];
      const bool leaf = octree::LinkFormat::is_leaf(link);
      const std::uint32_t record = links_.record(link);
      if (links_.page(link) != page)
        pending_.add({links_.page(link), record, false}, depth + 1);
      else
        (leaf ? block_depths : node_depths)[record] = depth + 1;
    }
  }

  FileParts& parts_;
  octree::LinkFormat links_;
  FileSurvey survey_;
  SubtreeLinks<std::uint32_t> pending_;  // context: depth of the linked record
  MaskWalk mask_;
};

}  // namespace

FileSurvey survey_file(FileParts& parts, const PageVisitor& visit) {
  if (parts.header() != nullptr) return Surveyor(parts).run(visit);
  FileSurvey survey;
  for (const Issue& issue : parts.issues()) survey.issues.add(issue);
  return survey;
}

}  // namespace planetree::tools
