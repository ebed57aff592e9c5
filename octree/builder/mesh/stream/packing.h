#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_scratch.h"
#include "octree/builder/mesh/stream/triangle_sink.h"
#include "planetree/error.h"

/// Compressed mesh files.
namespace planetree::octree {

/// How a file is compressed as a whole.
enum class Packing : std::uint8_t { kNone, kGzip, kZstd };

/// Finds the packing of a file by its first bytes.
Packing packing_of(std::string_view first_bytes);

/// The length that a compressed file states for its content; 0 if it states none. It need not be
/// true: a file of several members or frames states only that of one, and of 4 GiB or more a gzip
/// file states the rest.
Result<std::uint64_t> stated_bytes(const MeshFile& packed, Packing packing);

/// Unpacks a compressed file into a temporary file without a name. A gzip file may have several
/// members and end in zeros, a zstd file may have several frames.
///
/// scratch  half of its memory, or 8 MiB, bounds the window of a zstd frame.
/// sink     is told the progress in bytes of the packed file. Its error ends the unpacking.
/// errors   kBadInput: damaged, or ends too early; offset and text name the place in the packed
///          file. kNoMemory: a zstd frame needs a larger window. Those of temporary files and of
///          MeshScratch::make_room().
Result<MeshFile> unpack(const MeshFile& packed, Packing packing, MeshScratch& scratch,
                        TriangleSink& sink);

}  // namespace planetree::octree
