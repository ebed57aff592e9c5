#include "tools/picture/png_image.h"

#include <gtest/gtest.h>
#include <png.h>

#include <string>
#include <utility>
#include <vector>

namespace planetree::tools {
namespace {

/// An image in which no two neighbouring pixels, rows or channels are alike.
PngImage pattern(std::uint32_t width, std::uint32_t height) {
  PngImage image(width, height);
  for (std::uint32_t row = 0; row < height; ++row) {
    for (std::uint32_t column = 0; column < width; ++column) {
      image.at(column, row) = {static_cast<std::uint8_t>(column * 7 + row),
                               static_cast<std::uint8_t>(row * 13),
                               static_cast<std::uint8_t>(column * row + 5)};
    }
  }
  return image;
}

TEST(PngImage, ReadsBackPixelByPixel) {
  for (const auto& [width, height] :
       {std::pair(1U, 1U), std::pair(37U, 21U), std::pair(1U, 300U)}) {
    const PngImage image = pattern(width, height);
    const auto file = image.encode({});
    ASSERT_TRUE(file);
    png_image reader{};
    reader.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_memory(&reader, file->data(), file->size()), 0);
    EXPECT_EQ(reader.width, width);
    EXPECT_EQ(reader.height, height);
    EXPECT_EQ(reader.format, png_uint_32{PNG_FORMAT_RGB});
    std::vector<std::uint8_t> pixels(std::size_t{3} * width * height);
    ASSERT_NE(png_image_finish_read(&reader, nullptr, pixels.data(), 0, nullptr), 0);
    for (std::uint32_t row = 0; row < height; ++row) {
      for (std::uint32_t column = 0; column < width; ++column) {
        const std::uint8_t* read = &pixels[3 * (std::size_t{row} * width + column)];
        const Rgb expected = image.at(column, row);
        ASSERT_TRUE(read[0] == expected.red && read[1] == expected.green &&
                    read[2] == expected.blue)
            << column << ' ' << row;
      }
    }
  }
}

TEST(PngImage, StartsInOneColour) {
  const PngImage image(3, 2, {10, 20, 30});
  EXPECT_EQ(image.at(2, 1).red, 10);
  EXPECT_EQ(image.at(2, 1).green, 20);
  EXPECT_EQ(image.at(0, 0).blue, 30);
}

TEST(PngImage, WritesAnIncompressibleImage) {
  PngImage image(500, 400);
  std::uint32_t state = 1;
  for (std::uint32_t row = 0; row < 400; ++row) {
    for (std::uint32_t column = 0; column < 500; ++column) {
      state = state * 1664525U + 1013904223U;
      image.at(column, row) = {static_cast<std::uint8_t>(state >> 24),
                               static_cast<std::uint8_t>(state >> 16),
                               static_cast<std::uint8_t>(state >> 11)};
    }
  }
  const auto file = image.encode({});
  ASSERT_TRUE(file);
  // Readers may not notice a missing end, so the last chunk is checked: it is IEND.
  const std::string bytes(reinterpret_cast<const char*>(file->data()), file->size());
  EXPECT_GT(bytes.size(), 500U * 400U * 2U);
  EXPECT_TRUE(bytes.ends_with(std::string("\0\0\0\0IEND\xae\x42\x60\x82", 12)));
}

}  // namespace
}  // namespace planetree::tools
