#pragma once

#include <string>

#include "tools/thickness/thickness_record.h"
#include "tools/values/colour_scale.h"

namespace planetree::tools {

/// The colours of thicknesses: from 0 to the 95th percentile.
[[nodiscard]] ColourScale thickness_colours(const ThicknessRecord& record);

/// The record as an HTML file.
///
/// command  that makes the page again, as typed in a shell
[[nodiscard]] std::string thickness_page(const ThicknessRecord& record, const std::string& command);

}  // namespace planetree::tools
