#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace planetree::tools {

/// Red, green and blue of sRGB.
using Colour = std::array<std::uint8_t, 3>;

/// Colours of values. Equal steps of a value are steps of equal lightness in OKLab, and values can
/// be told apart without seeing red and green as different.
class ColourScale {
 public:
  /// Deviations: blue below 0, light grey at 0, red above 0, darker the farther from 0. Values
  /// beyond -reach and reach have the colours of these.
  ///
  /// reach  finite and >= 0; if 0, every value but 0 is beyond it
  static ColourScale diverging(double reach);
  /// Sizes: from dark violet at `lower` by green to light yellow at `upper`.
  ///
  /// lower, upper  finite, lower <= upper
  static ColourScale sequential(double lower, double upper);

  double lower() const { return lower_; }
  double upper() const { return upper_; }

  /// The colour of a value; kNoValue if that is not finite.
  Colour colour(double value) const;
  /// The grey of what has no value.
  static constexpr Colour kNoValue = {128, 128, 128};

 private:
  static constexpr std::size_t kStops = 17;
  using Stops = std::array<Colour, kStops>;
  static const Stops kDiverging, kSequential;

  ColourScale(const Stops& stops, double lower, double upper)
      : stops_(&stops), lower_(lower), upper_(upper) {}

  const Stops* stops_;
  double lower_, upper_;
};

/// "#rrggbb".
[[nodiscard]] std::string css_colour(const Colour& colour);

}  // namespace planetree::tools
