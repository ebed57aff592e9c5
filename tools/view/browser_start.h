#pragma once

#include <string>

namespace planetree::tools {

/// Opens a page in the user's browser by xdg-open, if there is a desktop. Does not wait for it.
/// That it could not be opened is no error.
void start_browser(const std::string& page);

}  // namespace planetree::tools
