#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "tests/golden/spec_reader.h"

namespace planetree::golden {

/// Decodes the raw bytes of page `number`, a distance page or a cap page ("Distance page",
/// "Bounds").
SpecPage decode_spec_page(std::span<const std::byte> raw, std::uint32_t number,
                          const SpecHeader& header);

}  // namespace planetree::golden
