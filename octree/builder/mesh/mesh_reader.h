#pragma once

#include <filesystem>

#include "octree/builder/mesh/stream/mesh_scratch.h"
#include "octree/builder/mesh/stream/triangle_sink.h"
#include "planetree/error.h"

/// Reading triangle meshes: PLY (ascii and both binary endians), STL (binary
/// and ascii), OBJ and OFF (ascii and binary), streamed one triangle at a time.
///
/// A triangle's index is its place in the input: polygons of n corners are
/// split into the fan (0, i, i + 1), i = 1 ... n - 2, and take n - 2 indices in
/// that order. A record that cannot be used is set aside whole and still takes
/// max(1, n - 2) indices, so that every index means the same whatever is wrong
/// elsewhere. Structural damage ends the reading with kBadInput.
namespace planetree::octree {

/// Reads the mesh at `path` into `sink`. The format is judged by content: a
/// PLY by its first line, a binary STL by its size being exactly what its count
/// says (even if it begins with "solid"), an ascii STL by "solid", an OFF by its
/// keyword; only then, for an OBJ and for an OFF without a keyword, by the extension.
///
/// path     a regular file. Its size is taken once, when it is opened; one that becomes shorter
///          during the call is an error, one that changes otherwise gives what it gives.
/// scratch  memory and room for temporary files; must not be used otherwise during the call.
///          What a mesh takes of both depends neither on the order of its faces nor, of memory,
///          on its size: vertices stay in the file, or are put away where the file is a text,
///          and are read again where faces name them. Faces that jump about take room on disk
///          for their corners, while it is read (FaceVertexJoin). Only a text's longest face is in
///          memory whole.
/// errors   kNotFound, kPermission, kReadFailed, kNoMemory, kBadInput (structural damage, an
///          unsupported layout, a line of more than 32 MiB, or no usable triangle; offset is
///          set where a byte is to blame), those of temporary files, or the sink's own. By then
///          the sink may have taken part of the mesh.
/// threads  one call per sink; calls on different sinks are independent.
Result<MeshSummary> read_mesh(const std::filesystem::path& path, TriangleSink& sink,
                              MeshScratch& scratch);

/// The same with MeshScratch::kMemoryBytes and the system's directory for temporary files.
Result<MeshSummary> read_mesh(const std::filesystem::path& path, TriangleSink& sink);

}  // namespace planetree::octree
