#include "tools/picture/svg_writer.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <iterator>
#include <variant>
#include <vector>

#include "tools/html/html_text.h"

namespace planetree::tools {
namespace {

constexpr double kFontShare = 1 / 0.72;  // of a capital letter's height, in most fonts

std::string hex(const Rgb& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue);
}

std::string base64(const std::vector<std::byte>& bytes) {
  std::string text((bytes.size() + 2) / 3 * 4 + 1, '\0');
  const int length = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                                     reinterpret_cast<const unsigned char*>(bytes.data()),
                                     static_cast<int>(bytes.size()));
  text.resize(static_cast<std::size_t>(length));
  return text;
}

class SvgShapes {
 public:
  explicit SvgShapes(std::string& text) : text_(text) {}

  Result<void> operator()(const FilledBox& box) {
    add("<rect x='{:.6g}' y='{:.6g}' width='{:.6g}' height='{:.6g}' fill='{}'/>\n", box.left,
        box.top, box.width, box.height, hex(box.colour));
    return {};
  }

  Result<void> operator()(const Stroke& stroke) {
    add("<path fill='none' stroke='{}' stroke-width='{:.6g}' stroke-opacity='{:.6g}' "
        "stroke-linecap='round' stroke-linejoin='round' d='",
        hex(stroke.colour), stroke.width, stroke.opacity);
    for (const auto& path : stroke.paths) {
      char command = 'M';
      for (const Place& place : path) {
        add("{}{:.6g} {:.6g}", command, place.x, place.y);
        command = 'L';
      }
      if (stroke.is_closed) text_ += 'Z';
    }
    text_ += "'/>\n";
    return {};
  }

  Result<void> operator()(const TextLine& line) {
    constexpr const char* kAnchors[] = {"start", "middle", "end"};
    add("<text x='{:.6g}' y='{:.6g}' font-size='{:.4g}' text-anchor='{}' fill='{}'>{}</text>\n",
        line.at.x, line.at.y, line.height * kFontShare, kAnchors[static_cast<int>(line.anchor)],
        hex(line.colour), html_text(line.text));
    return {};
  }

  Result<void> operator()(const RasterBox& raster) {
    const auto png = raster.image.encode({});
    if (!png) return png.error();
    add("<image x='{}' y='{}' width='{}' height='{}' style='image-rendering:pixelated' "
        "href='data:image/png;base64,{}'/>\n",
        raster.left, raster.top, raster.image.width(), raster.image.height(), base64(*png));
    return {};
  }

 private:
  template <class... Values>
  void add(fmt::format_string<const Values&...> form, const Values&... values) {
    fmt::format_to(std::back_inserter(text_), form, values...);
  }

  std::string& text_;
};

}  // namespace

Result<std::string> svg_text(const Drawing& drawing) {
  std::string text = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' width='{0}' height='{1}' viewBox='0 0 {0} {1}' "
      "role='img' aria-labelledby='title desc' font-family='sans-serif'>\n"
      "<title id='title'>{2}</title>\n<desc id='desc'>{3}</desc>\n<metadata>{4}</metadata>\n"
      "<rect width='100%' height='100%' fill='{5}'/>\n",
      drawing.width, drawing.height, html_text(drawing.title), html_text(drawing.description),
      html_text(drawing.metadata), hex(kPaper));
  SvgShapes shapes(text);
  for (const DrawnShape& shape : drawing.shapes) {
    const Result<void> added =
        std::visit([&shapes](const auto& each) { return shapes(each); }, shape);
    if (!added) return added.error();
  }
  text += "</svg>\n";
  return text;
}

}  // namespace planetree::tools
