#include "octree/builder/mesh/ply_type.h"

#include <utility>

#include "octree/builder/mesh/stream/mesh_text.h"

namespace planetree::octree {

std::optional<ScalarType> ply_type_named(std::string_view name) noexcept {
  static constexpr std::pair<std::string_view, ScalarType> kNames[] = {
      {"char", ScalarType::kInt8},      {"int8", ScalarType::kInt8},
      {"uchar", ScalarType::kUint8},    {"uint8", ScalarType::kUint8},
      {"short", ScalarType::kInt16},    {"int16", ScalarType::kInt16},
      {"ushort", ScalarType::kUint16},  {"uint16", ScalarType::kUint16},
      {"int", ScalarType::kInt32},      {"int32", ScalarType::kInt32},
      {"uint", ScalarType::kUint32},    {"uint32", ScalarType::kUint32},
      {"long", ScalarType::kInt64},     {"int64", ScalarType::kInt64},
      {"ulong", ScalarType::kUint64},   {"uint64", ScalarType::kUint64},
      {"longlong", ScalarType::kInt64}, {"ulonglong", ScalarType::kUint64},
      {"float", ScalarType::kFloat32},  {"float32", ScalarType::kFloat32},
      {"double", ScalarType::kFloat64}, {"float64", ScalarType::kFloat64}};
  if (name.ends_with("_t")) name.remove_suffix(2);
  for (const auto& [known, type] : kNames)
    if (is_same_word(name, known)) return type;
  return std::nullopt;
}

}  // namespace planetree::octree
