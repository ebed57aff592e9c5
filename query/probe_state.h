#pragma once

#include <atomic>
#include <bit>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <new>
#include <span>
#include <utility>

#include "cache/reader.h"
#include "planetree/contact.h"
#include "planetree/types.h"
#include "query/answer/contact_set.h"
#include "query/answer/line_hits.h"
#include "query/answer/model_line.h"
#include "query/answer/query_context.h"
#include "query/answer/triangle_set.h"
#include "query/serve/batch_order.h"
#include "query/serve/fetch_requests.h"
#include "query/serve/fetch_threads.h"
#include "query/serve/page_accessor.h"
#include "query/serve/page_trace.h"
#include "query/serving_model.h"

namespace planetree::query {

/// The implementation of Probe. It runs queries, leaves fetch requests for missing pages, and keeps
/// the coherence. It lies in the model's QueryArena. One thread at a time may use it.
class ProbeState {
 public:
  /// model          must outlive the probe
  /// reader         selects the probe's memory in the arena
  /// batch_buffers  null for the probes of the model's own threads
  static std::unique_ptr<ProbeState> create(const ServingModel& model, cache::Reader reader,
                                            std::unique_ptr<BatchBuffers> batch_buffers = nullptr) {
    void* storage = model.arena.probe(reader.index());
    return std::unique_ptr<ProbeState>(
        ::new (storage) ProbeState(model, std::move(reader), std::move(batch_buffers)));
  }
  static void* operator new(std::size_t) = delete;
  /// Does nothing, since the memory is the arena's. The next probe with this reader index
  /// reuses it.
  static void operator delete(void*) noexcept {}

  const ServingModel& model() const noexcept { return model_; }
  cache::Reader& reader() noexcept { return reader_; }
  Coherence& coherence() noexcept { return coherence_; }
  BatchBuffers* batch_buffers() noexcept { return batch_buffers_.get(); }

  /// See Probe::closest_point.
  ClosestPoint closest_point(const Vec3& query, const QueryOptions& options) noexcept;
  /// See Probe::contains.
  Containment contains(const Vec3& query, const QueryOptions& options) noexcept;
  /// Returns the answer of contains() if the side grid tells it by integers, as for most points of
  /// a solid; else kUnknown. It computes nothing with doubles, so the thread may be in any
  /// floating-point mode. It looks nothing up if the grid did not decide the last query.
  Containment contains_fast(const Vec3& query, const QueryOptions& options) noexcept;
  /// See Probe::nearest_triangles and Probe::triangles_within.
  Found find_triangles(const TriangleSetQuery& query, std::span<ClosestPoint> found,
                       const QueryOptions& options) noexcept;
  /// See Probe::first_hit.
  RayHit first_hit(const Ray& ray, const QueryOptions& options) noexcept {
    return find_first_hit(ray, options).hit;
  }
  FirstHit find_first_hit(const Ray& ray, const QueryOptions& options) noexcept;
  /// See Probe::all_hits.
  Found all_hits(const Ray& ray, std::span<RayHit> hits, const QueryOptions& options) noexcept;
  /// See Probe::first_contact.
  FirstContact first_contact(const Sweep& sweep, const QueryOptions& options) noexcept;
  /// See Probe::triangles_within of a box.
  Found find_triangles(const Box& box, std::span<ClosestPoint> found,
                       const QueryOptions& options) noexcept;
  /// See Probe::contacts.
  Found find_contacts(const Vec3& query, double radius, std::span<ClosestPoint> found,
                      const QueryOptions& options) noexcept;
  /// See Probe::motion.
  void note_motion(const Vec3& position, const Vec3& velocity) noexcept {
    model_.requests(reader_.index())
        .motion.store({position, velocity, last_parts_, static_cast<std::uint64_t>(last_side_rule_),
                       side_searches_});
    if (trace_) trace_->motion(position, velocity);
  }
  /// See Probe::work_spent.
  std::uint64_t work_spent() const noexcept { return work_spent_; }
  /// Says whether the next queries are of a batch, for the trace.
  void set_in_batch(bool in_batch) noexcept {
    if (trace_) trace_->set_in_batch(in_batch);
  }
  /// Limits all waits for the pages of a remote model, while it lives, to the wait limit together.
  class WaitLimit;
  /// Time that is left of it. Needs a WaitLimit.
  std::chrono::milliseconds wait_left() const noexcept;
  /// Says whether queries that wait get pages from a server by themselves, many at once. A batch
  /// does it for them.
  void set_looks_ahead(bool looks_ahead) noexcept { looks_ahead_ = looks_ahead; }
  /// Makes it the probe of a fetch thread, which reads its pages itself.
  void set_fetcher() noexcept { is_fetcher_ = true; }
  /// See FetchProbe::fetch_pages.
  std::uint32_t fetch_pages(const Vec3& query, const QueryOptions& options, FetchReason reason,
                            std::span<const Vec3> ahead, const std::atomic<bool>& stop) noexcept;
  /// See FetchProbe::fetch_triangles.
  void fetch_triangles(const TriangleSetQuery& query, std::uint64_t count,
                       const QueryOptions& options, const std::atomic<bool>& stop) noexcept;
  /// See FetchProbe::fetch_way.
  void fetch_way(const Sweep& way, std::uint64_t count, const QueryOptions& options,
                 const std::atomic<bool>& stop) noexcept;
  /// See FetchProbe::fetch_page.
  bool fetch_page(std::uint32_t page, const std::atomic<bool>& stop) noexcept;
  /// Finds the first pages that a closest-point query that does not wait lacks. Leaves no request
  /// and counts no answer.
  ///
  /// pages   receives them, each once, as far as there is room
  /// return  their number
  std::size_t missing_pages(const Vec3& query, const QueryOptions& options,
                            std::span<std::uint32_t> pages) noexcept;
  /// What became of a page that load_page() asked for.
  enum class Loaded : std::uint8_t { kResident, kUnreadable, kLate };
  /// Makes a page resident, as a blocking query does.
  Loaded load_page(std::uint32_t page) noexcept;
  /// See FetchProbe::read_awaited_page.
  bool read_awaited_page() noexcept {
    if (trace_) {
      model_.arena.traces->clock.advance();
      trace_->set_kind(PageAccess::Query::kFetch);
    }
    return reader_.help();
  }

 private:
  // With fewer frames, pages prefetched displace pages that the next queries need, unless no page
  // is ever displaced.
  static constexpr std::uint32_t kMinFramesToPrefetch = 8;

  class RunningQuery;
  using TimePoint = std::chrono::steady_clock::time_point;

  ProbeState(const ServingModel& model, cache::Reader reader,
             std::unique_ptr<BatchBuffers> batch_buffers) noexcept
      : reader_(std::move(reader)),
        model_(model),
        trace_(model.page_trace(reader_.index())),
        batch_buffers_(std::move(batch_buffers)) {}

  template <PageAccess::Query kKind>
  ClosestPoint find_closest_point(const Vec3& query, const QueryOptions& options) noexcept;
  Containment search_side(const Vec3& query, const QueryOptions& options,
                          const octree::Point& scaled,
                          const octree::SideGrid::Lookup& lookup) noexcept;
  Containment find_front(const Vec3& query, QueryOptions options) noexcept;
  Containment leave_unknown(const QueryOptions& options) noexcept;
  void begin_trace(PageAccess::Query kind, Wait wait) noexcept {
    if (trace_) trace_->begin_query(kind, wait);
  }
  template <class Find>
  Found find_set(const Vec3& centre, double radius, std::span<ClosestPoint> found,
                 const QueryOptions& options, const Find& find) noexcept;
  void note_degraded(double width, bool missed) noexcept;
  ClosestPoint find_remote_closest_point(const Vec3& query, const QueryOptions& options) noexcept;
  bool look_ahead(const Vec3& query, const QueryOptions& options) noexcept;
  std::uint32_t fetch_ahead(const Vec3& query, const QueryOptions& options, FetchReason reason,
                            std::span<const Vec3> ahead, const std::atomic<bool>& stop) noexcept;
  cache::FetchTerms remote_terms() const noexcept;
  cache::FetchTerms terms_of(Wait wait) const noexcept {
    if (is_fetcher_) return model_.fetcher_terms;
    const bool is_remote_wait = model_.remote_file && wait == Wait::kForPages;
    return is_remote_wait ? remote_terms() : model_.query_terms;
  }
  void request(const Vec3& query, const QueryOptions& options, std::uint32_t parts,
               std::uint64_t triangles = 0, double radius = 0) noexcept;
  void note_missing_way(const ModelLine& way, double end, double radius, std::uint64_t count,
                        const QueryOptions& options, RunningQuery& running) noexcept;

  // First, so that it is destroyed last: once the reader slot is released, another thread may make
  // a probe in this memory.
  cache::Reader reader_;
  const ServingModel& model_;
  PageTrace* const trace_;  // null: none
  std::unique_ptr<BatchBuffers> batch_buffers_;
  std::uint32_t last_parts_ = kAllParts;         // parts that the last query computed
  SideRule last_side_rule_ = SideRule::kOfFile;  // its side rule; not of contains_fast()
  std::uint64_t work_spent_ = 0;                 // units of all queries
  std::uint64_t side_searches_ = 0;              // closest-point queries that searched for the side
  bool looks_ahead_ = true;
  bool is_fetcher_ = false;                // it is the probe of a fetch thread
  TimePoint deadline_ = TimePoint::max();  // see WaitLimit
  Coherence coherence_;
};

class ProbeState::WaitLimit {
 public:
  explicit WaitLimit(ProbeState& probe) noexcept : probe_(probe) {
    probe.deadline_ = std::chrono::steady_clock::now() + probe.model_.query_terms.wait_limit;
  }
  ~WaitLimit() { probe_.deadline_ = TimePoint::max(); }
  WaitLimit(const WaitLimit&) = delete;
  WaitLimit& operator=(const WaitLimit&) = delete;

 private:
  ProbeState& probe_;
};

/// A query while it runs: its access to pages, its page trace if the model keeps one, and its work,
/// which counts in work_spent() when it ends.
class ProbeState::RunningQuery {
 public:
  /// For a query whose trace has begun.
  ///
  /// stop  null but for the queries of fetch threads: see PageAccessor
  RunningQuery(ProbeState& probe, Wait wait, const std::atomic<bool>* stop = nullptr) noexcept
      : probe_(probe),
        accessor_(probe.reader_, wait, stop ? probe.model_.fetcher_terms : probe.terms_of(wait),
                  stop) {
    accessor_.set_trace(probe.trace_);
  }
  RunningQuery(ProbeState& probe, PageAccess::Query kind, Wait wait,
               const std::atomic<bool>* stop = nullptr) noexcept
      : RunningQuery(probe, wait, stop) {
    probe.begin_trace(kind, wait);
  }
  ~RunningQuery() { probe_.work_spent_ += work_.units; }
  RunningQuery(const RunningQuery&) = delete;
  RunningQuery& operator=(const RunningQuery&) = delete;

  QueryContext context() noexcept {
    return {probe_.model_.geometry, accessor_.pages(), probe_.coherence_, work_};
  }
  const octree::PageReader& pages() const noexcept { return accessor_.pages(); }
  std::uint64_t units() const noexcept { return work_.units; }
  std::uint32_t fetched() const noexcept { return accessor_.fetched(); }
  bool missed() const noexcept { return accessor_.missed(); }
  void keep_missed(std::span<std::uint32_t> room) noexcept { accessor_.keep_missed(room); }
  std::size_t kept_missed() const noexcept { return accessor_.kept_missed(); }
  /// Notes an answer of which nothing is known but what it says.
  void note_degraded() noexcept {
    accessor_.pages().need_others();
    probe_.note_degraded(std::numeric_limits<double>::infinity(), missed());
  }

 private:
  ProbeState& probe_;
  PageAccessor accessor_;
  octree::TraversalStats work_;
};

inline Containment ProbeState::contains_fast(const Vec3& query,
                                             const QueryOptions& options) noexcept {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  const std::uint64_t infinite = bits(std::numeric_limits<double>::infinity());
  const bool is_valid = bits(options.max_error) < infinite &&
                        bits(options.max_distance) <= infinite && (options.parts & ~kAllParts) == 0;
  if (!coherence_.side_grid_answered || !is_valid ||
      model_.geometry.side_means(options.side_rule) != SideMeans::kWindingNumber)
    return {};
  const int winding = model_.geometry.side_grid.find_fast(query.x, query.y, query.z);
  if (winding == octree::SideGrid::kUnknown) return {};
  last_parts_ = kSide;
  if (trace_) trace_->count_query();
  return {winding != 0 ? Side::kInside : Side::kOutside, Status::kExact};
}

/// The probe of a fetch thread. It makes pages resident by running blocking queries.
class QueryingFetchProbe final : public FetchProbe {
 public:
  QueryingFetchProbe(const ServingModel& model, cache::Reader reader)
      : probe_(ProbeState::create(model, std::move(reader))) {
    probe_->set_fetcher();
  }

  std::uint32_t fetch_pages(const Vec3& query, const QueryOptions& options, FetchReason reason,
                            std::span<const Vec3> ahead,
                            const std::atomic<bool>& stop) noexcept override {
    return probe_->fetch_pages(query, options, reason, ahead, stop);
  }
  void fetch_triangles(const Vec3& query, double radius, std::uint64_t count,
                       const QueryOptions& options,
                       const std::atomic<bool>& stop) noexcept override {
    probe_->fetch_triangles({query, radius}, count, options, stop);
  }
  void fetch_way(const Sweep& way, std::uint64_t count, const QueryOptions& options,
                 const std::atomic<bool>& stop) noexcept override {
    probe_->fetch_way(way, count, options, stop);
  }
  bool fetch_page(std::uint32_t page, const std::atomic<bool>& stop) noexcept override {
    return probe_->fetch_page(page, stop);
  }
  bool read_awaited_page() noexcept override { return probe_->read_awaited_page(); }

 private:
  std::unique_ptr<ProbeState> probe_;
};

/// See Probe::closest_points.
void closest_points(ProbeState& probe, std::span<const Vec3> queries,
                    std::span<ClosestPoint> answers, const QueryOptions& options) noexcept;

/// See Probe::contains.
void contains(ProbeState& probe, std::span<const Vec3> queries, std::span<Containment> answers,
              const QueryOptions& options) noexcept;

/// See Probe::first_hits.
void first_hits(ProbeState& probe, std::span<const Ray> rays, std::span<RayHit> hits,
                const QueryOptions& options) noexcept;

/// See Probe::first_contacts.
void first_contacts(ProbeState& probe, std::span<const Sweep> sweeps,
                    std::span<FirstContact> contacts, const QueryOptions& options) noexcept;

/// See the batch of Probe::triangles_within. With `wants_all`
/// false it is that of Probe::nearest_triangles.
void find_triangles(ProbeState& probe, std::span<const Vec3> queries, double radius, bool wants_all,
                    std::span<ClosestPoint> answers, std::span<Found> found,
                    const QueryOptions& options) noexcept;

/// See the batch of Probe::contacts.
void find_contacts(ProbeState& probe, std::span<const Vec3> queries, double radius,
                   std::span<ClosestPoint> answers, std::span<Found> found,
                   const QueryOptions& options) noexcept;

}  // namespace planetree::query
