#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "planetree/error.h"

namespace planetree::tools {

/// An sRGB colour, 8 bits a channel.
struct Rgb {
  std::uint8_t red = 0, green = 0, blue = 0;
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

  /// Writes the picture as a PNG file; "-" is standard output. The file gets its name only when it
  /// is complete. On failure the destination is unchanged.
  ///
  /// errors  as OutputFile; kNoMemory
  Result<void> write(const std::filesystem::path& path, bool may_replace) const;

 private:
  std::uint32_t width_;
  std::uint32_t height_;
  std::vector<Rgb> pixels_;
};

}  // namespace planetree::tools
