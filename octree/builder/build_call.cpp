#include "octree/builder/build_call.h"

#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "octree/builder/job/build_memory.h"
#include "octree/builder/job/input_paths.h"
#include "storage/file/file_layout.h"
#include "storage/system/file_error.h"

namespace planetree::octree {
namespace {

namespace fs = std::filesystem;

static_assert(planetree::BuildOptions::kMinMemoryBytes == BuildMemory::kMinBytes);
static_assert(planetree::BuildOptions::kMinPageBytes == storage::kMinPageBytes);
static_assert(planetree::BuildOptions::kMaxPageBytes == storage::kMaxPageBytes);

Error error_of(ErrorCode code, const char* text) {
  return make_error(code, Error::kNowhere, Error::kNowhere, "%s", text);
}

Error thrown_by_callback(const char* what) {
  return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                    "a callback of the build threw: %s; let it throw nothing", what);
}

/// Calls a function of the caller, which may throw.
template <class Call>
Result<void> guarded(const Call& call) {
  try {
    return call();
  } catch (const std::exception& thrown) {
    return thrown_by_callback(thrown.what());
  } catch (...) {
    return thrown_by_callback("no standard exception");
  }
}

// The metadata of the file: the generator is added, and what is empty is left out.
Metadata complete_metadata(Metadata given) {
  given.try_emplace("generator", "planetree " PLANETREE_VERSION);
  std::erase_if(given, [](const auto& entry) { return entry.second.empty(); });
  return given;
}

std::uint64_t peak_resident_bytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace

Result<void> BuildObserver::progress(BuildPhase phase, std::uint64_t done, std::uint64_t total) {
  if (failure_) return *failure_;
  if (is_cancelled()) return cancelled();
  if (!options_.on_progress) return {};
  return guarded([&]() -> Result<void> {
    return options_.on_progress(phase, done, total) ? Result<void>() : cancelled();
  });
}

void BuildObserver::resumes(const std::string& what) {
  if (!options_.on_resume) return;
  const auto called = guarded([&]() -> Result<void> {
    options_.on_resume(what);
    return {};
  });
  if (!called) failure_ = called.error();
}

void BuildObserver::failed_at(const fs::path& path) noexcept {
  if (!std::exchange(has_failed_, true) && options_.on_failure)
    // The error that is about to be returned says more than an exception from here.
    try {
      options_.on_failure(path);
    } catch (...) {
    }
}

Error BuildObserver::cancelled() const {
  return error_of(ErrorCode::kCancelled, options_.resume
                                             ? "cancelled; a later build can resume what is done"
                                             : "cancelled; nothing was written");
}

Result<void> check_output(const BuildInput& input, const fs::path& output, bool replace) {
  std::error_code ignored;
  if (fs::is_directory(output, ignored))
    return error_of(ErrorCode::kBadArgument, "this is a directory; name a file in it");
  for (const fs::path& path : paths_of(input))
    if (fs::equivalent(path, output, ignored))
      return error_of(ErrorCode::kBadArgument, "this is the input itself; name another output");
  if (fs::exists(fs::symlink_status(output, ignored)) && !replace)
    return error_of(ErrorCode::kAlreadyExists,
                    "the file exists; use --force to replace it, or another name");
  const fs::path folder = output.parent_path();
  if (!folder.empty() && !fs::is_directory(folder, ignored))
    return error_of(ErrorCode::kNotFound, "its directory does not exist; create it first");
  if (::access(folder.empty() ? "." : folder.c_str(), W_OK | X_OK) != 0)
    return storage::file_error(errno, storage::FileAction::kWrite, "write to its directory");
  return {};
}

Result<void> check_spill_directory(const fs::path& directory) {
  if (std::error_code ignored; fs::is_directory(directory, ignored)) return {};
  return error_of(ErrorCode::kNotFound, "no such directory for temporary files; create it first");
}

BuildOptions inner_options(const planetree::BuildOptions& options) {
  BuildOptions inner;
  inner.page_bytes = options.page_bytes;
  inner.threads = options.threads;
  inner.memory_bytes = options.memory_bytes;
  inner.temp_directory = options.temp_directory;
  inner.float64 = options.float64;
  inner.strict = options.strict;
  if (options.side != SideChoice::kAuto)
    inner.side = options.side == SideChoice::kSurface ? storage::SideRule::kSurface
                                                      : storage::SideRule::kSolid;
  inner.layers = options.layers;
  inner.keep = options.keep;
  inner.value_property = options.value_property;
  inner.replace = options.replace;
  if (options.box) inner.box = {options.box->lower, options.box->upper};
  inner.resume = options.resume;
  inner.metadata = complete_metadata(options.metadata);
  return inner;
}

planetree::BuildReport public_report(const BuildReport& built) {
  const storage::FileHeader& header = built.header;
  const storage::ModelRecord& model = header.model;
  planetree::BuildReport report;
  report.triangles = model.triangle_count;
  report.input_triangles = built.frame.triangle_count;
  report.skipped = model.skipped_count;
  report.first_skipped = model.first_skipped;
  report.first_skipped_text = built.frame.first_skipped_text;
  report.nonplanar_polygons = built.frame.nonplanar_count;
  report.first_nonplanar_text = built.frame.first_nonplanar_text;
  report.fanned_polygons = built.frame.fanned_count;
  report.first_fanned_text = built.frame.first_fanned_text;
  report.notes = built.notes;
  report.vertices = model.vertex_count;
  report.strays = model.stray_count;
  report.unbalanced_edges = model.unbalanced_edge_count;
  report.side_rule =
      model.side_rule == storage::SideRule::kSurface ? SideRule::kSurface : SideRule::kSolid;
  report.side_is_chosen = model.side_is_chosen != 0;
  report.openness = model.openness;
  report.nodes = model.node_count;
  report.blocks = model.block_count;
  report.levels = model.height;
  report.layers = kDistanceLayer | (model.has_side_layer() ? kSideLayer : 0) |
                  (model.field_page_count > 0 ? kFieldLayer : 0) |
                  (model.attributes != 0 ? kAttributeLayer : 0);
  report.attributes = model.attributes;
  report.page_bytes = header.page_bytes;
  report.metadata = built.metadata;
  report.pages = header.page_count;
  report.file_bytes = header.file_bytes;
  report.temporary_bytes = built.temporary_bytes;
  report.peak_resident_bytes = peak_resident_bytes();
  report.content_id[0] = header.content_id[0];
  report.content_id[1] = header.content_id[1];
  return report;
}

Error refused_resources(const char* what) {
  return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                    "the system refuses resources: %s; free some, or give fewer --threads", what);
}

Error refused_memory() {
  return error_of(ErrorCode::kNoMemory,
                  "the system refuses memory; free some, or give less --memory or --threads");
}

}  // namespace planetree::octree
