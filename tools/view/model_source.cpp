#include "tools/view/model_source.h"

#include <algorithm>
#include <utility>

#include "octree/geometry/octcode.h"
#include "tools/cli/layer_option.h"
#include "tools/simulation/trace_budget.h"
#include "tools/trace_file/trace_reader.h"
#include "tools/view/point_answer.h"
#include "tools/view/view_json.h"

namespace planetree::tools {
namespace {

/// Words of the page trace of each thread: some seconds of a probe that is dragged.
constexpr std::uint32_t kTraceWords = 1U << 16;

OpenOptions options_with(std::uint64_t memory_bytes) {
  OpenOptions options;
  options.memory_budget_bytes = memory_bytes;
  options.max_probes = 1;
  options.page_trace_capacity = kTraceWords;
  return options;
}

std::vector<std::uint8_t> levels_of(const FileParts& parts) {
  std::vector<std::uint8_t> levels;
  levels.reserve(parts.page_count());
  for (const storage::PageEntry& entry : parts.entries())
    levels.push_back(static_cast<std::uint8_t>(octree::cell_of_octcode(entry.octcode).level));
  return levels;
}

}  // namespace

ModelSource::ModelSource(Model model, Probe probe, ShapeReader shape, std::string name,
                         std::uint64_t memory_bytes)
    : name_(std::move(name)),
      memory_bytes_(memory_bytes),
      parts_(parts_told(model)),
      model_(std::move(model)),
      probe_(std::move(probe)),
      shape_(std::move(shape)),
      header_(*shape_.parts().header()),
      activity_(levels_of(shape_.parts())),
      drained_(4096) {}

Result<std::unique_ptr<ModelSource>> ModelSource::open(const std::filesystem::path& file,
                                                       std::uint64_t memory_bytes) {
  OpenOptions options = options_with(memory_bytes);
  const auto budget = budget_with_trace(file, options);
  if (!budget) return budget.error();
  options.memory_budget_bytes = *budget;
  auto model = Model::open(file, options);
  if (!model) return model.error();
  auto probe = Probe::create(*model);
  if (!probe) return probe.error();
  auto shape = ShapeReader::open(file);
  if (!shape) return shape.error();
  return std::unique_ptr<ModelSource>(new ModelSource(std::move(*model), std::move(*probe),
                                                      std::move(*shape), file.filename().string(),
                                                      memory_bytes));
}

Result<void> ModelSource::read_trace(const std::filesystem::path& path) {
  auto reader = TraceReader::open(path.string());
  if (!reader) return reader.error();
  if (!std::equal(std::begin(model_.info().content_id), std::end(model_.info().content_id),
                  std::begin(reader->header().content_id)))
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "it is the trace of another model; view the file that was traced");
  TraceTimeline timeline;
  std::vector<PageAccess> accesses(4096);
  while (true) {
    const auto count = reader->read(accesses);
    if (!count) return count.error();
    for (std::size_t i = 0; i < *count; ++i) timeline.add(accesses[i]);
    if (*count == 0) break;
  }
  timeline_ = std::move(timeline);
  return {};
}

std::string ModelSource::info() {
  return info_json(name_, model_.info(), header_, model_.stats(), memory_bytes_);
}

Result<std::string> ModelSource::shape(const ShapeView& view) {
  const std::lock_guard lock(shaping_);
  return shape_.read_bytes(view);
}

std::string ModelSource::answer(const PointQuestion& question) {
  const auto placed = [](const ClosestPoint& found) { return PlacedPoint{found}; };
  const std::lock_guard lock(probing_);
  return answer_json(ask_at(probe_, question, parts_, placed), question.within);
}

/// Brings the states of pages up to date.
void ModelSource::follow_pages() {
  std::size_t count = 0;
  do {
    count = model_.drain_page_trace(drained_);
    activity_.add(std::span(drained_).first(count));
  } while (count == drained_.size());
}

std::string ModelSource::stats() {
  const std::lock_guard lock(following_);
  follow_pages();
  return stats_json(model_.stats(), activity_, header_);
}

std::string ModelSource::pages() {
  const std::lock_guard lock(following_);
  follow_pages();
  std::string bytes;
  bytes.reserve(2 * activity_.states().size());
  for (const PageState state : activity_.states()) bytes += static_cast<char>(state);
  for (const std::uint8_t level : activity_.levels()) bytes += static_cast<char>(level);
  return bytes;
}

std::string ModelSource::timeline() { return timeline_json(timeline_ ? &*timeline_ : nullptr); }

}  // namespace planetree::tools
