#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tools/slice/slice_picture.h"

namespace planetree::tools {

/// How to read a picture, for programs: docs/inspection.md describes it. The file has it as
/// metadata.
[[nodiscard]] nlohmann::ordered_json slice_json(const SliceContents& contents,
                                                const SlicePicture& picture);

/// One line about a picture, for people.
[[nodiscard]] std::string slice_text(const SliceContents& contents, const SlicePicture& picture);

}  // namespace planetree::tools
