#include <utility>

#include "octree/shard/shard_steps.h"

namespace planetree::octree {

Result<BuildReport> merge_shards(ShardJob& job, const std::filesystem::path& output,
                                 BuildOptions options, BuildProgress& progress,
                                 const BuildSeams& seams) {
  const auto plan = job.plan();
  if (!plan) return plan.error();
  plan->plan.impose_on(options);
  ShardResults results{{plan->file, plan->plan.mesh}, {}, {}};
  auto sorted = job.sorted(*plan);
  if (!sorted) return sorted.error();
  results.sorted = *std::move(sorted);
  auto built = job.built(*plan, results.sorted);
  if (!built) return built.error();
  results.built = *std::move(built);
  const BuildInput input = plan->plan.input_of(plan->plan.all_files());
  return merge_tree(results, input, output, options, progress, seams);
}

}  // namespace planetree::octree
