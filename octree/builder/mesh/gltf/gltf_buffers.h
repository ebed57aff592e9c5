#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string_view>

#include "octree/builder/mesh/gltf/gltf_document.h"
#include "octree/builder/mesh/gltf/gltf_file.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_scratch.h"
#include "planetree/error.h"

namespace planetree::octree {

/// The bytes of the buffers of a glTF: in the file itself, in files beside it, or embedded in
/// base64, which is decoded into a temporary file. A buffer is opened when it is first needed.
class GltfBuffers {
 public:
  /// A buffer, or a part of one. Its GltfBuffers must outlive it.
  struct Bytes {
    const MeshFile* file = nullptr;
    FileRange range;
  };

  /// file  the glTF; it, `document` and `scratch` must outlive this.
  /// path  of the glTF.
  GltfBuffers(const MeshFile& file, const std::filesystem::path& path, const GltfParts& parts,
              const GltfDocument& document, MeshScratch& scratch)
      : file_(file), path_(path), parts_(parts), document_(document), scratch_(scratch) {}

  /// The bytes of a buffer, as many as it declares.
  /// errors  kBadInput: there is no such buffer, or it has fewer bytes; those of opening its file.
  Result<Bytes> open(std::uint64_t buffer);

 private:
  struct Source {
    std::unique_ptr<MeshFile> file;  ///< null: that of the glTF
    FileRange range;
  };

  Result<Source> find(std::uint64_t buffer) const;
  Result<Source> find_binary(std::uint64_t buffer) const;

  const MeshFile& file_;
  const std::filesystem::path path_;
  const GltfParts parts_;
  const GltfDocument& document_;
  MeshScratch& scratch_;
  std::map<std::uint64_t, Source> sources_;
};

/// The file that the URI of a buffer names.
///
/// gltf    path of the glTF, to which it is relative; empty if that is the content of a compressed
///         file.
/// errors  kBadInput: the URI names no file beside the glTF.
Result<std::filesystem::path> gltf_buffer_path(const std::filesystem::path& gltf,
                                               std::string_view uri);

}  // namespace planetree::octree
