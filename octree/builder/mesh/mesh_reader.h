#pragma once

#include <cstdint>
#include <string>

#include "octree/builder/mesh/stream/mesh_scratch.h"
#include "octree/builder/mesh/stream/triangle_sink.h"
#include "planetree/build.h"
#include "planetree/error.h"

/// Readers of triangle meshes: files in PLY (ascii and both binary byte orders), STL (binary and
/// ascii), OBJ, OFF (ascii and binary) and glTF 2.0 (JSON and binary), meshes in memory, and
/// callbacks. They stream one triangle at a time.
///
/// A triangle's index is its position in the input. A polygon of n corners is split into n - 2
/// triangles (PolygonTriangulator): its fan (0, i, i + 1) if that covers it without overlap. A
/// record that cannot be used is skipped as a whole and still takes max(1, n - 2) indices, so that
/// an index does not depend on what is wrong elsewhere. Structural damage ends the reading with
/// kBadInput.
namespace planetree::octree {

/// How a mesh is read.
struct MeshOptions {
  /// Coordinates that an ascii PLY declares as floats are read as doubles, with all their digits.
  bool float64 = false;
  /// Attributes to deliver: kKeepColor, kKeepUv and kKeepValue, combined with `|`. A mesh that does
  /// not have one of them is an error. Other bits have no effect.
  std::uint32_t keep = 0;
  /// Name of the property of a PLY's faces that kKeepValue reads.
  std::string value_property = "value";
};

/// Reads a mesh into `sink`. The content of a file decides the format: the first line of a PLY;
/// the size of a binary STL, which is exactly what its count implies (even if it begins with
/// "solid"); "solid" of an ascii STL; the keyword of an OFF; "glTF" of a GLB, and the names of a
/// glTF's lists in JSON. Otherwise the extension decides: for
/// an OBJ, for an OFF without a keyword, and for an STL with a wrong size. A file that is
/// compressed by gzip or zstd is unpacked into a temporary file first (packing.h). The content is
/// then read under the path without .gz or .zst. Places in messages are those of the content.
/// Several files are read one after the other, as one mesh (mesh_sequence.h).
///
/// input    a file is a regular file. Its size is taken once, when it is opened. A file that
/// becomes shorter
///          during the call is an error; any other change gives unspecified triangles.
/// scratch  memory and a directory for temporary files; must not be used otherwise during the call.
///          Memory is bounded whatever the size of the mesh and the order of its faces. Vertices
///          stay in the file, or are spilled where the file is a text, and are read again where
///          faces refer to them. Where the faces refer to vertices in no order, their corners are
///          sorted on disk (FaceVertexJoin). Only the longest face of a text is in memory as a
///          whole. After an error, MeshScratch::file() is the file that it concerns.
/// errors   kNotFound, kPermission, kReadFailed, kNoMemory, kBadInput (structural damage, an
///          unsupported layout, a line of more than 32 MiB, or no usable triangle; offset is set
///          where a byte is at fault), kBadArgument (an empty list of files), those of temporary
///          files, and those of the sink. The sink may have received a part of the mesh by then.
/// threads  one call per sink; calls on different sinks are independent.
Result<MeshSummary> read_mesh(const BuildInput& input, TriangleSink& sink, MeshScratch& scratch,
                              const MeshOptions& options = {});

/// As above, with MeshScratch::kMemoryBytes and the system's directory for temporary files.
Result<MeshSummary> read_mesh(const BuildInput& input, TriangleSink& sink);

}  // namespace planetree::octree
