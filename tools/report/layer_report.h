#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "planetree/layers.h"
#include "tools/check/file_parts.h"

/// What the layers of a file take, and what leaving them out saves.
namespace planetree::tools {

/// Stored bytes of each part of a file.
struct Sections {
  std::uint64_t headers = 0;
  std::uint64_t directory = 0;
  std::uint64_t distance_pages = 0;
  std::uint64_t cap_pages = 0;
  std::uint64_t field_pages = 0;
  std::uint64_t attribute_pages = 0;
  std::uint64_t mask_pages = 0;
  std::uint64_t extensions = 0;  ///< with their records

  std::uint64_t side_pages() const { return cap_pages + mask_pages; }
};
[[nodiscard]] Sections sections_of(const FileParts& parts);

/// The least memory budget with one probe and these layers. Empty if the file cannot be opened.
[[nodiscard]] std::optional<std::uint64_t> min_budget_bytes(const FileParts& parts,
                                                            std::uint32_t layers = kAllLayers);

/// Pages and stored bytes of each layer, without headers and directory. Also what leaving the
/// layer out at open saves: of the minimum budget with one probe, and of the frames that hold all
/// pages. A layer that the file does not have is null in JSON. The savings of a file that cannot be
/// opened are null.
[[nodiscard]] nlohmann::ordered_json layers_json(const FileParts& parts);
[[nodiscard]] std::string layers_line(const FileParts& parts);

}  // namespace planetree::tools
