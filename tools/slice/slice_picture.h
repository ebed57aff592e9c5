#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "tools/picture/drawing.h"
#include "tools/picture/legend.h"
#include "tools/picture/picture_axes.h"
#include "tools/slice/slice_outlines.h"
#include "tools/slice/slice_pages.h"
#include "tools/slice/slice_scales.h"

namespace planetree::tools {

/// What a picture of a slice shows.
struct SliceContents {
  SliceArguments arguments;
  SliceRaster raster;
  std::vector<PixelAnswer> answers;
  SliceScales scales;
  std::optional<PageMap> page_map;  ///< with kPageOverlay or kResidencyOverlay
  std::map<std::uint32_t, MappedPage> pages;
  std::vector<LevelOutlines> cells;
  std::optional<LevelOutlines> discs;
};

/// A picture of a slice, and how to read it.
struct SlicePicture {
  Drawing drawing;
  RasterFrame frame;
  Legend legend;
};

/// Draws the raster with its lines and overlays, axes, legend and title. The metadata of the
/// drawing is slice_json().
SlicePicture draw_slice(const SliceContents& contents);

}  // namespace planetree::tools
