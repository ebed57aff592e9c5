#include "tests/golden/spec_mask.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "tests/golden/spec_streams.h"

namespace planetree::golden {
namespace {

struct MaskHead {
  std::uint32_t page_number, ordinal;
  std::uint64_t octcode;
  std::uint16_t records, roots, nodes, page_links, plain, corners, special, planes;
  std::uint16_t listed, block_links;
  std::uint32_t reserved;
};
static_assert(sizeof(MaskHead) == 40);

class MaskPageReader {
 public:
  MaskPageReader(std::span<const std::byte> raw, std::uint32_t number, const SpecHeader& header)
      : header_(header), number_(number), layout_(raw) {
    std::memcpy(&head_, layout_.bytes(40).data(), 40);
    require(head_.page_number == number, "another page");
    require(head_.reserved == 0, "reserved bytes");
  }

  SpecMaskPage read() {
    cut();
    std::uint32_t weight = head_.records + 9u * head_.planes;
    for (const unsigned count : block_counts_) weight += (count + 7) / 8 + (count + 2) / 2;
    require(weight <= header_.page_bytes / 8 - header_.page_bytes / 512 - 8,
            "the records do not fit");
    SpecMaskPage page{head_.octcode, head_.ordinal, head_.roots, {}};
    next_family_ = head_.roots;
    for (std::size_t i = 0; i < head_.records; ++i) {
      require(i < next_family_, "a record without a parent");
      page.records.push_back(read_record(kinds_[i]));
    }
    require(next_family_ == head_.records && node_ == head_.nodes && link_ == head_.page_links &&
                plain_ == head_.plain && corners_ == head_.corners && special_ == head_.special &&
                plane_ == head_.planes && listed_ == head_.listed && block_ == head_.block_links,
            "records do not add up");
    return page;
  }

 private:
  void cut() {
    kinds_ = layout_.byte_split<std::uint8_t>(head_.records);
    for (std::vector<std::uint8_t>& masks : masks_)
      masks = layout_.byte_split<std::uint8_t>(head_.nodes);
    linked_pages_ = layout_.byte_split<std::uint32_t>(head_.page_links);
    linked_records_ = layout_.byte_split<std::uint16_t>(head_.page_links);
    corner_bits_ = layout_.byte_split<std::uint8_t>(head_.plain);
    corner_numbers_ = layout_.byte_split<std::int8_t>(8u * head_.corners);
    plane_counts_ = layout_.byte_split<std::uint8_t>(head_.special);
    behind_ = layout_.byte_split<std::int8_t>(head_.special);
    beyond_ = layout_.byte_split<std::int8_t>(head_.special);
    coordinates_ = layout_.either<float, double>(header_.float64, 9u * head_.planes);
    min_ = layout_.byte_split<std::int8_t>(head_.listed);
    higher_ = layout_.byte_split<std::uint8_t>(head_.listed);
    block_counts_ = layout_.byte_split<std::uint8_t>(head_.listed);
    slab_directions_ = layout_.byte_split<std::uint16_t>(head_.listed);
    slab_lowers_ = layout_.byte_split<std::uint8_t>(head_.listed);
    slab_uppers_ = layout_.byte_split<std::uint8_t>(head_.listed);
    block_octants_ = layout_.byte_split<std::uint8_t>(head_.block_links);
    block_pages_ = layout_.byte_split<std::uint32_t>(head_.block_links);
    block_numbers_ = layout_.byte_split<std::uint16_t>(head_.block_links);
    require(layout_.empty(), "the page is too long");
  }

  SpecMaskRecord read_record(unsigned kind) {
    SpecMaskRecord record;
    record.kind = kind;
    require(kind <= 5, "kind of a record");
    if (kind < 2) read_node(record);
    if (kind == 2) {
      const unsigned bits = corner_bits_.at(plain_++);
      for (unsigned i = 0; i < 8; ++i) record.corners[i] = static_cast<int>(bits >> i & 1);
    }
    if (kind == 3) read_corners(record);
    if (kind == 4) read_special(record);
    if (kind == 5) read_listed(record);
    return record;
  }

  void read_corners(SpecMaskRecord& record) {
    for (unsigned i = 0; i < 8; ++i) record.corners[i] = corner_numbers_.at(8 * corners_ + i);
    ++corners_;
    const auto least = std::ranges::min(record.corners),
               greatest = std::ranges::max(record.corners);
    require(least >= -126 || greatest == -128, "numbers of corners");
  }

  void read_node(SpecMaskRecord& record) {
    record.grey = masks_[0].at(node_);
    record.leaf = masks_[1].at(node_);
    record.black = masks_[2].at(node_);
    record.inverted = masks_[3].at(node_);
    ++node_;
    require((record.leaf & ~record.grey) == 0 && (record.grey & record.black) == 0 &&
                ((record.grey | record.black) & record.inverted) == 0,
            "colours");
    if (record.kind == 1) {
      require(record.grey != 0, "a family of nobody");
      record.family = {linked_pages_.at(link_), linked_records_.at(link_)};
      ++link_;
      require(
          number_ - header_.d() < record.family.first && record.family.first < header_.mask_pages,
          "a page link");
      return;
    }
    record.family = {number_ - header_.d(), next_family_};
    for (unsigned octant = 0; octant < 8; ++octant)
      if ((record.grey >> octant & 1) != 0)
        require((kinds_.at(next_family_++) >= 2) == ((record.leaf >> octant & 1) != 0), "leaves");
  }

  void read_special(SpecMaskRecord& record) {
    record.behind = behind_.at(special_);
    record.beyond = beyond_.at(special_);
    require(record.behind != record.beyond, "sides of a special cell");
    const unsigned count = plane_counts_.at(special_++);
    require(count >= 1 && count <= 4, "planes of a special cell");
    for (unsigned i = 0; i < count; ++i, ++plane_) {
      SpecPlane plane{};
      for (std::size_t k = 0; k < 9; ++k) plane[k / 3][k % 3] = coordinates_.at(9 * plane_ + k);
      record.planes.push_back(plane);
    }
  }

  void read_listed(SpecMaskRecord& record) {
    const int least = min_.at(listed_);
    require(least >= -126 && least <= 126, "numbers of corners");
    for (unsigned i = 0; i < 8; ++i)
      record.corners[i] = least + static_cast<int>(higher_.at(listed_) >> i & 1);
    record.slab = read_slab();
    const unsigned count = block_counts_.at(listed_++);
    require(count >= 1 && count <= 16, "blocks of a list");
    for (unsigned i = 0; i < count; ++i, ++block_) {
      const std::uint32_t number = block_numbers_.at(block_);
      const SpecListedBlock block{block_octants_.at(block_),
                                  spec_link(true, block_pages_.at(block_), number)};
      require(block.octants != 0, "a listed block without an octant");
      require(page_of_link(block.link) < header_.e(), "a list's page");
      require(number < header_.page_bytes / 256, "a list's block");
      require(i == 0 || record.blocks.back().link < block.link, "order of a list");
      record.blocks.push_back(block);
    }
  }

  SpecSlab read_slab() const {
    const unsigned direction = slab_directions_.at(listed_);
    SpecSlab slab;
    slab.axis = direction & 3;
    slab.p = static_cast<int>(direction >> 2 & 0x7f) - 32;
    slab.q = static_cast<int>(direction >> 9) - 32;
    slab.lower = slab_lowers_.at(listed_);
    slab.upper = slab_uppers_.at(listed_);
    require(slab.axis < 3 && slab.p <= 32 && slab.q <= 32, "a slab's direction is out of range");
    require(slab.lower <= slab.upper, "a slab's planes are the wrong way round");
    return slab;
  }

  const SpecHeader& header_;
  std::uint32_t number_;
  StreamReader layout_;
  MaskHead head_{};
  std::vector<std::uint8_t> kinds_, corner_bits_, plane_counts_;
  std::vector<std::uint8_t> higher_, block_counts_, block_octants_, slab_lowers_, slab_uppers_;
  std::vector<std::uint16_t> slab_directions_, linked_records_, block_numbers_;
  std::array<std::vector<std::uint8_t>, 4> masks_;
  std::vector<std::uint32_t> linked_pages_, block_pages_;
  std::vector<std::int8_t> corner_numbers_, behind_, beyond_, min_;
  std::vector<double> coordinates_;
  std::size_t next_family_ = 0;
  std::size_t node_ = 0, link_ = 0, plain_ = 0, corners_ = 0, special_ = 0, plane_ = 0;
  std::size_t listed_ = 0, block_ = 0;
};

}  // namespace

SpecCell SpecCell::octant(unsigned number) const {
  SpecCell cell{level + 1, {}};
  for (unsigned axis = 0; axis < 3; ++axis) cell.at[axis] = 2 * at[axis] + (number >> axis & 1);
  return cell;
}

double SpecSlab::height(const SpecPoint& u) const {
  return 32 * u[axis] + p * u[(axis + 1) % 3] + q * u[(axis + 2) % 3] - std::min(p, 0) -
         std::min(q, 0);
}

double SpecSlab::width() const { return 32 + std::abs(p) + std::abs(q); }

bool SpecSlab::is_above(const SpecPoint& u) const {
  return bounds_above() && 256 * height(u) >= (upper + 1) * width();
}

bool SpecSlab::is_below(const SpecPoint& u) const {
  return bounds_below() && 256 * height(u) <= lower * width();
}

unsigned SpecSlab::top() const {
  return 1U << axis | unsigned{p >= 0} << (axis + 1) % 3 | unsigned{q >= 0} << (axis + 2) % 3;
}

SpecMaskPage decode_spec_mask_page(std::span<const std::byte> raw, std::uint32_t number,
                                   const SpecHeader& header) {
  return MaskPageReader(raw, number, header).read();
}

SpecMask::SpecMask(const SpecFile& file) : header_(file.header()) {
  for (std::uint32_t k = header_.d(); k < header_.page_count; ++k)
    pages_.push_back(decode_spec_mask_page(file.raw_page(k), k, header_));
}

const SpecMaskRecord& SpecMask::octant(const SpecMaskRecord& node, unsigned number) const {
  const auto [page, first] = node.family;
  const unsigned before = node.grey & ((1U << number) - 1);
  return pages_.at(page).records.at(first + static_cast<unsigned>(std::popcount(before)));
}

SpecPoint SpecMask::corner(const SpecCell& cell, unsigned number) const {
  SpecPoint point{};
  for (unsigned axis = 0; axis < 3; ++axis) {
    const double lower = std::ldexp(header_.core_lower[axis], header_.scale_exponent);
    const double i = cell.at[axis] + (number >> axis & 1);
    const double side = lower + std::ldexp(i, 1 - static_cast<int>(cell.level));
    point[axis] = std::clamp(side, header_.wall_lower[axis], header_.wall_upper[axis]);
  }
  return point;
}

SpecPoint SpecMask::in_cell(const SpecCell& cell, const SpecPoint& point) const {
  SpecPoint u{};
  for (unsigned axis = 0; axis < 3; ++axis) {
    const int level = static_cast<int>(cell.level);
    const double lower = std::ldexp(header_.core_lower[axis], header_.scale_exponent);
    const double side = lower + std::ldexp(cell.at[axis], 1 - level);
    u[axis] = std::ldexp(point[axis] - side, level - 1);
  }
  return u;
}

void SpecMask::each_grey(
    const std::function<void(const SpecCell&, const SpecMaskRecord&)>& look) const {
  std::vector<std::pair<SpecCell, const SpecMaskRecord*>> left = {{SpecCell{}, &root()}};
  while (!left.empty()) {
    const auto [cell, record] = left.back();
    left.pop_back();
    look(cell, *record);
    if (!record->is_node()) continue;
    for (unsigned i = 0; i < 8; ++i)
      if ((record->grey >> i & 1) != 0) left.emplace_back(cell.octant(i), &octant(*record, i));
  }
}

}  // namespace planetree::golden
