#include "tools/slice/slice_pages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>

#include "tools/check/tree_descent.h"
#include "tools/picture/band_scale.h"
#include "tools/trace_file/trace_reader.h"

namespace planetree::tools {
namespace {

// Of two lightnesses in turn, around the circle of hues.
constexpr std::array<Rgb, 12> kPageColours = {
    Rgb{225, 135, 142}, Rgb{254, 174, 138}, Rgb{205, 154, 80},  Rgb{207, 200, 113},
    Rgb{134, 180, 109}, Rgb{121, 219, 178}, Rgb{54, 186, 186},  Rgb{108, 211, 250},
    Rgb{116, 167, 232}, Rgb{189, 188, 254}, Rgb{191, 143, 212}, Rgb{248, 167, 212}};
constexpr std::size_t kColourStep = 5;  // pages one after the other have distant hues

// From no lookup to 1 million and more.
constexpr std::array<Rgb, kLookupClasses> kLookupColours = {
    Rgb{236, 236, 236}, Rgb{244, 223, 255}, Rgb{225, 177, 254}, Rgb{198, 137, 241},
    Rgb{165, 104, 215}, Rgb{130, 78, 181},  Rgb{94, 57, 138},   Rgb{61, 41, 90}};

void fill(const PixelBox& box, std::uint32_t page, std::uint32_t height, PageMap& map) {
  const auto pixel = [](double at, std::uint32_t most) {
    return static_cast<std::uint32_t>(std::clamp(std::round(at), 0.0, most + 0.0));
  };
  const std::uint32_t right = pixel(box.right, map.width), bottom = pixel(box.bottom, height);
  for (std::uint32_t row = pixel(box.top, height); row < bottom; ++row)
    for (std::uint32_t column = pixel(box.left, map.width); column < right; ++column)
      map.pages[std::size_t{row} * map.width + column] = page;
}

// The pages that each page borders on.
std::map<std::uint32_t, std::set<std::uint32_t>> neighbours_of(const PageMap& map) {
  std::map<std::uint32_t, std::set<std::uint32_t>> found;
  const auto add = [&](std::uint32_t one, std::uint32_t other) {
    if (one == other || one == PageMap::kNone || other == PageMap::kNone) return;
    found[one].insert(other);
    found[other].insert(one);
  };
  for (std::size_t at = 0; at < map.pages.size(); ++at) {
    if ((at + 1) % map.width != 0) add(map.pages[at], map.pages[at + 1]);
    if (at + map.width < map.pages.size()) add(map.pages[at], map.pages[at + map.width]);
  }
  return found;
}

bool is_lookup(const PageAccess& access) {
  switch (access.event) {
    case PageAccess::Event::kHit:
    case PageAccess::Event::kPrefetched:
    case PageAccess::Event::kMissed:
    case PageAccess::Event::kLate:
    case PageAccess::Event::kFetched:
      return access.query_kind == PageAccess::Query::kClosestPoint ||
             access.query_kind == PageAccess::Query::kContains;
    default:
      return false;
  }
}

}  // namespace

bool PageMap::is_border(std::uint32_t column, std::uint32_t row) const {
  const std::size_t at = std::size_t{row} * width + column;
  return (column + 1 < width && pages[at] != pages[at + 1]) ||
         (at + width < pages.size() && pages[at] != pages[at + width]);
}

Result<PageMap> page_map(FileParts& parts, const SliceCut& cut, const SliceRaster& raster) {
  PageMap map;
  map.width = raster.width();
  map.pages.assign(std::size_t{raster.width()} * raster.height(), PageMap::kNone);
  const auto visit = [&](const TreePart& part) {
    const auto box = cut.of(part.box);
    if (!box || box->longer_side() < 1) return false;
    if (part.depth > 0 ? part.begins_page || part.is_block : part.is_block)
      fill(*box, part.page, raster.height(), map);
    return true;
  };
  if (const auto done = descend_tree(parts, visit, {}); !done) return done.error();
  return map;
}

std::map<std::uint32_t, MappedPage> pages_of(const PageMap& map) {
  std::map<std::uint32_t, MappedPage> pages;
  for (const std::uint32_t page : map.pages)
    if (page != PageMap::kNone) ++pages[page].pixels;
  const auto neighbours = neighbours_of(map);
  std::map<std::uint32_t, std::size_t> chosen;
  std::size_t number = 0;
  for (auto& [page, each] : pages) {
    std::uint32_t used = 0;
    if (const auto found = neighbours.find(page); found != neighbours.end())
      for (const std::uint32_t other : found->second)
        if (const auto colour = chosen.find(other); colour != chosen.end())
          used |= 1U << colour->second;
    std::size_t colour = kColourStep * number++ % kPageColours.size();
    for (std::size_t i = 0; i < kPageColours.size() && (used >> colour & 1) != 0; ++i)
      colour = (colour + 1) % kPageColours.size();
    chosen[page] = colour;
    each.colour = kPageColours[colour];
  }
  return pages;
}

Result<void> count_lookups(const std::filesystem::path& trace, const std::uint64_t (&content_id)[2],
                           std::map<std::uint32_t, MappedPage>& pages) {
  auto reader = TraceReader::open(trace.string());
  if (!reader) return reader.error();
  if (!std::ranges::equal(reader->header().content_id, content_id))
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "it is the trace of another model; give one of this model");
  std::vector<PageAccess> accesses(4096);
  for (;;) {
    const auto count = reader->read(accesses);
    if (!count) return count.error();
    if (*count == 0) break;
    for (const PageAccess& access : std::span(accesses).first(*count))
      if (is_lookup(access))
        if (const auto found = pages.find(access.page); found != pages.end())
          ++found->second.lookups;
  }
  for (auto& [page, each] : pages) each.colour = lookup_colour(lookup_class(each.lookups));
  return {};
}

unsigned lookup_class(std::uint64_t lookups) {
  unsigned found = 0;
  for (; lookups > 0 && found + 1 < kLookupClasses; lookups /= 10) ++found;
  return found;
}

Rgb lookup_colour(unsigned lookup_class) { return kLookupColours[lookup_class]; }

}  // namespace planetree::tools
