#pragma once

#include <filesystem>
#include <string>

#include "planetree/error.h"
#include "tools/picture/drawing.h"

namespace planetree::tools {

/// Key of a PNG file's tEXt chunk with the metadata.
inline constexpr const char* kMetadataKey = "planetree";

/// A complaint if the extension of a file's name is of no picture, else nothing. "-" is standard
/// output, and a PNG.
[[nodiscard]] std::string picture_complaint(const std::string& path);

/// Writes a drawing as a PNG or, if the file's extension is .svg, as an SVG. "-" is standard
/// output. The file gets its name only when it is complete. On failure the destination is
/// unchanged.
///
/// errors  as OutputFile; kNoMemory
Result<void> write_picture(const Drawing& drawing, const std::filesystem::path& path,
                           bool may_replace);

}  // namespace planetree::tools
