#pragma once

#include <exception>
#include <filesystem>
#include <new>
#include <optional>
#include <string>
#include <utility>

#include "octree/builder/job/build_options.h"
#include "octree/builder/job/build_progress.h"
#include "octree/builder/tree_builder.h"
#include "octree/geometry/fp_environment.h"
#include "octree/geometry/startup_check.h"
#include "planetree/build.h"
#include "planetree/error.h"

/// What the public calls that build have in common: the caller's functions, options and reports.
namespace planetree::octree {

/// Passes what a build reports on to the caller's functions, and what they say back to the build.
class BuildObserver final : public BuildProgress {
 public:
  /// options  must outlive this.
  explicit BuildObserver(const planetree::BuildOptions& options) : options_(options) {}

  Result<void> progress(BuildPhase phase, std::uint64_t done, std::uint64_t total) override;
  void failed_at(BuildDirectory, const std::filesystem::path& path) override { failed_at(path); }
  void resumes(const std::string& what) override;

  /// Reports the path of a failure, the first one only.
  void failed_at(const std::filesystem::path& path) noexcept;
  /// Reports the path of a failure and returns the error.
  Error refuse(const std::filesystem::path& path, const Error& error) {
    failed_at(path);
    return error;
  }

 private:
  bool is_cancelled() const {
    return options_.cancel && options_.cancel->load(std::memory_order_relaxed);
  }
  Error cancelled() const;

  const planetree::BuildOptions& options_;
  std::optional<Error> failure_;  // of a callback that cannot return one
  bool has_failed_ = false;
};

/// Checks before the build what it would otherwise find only at its end.
/// errors  kBadArgument: `output` is a directory or the input; kAlreadyExists; kNotFound;
///         kPermission.
Result<void> check_output(const BuildInput& input, const std::filesystem::path& output,
                          bool replace);
/// errors  kNotFound: the directory for temporary files does not exist.
Result<void> check_spill_directory(const std::filesystem::path& directory);

/// The options of the layers below. The metadata has a generator.
BuildOptions inner_options(const planetree::BuildOptions& options);
planetree::BuildReport public_report(const BuildReport& built);

/// The error of an exception that says that the system refuses resources.
Error refused_resources(const char* what);
Error refused_memory();

/// Returns call(), which builds, in the floating-point mode that it needs. What it throws becomes
/// an error.
template <class Call>
auto call_builder(const Call& call) -> decltype(call()) {
  try {
    const FpEnvironmentGuard host;
    if (const auto checked = check_arithmetic(); !checked) return checked.error();
    return call();
  } catch (const std::bad_alloc&) {
    return refused_memory();
  } catch (const std::exception& thrown) {
    return refused_resources(thrown.what());
  }
}

}  // namespace planetree::octree
