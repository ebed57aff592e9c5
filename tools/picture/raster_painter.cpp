#include "tools/picture/raster_painter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <variant>
#include <vector>

#include "tools/picture/stroke_font.h"

namespace planetree::tools {
namespace {

/// Columns and rows of pixels, without the last.
struct PixelSpan {
  std::uint32_t left = 0, top = 0, right = 0, bottom = 0;
};

double distance_to_line(const Place& at, const Place& from, const Place& to) {
  const double x = to.x - from.x, y = to.y - from.y;
  const double squared = x * x + y * y;
  const double share =
      squared > 0 ? std::clamp(((at.x - from.x) * x + (at.y - from.y) * y) / squared, 0.0, 1.0) : 0;
  const double dx = from.x + share * x - at.x, dy = from.y + share * y - at.y;
  return std::sqrt(dx * dx + dy * dy);
}

class PixelPainter {
 public:
  PixelPainter(std::uint32_t width, std::uint32_t height)
      : image_(width, height, kPaper), coverage_(std::size_t{width} * height) {}

  void operator()(const FilledBox& box) {
    const PixelSpan span =
        pixels({box.left, box.top}, {box.left + box.width, box.top + box.height});
    for (std::uint32_t row = span.top; row < span.bottom; ++row)
      for (std::uint32_t column = span.left; column < span.right; ++column) {
        const double share =
            overlap(column, box.left, box.width) * overlap(row, box.top, box.height);
        image_.at(column, row) = mix(image_.at(column, row), box.colour, share);
      }
  }

  void operator()(const RasterBox& raster) {
    for (std::uint32_t row = 0; row < raster.image.height(); ++row)
      for (std::uint32_t column = 0; column < raster.image.width(); ++column)
        if (raster.left + column < image_.width() && raster.top + row < image_.height())
          image_.at(raster.left + column, raster.top + row) = raster.image.at(column, row);
  }

  void operator()(const TextLine& line) { (*this)(text_stroke(line)); }

  void operator()(const Stroke& stroke) {
    touched_.clear();
    for (const auto& path : stroke.paths) {
      for (std::size_t i = 0; i + 1 < path.size(); ++i) cover(path[i], path[i + 1], stroke.width);
      if (stroke.is_closed && path.size() > 1) cover(path.back(), path.front(), stroke.width);
      if (path.size() == 1) cover(path[0], path[0], stroke.width);
    }
    for (const std::size_t pixel : touched_) {
      Rgb& colour = image_.at(static_cast<std::uint32_t>(pixel % image_.width()),
                              static_cast<std::uint32_t>(pixel / image_.width()));
      colour = mix(colour, stroke.colour, static_cast<double>(coverage_[pixel]) * stroke.opacity);
      coverage_[pixel] = 0;
    }
  }

  PngImage take() { return std::move(image_); }

 private:
  static double overlap(std::uint32_t pixel, double from, double length) {
    return std::clamp(std::min(pixel + 1.0, from + length) - std::max<double>(pixel, from), 0.0,
                      1.0);
  }

  PixelSpan pixels(const Place& from, const Place& to) const {
    const auto first = [](double at, std::uint32_t end) {
      return static_cast<std::uint32_t>(std::clamp(std::floor(at), 0.0, static_cast<double>(end)));
    };
    const auto last = [](double at, std::uint32_t end) {
      return static_cast<std::uint32_t>(std::clamp(std::ceil(at), 0.0, static_cast<double>(end)));
    };
    return {first(from.x, image_.width()), first(from.y, image_.height()),
            last(to.x, image_.width()), last(to.y, image_.height())};
  }

  // Notes which share of each pixel a line covers.
  void cover(const Place& from, const Place& to, double width) {
    const double reach = width / 2 + 1;
    const PixelSpan span = pixels({std::min(from.x, to.x) - reach, std::min(from.y, to.y) - reach},
                                  {std::max(from.x, to.x) + reach, std::max(from.y, to.y) + reach});
    for (std::uint32_t row = span.top; row < span.bottom; ++row)
      for (std::uint32_t column = span.left; column < span.right; ++column) {
        const double away = distance_to_line({column + 0.5, row + 0.5}, from, to);
        const double share = std::clamp(width / 2 + 0.5 - away, 0.0, std::min(1.0, width));
        if (share <= 0) continue;
        const std::size_t pixel = std::size_t{row} * image_.width() + column;
        if (coverage_[pixel] == 0) touched_.push_back(pixel);
        coverage_[pixel] = std::max(coverage_[pixel], static_cast<float>(share));
      }
  }

  PngImage image_;
  std::vector<float> coverage_;       // of the stroke that is painted; 0 between strokes
  std::vector<std::size_t> touched_;  // pixels that it covers
};

}  // namespace

PngImage paint(const Drawing& drawing) {
  PixelPainter painter(drawing.width, drawing.height);
  for (const DrawnShape& shape : drawing.shapes)
    std::visit([&painter](const auto& each) { painter(each); }, shape);
  return painter.take();
}

}  // namespace planetree::tools
