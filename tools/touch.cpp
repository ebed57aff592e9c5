#include "tools/touch.h"

#include <fcntl.h>
#include <unistd.h>

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tools/cli/open_model.h"
#include "tools/cli/output_file.h"
#include "tools/scene/scene_session.h"
#include "tools/session/session_report.h"
#include "tools/session/session_ticks.h"
#include "tools/session/touch_page.h"
#include "tools/touch_model.h"
#include "tools/trace_file/trace_writer.h"

namespace planetree::tools {
namespace {

/// Drops the file from the system's page cache, so that every page comes from the disk.
void drop_from_page_cache(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return;
  ::posix_fadvise(file, 0, 0, POSIX_FADV_DONTNEED);
  ::close(file);
}

/// Opens an additional output file, if `path` names one. Opened before the session, which may be
/// long, so that the command fails early.
template <class File>
Result<std::optional<File>> open_extra_output(const std::filesystem::path& path, bool force) {
  if (path.empty()) return std::optional<File>();
  auto file = File::create(path, force);
  if (!file) return file.error();
  return std::optional<File>(std::move(*file));
}

Result<void> write_whole(OutputFile& file, const std::string& text) {
  if (const auto written = file.write(std::as_bytes(std::span(text))); !written) return written;
  return file.commit();
}

/// One session: what it reads, its path and what it comes to.
class TouchRun {
 public:
  /// console  must outlive this
  TouchRun(const TouchArguments& arguments, Console& console)
      : arguments_(arguments), console_(console) {}

  /// Reads the scene file, if there is one. Returns the exit status.
  int read();
  /// Finds the path and runs the session. Returns the exit status.
  int run(std::optional<TraceWriter>& trace);
  /// The error to report after the session. Empty if there is none.
  std::optional<Error> lost() const;

  /// Those that were given, with the memory that a scene file decides.
  const TouchArguments& arguments() const { return arguments_; }
  /// The files of the session.
  const std::vector<std::filesystem::path>& inputs() const { return inputs_; }
  const std::vector<Vec3>& path() const { return path_; }
  const TouchOutcome& outcome() const { return outcome_; }

 private:
  int run_model(std::optional<TraceWriter>& trace);
  int run_scene();
  void drop_inputs() const;

  TouchArguments arguments_;
  Console& console_;
  SceneDescription scene_;
  std::vector<std::filesystem::path> inputs_;
  std::vector<Vec3> path_;
  TouchOutcome outcome_;
};

int TouchRun::read() {
  inputs_ = {arguments_.file};
  if (!arguments_.is_scene) return kDone;
  auto scene = read_scene(arguments_.file);
  if (!scene) return console_.fail(arguments_.file.string(), scene.error());
  scene_ = *std::move(scene);
  if (!arguments_.memory_is_given) arguments_.memory_bytes = scene_.budget_bytes({});
  for (const ModelDescription& model : scene_.models) inputs_.push_back(model.file);
  return kDone;
}

int TouchRun::run(std::optional<TraceWriter>& trace) {
  return arguments_.is_scene ? run_scene() : run_model(trace);
}

void TouchRun::drop_inputs() const {
  if (arguments_.cold)
    for (const std::filesystem::path& file : inputs_) drop_from_page_cache(file);
}

int TouchRun::run_model(std::optional<TraceWriter>& trace) {
  auto path = find_model_path(arguments_, console_);
  if (!path) return console_.fail(arguments_.file.string(), path.error());
  path_ = *std::move(path);
  drop_inputs();
  auto outcome = run_model_session(arguments_, path_, trace);
  if (!outcome) return console_.fail(arguments_.file.string(), outcome.error());
  outcome_ = *std::move(outcome);
  return kDone;
}

int TouchRun::run_scene() {
  SceneFailure failure;
  auto path = find_scene_path(arguments_, scene_, failure);
  if (!path) return console_.fail(failure.file.string(), failure.error);
  path_ = *std::move(path);
  drop_inputs();
  auto outcome = run_scene_session(arguments_, scene_, path_, failure);
  if (!outcome) return console_.fail(failure.file.string(), failure.error);
  outcome_ = *std::move(outcome);
  return kDone;
}

std::optional<Error> TouchRun::lost() const {
  return arguments_.is_scene ? scene_pages_lost(outcome_.stats.quarantined_pages)
                             : pages_lost(outcome_.stats, outcome_.read_error);
}

}  // namespace

int run_touch(const TouchArguments& given, Console& console) {
  TouchRun run(given, console);
  if (const int status = run.read(); status != kDone) return status;
  const TouchArguments& arguments = run.arguments();
  ReportPage page(arguments.page, console);
  if (const int status = page.open(run.inputs()); status != kDone) return status;
  auto ticks = open_extra_output<OutputFile>(arguments.ticks, arguments.page.force);
  if (!ticks) return console.fail(arguments.ticks.string(), ticks.error());
  auto trace = open_extra_output<TraceWriter>(arguments.trace, arguments.page.force);
  if (!trace) return console.fail(arguments.trace.string(), trace.error());
  if (const int status = run.run(*trace); status != kDone) return status;

  const TouchOutcome& outcome = run.outcome();
  const int reported =
      page.report(arguments.json ? touch_json(arguments, outcome) : touch_words(arguments, outcome),
                  [&] { return touch_page(arguments, outcome, touch_command(arguments)); });
  if (reported != kDone) return console.finish(reported);
  if (*ticks)
    if (const auto written = write_whole(**ticks, touch_ticks(run.path(), outcome)); !written)
      return console.finish(console.fail(arguments.ticks.string(), written.error()));
  if (!outcome.trace_written)
    return console.finish(console.fail(arguments.trace.string(), outcome.trace_written.error()));
  const auto error = run.lost();
  return console.finish(error ? console.fail(arguments.file.string(), *error) : kDone);
}

}  // namespace planetree::tools
