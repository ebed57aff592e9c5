#pragma once

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

/// What all steps of a sharded build need to know.
struct ShardPlan {
  std::uint32_t shards = 0;
  std::string input;           ///< path, from the root
  BuildIdentity identity;      ///< of the input, and options
  storage::Hash128 content{};  ///< hash of all bytes of the input and of the files it names
  std::uint32_t layers = 0;
  std::uint32_t keep = 0;
  std::optional<storage::SideRule> side;
  std::vector<std::string> metadata;  ///< keys and values in turn
  OrderedMesh mesh;                   ///< without runs

  /// Number of triangle indices, those of skipped records included.
  std::uint64_t index_count() const { return mesh.frame.triangle_count + mesh.frame.skipped_count; }
  /// Puts the options that the bytes of the output depend on in place of those in `options`.
  void impose_on(BuildOptions& options) const;
  static ShardPlan of(const std::filesystem::path& input, std::uint32_t shards,
                      const BuildIdentity& identity, const BuildOptions& options);
  /// Whether a plan of these would be this one, unless the mesh is read in another way.
  bool is_like(const ShardPlan& other) const;
};

/// First of the things that belong to a part, where `count` things are divided among `parts`.
std::uint64_t first_of_part(std::uint64_t part, std::uint64_t count, std::uint64_t parts);

/// Hash of all bytes of a mesh file and of the files that it names.
/// errors  those of opening and reading them.
Result<storage::Hash128> content_of(const std::filesystem::path& input, storage::FileCalls& calls);

/// Checks that the input is the one that was planned. Where it looks like another file, as a copy
/// on another machine does, all of it is hashed. Returns what it looks like now.
/// errors  kBadInput: it has changed; those of content_of().
Result<BuildIdentity> check_input(const ShardPlan& plan, const BuildOptions& options,
                                  const BuildSeams& seams);
/// Checks that the input still looks as before it was read.
/// errors  kBadInput: it does not; those of BuildIdentity::of().
Result<void> check_unchanged(const ShardPlan& plan, const BuildIdentity& before,
                             const BuildOptions& options, const BuildSeams& seams);

template <class Record, IsA<ShardPlan> Value>
void fields(Record& record, Value& plan) {
  record(plan.shards, plan.input, plan.identity, plan.content.low, plan.content.high, plan.layers,
         plan.keep, plan.side, plan.metadata, plan.mesh);
}

}  // namespace planetree::octree
