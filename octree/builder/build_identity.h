#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "octree/builder/build_seams.h"
#include "octree/builder/job/build_options.h"
#include "octree/builder/job/record_fields.h"
#include "planetree/build.h"
#include "planetree/error.h"
#include "storage/file/checksum.h"

namespace planetree::octree {

/// Versions of planetree, of the format and of the records of unfinished work.
std::string work_version();

/// What tells an input, or one of its files, from another. A mesh in memory is hashed as a whole.
/// Any change to a file updates its st_ctim, which programs cannot set. Where st_ctim is too
/// coarse, the sample may still differ.
struct InputIdentity {
  std::uint64_t bytes = 0;
  std::uint64_t number = 0;          ///< inode number; in memory, bytes of a vertex
  std::int64_t changed_seconds = 0;  ///< st_ctim
  std::int64_t changed_nanoseconds = 0;
  std::uint64_t sample_low = 0, sample_high = 0;  ///< hash of blocks all over the file

  bool operator==(const InputIdentity&) const = default;
};

/// Everything that the work of a build depends on. A build can resume the work of an earlier one
/// with an equal identity.
struct BuildIdentity {
  std::string version;                ///< versions of planetree, of the format and of the records
  std::vector<InputIdentity> inputs;  ///< of each file; one if the input is in memory

  std::uint32_t page_bytes = 0;
  bool with_sides = true;
  std::uint32_t attributes = 0;
  std::string value_property;
  bool strict = false;
  bool float64 = false;
  std::uint64_t chunk_triangles = 0;
  std::uint64_t sector_triangles = 0;
  std::optional<std::array<double, 6>> box;  ///< lower, then upper

  /// errors  as file_error(); kBadInput: the input is not a regular file. kBadArgument: it is a
  ///         callback, whose triangles cannot be compared with earlier ones, or an empty list of
  ///         files. If the input is several files, `failed_at` is set to the one that the error
  ///         concerns, unless it is null.
  static Result<BuildIdentity> of(const BuildInput& input, const BuildOptions& options,
                                  const BuildSeams& seams,
                                  std::filesystem::path* failed_at = nullptr);

  /// Length of all files of the input.
  std::uint64_t input_bytes() const;
  /// Says in words what differs from `earlier`; empty if nothing does.
  std::string change_since(const BuildIdentity& earlier) const;

  bool operator==(const BuildIdentity&) const = default;
};

template <class Record, class Value>
requires std::same_as<std::remove_const_t<Value>, InputIdentity>
void fields(Record& record, Value& input) {
  record(input.bytes, input.number, input.changed_seconds, input.changed_nanoseconds,
         input.sample_low, input.sample_high);
}

template <class Record, class Value>
requires std::same_as<std::remove_const_t<Value>, BuildIdentity>
void fields(Record& record, Value& identity) {
  record(identity.version, identity.inputs, identity.page_bytes, identity.with_sides,
         identity.attributes, identity.value_property, identity.strict, identity.float64,
         identity.chunk_triangles, identity.sector_triangles, identity.box);
}

}  // namespace planetree::octree
