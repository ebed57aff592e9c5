#include "tools/mesh/input_kind.h"

#include <system_error>

#include "octree/builder/mesh/header_prefix.h"
#include "octree/builder/mesh/mesh_format.h"
#include "octree/builder/mesh/ply_header.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "tools/points/row_reader.h"

namespace planetree::tools {

Result<InputKind> input_kind(const std::filesystem::path& path) {
  std::error_code none;
  // A pipe or a device is read once, from front to back. Only points can be.
  if (path == "-" || std::filesystem::is_other(path, none)) return InputKind::kPoints;
  const auto file = octree::MeshFile::open(path);
  if (!file) return file.error();
  if (is_raw_rows(path)) return InputKind::kPoints;
  const auto packing = octree::detect_packing(*file);
  if (!packing) return packing.error();
  if (*packing != octree::Packing::kNone) return InputKind::kMesh;
  const auto format = octree::detect_format(*file, path);
  // The reader of points knows more formats that are not read than that of meshes.
  if (!format && format.error().code == ErrorCode::kBadInput) return InputKind::kPoints;
  if (!format) return format.error();
  if (*format == octree::MeshFormat::kUnknown) return InputKind::kPoints;
  if (*format != octree::MeshFormat::kPly) return InputKind::kMesh;
  // A header without faces is no mesh's. What else may be wrong with it, the reader of points says.
  const auto header = octree::parse_prefix(*file, octree::parse_ply_header);
  return header && header->faces().count > 0 ? InputKind::kMesh : InputKind::kPoints;
}

}  // namespace planetree::tools
