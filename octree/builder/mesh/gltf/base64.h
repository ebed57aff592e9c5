#pragma once

#include "octree/builder/mesh/gltf/gltf_file.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_scratch.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Decodes a part of a file from base64 into a temporary file. A backslash in front of a slash, as
/// some writers of JSON put it, is passed over.
///
/// errors  kBadInput: a byte is none of base64, or the last group of four is not whole. Those of
///         reading the file, of temporary files and of MeshScratch::make_room().
Result<MeshFile> decode_base64(const MeshFile& file, const FileRange& range, MeshScratch& scratch);

}  // namespace planetree::octree
