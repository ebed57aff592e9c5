#include "planetree/shard.h"

#include "octree/builder/build_call.h"
#include "octree/shard/shard_steps.h"
#include "storage/file/metadata.h"

namespace planetree {
namespace {

namespace fs = std::filesystem;

/// Calls step(job, inner options, observer, seams) and reports the file of a failure.
template <class Step>
auto run_step(const fs::path& directory, const BuildOptions& options, const Step& step) {
  octree::BuildObserver observer(options);
  const octree::BuildSeams seams;
  octree::ShardJob job(directory, seams);
  auto report = octree::call_builder([&] {
    const octree::BuildOptions inner = octree::inner_options(options);
    using Outcome = decltype(step(job, inner, observer, seams));
    if (const fs::path& temporary = options.temp_directory; !temporary.empty())
      if (const auto checked = octree::check_spill_directory(temporary); !checked)
        return Outcome(observer.refuse(temporary, checked.error()));
    return step(job, inner, observer, seams);
  });
  if (!report) observer.failed_at(job.failed_at().empty() ? directory : job.failed_at());
  return report;
}

Error refused(const char* text) {
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere, "%s", text);
}

Result<void> check_plan(std::uint32_t shards, const octree::BuildOptions& options) {
  if (shards == 0 || shards > kMaxShards)
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "%u shards; give 1 to %u", shards, kMaxShards);
  if (options.box) return refused("a job builds whole meshes; build the box without shards");
  if (options.resume) return refused("a job needs no checkpoint; plan it without resume");
  if (const auto checked = options.check(); !checked) return checked;
  return storage::check_metadata(options.metadata);
}

}  // namespace

Result<ShardPlanReport> plan_shards(const std::vector<fs::path>& inputs, const fs::path& job,
                                    std::uint32_t shards, const BuildOptions& options) {
  return run_step(job, options, [&](auto& opened, const auto& inner, auto& observer, auto& seams) {
    using Outcome = Result<ShardPlanReport>;
    if (const auto checked = check_plan(shards, inner); !checked)
      return Outcome(observer.refuse({}, checked.error()));
    auto report = octree::plan_shards(BuildInput(inputs), opened, shards, inner, observer, seams);
    return report;
  });
}

Result<ShardPlanReport> plan_shards(const fs::path& input, const fs::path& job,
                                    std::uint32_t shards, const BuildOptions& options) {
  return plan_shards(std::vector<fs::path>{input}, job, shards, options);
}

Result<ShardReport> map_shard(const fs::path& job, std::uint32_t shard,
                              const BuildOptions& options) {
  return run_step(job, options, [&](auto& opened, const auto& inner, auto& observer, auto& seams) {
    return octree::map_shard(opened, shard, inner, observer, seams);
  });
}

Result<ShardReport> reduce_shard(const fs::path& job, std::uint32_t shard,
                                 const BuildOptions& options) {
  return run_step(job, options, [&](auto& opened, const auto& inner, auto& observer, auto& seams) {
    return octree::reduce_shard(opened, shard, inner, observer, seams);
  });
}

Result<BuildReport> merge_shards(const fs::path& job, const fs::path& output,
                                 const BuildOptions& options) {
  return run_step(job, options, [&](auto& opened, const auto& inner, auto& observer, auto& seams) {
    using Outcome = Result<BuildReport>;
    if (const auto checked = octree::check_output({fs::path()}, output, inner.replace); !checked)
      return Outcome(observer.refuse(output, checked.error()));
    const auto built = octree::merge_shards(opened, output, inner, observer, seams);
    return built ? Outcome(octree::public_report(*built)) : Outcome(built.error());
  });
}

}  // namespace planetree
