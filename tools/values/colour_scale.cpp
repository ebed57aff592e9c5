#include "tools/values/colour_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace planetree::tools {

// Of 17 equal steps in OKLab. Lightness from 0.45 by 0.95 to 0.45, hue 258 degrees below the middle
// and 30 above it, chroma 0.165 at the ends and 0 in the middle.
const ColourScale::Stops ColourScale::kDiverging = {{{2, 80, 174},
                                                     {43, 101, 184},
                                                     {72, 121, 193},
                                                     {99, 141, 202},
                                                     {126, 160, 210},
                                                     {154, 180, 218},
                                                     {182, 199, 225},
                                                     {210, 219, 232},
                                                     {238, 238, 238},
                                                     {231, 213, 210},
                                                     {223, 188, 182},
                                                     {214, 164, 155},
                                                     {205, 139, 128},
                                                     {194, 114, 102},
                                                     {182, 89, 75},
                                                     {170, 62, 48},
                                                     {156, 28, 16}}};
// Lightness from 0.28 to 0.94, hue from 300 to 105 degrees, chroma 0.14 or what sRGB has.
const ColourScale::Stops ColourScale::kSequential = {{{54, 7, 97},
                                                      {52, 29, 116},
                                                      {45, 48, 133},
                                                      {30, 66, 147},
                                                      {0, 85, 153},
                                                      {0, 102, 150},
                                                      {0, 118, 152},
                                                      {2, 133, 155},
                                                      {0, 149, 158},
                                                      {3, 165, 159},
                                                      {3, 181, 156},
                                                      {49, 196, 148},
                                                      {100, 208, 140},
                                                      {141, 218, 131},
                                                      {179, 226, 124},
                                                      {215, 234, 121},
                                                      {249, 240, 123}}};

ColourScale ColourScale::diverging(double reach) { return {kDiverging, -reach, reach}; }
ColourScale ColourScale::sequential(double lower, double upper) {
  return {kSequential, lower, upper};
}

Colour ColourScale::colour(double value) const {
  if (!std::isfinite(value)) return kNoValue;
  constexpr double kSteps = kStops - 1;
  const double middle = lower_ / 2 + upper_ / 2, half = upper_ / 2 - lower_ / 2;
  double place = kSteps / 2;
  if (value != middle) {
    const double from_middle = half > 0 ? (value - middle) / half : value > middle ? 1 : -1;
    place = kSteps / 2 * (1 + std::clamp(from_middle, -1.0, 1.0));
  }
  const auto stop = std::min(static_cast<std::size_t>(place), kStops - 2);
  const double part = place - static_cast<double>(stop);
  Colour made{};
  for (std::size_t i = 0; i < made.size(); ++i) {
    const double from = (*stops_)[stop][i], to = (*stops_)[stop + 1][i];
    made[i] = static_cast<std::uint8_t>(from + (to - from) * part + 0.5);
  }
  return made;
}

std::string css_colour(const Colour& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour[0], colour[1], colour[2]);
}

}  // namespace planetree::tools
