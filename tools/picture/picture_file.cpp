#include "tools/picture/picture_file.h"

#include <fmt/format.h>

#include <span>

#include "octree/builder/mesh/stream/mesh_text.h"
#include "tools/cli/input_file.h"
#include "tools/cli/output_file.h"
#include "tools/picture/raster_painter.h"
#include "tools/picture/svg_writer.h"

namespace planetree::tools {
namespace {

Result<std::vector<std::byte>> png_bytes(const Drawing& drawing) {
  const PngText texts[] = {{"Software", "planetree"}, {kMetadataKey, drawing.metadata}};
  return paint(drawing).encode(texts);
}

Result<void> write_bytes(OutputFile& file, std::span<const std::byte> bytes) {
  if (const auto written = file.write(bytes); !written) return written;
  return file.commit();
}

}  // namespace

std::string picture_complaint(const std::string& path) {
  const std::string extension = lower_extension(path);
  if (path == "-" || extension == ".png" || extension == ".svg") return {};
  return fmt::format("'{}' is neither a .png nor a .svg; give a name that ends with one of these",
                     octree::printable(path));
}

Result<void> write_picture(const Drawing& drawing, const std::filesystem::path& path,
                           bool may_replace) {
  auto file = OutputFile::create(path, may_replace);
  if (!file) return file.error();
  if (lower_extension(path) == ".svg") {
    const auto text = svg_text(drawing);
    if (!text) return text.error();
    return write_bytes(*file, std::as_bytes(std::span(*text)));
  }
  const auto bytes = png_bytes(drawing);
  if (!bytes) return bytes.error();
  return write_bytes(*file, *bytes);
}

}  // namespace planetree::tools
