#include "tools/report/inspect_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/cli/size_text.h"
#include "tools/html/html_text.h"

namespace planetree::tools {
namespace {

/// "1.00 M" as "1 M".
std::string tick_count_text(double count) {
  const std::string text = short_count(count);
  const std::size_t end = std::min(text.find(' '), text.size());
  std::string digits = text.substr(0, end);
  while (digits.find('.') != std::string::npos && (digits.back() == '0' || digits.back() == '.'))
    digits.pop_back();
  return digits + text.substr(end);
}

/// A binary unit in which bytes up to `most` are short numbers.
struct ByteUnit {
  double bytes = 1;
  std::string name = "bytes";
};
ByteUnit unit_of(double most) {
  constexpr const char* kNames[] = {"bytes", "KiB", "MiB", "GiB", "TiB"};
  ByteUnit unit;
  for (std::size_t i = 1; i < std::size(kNames) && most >= 1024 * unit.bytes; ++i)
    unit = {1024 * unit.bytes, kNames[i]};
  return unit;
}

std::size_t shown(std::size_t levels) { return std::min(levels, kMaxLevelsShown); }

/// An axis with a place for each level, and a tick at each or at every other.
PlotAxis level_axis(const std::string& title, std::size_t levels) {
  constexpr std::size_t kMaxNamed = 12;
  if (levels > kMaxNamed)
    return PlotAxis::between(title, -0.5, static_cast<double>(levels) - 0.5, short_text);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < levels; ++i) names.push_back(std::to_string(i));
  return PlotAxis::named(title, names);
}

void add_series(SvgPlot& plot, std::size_t series, std::size_t level, std::uint64_t count,
                const std::string& key) {
  PlotPoint point;
  point.x = static_cast<double>(level);
  point.y = static_cast<double>(count);
  point.series = series;
  point.key = key;
  plot.points.push_back(std::move(point));
}

void set_count_axis(SvgPlot& plot, const char* title) {
  std::vector<double> values;
  for (const PlotPoint& point : plot.points) values.push_back(point.y);
  plot.y =
      PlotAxis::logarithmic(title, values, 1, [](double count) { return tick_count_text(count); });
  plot.has_lines = true;
}

}  // namespace

std::string depth_key(std::size_t depth) { return fmt::format("depth-{}", depth); }
std::string mask_level_key(std::size_t level) { return fmt::format("mask-{}", level); }
std::string size_key_of(std::size_t bin) { return fmt::format("size-{}", bin); }
std::string page_window_key(std::size_t window) { return fmt::format("pages-{}", window); }
std::string part_key(const std::string& id, std::size_t part) {
  return fmt::format("{}-{}", id, part);
}

BarPlot bytes_plot(const std::string& id, const std::string& title, const std::string& description,
                   const std::vector<BytePart>& parts) {
  std::uint64_t most = 0;
  for (const BytePart& part : parts) most = std::max(most, part.bytes);
  const ByteUnit unit = unit_of(static_cast<double>(most));
  BarPlot plot{id,
               title,
               description,
               PlotAxis::linear(unit.name, static_cast<double>(most) / unit.bytes, short_text),
               {}};
  for (std::size_t i = 0; i < parts.size(); ++i)
    plot.bars.push_back({parts[i].name, static_cast<double>(parts[i].bytes) / unit.bytes,
                         short_bytes(parts[i].bytes), part_key(id, i)});
  return plot;
}

SvgPlot depth_plot(const FileSurvey& survey) {
  SvgPlot plot;
  plot.id = "depths";
  plot.title = "Nodes, blocks and triangles by depth";
  plot.description =
      "Number of nodes, of blocks and of their triangles at each depth of the tree. The root has "
      "depth 0. The table below has the figures.";
  plot.series = {{"nodes", PlotShape::kCircle},
                 {"blocks", PlotShape::kSquare},
                 {"triangles", PlotShape::kTriangle}};
  const std::size_t levels = shown(survey.levels.size());
  plot.x = level_axis("depth", levels);
  for (std::size_t depth = 0; depth < levels; ++depth) {
    const LevelRow& row = survey.levels[depth];
    add_series(plot, 0, depth, row.nodes, depth_key(depth));
    add_series(plot, 1, depth, row.blocks, depth_key(depth));
    add_series(plot, 2, depth, row.triangles, depth_key(depth));
  }
  set_count_axis(plot, "number");
  return plot;
}

ColumnPlot depth_bytes_plot(const FileSurvey& survey) {
  const std::size_t levels = shown(survey.levels.size());
  std::uint64_t most = 0;
  for (std::size_t depth = 0; depth < levels; ++depth)
    most = std::max(most, survey.levels[depth].page_bytes);
  const ByteUnit unit = unit_of(static_cast<double>(most));
  ColumnPlot plot{
      "depth-bytes",
      "Stored bytes by depth",
      "Stored bytes of the distance pages, by the depth of the highest node or block in "
      "each. The table below has the figures.",
      level_axis("depth of the highest node or block of a page", levels),
      PlotAxis::linear(unit.name, static_cast<double>(most) / unit.bytes, short_text),
      {{"bytes", PlotShape::kSquare}},
      {},
      {},
      {},
      {}};
  for (std::size_t depth = 0; depth < levels; ++depth)
    plot.columns.push_back({static_cast<double>(depth) - 0.4,
                            static_cast<double>(depth) + 0.4,
                            static_cast<double>(survey.levels[depth].page_bytes) / unit.bytes,
                            {},
                            0,
                            depth_key(depth)});
  return plot;
}

SvgPlot mask_plot(const FileSurvey& survey) {
  SvgPlot plot;
  plot.id = "mask-levels";
  plot.title = "Cells of the mask by level";
  plot.description =
      "Number of white, black and grey cells at each level of the mask, and of the leaves among "
      "the grey ones. The table below has the figures.";
  plot.series = {{"white", PlotShape::kCircle},
                 {"black", PlotShape::kSquare},
                 {"grey", PlotShape::kDiamond},
                 {"with corners", PlotShape::kTriangle},
                 {"special", PlotShape::kPlus}};
  const std::size_t levels = shown(survey.mask.size());
  plot.x = level_axis("level", levels);
  for (std::size_t level = 0; level < levels; ++level) {
    const MaskLevelRow& row = survey.mask[level];
    std::size_t series = 0;
    for (const std::uint64_t count : {row.white, row.black, row.grey, row.corners, row.special})
      add_series(plot, series++, level, count, mask_level_key(level));
  }
  set_count_axis(plot, "cells");
  return plot;
}

ColumnPlot page_sizes_plot(const InspectRecord& record) {
  const double page_kib = record.summary["page_bytes"].get<double>() / 1024;
  const double bin_kib = page_kib / PageTally::kSizes;
  const PageTally::Sizes& sizes = record.pages.sizes();
  std::vector<double> counts;
  for (const auto& kinds : sizes)
    counts.push_back(std::accumulate(kinds.begin(), kinds.end(), 0.0));
  ColumnPlot plot{"page-sizes",
                  "Pages by stored size",
                  "Number of pages in each range of stored size, up to the size that a page has in "
                  "memory. The table below has the figures.",
                  PlotAxis::between("stored size in KiB", 0, page_kib, short_text),
                  PlotAxis::linear("pages", *std::ranges::max_element(counts), tick_count_text),
                  {{"pages", PlotShape::kSquare}},
                  {},
                  {},
                  {},
                  {}};
  for (std::size_t i = 0; i < counts.size(); ++i)
    plot.columns.push_back({bin_kib * static_cast<double>(i),
                            bin_kib * static_cast<double>(i + 1),
                            counts[i],
                            {},
                            0,
                            size_key_of(i)});
  return plot;
}

ColumnPlot compression_plot(const InspectRecord& record) {
  const std::string begins = "where another kind of pages begins";
  const auto& windows = record.pages.windows();
  double most = 0;
  for (const PageTally::Window& window : windows)
    most = std::max(most, static_cast<double>(window.stored_bytes) /
                              static_cast<double>(std::max<std::uint64_t>(window.raw_bytes, 1)));
  const auto end = static_cast<double>(windows.back().last) + 1;
  ColumnPlot plot{"compression",
                  "Compression along the file",
                  "Stored bytes over bytes before compression, of neighbouring pages in the order "
                  "of the file. The table below has the figures.",
                  PlotAxis::between("number of the page", 0, end, tick_count_text),
                  PlotAxis::linear("stored share", most,
                                   [](double share) { return short_text(100 * share) + " %"; }),
                  {{"readable", PlotShape::kSquare}},
                  {},
                  {},
                  {},
                  {}};
  if (record.pages.unreadable() > 0)
    plot.series.push_back({"with unreadable pages", PlotShape::kDownTriangle});
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const PageTally::Window& window = windows[i];
    plot.columns.push_back({static_cast<double>(window.first),
                            static_cast<double>(window.last) + 1,
                            static_cast<double>(window.stored_bytes) /
                                static_cast<double>(std::max<std::uint64_t>(window.raw_bytes, 1)),
                            {},
                            window.unreadable > 0 ? std::size_t{1} : 0,
                            page_window_key(i)});
    if (i > 0)
      for (std::size_t kind = 1; kind < kPageKindCount; ++kind)
        if (window.pages[kind] > 0 && windows[i - 1].pages[kind] == 0)
          plot.marks.push_back({static_cast<double>(window.first), begins});
  }
  return plot;
}

}  // namespace planetree::tools
