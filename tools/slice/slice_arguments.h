#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "planetree/types.h"
#include "tools/cli/subcommand_options.h"
#include "tools/slice/slice_plane.h"

namespace planetree::tools {

/// What a slice shows beside or in place of the distance; combined with `|`.
using SliceOverlays = std::uint32_t;
inline constexpr SliceOverlays kCellOverlay = 1;   ///< boxes of the tree that the plane cuts
inline constexpr SliceOverlays kDiscOverlay = 2;   ///< discs of one level of the tree
inline constexpr SliceOverlays kPageOverlay = 4;   ///< the page of each place
inline constexpr SliceOverlays kWidthOverlay = 8;  ///< widths of intervals in place of distances
inline constexpr SliceOverlays kResidencyOverlay = 16;  ///< lookups of each page in a trace

/// The words of overlays, as --overlay takes them.
[[nodiscard]] std::vector<std::string> overlay_words(SliceOverlays overlays);

/// Arguments of `planetree inspect --slice`.
struct SliceArguments {
  std::filesystem::path file, image;
  std::optional<SlicePlane> plane;
  SliceOverlays overlays = 0;
  std::uint64_t level = 0;      ///< of the discs
  std::filesystem::path trace;  ///< for kResidencyOverlay
  std::uint64_t max_work = QueryOptions::kNoLimit;
  SideRule side_rule = SideRule::kOfFile;
  bool replace_image = false;
  bool json = false;
  bool quiet = false;
};

/// The options of slices on a command line.
struct SliceOptions {
  SubcommandOptions::Option slice, image, overlay, level, trace, max_work;

  /// A complaint if options do not go together, or nothing. Once the command line is parsed.
  [[nodiscard]] std::string complaint(const SliceArguments& arguments) const;
};

/// Declares --slice, --image, and what goes with them.
SliceOptions add_slice_options(SubcommandOptions& subcommand, SliceArguments& arguments);

}  // namespace planetree::tools
