#pragma once

#include <span>
#include <vector>

#include "tools/picture/band_scale.h"
#include "tools/picture/legend.h"
#include "tools/slice/slice_field.h"

namespace planetree::tools {

/// The colours of a slice: bands of signed distance, blue outside and orange inside, and grey where
/// the side is unknown. With widths in their place, bands of these in green.
class SliceScales {
 public:
  /// shows_width   whether colours show widths
  /// pixel_length  the least band, for a slice on which all distances are 0
  SliceScales(std::span<const PixelAnswer> answers, bool shows_width, double pixel_length);

  /// Difference of distance between iso-lines: a round number, so that the greatest distance has 7
  /// to 18 bands. A band of distances is as long.
  double line_distance() const { return line_distance_; }
  double least_distance() const { return least_; }
  double greatest_distance() const { return greatest_; }

  /// Colour of a pixel, without lines. kNoValue if its value is infinite.
  Rgb colour(const PixelAnswer& answer) const;
  /// The bars of the colours that occur.
  std::vector<ColourBar> bars() const;

 private:
  ColourBar distance_bar() const;

  bool shows_width_;
  double least_ = 0, greatest_ = 0, line_distance_ = 1;
  BandScale outside_, inside_, unknown_, width_;
  // Number of bands up to the greatest value; 0 if there is none.
  std::uint32_t outside_bands_ = 0, inside_bands_ = 0, unknown_bands_ = 0, width_bands_ = 0;
};

}  // namespace planetree::tools
