#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "octree/builder/build_seams.h"
#include "octree/builder/job/build_options.h"
#include "octree/builder/job/record_fields.h"
#include "planetree/error.h"
#include "storage/file/checksum.h"

namespace planetree::octree {

/// All that a build's work depends on. What an earlier build completed can be gone on with if
/// this was the same.
struct BuildIdentity {
  std::string version;  ///< of planetree and of what it writes

  // The input. Whatever is done to a file changes its st_ctim, which nobody can put back; where
  // that is too coarse the sample may still tell.
  std::uint64_t input_bytes = 0;
  std::uint64_t input_number = 0;    ///< its inode
  std::int64_t changed_seconds = 0;  ///< when it last was
  std::int64_t changed_nanoseconds = 0;
  std::uint64_t sample_low = 0, sample_high = 0;  ///< a hash of blocks all over it

  std::uint32_t page_bytes = 0;
  bool strict = false;
  std::uint64_t chunk_triangles = 0;
  std::uint64_t sector_triangles = 0;
  std::optional<std::array<double, 6>> box;  ///< lower, then upper

  /// errors  as file_error(); kBadInput: the input is no regular file.
  static Result<BuildIdentity> of(const std::filesystem::path& input, const BuildOptions& options,
                                  const BuildSeams& seams);

  /// What is not the same in `earlier`, in words; null if all is.
  const char* change_since(const BuildIdentity& earlier) const;

  bool operator==(const BuildIdentity&) const = default;
};

template <class Record, class Value>
requires std::same_as<std::remove_const_t<Value>, BuildIdentity>
void fields(Record& record, Value& identity) {
  record(identity.version, identity.input_bytes, identity.input_number, identity.changed_seconds,
         identity.changed_nanoseconds, identity.sample_low, identity.sample_high,
         identity.page_bytes, identity.strict, identity.chunk_triangles, identity.sector_triangles,
         identity.box);
}

}  // namespace planetree::octree
