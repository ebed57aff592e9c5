#include "octree/builder/mask/mask_encoder.h"

#include <algorithm>

#include "octree/builder/tree/stream_writer.h"
#include "octree/page/mask_streams.h"

namespace planetree::octree {
namespace {

/// Collects the streams of one page.
class Streams {
 public:
  Streams(std::uint32_t page_bytes, std::uint32_t page)
      : block_links_(LinkFormat::numbered(page_bytes)), page_(page) {}

  void add_node(const MaskEntry& node, StoredLink family) {
    const bool above = node.grey != 0 && family.page != page_;
    add_kind(above ? MaskKind::kNodeWithLink : MaskKind::kNode);
    grey_.push_back(node.grey);
    leaf_.push_back(node.leaf);
    black_.push_back(node.black);
    inverted_.push_back(node.inverted);
    if (!above) return;
    linked_pages_.push_back(family.page);
    linked_records_.push_back(family.record);
  }

  void add_corners(const MaskCorners& corners) {
    std::uint8_t bits = 0;
    bool plain = true;
    for (unsigned corner = 0; corner < 8; ++corner) {
      plain = plain && (corners[corner] == 0 || corners[corner] == 1);
      bits |= static_cast<std::uint8_t>((corners[corner] & 1) << corner);
    }
    add_kind(plain ? MaskKind::kPlainCorners : MaskKind::kCorners);
    if (plain)
      plain_.push_back(bits);
    else
      corners_.insert(corners_.end(), corners.begin(), corners.end());
  }

  void add_special(const SpecialCell& special) {
    add_kind(MaskKind::kSpecial);
    plane_counts_.push_back(static_cast<std::uint8_t>(special.plane_count));
    behind_.push_back(static_cast<std::int8_t>(special.behind));
    beyond_.push_back(static_cast<std::int8_t>(special.beyond));
    for (unsigned i = 0; i < special.plane_count; ++i)
      for (const Point& corner : special.planes[i])
        planes_.insert(planes_.end(), corner.begin(), corner.end());
  }

  void add_listed(const MaskCorners& corners, const MaskBlocks& blocks) {
    const std::int8_t least = *std::min_element(corners.begin(), corners.end());
    std::uint8_t higher = 0;
    for (unsigned corner = 0; corner < 8; ++corner)
      higher |= static_cast<std::uint8_t>((corners[corner] - least) << corner);
    add_kind(MaskKind::kListed);
    min_.push_back(least);
    higher_.push_back(higher);
    block_counts_.push_back(blocks.count);
    slab_directions_.push_back(blocks.slab.direction);
    slab_lowers_.push_back(blocks.slab.lower);
    slab_uppers_.push_back(blocks.slab.upper);
    block_octants_.insert(block_octants_.end(), blocks.octants.begin(),
                          blocks.octants.begin() + blocks.count);
    for (unsigned i = 0; i < blocks.count; ++i) {
      block_pages_.push_back(block_links_.page(blocks.links[i]));
      block_numbers_.push_back(static_cast<std::uint16_t>(block_links_.record(blocks.links[i])));
    }
  }

  void describe(MaskPageHead& head) const {
    head.record_count = static_cast<std::uint16_t>(kinds_.size());
    head.node_count = static_cast<std::uint16_t>(grey_.size());
    head.page_link_count = static_cast<std::uint16_t>(linked_pages_.size());
    head.plain_count = static_cast<std::uint16_t>(plain_.size());
    head.corners_count = static_cast<std::uint16_t>(corners_.size() / 8);
    head.special_count = static_cast<std::uint16_t>(plane_counts_.size());
    head.plane_count = static_cast<std::uint16_t>(planes_.size() / 9);
    head.listed_count = static_cast<std::uint16_t>(block_counts_.size());
    head.block_link_count = static_cast<std::uint16_t>(block_pages_.size());
  }

  std::uint32_t link_count() const { return static_cast<std::uint32_t>(linked_pages_.size()); }

  // Returns the offset of the links to other pages.
  std::size_t write(StreamWriter& writer, bool float64) const {
    writer.byte_split(kinds_);
    writer.byte_split(grey_);
    writer.byte_split(leaf_);
    writer.byte_split(black_);
    writer.byte_split(inverted_);
    const std::size_t links_at = writer.size();
    writer.byte_split(linked_pages_);
    writer.byte_split(linked_records_);
    writer.byte_split(plain_);
    writer.byte_split(corners_);
    writer.byte_split(plane_counts_);
    writer.byte_split(behind_);
    writer.byte_split(beyond_);
    if (float64)
      writer.byte_split(planes_);
    else
      writer.byte_split(std::vector<float>(planes_.begin(), planes_.end()));
    writer.byte_split(min_);
    writer.byte_split(higher_);
    writer.byte_split(block_counts_);
    writer.byte_split(slab_directions_);
    writer.byte_split(slab_lowers_);
    writer.byte_split(slab_uppers_);
    writer.byte_split(block_octants_);
    writer.byte_split(block_pages_);
    writer.byte_split(block_numbers_);
    return links_at;
  }

 private:
  void add_kind(MaskKind kind) { kinds_.push_back(static_cast<std::uint8_t>(kind)); }

  const LinkFormat block_links_;
  const std::uint32_t page_;
  std::vector<std::uint8_t> kinds_, grey_, leaf_, black_, inverted_, plain_, plane_counts_;
  std::vector<std::uint8_t> higher_, block_counts_, slab_lowers_, slab_uppers_, block_octants_;
  std::vector<std::uint16_t> slab_directions_, linked_records_, block_numbers_;
  std::vector<std::uint32_t> linked_pages_, block_pages_;
  std::vector<std::int8_t> corners_, behind_, beyond_, min_;
  std::vector<double> planes_;
};

}  // namespace

EncodedPage MaskEncoder::encode(std::size_t page) const {
  const PlannedMaskPage& planned = plan_.pages[page];
  Streams streams(plan_.page_bytes, planned.number);
  for (const std::uint32_t at : planned.entries) {
    const MaskEntry& entry = mask_.entries[at];
    switch (entry.kind) {
      case MaskEntry::Kind::kNode:
      case MaskEntry::Kind::kSector:
        streams.add_node(entry, plan_.families[at]);
        break;
      case MaskEntry::Kind::kCorners:
        streams.add_corners(entry.corners);
        break;
      case MaskEntry::Kind::kSpecial:
        streams.add_special(mask_.specials[entry.first]);
        break;
      case MaskEntry::Kind::kListed:
        streams.add_listed(entry.corners, mask_.lists[entry.first]);
        break;
    }
  }
  MaskPageHead head{};
  head.page_number = first_page_ + planned.number;
  head.octcode = planned.octcode;
  head.ordinal = planned.ordinal;
  head.root_count = static_cast<std::uint16_t>(planned.root_count);
  streams.describe(head);
  StreamWriter writer;
  writer.plain(&head, sizeof head);
  EncodedPage encoded;
  encoded.links_at = static_cast<std::uint32_t>(streams.write(writer, float64_));
  encoded.link_count = streams.link_count();
  encoded.bytes = writer.take();
  return encoded;
}

}  // namespace planetree::octree
