#pragma once

#include <png.h>

#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tools/picture/rgb.h"

namespace planetree::tools {

/// A PNG file as libpng reads it: pixels row by row, and the texts by their keys.
struct ReadPng {
  std::uint32_t width = 0, height = 0;
  std::vector<Rgb> pixels;
  std::map<std::string, std::string> texts;

  Rgb at(std::uint32_t column, std::uint32_t row) const {
    return pixels.at(std::size_t{row} * width + column);
  }
};

/// Reads a file of 8 bits a channel without transparency. The result is empty if it is none.
inline ReadPng read_png(const std::filesystem::path& path) {
  ReadPng found;
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) return found;
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  if (setjmp(png_jmpbuf(png)) == 0) {
    png_init_io(png, file);
    png_read_info(png, info);
    if (png_get_color_type(png, info) == PNG_COLOR_TYPE_RGB && png_get_bit_depth(png, info) == 8) {
      found.width = png_get_image_width(png, info);
      found.height = png_get_image_height(png, info);
      found.pixels.resize(std::size_t{found.width} * found.height);
      for (std::uint32_t row = 0; row < found.height; ++row)
        png_read_row(png,
                     reinterpret_cast<png_bytep>(&found.pixels[std::size_t{row} * found.width]),
                     nullptr);
      png_textp texts = nullptr;
      int count = 0;
      png_get_text(png, info, &texts, &count);
      for (int i = 0; i < count; ++i) found.texts[texts[i].key] = texts[i].text;
    }
  }
  png_destroy_read_struct(&png, &info, nullptr);
  std::fclose(file);
  return found;
}

}  // namespace planetree::tools
