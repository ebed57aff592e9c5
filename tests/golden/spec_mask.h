#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "tests/golden/spec_reader.h"

namespace planetree::golden {

/// A cell of the mask ("Mask"), by level and coordinates within the level.
struct SpecCell {
  unsigned level = 0;
  std::array<std::uint32_t, 3> at{};

  SpecCell octant(unsigned number) const;
};

using SpecPlane = std::array<SpecPoint, 3>;

/// An entry of the list of a listed leaf.
struct SpecListedBlock {
  unsigned octants;
  SpecLink link;  ///< leads to a SpecBlock
};

/// "Slabs of listed leaves". Points are in cell coordinates, as from SpecMask::in_cell().
struct SpecSlab {
  unsigned axis = 0;
  int p = 0, q = 0;  ///< slopes along the next two axes, in 32nds
  unsigned lower = 0, upper = 255;

  bool bounds_below() const { return lower != 0; }
  bool bounds_above() const { return upper != 255; }
  double height(const SpecPoint& u) const;
  double width() const;
  bool is_above(const SpecPoint& u) const;
  bool is_below(const SpecPoint& u) const;
  /// A corner of the cell with the greatest height. The opposite corner has the least.
  unsigned top() const;
};

/// The record of a grey cell.
struct SpecMaskRecord {
  unsigned kind = 0;
  unsigned grey = 0, leaf = 0, black = 0, inverted = 0;
  /// Page within the mask, and record, of the first grey octant.
  std::pair<std::size_t, std::size_t> family;
  std::array<int, 8> corners{};
  int behind = 0, beyond = 0;
  std::vector<SpecPlane> planes;
  std::vector<SpecListedBlock> blocks;
  SpecSlab slab;  ///< of a listed leaf only

  bool is_node() const { return kind < 2; }
  /// Whether the record has corner numbers. They may be -128: not stored.
  bool has_corners() const { return kind == 2 || kind == 3 || kind == 5; }
};

struct SpecMaskPage {
  std::uint64_t octcode;
  std::uint32_t ordinal;
  std::size_t root_count;
  std::vector<SpecMaskRecord> records;
};

/// Decodes the raw bytes of page `number` ("Mask page").
SpecMaskPage decode_spec_mask_page(std::span<const std::byte> raw, std::uint32_t number,
                                   const SpecHeader& header);

/// The mask of a file, with all its pages. Part of the independent reader: see spec_reader.h.
class SpecMask {
 public:
  explicit SpecMask(const SpecFile& file);

  const std::vector<SpecMaskPage>& pages() const { return pages_; }
  const SpecMaskRecord& root() const { return pages_.at(0).records.at(0); }
  /// The record of a grey octant.
  const SpecMaskRecord& octant(const SpecMaskRecord& node, unsigned number) const;
  /// Corner `number` of a cell in the model frame. In a file of a region it is clamped to the
  /// region.
  SpecPoint corner(const SpecCell& cell, unsigned number) const;
  /// The point relative to corner 0 of the unclamped cell, in units of the cell's side.
  SpecPoint in_cell(const SpecCell& cell, const SpecPoint& point) const;

  /// Calls look(cell, record) for every grey cell.
  void each_grey(const std::function<void(const SpecCell&, const SpecMaskRecord&)>& look) const;

 private:
  SpecHeader header_;
  std::vector<SpecMaskPage> pages_;
};

}  // namespace planetree::golden
