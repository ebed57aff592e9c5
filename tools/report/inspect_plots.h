#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/html/bar_plot.h"
#include "tools/html/column_plot.h"
#include "tools/html/svg_plot.h"
#include "tools/report/inspect_record.h"

/// The plots of a page about a file. What they draw carries the keys below.
namespace planetree::tools {

/// Depths and levels that are shown. Only damaged files have more.
inline constexpr std::size_t kMaxLevelsShown = 64;

std::string depth_key(std::size_t depth);
std::string mask_level_key(std::size_t level);
std::string size_key_of(std::size_t bin);
std::string page_window_key(std::size_t window);
std::string part_key(const std::string& id, std::size_t part);

/// A named part of something, such as the bytes of a section.
struct BytePart {
  std::string name;
  std::uint64_t bytes = 0;
};
/// Bars of bytes. Bars carry part_key() of `id` and their place.
BarPlot bytes_plot(const std::string& id, const std::string& title, const std::string& description,
                   const std::vector<BytePart>& parts);

/// Nodes, blocks and triangles by depth of the tree.
SvgPlot depth_plot(const FileSurvey& survey);
/// Stored bytes of the distance pages that begin at each depth.
ColumnPlot depth_bytes_plot(const FileSurvey& survey);
/// Cells by level of the mask.
SvgPlot mask_plot(const FileSurvey& survey);
/// Pages by stored size.
ColumnPlot page_sizes_plot(const InspectRecord& record);
/// Stored bytes over bytes before compression, along the file.
ColumnPlot compression_plot(const InspectRecord& record);

}  // namespace planetree::tools
