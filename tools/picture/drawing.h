#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "tools/picture/png_image.h"
#include "tools/picture/rgb.h"

/// A picture as a list of shapes. Lengths are in pixels; x goes right and y down from the upper
/// left corner of the picture.
namespace planetree::tools {

/// A place in a picture.
struct Place {
  double x = 0, y = 0;
};

/// A box of one colour. Whole numbers give sharp sides.
struct FilledBox {
  double left = 0, top = 0, width = 0, height = 0;
  Rgb colour;
};

/// Lines of one colour and width, with round ends. Where they overlap, they are as opaque as
/// elsewhere.
struct Stroke {
  std::vector<std::vector<Place>> paths;
  bool is_closed = false;  ///< whether each path returns to its first place
  Rgb colour = kInk;
  double width = 1;
  double opacity = 1;
};

enum class Anchor : std::uint8_t { kStart, kMiddle, kEnd };

/// A line of text in UTF-8.
struct TextLine {
  Place at;  ///< on the base line, at the anchor
  std::string text;
  double height = 9;  ///< of a capital letter
  Anchor anchor = Anchor::kStart;
  Rgb colour = kInk;
};

/// Pixels. The place of the upper left corner has whole numbers.
struct RasterBox {
  std::uint32_t left = 0, top = 0;
  PngImage image{1, 1};
};

using DrawnShape = std::variant<FilledBox, Stroke, TextLine, RasterBox>;

/// A picture. Later shapes cover earlier ones.
struct Drawing {
  std::uint32_t width = 1, height = 1;  ///< up to PngImage::kMaxSide
  std::string title;                    ///< names the picture, in UTF-8
  std::string description;              ///< for those who do not see it, in UTF-8
  std::string metadata;                 ///< for programs, in ASCII
  std::vector<DrawnShape> shapes;
};

}  // namespace planetree::tools
