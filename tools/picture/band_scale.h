#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tools/picture/rgb.h"

/// Colours of values in bands of equal length, by which a reader of a picture finds the value of a
/// colour.
namespace planetree::tools {

/// Colours from light to dark.
using ColourRamp = std::array<Rgb, 7>;

// Of equal steps in OKLab, lightness from 0.95 to 0.33. Blue and orange can be told apart without
// seeing red and green as different.
inline constexpr ColourRamp kBlues = {Rgb{222, 242, 255}, Rgb{154, 213, 254}, Rgb{82, 180, 253},
                                      Rgb{16, 144, 237},  Rgb{12, 110, 199},  Rgb{26, 79, 151},
                                      Rgb{28, 51, 97}};
inline constexpr ColourRamp kOranges = {Rgb{255, 236, 205}, Rgb{255, 195, 114}, Rgb{243, 154, 37},
                                        Rgb{215, 120, 3},   Rgb{182, 91, 7},    Rgb{149, 63, 3},
                                        Rgb{103, 48, 28}};
inline constexpr ColourRamp kGreys = {Rgb{232, 232, 232}, Rgb{200, 200, 200}, Rgb{170, 170, 170},
                                      Rgb{140, 140, 140}, Rgb{111, 111, 111}, Rgb{84, 84, 84},
                                      Rgb{58, 58, 58}};
inline constexpr ColourRamp kGreens = {Rgb{231, 247, 186}, Rgb{179, 221, 130}, Rgb{118, 195, 91},
                                       Rgb{42, 167, 74},   Rgb{11, 131, 79},   Rgb{6, 96, 69},
                                       Rgb{2, 63, 52}};

/// The colour at a share of a ramp; 0 is light, 1 is dark.
[[nodiscard]] Rgb ramp_colour(const ColourRamp& ramp, double share);

/// The greatest length of the form 1, 2 or 5 times a power of ten that is at most `length`, which
/// is positive and normal.
[[nodiscard]] double round_length(double length);

/// A band of values and its colour.
struct ColourBand {
  double lower = 0, upper = 0;
  Rgb colour;
};

/// Bands of one ramp from 0 on, each of the same length.
class BandScale {
 public:
  /// length  of a band; positive
  /// count   of bands that share the ramp, at least 1
  BandScale(const ColourRamp& ramp, double length, std::uint32_t count)
      : ramp_(&ramp), length_(length), count_(count) {}

  double length() const { return length_; }
  std::uint32_t count() const { return count_; }
  /// Number of a value's band. Values beyond the last band are in that.
  ///
  /// value  >= 0
  std::uint32_t band_of(double value) const;
  /// Colour of a band.
  Rgb colour(std::uint32_t band) const;
  /// The first `shown` bands.
  std::vector<ColourBand> bands(std::uint32_t shown) const;

 private:
  const ColourRamp* ramp_;
  double length_;
  std::uint32_t count_;
};

}  // namespace planetree::tools
