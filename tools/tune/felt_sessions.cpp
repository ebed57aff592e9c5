#include "tools/tune/felt_sessions.h"

#include <algorithm>

#include "planetree/model.h"
#include "query/model_state.h"
#include "tools/simulation/simulated_session.h"

namespace planetree::tools {
namespace {

OpenOptions open_options(std::uint32_t layers) {
  OpenOptions options;
  options.max_probes = 1;
  options.layers = layers;
  options.locking = Locking::kNever;
  return options;
}

}  // namespace

Result<void> FeltSessions::open() {
  OpenOptions options = open_options(options_.layers);
  const auto least = query::ModelState::min_budget_bytes(options_.file, options);
  if (!least) return least.error();
  options.memory_budget_bytes = *least;
  const auto model = Model::open(options_.file, options);
  if (!model) return model.error();
  least_bytes_ = *least;
  page_bytes_ = model->info().page_bytes;
  overhead_bytes_ = model->stats().table_bytes;
  // Twice the pages of the recording: with other memory other pages are read ahead. The most that
  // the tables of policies take for each frame comes on top.
  constexpr std::uint64_t kMaxPolicyBytes = 64;
  const std::uint64_t frames = std::min(2 * options_.pages + 8, std::uint64_t{model->info().pages});
  most_bytes_ = std::max(least_bytes_, overhead_bytes_ + frames * (page_bytes_ + kMaxPolicyBytes));
  content_id_ = {model->info().content_id[0], model->info().content_id[1]};
  core_lower_ = model->info().core_lower;
  core_upper_ = model->info().core_upper;
  return {};
}

Result<std::vector<std::vector<FeltTick>>> FeltSessions::measure(std::uint64_t bytes,
                                                                 EvictionPolicy policy) {
  std::vector<std::vector<FeltTick>> sessions;
  for (const std::vector<Vec3>& path : options_.paths) {
    SimulationOptions simulation;
    simulation.file = options_.file;
    simulation.memory_bytes = bytes;
    simulation.policy = policy;
    simulation.layers = options_.layers;
    simulation.rate_hz = options_.rate_hz;
    simulation.latency_ns = static_cast<std::uint32_t>(options_.latency_ns);
    auto session = SimulatedSession::open(simulation);
    if (!session) return session.error();
    frames_[{bytes, policy}] = static_cast<std::uint32_t>((*session)->model().stats().frames);
    std::vector<FeltTick>& ticks = sessions.emplace_back();
    for (const Tick& tick : (*session)->run(path).ticks)
      ticks.push_back({tick.status == Status::kDegraded, tick.width, 0});
  }
  return sessions;
}

Result<std::uint32_t> FeltSessions::count_frames(std::uint64_t bytes, EvictionPolicy policy) {
  const auto known = frames_.find({bytes, policy});
  if (known != frames_.end()) return known->second;
  OpenOptions options = open_options(options_.layers);
  options.memory_budget_bytes = bytes;
  options.policy = policy;
  const auto model = Model::open(options_.file, options);
  if (!model) return model.error();
  const auto frames = static_cast<std::uint32_t>(model->stats().frames);
  frames_[{bytes, policy}] = frames;
  return frames;
}

}  // namespace planetree::tools
