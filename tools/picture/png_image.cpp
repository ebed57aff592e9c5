#include "tools/picture/png_image.h"

#include <png.h>

#include <cassert>
#include <csetjmp>
#include <new>

namespace planetree::tools {
namespace {

static_assert(sizeof(Rgb) == 3, "a row of Rgb is handed to libpng as bytes");

/// What libpng's calls get. Nothing in it has a destructor, because libpng leaves by longjmp.
struct Encoding {
  std::uint32_t width, height;
  const Rgb* pixels;
  png_text* texts;
  int text_count;
  std::vector<std::byte>* out;
};

void append(png_structp png, png_bytep bytes, png_size_t count) {
  auto& out = *static_cast<std::vector<std::byte>*>(png_get_io_ptr(png));
  const auto* first = reinterpret_cast<const std::byte*>(bytes);
  bool is_full = false;
  try {
    out.insert(out.end(), first, first + count);
  } catch (const std::bad_alloc&) {
    is_full = true;
  }
  if (is_full) png_error(png, "no memory");
}

void flush_nothing(png_structp) {}
void warn_nobody(png_structp, png_const_charp) {}

/// Returns false if libpng gave up, which it does for lack of memory alone.
bool run(const Encoding& encoding) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, warn_nobody);
  if (png == nullptr) return false;
  png_infop info = png_create_info_struct(png);
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_set_write_fn(png, encoding.out, append, flush_nothing);
  png_set_IHDR(png, info, encoding.width, encoding.height, 8, PNG_COLOR_TYPE_RGB,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_text(png, info, encoding.texts, encoding.text_count);
  png_write_info(png, info);
  for (std::uint32_t row = 0; row < encoding.height; ++row)
    png_write_row(png, reinterpret_cast<png_const_bytep>(encoding.pixels +
                                                         std::size_t{row} * encoding.width));
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return true;
}

}  // namespace

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

Result<std::vector<std::byte>> PngImage::encode(std::span<const PngText> texts) const {
  std::vector<png_text> chunks;
  std::vector<PngText> kept(texts.begin(), texts.end());
  for (PngText& text : kept) {
    png_text chunk{};
    chunk.compression = PNG_TEXT_COMPRESSION_NONE;
    chunk.key = text.key.data();
    chunk.text = text.value.data();
    chunk.text_length = text.value.size();
    chunks.push_back(chunk);
  }
  std::vector<std::byte> encoded;
  if (!run({width_, height_, pixels_.data(), chunks.data(), static_cast<int>(chunks.size()),
            &encoded}))
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "cannot encode the picture for lack of memory; free some");
  return encoded;
}

}  // namespace planetree::tools
