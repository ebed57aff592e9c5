#include "tools/slice/slice_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "tools/picture/stroke_font.h"
#include "tools/slice/slice_pixels.h"
#include "tools/slice/slice_record.h"

namespace planetree::tools {
namespace {

constexpr std::uint32_t kTitleRoom = 56;
constexpr std::uint32_t kLegendGap = 28;
constexpr std::uint32_t kMinBarHeight = 260;
constexpr std::size_t kMaxListed = 8;  // pages in the legend

std::string title_of(const SliceContents& contents) {
  return fmt::format("{}, {} = {}", contents.arguments.file.filename().string(),
                     "xyz"[contents.raster.axis()], value_text(contents.raster.coordinate()));
}

std::string description_of(const SliceContents& contents) {
  const bool shows_width = (contents.arguments.overlays & kWidthOverlay) != 0;
  const auto overlays = overlay_words(contents.arguments.overlays);
  return fmt::format(
      "{} over a plane through the model. The dark line is the surface.{} The greatest distance is "
      "{} model units.{}",
      shows_width ? "Width of the certified interval of the distance"
                  : "Signed distance to the surface, blue outside and orange inside,",
      shows_width ? ""
                  : fmt::format(" Iso-lines are {} model units apart.",
                                value_text(contents.scales.line_distance())),
      value_text(contents.scales.greatest_distance()),
      overlays.empty() ? "" : fmt::format(" Overlays: {}.", fmt::join(overlays, ", ")));
}

LegendGroup line_entries(const SliceContents& contents) {
  LegendGroup group{"lines", {{kInk, true, "surface"}}};
  if ((contents.arguments.overlays & kWidthOverlay) == 0)
    group.entries.push_back(
        {mix(kPaper, kInk, 0.45), true,
         fmt::format("iso-line every {}", value_text(contents.scales.line_distance()))});
  return group;
}

LegendGroup page_entries(const SliceContents& contents) {
  LegendGroup group{fmt::format("pages ({} on the plane)", contents.pages.size()), {}};
  // The largest first.
  std::vector<std::pair<std::uint32_t, MappedPage>> pages(contents.pages.begin(),
                                                          contents.pages.end());
  std::ranges::stable_sort(
      pages, [](const auto& a, const auto& b) { return a.second.pixels > b.second.pixels; });
  for (const auto& [page, each] : std::span(pages).first(std::min(pages.size(), kMaxListed)))
    group.entries.push_back({each.colour, false, fmt::format("page {}", page)});
  if (pages.size() > kMaxListed)
    group.entries.push_back({kPaper, false, fmt::format("and {} more", pages.size() - kMaxListed)});
  return group;
}

LegendGroup lookup_entries(const SliceContents& contents) {
  LegendGroup group{"lookups of the page", {}};
  unsigned most = 0;
  for (const auto& [page, each] : contents.pages) most = std::max(most, lookup_class(each.lookups));
  std::uint64_t first = 1;
  group.entries.push_back({lookup_colour(0), false, "none"});
  for (unsigned i = 1; i <= most; ++i, first *= 10)
    group.entries.push_back({lookup_colour(i), false,
                             i + 1 < kLookupClasses ? fmt::format("{} to {}", first, first * 10 - 1)
                                                    : fmt::format("{} and more", first)});
  return group;
}

Legend legend_of(const SliceContents& contents) {
  const SliceOverlays overlays = contents.arguments.overlays;
  Legend legend;
  legend.bars = contents.scales.bars();
  legend.groups.push_back(line_entries(contents));
  if ((overlays & kPageOverlay) != 0) legend.groups.push_back(page_entries(contents));
  if ((overlays & kResidencyOverlay) != 0) legend.groups.push_back(lookup_entries(contents));
  if ((overlays & kCellOverlay) != 0) {
    LegendGroup group{"boxes of the tree, by level", {}};
    for (const LevelOutlines& level : contents.cells)
      group.entries.push_back(
          {level.colour, true, fmt::format("{}: {} on the plane", level.level, level.count)});
    if (contents.cells.empty()) group.entries.push_back({kPaper, false, "none on the plane"});
    legend.groups.push_back(std::move(group));
  }
  if (contents.discs) {
    LegendGroup group{fmt::format("discs of level {}", contents.discs->level), {}};
    group.entries.push_back(
        {contents.discs->colour, true, fmt::format("{} on the plane", contents.discs->count)});
    if (contents.discs->left_out > 0)
      group.entries.push_back(
          {kPaper, false, fmt::format("{} too small", contents.discs->left_out)});
    legend.groups.push_back(std::move(group));
  }
  return legend;
}

void add_stroke(Stroke stroke, const RasterFrame& frame, Drawing& drawing) {
  for (auto& path : stroke.paths)
    for (Place& place : path) place = {place.x + frame.left, place.y + frame.top};
  drawing.shapes.emplace_back(std::move(stroke));
}

void draw_shapes(const SliceContents& contents, SlicePicture& picture) {
  Drawing& drawing = picture.drawing;
  drawing.shapes.emplace_back(
      RasterBox{picture.frame.left, picture.frame.top, slice_pixels(contents)});
  // The deepest first, so that a side that boxes share has the colour of the uppermost.
  for (auto level = contents.cells.rbegin(); level != contents.cells.rend(); ++level)
    add_stroke(level->stroke, picture.frame, drawing);
  if (contents.discs) add_stroke(contents.discs->stroke, picture.frame, drawing);
  draw_axes(picture.frame, drawing);
  picture.legend.draw(drawing);
  constexpr double kTitleHeight = 12;
  const double left = picture.frame.left;
  drawing.shapes.emplace_back(TextLine{
      {left, 34}, shortened(drawing.title, kTitleHeight, drawing.width - left - 12), kTitleHeight});
}

}  // namespace

SlicePicture draw_slice(const SliceContents& contents) {
  const SliceRaster& raster = contents.raster;
  SlicePicture picture;
  picture.frame = {0,
                   kTitleRoom,
                   raster.width(),
                   raster.height(),
                   "xyz"[raster.right()],
                   "xyz"[raster.up()],
                   raster.left(),
                   raster.top(),
                   raster.pixel_length()};
  picture.frame.left = left_room(picture.frame);
  const RasterFrame& frame = picture.frame;
  picture.legend = legend_of(contents);
  const std::uint32_t left = frame.left + std::max(frame.width, 160U) + kLegendGap;
  picture.legend.place(left, frame.top - 4, std::max(kMinBarHeight, frame.height / 2));
  Drawing& drawing = picture.drawing;
  drawing.width = left + Legend::kWidth;
  drawing.height = std::max(frame.top + frame.height + kLowerRoom, picture.legend.bottom());
  drawing.title = title_of(contents);
  drawing.description = description_of(contents);
  drawing.metadata = slice_json(contents, picture)
                         .dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace);
  draw_shapes(contents, picture);
  return picture;
}

}  // namespace planetree::tools
