#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tools/picture/band_scale.h"
#include "tools/picture/drawing.h"

namespace planetree::tools {

/// A colour bar: bands from the least value below to the greatest above, without gaps.
struct ColourBar {
  std::string name;               ///< for programs, such as "signed_distance"
  std::string heading;            ///< above the bar, such as "signed distance"
  std::string above, below;       ///< notes at its ends; may be empty
  std::vector<ColourBand> bands;  ///< in ascending order
  /// Where the bar is in the picture, in whole pixels; place_bars() sets it.
  std::uint32_t left = 0, top = 0, width = 0, height = 0;

  double lower() const { return bands.front().lower; }
  double upper() const { return bands.back().upper; }
};

/// A colour with its meaning.
struct LegendEntry {
  Rgb colour;
  bool is_line = false;  ///< a line, otherwise a filled box
  std::string text;
};

/// Colours of one kind.
struct LegendGroup {
  std::string heading;
  std::vector<LegendEntry> entries;
};

/// What the colours of a picture mean, in a column.
class Legend {
 public:
  static constexpr std::uint32_t kWidth = 236;  ///< of the column, in pixels

  std::vector<ColourBar> bars;
  std::vector<LegendGroup> groups;

  /// Places the bars below one another, and the groups below them.
  ///
  /// left, top   of the column
  /// bar_height  of the first bar, without heading and notes
  void place(std::uint32_t left, std::uint32_t top, std::uint32_t bar_height);
  /// The lower end of the column, once it is placed.
  std::uint32_t bottom() const { return bottom_; }
  /// Adds the shapes of the legend, which is placed.
  void draw(Drawing& drawing) const;

 private:
  std::uint32_t left_ = 0, groups_top_ = 0, bottom_ = 0;
};

/// A number for people: six digits, "0" for negative zero.
[[nodiscard]] std::string value_text(double value);

}  // namespace planetree::tools
