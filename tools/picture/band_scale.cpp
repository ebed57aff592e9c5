#include "tools/picture/band_scale.h"

#include <algorithm>
#include <cstddef>

namespace planetree::tools {

Rgb ramp_colour(const ColourRamp& ramp, double share) {
  const double position = std::clamp(share, 0.0, 1.0) * static_cast<double>(ramp.size() - 1);
  const auto index = std::min(static_cast<std::size_t>(position), ramp.size() - 2);
  return mix(ramp[index], ramp[index + 1], position - static_cast<double>(index));
}

double round_length(double length) {
  double power = 1;
  while (power * 10 <= length) power *= 10;
  while (power > length && power > 0) power /= 10;
  return length >= 5 * power ? 5 * power : length >= 2 * power ? 2 * power : power;
}

std::uint32_t BandScale::band_of(double value) const {
  const double band = value / length_;
  return band < count_ ? static_cast<std::uint32_t>(band) : count_ - 1;
}

Rgb BandScale::colour(std::uint32_t band) const {
  return ramp_colour(*ramp_, count_ > 1 ? static_cast<double>(band) / (count_ - 1) : 0);
}

std::vector<ColourBand> BandScale::bands(std::uint32_t shown) const {
  std::vector<ColourBand> bands;
  for (std::uint32_t i = 0; i < shown; ++i)
    bands.push_back({i * length_, (i + 1) * length_, colour(i)});
  return bands;
}

}  // namespace planetree::tools
