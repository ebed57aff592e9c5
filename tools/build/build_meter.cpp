#include "tools/build/build_meter.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/cli/size_text.h"

namespace planetree::tools {
namespace {

const char* unit_of(BuildPhase phase) {
  if (phase == BuildPhase::kReading) return "bytes";
  return phase == BuildPhase::kWriting ? "pages" : "parts";
}

/// The phase's key in JSON, such as "matching_edges".
std::string key_of(BuildPhase phase) {
  std::string key = name_of(phase);
  std::replace(key.begin(), key.end(), ' ', '_');
  return key;
}

void warn_of_skipped(const std::string& mesh, const BuildReport& report, Console& console) {
  if (report.skipped == 0) return;
  console.warn(mesh, fmt::format("{} triangle{} of bad records skipped, the first: {}; repair the "
                                 "mesh, or use --strict to refuse it",
                                 grouped_count(report.skipped), report.skipped == 1 ? "" : "s",
                                 report.first_skipped_text));
}

void warn_of_odd_polygons(const std::string& mesh, const BuildReport& report, Console& console) {
  const auto polygons = [](std::uint64_t count) {
    return fmt::format("{} polygon{}", grouped_count(count), count == 1 ? "" : "s");
  };
  if (report.nonplanar_polygons > 0)
    console.warn(mesh,
                 fmt::format("{} neither convex nor flat split as seen along an axis, the first: "
                             "{}; split them before the export to choose their triangles",
                             polygons(report.nonplanar_polygons), report.first_nonplanar_text));
  if (report.fanned_polygons > 0)
    console.warn(mesh,
                 fmt::format("{} split into fans that may reach beyond them, the first: {}; split "
                             "them before the export",
                             polygons(report.fanned_polygons), report.first_fanned_text));
}

}  // namespace

BuildOptions BuildMeter::observed(BuildOptions options) {
  options.on_progress = [this](BuildPhase phase, std::uint64_t done, std::uint64_t total) {
    show(phase, done, total);
    return true;
  };
  options.on_resume = [this](const std::string& line) {
    if (!quiet_) console_.note(fmt::format("planetree: {}: {}\n", name_.string(), line));
  };
  options.on_failure = [this](const std::filesystem::path& path) { failed_at_ = path; };
  return options;
}

void BuildMeter::finish() {
  note_seconds();
  progress_.finish();
}

double BuildMeter::seconds() const {
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - made_;
  return std::max(elapsed.count(), 1e-9);
}

void BuildMeter::show(BuildPhase phase, std::uint64_t done, std::uint64_t total) {
  if (phase != phase_) {
    note_seconds();
    phase_ = phase;
    done_ = 0;
    progress_.start(name_of(phase), total, unit_of(phase));
  }
  if (done > done_) progress_.add(done - done_);
  done_ = std::max(done, done_);
}

void BuildMeter::note_seconds() {
  const auto now = std::chrono::steady_clock::now();
  const std::chrono::duration<double> elapsed = now - started_;
  if (phase_) seconds_[key_of(*phase_)] = elapsed.count();
  started_ = now;
}

std::string mesh_name(const std::vector<std::filesystem::path>& files) {
  return files.size() == 1 ? files.front().string() : fmt::format("{} meshes", files.size());
}

std::string name_of_failure(const BuildMeter& meter,
                            const std::vector<std::filesystem::path>& inputs) {
  const bool is_of_all = meter.failed_at().empty() && inputs.size() > 1;
  return is_of_all ? mesh_name(inputs) : meter.failed_at().string();
}

void warn_of_mesh(const std::string& mesh, const BuildReport& report, Console& console) {
  for (const std::string& note : report.notes) console.warn(mesh, note);
  warn_of_skipped(mesh, report, console);
  warn_of_odd_polygons(mesh, report, console);
}

}  // namespace planetree::tools
