#include "tools/slice/slice_scales.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace planetree::tools {
namespace {

constexpr double kBands = 14;  // approximately; rounding gives 7 to 18

double band_length(double greatest) { return round_length(greatest / kBands * 2); }

std::uint32_t band_count(double greatest, double length) {
  return static_cast<std::uint32_t>(greatest / length) + 1;
}

}  // namespace

SliceScales::SliceScales(std::span<const PixelAnswer> answers, bool shows_width,
                         double pixel_length)
    : shows_width_(shows_width),
      least_(std::numeric_limits<double>::infinity()),
      outside_(kBlues, 1, 1),
      inside_(kOranges, 1, 1),
      unknown_(kGreys, 1, 1),
      width_(kGreens, 1, 1) {
  double widest = 0;
  for (const PixelAnswer& answer : answers) {
    if (std::isfinite(answer.width)) widest = std::max(widest, answer.width);
    if (!std::isfinite(answer.distance)) continue;
    least_ = std::min(least_, answer.distance);
    greatest_ = std::max(greatest_, answer.distance);
  }
  least_ = std::min(least_, greatest_);
  line_distance_ = band_length(std::max(greatest_, pixel_length));
  const std::uint32_t bands = band_count(greatest_, line_distance_);
  outside_ = BandScale(kBlues, line_distance_, bands);
  inside_ = BandScale(kOranges, line_distance_, bands);
  unknown_ = BandScale(kGreys, line_distance_, bands);
  const double band = band_length(std::max(widest, std::numeric_limits<double>::min() * 64));
  width_bands_ = band_count(widest, band);
  width_ = BandScale(kGreens, band, width_bands_);
  for (const PixelAnswer& answer : answers) {
    if (!std::isfinite(answer.distance)) continue;
    std::uint32_t& shown = answer.side == Side::kInside    ? inside_bands_
                           : answer.side == Side::kUnknown ? unknown_bands_
                                                           : outside_bands_;
    shown = std::max(shown, outside_.band_of(answer.distance) + 1);
  }
}

Rgb SliceScales::colour(const PixelAnswer& answer) const {
  const double value = shows_width_ ? answer.width : answer.distance;
  if (!std::isfinite(value)) return kNoValue;
  const BandScale& scale = shows_width_                    ? width_
                           : answer.side == Side::kInside  ? inside_
                           : answer.side == Side::kUnknown ? unknown_
                                                           : outside_;
  return scale.colour(scale.band_of(value));
}

ColourBar SliceScales::distance_bar() const {
  ColourBar bar{"signed_distance", "signed distance", "", "", {}};
  if (outside_bands_ > 0) bar.above = "outside";
  if (inside_bands_ > 0) bar.below = "inside";
  for (const ColourBand& band : inside_.bands(inside_bands_))
    bar.bands.push_back({-band.upper, -band.lower, band.colour});
  std::reverse(bar.bands.begin(), bar.bands.end());
  const auto outside = outside_.bands(outside_bands_);
  bar.bands.insert(bar.bands.end(), outside.begin(), outside.end());
  return bar;
}

std::vector<ColourBar> SliceScales::bars() const {
  if (shows_width_)
    return {{"interval_width", "width of the interval", "", "", width_.bands(width_bands_)}};
  std::vector<ColourBar> bars;
  if (outside_bands_ + inside_bands_ > 0) bars.push_back(distance_bar());
  if (unknown_bands_ > 0)
    bars.push_back({"distance_of_unknown_side", "distance, side unknown", "", "",
                    unknown_.bands(unknown_bands_)});
  return bars;
}

}  // namespace planetree::tools
