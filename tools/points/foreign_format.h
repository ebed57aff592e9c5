#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "planetree/error.h"
#include "tools/points/row_shape.h"

namespace planetree::tools {

/// The reason why bytes are no text of rows: a known format that holds points in another way, or
/// bytes that no text has. Empty if they may be such a text.
///
/// front       of the file
/// size_bytes  of the whole file, if known
/// shape       of the wanted rows, for the message
[[nodiscard]] std::optional<Error> find_foreign_format(std::string_view front,
                                                       std::optional<std::uint64_t> size_bytes,
                                                       const RowShape& shape);

}  // namespace planetree::tools
