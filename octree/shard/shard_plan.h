#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "octree/builder/build_identity.h"
#include "octree/builder/build_seams.h"
#include "octree/builder/job/build_options.h"
#include "octree/builder/sort/ordered_mesh.h"
#include "octree/builder/work_records.h"
#include "planetree/build.h"
#include "storage/file/checksum.h"

namespace planetree::octree {

/// Files of an input that follow each other.
struct MeshFileRange {
  std::size_t first = 0;
  std::size_t count = 0;
  std::uint64_t first_index = 0;  ///< triangle index with which the first of them begins
};

/// What all steps of a sharded build need to know.
struct ShardPlan {
  std::uint32_t shards = 0;
  std::vector<std::string> inputs;         ///< paths of the mesh files, from the root, in order
  BuildIdentity identity;                  ///< of the files, and options
  std::vector<storage::Hash128> contents;  ///< of each file, see content_of()
  std::uint32_t layers = 0;
  std::uint32_t keep = 0;
  std::optional<storage::SideRule> side;
  std::vector<std::string> metadata;  ///< keys and values in turn
  OrderedMesh mesh;                   ///< without runs

  /// Number of triangle indices, those of skipped records included.
  std::uint64_t index_count() const { return mesh.frame.triangle_count + mesh.frame.skipped_count; }
  /// Puts the options that the bytes of the output depend on in place of those in `options`.
  void impose_on(BuildOptions& options) const;
  /// input  one or more files.
  static ShardPlan of(const BuildInput& input, std::uint32_t shards, const BuildIdentity& identity,
                      const BuildOptions& options);
  /// Whether a plan of these would be this one, unless the mesh is read in another way.
  bool is_like(const ShardPlan& other) const;

  MeshFileRange all_files() const { return {0, inputs.size(), 0}; }
  /// The files with the triangle indices from `first_index` to before `end_index`; none if there is
  /// no index.
  MeshFileRange files_with(std::uint64_t first_index, std::uint64_t end_index) const;
  /// Files as an input, in which indices begin with 0.
  BuildInput input_of(const MeshFileRange& files) const;
};

/// First of the things that belong to a part, where `count` things are divided among `parts`.
std::uint64_t first_of_part(std::uint64_t part, std::uint64_t count, std::uint64_t parts);

/// Hash of all bytes of a mesh file and of the files that it names.
/// errors  those of opening and reading them.
Result<storage::Hash128> content_of(const std::filesystem::path& input, storage::FileCalls& calls);

/// Checks that files are those that were planned. Where one looks like another file, as a copy on
/// another machine does, all of it is hashed. Returns what they look like now.
///
/// failed_at  set to the file that an error concerns.
/// errors     kBadInput: it has changed; those of content_of().
Result<std::vector<InputIdentity>> check_files(const ShardPlan& plan, const MeshFileRange& files,
                                               const BuildOptions& options, const BuildSeams& seams,
                                               std::filesystem::path& failed_at);
/// Checks that files still look as before they were read.
///
/// failed_at  set to the file that an error concerns.
/// errors     kBadInput: it does not; those of BuildIdentity::of().
Result<void> check_unchanged(const ShardPlan& plan, const MeshFileRange& files,
                             const std::vector<InputIdentity>& before, const BuildOptions& options,
                             const BuildSeams& seams, std::filesystem::path& failed_at);

template <class Record, IsA<storage::Hash128> Value>
void fields(Record& record, Value& hash) {
  record(hash.low, hash.high);
}

template <class Record, IsA<ShardPlan> Value>
void fields(Record& record, Value& plan) {
  record(plan.shards, plan.inputs, plan.identity, plan.contents, plan.layers, plan.keep, plan.side,
         plan.metadata, plan.mesh);
}

}  // namespace planetree::octree
