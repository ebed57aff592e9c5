#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "planetree/attributes.h"
#include "planetree/error.h"
#include "planetree/model.h"
#include "planetree/stats.h"
#include "query/serve/batch_threads.h"
#include "query/serve/fetch_threads.h"
#include "query/serve/pager.h"
#include "query/serve/read_ahead.h"
#include "query/serve/trace_clock.h"
#include "query/serving_model.h"
#include "storage/http/http_options.h"
#include "storage/system/file_calls.h"

namespace planetree::query {

/// Parts of a model that tests and benchmarks may replace: system calls, so that disks can fail or
/// hang; fetch threads, so that a test can call FetchWorker::work() itself; the clock of the page
/// trace.
struct ModelSeams {
  storage::FileCalls& calls = storage::FileCalls::real();  ///< must outlive the model
  bool starts_fetching = true;                             ///< start fetch threads
  TimeSource trace_time{};  ///< time of the page trace; its context must outlive the model
  storage::HttpLimits http_limits{};  ///< of the requests for a remote file
};

/// The implementation of Model: pager, state in the arena, threads. Any thread may call the const
/// functions.
class ModelState {
 public:
  ~ModelState();
  ModelState(const ModelState&) = delete;
  ModelState& operator=(const ModelState&) = delete;

  /// See Model::open. Requires the default floating-point mode, see FpEnvironmentGuard.
  static Result<std::unique_ptr<ModelState>> open(const std::filesystem::path& path,
                                                  const OpenOptions& options,
                                                  const ModelSeams& seams = {});
  /// Implements Model::open.
  static Result<Model> open_model(const std::filesystem::path& path, const OpenOptions& options,
                                  const ModelSeams& seams = {});
  /// Returns the smallest memory budget that a file opens with. Ignores `memory_budget_bytes`.
  ///
  /// errors  those of Model::open that do not depend on memory
  static Result<std::uint64_t> min_budget_bytes(const std::filesystem::path& path,
                                                const OpenOptions& options);
  static const ModelState& of(const Model& model) noexcept { return *model.state_; }

  const ModelInfo& info() const noexcept { return info_; }
  Stats stats() const noexcept;
  const ServingModel& serving() const noexcept { return *serving_; }
  const ModelGeometry& geometry() const noexcept { return serving_->geometry; }
  /// Returns the reader of a new probe, or kBadArgument if all readers are in use.
  Result<cache::Reader> claim_reader() const noexcept { return pager_->cache().claim_reader(); }
  cache::PageCache& cache() const noexcept { return pager_->cache(); }
  /// See Model::read_error.
  std::optional<Error> read_error() const noexcept { return pager_->read_error(); }
  /// See Model::metadata.
  Result<Metadata> metadata() const;
  /// See Model::triangles.
  Result<void> find_triangles(std::span<const std::uint64_t> indices,
                              std::span<MeshTriangle> triangles) const noexcept;
  /// See Model::drain_page_trace.
  std::size_t drain_page_trace(std::span<PageAccess> accesses) const noexcept;

 private:
  explicit ModelState(std::unique_ptr<Pager> pager);
  Result<void> load();
  Result<void> start_threads(const OpenOptions& options, const ModelSeams& seams);

  // Each member uses the ones before it.
  std::unique_ptr<Pager> pager_;
  ModelInfo info_;
  ServingModelPtr serving_;
  bool field_damaged_ = false;
  // For find_triangles(), one thread at a time; empty if the attribute layer is not open.
  mutable std::mutex finding_;
  mutable std::optional<cache::Reader> finder_;
  std::vector<std::unique_ptr<ProbeState>> batch_probes_;
  std::unique_ptr<BatchThreads> batch_threads_;
  std::optional<ReadAhead> read_ahead_;
  std::unique_ptr<FetchThreads> fetch_threads_;
};

}  // namespace planetree::query
