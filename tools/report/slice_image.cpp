#include "tools/report/slice_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "octree/builder/mesh/stream/mesh_text.h"

namespace planetree::tools {
namespace {

constexpr double kLongSidePixels = 800;
constexpr double kMarginShare = 0.08;   // margin on each side, as a share of the longer side
constexpr double kErrorPixels = 0.05;   // tolerance of distances, too small to be visible
constexpr double kSurfacePixels = 0.7;  // half the width of the surface's stroke
constexpr double kBands = 14;           // approximately; rounding gives 7 to 18

struct Colour {
  double red = 0, green = 0, blue = 0;
};

constexpr Colour kInk = {18, 20, 32};
// From near to far: warm and light to cold and dark.
constexpr std::array<Colour, 6> kPalette = {Colour{255, 246, 214}, Colour{253, 206, 122},
                                            Colour{236, 131, 98},  Colour{168, 72, 121},
                                            Colour{88, 44, 117},   Colour{32, 24, 74}};

Colour mix(const Colour& a, const Colour& b, double share) {
  return {a.red + (b.red - a.red) * share, a.green + (b.green - a.green) * share,
          a.blue + (b.blue - a.blue) * share};
}

Colour palette(double share) {
  const double position = std::clamp(share, 0.0, 1.0) * (kPalette.size() - 1);
  const auto index = std::min(static_cast<std::size_t>(position), kPalette.size() - 2);
  return mix(kPalette[index], kPalette[index + 1], position - static_cast<double>(index));
}

Rgb rounded(const Colour& colour) {
  const auto byte = [](double value) { return static_cast<std::uint8_t>(value + 0.5); };
  return {byte(colour.red), byte(colour.green), byte(colour.blue)};
}

/// The greatest length of the form 1, 2 or 5 times a power of ten that is at most `length`.
double round_length(double length) {
  double power = 1;
  while (power * 10 <= length) power *= 10;
  while (power > length && power > 0) power /= 10;
  return length >= 5 * power ? 5 * power : length >= 2 * power ? 2 * power : power;
}

double component(const Vec3& vector, unsigned axis) {
  return axis == 0 ? vector.x : axis == 1 ? vector.y : vector.z;
}

/// Positions of the pixels.
class Raster {
 public:
  Raster(const ModelInfo& info, const SlicePlane& plane)
      : axis_(plane.axis),
        right_(plane.axis == 0 ? 1 : 0),
        up_(plane.axis == 2 ? 1 : 2),
        coordinate_(plane.coordinate(info)) {
    const auto length = [&info](unsigned axis) {
      return component(info.core_upper, axis) - component(info.core_lower, axis);
    };
    double longer = std::max(length(right_), length(up_));
    if (!(longer > 0)) longer = length(axis_) > 0 ? length(axis_) : 1;
    pixel_ = longer * (1 + 2 * kMarginShare) / kLongSidePixels;
    const auto pixels = [&](unsigned axis) {
      const double count = std::ceil((length(axis) + 2 * kMarginShare * longer) / pixel_ - 0.001);
      return static_cast<std::uint32_t>(std::clamp(count, 1.0, kLongSidePixels));
    };
    if (!usable()) return;
    width_ = pixels(right_);
    height_ = pixels(up_);
    const auto middle = [&info](unsigned axis) {
      return component(info.core_lower, axis) / 2 + component(info.core_upper, axis) / 2;
    };
    left_ = middle(right_) - pixel_ * width_ / 2;
    top_ = middle(up_) + pixel_ * height_ / 2;
  }

  /// Whether pixel size and coordinate are normal, finite doubles.
  bool usable() const { return std::isnormal(pixel_) && std::isfinite(coordinate_); }
  std::uint32_t width() const { return width_; }
  std::uint32_t height() const { return height_; }
  double pixel() const { return pixel_; }
  double coordinate() const { return coordinate_; }

  Vec3 centre(std::uint32_t column, std::uint32_t row) const {
    std::array<double, 3> at{};
    at[axis_] = coordinate_;
    at[right_] = left_ + pixel_ * (column + 0.5);
    at[up_] = top_ - pixel_ * (row + 0.5);
    return {at[0], at[1], at[2]};
  }

 private:
  unsigned axis_, right_, up_;
  double coordinate_;
  double pixel_ = 0;
  std::uint32_t width_ = 1, height_ = 1;
  double left_ = 0, top_ = 0;
};

std::vector<double> distances(const Raster& raster, Probe& probe, const SliceProgress& progress) {
  QueryOptions options;
  options.parts = kDistance;
  options.max_error = raster.pixel() * kErrorPixels;
  const std::size_t total = std::size_t{raster.width()} * raster.height();
  std::vector<double> found;
  found.reserve(total);
  // Rows are queried in batches large enough for a good order.
  constexpr std::uint32_t kRows = 64;
  if (progress) progress(0, total);
  std::vector<Vec3> points;
  std::vector<ClosestPoint> answers;
  for (std::uint32_t first = 0; first < raster.height(); first += kRows) {
    points.clear();
    for (std::uint32_t row = first; row < std::min(first + kRows, raster.height()); ++row)
      for (std::uint32_t column = 0; column < raster.width(); ++column)
        points.push_back(raster.centre(column, row));
    answers.resize(points.size());
    probe.closest_points(points, answers, options);
    for (const ClosestPoint& answer : answers) found.push_back(answer.distance);
    if (progress) progress(found.size(), total);
  }
  return found;
}

/// The share of a pixel that a stroke covers. `half` is half of the stroke's width, `away` the
/// distance of its middle from the pixel's centre; both in pixels.
double coverage(double away, double half) { return std::clamp(half + 0.5 - away, 0.0, 1.0); }

Colour shade(double distance, const SliceImage& slice) {
  const double band = std::floor(distance / slice.line_distance);
  const double bands = std::max(1.0, std::floor(slice.greatest / slice.line_distance));
  Colour colour = palette(band / bands);
  // Every fifth line is stronger. The line at 0 is the surface, which is drawn below.
  const double line = std::round(distance / slice.line_distance);
  if (line > 0) {
    const bool strong = std::fmod(line, 5) == 0;
    const double away = std::fabs(distance - line * slice.line_distance) / slice.pixel_length;
    colour = mix(colour, kInk, coverage(away, strong ? 0.4 : 0.1) * (strong ? 0.55 : 0.3));
  }
  return mix(colour, kInk, coverage(distance / slice.pixel_length, kSurfacePixels));
}

}  // namespace

std::optional<SlicePlane> SlicePlane::parse(std::string_view text) {
  if (text.size() < 3 || text[1] != '=') return std::nullopt;
  const char letter = static_cast<char>(text[0] | 0x20);
  if (letter < 'x' || letter > 'z') return std::nullopt;
  SlicePlane plane;
  plane.axis = static_cast<unsigned>(letter - 'x');
  text.remove_prefix(2);
  plane.percent = text.ends_with('%');
  if (plane.percent) text.remove_suffix(1);
  if (!octree::parse_real(text, plane.value) || !std::isfinite(plane.value)) return std::nullopt;
  return plane;
}

double SlicePlane::coordinate(const ModelInfo& info) const {
  if (!percent) return value;
  const double share = value / 100;
  return component(info.core_lower, axis) * (1 - share) + component(info.core_upper, axis) * share;
}

Result<SliceImage> draw_slice(const Model& model, Probe& probe, const SlicePlane& plane,
                              const SliceProgress& progress) {
  const Raster raster(model.info(), plane);
  if (!raster.usable())
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "the model's box is too large or too small to draw; choose another plane or "
                      "scale the model");
  const std::vector<double> found = distances(raster, probe, progress);
  SliceImage slice;
  slice.image = PngImage(raster.width(), raster.height());
  slice.coordinate = raster.coordinate();
  slice.pixel_length = raster.pixel();
  const auto [least, greatest] = std::minmax_element(found.begin(), found.end());
  slice.least = *least;
  slice.greatest = *greatest;
  slice.line_distance = round_length(std::max(slice.greatest, slice.pixel_length) / kBands * 2);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto column = static_cast<std::uint32_t>(i % raster.width());
    const auto row = static_cast<std::uint32_t>(i / raster.width());
    slice.image.at(column, row) = rounded(shade(found[i], slice));
  }
  return slice;
}

}  // namespace planetree::tools
