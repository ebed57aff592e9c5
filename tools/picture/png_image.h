#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "planetree/error.h"
#include "tools/picture/rgb.h"

namespace planetree::tools {

/// A tEXt chunk of a PNG file. The key has 1 to 79 Latin-1 characters; the value has no NUL.
struct PngText {
  std::string key;
  std::string value;
};

/// An opaque picture. Row 0 is the top row.
class PngImage {
 public:
  static constexpr std::uint32_t kMaxSide = 16384;

  /// Makes a picture of one colour. Each side is 1 to kMaxSide pixels.
  PngImage(std::uint32_t width, std::uint32_t height, Rgb colour = {});

  std::uint32_t width() const { return width_; }
  std::uint32_t height() const { return height_; }
  Rgb& at(std::uint32_t column, std::uint32_t row);
  Rgb at(std::uint32_t column, std::uint32_t row) const;

  /// The bytes of a PNG file with the texts before the pixels.
  ///
  /// errors  kNoMemory
  Result<std::vector<std::byte>> encode(std::span<const PngText> texts) const;

 private:
  std::uint32_t width_;
  std::uint32_t height_;
  std::vector<Rgb> pixels_;
};

}  // namespace planetree::tools
