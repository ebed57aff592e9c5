#include "tools/report/png_image.h"

#include <png.h>

#include <cassert>
#include <cstddef>
#include <span>

#include "tools/cli/output_file.h"

namespace planetree::tools {

static_assert(sizeof(Rgb) == 3, "a row of Rgb is handed to libpng as bytes");

PngImage::PngImage(std::uint32_t width, std::uint32_t height, Rgb colour)
    : width_(width), height_(height), pixels_(std::size_t{width} * height, colour) {
  assert(width >= 1 && width <= kMaxSide && height >= 1 && height <= kMaxSide);
}

Rgb& PngImage::at(std::uint32_t column, std::uint32_t row) {
  assert(column < width_ && row < height_);
  return pixels_[std::size_t{row} * width_ + column];
}

Rgb PngImage::at(std::uint32_t column, std::uint32_t row) const {
  assert(column < width_ && row < height_);
  return pixels_[std::size_t{row} * width_ + column];
}

Result<void> PngImage::write(const std::filesystem::path& path, bool may_replace) const {
  auto file = OutputFile::create(path, may_replace);
  if (!file) return file.error();

  // libpng's simplified interface catches its own longjmp and returns an error flag, so that no
  // destructor here is skipped.
  png_image encoder{};
  encoder.version = PNG_IMAGE_VERSION;
  encoder.width = width_;
  encoder.height = height_;
  encoder.format = PNG_FORMAT_RGB;
  png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(encoder);
  std::vector<std::byte> encoded(bytes);
  const int done =
      png_image_write_to_memory(&encoder, encoded.data(), &bytes, 0, pixels_.data(), 0, nullptr);
  if (done == 0) {
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "cannot encode the picture: %s; make it smaller", encoder.message);
  }
  if (const auto written = file->write(std::span(encoded).first(bytes)); !written) return written;
  return file->commit();
}

}  // namespace planetree::tools
