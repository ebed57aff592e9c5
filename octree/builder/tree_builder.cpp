#include "octree/builder/tree_builder.h"

#include "octree/builder/job/build_memory.h"
#include "octree/builder/job/build_threads.h"
#include "octree/builder/tree_build.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

/// Runs a step of a build with the memory and the threads that the options allow.
template <class Step>
Result<BuildReport> with_memory(const BuildOptions& options, const BuildSeams& seams,
                                const Step& step) {
  if (const auto checked = options.check(); !checked) return checked.error();
  auto memory = seams.memory ? Result<BuildMemory>(*seams.memory)
                             : BuildMemory::share(options.memory_bytes, options.threads);
  if (!memory) return memory.error();
  if (options.resume) memory = memory->with_checkpoint();
  return BuildThreads(memory->threads).run([&] { return step(*memory); });
}

}  // namespace

Result<BuildReport> build_tree(const BuildInput& input, const std::filesystem::path& output,
                               const BuildOptions& options, BuildProgress& progress,
                               const BuildSeams& seams) {
  return with_memory(options, seams, [&](const BuildMemory& memory) {
    TreeBuild build(input, output, options, memory, progress, seams);
    auto report = build.run();
    if (!report) build.report_failure();
    return report;
  });
}

Result<BuildReport> merge_tree(const ShardResults& results, const BuildInput& input,
                               const std::filesystem::path& output, const BuildOptions& options,
                               BuildProgress& progress, const BuildSeams& seams) {
  return with_memory(options, seams, [&](const BuildMemory& memory) {
    TreeBuild build(input, output, options, memory, progress, seams);
    auto report = build.join(results);
    if (!report) build.report_failure();
    return report;
  });
}

}  // namespace planetree::octree
