#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "planetree/error.h"
#include "planetree/model.h"
#include "planetree/probe.h"
#include "storage/file/file_layout.h"
#include "tools/tune/trace_timeline.h"
#include "tools/view/page_activity.h"
#include "tools/view/shape_reader.h"
#include "tools/view/view_source.h"

namespace planetree::tools {

/// A model as a source: its shape from the file, answers by a probe that does not wait for pages,
/// and its page trace.
class ModelSource final : public ViewSource {
 public:
  /// memory_bytes  OpenOptions::memory_budget_bytes, without the page trace
  /// errors        those of Model::open() and ShapeReader::open()
  static Result<std::unique_ptr<ModelSource>> open(const std::filesystem::path& file,
                                                   std::uint64_t memory_bytes);
  /// Reads the trace of a session with this model. Call it before the source is served.
  ///
  /// errors  those of TraceReader; kBadArgument: the trace is of another model
  Result<void> read_trace(const std::filesystem::path& path);

  std::string info() override;
  Result<std::string> shape(const ShapeView& view) override;
  std::string answer(const PointQuestion& question) override;
  std::string stats() override;
  std::string pages() override;
  std::string timeline() override;

 private:
  ModelSource(Model model, Probe probe, ShapeReader shape, std::string name,
              std::uint64_t memory_bytes);
  void follow_pages();

  const std::string name_;
  const std::uint64_t memory_bytes_;
  const std::uint32_t parts_;  // that queries compute; see parts_told()
  Model model_;
  std::mutex probing_;
  Probe probe_;
  std::mutex shaping_;
  ShapeReader shape_;
  const storage::FileHeader header_;
  std::mutex following_;
  PageActivity activity_;
  std::vector<PageAccess> drained_;
  std::optional<TraceTimeline> timeline_;
};

}  // namespace planetree::tools
