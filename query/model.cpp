#include "planetree/model.h"

#include <algorithm>
#include <array>
#include <new>
#include <utility>

#include "octree/geometry/octcode.h"
#include "octree/geometry/startup_check.h"
#include "query/answer/model_region.h"
#include "query/model_state.h"
#include "query/probe_state.h"
#include "query/serve/batch_threads.h"
#include "query/serve/fetch_threads.h"
#include "query/serve/fp_environment.h"
#include "query/serve/page_decoding.h"

namespace planetree {
namespace query {
namespace {

ModelInfo describe(const storage::PageFile& file) {
  const storage::FileHeader& header = file.header();
  const storage::ModelRecord& model = header.model;
  ModelInfo info;
  info.triangles = model.triangle_count;
  info.skipped = model.skipped_count;
  info.first_skipped = model.first_skipped;
  info.vertices = model.vertex_count;
  info.box_lower = {model.box_lower[0], model.box_lower[1], model.box_lower[2]};
  info.box_upper = {model.box_upper[0], model.box_upper[1], model.box_upper[2]};
  info.unbalanced_edges = model.unbalanced_edge_count;
  info.input_triangles = model.usable_triangles();
  info.has_region = model.has_region();
  info.region_lower = {model.region_lower[0], model.region_lower[1], model.region_lower[2]};
  info.region_upper = {model.region_upper[0], model.region_upper[1], model.region_upper[2]};
  info.float64 = model.vertex_kind == storage::VertexKind::kFloat64;
  info.nodes = model.node_count;
  info.blocks = model.block_count;
  info.levels = model.height;
  info.pages = header.page_count;
  info.page_bytes = header.page_bytes;
  info.file_bytes = header.file_bytes;
  info.section_bytes.headers = 2 * sizeof header;
  info.section_bytes.page_table = file.entries().size_bytes();
  for (std::uint32_t page = 0; page < header.page_count; ++page)
    (page < header.first_mask_page() ? info.section_bytes.distance_pages
                                     : info.section_bytes.mask_pages) +=
        file.entries()[page].stored_bytes;
  info.content_id[0] = header.content_id[0];
  info.content_id[1] = header.content_id[1];
  return info;
}

octree::TreeInfo tree_info(const storage::FileHeader& header, const Scale& scale) {
  const storage::ModelRecord& model = header.model;
  octree::TreeInfo tree;
  tree.page_bytes = header.page_bytes;
  tree.root_link = model.root_link;
  tree.shape = block_shape(model);
  tree.record_count = model.node_count + model.block_count;
  tree.box_lower = scale.in(Vec3{model.box_lower[0], model.box_lower[1], model.box_lower[2]});
  tree.box_upper = scale.in(Vec3{model.box_upper[0], model.box_upper[1], model.box_upper[2]});
  tree.centre = {model.centre[0], model.centre[1], model.centre[2]};
  tree.sample = {model.sample[0], model.sample[1], model.sample[2]};
  tree.sample_triangle = model.sample_triangle;
  return tree;
}

octree::MaskInfo mask_info(const storage::FileHeader& header, const octree::TreeInfo& tree) {
  octree::MaskInfo mask;
  mask.page_bytes = header.page_bytes;
  mask.first_page = header.first_mask_page();
  mask.page_count = header.model.mask_page_count;
  mask.lower = tree.box_lower;
  return mask;
}

Result<void> check_counts(const OpenOptions& options) {
  const auto check = [](unsigned count, const char* what, unsigned most) -> Result<void> {
    if (count >= 1 && count <= most) return {};
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "%u %s make no sense; give 1 to %u", count, what, most);
  };
  for (const Result<void>& checked :
       {check(options.batch_threads, "batch threads", OpenOptions::kMaxBatchThreads),
        check(options.fetch_threads, "fetch threads", OpenOptions::kMaxFetchThreads),
        check(options.max_probes, "probes", OpenOptions::kMaxProbes),
        check(std::max(options.page_trace_capacity, 1U), "accesses of a trace",
              OpenOptions::kMaxPageTraceCapacity)})
    if (!checked) return checked;
  return {};
}

// Of the model's own threads.
unsigned thread_probes(const OpenOptions& options) {
  return options.fetch_threads + (options.batch_threads > 1 ? options.batch_threads : 0);
}

Pager::Limits limits_of(const OpenOptions& options, const ModelSeams& seams) {
  Pager::Limits limits;
  limits.budget_bytes = options.memory_budget_bytes;
  limits.max_probes = options.max_probes;
  limits.probe_bytes = sizeof(BatchBuffers);
  limits.thread_probes = thread_probes(options);
  limits.thread_bytes = limits.thread_probes * sizeof(ProbeState) +
                        options.fetch_threads * FetchThreads::kThreadBytes +
                        limits.readers() * FetchWorker::kProbeBytes * options.fetch_threads;
  limits.locking = options.locking;
  limits.wait_limit = std::chrono::milliseconds(options.wait_limit_ms);
  limits.page_trace_capacity = options.page_trace_capacity;
  limits.policy = seams.policy;
  return limits;
}

static_assert(OpenOptions::kMaxProbes + OpenOptions::kMaxFetchThreads +
                  OpenOptions::kMaxBatchThreads <=
              cache::kMaxReaders);

}  // namespace

ModelState::~ModelState() = default;

// What it is in goes after it.
void ModelState::operator delete(ModelState* state, std::destroying_delete_t) noexcept {
  state->fetch_threads_.reset();
  state->batch_threads_.reset();
  const std::unique_ptr<Pager> pager = std::move(state->pager_);
  state->~ModelState();
}

ModelState::ModelState(std::unique_ptr<Pager> pager, std::chrono::milliseconds wait_limit)
    : pager_(std::move(pager)),
      query_arena_(pager_->query_arena().parts()),
      info_(describe(pager_->file())),
      scale_(pager_->file().header().model.scale_exponent),
      wait_limit_(wait_limit) {
  tree_ = tree_info(pager_->file().header(), scale_);
  mask_ = mask_info(pager_->file().header(), tree_);
  region_ = region_of(pager_->file().header().model);
  region_corner_ = region_.clamped(tree_.box_lower);
  region_winding_ = pager_->file().header().model.region_winding;
}

Result<void> ModelState::fill_side_grid() {
  auto reader = claim_reader();
  if (!reader) return reader.error();
  PageAccessor accessor(*reader, Wait::kForPages);
  side_grid_.fill(mask_, tree_, region_.has_walls(), scale_.exponent(), accessor.pages(),
                  query_arena_.side_grid);
  return {};
}

Result<void> ModelState::start_threads(const OpenOptions& options, const ModelSeams& seams) {
  if (options.batch_threads > 1) {
    auto batch_threads = BatchThreads::claim(*this, options.batch_threads);
    if (!batch_threads) return batch_threads.error();
    batch_threads_ = std::move(*batch_threads);
  }
  if (!seams.starts_fetching) return {};
  auto fetchers = FetchThreads::start(*this, options.fetch_threads);
  if (!fetchers) return fetchers.error();
  fetch_threads_ = std::move(*fetchers);
  return {};
}

Result<std::unique_ptr<ModelState>> ModelState::open(const std::filesystem::path& path,
                                                     const OpenOptions& options,
                                                     const ModelSeams& seams) {
  if (const char* fault = octree::startup_check())
    return make_error(ErrorCode::kUnsupported, Error::kNowhere, Error::kNowhere,
                      "this build computes otherwise than it must: %s; compile without "
                      "-ffast-math, -ffp-contract and -mfpmath=387",
                      fault);
  if (const auto checked = check_counts(options); !checked) return checked.error();
  auto pager = Pager::open(path, limits_of(options, seams), seams.calls);
  if (!pager) return pager.error();
  void* storage = (*pager)->query_arena().parts().model_storage;
  const std::chrono::milliseconds wait_limit(options.wait_limit_ms);
  std::unique_ptr<ModelState> state(::new (storage) ModelState(std::move(*pager), wait_limit));
  if (const auto filled = state->fill_side_grid(); !filled) return filled.error();
  if (const auto started = state->start_threads(options, seams); !started) return started.error();
  return state;
}

Result<Model> ModelState::open_model(const std::filesystem::path& path, const OpenOptions& options,
                                     const ModelSeams& seams) {
  const FpEnvironmentGuard host;
  auto state = open(path, options, seams);
  if (!state) return state.error();
  return Model(std::move(*state));
}

std::size_t ModelState::drain_page_trace(std::span<PageAccess> accesses) const noexcept {
  std::size_t count = 0;
  for (std::uint32_t index = 0; index < query_arena_.traces.size(); ++index) {
    std::array<TracedAccess, 64> taken;
    for (std::size_t got = taken.size(); got == taken.size();) {
      const std::size_t capacity = std::min(taken.size(), accesses.size() - count);
      got = query_arena_.traces[index].ring.take(std::span(taken).first(capacity));
      for (const TracedAccess& access : std::span(taken).first(got)) {
        const std::uint64_t octcode = pager_->file().entries()[access.page].octcode;
        const auto level = static_cast<std::uint8_t>(octree::cell_of_octcode(octcode).level);
        accesses[count++] = {access.query, index, access.page, level, access.kind};
      }
    }
  }
  return count;
}

Stats ModelState::stats() const noexcept {
  const cache::CacheStats cache = pager_->cache().stats();
  Stats stats;
  stats.page_hits = cache.hits;
  stats.page_misses = cache.misses;
  stats.pages_read = cache.fills;
  stats.pages_evicted = cache.evictions;
  stats.quarantined_pages = cache.quarantined;
  stats.waits_given_up = cache.given_up;
  stats.degraded_answers = degraded_.load(std::memory_order_relaxed);
  for (const PageTrace& trace : query_arena_.traces)
    stats.page_trace_dropped += trace.ring.dropped();
  for (const FetchRequests& fetch_requests : query_arena_.fetch_requests)
    stats.fetch_requests += fetch_requests.missed.given();
  if (fetch_threads_) {
    stats.fetch_requests_served = fetch_threads_->fetch_requests_served();
    stats.positions_prefetched = fetch_threads_->positions_prefetched();
  }
  stats.frames = cache.frame_count;
  stats.arena_bytes = cache.arena_bytes;
  stats.table_bytes = cache.table_bytes + cache.reserved_bytes;
  stats.budget_bytes = cache.budget_bytes;
  stats.locked_bytes = pager_->locked_bytes();
  stats.header_copy_damaged = pager_->file().header_copy_damaged();
  return stats;
}

}  // namespace query

Result<Model> Model::open(const std::filesystem::path& path, const OpenOptions& options) {
  return query::ModelState::open_model(path, options);
}

Model::Model(std::unique_ptr<query::ModelState> state) noexcept : state_(std::move(state)) {}
Model::Model(Model&&) noexcept = default;
Model& Model::operator=(Model&&) noexcept = default;
Model::~Model() = default;

const ModelInfo& Model::info() const noexcept { return state_->info(); }
Stats Model::stats() const noexcept { return state_->stats(); }
std::size_t Model::drain_page_trace(std::span<PageAccess> accesses) const noexcept {
  return state_->drain_page_trace(accesses);
}

}  // namespace planetree
