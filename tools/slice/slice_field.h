#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "planetree/probe.h"
#include "tools/slice/slice_arguments.h"
#include "tools/slice/slice_raster.h"

namespace planetree::tools {

using SliceProgress = std::function<void(std::uint64_t done, std::uint64_t total)>;

/// The answer at the middle of a pixel.
struct PixelAnswer {
  double distance = 0;  ///< as ClosestPoint has it; may be infinite
  double width = 0;     ///< of the certified interval
  Side side = Side::kUnknown;
};

/// Answers for all pixels, row by row from the upper left one. Distances err by at most 1/20 of a
/// pixel; with kWidthOverlay they are exact, or what SliceArguments::max_work finds.
///
/// progress  called with the numbers of finished and of all pixels; may be empty
std::vector<PixelAnswer> slice_field(const SliceRaster& raster, Probe& probe,
                                     const SliceArguments& arguments,
                                     const SliceProgress& progress);

}  // namespace planetree::tools
