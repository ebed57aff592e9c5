#include "octree/builder/mesh/ply_scalar.h"

#include <utility>

#include "octree/builder/mesh/stream/mesh_text.h"

namespace planetree::octree {

std::optional<PlyType> ply_type_named(std::string_view name) noexcept {
  static constexpr std::pair<std::string_view, PlyType> kNames[] = {
      {"char", PlyType::kInt8},      {"int8", PlyType::kInt8},
      {"uchar", PlyType::kUint8},    {"uint8", PlyType::kUint8},
      {"short", PlyType::kInt16},    {"int16", PlyType::kInt16},
      {"ushort", PlyType::kUint16},  {"uint16", PlyType::kUint16},
      {"int", PlyType::kInt32},      {"int32", PlyType::kInt32},
      {"uint", PlyType::kUint32},    {"uint32", PlyType::kUint32},
      {"long", PlyType::kInt64},     {"int64", PlyType::kInt64},
      {"ulong", PlyType::kUint64},   {"uint64", PlyType::kUint64},
      {"longlong", PlyType::kInt64}, {"ulonglong", PlyType::kUint64},
      {"float", PlyType::kFloat32},  {"float32", PlyType::kFloat32},
      {"double", PlyType::kFloat64}, {"float64", PlyType::kFloat64}};
  if (name.ends_with("_t")) name.remove_suffix(2);
  for (const auto& [known, type] : kNames)
    if (is_same_word(name, known)) return type;
  return std::nullopt;
}

}  // namespace planetree::octree
