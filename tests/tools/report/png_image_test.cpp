#include "tools/report/png_image.h"

#include <gtest/gtest.h>
#include <png.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace planetree::tools {
namespace {

namespace fs = std::filesystem;

class PngImageTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "planetree-XXXXXX";
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_;
};

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

TEST_F(PngImageTest, ReadsBackPixelByPixel) {
  for (const auto& [width, height] :
       {std::pair(1U, 1U), std::pair(37U, 21U), std::pair(1U, 300U)}) {
    const PngImage image = pattern(width, height);
    ASSERT_TRUE(image.write(folder_ / "image.png", true));
    png_image reader{};
    reader.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_file(&reader, (folder_ / "image.png").c_str()), 0);
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

TEST_F(PngImageTest, StartsInOneColour) {
  const PngImage image(3, 2, {10, 20, 30});
  EXPECT_EQ(image.at(2, 1).red, 10);
  EXPECT_EQ(image.at(2, 1).green, 20);
  EXPECT_EQ(image.at(0, 0).blue, 30);
}

TEST_F(PngImageTest, WritesAnIncompressibleImage) {
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
  ASSERT_TRUE(image.write(folder_ / "noise.png", false));
  // Readers may not notice a missing end, so the last chunk is checked: it is IEND.
  std::ifstream file(folder_ / "noise.png", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  EXPECT_GT(bytes.size(), 500U * 400U * 2U);
  EXPECT_TRUE(bytes.ends_with(std::string("\0\0\0\0IEND\xae\x42\x60\x82", 12)));
}

TEST_F(PngImageTest, FailsWithoutLeavingAFile) {
  const PngImage image = pattern(8, 8);
  const auto no_folder = image.write(folder_ / "absent/image.png", true);
  ASSERT_FALSE(no_folder);
  EXPECT_EQ(no_folder.error().code, ErrorCode::kNotFound);
  const auto full = image.write("/dev/full", true);
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().code, ErrorCode::kNoSpace);
  ASSERT_TRUE(image.write(folder_ / "image.png", false));
  const auto exists = image.write(folder_ / "image.png", false);
  ASSERT_FALSE(exists);
  EXPECT_EQ(exists.error().code, ErrorCode::kAlreadyExists);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace planetree::tools
