#include "planetree/build.h"

#include "octree/builder/build_call.h"
#include "octree/builder/job/input_paths.h"
#include "octree/builder/tree_builder.h"
#include "storage/file/metadata.h"

namespace planetree {
namespace {

Result<BuildReport> build_checked(const BuildInput& input, const std::filesystem::path& output,
                                  const BuildOptions& options, octree::BuildObserver& observer) {
  if (const auto checked = octree::check_output(input, output, options.replace); !checked)
    return observer.refuse(output, checked.error());
  const octree::BuildOptions inner = octree::inner_options(options);
  if (const auto checked = storage::check_metadata(inner.metadata); !checked)
    return observer.refuse({}, checked.error());
  const std::filesystem::path temporary = inner.spill_directory(output);
  if (const auto checked = octree::check_spill_directory(temporary); !checked)
    return observer.refuse(temporary, checked.error());
  const auto built = octree::build_tree(input, output, inner, observer);
  if (!built) return built.error();
  return octree::public_report(*built);
}

}  // namespace

Result<BuildReport> build(const BuildInput& input, const std::filesystem::path& output,
                          const BuildOptions& options) {
  octree::BuildObserver observer(options);
  auto report =
      octree::call_builder([&] { return build_checked(input, output, options, observer); });
  if (!report) observer.failed_at(octree::path_of(input));
  return report;
}

}  // namespace planetree
