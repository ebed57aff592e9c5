#include "tools/points/row_shape.h"

namespace planetree::tools {

std::string RowShape::joined_names() const {
  std::string text;
  for (const std::string_view name : all_names().first(required))
    text.append(text.empty() ? "" : ",").append(name);
  return text;
}

std::string RowShape::listed_names(const char* word) const {
  std::string text;
  for (std::size_t i = 0; i < required; ++i) {
    if (i > 0) text += i + 1 < required ? ", " : std::string(" ") + word + ' ';
    text += names[i];
  }
  return text;
}

}  // namespace planetree::tools
