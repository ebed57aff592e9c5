#include "tests/octree/mask/random_mask.h"

#include <algorithm>
#include <bit>
#include <set>
#include <utility>

#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

class RandomMask {
 public:
  RandomMask(unsigned levels, std::uint64_t seed) : levels_(levels), noise_(seed) {}

  MaskTree take() {
    tree_.entries.resize(1);
    grow(0, 0);
    return std::move(tree_);
  }

 private:
  // A random corner number, neither kUncounted nor kListedTag.
  std::int8_t number() { return static_cast<std::int8_t>(noise_.bits() % 254 - 126); }

  void grow(std::uint32_t position, unsigned level) {
    tree_.levels = std::max(tree_.levels, level);
    MaskEntry entry;
    const unsigned chance = noise_.bits() % 16;
    if (level > 1 && (level == levels_ || chance < 9)) {
      make_leaf(chance, entry);
      tree_.entries[position] = entry;
      return;
    }
    entry.grey = static_cast<std::uint8_t>(noise_.bits() | noise_.bits());
    if (chance == 15 && level > 1) entry.grey = 0;
    if (level < 2) entry.grey |= 0x81;
    entry.black = static_cast<std::uint8_t>(noise_.bits() & ~unsigned{entry.grey});
    entry.inverted =
        static_cast<std::uint8_t>(noise_.bits() & ~unsigned{entry.grey} & ~unsigned{entry.black});
    entry.first = static_cast<std::uint32_t>(tree_.entries.size());
    tree_.entries.resize(entry.first + static_cast<unsigned>(std::popcount(entry.grey)));
    std::uint32_t child = entry.first;
    for (unsigned octant = 0; octant < 8; ++octant) {
      if ((entry.grey >> octant & 1) == 0) continue;
      grow(child, level + 1);
      if (tree_.entries[child++].is_leaf()) entry.leaf |= static_cast<std::uint8_t>(1u << octant);
    }
    tree_.entries[position] = entry;
  }

  void make_leaf(unsigned chance, MaskEntry& entry) {
    if (chance >= 7) return chance % 2 == 0 ? make_listed(entry) : make_special(entry);
    entry.kind = MaskEntry::Kind::kCorners;
    for (std::int8_t& corner : entry.corners)
      corner = chance < 5 ? static_cast<std::int8_t>(noise_.bits() % 2) : number();
    if (chance == 5) entry.corners.fill(kUncounted);
  }

  void make_special(MaskEntry& entry) {
    entry.kind = MaskEntry::Kind::kSpecial;
    entry.first = static_cast<std::uint32_t>(tree_.specials.size());
    SpecialCell special;
    special.plane_count = 1 + noise_.bits() % kMaxPlanes;
    special.behind = number();
    special.beyond = special.behind == 127 ? -127 : special.behind + 1;
    for (unsigned i = 0; i < special.plane_count; ++i)
      for (Point& corner : special.planes[i]) {
        const Vec3 at = noise_.point(0, 2);
        corner = {at.x, at.y, at.z};
      }
    tree_.specials.push_back(special);
  }

  void make_listed(MaskEntry& entry) {
    entry.kind = MaskEntry::Kind::kListed;
    entry.first = static_cast<std::uint32_t>(tree_.lists.size());
    // Mostly corner numbers as around a single closed surface.
    const int any = number();
    const int least = any % 4 == 0 ? std::min<int>(any, 126) : -(any & 1);
    for (std::int8_t& corner : entry.corners)
      corner = static_cast<std::int8_t>(least + static_cast<int>(noise_.bits() % 2));
    MaskBlocks blocks{};
    blocks.count = static_cast<std::uint8_t>(1 + noise_.bits() % kMaxListed);
    std::set<std::uint32_t> links;
    while (links.size() < blocks.count) links.insert(numbered_link(noise_.bits()));
    std::copy(links.begin(), links.end(), blocks.links.begin());
    for (unsigned i = 0; i < blocks.count; ++i)
      blocks.octants[i] = static_cast<std::uint8_t>(1 + noise_.bits() % 255);
    blocks.slab = slab_of(blocks.links[0]);
    tree_.lists.push_back(blocks);
  }

  static CellSlab slab_of(std::uint32_t link) {
    CellSlab slab;
    const auto slope = [](std::uint32_t bits) { return static_cast<int>(bits % 65) - 32; };
    slab.direction = CellSlab::make_direction(link % 3, slope(link), slope(link / 7));
    slab.lower = static_cast<std::uint8_t>(link % 101);
    slab.upper = static_cast<std::uint8_t>(slab.lower + link % 154);
    return slab;
  }

  // A numbered link to a block before kRandomMaskPage, whether pages have 4 KiB or up to 1 MiB.
  static std::uint32_t numbered_link(std::uint32_t bits) {
    constexpr std::uint32_t kNumbers = max_page_blocks(4096), kPages = 12;
    static_assert((kPages - 1) << 8 < kRandomMaskPage);
    const std::uint32_t at = bits % (kNumbers * kPages);
    return LinkFormat::numbered(1 << 20).make_block(
        {at / kNumbers, static_cast<std::uint16_t>(at % kNumbers)});
  }

  const unsigned levels_;
  Noise noise_;
  MaskTree tree_;
};

}  // namespace

MaskTree random_mask(unsigned levels, std::uint64_t seed) {
  return RandomMask(levels, seed).take();
}

}  // namespace planetree::octree
