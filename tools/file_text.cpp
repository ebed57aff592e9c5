#include "tools/file_text.h"

#include <fmt/format.h>

namespace planetree::tools {

std::string content_id_text(std::span<const std::uint64_t, 2> id) {
  return fmt::format("{:016x}{:016x}", id[1], id[0]);
}

}  // namespace planetree::tools
