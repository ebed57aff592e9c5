#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

#include "octree/builder/mesh/ply_header.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Parses a header of any length at the front of a file. `parse` gets longer and longer prefixes
/// until one certainly includes everything in front of the body.
///
/// parse   (text) -> Result<PlyHeader>.
/// errors  those of reading the file; that of `parse` for the whole file or its first 16 MiB.
template <class Parse>
Result<PlyHeader> parse_prefix(const MeshFile& file, const Parse& parse) {
  constexpr std::uint64_t kFirstBytes = std::uint64_t{1} << 16;
  constexpr std::uint64_t kMaxBytes = std::uint64_t{16} << 20;
  for (std::uint64_t bytes = kFirstBytes;; bytes *= 4) {
    const Result<std::string> prefix = file.prefix(bytes);
    if (!prefix) return prefix.error();
    Result<PlyHeader> header = parse(std::string_view(*prefix));
    // A header that ends at the end of the prefix may be cut off.
    const bool is_whole = prefix->size() == file.size_bytes();
    if (is_whole || bytes >= kMaxBytes || (header && header->body.offset < prefix->size()))
      return header;
  }
}

}  // namespace planetree::octree
