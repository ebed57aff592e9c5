#include "tools/slice/slice_record.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace planetree::tools {
namespace {

using Json = nlohmann::ordered_json;

std::string hex(const Rgb& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue);
}

Json bar_json(const ColourBar& bar) {
  Json bands = Json::array();
  for (const ColourBand& band : bar.bands)
    bands.push_back({{"lower", band.lower}, {"upper", band.upper}, {"colour", hex(band.colour)}});
  return {{"quantity", bar.name},        {"left", bar.left},     {"top", bar.top},
          {"width", bar.width},          {"height", bar.height}, {"top_value", bar.upper()},
          {"bottom_value", bar.lower()}, {"bands", bands}};
}

Json raster_json(const SliceContents& contents, const RasterFrame& frame) {
  const Vec3 first = contents.raster.centre(0, 0);
  return {{"left", frame.left},
          {"top", frame.top},
          {"width", frame.width},
          {"height", frame.height},
          {"right_axis", std::string(1, frame.right_axis)},
          {"up_axis", std::string(1, frame.up_axis)},
          {"first_pixel", {first.x, first.y, first.z}}};
}

Json outlines_json(const LevelOutlines& outlines) {
  return {{"level", outlines.level},
          {"count", outlines.count},
          {"left_out", outlines.left_out},
          {"colour", hex(outlines.colour)}};
}

void add_overlays(const SliceContents& contents, Json& json) {
  const SliceOverlays overlays = contents.arguments.overlays;
  json["overlays"] = overlay_words(overlays);
  if ((overlays & kCellOverlay) != 0) {
    json["cells"] = Json::array();
    for (const LevelOutlines& level : contents.cells) json["cells"].push_back(outlines_json(level));
  }
  if (contents.discs) json["discs"] = outlines_json(*contents.discs);
  if (!contents.page_map) return;
  json["pages"] = Json::array();
  for (const auto& [page, each] : contents.pages) {
    Json entry = {{"page", page}, {"pixels", each.pixels}, {"colour", hex(each.colour)}};
    if ((overlays & kResidencyOverlay) != 0) entry["lookups"] = each.lookups;
    json["pages"].push_back(std::move(entry));
  }
}

}  // namespace

Json slice_json(const SliceContents& contents, const SlicePicture& picture) {
  Json json = {{"file", contents.arguments.file.filename().string()},
               {"width", picture.drawing.width},
               {"height", picture.drawing.height},
               {"axis", std::string(1, "xyz"[contents.raster.axis()])},
               {"coordinate", contents.raster.coordinate()},
               {"pixel_length", contents.raster.pixel_length()},
               {"line_distance", contents.scales.line_distance()},
               {"least_distance", contents.scales.least_distance()},
               {"greatest_distance", contents.scales.greatest_distance()},
               {"raster", raster_json(contents, picture.frame)},
               {"colour_bars", Json::array()}};
  for (const ColourBar& bar : picture.legend.bars) json["colour_bars"].push_back(bar_json(bar));
  json["no_value_colour"] = hex(kNoValue);
  add_overlays(contents, json);
  return json;
}

std::string slice_text(const SliceContents& contents, const SlicePicture& picture) {
  return fmt::format(
      "{}: {} = {:.6g}, {} by {} pixels of {:.3g}, an iso-line every {:.3g}, greatest distance "
      "{:.6g}\n",
      contents.arguments.image.string(), "xyz"[contents.raster.axis()],
      contents.raster.coordinate(), picture.frame.width, picture.frame.height,
      contents.raster.pixel_length(), contents.scales.line_distance(),
      contents.scales.greatest_distance());
}

}  // namespace planetree::tools
