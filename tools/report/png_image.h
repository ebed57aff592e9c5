#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "planetree/error.h"

namespace planetree::tools {

struct Rgb {
  std::uint8_t red = 0, green = 0, blue = 0;
};

/// An opaque colour picture, 8 bits (sRGB) a channel, row 0 on top.
class PngImage {
 public:
  static constexpr std::uint32_t kMaxSide = 16384;

  /// A picture of one colour; each side from 1 to kMaxSide pixels.
  PngImage(std::uint32_t width, std::uint32_t height, Rgb colour = {});

  std::uint32_t width() const { return width_; }
  std::uint32_t height() const { return height_; }
  Rgb& at(std::uint32_t column, std::uint32_t row);
  Rgb at(std::uint32_t column, std::uint32_t row) const;

  /// Writes the picture as a PNG file; "-" is standard output. The file bears its
  /// name only once it is whole; on failure the destination is as it was.
  ///
  /// errors  as OutputFile's; kNoMemory
  Result<void> write(const std::filesystem::path& path, bool may_replace) const;

 private:
  std::uint32_t width_;
  std::uint32_t height_;
  std::vector<Rgb> pixels_;
};

}  // namespace planetree::tools
