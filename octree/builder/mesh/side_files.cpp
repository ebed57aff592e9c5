#include "octree/builder/mesh/side_files.h"

#include "octree/builder/mesh/gltf/gltf_reader.h"
#include "octree/builder/mesh/mesh_format.h"
#include "octree/builder/mesh/stream/mesh_file.h"

namespace planetree::octree {

namespace {

using Paths = std::vector<std::filesystem::path>;

Result<Paths> none_unless_failed(const Error& error) {
  if (error.code == ErrorCode::kBadInput) return Paths();
  return error;
}

}  // namespace

Result<Paths> side_files_of(const std::filesystem::path& mesh, storage::FileCalls& calls) {
  const Result<MeshFile> file = MeshFile::open(mesh, calls);
  if (!file) return none_unless_failed(file.error());
  const Result<Packing> packing = detect_packing(*file);
  if (!packing) return packing.error();
  if (*packing != Packing::kNone) return Paths();
  const Result<MeshFormat> format = detect_format(*file, mesh);
  if (!format) return none_unless_failed(format.error());
  if (*format != MeshFormat::kGltf) return Paths();
  Result<Paths> files = files_of_gltf(*file, mesh);
  return files ? files : none_unless_failed(files.error());
}

}  // namespace planetree::octree
